//! Finite turns of nodes and chords, and forces of several states at once.

use super::generators::{beam, clamp, free, noise, perturbed};
use ancf::lanes::Lanes;
use ancf::model::{Beam, Centreline, Discretization, Load, Model, Nodes, Place, Support};
use ancf::solve::retraction::Retraction;
use ancf::system::{Needs, System};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn held(beam: Beam, supports: Vec<Support>) -> System {
    let model = Model { beams: vec![beam], supports, ..Model::default() };
    System::build(&model, Needs::default()).expect("a legal model")
}

/// What linear theory says of a straight cantilever under a tip moment, for whatever angle, taken along finite turns: a circle. Of it a chord misses
/// the fourth order of a cell's angle, (δ/2)⁴/120 of its length.
#[test]
fn a_straight_cantilever_turns_into_a_circle() {
    let cells = 16;
    let mut straight = ancf_beam(Nodes::Uniform(cells + 1));
    straight.centreline = Centreline::Line { start: [0.0, 0.0], end: [1.0, 0.0] };
    let system = held(straight, vec![clamp()]);
    let retraction = Retraction::new(&system);
    for angle in [0.5, -3.0, TAU, 3.0 * TAU] {
        let mut q = system.reference().to_vec();
        let nodes = (0..=cells).map(|i| i as f64 / cells as f64);
        let increment: Vec<f64> =
            nodes.clone().flat_map(|s| [0.0, 0.5 * angle * s * s, 0.0, angle * s]).collect();
        retraction.apply(&increment, &mut q);
        let allowed = (0.5 * angle / cells as f64).powi(4) / 60.0 + 1e-14;
        for (s, node) in nodes.zip(q.chunks_exact(4)) {
            let (sine, cosine) = (angle * s).sin_cos();
            let circle = [sine / angle, (1.0 - cosine) / angle, cosine, sine];
            for (ours, exact) in node.iter().zip(circle) {
                assert!((ours - exact).abs() < allowed, "{angle} rad, s = {s}: {node:?}, not {circle:?}");
            }
        }
    }
}

fn ancf_beam(nodes: Nodes) -> Beam {
    Beam {
        name: "beam".into(),
        centreline: Centreline::Line { start: [0.0, 0.0], end: [1.0, 0.0] },
        section: ancf::model::Section {
            axial_stiffness: Some(1e4),
            bending_stiffness: Some(1.0),
            mass_per_length: None,
        },
        strain: ancf::model::StrainMeasure::Engineering,
        discretization: Discretization::Ancf { nodes },
        gauss_points: ancf::model::GaussPoints { stretch: 4, bend: 2, lobatto: false },
    }
}

proptest! {
    #![proptest_config(super::cases(60))]

    /// Newton's convergence needs no more than that: what the turns change is of second order. And nothing that is held moves otherwise than it is told to.
    #[test]
    fn turns_differ_from_sums_in_the_second_order(beam in beam(), noise in noise(), both in any::<bool>()) {
        let end = Support { at: Place { beam: 0, s: free(&beam).beams()[0].basis.length() }, ..clamp() };
        let supports = if both { vec![clamp(), end] } else { vec![clamp()] };
        let system = held(beam, supports);
        let retraction = Retraction::new(&system);
        let q = perturbed(&system, 0.1, &noise);
        let difference = |size: f64| {
            let scales = system.length();
            let d: Vec<f64> = noise.iter().cycle().skip(3).take(q.len()).enumerate()
                .map(|(i, d)| size * d * if i % 4 < 2 { scales / 10.0 } else { 1.0 }).collect();
            let mut moved = q.clone();
            retraction.apply(&d, &mut moved);
            let apart: Vec<f64> = moved.iter().zip(&q).zip(&d).map(|((m, q), d)| m - (q + d)).collect();
            let ends = [0, apart.len() - 4];
            for end in &ends[..1 + usize::from(both)] {
                assert!(apart[*end].abs() + apart[end + 1].abs() < 1e-12 * scales, "a held node moved");
            }
            apart.iter().map(|a| a * a).sum::<f64>().sqrt()
        };
        // What turns by less than 0.01 rad is added.
        let turning = noise.iter().cycle().skip(3).take(q.len()).skip(2).step_by(4).fold(0.0_f64, |m, d| m.max(d.abs()));
        prop_assume!(turning > 0.3);
        let ratio = difference(0.08) / difference(0.04);
        prop_assert!((2.5..6.0).contains(&ratio), "half the increment divides the difference by {ratio}");
    }

    /// Four states side by side feel what each feels alone: beams of all kinds, with loads that turn and springs.
    #[test]
    fn forces_of_four_states_are_those_of_each(beam in beam(), noise in noise(), follower in any::<bool>()) {
        let s = 0.4 * free(&beam).beams()[0].basis.length();
        let load = Load::Force { at: Place { beam: 0, s }, value: [3.0, -2.0], follower };
        let model = Model { beams: vec![beam], loads: vec![load], ..Model::default() };
        let system = System::build(&model, Needs::default()).expect("a legal model");
        let n = system.coordinates();
        let states: Vec<Vec<f64>> = (0..4)
            .map(|k| perturbed(&system, 0.1, &noise.iter().cycle().skip(k).take(noise.len()).copied().collect::<Vec<_>>()))
            .collect();
        let parameters = [0.0, 0.3, 0.7, 1.0];
        let q: Vec<Lanes> = (0..n).map(|i| Lanes::new(std::array::from_fn(|k| states[k][i]))).collect();
        let mut together = vec![Lanes::ZERO; n];
        system.forces(parameters, &q, &mut together, &mut [vec![0.0; n], vec![0.0; n]]);
        for (lane, state) in states.iter().enumerate() {
            let mut alone = vec![0.0; n];
            system.force(parameters[lane], state, &mut alone);
            let size = alone.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            for (ours, alone) in together.iter().zip(&alone) {
                let ours = ours.to_array()[lane];
                prop_assert!((ours - alone).abs() <= 1e-11 * size, "lane {lane}: {ours}, not {alone}");
            }
        }
    }

    /// Nothing but the order of sums tells whether cells are summed alone or by fours: a beam with even cells has the forces of the same beam with cells that
    /// differ by round-off, which are never alike.
    #[test]
    fn cells_by_fours_are_cells(noise in noise()) {
        let even: Vec<f64> = (0..=14).map(|i| f64::from(i) / 14.0).collect();
        let uneven: Vec<f64> = even.iter().enumerate()
            .map(|(i, s)| if i == 0 || i == 14 { *s } else { s + 1e-9 * (i % 3) as f64 }).collect();
        let force = |nodes: Nodes| {
            let system = held(ancf_beam(nodes), Vec::new());
            let mut f = vec![0.0; system.coordinates()];
            system.force(1.0, &perturbed(&system, 0.1, &noise), &mut f);
            f
        };
        let (even, uneven) = (force(Nodes::Uniform(15)), force(Nodes::Given(uneven)));
        let size = even.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (a, b) in even.iter().zip(&uneven) {
            prop_assert!((a - b).abs() < 1e-5 * size, "{a} {b}");
        }
    }
}
