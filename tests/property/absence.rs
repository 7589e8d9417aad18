//! What a scene does not name is not there: no object, table, matrix or iteration of it.

use ancf::assembly::Kind;
use ancf::run::inspect;
use ancf::scene::{Scene, parse};
use ancf::system::Inventory;
use std::collections::BTreeMap;

const BEAM: &str = r#"
[beam.arm]
start = [0.0, 0.0]
end = [1.0, 0.0]
axial_stiffness = 1e4
mass_per_length = 0.5
basis.ancf.elements = 4
basis.ancf.gauss_points = { stretch = 5, bend = 3 }
[[support]]
beam = "arm"
at = "start"
fix = ["x", "y", "angle"]
[[probe]]
name = "tip"
beam = "arm"
at = "end"
"#;

/// Everything a scene can name beside the beam, each with the kinds that it brings.
fn blocks() -> Vec<(&'static str, Vec<Kind>)> {
    vec![
        ("[beam.arm]\nbending_stiffness = 2.0", vec![Kind::Bend]),
        ("[effect.gravity]\nacceleration = [0.0, -9.81]", vec![Kind::Gravity]),
        ("[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, 1.0]", vec![Kind::Force]),
        ("[[effect.moment]]\nbeam = 'arm'\nat = 'end'\nvalue = 0.1", vec![Kind::Moment]),
        ("[[effect.distributed_force]]\nbeam = 'arm'\nvalue = [0.0, 1.0]", vec![Kind::DistributedForce]),
        ("[[effect.damping]]\nbeam = 'arm'\nmass_proportional = 1.0\nstrain = 1e-3", vec![Kind::Damping]),
        ("[[effect.spring]]\nbeam = 'arm'\nat = 'end'\nstiffness = 1.0", vec![Kind::Spring]),
        ("[[effect.spring]]\nbeam = 'arm'\nat = 'end'\ndamping = 1.0", vec![Kind::Dashpot]),
        ("[[effect.torsion_spring]]\nbeam = 'arm'\nat = 'end'\nstiffness = 1.0", vec![Kind::TorsionSpring]),
        ("[[effect.torsion_spring]]\nbeam = 'arm'\nat = 'end'\ndamping = 1.0", vec![Kind::TorsionDashpot]),
        ("[[effect.point_mass]]\nbeam = 'arm'\nat = 'end'\nmass = 1.0", vec![Kind::PointMass]),
        ("[[effect.rotary_inertia]]\nbeam = 'arm'\nper_length = 1e-3", vec![Kind::RotaryInertia]),
        ("[[effect.foundation]]\nbeam = 'arm'\nstiffness = [0.0, 1.0]", vec![Kind::Foundation]),
        ("[[effect.actuation]]\nbeam = 'arm'\nstrain = 1e-3", vec![Kind::PreStrain]),
        ("[[effect.tendon]]\nbeam = 'arm'\noffset = 0.0\ntension = 1.0", vec![Kind::Tendon]),
        ("[[effect.drag]]\nbeam = 'arm'\nnormal = 1.0", vec![Kind::Drag]),
        (
            "[[effect.electrostatic]]\nbeam = 'arm'\nvoltage = 1\nwidth = 1\nelectrode = { point = [0, -1], normal = [0, 1] }",
            vec![Kind::Electrostatic],
        ),
        ("[[effect.force_field]]\nbeam = 'arm'\npotential = '0.5*y^2'", vec![Kind::ForceField]),
        ("[[effect.moving_force]]\nbeam = 'arm'\nvalue = [0.0, 1.0]\nspeed = 2.0", vec![Kind::MovingForce]),
        (
            "[[effect.contact]]\nbeam = 'arm'\nstiffness = 1e3\ncircle = { center = [0.5, -1.0], radius = 0.5 }\n\
             friction = { coefficient = 0.2 }",
            vec![Kind::Contact, Kind::Friction],
        ),
    ]
}

fn scene(blocks: &[&str], analysis: &str) -> Scene {
    let (mut text, mut rest) = (BEAM.to_owned(), String::new());
    for block in blocks {
        match block.strip_prefix("[beam.arm]\n") {
            Some(key) => text = text.replacen("[beam.arm]\n", &format!("[beam.arm]\n{key}\n"), 1),
            None => rest.push_str(&format!("{block}\n")),
        }
    }
    text.push_str(&rest);
    text.push_str(analysis);
    parse("arm.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const MOTION: &str =
    "[analysis.dynamic]\nduration = 0.02\noutput_every = 0.01\ngauss = { stages = 2, step = 1e-3 }\n";

fn inventory(scene: &Scene) -> Inventory {
    inspect(scene.model(), scene.analysis()).expect("a legal scene")
}

/// Bytes by kind.
fn bytes(inventory: &Inventory) -> BTreeMap<Kind, usize> {
    inventory.effects.iter().map(|effect| (effect.kind, effect.bytes)).collect()
}

#[test]
fn an_effect_is_there_when_it_is_named_and_only_then() {
    let blocks = blocks();
    let all: Vec<&str> = blocks.iter().map(|(block, _)| *block).collect();
    let full = bytes(&inventory(&scene(&all, MOTION)));
    for (i, (block, kinds)) in blocks.iter().enumerate() {
        let alone = inventory(&scene(&[block], MOTION));
        let there: Vec<Kind> = bytes(&alone).into_keys().collect();
        let mut expected = vec![Kind::Stretch, Kind::Inertia];
        expected.extend(kinds);
        expected.sort();
        assert_eq!(there, expected, "{block}");
        assert!(kinds.iter().all(|kind| !alone.absent.contains(kind)), "{block}");

        let mut others = all.clone();
        others.remove(i);
        let without = bytes(&inventory(&scene(&others, MOTION)));
        let mut left = full.clone();
        left.retain(|kind, _| !kinds.contains(kind));
        if kinds.contains(&Kind::PointMass) {
            // Its weight is part of gravity.
            left.insert(Kind::Gravity, without[&Kind::Gravity]);
        }
        assert_eq!(without, left, "without {block}");
    }
}

#[test]
fn a_beam_stretches_or_keeps_its_length() {
    let text = BEAM.replace("axial_stiffness = 1e4\n", "");
    let rigid = parse("arm.toml", &format!("{text}[analysis.static]\n")).expect("a scene");
    let there = |inventory: &Inventory| bytes(inventory).into_keys().collect::<Vec<_>>();
    assert_eq!(there(&inventory(&rigid)), [Kind::Inextensibility]);
    let elastic = inventory(&scene(&[], "[analysis.static]\n"));
    assert_eq!((there(&elastic), elastic.multipliers), (vec![Kind::Stretch], 0));
}

#[test]
fn stretch_and_bending_are_coupled_where_layers_differ() {
    let layer = |modulus: f64| format!("{{ youngs_modulus = {modulus}, width = 1, height = 0.1 }}");
    let beam = |layers: [f64; 2]| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], basis.ancf.elements = 4, section.layers = [{}] }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.static = {{}}\n",
            layers.map(layer).join(", ")
        );
        bytes(&inventory(&parse("arm.toml", &text).expect("a scene"))).into_keys().collect::<Vec<_>>()
    };
    assert_eq!(beam([1.0, 2.0]), [Kind::Stretch, Kind::Bend, Kind::Coupling]);
    assert_eq!(beam([1.5, 1.5]), [Kind::Stretch, Kind::Bend]);
}

#[test]
fn every_kind_is_tested_here() {
    let tested: Vec<Kind> = blocks().into_iter().flat_map(|(_, kinds)| kinds).collect();
    // What comes with every beam, with another block, or needs a companion.
    let others = [
        Kind::Stretch,
        Kind::Inextensibility,
        Kind::Coupling,
        Kind::Inertia,
        Kind::PreCurvature,
        Kind::Buoyancy,
    ];
    for kind in Kind::ALL {
        assert!(tested.contains(kind) || others.contains(kind), "{}", kind.name());
    }
}

#[test]
fn statics_has_no_mass_and_an_undamped_motion_no_damping() {
    // A force that moves needs time.
    let timeless = |(_, kinds): &(&str, Vec<Kind>)| !kinds.contains(&Kind::MovingForce);
    let all: Vec<&str> = blocks().into_iter().filter(timeless).map(|(block, _)| block).collect();
    let statics = inventory(&scene(&all, "[analysis.static]\n"));
    assert_eq!((statics.mass_bytes, statics.damping_bytes), (0, 0));
    let moving =
        [Kind::Inertia, Kind::PointMass, Kind::RotaryInertia, Kind::Damping, Kind::Dashpot, Kind::Drag];
    for kind in moving {
        assert!(statics.absent.contains(&kind), "{} in statics", kind.name());
    }
    let undamped = inventory(&scene(&all[..2], MOTION));
    assert!(undamped.mass_bytes > 0);
    assert_eq!(undamped.damping_bytes, 0);
    assert!(inventory(&scene(&all, MOTION)).damping_bytes > 0);
}

#[test]
fn small_vibrations_need_no_iteration() {
    let scene = scene(&["[beam.arm]\nbending_stiffness = 2.0"], "[analysis.modal]\ncount = 3\n");
    let trajectory = scene.model().solve(scene.analysis()).expect("three vibrations");
    assert_eq!(trajectory.eigenvalues().len(), 3);
    assert_eq!(
        (trajectory.run().statistics.newton_iterations, trajectory.run().statistics.residual_evaluations),
        (0, 0)
    );
}

#[test]
fn every_beam_has_its_own_effects() {
    let two = format!(
        "{BEAM}\n[beam.other]\nstart = [0.0, 1.0]\nend = [1.0, 1.0]\naxial_stiffness = 1e4\nmass_per_length = 0.5\nbasis.ancf.elements = 2\n[effect.gravity]\nacceleration = [0.0, -9.81]\n{MOTION}"
    );
    let two = parse("two.toml", &two).unwrap_or_else(|error| panic!("{error}"));
    let inventory = inventory(&two);
    for (beam, points) in [("arm", 20), ("other", 10)] {
        for kind in [Kind::Stretch, Kind::Inertia, Kind::Gravity] {
            let entry = inventory.effects.iter().find(|effect| effect.beam == beam && effect.kind == kind);
            assert_eq!(entry.map(|effect| effect.points), Some(points), "{} of {beam}", kind.name());
        }
    }
}
