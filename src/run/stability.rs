//! Warnings of equilibria that are unstable, or that chance decides on.

use crate::numeric::plain;
use crate::solve::stability::{Stability, StabilityChange};
use crate::solve::statics::{Solution, UnstableMechanism};

/// Changes of stability that are told one by one.
const MOST: usize = 8;

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
    let others = [pressed, crest, start, unwatched, softened, returns].into_iter().flatten();
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

/// What is said where directions lose or regain their stiffness.
fn of_change(change: &StabilityChange) -> String {
    let StabilityChange { load, before, after } = *change;
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

    /// The first eight one by one, and the others together.
    #[test]
    fn many_changes_are_told_together() {
        let change = |k: usize| StabilityChange {
            load: 0.125 * (k + 1) as f64,
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
