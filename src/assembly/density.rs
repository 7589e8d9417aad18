//! A quantity per unit of arc length, with its derivatives by the local fields.

use super::TendonPath;
use crate::lanes::{Lanes, Pair, Points, Square};
use nalgebra::{Matrix2, Vector2};

/// First derivatives of a density by each of its local fields.
pub type Gradient<const M: usize> = [Vector2<f64>; M];

/// Second derivatives of a density: block (m, n) is ∂²W/∂z_m∂z_n.
pub type Hessian<const M: usize> = [[Matrix2<f64>; M]; M];

/// Tables for which a sum is compiled apart, which makes it faster and the program larger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompiledFor {
    /// All common numbers of shape functions and of points.
    CommonTables,
    /// Cable elements with two or three points.
    CableElements,
    /// None: one loop serves all, for what acts at single points or takes little of the time.
    None,
}

/// A quantity per unit of arc length that depends on `M` local fields.
pub trait Density<const M: usize>: Send + Sync {
    /// The local fields, as derivative orders of r in rising order: `[1, 2]` for (r', r'').
    const ORDERS: [usize; M];

    /// Whether ∂²W/∂z∂z is symmetric, as it is for everything that has an energy.
    const SYMMETRIC: bool = true;

    /// Whether ∂²W/∂z∂z can differ from zero; if not, the force is constant and no tangent is
    /// assembled.
    const HAS_TANGENT: bool = true;

    /// Whether the force has the potential W; if not, its work is accumulated along the motion.
    const CONSERVATIVE: bool = true;

    /// For which tables its sums are compiled apart.
    const COMPILED_FOR: CompiledFor = CompiledFor::CommonTables;

    /// The tendon whose pull it is, for the densities of tendons.
    fn tendon(&self) -> Option<&TendonPath> {
        None
    }

    /// W at quadrature point number `point` \[J/m\]; zero for a density without an energy.
    fn energy(&self, point: usize, z: &Gradient<M>) -> f64;

    /// ∂W/∂z.
    fn gradient(&self, point: usize, z: &Gradient<M>) -> Gradient<M>;

    /// Whether [`Self::gradients`] is faster than four times [`Self::gradient`].
    const BY_FOURS: bool = false;

    /// Whether [`Self::gradients_and_hessians`] is, too.
    const TANGENTS_BY_FOURS: bool = Self::BY_FOURS;

    /// `factor · ∂W/∂z` at four points.
    #[inline(always)]
    fn gradients(&self, factor: f64, points: Points, z: &[Pair<Lanes>; M]) -> [Pair<Lanes>; M] {
        let numbers = points.numbers();
        let gradients: [Gradient<M>; 4] =
            std::array::from_fn(|lane| self.gradient(numbers[lane], &lane_of(z, lane)).map(|g| g * factor));
        std::array::from_fn(|m| {
            let part = |d: usize| Lanes::new(std::array::from_fn(|lane| gradients[lane][m][d]));
            [part(0), part(1)]
        })
    }

    /// `factor` times the result of [`Self::gradient_and_hessian`] at four points; `states` are the
    /// fields z, those of the earlier iterate, and the change.
    #[inline(always)]
    fn gradients_and_hessians(
        &self,
        factor: f64,
        points: Points,
        states: [&[Pair<Lanes>; M]; 3],
    ) -> ([Pair<Lanes>; M], [[Square<Lanes>; M]; M]) {
        let numbers = points.numbers();
        let of_lanes: [(Gradient<M>, Hessian<M>); 4] = std::array::from_fn(|lane| {
            let [z, before, change] = states.map(|z| lane_of(z, lane));
            self.gradient_and_hessian(numbers[lane], &z, &before, &change)
        });
        let in_lanes = |of: &dyn Fn(&(Gradient<M>, Hessian<M>)) -> f64| {
            Lanes::new(std::array::from_fn(|lane| factor * of(&of_lanes[lane])))
        };
        use std::array::from_fn;
        let gradient = from_fn(|m| from_fn(|d| in_lanes(&|(gradient, _)| gradient[m][d])));
        let entry = |m: usize, n: usize, d: usize, e: usize| in_lanes(&|(_, hessian)| hessian[m][n][(d, e)]);
        (gradient, from_fn(|m| from_fn(|n| from_fn(|d| from_fn(|e| entry(m, n, d, e))))))
    }

    /// ∂W/∂z and ∂²W/∂z∂z. Stress resultants in the latter are extrapolated from the iterate
    /// `before` by the `change` that was computed there; see [`crate::assembly`].
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<M>,
        before: &Gradient<M>,
        change: &Gradient<M>,
    ) -> (Gradient<M>, Hessian<M>);
}

/// The local fields at one of four points.
#[inline(always)]
pub(super) fn lane_of<const M: usize>(z: &[Pair<Lanes>; M], lane: usize) -> Gradient<M> {
    z.map(|pair| Vector2::from(pair.map(|lanes| lanes.to_array()[lane])))
}
