//! Natural frequencies and mode shapes of small vibrations about an equilibrium: K φ = ω² M φ.
//!
//! K is the tangent of all forces there, so that stress and loads stiffen or soften the structure;
//! about the stress-free state it is the linear stiffness, and loads take no part. Motions that a
//! support or a constraint row forbids are left out.
//!
//! The matrix that is inverted is K + σ M, with σ of the order of the lowest ω² and well above
//! round-off: it is definite even for free bodies, whose rigid motions have ω = 0. On a fine mesh
//! the entries of K have lost digits (with N elements, up to N⁴ round-offs). So frequencies and
//! shapes are then computed from K itself, whose products are evaluated without a matrix, in the
//! space of the vectors found (Rayleigh and Ritz). With 10 000 elements this leaves an error of at
//! most 1e-5 in the first frequency of a clamped beam, where the matrix alone leaves 5e-2. A
//! frequency that cannot be told from zero is set to zero where a motion without deformation may
//! have it, and refused else.

use super::eigen::{
    CERTAIN, Corrected, EigenError, Pencil, corrected, dot, errors, largest_reciprocals, ritz, round_off,
    settled,
};
use crate::assembly::{InternalVariables, Workspace, nodes};
use crate::linear::{Factor, Matrix};
use crate::system::System;
use std::f64::consts::TAU;

/// Vibrations, lowest first.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// f = ω/2π \[Hz\]; zero where nothing resists the motion.
    pub frequencies: Vec<f64>,
    /// Mode shapes φ as changes of the coordinates; φᵀ M φ = 1 kg m².
    pub shapes: Vec<Vec<f64>>,
    /// What round-off may change each frequency by at most, relative to it.
    pub round_off: Vec<f64>,
    /// Factorisations made.
    pub factorizations: usize,
}

/// The `count` lowest vibrations about the equilibrium `x` (coordinates, then scaled multipliers)
/// at load factor `load`, motions without resistance included. At load factor 0 the loads are
/// absent. `variables` are those of the equilibrium; friction takes no part.
///
/// # Errors
/// [`EigenError`] where the state is unstable or the loads have no symmetric tangent.
pub fn solve(
    system: &System,
    load: f64,
    x: &[f64],
    variables: &InternalVariables,
    count: usize,
) -> Result<Modes, EigenError> {
    let supports = system.supports();
    let (q, multipliers) = x.split_at(system.coordinates());
    let mut stiffness = if load == 0.0 {
        system.internal_tangent(q)
    } else if system.is_symmetric() {
        let (mut stiffness, mut force) = (system.matrix(), vec![0.0; q.len()]);
        system.force_and_tangent(load, q, None, &mut force, &mut stiffness, &mut Workspace::default());
        stiffness
    } else {
        return Err(EigenError::NotSymmetric { analysis: "modal" });
    };
    system.add_winding_tangent(variables, q, &mut stiffness);
    system.add_constraint_stiffness(q, multipliers, &mut stiffness);
    let mut mass = system.mass_matrix();
    system.add_turning_mass(q, &mut mass);
    for matrix in [&mut stiffness, &mut mass] {
        supports.turn_matrix(load, matrix);
        supports.eliminate(load, matrix);
    }
    supports.clear_fixed(load, &mut mass);
    let shift = SHIFT * system.lowest_vibration_scale() + STAND_OUT * noise(&stiffness, &mass);
    let mut shifted = stiffness.clone();
    shifted.add(shift, &mass);
    let (border, fixed) = (system.border(load, q), system.fixed());
    let pencil = Pencil { a: &shifted, b: &mass, border: &border, fixed };
    let pairs = largest_reciprocals(&pencil, count, GUARD)?;
    if pairs.vectors.is_empty() {
        return Err(EigenError::NotConverged { found: 0, wanted: count, largest: f64::INFINITY });
    }
    let product = |vector: &[f64]| {
        let (mut v, mut f) = (vector.to_vec(), vec![0.0; q.len()]);
        supports.from_frames(load, &mut v);
        system.tangent_product(load, q, &v, &mut f);
        system.add_winding_tangent_product(variables, q, &v, &mut f);
        system.add_constraint_stiffness_product(q, multipliers, &v, &mut f);
        supports.to_frames(load, &mut f);
        f
    };
    let mut modes = Modes { factorizations: 1, ..Modes::default() };
    let stiff: Vec<Vec<f64>> = pairs.vectors.iter().map(|vector| product(vector)).collect();
    let heavy: Vec<Vec<f64>> = pairs.vectors.iter().map(|vector| mass.product(vector)).collect();
    let pairs = ritz(&pairs.vectors, &stiff, &heavy)?;
    // What the entries of K lose.
    let lost: Vec<f64> =
        pairs.iter().take(count).map(|(_, shape)| CERTAIN * round_off(&stiffness, shape)).collect();
    // ω², what it may err by, and φ.
    let mut found: Vec<(f64, f64, Vec<f64>)> =
        if pairs.iter().zip(&lost).any(|((square, _), off)| *off > LOST * square) {
            let factor = Factor::new(&shifted, &border)?;
            modes.factorizations += 1;
            corrected_modes(&pencil, pairs, shift, &stiffness, &product, &factor)
        } else {
            pairs.into_iter().zip(lost).map(|((square, shape), off)| (square, off, shape)).collect()
        };
    let mut unstable = 0;
    let mut hidden = Vec::new();
    found.truncate(count);
    // What loads may add to the stiffness of a motion that turns beams.
    let loaded =
        if load != 0.0 && system.has_loads() { Some(system.internal_force(q, |_| true)) } else { None };
    // Of the stress-free structure it is known how many motions nothing resists.
    let free = if load == 0.0 { system.rigid_motions().unwrap_or(0) } else { 0 };
    for (number, (square, off, mut shape)) in found.into_iter().enumerate() {
        // Round-off changes the stress of the state, too.
        let turned = system.length() * slope(&shape).powi(2);
        let likely = off + system.stress_round_off() * turned;
        let worst = off + system.round_off() * turned;
        let zero = if number < free { worst } else { likely };
        unstable += usize::from(square < -worst);
        // Where round-off may hide what loads resist with, a motion without a frequency may have one.
        let turns = turned > TURNS * size(&shape).powi(2) / system.length();
        let hides = turns && loaded.is_some_and(|force| zero > KNOWN * force * turned);
        point_up(&mut shape);
        supports.from_frames(load, &mut shape);
        if square <= zero {
            hidden.push(zero.sqrt() / TAU);
        }
        modes.round_off.push(match () {
            () if square > zero => zero / (2.0 * square),
            () => f64::from(hides),
        });
        modes.frequencies.push(if square > zero { square.sqrt() / TAU } else { 0.0 });
        modes.shapes.push(shape);
    }
    if unstable > 0 {
        return Err(EigenError::Unstable { count: unstable });
    }
    // Motions without deformation have no frequency; what deforms has one, however small.
    match system.free_motions().and_then(|free| Some((free, *hidden.get(free)?))) {
        Some((free, below)) => Err(EigenError::Hidden { number: free + 1, below, free }),
        None => Ok(modes),
    }
}

/// σ in units of EI/(ρA L⁴): less than the lowest ω² of a cantilever, 12.4, and enough to stand out
/// of round-off.
const SHIFT: f64 = 10.0;
/// Vectors computed beyond the wanted ones, which would otherwise be mixed with modes left out.
const GUARD: usize = 4;
/// Least ratio of the shift to the round-off of a zero ω².
const STAND_OUT: f64 = 1e3;
/// Round-off of the entries of K that is a larger part of an ω² than this is worth corrections.
const LOST: f64 = 1e-9;

/// A motion whose turns, times the length, are less than this part of its displacements is a translation.
const TURNS: f64 = 1e-3;
/// Round-off below this part of what loads resist with hides nothing of it.
const KNOWN: f64 = 1e-3;

/// ω², what it may err by, and φ with φᵀ M φ = 1 of pairs corrected by products with K + σ M that are evaluated without a matrix.
fn corrected_modes(
    pencil: &Pencil<'_>,
    found: Vec<(f64, Vec<f64>)>,
    shift: f64,
    stiffness: &Matrix,
    product: &dyn Fn(&[f64]) -> Vec<f64>,
    factor: &Factor,
) -> Vec<(f64, f64, Vec<f64>)> {
    let n = pencil.a.size();
    let shifted = |v: &[f64]| {
        let mut of_a = product(v);
        pencil.b.multiply_add(shift, v, &mut of_a);
        of_a
    };
    let inverse = |force: &[f64]| {
        let mut change = force.to_vec();
        change.resize(n + pencil.border.len(), 0.0);
        factor.solve(&mut change);
        change.truncate(n);
        change
    };
    let squares: Vec<f64> = found.iter().map(|(square, _)| *square).collect();
    // φᵀ M φ = 1, and those of `settled` have φᵀ (K + σ M) φ = 1.
    let scaled = |(square, shape): (f64, Vec<f64>)| {
        let reciprocal = (square + shift).recip();
        (reciprocal, shape.into_iter().map(|value| value * reciprocal.abs().sqrt()).collect())
    };
    let pairs = found.into_iter().map(scaled).collect();
    // Where round-off makes K + σ M indefinite, nothing is known of the pairs before it is.
    let definite = squares.iter().all(|square| square + shift > 0.0);
    let correct = if definite { settled } else { corrected };
    let corrected = correct(pencil, pairs, squares.len(), &shifted, &inverse);
    let errors = errors(&corrected);
    let mode = |((pair, error), square): ((Corrected, f64), f64)| {
        let mut shape = pair.vector;
        let size = dot(&shape, &pencil.b.product(&shape)).sqrt();
        shape.iter_mut().for_each(|value| *value /= size);
        let square = if pair.moved { dot(&shape, &product(&shape)) } else { square };
        // That of a position acts once and in its square.
        let entries = shape.iter().enumerate().map(|(i, v)| stiffness.get(i, i).abs() * v * v);
        let of_products = f64::EPSILON * entries.sum::<f64>().sqrt();
        let off = CERTAIN * of_products * (2.0 * square.abs().sqrt() + of_products);
        (square, off + error * (square.abs() + shift).powi(2), shape)
    };
    let mut modes: Vec<(f64, f64, Vec<f64>)> =
        corrected.into_iter().zip(errors).zip(squares).map(mode).collect();
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    modes
}

/// Turns the largest displacement towards positive x or y.
fn point_up(shape: &mut [f64]) {
    let displacements = nodes(shape).flat_map(|node| node.position);
    let largest = displacements.fold(0.0_f64, |a, b| if b.abs() > (1.0 + 1e-6) * a.abs() { b } else { a });
    if largest < 0.0 {
        shape.iter_mut().for_each(|value| *value = -*value);
    }
}

/// Largest displacement.
fn size(shape: &[f64]) -> f64 {
    nodes(shape).map(|node| node.shift()).fold(0.0, f64::max)
}

/// Largest change of a gradient.
fn slope(shape: &[f64]) -> f64 {
    nodes(shape).map(|node| node.slope()).fold(0.0, f64::max)
}

/// ω² \[1/s²\] that round-off gives to a translation, which has none.
fn noise(k: &Matrix, mass: &Matrix) -> f64 {
    let along = |axis: usize| {
        let shape: Vec<f64> = (0..k.size()).map(|i| if i % 4 == axis { 1.0 } else { 0.0 }).collect();
        let mut product = vec![0.0; shape.len()];
        mass.multiply_add(1.0, &shape, &mut product);
        let size = dot(&shape, &product);
        if size > 0.0 { round_off(k, &shape) / size } else { 0.0 }
    };
    along(0).max(along(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_displacement_points_up() {
        let turned = |shape: [f64; 8]| {
            let mut turned = shape;
            point_up(&mut turned);
            if turned != shape {
                assert_eq!(turned, shape.map(|x| -x));
            }
            turned != shape
        };
        // Gradients do not count, nor what is as large but for round-off and comes later.
        assert!(turned([0.0, -3.0, 9.0, 9.0, 2.0, 1.0, 9.0, 9.0]));
        assert!(turned([1.0, 2.0, 9.0, 9.0, -3.0, 1.0, 9.0, 9.0]));
        assert!(!turned([0.0, 3.0, -9.0, -9.0, -2.0, 1.0, -9.0, -9.0]));
        assert!(!turned([3.0, 0.0, 0.0, 0.0, -3.0 - 1e-9, 0.0, 0.0, 0.0]));
        assert_eq!(slope(&[7.0, 7.0, 0.0, 1.0, 7.0, 7.0, 3.0, -4.0]), 5.0);
    }

    /// Stiffnesses 3 along x and 4 along y at two nodes of masses 1 and 2: a translation has
    /// ε √2·3/3 and ε √2·4/3.
    #[test]
    fn translations_have_the_round_off_of_the_stiffness() {
        let (mut k, mut mass) = (Matrix::zeros(2, 2, true), Matrix::zeros(2, 2, true));
        for (node, m) in [(0, 1.0), (4, 2.0)] {
            k.add_at(node, node, 3.0);
            k.add_at(node + 1, node + 1, 4.0);
            k.add_at(node + 2, node + 2, 1e9);
            mass.add_at(node, node, m);
            mass.add_at(node + 1, node + 1, m);
        }
        let expected = f64::EPSILON * 2.0_f64.sqrt() * 4.0 / 3.0;
        assert!((noise(&k, &mass) / expected - 1.0).abs() < 1e-12);
        assert_eq!(noise(&k, &Matrix::zeros(2, 2, true)), 0.0);
    }
}
