//! `--set PATH=VALUE`: values of a scene changed from outside, under the same checks as the file's
//! own.

use std::ops::Range;

use toml::de::{DeTable, DeValue};
use toml_edit::{DocumentMut, InlineTable, Item, Key, Table, Value};

use super::diagnose::{choices, path_at};
use super::error::{Fault, SceneError};

/// A scene's text before and after each override.
pub(super) struct Overridden<'a> {
    name: &'a str,
    /// Those that were given, each with `*` in its path as many as it stands for.
    overrides: Vec<String>,
    /// The texts: one more than overrides; the last one is read.
    texts: Vec<String>,
    /// Paths that were set.
    paths: Vec<Vec<String>>,
}

impl<'a> Overridden<'a> {
    /// Applies `overrides` in order to the scene `text`, which must be TOML.
    pub fn apply(name: &'a str, text: &str, overrides: &[String]) -> Result<Self, SceneError> {
        let mut this = Self { name, overrides: Vec::new(), texts: vec![text.to_owned()], paths: Vec::new() };
        for given in overrides {
            let all = expanded(this.text(), given).map_err(|fault| on_option(fault, given))?;
            for option in all {
                let (text, path) = set(this.text(), &option).map_err(|fault| on_option(fault, &option))?;
                this.texts.push(text);
                this.paths.push(path);
                this.overrides.push(option);
            }
        }
        Ok(this)
    }

    /// The text with every override applied.
    pub fn text(&self) -> &str {
        self.texts.last().map_or("", String::as_str)
    }

    /// Blames a fault of [`text`](Self::text) on the override that brought it, or on its place in
    /// the file.
    pub fn blame(&self, mut fault: Fault) -> SceneError {
        let document = DeTable::parse(self.text());
        let path = document.map(|root| path_at(root.get_ref(), &fault.span)).unwrap_or_default();
        let value_of = |mut fault: Fault, option: &str| {
            fault.span = option.find('=').map_or(0, |at| at + 1)..option.len();
            on_option(fault, option)
        };
        if let Some(setter) = self.paths.iter().rposition(|set| path.starts_with(set)) {
            return value_of(fault, &self.overrides[setter]);
        }
        for (pair, option) in self.texts.windows(2).zip(&self.overrides).rev() {
            let [before, after] = pair else { continue };
            let Some(start) = origin(before, after, &fault.span) else { return value_of(fault, option) };
            fault.span = start..start.saturating_add(fault.span.len());
        }
        fault.at(self.name, self.texts.first().map_or("", String::as_str))
    }
}

/// A fault in the text of the option itself.
fn on_option(mut fault: Fault, option: &str) -> SceneError {
    fault.message = format!("{} (in the override `{option}`)", fault.message);
    fault.at("--set", option)
}

/// Where the text at `span` of `after` began in `before`, unless it was touched by the change
/// between the two.
fn origin(before: &str, after: &str, span: &Range<usize>) -> Option<usize> {
    let same = |(a, b): &(u8, u8)| a == b;
    let prefix = before.bytes().zip(after.bytes()).take_while(same).count();
    let longest = before.len().min(after.len()) - prefix;
    let suffix = before.bytes().rev().zip(after.bytes().rev()).take(longest).take_while(same).count();
    if span.end <= prefix {
        Some(span.start)
    } else if span.start >= after.len() - suffix && suffix > 0 {
        Some(span.start - (after.len() - suffix) + (before.len() - suffix))
    } else {
        None
    }
}

/// The overrides that `option` stands for: with `*` in the place of a key one for each entry that the
/// scene `text` has there.
fn expanded(text: &str, option: &str) -> Result<Vec<String>, Fault> {
    let path = option.split('=').next().unwrap_or_default();
    let star = match path.find(".*") {
        Some(dot) if matches!(path.as_bytes().get(dot + 2), None | Some(b'.')) => dot,
        _ => return Ok(vec![option.to_owned()]),
    };
    let (before, after) = (&option[..star], &option[star + 2..]);
    let entries = match value(text, before)? {
        Some(serde_json::Value::Object(table)) => table.keys().map(|key| Key::new(key).to_string()).collect(),
        Some(serde_json::Value::Array(entries)) => {
            (0..entries.len()).map(|index| index.to_string()).collect()
        }
        _ => Vec::new(),
    };
    if entries.is_empty() {
        let message = format!("`{before}` has no entries for which `*` could stand");
        return Err(Fault::new(star + 1..star + 2, message)
            .help("`*` stands for all names of a table, or numbers of a list"));
    }
    let each = entries.iter().map(|entry: &String| expanded(text, &format!("{before}.{entry}{after}")));
    Ok(each.collect::<Result<Vec<_>, _>>()?.concat())
}

/// The text with one override applied, and the path that it sets.
fn set(text: &str, option: &str) -> Result<(String, Vec<String>), Fault> {
    const USAGE: &str =
        "such as --set beam.arm.basis.ancf.elements=9 or --set effect.moment.0.value=\"3 kN m\"";
    let Some((path, value)) = option.split_once('=') else {
        return Err(Fault::new(0..option.len(), "expected PATH=VALUE, found no `=`").help(USAGE));
    };
    let keys = Key::parse(path).map_err(|_| {
        Fault::new(0..path.len(), format!("`{path}` is not a path of keys joined by dots")).help(USAGE)
    })?;
    let value = value.trim().parse::<Value>().unwrap_or_else(|_| Value::from(value.trim()));
    let names: Vec<String> = keys.iter().map(|key| key.get().to_owned()).collect();
    let text = match single_value(text, &names) {
        Some(old) => {
            let (before, after) = (text.get(..old.start), text.get(old.end..));
            format!("{}{value}{}", before.unwrap_or_default(), after.unwrap_or_default())
        }
        None => {
            let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
                Fault::new(0..option.len(), format!("cannot be applied to this scene: {}", error.message()))
            })?;
            assign(document.as_item_mut(), &names, value)
                .map_err(|(message, help)| Fault::new(0..path.len(), message).help(help))?;
            document.to_string()
        }
    };
    // The editor should write only what can be read. If it ever does not, the option is blamed, not
    // the file.
    if let Err(error) = DeTable::parse(&text) {
        return Err(
            Fault::new(0..option.len(), format!("cannot be applied here: {}", error.message())).help(USAGE)
        );
    }
    Ok((text, names))
}

/// Where the text of a number, text or truth value stands, if the path leads to one: the usual case
/// of many runs, in which other text in its place is all that changes.
fn single_value(text: &str, path: &[String]) -> Option<Range<usize>> {
    let root = DeTable::parse(text).ok()?;
    let (first, rest) = path.split_first()?;
    let mut value = root.get_ref().get(first.as_str())?;
    for key in rest {
        value = match value.get_ref() {
            DeValue::Table(table) => table.get(key.as_str())?,
            DeValue::Array(entries) => entries.get(key.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    let single = !matches!(value.get_ref(), DeValue::Table(_) | DeValue::Array(_));
    single.then(|| value.span())
}

/// The value at a path of the scene `text`, if there is one.
pub(super) fn value(text: &str, path: &str) -> Result<Option<serde_json::Value>, Fault> {
    let keys = Key::parse(path).map_err(|_| {
        Fault::new(0..path.len(), format!("`{path}` is not a path of keys joined by dots"))
            .help("such as beam.arm.basis.ancf.elements or effect.moment.0.value")
    })?;
    let root = toml::from_str::<serde_json::Value>(text)
        .map_err(|error| Fault::new(0..path.len(), error.message().to_owned()))?;
    Ok(keys
        .iter()
        .try_fold(&root, |value, key| match value {
            serde_json::Value::Array(entries) => entries.get(key.get().parse::<usize>().ok()?),
            value => value.get(key.get()),
        })
        .cloned())
}

/// Sets the value at `path` below `root`; adds the last key, and tables on the way, where they are
/// missing.
fn assign(root: &mut Item, path: &[String], value: Value) -> Result<(), (String, String)> {
    let Some((last, parents)) = path.split_last() else {
        return Err(("the path is empty".into(), "name a key of the scene".into()));
    };
    let mut item = root;
    for (depth, key) in parents.iter().enumerate() {
        // A single value cannot define a beam: an unknown name is a misspelt one.
        let may_add = depth != 1 || path.first().is_none_or(|first| first != "beam");
        item = child(item, path, depth, key, may_add)?;
    }
    let depth = parents.len();
    if item.is_table_like() && item.get(last.as_str()).is_none() && !(depth == 1 && path[0] == "beam") {
        if let Some(table) = item.as_table_like_mut() {
            table.insert(last, Item::Value(value));
        }
        return Ok(());
    }
    let of_tables = item.is_array_of_tables();
    let place = child(item, path, depth, last, false)?;
    if of_tables {
        // Of a `[[list]]` only tables are written; any other entry would silently be lost.
        let found = value.type_name();
        let Value::InlineTable(table) = value else {
            return Err((
                format!("`{}` is a table, found a value of type {found}", path.join(".")),
                "give a table, such as { beam = \"arm\", … }, or set one of its keys".into(),
            ));
        };
        *place = Item::Table(table.into_table());
        return Ok(());
    }
    let decor = place.as_value().map(|old| old.decor().clone());
    *place = Item::Value(value);
    if let (Some(decor), Some(new)) = (decor, place.as_value_mut()) {
        *new.decor_mut() = decor;
    }
    Ok(())
}

fn child<'a>(
    item: &'a mut Item,
    path: &[String],
    depth: usize,
    key: &str,
    may_add: bool,
) -> Result<&'a mut Item, (String, String)> {
    let so_far = path.get(..depth).unwrap_or_default().join(".");
    let there = if so_far.is_empty() { "the scene".to_owned() } else { format!("`{so_far}`") };
    if item.is_table_like() {
        let inline = item.is_inline_table();
        let keys: Vec<String> =
            item.as_table_like().map(|t| t.iter().map(|(k, _)| k.to_owned()).collect()).unwrap_or_default();
        let absent = !keys.iter().any(|k| k == key);
        if absent && keys.is_empty() && key.parse::<usize>().is_ok() {
            return Err((
                format!("the scene has no {there}, of which this would be number {key}"),
                format!(
                    "an override changes what is there: write `[[{so_far}]]` into the scene, or give the whole list, as `{so_far}=[{{ … }}]`"
                ),
            ));
        }
        if absent && !may_add {
            return Err((format!("{there} has no `{key}`"), choices("it has", key, &keys)));
        }
        let table = item.as_table_like_mut().map(|table| {
            table.entry(key).or_insert_with(|| {
                if inline {
                    return Item::Value(Value::InlineTable(InlineTable::new()));
                }
                let mut table = Table::new();
                table.set_implicit(true);
                Item::Table(table)
            })
        });
        return table.ok_or_else(|| (format!("{there} is no table"), String::new()));
    }
    let length = item.as_array().map(|a| a.len()).or_else(|| item.as_array_of_tables().map(|a| a.len()));
    let Some(length) = length else {
        return Err((
            format!("{there} is a {}, so `{key}` cannot be set in it", item.type_name()),
            format!("set {there} itself, or check the path"),
        ));
    };
    let help = match length {
        0 => "the list is empty".to_owned(),
        1 => "its only entry is 0".to_owned(),
        n => format!("its entries are 0 to {}", n - 1),
    };
    let found = key.parse::<usize>().ok().filter(|index| *index < length);
    match found.and_then(|index| item.get_mut(index)) {
        Some(entry) => Ok(entry),
        None => Err((format!("{there} is a list and has no entry `{key}`"), help)),
    }
}
