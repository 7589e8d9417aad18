//! Concentrated moments.

use crate::assembly::{Assembly, BuildError, CompiledFor, Density, Extent, Gradient, Hessian, Kind, Part};
use crate::beam::Place;
use crate::law::Law;
use nalgebra::{Matrix2, Vector2};

/// A concentrated moment \[N m\], counter-clockwise. In the plane a moment about z does not change
/// its direction when the section turns, so there is no follower moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// The point at which it acts.
    pub at: Place,
    /// The moment \[N m\], counter-clockwise.
    pub value: f64,
    /// In a motion, the law of time that the load's factor follows; without one the load acts in
    /// full from the start.
    pub law: Option<Law>,
}

impl Moment {
    /// A moment \[N m\] without a law of time.
    pub fn new(at: Place, value: f64) -> Self {
        Self { at, value, law: None }
    }
}

impl Part for Moment {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let couple = |_: Vec<[Vector2<f64>; 1]>| Couple { moment: self.value };
        assembly.load(Kind::Moment, Extent::Point(self.at), self.law.as_ref(), couple)
    }

    fn fades(&self) -> bool {
        true
    }

    fn couple(&self) -> Option<Place> {
        Some(self.at)
    }
}

/// A moment M \[N m\], counter-clockwise: δW = −M δθ with θ = atan2(y', x').
///
/// ∂θ/∂r' = (−y', x')/|r'|², and the second derivative is symmetric. The work M θ is a potential
/// only if θ counts full turns, which a single state does not determine; the work is therefore
/// accumulated along the motion.
#[derive(Clone, Debug)]
pub struct Couple {
    /// M \[N m\], counter-clockwise.
    pub moment: f64,
}

impl Density<1> for Couple {
    const ORDERS: [usize; 1] = [1];
    const CONSERVATIVE: bool = false;
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, _: usize, _: &Gradient<1>) -> f64 {
        0.0
    }

    #[inline(always)]
    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let factor = -self.moment / z[0].norm_squared();
        [Vector2::new(-z[0].y * factor, z[0].x * factor)]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let (x, y) = (z[0].x, z[0].y);
        let inverse = 1.0 / z[0].norm_squared();
        let factor = -self.moment * inverse * inverse;
        let (diagonal, mixed) = (2.0 * x * y * factor, (y * y - x * x) * factor);
        (self.gradient(point, z), [[Matrix2::new(diagonal, mixed, mixed, -diagonal)]])
    }
}
