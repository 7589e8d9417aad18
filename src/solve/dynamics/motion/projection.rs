//! The end of a step moved onto the constraints.
//!
//! They hold to round-off only in the equations of a step, and what remains of their error in positions and velocities would add up
//! over many steps. The change δ is the smallest in the norm of the kinetic energy,
//!
//! ```text
//! M δ + Bᵀ μ = 0,   B δ = −g
//! ```
//!
//! with which Radau's methods keep their order (Hairer, Wanner, *Solving Ordinary Differential Equations II*, 1996, ch. VII) and a
//! free motion its momentum.
//!
//! # Rows that follow the state
//! Where beams keep their length, B is another after each step, and with it the matrix of these equations. To factorise it takes
//! longer than all else that a step does to the constraints. The factors of the state of the last tangent give μ with an error of
//! some thousandths; then
//!
//! ```text
//! δ = −M⁻¹ Bᵀ μ
//! ```
//!
//! with the B of the present state and the factors of M alone, which never change. Whatever μ, such a δ changes no momentum. It is
//! repeated until g is a hundredth of what the step has left: nothing adds up, because each step corrects the whole g.
//!
//! # What bends stiff beams
//! The smallest velocities that close a hinge are those of a blow, which bends a stiff beam in the few cells beside it: a vibration
//! that no step follows. The next step would end it, but its prediction, its error and every record in it would be those of a beam that
//! shakes. The fast part φ of the change,
//!
//! ```text
//! (c M + K) φ + Bᵀ λ = K δ,   B φ = 0
//! ```
//!
//! with the matrix c M + K of the step, is therefore taken away from δ. Of slow motions it is a part of the order h², and a motion of the
//! whole beam has none of it. Mass, tangent and rows must be those of the present state, or the method loses an order: the factors of
//! the step, which are of an earlier one, serve to correct φ until the equations hold. Where supports move or tendons are pulled, the
//! change stays as it is: what it takes from them would be missing in their work.

use super::{Motion, RowsFactor, State};
use crate::linear::{Factor, NOT_FACTORISED, Singular};

/// Vibrations, or a change, are too fast for a step where their ω² is so many times the c of its matrix c M + K.
const FAST: f64 = 1e3;
/// Most corrections of the fast part …
const CORRECTIONS: usize = 16;
/// … which is found where each is smaller than the one before by this factor at least …
const UNSOLVED: f64 = 0.7;
/// … to this part of the first of them, …
const PRECISE: f64 = 1e-8;
/// … or to this size in beam lengths.
const NEGLIGIBLE: f64 = 1e-13;
/// Constraints are met where they are violated by this in beam lengths, …
const MET: f64 = 1e-14;
/// … or by this part of what a step has left.
const SMALLER: f64 = 1e-2;
/// Most corrections with the factors of an earlier state.
const EARLIER: usize = 4;

/// The matrix c M + K of a step.
pub struct StepMatrix<F> {
    /// c \[1/s²\].
    pub inertia: f64,
    /// h \[s\].
    pub step: f64,
    /// Solves with it and the rows of the constraints in the supports' frames; it may be that of an earlier state.
    pub solve: F,
}

/// What is moved onto the constraints.
#[derive(Clone, Copy)]
enum Moved {
    Positions,
    Velocities,
}

impl Moved {
    fn of(self, state: &mut State) -> &mut Vec<f64> {
        match self {
            Self::Positions => &mut state.q,
            Self::Velocities => &mut state.v,
        }
    }
}

impl Motion<'_> {
    /// Moves a state at the end of a step, which had this matrix, onto the constraints.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn project(
        &mut self,
        state: &mut State,
        matrix: &StepMatrix<impl Fn(&mut [f64])>,
    ) -> Result<(), Singular> {
        if self.system.multipliers() == 0 {
            return Ok(());
        }
        let is_fed = self.system.works_by_constraints();
        self.vibrates = self.follows && !is_fed && self.fastest > FAST * matrix.inertia;
        for (moved, time) in [(Moved::Positions, 1.0), (Moved::Velocities, matrix.step)] {
            let change = self.correct(moved, time, state)?;
            if !self.vibrates {
                continue;
            }
            if let Some(fast) = self.fast_part(state, &change, time, matrix) {
                moved.of(state).iter_mut().zip(&fast).for_each(|(x, fast)| *x -= fast);
                self.correct(moved, time, state)?;
            }
        }
        Ok(())
    }

    /// Corrects positions, or velocities during a `time` \[s\], by the change that it returns.
    fn correct(&mut self, moved: Moved, time: f64, state: &mut State) -> Result<Vec<f64>, Singular> {
        let mut whole = vec![0.0; self.coordinates()];
        let is_met =
            self.without_rows.is_some() && self.correct_by_earlier(moved, time, state, &mut whole)?;
        if !is_met {
            // One correction is enough, for quadratic rows too: the error that a step leaves is small.
            self.mass_at(state.time, &state.q)?;
            let mut change = self.violation(moved, state);
            self.mass_factor.as_ref().expect(NOT_FACTORISED).solve(&mut change);
            self.move_by(&mut change, moved, state, &mut whole);
        }
        Ok(whole)
    }

    /// [`Self::correct`] with the factors of the state of the last tangent, added to the `whole` change; false where the constraints
    /// are not met by that.
    fn correct_by_earlier(
        &mut self,
        moved: Moved,
        time: f64,
        state: &mut State,
        whole: &mut [f64],
    ) -> Result<bool, Singular> {
        let n = self.coordinates();
        let mut met = MET;
        for correction in 0..=EARLIER {
            let mut change = self.violation(moved, state);
            let largest = change[n..].iter().fold(0.0, |largest: f64, g| largest.max(g.abs()));
            let size = time * largest / self.system.stiffness();
            if correction == 0 {
                met = met.max(SMALLER * size);
            }
            if size <= met {
                // Velocities of what rests are round-off, which must not contradict the constraints either.
                return Ok(correction > 0 || size == 0.0 || matches!(moved, Moved::Positions));
            }
            if correction == EARLIER || !size.is_finite() {
                break;
            }
            if !self.rows_factor.is_of_tangent {
                let earlier = self.rows_factor.factor.take();
                let factor = Factor::definite(earlier, &self.eliminated_mass, &self.border)?;
                self.rows_factor = RowsFactor { factor: Some(factor), is_of_tangent: true };
            }
            self.rows_factor.factor.as_ref().expect(NOT_FACTORISED).solve(&mut change);
            let (force, multipliers) = change.split_at_mut(n);
            force.fill(0.0);
            multipliers.iter_mut().for_each(|mu| *mu = -*mu);
            self.system.add_constraint_forces(state.time, &state.q, multipliers, force);
            self.system.supports().to_frames(state.time, force);
            self.without_rows.as_ref().expect(NOT_FACTORISED).solve(force);
            self.move_by(force, moved, state, whole);
        }
        Ok(false)
    }

    /// Zeros for the coordinates, and −g or its rate for the multipliers, scaled.
    fn violation(&self, moved: Moved, state: &State) -> Vec<f64> {
        let n = self.coordinates();
        let mut violation = vec![0.0; self.unknowns()];
        match moved {
            Moved::Positions => self.system.constraint_values(state.time, &state.q, &mut violation[n..]),
            Moved::Velocities => {
                self.system.constraint_rates(state.time, &state.q, &state.v, &mut violation[n..]);
                self.system.add_prescribed_rates(1, state.time, &mut violation[n..]);
            }
        }
        violation
    }

    /// Adds a change of the unknowns to positions or velocities, and to the `whole` change in fixed axes.
    fn move_by(&self, change: &mut [f64], moved: Moved, state: &mut State, whole: &mut [f64]) {
        self.to_fixed_axes(state, change);
        let moved = moved.of(state).iter_mut().zip(whole).zip(change);
        moved.for_each(|((x, whole), d)| {
            *x += *d;
            *whole += *d;
        });
    }

    /// The fast part of a change of positions, or of velocities during a `time` \[s\]; `None` where it is slow, or is not found with the
    /// matrix of the step.
    fn fast_part(
        &self,
        state: &State,
        change: &[f64],
        time: f64,
        StepMatrix { inertia, solve, .. }: &StepMatrix<impl Fn(&mut [f64])>,
    ) -> Option<Vec<f64>> {
        let (n, q) = (self.coordinates(), &state.q[..]);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let force = |d: &[f64]| {
            let mut force = vec![0.0; n];
            self.system.tangent_product(state.time, q, d, &mut force);
            force
        };
        let momentum = |d: &[f64]| {
            let mut momentum = vec![0.0; n];
            self.mass.multiply_add(1.0, d, &mut momentum);
            self.system.add_turning_momentum(q, d, &mut momentum);
            momentum
        };
        let wanted = force(&change[..n]);
        if dot(change, &wanted) <= FAST * inertia * dot(change, &momentum(&change[..n])) {
            return None;
        }
        let mut fast = vec![0.0; self.unknowns()];
        let (mut first, mut last) = (0.0, f64::INFINITY);
        for _ in 0..CORRECTIONS {
            let mut found = force(&fast[..n]);
            found.iter_mut().zip(momentum(&fast[..n])).for_each(|(f, p)| *f += inertia * p);
            self.system.add_constraint_forces(state.time, q, &fast[n..], &mut found);
            let mut more: Vec<f64> =
                wanted.iter().zip(&found).map(|(wanted, found)| wanted - found).collect();
            more.resize(self.unknowns(), 0.0);
            self.system.supports().to_frames(state.time, &mut more[..n]);
            self.system.polar().forces(q, &mut more[..n]);
            self.system.constraint_rates(state.time, q, &fast[..n], &mut more[n..]);
            solve(&mut more);
            self.to_fixed_axes(state, &mut more);
            let size = time * self.size(&more[..n]);
            if size.is_nan() || size > UNSOLVED * last {
                return None;
            }
            fast.iter_mut().zip(&more).for_each(|(x, d)| *x += d);
            if !last.is_finite() {
                first = size;
            } else if size * (size / last) <= NEGLIGIBLE.max(PRECISE * first) {
                fast.truncate(n);
                return Some(fast);
            }
            last = size;
        }
        None
    }

    /// Turns a change of the unknowns of a state into fixed axes.
    fn to_fixed_axes(&self, state: &State, change: &mut [f64]) {
        let n = self.coordinates();
        self.system.supports().to_fixed_axes(state.time, &mut change[..n]);
        self.system.polar().changes(&state.q, &mut change[..n]);
    }

    /// About the square ω² \[1/s²\] of the fastest vibration: the largest that one coordinate alone has in the last tangent.
    pub(super) fn fastest(&self) -> f64 {
        let alone = |i: usize| {
            let mass = self.free_mass.get(i, i);
            if mass > 0.0 { self.tangent.get(i, i) / mass } else { 0.0 }
        };
        (0..self.coordinates()).map(alone).fold(0.0, f64::max)
    }
}
