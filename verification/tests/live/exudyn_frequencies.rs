//! Small vibrations: Exudyn's mass and stiffness matrices have our frequencies.

use ancf_check::case::Peer;

use crate::both;

fn beam(fix: &str) -> String {
    format!(
        r#"
[beam.arm]
start = [0.0, 0.0]
end = [1.8, 0.0]
youngs_modulus = 68.95e9
area = 2.5e-4
second_moment = 0.130e-8
density = 2766.67
strain = "engineering"
basis.ancf = {{ elements = 10, gauss_points = {{ stretch = 5, bend = 3 }} }}

[[support]]
beam = "arm"
at = "start"
fix = [{fix}]

[analysis.modal]
count = 6
"#
    )
}

#[test]
fn exudyn_has_the_same_frequencies() {
    for fix in [r#""x", "y", "angle""#, r#""x", "y""#] {
        let (ours, theirs) = both(Peer::Exudyn, &beam(fix));
        println!("{:?}\n{:?}", ours.eigenvalues(), theirs.frequencies);
        assert_eq!((ours.eigenvalues().len(), theirs.frequencies.len()), (6, 6));
        for (a, b) in ours.eigenvalues().iter().zip(&theirs.frequencies) {
            // The rotation about the pin has 0 Hz; what round-off of a stiffness of 1e9 makes of it
            // is far below 1e-2 Hz.
            let allowed = if *a == 0.0 { 1e-2 } else { 1e-7 * a };
            assert!((a - b).abs() <= allowed, "{fix}: ours {a} Hz, Exudyn {b} Hz");
        }
    }
}
