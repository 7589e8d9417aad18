//! Errors of single records and places, as they are stated.

use crate::results::{ProbeErrors, ProbeSample};

/// The records around one whose errors count for it, on either side, as a part of the run.
const WINDOW: usize = 20;

/// Errors oscillate, and a moment at which two runs agree by chance is no better than those around
/// it: the largest within a twentieth of the run on either side.
pub(super) fn of_probe(mut probe: ProbeErrors) -> ProbeErrors {
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
    probe
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forty records: two on either side count.
    #[test]
    fn the_largest_error_around_a_record_counts() {
        let mut samples = vec![ProbeSample { vx: Some(0.0), ..ProbeSample::default() }; 40];
        samples[10] =
            ProbeSample { x: 4.0, y: 6.0, angle: 8.0, curvature: 9.0, strain: 12.0, vx: Some(2.0), vy: None };
        samples[39].y = 10.0;
        samples[20].x = f64::NAN;
        let found = of_probe(ProbeErrors { name: "tip".into(), samples }).samples;
        let x = |value: f64| found.iter().enumerate().filter(move |(_, s)| s.x == value).map(|(i, _)| i);
        assert_eq!(x(4.0).collect::<Vec<_>>(), [8, 9, 10, 11, 12]);
        let around =
            ProbeSample { x: 4.0, y: 6.0, angle: 8.0, curvature: 9.0, strain: 12.0, vx: Some(2.0), vy: None };
        assert_eq!((found[8], found[12]), (around, around));
        assert_eq!([36, 37, 38, 39].map(|i| found[i].y), [0.0, 10.0, 10.0, 10.0]);
        assert!(found[20].x.is_nan() && found[19].x == 0.0, "of a record nothing may be known");
    }
}
