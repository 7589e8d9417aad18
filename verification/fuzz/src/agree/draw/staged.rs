//! Stages, and what comes and goes between them.

use toml::{Table, Value};

use super::{Draw, Kind};

/// The names of the stages, in order.
const NAMES: [&str; 4] = ["one", "two", "three", "four"];

impl Draw<'_> {
    /// Makes the analysis the last one of several stages, and lets supports, joints and effects come
    /// and go.
    pub(super) fn stages(&mut self) {
        let Some(Value::Table(mut analysis)) = self.scene.remove("analysis") else { return };
        let kinds = self.kinds();
        // Modes after another stage are those about an equilibrium.
        if let Some(modal) = analysis.get_mut("modal").and_then(Value::as_table_mut)
            && kinds.len() > 1
        {
            modal.insert("about".into(), "equilibrium".into());
        }
        let mut stages = Vec::new();
        for (i, kind) in kinds.iter().enumerate() {
            let analysis = match (analysis.get(*kind), *kind) {
                (Some(given), kind) => {
                    let mut given = given.clone();
                    // The end that a path or a motion has is that of the last stage.
                    if i + 1 < kinds.len()
                        && let Value::Table(table) = &mut given
                    {
                        table.remove("arc_length");
                        table.remove("event");
                    }
                    of(kind, given)
                }
                (None, "modal") => {
                    let mut modes = self.modes();
                    modes.insert("about".into(), "equilibrium".into());
                    of("modal", modes.into())
                }
                (None, kind) => {
                    let statics = self.statics();
                    of(kind, statics.into())
                }
            };
            let mut stage = Table::new();
            stage.insert("name".into(), NAMES[i].into());
            stage.insert("analysis".into(), analysis);
            stages.push(Value::Table(stage));
        }
        self.scene.insert("stage".into(), Value::Array(stages));
        self.extra_support(&kinds);
        self.come_and_go(&kinds);
    }

    /// Kinds of the stages; the last, or the motions, are what was drawn.
    fn kinds(&mut self) -> Vec<&'static str> {
        let choices: &[&[&str]] = match self.kind {
            Kind::Static | Kind::ArcLength => &[
                &["static"],
                &["static", "static"],
                &["static", "static"],
                &["static", "static", "static"],
                &["static", "modal", "static"],
                &["static", "static", "static", "static"],
            ],
            Kind::Dynamic => &[
                &["static", "dynamic"],
                &["static", "dynamic"],
                &["static", "static", "dynamic"],
                &["dynamic", "dynamic"],
                &["dynamic", "static"],
                &["static", "dynamic", "static"],
                &["static", "dynamic", "modal"],
                &["dynamic", "static", "dynamic"],
                &["static", "dynamic", "dynamic"],
            ],
            Kind::Modal | Kind::Equilibrium => {
                &[&["static", "modal"], &["static", "modal"], &["static", "static", "modal"], &["modal"]]
            }
            Kind::Buckling => &[&["buckling", "static"], &["buckling"]],
        };
        self.pick(choices).to_vec()
    }

    /// A support, or a joint to the ground, that is not there all the time.
    fn extra_support(&mut self, kinds: &[&str]) {
        if kinds.len() < 2 || !self.chance(0.25) {
            return;
        }
        let (_, _, mut support) = self.of_point();
        let fix: &[&str] =
            self.pick(&[&["y"] as &[&str], &["x"], &["x", "y"], &["x", "y", "angle"], &["angle"]]);
        support.insert("fix".into(), fix.to_vec().into());
        let first = self.rng.bool();
        let last = kinds.len() - 1;
        let key = if first { "until" } else { "stage" };
        support.insert(key.into(), NAMES[if first { 1 } else { last }].into());
        if self.chance(0.5) {
            let mut by = Table::new();
            for name in fix {
                if *name == "angle" && self.beams.iter().any(|beam| !beam.bends) {
                    continue;
                }
                by.insert((*name).into(), self.signed(1e-3, 0.1).into());
            }
            if !by.is_empty() {
                support.insert("move".into(), by.into());
            }
        }
        self.push(&["support"], support);
    }

    /// Lets items come and go: what follows a law of time or moves takes part in motions only.
    fn come_and_go(&mut self, kinds: &[&str]) {
        let motions: Vec<usize> = (0..kinds.len()).filter(|i| kinds[*i] == "dynamic").collect();
        let mut scene = std::mem::take(&mut self.scene);
        for key in ["support", "joint"] {
            for item in scene.get_mut(key).and_then(Value::as_array_mut).into_iter().flatten() {
                let driven = item.get("move").is_some_and(follows);
                let share = if key == "joint" { 0.2 } else { 0.06 };
                self.during(item, kinds, &motions, driven, share);
            }
        }
        for (kind, list) in scene.get_mut("effect").and_then(Value::as_table_mut).into_iter().flatten() {
            let items = match list {
                Value::Array(items) => items.iter_mut().collect(),
                one => vec![one],
            };
            for item in items {
                let driven = follows(item) || kind == "moving_force";
                self.during(item, kinds, &motions, driven, 0.55);
            }
        }
        self.scene = scene;
    }

    /// Says when an item takes part, with the probability `share` of other than always.
    fn during(&mut self, item: &mut Value, kinds: &[&str], motions: &[usize], driven: bool, share: f64) {
        let Value::Table(item) = item else { return };
        if ["stage", "until"].iter().any(|key| item.contains_key(*key)) {
            return;
        }
        let n = kinds.len();
        let (mut begins, mut ends) = (0, n);
        if self.chance(share) {
            begins = self.rng.usize(0..n);
            ends = self.rng.usize(begins + 1..n + 1);
            if self.chance(0.35) {
                ends = n;
            }
        }
        if driven && let Some(first) = motions.first() {
            // As long as only motions follow each other.
            begins = begins.max(*first);
            if kinds[begins] != "dynamic" {
                begins = *first;
            }
            let still = (begins..n).find(|i| kinds[*i] != "dynamic").unwrap_or(n);
            ends = ends.clamp(begins + 1, still.max(begins + 1));
        }
        if begins > 0 {
            item.insert("stage".into(), NAMES[begins].into());
        }
        if ends < n {
            item.insert("until".into(), NAMES[ends].into());
        }
    }
}

/// Whether a law of time drives an item.
fn follows(item: &Value) -> bool {
    ["in_time", "spin_up"].iter().any(|key| item.get(key).is_some())
        || ["potential", "value"]
            .iter()
            .any(|key| item.get(key).is_some_and(|of| of.to_string().contains("*t)")))
}

fn of(kind: &str, settings: Value) -> Value {
    let mut analysis = Table::new();
    analysis.insert(kind.into(), settings);
    analysis.into()
}
