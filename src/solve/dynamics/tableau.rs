//! The coefficients of collocation methods, and the transformation that decouples their stage
//! equations.
//!
//! A method with the nodes c_i integrates ẏ = F(y) by the polynomial that satisfies the equation at
//! the nodes:
//!
//! ```text
//! a_ij = ∫₀^{c_i} ℓ_j dτ,   b_j = ∫₀¹ ℓ_j dτ,   ℓ_j the Lagrange polynomials of the nodes
//! ```
//!
//! Gauss: the zeros of the Legendre polynomial shifted to [0, 1], order 2s, symplectic and
//! symmetric. Radau IIA: the zeros of d^{s−1}/dx^{s−1} (x^{s−1} (x − 1)^s), order 2s − 1, c_s = 1,
//! damps infinitely stiff components in one step (Hairer, Wanner, *Solving Ordinary Differential
//! Equations II*, 1996, IV.5, IV.8).

use nalgebra::{Complex, DMatrix, DVector};

/// A part of the transformed stage system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Block {
    /// A real eigenvalue of A⁻¹, in row `row`.
    Real {
        /// The eigenvalue.
        gamma: f64,
        /// Its row.
        row: usize,
    },
    /// A pair ζ, ζ̄ of eigenvalues, in rows `row` and `row + 1`: (w₁ + i w₂) ↦ ζ (w₁ + i w₂).
    Complex {
        /// ζ.
        zeta: Complex<f64>,
        /// The first of its two rows.
        row: usize,
    },
}

/// Nodes, weights and transformations of a collocation method.
#[derive(Clone, Debug)]
pub struct Tableau {
    /// c.
    pub nodes: Vec<f64>,
    /// p.
    pub order: f64,
    /// A.
    pub a: DMatrix<f64>,
    /// A².
    pub a_squared: DMatrix<f64>,
    /// A⁻¹.
    pub inverse: DMatrix<f64>,
    /// A⁻².
    pub inverse_squared: DMatrix<f64>,
    /// b.
    pub weights: Vec<f64>,
    /// bᵀ A⁻¹ and bᵀ A⁻²: weights of the stage displacements in the position at the end, and in h
    /// times the velocity there.
    pub end: DMatrix<f64>,
    /// T of A⁻¹ = T Λ T⁻¹.
    pub transformation: DMatrix<f64>,
    /// T⁻¹.
    pub inverse_transformation: DMatrix<f64>,
    /// The diagonal blocks of Λ.
    pub blocks: Vec<Block>,
}

impl Tableau {
    /// Gauss' method with 1, 2 or 3 stages.
    pub fn gauss(stages: usize) -> Self {
        let nodes = match stages {
            1 => vec![0.5],
            2 => vec![0.5 - 3.0_f64.sqrt() / 6.0, 0.5 + 3.0_f64.sqrt() / 6.0],
            _ => vec![0.5 - 15.0_f64.sqrt() / 10.0, 0.5, 0.5 + 15.0_f64.sqrt() / 10.0],
        };
        let order = 2.0 * nodes.len() as f64;
        Self::new(nodes, order)
    }

    /// Radau's method IIA with 2 or 3 stages.
    pub fn radau(stages: usize) -> Self {
        let nodes = match stages {
            2 => vec![1.0 / 3.0, 1.0],
            _ => vec![(4.0 - 6.0_f64.sqrt()) / 10.0, (4.0 + 6.0_f64.sqrt()) / 10.0, 1.0],
        };
        let order = 2.0 * nodes.len() as f64 - 1.0;
        Self::new(nodes, order)
    }

    fn new(nodes: Vec<f64>, order: f64) -> Self {
        let s = nodes.len();
        // With V_ij = c_i^j: ∫₀^{c_i} x^j = c_i^{j+1}/(j + 1), so A = C V⁻¹ and bᵀ = (1, 1/2, …)
        // V⁻¹.
        let powers = DMatrix::from_fn(s, s, |i, j| nodes[i].powi(j as i32));
        let inverse_powers = invert(&powers);
        let integrals = DMatrix::from_fn(s, s, |i, j| nodes[i].powi(j as i32 + 1) / (j + 1) as f64);
        let a = integrals * &inverse_powers;
        let b = DVector::from_fn(s, |j, _| 1.0 / (j + 1) as f64).transpose() * &inverse_powers;
        let inverse = invert(&a);
        let inverse_squared = &inverse * &inverse;
        let (transformation, blocks) = diagonalise(&inverse);
        Self {
            order,
            a_squared: &a * &a,
            weights: b.iter().copied().collect(),
            end: DMatrix::from_rows(&[&b * &inverse, &b * &inverse_squared]),
            inverse_transformation: invert(&transformation),
            transformation,
            inverse,
            inverse_squared,
            blocks,
            a,
            nodes,
        }
    }

    /// Number of stages.
    pub fn stages(&self) -> usize {
        self.nodes.len()
    }

    /// Whether infinitely fast vibrations die out in one step: where the last stage is the end of
    /// the step.
    pub fn damps(&self) -> bool {
        self.nodes.last() == Some(&1.0)
    }

    /// ℓ_j(x).
    pub fn lagrange(&self, x: f64) -> Vec<f64> {
        lagrange(&self.nodes, x)
    }
}

fn lagrange(nodes: &[f64], x: f64) -> Vec<f64> {
    let factor = |j: usize, k: usize| (x - nodes[k]) / (nodes[j] - nodes[k]);
    (0..nodes.len()).map(|j| (0..nodes.len()).filter(|k| *k != j).map(|k| factor(j, k)).product()).collect()
}

/// The inverse of a matrix of this module. These are constant and regular; a failure would show as
/// NaN in the first test.
fn invert(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    matrix.clone().try_inverse().unwrap_or_else(|| matrix.map(|_| f64::NAN))
}

/// The eigenvectors as columns, u for a real one and (p, q) for a pair p ± iq, and the blocks in
/// the same order.
fn diagonalise(matrix: &DMatrix<f64>) -> (DMatrix<f64>, Vec<Block>) {
    let s = matrix.nrows();
    let mut columns = Vec::new();
    let mut blocks = Vec::new();
    for value in matrix.complex_eigenvalues().iter() {
        let row = columns.len();
        if value.im.abs() <= 1e-9 * value.norm() {
            columns.push(eigenvector(matrix, Complex::new(value.re, 0.0)).map(|v| v.re));
            blocks.push(Block::Real { gamma: value.re, row });
        } else if value.im < 0.0 {
            // W (p + iq) = (α − iβ)(p + iq) makes W [p q] = [p q] [α −β; β α], which maps w₁ + i w₂
            // by α + iβ.
            let vector = eigenvector(matrix, *value);
            columns.push(vector.map(|v| v.re));
            columns.push(vector.map(|v| v.im));
            blocks.push(Block::Complex { zeta: value.conj(), row });
        }
    }
    (DMatrix::from_fn(s, s, |i, j| columns.get(j).map_or(f64::NAN, |c| c[i])), blocks)
}

/// The eigenvector whose last component is 1.
fn eigenvector(matrix: &DMatrix<f64>, value: Complex<f64>) -> DVector<Complex<f64>> {
    let s = matrix.nrows();
    if s == 1 {
        return DVector::from_element(1, Complex::new(1.0, 0.0));
    }
    let entry = |i: usize, j: usize| {
        Complex::new(matrix[(i, j)], 0.0) - if i == j { value } else { Complex::default() }
    };
    let left = DMatrix::from_fn(s - 1, s - 1, entry);
    let right = DVector::from_fn(s - 1, |i, _| -entry(i, s - 1));
    let rest = left.lu().solve(&right).unwrap_or(right);
    DVector::from_fn(s, |i, _| if i + 1 == s { Complex::new(1.0, 0.0) } else { rest[i] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_the_order_are_integrated_exactly_and_the_blocks_are_those_of_the_inverse() {
        for tableau in
            [Tableau::gauss(1), Tableau::gauss(2), Tableau::gauss(3), Tableau::radau(2), Tableau::radau(3)]
        {
            let s = tableau.stages();
            let inverse = invert(&tableau.a);
            let b: Vec<f64> =
                (0..s).map(|j| (0..s).map(|i| tableau.end[(0, i)] * tableau.a[(i, j)]).sum()).collect();
            for degree in 0..tableau.order as i32 {
                let sum: f64 = b.iter().zip(&tableau.nodes).map(|(b, c)| b * c.powi(degree)).sum();
                assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 1e-14, "{s} stages, degree {degree}");
            }
            let mut lambda = DMatrix::zeros(s, s);
            for block in &tableau.blocks {
                match *block {
                    Block::Real { gamma, row } => lambda[(row, row)] = gamma,
                    Block::Complex { zeta, row } => {
                        lambda[(row, row)] = zeta.re;
                        lambda[(row + 1, row + 1)] = zeta.re;
                        lambda[(row, row + 1)] = -zeta.im;
                        lambda[(row + 1, row)] = zeta.im;
                    }
                }
            }
            let again = &tableau.transformation * lambda * &tableau.inverse_transformation;
            assert!((again - inverse).amax() < 1e-12, "{s} stages");
        }
    }

    /// What defines a collocation method: ∫₀^{c_i} τᵏ dτ = c_i^{k+1}/(k+1) for all k below the number of
    /// stages, and the same once more.
    #[test]
    fn stages_integrate_powers_once_and_twice() {
        let close = |a: f64, b: f64| (a - b).abs() < 1e-13;
        for (tableau, damps) in [
            (Tableau::gauss(1), false),
            (Tableau::gauss(2), false),
            (Tableau::gauss(3), false),
            (Tableau::radau(2), true),
            (Tableau::radau(3), true),
        ] {
            let (s, c) = (tableau.stages(), &tableau.nodes);
            assert_eq!(
                (tableau.damps(), tableau.order),
                (damps, (2 * s) as f64 - f64::from(u8::from(damps)))
            );
            for power in 0..s as i32 {
                let values = DVector::from_fn(s, |i, _| c[i].powi(power));
                let (n, m) = (f64::from(power + 1), f64::from(power + 2));
                let (once, twice) = (&tableau.a * &values, &tableau.a_squared * &values);
                for i in 0..s {
                    assert!(close(once[i], c[i].powi(power + 1) / n), "{s} stages, {power}");
                    // The integral is a power, too, of which there may be one too many.
                    let exact = power + 1 < s as i32;
                    assert!(!exact || close(twice[i], c[i].powi(power + 2) / (n * m)), "{s} stages, {power}");
                }
                assert!((&tableau.inverse * &once - &values).amax() < 1e-12);
                assert!((&tableau.inverse_squared * &twice - &values).amax() < 1e-12);
                // The position at the end is that after two integrations, and h times the velocity that
                // after one.
                let end = &tableau.end * &twice;
                assert!(close(end[0], 1.0 / (n * m)) && close(end[1], 1.0 / n), "{s} stages, {power}: {end}");
                let sum: f64 = tableau.weights.iter().zip(values.iter()).map(|(b, v)| b * v).sum();
                assert!(close(sum, 1.0 / n));
                for x in [-0.3, 0.45, 1.7_f64] {
                    let sum: f64 = tableau.lagrange(x).iter().zip(values.iter()).map(|(l, v)| l * v).sum();
                    assert!(close(sum, x.powi(power)), "{s} stages, {power} at {x}");
                }
            }
        }
    }
}
