//! Couples between the ends of a beam: its curvature jumps there, and so may that of the
//! discretisation.
//!
//! Moments alone bend a beam into arcs, each of the curvature M/EI of the moments beyond it; with a
//! support or a spring that is still known in closed form.

/// A support, spring or moment at `s`, and what it does to the moment that the beam before it
/// bears.
struct Couple {
    s: f64,
    text: String,
    /// Whether it bears all of the moment, so that nothing is left before it.
    holds: bool,
    /// Moment \[N m\].
    moment: f64,
    /// Stiffness \[N m/rad\].
    spring: f64,
}

const EI: f64 = 1.7;

fn moment(s: f64, moment: f64) -> Couple {
    let text = format!("[[effect.moment]]\nbeam = \"arm\"\nat = {s}\nvalue = {moment}\n");
    Couple { s, text, holds: false, moment, spring: 0.0 }
}

fn spring(s: f64, spring: f64) -> Couple {
    let text = format!("[[effect.torsion_spring]]\nbeam = \"arm\"\nat = {s}\nstiffness = {spring}\n");
    Couple { s, text, holds: false, moment: 0.0, spring }
}

fn angle(s: f64) -> Couple {
    let text = format!("[[support]]\nbeam = \"arm\"\nat = {s}\nfix = [\"angle\"]\n");
    Couple { s, text, holds: true, moment: 0.0, spring: 0.0 }
}

/// The tip of a beam of length 1 that starts in the origin along x, by a chain of arcs. With one
/// spring at most.
fn tip(couples: &[Couple]) -> [f64; 2] {
    let holds = couples.iter().filter(|couple| couple.holds).map(|couple| couple.s).fold(0.0, f64::max);
    // The moment that each piece bears, without the springs, which a linear equation for the angle
    // at the spring then gives.
    let beyond =
        |s: f64| couples.iter().filter(|couple| couple.s > s).map(|couple| couple.moment).sum::<f64>();
    let mut ends: Vec<f64> = couples.iter().map(|couple| couple.s).chain([0.0, 1.0]).collect();
    ends.sort_by(f64::total_cmp);
    let pieces: Vec<(f64, f64)> = ends.windows(2).map(|pair| (pair[0], pair[1])).collect();
    let bent = |a: f64| if a < holds { 0.0 } else { beyond(a) / EI };
    let turn =
        |to: f64| pieces.iter().filter(|(_, b)| *b <= to).map(|(a, b)| bent(*a) * (b - a)).sum::<f64>();
    let spring = couples.iter().find(|couple| couple.spring > 0.0);
    // θ = turn − T (s − holds)/EI and T = k θ.
    let relief = spring.map_or((0.0, 0.0), |at| {
        let free = (at.s - holds).max(0.0);
        (at.s, at.spring * turn(at.s) / (1.0 + at.spring * free / EI))
    });
    let (mut x, mut y, mut angle) = (0.0, 0.0, 0.0_f64);
    for (a, b) in pieces {
        let kappa = if a < holds { 0.0 } else { bent(a) - if b <= relief.0 { relief.1 / EI } else { 0.0 } };
        let half = 0.5 * kappa * (b - a);
        let chord = (b - a) * if half == 0.0 { 1.0 } else { half.sin() / half };
        x += chord * (angle + half).cos();
        y += chord * (angle + half).sin();
        angle += 2.0 * half;
    }
    [x, y]
}

fn error(basis: &str, fix: &str, couples: &[Couple]) -> f64 {
    let text: String = couples.iter().map(|couple| &couple.text[..]).collect();
    let text = format!(
        r#"
        beam.arm = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = {EI}, basis.{basis} }}
        analysis.static = {{ tolerance = 1e-10 }}
        probe = [{{ name = "tip", beam = "arm", at = "end" }}]
        [[support]]
        beam = "arm"
        at = "start"
        fix = {fix}
        {text}
        "#
    );
    let scene = ancf::scene::parse("arm.toml", &text).expect("a legal scene");
    let states = scene.model().solve(scene.analysis()).expect("an equilibrium");
    let found = states.states().probes[0].samples.last().expect("a record");
    let [x, y] = tip(couples);
    (found.x - x).hypot(found.y - y)
}

const CLAMP: &str = r#"["x", "y", "angle"]"#;
const RPIM: &str = "rpim.nodes = 9";

#[test]
fn couples_anywhere_are_met_by_nine_nodes() {
    let cases = || {
        let mut cases = Vec::new();
        for s in [0.5, 0.07, 0.3, 0.6180339887, 0.8125, 0.97] {
            cases.push((CLAMP, vec![moment(s, 1.5)]));
            cases.push((CLAMP, vec![moment(s, 1.5), moment(1.0, -2.0)]));
            cases.push((CLAMP, vec![spring(s, 3.0), moment(1.0, 2.0)]));
            cases.push((r#"["x", "y"]"#, vec![angle(s), moment(1.0, 2.0)]));
        }
        cases.push((CLAMP, vec![moment(0.2, 2.0), moment(0.45, -3.0), moment(0.7, 2.5), moment(1.0, -2.0)]));
        cases.push((CLAMP, vec![moment(0.40, 2.0), moment(0.41, -2.0), moment(1.0, 1.0)]));
        cases.push((CLAMP, vec![angle(0.33), spring(0.66, 2.0), moment(0.8, 1.0), moment(1.0, -1.0)]));
        cases
    };
    for (basis, bound) in [
        (RPIM, 1e-5),
        ("rpim = { nodes = [0.0, 0.13, 0.25, 0.38, 0.5, 0.62, 0.75, 0.88, 1.0] }", 1e-5),
        ("rpim = { nodes = 9, spacing = \"chebyshev\" }", 1e-4),
        ("ancf.elements = 32", 1e-5),
    ] {
        for (fix, couples) in cases() {
            let error = error(basis, fix, &couples);
            let said: String = couples.iter().map(|couple| &couple.text[..]).collect();
            assert!(error < bound, "{basis}: {error:.2e} L\n{said}");
        }
    }
}
