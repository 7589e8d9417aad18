//! Errors of a discretisation.

use thiserror::Error;

/// Why shape functions could not be built or evaluated.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BasisError {
    /// The beam has no discretisation.
    #[error(
        "no discretisation: one is chosen when the model is solved for an accuracy, and has to be given otherwise"
    )]
    Open,
    /// The beam has no usable length.
    #[error("expected a beam of positive, finite length, found {length} m")]
    Length {
        /// Length found \[m\].
        length: f64,
    },
    /// The beam has fewer than two nodes.
    #[error("expected at least 2 nodes, found {found}; give the beam a node at each end")]
    TooFewNodes {
        /// Nodes found.
        found: usize,
    },
    /// There are more nodes than memory and the numbering of the tables allow.
    #[error(
        "{nodes} nodes would need about {gigabytes:.0} GB for shape functions and unknowns; the limit is {limit} nodes, \
         use fewer"
    )]
    TooManyNodes {
        /// Nodes asked for.
        nodes: usize,
        /// Largest number accepted.
        limit: usize,
        /// Estimated memory \[GB\].
        gigabytes: f64,
    },
    /// A node is NaN or infinite.
    #[error("node {index} is at {value} m; expected a finite arc length in [0, {length}] m")]
    NodeNotFinite {
        /// Index of the node, from 0.
        index: usize,
        /// Its arc length \[m\].
        value: f64,
        /// Length of the beam \[m\].
        length: f64,
    },
    /// The given nodes do not span the beam.
    #[error(
        "node {index} is at {found} m; expected {expected} m: the first node belongs at 0, the last at the beam's length"
    )]
    NodesDoNotSpan {
        /// Index of the node, from 0.
        index: usize,
        /// Its arc length \[m\].
        found: f64,
        /// Its expected arc length \[m\].
        expected: f64,
    },
    /// Two neighbouring nodes are out of order.
    #[error("nodes {index} and {} are at {left} m and {right} m; arc lengths must increase along the beam", index + 1)]
    NodesOutOfOrder {
        /// Index of the first of the two, from 0.
        index: usize,
        /// Its arc length \[m\].
        left: f64,
        /// Arc length of the second \[m\].
        right: f64,
    },
    /// Two neighbouring nodes are so close that their distance is mostly round-off.
    #[error(
        "nodes {index} and {} at {left} m are only {spacing:e} m apart, less than {least:e} m, where double precision \
         still resolves their distance; move them apart or remove one",
        index + 1
    )]
    NodesCoincide {
        /// Index of the first of the two, from 0.
        index: usize,
        /// Its arc length \[m\].
        left: f64,
        /// Their distance \[m\].
        spacing: f64,
        /// Smallest distance accepted here \[m\].
        least: f64,
    },
    /// Two nodes are so much closer than those beside them that meshfree shape functions make numbers of round-off.
    #[error(
        "nodes {index} and {} at {left} m are {spacing:.3e} m apart beside a spacing of {beside:.3e} m: there meshfree shape functions \
         amplify the round-off of positions {amplification:.0e} times (at most {most:.0e} leave results their digits); move the two \
         apart, remove one, or use elements (`ancf`) in place of `rpim`",
        index + 1
    )]
    NodesTooClose {
        /// Index of the first of the two, from 0.
        index: usize,
        /// Its arc length \[m\].
        left: f64,
        /// Their distance \[m\].
        spacing: f64,
        /// The larger of the distances beside theirs \[m\].
        beside: f64,
        /// Largest second derivative in a cell that has the two in its support, of a node displaced by one, times the square of the
        /// cell's length.
        amplification: f64,
        /// Largest one accepted.
        most: f64,
    },
    /// A parameter of the radial function permits no usable shape functions.
    #[error("{parameter} = {value} of the {kernel} kernel: {problem}")]
    KernelParameter {
        /// Name of the kernel.
        kernel: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
        /// Value found.
        value: f64,
        /// The problem, with a suggestion.
        problem: String,
    },
    /// The number of polynomial terms is out of range: without the constant term a translated beam
    /// would be strained, and too many terms make the moment matrix singular.
    #[error(
        "{found} polynomial terms: expected 1 to {limit}, since {}",
        if *found == 0 {
            "without the constant one a rigid translation is not reproduced".to_owned()
        } else {
            format!("the smallest support has {limit} coefficients")
        }
    )]
    PolynomialTerms {
        /// Terms found.
        found: usize,
        /// Largest number that the smallest support allows.
        limit: usize,
    },
    /// The support of a cell is wider than any computation needs.
    #[error("a support of {nodes} nodes: at most {limit} are accepted, reduce `neighbours`")]
    SupportTooWide {
        /// Nodes in the widest support.
        nodes: usize,
        /// Largest number accepted.
        limit: usize,
    },
    /// The moment matrix of a cell is too close to singular for every precision tried.
    #[error(
        "the shape functions of cell {cell} (nodes {first_node} to {last_node}, spacings from {min_spacing:e} to \
         {max_spacing:e} m, {kernel}) could not be found: with {bits} bits the estimated relative error is still \
         {error:e} (condition about 1e{condition_log10:.0}); {advice}"
    )]
    IllConditioned {
        /// Index of the cell, from 0.
        cell: usize,
        /// First node of its support.
        first_node: usize,
        /// Last node of its support.
        last_node: usize,
        /// Smallest distance of neighbours in the support \[m\].
        min_spacing: f64,
        /// Largest distance of neighbours in the support \[m\].
        max_spacing: f64,
        /// The kernel and its parameters.
        kernel: String,
        /// Bits of the mantissa at the last attempt.
        bits: usize,
        /// Estimated relative error of the rows at the last attempt.
        error: f64,
        /// Decimal logarithm of the estimated condition number.
        condition_log10: f64,
        /// A suggestion.
        advice: &'static str,
    },
    /// The shape functions are larger than double precision can hold.
    #[error(
        "the shape functions of cell {cell} overflow double precision; use another unit of length or kernel"
    )]
    Overflow {
        /// Index of the cell, from 0.
        cell: usize,
    },
    /// The family of quadrature rules has none with that many points.
    #[error("{rule} quadrature with {points} points: expected {least} to {most}")]
    Quadrature {
        /// Name of the family.
        rule: &'static str,
        /// Points asked for.
        points: usize,
        /// Fewest possible.
        least: usize,
        /// Most supported.
        most: usize,
    },
    /// Tables do not hold derivatives of this order.
    #[error("derivative of order {order}: shape functions are tabulated for orders 0 to 2")]
    Order {
        /// Order asked for.
        order: usize,
    },
    /// A point does not lie on the beam.
    #[error("arc length {s} m is not on the beam, expected 0 to {length} m")]
    OffBeam {
        /// Arc length found \[m\].
        s: f64,
        /// Length of the beam \[m\].
        length: f64,
    },
}
