//! The page: its words and tables.

use super::made_up::{all, buckling, rise, sample, step, vibrations};
use super::{snapshot, written};
use ancf::results::{
    AnalysisKind, BucklingMode, CriticalLoads, LayerStress, ProbeSample, ProbeSeries, Reaction,
    ReactionSeries, Results, Run, Seconds, SectionForces, SectionSeries, Shape, Statistics, Tension,
    Trajectory, Vibration, Vibrations,
};

/// The page without what stands between the two, wherever they are.
fn without(text: &str, from: &str, to: &str) -> String {
    let mut parts = text.split(from);
    let mut kept = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (_, rest) = part.split_once(to).unwrap_or_else(|| panic!("{from} without {to}"));
        kept += &format!("{from}…{to}{rest}");
    }
    kept
}

/// Words and tables of the page; pictures and the moving one are looked at elsewhere.
fn words(results: &(impl Clone + Into<Results>)) -> String {
    let page = written(results)["report.html"].replace(env!("CARGO_PKG_VERSION"), "VERSION");
    let page = without(&page, "<style>", "</style>");
    let page = without(&page, "<script", "</script>");
    let page = without(&page, "<figure><svg", "<figcaption>");
    let page = without(&page, "<figure class=\"wide\"><svg", "<figcaption>");
    page.lines().filter(|line| !line.trim().is_empty()).map(|line| format!("{line}\n")).collect()
}

/// Whoever changes what the page says sees here what it changes.
#[test]
fn regress_pages() {
    let mut text = String::new();
    let more = [("rise", rise(3).into()), ("nothing", Trajectory::default().into())];
    for (name, results) in all().into_iter().chain(more) {
        text += &format!("== {name}\n{}", words(&results));
    }
    snapshot("pages", &text);
}

/// The cells of the first row behind a caption, by their names in the header.
fn first_row(page: &str, caption: &str) -> Vec<(String, String)> {
    let (_, rest) = page.split_once(&format!("<caption>{caption}</caption>")).expect("a table");
    let cells = |open: &str, close: &str, text: &str| -> Vec<String> {
        let cells = text.split(open).skip(1).filter_map(|cell| cell.split(close).next());
        cells.map(str::to_owned).collect()
    };
    let (header, body) = rest.split_once("</thead>").expect("a header");
    let row = body.split("</tr>").next().unwrap_or_default();
    cells("<th>", "</th>", header).into_iter().zip(cells("<td>", "</td>", row)).collect()
}

fn pairs(expected: &[(&str, &str)]) -> Vec<(String, String)> {
    expected.iter().map(|&(name, value)| (name.to_owned(), value.to_owned())).collect()
}

/// A probe's numbers have seven digits; what is round-off for its quantity has one.
#[test]
fn round_off_has_one_digit() {
    let mut trajectory = rise(1);
    trajectory.parameter = vec![0.123_456_789];
    // Of a beam of this length 1e-12 of it is the limit, and the limit itself no round-off.
    let length = 0.345_678_9;
    for shape in trajectory.run.undeformed.iter_mut() {
        shape.s = vec![0.0, 0.1, length];
    }
    let mut row = |x: f64, y: f64, curvature: f64, strain: f64, degrees: f64| {
        trajectory.probes[0].samples = vec![ProbeSample {
            curvature,
            strain,
            vx: Some(12.345_678_91),
            vy: Some(-1e-13),
            ..sample(x, y, degrees.to_radians(), None)
        }];
        first_row(&written(&trajectory)["report.html"], "Probes at 0.123457 s")
    };
    let found = row(1e-12 * length, 2.345_678e-13, 2.345_678e-12, 7.654_321e-13, 5.4e-13);
    let expected = [
        ("probe", "end"),
        ("x [m]", "3.456789 × 10⁻¹³"),
        ("y [m]", "2 × 10⁻¹³"),
        ("angle [°]", "5 × 10⁻¹³"),
        ("κ [1/m]", "2 × 10⁻¹²"),
        ("ε [–]", "8 × 10⁻¹³"),
        ("vx [m/s]", "12.34568"),
        ("vy [m/s]", "−1 × 10⁻¹³"),
    ];
    assert_eq!(found, pairs(&expected));
    let found = row(-0.012_345_678_9, 1_234.567_891, 3.456_789e-12, 1.234_567_89e-12, 123.456_789_12);
    let expected = [
        ("probe", "end"),
        ("x [m]", "−0.01234568"),
        ("y [m]", "1234.568"),
        ("angle [°]", "123.4568"),
        ("κ [1/m]", "3.456789 × 10⁻¹²"),
        ("ε [–]", "1.234568 × 10⁻¹²"),
        ("vx [m/s]", "12.34568"),
        ("vy [m/s]", "−1 × 10⁻¹³"),
    ];
    assert_eq!(found, pairs(&expected));
}

/// One probe that moves beside one of which no velocity is known.
#[test]
fn velocities_that_are_not_known_are_dashes() {
    let mut trajectory = rise(1);
    let mut other = trajectory.probes[0].clone();
    (other.samples[0].vx, other.samples[0].vy) = (None, None);
    trajectory.probes.insert(0, other.clone());
    let row = first_row(&written(&trajectory)["report.html"], "Probes at 0 s");
    assert_eq!(row[6..], pairs(&[("vx [m/s]", "–"), ("vy [m/s]", "–")]));
    trajectory.probes = vec![other];
    assert_eq!(first_row(&written(&trajectory)["report.html"], "Probes at 0 s").len(), 6);
}

/// Would catch another number of digits, another record's number, and another quantity's.
#[test]
fn captions_say_when_and_how_much() {
    let long = 0.123_456_789_12;
    let bent = |shape: &mut Shape| {
        shape.curvature = vec![long, -5.0 * long, 0.0];
        shape.strain = vec![-long * 1e-3, 0.0, 0.0];
    };
    let mut trajectory = rise(3);
    trajectory.parameter[2] = 10.0 * long;
    trajectory.last.iter_mut().for_each(bent);
    // Totals 0.25, 0.412345 and 0.3, of which the second departs most.
    trajectory.energy[2].potential = 0.05;
    trajectory.energy[1].potential = 0.1;
    trajectory.energy[1].kinetic = 0.312_345;
    let page = words(&trajectory);
    for caption in [
        "Shape at 1.23457 s, in true proportion.",
        "Curvature at 1.23457 s; largest magnitude 0.61728 1/m.",
        "Axial strain at 1.23457 s; largest magnitude 0.00012346.",
        "the total departs from its first value by 0.52 of the largest kinetic energy.",
    ] {
        assert!(page.contains(caption), "{caption} in {page}");
    }
    let row = first_row(&page, "Energies at 1.23457 s");
    let names: Vec<&str> = row.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["energy [J]", "stretch", "bend", "kinetic", "potential", "total", "drift [–]"]);
    let values: Vec<&str> = row.iter().map(|(_, value)| value.as_str()).collect();
    assert_eq!(values, ["last record", "0", "0", "0.25", "0.05", "0.3", "0.52"]);
    // The same of loads.
    trajectory.run.analysis = AnalysisKind::Static;
    trajectory.energy.iter_mut().for_each(|e| e.kinetic = 0.0);
    let page = words(&trajectory);
    for caption in [
        "Shape at load factor 1.23457, in true proportion.",
        "Energies of the equilibria.",
        "<caption>Probes at load factor 1.23457</caption>",
        "<caption>Energies at load factor 1.23457</caption>",
    ] {
        assert!(page.contains(caption), "{caption} in {page}");
    }
}

/// Forces with seven digits, stresses with five; where only one of two sections tells its shape, the
/// other's stresses are dashes.
#[test]
fn sections_stresses_reactions_and_tensions_have_their_digits() {
    let mut trajectory = rise(2);
    let probe = trajectory.probes[0].clone();
    trajectory.probes =
        ["plain", "end"].map(|name| ProbeSeries { name: name.into(), ..probe.clone() }).to_vec();
    let plain = SectionForces {
        axial_force: 1.234_567_89,
        shear_force: -23.456_789_1,
        bending_moment: 345.678_912_3,
        stress_bottom: None,
        stress_top: None,
    };
    let stressed =
        SectionForces { stress_bottom: Some(-4_567.891_23), stress_top: Some(0.567_891_234), ..plain };
    let series = |(name, samples): (&str, Vec<SectionForces>)| SectionSeries { name: name.into(), samples };
    trajectory.sections =
        [("plain", vec![stressed, plain]), ("end", vec![plain, stressed])].map(series).to_vec();
    let force = Reaction { fx: -1.234_567_89, fy: 23.456_789_1, moment: 0.034_567_891_23 };
    let samples = vec![Reaction::default(), force];
    trajectory.reactions = vec![ReactionSeries { name: "support1".into(), samples }];
    trajectory.run.tensions = vec![Tension { beam: "arm".into(), tension: 67.891_234_5 }];
    let (bottom, top) = (vec![0.0, -2.0, 1.0], vec![1.0, 3.0, -7.891_234_56]);
    let length = 0.912_345_678;
    for shape in &mut trajectory.last {
        shape.s = vec![0.0, 0.5, length];
        let idle = LayerStress { bottom: vec![0.0; 3], top: vec![0.0; 3] };
        shape.stress = vec![idle, LayerStress { bottom: bottom.clone(), top: top.clone() }];
    }
    let page = written(&trajectory)["report.html"].clone();
    for (caption, expected) in [
        (
            "Sections at the probes",
            &[
                ("section at", "plain"),
                ("N [N]", "1.234568"),
                ("Q [N]", "−23.45679"),
                ("M [N m]", "345.6789"),
                ("σ bottom [Pa]", "–"),
                ("σ top [Pa]", "–"),
            ][..],
        ),
        (
            "Largest stresses",
            &[
                ("largest stress in", "arm"),
                ("σ [Pa]", "−7.8912"),
                ("s [m]", "0.912346"),
                ("layer", "2"),
                ("face", "top"),
            ],
        ),
        (
            "Reactions",
            &[
                ("reaction of", "support1"),
                ("fx [N]", "−1.234568"),
                ("fy [N]", "23.45679"),
                ("moment [N m]", "0.03456789"),
            ],
        ),
        ("Tendons of given length", &[("tendon of", "arm"), ("tension [N]", "67.89123")]),
    ] {
        assert_eq!(first_row(&page, &format!("{caption} at 0.125 s")), pairs(expected), "{caption}");
    }
    for stress in ["<td>−4567.9</td>", "<td>0.56789</td>"] {
        assert_eq!(page.matches(stress).count(), 1, "{stress}");
    }
}

/// Frequencies and critical loads with eight digits, and which vibration nothing resists.
#[test]
fn eigenvalues_are_listed_with_their_numbers() {
    let vibration = |frequency| Vibration { frequency, round_off: 0.0, shape: Vec::new() };
    let modes = [0.0, 12.345_678_912].map(vibration).into();
    let page = words(&Vibrations { modes, ..vibrations() });
    assert_eq!(
        first_row(&page, "Natural frequencies"),
        pairs(&[("mode", "1"), ("frequency [Hz]", "0 (nothing resists)")])
    );
    assert!(page.contains("<tr><td>2</td><td>12.345679</td></tr></tbody>"), "{page}");
    assert!(page.contains("Dashed: the equilibrium."));
    let mode = |load_factor| BucklingMode { load_factor, round_off: 0.0, shape: Vec::new() };
    let modes = [0.0, 12.345_678_912].map(mode).into();
    let page = words(&CriticalLoads { modes, ..buckling() });
    assert_eq!(first_row(&page, "Critical loads"), pairs(&[("mode", "1"), ("load factor", "0")]));
    assert!(page.contains("<tr><td>2</td><td>12.345679</td></tr></tbody>"), "{page}");
    assert!(page.contains("Dashed: undeformed."));
}

/// What was counted and how long it took; nothing of which there is none.
#[test]
fn counts_and_times_are_told() {
    let mut trajectory = rise(1);
    trajectory.run.statistics =
        Statistics { steps: 1, rejected_steps: 0, load_steps: 2, ..Statistics::default() };
    let told = |trajectory: &Trajectory| -> Vec<String> {
        let page = words(trajectory);
        let (_, rest) = page.split_once("<h2>What it took</h2>").expect("a heading");
        let rows = rest.split("<tr><th>").skip(1).filter_map(|row| row.split("</td></tr>").next());
        rows.map(|row| row.replace("</th><td>", ": ")).collect()
    };
    trajectory.run.seconds = Seconds { build: 0.012_345, solve: 0.099_99, write: 7.0 };
    assert_eq!(
        told(&trajectory),
        ["steps: 1", "load steps: 2", "time to build: 12.3 ms", "time to solve: 100 ms"]
    );
    trajectory.run.statistics = Statistics {
        rejected_steps: 3,
        newton_iterations: 4,
        residual_evaluations: 5,
        tangent_evaluations: 6,
        factorizations: 7,
        ..Statistics::default()
    };
    trajectory.run.seconds = Seconds { build: 0.1, solve: 12.345, write: 7.0 };
    let expected = [
        "rejected steps: 3",
        "Newton iterations: 4",
        "residual evaluations: 5",
        "tangent evaluations: 6",
        "factorisations: 7",
        "time to build: 0.1 s",
        "time to solve: 12.3 s",
    ];
    assert_eq!(told(&trajectory), expected);
}

/// The head of the page: what it is about, and what the reader must know.
#[test]
fn the_head_says_what_it_is() {
    for (analysis, kind) in [
        (AnalysisKind::Static, "Equilibrium"),
        (AnalysisKind::Dynamic, "Motion"),
        (AnalysisKind::Modal, "Natural vibrations"),
        (AnalysisKind::Buckling, "Critical loads"),
    ] {
        for (title, shown) in [("", kind), (" \t", kind), ("Named", "Named")] {
            let title = title.to_owned();
            let page = words(&Trajectory {
                run: Run { analysis, title, degrees_of_freedom: 1, ..Run::default() },
                ..Trajectory::default()
            });
            assert!(page.contains(&format!("<h1>{shown}</h1>")), "{page}");
            assert!(
                page.contains(&format!("<p class=\"subtitle\">{kind} · 1 degree of freedom</p>")),
                "{page}"
            );
        }
    }
    let page = words(&Trajectory { run: Run { degrees_of_freedom: 2, ..rise(1).run }, ..rise(1) });
    assert!(page.contains("<p class=\"subtitle\">Motion · 2 degrees of freedom</p>"));
    assert!(!page.contains("class=\"warnings\"") && !page.contains("Incomplete"));
    // Pictures in their order, the shape first.
    let history = vec![step(0.1, 0.1, &[1e-3], &[1e-4]); 2];
    let page = words(&Trajectory { history, ..rise(2) });
    let mut at = 0;
    for caption in ["Shape", "Curvature", "Axial strain", "Position", "Direction", "Velocity", "Energies;"]
        .into_iter()
        .chain(["Convergence", "Size of the steps", "Newton iterations of"])
    {
        let found = page[at..].find(&format!("<figcaption>{caption}"));
        at += found.unwrap_or_else(|| panic!("{caption} is not behind the last one in {page}"));
    }
}
