//! Hermite radial point interpolation: shape functions of one cell from the nodes of its support.
//!
//! In the scaled coordinate X = (s − s̄)/d_c, with s̄ the middle of the cell and d_c the average
//! spacing of the whole beam's nodes, the interpolation is
//!
//! u(X) = Σ_i [R(X−X_i) a_i + R'(X−X_i) b_i] + Σ_{j<m} c_j Xʲ
//!
//! It interpolates values and slopes at the k nodes of the support, under the side conditions
//! Σ_i [X_iʲ a_i ± (Xʲ)'_i b_i] = 0. With G the matrix of these 2k + m conditions and φ(X) the
//! functions above, the row of shape functions is the solution y of Gᵀ y = φ(X); its derivatives
//! solve the same equation with φ differentiated.
//!
//! G is close to singular wherever the interpolation is good: its condition number grows about like
//! α^(4k−2), with α in units of the smallest spacing. Therefore G is formed, factorised and solved
//! in extended precision. The precision is raised until the error of the rows is negligible in
//! double precision, and only then are the rows rounded.

use std::ops::Range;

use super::interpolation::{Amount, Interpolation, Place, Quality, Wanted};

use super::arithmetic::Arithmetic;
use super::double_double::{Double, DoubleDouble};
use super::lu::Lu;
use super::moments::System;
use super::multiprecision::Multiprecision;
use astro_float_num::BigFloat;

/// Largest estimated relative error of a row before its rounding to double precision.
pub const TOLERANCE: f64 = 1e-13;

/// Most bits tried before the shape functions of a cell are refused as unsolvable.
pub const MOST_BITS: usize = 16_384;

/// Largest [`Interpolant::amplification`] of a cell: with more of it the tangent of stiff beams loses its sign, and the constraints of
/// those that keep their length their independence, to round-off.
pub const MOST_AMPLIFICATION: f64 = 1e4;

/// The factors of Gᵀ at the precision that the cell needs.
#[derive(Clone, Debug)]
enum Factors {
    Double(Lu<Double>),
    Multiprecision(Lu<BigFloat>),
}

/// The shape functions of a cell, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct Interpolant {
    factors: Factors,
    /// How accurate they are.
    pub quality: Quality,
}

/// The precisions used so far, kept so that the constants of each are computed only once.
#[derive(Default)]
pub struct Precisions {
    known: Vec<Multiprecision>,
    /// Number of bits that would have sufficed for the last cell.
    hint: f64,
}

impl Precisions {
    fn get(&mut self, bits: usize) -> Option<&Multiprecision> {
        let found = match self.known.iter().position(|m| m.bits() == bits) {
            Some(found) => found,
            None => {
                self.known.push(Multiprecision::new(bits)?);
                self.known.len() - 1
            }
        };
        self.known.get(found)
    }
}

impl Interpolant {
    /// Solves a cell at the lowest precision tried that suffices.
    ///
    /// # Errors
    /// The quality of the last attempt, if no precision suffices.
    pub fn solve(
        interpolation: &Interpolation,
        place: Place<'_>,
        precisions: &mut Precisions,
    ) -> Result<Self, Quality> {
        let mut last = Quality::default();
        // The number of bits that the last cell needed is known, and its neighbour needs about as
        // many, so the attempts start there.
        let mut bits = if precisions.hint <= DoubleDouble.bits() as f64 {
            DoubleDouble.bits()
        } else {
            (precisions.hint as usize + 8).next_multiple_of(64)
        };
        while bits <= MOST_BITS {
            let attempt = if bits == DoubleDouble.bits() {
                attempt(interpolation, place, &DoubleDouble)
                    .map(|(lu, quality)| (Factors::Double(lu), quality))
            } else {
                match precisions.get(bits) {
                    Some(arithmetic) => attempt(interpolation, place, arithmetic)
                        .map(|(lu, quality)| (Factors::Multiprecision(lu), quality)),
                    None => return Err(last),
                }
            };
            last = Quality { bits, error: f64::INFINITY, log2_condition: f64::INFINITY, ..last };
            let mut wanted = 2 * bits;
            if let Some((factors, quality)) = attempt {
                last = quality;
                let short = (quality.error / TOLERANCE).log2();
                if quality.error <= TOLERANCE
                    && quality.kronecker <= TOLERANCE
                    && quality.reproduction <= TOLERANCE
                {
                    precisions.hint = bits as f64 + short.max(-0.9 * bits as f64);
                    return Ok(Self { factors, quality });
                }
                // An error estimate far below one has the right order of magnitude, and tells how
                // many bits are missing.
                if quality.error < 1e-3 && short > 0.0 {
                    wanted = bits + short as usize + 8;
                }
            }
            bits = wanted.max(bits + 1).next_multiple_of(64);
        }
        Err(last)
    }

    /// Fills `2 * place.nodes.len()` numbers for each wanted order.
    pub fn rows(
        &self,
        interpolation: &Interpolation,
        place: Place<'_>,
        precisions: &mut Precisions,
        wanted: Wanted<'_>,
        rows: &mut [f64],
    ) {
        match &self.factors {
            Factors::Double(lu) => {
                System::new(&DoubleDouble, interpolation, place).rows(lu, wanted, rows);
            }
            Factors::Multiprecision(lu) => {
                if let Some(arithmetic) = precisions.get(self.quality.bits) {
                    System::new(arithmetic, interpolation, place).rows(lu, wanted, rows);
                }
            }
        }
    }

    /// Largest second derivative within the cell that a node displaced by one makes, times the square of the cell's length.
    ///
    /// Of a cubic it is 6. Two nodes of the support that are closer than the cell is long make it grow about like the third power of the
    /// ratio, since the third derivative at the two is then a coefficient, too.
    pub fn amplification(
        &self,
        interpolation: &Interpolation,
        place: Place<'_>,
        precisions: &mut Precisions,
    ) -> f64 {
        let width = 2 * place.nodes.len();
        let length = place.nodes[place.left + 1] - place.nodes[place.left];
        let mut row = vec![0.0; width];
        let largest = |xi: f64| {
            let wanted = Wanted { xi, orders: &[2], stride: width, amount: Amount::Few };
            self.rows(interpolation, place, precisions, wanted, &mut row);
            row.iter().step_by(2).fold(0.0f64, |largest, of| largest.max(of.abs()))
        };
        [0.25, 0.75].map(largest).into_iter().fold(0.0, f64::max) * length * length
    }
}

fn attempt<A: Arithmetic>(
    interpolation: &Interpolation,
    place: Place<'_>,
    arithmetic: &A,
) -> Option<(Lu<A::Number>, Quality)> {
    let system = System::new(arithmetic, interpolation, place);
    let matrix = system.transposed_moments();
    let magnitudes: Vec<f64> = matrix.iter().map(|x| arithmetic.scaled_magnitude(x, 0)).collect();
    let lu = Lu::new(arithmetic, system.size(), matrix.clone())?;
    let quality = system.quality(&lu, &matrix, &magnitudes)?;
    Some((lu, quality))
}

/// The cell as a place in its support, which is the range `support` of the beam's nodes.
pub fn place(nodes: &[f64], support: Range<usize>, cell: usize) -> Place<'_> {
    Place { left: cell - support.start, nodes: &nodes[support] }
}

#[cfg(test)]
mod tests {
    use super::super::interpolation::Amount;
    use super::super::{Kernel, SideCondition};
    use super::*;
    use proptest::prelude::*;

    /// Rows of orders 0 to 2 at a few points of a cell, from at least `bits` bits.
    fn rows(interpolation: &Interpolation, place: Place<'_>, bits: f64) -> (Quality, Vec<f64>) {
        let mut precisions = Precisions { hint: bits, ..Precisions::default() };
        let shape = Interpolant::solve(interpolation, place, &mut precisions).unwrap();
        let width = 2 * place.nodes.len();
        let mut rows = Vec::new();
        for xi in [0.11, 0.5, 0.93] {
            let mut point = vec![0.0; 3 * width];
            let wanted = Wanted { xi, orders: &[0, 1, 2], stride: width, amount: Amount::Few };
            shape.rows(interpolation, place, &mut precisions, wanted, &mut point);
            rows.extend(point);
        }
        (shape.quality, rows)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

        /// The estimated errors are compared with true ones, found with many more digits, entry by
        /// entry.
        #[test]
        fn estimated_errors_bound_the_true_ones(
            spacings in prop::collection::vec((-0.5..0.5f64).prop_map(|log| 10f64.powf(log)), 1..7),
            q in prop::sample::select(vec![0.5, 0.98, 1.03, 1.98, 2.03]), shape in 0.5..12.0f64, plus in any::<bool>(),
        ) {
            let nodes: Vec<f64> = std::iter::once(0.0)
                .chain(spacings.iter().scan(0.0, |s, h| { *s += h; Some(*s) }))
                .collect();
            let interpolation = Interpolation {
                kernel: Kernel::Multiquadric { q, shape },
                terms: 2,
                side_condition: if plus { SideCondition::Plus } else { SideCondition::Minus },
                length: nodes[nodes.len() - 1],
                spacings: spacings.len(),
            };
            let place = Place { nodes: &nodes, left: spacings.len() / 2 };
            let (quality, found) = rows(&interpolation, place, 0.0);
            let (_, exact) = rows(&interpolation, place, 700.0);
            let width = 2 * nodes.len();
            for order in 0..3 {
                for kind in 0..2 {
                    let of_kind = |rows: &[f64]| -> Vec<f64> {
                        let points = rows.chunks_exact(width).skip(order).step_by(3);
                        points.flat_map(|row| row.iter().skip(kind).step_by(2).copied().collect::<Vec<_>>()).collect()
                    };
                    let (found, exact) = (of_kind(&found), of_kind(&exact));
                    let largest = exact.iter().fold(0.0f64, |a, b| a.max(b.abs()));
                    for (found, exact) in found.iter().zip(&exact) {
                        let allowed = (quality.error + 4.0 * f64::EPSILON) * largest;
                        prop_assert!((found - exact).abs() <= allowed, "{found:e} for {exact:e}, {quality:?}");
                    }
                }
            }
        }
    }
}
