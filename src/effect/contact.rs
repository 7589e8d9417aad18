//! Contact of a beam with circles, half-planes and boxes of the ground, by penalty.
//!
//! With g(r) the distance of the centreline from the obstacle less half the beam's thickness, the contact has the energy W = ½ k ⟨−g⟩² per length, ⟨x⟩ = max(x, 0): the
//! pressure k ⟨−g⟩ grows with the penetration, which is the pressure divided by the stated k. Energy that goes into the contact comes back.
//!
//! Friction opposes the sliding velocity v along the surface, regularised about v = 0 over the stated velocity v₀:
//! f = −μ p v/√(v² + v₀²), with the dissipation function R = μ p (√(v² + v₀²) − v₀).

use super::{Density, Dissipation, Gradient, Hessian, Kind};
use crate::basis::Quadrature;
use crate::system::SystemError;
use crate::system::assembly::{Assembly, Extent, Part};
use nalgebra::{Matrix2, Vector2};

/// Points a cell where a contact is summed: its edge lies anywhere in a cell.
const POINTS: usize = 8;

/// What a beam can touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// A disc, or with `inside` the rim of a round hole.
    Circle {
        /// Its centre \[m\].
        center: [f64; 2],
        /// Its radius \[m\].
        radius: f64,
        /// Whether the beam is within it.
        inside: bool,
    },
    /// All that lies behind a straight line.
    HalfPlane {
        /// A point of the line \[m\].
        point: [f64; 2],
        /// Towards the beam, of length 1.
        normal: [f64; 2],
    },
    /// A rectangle.
    Box {
        /// Its centre \[m\].
        center: [f64; 2],
        /// Half its sides \[m\].
        half: [f64; 2],
        /// By which it is turned \[rad\].
        angle: f64,
    },
}

impl Obstacle {
    /// Its border; of a half-plane as long as the beams.
    fn outline(&self, size: f64) -> Vec<[f64; 2]> {
        match *self {
            Self::Circle { center: [x, y], radius, .. } => {
                let at = |i: u32| {
                    let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 72.0).sin_cos();
                    [x + radius * cosine, y + radius * sine]
                };
                (0..=72).map(at).collect()
            }
            Self::HalfPlane { point: [x, y], normal: [nx, ny] } => {
                [-size, size].map(|along| [x - along * ny, y + along * nx]).into()
            }
            Self::Box { center: [x, y], half: [a, b], angle } => {
                let (sine, cosine) = angle.sin_cos();
                let corner = |(a, b): (f64, f64)| [x + cosine * a - sine * b, y + sine * a + cosine * b];
                [(a, b), (-a, b), (-a, -b), (a, -b), (a, b)].map(corner).into()
            }
        }
    }

    /// Signed distance of a point, its gradient, and its second derivative.
    fn distance(&self, r: &Vector2<f64>) -> (f64, Vector2<f64>, Matrix2<f64>) {
        // From a point: the distance and its derivatives.
        let from = |d: Vector2<f64>| {
            let length = d.norm();
            let e = if length > 0.0 { d / length } else { Vector2::x() };
            (length, e, (Matrix2::identity() - e * e.transpose()) / length)
        };
        match *self {
            Self::Circle { center, radius, inside } => {
                let (length, e, second) = from(r - Vector2::from(center));
                if inside { (radius - length, -e, -second) } else { (length - radius, e, second) }
            }
            Self::HalfPlane { point, normal } => {
                let normal = Vector2::from(normal);
                (normal.dot(&(r - Vector2::from(point))), normal, Matrix2::zeros())
            }
            Self::Box { center, half, angle } => {
                let (sine, cosine) = angle.sin_cos();
                let turn = Matrix2::new(cosine, -sine, sine, cosine);
                let local = turn.transpose() * (r - Vector2::from(center));
                let beyond = Vector2::new(local.x.abs() - half[0], local.y.abs() - half[1]);
                let sign = local.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
                let (distance, e, second) = if beyond.x > 0.0 && beyond.y > 0.0 {
                    // Nearest to a corner.
                    from(beyond)
                } else if beyond.x > beyond.y {
                    (beyond.x, Vector2::x(), Matrix2::zeros())
                } else {
                    (beyond.y, Vector2::y(), Matrix2::zeros())
                };
                let frame = turn * Matrix2::from_diagonal(&sign);
                (distance, frame * e, frame * second * frame.transpose())
            }
        }
    }
}

/// Contact of one beam with one obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the beam.
    pub beam: usize,
    /// What it touches.
    pub obstacle: Obstacle,
    /// k \[N/m²\]: pressure per length and penetration.
    pub stiffness: f64,
    /// Distance of the beam's surface from its centreline \[m\].
    pub half_thickness: f64,
    /// Friction.
    pub friction: Option<Friction>,
}

/// Regularised dry friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// μ.
    pub coefficient: f64,
    /// v₀ \[m/s\].
    pub velocity: f64,
}

impl Part for Contact {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), SystemError> {
        assembly.beam("contact", self.beam)?;
        let extent = Extent::Beam(self.beam, Quadrature::Gauss(POINTS));
        let normal = Penalty { obstacle: self.obstacle, stiffness: self.stiffness, gap: self.half_thickness };
        assembly.elastic(Kind::Contact, extent, |_| normal)?;
        if let Some(friction) = self.friction {
            assembly.damping(Kind::Friction, extent, |_| Rubbing { normal, friction })?;
        }
        Ok(())
    }

    fn outline(&self, size: f64) -> Vec<[f64; 2]> {
        self.obstacle.outline(size)
    }
}

/// W = ½ k ⟨−g⟩².
#[derive(Clone, Copy, Debug)]
pub struct Penalty {
    /// What is touched.
    pub obstacle: Obstacle,
    /// k \[N/m²\].
    pub stiffness: f64,
    /// Distance at which it is touched \[m\].
    pub gap: f64,
}

impl Penalty {
    /// ⟨−g⟩, ∂g/∂r and ∂²g/∂r²; nothing without contact.
    fn penetration(&self, r: &Vector2<f64>) -> Option<(f64, Vector2<f64>, Matrix2<f64>)> {
        let (distance, normal, second) = self.obstacle.distance(r);
        (distance < self.gap).then_some((self.gap - distance, normal, second))
    }
}

impl Density<1> for Penalty {
    const ORDERS: [usize; 1] = [0];

    fn energy(&self, _: usize, z: &Gradient<1>) -> f64 {
        self.penetration(&z[0]).map_or(0.0, |(depth, ..)| 0.5 * self.stiffness * depth * depth)
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let force = |(depth, normal, _): (f64, Vector2<f64>, _)| normal * (-self.stiffness * depth);
        [self.penetration(&z[0]).map_or_else(Vector2::zeros, force)]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let hessian = self.penetration(&z[0]).map_or_else(Matrix2::zeros, |(depth, normal, second)| {
            (normal * normal.transpose() - second * depth) * self.stiffness
        });
        (self.gradient(point, z), [[hessian]])
    }
}

/// R = μ p (√(v² + v₀²) − v₀) with the pressure p and the sliding velocity v.
#[derive(Clone, Copy, Debug)]
pub struct Rubbing {
    /// Where the pressure comes from.
    pub normal: Penalty,
    /// μ and v₀.
    pub friction: Friction,
}

impl Dissipation<1> for Rubbing {
    const ORDERS: [usize; 1] = [0];

    #[inline(always)]
    fn force(&self, point: usize, z: &Gradient<1>, rate: &Gradient<1>) -> Gradient<1> {
        self.force_and_matrix(point, z, rate).0
    }

    #[inline(always)]
    fn force_and_matrix(&self, _: usize, z: &Gradient<1>, rate: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let Some((depth, normal, _)) = self.normal.penetration(&z[0]) else {
            return ([Vector2::zeros()], [[Matrix2::zeros()]]);
        };
        let Friction { coefficient, velocity } = self.friction;
        let along = Vector2::new(-normal.y, normal.x);
        let speed = along.dot(&rate[0]);
        let smooth = speed.hypot(velocity);
        let limit = coefficient * self.normal.stiffness * depth;
        let matrix = along * along.transpose() * (limit * velocity * velocity / smooth.powi(3));
        ([along * (limit * speed / smooth)], [[matrix]])
    }
}
