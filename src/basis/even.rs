//! Cells among evenly spaced nodes.
//!
//! In units of the node spacing all of them are alike: the shape functions depend only on the number
//! of nodes in the support, on the cell's place in it, and on the parameters of the interpolation. A
//! cell and its mirror image have the same functions, too, with the signs of slopes reversed. Each is
//! therefore solved once in a process, for a support whose nodes are 0, 1, 2, …, and its rows are
//! kept for the points at which they were asked for.
//!
//! What is kept are constants of mathematics: no result depends on what was asked for before.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::interpolation::{Amount, Interpolation, Place, Quality, Wanted};
use super::profile::Profile;
use super::rpim::{Interpolant, Precisions};

/// Most cells that are kept; the oldest goes first.
const CELLS: usize = 64;
/// Most points of a cell at which its rows are kept.
const POINTS: usize = 64;
/// Orders of derivatives of the rows that are kept.
const ORDERS: [usize; 3] = [0, 1, 2];

static KEPT: Mutex<Vec<Arc<EvenCell>>> = Mutex::new(Vec::new());

/// A cell of a support whose nodes are 0, 1, 2, …
#[derive(Debug)]
struct EvenCell {
    interpolation: Interpolation,
    nodes: Vec<f64>,
    left: usize,
    shape: Interpolant,
    /// ξ, and the rows there, one order after the other.
    rows: Mutex<Vec<(f64, Arc<Vec<f64>>)>>,
    /// The rows at any point, where a polynomial gives them.
    profile: OnceLock<Option<Profile>>,
}

/// A cell of evenly spaced nodes.
#[derive(Clone, Debug)]
pub struct Even {
    cell: Arc<EvenCell>,
    mirrored: bool,
    /// Distance of the nodes \[m\].
    spacing: f64,
}

/// Whether the nodes of a support are spaced by `spacing`, within the round-off of their places.
pub fn is_even(nodes: &[f64], spacing: f64) -> bool {
    let round_off = 4.0 * f64::EPSILON * nodes[nodes.len() - 1];
    nodes.windows(2).all(|pair| (pair[1] - pair[0] - spacing).abs() <= round_off.min(1e-9 * spacing))
}

impl Even {
    /// The cell number `left` of a support of `nodes` nodes at the average spacing of the beam.
    ///
    /// # Errors
    /// As [`Interpolant::solve`].
    pub fn find(
        interpolation: &Interpolation,
        nodes: usize,
        left: usize,
        precisions: &mut Precisions,
    ) -> Result<Self, Quality> {
        let spacing = interpolation.length / interpolation.spacings as f64;
        let mirrored = left > nodes - 2 - left;
        let left = if mirrored { nodes - 2 - left } else { left };
        let lock = || KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let Interpolation { kernel, terms, side_condition, .. } = *interpolation;
        let same = |kept: &&Arc<EvenCell>| {
            kept.left == left
                && kept.nodes.len() == nodes
                && kept.interpolation.terms == terms
                && kept.interpolation.side_condition == side_condition
                && kept.interpolation.kernel == kernel
        };
        if let Some(cell) = lock().iter().find(same) {
            return Ok(Self { cell: Arc::clone(cell), mirrored, spacing });
        }
        // Not under the lock: other threads need not wait for what takes long.
        let (length, spacings) = ((nodes - 1) as f64, nodes - 1);
        let interpolation = Interpolation { length, spacings, ..*interpolation };
        let places: Vec<f64> = (0..nodes).map(|node| node as f64).collect();
        let shape = Interpolant::solve(&interpolation, Place { nodes: &places, left }, precisions)?;
        let (rows, profile) = (Mutex::default(), OnceLock::new());
        let cell = Arc::new(EvenCell { interpolation, nodes: places, left, shape, rows, profile });
        let mut kept = lock();
        if kept.len() >= CELLS {
            kept.remove(0);
        }
        kept.push(Arc::clone(&cell));
        Ok(Self { cell, mirrored, spacing })
    }

    /// How accurate the rows are.
    pub fn quality(&self) -> Quality {
        self.cell.shape.quality
    }

    /// Fills two numbers per node of the support for each wanted order.
    pub fn rows(&self, precisions: &mut Precisions, wanted: Wanted<'_>, rows: &mut [f64]) {
        let width = 2 * self.cell.nodes.len();
        let xi = if self.mirrored { 1.0 - wanted.xi } else { wanted.xi };
        let here = match wanted.amount {
            Amount::Few => self.cell.rows_at(xi, precisions),
            Amount::Many => self.cell.rows_of_many(xi, precisions),
        };
        for (&order, row) in wanted.orders.iter().zip(rows.chunks_mut(wanted.stride.max(1))) {
            let value = self.spacing.powi(-(order as i32));
            let slope = self.spacing.powi(1 - order as i32);
            let source = &here[order * width..(order + 1) * width];
            let odd = if self.mirrored && order % 2 == 1 { -1.0 } else { 1.0 };
            for (node, row) in row[..width].as_chunks_mut::<2>().0.iter_mut().enumerate() {
                let (node, sign) = if self.mirrored { (width / 2 - 1 - node, -odd) } else { (node, odd) };
                *row = [source[2 * node] * (odd * value), source[2 * node + 1] * (sign * slope)];
            }
        }
    }
}

impl EvenCell {
    /// The rows of all orders at ξ.
    fn rows_at(&self, xi: f64, precisions: &mut Precisions) -> Arc<Vec<f64>> {
        let lock = || self.rows.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, rows)) = lock().iter().find(|(at, _)| *at == xi) {
            return Arc::clone(rows);
        }
        let rows = Arc::new(self.solved_at(xi, precisions));
        let mut kept = lock();
        if kept.len() >= POINTS {
            kept.remove(0);
        }
        kept.push((xi, Arc::clone(&rows)));
        rows
    }

    /// The same where so many points are wanted that a polynomial is worth its price.
    fn rows_of_many(&self, xi: f64, precisions: &mut Precisions) -> Arc<Vec<f64>> {
        let width = 2 * self.nodes.len();
        match self.profile.get_or_init(|| Profile::new(width, |xi| self.solved_at(xi, precisions))) {
            Some(profile) => Arc::new(profile.at(xi)),
            None => self.rows_at(xi, precisions),
        }
    }

    fn solved_at(&self, xi: f64, precisions: &mut Precisions) -> Vec<f64> {
        let width = 2 * self.nodes.len();
        let mut rows = vec![0.0; ORDERS.len() * width];
        let place = Place { nodes: &self.nodes, left: self.left };
        let wanted = Wanted { xi, orders: &ORDERS, stride: width, amount: Amount::Few };
        self.shape.rows(&self.interpolation, place, precisions, wanted, &mut rows);
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Kernel, SideCondition, rpim};
    use super::*;

    /// Rows of a beam of evenly spaced nodes are those that the nodes themselves give, on the left as
    /// well as mirrored on the right.
    #[test]
    fn rows_are_those_of_the_nodes_themselves() {
        let interpolation = Interpolation {
            kernel: Kernel::Multiquadric { q: 1.03, shape: 4.2 },
            terms: 2,
            side_condition: SideCondition::Plus,
            length: 1.8,
            spacings: 5,
        };
        let nodes: Vec<f64> = (0..6).map(|i| 1.8 * f64::from(i) / 5.0).collect();
        assert!(is_even(&nodes, 0.36) && !is_even(&nodes, 0.36 + 1e-12));
        let mut precisions = Precisions::default();
        for cell in 0..5 {
            let even = Even::find(&interpolation, 6, cell, &mut precisions).unwrap();
            assert_eq!(even.mirrored, cell > 2);
            let place = rpim::place(&nodes, 0..6, cell);
            let shape = Interpolant::solve(&interpolation, place, &mut precisions).unwrap();
            for xi in [0.0, 0.2, 0.7] {
                let wanted = Wanted { xi, orders: &[2, 0, 1], stride: 12, amount: Amount::Few };
                let [mut found, mut expected] = [[0.0; 36]; 2];
                even.rows(&mut precisions, wanted, &mut found);
                shape.rows(&interpolation, place, &mut precisions, wanted, &mut expected);
                for (i, (found, expected)) in found.iter().zip(&expected).enumerate() {
                    let size = expected.abs().max(1.0);
                    assert!(
                        (found - expected).abs() < 1e-12 * size,
                        "cell {cell}, ξ = {xi}, {i}: {found:e} {expected:e}"
                    );
                }
            }
            let mut of_many = [0.0; 36];
            let wanted = |amount| Wanted { xi: 0.4321, orders: &[2, 0, 1], stride: 12, amount };
            let mut found = [0.0; 36];
            even.rows(&mut precisions, wanted(Amount::Few), &mut found);
            even.rows(&mut precisions, wanted(Amount::Many), &mut of_many);
            assert!(even.cell.profile.get().is_some_and(Option::is_some));
            for (found, of_many) in found.iter().zip(&of_many) {
                let error = (found - of_many).abs();
                assert!(error < 1e-12 * found.abs().max(1.0), "cell {cell}: {found:e} {of_many:e}");
            }
            let again = Even::find(&interpolation, 6, cell, &mut precisions).unwrap();
            assert!(Arc::ptr_eq(&even.cell, &again.cell));
        }
    }
}
