//! Twenty random cantilevers: the same elements by Exudyn agree to the accuracy of Newton's method,
//! and RPIM with half as many cells to that of the elements.

use ancf_check::case::Peer;

use crate::{both, distance, ours};

/// Scenes of the sample.
const SAMPLE: u32 = 20;

/// Numbers of a low-discrepancy sequence in [−1, 1), the same in every run (Roberts' generalised
/// golden ratios).
struct Numbers {
    index: u32,
    dimension: i32,
}

impl Numbers {
    fn next(&mut self) -> f64 {
        // The root of x^13 = x + 1 for twelve numbers a scene; more come from its further powers.
        const ROOT: f64 = 1.056_304_897_279_664;
        self.dimension += 1;
        2.0 * (0.5 + f64::from(self.index) / ROOT.powi(self.dimension)).fract() - 1.0
    }
}

/// Arc lengths of `cells` cells between 0.7 and 1.3 of the average width, the same beam's for any
/// number of cells.
fn nodes(length: f64, cells: u32, strength: f64) -> String {
    let place = |x: f64| length * (x + strength * (std::f64::consts::TAU * x).sin() / std::f64::consts::TAU);
    let s: Vec<String> = (0..=cells)
        .map(|i| if i == cells { length } else { place(f64::from(i) / f64::from(cells)) })
        .map(|s| format!("{s:?}"))
        .collect();
    format!("[{}]", s.join(", "))
}

#[test]
fn exudyn_and_both_discretisations_agree_on_random_scenes() {
    let (mut worst_same, mut worst_rpim) = (0.0_f64, 0.0_f64);
    for index in 1..=SAMPLE {
        let mut numbers = Numbers { index, dimension: 0 };
        let mut next = || numbers.next();
        let length = 10.0_f64.powf(next());
        let bending = 10.0_f64.powf(3.0 * next());
        let axial = 10.0_f64.powf(4.5 + 1.5 * next()) * bending / length.powi(2);
        let (x, y) = (3.0 * next()).sin_cos();
        let (x, y) = (length * x, length * y);
        let size = x.hypot(y);
        let strength = 0.3 * next();
        let unit = bending / length.powi(2);
        let (fx, fy, follower) = (2.0 * unit * next(), 2.0 * unit * next(), next() > 0.0);
        let moment = 2.0 * bending / length * next();
        let scene = |basis: &str| {
            format!(
                "[beam.arm]\nstart = [0, 0]\nend = [{x:?}, {y:?}]\nstrain = \"engineering\"\n\
                 axial_stiffness = {axial:?}\nbending_stiffness = {bending:?}\nbasis = {basis}\n\
                 [[support]]\nbeam = \"arm\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n\
                 [[effect.force]]\nbeam = \"arm\"\nat = \"end\"\nvalue = [{fx:?}, {fy:?}]\nfollower = {follower}\n\
                 [[effect.moment]]\nbeam = \"arm\"\nat = \"end\"\nvalue = {moment:?}\n\
                 [[probe]]\nname = \"tip\"\nbeam = \"arm\"\nat = \"end\"\n\
                 [analysis.static]\ntolerance = 1e-12\n"
            )
        };
        let ancf = scene(&format!(
            "{{ ancf = {{ nodes = {}, gauss_points = {{ stretch = 4, bend = 2 }} }} }}",
            nodes(size, 40, strength)
        ));
        let rpim = scene(&format!("{{ rpim = {{ nodes = {} }} }}", nodes(size, 20, strength)));
        let (mine, theirs) = both(Peer::Exudyn, &ancf);
        let tip = |t: &ancf::results::Results| {
            t.states().probes[0].samples.last().map(|p| [p.x, p.y]).expect("an equilibrium")
        };
        let other =
            [theirs.probes[0].x.last(), theirs.probes[0].y.last()].map(|v| *v.expect("an equilibrium"));
        let same = distance(tip(&mine), other) / size;
        let meshfree = distance(tip(&ours(&rpim)), other) / size;
        assert!(same < 1e-8, "scene {index}: {same:.1e} L apart\n{ancf}");
        // What 40 cubic elements err by under such loads: 4e-7 L at most in this sample.
        assert!(meshfree < 3e-6, "scene {index}: {meshfree:.1e} L apart\n{rpim}");
        (worst_same, worst_rpim) = (worst_same.max(same), worst_rpim.max(meshfree));
    }
    println!("{SAMPLE} random scenes: same elements {worst_same:.1e} L apart, RPIM {worst_rpim:.1e} L");
}
