//! The data of the moving picture: places as whole cells of a grid.

use super::made_up::{beam, change, level, rise};
use super::written;
use ancf::results::{
    AnalysisKind, BucklingMode, CriticalLoads, Frame, Results, Run, Trajectory, Vibration, Vibrations,
};
use serde_json::{Value, json};

/// The data in the page; nothing where nothing moves.
fn movie(results: &(impl Clone + Into<Results>)) -> Option<Value> {
    let files = written(results);
    let page = &files["report.html"];
    let data = page.split_once("id=\"motion\">").and_then(|(_, rest)| rest.split_once("</script>"));
    assert_eq!(data.is_some(), page.contains("id=\"player\""), "a player has something to play");
    data.map(|(data, _)| serde_json::from_str(data).expect("JSON"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

fn frame(parameter: f64, points: &[[f64; 2]]) -> Frame {
    Frame { parameter, beams: vec![points.to_vec()] }
}

fn near(found: &Value, expected: f64) {
    let found = number(found);
    assert!((found - expected).abs() <= 1e-12, "{found}, not {expected}");
}

/// A load path whose picture is 2 m wide and 1 m high: cells of 0.25 mm from its lower left corner.
fn climb() -> Trajectory {
    Trajectory {
        run: Run {
            analysis: AnalysisKind::Static,
            undeformed: vec![beam("arm", 2.0, &[[1.0, 2.0], [3.0, 2.0]])],
            ..rise(2).run
        },
        parameter: vec![0.5, 1.0],
        probes: Vec::new(),
        frames: vec![frame(0.5, &[[1.0, 2.0], [3.0, 2.5]]), frame(1.0, &[[1.0, 2.0], [2.5, 3.0]])],
        ..rise(2)
    }
}

/// Would catch another origin, another cell, x for y, and the rest or a frame in another's place.
#[test]
fn places_are_cells_from_the_lower_left_corner() {
    let data = movie(&climb()).expect("a movie");
    assert_eq!(data["vibration"], json!(false));
    near(&data["origin"][0], 1.0);
    near(&data["origin"][1], 2.0);
    near(&data["cell"], 2.0 / 8000.0);
    assert_eq!(data["size"], json!([8000, 4000]));
    assert_eq!(data["parameter"], json!([0.5, 1.0]));
    assert_eq!(data["ground"], json!([]));
    assert_eq!(data["rest"], json!([[0, 0, 8000, 0]]));
    assert_eq!(data["frames"], json!([[[0, 0, 8000, 2000]], [[0, 0, 6000, 4000]]]));
}

/// The last state does not move a picture that the frames and the rest decide, nor does what is not
/// finite.
#[test]
fn only_what_can_be_seen_decides_the_window() {
    let mut trajectory = climb();
    trajectory.last = vec![level(77.0)];
    trajectory.frames[0].beams[0].extend([[f64::NAN, 50.0], [-50.0, f64::INFINITY]]);
    let data = movie(&trajectory).expect("a movie");
    near(&data["origin"][0], 1.0);
    near(&data["origin"][1], 2.0);
    assert_eq!(data["size"], json!([8000, 4000]));
    assert_eq!(data["frames"][1], json!([[0, 0, 6000, 4000]]));
}

/// Obstacles belong to the picture as far as a quarter of the beams' extent around them.
#[test]
fn ground_near_the_beams_is_in_the_picture() {
    let mut trajectory = climb();
    // 4 m by 1 m: a metre around them.
    trajectory.run.undeformed = vec![beam("arm", 4.0, &[[0.0, 0.0], [4.0, 0.0]])];
    trajectory.frames = vec![frame(1.0, &[[0.0, 0.0], [4.0, 1.0]])];
    trajectory.parameter = vec![0.5, 1.0];
    trajectory.run.outlines =
        vec![vec![[8.0, -0.5], [5.0, 0.5], [-0.5, -0.75]], vec![[2.0, -1.0], [-0.5, 2.5]]];
    let data = movie(&trajectory).expect("a movie");
    let cell = 5.5 / 8000.0;
    near(&data["cell"], cell);
    near(&data["origin"][0], -0.5);
    near(&data["origin"][1], -1.0);
    let line = |points: &[[f64; 2]]| {
        let cells = points.iter().flat_map(|p| [(p[0] + 0.5) / cell, (p[1] + 1.0) / cell]);
        cells.map(|c| c.round() as i64).collect::<Vec<_>>()
    };
    assert_eq!(data["size"], json!(line(&[[5.0, 1.0]])));
    // What is farther away is drawn as far as the picture reaches.
    assert_eq!(data["ground"], json!([line(&trajectory.run.outlines[0]), line(&trajectory.run.outlines[1])]));
    assert_eq!(data["frames"], json!([[line(&[[0.0, 0.0], [4.0, 1.0]])]]));
}

/// Vibrations swing to both sides of the rest, of which the modes show one: as far as a tenth of
/// the longest beam.
#[test]
fn vibrations_have_room_on_both_sides() {
    let bent = |height: f64| vec![beam("arm", 2.0, &[[0.0, 0.0], [2.0, height]])];
    let states = |analysis| Trajectory {
        run: Run { analysis, complete: true, undeformed: bent(44.0), ..Run::default() },
        last: bent(0.0),
        frames: vec![frame(0.0, &[[99.0, 99.0]])],
        ..Trajectory::default()
    };
    let shape = |height: f64| change(&bent(0.0), &bent(height));
    let modes = [(3.5, 7.0), (4.5, -1e-3)].map(|(frequency, height)| Vibration {
        frequency,
        round_off: 0.0,
        shape: shape(height),
    });
    let equilibrium = states(AnalysisKind::Modal);
    let data = movie(&Vibrations { equilibrium, modes: modes.into() }).expect("a movie");
    assert_eq!(data["vibration"], json!(true));
    near(&data["cell"], 2.0 / 8000.0);
    // 0.22 of the longer side above and below, a tenth of it on the left and on the right; from the
    // lowest place of any mode to the highest, each 0.1 of the length of 2 m from the rest.
    near(&data["origin"][0], -0.2);
    near(&data["origin"][1], -0.64);
    assert_eq!(data["size"], json!([9600, 5120]));
    assert_eq!(data["rest"], json!([[800, 2560, 8800, 2560]]));
    assert_eq!(data["frames"], json!([[[800, 2560, 8800, 3360]], [[800, 2560, 8800, 1760]]]));
    assert_eq!(data["parameter"], json!([3.5, 4.5]));
    let modes = vec![BucklingMode { load_factor: 7.0, round_off: 0.0, shape: shape(1.0) }];
    let data = movie(&CriticalLoads { unloaded: states(AnalysisKind::Buckling), modes }).expect("a movie");
    assert_eq!((&data["vibration"], &data["parameter"]), (&json!(true), &json!([7.0])));
    assert_eq!(data["frames"], json!([[[800, 1760, 8800, 2560]]]));
}

#[test]
fn the_parameter_has_its_name_and_unit() {
    let of = |analysis| Trajectory { run: Run { analysis, ..rise(2).run }, ..rise(2) };
    let shape = change(&[level(0.0)], &[level(0.3)]);
    let vibration = Vibration { frequency: 1.0, round_off: 0.0, shape: shape.clone() };
    let mode = BucklingMode { load_factor: 1.0, round_off: 0.0, shape };
    let modal = Vibrations { equilibrium: of(AnalysisKind::Modal), modes: vec![vibration] };
    let buckling = CriticalLoads { unloaded: of(AnalysisKind::Buckling), modes: vec![mode] };
    for (results, name, unit) in [
        (Results::from(of(AnalysisKind::Static)), "load factor", ""),
        (of(AnalysisKind::Dynamic).into(), "time", "s"),
        (modal.into(), "frequency of mode", "Hz"),
        (buckling.into(), "load factor of mode", ""),
    ] {
        let data = movie(&results).expect("a movie");
        assert_eq!((&data["name"], &data["unit"]), (&json!(name), &json!(unit)));
    }
}

/// A picture without extent, or of more than numbers hold, does not move.
#[test]
fn what_does_not_move_has_no_player() {
    let of = |points: &[[f64; 2]]| {
        let shape = beam("arm", 1.0, points);
        movie(&Trajectory {
            run: Run { undeformed: vec![shape.clone()], ..rise(2).run },
            frames: vec![frame(0.0, points)],
            last: vec![shape],
            probes: Vec::new(),
            ..rise(2)
        })
    };
    assert_eq!(movie(&Trajectory { frames: Vec::new(), ..rise(2) }), None);
    assert_eq!(of(&[[3.0, 4.0], [3.0, 4.0]]), None);
    assert_eq!(of(&[[f64::NAN, 4.0], [3.0, f64::INFINITY]]), None);
    assert_eq!(of(&[[-1.7e308, 0.0], [1.7e308, 0.0]]), None);
    assert!(of(&[[3.0, 4.0], [3.0, 4.0 + 1e-3]]).is_some());
    // The rest alone has an extent.
    let empty = Frame { parameter: 0.0, beams: vec![Vec::new()] };
    let data = movie(&Trajectory { frames: vec![empty], ..rise(2) }).expect("a movie");
    assert_eq!((&data["frames"], &data["size"]), (&json!([[[]]]), &json!([8000, 0])));
}

/// A page does not hold more than some 200 000 coordinates: first every second frame, as long as a
/// hundred stay, then every third point, and always the last.
#[test]
fn very_many_states_are_thinned_evenly() {
    let points: Vec<[f64; 2]> = (0..=2500).map(|i| [f64::from(i), 0.0]).collect();
    let frames: Vec<Frame> = (0..200).map(|i| frame(f64::from(i), &points)).collect();
    let many = Trajectory { run: Run { undeformed: vec![level(0.0)], ..rise(1).run }, frames, ..rise(1) };
    let data = movie(&many).expect("a movie");
    let parameter: Vec<f64> = data["parameter"].as_array().expect("times").iter().map(number).collect();
    let mut expected: Vec<f64> = (0..200).step_by(2).map(f64::from).collect();
    expected.push(199.0);
    assert_eq!(parameter, expected);
    assert_eq!(data["frames"].as_array().map(Vec::len), Some(101));
    let line = data["frames"][7][0].as_array().expect("a line");
    let metres: Vec<f64> = line.iter().step_by(2).map(|c| (number(c) * 2500.0 / 8000.0).round()).collect();
    let mut expected: Vec<f64> = (0..=2500).step_by(3).map(f64::from).collect();
    expected.push(2500.0);
    assert_eq!(metres, expected);
    // Few frames all stay, and few points.
    let all = Trajectory { frames: many.frames[..99].to_vec(), ..many.clone() };
    let data = movie(&all).expect("a movie");
    assert_eq!(data["frames"].as_array().map(Vec::len), Some(99));
    assert_eq!(data["frames"][0][0].as_array().map(Vec::len), Some(2 * (834 + 1)));
    let few = movie(&rise(150)).expect("a movie");
    assert_eq!(few["frames"].as_array().map(Vec::len), Some(150));
}

/// Mode shapes have about a hundred points, and their ends.
#[test]
fn modes_are_thinned_to_their_ends() {
    for (points, kept) in [(101, 101), (102, 52), (201, 101), (202, 102), (303, 102)] {
        let line: Vec<[f64; 2]> = (0..points).map(|i| [i as f64, 0.0]).collect();
        let shapes = vec![beam("arm", 1.0, &line)];
        let equilibrium = Trajectory {
            run: Run { analysis: AnalysisKind::Modal, undeformed: shapes.clone(), ..Run::default() },
            last: shapes.clone(),
            ..Trajectory::default()
        };
        let modes = vec![Vibration { frequency: 1.0, round_off: 0.0, shape: change(&shapes, &shapes) }];
        let data = movie(&Vibrations { equilibrium, modes });
        let data = data.expect("a movie");
        for line in [&data["rest"][0], &data["frames"][0][0]] {
            let line = line.as_array().expect("a line");
            assert_eq!(line.len(), 2 * kept, "of {points}");
            // From the left margin, a tenth of the length, to the right one.
            assert_eq!([number(&line[0]), number(&line[line.len() - 2])], [800.0, 8800.0]);
        }
    }
}
