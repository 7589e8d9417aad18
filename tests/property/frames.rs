//! Motion does not know the axes, the handedness of the plane, nor the units: every support, joint
//! and effect, by every integrator.

use ancf::results::Trajectory;
use ancf::scene::parse;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;

/// From where a motion is looked at: the scene is mirrored at the x axis, turned, and written in
/// other units.
#[derive(Clone, Copy, Debug)]
struct Frame {
    turn: f64,
    mirror: bool,
    length: f64,
    mass: f64,
    time: f64,
}

const HERE: Frame = Frame { turn: 0.0, mirror: false, length: 1.0, mass: 1.0, time: 1.0 };

const FRAMES: [Frame; 8] = [
    Frame { turn: PI / 6.0, ..HERE },
    Frame { turn: PI / 180.0, mirror: true, ..HERE },
    Frame { turn: -2.3, length: 1e-6, mass: 1e-12, time: 1e-5, ..HERE },
    Frame { turn: PI, ..HERE },
    Frame { turn: 2.6, mirror: true, length: 1e3, mass: 1e7, time: 40.0 },
    Frame { mirror: true, ..HERE },
    Frame { turn: FRAC_PI_2, ..HERE },
    Frame { turn: -FRAC_PI_2, mirror: true, time: 60.0, ..HERE },
];

impl Frame {
    fn sign(&self) -> f64 {
        if self.mirror { -1.0 } else { 1.0 }
    }

    fn turned(&self, [x, y]: [f64; 2], unit: f64) -> [f64; 2] {
        let ((s, c), y) = (self.turn.sin_cos(), self.sign() * y);
        [unit * (c * x - s * y), unit * (s * x + c * y)]
    }

    fn back(&self, [x, y]: [f64; 2], unit: f64) -> [f64; 2] {
        let (s, c) = self.turn.sin_cos();
        [(c * x + s * y) / unit, self.sign() * (c * y - s * x) / unit]
    }

    fn velocity(&self) -> f64 {
        self.length / self.time
    }

    fn force(&self) -> f64 {
        self.mass * self.velocity() / self.time
    }

    fn moment(&self) -> f64 {
        self.force() * self.length
    }

    /// The axes of the frame exist in the other one only where it is turned by right angles: there
    /// a support's `x` may be its `y`.
    fn square(&self) -> Self {
        Self { turn: (self.turn / FRAC_PI_2).round() * FRAC_PI_2, ..*self }
    }

    fn axis(&self, axis: usize) -> &'static str {
        let swapped = (self.turn / FRAC_PI_2).round() as i64 % 2 != 0;
        ["x", "y"][if swapped { 1 - axis } else { axis }]
    }

    /// Fills the gaps of a scene: `{f:1,2}` is the vector (1, 2) in units of force, `{l 3}` the
    /// number 3 in units of length, `{m~ 3}` a moment, whose sign the mirror changes, `{axis 0}`
    /// the name of an axis.
    fn write(&self, template: &str) -> String {
        let mut text = String::new();
        let mut rest = template;
        while let Some((before, gap)) = rest.split_once("<<") {
            text.push_str(before);
            let (gap, after) = gap.split_once(">>").expect("a gap that ends");
            let (name, values) = gap.split_once(' ').expect("a unit and values");
            if name == "axis" {
                text.push_str(self.axis(values.parse().expect("0 or 1")));
            } else {
                let unit = self.unit(name.trim_end_matches('~'));
                let numbers: Vec<f64> =
                    values.split(',').map(|v| v.trim().parse().expect("a number")).collect();
                match numbers[..] {
                    [x, y] => write!(
                        text,
                        "[{:?}, {:?}]",
                        self.turned([x, y], unit)[0],
                        self.turned([x, y], unit)[1]
                    ),
                    [x] if name.ends_with('~') => write!(text, "{:?}", self.sign() * x * unit),
                    [x] => write!(text, "{:?}", x * unit),
                    _ => panic!("one number or two: {gap}"),
                }
                .expect("text");
            }
            rest = after;
        }
        text + rest
    }

    fn unit(&self, name: &str) -> f64 {
        let Self { length, mass, time, .. } = *self;
        match name {
            "1" => 1.0,
            "l" => length,
            "t" => time,
            "1/t" => 1.0 / time,
            "1/l" => 1.0 / length,
            "v" => self.velocity(),
            "g" => self.velocity() / time,
            "m" => mass,
            "m/l" => mass / length,
            "f" => self.force(),
            "f/l" => self.force() / length,
            "f/l2" => self.force() / length.powi(2),
            "fl" => self.moment(),
            "fl2" => self.moment() * length,
            "ml" => mass * length,
            "ml2" => mass * length * length,
            "fls" => self.moment() * time,
            "f/v" => self.force() / self.velocity(),
            "f/v2" => self.force() / self.velocity().powi(2) / length,
            "f/v/l" => self.force() / self.velocity() / length,
            _ => panic!("no unit {name}"),
        }
    }
}

/// A beam along x, EA = 1e4, EI = 1, ρA = 1.
fn beam(name: &str, from: [f64; 2], to: [f64; 2]) -> String {
    let ([a, b], [c, d]) = (from, to);
    format!(
        "[beam.{name}]\nstart = <<l {a},{b}>>\nend = <<l {c},{d}>>\naxial_stiffness = <<f 1e4>>\nbending_stiffness = <<fl2 1>>\n\
         mass_per_length = <<m/l 1>>\nstrain = \"engineering\"\nbasis.BASIS\n\
         [[probe]]\nname = \"{name}\"\nbeam = \"{name}\"\nat = \"end\"\n[[probe]]\nname = \"{name}-inside\"\nbeam = \"{name}\"\nat = <<l 0.3>>\n"
    )
}

fn support(at: &str, fix: &str) -> String {
    format!("[[support]]\nbeam = \"a\"\nat = {at}\nfix = {fix}\n")
}

const CLAMP: &str = r#"["x", "y", "angle"]"#;
const PIN: &str = r#"["x", "y"]"#;
const TIP: &str = "[[effect.force]]\nbeam = \"a\"\nat = \"end\"\nvalue = <<f 0.5,2>>\n";
const WEIGHT: &str = "[effect.gravity]\nacceleration = <<g 1,-3>>\n";

/// What is looked at from everywhere, and whether its supports know the axes.
fn scenes() -> Vec<(&'static str, bool, String)> {
    let a = beam("a", [0.0; 2], [1.0, 0.0]);
    let clamped = format!("{a}{}", support("\"start\"", CLAMP));
    let moved = |with: &str| format!("{a}{}{with}{WEIGHT}", support("\"start\"", CLAMP));
    let chain = |joint: &str| {
        let (b, pin) = (beam("b", [1.0, 0.0], [1.6, 0.5]), support("\"start\"", CLAMP));
        format!(
            "{a}{b}{pin}{WEIGHT}[[joint]]\ntype = \"{joint}\"\nfirst = {{ beam = \"a\", at = \"end\" }}\nsecond = {{ beam = \"b\", at = \"start\" }}\n"
        )
    };
    let slider =
        "[[joint]]\ntype = \"slider\"\nfirst = { beam = \"a\", at = \"start\" }\nalong = <<1 0.8,0.6>>\n";
    let law = "in_time.smooth_ramp.duration = <<t 0.1>>";
    vec![
        ("clamp", false, format!("{clamped}{TIP}")),
        ("clamp at the end", false, format!("{a}{}{WEIGHT}", support("\"end\"", CLAMP))),
        ("clamp in the span", false, format!("{a}{}{TIP}", support("<<l 0.5>>", CLAMP))),
        ("gradient", false, format!("{a}{}{TIP}", support("\"start\"", r#"["x", "y", "gradient"]"#))),
        ("angle alone", false, format!("{a}{}{WEIGHT}", support("\"start\"", r#"["angle"]"#))),
        (
            "pin and angle",
            false,
            format!("{a}{}{}{WEIGHT}", support("\"start\"", PIN), support("\"end\"", r#"["angle"]"#)),
        ),
        (
            "one axis",
            true,
            format!("{a}{}{}{WEIGHT}", support("\"start\"", PIN), support("\"end\"", r#"["<<axis 1>>"]"#)),
        ),
        (
            "an axis and the angle",
            true,
            format!("{a}{}{WEIGHT}", support("\"start\"", r#"["<<axis 0>>", "angle"]"#)),
        ),
        ("slider", false, format!("{a}{slider}{WEIGHT}")),
        ("slider with angle", false, format!("{a}{slider}{}{WEIGHT}", support("\"start\"", r#"["angle"]"#))),
        ("clamp between nodes", false, format!("{a}{}{TIP}", support("<<l 0.37>>", CLAMP))),
        (
            "gradient between nodes",
            false,
            format!("{a}{}{TIP}", support("<<l 0.37>>", r#"["x", "y", "gradient"]"#)),
        ),
        (
            "moving clamp",
            false,
            moved(&format!(
                "move = {{ x = <<movex l 0.1,-0.05>>, y = <<movey l 0.1,-0.05>>, angle = <<1~ 0.4>>, {law} }}\n"
            )),
        ),
        ("spin-up", false, moved("move.spin_up = { speed = <<1/t~ 6>>, duration = <<t 0.2>> }\n")),
        (
            "turning gradient",
            false,
            format!(
                "{a}{}move = {{ angle = <<1~ 0.4>>, {law} }}\n{WEIGHT}",
                support("\"start\"", r#"["x", "y", "gradient"]"#)
            ),
        ),
        ("hinge", false, chain("hinge")),
        ("weld", false, chain("weld")),
        ("inextensible", false, format!("{clamped}{WEIGHT}").replace("axial_stiffness = <<f 1e4>>\n", "")),
        (
            "spring and masses",
            false,
            format!(
                "{clamped}{TIP}[[effect.spring]]\nbeam = \"a\"\nat = \"end\"\nanchor = <<l 1,0.5>>\nstiffness = <<f/l 30>>\ndamping = <<f/v 0.3>>\n\
             [[effect.torsion_spring]]\nbeam = \"a\"\nat = <<l 0.5>>\nstiffness = <<fl 2>>\ndamping = <<fls 0.01>>\n\
             [[effect.point_mass]]\nbeam = \"a\"\nat = \"end\"\nmass = <<m 0.3>>\n[[effect.damping]]\nbeam = \"a\"\nstiffness_proportional = <<t 1e-4>>\n"
            ),
        ),
        (
            "fluid and foundation",
            false,
            format!(
                "{clamped}{WEIGHT}[[effect.drag]]\nbeam = \"a\"\nnormal = <<f/v2 2>>\nviscous_tangential = <<f/v/l 0.5>>\nflow = <<v 1,2>>\n\
             [[effect.buoyancy]]\nbeam = \"a\"\ndisplaced_mass_per_length = <<m/l 0.4>>\n"
            ),
        ),
        (
            "loads of all kinds",
            false,
            format!(
                "{clamped}[[effect.force]]\nbeam = \"a\"\nat = \"end\"\nvalue = <<f 0.3,1>>\nfollower = true\nin_time.harmonic.frequency = <<1/t 4>>\n\
             [[effect.moment]]\nbeam = \"a\"\nat = <<l 0.5>>\nvalue = <<fl~ 0.5>>\nin_time.step.start = <<t 0.033>>\n\
             [[effect.distributed_force]]\nbeam = \"a\"\nvalue = <<f/l 0,1>>\nin_time.ramp.duration = <<t 0.05>>\n\
             [[effect.moving_force]]\nbeam = \"a\"\nvalue = <<f 0,-2>>\nspeed = <<v 8>>\n[[effect.actuation]]\nbeam = \"a\"\ncurvature = <<1/l~ 0.5>>\n"
            ),
        ),
        (
            "contact",
            false,
            format!(
                "{clamped}{WEIGHT}[[effect.contact]]\nbeam = \"a\"\nstiffness = <<f/l2 1e4>>\ncircle = {{ center = <<l 0.7,-0.14>>, radius = <<l 0.1>> }}\n"
            ),
        ),
    ]
}

/// Every integrator; fixed steps of 2 ms, or a tolerance.
const INTEGRATORS: [&str; 8] = [
    "gauss = { stages = 3, step = <<t 2e-3>> }",
    "radau = { stages = 3, step = <<t 2e-3>> }",
    "gauss = { stages = 2, step = <<t 2e-3>> }",
    "generalized_alpha = { step = <<t 2e-3>>, spectral_radius = 0.8 }",
    "radau = { stages = 3, tolerance = 1e-5 }",
    "gauss = { stages = 3, tolerance = 1e-5 }",
    "radau = { stages = 2, tolerance = 1e-4 }",
    "generalized_alpha = { tolerance = 1e-4, spectral_radius = 0.8 }",
];

fn moved(frame: &Frame, scene: &str, basis: &str, integrator: &str) -> Trajectory {
    let tail = format!("[analysis.dynamic]\nduration = <<t 0.2>>\noutput_every = <<t 0.05>>\n{integrator}\n");
    let mut template = format!("{scene}{tail}").replace("basis.BASIS", basis);
    // A support moves along both axes of the frame.
    for (axis, name) in ["<<movex l ", "<<movey l "].into_iter().enumerate() {
        while let Some((before, gap)) = template.clone().split_once(name) {
            let (values, after) = gap.split_once(">>").expect("a gap that ends");
            let numbers: Vec<f64> = values.split(',').map(|v| v.parse().expect("a number")).collect();
            template =
                format!("{before}{:?}{after}", frame.turned([numbers[0], numbers[1]], frame.length)[axis]);
        }
    }
    let text = frame.write(&template);
    let scene = parse("frame.toml", &text).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    let found = scene.model().solve(scene.analysis());
    found.unwrap_or_else(|error| panic!("{frame:?}: {error}\n{text}")).into_states()
}

/// Positions and velocities of all probes at all times, as they are seen from here.
fn seen(frame: &Frame, trajectory: &Trajectory) -> Vec<f64> {
    let samples = trajectory.probes.iter().flat_map(|probe| &probe.samples);
    samples
        .flat_map(|s| {
            let velocity = [s.vx.expect("a motion"), s.vy.expect("a motion")];
            let (r, v) = (frame.back([s.x, s.y], frame.length), frame.back(velocity, frame.velocity()));
            [r[0], r[1], v[0], v[1]]
        })
        .collect()
}

/// Which motions suit a scene: without damping the axial force of a beam that keeps its length errs
/// ever more.
fn suits(name: &str, integrator: &str) -> bool {
    name != "inextensible" || !integrator.starts_with("gauss")
}

#[test]
fn motions_do_not_depend_on_axes_handedness_or_units() {
    for (number, (name, square, scene)) in scenes().iter().enumerate() {
        for (i, integrator) in
            INTEGRATORS.iter().enumerate().filter(|(_, integrator)| suits(name, integrator))
        {
            let basis =
                if (number + i) % 3 == 0 { "basis.rpim.nodes = 6" } else { "basis.ancf.elements = 6" };
            // With a tolerance round-off decides here and there about an iteration or a step:
            // positions must agree to the tolerance.
            let tolerance =
                integrator.split("tolerance = ").nth(1).and_then(|rest| rest[..4].parse::<f64>().ok());
            let numbers = |frame: &Frame| {
                let seen = seen(frame, &moved(frame, scene, basis, integrator));
                let kept = seen.chunks(4).flat_map(|s| if tolerance.is_some() { &s[..2] } else { s });
                kept.copied().collect::<Vec<_>>()
            };
            let expected = numbers(&HERE);
            let fastest = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            // Generalised-α stops its iteration at 1e-11 a step, which velocities multiply by the
            // stiffest frequency.
            let allowed = tolerance.map_or(1e-7, |tolerance| 2.0 * tolerance);
            for frame in [FRAMES[0], FRAMES[1 + (number + i) % 7]] {
                let frame = if *square { frame.square() } else { frame };
                let found = numbers(&frame);
                assert_eq!(expected.len(), found.len());
                let apart = expected.iter().zip(&found).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                assert!(
                    apart <= allowed * fastest,
                    "{name}, {integrator}, {basis}: {apart:.2e} of {fastest} apart in {frame:?}"
                );
            }
        }
    }
}
