//! The generalised-α method (Chung, Hulbert, *J. Appl. Mech.* 60, 1993, 371–375).
//!
//! Second order; the spectral radius ρ∞ ∈ [0, 1] sets how fast the highest frequencies die out: 1
//! is the trapezoidal rule, 0 kills them in one step. Equilibrium holds at the end of each step,
//! and an algorithmic acceleration a carries the averaging (Arnold, Brüls, *Multibody Syst. Dyn.*
//! 18, 2007, 185–202):
//!
//! ```text
//! q₁ = q₀ + h v₀ + h² ((½ − β) a₀ + β a₁)      v₁ = v₀ + h ((1 − γ) a₀ + γ a₁)
//! (1 − α_m) a₁ + α_m a₀ = (1 − α_f) q̈₁ + α_f q̈₀
//! α_m = (2ρ∞ − 1)/(ρ∞ + 1)   α_f = ρ∞/(ρ∞ + 1)   γ = ½ − α_m + α_f   β = ¼ (1 − α_m + α_f)²
//! ```
//!
//! # Error of a step
//! a lies (α_m − α_f) h away from q̈ in time, so that the position errs by h³ q⃛ (β + (α_m − α_f)/2
//! − 1/6) in a step. With h q⃛ ≈ q̈₁ − q̈₀ this estimate costs nothing. The factor (K + cM)⁻¹ cM
//! removes vibrations too fast for the step, which it would not follow anyway. Changes of loads and
//! supports between the ends of the step ([`crate::system::laws`]) are added to the estimate, and
//! corrected for, through the same matrix; also in the parts of a step of fixed length that loads divide.
//!
//! Where a contact begins, ends, or turns, and where a much longer step follows a kink of loads or supports, a is set
//! to the q̈ of the equations of motion. Otherwise it would carry the earlier force into the next steps: a hinged beam on
//! a stiff box erred by 364 times the tolerance, and a pulse of a hundredth of a step gave more than twice its impulse,
//! since a differs from q̈ by what the force changes in the short step, which the long one after it goes on with. Behind
//! every kink of a densely sampled load the method would so lose an order. The q̈ of the formula above would not do,
//! because it rings.
//!
//! # A tangent for many steps
//! The tangent is kept, turned with the nodes ([`super::turns`]), as long as the increments shrink
//! to 0.6 % and less from one iteration to the next; then it is taken anew at the last equilibrium.
//! A residual costs a third of a tangent with its factorisation and substitution. Where that
//! iteration does not converge, Newton's method with a tangent at every iterate solves the step.

use super::State;
use super::memory::{GeneralizedAlphaMemory, Memory, TangentMemory};
use super::method::{Allowed, Method, may_not_see_loads};
use super::motion::{Acceleration, Motion, Rates, StageState, StepMatrix};
use super::turns::Turns;
use crate::assembly::Earlier;
use crate::lanes::Lanes;
use crate::linear::{Factor, NOT_FACTORISED, Singular};
use crate::model::StepControl;
use crate::solve::Statistics;
use crate::solve::newton::{self, Equations, Failure, Iterations, Settings};
use crate::threads;

/// In a step that moves the beam by less than the reciprocal of this, in beam lengths, Newton's
/// tolerance is smaller in proportion to the displacement: the velocity has the same relative
/// error.
const RELATIVE_TOLERANCE: f64 = 10.0;

/// Rate of convergence beyond which the next step takes a new tangent.
const KEEP: f64 = 0.006;
/// Rate of convergence beyond which the present step takes a new tangent.
const SLOW: f64 = 0.5;
/// Largest correction of a predicted state with a kept tangent.
const LARGEST_CORRECTION: f64 = 0.05;
/// Relative change of the step length that is ignored.
const ROUND_OFF: f64 = 1e-6;
/// Where a step follows a kink that is so many times longer than the one before, q̈ takes the place of a.
const LONGER: f64 = 4.0;
/// The acceleration is extrapolated over at most this many lengths of the last step.
const LONGEST: f64 = 4.0;
/// Most iterations with a kept tangent.
const ITERATIONS: usize = 12;

/// The coefficients of the method.
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

impl Accelerations {
    /// q̈ and the multipliers.
    fn rates(&self) -> Vec<f64> {
        self.physical.iter().chain(&self.multipliers).copied().collect()
    }
}

/// The formulas of a step, solved for the rates at its end: q̈ = c q + e, q̇ = d q + o.
#[derive(Clone, Debug, Default)]
struct Rule {
    time: f64,
    c: f64,
    d: f64,
    e: Vec<f64>,
    o: Vec<f64>,
    velocity: Vec<f64>,
}

impl Rule {
    /// The rates at the unknowns `x`; velocities only where forces depend on them.
    fn at(&mut self, x: &[f64], damped: bool) -> Rates<'_> {
        if damped {
            for ((v, q), o) in self.velocity.iter_mut().zip(x).zip(&self.o) {
                *v = self.d.mul_add(*q, *o);
            }
        }
        Rates { time: self.time, v: &self.velocity, a: Acceleration { factor: self.c, rest: &self.e } }
    }
}

/// The method with its memory.
pub struct GeneralizedAlpha<'a> {
    motion: Motion<'a>,
    coefficients: Coefficients,
    newton_tolerance: f64,
    control: StepControl,
    last: Accelerations,
    trial: Accelerations,
    /// a of the step before the last, and the last step: from them the next a is extrapolated.
    before: Option<(Vec<f64>, f64)>,
    trial_step: f64,
    /// Whether the last step ended at a kink.
    passed: bool,
    x: Vec<f64>,
    predicted: Vec<f64>,
    rule: Rule,
    increment: Vec<f64>,
    factor: Option<Factor>,
    kept: Option<FactoredTangent>,
    turns: Turns,
}

/// The tangent that the factorisation holds.
#[derive(Clone, Debug)]
struct FactoredTangent {
    /// Where it was taken: time, positions and velocities.
    time: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    /// The multipliers with which it was taken.
    multipliers: Vec<f64>,
    /// c of the factorised K + cM; 0 before there is one.
    c: f64,
    /// The factor by which an iteration shrinks the increments.
    rate: f64,
}

impl FactoredTangent {
    /// None yet, of states such as `state`.
    fn new(state: &State) -> Self {
        let (q, v) = (state.q.clone(), state.v.clone());
        Self { time: state.time, q, v, multipliers: Vec::new(), c: 0.0, rate: 1.0 }
    }
}

impl<'a> GeneralizedAlpha<'a> {
    /// The method with spectral radius `rho`; the iteration of a step of fixed length may leave an
    /// error of `newton_tolerance` beam lengths.
    pub fn new(motion: Motion<'a>, rho: f64, newton_tolerance: f64, control: StepControl) -> Self {
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
            control,
            trial: last.clone(),
            last,
            before: None,
            trial_step: 0.0,
            passed: false,
            x: vec![0.0; unknowns],
            predicted: vec![0.0; unknowns],
            rule: Rule { e: vec![0.0; n], o: vec![0.0; n], velocity: vec![0.0; n], ..Rule::default() },
            increment: vec![0.0; unknowns],
            factor: None,
            kept: None,
        }
    }

    /// Takes the tangent at `at`.
    fn keep(&mut self, at: &State, multipliers: Vec<f64>, rate: f64) {
        self.motion.tangent_at(at, &multipliers);
        let mut kept = self.kept.take().unwrap_or_else(|| FactoredTangent::new(at));
        (kept.time, kept.multipliers, kept.c, kept.rate) = (at.time, multipliers, 0.0, rate);
        // In the memory of the one before: to clear new memory takes longer than to copy.
        kept.q.copy_from_slice(&at.q);
        kept.v.copy_from_slice(&at.v);
        self.kept = Some(kept);
    }

    /// Factorises K + dD + cM, unless the present factors are those, up to the round-off of the
    /// step length.
    fn factorize(&mut self, c: f64, d: f64) -> Result<(), Singular> {
        if let Some(kept) = &mut self.kept
            && (kept.c - c).abs() > ROUND_OFF * kept.c
        {
            self.factor = Some(self.motion.factorize(c, d, self.factor.take())?);
            kept.c = c;
        }
        Ok(())
    }

    /// Solves for `x` with the kept tangent. Returns false where that fails, with `x` as it was.
    fn solve_with_kept(
        &mut self,
        from: &State,
        tolerance: f64,
        record: &mut Iterations,
    ) -> Result<bool, Singular> {
        let mut fresh = self.kept.as_ref().is_none_or(|kept| kept.rate > KEEP);
        if fresh {
            self.keep(from, self.last.multipliers.clone(), 1.0);
        }
        let (n, damped) = (self.motion.coordinates(), self.motion.needs_velocity());
        let (c, d) = (self.rule.c, self.rule.d);
        loop {
            self.factorize(c, d)?;
            let Some(kept) = &self.kept else { return Ok(false) };
            // The rate of an earlier step may no longer hold: steps of one iteration do not measure
            // it again.
            let mut rate = kept.rate.max(KEEP);
            self.turns.measure(&kept.q, &self.x[..n]);
            let mut last = 0.0;
            for _ in 0..ITERATIONS {
                let rates = self.rule.at(&self.x, damped);
                let residual =
                    self.motion.residual_turned_back(&self.x, rates, &self.turns, &mut self.increment);
                self.factor.as_ref().expect(NOT_FACTORISED).solve(&mut self.increment);
                let size = self.motion.update(&self.turns, &mut self.increment, &mut self.x);
                self.motion.statistics.newton_iterations += 1;
                record.residuals.push(residual);
                record.increments.push(size);
                // After so large a correction there may be several solutions; Newton's method,
                // which finds the nearest, takes over. The negated condition also catches NaN.
                if !(size <= LARGEST_CORRECTION && residual.is_finite()) {
                    break;
                }
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
            self.x.copy_from_slice(&self.predicted);
            if fresh {
                self.kept = None;
                return Ok(false);
            }
            self.keep(from, self.last.multipliers.clone(), 1.0);
            fresh = true;
        }
    }

    fn solve(&mut self, from: &State, settings: &Settings, record: &mut Iterations) -> Result<(), Failure> {
        if self.solve_with_kept(from, settings.tolerance, record)? {
            return Ok(());
        }
        let mut equations = AtEnd {
            motion: &mut self.motion,
            rule: &mut self.rule,
            last_increment: &mut self.increment,
            factor: &mut self.factor,
        };
        self.kept = None;
        let start: Vec<f64> = from.q.iter().chain(&self.last.multipliers).copied().collect();
        let change: Vec<f64> = self.x.iter().zip(&start).map(|(x, start)| x - start).collect();
        let start = Earlier { q: &start, increment: &change };
        newton::solve(&mut equations, &mut self.x, start, settings, record)?;
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
        self.filtered(&mut error)
    }

    /// The size of (K + cM)⁻¹ e.
    fn filtered(&self, e: &mut [f64]) -> f64 {
        self.turns.back(e);
        self.factor.as_ref().expect(NOT_FACTORISED).solve(e);
        self.turns.forth(e);
        self.motion.distance(e)
    }

    /// Corrects `to` for the loads that the ends of a step do not see, as far as the motion can
    /// follow them, so that their effect does not add up. Returns the error that the position would
    /// have without the correction, or has because of motions of supports that the ends do not see.
    fn make_up(&mut self, from: &State, to: &mut State, c: f64) -> f64 {
        let h = to.time - from.time;
        // The moments of a load that varies linearly between the ends.
        let looks = [(from.time, [0.5, 1.0 / 3.0]), (to.time, [0.5, 1.0 / 6.0])];
        let mut error = self.motion.unseen_motion(from.time, to.time, &looks);
        let Some(moments) = self.motion.unseen_loads(from, to.time, &looks) else { return error };
        for (mut force, (unknowns, unit)) in moments.into_iter().zip([(&mut to.v, h), (&mut to.q, h * h)]) {
            error = error.max(c * h * h * self.filtered(&mut force));
            self.motion.from_frames(&mut force);
            unknowns.iter_mut().zip(&force).for_each(|(x, e)| *x -= c * unit * e);
        }
        error
    }
}

/// Coordinates by nodes.
fn by_nodes(coordinates: &[f64]) -> &[[f64; 4]] {
    coordinates.as_chunks().0
}

/// Coordinates by nodes.
fn by_nodes_mut(coordinates: &mut [f64]) -> &mut [[f64; 4]] {
    coordinates.as_chunks_mut().0
}

/// Equilibrium at the end of a step.
struct AtEnd<'s, 'a> {
    motion: &'s mut Motion<'a>,
    rule: &'s mut Rule,
    last_increment: &'s mut [f64],
    factor: &'s mut Option<Factor>,
}

impl Equations for AtEnd<'_, '_> {
    fn increment(&mut self, x: &[f64], earlier: Earlier<'_>, increment: &mut [f64]) -> Result<f64, Singular> {
        self.motion.statistics.newton_iterations += 1;
        let rates = self.rule.at(x, self.motion.needs_velocity());
        let residual = self.motion.linearize(x, earlier, rates, increment);
        if !residual.is_finite() {
            // An overflow leaves no pivots either, but must not be reported as a singular matrix.
            return Ok(residual);
        }
        let factor = self.motion.factorize(self.rule.c, self.rule.d, self.factor.take())?;
        factor.solve(increment);
        *self.factor = Some(factor);
        self.motion.from_frames(increment);
        self.last_increment.copy_from_slice(increment);
        Ok(residual)
    }

    fn residual(&mut self, x: &[f64]) -> f64 {
        let mut negative = vec![0.0; x.len()];
        let rates = self.rule.at(x, self.motion.needs_velocity());
        self.motion.residual(x, rates, &mut negative)
    }

    fn size(&self, increment: &[f64]) -> f64 {
        self.motion.size(increment)
    }
}

impl Method for GeneralizedAlpha<'_> {
    fn order(&self) -> f64 {
        2.0
    }

    fn vibrates(&self) -> bool {
        self.motion.vibrates
    }

    fn start(&mut self, state: &State) -> Result<Vec<f64>, Singular> {
        self.motion.set_accepted(state);
        let unknowns = self.motion.unknowns_of(state);
        self.motion.acceleration(&unknowns, &mut self.last.physical)?;
        self.last.algorithmic.copy_from_slice(&self.last.physical);
        self.last.multipliers.copy_from_slice(self.motion.multipliers());
        self.before = None;
        Ok(self.last.physical.clone())
    }

    fn attempt(
        &mut self,
        state: &State,
        end: f64,
        allowed: Option<Allowed>,
        to: &mut State,
        record: &mut Iterations,
    ) -> Result<f64, Failure> {
        let is_longer = |(_, step): &(Vec<f64>, f64)| LONGER * step < end - state.time;
        if self.passed && self.before.as_ref().is_some_and(is_longer) {
            self.start(state)?;
        }
        self.motion.set_accepted(state);
        if self.motion.remembers() {
            // A kept tangent belongs to the accepted state at which it was taken.
            self.kept = None;
        }
        let Coefficients { alpha_m, alpha_f, beta, gamma } = self.coefficients;
        let n = self.motion.coordinates();
        let start = self.motion.unknowns_of(state);
        let (from, h) = (&*start, end - state.time);
        // q̈ = c q + e and q̇ = d q + o from the three formulas above.
        let a_per_q = 1.0 / (beta * h * h);
        let c = (1.0 - alpha_m) / (1.0 - alpha_f) * a_per_q;
        let d = gamma * h * a_per_q;
        (self.rule.time, self.rule.c, self.rule.d) = (end, c, d);
        let Accelerations { physical, algorithmic, multipliers } = &self.last;
        let (q, v, algorithmic, physical) = (&from.q[..n], &from.v[..n], &algorithmic[..n], &physical[..n]);
        let (e, x) = (&mut self.rule.e[..n], &mut self.x[..n]);
        let (ratio, before) = match &self.before {
            Some((before, step)) if h <= LONGEST * step => (h / step, &before[..n]),
            _ => (0.0, algorithmic),
        };
        let (of_algorithmic, of_physical) = (alpha_m / (1.0 - alpha_f), alpha_f / (1.0 - alpha_f));
        // The known part of the position at the end. It is computed where it is needed, because
        // storing it would cost one more pass over memory.
        let splat = Lanes::splat;
        let known = |q: Lanes, v: Lanes, a: Lanes| q + splat(h) * (v + splat(h * (0.5 - beta)) * a);
        let given = [q, v, algorithmic, physical, before].map(by_nodes);
        threads::each(([e, x].map(by_nodes_mut), given), &|_, ([e, x], given)| {
            let [q, v, algorithmic, physical, before] = given;
            let states = q.iter().zip(v).zip(algorithmic).zip(physical).zip(before);
            for ((e, x), ((((q, v), a), physical), before)) in e.iter_mut().zip(x).zip(states) {
                let [q, v, a, physical, before] = [q, v, a, physical, before].map(|of| Lanes::new(*of));
                let known = known(q, v, a);
                let rest = splat(of_algorithmic) * a - splat(of_physical) * physical - splat(c) * known;
                *e = rest.to_array();
                let extrapolated = a + splat(ratio) * (a - before);
                *x = (known + splat(h * h * beta) * extrapolated).to_array();
            }
        });
        if self.motion.needs_velocity() {
            let o = &mut self.rule.o[..n];
            for i in 0..n {
                let a = algorithmic[i];
                let known = q[i] + h * (v[i] + h * (0.5 - beta) * a);
                o[i] = v[i] + h * (1.0 - gamma) * a - d * known;
            }
        }
        self.x[n..].copy_from_slice(multipliers);
        self.motion.impose(end, &mut self.x);
        self.predicted.copy_from_slice(&self.x);
        let moved = self.motion.size_of_change(&from.q, &self.x);
        let tight = self.newton_tolerance * (RELATIVE_TOLERANCE * moved).min(1.0);
        let one_sided = self.motion.keeps_lengths();
        let settings = Settings {
            tolerance: allowed.map_or(tight, |allowed| allowed.of_iteration(one_sided).max(tight)),
            // The tangent is exact, and inertia makes it well conditioned: the increments alone
            // tell convergence.
            residual_tolerance: f64::INFINITY,
            ..Settings::default()
        };
        self.solve(from, &settings, record)?;
        self.trial_step = h;
        let (q, v, e, x) = (&from.q[..n], &from.v[..n], &self.rule.e[..n], &self.x[..n]);
        let (last, now) = (&self.last.algorithmic[..n], &mut self.trial.algorithmic[..n]);
        let (to_q, to_v, physical) = (&mut to.q[..n], &mut to.v[..n], &mut self.trial.physical[..n]);
        let written = [&mut *now, to_q, to_v, &mut *physical].map(by_nodes_mut);
        let given = [q, v, e, x, last].map(by_nodes);
        threads::each((written, given), &|_, ([now, to_q, to_v, physical], [q, v, e, x, last])| {
            let written = now.iter_mut().zip(to_q).zip(to_v).zip(physical);
            let states = q.iter().zip(v).zip(e).zip(x).zip(last);
            for ((((now, to_q), to_v), physical), ((((q, v), e), x), last)) in written.zip(states) {
                let [q, v, e, x, last] = [q, v, e, x, last].map(|of| Lanes::new(*of));
                let a = (x - known(q, v, last)) * splat(a_per_q);
                *now = a.to_array();
                *to_q = x.to_array();
                *to_v = (v + splat(h) * (splat(1.0 - gamma) * last + splat(gamma) * a)).to_array();
                *physical = (splat(c) * x + e).to_array();
            }
        });
        self.motion.release(now);
        self.motion.release(physical);
        self.trial.multipliers.copy_from_slice(&self.x[n..]);
        to.time = end;
        let unseen = if may_not_see_loads(self.control, h) { self.make_up(state, to, c) } else { 0.0 };
        self.motion.carry(to);
        let Self { motion, factor, turns, .. } = self;
        let factor = factor.as_ref().expect(NOT_FACTORISED);
        let solve = |change: &mut [f64]| {
            turns.back(change);
            factor.solve(change);
            turns.forth(change);
        };
        motion.project(to, &StepMatrix { inertia: c, step: h, solve })?;
        Ok(if allowed.is_some() { self.error(h, c) + unseen } else { 0.0 })
    }

    fn accept(&mut self) {
        self.passed = false;
        let n = self.motion.coordinates();
        let oldest = self.before.take().map_or_else(|| vec![0.0; n], |(a, _)| a);
        std::mem::swap(&mut self.last, &mut self.trial);
        let before = std::mem::replace(&mut self.trial.algorithmic, oldest);
        self.before = Some((before, self.trial_step));
    }

    fn pass(&mut self, before: f64, state: &mut State) -> Result<Vec<f64>, Singular> {
        let jump = self.motion.pass(before, state)?;
        let n = self.motion.coordinates();
        let Accelerations { physical, algorithmic, multipliers } = &mut self.last;
        let before = self.before.iter_mut().map(|(before, _)| before);
        for acceleration in [physical, algorithmic].into_iter().chain(before) {
            acceleration.iter_mut().zip(&jump).for_each(|(a, jump)| *a += jump);
        }
        multipliers.iter_mut().zip(&jump[n..]).for_each(|(mu, jump)| *mu += jump);
        self.passed = true;
        Ok(jump)
    }

    fn renew(&mut self, state: &State) -> Result<(), Singular> {
        self.start(state).map(|_| ())
    }

    fn end_accelerations(&mut self, _: &State, _: &State) -> Option<[Vec<f64>; 2]> {
        None
    }

    fn stages(&self, from: &State, to: &State) -> Vec<StageState> {
        let stage = |state: &State, accelerations: &Accelerations| StageState {
            state: self.motion.unknowns_of(state).into_owned(),
            rates: accelerations.rates(),
        };
        vec![stage(from, &self.last), stage(to, &self.trial)]
    }

    fn end_rates(&self) -> Vec<f64> {
        self.last.rates()
    }

    fn last_increment(&self) -> &[f64] {
        &self.increment
    }

    fn statistics(&mut self) -> &mut Statistics {
        &mut self.motion.statistics
    }

    fn memory(&self) -> Memory {
        let Accelerations { physical, algorithmic, multipliers } = self.last.clone();
        let (tangent, c) =
            self.kept.clone().map_or((None, 0.0), |FactoredTangent { time, q, v, multipliers, c, rate }| {
                (Some(TangentMemory { time, q, v, multipliers, rate }), c)
            });
        Memory::GeneralizedAlpha(GeneralizedAlphaMemory {
            physical,
            algorithmic,
            multipliers,
            before: self.before.clone(),
            passed: self.passed,
            tangent,
            factorized: [c, self.rule.d],
        })
    }

    fn restore(&mut self, memory: Memory) -> bool {
        let Memory::GeneralizedAlpha(memory) = memory else { return false };
        let GeneralizedAlphaMemory {
            physical,
            algorithmic,
            multipliers,
            before,
            passed,
            tangent,
            factorized,
        } = memory;
        let (n, m) = (self.motion.coordinates(), self.motion.unknowns() - self.motion.coordinates());
        if [physical.len(), algorithmic.len(), multipliers.len()] != [n, n, m]
            || before.as_ref().is_some_and(|(before, _)| before.len() != n)
            || tangent.as_ref().is_some_and(|t| [t.q.len(), t.v.len(), t.multipliers.len()] != [n, n, m])
        {
            return false;
        }
        let [c, d] = factorized;
        self.last = Accelerations { physical, algorithmic, multipliers };
        (self.before, self.passed) = (before, passed);
        self.rule.d = d;
        let Some(TangentMemory { time, q, v, multipliers, rate }) = tangent else { return true };
        self.keep(&State { time, q, v, ..State::default() }, multipliers, rate);
        c == 0.0 || self.factorize(c, d).is_ok()
    }
}
