//! Checks of supports: they fix nothing twice, and in statics they prevent every rigid motion.

use crate::effect::{DistributedForce, Force, Gravity};
use crate::model::freedom::{Freedom, Motion};
use crate::model::{Along, FixedRotation, Joint, Law, Model, Place};
use std::any::Any;

use super::error::Fault;
use super::file::SceneTable;
use super::place::Built;

/// Places nearer to each other than this, per length of the beam, are one: the equations cannot
/// tell two supports there apart.
const NEAR: f64 = 1e-6;

/// Refuses two supports at one point of a beam that hold the same quantity.
pub(super) fn check_duplicates(file: &SceneTable, model: &Model, built: &[Built]) -> Result<(), Fault> {
    for (index, later) in model.supports.iter().enumerate() {
        for earlier in model.supports.iter().take(index) {
            let length = built.get(later.at.beam).map_or(0.0, |beam| beam.curve.length());
            let apart = (later.at.s - earlier.at.s).abs() > NEAR * length;
            if later.at.beam != earlier.at.beam || apart {
                continue;
            }
            let shared = [
                ("x", later.fix.x && earlier.fix.x),
                ("y", later.fix.y && earlier.fix.y),
                (
                    "the direction of r'",
                    later.fix.rotation != FixedRotation::Free && earlier.fix.rotation != FixedRotation::Free,
                ),
            ];
            if let (Some((what, _)), Some(table)) =
                (shared.into_iter().find(|(_, both)| *both), file.support.get(index))
            {
                return Err(Fault::new(
                    table.get().fix.span(),
                    format!("a support before this one already fixes {what} at the same point"),
                )
                .help("fix each quantity of a point once, in one `[[support]]`"));
            }
        }
    }
    Ok(())
}

/// Forces other than elastic ones that may resist a rigid motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Resisting {
    /// None: the analysis asks for the stiffness of the unloaded structure.
    Nothing,
    /// Weight, under which a pendulum hangs still, and the loads of fixed direction beside it.
    Weight,
}

/// Refuses a structure that can move without deforming. The direction of a string need not be
/// fixed: it follows from the load that the string carries. Weight gives a direction to the beams
/// that it pulls straight.
pub(super) fn check_rigid_motions(model: &Model, built: &[Built], resisting: Resisting) -> Result<(), Fault> {
    let length = built.iter().map(|beam| beam.curve.length()).fold(0.0, f64::max);
    let position = |place: Place| built[place.beam].curve.position(place.s);
    let mut held = Freedom::new(model, length, position);
    held.resist(model, position);
    for (beam, _) in model.beams.iter().enumerate().filter(|(_, b)| b.section.bending_stiffness.is_none()) {
        held.fix_direction(beam);
    }
    let left = held.motions();
    if resisting == Resisting::Weight && !left.is_empty() {
        for (beam, taut) in taut(model, built).into_iter().enumerate() {
            if taut {
                held.fix_direction(beam);
            }
        }
        if held.motions().is_empty() {
            return Ok(());
        }
    }
    let Some(first) = left.first() else { return Ok(()) };
    // The beam that moves most.
    let size = |motion: &Motion, beam: usize| motion[beam].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let index = (0..built.len()).max_by(|a, b| size(first, *a).total_cmp(&size(first, *b))).unwrap_or(0);
    let moving = left.iter().filter(|motion| size(motion, index) > 1e-9);
    let words: Vec<String> = moving
        .map(|motion| describe(motion[index].map(|v| v / size(motion, index)), held.origin(index), length))
        .collect();
    let words = match &words[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        _ => words.concat(),
    };
    let beam = &built[index];
    let help = match resisting {
        Resisting::Weight => {
            "an equilibrium needs every rigid motion held: add a `[[support]]`, such as \
             `fix = [\"x\", \"y\", \"angle\"]` at the start, or a `[[joint]]`"
        }
        Resisting::Nothing => {
            "a path by arc length and a buckling analysis need every rigid motion held without loads: add a `[[support]]`, such as \
             `fix = [\"x\", \"y\", \"angle\"]` at the start, or a `[[joint]]`, or let a `[[stage]]` before it load what loads hold"
        }
    };
    let obstacles = if model.has_contact() {
        "; an obstacle does not count, for it holds what presses it only: a soft `[[effect.spring]]` holds a beam that lies on one"
    } else {
        ""
    };
    Err(Fault::new(
        beam.name.span(),
        format!("beam `{}` is under-supported: it is free for {words}", beam.name.get()),
    )
    .help(format!("{help}{obstacles}")))
}

/// Per beam, whether weight, and loads of fixed direction beside it, give it a direction, because
/// they may pull on it at one point and something else at another. Such a beam is joined, perhaps
/// through others, to one on which these loads act, and it is loaded, joined or supported at two
/// points or more.
fn taut(model: &Model, built: &[Built]) -> Vec<bool> {
    let length = built.iter().map(|beam| beam.curve.length()).fold(0.0, f64::max);
    let loads = acted_upon(model, built);
    let pairs: Vec<[Place; 2]> = model
        .joints
        .iter()
        .filter_map(|joint| match *joint {
            Joint::Hinge { first, second } | Joint::Weld { first, second } => Some([first, second]),
            Joint::Slider { .. } => None,
        })
        .collect();
    let mut reached = vec![false; built.len()];
    loads.iter().for_each(|place| reached[place.beam] = true);
    for _ in 0..built.len() {
        for [first, second] in &pairs {
            let either = reached[first.beam] || reached[second.beam];
            (reached[first.beam], reached[second.beam]) = (either, either);
        }
    }
    let mut taut = reached;
    loop {
        let dangles = |beam: &usize| {
            let joined = pairs.iter().filter(|pair| pair.iter().all(|place| taut[place.beam])).flatten();
            let sliders = model.joints.iter().filter_map(|joint| match joint {
                Joint::Slider { at, .. } => Some(at),
                _ => None,
            });
            let supports = model.supports.iter().map(|support| &support.at);
            let pulled = loads.iter().chain(joined).chain(sliders).chain(supports);
            let places = pulled.filter(|place| place.beam == *beam).map(|place| place.s);
            let (from, to) =
                places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)));
            to - from <= NEAR * length
        };
        let dangling: Vec<usize> = (0..built.len()).filter(|beam| taut[*beam]).filter(dangles).collect();
        if dangling.is_empty() {
            return taut;
        }
        dangling.into_iter().for_each(|beam| taut[beam] = false);
    }
}

/// Points on which loads of fixed direction act. Weight and distributed forces count as acting on
/// both ends of a beam.
fn acted_upon(model: &Model, built: &[Built]) -> Vec<Place> {
    let ends = |beam: usize| [0.0, built[beam].curve.length()].map(|s| Place { beam, s });
    let acts = |value: &[f64; 2]| value.iter().any(|component| *component != 0.0);
    let fixed = |follower: bool, law: &Option<Law>| !follower && law.is_none();
    let (mut places, mut weighs) = (Vec::new(), false);
    for part in &model.parts {
        let part: &dyn Any = part.as_ref();
        if let Some(gravity) = part.downcast_ref::<Gravity>().filter(|g| acts(&g.acceleration)) {
            weighs |= gravity.law.is_none();
        }
        if let Some(force) = part.downcast_ref::<Force>() {
            places.extend((fixed(force.follower, &force.law) && acts(&force.value)).then_some(force.at));
        }
        if let Some(force) = part.downcast_ref::<DistributedForce>() {
            let acts = fixed(force.follower, &force.law) && !force.value.iter().all(Along::is_zero);
            places.extend(acts.then(|| ends(force.beam)).into_iter().flatten());
        }
    }
    if weighs {
        let heavy = |beam: &usize| model.beams[*beam].section.mass_per_length.is_some();
        places.extend((0..model.beams.len()).filter(heavy).flat_map(ends));
        places.extend(model.parts.iter().filter_map(|part| part.mass()).map(|(place, _)| place));
    }
    // Without weight a beam on a hinge is more likely one that lacks a support.
    if weighs { places } else { Vec::new() }
}

fn describe([tx, ty, turn]: [f64; 3], origin: [f64; 2], length: f64) -> String {
    let round = |value: f64| {
        let rounded = (value * 1e6).round() / 1e6;
        if rounded == 0.0 { 0.0 } else { rounded }
    };
    if turn.abs() > 1e-9 {
        // The point that stays: t_x − ω y = 0 and t_y + ω x = 0, in units of the length.
        let (x, y) = (origin[0] - ty / turn * length, origin[1] + tx / turn * length);
        return format!("rotation about the point ({}, {})", round(x), round(y));
    }
    if ty == 0.0 {
        "translation along x".into()
    } else if tx == 0.0 {
        "translation along y".into()
    } else {
        format!("translation along ({}, {})", round(tx), round(ty))
    }
}
