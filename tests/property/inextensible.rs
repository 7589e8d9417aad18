//! Beams that name no axial stiffness: the rows that keep their length, and what they do in
//! statics, vibrations and motion.

use super::generators;
use ancf::assembly::{Kind, Needs};
use ancf::restart::SavedState;
use ancf::results::Trajectory;
use ancf::run::{Options, inspect};
use ancf::scene::{Scene, parse};
use ancf::solve::dynamics::motion::Motion;
use ancf::system::System;
use proptest::prelude::*;

const ARM: &str = "[beam.arm]\nstart = [0.0, 0.0]\nend = [1.0, 0.0]\nbending_stiffness = 1.0\nmass_per_length = 1.0\nbasis = BASIS\n\
                   [[support]]\nbeam = 'arm'\nat = 'start'\nfix = FIX\n\
                   [[probe]]\nname = 'tip'\nbeam = 'arm'\nat = 'end'\n";
const ANCF: &str = "{ ancf = { elements = 20 } }";
const RPIM: &str = "{ rpim = { nodes = 10 } }";
const CLAMP: &str = "['x', 'y', 'gradient']";
const HINGE: &str = "['x', 'y']";

fn scene(basis: &str, fix: &str, rest: &str) -> Scene {
    let text = format!("{}{rest}", ARM.replace("BASIS", basis).replace("FIX", fix));
    parse("arm.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn solve(scene: &Scene) -> Trajectory {
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}")).into_states()
}

fn refused(scene: &Scene) -> String {
    scene.model().solve(scene.analysis()).expect_err("refused").to_string()
}

const TIP_FORCE: &str =
    "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [0.0, -4.0]\n[analysis.static]\n";

proptest! {
    #![proptest_config(super::cases(16))]

    /// Rows are quadratic, so that differences are exact: g(q ± d) = g ± B d + ½ d·G d.
    #[test]
    fn rows_have_the_derivatives_that_they_say(
        mut beam in generators::beam(),
        moves in proptest::collection::vec(-0.3..0.3_f64, 400),
        forces in proptest::collection::vec(-1.0..1.0_f64, 400),
    ) {
        beam.section.axial_stiffness = None;
        let system = generators::free(&beam);
        let n = system.coordinates();
        let vector = |from: usize| -> Vec<f64> { (0..n).map(|i| moves[(i + from) % moves.len()]).collect() };
        let (d, v) = (vector(17), vector(101));
        let q: Vec<f64> = system.reference().iter().zip(vector(0)).map(|(q, d)| q + d).collect();
        let values = |factor: f64| {
            let moved: Vec<f64> = q.iter().zip(&d).map(|(q, d)| q + factor * d).collect();
            let mut values = vec![0.0; system.multipliers()];
            system.constraint_values(0.0, &moved, &mut values);
            values
        };
        let (before, here, after) = (values(-1.0), values(0.0), values(1.0));
        let (mut rates, mut curvatures) = (vec![0.0; here.len()], vec![0.0; here.len()]);
        system.constraint_rates(0.0, &q, &d, &mut rates);
        system.add_constraint_curvatures(&q, &d, &mut curvatures);
        let scale = here.iter().chain(&after).chain(&before).fold(1e-12_f64, |m, g| m.max(g.abs()));
        for r in 0..here.len() {
            prop_assert!((after[r] - before[r] - 2.0 * rates[r]).abs() < 1e-11 * scale, "B of row {r}");
            prop_assert!((after[r] + before[r] - 2.0 * here[r] - curvatures[r]).abs() < 1e-11 * scale, "G of row {r}");
        }
        // Forces are Bᵀμ, and the tangent Σ μ G.
        let mu: Vec<f64> = (0..here.len()).map(|r| forces[r % forces.len()]).collect();
        let mut f = vec![0.0; n];
        system.add_constraint_forces(0.0, &q, &mu, &mut f);
        let work: f64 = f.iter().zip(&d).map(|(f, d)| f * d).sum();
        let expected: f64 = mu.iter().zip(&rates).map(|(mu, rate)| -mu * rate).sum();
        let sum: f64 = mu.iter().zip(&rates).map(|(mu, rate)| (mu * rate).abs()).sum();
        prop_assert!((work - expected).abs() < 1e-12 * sum.max(1e-300), "{work}, not {expected}");
        let (mut k, mut by_matrix, mut by_rows) = (system.matrix(), vec![0.0; n], vec![0.0; n]);
        system.add_constraint_stiffness(&q, &mu, &mut k);
        k.multiply_add(1.0, &v, &mut by_matrix);
        system.add_constraint_stiffness_product(&q, &mu, &v, &mut by_rows);
        let largest = by_rows.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        for (a, b) in by_matrix.iter().zip(&by_rows) {
            prop_assert!((a - b).abs() <= 1e-12 * largest, "{a}, not {b}");
        }
        let energy: f64 = by_rows.iter().zip(&v).map(|(f, v)| f * v).sum();
        let mut of_rows = vec![0.0; mu.len()];
        system.add_constraint_curvatures(&q, &v, &mut of_rows);
        let expected: f64 = mu.iter().zip(&of_rows).map(|(mu, c)| -mu * c).sum();
        prop_assert!((energy - expected).abs() < 1e-11 * of_rows.iter().fold(1e-300_f64, |m, c| m.max(c.abs())) * n as f64);
    }
}

#[test]
fn what_names_no_axial_stiffness_gets_rows_and_no_stretch() {
    for (basis, cells, method) in [(ANCF, 20, "banded LDLᵀ"), (RPIM, 9, "banded LU")] {
        for (fix, rows) in [(CLAMP, 2 * cells), (HINGE, 2 * cells + 1)] {
            let analysis = if fix == CLAMP { TIP_FORCE } else { "[analysis.dynamic]\nduration = 1.0\n" };
            let scene = scene(basis, fix, analysis);
            let inventory = inspect(scene.model(), scene.analysis()).expect("an inventory");
            let points = |kind: Kind| inventory.effects.iter().find(|e| e.kind == kind).map(|e| e.points);
            assert_eq!(points(Kind::Inextensibility), Some(rows), "{basis} {fix}");
            assert_eq!(points(Kind::Stretch), None);
            assert_eq!(inventory.multipliers, rows);
            assert_eq!(inventory.solver, format!("{method}, constraints among the unknowns"));
        }
    }
}

/// The row that a wholly held gradient makes one too many is left out beside the last node, too.
#[test]
fn a_gradient_that_is_held_at_the_end_saves_a_row() {
    for (basis, cells) in [(ANCF, 20), (RPIM, 9)] {
        let text = ARM.replace("BASIS", basis).replace("FIX", CLAMP).replace("at = 'start'", "at = 'end'");
        let scene = parse("arm.toml", &format!("{text}[analysis.static]\n")).expect("a scene");
        let inventory = inspect(scene.model(), scene.analysis()).expect("an inventory");
        assert_eq!(inventory.multipliers, 2 * cells, "{basis}");
    }
}

/// The difference between a beam and one that cannot stretch falls with 1/EA.
#[test]
fn it_is_the_limit_of_large_axial_stiffness() {
    for basis in [ANCF, RPIM] {
        let tip = |stiffness: &str| {
            let text = ARM
                .replace("BASIS", basis)
                .replace("FIX", CLAMP)
                .replace("bending", &format!("{stiffness}bending"));
            let scene = parse("arm.toml", &format!("{text}{TIP_FORCE}")).expect("a scene");
            let sample = *solve(&scene).probes[0].samples.last().expect("an equilibrium");
            (sample.x, sample.y)
        };
        let limit = tip("");
        let off = |ea: &str| {
            let (x, y) = tip(&format!("strain = 'engineering'\naxial_stiffness = {ea}\n"));
            (x - limit.0).hypot(y - limit.1)
        };
        let [soft, stiff] = ["1e4", "1e5"].map(off);
        // Both meshes leave errors of their own, of 1e-5.
        assert!(
            stiff < 1.2e-4 && (5.0..20.0).contains(&(soft / stiff)),
            "{basis}: {soft:.1e} and {stiff:.1e}"
        );
    }
}

/// M = EI π/L bends a beam to a half circle of its length.
#[test]
fn a_half_circle_keeps_its_length() {
    let rest = "[[effect.moment]]\nbeam = 'arm'\nat = 'end'\nvalue = 3.141592653589793\n[analysis.static]\n";
    for (basis, allowed) in [(&ANCF.replace("20", "24")[..], 5e-6), (RPIM, 1e-4)] {
        let trajectory = solve(&scene(basis, CLAMP, rest));
        let tip = trajectory.probes[0].samples.last().expect("an equilibrium");
        let error = tip.x.hypot(tip.y - 2.0 / std::f64::consts::PI);
        assert!(error < allowed, "{basis}: {error:.1e}");
        let shape = &trajectory.last[0];
        assert!(shape.strain.iter().all(|e| e.abs() < 1e-3), "{:?}", shape.strain);
        // One part in a hundred of EI κ².
        assert!(shape.axial_force.iter().all(|n| n.abs() < 0.1), "{:?}", shape.axial_force);
        assert_eq!(trajectory.energy.last().map(|e| e.stretch), Some(0.0));
    }
}

/// A bar on its clamp under its own length of dead load carries N = q (L − s), to round-off.
#[test]
fn the_multiplier_is_the_axial_force() {
    for basis in [ANCF, RPIM] {
        let rest = "[[effect.distributed_force]]\nbeam = 'arm'\nvalue = [3.0, 0.0]\n[analysis.static]\n";
        let trajectory = solve(&scene(basis, CLAMP, rest));
        let shape = &trajectory.last[0];
        let allowed = if basis == ANCF { 1e-11 } else { 0.02 };
        for (s, n) in shape.s.iter().zip(&shape.axial_force) {
            assert!((n - 3.0 * (1.0 - s)).abs() < allowed, "{basis}: N = {n} at s = {s}");
        }
    }
}

const FALL: &str = "[effect.gravity]\nacceleration = [0.0, -9.81]\n[analysis.dynamic]\nduration = 0.4\noutput_every = 0.1\nMETHOD\n";

fn fall(basis: &str, method: &str) -> Scene {
    scene(basis, HINGE, &FALL.replace("METHOD", method))
}

/// Radau's positions and those of generalised-α converge to each other, with lengths and energies
/// kept.
#[test]
fn a_fall_converges_with_every_method_that_damps() {
    let reference = solve(&fall(ANCF, "radau = { step = '0.5 ms' }"));
    let end = reference.probes[0].samples.last().expect("a record");
    let first = reference.energy[0].total();
    assert!(reference.energy.iter().all(|e| (e.total() - first).abs() < 1e-7), "{:?}", reference.energy);
    for (method, order, least) in [
        ("radau = { stages = 2, step = 'H ms' }", 2.0, 1e-5),
        ("generalized_alpha = { spectral_radius = 0.8, step = 'H ms' }", 2.0, 3e-5),
    ] {
        let off = |step: &str| {
            let trajectory = solve(&fall(ANCF, &method.replace('H', step)));
            let tip = trajectory.probes[0].samples.last().expect("a record");
            for shape in &trajectory.last {
                assert!(shape.strain.iter().all(|e| e.abs() < 1e-4), "{method}: {:?}", shape.strain);
            }
            (tip.x - end.x).hypot(tip.y - end.y)
        };
        let [coarse, fine] = ["4", "1"].map(off);
        assert!(
            fine < least && coarse / fine > 4f64.powf(0.7 * order),
            "{method}: {coarse:.1e} and {fine:.1e}"
        );
    }
}

/// A step is judged by its own error, whichever state its tangent is of: few are rejected, tangents serve for many, and the result is as
/// good as it is with an axial stiffness.
///
/// Would catch an error that holds part of the forces which keep the lengths.
#[test]
fn steps_are_as_long_as_with_an_axial_stiffness() {
    let free = ARM.replace("BASIS", ANCF).replace("FIX", HINGE);
    let stiff = free.replace("bending_stiffness = 1.0", "bending_stiffness = 1.0\naxial_stiffness = 1e5");
    for stages in [2, 3] {
        let method = |tolerance: &str| format!("radau = {{ stages = {stages}, tolerance = {tolerance} }}");
        let run = |arm: &str, tolerance: &str| {
            let text = format!("{arm}{}", FALL.replace("METHOD", &method(tolerance)));
            solve(&parse("fall.toml", &text).unwrap_or_else(|error| panic!("{error}")))
        };
        let (kept, beside, exact) = (run(&free, "1e-5"), run(&stiff, "1e-5"), run(&free, "1e-9"));
        let [counts, other] = [&kept, &beside].map(|trajectory| trajectory.run.statistics);
        assert!(20 * counts.rejected_steps <= counts.steps, "{stages}: {counts:?}");
        assert!(4 * counts.steps <= 5 * other.steps, "{stages}: {counts:?} beside {other:?}");
        assert!(4 * counts.tangent_evaluations <= counts.steps, "{stages}: {counts:?}");
        let tip = |trajectory: &Trajectory| {
            trajectory.probes[0].samples.iter().map(|tip| [tip.x, tip.y]).collect::<Vec<_>>()
        };
        for (tip, exact) in tip(&kept).iter().zip(tip(&exact)) {
            let off = (tip[0] - exact[0]).hypot(tip[1] - exact[1]);
            assert!(off < 1e-5, "{stages}: {off:.1e}");
        }
    }
}

#[test]
fn a_motion_goes_on_as_if_it_had_not_stopped() {
    for method in
        ["radau = { step = '2 ms' }", "generalized_alpha = { step = '2 ms', spectral_radius = 0.8 }"]
    {
        let whole = solve(&fall(RPIM, method));
        let half = parse(
            "half.toml",
            &format!(
                "{}{}",
                ARM.replace("BASIS", RPIM).replace("FIX", HINGE),
                FALL.replace("METHOD", method).replace("0.4", "0.2")
            ),
        )
        .expect("a scene");
        let saved: SavedState = solve(&half).saved.expect("a state");
        let rest = half
            .model()
            .solve_with(half.analysis(), Options { start: Some(&saved), ..Options::default() })
            .expect("a motion");
        assert_eq!(whole.probes[0].samples.last(), rest.states().probes[0].samples.last(), "{method}");
    }
}

/// The accelerations that start a motion obey g̈ = 0: a rotating bar is pulled to its hinge by ω² ∫
/// s ds.
#[test]
fn a_bar_that_rotates_pulls_at_its_hinge() {
    let scene = scene(
        ANCF,
        HINGE,
        "[[initial_velocity]]\nbeam = 'arm'\nrotation = 3.0\n[analysis.dynamic]\nduration = 0.01\nradau.step = '1 ms'\n",
    );
    let system = System::build(scene.model(), Needs { inertia: true, motion: true }).expect("a system");
    let mut motion = Motion::new(&system).expect("a mass");
    // Turning about the origin with 3 rad/s.
    let v: Vec<f64> = system.reference().chunks_exact(2).flat_map(|r| [-3.0 * r[1], 3.0 * r[0]]).collect();
    let state = ancf::solve::dynamics::State { q: system.reference().to_vec(), v, ..Default::default() };
    let reactions = motion.reactions(&state).expect("reactions");
    assert!((reactions[0].fx + 4.5).abs() < 1e-10 && reactions[0].fy.abs() < 1e-10, "{:?}", reactions[0]);
    let s: Vec<f64> = (0..=20).map(|i| 0.05 * f64::from(i)).collect();
    let forces = system.axial_force(0, motion.multipliers(), &s).expect("an inextensible beam");
    for (s, n) in s.iter().zip(forces) {
        assert!((n - 4.5 * (1.0 - s * s)).abs() < 1e-9, "N = {n} at s = {s}");
    }
}

/// A corner of two beams that cannot stretch, against one whose beams nearly cannot.
#[test]
fn welded_corners_are_the_limit_of_stiff_ones() {
    let frame = |stiffness: &str, basis: &str| {
        let text = format!(
            "[beam.post]\nstart = [0.0, 0.0]\nend = [0.0, 1.0]\nbending_stiffness = 1.0\n{stiffness}basis = {basis}\n\
             [beam.bar]\nstart = [0.0, 1.0]\nend = [1.0, 1.0]\nbending_stiffness = 1.0\n{stiffness}basis = {basis}\n\
             [[joint]]\ntype = 'weld'\nfirst = {{ beam = 'post', at = 'end' }}\nsecond = {{ beam = 'bar', at = 'start' }}\n\
             [[support]]\nbeam = 'post'\nat = 'start'\nfix = {CLAMP}\n\
             [[effect.force]]\nbeam = 'bar'\nat = 'end'\nvalue = [0.0, -0.7]\n\
             [[probe]]\nname = 'tip'\nbeam = 'bar'\nat = 'end'\n[analysis.static]\n"
        );
        let scene = parse("frame.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let tip = *solve(&scene).probes[0].samples.last().expect("an equilibrium");
        (tip.x, tip.y)
    };
    for basis in [ANCF, RPIM] {
        let (limit, stiff) =
            (frame("", basis), frame("strain = 'engineering'\naxial_stiffness = 1e6\n", basis));
        let off = (limit.0 - stiff.0).hypot(limit.1 - stiff.1);
        assert!(off < 2e-5, "{basis}: {off:.1e}");
    }
}

/// A chain on one hook, laid out sideways: nothing but its weight says where down is.
#[test]
fn a_chain_on_one_hook_finds_its_way_down() {
    for stiffness in ["", "axial_stiffness = 1e6\n"] {
        let text =
            ARM.replace("BASIS", ANCF).replace("FIX", HINGE).replace("bending_stiffness = 1.0\n", stiffness);
        let rest = "[effect.gravity]\nacceleration = [0.0, -9.81]\n[analysis.static]\n";
        let trajectory = solve(&parse("chain.toml", &format!("{text}{rest}")).expect("a chain"));
        let tip = trajectory.probes[0].samples.last().expect("an equilibrium");
        assert!(tip.x.abs() < 1e-9 && (tip.y + 1.0).abs() < 1e-5, "({}, {})", tip.x, tip.y);
        let top = trajectory.last[0].axial_force[0];
        assert!((top - 9.81).abs() < 1e-3, "{top} N");
        assert_eq!(trajectory.run.statistics.load_steps, 1);
    }
    // With bending stiffness it is a pendulum, which statics refuses.
    let text = format!("{}[analysis.static]\n", ARM.replace("BASIS", ANCF).replace("FIX", HINGE));
    assert!(parse("arm.toml", &text).expect_err("refused").to_string().contains("under-supported"));
}

/// Two beams that cannot stretch, welded to one that can: each keeps the length of its own
/// gradient.
#[test]
fn what_is_welded_keeps_its_own_length() {
    let beam = |name: &str, start: &str, end: &str, more: &str| {
        format!(
            "[beam.{name}]\nstart = {start}\nend = {end}\nbending_stiffness = 1.0\n{more}basis = {ANCF}\n"
        )
    };
    let weld = |to: &str| {
        format!(
            "[[joint]]\ntype = 'weld'\nfirst = {{ beam = 'post', at = 'end' }}\nsecond = {{ beam = '{to}', at = 'start' }}\n"
        )
    };
    let text = [
        beam("post", "[0.0, 0.0]", "[0.0, 1.0]", "strain = 'engineering'\naxial_stiffness = 1e4\n"),
        beam("left", "[0.0, 1.0]", "[-1.0, 1.0]", ""),
        beam("right", "[0.0, 1.0]", "[1.0, 1.0]", ""),
        weld("left"),
        weld("right"),
        format!("[[support]]\nbeam = 'post'\nat = 'start'\nfix = {CLAMP}\n"),
        "[[effect.force]]\nbeam = 'right'\nat = 'end'\nvalue = [0.0, -0.7]\n[analysis.static]\n".into(),
    ];
    let scene = parse("tee.toml", &text.concat()).unwrap_or_else(|error| panic!("{error}"));
    let inventory = inspect(scene.model(), scene.analysis()).expect("an inventory");
    let rows = |beam: &str| {
        let mut of_beam = inventory.effects.iter().filter(|e| e.beam == beam);
        of_beam.find(|e| e.kind == Kind::Inextensibility).map(|e| e.points)
    };
    assert_eq!((rows("post"), rows("left"), rows("right")), (None, Some(41), Some(41)));
    let trajectory = solve(&scene);
    assert!(trajectory.last.iter().flat_map(|shape| &shape.strain).all(|e| e.abs() < 1e-3));
}

/// A straight string is hung between two hooks that are nearer to each other than it is long: taut, its length would be
/// held twice, but it begins with a sag. It hangs in the catenary x = a sinh⁻¹(s/a): 2a sinh(w/2a) = L with the distance w
/// of the hooks; the sag is a (cosh(w/2a) − 1), and each hook carries ρA g a along, and half the weight.
#[test]
fn a_string_that_begins_with_a_sag_may_be_held_at_both_ends() {
    let (span, weight) = (0.8, 2.0 * 10.0);
    let open = |a: f64| 2.0 * a * (span / (2.0 * a)).sinh() - 1.0;
    let (mut low, mut high) = (0.1, 10.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        *(if open(middle) > 0.0 { &mut low } else { &mut high }) = middle;
    }
    let sag = low * ((span / (2.0 * low)).cosh() - 1.0);
    for basis in [ANCF, RPIM] {
        let text = format!(
            "[beam.string]\nstart = [0, 0]\nend = [1, 0]\nmass_per_length = 2\nbasis = {basis}\n\
             initial_shape.points = [[0, 0], [0.4, -0.25], [0.8, 0]]\n\
             [[support]]\nbeam = 'string'\nat = 'start'\nfix = ['x', 'y']\n\
             [[support]]\nbeam = 'string'\nat = 'end'\nfix = ['x', 'y']\n\
             [effect.gravity]\nacceleration = [0, -10]\n\
             [[probe]]\nname = 'lowest'\nbeam = 'string'\nat = 0.5\n[analysis.static]\n[output]\nreactions = true\n"
        );
        let found = solve(&parse("string.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}")));
        let lowest = found.probes[0].samples.last().expect("an equilibrium");
        assert!((lowest.x - 0.4).hypot(lowest.y + sag) < 1e-4, "{basis}: {lowest:?} for a sag of {sag}");
        let hook = found.reactions[1].samples.last().expect("an equilibrium");
        let expected = [weight * low, 0.5 * weight];
        let off = (hook.fx - expected[0]).hypot(hook.fy - expected[1]);
        assert!(off < 1e-3 * weight, "{basis}: {hook:?} for {expected:?}");
    }
}

#[test]
fn what_cannot_be_done_is_refused_with_what_to_try() {
    for method in
        ["gauss = { step = '1 ms' }", "generalized_alpha = { step = '1 ms', spectral_radius = 1.0 }"]
    {
        let text =
            format!("{}{}", ARM.replace("BASIS", ANCF).replace("FIX", HINGE), FALL.replace("METHOD", method));
        let error = parse("fall.toml", &text).expect_err("refused").to_string();
        assert!(error.contains("axial force of an inextensible beam"), "{error}");
    }
    // The default is one that can.
    fall(ANCF, "");
    let held = format!(
        "[[support]]\nbeam = 'arm'\nat = 'end'\nfix = {CLAMP}\n{}",
        TIP_FORCE.replace("'end'", "0.5")
    );
    assert!(refused(&scene(ANCF, CLAMP, &held)).contains("the length that beam `arm` keeps"));
}

/// Units do not decide what a beam may do: a velocity that keeps its length is taken in millimetres
/// and microseconds as in metres and seconds.
#[test]
fn units_do_not_decide_about_velocities() {
    let tip = |length: f64, mass: f64, time: f64| {
        let text = format!(
            "beam.arm = {{ start = [0, 0], end = [{:e}, {:e}], bending_stiffness = {:e}, mass_per_length = {:e}, basis.ancf.elements = 14 }}\n\
             support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             probe = [{{ name = 'tip', beam = 'arm', at = 'end' }}]\n\
             initial_velocity = [{{ beam = 'arm', polynomial = {{ vx = [0, 0, {:e}], vy = [0, 0, {:e}] }} }}]\n\
             analysis.dynamic = {{ duration = {:e}, radau.tolerance = 1e-6 }}",
            0.6 * length,
            -0.8 * length,
            0.4 * mass * length.powi(3) / time.powi(2),
            2.0 * mass / length,
            0.08 / (length * time),
            0.06 / (length * time),
            0.2 * time,
        );
        let scene = parse("arm.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let last = solve(&scene).probes[0].samples.last().map(|tip| [tip.x / length, tip.y / length]);
        last.expect("a state")
    };
    let expected = tip(1.0, 1.0, 1.0);
    for (length, mass, time) in
        [(0.038, 1e-5, 2.7e-6), (1e-3, 1e-9, 1e-6), (1e3, 1e6, 1e2), (1e-6, 1e-15, 1e-7)]
    {
        let found = tip(length, mass, time);
        let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        assert!(apart < 1e-6, "L = {length}, M = {mass}, T = {time}: {apart:e} apart");
    }
}

proptest! {
    #![proptest_config(super::cases(48))]

    /// A straight beam that keeps its length and is held at two points is held once too often, and
    /// refused whatever its direction, place and mesh; one with a little sag is not.
    #[test]
    fn what_holds_a_length_twice_is_refused_in_every_direction(
        turn in -3.2..3.2_f64, x in -3.0..3.0_f64, y in -3.0..3.0_f64,
        elements in 3..60_usize, share in 1..100_usize, angle: bool,
    ) {
        let (sine, cosine) = turn.sin_cos();
        let s = (1 + share * elements / 101).min(elements) as f64 / elements as f64;
        let fix = if angle { CLAMP } else { HINGE };
        let rest = format!(
            "[[support]]\nbeam = 'arm'\nat = {s:?}\nfix = ['x', 'y']\n[[effect.distributed_force]]\nbeam = 'arm'\nvalue = [0.3, -0.4]\n[analysis.static]\n"
        );
        let basis = format!("{{ ancf = {{ elements = {elements} }} }}");
        let text = format!("{}{rest}", ARM.replace("BASIS", &basis).replace("FIX", fix))
            .replace("start = [0.0, 0.0]", &format!("start = [{x:?}, {y:?}]"))
            .replace("end = [1.0, 0.0]", &format!("end = [{:?}, {:?}]", x + cosine, y + sine));
        let scene = parse("arm.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let message = scene.model().solve(scene.analysis()).expect_err("refused").to_string();
        prop_assert!(message.contains("hold the same motion more than once"), "{message}");
    }
}
