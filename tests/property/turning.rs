//! Finite turns of nodes and chords, and forces of several states at once.

use super::generators::{beam, clamp, free, noise, perturbed};
use ancf::assembly::{Density, Earlier, Effect, Gradient, Hessian, Integral, Kind, Needs, Workspace};
use ancf::basis::Quadrature;
use ancf::effect::Bend;
use ancf::effect::{Force, Moment};
use ancf::lanes::Lanes;
use ancf::model::{
    Analysis, ArcLength, Beam, Centreline, Discretization, Model, Nodes, Place, Probe, Static, Support,
};
use ancf::solve::retraction::Retraction;
use ancf::system::System;
use nalgebra::Vector2;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

fn held(beam: Beam, supports: Vec<Support>) -> System {
    let model = Model { beams: vec![beam], supports, ..Model::default() };
    System::build(&model, Needs::default()).expect("a legal model")
}

/// What linear theory says of a straight cantilever under a tip moment, for whatever angle, taken
/// along finite turns: a circle. Of it a chord misses the fourth order of a cell's angle,
/// (δ/2)⁴/120 of its length.
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
            axial_stiffness: Some(1e4.into()),
            bending_stiffness: Some(1.0.into()),
            mass_per_length: None,
            ..Default::default()
        },
        strain: ancf::model::StrainMeasure::Engineering,
        discretization: Discretization::Ancf { nodes },
        gauss_points: ancf::model::GaussPoints { stretch: 4, bend: 2, lobatto: false },
    }
}

proptest! {
    #![proptest_config(super::cases(60))]

    /// Newton's convergence needs no more than that: what the turns change is of second order. And
    /// nothing that is held moves otherwise than it is told to.
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

    /// Four states side by side feel what each feels alone: beams of all kinds, with loads that
    /// turn and loads that do not.
    #[test]
    fn forces_of_four_states_are_those_of_each(beam in beam(), noise in noise(), follower in any::<bool>()) {
        let s = 0.4 * free(&beam).beams()[0].basis.length();
        let load = Arc::new(Force { at: Place { beam: 0, s }, value: [3.0, -2.0], follower, law: None });
        let model = Model { beams: vec![beam], parts: vec![load], ..Model::default() };
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

    /// Cells by fours are cells, whether their density knows four points or one: forces, and
    /// tangents after an iterate, where the curvature without stress differs from point to point.
    #[test]
    fn cells_by_fours_are_cells(noise in noise()) {
        let system = held(ancf_beam(Nodes::Uniform(15)), Vec::new());
        let table = || system.beams()[0].basis.table(Quadrature::Gauss(3), &[1, 2]).expect("a rule");
        let mut numbers = noise.iter().copied().cycle();
        let mut vector = || Vector2::new(numbers.next().unwrap_or_default(), 1.0);
        let reference: Vec<[Vector2<f64>; 2]> = (0..3 * 14).map(|_| [vector(), vector()]).collect();
        let bend = Bend::new(2.0, &reference);
        let q = perturbed(&system, 0.1, &noise);
        let increment: Vec<f64> = noise.iter().cycle().skip(5).take(q.len()).map(|x| 0.1 * x).collect();
        let before = perturbed(&system, 0.2, &noise);
        let found = |effect: &dyn Effect| {
            let (mut f, mut with, mut product) = (vec![0.0; q.len()], vec![0.0; q.len()], vec![0.0; q.len()]);
            let mut k = system.matrix();
            effect.add_force(3.0, &q, &mut f);
            let earlier = Earlier { q: &before, increment: &increment };
            effect.add_force_and_tangent(3.0, &q, Some(earlier), &mut with, &mut k, &mut Workspace::default());
            k.multiply_add(1.0, &increment, &mut product);
            [f, with, product]
        };
        let one_by_one = found(&Integral::new(Kind::Bend, 0, 0, table(), OneByOne::<false>(bend.clone())));
        let by_fours = found(&Integral::new(Kind::Bend, 0, 0, table(), OneByOne::<true>(bend.clone())));
        let in_lanes = found(&Integral::new(Kind::Bend, 0, 0, table(), bend));
        for (what, expected) in one_by_one.iter().enumerate() {
            let size = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for ours in [&by_fours[what], &in_lanes[what]] {
                for (ours, expected) in ours.iter().zip(expected) {
                    prop_assert!((ours - expected).abs() <= 1e-11 * size, "{what}: {ours}, not {expected}");
                }
            }
        }
    }
}

/// A density that knows one point at a time, summed by fours or not.
struct OneByOne<const BY_FOURS: bool>(Bend);

impl<const BY_FOURS: bool> Density<2> for OneByOne<BY_FOURS> {
    const ORDERS: [usize; 2] = Bend::ORDERS;
    const BY_FOURS: bool = BY_FOURS;

    fn energy(&self, point: usize, z: &Gradient<2>) -> f64 {
        self.0.energy(point, z)
    }

    fn gradient(&self, point: usize, z: &Gradient<2>) -> Gradient<2> {
        self.0.gradient(point, z)
    }

    fn gradient_and_hessian(
        &self,
        point: usize,
        z: &Gradient<2>,
        before: &Gradient<2>,
        change: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        self.0.gradient_and_hessian(point, z, before, change)
    }
}

/// One step winds the free end of a beam up by one and a half turns, whichever end is clamped.
#[test]
fn angles_count_the_turns_of_one_step() {
    for clamped in [0.0, 1.0] {
        let free = Place { beam: 0, s: 1.0 - clamped };
        let model = Model {
            beams: vec![ancf_beam(Nodes::Uniform(33))],
            supports: vec![Support { at: Place { beam: 0, s: clamped }, ..clamp() }],
            parts: vec![Arc::new(Moment::new(free, 1.5 * TAU))],
            probes: vec![Probe { name: "free".into(), at: free }],
            ..Model::default()
        };
        let analysis = Analysis::Static(Static::default());
        let trajectory = model.solve(&analysis).expect("a wound-up beam");
        let angle = trajectory.states().probes[0].samples.last().expect("a state").angle;
        assert!(
            (angle - 1.5 * TAU).abs() < 1e-3,
            "clamped at {clamped}: {angle} in {} steps",
            trajectory.states().parameter.len()
        );
    }
}

/// The end of a path at a load between two points of it that lie half a turn apart.
#[test]
fn a_path_ends_at_its_load_between_long_steps() {
    let tip = Place { beam: 0, s: 1.0 };
    let model = Model {
        beams: vec![ancf_beam(Nodes::Uniform(97))],
        supports: vec![clamp()],
        parts: vec![Arc::new(Moment::new(tip, 3.0 * TAU))],
        probes: vec![Probe { name: "tip".into(), at: tip }],
        ..Model::default()
    };
    for until in [0.5, 0.77, 0.93] {
        let arc = ArcLength { until_load: Some(until), max_points: 1000, max_step: None, until_probe: None };
        let settings = Static { arc_length: Some(arc), ..Static::default() };
        let trajectory = model.solve(&settings).expect("a path");
        assert_eq!(trajectory.parameter.last(), Some(&until), "{:?}", trajectory.parameter);
        let angle = trajectory.probes[0].samples.last().expect("a state").angle;
        assert!((angle - 3.0 * TAU * until).abs() < 1e-3, "{angle} at {until}");
    }
}
