//! Makes a scene that is a finding smaller, as long as it stays one.

use toml::{Table, Value};

use super::draw::round;
use super::frame::Frame;
use super::judge::{Case, Finding, Verdict, judge};
use super::outcome;
use super::ways::Way;
use super::{settings, stages};

/// Scenes that are tried at most.
const TRIES: usize = 100;

/// Keys of a beam's stiffness and mass.
const SECTION: [&str; 10] = [
    "axial_stiffness",
    "bending_stiffness",
    "mass_per_length",
    "youngs_modulus",
    "area",
    "second_moment",
    "density",
    "section",
    "axial_law",
    "bending_law",
];

/// The smallest scene found, and what it is a finding of.
pub fn shrink(case: Case, finding: Finding) -> (Case, Finding) {
    let mut shrink = Shrink { way: finding.way, best: case, finding, tries: TRIES };
    shrink.natural_units();
    while shrink.tries > 0 && shrink.pass() {}
    shrink.round();
    (shrink.best, shrink.finding)
}

struct Shrink {
    way: Way,
    best: Case,
    finding: Finding,
    tries: usize,
}

impl Shrink {
    /// Whether the scene is still a finding; kept if it is.
    fn keeps(&mut self, scene: Table, frame: Frame) -> bool {
        if self.tries == 0 || scene == self.best.scene && frame == self.best.frame {
            return false;
        }
        self.tries -= 1;
        if outcome::check(&scene, &frame).is_err() {
            return false;
        }
        let case = Case { scene, frame, seed: self.best.seed };
        let base = outcome::run(&case.scene, &case.frame);
        if let Verdict::Finding(finding) = judge(&case, self.way, &base) {
            (self.best, self.finding) = (case, finding);
            return true;
        }
        false
    }

    fn natural_units(&mut self) {
        let frame = self.best.frame;
        let plain = Frame::default();
        for simpler in [
            plain,
            Frame { units: frame.units, ..plain },
            Frame { units: plain.units, ..frame },
            Frame { shift: plain.shift, ..frame },
        ] {
            if self.keeps(self.best.scene.clone(), simpler) {
                break;
            }
        }
    }

    /// Leaves out what can be left out; whether anything was.
    fn pass(&mut self) -> bool {
        let mut smaller = false;
        for beam in ["c", "b"] {
            let without = without_beam(&self.best.scene, beam);
            smaller |= without.is_some_and(|scene| self.keeps(scene, self.best.frame));
        }
        for index in (0..stages::kinds(&self.best.scene).len()).rev() {
            let without = stages::without(&self.best.scene, index);
            smaller |= without.is_some_and(|scene| self.keeps(scene, self.best.frame));
        }
        let mut paths = Vec::new();
        removable(&self.best.scene, &mut Vec::new(), &mut paths);
        // Large tables first.
        paths.sort_by_key(Vec::len);
        for path in paths {
            let mut scene = self.best.scene.clone();
            if remove(&mut scene, &path) {
                smaller |= self.keeps(scene, self.best.frame);
            }
        }
        let halved = settings::map_bases(&self.best.scene, half);
        smaller | halved.is_some_and(|scene| self.keeps(scene, self.best.frame))
    }

    fn round(&mut self) {
        for digits in [1, 2, 3] {
            let mut scene = self.best.scene.clone();
            round_all(&mut scene, digits);
            if self.keeps(scene, self.best.frame) {
                break;
            }
        }
    }
}

/// One step of the way to a value: a key, or the number of a list's entry.
#[derive(Clone, Debug)]
enum Step {
    Key(String),
    Entry(usize),
}

/// All keys and entries that may go.
fn removable(table: &Table, here: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
    for (key, value) in table {
        let below_beam = matches!(here.first(), Some(Step::Key(first)) if first == "beam");
        here.push(Step::Key(key.clone()));
        // Without its stiffness a beam is another problem, and not a smaller one.
        if key != "output" && !(below_beam && (here.len() == 2 || SECTION.contains(&key.as_str()))) {
            found.push(here.clone());
        }
        match value {
            // The balances need the outputs.
            _ if key == "output" => {}
            Value::Table(table) => removable(table, here, found),
            Value::Array(list) => {
                // From the end, so that the numbers of the others stay.
                for (i, item) in list.iter().enumerate().rev() {
                    if let Value::Table(item) = item {
                        here.push(Step::Entry(i));
                        found.push(here.clone());
                        removable(item, here, found);
                        here.pop();
                    }
                }
            }
            _ => {}
        }
        here.pop();
    }
}

fn remove(table: &mut Table, path: &[Step]) -> bool {
    match path {
        [Step::Key(key)] => table.remove(key).is_some(),
        [Step::Key(key), rest @ ..] => match (table.get_mut(key), rest) {
            (Some(Value::Table(below)), rest) => remove(below, rest),
            (Some(Value::Array(list)), [Step::Entry(i)]) if *i < list.len() => {
                list.remove(*i);
                true
            }
            (Some(Value::Array(list)), [Step::Entry(i), rest @ ..]) => {
                list.get_mut(*i).and_then(Value::as_table_mut).is_some_and(|below| remove(below, rest))
            }
            _ => false,
        },
        _ => false,
    }
}

/// The scene without a beam, and all that names it.
fn without_beam(scene: &Table, beam: &str) -> Option<Table> {
    let mut scene = scene.clone();
    settings::table(&mut scene, &["beam"])?.remove(beam)?;
    let speaks = |value: &Value| value.get("beam").and_then(Value::as_str) == Some(beam);
    let drop = |list: &mut Vec<Value>| {
        list.retain(|item| {
            !speaks(item) && !["first", "second"].iter().any(|key| item.get(*key).is_some_and(speaks))
        });
    };
    for (_, value) in scene.iter_mut() {
        match value {
            Value::Array(list) => drop(list),
            Value::Table(table) => table.iter_mut().for_each(|(_, below)| {
                if let Value::Array(list) = below {
                    drop(list);
                }
            }),
            _ => {}
        }
    }
    Some(scene)
}

fn half(basis: &Table) -> Option<Table> {
    let mut basis = basis.clone();
    for (_, kind) in basis.iter_mut() {
        for (key, least) in [("elements", 1), ("nodes", 3)] {
            if let Some(Value::Integer(n)) = kind.get_mut(key) {
                *n = (*n / 2).max(least);
            }
        }
    }
    Some(basis)
}

fn round_all(table: &mut Table, digits: i32) {
    fn value(v: &mut Value, digits: i32) {
        match v {
            Value::Float(number) => *number = round(*number, digits),
            Value::Array(list) => list.iter_mut().for_each(|item| value(item, digits)),
            Value::Table(table) => round_all(table, digits),
            _ => {}
        }
    }
    // The kinks of an expression are where its text says.
    table.iter_mut().filter(|(key, _)| *key != "kinks").for_each(|(_, v)| value(v, digits));
}
