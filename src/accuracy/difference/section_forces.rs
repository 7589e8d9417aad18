//! By how much section forces differ.

use super::larger;
use super::negligible::{Negligible, tells};
use crate::results::Shape;
use crate::results::places::{interpolated, is_before};

/// The largest difference of axial and shear forces, relative to the largest of both and of M/L,
/// and of bending moments, relative to the largest of these; `None` where no force is larger than what round-off makes
/// of none. With these largest ones.
pub fn section_forces(
    coarse: &[Shape],
    fine: &[Shape],
    negligible: &[Negligible],
) -> (Option<f64>, [f64; 2]) {
    let kinds: [fn(&Shape) -> &Vec<f64>; 3] =
        [|shape| &shape.axial_force, |shape| &shape.shear_force, |shape| &shape.bending_moment];
    let error = |kind: fn(&Shape) -> &Vec<f64>| {
        let (mut largest, mut error) = (0.0_f64, 0.0_f64);
        for (a, b) in coarse.iter().zip(fine) {
            largest = kind(b).iter().fold(largest, |largest, value| largest.max(value.abs()));
            for (k, (s, value)) in a.s.iter().zip(kind(a)).enumerate() {
                if let Some(other) = interpolated(&b.s, kind(b), *s, !is_before(&a.s, k)) {
                    error = larger(error, (value - other).abs());
                }
            }
        }
        (error, largest)
    };
    let [(axial, n), (shear, q), (bending, m)] = kinds.map(error);
    // A force that is nowhere more than a small part of the others and of M/L is round-off.
    let length = fine.iter().filter_map(|shape| shape.s.last().copied()).fold(0.0, f64::max);
    let force = n.max(q).max(m / length);
    let no_force = negligible.iter().map(|beam| beam.force).reduce(f64::min).unwrap_or(0.0);
    let no_moment = negligible.iter().map(|beam| beam.moment(force)).fold(0.0, f64::max);
    let moment = if tells(m, bending, no_moment) { m } else { 0.0 };
    let error = tells(force, larger(axial, shear), no_force).then(|| {
        let bending = if moment > 0.0 { bending / moment } else { 0.0 };
        larger(larger(axial / force, shear / force), bending)
    });
    (error, [force, moment])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the forces the largest of both kinds counts, and M over the length; of moments their own.
    #[test]
    fn section_forces_err_by_their_largest() {
        let shape = |axial: [f64; 2], shear: [f64; 2], moment: [f64; 2]| Shape {
            s: vec![0.0, 2.0],
            axial_force: axial.into(),
            shear_force: shear.into(),
            bending_moment: moment.into(),
            ..Shape::default()
        };
        let fine = [shape([1.0, 8.0], [0.0, -4.0], [0.0, 10.0])];
        let error = |coarse: Shape| section_forces(&[coarse], &fine, &[]).0.unwrap();
        assert_eq!(error(shape([1.0, 6.0], [0.0, -4.0], [0.0, 10.0])), 0.25);
        assert_eq!(error(shape([1.0, 8.0], [0.0, -3.0], [0.0, 10.0])), 0.125);
        assert_eq!(error(shape([1.0, 8.0], [0.0, -4.0], [5.0, 10.0])), 0.5);
        assert_eq!(error(fine[0].clone()), 0.0);
        // Moments decide about forces where these are small.
        let bent = [shape([0.0, 0.0], [0.0, 1.0], [0.0, 20.0])];
        let other = shape([0.0, 0.5], [0.0, 1.0], [0.0, 20.0]);
        assert_eq!(section_forces(&[other], &bent, &[]).0, Some(0.05));
        // The same jump, at places that differ by their last digits.
        let jump = |s: f64| Shape {
            s: vec![0.0, s, s, 2.0],
            axial_force: vec![3.0, 3.0, -5.0, -5.0],
            shear_force: vec![0.0; 4],
            bending_moment: vec![0.0; 4],
            ..Shape::default()
        };
        for s in [1.0_f64.next_down(), 1.0, 1.0_f64.next_up()] {
            assert_eq!(section_forces(&[jump(s)], &[jump(1.0)], &[]).0, Some(0.0), "{s:?}");
        }
        assert!(section_forces(&[jump(1.001)], &[jump(1.0)], &[]).0 > Some(1.0));
        let small = [shape([0.0; 2], [1e-9, 0.0], [0.0; 2])];
        let mut negligible = [Negligible::default()];
        assert_eq!(section_forces(&small, &small, &negligible).0, Some(0.0));
        negligible[0].force = 1e-9;
        assert_eq!(section_forces(&small, &small, &negligible).0, Some(0.0), "round-off would differ");
        let other = [shape([0.0; 2], [0.0, 1e-9], [0.0; 2])];
        assert_eq!(section_forces(&other, &small, &negligible).0, None);
        let nothing = [shape([0.0; 2], [0.0; 2], [0.0; 2])];
        assert_eq!(section_forces(&nothing, &nothing, &[]).0, None);
    }
}
