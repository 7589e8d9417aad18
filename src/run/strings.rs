//! Demands of a model on its strings that a string, or its mesh, cannot meet.

use crate::model::{Beam, FixedRotation, Joint, Model, Place};
use crate::numeric::plain;
use crate::results::Shape;
use crate::system::System;

/// Part of a string's length by which a kink within it may move it without a message.
const UNMOVED: f64 = 1e-4;
/// Places that are nearer to each other are one, in lengths of a beam.
const SAME: f64 = 1e-9;
/// Part of a cell within which a kink beside a node spreads over both cells that meet there.
const NEAR_NODE: f64 = 0.25;
/// Of the angle of a kink and the length of the cells beside it: so far continuous tangents put the place of a kink off.
const OF_KINK: f64 = 1.0 / 12.0;

/// The part of its largest strain under tension until then by which a string may be pressed in a motion without a warning: behind a sudden front
/// shape functions overshoot by nearly as much.
const PRESSED: f64 = 0.2;
/// The part of its largest strain in the whole motion below which its pressure is not worth a warning.
const NEGLIGIBLE: f64 = 0.005;
/// Strains below this are round-off.
const NO_STRAIN: f64 = 1e-9;
/// The part of the largest axial force of a structure at rest by which a string may be pressed without a warning: where a slack one folds, shape
/// functions point back along it.
const PRESSED_AT_REST: f64 = 0.05;

/// The strings of a motion that resist pressure by a stiffness along their axis, which nothing keeps from folding.
#[derive(Clone)]
pub(super) struct Pressed {
    strings: Vec<PressedString>,
}

#[derive(Clone)]
struct PressedString {
    beam: usize,
    name: String,
    /// The largest strain so far.
    longest: f64,
    /// The smallest one where it is pressed, with its time \[s\] and its place \[m\].
    shortest: (f64, f64, f64),
}

/// Whether a beam has no bending stiffness, and resists pressure along its axis.
fn is_pressable(beam: &Beam) -> bool {
    let section = &beam.section;
    let resists = section.axial_law.as_ref().is_none_or(|law| !law.goes_slack());
    section.bending_stiffness.is_none() && resists
}

/// The warning on every string that is pressed in the last state of statics, by the balance of what acts: its cells are too few to fold, as a
/// single one is between two ends that approach each other. A tendon presses a string that goes along with it, and does not fold it.
pub(super) fn pressed_at_rest(model: &Model, last: &[Shape]) -> Vec<String> {
    let forces = last.iter().flat_map(|shape| &shape.axial_force);
    let largest = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
    let beams = model.beams.iter().zip(last).enumerate();
    let message = |(index, (beam, shape)): (usize, (&Beam, &Shape))| {
        let has_tendon = || model.parts.iter().filter_map(|part| part.tendon()).any(|(of, ..)| of == index);
        let rows = shape.axial_force.iter().zip(&shape.s);
        let (force, s) = rows.min_by(|(a, _), (b, _)| a.total_cmp(b))?;
        (-force > PRESSED_AT_REST * largest && is_pressable(beam) && !has_tendon()).then(|| {
            format!(
                "string `{}` is pressed by {} N at s = {} m: it has no bending stiffness and gives way to any pressure, but its cells are too few for that, \
                 and hold what it is tied to; use more elements or nodes, or give it its `bending_stiffness`",
                beam.name,
                plain(-force, 4),
                plain(*s, 4),
            )
        })
    };
    beams.filter_map(message).collect()
}

impl Pressed {
    pub(super) fn new(model: &Model) -> Self {
        let is_string = |beam: &&(usize, &Beam)| {
            // What is imposed takes its part of the strain without a force.
            let actuated = model.parts.iter().any(|part| part.actuation(beam.0).is_some());
            is_pressable(beam.1) && beam.1.section.axial_stiffness.is_some() && !actuated
        };
        let beams: Vec<(usize, &Beam)> = model.beams.iter().enumerate().collect();
        let string = |&(beam, of): &(usize, &Beam)| PressedString {
            beam,
            name: of.name.clone(),
            longest: 0.0,
            shortest: (0.0, 0.0, 0.0),
        };
        Self { strings: beams.iter().filter(is_string).map(string).collect() }
    }

    /// Whether there are any.
    pub(super) fn are_there(&self) -> bool {
        !self.strings.is_empty()
    }

    /// Takes the shapes at a time into account.
    pub(super) fn see(&mut self, time: f64, now: &[Shape]) {
        for PressedString { beam, longest, shortest, .. } in &mut self.strings {
            let Some(shape) = now.get(*beam) else { continue };
            *longest = shape.strain.iter().copied().fold(*longest, f64::max);
            for (strain, s) in shape.strain.iter().zip(&shape.s) {
                if *strain < shortest.0.min(-PRESSED * *longest) {
                    *shortest = (*strain, time, *s);
                }
            }
        }
    }

    pub(super) fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let pressed = self
            .strings
            .iter()
            .filter(|string| string.shortest.0 < -NO_STRAIN.max(NEGLIGIBLE * string.longest));
        pressed.map(|PressedString { name, longest, shortest: (strain, time, s), .. }| {
            format!(
                "string `{name}` is pressed, to a strain of {strain:.1e} at s = {} m and t = {} s (of {longest:.1e} where it is pulled most): nothing but the \
                 length of its cells keeps it from folding there, and what follows depends on them; give it its `bending_stiffness`, or an \
                 `axial_law` that resists tension only",
                plain(*s, 4),
                plain(*time, 4),
            )
        })
    }
}

/// A message for every place where a string, which has no bending stiffness, has a fixed direction
/// or carries a couple. It transmits no couple: only its first cells would bend, whatever their
/// length, so that the result depends on the mesh.
pub(super) fn couples(model: &Model) -> impl Iterator<Item = String> {
    let supports = model.supports.iter().enumerate();
    let supports = supports.filter(|(_, support)| support.fix.rotation != FixedRotation::Free);
    let supports =
        supports.map(|(i, support)| (format!("support {} holds its direction", i + 1), support.at));
    let welds = model.joints.iter().enumerate().flat_map(|(i, joint)| {
        let places = match *joint {
            Joint::Weld { first, second } => vec![first, second],
            Joint::Hinge { .. } | Joint::Slider { .. } => Vec::new(),
        };
        places.into_iter().map(move |at| (format!("joint {} welds it", i + 1), at))
    });
    let parts = model.parts.iter().filter_map(|part| part.couple());
    let parts = parts.map(|at| ("a moment, a torsion spring or rotary inertia acts on it".to_owned(), at));
    let on_strings = |(what, at): (String, Place)| {
        let beam = model.beams.get(at.beam).filter(|beam| beam.section.bending_stiffness.is_none())?;
        Some(format!(
            "beam `{}` has no `bending_stiffness`, and {what} at s = {} m: a string passes no couple on and turns freely, so that \
             the shape there depends on the mesh; leave it out, or give the beam a bending stiffness",
            beam.name,
            plain(at.s, 6),
        ))
    };
    supports.chain(welds).chain(parts).filter_map(on_strings)
}

/// A message for every place within a string where what acts in a point gives it a kink in the last state: its shape functions have
/// one direction there, and are off by what that is in the cells beside it.
pub(super) fn kinks(model: &Model, system: &System, last: &[Shape]) -> Vec<String> {
    let mut places: Vec<Place> = model.points().collect();
    places.sort_by(|a, b| (a.beam, a.s).partial_cmp(&(b.beam, b.s)).unwrap_or(std::cmp::Ordering::Equal));
    places.dedup();
    let message = |at: Place| {
        let beam = model.beams.get(at.beam).filter(|beam| beam.section.bending_stiffness.is_none())?;
        let (nodes, shape) = (system.beams().get(at.beam)?.basis.nodes(), last.get(at.beam)?);
        let cells = cells_around(nodes, at.s)?;
        let cell = (at.s - cells[0]).max(cells[1] - at.s);
        let (off, length) = (OF_KINK * kink(shape, cells)? * cell, nodes.last()?);
        (off > UNMOVED * length).then(|| {
            format!(
                "string `{}` has a kink at s = {} m, where something acts in a point, and its tangents are continuous: it may be off by {off:.0e} m there; \
                 cut it there, two strings in a `hinge`",
                beam.name,
                plain(at.s, 6),
            )
        })
    };
    places.into_iter().filter_map(message).collect()
}

/// The ends \[m\] of the cells over which a kink at `s` spreads: the one around it, and the next one where it is near; `None` at an end of
/// the beam.
fn cells_around(nodes: &[f64], s: f64) -> Option<[f64; 2]> {
    let same = SAME * nodes.last()?;
    let cell = nodes.partition_point(|node| *node <= s + same).checked_sub(1)?;
    let (start, end) = (nodes[cell], *nodes.get(cell + 1)?);
    if cell == 0 && s - start <= same {
        return None;
    }
    let near = NEAR_NODE * (end - start);
    let before = if s - start < near { nodes[cell.saturating_sub(1)] } else { start };
    let behind = if end - s < near { nodes.get(cell + 2).copied().unwrap_or(end) } else { end };
    Some([before, behind])
}

/// By how much a string turns between two places, beyond what it does in as long a piece on either side \[rad\].
fn kink(shape: &Shape, [before, behind]: [f64; 2]) -> Option<f64> {
    let (end, long) = (*shape.s.last()?, behind - before);
    let angle = |s: f64| shape.angle.get(shape.s.partition_point(|place| *place < s)).copied();
    let turn = |from: f64, to: f64| Some((angle(to)? - angle(from)?).abs());
    let beside = [(before - long, before), (behind, behind + long)];
    let inside = beside.into_iter().filter(|(from, to)| *from >= 0.0 && *to <= end);
    let usual = inside.filter_map(|(from, to)| turn(from, to)).reduce(f64::min).unwrap_or(0.0);
    Some(turn(before, behind)? - usual)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    /// Of a string, a beam and a rope that goes slack only the string is watched; a tenth of its largest strain, or round-off, is nothing to tell.
    #[test]
    fn a_pressed_string_is_told_with_its_time_and_place() {
        let scene = parse(
            "scene",
            "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 1, bending_stiffness = 1, mass_per_length = 1 }\n\
             beam.string = { start = [0, 1], end = [4, 1], axial_stiffness = 1, mass_per_length = 1 }\n\
             beam.rope = { start = [0, 2], end = [4, 2], axial_law = { strain = [-1, 0, 1], force = [0, 0, 1] }, mass_per_length = 1 }\n\
             support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'string', at = 'start', fix = ['x', 'y'] }, \
             { beam = 'rope', at = 'start', fix = ['x', 'y'] }]\n\
             analysis.dynamic = { duration = 1 }\n",
        )
        .unwrap_or_else(|error| panic!("{error}"));
        let shapes = |strain: [f64; 2]| {
            let shape = Shape { s: vec![0.0, 3.0], strain: strain.into(), ..Shape::default() };
            [shape.clone(), shape.clone(), shape]
        };
        let mut pressed = Pressed::new(scene.model());
        pressed.see(0.25, &shapes([1e-12, -1e-12]));
        assert_eq!(pressed.warnings().count(), 0);
        pressed.see(0.5, &shapes([0.25, -0.02]));
        assert_eq!((pressed.are_there(), pressed.warnings().count()), (true, 0));
        pressed.see(0.75, &shapes([0.1, -0.06]));
        pressed.see(1.0, &shapes([0.1, -0.01]));
        let told: Vec<String> = pressed.warnings().collect();
        let start = "string `string` is pressed, to a strain of -6.0e-2 at s = 3.0000 m and t = 0.7500 s (of 2.5e-1 where it is pulled most)";
        assert!(told.len() == 1 && told[0].starts_with(start), "{told:?}");
        // It is told however far the string is pulled later, unless the pressure is negligible beside that.
        pressed.see(1.25, &shapes([8.0, 1.0]));
        assert_eq!(pressed.warnings().count(), 1);
        pressed.see(1.5, &shapes([16.0, 1.0]));
        assert_eq!(pressed.warnings().count(), 0);
    }
}
