//! How far one run is from another.

use serde::Serialize;

use crate::accuracy::difference::pairs;
use crate::model::{Analysis, Model};
use crate::output::drift;
use crate::results::{AnalysisKind, Results, Shape, Trajectory};

/// Records belong together when their times or load factors differ by less than this, relative to
/// the last one.
const SAME: f64 = 1e-9;

/// Errors of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Deviation {
    /// What the target refers to. Statics and motion: largest distance of a probe from its place in
    /// the reference, over probes and common records, in lengths of the probe's beam. Modal
    /// analysis and buckling: largest relative error of a frequency or load factor.
    pub error: f64,
    /// Root mean square error of the curvature along all beams in the last state, relative to the
    /// largest curvature there; `None` where nothing bends or there is no state.
    pub curvature: Option<f64>,
    /// Statics: relative error of the strain energy in the last state. Motion: max |total −
    /// initial| / max kinetic, which needs no reference.
    pub energy: Option<f64>,
}

impl Deviation {
    /// Name and unit of [`Deviation::error`] for this analysis.
    pub fn name(analysis: AnalysisKind) -> &'static str {
        match analysis {
            AnalysisKind::Static | AnalysisKind::Dynamic => "position error [beam lengths]",
            AnalysisKind::Modal => "relative error of frequencies",
            AnalysisKind::Buckling => "relative error of load factors",
        }
    }

    /// The deviation of `run` from `reference`, both of `model` with this `analysis`.
    ///
    /// # Errors
    /// In words, where they cannot be compared.
    pub fn between(
        model: &Model,
        analysis: &Analysis,
        run: &Results,
        reference: &Results,
    ) -> Result<Self, String> {
        let eigenvalues = |what| values(&run.eigenvalues(), &reference.eigenvalues(), what);
        let (run, reference) = (run.states(), reference.states());
        let error = match analysis {
            Analysis::Modal(_) => eigenvalues("frequencies")?,
            Analysis::Buckling(_) => eigenvalues("load factors")?,
            Analysis::Static(_) | Analysis::Dynamic(_) | Analysis::Stages => {
                positions(model, run, reference, &pairs(analysis, &run.parameter, &reference.parameter)?)
            }
        };
        if !error.is_finite() {
            return Err("its error is not a number".into());
        }
        let energy = match analysis {
            Analysis::Static(_) => strain_energy(run).zip(strain_energy(reference)).and_then(|(u, exact)| {
                let error = ((u - exact) / exact).abs();
                error.is_finite().then_some(error)
            }),
            Analysis::Dynamic(_) => drift(&run.energy),
            Analysis::Modal(_) | Analysis::Buckling(_) | Analysis::Stages => None,
        };
        let has_state = matches!(analysis, Analysis::Static(_) | Analysis::Dynamic(_));
        let curvature = if has_state { curvature(&run.last, &reference.last) } else { None };
        Ok(Self { error, curvature, energy })
    }
}

fn positions(model: &Model, run: &Trajectory, reference: &Trajectory, pairs: &[(usize, usize)]) -> f64 {
    let mut largest = 0.0_f64;
    for ((probe, ours), theirs) in model.probes.iter().zip(&run.probes).zip(&reference.probes) {
        let length = reference.run.undeformed.get(probe.at.beam).and_then(|beam| beam.s.last());
        for &(i, j) in pairs {
            if let (Some(a), Some(b), Some(length)) = (ours.samples.get(i), theirs.samples.get(j), length) {
                let distance = (a.x - b.x).hypot(a.y - b.y) / length;
                // A maximum that keeps a NaN.
                largest = if distance > largest || distance.is_nan() { distance } else { largest };
            }
        }
    }
    largest
}

fn values(run: &[f64], reference: &[f64], what: &str) -> Result<f64, String> {
    if run.len() != reference.len() || run.is_empty() {
        return Err(format!("{} {what} where the reference has {}", run.len(), reference.len()));
    }
    let largest = reference.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    // Motions that nothing resists have the frequency 0, or its round-off.
    let relative =
        |(a, b): (&f64, &f64)| (a - b).abs() / if b.abs() > SAME * largest { b.abs() } else { largest };
    Ok(run.iter().zip(reference).map(relative).fold(0.0, f64::max))
}

fn strain_energy(t: &Trajectory) -> Option<f64> {
    t.energy.last().map(|energy| energy.stretch + energy.bend)
}

fn curvature(run: &[Shape], reference: &[Shape]) -> Option<f64> {
    let (mut sum, mut count, mut largest, mut length) = (0.0, 0_usize, 0.0_f64, 0.0_f64);
    for (a, b) in run.iter().zip(reference) {
        for (a, b) in a.curvature.iter().zip(&b.curvature) {
            sum += (a - b) * (a - b);
            count += 1;
            largest = largest.max(b.abs());
        }
        length = b.s.last().map_or(length, |l| length.max(*l));
    }
    (largest * length > 1e-9).then(|| (sum / count as f64).sqrt() / largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::difference::common;
    use crate::model::{
        About, ArcLength, Buckling, Dynamic, Integrator, Modal, Place, Probe, STEP_CONTROL, Static,
    };
    use crate::results::{
        BucklingMode, CriticalLoads, Energy, ProbeSample, ProbeSeries, Run, Vibration, Vibrations,
    };

    /// Probes on two beams, 2 m and 0.5 m long.
    fn model() -> Model {
        let probes = [0, 1].map(|beam| Probe::new("probe", Place::new(beam, 0.25)));
        Model { probes: probes.into(), ..Model::default() }
    }

    /// A run with these records, of which the probes see the places `first` and `second`.
    fn run(parameter: &[f64], first: &[[f64; 2]], second: &[[f64; 2]]) -> Trajectory {
        let series = |places: &[[f64; 2]]| ProbeSeries {
            name: "probe".into(),
            samples: places.iter().map(|&[x, y]| ProbeSample { x, y, ..ProbeSample::default() }).collect(),
        };
        Trajectory {
            run: Run {
                undeformed: [2.0, 0.5]
                    .map(|length| Shape { s: vec![0.0, length], ..Shape::default() })
                    .into(),
                ..Run::default()
            },
            parameter: parameter.into(),
            probes: vec![series(first), series(second)],
            ..Trajectory::default()
        }
    }

    fn vibrations(frequency: f64) -> Results {
        let modes = vec![Vibration { frequency, round_off: 0.0, shape: vec![] }];
        Vibrations { modes, ..Vibrations::default() }.into()
    }

    fn still() -> Analysis {
        Analysis::Static(Static::default())
    }

    fn path() -> Analysis {
        let arc = ArcLength { until_load: Some(1.0), max_points: 9, max_step: None, until_probe: None };
        Analysis::Static(Static { arc_length: Some(arc), ..Static::default() })
    }

    fn error(analysis: &Analysis, ours: &Trajectory, theirs: &Trajectory) -> Result<f64, String> {
        Deviation::between(&model(), analysis, &ours.clone().into(), &theirs.clone().into())
            .map(|deviation| deviation.error)
    }

    #[test]
    fn an_error_is_called_what_it_is() {
        let kinds =
            [AnalysisKind::Static, AnalysisKind::Dynamic, AnalysisKind::Modal, AnalysisKind::Buckling];
        let expected = [
            "position error [beam lengths]",
            "position error [beam lengths]",
            "relative error of frequencies",
            "relative error of load factors",
        ];
        assert_eq!(kinds.map(Deviation::name), expected);
    }

    #[test]
    fn records_are_compared_where_both_have_one() {
        let pairs = common(&[0.0, 0.25, 0.5, 1.0], &[0.0, 0.5, 0.75, 1.0 + 1e-12]).unwrap();
        assert_eq!(pairs, [(0, 0), (2, 1), (3, 3)]);
        assert!(common(&[0.1], &[0.0, 0.2]).is_err());
    }

    /// To 1e-9 of the last time, which is 1000 s: a microsecond.
    #[test]
    fn records_belong_together_whose_times_hardly_differ() {
        for (apart, together) in [(-1e-7, true), (1e-7, true), (-2e-6, false), (2e-6, false)] {
            let pairs = common(&[0.0, 500.0 + apart, 1000.0], &[0.0, 500.0, 1000.0]).unwrap();
            assert_eq!(pairs.contains(&(1, 1)), together, "{apart}: {pairs:?}");
            assert!(pairs.contains(&(0, 0)) && pairs.contains(&(2, 2)), "{apart}: {pairs:?}");
        }
        // A run that ends early, and an equilibrium without a load.
        assert_eq!(common(&[0.0, 0.5], &[0.0, 0.5, 1.0]).unwrap(), [(0, 0), (1, 1)]);
        assert_eq!(common(&[0.0], &[0.0]).unwrap(), [(0, 0)]);
        assert!(common(&[], &[0.0]).is_err() && common(&[0.0], &[]).is_err());
    }

    /// The first probe is off by (0.75, 1) m of 2 m halfway, the second by 0.25 m of 0.5 m at the
    /// end.
    #[test]
    fn positions_err_by_their_largest_distance_in_lengths() {
        let (steps, origin) = ([0.0, 0.5, 1.0], [[0.0, 0.0], [1.0, 1.0], [1.0, 1.0]]);
        let reference = run(&steps, &origin, &origin);
        let halfway = [[0.0, 0.0], [1.75, 2.0], [1.0, 1.0]];
        let end = [[0.0, 0.0], [1.0, 1.0], [1.25, 1.0]];
        assert_eq!(error(&still(), &run(&steps, &halfway, &end), &reference), Ok(0.625));
        assert_eq!(error(&still(), &run(&steps, &origin, &end), &reference), Ok(0.5));
        assert_eq!(error(&still(), &reference, &reference), Ok(0.0));
        let lost = [[0.0, 0.0], [f64::NAN, 1.0], [1.0, 1.0]];
        let nowhere = error(&still(), &run(&steps, &lost, &end), &reference);
        assert_eq!(nowhere, Err("its error is not a number".to_owned()));
        // The ends of paths are compared wherever they are.
        let ours = run(&[0.0, 0.75], &[[9.0, 9.0], [1.0, 2.25]], &[[0.0, 0.0], [1.0, 1.0]]);
        assert_eq!(error(&path(), &ours, &reference), Ok(0.625));
        assert_eq!(error(&path(), &run(&[], &[], &[]), &reference), Err("no record".to_owned()));
    }

    /// In statics there are 1.5 J in place of 2 J; in motion 0.5 J are gained, and the kinetic
    /// energy is at most 2 J.
    #[test]
    fn energies_err_by_analysis() {
        let with = |energy: Vec<Energy>| Trajectory { energy, ..run(&[1.0], &[[0.0; 2]], &[[0.0; 2]]) };
        let strain = |stretch: f64, bend: f64| Energy { stretch, bend, ..Energy::default() };
        let reference = with(vec![strain(0.5, 1.5)]);
        let error = |analysis: &Analysis, ours: &Trajectory, theirs: &Trajectory| {
            Deviation::between(&model(), analysis, &ours.clone().into(), &theirs.clone().into())
                .unwrap()
                .energy
        };
        let ours = with(vec![strain(7.0, 7.0), strain(0.5, 1.0)]);
        assert_eq!(error(&still(), &ours, &reference), Some(0.25));
        assert_eq!(error(&still(), &ours, &with(vec![Energy::default()])), None);
        assert_eq!(error(&still(), &with(vec![]), &reference), None);
        let integrator = Integrator::usual(STEP_CONTROL);
        let motion =
            Analysis::Dynamic(Dynamic { duration: 1.0, output_every: 1.0, integrator, events: vec![] });
        let moving = Energy { kinetic: 2.0, potential: -1.5, ..Energy::default() };
        let ours = with(vec![Energy::default(), moving]);
        assert_eq!(error(&motion, &ours, &reference), Some(0.25));
    }

    #[test]
    fn eigenvalues_are_compared_one_by_one() {
        assert_eq!(values(&[0.0, 2.2, 4.0], &[1e-13, 2.0, 4.0], "f").unwrap(), 0.10000000000000009);
        assert!(values(&[1.0], &[1.0, 2.0], "f").is_err());
        assert!(values(&[], &[], "f").is_err());
        // The frequency of a free motion is round-off of the largest one, up to 1e-9 of it.
        assert_eq!(values(&[0.0, 1000.0], &[1e-8, 1000.0], "f").unwrap(), 1e-8 / 1000.0);
        assert_eq!(values(&[0.0, 0.25], &[1e-12, 0.25], "f").unwrap(), 4e-12);
        assert_eq!(values(&[0.0, 1.0], &[1e-9, 1.0], "f").unwrap(), 1e-9);
        assert_eq!(values(&[-1.5, 0.5], &[-2.0, 0.5], "f").unwrap(), 0.25);
        let between = |analysis: &Analysis, found: [Results; 2]| {
            Deviation::between(&model(), analysis, &found[0], &found[1]).unwrap()
        };
        let modal = Analysis::Modal(Modal { count: 1, about: About::Reference });
        let found = between(&modal, [vibrations(3.0), vibrations(4.0)]);
        assert_eq!(found, Deviation { error: 0.25, curvature: None, energy: None });
        let loads = [5.0, 8.0].map(|load_factor| {
            let modes = vec![BucklingMode { load_factor, round_off: 0.0, shape: vec![] }];
            CriticalLoads { modes, ..CriticalLoads::default() }.into()
        });
        let found = between(&Analysis::Buckling(Buckling { count: 1 }), loads);
        assert_eq!(found, Deviation { error: 0.375, curvature: None, energy: None });
    }

    /// Root mean square of 3, −4 and 0 over the largest curvature.
    #[test]
    fn curvatures_err_in_the_mean() {
        let shape = |length: f64, curvature: &[f64]| Shape {
            s: vec![0.0, length],
            curvature: curvature.into(),
            ..Shape::default()
        };
        let reference = [shape(0.5, &[8.0, -10.0]), shape(0.25, &[1.0])];
        let ours = [shape(0.5, &[11.0, -14.0]), shape(0.25, &[1.0])];
        let expected = (25.0_f64 / 3.0).sqrt() / 10.0;
        let found = curvature(&ours, &reference).unwrap();
        assert!((found - expected).abs() < 1e-15, "{found}");
        // Where the largest curvature would turn the longest beam by 1e-9 rad nothing bends.
        let bent = |curvatures: [f64; 2], length: f64| {
            let [ours, theirs] = curvatures.map(|value| [shape(length, &[value])]);
            curvature(&ours, &theirs)
        };
        assert_eq!(bent([0.0, 0.0], 2.0), None);
        assert_eq!(bent([0.0, 1e-10], 20.0), Some(1.0));
        assert_eq!(bent([0.0, 1.5e-9], 0.5), None);
        assert_eq!(bent([0.0, 1e-9], 1.0), None);
        assert_eq!(bent([0.03125, 0.0625], 2.0), Some(0.5));
        // The longest beam decides, wherever it stands in the list.
        let straight = [shape(2.0, &[1e-9]), shape(0.1, &[1e-9])];
        assert_eq!(curvature(&straight, &straight), Some(0.0));
    }

    #[test]
    fn what_has_no_state_has_no_curvature() {
        let bent = |curvature: f64| Trajectory {
            last: vec![Shape { s: vec![0.0, 1.0], curvature: vec![curvature], ..Shape::default() }],
            ..run(&[1.0], &[[0.0; 2]], &[[0.0; 2]])
        };
        let curvature = |analysis: &Analysis, [ours, theirs]: [Results; 2]| {
            Deviation::between(&model(), analysis, &ours, &theirs).unwrap().curvature
        };
        assert_eq!(curvature(&still(), [3.0, 4.0].map(|k| bent(k).into())), Some(0.25));
        let modal = Analysis::Modal(Modal { count: 1, about: About::Reference });
        let vibrating = [3.0, 4.0].map(|k| {
            let modes = vec![Vibration { frequency: 1.0, round_off: 0.0, shape: vec![] }];
            Vibrations { equilibrium: bent(k), modes }.into()
        });
        assert_eq!(curvature(&modal, vibrating), None);
    }
}
