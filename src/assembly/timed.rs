//! Loads that depend on time by more than a factor.

use super::assemble::fields;
use super::weighted::{Weighted, scaled};
use super::{Actions, Density, Gradient, Hessian, Integral, Kind, Workspace};
use crate::law::{Law, VANISHED};
use crate::linear::Matrix;
use crate::numeric::GAUSS_6;
use nalgebra::Vector2;

/// A load that is a function of time in another way than by a law that multiplies it: its place
/// moves along its beam, or its formula contains the time.
///
/// Its work is that of no potential, and is accumulated along the motion.
pub trait TimedLoad: Send + Sync {
    /// The kind of effect.
    fn kind(&self) -> Kind;

    /// Index of the beam.
    fn beam(&self) -> usize;

    /// Whether its tangent is symmetric.
    fn is_symmetric(&self) -> bool {
        true
    }

    /// Whether its force at a time is the same in every state.
    fn is_constant(&self) -> bool {
        true
    }

    /// `f += factor ·` its generalised force in the state `q`, with the sign of a density: the
    /// derivative of its negative work.
    fn add_force(&self, factor: f64, time: f64, q: &[f64], f: &mut [f64]);

    /// `f += ` its generalised force, `k += ` the derivative of it by q.
    fn add_force_and_tangent(
        &self,
        time: f64,
        q: &[f64],
        f: &mut [f64],
        _k: &mut Matrix,
        _workspace: &mut Workspace,
    ) {
        self.add_force(1.0, time, q, f);
    }

    /// `f += ` the derivative of its force by q, times `v`.
    fn add_tangent_product(&self, _time: f64, _q: &[f64], _v: &[f64], _f: &mut [f64]) {}

    /// Adds mean and first moment of the force from `start` to `end` in the state `q`
    /// ([`Law::moments`]).
    fn add_moments(&self, span: [f64; 2], q: &[f64], moments: [&mut [f64]; 2]);

    /// Adds to `sum` its action on the beam in the state `q`.
    fn add_actions(&self, time: f64, q: &[f64], sum: &mut Actions);

    /// The times at which it is not smooth: steps should end there.
    fn kinks(&self) -> Vec<f64>;

    /// Adds to `changes` by how much its force changes in each of as many equal parts of `span`, on a beam
    /// that flies on as it does in the state (q, v) at the start of it. Returns the size of the force,
    /// measured likewise.
    fn add_changes(&self, _span: [f64; 2], _state: [&[f64]; 2], _changes: &mut [f64]) -> f64 {
        0.0
    }

    /// Number of points, and bytes of its tables.
    fn size(&self) -> (usize, usize);
}

/// A density that depends on time, too; as a [`Density`] it is that at t = 0.
pub trait TimedDensity<const M: usize>: Density<M> {
    /// ∂W/∂z at `time`.
    fn gradient_at(&self, time: f64, point: usize, z: &Gradient<M>) -> Gradient<M>;

    /// ∂W/∂z and ∂²W/∂z∂z at `time`.
    fn gradient_and_hessian_at(&self, time: f64, point: usize, z: &Gradient<M>) -> (Gradient<M>, Hessian<M>);
}

impl<D: TimedDensity<M>, const M: usize> TimedDensity<M> for Weighted<D> {
    fn gradient_at(&self, time: f64, point: usize, z: &Gradient<M>) -> Gradient<M> {
        self.density.gradient_at(time, point, z).map(|g| g * self.factors[point])
    }

    fn gradient_and_hessian_at(&self, time: f64, point: usize, z: &Gradient<M>) -> (Gradient<M>, Hessian<M>) {
        scaled(self.density.gradient_and_hessian_at(time, point, z), self.factors[point])
    }
}

/// Change of the moments of a force by twice as many parts, relative to its largest value, that
/// counts as none.
const SETTLED: f64 = 1e-11;
/// Most parts of a step for its moments. Where they have not settled by then, the error estimate of
/// the step is large anyway.
const MOST_PARTS: usize = 1 << 10;
/// Points of the beam at which changes of a force are looked for.
const PLACES: usize = 16;

/// A density that depends on time, summed over a beam, times a law of time.
pub struct TimedIntegral<D, const M: usize> {
    sum: Integral<D, M>,
    law: Option<Law>,
}

impl<D: TimedDensity<M>, const M: usize> TimedIntegral<D, M> {
    /// The sum times `law`.
    pub fn new(sum: Integral<D, M>, law: Option<Law>) -> Self {
        Self { sum, law }
    }

    /// The law's value.
    fn factor(&self, time: f64) -> f64 {
        self.law.as_ref().map_or(1.0, |law| law.at(time)[0])
    }

    /// Mean, first moment and largest entry of the force, by Gauss' rule in equal parts.
    fn in_parts(&self, [start, end]: [f64; 2], q: &[f64], parts: usize) -> ([Vec<f64>; 2], f64) {
        let ([mut mean, mut moment], mut largest) = ([0; 2].map(|_| vec![0.0; q.len()]), 0.0_f64);
        let mut force = vec![0.0; q.len()];
        for part in 0..parts {
            for (at, weight) in &GAUSS_6 {
                let x = (part as f64 + at) / parts as f64;
                let weight = weight / parts as f64;
                force.fill(0.0);
                self.add_force(1.0, (end - start).mul_add(x, start), q, &mut force);
                for (i, force) in force.iter().enumerate() {
                    mean[i] += weight * force;
                    moment[i] += (1.0 - x) * weight * force;
                    largest = largest.max(force.abs());
                }
            }
        }
        ([mean, moment], largest)
    }
}

impl<D: TimedDensity<M>, const M: usize> TimedLoad for TimedIntegral<D, M> {
    fn kind(&self) -> Kind {
        self.sum.kind
    }

    fn beam(&self) -> usize {
        self.sum.beam
    }

    fn is_symmetric(&self) -> bool {
        D::SYMMETRIC
    }

    fn is_constant(&self) -> bool {
        !D::HAS_TANGENT
    }

    fn add_force(&self, factor: f64, time: f64, q: &[f64], f: &mut [f64]) {
        let (density, factor) = (&self.sum.density, factor * self.factor(time));
        self.sum
            .force_of_pairs(q, q, f, |point, z, _| density.gradient_at(time, point, z).map(|g| g * factor));
    }

    fn add_force_and_tangent(
        &self,
        time: f64,
        q: &[f64],
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        let (density, factor) = (&self.sum.density, self.factor(time));
        self.sum.tangent_of(factor, q, None, f, k, workspace, |point, z, _, _| {
            density.gradient_and_hessian_at(time, point, z)
        });
    }

    fn add_tangent_product(&self, time: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        let (density, factor) = (&self.sum.density, self.factor(time));
        self.sum
            .product_of::<0>(factor, q, v, f, |point, z| density.gradient_and_hessian_at(time, point, z).1);
    }

    fn add_moments(&self, span: [f64; 2], q: &[f64], moments: [&mut [f64]; 2]) {
        let (mut before, _) = self.in_parts(span, q, 1);
        let mut parts = 2;
        loop {
            let (sums, largest) = self.in_parts(span, q, parts);
            let pairs = before.iter().flatten().zip(sums.iter().flatten());
            let change = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (before, parts) = (sums, 2 * parts);
            // What is not a number anywhere is none in its sums either.
            if change <= VANISHED.max(SETTLED * largest) || !change.is_finite() || parts > MOST_PARTS {
                break;
            }
        }
        for (sum, found) in moments.into_iter().zip(&before) {
            sum.iter_mut().zip(found).for_each(|(sum, found)| *sum += found);
        }
    }

    fn add_actions(&self, time: f64, q: &[f64], sum: &mut Actions) {
        let density = &self.sum.density;
        self.sum.actions_of_pairs(self.factor(time), q, q, sum, |point, z, _| {
            density.gradient_at(time, point, z)
        });
    }

    fn kinks(&self) -> Vec<f64> {
        self.law.as_ref().map_or_else(Vec::new, Law::kinks)
    }

    fn add_changes(&self, [start, end]: [f64; 2], state: [&[f64]; 2], changes: &mut [f64]) -> f64 {
        let [z, rates] = state.map(|x| fields::<M>(&self.sum.table, self.sum.offset, x));
        let every = z.len().div_ceil(PLACES).max(1);
        let at = |part: usize| {
            let passed = (end - start) * part as f64 / changes.len() as f64;
            let factor = self.factor(start + passed);
            let points = z.iter().zip(&rates).enumerate().step_by(every);
            let force = points.flat_map(|(point, (z, rate))| {
                let z = std::array::from_fn(|m| z[m] + rate[m] * passed);
                self.sum.density.gradient_at(start + passed, point, &z).map(|g| g * factor)
            });
            force.collect::<Vec<Vector2<f64>>>()
        };
        // Where a formula has no value, it does not hide what it does elsewhere.
        let sum = |sizes: &mut dyn Iterator<Item = f64>| sizes.filter(|size| size.is_finite()).sum::<f64>();
        let forces: Vec<_> = (0..=changes.len()).map(at).collect();
        for (change, pair) in changes.iter_mut().zip(forces.windows(2)) {
            *change += sum(&mut pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a).norm()));
        }
        forces.iter().map(|force| sum(&mut force.iter().map(|force| force.norm()))).fold(0.0, f64::max)
    }

    fn size(&self) -> (usize, usize) {
        super::Effect::size(&self.sum)
    }
}
