//! Springs, masses, damping, fluids, contacts: derivatives of their densities against dual numbers.

use ancf::assembly::{Density, Dissipation};
use ancf::effect::{
    BendDamping, Dashpot, DragForce, Engineering, FollowerForce, Green, GroundSpring, Gyration, Inertia,
    Obstacle, Penalty, PreCurvature, PreStrain, RotaryInertia, StretchDamping, Strut, Torsion,
    TorsionDashpot,
};
use ancf::lanes::{Lanes, Pair, Points};
use nalgebra::{DVector, Dyn, Vector2};
use num_dual::{Dual2Vec, DualNum, hessian};
use proptest::prelude::*;

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

/// Fields at four points: those given, and others of other sizes.
fn of_four<const M: usize>(z: &[Vector2<f64>; M]) -> ([[Vector2<f64>; M]; 4], [Pair<Lanes>; M]) {
    let fields: [[Vector2<f64>; M]; 4] = std::array::from_fn(|k| z.map(|z| z * (1.0 + 0.3 * k as f64)));
    let part = |m: usize, d: usize| Lanes::new(std::array::from_fn(|k| fields[k][m][d]));
    (fields, std::array::from_fn(|m| std::array::from_fn(|d| part(m, d))))
}

/// The forces at four points are those at each.
fn four_are_each<const M: usize>(found: [Pair<Lanes>; M], each: [[Vector2<f64>; M]; 4]) {
    for (k, each) in each.iter().enumerate() {
        let scale = each.iter().fold(1e-12_f64, |m, force| m.max(force.amax()));
        for (m, force) in each.iter().enumerate() {
            for d in 0..2 {
                let found = found[m][d].to_array()[k];
                assert!(
                    (found - force[d]).abs() <= 1e-13 * scale,
                    "point {k}, {m}{d}: {found}, not {}",
                    force[d]
                );
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
        ) -> ([Vector2<f64>; M], ancf::assembly::Hessian<M>) {
            self.0.force_and_matrix(point, &self.1, rate)
        }
    }
    let ((states, z_lanes), (rates, rate_lanes)) = (of_four(&z), of_four(&rate));
    let each = std::array::from_fn(|k| density.force(0, &states[k], &rates[k]));
    four_are_each(density.forces(&z_lanes, &rate_lanes), each);
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
        let tie = GroundSpring::new([3.0, 0.5], vec![Vector2::new(0.2, -0.1)]);
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
        let gyration = Gyration(RotaryInertia { inertia: 0.6 });
        let ((states, z_lanes), (velocities, lanes)) = (of_four(&[g]), of_four(&[w]));
        let each = std::array::from_fn(|k| gyration.force(0, &states[k], &velocities[k]));
        four_are_each(gyration.forces(&z_lanes, &lanes), each);
        let follower = FollowerForce::new([0.7, -1.2], &[c, g, v, w]);
        let (states, lanes) = of_four(&[r, g]);
        let each = std::array::from_fn(|k| follower.gradient(k, &states[k]).map(|force| force * 0.4));
        four_are_each(follower.gradients(0.4, Points { first: 0, stride: 1 }, &lanes), each);
        rates(&TorsionDashpot { coefficient: 0.6 }, [g], [w], |v| {
            square(cross(&g_dual, &v[0]) / g.norm_squared()) * 0.3
        });
        let drag = DragForce { viscous: [0.2, 0.5], quadratic: [0.1, 3.0], flow: [0.4, -0.3] };
        rates(&drag, [r, g], [v, w], |rate| {
            let u = minus(&rate[0], [0.4, -0.3]);
            let along = dot(&g_dual, &u) / g.norm();
            let across = cross(&g_dual, &u) / g.norm();
            square(along.clone()) * 0.1 + square(across.clone()) * 0.25
                + abs(along).powi(3) * (0.1 / 3.0) + abs(across).powi(3)
        });
    }
}

/// A force that is linear in the velocity is its matrix times the velocity. Of ten elements eight are
/// summed four at a time, all matrices one at a time. All quantities vary along the beam, so that each
/// point has its own.
#[test]
fn forces_of_velocities_are_their_matrices_times_the_velocity() {
    for (basis, damping) in [
        (
            "ancf.elements = 10",
            "damping = [{ beam = 'arm', stiffness_proportional.polynomial = [0.3, 0.1], mass_proportional.polynomial = [0.7, 0.2] }]",
        ),
        (
            "ancf.elements = 3",
            "damping = [{ beam = 'arm', strain.polynomial = [0.3, 0.1], curvature.polynomial = [0.1, 0.1] }]",
        ),
        ("rpim.nodes = 11", "damping = [{ beam = 'arm', stiffness_proportional = 0.3 }]"),
        (
            "ancf.elements = 10",
            "drag = [{ beam = 'arm', viscous_normal.polynomial = [2, 1], viscous_tangential.polynomial = [0.4, 0.3] }]",
        ),
        (
            "ancf = { elements = 10, gauss_points = { stretch = 4, bend = 2 } }",
            "damping = [{ beam = 'arm', stiffness_proportional = 0.3 }]",
        ),
    ] {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [1, 0.5], axial_stiffness.polynomial = [40, -10], \
             bending_stiffness.polynomial = [0.3, 0.2], mass_per_length.polynomial = [2, -1], basis.{basis} }}
            effect.{damping}
            analysis.dynamic.duration = 1.0\n"
        );
        let scene = ancf::scene::parse("scene.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let needs = ancf::assembly::Needs { inertia: true, motion: true };
        let system = ancf::system::System::build(scene.model(), needs).expect("a legal model");
        let n = system.coordinates();
        let some = |k: usize, size: f64| size * (((7 * k * k + 3 * k) % 23) as f64 / 11.0 - 1.0);
        let q: Vec<f64> = system.start().iter().enumerate().map(|(k, q)| q + some(k, 0.05)).collect();
        let v: Vec<f64> = (0..n).map(|k| some(k + 5, 1.0)).collect();
        let (mut force, mut with_matrix, mut product) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        system.add_damping(&q, &v, &mut force);
        let mut matrix = system.damping_pattern();
        let workspace = &mut ancf::assembly::Workspace::default();
        system.damping_matrix(&q, &v, &mut with_matrix, &mut matrix, workspace);
        matrix.multiply_add(1.0, &v, &mut product);
        let scale = product.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for ((force, with), product) in force.iter().zip(&with_matrix).zip(&product) {
            assert!((force - product).abs() <= 1e-12 * scale, "{basis}, {damping}: {force}, not {product}");
            assert!((with - product).abs() <= 1e-12 * scale, "{basis}, {damping}: {with}, not {product}");
        }
    }
}
