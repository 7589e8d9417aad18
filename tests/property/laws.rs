//! Loads and supports that follow laws of time: nothing moves before its cause, kinks cost no
//! accuracy, and what happens between the points at which a method looks is not lost on it.

use ancf::assembly::Needs;
use ancf::results::Trajectory;
use ancf::scene::parse;
use ancf::system::System;

/// A clamped beam along x, L = 1 m, EA = 1e4 N, EI = 1 N m², ρA = 1 kg/m, with what `acts` on it.
fn moved(acts: &str, duration: f64, every: f64, integrator: &str) -> Trajectory {
    let support = if acts.contains("move") {
        ""
    } else {
        "[[support]]\nbeam = \"a\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n"
    };
    let text = format!(
        "[beam.a]\nstart = [0, 0]\nend = [1, 0]\naxial_stiffness = 1e4\nbending_stiffness = 1\nmass_per_length = 1\nstrain = \"engineering\"\n\
         basis.ancf.elements = 6\n{support}{acts}\
         [[probe]]\nname = \"middle\"\nbeam = \"a\"\nat = 0.5\n[[probe]]\nname = \"tip\"\nbeam = \"a\"\nat = \"end\"\n\
         [analysis.dynamic]\nduration = {duration:?}\noutput_every = {every:?}\n{integrator}\n"
    );
    let scene = parse("laws.toml", &text).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    let found = scene.model().solve(scene.analysis());
    found.unwrap_or_else(|error| panic!("{integrator}: {error}\n{text}")).into_states()
}

/// Positions of all probes from the record `first` on.
fn positions(trajectory: &Trajectory, first: usize) -> Vec<f64> {
    let records = trajectory.probes.iter().flat_map(|probe| &probe.samples[first..]);
    records.flat_map(|sample| [sample.x, sample.y]).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

const FIXED: [&str; 6] = [
    "gauss = { stages = 1, step = 1e-3 }",
    "gauss = { stages = 2, step = 2e-3 }",
    "gauss = { stages = 3, step = 4e-3 }",
    "radau = { stages = 2, step = 2e-3 }",
    "radau = { stages = 3, step = 4e-3 }",
    "generalized_alpha = { step = 1e-3, spectral_radius = 0.8 }",
];

/// Every method with a tolerance in its place.
const CONTROLLED: [&str; 6] = [
    "gauss = { stages = 1, tolerance = TOLERANCE }",
    "gauss = { stages = 2, tolerance = TOLERANCE }",
    "gauss = { stages = 3, tolerance = TOLERANCE }",
    "radau = { stages = 2, tolerance = TOLERANCE }",
    "radau = { stages = 3, tolerance = TOLERANCE }",
    "generalized_alpha = { tolerance = TOLERANCE, spectral_radius = 0.8 }",
];

const TIP: &str = "[[effect.force]]\nbeam = \"a\"\nat = \"end\"\nvalue = [0, 4]\n";
const REFERENCE: &str = "radau = { stages = 3, tolerance = 1e-9 }";

/// What begins to act at 0.1537 s, which no step of fixed length meets by itself.
fn causes() -> Vec<(&'static str, String)> {
    let held = "[[support]]\nbeam = \"a\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n";
    vec![
        ("step", format!("{TIP}in_time.step.start = 0.1537\n")),
        ("ramp", format!("{TIP}in_time.ramp = {{ start = 0.1537, duration = 0.0411 }}\n")),
        ("smooth ramp", format!("{TIP}in_time.smooth_ramp = {{ start = 0.1537, duration = 0.0411 }}\n")),
        ("table", format!("{TIP}in_time.table = {{ times = [0.1537, 0.16, 0.2], values = [0, 1, -1] }}\n")),
        (
            "moving force",
            "[[effect.moving_force]]\nbeam = \"a\"\nvalue = [0, -6]\nspeed = 10\nstart = -1.537\n".into(),
        ),
        (
            "moving force from the end",
            "[[effect.moving_force]]\nbeam = \"a\"\nvalue = [0, -6]\nspeed = -10\nstart = 2.537\n".into(),
        ),
        (
            "support",
            format!(
                "{held}move = {{ y = 0.1, angle = 0.2, in_time.smooth_ramp = {{ start = 0.1537, duration = 0.05 }} }}\n"
            ),
        ),
    ]
}

/// Loads that move follow time as those with a law do; what always acts does not.
#[test]
fn loads_that_move_follow_time() {
    let follow = |acts: &str| {
        let text = format!(
            "[beam.a]\nstart = [0, 0]\nend = [1, 0]\naxial_stiffness = 1e4\nbending_stiffness = 1\nmass_per_length = 1\n\
             basis.ancf.elements = 1\n{acts}[analysis.dynamic]\nduration = 1\n"
        );
        let scene = parse("laws.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let system = System::build(scene.model(), Needs { inertia: true, motion: true });
        system.expect("a system").loads_follow_time()
    };
    let with_a_law = format!("{TIP}in_time.step.start = 0.1\n");
    let moving = "[[effect.moving_force]]\nbeam = \"a\"\nvalue = [0, -6]\nspeed = 10\n";
    assert_eq!(["", TIP, with_a_law.as_str(), moving].map(follow), [false, false, true, true]);
}

#[test]
fn nothing_moves_before_its_cause_and_kinks_cost_no_accuracy() {
    for (name, acts) in causes() {
        let reference = positions(&moved(&acts, 0.3, 0.01, REFERENCE), 0);
        let largest = reference.iter().skip(1).step_by(2).fold(0.0_f64, |m, y| m.max(y.abs()));
        let controlled = CONTROLLED.map(|integrator| integrator.replace("TOLERANCE", "1e-4"));
        for integrator in FIXED.iter().copied().chain(controlled.iter().map(|i| &i[..])) {
            let found = moved(&acts, 0.3, 0.01, integrator);
            for sample in found.probes.iter().flat_map(|probe| &probe.samples[..16]) {
                assert!(sample.y.abs() < 1e-12, "{name}, {integrator}: y = {} before 0.1537 s", sample.y);
            }
            // Steps of these lengths err by as much without a kink.
            let allowed = if integrator.contains("step") { 6e-3 } else { 5e-4 };
            let error = apart(&positions(&found, 0), &reference);
            assert!(error < allowed * largest.max(0.5), "{name}, {integrator}: {error:.2e}");
        }
    }
}

/// A rod at rest lies along x and turns freely about its start, which a support suddenly carries
/// across with the speed V, and stops later. In axes that move with the support no force has a
/// moment about it, so that the rod keeps its angular momentum there: it turns at 3 V/2 L, and at
/// the stop that changes by 3 V/2 L cos θ. What the jumps excite is damped within hundredths of a
/// second, in which the rod turns by 5e-5 rad less. The support gives the momentum ρA L (V − ¾ V
/// cos θ) and with it V times as much work, half of it at once to the mass of the node that it
/// holds.
#[test]
fn a_support_that_sets_off_and_stops_turns_a_rod_as_momentum_tells() {
    let (speed, turning) = (1.0_f64, 1.5);
    let (start, duration) = (0.1, 0.5);
    let angle = |t: f64| {
        let stop: f64 = -turning * duration;
        let after = turning * stop.cos() - turning;
        match t - start {
            since if since <= 0.0 => 0.0,
            since if since <= duration => -turning * since,
            since => stop + after * (since - duration),
        }
    };
    for integrator in
        ["radau.tolerance = 1e-5", "gauss.tolerance = 1e-5", "generalized_alpha.tolerance = 1e-4"]
    {
        let text = format!(
            "[beam.a]\nstart = [0, 0]\nend = [1, 0]\naxial_stiffness = 1e6\nbending_stiffness = 100\nmass_per_length = 1\n\
             basis.ancf.elements = 4\n[[effect.damping]]\nbeam = 'a'\ncurvature = 2\n\
             [[support]]\nbeam = 'a'\nat = 'start'\nfix = ['x', 'y']\n\
             move = {{ y = {}, in_time.ramp = {{ start = {start}, duration = {duration} }} }}\n\
             [[probe]]\nname = 'tip'\nbeam = 'a'\nat = 'end'\n[analysis.dynamic]\nduration = 1\noutput_every = 0.1\n{integrator}\n",
            speed * duration
        );
        let scene = parse("support.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let found =
            scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{integrator}: {error}"));
        assert_eq!(found.run().warnings, [""; 0], "{integrator}");
        for ((time, sample), energy) in
            found.states().parameter.iter().zip(&found.states().probes[0].samples).zip(&found.states().energy)
        {
            let error = (sample.angle - angle(*time)).abs();
            assert!(error < 2e-4, "{integrator}, t = {time}: {error:.2e} rad off");
            let since = time - start;
            if since > 0.05 && since < duration {
                let work: f64 = speed * (speed - 0.75 * speed * angle(*time).cos());
                let error = (energy.work - work).abs();
                assert!(error < 0.05 * work, "{integrator}, t = {time}: {error:.2e} J off");
            }
        }
    }
}

/// Steps of given length are solved on meshes so fine that a load which sets in at once would carry
/// their first node through many elements, were it followed with its first acceleration. Without
/// the second prediction they are not solved at all; by Radau's method few steps are divided.
#[test]
fn steps_of_given_length_bear_fine_meshes() {
    let at = |elements: usize, method: &str| {
        let text = format!(
            "[beam.a]\nstart = [0, 0]\nend = [1, 0]\naxial_stiffness = 1e4\nbending_stiffness = 1\nmass_per_length = 1\n\
             basis.ancf.elements = {elements}\n[[support]]\nbeam = 'a'\nat = 'start'\nfix = ['x', 'y', 'angle']\n{TIP}\
             [[probe]]\nname = 'tip'\nbeam = 'a'\nat = 'end'\n[analysis.dynamic]\nduration = 0.1\noutput_every = 0.1\n{method}.step = 0.01\n"
        );
        let scene = parse("fine.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let found = scene.model().solve(scene.analysis());
        let found = found.unwrap_or_else(|error| panic!("{elements} elements, {method}: {error}"));
        let tip = found.states().probes[0].samples.last().expect("a record");
        ([tip.x, tip.y], found.run().statistics.rejected_steps)
    };
    for method in ["radau", "gauss"] {
        let (coarse, _) = at(12, method);
        let (fine, rejected) = at(1500, method);
        let apart = (fine[0] - coarse[0]).hypot(fine[1] - coarse[1]);
        assert!(apart < 2e-3, "{method}: the tip is {apart:.2e} L elsewhere");
        assert!(method == "gauss" || rejected <= 20, "{method}: {rejected} steps rejected");
    }
}

/// A load that comes later moves the beam as one that acts at once does, later: to round-off, where
/// it comes at the end of a step.
#[test]
fn a_load_that_comes_later_does_the_same_later() {
    for integrator in FIXED {
        let at_once = moved(TIP, 0.2, 0.02, integrator);
        let later = moved(&format!("{TIP}in_time.step.start = 0.12\n"), 0.32, 0.02, integrator);
        let error = apart(&positions(&at_once, 0), &positions(&later, 6));
        assert!(error < 1e-8, "{integrator}: {error:.2e}");
    }
}

/// Between kinks the methods keep their order: of a ramp with corners anywhere, too.
#[test]
fn kinks_do_not_cost_the_order() {
    let damped = "[[effect.damping]]\nbeam = \"a\"\nstiffness_proportional = 2e-3\n";
    let acts = format!(
        "{TIP}in_time.table = {{ times = [0.0123, 0.0571, 0.0877], values = [0, 1, 0.3] }}\n{damped}"
    );
    let reference = positions(&moved(&acts, 0.12, 0.12, "radau = { stages = 3, step = 1e-4 }"), 1);
    for (integrator, order, step) in [
        ("gauss = { stages = 1, step = STEP }", 2.0, 2e-3),
        ("generalized_alpha = { step = STEP, spectral_radius = 0.8 }", 2.0, 2e-3),
        ("radau = { stages = 2, step = STEP }", 3.0, 2e-3),
        ("gauss = { stages = 2, step = STEP }", 4.0, 4e-3),
    ] {
        let error = |step: f64| {
            let integrator = integrator.replace("STEP", &format!("{step:?}"));
            apart(&positions(&moved(&acts, 0.12, 0.12, &integrator), 1), &reference)
        };
        let (coarse, fine) = (error(step), error(0.25 * step));
        let observed = 0.5 * (coarse / fine).log2();
        assert!(observed > order - 0.5, "{integrator}: order {observed:.2} from {coarse:.2e} and {fine:.2e}");
    }
}

/// What oscillates faster than the steps is seen all the same: forces, moments, supports that
/// shake, loads that run over the beam.
#[test]
fn a_tolerance_holds_for_loads_of_any_frequency() {
    let held = "[[support]]\nbeam = \"a\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n";
    let harmonic = |frequency: f64| format!("{TIP}in_time.harmonic.frequency = {frequency:?}\n");
    let acts = [
        harmonic(3.0),
        harmonic(50.0),
        harmonic(100.0),
        harmonic(1e3),
        format!("{TIP}in_time.harmonic = {{ frequency = 100, phase = \"90 deg\" }}\n"),
        "[[effect.moment]]\nbeam = \"a\"\nat = 0.5\nvalue = 3\nin_time.harmonic.frequency = 40\n".into(),
        format!("{held}move = {{ y = 0.01, in_time.harmonic.frequency = 30 }}\n"),
        format!("{held}move = {{ angle = 0.02, in_time.harmonic.frequency = 60 }}\n"),
        "[[effect.moving_force]]\nbeam = \"a\"\nvalue = [0, -20]\nspeed = 40\nstart = -1\n".into(),
        format!("{TIP}in_time.polynomial = [0, 40, -900, 5000]\n"),
    ];
    for acts in acts {
        let reference = positions(&moved(&acts, 0.1, 0.01, REFERENCE), 0);
        for integrator in CONTROLLED {
            for tolerance in ["1e-3", "1e-5"] {
                let low = integrator.contains("generalized") || integrator.contains("stages = 1");
                if tolerance == "1e-5" && low {
                    continue;
                }
                let found = moved(&acts, 0.1, 0.01, &integrator.replace("TOLERANCE", tolerance));
                let error = apart(&positions(&found, 0), &reference);
                let allowed = 5.0 * tolerance.parse::<f64>().expect("a number");
                assert!(error < allowed, "{acts}{integrator}, {tolerance}: {error:.2e}");
            }
        }
    }
}
