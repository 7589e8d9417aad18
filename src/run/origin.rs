//! Motions so far from the origin that positions have too few digits for them.

use super::sampler::Sampler;
use crate::model::{Dynamic, StepControl};
use crate::solve::dynamics::{STEP_PART, State};

/// Beam lengths from the origin up to which no other place would be much better.
const NEARBY: f64 = 10.0;
/// What counts as the tolerance of steps of given length: the one that is taken where nothing is said.
const TOLERANCE: f64 = 1e-6;

impl Sampler<'_> {
    /// The warning about positions whose round-off is more than a step may err by: no step, however
    /// short, is then as accurate as was asked for, and the shorter it is, the more of a velocity is
    /// round-off.
    pub(super) fn far_from_origin(&self, settings: &Dynamic, states: &[State]) -> Option<String> {
        let nodes = states.iter().flat_map(|state| state.q.as_chunks::<4>().0);
        let farthest = nodes.fold(0.0_f64, |far, [x, y, ..]| far.max(x.hypot(*y)));
        let far = farthest / self.system.length();
        let tolerance = match settings.integrator.step_control() {
            StepControl::Tolerance(tolerance) => tolerance,
            StepControl::Fixed(_) => TOLERANCE,
        };
        let known = f64::EPSILON * far;
        (far > NEARBY && known > STEP_PART * tolerance).then(|| {
            format!(
                "the motion goes on {far:.1e} beam lengths from the origin, where positions are known to {known:.0e} of a length only, and \
                 velocities and forces to much less: place the origin near the beams"
            )
        })
    }
}
