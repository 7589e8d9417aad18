//! Where a motion starts: at rest, or with given velocities.

use super::{Checkpoint, State};
use crate::linear::Singular;
use crate::model::InitialVelocity;
use crate::solve::dynamics::motion::Motion;
use crate::system::System;

/// Difference between given and admissible velocities, relative to the largest, that counts as round-off.
const ROUND_OFF: f64 = 1e-9;

/// Why a motion cannot start so.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum StartError {
    /// A support does not allow the velocity.
    #[error(
        "the initial velocity moves what a support holds: near s = {s:.6} m of beam `{beam}` the supports change it by {change:.3e} m/s"
    )]
    #[diagnostic(help(
        "let the velocity vanish where the beam is held, such as by a rotation about a hinge: `rotation = \"2 rad/s\"`, `about = [0, 0]`; \
         and its slope where the direction is held, such as by `polynomial = {{ vy = [0, 0, 1] }}`"
    ))]
    Held {
        /// The beam.
        beam: String,
        /// Where \[m\].
        s: f64,
        /// By how much the supports change the velocity \[m/s\].
        change: f64,
    },
    /// A law of a support is not zero at the start.
    #[error(
        "a support moves beam `{beam}` near s = {s:.6} m by {change:.3e} (m, or rad) at the start, all at once"
    )]
    #[diagnostic(help("let its law begin with zero, such as `smooth_ramp` or a harmonic of phase 0"))]
    Jump {
        /// The beam.
        beam: String,
        /// Where \[m\].
        s: f64,
        /// By how much.
        change: f64,
    },
    /// A coordinate has no mass.
    #[error(transparent)]
    Singular(#[from] Singular),
}

/// The place and size of the largest difference of two vectors.
fn largest_difference(a: &[f64], b: &[f64]) -> (usize, f64) {
    let changes = a.iter().zip(b).map(|(a, b)| (a - b).abs()).enumerate();
    changes.fold((0, 0.0), |w, c| if c.1 > w.1 { c } else { w })
}

/// The stress-free state with the given velocities.
///
/// # Errors
/// [`StartError::Held`] where supports do not allow them, [`StartError::Jump`] where a support starts elsewhere.
pub fn from_rest(system: &System, velocities: &[InitialVelocity]) -> Result<Checkpoint, StartError> {
    let mut state = State::at_rest(system.reference());
    system.supports().impose(0.0, &mut state.q);
    let (at, change) = largest_difference(&state.q, system.reference());
    if change > ROUND_OFF * system.length().max(1.0) {
        let (beam, s) = system.place_of(at);
        return Err(StartError::Jump { beam: system.beams()[beam].name.clone(), s, change });
    }
    if velocities.is_empty() && !system.supports().moves_in_time() {
        return Ok(Checkpoint { state, ..Checkpoint::default() });
    }
    for velocity in velocities {
        let Some(part) = system.beams().get(velocity.beam) else { continue };
        let first = 4 * part.first_node;
        let range = first..first + 4 * part.basis.nodes().len();
        let coordinates = state.q[range.clone()].chunks_exact(4).zip(state.v[range].chunks_exact_mut(4));
        for (s, (q, v)) in part.basis.nodes().iter().zip(coordinates) {
            let rates = velocity.at(*s, [q[0], q[1]], [q[2], q[3]]);
            v.iter_mut().zip(rates).for_each(|(v, rate)| *v += rate);
        }
    }
    let admissible = Motion::new(system)?.admissible_velocity(state.time, &state.q, &state.v)?;
    let largest = state.v.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    // A support that moves gives the beam its velocity.
    let moves = system.supports().moves_in_time();
    let mut given = state.v.clone();
    for (i, (given, admissible)) in given.iter_mut().zip(&admissible).enumerate() {
        if moves && !system.supports().holds_still(i) {
            *given = *admissible;
        }
    }
    let (worst, change) = largest_difference(&given, &admissible);
    if change > ROUND_OFF * largest {
        let (beam, s) = system.place_of(worst);
        return Err(StartError::Held { beam: system.beams()[beam].name.clone(), s, change });
    }
    state.v = admissible;
    Ok(Checkpoint { state, ..Checkpoint::default() })
}
