//! The equations of motion of a system, in the form that all integrators ask for.
//!
//! ```text
//! M q̈ + f(q) + Bᵀ μ = 0,   g(q) = 0,   f = f_int + f_load
//! ```
//!
//! What supports hold at nodes is eliminated from every matrix *before* it is factorised, the mass matrix included: solving with
//! the mass matrix of the free beam and clearing the held components afterwards would give wrong accelerations to all others.
//! Constraints between nodes are linear in q with constant rows, so that a method which satisfies them in its stages integrates
//! an ordinary differential equation on the subspace g(q) = 0, with all of its order.

use super::turns::Turns;
use crate::effect::Workspace;
use crate::linear::bordered::BorderRow;
use crate::linear::complex::ComplexFactor;
use crate::linear::{Factor, Matrix, Singular};
use crate::solve::equilibrium::{self, balance};
use crate::system::System;
use crate::trajectory::Statistics;
use faer::c64;

/// Loads act in full.
const LOAD: f64 = 1.0;

/// Forces, tangent and mass of a system in motion. Unknowns are the system's coordinates followed by the scaled multipliers.
pub struct Motion<'a> {
    system: &'a System,
    mass: Matrix,
    /// In the supports' frames, without the held coordinates.
    free_mass: Matrix,
    mass_factor: Factor,
    border: Vec<BorderRow>,
    /// Of the elastic forces and loads, in the supports' frames, held coordinates eliminated.
    tangent: Matrix,
    workspace: Workspace,
    force: Vec<f64>,
    scratch: Vec<f64>,
    /// Counts so far.
    pub statistics: Statistics,
}

impl<'a> Motion<'a> {
    /// The equations of motion of `system`, which must have been built with inertia.
    ///
    /// # Errors
    /// [`Singular`] where a coordinate has no mass.
    pub fn new(system: &'a System) -> Result<Self, Singular> {
        let n = system.coordinates();
        let mass = system.mass_matrix();
        let mut free_mass = mass.clone();
        system.supports().turn_matrix(LOAD, &mut free_mass);
        let border = system.border(LOAD);
        let mut eliminated = free_mass.clone();
        system.supports().eliminate(LOAD, &mut eliminated);
        let mass_factor = Factor::new(&eliminated, &border)?;
        system.supports().clear_held(LOAD, &mut free_mass);
        Ok(Self {
            system,
            mass,
            free_mass,
            mass_factor,
            border,
            tangent: system.matrix(),
            workspace: Workspace::default(),
            force: vec![0.0; n],
            scratch: vec![0.0; n + system.multipliers()],
            statistics: Statistics { factorizations: 1, ..Statistics::default() },
        })
    }

    /// The system that moves.
    pub fn system(&self) -> &'a System {
        self.system
    }

    /// Turns of the nodes, for a tangent that turns with them.
    pub fn turns(&self) -> Turns {
        Turns::new(self.coordinates() / 4, self.system.supports().half_held().collect())
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.system.coordinates()
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.system.coordinates() + self.system.multipliers()
    }

    /// q̈ in the state `q`.
    pub fn acceleration(&mut self, q: &[f64], acceleration: &mut [f64]) {
        let n = self.coordinates();
        self.statistics.residual_evaluations += 1;
        self.system.force(LOAD, q, &mut self.scratch[..n]);
        self.scratch.iter_mut().for_each(|f| *f = -*f);
        self.scratch[n..].fill(0.0);
        self.system.supports().to_frames(LOAD, &mut self.scratch[..n]);
        self.mass_factor.solve(&mut self.scratch);
        self.system.supports().from_frames(LOAD, &mut self.scratch[..n]);
        acceleration.copy_from_slice(&self.scratch[..n]);
    }

    /// The velocity nearest to `v`, in the norm of the kinetic energy, that supports and constraints allow.
    pub fn admissible_velocity(&self, v: &[f64]) -> Vec<f64> {
        let n = self.coordinates();
        let mut right = vec![0.0; self.unknowns()];
        let mut free = v.to_vec();
        self.system.supports().to_frames(LOAD, &mut free);
        self.free_mass.multiply_add(1.0, &free, &mut right[..n]);
        self.mass_factor.solve(&mut right);
        self.system.supports().from_frames(LOAD, &mut right[..n]);
        right.truncate(n);
        right
    }

    /// Writes −(M a + f(q) + Bᵀμ) and −g to `negative`, in the supports' frames; returns the scaled residual.
    pub fn residual(&mut self, x: &[f64], a: &[f64], negative: &mut [f64]) -> f64 {
        let n = self.coordinates();
        self.statistics.residual_evaluations += 1;
        self.system.force(LOAD, &x[..n], &mut self.force);
        self.finish(x, a, negative)
    }

    /// The same, and the tangent ∂f/∂q with stress resultants extrapolated from the iterate `before`.
    pub fn linearize(&mut self, x: &[f64], before: &[f64], a: &[f64], negative: &mut [f64]) -> f64 {
        self.statistics.residual_evaluations += 1;
        self.assemble(x, before);
        self.finish(x, a, negative)
    }

    /// The tangent ∂f/∂q at `q`.
    pub fn tangent_at(&mut self, q: &[f64]) {
        self.assemble(q, q);
    }

    fn assemble(&mut self, x: &[f64], before: &[f64]) {
        let n = self.coordinates();
        let Self { system, force, tangent, workspace, .. } = self;
        system.force_and_tangent(LOAD, &x[..n], &before[..n], force, tangent, workspace);
        system.supports().turn_matrix(LOAD, tangent);
        system.supports().eliminate(LOAD, tangent);
        self.statistics.tangent_evaluations += 1;
    }

    fn finish(&mut self, x: &[f64], a: &[f64], negative: &mut [f64]) -> f64 {
        let add_inertia = |force: &mut [f64]| self.mass.multiply_add(1.0, a, force);
        balance(self.system, LOAD, x, &mut self.force, add_inertia, negative)
    }

    /// Factorises K + c M with the last tangent K.
    ///
    /// # Errors
    /// [`Singular`] where it has no inverse.
    pub fn factorize(&mut self, c: f64, earlier: Option<Factor>) -> Result<Factor, Singular> {
        self.statistics.factorizations += 1;
        Factor::shifted(earlier, &self.tangent, (c, &self.free_mass), &self.border)
    }

    /// Factorises K + ζ M with the last tangent K.
    ///
    /// # Errors
    /// [`Singular`] where it has no inverse.
    pub fn factorize_complex(
        &mut self,
        zeta: c64,
        earlier: Option<ComplexFactor>,
    ) -> Result<ComplexFactor, Singular> {
        self.statistics.factorizations += 1;
        ComplexFactor::again(earlier, &self.tangent, &self.free_mass, zeta, &self.border)
    }

    /// Multiplies by the mass matrix without the held coordinates: `b += factor · M d`, both in the supports' frames.
    pub fn multiply_free_mass(&self, factor: f64, d: &[f64], b: &mut [f64]) {
        let n = self.coordinates();
        self.free_mass.multiply_add(factor, &d[..n], &mut b[..n]);
    }

    /// Turns a vector of coordinates into the supports' frames and clears what is held.
    pub fn to_frames(&self, v: &mut [f64]) {
        let n = self.coordinates();
        self.system.supports().to_frames(LOAD, &mut v[..n]);
    }

    /// Turns a vector of coordinates back from the supports' frames.
    pub fn from_frames(&self, v: &mut [f64]) {
        let n = self.coordinates();
        self.system.supports().from_frames(LOAD, &mut v[..n]);
    }

    /// Sets the held coordinates.
    pub fn impose(&self, q: &mut [f64]) {
        let n = self.coordinates();
        self.system.supports().impose(LOAD, &mut q[..n]);
    }

    /// Root mean square over the nodes of the change of their positions, in beam lengths.
    pub fn distance(&self, change: &[f64]) -> f64 {
        let n = self.coordinates();
        let sum: f64 = change[..n].chunks_exact(4).map(|d| d[0] * d[0] + d[1] * d[1]).sum();
        (sum / (n / 4) as f64).sqrt() / self.system.length()
    }

    /// Largest nodal change: positions in beam lengths, gradients as they are.
    pub fn size(&self, increment: &[f64]) -> f64 {
        equilibrium::size(self.system, increment)
    }
}
