//! Measures the time of an iteration: of one evaluation of each effect with its tangent, of one
//! factorisation, and of one substitution.

use super::{Inventory, System};
use crate::assembly::{Kind, Workspace};
use crate::linear::Factor;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Time for which each item is repeated: enough to measure it to a few per cent on a shared
/// machine.
const PATIENCE: Duration = Duration::from_millis(10);

/// Times of the linear algebra of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Measured {
    /// Time of a factorisation \[s\].
    pub factorization: f64,
    /// Time of a substitution \[s\].
    pub substitution: f64,
    /// Time of a factorisation, a substitution and all effects with their tangents \[s\].
    pub iteration: f64,
}

/// Seconds that one call takes.
fn time(mut call: impl FnMut()) -> f64 {
    call();
    let (start, mut count) = (Instant::now(), 0_u32);
    while start.elapsed() < PATIENCE {
        call();
        count += 1;
    }
    start.elapsed().as_secs_f64() / f64::from(count.max(1))
}

impl System {
    /// The inventory, with the time that each effect takes in the stress-free state.
    pub fn measured_inventory(&self) -> Inventory {
        let mut inventory = self.inventory();
        let q = &self.reference;
        let (mut f, mut k) = (vec![0.0; q.len()], self.matrix());
        let mut workspace = Workspace::default();
        let note = |inventory: &mut Inventory, kind: Kind, beam: usize, seconds: f64| {
            let name = &self.beams[beam].name;
            let entry = inventory.effects.iter_mut().find(|e| e.kind == kind && e.beam == *name);
            if let Some(entry) = entry {
                *entry.seconds.get_or_insert(0.0) += seconds;
            }
        };
        let loads = self.terms.loads.iter().map(|load| &load.effect);
        for effect in self.terms.internal.iter().chain(loads) {
            let seconds = time(|| effect.add_force_and_tangent(1.0, q, None, &mut f, &mut k, &mut workspace));
            note(&mut inventory, effect.kind(), effect.beam(), seconds);
        }
        for load in &self.terms.timed_loads {
            let seconds = time(|| load.add_force_and_tangent(0.0, q, &mut f, &mut k, &mut workspace));
            note(&mut inventory, load.kind(), load.beam(), seconds);
        }
        if self.is_damped() {
            let (v, mut d) = (vec![0.0; q.len()], self.damping_pattern());
            for damping in &self.terms.damping {
                let seconds = time(|| damping.add_matrix(q, &v, &mut f, &mut d, &mut workspace));
                note(&mut inventory, damping.kind(), damping.beam(), seconds);
            }
        }
        // In every residual, inertia is one product with the mass matrix.
        if !self.terms.inertia.is_empty() {
            let mass = self.mass_matrix();
            let seconds = time(|| mass.multiply_add(1.0, q, &mut f));
            if let Some(first) = self.terms.inertia.first() {
                note(&mut inventory, first.kind(), first.beam(), seconds);
            }
        }
        self.force_and_tangent(0.0, q, None, &mut f, &mut k, &mut workspace);
        self.supports.turn_matrix(0.0, &mut k);
        self.supports.eliminate(0.0, &mut k);
        let border = self.border(0.0, q);
        // If there is a mass, factorises as a motion with short steps does.
        let mass = (!self.terms.inertia.is_empty()).then(|| self.mass_matrix());
        let factorize = || match &mass {
            None => Factor::new(&k, &border),
            Some(mass) => {
                let stiffest = (0..q.len()).fold(0.0_f64, |m, i| m.max(k.get(i, i) / mass.get(i, i)));
                Factor::shifted(None, &k, (stiffest, mass), &border)
            }
        };
        if let Ok(factor) = factorize() {
            let mut b = vec![1.0; q.len() + border.len()];
            let factorization = time(|| drop(factorize()));
            let substitution = time(|| factor.solve(&mut b));
            let effects = inventory.effects.iter().filter_map(|e| e.seconds).sum::<f64>();
            let iteration = effects + factorization + substitution;
            inventory.measured = Some(Measured { factorization, substitution, iteration });
        }
        inventory
    }
}
