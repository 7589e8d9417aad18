//! Warnings of equilibria that are unstable, or that chance decides on.

use crate::model::Model;
use crate::numeric::plain;
use crate::results::{Event, Shape};
use crate::solve::stability::{Stability, StabilityChange};
use crate::solve::statics::{Jump, Solution, UnstableMechanism};
use crate::system::System;
use std::f64::consts::PI;

/// Changes of stability that are told one by one.
const MOST: usize = 8;

/// Cells of a half-wave that show at which load it grows to a thousandth.
const CELLS_OF_WAVE: f64 = 4.0;

/// What a static analysis has met on its way.
pub fn warnings(solution: &Solution) -> impl Iterator<Item = String> {
    let pressed = solution.pressed.map(|UnstableMechanism { load, unstable, free }| {
        let load = plain(load, 6);
        format!(
            "the load up to factor {load} presses the structure so that it is unstable in {unstable} directions where it stands, and \
             supports and joints leave it {free} to move in: its beams buckle before it moves, and on which side it comes to rest may be \
             chance; reach the load in more `steps`"
        )
    });
    let crest = solution.crest.map(|load| plain(load, 6)).map(|load| {
        format!(
            "at load factor {load} the structure stands on a crest of its energy, from which it may come to rest in more than one \
             equilibrium: which of them was found is arbitrary; a small load, or a small change of the geometry, decides"
        )
    });
    let jump = solution.jump.map(of_jump);
    let start = solution.unstable_start.map(|start| {
        let directions = match start {
            Stability::Directions(1) => "one direction".to_owned(),
            Stability::Directions(count) => format!("{count} directions"),
            Stability::NegativeDeterminants(_) => "an odd number of directions".to_owned(),
        };
        format!(
            "the path begins in a state that is unstable in {directions}, and follows unstable equilibria as long as nothing else is said: \
             a structure from which a support, a joint or a load has been taken away may leave it at once; a motion (`dynamic`) shows \
             where to"
        )
    });
    let unwatched = solution.unwatched.then(|| {
        "stability is not watched: loads turn with the structure or have no potential, and a constraint reaches over so much of a fine mesh \
         that the sign of the determinant of the tangent would take too long; use fewer elements or nodes to see it"
            .to_owned()
    });
    let softened = solution.softened.map(|load| plain(load, 6)).map(|load| {
        format!(
            "at load factor {load} several directions lose their stiffness at once, so that the determinant of the tangent, by which \
             loads without a potential are watched, keeps its sign: the equilibria found beyond may be unstable; reach the load in more \
             `steps`, or add a small imperfection"
        )
    });
    let returns = solution.returns.map(|load| plain(load, 6)).map(|load| {
        format!(
            "the path comes back to a state that it has passed, at load factor {load}: it is a closed one, or has turned round at a kink, \
             as where a snap ends at a stiff stop, or within a fold of the mesh; what it finds from there on may not be what comes first: use a \
             softer stop, another `max_step` or more nodes"
        )
    });
    let others = [pressed, crest, jump, start, unwatched, softened, returns].into_iter().flatten();
    let (told, more) = solution.events.split_at(MOST.min(solution.events.len()));
    let more = more.last().map(|last| {
        let beyond = ": what the path ends in is no shape that the structure takes; a load that pushes it aside, and acts in a stage before, \
                      leads to one";
        format!(
            "its stability changes {} more times, the last time at load factor {}{}",
            more.len(),
            plain(last.load, 6),
            if last.after.is_unstable() { beyond } else { "" }
        )
    });
    others.chain(told.iter().map(of_change)).chain(more)
}

/// What is said of beams that are pressed by so much that they might buckle in half-waves π √(EI/|N|) which are shorter than their cells: no
/// mesh of these knows of it, and a straight beam has no error that would tell.
pub fn unseen_waves(model: &Model, system: &System, last: &[Shape]) -> impl Iterator<Item = String> {
    let beams = model.beams.iter().zip(system.beams()).zip(last);
    beams.filter_map(|((beam, part), shape)| {
        let bending = beam.section.bending_stiffness.as_ref()?;
        let of_cell = |cell: &[f64]| {
            let middle = 0.5 * (cell[0] + cell[1]);
            let sample = shape.s.partition_point(|s| *s < middle);
            let press = -shape.axial_force.get(sample)?;
            let wave = PI * (bending.at(middle, middle) / press.max(0.0)).sqrt();
            Some((cell[1] - cell[0], wave, press))
        };
        let cells = part.basis.nodes().windows(2).filter_map(of_cell);
        let worst = cells.max_by(|(a, wave, _), (b, other, _)| (a / wave).total_cmp(&(b / other)));
        let (cell, wave, press) = worst.filter(|(cell, wave, _)| cell > wave)?;
        Some(format!(
            "beam `{}` is pressed by {} N, under which it might buckle in half-waves of {} m, shorter than its cells of {} m: changes of \
             stability may be missed, or be told at other loads; use more elements or nodes, about {} times as many",
            beam.name,
            plain(press, 4),
            plain(wave, 4),
            plain(cell, 4),
            (CELLS_OF_WAVE * cell / wave).ceil()
        ))
    })
}

/// A change of stability as an event.
pub fn event(change: &StabilityChange) -> Event {
    let StabilityChange { load, resolution, before, after } = *change;
    let (lost, unstable_directions) = match (before, after) {
        (Stability::Directions(before), Stability::Directions(after)) => {
            (after > before, Some([before, after]))
        }
        _ => (after.is_unstable(), None),
    };
    Event::Stability {
        load_factor: load,
        stability: if lost { "lost" } else { "regained" },
        unstable_directions,
        resolution,
    }
}

/// What is said where a structure that is relaxed comes to another equilibrium.
fn of_jump(jump: Jump) -> String {
    match jump {
        Jump::Between([low, high]) => format!(
            "between load factors {} and {} the structure jumps to another equilibrium, in which it is told from there on: beyond a \
             limit point or a bifurcation it comes to rest where its slow motion ends, which a fast one may pass; the path itself is \
             followed by `arc_length` where strings have a small bending stiffness, and a motion (`dynamic`) shows where it goes",
            plain(low, 6),
            plain(high, 6)
        ),
        Jump::BesidePath(load) => format!(
            "at load factor {} the structure rests in another equilibrium than smaller steps lead to: which of them is told is chance, as \
             where a string that weighs nothing is slack and rests anywhere; give such a string its `mass_per_length` and gravity, or \
             reach the load in more `steps`",
            plain(load, 6)
        ),
        Jump::Fork(load) => format!(
            "at load factor {} the structure gives way to one of two sides, between which it has no preference (a bifurcation): which of them \
             was found is arbitrary; a small load, or a small change of the geometry, decides",
            plain(load, 6)
        ),
    }
}

/// What is said where directions lose or regain their stiffness.
fn of_change(change: &StabilityChange) -> String {
    let StabilityChange { load, before, after, .. } = *change;
    let load = plain(load, 6);
    let unstable = "beyond it the equilibrium found is unstable: a bifurcation or a limit point";
    let (Stability::Directions(before), Stability::Directions(after)) = (before, after) else {
        return if after.is_unstable() {
            format!(
                "the determinant of the tangent changes its sign at load factor {load}: a direction loses its stiffness, or an odd \
                 number of them; {unstable}"
            )
        } else {
            format!(
                "the determinant of the tangent changes its sign back at load factor {load}: an odd number of directions lose or \
                 regain their stiffness; the equilibrium found beyond it is stable only if they regain it"
            )
        };
    };
    let (verb, advice) = if after > before {
        ("loses", unstable)
    } else {
        ("regains", "the path is back on a more stable branch")
    };
    let plural = if before == 1 { "" } else { "s" };
    format!(
        "the tangent {verb} definiteness at load factor {load}: {before} unstable direction{plural} before, {after} after; {advice}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jumps_are_told_with_their_loads() {
        for (jump, start) in [
            (Jump::Between([0.25, 0.5]), "between load factors 0.250000 and 0.500000 the structure jumps"),
            (Jump::BesidePath(0.5), "at load factor 0.500000 the structure rests in another equilibrium"),
            (Jump::Fork(0.5), "at load factor 0.500000 the structure gives way to one of two sides"),
        ] {
            let solution = Solution { jump: Some(jump), ..Solution::default() };
            let told: Vec<String> = warnings(&solution).collect();
            assert!(told.len() == 1 && told[0].starts_with(start), "{told:?}");
        }
    }

    #[test]
    fn a_path_that_comes_back_is_told() {
        let solution = Solution { returns: Some(0.25), ..Solution::default() };
        let told: Vec<String> = warnings(&solution).collect();
        assert!(
            told.len() == 1
                && told[0].starts_with(
                    "the path comes back to a state that it has passed, at load factor 0.250000"
                ),
            "{told:?}"
        );
    }

    /// Of more directions that are unstable, of fewer, and where the sign of the determinant alone is known.
    #[test]
    fn changes_of_stability_are_events() {
        let of = |before, after| match event(&StabilityChange { load: 0.5, resolution: 0.125, before, after })
        {
            Event::Stability { load_factor: 0.5, stability, unstable_directions, resolution: 0.125 } => {
                (stability, unstable_directions)
            }
            other => panic!("{other:?}"),
        };
        let (directions, sign) = (Stability::Directions, Stability::NegativeDeterminants);
        assert_eq!(of(directions(0), directions(2)), ("lost", Some([0, 2])));
        assert_eq!(of(directions(2), directions(1)), ("regained", Some([2, 1])));
        assert_eq!((of(sign(0), sign(1)), of(sign(1), sign(0))), (("lost", None), ("regained", None)));
    }

    /// The first eight one by one, and the others together.
    #[test]
    fn many_changes_are_told_together() {
        let change = |k: usize| StabilityChange {
            load: 0.125 * (k + 1) as f64,
            resolution: 0.0,
            before: Stability::Directions(k),
            after: Stability::Directions(k + 1),
        };
        let told = |count: usize| -> Vec<String> {
            warnings(&Solution { events: (0..count).map(change).collect(), ..Solution::default() }).collect()
        };
        assert_eq!((told(8).len(), told(12).len()), (8, 9));
        let more = told(12).pop().expect("a warning");
        assert!(
            more.starts_with("its stability changes 4 more times, the last time at load factor 1.50000"),
            "{more}"
        );
    }

    #[test]
    fn several_directions_at_once_are_told() {
        let solution = Solution { softened: Some(0.25), ..Solution::default() };
        let told: Vec<String> = warnings(&solution).collect();
        assert!(
            told.len() == 1 && told[0].starts_with("at load factor 0.250000 several directions lose"),
            "{told:?}"
        );
        assert_eq!(warnings(&Solution::default()).count(), 0);
    }
}
