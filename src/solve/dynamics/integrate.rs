//! The driver of all methods: chooses steps, records states, locates events, keeps the data for a
//! restart.
//!
//! # Steps that meet a stated accuracy
//! The tolerance is the wanted error of positions at the end, root mean square over the nodes,
//! relative to the beam length. A step may err by a fixed part of it. From an estimate of order p +
//! 1 the step length follows by the proportional–integral rule of Gustafsson (*ACM Trans. Math.
//! Softw.* 20, 1994, 496–517). A step that could grow only a little keeps its length, if the method
//! can then use its factorisation again ([`Method::least_growth`]).
//!
//! Two other choices were tried and rejected. An allowance in proportion to the step asks for ever
//! smaller steps once a high frequency rings, although its errors do not add up. The largest change
//! of any gradient, in place of positions, overrates the shortest waves, which the sudden release
//! of a beam excites: it took four times as many steps as needed.
//!
//! # When iterations stop
//! What an iteration leaves of a position, δ, is also a velocity of δ/h, which lasts, and after a
//! time T a position of δ T/h. Over N = T/h steps such errors add up like a random walk. So the
//! equations of a step are solved to
//!
//! ```text
//! δ = N^(−3/2) × tolerance
//! ```
//!
//! T is the time since the motion began or, if that is longer, the time that its beginning acts on:
//! that in which the fastest node moves by a beam length, or the slowest vibration turns by a
//! radian, whichever is shorter. N is at least 500: when a motion begins, nobody knows how long it
//! goes on, and in a stiff rod that rotates all these errors have one sign. A part of the tolerance
//! that does not depend on N let motions with strong damping, whose iterations converge slowly, err
//! by ten to a hundred tolerances.
//!
//! # Kinks
//! Where a load or a support's motion is not smooth a step ends, with every method and step
//! control: its last stage sees the values just before, the next step begins with those just after
//! (`Driver::pass_kinks`), and no interpolation reaches across. A step of fixed length is divided
//! there, and all later ones end where they would have. Where a contact begins, ends, or turns, a
//! step with a tolerance ends too, and the accelerations that the method carries on are computed
//! anew ([`Method::renew`]).
//!
//! An expression may change at any time, and a long step would pass over a short pulse. So steps end
//! also at times between which it changes about equally ([`System::turns_of_laws`]); steps of fixed length
//! only where it changes faster than they can follow.
//!
//! What a formula of place and time does depends on where the beam is by then. So before each step the
//! driver looks along it ([`System::sudden_changes`]), as closely as for expressions, and ends it where
//! such a load sets off suddenly; the change itself takes several steps.
//!
//! # Steps of fixed length
//! A step whose equations cannot be solved is divided, and the count of rejected steps and a
//! warning tell so; all others keep their lengths and their ends. In a step in which nodes turn far
//! the equations have several solutions, and the trapezoidal rule pumps energy into a stiff beam.
//! So a step that turns a node by more than 0.1 rad is also divided if it gains energy, and so is
//! one that leads through an obstacle (the private module `touch`).

use super::collocation::Collocation;
use super::contact::ContactState;
use super::event::{EventWatch, Watched};
use super::generalized_alpha::GeneralizedAlpha;
use super::method::{Allowed, Method};
use super::motion::Motion;
use super::tableau::Tableau;
use super::{Checkpoint, NoStep, Solution, State};
use crate::assembly::{AcceptedState, nodes};
use crate::linear::Singular;
use crate::model::{Integrator, StepControl};
use crate::solve::newton::{Failure, Iterations, not_crushed};
use crate::solve::{Statistics, StepRecord};
use crate::system::{System, View, unfold};
use crate::threads;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

/// The task of an integration.
pub struct Task<'t> {
    /// Time at which it ends \[s\].
    pub duration: f64,
    /// Time between recorded states \[s\].
    pub output_every: f64,
    /// The method and its step control.
    pub integrator: Integrator,
    /// The state from which it starts.
    pub start: Checkpoint,
    /// Whether forces of supports and joints are wanted.
    pub reactions: bool,
    /// Whether records keep what their forces follow from, so that section forces in them can be
    /// found later.
    pub forces: bool,
    /// Events to watch for.
    pub watches: &'t [EventWatch<'t>],
    /// Points whose directions are followed from step to step, so that full turns are counted.
    pub directions: &'t [View],
    /// Receives checkpoints during the motion.
    pub keep: Option<Checkpointing<'t>>,
}

/// Receives checkpoints during a motion.
#[derive(Clone, Copy)]
pub struct Checkpointing<'k> {
    /// Wall time between them.
    pub every: Duration,
    /// Receives them.
    pub take: &'k dyn Fn(Checkpoint),
}

/// Part of the tolerance that a step may err by: as if ten thousand errors added up. A step that is
/// shorter than this part of the time until its end may err by its share of that time, so that
/// steps do not depend on when the motion ends. On the soft pendulum, with all methods and
/// tolerances from 1e-3 to 1e-6, the largest error of the tip is at most 2.7 times the tolerance.
pub const STEP_PART: f64 = 1e-4;
/// The largest tolerance that iterations follow: equations of a step that are solved less closely
/// may not converge at all.
const LOOSEST: f64 = 1e-2;
/// Steps of the present length whose errors of iterations add up at least.
const FEWEST_STEPS: f64 = 500.0;
/// Longest first step in periods of the slowest vibration: where nothing moves yet, speeds set no
/// limit.
const FIRST_STEP: f64 = 0.01;
/// Part of the wanted step that is taken, so that few are rejected.
const SAFETY: f64 = 0.9;
/// Steps grow and shrink at most by these factors.
const LIMITS: (f64, f64) = (0.2, 4.0);
/// Factor of the step length after an iteration that did not converge.
const SHRINK: f64 = 0.3;
/// Smallest step, relative to the duration.
const SMALLEST_STEP: f64 = 1e-12;
/// Smallest part of a step of fixed length into which it is divided where its equations cannot be
/// solved.
pub(super) const SMALLEST_PART: f64 = 1e-3;
/// Part of a step of fixed length by which its end may be moved to a kink. A very short step to the
/// kink would be worse: round-off in accelerations grows with the inverse square of the step.
const NEAR: f64 = 1e-3;
/// Iterations beyond which a step does not grow: the next tangent would be worse.
const MANY_ITERATIONS: usize = 10;
/// How often a step may end earlier because a contact begins or ends in it.
const CUTS: usize = 6;
/// Parts of a whole motion in which formulas of place and time are looked at.
const LOOKS: f64 = 16384.0;
/// Steps of fewer such parts are not looked along: what is shorter may be missed.
const FEWEST_LOOKS: f64 = 16.0;
/// Attempted steps that are kept for the reader.
const HISTORY: usize = 20_000;
/// Time by which a record or an end may miss a step's end, relative to the step.
pub(super) const SLACK: f64 = 1e-9;

/// Integrates `task`. `observe` is called with (time, next step, counts) after every step and ends
/// the integration by returning false.
pub fn solve(
    system: &System,
    task: &Task<'_>,
    observe: &mut dyn FnMut(f64, f64, &Statistics) -> bool,
) -> Solution {
    let mut solution = Solution::default();
    let method = match method(system, task.integrator) {
        Ok(method) => method,
        Err(singular) => {
            let (time, at) = (task.start.state.time, system.place_of(singular.row));
            solution.stuck = Some(NoStep { time, step: 0.0, failure: singular.into(), at });
            return solution;
        }
    };
    let mut driver = Driver::new(system, task, method, solution);
    driver.run(observe);
    driver.finish()
}

fn method<'a>(system: &'a System, integrator: Integrator) -> Result<Box<dyn Method + 'a>, Singular> {
    let (motion, control) = (Motion::new(system)?, integrator.step_control());
    Ok(match integrator {
        Integrator::GeneralizedAlpha { spectral_radius, newton_tolerance, .. } => {
            Box::new(GeneralizedAlpha::new(motion, spectral_radius, newton_tolerance, control))
        }
        Integrator::Gauss { stages, .. } => {
            Box::new(Collocation::new(motion, Tableau::gauss(stages), control))
        }
        Integrator::Radau { stages, .. } => {
            Box::new(Collocation::new(motion, Tableau::radau(stages), control))
        }
    })
}

/// A motion under way.
pub(super) struct Driver<'t, 'a> {
    pub(super) system: &'a System,
    pub(super) task: &'t Task<'t>,
    pub(super) method: Box<dyn Method + 'a>,
    pub(super) solution: Solution,
    pub(super) control: StepControl,
    pub(super) state: State,
    /// The next step \[s\].
    pub(super) step: f64,
    pub(super) origin: (f64, u64),
    pub(super) next_record: u64,
    pub(super) last_ratio: f64,
    pub(super) rejected: bool,
    /// The state in which the motion was taken up; everything until then has been reported.
    pub(super) first: State,
    /// The checkpoint before the step that the end of the motion or an event has cut short.
    whole: Option<Checkpoint>,
    pub(super) stride: usize,
    /// Times at which loads or supports are not smooth, rising.
    pub(super) kinks: Vec<f64>,
    /// The last accepted state, for effects that depend on the path.
    pub(super) accepted: AcceptedState,
    /// The state of each contact.
    pub(super) touching: Vec<ContactState>,
    /// Times and powers at the start and the end of the last step.
    pub(super) powers: [(f64, (f64, f64)); 2],
    /// Times and powers of moving supports in the stages of the last attempt; empty before they are
    /// asked for.
    pub(super) support_powers: Vec<(f64, f64)>,
    /// Time and power of moving supports in the last stage of the last step, if that was its end
    /// and the accelerations go on from there.
    pub(super) support_power_at_start: Option<(f64, f64)>,
    /// The same for the powers of damping.
    pub(super) damping_powers: Vec<(f64, f64)>,
    /// Length of the last accepted step \[s\].
    pub(super) last_step: f64,
    /// Equations of motion for evaluating forces; made when first needed.
    pub(super) observer: Option<Motion<'a>>,
    /// What is remembered of each watched quantity.
    pub(super) watched: Vec<Watched>,
}

/// Whether forces are smooth at the end of a step.
#[derive(Clone, Copy, Debug)]
enum End {
    /// Only loads and supports may have a kink there, at a time known in advance.
    Smooth,
    /// A contact begins, ends, or turns: accelerations from before do not apply afterwards.
    ContactChanges,
}

impl<'t, 'a> Driver<'t, 'a> {
    fn new(
        system: &'a System,
        task: &'t Task<'t>,
        mut method: Box<dyn Method + 'a>,
        mut solution: Solution,
    ) -> Self {
        let mut first = task.start.reached().clone();
        first.angles = turned(task.directions, &first);
        let Checkpoint { state, method: name, memory, step, last_ratio, origin, .. } = task.start.clone();
        let state = State { angles: turned(task.directions, &state), ..state };
        let control = task.integrator.step_control();
        let mut lost = |unknown: usize, failure: Failure| {
            let at = system.place_of(unknown);
            solution.stuck = Some(NoStep { time: state.time, step: 0.0, failure, at });
        };
        let acceleration = method.start(&state).unwrap_or_else(|singular| {
            lost(singular.row, singular.into());
            vec![0.0; state.q.len()]
        });
        if let Some(unknown) = acceleration.iter().position(|a| !a.is_finite()) {
            lost(unknown, Failure::NotFinite);
        }
        let continued = name == task.integrator.to_string() && method.restore(memory);
        let (step, origin) = match control {
            _ if continued && on_grid(control, origin, state.time) => (step, origin),
            StepControl::Fixed(step) => (step, (state.time, 0)),
            StepControl::Tolerance(tolerance) => {
                (first_step(system, &*method, [&state.v, &acceleration], tolerance), (state.time, 0))
            }
        };
        let contacts = 0..system.contacts();
        let touching =
            contacts.map(|contact| ContactState::new(system.contact_force(contact, &state.q))).collect();
        let mut kinks = system.kinks();
        // Steps of fixed length end only at changes that are shorter than they are.
        let near = match control {
            StepControl::Fixed(step) => {
                kinks.extend(system.short_changes(step));
                step
            }
            StepControl::Tolerance(_) => f64::INFINITY,
        };
        kinks.extend(system.turns_of_laws([state.time, task.duration], near));
        kinks.retain(|kink| *kink > state.time && *kink <= task.duration);
        kinks.sort_by(f64::total_cmp);
        let next_record = (first.time / task.output_every + 1.0 + SLACK).floor() as u64;
        let mut driver = Self {
            system,
            task,
            method,
            solution,
            control,
            state,
            step,
            origin,
            next_record,
            last_ratio: if continued { last_ratio } else { 1.0 },
            rejected: false,
            first: first.clone(),
            whole: None,
            stride: 1,
            kinks,
            accepted: AcceptedState::default(),
            touching,
            powers: [(f64::NAN, (0.0, 0.0)); 2],
            support_powers: Vec::new(),
            support_power_at_start: None,
            damping_powers: Vec::new(),
            last_step: step,
            observer: None,
            watched: vec![Watched::default(); task.watches.len()],
        };
        driver.set_accepted();
        let balance = if driver.task.reactions { driver.balance_at_start(&first) } else { None };
        if driver.task.forces {
            let goes_on = (driver.state.time > 0.0).then(|| driver.tendency_at_end());
            driver.keep_forces(balance.as_ref(), goes_on);
        }
        if driver.task.reactions {
            driver.keep_reactions(balance);
        }
        driver.keep(first);
        driver
    }

    fn run(&mut self, observe: &mut dyn FnMut(f64, f64, &Statistics) -> bool) {
        let mut new = self.state.clone();
        let mut kept = Instant::now();
        // The state may be that of a motion that has ended just before a kink.
        self.go_on(End::Smooth);
        while self.solution.stuck.is_none() && !self.has_ended() {
            let before = self.may_be_cut().then(|| self.checkpoint());
            let ends_early = self.end_cuts();
            match self.advance(&mut new) {
                Err(stuck) => self.solution.stuck = Some(stuck),
                Ok(end) => {
                    self.last_step = new.time - self.state.time;
                    let stopped = self.look(&mut new);
                    if (stopped || ends_early) && self.whole.is_none() {
                        self.whole = before;
                    }
                    self.method.accept();
                    let last = self.support_powers.last().copied();
                    self.support_power_at_start = last.filter(|(time, _)| *time == new.time);
                    std::mem::swap(&mut self.state, &mut new);
                    if !stopped {
                        if self.has_ended() {
                            // What a law does after the end is not seen by the last state.
                            self.solution.end = self.balance_at_end();
                        }
                        self.go_on(end);
                    }
                    self.set_accepted();
                    if let Some(Checkpointing { every, take }) = self.task.keep
                        && kept.elapsed() >= every
                    {
                        take(self.checkpoint());
                        kept = Instant::now();
                    }
                    if stopped || !observe(self.state.time, self.step, self.method.statistics()) {
                        return;
                    }
                }
            }
        }
    }

    /// Whether the end of the motion is reached.
    fn has_ended(&self) -> bool {
        self.task.duration - self.state.time <= SMALLEST_STEP * self.task.duration
    }

    /// Makes the present state the one from which internal variables are counted.
    fn set_accepted(&mut self) {
        if self.system.has_history() {
            self.accepted =
                AcceptedState { q: self.state.q.clone(), variables: self.state.variables.clone() };
        }
    }

    fn finish(mut self) -> Solution {
        let last = self.solution.states.last().map_or(f64::NEG_INFINITY, |state| state.time);
        if self.solution.end.is_none() {
            self.solution.end = self.balance_at_end();
        }
        if self.state.time > last + SLACK * self.step {
            self.keep(self.state.clone());
            if self.task.forces {
                let end = self.solution.end.clone();
                self.keep_forces(end.as_ref(), None);
            }
            if self.task.reactions {
                self.keep_reactions(self.solution.end.clone());
            }
        }
        self.solution.contacts.retain(|change| change.time > self.first.time);
        self.solution.statistics = *self.method.statistics();
        self.solution.checkpoint = Some(self.checkpoint());
        self.solution
    }

    /// The checkpoint from which the motion can be continued.
    fn checkpoint(&self) -> Checkpoint {
        // A motion that was stopped before it came back to where it was taken up continues from
        // there.
        let reached = if self.state.time < self.first.time { &self.first } else { &self.state };
        if let Some(whole) = &self.whole {
            return Checkpoint { cut: Some(reached.clone()), ..whole.clone() };
        }
        Checkpoint {
            state: self.state.clone(),
            method: self.task.integrator.to_string(),
            memory: self.method.memory(),
            step: self.step,
            last_ratio: self.last_ratio,
            origin: self.origin,
            cut: (reached.time > self.state.time).then(|| reached.clone()),
        }
    }

    /// Whether the end of the motion cuts the next step short, which it would not with a longer
    /// duration.
    fn end_cuts(&self) -> bool {
        match self.control {
            StepControl::Fixed(step) => {
                self.origin.0 + step * (self.origin.1 + 1) as f64 != self.grid_end(step)
            }
            StepControl::Tolerance(_) => {
                let left = self.task.duration - self.state.time;
                let now = self.state.time;
                let kinks = || self.kinks.iter().filter(|kink| **kink > now);
                2.0 * self.step > left && kinks().all(|kink| *kink >= self.task.duration)
            }
        }
    }

    /// Whether the end of the motion or an event may cut the next step short, and none has before.
    fn may_be_cut(&self) -> bool {
        self.whole.is_none() && (self.end_cuts() || self.task.watches.iter().any(|watch| watch.stop))
    }

    /// Adds to the kinks where, in the step to come, a load that is a formula of place and time changes
    /// suddenly.
    fn look_ahead(&mut self) {
        let span = [self.state.time, self.next_end(f64::INFINITY)];
        let parts = LOOKS * (span[1] - span[0]) / self.task.duration;
        if parts < FEWEST_LOOKS {
            return;
        }
        let state = [&self.state.q[..], &self.state.v[..]];
        let sudden = self.system.sudden_changes(span, state, parts as usize);
        if !sudden.is_empty() {
            self.kinks.extend(sudden);
            self.kinks.sort_by(f64::total_cmp);
        }
    }

    /// Takes one step to `new`, shortened as often as needed.
    fn advance(&mut self, new: &mut State) -> Result<End, NoStep> {
        self.look_ahead();
        let (mut touch, mut cuts) = (f64::INFINITY, 0);
        loop {
            let end = self.next_end(touch);
            // At a kink the step ends just before it, so that it sees a load that jumps as it was
            // before.
            let until = if self.kinks.contains(&end) { end.next_down() } else { end };
            let h = until - self.state.time;
            let allowed = match self.control {
                StepControl::Fixed(_) => None,
                StepControl::Tolerance(tolerance) => Some(self.allowed(tolerance, until)),
            };
            let mut record = Iterations::default();
            let (method, state) = (&mut self.method, &self.state);
            let attempt = || method.attempt(state, until, allowed, new, &mut record);
            let result = threads::within(state.q.len() / 4, attempt);
            self.support_powers.clear();
            self.damping_powers.clear();
            new.time = until;
            let result = match allowed {
                None => result.and_then(|error| self.without_gain(new).map(|()| error)),
                Some(_) => result,
            };
            let result = result.and_then(|error| not_crushed(&new.q).map(|()| error));
            let result = result.and_then(|error| self.not_crossed(new).map(|()| error));
            let result = result.and_then(|error| self.not_overwound(new).map(|()| error));
            let iterations = record.increments.len();
            let ratio = match (&result, allowed) {
                (Ok(error), Some(allowed)) => error / allowed.step,
                _ => 0.0,
            };
            let accurate = result.is_ok() && ratio <= 1.0;
            let kink =
                if accurate && allowed.is_some() && cuts < CUTS { self.kink_within(new) } else { None };
            let accepted = accurate && kink.is_none();
            self.remember(StepRecord {
                parameter: end,
                step: h,
                accepted,
                increments: record.increments,
                residuals: record.residuals,
            });
            let power = 1.0 / (self.method.order() + 1.0);
            if accepted {
                self.method.statistics().steps += 1;
                (new.work, new.lost) = (self.state.work, self.state.lost);
                if let StepControl::Fixed(step) = self.control
                    && end >= self.grid_end(step) - NEAR * step
                {
                    self.origin.1 += 1;
                    self.step = step;
                } else if allowed.is_some() {
                    let ratio = ratio.max(1e-10);
                    let mut factor = SAFETY * ratio.powf(-0.7 * power) * self.last_ratio.powf(0.4 * power);
                    if self.rejected || iterations > MANY_ITERATIONS {
                        factor = factor.min(1.0);
                    }
                    if (1.0..self.method.least_growth()).contains(&factor) {
                        factor = 1.0;
                    }
                    let next = h * factor.clamp(LIMITS.0, LIMITS.1);
                    // A step that was cut says little about the next.
                    let cut = h < (1.0 - NEAR) * self.step;
                    self.step = if cut { self.step.max(next) } else { next };
                    (self.last_ratio, self.rejected) = (ratio, false);
                }
                return Ok(if end == touch { End::ContactChanges } else { End::Smooth });
            }
            let stuck = |method: &dyn Method, failure| {
                let unknown = match failure {
                    Failure::Crushed { node, .. } => 4 * node,
                    _ => worst(method.last_increment()),
                };
                let at = self.system.place_of(unknown);
                NoStep { time: self.state.time, step: h, failure, at }
            };
            self.method.statistics().rejected_steps += 1;
            if let Some(time) = kink {
                (touch, cuts) = (time, cuts + 1);
                continue;
            }
            match (result, allowed) {
                (Err(failure), _) => {
                    let smallest = match (self.control, failure) {
                        (StepControl::Fixed(step), Failure::Crossed { .. }) => SMALLEST_PART.powi(2) * step,
                        (StepControl::Fixed(step), _) => SMALLEST_PART * step,
                        (StepControl::Tolerance(_), _) => SMALLEST_STEP * self.task.duration,
                    };
                    self.step = h * match (allowed, failure) {
                        (None, _) => 0.5,
                        (Some(_), Failure::Crossed { part, .. }) => part.clamp(LIMITS.0, SAFETY),
                        (Some(_), _) => SHRINK,
                    };
                    if self.step < smallest {
                        return Err(stuck(&*self.method, failure));
                    }
                }
                (Ok(_), _) => {
                    self.step = h * (SAFETY * ratio.powf(-power)).clamp(LIMITS.0, SAFETY);
                    if self.step.is_nan() {
                        return Err(stuck(&*self.method, Failure::NotFinite));
                    }
                    if self.step < SMALLEST_STEP * self.task.duration {
                        return Err(stuck(&*self.method, Failure::StepsErr));
                    }
                }
            }
            self.rejected = true;
        }
    }

    /// The errors that the next step may make if it ends at the time `until`.
    fn allowed(&self, tolerance: f64, until: f64) -> Allowed {
        let h = until - self.state.time;
        let fastest = nodes(&self.state.v).fold(0.0_f64, |largest, node| largest.max(node.shift()));
        let slowest = self.system.lowest_vibration_scale().sqrt().recip();
        let ahead = slowest.min(self.system.length() / fastest);
        // An error of a position is one of h⁻¹ times the size of the velocity, which moves all that follows; those of several steps add
        // up as independent ones do, or in proportion to their number.
        let steps = (until.max(ahead) / h).max(FEWEST_STEPS);
        Allowed {
            step: tolerance * STEP_PART.min(h / until),
            iteration: tolerance.min(LOOSEST) * steps.powf(-1.5),
            one_sided: tolerance.min(LOOSEST) * steps.powi(-2),
        }
    }

    /// Where the present step of fixed length ends.
    fn grid_end(&self, step: f64) -> f64 {
        let end = self.origin.0 + step * (self.origin.1 + 1) as f64;
        // No sliver is left before the end.
        if end > self.task.duration - SLACK * step { self.task.duration } else { end }
    }

    /// Where the next step ends; not beyond `touch` if steps are chosen.
    fn next_end(&self, touch: f64) -> f64 {
        let now = self.state.time;
        let kink = self.kinks.iter().copied().find(|kink| *kink > now);
        let (end, sliver) = match self.control {
            StepControl::Fixed(step) => {
                let end = self.grid_end(step);
                (kink.filter(|kink| *kink <= end + NEAR * step).unwrap_or(end), 1.0 + SLACK)
            }
            // The last two steps share the remaining time.
            StepControl::Tolerance(_) => (kink.unwrap_or(self.task.duration).min(touch), 2.0),
        };
        let left = end - now;
        if self.step * (1.0 + SLACK) >= left {
            end
        } else if self.step * sliver > left {
            now + 0.5 * left
        } else {
            now + self.step
        }
    }

    /// Prepares the step that follows one with this `end`.
    fn go_on(&mut self, end: End) {
        let renewed = match end {
            End::ContactChanges => {
                self.support_power_at_start = None;
                self.method.renew(&self.state)
            }
            End::Smooth => Ok(()),
        };
        if let Err(singular) = renewed.and_then(|()| self.pass_kinks()) {
            let at = self.system.place_of(singular.row);
            let (time, step) = (self.state.time, self.step);
            self.solution.stuck = Some(NoStep { time, step, failure: singular.into(), at });
        }
    }

    /// Continues just after the kinks at which the last step ended, if it ended at any.
    fn pass_kinks(&mut self) -> Result<(), Singular> {
        let before = self.state.time;
        let slack = SMALLEST_STEP * self.task.duration;
        let passed = |kink: &&f64| **kink > before && **kink - before <= slack;
        let Some(kink) = self.kinks.iter().rfind(passed).copied() else { return Ok(()) };
        let kinetic =
            |driver: &Self| driver.system.energy(kink, &driver.state.q, Some(&driver.state.v)).kinetic;
        let earlier = kinetic(self);
        self.state.time = kink;
        let jump = self.method.pass(before, &mut self.state)?;
        // Work of the impulse of supports whose velocity jumps.
        self.state.work += kinetic(self) - earlier;
        if let StepControl::Tolerance(tolerance) = self.control {
            let n = self.state.q.len();
            self.step = self.step.min(step_by(self.system, &*self.method, tolerance, 2, &jump[..n]));
        }
        Ok(())
    }

    /// Records an attempted step. Where there are too many, every second record of the past is
    /// dropped, but rejected steps only if most are rejected.
    fn remember(&mut self, record: StepRecord) {
        let steps = self.method.statistics().steps;
        if record.accepted && !steps.is_multiple_of(self.stride) {
            return;
        }
        self.solution.history.push(record);
        if self.solution.history.len() > HISTORY {
            let rejected = self.solution.history.iter().filter(|record| !record.accepted).count();
            let mostly_rejected = rejected > HISTORY / 2;
            if !mostly_rejected {
                self.stride *= 2;
            }
            let mut keep = false;
            self.solution.history.retain(|record| {
                keep = !keep;
                keep || !(record.accepted || mostly_rejected)
            });
        }
    }
}

/// The direction at each watched point in a state, with as many full turns as bring it nearest to
/// the angle stored in the state.
pub(super) fn turned(directions: &[View], state: &State) -> Vec<f64> {
    let known = state.angles.iter().copied().chain(std::iter::repeat(f64::NAN));
    let angles = directions.iter().map(|view| view.fields(&state.q).angle()).zip(known);
    angles.map(|(angle, near)| unfold(angle, near.is_finite().then_some(near))).collect()
}

/// Whether `time` lies in the step of fixed length that is to be taken next; a saved state may
/// contradict this.
fn on_grid(control: StepControl, (start, taken): (f64, u64), time: f64) -> bool {
    match control {
        StepControl::Fixed(step) => {
            let parts = (time - start) / step - taken as f64;
            (-2.0 * NEAR..1.0 + 2.0 * NEAR).contains(&parts)
        }
        StepControl::Tolerance(_) => true,
    }
}

/// A step in which the fastest node moves by a part of a beam length that suits the tolerance.
fn first_step(
    system: &System,
    method: &dyn Method,
    [velocity, acceleration]: [&[f64]; 2],
    tolerance: f64,
) -> f64 {
    let by_speed = step_by(system, method, tolerance, 1, velocity);
    let by_acceleration = step_by(system, method, tolerance, 2, acceleration);
    // The end of the motion must not matter: one that is interrupted takes the same steps as one
    // that is not.
    by_speed.min(by_acceleration).min(FIRST_STEP * TAU / system.lowest_vibration_scale().sqrt())
}

/// The step that suits one derivative of the positions, of the given order.
fn step_by(system: &System, method: &dyn Method, tolerance: f64, order: i32, derivative: &[f64]) -> f64 {
    let largest = nodes(derivative).fold(0.0_f64, |m, v| m.max(v.shift() / system.length()).max(v.slope()));
    let part = 0.3 * tolerance.powf(1.0 / (method.order() + 1.0));
    (f64::from(order) * part / largest).powf(1.0 / f64::from(order))
}

/// The unknown that changed most.
pub(super) fn worst(increment: &[f64]) -> usize {
    let sizes = increment.iter().map(|d| d.abs()).enumerate();
    sizes.fold((0, 0.0), |worst, (i, d)| if d > worst.1 || d.is_nan() { (i, d) } else { worst }).0
}
