//! Equilibria near known ones: those of a coarse mesh, begun at those of a finer one.
//!
//! Two meshes err by little against what the loads do, so that Newton's method needs no load steps
//! from one to the other, and a few iterations instead of dozens. Where equilibria depend on the
//! path that leads to them, they are not looked for in this way.

use super::equilibrium::{AtLoad, Equilibrium};
use super::newton::{self, Iterations};
use super::statics::{Solution, newton_settings};
use crate::assembly::Earlier;
use crate::model::Static;
use crate::system::System;

/// Largest change of a node from the known state: positions in beam lengths, directions in radians.
const NEAR: f64 = 0.5;
/// Nodes nearer to each other than this, in beam lengths, are one.
const SAME_NODE: f64 = 1e-9;

/// Known equilibria.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// Arc lengths of the nodes of each beam \[m\].
    pub nodes: Vec<Vec<f64>>,
    /// Load factors, and coordinates of all nodes.
    pub states: Vec<(f64, Vec<f64>)>,
}

impl Known {
    /// The coordinates of the nodes of `system` in the state `q`; `None` where one is missing.
    fn on_nodes_of(&self, system: &System, q: &[f64]) -> Option<Vec<f64>> {
        let (mut on, mut first) = (Vec::with_capacity(system.coordinates()), 0);
        for (part, known) in system.beams().iter().zip(&self.nodes) {
            let near = SAME_NODE * part.basis.length();
            let mut at = 0;
            for s in part.basis.nodes() {
                at += known.get(at..)?.iter().position(|node| (node - s).abs() <= near)?;
                on.extend(q.get(4 * (first + at)..4 * (first + at + 1))?);
            }
            first += known.len();
        }
        (on.len() == system.coordinates()).then_some(on)
    }
}

/// The equilibria of `system` near those that are known; `None` where the path matters, and where
/// one is not found nearby.
pub fn solve(system: &System, settings: &Static, known: &Known) -> Option<Solution> {
    if system.has_history() || settings.arc_length.is_some() {
        return None;
    }
    let newton = newton_settings(settings);
    let mut equilibrium = Equilibrium::new(system);
    let mut solution = Solution::default();
    let starts_at_rest = !(system.is_taken_up() || system.starts_bent() || system.is_prestressed());
    for (load, q) in &known.states {
        let mut x = equilibrium.start();
        if *load != 0.0 || !starts_at_rest {
            let n = system.coordinates();
            x[..n].copy_from_slice(&known.on_nodes_of(system, q)?);
            system.supports().impose(*load, &mut x[..n]);
            let (from, still) = (x.clone(), vec![0.0; x.len()]);
            let earlier = Earlier { q: &from, increment: &still };
            let settings = newton::Settings { first_increment: NEAR, ..newton };
            let mut equations = AtLoad::new(&mut equilibrium, *load);
            newton::solve(&mut equations, &mut x, earlier, &settings, &mut Iterations::default()).ok()?;
            let change: Vec<f64> = x.iter().zip(&from).map(|(x, from)| x - from).collect();
            if equilibrium.size(&change) > NEAR {
                return None;
            }
        }
        solution.record(&equilibrium, *load, &x, super::Work::default());
    }
    solution.statistics = equilibrium.statistics;
    Some(solution)
}
