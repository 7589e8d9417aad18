//! Errors of single records and places, as they are stated.

use crate::results::{BeamErrors, ProbeErrors, ProbeSample};

/// The records around one whose errors count for it, on either side, as a part of the run.
const WINDOW: usize = 20;

/// Errors oscillate, and a moment at which two runs agree by chance is no better than those around
/// it: the largest within a twentieth of the run on either side.
pub(super) fn of_probe(mut probe: ProbeErrors, [result, curvature]: [f64; 2]) -> ProbeErrors {
    let reach = probe.samples.len() / WINDOW;
    let around: Vec<ProbeSample> = (0..probe.samples.len())
        .map(|i| {
            let last = (i + reach).min(probe.samples.len() - 1);
            if probe.samples[i].x.is_nan() {
                return probe.samples[i];
            }
            probe.samples[i.saturating_sub(reach)..=last].iter().fold(
                ProbeSample::default(),
                |most, sample| {
                    let of = |a: Option<f64>, b: Option<f64>| b.map(|b| a.map_or(b, |a| a.max(b)));
                    ProbeSample {
                        x: most.x.max(sample.x),
                        y: most.y.max(sample.y),
                        angle: most.angle.max(sample.angle),
                        curvature: most.curvature.max(sample.curvature),
                        strain: most.strain.max(sample.strain),
                        vx: of(most.vx, sample.vx),
                        vy: of(most.vy, sample.vy),
                    }
                },
            )
        })
        .collect();
    probe.samples = around;
    for sample in &mut probe.samples {
        sample.x /= result;
        sample.y /= result;
        sample.angle /= result;
        sample.strain /= curvature;
        sample.curvature /= curvature;
        sample.vx = sample.vx.map(|v| v / result);
        sample.vy = sample.vy.map(|v| v / result);
    }
    probe
}

/// Errors along a beam from their differences.
pub(super) fn of_beam(mut beam: BeamErrors, [result, curvature]: [f64; 2]) -> BeamErrors {
    beam.position.iter_mut().for_each(|error| *error /= result);
    beam.curvature.iter_mut().for_each(|error| *error /= curvature);
    beam
}
