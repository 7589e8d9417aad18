//! Error against time, both logarithmic.
//!
//! Every line of the diagram is a front, the settings that no other of the same line beats; all
//! settings have a mark. Ours has a line for every label, another code one for all that it can, which is
//! dashed. A ring is around what nothing in the diagram beats.

use ancf::output::plot::{Axis, Chart, GREY, Mark, PALETTE, PlotError, Series, colour};

use super::claim::on_front;
use super::decade::others;
use super::results::{Point, Results};

/// Size of the drawing \[px\], and what a row of the legend adds.
const SIZE: [u32; 2] = [820, 460];
const LEGEND_ROW: u32 = 20;

/// The diagram for one norm, as SVG.
///
/// # Errors
/// Where the drawing library refuses.
pub fn diagram(results: &Results, norm: &str) -> Result<String, PlotError> {
    let label = results.norm.get(norm).map_or(norm, |norm| norm.title.as_str());
    let mut lines: Vec<(&str, Vec<&Point>)> = Vec::new();
    for point in &results.points {
        let name = if point.code.is_ours() { point.line.as_str() } else { point.code.name() };
        match lines.iter_mut().find(|(line, _)| *line == name) {
            Some((_, points)) => points.push(point),
            None => lines.push((name, vec![point])),
        }
    }
    // A few codes beside many lines of ours: those count colours from the other end.
    let codes = others(&results.points);
    let rows = u32::try_from(lines.len() / 3).unwrap_or(0);
    let mut chart = Chart::new("", Axis::log("solve time [s]"), Axis::log(label))
        .sized(SIZE[0], SIZE[1] + LEGEND_ROW * rows);
    for (number, (line, points)) in lines.iter().enumerate() {
        let other = codes.iter().position(|code| points.iter().any(|point| point.code == *code));
        let (ours, number) = (other.is_none(), other.map_or(number, |k| PALETTE.len() - 1 - k));
        let (style, mark) = if ours { (Mark::Line, Mark::Points) } else { (Mark::Dashed, Mark::Crosses) };
        let front = places(points, norm, true);
        chart = chart.with(Series::new(*line, front, style, colour(number))).with(Series::new(
            "",
            places(points, norm, false),
            mark,
            colour(number),
        ));
    }
    let all: Vec<&Point> = results.points.iter().collect();
    chart
        .with(Series::new("beaten by nothing", places(&all, norm, true), Mark::Circles, GREY).size(6.0))
        .svg()
}

/// Time and error of points, by time; of all, or of those on their front.
fn places(points: &[&Point], norm: &str, front: bool) -> Vec<[f64; 2]> {
    let chosen = points.iter().zip(on_front(points, norm)).filter(|(_, on)| *on || !front);
    let mut places: Vec<_> =
        chosen.filter_map(|(point, _)| Some([point.seconds.median, *point.error.get(norm)?])).collect();
    places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    places
}
