//! The support of each cell, and the cells that share their shape functions.

use std::ops::Range;

/// Number of the latest distinct cells with which a new one is compared: enough for meshes that
/// repeat a pattern.
const RECENT: usize = 16;

/// The support of each cell: the nodes on which its shape functions depend.
#[derive(Clone, Debug)]
pub struct Supports {
    neighbours: usize,
    nodes: usize,
    /// Number of nodes in the widest support.
    widest: usize,
    /// Nodes at which supports end, in rising order: the two end nodes of the beam, and between
    /// them those at which the curvature jumps, since no smooth function follows it there.
    ends: Vec<usize>,
}

impl Supports {
    /// The support of a cell consists of its own two nodes and up to `neighbours` more on each
    /// side; it does not extend beyond the beam's ends or the nodes `breaks`, which are in rising
    /// order.
    pub fn new(neighbours: usize, nodes: usize, breaks: &[usize]) -> Self {
        let ends = std::iter::once(0).chain(breaks.iter().copied()).chain([nodes - 1]).collect();
        let supports = Self { neighbours, nodes, widest: 2, ends };
        let widest = (0..nodes - 1).map(|cell| supports.of(cell).len()).max().unwrap_or(2);
        Self { widest, ..supports }
    }

    /// Number of nodes in the widest support. The functions of every cell are tabulated for this
    /// many nodes, so that all rows have one length.
    pub fn widest(&self) -> usize {
        self.widest
    }

    /// The first of the nodes for which a cell's functions are tabulated; their number is
    /// [`Self::widest`].
    pub fn first(&self, cell: usize) -> usize {
        self.of(cell).start.min(self.nodes - self.widest)
    }

    /// Number of tabulated nodes before the cell's support, for which the functions are zero.
    pub fn padding(&self, cell: usize) -> usize {
        self.of(cell).start - self.first(cell)
    }

    /// The nodes at which supports end, other than the beam's first and last.
    pub fn breaks(&self) -> impl Iterator<Item = usize> + '_ {
        self.ends[1..self.ends.len() - 1].iter().copied()
    }

    /// Nodes of the support of `cell`, as a half-open range.
    pub fn of(&self, cell: usize) -> Range<usize> {
        let right = self.ends.partition_point(|end| *end <= cell).clamp(1, self.ends.len() - 1);
        let (first, last) = (self.ends[right - 1], self.ends[right]);
        cell.saturating_sub(self.neighbours).max(first)
            ..cell.saturating_add(self.neighbours).saturating_add(2).min(last + 1)
    }
}

/// Groups cells whose supports are translations of each other. Returns the number of its group per
/// cell, and the first cell per group.
///
/// Node positions are rounded to double precision, so the spacings of an even mesh differ in their
/// last digits. Two supports count as equal if their spacings agree within that round-off and
/// within 1e-9 of the smaller one, and if their rows are padded with the same zeros. The first cell
/// represents its group: it is the nearest to s = 0, where spacings are rounded the least.
pub fn distinct_cells(nodes: &[f64], supports: &Supports) -> (Vec<u32>, Vec<u32>) {
    let mut representative: Vec<u32> = Vec::new();
    let shape_of = (0..nodes.len() - 1)
        .map(|cell| {
            let here = supports.of(cell);
            let found = representative.iter().enumerate().rev().take(RECENT).find(|(_, other)| {
                let other = **other as usize;
                let there = supports.of(other);
                let alike = here.len() == there.len() && cell - here.start == other - there.start;
                alike && supports.padding(cell) == supports.padding(other) && {
                    let (here, there) = (&nodes[here.clone()], &nodes[there]);
                    let round_off = 4.0 * f64::EPSILON * here[here.len() - 1].max(there[there.len() - 1]);
                    here.windows(2).zip(there.windows(2)).all(|(a, b)| {
                        let (a, b) = (a[1] - a[0], b[1] - b[0]);
                        (a - b).abs() <= round_off.min(1e-9 * a.min(b))
                    })
                }
            });
            match found {
                Some((group, _)) => group as u32,
                None => {
                    representative.push(cell as u32);
                    (representative.len() - 1) as u32
                }
            }
        })
        .collect();
    (shape_of, representative)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supports_are_clipped_at_the_ends_and_at_breaks() {
        let supports = Supports::new(2, 9, &[]);
        assert_eq!([0, 4, 7].map(|cell| supports.of(cell)), [0..4, 2..8, 5..9]);
        assert_eq!(Supports::new(usize::MAX, 3, &[]).of(1), 0..3);
        let broken = Supports::new(2, 9, &[3, 4]);
        assert_eq!([0, 2, 3, 4, 7].map(|cell| broken.of(cell)), [0..4, 0..4, 3..5, 4..8, 5..9]);
        assert_eq!(
            [0, 2, 3, 4, 7].map(|cell| (broken.first(cell), broken.padding(cell))),
            [(0, 0), (0, 0), (3, 0), (4, 0), (4, 1)]
        );
        // Cells 0 and 4 have the same functions, but their rows are not padded with the same zeros.
        let even: Vec<f64> = (0..8).map(f64::from).collect();
        let (shape_of, _) = distinct_cells(&even, &Supports::new(2, 8, &[4]));
        assert_ne!(shape_of[0], shape_of[4]);
    }

    #[test]
    fn patterns_share_and_differences_do_not() {
        let alternating: Vec<f64> = (0..50).map(|i| i as f64 + if i % 2 == 0 { 0.0 } else { 0.3 }).collect();
        assert_eq!(distinct_cells(&alternating, &Supports::new(0, 50, &[])).1, [0, 1]);
        let (shape_of, representative) = distinct_cells(&alternating, &Supports::new(1, 50, &[]));
        assert_eq!((representative, shape_of[7], shape_of[48]), (vec![0, 1, 2, 48], 1, 3));
        let bent: Vec<f64> = (0..20).map(|i| i as f64 + 1e-6 * (i * i) as f64).collect();
        assert_eq!(distinct_cells(&bent, &Supports::new(0, 20, &[])).1.len(), 19);
    }
}
