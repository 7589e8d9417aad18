//! Scales of unknowns and multipliers that bring the entries of a bordered matrix to about one.
//!
//! Positions, gradients and multipliers have different units, but partial pivoting compares their
//! entries: for a beam of some millimetres those of the constraint rows are 10⁹ times those of a
//! mass matrix, which then loses nine digits. The scales are powers of two, so that scaling rounds
//! nothing.

/// Scales of `size` unknowns with the given diagonal of the matrix, followed by the scales of the
/// rows of `border`. All positions have one scale and all gradients another, because the diagonal
/// entry of a single unknown may be mere round-off.
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
