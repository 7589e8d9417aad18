//! Vibrations about the stress-free state and about equilibria, by both methods for eigenpairs.

use super::generators::clamp;
use ancf::assembly::{InternalVariables, Needs};
use ancf::effect::{Force, Moment};
use ancf::linear::Matrix;
use ancf::model::{
    About, Beam, Centreline, Discretization, Displacement, Fixed, FixedRotation, GaussPoints, Kernel, Modal,
    Model, Nodes, Place, Probe, Section, SideCondition, Static, StrainMeasure, Support,
};
use ancf::results::Vibrations;
use ancf::run::RunError;
use ancf::solve::eigen::{EigenError, Pairs, Pencil, dense, lanczos};
use ancf::solve::{modal, statics};
use ancf::system::{System, View};
use miette::Diagnostic;
use proptest::prelude::*;
use std::f64::consts::PI;
use std::sync::Arc;

const LENGTH: f64 = 1.5;

fn ancf(nodes: usize) -> Discretization {
    Discretization::Ancf { nodes: Nodes::Uniform(nodes) }
}

fn rpim(nodes: usize) -> Discretization {
    Discretization::Rpim {
        nodes: Nodes::Uniform(nodes),
        kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
        polynomial_terms: 2,
        side_condition: SideCondition::Plus,
        neighbours: 2,
    }
}

fn beam(discretization: Discretization, angle: f64) -> Beam {
    let (s, c) = angle.sin_cos();
    Beam {
        name: "beam".into(),
        centreline: Centreline::Line { start: [0.2, 0.1], end: [0.2 + LENGTH * c, 0.1 + LENGTH * s] },
        section: Section {
            axial_stiffness: Some(1e5.into()),
            bending_stiffness: Some(2.0.into()),
            mass_per_length: Some(0.7.into()),
            ..Default::default()
        },
        strain: StrainMeasure::Engineering,
        discretization,
        gauss_points: GaussPoints { stretch: 5, bend: 4, lobatto: false },
    }
}

fn model(beams: Vec<Beam>, supports: Vec<Support>) -> Model {
    Model { beams, supports, ..Model::default() }
}

fn support(s: f64, x: bool, y: bool, rotation: FixedRotation) -> Support {
    Support { at: Place { beam: 0, s }, fix: Fixed { x, y, rotation }, ..Support::default() }
}

fn pulled(mut model: Model, force: [f64; 2]) -> Model {
    model.parts.push(Arc::new(Force::new(Place { beam: 0, s: LENGTH }, force)));
    model
}

fn solve(model: &Model, count: usize, about: About) -> Result<Vibrations, RunError> {
    model.solve(&Modal { count, about })
}

fn frequencies(model: &Model, count: usize, about: About) -> Vec<f64> {
    solve(model, count, about).expect("a stable state").frequencies()
}

fn system(model: &Model) -> System {
    System::build(model, Needs { inertia: true, motion: false }).expect("a legal model")
}

fn close(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance * a.abs().max(b.abs()))
}

fn either() -> impl Strategy<Value = Discretization> {
    prop_oneof![Just(ancf(9)), Just(rpim(9)), Just(ancf(40))]
}

/// Matrices of the stress-free state, in the supports' frames.
fn matrices(system: &System) -> (Matrix, Matrix) {
    let (mut k, mut m) = (system.internal_tangent(system.reference()), system.mass_matrix());
    for matrix in [&mut k, &mut m] {
        system.supports().turn_matrix(0.0, matrix);
        system.supports().eliminate(0.0, matrix);
    }
    system.supports().clear_fixed(0.0, &mut m);
    (k, m)
}

fn product(matrix: &Matrix, u: &[f64], v: &[f64]) -> f64 {
    let mut w = vec![0.0; u.len()];
    matrix.multiply_add(1.0, u, &mut w);
    w.iter().zip(v).map(|(a, b)| a * b).sum()
}

proptest! {
    #![proptest_config(super::cases(24))]

    /// Turning a loaded structure as a whole changes no frequency.
    #[test]
    fn frequencies_do_not_depend_on_the_frame(
        discretization in either(),
        turn in -3.0..3.0,
        between in 0.3..0.9,
        force in prop::array::uniform2(-4.0..4.0),
    ) {
        let loaded = |turn: f64| {
            let (s, c) = f64::sin_cos(turn);
            let held = support(between * LENGTH, false, false, FixedRotation::Angle);
            let model = model(vec![beam(discretization.clone(), turn)], vec![clamp(), held]);
            pulled(model, [c * force[0] - s * force[1], s * force[0] + c * force[1]])
        };
        for about in [About::Reference, About::Equilibrium] {
            let (a, b) = (frequencies(&loaded(0.0), 4, about), frequencies(&loaded(turn), 4, about));
            prop_assert!(close(&a, &b, 1e-7), "{about:?}: {a:?} and {b:?}");
        }
    }

    /// Both methods find the same, whatever holds the beam, at nodes or between them; and two beams
    /// alike have every frequency twice.
    #[test]
    fn dense_and_lanczos_agree(
        discretization in either(),
        angle in -3.0..3.0,
        between in 0.2..0.9,
        (x, y) in (any::<bool>(), any::<bool>()),
        rotation in prop_oneof![Just(FixedRotation::Free), Just(FixedRotation::Angle), Just(FixedRotation::Gradient)],
        twice in any::<bool>(),
    ) {
        let mut supports = vec![clamp(), support(between * LENGTH, x, y, rotation)];
        let mut beams = vec![beam(discretization, angle)];
        if twice {
            beams.push(beams[0].clone());
            for support in supports.clone() {
                supports.push(Support { at: Place { beam: 1, ..support.at }, ..support });
            }
        }
        let system = system(&model(beams, supports));
        let ((k, m), border, held) = (matrices(&system), system.border(0.0, system.reference()), system.fixed());
        let pencil = Pencil { a: &k, b: &m, border: &border, fixed: held };
        let found: [Pairs; 2] =
            [dense::largest_reciprocals(&pencil, 8), lanczos::largest_reciprocals(&pencil, 8, 0)]
                .map(|pairs| pairs.expect("a stable state"));
        prop_assert_eq!(found[0].reciprocals.len(), 8);
        prop_assert!(close(&found[0].reciprocals, &found[1].reciprocals, 1e-7), "{:?}", found.map(|f| f.reciprocals));
        for pairs in &found {
            for (i, u) in pairs.vectors.iter().enumerate() {
                for (j, v) in pairs.vectors.iter().enumerate() {
                    let wanted = f64::from(u8::from(i == j));
                    prop_assert!((product(&k, u, v) - wanted).abs() < 1e-7);
                    let weight = product(&m, u, v) / (pairs.reciprocals[i] * pairs.reciprocals[j]).sqrt();
                    prop_assert!((weight - wanted).abs() < 1e-6, "modes {i} and {j}: {weight}");
                }
                for row in &border {
                    let value: f64 = row.iter().map(|&(i, b)| b * u[i]).sum();
                    let size = row.iter().map(|(_, b)| b.abs()).sum::<f64>() * u.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                    prop_assert!(value.abs() <= 1e-9 * size, "a row is violated by {value} of {size}");
                }
            }
        }
        if twice {
            for pair in found[1].reciprocals.chunks_exact(2) {
                prop_assert!((pair[0] / pair[1] - 1.0).abs() < 1e-7, "{pair:?}");
            }
        }
    }

    /// Tension stiffens, compression softens, and about the stress-free state loads take no part.
    #[test]
    fn tension_raises_and_compression_lowers_bending_frequencies(discretization in either(), force in 0.1..0.9) {
        let supports = vec![clamp()];
        let free = model(vec![beam(discretization, 0.0)], supports);
        let critical = 2.0 * PI.powi(2) / (4.0 * LENGTH * LENGTH);
        let at = |factor: f64, about| frequencies(&pulled(free.clone(), [factor * critical, 0.0]), 3, about);
        let rest = frequencies(&free, 3, About::Reference);
        let (tension, compression) = (at(force, About::Equilibrium), at(-force, About::Equilibrium));
        for i in 0..3 {
            prop_assert!(compression[i] < rest[i] && rest[i] < tension[i], "mode {i}");
        }
        prop_assert_eq!(at(force, About::Reference), rest);
    }

    /// Catches a geometric stiffness that is left out, and modes of another state. The modes of a
    /// loaded state are orthonormal in the mass, leave supports where they are, and their
    /// frequencies are those at which the forces around the equilibrium swing.
    #[test]
    fn modes_of_an_equilibrium_solve_its_equations(discretization in either(), force in prop::array::uniform2(-3.0..3.0)) {
        let model = pulled(model(vec![beam(discretization, 0.4)], vec![clamp()]), force);
        let system = system(&model);
        // Short steps: beyond the critical load a long one may leave the stable branch.
        let settings = Static { steps: Some(100), ..Static::default() };
        let states = statics::solve(&system, &settings, None, &mut |_, _, _| true).states;
        let (load, q) = states.last().expect("an equilibrium");
        let modes = modal::solve(&system, *load, q, &InternalVariables::default(), 3).expect("a stable state");
        let mass = system.mass_matrix();
        let view = View::point(&system.beams()[0].basis, 0, 0.0).expect("on the beam");
        for (i, shape) in modes.shapes.iter().enumerate() {
            for (j, other) in modes.shapes.iter().enumerate() {
                prop_assert!((product(&mass, shape, other) - f64::from(u8::from(i == j))).abs() < 1e-10);
            }
            let at_clamp = view.fields(shape);
            prop_assert!(at_clamp.position.iter().all(|c| c.abs() < 1e-12));
            // K φ by differences of forces: what is left beside ω² M φ must be reactions, which do
            // no work. Near buckling ω² is what is left of large terms, and a single quotient errs
            // by 6e-5 of it; two, extrapolated, err with the fourth power of the step.
            let quotient = |h: f64| -> f64 {
                let (mut ahead, mut behind) = (vec![0.0; q.len()], vec![0.0; q.len()]);
                let moved = |h: f64| q.iter().zip(shape).map(|(q, v)| q + h * v).collect::<Vec<_>>();
                system.force(1.0, &moved(h), &mut ahead);
                system.force(1.0, &moved(-h), &mut behind);
                ahead.iter().zip(&behind).zip(shape).map(|((a, b), v)| (a - b) / (2.0 * h) * v).sum()
            };
            let h = 1e-5;
            let work = (4.0 * quotient(h) - quotient(2.0 * h)) / 3.0;
            let square = (2.0 * PI * modes.frequencies[i]).powi(2);
            prop_assert!((work / square - 1.0).abs() < 1e-6, "mode {i}: {work} and {square}");
        }
    }
}

/// Motions that nothing resists have 0 Hz, come first and are all found, with few unknowns and with
/// many.
#[test]
fn free_bodies_have_frequencies_of_zero() {
    for nodes in [4, 12, 400] {
        for (count, angle, strain) in [
            (2, 0.3, StrainMeasure::Green),
            (5, 0.3, StrainMeasure::Engineering),
            (5, 0.0, StrainMeasure::Green),
        ] {
            let free = model(vec![Beam { strain, ..beam(ancf(nodes), angle) }], vec![]);
            let found = frequencies(&free, count, About::Reference);
            assert_eq!(found.len(), count);
            let zeros = found.iter().filter(|f| **f == 0.0).count();
            assert_eq!(zeros, count.min(3), "{nodes} nodes: {found:?}");
        }
        let pair = model(vec![beam(ancf(nodes), 0.3), beam(ancf(nodes), -1.0)], vec![]);
        let found = frequencies(&pair, 10, About::Reference);
        assert_eq!(found.iter().filter(|f| **f == 0.0).count(), 6, "{nodes} nodes: {found:?}");
        assert!(found[6] > 1.0 && close(&found[6..8], &[found[7], found[6]], 1e-7), "{found:?}");
        let pinned = model(vec![beam(ancf(nodes), 0.3)], vec![support(0.0, true, true, FixedRotation::Free)]);
        let found = frequencies(&pinned, 3, About::Reference);
        assert_eq!(found.iter().filter(|f| **f == 0.0).count(), 1, "{nodes} nodes: {found:?}");
    }
}

/// Digits lost in the matrix of a fine mesh are not lost in the frequencies.
#[test]
fn a_mesh_of_ten_thousand_elements_keeps_its_digits() {
    let unit = (2.0_f64 / 0.7).sqrt() / (2.0 * PI * LENGTH * LENGTH);
    let pinned = [0.0, 3.926_602_312_047_919, 7.068_582_745_628_732, 10.210_176_122_813_03];
    let clamped = [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613];
    for (rotation, roots) in [(FixedRotation::Free, &pinned[..]), (FixedRotation::Angle, &clamped[..])] {
        let fine = model(vec![beam(ancf(10_001), 0.3)], vec![support(0.0, true, true, rotation)]);
        let found = frequencies(&fine, roots.len(), About::Reference);
        let exact: Vec<f64> = roots.iter().map(|z: &f64| z * z * unit).collect();
        assert!(close(&found, &exact, 1e-4), "{found:?} against {exact:?}");
    }
}

#[test]
fn unstable_states_are_refused_with_advice() {
    let critical = 2.0 * PI.powi(2) / (4.0 * LENGTH * LENGTH);
    for (nodes, factor) in [(9, 1.02), (60, 1.02), (9, 1.5), (60, 3.0)] {
        let column = pulled(model(vec![beam(ancf(nodes), 0.0)], vec![clamp()]), [-factor * critical, 0.0]);
        let error = solve(&column, 3, About::Equilibrium).expect_err("beyond its critical load");
        assert!(
            matches!(error, RunError::Eigen(EigenError::Unstable { count: 1 })),
            "{nodes}, {factor}: {error}"
        );
        assert!(error.help().expect("advice").to_string().contains("[analysis.buckling]"));
        assert_eq!(error.exit_status(), 1);
        let below = pulled(model(vec![beam(ancf(nodes), 0.0)], vec![clamp()]), [-0.98 * critical, 0.0]);
        assert!(frequencies(&below, 1, About::Equilibrium)[0] > 0.0);
    }
}

/// Slightly oblique compression beyond the critical load bends the column far: that equilibrium is
/// stable, and found although one long step leads past it.
#[test]
fn a_bent_column_vibrates_about_its_stable_branch() {
    for nodes in [9, 41] {
        let column = pulled(model(vec![beam(ancf(nodes), 0.4)], vec![clamp()]), [-2.878, -1.471]);
        let found = solve(&column, 1, About::Equilibrium).expect("the bent state is stable");
        assert!((found.frequencies()[0] - 0.425).abs() < 1e-3, "{:?}", found.frequencies());
        assert!(found.equilibrium.run.warnings.is_empty(), "{:?}", found.equilibrium.run.warnings);
    }
}

#[test]
fn where_statics_fails_its_message_is_given() {
    let mut wheel = model(vec![beam(ancf(9), 0.0)], vec![support(0.0, true, true, FixedRotation::Free)]);
    wheel.parts.push(Arc::new(Moment::new(Place { beam: 0, s: LENGTH }, 1.0)));
    let error = solve(&wheel, 3, About::Equilibrium).expect_err("it turns for ever");
    assert!(matches!(error, RunError::NoEquilibrium { .. }), "{error}");
    assert!(error.help().expect("advice").to_string().contains("loads of fixed direction"));
}

#[test]
fn follower_loads_matter_only_where_they_act() {
    let mut beam = model(vec![beam(ancf(9), 0.0)], vec![clamp()]);
    let rest = frequencies(&beam, 3, About::Reference);
    beam.parts.push(Arc::new(Force::following(Place { beam: 0, s: LENGTH }, [0.0, 1.0])));
    assert_eq!(frequencies(&beam, 3, About::Reference), rest);
    let error = solve(&beam, 3, About::Equilibrium).expect_err("no symmetric tangent");
    assert!(matches!(error, RunError::Eigen(EigenError::NotSymmetric { analysis: "modal" })), "{error}");
}

/// A support that moves stretches the beam before it vibrates; the equilibrium is recorded.
#[test]
fn moved_supports_and_records_of_the_equilibrium() {
    let strain = 2e-3;
    let moved = Support {
        displacement: Displacement { x: strain * LENGTH, ..Displacement::default() },
        ..support(LENGTH, true, true, FixedRotation::Free)
    };
    let mut string =
        model(vec![beam(ancf(41), 0.0)], vec![support(0.0, true, true, FixedRotation::Free), moved]);
    string.probes = vec![Probe { name: "end".into(), at: Place { beam: 0, s: LENGTH } }];
    let found = solve(&string, 1, About::Equilibrium).expect("a stable state");
    let (k, c) = (PI / LENGTH, 1.0 + strain);
    let exact = ((2.0 * k.powi(4) / (c * c) + 1e5 * strain * k * k / c) / 0.7).sqrt() / (2.0 * PI);
    assert!(close(&found.frequencies(), &[exact], 1e-7), "{:?} against {exact}", found.frequencies());
    assert_eq!(found.equilibrium.parameter, [1.0]);
    assert!((found.equilibrium.probes[0].samples[0].x - 0.2 - LENGTH * c).abs() < 1e-12);
    assert!((found.equilibrium.energy[0].stretch - 0.5 * 1e5 * strain * strain * LENGTH).abs() < 1e-9);
    assert!(
        found.equilibrium.probes[0].samples.len() == 1
            && found.equilibrium.energy.len() == 1
            && found.modes.len() == 1
    );
    assert!(solve(&string, 1, About::Reference).expect("stable").equilibrium.parameter.is_empty());
}

/// What an equilibrium is needed for is told by the name of what asked for it, and its energies are
/// those of its own state: of a beam that bends freely as its actuator wants none is stored, and of
/// one that is held all of what is put in.
#[test]
fn vibrations_about_an_equilibrium_speak_of_themselves() {
    let about = |rest: &str| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 6 }}
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
             {rest}\nanalysis.modal = {{ count = 1, about = 'equilibrium' }}\n"
        );
        let scene = ancf::scene::parse("arm.toml", &text).unwrap_or_else(|error| panic!("{error:?}"));
        scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error:?}"))
    };
    let damped = about("effect.spring = [{ beam = 'arm', at = 'end', damping = 1 }]");
    assert!(
        damped.run().warnings[0].contains("takes no part in a modal analysis"),
        "{:?}",
        damped.run().warnings
    );
    let tied = about(
        "effect.actuation = [{ beam = 'arm', curvature = 2 }]\neffect.spring = [{ beam = 'arm', at = 'end', stiffness = 20 }]",
    );
    let energy = tied.states().energy.last().expect("an equilibrium");
    let stored = energy.stretch + energy.bend + energy.stored;
    assert!(stored > 0.1 && (energy.work - stored).abs() < 1e-6 * stored, "{} {stored}", energy.work);
}
