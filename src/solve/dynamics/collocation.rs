//! Collocation by Gauss' and Radau's methods for M q̈ + f(q) = 0.
//!
//! Applied to (q, v), the stages are Q_i = q₀ + c_i h v₀ + Y_i with Y = h² A² Q̈, so that with the
//! displacements Y as unknowns
//!
//! ```text
//! h⁻² Σ_j (A⁻²)_ij M Y_j + f(q₀ + c_i h v₀ + Y_i) = 0
//! q₁ = q₀ + h v₀ + bᵀA⁻¹ Y,   v₁ = v₀ + h⁻¹ bᵀA⁻² Y
//! ```
//!
//! Newton's method with one tangent K for all stages turns, by A⁻¹ = T Λ T⁻¹, into one system
//! (ζ²/h² M + K) w = r for each eigenvalue ζ of A⁻¹: a real one and a complex one for three stages,
//! both as banded as K is (Butcher, *BIT* 16, 1976, 237–240; Bickart). It converges linearly, at a
//! rate that depends on the change of K within the step.
//!
//! # The tangent turns with the nodes
//! K changes mostly because the beam rotates. The tangent is therefore taken at the start of the
//! step, where the axial force is right (at a predicted state a large EA makes it meaningless), and
//! turned with the nodes to each stage ([`super::turns`]). This takes a third fewer iterations than
//! the tangent at the mean of the stages. Anderson's acceleration was left out: it saved another
//! tenth of the iterations, but no failure.
//!
//! # A tangent for many steps
//! Where steps are chosen by a tolerance, the tangent and its factors are kept, turned with the
//! nodes, as long as the step length stays the same and every iteration shrinks the increments to a
//! twentieth or less. A tangent with its factors costs as much as two iterations. If a kept tangent
//! turns out to be slow, a new one is taken at the start of the step, and if that is slow too, at
//! the mean of the stages. With Radau's method and a tolerance of 3e-5 a solution thus costs a
//! quarter less. It does not pay to factorise a kept tangent for another step length, or to keep it
//! over steps of given length, whose stages are solved almost to round-off: either costs as many
//! iterations as it saves.
//!
//! # Predicted stages
//! The first step is predicted by the initial acceleration. Under a load that sets in suddenly this
//! would carry a node of a fine mesh across many elements. If the iteration then diverges, all
//! nodes are predicted by their mean acceleration, that of a rigid flight.
//!
//! Later steps continue the polynomial of the last step's accelerations. Where steps are chosen by
//! a tolerance, they use either this polynomial or the mean of the accelerations, whichever would
//! have come closer to the last stage of the last step: Gauss' methods do not damp vibrations that
//! are too fast to be followed, and a polynomial would continue their accelerations to a hundred
//! times their size. Steps of given length always use the polynomial, because the choice would save
//! a tenth of the iterations in pendulums but cost half as many again in small damped vibrations.
//!
//! # Gauss' methods with a tolerance
//! The ends of their steps are damped; how and why stands in `collocation/damping.rs`.
//!
//! # Error of a step
//! The polynomial of the stage accelerations is compared with the acceleration at the start, where
//! it has no node. Its defect δ = q̈(t₀) − Σ ℓ_j(0) Q̈_j = O(hˢ), applied through the step's own
//! matrix, e = (γ²/h² M + K)⁻¹ M δ = O(hˢ⁺²), does not see vibrations too fast to be followed
//! (Hairer & Wanner do the same for Radau IIA).
//!
//! The step itself is of higher order p. For a vibration of frequency ω and any amplitude, F
//! multiplies e by (ω h/γ)², so that |e| (|F e|/|e|)^{(p − 1 − s)/2} is O(h^{p+1}) and proportional
//! to the step's error; a factor of a tenth suits all methods. In place of F e, F (1 − F) e is
//! used, because motions too fast to be followed are lost only once, so that their error does not
//! add up. Rigid rotation and flight involve little stiffness: their error is modelled as the power
//! of |e| that is O(h^{p+1}). The larger of the two counts.
//!
//! Changes of loads and supports between the stages, which the stages do not see
//! ([`crate::system::laws`]), are added to the error through the same matrix. The mean and first
//! moment of the unseen loads are also applied to the end of the step, because a load that is
//! sampled always in the same phase would push the same way in every step; so they are in the parts of
//! a step of fixed length that loads divide.

mod damping;

use super::State;
use super::memory::{CollocationMemory, Memory, TangentMemory};
use super::method::{Allowed, Method, may_not_see_loads};
use super::motion::{Acceleration, Motion, Rates, StageState, StepMatrix};
use super::stages::{self, Mixture, Stages};
use super::tableau::{Block, Tableau};
use super::turns::Turns;
use crate::lanes::Lanes;
use crate::linear::complex::ComplexFactor;
use crate::linear::{Factor, NOT_FACTORISED, Singular};
use crate::model::StepControl;
use crate::solve::Statistics;
use crate::solve::equilibrium::larger;
use crate::solve::newton::{Failure, Iterations};
use crate::system::laws::LoadSample;
use nalgebra::{Complex, DMatrix, RowDVector};

/// Tolerance of the stages in steps of given length, relative to the displacement in the step; the
/// velocity has the same relative error.
const TOLERANCE: f64 = 1e-11;
/// Factor between the error of a vibration in a step and its estimate from the defect.
const ERROR_OF_DEFECT: f64 = 0.1;
/// Smallest tolerance of the stages in beam lengths: without it a beam that nothing moves yet would
/// be solved to the round-off of zero.
const REST: f64 = 1e-26;
/// Increments that no longer shrink count as converged below this size: they are round-off.
const ROUND_OFF: f64 = 1e-8;
/// Increments in beam lengths beyond which an iteration has diverged; smaller ones may be
/// round-off.
const FAR: f64 = 1.0;
/// Most iterations of a step.
const ITERATIONS: usize = 25;
/// Rate of convergence beyond which the present step takes a new tangent.
const SLOW: f64 = 0.4;
/// Rate of convergence beyond which the next step takes a new tangent.
const KEEP: f64 = 0.05;
/// A step that could grow by less than this factor keeps its length.
const LEAST_GROWTH: f64 = 1.2;
/// The polynomial of the last step is continued over at most this many of its lengths. Farther out
/// it would be meaningless, as after a short step before a kink of a load.
const LONGEST: f64 = 4.0;
/// Relative change of the step length that is ignored.
const SAME_STEP: f64 = 1e-6;

/// A tangent K with the factors of the transformed systems.
struct FactoredTangent {
    /// Where it was taken.
    at: State,
    /// The multipliers with which it was taken.
    multipliers: Vec<f64>,
    /// The step h of ζ²/h² M + K.
    step: f64,
    /// The factors of ζ²/h² M + K, one for each block of the tableau.
    factors: Vec<BlockFactor>,
    /// How much an iteration of the last step shrank the increments.
    rate: f64,
}

impl FactoredTangent {
    /// The real part of (ζ²/h² M + K)⁻¹ `factor` e for the ζ of a block, in the supports' frames, with the tangent turned.
    fn solve_turned(&self, block: usize, turns: &Turns, factor: Complex<f64>, e: &mut [f64]) {
        turns.back(e);
        match &self.factors[block] {
            BlockFactor::Real(matrix) => {
                matrix.solve(e);
                e.iter_mut().for_each(|e| *e *= factor.re);
            }
            BlockFactor::Complex(matrix) => {
                let mut imaginary: Vec<f64> = e.iter().map(|e| factor.im * e).collect();
                e.iter_mut().for_each(|e| *e *= factor.re);
                matrix.solve(e, &mut imaginary);
            }
        }
        turns.forth(e);
    }
}

/// When the tangent of a step was taken.
#[derive(Clone, Copy, PartialEq)]
enum TangentAge {
    /// In an earlier step.
    Before,
    /// At the start of this one.
    AtStart,
    /// At the mean of its stages.
    AtMean,
}

/// A factorised ζ²/h² M + K.
enum BlockFactor {
    Real(Factor),
    Complex(ComplexFactor),
}

/// The method with its memory.
pub struct Collocation<'a> {
    motion: Motion<'a>,
    tableau: Tableau,
    control: StepControl,
    /// Q̈_i of the last accepted step, its multipliers, and its length.
    accelerations: Vec<Lanes>,
    multipliers: Vec<Lanes>,
    last_step: f64,
    /// Whether the iteration of the last attempt diverged.
    astray: bool,
    /// Whether something may move on as a whole: what is not one beam with a pin.
    drifts: bool,
    trial_step: f64,
    /// When the last attempt ends; loads and supports are evaluated no later.
    end: f64,
    kept: Option<FactoredTangent>,
    /// Whether a polynomial predicts the stages better than a mean.
    smooth: bool,
    acceleration: Vec<f64>,
    stages: Stages,
    transformed: Vec<Vec<f64>>,
    increment: Vec<f64>,
    /// Turns of the nodes since the tangent was taken.
    turns: Turns,
}

impl<'a> Collocation<'a> {
    /// The method of a tableau.
    pub fn new(motion: Motion<'a>, tableau: Tableau, control: StepControl) -> Self {
        let (n, unknowns, s) = (motion.coordinates(), motion.unknowns(), tableau.stages());
        Self {
            accelerations: vec![Lanes::ZERO; n],
            multipliers: vec![Lanes::ZERO; unknowns - n],
            last_step: 0.0,
            astray: false,
            drifts: motion.system().beams().len() > 1 || !motion.system().supports().pin(),
            trial_step: 0.0,
            end: 0.0,
            kept: None,
            smooth: true,
            acceleration: vec![0.0; n],
            transformed: vec![vec![0.0; unknowns]; s],
            increment: vec![0.0; unknowns],
            turns: motion.turns(),
            stages: motion.stages(),
            motion,
            tableau,
            control,
        }
    }

    /// The matrix that predicts Y_i from the accelerations of the last step, by continuing their
    /// polynomial or by their mean.
    fn extrapolation(&self, h: f64, smooth: bool) -> DMatrix<f64> {
        let Tableau { nodes, a_squared, weights, .. } = &self.tableau;
        let (ratio, shift) = if self.last_step > 0.0 { (h / self.last_step, 1.0) } else { (0.0, 0.0) };
        let continued = nodes.iter().map(|c| {
            let at = if smooth && ratio <= LONGEST {
                self.tableau.lagrange(shift + ratio * c)
            } else {
                weights.clone()
            };
            RowDVector::from_vec(at)
        });
        a_squared * DMatrix::from_rows(&continued.collect::<Vec<_>>()) * (h * h)
    }

    /// Predicts the displacements of all stages; the multipliers are those of the last accepted step,
    /// because an attempt that failed leaves numbers of any size.
    fn predict(&mut self, from: &State, h: f64) {
        let mixture = Mixture::new(&self.extrapolation(h, self.smooth), 1.0);
        let (displacement, multipliers) = self.stages.displacement.split_at_mut(self.motion.coordinates());
        displacement.iter_mut().zip(&self.accelerations).for_each(|(y, a)| *y = mixture.of(*a));
        self.motion.release(displacement);
        multipliers.copy_from_slice(&self.multipliers);
        self.place(from, h);
    }

    /// Predicts stages by the mean acceleration of all nodes.
    fn predict_as_a_whole(&mut self, from: &State, h: f64) {
        let mixture = Mixture::new(&self.extrapolation(h, self.smooth), 1.0);
        let nodes = self.accelerations.len() / 4;
        let mean = [0, 1].map(|axis| {
            let sum = self.accelerations.iter().skip(axis).step_by(4).fold(Lanes::ZERO, |sum, a| sum + *a);
            mixture.of(sum * Lanes::splat(1.0 / nodes as f64))
        });
        let displacement = &mut self.stages.displacement[..4 * nodes];
        for node in displacement.chunks_exact_mut(4) {
            node.copy_from_slice(&[mean[0], mean[1], Lanes::ZERO, Lanes::ZERO]);
        }
        self.motion.release(displacement);
        self.place(from, h);
    }

    /// Q_i from Y_i.
    fn place(&mut self, from: &State, h: f64) {
        self.stages.place(from, self.in_lanes(|i| self.tableau.nodes[i] * h));
    }

    /// By how much a prediction would have missed the last stage of the last attempt: with the
    /// polynomial and with the mean.
    fn misses(&mut self) -> [f64; 2] {
        let last = self.tableau.stages() - 1;
        let rows =
            [true, false].map(|smooth| self.extrapolation(self.trial_step, smooth).row(last).into_owned());
        let mixture = Mixture::new(&DMatrix::from_rows(&rows), 1.0);
        let Stages { residual: difference, displacement, .. } = &mut self.stages;
        for ((d, y), a) in difference.iter_mut().zip(&*displacement).zip(&self.accelerations) {
            *d = mixture.of(*a) - Lanes::splat(y.to_array()[last]);
        }
        let [smooth, mean, ..] = self.motion.sizes(difference);
        [smooth, mean]
    }

    /// The scaled multipliers of the last stage.
    fn multipliers(&self) -> Vec<f64> {
        stages::lane(&self.stages.displacement[self.motion.coordinates()..], self.tableau.stages() - 1)
    }

    /// Factorises the transformed systems with the tangent at `at` for steps of length `h`.
    fn linearize(&mut self, at: &State, multipliers: Vec<f64>, h: f64) -> Result<(), Singular> {
        let mut earlier = self.kept.take().map(|kept| kept.factors).unwrap_or_default().into_iter();
        self.motion.tangent_at(at, &multipliers);
        let mut factors = Vec::with_capacity(self.tableau.blocks.len());
        for block in &self.tableau.blocks {
            let factor = match (block, earlier.next()) {
                (Block::Real { gamma, .. }, earlier) => {
                    let earlier =
                        if let Some(BlockFactor::Real(factor)) = earlier { Some(factor) } else { None };
                    BlockFactor::Real(self.motion.factorize((gamma / h).powi(2), gamma / h, earlier)?)
                }
                (Block::Complex { zeta, .. }, earlier) => {
                    let earlier =
                        if let Some(BlockFactor::Complex(factor)) = earlier { Some(factor) } else { None };
                    BlockFactor::Complex(self.motion.factorize_complex(zeta / h, earlier)?)
                }
            };
            factors.push(factor);
        }
        self.kept = Some(FactoredTangent { at: at.clone(), multipliers, step: h, factors, rate: 1.0 });
        Ok(())
    }

    /// Measures the turn of every node from where the tangent was taken to each stage.
    fn turn(&mut self) {
        let FactoredTangent { at, .. } = self.kept.as_ref().expect(NOT_FACTORISED);
        self.stages.measure_turns(&at.q);
    }

    /// Time of a stage of the attempt.
    fn time(&self, from: &State, stage: usize) -> f64 {
        (self.tableau.nodes[stage] * (self.end - from.time) + from.time).min(self.end)
    }

    /// One number for every stage; lanes beyond the last stage repeat it.
    fn in_lanes(&self, of: impl Fn(usize) -> f64) -> Lanes {
        let last = self.tableau.stages() - 1;
        Lanes::new(std::array::from_fn(|lane| of(lane.min(last))))
    }

    /// The mean of the stages.
    fn mean(&self, from: &State, h: f64) -> State {
        let s = self.tableau.stages();
        let of = |x: &Lanes| x.to_array()[..s].iter().sum::<f64>() / s as f64;
        let q = self.stages.x[..from.q.len()].iter().map(of).collect();
        State { time: from.time + 0.5 * h, q, v: from.v.clone(), ..State::default() }
    }

    /// One iteration; returns the scaled increment and residual.
    fn iterate(&mut self, from: &State, h: f64) -> (f64, f64) {
        let s = self.tableau.stages();
        let acceleration = Mixture::new(&self.tableau.inverse_squared, (h * h).recip());
        self.stages.move_on(from, &acceleration, &Mixture::new(&self.tableau.inverse, h.recip()));
        let times = self.in_lanes(|i| self.time(from, i)).to_array();
        let residual = self.motion.residuals(times, s, &mut self.stages);
        self.stages
            .take_apart(&Mixture::new(&self.tableau.inverse_transformation, -1.0), &mut self.transformed);
        let FactoredTangent { factors, .. } = self.kept.as_ref().expect(NOT_FACTORISED);
        for (block, factor) in self.tableau.blocks.iter().zip(factors) {
            match (block, factor) {
                (Block::Real { row, .. }, BlockFactor::Real(factor)) => {
                    factor.solve(&mut self.transformed[*row])
                }
                (Block::Complex { row, .. }, BlockFactor::Complex(factor)) => {
                    let (re, im) = self.transformed.split_at_mut(row + 1);
                    factor.solve(&mut re[*row], &mut im[0]);
                }
                (Block::Real { .. }, BlockFactor::Complex(_))
                | (Block::Complex { .. }, BlockFactor::Real(_)) => {
                    unreachable!("a block's factor is of the block's kind")
                }
            }
        }
        self.stages.put_together(&Mixture::new(&self.tableau.transformation, 1.0), &self.transformed);
        self.motion.from_frames(&mut self.stages.residual);
        let size = self.motion.sizes(&self.stages.residual).into_iter().fold(0.0, larger);
        self.stages.advance();
        self.place(from, h);
        self.motion.statistics.newton_iterations += 1;
        (size, residual)
    }

    fn solve_stages(
        &mut self,
        from: &State,
        h: f64,
        tolerance: f64,
        keep: bool,
        record: &mut Iterations,
    ) -> Result<(), Failure> {
        let last_rate = self.kept.as_ref().map_or(1.0, |kept| kept.rate);
        let fits = |kept: &FactoredTangent| kept.rate <= KEEP && (kept.step - h).abs() <= SAME_STEP * h;
        let mut tangent = TangentAge::Before;
        if !(keep && self.kept.as_ref().is_some_and(fits)) {
            // Taken at the converged start of the step: with a large EA the axial force of a
            // predicted state is wrong.
            self.linearize(from, self.multipliers(), h)?;
            tangent = TangentAge::AtStart;
        }
        self.turn();
        // Sizes of the last two increments with the present tangent. Rates alternate, so that their
        // mean over two iterations tells more than one of them.
        let mut last = [0.0_f64; 2];
        // The error after the first increment is estimated with the rate of the last step. It has a
        // lower bound, because steps of one iteration do not measure the rate again.
        let mut rate = last_rate.clamp(if keep { KEEP } else { 0.01 }, 1.0);
        for iteration in 0..ITERATIONS {
            let (size, residual) = self.iterate(from, h);
            record.increments.push(size);
            record.residuals.push(residual);
            let finite = size.is_finite() && residual.is_finite();
            if !finite && tangent != TangentAge::Before {
                return Err(Failure::NotFinite);
            }
            if last[1] > 0.0 {
                rate = if last[0] > 0.0 { (size / last[0]).sqrt() } else { size / last[1] };
            }
            let stalled = last[1] > 0.0 && rate > 0.5 && size <= ROUND_OFF;
            // The accelerations with which a motion starts shake short cells by the last digits of their positions. The
            // first increment takes that away, and tells nothing of how fast the rest falls.
            let told = self.last_step > 0.0 || iteration >= 2 || size <= tolerance;
            if size == 0.0 || stalled || (told && rate < 1.0 && size * rate / (1.0 - rate) <= tolerance) {
                if let Some(kept) = &mut self.kept {
                    kept.rate = rate;
                }
                return Ok(());
            }
            let left = (ITERATIONS - 1 - iteration) as i32;
            let hopeless = rate >= 0.95 || size * rate.powi(left) / (1.0 - rate) > tolerance;
            let known = last[0] > 0.0 && iteration >= 4;
            let slow = rate > SLOW || hopeless;
            last = [last[1], size];
            match tangent {
                TangentAge::Before if !finite || (last[0] > 0.0 && slow) => {
                    if !(finite && rate < 1.0) {
                        self.predict(from, h);
                    }
                    self.linearize(from, self.multipliers(), h)?;
                    tangent = TangentAge::AtStart;
                }
                TangentAge::AtStart if known && slow => {
                    let mean = self.mean(from, h);
                    self.linearize(&mean, self.multipliers(), h)?;
                    tangent = TangentAge::AtMean;
                }
                TangentAge::AtMean if known && hopeless => return Err(Failure::Diverging { last: size }),
                _ => continue,
            }
            self.turn();
            last = [0.0; 2];
        }
        Err(Failure::TooSlow { iterations: ITERATIONS, last: last[1] })
    }

    /// The defect of the polynomial of accelerations at `x` (0: start, 1: end of the step), where
    /// the state is `state`, through the step's own matrix: (ζ²/h² M + K)⁻¹ M (q̈ − Σ ℓ_j(x) Q̈_j),
    /// in fixed axes; then also |ζ|²/h², or 0 with two stages. The polynomial's value is left in
    /// `self.acceleration`.
    fn defect(&mut self, x: f64, state: &State) -> (Vec<f64>, f64) {
        let n = self.motion.coordinates();
        let h = self.trial_step;
        self.polynomial(x);
        // −M Σ ℓ_j(x) Q̈_j − f(q) − Bᵀ Σ ℓ_j(x) μ_j is M times the defect but for forces of supports and constraints, which
        // the solution removes: it removes small ones only, because its rows are those of an earlier state.
        let shares = self.tableau.lagrange(x);
        let multiplier =
            |stages: &Lanes| shares.iter().zip(stages.to_array()).map(|(share, mu)| share * mu).sum::<f64>();
        let mut unknowns = state.q.clone();
        unknowns.extend(self.stages.displacement[n..].iter().map(multiplier));
        let mut e = vec![0.0; self.motion.unknowns()];
        let a = Acceleration::constant(&self.acceleration);
        let rates = Rates { time: state.time, v: &state.v, a };
        self.motion.residual(&unknowns, rates, &mut e);
        e[n..].fill(0.0);
        let square = self.filter(state, &mut e);
        e.truncate(n);
        (e, if self.tableau.stages() == 2 { 0.0 } else { square / (h * h) })
    }

    /// The real block of the stage system, or its only one.
    fn leading_block(&self) -> usize {
        self.tableau.blocks.iter().position(|block| matches!(block, Block::Real { .. })).unwrap_or(0)
    }

    /// ζ of the leading block.
    fn eigenvalue(&self) -> Complex<f64> {
        match &self.tableau.blocks[self.leading_block()] {
            Block::Real { gamma, .. } => Complex::new(*gamma, 0.0),
            Block::Complex { zeta, .. } => *zeta,
        }
    }

    /// The real part of (ζ²/h² M + K)⁻¹ `factor` e, in the supports' frames, with the tangent
    /// turned as `self.turns` says.
    fn solve_turned(&self, factor: Complex<f64>, e: &mut [f64]) {
        self.kept.as_ref().expect(NOT_FACTORISED).solve_turned(self.leading_block(), &self.turns, factor, e);
    }

    /// (ζ²/h² M + K)⁻¹ e in the state `state`, from the supports' frames into fixed axes; returns
    /// |ζ|².
    fn filter(&mut self, state: &State, e: &mut [f64]) -> f64 {
        self.turn_to(state);
        self.solve_turned(Complex::new(1.0, 0.0), e);
        self.motion.from_frames(e);
        self.eigenvalue().norm_sqr()
    }

    /// Takes the turns of the nodes from where the tangent was taken to the state `state`.
    fn turn_to(&mut self, state: &State) {
        let FactoredTangent { at, .. } = self.kept.as_ref().expect(NOT_FACTORISED);
        self.turns.measure(&at.q, &state.q);
    }

    /// The error of the position in the step from `from`.
    fn error(&mut self, from: &State, h: f64) -> f64 {
        let (order, s) = (self.tableau.order, self.tableau.stages() as f64);
        let (mut defect, _) = self.defect(0.0, from);
        let size = self.motion.distance(&defect);
        let free = size.powf((order + 1.0) / (s + 2.0));
        if size == 0.0 || order == s + 1.0 {
            return free;
        }
        defect.resize(self.motion.unknowns(), 0.0);
        self.motion.to_frames(&mut defect);
        let mut defect = self.slow(h, &defect);
        self.keep_fast(h, &mut defect);
        self.motion.from_frames(&mut defect);
        let fast = self.motion.distance(&defect) / size;
        free.max(ERROR_OF_DEFECT * size * fast.powf(0.5 * (order - 1.0 - s)))
    }

    /// Corrects `to` for the loads that the stages do not see, as far as the motion can follow
    /// them, so that their effect does not add up. Returns the error that the position would have
    /// without the correction, or has because of motions of supports that the stages do not see.
    /// `state` is the start of the step in fixed axes, `from` its unknowns.
    fn make_up(&mut self, state: &State, from: &State, to: &mut State) -> f64 {
        let h = self.end - from.time;
        let Tableau { nodes, weights, .. } = &self.tableau;
        let pairs = nodes.iter().zip(weights).enumerate();
        let looks: Vec<LoadSample> =
            pairs.map(|(i, (c, b))| (self.time(from, i), [*b, b * (1.0 - c)])).collect();
        let mut error = self.motion.unseen_motion(from.time, self.end, &looks);
        let Some(moments) = self.motion.unseen_loads(state, self.end, &looks) else { return error };
        for (mut force, (unknowns, unit)) in
            moments.into_iter().zip([(&mut to.v, h.recip()), (&mut to.q, 1.0)])
        {
            self.turn_to(from);
            self.solve_turned(self.eigenvalue().powi(2), &mut force);
            self.motion.from_frames(&mut force);
            error = error.max(self.motion.distance(&force));
            unknowns.iter_mut().zip(&force).for_each(|(x, e)| *x -= unit * e);
        }
        error
    }

    /// The error of the position because friction, at the end `to` of a step, is that of a straight way from the accepted
    /// state: what it would be had the stages been accepted in turn sees what sticks or slides in between.
    fn error_of_path(&mut self, from: &State, to: &State) -> f64 {
        if !self.motion.system().has_friction() {
            return 0.0;
        }
        let passed = self.stages(from, to).into_iter().map(|stage| stage.state);
        let mut force = self.motion.forgotten_friction(passed, to);
        let unknowns = self.motion.unknowns_of(to).into_owned();
        self.turn_to(&unknowns);
        self.solve_turned(self.eigenvalue().powi(2), &mut force);
        self.motion.from_frames(&mut force);
        self.motion.distance(&force)
    }

    /// Σ ℓ_j(x) Q̈_j of the last attempt.
    fn polynomial(&mut self, x: f64) {
        let s = self.tableau.stages();
        let at = self.tableau.lagrange(x);
        let weights = |j: usize| {
            (0..s).map(|i| at[i] * self.tableau.inverse_squared[(i, j)]).sum::<f64>()
                / self.trial_step.powi(2)
        };
        self.stages.sum(|j| if j < s { weights(j) } else { 0.0 }, &mut self.acceleration);
    }

    /// q̈ at an end of the step without vibrations faster than the step can follow: however small
    /// their amplitude, they would dominate an interpolation by accelerations.
    fn smooth_acceleration(&mut self, x: f64, state: &State) -> Vec<f64> {
        let state = &self.motion.unknowns_of(state);
        let (defect, factor) = self.defect(x, state);
        self.acceleration.iter().zip(defect).map(|(a, d)| a + factor * d).collect()
    }
}

impl Method for Collocation<'_> {
    fn order(&self) -> f64 {
        self.tableau.order
    }

    fn least_growth(&self) -> f64 {
        LEAST_GROWTH
    }

    fn vibrates(&self) -> bool {
        self.motion.vibrates
    }

    fn start(&mut self, state: &State) -> Result<Vec<f64>, Singular> {
        // The accelerations count as constant until there is a step to continue.
        let mut acceleration = vec![0.0; state.q.len()];
        self.motion.set_accepted(state);
        let unknowns = self.motion.unknowns_of(state);
        self.motion.acceleration(&unknowns, &mut acceleration)?;
        self.accelerations.iter_mut().zip(&acceleration).for_each(|(all, a)| *all = Lanes::splat(*a));
        self.multipliers
            .iter_mut()
            .zip(self.motion.multipliers())
            .for_each(|(all, mu)| *all = Lanes::splat(*mu));
        (self.last_step, self.kept, self.smooth) = (0.0, None, true);
        Ok(acceleration)
    }

    fn attempt(
        &mut self,
        state: &State,
        end: f64,
        allowed: Option<Allowed>,
        to: &mut State,
        record: &mut Iterations,
    ) -> Result<f64, Failure> {
        self.motion.set_accepted(state);
        if self.motion.remembers() {
            // A kept tangent belongs to the accepted state at which it was taken.
            self.kept = None;
        }
        let start = self.motion.unknowns_of(state);
        let (from, h) = (&*start, end - state.time);
        self.end = end;
        self.smooth |= allowed.is_none();
        self.predict(from, h);
        self.stages.measure_displacements(from);
        let [.., displacement] = self.motion.sizes(&self.stages.residual);
        if self.astray && self.last_step == 0.0 {
            self.predict_as_a_whole(from, h);
        }
        let tight = (TOLERANCE * displacement).max(REST);
        let one_sided = self.motion.keeps_lengths();
        let tolerance = allowed.map_or(tight, |allowed| allowed.of_iteration(one_sided).max(tight));
        let solved = self.solve_stages(from, h, tolerance, allowed.is_some(), record);
        self.astray = match &solved {
            Ok(()) => false,
            Err(Failure::Diverging { last } | Failure::TooSlow { last, .. }) => *last > FAR,
            Err(_) => true,
        };
        if solved.is_err() {
            self.increment = stages::lane(&self.stages.residual, self.tableau.stages() - 1);
        }
        solved?;
        self.trial_step = h;
        let end = Mixture::new(&self.tableau.end, 1.0);
        for (i, y) in self.stages.displacement[..from.q.len()].iter().enumerate() {
            let [position, velocity, ..] = end.of(*y).to_array();
            to.q[i] = from.q[i] + (h * from.v[i] + position);
            to.v[i] = from.v[i] + velocity / h;
        }
        to.time = self.end;
        let mut unseen = 0.0;
        if let Some(allowed) = allowed.filter(|_| !self.tableau.damps()) {
            unseen += self.damp(from, to, allowed)?;
        }
        if may_not_see_loads(self.control, h) {
            unseen += self.make_up(state, from, to);
        }
        if !self.multipliers.is_empty() {
            self.turn_to(to);
        }
        self.motion.carry(to);
        let (block, inertia) = (self.leading_block(), self.eigenvalue().norm_sqr() / (h * h));
        let Self { motion, kept, turns, .. } = self;
        let kept = kept.as_ref().expect(NOT_FACTORISED);
        let solve = |change: &mut [f64]| kept.solve_turned(block, turns, Complex::new(1.0, 0.0), change);
        motion.project(to, &StepMatrix { inertia, step: h, solve })?;
        let Some(_) = allowed else { return Ok(0.0) };
        Ok(self.error(from, h) + self.error_of_path(state, to) + unseen)
    }

    fn accept(&mut self) {
        let h = self.trial_step;
        // The polynomial is preferred where both are about as good, so that round-off does not
        // decide.
        let [smooth, mean] = self.misses();
        self.smooth = smooth <= 2.0 * mean;
        let mixture = Mixture::new(&self.tableau.inverse_squared, (h * h).recip());
        let displacements = &self.stages.displacement;
        self.accelerations.iter_mut().zip(displacements).for_each(|(a, y)| *a = mixture.of(*y));
        self.multipliers.copy_from_slice(&displacements[self.accelerations.len()..]);
        self.last_step = h;
    }

    fn pass(&mut self, before: f64, state: &mut State) -> Result<Vec<f64>, Singular> {
        let jump = self.motion.pass(before, state)?;
        for (all, jump) in self.accelerations.iter_mut().chain(&mut self.multipliers).zip(&jump) {
            *all += Lanes::splat(*jump);
        }
        Ok(jump)
    }

    fn end_accelerations(&mut self, from: &State, to: &State) -> Option<[Vec<f64>; 2]> {
        // Below three stages a cubic is accurate enough; with two there is no real eigenvalue to
        // filter by.
        if self.tableau.stages() < 3 {
            return None;
        }
        let (start, end) = (self.smooth_acceleration(0.0, from), self.smooth_acceleration(1.0, to));
        Some([self.motion.carried_acceleration(from, start), self.motion.carried_acceleration(to, end)])
    }

    fn stages(&self, from: &State, _: &State) -> Vec<StageState> {
        let (h, n) = (self.trial_step, from.q.len());
        let from = self.motion.unknowns_of(from);
        let velocity = Mixture::new(&self.tableau.inverse, h.recip());
        let acceleration = Mixture::new(&self.tableau.inverse_squared, (h * h).recip());
        let (displacement, multipliers) = self.stages.displacement.split_at(n);
        let stage = |(i, node): (usize, &f64)| {
            let of = |mixture: &Mixture, y: &Lanes| mixture.of(*y).to_array()[i];
            let q = stages::lane(&self.stages.x[..n], i);
            let v = from.v.iter().zip(displacement).map(|(v, y)| v + of(&velocity, y)).collect();
            let state = State { time: from.time + node * h, q, v, ..State::default() };
            let mut rates: Vec<f64> = displacement.iter().map(|y| of(&acceleration, y)).collect();
            rates.extend(stages::lane(multipliers, i));
            StageState { state, rates }
        };
        self.tableau.nodes.iter().enumerate().map(stage).collect()
    }

    fn end_rates(&self) -> Vec<f64> {
        let shares = self.tableau.lagrange(1.0);
        let of = |stages: &Lanes| shares.iter().zip(stages.to_array()).map(|(share, a)| share * a).sum();
        self.accelerations.iter().chain(&self.multipliers).map(of).collect()
    }

    fn last_increment(&self) -> &[f64] {
        &self.increment
    }

    fn statistics(&mut self) -> &mut Statistics {
        &mut self.motion.statistics
    }

    fn memory(&self) -> Memory {
        let s = self.tableau.stages();
        let (tangent, tangent_step) = self.kept.as_ref().map_or((None, 0.0), |kept| {
            let FactoredTangent { at, multipliers, step, rate, .. } = kept;
            let (State { time, q, v, .. }, multipliers) = (at.clone(), multipliers.clone());
            (Some(TangentMemory { time, q, v, multipliers, rate: *rate }), *step)
        });
        Memory::Collocation(CollocationMemory {
            last_step: self.last_step,
            smooth: self.smooth,
            accelerations: (0..s).map(|i| stages::lane(&self.accelerations, i)).collect(),
            multipliers: (0..s).map(|i| stages::lane(&self.multipliers, i)).collect(),
            tangent,
            tangent_step,
        })
    }

    fn restore(&mut self, memory: Memory) -> bool {
        let Memory::Collocation(memory) = memory else { return false };
        let (n, s) = (self.motion.coordinates(), self.tableau.stages());
        let multipliers = self.motion.unknowns() - n;
        let fits =
            |stages: &[Vec<f64>], length| stages.len() == s && stages.iter().all(|v| v.len() == length);
        if !fits(&memory.accelerations, n) || !fits(&memory.multipliers, multipliers) {
            return false;
        }
        stages::gather(&memory.accelerations, &mut self.accelerations);
        stages::gather(&memory.multipliers, &mut self.multipliers);
        (self.last_step, self.smooth) = (memory.last_step, memory.smooth);
        // Before the first step there is no tangent.
        let Some(TangentMemory { time, q, v, multipliers: with, rate }) = memory.tangent else { return true };
        if [q.len(), v.len(), with.len()] != [n, n, multipliers] {
            return false;
        }
        let at = State { time, q, v, ..State::default() };
        let step = memory.tangent_step;
        let taken = step > 0.0 && self.linearize(&at, with, step).is_ok();
        if let Some(kept) = &mut self.kept {
            kept.rate = rate;
        }
        taken
    }
}
