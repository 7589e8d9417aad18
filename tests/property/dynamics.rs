//! Motion: exact where it must be, of the order that each method promises, energy and momentum
//! kept, restarts bit for bit.

use ancf::assembly::Needs;
use ancf::effect::{Contact, Obstacle};
use ancf::effect::{Force, Gravity, Moment};
use ancf::model::{
    Beam, Centreline, Crossing, Discretization, EventKind, Fixed, FixedRotation, GaussPoints,
    InitialVelocity, Integrator, Kernel, Model, Nodes, Place, Profile, Section, SideCondition, StepControl,
    StrainMeasure, Support, Tabulated,
};
use ancf::solve::dynamics::start::from_rest;
use ancf::solve::dynamics::{Checkpoint, EventWatch, Memory, Quantity, Solution, State, Task, solve};
use ancf::system::{System, View};
use proptest::prelude::*;
use std::sync::Arc;

const LENGTH: f64 = 1.2;
const GRAVITY: [f64; 2] = [1.5, -9.0];

const fn alpha(step: StepControl, spectral_radius: f64) -> Integrator {
    Integrator::GeneralizedAlpha { step, spectral_radius, newton_tolerance: Integrator::NEWTON_TOLERANCE }
}

const ALPHA: Integrator = alpha(StepControl::Fixed(0.0), 0.8);
const GAUSS: Integrator = Integrator::Gauss { stages: 3, step: StepControl::Fixed(0.0) };

/// Every method, with its order.
fn methods() -> [(Integrator, f64); 7] {
    let step = StepControl::Fixed(0.0);
    [
        (alpha(step, 1.0), 2.0),
        (ALPHA, 2.0),
        (Integrator::Gauss { stages: 1, step }, 2.0),
        (Integrator::Gauss { stages: 2, step }, 4.0),
        (GAUSS, 6.0),
        (Integrator::Radau { stages: 2, step }, 3.0),
        (Integrator::Radau { stages: 3, step }, 5.0),
    ]
}

/// A beam under its own weight.
fn model(discretization: Discretization, supports: Vec<Support>) -> Model {
    Model {
        beams: vec![Beam {
            name: "arm".into(),
            centreline: Centreline::Line { start: [0.0, 0.0], end: [LENGTH, 0.0] },
            section: Section {
                axial_stiffness: Some(2e3.into()),
                bending_stiffness: Some(0.5.into()),
                mass_per_length: Some(0.4.into()),
                ..Default::default()
            },
            strain: StrainMeasure::Engineering,
            discretization,
            gauss_points: GaussPoints { stretch: 4, bend: 4, lobatto: false },
        }],
        supports,
        parts: vec![Arc::new(Gravity::new(GRAVITY))],
        ..Model::default()
    }
}

fn hinge(s: f64) -> Support {
    Support {
        at: Place { beam: 0, s },
        fix: Fixed { x: true, y: true, ..Fixed::default() },
        ..Support::default()
    }
}

fn build(model: &Model) -> System {
    System::build(model, Needs { inertia: true, motion: true }).expect("a legal model")
}

fn system(discretization: Discretization, supports: Vec<Support>) -> System {
    build(&model(discretization, supports))
}

fn either() -> [Discretization; 2] {
    [
        Discretization::Ancf { nodes: Nodes::Uniform(7) },
        Discretization::Rpim {
            nodes: Nodes::Uniform(6),
            kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
            polynomial_terms: 2,
            side_condition: SideCondition::Plus,
            neighbours: 2,
        },
    ]
}

fn task(system: &System, duration: f64, integrator: Integrator) -> Task<'static> {
    let start = from_rest(system, &[]).expect("at rest");
    Task {
        duration,
        output_every: duration / 8.0,
        integrator,
        start,
        watches: &[],
        reactions: false,
        forces: false,
        directions: &[],
        keep: None,
    }
}

fn moved(system: &System, duration: f64, integrator: Integrator, step: f64) -> Solution {
    finished(solve(
        system,
        &task(system, duration, integrator.with_step(StepControl::Fixed(step))),
        &mut |_, _, _| true,
    ))
}

fn finished(solution: Solution) -> Solution {
    assert!(solution.stuck.is_none(), "{:?}", solution.stuck);
    solution
}

fn last(solution: &Solution) -> &State {
    solution.states.last().expect("a last state")
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
}

#[test]
fn free_fall_is_exact() {
    for discretization in either() {
        let system = system(discretization, vec![]);
        for (integrator, _) in methods() {
            let solution = moved(&system, 0.7, integrator, 0.013);
            for state in &solution.states {
                let t = state.time;
                for (i, ((q, v), q0)) in state.q.iter().zip(&state.v).zip(system.reference()).enumerate() {
                    let g = [GRAVITY[0], GRAVITY[1], 0.0, 0.0][i % 4];
                    assert!((q - q0 - 0.5 * g * t * t).abs() < 1e-11, "coordinate {i} at {t} s");
                    assert!((v - g * t).abs() < 1e-8, "velocity {i} at {t} s: {v}");
                }
            }
        }
    }
}

/// The highest axial vibration has a period of 1.7 ms: its phase, too, must be right for the order
/// to show.
#[test]
fn errors_fall_with_the_order_of_the_method() {
    for (integrator, expected) in methods() {
        for discretization in either() {
            let system = system(discretization, vec![hinge(0.0)]);
            let step = match expected {
                2.0 => 1e-5,
                3.0 => 4e-5,
                4.0 => 1e-4,
                _ => 2e-4,
            };
            let [a, b, c] = [2.0, 1.0, 0.5].map(|f| moved(&system, 0.0256, integrator, f * step));
            let order = (distance(&last(&a).q, &last(&b).q) / distance(&last(&b).q, &last(&c).q)).log2();
            assert!(
                (order - expected).abs() < 0.15 * expected.max(3.0),
                "{integrator}: observed order {order}"
            );
        }
    }
}

/// Supports between nodes are constraint rows; they must not cost order, and hold to round-off.
#[test]
fn constraints_keep_the_order_and_are_kept() {
    for discretization in either() {
        let system = system(discretization, vec![hinge(0.13)]);
        assert_eq!(system.multipliers(), 2);
        let view = View::point(&system.beams()[0].basis, 0, 0.13).expect("on the beam");
        for (integrator, expected) in methods() {
            let step = if expected < 4.0 { 1e-5 } else { 1e-4 };
            let [a, b, c] = [4.0, 2.0, 1.0].map(|f| moved(&system, 0.0128, integrator, f * step));
            for state in &b.states {
                let [x, y] = view.fields(&state.q).position;
                assert!((x - 0.13).hypot(y) < 1e-11, "{integrator}: ({x}, {y}) at {} s", state.time);
            }
            let order = (distance(&last(&a).q, &last(&b).q) / distance(&last(&b).q, &last(&c).q)).log2();
            assert!(
                (order - expected).abs() < 0.2 * expected.max(3.0),
                "{integrator}: observed order {order}"
            );
        }
    }
}

/// A direction held at a slope of 30° needs the turned frame in mass matrix, tangent and velocities
/// alike.
#[test]
fn a_motion_does_not_depend_on_the_axes() {
    let turn = 0.5_f64;
    let (sine, cosine) = turn.sin_cos();
    let rotate = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
    for discretization in either() {
        let clamp =
            Support { fix: Fixed { x: true, y: true, rotation: FixedRotation::Angle }, ..Support::default() };
        let straight = model(discretization, vec![clamp]);
        let mut turned = straight.clone();
        turned.beams[0].centreline = Centreline::Line { start: [0.0; 2], end: rotate([LENGTH, 0.0]) };
        turned.parts = vec![Arc::new(Gravity::new(rotate(GRAVITY)))];
        for (integrator, _) in methods() {
            // Generalised-α stops its iteration at 1e-11 a step, which velocities multiply by 2/h;
            // the others at round-off.
            let allowed = if matches!(integrator, Integrator::GeneralizedAlpha { .. }) { 1e-8 } else { 1e-9 };
            let [a, b] = [&straight, &turned].map(|model| moved(&build(model), 0.1, integrator, 5e-4));
            for (a, b) in last(&a).q.chunks_exact(2).zip(last(&b).q.chunks_exact(2)) {
                let [x, y] = rotate([a[0], a[1]]);
                assert!((x - b[0]).hypot(y - b[1]) < allowed, "{integrator}: ({x}, {y}) and {b:?}");
            }
        }
    }
}

/// Where one component of a position is held and the other free, a node's turn must not mix them.
#[test]
fn a_sliding_end_stays_on_its_line() {
    for discretization in either() {
        let slider = Support { fix: Fixed { y: true, ..Fixed::default() }, ..Support::default() };
        let system = system(discretization, vec![slider]);
        let finest = last(&moved(&system, 0.2, GAUSS, 2.5e-4)).q.clone();
        for (integrator, _) in methods() {
            let state = last(&moved(&system, 0.2, integrator, 5e-4)).clone();
            assert!(state.q[1].abs() < 1e-14, "{integrator}: y = {} of the sliding end", state.q[1]);
            let error = distance(&state.q, &finest);
            assert!(error < 5e-3, "{integrator}: {error} from the finest");
        }
    }
}

fn energies(system: &System, solution: &Solution) -> (f64, f64) {
    let energies = solution.states.iter().map(|s| {
        let energy = system.energy(1.0, &s.q, Some(&s.v));
        (energy.total() - s.work, energy.kinetic)
    });
    let (total, kinetic): (Vec<f64>, Vec<f64>) = energies.unzip();
    let drift = total.iter().fold(0.0_f64, |m, e| m.max((e - total[0]).abs()));
    (drift, kinetic.iter().fold(0.0, |m: f64, e| m.max(*e)))
}

#[test]
fn the_energy_of_a_hinged_beam_errs_by_the_order_of_the_method() {
    for discretization in either() {
        let system = system(discretization, vec![hinge(0.0)]);
        let drift = |integrator, step| {
            let (drift, kinetic) = energies(&system, &moved(&system, 1.0, integrator, step));
            drift / kinetic
        };
        // The trapezoidal rule conserves no nonlinear energy, but errs by the square of the step.
        let (trapezoidal, _) = methods()[0];
        let (coarse, fine) = (drift(trapezoidal, 1e-3), drift(trapezoidal, 5e-4));
        assert!(fine < 3e-4, "drift {fine}");
        assert!((coarse / fine).log2() > 1.5, "{coarse} against {fine}");
        let gauss = drift(GAUSS, 1e-3);
        assert!(gauss < 1e-7, "drift {gauss}");
    }
}

/// The trapezoidal rule is not symplectic, but conjugate to the midpoint rule: its energy wavers
/// and does not drift. 100 s are 40,000 steps and some 60 swings.
#[test]
fn the_energy_of_the_trapezoidal_rule_is_bounded_for_long_times() {
    let system = system(Discretization::Ancf { nodes: Nodes::Uniform(4) }, vec![hinge(0.0)]);
    let (trapezoidal, _) = methods()[0];
    let wavering = |duration| {
        let (drift, kinetic) = energies(&system, &moved(&system, duration, trapezoidal, 2.5e-3));
        drift / kinetic
    };
    let (short, long) = (wavering(10.0), wavering(100.0));
    assert!(long < 0.02 && long < 4.0 * short, "{short} in 10 s, {long} in 100 s");
}

/// Moments and follower forces have no potential; what they do is work, and the balance closes.
#[test]
fn the_work_of_loads_without_potential_closes_the_balance() {
    let [ancf, rpim] = either();
    for discretization in [ancf, rpim] {
        let mut model = model(discretization, vec![hinge(0.0)]);
        let at = Place { beam: 0, s: LENGTH };
        model.parts =
            vec![Arc::new(Moment { at, value: 0.3, law: None }), Arc::new(Force::following(at, [0.05, 0.2]))];
        let system = build(&model);
        let drift = |step| {
            let solution = moved(&system, 0.4, GAUSS, step);
            let (drift, kinetic) = energies(&system, &solution);
            assert!(last(&solution).work > 0.5 * kinetic, "the loads do work: {}", last(&solution).work);
            drift / kinetic
        };
        let (coarse, fine) = (drift(8e-4), drift(4e-4));
        assert!(fine < 1e-7, "the balance is off by {fine}");
        assert!((coarse / fine).log2() > 4.5, "{coarse} against {fine}");
    }
}

fn momenta(system: &System, state: &State) -> [f64; 3] {
    let mass = system.mass_matrix();
    let mut p = vec![0.0; state.v.len()];
    mass.multiply_add(1.0, &state.v, &mut p);
    let mut sums = [0.0; 3];
    for (i, (q, p)) in state.q.chunks_exact(2).zip(p.chunks_exact(2)).enumerate() {
        // Positions of all nodes together carry the beam's translation; gradients are invariant
        // under it.
        if i % 2 == 0 {
            sums[0] += p[0];
            sums[1] += p[1];
        }
        sums[2] += q[0] * p[1] - q[1] * p[0];
    }
    sums
}

/// A damped bow whose end slides along a line: gravity along that line gives it its momentum, and with steps chosen by a tolerance Gauss' methods, which then
/// damp what is too fast for a step, neither add to that nor take of it. Its nodes turn apart, as a bow swings and bends.
///
/// Would catch ends of steps that are damped with a tangent turned node by node, which lost 1e-5 of the momentum.
#[test]
fn what_slides_has_the_momentum_that_its_weight_gives() {
    let along = [0.6, -0.8];
    let text = format!(
        "[beam.bow]\npoints = [[0, 0], [0.33, -0.15], [0.67, 0.14], [1, -0.07]]\naxial_stiffness = 2e5\nbending_stiffness = 2\nmass_per_length = 1\n\
         basis.ancf.elements = 4\n\
         [[joint]]\ntype = 'slider'\nalong = {along:?}\nfirst = {{ beam = 'bow', at = 'end' }}\n\
         [effect.gravity]\nacceleration = [-0.4, -0.26]\n\
         [[effect.damping]]\nbeam = 'bow'\nstiffness_proportional = 6e-3\n\
         [analysis.dynamic]\nduration = 2\n"
    );
    let scene = ancf::scene::parse("bow.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    let system = build(scene.model());
    for tolerance in [1e-4, 1e-5] {
        let task = task(&system, 2.0, GAUSS.with_step(StepControl::Tolerance(tolerance)));
        let solution = finished(solve(&system, &task, &mut |_, _, _| true));
        let [x, y, _] = momenta(&system, last(&solution));
        let expected = (along[0] * -0.4 + along[1] * -0.26) * system.length() * 2.0;
        let found = along[0] * x + along[1] * y;
        assert!((found - expected).abs() < 0.1 * tolerance * system.length(), "{found} for {expected}");
    }
}

proptest! {
    #![proptest_config(super::cases(12))]

    /// Gauss' methods keep quadratic invariants: linear and angular momentum to round-off, whatever
    /// the step.
    #[test]
    fn a_free_beam_keeps_its_momentum(
        vx in -3.0..3.0_f64, vy in -3.0..3.0_f64, rotation in -20.0..20.0_f64,
        bump in prop::collection::vec(-0.5..0.5_f64, 28), meshfree: bool,
    ) {
        let [ancf, rpim] = either();
        let mut model = model(if meshfree { rpim } else { ancf }, vec![]);
        model.parts.clear();
        let system = build(&model);
        let velocity = InitialVelocity { translation: [vx, vy], rotation, center: [0.2, -0.1], ..InitialVelocity::default() };
        let mut start = from_rest(&system, &[velocity]).expect("a free beam");
        start.state.v.iter_mut().zip(bump).for_each(|(v, b)| *v += b);
        for integrator in [GAUSS, Integrator::Gauss { stages: 2, step: StepControl::Fixed(0.0) }] {
            let integrator = integrator.with_step(StepControl::Fixed(2e-3));
            let task = Task { start: start.clone(), ..task(&system, 0.2, integrator) };
            let solution = finished(solve(&system, &task, &mut |_, _, _| true));
            let before = momenta(&system, &start.state);
            let after = momenta(&system, last(&solution));
            let scale = 0.4 * LENGTH * (vx.hypot(vy) + rotation.abs() * LENGTH + 0.5);
            for (a, b) in before.iter().zip(after) {
                prop_assert!((a - b).abs() < 1e-9 * scale, "{before:?} became {after:?}");
            }
        }
    }

    /// Random initial motions of a hinged beam: the total energy stays.
    #[test]
    fn a_hinged_beam_keeps_its_energy(rotation in -8.0..8.0_f64, angle in -3.0..3.0_f64, meshfree: bool) {
        let [ancf, rpim] = either();
        let mut model = model(if meshfree { rpim } else { ancf }, vec![hinge(0.0)]);
        let end = [LENGTH * angle.cos(), LENGTH * angle.sin()];
        model.beams[0].centreline = Centreline::Line { start: [0.0; 2], end };
        model.initial_velocities = vec![InitialVelocity { beam: 0, rotation, ..InitialVelocity::default() }];
        let system = build(&model);
        let start = from_rest(&system, &model.initial_velocities).expect("about the hinge");
        let integrator = GAUSS.with_step(StepControl::Fixed(1e-3));
        let task = Task { start, ..task(&system, 0.5, integrator) };
        let (drift, kinetic) = energies(&system, &finished(solve(&system, &task, &mut |_, _, _| true)));
        prop_assert!(drift < 2e-7 * kinetic.max(0.5), "drift {drift} J of {kinetic} J");
    }

    /// A run interrupted anywhere and continued from its checkpoint, through the text of its file,
    /// ends in the same bits.
    #[test]
    fn a_restart_continues_bit_for_bit(stop in 1..30_usize, method in 0..7_usize, controlled: bool) {
        let [ancf, _] = either();
        let system = system(ancf, vec![hinge(0.0)]);
        let step = if controlled { StepControl::Tolerance(1e-4) } else { StepControl::Fixed(1.7e-3) };
        let integrator = methods()[method].0.with_step(step);
        let whole = finished(solve(&system, &task(&system, 0.1, integrator), &mut |_, _, _| true));
        let mut steps = 0;
        let first = solve(&system, &task(&system, 0.1, integrator), &mut |_, _, _| {
            steps += 1;
            steps < stop
        });
        let text = serde_json::to_string(&first.checkpoint).expect("finite numbers");
        let start: Checkpoint = serde_json::from_str(&text).expect("what was written");
        let second = finished(solve(&system, &Task { start, ..task(&system, 0.1, integrator) }, &mut |_, _, _| true));
        prop_assert_eq!(&last(&second).q, &last(&whole).q);
        prop_assert_eq!(&last(&second).v, &last(&whole).v);
    }
}

/// What a beam has of momentum when it is in the air again is its weight's part and the impulses of
/// the contacts that have ended.
#[test]
fn impulses_of_contacts_balance_the_momentum() {
    let contact = |obstacle| Contact {
        beam: 0,
        obstacle,
        stiffness: 2e3,
        half_thickness: 0.01,
        friction: None,
        between: None,
    };
    let ground = Obstacle::HalfPlane { point: [0.0, -0.3], normal: [0.0, 1.0] };
    let stone = Obstacle::Circle { center: [0.9, -0.2], radius: 0.2, inside: false };
    let methods = [GAUSS.with_step(StepControl::Tolerance(1e-8)), ALPHA.with_step(StepControl::Fixed(1e-4))];
    for (discretization, method) in either().into_iter().zip(methods) {
        let mut model = model(discretization, vec![]);
        model.beams[0].centreline = Centreline::Line { start: [0.0; 2], end: [LENGTH * 0.8, LENGTH * 0.6] };
        model.add(contact(ground));
        model.add(contact(stone));
        let system = build(&model);
        let task = Task { output_every: 1e-3, ..task(&system, 0.6, method) };
        let solution = finished(solve(&system, &task, &mut |_, _, _| true));
        let changes = &solution.contacts;
        let ended = |time: f64| changes.iter().filter(move |c| c.time <= time).filter_map(|c| c.impulse);
        let in_the_air = |time: f64| {
            let touches = |contact| {
                changes.iter().rfind(|c| c.contact == contact && c.time <= time).is_some_and(|c| c.touches)
            };
            !(touches(0) || touches(1))
        };
        let before = momenta(&system, &solution.states[0]);
        let after = solution.states.iter().filter(|s| in_the_air(s.time) && ended(s.time).count() >= 2);
        let mut count = 0;
        for state in after {
            let found = momenta(&system, state);
            for axis in 0..2 {
                let impulse: f64 = ended(state.time).map(|ended| ended.impulse[axis]).sum();
                let expected = before[axis] + 0.4 * LENGTH * GRAVITY[axis] * state.time + impulse;
                let apart = (found[axis] - expected).abs();
                assert!(apart < 2e-5, "{apart} N s along {axis} at {} s, impulses {impulse} N s", state.time);
            }
            count += 1;
        }
        assert!(count > 20, "{count} records in the air, {changes:?}");
    }
}

/// A velocity that grows evenly along a straight beam is a rotation, given as a polynomial or by
/// points; momenta and the energy have closed forms.
#[test]
fn a_linear_velocity_field_is_a_rotation() {
    let rotation = 3.0;
    let straight = Tabulated::with_flat_ends(
        vec![0.0, 0.5, LENGTH],
        vec![0.0, 0.5 * rotation, LENGTH * rotation],
        [false; 2],
    );
    let fields = [
        InitialVelocity { rotation, ..InitialVelocity::default() },
        InitialVelocity {
            along: [Profile::None, Profile::Polynomial(vec![0.0, rotation])],
            ..InitialVelocity::default()
        },
        InitialVelocity {
            along: [Profile::None, Profile::Table(straight.expect("rising places"))],
            ..InitialVelocity::default()
        },
    ];
    for discretization in either() {
        let mut model = model(discretization, vec![]);
        model.parts.clear();
        let system = build(&model);
        let ends = fields.clone().map(|field| {
            let start = from_rest(&system, &[field]).expect("a free beam");
            let [_, vertical, angular] = momenta(&system, &start.state);
            let (mass, energy) = (0.4 * LENGTH, system.energy(0.0, &start.state.q, Some(&start.state.v)));
            assert!((vertical - mass * rotation * LENGTH / 2.0).abs() < 1e-12);
            assert!((angular - mass * rotation * LENGTH.powi(2) / 3.0).abs() < 1e-12);
            assert!((energy.kinetic - mass * (rotation * LENGTH).powi(2) / 6.0).abs() < 1e-12);
            let task = Task { start, ..task(&system, 0.3, GAUSS.with_step(StepControl::Fixed(2e-3))) };
            last(&finished(solve(&system, &task, &mut |_, _, _| true))).q.clone()
        });
        // Free flight: the centre goes straight up while the beam turns about it, drawn out a
        // little by its own rotation.
        let turned = 0.3 * rotation;
        let centre = [LENGTH / 2.0, 0.3 * rotation * LENGTH / 2.0];
        let q = &ends[0];
        let n = q.len();
        let middle = [0.5 * (q[0] + q[n - 4]), 0.5 * (q[1] + q[n - 3])];
        assert!((middle[0] - centre[0]).hypot(middle[1] - centre[1]) < 1e-9, "{middle:?}, not {centre:?}");
        assert!(((q[n - 3] - q[1]).atan2(q[n - 4] - q[0]) - turned).abs() < 1e-3);
        for end in &ends[1..] {
            let apart = q.iter().zip(end).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(apart < 1e-10, "{apart}");
        }
    }
}

/// What a velocity of cubic shape has of energy and momentum, by integration of the polynomial;
/// elements of third degree have it exactly.
#[test]
fn a_cubic_velocity_field_has_its_energy() {
    let [discretization, _] = either();
    let model = model(discretization, vec![]);
    let system = build(&model);
    let (a, b) = ([0.3, -1.0, 0.0, 0.8], [0.0, 0.5, 2.0, -1.1]);
    let along = [a, b].map(|c| Profile::Polynomial(c.to_vec()));
    let start = from_rest(&system, &[InitialVelocity { along, ..InitialVelocity::default() }]).expect("free");
    let moment = |c: [f64; 4], d: [f64; 4]| -> f64 {
        let pairs = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
        pairs.map(|(i, j)| c[i] * d[j] * LENGTH.powi((i + j) as i32 + 1) / (i + j + 1) as f64).sum()
    };
    let kinetic = 0.5 * 0.4 * (moment(a, a) + moment(b, b));
    let found = system.energy(0.0, &start.state.q, Some(&start.state.v)).kinetic;
    assert!((found - kinetic).abs() < 1e-12 * kinetic, "{found} J, not {kinetic} J");
    let one = [1.0, 0.0, 0.0, 0.0];
    let [px, py, _] = momenta(&system, &start.state);
    assert!((px - 0.4 * moment(a, one)).abs() < 1e-12 && (py - 0.4 * moment(b, one)).abs() < 1e-12);
}

/// A hundred revolutions of a free beam, 20,000 steps: momenta stay to round-off, the energy wavers
/// no more in the second half than in the first, and a run continued from the middle ends in the
/// same bits.
#[test]
fn a_spinning_beam_keeps_momenta_and_energy_for_long_times_and_restarts_in_their_middle() {
    let mut model = model(Discretization::Ancf { nodes: Nodes::Uniform(4) }, vec![]);
    model.parts.clear();
    let system = build(&model);
    let (translation, center) = ([0.03, 0.01], [LENGTH / 2.0, 0.0]);
    let velocity = InitialVelocity {
        translation,
        rotation: std::f64::consts::TAU,
        center,
        ..InitialVelocity::default()
    };
    let start = from_rest(&system, &[velocity]).expect("a free beam");
    let integrator = GAUSS.with_step(StepControl::Fixed(5e-3));
    let whole = Task { start: start.clone(), ..task(&system, 100.0, integrator) };
    let middle = std::cell::Cell::new(0.0);
    let solution = finished(solve(&system, &whole, &mut |_, _, _| true));

    let scale = 0.4 * LENGTH * LENGTH * std::f64::consts::TAU;
    for (a, b) in momenta(&system, &start.state).iter().zip(momenta(&system, last(&solution))) {
        assert!((a - b).abs() < 1e-8 * scale, "a momentum of {a} became {b}");
    }
    let half = |states: &[State]| {
        let part = Solution { states: states.to_vec(), ..Solution::default() };
        let (drift, kinetic) = energies(&system, &part);
        drift / kinetic
    };
    let (first, second) = solution.states.split_at(solution.states.len() / 2);
    let (early, late) = (half(first), half(second));
    assert!(early < 1e-6 && late < 1e-6 && late < 5.0 * early.max(1e-9), "{early}, then {late}");

    let interrupted = solve(&system, &whole, &mut |time, _, _| {
        middle.set(time);
        time < 50.0
    });
    assert!((middle.get() - 50.0).abs() < 0.01);
    let text = serde_json::to_string(&interrupted.checkpoint).expect("finite numbers");
    let start: Checkpoint = serde_json::from_str(&text).expect("what was written");
    let rest =
        finished(solve(&system, &Task { start, ..task(&system, 100.0, integrator) }, &mut |_, _, _| true));
    assert_eq!(last(&rest).q, last(&solution).q);
    assert_eq!(last(&rest).v, last(&solution).v);
}

/// The stated accuracy of positions is what comes out, and a tighter one costs more.
#[test]
fn steps_meet_the_stated_accuracy() {
    let [ancf, _] = either();
    let system = system(ancf, vec![hinge(0.0)]);
    let reference = moved(&system, 0.3, GAUSS, 1e-4);
    for (integrator, _) in methods() {
        let mut work = 0;
        for tolerance in [1e-3, 1e-5] {
            let integrator = integrator.with_step(StepControl::Tolerance(tolerance));
            let solution = finished(solve(&system, &task(&system, 0.3, integrator), &mut |_, _, _| true));
            let pairs = last(&solution).q.chunks_exact(4).zip(last(&reference).q.chunks_exact(4));
            let error = pairs.fold(0.0_f64, |m, (a, b)| m.max((a[0] - b[0]).hypot(a[1] - b[1])));
            assert!(error < 3.0 * tolerance * LENGTH, "{integrator}: error {error} m");
            assert!(solution.statistics.steps > work, "{integrator}: {} steps", solution.statistics.steps);
            work = solution.statistics.steps;
        }
    }
}

/// Records lie where they were asked for, also between steps, and the last at the end; between
/// steps they are as accurate as the steps themselves.
#[test]
fn records_stand_at_the_times_asked_for() {
    let [ancf, _] = either();
    let system = system(ancf, vec![hinge(0.0)]);
    let expected = [0.0, 0.03, 0.06, 0.09, 0.1];
    for ((integrator, order), step) in [(methods()[0], 7e-5), (methods()[4], 4e-4)] {
        let states = |step| {
            let integrator = integrator.with_step(StepControl::Fixed(step));
            let task = Task { output_every: 0.03, ..task(&system, 0.1, integrator) };
            finished(solve(&system, &task, &mut |_, _, _| true)).states
        };
        let [coarse, middle, fine] = [1.0, 0.5, 0.25].map(|f| states(f * step));
        assert_eq!(coarse.len(), expected.len());
        for (state, expected) in coarse.iter().zip(expected) {
            assert!((state.time - expected).abs() < 1e-12, "{} for {expected}", state.time);
        }
        for i in 1..expected.len() {
            let observed = (distance(&coarse[i].q, &middle[i].q) / distance(&middle[i].q, &fine[i].q)).log2();
            assert!(observed > order - 0.8, "{integrator}: order {observed} at {} s", expected[i]);
        }
    }
}

/// A stone on a beam that falls freely: the height is known, so is the time at which it is passed.
#[test]
fn events_are_located_to_the_accuracy_of_the_motion() {
    for discretization in either() {
        let system = system(discretization, vec![]);
        let watch = |crossing, stop| {
            let view = View::point(&system.beams()[0].basis, 0, LENGTH).expect("on the beam");
            let when = EventKind::Reaches { value: -1.0, crossing };
            EventWatch {
                quantity: Quantity::Position(view.clone(), 1),
                place: view,
                round_off: 0.0,
                is_rate: false,
                is_relative: false,
                is_square: false,
                when,
                stop,
            }
        };
        let watches =
            [watch(Crossing::Rising, true), watch(Crossing::Any, false), watch(Crossing::Falling, true)];
        for (integrator, _) in methods() {
            let integrator = integrator.with_step(StepControl::Fixed(0.013));
            let task = Task { watches: &watches, ..task(&system, 2.0, integrator) };
            let solution = finished(solve(&system, &task, &mut |_, _, _| true));
            let time = (2.0 / -GRAVITY[1]).sqrt();
            let numbers: Vec<usize> = solution.events.iter().map(|event| event.watch).collect();
            assert_eq!(numbers, [1, 2], "the rising one does not happen");
            assert!((last(&solution).time - time).abs() < 1e-9, "{} instead of {time}", last(&solution).time);
            // A method goes on from before the step that the event cuts short, which is taken once
            // more.
            let checkpoint = solution.checkpoint.as_ref().expect("a checkpoint");
            assert!(checkpoint.state.time < time && checkpoint.state.time + 0.013 > time);
            assert_eq!(checkpoint.reached().time, last(&solution).time);
            assert!(checkpoint.memory != Memory::None);
        }
    }
}

/// What a support holds cannot have a velocity; a rotation about the hinge is legal, and so is a
/// free beam's.
#[test]
fn velocities_against_supports_are_refused() {
    let [ancf, _] = either();
    let pinned = system(ancf, vec![hinge(0.0)]);
    let spin = |center| InitialVelocity { beam: 0, rotation: 3.0, center, ..InitialVelocity::default() };
    let start = from_rest(&pinned, &[spin([0.0, 0.0])]).expect("about the hinge");
    let tip = start.state.v.len() - 4;
    assert!((start.state.v[tip + 1] - 3.0 * LENGTH).abs() < 1e-9, "{:?}", &start.state.v[tip..]);
    let error = from_rest(&pinned, &[spin([0.1, 0.0])]).expect_err("the hinge would move");
    assert!(error.to_string().contains("beam `arm`"), "{error}");
}

/// A support that moves must say how in time.
#[test]
fn prescribed_motion_needs_a_law_of_time() {
    use ancf::model::{Analysis, Displacement, Dynamic};
    let [ancf, _] = either();
    let mut model = model(ancf, vec![hinge(0.0)]);
    model.supports[0].displacement = Displacement { y: 0.1, ..Displacement::default() };
    let integrator = ALPHA.with_step(StepControl::Fixed(1e-3));
    let analysis =
        Analysis::Dynamic(Dynamic { duration: 0.1, output_every: 0.1, integrator, events: vec![] });
    let error = model.solve(&analysis).expect_err("no law");
    assert_eq!(error.exit_status(), 2);
    assert!(error.to_string().contains("does not say how in time"), "{error}");
}
