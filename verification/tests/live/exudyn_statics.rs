//! Equilibria of a cantilever: the same elements, so the same tips to the accuracy of Newton's
//! method.

use ancf_check::case::Peer;

use crate::{both, distance};

/// A cantilever of length 1 m along some direction, with one load at its end.
fn cantilever(along: [f64; 2], elements: usize, points: [usize; 2], clamp: &str, load: &str) -> String {
    let (x, y, [stretch, bend]) = (0.3 + along[0], -0.2 + along[1], points);
    format!(
        r#"
[beam.arm]
start = [0.3, -0.2]
end = [{x:?}, {y:?}]
axial_stiffness = 1e4
bending_stiffness = 2.0
mass_per_length = 0.5
strain = "engineering"
basis.ancf = {{ elements = {elements}, gauss_points = {{ stretch = {stretch}, bend = {bend} }} }}

[[support]]
beam = "arm"
at = "start"
fix = ["x", "y", "{clamp}"]

[[probe]]
name = "tip"
beam = "arm"
at = "end"

{load}

[analysis.static]
"#
    )
}

/// Tips and energies agree to 1e-8 of the length and of the energy.
fn agree(name: &str, text: &str) {
    let (ours, theirs) = both(Peer::Exudyn, text);
    let (tip, other) = (ours.states().probes[0].samples.last().unwrap(), &theirs.probes[0]);
    let (a, b) = ([tip.x, tip.y], [*other.x.last().unwrap(), *other.y.last().unwrap()]);
    let (mine, its) = (ours.states().energy.last().unwrap(), theirs.energy.last().unwrap());
    println!("{name}: tip {a:?}, apart {:.1e}; energy apart {:.1e}", distance(a, b), mine.bend - its.bend);
    assert!(distance(a, b) < 1e-8, "{name}: ours {a:?}, Exudyn {b:?}");
    for (a, [x, y, ..]) in ours.states().last[0].nodes.iter().zip(&theirs.nodes[0]) {
        assert!(distance(*a, [*x, *y]) < 1e-8, "{name}: a node, ours {a:?}, Exudyn [{x}, {y}]");
    }
    let energy = mine.bend + mine.stretch;
    assert!((mine.bend - its.bend).abs() < 1e-8 * energy, "{name}: {mine:?} {its:?}");
    assert!((mine.stretch - its.stretch).abs() < 1e-8 * energy, "{name}: {mine:?} {its:?}");
}

fn moment(value: f64) -> String {
    format!("[[effect.moment]]\nbeam = \"arm\"\nat = \"end\"\nvalue = {value:?}")
}

fn force(value: [f64; 2], follower: bool) -> String {
    format!("[[effect.force]]\nbeam = \"arm\"\nat = \"end\"\nvalue = {value:?}\nfollower = {follower}")
}

#[test]
fn exudyn_rolls_the_beam_up_to_the_same_tip() {
    let full = moment(std::f64::consts::TAU * 2.0);
    for (elements, points) in [(4, [5, 3]), (7, [5, 3]), (12, [5, 3]), (8, [4, 2])] {
        agree(
            &format!("roll-up, {elements} elements, {points:?}"),
            &cantilever([1.0, 0.0], elements, points, "angle", &full),
        );
    }
}

#[test]
fn exudyn_bends_under_dead_loads_to_the_same_tip() {
    for points in [[5, 3], [4, 2]] {
        agree("dead load", &cantilever([1.0, 0.0], 10, points, "angle", &force([0.0, -10.0], false)));
        agree(
            "whole gradient held",
            &cantilever([1.0, 0.0], 10, points, "gradient", &force([3.0, -10.0], false)),
        );
    }
    agree("inclined", &cantilever([0.6, 0.8], 10, [5, 3], "angle", &force([0.0, -10.0], false)));
    let weight = "[effect.gravity]\nacceleration = [1.0, -9.81]";
    agree("weight", &cantilever([1.0, 0.0], 10, [5, 3], "angle", weight));
}

#[test]
fn exudyn_follows_a_turning_load_to_the_same_tip() {
    agree("follower", &cantilever([1.0, 0.0], 10, [5, 3], "angle", &force([0.0, 20.0], true)));
    agree("follower, inclined", &cantilever([0.6, 0.8], 10, [5, 3], "angle", &force([-8.0, 6.0], true)));
}
