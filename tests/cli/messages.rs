//! What people read when a scene is wrong, word for word.

use ancf::effect::Force;
use ancf::run::RunError;
use ancf::scene::{self, Scene};

const BASE: &str = r#"title = "Cantilever"

[beam.arm]
start = [0.0, 0.0]
end = ["1.8 m", 0.0]
youngs_modulus = "68.95 GPa"
area = "2.5 cm^2"
second_moment = "0.130 cm^4"

[beam.arm.basis.ancf]
elements = 3

[[support]]
beam = "arm"
at = "start"
fix = ["x", "y", "angle"]

[[effect.force]]
beam = "arm"
at = "end"
value = [0.0, "-5 N"]

[[probe]]
name = "tip"
beam = "arm"
at = "end"

[analysis.static]
"#;

/// Title, what stands in the legal scene, what is put in its place.
const CASES: &[(&str, &str, &str)] = &[
    ("syntax", "elements = 3", "elements = = 3"),
    ("duplicate key", "elements = 3", "elements = 3\nelements = 4"),
    ("unknown key", "area =", "aera ="),
    ("unknown key at the top", "[[probe]]", "[[prob]]"),
    ("unknown effect", "[[effect.force]]", "[[effect.contact]]"),
    ("an effect at the top", "[[effect.force]]", "[[force]]"),
    ("a key of a table within", "[beam.arm.basis.ancf]", "[beam.arm.basis]"),
    ("a symbol", "area =", "A ="),
    ("a beam without a name", "[beam.arm]", "[beam]"),
    ("a number for a table", "[[probe]]", "[[effect.contact]]\nfriction = 0.3\n[[probe]]"),
    ("components for a table", "[[probe]]", "[effect]\ngravity = [0.0, -9.81]\n[[probe]]"),
    ("unknown analysis", "[analysis.static]", "[analysis.statics]"),
    ("missing key", "at = \"start\"\n", ""),
    ("wrong accuracy", "[analysis.static]", "[analysis.static]\naccuracy = 2"),
    ("unknown accuracy", "[analysis.static]", "[analysis.static]\naccuracy = { positon = 1e-3 }"),
    ("no accuracy", "[analysis.static]", "[analysis.static]\naccuracy = true"),
    ("missing analysis", "[analysis.static]", ""),
    ("wrong type", "\"2.5 cm^2\"", "true"),
    ("wrong unit", "\"2.5 cm^2\"", "\"2.5 cm\""),
    ("unknown unit", "\"2.5 cm^2\"", "\"2.5 furlong\""),
    ("power without ^", "\"2.5 cm^2\"", "\"2.5 cm2\""),
    ("power without ^ in a quotient", "\"2.5 cm^2\"", "\"2.5 kg/m3\""),
    ("units run together", "\"-5 N\"", "\"-5 Nm\""),
    ("one bracket", "[[support]]", "[support]"),
    ("one bracket within a table", "[[effect.force]]", "[effect.force]"),
    ("one bracket about a probe", "[[probe]]", "[probe]"),
    ("two brackets about a beam", "[beam.arm]", "[[beam]]"),
    ("two brackets about a named beam", "[beam.arm]", "[[beam.arm]]"),
    ("values without keys", "[analysis.static]", "[analysis]\nstatic = [1e-9]"),
    (
        "values without keys in a list",
        "fix = [\"x\", \"y\", \"angle\"]",
        "fix = [\"x\", \"y\", \"angle\"]\nmove = [0.0, 0.0, 1.0]",
    ),
    ("two brackets about an analysis", "[analysis.static]", "[[analysis.static]]"),
    ("a word for a list", "fix = [\"x\", \"y\", \"angle\"]", "fix = \"x\""),
    ("a number for a list", "end = [\"1.8 m\", 0.0]", "points = 3"),
    ("ambiguous unit", "\"2.5 cm^2\"", "\"2.5 m^3/m s\""),
    ("no unit", "\"2.5 cm^2\"", "\"2.5\""),
    ("negative", "\"2.5 cm^2\"", "-2.5e-4"),
    ("not a number", "\"2.5 cm^2\"", "nan"),
    ("overflow", "\"2.5 cm^2\"", "1e400"),
    ("overflow in text", "\"2.5 cm^2\"", "\"1e400 m^2\""),
    ("product overflows", "\"2.5 cm^2\"", "1e300"),
    ("EA given twice", "area =", "axial_stiffness = 1e6\narea ="),
    ("EA missing", "area = \"2.5 cm^2\"\n", ""),
    ("velocity of nothing", "[[probe]]", "[[initial_velocity]]\nbeam = \"arm\"\n\n[[probe]]"),
    (
        "velocity without coefficients",
        "[[probe]]",
        "[[initial_velocity]]\nbeam = \"arm\"\npolynomial = {}\n[[probe]]",
    ),
    (
        "velocities without components",
        "[[probe]]",
        "[[initial_velocity]]\nbeam = \"arm\"\ntable = { s = [0, 1.8] }\n[[probe]]",
    ),
    (
        "velocities of a part of the beam",
        "[[probe]]",
        "[[initial_velocity]]\nbeam = \"arm\"\ntable = { s = [0, 1.2], vy = [0, 1] }\n[[probe]]",
    ),
    (
        "velocities at unsorted places",
        "[[probe]]",
        "[[initial_velocity]]\nbeam = \"arm\"\ntable = { s = [0, 1, 0.5, 1.8], vy = [0, 1, 2, 3] }\n[[probe]]",
    ),
    (
        "velocities too few",
        "[[probe]]",
        "[[initial_velocity]]\nbeam = \"arm\"\ntable = { s = [0, 1, 1.8], vy = [0, \"1 m/s\"] }\n[[probe]]",
    ),
    (
        "velocity of another dimension",
        "[[probe]]",
        "[[initial_velocity]]\nbeam = \"arm\"\ntable = { s = [0, 1.8], vy = [0, \"1 m\"] }\n[[probe]]",
    ),
    ("empty law", "value = [0.0, \"-5 N\"]", "value = [0.0, 1.0]\nin_time = {}"),
    (
        "two laws",
        "value = [0.0, \"-5 N\"]",
        "value = [0.0, 1.0]\nin_time = { step = { start = 1.0 }, polynomial = [1.0] }",
    ),
    (
        "law with falling times",
        "value = [0.0, \"-5 N\"]",
        "value = [0.0, 1.0]\nin_time = { table = { times = [1.0, 0.5], values = [0.0, 1.0] } }",
    ),
    (
        "law that moves nothing",
        "fix = [\"x\", \"y\", \"angle\"]",
        "fix = [\"x\", \"y\", \"angle\"]\nmove = { in_time = { step = { start = 1.0 } } }",
    ),
    (
        "two laws of a hub",
        "fix = [\"x\", \"y\", \"angle\"]",
        "fix = [\"x\", \"y\", \"angle\"]\nmove = { angle = 1.0, spin_up = { speed = 1.0, duration = 1.0 } }",
    ),
    ("damping without effect", "[[probe]]", "[[effect.damping]]\nbeam = \"arm\"\n[[probe]]"),
    (
        "spring of a length without anchor",
        "[[probe]]",
        "[[effect.spring]]\nbeam = \"arm\"\nat = \"end\"\nstiffness = 1.0\nlength = 1.0\n[[probe]]",
    ),
    ("contact with nothing", "[[probe]]", "[[effect.contact]]\nbeam = \"arm\"\nstiffness = 1.0\n[[probe]]"),
    (
        "buoyancy without gravity",
        "[[probe]]",
        "[[effect.buoyancy]]\nbeam = \"arm\"\ndisplaced_mass_per_length = 1.0\n[[probe]]",
    ),
    (
        "slider of two points",
        "[[probe]]",
        "[[joint]]\ntype = \"slider\"\nfirst = { beam = \"arm\", at = \"end\" }\nsecond = { beam = \"arm\", at = \"start\" }\n[[probe]]",
    ),
    (
        "hinge of one point",
        "[[probe]]",
        "[[joint]]\ntype = \"hinge\"\nfirst = { beam = \"arm\", at = \"end\" }\n[[probe]]",
    ),
    ("mass missing for gravity", "[[probe]]", "[effect.gravity]\nacceleration = [0.0, -9.81]\n[[probe]]"),
    ("three components", "[0.0, \"-5 N\"]", "[0.0, 1.0, 2.0]"),
    ("no length", "[\"1.8 m\", 0.0]", "[0.0, 0.0]"),
    ("two geometries", "start = [0.0, 0.0]", "start = [0.0, 0.0]\npoints = [[0.0, 0.0], [1.0, 0.0]]"),
    ("no end", "end = [\"1.8 m\", 0.0]\n", ""),
    ("cusp", "start = [0.0, 0.0]\nend = [\"1.8 m\", 0.0]", "points = [[0, 0], [1, 0], [0, 1e-9], [1, 0]]"),
    ("no elements", "elements = 3", "elements = 0"),
    ("fractional elements", "elements = 3", "elements = 3.5"),
    ("too many elements", "elements = 3", "elements = 1_000_000_000_000"),
    ("nodes out of order", "elements = 3", "nodes = [0.0, \"90 cm\", 0.5, 1.8]"),
    ("nodes do not reach the end", "elements = 3", "nodes = [0.0, 1.0]"),
    ("two bases", "elements = 3", "elements = 3\n[beam.arm.basis.rpim]\nnodes = 5"),
    (
        "kernel",
        "[beam.arm.basis.ancf]\nelements = 3",
        "[beam.arm.basis.rpim]\nnodes = 5\nkernel.multiquadric = { q = 1, shape = 3 }",
    ),
    ("unknown beam", "beam = \"arm\"\nat = \"end\"\nvalue", "beam = \"arn\"\nat = \"end\"\nvalue"),
    ("beyond the end", "at = \"end\"\nvalue", "at = \"2 m\"\nvalue"),
    ("nowhere", "at = \"start\"", "at = \"middle\""),
    ("unknown fix", "\"angle\"", "\"rotation\""),
    ("fix twice", "\"angle\"", "\"angle\", \"gradient\""),
    (
        "moves what is free",
        "\"angle\"]",
        "\"angle\"]\n[support.move]\nangle = \"90 deg\"\n[[support]]\nbeam = \"arm\"\nat = \"end\"\nfix = [\"y\"]\nmove = { x = 0.1 }",
    ),
    (
        "held twice",
        "[[effect.force]]",
        "[[support]]\nbeam = \"arm\"\nat = 0.0\nfix = [\"x\"]\n[[effect.force]]",
    ),
    ("free to turn", "\"angle\"]", "]"),
    ("free to slide", "[\"x\", \"y\", \"angle\"]", "[\"y\", \"angle\"]"),
    ("vibrations about nothing", "[analysis.static]", "[analysis.modal]\ncount = 3\nabout = \"equilbrium\""),
    ("two analyses", "[analysis.static]", "[analysis.static]\n[analysis.modal]\ncount = 3"),
    ("stages beside an analysis", "[[probe]]", "[[stage]]\nname = \"a\"\nanalysis.static = {}\n[[probe]]"),
    (
        "unknown stage",
        "[analysis.static]",
        "[[effect.moment]]\nbeam = \"arm\"\nat = 1\nvalue = 1\nuntil = \"drew\"\n[[stage]]\nname = \"draw\"\nanalysis.static = {}",
    ),
    ("a stage without stages", "value = [0.0, \"-5 N\"]", "value = [0.0, \"-5 N\"]\nstage = \"draw\""),
    (
        "gone before it comes",
        "[analysis.static]",
        "[[effect.moment]]\nbeam = \"arm\"\nat = 1\nvalue = 1\nstage = \"b\"\nuntil = \"b\"\n[[stage]]\nname = \"a\"\nanalysis.static = {}\n[[stage]]\nname = \"b\"\nanalysis.static = {}",
    ),
    (
        "two stages of one name",
        "[analysis.static]",
        "[[stage]]\nname = \"a\"\nanalysis.static = {}\n[[stage]]\nname = \"A\"\nanalysis.static = {}",
    ),
    ("a stage that names no folder", "[analysis.static]", "[[stage]]\nname = \"../a\"\nanalysis.static = {}"),
    (
        "vibrations not about the stage before",
        "[analysis.static]",
        "[[stage]]\nname = \"a\"\nanalysis.static = {}\n[[stage]]\nname = \"b\"\nanalysis.modal = { count = 1, about = \"reference\" }",
    ),
    (
        "a stage with an accuracy",
        "[analysis.static]",
        "[[stage]]\nname = \"a\"\nanalysis.static.accuracy = 1e-3",
    ),
    (
        "two probes of one name",
        "[analysis.static]",
        "[[probe]]\nname = \"tip\"\nbeam = \"arm\"\nat = 1\n[analysis.static]",
    ),
    ("endless path", "[analysis.static]", "[analysis.static]\narc_length = {}"),
    (
        "integrator",
        "[analysis.static]",
        "[analysis.dynamic]\nduration = 1\n[analysis.dynamic.gauss]\nstages = 4\nstep = 0.1",
    ),
    (
        "neither step nor tolerance",
        "[analysis.static]",
        "[analysis.dynamic]\nduration = 1\n[analysis.dynamic.radau]",
    ),
];

const OVERRIDES: &[&str] = &[
    "beam.arm.basis.ancf.elements=0",
    "beam.arm.basis.ancf.element=4",
    "beam.amr.area=3 cm^2",
    "effect.force.1.value=[0, 1]",
    "title.x=1",
    "beam.arm.area",
    "beam..arm=3",
    "beam.arm.basis.rpim.nodes=4",
    "beam.arm.end=[0, 0]",
    "support.0.fix=['x', 'y']",
];

/// The scene is legal before each change, each change is refused, and the message says so in these
/// words.
#[test]
fn scene_messages() {
    scene::parse("arm.toml", BASE).unwrap_or_else(|e| panic!("{e}"));
    let mut all = String::new();
    for (title, from, to) in CASES {
        assert!(BASE.contains(from), "{title}");
        let error = scene::parse("arm.toml", &BASE.replacen(from, to, 1)).expect_err(title);
        all.push_str(&format!("# {title}\n{error}\n\n"));
    }
    let error = scene::parse("arm.toml", "[analysis.static]").expect_err("no beam");
    all.push_str(&format!("# no beam\n{error}\n"));
    compare("scene_messages", &all);
}

#[test]
fn override_messages() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    std::fs::write(&path, BASE).unwrap();
    let mut all = String::new();
    for option in OVERRIDES {
        let error = Scene::load(&path, &[(*option).to_owned()]).expect_err(option);
        let text = error.to_string().replace(&path.display().to_string(), "arm.toml");
        all.push_str(&format!("# {option}\n{text}\n\n"));
    }
    compare("override_messages", &all);
}

/// A fault of the file keeps its own line where an override only moved it.
#[test]
fn overrides_do_not_move_the_blame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    std::fs::write(&path, BASE.replace("at = \"end\"\nvalue", "at = \"3 m\"\nvalue")).unwrap();
    for option in ["beam.arm.basis.ancf.elements=1000", "beam.arm.strain=green", "output.vtu=true", "title=x"]
    {
        let error = Scene::load(&path, &[option.to_owned()]).expect_err(option);
        assert_eq!(error.place().map(|(_, line, column)| (line, column)), Some((20, 6)), "{option}: {error}");
    }
}

/// An entry of a `[[list]]` is replaced as a whole, and never lost.
#[test]
fn overrides_replace_entries_of_lists() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    std::fs::write(&path, BASE).unwrap();
    let before = Scene::load(&path, &[]).expect("a legal scene");
    let option = "effect.force.0={ beam = 'arm', at = 'start', value = [0, 7] }".to_owned();
    let after = Scene::load(&path, &[option]).expect("a legal scene");
    assert_eq!(after.model().parts.len(), before.model().parts.len());
    let force: &dyn std::any::Any = after.model().parts[0].as_ref();
    assert_eq!(force.downcast_ref::<Force>().expect("a force").value, [0.0, 7.0]);
    let error = Scene::load(&path, &["effect.force.0=7".to_owned()]).expect_err("no table").to_string();
    assert!(error.contains("`effect.force.0` is a table, found a value of type integer"), "{error}");
}

#[test]
fn unreadable_files_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().join("absent.toml"), folder.path().to_owned()] {
        let error = Scene::load(&path, &[]).unwrap_err();
        assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
    }
    let path = folder.path().join("latin.toml");
    std::fs::write(&path, b"title = \"x\"\nname = \"\xe9\"").unwrap();
    let error = Scene::load(&path, &[]).unwrap_err().to_string();
    assert!(error.contains("latin.toml:2:9: the file is not UTF-8"), "{error}");
}

/// The committed schema is the one that the program prints.
#[test]
fn schema_snapshot_is_fresh() {
    let text = serde_json::to_string_pretty(&scene::schema()).unwrap();
    compare("scene_schema", &text);
}

fn compare(name: &str, text: &str) {
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, text);
    });
}

/// Nodes a micrometre apart: what the round-off of positions hides is not blamed on a limit point.
#[test]
fn nodes_that_nearly_coincide_are_named_where_no_equilibrium_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("near.toml");
    let text = BASE.replace("elements = 3", "nodes = [0.0, 0.6, 0.600001, 1.2, 1.8]");
    std::fs::write(&path, text).expect("a file");
    let scene = Scene::load(&path, &[]).expect("a legal scene");
    let found = scene.model().solve(scene.analysis());
    let Err(RunError::NoEquilibrium { advice, .. }) = found else { panic!("forces cannot balance here") };
    assert!(advice.contains("nodes are so close"), "{advice}");
}
