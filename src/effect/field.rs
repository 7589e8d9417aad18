//! Forces per length that depend on the place, and in motions on the time, by formulas.
//!
//! A formula that contains the time t makes a load that is asked anew at every time
//! ([`crate::assembly::TimedLoad`]); one that does not is a load like others. The potential U(x, y, t)
//! gives the force −∇U at each time. Its tangent is symmetric, but energy is not conserved in it: what
//! it gives is counted as work.

use crate::assembly::{
    Assembly, BuildError, CompiledFor, Density, Extent, Gradient, Hessian, Kind, Part, Resistance,
    TimedDensity, edges_along,
};
use crate::beam::{Along, Place};
use crate::law::Law;
use crate::numeric::Formula;
use nalgebra::{Matrix2, Vector2};

/// The variables of a field: coordinates in metres, and the time in seconds.
const VARIABLES: [&str; 3] = ["x", "y", "t"];
/// Number of the time among them.
const TIME: usize = 2;

/// A force per reference length \[N/m\] that is a function of the place, and in a motion of the time.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceField {
    /// Index of the beam.
    pub beam: usize,
    /// The force.
    pub field: Field,
    /// 1 along the beam where it acts, and 0 elsewhere.
    pub acting: Along,
    /// In a motion, the law of time that multiplies it.
    pub law: Option<Law>,
}

/// A force as a function of place and time, with its derivatives by the place.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// F = −∇U.
    Potential(Potential),
    /// Components that need not have a potential.
    Components(Components),
}

/// U(x, y, t) \[J/m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Potential {
    value: Formula,
    first: [Formula; 2],
    /// ∂²U/∂x², ∂²U/∂x∂y, ∂²U/∂y².
    second: [Formula; 3],
}

/// (Fx, Fy)(x, y, t) \[N/m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Components {
    values: [Formula; 2],
    /// Of each component, by x and by y.
    first: [[Formula; 2]; 2],
}

impl Field {
    /// The force of the potential U that `text` says as a formula of x, y and t.
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn of_potential(text: &str) -> Result<Self, String> {
        let value = Formula::new(text, &VARIABLES)?;
        let first = [value.derivative(0)?, value.derivative(1)?];
        let second = [first[0].derivative(0)?, first[0].derivative(1)?, first[1].derivative(1)?];
        Ok(Self::Potential(Potential { value, first, second }))
    }

    /// The force with the components that the texts say as formulas of x, y and t.
    ///
    /// # Errors
    /// As [`Self::of_potential`].
    pub fn of_components([x, y]: [&str; 2]) -> Result<Self, String> {
        let values = [Formula::new(x, &VARIABLES)?, Formula::new(y, &VARIABLES)?];
        let by = |value: &Formula| Ok::<_, String>([value.derivative(0)?, value.derivative(1)?]);
        let first = [by(&values[0])?, by(&values[1])?];
        Ok(Self::Components(Components { values, first }))
    }

    /// The force \[N/m\] at x, y \[m\] and t \[s\].
    pub fn at(&self, place: [f64; 3]) -> [f64; 2] {
        match self {
            Self::Potential(potential) => potential.first.each_ref().map(|first| -first.at(&place)),
            Self::Components(components) => components.values.each_ref().map(|value| value.at(&place)),
        }
    }

    /// Whether it depends on the time, which only motions have.
    pub fn depends_on_time(&self) -> bool {
        match self {
            Self::Potential(potential) => potential.value.contains(TIME),
            Self::Components(components) => components.values.iter().any(|value| value.contains(TIME)),
        }
    }
}

impl Part for ForceField {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("a force field", self.beam)?;
        let (factor, extent) = Extent::along(self.beam, assembly.mass_rule(self.beam), &self.acting);
        let (kind, law) = (Kind::ForceField, self.law.as_ref());
        let what = "the formula of a force field";
        match &self.field {
            Field::Potential(potential) => {
                let density = |z: Vec<[Vector2<f64>; 1]>| {
                    let start = z.iter().map(|[r]| potential.value.at(&[r.x, r.y, 0.0])).collect();
                    PotentialField { potential: potential.clone(), factor, start }
                };
                if self.field.depends_on_time() {
                    return assembly.timed_density(what, kind, &extent, law, density);
                }
                assembly.load(kind, extent, law, density)
            }
            Field::Components(components) => {
                let density = |_| ComponentField { components: components.clone(), factor };
                if self.field.depends_on_time() {
                    return assembly.timed_density(what, kind, &extent, law, density);
                }
                assembly.load(kind, extent, law, density)
            }
        }
    }

    fn fades(&self) -> bool {
        !self.field.depends_on_time()
    }

    fn resists(&self) -> Vec<Resistance> {
        let start = Place { beam: self.beam, s: 0.0 };
        let axes = [[1.0, 0.0], [0.0, 1.0]].map(|axis| Resistance::Displacement(start, axis));
        axes.into_iter().chain([Resistance::Direction(start)]).collect()
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, [&self.acting])
    }
}

/// W = U(r, t) − U(r₀, t).
#[derive(Clone, Debug)]
struct PotentialField {
    potential: Potential,
    factor: f64,
    /// U of the stress-free shape.
    start: Vec<f64>,
}

impl Density<1> for PotentialField {
    const ORDERS: [usize; 1] = [0];
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, point: usize, z: &Gradient<1>) -> f64 {
        self.factor * (self.potential.value.at(&[z[0].x, z[0].y, 0.0]) - self.start[point])
    }

    fn gradient(&self, point: usize, z: &Gradient<1>) -> Gradient<1> {
        self.gradient_at(0.0, point, z)
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        self.gradient_and_hessian_at(0.0, point, z)
    }
}

impl TimedDensity<1> for PotentialField {
    fn gradient_at(&self, time: f64, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let at = [z[0].x, z[0].y, time];
        [Vector2::from(self.potential.first.each_ref().map(|first| self.factor * first.at(&at)))]
    }

    fn gradient_and_hessian_at(&self, time: f64, point: usize, z: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let at = [z[0].x, z[0].y, time];
        let [xx, xy, yy] = self.potential.second.each_ref().map(|second| self.factor * second.at(&at));
        (self.gradient_at(time, point, z), [[Matrix2::new(xx, xy, xy, yy)]])
    }
}

/// ∂W/∂r = −F(r, t), without an energy.
#[derive(Clone, Debug)]
struct ComponentField {
    components: Components,
    factor: f64,
}

impl Density<1> for ComponentField {
    const ORDERS: [usize; 1] = [0];
    const SYMMETRIC: bool = false;
    const CONSERVATIVE: bool = false;
    const COMPILED_FOR: CompiledFor = CompiledFor::None;

    fn energy(&self, _: usize, _: &Gradient<1>) -> f64 {
        0.0
    }

    fn gradient(&self, point: usize, z: &Gradient<1>) -> Gradient<1> {
        self.gradient_at(0.0, point, z)
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        self.gradient_and_hessian_at(0.0, point, z)
    }
}

impl TimedDensity<1> for ComponentField {
    fn gradient_at(&self, time: f64, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let at = [z[0].x, z[0].y, time];
        [Vector2::from(self.components.values.each_ref().map(|value| -self.factor * value.at(&at)))]
    }

    fn gradient_and_hessian_at(&self, time: f64, point: usize, z: &Gradient<1>) -> (Gradient<1>, Hessian<1>) {
        let at = [z[0].x, z[0].y, time];
        let [[xx, xy], [yx, yy]] = self
            .components
            .first
            .each_ref()
            .map(|of| of.each_ref().map(|derivative| -self.factor * derivative.at(&at)));
        (self.gradient_at(time, point, z), [[Matrix2::new(xx, xy, yx, yy)]])
    }
}
