//! The effects on the beams, and their velocities at the start.

use toml::{Table, Value};

use super::super::frame::list;
use super::{Draw, Kind, numbers, round};

impl Draw<'_> {
    pub(super) fn effects(&mut self) {
        // One load at least, or else most equilibria are the stress-free shape.
        let size = self.log(0.02, 1.0);
        let sure = self.rng.u8(0..4);
        if self.kind == Kind::Buckling && self.chance(0.8) {
            self.compression(size);
        } else if self.kind != Kind::Modal || self.chance(0.1) {
            self.force(size, sure == 0);
            self.moment(size, sure == 1);
            self.distributed(size, sure == 2);
            self.gravity(size, sure == 3);
        }
        self.damping();
        self.springs();
        self.masses();
        self.foundation();
        self.actuation();
        self.tendon(size);
        self.drag();
        self.moving_force(size);
        self.electrostatic();
        self.force_field(size);
        self.contact();
        self.initial_velocity();
    }

    fn force(&mut self, size: f64, sure: bool) {
        let share = if sure { 1.0 } else { 0.2 };
        if !self.chance(share) {
            return;
        }
        for _ in 0..self.pick(&[1, 1, 2]) {
            let (.., mut table) = self.of_point();
            table.insert("value".into(), self.vector(0.1 * size, 20.0 * size));
            self.perhaps_follower(&mut table);
            self.perhaps_in_time(&mut table, 0.5);
            self.push(&["effect", "force"], table);
        }
    }

    /// A dead force along the last beam, towards its start, under which it buckles without bending
    /// before.
    fn compression(&mut self, size: f64) {
        let Some(last) = self.beams.last() else { return };
        let ([x, y], name) = (last.curve.tangent(last.length), last.name.clone());
        let force = self.log(size, 20.0 * size);
        let mut table = Table::new();
        table.insert("beam".into(), name.into());
        table.insert("at".into(), "end".into());
        table.insert("value".into(), list([-force * x, -force * y]));
        self.push(&["effect", "force"], table);
    }

    fn perhaps_follower(&mut self, table: &mut Table) {
        if self.chance(0.25) {
            table.insert("follower".into(), self.chance(0.8).into());
        }
    }

    fn moment(&mut self, size: f64, sure: bool) {
        let share = if sure { 1.0 } else { 0.12 };
        if !self.chance(share) {
            return;
        }
        let (beam, _, mut table) = self.of_point();
        if !self.beams[beam].bends {
            return;
        }
        table.insert("value".into(), self.signed(0.1 * size, 8.0 * size).into());
        if self.chance(0.06) {
            table.insert("follower".into(), true.into());
        }
        self.perhaps_in_time(&mut table, 0.5);
        self.push(&["effect", "moment"], table);
    }

    fn distributed(&mut self, size: f64, sure: bool) {
        let share = if sure { 1.0 } else { 0.12 };
        if self.chance(share) {
            let (beam, mut table) = self.of_beam();
            let mut value = self.vector(0.1 * size, 20.0 * size);
            self.perhaps_vary_vector(&mut value, self.beams[beam].length);
            table.insert("value".into(), value);
            self.perhaps_follower(&mut table);
            self.perhaps_in_time(&mut table, 0.4);
            self.perhaps_stretch(&mut table);
            self.push(&["effect", "distributed_force"], table);
        }
    }

    fn gravity(&mut self, size: f64, sure: bool) {
        let share = if sure { 1.0 } else { 0.2 };
        if !self.chance(share) {
            return;
        }
        let mut table = Table::new();
        table.insert("acceleration".into(), self.vector(0.3 * size, 20.0 * size));
        self.perhaps_in_time(&mut table, 0.2);
        let effects = self.scene.entry("effect").or_insert_with(|| Table::new().into());
        if let Value::Table(effects) = effects {
            effects.insert("gravity".into(), table.into());
        }
        if self.chance(0.3) {
            let (_, mut table) = self.of_beam();
            table.insert("displaced_mass_per_length".into(), self.log(0.1, 1.5).into());
            self.perhaps_vary(&mut table, &["displaced_mass_per_length"]);
            self.perhaps_stretch(&mut table);
            self.push(&["effect", "buoyancy"], table);
        }
    }

    fn damping(&mut self) {
        if !self.is_motion() && !self.chance(0.04) || !self.chance(0.25) {
            return;
        }
        let (_, mut table) = self.of_beam();
        let mass = self.rng.bool();
        if mass {
            table.insert("mass_proportional".into(), self.log(0.01, 3.0).into());
        }
        match self.rng.u8(0..if mass { 3 } else { 2 }) {
            0 => {
                table.insert("stiffness_proportional".into(), self.log(1e-5, 0.1).into());
            }
            1 => {
                table.insert("curvature".into(), self.log(1e-4, 0.1).into());
                if self.rng.bool() {
                    table.insert("strain".into(), self.log(1e-5, 1e-2).into());
                }
            }
            _ => {}
        }
        self.perhaps_vary(
            &mut table,
            &["mass_proportional", "stiffness_proportional", "curvature", "strain"],
        );
        self.perhaps_stretch(&mut table);
        self.push(&["effect", "damping"], table);
    }

    fn springs(&mut self) {
        if self.chance(0.15) {
            let (beam, s, mut table) = self.of_point();
            if self.chance(0.6) {
                let [x, y] = self.beams[beam].curve.position(s);
                let anchor = [x + self.signed(0.1, 1.0), y + self.signed(0.1, 1.0)];
                table.insert("anchor".into(), list(anchor.map(|v| round(v, 4))));
                if self.chance(0.4) {
                    table.insert("length".into(), self.even(0.0, 1.2).into());
                }
            }
            table.insert("stiffness".into(), self.log(0.1, 100.0).into());
            self.dashpot(&mut table);
            self.push(&["effect", "spring"], table);
        }
        if self.chance(0.1) {
            let (beam, _, mut table) = self.of_point();
            if self.beams[beam].bends {
                table.insert("stiffness".into(), self.log(0.1, 100.0).into());
                self.dashpot(&mut table);
                self.push(&["effect", "torsion_spring"], table);
            }
        }
    }

    /// Adds a dashpot; seldom in statics, which ignores velocities with a warning.
    fn dashpot(&mut self, table: &mut Table) {
        let share = if self.is_motion() { 0.6 } else { 0.02 };
        if self.chance(share) {
            table.insert("damping".into(), self.log(0.01, 3.0).into());
        }
    }

    fn masses(&mut self) {
        if self.chance(0.15) {
            let (beam, _, mut table) = self.of_point();
            table.insert("mass".into(), self.log(0.01, 3.0).into());
            if self.beams[beam].bends && self.chance(0.4) {
                table.insert("rotary_inertia".into(), self.log(1e-3, 0.1).into());
            }
            self.push(&["effect", "point_mass"], table);
        }
        if self.chance(0.08) {
            let (_, mut table) = self.of_beam();
            table.insert("per_length".into(), self.log(1e-6, 1e-2).into());
            self.perhaps_vary(&mut table, &["per_length"]);
            self.push(&["effect", "rotary_inertia"], table);
        }
    }

    fn foundation(&mut self) {
        if self.chance(0.08) {
            let (_, mut table) = self.of_beam();
            let k = self.log(1.0, 1000.0);
            let both = if self.chance(0.6) { [k, k] } else { [0.0, k] };
            table.insert("stiffness".into(), list(both));
            self.perhaps_vary(&mut table, &["stiffness"]);
            self.perhaps_stretch(&mut table);
            self.push(&["effect", "foundation"], table);
        }
    }

    fn actuation(&mut self) {
        if !self.chance(0.12) {
            return;
        }
        let (beam, mut table) = self.of_beam();
        let drawn = &self.beams[beam];
        let (stretches, bends, layered) = (drawn.axial.is_some(), drawn.bends, drawn.layered);
        if drawn.by_law {
            return;
        }
        if stretches && self.chance(0.6) {
            table.insert("strain".into(), self.signed(1e-5, 3e-2).into());
        }
        if !stretches && !bends {
            return;
        }
        let layer = layered && table.contains_key("strain") && self.chance(0.8);
        if layer {
            table.insert("layer".into(), self.rng.i64(1..3).into());
        }
        if bends && !layer && (table.len() == 1 || self.chance(0.5)) {
            table.insert("curvature".into(), self.signed(1e-2, 5.0).into());
        }
        self.perhaps_vary(&mut table, &["strain", "curvature"]);
        self.perhaps_in_time(&mut table, 0.5);
        self.perhaps_stretch(&mut table);
        self.push(&["effect", "actuation"], table);
    }

    /// A tendon along a beam, beside its centreline if nothing says where its faces are.
    fn tendon(&mut self, size: f64) {
        if !self.chance(0.07) {
            return;
        }
        let (beam, mut table) = self.of_beam();
        let (length, beside) = (self.beams[beam].length, self.beams[beam].bends && !self.beams[beam].shaped);
        let offset = if beside { self.offset(length, &mut table) } else { 0.0.into() };
        let even = offset.is_float();
        table.insert("offset".into(), offset);
        self.perhaps_stretch(&mut table);
        if self.chance(0.4) {
            let place = |key: &str, default: f64| table.get(key).and_then(Value::as_float).unwrap_or(default);
            let span = place("to", length) - place("from", 0.0);
            let by = self.log(1e-4 * span, 1e-2 * span);
            // Beside a curved beam its length is another than the beam's.
            if even && self.beams[beam].straight && self.chance(0.5) {
                table.insert("length".into(), (span - by).into());
            } else {
                table.insert("shortening".into(), by.into());
            }
            if self.is_motion() {
                // A motion begins with the length of the stress-free shape.
                let ramp = Table::from_iter([("duration".to_owned(), self.log(0.01, 1.0).into())]);
                let law = Table::from_iter([("smooth_ramp".to_owned(), Value::Table(ramp))]);
                table.insert("in_time".into(), law.into());
            }
        } else {
            table.insert("tension".into(), self.log(0.1 * size, 5.0 * size).into());
            self.perhaps_in_time(&mut table, 0.4);
        }
        self.push(&["effect", "tendon"], table);
    }

    /// Where a tendon is beside a beam of this `length`. It has no jumps: those of pieces are before it.
    fn offset(&mut self, length: f64, tendon: &mut Table) -> Value {
        let mut beside = || self.even(-0.06, 0.06);
        let (a, b, c) = (beside(), beside(), beside());
        let of = |keys: &[(&str, &[f64])]| -> Value {
            let lists = keys.iter().map(|(key, list)| ((*key).to_owned(), numbers(list)));
            lists.collect::<Table>().into()
        };
        let (kind, places) = match self.rng.u8(0..10) {
            0..2 => ("table", of(&[("s", &[0.0, 0.5 * length, length]), ("value", &[a, b, c])])),
            2 => ("polynomial", numbers(&[a, b / length, c / length.powi(2)])),
            3 => {
                tendon.insert("from".into(), (0.3 * length).into());
                ("pieces", of(&[("until", &[0.2 * length]), ("value", &[a, b])]))
            }
            _ => return a.into(),
        };
        Table::from_iter([(kind.to_owned(), places)]).into()
    }

    fn drag(&mut self) {
        if !self.chance(0.1) {
            return;
        }
        let (_, mut table) = self.of_beam();
        for key in ["normal", "tangential", "viscous_normal", "viscous_tangential"] {
            if self.chance(0.45) {
                table.insert(key.into(), self.log(0.01, 3.0).into());
            }
        }
        if table.len() == 1 {
            table.insert("normal".into(), self.log(0.01, 3.0).into());
        }
        self.perhaps_vary(&mut table, &["normal", "tangential", "viscous_normal", "viscous_tangential"]);
        if !self.is_motion() || self.chance(0.5) {
            table.insert("flow".into(), self.vector(0.1, 2.0));
        }
        self.perhaps_stretch(&mut table);
        self.push(&["effect", "drag"], table);
    }

    fn moving_force(&mut self, size: f64) {
        if !self.is_motion() || !self.chance(0.1) {
            return;
        }
        let (beam, mut table) = self.of_beam();
        let length = self.beams[beam].length;
        table.insert("value".into(), self.vector(0.1 * size, 10.0 * size));
        let speed = length / self.duration * self.even(0.2, 3.0);
        let back = self.chance(0.3);
        table.insert("speed".into(), if back { -speed } else { speed }.into());
        if back || self.chance(0.4) {
            let start = length * if back { self.even(0.7, 1.1) } else { self.even(-0.2, 0.3) };
            table.insert("start".into(), start.into());
        }
        self.push(&["effect", "moving_force"], table);
    }

    fn contact(&mut self) {
        if self.kind == Kind::Buckling && self.chance(0.8) || !self.chance(0.16) {
            return;
        }
        let (beam, mut table) = self.of_beam();
        let length = self.beams[beam].length;
        let thickness = if self.chance(0.3) { self.log(1e-3, 2e-2) } else { 0.0 };
        let gap = self.log(1e-3, 0.2) + thickness;
        let s = self.beams[beam].starts.length() * (0.3 + 0.7 * self.rng.f64());
        let curve = &self.beams[beam].starts;
        let (p, [tx, ty]) = (curve.position(s), curve.tangent(s));
        let side = if self.rng.bool() { 1.0 } else { -1.0 };
        let normal = [-ty * side, tx * side];
        let beyond = |distance: f64| [0, 1].map(|i: usize| round(p[i] + distance * normal[i], 6));
        let (kind, obstacle): (&str, Vec<(&str, Value)>) = match self.rng.u8(0..10) {
            0..4 => {
                let radius = self.log(0.02, 0.6);
                ("circle", vec![("center", list(beyond(gap + radius))), ("radius", radius.into())])
            }
            4 => {
                // All of the beam is within a circle about its middle.
                let center = curve.position(0.5 * length).map(|v| round(v, 6));
                let radius = round(0.5 * length + gap + 0.05, 4);
                let inside = ("inside", Value::Boolean(true));
                ("circle", vec![("center", list(center)), ("radius", radius.into()), inside])
            }
            5..8 => {
                let towards = normal.map(|v| round(-v, 6));
                ("half_plane", vec![("point", list(beyond(gap))), ("normal", list(towards))])
            }
            _ => {
                let size = [self.log(0.05, 0.5), self.log(0.05, 0.5)];
                let mut keys = vec![("center", list(beyond(gap + 0.5 * size[1]))), ("size", list(size))];
                let angle = ty.atan2(tx);
                if angle != 0.0 || self.chance(0.5) {
                    keys.push(("angle", round(angle, 6).into()));
                }
                ("box", keys)
            }
        };
        let mut inner = Table::new();
        inner.extend(obstacle.into_iter().map(|(key, value)| (key.to_owned(), value)));
        table.insert(kind.into(), inner.into());
        table.insert("stiffness".into(), self.log(10.0, 1e5).into());
        if thickness > 0.0 {
            table.insert("half_thickness".into(), thickness.into());
        }
        if self.chance(0.35) {
            let mut friction = Table::new();
            friction.insert("coefficient".into(), self.log(0.05, 1.0).into());
            if self.chance(0.4) {
                friction.insert("stiffness".into(), self.log(10.0, 1e4).into());
            }
            table.insert("friction".into(), friction.into());
        }
        self.perhaps_stretch(&mut table);
        self.push(&["effect", "contact"], table);
    }

    fn initial_velocity(&mut self) {
        if !self.is_motion() || !self.chance(0.6) {
            return;
        }
        // Initial velocities must agree with the supports at the start: beams may turn about a pin,
        // and bend at a clamp.
        let held: Vec<Table> = super::super::settings::items(&self.scene, &["support"]).cloned().collect();
        let slides = super::super::settings::items(&self.scene, &["joint"])
            .any(|joint| joint.get("type").and_then(Value::as_str) == Some("slider"));
        let clamped =
            |table: &Table| table.get("fix").and_then(Value::as_array).is_some_and(|f| f.len() == 3);
        let (free, rigid) = match held.as_slice() {
            [] => (true, self.beams.len() > 1 || self.rng.bool()),
            [one] if one.get("at").and_then(Value::as_str) == Some("start") => {
                (false, !clamped(one) && (self.beams.len() > 1 || self.rng.bool()))
            }
            _ => return,
        };
        let moves = held.iter().any(|support| support.contains_key("move"));
        if slides || moves || !rigid && self.beams.len() > 1 {
            return;
        }
        let about = self.beams[0].curve.position(0.0);
        let rotation = self.signed(0.05, 5.0);
        let value = (free && self.chance(0.9)).then(|| self.vector(0.05, 3.0));
        for beam in 0..self.beams.len() {
            let mut table = Table::new();
            table.insert("beam".into(), self.beams[beam].name.clone().into());
            let length = self.beams[beam].length;
            if rigid {
                table.insert("rotation".into(), rotation.into());
                if about != [0.0; 2] || self.rng.bool() {
                    table.insert("about".into(), list(about));
                }
                if let Some(value) = &value {
                    table.insert("value".into(), value.clone());
                }
            } else {
                let size = self.signed(0.05, 2.0);
                // An inextensible beam can bend, and not stretch.
                let [x, y] = self.beams[0].curve.tangent(0.0);
                let key = if x.abs() > y.abs() { "vy" } else { "vx" };
                let mut inner = Table::new();
                if self.rng.bool() {
                    inner.insert(key.into(), list([0.0, 0.0, size / (length * length)]));
                    table.insert("polynomial".into(), inner.into());
                } else {
                    inner.insert("s".into(), list([0.0, 0.5 * length, length]));
                    inner.insert(key.into(), list([0.0, 0.3 * size, size]));
                    table.insert("table".into(), inner.into());
                }
            }
            self.push(&["initial_velocity"], table);
        }
    }
}
