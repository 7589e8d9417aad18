//! Attraction by electrodes.

use super::{Written, near};
use ancf::scene::parse;

/// A stiff plate of 1 mm on a spring at its middle, 10 µm above an electrode: the spring carries
/// k x = ½ ε w L V²/(g − x)² (1 + β (g − x)/w).
fn plate(more: &str, electrode: &str, analysis: &str) -> String {
    format!(
        "beam.plate = {{ start = [0, 0], end = ['1 mm', 0], axial_stiffness = '10 N', bending_stiffness = 1e-6, \
         mass_per_length = 1e-6, basis.ancf.elements = 4 }}
        {more}
        effect.electrostatic = [{{ beam = 'plate', voltage = '10 V', width = '100 µm', electrode = {{ point = [0, '-10 µm'], normal = [0, 2] }}{electrode} }}]
        probe = [{{ name = 'middle', beam = 'plate', at = '0.5 mm' }}]
        {analysis}\n"
    )
}

const HELD: &str = "support = [{ beam = 'plate', at = 'start', fix = ['x', 'angle'] }]
    effect.spring = [{ beam = 'plate', at = '0.5 mm', stiffness = '0.5 N/m' }]";

const GAP: f64 = 1e-5;

/// The force at the distance `gap` under the square of the voltage that is `factor` times that of
/// 10 V.
fn force(factor: f64, gap: f64, length: f64, fringe: f64) -> f64 {
    0.5 * 8.8541878128e-12 * 1e-4 * length * 100.0 * factor / (gap * gap) * (1.0 + fringe * gap / 1e-4)
}

/// The path through pull-in, which is at a third of the gap without the field beyond the edges.
#[test]
fn a_plate_on_a_spring_is_pulled_in() {
    for (electrode, length, fringe) in
        [("", 1e-3, 0.0), (", fringe = 0.65", 1e-3, 0.65), (", from = '0.2 mm', to = '0.8 mm'", 6e-4, 0.0)]
    {
        let path = "analysis.static.arc_length = { until_probe = { probe = 'middle', y = '-7 µm' }, max_step = 0.01 }";
        let found = Written::of(&plate(HELD, electrode, path));
        let (loads, ys) = (found.column("probes.csv", "load"), found.column("probes.csv", "middle.y"));
        assert!(loads.len() > 20, "{loads:?}");
        for (load, y) in loads.iter().zip(&ys) {
            near(force(*load, GAP + y, length, fringe), -0.5 * y, 1e-4 * 0.5 * GAP, electrode);
        }
        let largest = loads.iter().copied().fold(0.0, f64::max);
        if fringe == 0.0 {
            let pull_in = 8.0 * 0.5 * GAP.powi(3) / (27.0 * 2.0 * force(1.0, 1.0, length, 0.0));
            near(largest, pull_in, 1e-2 * pull_in, "pull-in");
        }
        // The potential of the plates.
        let energy = found.last("energy.csv", "potential");
        let gap = GAP + ys.last().expect("a record");
        let (a, load) = (force(1.0, 1.0, length, 0.0), *loads.last().expect("a record"));
        let potential = -a * (1.0 / gap - 1.0 / GAP) + a * fringe / 1e-4 * (gap / GAP).ln();
        near(energy, load * potential, 2e-4 * (load * potential).abs(), "potential");
    }
}

/// In a motion the law multiplies the voltage, so that half of it makes a quarter of the force; a
/// free plate falls by ½ f/m t². Permittivity and half thickness are those of the scene.
#[test]
fn a_free_plate_is_attracted_by_the_square_of_the_voltage() {
    let motion = "analysis.dynamic = { duration = '1 us', output_every = '1 us' }";
    let law = ", half_thickness = '2 µm', permittivity = '17.7083756256 pF/m', in_time.polynomial = [0.5]";
    let found = Written::of(&plate("", law, motion));
    let acceleration = 2.0 * force(0.25, 8e-6, 1e-3, 0.0) / (1e-6 * 1e-3);
    near(found.last("probes.csv", "middle.y"), -0.5 * acceleration * 1e-12, 1e-3 * acceleration * 1e-12, "y");
    // What the plates lose is what the plate moves with.
    let at = |column: &str| found.last("energy.csv", column);
    near(at("kinetic"), at("work"), 1e-3 * at("kinetic"), "energy");
}

/// The charge of a plate on a spring lowers its frequency: ω² = (k − 2 k x/(g − x))/m about the
/// equilibrium x of the gap g.
#[test]
fn an_electrode_softens_a_spring() {
    let scene = plate(HELD, "", "analysis.modal = { count = 1, about = 'equilibrium' }");
    let found = Written::of(&scene.replace("'10 V'", "'3 V'"));
    let x = -found.last("probes.csv", "middle.y");
    near(force(0.09, GAP - x, 1e-3, 0.0), 0.5 * x, 1e-9, "equilibrium");
    let omega = ((0.5 - 2.0 * 0.5 * x / (GAP - x)) / 1e-9_f64).sqrt();
    near(found.last("frequencies.csv", "frequency") * std::f64::consts::TAU, omega, 2e-3 * omega, "ω");
}

#[test]
fn an_electrode_has_a_side() {
    let wrong = plate(HELD, "", "analysis.static = {}").replace("normal = [0, 2]", "normal = [0, -2]");
    let said = parse("scene.toml", &wrong).expect_err("behind the electrode").to_string();
    assert!(said.contains("begins") && said.contains("behind the electrode at s = 0 m"), "{said}");
    // Aslant, the gap 0.6 (x + 10 µm) − 0.8 (y + 10 µm) grows from −2 to 598 µm along the plate, and falls the
    // other way round.
    let aslant = |normal: &str| {
        let wrong = plate(HELD, "", "analysis.static = {}").replace("normal = [0, 2]", normal);
        let wrong = wrong.replace("point = [0,", "point = ['-10 µm',");
        let said = parse("scene.toml", &wrong).expect_err("behind the electrode").to_string();
        let number = |before: &str| {
            let word = said.split_once(before).and_then(|(_, rest)| rest.split(' ').next());
            word.and_then(|word| word.parse::<f64>().ok()).unwrap_or_else(|| panic!("{said}"))
        };
        [number("begins "), number("at s = ")]
    };
    let [behind, s] = aslant("normal = [3, -4]");
    near(behind, 2e-6, 1e-18, "at the start");
    near(s, 0.0, 0.0, "s");
    // Looked at from 5 to 5 µm, the plate is first behind it at s = 5 µm, by 0.6 · 15 − 0.8 · 10 = 1 µm.
    let [behind, s] = aslant("normal = [-3, 4]");
    near(behind, 1e-6, 1e-18, "after the start");
    near(s, 5e-6, 1e-18, "s");
    let thick = plate(HELD, ", half_thickness = '10 µm'", "analysis.static = {}");
    assert!(parse("scene.toml", &thick).is_err());
    let pulled = plate(HELD, "", "analysis.static = {}").replace("'10 V'", "'60 V'");
    let scene = parse("scene.toml", &pulled).expect("a scene");
    let failed = scene.model().solve(scene.analysis()).expect_err("pulled in");
    assert!(failed.to_string().contains("no equilibrium beyond load factor"), "{failed}");
}

/// A voltage that comes all at once pulls the plate in from four fifths of the static limit on: 1/4 for 8/27 of k g³/(ε w L).
/// Such a motion ends at the electrode, and says so.
#[test]
fn a_motion_that_is_pulled_in_says_so() {
    for (factor, escapes) in [(0.95, true), (1.05, false)] {
        let limit = (0.25 * 0.5 * GAP.powi(3) / (8.8541878128e-12 * 1e-4 * 1e-3)).sqrt();
        let law = ", in_time.step.start = 0";
        let text = plate(HELD, law, "analysis.dynamic = { duration = '2 ms', accuracy = 1e-3 }");
        let text = text.replace("'10 V'", &(factor * limit).to_string());
        let scene = parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let end = ancf::accuracy::run(&scene, ancf::Options::default());
        let text = match &end {
            Ok(_) => String::new(),
            Err(error) => format!("{error:?}"),
        };
        assert_eq!(text.contains("an electrode has pulled beam `plate` in"), !escapes, "{factor}: {text}");
        assert_eq!(end.is_ok(), escapes, "{factor}: {text}");
    }
}
