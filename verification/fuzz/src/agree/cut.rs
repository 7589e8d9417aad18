//! A beam cut in two, and welded.

use std::f64::consts::PI;

use toml::{Table, Value};

use super::frame::{list, vector};
use super::settings;

/// The scene with one straight or circular beam in two pieces, which a weld joins where a node was;
/// none where this cannot be written.
pub fn cut(scene: &Table) -> Option<Table> {
    let (name, beam) = settings::beams(scene).find(|(_, beam)| !beam.contains_key("points"))?;
    let name = name.clone();
    let basis = beam.get("basis")?.as_table()?;
    let (kind, table) = basis.iter().next().map(|(kind, table)| (kind.clone(), table.as_table()))?;
    let table = table?;
    let cells = settings::cells(basis);
    let least = if kind == "ancf" { 1 } else { 3 };
    if cells < 2 * least || table.get("spacing").and_then(Value::as_str) == Some("chebyshev") {
        return None;
    }
    let length = length(beam)?;
    let before = cells / 2;
    let (at, nodes) = match table.get("nodes") {
        Some(Value::Array(places)) => {
            let s = places.iter().map(Value::as_float).collect::<Option<Vec<f64>>>()?;
            let at = *s.get(before)?;
            let rest = s[before..].iter().map(|s| Value::Float(s - at)).collect();
            let first = s[..=before].iter().copied().map(Value::Float).collect();
            (at, [Value::Array(first), Value::Array(rest)])
        }
        _ => {
            let counts = [before + 1, cells - before + 1].map(|n| Value::Integer(n as i64));
            (length * before as f64 / cells as f64, counts)
        }
    };
    // What varies along the beam, or acts on a stretch of it, is not cut.
    let whole = ["arc", "basis", "section", "axial_law", "bending_law", "initial_shape"];
    let quantities = beam.iter().filter(|(key, _)| !whole.contains(&key.as_str()));
    let varies = quantities.into_iter().any(|(_, value)| value.is_table());
    let section = beam.get("section").map(Value::to_string).unwrap_or_default();
    let layered = ["table", "polynomial", "pieces"].iter().any(|varying| section.contains(varying));
    let effects = scene.get("effect").and_then(Value::as_table);
    let on_a_stretch = |item: &Value| {
        let along = |value: &Value| {
            ["table", "polynomial", "pieces"].iter().any(|kind| value.get(kind).is_some())
                || value.as_array().is_some_and(|both| both.iter().any(Value::is_table))
        };
        let varies =
            item.as_table().into_iter().flatten().any(|(key, value)| key != "in_time" && along(value));
        item.get("from").is_some() || item.get("to").is_some() || varies
    };
    let mut items = effects.into_iter().flatten().filter_map(|(_, list)| list.as_array()).flatten();
    if varies || layered || items.any(on_a_stretch) {
        return None;
    }
    // Two tendons of given length have each a tension of its own, where one has the same throughout.
    let of_length = |tendon: &Table| !tendon.contains_key("tension");
    let here = |item: &Table| item.get("beam").and_then(Value::as_str) == Some(&name);
    if settings::items(scene, &["effect", "tendon"]).any(|tendon| here(tendon) && of_length(tendon)) {
        return None;
    }
    let other = format!("{name}2");
    let mut scene = scene.clone();
    // Velocities along the arc length are given for the whole beam and are not cut.
    let along = |v: &Table| v.contains_key("polynomial") || v.contains_key("table");
    if settings::items(&scene, &["initial_velocity"]).any(along) {
        return None;
    }
    let [first, second] = pieces(beam, length, at)?;
    let beams = settings::table(&mut scene, &["beam"])?;
    let mut renamed = Table::new();
    for (key, value) in beams.iter() {
        if *key != name {
            renamed.insert(key.clone(), value.clone());
            continue;
        }
        for (piece, (key, nodes)) in
            [first.clone(), second.clone()].into_iter().zip([&name, &other].into_iter().zip(nodes.clone()))
        {
            let mut piece = piece;
            let mut kind_table = table.clone();
            kind_table.remove("elements");
            kind_table.insert("nodes".into(), nodes);
            let mut basis = Table::new();
            basis.insert(kind.clone(), kind_table.into());
            piece.insert("basis".into(), basis.into());
            renamed.insert(key.clone(), piece.into());
        }
    }
    *beams = renamed;
    let cut = Cut { name: &name, other: &other, at, length };
    cut.places(&mut scene);
    cut.whole(&mut scene);
    // A string passes no couple.
    let kind = if settings::bends(&first) { "weld" } else { "hinge" };
    let mut weld = Table::new();
    weld.insert("type".into(), kind.into());
    for (key, beam, at) in [("first", &name, "end"), ("second", &other, "start")] {
        let mut point = Table::new();
        point.insert("beam".into(), beam.clone().into());
        point.insert("at".into(), at.into());
        weld.insert(key.into(), point.into());
    }
    let joints = scene.entry("joint").or_insert_with(|| Value::Array(Vec::new()));
    joints.as_array_mut()?.push(weld.into());
    Some(scene)
}

struct Cut<'c> {
    name: &'c str,
    other: &'c str,
    at: f64,
    length: f64,
}

impl Cut<'_> {
    /// Moves points of the beam to the piece on which they are.
    fn places(&self, scene: &mut Table) {
        for (_, value) in scene.iter_mut() {
            self.visit(value);
        }
    }

    fn visit(&self, value: &mut Value) {
        match value {
            Value::Array(items) => items.iter_mut().for_each(|item| self.visit(item)),
            Value::Table(table) => {
                let mine = table.get("beam").and_then(Value::as_str) == Some(self.name);
                if let (true, Some(at)) = (mine, table.get("at").cloned()) {
                    let s = match &at {
                        Value::Float(s) => *s,
                        Value::String(end) if end == "end" => self.length,
                        _ => 0.0,
                    };
                    if s > self.at {
                        let at = if at.is_float() {
                            Value::Float((s - self.at).min(self.length - self.at))
                        } else {
                            at
                        };
                        table.insert("beam".into(), self.other.into());
                        table.insert("at".into(), at);
                    } else if (s - self.at).abs() < 1e-9 * self.length {
                        table.insert("at".into(), "end".into());
                    }
                }
                table.iter_mut().filter(|(key, _)| *key != "beam").for_each(|(_, below)| self.visit(below));
            }
            _ => {}
        }
    }

    /// Effects along the whole beam act along both pieces.
    fn whole(&self, scene: &mut Table) {
        let doubled = |list: &mut Vec<Value>| {
            let copies: Vec<Value> = list
                .iter()
                .filter(|item| {
                    item.get("at").is_none() && item.get("beam").and_then(Value::as_str) == Some(self.name)
                })
                .cloned()
                .map(|mut item| {
                    if let Value::Table(table) = &mut item {
                        table.insert("beam".into(), self.other.into());
                        if table.contains_key("speed") {
                            let start = table.get("start").and_then(Value::as_float).unwrap_or(0.0);
                            table.insert("start".into(), (start - self.at).into());
                        }
                    }
                    item
                })
                .collect();
            list.extend(copies);
        };
        if let Some(Value::Array(list)) = scene.get_mut("initial_velocity") {
            doubled(list);
        }
        if let Some(Value::Table(effects)) = scene.get_mut("effect") {
            for (_, effect) in effects.iter_mut() {
                if let Value::Array(list) = effect {
                    doubled(list);
                }
            }
        }
    }
}

fn length(beam: &Table) -> Option<f64> {
    if let Some(arc) = beam.get("arc") {
        let float = |key: &str| arc.get(key).and_then(Value::as_float);
        return Some(float("radius")? * (float("to")? - float("from")?).abs());
    }
    let [start, end] = [beam.get("start")?, beam.get("end")?].map(vector);
    let ([a, b], [c, d]) = (start?, end?);
    Some((c - a).hypot(d - b))
}

fn pieces(beam: &Table, length: f64, at: f64) -> Option<[Table; 2]> {
    let part = at / length;
    let mut both = shapes(beam, part)?;
    match beam.get("initial_shape").and_then(Value::as_table) {
        Some(shape) if shape.contains_key("points") => return None,
        Some(shape) => {
            let line = shape.get("line").and_then(Value::as_table);
            let pieces = shapes(line.unwrap_or(shape), part)?;
            for (beam, piece) in both.iter_mut().zip(pieces) {
                let mut shape = piece;
                if line.is_some() {
                    shape = [("line".to_owned(), Value::from(shape))].into_iter().collect();
                }
                beam.insert("initial_shape".into(), shape.into());
            }
        }
        None => {}
    }
    Some(both)
}

/// A table with an `arc`, or with `start` and `end`, cut at a part of its length.
fn shapes(whole: &Table, part: f64) -> Option<[Table; 2]> {
    let (mut first, mut second) = (whole.clone(), whole.clone());
    if let Some(Value::Table(arc)) = whole.get("arc") {
        let float = |key: &str| arc.get(key).and_then(Value::as_float);
        let (from, to) = (float("from")?, float("to")?);
        // More than a turn is cut as well.
        let middle = from + part * (to - from);
        debug_assert!(middle.abs() < 100.0 * PI);
        first.get_mut("arc")?.as_table_mut()?.insert("to".into(), middle.into());
        second.get_mut("arc")?.as_table_mut()?.insert("from".into(), middle.into());
    } else {
        let ([a, b], [c, d]) = (vector(whole.get("start")?)?, vector(whole.get("end")?)?);
        let middle = list([a + part * (c - a), b + part * (d - b)]);
        first.insert("end".into(), middle.clone());
        second.insert("start".into(), middle);
    }
    Some([first, second])
}
