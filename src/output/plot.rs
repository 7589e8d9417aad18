//! Plots described as data and drawn as SVG text, without fonts or files: for the results of a run
//! and for the verification report alike.
//!
//! ```
//! use ancf::output::plot::{Axis, Chart, PALETTE, Series};
//! let curve: Vec<[f64; 2]> = (1..=4).map(|k| [10_f64.powi(-k), 10_f64.powi(-2 * k)]).collect();
//! let chart = Chart::new("Convergence", Axis::log("element length [m]"), Axis::log("error [m]"))
//!     .with(Series::line("cubic", curve.clone(), PALETTE[0]))
//!     .with(Series::points("", curve, PALETTE[0]));
//! assert!(chart.svg()?.starts_with("<svg"));
//! # Ok::<(), ancf::output::plot::PlotError>(())
//! ```

mod axis;
mod draw;
mod number;
mod thin;

pub use axis::{Axis, Scale};
pub use draw::{PlotError, grid};
pub use number::human;

/// A colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Colours that stay distinct to colour-blind readers and in grey print (M. Okabe, K. Ito, *Color
/// Universal Design*, 2008), strongest first.
pub const PALETTE: [Colour; 8] = [
    Colour(0, 114, 178),
    Colour(213, 94, 0),
    Colour(0, 158, 115),
    Colour(204, 121, 167),
    Colour(230, 159, 0),
    Colour(86, 180, 233),
    Colour(60, 60, 60),
    Colour(150, 110, 60),
];

/// For elements in the background: references, undeformed shapes.
pub const GREY: Colour = Colour(130, 130, 130);

/// The colour of the series with this number.
pub fn colour(index: usize) -> Colour {
    PALETTE[index % PALETTE.len()]
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line; it breaks where a coordinate is not finite, or not positive on a logarithmic axis.
    Line,
    /// A dashed line.
    Dashed,
    /// Filled circles.
    Points,
    /// Open circles.
    Circles,
    /// Crosses.
    Crosses,
    /// The area inside the points, which go round it.
    Area,
}

/// One set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty: not in the legend.
    pub label: String,
    /// Points in data coordinates.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub mark: Mark,
    /// Its colour.
    pub colour: Colour,
    /// Width of lines or radius of marks \[px\].
    pub size: f64,
    /// 0 (invisible) … 1.
    pub opacity: f64,
}

impl Series {
    /// A series drawn with `mark`.
    pub fn new(label: impl Into<String>, points: Vec<[f64; 2]>, mark: Mark, colour: Colour) -> Self {
        let size = match mark {
            Mark::Line => 1.8,
            Mark::Dashed => 1.4,
            Mark::Points => 2.6,
            Mark::Circles | Mark::Crosses => 3.4,
            Mark::Area => 0.0,
        };
        Self { label: label.into(), points, mark, colour, size, opacity: 1.0 }
    }

    /// A line.
    pub fn line(label: impl Into<String>, points: Vec<[f64; 2]>, colour: Colour) -> Self {
        Self::new(label, points, Mark::Line, colour)
    }

    /// A dashed line.
    pub fn dashed(label: impl Into<String>, points: Vec<[f64; 2]>, colour: Colour) -> Self {
        Self::new(label, points, Mark::Dashed, colour)
    }

    /// The band between `low` and `high`, both in rising order of their first coordinate.
    pub fn band(label: impl Into<String>, low: Vec<[f64; 2]>, high: Vec<[f64; 2]>, colour: Colour) -> Self {
        let round: Vec<[f64; 2]> = low.into_iter().chain(high.into_iter().rev()).collect();
        Self::new(label, round, Mark::Area, colour).opacity(0.22)
    }

    /// Filled circles.
    pub fn points(label: impl Into<String>, points: Vec<[f64; 2]>, colour: Colour) -> Self {
        Self::new(label, points, Mark::Points, colour)
    }

    /// The series with another width of lines or radius of marks \[px\].
    pub fn size(self, size: f64) -> Self {
        Self { size, ..self }
    }

    /// The series with another opacity.
    pub fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// A plot: axes, series, and how large.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The text above the plot; none if empty.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The series that are drawn, the last on top.
    pub series: Vec<Series>,
    /// Faint vertical lines at these x.
    pub separators: Vec<f64>,
    /// One metre is as long on both axes (both linear); the height then follows from the data, up
    /// to `height`.
    pub equal_aspect: bool,
    /// Width of the picture \[px\].
    pub width: u32,
    /// Height of the picture \[px\].
    pub height: u32,
}

impl Chart {
    /// An empty plot of 720 × 380 px.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            separators: Vec::new(),
            equal_aspect: false,
            width: 720,
            height: 380,
        }
    }

    /// The plot with one more series on top.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The plot with equal lengths on both axes and at most `height` px high.
    #[must_use]
    pub fn equal_aspect(self, height: u32) -> Self {
        Self { equal_aspect: true, height, ..self }
    }

    /// The plot in another size \[px\].
    #[must_use]
    pub fn sized(self, width: u32, height: u32) -> Self {
        Self { width, height, ..self }
    }

    /// The plot as the text of an SVG element, complete in itself.
    ///
    /// # Errors
    /// [`PlotError`] where there is no room for a plot or the drawing library refuses.
    pub fn svg(&self) -> Result<String, PlotError> {
        draw::svg(self).map(|picture| picture.text)
    }
}
