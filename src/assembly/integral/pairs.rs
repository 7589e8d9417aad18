//! Forces that depend on two states, such as positions and velocities.

use super::CABLE;
use super::force::{fields_of_four, sums_of_points};
use crate::assembly::{Density, Dissipation, Gradient, Integral, Rayleigh};
use crate::lanes::{self, Lanes};

impl<D: Density<M>, const M: usize> Integral<D, M> {
    /// `f += ∫ Σ_m N⁽ᵒᵐ⁾ g_m(z, ż) ds`, where z are the fields of `q`, ż those of `v`, and g is
    /// `force`.
    pub(in crate::assembly) fn force_of_pairs(
        &self,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
        force: impl Fn(usize, &Gradient<M>, &Gradient<M>) -> Gradient<M>,
    ) {
        let cells = 0..self.table.cells.len();
        match self.table.width {
            4 if Self::CABLES => cells.for_each(|cell| self.pairs_of_cell::<4>(cell, q, v, f, &force)),
            8 if Self::COMMON => cells.for_each(|cell| self.pairs_of_cell::<8>(cell, q, v, f, &force)),
            12 if Self::COMMON => cells.for_each(|cell| self.pairs_of_cell::<12>(cell, q, v, f, &force)),
            _ => cells.for_each(|cell| self.pairs_of_cell::<0>(cell, q, v, f, &force)),
        }
    }

    #[inline(always)]
    fn pairs_of_cell<const W: usize>(
        &self,
        cell: usize,
        q: &[f64],
        v: &[f64],
        f: &mut [f64],
        force: &impl Fn(usize, &Gradient<M>, &Gradient<M>) -> Gradient<M>,
    ) {
        let width = self.width::<W>();
        let (weights, rows) = self.table.block(self.table.cells[cell]);
        let first = self.first(cell);
        let range = first..first + 2 * width;
        let (q, v, f) = (&q[range.clone()], &v[range.clone()], &mut f[range]);
        for (p, (weight, rows)) in weights.iter().zip(rows.chunks_exact(M * width)).enumerate() {
            let (z, rate) = (self.fields::<W>(rows, q), self.fields::<W>(rows, v));
            let gradient = force(cell * weights.len() + p, &z, &rate);
            self.add_gradient::<W>(*weight, rows, &gradient, f);
        }
    }
}

impl<D: Dissipation<M>, const M: usize> Integral<Rayleigh<D>, M> {
    /// `f += ∂R/∂q̇` in the state (q, v); of cable elements in equal groups four at a time.
    pub(in crate::assembly) fn dissipative_force(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        let force = |point: usize, z: &Gradient<M>, rate: &Gradient<M>| self.density.0.force(point, z, rate);
        // A condition on a constant alone: for other densities the loops by fours are not compiled.
        #[expect(clippy::collapsible_if, reason = "together they would not be such a condition")]
        if D::BY_FOURS {
            if self.table.width == CABLE && !self.fours.is_empty() {
                match self.table.points_per_cell {
                    2 => self.dissipative_force_of_fours::<2>(q, v, f),
                    3 => self.dissipative_force_of_fours::<3>(q, v, f),
                    4 => self.dissipative_force_of_fours::<4>(q, v, f),
                    5 => self.dissipative_force_of_fours::<5>(q, v, f),
                    points => unreachable!("cells with {points} points are not grouped by four"),
                }
                let singles = self.singles.iter().map(|cell| *cell as usize);
                return singles.for_each(|cell| self.pairs_of_cell::<CABLE>(cell, q, v, f, &force));
            }
        }
        self.force_of_pairs(q, v, f, force);
    }

    /// The cable elements that are grouped by four, with `P` points in each.
    fn dissipative_force_of_fours<const P: usize>(&self, q: &[f64], v: &[f64], f: &mut [f64]) {
        for &cell in &self.fours {
            let cell = cell as usize;
            let first = self.first(cell);
            let range = first..first + 2 * CABLE + 12;
            let (weights, rows) = self.table.block(self.table.cells[cell]);
            let (weights, rows) = (&weights[..P], &rows.as_chunks::<CABLE>().0[..P * M]);
            let [here, rates] = [q, v].map(|q| lanes::gather::<CABLE>(&q[range.clone()]));
            let mut gradients = [[[Lanes::ZERO; 2]; M]; P];
            for p in 0..P {
                let rows = &rows[p * M..(p + 1) * M];
                let (z, rate) = (fields_of_four(rows, &here), fields_of_four(rows, &rates));
                let weight = Lanes::splat(weights[p]);
                gradients[p] = self.density.0.forces(&z, &rate).map(|g| g.map(|g| g * weight));
            }
            lanes::scatter(&sums_of_points::<M, CABLE, P>(rows, &gradients), &mut f[range]);
        }
    }
}
