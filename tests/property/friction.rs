//! Dry friction: what sticks rests, what slides is slowed as Coulomb says, and what is lost is
//! friction's work.

use ancf::assembly::{AcceptedState, InternalVariables, Needs, Workspace};
use ancf::effect::{Contact, Friction, Obstacle};
use ancf::linear::Matrix;
use ancf::model::{
    Analysis, Beam, Centreline, Discretization, GaussPoints, Kernel, Model, Nodes, Section, SideCondition,
    StrainMeasure,
};
use ancf::results::{Results, Trajectory};
use ancf::run::{Options, RunError};
use ancf::solve::dynamics::start::from_rest;
use ancf::solve::dynamics::{Solution, Task, solve};
use ancf::system::System;
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

const GRAVITY: f64 = 9.81;

fn solved(text: &str) -> Result<Trajectory, RunError> {
    let scene = ancf::scene::parse("friction.toml", text).expect("a legal scene");
    scene.model().solve(scene.analysis()).map(Results::into_states)
}

proptest! {
    #![proptest_config(super::cases(48))]

    /// The tangent against differences of the force, from states that stick and states that slide;
    /// and the same force from the slips that a state leaves.
    #[test]
    fn the_tangent_is_that_of_the_mapping(
        rpim in any::<bool>(), which in 0..5_usize, push in -0.02..0.02_f64, noise in prop::collection::vec(-1.0..1.0_f64, 40),
    ) {
        let discretization = if rpim {
            Discretization::Rpim {
                nodes: Nodes::Uniform(5),
                kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
                polynomial_terms: 2,
                side_condition: SideCondition::Plus,
                neighbours: 2,
            }
        } else {
            Discretization::Ancf { nodes: Nodes::Uniform(5) }
        };
        let obstacle = [
            Obstacle::HalfPlane { point: [0.0, 0.05], normal: [-0.6, 0.8] },
            Obstacle::Circle { center: [0.5, -0.3], radius: 0.9, inside: false },
            Obstacle::Circle { center: [0.5, 1.0], radius: 0.6, inside: true },
            // These touch a part of the beam.
            Obstacle::Circle { center: [0.4, -0.7], radius: 0.8, inside: false },
            Obstacle::Circle { center: [0.5, 0.2], radius: 0.4, inside: true },
        ][which];
        let edges = which > 2;
        let friction = Some(Friction { coefficient: 0.4, stiffness: 30.0 });
        let contact = Contact { beam: 0, obstacle, stiffness: 20.0, half_thickness: 0.01, friction, between: None };
        let beam = Beam {
            name: "beam".into(),
            centreline: Centreline::Line { start: [0.0, 0.0], end: [1.0, 0.0] },
            section: Section { axial_stiffness: Some(1.0.into()), bending_stiffness: None, mass_per_length: None, ..Default::default() },
            strain: StrainMeasure::Engineering,
            discretization,
            gauss_points: GaussPoints { stretch: 3, bend: 2, lobatto: false },
        };
        let model = Model { beams: vec![beam], parts: vec![Arc::new(contact)], ..Model::default() };
        let system = System::build(&model, Needs::default()).expect("a legal model");
        prop_assert!(!system.is_symmetric());
        let moved = |q: &[f64], size: f64, from: usize| -> Vec<f64> {
            q.iter().zip(noise[from..].iter().cycle()).map(|(q, n)| q + size * n).collect()
        };
        let start = moved(system.reference(), 0.02, 0);
        let rest = AcceptedState { q: start.clone(), variables: InternalVariables::default() };
        let mut first = start.clone();
        first.chunks_exact_mut(4).for_each(|node| node[0] += push);
        let held = AcceptedState { variables: system.internal_variables(&rest, &first), q: first.clone() };
        let mut q = moved(&first, 1e-4, 10);
        q.chunks_exact_mut(4).for_each(|node| node[0] += 0.2 * push);
        prop_assume!(push.abs() > 2e-3);
        let force = |q: &[f64]| {
            let mut f = vec![0.0; q.len()];
            system.add_friction(&held, q, &mut f);
            f
        };
        let (mut f, mut k): (_, Matrix) = (vec![0.0; q.len()], system.matrix());
        k.clear();
        system.add_history_and_tangent(&held, &q, &mut f, &mut k, &mut Workspace::default());
        prop_assert_eq!(&f, &force(&q));
        let direction = moved(&vec![0.0; q.len()], 1.0, 20);
        let step = |h: f64| -> Vec<f64> { q.iter().zip(&direction).map(|(q, d)| q + h * d).collect() };
        let mut product = vec![0.0; q.len()];
        k.multiply_add(1.0, &direction, &mut product);
        let h = 1e-9;
        let (after, before) = (force(&step(h)), force(&step(-h)));
        let largest = product.iter().fold(0.0, |m: f64, p| m.max(p.abs()));
        for ((p, a), b) in product.iter().zip(after).zip(before) {
            let difference = (a - b) / (2.0 * h);
            // Points at the edges of a contact have come to touch, and take the secant. They carry
            // little, but here they have up to a third of the stiffness.
            let off = if edges { 0.5 } else { 1e-5 };
            prop_assert!((p - difference).abs() <= off * largest + 1e-5, "{p}, not {difference} of {largest}");
        }
        // What is remembered of a state gives its force.
        let mut again = vec![0.0; q.len()];
        system.add_known_history(&system.internal_variables(&held, &q), &q, &mut again);
        let size = f.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        for (a, b) in f.iter().zip(&again) {
            prop_assert!((a - b).abs() <= 1e-9 * size + 1e-15, "{a}, not {b}");
        }
    }
}

/// A rod on a slope of `angle` degrees, with friction 0.5 and in the depth at which the ground
/// bears it, or touching it only.
fn slope(angle: f64, depth: f64, duration: f64, basis: &str, integrator: &str) -> String {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let at = |along: f64| format!("[{}, {}]", along * cosine + depth * sine, along * sine - depth * cosine);
    format!(
        "beam.rod = {{ start = {}, end = {}, axial_stiffness = 1e5, bending_stiffness = 10, mass_per_length = 1, basis.{basis} }}\n\
         effect.gravity.acceleration = [0, {}]\n\
         effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, 0], normal = [{}, {cosine}] }}, stiffness = 1e4, friction.coefficient = 0.5 }}]\n\
         probe = [{{ name = 'end', beam = 'rod', at = 'end' }}]\n\
         analysis.dynamic = {{ duration = {duration}, output_every = {}, {integrator} }}",
        at(0.0),
        at(1.0),
        -GRAVITY,
        -sine,
        duration / 20.0,
    )
}

/// How far down the slope the rod's end is.
fn slid(trajectory: &Trajectory, angle: f64) -> f64 {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let end = trajectory.probes[0].samples.last().expect("a record");
    1.0 - (end.x * cosine + end.y * sine)
}

const METHODS: [&str; 3] =
    ["gauss.tolerance = 1e-5", "radau.tolerance = 1e-5", "generalized_alpha.tolerance = 1e-5"];

/// Below the angle of friction a rod rests, to the springs' give; beyond it, it slides with g (sin
/// − μ cos).
#[test]
fn a_rod_rests_on_a_slope_or_slides() {
    for (integrator, basis) in
        METHODS.into_iter().zip(["ancf.elements = 4", "rpim.nodes = 5", "ancf.elements = 3"])
    {
        for angle in [10.0_f64, 13.0] {
            let depth = GRAVITY * angle.to_radians().cos() / 1e4;
            let trajectory = solved(&slope(angle, depth, 3.0, basis, integrator)).expect("a motion");
            let (slid, give) = (slid(&trajectory, angle), GRAVITY * angle.to_radians().sin() / 1e4);
            assert!((-1e-5..2.2 * give).contains(&slid), "{integrator}: {slid} m down a slope of {angle}°");
            assert!(
                trajectory.energy.iter().all(|e| e.lost.abs() < 1e-5),
                "{integrator}: what rests takes nothing"
            );
        }
        let angle = 40.0_f64;
        let depth = GRAVITY * angle.to_radians().cos() / 1e4;
        let trajectory = solved(&slope(angle, depth, 0.5, basis, integrator)).expect("a motion");
        let (sine, cosine) = angle.to_radians().sin_cos();
        // The springs are stretched first, swinging with ω² = 1e4 /s² until they hold no more.
        let (turned, give) = ((1.0 - 0.5 * cosine / sine).acos(), 0.5 * GRAVITY * cosine / 1e4);
        let (start, left) = (GRAVITY * sine / 100.0 * turned.sin(), 0.5 - turned / 100.0);
        let way = give + start * left + 0.5 * GRAVITY * (sine - 0.5 * cosine) * left * left;
        let found = slid(&trajectory, angle);
        assert!((found - way).abs() < 5e-5, "{integrator}: {found} m, not {way}");
        let lost = trajectory.energy.last().expect("a record").lost;
        let work = 0.5 * GRAVITY * cosine * (way - give);
        assert!((lost - work).abs() < 1e-3 * work, "{integrator}: {lost} J lost, not {work}");
    }
}

/// A long rest on a slope, by fixed steps from the surface's edge: pressure and traction swing
/// together.
#[test]
fn a_rod_does_not_creep() {
    let trajectory =
        solved(&slope(10.0, 0.0, 10.0, "ancf.elements = 1", "gauss.tolerance = 1e-5")).expect("a motion");
    assert!(slid(&trajectory, 10.0).abs() < 1e-3, "{} m", slid(&trajectory, 10.0));
}

/// What friction remembers is part of a saved state.
#[test]
fn a_restart_goes_on_bit_for_bit() {
    for integrator in METHODS {
        let text = slope(30.0, 0.0, 0.3, "ancf.elements = 3", integrator);
        let scene = ancf::scene::parse("slope.toml", &text).expect("a legal scene");
        let Analysis::Dynamic(settings) = scene.analysis() else { panic!("a motion") };
        let system =
            System::build(scene.model(), Needs { inertia: true, motion: true }).expect("a legal model");
        let task = |start| Task {
            duration: settings.duration,
            output_every: settings.output_every,
            integrator: settings.integrator,
            start,
            reactions: false,
            forces: false,
            directions: &[],
            watches: &[],
            keep: None,
        };
        let rest = || from_rest(&system, &[]).expect("at rest");
        let whole = solve(&system, &task(rest()), &mut |_, _, _| true);
        let mut steps = 0;
        let first = solve(&system, &task(rest()), &mut |_, _, _| {
            steps += 1;
            steps < 20
        });
        let text = serde_json::to_string(&first.checkpoint).expect("finite numbers");
        let second =
            solve(&system, &task(serde_json::from_str(&text).expect("what was written")), &mut |_, _, _| {
                true
            });
        let last = |solution: &Solution| solution.states.last().cloned().expect("a state");
        assert!(last(&first).time < 0.9 * last(&whole).time, "{integrator}: stopped on the way");
        assert_eq!(last(&second), last(&whole), "{integrator}");
        assert!(last(&whole).variables.friction > 0.0, "{integrator}: the springs of friction are stretched");
    }
}

/// In statics: a rod on the ground that is pulled by a third of what moves it, against a soft
/// spring; and by twice of that.
#[test]
fn a_rod_sticks_in_statics() {
    for (pull, steps) in [
        (0.5 * GRAVITY / 3.0, "{}"),
        (0.5 * GRAVITY / 3.0, "{ steps = 5 }"),
        (GRAVITY, "{}"),
        (GRAVITY, "{ steps = 4 }"),
    ] {
        let scene = format!(
            "beam.rod = {{ start = [0, -0.0001], end = [1, -0.0001], axial_stiffness = 1e5, bending_stiffness = 10, mass_per_length = 1, basis.ancf.elements = 4 }}\n\
             effect.gravity.acceleration = [0, {}]\n\
             effect.force = [{{ beam = 'rod', at = 'end', value = [{pull}, 0] }}]\n\
             effect.spring = [{{ beam = 'rod', at = 'start', stiffness = 10 }}]\n\
             effect.contact = [{{ beam = 'rod', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = 1e4, friction.coefficient = 0.5 }}]\n\
             probe = [{{ name = 'end', beam = 'rod', at = 'end' }}]\n\
             analysis.static = {steps}",
            -GRAVITY
        );
        let trajectory = solved(&scene).unwrap_or_else(|e| panic!("{pull} N, {steps}: {e}"));
        let moved = trajectory.probes[0].samples.last().expect("an equilibrium").x - 1.0;
        let expected = ((pull - 0.5 * GRAVITY) / 10.0).max(0.0);
        assert!((moved - expected).abs() < 2e-3, "{pull} N, {steps}: moved by {moved} m, not {expected}");

        // A motion that starts there knows what holds the rod, and rests.
        let dynamic = scene
            .replace(&format!("static = {steps}"), "dynamic = { duration = 0.2, radau.tolerance = 1e-6 }");
        let dynamic = ancf::scene::parse("friction.toml", &dynamic).expect("a legal scene");
        let start = Options { start: trajectory.saved.as_ref(), ..Options::default() };
        let rest = dynamic.model().solve_with(dynamic.analysis(), start);
        let rest = rest.unwrap_or_else(|e| panic!("{pull} N, {steps}: {e}"));
        for sample in &rest.states().probes[0].samples {
            let crept = (sample.x - 1.0 - moved).abs();
            assert!(crept < 1e-5, "{pull} N, {steps}: creeps by {crept:e} m");
        }
    }
}

/// Capstan: a thin belt that hangs over a disc is pulled at one end and held at the other by the
/// pull times e^(−μφ).
#[test]
fn a_belt_over_a_disc_is_held_as_a_capstan_holds_it() {
    for (basis, coefficient) in [("ancf.elements", 0.3), ("rpim.nodes", 0.2)] {
        let section = "axial_stiffness = 1e4, bending_stiffness = 1e-4";
        let scene = format!(
            "beam.held = {{ start = [0.5, -0.3], end = [0.5, 0], {section}, basis.{basis} = 5 }}\n\
             beam.belt = {{ arc = {{ center = [0, 0], radius = 0.5, from = 0, to = '180 deg' }}, {section}, basis.{basis} = 40 }}\n\
             beam.pulled = {{ start = [-0.5, 0], end = [-0.5, -0.3], {section}, basis.{basis} = 5 }}\n\
             joint = [\n\
               {{ type = 'weld', first = {{ beam = 'held', at = 'end' }}, second = {{ beam = 'belt', at = 'start' }} }},\n\
               {{ type = 'weld', first = {{ beam = 'belt', at = 'end' }}, second = {{ beam = 'pulled', at = 'start' }} }},\n\
             ]\n\
             support = [{{ beam = 'held', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.force = [{{ beam = 'pulled', at = 'end', value = [0, -10] }}]\n\
             effect.contact = [{{ beam = 'belt', circle = {{ center = [0, 0], radius = 0.5 }}, stiffness = 1e6, friction = {{ coefficient = {coefficient}, stiffness = 1e7 }} }}]\n\
             probe = [{{ name = 'end', beam = 'pulled', at = 'end' }}]\n\
             output.reactions = true\n\
             analysis.static = {{}}"
        );
        let trajectory = solved(&scene).unwrap_or_else(|e| panic!("{basis}: {e}"));
        let held = trajectory.reactions[0].samples.last().expect("a reaction");
        let expected = 10.0 * (-coefficient * PI).exp();
        assert!((-held.fy - expected).abs() < 2e-3 * expected, "{basis}: held by {held:?}, not {expected}");
    }
}

/// The same of a string, whose belt leaves the disc where it is pulled and held. What slides takes no
/// stiffness from what it slows down: iterations do not grow with the stiffness of the contact.
#[test]
fn a_string_over_a_disc_is_held_as_a_capstan_holds_it() {
    for stiffness in [1e4_f64, 1e6] {
        let scene = format!(
            "beam.a = {{ arc = {{ center = [0, 0], radius = 1, from = 0.3, to = 2.3 }}, axial_stiffness = 1e4, basis.ancf.elements = 64 }}
            support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}]
            effect.force = [{{ beam = 'a', at = 'end', value = [{:?}, {:?}] }}]
            effect.contact = [{{ beam = 'a', circle = {{ center = [0, 0], radius = 1 }}, stiffness = {stiffness:?}, friction.coefficient = 0.3 }}]
            probe = [{{ name = 'end', beam = 'a', at = 'end' }}]
            output.reactions = true
            analysis.static = {{}}",
            -10.0 * 2.3_f64.sin(),
            10.0 * 2.3_f64.cos(),
        );
        let trajectory = solved(&scene).unwrap_or_else(|error| panic!("{stiffness}: {error}"));
        let held = trajectory.reactions[0].samples.last().expect("a reaction");
        let (held, expected) = (held.fx.hypot(held.fy), 10.0 * (-0.3 * 2.0_f64).exp());
        // A string that sinks in by T/k leaves the disc √(2 T/k) before each of its ends.
        let early = 0.3 * 2.0 * (2.0 * 10.0 / stiffness).sqrt();
        assert!(
            (0.0..early).contains(&(held / expected - 1.0)),
            "{stiffness}: held by {held} N, not {expected} N"
        );
        let iterations = trajectory.run.statistics.newton_iterations;
        assert!(iterations < 1000, "{stiffness}: {iterations}");
    }
}

/// A bar that lies on a slope, with a gap that is zero but for round-off, slides down by
/// ½ g (sin α − μ cos α) t², whatever the slope.
#[test]
fn a_bar_that_lies_on_a_slope_slides() {
    for degrees in [-20.0_f64, 10.0, 25.0, 30.0, 60.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [{cosine:?}, {sine:?}], axial_stiffness = 1e5, bending_stiffness = 100, mass_per_length = 2, \
             basis.ancf.elements = 6 }}
            probe = [{{ name = 't', beam = 'a', at = 0.5 }}]
            effect.gravity.acceleration = [0, -9.81]
            effect.contact = [{{ beam = 'a', stiffness = 2e5, half_plane = {{ point = [0, 0], normal = [{:?}, {cosine:?}] }}, \
             friction = {{ coefficient = 0.05, stiffness = 1e6 }} }}]
            analysis.dynamic = {{ duration = 0.3, output_every = 0.1 }}",
            -sine
        );
        let scene = ancf::scene::parse("slope.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let results =
            scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{degrees}: {error}"));
        let end = results.states().probes[0].samples.last().expect("a state");
        let along = (end.x - 0.5 * cosine) * cosine + (end.y - 0.5 * sine) * sine;
        let exact = -0.5 * 9.81 * (sine.abs() - 0.05 * cosine) * 0.09 * sine.signum();
        // The bar settles by g/k/L, and its friction stores up to μ g m/k_t, both some 1e-4 m.
        assert!((along - exact).abs() < 5e-4, "{degrees}: {along} for {exact}");
    }
}
