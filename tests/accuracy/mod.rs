//! Results know their errors: what is chosen for an accuracy meets it, and the estimate is near the
//! truth.

mod chosen;
mod files;
mod friction;
mod refused;
mod stages;
mod worth;

use ancf::results::{ErrorEstimate, ProbeSample, Results};
use ancf::scene::{Scene, parse};
use ancf::{Options, accuracy};

/// A cantilever of unit length with these stiffnesses and no basis.
fn cantilever(stretch: f64, bend: f64, rest: &str) -> String {
    format!(
        "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = {stretch:e}, bending_stiffness = {bend:e}, mass_per_length = 1 }}\n\
         support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
         probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]\n{rest}\n"
    )
}

fn scene(text: &str) -> Scene {
    parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn run(scene: &Scene) -> Results {
    accuracy::run(scene, Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// As the scene is written, with its error.
fn estimate(scene: &Scene) -> Results {
    accuracy::estimate(scene.model(), scene.analysis(), Options::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn error(results: &Results) -> &ErrorEstimate {
    results.run().error.as_ref().expect("an estimate")
}

/// The last sample of the first probe.
fn last(results: &Results) -> ProbeSample {
    *results.states().probes[0].samples.last().expect("a record")
}
