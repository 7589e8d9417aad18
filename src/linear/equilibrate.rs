//! Scales of unknowns and multipliers by which the entries of a bordered matrix become about one.
//!
//! Positions, gradients and multipliers have units of their own, and partial pivoting compares
//! their entries: with a beam of some millimetres those of the rows are 10⁹ times those of a mass
//! matrix, which then loses as many digits. With powers of two nothing is rounded.

/// Scales of `size` unknowns with the given diagonal of the matrix, and then of the rows. Positions
/// have one scale and gradients another: what of a single unknown is left by round-off is no
/// measure.
pub fn scales(size: usize, diagonal: impl Fn(usize) -> f64, border: &[Vec<(usize, f64)>]) -> Vec<f64> {
    let power = |value: f64, exponent: f64| {
        let scale = (exponent * value.log2()).round().exp2();
        if scale.is_normal() { scale } else { 1.0 }
    };
    let largest = |gradient: bool| {
        let of_kind = (0..size).filter(|i| (i % 4 >= 2) == gradient);
        of_kind.fold(0.0_f64, |m, i| m.max(diagonal(i).abs()))
    };
    let [position, gradient] = [false, true].map(|kind| power(largest(kind), -0.5));
    let mut scales: Vec<f64> = (0..size).map(|i| if i % 4 < 2 { position } else { gradient }).collect();
    for row in border {
        let largest = row.iter().fold(0.0_f64, |m, (i, value)| m.max((value * scales[*i]).abs()));
        scales.push(power(largest, -1.0));
    }
    scales
}
