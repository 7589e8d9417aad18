//! Positions of the nodes along a beam.

use super::Nodes;

use super::NODE_SNAP;
use super::error::BasisError;

/// Largest number of nodes of one beam. With more, tables and unknowns would take gigabytes, and
/// coefficient numbers would exceed the range of their type.
pub const MOST_NODES: usize = 20_000_000;

/// Rough memory that one node takes in tables, states and tangents \[bytes\], for the message that
/// refuses too many nodes.
const BYTES_PER_NODE: f64 = 2000.0;

/// Smallest distance of neighbouring nodes, relative to their arc length; below it, their
/// difference has fewer than three correct digits.
const LEAST_RELATIVE_SPACING: f64 = 1e3 * f64::EPSILON;

/// Arc lengths of the nodes \[m\]: increasing, the first exactly 0, the last exactly `length`.
///
/// # Errors
/// An unusable length, too few or too many nodes, nodes that are not finite, out of order,
/// indistinguishable, or that do not span the beam to within 1e-9 of its length.
pub fn arc_lengths(nodes: &Nodes, length: f64) -> Result<Vec<f64>, BasisError> {
    // The square and the reciprocal of the length must stay in the range of double precision.
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

/// Breaks nearer to an end or to each other than this fraction of the beam's length are the same
/// place.
const SAME_PLACE: f64 = 1e-9;

/// Sizes of cells are rounded to one part in this number before they are compared, so that
/// round-off, of a rotated scene or of other units, does not decide where nodes lie.
const PARTS_OF_CELL: f64 = 1e9;

/// A given node nearer to a break than this, in units of the spacing around it, is shifted to the
/// break: a very short cell would be of no use.
const NEAR: f64 = 0.1;

/// The nodes `s` with a node at each of `breaks` \[m\] that lies between the ends, and the indices
/// of those nodes.
///
/// Nodes that are not `given` keep their number. The cells are distributed over the stretches
/// between breaks so that the longest cell, in units of the original cells, is as short as
/// possible; inside a stretch the nodes keep their original pattern. Only where there are more
/// breaks than inner nodes are nodes added. Nodes that are `given` stay where they are, and nodes
/// are added at the breaks; only a given node that is very near to a break is shifted there.
pub fn meet(mut s: Vec<f64>, given: bool, breaks: &[f64]) -> (Vec<f64>, Vec<usize>) {
    let length = s[s.len() - 1];
    let inside = |s: &f64| (SAME_PLACE * length..(1.0 - SAME_PLACE) * length).contains(s);
    let mut breaks: Vec<f64> = breaks.iter().copied().filter(inside).collect();
    breaks.sort_unstable_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a <= SAME_PLACE * length);
    if given || breaks.len() + 2 > s.len() {
        breaks.iter().for_each(|at| join(&mut s, *at, &breaks));
        let numbers = breaks.iter().map(|at| s.partition_point(|node| node < at)).collect();
        return (s, numbers);
    }
    let numbers = apportion(&s, &breaks);
    let last = s.len() - 1;
    let (mut first, mut from, mut old) = (0, 0.0, 0.0);
    for (&end, &to) in numbers.iter().zip(&breaks).chain([(&last, &length)]) {
        let old_end = s[end];
        let stays = |a: f64, b: f64| (a - b).abs() <= NODE_SNAP * length;
        if !(stays(from, old) && stays(to, old_end)) {
            let scale = (to - from) / (old_end - old);
            s[first + 1..end].iter_mut().for_each(|node| *node = from + (*node - old) * scale);
        }
        s[end] = to;
        (first, from, old) = (end, to, old_end);
    }
    (s, numbers)
}

/// The indices of the nodes that are moved to the breaks.
fn apportion(s: &[f64], breaks: &[f64]) -> Vec<usize> {
    let index = |at: &f64| {
        let right = s.partition_point(|node| node < at);
        right as f64 - (s[right] - at) / (s[right] - s[right - 1])
    };
    let last = s.len() - 1;
    let ends: Vec<f64> = std::iter::once(0.0).chain(breaks.iter().map(index)).chain([last as f64]).collect();
    let lengths: Vec<f64> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut cells: Vec<usize> =
        lengths.iter().map(|length| ((length + 1.0 / PARTS_OF_CELL) as usize).max(1)).collect();
    // Rounded, so that round-off does not decide between equal sizes.
    let size = |(j, cells): (usize, usize)| (lengths[j] / cells as f64 * PARTS_OF_CELL).round();
    while cells.iter().sum::<usize>() != last {
        let of = cells.iter().copied().enumerate();
        if cells.iter().sum::<usize>() < last {
            let Some((j, _)) = of.max_by(|a, b| size(*a).total_cmp(&size(*b))) else { break };
            cells[j] += 1;
        } else {
            let fewer = of.filter(|(_, cells)| *cells > 1).map(|(j, cells)| (j, cells - 1));
            let Some((j, _)) = fewer.min_by(|a, b| size(*a).total_cmp(&size(*b))) else { break };
            cells[j] -= 1;
        }
    }
    let sums = cells.iter().scan(0, |sum, cells| {
        *sum += cells;
        Some(*sum)
    });
    sums.take(breaks.len()).collect()
}

/// Places a node at `at`: shifts the nearest one if it is very near and neither an end of the beam
/// nor at another break; otherwise inserts one.
fn join(s: &mut Vec<f64>, at: f64, breaks: &[f64]) {
    let right = s.partition_point(|node| *node < at);
    let spacing = s[right] - s[right - 1];
    let nearest = if at - s[right - 1] < s[right] - at { right - 1 } else { right };
    let free = nearest > 0 && nearest + 1 < s.len() && !breaks.contains(&s[nearest]);
    if s[nearest] == at || free && (s[nearest] - at).abs() <= NEAR * spacing {
        s[nearest] = at;
    } else {
        s.insert(right, at);
    }
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
    fn nodes_meet_breaks() {
        let uniform = |n| arc_lengths(&Nodes::Uniform(n), 1.0).unwrap();
        let given = |s: &[f64], breaks: &[f64]| meet(s.to_vec(), true, breaks);
        assert_eq!(meet(uniform(9), false, &[0.5, 0.0, 1.0]), (uniform(9), vec![4]));
        assert_eq!(meet(uniform(5), false, &[0.4]), (vec![0.0, 0.2, 0.4, 0.7, 1.0], vec![2]));
        for (n, breaks, numbers) in [
            (9, &[0.8125][..], &[6][..]),
            (9, &[0.2, 0.45, 0.7], &[2, 4, 6]),
            (9, &[0.97], &[7]),
            (5, &[0.01, 0.02], &[1, 2]),
            (5, &[0.98, 0.99], &[2, 3]),
            (1001, &[0.5, 0.501], &[500, 501]),
        ] {
            assert_eq!(meet(uniform(n), false, breaks).1, numbers, "{breaks:?}");
        }
        // Of two equal stretches the same one gets the additional cell, whatever the round-off of
        // the break is.
        for error in [-1e-15, 0.0, 1e-15] {
            assert_eq!(meet(uniform(4), false, &[0.5 + error]).1, [1], "{error}");
        }
        // Ten cells before the break stay ten, whatever its round-off is.
        for error in [-1e-15, 0.0, 1e-15] {
            let breaks = [10.0 / 13.0 + error, 11.6 / 13.0];
            assert_eq!(meet(uniform(14), false, &breaks).1, [10, 12], "{error}");
        }
        // The places of given nodes that are moved: within a tenth of the spacing, ends never.
        assert_eq!(given(&[0.0, 0.5, 1.0], &[0.549]), (vec![0.0, 0.549, 1.0], vec![1]));
        assert_eq!(given(&[0.0, 0.5, 1.0], &[0.551]), (vec![0.0, 0.5, 0.551, 1.0], vec![2]));
        assert_eq!(given(&[0.0, 0.5, 1.0], &[0.01]), (vec![0.0, 0.01, 0.5, 1.0], vec![1]));
        assert_eq!(meet(uniform(3), false, &[0.3, 0.6]), (vec![0.0, 0.3, 0.5, 0.6, 1.0], vec![1, 3]));
        assert_eq!(given(&[0.0, 0.5, 1.0], &[0.3]), (vec![0.0, 0.3, 0.5, 1.0], vec![1]));
        assert_eq!(given(&[0.0, 0.5, 1.0], &[0.49, 0.501]), (vec![0.0, 0.49, 0.501, 1.0], vec![1, 2]));
        for (n, breaks) in [(7, vec![0.31, 0.33, 0.9]), (4, vec![0.1, 0.2, 0.3, 0.4]), (2, vec![0.7])] {
            let (s, numbers) = meet(uniform(n), false, &breaks);
            assert!(s.is_sorted_by(|a, b| a < b), "{s:?}");
            assert_eq!(numbers.iter().map(|i| s[*i]).collect::<Vec<_>>(), breaks);
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
