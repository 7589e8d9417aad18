//! Elastic foundation along a beam.

use super::spring::GroundSpring;
use crate::assembly::{Assembly, BuildError, Extent, Kind, Part, Resistance, edges_along};
use crate::beam::{Along, Place};
use nalgebra::Vector2;

/// Winkler foundation, W = ½ (k_x u_x² + k_y u_y²) per length with the displacement u = r − r₀. For
/// a beam along x, k_y is the usual foundation modulus.
#[derive(Clone, Debug, PartialEq)]
pub struct Foundation {
    /// Index of the beam.
    pub beam: usize,
    /// k_x, k_y \[N/m²\].
    pub stiffness: [Along; 2],
}

impl Part for Foundation {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        assembly.beam("a foundation", self.beam)?;
        let rule = assembly.mass_rule(self.beam);
        for (extent, stiffness) in Extent::pairs_along(self.beam, rule, &self.stiffness) {
            assembly.elastic(Kind::Foundation, extent, |z: Vec<[Vector2<f64>; 1]>| {
                GroundSpring::new(stiffness, z.into_iter().map(|[r]| r).collect())
            })?;
        }
        Ok(())
    }

    fn fades(&self) -> bool {
        true
    }

    fn resists(&self) -> Vec<Resistance> {
        let start = Place { beam: self.beam, s: 0.0 };
        let axes = [[1.0, 0.0], [0.0, 1.0]].into_iter().zip(&self.stiffness);
        let held = axes.filter(|(_, k)| !k.is_zero()).map(|(axis, _)| Resistance::Displacement(start, axis));
        held.chain([Resistance::Direction(start)]).collect()
    }

    fn edges(&self) -> Vec<Place> {
        edges_along(self.beam, &self.stiffness)
    }
}
