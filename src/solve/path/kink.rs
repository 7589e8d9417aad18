//! Kinks of a path by arc length, at which contacts open and close and laws have corners.
//!
//! The tangents (ẋ, λ̇) on both sides of a kink have any angle. Where a structure snaps onto a stiff stop, the load factor that
//! fell begins to grow, and the angle is nearly a half turn. A plane across the path at the end of a step then does not meet
//! what lies beyond the kink, and the side to which the new tangent points does not follow from where the step has led.
//!
//! It follows from the determinant of the equations with the tangent as their last row, whose sign no kink changes: on both
//! sides the equations differ by one column times the normal of the border between them, and the path crosses that border to
//! the same side. For a tangent with K ẋ = −λ̇ ∂R/∂λ it has the sign of λ̇ det K. See E. L. Allgower and K. Georg,
//! *Introduction to Numerical Continuation Methods*, SIAM 2003, chapters 2 and 15. Where the path meets another one, at a
//! bifurcation, the sign does change, but the tangent hardly does.

use super::{LEAVES_TURN, Parameter, Path, Point};

/// Steps below this part of the first one that do not converge are looked at: does the path have a kink there?
const LOOKED_AT: f64 = 1e-4;
/// Cosine of the angle of two tangents that are those of one smooth curve, in so short a step or at a bifurcation.
const SMOOTH: f64 = 0.5;
/// Part of the work of loads along a tangent that is left where the stiffness is another one. From 1 on the load turns back.
const JUMPS: f64 = 0.5;
/// The same part of what that work would be at most: a shape that does not change but by round-off does no work.
const ROUND_OFF: f64 = 1e-6;

impl Path<'_, '_> {
    /// The point beyond a kink that lies within a step of length `step` which has failed, and by how much it has turned against
    /// the one predicted; `None` where there is no kink.
    ///
    /// With the tangents t₁ before and t₂ beyond, the plane across t₁ + t₂ meets the path only beyond the kink.
    pub(super) fn through_kink(&mut self, step: f64) -> Option<(Point, f64)> {
        if self.parameter == Parameter::Load || step > LOOKED_AT * self.first_step {
            return None;
        }
        let here = self.last().clone();
        let first = self.increment(step);
        let mut beyond = self.predict(&first, here.parameter + step);
        let (mut residual, mut rate) = (vec![0.0; here.x.len()], vec![0.0; here.x.len()]);
        self.equilibrium.linearize(beyond.load, &beyond.x, None, &mut residual, &mut rate).ok()?;
        self.equilibrium.solve(beyond.load, &mut rate, true);
        if rate.iter().any(|rate| !rate.is_finite()) {
            return None;
        }
        rate.push(1.0);
        beyond.rate = self.along(rate, None);
        beyond.stability = self.equilibrium.stability();
        // The side with the same sign of λ̇ det K.
        if (here.load_rate() > 0.0) == here.stability?.changes_sign(beyond.stability?) {
            beyond.turn_round();
        }
        let bends = self.cosine(&here.rate, &beyond.rate).min(self.cosine_of_shapes(&here, &beyond)) < SMOOTH;
        let through: Vec<f64> =
            first.iter().zip(&beyond.rate).map(|(first, rate)| first + step * rate).collect();
        if !(bends && self.stiffens(&here, &beyond)) {
            return None;
        }
        self.correct(&through, here.parameter + step, step).ok()
    }

    /// Whether the tangent at `point`, which points to where the step from `before` has led, points back behind a kink within
    /// that step.
    pub(super) fn goes_back(&mut self, before: &Point, point: &Point) -> bool {
        let (Some(from), Some(to)) = (before.stability, point.stability) else { return false };
        let rates = [before.load_rate(), point.load_rate()];
        // At a limit point the sign of λ̇ tells nothing.
        let at_limit = rates[0].abs() <= LEAVES_TURN * rates[1].abs();
        let turns = (rates[0] > 0.0) != (rates[1] > 0.0);
        self.parameter != Parameter::Load
            && !at_limit
            && turns != from.changes_sign(to)
            && self.cosine_of_shapes(before, point) < SMOOTH
            && self.stiffens(before, point)
    }

    /// Whether the stiffness jumps on the way from `before` to `point`, by so much that the load factor has to change to the other
    /// side. The tangent before, with K ẋ = −λ̇ ∂R/∂λ there, leaves no residual where the stiffness is still the same; where it has
    /// become K + ΔK, the work ẋᵀ ΔK ẋ is left of that of the loads, λ̇ ẋᵀ ∂R/∂λ.
    ///
    /// At a bifurcation the stiffness is the same, however uncertain the tangent at `point` is: close to a singular K it may be
    /// round-off, as where load factors change nearly alone.
    fn stiffens(&mut self, before: &Point, point: &Point) -> bool {
        let h = point.parameter - before.parameter;
        let n = self.equilibrium.system().coordinates();
        let load = point.load + h * before.load_rate();
        let mut work_of = |share: f64| {
            let rates = &before.rate[..before.x.len()];
            let increment: Vec<f64> = rates.iter().map(|rate| share * h * rate).collect();
            let mut x = point.x.clone();
            self.equilibrium.retraction.apply(&increment, &mut x);
            self.equilibrium.system().supports().impose(load, &mut x[..n]);
            let mut negative = vec![0.0; x.len()];
            self.equilibrium.residual(load, &x, &mut negative);
            self.equilibrium.system().supports().from_frames(load, &mut negative[..n]);
            let along: f64 = negative.iter().zip(rates).take(n).map(|(force, rate)| force * rate).sum();
            let sizes = [&negative[..n], &rates[..n]].map(|of| of.iter().map(|x| x * x).sum::<f64>());
            [along.abs(), (sizes[0] * sizes[1]).sqrt()]
        };
        let [[left, _], [of_load, most]] = [1.0, 0.0].map(&mut work_of);
        left > JUMPS * of_load && left > ROUND_OFF * most
    }

    /// Cosine of the angle between two tangents.
    fn cosine(&self, a: &[f64], b: &[f64]) -> f64 {
        self.dot(a, b) / (self.dot(a, a) * self.dot(b, b)).sqrt()
    }

    /// The same without load factors; 1 where one of both moves nothing.
    fn cosine_of_shapes(&self, a: &Point, b: &Point) -> f64 {
        let shape = |point: &Point| {
            let mut rate = point.rate.clone();
            if let Some(load) = rate.last_mut() {
                *load = 0.0;
            }
            rate
        };
        let cosine = self.cosine(&shape(a), &shape(b));
        if cosine.is_finite() { cosine } else { 1.0 }
    }
}
