//! Beams that electrodes pull to themselves.

use crate::effect::Electrostatic;
use crate::model::Model;
use crate::results::Shape;
use std::any::Any;

/// Part of its stress-free gap below which an electrode has pulled a beam in. In equilibrium pull-in begins at two
/// thirds of the gap between stiff plates, at a little more than half of it at the tip of a cantilever, and in a motion after a sudden
/// voltage at half of it.
const PULLED_IN: f64 = 0.35;

/// What to say of a run that found no further state, if an electrode has pulled in a beam in the state `now`; `free` is
/// the stress-free state at the same places.
pub(super) fn pulled_in(model: &Model, now: &[Shape], free: &[Shape]) -> Option<String> {
    let gaps = model.parts.iter().filter_map(|part| {
        let part: &dyn Any = part.as_ref();
        let plate = part.downcast_ref::<Electrostatic>()?;
        let (now, free) = (now.get(plate.beam)?, free.get(plate.beam)?);
        let gap = |shape: &Shape, i: usize| {
            let across = [shape.x[i] - plate.point[0], shape.y[i] - plate.point[1]];
            plate.normal[0] * across[0] + plate.normal[1] * across[1] - plate.half_thickness
        };
        let facing =
            (0..now.s.len().min(free.s.len())).filter(|i| plate.facing.at(now.s[*i], now.s[*i]) != 0.0);
        facing
            .map(|i| (gap(now, i) / gap(free, i), gap(now, i), now.s[i], &now.beam))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    });
    let (part, gap, s, beam) = gaps.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (part < PULLED_IN).then(|| {
        format!(
            "an electrode has pulled beam `{beam}` in: at s = {s:.4e} m its gap is {:.2e} m, {:.0} % of that of the stress-free beam, and its force grows \
             without bound where it closes: end the run before, by an event, or use less voltage; or let a contact stop the beam before the electrode",
            gap.max(0.0),
            100.0 * part.max(0.0)
        )
    })
}
