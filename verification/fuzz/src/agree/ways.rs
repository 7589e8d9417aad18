//! The ways of running a scene that must give the same results.

use ancf::model::Static;
use fastrand::Rng;
use toml::{Table, Value};

use super::draw;
use super::frame::{Frame, has_axes};
use super::settings;

/// Points of a path in search of its first limit load …
const POINTS_OF_LONG_PATH: i64 = 60;
/// … and most of one to a load just below it.
const POINTS_OF_SHORT_STEPS: i64 = 2000;
/// Step that passes no limit load unseen \[beam lengths\].
const SHORT_STEP: f64 = 5e-3;

/// One way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Turned,
    Mirrored,
    Units,
    LoadSteps,
    Tolerance,
    Integrator,
    FixedStep,
    Continued,
    Mesh,
    Basis,
    Welded,
    Count,
    Accuracy,
    Balance,
    Momentum,
    Split,
    AtOnce,
    Estimate,
    Limit,
}

/// All of them, in the order of the report.
pub const WAYS: [Way; 19] = [
    Way::Turned,
    Way::Mirrored,
    Way::Units,
    Way::LoadSteps,
    Way::Tolerance,
    Way::Integrator,
    Way::FixedStep,
    Way::Continued,
    Way::Mesh,
    Way::Basis,
    Way::Welded,
    Way::Count,
    Way::Accuracy,
    Way::Balance,
    Way::Momentum,
    Way::Split,
    Way::AtOnce,
    Way::Estimate,
    Way::Limit,
];

impl Way {
    /// As the report calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Turned => "turned",
            Self::Mirrored => "mirrored",
            Self::Units => "units",
            Self::LoadSteps => "load-steps",
            Self::Tolerance => "tolerance",
            Self::Integrator => "integrator",
            Self::FixedStep => "fixed-step",
            Self::Continued => "continued",
            Self::Mesh => "mesh",
            Self::Basis => "basis",
            Self::Welded => "welded",
            Self::Count => "count",
            Self::Accuracy => "accuracy",
            Self::Estimate => "estimate",
            Self::Limit => "limit",
            Self::Balance => "balance",
            Self::Momentum => "momentum",
            Self::Split => "split",
            Self::AtOnce => "at-once",
        }
    }

    /// Whether the same numbers must come out, but for round-off.
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Turned | Self::Mirrored | Self::Units)
    }
}

/// The frame of an exact way.
pub fn other_frame(way: Way, frame: &Frame, scene: &Table, rng: &mut Rng) -> Frame {
    let mut other = *frame;
    match way {
        Way::Turned => {
            other.quarters = (frame.quarters + rng.u8(1..4)) % 4;
            if !has_axes(scene) && rng.bool() {
                other.turn = frame.turn + std::f64::consts::TAU * rng.f64();
            }
        }
        Way::Mirrored => other.mirrored = !frame.mirrored,
        _ => {
            let [length, mass, time] = draw::frame(rng, scene).units;
            // Powers of two leave all digits as they are.
            let even = rng.bool();
            let near = |unit: f64| if even { unit.log2().round().exp2() } else { unit };
            let factors = [length, mass, time].map(near);
            for (unit, factor) in other.units.iter_mut().zip(factors) {
                // The units of the frame scaled by powers of two, or other units.
                *unit = if even { *unit * factor } else { factor };
            }
            for (unit, most) in other.units.iter_mut().zip([1e6, 1e9, 1e6]) {
                *unit = unit.clamp(1.0 / most, most);
            }
        }
    }
    other
}

/// The same equilibrium by other load steps; of scenes with stages, in one of them.
pub fn load_steps(scene: &Table, rng: &mut Rng) -> Option<Table> {
    let statics: Vec<(usize, &Table)> = settings::analyses(scene)
        .enumerate()
        .filter_map(|(i, analysis)| Some((i, analysis.get("static")?.as_table()?)))
        .filter(|(_, statics)| !statics.contains_key("arc_length"))
        .collect();
    let (index, statics) = *statics.get(rng.usize(0..statics.len().max(1)))?;
    if settings::has_friction(scene) {
        return None;
    }
    let mut other = scene.clone();
    let mut analyses = settings::analyses_mut(&mut other);
    let table = settings::table(analyses.get_mut(index)?, &["static"])?;
    let steps = statics.get("steps").and_then(Value::as_integer);
    // A path may pass the full load on another branch, which is not asked for here.
    if rng.u8(0..4) == 0 && !rests_on_weight(scene) && !settings::begins_elsewhere(scene) {
        let mut path = Table::new();
        path.insert("until_load".into(), 1.0.into());
        table.remove("steps");
        table.remove("max_step");
        table.insert("arc_length".into(), path.into());
    } else if steps.is_some_and(|n| n > 1 && rng.bool()) {
        table.remove("steps");
    } else {
        table.insert("steps".into(), (steps.unwrap_or(1) * rng.i64(2..8)).into());
    }
    Some(other)
}

/// Whether the scene has strings, so that a path is refused although an equilibrium is not.
fn rests_on_weight(scene: &Table) -> bool {
    settings::beams(scene).any(|(_, beam)| !settings::bends(beam))
}

/// The scene with a hundredth of the tolerance.
pub fn tighter(scene: &Table) -> Option<Table> {
    if let Some(motion) = settings::motion(scene) {
        return Some(settings::with_integrator(
            scene,
            &motion.integrator,
            "tolerance",
            0.01 * motion.tolerance?,
        ));
    }
    let (mut other, mut any) = (scene.clone(), false);
    for analysis in settings::analyses_mut(&mut other) {
        let given = settings::get(analysis, &["static", "tolerance"]).and_then(Value::as_float);
        if let (Some(given), Some(table)) = (given, settings::table(analysis, &["static"])) {
            table.insert("tolerance".into(), (0.01 * given).into());
            any = true;
        }
    }
    any.then_some(other)
}

/// The scene with another integrator and the same tolerance.
pub fn integrator(scene: &Table, rng: &mut Rng) -> Option<Table> {
    let motion = settings::motion(scene)?;
    let tolerance = motion.tolerance?;
    let inextensible = settings::beams(scene).any(|(_, beam)| !settings::stretches(beam));
    let mut others = vec!["radau"];
    if !inextensible {
        others.push("gauss");
    }
    // The method is of second order: smaller tolerances would take too long.
    if tolerance > 1e-6 {
        others.push("generalized_alpha");
    }
    others.retain(|name| *name != motion.integrator);
    let name = *others.get(rng.usize(0..others.len().max(1)))?;
    Some(settings::with_integrator(scene, name, "tolerance", tolerance))
}

/// The scene with steps of half the length.
pub fn half_steps(scene: &Table) -> Option<Table> {
    let motion = settings::motion(scene)?;
    Some(settings::with_integrator(scene, &motion.integrator, "step", 0.5 * motion.step?))
}

/// The first part of a motion, and what is left of it.
pub fn parts(scene: &Table, rng: &mut Rng) -> Option<[Table; 2]> {
    let motion = settings::motion(scene)?;
    if settings::items(scene, &["analysis", "dynamic", "event"]).any(|event| event.contains_key("stop")) {
        return None;
    }
    let records = (motion.duration / motion.output_every).round();
    let part = (records * (0.2 + 0.6 * rng.f64())).round().max(1.0);
    let first = part * motion.output_every;
    let rest = motion.duration - first;
    if rest < motion.output_every || motion.step.is_some_and(|step| step > first.min(rest)) {
        return None;
    }
    let of = |duration: f64| {
        let mut scene = scene.clone();
        let dynamic = settings::table(&mut scene, &["analysis", "dynamic"])?;
        dynamic.insert("duration".into(), duration.into());
        dynamic.insert("output_every".into(), motion.output_every.into());
        Some(scene)
    };
    Some([of(first)?, of(rest)?])
}

/// A path that goes on for some points, wherever the scene's own path ends.
pub fn long_path(scene: &Table) -> Option<Table> {
    with_path(scene, |path| {
        path.remove("until_load");
        path.remove("until_probe");
        path.insert("max_points".into(), POINTS_OF_LONG_PATH.into());
    })
}

/// The scene's path to a load factor.
pub fn path_to(scene: &Table, load: f64) -> Option<Table> {
    with_path(scene, |path| {
        path.remove("until_probe");
        path.insert("until_load".into(), load.into());
        path.insert("max_points".into(), POINTS_OF_SHORT_STEPS.into());
    })
}

/// The scene's path by short steps.
pub fn short_steps(scene: &Table) -> Option<Table> {
    with_path(scene, |path| {
        path.insert("max_step".into(), SHORT_STEP.into());
    })
}

/// The load from rest in load steps half as long; `None` without friction, for which they do not matter.
pub fn half_load_steps(scene: &Table) -> Option<Table> {
    let statics = settings::get(scene, &["analysis", "static"])?.as_table()?;
    if statics.contains_key("arc_length") || !settings::has_friction(scene) {
        return None;
    }
    let step = statics.get("max_step").and_then(Value::as_float).unwrap_or(Static::FRICTION_STEP);
    let mut other = scene.clone();
    settings::table(&mut other, &["analysis", "static"])?.insert("max_step".into(), (0.5 * step).into());
    Some(other)
}

fn with_path(scene: &Table, change: impl Fn(&mut Table)) -> Option<Table> {
    settings::get(scene, &["analysis", "static", "arc_length"])?;
    let mut scene = scene.clone();
    change(settings::table(&mut scene, &["analysis", "static", "arc_length"])?);
    Some(scene)
}

/// The scene with more or fewer modes.
pub fn count(scene: &Table, rng: &mut Rng) -> Option<Table> {
    let kind = settings::analysis(scene).to_owned();
    let count = settings::get(scene, &["analysis", &kind, "count"])?.as_integer()?;
    let mut other = scene.clone();
    let table = settings::table(&mut other, &["analysis", &kind])?;
    let new = if count > 1 && rng.bool() { rng.i64(1..count) } else { count + rng.i64(1..4) };
    table.insert("count".into(), new.into());
    Some(other)
}
