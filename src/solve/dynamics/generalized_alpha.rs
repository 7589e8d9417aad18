//! The generalised-α method (Chung, Hulbert, *J. Appl. Mech.* 60, 1993, 371–375).
//!
//! Second order; the spectral radius ρ∞ ∈ [0, 1] sets how fast the highest frequencies die out: 1 is the trapezoidal rule,
//! 0 kills them in one step. Equilibrium holds at the end of each step, and an algorithmic acceleration a carries the
//! averaging (Arnold, Brüls, *Multibody Syst. Dyn.* 18, 2007, 185–202):
//!
//! ```text
//! q₁ = q₀ + h v₀ + h² ((½ − β) a₀ + β a₁)      v₁ = v₀ + h ((1 − γ) a₀ + γ a₁)
//! (1 − α_m) a₁ + α_m a₀ = (1 − α_f) q̈₁ + α_f q̈₀
//! α_m = (2ρ∞ − 1)/(ρ∞ + 1)   α_f = ρ∞/(ρ∞ + 1)   γ = ½ − α_m + α_f   β = ¼ (1 − α_m + α_f)²
//! ```
//!
//! # Error of a step
//! a lies (α_m − α_f) h away from q̈ in time, so that the position errs by h³ q⃛ (β + (α_m − α_f)/2 − 1/6) in a step. With
//! h q⃛ ≈ q̈₁ − q̈₀ that is known at no cost; multiplied by (K + cM)⁻¹ cM it leaves out what lies above the step's own
//! frequency and would not be followed anyway.
//!
//! # A tangent for many steps
//! The tangent is kept, turned with the nodes ([`super::turns`]), as long as the increments shrink to 0.6 % and less from one iteration to the next; then it is
//! taken anew at the last equilibrium. A residual costs a third of a tangent with its factorisation and substitution. Where that
//! iteration does not converge, Newton's method with a tangent at every iterate solves the step.

use super::State;
use super::method::Method;
use super::motion::Motion;
use super::turns::Turns;
use crate::linear::{Factor, Singular};
use crate::solve::newton::{self, Equations, Failure, Iterations, Settings};
use crate::trajectory::Statistics;

/// Newton tolerance relative to the displacement in the step and to the absolute tolerance: it counts where steps are very short, for the
/// velocity takes the same relative error.
const RELATIVE_TOLERANCE: f64 = 1e3;
/// The same as a part of the error that a step may make.
const TOLERANCE_OF_ERROR: f64 = 0.02;

/// Rate of convergence beyond which the next step takes a new tangent.
const KEEP: f64 = 0.006;
/// Rate of convergence beyond which the present step does.
const SLOW: f64 = 0.5;
/// Largest correction of a predicted state with a kept tangent.
const LARGEST_CORRECTION: f64 = 0.05;
/// Relative change of the step's length that is none.
const ROUND_OFF: f64 = 1e-6;
/// Most iterations with a kept tangent.
const ITERATIONS: usize = 12;

/// The numbers of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Coefficients {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Coefficients {
    fn new(rho: f64) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let (gamma, beta) = (0.5 - alpha_m + alpha_f, 0.25 * (1.0 - alpha_m + alpha_f).powi(2));
        Self { alpha_m, alpha_f, beta, gamma }
    }
}

/// q̈ and a, and the multipliers that go with them.
#[derive(Clone, Debug)]
struct Accelerations {
    physical: Vec<f64>,
    algorithmic: Vec<f64>,
    multipliers: Vec<f64>,
}

/// The method with its memory.
pub struct GeneralizedAlpha<'a> {
    motion: Motion<'a>,
    coefficients: Coefficients,
    newton_tolerance: f64,
    last: Accelerations,
    trial: Accelerations,
    /// a of the step before the last, and the last step: from them the next a is extrapolated.
    before: Option<(Vec<f64>, f64)>,
    trial_step: f64,
    x: Vec<f64>,
    start: Vec<f64>,
    offset: Vec<f64>,
    acceleration: Vec<f64>,
    increment: Vec<f64>,
    factor: Option<Factor>,
    kept: Option<Kept>,
    turns: Turns,
}

/// The tangent that the factorisation holds.
#[derive(Clone, Debug)]
struct Kept {
    /// Where it was taken.
    at: Vec<f64>,
    /// Of K + cM; 0 before it is factorised.
    c: f64,
    /// How much increments shrink an iteration.
    rate: f64,
}

impl<'a> GeneralizedAlpha<'a> {
    /// The method with spectral radius `rho`; the iteration of a step of fixed length may leave an error of `newton_tolerance` beam lengths.
    pub fn new(motion: Motion<'a>, rho: f64, newton_tolerance: f64) -> Self {
        let (n, unknowns) = (motion.coordinates(), motion.unknowns());
        let last = Accelerations {
            physical: vec![0.0; n],
            algorithmic: vec![0.0; n],
            multipliers: vec![0.0; unknowns - n],
        };
        Self {
            turns: motion.turns(),
            motion,
            coefficients: Coefficients::new(rho),
            newton_tolerance,
            trial: last.clone(),
            last,
            before: None,
            trial_step: 0.0,
            x: vec![0.0; unknowns],
            start: vec![0.0; unknowns],
            offset: vec![0.0; n],
            acceleration: vec![0.0; n],
            increment: vec![0.0; unknowns],
            factor: None,
            kept: None,
        }
    }

    /// Takes the tangent at `at`.
    fn keep(&mut self, at: &[f64], rate: f64) {
        self.motion.tangent_at(at);
        self.kept = Some(Kept { at: at.to_vec(), c: 0.0, rate });
    }

    /// Factorises K + cM, unless that is what is there but for the round-off of the step's length.
    fn factorize(&mut self, c: f64) -> Result<(), Singular> {
        if let Some(kept) = &mut self.kept
            && (kept.c - c).abs() > ROUND_OFF * c
        {
            self.factor = Some(self.motion.factorize(c, self.factor.take())?);
            kept.c = c;
        }
        Ok(())
    }

    /// Solves for `x` with the kept tangent; false where that fails, `x` is then as it was.
    fn solve_with_kept(
        &mut self,
        from: &State,
        c: f64,
        tolerance: f64,
        record: &mut Iterations,
    ) -> Result<bool, Singular> {
        let predicted = self.x.clone();
        let mut fresh = self.kept.as_ref().is_none_or(|kept| kept.rate > KEEP);
        if fresh {
            self.keep(&from.q, 1.0);
        }
        let n = self.motion.coordinates();
        loop {
            self.factorize(c)?;
            let Some(kept) = &self.kept else { return Ok(false) };
            let mut rate = kept.rate;
            self.turns.measure(&kept.at, &self.x[..n]);
            let mut last = 0.0;
            for _ in 0..ITERATIONS {
                for ((a, q), e) in self.acceleration.iter_mut().zip(&self.x).zip(&self.offset) {
                    *a = c.mul_add(*q, *e);
                }
                let residual = self.motion.residual(&self.x, &self.acceleration, &mut self.increment);
                self.turns.back(&mut self.increment[..n]);
                if let Some(factor) = &self.factor {
                    factor.solve(&mut self.increment);
                }
                self.turns.forth(&mut self.increment[..n]);
                self.motion.from_frames(&mut self.increment);
                let size = self.motion.size(&self.increment);
                self.motion.statistics.newton_iterations += 1;
                record.residuals.push(residual);
                record.increments.push(size);
                // Far from the solution there may be another one, and Newton's method finds the nearer of them. Also true for a NaN.
                if !(size <= LARGEST_CORRECTION && residual.is_finite()) {
                    break;
                }
                self.x.iter_mut().zip(&self.increment).for_each(|(x, d)| *x += d);
                if last > 0.0 {
                    rate = size / last;
                }
                if rate < 1.0 && size * rate / (1.0 - rate) <= tolerance {
                    if let Some(kept) = &mut self.kept {
                        kept.rate = rate;
                    }
                    return Ok(true);
                }
                if last > 0.0 && rate > SLOW {
                    break;
                }
                last = size;
            }
            self.x.copy_from_slice(&predicted);
            if fresh {
                self.kept = None;
                return Ok(false);
            }
            self.keep(&from.q, 1.0);
            fresh = true;
        }
    }

    fn solve(
        &mut self,
        from: &State,
        c: f64,
        settings: &Settings,
        record: &mut Iterations,
    ) -> Result<(), Failure> {
        if self.solve_with_kept(from, c, settings.tolerance, record)? {
            return Ok(());
        }
        let mut equations = AtEnd {
            motion: &mut self.motion,
            c,
            offset: &self.offset,
            acceleration: &mut self.acceleration,
            last_increment: &mut self.increment,
            factor: &mut self.factor,
        };
        self.kept = None;
        newton::solve(&mut equations, &mut self.x, &self.start, settings, record)?;
        let n = self.motion.coordinates();
        self.turns.measure(&self.x[..n], &self.x[..n]);
        Ok(())
    }

    /// The local error of the position, filtered by the step's own matrix.
    fn error(&mut self, h: f64, c: f64) -> f64 {
        let Coefficients { alpha_m, alpha_f, beta, .. } = self.coefficients;
        let constant = h * h * (beta + 0.5 * (alpha_m - alpha_f) - 1.0 / 6.0).abs();
        let mut change: Vec<f64> =
            self.trial.physical.iter().zip(&self.last.physical).map(|(b, a)| constant * (b - a)).collect();
        self.motion.to_frames(&mut change);
        let mut error = vec![0.0; self.motion.unknowns()];
        self.motion.multiply_free_mass(c, &change, &mut error);
        let n = change.len();
        self.turns.back(&mut error[..n]);
        if let Some(factor) = &self.factor {
            factor.solve(&mut error);
        }
        self.turns.forth(&mut error[..n]);
        self.motion.distance(&error)
    }
}

/// Equilibrium at the end of a step, with q̈ = c q + e.
struct AtEnd<'s, 'a> {
    motion: &'s mut Motion<'a>,
    c: f64,
    offset: &'s [f64],
    acceleration: &'s mut [f64],
    last_increment: &'s mut [f64],
    factor: &'s mut Option<Factor>,
}

impl AtEnd<'_, '_> {
    fn accelerate(&mut self, x: &[f64]) {
        for ((a, q), e) in self.acceleration.iter_mut().zip(x).zip(self.offset) {
            *a = self.c.mul_add(*q, *e);
        }
    }
}

impl Equations for AtEnd<'_, '_> {
    fn increment(&mut self, x: &[f64], before: &[f64], increment: &mut [f64]) -> Result<f64, Singular> {
        self.motion.statistics.newton_iterations += 1;
        self.accelerate(x);
        let residual = self.motion.linearize(x, before, self.acceleration, increment);
        if !residual.is_finite() {
            // What overflows has no pivots either, but that is not why.
            return Ok(residual);
        }
        let factor = self.motion.factorize(self.c, self.factor.take())?;
        factor.solve(increment);
        *self.factor = Some(factor);
        self.motion.from_frames(increment);
        self.last_increment.copy_from_slice(increment);
        Ok(residual)
    }

    fn residual(&mut self, x: &[f64]) -> f64 {
        self.accelerate(x);
        let mut negative = vec![0.0; x.len()];
        self.motion.residual(x, self.acceleration, &mut negative)
    }

    fn size(&self, increment: &[f64]) -> f64 {
        self.motion.size(increment)
    }
}

impl Method for GeneralizedAlpha<'_> {
    fn order(&self) -> f64 {
        2.0
    }

    fn start(&mut self, state: &State) -> Vec<f64> {
        self.motion.acceleration(&state.q, &mut self.last.physical);
        self.last.algorithmic.copy_from_slice(&self.last.physical);
        self.before = None;
        self.last.physical.clone()
    }

    fn attempt(
        &mut self,
        from: &State,
        h: f64,
        accuracy: Option<f64>,
        to: &mut State,
        record: &mut Iterations,
    ) -> Result<f64, Failure> {
        let Coefficients { alpha_m, alpha_f, beta, gamma } = self.coefficients;
        let n = self.motion.coordinates();
        // q̈ = c q + e from the three formulas above.
        let a_per_q = 1.0 / (beta * h * h);
        let c = (1.0 - alpha_m) / (1.0 - alpha_f) * a_per_q;
        let Accelerations { physical, algorithmic, multipliers } = &self.last;
        for i in 0..n {
            let explicit = from.q[i] + h * (from.v[i] + h * (0.5 - beta) * algorithmic[i]);
            self.offset[i] =
                (alpha_m * algorithmic[i] - alpha_f * physical[i]) / (1.0 - alpha_f) - c * explicit;
            let predicted = match &self.before {
                Some((before, step)) => algorithmic[i] + h / step * (algorithmic[i] - before[i]),
                None => algorithmic[i],
            };
            to.q[i] = explicit;
            self.x[i] = explicit + h * h * beta * predicted;
        }
        self.x[n..].copy_from_slice(multipliers);
        self.start[..n].copy_from_slice(&from.q);
        self.start[n..].copy_from_slice(multipliers);
        self.motion.impose(&mut self.x);
        let moved: Vec<f64> = self.x.iter().zip(&self.start).map(|(x, start)| x - start).collect();
        let tight = self.newton_tolerance * (RELATIVE_TOLERANCE * self.motion.size(&moved)).min(1.0);
        let settings = Settings {
            tolerance: accuracy.map_or(tight, |allowed| (TOLERANCE_OF_ERROR * allowed).max(tight)),
            // The tangent is exact, and inertia makes it well conditioned: the increments tell all.
            residual_tolerance: f64::INFINITY,
            ..Settings::default()
        };
        self.solve(from, c, &settings, record)?;
        self.trial_step = h;
        let Accelerations { algorithmic, .. } = &self.last;
        for (i, before) in algorithmic.iter().enumerate() {
            let a = (self.x[i] - to.q[i]) * a_per_q;
            to.q[i] = self.x[i];
            to.v[i] = from.v[i] + h * ((1.0 - gamma) * before + gamma * a);
            self.trial.physical[i] = c * self.x[i] + self.offset[i];
            self.trial.algorithmic[i] = a;
        }
        self.trial.multipliers.copy_from_slice(&self.x[n..]);
        Ok(if accuracy.is_some() { self.error(h, c) } else { 0.0 })
    }

    fn accept(&mut self) {
        let mut oldest = self.before.take().map_or_else(Vec::new, |(a, _)| a);
        oldest.clone_from(&self.last.algorithmic);
        self.before = Some((oldest, self.trial_step));
        std::mem::swap(&mut self.last, &mut self.trial);
    }

    fn end_accelerations(&mut self, _: &State, _: &State) -> Option<[Vec<f64>; 2]> {
        None
    }

    fn last_increment(&self) -> &[f64] {
        &self.increment
    }

    fn statistics(&mut self) -> &mut Statistics {
        &mut self.motion.statistics
    }

    fn memory(&self) -> Vec<Vec<f64>> {
        let Accelerations { physical, algorithmic, multipliers } = self.last.clone();
        let (before, step) = self.before.clone().unwrap_or_default();
        let kept =
            self.kept.as_ref().map_or((Vec::new(), 0.0, 0.0), |kept| (kept.at.clone(), kept.c, kept.rate));
        vec![physical, algorithmic, multipliers, before, kept.0, vec![step, kept.1, kept.2]]
    }

    fn restore(&mut self, memory: Vec<Vec<f64>>) -> bool {
        let n = self.motion.coordinates();
        let Ok([physical, algorithmic, multipliers, before, at, numbers]) = <[Vec<f64>; 6]>::try_from(memory)
        else {
            return false;
        };
        let fits = |v: &[f64]| v.is_empty() || v.len() == n;
        let required = [physical.len(), algorithmic.len(), multipliers.len(), numbers.len()];
        if required != [n, n, self.motion.unknowns() - n, 3] || !fits(&before) || !fits(&at) {
            return false;
        }
        let [step, c, rate] = [numbers[0], numbers[1], numbers[2]];
        self.last = Accelerations { physical, algorithmic, multipliers };
        self.before = (!before.is_empty()).then_some((before, step));
        if !at.is_empty() {
            self.keep(&at, rate);
            return c == 0.0 || self.factorize(c).is_ok();
        }
        true
    }
}
