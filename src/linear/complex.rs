//! Factorisation of K + ζ M for a complex number ζ and real K and M: the matrices into which the stages of a collocation
//! method fall apart.
//!
//! K and M are symmetric there, so K + ζ M is complex *symmetric* (not Hermitian) and has L D Lᵀ. It exists without
//! pivoting: with M positive definite and Im ζ ≠ 0, x*(K + ζM)x has an imaginary part different from zero for every x, hence no
//! leading minor vanishes (George, Ikramov, Kucherov, *SIAM J. Matrix Anal. Appl.* 21, 2000, 377–387).
//! Numbers are kept by fours, their real parts before their imaginary parts (`Four`), so that all inner loops are real multiply–adds over
//! whole registers: four times as many as [`super::symmetric`] has, in the same order. Unsymmetric matrices and those bordered by many rows are
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

const ZERO: Four = [Lanes::ZERO; 2];

/// `l · source + target`.
#[inline(always)]
fn add(l: c64, [s_re, s_im]: &Four, [re, im]: &Four) -> Four {
    let (l_re, l_im) = (Lanes::splat(l.re), Lanes::splat(l.im));
    [l_im.mul_neg_add(*s_im, l_re.mul_add(*s_re, *re)), l_im.mul_add(*s_re, l_re.mul_add(*s_im, *im))]
}

/// `a · b + sum`, number by number.
#[inline(always)]
fn add_products(a: &Four, b: &Four, [re, im]: &Four) -> Four {
    [a[1].mul_neg_add(b[1], a[0].mul_add(b[0], *re)), a[1].mul_add(b[0], a[0].mul_add(b[1], *im))]
}

#[inline(always)]
fn number(four: &Four, lane: usize) -> c64 {
    c64::new(four[0].to_array()[lane], four[1].to_array()[lane])
}

#[inline(always)]
fn sum(four: &Four) -> c64 {
    c64::new(four[0].reduce_add(), four[1].reduce_add())
}

/// The unknowns of `node`, zeros beyond the last.
#[inline(always)]
fn unknowns(re: &[f64], im: &[f64], node: usize) -> Four {
    match (re.as_chunks().0.get(node), im.as_chunks().0.get(node)) {
        (Some(re), Some(im)) => [Lanes::new(*re), Lanes::new(*im)],
        _ => ZERO,
    }
}

/// L D Lᵀ of a complex symmetric band. The rows hold D Lᵀ.
#[derive(Clone, Debug)]
pub struct ComplexLdl {
    /// Blocks in a panel, the diagonal one included.
    blocks: usize,
    /// Panels of four rows of `blocks` blocks, one a node.
    rows: Vec<Four>,
    /// 1/d.
    reciprocal: Vec<c64>,
}

impl ComplexLdl {
    fn zeros(pattern: &SymmetricBand) -> Self {
        let (size, blocks) = (pattern.size(), pattern.stride() / 4);
        Self { blocks, rows: vec![ZERO; size * blocks], reciprocal: vec![c64::new(0.0, 0.0); size] }
    }

    fn factorize(&mut self, k: &SymmetricBand, m: &SymmetricBand, zeta: c64) -> Result<(), Singular> {
        let sources = k.data().as_chunks::<4>().0.iter().zip(m.data().as_chunks::<4>().0);
        for ([re, im], (k, m)) in self.rows.iter_mut().zip(sources) {
            let m = Lanes::new(*m);
            (*re, *im) = (m.mul_add(Lanes::splat(zeta.re), Lanes::new(*k)), m * Lanes::splat(zeta.im));
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
        for (node, reciprocal) in self.reciprocal.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let (panel, later) = self.rows[node * 4 * blocks..].split_at_mut(4 * blocks);
            for r in 0..4 {
                let (done, below) = panel.split_at_mut((r + 1) * blocks);
                let row = &done[r * blocks..];
                let pivot = number(&row[0], r);
                let size = pivot.re * pivot.re + pivot.im * pivot.im;
                // Written so that a NaN fails too.
                if !(size > 0.0 && size.is_finite()) {
                    return Err(Singular { row: 4 * node + r });
                }
                reciprocal[r] = c64::new(pivot.re / size, -pivot.im / size);
                for (c, target) in (r + 1..4).zip(below.chunks_exact_mut(blocks)) {
                    let l = -number(&row[0], c) * reciprocal[r];
                    for (t, s) in target.iter_mut().zip(row) {
                        *t = add(l, s, t);
                    }
                }
            }
            let (first, second) = panel.split_at(2 * blocks);
            let ((a, b), (c, d)) = (first.split_at(blocks), second.split_at(blocks));
            for (ahead, target) in later.chunks_exact_mut(4 * blocks).take(blocks - 1).enumerate() {
                let (a, b, c, d) = (&a[ahead + 1..], &b[ahead + 1..], &c[ahead + 1..], &d[ahead + 1..]);
                for (r, target) in target.chunks_exact_mut(blocks).enumerate() {
                    let l0 = -number(&a[0], r) * reciprocal[0];
                    let l1 = -number(&b[0], r) * reciprocal[1];
                    let l2 = -number(&c[0], r) * reciprocal[2];
                    let l3 = -number(&d[0], r) * reciprocal[3];
                    let sources = a.iter().zip(b).zip(c.iter().zip(d));
                    for (t, ((a, b), (c, d))) in target.iter_mut().zip(sources) {
                        *t = add(l3, d, &add(l2, c, &add(l1, b, &add(l0, a, t))));
                    }
                }
            }
        }
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        match self.blocks {
            2 => self.substitute_window(&mut [ZERO; 2], re, im),
            4 => self.substitute_window(&mut [ZERO; 4], re, im),
            6 => self.substitute_window(&mut [ZERO; 6], re, im),
            _ => self.substitute(&mut vec![ZERO; self.blocks], re, im),
        }
    }

    /// Forward and backward substitution with the numbers that a panel touches in a window of registers.
    fn substitute_window<const BLOCKS: usize>(
        &self,
        window: &mut [Four; BLOCKS],
        re: &mut [f64],
        im: &mut [f64],
    ) {
        self.substitute(window, re, im);
    }

    /// `window` has as many blocks as a panel. Inlined where that is a constant, it is kept in registers.
    #[inline(always)]
    fn substitute(&self, window: &mut [Four], re: &mut [f64], im: &mut [f64]) {
        let blocks = window.len();
        for (node, block) in window.iter_mut().enumerate() {
            *block = unknowns(re, im, node);
        }
        let panels = self.rows.chunks_exact(4 * blocks).zip(self.reciprocal.as_chunks::<4>().0);
        for (node, (panel, reciprocal)) in panels.clone().enumerate() {
            let mut z = [[0.0; 4]; 2];
            for (r, row) in panel.chunks_exact(blocks).enumerate() {
                // What this changes in the first block up to its own place is not read again.
                let value = number(&window[0], r) * reciprocal[r];
                for (w, u) in window.iter_mut().zip(row) {
                    *w = add(-value, u, w);
                }
                (z[0][r], z[1][r]) = (value.re, value.im);
            }
            re[4 * node..4 * node + 4].copy_from_slice(&z[0]);
            im[4 * node..4 * node + 4].copy_from_slice(&z[1]);
            window.copy_within(1.., 0);
            window[blocks - 1] = unknowns(re, im, node + blocks);
        }
        window.fill(ZERO);
        for (node, (panel, reciprocal)) in panels.enumerate().rev() {
            window.copy_within(..blocks - 1, 1);
            // Zeros meet the entries on the diagonal and left of it.
            let z = unknowns(re, im, node);
            let mut here = [[0.0; 4]; 2];
            for (r, row) in panel.chunks_exact(blocks).enumerate().rev() {
                window[0] = here.map(Lanes::new);
                let mut sums = ZERO;
                for (w, u) in window.iter().zip(row) {
                    sums = add_products(u, w, &sums);
                }
                let x = number(&z, r) - sum(&sums) * reciprocal[r];
                (here[0][r], here[1][r]) = (x.re, x.im);
            }
            window[0] = here.map(Lanes::new);
            re[4 * node..4 * node + 4].copy_from_slice(&here[0]);
            im[4 * node..4 * node + 4].copy_from_slice(&here[1]);
        }
    }
}
