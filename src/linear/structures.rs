//! The structures into which a bordered matrix falls: nodes that neither an entry nor a row ties to
//! those of others.

use super::Matrix;
use super::bordered::BorderRow;

/// The structure of each unknown, and then of each row of `border`, by the number of one of its nodes.
pub fn structures(matrix: &Matrix, border: &[BorderRow]) -> Vec<usize> {
    let nodes = matrix.size() / 4;
    let mut towards: Vec<usize> = (0..nodes).collect();
    for node in 0..nodes {
        let coupled = |other: &usize| {
            let entries = (0..16).map(|k| (4 * node + k / 4, 4 * other + k % 4));
            entries.into_iter().any(|(i, j)| matrix.get(i, j) != 0.0 || matrix.get(j, i) != 0.0)
        };
        let ahead = node + 1..matrix.columns(4 * node).end / 4;
        ahead.filter(coupled).for_each(|other| join(&mut towards, node, other));
    }
    let node_of = |(i, _): &(usize, f64)| i / 4;
    for row in border {
        let Some(first) = row.first().map(node_of) else { continue };
        row.iter().map(node_of).for_each(|other| join(&mut towards, first, other));
    }
    let of_node: Vec<usize> = (0..nodes).map(|node| end(&towards, node)).collect();
    let of_rows = border.iter().map(|row| row.first().map_or(0, |entry| of_node[node_of(entry)]));
    of_node.iter().flat_map(|structure| [*structure; 4]).chain(of_rows).collect()
}

/// The node in which the way from `node` ends.
fn end(towards: &[usize], mut node: usize) -> usize {
    while towards[node] != node {
        node = towards[node];
    }
    node
}

/// Lets the ways from two nodes end in the same one, the first of both ends.
fn join(towards: &mut [usize], a: usize, b: usize) {
    let (a, b) = (end(towards, a), end(towards, b));
    towards[a.max(b)] = a.min(b);
}
