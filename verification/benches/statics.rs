//! What statics cost: one Newton iteration, a whole roll-up, the tables of radial point
//! interpolation, and the factorisations against each other. `cargo bench -p ancf-verification`.

use ancf::assembly::Needs;
use ancf::effect::Moment;
use std::hint::black_box;

use ancf::basis::{Basis, Quadrature};
use ancf::linear::Matrix;
use ancf::linear::band::BandLu;
use ancf::linear::bordered::Bordered;
use ancf::linear::symmetric::Ldl;
use ancf::model::{
    Analysis, Beam, Centreline, Discretization, Fixed, FixedRotation, GaussPoints, Kernel, Model, Nodes,
    Place, Section, SideCondition, Static, StrainMeasure, Support,
};
use ancf::solve::equilibrium::Equilibrium;
use ancf::system::System;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::sync::Arc;

const LENGTH: f64 = 1.8;
const EI: f64 = 68.95e9 * 0.130e-8;

fn rpim(nodes: Nodes) -> Discretization {
    Discretization::Rpim {
        nodes,
        kernel: Kernel::Multiquadric { q: 1.03, shape: 3.3 },
        polynomial_terms: 2,
        side_condition: SideCondition::Plus,
        neighbours: 2,
    }
}

/// The cantilever under an end moment that bends it by `angle`.
fn cantilever(discretization: Discretization, gauss_points: GaussPoints, angle: f64) -> Model {
    Model {
        beams: vec![Beam {
            name: "cantilever".into(),
            centreline: Centreline::Line { start: [0.0, 0.0], end: [LENGTH, 0.0] },
            section: Section {
                axial_stiffness: Some((68.95e9 * 2.5e-4).into()),
                bending_stiffness: Some(EI.into()),
                mass_per_length: None,
                ..Default::default()
            },
            strain: StrainMeasure::Engineering,
            discretization,
            gauss_points,
        }],
        supports: vec![Support {
            at: Place { beam: 0, s: 0.0 },
            fix: Fixed { x: true, y: true, rotation: FixedRotation::Angle },
            ..Support::default()
        }],
        parts: vec![Arc::new(Moment {
            at: Place { beam: 0, s: LENGTH },
            value: angle * EI / LENGTH,
            law: None,
        })],
        ..Model::default()
    }
}

fn system(discretization: Discretization, gauss_points: GaussPoints) -> System {
    System::build(&cantilever(discretization, gauss_points, 1.0), Needs { inertia: false, motion: false })
        .expect("a legal model")
}

/// Assembly of force and tangent, factorisation, solution.
fn newton_iteration(c: &mut Criterion) {
    let mut group = c.benchmark_group("newton-iteration");
    let full = GaussPoints { stretch: 5, bend: 3, lobatto: false };
    let four = GaussPoints { stretch: 4, bend: 4, lobatto: false };
    let uniform = |cells: usize| Discretization::Ancf { nodes: Nodes::Uniform(cells + 1) };
    let cases = [
        ("ancf-5-3", 1_000, uniform(1_000), full),
        ("ancf-5-3", 10_000, uniform(10_000), full),
        ("ancf-5-3", 100_000, uniform(100_000), full),
        ("rpim-4-4", 1_000, rpim(Nodes::Uniform(1_001)), four),
    ];
    for (name, cells, discretization, gauss_points) in cases {
        let system = system(discretization, gauss_points);
        let mut equilibrium = Equilibrium::new(&system);
        let x = equilibrium.start();
        let mut increment = vec![0.0; x.len()];
        let mut rate = increment.clone();
        group.throughput(Throughput::Elements(cells as u64));
        group.bench_function(BenchmarkId::new(name, cells), |b| {
            b.iter(|| {
                equilibrium.linearize(0.1, &x, None, &mut increment, &mut rate).expect("a stable cantilever");
                equilibrium.solve(0.1, &mut increment, false);
                black_box(&increment);
            });
        });
    }
    group.finish();
}

/// Everything from the model to the trajectory: a full circle with nine elements.
fn roll_up(c: &mut Criterion) {
    let ancf = Discretization::Ancf { nodes: Nodes::Uniform(10) };
    let cases = [
        (
            "ancf-9-elements-5-3",
            cantilever(ancf, GaussPoints { stretch: 5, bend: 3, lobatto: false }, std::f64::consts::TAU),
        ),
        (
            "rpim-10-nodes-4-4",
            cantilever(
                rpim(Nodes::Uniform(10)),
                GaussPoints { stretch: 4, bend: 4, lobatto: false },
                std::f64::consts::TAU,
            ),
        ),
    ];
    for (name, model) in cases {
        c.bench_function(&format!("roll-up/{name}"), |b| {
            b.iter(|| {
                let analysis = Analysis::Static(Static::default());
                model.solve(&analysis).expect("the cantilever rolls up")
            });
        });
    }
}

/// Shape functions of 100 cells of uneven width, solved in extended precision, and their tables.
fn tables(c: &mut Criterion) {
    let mut s = vec![0.0];
    for i in 0..100 {
        // Widths between 0.7 and 1.3, without pattern.
        let width = 1.0 + 0.3 * (7.3 * f64::from(i)).sin();
        s.push(s[s.len() - 1] + width);
    }
    let length = s[100];
    let discretization = rpim(Nodes::Given(s));
    c.bench_function("rpim-tables/100-uneven-cells", |b| {
        b.iter(|| {
            let basis = Basis::new(&discretization, length).expect("solvable");
            let stretch = basis.table(Quadrature::Gauss(4), &[1]).expect("a table");
            let bend = basis.table(Quadrature::Gauss(4), &[1, 2]).expect("a table");
            black_box((stretch, bend));
        });
    });
}

/// The same tangent by every factorisation that can take it.
fn factorisations(c: &mut Criterion) {
    let mut group = c.benchmark_group("factorisation");
    let ancf = Discretization::Ancf { nodes: Nodes::Uniform(1_001) };
    let cases = [("ancf", ancf), ("rpim", rpim(Nodes::Uniform(1_001)))];
    for (name, discretization) in cases {
        let system = system(discretization, GaussPoints { stretch: 4, bend: 4, lobatto: false });
        let n = system.coordinates();
        let mut k = system.matrix();
        let q = system.reference();
        system.force_and_tangent(0.1, q, None, &mut vec![0.0; n], &mut k, &mut Default::default());
        system.supports().eliminate(0.1, &mut k);
        let Matrix::Symmetric(symmetric) = &k else { continue };
        let band = symmetric.to_band();
        let mut ldl = Ldl::new(symmetric).ok();
        let mut sparse = Bordered::new(&k, &[], None).ok();
        group.bench_function(BenchmarkId::new("banded-ldl", name), |b| {
            b.iter(|| ldl = Ldl::again(ldl.take(), symmetric, None).ok());
        });
        group.bench_function(BenchmarkId::new("banded-lu", name), |b| {
            b.iter(|| BandLu::new(&band).expect("regular"));
        });
        group.bench_function(BenchmarkId::new("sparse-lu", name), |b| {
            b.iter(|| sparse = Bordered::new(&k, &[], sparse.take()).ok());
        });
    }
    group.finish();
}

criterion_group! {
    name = statics;
    config = Criterion::default().sample_size(20);
    targets = newton_iteration, roll_up, tables, factorisations
}
criterion_main!(statics);
