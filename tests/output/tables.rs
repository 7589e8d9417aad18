//! Tables, files for ParaView, the summary.

use super::made_up::{all, beam, level, rise};
use super::{Files, snapshot, written_in_full};
use ancf::output::Summary;
use ancf::results::{AnalysisKind, Energy, Frame, ProbeSeries, Run, Trajectory};

/// Whoever changes a table, a file for ParaView or the summary sees here what it changes.
#[test]
fn regress_tables() {
    let mut text = String::new();
    for (name, results) in all() {
        let summary = Summary::of(&results).to_json().expect("JSON");
        let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
        assert!(summary.contains(&version) && summary.ends_with("}\n"));
        text += &format!("== {name}\n{}", summary.replace(&version, "\"version\": …"));
        for (file, content) in written_in_full(&results) {
            text += &format!("== {name}/{file}\n");
            if [".csv", ".vtu", ".pvd"].iter().any(|ending| file.ends_with(*ending)) {
                text += &content;
            }
        }
    }
    snapshot("tables", &text);
}

fn rows(files: &Files, name: &str) -> Vec<Vec<String>> {
    let text = files.get(name).unwrap_or_else(|| panic!("no {name} in {:?}", files.keys()));
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    reader.records().map(|row| row.expect("a row").iter().map(str::to_owned).collect()).collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("no number: {cell}"))
}

/// Would catch a name that a spreadsheet computes, and a number or a harmless name that is changed.
#[test]
fn names_that_begin_as_formulas_are_marked_and_others_are_not() {
    let marked = ["=1+1", "@SUM", "\tx", "\rx", "+x", "-x", "--1"];
    let plain = ["tip", "x=1", "a,\"b\"", "'", ""];
    let numbers = ["-1", "+2.5", "-.5"];
    for name in marked.into_iter().chain(plain).chain(numbers) {
        let mut trajectory = rise(1);
        trajectory.probes[0].name = name.to_owned();
        trajectory.last[0].beam = name.to_owned();
        let files = written_in_full(&trajectory);
        let mark = if marked.contains(&name) { "'" } else { "" };
        assert_eq!(rows(&files, "shape.csv")[1][0], format!("{mark}{name}"));
        // A column's name goes on behind the probe's, and is no number.
        if !numbers.contains(&name) {
            assert_eq!(rows(&files, "probes.csv")[0][1], format!("{mark}{name}.x"));
        }
    }
}

/// A parameter below zero is a number, and stays one.
#[test]
fn negative_load_factors_are_numbers() {
    let mut trajectory = rise(2);
    trajectory.run.analysis = AnalysisKind::Static;
    (trajectory.parameter[1], trajectory.frames[1].parameter) = (-0.125, -0.125);
    let files = written_in_full(&trajectory);
    for name in ["probes.csv", "energy.csv", "states.csv"] {
        let rows = rows(&files, name);
        assert_eq!(rows[0][0], "load", "{name}");
        assert_eq!(rows[rows.len() - 1][0], "-1.2500000000000000e-1", "{name}");
    }
    assert!(
        files["states.pvd"]
            .contains("<DataSet timestep=\"-1.25e-1\" part=\"0\" file=\"vtu/state_00001.vtu\"/>")
    );
}

/// Energies that are zero throughout have no column, and those that are not at one record have one.
#[test]
fn stored_and_lost_energies_have_columns_where_there_are_some() {
    let plain = ["time", "stretch", "bend", "kinetic", "potential", "work", "total"];
    for (stored, lost) in [(false, false), (true, false), (false, true), (true, true)] {
        let mut trajectory = rise(3);
        let there = |is: bool, value: f64| if is { value } else { 0.0 };
        trajectory.energy[1] = Energy {
            stored: there(stored, 1.0),
            lost: there(lost, -2.0),
            work: 8.0,
            bend: 16.0,
            ..Energy::default()
        };
        let rows = rows(&written_in_full(&trajectory), "energy.csv");
        let mut header = plain.to_vec();
        let mut last = vec![0.125, 0.0, 16.0, 0.0, 0.0, 8.0, 8.0 + there(stored, 1.0) + there(lost, -2.0)];
        for (is, name, value) in [(stored, "stored", 1.0), (lost, "lost", -2.0)] {
            if is {
                header.push(name);
                last.push(value);
            }
        }
        assert_eq!(rows[0], header);
        assert_eq!(rows[2].iter().map(|cell| number(cell)).collect::<Vec<_>>(), last);
        // The same of the last record, of which the summary speaks.
        trajectory.energy.truncate(2);
        let last = Summary::of(&trajectory.into()).to_json().expect("JSON");
        let last: serde_json::Value = serde_json::from_str(&last).expect("JSON");
        assert_eq!(
            (last["energy"].get("stored").is_some(), last["energy"].get("lost").is_some()),
            (stored, lost)
        );
    }
}

/// The largest departure from the first total, by the largest kinetic energy.
#[test]
fn drift_is_the_largest_departure_of_the_total() {
    let energy = |kinetic: f64, bend: f64| Energy { kinetic, bend, ..Energy::default() };
    let drift = |energy: Vec<Energy>| {
        Summary::of(&Trajectory { energy, ..Trajectory::default() }.into()).energy.and_then(|e| e.drift)
    };
    // Totals 0.5, 0.25, 0.625: up to 0.25 from the first, of a kinetic energy of 0.5.
    let found = drift(vec![energy(0.25, 0.25), energy(0.125, 0.125), energy(0.5, 0.125)]);
    assert_eq!(found, Some(0.5));
    assert_eq!(drift(vec![energy(0.25, 0.5), energy(0.5, 0.25)]), Some(0.0));
    assert_eq!(drift(vec![energy(0.0, 0.5), energy(0.0, 0.25)]), None);
    assert_eq!(drift(vec![energy(1e-17, 0.5), energy(0.0, 0.5 + 1e-16)]), None, "at rest but for round-off");
    assert_eq!(drift(Vec::new()), None);
}

/// Points of a frame lie evenly between the ends of their beam, wherever these begin.
#[test]
fn states_have_even_arc_lengths() {
    let mut shape = beam("arm", 0.5, &[[0.0, 0.0], [1.0, 2.0]]);
    shape.s = vec![0.25, 0.75];
    let points = |count: usize| (0..count).map(|i| [i as f64, -(i as f64)]).collect::<Vec<_>>();
    let frame =
        |beams: &[usize]| Frame { parameter: 2.0, beams: beams.iter().map(|&count| points(count)).collect() };
    // The second beam is not known: its name is none, and its length one.
    let trajectory = Trajectory {
        run: Run { undeformed: vec![shape], ..Run::default() },
        frames: vec![frame(&[5, 3]), frame(&[1, 0]), frame(&[2])],
        ..Trajectory::default()
    };
    let rows = rows(&written_in_full(&trajectory), "states.csv");
    assert_eq!(rows[0], ["load", "beam", "s", "x", "y"]);
    let found: Vec<(&str, f64)> = rows[1..].iter().map(|row| (row[1].as_str(), number(&row[2]))).collect();
    let expected = [
        ("arm", 0.25),
        ("arm", 0.375),
        ("arm", 0.5),
        ("arm", 0.625),
        ("arm", 0.75),
        ("", 0.0),
        ("", 0.5),
        ("", 1.0),
        ("arm", 0.25),
        ("arm", 0.25),
        ("arm", 0.75),
    ];
    assert_eq!(found, expected);
    assert_eq!([number(&rows[3][0]), number(&rows[3][3]), number(&rows[3][4])], [2.0, 2.0, -2.0]);
}

/// The numbers of an array of a file for ParaView.
fn array(text: &str, name: &str) -> Vec<f64> {
    let (_, rest) = text.split_once(&format!("Name=\"{name}\"")).unwrap_or_else(|| panic!("no {name}"));
    let numbers = rest.split_once('>').and_then(|(_, rest)| rest.split_once('<')).expect("numbers").0;
    numbers.split_whitespace().map(number).collect()
}

/// Would catch displacements from another place of the rest, and cells of another beam's points.
#[test]
fn displacements_are_from_the_same_place_of_the_rest() {
    // The rest is bent, and sampled unevenly; a place is there twice, as where a force acts.
    let mut rest = beam("arm", 1.0, &[[0.0, 0.0], [0.5, 1.0], [0.5, 1.0], [2.0, 1.0]]);
    rest.s = vec![0.0, 0.25, 0.25, 1.0];
    let leg = beam("leg", 3.0, &[[7.0, 7.0], [7.0, 4.0]]);
    let frame = Frame {
        parameter: 0.5,
        beams: vec![
            vec![[0.0, 0.125], [0.75, 1.5], [1.0, 1.0], [2.0, 0.5], [2.5, 0.0]],
            vec![[7.0, 7.0], [8.0, 5.5], [9.0, 4.0]],
        ],
    };
    let trajectory = Trajectory {
        run: Run { undeformed: vec![rest, leg], ..Run::default() },
        frames: vec![frame],
        ..Trajectory::default()
    };
    let files = written_in_full(&trajectory);
    let text = &files["vtu/state_00000.vtu"];
    assert!(text.contains("<Piece NumberOfPoints=\"8\" NumberOfCells=\"2\">"));
    let s = [0.0, 0.25, 0.5, 0.75, 1.0, 0.0, 1.5, 3.0];
    assert_eq!(array(text, "arc length [m]"), s);
    assert_eq!(array(text, "connectivity"), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    assert_eq!(array(text, "offsets"), [5.0, 8.0]);
    assert_eq!(array(text, "types"), [4.0, 4.0]);
    assert_eq!(array(text, "beam"), [0.0, 1.0]);
    let at_rest =
        [[0.0, 0.0], [0.5, 1.0], [1.0, 1.0], [1.5, 1.0], [2.0, 1.0], [7.0, 7.0], [7.0, 5.5], [7.0, 4.0]];
    let (position, displacement) = (array(text, "position [m]"), array(text, "displacement [m]"));
    assert_eq!((position.len(), displacement.len()), (24, 24));
    for (i, rest) in at_rest.iter().enumerate() {
        let expected = [position[3 * i] - rest[0], position[3 * i + 1] - rest[1], 0.0];
        for (found, expected) in displacement[3 * i..3 * i + 3].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "point {i}: {found}, not {expected}");
        }
    }
    // Of a beam whose rest is not known there are no displacements, and no other has another's.
    let unknown = Trajectory { run: Run { undeformed: vec![level(0.0)], ..trajectory.run }, ..trajectory };
    assert!(!written_in_full(&unknown)["vtu/state_00000.vtu"].contains("displacement"));
}

/// Velocities have columns where any probe has one, at any record.
#[test]
fn velocities_have_columns_where_there_is_one() {
    let mut trajectory = rise(2);
    let mut other = trajectory.probes[0].clone();
    for sample in &mut other.samples {
        (sample.vx, sample.vy) = (None, None);
    }
    other.name = "other".to_owned();
    let still = Trajectory { probes: vec![other.clone()], ..trajectory.clone() };
    let header = |trajectory: &Trajectory| rows(&written_in_full(trajectory), "probes.csv")[0].clone();
    assert_eq!(header(&still).len(), 1 + 5);
    trajectory.probes.insert(0, other);
    assert_eq!(header(&trajectory).len(), 1 + 2 * 7);
    let rows = rows(&written_in_full(&trajectory), "probes.csv");
    assert_eq!((rows[1][6].as_str(), rows[1][7].as_str()), ("NaN", "NaN"));
    assert_eq!((number(&rows[1][13]), number(&rows[1][14])), (0.0, 0.08));
    // One component alone is enough.
    let mut half = Trajectory { probes: vec![ProbeSeries::default()], ..rise(1) };
    half.probes[0].samples = still.probes[0].samples[..1].to_vec();
    half.probes[0].samples[0].vy = Some(0.5);
    assert_eq!(header(&half).len(), 1 + 7);
}
