//! Damage to scenes and saved states: to the tree of their values, and to the text.

use fastrand::Rng;
use serde_json::{Map, Value};

use crate::exercise::Input;

const NUMBERS: [f64; 21] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    3.0,
    7.0,
    100.0,
    1e-9,
    1e9,
    1e-300,
    1e300,
    -1e308,
    5e-324,
    1e-160,
    1e160,
    1e16,
    9.007199254740993e15,
    1.8e19,
    1e-6,
];

const WORDS: [&str; 24] = [
    "",
    "start",
    "end",
    "x",
    "y",
    "angle",
    "gradient",
    "1 m",
    "-3 kN",
    "90 deg",
    "36000 deg",
    "1e-300 m",
    "5 GPa",
    "green",
    "engineering",
    "lobatto",
    "equilibrium",
    "chebyshev",
    "1e400 m",
    "m",
    "nan",
    "1 m^3/s^2",
    "tip",
    "cantilever",
];

const TOKENS: [&str; 20] = [
    "nan",
    "inf",
    "-inf",
    "1e400",
    "-0",
    "0x7fffffffffffffff",
    "9223372036854775808",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'''",
    "=",
    ".",
    "\u{0}",
    "\u{feff}",
    "[[effect.force]]\n",
    "[analysis.static]\n",
    "#",
];

/// The next input.
pub fn input(rng: &mut Rng, scenes: &[String], states: &[(String, Value)]) -> Input {
    if !states.is_empty() && rng.u8(..4) == 0 {
        let (scene, state) = &states[rng.usize(..states.len())];
        let mut state = state.clone();
        harm(rng, &mut state, &Value::Null);
        let scene = if rng.bool() { scene.clone() } else { damaged(rng, scene, scenes) };
        let text = state.to_string();
        let state = if rng.u8(..4) == 0 { torn(rng, &text) } else { text };
        return Input { scene, state: Some(state) };
    }
    let seed = &scenes[rng.usize(..scenes.len())];
    Input { scene: damaged(rng, seed, scenes), state: None }
}

fn damaged(rng: &mut Rng, seed: &str, scenes: &[String]) -> String {
    let tree = |text: &str| toml::from_str::<Value>(text).ok();
    let other = scenes[rng.usize(..scenes.len())].as_str();
    let text = match (rng.u8(..8) > 0).then(|| tree(seed)).flatten() {
        Some(mut scene) => {
            let donor = tree(other).unwrap_or(Value::Null);
            harm(rng, &mut scene, &donor);
            toml::to_string(&scene).unwrap_or_else(|_| seed.to_owned())
        }
        None => seed.to_owned(),
    };
    if rng.u8(..5) == 0 { torn(rng, &text) } else { text }
}

/// One to four changes to a tree; `donor` is one from which parts may be taken.
fn harm(rng: &mut Rng, tree: &mut Value, donor: &Value) {
    for _ in 0..rng.usize(1..5) {
        let places = places(tree);
        let place = &places[rng.usize(..places.len())];
        let part = {
            let places = self::places(donor);
            donor.pointer(&places[rng.usize(..places.len())]).cloned().unwrap_or(Value::Null)
        };
        let twin = tree.pointer(&places[rng.usize(..places.len())]).cloned().unwrap_or(Value::Null);
        if let Some(value) = tree.pointer_mut(place) {
            change(rng, value, part, twin);
        }
    }
}

fn change(rng: &mut Rng, value: &mut Value, part: Value, twin: Value) {
    match value {
        Value::Number(number) if rng.u8(..4) > 0 => {
            let old = number.as_f64().unwrap_or(0.0);
            let new = match rng.u8(..5) {
                0 => NUMBERS[rng.usize(..NUMBERS.len())],
                1 => old * 10.0_f64.powi(rng.i32(-20..21)),
                2 => -old,
                3 => old * (1.0 + 1e-12 * rng.f64()),
                _ => return *value = Value::from(rng.i64(-2..40)),
            };
            *value = Value::from(new);
        }
        Value::String(text) if rng.bool() => *text = WORDS[rng.usize(..WORDS.len())].to_owned(),
        Value::Bool(flag) => *flag = !*flag,
        Value::Array(items) if !items.is_empty() && rng.bool() => {
            let at = rng.usize(..items.len());
            match rng.u8(..4) {
                0 => drop(items.remove(at)),
                1 => items.push(items[at].clone()),
                2 => rng.shuffle(items),
                _ => items.insert(at, twin),
            }
        }
        Value::Object(table) if !table.is_empty() && rng.bool() => {
            let keys: Vec<String> = table.keys().cloned().collect();
            let key = keys[rng.usize(..keys.len())].clone();
            match rng.u8(..3) {
                0 => drop(table.remove(&key)),
                1 => {
                    if let Some(value) = table.remove(&key) {
                        table.insert(WORDS[rng.usize(..WORDS.len())].to_owned(), value);
                    }
                }
                _ => merge(table, part),
            }
        }
        other if rng.u8(..3) == 0 => *other = twin,
        other if !part.is_null() => *other = part,
        other => *other = Value::from(NUMBERS[rng.usize(..NUMBERS.len())]),
    }
}

fn merge(table: &mut Map<String, Value>, part: Value) {
    if let Value::Object(more) = part {
        table.extend(more);
    }
}

/// JSON pointers to every value of a tree.
fn places(tree: &Value) -> Vec<String> {
    let mut found = vec![String::new()];
    let mut at = 0;
    while at < found.len() && found.len() < 4000 {
        let here = found[at].clone();
        match tree.pointer(&here) {
            Some(Value::Object(table)) => {
                let keys = table.keys().map(|key| key.replace('~', "~0").replace('/', "~1"));
                found.extend(keys.map(|key| format!("{here}/{key}")));
            }
            Some(Value::Array(items)) => found.extend((0..items.len()).map(|i| format!("{here}/{i}"))),
            _ => {}
        }
        at += 1;
    }
    found
}

/// The text with characters lost, doubled, replaced or put in.
fn torn(rng: &mut Rng, text: &str) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    for _ in 0..rng.usize(1..4) {
        if chars.is_empty() {
            break;
        }
        let at = rng.usize(..chars.len());
        let end = (at + rng.usize(..20)).min(chars.len());
        match rng.u8(..4) {
            0 => drop(chars.drain(at..end)),
            1 => {
                let piece: Vec<char> = chars[at..end].to_vec();
                chars.splice(at..at, piece);
            }
            2 => drop(chars.splice(at..at, TOKENS[rng.usize(..TOKENS.len())].chars())),
            _ => chars[at] = rng.char(..),
        }
    }
    chars.into_iter().collect()
}
