//! Force fields that are narrower than the distances of the points at which they are summed.

use crate::effect::ForceField;
use crate::model::Model;
use crate::system::{System, View};
use std::any::Any;

/// Evenly spaced places of a beam at which a field is looked at.
const PLACES: usize = 2000;
/// Part of the largest sum of a field in any state by which both sums may differ.
const MISSED: f64 = 0.2;
/// Forces below this part of the stiffness are none.
const NOTHING: f64 = 1e-30;

/// A message for every force field whose sum over the points of the mesh is not the one that it has on the beam, in one of the
/// states: their coordinates and times \[s\]. Such a field acts between the points, and neither a coarser mesh nor a finer one
/// need see it.
pub(super) fn missed<'a>(
    model: &'a Model,
    system: &'a System,
    states: &'a [(&'a [f64], f64)],
) -> impl Iterator<Item = String> + 'a {
    model.parts.iter().filter_map(move |part| {
        let part: &dyn Any = part.as_ref();
        let field = part.downcast_ref::<ForceField>()?;
        let (even, points) = (even(system, field.beam)?, points(model, system, field)?);
        let sums_in = |(q, time): &(&[f64], f64)| {
            [&even, &points].map(|(view, weights)| sum(field, view, weights, q, *time))
        };
        let sums: Vec<[f64; 2]> = states.iter().map(sums_in).filter(|[a, b]| (a + b).is_finite()).collect();
        // A field that is nowhere to be felt in these states tells nothing.
        let largest = sums.iter().flatten().fold(NOTHING * system.stiffness(), |most, sum| most.max(*sum));
        let off = |[fine, summed]: &[f64; 2]| (fine - summed).abs();
        let [fine, summed] = sums.into_iter().max_by(|a, b| off(a).total_cmp(&off(b)))?;
        (off(&[fine, summed]) > MISSED * largest).then(|| {
            format!(
                "the force field on beam `{}` is narrower than its cells: of {fine:.3e} N, summed by size, the points of the mesh see \
                 {summed:.3e} N; use more elements or nodes where it acts (`nodes` may be a list of arc lengths)",
                model.beams[field.beam].name
            )
        })
    })
}

/// ∫ |F| ds \[N\].
fn sum(field: &ForceField, view: &View, weights: &[f64], q: &[f64], time: f64) -> f64 {
    let places = view.positions(1, q).zip(view.s()).zip(weights);
    places
        .map(|(([x, y], s), weight)| {
            let [fx, fy] = field.field.at([x, y, time]);
            weight * field.acting.at(*s, *s) * fx.hypot(fy)
        })
        .sum()
}

/// The middles of many equal parts of a beam, with their lengths \[m\].
fn even(system: &System, beam: usize) -> Option<(View, Vec<f64>)> {
    let part = system.beams().get(beam)?;
    let width = part.basis.length() / PLACES as f64;
    let s: Vec<f64> = (0..PLACES).map(|k| (k as f64 + 0.5) * width).collect();
    Some((View::points(&part.basis, part.offset(), &s).ok()?, vec![width; PLACES]))
}

/// The points at which the field is summed, with their weights \[m\].
fn points(model: &Model, system: &System, field: &ForceField) -> Option<(View, Vec<f64>)> {
    let (part, beam) = (system.beams().get(field.beam)?, model.beams.get(field.beam)?);
    let (xi, weights) = beam.gauss_points.of_loads().rule().ok()?;
    // Cells are divided where what acts begins and ends.
    let jumps = field.acting.jumps().into_iter().filter(|s| (0.0..part.basis.length()).contains(s));
    let mut ends: Vec<f64> = part.basis.nodes().iter().copied().chain(jumps).collect();
    ends.sort_by(f64::total_cmp);
    let (mut s, mut lengths) = (Vec::new(), Vec::new());
    for cell in ends.windows(2) {
        let width = cell[1] - cell[0];
        s.extend(xi.iter().map(|xi| cell[0] + xi * width));
        lengths.extend(weights.iter().map(|weight| weight * width));
    }
    Some((View::points(&part.basis, part.offset(), &s).ok()?, lengths))
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    /// A force of 0.1 N/m along 1 m is seen whole, and a bump of 3 mm by 8 elements not at all; by 400 it is.
    #[test]
    fn fields_narrower_than_the_cells_are_told() {
        let messages = |elements: usize, value: &str| {
            let text = format!(
                "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 10, basis.ancf.elements = {elements} }}\n\
                 support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
                 effect.force_field = [{{ beam = 'arm', value = ['0', '{value}'] }}]\nanalysis.static = {{}}\n"
            );
            let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
            let results = scene.model().solve(scene.analysis()).expect("an equilibrium");
            results.run().warnings.clone()
        };
        let narrow = "100*exp(-((x-0.43)/0.003)^2)";
        let found = messages(8, narrow);
        // ∫ 100 exp(−(x/0.003)²) dx = 0.3 √π.
        assert!(
            found.iter().any(|text| text.contains("narrower than its cells: of 5.317e-1 N")),
            "{found:?}"
        );
        for (elements, value) in [(8, "0.1"), (8, "sin(3*x)"), (400, narrow)] {
            assert_eq!(messages(elements, value), [""; 0], "{value}");
        }
    }
}
