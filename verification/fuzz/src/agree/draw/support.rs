//! Supports, and sliders.

use toml::{Table, Value};

use super::{Draw, Kind};

impl Draw<'_> {
    pub(super) fn supports(&mut self) {
        let first = match self.rng.u8(0..20) {
            0..9 => "clamp",
            9..12 => "gradient",
            12..17 => "pin",
            _ if self.is_motion() || self.kind == Kind::Modal => "free",
            _ => "clamp",
        };
        let last = match first {
            "pin" => match self.rng.u8(0..10) {
                0..3 => "pin",
                3..6 => "roller",
                6..8 => "slider",
                _ if self.is_motion() || self.kind == Kind::Modal => "free",
                _ => "clamp",
            },
            _ => match self.rng.u8(0..20) {
                0..12 => "free",
                12..14 => "pin",
                14..16 => "clamp",
                16..18 => "roller",
                _ => "slider",
            },
        };
        self.hold(0, "start", first);
        let end = self.beams.len() - 1;
        self.hold(end, "end", last);
        if self.beams.len() == 1 && self.chance(0.06) {
            let middle = self.beams[0].length * self.pick(&[0.5, 0.37]);
            let kind = self.pick(&["pin", "roller", "slider"]);
            self.hold(0, middle, kind);
        }
    }

    fn hold(&mut self, beam: usize, at: impl Into<Value>, kind: &str) {
        let at = at.into();
        let mut table = Table::new();
        let name: Value = self.beams[beam].name.clone().into();
        if kind == "slider" {
            let mut point = Table::new();
            point.insert("beam".into(), name);
            point.insert("at".into(), at);
            table.insert("type".into(), "slider".into());
            table.insert("first".into(), point.into());
            let along = self.vector(1.0, 1.0);
            table.insert("along".into(), along);
            self.push(&["joint"], table);
            return;
        }
        // A string passes no couple to its support.
        let pinned = !self.beams[beam].bends && self.chance(0.9);
        let fix: &[&str] = match kind {
            "clamp" | "gradient" if pinned => &["x", "y"],
            "clamp" => &["x", "y", "angle"],
            "gradient" => &["x", "y", "gradient"],
            "pin" => &["x", "y"],
            "roller" if self.chance(0.5) => &["y"],
            "roller" => &["x"],
            _ => return,
        };
        table.insert("beam".into(), name);
        table.insert("at".into(), at);
        table.insert("fix".into(), fix.to_vec().into());
        if self.chance(0.15) && self.kind != Kind::Buckling {
            let moves = self.moves(fix);
            table.insert("move".into(), moves.into());
        }
        self.push(&["support"], table);
    }

    /// The prescribed motion of a support. In a motion it follows a law that starts at rest.
    fn moves(&mut self, fix: &[&str]) -> Table {
        let turns = fix.iter().any(|name| matches!(*name, "angle" | "gradient"));
        let mut table = Table::new();
        if self.is_motion() && turns && self.chance(0.3) {
            let mut hub = Table::new();
            let speed = self.signed(0.1, 6.0) / self.duration;
            hub.insert("speed".into(), speed.into());
            hub.insert("duration".into(), (self.duration * self.even(0.2, 1.2)).into());
            if speed < 0.0 {
                hub.insert("start".into(), (0.2 * self.duration).into());
            }
            table.insert("spin_up".into(), hub.into());
            return table;
        }
        for axis in ["x", "y"] {
            if fix.contains(&axis) && self.chance(0.6) {
                table.insert(axis.into(), self.signed(1e-3, 0.2).into());
            }
        }
        if table.is_empty() || turns && self.chance(0.7) {
            let (key, low, high) = if turns { ("angle", 1e-2, 3.0) } else { (fix[0], 1e-3, 0.2) };
            table.insert(key.into(), self.signed(low, high).into());
        }
        if self.is_motion() {
            let law = self.law(true);
            table.insert("in_time".into(), law.into());
        }
        table
    }
}
