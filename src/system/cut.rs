//! Section forces, from the balance of all actions on one side of a cut through a beam.
//!
//! Constants and r itself are among the functions that the shape functions reproduce, so that in
//! the discrete equations the forces on a whole beam, including those of supports and joints, and
//! their moments balance to round-off. The section forces at a cut therefore balance all actions on
//! the piece before it:
//!
//! ```text
//! F(s) = −Σ f      M(s) = −Σ ((r_i − r(s)) × f_i + couples)      N = F·t   Q = F·Jt   t = r'/|r'|
//! ```
//!
//! The sums run over loads, inertia, springs, contacts, fluids, supports and joints. F and M act on
//! the cut face of the piece before the cut: N is positive in tension, M has the sign of EI κ, and
//! M' = −Q |r'| where no couple acts. Stiffness times strain would be much less accurate: its error
//! is EA times the error of the strain, which may exceed by far the loads that bend a slender beam.

use super::System;
use crate::assembly::{Action, Actions, InternalVariables, Turning};

/// A state in which all forces are in balance.
#[derive(Clone, Copy, Debug)]
pub struct Balanced<'b> {
    /// Load factor or time.
    pub parameter: f64,
    /// Coordinates.
    pub q: &'b [f64],
    /// Velocities and accelerations, in a motion.
    pub motion: Option<[&'b [f64]; 2]>,
    /// Forces of supports on the fixed coordinates, in fixed axes; zero on all others.
    pub support_forces: &'b [f64],
    /// The scaled multipliers.
    pub multipliers: &'b [f64],
    /// The internal variables.
    pub variables: &'b InternalVariables,
}

impl System {
    /// The actions on each beam.
    pub fn actions(&self, state: Balanced<'_>) -> Vec<Actions> {
        let Balanced { parameter, q, motion, support_forces, multipliers, variables } = state;
        let mut actions = vec![Actions::default(); self.beams.len()];
        for effect in self.terms.internal.iter().filter(|effect| !effect.kind().is_of_shape_alone()) {
            effect.add_actions(1.0, q, q, &mut actions[effect.beam()]);
        }
        for load in self.terms.loads.iter().filter(|load| !load.effect.kind().is_of_shape_alone()) {
            let factor = self.amplitude_of(load).at(parameter);
            load.effect.add_actions(factor, q, q, &mut actions[load.effect.beam()]);
        }
        self.add_layer_strains(parameter, &mut actions);
        for load in &self.terms.timed_loads {
            load.add_actions(parameter, q, &mut actions[load.beam()]);
        }
        if let Some([v, a]) = motion {
            for effect in &self.terms.inertia {
                effect.add_actions(1.0, q, a, &mut actions[effect.beam()]);
            }
            for Turning { momentum, rate } in &self.terms.turning {
                momentum.add_actions(q, a, &mut actions[momentum.beam()]);
                rate.add_actions(q, v, &mut actions[rate.beam()]);
            }
            for damping in &self.terms.damping {
                damping.add_actions(q, v, &mut actions[damping.beam()]);
            }
        }
        for friction in &self.terms.friction {
            friction.add_actions_of(variables, q, &mut actions[friction.beam()]);
        }
        for winding in &self.terms.windings {
            winding.add_actions(variables, q, &mut actions[winding.beam()]);
        }
        for (part, actions) in self.beams.iter().zip(&mut actions) {
            let range = 4 * part.first_node..4 * (part.first_node + part.basis.nodes().len());
            let nodes =
                q[range.clone()].as_chunks::<4>().0.iter().zip(support_forces[range].as_chunks::<4>().0);
            for (s, (z, force)) in part.basis.nodes().iter().zip(nodes) {
                actions.add_point(*s, Action::of_node(*z, *force));
            }
        }
        for (constraint, mu) in self.constraints.iter().zip(multipliers) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            for (first, s, action) in constraint.actions(parameter, q, mu) {
                let (beam, _) = self.place_of(first);
                actions[beam].add_point(s, action);
            }
        }
        for (tension, length) in self.tensions(multipliers) {
            actions[length.beam()].add_tendon(tension, &length.path);
        }
        actions
    }

    /// As [`Self::actions`], in equilibrium; `x` holds the coordinates and the scaled multipliers.
    pub fn static_actions(&self, load: f64, x: &[f64], variables: &InternalVariables) -> Vec<Actions> {
        let (q, multipliers) = x.split_at(self.coordinates());
        let support_forces = self.static_support_forces(load, x, variables);
        self.actions(Balanced {
            parameter: load,
            q,
            motion: None,
            support_forces: &support_forces,
            multipliers,
            variables,
        })
    }
}
