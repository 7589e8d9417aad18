//! Linear algebra of the tangent: storage by pattern, factorisation, inertia.
//!
//! Every unknown belongs to a node, and a node has four: x, y, x', y'. A beam's tangent is
//! therefore a band of 4 × 4 blocks, with as many blocks to the right of the diagonal as a support
//! has further nodes (1 for the cable element, 5 for six-node radial point interpolation). The
//! pattern decides among seven factorisations; the caller only states whether a matrix is definite:
//!
//! | pattern | method | file |
//! |---|---|---|
//! | symmetric band | LDLᵀ by blocks, no pivoting; its signs are the inertia | [`symmetric`] |
//! | band (follower loads) with a mass | LU by blocks, pivoting within them | [`unsymmetric`] |
//! | band without one, or any of these with a vanishing pivot | LU with partial pivoting | [`band`] |
//! | the first, definite and bordered by few constraint rows | LDLᵀ and a small Schur complement | [`condensed`] |
//! | symmetric band of neighbours, bordered by rows within three nodes | LDLᵀ, the rows in between | [`chain`] |
//! | band bordered by other constraint rows within it | LU of a band in another order | [`interleaved`] |
//! | band bordered by others, such as those of joints | sparse LU by faer | [`bordered`] |
//!
//! Bands of small blocks have factorisations of their own, because a Newton iteration is little
//! else: to factorise and to solve takes faer's sparse LLᵀ, its pattern analysed once, 7 to 8 times
//! as long for cable elements and 11 times for radial point interpolation, its sparse LU 3 to 5
//! times, for 13 nodes as for 10,000 (`faer` 0.24, one thread, AVX2).
//!
//! The module `inertia` finds the inertia on the motions that constraint rows leave. The module
//! `structures` tells which nodes belong together. The complex
//! matrices of collocation's stages are in [`complex`], the constant mass matrix is in
//! [`isotropic`].

pub mod band;
pub mod bordered;
pub mod chain;
pub mod complex;
mod complex_ldl;
pub mod condensed;
mod equilibrate;
mod four;
pub(crate) mod inertia;
pub mod interleaved;
pub mod isotropic;
mod order;
mod schur;
mod sparse_ldl;
mod structures;
pub mod symmetric;
pub mod unsymmetric;

use crate::lanes::fma;
use band::{Band, BandLu};
use bordered::{BorderRow, Bordered};
use chain::Chain;
use condensed::Condensed;
use interleaved::Interleaved;
use sparse_ldl::SparseLdl;
use structures::structures;
use symmetric::{Ldl, SymmetricBand};
use unsymmetric::BlockLu;

/// A tangent matrix under assembly.
#[derive(Clone, Debug)]
pub enum Matrix {
    /// Upper half of a symmetric matrix.
    Symmetric(SymmetricBand),
    /// All entries of an unsymmetric matrix.
    General(Band),
}

/// Panic message of methods that solve with a tangent before one is factorised, a fault of the
/// program.
pub(crate) const NOT_FACTORISED: &str = "a tangent is factorised before it is solved with";

/// Factor of the weights with which the signs of pivots are counted a second time: without
/// pivoting, a small pivot may amplify round-off to the size of entries eliminated after it.
const OTHER_WEIGHTS: f64 = 30.0;

/// The matrix could not be factorised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is singular: no pivot in row {row}")]
pub struct Singular {
    /// Row (unknown) at which no pivot was found.
    pub row: usize,
}

impl Matrix {
    /// A zero matrix for `nodes` nodes of four unknowns whose supports span `blocks` nodes.
    pub fn zeros(nodes: usize, blocks: usize, symmetric: bool) -> Self {
        if symmetric {
            Self::Symmetric(SymmetricBand::zeros(nodes, blocks))
        } else {
            Self::General(Band::zeros(4 * nodes, 4 * blocks - 1))
        }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        match self {
            Self::Symmetric(matrix) => matrix.size(),
            Self::General(matrix) => matrix.size(),
        }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        match self {
            Self::Symmetric(matrix) => matrix.clear(),
            Self::General(matrix) => matrix.clear(),
        }
    }

    /// The entry in row `i`, column `j`; zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        match self {
            Self::Symmetric(matrix) => matrix.get(i, j),
            Self::General(matrix) => matrix.get(i, j),
        }
    }

    /// Columns that can be different from zero in row `i`.
    pub fn columns(&self, i: usize) -> std::ops::Range<usize> {
        match self {
            Self::Symmetric(matrix) => matrix.columns(i),
            Self::General(matrix) => matrix.columns(i),
        }
    }

    /// Adds `factor` times a matrix of the same size whose band is not wider.
    pub fn add(&mut self, factor: f64, other: &Self) {
        match (&mut *self, other) {
            (Self::Symmetric(a), Self::Symmetric(b)) if a.stride() == b.stride() => a.add(factor, b),
            (Self::General(a), Self::Symmetric(b)) => b.add_to(factor, a),
            _ => {
                for i in 0..other.size() {
                    other.columns(i).for_each(|j| self.add_at(i, j, factor * other.get(i, j)));
                }
            }
        }
    }

    /// ½ (A + Aᵀ).
    pub fn symmetric_part(&self) -> Self {
        let mut part = Self::zeros(self.size() / 4, self.columns(0).len() / 4, true);
        for i in 0..self.size() {
            // The band of a row may end within a node that no other row of its node reaches: with zeros.
            let right = part.columns(i).filter(|j| *j >= i);
            right.for_each(|j| part.set(i, j, 0.5 * (self.get(i, j) + self.get(j, i))));
        }
        part
    }

    /// Bytes of the entries.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Symmetric(matrix) => matrix.bytes(),
            Self::General(matrix) => matrix.bytes(),
        }
    }

    /// Transforms the unknowns `2 pair` and `2 pair + 1` to a frame rotated by the angle with the
    /// given cosine and sine: rows and columns are replaced by their components along that frame's
    /// axes.
    pub fn rotate_pair(&mut self, pair: usize, cosine: f64, sine: f64) {
        self.change_pair(pair, [[cosine, sine], [-sine, cosine]]);
    }

    /// Replaces the matrix K by T K Tᵀ, where T mixes only the unknowns `2 pair` and `2 pair + 1`.
    pub fn change_pair(&mut self, pair: usize, [t, u]: [[f64; 2]; 2]) {
        let (x, y) = (2 * pair, 2 * pair + 1);
        // The band of either row ends within a node that the other row does not reach: with zeros.
        let (of_x, of_y) = (self.columns(x), self.columns(y));
        for j in of_x.start.max(of_y.start)..of_x.end.min(of_y.end) {
            if j == x || j == y {
                continue;
            }
            let (a, b) = (self.get(x, j), self.get(y, j));
            self.set(x, j, t[0] * a + t[1] * b);
            self.set(y, j, u[0] * a + u[1] * b);
            if let Self::General(matrix) = self {
                let (a, b) = (matrix.get(j, x), matrix.get(j, y));
                matrix.set(j, x, t[0] * a + t[1] * b);
                matrix.set(j, y, u[0] * a + u[1] * b);
            }
        }
        let k = nalgebra::Matrix2::new(self.get(x, x), self.get(x, y), self.get(y, x), self.get(y, y));
        let r = nalgebra::Matrix2::new(t[0], t[1], u[0], u[1]);
        let k = r * k * r.transpose();
        self.set(x, x, k[(0, 0)]);
        self.set(x, y, k[(0, 1)]);
        self.set(y, y, k[(1, 1)]);
        if let Self::General(matrix) = self {
            matrix.set(y, x, k[(1, 0)]);
        }
    }

    /// Replaces row and column `i` by those of the identity times `diagonal`.
    pub fn eliminate(&mut self, i: usize, diagonal: f64) {
        for j in self.columns(i) {
            self.set(i, j, 0.0);
            if let Self::General(matrix) = self {
                matrix.set(j, i, 0.0);
            }
        }
        self.set(i, i, diagonal);
    }

    /// Adds `factor` times the diagonal matrix with the entries `diagonal`.
    pub fn add_diagonal(&mut self, factor: f64, diagonal: &[f64]) {
        for (i, value) in diagonal.iter().enumerate() {
            self.set(i, i, fma(factor, *value, self.get(i, i)));
        }
    }

    /// Multiplies all entries by `factor`.
    pub fn scale(&mut self, factor: f64) {
        match self {
            Self::Symmetric(matrix) => matrix.scale(factor),
            Self::General(matrix) => matrix.scale(factor),
        }
    }

    /// Adds `value` to the entry in row `i`, column `j`. A symmetric matrix takes only calls with
    /// `i <= j` and ignores the others, since one entry stands for both halves.
    pub fn add_at(&mut self, i: usize, j: usize, value: f64) {
        if matches!(self, Self::General(_)) || i <= j {
            self.set(i, j, self.get(i, j) + value);
        }
    }

    /// Adds a block c ⊗ 1₂ in the rows of node `a` and the columns of node `b`, which is not before
    /// it, and its transpose in the other half: c is
    /// \[position–position, position–slope, slope–position, slope–slope\].
    #[inline]
    pub fn add_isotropic(&mut self, a: usize, b: usize, c: [f64; 4]) {
        for (place, value) in c.into_iter().enumerate() {
            let (row, column) = (2 * (place / 2), 2 * (place % 2));
            for d in 0..2 {
                let (i, j) = (row + d, column + d);
                match self {
                    Self::Symmetric(matrix) => {
                        let stride = matrix.stride();
                        matrix.panel_mut(a)[i * stride + 4 * (b - a) + j] += value;
                    }
                    Self::General(matrix) => {
                        matrix.row_mut(4 * a + i, 4 * b + j, 1)[0] += value;
                        if a != b {
                            matrix.row_mut(4 * b + j, 4 * a + i, 1)[0] += value;
                        }
                    }
                }
            }
        }
    }

    /// `y += factor · A x`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        match self {
            Self::Symmetric(matrix) => matrix.multiply_add(factor, x, y),
            Self::General(matrix) => matrix.multiply_add(factor, x, y),
        }
    }

    /// A x.
    pub fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        self.multiply_add(1.0, x, &mut y);
        y
    }

    /// Σ (Aᵢⱼ xᵢ xⱼ)² over all entries.
    pub fn squares_of_terms(&self, x: &[f64]) -> f64 {
        match self {
            Self::Symmetric(matrix) => matrix.squares_of_terms(x),
            Self::General(matrix) => {
                let of_row = |(i, a): (usize, &f64)| -> f64 {
                    self.columns(i).map(|j| (matrix.get(i, j) * a * x[j]).powi(2)).sum()
                };
                x.iter().enumerate().map(of_row).sum()
            }
        }
    }

    fn set(&mut self, i: usize, j: usize, value: f64) {
        match self {
            Self::Symmetric(matrix) => matrix.set(i, j, value),
            Self::General(matrix) => matrix.set(i, j, value),
        }
    }
}

/// A factorised [`Matrix`].
#[derive(Clone, Debug)]
pub enum Factor {
    /// LDLᵀ of a symmetric band.
    Ldl(Ldl),
    /// LU of a band.
    Lu(BandLu),
    /// LU of a band of blocks.
    BlockLu(BlockLu),
    /// LDLᵀ of a symmetric band bordered by few rows.
    Condensed(Box<Condensed>),
    /// LDLᵀ of a symmetric band of neighbours that is bordered by rows within three nodes.
    Chain(Box<Chain>),
    /// LU of a bordered band whose constraint rows are numbered among the unknowns.
    Interleaved(Box<Interleaved>),
    /// Sparse LDLᵀ of a symmetric band that is bordered by any rows.
    SparseLdl(Box<SparseLdl>),
    /// Sparse LU of a bordered band.
    Bordered(Box<Bordered>),
}

/// What is known of a matrix to be factorised.
#[derive(Clone, Copy, Default)]
struct Hint<'m> {
    /// It is probably definite.
    definite: bool,
    /// c and M, where c M is to be added to it.
    shift: Option<(f64, &'m Matrix)>,
}

impl Factor {
    /// Factorises `matrix`, bordered by constraint rows if there are any. A symmetric matrix whose
    /// LDLᵀ meets a vanishing pivot is factorised again with pivoting.
    ///
    /// # Errors
    /// [`Singular`] if the matrix is singular to round-off.
    pub fn new(matrix: &Matrix, border: &[BorderRow]) -> Result<Self, Singular> {
        if !border.is_empty() {
            return Self::bordered(None, matrix, Hint::default(), border);
        }
        match matrix {
            Matrix::Symmetric(symmetric) => match Ldl::new(symmetric) {
                Ok(ldl) => Ok(Self::Ldl(ldl)),
                Err(_) => Ok(Self::Lu(BandLu::new(&symmetric.to_band())?)),
            },
            Matrix::General(band) => Ok(Self::Lu(BandLu::new(band)?)),
        }
    }

    /// Factorises `matrix`, plus c M where `shift` is (c, M), bordered by at least one row. A chain
    /// whose elimination meets a vanishing pivot is factorised again with pivoting.
    fn bordered(
        earlier: Option<Self>,
        matrix: &Matrix,
        Hint { definite, shift }: Hint<'_>,
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        let (kept, earlier, sparse) = match earlier {
            Some(Self::Chain(chain)) => (Some(*chain), None, None),
            Some(Self::Bordered(bordered)) => (None, Some(*bordered), None),
            Some(Self::SparseLdl(ldl)) => (None, None, Some(ldl)),
            _ => (None, None, None),
        };
        let symmetric = match (matrix, shift) {
            (Matrix::Symmetric(k), Some((c, Matrix::Symmetric(m)))) => Some((k, Some((c, m)))),
            (Matrix::Symmetric(k), None) => Some((k, None)),
            _ => None,
        };
        if let Some((k, shift)) = symmetric
            && chain::fits(k, border)
            && let Ok(chain) = Chain::new(kept, k, shift, definite, border)
        {
            return Ok(Self::Chain(Box::new(chain)));
        }
        let mut sum = std::borrow::Cow::Borrowed(matrix);
        if let Some((c, mass)) = shift {
            sum.to_mut().add(c, mass);
        }
        if interleaved::fits(&sum, border) {
            let lu = Interleaved::new(&sum, |i, j| sum.get(i, j), border)?;
            return Ok(Self::Interleaved(Box::new(lu)));
        }
        for factor in [1.0, OTHER_WEIGHTS] {
            if let Ok(ldl) = SparseLdl::new(sparse.as_deref(), &sum, border, factor)
                && ldl.is_sound(&sum)
            {
                return Ok(Self::SparseLdl(Box::new(ldl)));
            }
        }
        Ok(Self::Bordered(Box::new(Bordered::new(&sum, border, earlier)?)))
    }

    /// Factorises a symmetric positive definite `matrix`, bordered by constraint rows if there are
    /// any, where possible in the memory of an earlier factorisation.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn definite(earlier: Option<Self>, matrix: &Matrix, border: &[BorderRow]) -> Result<Self, Singular> {
        match matrix {
            Matrix::Symmetric(symmetric) if !border.is_empty() && condensed::serves(matrix, border) => {
                let condensed = Condensed::new(Ldl::new(symmetric)?, &[symmetric], border)?;
                Ok(Self::Condensed(Box::new(condensed)))
            }
            _ if border.is_empty() => Self::new(matrix, border),
            _ => Self::bordered(earlier, matrix, Hint { definite: true, shift: None }, border),
        }
    }

    /// As [`Self::new`], reusing the memory and the ordering of an earlier factorisation of the
    /// same pattern.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn again(earlier: Option<Self>, matrix: &Matrix, border: &[BorderRow]) -> Result<Self, Singular> {
        match (earlier, matrix) {
            (Some(Self::Ldl(ldl)), Matrix::Symmetric(symmetric)) if border.is_empty() => {
                Ldl::again(Some(ldl), symmetric, None).map(Self::Ldl).or_else(|_| Self::new(matrix, border))
            }
            (Some(earlier), _) if !border.is_empty() => {
                Self::bordered(Some(earlier), matrix, Hint::default(), border)
            }
            _ => Self::new(matrix, border),
        }
    }

    /// Factorises `matrix` + c `mass`, bordered by constraint rows if there are any, reusing an
    /// earlier factorisation of the same pattern. The sum is assumed to be definite, as it is if c
    /// is large enough, that is, if the step is short enough to resolve the motion.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn shifted(
        earlier: Option<Self>,
        matrix: &Matrix,
        (c, mass): (f64, &Matrix),
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        let (kept, earlier) = match earlier {
            Some(Self::Ldl(ldl)) => (Some(ldl), None),
            Some(Self::Condensed(condensed)) => (Some(condensed.into_ldl()), None),
            other => (None, other),
        };
        if let (Matrix::Symmetric(k), Matrix::Symmetric(m), true) =
            (matrix, mass, condensed::serves(matrix, border))
        {
            match Ldl::again(kept, k, Some((c, m))) {
                Ok(ldl) if border.is_empty() => return Ok(Self::Ldl(ldl)),
                Ok(ldl) => {
                    if let Ok(condensed) = Condensed::new(ldl, &[k, m], border) {
                        return Ok(Self::Condensed(Box::new(condensed)));
                    }
                }
                Err(_) => {}
            }
        }
        if !border.is_empty() {
            return Self::bordered(earlier, matrix, Hint { definite: true, shift: Some((c, mass)) }, border);
        }
        let mut sum = matrix.clone();
        sum.add(c, mass);
        if let Matrix::General(band) = &sum
            && let Ok(lu) = BlockLu::new(band)
        {
            return Ok(Self::BlockLu(lu));
        }
        Self::again(earlier, &sum, border)
    }

    /// Solves A x = b in place; the multipliers' part of `b` comes last.
    pub fn solve(&self, b: &mut [f64]) {
        match self {
            Self::Ldl(ldl) => ldl.solve(b),
            Self::Lu(lu) => lu.solve(b),
            Self::BlockLu(lu) => lu.solve(b),
            Self::Condensed(condensed) => condensed.solve(b),
            Self::Chain(chain) => chain.solve(b),
            Self::Interleaved(interleaved) => interleaved.solve(b),
            Self::SparseLdl(ldl) => ldl.solve(b),
            Self::Bordered(bordered) => bordered.solve(b),
        }
    }

    /// Number of negative eigenvalues of a symmetric matrix (Sylvester's law of inertia); `None` if
    /// the factorisation does not determine it.
    pub fn negative_eigenvalues(&self) -> Option<usize> {
        match self {
            Self::Ldl(ldl) => Some(ldl.negative_pivots()),
            _ => None,
        }
    }

    /// Of how many separate structures the determinant of the factorised `matrix`, restricted to motions
    /// that the rows of `border` allow, is negative; `None` if the factorisation does not determine it.
    pub fn negative_determinants(&self, matrix: &Matrix, border: &[BorderRow]) -> Option<usize> {
        match self {
            Self::Lu(lu) => Some(negative_determinants(matrix, border, |i| lu.turns_sign(i))),
            Self::Interleaved(lu) => Some(negative_determinants(matrix, border, |i| lu.turns_sign(i))),
            Self::Bordered(_) => {
                let lu = Interleaved::of_any_reach(matrix, border)?;
                Some(negative_determinants(matrix, border, |i| lu.turns_sign(i)))
            }
            Self::Ldl(_) | Self::BlockLu(_) | Self::Condensed(_) | Self::Chain(_) | Self::SparseLdl(_) => {
                None
            }
        }
    }

    /// Number of negative eigenvalues of the factorised `matrix`, restricted to motions that the
    /// rows of `border` allow; `None` if it is unsymmetric or the number cannot be determined.
    pub fn negative_directions(&self, matrix: &Matrix, border: &[BorderRow]) -> Option<usize> {
        if border.is_empty() {
            return self.negative_eigenvalues();
        }
        if let (Self::Chain(chain), Matrix::Symmetric(k)) = (self, matrix)
            && let Some(count) = chain.negative_directions()
            && chain.negative_directions_again(OTHER_WEIGHTS, k, border) == Some(count)
        {
            return Some(count);
        }
        let known = if let Self::SparseLdl(ldl) = self { Some(&**ldl) } else { None };
        inertia::negative_directions(matrix, border, known)
    }
}

/// Of how many structures the determinant is negative, where the elimination of unknowns and multipliers
/// `turns_sign`. Interchanges stay within a structure. The determinant on the motions that rows allow
/// has the sign of the bordered matrix's, times −1 for each row.
fn negative_determinants(matrix: &Matrix, border: &[BorderRow], turns_sign: impl Fn(usize) -> bool) -> usize {
    let mut negative = vec![false; matrix.size() / 4];
    for (i, structure) in structures(matrix, border).into_iter().enumerate() {
        negative[structure] ^= turns_sign(i) != (i >= matrix.size());
    }
    negative.into_iter().filter(|negative| *negative).count()
}
