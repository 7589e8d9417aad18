//! Pendulums that fall: the same elements, method and step, so the same motion.

use ancf_check::case::Peer;
use ancf_verification::peers::ask;

use crate::{both, distance, ours, tips};

/// The pendulum of Chen, Zhang & Li 2018, Section 4.2.
fn pendulum(modulus: f64, elements: usize, method: &str) -> String {
    format!(
        r#"
[beam.arm]
start = [0.0, 0.0]
end = [1.8, 0.0]
youngs_modulus = {modulus:?}
area = 2.5e-4
second_moment = 0.130e-8
density = 2766.67
strain = "engineering"
basis.ancf = {{ elements = {elements}, gauss_points = {{ stretch = 5, bend = 3 }} }}

[[support]]
beam = "arm"
at = "start"
fix = ["x", "y"]

[effect.gravity]
acceleration = [0.0, -9.81]

[[probe]]
name = "tip"
beam = "arm"
at = "end"

[analysis.dynamic]
duration = 0.5
output_every = 0.1
{method}
"#
    )
}

const SOFT: f64 = 68.95e6;
const STIFF: f64 = 68.95e9;
const STEPS: [f64; 3] = [2e-3, 1e-3, 0.5e-3];

/// With the equations of a step solved to round-off: what the usual 1e-11 leaves of them swings
/// axially in a stiff beam, and the tips of the stiff pendulum are then 2e-7 m apart.
fn generalized_alpha(step: f64, radius: f64) -> String {
    format!(
        "generalized_alpha = {{ step = {step:?}, spectral_radius = {radius:?}, newton_tolerance = 1e-14 }}"
    )
}

/// Ours and Exudyn's tips stay together over half a second, and energies with them. Where both
/// solve the equations of a step to a relative 1e-9 or so, that adds up to 1e-9 m over a thousand
/// steps.
fn together(modulus: f64, radius: f64) {
    for step in STEPS {
        let (ours, theirs) = both(Peer::Exudyn, &pendulum(modulus, 8, &generalized_alpha(step, radius)));
        assert_eq!(ours.run().statistics.rejected_steps, 0);
        let apart = tips(&ours, &theirs).iter().map(|(_, a, b)| distance(*a, *b)).fold(0.0, f64::max);
        println!("E = {modulus:e}, radius {radius}, step {step}: {apart:.1e} m apart");
        assert!(apart < 1e-8 * 1.8, "step {step}: {apart} m apart");
        for (a, b) in ours.states().energy.iter().zip(&theirs.energy) {
            let pairs =
                [(a.stretch, b.stretch), (a.bend, b.bend), (a.kinetic, b.kinetic), (a.potential, b.weight)];
            assert!(pairs.iter().all(|(a, b)| (a - b).abs() < 1e-6), "step {step}: {a:?} {b:?}");
        }
    }
}

#[test]
fn exudyn_moves_the_soft_pendulum_alike_by_the_trapezoidal_rule() {
    together(SOFT, 1.0);
}

#[test]
fn exudyn_moves_the_stiff_pendulum_alike_by_the_trapezoidal_rule() {
    together(STIFF, 1.0);
}

#[test]
fn exudyn_moves_the_pendulums_alike_with_damping_of_the_highest_frequencies() {
    together(SOFT, 0.8);
    together(STIFF, 0.8);
}

/// Both have one error, that of the step: against collocation of order 6 it falls with order 2, as
/// the trapezoidal rule's must once the step resolves the fastest waves. With four soft elements
/// their period is some 2 ms; those of the stiff ones are thirty times as fast, and no order is to
/// be seen there down to steps of 0.025 ms.
#[test]
fn exudyn_errs_by_its_step_with_order_2() {
    let exact = ours(&pendulum(SOFT, 4, "gauss = { stages = 3, step = 0.1e-3 }"));
    let errors = [0.4e-3, 0.2e-3, 0.1e-3].map(|step| {
        let (_, theirs) = both(Peer::Exudyn, &pendulum(SOFT, 4, &generalized_alpha(step, 1.0)));
        tips(&exact, &theirs).iter().map(|(_, a, b)| distance(*a, *b)).fold(0.0, f64::max)
    });
    let orders = [errors[0] / errors[1], errors[1] / errors[2]].map(f64::log2);
    println!("errors {errors:?} m, orders {orders:?}");
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.05), "{errors:?} m, orders {orders:?}");
    assert!(errors[2] < 5e-6 * 1.8, "{errors:?} m");
}

/// Steps of 10 ms are far too long for 120 soft elements, and Exudyn gives up: an error, after
/// which it can be asked again.
#[test]
fn exudyn_that_gives_up_is_an_error() {
    let text = pendulum(SOFT, 120, &generalized_alpha(1e-2, 1.0)).replace("duration = 0.5", "duration = 2.5");
    let scene = ancf::scene::parse("live.toml", &text).expect("a legal scene");
    let error = ask(Peer::Exudyn, &scene).expect_err("no motion").to_string();
    assert!(error.starts_with("live.toml: Exudyn: SolveDynamic terminated"), "{error}");
    both(Peer::Exudyn, &pendulum(SOFT, 2, &generalized_alpha(1e-2, 1.0)));
}

/// Two beams, one flying and spinning freely, one along y that is hit at its end by a follower:
/// ours and Exudyn's together.
#[test]
fn exudyn_lets_beams_fly_alike() {
    let text = r#"
[beam.free]
start = [0.2, 0.1]
end = [0.8, 0.9]
axial_stiffness = 5e2
bending_stiffness = 0.2
mass_per_length = 0.3
strain = "engineering"
basis.ancf = { elements = 5, gauss_points = { stretch = 4, bend = 2 } }

[beam.held]
start = [0.0, 0.0]
end = [0.0, 1.0]
axial_stiffness = 5e2
bending_stiffness = 0.2
mass_per_length = 0.3
strain = "engineering"
basis.ancf = { nodes = [0.0, 0.1, 0.35, 0.6, 1.0], gauss_points = { stretch = 5, bend = 3 } }

[[support]]
beam = "held"
at = "start"
fix = ["x", "y", "gradient"]

[[initial_velocity]]
beam = "free"
value = [1.0, 2.0]
rotation = 3.0
about = [0.5, 0.5]
polynomial = { vx = [0.0, 0.3, -0.5], vy = [0.1, 0.0, 0.0, 0.4] }

[[initial_velocity]]
beam = "held"
table = { s = [0.0, 0.4, 1.0], vx = [0.0, 0.2, -0.3] }

[[effect.force]]
beam = "held"
at = "end"
value = [0.3, 0.1]
follower = true

[[effect.force]]
beam = "free"
at = "start"
value = [0.0, 0.5]

[[probe]]
name = "tip"
beam = "free"
at = "end"

[[probe]]
name = "held"
beam = "held"
at = "end"

[analysis.dynamic]
duration = 0.5
output_every = 0.1
generalized_alpha = { step = 1e-3, spectral_radius = 0.9 }
"#;
    let (ours, theirs) = both(Peer::Exudyn, text);
    for (a, b) in ours.states().probes.iter().zip(&theirs.probes) {
        let places = a.samples.iter().zip(b.x.iter().zip(&b.y));
        let apart = places.map(|(p, (x, y))| (p.x - x).hypot(p.y - y)).fold(0.0, f64::max);
        println!("{}: {apart:.1e} m apart", a.name);
        assert!(apart < 1e-8, "{}: {apart} m apart", a.name);
    }
    for (a, b) in ours.states().energy.iter().zip(&theirs.energy) {
        let parts = [(a.stretch, b.stretch), (a.bend, b.bend), (a.kinetic, b.kinetic)];
        assert!(parts.iter().all(|(a, b)| (a - b).abs() < 1e-6), "{a:?} {b:?}");
    }
}
