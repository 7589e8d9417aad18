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

#[inline(always)]
fn number(four: &Four, lane: usize) -> c64 {
    c64::new(four[0].to_array()[lane], four[1].to_array()[lane])
}

/// L D Lᵀ of a complex symmetric band, in blocks as [`super::symmetric::Ldl`] is.
#[derive(Clone, Debug)]
pub struct ComplexLdl {
    /// Blocks in a panel, the diagonal one included.
    blocks: usize,
    /// Panels of four rows of `blocks` blocks, one a node: d lᵀ, and right of it W.
    rows: Vec<Four>,
    /// The blocks Wᵀ.
    transposed: Vec<[Four; 4]>,
    /// 1/d.
    reciprocal: Vec<c64>,
}

impl ComplexLdl {
    fn zeros(pattern: &SymmetricBand) -> Self {
        let (size, blocks) = (pattern.size(), pattern.stride() / 4);
        let transposed = vec![[ZERO; 4]; size / 4 * (blocks - 1)];
        Self {
            blocks,
            rows: vec![ZERO; size * blocks],
            transposed,
            reciprocal: vec![c64::new(0.0, 0.0); size],
        }
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
            let transposed = &mut self.transposed[node * (blocks - 1)..];
            for (block, transposed) in (1..blocks).zip(transposed) {
                let w = divide_by_pivots(panel, reciprocal, block);
                for (row, w) in panel.chunks_exact_mut(blocks).zip(w) {
                    row[block] = w;
                }
                let [re, im] = [0, 1].map(|part| Lanes::transpose(w.map(|w| w[part])));
                *transposed = std::array::from_fn(|c| [re[c], im[c]]);
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
        let panels = self.rows.chunks_exact(4 * blocks).zip(self.reciprocal.as_chunks::<4>().0);
        for (node, (panel, reciprocal)) in panels.enumerate() {
            let here: [c64; 4] = std::array::from_fn(|r| c64::new(re[node][r], im[node][r]));
            let rows: [&[Four]; 4] = std::array::from_fn(|r| &panel[blocks * r..blocks * (r + 1)]);
            for (ahead, (re, im)) in (1..blocks).zip(re[node + 1..].iter_mut().zip(&mut im[node + 1..])) {
                subtract(rows.map(|row| row[ahead]), here, re, im);
            }
            let solved = solve_pivots(rows.map(|row| row[0]), reciprocal, here);
            (re[node], im[node]) = (solved.map(|z| z.re), solved.map(|z| z.im));
        }
        for (node, transposed) in self.transposed.chunks_exact((blocks - 1).max(1)).enumerate().rev() {
            let ([re, re_later @ ..], [im, im_later @ ..]) = (&mut re[node..], &mut im[node..]) else {
                continue;
            };
            for (w, (source_re, source_im)) in transposed.iter().zip(re_later.iter().zip(im_later)) {
                let source = std::array::from_fn(|c| c64::new(source_re[c], source_im[c]));
                subtract(*w, source, re, im);
            }
        }
    }
}

/// Takes `Σ_r rows_r · factors_r` from four numbers, in two chains.
#[inline(always)]
fn subtract(rows: [Four; 4], factors: [c64; 4], re: &mut [f64; 4], im: &mut [f64; 4]) {
    let sum = add(factors[1], &rows[1], &add(factors[0], &rows[0], &ZERO));
    let target = [Lanes::new(*re), Lanes::new(*im)];
    let rest = add(-factors[3], &rows[3], &add(-factors[2], &rows[2], &target));
    (*re, *im) = ((rest[0] - sum[0]).to_array(), (rest[1] - sum[1]).to_array());
}

/// W = D⁻¹ U of a block, from the rows of d lᵀ and l⁻¹ U that elimination leaves.
#[inline(always)]
fn divide_by_pivots(panel: &[Four], reciprocal: &[c64; 4], block: usize) -> [Four; 4] {
    let blocks = panel.len() / 4;
    let mut w = [ZERO; 4];
    for r in (0..4).rev() {
        let row = &panel[r * blocks..(r + 1) * blocks];
        let mut sum = row[block];
        for (c, w) in w.iter().enumerate().skip(r + 1) {
            sum = add(-number(&row[0], c), w, &sum);
        }
        w[r] = add(reciprocal[r], &sum, &ZERO);
    }
    w
}

/// D⁻¹ b with the rows of d lᵀ.
#[inline(always)]
fn solve_pivots(rows: [Four; 4], reciprocal: &[c64; 4], mut b: [c64; 4]) -> [c64; 4] {
    for r in 0..4 {
        let z = b[r] * reciprocal[r];
        for (c, b) in b.iter_mut().enumerate().skip(r + 1) {
            *b -= z * number(&rows[r], c);
        }
        b[r] = z;
    }
    for r in (0..4).rev() {
        let mut sum = c64::new(0.0, 0.0);
        for (c, b) in b.iter().enumerate().skip(r + 1) {
            sum += number(&rows[r], c) * b;
        }
        b[r] -= sum * reciprocal[r];
    }
    b
}
