//! Modes in waves that are too short for the cells.
//!
//! Cubic shape functions take the curvature in a cell of the length h for a linear one. Of a wave with the wavenumber k the energy
//! that they miss is
//!
//! ```text
//! k⁴/720 ∫ EI κ² h⁴ ds
//! ```
//!
//! and by this part of all elastic energy a critical load is too large, and a frequency by half of it. Meshfree shape functions follow
//! waves to 1 % that are longer than 1.7 cells, and none below that.

use crate::model::{Discretization, Model};
use crate::numeric::plain;
use crate::results::ModeShape;
use crate::system::System;
use std::f64::consts::TAU;

/// Part of itself by which a frequency or a critical load may be off before a warning says so.
const TOLERATED: f64 = 0.02;

/// Waves of so many cells are followed by meshfree shape functions.
const MESHFREE: f64 = 1.7;

/// The waves of a beam in a mode.
struct Waves {
    /// Their wavenumber \[1/m\].
    number: f64,
    /// The length of the cells where the beam bends \[m\].
    cell: f64,
    /// Twice the energy of bending, and what is missed of it \[N m\].
    energy: f64,
    missed: f64,
}

impl Waves {
    /// `None` of beams that do not bend.
    fn of(model: &Model, system: &System, beam: usize, shape: &ModeShape) -> Option<Self> {
        let bending = model.beams.get(beam)?.section.bending_stiffness.as_ref()?;
        let basis = &system.beams().get(beam)?.basis;
        let inside = 0.5 * basis.length();
        let integral = |of: &dyn Fn(usize) -> f64| -> f64 {
            let parts = (1..shape.s.len()).map(|k| 0.5 * (shape.s[k] - shape.s[k - 1]) * (of(k - 1) + of(k)));
            parts.sum()
        };
        let length = integral(&|_| 1.0);
        let mean = integral(&|k| shape.angle[k]) / length;
        let turned = integral(&|k| (shape.angle[k] - mean).powi(2));
        let bent = integral(&|k| shape.curvature[k].powi(2));
        let energy_at = |k: usize| bending.at(shape.s[k], inside) * shape.curvature[k].powi(2);
        let energy = integral(&energy_at);
        let fourth = integral(&|k| energy_at(k) * basis.spacing(basis.cell_at(shape.s[k])).powi(4));
        // Curvatures jump from cell to cell.
        let slope = |k: usize| {
            let (width, change) = (shape.s[k] - shape.s[k - 1], shape.curvature[k] - shape.curvature[k - 1]);
            let in_a_cell = width > 0.0 && basis.cell_at(shape.s[k - 1]) == basis.cell_at(shape.s[k]);
            if in_a_cell { change * change / width } else { 0.0 }
        };
        let slopes: f64 = (1..shape.s.len()).map(slope).sum();
        // Of less than a wave the mean turn is a part of it; in a cell of half a wave the slope of the curvature is half of what it should be.
        let [by_turns, by_slopes] = [(bent / turned).powi(2), 2.0 * (slopes / bent).powi(2)];
        let number = by_turns.min(by_slopes).powf(0.25);
        let waves = Self {
            number,
            cell: (fourth / energy).powf(0.25),
            energy,
            missed: number.powi(4) * fourth / 720.0,
        };
        let meshfree = matches!(model.beams[beam].discretization, Discretization::Rpim { .. });
        let resolved = meshfree && MESHFREE * waves.number * waves.cell < TAU;
        waves.missed.is_finite().then_some(if resolved { Self { missed: 0.0, ..waves } } else { waves })
    }
}

/// A warning about the first of the modes that is off by more than it may. Each comes with twice its elastic energy \[N m\], where that is
/// known beforehand; `part` is how much of what is missed of it `what` is off by.
pub(super) fn too_short<'m>(
    (model, system): (&Model, &System),
    what: &str,
    part: f64,
    modes: impl Iterator<Item = (&'m [ModeShape], Option<f64>)>,
) -> Option<String> {
    for (number, (shapes, energy)) in (1..).zip(modes) {
        let waves: Vec<(usize, Waves)> = (shapes.iter().enumerate())
            .filter_map(|(beam, shape)| Some((beam, Waves::of(model, system, beam, shape)?)))
            .collect();
        let energy = energy.unwrap_or_else(|| waves.iter().map(|(_, waves)| waves.energy).sum());
        let off = part * waves.iter().map(|(_, waves)| waves.missed).sum::<f64>() / energy;
        let worst = waves.iter().max_by(|(_, a), (_, b)| a.missed.total_cmp(&b.missed));
        // Where nothing resists a mode, or nothing bends in it, there is no part.
        if let Some((beam, worst)) = worst.filter(|_| off > TOLERATED && off.is_finite()) {
            return Some(format!(
                "{what} {number} may be off by {:.0} %, and those above it may be by more: in it beam `{}` has waves of {} m, and cells of {} m are too long \
                 for them; use more elements or nodes, or leave `basis` out and name an `accuracy`",
                100.0 * off,
                model.beams[*beam].name,
                plain(TAU / worst.number, 3),
                plain(worst.cell, 3)
            ));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    fn told(basis: &str, analysis: &str) -> Option<String> {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1, mass_per_length = 1, basis = {{ {basis} }} }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.force = [{{ beam = 'arm', at = 'end', value = [-1, 0] }}]\n{analysis}\n"
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).expect("modes");
        results.run().warnings.iter().find(|text| text.contains("too long for them")).cloned()
    }

    /// Of a cantilever on four elements the fifth frequency is 14 % above (4.5 π)² = 199.9 rad/s, the fourth 1.5 % above 120.9; five meshfree nodes
    /// have it to 0.5 %. On eight elements the eighth is 1.8 % off.
    #[test]
    fn frequencies_of_waves_too_short_for_the_cells_are_told() {
        let of = |basis: &str, count: usize| told(basis, &format!("analysis.modal = {{ count = {count} }}"));
        let found = of("ancf.elements = 4", 5).expect("a warning");
        assert!(found.starts_with("frequency 4 may be off by 3 %, and those above"), "{found}");
        assert_eq!(of("ancf.elements = 4", 3), None);
        assert_eq!(of("rpim.nodes = 5", 5), None);
        assert!(of("rpim.nodes = 5", 6).is_some());
        assert_eq!(of("ancf.elements = 8", 6), None);
    }

    /// A beam of EA = 1 N is first stretched by a quarter of a wave, at √EA π/2 = 1.57 rad/s, and does not bend in that.
    #[test]
    fn modes_without_bending_hide_none_behind_them() {
        let soft = "axial_stiffness = 1, bending_stiffness = 1";
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], {soft}, mass_per_length = 1, basis.ancf.elements = 1 }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\nanalysis.modal = {{ count = 3 }}\n"
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).expect("modes");
        assert!(results.eigenvalues()[0] < 0.3, "{:?}", results.eigenvalues());
        let told = results.run().warnings.iter().filter(|text| text.contains("too long for them"));
        assert_eq!(told.count(), 1);
    }

    /// The second critical load of a cantilever is (1.5 π)² EI/L² = 22.2; on one element it is 32.2.
    #[test]
    fn critical_loads_of_waves_too_short_for_the_cells_are_told() {
        let of = |elements: usize| {
            told(&format!("ancf.elements = {elements}"), "analysis.buckling = { count = 2 }")
        };
        let found = of(1).expect("a warning");
        assert!(found.starts_with("critical load 2 may be off by"), "{found}");
        assert_eq!(of(4), None);
    }
}
