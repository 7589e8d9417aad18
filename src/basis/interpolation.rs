//! Input of an interpolation by radial functions, and the quality of its result.

use super::{Kernel, SideCondition};

/// The parameters of the interpolation, the same for every support of a beam.
#[derive(Clone, Copy, Debug)]
pub struct Interpolation {
    /// Radial function.
    pub kernel: Kernel,
    /// Number m of polynomial terms.
    pub terms: usize,
    /// Sign of the slope terms in the side conditions.
    pub side_condition: SideCondition,
    /// Length of the beam \[m\].
    pub length: f64,
    /// Number of cells of the beam: `length / spacings` is the average node spacing d_c.
    pub spacings: usize,
}

/// One cell and its support.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Arc lengths of the nodes of the support \[m\].
    pub nodes: &'a [f64],
    /// Index in `nodes` of the cell's left end.
    pub left: usize,
}

/// The rows wanted at one point.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// ξ ∈ [0, 1] in the cell.
    pub xi: f64,
    /// Orders of the derivatives.
    pub orders: &'a [usize],
    /// Distance in memory from the start of one row to the start of the next.
    pub stride: usize,
    /// At how many points of the beam rows are wanted.
    pub amount: Amount,
}

/// At how many points rows are wanted: whether what makes each cheaper is worth its own price.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amount {
    /// At the points of a quadrature, or at some places.
    Few,
    /// Along the whole beam, as for a picture of its shape.
    Many,
}

/// How accurate the rows of one cell are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quality {
    /// Estimated largest relative error of any row.
    pub error: f64,
    /// log₂ of the estimated condition number of the moment matrix G.
    pub log2_condition: f64,
    /// Largest difference of the rows at the ends of the cell from exact unit rows, dimensionless.
    pub kronecker: f64,
    /// Largest relative defect in reproducing 1 and s.
    pub reproduction: f64,
    /// Bits of the arithmetic.
    pub bits: usize,
}
