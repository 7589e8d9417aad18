//! The conditions that define the shape functions of one support, and an estimate of the error of
//! their solution.
//!
//! Relative perturbations of size u in φ and G change the solution y, to first order, by at most
//! u |G⁻ᵀ| (|φ| + |Gᵀ| |y|), taken entry by entry (Bauer and Skeel; Higham, *Accuracy and Stability
//! of Numerical Algorithms*, 2nd ed., SIAM 2002, §7.2). With the residual of each solution added,
//! this bound covers the evaluation of the kernel as well as the factorisation. It would not be
//! enough to check the rows against the same factors: they pass that check even if G is wrong.

use super::SideCondition;

use super::arithmetic::Arithmetic;
use super::interpolation::{Interpolation, Place, Quality, Wanted};
use super::kernel::Radial;
use super::lu::Lu;

/// Points ξ ∈ [0, 1] of a cell at which the error is estimated.
const SAMPLES: [f64; 4] = [0.0, 0.3, 0.7, 1.0];

/// Allowance for several round-offs in one entry of G or φ, and for growth in the factorisation.
const SAFETY: f64 = 16.0;

/// The error of a shape function is taken relative to its largest value in the cell, but to at
/// least this fraction of the largest among all functions of its kind (value or slope).
const NEGLIGIBLE: f64 = 1e-3;

/// The defining conditions of the shape functions of one support, at one precision.
pub struct System<'a, A: Arithmetic> {
    arithmetic: &'a A,
    interpolation: &'a Interpolation,
    place: Place<'a>,
    radial: Radial<'a, A>,
    /// Nodes in the scaled coordinate, the cell's left end at 0.
    x: Vec<A::Number>,
    /// The middle of the cell, where the polynomials are centred.
    middle: A::Number,
    zero: A::Number,
}

impl<'a, A: Arithmetic> System<'a, A> {
    /// The conditions of the support at `place`.
    pub fn new(arithmetic: &'a A, interpolation: &'a Interpolation, place: Place<'a>) -> Self {
        let n = |x| arithmetic.number(x);
        let scale = arithmetic.div(&n(interpolation.spacings as f64), &n(interpolation.length));
        let left = n(place.nodes[place.left]);
        let x: Vec<_> =
            place.nodes.iter().map(|&s| arithmetic.mul(&arithmetic.sub(&n(s), &left), &scale)).collect();
        let middle = arithmetic.mul(&x[place.left + 1], &n(0.5));
        let radial = Radial::new(arithmetic, interpolation.kernel);
        Self { arithmetic, interpolation, place, radial, x, middle, zero: n(0.0) }
    }

    /// Number of conditions, 2k + m.
    pub fn size(&self) -> usize {
        2 * self.x.len() + self.interpolation.terms
    }

    /// Average node spacing d_c \[m\].
    fn spacing(&self) -> f64 {
        self.interpolation.length / self.interpolation.spacings as f64
    }

    /// Derivative of order `order` of 1, X, X², … at the distance `x` from the cell's left end,
    /// with X measured from the middle of the cell.
    fn polynomials(&self, x: &A::Number, order: usize) -> Vec<A::Number> {
        let a = self.arithmetic;
        let x = a.sub(x, &self.middle);
        let mut power = a.number(1.0);
        (0..self.interpolation.terms)
            .map(|j| {
                if j < order {
                    return self.zero.clone();
                }
                // d^k X^j / dX^k = j (j − 1) … (j − k + 1) X^(j−k).
                let factor: f64 = (0..order).map(|i| (j - i) as f64).product();
                let term = a.mul(&a.number(factor), &power);
                power = a.mul(&power, &x);
                term
            })
            .collect()
    }

    /// Gᵀ, row by row: row j belongs to the function φ_j and column l to the condition l. The first
    /// 2k rows and columns alternate between values and slopes of the nodes.
    pub fn transposed_moments(&self) -> Vec<A::Number> {
        let a = self.arithmetic;
        let (k, n) = (self.x.len(), self.size());
        let mut g = vec![self.zero.clone(); n * n];
        let minus = |x: &A::Number| a.sub(&self.zero, x);
        for i in 0..k {
            for l in i..k {
                // Even derivatives are even functions of the distance; the first is odd.
                let [r, r1, r2, _] = self.radial.derivatives(&a.sub(&self.x[l], &self.x[i]));
                let (fi, fl) = (2 * i, 2 * l);
                g[fl * n + fi] = r.clone();
                g[(fl + 1) * n + fi] = minus(&r1);
                g[fl * n + fi + 1] = minus(&r1);
                g[(fl + 1) * n + fi + 1] = r2.clone();
                g[fi * n + fl] = r;
                g[(fi + 1) * n + fl] = r1.clone();
                g[fi * n + fl + 1] = r1;
                g[(fi + 1) * n + fl + 1] = r2;
            }
            let values = self.polynomials(&self.x[i], 0);
            let slopes = self.polynomials(&self.x[i], 1);
            for (j, (value, slope)) in values.into_iter().zip(slopes).enumerate() {
                let j = 2 * k + j;
                let side = match self.interpolation.side_condition {
                    SideCondition::Plus => slope.clone(),
                    SideCondition::Minus => minus(&slope),
                };
                g[2 * i * n + j] = value.clone();
                g[(2 * i + 1) * n + j] = side;
                g[j * n + 2 * i] = value;
                g[j * n + 2 * i + 1] = slope;
            }
        }
        g
    }

    /// The scaled coordinate of the point ξ, and there the radial function of each node with its
    /// derivatives.
    fn radials(&self, xi: f64) -> (A::Number, Vec<[A::Number; 4]>) {
        let a = self.arithmetic;
        let x = a.mul(&a.number(xi), &self.x[self.place.left + 1]);
        let radials = self.x.iter().map(|node| self.radial.derivatives(&a.sub(&x, node))).collect();
        (x, radials)
    }

    /// φ, differentiated `order` times.
    fn functions(&self, at: &(A::Number, Vec<[A::Number; 4]>), order: usize) -> Vec<A::Number> {
        let mut phi = Vec::with_capacity(self.size());
        for r in &at.1 {
            phi.extend([r[order].clone(), r[order + 1].clone()]);
        }
        phi.extend(self.polynomials(&at.0, order));
        phi
    }

    /// Rounds the solution y of Gᵀ y = φ to a row of doubles, with s in metres instead of X.
    fn round(&self, y: &[A::Number], order: usize, row: &mut [f64]) {
        let spacing = self.spacing();
        let value = spacing.powi(-(order as i32));
        let slope = spacing.powi(1 - order as i32);
        for (j, (row, y)) in row.iter_mut().zip(y).enumerate() {
            *row = self.arithmetic.nearest(y) * if j % 2 == 0 { value } else { slope };
        }
    }

    /// Fills a row for each wanted order.
    pub fn rows(&self, lu: &Lu<A::Number>, wanted: Wanted<'_>, rows: &mut [f64]) {
        let at = self.radials(wanted.xi);
        for (&order, row) in wanted.orders.iter().zip(rows.chunks_mut(wanted.stride.max(1))) {
            let y = lu.solve(self.arithmetic, &self.functions(&at, order));
            let width = (2 * self.x.len()).min(row.len());
            self.round(&y, order, &mut row[..width]);
        }
    }

    /// Estimates errors and measures defects at a few points of the cell; `None` if any number is
    /// not finite.
    pub fn quality(&self, lu: &Lu<A::Number>, matrix: &[A::Number], moments: &[f64]) -> Option<Quality> {
        let a = self.arithmetic;
        let (n, width) = (self.size(), 2 * self.x.len());
        let (inverse, shift) = self.inverse_magnitudes(lu)?;
        let log2_unit = a.log2_round_off() + SAFETY.log2() + shift as f64;
        let mut quality = Quality { bits: a.bits(), ..Quality::default() };
        let mut bounds = [vec![0.0f64; width], vec![0.0; width], vec![0.0; width]];
        let mut largest = bounds.clone();
        let mut row = vec![0.0; width];
        for xi in SAMPLES {
            let at = self.radials(xi);
            for order in 0..3 {
                let phi = self.functions(&at, order);
                let y = lu.solve(a, &phi);
                let size: Vec<f64> = y.iter().map(|y| a.scaled_magnitude(y, 0)).collect();
                let perturbation = self.perturbation(matrix, moments, &phi, &y, &size);
                for l in 0..width {
                    let entries = inverse[l * n..(l + 1) * n].iter();
                    let bound: f64 = entries.zip(&perturbation).map(|(g, p)| g * p).sum();
                    bounds[order][l] = bounds[order][l].max(bound);
                    largest[order][l] = largest[order][l].max(size[l]);
                    if !(bound.is_finite() && size[l].is_finite()) {
                        return None;
                    }
                }
                self.round(&y, order, &mut row);
                quality.reproduction = quality.reproduction.max(self.reproduction(&row, xi, order));
                if order < 2 && (xi == 0.0 || xi == 1.0) {
                    quality.kronecker = quality.kronecker.max(self.kronecker(&row, xi, order));
                }
            }
        }
        let mut log2_error = f64::NEG_INFINITY;
        for (bounds, largest) in bounds.iter().zip(&largest) {
            for kind in 0..2 {
                let of_kind = || largest.iter().skip(kind).step_by(2);
                let floor = NEGLIGIBLE * of_kind().copied().fold(f64::MIN_POSITIVE, f64::max);
                for (bound, largest) in bounds.iter().skip(kind).step_by(2).zip(of_kind()) {
                    log2_error = log2_error.max(log2_unit + bound.log2() - largest.max(floor).log2());
                }
            }
        }
        let norm = moments.chunks_exact(n).map(|row| row.iter().sum::<f64>()).fold(0.0, f64::max);
        let inverse_norm = inverse.chunks_exact(n).map(|row| row.iter().sum::<f64>()).fold(0.0, f64::max);
        quality.error = log2_error.exp2();
        quality.log2_condition = norm.log2() + inverse_norm.log2() + shift as f64;
        Some(quality)
    }

    /// |φ| + |Gᵀ| |y| + |φ − Gᵀ y| / u: the last term is the residual in units of u, the
    /// round-off times the safety factor.
    fn perturbation(
        &self,
        matrix: &[A::Number],
        moments: &[f64],
        phi: &[A::Number],
        y: &[A::Number],
        size: &[f64],
    ) -> Vec<f64> {
        let a = self.arithmetic;
        let unit = (a.log2_round_off() + SAFETY.log2()) as i64;
        let rows = matrix.chunks_exact(y.len()).zip(moments.chunks_exact(y.len()));
        rows.zip(phi)
            .map(|((row, magnitudes), phi)| {
                let terms: f64 = magnitudes.iter().zip(size).map(|(g, y)| g * y).sum();
                let residual = row.iter().zip(y).fold(phi.clone(), |rest, (g, y)| a.sub(&rest, &a.mul(g, y)));
                a.scaled_magnitude(phi, 0) + terms + a.scaled_magnitude(&residual, unit)
            })
            .collect()
    }

    /// |G⁻ᵀ| · 2^−shift, row by row, with a shift that keeps the largest entry near one.
    fn inverse_magnitudes(&self, lu: &Lu<A::Number>) -> Option<(Vec<f64>, i64)> {
        let a = self.arithmetic;
        let n = self.size();
        let mut columns = Vec::with_capacity(n);
        let mut unit = vec![self.zero.clone(); n];
        for j in 0..n {
            unit[j] = a.number(1.0);
            columns.push(lu.solve(a, &unit));
            unit[j] = self.zero.clone();
        }
        if !columns.iter().flatten().all(|x| a.is_finite(x)) {
            return None;
        }
        let shift = columns.iter().flatten().filter_map(|x| a.exponent(x)).max()?;
        let mut inverse = vec![0.0; n * n];
        for (j, column) in columns.iter().enumerate() {
            for (i, x) in column.iter().enumerate() {
                inverse[i * n + j] = a.scaled_magnitude(x, shift);
            }
        }
        Some((inverse, shift))
    }

    /// Defect of the rounded row in reproducing 1 and, with at least two polynomial terms,
    /// s − s_left. Each defect is relative to the sum of the absolute terms plus the natural size
    /// in a cell of length h, h^−order or h^(1−order), since at a node all terms may vanish but for
    /// round-off.
    fn reproduction(&self, row: &[f64], xi: f64, order: usize) -> f64 {
        let nodes = self.place.nodes;
        let left = nodes[self.place.left];
        let h = nodes[self.place.left + 1] - left;
        let natural = h.powi(-(order as i32));
        let (constant, linear) = match order {
            0 => (1.0, xi * h),
            1 => (0.0, 1.0),
            _ => (0.0, 0.0),
        };
        let (mut one, mut one_size) = (-constant, natural);
        let (mut s, mut s_size) = (-linear, h * natural);
        for (pair, node) in row.chunks_exact(2).zip(nodes) {
            let (value, slope) = (pair[0], pair[1]);
            one += value;
            one_size += value.abs();
            let moment = value * (node - left);
            s += moment + slope;
            s_size += moment.abs() + slope.abs();
        }
        let defect = (one / one_size).abs();
        if self.interpolation.terms > 1 { defect.max((s / s_size).abs()) } else { defect }
    }

    /// Largest difference of `row` from the unit row at an end of the cell, made dimensionless with
    /// the cell's length h: derivatives of order 1 are multiplied by h, and entries for slopes
    /// divided by h.
    fn kronecker(&self, row: &[f64], xi: f64, order: usize) -> f64 {
        let h = self.place.nodes[self.place.left + 1] - self.place.nodes[self.place.left];
        let node = self.place.left + usize::from(xi == 1.0);
        let own = 2 * node + order;
        let mut defect = 0.0f64;
        for (j, &entry) in row.iter().enumerate() {
            let exact = if j == own { 1.0 } else { 0.0 };
            let scale = h.powi(order as i32 - (j % 2) as i32);
            defect = defect.max(((entry - exact) * scale).abs());
        }
        defect
    }
}

#[cfg(test)]
mod tests {
    use super::super::Kernel;
    use super::super::double_double::DoubleDouble;
    use super::*;
    use nalgebra::DMatrix;

    fn interpolation(terms: usize) -> Interpolation {
        Interpolation {
            kernel: Kernel::Multiquadric { q: 1.03, shape: 1.5 },
            terms,
            side_condition: SideCondition::Plus,
            length: 3.0,
            spacings: 2,
        }
    }

    /// Rows that miss 1 and s − s_left by what is worked out by hand.
    #[test]
    fn defects_of_a_row_are_relative_to_its_terms() {
        let (one, both) = (interpolation(1), interpolation(2));
        let place = Place { nodes: &[0.0, 1.0, 3.0], left: 1 };
        let [of_one, of_both] = [&one, &both].map(|of| System::new(&DoubleDouble, of, place));
        // Values add up to 1¼, as do their sizes, beside 1; moments and slopes to −¼ + ¼ + 2 − 1, which is
        // half of the cell.
        let row = [0.25, 0.0, 0.0, 0.25, 1.0, -1.0];
        for of in [&of_one, &of_both] {
            assert!((of.reproduction(&row, 0.5, 0) - 0.25 / 2.25).abs() < 1e-15);
        }
        let tilted = [0.0, 2.0, 0.0, 0.0, 1.0, 0.0];
        // 2 + 2 instead of 1, of terms 4 beside 2.
        assert!((of_both.reproduction(&tilted, 0.5, 0) - 3.0 / 6.0).abs() < 1e-15);
        assert_eq!(of_one.reproduction(&tilted, 0.5, 0), 0.0);
        // First derivatives add up to nothing, and those of s to one; sizes beside 1/h = ½ and 1.
        let slopes = [0.0, 0.0, 0.5, 0.0, 0.0, 1.0];
        assert!((of_one.reproduction(&slopes, 0.5, 1) - 0.5 / 1.0).abs() < 1e-15);
        let twice = [-0.5, 0.0, 0.0, 0.0, 0.5, 0.5];
        // −½·(−1) + ½·2 + ½ instead of 1, of terms 2 beside 1.
        assert!((of_both.reproduction(&twice, 0.5, 1) - 1.0 / 3.0).abs() < 1e-15);
        // Second derivatives of both are zero; sizes beside ¼ and ½.
        let second = [0.0, 0.0, 0.25, 0.0, 0.0, 0.0];
        assert!((of_one.reproduction(&second, 0.5, 2) - 0.25 / 0.5).abs() < 1e-15);
        let second = [0.0, 0.25, 0.0, 0.0, 0.0, 0.0];
        assert!((of_both.reproduction(&second, 0.5, 2) - 0.25 / 0.75).abs() < 1e-15);
    }

    /// In a cell of 2 m slopes count half, and derivatives twice.
    #[test]
    fn defects_at_the_ends_of_a_cell_have_no_dimension() {
        let both = interpolation(2);
        let system = System::new(&DoubleDouble, &both, Place { nodes: &[0.0, 1.0, 3.0], left: 1 });
        let unit = |own: usize, other: usize, by: f64| {
            let mut row = [0.0; 6];
            row[own] = 1.0;
            row[other] += by;
            row
        };
        for (xi, order, own) in [(0.0, 0, 2), (1.0, 0, 4), (0.0, 1, 3), (1.0, 1, 5)] {
            for other in 0..6 {
                let found = system.kronecker(&unit(own, other, -0.125), xi, order);
                let expected = 0.125 * 2.0_f64.powi(order as i32) * if other % 2 == 0 { 1.0 } else { 0.5 };
                assert_eq!(found, expected, "{xi} {order} {other}");
            }
        }
    }

    /// By the inverse that nalgebra finds, in doubles.
    #[test]
    fn conditions_are_those_of_the_matrix() {
        for (terms, side_condition) in [(1, SideCondition::Plus), (3, SideCondition::Minus)] {
            let of = Interpolation { side_condition, ..interpolation(terms) };
            let system = System::new(&DoubleDouble, &of, Place { nodes: &[0.0, 1.0, 3.0], left: 1 });
            let n = system.size();
            assert_eq!(n, 6 + terms);
            let entries = system.transposed_moments();
            let matrix = DMatrix::from_fn(n, n, |i, j| DoubleDouble.nearest(&entries[i * n + j]));
            let norm = |matrix: &DMatrix<f64>| {
                matrix.row_iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max)
            };
            let inverse = matrix.clone().try_inverse().expect("a regular matrix");
            let expected = norm(&matrix).log2() + norm(&inverse).log2();
            let magnitudes: Vec<f64> = entries.iter().map(|x| DoubleDouble.scaled_magnitude(x, 0)).collect();
            let lu = Lu::new(&DoubleDouble, n, entries.clone()).expect("a regular matrix");
            let quality = system.quality(&lu, &entries, &magnitudes).expect("finite numbers");
            assert!((quality.log2_condition - expected).abs() < 1e-6, "{quality:?} {expected}");
            // 106 bits less those that the condition takes, with what is allowed beyond.
            assert!(quality.error.log2() < expected - 100.0 + SAFETY.log2(), "{quality:?}");
            assert!(quality.kronecker < 1e-15 && quality.reproduction < 1e-15, "{quality:?}");
        }
    }
}
