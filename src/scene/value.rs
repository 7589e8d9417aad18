//! Values of scene files that are not plain quantities: counts, places along a beam, node lists —
//! and [`Located`], which remembers where in the text a value stands.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range as ByteRange;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};

use super::quantity::{Length, Measure, Positive, Quantity, Ratio};
use super::reader::PLACE;

/// A value and the bytes of the text that it came from; compared by the value.
#[derive(Clone, Debug)]
pub struct Located<T> {
    value: T,
    start: usize,
    end: usize,
}

impl<T> Located<T> {
    /// The value.
    pub fn get(&self) -> &T {
        &self.value
    }

    /// Where it stands.
    pub fn span(&self) -> ByteRange<usize> {
        self.start..self.end
    }
}

impl<T: PartialEq> PartialEq for Located<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: Eq> Eq for Located<T> {}

impl<T: PartialOrd> PartialOrd for Located<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<T: Ord> Ord for Located<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.value.cmp(&other.value)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Located<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = Located<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a value and its place")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Located<T>, A::Error> {
                match (items.next_element()?, items.next_element()?, items.next_element()?) {
                    (Some(start), Some(end), Some(value)) => Ok(Located { value, start, end }),
                    _ => Err(serde::de::Error::custom("a value without its place")),
                }
            }
        }

        deserializer.deserialize_tuple_struct(PLACE, 3, Reader(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for Located<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A whole number from `MIN` on; the upper bounds depend on what is counted and are checked later.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count<const MIN: u64>(pub u64);

impl<const MIN: u64> Count<MIN> {
    fn expected() -> String {
        format!("a whole number, {MIN} or more")
    }

    fn check<E: serde::de::Error>(value: i128) -> Result<Self, E> {
        match u64::try_from(value) {
            Ok(value) if value >= MIN => Ok(Self(value)),
            _ => Err(E::custom(format!("found {value}, expected {}", Self::expected()))),
        }
    }
}

impl<'de, const MIN: u64> Deserialize<'de> for Count<MIN> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<const MIN: u64>;

        impl<const MIN: u64> Visitor<'_> for Reader<MIN> {
            type Value = Count<MIN>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&Count::<MIN>::expected())
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<Self::Value, E> {
                Count::check(value.into())
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<Self::Value, E> {
                Count::check(value.into())
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

impl<const MIN: u64> JsonSchema for Count<MIN> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("CountFrom{MIN}").into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": MIN })
    }
}

/// A point of a beam: `"start"`, `"end"`, or an arc length from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// s = 0.
    Start,
    /// s = L.
    End,
    /// s \[m\].
    ArcLength(f64),
}

impl At {
    const EXPECTED: &'static str =
        "\"start\", \"end\" or an arc length from the start: a number in m, or text such as \"45 cm\"";
    /// Distance from an end, in lengths of the beam, that counts as round-off.
    pub(super) const ROUND_OFF: f64 = 1e-9;

    /// The arc length \[m\] on a beam of the given `length`. An end typed with fewer digits than the length has is meant as the end.
    pub(super) fn on(self, length: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::End => length,
            Self::ArcLength(s) if (0.0..=Self::ROUND_OFF * length).contains(&s) => 0.0,
            Self::ArcLength(s) if (s - length).abs() <= Self::ROUND_OFF * length => length,
            Self::ArcLength(s) => s,
        }
    }
}

impl<'de> Deserialize<'de> for At {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl Visitor<'_> for Reader {
            type Value = At;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(At::EXPECTED)
            }

            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<At, E> {
                if value.is_finite() {
                    return Ok(At::ArcLength(value));
                }
                Err(E::custom(format!("found {value}, expected {}", At::EXPECTED)))
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<At, E> {
                Ok(At::ArcLength(value as f64))
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<At, E> {
                Ok(At::ArcLength(value as f64))
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<At, E> {
                match text {
                    "start" => Ok(At::Start),
                    "end" => Ok(At::End),
                    _ if text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) => {
                        Quantity::<Length>::parse(text).map(|s| At::ArcLength(s.si)).map_err(E::custom)
                    }
                    _ => Err(E::custom(format!("found {text:?}, expected {}", At::EXPECTED))),
                }
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for At {
    fn schema_name() -> Cow<'static, str> {
        "At".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let length = generator.subschema_for::<Quantity<Length>>();
        json_schema!({
            "description": "A point of a beam: its start, its end, or the arc length from its start.",
            "anyOf": [{ "enum": ["start", "end"] }, length],
            "examples": ["start", "end", 0.45, "45 cm"],
        })
    }
}

/// A point or vector in the plane; each component may carry a unit of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<M> {
    /// Components in SI.
    pub si: [f64; 2],
    kind: PhantomData<M>,
}

impl<M: Measure> Vector<M> {
    /// `two components [x, y] in m, such as [0.0, "1.8 m"]`.
    pub fn expected() -> String {
        let unit = if M::SI.is_empty() { String::new() } else { format!(" in {}", M::SI) };
        let example = if M::SI.is_empty() { "1.0".to_owned() } else { format!("{:?}", M::EXAMPLE) };
        format!("two components [x, y]{unit}, such as [0.0, {example}]")
    }

    /// The message about `count` components.
    pub fn wrong_count(count: usize) -> String {
        let plural = if count == 1 { "" } else { "s" };
        format!("found {count} component{plural}, expected {}", Self::expected())
    }
}

impl<'de, M: Measure> Deserialize<'de> for Vector<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<M>(PhantomData<M>);

        impl<'de, M: Measure> Visitor<'de> for Reader<M> {
            type Value = Vector<M>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&Vector::<M>::expected())
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Vector<M>, A::Error> {
                let mut si = [0.0; 2];
                let mut count = 0;
                while let Some(item) = items.next_element::<Quantity<M>>()? {
                    if let Some(place) = si.get_mut(count) {
                        *place = item.si;
                    }
                    count += 1;
                }
                if count != 2 {
                    return Err(serde::de::Error::custom(Vector::<M>::wrong_count(count)));
                }
                Ok(Vector { si, kind: PhantomData })
            }
        }

        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<M: Measure> JsonSchema for Vector<M> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("VectorOf{}", Quantity::<M>::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let component = generator.subschema_for::<Quantity<M>>();
        json_schema!({ "type": "array", "items": component, "minItems": 2, "maxItems": 2 })
    }
}

/// How many nodes, or where each one is.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeList {
    /// This many nodes.
    Count(u64),
    /// At these arc lengths \[m\].
    At(Vec<Located<Quantity<Length>>>),
}

impl NodeList {
    const EXPECTED: &'static str =
        "a number of nodes, 2 or more, or a list of arc lengths such as [0.0, \"45 cm\", 1.8]";
}

impl<'de> Deserialize<'de> for NodeList {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl<'de> Visitor<'de> for Reader {
            type Value = NodeList;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(NodeList::EXPECTED)
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<NodeList, E> {
                match u64::try_from(value) {
                    Ok(count) if count >= 2 => Ok(NodeList::Count(count)),
                    _ => Err(E::custom(format!("found {value}, expected {}", NodeList::EXPECTED))),
                }
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<NodeList, E> {
                Ok(NodeList::Count(value))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<NodeList, A::Error> {
                let mut list = Vec::new();
                while let Some(item) = items.next_element()? {
                    list.push(item);
                }
                Ok(NodeList::At(list))
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for NodeList {
    fn schema_name() -> Cow<'static, str> {
        "NodeList".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let length = generator.subschema_for::<Quantity<Length>>();
        json_schema!({
            "description": "The number of nodes, or the arc length of each, increasing from 0 to the beam's length.",
            "anyOf": [
                { "type": "integer", "minimum": 2 },
                { "type": "array", "items": length, "minItems": 2 },
            ],
            "examples": [5, [0.0, "45 cm", 1.8]],
        })
    }
}

/// The error that results may have: of the positions, or of several quantities.
#[derive(Clone, Debug)]
pub enum AccuracyValue {
    /// Of the positions, in beam lengths.
    Position(Quantity<Ratio, Positive>),
    /// Of each quantity that is named.
    Table(AccuracyTable),
}

/// The errors that results may have.
#[derive(Clone, Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AccuracyTable {
    /// Of the positions of probes and shape, in lengths of the beam; 1e-4 when left out.
    pub position: Option<Located<Quantity<Ratio, Positive>>>,
    /// Of the curvature, relative to the largest.
    pub curvature: Option<Located<Quantity<Ratio, Positive>>>,
    /// Of axial force, shear force and bending moment, relative to the largest.
    pub section_force: Option<Located<Quantity<Ratio, Positive>>>,
}

impl<'de> Deserialize<'de> for AccuracyValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        /// Reads a number or text as a quantity does.
        fn position<'de, E: serde::de::Error>(
            value: impl IntoDeserializer<'de, E>,
        ) -> Result<AccuracyValue, E> {
            Quantity::deserialize(value.into_deserializer()).map(AccuracyValue::Position)
        }

        impl<'de> Visitor<'de> for Reader {
            type Value = AccuracyValue;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an error such as 1e-4, or a table such as { position = 1e-5, curvature = 1e-3 }")
            }

            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<AccuracyValue, E> {
                position(value)
            }

            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<AccuracyValue, E> {
                position(value)
            }

            fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<AccuracyValue, E> {
                position(value)
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<AccuracyValue, E> {
                position(text)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AccuracyValue, A::Error> {
                AccuracyTable::deserialize(MapAccessDeserializer::new(map)).map(AccuracyValue::Table)
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for AccuracyValue {
    fn schema_name() -> Cow<'static, str> {
        "Accuracy".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let position = generator.subschema_for::<Quantity<Ratio, Positive>>();
        let table = generator.subschema_for::<AccuracyTable>();
        json_schema!({
            "description": "The largest error of the positions in beam lengths, or of several quantities.",
            "anyOf": [position, table],
            "examples": [1e-4, { "position": 1e-5, "curvature": 1e-3, "section_force": 1e-2 }],
        })
    }
}
