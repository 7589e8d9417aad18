//! Lift is weight of the fluid: it follows the same gravity.

/// A rod that weighs what it displaces stays where it is, whatever gravity does.
#[test]
fn what_floats_stays_under_any_gravity() {
    let laws = [
        "",
        "in_time = { step = { start = 0.13 } }",
        "in_time = { harmonic = { frequency = 3.0, phase = 0.4 } }",
        "in_time = { polynomial = [0.0, 2.0, -1.0] }",
        "in_time = { table = { times = [0.0, 0.2, 0.4], values = [0.0, 1.0, -1.0] } }",
    ];
    for law in laws {
        let text = format!(
            r#"
            beam.rod = {{ start = [0, 0], end = [0.8, 0.6], axial_stiffness = 1e3, bending_stiffness = 1.0, mass_per_length = 0.7, basis.ancf.elements = 3 }}
            analysis.dynamic = {{ duration = 0.4, output_every = 0.1 }}
            probe = [{{ name = "end", beam = "rod", at = "end" }}]
            [effect.gravity]
            acceleration = [1.0, -9.81]
            {law}
            [[effect.buoyancy]]
            beam = "rod"
            displaced_mass_per_length = 0.7
            "#
        );
        let scene = ancf::scene::parse("rod.toml", &text).expect("a legal scene");
        let motion = scene.model().solve(scene.analysis()).expect("a motion");
        for sample in &motion.states().probes[0].samples {
            let moved = (sample.x - 0.8).hypot(sample.y - 0.6);
            assert!(moved < 1e-12, "{law}: {moved:e} m at {sample:?}");
        }
    }
}
