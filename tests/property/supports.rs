//! Supports hold what they name, at nodes and between them, alone and together, at rest and in
//! motion.

use super::generators::clamp;
use ancf::assembly::Needs;
use ancf::effect::Force;
use ancf::model::{
    Analysis, Beam, Centreline, Discretization, Displacement, Fixed, FixedRotation, GaussPoints, Kernel,
    Model, Nodes, Place, Probe, Section, SideCondition, Static, StrainMeasure, Support,
};
use ancf::solve::stability::Stability;
use ancf::system::{System, View};
use proptest::prelude::*;
use std::sync::Arc;

const LENGTH: f64 = 2.0;

fn model(discretization: Discretization, angle: f64, supports: Vec<Support>) -> Model {
    let (s, c) = angle.sin_cos();
    Model {
        beams: vec![Beam {
            name: "beam".into(),
            centreline: Centreline::Line { start: [0.5, -0.3], end: [0.5 + LENGTH * c, -0.3 + LENGTH * s] },
            section: Section {
                axial_stiffness: Some(2e3.into()),
                bending_stiffness: Some(1.0.into()),
                mass_per_length: None,
                ..Default::default()
            },
            strain: StrainMeasure::Engineering,
            discretization,
            gauss_points: GaussPoints { stretch: 4, bend: 4, lobatto: false },
        }],
        supports,
        parts: vec![Arc::new(Force::new(Place { beam: 0, s: LENGTH }, [0.2, 0.3]))],
        probes: vec![
            Probe { name: "held".into(), at: Place { beam: 0, s: 0.0 } },
            Probe { name: "tip".into(), at: Place { beam: 0, s: LENGTH } },
        ],
        ..Model::default()
    }
}

fn either() -> impl Strategy<Value = Discretization> {
    prop_oneof![
        Just(Discretization::Ancf { nodes: Nodes::Uniform(7) }),
        Just(Discretization::Rpim {
            nodes: Nodes::Uniform(7),
            kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
            polynomial_terms: 2,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        })
    ]
}

fn rotation() -> impl Strategy<Value = FixedRotation> {
    prop_oneof![Just(FixedRotation::Free), Just(FixedRotation::Angle), Just(FixedRotation::Gradient)]
}

proptest! {
    #![proptest_config(super::cases(40))]

    /// The clamp at the start moves as prescribed; a second support somewhere holds any
    /// combination.
    #[test]
    fn supports_hold_and_move_what_they_name(
        discretization in either(),
        angle in -3.0..3.0,
        at_node in any::<bool>(),
        share in 0.3..0.9,
        (x, y, rotation) in (any::<bool>(), any::<bool>(), rotation()),
        turn in -0.4..0.4,
        lift in -0.1..0.1,
    ) {
        // Node 4 of 7, or a place between nodes.
        let s = if at_node { LENGTH * 4.0 / 6.0 } else { LENGTH * share };
        let start = Support { displacement: Displacement { x: lift, y: -lift, angle: turn }, ..clamp() };
        let second = Support {
            at: Place { beam: 0, s },
            fix: Fixed { x, y, rotation },
            displacement: Displacement { x: lift, y: -lift, angle: 0.5 * turn },
            law: None,
        };
        let model = model(discretization, angle, vec![start.clone(), second.clone()]);
        let system = System::build(&model, Needs { inertia: false, motion: false }).expect("a legal model");
        let between = system.multipliers();
        let rows = usize::from(x) + usize::from(y) + match rotation {
            FixedRotation::Free => 0,
            FixedRotation::Angle => 1,
            FixedRotation::Gradient => 2,
        };
        let near_node = system.beams()[0].basis.node_at(s).is_some();
        prop_assert_eq!(between, if near_node { 0 } else { rows });
        let solution = ancf::solve::statics::solve(&system, &Static::default(), None, &mut |_, _, _| true);
        // Some of these snap through on the way; whatever was found must hold.
        prop_assert!(solution.states.len() > 1, "{:?}", solution.stuck);
        let part = &system.beams()[0];
        for (load, q) in &solution.states {
            for support in [&start, &second] {
                let view = View::point(&part.basis, part.offset(), support.at.s).expect("on the beam");
                let (now, before) = (view.fields(q), view.fields(system.reference()));
                let wanted = [support.displacement.x * load, support.displacement.y * load];
                for (axis, held) in [support.fix.x, support.fix.y].into_iter().enumerate() {
                    let error = now.position[axis] - before.position[axis] - wanted[axis];
                    prop_assert!(!held || error.abs() < 1e-12, "axis {axis} is off by {error} at load factor {load}");
                }
                let turned = now.angle() - before.angle() - support.displacement.angle * load;
                let turned = turned - std::f64::consts::TAU * (turned / std::f64::consts::TAU).round();
                if support.fix.rotation != FixedRotation::Free {
                    prop_assert!(turned.abs() < 1e-11, "turned by {turned} too much at load factor {load}");
                }
                if support.fix.rotation == FixedRotation::Gradient {
                    prop_assert!((now.gradient[0].hypot(now.gradient[1]) - 1.0).abs() < 1e-11);
                }
            }
        }
    }
}

/// A column that passes its buckling load undisturbed is reported, with the load.
#[test]
fn a_bifurcation_is_reported_with_its_load() {
    let mut column = model(Discretization::Ancf { nodes: Nodes::Uniform(9) }, 0.0, vec![clamp()]);
    column.beams[0].section.axial_stiffness = Some(1e6.into());
    let critical = std::f64::consts::PI.powi(2) / (4.0 * LENGTH * LENGTH);
    column.parts = vec![Arc::new(Force::new(Place { beam: 0, s: LENGTH }, [-2.0 * critical, 0.0]))];
    let system = System::build(&column, Needs { inertia: false, motion: false }).expect("a legal model");
    let solution = ancf::solve::statics::solve(&system, &Static::default(), None, &mut |_, _, _| true);
    let [event] = solution.events[..] else { panic!("one loss of definiteness, not {:?}", solution.events) };
    assert_eq!((event.before, event.after), (Stability::Directions(0), Stability::Directions(1)));
    assert!((event.load - 0.5).abs() < 1e-4, "at load factor {}", event.load);
    let trajectory = column.solve(&Static::default()).expect("solvable");
    assert!(
        trajectory.run.warnings[0].contains("loses definiteness at load factor 0.5000"),
        "{:?}",
        trajectory.run.warnings
    );
}

/// A pinned column with a support between nodes in its middle buckles in two half waves, four times
/// later than without, and stability is judged alike in all units.
#[test]
fn stability_between_constraint_rows_does_not_depend_on_units() {
    for metre in [1e-6, 1.0, 1e6] {
        let length = LENGTH * metre;
        let mut column = model(Discretization::Ancf { nodes: Nodes::Uniform(10) }, 0.0, vec![]);
        column.beams[0].centreline = Centreline::Line { start: [0.0, 0.0], end: [length, 0.0] };
        column.beams[0].section = Section {
            axial_stiffness: Some(1e6.into()),
            bending_stiffness: Some((metre * metre).into()),
            mass_per_length: None,
            ..Default::default()
        };
        let pin = |s: f64, x: bool| Support {
            at: Place { beam: 0, s },
            fix: Fixed { x, y: true, ..Fixed::default() },
            ..Support::default()
        };
        column.supports = vec![pin(0.0, true), pin(0.5 * length, false), pin(length, false)];
        column.probes.clear();
        let critical = 4.0 * std::f64::consts::PI.powi(2) / (LENGTH * LENGTH);
        column.parts = vec![Arc::new(Force::new(Place { beam: 0, s: length }, [-2.0 * critical, 0.0]))];
        let system = System::build(&column, Needs { inertia: false, motion: false }).expect("a legal model");
        assert_eq!(system.multipliers(), 1, "the middle lies between nodes");
        let solution = ancf::solve::statics::solve(&system, &Static::default(), None, &mut |_, _, _| true);
        let first = solution.events.first().expect("the column passes its critical load");
        let counts = (Stability::Directions(0), Stability::Directions(1));
        assert_eq!((first.before, first.after), counts, "lengths in {metre} m");
        assert!((first.load - 0.5).abs() < 1e-3, "at load factor {} with lengths in {metre} m", first.load);
    }
}

/// An observer that stops ends the analysis, whatever parts of the load were asked for.
#[test]
fn stopping_ends_the_analysis() {
    let model = model(Discretization::Ancf { nodes: Nodes::Uniform(7) }, 0.0, vec![clamp()]);
    let system = System::build(&model, Needs { inertia: false, motion: false }).expect("a legal model");
    let settings = Static { steps: Some(8), ..Static::default() };
    let mut calls = 0;
    let solution = ancf::solve::statics::solve(&system, &settings, None, &mut |_, _, _| {
        calls += 1;
        false
    });
    assert_eq!(calls, 1);
    assert!(solution.stuck.is_none() && solution.states.iter().all(|(load, _)| *load <= 0.125));
    let recorded = |steps| {
        let settings = Static { steps: Some(steps), ..Static::default() };
        let solution = ancf::solve::statics::solve(&system, &settings, None, &mut |_, _, _| true);
        solution.states.iter().map(|(load, _)| *load).collect::<Vec<_>>()
    };
    assert_eq!(recorded(4), [0.0, 0.25, 0.5, 0.75, 1.0]);
}

/// What one support holds of a node and another holds of it too add up; the same component twice is
/// a contradiction.
#[test]
fn supports_at_one_node_add_up() {
    let support =
        |x: bool, y: bool| Support { fix: Fixed { x, y, ..Fixed::default() }, ..Support::default() };
    let tip = |supports: Vec<Support>| {
        let far = Support { at: Place { beam: 0, s: LENGTH }, ..support(false, true) };
        let discretization = Discretization::Ancf { nodes: Nodes::Uniform(7) };
        let mut model = model(discretization, 0.3, [supports, vec![far]].concat());
        model.parts[0] = Arc::new(Force::new(Place { beam: 0, s: 0.5 * LENGTH }, [0.2, 0.3]));
        let analysis = Analysis::Static(Static::default());
        model.solve(&analysis).map(|t| t.states().probes[1].samples.clone())
    };
    let together = tip(vec![support(true, true)]).expect("a pinned beam");
    let apart = tip(vec![support(true, false), support(false, true)]).expect("the same");
    assert_eq!(together.last(), apart.last());
    assert!(tip(vec![support(true, true), support(false, true)]).is_err(), "y is held twice");
}

/// The path's tangent carries moved supports along: where all is nearly linear the first prediction
/// leaves next to nothing to correct.
#[test]
fn the_prediction_moves_with_the_supports() {
    let moved = Support { displacement: Displacement { x: 2e-5, y: -3e-5, angle: 1e-5 }, ..clamp() };
    let mut model = model(Discretization::Ancf { nodes: Nodes::Uniform(9) }, 0.4, vec![moved]);
    model.parts.clear();
    let trajectory = model.solve(&Static::default()).expect("an equilibrium");
    let first = trajectory.history[0].increments[0];
    assert!(first < 1e-8, "the first correction is {first} of a beam length");
}
