//! Newton's method on scripted increments: when it stops, when it gives up, and by which words.

use ancf::assembly::Earlier;
use ancf::linear::Singular;
use ancf::solve::newton::{Equations, Failure, Iterations, Settings, not_crushed, not_crushed_since, solve};
use std::cell::Cell;

/// Increments one after the other, with the residuals before and, where they are asked for, behind
/// them; the last of each again and again.
struct Script<'s> {
    increments: &'s [f64],
    before: &'s [f64],
    behind: &'s [f64],
    asked: Cell<usize>,
    taken: usize,
    /// The iterates before each increment, and the increments that led to them.
    seen: Vec<(f64, f64)>,
}

impl<'s> Script<'s> {
    fn new(increments: &'s [f64], behind: &'s [f64]) -> Self {
        Self { increments, before: &[1.0], behind, asked: Cell::new(0), taken: 0, seen: Vec::new() }
    }
}

fn nth(list: &[f64], n: usize) -> f64 {
    list[n.min(list.len() - 1)]
}

impl Equations for Script<'_> {
    fn increment(&mut self, _: &[f64], earlier: Earlier<'_>, increment: &mut [f64]) -> Result<f64, Singular> {
        self.seen.push((earlier.q[0], earlier.increment[0]));
        increment[0] = nth(self.increments, self.taken);
        let residual = nth(self.before, self.taken);
        self.taken += 1;
        if residual < 0.0 { Err(Singular { row: 7 }) } else { Ok(residual) }
    }

    fn residual(&mut self, _: &[f64]) -> f64 {
        self.asked.set(self.asked.get() + 1);
        nth(self.behind, self.asked.get() - 1)
    }

    fn size(&self, increment: &[f64]) -> f64 {
        increment[0].abs()
    }
}

/// The outcome, the number of increments that were taken, and how often the residual was asked for.
fn outcome(script: &mut Script<'_>, settings: &Settings) -> (Result<(), Failure>, usize, usize) {
    let (mut x, mut record) = ([0.0], Iterations::default());
    let start = Earlier { q: &[-5.0], increment: &[5.0] };
    let result = solve(script, &mut x, start, settings, &mut record);
    assert_eq!(record.increments.len(), record.residuals.len());
    if result.is_ok() {
        let sum: f64 = record.increments.iter().sum();
        assert!((x[0] - sum).abs() <= 1e-15 * sum.abs(), "{} and {sum}", x[0]);
    }
    (result, record.increments.len(), script.asked.get())
}

const EXACT: &[f64] = &[0.0];
const WRONG: &[f64] = &[1.0];

/// What is left of an error is Θ² times the last increment, and the residual has its say: would
/// catch a contraction that is not squared, an increment of the other side, bounds that are strict,
/// and a residual that is not asked for, or asked for where there is nothing to tell.
#[test]
fn it_stops_where_increment_and_residual_say_so() {
    let usual = Settings::default();
    assert_eq!((usual.tolerance, usual.residual_tolerance, usual.max_iterations), (1e-10, 1e-6, 16));
    let coarse = Settings { tolerance: 1e-2, ..usual };
    let blind = Settings { residual_tolerance: f64::INFINITY, ..usual };
    let (near, far) =
        (Settings { last_increment: 1e-5, ..usual }, Settings { last_increment: 1e-3, ..usual });
    for (increments, behind, settings, iterations, asked) in [
        // Θ = 1e-4: 1e-12 is left.
        (&[1.0, 1e-4][..], EXACT, usual, 2, 1),
        // Θ = 1e-3: 1e-9 is left, and then 1e-15.
        (&[1.0, 1e-3, 1e-7], EXACT, usual, 3, 1),
        // The same to 1e-9 would have been enough.
        (&[1.0, 1e-3, 1e-7], EXACT, Settings { tolerance: 1.01e-9, ..usual }, 2, 1),
        (&[1.0, 1e-3, 1e-7], EXACT, Settings { tolerance: 0.99e-9, ..usual }, 3, 1),
        // The residual refuses once and twice.
        (&[1.0, 1e-4, 1e-8], &[2e-6, 1e-6], usual, 3, 2),
        (&[1.0, 1e-4, 1e-8, 1e-12], &[1.0, 1.0, 0.0], usual, 4, 3),
        // An increment of a thousandth of the tolerance needs no residual.
        (&[1.0, 1e-4, 0.9e-13], WRONG, usual, 3, 1),
        (&[1.0, 1e-6, 1.1e-13, 0.9e-13], WRONG, usual, 4, 2),
        (&[1.0, 1e-4], WRONG, blind, 2, 0),
        // The last tangent must be near enough.
        (&[1.0, 1e-4, 1e-8], EXACT, near, 3, 1),
        (&[1.0, 1e-4, 1e-8], EXACT, far, 2, 1),
        // Below the round-off that counts as none increments may stand still.
        (&[1e-5, 1e-6, 0.9e-6], EXACT, usual, 3, 1),
        (&[1e-5, 1e-6, 0.51e-6], EXACT, usual, 3, 1),
        (&[1e-5, 1e-6, 0.4e-6, 1e-9], EXACT, usual, 4, 1),
        (&[0.9e-6], EXACT, usual, 1, 1),
        // And within the tolerance they need no residual then.
        (&[1.0, 1e-6, 0.9e-6], WRONG, Settings { tolerance: 1e-6, ..usual }, 3, 1),
        (&[1.0, 0.1, 1e-3], EXACT, coarse, 2, 1),
    ] {
        let mut script = Script::new(increments, behind);
        let found = outcome(&mut script, &settings);
        assert_eq!(found, (Ok(()), iterations, asked), "{increments:?}, {settings:?}");
    }
}

/// Would catch bounds that are strict or not, counted from another iteration, and failures that are
/// told with another increment.
#[test]
fn it_gives_up_where_increments_say_so() {
    let usual = Settings::default();
    let first = Settings { first_increment: 0.5, ..usual };
    let three = Settings { max_iterations: 3, ..usual };
    for (increments, settings, failure, iterations) in [
        (&[0.51][..], first, Failure::FarOff { size: 0.51 }, 1),
        // A later one may be as large as it likes, up to ten times the first.
        (&[0.5, 4.0, 5.0, 5.1], first, Failure::Diverging { last: 5.1 }, 4),
        (&[1.0, 10.01], usual, Failure::Diverging { last: 10.01 }, 2),
        // From the fifth on they must not grow at all.
        (&[1.0, 2.0, 3.0, 4.0, 4.01], usual, Failure::Diverging { last: 4.01 }, 5),
        (&[1.0, 2.0, 3.0, 4.0, 4.0, 3.0, 3.5], usual, Failure::Diverging { last: 3.5 }, 7),
        (&[1.0, 1.0, 1.0, 1.0, 1.0], usual, Failure::TooSlow { iterations: 16, last: 1.0 }, 16),
        (&[1.0, 0.9, 0.8, 0.7], three, Failure::TooSlow { iterations: 3, last: 0.8 }, 3),
        (&[1.0, f64::NAN], usual, Failure::NotFinite, 2),
        (&[f64::INFINITY], usual, Failure::NotFinite, 1),
    ] {
        let mut script = Script::new(increments, WRONG);
        let (result, taken, _) = outcome(&mut script, &settings);
        assert_eq!((result, taken), (Err(failure), iterations), "{increments:?}");
    }
    let mut infinite = Script { before: &[1.0, f64::INFINITY], ..Script::new(&[1.0, 0.1], EXACT) };
    assert_eq!(outcome(&mut infinite, &usual).0, Err(Failure::NotFinite));
    let mut singular = Script { before: &[1.0, -1.0], ..Script::new(&[1.0, 0.1], EXACT) };
    assert_eq!(outcome(&mut singular, &usual).0, Err(Failure::Singular(Singular { row: 7 })));
    // Growth of what is round-off is none.
    let mut noise = Script::new(&[1e-8, 0.5e-6, 0.9e-6], EXACT);
    assert_eq!(outcome(&mut noise, &Settings { residual_tolerance: -1.0, ..usual }).1, 16);
}

/// Each increment is asked for with the iterate before and the increment that led from there: the
/// first with those of the prediction.
#[test]
fn increments_are_asked_for_with_those_before() {
    let mut script = Script::new(&[1.0, 0.5, 0.25], WRONG);
    let _ = outcome(&mut script, &Settings { max_iterations: 4, ..Settings::default() });
    assert_eq!(script.seen, [(-5.0, 5.0), (0.0, 1.0), (1.0, 0.5), (1.5, 0.25)]);
}

/// A gradient of a twentieth stands, a shorter one does not; one that has turned about does not
/// either, however long it is.
#[test]
fn crushed_nodes_are_named() {
    let nodes = |gradients: &[[f64; 2]]| -> Vec<f64> {
        gradients.iter().flat_map(|[x, y]| [100.0, 200.0, *x, *y]).collect()
    };
    let upright = nodes(&[[1.0, 0.0], [0.0, 1.0], [0.03, 0.04000001]]);
    assert_eq!(not_crushed(&upright), Ok(()));
    let crushed = nodes(&[[1.0, 0.0], [0.0, 0.5], [0.03, -0.03999], [0.0, 0.0]]);
    let Err(Failure::Crushed { stretch, node: 2 }) = not_crushed(&crushed) else { panic!("node 2") };
    assert!((stretch - 0.03_f64.hypot(0.03999)).abs() < 1e-15, "{stretch}");
    let before = nodes(&[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    let across = nodes(&[[0.0, 1.0], [1.0, 0.0], [-1.0, 1.0]]);
    assert_eq!(not_crushed_since(&before, &across), Ok(()));
    let about = nodes(&[[0.0, 1.0], [1.0, -1e-6], [-1.0, 1.0]]);
    assert_eq!(not_crushed_since(&before, &about), Err(Failure::Crushed { stretch: 0.0, node: 1 }));
    let short = nodes(&[[0.04, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    assert_eq!(not_crushed_since(&before, &short), Err(Failure::Crushed { stretch: 0.04, node: 0 }));
}

/// What a user reads of each failure, with contacts counted from one.
#[test]
fn failures_are_told_in_words() {
    for (failure, told) in [
        (Failure::FarOff { size: 0.754 }, "the prediction is 0.75 of a beam length or rad off"),
        (Failure::Diverging { last: 0.021 }, "the increments grow (the last is 2.1e-2 of a beam length)"),
        (Failure::NotFinite, "a force or an increment is not finite"),
        (
            Failure::Crushed { stretch: 0.04, node: 3 },
            "the beam is crushed: |r'|, its length against the stress-free one, is down to 0.04 at a node",
        ),
        (
            Failure::Crossed { contact: 0, part: 0.5 },
            "the step would carry the beam through the obstacle of contact 1",
        ),
        (
            Failure::Unseen { contact: 1 },
            "the step would touch the obstacle of contact 2 and leave it again, unseen",
        ),
        (Failure::Gain { gain: 0.0234 }, "the step would gain energy, 2.3 % of the kinetic"),
        (
            Failure::TooSlow { iterations: 16, last: 3e-5 },
            "no convergence within 16 iterations (the last increment is 3.0e-5 of a beam length)",
        ),
    ] {
        assert_eq!(failure.to_string(), told);
    }
}
