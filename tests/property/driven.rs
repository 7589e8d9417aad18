//! What depends on time and velocity: damping, drag, hubs that turn by laws; orders of methods and
//! the balance of energy.

use super::arm::{LENGTH, gauss, imbalance, methods, moved, one, support};
use ancf::assembly::Part;
use ancf::effect::{
    Actuation, BeamDamping, Drag, Foundation, PointMass, SectionInertia, Spring, TorsionSpring,
};
use ancf::effect::{Force, Gravity};
use ancf::model::*;
use std::sync::Arc;

/// A hub that is turned by a law, with all that depends on velocity: supports whose frames turn,
/// damping matrices, laws of time.
fn driven(rotation: FixedRotation, duration: f64) -> Model {
    let hub = Support {
        displacement: Displacement { x: 0.05, y: 0.0, angle: 0.7 },
        law: Some(Law::SmoothRamp { start: 0.0, duration }),
        ..support(0.0, rotation)
    };
    let at = Place { beam: 0, s: LENGTH };
    let parts: Vec<Arc<dyn Part>> = vec![
        Arc::new(BeamDamping {
            beam: 0,
            mass_proportional: Some((0.5).into()),
            strain: Some((2e-4).into()),
            curvature: Some((2e-3).into()),
        }),
        Arc::new(Drag {
            beam: 0,
            viscous: [0.1, 0.1].map(Into::into),
            quadratic: [0.0, 0.2].map(Into::into),
            flow: [0.3, 0.0],
        }),
        Arc::new(PointMass { at, mass: Some(0.1), rotary_inertia: Some(1e-3) }),
        Arc::new(Spring {
            at,
            anchor: Some([1.0, 1.0]),
            length: Some(0.8),
            stiffness: Some(3.0),
            damping: Some(0.1),
        }),
        Arc::new(TorsionSpring { at, stiffness: Some(0.1), damping: Some(0.01) }),
        Arc::new(SectionInertia { beam: 0, per_length: 1e-4.into() }),
        Arc::new(Foundation { beam: 0, stiffness: [0.5, 2.0].map(Into::into) }),
        Arc::new(Actuation {
            beam: 0,
            strain: Some((1e-3).into()),
            curvature: Some((0.3).into()),
            layer: None,
            law: Some(Law::Polynomial(vec![0.0, 2.0, -1.0])),
        }),
    ];
    let mut model = one(vec![hub], parts);
    let law = Some(Law::Harmonic { frequency: 20.0, phase: 0.0 });
    model.add(Gravity::new([0.0, -9.81]));
    model.add(Force { at, value: [0.0, 0.3], follower: true, law });
    model
}

/// Places after a short while with three steps, each half of the one before. Catches a term of time
/// or velocity that is taken at another time than its method wants, which costs a method its order.
/// Steps are such that the fastest waves are resolved, without which no order shows, and changes
/// are a hundred times round-off, without which chance decides.
#[test]
fn what_depends_on_time_and_velocity_keeps_the_order_of_every_method() {
    const ROUND_OFF: f64 = 1e-14;
    let mut wrong = Vec::new();
    for rotation in [FixedRotation::Gradient, FixedRotation::Angle] {
        let model = driven(rotation, 0.08);
        for (integrator, expected) in methods(1.0) {
            let (step, within): (f64, f64) = match expected {
                2.0 => (1e-4, 0.05),
                3.0 => (1e-4, 0.25),
                4.0 => (4e-4, 0.1),
                5.0 => (4e-4, 0.4),
                _ => (8e-4, 0.5),
            };
            let at = |factor: f64| {
                let integrator = integrator.with_step(StepControl::Fixed(factor * step));
                let trajectory = moved(&model, 0.0512, integrator);
                let sample = *trajectory.probes[0].samples.last().expect("a record");
                [sample.x, sample.y]
            };
            let [a, b, c] = [2.0, 1.0, 0.5].map(at);
            let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
            let changes = [distance(a, b), distance(b, c)];
            let order = (changes[0] / changes[1]).log2();
            if (order - expected).abs() > within || changes[1] < 100.0 * ROUND_OFF {
                wrong.push(format!("{rotation:?}, {integrator}: order {order}, changes {changes:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_is_lost_and_put_in_closes_the_balance_of_energy() {
    for rotation in [FixedRotation::Gradient, FixedRotation::Angle] {
        let trajectory = moved(&driven(rotation, 0.4), 0.5, gauss(5e-4));
        let last = trajectory.energy.last().expect("a record");
        assert!(last.lost > 0.01 * last.kinetic && last.work.abs() > 0.01 * last.kinetic, "{last:?}");
        let off = imbalance(&trajectory);
        assert!(off < 2e-6, "{rotation:?}: the balance is off by {off}");
    }
}

/// A step of fixed length that gains energy is divided, though damping takes more than it gains.
#[test]
fn damping_hides_no_gain() {
    let coarse = "analysis.dynamic={duration='1 s',output_every='40 ms',generalized_alpha={step='40 ms',spectral_radius=1.0}}";
    let damped = "effect.damping=[{beam='arm',mass_proportional=1.0}]";
    let path = ancf_check::Suite::here().cases_folder().join("hard-coarse-steps/scene.toml");
    let scene = ancf::scene::Scene::load(&path, &[coarse, damped].map(String::from)).expect("a legal scene");
    let trajectory = scene.model().solve(scene.analysis()).expect("a motion");
    // Of the first step, which starts from rest, the trapezoidal rule counts a larger loss than
    // there is.
    for pair in trajectory.states().energy[1..].windows(2) {
        let gain = (pair[1].total() - pair[0].total()) / pair[0].kinetic.max(pair[1].kinetic);
        assert!(gain < 5e-3, "a step gains {gain} of the kinetic energy");
    }
}

/// A rigid beam in free flight loses its speed as exp(−αt), and nothing by its material's damping.
#[test]
fn mass_damping_slows_free_flight() {
    let alpha = 3.0;
    let damping = BeamDamping {
        beam: 0,
        mass_proportional: Some((alpha).into()),
        strain: Some((1e-3).into()),
        curvature: Some((1e-2).into()),
    };
    let mut model = one(vec![], vec![Arc::new(damping)]);
    model.initial_velocities =
        vec![InitialVelocity { translation: [2.0, 1.0], ..InitialVelocity::default() }];
    let trajectory = moved(&model, 0.5, gauss(1e-2));
    let last = trajectory.probes[0].samples.last().expect("a record");
    let left = (-alpha * 0.5_f64).exp();
    assert!((last.vx.unwrap_or(0.0) - 2.0 * left).abs() < 1e-9, "{last:?}");
    assert!((last.y - (1.0 - left) / alpha).abs() < 1e-9, "{last:?}");
}

/// A hub at rest that starts to turn with constant speed, without bending it, carries the beam as a
/// rigid body if that starts so too.
#[test]
fn a_hub_of_constant_speed_keeps_a_rigid_rotation_in_its_equilibrium() {
    let speed = 4.0;
    let hub = Support {
        displacement: Displacement { angle: speed, ..Displacement::default() },
        law: Some(Law::Polynomial(vec![0.0, 1.0])),
        ..support(0.0, FixedRotation::Angle)
    };
    let mut model = one(
        vec![hub],
        vec![Arc::new(BeamDamping {
            strain: Some((0.02).into()),
            curvature: Some((0.4).into()),
            ..BeamDamping::default()
        })],
    );
    model.initial_velocities = vec![InitialVelocity { rotation: speed, ..InitialVelocity::default() }];
    let trajectory = moved(&model, 6.0, gauss(2e-3));
    let last = trajectory.probes[0].samples.last().expect("a record");
    // The stretched radius: u'' EA + ρA Ω² (s + u) = 0, u(0) = 0, u'(L) = 0, so s + u = sin(ks)/(k
    // cos(kL)).
    let k = speed * (0.4_f64 / 2e3).sqrt();
    let radius = (k * LENGTH).tan() / k;
    assert!((last.x.hypot(last.y) - radius).abs() < 1e-8, "radius {} and not {radius}", last.x.hypot(last.y));
    // The slowest vibration about it has not quite died out.
    assert!((last.angle - speed * 6.0).abs() < 1e-5, "angle {}", last.angle);
    // The hub pulls with ∫ ρA Ω² r ds.
    let pull = trajectory.reactions[0].samples.last().expect("a record");
    let exact = 2e3 * (1.0 / (k * LENGTH).cos() - 1.0);
    let found = pull.fx.hypot(pull.fy);
    assert!((found - exact).abs() < 1e-4 * exact, "{found} N and not {exact} N");
}
