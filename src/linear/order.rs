//! The order in which the nodes of a symmetric band are eliminated.
//!
//! The elimination of a node, and each step of a substitution, has to wait for the result of the
//! one before. A cable element couples only neighbouring nodes, so that its nodes can be eliminated
//! alternately from both ends towards the middle:
//!
//! ```text
//! 0, n − 1, 1, n − 2, 2, …     position k leads to position k + 2, the last but one to the last
//! ```
//!
//! These are two chains of half the length that do not wait for each other: a factorisation takes
//! four fifths of the time, a substitution three fifths.
//!
//! This order is used only for matrices that contain a mass. In equilibria, without a mass, the
//! nodes eliminated last decide how many digits are lost, and the order from the first node to the
//! last loses fewer: from both ends, the relaxation of a slack cable did not converge. Wider bands
//! are eliminated from the first node to the last, too.

/// The order of elimination for a number of nodes.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    nodes: usize,
    from_both_ends: bool,
}

impl Order {
    /// An order of `nodes` nodes; `from_both_ends` requires that each node is coupled only with its
    /// neighbours.
    #[inline(always)]
    pub fn new(nodes: usize, from_both_ends: bool) -> Self {
        Self { nodes, from_both_ends }
    }

    /// The node at a position.
    #[inline(always)]
    pub fn node(self, position: usize) -> usize {
        match (self.from_both_ends, position % 2) {
            (false, _) => position,
            (true, 0) => position / 2,
            (true, _) => self.nodes - 1 - position / 2,
        }
    }

    /// The position of the `block`th node (from 1 on) with which the node at `position` is coupled
    /// when it is eliminated.
    #[inline(always)]
    pub fn next(self, position: usize, block: usize) -> Option<usize> {
        let next = if self.from_both_ends { (position + 2).min(self.nodes - 1) } else { position + block };
        (next < self.nodes && next > position).then_some(next)
    }

    /// Whether `position` is the first of two successive positions whose nodes do not depend on
    /// each other and can be eliminated together.
    #[inline(always)]
    pub fn is_pair(self, position: usize) -> bool {
        self.from_both_ends && position.is_multiple_of(2) && position + 2 < self.nodes
    }

    /// The place of block number `block` of the node at `position` in the matrix: the node in whose
    /// panel it is, and whether it must be transposed.
    #[inline(always)]
    pub fn source(self, position: usize, block: usize) -> (usize, bool) {
        let node = self.node(position);
        let before = self.from_both_ends && position % 2 == 1 && block == 1;
        (node - usize::from(before), before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_and_every_coupling_has_its_turn() {
        for nodes in 1..9 {
            for (blocks, from_both_ends) in [(2, true), (2, false), (4, false)] {
                let order = Order::new(nodes, from_both_ends);
                let mut coupled = Vec::new();
                for position in 0..nodes {
                    for (block, next) in (1..blocks).filter_map(|b| Some((b, order.next(position, b)?))) {
                        let (ours, theirs) = (order.node(position), order.node(next));
                        let (panel, turned) = order.source(position, block);
                        assert_eq!((panel, turned), (ours.min(theirs), theirs < ours));
                        coupled.push((panel, ours.max(theirs)));
                    }
                }
                coupled.sort_unstable();
                let all = (0..nodes).flat_map(|i| (i + 1..nodes.min(i + blocks)).map(move |j| (i, j)));
                assert_eq!(coupled, all.collect::<Vec<_>>(), "{nodes} nodes, {blocks} blocks");
                let mut eliminated: Vec<usize> = (0..nodes).map(|k| order.node(k)).collect();
                eliminated.sort_unstable();
                assert_eq!(eliminated, (0..nodes).collect::<Vec<_>>());
            }
        }
    }
}
