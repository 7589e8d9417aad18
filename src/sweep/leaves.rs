//! Flattens a summary, whatever its fields are, into values with names, in the order in which they
//! were written.

use std::fmt;

use serde_json::Value;

use crate::output::exact;

/// Calls `see` with the path of every value in `value` that is neither null nor made of others, and
/// with that value. A path begins with `path`, its keys are joined by dots, and entries of lists are
/// counted from 1.
pub(super) fn visit(value: &Value, path: &str, see: &mut dyn FnMut(&str, &Value)) {
    let below = |key: &dyn fmt::Display| {
        if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
    };
    match value {
        Value::Null => {}
        Value::Bool(_) | Value::Number(_) | Value::String(_) => see(path, value),
        Value::Array(items) => {
            items.iter().zip(1..).for_each(|(item, number)| visit(item, &below(&number), see));
        }
        Value::Object(entries) => entries.iter().for_each(|(key, entry)| visit(entry, &below(key), see)),
    }
}

/// The text of such a value in a table. Numbers that are not whole have 17 significant digits.
pub(super) fn text(value: &Value) -> String {
    match value {
        Value::Number(number) => match number.as_f64().filter(|_| number.is_f64()) {
            Some(value) => exact(value),
            None => number.to_string(),
        },
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_bits_survive() {
        let text = r#"{"z":{"y":0.1,"x":-0.0},"list":[3,-4,null,true],"a":"b","tiny":5e-324}"#;
        let value: Value = serde_json::from_str(text).unwrap();
        assert_eq!(serde_json::to_string(&value).unwrap(), text);
        let mut cells = Vec::new();
        visit(&value, "", &mut |path, value| cells.push(format!("{path}={}", super::text(value))));
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
