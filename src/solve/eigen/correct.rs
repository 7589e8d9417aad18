//! Eigenpairs corrected by products with an A whose entries have lost digits.

use super::{CERTAIN, Pencil, dot, ritz, round_off};
use crate::linear::bordered::BorderRow;

/// Most corrections of the vectors …
const CORRECTIONS: usize = 12;
/// … until the bound of the error of a reciprocal is this part of the largest reciprocal: the error itself goes with its square.
const SETTLED: f64 = 1e-6;
/// A correction moves constraints by this part at most of what its entries would; what moves them by more is round-off.
const HELD: f64 = 1e-9;

/// An eigenpair.
#[derive(Clone, Debug, PartialEq)]
pub struct Corrected {
    /// 1/θ.
    pub reciprocal: f64,
    /// A bound of its error: √(rᵀ A⁻¹ r) of what the pair leaves, r = (B − A/θ) φ.
    pub bound: f64,
    /// φ, with φᵀ A φ = 1.
    pub vector: Vec<f64>,
    /// Whether corrections have changed φ.
    pub moved: bool,
}

/// The `count` largest 1/θ of A φ = θ B φ in the span of the vectors of `pairs` and of what corrects them. `product` gives A v
/// without the round-off that the matrix A carries, and `inverse` A⁻¹ r of that matrix on the allowed motions, which has it.
pub fn corrected(
    pencil: &Pencil<'_>,
    pairs: Vec<(f64, Vec<f64>)>,
    count: usize,
    product: &dyn Fn(&[f64]) -> Vec<f64>,
    inverse: &dyn Fn(&[f64]) -> Vec<f64>,
) -> Vec<Corrected> {
    let vectors: Vec<Vec<f64>> = pairs.iter().map(|(_, vector)| vector.clone()).collect();
    match restricted(pencil, &vectors, product) {
        Some(pairs) => settled(pencil, pairs, count, product, inverse),
        // Any of them may be wrong as a whole.
        None => {
            let uncertain = |(reciprocal, vector): (f64, Vec<f64>)| Corrected {
                reciprocal,
                bound: reciprocal,
                vector,
                moved: false,
            };
            pairs.into_iter().take(count).map(uncertain).collect()
        }
    }
}

/// [`corrected`], from pairs that are those of A and B in the span of their vectors already, the largest first.
pub fn settled(
    pencil: &Pencil<'_>,
    mut pairs: Vec<(f64, Vec<f64>)>,
    count: usize,
    product: &dyn Fn(&[f64]) -> Vec<f64>,
    inverse: &dyn Fn(&[f64]) -> Vec<f64>,
) -> Vec<Corrected> {
    let (mut found, mut moved) = (Vec::new(), false);
    for _ in 0..=CORRECTIONS {
        let largest = pairs.first().map_or(0.0, |(reciprocal, _)| reciprocal.abs());
        let mut corrections: Vec<Vec<f64>> = Vec::new();
        found.clear();
        for (number, (reciprocal, vector)) in pairs.into_iter().enumerate() {
            let mut bound = 0.0;
            if number < count {
                let left = remainder(pencil, reciprocal, &vector, product);
                let correction = inverse(&left);
                // The round-off of the matrix that is inverted makes it stiffer, by as much as it adds to φᵀ A φ = 1 if
                // nothing cancels.
                let stiffer = 1.0 + CERTAIN * round_off(pencil.a, &vector);
                bound = (dot(&left, &correction).abs() * stiffer).sqrt();
                let settled = bound <= SETTLED * largest || !bound.is_finite();
                if !settled && pencil.border.iter().all(|row| holds(row, &correction)) {
                    corrections.push(correction.into_iter().map(|value| value / bound).collect());
                }
            }
            found.push(Corrected { reciprocal, bound, vector, moved });
        }
        if corrections.is_empty() {
            break;
        }
        let vectors = found.iter().map(|pair| pair.vector.clone());
        let vectors: Vec<Vec<f64>> = vectors.chain(corrections).collect();
        // Vectors that depend on each other tell nothing new.
        let Some(better) = restricted(pencil, &vectors, product) else { break };
        (pairs, moved) = (better, true);
    }
    found.truncate(count);
    found
}

/// The pairs of A and B in the span of some vectors, the largest 1/θ first, with φᵀ A φ = 1; none where the vectors depend on each
/// other.
fn restricted(
    pencil: &Pencil<'_>,
    vectors: &[Vec<f64>],
    product: &dyn Fn(&[f64]) -> Vec<f64>,
) -> Option<Vec<(f64, Vec<f64>)>> {
    let of_a: Vec<Vec<f64>> = vectors.iter().map(|v| product(v)).collect();
    let of_b: Vec<Vec<f64>> = vectors.iter().map(|v| pencil.b.product(v)).collect();
    let mut pairs = ritz(vectors, &of_b, &of_a).ok()?;
    pairs.reverse();
    Some(pairs)
}

/// What each 1/θ errs by at most: the bound, or its square over the distance from those that are not its equals, whichever is smaller
/// (Parlett, *The Symmetric Eigenvalue Problem*, 1980, theorem 11.7.1). The bounds of pairs that may be equal add up. How near to the
/// last pair the next one is, nobody knows.
pub fn errors(pairs: &[Corrected]) -> Vec<f64> {
    let error = |pair: &Corrected| {
        let apart = |other: &Corrected| (pair.reciprocal - other.reciprocal).abs();
        let is_equal = |other: &&Corrected| apart(other) <= pair.bound + other.bound;
        let square: f64 = pairs.iter().filter(is_equal).map(|other| other.bound.powi(2)).sum();
        let others = pairs.iter().filter(|other| !is_equal(other));
        let nearest = others.map(apart).fold(pair.reciprocal.abs(), f64::min);
        let distance = if pairs.last().as_ref().is_some_and(is_equal) { 0.0 } else { nearest };
        if square > 0.0 { pair.bound.min(square / distance) } else { pair.bound }
    };
    pairs.iter().map(error).collect()
}

/// What a pair leaves of its equations on the free coordinates.
fn remainder(
    pencil: &Pencil<'_>,
    reciprocal: f64,
    v: &[f64],
    product: &dyn Fn(&[f64]) -> Vec<f64>,
) -> Vec<f64> {
    let mut left = pencil.b.product(v);
    for ((left, stiff), fixed) in left.iter_mut().zip(product(v)).zip(pencil.fixed) {
        *left = if *fixed { 0.0 } else { *left - reciprocal * stiff };
    }
    left
}

/// Whether a motion keeps a constraint, but for round-off.
fn holds(row: &BorderRow, v: &[f64]) -> bool {
    let terms = row.iter().map(|(i, value)| value * v[*i]);
    let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), term| (sum + term, size + term.abs()));
    sum.abs() <= HELD * size
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Matrix;

    /// Of 1, ½ and ½ + 1e-7 with bounds of 1e-3: the first is 0.5 away from the others, which are equal as far as is known and the last.
    #[test]
    fn errors_go_with_the_square_of_bounds_where_others_are_far() {
        let pair =
            |reciprocal: f64, bound: f64| Corrected { reciprocal, bound, vector: Vec::new(), moved: false };
        let of = |pairs: &[Corrected]| errors(pairs);
        let found = of(&[pair(1.0, 1e-3), pair(0.5 + 1e-7, 1e-3), pair(0.5, 1e-3)]);
        assert!((found[0] - 1e-6 / (0.5 - 1e-7)).abs() < 1e-18 && found[1..] == [1e-3; 2], "{found:?}");
        // With one more below, they are known to both bounds together.
        let found = of(&[pair(1.0, 1e-3), pair(0.5 + 1e-7, 1e-3), pair(0.5, 1e-3), pair(0.25, 1e-3)]);
        assert!((found[2] - 2e-6 / 0.25).abs() < 1e-11, "{found:?}");
        assert_eq!(of(&[pair(1.0, 0.0), pair(0.5, 0.0)]), [0.0, 0.0]);
    }

    /// A = diag(1, 4, 9, …) and B = 1, from vectors that are not those of A, and with an inverse of a matrix that is
    /// stiffer: 1/θ = 1 and 1/4.
    #[test]
    fn wrong_vectors_are_corrected_by_products() {
        let diagonal = |values: [f64; 8]| {
            let mut matrix = Matrix::zeros(2, 2, true);
            matrix.add_diagonal(1.0, &values);
            matrix
        };
        let squares: [f64; 8] = std::array::from_fn(|i| ((i + 1) * (i + 1)) as f64);
        let (a, b) = (diagonal(squares), diagonal([1.0; 8]));
        let pencil = Pencil { a: &a, b: &b, border: &[], fixed: &[false; 8] };
        let vector = |first: usize| {
            (0..8).map(|i| if i == first { 1.0 } else { 0.2 / (i + 1) as f64 }).collect::<Vec<f64>>()
        };
        let pairs = || vec![(0.9, vector(0)), (0.2, vector(1))];
        let product = |v: &[f64]| a.product(v);
        let inverse = |r: &[f64]| r.iter().zip(squares).map(|(r, a)| r / (a + 0.5)).collect::<Vec<_>>();
        let found = corrected(&pencil, pairs(), 2, &product, &inverse);
        assert_eq!(found.len(), 2);
        for (pair, expected) in found.iter().zip([1.0, 0.25]) {
            assert!((pair.reciprocal - expected).abs() < 1e-10 && pair.bound < 1e-6, "{pair:?}");
        }
        // A constraint that the corrections do not keep leaves the vectors, with a bound that tells.
        let row: BorderRow = vec![(6, 1.0), (7, 1.0)];
        let held = Pencil { border: std::slice::from_ref(&row), ..pencil };
        let found = corrected(&held, pairs(), 2, &product, &inverse);
        assert!(found.iter().all(|pair| pair.bound > 1e-3), "{found:?}");
        // Vectors that are the same tell nothing: any of them may be wrong as a whole.
        let same = corrected(&pencil, vec![(0.9, vector(0)), (0.2, vector(0))], 2, &product, &inverse);
        assert!(same.iter().all(|pair| pair.bound == pair.reciprocal), "{same:?}");
        assert!(corrected(&pencil, Vec::new(), 2, &product, &inverse).is_empty());
    }
}
