//! Beams that are joined: welds, corners, chains of hinges.

use super::arm::{LENGTH, ancf, beam, gauss, imbalance, methods, moved, one, still, support, tip};
use ancf::effect::{Force, Gravity};
use ancf::model::*;
use ancf::results::Trajectory;
use std::sync::Arc;

/// One beam and two that are welded are the same but for the stretch at the weld, which is free to
/// jump there: with finer meshes they become one.
#[test]
fn a_weld_makes_one_beam_of_two() {
    let half = 0.5 * LENGTH;
    let apart = |compute: &dyn Fn(&Model) -> Trajectory, elements: usize| {
        let mut whole = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
        whole.beams = vec![beam("arm", [0.0, 0.0], [LENGTH, 0.0], ancf(2 * elements))];
        let mut parts = Model {
            beams: vec![
                beam("left", [0.0, 0.0], [half, 0.0], ancf(elements)),
                beam("right", [half, 0.0], [LENGTH, 0.0], ancf(elements)),
            ],
            joints: vec![Joint::Weld {
                first: Place { beam: 0, s: half },
                second: Place { beam: 1, s: 0.0 },
            }],
            probes: tip(1, half),
            ..whole.clone()
        };
        whole.parts = vec![Arc::new(Force::following(Place { beam: 0, s: LENGTH }, [-0.1, 0.6]))];
        parts.parts = vec![Arc::new(Force::following(Place { beam: 1, s: half }, [-0.1, 0.6]))];
        let [a, b] =
            [&whole, &parts].map(|model| *compute(model).probes[0].samples.last().expect("a record"));
        assert!((a.y).abs() > 0.05, "it bends");
        (a.x - b.x).hypot(a.y - b.y)
    };
    for compute in [
        &(|model: &Model| still(model)) as &dyn Fn(&Model) -> Trajectory,
        &|model: &Model| moved(model, 0.3, gauss(1e-3)),
        &|model: &Model| moved(model, 0.3, methods(1e-3)[1].0),
    ] {
        let [coarse, fine] = [3, 6].map(|elements| apart(compute, elements));
        assert!(fine < (coarse / 8.0).max(2e-7), "{coarse:.2e} and {fine:.2e}");
    }
}

/// Right angle: the corner stays one, both beams bend, and what supports and joints bear is in
/// equilibrium with the load.
#[test]
fn a_corner_keeps_its_angle_and_passes_forces_on() {
    let mut model = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
    model.beams.push(beam("up", [LENGTH, 0.0], [LENGTH, 0.8], ancf(5)));
    model.joints =
        vec![Joint::Weld { first: Place { beam: 0, s: LENGTH }, second: Place { beam: 1, s: 0.0 } }];
    model.parts = vec![Arc::new(Force::new(Place { beam: 1, s: 0.8 }, [0.2, 0.1]))];
    model.probes = vec![
        Probe { name: "corner".into(), at: Place { beam: 0, s: LENGTH } },
        Probe { name: "foot".into(), at: Place { beam: 1, s: 0.0 } },
        Probe { name: "top".into(), at: Place { beam: 1, s: 0.8 } },
    ];
    let trajectory = still(&model);
    let [corner, foot, top] = [0, 1, 2].map(|i| *trajectory.probes[i].samples.last().expect("a record"));
    assert!(corner.angle.abs() > 0.1, "it bends by {}", corner.angle);
    assert!((foot.angle - corner.angle - std::f64::consts::FRAC_PI_2).abs() < 1e-10);
    let [clamp, joint] = [0, 1].map(|i| *trajectory.reactions[i].samples.last().expect("a record"));
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} and not {b}");
    near(clamp.fx, -0.2);
    near(clamp.fy, -0.1);
    near(clamp.moment, 0.2 * top.y - 0.1 * top.x);
    near(joint.fx, -0.2);
    near(joint.fy, -0.1);
    near(joint.moment, 0.2 * (top.y - foot.y) - 0.1 * (top.x - foot.x));
    // Section forces say the same, but for the accuracy of second derivatives.
    let arm = &trajectory.last[0];
    assert!(
        (arm.bending_moment[0] + clamp.moment).abs() < 0.02 * clamp.moment.abs(),
        "{}",
        arm.bending_moment[0]
    );
}

/// A hinge passes no moment on; the lower half of a hanging double pendulum hangs straight.
#[test]
fn a_chain_of_hinges_keeps_together_and_its_energy() {
    let half = 0.5 * LENGTH;
    let rpim = Discretization::Rpim {
        nodes: Nodes::Uniform(6),
        kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
        polynomial_terms: 2,
        side_condition: SideCondition::Plus,
        neighbours: 2,
    };
    let model = Model {
        beams: vec![
            beam("upper", [0.0, 0.0], [half, 0.0], ancf(4)),
            beam("lower", [half, 0.0], [LENGTH, 0.0], rpim),
        ],
        joints: vec![Joint::Hinge { first: Place { beam: 0, s: half }, second: Place { beam: 1, s: 0.0 } }],
        parts: vec![Arc::new(Gravity::new([0.0, -9.81]))],
        probes: vec![
            Probe { name: "a".into(), at: Place { beam: 0, s: half } },
            Probe { name: "b".into(), at: Place { beam: 1, s: 0.0 } },
        ],
        ..one(vec![support(0.0, FixedRotation::Free)], vec![])
    };
    for (integrator, order) in methods(1e-3) {
        let trajectory = moved(&model, 1.0, integrator);
        for (a, b) in trajectory.probes[0].samples.iter().zip(&trajectory.probes[1].samples) {
            assert!(
                (a.x - b.x).hypot(a.y - b.y) < 1e-12,
                "{integrator}: ({}, {}) and ({}, {})",
                a.x,
                a.y,
                b.x,
                b.y
            );
            let (va, vb) =
                ([a.vx, a.vy].map(Option::unwrap_or_default), [b.vx, b.vy].map(Option::unwrap_or_default));
            assert!((va[0] - vb[0]).hypot(va[1] - vb[1]) < 1e-9, "{integrator}: {va:?} and {vb:?}");
        }
        if order > 4.0 {
            let off = imbalance(&trajectory);
            assert!(off < 1e-5, "{integrator}: energy off by {off}");
        }
    }
}
