//! Random models and states.

use ancf::assembly::Needs;
use ancf::model::{
    Beam, Centreline, Discretization, Fixed, FixedRotation, GaussPoints, Kernel, Model, Nodes, Place,
    Section, SideCondition, StrainMeasure, Support,
};
use ancf::system::System;
use proptest::prelude::*;

/// Either discretisation with a few nodes.
pub fn discretization() -> impl Strategy<Value = Discretization> {
    let nodes =
        || prop_oneof![(2..7_usize).prop_map(Nodes::Uniform), (3..7_usize).prop_map(Nodes::Chebyshev)];
    let rpim =
        (nodes(), 0.9..6.0, prop_oneof![Just(SideCondition::Plus), Just(SideCondition::Minus)], 0..3_usize)
            .prop_map(|(nodes, shape, side_condition, neighbours)| Discretization::Rpim {
                nodes,
                kernel: Kernel::Multiquadric { q: 1.03, shape },
                polynomial_terms: 2,
                side_condition,
                neighbours,
            });
    prop_oneof![nodes().prop_map(|nodes| Discretization::Ancf { nodes }), rpim]
}

/// Straight beams in any direction, and arcs.
pub fn centreline() -> impl Strategy<Value = Centreline> {
    prop_oneof![
        (-1.0..1.0, -1.0..1.0, 0.0..std::f64::consts::TAU, 0.5..3.0_f64).prop_map(
            |(x, y, angle, length): (f64, f64, f64, f64)| {
                Centreline::Line { start: [x, y], end: [x + length * angle.cos(), y + length * angle.sin()] }
            }
        ),
        (0.5..2.0, -3.0..3.0, 0.3..2.0_f64, any::<bool>()).prop_map(|(radius, from, opening, turn)| {
            let to = if turn { from + opening } else { from - opening };
            Centreline::Arc { center: [0.3, -0.2], radius, from, to }
        }),
    ]
}

/// One beam with moderate stiffness ratio, free in space.
pub fn beam() -> impl Strategy<Value = Beam> {
    let strain = prop_oneof![Just(StrainMeasure::Green), Just(StrainMeasure::Engineering)];
    (discretization(), centreline(), strain, 10.0..1e4, 0.1..10.0).prop_map(
        |(discretization, centreline, strain, axial, bending): (_, _, _, f64, f64)| Beam {
            name: "beam".into(),
            centreline,
            section: Section {
                axial_stiffness: Some(axial.into()),
                bending_stiffness: Some(bending.into()),
                mass_per_length: Some(1.3.into()),
                ..Default::default()
            },
            strain,
            discretization,
            gauss_points: GaussPoints { stretch: 5, bend: 3, lobatto: false },
        },
    )
}

/// The system of one beam without supports and loads.
pub fn free(beam: &Beam) -> System {
    let model = Model { beams: vec![beam.clone()], ..Model::default() };
    System::build(&model, Needs { inertia: true, motion: false }).expect("a random beam is a legal beam")
}

/// A clamp at the start of beam 0.
pub fn clamp() -> Support {
    Support {
        at: Place { beam: 0, s: 0.0 },
        fix: Fixed { x: true, y: true, rotation: FixedRotation::Angle },
        ..Support::default()
    }
}

/// The reference state, each coordinate changed by up to `size` (positions in beam lengths) from a
/// list of numbers in [−1, 1].
pub fn perturbed(system: &System, size: f64, noise: &[f64]) -> Vec<f64> {
    let reference = system.reference().iter().enumerate();
    reference
        .map(|(i, q)| {
            let unit = if i % 4 < 2 { system.length() * 0.1 } else { 1.0 };
            q + size * unit * noise[i % noise.len()]
        })
        .collect()
}

/// Numbers in [−1, 1] for [`perturbed`].
pub fn noise() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0, 31)
}
