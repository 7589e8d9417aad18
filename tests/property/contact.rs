//! Contact: what is summed is the gap of the curve, and nothing is crossed by steps of whatever
//! kind.

use super::generators;
use ancf::assembly::{Density, Needs};
use ancf::effect::{Contact, Obstacle, Penalty};
use ancf::model::{Beam, Centreline, Discretization, GaussPoints, Model, Section, StrainMeasure};
use ancf::results::{Results, Trajectory};
use ancf::run::RunError;
use ancf::system::{System, View};
use nalgebra::Vector2;
use proptest::prelude::*;
use std::sync::Arc;

fn solved(text: &str) -> Result<Trajectory, RunError> {
    let scene = ancf::scene::parse("contact.toml", text).expect("a legal scene");
    scene.model().solve(scene.analysis()).map(Results::into_states)
}

fn obstacle() -> impl Strategy<Value = Obstacle> {
    let place = || (0.0..1.0_f64, -0.25..0.25_f64);
    let radius = prop_oneof![1e-3..1e-2_f64, 0.05..0.3_f64];
    prop_oneof![
        (place(), radius).prop_map(|((x, y), radius)| Obstacle::Circle {
            center: [x, y],
            radius,
            inside: false
        }),
        (place(), 0.3..0.6_f64).prop_map(|((x, y), radius)| Obstacle::Circle {
            center: [x, y],
            radius,
            inside: true
        }),
        (place(), 0.0..6.3_f64).prop_map(|((x, y), angle)| Obstacle::HalfPlane {
            point: [x, y],
            normal: angle.sin_cos().into()
        }),
        (place(), 0.01..0.2_f64, 0.01..0.2_f64, 0.0..6.3_f64)
            .prop_map(|((x, y), a, b, angle)| Obstacle::Box { center: [x, y], half: [a, b], angle }),
    ]
}

/// A beam of unit length without stiffness to speak of: what is left is the contact.
fn touching(discretization: Discretization, contact: Contact) -> System {
    let beam = Beam {
        name: "beam".into(),
        centreline: Centreline::Line { start: [0.0, 0.0], end: [1.0, 0.0] },
        section: Section {
            axial_stiffness: Some((1e-9).into()),
            bending_stiffness: None,
            mass_per_length: None,
            ..Default::default()
        },
        strain: StrainMeasure::Engineering,
        discretization,
        gauss_points: GaussPoints { stretch: 3, bend: 2, lobatto: false },
    };
    let model = Model { beams: vec![beam], parts: vec![Arc::new(contact)], ..Model::default() };
    System::build(&model, Needs::default()).expect("a legal model")
}

proptest! {
    #![proptest_config(super::cases(48))]

    /// Energy, by a sum over very many points of the curve; force and tangent, by differences.
    #[test]
    fn contact_is_summed_over_what_touches(
        discretization in generators::discretization(), obstacle in obstacle(),
        gap in prop_oneof![Just(0.0), 0.002..0.05_f64], noise in prop::collection::vec(-1.0..1.0_f64, 64),
    ) {
        let contact = Contact { beam: 0, obstacle, stiffness: 2.0, half_thickness: gap, friction: None, between: None };
        let system = touching(discretization, contact);
        let moved = |q: &[f64], size: f64, from: usize| -> Vec<f64> {
            let noise = noise[from..].iter().cycle();
            q.iter().zip(noise).map(|(q, n)| q + size * n).collect()
        };
        let q = moved(system.reference(), 0.04, 0);
        let energy = |q: &[f64]| system.energy(0.0, q, None).stored;
        let part = &system.beams()[0];
        let count = 20_000;
        let s: Vec<f64> = (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count)).collect();
        let view = View::points(&part.basis, 0, &s).expect("on the beam");
        let penalty = Penalty { obstacle, stiffness: 2.0, gap };
        let energies: Vec<f64> = view.positions(1, &q).map(|r| penalty.energy(0, &[Vector2::from(r)])).collect();
        // What lies near the middle of an obstacle is refused by every analysis.
        let deepest = energies.iter().fold(0.0, |m: f64, e| m.max(e.sqrt()));
        prop_assume!(deepest < 0.5 * obstacle.deepest(gap));
        let sum: f64 = energies.iter().sum();
        let (found, exact) = (energy(&q), sum / f64::from(count));
        prop_assert!((found - exact).abs() <= 2e-3 * exact + 1e-11, "{found:e}, not {exact:e}");

        // Central differences along a random direction.
        let direction = moved(&vec![0.0; q.len()], 1.0, 32);
        let step = |h: f64| -> Vec<f64> { q.iter().zip(&direction).map(|(q, d)| q + h * d).collect() };
        let h = 1e-6;
        let mut force = vec![0.0; q.len()];
        system.force(0.0, &q, &mut force);
        let slope: f64 = force.iter().zip(&direction).map(|(f, d)| f * d).sum();
        let by_difference = (energy(&step(h)) - energy(&step(-h))) / (2.0 * h);
        // What a sharp corner leaves: the rule's points move over a distance that is not smooth to
        // the third derivative.
        let size: f64 = force.iter().zip(&direction).map(|(f, d)| (f * d).abs()).sum();
        prop_assert!((slope - by_difference).abs() <= 2e-3 * size + 1e-6, "{slope:e}, not {by_difference:e}");
    }
}

/// A rod in the air above an obstacle whose surface is at y = 0, `left` of the rod's middle lying
/// over it.
fn falling(obstacle: &str, basis: &str, left: f64, speed: f64, integrator: &str) -> String {
    format!(
        "beam.a = {{ start = [{}, 0.3], end = [{}, 0.3], axial_stiffness = 1e5, bending_stiffness = 10, mass_per_length = 1, basis.{basis} }}\n\
         effect.gravity.acceleration = [0, -9.81]\n\
         initial_velocity = [{{ beam = 'a', value = [0, {speed}] }}]\n\
         effect.contact = [{{ beam = 'a', {obstacle}, stiffness = 1e7 }}]\n\
         probe = [{{ name = 'mid', beam = 'a', at = {} }}]\n\
         analysis.dynamic = {{ duration = {}, output_every = 0.005, {integrator} }}",
        -left,
        1.0 - left,
        left,
        if speed < -5.0 { 0.06 } else { 0.3 },
    )
}

/// Whatever is thrown at an obstacle stays on its side: thin boxes and small discs, between nodes
/// and on them, by steps of any length.
#[test]
fn nothing_is_crossed_in_motion() {
    let plate = ("box = { center = [0, -0.01], size = [2, 0.02] }", 0.02);
    let thin = ("box = { center = [0, -0.002], size = [2, 0.004] }", 0.004);
    let disc = ("circle = { center = [0, -0.05], radius = 0.05 }", 0.1);
    let pin = ("circle = { center = [0, -0.02], radius = 0.02 }", 0.04);
    let (ancf, rpim) = ("ancf.elements = 12", "rpim.nodes = 10");
    for ((obstacle, thickness), basis, left, speed, integrator) in [
        (plate, ancf, 0.5, -1.0, "gauss.tolerance = 1e-4"),
        (plate, rpim, 0.5, -10.0, "radau.tolerance = 1e-7"),
        (plate, ancf, 0.5, -10.0, "radau.step = 0.02"),
        (thin, ancf, 0.5, -1.0, "gauss.step = 0.05"),
        (thin, rpim, 0.5, -1.0, "generalized_alpha.step = 0.05"),
        (thin, ancf, 0.5, -1.0, "generalized_alpha.tolerance = 1e-4"),
        (disc, ancf, 0.5, -1.0, "gauss.tolerance = 1e-3"),
        (disc, ancf, 0.54, -1.0, "gauss.step = 0.02"),
        (disc, rpim, 0.45, -1.0, "radau.tolerance = 1e-4"),
        (pin, ancf, 0.54, -1.0, "radau.tolerance = 1e-4"),
    ] {
        let scene = falling(obstacle, basis, left, speed, integrator);
        let trajectory = solved(&scene).unwrap_or_else(|e| panic!("{obstacle}, {basis}, {integrator}: {e}"));
        let lowest = trajectory.probes[0].samples.iter().fold(f64::INFINITY, |m, s| m.min(s.y));
        assert!(lowest > -0.5 * thickness, "{obstacle}, {basis}, {integrator}: down to y = {lowest}");
        let touched = trajectory.events.len();
        assert!(touched > 0, "{obstacle}, {basis}, {integrator}: nothing was touched");
        let divided = trajectory.run.warnings.iter().any(|warning| warning.contains("divided"));
        assert_eq!(
            divided,
            integrator.contains("step"),
            "{obstacle}, {basis}, {integrator}: {:?}",
            trajectory.run.warnings
        );
    }
}

/// A pin that is too soft to stop what strikes it gives way, which is said; what it takes from the
/// energy it gives back.
#[test]
fn what_gives_way_is_told() {
    let pin = "circle = { center = [0, -0.001], radius = 0.001 }";
    for integrator in ["gauss.tolerance = 1e-5", "radau.tolerance = 1e-4", "radau.step = 0.01"] {
        let trajectory =
            solved(&falling(pin, "ancf.elements = 12", 0.54, -10.0, integrator)).expect("a motion");
        let told = |what: &str| trajectory.run.warnings.iter().any(|warning| warning.contains(what));
        assert!(told("contact a.1 gave way"), "{integrator}: {:?}", trajectory.run.warnings);
        assert_eq!(
            told("divided"),
            integrator.contains("step"),
            "{integrator}: {:?}",
            trajectory.run.warnings
        );
        assert!(!trajectory.events.is_empty(), "{integrator}: the pin was not seen");
    }
}

/// A cantilever is bent against a thin shelf; mirrored, turned, by cells of either kind, by any
/// number of load steps.
#[test]
fn nothing_is_crossed_in_statics() {
    for (turn, sign, basis, analysis) in [
        (0.0, 1.0, "ancf.elements = 12", "static = {}"),
        (0.0, 1.0, "ancf.elements = 12", "static.steps = 7"),
        (0.7, -1.0, "ancf.elements = 12", "static = {}"),
        (2.0, 1.0, "rpim.nodes = 9", "static = {}"),
        (-1.1, 1.0, "ancf.elements = 12", "static.arc_length.until_load = 1"),
    ] {
        let (sine, cosine) = f64::sin_cos(turn);
        let at = |x: f64, y: f64| {
            let y = sign * y;
            format!("[{}, {}]", cosine * x - sine * y, sine * x + cosine * y)
        };
        let scene = format!(
            "beam.a = {{ start = [0, 0], end = {}, axial_stiffness = 1e6, bending_stiffness = 1, basis.{basis} }}\n\
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.force = [{{ beam = 'a', at = 'end', value = {} }}]\n\
             effect.contact = [{{ beam = 'a', box = {{ center = {}, size = [0.6, 0.02], angle = {turn} }}, stiffness = 1e6 }}]\n\
             probe = [{{ name = 'tip', beam = 'a', at = 'end' }}]\n\
             analysis.{analysis}",
            at(1.0, 0.0),
            at(0.0, 3.0),
            at(1.0, 0.15),
        );
        let trajectory = solved(&scene).unwrap_or_else(|e| panic!("{turn}, {basis}, {analysis}: {e}"));
        let tip = trajectory.probes[0].samples.last().expect("an equilibrium");
        let across = sign * (cosine * tip.y - sine * tip.x);
        assert!((across - 0.14104).abs() < 5e-4, "{turn}, {basis}, {analysis}: the tip is {across} aside");
    }
}

/// A hinged beam, turned by an angle, falls on a peg and is bent around it: the places of its tip
/// in its own frame.
fn around_a_peg(turn: f64, friction: &str, integrator: &str) -> Vec<[f64; 2]> {
    let (sine, cosine) = f64::sin_cos(turn);
    let at = |x: f64, y: f64| format!("[{}, {}]", cosine * x - sine * y, sine * x + cosine * y);
    let scene = format!(
        "beam.rope = {{ start = [0, 0], end = {}, axial_stiffness = 1e4, bending_stiffness = 0.5, mass_per_length = 1, basis.ancf.elements = 8 }}\n\
         support = [{{ beam = 'rope', at = 'start', fix = ['x', 'y'] }}]\n\
         effect.gravity.acceleration = {}\n\
         effect.contact = [{{ beam = 'rope', circle = {{ center = {}, radius = 0.1 }}, {friction} stiffness = 1e4 }}]\n\
         probe = [{{ name = 'tip', beam = 'rope', at = 'end' }}]\n\
         analysis.dynamic = {{ duration = 0.5, output_every = 0.05, {integrator} }}",
        at(1.0, 0.0),
        at(0.0, -9.81),
        at(0.3, -0.5),
    );
    let trajectory = solved(&scene).unwrap_or_else(|e| panic!("{friction} {integrator}: {e}"));
    let back = |s: &ancf::results::ProbeSample| [cosine * s.x + sine * s.y, cosine * s.y - sine * s.x];
    trajectory.probes[0].samples.iter().map(back).collect()
}

/// With contact and with friction the error of every method stays within five times the tolerance,
/// in whatever direction the scene lies.
#[test]
fn tolerances_are_kept_with_contact() {
    for (friction, tolerances) in [("", [1e-4, 1e-6]), ("friction.coefficient = 0.3,", [1e-4, 1e-5])] {
        let reference = around_a_peg(0.0, friction, "radau.tolerance = 1e-8");
        for (method, turn) in [("gauss", 1.0), ("radau", 0.0), ("generalized_alpha", -2.0)] {
            for tolerance in tolerances {
                let found = around_a_peg(turn, friction, &format!("{method}.tolerance = {tolerance:e}"));
                let apart = found.iter().zip(&reference).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
                let worst = apart.fold(0.0, f64::max) / tolerance;
                assert!(worst < 5.0, "{friction} {method}, {tolerance:e}: {worst} times the tolerance");
            }
        }
    }
}

/// A long beam is pushed past a soft pin by a moment that swings: the force on the pin begins,
/// turns and ends, and the error of the generalised-α method, which remembers accelerations from
/// before, falls with the tolerance all the same. The numbers are those of a random scene in which
/// it was 28 tolerances of 1e-5; where the force turns within a step is a matter of chance.
#[test]
fn a_pin_that_is_pushed_past_leaves_no_error_behind() {
    let tip = |integrator: &str| {
        let scene = format!(
            "beam.a = {{ start = [0, 0], end = [17.4868021308, 4.01314756933], axial_stiffness = 7807283.3, bending_stiffness = 6012.8803, mass_per_length = 0.52356094, \
             basis.ancf.elements = 16 }}\n\
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}]\n\
             effect.moment = [{{ beam = 'a', at = 'end', value = -569.765014, in_time.harmonic.frequency = 0.5363107 }}]\n\
             effect.distributed_force = [{{ beam = 'a', value = [-0.1539181772, 1.577156206], in_time.ramp = {{ start = 0.39658073, duration = 1.459289 }} }}]\n\
             effect.contact = [{{ beam = 'a', circle = {{ center = [17.15255387, 1.273779032], radius = 0.1524151775 }}, stiffness = 1263.352073 }}]\n\
             probe = [{{ name = 'tip', beam = 'a', at = 'end' }}]\n\
             analysis.dynamic = {{ duration = 2.147067408, output_every = 2.147067408, {integrator} }}"
        );
        let trajectory = solved(&scene).unwrap_or_else(|e| panic!("{integrator}: {e}"));
        let last = trajectory.probes[0].samples.last().expect("a record");
        Vector2::new(last.x, last.y)
    };
    let reference = tip("radau.tolerance = 1e-7");
    for tolerance in [1e-4, 1e-5] {
        let found = tip(&format!("generalized_alpha.tolerance = {tolerance:e}"));
        let apart = (found - reference).norm() / 17.9414 / tolerance;
        assert!(apart < 5.0, "{tolerance:e}: {apart} times the tolerance");
    }
}
