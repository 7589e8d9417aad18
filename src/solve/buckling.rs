//! Linear buckling: the load factors λ at which the tangent, with the stress resultants of the
//! linear solution, becomes singular,
//!
//! ```text
//! (K₀ + λ K₁) φ = 0,   K₀ u = −f_load,   N₁ = EA ∂ε/∂q·u,   M₁ = EI ∂κ/∂q·u
//! K₁ = ∫ N₁ ∂²ε/∂q∂q + M₁ ∂²κ/∂q∂q ds + …
//! ```
//!
//! with all derivatives taken in the stress-free state, or, after another stage, in the equilibrium that it
//! has left: K₀ is then the tangent there, under all that acts already, and λ multiplies what is new. The
//! direction in which a beam resists
//! stretch is that of this state too. Its turn with the rotations of u is a first-order term that a
//! second-order term cancels; keeping the first alone would make a stiff beam in bending buckle at
//! once. An effect whose tangent extrapolates its resultants ([`crate::effect`]) gives K₀ + λ K₁
//! when it is asked for the tangent one increment λ u ahead.

use super::eigen::{EigenError, Pencil, largest_reciprocals, round_off};
use super::equilibrium::Equilibrium;
use crate::assembly::{Earlier, Kind, Workspace, nodes};
use crate::system::System;

/// Critical loads, lowest first.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// λ at which the structure buckles, positive.
    pub load_factors: Vec<f64>,
    /// Buckling shapes as changes of the coordinates.
    pub shapes: Vec<Vec<f64>>,
    /// Largest rotation of a node in the linear solution, per load factor \[rad\].
    pub turn: f64,
    /// Largest axial strain of a node in the linear solution, per load factor.
    pub strain: f64,
    /// Per load factor, by which part of themselves the loads change with the linear solution, or the
    /// stiffnesses of contacts and of loads that have acted before, whichever is larger.
    pub changes: Vec<f64>,
    /// Norm of the forces of springs and contacts that nothing balances in the state whose critical loads
    /// these are, in that of the load.
    pub prestress: f64,
    /// Factorisations made.
    pub factorizations: usize,
}

/// Load factor at which K₀ + λ K₁ is evaluated to find K₁. It is so large that the subtraction of
/// K₀ costs no digit; any factor will do, because the tangent is linear in λ.
const FAR_AHEAD: f64 = 1e18;

/// Reciprocals of load factors below this, in units of the load over the structure's stiffness, may
/// be round-off.
const ROUND_OFF: f64 = 1e-11;

/// What may act on the beams without any load.
pub const STRESSING: &[Kind] = &[Kind::Spring, Kind::Contact];

/// A reciprocal counts as different from zero if it exceeds its round-off by this many standard
/// deviations.
const CERTAIN: f64 = 10.0;

/// The coordinates and scaled multipliers of the state whose critical loads are found.
pub fn base(system: &System) -> Vec<f64> {
    if system.is_taken_up() {
        return Equilibrium::new(system).start();
    }
    let mut x = system.reference().to_vec();
    x.resize(x.len() + system.multipliers(), 0.0);
    x
}

/// The `count` lowest positive critical load factors.
///
/// # Errors
/// [`EigenError`] where the unloaded structure is a mechanism or the loads have no symmetric
/// tangent.
pub fn solve(system: &System, count: usize) -> Result<Modes, EigenError> {
    if !system.is_symmetric() {
        return Err(EigenError::NotSymmetric { analysis: "buckling" });
    }
    let mut equilibrium = Equilibrium::new(system);
    let x = base(system);
    let variables = system.start_history().1;
    let (mut negative, mut rate) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    equilibrium.linearize(0.0, &x, None, &mut negative, &mut rate)?;
    equilibrium.solve(0.0, &mut rate, true);
    let n = system.coordinates();
    let q = &x[..n];
    let mut workspace = Workspace::default();
    let mut tangent = |load: f64, increment: Option<&[f64]>, multipliers: &[f64]| {
        let (mut k, mut force) = (system.matrix(), vec![0.0; n]);
        let earlier = increment.map(|increment| Earlier { q, increment });
        system.force_and_tangent(load, q, earlier, &mut force, &mut k, &mut workspace);
        system.add_winding_tangent(&variables, q, &mut k);
        system.add_constraint_stiffness(q, multipliers, &mut k);
        system.supports().turn_matrix(0.0, &mut k);
        k
    };
    let mut stiffness = tangent(0.0, None, &x[n..]);
    let ahead: Vec<f64> = rate.iter().map(|rate| FAR_AHEAD * rate).collect();
    let mut geometric_at = |load: f64| {
        let mut geometric = tangent(load, Some(&ahead[..n]), &ahead[n..]);
        geometric.add(-1.0, &stiffness);
        geometric.scale(-1.0 / FAR_AHEAD);
        geometric
    };
    // What loads that follow the beam add may cancel what the forces within it do, but for round-off.
    let within = system.loads_have_tangents().then(|| geometric_at(0.0));
    let mut geometric = geometric_at(FAR_AHEAD);
    system.supports().eliminate(0.0, &mut geometric);
    system.supports().clear_fixed(0.0, &mut geometric);
    system.supports().eliminate(0.0, &mut stiffness);
    let (border, fixed) = (system.border(0.0, q), system.fixed());
    let pencil = Pencil { a: &stiffness, b: &geometric, border: &border, fixed };
    let mut pairs = largest_reciprocals(&pencil, count)?;
    // A load that compresses nothing gives reciprocals that are round-off alone.
    let mut load = vec![0.0; n];
    system.add_load_rate(1.0, 0.0, q, &mut load);
    let least = ROUND_OFF * system.norm(&load) / system.stiffness();
    // The standard deviation of 1/λ = φᵀ B φ, with φᵀ A φ = 1, due to the round-off of both
    // matrices.
    let known = |(reciprocal, shape): (&f64, &Vec<f64>)| {
        let of_geometric = round_off(within.as_ref().unwrap_or(&geometric), shape);
        let deviation = of_geometric + reciprocal * round_off(&stiffness, shape);
        *reciprocal > least.max(CERTAIN * deviation)
    };
    let real = pairs.reciprocals.iter().zip(&pairs.vectors).take_while(|pair| known(*pair)).count();
    pairs.reciprocals.truncate(real);
    pairs.vectors.truncate(real);
    let shapes = pairs.vectors.into_iter().map(|mut v| {
        system.supports().from_frames(0.0, &mut v);
        v
    });
    let load_factors: Vec<f64> = pairs.reciprocals.iter().map(|r| 1.0 / r).collect();
    let (mut turn, mut strain) = (0.0_f64, 0.0_f64);
    for (rate, node) in nodes(&rate[..n]).zip(nodes(q)) {
        let ([x, y], [dx, dy]) = (node.gradient, rate.gradient);
        let squared = x * x + y * y;
        turn = turn.max((x * dy - y * dx).abs() / squared);
        strain = strain.max((x * dx + y * dy).abs() / squared);
    }
    let change = |factor: &f64| {
        let step: Vec<f64> = rate[..n].iter().map(|rate| factor * rate).collect();
        let moved: Vec<f64> = q.iter().zip(&step).map(|(q, step)| q + step).collect();
        let mut changed: Vec<f64> = load.iter().map(|load| -load).collect();
        system.add_load_rate(1.0, 0.0, &moved, &mut changed);
        system.relative(&changed, system.norm(&load)).max(system.change_of_stiffness(q, &step))
    };
    let changes = load_factors.iter().map(change).collect();
    let prestress =
        if system.is_taken_up() { 0.0 } else { system.force_at_start(STRESSING) / system.norm(&load) };
    Ok(Modes { load_factors, shapes: shapes.collect(), turn, strain, changes, prestress, factorizations: 2 })
}
