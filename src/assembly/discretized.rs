//! A discretised beam and its position among the coordinates of a system.

use std::sync::Arc;

use super::BuildError;
use crate::basis::Basis;

/// Distance from an end or a node, in beam lengths, that counts as round-off.
const PLACE_ROUND_OFF: f64 = 1e-9;

/// The shape functions of a beam, and its position among the coordinates of a system.
#[derive(Debug)]
pub struct DiscretizedBeam {
    /// The beam's name.
    pub name: String,
    /// Its shape functions.
    pub basis: Arc<Basis>,
    /// Index of its first node in the system.
    pub first_node: usize,
    /// Whether the stress-free state, as interpolated by the shape functions, is straight to
    /// round-off.
    pub straight: bool,
}

impl DiscretizedBeam {
    /// Index of its first coefficient in the system; there are two coefficients per node.
    pub fn offset(&self) -> usize {
        2 * self.first_node
    }

    /// The arc length `s` with round-off removed: it is moved to an end or a node that is within
    /// round-off of it. `what` names the item at `s`, for the error.
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
