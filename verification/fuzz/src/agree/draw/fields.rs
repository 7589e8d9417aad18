//! Forces that depend on the place: of electrodes, and by formulas.

use toml::{Table, Value};

use super::super::formula::{self, number};
use super::super::frame::list;
use super::{Draw, Kind, round};

/// The permittivity of the vacuum \[F/m\].
const VACUUM: f64 = 8.854_187_812_8e-12;

impl Draw<'_> {
    /// An electrode in front of a beam, mostly too weak to pull it in.
    pub(super) fn electrostatic(&mut self) {
        if self.kind == Kind::Buckling || !self.chance(0.08) {
            return;
        }
        let (beam, mut table) = self.of_beam();
        let starts = self.beams[beam].starts.clone();
        let middle = starts.tangent(0.5 * starts.length());
        let off = if self.chance(0.6) { 0.0 } else { self.even(-0.5, 0.5) };
        let angle = middle[1].atan2(middle[0])
            + off
            + if self.rng.bool() { 0.5 } else { -0.5 } * std::f64::consts::PI;
        let normal = [round(angle.cos(), 6), round(angle.sin(), 6)];
        let height = |s: f64| {
            let [x, y] = starts.position(s);
            normal[0] * x + normal[1] * y
        };
        let lowest = (0..=50).map(|i| height(starts.length() * f64::from(i) / 50.0)).fold(f64::MAX, f64::min);
        let thickness = if self.chance(0.6) { self.log(1e-3, 2e-2) } else { 0.0 };
        let gap = self.log(0.03, 0.5);
        let below = lowest - gap - thickness;
        let along = self.even(-0.5, 0.5);
        let point = [below * normal[0] - along * normal[1], below * normal[1] + along * normal[0]];
        let width = self.log(0.02, 0.5);
        let permittivity = if self.chance(0.5) { self.log(0.01, 10.0) } else { VACUUM };
        // By f = ½ ε w V²/g².
        let force = gap * self.log(0.02, 6.0);
        let voltage = (2.0 * force * gap * gap / (permittivity * width)).sqrt();
        table.insert("voltage".into(), round(voltage, 4).into());
        table.insert("width".into(), width.into());
        let mut electrode = Table::new();
        electrode.insert("point".into(), list(point));
        electrode.insert("normal".into(), list(normal));
        table.insert("electrode".into(), electrode.into());
        if permittivity != VACUUM {
            table.insert("permittivity".into(), permittivity.into());
        }
        if thickness > 0.0 {
            table.insert("half_thickness".into(), thickness.into());
        }
        if self.chance(0.5) {
            table.insert("fringe".into(), self.pick(&[0.65, 0.3]).into());
        }
        self.perhaps_in_time(&mut table, 0.4);
        self.perhaps_stretch(&mut table);
        self.push(&["effect", "electrostatic"], table);
    }

    /// A force by formulas.
    pub(super) fn force_field(&mut self, size: f64) {
        if self.kind == Kind::Buckling || !self.chance(0.08) {
            return;
        }
        let (_, mut table) = self.of_beam();
        let mut n = |low: f64, high: f64| number(self.signed(low, high));
        let (a, b) = (n(0.3 * size, 10.0 * size), n(0.3 * size, 10.0 * size));
        let (c, d, k) = (n(0.05, 1.0), n(0.05, 1.0), n(0.3, 5.0));
        let speed = n(0.3, 3.0);
        let wide = number(self.log(0.1, 2.0));
        // In a motion some fields travel.
        let travels = self.is_motion() && self.chance(0.3);
        let moved = |text: String| match travels {
            true => formula::with(&text, &[("x", format!("x-{speed}*t"))]),
            false => text,
        };
        if self.rng.bool() {
            let potential = match self.rng.u8(0..6) {
                0 => format!("{a}*(y-{c})^2+{b}*x"),
                1 => format!("{a}*x*y-{b}*y"),
                2 => format!("{a}*exp(-((x-{c})^2+(y-{d})^2)/{wide})"),
                3 => format!("{a}*sin({k}*x)*cos({c}+y)"),
                4 => format!("{a}*ln(1+x^2+y^2)+{b}*sqrt(1+(x-y)^2)"),
                _ => format!("-x^3*{a}/(1+x^2)-{b}*tanh(y/{wide})"),
            };
            table.insert("potential".into(), moved(potential).into());
        } else {
            let value = match self.rng.u8(0..5) {
                0 => [format!("-{a}*y"), format!("{a}*x")],
                1 => [format!("{a}*(x-{c})+{b}"), format!("-{wide}*y")],
                2 => [format!("{a}*tanh(y/{wide})"), "0".to_owned()],
                3 => [format!("{a}*sin({k}*y)"), format!("{b}*cos({k}*x)")],
                _ => [format!("{a}/(1+x^2)"), format!("{b}*exp(-y^2/{wide})+{a}*atan(x*y)")],
            };
            let value = value.into_iter().map(|text| Value::String(moved(text)));
            table.insert("value".into(), Value::Array(value.collect()));
        }
        self.perhaps_in_time(&mut table, 0.4);
        self.perhaps_stretch(&mut table);
        self.push(&["effect", "force_field"], table);
    }
}
