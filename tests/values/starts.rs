//! Velocities at the start of a motion that are given at points of a beam: splines that are flat
//! where the direction is held, and where they may begin and end.

use super::near;
use ancf::results::ProbeSample;
use ancf::scene::parse;

/// A beam of 2 m whose middle and quarters are nodes, with its first velocities there.
fn starts(supports: &str, velocity: &str) -> Result<Vec<ProbeSample>, String> {
    let text = format!(
        "beam.rod = {{ start = [0, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 4 }}
         probe = [{{ name = 'quarter', beam = 'rod', at = 0.5 }}, {{ name = 'middle', beam = 'rod', at = 1 }}, \
         {{ name = 'rest', beam = 'rod', at = 1.5 }}]
         support = [{supports}]
         initial_velocity = [{velocity}]
         analysis.dynamic = {{ duration = 1e-4, output_every = 1e-4 }}\n"
    );
    let scene = parse("scene.toml", &text).map_err(|error| error.to_string())?;
    let found = scene.model().solve(scene.analysis()).map_err(|error| error.to_string())?;
    Ok(found.states().probes.iter().map(|probe| probe.samples[0]).collect())
}

fn held(at: &str, fix: &str) -> String {
    format!("{{ beam = 'rod', at = {at}, fix = {fix} }}")
}

/// Cubics from 0 to 1 over t = s/2: flat at the start 1.5 t² − 0.5 t³, at both ends 3 t² − 2 t³,
/// and straight where nothing holds the direction.
#[test]
fn velocities_are_flat_where_the_direction_is_held() {
    let rises = |t: f64| 1.5 * t * t - 0.5 * t.powi(3);
    let bell = |t: f64| 3.0 * t * t - 2.0 * t.powi(3);
    let (clamp, pin) = ("['x', 'y', 'angle']", "['x', 'y']");
    let up = "{ beam = 'rod', table = { s = [0, 2], vy = [0, 1] } }";
    let down = "{ beam = 'rod', table = { s = [0, 2], vy = ['1 m/s', 0] } }";
    let along = "{ beam = 'rod', table = { s = [0, 2], vx = [0, 1] } }";
    for (supports, velocity, axis, expected) in [
        (held("'start'", clamp), up, 1, [0.25, 0.5, 0.75].map(rises)),
        (held("'start'", "['x', 'y', 'gradient']"), up, 1, [0.25, 0.5, 0.75].map(rises)),
        (held("'start'", pin), up, 1, [0.25, 0.5, 0.75]),
        (String::new(), up, 1, [0.25, 0.5, 0.75]),
        (held("'end'", clamp), down, 1, [0.75, 0.5, 0.25].map(rises)),
        (held("'end'", "['angle']") + ", " + &held("'start'", clamp), up, 1, [0.25, 0.5, 0.75].map(bell)),
        (held("'start'", "['angle']"), along, 0, [0.25, 0.5, 0.75].map(rises)),
    ] {
        let found = starts(&supports, velocity).unwrap_or_else(|error| panic!("{error}\n{supports}"));
        for (sample, expected) in found.iter().zip(expected) {
            let velocity = [sample.vx, sample.vy].map(|v| v.expect("a velocity"));
            near(velocity[axis], expected, 1e-12, &format!("{supports}, {velocity:?}"));
            near(velocity[1 - axis], 0.0, 1e-12, &supports);
        }
    }
}

/// Several velocities add up, and both components of one table are read.
#[test]
fn velocities_of_one_beam_add_up() {
    let velocity = "{ beam = 'rod', value = [0.25, 0.5] }, { beam = 'rod', rotation = 2, about = [1, 3] }, \
        { beam = 'rod', polynomial = { vy = [0, 1] }, table = { s = [0, 2], vx = [0, 4], vy = [2, 0] } }";
    for (sample, s) in starts("", velocity).expect("a motion").iter().zip([0.5, 1.0, 1.5]) {
        // v + ω × (r − c) + s and the straight lines of the table.
        near(sample.vx.expect("a velocity"), 0.25 + 6.0 + 2.0 * s, 1e-12, "vx");
        near(sample.vy.expect("a velocity"), 0.5 + 2.0 * (s - 1.0) + s + 2.0 - s, 1e-12, "vy");
    }
}

/// A table goes from end to end to a billionth of the length, 2e-9 m.
#[test]
fn tables_of_velocities_go_from_end_to_end() {
    let of = |from: &str, to: &str| {
        starts("", &format!("{{ beam = 'rod', table = {{ s = [{from}, 1, {to}], vy = [0, 1, 2] }} }}"))
    };
    for (from, to) in [("0", "2"), ("1.9e-9", "2.0000000019"), ("-1.9e-9", "1.9999999981")] {
        let found = of(from, to).unwrap_or_else(|error| panic!("{error}"));
        near(found[1].vy.expect("a velocity"), 1.0, 1e-6, "the middle");
    }
    for (from, to) in [("2.1e-9", "2"), ("0", "2.0000000021"), ("0", "1.9999999979"), ("0", "1.5")] {
        let error = of(from, to).expect_err("not from end to end");
        assert!(
            error.contains("`s` must go from one end of the beam to the other, 0 to 2 m; found"),
            "{error}"
        );
    }
}
