//! Section forces and reactions balance what acts on the beam, whatever its stiffness, its
//! discretisation and its motion.

use ancf::results::{Shape, Trajectory};
use ancf::scene::parse;

const BASES: [&str; 2] = ["ancf.elements = 16", "rpim.nodes = 10"];
const METHODS: [&str; 4] = [
    "radau.tolerance = 1e-4",
    "gauss.step = 0.004",
    "generalized_alpha = { step = 0.002, spectral_radius = 0.5 }",
    "radau = { stages = 2, step = 0.002 }",
];

fn solved(text: &str) -> Trajectory {
    let scene = parse("forces.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

/// A beam of length `l` from `start` in the direction `angle`, with stiffnesses.
fn beam(name: &str, [x, y]: [f64; 2], l: f64, angle: f64, ea: f64, ei: f64, basis: &str) -> String {
    let (sine, cosine) = angle.sin_cos();
    format!(
        "[beam.{name}]\nstart = [{x:e}, {y:e}]\nend = [{:e}, {:e}]\naxial_stiffness = {ea:e}\nbending_stiffness = {ei:e}\n\
         mass_per_length = 1.0\nbasis.{basis}\n",
        x + l * cosine,
        y + l * sine
    )
}

fn support(beam: &str, at: &str, fix: &str) -> String {
    format!("[[support]]\nbeam = '{beam}'\nat = {at}\nfix = {fix}\n")
}

const CLAMP: &str = "['x', 'y', 'angle']";

/// N, Q and M of a row, from the force [fx, fy] on the positive side and the moment.
fn differs(shape: &Shape, i: usize, [fx, fy]: [f64; 2], moment: f64) -> [f64; 3] {
    let (sine, cosine) = shape.angle[i].sin_cos();
    [
        (shape.axial_force[i] - fx * cosine - fy * sine).abs(),
        (shape.shear_force[i] - fy * cosine + fx * sine).abs(),
        (shape.bending_moment[i] - moment).abs(),
    ]
}

/// A cantilever that a dead force P bends to an elastica carries P in every section, and the moment
/// of P about it: for EA L²/EI from 1e2 to 1e10, in all directions, from micrometres to kilometres.
#[test]
fn a_cantilever_carries_its_load_in_every_section() {
    for basis in BASES {
        for (slenderness, turn, length) in
            [(1e2, 0.0, 1.0), (1e4, 2.0, 1e-6), (1e6, -0.7, 1.0), (1e8, 1.57, 1e3), (1e10, 3.0, 1.0)]
        {
            let ei = 7.0 * length * length;
            let ea = slenderness * 7.0;
            let load = 10.0 * 7.0_f64;
            let f = [-load * f64::sin(turn), load * f64::cos(turn)];
            let text = beam("arm", [0.3 * length, 0.0], length, turn, ea, ei, basis)
                + &support("arm", "'start'", CLAMP)
                + &format!(
                    "[[effect.force]]\nbeam = 'arm'\nat = 'end'\nvalue = [{:e}, {:e}]\n[analysis.static]\n",
                    f[0], f[1]
                );
            let shape = &solved(&text).last[0];
            let (x, y) = (shape.x[200], shape.y[200]);
            for i in 0..shape.s.len() {
                let moment = (x - shape.x[i]) * f[1] - (y - shape.y[i]) * f[0];
                let [n, q, m] = differs(shape, i, f, moment);
                assert!(
                    n.max(q) < 1e-3 * load && m < 1e-3 * load * length,
                    "{basis}, EA L²/EI = {slenderness:e}, s = {}: {n:e} N, {q:e} N, {m:e} N m",
                    shape.s[i]
                );
            }
        }
    }
}

/// At forces, moments and supports between the ends there are two rows, which differ by what acts
/// there.
#[test]
fn section_forces_jump_by_what_acts_in_a_point() {
    for basis in BASES {
        let text = beam("bar", [0.0; 2], 1.0, 0.0, 1e7, 1.0, basis)
            + &support("bar", "'start'", "['x', 'y']")
            + &support("bar", "0.61", "['y']")
            + "[[effect.force]]\nbeam = 'bar'\nat = 0.25\nvalue = [3.0, -4.0]\n\
               [[effect.moment]]\nbeam = 'bar'\nat = 0.8\nvalue = 0.5\n\
               [[effect.distributed_force]]\nbeam = 'bar'\nvalue = [0.0, -2.0]\n\
               [output]\nreactions = true\n[analysis.static]\n";
        let trajectory = solved(&text);
        let shape = &trajectory.last[0];
        let reaction = trajectory.reactions[1].samples.last().expect("a record");
        let jump = |at: f64| {
            let i = shape.s.iter().position(|s| (s - at).abs() < 1e-9).expect("a row");
            assert!((shape.s[i + 1] - at).abs() < 1e-9, "{basis}: two rows at {at}");
            let (sine, cosine) = shape.angle[i].sin_cos();
            let n = shape.axial_force[i] - shape.axial_force[i + 1];
            let q = shape.shear_force[i] - shape.shear_force[i + 1];
            [
                n * cosine - q * sine,
                n * sine + q * cosine,
                shape.bending_moment[i] - shape.bending_moment[i + 1],
            ]
        };
        for (at, expected) in
            [(0.25, [3.0, -4.0, 0.0]), (0.61, [0.0, reaction.fy, 0.0]), (0.8, [0.0, 0.0, 0.5])]
        {
            for (found, expected) in jump(at).into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-6, "{basis}, s = {at}: {found} and not {expected}");
            }
        }
        assert_eq!(shape.s.len(), 201 + 3, "all three were rows already");
        // Free at its end, and hinged at its start.
        let last = shape.s.len() - 1;
        for value in [
            shape.axial_force[last],
            shape.shear_force[last],
            shape.bending_moment[last],
            shape.bending_moment[0],
        ] {
            assert!(value.abs() < 1e-6, "{basis}: {value} at an end");
        }
        // M' = −Q |r'| between the rows.
        for i in
            (1..last).filter(|&i| shape.s[i + 1] - shape.s[i - 1] > 0.0099 && shape.s[i + 1] > shape.s[i])
        {
            let slope = (shape.bending_moment[i + 1] - shape.bending_moment[i - 1])
                / (shape.s[i + 1] - shape.s[i - 1]);
            let inner = [0.25, 0.61, 0.8].iter().all(|at: &f64| (shape.s[i] - at).abs() > 0.011);
            assert!(!inner || (slope + shape.shear_force[i]).abs() < 1e-3, "{basis}, s = {}", shape.s[i]);
        }
    }
}

/// A cantilever that a pull along it and a load across it press on the ground: behind the contact,
/// at the free end, nothing is left of the forces, and at the clamp they are the reactions'. With
/// friction the ground pulls back.
#[test]
fn section_forces_balance_contacts_and_friction() {
    for (friction, analysis) in [
        ("", "[analysis.static]\n"),
        (", friction = { coefficient = 0.4 }", "[analysis.static]\n"),
        (
            ", friction = { coefficient = 0.4 }",
            "[analysis.dynamic]\nduration = 0.4\nradau.tolerance = 1e-5\n",
        ),
    ] {
        for basis in BASES {
            let text = beam("arm", [0.0; 2], 1.0, 0.0, 1e4, 1.0, basis)
                + &support("arm", "'start'", CLAMP)
                + "[[effect.force]]\nbeam = 'arm'\nat = 0.9\nvalue = [0.4, -3.0]\n"
                + &format!(
                    "[[effect.contact]]\nbeam = 'arm'\nhalf_plane = {{ point = [0.0, -0.1], normal = [0.0, 1.0] }}\nstiffness = 1e4{}\n",
                    friction.replace(", ", "\n")
                )
                + "[output]\nreactions = true\n"
                + analysis;
            let trajectory = solved(&text);
            let shape = &trajectory.last[0];
            let reaction = trajectory.reactions[0].samples.last().expect("a record");
            let last = shape.s.len() - 1;
            let free = [shape.axial_force[last], shape.shear_force[last], shape.bending_moment[last]];
            assert!(
                free.iter().all(|value| value.abs() < 1e-4),
                "{basis}, {analysis}: {free:?} at a free end"
            );
            let clamp = differs(shape, 0, [-reaction.fx, -reaction.fy], -reaction.moment);
            assert!(clamp.iter().all(|value| *value < 1e-4), "{basis}, {analysis}: {clamp:?} at the clamp");
            assert!(reaction.fy < 2.5, "{basis}, {analysis}: the ground bears some of it, {reaction:?}");
        }
    }
}

/// A frame of two beams, welded and clamped at both feet: what one passes on the other takes.
#[test]
fn section_forces_pass_through_a_weld() {
    for ea in [1e4, 1e8] {
        let half = std::f64::consts::FRAC_PI_2;
        let text = beam("post", [0.0; 2], 1.0, half, ea, 1.0, BASES[0])
            + &beam("bar", [0.0, 1.0], 1.0, -0.4, ea, 1.0, BASES[1])
            + "[[joint]]\ntype = 'weld'\nfirst = { beam = 'post', at = 'end' }\nsecond = { beam = 'bar', at = 'start' }\n"
            + &support("post", "'start'", CLAMP)
            + &support("bar", "'end'", "['x', 'y']")
            + "[[effect.force]]\nbeam = 'bar'\nat = 0.5\nvalue = [1.0, -6.0]\n[output]\nreactions = true\n[analysis.static]\n";
        let trajectory = solved(&text);
        let [post, bar] = [&trajectory.last[0], &trajectory.last[1]];
        let top = post.s.len() - 1;
        let joint = trajectory.reactions[2].samples.last().expect("a record");
        let hinge = trajectory.reactions[1].samples.last().expect("a record");
        // The joint's force on the bar is what the post's last section gives to what is beyond it,
        // turned about.
        for (shape, i) in [(post, top), (bar, 0)] {
            let found = differs(shape, i, [-joint.fx, -joint.fy], -joint.moment);
            assert!(found.iter().all(|d| *d < 1e-6), "EA = {ea:e}: {found:?}");
        }
        let end = bar.s.len() - 1;
        let found = differs(bar, end, [hinge.fx, hinge.fy], 0.0);
        assert!(found.iter().all(|d| *d < 1e-6), "EA = {ea:e}: {found:?}");
        // Stiffness times curvature says the same of the moment, but for the accuracy of second
        // derivatives.
        for shape in [post, bar] {
            let largest = shape.bending_moment.iter().fold(0.0_f64, |m, b| m.max(b.abs()));
            for (m, kappa) in shape.bending_moment.iter().zip(&shape.curvature) {
                assert!((m - kappa).abs() < 0.06 * largest, "EA = {ea:e}: {m} and {kappa}");
            }
        }
    }
}

/// A rod that turns steadily about its end carries N = ½ ρA ω² (L² − s²), and its hinge pulls as
/// much.
#[test]
fn a_rotating_rod_carries_its_centrifugal_force() {
    let (omega, length) = (4.0, 0.8_f64);
    for basis in BASES {
        let steady = "radau.step = 0.01";
        for (method, turn, ea) in
            [(steady, 0.0, 1e6), (METHODS[2], 2.0, 1e6), (METHODS[3], 0.5, 1e8), (steady, 3.0, 1e6)]
        {
            let text = beam("rod", [0.0; 2], length, turn, ea, 1e3, basis)
                + &support("rod", "'start'", "['x', 'y']")
                + &format!(
                    "[[initial_velocity]]\nbeam = 'rod'\nrotation = {omega:e}\n[output]\nreactions = true\n\
                     [analysis.dynamic]\nduration = 0.7\noutput_every = 0.07\n{}\n",
                    method
                );
            let trajectory = solved(&text);
            let shape = &trajectory.last[0];
            let most = 0.5 * omega * omega * length * length;
            for (i, s) in shape.s.iter().enumerate() {
                let n = 0.5 * omega * omega * (length * length - s * s);
                let off = [shape.axial_force[i] - n, shape.shear_force[i], shape.bending_moment[i] / length];
                assert!(
                    off.iter().all(|d| d.abs() < 0.02 * most),
                    "{basis}, {}, EA = {ea:e}, s = {s}: {off:?} of {most}",
                    method
                );
            }
            // It starts without strain, and so without force, and would ring for ever: methods with
            // steps too long for that damp it.
            for (sample, time) in trajectory.reactions[0].samples.iter().zip(&trajectory.parameter).skip(2) {
                let angle = turn + omega * time;
                let off = (sample.fx + most * angle.cos()).hypot(sample.fy + most * angle.sin());
                assert!(off < 0.02 * most, "{basis}, {}, t = {time}: {off} of {most}", method);
            }
        }
    }
}

/// A crank that is spun up: its hub takes the moment that its inertia asks for, puts in what
/// becomes kinetic energy, and no stiff vibration of a small error.
#[test]
fn a_hub_takes_the_moment_of_inertia_and_puts_in_the_kinetic_energy() {
    let (duration, length) = (0.5, 0.25_f64);
    let omega = 2.0 * std::f64::consts::TAU;
    for method in METHODS {
        let text = beam("crank", [0.0; 2], length, 0.0, 1e6, 1e4, "ancf.elements = 2")
            + &support("crank", "'start'", CLAMP)
            + &format!(
                "move = {{ spin_up = {{ speed = '{omega} rad/s', duration = '{duration} s' }} }}\n\
                 [output]\nreactions = true\n[analysis.dynamic]\nduration = 1.0\noutput_every = 0.01\n{method}\n"
            );
        let trajectory = solved(&text);
        let inertia = length.powi(3) / 3.0;
        let largest = 2.0 * inertia * omega / duration;
        for (sample, time) in trajectory.reactions[0].samples.iter().zip(&trajectory.parameter) {
            let part = time / duration;
            let rate = if part < 1.0 { 1.0 - (std::f64::consts::TAU * part).cos() } else { 0.0 };
            let off = sample.moment - 0.5 * largest * rate;
            assert!(off.abs() < 0.02 * largest, "{method}, t = {time}: {off} of {largest} N m");
        }
        let kinetic = 0.5 * inertia * omega * omega;
        let first = trajectory.energy[0].total();
        for (energy, time) in trajectory.energy.iter().zip(&trajectory.parameter) {
            let drift = (energy.total() - first).abs() / kinetic;
            assert!(drift < 1e-3, "{method}, t = {time}: drift {drift:e}");
        }
        let work = trajectory.energy.last().expect("a record").work;
        assert!((work - kinetic).abs() < 1e-3 * kinetic, "{method}: {work} J of {kinetic} J");
    }
}

/// The last state of a motion is that before a law's kink at the very end: where damping makes the
/// forces jump there, sections, reactions and probes show the same side.
#[test]
fn a_law_that_ends_with_the_motion_is_seen_from_before_by_all() {
    for method in METHODS {
        let text = beam("arm", [0.0, 0.0], 1.0, 0.7, 50.0, 1.0, "ancf.elements = 4")
            + &format!(
                "[[support]]
                beam = 'arm'
                at = 'end'
                fix = ['x']
                move = {{ x = 0.05, in_time = {{ table = {{ times = [0.0, 0.2], values = [0.0, 1.0] }} }} }}
                [effect]
                damping = [{{ beam = 'arm', strain = 1e-3 }}]
                [[probe]]
                name = 'tip'
                beam = 'arm'
                at = 'end'
                [analysis.dynamic]
                duration = 0.2
                output_every = 0.02
                {method}
                [output]
                reactions = true
                section_forces = true
"
            );
        let t = solved(&text);
        let reaction = t.reactions[0].samples.last().expect("a record");
        let shape = t.last.last().expect("a shape");
        let largest = reaction.fx.hypot(reaction.fy);
        assert!(largest > 0.1, "{method}: {largest}");
        let off = differs(shape, shape.s.len() - 1, [reaction.fx, reaction.fy], reaction.moment);
        assert!(off.iter().all(|off| *off < 1e-5 * largest), "{method}: {off:?} of {largest}");
    }
}

/// A string of 2π/3 m without weight between supports √3 m apart, pulled down in its middle by 10 N: its halves are straight, and
/// carry F/(2 sin α) with cos α = (√3/2)/(π/3).
#[test]
fn a_string_is_pulled_along_itself_where_it_has_a_kink() {
    let text = "[beam.s]\narc = { center = [0, 0], radius = 1, from = '210 deg', to = '330 deg' }\nbasis.ancf.elements = 48\n\
                [[support]]\nbeam = 's'\nat = 'start'\nfix = ['x', 'y']\n[[support]]\nbeam = 's'\nat = 'end'\nfix = ['x', 'y']\n\
                [[effect.force]]\nbeam = 's'\nat = 1.0471975511965976\nvalue = [0, -10]\n\
                [analysis.static]\n";
    let found = solved(text);
    let cosine = 0.5 * 3.0_f64.sqrt() / std::f64::consts::FRAC_PI_3;
    let tension = 10.0 / (2.0 * (1.0 - cosine * cosine).sqrt());
    let shape = &found.last[0];
    let rows: Vec<f64> = (0..shape.s.len())
        .filter(|i| (shape.s[*i] - 1.0471975511965976).abs() < 1e-9)
        .map(|i| shape.axial_force[i])
        .collect();
    assert_eq!(rows.len(), 2, "before and behind");
    assert!(rows.iter().all(|n| (n / tension - 1.0).abs() < 1e-2), "{rows:?} for {tension}");
}

/// A couple of 1.5 N m at 0.7 m, and none behind it: the row before it is bent by it, and the one behind is straight.
#[test]
fn curvature_before_a_couple_is_that_of_its_moment() {
    for basis in ["ancf.elements = 40", "rpim.nodes = 41"] {
        let text = beam("arm", [0.0, 0.0], 1.0, 0.0, 1e4, 1.0, basis)
            + &support("arm", "'start'", CLAMP)
            + "[[effect.moment]]\nbeam = 'arm'\nat = 0.7\nvalue = 1.5\n[analysis.static]\n";
        let shape = &solved(&text).last[0];
        let rows: Vec<usize> = (0..shape.s.len()).filter(|i| (shape.s[*i] - 0.7).abs() < 1e-9).collect();
        assert_eq!(rows.len(), 2, "before and behind");
        for (row, moment) in rows.into_iter().zip([1.5, 0.0]) {
            assert!((shape.bending_moment[row] - moment).abs() < 1e-9, "{basis}");
            assert!((shape.curvature[row] - moment).abs() < 1e-2, "{basis}: {}", shape.curvature[row]);
        }
    }
}
