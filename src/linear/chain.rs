//! A chain of nodes, each coupled with its neighbours, bordered by rows that belong to a few
//! neighbouring nodes: the tangent of cable elements that keep their length.
//!
//! ```text
//! [ A  Bᵀ ]
//! [ B  0  ]
//! ```
//!
//! A node has four unknowns, and with it at most two multipliers are eliminated: one whose row
//! spans up to three nodes, and one whose row spans up to two. In stage j of the elimination these
//! are, for a beam that keeps its length,
//!
//! ```text
//! x_j, then λ of node j − 1 and λ of the cell before node j        (6 pivots)
//! ```
//!
//! All unknowns of a row are eliminated before its multiplier is. If A is positive definite, the
//! pivots of unknowns are then positive and those of multipliers negative, and L D Lᵀ needs no
//! pivoting (the leading minors are those of smaller systems of the same kind). What remains of
//! a stage are x_{j+1} and three multipliers. Compared with an LU with pivoting of the same band,
//! which is as wide as the longest row, it takes a tenth of the operations.
//!
//! # Matrices that are not definite
//! Without an axial stiffness, the tangent of statics is zero along the axis. There A is replaced by
//! A + BᵀWB with a positive diagonal W, and the right-hand side f of the unknowns by f + BᵀW g,
//! where g is that of the multipliers. This changes neither the solution nor the number of negative
//! pivots, but gives A a stiffness along the axis. It couples every node with the next but one.
//!
//! The same elimination serves complex symmetric matrices whose imaginary part is definite.

use super::Singular;
use super::bordered::BorderRow;
use super::four::Four;
use super::symmetric::{SMALLEST_PIVOT, SymmetricBand};
use crate::lanes::Lanes;
use faer::c64;

/// No row.
const NONE: u32 = u32::MAX;
/// Rows that may touch a node: in the order of their elimination, those of stage j, j + 1, j + 2,
/// where the last is only one.
const ROWS: usize = 5;

/// The entries of the rows that touch a node, and three rows of zeros, with which those of this
/// node's stage and the others become blocks.
#[derive(Clone, Copy, Debug, Default)]
struct Entries {
    rows: [[f64; 4]; ROWS + 3],
}

/// In which stage each multiplier is eliminated.
#[derive(Clone, Debug, Default, PartialEq)]
struct Stages {
    /// Per stage: the row that may span three nodes, and the one that may span two.
    slots: Vec<[u32; 2]>,
}

impl Stages {
    /// Finds a stage for each row of `border` in a chain of `nodes` nodes.
    fn find(&mut self, nodes: usize, border: &[BorderRow]) -> bool {
        self.slots.clear();
        self.slots.resize(nodes + 1, [NONE; 2]);
        border.iter().enumerate().all(|(r, row)| {
            let (Some((first, _)), Some((last, _))) = (row.first(), row.last()) else { return false };
            let (first, last) = (first / 4, last / 4);
            // Later stages are possible, too, but the row must not enter after its first node.
            let places = [(last, 1, 1), (last, 0, 2), (last + 1, 0, 2), (last + 1, 1, 1), (last + 2, 0, 2)];
            let free = places.into_iter().find(|&(stage, kind, reach)| {
                stage <= first + reach && self.slots.get(stage).is_some_and(|slots| slots[kind] == NONE)
            });
            let Some((stage, kind, _)) = free else { return false };
            self.slots[stage][kind] = r as u32;
            true
        })
    }

    /// The entries of all rows at each node, in the order of the stages of the rows.
    fn entries(&self, border: &[BorderRow], entries: &mut Vec<Entries>) {
        entries.clear();
        entries.resize(self.slots.len() + 2, Entries::default());
        for (stage, slots) in self.slots.iter().enumerate() {
            let Some(node) = stage.checked_sub(2).or(stage.checked_sub(1)).or(Some(stage)) else { continue };
            let ahead = stage - node;
            let nodes = &mut entries[node..=stage];
            for (kind, row) in slots.iter().enumerate().filter(|(_, row)| **row != NONE) {
                let mut left = &border[*row as usize][..];
                while let Some(&(i, value)) = left.first() {
                    let place = i / 4 - node;
                    // Entries ascend, and most rows hold all of a node.
                    let whole = left.first_chunk::<4>().filter(|four| i % 4 == 0 && four[3].0 == i + 3);
                    left = &left[if whole.is_some() { 4 } else { 1 }..];
                    let Some(entries) = nodes.get_mut(place) else { continue };
                    let target = &mut entries.rows[kind + 2 * (ahead - place)];
                    match whole {
                        Some(four) => *target = four.map(|(_, value)| value),
                        None => target[i % 4] = value,
                    }
                }
            }
        }
    }
}

/// The factors of a stage. The unknowns x of its node come first, then its two multipliers a; both
/// are coupled with what remains: the unknowns of the next node, three multipliers, and, where A is
/// augmented, the unknowns of the next node but one.
#[derive(Clone, Copy, Debug)]
struct Stage<F: Four> {
    /// D⁻¹ of the unknowns, or the rows of d lᵀ.
    x: [F; 4],
    /// 1/d of the unknowns.
    reciprocal: [F::One; 4],
    /// W = D⁻¹ U between unknowns and multipliers, and its transpose.
    x_a: [F; 4],
    a_x: [F; 2],
    /// W between unknowns and what remains, and its transpose.
    x_rest: [[F; 4]; 3],
    rest_x: [[F; 4]; 3],
    /// 1/d, u, 1/d of D = [d u; 0 d] of the multipliers.
    a: [F::One; 3],
    /// W between multipliers and what remains.
    a_rest: [[F; 2]; 3],
}

impl<F: Four> Default for Stage<F> {
    fn default() -> Self {
        let (zero, two, four) = (F::one(0.0), [F::ZERO; 2], [F::ZERO; 4]);
        Self {
            x: four,
            reciprocal: [zero; 4],
            x_a: four,
            a_x: two,
            x_rest: [four; 3],
            rest_x: [four; 3],
            a: [zero; 3],
            a_rest: [two; 3],
        }
    }
}

/// What the stages so far have added to the blocks of x, the unknowns of the next node, b, the
/// multipliers that remain, and, where A is augmented, y, the unknowns of the node after that.
#[derive(Clone, Copy, Debug)]
struct Carried<F: Four> {
    xx: [F; 4],
    xb: [F; 4],
    xy: [F; 4],
    bb: [F; 3],
    by: [F; 3],
    yy: [F; 4],
    /// The largest size that the pivot of each multiplier has had.
    sizes: [f64; 3],
}

impl<F: Four> Default for Carried<F> {
    fn default() -> Self {
        let (four, three) = ([F::ZERO; 4], [F::ZERO; 3]);
        Self { xx: four, xb: four, xy: four, bb: three, by: three, yy: four, sizes: [0.0; 3] }
    }
}

/// `block += weight · column rowᵀ`.
#[inline(always)]
fn add_product<F: Four>(block: &mut [F; 4], weight: f64, column: &[f64; 4], row: &[f64; 4]) {
    let row = F::real(*row);
    for (target, value) in block.iter_mut().zip(column) {
        *target = row.added(F::one(weight * value), *target);
    }
}

/// `targets_i −= Σ_r l_ri u_r`.
#[inline(always)]
fn reduce<F: Four, const N: usize, const R: usize>(targets: &mut [F; N], l: &[[F::One; 4]; R], u: &[F; R]) {
    for (i, target) in targets.iter_mut().enumerate() {
        let mut sum = *target;
        for r in 0..R {
            sum = u[r].subtracted(l[r][i], sum);
        }
        *target = sum;
    }
}

/// L D Lᵀ of a chain with its rows.
#[derive(Clone, Debug)]
pub struct Chain<F: Four = Lanes> {
    stages: Stages,
    factors: Vec<Stage<F>>,
    entries: Vec<Entries>,
    /// W of each row; empty where A was not augmented.
    weights: Vec<[f64; 2]>,
    negative: usize,
    rows: usize,
}

/// Whether a chain of `nodes` nodes with such rows can be factorised here.
pub fn fits(matrix: &SymmetricBand, border: &[BorderRow]) -> bool {
    matrix.stride() <= 8 && Stages::default().find(matrix.size() / 4, border)
}

impl<F: Four> Chain<F> {
    fn of(earlier: Option<Self>, nodes: usize, border: &[BorderRow]) -> Option<Self> {
        let empty = || Self {
            stages: Stages::default(),
            factors: Vec::new(),
            entries: Vec::new(),
            weights: Vec::new(),
            negative: 0,
            rows: 0,
        };
        let mut chain = earlier.unwrap_or_else(empty);
        if !chain.stages.find(nodes, border) {
            return None;
        }
        chain.stages.entries(border, &mut chain.entries);
        chain.rows = border.len();
        Some(chain)
    }

    /// Adds BᵀWB to the blocks from node `node` to itself and to the next two.
    #[inline(always)]
    fn augment(&self, node: usize, blocks: [&mut [F; 4]; 3]) {
        let (Some([here, next, last]), Some([w0, w1, w2])) =
            (self.entries[node..].first_chunk(), self.weights[node..].first_chunk())
        else {
            return;
        };
        let [diagonal, right, far] = blocks;
        for (row, weight) in here.rows.iter().zip([w0[0], w0[1], w1[0], w1[1], w2[0]]) {
            add_product(diagonal, weight, row, row);
        }
        add_product(right, w1[0], &here.rows[2], &next.rows[0]);
        add_product(right, w1[1], &here.rows[3], &next.rows[1]);
        add_product(right, w2[0], &here.rows[4], &next.rows[2]);
        add_product(far, w2[0], &here.rows[4], &last.rows[0]);
    }

    /// Eliminates stage by stage. `block(node, b)` is the block of A in the rows of `node` and the
    /// columns of the node `b` further on. `AUGMENTED`: A is augmented by BᵀWB. `INVERSE`: D⁻¹
    /// is stored, not D.
    fn eliminate<const AUGMENTED: bool, const INVERSE: bool>(
        &mut self,
        nodes: usize,
        block: impl Fn(usize, usize) -> [F; 4],
    ) -> Result<(), Singular> {
        self.factors.resize(nodes + 1, Stage::default());
        self.negative = 0;
        let (zero, unity) = (F::one(0.0), F::one(1.0));
        let mut carried = Carried::<F>::default();
        for stage in 0..=nodes {
            let (mut x, mut x1, mut x2) = if stage < nodes {
                let next = if stage + 1 < nodes { block(stage, 1) } else { [F::ZERO; 4] };
                (block(stage, 0), next, [F::ZERO; 4])
            } else {
                let unit = |r: usize| F::real(std::array::from_fn(|c| f64::from(u8::from(c == r))));
                (std::array::from_fn(unit), [F::ZERO; 4], [F::ZERO; 4])
            };
            if AUGMENTED && stage < nodes {
                self.augment(stage, [&mut x, &mut x1, &mut x2]);
            }
            let scales: [f64; 4] = std::array::from_fn(|r| F::size(x[r].numbers()[r]));
            let rows = self.entries[stage].rows.map(F::real);
            let mut xa = F::transpose([rows[0], rows[1], rows[6], rows[7]]);
            let mut xr = F::transpose([rows[2], rows[3], rows[4], rows[5]]);
            for r in 0..4 {
                x[r] = carried.xx[r].added(unity, x[r]);
                xa[r] = carried.xb[r].first_two().added(unity, xa[r]);
                xr[r] = carried.xb[r].third_first().added(unity, xr[r]);
                if AUGMENTED {
                    x1[r] = carried.xy[r].added(unity, x1[r]);
                }
            }

            // The four unknowns.
            let mut reciprocal = [zero; 4];
            for r in 0..4 {
                let row = x[r].numbers();
                let size = F::size(row[r]);
                // Written with a negation, so that a NaN fails, too.
                if !(size > SMALLEST_PIVOT * scales[r] && size.is_finite()) {
                    return Err(Singular { row: 4 * stage + r });
                }
                self.negative += usize::from(F::is_negative(row[r]));
                reciprocal[r] = unity / row[r];
                for c in r + 1..4 {
                    let l = row[c] * reciprocal[r];
                    x[c] = x[r].subtracted(l, x[c]);
                    xa[c] = xa[r].subtracted(l, xa[c]);
                    x1[c] = x1[r].subtracted(l, x1[c]);
                    xr[c] = xr[r].subtracted(l, xr[c]);
                    if AUGMENTED {
                        x2[c] = x2[r].subtracted(l, x2[c]);
                    }
                }
            }
            let scaled = |u: &[F; 4]| -> [[F::One; 4]; 4] {
                std::array::from_fn(|r| u[r].added(reciprocal[r], F::ZERO).numbers())
            };
            let l_a = scaled(&xa);
            let (mut aa, mut ar) = ([carried.bb[0], carried.bb[1]], [carried.bb[0], carried.bb[1]]);
            ar = ar.map(F::third_first);
            let (mut a1, mut a2) = ([carried.by[0], carried.by[1]], [F::ZERO; 2]);
            reduce(&mut aa, &l_a, &xa);
            reduce(&mut a1, &l_a, &x1);
            reduce(&mut ar, &l_a, &xr);
            if AUGMENTED {
                reduce(&mut a2, &l_a, &x2);
            }

            // The two multipliers.
            let aa = aa.map(F::numbers);
            let a =
                self.pivots_of_multipliers(stage, nodes, [aa[0][0], aa[0][1], aa[1][1]], carried.sizes)?;
            let l = a[1] * a[0];
            a1[1] = a1[0].subtracted(l, a1[1]);
            ar[1] = ar[0].subtracted(l, ar[1]);
            a2[1] = a2[0].subtracted(l, a2[1]);

            // What remains.
            let six = |x: &[F; 4], a: &[F; 2]| [x[0], x[1], x[2], x[3], a[0], a[1]];
            let pivots = [reciprocal[0], reciprocal[1], reciprocal[2], reciprocal[3], a[0], a[2]];
            let scaled = |u: &[F; 6]| -> [[F::One; 4]; 6] {
                std::array::from_fn(|r| u[r].added(pivots[r], F::ZERO).numbers())
            };
            let (next, rest, far) = (six(&x1, &a1), six(&xr, &ar), six(&x2, &a2));
            let (l_next, l_rest) = (scaled(&next), scaled(&rest));
            let mut after = Carried {
                xx: carried.yy,
                xb: [F::ZERO; 4],
                bb: [carried.bb[2].third_first(), F::ZERO, F::ZERO],
                ..Carried::<F>::default()
            };
            if AUGMENTED {
                let by = carried.by[2].numbers();
                after.xb = by.map(|value| F::splat(value).times([1.0, 0.0, 0.0, 0.0]));
            }
            reduce(&mut after.xx, &l_next, &next);
            reduce(&mut after.xb, &l_next, &rest);
            reduce(&mut after.bb, &l_rest, &rest);
            if AUGMENTED {
                reduce(&mut after.xy, &l_next, &far);
                reduce(&mut after.by, &l_rest, &far);
                reduce(&mut after.yy, &scaled(&far), &far);
            }
            let size = |i: usize| F::size(after.bb[i].numbers()[i]);
            after.sizes = [carried.sizes[2].max(size(0)), size(1), size(2)];
            carried = after;

            // W of the unknowns and of the multipliers.
            for r in (0..4).rev() {
                let row = x[r].numbers();
                for c in r + 1..4 {
                    xa[r] = xa[c].subtracted(row[c], xa[r]);
                    x1[r] = x1[c].subtracted(row[c], x1[r]);
                    xr[r] = xr[c].subtracted(row[c], xr[r]);
                    if AUGMENTED {
                        x2[r] = x2[c].subtracted(row[c], x2[r]);
                    }
                }
                for u in [&mut xa, &mut x1, &mut xr, &mut x2] {
                    u[r] = u[r].added(reciprocal[r], F::ZERO);
                }
            }
            for u in [&mut a1, &mut ar, &mut a2] {
                u[1] = u[1].added(a[2], F::ZERO);
                u[0] = u[1].subtracted(a[1], u[0]).added(a[0], F::ZERO);
            }
            let target = &mut self.factors[stage];
            target.x = if INVERSE { inverse(&x, &reciprocal) } else { x };
            target.reciprocal = reciprocal;
            let [a_x0, a_x1, ..] = F::transpose(xa);
            (target.x_a, target.a_x, target.a) = (xa, [a_x0, a_x1], a);
            (target.x_rest[0], target.rest_x[0], target.a_rest[0]) = (x1, F::transpose(x1), a1);
            (target.x_rest[1], target.rest_x[1], target.a_rest[1]) = (xr, F::transpose(xr), ar);
            if AUGMENTED {
                (target.x_rest[2], target.rest_x[2], target.a_rest[2]) = (x2, F::transpose(x2), a2);
            }
        }
        Ok(())
    }

    /// 1/d, u, 1/d of the multipliers of a stage, from the entries of their symmetric block; those
    /// of a multiplier that does not exist are 1 and 0. `sizes` are the largest that their pivots
    /// have been.
    #[inline(never)]
    fn pivots_of_multipliers(
        &mut self,
        stage: usize,
        nodes: usize,
        [first, mixed, second]: [F::One; 3],
        sizes: [f64; 3],
    ) -> Result<[F::One; 3], Singular> {
        let (zero, unity) = (F::one(0.0), F::one(1.0));
        let [one, other] = self.stages.slots[stage];
        let mut a = [unity, zero, unity];
        let mut pivot = |row: u32, pivot: F::One, scale: f64| {
            let scale = scale.max(F::size(pivot));
            if !(F::size(pivot) > SMALLEST_PIVOT * scale && scale.is_finite()) {
                return Err(Singular { row: 4 * nodes + row as usize });
            }
            self.negative += usize::from(F::is_negative(pivot));
            Ok(unity / pivot)
        };
        if one != NONE {
            a[0] = pivot(one, first, sizes[0])?;
        }
        if other != NONE {
            if one != NONE {
                a[1] = mixed;
            }
            let scale = sizes[1].max(F::size(second));
            a[2] = pivot(other, second - a[1] * a[0] * a[1], scale)?;
        }
        Ok(a)
    }

    /// Solves in place: `x` are the unknowns of the nodes and a further node, `mu` the first two
    /// numbers of each stage, its multipliers.
    #[inline(always)]
    fn substitute<const AUGMENTED: bool, const INVERSE: bool>(&self, x: &mut [F], mu: &mut [F]) {
        let unity = F::one(1.0);
        let mut rest = F::ZERO;
        let (mut next, mut far) = (x[0], F::ZERO);
        for (j, (stage, mu)) in self.factors.iter().zip(&mut *mu).enumerate() {
            let here = next.numbers();
            let mut own = rest.added(unity, *mu);
            rest = rest.third_first();
            next = x.get(j + 1).copied().unwrap_or(F::ZERO);
            if AUGMENTED {
                next = far.added(unity, next);
                far = F::ZERO;
            }
            for (r, x) in here.into_iter().enumerate() {
                own = stage.x_a[r].subtracted(x, own);
                next = stage.x_rest[0][r].subtracted(x, next);
                rest = stage.x_rest[1][r].subtracted(x, rest);
                if AUGMENTED {
                    far = stage.x_rest[2][r].subtracted(x, far);
                }
            }
            let [a, b, ..] = own.numbers();
            for (r, a) in [a, b].into_iter().enumerate() {
                next = stage.a_rest[0][r].subtracted(a, next);
                rest = stage.a_rest[1][r].subtracted(a, rest);
                if AUGMENTED {
                    far = stage.a_rest[2][r].subtracted(a, far);
                }
            }
            x[j] = if INVERSE {
                let sum = stage.x[1].added(here[1], stage.x[0].added(here[0], F::ZERO));
                let other = stage.x[3].added(here[3], stage.x[2].added(here[2], F::ZERO));
                sum.added(unity, other)
            } else {
                solve_pivots(&stage.x, &stage.reciprocal, here)
            };
            let last = (b - stage.a[1] * stage.a[0] * a) * stage.a[2];
            *mu = F::new([(a - stage.a[1] * last) * stage.a[0], last, last, last]);
        }
        let (mut rest, mut next, mut far) = (F::ZERO, F::ZERO, F::ZERO);
        for ((stage, mu), x) in self.factors.iter().zip(mu).zip(x).rev() {
            let [a, b, ..] = mu.numbers();
            let mut own = [a, b];
            for (r, own) in own.iter_mut().enumerate() {
                *own = *own - stage.a_rest[0][r].dot(next) - stage.a_rest[1][r].dot(rest);
                if AUGMENTED {
                    *own = *own - stage.a_rest[2][r].dot(far);
                }
            }
            let (mut here, mut other) = (*x, F::ZERO);
            for (r, next) in next.numbers().into_iter().enumerate() {
                here = stage.rest_x[0][r].subtracted(next, here);
            }
            let [a, b, c, _] = rest.numbers();
            for (r, rest) in [a, b, c].into_iter().enumerate() {
                other = stage.rest_x[1][r].added(rest, other);
            }
            for (r, own) in own.into_iter().enumerate() {
                other = stage.a_x[r].added(own, other);
            }
            if AUGMENTED {
                for (r, far) in far.numbers().into_iter().enumerate() {
                    here = stage.rest_x[2][r].subtracted(far, here);
                }
            }
            here = other.subtracted(unity, here);
            *x = here;
            (far, next) = (next, here);
            // The fourth number is multiplied by zeros only.
            rest = F::new([own[0], own[1], a, a]);
            *mu = rest;
        }
    }

    /// The right-hand sides of the multipliers by stages.
    fn by_stages(&self, of_rows: impl Fn(usize) -> F::One) -> Vec<F> {
        let of_slot = |slot: u32| if slot == NONE { F::one(0.0) } else { of_rows(slot as usize) };
        let of_stage = |slots: &[u32; 2]| {
            let [a, b] = slots.map(of_slot);
            F::new([a, b, b, b]).first_two()
        };
        self.stages.slots.iter().map(of_stage).collect()
    }
}

impl Chain {
    /// Factorises `k`, plus c M where `shift` is (c, M), bordered by `border`, for which [`fits`]
    /// must hold. The sum is augmented unless it is `definite`, as the caller expects and the signs
    /// of the pivots confirm.
    ///
    /// # Errors
    /// [`Singular`] if a pivot vanishes.
    pub fn new(
        earlier: Option<Self>,
        k: &SymmetricBand,
        shift: Option<(f64, &SymmetricBand)>,
        definite: bool,
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        let nodes = k.size() / 4;
        let singular = Singular { row: k.size() };
        let mut chain = Self::of(earlier, nodes, border).ok_or(singular)?;
        let coupled = k.stride() / 4;
        let block = |node: usize, b: usize| {
            if b >= coupled {
                return [Lanes::ZERO; 4];
            }
            let mut block = k.block(node, b);
            if let Some((c, m)) = shift {
                let (c, m) = (Lanes::splat(c), m.block(node, b));
                block.iter_mut().zip(m).for_each(|(k, m)| *k = m.mul_add(c, *k));
            }
            block
        };
        chain.weights.clear();
        let found = |chain: &mut Self| chain.eliminate::<false, true>(nodes, block).is_ok();
        if definite && found(&mut chain) && chain.negative == border.len() {
            return Ok(chain);
        }
        chain.weigh(1.0, nodes, |i| k.get(i, i) + shift.map_or(0.0, |(c, m)| c * m.get(i, i)));
        chain.eliminate::<true, false>(nodes, block)?;
        Ok(chain)
    }

    /// Chooses W: each row becomes `factor` times as stiff as the softest of the nodal pairs of
    /// unknowns in it. Pairs are compared, because there is no stiffness along the axis.
    fn weigh(&mut self, factor: f64, nodes: usize, diagonal: impl Fn(usize) -> f64) {
        let pair = |i: usize| diagonal(i).abs().max(diagonal(i + 1).abs());
        let mut pairs: Vec<[f64; 2]> = (0..nodes).map(|node| [pair(4 * node), pair(4 * node + 2)]).collect();
        pairs.resize(nodes + 1, [0.0; 2]);
        let of_row = |stage: usize, kind: usize| {
            let mut weight = f64::INFINITY;
            for ahead in 0..(3 - kind).min(stage + 1) {
                let (row, pairs) =
                    (&self.entries[stage - ahead].rows[kind + 2 * ahead], pairs[stage - ahead]);
                for (d, pair) in pairs.into_iter().enumerate() {
                    let square = (row[2 * d] * row[2 * d]).max(row[2 * d + 1] * row[2 * d + 1]);
                    if square > 0.0 && pair > 0.0 {
                        weight = weight.min(pair / square);
                    }
                }
            }
            if weight.is_finite() { factor * weight } else { 0.0 }
        };
        self.weights.clear();
        self.weights.extend((0..=nodes).map(|stage| [0, 1].map(|kind| of_row(stage, kind))));
        self.weights.resize(nodes + 3, [0.0; 2]);
    }

    /// Number of negative eigenvalues of the matrix on the motions that the rows allow.
    pub fn negative_directions(&self) -> Option<usize> {
        self.negative.checked_sub(self.rows)
    }

    /// The same from another elimination of `k`, with `factor` times the weights.
    pub fn negative_directions_again(
        &self,
        factor: f64,
        k: &SymmetricBand,
        border: &[BorderRow],
    ) -> Option<usize> {
        let nodes = k.size() / 4;
        let mut chain = Self::of(None, nodes, border)?;
        chain.weigh(factor, nodes, |i| k.get(i, i));
        let coupled = k.stride() / 4;
        let block = |node, b| if b < coupled { k.block(node, b) } else { [Lanes::ZERO; 4] };
        chain.eliminate::<true, false>(nodes, block).ok()?;
        chain.negative_directions()
    }

    /// Solves in place; `b` holds the unknowns first and the multipliers last.
    pub fn solve(&self, b: &mut [f64]) {
        let (unknowns, g) = b.split_at_mut(b.len() - self.rows);
        let mut mu = self.by_stages(|row| g[row]);
        let nodes = unknowns.len() / 4;
        let mut x: Vec<Lanes> = unknowns.as_chunks::<4>().0.iter().map(|x| Lanes::new(*x)).collect();
        if self.weights.is_empty() {
            x.push(Lanes::ZERO);
            self.substitute::<false, true>(&mut x, &mut mu);
        } else {
            // f + BᵀW g.
            for (stage, (mu, weights)) in mu.iter().zip(&self.weights).enumerate() {
                let mu = mu.to_array();
                for kind in 0..2 {
                    let factor = mu[kind] * weights[kind];
                    if factor != 0.0 {
                        for ahead in 0..3 - kind {
                            if let Some(node) = stage.checked_sub(ahead).filter(|node| *node < nodes) {
                                let row = Lanes::new(self.entries[node].rows[kind + 2 * ahead]);
                                x[node] = row.added(factor, x[node]);
                            }
                        }
                    }
                }
            }
            x.push(Lanes::ZERO);
            self.substitute::<true, false>(&mut x, &mut mu);
        }
        for (b, x) in unknowns.as_chunks_mut::<4>().0.iter_mut().zip(&x) {
            *b = x.to_array();
        }
        for (slots, mu) in self.stages.slots.iter().zip(&mu) {
            for (slot, mu) in slots.iter().zip(mu.to_array()).filter(|(slot, _)| **slot != NONE) {
                g[*slot as usize] = mu;
            }
        }
    }
}

/// [`Chain`] of complex matrices.
pub type ComplexChain = Chain<[Lanes; 2]>;

impl ComplexChain {
    /// Factorises `k` + ζ `m`, bordered by `border`, for which [`fits`] must hold; the imaginary
    /// part must be definite.
    ///
    /// # Errors
    /// [`Singular`] if a pivot vanishes.
    pub fn complex(
        earlier: Option<Self>,
        k: &SymmetricBand,
        m: &SymmetricBand,
        zeta: c64,
        border: &[BorderRow],
    ) -> Result<Self, Singular> {
        let nodes = k.size() / 4;
        let mut chain = Self::of(earlier, nodes, border).ok_or(Singular { row: k.size() })?;
        let coupled = k.stride() / 4;
        let (re, im) = (Lanes::splat(zeta.re), Lanes::splat(zeta.im));
        let block = |node: usize, b: usize| {
            if b >= coupled {
                return [[Lanes::ZERO; 2]; 4];
            }
            let (k, m) = (k.block(node, b), m.block(node, b));
            std::array::from_fn(|r| [m[r].mul_add(re, k[r]), m[r] * im])
        };
        chain.eliminate::<false, true>(nodes, block)?;
        Ok(chain)
    }

    /// Solves in place; the multipliers' parts of `re` and `im` come last.
    pub fn solve_parts(&self, re: &mut [f64], im: &mut [f64]) {
        let ((re, g_re), (im, g_im)) =
            (re.split_at_mut(re.len() - self.rows), im.split_at_mut(im.len() - self.rows));
        let mut mu = self.by_stages(|row| c64::new(g_re[row], g_im[row]));
        let (re, im) = (re.as_chunks_mut::<4>().0, im.as_chunks_mut::<4>().0);
        let mut x: Vec<[Lanes; 2]> =
            re.iter().zip(&*im).map(|(re, im)| [Lanes::new(*re), Lanes::new(*im)]).collect();
        x.push([Lanes::ZERO; 2]);
        self.substitute::<false, true>(&mut x, &mut mu);
        for ((re, im), x) in re.iter_mut().zip(im).zip(&x) {
            [*re, *im] = x.map(Lanes::to_array);
        }
        for (slots, mu) in self.stages.slots.iter().zip(&mu) {
            for (slot, mu) in slots.iter().zip(mu.numbers()).filter(|(slot, _)| **slot != NONE) {
                (g_re[*slot as usize], g_im[*slot as usize]) = (mu.re, mu.im);
            }
        }
    }
}

/// D⁻¹, from the rows of d lᵀ and 1/d.
#[inline(always)]
fn inverse<F: Four>(pivots: &[F; 4], reciprocal: &[F::One; 4]) -> [F; 4] {
    let mut inverse: [F; 4] =
        std::array::from_fn(|r| F::real(std::array::from_fn(|c| f64::from(u8::from(r == c)))));
    for r in 0..4 {
        let row = pivots[r].numbers();
        for c in r + 1..4 {
            inverse[c] = inverse[r].subtracted(row[c] * reciprocal[r], inverse[c]);
        }
    }
    for r in (0..4).rev() {
        let row = pivots[r].numbers();
        for c in r + 1..4 {
            inverse[r] = inverse[c].subtracted(row[c], inverse[r]);
        }
        inverse[r] = inverse[r].added(reciprocal[r], F::ZERO);
    }
    inverse
}

/// D⁻¹ b, from the rows of d lᵀ and 1/d.
#[inline(always)]
fn solve_pivots<F: Four>(rows: &[F; 4], reciprocal: &[F::One; 4], mut b: [F::One; 4]) -> F {
    let rows = rows.map(F::numbers);
    for r in 0..4 {
        let z = b[r] * reciprocal[r];
        for c in r + 1..4 {
            b[c] = b[c] - z * rows[r][c];
        }
        b[r] = z;
    }
    for r in (0..4).rev() {
        let sum = (r + 1..4).fold(F::one(0.0), |sum, c| sum + rows[r][c] * b[c]);
        b[r] = b[r] - sum * reciprocal[r];
    }
    F::new(b)
}

#[cfg(test)]
mod tests {
    use super::super::Matrix;
    use super::super::bordered::Bordered;
    use super::*;

    /// A chain of `nodes` nodes with two rows per cell and one more, as a beam that keeps its length
    /// has them; `mass` is added to the diagonal.
    fn example(nodes: usize, mass: f64) -> (Matrix, Vec<BorderRow>) {
        let mut k = Matrix::zeros(nodes, 2, true);
        for i in 0..4 * nodes {
            for j in k.columns(i).filter(|j| *j >= i) {
                let value = ((3 * i * i + 7 * i * j + 3 * j * j) as f64).sin();
                k.add_at(i, j, value + if i == j { mass } else { 0.0 });
            }
        }
        let row = |nodes: std::ops::Range<usize>, f: f64| -> BorderRow {
            (4 * nodes.start..4 * nodes.end).map(|i| (i, (f * (i + 1) as f64).cos())).collect()
        };
        let mut border = Vec::new();
        for node in 0..nodes {
            border.push(row(node.saturating_sub(1)..(node + 2).min(nodes), 1.0 + 0.1 * node as f64));
            if node + 1 < nodes {
                border.push(row(node..node + 2, 2.0 + 0.3 * node as f64));
            }
        }
        (k, border)
    }

    fn right_hand_side(size: usize) -> Vec<f64> {
        (0..size).map(|i| 1.0 / (i + 1) as f64 - 0.2).collect()
    }

    fn close(found: &[f64], expected: &[f64]) {
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{a} and {b}");
        }
    }

    #[test]
    fn it_solves_what_a_sparse_factorisation_solves() {
        for nodes in [1, 2, 3, 7] {
            for (mass, definite) in [(6.0, true), (6.0, false), (0.0, true), (0.0, false)] {
                let (k, border) = example(nodes, mass);
                let Matrix::Symmetric(band) = &k else { unreachable!() };
                assert!(fits(band, &border), "{nodes} nodes");
                let mut expected = right_hand_side(4 * nodes + border.len());
                let mut found = expected.clone();
                Bordered::new(&k, &border, None).unwrap().solve(&mut expected);
                let chain = Chain::new(None, band, None, definite, &border).unwrap();
                assert_eq!(chain.weights.is_empty(), mass > 0.0 && definite);
                chain.solve(&mut found);
                close(&found, &expected);
            }
        }
    }

    #[test]
    fn a_mass_is_added_and_memory_used_again() {
        let (k, border) = example(5, 0.0);
        let (m, _) = example(5, 9.0);
        let (Matrix::Symmetric(k), Matrix::Symmetric(m)) = (&k, &m) else { unreachable!() };
        let mut sum = k.clone();
        sum.add(2.0, m);
        let [mut expected, mut found] = [0; 2].map(|_| right_hand_side(20 + border.len()));
        let first = Chain::new(None, &sum, None, true, &border).unwrap();
        first.solve(&mut expected);
        Chain::new(Some(first), k, Some((2.0, m)), true, &border).unwrap().solve(&mut found);
        close(&found, &expected);
    }

    #[test]
    fn complex_matrices_too() {
        let (k, border) = example(6, 0.0);
        let (m, _) = example(6, 7.0);
        let zeta = c64::new(0.3, 0.8);
        let entry = |i, j| c64::new(k.get(i, j), 0.0) + zeta * m.get(i, j);
        let size = 24 + border.len();
        let mut expected: Vec<c64> = (0..size).map(|i| c64::new(1.0, 0.1 * i as f64)).collect();
        let (mut re, mut im): (Vec<f64>, Vec<f64>) = expected.iter().map(|x| (x.re, x.im)).unzip();
        Bordered::from_entries(&k, entry, |i| entry(i, i).norm(), &border, None)
            .unwrap()
            .solve(&mut expected);
        let (Matrix::Symmetric(k), Matrix::Symmetric(m)) = (&k, &m) else { unreachable!() };
        ComplexChain::complex(None, k, m, zeta, &border).unwrap().solve_parts(&mut re, &mut im);
        let (expected_re, expected_im): (Vec<f64>, Vec<f64>) = expected.iter().map(|x| (x.re, x.im)).unzip();
        close(&re, &expected_re);
        close(&im, &expected_im);
    }

    #[test]
    fn negative_directions_are_those_of_a_sparse_elimination() {
        for mass in [-3.0, 0.0, 1.0, 4.0] {
            let (k, border) = example(8, mass);
            let Matrix::Symmetric(band) = &k else { unreachable!() };
            let chain = Chain::new(None, band, None, false, &border).unwrap();
            let expected = super::super::inertia::negative_directions(&k, &border, None);
            assert_eq!(chain.negative_directions(), expected, "{mass}");
            assert_eq!(chain.negative_directions_again(30.0, band, &border), expected, "{mass}");
        }
    }

    #[test]
    fn rows_that_depend_on_each_other_are_refused() {
        let (k, mut border) = example(4, 6.0);
        border[3] = border[1].clone();
        let Matrix::Symmetric(band) = &k else { unreachable!() };
        assert!(Chain::new(None, band, None, true, &border).is_err());
    }

    #[test]
    fn rows_across_the_chain_do_not_fit() {
        let Matrix::Symmetric(band) = Matrix::zeros(6, 2, true) else { unreachable!() };
        let row = |last: usize| vec![(0, 1.0), (last, 1.0)];
        assert_eq!([4, 8, 12].map(|last| fits(&band, &[row(last)])), [true, true, false]);
        assert_eq!([2, 4].map(|count| fits(&band, &vec![row(8); count])), [false; 2]);
    }
}
