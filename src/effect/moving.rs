//! A force that travels along a beam with constant speed.
//!
//! The generalised force f_a = −N_a(s(t)) F needs the shape functions at a place that changes with time. They are tabulated at Lobatto points of every cell and
//! interpolated between them by Lagrange's polynomial of degree 7, which is exact for the cable element's cubics.

use super::Kind;
use crate::basis::{Basis, BasisError, BasisTable, Quadrature};
use crate::system::SystemError;
use crate::system::assembly::{Assembly, Part};

/// Points a cell.
const POINTS: usize = 8;

/// A dead force at s(t) = s₀ + v t, acting while that is on the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingForce {
    /// Index of the beam.
    pub beam: usize,
    /// F \[N\].
    pub value: [f64; 2],
    /// s₀ \[m\]; off the beam, where the force comes later.
    pub start: f64,
    /// v \[m/s\].
    pub speed: f64,
}

impl Part for MovingForce {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
        let beam = assembly.beam("a moving force", self.beam)?;
        let part = assembly.discretised(self.beam);
        let travelling = Travelling::new(*self, &part.basis, part.offset());
        assembly.travelling(travelling.map_err(|e| SystemError::basis(&beam.name, e))?)
    }
}

/// A moving force with the rows that it needs.
#[derive(Clone, Debug)]
pub struct Travelling {
    force: MovingForce,
    table: BasisTable,
    offset: usize,
    length: f64,
}

impl Travelling {
    /// `offset` is the beam's first coefficient in the system.
    ///
    /// # Errors
    /// Where the shape functions cannot be tabulated.
    pub fn new(force: MovingForce, basis: &Basis, offset: usize) -> Result<Self, BasisError> {
        let table = basis.table(Quadrature::Lobatto(POINTS), &[0])?;
        Ok(Self { force, table, offset, length: basis.length() })
    }

    /// What it is.
    pub fn kind(&self) -> Kind {
        Kind::MovingForce
    }

    /// Index of the beam.
    pub fn beam(&self) -> usize {
        self.force.beam
    }

    /// `f −= N(s(t)) F`.
    pub fn add_force(&self, time: f64, f: &mut [f64]) {
        let s = self.force.speed.mul_add(time, self.force.start);
        if !(0.0..=self.length).contains(&s) {
            return;
        }
        let places = self.table.s.chunks_exact(POINTS);
        let cell = places.clone().take_while(|places| places[0] <= s).count().max(1) - 1;
        let (Some(places), Some(entry)) = (places.clone().nth(cell), self.table.cells.get(cell)) else {
            return;
        };
        let (_, rows) = self.table.block(*entry);
        let first = 2 * (self.offset + entry.first as usize);
        for (k, row) in rows.chunks_exact(self.table.width).enumerate() {
            let others = places.iter().enumerate().filter(|(j, _)| *j != k);
            let weight: f64 = others.map(|(_, other)| (s - other) / (places[k] - other)).product();
            for (n, f) in row.iter().zip(f[first..].chunks_exact_mut(2)) {
                f[0] -= weight * n * self.force.value[0];
                f[1] -= weight * n * self.force.value[1];
            }
        }
    }

    /// When it comes and goes.
    pub fn kinks(&self) -> [f64; 2] {
        [0.0, self.length].map(|s| (s - self.force.start) / self.force.speed)
    }

    /// Points, and bytes of its tables.
    pub fn size(&self) -> (usize, usize) {
        (self.table.s.len(), self.table.bytes())
    }
}
