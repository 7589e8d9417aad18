//! Neighbours of a scene, and how far they depart from it: a disagreement that the growth of errors
//! explains is no finding.

use fastrand::Rng;
use toml::{Table, Value};

use super::frame::{Frame, vector};
use super::gap::{self, Records};
use super::outcome::{self, Outcome, Seen};
use super::{settings, ways};

/// Quantities of beams that neighbours have otherwise.
const SHAKEN: [&str; 7] = [
    "bending_stiffness",
    "axial_stiffness",
    "second_moment",
    "mass_per_length",
    "section",
    "axial_law",
    "bending_law",
];

/// Neighbours in each frame; where chance decides, so many hardly ever agree.
const NEIGHBOURS: usize = 5;
/// Changes of which only the order of what happens takes notice.
const TINY: f64 = 1e-12;
/// Energies below this are round-off \[EI/L\].
const REST: f64 = 1e-12;

/// The scene with loads, stiffnesses and prescribed motions that differ by about `share`. A vector
/// changes its direction too, so that symmetry does not hide that it can be lost.
pub fn near(scene: &Table, share: f64, rng: &mut Rng) -> Table {
    let mut near = scene.clone();
    for key in ["effect", "initial_velocity", "support"] {
        if let Some(value) = near.get_mut(key) {
            shake(key, value, share, rng);
        }
    }
    // An additional force reveals motions that nothing resists: of a string without a load across
    // it, or of a column at its critical load.
    let beams: Vec<String> = settings::beams(scene).map(|(name, _)| name.clone()).collect();
    for beam in beams {
        let (sine, cosine) = (std::f64::consts::TAU * rng.f64()).sin_cos();
        let mut force = Table::new();
        force.insert("beam".into(), beam.into());
        force.insert("value".into(), super::frame::list([share * cosine, share * sine]));
        if let Some(effects) = settings::table(&mut near, &["effect"])
            && let Value::Array(list) =
                effects.entry("distributed_force").or_insert_with(|| Value::Array(Vec::new()))
        {
            list.push(force.into());
        }
    }
    if let Some(Value::Table(beams)) = near.get_mut("beam") {
        for (_, beam) in beams.iter_mut() {
            for key in SHAKEN {
                if let Some(value) = beam.get_mut(key) {
                    shake(key, value, share, rng);
                }
            }
        }
    }
    near
}

fn shake(key: &str, value: &mut Value, share: f64, rng: &mut Rng) {
    // Points must stay on the beams, and the beams where they are at the start.
    if matches!(key, "at" | "s" | "start" | "times" | "about" | "polynomial" | "until" | "from" | "to") {
        return;
    }
    let mut by = |size: f64| share * size * (0.5 + 0.5 * rng.f64()) * if rng.bool() { 1.0 } else { -1.0 };
    if let Some([x, y]) = vector(value).filter(|_| key != "stiffness" && key != "size") {
        let size = x.hypot(y);
        *value = super::frame::list([x + by(size), y + by(size)]);
        return;
    }
    match value {
        Value::Float(v) => *v += by(v.abs()),
        Value::Table(table) => table.iter_mut().for_each(|(key, value)| shake(key, value, share, rng)),
        Value::Array(list) => list.iter_mut().for_each(|item| shake(key, item, share, rng)),
        _ => {}
    }
}

/// By how much an error grows in a scene: the departure of neighbours per difference, 1 at least.
/// Of a motion both are computed a hundred times more accurately than was asked for, so that the
/// integrator's own error does not look like sensitivity.
pub fn growth(scene: &Table, frame: &Frame, rng: &mut Rng) -> Growth {
    let (scene, share) = match settings::motion(scene) {
        None => (scene.clone(), 1e-7),
        Some(motion) => {
            let wanted = motion.tolerance.unwrap_or(1e-6).min(1e-4);
            let name = if motion.integrator == "gauss" { "gauss" } else { "radau" };
            // A looser tolerance would tell nothing, a tighter one costs time.
            (settings::with_integrator(scene, name, "tolerance", 1e-2 * wanted), (0.1 * wanted).max(1e-7))
        }
    };
    let Outcome::Solved(here) = outcome::run(&scene, frame) else { return Growth::Unknown };
    let mut growth = Growth::By { places: 1.0, all: 1.0 };
    for _ in 0..2 {
        let Outcome::Solved(there) = outcome::run(&near(&scene, share, rng), frame) else {
            return Growth::Unknown;
        };
        let gap = gap::between(&here, &there, Records::Common);
        if let Growth::By { places, all } = &mut growth {
            *places = places.max(gap.places / share);
            *all = all.max(gap.all.value / share);
        }
    }
    growth
}

/// The largest distance between a scene and neighbours that differ from it by next to nothing: which point sticks first may decide
/// where others stick, and the last digits which one that is.
pub fn apart_by_order(scene: &Table, frame: &Frame, rng: &mut Rng) -> f64 {
    let Outcome::Solved(here) = outcome::run(scene, frame) else { return 0.0 };
    let departure = |_| match outcome::run(&near(scene, TINY, rng), frame) {
        Outcome::Solved(there) => gap::between(&here, &there, Records::Common).places,
        _ => 0.0,
    };
    (0..NEIGHBOURS).map(departure).fold(0.0, f64::max)
}

/// Whether runs whose errors, loads or stiffnesses are a little different have as many events as
/// `here`: turns as small as the errors of a run come and go with anything that changes it.
pub fn keeps_events(scene: &Table, frame: &Frame, here: &Seen, rng: &mut Rng) -> bool {
    // Where nothing moves there is no event to keep.
    if here.energy_exchanged() < REST {
        return true;
    }
    let share = settings::tolerance(scene).max(1e-7);
    let finer = ways::tighter(scene).or_else(|| ways::half_steps(scene));
    let others = finer.into_iter().chain((0..2).map(|_| near(scene, share, rng)));
    others.into_iter().all(|other| match outcome::run(&other, frame) {
        Outcome::Solved(there) => !gap::between(here, &there, Records::All).events,
        _ => false,
    })
}

/// The growth of errors as neighbours show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Growth {
    /// By these factors: of positions, and of the quantity that grows most.
    By { places: f64, all: f64 },
    /// A neighbour has no result.
    Unknown,
}

/// Whether some neighbour solves and another does not: a scene at the edge of what has a solution. If
/// all fail in one frame and none in the other, nothing but the frame decides.
pub fn at_the_edge(scene: &Table, frames: [&Frame; 2], rng: &mut Rng) -> bool {
    let mut solves = |frame| matches!(outcome::run(&near(scene, 1e-9, rng), frame), Outcome::Solved(_));
    let all = frames.map(|frame| {
        let first = solves(frame);
        (1..NEIGHBOURS).all(|_| solves(frame) == first).then_some(first)
    });
    !matches!(all, [Some(a), Some(b)] if a != b)
}
