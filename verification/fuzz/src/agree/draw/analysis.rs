//! Analyses and their settings.

use toml::{Table, Value};

use super::super::settings;
use super::{Draw, Kind};

impl Draw<'_> {
    pub(super) fn analysis(&mut self) {
        let (key, table) = match self.kind {
            Kind::Static => ("static", self.statics()),
            Kind::ArcLength => {
                let mut table = Table::new();
                let path = self.path();
                table.insert("arc_length".into(), path.into());
                if self.chance(0.15) {
                    table.insert("tolerance".into(), self.pick(&[1e-6, 1e-8]).into());
                }
                ("static", table)
            }
            Kind::Dynamic => ("dynamic", self.dynamics()),
            Kind::Modal | Kind::Equilibrium => {
                let mut table = self.modes();
                if self.kind == Kind::Equilibrium {
                    table.insert("about".into(), "equilibrium".into());
                } else if self.chance(0.2) {
                    table.insert("about".into(), "reference".into());
                }
                ("modal", table)
            }
            Kind::Buckling => ("buckling", self.modes()),
        };
        let mut analysis = Table::new();
        analysis.insert(key.into(), table.into());
        self.scene.insert("analysis".into(), analysis.into());
    }

    /// Leaves everything open that an accuracy chooses, of all beams or of some.
    pub(super) fn accuracy(&mut self) {
        let wanted = self.pick(&[1e-2, 1e-3, 1e-4]);
        let Some(mut open) = settings::opened(&self.scene, wanted) else { return };
        let kind = settings::analysis(&open).to_owned();
        let moves = matches!(kind.as_str(), "static" | "dynamic");
        let (some, table) = (self.chance(0.3), moves && self.chance(0.5));
        let (curvature, forces) = (self.pick(&[0.1, 0.03]), self.pick(&[0.1, 0.03]));
        if some && let (Some(from), Some(to)) = (self.first_basis(), settings::table(&mut open, &["beam"])) {
            let (name, basis) = from;
            if let Some(beam) = to.get_mut(&name).and_then(Value::as_table_mut) {
                beam.insert("basis".into(), basis);
            }
        }
        if table && let Some(analysis) = settings::table(&mut open, &["analysis", &kind]) {
            let mut errors = Table::new();
            errors.insert("position".into(), wanted.into());
            errors.insert("curvature".into(), curvature.into());
            errors.insert("section_force".into(), forces.into());
            analysis.insert("accuracy".into(), errors.into());
        }
        self.scene = open;
    }

    /// The first beam's name and basis.
    fn first_basis(&self) -> Option<(String, Value)> {
        let (name, beam) = settings::beams(&self.scene).next()?;
        Some((name.clone(), beam.get("basis")?.clone()))
    }

    pub(super) fn modes(&mut self) -> Table {
        let mut table = Table::new();
        table.insert("count".into(), self.rng.i64(1..6).into());
        table
    }

    pub(super) fn statics(&mut self) -> Table {
        let mut table = Table::new();
        if self.chance(0.3) {
            table.insert("steps".into(), self.rng.i64(1..8).into());
        }
        if self.chance(0.2) {
            table.insert("tolerance".into(), self.pick(&[1e-4, 1e-6, 1e-8]).into());
        }
        table
    }

    fn path(&mut self) -> Table {
        let mut table = Table::new();
        if self.chance(0.6) {
            table.insert("until_load".into(), self.even(0.3, 1.5).into());
        } else if self.chance(0.8) {
            let probe = self.coordinate(0.02);
            table.insert("until_probe".into(), probe.into());
        }
        if table.is_empty() || self.chance(0.2) {
            table.insert("max_points".into(), self.rng.i64(3..20).into());
        }
        if self.chance(0.3) {
            table.insert("max_step".into(), self.log(0.02, 0.3).into());
        }
        table
    }

    /// A coordinate of the first probe near to where the beam's end is without load.
    fn coordinate(&mut self, distance: f64) -> Table {
        let length = self.beams[0].length;
        let place = self.beams[0].curve.position(length);
        let axis = self.rng.usize(0..2);
        let mut table = Table::new();
        table.insert("probe".into(), "p0".into());
        let value = place[axis] + self.signed(0.1 * distance, 3.0 * distance);
        table.insert(["x", "y"][axis].into(), value.into());
        table
    }

    fn dynamics(&mut self) -> Table {
        let mut table = Table::new();
        table.insert("duration".into(), self.duration.into());
        if self.chance(0.5) {
            let parts = self.rng.u8(4..30);
            table.insert("output_every".into(), (self.duration / f64::from(parts)).into());
        }
        let inextensible = self.beams.iter().any(|beam| beam.axial.is_none());
        let kind = match self.rng.u8(0..12) {
            0..3 => None,
            3..6 => Some("radau"),
            6..9 if !inextensible => Some("gauss"),
            _ => Some("generalized_alpha"),
        };
        if let Some(kind) = kind {
            let mut settings = Table::new();
            let fixed = self.chance(0.2);
            if fixed {
                let steps = f64::from(self.rng.u16(20..300));
                settings.insert("step".into(), (self.duration / steps).into());
            } else {
                let tolerance = if kind == "generalized_alpha" {
                    self.pick(&[1e-3, 1e-4, 1e-5])
                } else {
                    self.pick(&[1e-3, 1e-4, 1e-5, 1e-6, 1e-7])
                };
                settings.insert("tolerance".into(), tolerance.into());
            }
            match kind {
                "generalized_alpha" => {
                    if self.chance(0.5) {
                        let radius = self.even(0.0, 1.0);
                        settings.insert("spectral_radius".into(), radius.into());
                    }
                    if fixed && self.chance(0.4) {
                        settings.insert("newton_tolerance".into(), self.pick(&[1e-9, 1e-10, 1e-12]).into());
                    }
                }
                _ if self.chance(0.3) => {
                    let least = if kind == "radau" { 2 } else { 1 };
                    settings.insert("stages".into(), self.rng.i64(least..4).into());
                }
                _ => {}
            }
            table.insert(kind.into(), settings.into());
        }
        if self.chance(0.12) {
            let mut event = self.coordinate(0.05);
            if self.chance(0.3) {
                event.remove("x");
                event.remove("y");
                event.insert("speed".into(), self.log(0.05, 1.0).into());
            }
            if self.chance(0.6) {
                event.insert("crossing".into(), self.pick(&["rising", "falling", "any"]).into());
            }
            if self.chance(0.3) {
                event.insert("stop".into(), true.into());
            }
            table.insert("event".into(), Value::Array(vec![event.into()]));
        }
        table
    }
}
