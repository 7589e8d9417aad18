//! Draws random scenes over the whole vocabulary, in natural units: L = 1, EI = 1, ρA = 1. Most of
//! them are legal; the reader decides.

mod analysis;
mod beams;
mod effects;
mod fields;
mod law;
mod staged;
mod support;

use fastrand::Rng;
use toml::{Table, Value};

use super::frame::{Frame, has_axes};

/// The scene drawn so far, for the parts that are drawn later.
pub struct Draw<'r> {
    rng: &'r mut Rng,
    scene: Table,
    beams: Vec<Drawn>,
    kind: Kind,
    /// Simulated time of a motion, in natural units.
    duration: f64,
}

/// A beam that was drawn.
struct Drawn {
    name: String,
    /// Its stress-free shape.
    curve: ancf::centreline::Curve,
    /// Where it is at the start.
    starts: ancf::centreline::Curve,
    straight: bool,
    /// Length of the beam.
    length: f64,
    axial: Option<f64>,
    bends: bool,
    /// Whether it has an elastic law in place of a stiffness.
    by_law: bool,
    /// Whether its section has a shape, and layers.
    shaped: bool,
    layered: bool,
}

/// The kind of analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Static,
    ArcLength,
    Dynamic,
    Modal,
    Equilibrium,
    Buckling,
}

/// A scene.
pub fn scene(rng: &mut Rng) -> Table {
    let kind = match rng.u8(0..100) {
        0..32 => Kind::Static,
        32..40 => Kind::ArcLength,
        40..78 => Kind::Dynamic,
        78..86 => Kind::Modal,
        86..92 => Kind::Equilibrium,
        _ => Kind::Buckling,
    };
    let mut draw = Draw { rng, scene: Table::new(), beams: Vec::new(), kind, duration: 0.0 };
    draw.duration = draw.log(0.02, 4.0);
    if draw.chance(0.05) {
        draw.scene.insert("title".into(), "drawn".into());
    }
    draw.beams();
    draw.supports();
    draw.effects();
    draw.probes();
    draw.analysis();
    match draw.rng.u8(0..100) {
        0..8 => draw.accuracy(),
        // Most stages of vibrations and critical loads are refused.
        8..20 if matches!(draw.kind, Kind::Modal | Kind::Buckling) => draw.accuracy(),
        8..40 => draw.stages(),
        _ => {}
    }
    draw.output();
    draw.scene
}

/// A frame for a scene: units from µm to km, from µg to kt, from µs to minutes; any direction that
/// the scene allows.
pub fn frame(rng: &mut Rng, scene: &Table) -> Frame {
    let mut power = |low: f64, high: f64| 10f64.powf(low + (high - low) * rng.f64());
    let units = [power(-6.0, 3.0), power(-9.0, 6.0), power(-6.0, 2.0)];
    // Half of the scenes keep to the axes, as users draw them: exact zeros are a case of their own.
    let turn = if has_axes(scene) || rng.bool() { 0.0 } else { std::f64::consts::TAU * rng.f64() };
    let shift = if rng.u8(0..3) == 0 { [3.0 * rng.f64(), -2.0 * rng.f64()] } else { [0.0; 2] };
    Frame { units, mirrored: rng.bool(), quarters: rng.u8(0..4), turn, shift }
}

/// Rounds to so many significant digits.
pub fn round(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    format!("{value:.*e}", usize::try_from(digits - 1).unwrap_or(0)).parse().unwrap_or(value)
}

/// A list of numbers.
fn numbers(list: &[f64]) -> Value {
    Value::Array(list.iter().copied().map(Value::Float).collect())
}

impl Draw<'_> {
    fn chance(&mut self, probability: f64) -> bool {
        self.rng.f64() < probability
    }

    /// A number drawn evenly between two numbers.
    fn even(&mut self, low: f64, high: f64) -> f64 {
        round(low + (high - low) * self.rng.f64(), 4)
    }

    /// A number whose logarithm is drawn evenly between those of two numbers.
    fn log(&mut self, low: f64, high: f64) -> f64 {
        round(low * (high / low).powf(self.rng.f64()), 4)
    }

    /// [`Self::log`] with either sign.
    fn signed(&mut self, low: f64, high: f64) -> f64 {
        let size = self.log(low, high);
        if self.rng.bool() { size } else { -size }
    }

    /// A vector of any direction, sometimes along an axis.
    fn vector(&mut self, low: f64, high: f64) -> Value {
        let size = self.log(low, high);
        let [x, y] = match self.rng.u8(0..5) {
            0 => [1.0, 0.0],
            1 => [0.0, -1.0],
            _ => {
                let (sine, cosine) = (std::f64::consts::TAU * self.rng.f64()).sin_cos();
                [cosine, sine]
            }
        };
        super::frame::list([round(size * x, 4), round(size * y, 4)])
    }

    fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.rng.usize(0..choices.len())]
    }

    fn is_motion(&self) -> bool {
        self.kind == Kind::Dynamic
    }

    /// A beam's index.
    fn any_beam(&mut self) -> usize {
        self.rng.usize(0..self.beams.len())
    }

    /// A table that names a beam.
    fn of_beam(&mut self) -> (usize, Table) {
        let beam = self.any_beam();
        let mut table = Table::new();
        table.insert("beam".into(), self.beams[beam].name.clone().into());
        (beam, table)
    }

    /// Length of the beam that a table names.
    fn length_of_beam(&self, table: &Table) -> Option<f64> {
        let name = table.get("beam")?.as_str()?;
        self.beams.iter().find(|beam| beam.name == name).map(|beam| beam.length)
    }

    /// Lets what acts along a whole beam act on a stretch of it, sometimes.
    fn perhaps_stretch(&mut self, table: &mut Table) {
        let Some(length) = self.length_of_beam(table) else { return };
        if !self.chance(0.15) {
            return;
        }
        let (from, to) = (self.even(0.05, 0.45), self.even(0.55, 0.95));
        let ends = self.rng.u8(0..3);
        if ends != 1 && !table.contains_key("from") {
            table.insert("from".into(), (length * from).into());
        }
        if ends != 0 {
            table.insert("to".into(), (length * to).into());
        }
    }

    /// Lets what a table gives for a whole beam vary along it, sometimes.
    fn perhaps_vary(&mut self, table: &mut Table, keys: &[&str]) {
        let Some(length) = self.length_of_beam(table) else { return };
        if !self.chance(0.25) {
            return;
        }
        for key in keys {
            match table.get_mut(*key) {
                Some(Value::Array(both)) => both.iter_mut().for_each(|value| self.vary(value, length)),
                Some(value) => self.vary(value, length),
                None => {}
            }
        }
    }

    /// Lets a vector vary along a beam of this `length`, sometimes: both components at the same places.
    fn perhaps_vary_vector(&mut self, vector: &mut Value, length: f64) {
        let Some([x, y]) = super::frame::vector(vector).filter(|[x, _]| *x != 0.0) else { return };
        if !self.chance(0.25) {
            return;
        }
        let mut first = Value::Float(x);
        self.vary(&mut first, length);
        let mut second = first.clone();
        for list in second.as_table_mut().into_iter().flat_map(super::frame::values_along) {
            for value in list.iter_mut() {
                if let Value::Float(v) = value {
                    *v *= y / x * self.even(0.7, 1.3);
                }
            }
        }
        *vector = Value::Array(vec![first, second]);
    }

    /// A table that names a point of a beam; its arc length.
    fn of_point(&mut self) -> (usize, f64, Table) {
        let (beam, mut table) = self.of_beam();
        let length = self.beams[beam].length;
        let (at, s): (Value, f64) = match self.rng.u8(0..10) {
            0..2 => ("start".into(), 0.0),
            2..7 => ("end".into(), length),
            7..9 => {
                let s = length * self.pick(&[0.25, 0.5, 0.75]);
                (s.into(), s)
            }
            _ => {
                let s = length * self.even(0.05, 0.95);
                (s.into(), s)
            }
        };
        table.insert("at".into(), at);
        (beam, s, table)
    }

    /// Adds an entry to a list of the scene, such as `effect.force`.
    fn push(&mut self, path: &[&str], table: Table) {
        let mut place = &mut self.scene;
        let (last, above) = path.split_last().unwrap_or((&"", &[]));
        for key in above {
            let below = place.entry(*key).or_insert_with(|| Table::new().into());
            let Value::Table(below) = below else { return };
            place = below;
        }
        if let Value::Array(list) = place.entry(*last).or_insert_with(|| Value::Array(Vec::new())) {
            list.push(table.into());
        }
    }

    fn probes(&mut self) {
        let ends: Vec<String> = self.beams.iter().map(|beam| beam.name.clone()).collect();
        for (i, beam) in ends.iter().enumerate() {
            let mut probe = Table::new();
            probe.insert("name".into(), format!("p{i}").into());
            probe.insert("beam".into(), beam.clone().into());
            probe.insert("at".into(), "end".into());
            self.push(&["probe"], probe);
        }
        if self.chance(0.5) {
            let (_, _, mut probe) = self.of_point();
            probe.insert("name".into(), "other".into());
            self.push(&["probe"], probe);
        }
    }

    fn output(&mut self) {
        let mut output = Table::new();
        for (key, share) in
            [("reactions", 1.0), ("effects", 1.0), ("states", 0.05), ("vtu", 0.05), ("section_forces", 0.05)]
        {
            if self.chance(share) {
                output.insert(key.into(), true.into());
            }
        }
        self.scene.insert("output".into(), output.into());
    }
}
