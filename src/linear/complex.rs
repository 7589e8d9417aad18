//! Factorisation of K + ζ M for a complex number ζ and real K and M: the matrices into which the stages of a collocation
//! method fall apart.
//!
//! K and M are symmetric there, so K + ζ M is complex *symmetric* (not Hermitian) and has L D Lᵀ. It exists without
//! pivoting: with M positive definite and Im ζ ≠ 0, x*(K + ζM)x has an imaginary part different from zero for every x, hence no
//! leading minor vanishes (George, Ikramov, Kucherov, *SIAM J. Matrix Anal. Appl.* 21, 2000, 377–387).
//! Real and imaginary parts are kept apart, so that all inner loops are real multiply–adds over contiguous rows: four times
//! as many as [`super::symmetric`] has, in the same order. Unsymmetric matrices and those bordered by many rows are
//! factorised with pivoting, as a band where the rows lie within it, else by faer's sparse LU.

use super::bordered::{BorderRow, Bordered};
use super::condensed::{self, ComplexCondensed};
use super::fma::fma;
use super::interleaved::{self, Interleaved};
use super::symmetric::SymmetricBand;
use super::{Matrix, Singular};
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

/// L D Lᵀ of a complex symmetric band. The rows hold D Lᵀ.
#[derive(Clone, Debug)]
pub struct ComplexLdl {
    nodes: usize,
    stride: usize,
    re: Vec<f64>,
    im: Vec<f64>,
    /// 1/d.
    reciprocal: Vec<c64>,
}

impl ComplexLdl {
    fn zeros(pattern: &SymmetricBand) -> Self {
        let (size, stride) = (pattern.size(), pattern.stride());
        Self {
            nodes: size / 4,
            stride,
            re: vec![0.0; size * stride],
            im: vec![0.0; size * stride],
            reciprocal: vec![c64::new(0.0, 0.0); size],
        }
    }

    fn factorize(&mut self, k: &SymmetricBand, m: &SymmetricBand, zeta: c64) -> Result<(), Singular> {
        let parts = self.re.iter_mut().zip(&mut self.im);
        for ((re, im), (k, m)) in parts.zip(k.data().iter().zip(m.data())) {
            *re = fma(zeta.re, *m, *k);
            *im = zeta.im * m;
        }
        match self.stride {
            8 => self.eliminate::<8>(),
            16 => self.eliminate::<16>(),
            24 => self.eliminate::<24>(),
            _ => self.eliminate::<0>(),
        }
    }

    fn eliminate<const STRIDE: usize>(&mut self) -> Result<(), Singular> {
        let stride = if STRIDE == 0 { self.stride } else { STRIDE };
        for node in 0..self.nodes {
            let (panel_re, later_re) = self.re[node * 4 * stride..].split_at_mut(4 * stride);
            let (panel_im, later_im) = self.im[node * 4 * stride..].split_at_mut(4 * stride);
            let mut reciprocal = [c64::new(0.0, 0.0); 4];
            for r in 0..4 {
                let (done_re, rest_re) = panel_re.split_at_mut((r + 1) * stride);
                let (done_im, rest_im) = panel_im.split_at_mut((r + 1) * stride);
                let (row_re, row_im) = (&done_re[r * stride..], &done_im[r * stride..]);
                let size = row_re[r] * row_re[r] + row_im[r] * row_im[r];
                // Written so that a NaN fails too.
                if !(size > 0.0 && size.is_finite()) {
                    return Err(Singular { row: 4 * node + r });
                }
                reciprocal[r] = c64::new(row_re[r] / size, -row_im[r] / size);
                let below = rest_re.chunks_exact_mut(stride).zip(rest_im.chunks_exact_mut(stride));
                for (below, (target_re, target_im)) in below.enumerate() {
                    let c = r + 1 + below;
                    let l = -c64::new(row_re[c], row_im[c]) * reciprocal[r];
                    let target = target_re.iter_mut().zip(target_im);
                    for ((t_re, t_im), (s_re, s_im)) in target.zip(row_re.iter().zip(row_im)) {
                        *t_re = fma(-l.im, *s_im, fma(l.re, *s_re, *t_re));
                        *t_im = fma(l.im, *s_re, fma(l.re, *s_im, *t_im));
                    }
                }
            }
            self.reciprocal[4 * node..4 * node + 4].copy_from_slice(&reciprocal);
            let reach = (stride / 4 - 1).min(self.nodes - 1 - node);
            let panels = later_re.chunks_exact_mut(4 * stride).zip(later_im.chunks_exact_mut(4 * stride));
            for (ahead, (target_re, target_im)) in panels.take(reach).enumerate() {
                let from = 4 * (ahead + 1);
                let length = stride - from;
                let rows = target_re.chunks_exact_mut(stride).zip(target_im.chunks_exact_mut(stride));
                for (r, (target_re, target_im)) in rows.enumerate() {
                    // One source row at a time: eight streams at once would not fit the registers.
                    for (k, reciprocal) in reciprocal.iter().enumerate() {
                        let (source_re, source_im) = (&panel_re[k * stride..], &panel_im[k * stride..]);
                        let l = -c64::new(source_re[from + r], source_im[from + r]) * *reciprocal;
                        let target = target_re[..length].iter_mut().zip(&mut target_im[..length]);
                        let source = source_re[from..stride].iter().zip(&source_im[from..stride]);
                        for ((t_re, t_im), (s_re, s_im)) in target.zip(source) {
                            *t_re = fma(-l.im, *s_im, fma(l.re, *s_re, *t_re));
                            *t_im = fma(l.im, *s_re, fma(l.re, *s_im, *t_im));
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        match self.stride {
            8 => self.substitute_window::<8>(re, im),
            16 => self.substitute_window::<16>(re, im),
            24 => self.substitute_window::<24>(re, im),
            _ => self.substitute(re, im),
        }
    }

    /// As [`super::symmetric::Ldl`] does it, with a window for each part.
    fn substitute_window<const STRIDE: usize>(&self, re: &mut [f64], im: &mut [f64]) {
        let panels_re = self.re.as_chunks::<STRIDE>().0.as_chunks::<4>().0;
        let panels_im = self.im.as_chunks::<STRIDE>().0.as_chunks::<4>().0;
        let ahead = STRIDE - 4;
        let (mut w_re, mut w_im) = ([0.0; STRIDE], [0.0; STRIDE]);
        let loaded = re.len().min(STRIDE);
        w_re[..loaded].copy_from_slice(&re[..loaded]);
        w_im[..loaded].copy_from_slice(&im[..loaded]);
        for (node, (u_re, u_im)) in panels_re.iter().zip(panels_im).enumerate() {
            for r in 0..4 {
                let z = c64::new(w_re[r], w_im[r]) * self.reciprocal[4 * node + r];
                // The second range has the length of whole registers.
                for range in [r + 1..4, 4..STRIDE] {
                    for c in range {
                        w_re[c] = fma(z.im, u_im[r][c], fma(-z.re, u_re[r][c], w_re[c]));
                        w_im[c] = fma(-z.im, u_re[r][c], fma(-z.re, u_im[r][c], w_im[c]));
                    }
                }
                (re[4 * node + r], im[4 * node + r]) = (z.re, z.im);
            }
            for (window, b) in [(&mut w_re, &*re), (&mut w_im, &*im)] {
                window.copy_within(4.., 0);
                match b.get(4 * node + STRIDE..4 * node + STRIDE + 4) {
                    Some(values) => window[ahead..].copy_from_slice(values),
                    None => window[ahead..].fill(0.0),
                }
            }
        }
        w_re.fill(0.0);
        w_im.fill(0.0);
        for (node, (u_re, u_im)) in panels_re.iter().zip(panels_im).enumerate().rev() {
            w_re.copy_within(..ahead, 4);
            w_im.copy_within(..ahead, 4);
            for r in (0..4).rev() {
                let (mut lanes_re, mut lanes_im) = ([0.0; 4], [0.0; 4]);
                for c in (4..STRIDE).step_by(4) {
                    for lane in 0..4 {
                        let (a_re, a_im) = (u_re[r][c + lane], u_im[r][c + lane]);
                        let (x_re, x_im) = (w_re[c + lane], w_im[c + lane]);
                        lanes_re[lane] = fma(-x_im, a_im, fma(x_re, a_re, lanes_re[lane]));
                        lanes_im[lane] = fma(x_im, a_re, fma(x_re, a_im, lanes_im[lane]));
                    }
                }
                let sum = |lanes: [f64; 4]| (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
                let mut sum = c64::new(sum(lanes_re), sum(lanes_im));
                for c in r + 1..4 {
                    sum += c64::new(u_re[r][c], u_im[r][c]) * c64::new(w_re[c], w_im[c]);
                }
                let x = c64::new(re[4 * node + r], im[4 * node + r]) - sum * self.reciprocal[4 * node + r];
                (w_re[r], w_im[r]) = (x.re, x.im);
                (re[4 * node + r], im[4 * node + r]) = (x.re, x.im);
            }
        }
    }

    fn substitute(&self, re: &mut [f64], im: &mut [f64]) {
        let stride = self.stride;
        let n = 4 * self.nodes;
        let row = |i: usize, from: usize, length: usize| {
            let start = i * stride + from;
            (&self.re[start..start + length], &self.im[start..start + length])
        };
        for i in 0..n {
            let start = 4 * (i / 4);
            let length = (start + stride).min(n) - (i + 1);
            let (row_re, row_im) = row(i, i + 1 - start, length);
            let z = c64::new(re[i], im[i]) * self.reciprocal[i];
            let target = re[i + 1..].iter_mut().zip(&mut im[i + 1..]);
            for ((t_re, t_im), (s_re, s_im)) in target.zip(row_re.iter().zip(row_im)) {
                *t_re = fma(z.im, *s_im, fma(-z.re, *s_re, *t_re));
                *t_im = fma(-z.im, *s_re, fma(-z.re, *s_im, *t_im));
            }
            (re[i], im[i]) = (z.re, z.im);
        }
        for i in (0..n).rev() {
            let start = 4 * (i / 4);
            let length = (start + stride).min(n) - (i + 1);
            let (row_re, row_im) = row(i, i + 1 - start, length);
            let (mut sum_re, mut sum_im) = (0.0, 0.0);
            let known = re[i + 1..].iter().zip(&im[i + 1..]);
            for ((x_re, x_im), (s_re, s_im)) in known.zip(row_re.iter().zip(row_im)) {
                sum_re = fma(-x_im, *s_im, fma(*x_re, *s_re, sum_re));
                sum_im = fma(*x_im, *s_re, fma(*x_re, *s_im, sum_im));
            }
            let x = c64::new(sum_re, sum_im) * self.reciprocal[i];
            re[i] -= x.re;
            im[i] -= x.im;
        }
    }
}
