//! Angles that count turns: a tip that has gone round once stands at 2π, not at 0.

use crate::assembly::{DiscretizedBeam, Node, nodes};
use crate::system::unfold;

/// By how much the node of a beam nearest to `s` has turned between two states. One load step may
/// wind a beam up by whole turns. But some node, such as a clamped one, has turned by less than
/// half a turn, and the turns of the others follow from cell to cell.
pub(super) fn turn(part: &DiscretizedBeam, s: f64, before: &[f64], now: &[f64]) -> f64 {
    let first = 4 * part.first_node;
    let angles = |q: &'_ [f64]| {
        let nodes = nodes(&q[first..first + 4 * part.basis.nodes().len()]);
        nodes.map(|Node { gradient: [x, y], .. }| y.atan2(x)).collect::<Vec<_>>()
    };
    let folded: Vec<f64> = angles(before)
        .into_iter()
        .zip(angles(now))
        .map(|(before, now)| unfold(now - before, Some(0.0)))
        .collect();
    let sizes = folded.iter().map(|turn| turn.abs()).enumerate();
    let still = sizes.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(node, _)| node);
    let distances = part.basis.nodes().iter().map(|node| (node - s).abs()).enumerate();
    let target = distances.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(node, _)| node);
    let follow = |turn: f64, next: &f64| unfold(*next, Some(turn));
    if target >= still {
        folded[still + 1..=target].iter().fold(folded[still], follow)
    } else {
        folded[target..still].iter().rev().fold(folded[still], follow)
    }
}
