//! Where a motion starts: at rest, with given velocities, or in a state that another analysis has
//! left.

use super::{Checkpoint, State};
use crate::assembly::nodes;
use crate::linear::Singular;
use crate::model::InitialVelocity;
use crate::numeric::plain;
use crate::solve::dynamics::motion::Motion;
use crate::system::{Holds, System};

/// Differences that count as round-off: between given and admissible velocities relative to the
/// largest, and between positions in beam lengths.
const ROUND_OFF: f64 = 1e-9;
/// The same for joints, which hold only to the accuracy of the equations.
const JOINED: f64 = 1e-6;
/// The same for the velocities of a state that a motion has left, perhaps at an event within a step,
/// where its polynomial holds joints and lengths to the accuracy of the steps.
const WITHIN_A_STEP: f64 = 1e-3;

/// Why a motion cannot start in the given state.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum StartError {
    /// A support does not allow the velocity.
    #[error(
        "the velocity at the start moves what a support holds: near s = {} m of beam `{beam}` the supports change it by {change:.3e} {unit}",
        plain(*.s, 6)
    )]
    #[diagnostic(help(
        "let the velocity vanish where the beam is held, such as by a rotation about a hinge: `rotation = \"2 rad/s\"`, `about = [0, 0]`; \
         and its slope where the direction is held, such as by `polynomial = {{ vy = [0, 0, 1] }}`"
    ))]
    Held {
        /// Name of the beam.
        beam: String,
        /// Arc length \[m\].
        s: f64,
        /// By how much the supports change the velocity.
        change: f64,
        /// Unit of the change.
        unit: &'static str,
    },
    /// A support comes that does not allow the velocity with which an earlier analysis has ended.
    #[error(
        "what moves is held all at once: near s = {} m of beam `{beam}` a support that was not there before changes its velocity by {change:.3e} {unit}",
        plain(*.s, 6)
    )]
    #[diagnostic(help(
        "an impact on what is rigid has no bound: let the motion before end where this point, or its direction, is at rest (an `[[analysis.dynamic.event]]` with `stop`), or \
         catch it by a stiff `effect.spring` or `effect.torsion_spring` with `damping`"
    ))]
    Caught {
        /// Name of the beam.
        beam: String,
        /// Arc length \[m\].
        s: f64,
        /// By how much the support changes the velocity.
        change: f64,
        /// Unit of the change.
        unit: &'static str,
    },
    /// A joint does not allow the velocity.
    #[error("the velocity at the start parts a joint: near s = {} m of beam `{beam}` what it holds moves apart at {rate:.3e} {unit}", plain(*.s, 6))]
    #[diagnostic(help(
        "let the points of a joint have one velocity, and beams of a weld one rate of turning, such as by the same `rotation` `about` the same place for \
         every beam, or by a `rotation` of the second about the place of the joint, with the `value` that the velocity of the first has there"
    ))]
    Parted {
        /// Name of one of the beams.
        beam: String,
        /// Arc length on it \[m\].
        s: f64,
        /// How fast it parts.
        rate: f64,
        /// Unit of the rate.
        unit: &'static str,
    },
    /// An inextensible beam does not allow the velocity.
    #[error("the velocity at the start stretches the inextensible beam `{beam}` near s = {} m, at {rate:.3e} m/s over a cell", plain(*.s, 6))]
    #[diagnostic(help(
        "let the beam move as a rigid body, by `value` and `rotation`, or across itself, or give it an `axial_stiffness`"
    ))]
    Stretched {
        /// Name of the beam.
        beam: String,
        /// Arc length \[m\].
        s: f64,
        /// How fast a cell becomes longer \[m/s\].
        rate: f64,
    },
    /// A joint of the scene is open in the state at the start, or a length not the one that is kept.
    #[error(
        "a joint, a support or a length that is kept holds beam `{beam}` near s = {} m, and the state at the start misses it by {miss:.3e} {unit}",
        plain(*.s, 6)
    )]
    #[diagnostic(help(
        "the joints of a motion must be closed in the state from which it starts, and beams that keep their length must have it: begin with the joints that \
         a saved state had, or go through statics before (a `[[stage]]`), which brings what is apart together"
    ))]
    Open {
        /// Name of the beam.
        beam: String,
        /// Arc length \[m\].
        s: f64,
        /// By how much the state misses it.
        miss: f64,
        /// Unit of that.
        unit: &'static str,
    },
    /// A tendon does not have its length at the start.
    #[error("a tendon of beam `{beam}` is {excess:.3e} m too long for its given length at t = {time} s")]
    #[diagnostic(help(
        "a motion begins with tendons that have their lengths: shorten them in a static stage before, or from zero on by a law of \
         time, such as `in_time.ramp = {{ duration = \"0.1 s\" }}`"
    ))]
    Tendon {
        /// Name of the beam.
        beam: String,
        /// By how much it is too long \[m\].
        excess: f64,
        /// When \[s\].
        time: f64,
    },
    /// A support jumps.
    #[error(
        "a support moves beam `{beam}` near s = {} m by {change:.3e} (m, or rad) at t = {time} s, all at once",
        plain(*.s, 6)
    )]
    #[diagnostic(help(
        "what jumps has no velocity, and its energy no bound: let the law begin where the beam is and take a time, such as \
         `smooth_ramp = {{ start = \"{time} s\", duration = \"10 ms\" }}`, a `table` with `smooth = true`, or a harmonic of phase 0"
    ))]
    Jump {
        /// Name of the beam.
        beam: String,
        /// Arc length \[m\].
        s: f64,
        /// Time of the jump \[s\].
        time: f64,
        /// By how much the support jumps \[m or rad\].
        change: f64,
    },
    /// A coordinate has no mass.
    #[error(transparent)]
    Singular(#[from] Singular),
}

/// The angle \[rad\] between two gradients, whose coordinates begin at `i`.
fn turn(imposed: &[f64], q: &[f64], i: usize) -> f64 {
    let ([a, b], [x, y]) = ([imposed[i], imposed[i + 1]], [q[i], q[i + 1]]);
    (a * y - b * x).atan2(a * x + b * y).abs()
}

/// The largest of a vector of coordinates, those of positions in beam lengths: its place and size.
fn largest(system: &System, of: impl Fn(usize) -> f64) -> (usize, f64) {
    let unit = |i: usize| if i % 4 < 2 { system.length() } else { 1.0 };
    let sizes = (0..system.coordinates()).map(|i| (i, of(i).abs() / unit(i)));
    sizes.fold((0, 0.0), |w, c| if c.1 > w.1 { c } else { w })
}

/// Refuses supports that jump between `start` and `end` \[s\].
///
/// # Errors
/// [`StartError::Jump`] naming the first that does.
pub fn check_jumps(system: &System, start: f64, end: f64) -> Result<(), StartError> {
    let within = system.supports().jumps().filter(|(_, time, _)| *time > start && *time <= end);
    match within.min_by(|a, b| a.1.total_cmp(&b.1)) {
        None => Ok(()),
        Some((at, time, change)) => Err(jump(system, at, time, change)),
    }
}

fn jump(system: &System, at: usize, time: f64, change: f64) -> StartError {
    let (beam, s) = system.place_of(at);
    StartError::Jump { beam: system.beams()[beam].name.clone(), s, time, change }
}

/// The state in which the model begins, with the given velocities.
///
/// # Errors
/// [`StartError::Held`], [`StartError::Parted`] or [`StartError::Stretched`] where supports, joints or lengths do not allow them,
/// [`StartError::Jump`] where a support starts elsewhere.
pub fn from_rest(system: &System, velocities: &[InitialVelocity]) -> Result<Checkpoint, StartError> {
    let (_, variables) = system.start_history();
    from_state(system, State { variables, ..State::at_rest(system.start()) }, velocities)
}

/// A state with the given velocities added to its own. The kinetic energy that supports add by
/// moving from the first instant counts as work.
///
/// # Errors
/// [`StartError::Held`], [`StartError::Parted`] or [`StartError::Stretched`] where supports, joints or lengths do not allow the
/// velocities, [`StartError::Jump`] where a support is elsewhere, [`StartError::Open`] where a joint is open.
pub fn from_state(
    system: &System,
    mut state: State,
    velocities: &[InitialVelocity],
) -> Result<Checkpoint, StartError> {
    let mut imposed = state.q.clone();
    system.supports().impose(state.time, &mut imposed);
    let (at, change) = largest(system, |i| imposed[i] - state.q[i]);
    if change > ROUND_OFF {
        let change = match at % 4 {
            0 | 1 => (imposed[at] - state.q[at]).abs(),
            _ => turn(&imposed, &state.q, 4 * (at / 4) + 2).max(change),
        };
        return Err(jump(system, at, state.time, change));
    }
    if let Some((beam, excess)) = system.missed_length(state.time, &state.q)
        && excess.abs() > JOINED * system.length()
    {
        return Err(StartError::Tendon { beam: beam.to_owned(), excess, time: state.time });
    }
    if let Some(((beam, s), is_length, miss)) = system.missed(state.time, &state.q)
        && miss > JOINED
    {
        let (miss, unit) = if is_length { (miss * system.length(), "m") } else { (miss, "rad") };
        return Err(StartError::Open { beam: system.beams()[beam].name.clone(), s, miss, unit });
    }
    state.q = imposed;
    let at_rest = velocities.is_empty() && state.v.iter().all(|v| *v == 0.0);
    if at_rest && !system.works_by_constraints() {
        return Ok(Checkpoint { state, ..Checkpoint::default() });
    }
    for velocity in velocities {
        let Some(part) = system.beams().get(velocity.beam) else { continue };
        let first = 4 * part.first_node;
        let range = first..first + 4 * part.basis.nodes().len();
        let coordinates = nodes(&state.q[range.clone()]).zip(state.v[range].chunks_exact_mut(4));
        for (s, (node, v)) in part.basis.nodes().iter().zip(coordinates) {
            let rates = velocity.at(*s, node.position, node.gradient);
            v.iter_mut().zip(rates).for_each(|(v, rate)| *v += rate);
        }
    }
    let admissible = Motion::new(system)?.admissible_velocity(state.time, &state.q, &state.v)?;
    // A support that moves gives the beam its velocity.
    let moves = system.works_by_constraints();
    let mut given = state.v.clone();
    for (i, (given, admissible)) in given.iter_mut().zip(&admissible).enumerate() {
        if moves && !system.supports().is_stationary(i) {
            *given = *admissible;
        }
    }
    let (worst, change) = largest(system, |i| given[i] - admissible[i]);
    let allowed = if velocities.is_empty() { WITHIN_A_STEP } else { ROUND_OFF };
    // Velocities of a motion that has come to rest are round-off beside those of its slowest vibration.
    let rest =
        if velocities.is_empty() { f64::EPSILON * system.lowest_vibration_scale().sqrt() } else { 0.0 };
    // What is at rest until laws move it has no velocity that supports could contradict.
    let allowed = rest.max(allowed * largest(system, |i| state.v[i]).1);
    if !at_rest && change > allowed {
        let changes: Vec<f64> =
            given.iter().zip(&admissible).map(|(given, admissible)| given - admissible).collect();
        return Err(refused(system, &state, allowed, (worst, changes), velocities.is_empty()));
    }
    let kinetic = |v: &[f64]| system.energy(state.time, &state.q, Some(v)).kinetic;
    state.work += kinetic(&admissible) - kinetic(&state.v);
    state.v = admissible;
    Ok(Checkpoint { state, ..Checkpoint::default() })
}

/// What does not allow the velocities of a state: a joint or a length whose own rate is larger than `allowed` (1/s, lengths in
/// beam lengths), or else supports, which make `changes` of the velocities, the largest of coordinate `worst`. Where the velocities
/// are those with which an `earlier` analysis has ended, these supports are new.
fn refused(
    system: &System,
    state: &State,
    allowed: f64,
    (worst, mut changes): (usize, Vec<f64>),
    earlier: bool,
) -> StartError {
    let name = |beam: usize| system.beams()[beam].name.clone();
    if let Some(((beam, s), holds, rate)) = system.missed_rate(state.time, &state.q, &state.v) {
        let beam = name(beam);
        match holds {
            Holds::Together if rate > allowed * system.length() => {
                return StartError::Parted { beam, s, rate, unit: "m/s" };
            }
            Holds::Angle if rate > allowed => return StartError::Parted { beam, s, rate, unit: "rad/s" },
            Holds::Length if rate > allowed * system.length() => {
                return StartError::Stretched { beam, s, rate };
            }
            _ => {}
        }
    }
    // What is held itself tells more than what it drags along.
    let of_worst = changes[worst].abs();
    system.supports().keep_fixed(state.time, &mut changes);
    let (held, excess) = largest(system, |i| changes[i]);
    let (at, change) = if excess > 0.0 { (held, changes[held].abs()) } else { (worst, of_worst) };
    let ((beam, s), unit) = (system.place_of(at), if at % 4 < 2 { "m/s" } else { "rad/s" });
    match earlier {
        false => StartError::Held { beam: name(beam), s, change, unit },
        true => StartError::Caught { beam: name(beam), s, change, unit },
    }
}
