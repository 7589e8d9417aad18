//! From the description of a plot to SVG text.

use std::fmt::Display;
use std::fmt::Write as _;

use plotters::chart::ChartContext;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use thiserror::Error;

use super::axis::{Ruler, nice};
use super::thin::thin;
use super::{Chart, Colour, GREY, Mark, Series};

/// Why a plot could not be drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PlotError {
    /// The picture is too small for its labels.
    #[error(
        "a plot of {width} × {height} px leaves no room beside its labels; at least 160 × 120 px are needed"
    )]
    TooSmall {
        /// Width asked for \[px\].
        width: u32,
        /// Height asked for \[px\].
        height: u32,
    },
    /// An axis of a plot with equal lengths on both axes is logarithmic.
    #[error("equal lengths on both axes need linear axes")]
    EqualAspectNeedsLinear,
    /// The drawing library refused.
    #[error("drawing failed: {0}")]
    Drawing(String),
}

fn failed(error: impl Display) -> PlotError {
    PlotError::Drawing(error.to_string())
}

/// Drawing units per pixel: the library rounds to whole units, and whole pixels would show as
/// jitter.
const UNIT: f64 = 10.0;
/// Height of ordinary text \[px\].
const TEXT: f64 = 12.5;
/// Mean width of a character of ordinary text \[px\].
const CHARACTER: f64 = 0.56 * TEXT;
/// Space between ticks' texts and pictures' rims \[px\].
const GAP: f64 = 8.0;
const INK: RGBColor = RGBColor(40, 40, 40);
const FRAME: RGBColor = RGBColor(120, 120, 120);
const MESH: RGBColor = RGBColor(226, 226, 226);
const MINOR: RGBColor = RGBColor(241, 241, 241);

fn units(pixels: f64) -> i32 {
    (pixels * UNIT).round() as i32
}

impl From<Colour> for RGBColor {
    fn from(c: Colour) -> Self {
        Self(c.0, c.1, c.2)
    }
}

/// A drawn plot.
pub(super) struct Picture {
    pub(super) text: String,
    width: f64,
    height: f64,
}

/// Where everything goes \[px\].
struct Layout {
    x: Ruler,
    y: Ruler,
    width: f64,
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    legend: Vec<Entry>,
}

/// An entry of the legend, with its place.
struct Entry {
    series: usize,
    x: f64,
    y: f64,
}

const LEGEND_LINE: f64 = 20.0;

/// Largest part of the picture's height that the legend may take: series that do not fit are drawn
/// without their names.
const LEGEND_PART: f64 = 0.3;

/// Room for the sample of a series in the legend \[px\].
fn sample_length(mark: Mark) -> f64 {
    match mark {
        Mark::Line | Mark::Dashed | Mark::Area => 24.0,
        Mark::Points | Mark::Circles | Mark::Crosses => 10.0,
    }
}

fn layout(chart: &Chart) -> Result<Layout, PlotError> {
    let (width, height) = (f64::from(chart.width), f64::from(chart.height));
    if chart.width < 160 || chart.height < 120 {
        return Err(PlotError::TooSmall { width: chart.width, height: chart.height });
    }
    let all = || chart.series.iter().flat_map(|s| &s.points);
    let (x_values, y_values) = (all().map(|p| p[0]), all().map(|p| p[1]));
    let (mut x_span, mut y_span) = if chart.equal_aspect {
        pictured(chart.x.extent(x_values), chart.y.extent(y_values))
    } else {
        (chart.x.span(x_values, 0.015), chart.y.span(y_values, 0.06))
    };
    let desc = |label: &str| if label.is_empty() { 0.0 } else { 1.5 * TEXT };
    let title = if chart.title.is_empty() { 0.0 } else { 1.9 * TEXT };
    let bottom = 0.5 * GAP + 1.7 * TEXT + desc(&chart.x.label);
    let right = 2.0 * GAP;
    // The ticks of y decide the room on the left, and for equal lengths the reverse: take the
    // widest tick first.
    let draft = Ruler::new(&chart.y, y_span, 6.0);
    let left = GAP + desc(&chart.y.label) + CHARACTER * draft.widest().max(3) as f64 + GAP;
    let plot_width = width - left - right;
    let mut legend = Vec::new();
    let (mut at, mut line) = (left, 0.0);
    for (series, Series { label, mark, .. }) in
        chart.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty())
    {
        let text = CHARACTER * label.chars().count() as f64;
        let length = sample_length(*mark) + 0.5 * GAP + text + 2.0 * GAP;
        if at > left && at + length > width {
            (at, line) = (left, line + LEGEND_LINE);
        }
        if line + LEGEND_LINE > LEGEND_PART * height {
            break;
        }
        legend.push(Entry { series, x: at, y: GAP + title + line + 0.5 * LEGEND_LINE });
        at += length;
    }
    let lines = legend.last().map_or(0.0, |last: &Entry| last.y + 0.5 * LEGEND_LINE - GAP - title);
    let legend_height = if legend.is_empty() { 0.0 } else { lines + 0.5 * GAP };
    let factor = if draft.exponent == 0 { 0.0 } else { 1.3 * TEXT };
    let top = GAP + title + legend_height + factor + 0.5 * TEXT;
    let mut plot_height = height - top - bottom;
    if plot_width < 60.0 || plot_height < 30.0 {
        return Err(PlotError::TooSmall { width: chart.width, height: chart.height });
    }
    let (x, y);
    if chart.equal_aspect {
        if chart.x.scale != super::Scale::Linear || chart.y.scale != super::Scale::Linear {
            return Err(PlotError::EqualAspectNeedsLinear);
        }
        let [wide, high] = [x_span, y_span].map(|[low, high]| high - low);
        let wanted = plot_width * high / wide;
        let lowest = (0.16 * plot_width).min(plot_height);
        if wanted > plot_height {
            widen(&mut x_span, high * plot_width / plot_height);
        } else if wanted < lowest {
            widen(&mut y_span, wide * lowest / plot_width);
            plot_height = lowest;
        } else {
            plot_height = wanted;
        }
        let longest = (x_span[1] - x_span[0]).max(y_span[1] - y_span[0]);
        let across = plot_width.max(plot_height);
        let step = nice(longest / (across / 60.0).max(1.0));
        (x, y) = (Ruler::linear(x_span, step), Ruler::linear(y_span, step));
    } else {
        let text = CHARACTER * (Ruler::new(&chart.x, x_span, 6.0).widest() + 3) as f64;
        x = Ruler::new(&chart.x, x_span, (plot_width / text.max(60.0)).floor());
        y = Ruler::new(&chart.y, y_span, (plot_height / 42.0).floor());
    }
    let height = top + plot_height + bottom;
    Ok(Layout { x, y, width, height, left, right, top, bottom, legend })
}

/// The window onto a shape: one margin all around, in proportion to its larger side.
fn pictured(x: [f64; 2], y: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    let larger = (x[1] - x[0]).max(y[1] - y[0]);
    let margin = if larger > 0.0 && larger.is_finite() { 0.05 * larger } else { 1.0 };
    let around = |[low, high]: [f64; 2]| [low - margin, high + margin];
    (around(x), around(y))
}

fn widen(span: &mut [f64; 2], to: f64) {
    let middle = 0.5 * (span[0] + span[1]);
    *span = [middle - 0.5 * to, middle + 0.5 * to];
}

impl Ranged for Ruler {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        from + ((value - self.low) / (self.high - self.low) * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { self.minor.clone() } else { self.ticks.clone() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Ruler {
    fn format_ext(&self, value: &f64) -> String {
        self.label(*value)
    }
}

type Area<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Ruler, Ruler>>;
type Root<'b> = DrawingArea<SVGBackend<'b>, plotters::coord::Shift>;

pub(super) fn svg(chart: &Chart) -> Result<Picture, PlotError> {
    let layout = layout(chart)?;
    let mut drawn = String::new();
    {
        let size = (units(layout.width).unsigned_abs(), units(layout.height).unsigned_abs());
        let root = SVGBackend::with_string(&mut drawn, size).into_drawing_area();
        words(chart, &layout, &root)?;
        let mut area = axes(&layout, &root)?;
        for &at in &chart.separators {
            if let Some(x) = chart.x.map(at).filter(|x| (layout.x.low..layout.x.high).contains(x)) {
                let ends = [(x, layout.y.low), (x, layout.y.high)];
                area.draw_series([PathElement::new(ends, stroke(GREY, 0.35, 0.7))]).map_err(failed)?;
            }
        }
        for series in &chart.series {
            draw_series(&mut area, &layout, chart, series)?;
        }
        for entry in &layout.legend {
            sample(&root, entry, &chart.series[entry.series])?;
        }
        root.present().map_err(failed)?;
    }
    // The library's own opening tag says how large a unit is; ours says how large the picture is.
    let inner = drawn.split_once('>').map_or("", |(_, rest)| rest);
    let inner = inner.trim_end().strip_suffix("</svg>").unwrap_or(inner);
    Ok(wrap(inner, layout.width, layout.height, UNIT, &chart.title))
}

fn wrap(inner: &str, width: f64, height: f64, unit: f64, title: &str) -> Picture {
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    let text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {:.0} {:.0}\" stroke-linejoin=\"round\" role=\"img\" aria-label=\"{title}\">{inner}</svg>\n",
        width * unit,
        height * unit,
    );
    Picture { text, width, height }
}

fn stroke(colour: Colour, opacity: f64, width: f64) -> ShapeStyle {
    RGBColor::from(colour).mix(opacity).stroke_width(units(width).unsigned_abs())
}

fn font(size: f64, anchor: Pos) -> TextStyle<'static> {
    ("sans-serif", size * UNIT).into_font().color(&INK).pos(anchor)
}

/// Title, names of the axes, powers of ten, texts of the legend.
fn words(chart: &Chart, layout: &Layout, root: &Root<'_>) -> Result<(), PlotError> {
    let at = |x: f64, y: f64| (units(x), units(y));
    let text = |words: &str, place: (i32, i32), style: TextStyle<'static>| {
        root.draw(&Text::new(words.to_owned(), place, style)).map_err(failed)
    };
    let (left, bottom) = (layout.left, layout.height - layout.bottom);
    let (middle_x, middle_y) = (0.5 * (left + layout.width - layout.right), 0.5 * (layout.top + bottom));
    if !chart.title.is_empty() {
        let style = ("sans-serif", 1.12 * TEXT * UNIT, FontStyle::Bold).into_font().color(&INK);
        text(&chart.title, at(left, GAP), style.pos(Pos::new(HPos::Left, VPos::Top)))?;
    }
    if !chart.x.label.is_empty() {
        let style = font(TEXT, Pos::new(HPos::Center, VPos::Bottom));
        text(&chart.x.label, at(middle_x, layout.height - 0.25 * GAP), style)?;
    }
    if !chart.y.label.is_empty() {
        let style = ("sans-serif", TEXT * UNIT).into_font().transform(FontTransform::Rotate270).color(&INK);
        text(&chart.y.label, at(0.5 * GAP, middle_y), style.pos(Pos::new(HPos::Center, VPos::Top)))?;
    }
    if let Some(factor) = layout.y.factor() {
        text(
            &factor,
            at(left, layout.top - 0.4 * TEXT),
            font(0.9 * TEXT, Pos::new(HPos::Left, VPos::Bottom)),
        )?;
    }
    if let Some(factor) = layout.x.factor() {
        let place = at(layout.width - layout.right, layout.height - 0.25 * GAP);
        text(&factor, place, font(0.9 * TEXT, Pos::new(HPos::Right, VPos::Bottom)))?;
    }
    for entry in &layout.legend {
        let series = &chart.series[entry.series];
        let place = at(entry.x + sample_length(series.mark) + 0.5 * GAP, entry.y);
        text(&series.label, place, font(TEXT, Pos::new(HPos::Left, VPos::Center)))?;
    }
    Ok(())
}

/// Frame, grid lines and ticks.
fn axes<'a, 'b>(layout: &Layout, root: &'a Root<'b>) -> Result<Area<'a, 'b>, PlotError> {
    let mut area = ChartBuilder::on(root)
        .margin_top(units(layout.top))
        .margin_right(units(layout.right))
        .set_label_area_size(LabelAreaPosition::Left, units(layout.left))
        .set_label_area_size(LabelAreaPosition::Bottom, units(layout.bottom))
        .build_cartesian_2d(layout.x.clone(), layout.y.clone())
        .map_err(failed)?;
    area.configure_mesh()
        .bold_line_style(ShapeStyle::from(MESH).stroke_width(units(0.8).unsigned_abs()))
        .light_line_style(ShapeStyle::from(MINOR).stroke_width(units(0.6).unsigned_abs()))
        .axis_style(ShapeStyle::from(FRAME).stroke_width(units(1.0).unsigned_abs()))
        .set_all_tick_mark_size(units(4.0))
        .x_label_style(font(0.94 * TEXT, Pos::new(HPos::Center, VPos::Top)))
        .y_label_style(font(0.94 * TEXT, Pos::new(HPos::Right, VPos::Center)))
        .draw()
        .map_err(failed)?;
    Ok(area)
}

fn draw_series(
    area: &mut Area<'_, '_>,
    layout: &Layout,
    chart: &Chart,
    series: &Series,
) -> Result<(), PlotError> {
    let within =
        |low: f64, high: f64, v: f64| v >= low - 1e-9 * (high - low) && v <= high + 1e-9 * (high - low);
    let place = |[x, y]: [f64; 2]| {
        let (x, y) = (chart.x.map(x)?, chart.y.map(y)?);
        (within(layout.x.low, layout.x.high, x) && within(layout.y.low, layout.y.high, y)).then_some((x, y))
    };
    let style = stroke(series.colour, series.opacity, series.size);
    let radius = units(series.size);
    match series.mark {
        Mark::Line | Mark::Dashed => {
            let points = thin(&series.points);
            for run in points.split(|&p| place(p).is_none()).filter(|run| !run.is_empty()) {
                let run: Vec<(f64, f64)> = run.iter().filter_map(|&p| place(p)).collect();
                if series.mark == Mark::Line {
                    area.draw_series([PathElement::new(run, style)]).map_err(failed)?;
                } else {
                    let dashes = DashedPathElement::new(run, units(6.0), units(4.0), style);
                    area.draw_series([dashes]).map_err(failed)?;
                }
            }
        }
        Mark::Area => {
            let round: Vec<(f64, f64)> = series.points.iter().filter_map(|&p| place(p)).collect();
            let fill = RGBColor::from(series.colour).mix(series.opacity).filled();
            if round.len() > 2 {
                area.draw_series([Polygon::new(round, fill)]).map_err(failed)?;
            }
        }
        Mark::Points => {
            let fill = RGBColor::from(series.colour).mix(series.opacity).filled();
            let marks = series.points.iter().filter_map(|&p| place(p)).map(|p| Circle::new(p, radius, fill));
            area.draw_series(marks).map_err(failed)?;
        }
        Mark::Circles => {
            let rim = stroke(series.colour, series.opacity, 1.3);
            let marks = series.points.iter().filter_map(|&p| place(p)).map(|p| Circle::new(p, radius, rim));
            area.draw_series(marks).map_err(failed)?;
        }
        Mark::Crosses => {
            let rim = stroke(series.colour, series.opacity, 1.3);
            let marks = series.points.iter().filter_map(|&p| place(p)).map(|p| Cross::new(p, radius, rim));
            area.draw_series(marks).map_err(failed)?;
        }
    }
    Ok(())
}

/// The sample of a series in the legend.
fn sample(root: &Root<'_>, entry: &Entry, series: &Series) -> Result<(), PlotError> {
    let (from, to, y) = (units(entry.x), units(entry.x + sample_length(series.mark)), units(entry.y));
    let middle = ((from + to) / 2, y);
    let style = stroke(series.colour, series.opacity, series.size);
    let rim = stroke(series.colour, series.opacity, 1.3);
    let radius = units(series.size);
    match series.mark {
        Mark::Line => root.draw(&PathElement::new([(from, y), (to, y)], style)),
        Mark::Dashed => {
            root.draw(&DashedPathElement::new([(from, y), (to, y)], units(6.0), units(4.0), style))
        }
        Mark::Points => root.draw(&Circle::new(
            middle,
            radius,
            RGBColor::from(series.colour).mix(series.opacity).filled(),
        )),
        Mark::Circles => root.draw(&Circle::new(middle, radius, rim)),
        Mark::Crosses => root.draw(&Cross::new(middle, radius, rim)),
        Mark::Area => root.draw(&Rectangle::new(
            [(from, y - units(4.0)), (to, y + units(4.0))],
            RGBColor::from(series.colour).mix(series.opacity).filled(),
        )),
    }
    .map_err(failed)
}

/// Several plots in one picture, `columns` side by side, as the text of an SVG element.
///
/// # Errors
/// [`PlotError`] of the first plot that cannot be drawn.
pub fn grid(charts: &[Chart], columns: usize) -> Result<String, PlotError> {
    let (mut inner, mut width, mut top) = (String::new(), 0.0_f64, 0.0);
    for row in charts.chunks(columns.max(1)) {
        let (mut left, mut height) = (0.0, 0.0_f64);
        for chart in row {
            let picture = svg(chart)?;
            // A nested picture is placed by its own corner.
            let placed = picture.text.replacen("<svg ", &format!("<svg x=\"{left:.0}\" y=\"{top:.0}\" "), 1);
            let _ = write!(inner, "{placed}");
            left += picture.width;
            height = height.max(picture.height);
        }
        width = width.max(left);
        top += height;
    }
    Ok(wrap(&inner, width.max(1.0), top.max(1.0), 1.0, "").text)
}
