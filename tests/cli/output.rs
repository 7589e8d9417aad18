//! Results as files: complete, exact, and all or none.

use std::fs;
use std::path::Path;

use ancf::output::plot::{Axis, Chart, PALETTE, PlotError, Series, grid};
use ancf::output::{OutputError, OutputOptions, Summary, write};
use ancf::results::{
    AnalysisKind, CriticalLoads, Energy, Frame, ModeShape, ProbeSample, ProbeSeries, Results, Run, Shape,
    StepRecord, Trajectory, Vibration, Vibrations,
};

/// A beam on a line of the given slope, its numbers chosen to need all their digits.
fn line(beam: &str, slope: f64) -> Shape {
    let s: Vec<f64> = (0..201).map(|i| 1.8 * f64::from(i) / 200.0).collect();
    let third = |v: &f64| v / 3.0;
    Shape {
        beam: beam.into(),
        x: s.clone(),
        y: s.iter().map(|s| s * slope).collect(),
        angle: vec![slope.atan(); 201],
        strain: s.iter().map(|s| 1e-7 * s.sin()).collect(),
        curvature: s.iter().map(third).collect(),
        axial_force: s.iter().map(|s| 3e4 * s).collect(),
        shear_force: s.iter().map(|s| 0.3 * s).collect(),
        bending_moment: s.iter().map(|s| -0.7 * s).collect(),
        nodes: vec![[0.0, 0.0], [1.8, 1.8 * slope]],
        s,
        ..Shape::default()
    }
}

fn frame(parameter: f64, slope: f64, beams: usize) -> Frame {
    let points: Vec<[f64; 2]> =
        (0..101).map(|i| 1.8 * f64::from(i) / 100.0).map(|s| [s, s * slope]).collect();
    Frame { parameter, beams: vec![points; beams] }
}

fn sample(time: f64, velocity: Option<f64>) -> ProbeSample {
    let (vx, vy) = (velocity, velocity.map(|v| v / 7.0));
    ProbeSample {
        x: time.cos() / 3.0,
        y: -1e-17 * time,
        angle: 40.0 * time,
        curvature: 1e300,
        strain: 5e-324,
        vx,
        vy,
    }
}

fn motion(records: u32) -> Trajectory {
    let time = |i: u32| f64::from(i) * 0.1;
    let series = |name: &str| ProbeSeries {
        name: name.into(),
        samples: (0..records).map(|i| sample(time(i), Some(1.0 / 3.0))).collect(),
    };
    Trajectory {
        run: Run {
            title: "Arm <&> </script> \"quoted\"".into(),
            analysis: AnalysisKind::Dynamic,
            complete: true,
            degrees_of_freedom: 12,
            undeformed: vec![line("arm", 0.0)],
            ..Run::default()
        },
        parameter: (0..records).map(time).collect(),
        probes: vec![series("tip"), series("mid, of the arm")],
        energy: (0..records)
            .map(|i| Energy {
                stretch: 0.1,
                bend: 1.0 / 3.0,
                stored: 0.0,
                kinetic: time(i),
                potential: -0.999 * time(i),
                work: 0.0,
                lost: 0.0,
            })
            .collect(),
        frames: (0..records).map(|i| frame(time(i), time(i), 1)).collect(),
        last: vec![line("arm", 0.7)],
        history: vec![
            StepRecord {
                parameter: 0.1,
                step: 0.1,
                accepted: true,
                increments: vec![1e-2, 1e-5, 0.0],
                residuals: vec![1e-1, 1e-4, 1e-12],
            };
            4
        ],
        ..Trajectory::default()
    }
}

fn mode(frequency: f64, slope: f64) -> Vibration {
    let Shape { beam, s, x, y, angle, strain, curvature, nodes, .. } = line("arm", slope);
    let x = vec![0.0; x.len()];
    let nodes = nodes.iter().map(|node| [0.0, node[1]]).collect();
    Vibration {
        frequency,
        round_off: 0.0,
        shape: vec![ModeShape { beam, s, x, y, angle, strain, curvature, nodes }],
    }
}

fn modal() -> Vibrations {
    let equilibrium = Trajectory {
        run: Run {
            title: "Modes".into(),
            analysis: AnalysisKind::Modal,
            complete: true,
            degrees_of_freedom: 12,
            undeformed: vec![line("arm", 0.0)],
            ..Run::default()
        },
        probes: vec![ProbeSeries { name: "tip".into(), samples: vec![] }],
        last: vec![line("arm", 0.0)],
        ..Trajectory::default()
    };
    Vibrations { equilibrium, modes: vec![mode(6.2, 0.1), mode(39.0, -0.1)] }
}

const EVERYTHING: OutputOptions = OutputOptions { states: true, vtu: true };

fn names(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).expect("the directory exists");
    let mut names: Vec<_> =
        entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Header and rows of a CSV file.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let mut reader = csv::Reader::from_path(path).expect("a table");
    let owned = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let header = owned(reader.headers().expect("a header"));
    (header, reader.records().map(|r| owned(&r.expect("a row"))).collect())
}

fn bits(cells: &[String]) -> Vec<u64> {
    cells.iter().map(|c| c.parse::<f64>().expect("a number").to_bits()).collect()
}

fn bits_of(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn tables_read_back_to_the_same_bits() {
    let directory = tempfile::tempdir().expect("a directory");
    let t = motion(5);
    write(directory.path(), &mut t.clone().into(), &EVERYTHING).expect("written");
    for plot in ["steps.svg", "newton.svg", "convergence.svg"] {
        assert!(names(directory.path()).contains(&plot.into()), "{plot}");
    }
    let (header, rows) = table(&directory.path().join("probes.csv"));
    assert_eq!(
        header[..8],
        ["time", "tip.x", "tip.y", "tip.angle", "tip.curvature", "tip.strain", "tip.vx", "tip.vy"]
    );
    assert_eq!((header.len(), header[8].as_str(), rows.len()), (15, "mid, of the arm.x", 5));
    for (i, row) in rows.iter().enumerate() {
        let s = t.probes[0].samples[i];
        let (vx, vy) = (s.vx.expect("moving"), s.vy.expect("moving"));
        assert_eq!(
            bits(&row[..8]),
            bits_of(&[t.parameter[i], s.x, s.y, s.angle, s.curvature, s.strain, vx, vy])
        );
    }
    let (header, rows) = table(&directory.path().join("energy.csv"));
    assert_eq!(header, ["time", "stretch", "bend", "kinetic", "potential", "work", "total"]);
    for (i, (row, e)) in rows.iter().zip(&t.energy).enumerate() {
        assert_eq!(
            bits(row),
            bits_of(&[t.parameter[i], e.stretch, e.bend, e.kinetic, e.potential, e.work, e.total()])
        );
    }
    let (header, rows) = table(&directory.path().join("shape.csv"));
    assert_eq!(
        header,
        [
            "beam",
            "s",
            "x",
            "y",
            "angle",
            "strain",
            "curvature",
            "axial_force",
            "shear_force",
            "bending_moment"
        ]
    );
    assert_eq!(rows.len(), 201);
    let b = &t.last[0];
    for (i, row) in rows.iter().enumerate() {
        assert_eq!(row[0], "arm");
        assert_eq!(
            bits(&row[1..]),
            bits_of(&[
                b.s[i],
                b.x[i],
                b.y[i],
                b.angle[i],
                b.strain[i],
                b.curvature[i],
                b.axial_force[i],
                b.shear_force[i],
                b.bending_moment[i]
            ])
        );
    }
    let (header, rows) = table(&directory.path().join("states.csv"));
    assert_eq!((header, rows.len()), (["time", "beam", "s", "x", "y"].map(String::from).to_vec(), 5 * 101));
    let [x, y] = t.frames[4].beams[0][100];
    assert_eq!(bits(&rows[504][3..]), bits_of(&[x, y]));
}

#[test]
fn summary_has_the_keys_of_the_contract() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut results = motion(5).into();
    let summary = write(directory.path(), &mut results, &OutputOptions::default()).expect("written");
    let t = results.into_states();
    let text = fs::read_to_string(directory.path().join("summary.json")).expect("a summary");
    assert_eq!(text, summary.to_json().expect("JSON"), "the file says what `write` returns");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(json["title"], t.run.title);
    assert_eq!(json["analysis"], "dynamic");
    assert_eq!(json["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(json["complete"], true);
    assert_eq!(json["degrees_of_freedom"], 12);
    for key in ["x", "y", "angle", "curvature", "strain", "vx", "vy"] {
        assert!(json["probes"]["tip"][key].is_f64(), "probes.tip.{key}");
    }
    for key in ["stretch", "bend", "kinetic", "potential", "total"] {
        assert!(json["energy"][key].is_f64(), "energy.{key}");
    }
    let drift = json["energy"]["drift"].as_f64().expect("a drift");
    assert!(
        (drift - 1e-3).abs() < 1e-12,
        "max |total − initial| / max kinetic = 0.0004 / 0.4, found {drift}"
    );
    let counts = [
        "steps",
        "rejected_steps",
        "load_steps",
        "newton_iterations",
        "residual_evaluations",
        "tangent_evaluations",
        "factorizations",
    ];
    for key in counts {
        assert!(json["statistics"][key].is_u64(), "statistics.{key}");
    }
    for key in ["build", "solve", "write"] {
        assert!(json["seconds"][key].is_f64(), "seconds.{key}");
    }
    assert!(t.run.seconds.write > 0.0 && json["seconds"]["write"] == t.run.seconds.write);
    assert!(json.get("frequencies").is_none(), "frequencies are for modal analysis");
    let still = Summary::of(&Trajectory { energy: vec![Energy::default()], ..Trajectory::default() }.into());
    assert_eq!(still.energy.and_then(|e| e.drift), None, "nothing moves: no drift");
}

#[test]
fn modal_results_hold_frequencies_and_modes() {
    let directory = tempfile::tempdir().expect("a directory");
    write(directory.path(), &mut modal().into(), &EVERYTHING).expect("written");
    let json = fs::read_to_string(directory.path().join("summary.json")).expect("a summary");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["frequencies"], serde_json::json!([6.2, 39.0]));
    assert_eq!(json["probes"], serde_json::json!({}));
    let (header, rows) = table(&directory.path().join("frequencies.csv"));
    assert_eq!((header, rows.len()), (vec!["mode".to_owned(), "frequency".into()], 2));
    assert_eq!(table(&directory.path().join("modes.csv")).1.len(), 402);
    assert!(names(directory.path()).contains(&"modes.svg".into()));
}

#[test]
fn a_later_run_leaves_nothing_of_an_earlier_one() {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("notes.txt"), "mine").expect("written");
    write(directory.path(), &mut motion(5).into(), &EVERYTHING).expect("written");
    assert!(directory.path().join("vtu/state_00004.vtu").is_file());
    write(directory.path(), &mut motion(3).into(), &EVERYTHING).expect("written");
    assert!(!directory.path().join("vtu/state_00003.vtu").exists());
    write(directory.path(), &mut modal().into(), &OutputOptions::default()).expect("written");
    let expected = [
        "frequencies.csv",
        "modes.csv",
        "modes.svg",
        "notes.txt",
        "report.html",
        "shape.csv",
        "summary.json",
    ];
    assert_eq!(names(directory.path()), expected);
}

#[test]
fn a_file_in_the_way_is_named_and_nothing_is_written() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("file");
    fs::write(&file, "").expect("written");
    let error =
        write(&file.join("results"), &mut motion(3).into(), &EVERYTHING).expect_err("a file is no directory");
    assert!(
        matches!(&error, OutputError::Directory { path, .. } if path.ends_with("file/results")),
        "{error:?}"
    );
    assert_eq!(names(directory.path()), ["file"]);
}

#[test]
fn a_failure_half_way_leaves_nothing() {
    let directory = tempfile::tempdir().expect("a directory");
    let results = directory.path().join("results");
    // The last file to be written cannot be.
    fs::create_dir_all(results.join("summary.json")).expect("made");
    let error = write(&results, &mut motion(3).into(), &EVERYTHING).expect_err("a directory is in the way");
    assert!(matches!(&error, OutputError::Occupied { path } if path.ends_with("summary.json")), "{error:?}");
    assert_eq!(names(&results), ["summary.json"]);
}

#[cfg(unix)]
#[test]
fn an_unwritable_directory_stays_empty() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempfile::tempdir().expect("a directory");
    fs::set_permissions(directory.path(), fs::Permissions::from_mode(0o555)).expect("read-only");
    let superuser = fs::write(directory.path().join("probe"), "").is_ok();
    let result = write(&directory.path().join("results"), &mut motion(3).into(), &EVERYTHING);
    fs::set_permissions(directory.path(), fs::Permissions::from_mode(0o755)).expect("writable");
    // Permissions do not bind the superuser, as whom containers run.
    if !superuser {
        assert!(matches!(result, Err(OutputError::Directory { .. })), "{result:?}");
        assert!(names(directory.path()).is_empty());
    }
}

#[test]
fn lists_that_do_not_fit_are_refused_before_anything_is_written() {
    let directory = tempfile::tempdir().expect("a directory");
    let results = directory.path().join("results");
    let mut t = motion(5);
    t.probes[1].samples.pop();
    let error = write(&results, &mut t.clone().into(), &EVERYTHING).expect_err("a sample is missing");
    assert_eq!(error.to_string(), "samples of probe `mid, of the arm`: expected 5 entries, found 4");
    assert!(!results.exists());
}

#[test]
fn the_page_is_self_contained_escaped_and_small() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut t = motion(400);
    for frame in &mut t.frames {
        frame.beams = vec![frame.beams[0].clone(); 12];
    }
    t.run.undeformed = vec![line("arm", 0.0); 12];
    t.last = vec![line("</script>", 0.7); 12];
    write(directory.path(), &mut t.clone().into(), &OutputOptions::default()).expect("written");
    let page = fs::read_to_string(directory.path().join("report.html")).expect("a page");
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
    assert_eq!(page.matches("</script>").count(), 2, "the data and the player, and no title or name");
    for outside in ["src=", "href=", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    let data = page.split_once("id=\"motion\">").and_then(|(_, rest)| rest.split_once("</script>"));
    let data: serde_json::Value = serde_json::from_str(data.expect("data").0).expect("JSON");
    let frames = data["frames"].as_array().expect("frames");
    assert!(frames.len() >= 100 && frames.len() == data["parameter"].as_array().expect("parameters").len());
}

#[test]
fn paraview_series_names_every_frame() {
    let directory = tempfile::tempdir().expect("a directory");
    write(directory.path(), &mut motion(5).into(), &EVERYTHING).expect("written");
    let index = fs::read_to_string(directory.path().join("states.pvd")).expect("an index");
    assert_eq!(index.matches("<DataSet ").count(), 5);
    for file in index.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        let grid = fs::read_to_string(directory.path().join(file)).expect("a frame");
        assert!(
            grid.contains("NumberOfPoints=\"101\" NumberOfCells=\"1\"") && grid.contains("displacement [m]")
        );
    }
}

#[test]
fn every_odd_trajectory_gives_files_or_an_error() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut odd: Vec<Results> = vec![Trajectory::default().into(), motion(1).into(), motion(2).into()];
    odd.extend([Vibrations::default().into(), CriticalLoads::default().into(), modal().into()]);
    for value in [f64::NAN, f64::INFINITY, f64::MAX, f64::MIN_POSITIVE] {
        let mut t = motion(3);
        t.parameter[1] = value;
        t.probes[0].samples[1].x = value;
        t.frames[1].beams[0][3] = [value, -value];
        t.last[0].curvature[7] = value;
        t.history[0].step = value;
        t.history[0].increments[0] = value;
        odd.push(t.into());
    }
    for (i, t) in odd.iter_mut().enumerate() {
        let results = directory.path().join(i.to_string());
        write(&results, t, &EVERYTHING).unwrap_or_else(|e| panic!("trajectory {i}: {e:?}"));
    }
}

#[test]
fn charts_refuse_what_cannot_be_drawn() {
    let chart = || {
        Chart::new("T", Axis::log("x"), Axis::linear("y")).with(Series::line(
            "a & b",
            vec![[1.0, 2.0]],
            PALETTE[0],
        ))
    };
    assert!(chart().svg().expect("drawn").contains("a &amp; b"));
    assert_eq!(chart().equal_aspect(300).svg(), Err(PlotError::EqualAspectNeedsLinear));
    assert_eq!(chart().sized(50, 50).svg(), Err(PlotError::TooSmall { width: 50, height: 50 }));
    // Hundreds of series leave room for the picture.
    let many = (0..300).fold(chart(), |chart, i| {
        chart.with(Series::line(format!("beam{i}"), vec![[1.0, 2.0], [2.0, 3.0]], PALETTE[1]))
    });
    assert!(many.svg().expect("drawn").matches("<polyline").count() >= 300);
    let both = grid(&[chart(), chart()], 2).expect("drawn");
    assert_eq!(both.matches("<svg ").count(), 3);
}

#[test]
fn equal_lengths_are_equal_in_the_picture() {
    // A square of side 3 far from the origin, in a picture much wider than high.
    let square = vec![[1e3, 5.0], [1003.0, 5.0], [1003.0, 8.0], [1e3, 8.0], [1e3, 5.0]];
    let chart = Chart::new("", Axis::linear("x"), Axis::linear("y")).sized(900, 300).equal_aspect(300);
    let svg = chart.with(Series::line("", square, PALETTE[1])).svg().expect("drawn");
    let drawn = svg.split("<polyline").find(|p| p.contains("#D55E00")).expect("the square");
    let points = drawn.split("points=\"").nth(1).and_then(|p| p.split('"').next()).expect("points");
    let corner: Vec<f64> =
        points.split_whitespace().flat_map(|p| p.split(',')).map(|c| c.parse().expect("a number")).collect();
    let (wide, high) = (corner[2] - corner[0], corner[3] - corner[5]);
    assert!(wide > 100.0 && (wide - high).abs() <= 2.0, "{wide} × {high}");
}

/// What a picture shows, a line each: texts with their places, curves by their number of points,
/// ends and extent, lines, marks, and their colours.
pub(super) fn elements(svg: &str) -> String {
    let mut lines = String::new();
    for element in svg.split('<').skip(1).filter(|element| !element.starts_with('/')) {
        let (tag, text) = element.split_once('>').unwrap_or((element, ""));
        let attribute = |name: &str| {
            let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
            rest.split_once('"').map(|(value, _)| value)
        };
        let mut line = tag.split_whitespace().next().unwrap_or_default().to_owned();
        for name in [
            "x",
            "y",
            "x1",
            "y1",
            "x2",
            "y2",
            "cx",
            "cy",
            "r",
            "width",
            "height",
            "stroke",
            "fill",
            "transform",
        ] {
            if let Some(value) = attribute(name).filter(|value| *value != "none" && *value != "#282828") {
                line += &format!(" {name} {value}");
            }
        }
        if let Some(points) = attribute("points") {
            let points: Vec<[i32; 2]> = points
                .split_whitespace()
                .filter_map(|point| point.split_once(','))
                .map(|(x, y)| [x, y].map(|c| c.parse().expect("a whole number")))
                .collect();
            let extent = |axis: usize| {
                let of = || points.iter().map(|point| point[axis]);
                [of().min().expect("points"), of().max().expect("points")]
            };
            let (first, last) = (points[0], points[points.len() - 1]);
            line += &format!(", {} points from {first:?} to {last:?}", points.len());
            if points.len() > 2 {
                line += &format!(" within {:?} {:?}", extent(0), extent(1));
            }
        }
        lines += &format!("{line} {}\n", text.trim());
    }
    lines
}

/// The pictures of a motion and of modes whose numbers are made up, so that no solver moves a
/// point: whoever changes how something is drawn sees here what it changes.
#[test]
fn regress_pictures() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut text = String::new();
    for (name, mut found) in [("motion", Results::from(motion(5))), ("modes", modal().into())] {
        let results = directory.path().join(name);
        write(&results, &mut found, &OutputOptions::default()).expect("written");
        for file in names(&results).iter().filter(|file| file.ends_with(".svg")) {
            let svg = fs::read_to_string(results.join(file)).expect("a picture");
            text += &format!("== {name}/{file}\n{}", elements(&svg));
        }
    }
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("pictures", text);
    });
}
