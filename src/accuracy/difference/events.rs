//! By how much the events of two runs differ.

use super::larger;
use crate::results::{ContactImpulse, Event, EventErrors};

/// The part of the time to the next event of its kind by which one may differ in two runs that are still in step.
const IN_STEP: f64 = 0.25;

/// Per event that is `told` of, such as those of the finer run, the difference of the same event of both.
///
/// Errors of times oscillate, and two events that agree by chance err by no less than the next ones of their kind on either side.
pub(in crate::accuracy) fn events(told: &[Event], runs: [&[Event]; 2]) -> Vec<EventErrors> {
    let mut errors = vec![EventErrors::UNKNOWN; told.len()];
    for (first, kind) in told.iter().enumerate() {
        if told[..first].iter().any(|event| is_alike(event, kind)) {
            continue;
        }
        let [coarse, fine] =
            runs.map(|run| run.iter().filter(|event| is_alike(event, kind)).collect::<Vec<_>>());
        let differences = differences(&coarse, &fine);
        let alike = (first..told.len()).filter(|i| is_alike(&told[*i], kind));
        for (i, k) in alike.zip(0..differences.len()) {
            let near = &differences[k.saturating_sub(1)..(k + 2).min(differences.len())];
            let known = near.iter().copied().flatten();
            errors[i] =
                differences[k].map_or(EventErrors::UNKNOWN, |difference| known.fold(difference, most));
        }
    }
    errors
}

/// The differences of the events of one kind, in their order, from the same ones of a coarse run: of two that are nearer to each other in
/// time than to any other one. An event without such a partner is one that the other run has not, and both go on with the next.
/// But once two that belong together are farther apart than a part of the time to their neighbours, nobody could tell a missing event
/// from runs that go apart: from the next event without a partner on nothing is known.
///
/// Along a path load factors rise and fall: there the changes of stability are the same one after the other, where both runs have as many.
fn differences(coarse: &[&Event], fine: &[&Event]) -> Vec<Option<EventErrors>> {
    let mut differences = vec![None; fine.len()];
    if let Some(Event::Stability { .. }) = fine.first() {
        if coarse.len() == fine.len() {
            let pairs = coarse.iter().zip(fine);
            differences = pairs.map(|(coarse, fine)| Some(differ(coarse, fine))).collect();
        }
        return differences;
    }
    let (mut i, mut j, mut in_step) = (0, 0, true);
    while i < coarse.len() && j < fine.len() {
        let apart = |i: usize, j: usize| Some((coarse.get(i)?.parameter() - fine.get(j)?.parameter()).abs());
        let here = (coarse[i].parameter() - fine[j].parameter()).abs();
        let beside = |k: usize| [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
        let others = beside(i).filter_map(|i| apart(i, j)).chain(beside(j).filter_map(|j| apart(i, j)));
        let nearest = others.fold(f64::INFINITY, f64::min);
        if here <= nearest {
            differences[j] = Some(differ(coarse[i], fine[j]));
            in_step &= here <= IN_STEP * nearest;
            (i, j) = (i + 1, j + 1);
        } else if !in_step {
            break;
        } else if coarse[i].parameter() < fine[j].parameter() {
            i += 1;
        } else {
            j += 1;
        }
    }
    differences
}

/// Whether the same happens in both, at whatever time.
fn is_alike(a: &Event, b: &Event) -> bool {
    match (a, b) {
        (
            Event::Probe { probe, quantity, value, turns, .. },
            Event::Probe { probe: other, quantity: same, value: level, turns: turn, .. },
        ) => probe == other && quantity == same && turns == turn && (turns.is_some() || value == level),
        (Event::Contact { contact, touches, .. }, Event::Contact { contact: other, touches: touch, .. }) => {
            contact == other && touches == touch
        }
        (
            Event::Stability { stability, unstable_directions, .. },
            Event::Stability { stability: other, unstable_directions: same, .. },
        ) => stability == other && unstable_directions == same,
        _ => false,
    }
}

/// The differences of two events of a kind.
fn differ(a: &Event, b: &Event) -> EventErrors {
    let mut errors =
        EventErrors { parameter: (a.parameter() - b.parameter()).abs(), ..EventErrors::default() };
    match (a, b) {
        (Event::Probe { value, .. }, Event::Probe { value: other, turns: Some(_), .. }) => {
            errors.value = Some((value - other).abs());
        }
        (Event::Contact { impulse: Some(a), .. }, Event::Contact { impulse: Some(b), .. }) => {
            let ContactImpulse { impulse: [x, y], largest_force } = a;
            errors.impulse = Some((x - b.impulse[0]).hypot(y - b.impulse[1]));
            errors.largest_force = Some((largest_force - b.largest_force).abs());
        }
        _ => {}
    }
    errors
}

/// The larger error of each kind.
fn most(a: EventErrors, b: EventErrors) -> EventErrors {
    let of = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| larger(a, b));
    EventErrors {
        parameter: larger(a.parameter, b.parameter),
        value: of(a.value, b.value),
        impulse: of(a.impulse, b.impulse),
        largest_force: of(a.largest_force, b.largest_force),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(time: f64, value: f64) -> Event {
        Event::Probe {
            time,
            probe: "tip".into(),
            quantity: "y",
            value,
            turns: Some("maximum"),
            rates: [0.0; 2],
        }
    }

    fn turns(times: &[f64]) -> Vec<Event> {
        times.iter().map(|time| turn(*time, 0.5 * time)).collect()
    }

    /// The times told of turns at these times, of which a coarse run has those.
    fn told(fine: &[f64], coarse: &[f64]) -> Vec<f64> {
        let (fine, coarse) = (turns(fine), turns(coarse));
        events(&fine, [&coarse, &fine]).iter().map(|error| error.parameter).collect()
    }

    /// Times differ by powers of two, so that differences are exact.
    #[test]
    fn events_differ_from_the_same_ones_and_from_no_others() {
        const NONE: f64 = f64::INFINITY;
        assert_eq!(told(&[1.0, 2.0, 3.0], &[1.0, 2.125, 3.0]), [0.125, 0.125, 0.125], "the next ones count");
        // One of the runs has one more, at the end or on the way.
        assert_eq!(told(&[1.0, 2.0], &[1.0]), [0.0, NONE]);
        assert_eq!(told(&[1.0], &[1.0, 2.0]), [0.0]);
        assert_eq!(told(&[1.0, 1.5, 2.0], &[1.0, 2.0]), [0.0, NONE, 0.0]);
        assert_eq!(told(&[1.0, 2.0], &[1.0, 1.5, 2.0]), [0.0, 0.0]);
        assert_eq!(told(&[1.0], &[]), [NONE]);
        // The runs go apart, by a quarter of the time between two events and then by more than half.
        let fine = [1.0, 2.0, 3.0, 4.0, 5.0];
        let coarse = [1.125, 2.375, 3.625, 4.875, 6.125];
        assert_eq!(told(&fine, &coarse), [0.375, 0.375, NONE, NONE, NONE]);
    }

    /// Along a path changes of stability are those in the same place of their kind, wherever the load factor goes; where one run has more of
    /// a kind than the other, nothing is known of it.
    #[test]
    fn changes_of_stability_belong_together_in_their_order() {
        let change = |load_factor: f64, stability: &'static str, unstable_directions: [usize; 2]| {
            let unstable_directions = Some(unstable_directions);
            Event::Stability { load_factor, stability, unstable_directions, resolution: 0.0 }
        };
        let path = |by: f64| {
            vec![
                change(1.0 + by, "lost", [0, 1]),
                change(-0.5, "regained", [1, 0]),
                change(0.75 + 2.0 * by, "lost", [0, 1]),
            ]
        };
        let (fine, mut coarse) = (path(0.0), path(0.25));
        let told = |coarse: &[Event]| -> Vec<f64> {
            events(&fine, [coarse, &fine]).iter().map(|error| error.parameter).collect()
        };
        assert_eq!(told(&coarse), [0.5, 0.0, 0.5], "the other one of its kind counts");
        coarse[2] = change(0.75, "lost", [1, 2]);
        assert_eq!(told(&coarse), [f64::INFINITY, 0.0, f64::INFINITY]);
    }

    #[test]
    fn kinds_of_events_are_told_apart() {
        let reached = |time: f64, value: f64| Event::Probe {
            time,
            probe: "tip".into(),
            quantity: "y",
            value,
            turns: None,
            rates: [0.0; 2],
        };
        let contact = |time: f64, impulse: Option<f64>| Event::Contact {
            time,
            contact: "arm.1".into(),
            touches: impulse.is_none(),
            impulse: impulse.map(|p| ContactImpulse { impulse: [p, 2.0 * p], largest_force: 4.0 * p }),
        };
        let fine = [turn(1.0, 0.5), reached(1.25, 0.25), contact(1.5, None), contact(2.0, Some(1.0))];
        let coarse = [reached(1.125, 0.75), contact(1.75, None), turn(2.0, 0.75), contact(3.0, Some(2.0))];
        let found = events(&fine, [&coarse, &fine]);
        assert_eq!(found[0], EventErrors { parameter: 1.0, value: Some(0.25), ..EventErrors::default() });
        assert_eq!(found[1], EventErrors::UNKNOWN, "another value is reached");
        assert_eq!(found[2], EventErrors { parameter: 0.25, ..EventErrors::default() });
        let ended = EventErrors {
            parameter: 1.0,
            value: None,
            impulse: Some(5.0_f64.sqrt()),
            largest_force: Some(4.0),
        };
        assert_eq!(found[3], ended);
        // Of the events of a third run, in its order.
        let told = events(&[fine[3].clone(), fine[0].clone()], [&coarse, &fine]);
        assert_eq!(told, [found[3], found[0]]);
    }
}
