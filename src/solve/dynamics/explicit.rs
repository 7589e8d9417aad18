//! Explicit symplectic methods for scenes that are not stiff: kicks and drifts in turn.
//!
//! ```text
//! v ← v + b_k h M⁻¹(−f(q)),   q ← q + a_k h v,   k = 1, 2, …, and a last kick b_{m+1}
//! ```
//!
//! Order 2 is the rule of Störmer and Verlet (b = ½, ½; one force a step). Order 4 is the Runge–Kutta–Nyström method with six
//! forces a step of Blanes and Moan (*J. Comput. Appl. Math.* 142, 2002, 313–330, SRKN₆ᵇ). Both are symplectic and symmetric, and
//! solve with the mass matrix alone, which was factorised once.
//!
//! A step longer than z/ω_max explodes, with z = 2 for Störmer and Verlet and 2.98 for the fourth order; ω_max, the highest frequency of the
//! discretised beam, is found by the power method at the start. With a stated accuracy steps stay below that.
//!
//! # Error of a step
//! Order 2: h²(a₁ − a₀)/12 in position, the leading term. Order 4: h times the difference between the velocity found and that of the
//! implicit Adams formula through the accelerations at the last three step ends, O(h⁵).

use super::State;
use super::method::Method;
use super::motion::Motion;
use crate::solve::newton::{Failure, Iterations};
use crate::trajectory::Statistics;

/// Kicks and drifts; there is one kick more than drifts.
#[derive(Clone, Debug)]
struct Coefficients {
    kicks: Vec<f64>,
    drifts: Vec<f64>,
}

impl Coefficients {
    fn new(order: usize) -> Self {
        if order < 4 {
            return Self { kicks: vec![0.5, 0.5], drifts: vec![1.0] };
        }
        let b = [0.082_984_406_417_405_2, 0.396_309_801_498_368, -0.039_056_304_922_348_6];
        let a = [0.245_298_957_184_271, 0.604_872_665_711_080];
        let middle = 1.0 - 2.0 * b.iter().sum::<f64>();
        let half = 0.5 - a.iter().sum::<f64>();
        Self {
            kicks: vec![b[0], b[1], b[2], middle, b[2], b[1], b[0]],
            drifts: vec![a[0], a[1], half, half, a[1], a[0]],
        }
    }

    /// The largest z = ω h up to which the oscillator q̈ = −ω² q stays bounded: |trace of a step| ≤ 2.
    fn stability_limit(&self) -> f64 {
        let trace = |z: f64| {
            let step = |mut q: f64, mut v: f64| {
                for (kick, drift) in self.kicks.iter().zip(self.drifts.iter().map(Some).chain([None])) {
                    v -= kick * z * z * q;
                    q += drift.unwrap_or(&0.0) * v;
                }
                [q, v]
            };
            step(1.0, 0.0)[0] + step(0.0, 1.0)[1]
        };
        let stable = |z: &f64| trace(*z).abs() <= 2.0 + 1e-9;
        (1..).map(|i| 1e-3 * f64::from(i)).find(|z| !stable(z)).unwrap_or(0.0)
    }
}

/// The method with its memory.
pub struct Explicit<'a> {
    motion: Motion<'a>,
    order: usize,
    coefficients: Coefficients,
    /// Longest stable step \[s\].
    limit: f64,
    acceleration: Vec<f64>,
    trial: Vec<f64>,
    /// q̈ at the start of the step before, and its length.
    before: Option<(Vec<f64>, f64)>,
    trial_step: f64,
}

/// Iterations of the power method.
const ITERATIONS: usize = 60;
/// Part of the largest stable step that is taken: the highest frequency is known to some percent and rises with tension.
const SAFETY: f64 = 0.9;

/// ω_max of M⁻¹ K at `q` \[rad/s\].
fn highest_frequency(motion: &mut Motion<'_>, q: &[f64]) -> f64 {
    let n = q.len();
    let mut v: Vec<f64> = (1..=n).map(|i| (i as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
    motion.tangent_at(q);
    let mut value = 0.0;
    for _ in 0..ITERATIONS {
        let product = motion.stiffness_over_mass(&v);
        // A Rayleigh quotient in the Euclidean norm would do for the vector, but not for units that differ.
        let size = |v: &[f64]| motion.size(v);
        let (before, after) = (size(&v), size(&product));
        if !(before > 0.0 && after > 0.0) {
            return 0.0;
        }
        value = after / before;
        v.clear();
        v.extend(product.iter().map(|p| p / after));
    }
    value.sqrt()
}

impl<'a> Explicit<'a> {
    /// The method of the given order, 2 or 4.
    pub fn new(motion: Motion<'a>, order: usize) -> Self {
        let n = motion.coordinates();
        Self {
            motion,
            order,
            coefficients: Coefficients::new(order),
            limit: f64::INFINITY,
            acceleration: vec![0.0; n],
            trial: vec![0.0; n],
            before: None,
            trial_step: 0.0,
        }
    }

    fn error(&self, from: &State, h: f64, to: &State) -> f64 {
        let (a0, a1) = (&self.acceleration, &self.trial);
        let error: Vec<f64> = match &self.before {
            Some((before, step)) if self.order > 2 => {
                // ∫₀ʰ of the parabola through (−step, a₋), (0, a₀), (h, a₁).
                let r = h / step;
                let (w_before, w_end) = (-r * r / (6.0 * (1.0 + r)), (3.0 + 2.0 * r) / (6.0 * (1.0 + r)));
                let w_start = 1.0 - w_before - w_end;
                (0..a0.len())
                    .map(|i| {
                        let change = w_before * before[i] + w_start * a0[i] + w_end * a1[i];
                        h * (to.v[i] - from.v[i] - h * change)
                    })
                    .collect()
            }
            _ => a0.iter().zip(a1).map(|(a0, a1)| h * h * (a1 - a0) / 12.0).collect(),
        };
        self.motion.size(&error)
    }
}

impl Method for Explicit<'_> {
    fn order(&self) -> f64 {
        self.order as f64
    }

    fn start(&mut self, state: &State) -> Vec<f64> {
        self.motion.acceleration(&state.q, &mut self.acceleration);
        let highest = highest_frequency(&mut self.motion, &state.q);
        self.limit = SAFETY * self.coefficients.stability_limit() / highest;
        self.before = None;
        self.acceleration.clone()
    }

    fn attempt(
        &mut self,
        from: &State,
        h: f64,
        accuracy: Option<f64>,
        to: &mut State,
        record: &mut Iterations,
    ) -> Result<f64, Failure> {
        if h > self.limit && accuracy.is_some() {
            return Err(Failure::Unstable { limit: self.limit });
        }
        to.q.copy_from_slice(&from.q);
        to.v.copy_from_slice(&from.v);
        self.trial.copy_from_slice(&self.acceleration);
        let Coefficients { kicks, drifts } = &self.coefficients;
        for (k, kick) in kicks.iter().enumerate() {
            to.v.iter_mut().zip(&self.trial).for_each(|(v, a)| *v += kick * h * a);
            if let Some(drift) = drifts.get(k) {
                to.q.iter_mut().zip(&to.v).for_each(|(q, v)| *q += drift * h * v);
                self.motion.acceleration(&to.q, &mut self.trial);
            }
        }
        self.trial_step = h;
        let moved = self.motion.size(&self.trial);
        record.increments.clear();
        if !moved.is_finite() {
            return Err(Failure::Unstable { limit: self.limit });
        }
        Ok(if accuracy.is_some() { self.error(from, h, to) } else { 0.0 })
    }

    fn accept(&mut self) {
        let mut oldest = self.before.take().map_or_else(Vec::new, |(a, _)| a);
        oldest.clone_from(&self.acceleration);
        self.before = Some((oldest, self.trial_step));
        std::mem::swap(&mut self.acceleration, &mut self.trial);
    }

    fn longest_step(&self) -> f64 {
        self.limit
    }

    fn end_accelerations(&mut self, _: &State, _: &State) -> Option<[Vec<f64>; 2]> {
        (self.order > 2).then(|| [self.acceleration.clone(), self.trial.clone()])
    }

    fn last_increment(&self) -> &[f64] {
        &self.trial
    }

    fn statistics(&mut self) -> &mut Statistics {
        &mut self.motion.statistics
    }

    fn memory(&self) -> Vec<Vec<f64>> {
        let mut memory = vec![self.acceleration.clone(), vec![self.limit]];
        if let Some((before, step)) = &self.before {
            memory.extend([before.clone(), vec![*step]]);
        }
        memory
    }

    fn restore(&mut self, memory: Vec<Vec<f64>>) -> bool {
        let n = self.motion.coordinates();
        let lengths: Vec<usize> = memory.iter().map(Vec::len).collect();
        match &memory[..] {
            [a, limit] if lengths == [n, 1] => {
                self.acceleration.clone_from(a);
                self.limit = limit[0];
                self.before = None;
            }
            [a, limit, before, step] if lengths == [n, 1, n, 1] => {
                self.acceleration.clone_from(a);
                self.limit = limit[0];
                self.before = Some((before.clone(), step[0]));
            }
            _ => return false,
        }
        true
    }
}
