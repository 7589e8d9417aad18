//! The sections of a beam: what they resist, what they weigh, and how strain and stress are
//! distributed over them.

use super::{Along, Elastic};
use std::sync::Arc;

/// Stiffnesses and mass of the sections along a beam. A quantity that is `None` is not named in the
/// scene and not simulated; a beam without an axial stiffness keeps its length.
///
/// A fibre at the offset y from the centreline, counted to the left of the direction of rising s,
/// has the strain ε − y κ. Over a section of Young's modulus E(y)
///
/// ```text
/// N = EA ε + EB κ,   M = EB ε + EI κ,   EA = ∫ E dA,   EB = −∫ E y dA,   EI = ∫ E y² dA
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// EA \[N\].
    pub axial_stiffness: Option<Along>,
    /// EI \[N m²\].
    pub bending_stiffness: Option<Along>,
    /// N of the axial strain, where it is not EA ε; EA is then the largest slope.
    pub axial_law: Option<Arc<Elastic>>,
    /// M of the curvature, where it is not EI κ; EI is then the largest slope.
    pub bending_law: Option<Arc<Elastic>>,
    /// Arc lengths \[m\], rising, at which cells are divided for the sums of the axial and of the bending law,
    /// since a stiffness jumps there.
    pub law_jumps: [Vec<f64>; 2],
    /// EB \[N m\], where the centreline is not the neutral line of bending; it needs both
    /// stiffnesses.
    pub coupling: Option<Along>,
    /// ρA \[kg/m\].
    pub mass_per_length: Option<Along>,
    /// ρI \[kg m\], about the centreline. It has an effect only as a part
    /// [`crate::effect::SectionInertia`].
    pub rotary_inertia: Option<Along>,
    /// The layers of the section, from its right face to its left one; empty where its shape is not
    /// known.
    pub layers: Vec<Layer>,
}

/// A layer of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// E \[Pa\], where it is known.
    pub youngs_modulus: Option<Along>,
    /// Offset of the face on the right \[m\].
    pub bottom: Along,
    /// Offset of the face on the left \[m\].
    pub top: Along,
    /// The parts of EA \[N\] and of EB \[N m\] that it contributes, where a strain may be imposed
    /// on it alone.
    pub stiffness: Option<[Along; 2]>,
}

impl Section {
    /// A section without mass, with the axial stiffness EA \[N\] and the bending stiffness EI
    /// \[N m²\].
    pub fn new(axial_stiffness: impl Into<Along>, bending_stiffness: impl Into<Along>) -> Self {
        Self {
            axial_stiffness: Some(axial_stiffness.into()),
            bending_stiffness: Some(bending_stiffness.into()),
            ..Self::default()
        }
    }

    /// The same section with the mass per length ρA \[kg/m\].
    #[must_use]
    pub fn weighing(self, mass_per_length: impl Into<Along>) -> Self {
        Self { mass_per_length: Some(mass_per_length.into()), ..self }
    }

    /// Whether strain and curvature are proportional to axial force and bending moment.
    pub fn is_linear(&self) -> bool {
        self.axial_law.is_none() && self.bending_law.is_none()
    }

    /// The stiffnesses and the mass that are given.
    pub fn quantities(&self) -> impl Iterator<Item = &Along> {
        [&self.axial_stiffness, &self.bending_stiffness, &self.coupling, &self.mass_per_length]
            .into_iter()
            .flatten()
    }

    /// Arc lengths \[m\] at which a quantity jumps, or a stiffness or the mass has a corner between which a
    /// cell would not see what lies, such as a notch; rising.
    pub fn breaks(&self) -> Vec<f64> {
        /// By this factor a quantity may depart from what its ends say.
        const SEEN: f64 = 1.5;
        // The coupling of stretch and bending has a sign, and no size of its own: the bending stiffness about
        // the neutral line tells what it does.
        let bending = self.uncoupled_bending_stiffness();
        let positive = [&self.axial_stiffness, &bending, &self.mass_per_length];
        let corners = positive.into_iter().flatten().flat_map(|quantity| quantity.corners(SEEN));
        let mut breaks: Vec<f64> = self.jumps().into_iter().chain(corners).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// Arc lengths \[m\] at which one of them jumps, rising.
    pub fn jumps(&self) -> Vec<f64> {
        let mut jumps: Vec<f64> = self.quantities().flat_map(Along::jumps).collect();
        jumps.sort_by(f64::total_cmp);
        jumps.dedup();
        jumps
    }

    /// EA \[N\], EB \[N m\] and EB²/EA \[N m²\] of a section whose stretch and bending are coupled. All are
    /// smooth between the same places, and are thus summed over the same cells, as the square
    /// EA (ε + EB/EA κ)² has to be in order to be positive.
    pub fn coupled_stiffnesses(&self) -> Option<[Along; 3]> {
        let (axial, coupling) = self.axial_stiffness.as_ref().zip(self.coupling.as_ref())?;
        let moved = coupling.product(coupling).over(axial);
        Some([axial.divided_like(coupling), coupling.divided_like(axial), moved])
    }

    /// EA \[N\], as [`Self::coupled_stiffnesses`] has it where stretch and bending are coupled.
    pub fn summed_axial_stiffness(&self) -> Option<Along> {
        match self.coupled_stiffnesses() {
            Some([axial, ..]) => Some(axial),
            None => self.axial_stiffness.clone(),
        }
    }

    /// EI − EB²/EA \[N m²\]: the bending stiffness about the neutral line, with which a section that is
    /// free to stretch resists.
    pub fn uncoupled_bending_stiffness(&self) -> Option<Along> {
        let bending = self.bending_stiffness.as_ref()?;
        Some(match self.coupled_stiffnesses() {
            Some([.., moved]) => bending.plus(&moved.times(-1.0)),
            None => bending.clone(),
        })
    }

    /// Offsets \[m\] of the outer faces on the right and on the left at `s`; `inside` as for
    /// [`Along::at`].
    pub fn faces(&self, s: f64, inside: f64) -> Option<[f64; 2]> {
        let faces = |layer: &Layer| [layer.bottom.at(s, inside), layer.top.at(s, inside)];
        self.layers.iter().map(faces).reduce(|[low, high], [bottom, top]| [low.min(bottom), high.max(top)])
    }

    /// Stresses \[Pa\] on the right and the left face of every layer at `s`, from the axial force
    /// \[N\] and the bending moment \[N m\]: σ = E (ε − y κ − ε₀), where ε and κ are those elastic
    /// strains that N and M cause together with the strains ε₀ that are `imposed` on the layers, none
    /// beyond the last one given. `None` where the section does not tell its shape or its modulus.
    pub fn stresses(
        &self,
        s: f64,
        inside: f64,
        [mut force, mut moment]: [f64; 2],
        imposed: &[f64],
    ) -> Option<Vec<[f64; 2]>> {
        if self.layers.is_empty() {
            return None;
        }
        let at = |along: &Along| along.at(s, inside);
        for (layer, imposed) in self.layers.iter().zip(imposed).filter(|(_, imposed)| **imposed != 0.0) {
            let [axial, coupling] = layer.stiffness.as_ref()?.each_ref().map(at);
            force += axial * imposed;
            moment += coupling * imposed;
        }
        let (axial, bending) = (at(self.axial_stiffness.as_ref()?), at(self.bending_stiffness.as_ref()?));
        let coupling = self.coupling.as_ref().map_or(0.0, at);
        let determinant = axial * bending - coupling * coupling;
        let strain = (bending * force - coupling * moment) / determinant;
        let curvature = (axial * moment - coupling * force) / determinant;
        let of_layer = |(number, layer): (usize, &Layer)| {
            let modulus = at(layer.youngs_modulus.as_ref()?);
            let elastic = strain - imposed.get(number).unwrap_or(&0.0);
            Some([&layer.bottom, &layer.top].map(|y| modulus * (elastic - at(y) * curvature)))
        };
        self.layers.iter().enumerate().map(of_layer).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small coupling of stretch and bending that falls to a tenth and rises again changes hardly anything,
    /// whatever its sign; a large one makes the bending stiffness about the neutral line fall likewise.
    #[test]
    fn sections_break_alike_on_both_sides() {
        let breaks = |size: f64| {
            let coupling = Along::Table { s: vec![0.0, 1.0, 2.0], value: vec![size, 0.1 * size, size] };
            Section { coupling: Some(coupling), ..Section::new(1.0, 1.0) }.breaks()
        };
        assert!(breaks(0.1).is_empty() && breaks(-0.1).is_empty());
        assert_eq!([breaks(0.9), breaks(-0.9)], [vec![1.0], vec![1.0]]);
    }

    /// A bar of width 1, height h = 0.2 and E = 5: σ = N/A ∓ 6 M/h², compressed on the left where M
    /// is positive.
    #[test]
    fn stresses_of_a_rectangle() {
        let layer = Layer {
            youngs_modulus: Some(5.0.into()),
            bottom: (-0.1).into(),
            top: 0.1.into(),
            stiffness: None,
        };
        let section = Section { layers: vec![layer], ..Section::new(1.0, 5.0 * 0.008 / 12.0) };
        let stresses = section.stresses(0.0, 0.0, [0.4, 0.03], &[]).unwrap();
        let expected = [0.4 / 0.2 + 6.0 * 0.03 / 0.04, 0.4 / 0.2 - 6.0 * 0.03 / 0.04];
        assert_eq!(stresses.len(), 1);
        for (stress, expected) in stresses[0].iter().zip(expected) {
            assert!((stress - expected).abs() < 1e-12, "{stresses:?}");
        }
        assert_eq!(section.faces(0.0, 0.0), Some([-0.1, 0.1]));
        assert_eq!(Section::new(1.0, 1.0).stresses(0.0, 0.0, [1.0, 1.0], &[]), None);
    }

    /// Two layers of E = 1 and 3 whose stresses add up to the N and M that they came from.
    #[test]
    fn stresses_of_layers_add_up_to_force_and_moment() {
        let layer = |modulus: f64, bottom: f64, top: f64| {
            let area = top - bottom;
            Layer {
                youngs_modulus: Some(modulus.into()),
                bottom: bottom.into(),
                top: top.into(),
                stiffness: Some([(modulus * area).into(), (-0.5 * modulus * area * (top + bottom)).into()]),
            }
        };
        let layers = vec![layer(1.0, -0.3, 0.1), layer(3.0, 0.1, 0.2)];
        let integral = |power: i32| -> f64 {
            let of = |(e, a, b): (f64, f64, f64)| {
                e * (b.powi(power + 1) - a.powi(power + 1)) / f64::from(power + 1)
            };
            of((1.0, -0.3, 0.1)) + of((3.0, 0.1, 0.2))
        };
        let section = Section {
            coupling: Some((-integral(1)).into()),
            layers,
            ..Section::new(integral(0), integral(2))
        };
        // Whether or not strains are imposed on the layers.
        for imposed in [vec![], vec![0.4], vec![-0.3, 0.7]] {
            let stresses = section.stresses(0.0, 0.0, [0.7, -0.2], &imposed).unwrap();
            // Linear stress over a layer: ∫ σ dy and −∫ σ y dy by Simpson's rule, which is exact.
            let sums = |[from, to]: [f64; 2], [bottom, top]: [f64; 2]| {
                let middle = 0.5 * (from + to);
                let h = top - bottom;
                let mean_y = 0.5 * (bottom + top);
                (h * middle, -h / 6.0 * (from * bottom + 4.0 * middle * mean_y + to * top))
            };
            let (a, b) = (sums(stresses[0], [-0.3, 0.1]), sums(stresses[1], [0.1, 0.2]));
            assert!((a.0 + b.0 - 0.7).abs() < 1e-12 && (a.1 + b.1 + 0.2).abs() < 1e-12, "{a:?} {b:?}");
        }
        assert_eq!(section.faces(0.0, 0.0), Some([-0.3, 0.2]));
    }
}
