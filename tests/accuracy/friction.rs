//! What friction errs by in the steps of the load and of time.

use super::{error, last, run, scene};
use ancf::results::Results;

/// A soft cantilever that is pressed against a rough disc by a force at its end.
fn pressed(analysis: &str) -> String {
    format!(
        "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1500, bending_stiffness = 0.06 }}
         support = [{{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }}]
         effect.contact = [{{ beam = 'b', circle = {{ center = [0.45, -0.3], radius = 0.23 }}, stiffness = 4000, friction = {{ coefficient = 0.5 }} }}]
         effect.force = [{{ beam = 'b', at = 'end', value = [-0.6, -0.6] }}]
         probe = [{{ name = 'q', beam = 'b', at = 0.25 }}]
         analysis.static = {analysis}\n"
    )
}

/// y of the probe by a chain of 320 rigid links with springs, which presses against the same disc with the same law of
/// friction in 400 steps of the load (a program of its own), and what its links err by: half of what half as many change. With
/// the seven load steps that the equilibria alone need y is wrong by 4e-4.
const CHAIN: [f64; 2] = [-6.98e-3, 5e-5];

#[test]
fn errors_of_load_steps_count() {
    for wanted in [1e-3, 1e-4] {
        let results = run(&scene(&pressed(&format!("{{ accuracy = {wanted:e} }}"))));
        let (error, found) = (error(&results), results.states().probes[0].samples.last().expect("a state").y);
        assert!(error.met && error.estimated.result <= wanted, "{error:?}");
        assert!((found - CHAIN[0]).abs() < wanted + CHAIN[1], "{found} for {wanted:e}");
        assert!(error.runs.iter().all(|run| run.setting.contains("of the load")), "{error:?}");
        let chosen = error.chosen.as_deref().expect("the chosen scene");
        assert!(chosen.contains("max_step = "), "{chosen}");
        let again = run(&ancf::scene::parse("chosen.toml", chosen).expect("a legal scene"));
        assert_eq!(again.states().probes[0].samples.last().map(|sample| sample.y), Some(found));
    }
}

/// Load steps that the scene names are kept, and tell of their errors by runs with longer ones.
#[test]
fn errors_of_named_load_steps_are_estimated() {
    for (named, largest) in [("max_step = 1", true), ("max_step = 0.05", false)] {
        let text = pressed(&format!("{{ {named}, accuracy = 1e-4 }}"));
        let results = ancf::accuracy::run(&scene(&text), ancf::Options::default());
        let results = results.unwrap_or_else(|error| panic!("{error}"));
        let (error, found) = (error(&results), results.states().probes[0].samples.last().expect("a state").y);
        let wrong = (found - CHAIN[0]).abs();
        assert!(wrong < error.estimated.result + CHAIN[1], "{wrong:e}: {error:?}");
        assert!(!error.met || !largest, "{error:?}");
    }
}

/// A stiff flat bar on the ground: dead forces per mass along it and on the ground, and a speed along it. It is one point, of
/// which this integrator with a hundred thousand steps knows where it is: penetration and slip by leapfrog, the slip cut off
/// at Coulomb's limit after each step.
struct Sliding {
    gravity: [f64; 2],
    speed: f64,
    /// k/ρA and k_t/ρA.
    stiffness: [f64; 2],
    coefficient: f64,
    duration: f64,
}

impl Sliding {
    fn travelled(&self) -> f64 {
        const STEPS: u32 = 100_000;
        let h = self.duration / f64::from(STEPS);
        let [normal, tangential] = self.stiffness;
        let ([mut x, mut y], [mut u, mut v], mut slip) = ([0.0; 2], [self.speed, 0.0], 0.0_f64);
        let mut force = [0.0; 2];
        for _ in 0..STEPS {
            u += 0.5 * h * (self.gravity[0] + force[0]);
            v += 0.5 * h * (self.gravity[1] + force[1]);
            (x, y) = (h.mul_add(u, x), h.mul_add(v, y));
            let pressure = normal * (-y).max(0.0);
            let limit = self.coefficient * pressure / tangential;
            slip = h.mul_add(u, slip).clamp(-limit, limit);
            force = [-tangential * slip, pressure];
            u += 0.5 * h * (self.gravity[0] + force[0]);
            v += 0.5 * h * (self.gravity[1] + force[1]);
        }
        x
    }

    fn scene(&self, length: f64, basis: &str, analysis: &str) -> ancf::Scene {
        let Self { gravity, speed, stiffness: [normal, tangential], coefficient, duration } = self;
        let (axial, bending) = (1e3 * normal * length.powi(2), 1e3 * normal * length.powi(4));
        scene(&format!(
            "beam.bar = {{ start = [0, 0], end = [{length:?}, 0], axial_stiffness = {axial:?}, bending_stiffness = {bending:?}, \
             mass_per_length = 1 {basis} }}\n\
             effect.gravity.acceleration = {gravity:?}\n\
             effect.contact = [{{ beam = 'bar', half_plane = {{ point = [0, 0], normal = [0, 1] }}, stiffness = {normal:?}, \
             friction = {{ coefficient = {coefficient:?}, stiffness = {tangential:?} }} }}]\n\
             initial_velocity = [{{ beam = 'bar', value = [{speed:?}, 0] }}]\n\
             probe = [{{ name = 'end', beam = 'bar', at = 'start' }}]\n\
             analysis.dynamic = {{ duration = {duration:?}, output_every = {every:?}, {analysis} }}\n",
            every = duration / 10.0,
        ))
    }
}

/// While the pressure of a point that slides falls, its slip falls with its limit even after it has turned back, until it moves
/// back faster than that; a step that ended later took the whole way back from the limit at its start. Between two looks of a
/// step a point may stick and slide again. Both erred by ten times the tolerance, and by fifty times what was told.
#[test]
fn friction_under_pressure_that_changes_keeps_the_tolerance() {
    let bars = [
        (
            3.29,
            Sliding {
                gravity: [-0.43003, -0.86791],
                speed: 0.3319,
                stiffness: [94.96, 94.96],
                coefficient: 0.4968,
                duration: 5.004,
            },
        ),
        (
            865.7,
            Sliding {
                gravity: [-0.055_89, -0.230_83],
                speed: -0.6204,
                stiffness: [0.046_68, 0.010_884],
                coefficient: 0.8931,
                duration: 86.96,
            },
        ),
        (
            1.0,
            Sliding {
                gravity: [0.2, -1.0],
                speed: 0.5,
                stiffness: [400.0, 300.0],
                coefficient: 0.3,
                duration: 3.0,
            },
        ),
    ];
    for (length, bar) in bars {
        let truth = bar.travelled();
        let miss = |results: &Results| (last(results).x - truth).abs() / length;
        for tolerance in [1e-3, 1e-5] {
            for method in ["radau", "gauss"] {
                let integrator = format!("{method}.tolerance = {tolerance:e}");
                let miss = miss(&run(&bar.scene(length, ", basis.ancf.elements = 2", &integrator)));
                assert!(miss <= 10.0 * tolerance, "{integrator}, {length} m: {miss:.1e}");
            }
        }
        for wanted in [1e-2, 1e-4] {
            let results = run(&bar.scene(length, "", &format!("accuracy = {wanted:?}")));
            let (miss, told) = (miss(&results), error(&results).estimated.result);
            assert!(
                miss <= 5.0 * told + 1e-9 && told <= wanted,
                "{wanted:?}, {length} m: {miss:.1e}, told {told:.1e}"
            );
        }
    }
}
