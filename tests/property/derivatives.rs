//! Forces are derivatives of energies and tangents of forces, at random states: the assembled
//! vectors and matrices against dual numbers, effect by effect, with the energies written down a
//! second time here from their formulas.

use super::generators::{beam, clamp, free, noise, perturbed};
use ancf::assembly::{Earlier, Needs, Part, Workspace};
use ancf::basis::{Basis, BasisTable, Quadrature};
use ancf::effect::{DistributedForce, Force, Gravity, Moment};
use ancf::model::{Beam, Model, Place, StrainMeasure};
use ancf::system::System;
use nalgebra::{DVector, Dyn};
use num_dual::{Dual2Vec, DualNum, DualVec, hessian, jacobian};
use proptest::prelude::*;
use std::sync::Arc;

/// Local fields r⁽ᵒ⁾ of all points of a table, with their weights.
fn fields<T: DualNum<Primitive = f64, InnerDual = f64>>(
    table: &BasisTable,
    q: &DVector<T>,
) -> Vec<(f64, Vec<[T; 2]>)> {
    let mut out = Vec::new();
    for cell in &table.cells {
        let (weights, rows) = table.block(*cell);
        for (weight, rows) in weights.iter().zip(rows.chunks_exact(table.row_stride())) {
            let combine = |row: &[f64], d: usize| {
                row.iter()
                    .enumerate()
                    .map(|(a, n)| q[2 * (cell.first as usize + a) + d].clone() * *n)
                    .fold(T::from_re(0.0), |sum, term| sum + term)
            };
            let z = rows.chunks_exact(table.width).map(|row| [combine(row, 0), combine(row, 1)]).collect();
            out.push((*weight, z));
        }
    }
    out
}

fn strain<T: DualNum<Primitive = f64, InnerDual = f64>>(measure: StrainMeasure, r: &[T; 2]) -> T {
    let square = r[0].clone() * r[0].clone() + r[1].clone() * r[1].clone();
    match measure {
        StrainMeasure::Green => (square - 1.0) * 0.5,
        StrainMeasure::Engineering => square.sqrt() - 1.0,
    }
}

fn curvature<T: DualNum<Primitive = f64, InnerDual = f64>>(z: &[[T; 2]]) -> T {
    let [r, s] = z else { unreachable!("a curvature needs r' and r''") };
    let cross = r[0].clone() * s[1].clone() - r[1].clone() * s[0].clone();
    cross / (r[0].clone() * r[0].clone() + r[1].clone() * r[1].clone())
}

/// ½∫ EA (ε − ε₀)² + ½∫ EI (κ − κ₀)².
fn elastic<T: DualNum<Primitive = f64, InnerDual = f64>>(
    beam: &Beam,
    basis: &Basis,
    reference: &[f64],
    q: &DVector<T>,
) -> T {
    let table =
        |n: usize, orders: &[usize]| basis.table(Quadrature::Gauss(n), orders).expect("a legal table");
    let (first, both) = (table(beam.gauss_points.stretch, &[1]), table(beam.gauss_points.bend, &[1, 2]));
    let reference = DVector::from_column_slice(reference);
    let ea = beam.section.axial_stiffness.as_ref().and_then(ancf::model::Along::constant).unwrap_or(0.0);
    let ei = beam.section.bending_stiffness.as_ref().and_then(ancf::model::Along::constant).unwrap_or(0.0);
    let mut energy = T::from_re(0.0);
    for ((weight, z), (_, z0)) in fields(&first, q).into_iter().zip(fields(&first, &reference)) {
        let e = strain(beam.strain, &z[0]) - strain(beam.strain, &z0[0]);
        energy += e.clone() * e * (0.5 * ea * weight);
    }
    for ((weight, z), (_, z0)) in fields(&both, q).into_iter().zip(fields(&both, &reference)) {
        let k = curvature(&z) - curvature(&z0);
        energy += k.clone() * k * (0.5 * ei * weight);
    }
    energy
}

/// Force and tangent of the system at q, dense.
fn assembled(system: &System, load: f64, q: &[f64]) -> (DVector<f64>, nalgebra::DMatrix<f64>) {
    let n = q.len();
    let mut force = vec![0.0; n];
    let mut tangent = system.matrix();
    system.force_and_tangent(load, q, None, &mut force, &mut tangent, &mut Workspace::default());
    let mut alone = vec![0.0; n];
    system.force(load, q, &mut alone);
    let scale = force.iter().fold(1e-300_f64, |m, f| m.max(f.abs()));
    for (a, b) in force.iter().zip(&alone) {
        assert!((a - b).abs() <= 1e-12 * scale, "force with tangent {a}, without {b}");
    }
    (force.into(), nalgebra::DMatrix::from_fn(n, n, |i, j| tangent.get(i, j)))
}

fn close(what: &str, ours: &nalgebra::DMatrix<f64>, reference: &nalgebra::DMatrix<f64>, tolerance: f64) {
    // Relative to each row's and column's own size: entries of positions and gradients have
    // different units.
    let size = |i: usize| reference.row(i).amax().max(reference.column(i.min(reference.ncols() - 1)).amax());
    let largest = reference.amax();
    for i in 0..reference.nrows() {
        for j in 0..reference.ncols() {
            let scale = size(i).max(1e-9 * largest);
            let error = (ours[(i, j)] - reference[(i, j)]).abs();
            assert!(
                error <= tolerance * scale,
                "{what}[{i}, {j}] is {}, dual numbers give {} (row's scale {scale:.3e})",
                ours[(i, j)],
                reference[(i, j)]
            );
        }
    }
}

fn column(v: DVector<f64>) -> nalgebra::DMatrix<f64> {
    nalgebra::DMatrix::from_column_slice(v.len(), 1, v.as_slice())
}

/// Virtual work of a load as generalised forces f(q) (negative work: the system's sign).
fn load_forces<T: DualNum<Primitive = f64, InnerDual = f64>>(
    basis: &Basis,
    table: &BasisTable,
    q: &DVector<T>,
    density: impl Fn(usize, &[[T; 2]]) -> Vec<[T; 2]>,
) -> DVector<T> {
    let mut f = DVector::from_element(2 * basis.coefficients(), T::from_re(0.0));
    let mut point = 0;
    let all = fields(table, q);
    for cell in &table.cells {
        let (weights, rows) = table.block(*cell);
        for (weight, rows) in weights.iter().zip(rows.chunks_exact(table.row_stride())) {
            let g = density(point, &all[point].1);
            for (row, g) in rows.chunks_exact(table.width).zip(g) {
                for (a, n) in row.iter().enumerate() {
                    for d in 0..2 {
                        f[2 * (cell.first as usize + a) + d] += g[d].clone() * (n * weight);
                    }
                }
            }
            point += 1;
        }
    }
    f
}

fn with_load(beam: &Beam, load: Arc<dyn Part>) -> System {
    let elastic_free = Beam {
        section: ancf::model::Section { mass_per_length: Some(1.3.into()), ..Default::default() },
        ..beam.clone()
    };
    let model = Model { beams: vec![elastic_free], supports: vec![], parts: vec![load], ..Model::default() };
    System::build(&model, Needs { inertia: false, motion: false }).expect("a legal system")
}

/// Compares a load's force and tangent with dual numbers.
fn check_load(
    beam: &Beam,
    load: Arc<dyn Part>,
    noise: &[f64],
    orders: &[usize],
    at: Option<f64>,
    density: impl Fn(usize, &[[DualVec<f64, Dyn>; 2]]) -> Vec<[DualVec<f64, Dyn>; 2]>,
) {
    let system = with_load(beam, load);
    let basis = &system.beams()[0].basis;
    let points = beam.gauss_points.stretch.max(4);
    let table = match at {
        Some(s) => basis.points(&[s], orders),
        None => basis.table(Quadrature::Gauss(points), orders),
    }
    .expect("a legal table");
    let q = perturbed(&system, 0.3, noise);
    let factor = 0.7;
    let (force, tangent) = assembled(&system, factor, &q);
    let forces =
        |q: DVector<DualVec<f64, Dyn>>| load_forces(basis, &table, &q, &density) * DualVec::from_re(factor);
    let (expected, jacobian) = jacobian(forces, &DVector::from_column_slice(&q));
    close("load", &column(force), &column(expected), 1e-11);
    close("load tangent", &tangent, &jacobian, 1e-10);
}

proptest! {
    #![proptest_config(super::cases(24))]

    #[test]
    fn elastic_force_and_tangent_are_derivatives_of_the_energy(beam in beam(), noise in noise()) {
        let system = free(&beam);
        let q = perturbed(&system, 0.3, &noise);
        let energy = |q: DVector<Dual2Vec<f64, Dyn>>| {
            elastic(&beam, &system.beams()[0].basis, system.reference(), &q)
        };
        let (value, gradient, hessian) = hessian(energy, &DVector::from_column_slice(&q));
        let ours = system.energy(1.0, &q, None);
        prop_assert!((ours.stretch + ours.bend - value).abs() <= 1e-11 * value.abs().max(1e-12));
        let (force, tangent) = assembled(&system, 1.0, &q);
        close("force", &column(force), &column(gradient), 1e-10);
        close("tangent", &tangent, &hessian, 1e-10);
    }

    #[test]
    fn dead_moment(beam in beam(), noise in noise(), value in -5.0..5.0, share in 0.0..1.0) {
        let s = share * free(&beam).beams()[0].basis.length();
        let load = Arc::new(Moment { at: Place { beam: 0, s }, value, law: None });
        check_load(&beam, load, &noise, &[1], Some(s), |_, z| {
            let [x, y] = z[0].clone();
            let factor = (x.clone() * x.clone() + y.clone() * y.clone()).recip() * -value;
            vec![[-y * factor.clone(), x * factor]]
        });
    }

    #[test]
    fn follower_force(beam in beam(), noise in noise(), fx in -5.0..5.0, fy in -5.0..5.0, share in 0.0..1.0) {
        let system = free(&beam);
        let basis = &system.beams()[0].basis;
        let s = share * basis.length();
        // Turned by the angle between the gradients now and in the reference.
        let rows = basis.points(&[s], &[1]).expect("on the beam");
        let start = fields(&rows, &DVector::from_column_slice(system.reference()))[0].1[0];
        let load = Arc::new(Force::following(Place { beam: 0, s }, [fx, fy]));
        check_load(&beam, load, &noise, &[0, 1], Some(s), |_, z| {
            let turned = turned([fx, fy], start, &z[1]);
            vec![turned, [DualVec::from_re(0.0), DualVec::from_re(0.0)]]
        });
    }

    #[test]
    fn follower_distributed_force(beam in beam(), noise in noise(), fx in -5.0..5.0, fy in -5.0..5.0) {
        let system = free(&beam);
        let basis = &system.beams()[0].basis;
        let points = beam.gauss_points.stretch.max(4);
        let rows = basis.table(Quadrature::Gauss(points), &[1]).expect("a legal table");
        let start = fields(&rows, &DVector::from_column_slice(system.reference()));
        let load = Arc::new(DistributedForce { beam: 0, value: [fx, fy].map(Into::into), follower: true, law: None });
        check_load(&beam, load, &noise, &[0, 1], None, |point, z| {
            let turned = turned([fx, fy], start[point].1[0], &z[1]);
            vec![turned, [DualVec::from_re(0.0), DualVec::from_re(0.0)]]
        });
    }

    #[test]
    fn dead_forces_and_gravity(beam in beam(), noise in noise(), fx in -5.0..5.0, fy in -5.0..5.0, share in 0.0..1.0) {
        let s = share * free(&beam).beams()[0].basis.length();
        let constant = move |scale: f64| vec![[fx, fy].map(|f: f64| DualVec::<f64, Dyn>::from_re(-f * scale))];
        let force = Arc::new(Force::new(Place { beam: 0, s }, [fx, fy]));
        check_load(&beam, force, &noise, &[0], Some(s), |_, _| constant(1.0));
        let distributed = Arc::new(DistributedForce { beam: 0, value: [fx, fy].map(Into::into), follower: false, law: None });
        check_load(&beam, distributed, &noise, &[0], None, |_, _| constant(1.0));
        let gravity = Arc::new(Gravity::new([fx, fy]));
        check_load(&beam, gravity, &noise, &[0], None, |_, _| constant(1.3));
    }

    #[test]
    fn potential_of_dead_loads_is_their_negative_work(beam in beam(), noise in noise(), fx in -5.0..5.0) {
        let load = Arc::new(Force::new(Place { beam: 0, s: 0.0 }, [fx, 2.0]));
        let model = Model { beams: vec![beam], supports: vec![clamp()], parts: vec![load], ..Model::default() };
        let system = System::build(&model, Needs { inertia: false, motion: false }).expect("a legal system");
        let q = perturbed(&system, 0.3, &noise);
        let (dx, dy) = (q[0] - system.reference()[0], q[1] - system.reference()[1]);
        let work = fx * dx + 2.0 * dy;
        prop_assert!((system.energy(0.5, &q, None).potential + 0.5 * work).abs() <= 1e-13 * (1.0 + work.abs()));
    }

    /// With extrapolated stress resultants the tangent is that of the mixed problem: at z⁻ = z it
    /// is the ordinary one, and along z − z⁻ it differs by the resultants' error, which is of
    /// second order.
    #[test]
    fn extrapolated_tangent_tends_to_the_ordinary_one(beam in beam(), noise in noise()) {
        let system = free(&beam);
        let q = perturbed(&system, 0.2, &noise);
        let n = q.len();
        let difference = |size: f64| {
            let shifted = noise.iter().cycle().skip(7);
            let before: Vec<f64> = q.iter().zip(shifted).map(|(q, d)| q + size * d).collect();
            let tangent = |before: &[f64]| {
                let mut k = system.matrix();
                let increment: Vec<f64> = q.iter().zip(before).map(|(q, before)| q - before).collect();
                let earlier = Some(Earlier { q: before, increment: &increment });
                system.force_and_tangent(1.0, &q, earlier, &mut vec![0.0; n], &mut k, &mut Workspace::default());
                nalgebra::DMatrix::from_fn(n, n, |i, j| k.get(i, j))
            };
            (tangent(&before) - tangent(&q)).norm()
        };
        let ratio = difference(1e-4) / difference(5e-5);
        prop_assert!((ratio - 4.0).abs() < 0.2, "halving the distance divides the difference by {ratio}");
    }
}

/// R(θ − θ₀) F, negative: the force of a follower in the system's sign.
fn turned(force: [f64; 2], start: [f64; 2], now: &[DualVec<f64, Dyn>; 2]) -> [DualVec<f64, Dyn>; 2] {
    let angle = now[1].atan2(now[0].clone()) - start[1].atan2(start[0]);
    let (sine, cosine) = angle.sin_cos();
    [-(cosine.clone() * force[0] - sine.clone() * force[1]), -(sine * force[0] + cosine * force[1])]
}
