//! Lengths of tendons that are kept, as constraints with a Lagrange multiplier each.

use super::{Amplitude, Effect, TendonPath, Workspace, remaining};
use crate::linear::Matrix;

/// The length of the line of a tendon, which is kept at that of the stress-free state less a shortening:
///
/// ```text
/// g(q) = ∫ |p'| ds − ∫ |p'₀| ds + Δ a = 0
/// ```
///
/// with the line p of [`TendonPath`] and the amplitude a of the shortening Δ. Its multiplier is the
/// tension of the tendon \[N\].
pub struct HeldLength {
    /// Parts of the length, as the energies of a tendon of tension 1 N.
    sums: [Box<dyn Effect>; 2],
    /// The line, with a tension of 1 N.
    pub path: TendonPath,
    /// Δ \[m\].
    pub shortening: f64,
    /// a; `None` for that of the system.
    pub amplitude: Option<Amplitude>,
    /// The sum in the stress-free state.
    start: f64,
    /// g at load factor 0, from which it closes in proportion to the load factor: zero unless the state
    /// in which statics begins misses it.
    open: f64,
}

impl HeldLength {
    /// `reference` are the coordinates of the stress-free state.
    pub fn new(
        sums: [Box<dyn Effect>; 2],
        path: TendonPath,
        shortening: f64,
        amplitude: Option<Amplitude>,
        reference: &[f64],
    ) -> Self {
        let start = sums.iter().map(|sum| sum.energy(reference)).sum();
        Self { sums, path, shortening, amplitude, start, open: 0.0 }
    }

    /// Index of its beam.
    pub fn beam(&self) -> usize {
        self.sums[0].beam()
    }

    /// By how much it is longer in the state `q` than in the stress-free one \[m\].
    pub fn stretch(&self, q: &[f64]) -> f64 {
        self.sums.iter().map(|sum| sum.energy(q)).sum::<f64>() - self.start
    }

    /// Lets it be `open` \[m\] at load factor 0.
    pub fn begin_open(&mut self, open: f64) {
        self.open = open;
    }

    /// What g is to be at the load factor `load` \[m\].
    pub fn remains_open(&self, load: f64) -> f64 {
        remaining(load)[0] * self.open
    }

    /// The derivative of [`Self::remains_open`] by the load factor.
    pub fn closes(&self, load: f64) -> f64 {
        remaining(load)[1] * self.open
    }

    /// `f += factor · ∂g/∂q`.
    pub fn add_gradient(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        self.sums.iter().for_each(|sum| sum.add_force(factor, q, f));
    }

    /// `k += factor · ∂²g/∂q∂q`.
    pub fn add_curvature(&self, factor: f64, q: &[f64], k: &mut Matrix) {
        let (mut force, mut workspace) = (vec![0.0; q.len()], Workspace::default());
        for sum in &self.sums {
            sum.add_force_and_tangent(factor, q, None, &mut force, k, &mut workspace);
        }
    }

    /// `f += factor · ∂²g/∂q∂q v`.
    pub fn add_curvature_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.sums.iter().for_each(|sum| sum.add_tangent_product(factor, q, v, f));
    }

    /// Quadrature points, and bytes of its tables and data.
    pub fn size(&self) -> (usize, usize) {
        let sizes = self.sums.each_ref().map(|sum| sum.size());
        (sizes[0].0 + sizes[1].0, sizes[0].1 + sizes[1].1)
    }
}
