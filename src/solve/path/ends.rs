//! Steps of a path that end where a quantity vanishes, or turns back.

use super::{NoStep, Path, Point, turns_within};
use crate::solve::newton::Failure;

/// Most trials for the length of a step that must end at a target: halving alone needs as many as a
/// number has binary digits.
const MOST_TRIALS: usize = 60;
/// Such a step may miss its target by this many times the tolerance where shorter steps change
/// nothing.
const ROUND_OFFS: f64 = 1e4;
/// A rate that changes its sign within this part of a step jumps there.
const AT_KINK: f64 = 1e-9;
/// A rate that is this part of the larger one at the ends of a step vanishes.
const AT_TURN: f64 = 1e-6;

impl Path<'_, '_> {
    /// Shortens the last step until `miss` of its end vanishes to within `near`, by the secant
    /// method with halved ends (known as Illinois). `miss` must have opposite signs at both ends of
    /// the step.
    ///
    /// # Errors
    /// [`NoStep`] where a shorter step does not converge, or leads to another branch on which
    /// `miss` does not vanish.
    pub fn end_where(&mut self, miss: impl Fn(&Point) -> f64, near: f64) -> Result<&Point, NoStep> {
        self.restoring(|path| {
            path.try_to_end_where(&miss, near, f64::EPSILON)?;
            let Point { load, .. } = *path.last();
            if miss(path.last()).abs() <= ROUND_OFFS * near {
                return Ok(());
            }
            let step = path.history.last().map_or(0.0, |record| record.step);
            let at = path.equilibrium.system().place_of(0);
            Err(NoStep { load, step, failure: Failure::Bifurcation, at })
        })?;
        Ok(self.last())
    }

    /// Calls `shorten`, and makes the last step what it was before where that fails.
    fn restoring(&mut self, shorten: impl FnOnce(&mut Self) -> Result<(), NoStep>) -> Result<(), NoStep> {
        let (whole, record) = (self.last().clone(), self.history.last().cloned());
        let shortened = shorten(self);
        if shortened.is_err() {
            self.points.pop();
            self.points.push(whole);
            self.history.pop();
            self.history.extend(record);
        }
        shortened
    }

    /// Shortens the last step until `miss` vanishes to within `near`, or changes its sign within the part `narrow` of the step.
    fn try_to_end_where(
        &mut self,
        miss: &impl Fn(&Point) -> f64,
        near: f64,
        narrow: f64,
    ) -> Result<(), NoStep> {
        let [.., before, point] = &self.points[..] else { return Ok(()) };
        let mut low = (0.0, miss(before));
        let mut high = (self.history.last().map_or(0.0, |record| record.step), miss(point));
        for _ in 0..MOST_TRIALS {
            let width = high.0 - low.0;
            if miss(self.last()).abs() <= near || width.abs() <= narrow * high.0.abs().max(low.0.abs()) {
                break;
            }
            let mut step =
                (low.0 - low.1 * width / (high.1 - low.1)).clamp(low.0.min(high.0), low.0.max(high.0));
            if self.retake(step).is_err() {
                // At a limit point that is met exactly, no tangent can be factorised.
                step = 0.5 * (step + high.0);
                self.retake(step)?;
            }
            let found = miss(self.last());
            if (found < 0.0) == (high.1 < 0.0) {
                low.1 *= 0.5;
            } else {
                low = high;
            }
            high = (step, found);
        }
        Ok(())
    }

    /// Ends the last step at the limit point within it; returns whether there is one.
    ///
    /// # Errors
    /// As [`Self::end_at_turn`].
    pub fn end_at_limit(&mut self) -> Result<bool, NoStep> {
        let Point { stability, soft, .. } = *self.last();
        let turns = self.end_at_turn(Point::load_rate)?;
        if turns && let Some(limit) = self.points.last_mut() {
            // There the tangent is singular, and its signs are round-off: what changes in the whole step changes here.
            (limit.stability, limit.soft) = (stability, soft);
        }
        Ok(turns)
    }

    /// Ends the last step where `rate`, which its ends have with opposite signs, vanishes; returns whether they have. The
    /// quantity whose rate it is then only grows or only falls in any step, and what it reaches in one is seen at the ends.
    ///
    /// # Errors
    /// [`NoStep`] where a shorter step does not converge; the step is then what it was.
    pub fn end_at_turn(&mut self, rate: impl Fn(&Point) -> f64) -> Result<bool, NoStep> {
        let Some([a, b]) = self.last_two() else { return Ok(false) };
        let ends = [rate(a), rate(b)];
        if !turns_within(ends) {
            return Ok(false);
        }
        let near = AT_TURN * ends[0].abs().max(ends[1].abs());
        self.restoring(|path| {
            path.try_to_end_where(&rate, near, AT_KINK)?;
            // At a kink the rate jumps. The path goes on beyond it.
            let last = rate(path.last());
            if last.abs() > near && (last < 0.0) != (ends[1] < 0.0) {
                let step = path.history.last().map_or(0.0, |record| record.step);
                path.retake(step * (1.0 + 2.0 * AT_KINK))?;
            }
            Ok(())
        })?;
        Ok(true)
    }

    /// Replaces the last step by one of length `step`, if that converges.
    fn retake(&mut self, step: f64) -> Result<(), NoStep> {
        let (point, record) = (self.points.pop(), self.history.pop());
        let increment = self.increment(step);
        match self.correct(&increment, self.last().parameter + step, step) {
            Ok((point, _)) => {
                self.points.push(point);
                Ok(())
            }
            Err((failure, at)) => {
                let load = self.last().load;
                self.points.extend(point);
                self.history.pop();
                self.history.extend(record);
                Err(NoStep { load, step, failure, at })
            }
        }
    }
}
