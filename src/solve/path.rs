//! Following a path of equilibria: predictor, step control, and the detection of instabilities.
//!
//! Points of the path are functions of a parameter t, the load factor or the arc length. The next
//! point is predicted by going on along the path's tangent, which costs one substitution, and
//! corrected by Newton's method. The step is controlled by the *turn of the corrector*: the largest
//! change of a nodal gradient between predicted and corrected state, which is an angle in radians
//! for slender beams whatever their size. The predictor errs by O(h²), so that the step for a
//! wanted turn follows at once. A step whose corrector turns too far is redone smaller even though
//! it converged: a solution that far from the prediction may lie on another branch. If already the
//! first correction is that large, the step is refused before it is followed, and the correction
//! tells how much shorter the next one has to be.
//!
//! States are moved along tangents and increments with finite turns ([`super::retraction`]), so
//! that one step may turn a tip by a whole turn: a straight cantilever takes one step and three
//! iterations to a full circle. Increments that are added would allow steps of 0.8 rad and take
//! nine of them.
//!
//! A step is redone, too, if the tangents at its two ends do not explain it. On a smooth path the
//! trapezoidal rule for the angles of the nodes, φ₁ ≈ φ₀ + ½h (φ̇₀ + φ̇₁), errs by O(h³) and thus
//! by a fraction of the corrector's own O(h²), or of the step's turn where the corrector turns
//! little. A step to another branch differs from the rule by the whole jump. With this check twelve
//! thousand random cantilevers end where two hundred small steps end. Only a mesh of few cable
//! elements that locks under full quadrature may still fail, because it has branches of its own
//! within a step.
//!
//! Where beams slide without turning, shifts in beam lengths take the place of turns.
//!
//! A step that passes no limit point and yet ends in an unstable equilibrium is redone smaller too,
//! and so is one that turns the nodes against the prediction. The path of an imperfect column bends
//! away from its critical load and stays stable. A long step may end on the unstable path beside
//! it, or on the branch that bends to the other side, although its corrector turns little. Only
//! where ever smaller steps lose stability as well is the path itself unstable; it is then followed
//! further, with a warning.
//!
//! Where a contact closes or a law has a corner, a path by arc length has a kink, at which it may turn
//! by more than a right angle (`kink.rs`).
//!
//! Predictors by polynomials through the last points, with and without the tangents there, were
//! rejected: their corrections are smaller, but Newton's method takes as many iterations a step,
//! and the first steps, which have no past to extrapolate, decide on the cost.

mod closed;
mod ends;
mod hidden;
mod kink;

pub use closed::comes_back;

use super::equilibrium::{AcrossPath, AtLoad, Equilibrium};
use super::newton::{self, Failure, Iterations, Settings};
use super::stability::{Stability, StabilityChange};
use crate::assembly::{Earlier, Node, nodes};
use crate::lanes::{cross, dot};
use crate::solve::StepRecord;
use std::f64::consts::TAU;

/// An equilibrium on the path.
#[derive(Clone, Debug)]
pub struct Point {
    /// Load factor or arc length.
    pub parameter: f64,
    /// Load factor.
    pub load: f64,
    /// Coordinates and multipliers.
    pub x: Vec<f64>,
    /// Its stability, where the factorisation tells.
    pub stability: Option<Stability>,
    /// Directions in which the symmetric part of the tangent lacks stiffness, where the sign of the
    /// determinant alone tells of stability.
    pub soft: Option<usize>,
    /// The path's tangent (dx/dt, dλ/dt); empty where it is not known.
    pub rate: Vec<f64>,
}

impl Point {
    /// The load factor's rate dλ/dt along the path.
    pub fn load_rate(&self) -> f64 {
        self.rate.last().copied().unwrap_or_default()
    }

    /// Turns its tangent to the other side.
    fn turn_round(&mut self) {
        self.rate.iter_mut().for_each(|rate| *rate = -*rate);
    }
}

/// The parameter of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Parameter {
    /// The load factor, which is prescribed.
    Load,
    /// The arc length in the scaled space of states and load factors. The load factor counts in parts of `loads`, the largest
    /// that is of interest, or of the largest that the path has reached, where that is beyond; and where the structure yields more
    /// at first, so that it counts no less than the shape there. Where `loads` follows from a load that ends the path, what that
    /// finds does not depend on the unit of loads.
    ArcLength {
        /// \[1\]
        loads: f64,
    },
}

/// How often the part of a step in which stability changes is halved at most …
const HALVINGS: u32 = 20;
/// … and the part of its load factor to which it is: nearer to a singular tangent round-off decides.
const SEPARATE: f64 = 1e-7;
/// Points kept: enough for the vertex of a parabola.
const MEMORY: usize = 3;
/// Turn of the corrector that the step control aims at \[rad\].
const WANTED_TURN: f64 = 0.25;
/// Turn of the corrector beyond which a converged step is not trusted \[rad\].
const LARGEST_TURN: f64 = 0.5;
/// Part of the corrector's turn that the tangents at both ends of a step may leave unexplained.
const UNEXPLAINED_PART: f64 = 0.5;
/// Unexplained turn that is never refused \[rad\]: near an inflection of the path the corrector's
/// own turn vanishes.
const UNEXPLAINED_TURN: f64 = 0.02;
/// The same as a part of the step's predicted turn: for a whole turn as much as
/// [`UNEXPLAINED_PART`] allows the wanted turn of the corrector.
const UNEXPLAINED_OF_STEP: f64 = 0.02;
/// Largest predicted turn of any node in one step \[rad\], with finite turns and with increments
/// that are added.
const LARGEST_STEP: (f64, f64) = (7.0, 0.8);
/// The same where the path between two points matters, as it does for contacts and for torsion
/// springs.
const BY_SMALL_STEPS: f64 = 0.5;
/// Beams whose shifts, in beam lengths, are more than so many times their turns only slide.
const SLIDING: f64 = 10.0;
/// A corrector that turns no node by more than this, and by less than was predicted, stays on its
/// side of a bifurcation \[rad\].
const SURE_TURN: f64 = 0.05;
/// A point so many steps away on the plane across the path, where that turns by 120° within a step, may be one that the path
/// comes to later.
const FAR_ACROSS: f64 = 2.0;
/// Turns of the corrector below this are round-off \[rad\].
const STILL: f64 = 1e-10;
/// A rate that is below this part of that at the end of a step is that of a turning point, where the step before has ended.
const LEAVES_TURN: f64 = 1e-4;
/// Smallest step, relative to the first one that was to be tried.
const SMALLEST_STEP: f64 = 1e-9;
/// Steps below this part of the first one in succession, with longer ones that fail between them, …
const CREEPING: f64 = 1e-6;
/// … of which so many lead nowhere.
const MOST_CREEPING: usize = 300;
/// Part of a failed step that is tried next.
const SHORTER: f64 = 0.4;
/// Smallest step in place of one that is taken back, relative to the first one that was to be tried.
const SHORTEST_AGAIN: f64 = 1e-3;
/// A step of this size in which stability is lost is accepted. The knee of an imperfect path is
/// about as wide as the imperfection to the power of 2/3 (Koiter), so that only knees of
/// imperfections below 1e-7 are mistaken for bifurcations.
const BELIEVED_STEP: f64 = 1e-5;
/// Before this load factor it is smaller, by its third power down to the same part of it: so early a critical load is as near, and so is
/// the knee beside it.
const EARLY: f64 = 1e-3;

/// Why a path could not be followed.
#[derive(Clone, Debug, PartialEq)]
pub struct NoStep {
    /// Load factor of the last equilibrium.
    pub load: f64,
    /// The smallest step tried.
    pub step: f64,
    /// What went wrong with it.
    pub failure: Failure,
    /// Arc length \[m\] along beam `beam` at which the last iterate changed most.
    pub at: (usize, f64),
}

/// A path under construction.
pub struct Path<'e, 'a> {
    /// The equations.
    pub equilibrium: &'e mut Equilibrium<'a>,
    settings: Settings,
    parameter: Parameter,
    points: Vec<Point>,
    step: f64,
    first_step: f64,
    /// How many steps in succession were so short that they lead nowhere, and why the last longer one failed.
    crept: usize,
    refused: Option<(Failure, (usize, f64))>,
    /// The largest load factor that is of interest, or that was reached.
    loads: f64,
    /// Change of the load factor by which the structure yields by one beam length at first.
    yields: f64,
    /// Change of the load factor that counts as one beam length in the arc length.
    load_scale: f64,
    /// A doubtful equilibrium ahead, from the shortest step that led to one, with its corrector's
    /// turn.
    crossing: Option<(Point, f64)>,
    /// Attempted steps so far.
    pub history: Vec<StepRecord>,
    /// Load factor at which several directions lost their stiffness within one step, and the
    /// determinant kept its sign.
    pub softened: Option<f64>,
}

impl<'e, 'a> Path<'e, 'a> {
    /// Starts in the state `x` at load factor 0; `step` is the first step to try. A state that another
    /// analysis has left is an equilibrium to the tolerance of that analysis only, and made one to
    /// that of this path.
    pub fn new(
        equilibrium: &'e mut Equilibrium<'a>,
        parameter: Parameter,
        settings: Settings,
        step: f64,
        mut x: Vec<f64>,
    ) -> Result<Self, NoStep> {
        let n = equilibrium.system().coordinates();
        equilibrium.system().supports().impose(0.0, &mut x[..n]);
        if equilibrium.system().is_taken_up() {
            let (mut exact, still) = (x.clone(), vec![0.0; x.len()]);
            let from = Earlier { q: &x, increment: &still };
            let mut equations = AtLoad::new(equilibrium, 0.0);
            let found =
                newton::solve(&mut equations, &mut exact, from, &settings, &mut Iterations::default());
            let change: Vec<f64> = exact.iter().zip(&x).map(|(exact, x)| exact - x).collect();
            if found.is_ok() && equilibrium.size(&change) < SURE_TURN {
                x = exact;
            }
        }
        equilibrium.set_accepted(&x);
        let start = Point { parameter: 0.0, load: 0.0, x, stability: None, soft: None, rate: Vec::new() };
        let loads = match parameter {
            Parameter::Load => 1.0,
            Parameter::ArcLength { loads } => loads,
        };
        let mut path = Self {
            equilibrium,
            settings: Settings { first_increment: LARGEST_TURN, ..settings },
            parameter,
            points: vec![start],
            step,
            first_step: step,
            crept: 0,
            refused: None,
            loads,
            yields: f64::INFINITY,
            load_scale: loads,
            crossing: None,
            history: Vec::new(),
            softened: None,
        };
        path.set_out()?;
        Ok(path)
    }

    /// The last equilibrium.
    pub fn last(&self) -> &Point {
        &self.points[self.points.len() - 1]
    }

    /// The last two equilibria.
    pub fn last_two(&self) -> Option<[&Point; 2]> {
        match &self.points[..] {
            [.., a, b] => Some([a, b]),
            _ => None,
        }
    }

    /// The change of stability within the last step from what it was `before` to what it is `after`: by bisection, or where a limit point
    /// within the step could not be made an end, the vertex of the parabola through the last three points, if it lies between them.
    pub fn change(&mut self, before: Stability, after: Stability) -> StabilityChange {
        let [load, resolution] = self.load_of_change(before);
        StabilityChange { load, resolution, before, after }
    }

    /// The load factor of a change of stability within the last step, and by how much it may be another one.
    fn load_of_change(&mut self, before: Stability) -> [f64; 2] {
        let [.., b, c] = &self.points[..] else { return [self.last().load, f64::INFINITY] };
        if !turns_within([b, c].map(Point::load_rate)) {
            let mut bracket = [b.load, c.load];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (bracket[0] + bracket[1]);
                if (bracket[1] - bracket[0]).abs() < SEPARATE * middle.abs() {
                    break;
                }
                match self.between(middle).and_then(|point| point.stability) {
                    Some(here) if !before.differs(here) => bracket[0] = middle,
                    Some(_) => bracket[1] = middle,
                    None => break,
                }
            }
            return [0.5 * (bracket[0] + bracket[1]), 0.5 * (bracket[1] - bracket[0]).abs()];
        }
        let whole = (c.load - b.load).abs();
        let [.., a, b, c] = &self.points[..] else { return [c.load, whole] };
        let slope = |p: &Point, q: &Point| (q.load - p.load) / (q.parameter - p.parameter);
        let (first, second) = (slope(a, b), slope(b, c));
        let bend = (second - first) / (c.parameter - a.parameter);
        let vertex = 0.5 * (a.parameter + b.parameter) - 0.5 * first / bend;
        if (a.parameter..=c.parameter).contains(&vertex) {
            let load = a.load
                + first * (vertex - a.parameter)
                + bend * (vertex - a.parameter) * (vertex - b.parameter);
            [load, (load - b.load).abs().min((load - c.load).abs())]
        } else {
            [c.load, whole]
        }
    }

    /// The step that will be tried next.
    pub fn next_step(&self) -> f64 {
        self.step
    }

    /// Follows the path to the other side of its start, before the first step.
    pub fn turn_round(&mut self) {
        if let [start] = &mut self.points[..] {
            start.turn_round();
        }
    }

    /// Limits the next step: of a load factor, or of an arc length in which load factors count in parts of those that are of
    /// interest.
    pub fn limit_step(&mut self, largest: f64) {
        let of_step = match self.parameter {
            Parameter::Load => 1.0,
            Parameter::ArcLength { .. } => self.size(&self.last().rate, self.loads),
        };
        self.step = self.step.min(largest / of_step);
    }

    /// Takes one step to a new equilibrium, not beyond the parameter `end`, shortened as often as
    /// needed.
    ///
    /// # Errors
    /// [`NoStep`] where no step converges.
    pub fn advance(&mut self, end: f64) -> Result<&Point, NoStep> {
        self.count_loads();
        let last = &self.points[self.points.len() - 1];
        self.equilibrium.set_accepted(&last.x);
        let here = self.last().parameter;
        loop {
            // No sliver is left before the end.
            let left = end - here;
            let mut step = self.step.min(left);
            if step > 0.5 * left && step < left {
                step = 0.5 * left;
            }
            let turn = self.predicted_turn(step);
            let (turned, added) = LARGEST_STEP;
            let system = self.equilibrium.system();
            let by_small_steps = system.has_contacts() || system.has_windings();
            let largest = match (by_small_steps, self.equilibrium.retraction.turns()) {
                (true, _) => BY_SMALL_STEPS,
                (false, true) => turned,
                (false, false) => added,
            };
            if turn > largest {
                self.step = step * (0.95 * largest / turn);
                step = self.step;
            }
            let increment = self.increment(step);
            let target = if step >= left { end } else { here + step };
            let corrected = match self.correct(&increment, target, step) {
                Ok((mut point, turn)) => {
                    if self.loses_stability(&point) {
                        self.judge_again(&mut point);
                    }
                    let doubtful = self.loses_stability(&point)
                        || turn > SURE_TURN.min(self.predicted_turn(step)).max(STILL)
                            && self.turns_back(&point, &increment)
                        || self.parameter != Parameter::Load && point.parameter - here > FAR_ACROSS * step
                        || self.passes_more_than_a_limit(&point)
                        || self.crosses_twice(&point);
                    if doubtful && step > self.believed_step(target) {
                        if let Some(record) = self.history.last_mut() {
                            record.accepted = false;
                        }
                        let at = self.worst(&point.x, &self.last().x);
                        self.crossing = Some((point, turn));
                        Err((Failure::Bifurcation, at))
                    } else {
                        Ok((point, turn))
                    }
                }
                failed => failed,
            };
            match corrected {
                Ok((point, turn)) => {
                    let creeps = self.parameter == Parameter::Load && step < CREEPING * self.first_step;
                    self.crept = if creeps { self.crept + 1 } else { 0 };
                    if self.crept > MOST_CREEPING
                        && let Some((failure, at)) = self.refused
                    {
                        return Err(NoStep { load: self.last().load, step, failure, at });
                    }
                    return Ok(self.accept(point, step, turn));
                }
                Err((failure, at)) => {
                    self.refused = Some((failure, at));
                    self.equilibrium.statistics.rejected_steps += 1;
                    self.step = step
                        * match failure {
                            // The predictor errs by O(h²).
                            Failure::FarOff { size } => (WANTED_TURN / size).sqrt().clamp(0.05, 0.4),
                            _ => SHORTER,
                        };
                    if let Some((point, turn)) = self.through_kink(step) {
                        return Ok(self.accept(point, step, turn));
                    }
                    if self.step >= SMALLEST_STEP * self.first_step {
                        continue;
                    }
                    // Close to a singular tangent no step may converge, although the doubtful one
                    // beyond it did.
                    match self.crossing.take() {
                        Some((point, turn)) if point.parameter > here => {
                            self.step = point.parameter - here;
                            return Ok(self.accept(point, self.step, turn));
                        }
                        _ => return Err(NoStep { load: self.last().load, step, failure, at }),
                    }
                }
            }
        }
    }

    /// Lets load factors count in parts of the largest that was reached. Otherwise a path to loads that are many times those of the
    /// scene would be one of prescribed loads, which jumps where these turn back.
    fn count_loads(&mut self) {
        let reached = self.last().load.abs();
        if self.parameter == Parameter::Load || reached <= self.loads {
            return;
        }
        self.loads = reached;
        self.load_scale = reached.min(self.yields);
        let length = self.dot(&self.last().rate, &self.last().rate).sqrt();
        self.step *= length;
        self.first_step *= length;
        let Some((last, before)) = self.points.split_last_mut() else { return };
        last.rate.iter_mut().for_each(|rate| *rate /= length);
        for point in before {
            point.parameter = last.parameter - length * (last.parameter - point.parameter);
            point.rate.iter_mut().for_each(|rate| *rate /= length);
        }
    }

    /// Adds a point that a step led to, and chooses the next step.
    fn accept(&mut self, point: Point, step: f64, turn: f64) -> &Point {
        let factor = (WANTED_TURN / turn.max(1e-12)).sqrt();
        self.step = self.step.max(step) * factor.clamp(0.4, 2.5);
        let told =
            self.last().stability.zip(point.stability).is_some_and(|(before, after)| before.differs(after));
        if !told && softens(self.last(), &point) {
            self.softened = self.softened.or(Some(point.load));
        }
        self.points.push(point);
        if self.points.len() > MEMORY {
            self.points.remove(0);
        }
        self.equilibrium.statistics.steps += 1;
        self.equilibrium.statistics.load_steps += 1;
        self.last()
    }

    /// Takes the last step back, to try a shorter one in its place; returns whether it could be shorter.
    pub fn take_back(&mut self) -> bool {
        let Some(record) = self.history.last_mut() else { return false };
        let step = SHORTER * record.step;
        if step < SHORTEST_AGAIN * self.first_step {
            return false;
        }
        record.accepted = false;
        self.step = step;
        self.points.pop();
        let counts = &mut self.equilibrium.statistics;
        counts.steps -= 1;
        counts.load_steps -= 1;
        counts.rejected_steps += 1;
        true
    }

    /// A step to this end in which stability is lost is accepted where it is no longer.
    fn believed_step(&self, target: f64) -> f64 {
        match self.parameter {
            Parameter::Load => BELIEVED_STEP * (target.abs() / EARLY).powi(3).clamp(EARLY, 1.0),
            _ => BELIEVED_STEP,
        }
    }

    /// Whether a point is less stable than the last one although no limit point of the load lies
    /// between them.
    fn loses_stability(&self, point: &Point) -> bool {
        let last = self.last();
        let along = |rate: &[f64]| rate.last().is_some_and(|load| *load > 0.0);
        let (Some(before), Some(after)) = (last.stability, point.stability) else { return false };
        before.is_lost(after) && along(&last.rate) == along(&point.rate)
    }

    /// Whether nodes turn the other way than `increment` foretells, as on the mirrored branch of a column.
    fn turns_back(&self, point: &Point, increment: &[f64]) -> bool {
        if self.parameter != Parameter::Load {
            return false;
        }
        let predicted = self.predict(increment, point.load).x;
        let n = self.equilibrium.system().coordinates();
        let gradients = |x: &'_ [f64]| nodes(&x[..n]).map(|node| node.gradient).collect::<Vec<_>>();
        let [here, there, wanted] = [&self.last().x[..], &point.x, &predicted].map(gradients);
        let angle = |from: [f64; 2], to: [f64; 2]| cross(from, to).atan2(dot(from, to));
        let turns = here.iter().zip(there).zip(wanted);
        let along: f64 = turns.map(|((from, to), wanted)| angle(*from, to) * angle(*from, wanted)).sum();
        along < 0.0
    }

    /// Determines stability at the point itself: near a critical load the last increment may still
    /// have changed the sign.
    fn judge_again(&mut self, point: &mut Point) {
        let mut scratch = vec![0.0; point.x.len()];
        let mut rate = scratch.clone();
        if self.equilibrium.linearize(point.load, &point.x, None, &mut scratch, &mut rate).is_ok() {
            point.stability = self.equilibrium.stability();
        }
    }

    /// Stability and the path's tangent at the start.
    fn set_out(&mut self) -> Result<(), NoStep> {
        let n = self.equilibrium.unknowns();
        let Point { load, x, .. } = self.points[0].clone();
        let mut rate = vec![0.0; n];
        self.equilibrium.linearize(load, &x, None, &mut vec![0.0; n], &mut rate).map_err(|singular| {
            NoStep {
                load,
                step: 0.0,
                failure: singular.into(),
                at: self.equilibrium.system().place_of(singular.row),
            }
        })?;
        self.equilibrium.solve(load, &mut rate, true);
        if let Some(unknown) = rate.iter().position(|rate| !rate.is_finite()) {
            let at = self.equilibrium.system().place_of(unknown);
            return Err(NoStep { load, step: 0.0, failure: Failure::NotFinite, at });
        }
        rate.push(1.0);
        if self.parameter != Parameter::Load {
            self.yields = 1.0 / self.size(&rate, f64::INFINITY);
            self.load_scale = self.loads.min(self.yields);
            rate = self.along(rate, None);
        }
        (self.points[0].stability, self.points[0].soft) = self.equilibrium.stability_and_softness();
        self.points[0].rate = rate;
        Ok(())
    }

    /// ⟨a, b⟩ over (x, λ): mean square of nodal changes, positions in beam lengths, plus that of the load
    /// factor.
    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.weights(a, self.load_scale).iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// Length of a change of (x, λ) where load factors count in parts of `load_scale`.
    fn size(&self, change: &[f64], load_scale: f64) -> f64 {
        self.weights(change, load_scale).iter().zip(change).map(|(a, b)| a * b).sum::<f64>().sqrt()
    }

    /// The unit vector along ±`rate` on the side of `direction`, if one is given.
    fn along(&self, mut rate: Vec<f64>, direction: Option<&[f64]>) -> Vec<f64> {
        let length = self.dot(&rate, &rate).sqrt();
        let backward = direction.is_some_and(|direction| self.dot(&rate, direction) < 0.0);
        let factor = if backward { -1.0 / length } else { 1.0 / length };
        rate.iter_mut().for_each(|r| *r *= factor);
        rate
    }

    fn weights(&self, v: &[f64], load_scale: f64) -> Vec<f64> {
        let system = self.equilibrium.system();
        let n = system.coordinates();
        let nodes = (n / 4) as f64;
        let inverse = system.length().powi(-2) / nodes;
        let mut weighted: Vec<f64> = v.to_vec();
        for (i, w) in weighted.iter_mut().enumerate() {
            *w *= match i {
                _ if i + 1 == v.len() => load_scale.powi(-2),
                _ if i >= n => 0.0,
                _ if i % 4 < 2 => inverse,
                _ => 1.0 / nodes,
            };
        }
        weighted
    }

    /// The point to which `increment` leads from the last one.
    fn predict(&self, increment: &[f64], parameter: f64) -> Point {
        let Point { mut x, load, rate, .. } = self.last().clone();
        let (of_load, of_x) = increment.split_last().unwrap_or((&0.0, &[]));
        self.equilibrium.retraction.apply(of_x, &mut x);
        let load = if self.parameter == Parameter::Load { parameter } else { load + of_load };
        let n = self.equilibrium.system().coordinates();
        self.equilibrium.system().supports().impose(load, &mut x[..n]);
        Point { parameter, load, x, stability: None, soft: None, rate }
    }

    /// The increment of (x, λ) in a step of length `h` along the tangent.
    fn increment(&self, h: f64) -> Vec<f64> {
        self.last().rate.iter().map(|rate| h * rate).collect()
    }

    /// Largest turn of a node in a step of length `h` along the tangent \[rad\].
    fn predicted_turn(&self, h: f64) -> f64 {
        let n = self.equilibrium.system().coordinates();
        nodes(&self.last().rate[..n]).map(|rate| h.abs() * rate.slope()).fold(0.0, f64::max)
    }

    /// Largest change of a nodal gradient between two states.
    fn turn(&self, a: &[f64], b: &[f64]) -> f64 {
        let n = self.equilibrium.system().coordinates();
        turns(&a[..n], &b[..n]).fold(0.0, f64::max)
    }

    /// Largest shift of a node between two states, in beam lengths.
    fn shift(&self, a: &[f64], b: &[f64]) -> f64 {
        let n = self.equilibrium.system().coordinates();
        let shifts = nodes(&a[..n]).zip(nodes(&b[..n])).map(|(a, b)| {
            let ([ax, ay], [bx, by]) = (a.position, b.position);
            (bx - ax).hypot(by - ay)
        });
        shifts.fold(0.0, f64::max) / self.equilibrium.system().length()
    }

    /// Whether beams move between two states without turning, so that turns tell nothing of the step.
    fn slides(&self, a: &[f64], b: &[f64]) -> bool {
        self.shift(a, b) > SLIDING * self.turn(a, b)
    }

    /// What is left of the largest shift of a node between two points \[beam lengths\] that the trapezoidal rule does not lead to,
    /// with the rates at both; 0 where one is unknown.
    fn unexplained_shift(&self, from: &Point, to: &Point) -> f64 {
        let half = 0.5 * (to.parameter - from.parameter);
        let n = self.equilibrium.system().coordinates();
        if from.rate.len() < n || to.rate.len() < n {
            return 0.0;
        }
        let rates = from.rate.iter().zip(&to.rate).map(|(a, b)| half * (a + b));
        let led: Vec<f64> = from.x.iter().zip(rates).map(|(x, by)| x + by).collect();
        self.shift(&led, &to.x)
    }

    /// Largest angle between a gradient of `to` and the one to which the trapezoidal rule leads
    /// from `from`, with the turning rates at both; 0 where one is unknown.
    fn unexplained(&self, from: &Point, to: &Point) -> f64 {
        let half = 0.5 * (to.parameter - from.parameter);
        let n = self.equilibrium.system().coordinates();
        if from.rate.len() < n || to.rate.len() < n {
            return 0.0;
        }
        let turning_nodes = |point: &'_ Point| {
            let pairs = nodes(&point.x[..n]).zip(nodes(&point.rate[..n]));
            pairs.map(|(x, rate)| (x.gradient, rate.gradient)).collect::<Vec<_>>()
        };
        let turning = |(g, rate): ([f64; 2], [f64; 2])| cross(g, rate) / dot(g, g);
        let pairs = turning_nodes(from).into_iter().zip(turning_nodes(to));
        pairs.fold(0.0, |largest: f64, (a, b)| {
            let turned = cross(a.0, b.0).atan2(dot(a.0, b.0));
            let missed = turned - half * (turning(a) + turning(b));
            largest.max((missed - TAU * (missed / TAU).round()).abs())
        })
    }

    /// The equilibrium at the load factor `target`, or on the plane through the point to which `increment` leads from the last
    /// one, across it; and by how much it has turned against that point.
    fn correct(
        &mut self,
        increment: &[f64],
        target: f64,
        step: f64,
    ) -> Result<(Point, f64), (Failure, (usize, f64))> {
        let mut record = Iterations::default();
        let before = self.last().clone();
        let predicted = self.predict(increment, target);
        let mut point = predicted.clone();
        let result = match self.parameter {
            Parameter::Load => {
                point.load = target;
                let mut equations = AtLoad::new(self.equilibrium, target);
                let start = Earlier { q: &before.x, increment };
                let result = newton::solve(&mut equations, &mut point.x, start, &self.settings, &mut record);
                // A tangent that could not be factorised gives none.
                if result.is_ok() {
                    point.rate = equations.rate();
                }
                result
            }
            Parameter::ArcLength { .. } => {
                let mut direction: Vec<f64> = point.x.iter().zip(&before.x).map(|(a, b)| a - b).collect();
                direction.push(point.load - before.load);
                let length = self.dot(&direction, &direction).sqrt();
                direction.iter_mut().for_each(|d| *d /= length);
                let normal = self.weights(&direction, self.load_scale);
                let mut x = std::mem::take(&mut point.x);
                x.push(point.load);
                let mut start = before.x.clone();
                start.push(before.load);
                let mut equations = AcrossPath::new(self.equilibrium, normal, self.load_scale);
                let start = Earlier { q: &start, increment };
                let result = newton::solve(&mut equations, &mut x, start, &self.settings, &mut record);
                let rate = result.is_ok().then(|| equations.rate());
                point.load = x.pop().unwrap_or(before.load);
                point.x = x;
                let mut change: Vec<f64> = point.x.iter().zip(&before.x).map(|(a, b)| a - b).collect();
                change.push(point.load - before.load);
                point.parameter = before.parameter + self.dot(&change, &change).sqrt();
                if let Some(rate) = rate {
                    point.rate = self.along(rate, Some(&change));
                }
                result
            }
        };
        if self.parameter == Parameter::Load {
            point.parameter = target;
        }
        let slides = self.slides(&before.x, &point.x);
        let (turn, unexplained, predicted_turn) = if slides {
            let predicted_shift = self.shift(&before.x, &predicted.x);
            (self.shift(&point.x, &predicted.x), self.unexplained_shift(&before, &point), predicted_shift)
        } else {
            let predicted_turn = self.predicted_turn(step);
            (self.turn(&point.x, &predicted.x), self.unexplained(&before, &point), predicted_turn)
        };
        let explained = UNEXPLAINED_OF_STEP * predicted_turn;
        let jump = unexplained > UNEXPLAINED_TURN.max(UNEXPLAINED_PART * turn).max(explained);
        let outcome = match result {
            Ok(()) if turn > LARGEST_TURN || jump => {
                let unit = if slides { "beam lengths" } else { "rad" };
                Err((
                    Failure::OtherBranch { off: turn.max(unexplained), unit },
                    self.worst(&point.x, &predicted.x),
                ))
            }
            Ok(()) => {
                let n = self.equilibrium.system().coordinates();
                let since = if self.equilibrium.retraction.turns() { &predicted } else { &before };
                newton::not_crushed_since(&since.x[..n], &point.x[..n])
                    .and_then(|()| self.not_crossed(&before, &point))
                    .map(|()| turn)
                    .map_err(|failure| (failure, self.worst(&point.x, &predicted.x)))
            }
            Err(failure) => Err((failure, self.worst(&point.x, &predicted.x))),
        };
        let outcome = outcome.map_err(|(failure, worst)| {
            let place = failure.unknown().map(|unknown| self.equilibrium.system().place_of(unknown));
            (failure, place.unwrap_or(worst))
        });
        self.history.push(StepRecord {
            parameter: point.load,
            step,
            accepted: outcome.is_ok(),
            increments: record.increments,
            residuals: record.residuals,
        });
        let turn = outcome?;
        (point.stability, point.soft) = self.equilibrium.stability_and_softness();
        if self.goes_back(&before, &point) {
            point.turn_round();
        }
        Ok((point, turn))
    }

    /// Refuses a step that leads through an obstacle, on the cubic with the rates at both ends.
    fn not_crossed(&self, before: &Point, point: &Point) -> Result<(), Failure> {
        let system = self.equilibrium.system();
        if !system.has_contacts() {
            return Ok(());
        }
        let n = system.coordinates();
        let third = (point.parameter - before.parameter) / 3.0;
        let moved = |point: &Point, by: f64| -> Vec<f64> {
            point.x[..n].iter().zip(&point.rate).map(|(x, rate)| x + by * rate).collect()
        };
        let (first, second) = (moved(before, third), moved(point, -third));
        match system.conflict([&before.x[..n], &first, &second, &point.x[..n]], false) {
            Some((part, contact)) => Err(Failure::Crossed { contact, part }),
            None => Ok(()),
        }
    }

    /// Beam and arc length of the node that changed most.
    fn worst(&self, a: &[f64], b: &[f64]) -> (usize, f64) {
        let n = self.equilibrium.system().coordinates();
        let node = turns(&a[..n], &b[..n])
            .enumerate()
            .fold((0, 0.0), |worst, (i, d)| if d > worst.1 || d.is_nan() { (i, d) } else { worst })
            .0;
        self.equilibrium.system().place_of(4 * node)
    }

    /// The equilibrium at load factor `load`, starting from the state between the last two points
    /// nearest to it; the path itself is not changed.
    pub fn between(&mut self, load: f64) -> Option<Point> {
        let [.., a, b] = &self.points[..] else { return None };
        let share = (load - a.load) / (b.load - a.load);
        let mut x: Vec<f64> = a.x.iter().zip(&b.x).map(|(a, b)| a + share * (b - a)).collect();
        // A long step is not straight: the state follows the tangent at the first point, corrected
        // by a part of the tangent's miss at the second that grows as the square of the length,
        // like the error.
        if self.turn(&a.x, &b.x) > LARGEST_STEP.1 {
            let led = |h: f64| {
                let increment: Vec<f64> = a.rate[..a.x.len()].iter().map(|rate| h * rate).collect();
                let mut x = a.x.clone();
                self.equilibrium.retraction.apply(&increment, &mut x);
                x
            };
            let h = b.parameter - a.parameter;
            let end = led(h);
            x = led(share * h);
            x.iter_mut().zip(b.x.iter().zip(&end)).for_each(|(x, (b, end))| *x += share * share * (b - end));
        }
        self.solved(load, x)
    }

    /// The equilibrium at load factor `load`, starting on the straight line between the states `a` and
    /// `b` at two others; the path itself is not changed.
    pub fn near(&mut self, [(from, a), (to, b)]: [(f64, &[f64]); 2], load: f64) -> Option<Point> {
        let share = (load - from) / (to - from);
        self.solved(load, a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect())
    }

    /// The equilibrium at load factor `load` that Newton's method finds from `x`.
    fn solved(&mut self, load: f64, mut x: Vec<f64>) -> Option<Point> {
        let (start, still) = (x.clone(), vec![0.0; x.len()]);
        let n = self.equilibrium.system().coordinates();
        self.equilibrium.system().supports().impose(load, &mut x[..n]);
        let mut record = Iterations::default();
        let mut equations = AtLoad::new(self.equilibrium, load);
        let start = Earlier { q: &start, increment: &still };
        newton::solve(&mut equations, &mut x, start, &self.settings, &mut record).ok()?;
        let stability = self.equilibrium.stability();
        Some(Point { parameter: load, load, x, stability, soft: None, rate: Vec::new() })
    }
}

/// Whether a rate with these values at the ends of a step vanishes within it.
fn turns_within([first, last]: [f64; 2]) -> bool {
    (first < 0.0) != (last < 0.0) && first.abs() > LEAVES_TURN * last.abs()
}

/// Whether several directions lose their stiffness between two states, so that the determinant may
/// have the same sign in both.
fn softens(before: &Point, after: &Point) -> bool {
    before.soft.zip(after.soft).is_some_and(|(before, after)| after >= before + 2)
}

/// By how much the gradient of each node differs between two states.
fn turns<'x>(a: &'x [f64], b: &'x [f64]) -> impl Iterator<Item = f64> + 'x {
    let apart = |(a, b): (Node, Node)| (a.gradient[0] - b.gradient[0]).hypot(a.gradient[1] - b.gradient[1]);
    nodes(a).zip(nodes(b)).map(apart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::model::{Beam, Discretization, Model, Place, Section, Support};
    use crate::system::System;

    /// A step may fail before anything has changed: then the first node is named, and else the one
    /// whose gradient has changed most.
    #[test]
    fn a_failure_has_a_place_even_where_nothing_changed() {
        let section = Section::new(1.0, 1.0);
        let beam = Beam::line("arm", [0.0, 0.0], [1.0, 0.0], section, Discretization::ancf(2));
        let supports = vec![Support::clamp(Place::new(0, 0.0))];
        let model = Model { beams: vec![beam], supports, ..Model::default() };
        let system = System::build(&model, Needs::default()).unwrap();
        let mut equilibrium = Equilibrium::new(&system);
        let x = equilibrium.start();
        let path = Path::new(&mut equilibrium, Parameter::Load, Settings::default(), 1.0, x).unwrap();
        let still = path.last().x.clone();
        assert_eq!(path.worst(&still, &still), (0, 0.0));
        let mut moved = still.clone();
        moved[4 + 3] += 0.1;
        moved[8 + 2] += 0.3;
        assert_eq!(path.worst(&moved, &still), (0, 1.0));
    }
}
