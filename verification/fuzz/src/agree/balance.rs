//! Balances that need no second run: of all forces, and of forces and couples at the ends of beams.

use toml::{Table, Value};

use super::gap::force_size;
use super::outcome::Seen;
use super::{settings, stages};

/// The worst of the balances: its error relative to the largest force, and its name.
pub fn worst(scene: &Table, seen: &Seen) -> Option<(f64, String)> {
    if stages::may_end_fading(scene) {
        return None;
    }
    let scene = &stages::last(scene);
    let kind = settings::analysis(scene);
    if !matches!(kind, "static" | "dynamic") {
        return None;
    }
    let size = force_size(seen);
    let mut worst = (0.0, "nothing".to_owned());
    let mut note = |off: f64, what: String| {
        if off.is_nan() || off / size > worst.0 {
            worst = (off / size, what);
        }
    };
    if seen.reactions.len()
        != settings::items(scene, &["support"]).count() + settings::items(scene, &["joint"]).count()
    {
        return None;
    }
    if kind == "static" {
        let held = ground(scene, seen).fold(seen.effects.0, |[x, y], [fx, fy, _]| [x + fx, y + fy]);
        note(held[0].hypot(held[1]), "sum of all forces".to_owned());
    }
    for ((name, table), beam) in settings::beams(scene).zip(&seen.beams) {
        // A string has no Q and no M, whatever holds its direction.
        if !settings::bends(table) {
            continue;
        }
        for (end, index) in [("start", 0), ("end", beam.forces.len().saturating_sub(1))] {
            let (Some([n, q, m]), Some(angle)) = (beam.forces.get(index), beam.angle.get(index)) else {
                continue;
            };
            let acts = match at_end(scene, seen, name, end) {
                Acts::Nothing => [0.0; 3],
                Acts::Support(reaction) => reaction,
                Acts::More => continue,
            };
            // Forces at the start have this sign on the section behind them.
            let sign = if end == "start" { -1.0 } else { 1.0 };
            let (sine, cosine) = angle.sin_cos();
            let [fx, fy, moment] = acts.map(|v| sign * v);
            let off = [fx * cosine + fy * sine - n, fy * cosine - fx * sine - q, moment - m];
            for (what, off) in ["N", "Q", "M"].iter().zip(off) {
                note(off.abs(), format!("{what} at the {end} of beam {name}, against what acts there"));
            }
        }
    }
    Some(worst)
}

/// The forces that act at the end of a beam.
enum Acts {
    Nothing,
    /// A support alone, with this force and moment.
    Support([f64; 3]),
    /// Something whose force is not known here.
    More,
}

fn at_end(scene: &Table, seen: &Seen, beam: &str, end: &str) -> Acts {
    let here = |table: &Table| {
        let named = table.get("beam").and_then(Value::as_str) == Some(beam);
        // Arc lengths are drawn between the ends.
        named && table.get("at").and_then(Value::as_str) == Some(end)
    };
    let point_effects = ["force", "moment", "spring", "torsion_spring", "point_mass"];
    let acts = point_effects.iter().any(|kind| settings::items(scene, &["effect", kind]).any(here));
    let travels = settings::names(scene, &["effect", "moving_force"]);
    let joined = settings::items(scene, &["joint"])
        .flat_map(|joint| ["first", "second"].map(|key| joint.get(key).and_then(Value::as_table)))
        .flatten()
        .any(here);
    // A tendon pulls at the sections at which it ends.
    let pulled = settings::items(scene, &["effect", "tendon"])
        .any(|tendon| tendon.get("beam").and_then(Value::as_str) == Some(beam));
    if acts || travels || joined || pulled {
        return Acts::More;
    }
    let supports: Vec<usize> =
        settings::items(scene, &["support"]).enumerate().filter(|(_, s)| here(s)).map(|(i, _)| i).collect();
    match supports.as_slice() {
        [] => Acts::Nothing,
        [one] => match seen.reactions.get(*one) {
            Some((_, reaction)) => Acts::Support(*reaction),
            None => Acts::More,
        },
        _ => Acts::More,
    }
}

/// Forces and moments of supports and sliders.
fn ground<'s>(scene: &'s Table, seen: &'s Seen) -> impl Iterator<Item = [f64; 3]> {
    let supports = settings::items(scene, &["support"]).count();
    let joints = settings::items(scene, &["joint"])
        .map(|joint| joint.get("type").and_then(Value::as_str) == Some("slider"));
    let outer = std::iter::repeat_n(true, supports).chain(joints);
    seen.reactions.iter().zip(outer).filter(|(_, outer)| *outer).map(|((_, reaction), _)| *reaction)
}
