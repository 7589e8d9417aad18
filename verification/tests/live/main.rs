//! The solver beside other codes that run in this process, on the same scenes, meshes, Gauss points and steps.
//!
//! Every test needs the bridge to Python. Where it cannot be had the tests fail; nothing is skipped.

mod exudyn_dynamics;
mod exudyn_frequencies;
mod exudyn_statics;
mod frozen;

use ancf::run::{Control, run};
use ancf::scene::Scene;
use ancf::trajectory::Trajectory;
use ancf_check::case::Peer;
use ancf_verification::peers::{Answer, ask};

/// The scene under some overrides by both: ours and Exudyn's.
fn both(text: &str) -> (Trajectory, Answer) {
    let scene = ancf::scene::parse("live.toml", text).unwrap_or_else(|e| panic!("{e}"));
    (ours(&scene), ask(Peer::Exudyn, &scene).unwrap_or_else(|e| panic!("{e}")))
}

fn ours(scene: &Scene) -> Trajectory {
    run(scene.model(), scene.analysis(), &mut |_| Control::Continue).unwrap_or_else(|e| panic!("{e}"))
}

/// Where our only probe and Exudyn's are, record by record: (parameter, ours, theirs).
fn tips(ours: &Trajectory, theirs: &Answer) -> Vec<(f64, [f64; 2], [f64; 2])> {
    let (a, b) = (&ours.probes[0].samples, &theirs.probes[0]);
    assert_eq!(ours.parameter.len(), theirs.parameter.len(), "{:?}", theirs.parameter);
    let places = a.iter().zip(b.x.iter().zip(&b.y));
    ours.parameter.iter().zip(places).map(|(t, (p, (x, y)))| (*t, [p.x, p.y], [*x, *y])).collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
