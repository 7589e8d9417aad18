//! Units, direction and place in which a scene is written down. Scenes are drawn in natural units:
//! L = 1, EI = 1, ρA = 1.

use toml::{Table, Value};

use super::quantity::{Dimension, Nature, axes, nature, watched};
use super::{formula, settings};

/// How natural coordinates become those of a scene: mirrored first, then turned, stretched and
/// shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Natural units of length, mass and time in SI.
    pub units: [f64; 3],
    /// Whether y points the other way.
    pub mirrored: bool,
    /// Quarter turns, counter-clockwise, which turn axes into axes.
    pub quarters: u8,
    /// Further turn \[rad\]; zero in scenes with settings along one axis.
    pub turn: f64,
    /// Where the origin goes, in natural lengths.
    pub shift: [f64; 2],
}

impl Default for Frame {
    fn default() -> Self {
        Self { units: [1.0; 3], mirrored: false, quarters: 0, turn: 0.0, shift: [0.0; 2] }
    }
}

impl Frame {
    /// The unit of a quantity.
    pub fn unit(&self, dimension: Dimension) -> f64 {
        self.units.iter().zip(dimension).map(|(unit, power)| unit.powi(power)).product()
    }

    /// −1 if mirrored, otherwise 1.
    pub fn sign(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }

    /// The angle by which all is turned \[rad\].
    fn angle(&self) -> f64 {
        f64::from(self.quarters) * std::f64::consts::FRAC_PI_2 + self.turn
    }

    /// A direction, mirrored and turned.
    pub fn direction(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let y = self.sign() * y;
        let [x, y] = match self.quarters % 4 {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        let (sine, cosine) = self.turn.sin_cos();
        [x * cosine - y * sine, x * sine + y * cosine]
    }

    /// The reverse of [`direction`](Self::direction).
    pub fn back(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.turn.sin_cos();
        let [x, y] = [x * cosine + y * sine, y * cosine - x * sine];
        let [x, y] = match self.quarters % 4 {
            0 => [x, y],
            1 => [y, -x],
            2 => [-x, -y],
            _ => [-y, x],
        };
        [x, self.sign() * y]
    }

    /// A place in the coordinates of the scene.
    fn point(&self, p: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.direction(p);
        [self.units[0] * (x + self.shift[0]), self.units[0] * (y + self.shift[1])]
    }

    /// The reverse of [`point`](Self::point).
    pub fn point_back(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        self.back([x / self.units[0] - self.shift[0], y / self.units[0] - self.shift[1]])
    }

    /// The scene as it is written in this frame.
    pub fn write(&self, natural: &Table) -> Table {
        let mut scene = natural.clone();
        self.table("", &mut scene);
        scene
    }

    fn table(&self, path: &str, table: &mut Table) {
        self.complete(path, table);
        if let Some((keys, dimension, places)) = axes(path) {
            self.components(path, table, (keys, dimension, places));
        }
        if path == "support" {
            self.fixed(table);
        }
        if path == "analysis.dynamic.event" {
            self.event(table);
        }
        // Of the two layers that are drawn.
        if let (true, Some(Value::Integer(layer))) =
            (self.mirrored && path == "effect.actuation", table.get_mut("layer"))
        {
            *layer = 3 - *layer;
        }
        // Layers are listed from the right face to the left one, which a mirror exchanges.
        if let (true, Some(Value::Array(layers))) =
            (self.mirrored && path == "beam.*.section", table.get_mut("layers"))
        {
            layers.reverse();
        }
        // A mirror exchanges bending to the left with bending to the right.
        if self.mirrored && path == "beam.*.bending_law" {
            for list in table.iter_mut().filter_map(|(_, list)| list.as_array_mut()) {
                list.reverse();
            }
        }
        for (key, value) in table.iter_mut() {
            let below = match path {
                "" => key.clone(),
                "beam" => "beam.*".to_owned(),
                "stage" if key == "analysis" => key.clone(),
                _ => format!("{path}.{key}"),
            };
            self.value(&below, value);
        }
    }

    fn value(&self, path: &str, value: &mut Value) {
        let swapped = path == "effect.foundation.stiffness" && self.quarters % 2 == 1;
        if let (true, Value::Array(both)) = (swapped, &mut *value) {
            both.reverse();
        }
        match (nature(path), value) {
            // A formula with its kinks is a table of both.
            (Some(Nature::OfTime) | None, Value::Table(table)) => self.table(path, table),
            (Some(nature), value) => self.quantity(nature, value),
            (None, Value::Array(list)) => list.iter_mut().for_each(|item| self.value(path, item)),
            (None, _) => {}
        }
    }

    fn quantity(&self, nature: Nature, value: &mut Value) {
        match (nature, value) {
            (Nature::Scalar(d), Value::Float(v)) => *v *= self.unit(d),
            (Nature::Turning(d), Value::Float(v)) => *v *= self.sign() * self.unit(d),
            (Nature::Polar, Value::Float(v)) => *v = self.angle() + self.sign() * *v,
            (Nature::Vector(d), value) => {
                if let Some(v) = vector(value) {
                    *value = list(self.direction(v).map(|v| v * self.unit(d)));
                } else if let Value::Array(both) = value
                    && let [Value::Table(x), Value::Table(y)] = &mut both[..]
                {
                    self.vector_along(x, y, d);
                }
            }
            (Nature::Point, value) => {
                if let Some(p) = vector(value) {
                    *value = list(self.point(p));
                } else if let Value::Array(points) = value {
                    points.iter_mut().for_each(|point| self.quantity(Nature::Point, point));
                }
            }
            (Nature::Polynomial, Value::Array(coefficients)) => {
                for (power, c) in (0..).zip(coefficients) {
                    self.quantity(Nature::Scalar([0, 0, -power]), c);
                }
            }
            (Nature::Root(d), Value::Float(v)) => *v *= self.unit(d).sqrt(),
            (Nature::OfTime, Value::String(text)) => {
                *text = formula::with(text, &[("t", formula::scaled("t", 1.0 / self.units[2]))]);
            }
            (Nature::OfPlace(d), Value::String(text)) => {
                *text = formula::scaled(&format!("({})", self.of_place(text)), self.unit(d));
            }
            (Nature::VectorOfPlace(d), Value::Array(both)) => self.vector_of_place(both, d),
            (Nature::Scalar(_) | Nature::Turning(_), Value::Table(table)) => self.along(nature, table),
            (nature, Value::Array(items)) => items.iter_mut().for_each(|item| self.quantity(nature, item)),
            _ => {}
        }
    }

    /// A formula of the natural place and time as one of the coordinates of the scene.
    fn of_place(&self, text: &str) -> String {
        let origin = self.point_back([0.0; 2]);
        let [x, y] = [self.point_back([1.0, 0.0]), self.point_back([0.0, 1.0])];
        let [x, y] = [0, 1].map(|axis: usize| {
            let slopes = [x[axis] - origin[axis], y[axis] - origin[axis]];
            formula::sum(&[(slopes[0], "x"), (slopes[1], "y"), (origin[axis], "1")])
        });
        let t = formula::scaled("t", 1.0 / self.units[2]);
        formula::with(text, &[("x", x), ("y", y), ("t", t)])
    }

    /// Turns a force that formulas tell.
    fn vector_of_place(&self, both: &mut [Value], dimension: Dimension) {
        let [Value::String(x), Value::String(y)] = both else { return };
        let of = [self.of_place(x), self.of_place(y)].map(|text| format!("({text})"));
        let columns = [self.direction([1.0, 0.0]), self.direction([0.0, 1.0])];
        let unit = self.unit(dimension);
        for (axis, text) in [x, y].into_iter().enumerate() {
            *text = formula::sum(&[(unit * columns[0][axis], &of[0]), (unit * columns[1][axis], &of[1])]);
        }
    }

    /// Converts a quantity that varies along a beam. Coefficients of 1, s, s², … have a dimension
    /// each.
    fn along(&self, nature: Nature, table: &mut Table) {
        let length = Nature::Scalar([1, 0, 0]);
        for (kind, value) in table.iter_mut() {
            if let ("polynomial", Value::Array(coefficients)) = (kind.as_str(), &mut *value) {
                for (power, c) in (0..).zip(coefficients) {
                    let lower = |[d, m, t]: Dimension| [d - power, m, t];
                    let of_power = match nature {
                        Nature::Scalar(d) => Nature::Scalar(lower(d)),
                        Nature::Turning(d) => Nature::Turning(lower(d)),
                        other => other,
                    };
                    self.quantity(of_power, c);
                }
            }
            for (key, list) in value.as_table_mut().into_iter().flatten() {
                self.quantity(if key == "value" { nature } else { length }, list);
            }
        }
    }

    /// Converts a vector that varies along a beam, of which both components are given at the same
    /// places.
    fn vector_along(&self, x: &mut Table, y: &mut Table, dimension: Dimension) {
        let (of_powers, length) = (x.contains_key("polynomial"), Nature::Scalar([1, 0, 0]));
        for table in [&mut *x, &mut *y] {
            for (key, places) in table.iter_mut().filter_map(|(_, below)| below.as_table_mut()).flatten() {
                if key != "value" {
                    self.quantity(length, places);
                }
            }
        }
        for (xs, ys) in values_along(x).zip(values_along(y)) {
            for (power, (x, y)) in (0..).zip(xs.iter_mut().zip(ys)) {
                let (Value::Float(a), Value::Float(b)) = (&*x, &*y) else { continue };
                let lower = if of_powers { power } else { 0 };
                let [of_length, mass, time] = dimension;
                let unit = self.unit([of_length - lower, mass, time]);
                let turned = self.direction([*a, *b]).map(|v| Value::Float(v * unit));
                [*x, *y] = turned;
            }
        }
    }

    /// Writes out defaults that would mean something else in this frame.
    fn complete(&self, path: &str, table: &mut Table) {
        let absent = match path {
            "effect.contact.box" => Some(("angle", Value::Float(0.0))),
            "initial_velocity" if table.contains_key("rotation") => Some(("about", list([0.0; 2]))),
            _ => None,
        };
        if let Some((key, value)) = absent {
            table.entry(key).or_insert(value);
        }
    }

    /// Converts a pair of keys for the two axes. Coefficients of 1, s, s², … have a dimension each.
    fn components(
        &self,
        path: &str,
        table: &mut Table,
        (keys, dimension, places): ([&str; 2], Dimension, bool),
    ) {
        let along = |power: i32| if path.ends_with("polynomial") { power } else { 0 };
        let both = keys.map(|key| table.remove(key));
        if both.iter().all(Option::is_none) {
            return;
        }
        if places {
            self.crossing(table, keys, both);
            return;
        }
        let columns = both.each_ref().map(|v| v.as_ref().map_or(Vec::new(), floats));
        let single = both.iter().flatten().any(Value::is_float);
        let n = columns[0].len().max(columns[1].len());
        let turned: Vec<[f64; 2]> = (0..n)
            .map(|i| {
                let v = [0, 1].map(|axis: usize| columns[axis].get(i).copied().unwrap_or(0.0));
                let [mut d, m, t] = dimension;
                d -= along(i as i32);
                self.direction(v).map(|v| v * self.unit([d, m, t]))
            })
            .collect();
        for (axis, key) in keys.into_iter().enumerate() {
            if turned.iter().all(|v| v[axis] == 0.0) && !turned.iter().all(|v| v[1 - axis] == 0.0) {
                continue;
            }
            let mut column = turned.iter().map(|v| Value::Float(v[axis]));
            let value = if single { column.next_back() } else { Some(Value::Array(column.collect())) };
            table.extend(value.map(|value| (key.to_owned(), value)));
        }
    }

    /// Converts a coordinate that is to be reached: it may become one of the other axis, reached
    /// from the other side.
    fn crossing(&self, table: &mut Table, keys: [&str; 2], [x, y]: [Option<Value>; 2]) {
        let (axis, value) = if let Some(x) = x { (0, x) } else { (1, y.unwrap_or(Value::Float(0.0))) };
        let Value::Float(value) = value else { return };
        let mut place = [0.0; 2];
        place[axis] = 1.0;
        let turned = self.direction(place);
        let axis = usize::from(turned[1].abs() > 0.5);
        let place = if keys == ["vx", "vy"] {
            self.unit([1, 0, -1]) * turned[axis] * value
        } else {
            self.units[0] * (turned[axis] * value + self.shift[axis])
        };
        table.insert(keys[axis].to_owned(), Value::Float(place));
        if turned[axis] < 0.0 {
            exchange(table, "crossing", ["rising", "falling"]);
        }
    }

    /// Converts what an event watches.
    fn event(&self, event: &mut Table) {
        for keys in [["x", "y"], ["vx", "vy"]] {
            let both = keys.map(|key| event.remove(key));
            if both.iter().any(Option::is_some) {
                self.crossing(event, keys, both);
            }
        }
        let mut flips = false;
        for (key, value) in event.iter_mut() {
            let (Some((dimension, turns)), Value::Float(value)) = (watched(key), value) else { continue };
            if key == "angle" {
                let turned = self.angle() + self.sign() * *value;
                *value = turned.sin().atan2(turned.cos());
            } else {
                *value *= self.unit(dimension) * if turns { self.sign() } else { 1.0 };
            }
            flips |= turns && self.mirrored;
        }
        if flips {
            exchange(event, "crossing", ["rising", "falling"]);
        }
        if self.mirrored {
            rename(event, ["stress_bottom", "stress_top"]);
        }
        let mut turns_back = false;
        for key in ["maximum", "minimum"] {
            let Some(Value::String(name)) = event.get_mut(key) else { continue };
            for axes in [["x", "y"], ["vx", "vy"]] {
                if let Some(axis) = axes.iter().position(|axis| *axis == name.as_str()) {
                    let mut place = [0.0; 2];
                    place[axis] = 1.0;
                    let turned = self.direction(place);
                    let axis = usize::from(turned[1].abs() > 0.5);
                    *name = axes[axis].to_owned();
                    turns_back = turned[axis] < 0.0;
                    break;
                }
            }
            turns_back |= self.mirrored && watched(name).is_some_and(|(_, turns)| turns);
            if self.mirrored {
                exchange(event, key, ["stress_bottom", "stress_top"]);
            }
        }
        if turns_back {
            rename(event, ["maximum", "minimum"]);
        }
    }

    /// Exchanges the names of fixed components where the axes are exchanged.
    fn fixed(&self, support: &mut Table) {
        let Some(Value::Array(names)) = support.get_mut("fix") else { return };
        if self.quarters.is_multiple_of(2) {
            return;
        }
        for name in names {
            *name = match name.as_str() {
                Some("x") => Value::from("y"),
                Some("y") => Value::from("x"),
                _ => continue,
            };
        }
    }
}

/// Replaces one of two words by the other.
fn exchange(table: &mut Table, key: &str, words: [&str; 2]) {
    if let Some(Value::String(word)) = table.get_mut(key)
        && let Some(found) = words.iter().position(|other| *other == word.as_str())
    {
        *word = words[1 - found].to_owned();
    }
}

/// Exchanges two keys.
fn rename(table: &mut Table, keys: [&str; 2]) {
    let values = keys.map(|key| table.remove(key));
    for (key, value) in keys.into_iter().rev().zip(values) {
        table.extend(value.map(|value| (key.to_owned(), value)));
    }
}

/// Whether a scene has settings along one axis, so that only quarter turns leave it what it is.
pub fn has_axes(scene: &Table) -> bool {
    let ends = |analysis: &Table| {
        settings::names(analysis, &["dynamic", "event"])
            || settings::get(analysis, &["static", "arc_length", "until_probe"]).is_some()
    };
    let lists = |path: &[&str]| {
        let mut value = Some(scene);
        for key in &path[..path.len() - 1] {
            value = value.and_then(|table| table.get(*key)).and_then(Value::as_table);
        }
        value.and_then(|table| table.get(path[path.len() - 1])).cloned()
    };
    let items = |path: &[&str]| match lists(path) {
        Some(Value::Array(items)) => items,
        _ => Vec::new(),
    };
    let one_axis = |support: &Value| {
        let names = support.get("fix").and_then(Value::as_array).cloned().unwrap_or_default();
        let held = ["x", "y"].map(|axis| names.iter().any(|name| name.as_str() == Some(axis)));
        held[0] != held[1]
    };
    let uneven =
        |foundation: &Value| foundation.get("stiffness").and_then(vector).is_none_or(|[x, y]| x != y);
    items(&["support"]).iter().any(one_axis)
        || items(&["effect", "foundation"]).iter().any(uneven)
        || settings::analyses(scene).any(ends)
}

/// Two floats.
pub fn vector(value: &Value) -> Option<[f64; 2]> {
    match value.as_array()?.as_slice() {
        [x, y] => Some([x.as_float()?, y.as_float()?]),
        _ => None,
    }
}

/// The lists of values, or of coefficients, of a quantity that varies along a beam.
pub fn values_along(quantity: &mut Table) -> impl Iterator<Item = &mut Vec<Value>> {
    quantity.iter_mut().filter_map(|(_, below)| match below {
        Value::Array(coefficients) => Some(coefficients),
        below => below.get_mut("value")?.as_array_mut(),
    })
}

/// A list of numbers.
pub fn list<const N: usize>(numbers: [f64; N]) -> Value {
    Value::Array(numbers.into_iter().map(Value::Float).collect())
}

/// All numbers of a value, in order.
fn floats(value: &Value) -> Vec<f64> {
    match value {
        Value::Float(v) => vec![*v],
        Value::Array(items) => items.iter().flat_map(floats).collect(),
        _ => Vec::new(),
    }
}
