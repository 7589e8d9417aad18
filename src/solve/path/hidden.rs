//! What a step of a path may have passed over without a trace at its ends.

use super::{LEAVES_TURN, Parameter, Path, Point, softens, turns_within};
use crate::assembly::Earlier;
use crate::solve::equilibrium::AcrossPath;
use crate::solve::newton::Equations;
use crate::solve::stability::Stability;

/// A step without a count of unstable directions is also checked between its ends, if it turns no
/// node by more than this \[rad\]: a beam that is bent more keeps to its side of a bifurcation.
const STRAIGHT: f64 = 0.1;
/// Number of parts of such a step at whose ends it is checked.
const BETWEEN: u32 = 5;
/// How often such a part is halved at most where two directions lose their stiffness within it.
const HALVINGS: u32 = 20;
/// A rate that falls below this part of both of those at the ends of a step may vanish between.
const STANDS_STILL: f64 = 0.2;
/// Part of a step by which the cubic between its ends may miss the path halfway.
const MISSED: f64 = 0.03;
/// Changes of the shape below this part of a step are round-off …
const UNMOVED: f64 = 1e-7;
/// … and so are those below this turn \[rad\], or part of a beam length, which beside a bifurcation round-off makes in the direction that
/// is about to lose its stiffness.
const STIRRED: f64 = 1e-8;

impl Path<'_, '_> {
    /// Whether a path by arc length meets more on the way to a point than one limit point, where one direction loses or regains
    /// its stiffness and the load factor turns back.
    pub(super) fn passes_more_than_a_limit(&self, point: &Point) -> bool {
        let last = self.last();
        let (Some(before), Some(after)) = (last.stability, point.stability) else { return false };
        let turns = turns_within([last, point].map(Point::load_rate));
        self.parameter != Parameter::Load
            && (before.changes_sign(after) != turns || before.count().abs_diff(after.count()) > 1)
    }

    /// Whether the determinant changes its sign twice on the way to a point, where it alone tells
    /// of stability. It is evaluated at several states between, and where the number of directions
    /// that lack stiffness changes by more than one, at states ever nearer to the change. In a step
    /// that bends the beams states between would be compressed, as chords are; there the number at
    /// both ends has to do.
    pub(super) fn crosses_twice(&mut self, point: &Point) -> bool {
        let last = self.last().clone();
        let (Some(before), Some(Stability::NegativeDeterminants(_))) = (last.stability, point.stability)
        else {
            return false;
        };
        if self.turn(&point.x, &last.x) >= STRAIGHT {
            return softens(&last, point);
        }
        let mut scratch = vec![0.0; point.x.len()];
        let mut rate = scratch.clone();
        let mut look = |part: f64| -> Option<Between> {
            let (x, load) = within(&last, point, part);
            self.equilibrium.linearize(load, &x, None, &mut scratch, &mut rate).ok()?;
            let crossed = before.differs(self.equilibrium.stability()?);
            Some(Between { part, crossed, soft: self.equilibrium.soft_directions() })
        };
        let parts = (0..=BETWEEN).map(|k| f64::from(k) / f64::from(BETWEEN));
        let crossed = match parts.map(&mut look).collect::<Option<Vec<_>>>() {
            Some(looks) => {
                looks.windows(2).any(|ends| ends[0].crossed || crosses_within(ends, &mut look, HALVINGS))
            }
            None => true,
        };
        // The last factorisation must be that of the point.
        crossed || look(1.0).is_none()
    }

    /// Whether a quantity turns back within the last step and goes on again, so that its rates at the ends do not tell: on the
    /// cubic with these rates it nearly stands still between. Changes below `least` are none.
    pub fn hides_turns(
        &self,
        value: impl Fn(&Point) -> f64,
        rate: impl Fn(&Point) -> f64,
        least: f64,
    ) -> bool {
        let Some([a, b]) = self.last_two() else { return false };
        let h = b.parameter - a.parameter;
        let (change, [from, to]) = (value(b) - value(a), [h * rate(a), h * rate(b)]);
        if from.abs().max(to.abs()).max(change.abs()) <= least {
            return false;
        }
        if from.abs() <= LEAVES_TURN * to.abs() {
            // The step leaves a turn, and comes through another one if it ends as the path went before, or against the way that
            // it went itself.
            let before = match &self.points[..] {
                [.., before, a, _] => value(a) - value(before),
                _ => 0.0,
            };
            return change * to < 0.0 || before * to > 0.0;
        }
        if (from < 0.0) != (to < 0.0) {
            return false;
        }
        // The rate on the cubic is from + p t + q t².
        let (p, q) = (6.0 * change - 4.0 * from - 2.0 * to, 3.0 * (from + to - 2.0 * change));
        let turns = (0.0..1.0).contains(&(-0.5 * p / q));
        turns && (from - 0.25 * p * p / q) * from.signum() < STANDS_STILL * from.abs().min(to.abs())
    }

    /// Whether the cubic between the ends of the last step, with their tangents, misses the path halfway by more than a part
    /// of the step, in its shape or in its load: the step may then have passed over a snap as a whole. One iteration at the
    /// middle, across the step, tells; where it cannot be made, nothing does.
    pub fn misses_middle(&mut self) -> bool {
        let [.., a, b] = &self.points[..] else { return false };
        let n = a.x.len();
        if a.rate.len() <= n || b.rate.len() <= n {
            return false;
        }
        let length = (b.parameter - a.parameter).abs();
        let (mut middle, load) = within(a, b, 0.5);
        let mut step: Vec<f64> = b.x.iter().zip(&a.x).map(|(b, a)| b - a).collect();
        step.push(b.load - a.load);
        // The load factor may turn back within the step.
        let of_load = [b.load - a.load, length * a.load_rate(), length * b.load_rate()];
        let of_load = of_load.into_iter().fold(0.0_f64, |most, change| most.max(change.abs()));
        let system = self.equilibrium.system();
        system.supports().impose(load, &mut middle[..system.coordinates()]);
        middle.push(load);
        let (mut off, still) = (vec![0.0; n + 1], vec![0.0; n + 1]);
        let here = Earlier { q: &middle, increment: &still };
        let normal = self.weights(&step, self.load_scale);
        if AcrossPath::new(self.equilibrium, normal, self.load_scale)
            .increment(&middle, here, &mut off)
            .is_err()
        {
            return false;
        }
        let off_load = std::mem::take(&mut off[n]);
        step[n] = 0.0;
        let size = |v: &[f64]| self.dot(v, v).sqrt();
        size(&off) > (MISSED * size(&step)).max(UNMOVED * length).max(STIRRED)
            || off_load.abs() > MISSED * of_load
    }
}

/// State and load factor on the cubic between two points with their tangents, at a part of the step. A
/// chord would shorten a beam that turns, and so press it.
fn within(a: &Point, b: &Point, part: f64) -> (Vec<f64>, f64) {
    let (h, rest) = (b.parameter - a.parameter, 1.0 - part);
    let of = |a: f64, b: f64, [from, to]: [f64; 2]| {
        let (start, end) = (h * from - (b - a), (b - a) - h * to);
        rest * a + part * b + part * rest * (rest * start + part * end)
    };
    let states = a.x.iter().zip(&b.x).zip(a.rate.iter().zip(&b.rate));
    let x = states.map(|((a, b), (from, to))| of(*a, *b, [*from, *to])).collect();
    (x, of(a.load, b.load, [a.load_rate(), b.load_rate()]))
}

/// A state within a step.
#[derive(Clone, Copy)]
struct Between {
    /// Part of the step up to it.
    part: f64,
    /// Whether its determinant has the other sign than at the start of the step.
    crossed: bool,
    /// Directions that lack stiffness there.
    soft: Option<usize>,
}

/// Whether the determinant has the other sign somewhere between two states at which it has not.
fn crosses_within(ends: &[Between], look: &mut impl FnMut(f64) -> Option<Between>, halvings: u32) -> bool {
    let [a, b] = ends else { return false };
    let count = |state: &Between| state.soft.unwrap_or(0);
    if halvings == 0 || count(a).abs_diff(count(b)) < 2 {
        return false;
    }
    let Some(middle) = look(0.5 * (a.part + b.part)) else { return true };
    middle.crossed
        || crosses_within(&[*a, middle], look, halvings - 1)
        || crosses_within(&[middle, *b], look, halvings - 1)
}
