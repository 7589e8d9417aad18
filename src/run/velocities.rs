//! Velocities at the start of a motion that are narrower than the cells of their beam.

use crate::assembly::DiscretizedBeam;
use crate::model::{Model, Profile};
use crate::system::{System, View};

/// Pieces of a beam in whose middles velocities are looked at …
const PIECES: usize = 2000;
/// … and those between two nodes, or two points of a table, at least.
const LEAST: usize = 4;
/// Part of a velocity's integral along the beam that may be missing.
const MISSED: f64 = 0.1;

/// A message for every beam whose velocity at the start of a motion changes within its cells by more than they can follow. They have its
/// values and slopes at their nodes, between which a push that is narrower is lost.
pub(super) fn missed(model: &Model, system: &System) -> Vec<String> {
    let message = |(index, part): (usize, &DiscretizedBeam)| {
        let given: Vec<&[Profile; 2]> = (model.initial_velocities.iter())
            .filter(|velocity| velocity.beam == index)
            .map(|velocity| &velocity.along)
            .collect();
        if given.iter().all(|along| **along == [Profile::None, Profile::None]) {
            return None;
        }
        let of = |s: f64| {
            given.iter().fold([[0.0; 2]; 2], |sum, along| {
                let more = [0, 1].map(|axis| along[axis].at(s));
                [0, 1].map(|axis| [0, 1].map(|order| sum[axis][order] + more[axis][order]))
            })
        };
        let nodes = part.basis.nodes();
        let at_nodes = nodes.iter().flat_map(|s| {
            let [[x, dx], [y, dy]] = of(*s);
            [x, y, dx, dy]
        });
        let at_nodes: Vec<f64> = at_nodes.collect();
        let pieces = pieces(nodes, given.iter().flat_map(|along| along.iter()));
        let middles: Vec<f64> = pieces.iter().map(|[from, to]| 0.5 * (from + to)).collect();
        let view = View::points(&part.basis, 0, &middles).ok()?;
        let seen = view.positions(1, &at_nodes).zip(&pieces).zip(&middles);
        let [off, size] = seen.fold([0.0; 2], |[off, size], (([x, y], [from, to]), s)| {
            let [[vx, _], [vy, _]] = of(*s);
            let width = to - from;
            [off + width * (x - vx).hypot(y - vy), size + width * vx.hypot(vy)]
        });
        (off > MISSED * size).then(|| {
            format!(
                "the velocity of beam `{}` at the start changes within its cells by more than they can follow: what they have differs by {:.0} % \
                 of its size from what is given; use more elements or nodes where it does (`nodes` may be a list of arc lengths)",
                part.name,
                100.0 * off / size
            )
        })
    };
    system.beams().iter().enumerate().filter_map(message).collect()
}

/// Pieces of a beam that end at its nodes and at the points of tables.
fn pieces<'p>(nodes: &[f64], profiles: impl Iterator<Item = &'p Profile>) -> Vec<[f64; 2]> {
    let length = nodes.last().copied().unwrap_or(0.0);
    let of_tables = profiles.flat_map(|profile| match profile {
        Profile::Table(table) => table.times(),
        _ => &[],
    });
    let mut ends: Vec<f64> = nodes.iter().chain(of_tables).copied().collect();
    ends.retain(|s| (0.0..=length).contains(s));
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let each = LEAST.max(PIECES / ends.len());
    let divided = ends.windows(2).flat_map(|ends| {
        let place = move |k: usize| ends[0] + k as f64 / each as f64 * (ends[1] - ends[0]);
        (0..each).map(move |k| [place(k), place(k + 1)])
    });
    divided.collect()
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    /// A push as wide as the beam is followed, and one of a centimetre by 8 elements not at all; by 400 it is. So it is whatever else moves.
    #[test]
    fn velocities_narrower_than_the_cells_are_told() {
        let messages = |elements: usize, velocity: &str| {
            let text = format!(
                "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = {elements} }}\n\
                 initial_velocity = [{{ beam = 'rod', value = [0, 5] }}, {{ beam = 'rod', {velocity} }}]\n\
                 analysis.dynamic = {{ duration = 1e-3, radau.tolerance = 1e-2 }}\n"
            );
            let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
            let results = scene.model().solve(scene.analysis()).expect("a motion");
            results.run().warnings.iter().filter(|text| text.contains("the velocity of beam `rod`")).count()
        };
        let push = |half: f64| {
            let s: Vec<f64> = (0..=400).map(|k| 0.0025 * f64::from(k)).collect();
            let vy: Vec<f64> = s.iter().map(|s| (-((s - 0.52) / half).powi(2)).exp()).collect();
            format!("table = {{ s = {s:?}, vy = {vy:?} }}")
        };
        assert_eq!([(8, 0.005), (8, 0.4), (400, 0.005)].map(|(n, half)| messages(n, &push(half))), [1, 0, 0]);
        assert_eq!([messages(8, "polynomial.vy = [0, 1, -3, 2]"), messages(8, "rotation = 3")], [0, 0]);
    }
}
