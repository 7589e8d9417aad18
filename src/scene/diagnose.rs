//! Turns the messages of the TOML reader and of serde into faults that say what is legal.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::error::Fault;
use super::reader;
use super::schema::{NAME, is_like, paths_to, required_at};

/// Symbols and names of others for keys.
const OTHER_NAMES: [(&str, &str); 10] = [
    ("E", "youngs_modulus"),
    ("EA", "axial_stiffness"),
    ("EI", "bending_stiffness"),
    ("A", "area"),
    ("I", "second_moment"),
    ("rho", "density"),
    ("end_time", "duration"),
    ("t_end", "duration"),
    ("sine", "harmonic"),
    ("cosine", "harmonic"),
];
/// Most places of a key that are told.
const PLACES: usize = 4;

/// The fault behind an error of the TOML syntax.
pub(super) fn syntax(error: &toml::de::Error, text: &str) -> Fault {
    let span = error.span().unwrap_or(text.len()..text.len());
    let message = error.message().lines().collect::<Vec<_>>().join("; ");
    let help = if message.contains("duplicate key") {
        "a key may be given once in its table"
    } else {
        "the file is TOML: `key = value` lines under [table] headings, text in \"quotation marks\""
    };
    Fault::new(span, format!("TOML syntax: {message}")).help(help)
}

/// The fault behind an error that serde found in the tables of `document`.
pub(super) fn data(error: &reader::Error, document: &DeTable<'_>) -> Fault {
    let span = error.span.clone().unwrap_or(0..0);
    // An empty span is that of the scene as a whole.
    let mut path = if span.is_empty() { Vec::new() } else { path_at(document, &span) };
    // A list written as a single `[[table]]` stands where its only entry does.
    if error.message.starts_with("invalid type: sequence") && !is_list(document, &path) {
        path.pop();
    }
    let path = path.join(".");
    let (first, rest) = error.message.split_once('\n').unwrap_or((&error.message, ""));
    let place = if path.is_empty() { "at the top of the scene".to_owned() } else { format!("in `{path}`") };

    if let Some(rest) = first.strip_prefix("unknown field ") {
        let (found, legal) = quoted(rest);
        // The span is that of the key itself, so the last part of the path is the unknown key.
        let table = path.rsplit_once('.').map(|(table, _)| table);
        let place = table.map_or("at the top of the scene".to_owned(), |table| format!("in `{table}`"));
        let fault = Fault::new(span, format!("unknown key `{found}` {place}"));
        let other =
            OTHER_NAMES.into_iter().find(|(other, _)| *other == found).map_or(found.as_str(), |(_, key)| key);
        return match elsewhere(&found, &keys_of(table.unwrap_or_default())) {
            Some(there) => fault.help(format!("{there} legal keys: {}", legal.join(", "))),
            None if legal.is_empty() => fault,
            None => fault.help(choices("legal keys", other, &legal)),
        };
    }
    if let Some(rest) = first.strip_prefix("unknown variant ") {
        let (found, legal) = quoted(rest);
        return Fault::new(
            span,
            format!("`{path}`: found \"{found}\", expected one of {}", list(&legal, '"')),
        )
        .help(choices("legal values", &found, &legal));
    }
    if let Some(rest) = first.strip_prefix("missing field ") {
        let (missing, _) = quoted(rest);
        return Fault::new(span, format!("missing key `{missing}` {place}"))
            .help(match missing.as_str() {
                "analysis" => "add one of `[analysis.static]`, `[analysis.dynamic]`, `[analysis.buckling]`, `[analysis.modal]`".into(),
                _ => format!("add `{missing} = …` there; `ancf schema` describes every key"),
            });
    }
    let message = if let Some(rest) =
        first.strip_prefix("invalid type: ").or_else(|| first.strip_prefix("invalid value: "))
    {
        format!("found {rest}")
    } else {
        first.to_owned()
    };
    // Names of this crate's types mean nothing to whoever wrote the scene, and a map is a table there.
    let message =
        match message.split_once("expected struct ").or_else(|| message.split_once("expected a map")) {
            Some((before, _)) => format!("{before}expected a table"),
            None => message,
        };
    let place = if path.is_empty() { String::new() } else { format!("`{path}`: ") };
    let help = nameless_beam(&path, &message)
        .or_else(|| list_form(&path, &message))
        .or_else(|| table_form(&path, &message, document))
        .or((!rest.is_empty()).then(|| rest.to_owned()));
    let fault = Fault::new(span, format!("{place}{message}"));
    match help {
        Some(help) => fault.help(help),
        None => fault,
    }
}

/// A path without the numbers of lists.
fn keys_of(path: &str) -> Vec<String> {
    path.split('.')
        .filter(|key| !key.is_empty() && key.parse::<usize>().is_err())
        .map(str::to_owned)
        .collect()
}

/// The paths at which the key that was `found` in a `table` that does not know it is legal: within this table, or elsewhere, if these are few.
fn elsewhere(found: &str, table: &[String]) -> Option<String> {
    let all = paths_to(found);
    let within = |path: &&Vec<String>| path.len() > table.len() && is_like(&path[..table.len()], table);
    let here: Vec<String> = all.iter().filter(within).map(|path| path[table.len()..].join(".")).collect();
    let places = if here.is_empty() { all.iter().map(|path| path.join(".")).collect() } else { here };
    let few = (1..=PLACES).contains(&places.len());
    few.then(|| format!("did you mean {}?", list(&places, '`')))
}

/// How to write a beam, where keys of one stand in place of its name.
fn nameless_beam(path: &str, message: &str) -> Option<String> {
    let key = path.strip_prefix("beam.").filter(|_| message.ends_with("expected a table"))?;
    let of_beams = paths_to(key).into_iter().any(|path| path == ["beam", NAME, key]);
    of_beams.then(|| format!("every beam has a name: write `[beam.NAME]`, and `{key}` below it"))
}

/// How to write a list, where one is expected and something else was found: an array of tables
/// takes two brackets, even for a single table.
fn list_form(path: &str, message: &str) -> Option<String> {
    let found = message.strip_prefix("found ")?.strip_suffix(", expected a sequence")?;
    let key = path.rsplit('.').next().unwrap_or(path);
    if found == "map" {
        let form = format!("write `[[{path}]]`, with two brackets, as often as there is one");
        return Some(format!("{form}; within a line `{key} = [{{ … }}]`"));
    }
    let value = match found.strip_prefix("string ") {
        Some(text) => text.to_owned(),
        None => found.split('`').nth(1).unwrap_or("…").to_owned(),
    };
    if key == "fix" {
        return Some(
            "write a list of what is fixed: `fix = [\"x\", \"y\", \"angle\"]` for a clamp".to_owned(),
        );
    }
    Some(format!("write a list, also of one: `{key} = [{value}]`"))
}

/// How to write a table, where one is expected and something else was found.
fn table_form(path: &str, message: &str, document: &DeTable<'_>) -> Option<String> {
    message.strip_suffix("expected a table")?;
    let keys: Vec<String> = path.split('.').map(str::to_owned).collect();
    let key = keys.last().filter(|key| key.parse::<usize>().is_err());
    if let Some(key) = key.filter(|_| path != "beam" && !holds_tables(document, &keys)) {
        let required = required_at(&keys_of(path));
        let entries: Vec<String> = required.iter().map(|key| format!("{key} = …")).collect();
        let entries = if entries.is_empty() { "key = value, …".to_owned() } else { entries.join(", ") };
        return Some(format!("write a table: `{key} = {{ {entries} }}`"));
    }
    let within_list = path.split('.').any(|part| part.parse::<usize>().is_ok());
    Some(match path {
        "beam" => "write `[beam.NAME]`, one table with a name of its own for each beam".to_owned(),
        _ if within_list => "write a table, `{ key = value, … }`".to_owned(),
        _ => format!("write `[{path}]`, with single brackets: there is one"),
    })
}

/// The first word in backticks, and all that follow it.
fn quoted(text: &str) -> (String, Vec<String>) {
    let mut words = text.split('`').skip(1).step_by(2).map(str::to_owned);
    (words.next().unwrap_or_default(), words.collect())
}

/// `a, b or c`, each within `mark`.
pub(super) fn list(words: &[String], mark: char) -> String {
    let words: Vec<_> = words.iter().map(|word| format!("{mark}{word}{mark}")).collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => "nothing".into(),
    }
}

/// `did you mean …?` with the legal words.
pub(super) fn choices(what: &str, found: &str, legal: &[String]) -> String {
    let near = legal
        .iter()
        .map(|word| (strsim::jaro_winkler(&found.to_lowercase(), word), word))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let guess = near.map_or(String::new(), |(_, word)| format!("did you mean `{word}`? "));
    format!("{guess}{what}: {}", legal.join(", "))
}

/// The path of the innermost key or value whose text covers `span`; list entries go by number.
pub(super) fn path_at(document: &DeTable<'_>, span: &Range<usize>) -> Vec<String> {
    let mut best = (usize::MAX, Vec::new());
    visit_table(document, &mut Vec::new(), &mut |path, of| {
        if of.start <= span.start && span.end <= of.end && of.len() <= best.0 {
            best = (of.len(), path.to_vec());
        }
    });
    best.1
}

/// Whether the value at `path` is a list.
fn is_list(document: &DeTable<'_>, path: &[String]) -> bool {
    matches!(value_at(document, path), Some(DeValue::Array(_)))
}

/// Whether the value at `path` is a list of tables.
fn holds_tables(document: &DeTable<'_>, path: &[String]) -> bool {
    let Some(DeValue::Array(items)) = value_at(document, path) else { return false };
    items.iter().any(|item| matches!(item.get_ref(), DeValue::Table(_)))
}

fn value_at<'a>(document: &'a DeTable<'_>, path: &[String]) -> Option<&'a DeValue<'a>> {
    let (first, rest) = path.split_first()?;
    let value = rest.iter().try_fold(document.get(first.as_str())?, |value, part| match value.get_ref() {
        DeValue::Table(table) => table.get(part.as_str()),
        DeValue::Array(items) => items.get(part.parse::<usize>().ok()?),
        _ => None,
    });
    Some(value?.get_ref())
}

type See<'a> = &'a mut dyn FnMut(&[String], Range<usize>);

fn visit_table(table: &DeTable<'_>, path: &mut Vec<String>, see: See<'_>) {
    for (key, value) in table {
        path.push(key.get_ref().to_string());
        see(path, key.span());
        see(path, value.span());
        visit_value(value.get_ref(), path, see);
        path.pop();
    }
}

fn visit_value(value: &DeValue<'_>, path: &mut Vec<String>, see: See<'_>) {
    match value {
        DeValue::Table(table) => visit_table(table, path, see),
        DeValue::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                path.push(index.to_string());
                see(path, item.span());
                visit_value(item.get_ref(), path, see);
                path.pop();
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(words: &[&str]) -> Vec<String> {
        words.iter().map(|word| (*word).to_owned()).collect()
    }

    /// Of several words that are like what was found the likest is asked for, and none where all differ.
    #[test]
    fn the_likest_of_the_legal_words_is_asked_for() {
        let legal = words(&["start", "stiffness", "stiffness_proportional", "stop"]);
        let all = "legal keys: start, stiffness, stiffness_proportional, stop";
        for (found, guess) in [
            ("stifness", "did you mean `stiffness`? "),
            ("STIFFNESS", "did you mean `stiffness`? "),
            ("stiffnes_proportionl", "did you mean `stiffness_proportional`? "),
            ("stpo", "did you mean `stop`? "),
            ("voltage", ""),
        ] {
            assert_eq!(choices("legal keys", found, &legal), format!("{guess}{all}"));
        }
        assert_eq!(choices("legal keys", "x", &[]), "legal keys: ");
    }

    #[test]
    fn lists_have_a_last_word() {
        for (of, text) in [
            (&[][..], "nothing"),
            (&["a"], "`a`"),
            (&["a", "b"], "`a` or `b`"),
            (&["a", "b", "c"], "`a`, `b` or `c`"),
        ] {
            assert_eq!(list(&words(of), '`'), text);
        }
        assert_eq!(quoted("key `a` is none of `b`, `c`"), ("a".to_owned(), words(&["b", "c"])));
    }

    /// The innermost of tables, lists and values that cover a place; a key belongs to its value.
    #[test]
    fn a_place_has_the_path_of_the_innermost_value() {
        let text = "a = 1\n[b]\nc = [10, { d = 20 }]\n[[e]]\nf = 3\n[[e]]\nf = 4\n";
        let document = DeTable::parse(text).expect("a document").into_inner();
        for (at, path) in [
            ("1", "a"),
            ("10", "b.c.0"),
            ("20", "b.c.1.d"),
            ("d = 20", "b.c.1"),
            ("c", "b.c"),
            ("3", "e.0.f"),
            ("4", "e.1.f"),
        ] {
            let start = text.find(at).expect("a place");
            assert_eq!(path_at(&document, &(start..start + at.len())).join("."), path, "{at}");
        }
    }
}
