//! Places that are spread evenly and yet not regularly.

/// (√5 − 1)/2: the fractional parts of its multiples are those that are the least near to each other.
pub const GOLDEN: f64 = 0.618_033_988_749_895;

/// One place in each of `count` equal parts of the unit interval, rising, no two of them at the same part of theirs: what
/// oscillates as often as places lie in it does not look constant there.
pub fn spread(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| (k as f64 + (k as f64 * GOLDEN).fract()) / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_rise_and_do_not_alias() {
        let places: Vec<f64> = spread(24).collect();
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]) && places[0] == 0.0 && places[23] < 1.0);
        for waves in [24.0, 48.0, 240.0] {
            let mean = places.iter().map(|x| (std::f64::consts::TAU * waves * x).cos()).sum::<f64>() / 24.0;
            assert!(mean.abs() < 0.3, "{mean} of {waves} waves");
        }
    }
}
