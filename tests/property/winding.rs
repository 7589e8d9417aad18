//! A torsion spring knows no more than half a turn, and a run that winds it further says so.

use ancf::run::{Control, run};

fn warnings(turns: f64) -> Vec<String> {
    let moment = 2.0 * std::f64::consts::TAU * turns;
    let text = format!(
        r#"
        beam.coil = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 2.0, basis.ancf.elements = 24 }}
        analysis.static = {{}}
        support = [{{ beam = "coil", at = "start", fix = ["x", "y", "angle"] }}]
        probe = [{{ name = "end", beam = "coil", at = "end" }}]
        effect.moment = [{{ beam = "coil", at = "end", value = {moment} }}]
        effect.torsion_spring = [{{ beam = "coil", at = 0.9, stiffness = 1e-6 }}]
        "#
    );
    let scene = ancf::scene::parse("coil.toml", &text).expect("a legal scene");
    run(scene.model(), scene.analysis(), &mut |_| Control::Continue).expect("an equilibrium").warnings
}

#[test]
fn a_spring_beyond_half_a_turn_is_named() {
    let said =
        |turns: f64| warnings(turns).iter().filter(|text| text.contains("torsion spring at s = 0.9")).count();
    assert_eq!([0.3, -0.5].map(said), [0, 0]);
    assert_eq!([0.6, -0.6, 1.0, 2.0].map(said), [1, 1, 1, 1]);
}
