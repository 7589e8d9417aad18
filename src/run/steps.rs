//! Steps of fixed length that do not see what loads and supports do within them.

use crate::model::{Dynamic, StepControl};
use crate::system::System;
use std::f64::consts::{PI, TAU};

/// A message where a law of time goes through more than half a cycle in a step of fixed length: its values at the steps are then
/// those of a slower one.
pub(super) fn too_long(system: &System, settings: &Dynamic) -> Option<String> {
    let StepControl::Fixed(step) = settings.integrator.step_control() else { return None };
    let fastest = system.fastest_law();
    (fastest * step > PI).then(|| {
        format!(
            "a load or a support follows a law of {:.4e} Hz, which goes through {:.2} cycles in a step of {step:.3e} s: the motion is that of \
             a slower law; use steps below {:.1e} s, or a `tolerance`",
            fastest / TAU,
            fastest * step / TAU,
            0.1 * TAU / fastest
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    #[test]
    fn laws_faster_than_the_steps_are_told() {
        let messages = |frequency: f64, steps: &str| {
            let text = format!(
                "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1e3, mass_per_length = 1, \
                 basis.ancf.elements = 1 }}\n\
                 effect.force = [{{ beam = 'rod', at = 'start', value = [1, 0], in_time.harmonic.frequency = {frequency} }}]\n\
                 analysis.dynamic = {{ duration = 0.02, generalized_alpha = {{ {steps} }} }}\n"
            );
            let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
            let results = scene.model().solve(scene.analysis()).expect("a motion");
            results.run().warnings.iter().filter(|text| text.contains("a slower law")).count()
        };
        // Half a cycle a step of 1 ms is 500 Hz.
        assert_eq!([499.0, 501.0].map(|frequency| messages(frequency, "step = 1e-3")), [0, 1]);
        assert_eq!(messages(501.0, "tolerance = 1e-3"), 0);
    }
}
