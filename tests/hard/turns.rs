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

/// A path ends at the height that is asked for first, in whatever part or multiple of the load of the truss its loads are given.
#[test]
fn the_unit_of_loads_does_not_change_where_a_path_to_a_place_ends() {
    let expected = 50.0 * load(-0.45);
    for unit in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let text = truss("until_probe = { probe = 'p', y = -0.45 }").replace("-50", &format!("{:?}", -unit));
        let found = outcome(&text).unwrap_or_else(|error| panic!("{error}, {unit} N"));
        let force = unit * found.parameter.last().expect("a state");
        assert!((force / expected - 1.0).abs() < 1e-7, "{force} N for {expected} N in parts of {unit} N");
    }
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

/// Upwards the truss only stiffens: the load −0.5 is reached at once, and not after the limit loads below.
#[test]
fn a_path_to_a_negative_load_begins_with_loads_turned_round() {
    let expected = zero(|y| load(y) + 0.5, [0.3, 1.0]);
    let found = solved(&truss("until_load = -0.5"));
    let tip = found.probes[0].samples.last().expect("a state");
    assert!((tip.y - expected).abs() < 1e-9, "y = {} for {expected}", tip.y);
    assert!(found.parameter.windows(2).all(|loads| loads[1] < loads[0]), "{:?}", found.parameter);
}

/// A bar from (0, 0) to a guide that lets its end (1, 0.3) move down, held by a spring k there: two limit points, at
/// w = 0.18 and 0.42 below the start, between which the load falls.
const GUIDED: [f64; 2] = [22.173_714_778_848_65, 34.173_714_778_848_65];

fn guided(k: f64, target: &str) -> String {
    format!(
        "beam.bar = {{ start = [0, 0], end = [1, 0.3], axial_stiffness = 1000, bending_stiffness = 100, basis.ancf.elements = 2 }}\n\
         support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'bar', at = 'end', fix = ['x'] }}]\n\
         effect.spring = [{{ beam = 'bar', at = 'end', stiffness = {k:?} }}]\n\
         effect.force = [{{ beam = 'bar', at = 'end', value = [0, -100] }}]\n\
         probe = [{{ name = 'p', beam = 'bar', at = 'end' }}]\nanalysis.static.arc_length = {{ {target} }}\n"
    )
}

/// The load factor in equilibrium with the end at the height y.
fn guided_load(k: f64, y: f64) -> f64 {
    let (long, now) = (1.0_f64.hypot(0.3), 1.0_f64.hypot(y));
    (-1000.0 * (now - long) / long * y / now + k * (0.3 - y)) / 100.0
}

/// A load far beyond what the structure carries makes steps long. Even one that would pass both limit points, at whose ends the
/// load grows, ends at the first of them.
#[test]
fn two_limit_points_within_a_step_are_not_passed() {
    for k in GUIDED {
        let height = |turn: usize| 0.3 - 1e-4 * turn as f64;
        let highest = (1..3000).find(|turn| guided_load(k, height(turn + 1)) < guided_load(k, height(*turn)));
        let highest = highest.expect("a limit point");
        let limit = guided_load(k, height(highest));
        for part in [0.9, 0.99, 0.999] {
            let until = part * limit;
            let expected = zero(|y| guided_load(k, y) - until, [height(highest), 0.3]);
            let found = solved(&guided(k, &format!("until_load = {until:?}")));
            let tip = found.probes[0].samples.last().expect("a state");
            assert!((tip.y - expected).abs() < 1e-8, "k = {k}, {part}: y = {} for {expected}", tip.y);
        }
        let found = solved(&guided(k, "until_probe = { probe = 'p', y = -0.35 }"));
        let turns = |sign: f64| {
            let loads = found.parameter.windows(3);
            let mut turns = loads
                .filter(|loads| sign * (loads[1] - loads[0]) > 0.0 && sign * (loads[1] - loads[2]) > 0.0);
            turns.next().unwrap_or_else(|| panic!("{:?} of {k}", found.parameter))[1]
        };
        let lowest =
            (highest + 1..6000).map(|turn| guided_load(k, height(turn))).fold(f64::INFINITY, f64::min);
        assert!((turns(1.0) / limit - 1.0).abs() < 1e-6, "{} for {limit}", turns(1.0));
        assert!((turns(-1.0) / lowest - 1.0).abs() < 1e-6, "{} for {lowest}", turns(-1.0));
    }
}

/// A bar that only slides, on a spring k = 1 and a slanted one of 300 from (−1, −0.3): nothing turns that would tell of a step.
fn sliding(force: f64, analysis: &str) -> String {
    format!(
        "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e6, basis.ancf.elements = 2 }}\n\
         support = [{{ beam = 'b', at = 'start', fix = ['x', 'angle'] }}]\n\
         probe = [{{ name = 'p', beam = 'b', at = 'start' }}]\n\
         effect.force = [{{ beam = 'b', at = 'start', value = [0, {force:?}] }}]\n\
         effect.spring = [{{ beam = 'b', at = 'start', stiffness = 1 }}, {{ beam = 'b', at = 'start', stiffness = 300, anchor = [-1, -0.3] }}]\n\
         analysis.static{analysis}\n"
    )
}

/// The force in equilibrium with the bar at the height y \[N\].
fn sliding_force(y: f64) -> f64 {
    let (now, long) = (1.0_f64.hypot(y + 0.3), 1.0_f64.hypot(0.3));
    y + 300.0 * (now - long) * (y + 0.3) / now
}

/// Load steps end at the limit load of 1.49 N, and paths go on behind it to the only height of a larger load.
#[test]
fn beams_that_only_slide_do_not_jump() {
    let lowest = (0..3000).map(|i| sliding_force(-1e-4 * f64::from(i))).fold(0.0, f64::min);
    let error = outcome(&sliding(-20.0, " = {}")).expect_err("beyond the limit load");
    assert!(error.contains(&format!("beyond load factor {:.6}", lowest / -20.0)), "{error}, {lowest} N");
    let expected = zero(|y| sliding_force(y) + 20.0, [-2.0, -0.7]);
    for step in ["", ", max_step = 0.2", ", max_step = 0.05"] {
        let found = solved(&sliding(-10.0, &format!(".arc_length = {{ until_load = 2{step} }}")));
        let end = found.probes[0].samples.last().expect("a state").y;
        assert!((end - expected).abs() < 1e-8, "{end} for {expected}{step}");
        let heights = found.probes[0].samples.windows(2);
        assert!(heights.into_iter().all(|pair| pair[1].y < pair[0].y), "it comes back{step}");
    }
}

/// Whether loads are given in small units or in large ones, a path finds the height that a load has first: below the limit load,
/// as close as it may be, before the snap, and above it behind.
#[test]
fn the_unit_of_loads_does_not_change_what_a_path_finds() {
    let heights = (0..3000).map(|i| -1e-4 * f64::from(i));
    let limit = heights.min_by(|a, b| sliding_force(*a).total_cmp(&sliding_force(*b))).expect("a limit");
    for part in [0.5, 0.999, 1.01, 10.0] {
        let force = part * sliding_force(limit);
        let between = if part < 1.0 { [limit, 0.0] } else { [-2.0, -0.3] };
        let expected = zero(|y| sliding_force(y) - force, between);
        for unit in [1e-5, 1e-2, 1.0, 1e2, 1e5] {
            let path = format!(".arc_length = {{ until_load = {:?} }}", -force / unit);
            let found =
                outcome(&sliding(-unit, &path)).unwrap_or_else(|error| panic!("{error}, {unit} {part}"));
            let end = found.probes[0].samples.last().expect("a state").y;
            assert!((end - expected).abs() < 1e-7, "{end} for {expected}, {part} of the limit in {unit} N");
        }
    }
}

/// A bar that snaps onto a stop, as a bar on two springs does: where it touches, the load that fell begins to grow, at nearly half
/// a turn of the path. Paths with any step go on from there, and limit point and kink are told with their loads.
#[test]
fn paths_go_on_where_a_snap_ends_at_a_stop() {
    let lowest = (0..3000).map(|i| sliding_force(-1e-4 * f64::from(i))).fold(0.0, f64::min);
    for (at, k) in [(-0.2, 1e3), (-0.38, 1e2), (-0.38, 1e5), (-0.3, 1e4)] {
        let stop = format!(
            "effect.contact = [{{ beam = 'b', half_plane = {{ point = [0, {at:?}], normal = [0, 1] }}, stiffness = {k:?} }}]\n"
        );
        let force = |y: f64| sliding_force(y) + if y < at { k * (y - at) } else { 0.0 };
        let expected = zero(|y| force(y) + 10.0, [at - 1.0, at]);
        for step in ["", ", max_step = 0.1", ", max_step = 0.03", ", max_step = 0.02"] {
            let path = sliding(-10.0, &format!(".arc_length = {{ until_load = 1{step} }}\n{stop}"));
            let found = outcome(&path).unwrap_or_else(|error| panic!("{error}, {at} {k}{step}"));
            let end = found.probes[0].samples.last().expect("a state").y;
            // The contact is along the bar, which its force of some 10 N bends by 10/(8 EI).
            assert!((end - expected).abs() < 2e-6, "{end} for {expected}, {at} {k}{step}");
            let told: Vec<f64> =
                found.run.warnings.iter().map(|text| number_after(text, "load factor ")).collect();
            // A long step may pass both together.
            if !told.is_empty() {
                let right = [lowest / -10.0, sliding_force(at) / -10.0];
                assert!(
                    told.len() == 2 && (0..2).all(|i| (told[i] - right[i]).abs() < 2e-6),
                    "{told:?} {right:?}, {at} {k}{step}"
                );
            }
        }
    }
}

/// The number in `text` behind the first `words`.
fn number_after(text: &str, words: &str) -> f64 {
    let rest = text.split_once(words).map_or("", |(_, rest)| rest);
    rest.split([':', ',', ';']).next().and_then(|number| number.parse().ok()).unwrap_or(f64::NAN)
}

/// A bar that slides on one slanted spring turns back at both limits of its load, ∓k (l₀ − l) y/(l F) with l³ = l₀ a²: after the
/// first one a step changes the load factor alone.
#[test]
fn limit_points_of_a_sliding_bar_are_exact() {
    let long = 1.0_f64.hypot(0.3);
    let now = long.powf(1.0 / 3.0);
    let limit = 100.0 * (long - now) / now * (now * now - 1.0).sqrt();
    for force in [0.3, 2.0, 5.0, 20.0, 100.0] {
        let found = solved(&format!(
            "beam.b = {{ start = [0, 0.3], end = [0.5, 0.3], axial_stiffness = 1e6, bending_stiffness = 1e3, basis.ancf.elements = 2 }}\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'angle'] }}]\n\
             effect.spring = [{{ beam = 'b', at = 'start', stiffness = 100, anchor = [-1, 0] }}]\n\
             effect.force = [{{ beam = 'b', at = 'start', value = [0, {:?}] }}]\n\
             analysis.static.arc_length.until_load = {:?}\n",
            -force,
            10.0 / force
        ));
        let told: Vec<f64> =
            found.run.warnings.iter().map(|text| number_after(text, "load factor ")).collect();
        let right = limit / force;
        assert!(told.len() == 2, "{force}: {:?}", found.run.warnings);
        let near = |found: f64, right: f64| (found - right).abs() < 1e-6 + 1e-6 * right.abs();
        assert!(near(told[0], right) && near(told[1], -right), "{force}: {told:?} for {right}");
    }
}

/// A shallow bar whose law stiffens under pressure snaps through within 0.3°, less than any step turns it: the middle of a step tells,
/// and the path ends where its target is reached first. With N of the law, the load is λ = −N y/(l F).
#[test]
fn a_snap_that_turns_next_to_nothing_is_not_passed() {
    let (height, force) = (0.005, 1.250_803_7e-8);
    let long = 1.0_f64.hypot(height);
    let law = |strain: f64| if strain > -7.5e-6 { 0.1 * strain } else { -7.5e-7 + strain + 7.5e-6 };
    let load = |y: f64| {
        let now = 1.0_f64.hypot(y);
        -law((now - long) / long) * y / now / force
    };
    let highest = (1..1000).map(|k| 1e-3 * f64::from(k) * height);
    let highest = highest.max_by(|a, b| load(*a).total_cmp(&load(*b))).expect("a limit point");
    for until in [0.3, 0.5, 0.9 * load(highest)] {
        let expected = zero(|y| load(y) - until, [highest, height]);
        let found = solved(&format!(
            "beam.b = {{ start = [0, 0], end = [1, {height:?}], bending_stiffness = 0.1, basis.ancf.elements = 4, \
             axial_law = {{ strain = [-1, -7.5e-6, 0, 1], force = [-0.99999325, -7.5e-7, 0, 1] }} }}\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'b', at = 'end', fix = ['x'] }}]\n\
             effect.force = [{{ beam = 'b', at = 'end', value = [0, {:?}] }}]\n\
             probe = [{{ name = 'p', beam = 'b', at = 'end' }}]\n\
             analysis.static.arc_length.until_load = {until:?}\n",
            -force
        ));
        let end = found.probes[0].samples.last().expect("a state").y;
        assert!((end - expected).abs() < 1e-3 * height, "{until}: {end} for {expected}");
    }
}

/// A cantilever whose end is pulled across, away from where its path is to end, until its mesh folds: the path does not walk back
/// through the states on its way there, but ends for lack of points.
#[test]
fn a_path_away_from_its_target_does_not_walk_back() {
    let text = "beam.b = { start = [0, 0], end = [1, 0], axial_stiffness = 1e5, bending_stiffness = 10, basis.ancf.elements = 16 }\n\
        support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'b', at = 'end', fix = ['y'], move = { y = 0.2 } }]\n\
        probe = [{ name = 'p', beam = 'b', at = 'end' }]\n\
        analysis.static.arc_length = { until_probe = { probe = 'p', y = -0.1 }, max_points = 300 }\n";
    let error = outcome(text).expect_err("the other way");
    assert!(error.contains("ends after `max_points = 300` at load factor"), "{error}");
}
