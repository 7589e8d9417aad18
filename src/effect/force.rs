//! Forces, concentrated (a table of one point with weight 1) or distributed (a table of the whole
//! beam).

use crate::assembly::{Assembly, BuildError, Density, Extent, Gradient, Hessian, Kind, Part, edges_along};
use crate::beam::{Along, Place};
use crate::lanes::{Lanes, Pair, Points, Real};
use crate::law::Law;
use nalgebra::{Matrix2, Vector2};

/// A concentrated force \[N\]. A follower force turns with the section.
#[derive(Clone, Debug, PartialEq)]
pub struct Force {
    /// The point at which it acts.
    pub at: Place,
    /// Components along the fixed axes; of a follower force, those in the undeformed state.
    pub value: [f64; 2],
    /// Whether the force turns with the section.
    pub follower: bool,
    /// In a motion, the law of time that the load's factor follows; without one the load acts in
    /// full from the start.
    pub law: Option<Law>,
}

impl Force {
    /// A force of fixed direction \[N\].
    pub fn new(at: Place, value: [f64; 2]) -> Self {
        Self { at, value, follower: false, law: None }
    }

    /// A force that turns with the section \[N\].
    pub fn following(at: Place, value: [f64; 2]) -> Self {
        Self { at, value, follower: true, law: None }
    }
}

impl Part for Force {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        add_force(assembly, Kind::Force, Extent::Point(self.at), self.value, self.follower, self.law.as_ref())
    }

    fn fades(&self) -> bool {
        true
    }

    fn point(&self) -> Option<Place> {
        Some(self.at)
    }
}

/// A force per reference length \[N/m\] along a beam.
#[derive(Clone, Debug, PartialEq)]
pub struct DistributedForce {
    /// Index of the beam.
    pub beam: usize,
    /// Components, as for [`Force`].
    pub value: [Along; 2],
    /// Whether the force turns with the section.
    pub follower: bool,
    /// In a motion, the law of time that the load's factor follows; without one the load acts in
    /// full from the start.
    pub law: Option<Law>,
}

impl DistributedForce {
    /// A force of fixed direction \[N/m\].
    pub fn new(beam: usize, value: [impl Into<Along>; 2]) -> Self {
        Self { beam, value: value.map(Into::into), follower: false, law: None }
    }

    /// A force that turns with the sections \[N/m\].
    pub fn following(beam: usize, value: [impl Into<Along>; 2]) -> Self {
        Self { follower: true, ..Self::new(beam, value) }
    }
}

impl Part for DistributedForce {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("a distributed force", self.beam)?;
        let (rule, law) = (assembly.mass_rule(self.beam), self.law.as_ref());
        let mut add =
            |extent, value| add_force(assembly, Kind::DistributedForce, extent, value, self.follower, law);
        for (extent, value) in Extent::pairs_along(self.beam, rule, &self.value) {
            add(extent, value)?;
        }
        Ok(())
    }

    fn fades(&self) -> bool {
        true
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, &self.value)
    }
}

/// Adds a force of fixed direction.
pub(super) fn add_dead_force(
    assembly: &mut Assembly<'_>,
    kind: Kind,
    extent: Extent,
    value: [f64; 2],
    law: Option<&Law>,
) -> Result<(), BuildError> {
    assembly.load(kind, extent, law, |z: Vec<[Vector2<f64>; 1]>| {
        DeadForce::new(value, z.into_iter().map(|[r]| r).collect())
    })
}

fn add_force(
    assembly: &mut Assembly<'_>,
    kind: Kind,
    extent: Extent,
    value: [f64; 2],
    follower: bool,
    law: Option<&Law>,
) -> Result<(), BuildError> {
    if !follower {
        return add_dead_force(assembly, kind, extent, value, law);
    }
    assembly.load(kind, extent, law, |z: Vec<[Vector2<f64>; 2]>| {
        FollowerForce::new(value, &z.into_iter().map(|[_, r]| r).collect::<Vec<_>>())
    })
}

/// A force F of fixed direction \[N\] or \[N/m\]: W = −F·(r − r₀). Weight is such a force, with
/// F = ρA g.
#[derive(Clone, Debug)]
pub struct DeadForce {
    force: Vector2<f64>,
    reference: Vec<Vector2<f64>>,
}

impl DeadForce {
    /// `force` is F; `reference` holds the positions r₀ at which its potential is zero.
    pub fn new(force: [f64; 2], reference: Vec<Vector2<f64>>) -> Self {
        Self { force: force.into(), reference }
    }
}

impl Density<1> for DeadForce {
    const ORDERS: [usize; 1] = [0];
    const HAS_TANGENT: bool = false;

    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        -self.force.dot(&(z[0] - self.reference[point]))
    }

    #[inline(always)]
    fn gradient(&self, _: usize, _: &Gradient<1>) -> Gradient<1> {
        [-self.force]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        _: usize,
        _: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        ([-self.force], [[Matrix2::zeros()]])
    }
}

/// A force that turns with the section: F = R(θ − θ₀) F₀ with θ = atan2(y', x'). It has no energy.
///
/// Its components (f_t, f_n) along and across the tangent t = r'/|r'| are constant:
/// F = f_t t + f_n J t, with the quarter turn J, and ∂F/∂r' = (f_t 1 + f_n J)(1 − t tᵀ)/|r'|.
#[derive(Clone, Debug)]
pub struct FollowerForce {
    /// f_t and f_n per point.
    components: [Vec<f64>; 2],
}

impl FollowerForce {
    /// `force` is F₀ in the undeformed state, and `reference` holds the gradients r'₀ there, one
    /// per point.
    pub fn new(force: [f64; 2], reference: &[Vector2<f64>]) -> Self {
        let force = Vector2::from(force);
        let component = |of: fn(Vector2<f64>, Vector2<f64>) -> f64| {
            reference.iter().map(|r| of(r / r.norm(), force)).collect()
        };
        Self { components: [component(|t, force| t.dot(&force)), component(|t, force| t.perp(&force))] }
    }

    #[inline(always)]
    fn turned(&self, point: usize) -> Matrix2<f64> {
        let [along, across] = self.components.each_ref().map(|list| list[point]);
        Matrix2::new(along, -across, across, along)
    }

    /// −(f_t t + f_n J t) at a section with the gradient r'.
    #[inline(always)]
    fn force_at<T: Real>([along, across]: [T; 2], [x, y]: Pair<T>) -> Pair<T> {
        let inverse = -x.fma(x, y * y).sqrt().inverse();
        [(along * x - across * y) * inverse, (along * y + across * x) * inverse]
    }
}

impl Density<2> for FollowerForce {
    const ORDERS: [usize; 2] = [0, 1];
    const SYMMETRIC: bool = false;
    const CONSERVATIVE: bool = false;

    fn energy(&self, _: usize, _: &Gradient<2>) -> f64 {
        0.0
    }

    #[inline(always)]
    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        let components = self.components.each_ref().map(|list| list[point]);
        [Self::force_at(components, z[1].into()).into(), Vector2::zeros()]
    }

    const BY_FOURS: bool = true;
    const TANGENTS_BY_FOURS: bool = false;

    #[inline(always)]
    fn gradients(&self, factor: f64, points: Points, z: &[Pair<Lanes>; 2]) -> [Pair<Lanes>; 2] {
        let force = Self::force_at(self.components.each_ref().map(|list| points.of(list)), z[1]);
        [force.map(|force| force * Lanes::splat(factor)), [Lanes::ZERO; 2]]
    }

    #[inline(always)]
    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        _: &Gradient<2>,
        _: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let inverse = 1.0 / z[1].norm_squared().sqrt();
        let t = z[1] * inverse;
        let turned = self.turned(point);
        let by_gradient = turned * (Matrix2::identity() - t * t.transpose()) * -inverse;
        let zero = Matrix2::zeros();
        ([-(turned * t), Vector2::zeros()], [[zero, by_gradient], [zero, zero]])
    }
}
