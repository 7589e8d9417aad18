//! Whatever is done to the text of a legal scene, reading it never panics, and every refusal names
//! a place.

use ancf::model::{Analysis, Discretization, Integrator, Nodes, StepControl};
use ancf::scene::{self, Scene, SceneError};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::path::{Path, PathBuf};

const SCENES: [(&str, &str); 6] = [
    ("modal", include_str!("../scenes/modal.toml")),
    ("roll-up-ancf", include_str!("../scenes/roll-up-ancf.toml")),
    ("roll-up-rpim", include_str!("../scenes/roll-up-rpim.toml")),
    ("soft-pendulum-accurate", include_str!("../scenes/soft-pendulum-accurate.toml")),
    ("soft-pendulum", include_str!("../scenes/soft-pendulum.toml")),
    ("tip-load", include_str!("../scenes/tip-load.toml")),
];

/// Values that are out of range, of a wrong type, or no TOML at all.
const VALUES: [&str; 34] = [
    "nan",
    "-nan",
    "inf",
    "-1",
    "0",
    "0.0",
    "-0.0",
    "1e400",
    "-1e308",
    "5e-324",
    "9223372036854775807",
    "9223372036854775808",
    "99999999999999999999999999999999999999999",
    "1000000000000",
    "true",
    "\"\"",
    "\"x\"",
    "\"1.8\"",
    "\"3 kg\"",
    "\"-1 m\"",
    "\"1e400 m\"",
    "\"nan m\"",
    "\"1 m^99\"",
    "\"1 m/\"",
    "[]",
    "[0.0]",
    "[0.0, 0.0, 0.0]",
    "[nan, 1]",
    "{}",
    "{ x = 1 }",
    "1979-05-27",
    "[[[[]]]]",
    "\"\\u0000\"",
    "'µ°²'",
];

const KEYS: [&str; 24] = [
    "beam",
    "start",
    "end",
    "arc",
    "points",
    "area",
    "density",
    "axial_stiffness",
    "basis",
    "ancf",
    "rpim",
    "nodes",
    "elements",
    "spacing",
    "kernel",
    "gauss_points",
    "at",
    "fix",
    "move",
    "value",
    "static",
    "dynamic",
    "bogus",
    "",
];

/// One change to a text.
#[derive(Clone, Debug)]
enum Mutation {
    Delete(Index, usize),
    Duplicate(Index, usize),
    Replace(Index, char),
    DropLine(Index),
    RepeatLine(Index),
    SwapLines(Index, Index),
    SetValue(Index, &'static str),
    RenameKey(Index, &'static str),
    AddKey(Index, &'static str, &'static str),
    Splice(Index, usize, Index),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let at = || any::<Index>();
    prop_oneof![
        (at(), 1..20usize).prop_map(|(i, n)| Mutation::Delete(i, n)),
        (at(), 1..20usize).prop_map(|(i, n)| Mutation::Duplicate(i, n)),
        (at(), any::<char>()).prop_map(|(i, c)| Mutation::Replace(i, c)),
        (at(), select("\"'[]{}=.,#\n\\-+ 0e".chars().collect::<Vec<_>>()))
            .prop_map(|(i, c)| Mutation::Replace(i, c)),
        at().prop_map(Mutation::DropLine),
        at().prop_map(Mutation::RepeatLine),
        (at(), at()).prop_map(|(a, b)| Mutation::SwapLines(a, b)),
        (at(), select(&VALUES[..])).prop_map(|(i, v)| Mutation::SetValue(i, v)),
        (at(), select(&VALUES[..])).prop_map(|(i, v)| Mutation::SetValue(i, v)),
        (at(), select(&KEYS[..])).prop_map(|(i, k)| Mutation::RenameKey(i, k)),
        (at(), select(&KEYS[..]), select(&VALUES[..])).prop_map(|(i, k, v)| Mutation::AddKey(i, k, v)),
        (at(), 0..SCENES.len(), at()).prop_map(|(i, s, j)| Mutation::Splice(i, s, j)),
    ]
}

fn mutate(text: &str, mutation: &Mutation) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    if chars.is_empty() {
        return String::new();
    }
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    match mutation {
        Mutation::Delete(i, n) => {
            let start = i.index(chars.len());
            chars.drain(start..(start + n).min(chars.len()));
        }
        Mutation::Duplicate(i, n) => {
            let start = i.index(chars.len());
            let part: Vec<char> = chars.iter().skip(start).take(*n).copied().collect();
            chars.splice(start..start, part);
        }
        Mutation::Replace(i, c) => {
            let at = i.index(chars.len());
            chars[at] = *c;
        }
        Mutation::Splice(i, scene, j) => {
            let other: Vec<char> = SCENES[*scene].1.chars().collect();
            chars.truncate(i.index(chars.len()));
            chars.extend(other.iter().skip(j.index(other.len())));
        }
        _ if lines.is_empty() => {}
        Mutation::DropLine(i) => drop(lines.remove(i.index(lines.len()))),
        Mutation::RepeatLine(i) => {
            let at = i.index(lines.len());
            lines.insert(at, lines[at].clone());
        }
        Mutation::SwapLines(a, b) => {
            let n = lines.len();
            lines.swap(a.index(n), b.index(n));
        }
        Mutation::SetValue(i, value) => {
            let keyed: Vec<usize> = (0..lines.len()).filter(|&l| lines[l].contains('=')).collect();
            if let Some(&at) = keyed.get(i.index(keyed.len().max(1))) {
                let key = lines[at].split('=').next().unwrap_or_default().to_owned();
                lines[at] = format!("{key}= {value}");
            }
        }
        Mutation::RenameKey(i, name) => {
            let keyed: Vec<usize> = (0..lines.len()).filter(|&l| lines[l].contains('=')).collect();
            if let Some(&at) = keyed.get(i.index(keyed.len().max(1))) {
                let value = lines[at].split_once('=').map(|(_, v)| v.to_owned()).unwrap_or_default();
                lines[at] = format!("{name} ={value}");
            }
        }
        Mutation::AddKey(i, key, value) => lines.insert(i.index(lines.len()), format!("{key} = {value}")),
    }
    match mutation {
        Mutation::Delete(..) | Mutation::Duplicate(..) | Mutation::Replace(..) | Mutation::Splice(..) => {
            chars.into_iter().collect()
        }
        _ => lines.join("\n"),
    }
}

/// A refusal names file, line and column, and both lie within the text.
fn has_a_place(error: &SceneError, name: &str, text: &str) {
    let (file, line, column) = error.place().expect("text has places");
    assert_eq!(file, name);
    assert!(line >= 1 && line <= text.matches('\n').count() + 1, "{error}");
    assert!(
        column >= 1 && column <= text.split('\n').nth(line - 1).map_or(0, |l| l.chars().count()) + 1,
        "{error}"
    );
    assert!(error.to_string().starts_with(&format!("{file}:{line}:{column}: ")), "{error}");
}

proptest! {
    #![proptest_config(super::cases(2000))]

    #[test]
    fn mutated_scenes_never_panic(scene in 0..SCENES.len(), mutations in prop::collection::vec(mutation(), 1..5)) {
        let text = mutations.iter().fold(SCENES[scene].1.to_owned(), |text, m| mutate(&text, m));
        if let Err(error) = scene::parse("mutated.toml", &text) {
            has_a_place(&error, "mutated.toml", &text);
        }
    }

    #[test]
    fn arbitrary_text_never_panics(text in "\\PC{0,200}") {
        if let Err(error) = scene::parse("any.toml", &text) {
            has_a_place(&error, "any.toml", &text);
        }
    }

    #[test]
    fn overrides_never_panic(
        scene in 0..SCENES.len(),
        path in prop::collection::vec(prop_oneof![
            select(&KEYS[..]).prop_map(str::to_owned),
            select(vec!["cantilever", "arm", "effect", "analysis", "moment", "gauss", "0", "1", "-1", "support", "title"])
                .prop_map(str::to_owned),
            "\\PC{0,4}",
        ], 0..6),
        value in prop_oneof![select(&VALUES[..]).prop_map(str::to_owned), "\\PC{0,12}"],
    ) {
        let option = format!("{}={value}", path.join("."));
        // A refusal names the override or a place in the file; either way it is one message.
        if let Err(error) = Scene::load(&file(SCENES[scene].0), &[option]) {
            prop_assert!(error.place().is_some(), "{error}");
        }
    }
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(format!("{name}.toml"))
}

#[test]
fn example_scenes_are_legal() {
    for (name, text) in SCENES {
        if let Err(error) = scene::parse(name, text) {
            panic!("{error}");
        }
    }
}

#[test]
fn numbers_arrive_in_si() {
    let scene = scene::parse("roll-up", SCENES[1].1).unwrap();
    let beam = &scene.model().beams[0];
    let constant =
        |quantity: &Option<ancf::model::Along>| quantity.as_ref().and_then(ancf::model::Along::constant);
    let close = |a: Option<f64>, b: f64| (a.unwrap() / b - 1.0).abs() < 1e-15;
    assert!(close(constant(&beam.section.axial_stiffness), 68.95e9 * 2.5e-4), "{:?}", beam.section);
    assert!(close(constant(&beam.section.bending_stiffness), 68.95e9 * 0.130e-8), "{:?}", beam.section);
    assert!(close(constant(&beam.section.mass_per_length), 2766.67 * 2.5e-4), "{:?}", beam.section);
    assert_eq!(beam.discretization, Discretization::Ancf { nodes: Nodes::Uniform(4) });
}

#[test]
fn integrators_arrive() {
    for (name, integrator) in [
        (
            4,
            Integrator::GeneralizedAlpha {
                step: StepControl::Fixed(0.001),
                spectral_radius: 0.9,
                newton_tolerance: Integrator::NEWTON_TOLERANCE,
            },
        ),
        (3, Integrator::Gauss { stages: 3, step: StepControl::Tolerance(1e-5) }),
    ] {
        let scene = scene::parse("pendulum", SCENES[name].1).unwrap();
        let Analysis::Dynamic(dynamic) = scene.analysis() else { panic!("no dynamic analysis") };
        assert_eq!(dynamic.integrator, integrator);
        assert_eq!((dynamic.duration, dynamic.output_every), (2.5, 0.01));
    }
}

/// What an override sets is what the same edit of the file would set.
#[test]
fn an_override_equals_an_edit() {
    let with = |options: &[&str]| {
        let options: Vec<String> = options.iter().map(|o| (*o).to_owned()).collect();
        Scene::load(&file("roll-up-ancf"), &options).unwrap_or_else(|e| panic!("{e}"))
    };
    let edited = |from: &str, to: &str| {
        assert!(SCENES[1].1.contains(from));
        scene::parse("edited", &SCENES[1].1.replace(from, to)).unwrap()
    };
    for (option, from, to) in [
        ("beam.cantilever.basis.ancf.elements=9", "elements = 3", "elements = 9"),
        ("beam.cantilever.end.0=180 cm", "\"1.8 m\"", "\"180 cm\""),
        ("effect.moment.0.value=3 kN m", "312.885175", "3000.0"),
        ("effect.moment.0.value=-7", "312.885175", "-7"),
        ("beam.cantilever.strain=engineering", "\"green\"", "\"engineering\""),
        ("analysis.static.steps=4", "[analysis.static]", "[analysis.static]\nsteps = 4\n"),
        (
            "analysis.static.arc_length.max_points=9",
            "[analysis.static]",
            "[analysis.static.arc_length]\nmax_points = 9\n",
        ),
        ("output.vtu=true", "[analysis.static]", "[analysis.static]\n[output]\nvtu = true\n"),
        ("support.0.fix=['x', 'y', 'angle']", "\"gradient\"]", "\"angle\"]"),
    ] {
        let (a, b) = (with(&[option]), edited(from, to));
        assert_eq!((a.model(), a.analysis(), a.output()), (b.model(), b.analysis(), b.output()), "{option}");
    }
    let whole = with(&[
        "beam.cantilever.basis={ rpim = { nodes = 7 } }",
        "beam.cantilever.basis.rpim.spacing=chebyshev",
    ]);
    assert!(matches!(
        whole.model().beams[0].discretization,
        Discretization::Rpim { nodes: Nodes::Chebyshev(7), .. }
    ));
}

/// Every example satisfies the published schema, so that editors do not complain of legal scenes.
#[test]
fn the_schema_accepts_the_examples_and_refuses_unknown_keys() {
    let schema = scene::schema();
    let validator = jsonschema::validator_for(&schema).unwrap();
    for (name, text) in SCENES {
        let value: serde_json::Value = toml::from_str(text).unwrap();
        let errors: Vec<String> =
            validator.iter_errors(&value).map(|e| format!("{e} at {}", e.instance_path())).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
    for (from, to) in [
        ("area", "aera"),
        ("\"2.5 cm^2\"", "true"),
        ("elements = 10", "elements = 0"),
        ("at = \"start\"", "at = \"middle\""),
    ] {
        let text = SCENES[0].1.replace(from, to);
        let value: serde_json::Value = toml::from_str(&text).unwrap();
        assert!(!validator.is_valid(&value), "{to}");
    }
}
