//! Momentum of beams without supports: constant forces change it in proportion to time; without
//! forces it is conserved, and its moment, too.

use ancf::assembly::Needs;
use ancf::scene;
use ancf::system::System;
use toml::{Table, Value};

use super::frame::Frame;
use super::outcome::Seen;
use super::{settings, stages};

/// Effects whose force has no law of its own, and those that only act within beams.
const KNOWN: [&str; 9] = [
    "gravity",
    "force",
    "distributed_force",
    "damping",
    "actuation",
    "tendon",
    "point_mass",
    "rotary_inertia",
    "initial_velocity",
];

/// Momentum in x and y, its moment about the origin, and the sums of the sizes of their parts.
struct Momentum {
    of: [f64; 3],
    size: [f64; 3],
}

/// Whether the momentum of a motion is known.
pub fn is_known(scene: &Table) -> bool {
    let effects = settings::get(scene, &["effect"]).and_then(Value::as_table);
    let constant = |kind: &str| {
        settings::items(scene, &["effect", kind])
            .all(|load| !load.contains_key("in_time") && !load.contains_key("follower"))
    };
    let weight = settings::get(scene, &["effect", "gravity"]).and_then(Value::as_table);
    let drawn = |table: &Table| table.contains_key("mass_proportional");
    !stages::has(scene)
        && settings::motion(scene).is_some()
        && !settings::names(scene, &["support"])
        && settings::items(scene, &["joint"])
            .all(|joint| joint.get("type").and_then(Value::as_str) != Some("slider"))
        && effects.into_iter().flatten().all(|(kind, _)| KNOWN.contains(&&kind[..]))
        && ["force", "distributed_force"].into_iter().all(constant)
        && weight.is_none_or(|weight| !weight.contains_key("in_time"))
        && !settings::items(scene, &["effect", "damping"]).any(drawn)
}

/// The error of the momentum at the end of the motion, against that at the end of its first part
/// and the impulse of the forces since, relative to the size of its parts.
pub fn lacks(scene: &Table, first: &Seen, whole: &Seen) -> Option<(f64, String)> {
    let [before, after] = [first, whole].map(|seen| momentum(scene, seen));
    let (before, after) = (before?, after?);
    let since = whole.parameter.last()? - first.parameter.last()?;
    let [fx, fy] = whole.effects.0;
    let loads = whole.effects.1 > 0.0;
    let mut worst = (0.0, "nothing".to_owned());
    for (axis, (name, force)) in
        [("momentum in x", fx), ("momentum in y", fy), ("moment of momentum", 0.0)].into_iter().enumerate()
    {
        // Where loads act is not known here.
        if axis == 2 && loads {
            continue;
        }
        let size = after.size[axis] + since * whole.effects.1;
        let off = (after.of[axis] - before.of[axis] - since * force).abs() / size;
        if off.is_nan() || off > worst.0 {
            worst = (off, name.to_owned());
        }
    }
    Some(worst)
}

/// The momentum in the state that a motion has left: M v, multiplied by the velocities of rigid
/// motions. In natural units.
fn momentum(natural: &Table, seen: &Seen) -> Option<Momentum> {
    let text = Frame::default().write(natural).to_string();
    let scene = scene::parse("drawn.toml", &text).ok()?;
    let system = System::build(scene.model(), Needs { inertia: true, motion: true }).ok()?;
    let saved = serde_json::to_value(seen.saved.as_ref()?).ok()?;
    // Where the end of the motion cuts a step, the state that it goes on from is earlier.
    let checkpoint = saved.pointer("/saved/checkpoint")?;
    let cut = checkpoint.get("cut").filter(|cut| !cut.is_null());
    let state = cut.or_else(|| checkpoint.get("state"))?;
    let numbers = |key: &str| -> Option<Vec<f64>> {
        state.get(key)?.as_array()?.iter().map(serde_json::Value::as_f64).collect()
    };
    let (q, v) = (numbers("q")?, numbers("v")?);
    let mut parts = vec![0.0; q.len()];
    system.mass_matrix().multiply_add(1.0, &v, &mut parts);
    system.add_turning_momentum(&q, &v, &mut parts);
    let (mut of, mut size) = ([0.0; 3], [0.0; 3]);
    for (p, q) in parts.chunks_exact(4).zip(q.chunks_exact(4)) {
        let moment = q[0] * p[1] - q[1] * p[0] + q[2] * p[3] - q[3] * p[2];
        for (axis, part) in [p[0], p[1], moment].into_iter().enumerate() {
            of[axis] += part;
            size[axis] += part.abs();
        }
    }
    Some(Momentum { of, size })
}
