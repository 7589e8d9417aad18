//! Charts as they are drawn: marks, legends, windows onto shapes, and several in one picture.

use super::picture::{Picture, digest};
use super::{show, snapshot};
use ancf::output::plot::{Axis, Chart, GREY, Mark, PALETTE, PlotError, Series, colour, grid};

const BLUE: &str = "#0072B2";

fn drawn(chart: &Chart) -> Picture {
    Picture::read(&chart.svg().expect("drawn"))
}

fn plain() -> Chart {
    Chart::new("", Axis::linear("x"), Axis::linear("y"))
}

/// Three points within a square of this size.
fn corner(size: f64) -> Vec<[f64; 2]> {
    vec![[0.0, 0.0], [0.7 * size, 0.4 * size], [size, size]]
}

/// Every way to draw a series, one behind the other in the legend.
fn marks() -> Chart {
    let mut chart = Chart::new("Every \"mark\" & < more", Axis::linear("x [m]"), Axis::linear("y [m]"))
        .with(Series::line("line", vec![[0.0, 0.0], [1.0, 0.3], [2.0, 0.1]], PALETTE[0]))
        .with(Series::dashed("dashed", vec![[0.0, 0.2], [0.5, 0.25]], PALETTE[1]))
        .with(Series::points("points", vec![[0.3, 0.3], [1.7, 0.35]], PALETTE[2]))
        .with(Series::new("circles", vec![[0.4, 0.3], [1.6, 0.35]], Mark::Circles, PALETTE[3]))
        .with(Series::new("crosses", vec![[0.5, 0.3], [1.5, 0.35]], Mark::Crosses, PALETTE[4]));
    chart = chart
        .with(Series::line("wide", vec![[0.2, 0.15], [1.9, 0.2]], GREY).size(3.3).opacity(0.25))
        .with(Series::points("faint", vec![[1.0, 0.05]], PALETTE[5]).size(4.1).opacity(0.5))
        .with(Series::new("open", vec![[1.1, 0.05]], Mark::Circles, PALETTE[6]).size(5.2).opacity(0.75))
        .with(Series::new("large", vec![[1.2, 0.05]], Mark::Crosses, PALETTE[7]).size(6.3).opacity(0.6))
        .with(Series::points("", vec![[1.3, 0.05]], PALETTE[0]));
    chart.separators = vec![-7.0, 0.25, 1.5, 99.0];
    chart
}

/// Whoever changes how a chart is laid out or drawn sees here what it changes.
#[test]
fn regress_charts() {
    let names = |chart: Chart, count: usize| {
        (0..count).fold(chart, |chart, i| {
            chart.with(Series::points(format!("series {i}"), corner(2.0 + i as f64), colour(i)))
        })
    };
    let mut logs =
        Chart::new("Two logarithms", Axis::log("length [m]"), Axis::log("error [m]")).sized(430, 330).with(
            Series::line("an error", vec![[1e-4, 3e-9], [1e-2, 2e-5], [-1.0, 1.0], [0.3, 1e-3]], PALETTE[0]),
        );
    logs.separators = vec![-1.0, 1e-3, 0.02];
    let small = Chart::new("Powers of ten", Axis::linear("x"), Axis::linear("y"))
        .sized(400, 260)
        .with(Series::line("", vec![[2e6, 3e-5], [7e6, -4e-5]], PALETTE[1]));
    let given =
        Chart::new("", Axis::linear("x").range(1000.0, 1000.09), Axis::linear("y").range(100.0, 103.2)).with(
            Series::dashed("beyond", vec![[1000.01, 99.0], [1000.02, 101.0], [1000.05, 103.0]], PALETTE[2]),
        );
    let nameless = Chart::new("", Axis::linear(""), Axis::linear("")).sized(160, 120);
    let log_span = Chart::new("", Axis::log("x").range(1e-12, 1.0), Axis::linear("")).sized(300, 130);
    let pictures = [
        ("every mark", marks().svg()),
        ("two logarithms", logs.svg()),
        ("powers of ten", small.svg()),
        ("given ranges", given.svg()),
        ("nothing", nameless.svg()),
        ("many decades", log_span.svg()),
        ("a legend of lines", names(plain().sized(300, 240), 9).svg()),
        (
            "a wide window",
            plain().equal_aspect(200).with(Series::line("", vec![[0.0, 5.0], [9.0, 5.3]], GREY)).svg(),
        ),
        (
            "a high window",
            plain().equal_aspect(310).with(Series::line("", vec![[1.0, 0.0], [2.0, 7.0]], GREY)).svg(),
        ),
        ("a window", plain().equal_aspect(620).with(Series::line("", corner(30.0), GREY)).svg()),
        (
            "a window on a point",
            plain().equal_aspect(300).with(Series::points("", vec![[3.0, 4.0]], GREY)).svg(),
        ),
        ("three in a grid", {
            let one =
                |size: f64, height| plain().sized(250, height).with(Series::line("", corner(size), GREY));
            grid(&[one(1.0, 160), one(2.0, 200), one(3.0, 150).sized(410, 150)], 2)
        }),
    ];
    let mut text = String::new();
    for (name, svg) in pictures {
        let svg = svg.expect("drawn");
        show(&format!("{name}.svg"), &svg);
        text += &format!("== {name}\n{}", digest(&svg));
    }
    snapshot("charts", &text);
}

#[test]
fn a_mark_is_as_large_and_as_faint_as_it_is_asked_to_be() {
    let picture = drawn(&marks());
    // Ten units a pixel; the second of each is the sample in the legend.
    let [line, sample] = picture.lines(BLUE)[..] else { panic!("a line and its sample") };
    assert_eq!((line.word("stroke-width"), sample.word("stroke-width")), ("18", "18"));
    assert_eq!(line.points().len(), 3);
    let faint = picture.dots("#56B4E9");
    assert_eq!(faint.len(), 2);
    for dot in faint {
        assert_eq!((dot.word("r"), dot.word("opacity")), ("41", "0.5"));
    }
    let open = |stroke: &str| {
        let found = picture.named("circle").filter(|circle| circle.word("stroke") == stroke);
        found
            .map(|c| ["r", "fill", "opacity", "stroke-width"].map(|key| c.word(key).to_owned()))
            .collect::<Vec<_>>()
    };
    assert_eq!(open("#CC79A7"), vec![["34", "none", "1", "13"].map(String::from); 3]);
    assert_eq!(open("#3C3C3C"), vec![["52", "none", "0.75", "13"].map(String::from); 2]);
    // A cross is two strokes from corner to corner.
    let strokes: Vec<_> = picture.named("line").filter(|line| line.word("stroke") == "#966E3C").collect();
    assert_eq!(strokes.len(), 4);
    for stroke in strokes {
        let extent = |from, to| (stroke.number(to) - stroke.number(from)).abs();
        assert_eq!((extent("x1", "x2"), extent("y1", "y2")), (126.0, 126.0));
        assert_eq!((stroke.word("opacity"), stroke.word("stroke-width")), ("0.6", "13"));
    }
    // Dashes of 6 px, and gaps of 4 px between them.
    let dashes = picture.lines("#D55E00");
    let (first, second) = (dashes[0].points(), dashes[1].points());
    let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    assert!((length(first[0], first[1]) - 60.0).abs() < 2.0, "{first:?}");
    assert!((length(first[1], second[0]) - 40.0).abs() < 2.0, "{first:?} {second:?}");
    // Separators within the plot, from its bottom to its top.
    let separators = picture.lines("#828282");
    let [_, right, top, bottom] = picture.frame();
    let faint: Vec<_> = separators.into_iter().filter(|line| line.word("opacity") == "0.35").collect();
    assert_eq!(faint.len(), 2);
    for (line, x) in faint.into_iter().zip([0.25, 1.5]) {
        let expected = picture.place(0, false, x);
        let points = line.points();
        assert!(points[0][0] == points[1][0] && (points[0][0] - expected).abs() < 3.0 && expected < right);
        assert_eq!([points[0][1], points[1][1]], [bottom, top]);
        assert_eq!(line.word("stroke-width"), "7");
    }
}

/// Would catch names without their samples, on each other, beyond the picture, or in its place.
#[test]
fn a_legend_names_the_series_in_lines_and_leaves_room_for_the_plot() {
    let chart = (0..8).fold(plain().sized(260, 200), |chart, i| {
        chart.with(Series::points(format!("series {i} of 8"), corner(2.0), colour(i)))
    });
    let picture = drawn(&chart);
    let names: Vec<_> = picture.named("text").filter(|text| text.text.starts_with("series")).collect();
    // Three lines of 20 px are three tenths of the picture; a fourth would be more.
    assert_eq!(names.len(), 3);
    let [_, _, top, _] = picture.frame();
    for (i, name) in names.iter().enumerate() {
        assert_eq!(name.text, format!("series {i} of 8"));
        assert_eq!((name.number("y"), name.number("x")), (180.0 + 200.0 * i as f64, names[0].number("x")));
        // Its sample stands before it, in its colour, and is no mark of the plot.
        let colours = [BLUE, "#D55E00", "#009E73"];
        let sample = picture.dots(colours[i])[3];
        assert_eq!((sample.number("cy"), sample.number("cx") + 90.0), (name.number("y"), name.number("x")));
        assert!(name.number("y") < top);
    }
    // A name that is too long for its line does not leave an empty one above it.
    let name = "a name of very many characters".repeat(3);
    let long = plain().sized(260, 200).with(Series::line(name.as_str(), corner(2.0), GREY));
    assert_eq!(drawn(&long).text(&name).number("y"), 180.0);
    // Side by side where there is room: 13 characters, their sample and gaps take 121 px.
    let picture = drawn(&chart.sized(720, 380));
    let names: Vec<_> = picture.named("text").filter(|text| text.text.starts_with("series")).collect();
    assert_eq!(names.len(), 8);
    for (i, name) in names.iter().enumerate() {
        let (line, place) = (i / 5, i % 5);
        assert_eq!(name.number("y"), 180.0 + 200.0 * line as f64);
        let expected = names[0].number("x") + 1210.0 * place as f64;
        assert!((name.number("x") - expected).abs() <= 1.0, "{i}: {}, not {expected}", name.number("x"));
    }
}

#[test]
fn pictures_too_small_for_their_labels_are_refused() {
    let empty = |width, height| Chart::new("", Axis::linear(""), Axis::linear("")).sized(width, height).svg();
    let small = |width, height| -> Result<String, PlotError> { Err(PlotError::TooSmall { width, height }) };
    assert!(empty(160, 120).is_ok());
    assert_eq!(empty(159, 120), small(159, 120));
    assert_eq!(empty(160, 119), small(160, 119));
    // Labels of eight characters take 56 px, a name of the axis 19 px, gaps and margin 32 px.
    let wide = |width| {
        Chart::new("", Axis::linear(""), Axis::linear("y").range(1e4, 10_000.05)).sized(width, 300).svg()
    };
    assert!(wide(167).is_ok());
    assert_eq!(wide(166), small(166, 300));
    // Title, legend, labels and name of the axis take 106 px.
    let high = |height| {
        let chart = Chart::new("T", Axis::linear("x"), Axis::linear("y")).sized(400, height);
        chart.with(Series::line("name", corner(1.0), GREY)).svg()
    };
    assert!(high(136).is_ok());
    assert_eq!(high(135), small(400, 135));
    for (x, y) in [(Axis::log("x"), Axis::linear("y")), (Axis::linear("x"), Axis::log("y"))] {
        let chart = Chart::new("", x, y).with(Series::line("", vec![[1.0, 1.0], [2.0, 2.0]], GREY));
        assert_eq!(chart.equal_aspect(300).svg(), Err(PlotError::EqualAspectNeedsLinear));
    }
}

/// A window onto a shape: would catch lengths that differ, margins on one side, a picture higher
/// than it may be, or too flat to be read.
#[test]
fn a_window_shows_the_whole_shape_in_proportion() {
    for (points, width, height) in [
        (vec![[0.0, 0.0], [9.0, 0.5]], 720, 620),
        (vec![[0.0, 0.0], [9.0, 6.0]], 720, 620),
        (vec![[0.0, 0.0], [9.0, 6.0]], 720, 240),
        (vec![[-1e3, 20.0], [-1003.0, 50.0]], 460, 300),
        (vec![[2e-5, 0.0], [5e-5, 1e-5]], 460, 300),
        (vec![[5.0, 3.0], [8.0, 3.0]], 900, 150),
        (vec![[5.0, 3.0], [5.0, 8.0]], 400, 300),
    ] {
        let chart = plain().sized(width, height).equal_aspect(height);
        let svg = chart.with(Series::points("", points.clone(), PALETTE[0])).svg().expect("drawn");
        let picture = Picture::read(&svg);
        let size = |key: &str| picture.elements[0].number(key);
        assert!(size("width") == f64::from(width) && size("height") <= f64::from(height), "{points:?}");
        let dots: Vec<[f64; 2]> =
            picture.dots(BLUE).iter().map(|dot| ["cx", "cy"].map(|key| dot.number(key))).collect();
        // As many units a metre along x, along y and, where there are two ticks, between these.
        let extent = |axis: usize| (points[0][axis] - points[1][axis]).abs();
        let drawn = |axis: usize| (dots[0][axis] - dots[1][axis]).abs();
        let longer = usize::from(extent(1) > extent(0));
        let scale = drawn(longer) / extent(longer);
        assert!((drawn(1 - longer) - scale * extent(1 - longer)).abs() <= 3.0, "{points:?}: {dots:?}");
        let ticks = picture.ticks();
        let steps: Vec<f64> =
            ticks.iter().filter(|ticks| ticks.len() > 1).map(|t| (t[1].1 - t[0].1).abs()).collect();
        assert!(!steps.is_empty() && steps.iter().all(|s| (s / steps[0] - 1.0).abs() < 1e-6), "{steps:?}");
        for pair in ticks.iter().flat_map(|ticks| ticks.windows(2)) {
            let (units, metres) = (pair[1].0 - pair[0].0, (pair[1].1 - pair[0].1).abs());
            assert!((units / metres / scale - 1.0).abs() < 0.01, "{points:?}: {ticks:?}");
            // Neither on each other nor farther apart than 2.5 times what is needed.
            assert!((590.0..1600.0).contains(&units), "{points:?}: {ticks:?}");
        }
        // In the middle, a twentieth of the longer side or more from every rim.
        let [left, right, top, bottom] = picture.frame();
        for (axis, [low, high]) in [[left, right], [top, bottom]].into_iter().enumerate() {
            let least = dots[0][axis].min(dots[1][axis]) - low;
            let most = high - dots[0][axis].max(dots[1][axis]);
            assert!((least - most).abs() <= 3.0, "{points:?}: {least} {most}");
            assert!(least >= 0.05 * drawn(longer) - 2.0, "{points:?}: {least}");
        }
        assert!(bottom - top >= 0.155 * (right - left) || size("height") >= f64::from(height) - 1.0);
    }
}

/// Would catch points beyond a given range that are drawn upon the labels, and points on its rim
/// that are not.
#[test]
fn what_lies_beyond_a_given_range_is_not_drawn() {
    let values = [0.5, 1.0 - 2.5e-9, 1.0 - 2e-9, 1.0, 2.0, 3.0, 3.0 + 2e-9, 3.0 + 2.5e-9, 3.5, f64::NAN];
    for axis in 0..2 {
        let points: Vec<[f64; 2]> =
            values.iter().map(|&v| if axis == 0 { [v, 5.0] } else { [5.0, v] }).collect();
        let (own, other) = (Axis::linear("").range(1.0, 3.0), Axis::linear("").range(0.0, 10.0));
        let (x, y) = if axis == 0 { (own, other) } else { (other, own) };
        let picture = drawn(&Chart::new("", x, y).with(Series::points("", points, PALETTE[0])));
        let dots = picture.dots(BLUE);
        let places: Vec<f64> = dots.iter().map(|dot| dot.number(["cx", "cy"][axis])).collect();
        let [left, right, top, bottom] = picture.frame();
        let [low, high] = [[left, right], [bottom, top]][axis];
        let middle = (0.5 * (low + high)).round();
        assert_eq!(places.len(), 5);
        assert_eq!([places[0], places[1], places[3], places[4]], [low, low, high, high]);
        assert!((places[2] - middle).abs() <= 1.0, "{places:?}");
    }
}

#[test]
fn lines_break_where_there_is_no_point() {
    let points = |gap: f64| vec![[1.0, 2.0], [2.0, 3.0], [3.0, gap], [4.0, 1.0], [5.0, 4.0], [6.0, 2.0]];
    for (axis, gap, parts) in [
        (Axis::linear("y"), f64::NAN, &[2_usize, 3][..]),
        (Axis::linear("y"), f64::INFINITY, &[2, 3]),
        (Axis::linear("y"), -1.0, &[6]),
        (Axis::log("y"), 0.0, &[2, 3]),
        (Axis::log("y"), -1.0, &[2, 3]),
        (Axis::log("y"), 0.1, &[6]),
        (Axis::linear("y").range(0.0, 5.0), 9.0, &[2, 3]),
    ] {
        let chart = Chart::new("", Axis::linear("x"), axis);
        let picture = drawn(&chart.with(Series::line("", points(gap), PALETTE[0])));
        let found: Vec<usize> = picture.lines(BLUE).iter().map(|line| line.points().len()).collect();
        assert_eq!(found, parts, "{gap}");
    }
}

/// Peaks of a line that is thinned are drawn as high as its others.
#[test]
fn a_line_of_very_many_points_keeps_its_peaks() {
    let mut points: Vec<[f64; 2]> = (0..20_000).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
    points[12_345][1] = 100.0;
    points[15_432][1] = -50.0;
    let picture = drawn(&plain().with(Series::line("", points, PALETTE[0])));
    let line = picture.lines(BLUE)[0].points();
    assert!((1000..3000).contains(&line.len()), "{}", line.len());
    for (x, y) in [(0.0, 0.0), (12_345.0, 100.0), (15_432.0, -50.0), (19_999.0, f64::from(19_999 % 7))] {
        let place = [picture.place(0, false, x), picture.place(1, false, y)];
        let near = line.iter().any(|p| (p[0] - place[0]).abs() <= 3.0 && (p[1] - place[1]).abs() <= 3.0);
        assert!(near, "{x} {y}");
    }
}

/// Would catch pictures on each other, a row as high as its lowest one, and a frame too small.
#[test]
fn a_grid_puts_pictures_side_by_side_and_rows_below_each_other() {
    let sizes = [(200, 150), (240, 180), (260, 130), (200, 120), (300, 160)];
    let charts: Vec<Chart> = sizes.iter().map(|&(width, height)| plain().sized(width, height)).collect();
    let svg = grid(&charts, 2).expect("drawn");
    let picture = Picture::read(&svg);
    let frames: Vec<_> = picture.named("svg").collect();
    let read = |key: &str| frames.iter().skip(1).map(|frame| frame.number(key)).collect::<Vec<_>>();
    assert_eq!(read("x"), [0.0, 200.0, 0.0, 260.0, 0.0]);
    assert_eq!(read("y"), [0.0, 0.0, 180.0, 180.0, 310.0]);
    assert_eq!(read("width"), [200.0, 240.0, 260.0, 200.0, 300.0]);
    assert_eq!(read("height"), [150.0, 180.0, 130.0, 120.0, 160.0]);
    // All in pixels outside, and in tenths of them inside.
    assert_eq!(frames[0].word("viewBox"), "0 0 460 470");
    assert_eq!((frames[0].word("width"), frames[0].word("height")), ("460", "470"));
    assert_eq!(frames[1].word("viewBox"), "0 0 2000 1500");
    assert_eq!(svg.matches("</svg>").count(), 6);
    // One below the other, where no number is asked for.
    let column = Picture::read(&grid(&charts[..2], 0).expect("drawn"));
    let places: Vec<_> = column.named("svg").skip(1).map(|svg| (svg.word("x"), svg.word("y"))).collect();
    assert_eq!(places, [("0", "0"), ("0", "150")]);
    let none = Picture::read(&grid(&[], 2).expect("drawn"));
    assert_eq!((none.elements.len(), none.elements[0].word("viewBox")), (1, "0 0 1 1"));
    let error = grid(&[plain(), plain().sized(50, 50)], 2);
    assert_eq!(error, Err(PlotError::TooSmall { width: 50, height: 50 }));
}

#[test]
fn titles_are_told_to_those_who_cannot_see() {
    let svg = Chart::new("a & b < \"c\"", Axis::linear("x"), Axis::linear("y")).svg().expect("drawn");
    assert!(svg.starts_with(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"720\" height=\"380\" viewBox=\"0 0 7200 3800\""
    ));
    assert!(svg.contains("role=\"img\" aria-label=\"a &amp; b &lt; &quot;c&quot;\">"));
    assert_eq!((svg.matches("<svg").count(), svg.matches("</svg>").count()), (1, 1));
    assert!(svg.ends_with("</svg>\n"));
}

#[test]
fn colours_begin_anew_after_the_last() {
    assert_eq!([0, 1, 7, 8, 9, 17].map(colour), [0, 1, 7, 0, 1, 1].map(|i| PALETTE[i]));
}
