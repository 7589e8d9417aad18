//! Quantities that may vary along a beam.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};

use crate::scene::quantity::{Any, Measure, Quantity, Range};
use crate::scene::value::{At, Located, Vector};

/// A quantity of a beam: a number, or a table of how it varies along the arc length.
#[derive(Clone, Debug)]
pub enum AlongBeam<M, R = Any> {
    /// The same everywhere.
    Constant(Quantity<M, R>),
    /// Exactly one kind of variation.
    Varying(VaryingTable<M, R>),
}

/// How a quantity varies along the arc length of a beam: exactly one of the keys.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, bound = "M: Measure, R: Range")]
pub struct VaryingTable<M, R> {
    /// Linear between values at arc lengths.
    pub table: Option<Located<PlacesTable<M, R>>>,
    /// Coefficients of 1, s, s², …, with s in metres.
    pub polynomial: Option<Located<Vec<Quantity<M>>>>,
    /// Constant by pieces.
    pub pieces: Option<Located<PiecesTable<M, R>>>,
}

/// Values at arc lengths, linear between them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, bound = "M: Measure, R: Range")]
pub struct PlacesTable<M, R> {
    /// Arc lengths, rising from the beam's start to its end.
    pub s: Vec<Located<At>>,
    /// The value at each.
    pub value: Located<Vec<Quantity<M, R>>>,
}

/// Constant by pieces.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, bound = "M: Measure, R: Range")]
pub struct PiecesTable<M, R> {
    /// Arc lengths at which pieces end, rising; the end of the last one may be left out.
    pub until: Vec<Located<At>>,
    /// The value of each piece.
    pub value: Located<Vec<Quantity<M, R>>>,
}

impl<'de, M: Measure, R: Range> Deserialize<'de> for AlongBeam<M, R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<M, R>(PhantomData<(M, R)>);

        /// Reads a number or text as a quantity does.
        fn constant<'de, M: Measure, R: Range, E: serde::de::Error>(
            value: impl IntoDeserializer<'de, E>,
        ) -> Result<AlongBeam<M, R>, E> {
            Quantity::deserialize(value.into_deserializer()).map(AlongBeam::Constant)
        }

        impl<'de, M: Measure, R: Range> Visitor<'de> for Reader<M, R> {
            type Value = AlongBeam<M, R>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(
                    f,
                    "{}; or a table of how it varies along the beam: `table`, `polynomial` or `pieces`",
                    Quantity::<M, R>::expected()
                )
            }

            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Self::Value, E> {
                constant(value)
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Self::Value, E> {
                constant(value)
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Self::Value, E> {
                constant(value)
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Self::Value, E> {
                constant(text)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                VaryingTable::deserialize(MapAccessDeserializer::new(map)).map(AlongBeam::Varying)
            }
        }

        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<M: Measure, R: Range> JsonSchema for AlongBeam<M, R> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}AlongBeam", Quantity::<M, R>::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let constant = generator.subschema_for::<Quantity<M, R>>();
        let coefficient = generator.subschema_for::<Quantity<M>>();
        let place = generator.subschema_for::<At>();
        schema(constant, coefficient, place)
    }
}

/// The schema of a quantity of which those of a value, a coefficient and a place are given.
fn schema(constant: Schema, coefficient: Schema, place: Schema) -> Schema {
    let places = |description: &str| json_schema!({ "type": "array", "items": place.clone(), "description": description });
    let values =
        json_schema!({ "type": "array", "items": constant.clone(), "description": "A value for each." });
    json_schema!({
        "description": "A value, or how it varies along the arc length of the beam.",
        "anyOf": [
            constant,
            {
                "type": "object",
                "additionalProperties": false,
                "minProperties": 1,
                "maxProperties": 1,
                "properties": {
                    "table": {
                        "description": "Linear between values at arc lengths.",
                        "type": "object",
                        "additionalProperties": false,
                        "required": ["s", "value"],
                        "properties": {
                            "s": places("Arc lengths, rising from the beam's start to its end."),
                            "value": values.clone(),
                        },
                    },
                    "polynomial": {
                        "description": "Coefficients of 1, s, s², …, with s in metres.",
                        "type": "array",
                        "minItems": 1,
                        "items": coefficient,
                    },
                    "pieces": {
                        "description": "Constant by pieces.",
                        "type": "object",
                        "additionalProperties": false,
                        "required": ["until", "value"],
                        "properties": {
                            "until": places("Arc lengths at which pieces end, rising; the end of the last one may be left out."),
                            "value": values,
                        },
                    },
                },
            },
        ],
    })
}

/// The components of a vector, each of which may vary along a beam.
#[derive(Clone, Debug)]
pub struct AlongVector<M>(pub [Located<AlongBeam<M>>; 2]);

impl<'de, M: Measure> Deserialize<'de> for AlongVector<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<M>(PhantomData<M>);

        impl<'de, M: Measure> Visitor<'de> for Reader<M> {
            type Value = AlongVector<M>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&Vector::<M>::expected())
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
                let mut components = Vec::with_capacity(2);
                while let Some(item) = items.next_element()? {
                    components.push(item);
                }
                components
                    .try_into()
                    .map(AlongVector)
                    .map_err(|found: Vec<_>| serde::de::Error::custom(Vector::<M>::wrong_count(found.len())))
            }
        }

        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<M: Measure> JsonSchema for AlongVector<M> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("VectorOf{}", AlongBeam::<M>::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let component = generator.subschema_for::<AlongBeam<M>>();
        json_schema!({ "type": "array", "items": component, "minItems": 2, "maxItems": 2 })
    }
}
