//! The keys of the schema, and which of them a scene uses.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value as Json;
use toml::{Table, Value};

/// All keys of the schema, as paths without list indices, with `*` for the names of beams. A law of
/// time counts as the same keys wherever it is.
pub fn keys() -> BTreeSet<String> {
    let schema = ancf::scene::schema();
    let mut keys = BTreeSet::new();
    visit(&schema, &schema, "", &mut keys);
    keys
}

fn visit(root: &Json, schema: &Json, path: &str, keys: &mut BTreeSet<String>) {
    if let Some(name) = schema.get("$ref").and_then(Json::as_str) {
        let definition = root.pointer(name.trim_start_matches('#'));
        // A law is described where the first load has one.
        let path = match name.rsplit('/').next() {
            Some("LawTable") => "law",
            // An analysis is the same in a stage.
            Some("AnalysisTable") => "analysis",
            _ => path,
        };
        // Sums and products of laws consist of laws.
        let known = path == "law" && keys.contains("law.ramp");
        if let Some(definition) = definition.filter(|_| !known) {
            visit(root, definition, path, keys);
        }
    }
    for (key, below) in schema.get("properties").and_then(Json::as_object).into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        keys.insert(path.clone());
        visit(root, below, &path, keys);
    }
    if let Some(below) = schema.get("additionalProperties").filter(|below| below.is_object()) {
        visit(root, below, &format!("{path}.*"), keys);
    }
    if let Some(items) = schema.get("items") {
        visit(root, items, path, keys);
    }
    for several in ["anyOf", "oneOf", "allOf"] {
        for one in schema.get(several).and_then(Json::as_array).into_iter().flatten() {
            visit(root, one, path, keys);
        }
    }
}

/// The keys that a scene uses.
pub fn used(scene: &Table) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    table("", scene, &mut used);
    used
}

/// Counts the keys of a scene, each once.
pub fn count(scene: &Table, counts: &mut BTreeMap<String, usize>) {
    for key in used(scene) {
        *counts.entry(key).or_default() += 1;
    }
}

fn table(path: &str, scene: &Table, used: &mut BTreeSet<String>) {
    for (key, below) in scene {
        let here = match path {
            "" => key.clone(),
            "beam" => "beam.*".to_owned(),
            _ => format!("{path}.{key}"),
        };
        if path != "beam" {
            used.insert(here.clone());
        }
        let here = match &here[..] {
            _ if key == "in_time" => "law",
            "stage.analysis" => "analysis",
            here => here,
        };
        value(here, below, used);
    }
}

fn value(path: &str, scene: &Value, used: &mut BTreeSet<String>) {
    match scene {
        Value::Table(below) => table(path, below, used),
        Value::Array(list) => list.iter().for_each(|item| value(path, item, used)),
        _ => {}
    }
}
