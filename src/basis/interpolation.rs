//! What an interpolation by radial functions is asked, and how well it answered.

use super::{Kernel, SideCondition};

/// What defines the interpolation on every support of a beam.
#[derive(Clone, Copy, Debug)]
pub struct Interpolation {
    /// Radial function.
    pub kernel: Kernel,
    /// m.
    pub terms: usize,
    /// Sign of the slope terms in the side conditions.
    pub side_condition: SideCondition,
    /// Length of the beam \[m\].
    pub length: f64,
    /// Number of average spacings in it.
    pub spacings: usize,
}

/// One cell and its support.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Arc lengths of the nodes of the support \[m\].
    pub nodes: &'a [f64],
    /// Which of them is the cell's left end.
    pub left: usize,
}

/// Rows asked for at one point.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// ξ ∈ [0, 1] in the cell.
    pub xi: f64,
    /// Orders of the derivatives.
    pub orders: &'a [usize],
    /// Numbers from one row to the next.
    pub stride: usize,
}

/// How well the rows of one cell are known.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quality {
    /// Estimated largest relative error.
    pub error: f64,
    /// log₂ of the estimated condition number of G.
    pub log2_condition: f64,
    /// Largest defect at the ends of the cell.
    pub kronecker: f64,
    /// Largest relative defect in reproducing 1 and s.
    pub reproduction: f64,
    /// Bits of the arithmetic.
    pub bits: usize,
}
