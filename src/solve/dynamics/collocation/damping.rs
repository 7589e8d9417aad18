//! Damping of the ends of steps of Gauss' methods, where steps are chosen by a tolerance.
//!
//! They neither damp nor follow vibrations with many periods in a step. Axial waves of fine meshes,
//! which loads, kinks and the error of the stages excite, are carried on with changing sign, until
//! the stages take ever more iterations and the steps are wrong in a way that the error estimate
//! does not see. Where steps are chosen by a tolerance, most are too long for some of these waves.
//! The end of a step is therefore drawn towards its last stage:
//!
//! ```text
//! q₁ ← q₁ − Fˢ⁺¹ (q₁ − Q_s),   v₁ ← v₁ − Fˢ⁺¹ (v₁ − V_s),   F = (γ²/h² M + K)⁻¹ K
//! ```
//!
//! F is (ω h/γ)² for slow motions, which hardly change, and 1 for infinitely fast ones, whose
//! stages are in equilibrium. The differences are of the order h, so that the change is two orders
//! smaller than the method's error. No amplitude grows at any frequency: with three stages a
//! vibration of ω h = 1 loses 2e-8 of it in a step (Radau IIA: 1.3e-4), one of ω h = 30 four
//! fifths. Linear momentum is kept, for which nodes that have turned apart need a new tangent. K (q₁ − Q_s) is computed as the difference of the forces, and K
//! (v₁ − V_s) as that of their rates, because both must vanish in a rigid rotation. The change of
//! slow motions counts as an error of the step: the end of a step of a stiff rotating rod lies off
//! the circle, and drawing it back takes away some angular momentum in every step. With steps of
//! given length the methods remain symplectic.

use super::{Collocation, NOT_FACTORISED};
use crate::linear::Singular;
use crate::solve::dynamics::State;
use crate::solve::dynamics::method::Allowed;
use crate::solve::dynamics::motion::{Acceleration, Rates};
use crate::solve::dynamics::stages;
use crate::solve::dynamics::tableau::Tableau;
use nalgebra::{Complex, DMatrix};

/// Weight of the errors due to the damping at the ends of steps: they have the same sign in every
/// step.
const ERRORS_OF_DAMPING: f64 = 3.0;
/// A change at the end of a step times the angle by which nodes have turned apart, as a part of the error that the step may make, beyond which what
/// may drift has the change computed with a tangent of its own: one that is turned keeps linear momentum only where all nodes turn alike, and what is
/// lost in every step adds up.
const APART: f64 = 1e-6;

/// A change of the end of a step, by motions that are too fast for it.
struct FastChange {
    /// In fixed axes.
    of: Vec<f64>,
    /// As positions \[beam lengths\].
    size: f64,
    /// Of that what moves slowly.
    slow: f64,
}

impl Collocation<'_> {
    /// e − F e in the supports' frames: the part of e that is slow compared with a step of length
    /// `h`.
    pub(super) fn slow(&self, h: f64, e: &[f64]) -> Vec<f64> {
        let mut slow = vec![0.0; e.len()];
        self.motion.multiply_free_mass((h * h).recip(), e, &mut slow);
        self.solve_turned(self.eigenvalue().powi(2), &mut slow);
        slow
    }

    /// Replaces e by F e, its fast part.
    pub(super) fn keep_fast(&self, h: f64, e: &mut [f64]) {
        let slow = self.slow(h, e);
        e.iter_mut().zip(&slow).for_each(|(e, slow)| *e -= slow);
    }

    /// Draws the unknowns `to` at the end of the step towards its last stage, as far as they move
    /// too fast for the step. Returns the error of the position due to the change of slow motions.
    pub(super) fn damp(&mut self, from: &State, to: &mut State, allowed: Allowed) -> Result<f64, Singular> {
        let (n, last, h) = (self.motion.coordinates(), self.tableau.stages() - 1, self.end - from.time);
        let weights =
            |matrix: &DMatrix<f64>, j: usize, h: f64| if j <= last { matrix[(last, j)] / h } else { 0.0 };
        let Tableau { inverse, inverse_squared, .. } = &self.tableau;
        self.stages.sum(|j| weights(inverse_squared, j, h * h), &mut self.acceleration);
        let mut velocity = vec![0.0; n];
        self.stages.sum(|j| weights(inverse, j, h), &mut velocity);
        velocity.iter_mut().zip(&from.v).for_each(|(v, start)| *v += start);
        let q = stages::lane(&self.stages.x[..n], last);
        let stage = State { time: self.time(from, last), q, v: velocity, ..State::default() };

        let mut position = vec![0.0; self.motion.unknowns()];
        let x: Vec<f64> = to.q.iter().copied().chain(self.multipliers()).collect();
        let rates = Rates { time: to.time, v: &to.v, a: Acceleration::constant(&self.acceleration) };
        self.motion.residual(&x, rates, &mut position);
        position[n..].fill(0.0);
        let forces = [position, self.motion.rate_of_forces(&stage, to)];
        self.turn_to(to);
        let mut changes = self.fast_changes(h, &forces);
        let size: f64 = changes.iter().map(|change| change.size).sum();
        if self.drifts && size * self.turns.spread() > APART * allowed.step {
            let rate = self.kept.as_ref().map_or(1.0, |kept| kept.rate);
            self.linearize(to, self.multipliers(), h)?;
            self.kept.as_mut().expect(NOT_FACTORISED).rate = rate;
            self.turn_to(to);
            changes = self.fast_changes(h, &forces);
        }
        let [position, velocity] = &changes;
        for (unknowns, change) in [(&mut to.q, position), (&mut to.v, velocity)] {
            unknowns.iter_mut().zip(&change.of).for_each(|(x, change)| *x += change);
        }
        Ok(ERRORS_OF_DAMPING * (position.slow + velocity.slow))
    }

    /// F^{s+1} (γ²/h² M + K)⁻¹ of the forces for the positions and their rates for the velocities.
    fn fast_changes(&self, h: f64, forces: &[Vec<f64>; 2]) -> [FastChange; 2] {
        let change = |(forces, unit): (&Vec<f64>, f64)| {
            let mut of = forces.clone();
            self.solve_turned(Complex::new(1.0, 0.0), &mut of);
            (0..self.tableau.stages()).for_each(|_| self.keep_fast(h, &mut of));
            let mut slow = self.slow(h, &of);
            for change in [&mut of, &mut slow] {
                self.motion.from_frames(change);
            }
            let [size, slow] = [&of, &slow].map(|change| unit * self.motion.distance(change));
            FastChange { of, size, slow }
        };
        let [position, velocity] = forces;
        [(position, 1.0), (velocity, h)].map(change)
    }
}
