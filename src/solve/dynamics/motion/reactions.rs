//! What supports and joints do to a motion: their forces, and the power that moving ones put in.

use super::super::State;
use super::Motion;
use crate::linear::Singular;
use crate::system::Reaction;

impl Motion<'_> {
    /// Forces of supports and joints on the beams in the state `state`.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn reactions(&mut self, state: &State) -> Result<Vec<Reaction>, Singular> {
        let held = self.held_forces(state)?;
        Ok(self.system.reactions(state.time, &state.q, &held, &self.multipliers))
    }

    /// Forces of the supports on the held coordinates, zero for all others: M q̈ + f in the state `state`, in fixed axes.
    fn held_forces(&mut self, state: &State) -> Result<Vec<f64>, Singular> {
        let n = self.coordinates();
        let unknowns = self.unknowns_of(state).into_owned();
        let mut acceleration = vec![0.0; n];
        self.acceleration(&unknowns, &mut acceleration)?;
        let (mut q, mut v) = (unknowns.q, unknowns.v);
        self.system.supports().carry(state.time, [&mut q, &mut v, &mut acceleration]);
        let mut force = vec![0.0; n];
        self.system.force(state.time, &q, &mut force);
        self.system.add_damping(&q, &v, &mut force);
        self.mass.multiply_add(1.0, &acceleration, &mut force);
        self.system.add_constraint_forces(state.time, &q, &self.multipliers, &mut force);
        self.system.supports().keep_held(state.time, &mut force);
        Ok(force)
    }

    /// Power \[W\] that moving supports put in.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn support_power(&mut self, state: &State) -> Result<f64, Singular> {
        if !self.moves {
            return Ok(0.0);
        }
        let reactions = self.held_forces(state)?;
        let mut velocity = vec![0.0; state.q.len()];
        self.system.supports().prescribed_velocity(state.time, &state.q, &mut velocity);
        Ok(reactions.iter().zip(&velocity).map(|(r, v)| r * v).sum())
    }
}
