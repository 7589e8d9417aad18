//! The linear beam of scikit-fem, which ours becomes as deflections become small.

use ancf_check::case::Peer;

use crate::{both, tips};

/// A clamped beam of unit length with a small force at its end: PL³/3EI = 1e-5 L.
fn beam(fix: &str, analysis: &str) -> String {
    format!(
        r#"
[beam.arm]
start = [0.0, 0.0]
end = [1.0, 0.0]
axial_stiffness = 1e4
bending_stiffness = 2.0
mass_per_length = 0.5
strain = "engineering"
basis.ancf = {{ elements = 6, gauss_points = {{ stretch = 5, bend = 3 }} }}

[[support]]
beam = "arm"
at = "start"
fix = [{fix}]

[[effect.force]]
beam = "arm"
at = "end"
value = [0.0, 6e-5]

[[probe]]
name = "tip"
beam = "arm"
at = "end"

{analysis}
"#
    )
}

const CLAMP: &str = r#""x", "y", "angle""#;

#[test]
fn scikit_fem_deflects_the_clamped_beam_alike() {
    let (ours, theirs) = both(Peer::ScikitFem, &beam(CLAMP, "[analysis.static]"));
    let (a, b) = (ours.states().probes[0].samples.last().unwrap().y, theirs.probes[0].y[0]);
    println!("ours {a:e}, theirs {b:e}, 1e-5 is exact");
    assert!((b - 1e-5).abs() < 1e-12 * 1e-5, "one force: cubics are exact: {b}");
    // what is not linear is of the order (w/L)² = 1e-10 of the deflection
    assert!((a - b).abs() < 1e-9 * b, "{a} {b}");
}

#[test]
fn scikit_fem_has_the_same_frequencies() {
    // the motions along the beam, which the linear one does not know, come later: the first has
    // √(EA/ρA)/4L = 35 Hz
    for fix in [CLAMP, r#""x", "y""#] {
        let (ours, theirs) = both(Peer::ScikitFem, &beam(fix, "[analysis.modal]\ncount = 3"));
        println!("{:?} {:?}", ours.eigenvalues(), theirs.frequencies);
        for (a, b) in ours.eigenvalues().iter().zip(&theirs.frequencies) {
            let allowed = if *a == 0.0 { 1e-4 } else { 1e-7 * a };
            assert!((a - b).abs() <= allowed, "ours {a} Hz, scikit-fem {b} Hz");
        }
    }
}

#[test]
fn scikit_fem_swings_alike_where_deflections_are_small() {
    let analysis = "[analysis.dynamic]\nduration = 0.5\noutput_every = 0.01\ngeneralized_alpha = { step = 1e-3, spectral_radius = 1.0 }";
    let (ours, theirs) = both(Peer::ScikitFem, &beam(CLAMP, analysis));
    let apart = tips(&ours, &theirs).iter().map(|(_, a, b)| (a[1] - b[1]).abs()).fold(0.0, f64::max);
    let height = theirs.probes[0].y.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
    println!("apart {apart:.1e} of {height:.3e}");
    assert!(apart < 1e-6 * height, "{apart} of {height}");
}
