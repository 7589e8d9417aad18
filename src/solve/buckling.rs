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
//!
//! On short cells the entries of K₀ have lost the digits of soft motions. Shapes are therefore corrected by products with K₀
//! that are evaluated without a matrix, and 1/λ is Rayleigh's quotient ([`super::eigen::corrected`]). What round-off may still
//! change comes with the results; where it hides every load factor, there is an error.

use super::eigen::{
    CERTAIN, Corrected, EigenError, Pairs, Pencil, corrected, errors, largest_reciprocals, round_off,
};
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
    /// What round-off may change each load factor by at most, relative to it.
    pub round_off: Vec<f64>,
    /// The load factor above which round-off hides others, where fewer were found than were wanted.
    pub hidden: Option<f64>,
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

/// Vectors computed beyond the wanted ones.
const GUARD: usize = 4;
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
    let pairs =
        largest_reciprocals(&pencil, count, GUARD).or_else(|_| largest_reciprocals(&pencil, count, 0));
    // The stress-free state is stable: what is said against it is the round-off of its stiffness.
    let stress_free = !system.is_taken_up() && !system.is_stressed_at_start(STRESSING);
    let (mut turn, mut strain) = (0.0_f64, 0.0_f64);
    for (rate, node) in nodes(&rate[..n]).zip(nodes(q)) {
        let ([x, y], [dx, dy]) = (node.gradient, rate.gradient);
        let squared = x * x + y * y;
        turn = turn.max((x * dy - y * dx).abs() / squared);
        strain = strain.max((x * dx + y * dy).abs() / squared);
    }
    let pairs = match pairs {
        // Load factors at which beams would be crushed before do not matter.
        Err(EigenError::NotConverged { largest, .. }) if strain > largest => Pairs::default(),
        Err(EigenError::Unstable { .. }) if stress_free => {
            return Err(EigenError::HiddenLoads { above: 0.0 });
        }
        pairs => pairs?,
    };
    // K₀ has lost digits where cells are short. Its products without a matrix have not.
    let product = |v: &[f64]| {
        let (mut v, mut f) = (v.to_vec(), vec![0.0; n]);
        system.supports().from_frames(0.0, &mut v);
        system.tangent_product(0.0, q, &v, &mut f);
        system.add_winding_tangent_product(&variables, q, &v, &mut f);
        system.add_constraint_stiffness_product(q, &x[n..], &v, &mut f);
        system.supports().to_frames(0.0, &mut f);
        f
    };
    let inverse = |force: &[f64]| {
        let mut change = force.to_vec();
        change.resize(x.len(), 0.0);
        equilibrium.solve(0.0, &mut change, false);
        change.truncate(n);
        system.supports().to_frames(0.0, &mut change);
        change
    };
    let of_geometric = |shape: &[f64]| round_off(within.as_ref().unwrap_or(&geometric), shape);
    // A load that compresses nothing has reciprocals that are the round-off of B alone.
    let mut load = vec![0.0; n];
    system.add_load_rate(1.0, 0.0, q, &mut load);
    let least = ROUND_OFF * system.norm(&load) / system.stiffness();
    let real = |(reciprocal, shape): &(f64, Vec<f64>)| *reciprocal > least.max(CERTAIN * of_geometric(shape));
    let pairs: Vec<(f64, Vec<f64>)> =
        pairs.reciprocals.into_iter().zip(pairs.vectors).take_while(real).collect();
    // The one after the last tells how well that is known.
    let found = corrected(&pencil, pairs, count + 1, &product, &inverse);
    let errors = errors(&found);
    // What balances nothing in the state itself: in the stress-free one the round-off of strains.
    let prestress =
        if system.is_taken_up() { 0.0 } else { system.force_at_start(STRESSING) / system.norm(&load) };
    let unbalanced = nodes(&negative[..n]).map(|node| node.shift()).fold(0.0, f64::max);
    let stressed = match (prestress > 0.0, stress_free) {
        (true, _) => 0.0,
        (_, true) => system.stress_round_off() * system.length(),
        _ => unbalanced * system.length(),
    };
    // What 1/λ = φᵀ B φ, with φᵀ K₀ φ = 1, may err by: by the round-off of B, of the products with K₀, in which that of a
    // position acts once and in its square, and of the state's stress.
    let deviation = |reciprocal: f64, error: f64, shape: &[f64]| {
        let entries = shape.iter().enumerate().map(|(i, v)| stiffness.get(i, i).abs() * v * v);
        let of_products = f64::EPSILON * entries.sum::<f64>().sqrt();
        let slope = nodes(shape).map(|node| node.slope()).fold(0.0, f64::max);
        let of_stiffness = of_products * (2.0 + of_products);
        CERTAIN * (of_geometric(shape) + reciprocal * of_stiffness)
            + reciprocal * stressed * slope * slope
            + error
    };
    let (mut load_factors, mut shapes) = (Vec::new(), Vec::new());
    let (mut of_factors, mut hidden) = (Vec::new(), None);
    for (Corrected { reciprocal, vector: mut shape, .. }, error) in found.into_iter().zip(errors).take(count)
    {
        let deviation = deviation(reciprocal, error, &shape);
        if reciprocal <= deviation || deviation.is_nan() {
            // Load factors at which beams would be crushed before do not matter.
            hidden = Some(1.0 / deviation).filter(|above| above * strain < 1.0);
            break;
        }
        load_factors.push(1.0 / reciprocal);
        of_factors.push(deviation / reciprocal);
        system.supports().from_frames(0.0, &mut shape);
        shapes.push(shape);
    }
    if let Some(above) = hidden.filter(|_| load_factors.is_empty()) {
        return Err(EigenError::HiddenLoads { above });
    }
    let change = |factor: &f64| {
        let step: Vec<f64> = rate[..n].iter().map(|rate| factor * rate).collect();
        let moved: Vec<f64> = q.iter().zip(&step).map(|(q, step)| q + step).collect();
        let mut changed: Vec<f64> = load.iter().map(|load| -load).collect();
        system.add_load_rate(1.0, 0.0, &moved, &mut changed);
        system.relative(&changed, system.norm(&load)).max(system.change_of_stiffness(q, &step))
    };
    let changes = load_factors.iter().map(change).collect();
    Ok(Modes {
        load_factors,
        shapes,
        turn,
        strain,
        changes,
        prestress,
        round_off: of_factors,
        hidden,
        factorizations: 2,
    })
}
