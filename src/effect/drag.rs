//! Resistance and lift of a fluid around a beam.

use super::DeadForce;
use crate::assembly::{
    Assembly, BuildError, Density, Dissipation, Extent, Gradient, Hessian, Kind, Part, edges_along,
};
use crate::basis::Quadrature;
use crate::beam::{Along, Place};
use crate::lanes::{Lanes, Pair, Real, dot};
use crate::law::Law;
use nalgebra::{Matrix2, Vector2};

/// Drag per length on a section that moves with the velocity u relative to the fluid, split along
/// and across the beam: f = −Σ_d (c_d + C_d |u_d|) u_d. The first term is viscous, the second is
/// Morison's with C = ½ ρ C_D D. The dissipation function is R = Σ_d (½ c_d u_d² + ⅓ C_d |u_d|³).
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    /// Index of the beam.
    pub beam: usize,
    /// Along and across the beam: c \[N s/m²\].
    pub viscous: [Along; 2],
    /// Along and across the beam: C \[N s²/m³\].
    pub quadratic: [Along; 2],
    /// Velocity of the fluid \[m/s\].
    pub flow: [f64; 2],
}

impl Part for Drag {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("drag", self.beam)?;
        let (needs, flows) = (assembly.needs(), self.flow != [0.0; 2]);
        for (extent, force) in self.forces(assembly.mass_rule(self.beam)) {
            if flows && !needs.motion {
                assembly.load(Kind::Drag, extent.clone(), None, |_| SteadyDrag(force))?;
            }
            // In an equilibrium, drag consists of the steady flow alone.
            if !flows || needs.motion || needs.inertia {
                assembly.damping(Kind::Drag, extent, |_| force)?;
            }
        }
        Ok(())
    }

    fn fades(&self) -> bool {
        true
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, self.viscous.iter().chain(&self.quadratic))
    }
}

impl Drag {
    /// One density for constant coefficients, else one for each that is not zero.
    fn forces(&self, rule: Quadrature) -> Vec<(Extent, DragForce)> {
        let constant = |pair: &[Along; 2]| match pair.each_ref().map(Along::constant) {
            [Some(along), Some(across)] => Some([along, across]),
            _ => None,
        };
        let still = DragForce { flow: self.flow, ..DragForce::default() };
        if let (Some(viscous), Some(quadratic)) = (constant(&self.viscous), constant(&self.quadratic)) {
            return vec![(Extent::Beam(self.beam, rule), DragForce { viscous, quadratic, ..still })];
        }
        let viscous = Extent::pairs_along(self.beam, rule, &self.viscous).into_iter();
        let quadratic = Extent::pairs_along(self.beam, rule, &self.quadratic).into_iter();
        let viscous = viscous.map(|(extent, viscous)| (extent, DragForce { viscous, ..still }));
        let quadratic = quadratic.map(|(extent, quadratic)| (extent, DragForce { quadratic, ..still }));
        viscous.chain(quadratic).collect()
    }
}

/// The density of a [`Drag`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DragForce {
    /// Along and across the beam: c \[N s/m²\].
    pub viscous: [f64; 2],
    /// Along and across the beam: C \[N s²/m³\].
    pub quadratic: [f64; 2],
    /// Velocity of the fluid \[m/s\].
    pub flow: [f64; 2],
}

/// The drag of a steady flow on a beam at rest. It is a load that depends on the beam's direction.
/// With the velocity u = u_t t + u_n n of the beam relative to the fluid, opposite to that of the
/// flow,
///
/// ```text
/// ∂W/∂r = Σ_d φ_d a_d,   φ_d = (c_d + C_d |u_d|) u_d,   a = (t, n)
/// ∂²W/∂r∂r' = Σ_d (φ_d' (u·a_d') a_d + φ_d a_d') ⊗ n/|r'|,   t' = n,   n' = −t
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SteadyDrag(pub DragForce);

impl Density<2> for SteadyDrag {
    const ORDERS: [usize; 2] = [0, 1];
    const SYMMETRIC: bool = false;
    const CONSERVATIVE: bool = false;

    fn energy(&self, _: usize, _: &Gradient<2>) -> f64 {
        0.0
    }

    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        self.0.force(point, z, &[Vector2::zeros(); 2])
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        _: &Gradient<2>,
        _: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let length = z[1].norm();
        let along = z[1] / length;
        let across = Vector2::new(-along.y, along.x);
        let u = -Vector2::from(self.0.flow);
        let mut by_angle = Vector2::zeros();
        for (d, (axis, turned)) in [(along, across), (across, -along)].into_iter().enumerate() {
            let speed = u.dot(&axis);
            let (c, quadratic) = (self.0.viscous[d], self.0.quadratic[d] * speed.abs());
            by_angle += axis * ((c + 2.0 * quadratic) * u.dot(&turned)) + turned * ((c + quadratic) * speed);
        }
        let (zero, by_gradient) = (Matrix2::zeros(), by_angle * across.transpose() / length);
        (self.gradient(point, z), [[zero, by_gradient], [zero, zero]])
    }
}

impl DragForce {
    /// The force on a section with the gradient r' and the velocity ṙ.
    #[inline(always)]
    fn force_at<T: Real>(&self, gradient: Pair<T>, velocity: Pair<T>) -> Pair<T> {
        let inverse = dot(gradient, gradient).sqrt().inverse();
        let along = gradient.map(|x| x * inverse);
        let u = [velocity[0] - T::of(self.flow[0]), velocity[1] - T::of(self.flow[1])];
        let force = |d: usize, axis: Pair<T>| {
            let speed = dot(u, axis);
            T::of(self.quadratic[d]).fma(speed.abs(), T::of(self.viscous[d])) * speed
        };
        let [t, n] = [force(0, along), force(1, [-along[1], along[0]])];
        [t * along[0] - n * along[1], t * along[1] + n * along[0]]
    }
}

impl Dissipation<2> for DragForce {
    const ORDERS: [usize; 2] = [0, 1];

    #[inline(always)]
    fn force(&self, _: usize, z: &Gradient<2>, rate: &Gradient<2>) -> Gradient<2> {
        [self.force_at(z[1].into(), rate[0].into()).into(), Vector2::zeros()]
    }

    const BY_FOURS: bool = true;

    #[inline(always)]
    fn forces(&self, z: &[Pair<Lanes>; 2], rate: &[Pair<Lanes>; 2]) -> [Pair<Lanes>; 2] {
        [self.force_at(z[1], rate[0]), [Lanes::ZERO; 2]]
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<2>, rate: &Gradient<2>) -> (Gradient<2>, Hessian<2>) {
        let along = z[1] / z[1].norm();
        let u = rate[0] - Vector2::from(self.flow);
        let (mut force, mut matrix) = (Vector2::zeros(), Matrix2::zeros());
        for (d, axis) in [along, Vector2::new(-along.y, along.x)].into_iter().enumerate() {
            let speed = u.dot(&axis);
            let (c, quadratic) = (self.viscous[d], self.quadratic[d] * speed.abs());
            force += axis * ((c + quadratic) * speed);
            matrix += axis * axis.transpose() * (c + 2.0 * quadratic);
        }
        let zero = Matrix2::zeros();
        ([force, Vector2::zeros()], [[matrix, zero], [zero, zero]])
    }
}

/// Buoyancy of a beam in a heavy fluid: the dead force −m g per length, where m is the mass of the
/// displaced fluid per length.
#[derive(Clone, Debug, PartialEq)]
pub struct Buoyancy {
    /// Index of the beam.
    pub beam: usize,
    /// m \[kg/m\].
    pub displaced: Along,
    /// g \[m/s²\].
    pub acceleration: [f64; 2],
    /// In a motion, the law of time that g follows; without one it acts in full from the start.
    pub law: Option<Law>,
}

impl Part for Buoyancy {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("buoyancy", self.beam)?;
        let (displaced, extent) = Extent::along(self.beam, assembly.mass_rule(self.beam), &self.displaced);
        let force = self.acceleration.map(|g| -displaced * g);
        assembly.load(Kind::Buoyancy, extent, self.law.as_ref(), |z: Vec<[Vector2<f64>; 1]>| {
            DeadForce::new(force, z.into_iter().map(|[r]| r).collect())
        })
    }

    fn fades(&self) -> bool {
        true
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, [&self.displaced])
    }
}
