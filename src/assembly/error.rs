//! Reasons why a model cannot be turned into equations.

use crate::basis::BasisError;
use crate::beam::Beam;
use crate::centreline::CurveError;

/// Why a model could not be turned into equations.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[non_exhaustive]
pub enum BuildError {
    /// The model has no beam.
    #[error("the model has no beam")]
    #[diagnostic(help("add at least one beam with a geometry, a section and a basis"))]
    NoBeam,
    /// Something refers to a beam that does not exist.
    #[error("{what} refers to beam number {beam}, but the model has {count}")]
    NoSuchBeam {
        /// The item that refers to it.
        what: &'static str,
        /// The index given.
        beam: usize,
        /// Number of beams.
        count: usize,
    },
    /// A place is not on its beam.
    #[error("{what} stands at s = {s} m, but beam `{beam}` runs from 0 to {length} m")]
    OffBeam {
        /// The item that stands there.
        what: &'static str,
        /// The beam's name.
        beam: String,
        /// Arc length asked for \[m\].
        s: f64,
        /// The beam's length \[m\].
        length: f64,
    },
    /// A quantity is needed that the model does not give.
    #[error("beam `{beam}` has no {quantity}, which {needed_by} needs")]
    #[diagnostic(help("give the beam this quantity, or leave out what needs it"))]
    Missing {
        /// The beam's name.
        beam: String,
        /// The quantity.
        quantity: &'static str,
        /// The item that needs it.
        needed_by: &'static str,
    },
    /// A coupled section damps strain and curvature by different times.
    #[error(
        "beam `{beam}`: its section couples strain and curvature, and they are damped by different times"
    )]
    #[diagnostic(help("give `stiffness_proportional`, which damps both alike, or `mass_proportional`"))]
    CoupledDamping {
        /// The beam's name.
        beam: String,
    },
    /// Two supports fix the same coordinate.
    #[error("two supports hold the {what} of beam `{beam}` at s = {s} m")]
    #[diagnostic(help("join them into one support"))]
    HeldTwice {
        /// The fixed quantity.
        what: &'static str,
        /// The beam's name.
        beam: String,
        /// Arc length of the supports \[m\].
        s: f64,
    },
    /// A support has a prescribed displacement in a motion, but no law of time.
    #[error(
        "the support of beam `{beam}` at s = {s} m moves by a stated amount, but does not say how in time"
    )]
    #[diagnostic(help(
        "give a law, such as `move = {{ x = \"1 cm\", in_time = {{ ramp = {{ duration = \"1 s\" }} }} }}`, or leave `move` out"
    ))]
    NoLaw {
        /// The beam's name.
        beam: String,
        /// Arc length of the support \[m\].
        s: f64,
    },
    /// An item follows a law of time in an analysis without time.
    #[error("{what} follows a law of time, which this analysis does not have")]
    #[diagnostic(help(
        "leave `in_time`, or what moves along a beam, out, or use [analysis.dynamic]; in a scene with stages let it begin with a motion, by `stage = \"…\"`"
    ))]
    NoTime {
        /// The item that follows a law.
        what: String,
    },
    /// The two points of a joint do not coincide.
    #[error(
        "a joint ties s = {first_s} m of beam `{first}`, at {at:?} m, to s = {second_s} m of beam `{second}`, but these points are {gap:.3e} m \
         apart"
    )]
    #[diagnostic(help(
        "let the stress-free shapes of the beams meet where they are joined, to 1e-9 of a beam's length{}",
        meets.as_ref().map_or_else(String::new, |(beam, s)| format!(": beam `{beam}` does at s = {s} m"))
    ))]
    Apart {
        /// The first beam's name.
        first: String,
        /// Arc length of the first point \[m\].
        first_s: f64,
        /// The second beam's name.
        second: String,
        /// Arc length of the second point \[m\].
        second_s: f64,
        /// Where the first point is at the start \[m\].
        at: [f64; 2],
        /// Their distance \[m\].
        gap: f64,
        /// The name of one of the beams and the arc length \[m\] at which it meets the point of the other one, if it does.
        meets: Option<(String, f64)>,
    },
    /// A support that lies between nodes moves with time.
    #[error("the support of beam `{beam}` at s = {s} m moves with time and lies between two nodes")]
    #[diagnostic(help("put a node there: `nodes` of the beam's basis may be a list of arc lengths"))]
    MovesBetweenNodes {
        /// The beam's name.
        beam: String,
        /// Arc length of the support \[m\].
        s: f64,
    },
    /// Supports between nodes fix more quantities than the mesh has free coordinates there.
    #[error(
        "supports of beam `{beam}` between the nodes from s = {s} m on hold {rows} quantities, and the mesh has {free} free coordinates there"
    )]
    #[diagnostic(help(
        "use more elements or nodes, put nodes where the supports are, or leave some supports out"
    ))]
    OverSupported {
        /// The beam's name.
        beam: String,
        /// Arc length of the first of the nodes around the supports \[m\].
        s: f64,
        /// Number of fixed quantities, each of which is a constraint row.
        rows: usize,
        /// Number of coordinates that no support at a node fixes.
        free: usize,
    },
    /// A joint ties a point to itself.
    #[error("{joint} ties a point to itself")]
    #[diagnostic(help("let a joint tie two points of different beams, or leave it out"))]
    ToItself {
        /// The joint with the places that it ties.
        joint: String,
    },
    /// Joints, supports between nodes or inextensible beams fix one motion more than once.
    #[error("{parts} hold the same motion more than once")]
    #[diagnostic(help(
        "the forces between them have no values: leave one of them out, or let one hold less, such as a support that slides; \
         held at both ends may be a beam with an `axial_stiffness`, and one that sags between them, by its stress-free shape (`points`, \
         `arc`) or by the one in which it begins (`initial_shape`)"
    ))]
    Redundant {
        /// The parts that fix it, with their places.
        parts: String,
    },
    /// The shape functions could not be built.
    #[error("beam `{beam}`: {cause}")]
    Basis {
        /// The beam's name.
        beam: String,
        /// The reason.
        cause: Box<BasisError>,
    },
    /// The centreline is not a curve.
    #[error("beam `{beam}`: {cause}")]
    Curve {
        /// The beam's name.
        beam: String,
        /// The reason.
        cause: CurveError,
    },
}

impl BuildError {
    pub(crate) fn missing(beam: &Beam, quantity: &'static str, needed_by: &'static str) -> Self {
        Self::Missing { beam: beam.name.clone(), quantity, needed_by }
    }

    pub(crate) fn basis(beam: &str, source: BasisError) -> Self {
        Self::Basis { beam: beam.to_owned(), cause: Box::new(source) }
    }
}
