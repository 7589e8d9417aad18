//! A band bordered by few constraint rows, condensed onto their multipliers.
//!
//! If K itself has an inverse, as K + c M of a motion does, the bordered system needs only a
//! factorisation of the band and one of a matrix S as large as the number r of rows:
//!
//! ```text
//! S = B K⁻¹ Bᵀ,   S μ = B K⁻¹ f − g,   x = K⁻¹ f − K⁻¹Bᵀ μ
//! ```
//!
//! S is a band where the rows are many (the private module `linear::schur`). This takes r
//! substitutions for K⁻¹Bᵀ at factorisation and one per solution, which is a fifth of the time of a
//! sparse LU for a chain of two beams. Beams are not coupled in K, so that the substitution for the
//! row of a joint involves only the beams that it joins.

use super::bordered::BorderRow;
use super::complex_ldl::ComplexLdl;
use super::interleaved::fits;
use super::order::Order;
use super::schur::{Numbering, Schur, SchurLu};
use super::symmetric::{Ldl, SymmetricBand};
use super::{Matrix, Singular};
use faer::c64;
use nalgebra::DVector;
use std::ops::Range;

/// Number of substitutions with all nodes, or as many nodes in substitutions for some beams, above
/// which a sparse LU is faster.
const MOST_SUBSTITUTIONS: usize = 48;
/// Multiplications per unknown that the factorisation of S may take: with more a sparse LU of the
/// whole is faster.
const MOST_WORK: usize = 2000;
/// Number of local rows above which the LU of a wider band is faster ([`super::interleaved`]).
const MOST_LOCAL_ROWS: usize = 12;

/// Whether the rows are few enough, or involve so few beams each, that this method is the fastest.
pub fn serves(matrix: &Matrix, border: &[BorderRow]) -> bool {
    if fits(matrix, border) {
        return border.len() <= MOST_LOCAL_ROWS;
    }
    if border.len() <= MOST_SUBSTITUTIONS {
        return true;
    }
    let Matrix::Symmetric(band) = matrix else { return false };
    let nodes = band.size() / 4;
    let parts = Parts::new(&[band], Order::new(nodes, false));
    let of_row = |row: &BorderRow| parts.of(row).map(|part| parts.positions[part].len()).sum::<usize>();
    let narrow = || Numbering::new(border.len(), &parts.rows(border)).work() <= MOST_WORK * band.size();
    border.iter().map(of_row).sum::<usize>() <= MOST_SUBSTITUTIONS * nodes && narrow()
}

/// The parts of a band that are not coupled, such as beams: each consists of successive nodes.
#[derive(Clone, Debug, Default)]
struct Parts {
    of_node: Vec<u32>,
    /// Per part: its first node.
    first: Vec<usize>,
    /// Per part: the positions at which its nodes are eliminated.
    positions: Vec<Vec<u32>>,
}

impl Parts {
    /// The parts of a sum of `bands` whose nodes are eliminated in the given order.
    fn new(bands: &[&SymmetricBand], order: Order) -> Self {
        let nodes = bands.first().map_or(0, |band| band.size() / 4);
        let mut parts = Self::default();
        // The node after the last with which any node so far is coupled.
        let mut end = 0;
        for node in 0..nodes {
            if node >= end {
                parts.first.push(node);
            }
            let reach = bands.iter().map(|band| band.reach(node)).max().unwrap_or(0);
            end = end.max(node + reach + 1);
            parts.of_node.push(parts.first.len() as u32 - 1);
        }
        parts.positions = vec![Vec::new(); parts.first.len()];
        for position in 0..nodes {
            let part = parts.of_node[order.node(position)] as usize;
            parts.positions[part].push(position as u32);
        }
        parts
    }

    /// The parts that a row, whose unknowns rise, touches.
    fn of<'r>(&'r self, row: &'r BorderRow) -> impl Iterator<Item = usize> + 'r {
        let mut last = None;
        row.iter().filter_map(move |(i, _)| {
            let part = self.of_node[i / 4] as usize;
            (last.replace(part) != Some(part)).then_some(part)
        })
    }

    /// The unknowns of a part.
    fn unknowns(&self, part: usize) -> Range<usize> {
        let first = self.first[part];
        4 * first..4 * (first + self.positions[part].len())
    }

    /// Per part: the rows that touch it.
    fn rows(&self, border: &[BorderRow]) -> Vec<Vec<usize>> {
        let mut rows = vec![Vec::new(); self.first.len()];
        for (r, row) in border.iter().enumerate() {
            self.of(row).for_each(|part| rows[part].push(r));
        }
        rows
    }
}

/// A column of K⁻¹ Bᵀ: per part, its first unknown and the numbers there.
type Column<T> = Vec<(usize, Vec<T>)>;

fn dot(row: &BorderRow, x: &[f64]) -> f64 {
    row.iter().map(|(i, value)| value * x[*i]).sum()
}

/// The same with the numbers `x` of the unknowns `range` only.
fn dot_within(row: &BorderRow, range: &Range<usize>, x: &[f64]) -> f64 {
    let inside = row.iter().filter(|(i, _)| range.contains(i));
    inside.map(|(i, value)| value * x[i - range.start]).sum()
}

/// A bordered matrix, by the LDLᵀ of its band and the LU of S.
#[derive(Clone, Debug)]
pub struct Condensed {
    ldl: Ldl,
    border: Vec<BorderRow>,
    /// K⁻¹ Bᵀ.
    columns: Vec<Column<f64>>,
    schur: SchurLu<f64>,
}

impl Condensed {
    /// Borders the factorised sum `ldl` of `bands`.
    ///
    /// # Errors
    /// [`Singular`] if the rows are linearly dependent.
    pub fn new(ldl: Ldl, bands: &[&SymmetricBand], border: &[BorderRow]) -> Result<Self, Singular> {
        let parts = Parts::new(bands, ldl.order());
        let rows = parts.rows(border);
        let size = parts.of_node.len() * 4;
        let mut x = vec![0.0; size];
        let mut schur = Schur::zeros(border.len(), &rows);
        let mut columns = Vec::with_capacity(border.len());
        for (c, row) in border.iter().enumerate() {
            row.iter().for_each(|(i, value)| x[*i] = *value);
            let mut column = Column::new();
            for part in parts.of(row) {
                let range = parts.unknowns(part);
                ldl.solve_part(&parts.positions[part], &mut x);
                let solution = x[range.clone()].to_vec();
                x[range.clone()].fill(0.0);
                for &r in &rows[part] {
                    schur.add(r, c, dot_within(&border[r], &range, &solution));
                }
                column.push((range.start, solution));
            }
            columns.push(column);
        }
        let schur = schur.factorise().ok_or(Singular { row: size })?;
        Ok(Self { ldl, border: border.to_vec(), columns, schur })
    }

    /// The factorised band, whose memory the next factorisation reuses.
    pub fn into_ldl(self) -> Ldl {
        self.ldl
    }

    /// Solves in place; `b` holds the unknowns first and the multipliers last.
    pub fn solve(&self, b: &mut [f64]) {
        let (x, g) = b.split_at_mut(b.len() - self.border.len());
        self.ldl.solve(x);
        let mut mu = DVector::from_fn(g.len(), |r, _| dot(&self.border[r], x) - g[r]);
        self.schur.solve(&mut mu);
        for (column, mu) in self.columns.iter().zip(mu.iter()) {
            for (first, column) in column {
                x[*first..].iter_mut().zip(column).for_each(|(x, c)| *x -= mu * c);
            }
        }
        g.copy_from_slice(mu.as_slice());
    }
}

/// As [`Condensed`], for the complex matrices of collocation's stages.
#[derive(Clone, Debug)]
pub struct ComplexCondensed {
    ldl: ComplexLdl,
    border: Vec<BorderRow>,
    /// K⁻¹ Bᵀ.
    columns: Vec<Column<c64>>,
    schur: SchurLu<c64>,
}

impl ComplexCondensed {
    /// Borders the factorised sum `ldl` of `bands`, the second times a complex number.
    ///
    /// # Errors
    /// [`Singular`] if the rows are linearly dependent.
    pub fn new(ldl: ComplexLdl, bands: &[&SymmetricBand], border: &[BorderRow]) -> Result<Self, Singular> {
        let parts = Parts::new(bands, ldl.order());
        let rows = parts.rows(border);
        let size = parts.of_node.len() * 4;
        let (mut re, mut im) = (vec![0.0; size], vec![0.0; size]);
        let mut schur = Schur::zeros(border.len(), &rows);
        let mut columns = Vec::with_capacity(border.len());
        for (c, row) in border.iter().enumerate() {
            row.iter().for_each(|(i, value)| re[*i] = *value);
            let mut column = Column::new();
            for part in parts.of(row) {
                let range = parts.unknowns(part);
                ldl.solve_part(&parts.positions[part], &mut re, &mut im);
                let [here_re, here_im] = [&re, &im].map(|x| &x[range.clone()]);
                for &r in &rows[part] {
                    let of = |x| dot_within(&border[r], &range, x);
                    schur.add(r, c, c64::new(of(here_re), of(here_im)));
                }
                let solution = here_re.iter().zip(here_im).map(|(re, im)| c64::new(*re, *im)).collect();
                column.push((range.start, solution));
                re[range.clone()].fill(0.0);
                im[range].fill(0.0);
            }
            columns.push(column);
        }
        let schur = schur.factorise().ok_or(Singular { row: size })?;
        Ok(Self { ldl, border: border.to_vec(), columns, schur })
    }

    /// The factorised band, whose memory the next factorisation reuses.
    pub fn into_ldl(self) -> ComplexLdl {
        self.ldl
    }

    /// Solves in place; `re` and `im` hold the unknowns first and the multipliers last.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        let unknowns = re.len() - self.border.len();
        let ((xr, gr), (xi, gi)) = (re.split_at_mut(unknowns), im.split_at_mut(unknowns));
        self.ldl.solve(xr, xi);
        let mut mu = DVector::from_fn(gr.len(), |r, _| {
            let row = &self.border[r];
            c64::new(dot(row, xr) - gr[r], dot(row, xi) - gi[r])
        });
        self.schur.solve(&mut mu);
        for (column, mu) in self.columns.iter().zip(mu.iter()) {
            for (first, column) in column {
                for ((xr, xi), c) in xr[*first..].iter_mut().zip(&mut xi[*first..]).zip(column) {
                    *xr -= mu.re * c.re - mu.im * c.im;
                    *xi -= mu.re * c.im + mu.im * c.re;
                }
            }
        }
        for ((gr, gi), mu) in gr.iter_mut().zip(gi).zip(mu.iter()) {
            (*gr, *gi) = (mu.re, mu.im);
        }
    }
}
