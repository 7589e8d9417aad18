//! Forces that depend on the place.

use super::{Written, near};
use ancf::assembly::Needs;
use ancf::scene::parse;
use ancf::system::System;
use std::f64::consts::TAU;

/// A rigid rod of 2 m and 3 kg in the plane.
fn rod(field: &str, more: &str) -> String {
    format!(
        "beam.rod = {{ start = [0, 0], end = [2, 0], axial_stiffness = 1e7, bending_stiffness = 1e6, mass_per_length = 1.5, basis.ancf.elements = 3 }}
        effect.force_field = [{{ beam = 'rod', {field} }}]
        probe = [{{ name = 'start', beam = 'rod', at = 'start' }}, {{ name = 'end', beam = 'rod', at = 'end' }}]
        {more}\n"
    )
}

const GUIDED: &str = "support = [{ beam = 'rod', at = 'start', fix = ['x', 'angle'] }]";

/// Springs are fields, too: in the potential ½ k (y − y₀)² a rod comes to rest at y₀, and has lost
/// ½ k y₀² a length.
#[test]
fn a_potential_pulls_down_its_slope() {
    for (field, y) in [
        ("potential = '20*(y-0.25)^2'", 0.25),
        ("value = ['0', '10-40*y']", 0.25),
        ("potential = '20*(y-0.25)^2', from = 0.5, to = 1.5", 0.25),
    ] {
        let found = Written::of(&rod(field, &format!("{GUIDED}\nanalysis.static = {{}}")));
        near(found.last("probes.csv", "end.y"), y, 1e-7, field);
        let stored = if field.contains("potential") { -20.0 * y * y } else { 0.0 };
        let length = if field.contains("from") { 1.0 } else { 2.0 };
        near(found.last("energy.csv", "potential"), stored * length, 1e-6, field);
    }
}

/// The tangent is exact: a rod in the potential ½ k y² swings with √(k/ρA), whatever the analysis.
#[test]
fn a_potential_has_its_stiffness() {
    let field = "potential = '0.5*60*y^2 + 7*x'";
    let modal = Written::of(&rod(
        field,
        &format!("{GUIDED}\nanalysis.modal = {{ count = 1, about = 'equilibrium' }}"),
    ));
    near(modal.last("frequencies.csv", "frequency") * TAU, (60.0_f64 / 1.5).sqrt(), 1e-6, "ω");
    let motion = rod(
        field,
        &format!(
            "{GUIDED}\ninitial_velocity = [{{ beam = 'rod', value = [0, 0.3] }}]\nanalysis.dynamic = {{ duration = 0.5, output_every = 0.1 }}"
        ),
    );
    let found = Written::of(&motion);
    let omega = (60.0_f64 / 1.5).sqrt();
    near(found.last("probes.csv", "end.y"), 0.3 / omega * (omega * 0.5).sin(), 1e-6, "y");
    for total in found.column("energy.csv", "total") {
        // Radau's method damps by as much as its tolerance allows.
        near(total, 0.5 * 3.0 * 0.09, 1e-5, "total");
    }
}

/// What has no potential does work: a rod in a vortex (−y, x) k/2 is turned by the moment ∫ k s²/2 ds,
/// which the law of time halves.
#[test]
fn a_vortex_turns_a_rod() {
    let motion = "support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]
        analysis.dynamic = { duration = 0.02, output_every = 0.02 }";
    let found = Written::of(&rod("value = ['-1.5*y', '1.5*x'], in_time.polynomial = [0.5]", motion));
    // 0.75 ∫ s² ds over 1.5 ∫ s² ds.
    near(found.last("probes.csv", "end.angle"), 0.5 * 0.5 * 0.02 * 0.02, 1e-8, "angle");
    near(found.last("energy.csv", "work"), found.last("energy.csv", "kinetic"), 1e-8, "work");
}

const STEPS: [&str; 4] = [
    "radau.tolerance = 1e-6",
    "gauss = { stages = 3, tolerance = 1e-6 }",
    "radau.step = 0.005",
    "generalized_alpha.tolerance = 1e-7",
];

fn in_motion(field: &str, held: &str, duration: f64, steps: &str) -> Written {
    let every = duration / 4.0;
    let analysis = format!("analysis.dynamic = {{ duration = {duration}, output_every = {every}, {steps} }}");
    Written::of(&rod(field, &format!("{held}\n{analysis}")))
}

/// y(T) of ÿ = a(y, t) from y = 0 with the velocity `v`, by the classical Runge–Kutta method.
fn motion_of(a: impl Fn(f64, f64) -> f64, mut v: f64, duration: f64) -> f64 {
    let (count, mut y) = (4000_u32, 0.0);
    let h = duration / f64::from(count);
    for t in (0..count).map(|step| f64::from(step) * h) {
        let a1 = a(y, t);
        let a2 = a(y + 0.5 * h * v, t + 0.5 * h);
        let a3 = a(y + 0.5 * h * v + 0.25 * h * h * a1, t + 0.5 * h);
        let a4 = a(y + h * v + 0.5 * h * h * a2, t + h);
        y += h * v + h * h * (a1 + a2 + a3) / 6.0;
        v += h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0;
    }
    y
}

/// A guided rod is a point that moves in y. Waves that travel across it, as a force and as a potential,
/// and a spring that varies (Mathieu's equation) against another integration of ÿ = F(y, t)/ρA, and
/// energy against work.
#[test]
fn a_wave_across_a_rod_moves_it_as_a_point() {
    let wave = |y: f64, t: f64| 4.0 * (3.0 * y - 5.0 * t).sin() / 1.5;
    let spring = |y: f64, t: f64| (6.0 - (40.0 + 24.0 * (9.0 * t).cos()) * y) / 1.5;
    let twice = |y: f64, t: f64| 0.8 * (6.0 * t).sin() * wave(y, t);
    for steps in STEPS {
        for (field, expected) in [
            ("value = ['0', '4*sin(3*y-5*t)']", motion_of(wave, 0.0, 1.0)),
            ("potential = '4/3*cos(3*y-5*t)+t'", motion_of(wave, 0.0, 1.0)),
            ("potential = '(20+12*cos(9*t))*y^2-6*y'", motion_of(spring, 0.0, 1.0)),
            (
                "value = ['0', '4*sin(3*y-5*t)'], in_time.expression = '0.8*sin(6*t)'",
                motion_of(twice, 0.0, 1.0),
            ),
        ] {
            let found = in_motion(field, GUIDED, 1.0, steps);
            near(found.last("probes.csv", "end.y"), expected, 2e-6, &format!("{field}, {steps}"));
            let [total, kinetic] = ["total", "kinetic"].map(|name| found.column("energy.csv", name));
            let largest = kinetic.iter().copied().fold(0.0, f64::max);
            assert!(total.iter().all(|total| total.abs() < 1e-5 * largest), "{field}, {steps}: {total:?}");
            assert_eq!(found.last("energy.csv", "potential"), 0.0);
        }
    }
}

/// A wave along the rod, 3 sin k (x − c t), is ∫ over its 2 m: ÿ = (cos k c t − cos k (2 − c t)) 3/3k,
/// whose motion from rest is in closed form. It is that of two fields with laws of time.
#[test]
fn a_wave_along_a_rod_pushes_it_by_its_sum() {
    let (k, c, time) = (2.3_f64, 2.0_f64, 1.0_f64);
    let w = k * c;
    let rest = (1.0 - (w * time).cos()) / (w * w);
    let other = ((2.0 * k).cos() - (2.0 * k - w * time).cos()) / (w * w) + time * (2.0 * k).sin() / w;
    let expected = (rest - other) / k;
    for field in [
        "value = ['0', '3*sin(2.3*(x-2*t))']",
        "value = ['0', '3*sin(2.3*x)'], in_time.expression = 'cos(4.6*t)' },
         { beam = 'rod', value = ['0', '-3*cos(2.3*x)'], in_time.expression = 'sin(4.6*t)'",
    ] {
        let found = in_motion(field, GUIDED, time, "radau.step = 0.01");
        // The wave bends the rod by some 1e-6 m.
        near(found.last("probes.csv", "end.y"), expected, 3e-5, field);
    }
}

/// An unsymmetric tangent that varies: a vortex (−y, x) k t turns a rod about its start by θ̈ = k t/ρA.
#[test]
fn a_vortex_that_grows_turns_a_rod() {
    let hinged = "support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]";
    for steps in STEPS {
        let found = in_motion("value = ['-3*y*t', '3*x*t']", hinged, 1.0, steps);
        near(found.last("probes.csv", "end.angle"), 2.0 / 6.0, 1e-6, steps);
        near(found.last("energy.csv", "work"), found.last("energy.csv", "kinetic"), 2e-6, steps);
    }
}

/// A guided rod moves as one under the force 3 t x of a length: the section at s carries what is beyond it less
/// its inertia, ∫ (3 t x − ρA 2 t) dx from s to 2 m, which is 1.5 t N in the middle.
#[test]
fn sections_carry_a_field_that_varies_in_time() {
    let text = rod(
        "value = ['0', '3*t*x']",
        &format!(
            "{GUIDED}\noutput.section_forces = true\nanalysis.dynamic = {{ duration = 1, output_every = 0.5, radau.tolerance = 1e-7 }}"
        ),
    );
    let found =
        Written::of(&text.replace("probe = [", "probe = [{ beam = 'rod', name = 'middle', at = 1 }, "));
    near(found.last("probes.csv", "start.vy"), 1.0, 1e-4, "t² from 6 t N on 3 kg");
    let shears = found.column("probes.csv", "middle.shear_force");
    for (shear, expected) in shears.iter().zip([0.0, 0.75, 1.5]) {
        near(*shear, expected, 2e-3, "Q");
    }
}

/// Pulses much shorter than a step of a rod at rest or in flight, whose time depends on where the rod
/// is by then: each gives its whole momentum, and 0.5 s after the rod has met it that is a way.
#[test]
fn no_step_passes_over_a_short_pulse() {
    let flying = format!("{GUIDED}\ninitial_velocity = [{{ beam = 'rod', value = [0, 2] }}]");
    for (field, held, start, met) in [
        ("value = ['0', '300*exp(-((t-0.5)/0.0005)^2)']", GUIDED, 0.0, 0.5),
        // At y = 2 t the pulse comes at t = 0.8 − 0.3 y = 0.5, and lasts 1/1.6 as long.
        ("value = ['0', '300*exp(-((t-0.8+0.3*y)/0.0005)^2)']", &flying, 2.0, 0.5),
    ] {
        let moves = field.contains('y');
        let a = |y: f64, t: f64| {
            let at = if moves { t - 0.8 + 0.3 * y } else { t - 0.5 };
            200.0 * (-(at / 0.0005).powi(2)).exp()
        };
        // The pulse by itself, in steps that suit it.
        let expected = {
            let before = start * (met - 0.01);
            let shifted = |y: f64, t: f64| a(before + y, t + met - 0.01);
            let (y, h) = (motion_of(shifted, start, 0.02), 1e-6);
            let speed = (motion_of(shifted, start, 0.02 + h) - y) / h;
            before + y + speed * (1.0 - met - 0.01)
        };
        for steps in STEPS {
            let found = in_motion(field, held, 1.0, steps);
            let tolerance = if steps.contains("step") { 1e-3 } else { 2e-6 };
            near(found.last("probes.csv", "end.y"), expected, tolerance, &format!("{field}, {steps}"));
        }
    }
}

/// However fast a field varies within a step, its mean 2 (1 − cos ω)/ω over a second and its first moment 2 (ω − sin ω)/ω² are known, with
/// which steps are judged and corrected.
#[test]
fn a_field_that_is_faster_than_steps_has_its_mean_and_first_moment() {
    for omega in [3.0_f64, 40.0, 400.0] {
        let field = rod(
            &format!("value = ['0', 'sin({omega}*t)']"),
            &format!("{GUIDED}\nanalysis.dynamic.duration = 1"),
        );
        let scene = parse("field.toml", &field).expect("a scene");
        let system = System::build(scene.model(), Needs { inertia: true, motion: true }).expect("a rod");
        let mut sums = [0; 2].map(|_| vec![0.0; system.coordinates()]);
        let mut scratch = sums[0].clone();
        let [mean, moment] = &mut sums;
        system.add_unseen_loads([0.0, 1.0], &[], system.start(), [mean, moment], &mut scratch);
        // Forces have the sign of a density, and those of the nodes' y sum up to all.
        let found = sums.map(|force| -force.iter().skip(1).step_by(4).sum::<f64>());
        let expected = [2.0 * (1.0 - omega.cos()) / omega, 2.0 * (omega - omega.sin()) / (omega * omega)];
        for (found, expected) in found.into_iter().zip(expected) {
            near(found, expected, 1e-10, &format!("ω = {omega}"));
        }
    }
}

/// In statics, vibrations and buckling nobody knows which time is meant.
#[test]
fn formulas_of_time_are_refused_where_there_is_none() {
    for analysis in ["static = {}", "modal.count = 1", "buckling.count = 1"] {
        for (field, at) in [("potential = 'x*t'", "'x*t'"), ("value = ['x', 'y+0*t']", "'y+0*t'")] {
            let text = rod(field, &format!("{GUIDED}\nanalysis.{analysis}"));
            let said = parse("field.toml", &text).expect_err(field).to_string();
            assert!(said.contains("names the time t, which this analysis does not have"), "{said}");
            let column = text.lines().nth(1).and_then(|line| line.find(at)).expect("the formula") + 1;
            assert!(said.starts_with(&format!("field.toml:2:{column}: ")), "{column}: {said}");
        }
    }
}

#[test]
fn formulas_that_cannot_be_read_are_told_with_their_place() {
    for (field, part) in [
        ("potential = '20*z'", "it cannot contain `z`: it knows x, y, t, pi"),
        ("value = ['x', 'y^2^2']", "a power of a power"),
        ("potential = 'x', value = ['x', 'y']", "exactly one of `potential`, `value`"),
        ("from = 0.5", "exactly one of `potential`, `value`"),
    ] {
        let said = parse("field.toml", &rod(field, &format!("{GUIDED}\nanalysis.static = {{}}")))
            .expect_err(field)
            .to_string();
        assert!(said.contains(part) && said.contains("field.toml:2:"), "{said}");
    }
}
