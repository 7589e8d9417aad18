//! The interface through which a system uses each of the effects that it sums.

use super::{Actions, Kind, Workspace};
use crate::lanes::{self, Lanes};
use crate::linear::Matrix;

/// The iterate before the current one, from which stress resultants are extrapolated.
#[derive(Clone, Copy, Debug)]
pub struct Earlier<'a> {
    /// Its coordinates.
    pub q: &'a [f64],
    /// The increment that the linear system gave there; the current iterate may have been computed
    /// from it with finite rotations.
    pub increment: &'a [f64],
}

/// A density summed over a beam; a system is a sum of such effects.
///
/// Coordinates `q` and forces `f` are those of the whole system, `[x, y, x', y']` node after node.
pub trait Effect: Send + Sync {
    /// The kind of effect.
    fn kind(&self) -> Kind;

    /// Index of the beam on which it acts.
    fn beam(&self) -> usize;

    /// Whether its tangent is symmetric.
    fn is_symmetric(&self) -> bool;

    /// Whether its force is the same in every state.
    fn is_constant(&self) -> bool;

    /// Whether its force has a potential.
    fn is_conservative(&self) -> bool;

    /// The energy U \[J\].
    fn energy(&self, q: &[f64]) -> f64;

    /// `f += factor · ∂U/∂q`.
    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]);

    /// As [`Self::add_force`] for four states, one per lane, each with its own factor; `scratch`
    /// holds two vectors of the length of `q`.
    fn add_forces(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        let factors = factors.to_array();
        lanes::one_by_one(q, f, scratch, |lane, q, f| self.add_force(factors[lane], q, f));
    }

    /// `f += factor · ∂U/∂q`, `k += factor · ∂²U/∂q∂q`, the latter with stress resultants
    /// extrapolated from an earlier iterate, if there is one.
    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    );

    /// `f += factor · ∂²U/∂q∂q v`, summed over points without forming a matrix. Fields that differ
    /// little between neighbouring nodes are thus differentiated before they are multiplied by a
    /// large stiffness, so that few digits are lost even on fine meshes.
    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]);

    /// Adds to `sum` the actions on its beam in the state `q`, times `factor`. For a kinetic
    /// energy, `a` are the accelerations of the coordinates; for all other effects `a` is the same
    /// as `q`.
    fn add_actions(&self, factor: f64, q: &[f64], a: &[f64], sum: &mut Actions);

    /// Quadrature points, and bytes of its tables and data.
    fn size(&self) -> (usize, usize);
}

/// An effect that is shared, because other code uses it through another interface.
impl<E: Effect + ?Sized> Effect for std::sync::Arc<E> {
    fn kind(&self) -> Kind {
        (**self).kind()
    }

    fn beam(&self) -> usize {
        (**self).beam()
    }

    fn is_symmetric(&self) -> bool {
        (**self).is_symmetric()
    }

    fn is_constant(&self) -> bool {
        (**self).is_constant()
    }

    fn is_conservative(&self) -> bool {
        (**self).is_conservative()
    }

    fn energy(&self, q: &[f64]) -> f64 {
        (**self).energy(q)
    }

    fn add_force(&self, factor: f64, q: &[f64], f: &mut [f64]) {
        (**self).add_force(factor, q, f);
    }

    fn add_forces(&self, factors: Lanes, q: &[Lanes], f: &mut [Lanes], scratch: &mut [Vec<f64>; 2]) {
        (**self).add_forces(factors, q, f, scratch);
    }

    fn add_force_and_tangent(
        &self,
        factor: f64,
        q: &[f64],
        earlier: Option<Earlier<'_>>,
        f: &mut [f64],
        k: &mut Matrix,
        workspace: &mut Workspace,
    ) {
        (**self).add_force_and_tangent(factor, q, earlier, f, k, workspace);
    }

    fn add_tangent_product(&self, factor: f64, q: &[f64], v: &[f64], f: &mut [f64]) {
        (**self).add_tangent_product(factor, q, v, f);
    }

    fn add_actions(&self, factor: f64, q: &[f64], a: &[f64], sum: &mut Actions) {
        (**self).add_actions(factor, q, a, sum);
    }

    fn size(&self) -> (usize, usize) {
        (**self).size()
    }
}
