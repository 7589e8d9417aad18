//! Which nodes a cell uses, and which cells have the same shape functions.

/// How many of the latest distinct cells a new one is compared with: enough for meshes that repeat a pattern.
const RECENT: usize = 16;

/// Nodes of the support of `cell`, as a half-open range: its own two and `neighbours` more on each side that exists.
pub fn support(cell: usize, neighbours: usize, nodes: usize) -> std::ops::Range<usize> {
    cell.saturating_sub(neighbours)..cell.saturating_add(neighbours).saturating_add(2).min(nodes)
}

/// Groups cells whose supports are translations of each other: per cell the number of its group, per group its first
/// cell.
///
/// Node positions are rounded to double precision, so the spacings of an even mesh differ in their last digits. Two
/// supports are the same if they agree within that round-off and within 1e-9 of the smallest spacing. The first of a
/// group stands for it: nearest to s = 0, its spacings are rounded the least.
pub fn distinct_cells(nodes: &[f64], neighbours: usize) -> (Vec<u32>, Vec<u32>) {
    let mut representative: Vec<u32> = Vec::new();
    let shape_of = (0..nodes.len() - 1)
        .map(|cell| {
            let here = support(cell, neighbours, nodes.len());
            let found = representative.iter().enumerate().rev().take(RECENT).find(|(_, other)| {
                let other = **other as usize;
                let there = support(other, neighbours, nodes.len());
                here.len() == there.len() && cell - here.start == other - there.start && {
                    let (here, there) = (&nodes[here.clone()], &nodes[there]);
                    let round_off = 4.0 * f64::EPSILON * here[here.len() - 1].max(there[there.len() - 1]);
                    here.windows(2).zip(there.windows(2)).all(|(a, b)| {
                        let (a, b) = (a[1] - a[0], b[1] - b[0]);
                        (a - b).abs() <= round_off.min(1e-9 * a.min(b))
                    })
                }
            });
            match found {
                Some((group, _)) => group as u32,
                None => {
                    representative.push(cell as u32);
                    (representative.len() - 1) as u32
                }
            }
        })
        .collect();
    (shape_of, representative)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supports_are_clipped_at_the_ends() {
        assert_eq!(support(0, 2, 9), 0..4);
        assert_eq!(support(4, 2, 9), 2..8);
        assert_eq!(support(7, 2, 9), 5..9);
        assert_eq!(support(1, usize::MAX, 3), 0..3);
    }

    #[test]
    fn patterns_share_and_differences_do_not() {
        let alternating: Vec<f64> = (0..50).map(|i| i as f64 + if i % 2 == 0 { 0.0 } else { 0.3 }).collect();
        assert_eq!(distinct_cells(&alternating, 0).1, [0, 1]);
        let (shape_of, representative) = distinct_cells(&alternating, 1);
        assert_eq!((representative, shape_of[7], shape_of[48]), (vec![0, 1, 2, 48], 1, 3));
        let bent: Vec<f64> = (0..20).map(|i| i as f64 + 1e-6 * (i * i) as f64).collect();
        assert_eq!(distinct_cells(&bent, 0).1.len(), 19);
    }
}
