//! A weld ties positions and directions, and nothing else.

use ancf::results::Trajectory;

fn solved(text: &str) -> Trajectory {
    let scene = ancf::scene::parse("weld.toml", text).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error:?}\n{text}")).into_states()
}

fn end(trajectory: &Trajectory, probe: usize) -> [f64; 2] {
    let sample = trajectory.probes[probe].samples.last().expect("a record");
    [sample.x, sample.y]
}

/// Beams from point to point, each welded to the one before it, the first clamped at its start, a
/// probe at the last one's end.
fn chain(points: &[[f64; 2]], beams: &[(&str, &str)], rest: &str) -> String {
    let mut text = String::new();
    for (i, ((section, basis), ends)) in beams.iter().zip(points.windows(2)).enumerate() {
        let ([a, b], [c, d]) = (ends[0], ends[1]);
        text += &format!(
            "beam.b{i} = {{ start = [{a:?}, {b:?}], end = [{c:?}, {d:?}], {section}, basis.{basis} }}\n"
        );
    }
    for i in 1..beams.len() {
        text += &format!(
            "[[joint]]\ntype = \"weld\"\nfirst = {{ beam = \"b{}\", at = \"end\" }}\nsecond = {{ beam = \"b{i}\", at = \"start\" }}\n",
            i - 1
        );
    }
    let last = beams.len() - 1;
    text + "[[support]]\nbeam = \"b0\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n"
        + &format!("[[probe]]\nname = \"tip\"\nbeam = \"b{last}\"\nat = \"end\"\n")
        + &rest.replace("LAST", &format!("b{last}"))
}

const BASES: [&str; 4] = ["ancf.elements = 1", "ancf.elements = 5", "rpim.nodes = 4", "rpim.nodes = 9"];

/// Two bars in series under a force along them, in any direction.
#[test]
fn bars_in_series_bear_the_same_force() {
    for (i, angle) in [0.0, 0.5, 1.7, 3.0, -2.2].into_iter().enumerate() {
        let (sine, cosine) = f64::sin_cos(angle);
        let at = |s: f64| [s * cosine, s * sine];
        let force = format!(
            "[[effect.force]]\nbeam = \"LAST\"\nat = \"end\"\nvalue = [{cosine:?}, {sine:?}]\n[analysis.static]\ntolerance = 1e-12\n"
        );
        let sections =
            [100.0, 1000.0, 10.0].map(|ea| format!("axial_stiffness = {ea}, bending_stiffness = 1.0"));
        let beams: Vec<(&str, &str)> =
            sections.iter().enumerate().map(|(k, section)| (&section[..], BASES[(i + k) % 4])).collect();
        let states = solved(&chain(&[at(0.0), at(1.0), at(2.0), at(3.0)], &beams, &force));
        let [x, y] = end(&states, 0);
        assert!((x.hypot(y) - 3.0 - 0.111).abs() < 1e-8, "{angle}: elongation {}", x.hypot(y) - 3.0);
        for (shape, ea) in states.last.iter().zip([100.0, 1000.0, 10.0]) {
            for strain in &shape.strain {
                assert!((ea * strain - 1.0).abs() < 1e-3, "{angle}: N = {} where EA is {ea}", ea * strain);
            }
        }
    }
}

/// A frame of three beams with different stiffnesses under a small force: the unit-load theorem, ∫
/// N n/EA + M m/EI ds.
#[test]
fn a_frame_of_different_stiffnesses_is_as_soft_as_linear_theory_says() {
    let points = [[0.0, 0.0], [0.3, 1.1], [1.2, 0.9], [1.5, 1.6]];
    let stiffness = [(300.0, 0.9), (40.0, 2.5), (900.0, 0.2)];
    let sections = stiffness.map(|(ea, ei)| format!("axial_stiffness = {ea}, bending_stiffness = {ei}"));
    let tip = points[3];
    let size = 1e-7;
    // Displacement of the tip along `unit` under the force `force`.
    let by_theorem = |force: [f64; 2], unit: [f64; 2]| -> f64 {
        let pieces = points.windows(2).zip(stiffness).map(|(ends, (ea, ei))| {
            let (d, length) = ([ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]], 0.0_f64);
            let length = length + f64::hypot(d[0], d[1]);
            let along = |f: [f64; 2]| (f[0] * d[0] + f[1] * d[1]) / length;
            let moment = |p: [f64; 2], f: [f64; 2]| (tip[0] - p[0]) * f[1] - (tip[1] - p[1]) * f[0];
            let [[m0, n0], [m1, n1]] = [ends[0], ends[1]].map(|p| [moment(p, force), moment(p, unit)]);
            along(force) * along(unit) * length / ea
                + (2.0 * m0 * n0 + m0 * n1 + m1 * n0 + 2.0 * m1 * n1) * length / (6.0 * ei)
        });
        pieces.sum()
    };
    for force in [[size, 0.0], [0.0, size]] {
        for bases in [[BASES[0], BASES[1], BASES[0]], [BASES[3], BASES[1], BASES[3]]] {
            let beams: Vec<(&str, &str)> =
                sections.iter().zip(bases).map(|(section, basis)| (&section[..], basis)).collect();
            let rest = format!(
                "[[effect.force]]\nbeam = \"LAST\"\nat = \"end\"\nvalue = {force:?}\n[analysis.static]\ntolerance = 1e-13\n"
            );
            let [x, y] = end(&solved(&chain(&points, &beams, &rest)), 0);
            for (found, unit) in [(x - tip[0], [1.0, 0.0]), (y - tip[1], [0.0, 1.0])] {
                let expected = by_theorem(force, unit);
                assert!(
                    (found - expected).abs() < 1e-4 * size,
                    "{bases:?}, {force:?}: {found:e}, not {expected:e}"
                );
            }
        }
    }
}

/// A frame in motion, whose welded beams stretch differently.
fn swinging(integrator: &str, duration: f64) -> Trajectory {
    let beams = [
        ("axial_stiffness = 2000.0, bending_stiffness = 2.0, mass_per_length = 1.0", "ancf.elements = 2"),
        ("axial_stiffness = 500.0, bending_stiffness = 1.0, mass_per_length = 0.5", "rpim.nodes = 4"),
        ("axial_stiffness = 1000.0, bending_stiffness = 0.5, mass_per_length = 1.0", "ancf.elements = 2"),
    ];
    let rest = format!(
        "[effect.gravity]\nacceleration = [1.0, -3.0]\n[analysis.dynamic]\nduration = {duration}\noutput_every = {}\n[analysis.dynamic.{integrator}",
        duration / 4.0
    );
    solved(&chain(&[[0.0, 0.0], [0.7, 0.0], [0.7, 0.8], [0.1, 1.2]], &beams, &rest))
}

/// The angle from one beam to the next at each weld stays; every method keeps its order.
#[test]
fn every_method_keeps_its_order_where_beams_are_welded() {
    let duration = 0.08;
    let reference = swinging("gauss]\nstages = 3\nstep = 2.5e-4", duration);
    let deviation = |trajectory: &Trajectory| {
        let ([x, y], [a, b]) = (end(trajectory, 0), end(&reference, 0));
        (x - a).hypot(y - b)
    };
    for (method, order, step) in [
        ("generalized_alpha]\nspectral_radius = 1.0\nnewton_tolerance = 1e-12", 2.0, 1e-3),
        ("generalized_alpha]\nspectral_radius = 0.6\nnewton_tolerance = 1e-12", 2.0, 1e-3),
        ("gauss]\nstages = 1", 2.0, 1e-3),
        ("gauss]\nstages = 2", 4.0, 2e-3),
        ("gauss]\nstages = 3", 6.0, 2e-3),
        ("radau]\nstages = 2", 3.0, 1e-3),
        ("radau]\nstages = 3", 5.0, 2e-3),
    ] {
        let [coarse, fine] = [step, 0.5 * step]
            .map(|step| deviation(&swinging(&format!("{method}\nstep = {step:e}"), duration)));
        let found = (coarse / fine).log2();
        assert!(found > order - 0.6, "{method}: order {found:.2} from {coarse:.2e} and {fine:.2e}");
    }
}

/// Gauss' methods neither gain nor lose energy at a weld over many swings.
#[test]
fn gauss_conserves_the_energy_of_welded_beams() {
    for (step, bound) in [(4e-3, 1e-7), (2e-3, 1e-9)] {
        let trajectory = swinging(&format!("gauss]\nstages = 3\nstep = {step:e}"), 1.0);
        let first = trajectory.energy[0].total();
        let kinetic = trajectory.energy.iter().fold(0.0_f64, |m, e| m.max(e.kinetic));
        let drift = trajectory.energy.iter().fold(0.0_f64, |m, e| m.max((e.total() - first).abs())) / kinetic;
        assert!(drift < bound, "steps of {step} s: {drift:.2e} of the kinetic energy");
    }
}
