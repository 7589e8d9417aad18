//! Natural frequencies and mode shapes about the stress-free state: K φ = ω² M φ.

use super::eigen::{EigenError, largest_reciprocals};
use crate::effect::Workspace;
use crate::linear::{Factor, Matrix};
use crate::system::System;
use std::f64::consts::TAU;

/// Vibrations, lowest first.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// f = ω/2π \[Hz\].
    pub frequencies: Vec<f64>,
    /// Mode shapes as changes of the coordinates.
    pub shapes: Vec<Vec<f64>>,
    /// Factorisations made.
    pub factorizations: usize,
}

/// The `count` lowest vibrations. The stiffness is shifted by a little mass, so that a free beam's rigid motions come out
/// as frequencies of zero.
///
/// # Errors
/// [`EigenError`] where the state is unstable or the loads have no symmetric tangent.
pub fn solve(system: &System, count: usize) -> Result<Modes, EigenError> {
    if !system.is_symmetric() {
        return Err(EigenError::NotSymmetric { analysis: "modal" });
    }
    let (q, n) = (system.reference(), system.coordinates());
    let mut stiffness = system.matrix();
    let mut force = vec![0.0; n];
    // Loads are absent from the linearisation about the unloaded state.
    system.force_and_tangent(0.0, q, q, &mut force, &mut stiffness, &mut Workspace::default());
    let mut mass = system.mass_matrix();
    let shift = system.lowest_vibration_scale();
    if let (Matrix::Symmetric(k), Matrix::Symmetric(m)) = (&mut stiffness, &mass) {
        k.add(shift, m);
    }
    for matrix in [&mut stiffness, &mut mass] {
        system.supports().turn_matrix(0.0, matrix);
        system.supports().eliminate(0.0, matrix);
    }
    system.supports().clear_held(0.0, &mut mass);
    let border = system.border(0.0);
    let factor = Factor::new(&stiffness, &border)?;
    if let Some(count) = factor.negative_eigenvalues().filter(|count| *count > 0) {
        return Err(EigenError::Unstable { count });
    }
    let pairs = largest_reciprocals(&stiffness, &factor, border.len(), &mass, count)?;
    let frequency = |reciprocal: &f64| (1.0 / reciprocal - shift).max(0.0).sqrt() / TAU;
    let shapes = pairs.vectors.into_iter().map(|mut v| {
        system.supports().from_frames(0.0, &mut v);
        v
    });
    Ok(Modes {
        frequencies: pairs.reciprocal.iter().map(frequency).collect(),
        shapes: shapes.collect(),
        factorizations: 1,
    })
}
