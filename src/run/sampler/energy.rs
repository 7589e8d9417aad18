//! Warnings of energies that do not balance.

use crate::results::Energy;
use crate::solve::Work;

/// Part of the largest energy by which the work of actuators may err without a warning.
const WORK_KNOWN: f64 = 1e-2;
/// Change of the total energy, relative to the largest energy, that is worth a warning.
const LARGEST_DRIFT: f64 = 1e-2;

/// The warning about a motion whose balance of energy is off by more than a hundredth of its
/// largest energy, if that is more than `least` \[J\].
pub(super) fn unbalanced(energy: &[Energy], least: f64) -> Option<String> {
    let first = energy.first()?;
    let change = |e: &Energy| e.total() - first.total();
    let off = energy.iter().map(change).fold(0.0_f64, |m, c| if c.abs() > m.abs() { c } else { m });
    let parts =
        |e: &Energy| [e.stretch, e.bend, e.stored, e.kinetic, e.potential - first.potential, e.work, e.lost];
    let largest = energy.iter().flat_map(parts).fold(0.0_f64, |m, part| m.max(part.abs()));
    let share = off.abs() / largest;
    (largest > least && share > LARGEST_DRIFT).then(|| {
        let (what, meaning) = if off > 0.0 {
            ("gained", "that nothing put in: it is not the motion of this beam")
        } else {
            (
                "lost",
                "that no damping took: vibrations that are too fast for the steps are missing, or more than these",
            )
        };
        format!(
            "the motion has {what} {:.2e} J, {:.2} of its largest energy, {meaning}; compare with a smaller `tolerance` or `step`, or with \
             a finer mesh",
            off.abs(),
            share
        )
    })
}

/// The warning about the work of actuators, if its error is not small against the energies of the
/// state.
pub(super) fn put_in(work: &Work, energy: &Energy) -> Option<String> {
    let parts = [energy.stretch, energy.bend, energy.stored, energy.potential, work.value, work.size];
    let largest = parts.iter().fold(0.0_f64, |m, part| m.max(part.abs()));
    (work.error > WORK_KNOWN * largest).then(|| {
        format!(
            "the energy that actuation has put in, {:.3e} J, is a sum over the states of the path and may err by {:.0e} J: give more `steps`, \
             or a smaller `max_step` of the arc length",
            work.value, work.error
        )
    })
}
