//! Axes as they are drawn: a mark lies where the ticks say, and the ticks are those that a reader
//! expects.

use super::picture::Picture;
use ancf::output::plot::{Axis, Chart, PALETTE, Series};

const BLUE: &str = "#0072B2";
/// Of the grid at the ticks, and between them.
const MESH: &str = "#E2E2E2";
const MINOR: &str = "#F1F1F1";

fn drawn(chart: &Chart) -> Picture {
    Picture::read(&chart.svg().expect("drawn"))
}

/// Places of grid lines of a colour across an axis.
fn grid_lines(picture: &Picture, colour: &str, axis: usize) -> Vec<f64> {
    let (own, other) = [("x1", "x2"), ("y1", "y2")][axis];
    let lines = picture.named("line").filter(|line| line.word("stroke") == colour);
    let across = lines.filter(|line| line.number(own) == line.number(other));
    across.map(|line| line.number(own)).collect()
}

/// Would catch an axis that is shifted, stretched or turned round, a logarithm too many, a power of
/// ten that is not told, and ticks beside their texts.
#[test]
fn marks_lie_where_the_ticks_say() {
    let points = [[0.3, 1.9], [0.7, 0.4], [1.1, 2.6], [2.9, 0.9]];
    let axis = |log: bool, label: &str| if log { Axis::log(label) } else { Axis::linear(label) };
    for logs in [[false, false], [false, true], [true, false], [true, true]] {
        for scales in [[1.0, 1.0], [3e-5, 2e7], [2e7, 3e-5], [1.0, 900.0]] {
            let points: Vec<[f64; 2]> = points.map(|[x, y]| [x * scales[0], y * scales[1]]).to_vec();
            let chart = Chart::new("", axis(logs[0], "x"), axis(logs[1], "y")).with(Series::points(
                "",
                points.clone(),
                PALETTE[0],
            ));
            let picture = drawn(&chart);
            let dots = picture.dots(BLUE);
            assert_eq!(dots.len(), points.len());
            for (dot, point) in dots.iter().zip(&points) {
                for (axis, key) in ["cx", "cy"].into_iter().enumerate() {
                    let expected = picture.place(axis, logs[axis], point[axis]);
                    let found = dot.number(key);
                    assert!((found - expected).abs() < 3.0, "{logs:?} {scales:?}: {found}, not {expected}");
                }
            }
            let [left, right, top, bottom] = picture.frame();
            for (axis, [low, high]) in [[left, right], [top, bottom]].into_iter().enumerate() {
                let ticks = picture.ticks()[axis].clone();
                assert!(ticks.len() > 1, "{ticks:?}");
                assert!(ticks.iter().all(|tick| (low - 1.0..=high + 1.0).contains(&tick.0)), "{ticks:?}");
                // The grid is drawn at the ticks.
                let mut lines = grid_lines(&picture, MESH, axis);
                lines.sort_by(f64::total_cmp);
                assert_eq!(lines, ticks.iter().map(|tick| tick.0).collect::<Vec<_>>());
            }
            // The data are in the middle of a linear axis, with a margin on both sides.
            if !logs[0] {
                let (first, last) = (dots[0].number("cx") - left, right - dots[3].number("cx"));
                assert!((first - last).abs() < 2.0 && first > 0.0, "{first} {last}");
                near(first / (right - left), 0.015 / 1.03, 1e-3);
            }
            if !logs[1] {
                let (lowest, highest) = (bottom - dots[1].number("cy"), dots[2].number("cy") - top);
                assert!((lowest - highest).abs() < 2.0 && lowest > 0.0, "{lowest} {highest}");
                near(lowest / (bottom - top), 0.06 / 1.12, 1e-3);
            }
        }
    }
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, not {expected}");
}

/// The least of 1, 2 and 5 × 10ᵏ that is not below.
fn round_step(least: f64) -> f64 {
    let mut steps = (-6..9).flat_map(|k| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(k)));
    steps.find(|step| *step >= least * (1.0 - 1e-9)).expect("a step")
}

/// Holds ticks against the step that their number allows, and against the ends of the range.
fn holds(picture: &Picture, axis: usize, [low, high]: [f64; 2], room: f64) {
    let [left, right, top, bottom] = picture.frame();
    let count = [right - left, bottom - top][axis] / room;
    assert!((count - count.round()).abs() > 5e-3, "another size makes this test clearer: {count}");
    let wide = round_step((high - low) / count.floor());
    // One tick tells no scale: then a third of the range has one.
    let inside = ((high / wide + 1e-9).floor() - (low / wide - 1e-9).ceil()) as i64;
    let step = if inside >= 1 { wide } else { round_step(0.3 * (high - low)) };
    let mut values: Vec<f64> = picture.ticks()[axis].iter().map(|tick| tick.1).collect();
    values.sort_by(f64::total_cmp);
    for pair in values.windows(2) {
        near((pair[1] - pair[0]) / step, 1.0, 1e-6);
    }
    // Multiples of the step, from one end to the other.
    assert!(values.iter().all(|v| (v / step - (v / step).round()).abs() < 1e-6), "{values:?} by {step}");
    let (first, last) = (values[0], values[values.len() - 1]);
    let within = 1e-6 * step;
    assert!(first >= low - within && first - step < low - within, "{low} to {high}: {values:?}");
    assert!(last <= high + within && last + step > high + within, "{low} to {high}: {values:?}");
}

/// Would catch steps that are not round, closer than their texts allow or wider than they need be.
#[test]
fn ticks_are_as_close_as_there_is_room_for() {
    for (width, height) in [(300, 190), (423, 300), (677, 411), (720, 380), (903, 517)] {
        for span in [0.9, 1.0, 1.05, 3.1, 4.7, 6.2, 7.7, 9.1, 10.5, 12.0] {
            let [x, y] = ["x", "y"].map(|label| Axis::linear(label).range(-0.3 * span, 0.7 * span));
            let picture = drawn(&Chart::new("", x, y).sized(width, height));
            let range = [-0.3 * span, 0.7 * span];
            // Room of 60 px along x and of 42 px along y, ten units a pixel.
            holds(&picture, 0, range, 600.0);
            holds(&picture, 1, range, 420.0);
        }
        // Seven characters of 7 px, and three between texts.
        for span in [0.08, 0.085, 0.09, 0.095, 0.1, 0.105, 0.11] {
            let x = Axis::linear("x").range(1000.0, 1000.0 + span);
            let picture = drawn(&Chart::new("", x, Axis::linear("y")).sized(width, height));
            holds(&picture, 0, [1000.0, 1000.0 + span], 700.0);
        }
    }
}

/// Would catch texts that do not tell two ticks apart, or that say another number.
#[test]
fn texts_of_ticks_say_their_values() {
    for (range, expected) in [
        ([0.0, 1.0], &["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"][..]),
        ([-3.0, 2.0], &["−3", "−2", "−1", "0", "1", "2"]),
        ([0.0, 0.001], &["0.0000", "0.0002", "0.0004", "0.0006", "0.0008", "0.0010"]),
        ([-2e-8, 0.0], &["−20", "−15", "−10", "−5", "0"]),
        ([0.0, 250_000.0], &["0", "50", "100", "150", "200", "250"]),
    ] {
        let y = Axis::linear("y").range(range[0], range[1]);
        let picture = drawn(&Chart::new("", Axis::linear("x"), y).sized(500, 330));
        let own = picture.named("text").filter(|text| text.word("text-anchor") == "end");
        assert_eq!(own.map(|text| text.text.as_str()).collect::<Vec<_>>(), expected);
        // By the texts the ticks are where the range says.
        let [_, _, top, bottom] = picture.frame();
        let size = range[1] - range[0];
        near(picture.value_at(1, bottom) / size, range[0] / size, 2e-3);
        near(picture.value_at(1, top) / size, range[1] / size, 2e-3);
    }
}

#[test]
fn a_logarithmic_axis_has_its_ticks_at_powers_of_ten() {
    // Two decades and a bit make three of them.
    let points = vec![[0.0, 0.02], [1.0, 7.0]];
    let chart = Chart::new("", Axis::linear("x"), Axis::log("y"))
        .sized(540, 300)
        .with(Series::points("", points, PALETTE[0]));
    let picture = drawn(&chart);
    let [_, _, top, bottom] = picture.frame();
    let values: Vec<f64> = picture.ticks()[1].iter().map(|tick| tick.1).collect();
    assert_eq!(values, [10.0, 1.0, 0.1, 0.01]);
    // From one rim to the other, each as far from the next.
    for (i, tick) in picture.ticks()[1].iter().enumerate() {
        near(tick.0, top + (bottom - top) * i as f64 / 3.0, 1.0);
    }
    // Between them fainter lines at 2 to 9 of each.
    let mut minor = grid_lines(&picture, MINOR, 1);
    minor.sort_by(f64::total_cmp);
    let mut expected: Vec<f64> = (0..3)
        .flat_map(|decade| (2..10).map(move |digit| f64::from(digit) * 10_f64.powi(decade - 2)))
        .map(|value| picture.place(1, true, value))
        .collect();
    expected.sort_by(f64::total_cmp);
    assert_eq!(minor.len(), expected.len());
    for (found, expected) in minor.into_iter().zip(expected) {
        near(found, expected, 1.5);
    }
}

/// Of whole numbers only whole ones have ticks.
#[test]
fn whole_numbers_have_whole_ticks() {
    let whole = |label: &str| Axis::linear(label).whole();
    let points = vec![[1.0, 0.0], [3.0, 2.0]];
    let chart = Chart::new("", whole("x"), whole("y")).with(Series::points("", points, PALETTE[0]));
    let [x, y] = drawn(&chart).ticks().map(|ticks| ticks.iter().map(|tick| tick.1).collect::<Vec<_>>());
    assert_eq!((x, y), (vec![1.0, 2.0, 3.0], vec![2.0, 1.0, 0.0]));
}

/// What is zero to the reader spans the axis, and what does not change is shown against zero.
#[test]
fn noise_and_constants_have_an_axis_that_says_so() {
    let shown = |axis: Axis, values: [f64; 3]| {
        let points = values.iter().enumerate().map(|(i, &v)| [i as f64, v]).collect();
        let picture =
            drawn(&Chart::new("", Axis::linear("x"), axis).with(Series::points("", points, PALETTE[0])));
        let [_, _, top, bottom] = picture.frame();
        [bottom, top].map(|place| picture.value_at(1, place))
    };
    for (axis, values, [low, high]) in [
        (Axis::linear("y").negligible(1e-9), [3e-13, -8e-12, 0.0], [-1e-9, 1e-9]),
        (Axis::linear("y").negligible(1e-9), [1e-9, -1e-9, 0.0], [-1e-9, 1e-9]),
        (Axis::linear("y"), [0.0; 3], [-1.0, 1.0]),
        (Axis::linear("y"), [-8.0; 3], [-10.0, 0.0]),
        (Axis::linear("y"), [4.0, 4.000_001, 4.0], [0.0, 5.0]),
    ] {
        let found = shown(axis, values);
        let size = high - low;
        near((found[0] - low) / size, 0.0, 3e-3);
        near((found[1] - high) / size, 0.0, 3e-3);
    }
}
