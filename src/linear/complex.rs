//! Factorisation of K + ζ M for a complex number ζ and real K and M. The stages of a collocation
//! method are decoupled into systems with such matrices.
//!
//! K and M are symmetric as a rule, and L D Lᵀ ([`ComplexLdl`]) serves. Unsymmetric matrices and
//! those bordered by many rows are factorised with pivoting: as a band if the rows lie within it,
//! else by faer's sparse LU.

use super::bordered::{BorderRow, Bordered};
use super::chain::{self, ComplexChain};
pub use super::complex_ldl::ComplexLdl;
use super::condensed::{self, ComplexCondensed};
use super::interleaved::{self, Interleaved};
use super::{Matrix, Singular};
use faer::c64;

/// A factorised K + ζ M.
#[derive(Clone, Debug)]
pub enum ComplexFactor {
    /// L D Lᵀ of a symmetric band.
    Ldl(ComplexLdl),
    /// L D Lᵀ of a symmetric band that is bordered by few rows.
    Condensed(Box<ComplexCondensed>),
    /// L D Lᵀ of a symmetric band of neighbours that is bordered by rows within three nodes.
    Chain(Box<ComplexChain>),
    /// LU of a band whose constraint rows are numbered among the unknowns.
    Interleaved(Box<Interleaved<c64>>),
    /// Sparse LU of a bordered band.
    Sparse(Box<Bordered<c64>>),
}

impl ComplexFactor {
    /// Factorises `k` + ζ `m`, bordered by constraint rows if there are any, in the memory of an
    /// earlier factorisation of the same pattern.
    ///
    /// # Errors
    /// [`Singular`] if the matrix is singular to round-off.
    pub fn again(
        earlier: Option<Self>,
        k: &Matrix,
        m: &Matrix,
        zeta: c64,
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        if let (Matrix::Symmetric(k), Matrix::Symmetric(m), true) = (k, m, condensed::serves(k, border)) {
            let mut ldl = match earlier {
                Some(Self::Ldl(ldl)) => ldl,
                Some(Self::Condensed(condensed)) => condensed.into_ldl(),
                _ => ComplexLdl::zeros(k),
            };
            ldl.factorize(k, m, zeta)?;
            if border.is_empty() {
                return Ok(Self::Ldl(ldl));
            }
            return Ok(Self::Condensed(Box::new(ComplexCondensed::new(ldl, &[k, m], border)?)));
        }
        let (kept, earlier) = match earlier {
            Some(Self::Chain(chain)) => (Some(*chain), None),
            other => (None, other),
        };
        if let (Matrix::Symmetric(symmetric), Matrix::Symmetric(mass)) = (k, m)
            && chain::fits(symmetric, border)
            && let Ok(chain) = ComplexChain::complex(kept, symmetric, mass, zeta, border)
        {
            return Ok(Self::Chain(Box::new(chain)));
        }
        let entry = |i, j| c64::new(k.get(i, j) + zeta.re * m.get(i, j), zeta.im * m.get(i, j));
        if interleaved::fits(k, border) {
            return Ok(Self::Interleaved(Box::new(Interleaved::new(k, entry, border)?)));
        }
        let earlier = match earlier {
            Some(Self::Sparse(earlier)) => Some(*earlier),
            _ => None,
        };
        Ok(Self::Sparse(Box::new(Bordered::from_entries(k, entry, |i| entry(i, i).norm(), border, earlier)?)))
    }

    /// Solves in place; the multipliers' parts of `re` and `im` come last.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        match self {
            Self::Ldl(ldl) => ldl.solve(re, im),
            Self::Condensed(condensed) => condensed.solve(re, im),
            Self::Chain(chain) => chain.solve_parts(re, im),
            Self::Interleaved(lu) => pairwise(re, im, |b| lu.solve(b)),
            Self::Sparse(sparse) => pairwise(re, im, |b| sparse.solve(b)),
        }
    }
}

/// Calls `solve` with real and imaginary parts combined to complex numbers.
fn pairwise(re: &mut [f64], im: &mut [f64], solve: impl FnOnce(&mut [c64])) {
    let mut b: Vec<c64> = re.iter().zip(&*im).map(|(re, im)| c64::new(*re, *im)).collect();
    solve(&mut b);
    for ((re, im), b) in re.iter_mut().zip(im).zip(b) {
        (*re, *im) = (b.re, b.im);
    }
}
