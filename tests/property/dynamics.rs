//! Motion by the generalised-α method: exact where it must be, second order where it may err, energy kept.

use ancf::model::{
    Beam, Centreline, Discretization, Fixed, GaussPoints, Kernel, Load, Model, Nodes, Place, Section,
    SideCondition, StrainMeasure, Support,
};
use ancf::solve::dynamics::Solution;
use ancf::solve::dynamics::generalized_alpha::{Task, solve};
use ancf::system::{Needs, System};

const LENGTH: f64 = 1.2;

/// A beam under its own weight, hinged at its start or free.
fn model(discretization: Discretization, hinged: bool) -> Model {
    let hinge = Support {
        at: Place { beam: 0, s: 0.0 },
        fix: Fixed { x: true, y: true, ..Fixed::default() },
        ..Support::default()
    };
    Model {
        beams: vec![Beam {
            name: "arm".into(),
            centreline: Centreline::Line { start: [0.0, 0.0], end: [LENGTH, 0.0] },
            section: Section {
                axial_stiffness: Some(2e3),
                bending_stiffness: Some(0.5),
                mass_per_length: Some(0.4),
            },
            strain: StrainMeasure::Engineering,
            discretization,
            gauss_points: GaussPoints { stretch: 4, bend: 4 },
        }],
        supports: if hinged { vec![hinge] } else { vec![] },
        loads: vec![Load::Gravity { acceleration: [1.5, -9.0] }],
        ..Model::default()
    }
}

fn system(discretization: Discretization, hinged: bool) -> System {
    System::build(&model(discretization, hinged), Needs { inertia: true }).expect("a legal model")
}

fn either() -> [Discretization; 2] {
    [
        Discretization::Ancf { nodes: Nodes::Uniform(7) },
        Discretization::Rpim {
            nodes: Nodes::Uniform(6),
            kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
            polynomial_terms: 2,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        },
    ]
}

fn moved(system: &System, duration: f64, step: f64, spectral_radius: f64) -> Solution {
    let task = Task { duration, output_every: duration / 8.0, step, spectral_radius };
    let solution = solve(system, &task, &mut |_, _, _| true);
    assert!(solution.stuck.is_none(), "{:?}", solution.stuck);
    solution
}

#[test]
fn free_fall_is_exact() {
    for discretization in either() {
        let system = system(discretization, false);
        for spectral_radius in [0.0, 0.6, 1.0] {
            let solution = moved(&system, 0.7, 0.013, spectral_radius);
            for state in &solution.states {
                let t = state.time;
                for (i, ((q, v), q0)) in state.q.iter().zip(&state.v).zip(system.reference()).enumerate() {
                    let g = [1.5, -9.0, 0.0, 0.0][i % 4];
                    assert!((q - q0 - 0.5 * g * t * t).abs() < 1e-11, "coordinate {i} at {t} s");
                    assert!((v - g * t).abs() < 1e-9, "velocity {i} at {t} s: {v}");
                }
            }
        }
    }
}

#[test]
fn the_error_falls_with_the_second_power_of_the_step() {
    for (discretization, spectral_radius) in either().into_iter().zip([0.8, 1.0]) {
        let system = system(discretization, true);
        let tip = |step: f64| {
            let solution = moved(&system, 0.05, step, spectral_radius);
            let q = &solution.states.last().expect("a last state").q;
            [q[q.len() - 4], q[q.len() - 3]]
        };
        // The highest axial vibration has a period of 1.7 ms: its phase, too, must be right for the order to show.
        let [a, b, c] = [2e-5, 1e-5, 5e-6].map(tip);
        let distance = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        let order = (distance(a, b) / distance(b, c)).log2();
        assert!((order - 2.0).abs() < 0.15, "observed order {order}");
    }
}

#[test]
fn a_hinged_beam_under_its_weight_keeps_its_energy() {
    for discretization in either() {
        let system = system(discretization, true);
        let drift = |step: f64| {
            let solution = moved(&system, 1.0, step, 1.0);
            let energies = solution.states.iter().map(|s| system.energy(1.0, &s.q, Some(&s.v)));
            let (total, kinetic): (Vec<f64>, Vec<f64>) = energies.map(|e| (e.total(), e.kinetic)).unzip();
            let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            largest(&total) / largest(&kinetic)
        };
        let (coarse, fine) = (drift(1e-3), drift(5e-4));
        // The trapezoidal rule conserves no nonlinear energy, but errs by the square of the step.
        assert!(fine < 3e-4, "drift {fine}");
        assert!((coarse / fine).log2() > 1.5, "{coarse} against {fine}");
    }
}

/// Records lie where they were asked for, also between steps, and the last at the end.
#[test]
fn records_stand_at_the_times_asked_for() {
    let [ancf, _] = either();
    let system = system(ancf, true);
    let task = |step| Task { duration: 0.1, output_every: 0.03, step, spectral_radius: 1.0 };
    let times = |step| solve(&system, &task(step), &mut |_, _, _| true).states;
    let coarse = times(7e-5);
    let expected = [0.0, 0.03, 0.06, 0.09, 0.1];
    assert_eq!(coarse.len(), expected.len());
    for (state, expected) in coarse.iter().zip(expected) {
        assert!((state.time - expected).abs() < 1e-12, "{} for {expected}", state.time);
    }
    // Between steps the interpolation errs no more than the steps themselves: its error is of the fourth order.
    let (middle, fine) = (times(3.5e-5), times(1.75e-5));
    for i in 1..expected.len() {
        let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        let order = (distance(&coarse[i].q, &middle[i].q) / distance(&middle[i].q, &fine[i].q)).log2();
        assert!((order - 2.0).abs() < 0.25, "observed order {order} at {} s", expected[i]);
    }
}

/// What is not simulated is refused, not ignored: here a support that would have to move.
#[test]
fn prescribed_motion_is_refused() {
    use ancf::model::{Analysis, Displacement, Dynamic, Integrator, StepControl};
    let [ancf, _] = either();
    let mut model = model(ancf, true);
    model.supports[0].displacement = Displacement { y: 0.1, ..Displacement::default() };
    let integrator = Integrator::GeneralizedAlpha { step: StepControl::Fixed(1e-3), spectral_radius: 0.9 };
    let analysis = Analysis::Dynamic(Dynamic { duration: 0.1, output_every: 0.1, integrator });
    let error =
        ancf::run::run(&model, &analysis, &mut |_| ancf::run::Control::Continue).expect_err("not available");
    assert_eq!(error.exit_status(), 2);
    assert!(error.to_string().contains("prescribed motion"), "{error}");
}
