//! A force that travels along a beam with constant speed.
//!
//! The generalised force f_a = −N_a(s(t)) F needs the shape functions at a position that changes
//! with time. They are tabulated at Lobatto points of every cell and interpolated between these by
//! Lagrange's polynomial of degree 7, which is exact for the cable element's cubics.

use crate::assembly::{Action, Actions, Assembly, BuildError, Kind, Part, TimedLoad};
use crate::basis::{Basis, BasisError, BasisTable, Quadrature};
use nalgebra::Vector2;

/// Number of Lobatto points per cell.
const POINTS: usize = 8;
/// Number of points of the rule that integrates the force over the time it needs to cross a cell.
const RULE: usize = 5;

/// A dead force at s(t) = s₀ + v t, which acts while this position is on the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingForce {
    /// Index of the beam.
    pub beam: usize,
    /// F \[N\].
    pub value: [f64; 2],
    /// s₀ \[m\], the position at time zero; it is off the beam if the force arrives later.
    pub start: f64,
    /// v \[m/s\].
    pub speed: f64,
}

impl Part for MovingForce {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beam = assembly.beam("a moving force", self.beam)?;
        let part = assembly.discretized(self.beam);
        let travelling = Travelling::new(*self, &part.basis, part.offset());
        let travelling = travelling.map_err(|e| BuildError::basis(&beam.name, e))?;
        assembly.timed_load("a moving force", Box::new(travelling))
    }
}

/// A moving force with the tabulated shape functions that it needs.
#[derive(Clone, Debug)]
pub struct Travelling {
    force: MovingForce,
    table: BasisTable,
    offset: usize,
    length: f64,
    /// Gauss rule for a part of a step: abscissae and weights.
    rule: (Vec<f64>, Vec<f64>),
}

impl Travelling {
    /// `offset` is the beam's first coefficient in the system.
    ///
    /// # Errors
    /// Where the shape functions cannot be tabulated.
    pub fn new(force: MovingForce, basis: &Basis, offset: usize) -> Result<Self, BasisError> {
        let table = basis.table(Quadrature::Lobatto(POINTS), &[0])?;
        Ok(Self { force, table, offset, length: basis.length(), rule: Quadrature::Gauss(RULE).rule()? })
    }

    /// The times at which it enters and leaves the beam.
    fn ends(&self) -> [f64; 2] {
        let [a, b] = [0.0, self.length].map(|s| (s - self.force.start) / self.force.speed);
        [a.min(b), a.max(b)]
    }

    /// The arc length at which it acts at `time`, if it is on the beam.
    fn place(&self, time: f64) -> Option<f64> {
        let [comes, goes] = self.ends();
        (comes..goes).contains(&time).then(|| self.force.speed.mul_add(time, self.force.start))
    }

    /// Calls `each` for every coefficient on which the position at the arc length `s` depends, with
    /// the indices of its two coordinates and its shape function there.
    fn shape(&self, s: f64, mut each: impl FnMut(std::ops::Range<usize>, f64)) {
        let cells = self.table.s.as_chunks::<POINTS>().0;
        let cell = cells.partition_point(|places| places[0] <= s).max(1) - 1;
        let (Some(places), Some(entry)) = (cells.get(cell), self.table.cells.get(cell)) else {
            return;
        };
        let (_, rows) = self.table.block(*entry);
        let first = 2 * (self.offset + entry.first as usize);
        for (k, row) in rows.chunks_exact(self.table.width).enumerate() {
            let others = places.iter().enumerate().filter(|(j, _)| *j != k);
            let weight: f64 = others.map(|(_, other)| (s - other) / (places[k] - other)).product();
            row.iter().enumerate().for_each(|(a, n)| each(first + 2 * a..first + 2 * a + 2, weight * n));
        }
    }
}

impl TimedLoad for Travelling {
    fn kind(&self) -> Kind {
        Kind::MovingForce
    }

    fn beam(&self) -> usize {
        self.force.beam
    }

    fn add_force(&self, factor: f64, time: f64, _: &[f64], f: &mut [f64]) {
        let Some(s) = self.place(time) else { return };
        self.shape(s, |pair, n| {
            f[pair].iter_mut().zip(self.force.value).for_each(|(f, value)| *f -= factor * n * value);
        });
    }

    fn add_moments(&self, [start, end]: [f64; 2], q: &[f64], [mean, moment]: [&mut [f64]; 2]) {
        let [comes, goes] = self.ends();
        if end <= comes || start >= goes {
            return;
        }
        let cells = self.table.cells.len() as f64;
        let parts = (cells * (end - start) / (goes - comes)).ceil().max(1.0);
        for part in 0..parts as usize {
            for (at, weight) in self.rule.0.iter().zip(&self.rule.1) {
                let (x, weight) = ((part as f64 + at) / parts, weight / parts);
                let time = (end - start).mul_add(x, start);
                self.add_force(weight, time, q, mean);
                self.add_force((1.0 - x) * weight, time, q, moment);
            }
        }
    }

    fn add_actions(&self, time: f64, q: &[f64], sum: &mut Actions) {
        let Some(s) = self.place(time) else { return };
        let mut r = Vector2::zeros();
        self.shape(s, |pair, n| r += Vector2::from_column_slice(&q[pair]) * n);
        sum.add_point(s, Action::at(r, self.force.value.into()));
    }

    fn kinks(&self) -> Vec<f64> {
        self.ends().to_vec()
    }

    fn size(&self) -> (usize, usize) {
        (self.table.s.len(), self.table.bytes())
    }
}
