//! Sums over the cells of a beam that keeps its length: the forces of its axial force N, the rows
//! of its constraint, and the matrix ∫ N N'ᵀN' ds ⊗ I.
//!
//! Four equal cells, each one node after the cell before, are computed side by side in the lanes of
//! a register, like other densities ([`crate::assembly`]); or one cell in four states.

use super::inextensible::POINTS;
use crate::basis::BasisTable;
use crate::lanes::{self, Lanes, Pair};
use crate::linear::Matrix;

/// No row.
const NONE: u32 = u32::MAX;

/// The functions φ of the left node, of the cell and of the right node at the points of a cell.
type Functions = [[f64; 3]; POINTS];

/// The lengths that one beam keeps.
#[derive(Debug)]
pub(super) struct Lengths {
    /// First coefficient of the beam.
    offset: usize,
    /// r' at the points of all cells.
    table: BasisTable,
    /// Per cell: the rows of its left node, of itself and of its right node, counted among all
    /// constraints; a cell whose axial force is linear has no row of its own.
    rows: Vec<[u32; 3]>,
    /// In the order of the cells: the first cell of a group, and its number of cells: four that
    /// have all rows, or one.
    groups: Vec<(u32, u32)>,
    /// The rows of all cells.
    numbers: std::ops::Range<usize>,
    /// φ of cells that have all rows, and of those whose axial force is linear.
    functions: [Functions; 2],
}

/// Calls `method::<WIDTH>(arguments…)` with the table's width as a compile-time constant.
macro_rules! with_width {
    ($self:ident . $method:ident ( $($argument:expr),* )) => {
        match $self.table.width {
            4 => $self.$method::<4>($($argument),*),
            8 => $self.$method::<8>($($argument),*),
            _ => $self.$method::<12>($($argument),*),
        }
    };
}

/// What a group of cells adds: forces on their coefficients, and to their rows.
type Sums<const W: usize> = ([Pair<Lanes>; W], [Lanes; 3]);

impl Lengths {
    /// The cells of `table`, if its width is a common one. `rows` are as in [`Self::rows`],
    /// `functions` those of a cell at a point for a quadratic and for a linear axial force.
    pub fn new(
        offset: usize,
        table: BasisTable,
        rows: Vec<[Option<usize>; 3]>,
        functions: [Functions; 2],
    ) -> Option<Self> {
        if !matches!(table.width, 4 | 8 | 12) {
            return None;
        }
        let of_all = || rows.iter().flatten().filter_map(|row| *row);
        let numbers = of_all().min()?..of_all().max()? + 1;
        let rows: Vec<[u32; 3]> =
            rows.iter().map(|rows| rows.map(|row| row.map_or(NONE, |row| row as u32))).collect();
        let (fours, mut singles) = table.by_fours();
        let whole = |cell: &u32| rows[*cell as usize..*cell as usize + 4].iter().all(|rows| rows[1] != NONE);
        let (fours, broken): (Vec<u32>, Vec<u32>) = fours.into_iter().partition(whole);
        singles.extend(broken.iter().flat_map(|cell| *cell..cell + 4));
        let fours = fours.into_iter().map(|cell| (cell, 4));
        let mut groups: Vec<(u32, u32)> = fours.chain(singles.into_iter().map(|cell| (cell, 1))).collect();
        groups.sort_unstable();
        Some(Self { offset, table, rows, groups, numbers, functions })
    }

    /// The numbers of its rows among all constraints.
    pub fn numbers(&self) -> std::ops::Range<usize> {
        self.numbers.clone()
    }

    #[inline(always)]
    fn cell<const W: usize>(&self, cell: usize) -> (usize, &[f64; POINTS], &[[f64; W]; POINTS], &Functions) {
        let entry = self.table.cells[cell];
        let (weights, shapes) = self.table.block(entry);
        let first = 2 * (self.offset + entry.first as usize);
        let functions = &self.functions[usize::from(self.rows[cell][1] == NONE)];
        let (weights, shapes) = (weights.first_chunk(), shapes.as_chunks::<W>().0.first_chunk());
        (first, weights.expect(OF_POINTS), shapes.expect(OF_POINTS), functions)
    }

    /// Calls `of` for all cells, four at a time or one in lane 0, with a cell and the number of
    /// lanes in use.
    #[inline(always)]
    fn each(&self, mut of: impl FnMut(usize, usize)) {
        for &(cell, lanes) in &self.groups {
            // With either constant the loops over the lanes are unrolled.
            if lanes == 4 { of(cell as usize, 4) } else { of(cell as usize, 1) }
        }
    }

    /// The numbers of three rows of each of `lanes` cells.
    #[inline(always)]
    fn of_rows(&self, cell: usize, lanes: usize, list: &[f64]) -> [Lanes; 3] {
        let rows = self.rows[cell];
        if lanes == 1 {
            return rows.map(|row| Lanes::splat(list.get(row as usize).copied().unwrap_or(0.0)));
        }
        let first = rows[0] as usize;
        let Some(of) = list.get(first..first + 9) else { return [Lanes::ZERO; 3] };
        std::array::from_fn(|k| Lanes::new([of[k], of[k + 2], of[k + 4], of[k + 6]]))
    }

    /// Adds to the three rows of each of `lanes` cells.
    #[inline(always)]
    fn add_to_rows(&self, cell: usize, lanes: usize, sums: [Lanes; 3], list: &mut [f64]) {
        for (k, sums) in sums.into_iter().enumerate() {
            for (lane, sum) in sums.to_array().into_iter().take(lanes).enumerate() {
                if let Some(target) = list.get_mut(self.rows[cell + lane][k] as usize) {
                    *target += sum;
                }
            }
        }
    }

    /// `f += ∫ N r' N' ds`, where N = `unit` Σ μ φ, and `gaps += unit ∫ φ ½ r'·r' ds`. Returns the
    /// largest forces on the four coordinates of a node from any cell.
    pub fn balance(&self, unit: f64, q: &[f64], mu: &[f64], f: &mut [f64], gaps: &mut [f64]) -> Lanes {
        with_width!(self.balance_within(unit, q, mu, f, gaps))
    }

    fn balance_within<const W: usize>(
        &self,
        unit: f64,
        q: &[f64],
        mu: &[f64],
        f: &mut [f64],
        gaps: &mut [f64],
    ) -> Lanes {
        let mut largest = [Lanes::ZERO; 4];
        self.each(|cell, lanes| {
            let (first, weights, shapes, functions) = self.cell::<W>(cell);
            let here = gather::<W>(lanes, &q[first..]);
            let mu = self.of_rows(cell, lanes, mu);
            let (sums, of_rows) = sums::<W>(unit, weights, shapes, functions, &here, mu);
            for pairs in sums.as_chunks::<2>().0 {
                for (largest, sum) in largest.iter_mut().zip(pairs.as_flattened()) {
                    *largest = sum.abs().fast_max(*largest);
                }
            }
            scatter::<W>(lanes, &sums, &mut f[first..]);
            self.add_to_rows(cell, lanes, of_rows, gaps);
        });
        Lanes::new(largest.map(|lanes| lanes.to_array().into_iter().fold(0.0, f64::max)))
    }

    /// [`Self::balance`] in four states, one per lane; the largest forces are those in any state.
    pub fn balance_in_lanes(
        &self,
        unit: f64,
        q: &[Lanes],
        mu: &[Lanes],
        f: &mut [Lanes],
        gaps: &mut [Lanes],
    ) -> [Lanes; 4] {
        with_width!(self.balance_in_lanes_within(unit, q, mu, f, gaps))
    }

    fn balance_in_lanes_within<const W: usize>(
        &self,
        unit: f64,
        q: &[Lanes],
        mu: &[Lanes],
        f: &mut [Lanes],
        gaps: &mut [Lanes],
    ) -> [Lanes; 4] {
        let mut largest = [Lanes::ZERO; 4];
        for (cell, rows) in self.rows.iter().enumerate() {
            let (first, weights, shapes, functions) = self.cell::<W>(cell);
            let range = first..first + 2 * W;
            let Some(here) = q[range.clone()].as_chunks::<2>().0.first_chunk::<W>() else { continue };
            let mu = rows.map(|row| mu.get(row as usize).copied().unwrap_or(Lanes::ZERO));
            let (sums, of_rows) = sums::<W>(unit, weights, shapes, functions, here, mu);
            for (f, sum) in f[range].as_chunks_mut::<2>().0.iter_mut().zip(&sums) {
                *f = [f[0] + sum[0], f[1] + sum[1]];
            }
            for pairs in sums.as_chunks::<2>().0 {
                for (largest, sum) in largest.iter_mut().zip(pairs.as_flattened()) {
                    *largest = sum.abs().fast_max(*largest);
                }
            }
            for (row, sum) in rows.iter().zip(of_rows) {
                if let Some(gap) = gaps.get_mut(*row as usize) {
                    *gap += sum;
                }
            }
        }
        largest
    }

    /// `rows += factor ∫ φ a'·b' ds`, where a' and b' are the gradients of the coordinates `a` and
    /// `b`.
    pub fn add_products(&self, factor: f64, a: &[f64], b: &[f64], rows: &mut [f64]) {
        with_width!(self.add_products_within(factor, a, b, rows));
    }

    fn add_products_within<const W: usize>(&self, factor: f64, a: &[f64], b: &[f64], rows: &mut [f64]) {
        self.each(|cell, lanes| {
            let (first, weights, shapes, functions) = self.cell::<W>(cell);
            let (a, b) = (gather::<W>(lanes, &a[first..]), gather::<W>(lanes, &b[first..]));
            let mut sums = [Lanes::ZERO; 3];
            for p in 0..POINTS {
                let (a, b) = (field(&shapes[p], &a), field(&shapes[p], &b));
                let product = lanes::dot(a, b) * Lanes::splat(factor * weights[p]);
                for (sum, function) in sums.iter_mut().zip(functions[p]) {
                    *sum = Lanes::splat(function).mul_add(product, *sum);
                }
            }
            self.add_to_rows(cell, lanes, sums, rows);
        });
    }

    /// `f += ∫ N v' N' ds`, where N = `unit` Σ μ φ and v' is the gradient of the coordinates `v`.
    pub fn add_forces(&self, unit: f64, v: &[f64], mu: &[f64], f: &mut [f64]) {
        with_width!(self.add_forces_within(unit, v, mu, f));
    }

    fn add_forces_within<const W: usize>(&self, unit: f64, v: &[f64], mu: &[f64], f: &mut [f64]) {
        self.each(|cell, lanes| {
            let (first, weights, shapes, functions) = self.cell::<W>(cell);
            let here = gather::<W>(lanes, &v[first..]);
            let mu = self.of_rows(cell, lanes, mu);
            let (sums, _) = sums::<W>(unit, weights, shapes, functions, &here, mu);
            scatter::<W>(lanes, &sums, &mut f[first..]);
        });
    }

    /// `k += ∫ N N'ᵀN' ds ⊗ I`, where N = `unit` Σ μ φ.
    pub fn add_stiffness(&self, unit: f64, mu: &[f64], k: &mut Matrix) {
        with_width!(self.add_stiffness_within(unit, mu, k));
    }

    fn add_stiffness_within<const W: usize>(&self, unit: f64, mu: &[f64], k: &mut Matrix) {
        self.each(|cell, lanes| {
            let (first, weights, shapes, functions) = self.cell::<W>(cell);
            let mu = self.of_rows(cell, lanes, mu);
            let mut forces = [Lanes::ZERO; POINTS];
            for p in 0..POINTS {
                forces[p] = axial_force(&functions[p], mu) * Lanes::splat(unit * weights[p]);
            }
            for a in 0..W / 2 {
                for b in a..W / 2 {
                    let mut sums = [Lanes::ZERO; 4];
                    for (force, shape) in forces.iter().zip(shapes) {
                        for (place, sum) in sums.iter_mut().enumerate() {
                            let product = shape[2 * a + place / 2] * shape[2 * b + place % 2];
                            *sum = Lanes::splat(product).mul_add(*force, *sum);
                        }
                    }
                    for (lane, tile) in Lanes::transpose(sums).into_iter().enumerate().take(lanes) {
                        k.add_isotropic(first / 4 + lane + a, first / 4 + lane + b, tile.to_array());
                    }
                }
            }
        });
    }

    /// Calls `of` for every cell with the index of its first coordinate, its three rows, and their
    /// entries `unit` ∫ φ r' N' ds for the coordinates of the cell.
    pub fn entries(&self, unit: f64, q: &[f64], mut of: impl FnMut(usize, [Option<usize>; 3], &[&[f64]; 3])) {
        match self.table.width {
            4 => self.entries_within::<4, 8>(unit, q, &mut of),
            8 => self.entries_within::<8, 16>(unit, q, &mut of),
            _ => self.entries_within::<12, 24>(unit, q, &mut of),
        }
    }

    fn entries_within<const W: usize, const WW: usize>(
        &self,
        unit: f64,
        q: &[f64],
        of: &mut impl FnMut(usize, [Option<usize>; 3], &[&[f64]; 3]),
    ) {
        self.each(|cell, lanes| {
            let (first, weights, shapes, functions) = self.cell::<W>(cell);
            let here = gather::<W>(lanes, &q[first..]);
            let mut fields = [[Lanes::ZERO; 2]; POINTS];
            for p in 0..POINTS {
                let weight = Lanes::splat(unit * weights[p]);
                fields[p] = field(&shapes[p], &here).map(|r| r * weight);
            }
            let mut entries = [[[0.0; WW]; 3]; 4];
            for k in 0..3 {
                for node in 0..W / 2 {
                    let mut sums = [Lanes::ZERO; 4];
                    for p in 0..POINTS {
                        for (place, sum) in sums.iter_mut().enumerate() {
                            let value = Lanes::splat(functions[p][k] * shapes[p][2 * node + place / 2]);
                            *sum = value.mul_add(fields[p][place % 2], *sum);
                        }
                    }
                    for (entries, values) in entries.iter_mut().zip(Lanes::transpose(sums)) {
                        if let Some(target) = entries[k].as_chunks_mut::<4>().0.get_mut(node) {
                            *target = values.to_array();
                        }
                    }
                }
            }
            for (lane, entries) in entries.iter().enumerate().take(lanes) {
                let rows = self.rows[cell + lane].map(|row| (row != NONE).then_some(row as usize));
                of(first + 4 * lane, rows, &entries.each_ref().map(|row| &row[..]));
            }
        });
    }
}

/// Message for a table with another number of points than was asked for.
const OF_POINTS: &str = "the table has the points of its rule";

/// Σ_k μ_k φ_k.
#[inline(always)]
fn axial_force(functions: &[f64; 3], mu: [Lanes; 3]) -> Lanes {
    let [a, b, c] = functions.map(Lanes::splat);
    c.mul_add(mu[2], b.mul_add(mu[1], a * mu[0]))
}

/// r' at a point.
#[inline(always)]
fn field<const W: usize>(shape: &[f64; W], here: &[Pair<Lanes>; W]) -> Pair<Lanes> {
    let mut r = [Lanes::ZERO; 2];
    for (shape, here) in shape.iter().zip(here) {
        let shape = Lanes::splat(*shape);
        r = [shape.mul_add(here[0], r[0]), shape.mul_add(here[1], r[1])];
    }
    r
}

/// Forces on the coefficients and contributions to the rows of four cells.
#[inline(always)]
fn sums<const W: usize>(
    unit: f64,
    weights: &[f64; POINTS],
    shapes: &[[f64; W]; POINTS],
    functions: &Functions,
    here: &[Pair<Lanes>; W],
    mu: [Lanes; 3],
) -> Sums<W> {
    let (mut sums, mut of_rows) = ([[Lanes::ZERO; 2]; W], [Lanes::ZERO; 3]);
    for p in 0..POINTS {
        let r = field(&shapes[p], here);
        let weight = Lanes::splat(unit * weights[p]);
        let half_square = lanes::dot(r, r) * (weight * Lanes::splat(0.5));
        for (sum, function) in of_rows.iter_mut().zip(functions[p]) {
            *sum = Lanes::splat(function).mul_add(half_square, *sum);
        }
        let force = axial_force(&functions[p], mu) * weight;
        let force = r.map(|r| r * force);
        for (sum, shape) in sums.iter_mut().zip(shapes[p]) {
            let shape = Lanes::splat(shape);
            *sum = [shape.mul_add(force[0], sum[0]), shape.mul_add(force[1], sum[1])];
        }
    }
    (sums, of_rows)
}

/// The coefficients of four cells, or of one in all lanes.
#[inline(always)]
fn gather<const W: usize>(lanes: usize, q: &[f64]) -> [Pair<Lanes>; W] {
    if lanes == 4 {
        return lanes::gather::<W>(&q[..2 * W + 12]);
    }
    let mut here = [[Lanes::ZERO; 2]; W];
    for (here, q) in here.iter_mut().zip(q.as_chunks::<2>().0) {
        *here = q.map(Lanes::splat);
    }
    here
}

/// Adds to the coefficients of four cells, or of the one in lane 0.
#[inline(always)]
fn scatter<const W: usize>(lanes: usize, sums: &[Pair<Lanes>; W], f: &mut [f64]) {
    if lanes == 4 {
        lanes::scatter(sums, &mut f[..2 * W + 12]);
        return;
    }
    for (f, sum) in f.as_chunks_mut::<2>().0.iter_mut().zip(sums) {
        *f = [f[0] + sum[0].to_array()[0], f[1] + sum[1].to_array()[0]];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::basis::Nodes;
    use crate::model::{Beam, Discretization, Model, Place, Section, Support};
    use crate::system::System;

    /// A clamped beam that keeps its length, with even and with uneven cells.
    fn systems() -> Vec<System> {
        let uneven = vec![0.0, 0.1, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.1, 1.2];
        let meshes = [
            Discretization::Ancf { nodes: Nodes::Uniform(11) },
            Discretization::Ancf { nodes: Nodes::Given(uneven) },
            Discretization::rpim(10),
            Discretization::rpim(4),
        ];
        let system = |mesh: Discretization| {
            let section = Section { axial_stiffness: None, ..Section::new(1.0, 0.3).weighing(0.2) };
            let beams = vec![Beam::line("beam", [0.0, 0.0], [0.72, 0.96], section, mesh)];
            let supports = vec![Support::clamp(Place::new(0, 0.0))];
            let model = Model { beams, supports, ..Model::default() };
            System::build(&model, Needs { inertia: false, motion: false }).unwrap()
        };
        meshes.into_iter().map(system).collect()
    }

    fn numbers(count: usize, seed: f64) -> Vec<f64> {
        (0..count).map(|i| (seed * (i + 1) as f64 * (i + 3) as f64).sin()).collect()
    }

    fn close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        let size = expected.iter().fold(1e-300_f64, |m, x| m.max(x.abs()));
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert!((found - expected).abs() < 1e-13 * size, "{i}: {found} {expected}");
        }
    }

    #[test]
    fn sums_are_those_of_the_rows() {
        for system in systems() {
            assert_eq!((system.kept.len(), system.tied.len()), (1, 0));
            let (n, m) = (system.coordinates(), system.multipliers());
            let unit = system.stiffness() / system.length();
            let (v, mu) = (numbers(n, 0.3), numbers(m, 0.7));
            let q: Vec<f64> =
                system.reference().iter().zip(numbers(n, 0.4)).map(|(q, d)| q + 0.2 * d).collect();

            let (mut force, mut gaps) = (vec![0.0; n], vec![0.0; m]);
            let (mut product, mut k) = (vec![0.0; n], system.matrix());
            let (mut rates, mut curvatures) = (vec![0.0; m], vec![0.0; m]);
            for (r, row) in system.constraints().iter().enumerate() {
                row.gradient(0.0, &q).for_each(|(i, value)| {
                    force[i] += unit * mu[r] * value;
                    rates[r] -= unit * value * v[i];
                });
                row.second_derivative(&q).for_each(|(i, j, value)| {
                    product[i] += unit * mu[r] * value * v[j];
                    k.add_at(i, j, unit * mu[r] * value);
                });
                curvatures[r] = -unit * row.curvature(&q, &v);
                gaps[r] = unit * row.value(0.0, &q);
            }

            let (mut f, mut g) = (vec![0.0; n], vec![7.0; m]);
            let scale = system.constrain(0.0, [&q, &mu], &mut f, &mut g, 0.0);
            close(&f, &force);
            close(&g, &gaps);
            assert!(scale > 0.1 * force.iter().fold(0.0_f64, |m, f| m.max(f.abs()) / system.length()));
            let mut f = vec![0.0; n];
            system.add_constraint_forces(0.0, &q, &mu, &mut f);
            close(&f, &force);
            system.constraint_values(0.0, &q, &mut g);
            g.iter_mut().for_each(|g| *g = -*g);
            close(&g, &gaps);
            system.constraint_rates(0.0, &q, &v, &mut g);
            close(&g, &rates);
            g.fill(0.0);
            system.add_constraint_curvatures(&q, &v, &mut g);
            close(&g, &curvatures);
            let mut f = vec![0.0; n];
            system.add_constraint_stiffness_product(&q, &mu, &v, &mut f);
            close(&f, &product);
            let mut stiffness = system.matrix();
            system.add_constraint_stiffness(&q, &mu, &mut stiffness);
            let all = |k: &Matrix| -> Vec<f64> {
                (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| k.get(i, j)).collect()
            };
            close(&all(&stiffness), &all(&k));
        }
    }

    #[test]
    fn four_states_at_once_are_four_states() {
        for system in systems() {
            let (n, m) = (system.coordinates(), system.multipliers());
            let states: Vec<[Vec<f64>; 2]> = (0..4)
                .map(|lane| {
                    [numbers(n, 0.2 + 0.1 * f64::from(lane)), numbers(m, 0.5 + 0.1 * f64::from(lane))]
                })
                .collect();
            let in_lanes = |part: usize, count: usize| -> Vec<Lanes> {
                (0..count).map(|i| Lanes::new(std::array::from_fn(|lane| states[lane][part][i]))).collect()
            };
            let (q, mu) = (in_lanes(0, n), in_lanes(1, m));
            let (mut f, mut g) = (vec![Lanes::ZERO; n], vec![Lanes::ONE; m]);
            let mut scratch = [vec![0.0; n], vec![0.0; n]];
            let scale =
                system.constrain_in_lanes([0.0; 4], [&q, &mu], &mut f, &mut g, Lanes::ZERO, &mut scratch);
            for (lane, [q, mu]) in states.iter().enumerate() {
                let (mut force, mut gaps) = (vec![0.0; n], vec![0.0; m]);
                let expected = system.constrain(0.0, [q, mu], &mut force, &mut gaps, 0.0);
                let of_lane =
                    |list: &[Lanes]| -> Vec<f64> { list.iter().map(|x| x.to_array()[lane]).collect() };
                close(&of_lane(&f), &force);
                close(&of_lane(&g), &gaps);
                assert!((scale.to_array()[lane] / expected - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn entries_are_those_of_the_rows() {
        for system in systems() {
            let unit = system.stiffness() / system.length();
            let q = numbers(system.coordinates(), 0.4);
            let border = system.border(0.0, &q);
            for (row, found) in system.constraints().iter().zip(&border) {
                let mut expected = vec![0.0; q.len()];
                row.gradient(0.0, &q).for_each(|(i, value)| expected[i] += unit * value);
                // The clamp fixes the position and the direction of the first node: here its frame
                // is not parallel to the axes.
                let mut first = expected.clone();
                system.supports().to_frames(0.0, &mut first);
                expected[..4].copy_from_slice(&first[..4]);
                let mut dense = vec![0.0; q.len()];
                found.iter().for_each(|(i, value)| dense[*i] += value);
                close(&dense, &expected);
                assert!(found.is_sorted_by(|a, b| a.0 < b.0));
                assert!(found.iter().all(|(i, _)| !system.fixed()[*i]));
            }
        }
    }
}
