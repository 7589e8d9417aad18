//! Beams: shapes, sections, discretisations, and how they are joined.

use std::f64::consts::PI;

use ancf::centreline::Curve;
use ancf::model::Centreline;
use toml::{Table, Value};

use super::super::frame::list;
use super::super::settings;
use super::{Draw, Drawn, Kind, numbers, round};

impl Draw<'_> {
    pub(super) fn beams(&mut self) {
        let count = match self.rng.u8(0..10) {
            0..6 => 1,
            6..9 => 2,
            _ => 3,
        };
        let names = ["a", "b", "c"];
        let axial = self.axial();
        let mut beams = Table::new();
        let alike = self.chance(0.5);
        let mut first: Option<Table> = None;
        for name in names.iter().take(count) {
            let table = self.beam(name, axial, if alike { first.clone() } else { None }, count);
            first.get_or_insert_with(|| table.clone());
            beams.insert((*name).to_owned(), table.into());
        }
        self.scene.insert("beam".into(), beams.into());
    }

    /// Draws EA L²/EI; none for an inextensible beam.
    fn axial(&mut self) -> Option<f64> {
        match self.rng.u8(0..20) {
            0..3 => None,
            3..12 => Some(self.log(1e3, 1e6)),
            _ => Some(self.log(1e1, 1e10)),
        }
    }

    fn beam(&mut self, name: &str, axial: Option<f64>, like: Option<Table>, count: usize) -> Table {
        let (geometry, centreline) = self.geometry(count);
        // The reader, too, refuses points that double back; a straight beam takes their place.
        let (geometry, centreline, curve) = match Curve::new(&centreline) {
            Ok(curve) => (geometry, centreline, curve),
            Err(_) => self.fallback(),
        };
        let length = curve.length();
        let straight = matches!(centreline, Centreline::Line { .. });
        let bends = like.as_ref().map_or_else(
            // No path by arc length leads away from a string without a load.
            || axial.is_none() || self.kind == Kind::ArcLength || !self.chance(0.08),
            settings::bends,
        );
        let mut table = geometry;
        if let Some(like) = like {
            let same = like.into_iter().filter(|(key, _)| {
                !matches!(key.as_str(), "start" | "end" | "arc" | "points" | "initial_shape")
            });
            table.extend(same);
            let ratio = length / self.beams[0].length;
            let quantities = table.iter_mut().filter(|(key, _)| !matches!(key.as_str(), "arc" | "basis"));
            quantities.into_iter().for_each(|(_, value)| scale_places(value, ratio));
            if let Some(Value::Table(basis)) = table.get_mut("basis") {
                for (_, kind) in basis.iter_mut() {
                    scale_nodes(kind, length);
                }
            }
        } else {
            self.section(&mut table, axial, bends);
            self.variation(&mut table, length);
            let basis = self.basis(length, count);
            table.insert("basis".into(), basis.into());
        }
        let starts = if count == 1 { self.initial_shape(&mut table, &curve, axial) } else { None };
        let starts = starts.unwrap_or_else(|| curve.clone());
        let by_law = ["axial_law", "bending_law"].iter().any(|key| table.contains_key(*key));
        let shaped = table.contains_key("section");
        let layered = settings::get(&table, &["section", "layers"]).is_some();
        self.beams.push(Drawn {
            name: name.to_owned(),
            curve,
            starts,
            straight,
            length,
            axial,
            bends,
            by_law,
            shaped,
            layered,
        });
        table
    }

    /// Lets a beam begin in another shape than the stress-free one, sometimes.
    fn initial_shape(&mut self, table: &mut Table, curve: &Curve, axial: Option<f64>) -> Option<Curve> {
        if !matches!(self.kind, Kind::Static | Kind::Dynamic | Kind::Equilibrium) || !self.chance(0.12) {
            return None;
        }
        let (origin, [tx, ty]) = (curve.position(0.0), curve.tangent(0.0));
        let soft = axial.is_some_and(|axial| axial < 1e5);
        let stretch = if soft && self.chance(0.5) { self.even(-0.01, 0.01) } else { 0.0 };
        let length = curve.length() * (1.0 + stretch);
        let heading = ty.atan2(tx) + if self.chance(0.5) { 0.0 } else { self.even(-0.6, 0.6) };
        let kind = match self.rng.u8(0..if axial.is_some() { 6 } else { 5 }) {
            0..2 => "line",
            2..5 => "arc",
            _ => "points",
        };
        let (value, centreline): (Value, Centreline) = match kind {
            "line" => {
                let end = [origin[0] + length * heading.cos(), origin[1] + length * heading.sin()];
                let mut line = Table::new();
                line.insert("start".into(), list(origin));
                line.insert("end".into(), list(end));
                (line.into(), Centreline::Line { start: origin, end })
            }
            "arc" => {
                let (table, centreline) = self.arc(origin, heading, length, 3.0);
                (table.into(), centreline)
            }
            _ => {
                let n = self.rng.usize(2..5);
                let mut points = vec![origin];
                for i in 1..=n {
                    let (along, off) = (length * i as f64 / n as f64, length * self.even(-0.04, 0.04));
                    let (sine, cosine) = heading.sin_cos();
                    points.push([
                        round(origin[0] + along * cosine - off * sine, 6),
                        round(origin[1] + along * sine + off * cosine, 6),
                    ]);
                }
                let value = Value::Array(points.iter().map(|p| list(*p)).collect());
                (value, Centreline::Points(points))
            }
        };
        let starts = Curve::new(&centreline).ok()?;
        let mut shape = Table::new();
        shape.insert(kind.into(), value);
        table.insert("initial_shape".into(), shape.into());
        Some(starts)
    }

    /// An arc from a point in a direction, by an angle of at most `most`.
    fn arc(&mut self, origin: [f64; 2], heading: f64, length: f64, most: f64) -> (Table, Centreline) {
        let angle = self.signed(0.1, most);
        let radius = length / angle.abs();
        let (sine, cosine) = heading.sin_cos();
        let off = radius * angle.signum();
        let center = [origin[0] - off * sine, origin[1] + off * cosine];
        let from = heading - 0.5 * PI * angle.signum();
        let to = from + angle;
        let mut arc = Table::new();
        arc.insert("center".into(), list(center));
        for (key, value) in [("radius", radius), ("from", from), ("to", to)] {
            arc.insert(key.into(), value.into());
        }
        (arc, Centreline::Arc { center, radius, from, to })
    }

    fn fallback(&mut self) -> (Table, Centreline, Curve) {
        let line = Centreline::Line { start: [0.0; 2], end: [1.0, 0.0] };
        let mut table = Table::new();
        table.insert("start".into(), list([0.0; 2]));
        table.insert("end".into(), list([1.0, 0.0]));
        match Curve::new(&line) {
            Ok(curve) => (table, line, curve),
            Err(_) => self.fallback(),
        }
    }

    /// A shape, which begins where the last beam ends, or in the middle of it, if there is one.
    fn geometry(&mut self, count: usize) -> (Table, Centreline) {
        let mut origin = [0.0; 2];
        let mut heading = 0.0;
        if let Some(last) = self.beams.len().checked_sub(1) {
            let (from, joint) = self.joint(last);
            origin = self.beams[last].curve.position(from);
            let tangent = self.beams[last].curve.tangent(from);
            heading = tangent[1].atan2(tangent[0]);
            if joint {
                heading += if self.chance(0.3) { 0.0 } else { self.even(-2.4, 2.4) };
            }
        } else if self.chance(0.5) {
            heading = self.even(-PI, PI);
        }
        let length = if count == 1 { self.pick(&[1.0, 1.0, 0.8]) } else { self.even(0.4, 1.0) };
        let mut table = Table::new();
        let at = |t: f64, n: f64| {
            let (sine, cosine) = heading.sin_cos();
            [origin[0] + t * cosine - n * sine, origin[1] + t * sine + n * cosine]
        };
        match self.rng.u8(0..10) {
            0..6 => {
                let end = at(length, 0.0).map(|v| round(v, 12));
                table.insert("start".into(), list(origin));
                table.insert("end".into(), list(end));
                (table, Centreline::Line { start: origin, end })
            }
            6..8 => {
                let (arc, centreline) = self.arc(origin, heading, length, 4.0);
                table.insert("arc".into(), arc.into());
                (table, centreline)
            }
            _ => {
                let n = self.rng.usize(2..5);
                let mut points = vec![origin];
                for i in 1..=n {
                    let off = length * self.even(-0.2, 0.2);
                    points.push(at(length * i as f64 / n as f64, off).map(|v| round(v, 6)));
                }
                table.insert("points".into(), Value::Array(points.iter().map(|p| list(*p)).collect()));
                (table, Centreline::Points(points))
            }
        }
    }

    /// Joins the next beam to beam `last`. Returns the arc length of the joint on that beam, and
    /// whether it is other than a weld along the tangent.
    fn joint(&mut self, last: usize) -> (f64, bool) {
        let drawn = &self.beams[last];
        let (name, length, straight, bends) = (drawn.name.clone(), drawn.length, drawn.straight, drawn.bends);
        let next = ["a", "b", "c"][last + 1];
        // Where a curved beam is between its nodes only the solver knows.
        let middle = straight && self.chance(0.15);
        let (at, s): (Value, f64) =
            if middle { ((0.5 * length).into(), 0.5 * length) } else { ("end".into(), length) };
        // A string cannot keep a direction.
        let kind = if self.chance(0.6) && bends { "weld" } else { "hinge" };
        let point = |beam: &str, at: Value| {
            let mut point = Table::new();
            point.insert("beam".into(), beam.into());
            point.insert("at".into(), at);
            Value::Table(point)
        };
        let mut joint = Table::new();
        joint.insert("type".into(), kind.into());
        joint.insert("first".into(), point(&name, at));
        joint.insert("second".into(), point(next, "start".into()));
        self.push(&["joint"], joint);
        (s, true)
    }

    fn section(&mut self, table: &mut Table, axial: Option<f64>, bends: bool) {
        let bending = if self.chance(0.6) { 1.0 } else { self.log(0.3, 3.0) };
        let mass = if self.chance(0.6) { 1.0 } else { self.log(0.3, 3.0) };
        if self.chance(0.4) {
            table.insert("strain".into(), self.pick(&["green", "engineering"]).into());
        }
        if let Some(axial) = axial.filter(|axial| bends && *axial >= 100.0)
            && self.chance(0.16)
        {
            return self.shape(table, [axial, bending, mass]);
        }
        let mut put = |key: &str, value: f64| {
            table.insert(key.into(), value.into());
        };
        match axial {
            // By the material: EA/EI = A/I.
            Some(axial) if self.chance(0.25) => {
                let area = self.log(1e-4, 1e-2);
                put("area", area);
                put("youngs_modulus", axial / area);
                if bends {
                    put("second_moment", bending * area / axial);
                }
                put("density", mass / area);
            }
            _ => {
                put("mass_per_length", mass);
                if let Some(axial) = axial {
                    if self.chance(0.06) {
                        let law = self.elastic(["strain", "force"], axial, [1e-3, 0.1, 0.6]);
                        table.insert("axial_law".into(), law.into());
                    } else {
                        table.insert("axial_stiffness".into(), axial.into());
                    }
                }
                if bends && self.chance(0.06) {
                    let law = self.elastic(["curvature", "moment"], bending, [0.1, 5.0, 100.0]);
                    table.insert("bending_law".into(), law.into());
                } else if bends {
                    table.insert("bending_stiffness".into(), bending.into());
                }
            }
        }
    }

    /// An elastic law with about this stiffness, with corners between `low` and `high`, and an end.
    fn elastic(&mut self, keys: [&str; 2], stiffness: f64, [low, high, end]: [f64; 3]) -> Table {
        // What takes no pressure, or has play.
        let slack = self.chance(0.1);
        let mut side = |slack: bool| {
            let corner = self.log(low, high);
            let first = if slack { 0.0 } else { stiffness * self.even(0.7, 1.3) };
            let force = corner * first;
            [(corner, force), (end, force + (end - corner) * first.max(stiffness) * self.log(0.3, 3.0))]
        };
        let [plus, minus] = [side(false), side(slack)];
        let points = [(-minus[1].0, -minus[1].1), (-minus[0].0, -minus[0].1), (0.0, 0.0), plus[0], plus[1]];
        let mut law = Table::new();
        law.insert(keys[0].into(), list(points.map(|(x, _)| x)));
        law.insert(keys[1].into(), list(points.map(|(_, y)| y + 0.0)));
        law
    }

    /// A shape of the section with about this EA, EI and ρA.
    fn shape(&mut self, table: &mut Table, [axial, bending, mass]: [f64; 3]) {
        let square = bending / axial;
        let mut put = |key: &str, value: Value| table.insert(key.into(), value);
        let of = |pairs: &[(&str, f64)]| -> Table {
            pairs.iter().map(|(key, value)| ((*key).to_owned(), Value::from(*value))).collect()
        };
        // EI/EA is h²/12 of a rectangle, d²/16 of a circle, (d² + b²)/16 of a tube with the bore b.
        let (kind, shape, area): (&str, Value, f64) = match self.rng.u8(0..5) {
            0 => {
                let height = (12.0 * square).sqrt();
                let width = height * self.log(0.5, 5.0);
                ("rectangle", of(&[("width", width), ("height", height)]).into(), width * height)
            }
            1 => {
                let diameter = 4.0 * square.sqrt();
                ("circle", of(&[("diameter", diameter)]).into(), 0.25 * PI * diameter * diameter)
            }
            2 => {
                let diameter = (16.0 * square / 1.36).sqrt();
                let tube = of(&[("diameter", diameter), ("wall", 0.2 * diameter)]);
                ("tube", tube.into(), 0.25 * PI * 0.64 * diameter * diameter)
            }
            _ => {
                let height = (12.0 * square).sqrt();
                let (lower, off) = (height * self.even(0.2, 0.8), height * self.even(-0.3, 0.3));
                let (modulus, density) = (axial / (height * height), mass / (height * height));
                let stiffer = self.log(0.3, 3.0);
                let offsets = self.chance(0.4);
                let layer = |factor: f64, thick: f64, middle: f64| {
                    let mut layer = of(&[("width", height), ("height", thick)]);
                    layer.insert("youngs_modulus".into(), (factor * modulus).into());
                    layer.insert("density".into(), density.into());
                    if offsets {
                        layer.insert("offset".into(), (middle + off).into());
                    }
                    Value::from(layer)
                };
                let upper = height - lower;
                let layers = vec![layer(1.0, lower, -0.5 * upper), layer(stiffer, upper, 0.5 * lower)];
                ("layers", Value::Array(layers), 0.0)
            }
        };
        if area > 0.0 {
            put("youngs_modulus", (axial / area).into());
            put("density", (mass / area).into());
        }
        let mut section = Table::new();
        section.insert(kind.into(), shape);
        put("section", section.into());
    }

    /// Lets some of the beam's quantities vary along it.
    fn variation(&mut self, table: &mut Table, length: f64) {
        let share = if table.contains_key("section") { 0.5 } else { 0.12 };
        if !self.chance(share) {
            return;
        }
        let keys = [
            "axial_stiffness",
            "bending_stiffness",
            "mass_per_length",
            "youngs_modulus",
            "area",
            "second_moment",
            "density",
        ];
        for key in keys {
            if let Some(value) = table.get_mut(key)
                && self.chance(0.6)
            {
                self.vary(value, length);
            }
        }
        if let Some(Value::Table(section)) = table.get_mut("section") {
            for (_, shape) in section.iter_mut() {
                let shapes = match shape {
                    Value::Array(layers) => layers.iter_mut().collect(),
                    one => vec![one],
                };
                for shape in shapes.into_iter().filter_map(Value::as_table_mut) {
                    for (_, value) in shape.iter_mut() {
                        if self.chance(0.4) {
                            self.vary(value, length);
                        }
                    }
                }
            }
        }
    }

    /// Makes a number one that varies along a beam, by a factor of two at most.
    pub(super) fn vary(&mut self, value: &mut Value, length: f64) {
        let Value::Float(v) = *value else { return };
        let mut varying = Table::new();
        let mut factor = || v * self.even(0.75, 1.3);
        let (a, b, c) = (factor(), factor(), factor());
        let middle = round(length * self.even(0.2, 0.8), 6);
        match self.rng.u8(0..4) {
            0 => {
                let mut places = Table::new();
                places.insert("s".into(), numbers(&[0.0, middle, length]));
                places.insert("value".into(), numbers(&[a, b, c]));
                varying.insert("table".into(), places.into());
            }
            1..3 => {
                varying.insert(
                    "polynomial".into(),
                    numbers(&[a, 0.3 * (b - v) / length, 0.3 * (c - v) / length.powi(2)]),
                );
            }
            _ => {
                let mut pieces = Table::new();
                pieces.insert("until".into(), numbers(&[middle]));
                pieces.insert("value".into(), numbers(&[a, b]));
                varying.insert("pieces".into(), pieces.into());
            }
        }
        *value = varying.into();
    }

    fn basis(&mut self, length: f64, count: usize) -> Table {
        let most = if count == 1 { 24 } else { 12 };
        let mut table = Table::new();
        let mut basis = Table::new();
        let ancf = self.chance(0.55);
        let cells = if ancf { self.rng.usize(2..most) } else { self.rng.usize(4..most) };
        let gauss = self.chance(0.12);
        let spacing = self.chance(0.15).then(|| self.pick(&["uniform", "chebyshev"]));
        if ancf && self.chance(0.6) {
            table.insert("elements".into(), (cells as i64).into());
        } else if self.chance(0.15) {
            table.insert("nodes".into(), self.places(length, cells));
        } else {
            table.insert("nodes".into(), (cells as i64 + 1).into());
        }
        if let (Some(spacing), false) = (spacing, table.get("nodes").is_some_and(Value::is_array)) {
            table.insert("spacing".into(), spacing.into());
        }
        if gauss {
            let mut points = Table::new();
            let lobatto = self.rng.bool();
            let (low, high) = if ancf { (3, 6) } else { (4, 7) };
            points.insert("stretch".into(), self.rng.i64(low..high).into());
            points.insert("bend".into(), self.rng.i64(if ancf { 2 } else { 4 }..high).into());
            if lobatto {
                points.insert("stretch_rule".into(), self.pick(&["lobatto", "lobatto", "gauss"]).into());
            }
            table.insert("gauss_points".into(), points.into());
        }
        if !ancf {
            self.rpim(&mut table);
        }
        basis.insert(if ancf { "ancf" } else { "rpim" }.into(), table.into());
        basis
    }

    /// Uneven nodes.
    fn places(&mut self, length: f64, cells: usize) -> Value {
        let mut weights: Vec<f64> = (0..cells).map(|_| self.even(0.6, 1.4)).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|w| *w *= length / sum);
        let mut s = 0.0;
        let mut places = vec![Value::Float(0.0)];
        for w in &weights[..cells - 1] {
            s += w;
            places.push(Value::Float(s));
        }
        places.push(Value::Float(length));
        Value::Array(places)
    }

    fn rpim(&mut self, table: &mut Table) {
        if self.chance(0.2) {
            let (kind, keys): (&str, Vec<(&str, f64)>) = match self.rng.u8(0..4) {
                0 => ("multiquadric", vec![("q", self.pick(&[0.98, 1.03])), ("shape", self.even(2.0, 6.0))]),
                1 => ("exponential", vec![("shape", self.log(0.02, 0.2))]),
                2 => ("thin_plate_spline", vec![("exponent", self.pick(&[5.0, 6.0, 7.0]))]),
                _ => ("wendland", vec![("radius", self.even(6.0, 12.0))]),
            };
            let mut function = Table::new();
            function.extend(keys.into_iter().map(|(key, value)| (key.to_owned(), Value::Float(value))));
            let mut kernel = Table::new();
            kernel.insert(kind.into(), function.into());
            table.insert("kernel".into(), kernel.into());
        }
        if self.chance(0.08) {
            table.insert("polynomial_terms".into(), self.rng.i64(1..5).into());
        }
        if self.chance(0.08) {
            table.insert("side_condition".into(), self.pick(&["plus", "minus"]).into());
        }
        if self.chance(0.08) {
            table.insert("neighbours".into(), self.rng.i64(1..4).into());
        }
    }
}

/// Given nodes of one beam on a beam of another length.
/// Stretches what varies along a beam to one that is longer by `ratio`.
fn scale_places(value: &mut Value, ratio: f64) {
    match value {
        Value::Table(table) => {
            for (key, below) in table.iter_mut() {
                let power = match key.as_str() {
                    "s" | "until" => |_: i32| 1,
                    "polynomial" => |term: i32| -term,
                    _ => {
                        scale_places(below, ratio);
                        continue;
                    }
                };
                for (term, number) in (0..).zip(below.as_array_mut().into_iter().flatten()) {
                    if let Value::Float(number) = number {
                        *number *= ratio.powi(power(term));
                    }
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| scale_places(item, ratio)),
        _ => {}
    }
}

fn scale_nodes(kind: &mut Value, length: f64) {
    let Some(Value::Array(places)) = kind.get_mut("nodes") else { return };
    let old = places.last().and_then(Value::as_float).unwrap_or(1.0);
    for place in places.iter_mut() {
        if let Value::Float(s) = place {
            *s *= length / old;
        }
    }
}
