//! What motion costs: the soft pendulum by the trapezoidal rule and by Gauss collocation, and the
//! time of a step as the number of elements grows.
//! `cargo bench -p ancf-verification --bench dynamics`.

use std::path::Path;

use ancf::model::{Analysis, Centreline, Discretization, Model, Nodes};
use ancf::scene::Scene;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// The soft pendulum with one basis and one integrator.
fn pendulum(basis: &str, dynamic: &str) -> (Model, Analysis) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/soft-pendulum/scene.toml");
    let set = [format!("beam.arm.basis={basis}"), format!("analysis.dynamic={dynamic}")];
    let scene = Scene::load(&path, &set).expect("a legal scene");
    (scene.model().clone(), scene.analysis().clone())
}

/// 2.5 s of motion, one record at the end.
fn soft_pendulum(c: &mut Criterion) {
    let mut group = c.benchmark_group("soft-pendulum");
    let ancf = "{ancf={elements=30}}";
    let rpim = "{rpim={nodes=20}}";
    let cases = [
        ("ancf-30-trapezoidal-1ms", ancf, "generalized_alpha={step=\"1 ms\", spectral_radius=1.0}"),
        ("rpim-20-gauss-3-5ms", rpim, "gauss={stages=3, step=\"5 ms\"}"),
        ("rpim-20-gauss-3-1e-5", rpim, "gauss={stages=3, tolerance=1e-5}"),
        ("rpim-20-radau-3-1e-5", rpim, "radau={stages=3, tolerance=1e-5}"),
    ];
    for (name, basis, integrator) in cases {
        let dynamic = format!("{{duration=\"2.5 s\", output_every=\"2.5 s\", {integrator}}}");
        let (model, analysis) = pendulum(basis, &dynamic);
        group.bench_function(name, |b| {
            b.iter(|| model.solve(&analysis).expect("it swings"));
        });
    }
    group.finish();
}

/// Ten steps of the trapezoidal rule, elements of 6 cm.
fn elements(c: &mut Criterion) {
    let mut group = c.benchmark_group("ten-trapezoidal-steps");
    let dynamic = "{duration=\"10 ms\", output_every=\"10 ms\", generalized_alpha={step=\"1 ms\", spectral_radius=1.0}}";
    for count in [100_usize, 1_000, 10_000, 100_000] {
        let (mut model, analysis) = pendulum("{ancf={elements=30}}", dynamic);
        model.beams[0].centreline = Centreline::Line { start: [0.0; 2], end: [0.06 * count as f64, 0.0] };
        model.beams[0].discretization = Discretization::Ancf { nodes: Nodes::Uniform(count + 1) };
        model.probes.clear();
        group.throughput(Throughput::Elements(10 * count as u64));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| model.solve(&analysis).expect("it falls"));
        });
    }
    group.finish();
}

criterion_group! {
    name = dynamics;
    config = Criterion::default().sample_size(10);
    targets = soft_pendulum, elements
}
criterion_main!(dynamics);
