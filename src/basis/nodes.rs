//! Where the nodes are.

use crate::model::Nodes;

use super::error::BasisError;

/// Most nodes of one beam. Beyond, tables and unknowns take gigabytes and coefficient numbers outgrow their type.
pub const MOST_NODES: usize = 20_000_000;

/// Rough memory of one node in tables, states and tangents, for the message that refuses too many \[bytes\].
const BYTES_PER_NODE: f64 = 2000.0;

/// Relative distance of neighbouring nodes below which their difference carries fewer than three digits.
const LEAST_RELATIVE_SPACING: f64 = 1e3 * f64::EPSILON;

/// Arc lengths of the nodes \[m\]: increasing, the first exactly 0, the last exactly `length`.
///
/// # Errors
/// An unusable length, too few or too many nodes, nodes that are not finite, out of order, indistinguishable, or that
/// do not span the beam to within 1e-9 of its length.
pub fn arc_lengths(nodes: &Nodes, length: f64) -> Result<Vec<f64>, BasisError> {
    // A length whose square or reciprocal leaves the range of double precision cannot be computed with.
    if !(1e-140..=1e140).contains(&length) {
        return Err(BasisError::Length { length });
    }
    let n = match nodes {
        Nodes::Uniform(n) | Nodes::Chebyshev(n) => *n,
        Nodes::Given(s) => s.len(),
    };
    if n < 2 {
        return Err(BasisError::TooFewNodes { found: n });
    }
    if n > MOST_NODES {
        let gigabytes = n as f64 * BYTES_PER_NODE * 1e-9;
        return Err(BasisError::TooManyNodes { nodes: n, limit: MOST_NODES, gigabytes });
    }
    let last = (n - 1) as f64;
    let mut s: Vec<f64> = match nodes {
        Nodes::Uniform(_) => (0..n).map(|i| length * (i as f64 / last)).collect(),
        Nodes::Chebyshev(_) => (0..n)
            .map(|i| {
                // ½ (1 − cos φ) = sin²(φ/2) without cancellation near the first end.
                let half = (0.5 * std::f64::consts::PI * (i as f64 / last)).sin();
                length * (half * half)
            })
            .collect(),
        Nodes::Given(given) => {
            check_given(given, length)?;
            given.clone()
        }
    };
    s[0] = 0.0;
    s[n - 1] = length;
    for (index, pair) in s.windows(2).enumerate() {
        let (left, right) = (pair[0], pair[1]);
        if left >= right {
            return Err(BasisError::NodesOutOfOrder { index, left, right });
        }
        let least = LEAST_RELATIVE_SPACING * right;
        if right - left < least {
            return Err(BasisError::NodesCoincide { index, left, spacing: right - left, least });
        }
    }
    Ok(s)
}

fn check_given(given: &[f64], length: f64) -> Result<(), BasisError> {
    if let Some((index, &value)) = given.iter().enumerate().find(|(_, s)| !s.is_finite()) {
        return Err(BasisError::NodeNotFinite { index, value, length });
    }
    let last = given.len() - 1;
    for (index, expected) in [(0, 0.0), (last, length)] {
        let found = given[index];
        if (found - expected).abs() > 1e-9 * length {
            return Err(BasisError::NodesDoNotSpan { index, found, expected });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_exact() {
        for n in 2..200 {
            for nodes in [Nodes::Uniform(n), Nodes::Chebyshev(n)] {
                let s = arc_lengths(&nodes, 1.8).unwrap();
                assert_eq!((s.len(), s[0], s[n - 1]), (n, 0.0, 1.8));
            }
        }
    }

    #[test]
    fn chebyshev_nodes_follow_the_formula() {
        let s = arc_lengths(&Nodes::Chebyshev(7), 2.0).unwrap();
        for (i, s) in s.iter().enumerate() {
            assert!((s - (1.0 - (i as f64 * std::f64::consts::PI / 6.0).cos())).abs() < 1e-15);
        }
    }

    #[test]
    fn each_fault_has_its_message() {
        let fault = |nodes: &[f64]| arc_lengths(&Nodes::Given(nodes.to_vec()), 1.0).unwrap_err();
        assert!(matches!(fault(&[0.0]), BasisError::TooFewNodes { found: 1 }));
        assert!(matches!(fault(&[0.0, f64::NAN, 1.0]), BasisError::NodeNotFinite { index: 1, .. }));
        assert!(matches!(fault(&[0.1, 0.5, 1.0]), BasisError::NodesDoNotSpan { index: 0, .. }));
        assert!(matches!(fault(&[0.0, 0.5]), BasisError::NodesDoNotSpan { index: 1, .. }));
        assert!(matches!(fault(&[0.0, 0.6, 0.5, 1.0]), BasisError::NodesOutOfOrder { index: 1, .. }));
        assert!(matches!(fault(&[0.0, 0.5, 0.5 + 1e-15, 1.0]), BasisError::NodesCoincide { index: 1, .. }));
        assert!(matches!(
            arc_lengths(&Nodes::Uniform(usize::MAX), 1.0),
            Err(BasisError::TooManyNodes { .. })
        ));
        for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(arc_lengths(&Nodes::Uniform(2), length), Err(BasisError::Length { .. })));
        }
    }
}
