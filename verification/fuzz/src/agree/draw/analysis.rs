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
        if self.chance(0.1) {
            table.insert("max_step".into(), self.pick(&[0.5, 0.1, 0.02]).into());
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
        if self.chance(0.3) {
            let count = self.pick(&[1, 2, 3]);
            let events = (0..count).map(|_| self.event().into()).collect();
            table.insert("event".into(), Value::Array(events));
        }
        table
    }

    /// Something to watch for at the first probe.
    fn event(&mut self) -> Table {
        let [x, y] = self.beams[0].curve.tangent(self.beams[0].length);
        let (heading, velocity) = (y.atan2(x), 1.0 / self.duration.max(0.1));
        let value = match self.rng.u8(0..16) {
            0..2 => None,
            2 => Some((self.pick(&["vx", "vy"]), self.signed(0.01, 1.0) * velocity)),
            3 => Some(("speed", self.log(0.01, 1.0) * velocity)),
            4 => Some(("strain", self.signed(1e-6, 1e-3))),
            5 => Some(("axial_force", self.signed(0.01, 5.0))),
            // Near to half a turn the angle of a turned scene would begin on the other side.
            6 if (0.4..1.17).contains(&heading.rem_euclid(std::f64::consts::FRAC_PI_2)) => {
                Some(("angle", heading + self.signed(0.01, 0.3)))
            }
            7 if self.beams[0].bends => Some(("curvature", self.signed(0.05, 3.0))),
            8 if self.beams[0].bends => Some(("shear_force", self.signed(0.01, 5.0))),
            9 if self.beams[0].bends => Some(("bending_moment", self.signed(0.01, 2.0))),
            10..14 => {
                let key = self.pick(&["maximum", "minimum"]);
                let mut names = vec!["x", "y", "vx", "vy", "speed", "angle", "strain", "axial_force"];
                if self.beams[0].bends {
                    names.extend(["curvature", "shear_force", "bending_moment"]);
                }
                if self.beams[0].shaped {
                    names.extend(["stress_bottom", "stress_top"]);
                }
                let mut event = Table::new();
                event.insert("probe".into(), "p0".into());
                event.insert(key.into(), self.pick(&names).into());
                return self.perhaps_stop(event);
            }
            _ if self.beams[0].shaped => {
                Some((self.pick(&["stress_bottom", "stress_top"]), self.signed(0.1, 100.0)))
            }
            _ => None,
        };
        let mut event = match value {
            None => self.coordinate(0.05),
            Some((key, value)) => {
                let mut event = Table::new();
                event.insert("probe".into(), "p0".into());
                event.insert(key.into(), value.into());
                event
            }
        };
        if self.chance(0.6) {
            event.insert("crossing".into(), self.pick(&["rising", "falling", "any"]).into());
        }
        self.perhaps_stop(event)
    }

    fn perhaps_stop(&mut self, mut event: Table) -> Table {
        if self.chance(0.12) {
            event.insert("stop".into(), true.into());
        }
        event
    }
}
