//! Forces per length that depend on the place, by formulas.

use crate::assembly::{
    Assembly, BuildError, CompiledFor, Density, Extent, Gradient, Hessian, Kind, Part, Resistance,
};
use crate::beam::{Along, Place};
use crate::law::Law;
use crate::numeric::Formula;
use nalgebra::{Matrix2, Vector2};

/// The variables of a field: coordinates in metres.
const PLACE: [&str; 2] = ["x", "y"];

/// A force per reference length \[N/m\] that is a function of the place.
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

/// A force as a function of the place, with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// F = −∇U.
    Potential(Potential),
    /// Components that need not have a potential.
    Components(Components),
}

/// U(x, y) \[J/m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Potential {
    value: Formula,
    first: [Formula; 2],
    /// ∂²U/∂x², ∂²U/∂x∂y, ∂²U/∂y².
    second: [Formula; 3],
}

/// (Fx, Fy)(x, y) \[N/m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Components {
    values: [Formula; 2],
    /// Of each component, by x and by y.
    first: [[Formula; 2]; 2],
}

impl Field {
    /// The force of the potential U that `text` says as a formula of x and y.
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn of_potential(text: &str) -> Result<Self, String> {
        let value = Formula::new(text, &PLACE)?;
        let first = [value.derivative(0)?, value.derivative(1)?];
        let second = [first[0].derivative(0)?, first[0].derivative(1)?, first[1].derivative(1)?];
        Ok(Self::Potential(Potential { value, first, second }))
    }

    /// The force with the components that the texts say as formulas of x and y.
    ///
    /// # Errors
    /// As [`Self::of_potential`].
    pub fn of_components([x, y]: [&str; 2]) -> Result<Self, String> {
        let values = [Formula::new(x, &PLACE)?, Formula::new(y, &PLACE)?];
        let by = |value: &Formula| Ok::<_, String>([value.derivative(0)?, value.derivative(1)?]);
        let first = [by(&values[0])?, by(&values[1])?];
        Ok(Self::Components(Components { values, first }))
    }
}

impl Part for ForceField {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("a force field", self.beam)?;
        let (factor, extent) = Extent::along(self.beam, assembly.mass_rule(self.beam), &self.acting);
        let law = self.law.as_ref();
        match &self.field {
            Field::Potential(potential) => {
                let density = |z: Vec<[Vector2<f64>; 1]>| {
                    let start = z.iter().map(|[r]| potential.value.at(&[r.x, r.y])).collect();
                    PotentialField { potential: potential.clone(), factor, start }
                };
                assembly.load(Kind::ForceField, extent, law, density)
            }
            Field::Components(components) => {
                let density = ComponentField { components: components.clone(), factor };
                assembly.load(Kind::ForceField, extent, law, |_| density)
            }
        }
    }

    fn resists(&self) -> Vec<Resistance> {
        let start = Place { beam: self.beam, s: 0.0 };
        let axes = [[1.0, 0.0], [0.0, 1.0]].map(|axis| Resistance::Displacement(start, axis));
        axes.into_iter().chain([Resistance::Direction(start)]).collect()
    }
}

/// W = U(r) − U(r₀).
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
        self.factor * (self.potential.value.at(&[z[0].x, z[0].y]) - self.start[point])
    }

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let at = [z[0].x, z[0].y];
        [Vector2::from(self.potential.first.each_ref().map(|first| self.factor * first.at(&at)))]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let at = [z[0].x, z[0].y];
        let [xx, xy, yy] = self.potential.second.each_ref().map(|second| self.factor * second.at(&at));
        (self.gradient(point, z), [[Matrix2::new(xx, xy, xy, yy)]])
    }
}

/// ∂W/∂r = −F(r), without an energy.
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

    fn gradient(&self, _: usize, z: &Gradient<1>) -> Gradient<1> {
        let at = [z[0].x, z[0].y];
        [Vector2::from(self.components.values.each_ref().map(|value| -self.factor * value.at(&at)))]
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<1>,
        _: &Gradient<1>,
        _: &Gradient<1>,
    ) -> (Gradient<1>, Hessian<1>) {
        let at = [z[0].x, z[0].y];
        let [[xx, xy], [yx, yy]] = self
            .components
            .first
            .each_ref()
            .map(|of| of.each_ref().map(|derivative| -self.factor * derivative.at(&at)));
        (self.gradient(point, z), [[Matrix2::new(xx, xy, yx, yy)]])
    }
}
