//! Values along a beam that are known at some places.

/// Places along a beam are the same when they differ by less, relative to the last one.
const SAME: f64 = 1e-9;

/// Arc lengths \[m\] that are nearer to each other are one place, to which a finer mesh gives other last
/// digits.
pub fn same_place(places: &[f64]) -> f64 {
    SAME * places.last().copied().unwrap_or(0.0)
}

/// The value at `s`; where a place is there twice, behind it with `after`.
pub fn interpolated(places: &[f64], values: &[f64], s: f64, after: bool) -> Option<f64> {
    let (before, behind) = (s - same_place(places), s + same_place(places));
    let right = places.partition_point(|p| if after { *p <= behind } else { *p < before });
    let here = if after { right.checked_sub(1) } else { Some(right) };
    if let Some(here) = here
        && places.get(here).is_some_and(|p| (before..=behind).contains(p))
    {
        return values.get(here).copied();
    }
    let left = right.checked_sub(1)?;
    let (a, b) = (*places.get(left)?, *places.get(right)?);
    let part = (s - a) / (b - a);
    Some((1.0 - part) * values.get(left)? + part * values.get(right)?)
}

/// Whether the place of this number is there once more: this one is before what acts there in a point, that one behind.
pub fn is_before(places: &[f64], k: usize) -> bool {
    places.get(k + 1).is_some_and(|next| next - places[k] <= same_place(places))
}

/// Whether a place is there twice.
pub fn is_twice(places: &[f64], s: f64) -> bool {
    (0..places.len()).any(|k| (places[k] - s).abs() <= same_place(places) && is_before(places, k))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_two_places_values_are_linear_and_at_a_jump_there_are_two() {
        let (s, v) = ([0.0, 1.0, 1.0, 3.0], [1.0, 2.0, 5.0, 9.0]);
        let at = |place, after| interpolated(&s, &v, place, after);
        assert_eq!(at(0.25, true), Some(1.25));
        assert_eq!(at(2.5, false), Some(8.0));
        assert_eq!((at(1.0, false), at(1.0, true)), (Some(2.0), Some(5.0)));
        assert_eq!((at(0.0, false), at(3.0, true)), (Some(1.0), Some(9.0)));
        assert_eq!((at(-0.5, true), at(3.5, true)), (None, None));
        assert_eq!([0.0, 1.0, 3.0].map(|place| is_twice(&s, place)), [false, true, false]);
    }
}
