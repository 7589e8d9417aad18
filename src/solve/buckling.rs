//! Linear buckling: the load factors λ at which the tangent, linearised along the initial path, becomes singular,
//!
//! ```text
//! (K₀ + λ K₁) φ = 0,   K₁ = d/dλ K(q₀ + λ u, λ) at λ = 0,   K₀ u = −f_load
//! ```
//!
//! K₁ is the total derivative of the tangent along the linear solution u (stress and rotation effects of the initial
//! path alike), by central differences with one step of Richardson's extrapolation: the tangent is smooth, so that the
//! error is of the order of round-off over the difference step, about 1e-12.

use super::eigen::{EigenError, Pencil, largest_reciprocals};
use super::equilibrium::Equilibrium;
use crate::effect::Workspace;
use crate::linear::Matrix;
use crate::linear::symmetric::SymmetricBand;
use crate::system::System;

/// Critical loads, lowest first.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// λ at which the structure buckles, positive.
    pub load_factors: Vec<f64>,
    /// Buckling shapes as changes of the coordinates.
    pub shapes: Vec<Vec<f64>>,
    /// Factorisations made.
    pub factorizations: usize,
}

/// Displacement, in beam lengths, that round-off leaves to an inextensible beam that its load does not move.
const NOTHING_MOVES: f64 = 1e-9;
/// Turn of a node by which the tangent is differenced \[rad\].
const DIFFERENCE: f64 = 1e-3;

/// The `count` lowest positive critical load factors.
///
/// # Errors
/// [`EigenError`] where the unloaded structure is a mechanism or the loads follow.
pub fn solve(system: &System, count: usize) -> Result<Modes, EigenError> {
    if !system.is_symmetric() {
        return Err(EigenError::NotSymmetric { analysis: "buckling" });
    }
    let mut equilibrium = Equilibrium::new(system);
    let x = equilibrium.start();
    let (mut negative, mut rate) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    equilibrium.linearize(0.0, &x, None, &mut negative, &mut rate)?;
    equilibrium.solve(0.0, &mut rate, true);
    let size = equilibrium.size(&rate);
    let n = system.coordinates();
    if size == 0.0 && rate[n..].iter().all(|force| *force == 0.0) {
        return Ok(Modes::default());
    }
    // Multipliers enter the tangent in proportion: where nothing moves, any difference is exact.
    let h = if size > NOTHING_MOVES { DIFFERENCE / size } else { 1.0 };
    if h != 1.0 && system.has_nonlinear_constraints() {
        return Err(EigenError::Deforms);
    }
    let mut workspace = Workspace::default();
    let mut tangent_at = |load: f64| {
        let x: Vec<f64> = x.iter().zip(&rate).map(|(x, r)| x + load * r).collect();
        let (q, multipliers) = x.split_at(n);
        let mut k = system.matrix();
        let mut force = vec![0.0; n];
        system.force_and_tangent(load, q, None, &mut force, &mut k, &mut workspace);
        system.add_constraint_stiffness(multipliers, &mut k);
        system.supports().turn_matrix(0.0, &mut k);
        k
    };
    let mut geometric = tangent_at(0.0);
    geometric.clear();
    // −(4 D(h/2) − D(h))/3 with D the central difference quotient.
    for (at, weight) in [(0.5, -4.0 / 3.0), (-0.5, 4.0 / 3.0), (1.0, 1.0 / 6.0), (-1.0, -1.0 / 6.0)] {
        if let (Matrix::Symmetric(sum), Matrix::Symmetric(k)) = (&mut geometric, &tangent_at(at * h)) {
            SymmetricBand::add(sum, weight / h, k);
        }
    }
    system.supports().eliminate(0.0, &mut geometric);
    system.supports().clear_held(0.0, &mut geometric);
    let mut stiffness = tangent_at(0.0);
    system.supports().eliminate(0.0, &mut stiffness);
    let (border, held) = (system.border(0.0, system.reference()), system.held());
    let pencil = Pencil { a: &stiffness, b: &geometric, border: &border, held: &held };
    let pairs = largest_reciprocals(&pencil, count)?;
    let shapes = pairs.vectors.into_iter().map(|mut v| {
        system.supports().from_frames(0.0, &mut v);
        v
    });
    Ok(Modes {
        load_factors: pairs.reciprocals.iter().map(|r| 1.0 / r).collect(),
        shapes: shapes.collect(),
        factorizations: 2,
    })
}
