//! Masses on a beam, and the rotary inertia of points and sections.
//!
//! Rotary inertia belongs to the direction θ of the gradient alone: T = ½ J θ̇² with θ̇ = p·ṙ' and
//! p = ∂θ/∂r' = (−y', x')/|r'|². Its mass matrix J p pᵀ therefore depends on the direction, and the
//! force of inertia is
//!
//! ```text
//! J θ̈ p,   θ̈ = p·r̈' + ṙ'·∂²θ/∂r'∂r'·ṙ'
//! ```
//!
//! The simpler ½ J ṙ'·ṙ' has a constant matrix, but would give an inertia to |r'|, too: at a point,
//! the stretch of the neighbouring cells would oscillate, the slower the finer the mesh; along a
//! beam, axial waves would be slowed down.

use super::Inertia;
use super::direction;
use crate::assembly::{
    Assembly, BuildError, Dissipation, Extent, Gradient, Hessian, Kind, Part, edges_along,
};
use crate::beam::{Along, Place};
use crate::lanes::{Lanes, Pair, Real, cross, dot};

/// A mass at a point: T = ½ m ṙ·ṙ + ½ J θ̇².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMass {
    /// The point of the beam.
    pub at: Place,
    /// m \[kg\]; gravity acts on it, too.
    pub mass: Option<f64>,
    /// J \[kg m²\].
    pub rotary_inertia: Option<f64>,
}

impl Part for PointMass {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let extent = Extent::Point(self.at);
        if let Some(mass) = self.mass {
            assembly.inertia(Kind::PointMass, extent.clone(), Inertia { mass_per_length: mass })?;
        }
        if let Some(inertia) = self.rotary_inertia {
            let momentum = RotaryInertia { inertia };
            assembly.turning_inertia(Kind::RotaryInertia, extent, momentum.clone(), Gyration(momentum))?;
        }
        Ok(())
    }

    fn couple(&self) -> Option<Place> {
        self.rotary_inertia.map(|_| self.at)
    }

    fn point(&self) -> Option<Place> {
        Some(self.at)
    }

    fn mass(&self) -> Option<(Place, f64)> {
        Some((self.at, self.mass?))
    }
}

/// The rotary inertia of a beam's sections, T = ½ ρI ∫ θ̇² ds.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionInertia {
    /// Index of the beam.
    pub beam: usize,
    /// ρI \[kg m\].
    pub per_length: Along,
}

impl Part for SectionInertia {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("rotary inertia", self.beam)?;
        let rule = assembly.mass_rule(self.beam);
        let (inertia, extent) = Extent::along(self.beam, rule, &self.per_length);
        let momentum = RotaryInertia { inertia };
        assembly.turning_inertia(Kind::RotaryInertia, extent, momentum.clone(), Gyration(momentum))
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, [&self.per_length])
    }
}

/// The kinetic energy ½ J θ̇² as a function of ṙ'. Its derivative is the momentum J θ̇ p, and its
/// second derivative the mass matrix J p pᵀ.
#[derive(Clone, Debug)]
pub struct RotaryInertia {
    /// J \[kg m²\], or per length ρI \[kg m\].
    pub inertia: f64,
}

impl RotaryInertia {
    #[inline(always)]
    fn force_at<T: Real>(&self, [x, y]: Pair<T>, rate: Pair<T>) -> Pair<T> {
        let inverse = x.fma(x, y * y).inverse();
        let p = [-y * inverse, x * inverse];
        let momentum = T::of(self.inertia) * dot(p, rate);
        p.map(|p| p * momentum)
    }
}

impl Dissipation<1> for RotaryInertia {
    const ORDERS: [usize; 1] = [1];

    #[inline(always)]
    fn force(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        [self.force_at(z[0].into(), rate[0].into()).into()]
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn forces(&self, z: &[Pair<Lanes>; 1], rate: &[Pair<Lanes>; 1]) -> [Pair<Lanes>; 1] {
        [self.force_at(z[0], rate[0])]
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let p = direction::gradient(&z[0]);
        let matrix = p * p.transpose() * self.inertia;
        ([matrix * rate[0]], [[matrix]])
    }
}

/// The force of inertia J (ṙ'·∂²θ/∂r'∂r'·ṙ') p of a gradient without acceleration.
#[derive(Clone, Debug)]
pub struct Gyration(pub RotaryInertia);

impl Gyration {
    #[inline(always)]
    fn force_at<T: Real>(&self, [x, y]: Pair<T>, [u, v]: Pair<T>) -> Pair<T> {
        let inverse = x.fma(x, y * y).inverse();
        let p = [-y * inverse, x * inverse];
        // ṙ'·∂²θ/∂r'∂r'·ṙ' = −2 (r'·ṙ') (r' × ṙ')/|r'|⁴
        let along = dot([x, y], [u, v]) * inverse;
        let force = T::of(-2.0 * self.0.inertia) * along * (cross([x, y], [u, v]) * inverse);
        p.map(|p| p * force)
    }
}

impl Dissipation<1> for Gyration {
    const ORDERS: [usize; 1] = [1];

    #[inline(always)]
    fn force(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        [self.force_at(z[0].into(), rate[0].into()).into()]
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn forces(&self, z: &[Pair<Lanes>; 1], rate: &[Pair<Lanes>; 1]) -> [Pair<Lanes>; 1] {
        [self.force_at(z[0], rate[0])]
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let (p, half) = (direction::gradient(&z[0]), direction::hessian(&z[0]) * rate[0]);
        let inertia = self.0.inertia;
        ([p * (inertia * rate[0].dot(&half))], [[p * half.transpose() * (2.0 * inertia)]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    /// The force J (ṙ'·∂²θ/∂r'∂r'·ṙ') p is quadratic in ṙ', so that a central difference is its
    /// derivative; by hand, at r' = (2, 1) with ṙ' = (3, −1) and J = 5 it is −2 J·5·(−5)/25 p = 10 p with
    /// p = (−1, 2)/5.
    #[test]
    fn the_matrix_of_gyration_is_the_derivative_of_its_force() {
        let gyration = Gyration(RotaryInertia { inertia: 5.0 });
        let (z, rate) = ([Vector2::new(2.0, 1.0)], [Vector2::new(3.0, -1.0)]);
        let ([force], [[matrix]]) = gyration.force_and_matrix(0, &z, &rate);
        assert!((force - Vector2::new(-2.0, 4.0)).amax() < 1e-13, "{force}");
        assert!((force - gyration.force(0, &z, &rate)[0]).amax() < 1e-13);
        for axis in 0..2 {
            let mut step = Vector2::zeros();
            step[axis] = 0.5;
            let [above, below] = [step, -step].map(|step| gyration.force(0, &z, &[rate[0] + step])[0]);
            assert!((matrix.column(axis) - (above - below)).amax() < 1e-13, "{matrix}");
        }
    }
}
