//! Section forces: what a cut through a beam passes on, by the balance of one side of it.
//!
//! In the discrete equations, constants and r itself are among the shape functions, so that the
//! forces on a whole beam and their moments balance to round-off, those of supports and joints
//! included. The piece before a cut is therefore held by
//!
//! ```text
//! F(s) = −Σ f      M(s) = −Σ ((r_i − r(s)) × f_i + couples)      N = F·t   Q = F·Jt   t = r'/|r'|
//! ```
//!
//! summed over all that acts on it: loads, inertia, springs, contacts, fluids, supports, joints. F
//! and M are those on the side of the cut that looks to the beam's end: N is positive in tension, M
//! has the sign of EI κ, and M' = −Q |r'| where no couple acts. Stiffness times strain is another
//! thing: its error is that of the strain times EA, of any size against a load that bends a slender
//! beam.

use super::System;
use crate::assembly::{Action, Actions, InternalVariables, Turning};
use nalgebra::Vector2;

/// A state in which all forces balance.
#[derive(Clone, Copy, Debug)]
pub struct Balanced<'b> {
    /// Load factor or time.
    pub parameter: f64,
    /// Coordinates.
    pub q: &'b [f64],
    /// Velocities and accelerations, in a motion.
    pub motion: Option<[&'b [f64]; 2]>,
    /// Forces of supports on the held coordinates, in fixed axes; zero on all others.
    pub support_forces: &'b [f64],
    /// Scaled multipliers.
    pub multipliers: &'b [f64],
    /// The internal variables.
    pub variables: &'b InternalVariables,
}

impl System {
    /// What acts on each beam.
    pub fn actions(&self, state: Balanced<'_>) -> Vec<Actions> {
        let Balanced { parameter, q, motion, support_forces, multipliers, variables } = state;
        let mut actions = vec![Actions::default(); self.beams.len()];
        for effect in &self.terms.internal {
            effect.add_actions(1.0, q, q, &mut actions[effect.beam()]);
        }
        for load in &self.terms.loads {
            let factor = self.amplitude_of(load).at(parameter);
            load.effect.add_actions(factor, q, q, &mut actions[load.effect.beam()]);
        }
        for force in &self.terms.moving_loads {
            force.add_actions(parameter, q, &mut actions[force.beam()]);
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
            for (s, ([x, y, dx, dy], [fx, fy, gx, gy])) in part.basis.nodes().iter().zip(nodes) {
                let mut action = Action::at(Vector2::new(*x, *y), Vector2::new(*fx, *fy));
                action += Action::couple(dx * gy - dy * gx);
                actions.add_point(*s, action);
            }
        }
        for (constraint, mu) in self.constraints.iter().zip(multipliers) {
            let mu = mu * constraint.scale(self.stiffness, self.length);
            for (first, s, action) in constraint.actions(parameter, q, mu) {
                let (beam, _) = self.place_of(first);
                actions[beam].add_point(s, action);
            }
        }
        actions
    }

    /// The same in equilibrium, `x` being coordinates and scaled multipliers.
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
