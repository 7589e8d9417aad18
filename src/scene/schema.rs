//! The JSON schema of scene files.

use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use serde_json::Value;

use super::file::SceneTable;

/// The JSON schema (draft 2020-12) of scene files, for editors and other programs. It describes
/// keys, types and units; what depends on several keys at once is checked by [`super::parse`]
/// alone.
pub fn schema() -> Value {
    let generator = SchemaSettings::draft2020_12().with_transform(without_null).into_generator();
    generator.into_root_schema_for::<SceneTable>().to_value()
}

/// TOML has no null: a key that may be absent is either there with a value, or not there.
fn without_null(schema: &mut Schema) {
    transform_subschemas(&mut without_null, schema);
    let Some(object) = schema.as_object_mut() else { return };
    if let Some(Value::Array(kinds)) = object.get_mut("type") {
        kinds.retain(|kind| kind != "null");
        if let [kind] = kinds.as_slice() {
            let kind = kind.clone();
            object.insert("type".into(), kind);
        }
    }
    if object.get("default").is_some_and(Value::is_null) {
        object.remove("default");
    }
    if let Some(Value::Array(choices)) = object.get_mut("anyOf") {
        choices.retain(|choice| choice.get("type").is_none_or(|kind| kind != "null"));
        if let [Value::Object(only)] = choices.as_slice() {
            let only = only.clone();
            object.remove("anyOf");
            for (key, value) in only {
                object.entry(key).or_insert(value);
            }
        }
    }
}

/// Most keys of a path that is looked for: laws hold laws without end.
const DEEPEST: usize = 5;
/// Stands in paths for what may have any name.
pub(super) const NAME: &str = "NAME";

/// All paths of a scene, without the numbers of lists, that end with `key`.
pub(super) fn paths_to(key: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    visit(&schema(), &mut |path, _| {
        if path.last().is_some_and(|last| last == key) && !found.iter().any(|other| other == path) {
            found.push(path.to_vec());
        }
    });
    found
}

/// The keys that the table at `path`, without the numbers of lists, must have; of several choices those of the first.
pub(super) fn required_at(path: &[String]) -> Vec<String> {
    let mut keys = Vec::new();
    visit(&schema(), &mut |at, schema| {
        if keys.is_empty()
            && is_like(at, path)
            && let Some(Value::Array(required)) = schema.get("required")
        {
            keys.extend(required.iter().filter_map(|key| key.as_str().map(str::to_owned)));
        }
    });
    keys
}

/// Whether `path` is one of those that `pattern` stands for.
pub(super) fn is_like(pattern: &[String], path: &[String]) -> bool {
    pattern.len() == path.len()
        && pattern.iter().zip(path).all(|(pattern, key)| pattern == NAME || pattern == key)
}

/// Calls `see` with every path of the scene, and what the schema says of it.
fn visit(root: &Value, see: &mut dyn FnMut(&[String], &Value)) {
    below(root, root, &mut Vec::new(), see);
}

fn below(root: &Value, schema: &Value, path: &mut Vec<String>, see: &mut dyn FnMut(&[String], &Value)) {
    see(path, schema);
    if let Some(reference) = schema.get("$ref").and_then(Value::as_str)
        && let Some(there) = root.pointer(reference.trim_start_matches('#'))
    {
        below(root, there, path, see);
    }
    for word in ["anyOf", "oneOf", "allOf"] {
        schema
            .get(word)
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .for_each(|schema| below(root, schema, path, see));
    }
    if let Some(items) = schema.get("items") {
        below(root, items, path, see);
    }
    if path.len() == DEEPEST {
        return;
    }
    let named = schema.get("properties").and_then(Value::as_object).into_iter().flatten();
    let any = schema.get("additionalProperties").filter(|schema| schema.is_object());
    let named = named.map(|(key, schema)| (key.as_str(), schema));
    for (key, schema) in named.chain(any.map(|schema| (NAME, schema))) {
        path.push(key.to_owned());
        below(root, schema, path, see);
        path.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(paths: &[Vec<String>]) -> Vec<String> {
        paths.iter().map(|path| path.join(".")).collect()
    }

    #[test]
    fn keys_are_found_wherever_they_are() {
        assert_eq!(joined(&paths_to("elements")), ["beam.NAME.basis.ancf.elements"]);
        assert_eq!(joined(&paths_to("contact")), ["effect.contact"]);
        assert!(joined(&paths_to("step")).contains(&"analysis.dynamic.radau.step".to_owned()));
        assert!(paths_to("sailplane").is_empty());
        let path = |text: &str| text.split('.').map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(required_at(&path("effect.gravity")), ["acceleration"]);
        assert_eq!(required_at(&path("effect.contact.friction")), ["coefficient"]);
        assert_eq!(required_at(&path("beam.arm")), ["start", "end"]);
        assert!(is_like(&path("beam.NAME.start"), &path("beam.arm.start")));
        assert!(!is_like(&path("beam.NAME.start"), &path("beam.arm.end")));
    }
}
