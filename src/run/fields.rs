//! Force fields that are narrower than the distances of the points at which they are summed.

use crate::assembly::Part;
use crate::effect::ForceField;
use crate::model::Model;
use crate::numeric::spread;
use crate::system::{System, View};
use nalgebra::Vector2;
use std::any::Any;
use std::sync::Arc;

/// Places of a beam at which a field is looked at …
const PLACES: usize = 2000;
/// … and those of a cell at least.
const OF_A_CELL: usize = 12;
/// Part of the largest sum of a field in any state by which the sums over the cells may differ.
const MISSED: f64 = 0.1;
/// Forces below this part of the stiffness are none.
const NOTHING: f64 = 1e-30;

/// A message for every force field whose sums over the points of the cells are not those that it has on the beam, in one of the
/// states: their coordinates and times \[s\]. Such a field changes between the points, and neither a coarser mesh nor a finer one
/// need see it.
pub(super) fn missed(model: &Model, system: &System, states: &[(&[f64], f64)]) -> Vec<String> {
    let message = |part: &Arc<dyn Part>| {
        let part: &dyn Any = part.as_ref();
        let field = part.downcast_ref::<ForceField>()?;
        let cells = cells(system, field)?;
        let (xi, weights) = model.beams.get(field.beam)?.gauss_points.of_loads().rule().ok()?;
        let fine = OF_A_CELL.max(PLACES / cells.len());
        let even = points(system, field, &cells, &spread(fine).collect::<Vec<_>>())?;
        let summed = points(system, field, &cells, &xi)?;
        let even_weights = vec![1.0 / fine as f64; fine];
        let sums = |(q, time): &(&[f64], f64)| {
            let fine = means(field, &even, &even_weights, q, *time);
            let seen = means(field, &summed, &weights, q, *time);
            let of_cells = fine.into_iter().zip(seen).zip(&cells);
            of_cells.fold([0.0; 2], |[off, size], (((fine, of), (seen, by)), [start, end])| {
                let width = end - start;
                [off + width * (fine - seen).norm(), size + width * of.max(by)]
            })
        };
        let found: Vec<[f64; 2]> = states.iter().map(sums).filter(|[a, b]| (a + b).is_finite()).collect();
        // A field that is nowhere to be felt in these states tells nothing.
        let largest = found.iter().fold(NOTHING * system.stiffness(), |most, [_, size]| most.max(*size));
        let off = found.iter().fold(0.0_f64, |most, [off, _]| most.max(*off)) / largest;
        (off > MISSED).then(|| {
            format!(
                "the force field on beam `{}` changes within its cells by more than their points see: what they sum up differs by {:.0} % of \
                 its size from what acts; use more elements or nodes where it acts (`nodes` may be a list of arc lengths)",
                model.beams[field.beam].name,
                100.0 * off
            )
        })
    };
    model.parts.iter().filter_map(message).collect()
}

/// Per cell, the means of F and of |F| \[N/m\] over its points.
fn means(field: &ForceField, view: &View, weights: &[f64], q: &[f64], time: f64) -> Vec<(Vector2<f64>, f64)> {
    let force =
        |([x, y], s): ([f64; 2], &f64)| Vector2::from(field.field.at([x, y, time])) * field.acting.at(*s, *s);
    let forces: Vec<Vector2<f64>> = view.positions(1, q).zip(view.s()).map(force).collect();
    let of_cell = |forces: &[Vector2<f64>]| {
        let mean = |(sum, size): (Vector2<f64>, f64), (force, weight): (&Vector2<f64>, &f64)| {
            (sum + force * *weight, size + force.norm() * weight)
        };
        forces.iter().zip(weights).fold((Vector2::zeros(), 0.0), mean)
    };
    forces.chunks_exact(weights.len()).map(of_cell).collect()
}

/// The cells of its beam, divided where what acts begins and ends.
fn cells(system: &System, field: &ForceField) -> Option<Vec<[f64; 2]>> {
    let part = system.beams().get(field.beam)?;
    let jumps = field.acting.jumps().into_iter().filter(|s| (0.0..part.basis.length()).contains(s));
    let mut ends: Vec<f64> = part.basis.nodes().iter().copied().chain(jumps).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    Some(ends.windows(2).map(|cell| [cell[0], cell[1]]).collect())
}

/// The same places within each of the cells.
fn points(system: &System, field: &ForceField, cells: &[[f64; 2]], within: &[f64]) -> Option<View> {
    let part = system.beams().get(field.beam)?;
    let of_cell = |&[start, end]: &[f64; 2]| within.iter().map(move |xi| start + xi * (end - start));
    let s: Vec<f64> = cells.iter().flat_map(of_cell).collect();
    View::points(&part.basis, part.offset(), &s).ok()
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    /// A force of 0.1 N/m along 1 m is seen whole, and a bump of 3 mm by 8 elements not at all; by 400 it is.
    #[test]
    fn fields_narrower_than_the_cells_are_told() {
        let told = |elements: usize, value: &str| {
            let text = format!(
                "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 10, basis.ancf.elements = {elements} }}\n\
                 support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
                 effect.force_field = [{{ beam = 'arm', value = ['0', '{value}'] }}]\nanalysis.static = {{}}\n"
            );
            let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
            let results = scene.model().solve(scene.analysis()).expect("an equilibrium");
            let about_fields = |text: &&String| text.contains("changes within its cells");
            results.run().warnings.iter().filter(about_fields).count()
        };
        let narrow = "100*exp(-((x-0.43)/0.003)^2)";
        assert_eq!(told(8, narrow), 1);
        // As many waves as would look constant at the points of eight cells, and others.
        for waves in [16, 24, 40, 56, 64, 136, 144, 160, 192] {
            assert_eq!(told(8, &format!("3*cos(2*pi*{waves}*x)")), 1, "{waves} waves");
        }
        for (elements, value) in
            [(8, "0.1"), (8, "sin(3*x)"), (8, "3*cos(2*pi*8*x)"), (400, narrow), (100, "3*cos(2*pi*64*x)")]
        {
            assert_eq!(told(elements, value), 0, "{value}");
        }
    }
}
