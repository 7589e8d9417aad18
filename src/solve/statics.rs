//! Static analysis: from the stress-free state to the full loads, or along the path through limit
//! points.

mod relaxed;

use super::equilibrium::Equilibrium;
use super::newton::{Failure, Iterations, Settings};
use super::path::{self, NoStep, Parameter, Path, Point};
use super::relax::relax;
use super::stability::{Stability, StabilityChange};
use crate::assembly::{InternalVariables, Kind};
use crate::model::{ArcLength, Static};
use crate::solve::{Statistics, StepRecord, Work};
use crate::system::{System, View};
use relaxed::{look, relaxed};
use std::f64::consts::FRAC_PI_2;

/// Largest last increment, in beam lengths, with which stability and the path's tangent are judged.
/// The tangent of Newton's last iterate carries the stress of a state that has not converged yet,
/// which in a slender beam is enough to change the signs.
const LAST_INCREMENT: f64 = 1e-6;

/// Largest turn of a support in a step of a path by loads, so that what it carries turns by less than half a turn \[rad\].
const LARGEST_TURN_OF_PATH: f64 = FRAC_PI_2;

/// By how much a path may miss its target, relative to the wanted load factor or in beam lengths.
const AT_TARGET: f64 = 1e-12;
/// A structure that is held by what strains its given shape alone, and that ends at so small a load factor, was not held.
const NEXT_TO_NOTHING: f64 = 1e-3;
/// Forces below this part of the stiffness stress nothing.
const SLACK: f64 = 1e-12;

/// Changes of load factors, and of coordinates in beam lengths, that are too small to be a turn that is passed.
const UNSEEN: f64 = 1e-6;
/// First step along a path \[beam lengths\].
const FIRST_STEP: f64 = 0.05;
/// How often a step is shortened at most for what it may hide.
const SHORTENED: usize = 8;
/// Changes of positions in beam lengths, and of gradients, that are round-off …
const STILL: f64 = 1e-13;
/// … and where there are no larger ones while load factors grow to so many times those that are of interest, nothing moves: that is more
/// than round-off hides.
const GROWN: f64 = 1e14;

/// The results of a static analysis.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// (load factor, coordinates and scaled multipliers) of the recorded equilibria, the
    /// stress-free state first.
    pub states: Vec<(f64, Vec<f64>)>,
    /// The internal variables of each of them.
    pub variables: Vec<InternalVariables>,
    /// Work of the actuators up to each of them.
    pub work: Vec<Work>,
    /// By how much the nodes of all beams have turned to each of them from the one before \[rad\], where steps between them are not recorded.
    pub turned: Vec<Vec<f64>>,
    /// Attempted steps.
    pub history: Vec<StepRecord>,
    /// Stability of the state in which the path begins, if it is unstable.
    pub unstable_start: Option<Stability>,
    /// Whether a tangent without symmetry tells nothing of the stability at the end of the path.
    pub unwatched: bool,
    /// Load factor at which several directions lost their stiffness at once, where only the sign of
    /// the determinant is watched.
    pub softened: Option<f64>,
    /// Load factor at which a path by arc length comes back to a state that it has passed.
    pub returns: Option<f64>,
    /// Instabilities met.
    pub events: Vec<StabilityChange>,
    /// A mechanism under its loads that, before it was relaxed, had more unstable directions than
    /// free motions.
    pub pressed: Option<UnstableMechanism>,
    /// Load factor at which a mechanism first reached an unstable equilibrium, from which it comes
    /// to rest in one stable equilibrium or in another.
    pub crest: Option<f64>,
    /// How a structure that was relaxed first came to another equilibrium than the one to which its path leads.
    pub jump: Option<Jump>,
    /// Counts.
    pub statistics: Statistics,
    /// Why the path ends before its target, if it does.
    pub stuck: Option<NoStep>,
    /// Why a path by arc length has not reached its target, where no step has failed.
    pub unreached: Option<Unreached>,
}

/// Why a path by arc length ends before its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unreached {
    /// It has its largest number of points.
    OutOfPoints,
    /// Nothing changes any more as the load factor grows.
    NothingGrows,
    /// What grows with the load factor moves nothing.
    NothingMoves,
}

impl Solution {
    /// Forgets all recorded equilibria but the last.
    pub fn keep_last(&mut self) {
        let before = self.states.len().saturating_sub(1);
        self.states.drain(..before);
        self.variables.drain(..before);
        self.work.drain(..before);
        self.turned.drain(..before);
    }

    fn record(
        &mut self,
        equilibrium: &Equilibrium<'_>,
        load: f64,
        x: &[f64],
        work: Work,
        turned: &mut Turned,
    ) {
        self.states.push((load, x.to_vec()));
        self.work.push(work);
        self.turned.push(std::mem::take(&mut turned.nodes));
        self.variables.push(equilibrium.internal_variables(x));
    }
}

/// By how much the nodes of all beams have turned since the last record \[rad\], where steps between records are not recorded.
#[derive(Default)]
struct Turned {
    follows: bool,
    nodes: Vec<f64>,
}

impl Turned {
    fn new(settings: &Static) -> Self {
        Self { follows: settings.steps.is_some(), nodes: Vec::new() }
    }

    /// Adds a step from one state with its load factor to another.
    fn add_step(&mut self, system: &System, before: (f64, &[f64]), now: (f64, &[f64])) {
        if self.follows {
            let turns = system.node_turns(before, now);
            self.nodes.resize(turns.len(), 0.0);
            self.nodes.iter_mut().zip(turns).for_each(|(sum, turn)| *sum += turn);
        }
    }
}

/// A way from one equilibrium to another that is no path of equilibria, or not the only one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Jump {
    /// Between two load factors, where the path ends.
    Between([f64; 2]),
    /// Up to a load factor to which a path leads, too, but to another equilibrium.
    BesidePath(f64),
    /// Along one of two paths that part at a load factor.
    Fork(f64),
}

/// A mechanism whose beams buckle before it moves: the smallest disturbance then decides in which
/// equilibrium it comes to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnstableMechanism {
    /// Load factor at which it was relaxed.
    pub load: f64,
    /// Unstable directions.
    pub unstable: usize,
    /// Rigid motions that supports and joints leave.
    pub free: usize,
}

/// The target at which a path ends.
pub struct Target<'a> {
    /// The settings of the path.
    pub arc: &'a ArcLength,
    /// The probe whose coordinate ends it.
    pub probe: Option<(View, usize, f64)>,
}

impl Target<'_> {
    /// The conditions that may end the path.
    fn end_conditions(&self) -> Vec<EndCondition<'_>> {
        let load = self.arc.until_load.map(EndCondition::Load);
        let probe = self.probe.as_ref().map(|(view, axis, value)| EndCondition::Probe(view, *axis, *value));
        load.into_iter().chain(probe).collect()
    }
}

/// A quantity at whose zero a path ends.
enum EndCondition<'a> {
    /// The load factor less this one.
    Load(f64),
    /// A component of a probe's position less this value \[m\].
    Probe(&'a View, usize, f64),
}

impl EndCondition<'_> {
    fn of(&self, point: &Point) -> f64 {
        match self {
            Self::Load(until) => point.load - until,
            Self::Probe(view, axis, value) => view.fields(&point.x).position[*axis] - value,
        }
    }

    /// What counts as zero between two points.
    fn near(&self, [before, after]: [&Point; 2], system: &System) -> f64 {
        match self {
            Self::Load(until) => AT_TARGET * until.abs().max(before.load.abs()).max(after.load.abs()),
            Self::Probe(..) => AT_TARGET * system.length(),
        }
    }

    /// Whether it vanishes between two points; not where it does so at the first already, which a path that begins there
    /// leaves.
    fn is_reached(&self, [before, after]: [&Point; 2], system: &System) -> bool {
        let [first, second] = [self.of(before), self.of(after)];
        first.abs() > self.near([before, after], system) && ((first < 0.0) != (second < 0.0) || second == 0.0)
    }

    /// Ends the path where it vanishes.
    fn end(&self, path: &mut Path<'_, '_>, system: &System) -> Result<Point, NoStep> {
        let near = path.last_two().map_or(0.0, |points| self.near(points, system));
        let mut point = path.end_where(|point| self.of(point), near)?.clone();
        if let Self::Load(until) = self {
            // The remaining miss, in the last digit, does not change the equilibrium.
            point.load = *until;
        }
        Ok(point)
    }
}

/// Called with (load factor, step, counts) after every step, and after every iteration of a search
/// for a place of rest (the load factor is then that of the last equilibrium); returns whether to
/// go on.
pub type Observer<'o> = &'o mut dyn FnMut(f64, f64, &Statistics) -> bool;

/// Solves for the full loads by adaptive load steps, or follows the path by arc length to `target`.
/// `observe` ends the analysis by returning false.
pub fn solve(
    system: &System,
    settings: &Static,
    target: Option<&Target<'_>>,
    observe: Observer<'_>,
) -> Solution {
    let mut equilibrium = Equilibrium::new(system);
    let mut solution = Solution::default();
    let newton = newton_settings(settings);
    let outcome = match target {
        None => loaded(&mut equilibrium, settings, newton, &mut solution, observe),
        Some(target) => settled(&mut equilibrium, newton, observe)
            .and_then(|x| along_arc(&mut equilibrium, x, (settings, target), newton, &mut solution, observe)),
    };
    solution.statistics = equilibrium.statistics;
    solution.stuck = outcome.err().filter(|stuck| stuck.failure != Failure::Stopped);
    solution
}

/// The equilibria up to the full loads: along a path of load steps, or, where nothing holds the structure before loads do, where it
/// comes to rest under each of them.
fn loaded(
    equilibrium: &mut Equilibrium<'_>,
    settings: &Static,
    newton: Settings,
    solution: &mut Solution,
    observe: Observer<'_>,
) -> Result<(), NoStep> {
    let system = equilibrium.system();
    let was_stopped = |stuck: &NoStep| stuck.failure == Failure::Stopped;
    let x = match settled(equilibrium, newton, observe) {
        Err(stuck) if !system.is_floppy() || was_stopped(&stuck) => return Err(stuck),
        // What strains the given shape may be next to nothing.
        Err(_) => {
            let given = equilibrium.start();
            return relaxed(equilibrium, given, settings, newton, solution, observe);
        }
        Ok(x) => x,
    };
    if system.is_floppy() && !is_steady(equilibrium, &x) {
        return relaxed(equilibrium, x, settings, newton, solution, observe);
    }
    match along_load(equilibrium, x.clone(), settings, newton, solution, observe) {
        Err(stuck) if !was_stopped(&stuck) && is_loose(system, &stuck) => {
            *solution = Solution::default();
            relaxed(equilibrium, x, settings, newton, solution, observe)
        }
        // An obstacle that presses from the start does so in full, however small the first step of the load is. Without loads the structure may
        // come to rest; where only they hold it against the obstacle, that first step was found.
        Err(stuck) if stuck.load == 0.0 && acts_from_the_start(system, &[Kind::Contact]) => {
            let first = std::mem::take(solution);
            let found = at_rest(equilibrium, newton, observe)
                .and_then(|x| along_load(equilibrium, x, settings, newton, solution, observe));
            found.map_err(|second| {
                if was_stopped(&second) || second.load > 0.0 {
                    return second;
                }
                *solution = first;
                stuck
            })
        }
        path => path,
    }
}

/// Whether a structure may be let come to rest where a path of load steps ends: one that only loads hold, where the path began from a
/// state that was reached before; at the very beginning also one that begins in a given shape, which strains it a little, and a beam
/// without stiffness along its axis yet.
fn is_loose(system: &System, stuck: &NoStep) -> bool {
    let at_start = system.is_floppy() && system.starts_bent() || system.goes_slack();
    at_start && stuck.load < NEXT_TO_NOTHING || system.is_floppy() && system.is_taken_up()
}

/// Whether a structure that is held in its stress-free state is pushed out of it by effects of these kinds.
fn acts_from_the_start(system: &System, kinds: &[Kind]) -> bool {
    !system.is_taken_up() && !system.is_floppy() && system.force_at_start(kinds) > 0.0
}

/// The state at load factor 0: where a given shape, or one in which springs are stretched, comes to rest.
fn settled(
    equilibrium: &mut Equilibrium<'_>,
    newton: Settings,
    observe: Observer<'_>,
) -> Result<Vec<f64>, NoStep> {
    let system = equilibrium.system();
    if system.starts_bent() || acts_from_the_start(system, &[Kind::Spring]) {
        return at_rest(equilibrium, newton, observe);
    }
    Ok(equilibrium.start())
}

/// Where the given shape comes to rest without loads.
fn at_rest(
    equilibrium: &mut Equilibrium<'_>,
    newton: Settings,
    observe: Observer<'_>,
) -> Result<Vec<f64>, NoStep> {
    let (mut x, system) = (equilibrium.start(), equilibrium.system());
    let goes_on = &mut |counts: &Statistics| observe(0.0, 0.0, counts);
    let before = equilibrium.accepted().clone();
    if let Err(failure) = relax(equilibrium, 0.0, &mut x, &newton, &mut Iterations::default(), goes_on) {
        equilibrium.restore(before);
        let at = system.place_of(failure.unknown().unwrap_or(0));
        return Err(NoStep { load: 0.0, step: 0.0, failure, at });
    }
    equilibrium.set_accepted(&x);
    Ok(x)
}

/// Whether the analysis does not begin in the stress-free state but in a stable equilibrium, from
/// which a path of load steps leads on even where the stress-free structure is floppy.
fn is_steady(equilibrium: &mut Equilibrium<'_>, x: &[f64]) -> bool {
    let system = equilibrium.system();
    if !(system.is_taken_up() || system.starts_bent()) || is_slack(system, x) {
        return false;
    }
    look(equilibrium, 0.0, x) && !equilibrium.is_unstable()
}

/// Whether nothing is stressed in the state `x`, so that a structure without stiffness of its own has none.
fn is_slack(system: &System, x: &[f64]) -> bool {
    let (q, multipliers) = x.split_at(system.coordinates());
    let energy = system.energy(0.0, q, None);
    let stored = energy.stretch + energy.bend + energy.stored;
    let none = SLACK * system.stiffness();
    stored.abs() <= SLACK * none * system.length() && multipliers.iter().all(|force| force.abs() <= none)
}

fn newton_settings(settings: &Static) -> Settings {
    let mut newton = Settings { last_increment: LAST_INCREMENT, ..Settings::default() };
    if let Some(tolerance) = settings.tolerance {
        newton.tolerance = tolerance;
        newton.last_increment = LAST_INCREMENT.max(tolerance);
    }
    newton
}

fn along_load(
    equilibrium: &mut Equilibrium<'_>,
    x: Vec<f64>,
    settings: &Static,
    newton: Settings,
    solution: &mut Solution,
    observe: Observer<'_>,
) -> Result<(), NoStep> {
    let mut path = Path::new(equilibrium, Parameter::Load, newton, 1.0, x)?;
    let mut known = path.last().stability;
    solution.unstable_start = known.filter(|stability| stability.is_unstable());
    let mut work = Work::default();
    let mut turned = Turned::new(settings);
    solution.record(path.equilibrium, 0.0, &path.last().x, work, &mut turned);
    let recorded = settings.steps.unwrap_or(1).max(1);
    let between = steps_between(path.equilibrium.system(), settings, recorded, LARGEST_TURN_OF_PATH);
    let parts = recorded.saturating_mul(between);
    let mut part = 1;
    let outcome = loop {
        // The last part ends at 1 exactly.
        let end = if part == parts { 1.0 } else { part as f64 / parts as f64 };
        let point = match path.advance(end) {
            Ok(point) => point.clone(),
            Err(stuck) => break Err(stuck),
        };
        if !work.keep_step(&mut path) {
            if observe(path.last().load, path.next_step(), &path.equilibrium.statistics) {
                continue;
            }
            break Ok(());
        }
        if let Some([before, after]) = path.last_two() {
            turned.add_step(path.equilibrium.system(), (before.load, &before.x), (after.load, &after.x));
        }
        notice(&mut path, &mut known, &mut solution.events);
        let at_end = point.load >= end;
        if settings.steps.is_none() || at_end && part.is_multiple_of(between) {
            solution.record(path.equilibrium, point.load, &point.x, work, &mut turned);
        }
        part += usize::from(at_end);
        let go_on = observe(point.load, path.next_step(), &path.equilibrium.statistics);
        if part > parts || !go_on {
            break Ok(());
        }
    };
    // Where the path ends early, its end is recorded too.
    let last = path.last();
    if solution.states.last().is_none_or(|(load, _)| *load != last.load) {
        solution.record(path.equilibrium, last.load, &last.x, work, &mut turned);
    }
    solution.history = std::mem::take(&mut path.history);
    solution.unwatched = path.last().stability.is_none() && !path.equilibrium.is_symmetric();
    solution.softened = path.softened;
    outcome
}

/// Whether two states differ by more than the round-off of positions.
fn moves(system: &System, before: &[f64], now: &[f64]) -> bool {
    let units = [system.length(), system.length(), 1.0, 1.0];
    let apart = before.iter().zip(now).take(system.coordinates()).zip(units.into_iter().cycle());
    apart.into_iter().any(|((before, now), unit)| (before - now).abs() > STILL * unit)
}

/// Load steps from one of so many recorded states to the next, of the largest length or smaller, and in none of which a support turns by
/// more than `turn`; at least one.
fn steps_between(system: &System, settings: &Static, recorded: usize, turn: f64) -> usize {
    // A length such as 1/50, as it is written, has 50 steps.
    let steps = (1.0 / settings.largest_step(system.has_friction()) - AT_TARGET).ceil() as usize;
    steps.max(system.parts_of_turns(turn)).div_ceil(recorded).max(1)
}

/// Records a change of stability in the last step.
fn notice(path: &mut Path<'_, '_>, known: &mut Option<Stability>, events: &mut Vec<StabilityChange>) {
    let Some(after) = path.last().stability else { return };
    let Some(before) = known.replace(after).filter(|before| before.differs(after)) else { return };
    events.push(path.change(before, after));
}

/// A step of a path by arc length.
struct Stride {
    /// Its end.
    point: Point,
    /// Whether that is a limit point.
    at_limit: bool,
    /// Whether a target is reached there.
    reached: bool,
}

/// Takes a step to a new equilibrium, or to where the load factor or a coordinate that ends the path turns back within it, or
/// reaches its target. What a step may hide is sought by a shorter one.
fn stride(
    path: &mut Path<'_, '_>,
    conditions: &[EndCondition<'_>],
    system: &System,
) -> Result<Stride, NoStep> {
    let mut shorter = 0;
    let mut take_back = |path: &mut Path<'_, '_>| {
        shorter += 1;
        shorter <= SHORTENED && path.take_back()
    };
    loop {
        path.advance(f64::INFINITY)?;
        let hidden = path.hides_turns(|point| point.load, Point::load_rate, UNSEEN * path.last().load.abs())
            || conditions.iter().any(|condition| match condition {
                EndCondition::Load(_) => false,
                EndCondition::Probe(view, axis, _) => path.hides_turns(
                    |point| condition.of(point),
                    |point| view.at_point(&point.rate)[*axis],
                    UNSEEN * system.length(),
                ),
            });
        if (hidden || path.misses_middle()) && take_back(path) {
            continue;
        }
        let Some(previous) = path.last_two().map(|[previous, _]| previous.clone()) else { continue };
        // A step passes no limit point, and no point where the coordinate that ends the path turns back: a target could be
        // reached before it and be left again.
        let mut at_limit = path.end_at_limit();
        for condition in conditions {
            if let (Ok(limit), EndCondition::Probe(view, axis, _)) = (&at_limit, condition) {
                let turns = path.end_at_turn(|point| view.at_point(&point.rate)[*axis]);
                at_limit = turns.map(|turns| *limit && !turns);
            }
        }
        if at_limit.is_err() && take_back(path) {
            continue;
        }
        let at_limit = at_limit.unwrap_or(false);
        // Of two targets within a step the one that comes first counts.
        let (mut last, mut reached) = (Ok(path.last().clone()), false);
        for miss in conditions {
            if let Ok(point) = &last
                && miss.is_reached([&previous, point], system)
            {
                (last, reached) = (miss.end(path, system), true);
            }
        }
        match last {
            Ok(point) => return Ok(Stride { point, at_limit, reached }),
            // A long step may have passed over what lies between.
            Err(_) if take_back(path) => {}
            Err(stuck) => return Err(stuck),
        }
    }
}

fn along_arc(
    equilibrium: &mut Equilibrium<'_>,
    x: Vec<f64>,
    (settings, target): (&Static, &Target<'_>),
    newton: Settings,
    solution: &mut Solution,
    observe: Observer<'_>,
) -> Result<(), NoStep> {
    let system = equilibrium.system();
    let largest = settings.largest_step(system.has_friction());
    let loads = target.arc.until_load.map_or(1.0, |load| load.abs().max(1.0));
    let first = largest.min(FIRST_STEP);
    let mut path = Path::new(equilibrium, Parameter::ArcLength { loads }, newton, first, x)?;
    let mut known = path.last().stability;
    solution.unstable_start = known.filter(|stability| stability.is_unstable());
    let mut work = Work::default();
    let mut turned = Turned::default();
    solution.record(path.equilibrium, 0.0, &path.last().x, work, &mut turned);
    let mut outcome = Ok(());
    if target.arc.until_load.is_some_and(|load| load < 0.0) {
        path.turn_round();
    }
    let aims = target.arc.until_load.is_some() || target.probe.is_some();
    let conditions = target.end_conditions();
    let mut unreached = aims.then_some(Unreached::OutOfPoints);
    // The largest load factor at which something has moved.
    let mut moved = loads;
    for _ in 0..target.arc.max_points {
        path.limit_step(largest);
        let from = path.last().clone();
        let Stride { point, at_limit, reached } = match stride(&mut path, &conditions, system) {
            Ok(stride) => stride,
            Err(stuck) => {
                (outcome, unreached) = (Err(stuck), None);
                break;
            }
        };
        if let Some(after) = point.stability
            && let Some(before) = known.replace(after).filter(|before| before.differs(after))
        {
            let change = match at_limit && !reached {
                true => StabilityChange { load: point.load, resolution: 0.0, before, after },
                false => path.change(before, after),
            };
            solution.events.push(change);
        }
        work.add_states(system, (from.load, &from.x), (point.load, &point.x));
        solution.record(path.equilibrium, point.load, &point.x, work, &mut turned);
        let go_on = observe(point.load, path.next_step(), &path.equilibrium.statistics);
        if reached || !go_on {
            unreached = None;
            break;
        }
        if moves(system, &from.x, &point.x) {
            moved = point.load.abs().max(moved);
        }
        if point.load.abs() > GROWN * moved {
            unreached = Some(Unreached::NothingMoves);
            break;
        }
        // What comes and what goes has done so at load factor 1.
        if target.arc.until_load.is_none() && !system.is_driven(point.load) {
            unreached = aims.then_some(Unreached::NothingGrows);
            break;
        }
    }
    solution.history = std::mem::take(&mut path.history);
    solution.unwatched = path.last().stability.is_none() && !path.equilibrium.is_symmetric();
    solution.softened = path.softened;
    solution.returns = path::comes_back(system, &solution.states);
    solution.unreached = unreached;
    outcome
}
