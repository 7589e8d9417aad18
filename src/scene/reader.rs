//! Serde's view of a parsed TOML document, in which every value knows where it stands.
//!
//! The `toml` crate has such a view too. Its own is generic over several kinds of maps, for each of
//! which the compiler writes out the reader of every table of `file`: a quarter of this crate's
//! machine code. Here a table is read from one kind of map only, and what expects a table, a list, a
//! word or a number is not compiled for the others.

use std::fmt;
use std::ops::Range;

use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, Error as _, Expected, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, Visitor,
};
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// Reads the tables of a scene from the parsed text.
///
/// # Errors
/// What serde expected in place of what, at the innermost value that it is about.
pub(super) fn read<'a, T: Deserialize<'a>>(document: &'a Spanned<DeTable<'a>>) -> Result<T, Error> {
    let span = document.span();
    T::deserialize(Node { input: Input::Table(document.get_ref()), span })
}

/// The name by which a type asks for the place of its value too: as a tuple struct of this name, whose
/// items are the first byte, the end, and the value.
pub(super) const PLACE: &str = "$ancf::scene::Place";

/// Why a document is not a scene.
#[derive(Debug)]
pub(super) struct Error {
    pub(super) message: String,
    /// The bytes of the text that the message is about.
    pub(super) span: Option<Range<usize>>,
}

impl Error {
    /// The error at `span`, unless it is already about something within.
    fn within(mut self, span: &Range<usize>) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

impl serde::de::Error for Error {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), span: None }
    }
}

/// A key or a value of the document.
struct Node<'a> {
    input: Input<'a>,
    span: Range<usize>,
}

#[derive(Clone, Copy)]
enum Input<'a> {
    Key(&'a str),
    Table(&'a DeTable<'a>),
    Value(&'a DeValue<'a>),
    /// A byte of the text; see [`Place`].
    Byte(usize),
}

impl<'a> Node<'a> {
    fn key(key: &'a Spanned<DeString<'a>>) -> Self {
        Self { input: Input::Key(key.get_ref()), span: key.span() }
    }

    fn value(value: &'a Spanned<DeValue<'a>>) -> Self {
        Self { input: Input::Value(value.get_ref()), span: value.span() }
    }

    /// The error that something else was expected.
    fn unlike(&self, expected: &dyn Expected) -> Error {
        let found = match self.input {
            Input::Key(text) => Unexpected::Str(text),
            Input::Byte(number) => Unexpected::Unsigned(number as u64),
            Input::Table(_) => Unexpected::Map,
            Input::Value(value) => unexpected(value),
        };
        Error::invalid_type(found, expected).within(&self.span)
    }

    fn text(&self) -> Option<&'a str> {
        match &self.input {
            Input::Key(text) => Some(text),
            Input::Value(DeValue::String(text)) => Some(text),
            _ => None,
        }
    }
}

/// A number of the document.
enum Number {
    Signed(i64),
    Unsigned(u64),
    Float(f64),
}

impl Number {
    fn read(value: &DeValue<'_>, expected: &dyn Expected) -> Result<Self, Error> {
        match value {
            DeValue::Integer(integer) => {
                let (digits, radix) = (integer.as_str(), integer.radix());
                if let Ok(number) = i64::from_str_radix(digits, radix) {
                    return Ok(Self::Signed(number));
                }
                match u64::from_str_radix(digits, radix) {
                    Ok(number) => Ok(Self::Unsigned(number)),
                    Err(_) => Err(Error::custom("the whole number has too many digits")),
                }
            }
            DeValue::Float(float) => match float.as_str().parse::<f64>() {
                Ok(number)
                    if number.is_finite() || !float.as_str().contains(|c: char| c.is_ascii_digit()) =>
                {
                    Ok(Self::Float(number))
                }
                _ => Err(Error::custom("the number is beyond the largest one, 1.8e308")),
            },
            _ => Err(Error::invalid_type(unexpected(value), expected)),
        }
    }

    fn visit<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Self::Signed(number) => visitor.visit_i64(number),
            Self::Unsigned(number) => visitor.visit_u64(number),
            Self::Float(number) => visitor.visit_f64(number),
        }
    }
}

/// What a value is, in the words of serde's messages.
fn unexpected<'a>(value: &'a DeValue<'_>) -> Unexpected<'a> {
    let number = |value| match Number::read(value, &"a number") {
        Ok(Number::Signed(number)) => Unexpected::Signed(number),
        Ok(Number::Unsigned(number)) => Unexpected::Unsigned(number),
        Ok(Number::Float(number)) => Unexpected::Float(number),
        Err(_) => Unexpected::Other("a number that is too large"),
    };
    match value {
        DeValue::Table(_) => Unexpected::Map,
        DeValue::Array(_) => Unexpected::Seq,
        DeValue::String(text) => Unexpected::Str(text),
        DeValue::Boolean(value) => Unexpected::Bool(*value),
        DeValue::Integer(_) | DeValue::Float(_) => number(value),
        DeValue::Datetime(_) => Unexpected::Other("a date"),
    }
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let read = match self.input {
            Input::Key(text) => visitor.visit_borrowed_str(text),
            Input::Byte(number) => visitor.visit_u64(number as u64),
            Input::Table(table) | Input::Value(DeValue::Table(table)) => {
                visitor.visit_map(Entries { rest: table.iter(), value: None })
            }
            Input::Value(DeValue::Array(items)) => visitor.visit_seq(Items(items.iter())),
            Input::Value(DeValue::String(text)) => visitor.visit_borrowed_str(text),
            Input::Value(DeValue::Boolean(value)) => visitor.visit_bool(*value),
            Input::Value(value) => Number::read(value, &visitor).and_then(|number| number.visit(visitor)),
        };
        read.map_err(|error| error.within(&self.span))
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.input {
            Input::Value(DeValue::Boolean(value)) => {
                visitor.visit_bool(*value).map_err(|error: Error| error.within(&self.span))
            }
            _ => Err(self.unlike(&visitor)),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let read = match self.input {
            Input::Value(value @ (DeValue::Integer(_) | DeValue::Float(_))) => {
                Number::read(value, &visitor).and_then(|number| number.visit(visitor))
            }
            _ => return Err(self.unlike(&visitor)),
        };
        read.map_err(|error| error.within(&self.span))
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.input {
            Input::Byte(number) => visitor.visit_u64(number as u64),
            _ => self.deserialize_f64(visitor),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.text() {
            Some(text) => visitor.visit_borrowed_str(text).map_err(|error: Error| error.within(&self.span)),
            None => Err(self.unlike(&visitor)),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.input {
            Input::Value(DeValue::Array(items)) => {
                visitor.visit_seq(Items(items.iter())).map_err(|error| error.within(&self.span))
            }
            _ => Err(self.unlike(&visitor)),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.input {
            Input::Table(table) | Input::Value(DeValue::Table(table)) => visitor
                .visit_map(Entries { rest: table.iter(), value: None })
                .map_err(|error| error.within(&self.span)),
            _ => Err(self.unlike(&visitor)),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_map(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    /// A value with its place: the only tuple structs of a scene.
    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        debug_assert_eq!(name, PLACE);
        visitor.visit_seq(Place { node: self, given: 0 })
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let read = match self.text() {
            Some(text) => {
                let word: StrDeserializer<'_, Error> = text.into_deserializer();
                visitor.visit_enum(word)
            }
            None => Err(Error::custom("expected a word in quotation marks")),
        };
        read.map_err(|error| error.within(&self.span))
    }

    serde::forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u32 u128 f32 char bytes byte_buf unit unit_struct ignored_any
    }
}

/// The entries of a table.
struct Entries<'a> {
    rest: toml::map::Iter<'a, Spanned<DeString<'a>>, Spanned<DeValue<'a>>>,
    value: Option<&'a Spanned<DeValue<'a>>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((key, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        seed.deserialize(Node::key(key)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        match self.value.take() {
            Some(value) => seed.deserialize(Node::value(value)),
            None => Err(Error::custom("a value without a key")),
        }
    }
}

/// The items of a list.
struct Items<'a>(std::slice::Iter<'a, Spanned<DeValue<'a>>>);

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        self.0.next().map(|item| seed.deserialize(Node::value(item))).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// Where a value stands, and the value.
struct Place<'a> {
    node: Node<'a>,
    given: u8,
}

impl<'de> SeqAccess<'de> for Place<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let span = self.node.span.clone();
        let input = match self.given {
            0 => Input::Byte(span.start),
            1 => Input::Byte(span.end),
            2 => self.node.input,
            _ => return Ok(None),
        };
        self.given += 1;
        seed.deserialize(Node { input, span }).map(Some)
    }
}
