//! Paths whose load factor or coordinate turns back just behind a target.

use ancf::results::Trajectory;
use ancf::scene::parse;

fn outcome(text: &str) -> Result<Trajectory, String> {
    let scene = parse("truss.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let results = scene.model().solve(scene.analysis());
    results.map(|results| results.into_states()).map_err(|error| error.to_string())
}

fn solved(text: &str) -> Trajectory {
    outcome(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Von Mises' truss: two bars from (∓1, 0) to a hinge at (0, 0.3), EA = 1000, under a dead load P at the hinge.
fn truss(target: &str) -> String {
    let bar = "axial_stiffness = 1000, bending_stiffness = 1e4, basis.ancf.elements = 2";
    format!(
        "beam.l = {{ start = [-1, 0], end = [0, 0.3], {bar} }}\nbeam.r = {{ start = [0, 0.3], end = [1, 0], {bar} }}\n\
         support = [{{ beam = 'l', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'r', at = 'end', fix = ['x', 'y'] }}]\n\
         joint = [{{ type = 'hinge', first = {{ beam = 'l', at = 'end' }}, second = {{ beam = 'r', at = 'start' }} }}]\n\
         effect.force = [{{ beam = 'l', at = 'end', value = [0, -50] }}]\n\
         probe = [{{ name = 'p', beam = 'l', at = 'end' }}]\nanalysis.static.arc_length = {{ {target} }}\n"
    )
}

/// λ(y) = −2 EA (l − l₀)/l₀ · y/l / 50.
fn load(y: f64) -> f64 {
    let (long, now) = (1.0_f64.hypot(0.3), 1.0_f64.hypot(y));
    -2.0 * 1000.0 * (now - long) / long * y / now / 50.0
}

/// The height between `low` and `high` at which `f` changes its sign.
fn zero(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (f(middle) < 0.0) == (f(low) < 0.0) { low = middle } else { high = middle }
    }
    low
}

/// The height at the limit point: (1 + y²)^{3/2} = l₀.
fn at_limit() -> f64 {
    (1.0_f64.hypot(0.3).powf(2.0 / 3.0) - 1.0).sqrt()
}

/// However near to the limit load the target is, the path ends where it is reached first, and not where it is again after the
/// truss has snapped through.
#[test]
fn a_target_just_below_a_limit_load_ends_the_path_before_it() {
    let limit = load(at_limit());
    for part in [0.9, 0.99, 0.999, 0.9999, 0.99999] {
        let until = part * limit;
        let expected = zero(|y| load(y) - until, [at_limit(), 0.3]);
        let tip =
            *solved(&truss(&format!("until_load = {until:?}"))).probes[0].samples.last().expect("a state");
        assert!((tip.y - expected).abs() < 1e-9, "{part}: y = {} for {expected}", tip.y);
    }
}

/// Warnings name the limit loads themselves, and the other equilibrium without load is one to which a path may lead.
#[test]
fn limit_points_are_states_of_the_path() {
    let found = solved(&truss("until_load = 0"));
    let tip = found.probes[0].samples.last().expect("a state");
    assert!(tip.y.abs() < 1e-9, "the bars lie in a line: y = {}", tip.y);
    let limit = load(at_limit());
    let highest = found.parameter.iter().copied().fold(0.0, f64::max);
    assert!((highest / limit - 1.0).abs() < 1e-9, "{highest} for {limit}");
    let told = format!("at load factor {limit:.6}");
    assert!(found.run.warnings.iter().any(|warning| warning.contains(&told)), "{:?}", found.run.warnings);
}

/// A path that begins at its target goes on: this one does not come back, and says so.
#[test]
fn a_path_that_begins_at_its_target_leaves_it() {
    let error =
        outcome(&truss("until_probe = { probe = 'p', y = 0.3 }, max_points = 40")).expect_err("no return");
    assert!(error.contains("before y = 0.3 m of probe `p`"), "{error}");
    let found = solved(&truss("until_probe = { probe = 'p', y = -0.3 }"));
    let load = found.parameter.last().expect("a state");
    assert!(load.abs() < 1e-9, "{load} in the mirrored state");
}
