//! Springs, masses, damping, fluids, contacts: derivatives of their densities, and what they do in motion.

use ancf::effect::{
    Actuation, BeamDamping, BendDamping, Contact, Dashpot, Density, Dissipation, Drag, Engineering,
    Foundation, Friction, Green, Gyration, Inertia, Obstacle, Penalty, PointMass, PreCurvature, PreStrain,
    RotaryInertia, SectionInertia, Spring, StretchDamping, Strut, Tie, Torsion, TorsionDashpot,
    TorsionSpring,
};
use ancf::model::*;
use ancf::run::{Control, run};
use ancf::system::assembly::Part;
use ancf::trajectory::{Event, Trajectory};
use nalgebra::{DVector, Dyn, Vector2};
use num_dual::{Dual2Vec, DualNum, hessian};
use proptest::prelude::*;
use std::sync::Arc;

type Dual = Dual2Vec<f64, Dyn>;
type Field = [Dual; 2];

fn flat<const M: usize>(z: &[Vector2<f64>; M]) -> DVector<f64> {
    DVector::from_iterator(2 * M, z.iter().flat_map(|z| [z.x, z.y]))
}

/// Energy, gradient and Hessian of a density against dual numbers through the formula `energy`.
fn derivatives<D: Density<M>, const M: usize>(
    density: &D,
    z: [Vector2<f64>; M],
    energy: impl Fn(&[Field]) -> Dual,
) {
    let split = |x: DVector<Dual>| -> Vec<Field> {
        x.as_slice().chunks_exact(2).map(|z| [z[0].clone(), z[1].clone()]).collect()
    };
    let (value, first, second) = hessian(|x| energy(&split(x)), &flat(&z));
    let (gradient, tangent) = density.gradient_and_hessian(0, &z, &z, &[Vector2::zeros(); M]);
    let scale = second.amax().max(first.amax()).max(value.abs()).max(1e-12);
    assert!((density.energy(0, &z) - value).abs() < 1e-11 * scale, "energy");
    assert!((flat(&gradient) - &first).amax() < 1e-11 * scale, "gradient {gradient:?}, not {first}");
    assert!((flat(&density.gradient(0, &z)) - &first).amax() < 1e-11 * scale, "gradient alone");
    for m in 0..M {
        for n in 0..M {
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let (ours, exact) = (tangent[m][n][(i, j)], second[(2 * m + i, 2 * n + j)]);
                assert!((ours - exact).abs() < 1e-10 * scale, "hessian {m}{n}{i}{j}: {ours}, not {exact}");
            }
        }
    }
}

/// Force and matrix of a dissipation function R(ż) at the state z.
fn rates<D: Dissipation<M>, const M: usize>(
    density: &D,
    z: [Vector2<f64>; M],
    rate: [Vector2<f64>; M],
    function: impl Fn(&[Field]) -> Dual,
) {
    struct AtState<'d, D, const M: usize>(&'d D, [Vector2<f64>; M], f64);
    impl<D: Dissipation<M>, const M: usize> Density<M> for AtState<'_, D, M> {
        const ORDERS: [usize; M] = D::ORDERS;
        fn energy(&self, _: usize, _: &[Vector2<f64>; M]) -> f64 {
            self.2
        }
        fn gradient(&self, point: usize, rate: &[Vector2<f64>; M]) -> [Vector2<f64>; M] {
            self.0.force(point, &self.1, rate)
        }
        fn gradient_and_hessian(
            &self,
            point: usize,
            rate: &[Vector2<f64>; M],
            _: &[Vector2<f64>; M],
            _: &[Vector2<f64>; M],
        ) -> ([Vector2<f64>; M], ancf::effect::Hessian<M>) {
            self.0.force_and_matrix(point, &self.1, rate)
        }
    }
    let constant: Vec<Field> = rate.iter().map(|r| [Dual::from(r.x), Dual::from(r.y)]).collect();
    let value = function(&constant).re;
    derivatives(&AtState(density, z, value), rate, function);
}

fn dual(z: &Vector2<f64>) -> Field {
    [Dual::from(z.x), Dual::from(z.y)]
}

fn dot(a: &Field, b: &Field) -> Dual {
    a[0].clone() * b[0].clone() + a[1].clone() * b[1].clone()
}

fn cross(a: &Field, b: &Field) -> Dual {
    a[0].clone() * b[1].clone() - a[1].clone() * b[0].clone()
}

fn minus(a: &Field, b: [f64; 2]) -> Field {
    [a[0].clone() - b[0], a[1].clone() - b[1]]
}

fn square(x: Dual) -> Dual {
    x.clone() * x
}

fn abs(x: Dual) -> Dual {
    if x.re < 0.0 { -x } else { x }
}

fn vector() -> impl Strategy<Value = Vector2<f64>> {
    (-2.0..2.0_f64, -2.0..2.0_f64).prop_map(|(x, y)| Vector2::new(x, y))
}

fn gradient() -> impl Strategy<Value = Vector2<f64>> {
    (0.6..1.5_f64, -3.1..3.1_f64).prop_map(|(r, a)| Vector2::new(r * a.cos(), r * a.sin()))
}

proptest! {
    #![proptest_config(super::cases(64))]

    #[test]
    fn energies_of_springs_and_actuations(r in vector(), g in gradient(), c in vector()) {
        let tie = Tie::new([3.0, 0.5], vec![Vector2::new(0.2, -0.1)]);
        derivatives(&tie, [r], |z| {
            let [x, y] = minus(&z[0], [0.2, -0.1]);
            square(x) * 1.5 + square(y) * 0.25
        });
        for length in [0.0, 0.4] {
            let strut = Strut::new(2.0, [0.1, 0.3], length);
            derivatives(&strut, [r], |z| {
                let d = minus(&z[0], [0.1, 0.3]);
                square(dot(&d, &d).sqrt() - length)
            });
        }
        let torsion = Torsion::new(1.7, [0.6, -0.8]);
        let t0: Field = [Dual::from(0.6), Dual::from(-0.8)];
        derivatives(&torsion, [g], |z| square(cross(&t0, &z[0]).atan2(dot(&t0, &z[0]))) * 0.85);
        derivatives(&PreStrain::<Green>::new(2.5), [g], |z| (dot(&z[0], &z[0]) - 1.0) * -1.25);
        derivatives(&PreStrain::<Engineering>::new(2.5), [g], |z| (dot(&z[0], &z[0]).sqrt() - 1.0) * -2.5);
        derivatives(&PreCurvature { moment: 0.7 }, [g, c], |z| {
            cross(&z[0], &z[1]) / dot(&z[0], &z[0]) * -0.7
        });
        derivatives(&Inertia { mass_per_length: 0.3 }, [c], |z| dot(&z[0], &z[0]) * 0.15);
    }

    #[test]
    fn energies_of_contacts(r in vector()) {
        let penalty = |obstacle| Penalty { obstacle, stiffness: 40.0, gap: 0.1 };
        let depth = |distance: Dual| {
            let depth = -distance + 0.1;
            if depth.re > 0.0 { square(depth) * 20.0 } else { Dual::from(0.0) }
        };
        for inside in [false, true] {
            let circle = penalty(Obstacle::Circle { center: [0.3, 0.1], radius: 0.9, inside });
            derivatives(&circle, [r], |z| {
                let d = minus(&z[0], [0.3, 0.1]);
                let length = dot(&d, &d).sqrt();
                depth(if inside { -length + 0.9 } else { length - 0.9 })
            });
        }
        let plane = penalty(Obstacle::HalfPlane { point: [0.0, 0.2], normal: [0.6, 0.8] });
        derivatives(&plane, [r], |z| {
            let [x, y] = minus(&z[0], [0.0, 0.2]);
            depth(x * 0.6 + y * 0.8)
        });
        let angle = 0.4_f64;
        let rectangle = penalty(Obstacle::Box { center: [0.1, -0.2], half: [0.8, 0.5], angle });
        derivatives(&rectangle, [r], |z| {
            let [x, y] = minus(&z[0], [0.1, -0.2]);
            let (s, c) = angle.sin_cos();
            let local = [x.clone() * c + y.clone() * s, y * c - x * s];
            let beyond = [abs(local[0].clone()) - 0.8, abs(local[1].clone()) - 0.5];
            depth(if beyond[0].re > 0.0 && beyond[1].re > 0.0 {
                dot(&beyond, &beyond).sqrt()
            } else if beyond[0].re > beyond[1].re {
                beyond[0].clone()
            } else {
                beyond[1].clone()
            })
        });
    }

    #[test]
    fn dissipation_functions(r in vector(), g in gradient(), c in vector(), v in vector(), w in vector()) {
        let g_dual = dual(&g);
        rates(&StretchDamping::<Green>::new(1.3), [g], [w], |v| square(dot(&g_dual, &v[0])) * 0.65);
        rates(&StretchDamping::<Engineering>::new(1.3), [g], [w], |v| {
            square(dot(&g_dual, &v[0]) / g.norm()) * 0.65
        });
        // κ̇ by differentiating κ along the velocity.
        rates(&BendDamping { coefficient: 0.8 }, [g, c], [v, w], |rate| {
            let (a, b) = (&rate[0], &rate[1]);
            let (square_, kappa) = (g.norm_squared(), (g.x * c.y - g.y * c.x) / g.norm_squared());
            let turned = cross(a, &dual(&c)) + cross(&g_dual, b);
            let stretched = dot(&g_dual, a) * (2.0 * kappa);
            square((turned - stretched) / square_) * 0.4
        });
        rates(&Dashpot { coefficient: 2.0, anchor: None }, [r], [v], |v| dot(&v[0], &v[0]));
        let anchor = Vector2::new(0.1, 0.3);
        let e = (r - anchor).normalize();
        rates(&Dashpot { coefficient: 2.0, anchor: Some(anchor) }, [r], [v], |v| square(dot(&dual(&e), &v[0])));
        rates(&RotaryInertia { inertia: 0.6 }, [g], [w], |v| {
            square(cross(&g_dual, &v[0]) / g.norm_squared()) * 0.3
        });
        // J θ̈ ∂θ/∂r' along a straight line of gradients.
        let along = |h: f64| g + w * h;
        let turn = |h: f64| (g.x * along(h).y - g.y * along(h).x).atan2(g.dot(&along(h)));
        let second = (turn(1e-4) + turn(-1e-4)) / 1e-8;
        let [force] = Gyration(RotaryInertia { inertia: 0.6 }).force(0, &[g], &[w]);
        let expected = Vector2::new(-g.y, g.x) * (0.6 * second / g.norm_squared());
        prop_assert!((force - expected).amax() < 1e-5 * (1.0 + expected.amax()), "{force} and {expected}");
        rates(&TorsionDashpot { coefficient: 0.6 }, [g], [w], |v| {
            square(cross(&g_dual, &v[0]) / g.norm_squared()) * 0.3
        });
        let drag = Drag { beam: 0, viscous: [0.2, 0.5], quadratic: [0.1, 3.0], flow: [0.4, -0.3] };
        rates(&drag, [r, g], [v, w], |rate| {
            let u = minus(&rate[0], [0.4, -0.3]);
            let along = dot(&g_dual, &u) / g.norm();
            let across = cross(&g_dual, &u) / g.norm();
            square(along.clone()) * 0.1 + square(across.clone()) * 0.25
                + abs(along).powi(3) * (0.1 / 3.0) + abs(across).powi(3)
        });
    }
}

const LENGTH: f64 = 1.2;

fn ancf(elements: usize) -> Discretization {
    Discretization::Ancf { nodes: Nodes::Uniform(elements + 1) }
}

fn beam(name: &str, start: [f64; 2], end: [f64; 2], discretization: Discretization) -> Beam {
    Beam {
        name: name.into(),
        centreline: Centreline::Line { start, end },
        section: Section {
            axial_stiffness: Some(2e3),
            bending_stiffness: Some(0.5),
            mass_per_length: Some(0.4),
        },
        strain: StrainMeasure::Engineering,
        discretization,
        gauss_points: GaussPoints { stretch: 4, bend: 3, lobatto: false },
    }
}

fn support(s: f64, rotation: FixedRotation) -> Support {
    Support { at: Place { beam: 0, s }, fix: Fixed { x: true, y: true, rotation }, ..Support::default() }
}

fn tip(beam: usize, s: f64) -> Vec<Probe> {
    vec![Probe { name: "tip".into(), at: Place { beam, s } }]
}

fn one(supports: Vec<Support>, parts: Vec<Arc<dyn Part>>) -> Model {
    Model {
        beams: vec![beam("arm", [0.0, 0.0], [LENGTH, 0.0], ancf(6))],
        supports,
        parts,
        probes: tip(0, LENGTH),
        outputs: Outputs { reactions: true, effects: true },
        ..Model::default()
    }
}

fn moved(model: &Model, duration: f64, integrator: Integrator) -> Trajectory {
    let analysis =
        Analysis::Dynamic(Dynamic { duration, output_every: duration / 20.0, integrator, events: vec![] });
    run(model, &analysis, &mut |_| Control::Continue).expect("a motion")
}

fn still(model: &Model) -> Trajectory {
    run(model, &Analysis::Static(Static::default()), &mut |_| Control::Continue).expect("an equilibrium")
}

fn gauss(step: f64) -> Integrator {
    Integrator::Gauss { stages: 3, step: StepControl::Fixed(step) }
}

/// Every method with a fixed step, and its order.
fn methods(step: f64) -> Vec<(Integrator, f64)> {
    let step = StepControl::Fixed(step);
    let alpha =
        |spectral_radius| Integrator::GeneralizedAlpha { step, spectral_radius, newton_tolerance: 1e-12 };
    vec![
        (alpha(1.0), 2.0),
        (alpha(0.8), 2.0),
        (Integrator::Gauss { stages: 1, step }, 2.0),
        (Integrator::Gauss { stages: 2, step }, 4.0),
        (Integrator::Gauss { stages: 3, step }, 6.0),
        (Integrator::Radau { stages: 2, step }, 3.0),
        (Integrator::Radau { stages: 3, step }, 5.0),
    ]
}

fn imbalance(trajectory: &Trajectory) -> f64 {
    let first = trajectory.energy[0].total();
    let kinetic = trajectory.energy.iter().fold(0.0_f64, |m, e| m.max(e.kinetic));
    trajectory.energy.iter().fold(0.0_f64, |m, e| m.max((e.total() - first).abs())) / kinetic
}

/// A hub that is turned by a law, with all that depends on velocity: supports whose frames turn, damping matrices, laws of time.
fn driven(rotation: FixedRotation, duration: f64) -> Model {
    let hub = Support {
        displacement: Displacement { x: 0.05, y: 0.0, angle: 0.7 },
        law: Some(Law::SmoothRamp { start: 0.0, duration }),
        ..support(0.0, rotation)
    };
    let at = Place { beam: 0, s: LENGTH };
    let parts: Vec<Arc<dyn Part>> = vec![
        Arc::new(BeamDamping {
            beam: 0,
            mass_proportional: Some(0.5),
            strain: Some(2e-4),
            curvature: Some(2e-3),
        }),
        Arc::new(Drag { beam: 0, viscous: [0.1, 0.1], quadratic: [0.0, 0.2], flow: [0.3, 0.0] }),
        Arc::new(PointMass { at, mass: Some(0.1), rotary_inertia: Some(1e-3) }),
        Arc::new(Spring {
            at,
            anchor: Some([1.0, 1.0]),
            length: Some(0.8),
            stiffness: Some(3.0),
            damping: Some(0.1),
        }),
        Arc::new(TorsionSpring { at, stiffness: Some(0.1), damping: Some(0.01) }),
        Arc::new(SectionInertia { beam: 0, per_length: 1e-4 }),
        Arc::new(Foundation { beam: 0, stiffness: [0.5, 2.0] }),
        Arc::new(Actuation {
            beam: 0,
            strain: Some(1e-3),
            curvature: Some(0.3),
            law: Some(Law::Polynomial(vec![0.0, 2.0, -1.0])),
        }),
    ];
    let mut model = one(vec![hub], parts);
    let push = Load::Force { at, value: [0.0, 0.3], follower: true };
    model.loads = vec![
        Load::Gravity { acceleration: [0.0, -9.81] },
        Load::InTime { load: Box::new(push), law: Law::Harmonic { frequency: 20.0, phase: 0.0 } },
    ];
    model
}

/// Places after a short while with three steps, each half of the one before. Catches a term of time or velocity that is taken at
/// another time than its method wants, which costs a method its order. Steps are such that the fastest waves are
/// resolved, without which no order shows, and changes are a hundred times round-off, without which chance decides.
#[test]
fn what_depends_on_time_and_velocity_keeps_the_order_of_every_method() {
    const ROUND_OFF: f64 = 1e-14;
    let mut wrong = Vec::new();
    for rotation in [FixedRotation::Gradient, FixedRotation::Angle] {
        let model = driven(rotation, 0.08);
        for (integrator, expected) in methods(1.0) {
            let (step, within): (f64, f64) = match expected {
                2.0 => (1e-4, 0.05),
                3.0 => (1e-4, 0.25),
                4.0 => (4e-4, 0.1),
                5.0 => (4e-4, 0.4),
                _ => (8e-4, 0.5),
            };
            let at = |factor: f64| {
                let integrator = super::dynamics::with_step(integrator, StepControl::Fixed(factor * step));
                let trajectory = moved(&model, 0.0512, integrator);
                let sample = *trajectory.probes[0].samples.last().expect("a record");
                [sample.x, sample.y]
            };
            let [a, b, c] = [2.0, 1.0, 0.5].map(at);
            let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
            let changes = [distance(a, b), distance(b, c)];
            let order = (changes[0] / changes[1]).log2();
            if (order - expected).abs() > within || changes[1] < 100.0 * ROUND_OFF {
                wrong.push(format!("{rotation:?}, {integrator}: order {order}, changes {changes:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_is_lost_and_put_in_closes_the_balance_of_energy() {
    for rotation in [FixedRotation::Gradient, FixedRotation::Angle] {
        let trajectory = moved(&driven(rotation, 0.4), 0.5, gauss(5e-4));
        let last = trajectory.energy.last().expect("a record");
        assert!(last.lost > 0.01 * last.kinetic && last.work.abs() > 0.01 * last.kinetic, "{last:?}");
        let off = imbalance(&trajectory);
        assert!(off < 2e-6, "{rotation:?}: the balance is off by {off}");
    }
}

/// A step of fixed length that gains energy is divided, though damping takes more than it gains.
#[test]
fn damping_hides_no_gain() {
    let coarse = "analysis.dynamic={duration='1 s',output_every='40 ms',generalized_alpha={step='40 ms',spectral_radius=1.0}}";
    let damped = "effect.damping=[{beam='arm',mass_proportional=1.0}]";
    let path = ancf_check::Suite::here().cases_folder().join("hard-coarse-steps/scene.toml");
    let scene = ancf::scene::Scene::load(&path, &[coarse, damped].map(String::from)).expect("a legal scene");
    let trajectory = run(scene.model(), scene.analysis(), &mut |_| Control::Continue).expect("a motion");
    // Of the first step, which starts from rest, the trapezoidal rule counts a larger loss than there is.
    for pair in trajectory.energy[1..].windows(2) {
        let gain = (pair[1].total() - pair[0].total()) / pair[0].kinetic.max(pair[1].kinetic);
        assert!(gain < 5e-3, "a step gains {gain} of the kinetic energy");
    }
}

/// A rigid beam in free flight loses its speed as exp(−αt), and nothing by its material's damping.
#[test]
fn mass_damping_slows_free_flight() {
    let alpha = 3.0;
    let damping =
        BeamDamping { beam: 0, mass_proportional: Some(alpha), strain: Some(1e-3), curvature: Some(1e-2) };
    let mut model = one(vec![], vec![Arc::new(damping)]);
    model.initial_velocities =
        vec![InitialVelocity { translation: [2.0, 1.0], ..InitialVelocity::default() }];
    let trajectory = moved(&model, 0.5, gauss(1e-2));
    let last = trajectory.probes[0].samples.last().expect("a record");
    let left = (-alpha * 0.5_f64).exp();
    assert!((last.vx.unwrap_or(0.0) - 2.0 * left).abs() < 1e-9, "{last:?}");
    assert!((last.y - (1.0 - left) / alpha).abs() < 1e-9, "{last:?}");
}

/// A hub at rest that starts to turn with constant speed, without bending it, carries the beam as a rigid body if that starts so too.
#[test]
fn a_hub_of_constant_speed_keeps_a_rigid_rotation_in_its_equilibrium() {
    let speed = 4.0;
    let hub = Support {
        displacement: Displacement { angle: speed, ..Displacement::default() },
        law: Some(Law::Polynomial(vec![0.0, 1.0])),
        ..support(0.0, FixedRotation::Angle)
    };
    let mut model = one(
        vec![hub],
        vec![Arc::new(BeamDamping { strain: Some(0.02), curvature: Some(0.4), ..BeamDamping::default() })],
    );
    model.initial_velocities = vec![InitialVelocity { rotation: speed, ..InitialVelocity::default() }];
    let trajectory = moved(&model, 6.0, gauss(2e-3));
    let last = trajectory.probes[0].samples.last().expect("a record");
    // The stretched radius: u'' EA + ρA Ω² (s + u) = 0, u(0) = 0, u'(L) = 0, so s + u = sin(ks)/(k cos(kL)).
    let k = speed * (0.4_f64 / 2e3).sqrt();
    let radius = (k * LENGTH).tan() / k;
    assert!((last.x.hypot(last.y) - radius).abs() < 1e-8, "radius {} and not {radius}", last.x.hypot(last.y));
    // The slowest vibration about it has not quite died out.
    assert!((last.angle - speed * 6.0).abs() < 1e-5, "angle {}", last.angle);
    // The hub pulls with ∫ ρA Ω² r ds.
    let pull = trajectory.reactions[0].samples.last().expect("a record");
    let exact = 2e3 * (1.0 / (k * LENGTH).cos() - 1.0);
    let found = pull.fx.hypot(pull.fy);
    assert!((found - exact).abs() < 1e-4 * exact, "{found} N and not {exact} N");
}

/// One beam and two that are welded are the same but for the stretch at the weld, which is free to jump there: with finer meshes they become one.
#[test]
fn a_weld_makes_one_beam_of_two() {
    let half = 0.5 * LENGTH;
    let apart = |compute: &dyn Fn(&Model) -> Trajectory, elements: usize| {
        let mut whole = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
        whole.beams = vec![beam("arm", [0.0, 0.0], [LENGTH, 0.0], ancf(2 * elements))];
        let mut parts = Model {
            beams: vec![
                beam("left", [0.0, 0.0], [half, 0.0], ancf(elements)),
                beam("right", [half, 0.0], [LENGTH, 0.0], ancf(elements)),
            ],
            joints: vec![Joint::Weld {
                first: Place { beam: 0, s: half },
                second: Place { beam: 1, s: 0.0 },
            }],
            probes: tip(1, half),
            ..whole.clone()
        };
        whole.loads =
            vec![Load::Force { at: Place { beam: 0, s: LENGTH }, value: [-0.1, 0.6], follower: true }];
        parts.loads =
            vec![Load::Force { at: Place { beam: 1, s: half }, value: [-0.1, 0.6], follower: true }];
        let [a, b] =
            [&whole, &parts].map(|model| *compute(model).probes[0].samples.last().expect("a record"));
        assert!((a.y).abs() > 0.05, "it bends");
        (a.x - b.x).hypot(a.y - b.y)
    };
    for compute in [
        &(|model: &Model| still(model)) as &dyn Fn(&Model) -> Trajectory,
        &|model: &Model| moved(model, 0.3, gauss(1e-3)),
        &|model: &Model| moved(model, 0.3, methods(1e-3)[1].0),
    ] {
        let [coarse, fine] = [3, 6].map(|elements| apart(compute, elements));
        assert!(fine < (coarse / 8.0).max(2e-7), "{coarse:.2e} and {fine:.2e}");
    }
}

/// Right angle: the corner stays one, both beams bend, and what supports and joints bear is in equilibrium with the load.
#[test]
fn a_corner_keeps_its_angle_and_passes_forces_on() {
    let mut model = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
    model.beams.push(beam("up", [LENGTH, 0.0], [LENGTH, 0.8], ancf(5)));
    model.joints =
        vec![Joint::Weld { first: Place { beam: 0, s: LENGTH }, second: Place { beam: 1, s: 0.0 } }];
    model.loads = vec![Load::Force { at: Place { beam: 1, s: 0.8 }, value: [0.2, 0.1], follower: false }];
    model.probes = vec![
        Probe { name: "corner".into(), at: Place { beam: 0, s: LENGTH } },
        Probe { name: "foot".into(), at: Place { beam: 1, s: 0.0 } },
        Probe { name: "top".into(), at: Place { beam: 1, s: 0.8 } },
    ];
    let trajectory = still(&model);
    let [corner, foot, top] = [0, 1, 2].map(|i| *trajectory.probes[i].samples.last().expect("a record"));
    assert!(corner.angle.abs() > 0.1, "it bends by {}", corner.angle);
    assert!((foot.angle - corner.angle - std::f64::consts::FRAC_PI_2).abs() < 1e-10);
    let [clamp, joint] = [0, 1].map(|i| *trajectory.reactions[i].samples.last().expect("a record"));
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} and not {b}");
    near(clamp.fx, -0.2);
    near(clamp.fy, -0.1);
    near(clamp.moment, 0.2 * top.y - 0.1 * top.x);
    near(joint.fx, -0.2);
    near(joint.fy, -0.1);
    near(joint.moment, 0.2 * (top.y - foot.y) - 0.1 * (top.x - foot.x));
    // Section forces say the same, but for the accuracy of second derivatives.
    let arm = &trajectory.last[0];
    assert!(
        (arm.bending_moment[0] + clamp.moment).abs() < 0.02 * clamp.moment.abs(),
        "{}",
        arm.bending_moment[0]
    );
}

/// A hinge passes no moment on; the lower half of a hanging double pendulum hangs straight.
#[test]
fn a_chain_of_hinges_keeps_together_and_its_energy() {
    let half = 0.5 * LENGTH;
    let rpim = Discretization::Rpim {
        nodes: Nodes::Uniform(6),
        kernel: Kernel::Multiquadric { q: 1.03, shape: 5.0 },
        polynomial_terms: 2,
        side_condition: SideCondition::Plus,
        neighbours: 2,
    };
    let model = Model {
        beams: vec![
            beam("upper", [0.0, 0.0], [half, 0.0], ancf(4)),
            beam("lower", [half, 0.0], [LENGTH, 0.0], rpim),
        ],
        joints: vec![Joint::Hinge { first: Place { beam: 0, s: half }, second: Place { beam: 1, s: 0.0 } }],
        loads: vec![Load::Gravity { acceleration: [0.0, -9.81] }],
        probes: vec![
            Probe { name: "a".into(), at: Place { beam: 0, s: half } },
            Probe { name: "b".into(), at: Place { beam: 1, s: 0.0 } },
        ],
        ..one(vec![support(0.0, FixedRotation::Free)], vec![])
    };
    for (integrator, order) in methods(1e-3) {
        let trajectory = moved(&model, 1.0, integrator);
        for (a, b) in trajectory.probes[0].samples.iter().zip(&trajectory.probes[1].samples) {
            assert!(
                (a.x - b.x).hypot(a.y - b.y) < 1e-12,
                "{integrator}: ({}, {}) and ({}, {})",
                a.x,
                a.y,
                b.x,
                b.y
            );
            let (va, vb) =
                ([a.vx, a.vy].map(Option::unwrap_or_default), [b.vx, b.vy].map(Option::unwrap_or_default));
            assert!((va[0] - vb[0]).hypot(va[1] - vb[1]) < 1e-9, "{integrator}: {va:?} and {vb:?}");
        }
        if order > 4.0 {
            let off = imbalance(&trajectory);
            assert!(off < 1e-5, "{integrator}: energy off by {off}");
        }
    }
}

/// An actuated cantilever without loads takes the arc of its own curvature, and is free of stress.
#[test]
fn an_actuated_beam_takes_its_own_shape() {
    let actuation = Actuation { beam: 0, strain: Some(0.02), curvature: Some(1.5), law: None };
    let trajectory = still(&one(vec![support(0.0, FixedRotation::Angle)], vec![Arc::new(actuation)]));
    let last = trajectory.probes[0].samples.last().expect("a record");
    // κ counts per reference length: the arc has the angle κ L and the length 1.02 L.
    let angle = 1.5 * LENGTH;
    let radius = 1.02 / 1.5;
    assert!((last.angle - angle).abs() < 1e-4, "{}", last.angle);
    assert!((last.x - radius * angle.sin()).hypot(last.y - radius * (1.0 - angle.cos())) < 1e-3, "{last:?}");
    let arm = &trajectory.last[0];
    assert!(arm.axial_force.iter().all(|n| n.abs() < 2.0), "{:?}", arm.axial_force);
}

/// A beam dropped on a plane bounces; the contact gives back what it takes, friction takes for good.
#[test]
fn a_beam_bounces_from_a_plane() {
    let contact = |friction| Contact {
        beam: 0,
        obstacle: Obstacle::HalfPlane { point: [0.0, -0.1], normal: [0.0, 1.0] },
        stiffness: 1e4,
        half_thickness: 0.0,
        friction,
    };
    let tolerance = Integrator::Gauss { stages: 2, step: StepControl::Tolerance(1e-7) };
    for friction in [None, Some(Friction { coefficient: 0.3, stiffness: 1e4 })] {
        let mut model = one(vec![], vec![Arc::new(contact(friction))]);
        model.loads = vec![Load::Gravity { acceleration: [0.0, -9.81] }];
        model.initial_velocities =
            vec![InitialVelocity { translation: [1.0, 0.0], ..InitialVelocity::default() }];
        let trajectory = moved(&model, 0.4, tolerance);
        let lowest = trajectory.probes[0].samples.iter().fold(f64::INFINITY, |m, s| m.min(s.y));
        assert!((-0.12..-0.05).contains(&lowest), "lowest {lowest}");
        let off = imbalance(&trajectory);
        assert!(off < 1e-5, "balance off by {off}");
        assert_eq!(trajectory.outlines, [[[LENGTH, -0.1], [-LENGTH, -0.1]]]);
        // It falls 0.1 m, and is pushed back.
        let [
            Event::Contact { time: begin, contact, touches: true, blow: None },
            Event::Contact { time: end, touches: false, blow: Some(blow), .. },
            ..,
        ] = &trajectory.events[..]
        else {
            panic!("{:?}", trajectory.events)
        };
        assert!(
            contact == "arm.1" && (begin - (0.2_f64 / 9.81).sqrt()).abs() < 1e-6,
            "{contact} at {begin} s"
        );
        assert!((1e-3..0.1).contains(&(end - begin)), "it touches until {end} s");
        // It leaves as fast as it came, by an oscillation on the penalty about the depth at which that bears the weight.
        let (mass, speed, frequency) = (0.4 * LENGTH, 9.81 * begin, (1e4 / 0.4_f64).sqrt());
        let impulse = mass * (2.0 * speed + 9.81 * (end - begin));
        let force =
            1e4 * LENGTH * (9.81 / frequency.powi(2) + (9.81 / frequency.powi(2)).hypot(speed / frequency));
        assert!(
            blow.impulse[0].abs() < 1e-9 && (blow.impulse[1] - impulse).abs() < 1e-5 * impulse,
            "{blow:?}, not {impulse}"
        );
        assert!((0.9..=1.0 + 1e-6).contains(&(blow.largest_force / force)), "{blow:?}, not {force}");
        let lost = trajectory.energy.last().expect("a record").lost;
        assert_eq!(friction.is_some(), lost > 1e-3, "lost {lost}");
        let speed = trajectory.probes[0].samples.last().and_then(|s| s.vx).unwrap_or_default();
        assert_eq!(friction.is_some(), speed < 0.95, "speed {speed}");
        assert!(
            trajectory
                .effects
                .iter()
                .any(|e| e.name == "contact.arm" && e.samples.iter().any(|s| s[2] > 1.0))
        );
    }
}

/// A string: no bending stiffness named, none computed.
#[test]
fn a_string_has_no_bending() {
    let mut model = one(vec![support(0.0, FixedRotation::Free)], vec![]);
    model.beams[0].section.bending_stiffness = None;
    model.loads = vec![Load::Gravity { acceleration: [0.0, -9.81] }];
    let analysis = Analysis::Dynamic(Dynamic {
        duration: 0.1,
        output_every: 0.1,
        integrator: gauss(1e-3),
        events: vec![],
    });
    let inventory = ancf::run::inspect(&model, &analysis).expect("a string");
    assert!(inventory.effects.iter().all(|effect| effect.kind != ancf::effect::Kind::Bend));
    let trajectory = moved(&model, 0.3, gauss(1e-3));
    assert!(trajectory.energy.iter().all(|e| e.bend == 0.0));
    assert!(imbalance(&trajectory) < 1e-4, "{}", imbalance(&trajectory));
}

/// A slack cable between two supports, laid out as an arc, hangs as a catenary: y = a cosh(x/a) with 2 a sinh(w/2a) = L.
#[test]
fn a_slack_cable_hangs_as_a_catenary() {
    let (radius, half) = (1.0_f64, 1.0_f64);
    let mut cable = beam("cable", [0.0; 2], [1.0, 0.0], ancf(24));
    cable.centreline = Centreline::Arc { center: [0.0, 0.0], radius, from: -2.0, to: -2.0 + 2.0 * half };
    cable.section =
        Section { axial_stiffness: Some(1e6), bending_stiffness: None, mass_per_length: Some(0.4) };
    let length = 2.0 * half * radius;
    let ends = [0.0, length].map(|s| support(s, FixedRotation::Free));
    let mut model = one(ends.to_vec(), vec![]);
    model.beams = vec![cable];
    model.loads = vec![Load::Gravity { acceleration: [0.0, -9.81] }];
    model.probes = tip(0, 0.5 * length);
    let trajectory = still(&model);
    let [a, b] = [-2.0_f64, 0.0].map(|angle| [radius * angle.cos(), radius * angle.sin()]);
    // The catenary through both ends: √(L² − v²) = 2 c sinh(h/2c), h and v the distances along x and y.
    let (h, v) = (b[0] - a[0], b[1] - a[1]);
    let mut bracket = (0.05_f64, 50.0_f64);
    for _ in 0..200 {
        let c = 0.5 * (bracket.0 + bracket.1);
        if 2.0 * c * (0.5 * h / c).sinh() > (length * length - v * v).sqrt() {
            bracket.0 = c
        } else {
            bracket.1 = c
        }
    }
    let c = bracket.0;
    let tension = c * 0.4 * 9.81;
    let pull = trajectory.reactions[1].samples.last().expect("a record");
    assert!((pull.fx - tension).abs() < 2e-3 * tension, "{} N and not {tension} N", pull.fx);
    let weight: f64 = trajectory.reactions.iter().filter_map(|r| r.samples.last()).map(|r| r.fy).sum();
    assert!((weight - 0.4 * 9.81 * length).abs() < 1e-6, "the supports bear {weight} N");
    assert!(trajectory.last[0].bending_moment.iter().all(|m| *m == 0.0));
}

/// Where nothing acts a string stays where it is, though nothing would resist it.
#[test]
fn a_string_without_load_stays() {
    let arc = Centreline::Arc { center: [0.0, 0.0], radius: 1.0, from: -2.0, to: -0.5 };
    let line = Centreline::Line { start: [0.0; 2], end: [0.9, 1.2] };
    for centreline in [arc, line] {
        let mut model =
            one(vec![support(0.0, FixedRotation::Free), support(1.5, FixedRotation::Free)], vec![]);
        model.beams[0].centreline = centreline;
        model.beams[0].section.bending_stiffness = None;
        for supports in [2, 1, 0] {
            model.supports.truncate(supports);
            let trajectory = still(&model);
            assert_eq!(trajectory.statistics.newton_iterations, 0);
            assert_eq!(
                (&trajectory.last[0].x, &trajectory.last[0].y),
                (&trajectory.undeformed[0].x, &trajectory.undeformed[0].y)
            );
        }
        // A support that has a way to go is not at rest.
        model.supports = vec![support(0.0, FixedRotation::Free), support(1.5, FixedRotation::Free)];
        model.supports[1].displacement = Displacement { x: 0.01, ..Displacement::default() };
        let end = still(&Model { probes: tip(0, 1.5), ..model.clone() }).probes[0]
            .samples
            .last()
            .expect("a record")
            .x;
        let before =
            still(&Model { probes: tip(0, 1.5), supports: vec![], ..model.clone() }).probes[0].samples[0].x;
        assert!((end - before - 0.01).abs() < 1e-9, "{end} from {before}");
    }
}

/// A straight string whose end is brought nearer at once may be left with a fold, and says so; by small steps it hangs without one.
#[test]
fn a_folded_string_is_named() {
    let cable = |steps| {
        let mut model =
            one(vec![support(0.0, FixedRotation::Free), support(1.0, FixedRotation::Free)], vec![]);
        model.beams = vec![beam("cable", [0.0; 2], [1.0, 0.0], ancf(16))];
        model.beams[0].section =
            Section { axial_stiffness: Some(100.0), bending_stiffness: None, mass_per_length: Some(1.0) };
        model.supports[1].displacement = Displacement { x: -0.4, ..Displacement::default() };
        model.loads = vec![Load::Gravity { acceleration: [0.0, -9.81] }];
        model.probes = tip(0, 0.5);
        let settings = Static { steps, ..Static::default() };
        run(&model, &Analysis::Static(settings), &mut |_| Control::Continue).expect("an equilibrium")
    };
    for steps in [None, Some(40)] {
        let trajectory = cable(steps);
        let middle = trajectory.probes[0].samples.last().expect("a record");
        // What is free of folds is symmetric.
        let symmetric = (middle.x - 0.3).abs() < 1e-6;
        let named =
            trajectory.warnings.iter().any(|w| w.contains("string `cable` turns by more than a right angle"));
        assert_eq!(named, !symmetric, "{steps:?} steps: x = {}, {:?}", middle.x, trajectory.warnings);
        assert!(symmetric || steps.is_none(), "x = {}", middle.x);
    }
}

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let refused = |model: &Model, words: &str| {
        let error = run(model, &Analysis::Static(Static::default()), &mut |_| Control::Continue);
        let message = error.expect_err("refused").to_string();
        assert!(message.contains(words), "{message}");
    };
    let mut apart = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
    apart.beams.push(beam("other", [LENGTH, 0.3], [2.0, 0.3], ancf(2)));
    apart.joints =
        vec![Joint::Hinge { first: Place { beam: 0, s: LENGTH }, second: Place { beam: 1, s: 0.0 } }];
    refused(&apart, "3.000e-1 m apart");
    let load = Load::Force { at: Place { beam: 0, s: 0.5 }, value: [0.0, 1.0], follower: false };
    let mut timed = one(vec![support(0.0, FixedRotation::Angle)], vec![]);
    timed.loads = vec![Load::InTime { load: Box::new(load), law: Law::Step { start: 0.0 } }];
    refused(&timed, "law of time");
    let spring = Spring {
        at: Place { beam: 0, s: 7.0 },
        anchor: None,
        length: None,
        stiffness: Some(1.0),
        damping: None,
    };
    refused(&one(vec![support(0.0, FixedRotation::Angle)], vec![Arc::new(spring)]), "s = 7 m");
    let damping = BeamDamping { beam: 3, mass_proportional: Some(1.0), ..BeamDamping::default() };
    refused(&one(vec![support(0.0, FixedRotation::Angle)], vec![Arc::new(damping)]), "beam number 3");
}
