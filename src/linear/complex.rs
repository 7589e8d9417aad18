//! Factorisation of K + ζ M for a complex number ζ and real K and M: the matrices into which the stages of a collocation
//! method fall apart.
//!
//! K and M are symmetric there, so K + ζ M is complex *symmetric* (not Hermitian) and has L D Lᵀ. It exists without
//! pivoting: with M positive definite and Im ζ ≠ 0, x*(K + ζM)x has an imaginary part different from zero for every x, hence no
//! leading minor vanishes (George, Ikramov, Kucherov, *SIAM J. Matrix Anal. Appl.* 21, 2000, 377–387).
//! Numbers are kept by fours, their real parts before their imaginary parts (`Four`), so that all inner loops are real multiply–adds over
//! whole registers. Unsymmetric matrices and those bordered by many rows are
//! factorised with pivoting, as a band where the rows lie within it, else by faer's sparse LU.

use super::bordered::{BorderRow, Bordered};
use super::condensed::{self, ComplexCondensed};
use super::interleaved::{self, Interleaved};
use super::symmetric::SymmetricBand;
use super::{Matrix, Singular};
use crate::lanes::Lanes;
use faer::c64;

/// A factorised K + ζ M.
#[derive(Clone, Debug)]
pub enum ComplexFactor {
    /// L D Lᵀ of a symmetric band.
    Ldl(ComplexLdl),
    /// The same, bordered by few rows.
    Condensed(Box<ComplexCondensed>),
    /// LU of an unsymmetric band, its constraint rows among the unknowns.
    Interleaved(Box<Interleaved<c64>>),
    /// Sparse LU of a bordered band.
    Sparse(Box<Bordered<c64>>),
}

impl ComplexFactor {
    /// Factorises `k` + ζ `m`, bordered by constraint rows if there are any, in the memory of an earlier factorisation of the
    /// same pattern.
    ///
    /// # Errors
    /// [`Singular`] where the matrix has no inverse to round-off.
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
            return Ok(Self::Condensed(Box::new(ComplexCondensed::new(ldl, k.size(), border)?)));
        }
        let entry = |i, j| c64::new(k.get(i, j) + zeta.re * m.get(i, j), zeta.im * m.get(i, j));
        if interleaved::fits(k, border) {
            return Ok(Self::Interleaved(Box::new(Interleaved::new(k, entry, border)?)));
        }
        let earlier = match earlier {
            Some(Self::Sparse(earlier)) => Some(*earlier),
            _ => None,
        };
        Ok(Self::Sparse(Box::new(Bordered::from_entries(k, entry, border, earlier)?)))
    }

    /// Solves in place; `re` and `im` hold the multipliers' parts last.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        match self {
            Self::Ldl(ldl) => ldl.solve(re, im),
            Self::Condensed(condensed) => condensed.solve(re, im),
            Self::Interleaved(lu) => pairwise(re, im, |b| lu.solve(b)),
            Self::Sparse(sparse) => pairwise(re, im, |b| sparse.solve(b)),
        }
    }
}

/// Solves with real and imaginary parts side by side.
fn pairwise(re: &mut [f64], im: &mut [f64], solve: impl FnOnce(&mut [c64])) {
    let mut b: Vec<c64> = re.iter().zip(&*im).map(|(re, im)| c64::new(*re, *im)).collect();
    solve(&mut b);
    for ((re, im), b) in re.iter_mut().zip(im).zip(b) {
        (*re, *im) = (b.re, b.im);
    }
}

/// Real and imaginary parts of four numbers: those of one node in a row.
type Four = [Lanes; 2];

/// Rows of 4 × 4 numbers.
type Block = [Four; 4];

const ZERO: Four = [Lanes::ZERO; 2];

/// `target + l · source`.
#[inline(always)]
fn add(l: c64, [s_re, s_im]: Four, [re, im]: Four) -> Four {
    let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
    [l_im.mul_neg_add(s_im, l_re.mul_add(s_re, re)), l_im.mul_add(s_re, l_re.mul_add(s_im, im))]
}

/// `target − l · source`.
#[inline(always)]
fn subtract(l: c64, [s_re, s_im]: Four, [re, im]: Four) -> Four {
    let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
    [l_im.mul_add(s_im, l_re.mul_neg_add(s_re, re)), l_im.mul_neg_add(s_re, l_re.mul_neg_add(s_im, im))]
}

/// `Σ_r rows_r · factors_r`, in two chains.
#[inline(always)]
fn product(rows: &Block, factors: [c64; 4]) -> Four {
    let one = add(factors[1], rows[1], add(factors[0], rows[0], ZERO));
    let other = add(factors[3], rows[3], add(factors[2], rows[2], ZERO));
    [one[0] + other[0], one[1] + other[1]]
}

#[inline(always)]
fn numbers(four: Four) -> [c64; 4] {
    let [re, im] = four.map(Lanes::to_array);
    std::array::from_fn(|lane| c64::new(re[lane], im[lane]))
}

#[inline(always)]
fn transpose(block: Block) -> Block {
    let [re, im] = [0, 1].map(|part| Lanes::transpose(block.map(|row| row[part])));
    std::array::from_fn(|r| [re[r], im[r]])
}

/// L D Lᵀ of a complex symmetric band, D of blocks of 4 × 4.
///
/// Kept are D⁻¹, by Gauss and Jordan's elimination, whose pivots are those of L D Lᵀ by single numbers, and the blocks W = D⁻¹ U and Wᵀ right of the
/// diagonal, so that a substitution consists of products with blocks, none of which but the one with W or Wᵀ waits for the node before.
#[derive(Clone, Debug)]
pub struct ComplexLdl {
    /// Blocks of a node, the diagonal one included.
    blocks: usize,
    /// D⁻¹ and W of each node.
    rows: Vec<Block>,
    /// The blocks Wᵀ.
    transposed: Vec<Block>,
}

impl ComplexLdl {
    fn zeros(pattern: &SymmetricBand) -> Self {
        let (nodes, blocks) = (pattern.size() / 4, pattern.stride() / 4);
        Self {
            blocks,
            rows: vec![[ZERO; 4]; nodes * blocks],
            transposed: vec![[ZERO; 4]; nodes * (blocks - 1)],
        }
    }

    fn factorize(&mut self, k: &SymmetricBand, m: &SymmetricBand, zeta: c64) -> Result<(), Singular> {
        let [k, m] = [k, m].map(|matrix| matrix.data().as_chunks::<4>().0.chunks_exact(4 * self.blocks));
        for (panel, (k, m)) in self.rows.chunks_exact_mut(self.blocks).zip(k.zip(m)) {
            for (b, block) in panel.iter_mut().enumerate() {
                for (r, [re, im]) in block.iter_mut().enumerate() {
                    let [k, m] = [k, m].map(|rows| Lanes::new(rows[r * self.blocks + b]));
                    (*re, *im) = (m.mul_add(Lanes::splat(zeta.re), k), m * Lanes::splat(zeta.im));
                }
            }
        }
        match self.blocks {
            2 => self.eliminate::<2>(),
            4 => self.eliminate::<4>(),
            6 => self.eliminate::<6>(),
            _ => self.eliminate::<0>(),
        }
    }

    /// With the number of blocks a compile-time constant, or 0.
    fn eliminate<const BLOCKS: usize>(&mut self) -> Result<(), Singular> {
        let blocks = if BLOCKS == 0 { self.blocks } else { BLOCKS };
        for node in 0..self.rows.len() / blocks {
            let (panel, later) = self.rows[node * blocks..].split_at_mut(blocks);
            let Some((diagonal, right)) = panel.split_first_mut() else { break };
            *diagonal = inverse(*diagonal).map_err(|r| Singular { row: 4 * node + r })?;
            let products = &mut self.transposed[node * (blocks - 1)..(node + 1) * (blocks - 1)];
            for (w, u) in products.iter_mut().zip(&*right) {
                *w = diagonal.map(|row| product(u, numbers(row)));
            }
            for (a, (u, later)) in right.iter().zip(later.chunks_exact_mut(blocks)).enumerate() {
                for (target, w) in later.iter_mut().zip(&products[a..]) {
                    for (source, w) in u.iter().zip(w) {
                        for (target, u) in target.iter_mut().zip(numbers(*source)) {
                            *target = subtract(u, *w, *target);
                        }
                    }
                }
            }
            for (w, transposed) in right.iter_mut().zip(products) {
                (*w, *transposed) = (*transposed, transpose(*transposed));
            }
        }
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        match self.blocks {
            2 => self.substitute::<2>(re, im),
            4 => self.substitute::<4>(re, im),
            6 => self.substitute::<6>(re, im),
            _ => self.substitute::<0>(re, im),
        }
    }

    /// With the number of blocks a compile-time constant, or 0.
    fn substitute<const BLOCKS: usize>(&self, re: &mut [f64], im: &mut [f64]) {
        let blocks = if BLOCKS == 0 { self.blocks } else { BLOCKS };
        let (re, im) = (re.as_chunks_mut::<4>().0, im.as_chunks_mut::<4>().0);
        for (node, panel) in self.rows.chunks_exact(blocks).enumerate() {
            let ([re, re_later @ ..], [im, im_later @ ..]) = (&mut re[node..], &mut im[node..]) else {
                break;
            };
            let here = numbers([*re, *im].map(Lanes::new));
            for (w, (re, im)) in panel[1..].iter().zip(re_later.iter_mut().zip(im_later)) {
                let change = product(w, here);
                *re = (Lanes::new(*re) - change[0]).to_array();
                *im = (Lanes::new(*im) - change[1]).to_array();
            }
            // Symmetric: its rows are its columns.
            [*re, *im] = product(&panel[0], here).map(Lanes::to_array);
        }
        for (node, transposed) in self.transposed.chunks_exact((blocks - 1).max(1)).enumerate().rev() {
            let ([re, re_later @ ..], [im, im_later @ ..]) = (&mut re[node..], &mut im[node..]) else {
                break;
            };
            let mut here = [*re, *im].map(Lanes::new);
            for (w, (re, im)) in transposed.iter().zip(re_later.iter().zip(im_later)) {
                let change = product(w, numbers([*re, *im].map(Lanes::new)));
                here = [here[0] - change[0], here[1] - change[1]];
            }
            [*re, *im] = here.map(Lanes::to_array);
        }
    }
}

/// The inverse of a symmetric block of which the part below the diagonal need not be there, or the row of a pivot that vanishes or is not finite.
#[inline(always)]
fn inverse(upper: Block) -> Result<Block, usize> {
    let lower = transpose(upper);
    let mut block: Block = std::array::from_fn(|r| {
        std::array::from_fn(|part| {
            let [lower, upper] = [lower, upper].map(|block| block[r][part].to_array());
            Lanes::new(std::array::from_fn(|c| if c < r { lower[c] } else { upper[c] }))
        })
    });
    exchange::<0>(&mut block)?;
    exchange::<1>(&mut block)?;
    exchange::<2>(&mut block)?;
    exchange::<3>(&mut block)?;
    Ok(block)
}

/// One step of Gauss and Jordan's elimination: exchanges unknown and right-hand side number `R`.
#[inline(always)]
fn exchange<const R: usize>(block: &mut Block) -> Result<(), usize> {
    let with = |lanes: Lanes, value: f64| {
        let mut numbers = lanes.to_array();
        numbers[R] = value;
        Lanes::new(numbers)
    };
    let pivot = numbers(block[R])[R];
    let size = pivot.re * pivot.re + pivot.im * pivot.im;
    // Written so that a NaN fails too.
    if !(size > 0.0 && size.is_finite()) {
        return Err(R);
    }
    let row = [with(block[R][0], 1.0), with(block[R][1], 0.0)];
    let scale = 1.0 / size;
    let row = add(c64::new(pivot.re * scale, -pivot.im * scale), row, ZERO);
    for (r, target) in block.iter_mut().enumerate() {
        let rest = target.map(|part| with(part, 0.0));
        *target = if r == R { row } else { subtract(numbers(*target)[R], row, rest) };
    }
    Ok(())
}
