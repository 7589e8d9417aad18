//! Numbers with a dimension, as a scene writes them: `1.8` (SI) or `"180 cm"`.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Visitor};

use super::unit::{self, Dimension};

/// What a key measures: its dimension, and the words and examples of its messages.
pub trait Measure {
    /// Name in messages and in the schema, such as `length`.
    const NAME: &'static str;
    /// The SI unit of plain numbers; empty for a pure number.
    const SI: &'static str;
    /// An example with a unit, without quotation marks.
    const EXAMPLE: &'static str;
    /// Its dimension.
    const DIMENSION: Dimension;
}

macro_rules! measures {
    ($($(#[$doc:meta])* $type:ident: $name:literal, $si:literal, $example:literal, $dimension:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum $type {}

        impl Measure for $type {
            const NAME: &'static str = $name;
            const SI: &'static str = $si;
            const EXAMPLE: &'static str = $example;
            const DIMENSION: Dimension = $dimension;
        }
    )*};
}

measures! {
    /// A length or coordinate \[m\].
    Length: "length", "m", "1.8 m", Dimension::new(1, 0, 0);
    /// A duration \[s\].
    Time: "time", "s", "10 ms", Dimension::new(0, 0, 1);
    /// An angle \[rad\].
    Angle: "angle", "rad", "90 deg", Dimension::ANGLE;
    /// Young's modulus [Pa].
    Stress: "stress", "Pa", "68.95 GPa", Dimension::new(-1, 1, -2);
    /// Area of a section \[m²\].
    Area: "area", "m^2", "2.5 cm^2", Dimension::new(2, 0, 0);
    /// Second moment of area \[m⁴\].
    SecondMoment: "second moment of area", "m^4", "0.13 cm^4", Dimension::new(4, 0, 0);
    /// Mass per volume \[kg/m³\].
    Density: "density", "kg/m^3", "7.85 g/cm^3", Dimension::new(-3, 1, 0);
    /// Force; also axial stiffness EA \[N\].
    Force: "force", "N", "3 kN", Dimension::new(1, 1, -2);
    /// Bending stiffness EI \[N m²\].
    BendingStiffness: "bending stiffness", "N m^2", "89.6 N m^2", Dimension::new(3, 1, -2);
    /// Mass per length \[kg/m\].
    MassPerLength: "mass per length", "kg/m", "0.69 kg/m", Dimension::new(-1, 1, 0);
    /// Moment \[N m\].
    Moment: "moment", "N m", "3 kN m", Dimension::new(2, 1, -2);
    /// Force per length \[N/m\].
    ForcePerLength: "force per length", "N/m", "5 N/mm", Dimension::new(0, 1, -2);
    /// Force per length and displacement \[N/m²\].
    StiffnessPerLength: "stiffness per length", "N/m^2", "1e5 N/m^2", Dimension::new(-1, 1, -2);
    /// Acceleration \[m/s²\].
    Acceleration: "acceleration", "m/s^2", "-9.81 m/s^2", Dimension::new(1, 0, -2);
    /// Velocity \[m/s\].
    Velocity: "velocity", "m/s", "2 m/s", Dimension::new(1, 0, -1);
    /// Angular velocity \[rad/s\].
    AngularVelocity: "angular velocity", "rad/s", "90 deg/s", Dimension { metre: 0, kilogram: 0, second: -1, radian: 1, ampere: 0 };
    /// Cycles per second \[Hz\].
    Frequency: "frequency", "Hz", "2 Hz", Dimension::new(0, 0, -1);
    /// Curvature \[1/m\].
    Curvature: "curvature", "1/m", "0.5 1/m", Dimension::new(-1, 0, 0);
    /// Mass \[kg\].
    Mass: "mass", "kg", "200 g", Dimension::new(0, 1, 0);
    /// Moment of inertia \[kg m²\].
    RotaryInertia: "moment of inertia", "kg m^2", "3 g m^2", Dimension::new(2, 1, 0);
    /// Moment of inertia per length \[kg m\].
    RotaryInertiaPerLength: "moment of inertia per length", "kg m", "2 g m", Dimension::new(1, 1, 0);
    /// Force per velocity \[N s/m\].
    TranslationalDamping: "force per velocity", "N s/m", "5 N s/m", Dimension::new(0, 1, -1);
    /// Moment per angular velocity \[N m s\].
    TorsionalDamping: "moment per angular velocity", "N m s", "0.1 N m s", Dimension::new(2, 1, -1);
    /// Force per length and velocity \[N s/m²\].
    ViscousDamping: "force per length and velocity", "N s/m^2", "2 N s/m^2", Dimension::new(-1, 1, -1);
    /// Force per length and squared velocity \[N s²/m³\].
    DragCoefficient: "force per length and squared velocity", "N s^2/m^3", "6 N s^2/m^3", Dimension::new(-2, 1, 0);
    /// Electric potential \[V\].
    Voltage: "voltage", "V", "30 V", Dimension { metre: 2, kilogram: 1, second: -3, radian: 0, ampere: -1 };
    /// Permittivity \[F/m\].
    Permittivity: "permittivity", "F/m", "8.854 pF/m", Dimension { metre: -3, kilogram: -1, second: 4, radian: 0, ampere: 2 };
    /// A pure number.
    Ratio: "number", "", "0.5", Dimension::new(0, 0, 0);
}

/// Which values a key accepts, besides finite ones.
pub trait Range {
    /// In words, with a trailing blank, such as `positive `.
    const WORD: &'static str;
    /// The bound for the schema, as key and value.
    const BOUND: Option<&'static str>;
    /// Whether `value` lies within.
    fn contains(value: f64) -> bool;
}

/// Any finite number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Any {}

impl Range for Any {
    const WORD: &'static str = "";
    const BOUND: Option<&'static str> = None;

    fn contains(_: f64) -> bool {
        true
    }
}

/// Greater than zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Positive {}

impl Range for Positive {
    const WORD: &'static str = "positive ";
    const BOUND: Option<&'static str> = Some("exclusiveMinimum");

    fn contains(value: f64) -> bool {
        value > 0.0
    }
}

/// A finite number in SI, of dimension `M` and within `R`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity<M, R = Any> {
    /// In SI.
    pub si: f64,
    kind: PhantomData<(M, R)>,
}

/// What a value of a key must be: [`Measure`] and [`Range`] as values, so that what reads them is
/// compiled once.
struct Kind {
    name: &'static str,
    si: &'static str,
    example: &'static str,
    dimension: Dimension,
    word: &'static str,
    bound: Option<&'static str>,
    contains: fn(f64) -> bool,
}

impl Kind {
    fn expected(&self) -> String {
        let Self { name, si, example, word, .. } = self;
        let article = if word.is_empty() && name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        if si.is_empty() {
            return format!("{article} {word}{name}, such as {example}");
        }
        format!("{article} {word}{name}: a number in {si}, or text with a unit such as \"{example}\"")
    }

    fn check(&self, value: f64, found: &dyn fmt::Display) -> Result<f64, String> {
        if !value.is_finite() || !(self.contains)(value) {
            let finite = if value.is_finite() { "" } else { "; it must be finite" };
            return Err(format!("found {found}, expected {}{finite}", self.expected()));
        }
        Ok(value)
    }

    fn parse(&self, text: &str) -> Result<f64, String> {
        let quoted = format!("{text:?}");
        let (number, symbol) = unit::split_number(text)
            .map_err(|reason| format!("found {quoted}, expected {}: {reason}", self.expected()))?;
        if symbol.is_empty() {
            let si = self.si;
            if si.is_empty() {
                return self.check(number, &quoted);
            }
            return Err(format!(
                "found {quoted}, which has no unit, expected {}\nwrite {number} without quotation marks for {si}, \
                 or \"{number} {si}\"",
                self.expected(),
            ));
        }
        let unit = unit::parse_unit(symbol).map_err(|reason| {
            format!("found {quoted}, expected {}\nin the unit: {reason}", self.expected())
        })?;
        if unit.dimension != self.dimension {
            return Err(format!(
                "found {quoted}, whose dimension is {}, not {}; expected {}",
                unit.dimension,
                self.dimension,
                self.expected()
            ));
        }
        self.check(number * unit.factor, &quoted)
    }

    /// The words of its range and its name, each with a capital.
    fn schema_name(&self) -> String {
        let mut name: String = self.word.trim_end().into();
        for word in self.name.split(' ') {
            name.push_str(word.get(..1).unwrap_or_default().to_uppercase().as_str());
            name.push_str(word.get(1..).unwrap_or_default());
        }
        name.replace("positive", "Positive")
    }

    fn schema(&self) -> Schema {
        let mut number = json_schema!({ "type": "number" });
        if let Some(bound) = self.bound {
            number.insert(bound.into(), 0.into());
        }
        if self.si.is_empty() {
            number.insert("description".into(), self.expected().into());
            return number;
        }
        json_schema!({
            "description": self.expected(),
            "anyOf": [
                number,
                { "type": "string", "pattern": r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[^\d\s]" },
            ],
            "examples": [self.example],
        })
    }
}

impl<M: Measure, R: Range> Quantity<M, R> {
    const KIND: Kind = Kind {
        name: M::NAME,
        si: M::SI,
        example: M::EXAMPLE,
        dimension: M::DIMENSION,
        word: R::WORD,
        bound: R::BOUND,
        contains: R::contains,
    };

    /// `a positive length: a number in m, or text with a unit such as "1.8 m"`.
    pub fn expected() -> String {
        Self::KIND.expected()
    }

    fn new(si: f64) -> Self {
        Self { si, kind: PhantomData }
    }

    /// Reads `"1.8 m"`.
    ///
    /// # Errors
    /// What was found and what is legal, in one sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::KIND.parse(text).map(Self::new)
    }
}

impl<'de, M: Measure, R: Range> Deserialize<'de> for Quantity<M, R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<M, R>(PhantomData<(M, R)>);

        impl<M: Measure, R: Range> Reader<M, R> {
            fn checked<E: serde::de::Error>(
                value: f64,
                found: &dyn fmt::Display,
            ) -> Result<Quantity<M, R>, E> {
                Quantity::<M, R>::KIND.check(value, found).map(Quantity::new).map_err(E::custom)
            }
        }

        impl<M: Measure, R: Range> Visitor<'_> for Reader<M, R> {
            type Value = Quantity<M, R>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&Quantity::<M, R>::expected())
            }

            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Self::Value, E> {
                Self::checked(value, &value)
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Self::Value, E> {
                Self::checked(value as f64, &value)
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Self::Value, E> {
                Self::checked(value as f64, &value)
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
                Quantity::parse(text).map_err(E::custom)
            }
        }

        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<M: Measure, R: Range> JsonSchema for Quantity<M, R> {
    fn schema_name() -> Cow<'static, str> {
        Self::KIND.schema_name().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        Self::KIND.schema()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_dimension_names_both() {
        let message = Quantity::<Length>::parse("3 kg").unwrap_err();
        assert!(message.contains("is kg, not m") && message.contains("\"1.8 m\""), "{message}");
    }

    #[test]
    fn only_finite_values_in_range() {
        assert!(Quantity::<Length, Positive>::parse("0 m").is_err());
        assert!(Quantity::<Length, Positive>::parse("-1 m").is_err());
        assert!(Quantity::<Length>::parse("1e308 Tm").is_err());
        assert_eq!(Quantity::<Length>::parse("-45 cm").unwrap().si, -0.45);
        assert!(Quantity::<Angle>::parse("3 m").is_err());
    }
}
