//! Motions as they come: random beams, supports and loads, which no method was measured on. None
//! may fail, and none may err by more than ten times its tolerance.

use ancf::results::{Results, Trajectory};
use ancf::run::RunError;
use ancf::scene::parse;
use std::fmt::Write;

/// Numbers that are the same on every machine (Knuth's linear congruence).
struct Random(u64);

impl Random {
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.part()
    }

    fn one_of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[(self.part() * choices.len() as f64) as usize].clone()
    }
}

const DURATION: f64 = 0.3;

fn law(random: &mut Random) -> String {
    let (start, length) = (random.within(0.01, 0.1), random.within(0.01, 0.1));
    let frequency = random.within(1.0, 90.0);
    random.one_of(&[
        String::new(),
        format!("in_time.step.start = {start}\n"),
        format!("in_time.ramp = {{ start = {start}, duration = {length} }}\n"),
        format!("in_time.smooth_ramp = {{ start = 0.0, duration = {length} }}\n"),
        format!("in_time.harmonic.frequency = {frequency}\n"),
    ])
}

/// A motion without its integrator.
fn scene(seed: u64) -> String {
    let mut random = Random(seed);
    random.part();
    let (sine, cosine) = random.within(0.0, std::f64::consts::TAU).sin_cos();
    let turned = |x: f64, y: f64| format!("[{}, {}]", cosine * x - sine * y, sine * x + cosine * y);
    let basis = random.one_of(&["ancf.elements = 4", "ancf.elements = 8", "rpim.nodes = 7"]);
    let stiffness = 10f64.powf(random.within(3.0, 5.0));
    let mut text = format!(
        "[beam.a]\nstart = [0, 0]\nend = {}\naxial_stiffness = {stiffness}\nbending_stiffness = 1\nmass_per_length = 1\nbasis.{basis}\n\
         [analysis.dynamic]\nduration = {DURATION}\noutput_every = 0.05\nINTEGRATOR\n",
        turned(1.0, 0.0)
    );
    for (name, at) in [("inside", "0.3"), ("tip", "\"end\"")] {
        writeln!(text, "[[probe]]\nname = \"{name}\"\nbeam = \"a\"\nat = {at}").expect("text");
    }
    let pinned = random.part() < 0.4;
    let fix = if pinned { "\"x\", \"y\"" } else { "\"x\", \"y\", \"angle\"" };
    writeln!(text, "[[support]]\nbeam = \"a\"\nat = \"start\"\nfix = [{fix}]").expect("text");
    if pinned && random.part() < 0.7 {
        let rotation = random.within(-6.0, 6.0);
        writeln!(text, "[[initial_velocity]]\nbeam = \"a\"\nrotation = {rotation}\nabout = [0, 0]")
            .expect("text");
    }
    for _ in 0..random.one_of(&[1, 2]) {
        let at = random.one_of(&["\"end\"", "0.5"]);
        let force = turned(random.within(-3.0, 3.0), random.within(-5.0, 5.0));
        let moment = random.within(-2.0, 2.0);
        let load = random.one_of(&[
            format!("[[effect.force]]\nbeam = \"a\"\nat = {at}\nvalue = {force}\n"),
            format!("[[effect.force]]\nbeam = \"a\"\nat = {at}\nvalue = {force}\nfollower = true\n"),
            format!("[[effect.moment]]\nbeam = \"a\"\nat = {at}\nvalue = {moment}\n"),
            format!("[[effect.distributed_force]]\nbeam = \"a\"\nvalue = {force}\n"),
        ]);
        text += &(load + &law(&mut random));
    }
    if random.part() < 0.3 {
        let mass = random.within(0.1, 1.0);
        writeln!(text, "[[effect.point_mass]]\nbeam = \"a\"\nat = \"end\"\nmass = {mass}").expect("text");
    }
    text
}

fn moved(scene: &str, integrator: &str) -> Result<Trajectory, RunError> {
    let scene = parse("random.toml", &scene.replace("INTEGRATOR", integrator)).expect("a legal scene");
    scene.model().solve(scene.analysis()).map(Results::into_states)
}

fn positions(trajectory: &Trajectory) -> impl Iterator<Item = [f64; 2]> + '_ {
    trajectory.probes.iter().flat_map(|probe| &probe.samples).map(|sample| [sample.x, sample.y])
}

#[test]
fn random_motions_meet_their_tolerance_by_every_integrator() {
    let integrators = [
        "gauss = { stages = 1, tolerance = TOLERANCE }",
        "gauss = { stages = 2, tolerance = TOLERANCE }",
        "gauss = { stages = 3, tolerance = TOLERANCE }",
        "radau = { stages = 2, tolerance = TOLERANCE }",
        "radau = { stages = 3, tolerance = TOLERANCE }",
        "generalized_alpha = { tolerance = TOLERANCE }",
    ];
    let mut faults = Vec::new();
    for seed in 1..=8 {
        let scene = scene(seed);
        let reference = moved(&scene, "radau = { stages = 3, tolerance = 1e-8 }").expect("a reference");
        for (i, integrator) in integrators.iter().enumerate() {
            for (tolerance, text) in [(1e-3, "1e-3"), (1e-5, "1e-5")] {
                // Methods of second order take very many steps for five digits: a motion each will
                // do.
                if tolerance < 1e-4 && [0, 5].contains(&i) && seed % 4 != i as u64 % 2 {
                    continue;
                }
                match moved(&scene, &integrator.replace("TOLERANCE", text)) {
                    Err(error) => faults.push(format!("seed {seed}, {integrator}, {text}: {error}")),
                    Ok(found) => {
                        let pairs = positions(&found).zip(positions(&reference));
                        let error = pairs.fold(0.0_f64, |m, (a, b)| m.max((a[0] - b[0]).hypot(a[1] - b[1])));
                        if error > 10.0 * tolerance {
                            faults.push(format!("seed {seed}, {integrator}, {text}: errs by {error:.2e}"));
                        }
                    }
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// With strong damping of strains the iterations of a step converge slowly, and what they leave adds
/// up. Each motion is compared with one of short steps of given length, whose equations are solved
/// almost to round-off. A tolerance is a wanted error, not a bound; iterations that stopped at a
/// fixed part of it erred by up to 70 tolerances here.
#[test]
fn tolerances_are_kept_with_strong_damping() {
    const LENGTH: f64 = 1.14;
    let scene = |support: &str, damping: f64, load: &str, duration: f64| {
        format!(
            "beam.a = {{ points = [[0, 0], [0.06, 0.3], [0.3, 0.4], [0.4, 0.6], [0.4, 0.9]], axial_stiffness = 4e9, bending_stiffness = 1.6, mass_per_length = 1.2, basis.ancf.nodes = 3 }}
            {support}
            effect.damping = [{{ beam = 'a', stiffness_proportional = {damping} }}]
            {load}
            probe = [{{ name = 'middle', beam = 'a', at = 0.5 }}, {{ name = 'tip', beam = 'a', at = 'end' }}]
            analysis.dynamic = {{ duration = {duration}, output_every = 0.01, INTEGRATOR }}\n"
        )
    };
    let clamp = "support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }]";
    let swollen = "effect.actuation = [{ beam = 'a', strain = 0.03 }]";
    let pulled = "effect.force = [{ beam = 'a', at = 'end', value = [5, 0] }]";
    for (name, scene, step, worst) in [
        ("clamped, swollen", scene(clamp, 2e-4, swollen, 0.05), 1e-6, 5.0),
        ("free, pulled", scene("", 2e-4, pulled, 0.2), 1e-4, 2.0),
        ("clamped, pulled", scene(clamp, 2e-5, pulled, 0.2), 1e-4, 3.0),
    ] {
        let reference = moved(&scene, &format!("radau = {{ stages = 3, step = {step} }}"))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        for (integrator, tolerance) in [
            ("radau = { stages = 2, tolerance = 1e-5 }", 1e-5),
            ("radau = { stages = 3, tolerance = 1e-4 }", 1e-4),
            ("radau = { stages = 3, tolerance = 1e-5 }", 1e-5),
            ("gauss = { stages = 3, tolerance = 1e-5 }", 1e-5),
            ("generalized_alpha = { tolerance = 1e-5 }", 1e-5),
        ] {
            let found = moved(&scene, integrator).unwrap_or_else(|error| panic!("{name}: {error}"));
            let pairs = positions(&found).zip(positions(&reference));
            let error = pairs.fold(0.0_f64, |m, (a, b)| m.max((a[0] - b[0]).hypot(a[1] - b[1]))) / LENGTH;
            println!("{name}, {integrator}: {:.3}", error / tolerance);
            assert!(error < worst * tolerance, "{name}, {integrator}: errs by {error:.2e} lengths");
        }
    }
}

/// An attempt whose iteration diverges leaves a tension of any size of the tendon. A shorter attempt
/// that began with it stalled at once, and its steps were taken for solved: the motion erred by 4000
/// tolerances. The reference has steps of given length.
#[test]
fn a_step_that_failed_leaves_no_forces_of_constraints_behind() {
    let scene = "beam.a = { axial_stiffness = 125, bending_stiffness = 9e-9, mass_per_length = 8e-4, basis.rpim.nodes = 11, arc = { center = [0.0733, 0], radius = 0.0733, from = 3.141592653589793, to = 1.3725926535897932 } }
        effect.damping = [{ beam = 'a', curvature = 0.0064 }]
        effect.tendon = [{ beam = 'a', offset = -0.00325, shortening = 0.00083, in_time.smooth_ramp.duration = 1.07 }]
        initial_velocity = [{ beam = 'a', rotation = 0.0106, about = [0, 0] }]
        effect.force = [{ beam = 'a', at = 'end', value = [-7.85e-8, 1.0476e-6] }]
        probe = [{ name = 'tip', beam = 'a', at = 'end' }]
        analysis.dynamic = { duration = 0.1, INTEGRATOR }\n";
    let length = 0.0733 * 1.769;
    let reference = moved(scene, "radau = { stages = 3, step = 1e-4 }").expect("a reference");
    for (text, tolerance) in [("1e-6", 1e-6), ("1e-7", 1e-7), ("3e-8", 3e-8)] {
        let found = moved(scene, &format!("radau = {{ stages = 3, tolerance = {text} }}")).expect("a motion");
        let pairs = positions(&found).zip(positions(&reference));
        let (a, b) = pairs.last().expect("the end");
        let error = (a[0] - b[0]).hypot(a[1] - b[1]) / length;
        assert!(error < 3.0 * tolerance, "{text}: errs by {error:.2e} lengths");
    }
}

/// Two rods of 1 m and 1 kg/m that keep their length, let go from the horizontal: as stiff as they are (their weight bends them by a
/// millionth) they fall as rigid ones do, of which an integration by Runge and Kutta's method with a tolerance of 1e-12 gives the
/// end after 1 s. What moves a state onto the constraints must not bend them beside the hinge: that would be seen in records
/// between the ends of steps, and be a tenth of a joule.
#[test]
fn hinged_rods_are_not_bent_by_what_keeps_their_length() {
    let scene = "beam.upper = { start = [0, 0], end = [1, 0], bending_stiffness = 1e6, mass_per_length = 1, basis.ancf.elements = 8 }
        beam.lower = { start = [1, 0], end = [2, 0], bending_stiffness = 1e6, mass_per_length = 1, basis.ancf.elements = 8 }
        joint = [{ type = 'hinge', first = { beam = 'upper', at = 'end' }, second = { beam = 'lower', at = 'start' } }]
        support = [{ beam = 'upper', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -9.81]
        probe = [{ name = 'tip', beam = 'lower', at = 'end' }]
        analysis.dynamic = { duration = 1, INTEGRATOR }\n";
    for integrator in ["radau = { stages = 3, tolerance = 1e-4 }", "generalized_alpha = { tolerance = 1e-4 }"]
    {
        let found = moved(scene, integrator).expect("a motion");
        let [x, y] = positions(&found).last().expect("the end");
        let error = (x + 1.662_115_14).hypot(y + 1.041_466_64);
        // Ten tolerances: by so much the motion amplifies what its steps err by.
        assert!(error < 1e-3, "{integrator}: errs by {error:.1e} m");
        let bend = found.energy.iter().map(|energy| energy.bend).fold(0.0, f64::max);
        assert!(bend < 2e-3, "{integrator}: {bend:.1e} J");
    }
}

/// A support turns a stiff arm that keeps its length, from which another one hangs by a hinge: all that it puts in is in the balance
/// of energy, of 2 J that move.
#[test]
fn the_work_of_a_support_that_drives_stiff_rods_is_complete() {
    let scene = "beam.a = { start = [0, 0], end = [0.5, 0], bending_stiffness = 1e5, mass_per_length = 1, basis.ancf.elements = 3 }
        beam.b = { start = [0.5, 0], end = [0.9, 0.3], bending_stiffness = 1e3, mass_per_length = 0.6, basis.ancf.elements = 4 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'], move = { angle = 6, in_time.smooth_ramp.duration = 1 } }]
        joint = [{ type = 'hinge', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]
        effect.gravity.acceleration = [0, -9.81]
        analysis.dynamic = { duration = 1.2, INTEGRATOR }\n";
    let found = moved(scene, "radau = { stages = 2, step = 0.005 }").expect("a motion");
    let total = found.energy.last().expect("a record").total() - found.energy[0].total();
    assert!(total.abs() < 2e-3, "{total:.1e} J");
}

/// Two hinged rods that keep their length fly apart from their hinge, at rest at first, with no force on them: their centre of mass
/// goes on with the velocity Σ m v/Σ m of their midpoints. No other norm than that of the kinetic energy moves states onto the
/// constraints so.
#[test]
fn what_keeps_lengths_leaves_momentum_alone() {
    let scene = "beam.a = { start = [0, 0], end = [1, 0], bending_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 12 }
        beam.b = { start = [1, 0], end = [1.7, 0.3], bending_stiffness = 1e3, mass_per_length = 0.6, basis.ancf.elements = 12 }
        initial_velocity = [{ beam = 'a', rotation = 4, about = [1, 0] }, { beam = 'b', rotation = -5, about = [1, 0] }]
        joint = [{ type = 'hinge', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]
        analysis.dynamic = { duration = 1, INTEGRATOR }\n";
    let masses = [1.0, 0.6 * 0.58_f64.sqrt()];
    let centre = |of: [[f64; 2]; 2]| {
        [0, 1].map(|axis| (masses[0] * of[0][axis] + masses[1] * of[1][axis]) / (masses[0] + masses[1]))
    };
    let (start, velocity) = (centre([[0.5, 0.0], [1.35, 0.15]]), centre([[0.0, -2.0], [0.75, -1.75]]));
    for (integrator, allowed) in [("radau.step = 0.01", 1e-7), ("generalized_alpha.step = 0.005", 1e-5)] {
        let found = moved(scene, integrator).expect("a motion");
        let middle = |beam: usize| {
            let shape = &found.last[beam];
            let mean = |along: &[f64]| {
                let cells = shape.s.windows(2).zip(along.windows(2));
                cells.map(|(s, x)| 0.5 * (s[1] - s[0]) * (x[0] + x[1])).sum::<f64>()
                    / shape.s.last().expect("a place")
            };
            [mean(&shape.x), mean(&shape.y)]
        };
        let end = centre([middle(0), middle(1)]);
        let off = (0..2).map(|axis| (end[axis] - start[axis] - velocity[axis]).abs()).fold(0.0, f64::max);
        assert!(off < allowed, "{integrator}: {off:.1e} m");
    }
}

/// Two stiff beams at right angles, welded, fly and spin as one body: the end of the second turns about the centre of mass, which goes
/// straight on. What they are welded by turns with them, and so does a tangent, that serves for many steps.
#[test]
fn tangents_turn_with_welded_beams() {
    let scene = "beam.a = { start = [0, 0], end = [1, 0], bending_stiffness = 1e7, STRETCH mass_per_length = 1, basis.ancf.elements = 8 }
        beam.b = { start = [1, 0], end = [1, 1], bending_stiffness = 1e7, STRETCH mass_per_length = 1, basis.ancf.elements = 8 }
        initial_velocity = [
            { beam = 'a', rotation = 6, about = [0.75, 0.25], value = [1, 0.5] },
            { beam = 'b', rotation = 6, about = [0.75, 0.25], value = [1, 0.5] },
        ]
        joint = [{ type = 'weld', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]
        probe = [{ name = 'end', beam = 'b', at = 'end' }]
        analysis.dynamic = { duration = 2, INTEGRATOR }\n";
    let (sine, cosine) = 12_f64.sin_cos();
    let exact = [2.75 + 0.25 * cosine - 0.75 * sine, 1.25 + 0.25 * sine + 0.75 * cosine];
    for stretch in ["", "axial_stiffness = 1e8, "] {
        for (integrator, allowed) in
            [("radau.tolerance = 1e-4", 1e-4), ("generalized_alpha.step = 0.002", 1e-3)]
        {
            let found = moved(&scene.replace("STRETCH ", stretch), integrator).expect("a motion");
            let [x, y] = positions(&found).last().expect("the end");
            let error = (x - exact[0]).hypot(y - exact[1]);
            assert!(error < allowed, "{integrator}, {stretch}: errs by {error:.1e} m");
            let statistics = &found.run.statistics;
            let factorizations = statistics.factorizations;
            assert!(2 * factorizations < statistics.steps, "{integrator}, {stretch}: {statistics:?}");
        }
    }
}

/// A beam that can stretch, and is damped, and one that keeps its length, hinged at its end, fly freely. Each iteration leaves lengths too
/// large, in every step, so that it has to be stopped later than where errors have any sign. Radau's method is the judge.
#[test]
fn steps_that_keep_lengths_err_by_their_tolerance() {
    let scene = "beam.a = { start = [0, 0], end = [1, 0], axial_stiffness = 5e4, bending_stiffness = 4, mass_per_length = 1.6, basis.ancf.elements = 2 }
        beam.b = { start = [1, 0], end = [1.3, 0.8], bending_stiffness = 2.4, mass_per_length = 1, basis.ancf.elements = 2 }
        joint = [{ type = 'hinge', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]
        initial_velocity = [{ beam = 'a', rotation = 7 }, { beam = 'b', rotation = 7 }]
        effect.damping = [{ beam = 'a', stiffness_proportional = 1e-3 }]
        probe = [{ name = 'a', beam = 'a', at = 'end' }, { name = 'b', beam = 'b', at = 'end' }]
        analysis.dynamic = { duration = 1, INTEGRATOR }\n";
    let end = |integrator: &str| -> Vec<[f64; 2]> {
        let found = moved(scene, integrator).expect("a motion");
        let last = found.probes.iter().filter_map(|probe| probe.samples.last());
        last.map(|at| [at.x, at.y]).collect()
    };
    let exact = end("radau.tolerance = 1e-8");
    for (integrator, allowed) in [
        ("generalized_alpha.tolerance = 1e-4", 5e-4),
        ("generalized_alpha.tolerance = 1e-5", 5e-5),
        ("radau.tolerance = 1e-4", 5e-4),
    ] {
        let errors = end(integrator).into_iter().zip(&exact).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        let error = errors.fold(0.0, f64::max);
        assert!(error < allowed, "{integrator}: errs by {error:.1e} m");
    }
}

/// A free beam of 1 kg that a pulse pushes by 0.1 N s in its middle, as briefly as it may be against a step: from then on its centre
/// of mass goes 0.1 m/s faster. The middle vibrates about it by some tenths of a millimetre.
#[test]
fn the_impulse_of_a_pulse_does_not_depend_on_how_short_it_is() {
    for spectral_radius in [0.8, 0.9, 1.0] {
        for width in [1e-3, 1e-4, 1e-6, 1e-9] {
            let text = format!(
                "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 10, mass_per_length = 1, \
                 basis.ancf.elements = 4 }}\n\
                 effect.force = [{{ beam = 'b', at = 0.5, value = [0, {:e}], in_time.table = {{ times = [0.1003, {}, {}], \
                 values = [0, 1, 0] }} }}]\n\
                 probe = [{{ name = 'm', beam = 'b', at = 0.5 }}]\n\
                 analysis.dynamic = {{ duration = 0.5, output_every = 0.1, \
                 generalized_alpha = {{ step = 0.002, spectral_radius = {spectral_radius} }} }}\n",
                0.2 / width,
                0.1003 + 0.5 * width,
                0.1003 + width
            );
            let found = moved(&text, "").unwrap_or_else(|error| panic!("{error}, {width} s"));
            let y = positions(&found).last().expect("a state")[1];
            let expected = 0.1 * (0.5 - 0.1003 - 0.5 * width);
            assert!((y - expected).abs() < 1e-3, "{y} for {expected}: {width} s, {spectral_radius}");
        }
    }
}

/// The foot of a cantilever that is moved by 1 mm within half a step: between the ends of a step that held all of it, its foot would
/// have moved without velocity or acceleration, and the tip would miss a third of its motion.
#[test]
fn a_support_that_moves_within_a_step_is_seen() {
    let of = |integrator: &str| {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 1 }}\n\
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'], move = {{ y = 1e-3, \
             in_time.smooth_ramp = {{ start = 0.1003, duration = 1e-3 }} }} }}]\n\
             probe = [{{ name = 'tip', beam = 'a', at = 'end' }}]\n\
             analysis.dynamic = {{ duration = 1, output_every = 0.05, {integrator} }}\n"
        );
        moved(&text, "").unwrap_or_else(|error| panic!("{error}, {integrator}"))
    };
    let expected = of("radau.tolerance = 1e-9");
    for integrator in ["generalized_alpha.step = 2e-3", "gauss = { stages = 2, step = 2e-3 }"] {
        let found = of(integrator);
        for (found, expected) in positions(&found).zip(positions(&expected)) {
            assert!((found[1] - expected[1]).abs() < 2e-4, "{found:?} for {expected:?}, {integrator}");
        }
    }
}

/// A stiff rod flies through the air, and a force runs along it and leaves it. Vibrations of its bending then decay, steps
/// become longer than a tenth of the motion, and records lie within them. Between records a free rod's centre falls by
/// −g Δt² in second differences, and the rod turns evenly, whether or not reactions are asked for: with them, states
/// are moved until their forces balance.
#[test]
fn states_within_long_steps_fly_as_rods_do() {
    let (end, gravity, every) =
        ([0.025_966_123_729_071_058_f64, 0.007_981_080_345_828_7], 2.5971_f64, 0.02191);
    let length = end[0].hypot(end[1]);
    for (integrator, most) in
        [("gauss.tolerance = 1e-6", 3e-6), ("gauss.tolerance = 1e-5", 3e-5), ("radau.tolerance = 1e-6", 3e-6)]
    {
        for output in ["", "output.reactions = true\n"] {
            let text = format!(
                "{output}analysis.dynamic = {{ duration = 0.2191, output_every = {every}, {integrator} }}\n\
                 beam.rod = {{ start = [0, 0], end = {end:?}, bending_stiffness = 313.2, mass_per_length = 3.066, \
                 axial_stiffness = 1.2733e8, strain = 'engineering', basis.rpim.nodes = 6 }}\n\
                 effect.damping = [{{ beam = 'rod', curvature = 1.0227e-4 }}]\n\
                 effect.gravity.acceleration = [0, -{gravity}]\n\
                 effect.moving_force = [{{ beam = 'rod', value = [-0.11072, 0.088174], speed = -0.49498, start = 0.024455 }}]\n\
                 initial_velocity = [{{ beam = 'rod', value = [0.22432, -0.1186] }}]\n\
                 probe = [{{ name = 'a', beam = 'rod', at = 0.0 }}, {{ name = 'b', beam = 'rod', at = 'end' }}]\n"
            );
            let scene = parse("rod", &text).unwrap_or_else(|error| panic!("{error}"));
            let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
            let [a, b] = [0, 1].map(|i| &results.states().probes[i].samples);
            let centre = |k: usize| [0.5 * (a[k].x + b[k].x), 0.5 * (a[k].y + b[k].y)];
            for k in 4..10 {
                let ([before, now, after], angle) = ([k - 1, k, k + 1].map(centre), |k: usize| a[k].angle);
                let second = |i: usize| before[i] - 2.0 * now[i] + after[i];
                let fall = second(0).hypot(gravity.mul_add(every * every, second(1))) / length;
                let turn = (angle(k - 1) - 2.0 * angle(k) + angle(k + 1)).abs();
                assert!(
                    fall < most && turn < most,
                    "{integrator}, {output:?}, record {k}: {fall:.1e}, {turn:.1e} rad"
                );
            }
        }
    }
}

/// A stiff rod of given length swings from a pin (θ̈ = −3g/2L sin θ, by Runge and Kutta). Two of its cells are so short that the last
/// digits of their nodes would turn them by 1e4 rad/s², which is what the motion seems to start with.
#[test]
fn short_cells_do_not_kick_a_rod_at_its_start() {
    let (sine, cosine) = (-0.183_163_736_813_126_28_f64, 0.983_082_420_510_433_f64);
    let [mut angle, mut speed] = [sine.atan2(cosine), 0.0];
    let (h, steps) = (1e-4, 10_000);
    let rates = |angle: f64, speed: f64| [speed, -1.5 * angle.sin()];
    for _ in 0..steps {
        let [a, b] = rates(angle, speed);
        let [c, d] = rates(angle + 0.5 * h * a, speed + 0.5 * h * b);
        let [e, f] = rates(angle + 0.5 * h * c, speed + 0.5 * h * d);
        let [g, i] = rates(angle + h * e, speed + h * f);
        angle += h / 6.0 * (a + 2.0 * (c + e) + g);
        speed += h / 6.0 * (b + 2.0 * (d + f) + i);
    }
    for tolerance in [1e-4, 1e-6] {
        let text = format!(
            "beam.b = {{ start = [0, 0], end = [{sine:?}, {:?}], bending_stiffness = 1.2e5, mass_per_length = 1, \
             basis.ancf.nodes = [0.0, 0.118, 0.236, 0.355, 0.473, 0.591, 0.709, 0.7117, 0.7141, 0.755, 0.796, 0.822, 0.848, 0.924, 1.0] }}\n\
             effect.damping = [{{ beam = 'b', curvature = 1e-3 }}]\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'y'] }}]\n\
             effect.gravity.acceleration = [0, -1]\n\
             probe = [{{ name = 'tip', beam = 'b', at = 'end' }}]\n\
             analysis.dynamic = {{ duration = 1.0, radau.tolerance = {tolerance:e} }}\n",
            -cosine
        );
        let scene = parse("rod", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
        let tip = results.states().probes[0].samples.last().expect("a record");
        let miss = (tip.x - angle.sin()).hypot(tip.y + angle.cos());
        assert!(miss < 10.0 * tolerance && miss < 1e-6, "{tolerance:e}: {miss:.1e}");
    }
}

/// The end of a string under tension is brought back to where the string has no tension, and beyond: the wave that follows presses
/// it, which a string does not resist. As long as it is pulled nothing is said.
#[test]
fn strings_that_are_pressed_are_warned_of() {
    for (back, pressed) in [(-0.05, false), (-0.12, true)] {
        let text = format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 4, mass_per_length = 1, basis.ancf.elements = 16, \
             initial_shape.line = {{ start = [0, 0], end = [1.1, 0] }} }}\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'y'] }}, \
             {{ beam = 'b', at = 'end', fix = ['x', 'y'], move = {{ x = {back}, in_time.smooth_ramp.duration = 2.0 }} }}]\n\
             analysis.dynamic = {{ duration = 2.0, radau.tolerance = 1e-5 }}\n"
        );
        let scene = parse("string", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
        let warned = results.run().warnings.iter().any(|warning| warning.contains("is pressed"));
        assert_eq!(warned, pressed, "{back}: {:?}", results.run().warnings);
    }
}

/// Three welded beams on few cells shake, driven by a hinge that is moved: forces of a record balance all the same, and there is no moment
/// in the hinge.
#[test]
fn forces_balance_in_beams_that_shake() {
    let beam = |name: &str, points: &str| {
        format!(
            "beam.{name} = {{ {points}, mass_per_length = 1, axial_stiffness = 9970, bending_stiffness = 2.825, basis.ancf.elements = 3 }}\n"
        )
    };
    let [a, b, c] = [
        beam("a", "start = [0, 0], end = [0.4421, 0]"),
        beam(
            "b",
            "points = [[0.4421, 0], [0.505965, 0.199411], [0.656917, 0.385766], [0.489575, 0.619836], [0.719585, 0.794341]]",
        ),
        beam(
            "c",
            "points = [[0.719585, 0.794341], [0.756531, 0.662316], [0.910235, 0.651072], [0.959281, 0.531563], [1.1106, 0.517855]]",
        ),
    ];
    let text = format!(
        "{a}{b}{c}joint = [{{ type = 'weld', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}, \
         {{ type = 'weld', first = {{ beam = 'b', at = 'end' }}, second = {{ beam = 'c', at = 'start' }} }}]
         support = [{{ beam = 'c', at = 'end', fix = ['x', 'y'], move = {{ x = -0.04784, y = 0.06393, in_time.ramp = {{ start = 0.007510968, \
         duration = 0.024741693 }} }} }}]
         output.section_forces = true
         analysis.dynamic = {{ duration = 0.05427, generalized_alpha.step = 0.0004307142857142857 }}"
    );
    let scene = parse("shakes.toml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let found = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
    let last = found.states().last.last().expect("a shape");
    let ends = [&last.bending_moment, &last.axial_force].map(|along| along.last().copied().expect("an end"));
    assert!(ends[0].abs() < 1e-3 && ends[1].abs() > 10.0, "M and N in the hinge: {ends:?}");
}
