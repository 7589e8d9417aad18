//! What friction errs by in the steps of the load.

use super::{error, run, scene};

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
