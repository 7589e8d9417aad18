//! Torsion springs count all turns: statics, motion, restarts and vibrations of what is wound up,
//! against closed forms.

use ancf::assembly::{AcceptedState, InternalVariables, Needs};
use ancf::results::Trajectory;
use ancf::system::System;
use std::f64::consts::{PI, TAU};

fn solved(text: &str) -> Trajectory {
    let scene = ancf::scene::parse("winding.toml", text).expect("a legal scene");
    scene.model().solve(scene.analysis()).unwrap_or_else(|e| panic!("{e}")).into_states()
}

/// A clamped beam is coiled up by a couple at its end against a spring at 0.9 m, which turns by
/// 0.9 M/(EI + 0.9 k).
#[test]
fn a_coil_is_held_back_by_all_its_turns() {
    let (ei, k) = (2.0, 1.0);
    for (turns, basis, analysis) in [
        (0.4, "ancf.elements = 20", "static = {}"),
        (0.9, "ancf.elements = 20", "static = {}"),
        (-2.3, "ancf.elements = 20", "static = {}"),
        (2.3, "ancf.elements = 20", "static.steps = 3"),
        (1.6, "rpim.nodes = 40", "static = {}"),
        (1.6, "ancf.elements = 20", "static.arc_length.until_load = 1"),
    ] {
        let moment = ei * TAU * turns;
        let scene = format!(
            "beam.coil = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = {ei}, basis.{basis} }}\n\
             analysis.{analysis}\n\
             support = [{{ beam = 'coil', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             probe = [{{ name = 'spring', beam = 'coil', at = 0.9 }}]\n\
             effect.moment = [{{ beam = 'coil', at = 'end', value = {moment} }}]\n\
             effect.torsion_spring = [{{ beam = 'coil', at = 0.9, stiffness = {k} }}]"
        );
        let trajectory = solved(&scene);
        let found = trajectory.probes[0].samples.last().expect("an equilibrium").angle;
        let exact = 0.9 * moment / (ei + 0.9 * k);
        assert!(
            (found - exact).abs() < 2e-3 * exact.abs(),
            "{turns}, {basis}, {analysis}: {found}, not {exact}"
        );
        let stored = trajectory.energy.last().expect("energies").stored;
        let half = 0.5 * k * exact * exact;
        assert!((stored - half).abs() < 5e-3 * half, "{turns}, {basis}: {stored} J, not {half} J");
    }
}

/// A rod on a hinge with a torsion spring.
const ROD: &str = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e10, bending_stiffness = 1e7, mass_per_length = 3, basis.ancf.elements = 4 }\n\
    support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]\n\
    probe = [{ name = 'hub', beam = 'rod', at = 'start' }]\n\
    effect.torsion_spring = [{ beam = 'rod', at = 'start', stiffness = 2 }]\n";

/// J = 1 kg m², k = 2 N m/rad: θ = (ω₀/√2) sin √2 t, three turns and a half to either side.
#[test]
fn a_rod_swings_through_all_turns_of_its_spring() {
    let speed = 22.0 * 2_f64.sqrt();
    for (integrator, allowed) in [
        ("radau.tolerance = 1e-5", 1e-4),
        ("gauss.tolerance = 1e-4", 1e-3),
        ("generalized_alpha.step = 5e-4", 5e-2),
        ("radau.step = 2e-3", 1e-4),
    ] {
        let scene = format!(
            "{ROD}initial_velocity = [{{ beam = 'rod', rotation = {speed}, about = [0, 0] }}]\n\
             analysis.dynamic = {{ duration = 2.3, output_every = 0.05, {integrator} }}"
        );
        let trajectory = solved(&scene);
        for (time, sample) in trajectory.parameter.iter().zip(&trajectory.probes[0].samples) {
            let exact = 22.0 * (2_f64.sqrt() * time).sin();
            let found = sample.angle;
            assert!((found - exact).abs() < allowed, "{integrator}: {found} at {time} s, not {exact}");
        }
        let [first, last] =
            [trajectory.energy.first(), trajectory.energy.last()].map(|e| e.expect("energies"));
        let drift = (last.total() - first.total()).abs() / first.kinetic;
        assert!(drift < 1e-3, "{integrator}: drift {drift:e}");
    }
}

/// A couple winds the spring up by ten radians; the rod vibrates about it as about the stress-free
/// state: f = √(k/J)/2π.
#[test]
fn a_wound_spring_vibrates_as_a_slack_one() {
    let exact = 2_f64.sqrt() / TAU;
    for moment in [0.0, 6.0, 20.0, -31.0] {
        // Less stiff along: what round-off leaves of an axial force counts as a stiffness.
        let rod = ROD.replace("axial_stiffness = 1e10", "axial_stiffness = 1e6");
        let scene = format!(
            "{rod}effect.moment = [{{ beam = 'rod', at = 'start', value = {moment} }}]\n\
             analysis.modal = {{ count = 2, about = 'equilibrium' }}"
        );
        let scene = ancf::scene::parse("scene.toml", &scene).unwrap_or_else(|e| panic!("{e}"));
        let found = scene.model().solve(scene.analysis()).unwrap_or_else(|e| panic!("{e}")).eigenvalues()[0];
        assert!((found - exact).abs() < 1e-4 * exact, "{moment} N m: {found} Hz, not {exact} Hz");
    }
}

/// How far springs turn from one state to the next is told by the one that turns most, to either
/// side, its turns counted.
#[test]
fn the_turn_of_a_step_is_that_of_the_spring_that_turns_most() {
    let two = ROD.replace("stiffness = 2 }", "stiffness = 2 }, { beam = 'rod', at = 'end', stiffness = 3 }");
    let text = format!("{two}analysis.dynamic.duration = 1");
    let scene = ancf::scene::parse("winding.toml", &text).expect("a legal scene");
    let system = System::build(scene.model(), Needs { inertia: true, motion: true }).expect("a system");
    let last = system.coordinates() - 4;
    for (before, [start, end], turn) in [
        ([0.3, -0.2], [1.0_f64, 0.1_f64], 0.7),
        ([0.3, -0.2], [0.2, -1.9], 1.7),
        ([7.0, -0.2], [0.5, -0.2], 7.0 - 0.5 - TAU),
    ] {
        let mut q = system.reference().to_vec();
        for (node, direction) in [(0, start), (last, end)] {
            (q[node + 2], q[node + 3]) = (direction.cos(), direction.sin());
        }
        let variables = InternalVariables { angles: before.to_vec(), ..InternalVariables::default() };
        let held = AcceptedState { q: system.reference().to_vec(), variables };
        let found = system.winding_turn(&held, &q);
        assert!((found - turn).abs() < 1e-12, "from {before:?} to {start}, {end}: {found}, not {turn}");
    }
}

/// A support that turns the end of a clamped beam by θ = nπ against a spring there holds it by (EI/L + k) θ. Just half a turn is both π
/// and −π, and the full turns beyond it follow from which of them it is taken for.
#[test]
fn a_spring_that_is_turned_by_half_turns_has_all_its_moment() {
    let (ei, k) = (1.0, 0.5);
    for (half_turns, basis, analysis) in [
        (1, "ancf.elements = 20", "static = {}"),
        (-1, "ancf.elements = 20", "static = {}"),
        (1, "rpim.nodes = 15", "static.steps = 4"),
        (2, "ancf.elements = 20", "static = {}"),
        (3, "ancf.elements = 20", "static.arc_length.until_load = 1"),
        (-3, "ancf.elements = 20", "static.steps = 3"),
        (5, "ancf.elements = 40", "static = {}"),
        (7, "ancf.elements = 40", "static.arc_length.until_load = 1"),
    ] {
        let trajectory = solved(&format!(
            "beam.coil = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = {ei}, basis.{basis} }}\n\
             analysis.{analysis}\noutput.reactions = true\n\
             support = [{{ beam = 'coil', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'coil', at = 'end', fix = ['angle'], \
             move = {{ angle = '{} deg' }} }}]\n\
             effect.torsion_spring = [{{ beam = 'coil', at = 'end', stiffness = {k} }}]",
            180 * half_turns
        ));
        let found = trajectory.reactions[1].samples.last().expect("an equilibrium").moment;
        let exact = (ei + k) * f64::from(half_turns) * PI;
        assert!((found - exact).abs() < 1e-3 * exact.abs(), "{half_turns}, {analysis}: {found} for {exact}");
    }
}
