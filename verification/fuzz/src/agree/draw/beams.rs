//! Beams: shapes, sections, discretisations, and how they are joined.

use std::f64::consts::PI;

use ancf::centreline::Curve;
use ancf::model::Centreline;
use toml::{Table, Value};

use super::super::frame::list;
use super::{Draw, Drawn, Kind, round};

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
            |like| like.contains_key("bending_stiffness") || like.contains_key("second_moment"),
        );
        let mut table = geometry;
        if let Some(like) = like {
            let same = like
                .into_iter()
                .filter(|(key, _)| !matches!(key.as_str(), "start" | "end" | "arc" | "points"));
            table.extend(same);
            if let Some(Value::Table(basis)) = table.get_mut("basis") {
                for (_, kind) in basis.iter_mut() {
                    scale_nodes(kind, length);
                }
            }
        } else {
            self.section(&mut table, axial, bends);
            let basis = self.basis(length, count);
            table.insert("basis".into(), basis.into());
        }
        self.beams.push(Drawn { name: name.to_owned(), curve, straight, length, axial, bends });
        table
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
                let angle = self.signed(0.1, 4.0);
                let radius = length / angle.abs();
                let center = at(0.0, radius * angle.signum());
                let from = heading - 0.5 * PI * angle.signum();
                let to = from + angle;
                let mut arc = Table::new();
                arc.insert("center".into(), list(center));
                for (key, value) in [("radius", radius), ("from", from), ("to", to)] {
                    arc.insert(key.into(), value.into());
                }
                table.insert("arc".into(), arc.into());
                (table, Centreline::Arc { center, radius, from, to })
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
                if let Some(axial) = axial {
                    put("axial_stiffness", axial);
                }
                if bends {
                    put("bending_stiffness", bending);
                }
                put("mass_per_length", mass);
            }
        }
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
fn scale_nodes(kind: &mut Value, length: f64) {
    let Some(Value::Array(places)) = kind.get_mut("nodes") else { return };
    let old = places.last().and_then(Value::as_float).unwrap_or(1.0);
    for place in places.iter_mut() {
        if let Value::Float(s) = place {
            *s *= length / old;
        }
    }
}
