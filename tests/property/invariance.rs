//! Invariances of the continuous beam that the discrete one must keep: rigid motions, orientation,
//! units.

use super::generators::{beam, clamp, free, noise, perturbed};
use ancf::effect::Force;
use ancf::model::{
    Beam, Centreline, Discretization, Kernel, Model, Nodes, Place, Probe, Section, SideCondition, Static,
    StrainMeasure,
};
use ancf::results::Trajectory;
use proptest::prelude::*;
use std::sync::Arc;

fn moved(q: &[f64], angle: f64, shift: [f64; 2]) -> Vec<f64> {
    let (s, c) = angle.sin_cos();
    q.chunks_exact(4)
        .flat_map(|n| {
            [
                c * n[0] - s * n[1] + shift[0],
                s * n[0] + c * n[1] + shift[1],
                c * n[2] - s * n[3],
                s * n[2] + c * n[3],
            ]
        })
        .collect()
}

proptest! {
    #![proptest_config(super::cases(48))]

    #[test]
    fn rigid_motion_changes_no_energy(beam in beam(), noise in noise(), angle in -7.0..7.0, x in -5.0..5.0, y in -5.0..5.0) {
        let system = free(&beam);
        let q = perturbed(&system, 0.3, &noise);
        let (a, b) = (system.energy(1.0, &q, None), system.energy(1.0, &moved(&q, angle, [x, y]), None));
        prop_assert!((a.stretch - b.stretch).abs() <= 1e-10 * a.stretch.abs().max(1e-9));
        prop_assert!((a.bend - b.bend).abs() <= 1e-10 * a.bend.abs().max(1e-9));
    }

    #[test]
    fn the_stress_free_state_has_no_energy_and_no_force(beam in beam(), angle in -7.0..7.0) {
        let system = free(&beam);
        let q = moved(system.reference(), angle, [0.3, 0.7]);
        let energy = system.energy(1.0, &q, None);
        let stiffness = beam.section.axial_stiffness.as_ref().and_then(ancf::model::Along::constant).unwrap_or(1.0);
        prop_assert!(energy.stretch + energy.bend <= 1e-24 * stiffness);
        let mut force = vec![0.0; q.len()];
        system.force(1.0, &q, &mut force);
        prop_assert!(force.iter().all(|f| f.abs() <= 1e-11 * stiffness), "{force:?}");
    }

    #[test]
    fn internal_forces_are_in_equilibrium(beam in beam(), noise in noise()) {
        let system = free(&beam);
        let q = perturbed(&system, 0.3, &noise);
        let mut f = vec![0.0; q.len()];
        system.force(1.0, &q, &mut f);
        let scale = f.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let mut sum = [0.0; 3];
        for (f, q) in f.chunks_exact(4).zip(q.chunks_exact(4)) {
            sum[0] += f[0];
            sum[1] += f[1];
            sum[2] += q[0] * f[1] - q[1] * f[0] + q[2] * f[3] - q[3] * f[2];
        }
        prop_assert!(sum.iter().all(|s| s.abs() <= 1e-9 * scale), "{sum:?} against {scale}");
    }

    #[test]
    fn velocity_of_a_translation_has_its_kinetic_energy(beam in beam(), vx in -3.0..3.0, vy in -3.0..3.0) {
        let system = free(&beam);
        let velocity: Vec<f64> = (0..system.coordinates() / 4).flat_map(|_| [vx, vy, 0.0, 0.0]).collect();
        let mass = 1.3 * system.length();
        let expected = 0.5 * mass * (vx * vx + vy * vy);
        let ours = system.energy(1.0, system.reference(), Some(&velocity)).kinetic;
        prop_assert!((ours - expected).abs() <= 1e-12 * expected.max(1e-3));
        // The mass matrix gives the same.
        let mut mv = vec![0.0; velocity.len()];
        system.mass_matrix().multiply_add(1.0, &velocity, &mut mv);
        let product: f64 = 0.5 * mv.iter().zip(&velocity).map(|(a, b)| a * b).sum::<f64>();
        prop_assert!((product - expected).abs() <= 1e-12 * expected.max(1e-3));
    }
}

/// A clamped beam with a dead or follower tip force, everything in multiples of a unit of length
/// and one of force.
fn cantilever(metre: f64, newton: f64, angle: f64, discretization: Discretization, follower: bool) -> Model {
    let turned = |x: f64, y: f64| {
        let (s, c) = angle.sin_cos();
        [c * x - s * y, s * x + c * y]
    };
    let length = 1.8 * metre;
    Model {
        beams: vec![Beam {
            name: "beam".into(),
            centreline: Centreline::Line { start: [0.0, 0.0], end: turned(length, 0.0) },
            section: Section {
                axial_stiffness: Some((1.7e5 * newton).into()),
                bending_stiffness: Some((90.0 * newton * metre * metre).into()),
                mass_per_length: None,
                ..Default::default()
            },
            strain: StrainMeasure::Engineering,
            discretization,
            gauss_points: ancf::model::GaussPoints { stretch: 4, bend: 4, lobatto: false },
        }],
        supports: vec![clamp()],
        parts: vec![Arc::new(Force {
            at: Place { beam: 0, s: length },
            value: turned(20.0 * newton, 150.0 * newton),
            follower,
            law: None,
        })],
        probes: vec![Probe { name: "tip".into(), at: Place { beam: 0, s: length } }],
        ..Model::default()
    }
}

fn solved(model: &Model) -> Trajectory {
    model.solve(&Static::default()).expect("a plain cantilever has an equilibrium")
}

fn both() -> impl Strategy<Value = Discretization> {
    prop_oneof![
        Just(Discretization::Ancf { nodes: Nodes::Uniform(9) }),
        Just(Discretization::Rpim {
            nodes: Nodes::Uniform(8),
            kernel: Kernel::Multiquadric { q: 1.03, shape: 3.3 },
            polynomial_terms: 2,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        })
    ]
}

proptest! {
    #![proptest_config(super::cases(12))]

    #[test]
    fn results_do_not_depend_on_units(d in both(), metre in -6.0..6.0, newton in -6.0..6.0, follower in any::<bool>()) {
        let (metre, newton) = (10f64.powf(metre), 10f64.powf(newton));
        let (a, b) = (solved(&cantilever(1.0, 1.0, 0.0, d.clone(), follower)), solved(&cantilever(metre, newton, 0.0, d, follower)));
        let (p, r) = (a.probes[0].samples.last().unwrap(), b.probes[0].samples.last().unwrap());
        for (ours, other) in [(p.x, r.x / metre), (p.y, r.y / metre), (p.curvature, r.curvature * metre), (p.angle, r.angle)] {
            prop_assert!((ours - other).abs() <= 1e-9 * (1.0 + ours.abs()), "{ours} against {other}");
        }
        prop_assert_eq!(a.run.statistics, b.run.statistics);
    }

    #[test]
    fn results_do_not_depend_on_orientation(d in both(), angle in -3.1..3.1, follower in any::<bool>()) {
        let (a, b) = (solved(&cantilever(1.0, 1.0, 0.0, d.clone(), follower)), solved(&cantilever(1.0, 1.0, angle, d, follower)));
        let (p, r) = (a.probes[0].samples.last().unwrap(), b.probes[0].samples.last().unwrap());
        let (s, c) = f64::sin_cos(angle);
        for (ours, other) in [(p.x, c * r.x + s * r.y), (p.y, c * r.y - s * r.x), (p.curvature, r.curvature), (p.strain, r.strain)] {
            prop_assert!((ours - other).abs() <= 1e-9, "{ours} against {other}");
        }
    }
}
