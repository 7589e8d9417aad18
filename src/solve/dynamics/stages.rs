//! The stages of a collocation method side by side: stage i of every unknown in lane i of a
//! register.
//!
//! All stages need the same computations in every cell, so that forces, products with the mass
//! matrix and turns are computed for all of them at once. Lanes beyond the last stage repeat it.
//! Substitutions work on one vector after the other; between vectors and lanes, blocks of 4 × 4
//! numbers are transposed.

use super::State;
use super::motion::{Acceleration, Motion, Rates};
use super::turns::{PairTurns, Turn};
use crate::lanes::{self, Lanes};
use crate::solve::equilibrium::{self, larger};
use nalgebra::DMatrix;

/// Most stages of a method, of the four that would fit into a register.
const STAGES: usize = 3;

/// A small matrix that maps the stages of an unknown to up to four other numbers.
#[derive(Clone, Copy, Debug)]
pub struct Mixture {
    columns: [Lanes; STAGES],
}

impl Mixture {
    /// `factor` times `matrix`, which has a column per stage; lanes beyond its last row repeat
    /// that.
    pub fn new(matrix: &DMatrix<f64>, factor: f64) -> Self {
        let (rows, columns) = matrix.shape();
        let column = |j: usize| Lanes::new(std::array::from_fn(|i| factor * matrix[(i.min(rows - 1), j)]));
        Self { columns: std::array::from_fn(|j| if j < columns { column(j) } else { Lanes::ZERO }) }
    }

    /// The product with the stages of one unknown.
    #[inline(always)]
    pub fn of(&self, stages: Lanes) -> Lanes {
        let [a, b, c, _] = stages.to_array();
        let [first, second, third] = self.columns;
        let sum = first * Lanes::splat(a);
        third.mul_add(Lanes::splat(c), second.mul_add(Lanes::splat(b), sum))
    }
}

/// Copies vectors, one per stage, into lanes.
pub fn gather(vectors: &[Vec<f64>], lanes: &mut [Lanes]) {
    let of_lane = |lane: usize| &vectors[lane.min(vectors.len() - 1)][..];
    let of_lane: [&[f64]; 4] = std::array::from_fn(of_lane);
    let blocks = of_lane.map(|vector| vector.as_chunks::<4>().0);
    let whole = blocks[0].len();
    for (k, target) in lanes.as_chunks_mut::<4>().0[..whole].iter_mut().enumerate() {
        *target = Lanes::transpose(blocks.map(|blocks| Lanes::new(blocks[k])));
    }
    for (k, target) in lanes.iter_mut().enumerate().skip(4 * whole) {
        *target = Lanes::new(of_lane.map(|vector| vector[k]));
    }
}

/// Copies lanes back to vectors, one per stage.
pub fn scatter(lanes: &[Lanes], vectors: &mut [Vec<f64>]) {
    let (blocks, rest) = lanes.as_chunks::<4>();
    for (k, block) in blocks.iter().enumerate() {
        let rows = Lanes::transpose(*block);
        for (vector, row) in vectors.iter_mut().zip(rows) {
            if let Some(target) = vector.as_chunks_mut::<4>().0.get_mut(k) {
                *target = row.to_array();
            }
        }
    }
    for (k, values) in rest.iter().enumerate() {
        for (vector, value) in vectors.iter_mut().zip(values.to_array()) {
            vector[4 * blocks.len() + k] = value;
        }
    }
}

/// One stage of all unknowns.
pub fn lane(lanes: &[Lanes], lane: usize) -> Vec<f64> {
    lanes.iter().map(|values| values.to_array()[lane]).collect()
}

/// The largest size of all numbers in each lane, those of a node in `units`; NaN if one is not
/// finite.
pub fn largest(numbers: &[Lanes], units: [f64; 4]) -> Lanes {
    let mut sizes = Lanes::ZERO;
    let mut not_finite = Lanes::ZERO;
    for node in numbers.as_chunks::<4>().0 {
        for (number, unit) in node.iter().zip(units) {
            let size = (*number * Lanes::splat(unit)).abs();
            sizes = size.fast_max(sizes);
            // Times zero, ∞ and NaN give NaN, which a maximum might drop.
            not_finite += size * Lanes::ZERO;
        }
    }
    sizes + not_finite
}

/// Working memory of an iteration.
#[derive(Clone, Debug)]
pub struct Stages {
    /// Y, followed by the multipliers.
    pub displacement: Vec<Lanes>,
    /// Q, followed by the multipliers.
    pub x: Vec<Lanes>,
    /// Q̈.
    pub acceleration: Vec<Lanes>,
    /// Q̇, where forces depend on it.
    pub velocity: Vec<Lanes>,
    /// The residual, then the increment.
    pub residual: Vec<Lanes>,
    /// Turns of the nodes since the tangent was taken.
    turns: Vec<Turn<Lanes>>,
    still: Vec<usize>,
    pairs: PairTurns<Lanes>,
}

impl Stages {
    /// For `n` coordinates of `unknowns`; the nodes `still` do not turn as a whole.
    pub fn new(n: usize, unknowns: usize, damped: bool, still: Vec<usize>, pairs: PairTurns<Lanes>) -> Self {
        Self {
            displacement: vec![Lanes::ZERO; unknowns],
            x: vec![Lanes::ZERO; unknowns],
            acceleration: vec![Lanes::ZERO; n],
            velocity: vec![Lanes::ZERO; if damped { n } else { 0 }],
            residual: vec![Lanes::ZERO; unknowns],
            turns: vec![Turn::none(); n / 4],
            still,
            pairs,
        }
    }

    /// Q_i = q₀ + c_i h v₀ + Y_i.
    pub fn place(&mut self, from: &State, ch: Lanes) {
        let n = from.q.len();
        let (x, y) = (&mut self.x[..n], &self.displacement[..n]);
        let (q, v) = (&from.q[..n], &from.v[..n]);
        for k in 0..n {
            x[k] = Lanes::splat(q[k]) + ch.mul_add(Lanes::splat(v[k]), y[k]);
        }
        self.x[n..].copy_from_slice(&self.displacement[n..]);
    }

    /// Computes Q̈_i and, where forces depend on it, Q̇_i.
    pub fn move_on(&mut self, from: &State, acceleration: &Mixture, velocity: &Mixture) {
        for (a, y) in self.acceleration.iter_mut().zip(&self.displacement) {
            *a = acceleration.of(*y);
        }
        for ((v, y), start) in self.velocity.iter_mut().zip(&self.displacement).zip(&from.v) {
            *v = Lanes::splat(*start) + velocity.of(*y);
        }
    }

    /// Measures how far every node has turned since `at`.
    pub fn measure_turns(&mut self, at: &[f64]) {
        self.pairs.measure(at, &self.x);
        let nodes = self.x.as_chunks::<4>().0.iter().zip(at.as_chunks::<4>().0);
        for (turn, (x, start)) in self.turns.iter_mut().zip(nodes) {
            *turn = Turn::between([start[2], start[3]].map(Lanes::splat), [x[2], x[3]]);
        }
        for &node in &self.still {
            self.turns[node] = Turn::none();
        }
    }

    /// Turns the residual back to where the tangent was taken, combines the stages and writes them
    /// to `rows`.
    pub fn take_apart(&mut self, mixture: &Mixture, rows: &mut [Vec<f64>]) {
        self.pairs.back(&mut self.residual);
        let nodes = self.residual.as_chunks_mut::<4>().0;
        for (turn, node) in self.turns.iter().zip(nodes) {
            turn.back(node);
            *node = node.map(|r| mixture.of(r));
        }
        self.residual[4 * self.turns.len()..].iter_mut().for_each(|r| *r = mixture.of(*r));
        scatter(&self.residual, rows);
    }

    /// Computes the increments of the stages from those of `rows`.
    pub fn put_together(&mut self, mixture: &Mixture, rows: &[Vec<f64>]) {
        gather(rows, &mut self.residual);
        let nodes = self.residual.as_chunks_mut::<4>().0;
        for (turn, node) in self.turns.iter().zip(nodes) {
            *node = node.map(|r| mixture.of(r));
            turn.forth(node);
        }
        self.residual[4 * self.turns.len()..].iter_mut().for_each(|r| *r = mixture.of(*r));
        self.pairs.forth(&mut self.residual);
    }

    /// Adds the increments to the displacements.
    pub fn advance(&mut self) {
        self.displacement.iter_mut().zip(&self.residual).for_each(|(y, d)| *y += *d);
    }

    /// How far each stage is from `from`, as increments.
    pub fn measure_displacements(&mut self, from: &State) {
        let coordinates = self.x.iter().zip(&from.q);
        self.residual.iter_mut().zip(coordinates).for_each(|(d, (x, q))| *d = *x - Lanes::splat(*q));
    }

    /// Σ_i `weights`_i Y_i.
    pub fn sum(&self, weights: impl Fn(usize) -> f64, sum: &mut [f64]) {
        let weights = Lanes::new(std::array::from_fn(weights));
        sum.iter_mut().zip(&self.displacement).for_each(|(sum, y)| *sum = (*y * weights).reduce_add());
    }
}

impl Motion<'_> {
    /// Room for the stages of a collocation method.
    pub fn stages(&self) -> Stages {
        let damped = self.needs_velocity() || self.carries;
        Stages::new(self.coordinates(), self.unknowns(), damped, self.still(), self.turning_pairs())
    }

    /// [`Self::residual`] of the first `count` stages of a step, at their `times`: writes all of
    /// them to `stages` and returns the largest.
    pub fn residuals(&mut self, times: [f64; 4], count: usize, stages: &mut Stages) -> f64 {
        if self.carries || self.system.has_turning_inertia() {
            let mut largest = 0.0_f64;
            let mut rows: [Vec<f64>; 4] = Default::default();
            for (stage, row) in rows.iter_mut().enumerate() {
                if stage < count {
                    let [x, v, a] =
                        [&stages.x, &stages.velocity, &stages.acceleration].map(|of| lane(of, stage));
                    row.resize(x.len(), 0.0);
                    let a = Acceleration::constant(&a);
                    let scaled = self.residual(&x, Rates { time: times[stage], v: &v, a }, row);
                    largest = larger(largest, scaled);
                }
            }
            gather(&rows[..count], &mut stages.residual);
            stages.residual.iter_mut().for_each(|r| *r = -*r);
            return largest;
        }
        self.statistics.residual_evaluations += count;
        let Self { system, mass, side_by_side, accepted, .. } = self;
        let n = system.coordinates();
        let (force, gaps) = stages.residual.split_at_mut(n);
        let (q, multipliers) = stages.x.split_at(n);
        system.forces(times, q, force, side_by_side);
        if system.has_history() {
            lanes::one_by_one(q, force, side_by_side, |_, q, f| system.add_history(accepted, q, f));
        }
        if system.is_damped() {
            let velocities: [Vec<f64>; 4] = std::array::from_fn(|stage| lane(&stages.velocity, stage));
            lanes::one_by_one(q, force, side_by_side, |lane, q, f| {
                system.add_damping(q, &velocities[lane], f);
            });
        }
        let inverse = 1.0 / system.length();
        let units = [1.0, 1.0, inverse, inverse];
        let mut scale = largest(force, units);
        scale = system.constrain_in_lanes(times, [q, multipliers], force, gaps, scale, side_by_side);
        mass.multiply_add_lanes(&stages.acceleration, force, side_by_side);
        system.supports().to_frames(0.0, force);
        let residual =
            (largest(force, units) / (scale + Lanes::splat(equilibrium::floor(system)))).to_array();
        residual.into_iter().fold(0.0, larger)
    }

    /// [`Self::size`] of the increments of all stages.
    pub fn sizes(&self, increment: &[Lanes]) -> [f64; 4] {
        let inverse = 1.0 / self.system.length();
        let units = [inverse, inverse, 1.0, 1.0];
        largest(&increment[..self.coordinates()], units).to_array()
    }
}
