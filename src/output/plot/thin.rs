//! Fewer points where there are more than a picture can show.

/// More points than this are thinned.
const ENOUGH: usize = 3000;
/// Each group of points leaves its first, lowest, highest and last one, so that no peak is lost.
const GROUPS: usize = 600;

/// `points`, or their outline where they are very many.
pub(super) fn thin(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if points.len() <= ENOUGH {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(4 * GROUPS);
    for group in points.chunks(points.len().div_ceil(GROUPS)) {
        let by_height = |a: &usize, b: &usize| group[*a][1].total_cmp(&group[*b][1]);
        let lowest = (0..group.len()).min_by(by_height).unwrap_or(0);
        let highest = (0..group.len()).max_by(by_height).unwrap_or(0);
        let mut indices = [0, lowest, highest, group.len() - 1];
        indices.sort_unstable();
        for (k, &i) in indices.iter().enumerate() {
            if k == 0 || indices[k - 1] != i {
                kept.push(group[i]);
            }
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_peaks() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|i| [f64::from(i), 0.0]).collect();
        points[54_321][1] = 7.0;
        let kept = thin(&points);
        assert!(kept.len() < ENOUGH && kept.contains(&[54_321.0, 7.0]));
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
    }

    /// Groups of six whose first, third, fourth and sixth are to stay, and a last group of one.
    #[test]
    fn each_group_leaves_its_ends_and_extremes() {
        let heights = [0.0, 1.0, -2.0, 5.0, 3.0, 0.5];
        let point = |i: usize| [-(i as f64), heights[i % 6]];
        let few: Vec<[f64; 2]> = (0..ENOUGH).map(point).collect();
        assert_eq!(thin(&few), few);
        let many: Vec<[f64; 2]> = (0..=ENOUGH).map(point).collect();
        let expected: Vec<[f64; 2]> =
            (0..=ENOUGH).filter(|i| [0, 2, 3, 5].contains(&(i % 6))).map(point).collect();
        assert_eq!(thin(&many), expected);
        // Where an extreme is an end, nothing is there twice.
        let rising: Vec<[f64; 2]> = (0..=ENOUGH).map(|i| [0.0, i as f64]).collect();
        assert_eq!(thin(&rising).len(), 2 * ENOUGH / 6 + 1);
    }
}
