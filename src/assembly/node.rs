//! The entries of a vector that belong to one node.

/// The entries at one node of a vector of nodal coordinates \[x, y, x', y'\], of their changes or
/// rates, or of the forces on them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The entries that belong to the position r.
    pub position: [f64; 2],
    /// The entries that belong to the gradient r'.
    pub gradient: [f64; 2],
}

impl Node {
    /// Length of the entries for the position.
    pub fn shift(&self) -> f64 {
        self.position[0].hypot(self.position[1])
    }

    /// Length of the entries for the gradient.
    pub fn slope(&self) -> f64 {
        self.gradient[0].hypot(self.gradient[1])
    }
}

/// The nodes of a vector, which must not contain multipliers.
pub fn nodes(vector: &[f64]) -> impl ExactSizeIterator<Item = Node> + Clone + '_ {
    let node = |&[x, y, dx, dy]: &[f64; 4]| Node { position: [x, y], gradient: [dx, dy] };
    vector.as_chunks().0.iter().map(node)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_has_a_position_and_a_gradient() {
        let vector = [1.0, 2.0, 3.0, 4.0, 5.0, 12.0, 6.0, -8.0];
        let [first, second] = nodes(&vector).collect::<Vec<_>>()[..] else { panic!("two nodes") };
        assert_eq!((first.position, first.gradient), ([1.0, 2.0], [3.0, 4.0]));
        assert_eq!((first.slope(), second.shift(), second.slope()), (5.0, 13.0, 10.0));
    }
}
