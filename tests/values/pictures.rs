//! Plots and the moving picture, read back: what is drawn is what the tables hold.

use super::{Written, near};

/// A chart of `svg`: polylines by colour in the units of its axes, by the texts and places of their
/// ticks.
struct Drawn {
    x: [f64; 2],
    y: [f64; 2],
    lines: Vec<(String, Vec<[f64; 2]>)>,
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let found = tag.split_once(&format!(" {name}=\"")).and_then(|(_, rest)| rest.split_once('"'));
    found.unwrap_or_else(|| panic!("no {name} in {tag}")).0
}

/// Offset and slope of the line through (place, value) of the first and the last tick.
fn scale(mut ticks: Vec<(f64, f64)>) -> [f64; 2] {
    ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
    let slope = (last.1 - first.1) / (last.0 - first.0);
    for (place, value) in &ticks {
        assert!(
            (first.1 + slope * (place - first.0) - value).abs() <= 0.02 * (last.1 - first.1).abs(),
            "{ticks:?}"
        );
    }
    [first.1 - slope * first.0, slope]
}

impl Drawn {
    fn read(svg: &str) -> Self {
        let (mut horizontal, mut vertical, mut factor) = (Vec::new(), Vec::new(), 1.0);
        for text in svg.split("<text").skip(1) {
            let Some((tag, words)) =
                text.split_once('>').and_then(|(tag, rest)| Some((tag, rest.split_once('<')?.0)))
            else {
                continue;
            };
            let words = words.trim().replace('−', "-");
            if let Some(power) = words.strip_prefix("× 10") {
                let digits: String = power
                    .chars()
                    .map(|c| match "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|s| s == c) {
                        Some(digit) => char::from_digit(digit as u32, 10).expect("a digit"),
                        None => '-',
                    })
                    .collect();
                factor = format!("1e{digits}").parse().expect("a power of ten");
            }
            let Ok(value) = words.parse::<f64>() else { continue };
            let place = |name: &str| attribute(tag, name).parse::<f64>().expect("a place");
            match attribute(tag, "text-anchor") {
                "end" => vertical.push((place("y"), value)),
                _ => horizontal.push((place("x"), value)),
            }
        }
        // The texts of ticks stand a little beside them; all by as much.
        let lines = svg.split("<polyline").skip(1).map(|tag| {
            let numbers = attribute(tag, "points").split([' ', ',']).filter(|n| !n.is_empty());
            let numbers: Vec<f64> = numbers.map(|n| n.parse().expect("a number")).collect();
            (attribute(tag, "stroke").to_owned(), numbers.as_chunks::<2>().0.to_vec())
        });
        let vertical = vertical.into_iter().map(|(place, value)| (place, factor * value)).collect();
        Self { x: scale(horizontal), y: scale(vertical), lines: lines.collect() }
    }

    /// The longest line of this colour, in the units of the axes.
    fn line(&self, colour: &str) -> Vec<[f64; 2]> {
        let own = self.lines.iter().filter(|(stroke, _)| stroke == colour);
        let longest = own.max_by_key(|(_, points)| points.len());
        let (_, points) = longest.unwrap_or_else(|| panic!("no line {colour}"));
        points.iter().map(|[x, y]| [self.x[0] + self.x[1] * x, self.y[0] + self.y[1] * y]).collect()
    }
}

/// Holds a drawn line against a table's columns: every column's value at every place that is drawn.
fn follows(drawn: &[[f64; 2]], x: &[f64], y: &[f64], what: &str) {
    let extent = |values: &[f64]| {
        let (low, high) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        (high - low).max(high.abs()).max(low.abs())
    };
    let (wide, high) = (extent(x), extent(y));
    assert!(drawn.len() > 1 && wide > 0.0 && high > 0.0, "{what}");
    for point in drawn {
        let nearest = x
            .iter()
            .zip(y)
            .map(|(x, y)| ((x - point[0]) / wide).hypot((y - point[1]) / high))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.02, "{what}: {point:?} is drawn {nearest} away from the table");
    }
    // The same ends, so that it is not a part alone.
    for (end, i) in [(drawn[0], 0), (drawn[drawn.len() - 1], x.len() - 1)] {
        near(end[0] / wide, x[i] / wide, 0.02, what);
        near(end[1] / high, y[i] / high, 0.02, what);
    }
}

const BLUE: &str = "#0072B2";

/// A beam that a force bends and pulls, so that curvature falls and strain rises along it. Would
/// catch one quantity that is drawn for another, and axes with other numbers.
#[test]
fn plots_along_a_beam_draw_the_columns_of_the_table() {
    let text = "beam.arm = { start = [0, 0], end = [2, 0], axial_stiffness = 300, bending_stiffness = 2, basis.ancf.elements = 16 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [0, 1.5] }]
        analysis.static.steps = 4\n";
    let found = Written::of(text);
    let column = |name: &str| found.column("shape.csv", name);
    for (picture, x, y) in
        [("curvature.svg", "s", "curvature"), ("strain.svg", "s", "strain"), ("shape.svg", "x", "y")]
    {
        let drawn = Drawn::read(&found.text(picture));
        follows(&drawn.line(BLUE), &column(x), &column(y), picture);
    }
}

/// Would catch x for y, a velocity for a place, degrees for radians, and the work that is drawn as
/// what is lost.
#[test]
fn plots_over_time_draw_the_columns_of_the_tables() {
    let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 50, mass_per_length = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -5]
        effect.moment = [{ beam = 'arm', at = 'start', value = 1 }]
        effect.torsion_spring = [{ beam = 'arm', at = 'start', damping = 0.3 }]
        probe = [{ name = 'end', beam = 'arm', at = 'end' }]
        analysis.dynamic = { duration = 1, output_every = 0.02, radau.tolerance = 1e-6 }\n";
    let found = Written::of(text);
    let time = found.column("probes.csv", "time");
    let probe = |name: &str| found.column("probes.csv", name);
    for (picture, values) in [
        ("position.svg", probe("end.x")),
        ("velocity.svg", probe("end.vx")),
        ("angle.svg", probe("end.angle").iter().map(|a| a.to_degrees()).collect()),
        ("energy.svg", found.column("energy.csv", "bend")),
    ] {
        let drawn = Drawn::read(&found.text(picture));
        if picture != "energy.svg" {
            follows(&drawn.line(BLUE), &time, &values, picture);
        }
    }
    // Each energy in its colour.
    let drawn = Drawn::read(&found.text("energy.svg"));
    let energies = |name: &str| found.column("energy.csv", name);
    for (colour, name) in
        [("#D55E00", "kinetic"), ("#CC79A7", "potential"), ("#E69F00", "work"), ("#966E3C", "lost")]
    {
        let high = energies("kinetic").iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let line = drawn.line(colour);
        let end = line[line.len() - 1];
        near(end[0], 1.0, 0.03, name);
        near(end[1] / high, found.last("energy.csv", name) / high, 0.05, name);
    }
}

/// The data of the moving picture: whole cells from an origin, frame by frame the places of
/// `states.csv`. Would catch another origin, another cell, times by number, and x for y.
#[test]
fn the_moving_picture_shows_the_states_of_the_table() {
    let text = "beam.arm = { start = [3, 1], end = [4, 1.5], axial_stiffness = 1e4, bending_stiffness = 5, mass_per_length = 1, basis.ancf.elements = 4 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -5]
        effect.contact = [{ beam = 'arm', half_plane = { point = [3.5, -5], normal = [0, 1] }, stiffness = 10 }]
        output.states = true
        analysis.dynamic = { duration = 0.8, output_every = 0.1, radau.tolerance = 1e-6 }\n";
    let found = Written::of(text);
    let page = found.text("report.html");
    let data = page.split_once("id=\"motion\">").and_then(|(_, rest)| rest.split_once("</script>"));
    let data: serde_json::Value = serde_json::from_str(data.expect("data").0).expect("JSON");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let (origin, cell) = (
        ["/origin/0", "/origin/1"].map(|p| number(data.pointer(p).expect("a place"))),
        number(&data["cell"]),
    );
    let place = |value: &serde_json::Value, axis: usize| origin[axis] + cell * number(value);
    let [time, x, y] = ["time", "x", "y"].map(|name| found.column("states.csv", name));
    let frames = data["frames"].as_array().expect("frames");
    let times: Vec<f64> = data["parameter"].as_array().expect("times").iter().map(number).collect();
    assert_eq!((frames.len(), times.len()), (9, 9));
    for (i, (frame, at)) in frames.iter().zip(times).enumerate() {
        let line = frame[0].as_array().expect("a line");
        assert_eq!(line.len(), 202);
        for j in 0..101 {
            near(at, time[101 * i + j], 1e-12, "time");
            near(place(&line[2 * j], 0), x[101 * i + j], 0.51 * cell, "x");
            near(place(&line[2 * j + 1], 1), y[101 * i + j], 0.51 * cell, "y");
        }
    }
    // At rest the beam is where the scene has it, and fills some part of the picture.
    let rest = data["rest"][0].as_array().expect("a line");
    for (i, value) in [(0, 3.0), (1, 1.0), (rest.len() - 2, 4.0), (rest.len() - 1, 1.5)] {
        near(place(&rest[i], i % 2), value, 0.51 * cell, "at rest");
    }
    for axis in 0..2 {
        let size = number(&data["size"][axis]);
        let within = rest.iter().skip(axis).step_by(2).all(|v| (0.0..=size).contains(&number(v)));
        assert!(within && size > 1000.0, "the picture holds the beam: {size}");
    }
    assert_eq!((data["name"].as_str(), data["unit"].as_str()), (Some("time"), Some("s")));
}
