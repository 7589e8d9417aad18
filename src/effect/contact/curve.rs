//! The curve of a cell as a polynomial in Bernstein's form, r(ξ) = Σ_j B_j(ξ) P_j with ξ ∈ [0, 1].
//!
//! The curve lies within the convex hull of its control points P_j, so that curves far from an
//! obstacle are recognised at once. A polynomial has at most as many roots in [0, 1] as its
//! Bernstein coefficients have changes of sign (Farin, *Curves and Surfaces for CAGD*, 2002, ch.
//! 5), by which all crossings of a curve and a border are found.
//!
//! Control points are linear in the beam's coordinates. The cable element's cubic is represented
//! exactly; shape functions that are not polynomials are interpolated between Lobatto points, with
//! a degree as high as they need.

use crate::basis::{Basis, BasisError, Quadrature};
use crate::lanes::fma;
use nalgebra::{DMatrix, Vector2};

/// Degrees that are tried, in this order, until one is accurate.
const DEGREES: [usize; 3] = [3, 7, 11];
/// Largest number of control points of a curve.
pub const MOST: usize = 12;
/// Largest number of coefficients of the square of a distance.
const MOST_COEFFICIENTS: usize = 2 * MOST - 1;
/// Largest accepted error of an interpolated shape function.
const EXACT: f64 = 1e-9;
/// Coefficients smaller than this, relative to the numbers they were computed from, count as zero.
const ROUND_OFF: f64 = 1e-14;
/// Intervals of ξ shorter than this are not divided further to separate roots.
const APART: f64 = 1e-10;

/// The binomial coefficient C(n, k).
fn binomial(n: usize, k: usize) -> f64 {
    (1..=k.min(n - k)).fold(1.0, |c, i| c * (n + 1 - i) as f64 / i as f64)
}

/// Writes the Bernstein polynomials B_j(ξ) of degree `degree` to the first entries of `values`.
pub fn bernstein(degree: usize, xi: f64, values: &mut [f64]) {
    values[0] = 1.0;
    for d in 1..=degree {
        values[d] = xi * values[d - 1];
        for j in (1..d).rev() {
            values[j] = xi * values[j - 1] + (1.0 - xi) * values[j];
        }
        values[0] *= 1.0 - xi;
    }
}

/// A curve, by its control points.
#[derive(Clone, Copy, Debug)]
pub struct Curve {
    points: [Vector2<f64>; MOST],
    count: usize,
}

impl Curve {
    /// The control points.
    pub fn points(&self) -> &[Vector2<f64>] {
        &self.points[..self.count]
    }

    /// The point at which the Bernstein polynomials have the values `values`.
    pub fn at(&self, values: &[f64]) -> Vector2<f64> {
        self.points().iter().zip(values).fold(Vector2::zeros(), |sum, (p, b)| sum + p * *b)
    }

    /// The curve of which each row of `control` yields a control point from the coefficients `q`.
    /// `N` is their number if it is known at compile time, or 0.
    #[inline(always)]
    fn of_rows<const N: usize>(control: &[f64], width: usize, q: &[f64]) -> Self {
        let width = if N == 0 { width } else { N };
        let q = &q[..2 * width];
        let mut curve = Self { points: [Vector2::zeros(); MOST], count: control.len() / width };
        for (point, row) in curve.points.iter_mut().zip(control.chunks_exact(width)) {
            // Two coefficients at a time fill the four lanes of a register.
            let mut sum = [0.0; 4];
            for (n, q) in row.as_chunks::<2>().0.iter().zip(q.as_chunks::<4>().0) {
                let n = [n[0], n[0], n[1], n[1]];
                for lane in 0..4 {
                    sum[lane] = fma(n[lane], q[lane], sum[lane]);
                }
            }
            *point = Vector2::new(sum[0] + sum[2], sum[1] + sum[3]);
        }
        curve
    }

    /// The point at ξ = ½.
    pub fn middle(&self) -> Vector2<f64> {
        self.halves()[1].points[0]
    }

    /// Both halves, by de Casteljau's algorithm.
    pub fn halves(&self) -> [Self; 2] {
        let (mut first, mut second) = (*self, *self);
        let last = self.count - 1;
        for d in 1..=last {
            for j in 0..=last - d {
                second.points[j] = 0.5 * (second.points[j] + second.points[j + 1]);
            }
            first.points[d] = second.points[0];
        }
        [first, second]
    }

    /// The curve whose control points are `f` of the corresponding control points of `curves`.
    pub fn combine<const N: usize>(
        curves: [&Self; N],
        f: impl Fn([Vector2<f64>; N]) -> Vector2<f64>,
    ) -> Self {
        let mut result = *curves[0];
        for j in 0..result.count {
            result.points[j] = f(curves.map(|curve| curve.points[j]));
        }
        result
    }
}

/// A line n · r = c or a circle that a curve may cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Border {
    /// Unit normal n, and distance c of the line from the origin along it \[m\].
    Line(Vector2<f64>, f64),
    /// Centre and radius \[m\].
    Circle(Vector2<f64>, f64),
}

impl Border {
    /// Adds the parameters ξ in (0, 1) at which `curve`, one of `cells`, crosses the border, in no
    /// order.
    pub fn crossings(&self, cells: &Cells, curve: &Curve, roots: &mut Vec<f64>) {
        let points = curve.points();
        if let Self::Circle(center, radius) = self
            && points.iter().all(|p| (p - center).norm_squared() < radius * radius)
        {
            // With its control points, the whole curve lies within the circle.
            return;
        }
        let mut polynomial = Polynomial { coefficients: [0.0; MOST_COEFFICIENTS], count: points.len() };
        let mut scale = 0.0_f64;
        match *self {
            Self::Line(normal, offset) => {
                for (b, p) in polynomial.coefficients.iter_mut().zip(points) {
                    *b = normal.dot(p) - offset;
                    scale = scale.max(p.x.abs() + p.y.abs() + offset.abs());
                }
            }
            Self::Circle(center, radius) => {
                polynomial.count = 2 * points.len() - 1;
                for (i, (p, weights)) in points.iter().zip(cells.products.chunks(points.len())).enumerate() {
                    for (j, (q, weight)) in points.iter().zip(weights).enumerate() {
                        let product = (p - center).dot(&(q - center)) - radius * radius;
                        polynomial.coefficients[i + j] += weight * product;
                    }
                    scale =
                        scale.max((p - center).norm_squared() + radius * radius + center.norm() * p.norm());
                }
            }
        }
        polynomial.roots(ROUND_OFF * scale, [0.0, 1.0], roots);
    }
}

/// A polynomial in Bernstein's form.
#[derive(Clone, Copy, Debug)]
struct Polynomial {
    coefficients: [f64; MOST_COEFFICIENTS],
    count: usize,
}

impl Polynomial {
    fn halves(&self) -> [Self; 2] {
        let (mut first, mut second) = (*self, *self);
        let last = self.count - 1;
        for d in 1..=last {
            for j in 0..=last - d {
                second.coefficients[j] = 0.5 * (second.coefficients[j] + second.coefficients[j + 1]);
            }
            first.coefficients[d] = second.coefficients[0];
        }
        [first, second]
    }

    /// The coefficients times the binomials, C(n, i) b_i.
    fn scaled(&self) -> Self {
        let (mut scaled, mut binomial) = (*self, 1.0);
        let degree = self.count - 1;
        for (i, b) in scaled.coefficients[..self.count].iter_mut().enumerate() {
            *b *= binomial;
            binomial = binomial * (degree - i) as f64 / (i + 1) as f64;
        }
        scaled
    }

    /// The value at x of a polynomial that is given by its [`Self::scaled`] coefficients: by Horner's
    /// rule in x/(1 − x), or from the other end in (1 − x)/x, whichever is smaller
    /// (Schumaker, Volk, *Comput. Aided Geom. Des.* 3, 1986, 149–154).
    fn value(&self, x: f64) -> f64 {
        let (b, degree) = (&self.coefficients[..self.count], self.count as i32 - 1);
        let y = 1.0 - x;
        if x <= 0.5 {
            b.iter().rev().fold(0.0, |sum, b| fma(sum, x / y, *b)) * y.powi(degree)
        } else {
            b.iter().fold(0.0, |sum, b| fma(sum, y / x, *b)) * x.powi(degree)
        }
    }

    /// Appends the places at which the sign changes; [0, 1] of the polynomial stands for
    /// `[from, to]`.
    fn roots(&self, zero: f64, [from, to]: [f64; 2], roots: &mut Vec<f64>) {
        let coefficients = &self.coefficients[..self.count];
        let signs = coefficients.iter().filter(|b| b.abs() > zero).map(|b| *b > 0.0);
        let changes = signs.clone().zip(signs.skip(1)).filter(|(a, b)| a != b).count();
        if changes == 0 || to - from < APART {
            return;
        }
        let ends = [coefficients[0], coefficients[self.count - 1]];
        if changes == 1 && ends.iter().all(|end| end.abs() > zero) {
            roots.push(from + (to - from) * self.root(ends));
            return;
        }
        let middle = 0.5 * (from + to);
        let [first, second] = self.halves();
        first.roots(zero, [from, middle], roots);
        // A root exactly in the middle belongs to neither half.
        let next = second.coefficients[0];
        if next.abs() <= zero {
            let scaled = self.scaled();
            if scaled.value(0.5 - 0.5 * APART) * scaled.value(0.5 + 0.5 * APART) < 0.0 {
                roots.push(middle);
            }
        }
        second.roots(zero, [middle, to], roots);
    }

    /// The only root, by the Illinois variant of false position, which halves the value at an end
    /// that is kept twice in a row.
    fn root(&self, [mut low, mut high]: [f64; 2]) -> f64 {
        let scaled = self.scaled();
        let (mut from, mut to, mut side) = (0.0, 1.0, 0_i8);
        let mut x = 0.0;
        for _ in 0..60 {
            let next = from - low * (to - from) / (high - low);
            if (next - x).abs() < 1e-16 {
                return next;
            }
            x = next;
            let value = scaled.value(x);
            if value == 0.0 {
                return x;
            }
            if (value > 0.0) == (high > 0.0) {
                (to, high) = (x, value);
                low *= if side == 1 { 0.5 } else { 1.0 };
                side = 1;
            } else {
                (from, low) = (x, value);
                high *= if side == -1 { 0.5 } else { 1.0 };
                side = -1;
            }
        }
        x
    }
}

/// A cell of a beam.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// The first of its coordinates in the system.
    first: usize,
    /// Index of its block of control rows.
    block: usize,
    /// Arc length at its start \[m\].
    start: f64,
    /// Its length \[m\].
    length: f64,
}

/// The cells of a beam as polynomials, with the rows by which coordinates yield control points.
#[derive(Clone, Debug)]
pub struct Cells {
    cells: Vec<Cell>,
    width: usize,
    degree: usize,
    rows: Vec<f64>,
    /// Weights of the Bernstein polynomials of twice the degree in the products of two of this
    /// degree: B_i B_j = C(n, i) C(n, j)/C(2n, i + j) B_{i + j}.
    products: Vec<f64>,
}

impl Cells {
    /// `offset` is the beam's first coefficient in the system.
    ///
    /// # Errors
    /// Where the shape functions cannot be tabulated.
    pub fn new(basis: &Basis, offset: usize) -> Result<Self, BasisError> {
        let width = basis.width();
        let probe = basis.table(Quadrature::Gauss(8), &[0])?;
        let (places, _) = Quadrature::Gauss(8).rule()?;
        let mut last = None;
        for degree in DEGREES {
            let rule = Quadrature::Lobatto(degree + 1);
            let (xi, _) = rule.rule()?;
            let table = basis.table(rule, &[0])?;
            let mut values = DMatrix::zeros(degree + 1, degree + 1);
            let mut row = [0.0; MOST];
            for (i, xi) in xi.iter().enumerate() {
                bernstein(degree, *xi, &mut row);
                (0..=degree).for_each(|j| values[(i, j)] = row[j]);
            }
            let inverse = values.lu();
            let mut rows = Vec::with_capacity(table.rows.len());
            for samples in table.rows.chunks_exact(((degree + 1) * width).max(1)) {
                let samples = DMatrix::from_row_slice(degree + 1, width, samples);
                let control = inverse.solve(&samples).unwrap_or(samples);
                rows.extend(control.transpose().iter());
            }
            let mut start = 0.0;
            let cells = table.cells.iter().map(|cell| {
                let (weights, _) = table.block(*cell);
                let first = 2 * (offset + cell.first as usize);
                let length = weights.iter().sum();
                let cell = Cell { first, block: cell.block as usize, start, length };
                start += length;
                cell
            });
            let product = |k: usize| {
                let (i, j) = (k / (degree + 1), k % (degree + 1));
                binomial(degree, i) * binomial(degree, j) / binomial(2 * degree, i + j)
            };
            let products = (0..(degree + 1) * (degree + 1)).map(product).collect();
            let cells = Self { cells: cells.collect(), width, degree, rows, products };
            // Measures the error of the interpolation at other points.
            let mut missed = 0.0_f64;
            let mut found = vec![0.0; width];
            for (number, entry) in probe.cells.iter().enumerate() {
                let (_, exact) = probe.block(*entry);
                for (xi, exact) in places.iter().zip(exact.chunks_exact(width)) {
                    bernstein(degree, *xi, &mut row);
                    cells.row(number, &row, &mut found);
                    let length = cells.length(number);
                    let units = [1.0, length].into_iter().cycle();
                    let apart = found.iter().zip(exact).zip(units).map(|((a, b), unit)| (a - b).abs() / unit);
                    missed = apart.fold(missed, f64::max);
                }
            }
            last = Some(cells);
            if missed <= EXACT {
                break;
            }
        }
        last.ok_or(BasisError::Order { order: 0 })
    }

    /// Keeps the cells whose middles lie between two arc lengths \[m\].
    pub fn keep_between(&mut self, [from, to]: [f64; 2]) {
        self.cells.retain(|cell| (from..=to).contains(&(cell.start + 0.5 * cell.length)));
    }

    /// Number of cells.
    pub fn count(&self) -> usize {
        self.cells.len()
    }

    /// Degree of the polynomials.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Number of coefficients that a row multiplies.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Length of a cell \[m\].
    pub fn length(&self, cell: usize) -> f64 {
        self.cells[cell].length
    }

    /// Arc length at ξ of a cell \[m\].
    pub fn arc_length(&self, cell: usize, xi: f64) -> f64 {
        let Cell { start, length, .. } = self.cells[cell];
        start + xi * length
    }

    /// The indices of the coordinates of a cell.
    pub fn coordinates(&self, cell: usize) -> std::ops::Range<usize> {
        let first = self.cells[cell].first;
        first..first + 2 * self.width
    }

    /// The rows of a cell that yield its control points, one row per control point.
    pub fn control(&self, cell: usize) -> impl Iterator<Item = &[f64]> {
        self.block(cell).chunks_exact(self.width)
    }

    /// All rows of a cell.
    fn block(&self, cell: usize) -> &[f64] {
        let size = (self.degree + 1) * self.width;
        let start = self.cells[cell].block * size;
        &self.rows[start..start + size]
    }

    /// The curve of a cell in the state `q`.
    pub fn curve(&self, cell: usize, q: &[f64]) -> Curve {
        let (control, q) = (self.block(cell), &q[self.coordinates(cell)]);
        match self.width {
            4 => Curve::of_rows::<4>(control, 4, q),
            width => Curve::of_rows::<0>(control, width, q),
        }
    }

    /// Writes the row of shape functions at the point where the Bernstein polynomials are `values`.
    pub fn row(&self, cell: usize, values: &[f64], row: &mut [f64]) {
        row.fill(0.0);
        for (control, value) in self.control(cell).zip(values) {
            row.iter_mut().zip(control).for_each(|(row, n)| *row += value * n);
        }
    }

    /// Memory held on the heap \[bytes\].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.cells[..]) + size_of_val(&self.rows[..]) + size_of_val(&self.products[..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::{Discretization, Nodes};

    /// A basis has the degree that its shape functions need, however long its beam is; rows of gradients
    /// have the unit of a length.
    #[test]
    fn the_degree_of_the_cells_does_not_depend_on_the_unit_of_length() {
        for length in [1e-9, 1.0, 1e9] {
            let cable = Discretization::Ancf { nodes: Nodes::Uniform(3) };
            let cells = Basis::new(&cable, length).and_then(|basis| Cells::new(&basis, 0)).expect("cells");
            assert_eq!((cells.degree(), cells.count()), (3, 2), "{length}");
        }
    }
}
