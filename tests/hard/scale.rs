//! Scales: one problem from a micrometre to a thousand kilometres, in any units of force and time,
//! has one dimensionless answer, by every analysis.

use crate::property::generators::clamp;
use ancf::effect::{DistributedForce, Force, Gravity, Moment};
use ancf::model::{
    About, Analysis, ArcLength, Beam, Buckling, Centreline, Crossing, Discretization, Dynamic,
    EventCondition, EventKind, Fixed, GaussPoints, InitialVelocity, Integrator, Kernel, Modal, Model, Nodes,
    Place, Probe, ProbeQuantity, Section, SideCondition, Static, StepControl, StrainMeasure, Support,
};
use ancf::results::{AnalysisKind, Results};
use ancf::solve::Statistics;
use std::sync::Arc;

/// What a length, a force and a time of one are, in metres, newtons and seconds.
#[derive(Clone, Copy, Debug)]
struct Units {
    length: f64,
    force: f64,
    time: f64,
}

const ONE: Units = Units { length: 1.0, force: 1.0, time: 1.0 };

/// A part of a microsystem, a tether, a nanobeam in zeptonewtons, a beam of which the numbers are
/// the size of its mountain.
const SCALES: [Units; 5] = [
    Units { length: 1e-6, force: 1e-9, time: 1e-7 },
    Units { length: 1e6, force: 1e5, time: 3e3 },
    Units { length: 1e-9, force: 1e-21, time: 1e-12 },
    Units { length: 7.3e4, force: 1e15, time: 1e-3 },
    Units { length: 3.048e-1, force: 4.448, time: 60.0 },
];

fn discretizations() -> [Discretization; 2] {
    [
        Discretization::Ancf { nodes: Nodes::Uniform(9) },
        Discretization::Rpim {
            nodes: Nodes::Uniform(8),
            kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
            polynomial_terms: 2,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        },
    ]
}

/// A beam with L = 1.8, EA = 1e4, EI = 2, ρA = 0.7 in these units.
fn beam(units: Units, discretization: &Discretization, centreline: Centreline) -> Beam {
    Beam {
        name: "beam".into(),
        centreline,
        section: Section {
            axial_stiffness: Some((1e4 * units.force).into()),
            bending_stiffness: Some((2.0 * units.force * units.length.powi(2)).into()),
            mass_per_length: Some((0.7 * units.force * (units.time / units.length).powi(2)).into()),
            ..Default::default()
        },
        strain: StrainMeasure::Engineering,
        discretization: discretization.clone(),
        gauss_points: GaussPoints { stretch: 4, bend: 4, lobatto: false },
    }
}

fn cantilever(units: Units, discretization: &Discretization) -> Model {
    let Units { length, force, time } = units;
    let tip = Place { beam: 0, s: 1.8 * length };
    let line = Centreline::Line { start: [0.0; 2], end: [1.8 * length, 0.0] };
    Model {
        beams: vec![beam(units, discretization, line)],
        supports: vec![clamp()],
        parts: vec![
            Arc::new(Force::new(tip, [-0.3 * force, 2.0 * force])),
            Arc::new(Moment::new(tip, 0.8 * force * length)),
            Arc::new(DistributedForce {
                beam: 0,
                value: [0.0, 0.4 * force / length].map(Into::into),
                follower: false,
                law: None,
            }),
            Arc::new(Gravity {
                acceleration: [0.1 * length / time.powi(2), -0.5 * length / time.powi(2)],
                law: None,
            }),
        ],
        probes: vec![Probe { name: "tip".into(), at: tip }],
        ..Model::default()
    }
}

/// A hinged beam that spins and falls.
fn pendulum(units: Units, discretization: &Discretization) -> Model {
    let hinge = Support { fix: Fixed { x: true, y: true, ..Fixed::default() }, ..clamp() };
    let spin = InitialVelocity { rotation: 1.0 / units.time, ..InitialVelocity::default() };
    let mut model = cantilever(units, discretization);
    model.parts.drain(..3);
    Model { supports: vec![hinge], initial_velocities: vec![spin], ..model }
}

/// A shallow arch pressed down at its crown, through its limit point.
fn arch(units: Units, discretization: &Discretization) -> Model {
    let Units { length, force, .. } = units;
    let quarter = std::f64::consts::FRAC_PI_2;
    let (radius, opening) = (4.0 * length, 0.45);
    let centreline = Centreline::Arc {
        center: [0.0; 2],
        radius,
        from: quarter + 0.5 * opening,
        to: quarter - 0.5 * opening,
    };
    let crown = Place { beam: 0, s: 0.5 * radius * opening };
    let hold = |s: f64| Support {
        at: Place { beam: 0, s },
        fix: Fixed { x: true, y: true, ..Fixed::default() },
        ..Support::default()
    };
    Model {
        beams: vec![beam(units, discretization, centreline)],
        supports: vec![hold(0.0), hold(radius * opening)],
        parts: vec![Arc::new(Force::new(crown, [0.0, -60.0 * force]))],
        probes: vec![Probe { name: "tip".into(), at: crown }],
        ..Model::default()
    }
}

fn solved(model: &Model, analysis: &Analysis) -> Results {
    model.solve(analysis).unwrap_or_else(|error| panic!("{error}"))
}

/// All that results say, without units.
fn dimensionless(units: Units, results: &Results) -> Vec<f64> {
    let t = results.states();
    let Units { length, force, time } = units;
    let mut numbers: Vec<f64> = Vec::new();
    let dynamic = t.run.analysis == AnalysisKind::Dynamic;
    numbers.extend(t.parameter.iter().map(|p| if dynamic { p / time } else { *p }));
    for s in t.probes.iter().flat_map(|probe| &probe.samples) {
        numbers.extend([s.x / length, s.y / length, s.angle, s.curvature * length]);
        numbers.extend([s.vx, s.vy].iter().flatten().map(|v| v * time / length));
    }
    for e in &t.energy {
        numbers.extend([e.bend, e.kinetic, e.potential, e.work].map(|e| e / (force * length)));
    }
    let unit = if t.run.analysis == AnalysisKind::Modal { time } else { 1.0 };
    numbers.extend(results.eigenvalues().iter().map(|value| value * unit));
    numbers.extend(t.events.iter().map(|event| event.parameter() / if dynamic { time } else { 1.0 }));
    numbers
}

fn same_at_all_scales(
    model: impl Fn(Units, &Discretization) -> Model,
    analysis: impl Fn(Units) -> Analysis,
    allowed: f64,
) {
    for discretization in discretizations() {
        let find = |units| {
            let results = solved(&model(units, &discretization), &analysis(units));
            // An iteration that ends at round-off may look at one residual more.
            let work = Statistics { residual_evaluations: 0, ..results.run().statistics };
            (dimensionless(units, &results), work)
        };
        let (expected, work) = find(ONE);
        assert!(!expected.is_empty());
        let scale = expected.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
        for units in SCALES {
            let (found, same_work) = find(units);
            assert_eq!(expected.len(), found.len(), "{units:?}");
            let apart = expected.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart <= allowed * scale, "{units:?}: {:e} of {scale}", apart);
            assert_eq!(work, same_work, "{units:?}");
        }
    }
}

#[test]
fn statics() {
    same_at_all_scales(cantilever, |_| Analysis::Static(Static::default()), 1e-9);
}

#[test]
fn paths_by_arc_length() {
    let arc = |_| {
        let arc = ArcLength { until_load: None, max_points: 40, max_step: None, until_probe: None };
        Analysis::Static(Static { arc_length: Some(arc), ..Static::default() })
    };
    // Where a path turns is known to the tolerance of its tangent, and so is where its next points lie on it.
    same_at_all_scales(arch, arc, 1e-8);
}

#[test]
fn critical_loads() {
    let column = |units: Units, discretization: &Discretization| {
        let mut model = cantilever(units, discretization);
        let at = Place { beam: 0, s: 1.8 * units.length };
        model.parts = vec![Arc::new(Force::new(at, [-units.force, 0.0]))];
        model
    };
    same_at_all_scales(column, |_| Analysis::Buckling(Buckling { count: 3 }), 1e-9);
}

#[test]
fn frequencies() {
    for about in [About::Reference, About::Equilibrium] {
        same_at_all_scales(cantilever, |_| Analysis::Modal(Modal { count: 4, about }), 1e-9);
    }
}

fn motion(units: Units, integrator: Integrator) -> Analysis {
    let when = EventKind::Reaches { value: -0.2 * units.length, crossing: Crossing::Any };
    let event = EventCondition { probe: "tip".into(), quantity: ProbeQuantity::Y, when, stop: false };
    Analysis::Dynamic(Dynamic {
        duration: 1.0 * units.time,
        output_every: 0.25 * units.time,
        integrator,
        events: vec![event],
    })
}

#[test]
fn motions_by_fixed_steps() {
    let alpha = |units: Units| Integrator::GeneralizedAlpha {
        step: StepControl::Fixed(0.01 * units.time),
        spectral_radius: 0.9,
        newton_tolerance: Integrator::NEWTON_TOLERANCE,
    };
    same_at_all_scales(pendulum, |units| motion(units, alpha(units)), 1e-9);
    let gauss = |units: Units| Integrator::Gauss { stages: 3, step: StepControl::Fixed(0.02 * units.time) };
    same_at_all_scales(pendulum, |units| motion(units, gauss(units)), 1e-9);
}

#[test]
fn motions_by_tolerance() {
    for integrator in [
        Integrator::Gauss { stages: 3, step: StepControl::Tolerance(1e-5) },
        Integrator::Radau { stages: 3, step: StepControl::Tolerance(1e-5) },
        Integrator::GeneralizedAlpha {
            step: StepControl::Tolerance(1e-3),
            spectral_radius: 0.8,
            newton_tolerance: Integrator::NEWTON_TOLERANCE,
        },
    ] {
        same_at_all_scales(pendulum, |units| motion(units, integrator), 1e-9);
    }
}
