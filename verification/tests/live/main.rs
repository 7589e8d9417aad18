//! The solver beside other codes that run in this process, on the same scenes, meshes, Gauss points
//! and steps.
//!
//! Every test needs the bridge to Python. Where it cannot be had the tests fail; nothing is
//! skipped.

mod exudyn_dynamics;
mod exudyn_frequencies;
mod exudyn_random;
mod exudyn_statics;
mod frozen;
mod scikit_fem;
mod vtu;
mod work;

use ancf::results::Results;
use ancf_check::case::Peer;
use ancf_verification::peers::{Answer, ask};

/// A scene by both: ours and the peer.
fn both(peer: Peer, text: &str) -> (Results, Answer) {
    let scene = ancf::scene::parse("live.toml", text).unwrap_or_else(|e| panic!("{e}"));
    (ours(text), ask(peer, &scene).unwrap_or_else(|e| panic!("{e}")))
}

fn ours(text: &str) -> Results {
    let scene = ancf::scene::parse("live.toml", text).unwrap_or_else(|e| panic!("{e}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|e| panic!("{e}"))
}

/// Where our only probe and theirs are, record by record: (parameter, ours, theirs).
fn tips(ours: &Results, theirs: &Answer) -> Vec<(f64, [f64; 2], [f64; 2])> {
    let ours = ours.states();
    let (a, b) = (&ours.probes[0].samples, &theirs.probes[0]);
    assert_eq!(ours.parameter.len(), theirs.parameter.len(), "{:?}", theirs.parameter);
    let places = a.iter().zip(b.x.iter().zip(&b.y));
    ours.parameter.iter().zip(places).map(|(t, (p, (x, y)))| (*t, [p.x, p.y], [*x, *y])).collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
