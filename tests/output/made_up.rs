//! Trajectories whose numbers are made up, so that no solver moves a point. Sizes are far from one
//! and from each other, so that a factor that is lost shows.

use ancf::results::{
    AnalysisKind, BucklingMode, ContactImpulse, CriticalLoads, EffectSeries, Energy, Event, Frame, ModeShape,
    ProbeSample, ProbeSeries, ReactionSeries, Results, Run, Seconds, Shape, Statistics, StepRecord,
    Trajectory, Vibration, Vibrations,
};
use ancf::system::Reaction;

/// A beam through points at even arc lengths, nodes at its ends.
pub(super) fn beam(name: &str, length: f64, points: &[[f64; 2]]) -> Shape {
    let parts = (points.len().max(2) - 1) as f64;
    let s: Vec<f64> = (0..points.len()).map(|i| length * i as f64 / parts).collect();
    let along = |factor: f64| s.iter().map(|s| factor * s).collect::<Vec<f64>>();
    Shape {
        beam: name.to_owned(),
        x: points.iter().map(|p| p[0]).collect(),
        y: points.iter().map(|p| p[1]).collect(),
        angle: along(0.5),
        strain: along(-1e-3),
        curvature: along(0.25),
        axial_force: along(40.0),
        shear_force: along(-3.0),
        bending_moment: along(0.7),
        nodes: vec![points[0], points[points.len() - 1]],
        s,
        ..Shape::default()
    }
}

/// A straight beam of 1 m along x, at a height.
pub(super) fn level(height: f64) -> Shape {
    beam("arm", 1.0, &[[0.0, height], [0.5, height], [1.0, height]])
}

pub(super) fn step(parameter: f64, step: f64, increments: &[f64], residuals: &[f64]) -> StepRecord {
    StepRecord {
        parameter,
        step,
        accepted: true,
        increments: increments.to_vec(),
        residuals: residuals.to_vec(),
    }
}

pub(super) fn rejected(step: StepRecord) -> StepRecord {
    StepRecord { accepted: false, ..step }
}

pub(super) fn sample(x: f64, y: f64, angle: f64, velocity: Option<[f64; 2]>) -> ProbeSample {
    ProbeSample {
        x,
        y,
        angle,
        curvature: 0.3 * x,
        strain: -2e-4 * y,
        vx: velocity.map(|v| v[0]),
        vy: velocity.map(|v| v[1]),
    }
}

/// Results of every kind, with their names.
pub(super) fn all() -> [(&'static str, Results); 5] {
    [
        ("path", path().into()),
        ("swing", swing().into()),
        ("vibrations", vibrations().into()),
        ("buckling", buckling().into()),
        ("speck", speck().into()),
    ]
}

/// A motion of one level beam with so many records, 0.125 s apart, that rises by 0.01 m each.
pub(super) fn rise(records: u32) -> Trajectory {
    let height = |i: u32| 0.01 * f64::from(i);
    let samples = (0..records).map(|i| sample(1.0, height(i), 0.0, Some([0.0, 0.08]))).collect();
    Trajectory {
        run: Run {
            title: "Rise".to_owned(),
            analysis: AnalysisKind::Dynamic,
            complete: true,
            degrees_of_freedom: 12,
            undeformed: vec![level(0.0)],
            ..Run::default()
        },
        parameter: (0..records).map(|i| 0.125 * f64::from(i)).collect(),
        probes: vec![ProbeSeries { name: "end".to_owned(), samples }],
        energy: (0..records)
            .map(|i| Energy { kinetic: 0.25, potential: 0.1 * f64::from(i), ..Energy::default() })
            .collect(),
        frames: (0..records)
            .map(|i| Frame {
                parameter: 0.125 * f64::from(i),
                beams: vec![vec![[0.0, height(i)], [1.0, height(i)]]],
            })
            .collect(),
        last: vec![level(height(records.max(1) - 1))],
        ..Trajectory::default()
    }
}

/// Two beams under growing loads: one step is rejected, one takes no iteration.
pub(super) fn path() -> Trajectory {
    let loads = [0.0, 0.25, 0.5, 1.0];
    let arm = |load: f64| [[0.0, 0.1], [0.2, 0.1 + 0.03 * load], [0.4, 0.1 + 0.12 * load]];
    let leg = |load: f64| [[0.4, 0.1 + 0.12 * load], [0.4 - 0.02 * load, -0.2]];
    let beams = |load: f64| vec![beam("arm", 0.4, &arm(load)), beam("leg", 0.3, &leg(load))];
    Trajectory {
        run: Run {
            title: "Two <beams> & a \"joint\"".to_owned(),
            analysis: AnalysisKind::Static,
            complete: true,
            degrees_of_freedom: 17,
            settings: vec![
                ("beam arm".into(), "0.4 m <long>".into()),
                ("linear solver".into(), "banded".into()),
            ],
            undeformed: beams(0.0),
            outlines: vec![vec![[-0.05, -0.21], [0.5, -0.21]], vec![[0.6, 0.0], [0.6, 0.1]]],
            tensions: Vec::new(),
            misses_fields: false,
            warnings: vec!["the path turns at load factor 0.9 & <more>".to_owned()],
            statistics: Statistics {
                steps: 4,
                rejected_steps: 1,
                load_steps: 4,
                newton_iterations: 10,
                residual_evaluations: 12,
                tangent_evaluations: 10,
                factorizations: 9,
            },
            seconds: Seconds { build: 0.0123, solve: 0.1, write: 0.0 },
            error: None,
        },
        parameter: loads.to_vec(),
        probes: vec![
            ProbeSeries {
                name: "tip".to_owned(),
                samples: loads.map(|load| sample(0.4, 0.1 + 0.12 * load, 0.006 * load, None)).to_vec(),
            },
            ProbeSeries {
                name: "foot".to_owned(),
                samples: loads.map(|load| sample(0.4 - 0.02 * load, -0.2, -0.002 * load, None)).to_vec(),
            },
        ],
        energy: loads
            .map(|load| Energy {
                stretch: 0.02 * load * load,
                bend: 0.3 * load * load,
                potential: -0.64 * load * load,
                stored: 0.05 * load,
                ..Energy::default()
            })
            .to_vec(),
        reactions: vec![
            ReactionSeries {
                name: "support1".to_owned(),
                samples: loads
                    .map(|load| Reaction { fx: 2.0 * load, fy: -3.0 * load, moment: 0.7 * load })
                    .to_vec(),
            },
            ReactionSeries { name: "joint1".to_owned(), samples: vec![Reaction::default(); 4] },
        ],
        effects: vec![
            EffectSeries {
                name: "gravity.arm".to_owned(),
                has_energy: true,
                samples: loads.map(|load| [-0.64 * load, 0.0, -9.0 * load]).to_vec(),
            },
            EffectSeries {
                name: "moment.leg".to_owned(),
                has_energy: false,
                samples: loads.map(|load| [0.5, 1.5 * load, 2.5 * load]).to_vec(),
            },
        ],
        frames: loads
            .map(|load| Frame { parameter: load, beams: vec![arm(load).to_vec(), leg(load).to_vec()] })
            .to_vec(),
        last: beams(1.0),
        history: vec![
            step(0.25, 0.25, &[1e-2, 1e-5], &[0.4, 1e-4, 3e-9]),
            rejected(step(1.0, 0.75, &[0.3, 0.9, 2.0], &[0.2, 0.5])),
            step(0.25, 0.0, &[], &[]),
            step(0.5, 0.25, &[2e-2, 3e-6], &[0.1, 2e-4]),
            step(1.0, -0.5, &[5e-2, 4e-4, 1e-9], &[0.3, 7e-5, 1e-10]),
        ],
        ..Trajectory::default()
    }
}

/// A beam that swings and touches: all energies, events, steps of very different sizes.
pub(super) fn swing() -> Trajectory {
    let time = |i: u32| 0.02 * f64::from(i);
    let times: Vec<f64> = (0..5).map(time).collect();
    let arm = |t: f64| [[0.3, 0.0], [0.3 + t, -0.2], [0.3 + 3.0 * t, -0.4], [0.3 + 6.0 * t, -0.6]];
    let samples = |end: usize| -> Vec<ProbeSample> {
        let velocity = |t: f64| if t < 0.05 { Some([6.0, -0.5 * t]) } else { None };
        times.iter().map(|&t| sample(arm(t)[end][0], arm(t)[end][1], 0.1 * t, velocity(t))).collect()
    };
    Trajectory {
        run: Run {
            title: "  ".to_owned(),
            analysis: AnalysisKind::Dynamic,
            complete: false,
            degrees_of_freedom: 1,
            undeformed: vec![beam("arm", 0.6, &arm(0.0))],
            outlines: vec![vec![[-2.0, -0.65], [0.0, -0.65], [2.0, -0.65]]],
            warnings: vec!["one".to_owned(), "two".to_owned()],
            statistics: Statistics {
                steps: 4,
                rejected_steps: 1,
                factorizations: 7,
                ..Statistics::default()
            },
            seconds: Seconds { build: 0.0999, solve: 12.34567, write: 0.5 },
            ..Run::default()
        },
        parameter: times.clone(),
        probes: vec![
            ProbeSeries { name: "end".to_owned(), samples: samples(3) },
            ProbeSeries { name: "-inner".to_owned(), samples: samples(1) },
        ],
        energy: times
            .iter()
            .map(|t| Energy {
                stretch: 0.05,
                bend: 0.02 + t,
                stored: 0.3 * t,
                kinetic: 0.1 + 2.0 * t,
                potential: -4.0 * t,
                work: 0.2 * t,
                lost: 0.5 * t,
            })
            .collect(),
        frames: times.iter().map(|&t| Frame { parameter: t, beams: vec![arm(t).to_vec()] }).collect(),
        last: vec![beam("arm", 0.6, &arm(0.08))],
        history: vec![
            step(0.001, 0.001, &[1e-2, 1e-7], &[1e-1, 1e-6]),
            step(0.02, 0.019, &[1e-3, 1e-6, 1e-12], &[1e-2, 1e-5, 1e-10]),
            rejected(step(0.08, 0.06, &[0.5, 0.7], &[0.9, 2.0, 30.0])),
            step(0.05, 0.03, &[1e-3], &[1e-2]),
            step(0.08, 0.03, &[2e-3, 1e-8], &[1e-3, 1e-9]),
        ],
        events: vec![
            Event::Probe {
                time: 0.03,
                probe: "end".into(),
                quantity: "x",
                value: 0.48,
                turns: None,
                rates: [0.0; 2],
            },
            Event::Contact { time: 0.04, contact: "arm.1".to_owned(), touches: true, impulse: None },
            Event::Contact {
                time: 0.06,
                contact: "arm.1".to_owned(),
                touches: false,
                impulse: Some(ContactImpulse { impulse: [0.25, 1.5], largest_force: 80.0 }),
            },
        ],
        ..Trajectory::default()
    }
}

/// The change from one shape to another.
pub(super) fn change(from: &[Shape], to: &[Shape]) -> Vec<ModeShape> {
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| b - a).collect::<Vec<f64>>();
    let beam = |(a, b): (&Shape, &Shape)| ModeShape {
        beam: a.beam.clone(),
        s: a.s.clone(),
        x: apart(&a.x, &b.x),
        y: apart(&a.y, &b.y),
        angle: a.s.iter().map(|s| 0.2 * s).collect(),
        strain: a.s.iter().map(|s| 3e-3 * s).collect(),
        curvature: a.s.iter().map(|s| -0.6 * s).collect(),
        nodes: a.nodes.iter().zip(&b.nodes).map(|(a, b)| [b[0] - a[0], b[1] - a[1]]).collect(),
    };
    from.iter().zip(to).map(beam).collect()
}

/// Vibrations of two beams about an equilibrium.
pub(super) fn vibrations() -> Vibrations {
    let arm = |swing: f64| beam("arm", 0.4, &[[0.0, 0.1], [0.2, 0.1 + swing], [0.4, 0.1 - swing]]);
    let leg = |swing: f64| beam("leg", 0.3, &[[0.4, 0.1 - swing], [0.4 + swing, -0.2]]);
    let both = |swing: f64| vec![arm(swing), leg(swing)];
    let mode = |(frequency, swing): (f64, f64)| Vibration {
        frequency,
        round_off: 0.0,
        shape: change(&both(0.0), &both(swing)),
    };
    let equilibrium = Trajectory {
        run: Run {
            title: "Modes".to_owned(),
            analysis: AnalysisKind::Modal,
            complete: true,
            degrees_of_freedom: 9,
            undeformed: both(0.01),
            ..Run::default()
        },
        parameter: vec![0.75],
        energy: vec![Energy { bend: 0.25, ..Energy::default() }],
        probes: vec![ProbeSeries { name: "tip".to_owned(), samples: vec![sample(0.4, 0.1, 0.3, None)] }],
        frames: vec![Frame { parameter: 0.75, beams: vec![vec![[0.0, 0.1], [0.4, 0.1]], vec![[0.4, 0.1]]] }],
        last: both(0.0),
        ..Trajectory::default()
    };
    Vibrations { equilibrium, modes: [(0.0, 0.05), (12.5, -0.03), (77.0, 0.1)].map(mode).into() }
}

/// One critical load.
pub(super) fn buckling() -> CriticalLoads {
    let column = |bow: f64| vec![beam("column", 0.5, &[[0.0, 0.0], [bow, 0.25], [0.0, 0.5]])];
    let unloaded = Trajectory {
        run: Run {
            analysis: AnalysisKind::Buckling,
            complete: true,
            degrees_of_freedom: 5,
            undeformed: column(0.0),
            ..Run::default()
        },
        last: column(0.0),
        ..Trajectory::default()
    };
    let mode =
        BucklingMode { load_factor: 2.467_401_1, round_off: 0.0, shape: change(&column(0.0), &column(0.06)) };
    CriticalLoads { unloaded, modes: vec![mode] }
}

/// A beam without length, seen once.
pub(super) fn speck() -> Trajectory {
    let shape = Shape { curvature: vec![0.3], ..beam("arm", 0.0, &[[2.0, 3.0]]) };
    Trajectory {
        run: Run {
            analysis: AnalysisKind::Static,
            complete: true,
            undeformed: vec![shape.clone()],
            ..Run::default()
        },
        parameter: vec![1.0],
        energy: vec![Energy::default()],
        last: vec![shape],
        ..Trajectory::default()
    }
}
