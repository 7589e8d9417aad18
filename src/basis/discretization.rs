//! The choices a user has in the approximation of a centreline.

use std::fmt;

/// How a beam's centreline is approximated between nodes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Discretization {
    /// Gradient-deficient cable element: cubic Hermite shape functions between neighbouring nodes.
    Ancf {
        /// Where the nodes are.
        nodes: Nodes,
    },
    /// Hermite radial point interpolation.
    Rpim {
        /// Where the nodes are.
        nodes: Nodes,
        /// Radial function.
        kernel: Kernel,
        /// Number of polynomial terms 1, s, s², …
        polynomial_terms: usize,
        /// Sign of the slope terms in the side conditions.
        side_condition: SideCondition,
        /// Number of nodes of a support beyond the cell's own two, on each side.
        neighbours: usize,
    },
    /// None: to be chosen for an accuracy. No basis can be made of it.
    Open,
}

impl Discretization {
    /// Where the search for an accuracy begins.
    const FIRST: Nodes = Nodes::Uniform(9);

    /// Where the nodes are.
    pub fn nodes(&self) -> &Nodes {
        match self {
            Self::Ancf { nodes } | Self::Rpim { nodes, .. } => nodes,
            Self::Open => &Self::FIRST,
        }
    }
}

/// The places of the nodes along a beam.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Nodes {
    /// `n` nodes at equal distances.
    Uniform(usize),
    /// `n` nodes at s_i = L/2 − L/2 cos((i−1)π/(n−1)).
    Chebyshev(usize),
    /// Arc lengths \[m\], increasing from 0 to L.
    Given(Vec<f64>),
}

/// Radial function R(d) of the distance d from a node, in units of the average node spacing d_c.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Kernel {
    /// (d² + α²)^q
    Multiquadric {
        /// Exponent q, not a whole number.
        q: f64,
        /// Shape parameter α, in units of d_c.
        shape: f64,
    },
    /// exp(−α d²)
    Exponential {
        /// Shape parameter α.
        shape: f64,
    },
    /// d^η, or d^η ln d where η is an even whole number.
    ThinPlateSpline {
        /// η, larger than 3: three derivatives must exist at d = 0.
        exponent: f64,
    },
    /// (1 − d/δ)₊⁸ (32 (d/δ)³ + 25 (d/δ)² + 8 d/δ + 1), Wendland's C⁶ function of compact support.
    Wendland {
        /// Radius δ beyond which the function is zero, in units of d_c.
        radius: f64,
    },
}

/// The sign in the side conditions Σ_i [p_j(s_i) a_i ± p_j'(s_i) b_i] = 0 of an RPIM interpolation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SideCondition {
    /// The sign in the paper by Chen, Zhang and Li; the moment matrix is not symmetric.
    #[default]
    Plus,
    /// The sign with which the moment matrix is symmetric.
    Minus,
}

impl Nodes {
    /// Number of nodes.
    pub fn count(&self) -> usize {
        match self {
            Self::Uniform(n) | Self::Chebyshev(n) => *n,
            Self::Given(s) => s.len(),
        }
    }
}

impl fmt::Display for Nodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uniform(n) => write!(f, "{n} uniform nodes"),
            Self::Chebyshev(n) => write!(f, "{n} Chebyshev nodes"),
            Self::Given(s) => write!(f, "{} given nodes", s.len()),
        }
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Multiquadric { q, shape } => write!(f, "multiquadric (q = {q}, shape {shape})"),
            Self::Exponential { shape } => write!(f, "exponential (shape {shape})"),
            Self::ThinPlateSpline { exponent } => write!(f, "thin plate spline (exponent {exponent})"),
            Self::Wendland { radius } => write!(f, "Wendland C⁶ (radius {radius})"),
        }
    }
}

impl fmt::Display for Discretization {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ancf { nodes } => write!(f, "ANCF cable elements, {nodes}"),
            Self::Open => f.write_str("chosen for the accuracy"),
            Self::Rpim { nodes, kernel, polynomial_terms, side_condition, neighbours } => {
                let sign = match side_condition {
                    SideCondition::Plus => '+',
                    SideCondition::Minus => '−',
                };
                write!(
                    f,
                    "RPIM, {nodes}, {kernel}, {polynomial_terms} polynomial terms, side condition {sign}, {neighbours} neighbours a side"
                )
            }
        }
    }
}
