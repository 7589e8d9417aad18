//! Pendulums that fall: the same elements, method and step, so the same motion.

use crate::{both, distance, tips};

/// The pendulum of Chen, Zhang & Li 2018, Section 4.2.
fn pendulum(modulus: f64, elements: usize, step: f64, radius: f64) -> String {
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
generalized_alpha = {{ step = {step:?}, spectral_radius = {radius:?} }}
"#
    )
}

#[test]
fn exudyn_moves_the_pendulums() {
    for (name, modulus) in [("soft", 68.95e6), ("stiff", 68.95e9)] {
        for radius in [1.0, 0.8] {
            for step in [2e-3, 1e-3, 0.5e-3] {
                let (ours, theirs) = both(&pendulum(modulus, 8, step, radius));
                let apart: Vec<f64> = tips(&ours, &theirs).iter().map(|(_, a, b)| distance(*a, *b)).collect();
                println!("{name} rho {radius} h {step}: {apart:?} {:?}", ours.statistics);
                let e = (ours.energy.last().unwrap(), theirs.energy.last().unwrap());
                println!("   {e:?}");
            }
        }
    }
}
