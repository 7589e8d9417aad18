//! Drawings of the report, as SVG.

use plotters::prelude::*;
use plotters::style::RGBColor;

use ancf_check::case::Line;

use crate::Failure;

/// One curve of a drawing.
pub struct Trace {
    /// Name in the legend.
    pub label: String,
    /// Points.
    pub points: Vec<(f64, f64)>,
    /// Appearance.
    pub line: Line,
    /// Number of the colour.
    pub color: usize,
}

/// A drawing with its legend.
pub struct Drawing {
    /// `<svg>…</svg>`.
    pub svg: String,
    /// Colour, whether dashed or dotted, and name.
    pub legend: Vec<Entry>,
}

/// A line of a legend.
pub struct Entry {
    /// `#rrggbb`.
    pub color: String,
    /// Dash pattern of the sample, as in SVG.
    pub dash: &'static str,
    /// Name.
    pub label: String,
}

/// What a drawing looks like.
pub struct Frame<'a> {
    /// Label of the horizontal axis.
    pub x: &'a str,
    /// Label of the vertical axis.
    pub y: &'a str,
    /// True aspect ratio.
    pub equal: bool,
    /// Logarithmic horizontal, vertical axis.
    pub logarithmic: (bool, bool),
}

const PALETTE: [RGBColor; 8] = [
    RGBColor(31, 95, 191),
    RGBColor(209, 73, 31),
    RGBColor(30, 138, 90),
    RGBColor(138, 79, 191),
    RGBColor(184, 134, 11),
    RGBColor(15, 138, 157),
    RGBColor(194, 53, 127),
    RGBColor(40, 40, 40),
];

const WIDTH: f64 = 540.0;
/// What axes and labels take of the width and of the height.
const BORDER: (f64, f64) = (86.0, 62.0);
/// The library rounds to whole pixels; it draws this many times larger, and the page shows it at its size.
const FINE: u32 = 8;

/// Draws curves. Points that cannot be drawn (not finite, or not positive on a logarithmic axis) are left out.
pub fn draw(frame: &Frame, traces: &[Trace]) -> Result<Drawing, Failure> {
    let map = |v: f64, logarithmic: bool| if logarithmic { v.log10() } else { v };
    let drawn: Vec<Vec<(f64, f64)>> = traces
        .iter()
        .map(|t| {
            let mapped =
                t.points.iter().map(|&(x, y)| (map(x, frame.logarithmic.0), map(y, frame.logarithmic.1)));
            mapped.filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
        })
        .collect();
    let all = || drawn.iter().flatten();
    if all().next().is_none() {
        return Err("there is nothing to draw".into());
    }
    let mut xs = range(all().map(|p| p.0));
    let mut ys = range(all().map(|p| p.1));
    let inner = WIDTH - BORDER.0;
    let mut height = 270.0;
    if frame.equal {
        let natural = inner * (ys.1 - ys.0) / (xs.1 - xs.0);
        height = natural.clamp(120.0, 440.0);
        let wanted = height / inner;
        if (ys.1 - ys.0) / (xs.1 - xs.0) > wanted {
            widen(&mut xs, (ys.1 - ys.0) / wanted);
        } else {
            widen(&mut ys, (xs.1 - xs.0) * wanted);
        }
    }
    let size = (WIDTH as u32 * FINE, (height + BORDER.1) as u32 * FINE);

    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .margin(8 * FINE)
            .x_label_area_size(46 * FINE)
            .y_label_area_size(70 * FINE)
            .build_cartesian_2d(xs.0..xs.1, ys.0..ys.1)?;
        let text = ("sans-serif", 13 * FINE).into_font().color(&RGBColor(60, 60, 60));
        let horizontal = |v: &f64| tick(*v, xs.1 - xs.0, frame.logarithmic.0);
        let vertical = |v: &f64| tick(*v, ys.1 - ys.0, frame.logarithmic.1);
        chart
            .configure_mesh()
            .x_desc(frame.x)
            .y_desc(frame.y)
            .x_labels(9)
            .y_labels(if height < 200.0 { 5 } else { 8 })
            .x_label_formatter(&horizontal)
            .y_label_formatter(&vertical)
            .label_style(text.clone())
            .axis_desc_style(text)
            .axis_style(RGBColor(120, 120, 120).stroke_width(FINE))
            .set_all_tick_mark_size(5 * FINE)
            .bold_line_style(RGBColor(225, 225, 225).stroke_width(FINE))
            .light_line_style(WHITE)
            .draw()?;
        for (trace, points) in traces.iter().zip(&drawn) {
            let color = color(trace.color);
            match trace.line {
                Line::Solid => {
                    chart
                        .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2 * FINE)))?;
                }
                Line::Dashed => {
                    chart.draw_series(DashedLineSeries::new(
                        points.iter().copied(),
                        6 * FINE,
                        5 * FINE,
                        color.stroke_width(3 * FINE / 2),
                    ))?;
                }
                Line::Points => {
                    chart.draw_series(
                        points.iter().map(|&p| Circle::new(p, 3 * FINE, color.stroke_width(FINE))),
                    )?;
                }
            }
        }
        root.present()?;
    }
    let mut legend: Vec<Entry> = Vec::new();
    for trace in traces {
        let RGBColor(r, g, b) = color(trace.color);
        let entry = Entry {
            color: format!("#{r:02x}{g:02x}{b:02x}"),
            dash: match trace.line {
                Line::Solid => "none",
                Line::Dashed => "5 4",
                Line::Points => "2 4",
            },
            label: trace.label.clone(),
        };
        if !legend.iter().any(|e| e.label == entry.label && e.color == entry.color) {
            legend.push(entry);
        }
    }
    Ok(Drawing { svg, legend })
}

fn color(number: usize) -> RGBColor {
    PALETTE.get(number % PALETTE.len()).copied().unwrap_or(BLACK)
}

/// Smallest and largest value with some room on both sides.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let room = if high - low > 1e-9 * high.abs().max(low.abs()) {
        0.05 * (high - low)
    } else {
        0.05 * high.abs().max(1e-12)
    };
    (low - room, high + room)
}

fn widen(range: &mut (f64, f64), to: f64) {
    let more = (to - (range.1 - range.0)) / 2.0;
    *range = (range.0 - more, range.1 + more);
}

/// Text of a tick. Logarithmic axes name whole decades alone.
fn tick(value: f64, span: f64, logarithmic: bool) -> String {
    if logarithmic {
        let decade = value.round();
        if (value - decade).abs() < 1e-6 {
            return format!("1e{decade}");
        }
        // an axis shorter than a decade needs its numbers all the same
        let number = 10f64.powf(value);
        return match (span < 1.5, (0.1..1000.0).contains(&number)) {
            (false, _) => String::new(),
            (true, true) => format!("{number:.1}"),
            (true, false) => format!("{number:.1e}"),
        };
    }
    let value = if value.abs() < 1e-9 * span { 0.0 } else { value };
    if !(1e-3..=1e5).contains(&span) {
        return format!("{value:.1e}");
    }
    let decimals = (1.0 - span.log10()).ceil().clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}
