//! Forces that depend on velocity, as derivatives of a dissipation function.
//!
//! Effects that take energy out of a motion (material damping, dashpots, drag) have a dissipation
//! function R(z, ż), called Rayleigh's if it is quadratic in ż, whose derivatives give
//!
//! ```text
//! force     f_a  = ∫ Σ_m N_a⁽ᵒᵐ⁾ ∂R/∂ż_m ds
//! matrix    D_ab = ∫ Σ_m Σ_n N_a⁽ᵒᵐ⁾ ∂²R/∂ż_m∂ż_n N_b⁽ᵒⁿ⁾ ds      (symmetric)
//! power     P    = f · q̇ ≥ 0, lost
//! ```
//!
//! where z are the local fields of the position and ż those of the velocity, with the same tables
//! as a [`Density`]. The change of f with z is left out of the iteration matrix K + d D + c M: it
//! is smaller than D/h, with h the step, by a factor of the rotation within that step, and would
//! make the matrix unsymmetric.

use super::density::lane_of;
use super::{Actions, CompiledFor, Density, Gradient, Hessian, Integral, Kind, Workspace};
use crate::lanes::{Lanes, Pair};
use crate::linear::Matrix;

/// A dissipation function per unit of arc length that depends on `M` local fields and their rates.
pub trait Dissipation<const M: usize>: Send + Sync {
    /// The local fields, as derivative orders of r in rising order.
    const ORDERS: [usize; M];

    /// As [`Density::COMPILED_FOR`].
    const COMPILED_FOR: CompiledFor = CompiledFor::CommonTables;

    /// ∂R/∂ż at quadrature point number `point`.
    fn force(&self, point: usize, z: &Gradient<M>, rate: &Gradient<M>) -> Gradient<M>;

    /// Whether it is the same function at all points, and [`Self::forces`] faster than four times
    /// [`Self::force`].
    const BY_FOURS: bool = false;

    /// ∂R/∂ż at four points of a function that is the same at all.
    #[inline(always)]
    fn forces(&self, z: &[Pair<Lanes>; M], rate: &[Pair<Lanes>; M]) -> [Pair<Lanes>; M] {
        let forces: [Gradient<M>; 4] =
            std::array::from_fn(|lane| self.force(0, &lane_of(z, lane), &lane_of(rate, lane)));
        let part = |m: usize, d: usize| Lanes::new(std::array::from_fn(|lane| forces[lane][m][d]));
        std::array::from_fn(|m| std::array::from_fn(|d| part(m, d)))
    }

    /// ∂R/∂ż and ∂²R/∂ż∂ż.
    fn force_and_matrix(
        &self,
        point: usize,
        z: &Gradient<M>,
        rate: &Gradient<M>,
    ) -> (Gradient<M>, Hessian<M>);
}

/// A dissipation function summed over a beam.
///
/// Coordinates `q`, velocities `v` and forces `f` are those of the whole system.
pub trait Damping: Send + Sync {
    /// The kind of effect.
    fn kind(&self) -> Kind;

    /// Index of the beam on which it acts.
    fn beam(&self) -> usize;

    /// `f += ∂R/∂q̇`.
    fn add_force(&self, q: &[f64], v: &[f64], f: &mut [f64]);

    /// `d += ∂²R/∂q̇∂q̇`; `f` receives the force.
    fn add_matrix(&self, q: &[f64], v: &[f64], f: &mut [f64], d: &mut Matrix, workspace: &mut Workspace);

    /// Adds to `sum` the actions on its beam in the state (q, v).
    fn add_actions(&self, q: &[f64], v: &[f64], sum: &mut Actions);

    /// Quadrature points, and bytes of its tables and data.
    fn size(&self) -> (usize, usize);
}

/// A dissipation function as a density: its fields are the rates ż, and z is passed in place of the
/// earlier iterate.
#[derive(Clone, Debug)]
pub struct Rayleigh<D>(pub D);

impl<D: Dissipation<M>, const M: usize> Density<M> for Rayleigh<D> {
    const ORDERS: [usize; M] = D::ORDERS;
    const CONSERVATIVE: bool = false;
    const COMPILED_FOR: CompiledFor = D::COMPILED_FOR;
    const BY_FOURS: bool = D::BY_FOURS;
    const TANGENTS_BY_FOURS: bool = false;

    fn energy(&self, _: usize, _: &Gradient<M>) -> f64 {
        0.0
    }

    fn gradient(&self, point: usize, rate: &Gradient<M>) -> Gradient<M> {
        self.0.force(point, rate, rate)
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        rate: &Gradient<M>,
        z: &Gradient<M>,
        _: &Gradient<M>,
    ) -> (Gradient<M>, Hessian<M>) {
        self.0.force_and_matrix(point, z, rate)
    }
}

impl<D: Dissipation<M>, const M: usize> Damping for Integral<Rayleigh<D>, M> {
    fn kind(&self) -> Kind {
        self.kind
    }

    fn beam(&self) -> usize {
        self.beam
    }

    fn add_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        self.dissipative_force(q, v, f);
    }

    fn add_matrix(&self, q: &[f64], v: &[f64], f: &mut [f64], d: &mut Matrix, workspace: &mut Workspace) {
        let state = super::Earlier { q, increment: q };
        super::Effect::add_force_and_tangent(self, 1.0, v, Some(state), f, d, workspace);
    }

    fn add_actions(&self, q: &[f64], v: &[f64], sum: &mut Actions) {
        self.actions_of_pairs(1.0, q, v, sum, |point, z, rate| self.density.0.force(point, z, rate));
    }

    fn size(&self) -> (usize, usize) {
        super::Effect::size(self)
    }
}
