//! Long chains, on which several threads work in blocks of nodes.

use ancf::assembly::{Needs, Workspace};
use ancf::linear::Matrix;
use ancf::linear::symmetric::{Ldl, SymmetricBand};
use ancf::model::{Analysis, Discretization, Dynamic, Model, Nodes};
use ancf::run::Options;
use ancf::scene::parse;
use ancf::system::System;

/// Elements of a chain that is long, and of one that is not.
const LONG: usize = 20_500;
const SHORT: usize = 10_250;

/// A pinned beam of so many elements of 1 cm under its weight, pushed where two blocks meet.
fn chain(elements: usize) -> (Model, Analysis) {
    let length = 0.01 * elements as f64;
    let text = format!(
        "beam.chain = {{ start = [0, 0], end = [{length}, 0], axial_stiffness = 1e3, bending_stiffness = 1e-3, mass_per_length = 0.1, \
         basis.ancf.elements = {elements} }}
        support = [{{ beam = 'chain', at = 'start', fix = ['x', 'y'] }}]
        effect.gravity.acceleration = [0, -9.81]
        effect.force = [{{ beam = 'chain', at = 40.96, value = [0.3, -1] }}]
        probe = [{{ name = 'near', beam = 'chain', at = 0.5 }}, {{ name = 'seam', beam = 'chain', at = 40.96 }}]
        analysis.dynamic = {{ duration = 0.005, output_every = 0.005, generalized_alpha.step = 0.001 }}"
    );
    let scene = parse("chain.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    (scene.model().clone(), scene.analysis().clone())
}

/// Coordinates that bend and stretch every element in another way.
fn shape(system: &System) -> Vec<f64> {
    let wave = |i: usize, q: &f64| q + 1e-3 * (0.37 * i as f64).sin();
    system.reference().iter().enumerate().map(|(i, q)| wave(i, q)).collect()
}

/// Forces and tangents of a long chain are those of the first half of it, which one thread sums: of
/// cable elements, whose cells are summed by fours, and of meshfree cells.
#[test]
fn sums_over_blocks_are_those_of_one_thread() {
    for meshfree in [false, true] {
        let [long, short] = [LONG, SHORT].map(|elements| {
            let (mut model, _) = chain(elements);
            if meshfree {
                let nodes = Nodes::Uniform(elements + 1);
                let Discretization::Ancf { .. } = model.beams[0].discretization else { panic!("elements") };
                model.beams[0].discretization = meshfree_on(nodes);
            }
            let system = System::build(&model, Needs { motion: true, inertia: true }).expect("a legal model");
            let q = shape(&system);
            let (mut force, mut both) = (vec![0.0; q.len()], vec![0.0; q.len()]);
            system.force(1.0, &q, &mut force);
            let mut tangent = system.matrix();
            system.force_and_tangent(1.0, &q, None, &mut both, &mut tangent, &mut Workspace::default());
            for (a, b) in force.iter().zip(&both) {
                assert!((a - b).abs() <= 1e-9 * a.abs().max(1.0), "{a} {b}");
            }
            (force, tangent)
        });
        let ((force, tangent), (expected, reference)) = (long, short);
        // The last nodes of the short one are those of an end.
        let count = expected.len() - 40;
        let largest = expected.iter().fold(0.0, |largest: f64, f| largest.max(f.abs()));
        for (i, (a, b)) in force.iter().zip(&expected).enumerate().take(count) {
            assert!((a - b).abs() <= 1e-9 * largest, "force {i}: {a}, not {b}");
        }
        let (Matrix::Symmetric(tangent), Matrix::Symmetric(reference)) = (tangent, reference) else {
            panic!("symmetric ones")
        };
        for i in 0..count {
            for j in reference.columns(i) {
                let (a, b) = (tangent.get(i, j), reference.get(i, j));
                let size = reference.get(i, i).abs().max(reference.get(j, j).abs());
                assert!((a - b).abs() <= 1e-9 * size, "({i}, {j}): {a}, not {b}");
            }
        }
    }
}

fn meshfree_on(nodes: Nodes) -> Discretization {
    use ancf::model::{Kernel, SideCondition};
    Discretization::Rpim {
        nodes,
        kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
        polynomial_terms: 2,
        side_condition: SideCondition::Plus,
        neighbours: 2,
    }
}

fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
}

/// A long chain is eliminated by two threads as by one, to the last bit: with an even and an odd number of
/// nodes, with negative pivots at either end and in the middle, and up to a node without a pivot.
#[test]
fn factors_do_not_depend_on_the_number_of_threads() {
    let chain = |nodes: usize, lost: Option<usize>| {
        let [mut k, mut m] = [(); 2].map(|()| SymmetricBand::zeros(nodes, 2));
        for i in 0..4 * nodes {
            let node = i / 4;
            let turned = [1, nodes / 2, nodes - 2].contains(&node) && i % 4 == 2;
            k.set(i, i, if turned { -30.0 } else { 20.0 + (i as f64).sin() });
            m.set(i, i, 7.0);
            for j in i + 1..(4 * (node + 2)).min(4 * nodes) {
                k.set(i, j, (0.7 * (i * j) as f64).cos());
            }
        }
        if let Some(node) = lost {
            let row = 4 * node + 1;
            k.columns(row).for_each(|j| k.set(row, j, 0.0));
            m.set(row, row, 0.0);
        }
        Ldl::again(None, &k, Some((0.5, &m)))
    };
    for nodes in [LONG, LONG + 1] {
        let solved = |threads: usize| {
            on_threads(threads, || {
                let factor = chain(nodes, None).expect("pivots");
                let mut x: Vec<f64> = (0..4 * nodes).map(|i| (0.3 * i as f64).sin()).collect();
                factor.solve(&mut x);
                (factor.negative_pivots(), x)
            })
        };
        let one = solved(1);
        assert_eq!(one.0, 3);
        assert!(one == solved(2), "{nodes} nodes");
        for lost in [3, nodes / 2, nodes - 3] {
            let found = [1, 2]
                .map(|threads| on_threads(threads, || chain(nodes, Some(lost)).expect_err("no pivot").row));
            assert_eq!(found, [4 * lost + 1; 2]);
        }
    }
}

/// What the probes of a motion see at its end, on so many threads.
fn seen(elements: usize, threads: usize) -> Vec<[f64; 5]> {
    let (model, analysis) = chain(elements);
    let Analysis::Dynamic(Dynamic { .. }) = analysis else { panic!("a motion") };
    on_threads(threads, || {
        let results = model.solve_with(&analysis, Options::default()).expect("results");
        let last = results.states().probes.iter().filter_map(|probe| probe.samples.last());
        let seen = last.map(|seen| [Some(seen.x), Some(seen.y), Some(seen.angle), seen.vx, seen.vy]);
        seen.map(|all| all.map(|one| one.expect("a velocity"))).collect()
    })
}

/// The motion of a long chain is the same on any number of threads, to the last bit; and that of the half of
/// it that begins at the same support, of which one thread computes all, before anything of the other end
/// arrives.
#[test]
fn motions_do_not_depend_on_the_number_of_threads() {
    let [one, two, three] = [1, 2, 3].map(|threads| seen(LONG, threads));
    assert_eq!(one, two);
    assert_eq!(one, three);
    for (a, b) in one.iter().zip(seen(SHORT, 2)) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= 1e-9, "{a}, not {b}");
        }
    }
    assert!(one[1][1] < -1e-5, "it falls");
}
