//! A beam among the coordinates of a system.

use super::BuildError;
use crate::basis::Basis;

/// Distance beyond an end or beside a node, per length, that counts as round-off.
const PLACE_ROUND_OFF: f64 = 1e-9;

/// A beam as its shape functions see it, and its place among the coordinates.
#[derive(Debug)]
pub struct DiscretizedBeam {
    /// The beam's name.
    pub name: String,
    /// Its shape functions.
    pub basis: Basis,
    /// Its first node in the system.
    pub first_node: usize,
    /// Whether the stress-free state is straight to round-off, as the shape functions see it.
    pub straight: bool,
}

impl DiscretizedBeam {
    /// First coefficient in the system: two a node.
    pub fn offset(&self) -> usize {
        2 * self.first_node
    }

    /// The arc length `s`, where `what` stands; round-off beyond an end and beside a node is cut
    /// off.
    ///
    /// # Errors
    /// [`BuildError::OffBeam`].
    pub fn arc_length(&self, what: &'static str, s: f64) -> Result<f64, BuildError> {
        let length = self.basis.length();
        // A length computed elsewhere may differ by round-off.
        if s >= -PLACE_ROUND_OFF * length && s <= (1.0 + PLACE_ROUND_OFF) * length {
            let nodes = self.basis.nodes();
            let right = nodes.partition_point(|node| *node < s).min(nodes.len() - 1);
            let near = |node: &&f64| (**node - s).abs() <= PLACE_ROUND_OFF * length;
            let node = nodes[right.saturating_sub(1)..=right].iter().find(near);
            Ok(node.copied().unwrap_or_else(|| s.clamp(0.0, length)))
        } else {
            Err(BuildError::OffBeam { what, beam: self.name.clone(), s, length })
        }
    }
}
