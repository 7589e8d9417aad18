//! No key and no column without a value test: the schema and the headers as written against the
//! lists `keys.toml` and `columns.toml`.

use super::Written;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// For each table the tests by the names that they look at.
type List = BTreeMap<String, BTreeMap<String, String>>;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn list(name: &str) -> List {
    let path = root().join("tests/values").join(name);
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    toml::from_str(&text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Whether a word stands in a text by itself.
fn has_word(text: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word)
        .any(|(at, _)| !text[..at].ends_with(part) && !text[at + word.len()..].starts_with(part))
}

/// What is wrong with a test that a list names: `room::file::function` of `tests`,
/// `live::file::function`, or `case NAME`; it must be there, and speak of the word.
fn problem(test: &str, word: &str) -> Option<String> {
    if let Some(name) = test.strip_prefix("case ") {
        let folder = root().join("verification/cases").join(name);
        let Ok(entries) = fs::read_dir(&folder) else { return Some(format!("there is no case `{name}`")) };
        let texts = entries.filter_map(|entry| fs::read_to_string(entry.ok()?.path()).ok());
        return (!texts.into_iter().any(|text| has_word(&text, word)))
            .then(|| format!("the case `{name}` does not name `{word}`"));
    }
    let parts: Vec<&str> = test.split("::").collect();
    let [room, file, function] = parts[..] else {
        return Some(format!("`{test}` is no room::file::function"));
    };
    let folder: PathBuf =
        if room == "live" { "verification/tests/live".into() } else { ["tests", room].iter().collect() };
    let path = root().join(folder).join(format!("{file}.rs"));
    let Ok(text) = fs::read_to_string(&path) else { return Some(format!("there is no {}", path.display())) };
    let Some(at) = text.find(&format!("fn {function}()")) else {
        return Some(format!("there is no `{function}` in {}", path.display()));
    };
    if !text[..at].trim_end().lines().rev().take(3).any(|line| line.trim() == "#[test]") {
        return Some(format!("`{test}` is no test"));
    }
    (!has_word(&text, word)).then(|| format!("{} does not name `{word}`", path.display()))
}

fn problems(list: &List) -> Vec<String> {
    let entries =
        list.iter().flat_map(|(table, names)| names.iter().map(move |(name, test)| (table, name, test)));
    entries
        .filter_map(|(table, name, test)| {
            // Of what has a place in a list or below a name the last word is written.
            let word = if table == "vtu" { name } else { name.rsplit('.').next().unwrap_or(name) };
            Some(format!("{table}.{name}: {}", problem(test, word)?))
        })
        .collect()
}

/// Every key, and every word that a key can be, of the schema.
fn schema() -> BTreeSet<String> {
    let schema = ancf::scene::schema();
    let mut keys = BTreeSet::new();
    let empty = serde_json::Map::new();
    let tables = schema["$defs"].as_object().unwrap_or(&empty).iter();
    for (name, table) in tables.map(|(name, table)| (name.as_str(), table)).chain([("SceneTable", &schema)]) {
        let properties = table["properties"].as_object().unwrap_or(&empty).keys();
        let words = table["oneOf"].as_array().into_iter().flatten().filter_map(|word| word["const"].as_str());
        keys.extend(properties.map(String::as_str).chain(words).map(|key| format!("{name}.{key}")));
    }
    keys
}

/// Would catch a key that is added to the schema, or taken from it, without a test of its value.
#[test]
fn every_key_of_the_schema_has_a_value_test() {
    let list = list("keys.toml");
    let listed: BTreeSet<String> =
        list.iter().flat_map(|(table, keys)| keys.keys().map(move |key| format!("{table}.{key}"))).collect();
    let keys = schema();
    assert!(keys.len() > 200, "{}", keys.len());
    let missing: Vec<_> = keys.difference(&listed).collect();
    let gone: Vec<_> = listed.difference(&keys).collect();
    assert!(
        missing.is_empty() && gone.is_empty(),
        "without a value test: {missing:?}; not in the schema: {gone:?}"
    );
    let problems = problems(&list);
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// The names that `columns.toml` has of a file.
pub(super) fn listed(file: &str) -> BTreeSet<String> {
    list("columns.toml").remove(file).unwrap_or_default().into_keys().collect()
}

/// Holds the names of a file against `columns.toml`, both ways.
pub(super) fn is_listed(file: &str, names: impl Iterator<Item = String>) {
    let listed = listed(file);
    let names: BTreeSet<String> = names.collect();
    let missing: Vec<_> = names.difference(&listed).collect();
    assert!(missing.is_empty(), "{file}: without a value test: {missing:?}");
    let gone: Vec<_> = listed.difference(&names).collect();
    assert!(gone.is_empty(), "{file}: not written any more: {gone:?}");
}

/// Paths of all values below `value`.
fn paths(value: &serde_json::Value, path: &str, into: &mut BTreeSet<String>) {
    match value {
        serde_json::Value::Object(entries) => entries.iter().for_each(|(key, value)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            paths(value, &path, into);
        }),
        serde_json::Value::Array(entries) if entries.iter().any(serde_json::Value::is_object) => {
            entries.iter().for_each(|value| paths(value, path, into));
        }
        // What a kind of analysis has none of.
        serde_json::Value::Null => {}
        _ => {
            into.insert(path.replace("probes.end.", "probes.").replace("reactions.support1.", "reactions."));
        }
    }
}

/// Would catch a column, a number of the summary, or a field for ParaView that is new and has no
/// test of its value.
#[test]
fn every_column_of_every_file_has_a_value_test() {
    let beam = "beam.arm = { start = [0, 0.2], end = [1, 0.2], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [-1e-3, 0] }]
        probe = [{ name = 'end', beam = 'arm', at = 'end' }]
        output = { states = true, vtu = true, reactions = true, effects = true, section_forces = true }\n";
    let moving = "effect.gravity.acceleration = [0, -9.81]
        effect.contact = [{ beam = 'arm', half_plane = { point = [0, 0], normal = [0, 1] }, stiffness = 1e4 }]
        effect.damping = [{ beam = 'arm', mass_proportional = 0.2 }]
        effect.spring = [{ beam = 'arm', at = 0.5, stiffness = 1 }]
        analysis.dynamic = { duration = 0.6, output_every = 0.2, event = [{ probe = 'end', y = 0.1 }] }\n";
    let held = beam.replace("fix = ['x', 'y'] }", "fix = ['x', 'y', 'angle'] }");
    let bent = held.replace("value = [-1e-3, 0]", "value = [-1e-3, 1]");
    let [open, loose] = [&bent[..], beam].map(|text| text.replace(", basis.ancf.elements = 4", ""));
    let bouncing = moving
        .replace("output_every = 0.2", "output_every = 0.2, accuracy = 1e-2")
        .replace(" y = 0.1", " minimum = 'y'");
    // It loses its stability on the way.
    let pressed = held.replace(", basis.ancf.elements = 4", "").replace("-1e-3", "-4");
    let short = bent.replace("axial_stiffness = 1e3", "axial_stiffness = 1e2");
    let written = [
        Written::of(&format!("{beam}{moving}")),
        Written::of(&format!("{loose}{bouncing}")),
        Written::of(&format!("{held}analysis.static = {{}}\n")),
        Written::of(&format!("{held}analysis.modal.count = 2\n")),
        Written::of(&format!("{held}analysis.buckling.count = 2\n")),
        Written::of(&format!(
            "{open}analysis.static.accuracy = {{ position = 1e-3, curvature = 1e-1, section_force = 1e-1 }}\n"
        )),
        Written::of(&format!("{open}analysis.dynamic = {{ duration = 0.1, accuracy = 1e-2 }}\n")),
        Written::of(&format!("{open}analysis.modal.count = 2\n")),
        Written::of(&format!("{open}analysis.buckling.count = 2\n")),
        Written::of(
            &held
                .replace(
                    "axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1",
                    "section.layers = [{ youngs_modulus = 1e6, density = 1, width = 0.1, height = 0.01 }, \
             { youngs_modulus = 2e6, density = 1, width = 0.1, height = 0.01 }]",
                )
                .replace("output =", "analysis.static = {}\n        output ="),
        ),
        Written::of(&format!(
            "{held}effect.tendon = [{{ beam = 'arm', offset = 0.01, shortening = 1e-3 }}]\nanalysis.static = {{}}\n"
        )),
        Written::of(&format!("{pressed}analysis.static.accuracy = 1e-3\n")),
        // Missed, and short.
        Written::of(&format!("{short}analysis.static = {{ steps = 2, accuracy = 1e-12 }}\n")),
    ];
    let mut names: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for files in &written {
        for file in [
            "probes.csv",
            "energy.csv",
            "reactions.csv",
            "effects.csv",
            "shape.csv",
            "layers.csv",
            "states.csv",
            "modes.csv",
            "frequencies.csv",
            "load_factors.csv",
        ] {
            if files.path(file).is_file() && files.text(file).lines().count() > 1 {
                // A name before the point is that of a probe, a support or an effect.
                let own = files
                    .header(file)
                    .into_iter()
                    .map(|name| name.rsplit('.').next().unwrap_or_default().to_owned());
                names.entry(file).or_default().extend(own);
            }
        }
        paths(&files.summary(), "", names.entry("summary.json").or_default());
        for file in ["vtu/last.vtu", "vtu/state_00000.vtu", "vtu/mode_00001.vtu"] {
            if files.path(file).is_file() {
                let text = files.text(file);
                let own = text
                    .split("Name=\"")
                    .skip(1)
                    .filter_map(|rest| rest.split('"').next().map(str::to_owned));
                names.entry("vtu").or_default().extend(own);
            }
        }
    }
    assert_eq!(names.len(), 12, "{:?}", names.keys());
    for (file, names) in names {
        is_listed(file, names.into_iter());
    }
    let list = list("columns.toml");
    let problems = problems(&list);
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
