//! Quantities at probes that reach a value, or turn back.
//!
//! A position is linear in q, so that in a step it is one polynomial of time, the Hermite
//! interpolation of the data at both ends: positions and velocities (cubic), and if known
//! accelerations (quintic). Any other quantity is evaluated in states within the step, and is
//! represented by polynomials of degree five, where it follows from the motion alone on so many parts
//! of the step that they err by less than [`CLOSE`]. The events are those of the polynomials ([`super::crossing`]).

use super::State;
use super::crossing::{NEAR, Polynomial};
use super::integrate::Driver;
use super::motion::Balance;
use crate::model::{Crossing, EventKind, StepControl};
use crate::system::View;

/// Largest error of a polynomial, relative to the change of the quantity in the step.
const CLOSE: f64 = 1e-8;
/// Changes of positions below this part of what the tolerance of a motion allows are errors of its steps, and no turns.
const NOISE_OF_POSITIONS: f64 = 1e-3;
/// How often a step is halved at most to represent a quantity.
const HALVINGS: u32 = 4;
/// Changes below this part of the largest value so far, of forces along the whole beam, are errors of the integration, and
/// no turns.
const NOISE: f64 = 1e-6;
/// The same part for strains and forces \[tolerances of the motion\], which err by more than positions …
const NOISE_OF_FORCES: f64 = 10.0;
/// … and its largest value, for motions whose tolerance is so loose that no turn would be left.
const LARGEST_NOISE: f64 = 1e-2;
/// Places at which a polynomial is compared with the quantity.
const BETWEEN: [f64; 3] = [0.2, 0.5, 0.8];

/// The smallest change of a position between turns that can be told from round-off and from the errors
/// of steps \[beam lengths\].
pub fn least_change(control: StepControl) -> f64 {
    match control {
        StepControl::Fixed(_) => NEAR,
        StepControl::Tolerance(tolerance) => NEAR.max(NOISE_OF_POSITIONS * tolerance),
    }
}

/// A quantity that is watched.
pub struct EventWatch<'t> {
    /// The quantity.
    pub quantity: Quantity<'t>,
    /// The point at which it is watched.
    pub place: View,
    /// Values of it that are errors of its arithmetic, within a beam length of the origin. Farther away
    /// positions have fewer digits, and errors grow with the distance.
    pub round_off: f64,
    /// Whether it is a velocity.
    pub is_rate: bool,
    /// Whether its zero is one of many, as that of a direction: its size is then that of its change.
    pub is_relative: bool,
    /// Whether `quantity` is the square of what is watched: a speed has a corner where a point reverses, and no polynomial
    /// represents it.
    pub is_square: bool,
    /// What it has to do.
    pub when: EventKind,
    /// Whether the motion ends there.
    pub stop: bool,
}

/// A scalar function of the state, by what it needs.
pub enum Quantity<'t> {
    /// A component of the position of a point: 0 for x, 1 for y.
    Position(View, usize),
    /// A function of coordinates and velocities.
    OfMotion(Box<dyn Fn(&State) -> f64 + 't>),
    /// A function of a state in which all forces are in balance.
    OfForces(Box<dyn Fn(&Balance) -> Observed + 't>),
}

/// What is seen of a quantity in a state.
#[derive(Clone, Copy, Debug)]
pub struct Observed {
    /// Its value at the point; no number where it is not known.
    pub value: f64,
    /// The largest magnitude of a force along its beam. Zero of other quantities: strains may be any small part of those in a
    /// softer piece of the beam, and yet be known.
    pub along: f64,
}

impl Observed {
    /// A quantity that is known at the point only.
    pub fn at_point(value: f64) -> Self {
        Self { value, along: 0.0 }
    }
}

/// What is remembered of a watched quantity from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watched {
    /// Its value at the end of the last step.
    value: Option<f64>,
    /// Its first value, from which its size is counted where its zero is one of many.
    first: Option<f64>,
    /// Its largest magnitude so far; of forces, along the whole beam.
    largest: f64,
    /// The sign of its slope there, or of the last slope that was not zero.
    slope: f64,
    /// Its value where it turned back last, or at the start.
    turned: Option<f64>,
}

/// An event of a watched quantity.
#[derive(Clone, Copy, Debug)]
pub struct ProbeEvent {
    /// Number of the watch.
    pub watch: usize,
    /// When \[s\].
    pub time: f64,
    /// Value of the quantity.
    pub value: f64,
    /// Its first and second derivative there \[1/s, 1/s²\].
    pub rates: [f64; 2],
}

/// A part of a step, from 0 to 1, and the quantity on it.
type Piece = ([f64; 2], Polynomial);

/// States within a step, by their places in it: what is watched is seen at the same places, and forces in balance cost as much as an
/// iteration.
#[derive(Default)]
struct Within {
    moving: Vec<(f64, State)>,
    balanced: Vec<(f64, Option<Balance>)>,
}

impl Driver<'_, '_> {
    /// Notes the events of the step to `new` in the order of time; returns the state of the first
    /// that ends the motion.
    pub(super) fn note_events(&mut self, new: &State, accelerations: Option<[&[f64]; 2]>) -> Option<State> {
        let task = self.task;
        let h = new.time - self.state.time;
        let noise_of_forces = match self.control {
            StepControl::Fixed(_) => NOISE,
            StepControl::Tolerance(tolerance) => (NOISE_OF_FORCES * tolerance).clamp(NOISE, LARGEST_NOISE),
        };
        let mut within = Within::default();
        // With the place of each in the step.
        let mut found: Vec<(f64, ProbeEvent)> = Vec::new();
        for (number, watch) in task.watches.iter().enumerate() {
            let (pieces, along) = self.pieces(watch, new, accelerations, &mut within);
            if pieces.iter().any(|(_, piece)| !(piece.at(0.0)[0] + piece.at(1.0)[0]).is_finite()) {
                self.solution.unseen.get_or_insert((number, self.state.time));
                continue;
            }
            let round_off = self.round_off(watch, new.time - self.first.time);
            let memory = &mut self.watched[number];
            let first = pieces.first().map_or(0.0, |(_, piece)| piece.at(0.0)[0]);
            let zero = if watch.is_relative { *memory.first.get_or_insert(first) } else { 0.0 };
            let watched = |value: f64| if watch.is_square { value.max(0.0).sqrt() } else { value };
            let ends = pieces
                .iter()
                .flat_map(|(_, piece)| [0.0, 1.0].map(|x| (watched(piece.at(x)[0]) - zero).abs()));
            memory.largest = ends.fold(memory.largest.max(along), f64::max);
            let (unit, noise) = match watch.quantity {
                Quantity::Position(..) => (self.system.length(), least_change(self.control)),
                Quantity::OfMotion(_) => (memory.largest, NOISE),
                Quantity::OfForces(_) => (memory.largest, noise_of_forces),
            };
            let events = match watch.when {
                EventKind::Reaches { value, crossing } => {
                    // What rests where it is zero does not reach zero again and again.
                    let near = round_off.max(NEAR * unit.max(value.abs()));
                    let (followed, near) = match watch.is_square {
                        // At rest the square turns back at zero, as near to it as polynomials are.
                        true if value == 0.0 => (0.0, (near * near).max(CLOSE * memory.largest.powi(2))),
                        true => (value * value.abs(), near * (2.0 * value.abs() + near)),
                        false => (value, near),
                    };
                    reached(&pieces, followed, crossing, near, memory)
                }
                EventKind::Maximum => turned(&pieces, 1.0, round_off.max(noise * unit), memory, watched),
                EventKind::Minimum => turned(&pieces, -1.0, round_off.max(noise * unit), memory, watched),
            };
            memory.value = pieces.last().map(|(_, piece)| piece.at(1.0)[0]);
            let later = events.into_iter().filter(|(at, _)| self.state.time + at * h > self.first.time);
            found.extend(later.map(|(at, value)| {
                let (value, rates) = (watched(value), rates(&pieces, at, h, watch.is_square));
                (at, ProbeEvent { watch: number, time: self.state.time + at * h, value, rates })
            }));
        }
        // Among simultaneous events, one that ends the motion comes last.
        let stops = |event: &ProbeEvent| task.watches[event.watch].stop;
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(stops(&a.1).cmp(&stops(&b.1))));
        for (at, event) in found {
            let state = match at {
                _ if at < 1.0 => self.between(new, event.time, accelerations),
                _ => new.clone(),
            };
            self.solution.events.push(ProbeEvent { time: state.time, ..event });
            if stops(&event) {
                return Some(state);
            }
        }
        None
    }

    /// Values of a watched quantity that are round-off, in a motion that has lasted for `elapsed`. A
    /// velocity is, if it neither moves its point by as much as the round-off of positions since then, nor
    /// belongs to a slow vibration of such an amplitude.
    fn round_off(&self, watch: &EventWatch<'_>, elapsed: f64) -> f64 {
        let length = self.system.length();
        let [x, y] = watch.place.at_point(&self.state.q);
        let far = (x.hypot(y) / length).max(1.0);
        let slow = self.system.lowest_vibration_scale().sqrt().recip();
        let of_position = match watch.quantity {
            Quantity::Position(..) => NEAR * length,
            _ if watch.is_rate => NEAR * length / elapsed.max(slow),
            _ => 0.0,
        };
        far * watch.round_off.max(of_position)
    }

    /// A watched quantity in the step to `new`, and its largest magnitude along the beam where it is a force.
    fn pieces(
        &mut self,
        watch: &EventWatch<'_>,
        new: &State,
        accelerations: Option<[&[f64]; 2]>,
        within: &mut Within,
    ) -> (Vec<Piece>, f64) {
        let h = new.time - self.state.time;
        if let Quantity::Position(view, axis) = &watch.quantity {
            let of = |scale: f64, vectors: [&[f64]; 2]| vectors.map(|v| scale * view.at_point(v)[*axis]);
            let halves = accelerations.map(|pair| of(0.5 * h * h, pair));
            let (positions, slopes) = (of(1.0, [&self.state.q, &new.q]), of(h, [&self.state.v, &new.v]));
            return (vec![([0.0, 1.0], Polynomial::hermite(positions, slopes, halves))], 0.0);
        }
        // Accelerations are interpolated between the stages of a step, so that forces are smooth in it;
        // and each of their values costs as much as an iteration.
        let halvings = if matches!(watch.quantity, Quantity::OfForces(_)) { 0 } else { HALVINGS };
        let mut largest = 0.0_f64;
        let mut at = |x: f64| {
            let seen = self.value(&watch.quantity, new, x, accelerations, within);
            largest = largest.max(seen.along);
            seen.value
        };
        let (mut pieces, mut open) = (Vec::new(), vec![([0.0, 1.0], halvings)]);
        while let Some(([from, to], halvings)) = open.pop() {
            let place = |x: f64| from + x * (to - from);
            let values = Polynomial::PLACES.map(|x| at(place(x)));
            let polynomial = Polynomial::through(values);
            let (low, high) =
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
            let size = low.abs().max(high.abs());
            let close = (CLOSE * (high - low)).max(NEAR * size);
            let misses = |x: f64| (polynomial.at(x)[0] - at(place(x))).abs() > close;
            if halvings > 0 && size.is_finite() && BETWEEN.into_iter().any(misses) {
                let middle = place(0.5);
                open.extend([([middle, to], halvings - 1), ([from, middle], halvings - 1)]);
            } else {
                pieces.push(([from, to], polynomial));
            }
        }
        (pieces, largest)
    }

    /// A watched quantity at the place `x`, from 0 to 1, of the step to `new`.
    fn value(
        &mut self,
        quantity: &Quantity<'_>,
        new: &State,
        x: f64,
        accelerations: Option<[&[f64]; 2]>,
        within: &mut Within,
    ) -> Observed {
        let time = self.state.time + x * (new.time - self.state.time);
        let between = |start: &State| start.between(new, time, accelerations);
        match quantity {
            Quantity::Position(view, axis) => {
                Observed::at_point(view.at_point(&between(&self.state).q)[*axis])
            }
            Quantity::OfMotion(value) => {
                Observed::at_point(value(at(&mut within.moving, x, || between(&self.state))))
            }
            Quantity::OfForces(value) => {
                let balance = at(&mut within.balanced, x, || {
                    let mut state = between(&self.state);
                    self.settle(&mut state);
                    self.balance_within(new, &state)
                });
                balance.as_ref().map_or(Observed::at_point(f64::NAN), value)
            }
        }
    }
}

/// What is known at a place, or is found there now.
fn at<T>(known: &mut Vec<(f64, T)>, x: f64, find: impl FnOnce() -> T) -> &T {
    let index = known.iter().position(|(place, _)| *place == x).unwrap_or_else(|| {
        known.push((x, find()));
        known.len() - 1
    });
    &known[index].1
}

/// The first and second derivative of a quantity, or of the root of one that is a square, at a place in a step of length `h`.
fn rates(pieces: &[Piece], at: f64, h: f64, is_square: bool) -> [f64; 2] {
    let piece = pieces.iter().find(|([_, to], _)| at <= *to).or(pieces.last());
    let Some(([from, to], piece)) = piece else { return [0.0; 2] };
    let (x, h) = ((at - from) / (to - from), h * (to - from));
    let [value, slope] = piece.at(x);
    let [first, second] = [slope / h, piece.derivative().at(x)[1] / (h * h)];
    if !is_square {
        return [first, second];
    }
    let root = value.max(0.0).sqrt();
    let of_root = first / (2.0 * root);
    [of_root, (0.5 * second - of_root * of_root) / root]
}

/// Where the quantity reaches `value`, and the value. What is nearer to it than `near` is at it.
fn reached(pieces: &[Piece], value: f64, crossing: Crossing, near: f64, memory: &Watched) -> Vec<(f64, f64)> {
    let wanted = |rising: bool| match crossing {
        Crossing::Any => true,
        Crossing::Rising => rising,
        Crossing::Falling => !rising,
    };
    let mut found = Vec::new();
    // Forces may jump from one step to the next.
    let start = pieces.first().map_or(value, |(_, piece)| piece.at(0.0)[0]);
    let jumped = memory.value.filter(|before| {
        (before - value).abs() > near && (start - value).abs() > near && (before < &value) == (start > value)
    });
    if jumped.is_some_and(|before| wanted(before < value)) {
        found.push((0.0, value));
    }
    for ([from, to], piece) in pieces {
        let events = piece.less(value).reaches_zero(near).into_iter().filter(|event| wanted(event.rising));
        found.extend(events.map(|event| (from + event.at * (to - from), value)));
    }
    found
}

/// Where the quantity times `sign` begins to fall after what is `watched` of it has risen by more than `near`, and its
/// values there.
fn turned(
    pieces: &[Piece],
    sign: f64,
    near: f64,
    memory: &mut Watched,
    watched: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for ([from, to], piece) in pieces {
        let start = piece.at(0.0)[0];
        let mut reference = memory.turned.unwrap_or(start);
        let mut slope = memory.slope;
        let turns = piece.turns_back(&mut slope);
        // Before its last turn it had the slope from which the memory started, or the opposite one.
        let mut rising = memory.slope;
        if rising == 0.0 {
            rising = if turns.len() % 2 == 0 { slope } else { -slope };
        }
        for at in turns {
            let value = piece.at(at)[0];
            let change = watched(value) - watched(reference);
            if change * rising > near {
                reference = value;
                if rising == sign {
                    found.push((from + at * (to - from), value));
                }
            }
            rising = -rising;
        }
        (memory.slope, memory.turned) = (slope, Some(reference));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: &[(f64, f64)], expected: &[(f64, f64)]) {
        let close = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9;
        assert!(
            found.len() == expected.len() && found.iter().zip(expected).all(close),
            "{found:?} {expected:?}"
        );
    }

    fn same(value: f64) -> f64 {
        value
    }

    /// x³/3 − x²/2 + 3x/16 rises to 1/48 at ¼ and falls to 0 at ¾, from where it rises again.
    fn wave() -> Polynomial {
        Polynomial::hermite([0.0, 1.0 / 48.0], [3.0 / 16.0; 2], None)
    }

    #[test]
    fn maxima_and_minima_are_those_of_a_wave() {
        let pieces = [([0.5, 1.0], wave())];
        let (high, low) = (1.0 / 48.0, 0.0);
        for (sign, near_to, expected) in [
            (1.0, 1e-9, &[(0.625, high)][..]),
            (-1.0, 1e-9, &[(0.875, low)]),
            (1.0, 0.02, &[(0.625, high)]),
            // Waves that are lower than that are none.
            (1.0, 0.021, &[]),
            (-1.0, 0.021, &[]),
        ] {
            near(&turned(&pieces, sign, near_to, &mut Watched::default(), same), expected);
        }
        // What was falling before has turned at the border, and comes from the value that is
        // remembered.
        let mut memory = Watched { slope: -1.0, turned: Some(1.0), ..Watched::default() };
        near(&turned(&pieces, -1.0, 1e-9, &mut memory, same), &[(0.5, 0.0), (0.875, low)]);
        assert_eq!(memory.slope, 1.0);
        assert!(memory.turned.is_some_and(|value| value.abs() < 1e-9), "{memory:?}");
        // A line has no turn; two pieces may have one where they meet.
        let line = |from: f64, to: f64| Polynomial::hermite([from, to], [to - from; 2], None);
        near(&turned(&[([0.0, 1.0], line(0.0, 1.0))], 1.0, 1e-9, &mut Watched::default(), same), &[]);
        let peak = [([0.0, 0.25], line(0.0, 1.0)), ([0.25, 1.0], line(1.0, 0.5))];
        near(&turned(&peak, 1.0, 1e-9, &mut Watched::default(), same), &[(0.25, 1.0)]);
        near(&turned(&peak, -1.0, 1e-9, &mut Watched::default(), same), &[]);
    }

    #[test]
    fn values_are_reached_within_pieces_and_by_jumps() {
        let line = |from: f64, to: f64| Polynomial::hermite([from, to], [to - from; 2], None);
        let up = [([0.5, 1.0], line(-1.0, 3.0))];
        let of = |pieces: &[Piece], value: f64, crossing: Crossing, before: Option<f64>| {
            let memory = Watched { value: before, ..Watched::default() };
            reached(pieces, value, crossing, 1e-3, &memory)
        };
        near(&of(&up, 1.0, Crossing::Any, None), &[(0.75, 1.0)]);
        near(&of(&up, 1.0, Crossing::Rising, Some(-1.0)), &[(0.75, 1.0)]);
        near(&of(&up, 1.0, Crossing::Falling, None), &[]);
        let down = [([0.0, 1.0], line(3.0, -1.0))];
        near(&of(&down, 1.0, Crossing::Falling, None), &[(0.5, 1.0)]);
        near(&of(&down, 1.0, Crossing::Rising, None), &[]);
        // A force that stood below 1 before, and begins at 3.
        let above = [([0.0, 1.0], line(3.0, 3.5))];
        near(&of(&above, 1.0, Crossing::Any, Some(0.5)), &[(0.0, 1.0)]);
        near(&of(&above, 1.0, Crossing::Rising, Some(0.5)), &[(0.0, 1.0)]);
        near(&of(&above, 1.0, Crossing::Falling, Some(0.5)), &[]);
        near(&of(&above, 1.0, Crossing::Any, Some(2.0)), &[]);
        near(&of(&above, 1.0, Crossing::Any, None), &[]);
        // From above, and from a value or to one that is nearly reached.
        near(&of(&above, 4.0, Crossing::Falling, Some(5.0)), &[(0.0, 4.0)]);
        near(&of(&above, 1.0, Crossing::Any, Some(0.9995)), &[]);
        near(&of(&above, 2.9995, Crossing::Any, Some(0.5)), &[]);
    }
}
