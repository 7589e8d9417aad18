//! Values by name, in the order in which they were written: a summary becomes columns whatever its
//! fields are.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Serialize, Serializer};

use crate::output::exact;

/// A JSON value whose keys keep their order.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tree {
    Nothing,
    Truth(bool),
    Count(u64),
    Whole(i64),
    Number(f64),
    Text(String),
    List(Vec<Tree>),
    Table(Vec<(String, Tree)>),
}

impl Tree {
    /// What `value` looks like in JSON. Numbers that are not finite become nothing.
    pub fn of(value: &impl Serialize) -> Result<Self, serde_json::Error> {
        serde_json::from_str(&serde_json::to_string(value)?)
    }

    /// Calls `see` with the path of every value that is neither nothing nor made of others, keys
    /// joined by dots, entries of lists counted from 1, and its text, numbers with 17 significant
    /// digits.
    pub fn visit(&self, path: &str, see: &mut dyn FnMut(&str, String)) {
        let below = |key: &dyn fmt::Display| {
            if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
        };
        match self {
            Self::Nothing => {}
            Self::Truth(value) => see(path, value.to_string()),
            Self::Count(value) => see(path, value.to_string()),
            Self::Whole(value) => see(path, value.to_string()),
            Self::Number(value) => see(path, exact(*value)),
            Self::Text(value) => see(path, value.clone()),
            Self::List(items) => {
                items.iter().zip(1..).for_each(|(item, number)| item.visit(&below(&number), see));
            }
            Self::Table(entries) => entries.iter().for_each(|(key, entry)| entry.visit(&below(key), see)),
        }
    }
}

impl Serialize for Tree {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Nothing => serializer.serialize_unit(),
            Self::Truth(value) => serializer.serialize_bool(*value),
            Self::Count(value) => serializer.serialize_u64(*value),
            Self::Whole(value) => serializer.serialize_i64(*value),
            Self::Number(value) => serializer.serialize_f64(*value),
            Self::Text(value) => serializer.serialize_str(value),
            Self::List(items) => serializer.collect_seq(items),
            Self::Table(entries) => serializer.collect_map(entries.iter().map(|(key, entry)| (key, entry))),
        }
    }
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Tree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree::Nothing)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Tree, E> {
        Ok(Tree::Truth(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Tree, E> {
        Ok(Tree::Count(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Tree, E> {
        Ok(Tree::Whole(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Tree, E> {
        Ok(Tree::Number(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Tree, E> {
        Ok(Tree::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Tree, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            list.push(item);
        }
        Ok(Tree::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Tree, A::Error> {
        let mut table = Vec::new();
        while let Some(entry) = entries.next_entry()? {
            table.push(entry);
        }
        Ok(Tree::Table(table))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_bits_survive() {
        let text = r#"{"z":{"y":0.1,"x":-0.0},"list":[3,-4,null,true],"a":"b","tiny":5e-324}"#;
        let tree: Tree = serde_json::from_str(text).unwrap();
        assert_eq!(serde_json::to_string(&tree).unwrap(), text);
        let mut cells = Vec::new();
        tree.visit("", &mut |path, text| cells.push(format!("{path}={text}")));
        assert_eq!(
            cells,
            [
                "z.y=1.0000000000000001e-1",
                "z.x=-0.0000000000000000e0",
                "list.1=3",
                "list.2=-4",
                "list.4=true",
                "a=b",
                "tiny=4.9406564584124654e-324",
            ]
        );
    }
}
