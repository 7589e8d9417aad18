//! Laws of time in a motion: the part of them that a step does not see, and jumps where they are
//! not smooth.

use super::super::State;
use super::Motion;
use crate::linear::Singular;
use crate::system::laws::LoadSample;

impl Motion<'_> {
    /// Mean and first moment of the loads from the time of `state`, which is in fixed axes, to
    /// `end`, less those that the samples `looks` give; in the supports' frames. None where no load
    /// depends on time.
    pub fn unseen_loads(&self, state: &State, end: f64, looks: &[LoadSample]) -> Option<[Vec<f64>; 2]> {
        if !self.system.loads_follow_time() {
            return None;
        }
        let n = self.coordinates();
        let [mut mean, mut moment] = [0; 2].map(|_| vec![0.0; self.unknowns()]);
        let span = [state.time, end];
        let unseen = [&mut mean[..n], &mut moment[..n]];
        self.system.add_unseen_loads(span, looks, &state.q, unseen, &mut vec![0.0; n]);
        for force in [&mut mean, &mut moment] {
            self.system.supports().to_frames(state.time, &mut force[..n]);
            self.system.polar().forces(&state.q, &mut force[..n]);
        }
        Some([mean, moment])
    }

    /// Error of positions, in beam lengths, due to motions of supports that the samples `looks`
    /// miss.
    pub fn unseen_motion(&self, start: f64, end: f64, looks: &[LoadSample]) -> f64 {
        if self.system.supports().moves_in_time() {
            self.system.unseen_motion([start, end], looks)
        } else {
            0.0
        }
    }

    /// Passes from `before`, just before a time at which loads or supports are not smooth, to the
    /// time of `state`, just after it. Moving supports take their velocity there, and all else the
    /// velocity that their impulse gives it. Returns the jump of accelerations and multipliers.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn pass(&mut self, before: f64, state: &mut State) -> Result<Vec<f64>, Singular> {
        if self.system.supports().moves_in_time() {
            let q = std::mem::take(&mut state.q);
            let velocities = [before, state.time].map(|time| {
                let mut v = vec![0.0; q.len()];
                self.system.supports().prescribed_velocity(time, &q, &mut v);
                v
            });
            if velocities[0] != velocities[1] {
                state.v = self.admissible_velocity(state.time, &q, &state.v)?;
            }
            state.q = q;
        }
        let after = self.unknowns_of(state).into_owned();
        let mut jump = self.free_forces(&after);
        let earlier = self.free_forces(&State { time: before, ..after.clone() });
        jump.iter_mut().zip(&earlier).for_each(|(jump, earlier)| *jump -= earlier);
        self.accelerate(&after, &mut jump)?;
        Ok(jump)
    }
}
