//! What only its loads hold comes to rest under each of them: where it jumps from one equilibrium to another on the way, that is told.

use ancf::results::Trajectory;
use ancf::scene::parse;

/// A shallow arch on hinges.
const ARCH: &str = "beam.arch = { arc = { center = [0, -1], radius = 1.1, from = 1.9707963267948965, to = 1.1707963267948966 }, axial_stiffness = 1e4, \
    bending_stiffness = 1, basis.ancf.elements = 24 }\n\
    probe = [{ name = 'mid', beam = 'arch', at = 0.44 }]\n";
const HINGES: &str =
    "{ beam = 'arch', at = 'start', fix = ['x', 'y'] }, { beam = 'arch', at = 'end', fix = ['x', 'y'] }";

fn solve(text: &str) -> Trajectory {
    let scene = parse("jump.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

/// The two load factors between which a warning tells of a jump.
fn jump(trajectory: &Trajectory) -> Option<[f64; 2]> {
    trajectory.run.warnings.iter().find_map(|warning| {
        let loads = warning.strip_prefix("between load factors ")?.split(" the structure jumps").next()?;
        let (low, high) = loads.split_once(" and ")?;
        Some([low, high].map(|load| load.parse().expect("a load factor")))
    })
}

/// A string that has nothing to do with an arch changes nothing about its critical load, of which the arch alone tells.
#[test]
fn a_string_beside_an_arch_does_not_hide_that_it_snaps() {
    let alone =
        "effect.force = [{ beam = 'arch', at = 0.44, value = [0, -24] }]\nanalysis.static.steps = 20\n";
    let alone = solve(&format!("{ARCH}support = [{HINGES}]\n{alone}"));
    let [lost] = &alone.run.warnings[..] else { panic!("{:?}", alone.run.warnings) };
    let critical: f64 = lost
        .strip_prefix("the tangent loses definiteness at load factor ")
        .and_then(|rest| rest.split(':').next())
        .and_then(|load| load.parse().ok())
        .unwrap_or_else(|| panic!("{lost}"));
    let string =
        "beam.string = { start = [2, 0], end = [3, 0], axial_stiffness = 10, basis.ancf.elements = 4 }\n";
    let ends = "{ beam = 'string', at = 'start', fix = ['x', 'y'] }, { beam = 'string', at = 'end', fix = ['x', 'y'] }";
    for steps in ["", "steps = 8"] {
        let both = |force: f64| {
            solve(&format!(
                "{ARCH}{string}support = [{HINGES}, {ends}]\n\
                 effect.force = [{{ beam = 'arch', at = 0.44, value = [0, {force}] }}, {{ beam = 'string', at = 0.5, value = [0, -0.1] }}]\n\
                 analysis.static = {{ {steps} }}\n"
            ))
        };
        // Two thirds more than it bears, and three quarters of it.
        let [low, high] = jump(&both(-24.0 * critical / 0.6)).unwrap_or_else(|| panic!("{steps}"));
        assert!(low <= 0.6 + 1e-4 && high >= 0.6 - 1e-4 && high - low < 1e-3, "{low} to {high}");
        assert_eq!(jump(&both(-24.0 * critical * 0.75)), None, "{steps}");
    }
}

/// A string pulls an arch down: slowly it gives way a little, then it snaps. What a string holds without that changes smoothly, be it
/// much and fast, as when it first takes its load.
#[test]
fn a_string_that_pulls_an_arch_through_says_so() {
    let pulled = |by: f64, steps: &str| {
        solve(&format!(
            "{ARCH}beam.string = {{ start = [0, 0.1], end = [0, -0.4], axial_stiffness = 10, basis.ancf.elements = 2 }}\n\
             joint = [{{ type = 'hinge', first = {{ beam = 'arch', at = 0.44 }}, second = {{ beam = 'string', at = 'start' }} }}]\n\
             support = [{HINGES}, {{ beam = 'string', at = 'end', fix = ['x', 'y'], move.y = -{by} }}]\n\
             analysis.static = {{ {steps} }}\n"
        ))
    };
    for steps in ["", "steps = 5", "steps = 40"] {
        let [low, high] = jump(&pulled(1.5, steps)).unwrap_or_else(|| panic!("{steps}"));
        // With a bending stiffness of a thousandth in place of none the path loses its stability at 0.76535; a crest is left a little later.
        assert!(low < 0.772 && high > 0.764 && high - low < 1e-3, "{steps}: {low} to {high}");
        assert_eq!(jump(&pulled(1.0, steps)), None, "{steps}");
    }
}

/// What a string does that stretches far is much more than what the arch at its end does, which snaps all the same. With a bending stiffness of
/// a thousandth of the arch's in place of none the path loses its stability at 0.31835.
#[test]
fn an_arch_that_snaps_while_its_string_moves_far_is_told() {
    for steps in [1, 12] {
        let found = solve(&format!(
            "beam.arch = {{ arc = {{ center = [0, -1], radius = 1, from = 1.84725, to = 1.29434 }}, axial_stiffness = 68340, bending_stiffness = 1, basis.ancf.elements = 20 }}
            beam.string = {{ start = [-0.027639652774, -0.000382048183], end = [0, -0.5], axial_stiffness = 29.927, basis.ancf.elements = 2 }}
            joint = [{{ type = 'hinge', first = {{ beam = 'arch', at = 0.2488105 }}, second = {{ beam = 'string', at = 'start' }} }}]
            support = [{HINGES}, {{ beam = 'string', at = 'end', fix = ['x', 'y'], move.y = -1.6395 }}]
            analysis.static.steps = {steps}\n"
        ));
        let [low, high] = jump(&found).unwrap_or_else(|| panic!("{steps}"));
        assert!(low < 0.3188 && high > 0.3178 && high - low < 1e-3, "{steps}: {low} to {high}");
    }
}

/// The load factor at which a warning tells that the structure gives way to one of two sides.
fn fork(trajectory: &Trajectory) -> Option<f64> {
    trajectory.run.warnings.iter().find_map(|warning| {
        let (load, _) = warning
            .strip_prefix("at load factor ")?
            .split_once(" the structure gives way to one of two sides")?;
        Some(load.parse().expect("a load factor"))
    })
}

/// A column on hinges beside a string that has nothing to do with it: P = π² EI/L² of the length that is left of it under P, and with
/// 9 N it stands.
#[test]
fn a_column_beside_a_string_buckles() {
    let column = |force: f64, steps: usize| {
        solve(&format!(
            "beam.column = {{ start = [0, 0], end = [0, 1], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 16 }}
            beam.string = {{ start = [2, 0], end = [3, 0], axial_stiffness = 10, basis.ancf.elements = 4 }}
            support = [{{ beam = 'column', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'column', at = 'end', fix = ['x'] }},
                {{ beam = 'string', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'string', at = 'end', fix = ['x', 'y'], move.x = 0.1 }}]
            effect.force = [{{ beam = 'column', at = 'end', value = [0, -{force}] }}]
            analysis.static.steps = {steps}\n"
        ))
    };
    let critical = std::f64::consts::PI.powi(2) * (1.0 + std::f64::consts::PI.powi(2) / 1e4) / 12.0;
    for steps in [1, 10] {
        let told = fork(&column(12.0, steps)).unwrap_or_else(|| panic!("{steps}"));
        assert!((told / critical - 1.0).abs() < 1e-3, "{steps}: {told} {critical}");
        assert_eq!(column(9.0, steps).run.warnings, [""; 0], "{steps}");
    }
}

/// A mast on a hinge between stays of different lengths that are tightened. With stays of a ten-thousandth of its bending stiffness in place of none
/// the path loses its stability at 0.61498; beyond, a mast bent to either side has the same energy.
#[test]
fn a_mast_between_uneven_stays_gives_way_to_either_side() {
    let mast = |force: f64, steps: usize| {
        solve(&format!(
            "beam.mast = {{ start = [0, 0], end = [0, 1], axial_stiffness = 1302.998416160383, bending_stiffness = 1, basis.ancf.elements = 32 }}
            beam.left = {{ start = [0, 0.75], end = [-0.49414443346832443, -0.08948692143772209], axial_stiffness = 7582.160792539763, basis.ancf.elements = 2 }}
            beam.right = {{ start = [0, 0.75], end = [0.7415463125841857, 0.16795181868637857], axial_stiffness = 5806.714588187645, basis.ancf.elements = 2 }}
            joint = [{{ type = 'hinge', first = {{ beam = 'mast', at = 0.75 }}, second = {{ beam = 'left', at = 'start' }} }},
                {{ type = 'hinge', first = {{ beam = 'mast', at = 0.75 }}, second = {{ beam = 'right', at = 'start' }} }}]
            support = [{{ beam = 'mast', at = 'start', fix = ['x', 'y'] }},
                {{ beam = 'left', at = 'end', fix = ['x', 'y'], move = {{ x = 0.01447989266783096, y = -0.03569943861632446 }} }},
                {{ beam = 'right', at = 'end', fix = ['x', 'y'], move = {{ x = -0.006242145348346082, y = -0.012169706300390454 }} }}]
            effect.force = [{{ beam = 'mast', at = 0.4, value = [{force}, 0] }}]
            analysis.static.steps = {steps}\n"
        ))
    };
    for steps in [1, 20] {
        let told = fork(&mast(0.0, steps)).unwrap_or_else(|| panic!("{steps}"));
        assert!((told - 0.614_98).abs() < 2e-4, "{steps}: {told}");
        // Pushed to a side it goes there.
        assert_eq!(fork(&mast(0.1, steps)), None, "{steps}");
    }
}

/// An arch that snaps while all of its supports move does so where it would if they stood.
#[test]
fn supports_that_move_do_not_hide_that_an_arch_snaps() {
    let moved = |by: f64| {
        solve(&format!(
            "beam.arch = {{ arc = {{ center = [0, 0], radius = 1.1, from = 1.8707963267948966, to = 1.2707963267948965 }}, axial_stiffness = 2000, bending_stiffness = 1, basis.ancf.elements = 20 }}
            beam.string = {{ start = [-0.03299505022274519, 1.0995050371238864], end = [-0.03299505022274519, 0.09950503712388636], axial_stiffness = 30, basis.ancf.elements = 2 }}
            joint = [{{ type = 'hinge', first = {{ beam = 'arch', at = 0.297 }}, second = {{ beam = 'string', at = 'start' }} }}]
            support = [{{ beam = 'arch', at = 'start', fix = ['x', 'y'], move.x = {by} }}, {{ beam = 'arch', at = 'end', fix = ['x', 'y'], move.x = {by} }},
                {{ beam = 'string', at = 'end', fix = ['x', 'y'], move = {{ x = {by}, y = -0.5 }} }}]
            analysis.static.steps = 1\n"
        ))
    };
    for by in [0.0, 2.0] {
        let [low, high] = jump(&moved(by)).unwrap_or_else(|| panic!("{by}"));
        assert!(low < 0.7015 && high > 0.7013 && high - low < 1e-3, "{by}: {low} to {high}");
    }
}

/// A spring that is tilted pushes a block up, which a string pulls down and a guide keeps from turning: it snaps through without any change of a
/// gradient. With the spring's force 100 (1.04403 - l) and EA/L = 5 N/m of the string that is where dy/dλ is infinite.
#[test]
fn a_block_that_snaps_without_turning_is_told() {
    let found = solve(
        "beam.block = { start = [0, 0.3], end = [0.1, 0.3], axial_stiffness = 1e5, bending_stiffness = 100, basis.ancf.elements = 2 }
        beam.string = { start = [0.1, 0.3], end = [0.1, -0.7], axial_stiffness = 5, basis.ancf.elements = 2 }
        joint = [{ type = 'hinge', first = { beam = 'block', at = 'end' }, second = { beam = 'string', at = 'start' } }]
        support = [{ beam = 'block', at = 'start', fix = ['x', 'angle'] }, { beam = 'string', at = 'end', fix = ['x', 'y'], move.y = -2 }]
        effect.spring = [{ beam = 'block', at = 'start', anchor = [-1, 0], stiffness = 100, length = 1.04403 }]
        analysis.static = {}\n",
    );
    // The pull 5 (y - 0.3 + 2 λ) that holds the block at y, of which λ is largest where it snaps.
    let load = |y: f64| {
        let length = (1.0 + y * y).sqrt();
        0.5 * (100.0 * (1.04403 - length) * y / length / 5.0 + 0.3 - y)
    };
    let critical = (1..300).map(|i| load(f64::from(i) * 1e-3)).fold(0.0, f64::max);
    let [low, high] = jump(&found).expect("a snap");
    assert!(
        low < critical + 1e-3 && high > critical - 1e-3 && high - low < 1e-3,
        "{low} to {high}: {critical}"
    );
}

/// A mast is pushed aside between two stays. The lee one goes slack, which a string of a single cell cannot: it holds the mast, and says so.
#[test]
fn a_stay_whose_cells_cannot_fold_is_told() {
    let mast = |elements: usize| {
        solve(&format!(
            "beam.mast = {{ start = [0, 0], end = [0, 1], axial_stiffness = 1e5, bending_stiffness = 1, basis.ancf.elements = 16 }}
            beam.windward = {{ start = [0, 1], end = [-0.7, 0], axial_stiffness = 20, basis.ancf.elements = {elements} }}
            beam.leeward = {{ start = [0, 1], end = [0.7, 0], axial_stiffness = 20, basis.ancf.elements = {elements} }}
            joint = [{{ type = 'hinge', first = {{ beam = 'mast', at = 'end' }}, second = {{ beam = 'windward', at = 'start' }} }},
                {{ type = 'hinge', first = {{ beam = 'mast', at = 'end' }}, second = {{ beam = 'leeward', at = 'start' }} }}]
            support = [{{ beam = 'mast', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'windward', at = 'end', fix = ['x', 'y'] }},
                {{ beam = 'leeward', at = 'end', fix = ['x', 'y'] }}]
            probe = [{{ name = 'tip', beam = 'mast', at = 'end' }}]
            effect.force = [{{ beam = 'mast', at = 'end', value = [1, 0] }}]
            analysis.static = {{}}\n"
        ))
    };
    let pressed = |found: &Trajectory| {
        found.run.warnings.iter().any(|warning| warning.starts_with("string `leeward` is pressed by "))
    };
    assert!(pressed(&mast(1)));
    let folds = mast(4);
    let tip = folds.probes[0].samples.last().expect("a record").x;
    // A chain of bars and springs, without the lee stay, extrapolated.
    assert!(!pressed(&folds) && (tip - 0.129_553).abs() < 2e-6, "{tip}: {:?}", folds.run.warnings);
}

/// A cable with a weight at its end hangs in a current, whose drag on the straight cable is larger than what its bending stiffness resists. Its tension
/// holds it, and it has one equilibrium.
#[test]
fn a_cable_in_a_current_does_not_buckle() {
    let found = solve(
        "beam.cable = { start = [0, 0], end = [0, -100], axial_stiffness = 5e6, bending_stiffness = 50, mass_per_length = 3, basis.ancf.elements = 40 }
        support = [{ beam = 'cable', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -9.81]
        effect.buoyancy = [{ beam = 'cable', displaced_mass_per_length = 1.5 }]
        effect.drag = [{ beam = 'cable', normal = 24, tangential = 0.3, flow = [1.5, 0] }]
        effect.point_mass = [{ beam = 'cable', at = 'end', mass = 50 }]
        probe = [{ name = 'end', beam = 'cable', at = 'end' }]
        analysis.static = {}\n",
    );
    let end = found.probes[0].samples.last().expect("a record");
    // The boundary value problem of the elastica in a current, by collocation.
    assert!((end.x - 79.91350).hypot(end.y + 56.76615) < 2e-2, "{} {}", end.x, end.y);
    assert_eq!(found.run.warnings, [""; 0]);
}

/// A string that an actuation shortens pulls with what it resists, and stores no more than that.
#[test]
fn a_string_that_is_shortened_does_not_hold_itself() {
    let found = solve(
        "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 8 }
        beam.string = { start = [1, 0], end = [1, 1], axial_stiffness = 1000, basis.ancf.elements = 4 }
        joint = [{ type = 'hinge', first = { beam = 'arm', at = 'end' }, second = { beam = 'string', at = 'start' } }]
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'string', at = 'end', fix = ['x', 'y'] }]
        effect.actuation = [{ beam = 'string', strain = -0.05 }]
        analysis.static = {}\n",
    );
    assert_eq!(found.run.warnings, [""; 0]);
}

/// A mast that a slack stay and its weight hold leans and rises, and a hinged beam falls by a right angle under the first of its load.
#[test]
fn what_changes_fast_does_not_jump() {
    let mast = solve(
        "beam.mast = { start = [0, 0], end = [0, 1], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }
        beam.stay = { start = [0, 1], end = [-1, 0], axial_stiffness = 100, basis.ancf.elements = 4 }
        support = [{ beam = 'mast', at = 'start', fix = ['x', 'y'] }, { beam = 'stay', at = 'end', fix = ['x', 'y'] }]
        joint = [{ type = 'hinge', first = { beam = 'mast', at = 'end' }, second = { beam = 'stay', at = 'start' } }]
        effect.force = [{ beam = 'mast', at = 'end', value = [5, -1] }]
        analysis.static = {}\n",
    );
    assert_eq!(jump(&mast), None, "{:?}", mast.run.warnings);
    let beam = solve(
        "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 100, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 8 }
        support = [{ beam = 'rod', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0, -9.81]
        effect.force = [{ beam = 'rod', at = 'end', value = [20, 0] }]
        analysis.static.steps = 3\n",
    );
    assert_eq!(jump(&beam), None, "{:?}", beam.run.warnings);
}

/// Droppers between two wires are slack before loads have stretched the upper one, and fold from one element to the next: the wires do not jump.
#[test]
fn droppers_that_fold_are_no_jump() {
    let wires = |elements: usize| {
        solve(&format!(
            "beam.upper = {{ start = [0, 1], end = [12, 1], axial_stiffness = 2e5, bending_stiffness = 4, mass_per_length = 0.8, basis.ancf.elements = {elements} }}
            beam.lower = {{ start = [0, 0], end = [12, 0], axial_stiffness = 4e5, bending_stiffness = 60, mass_per_length = 1.2, basis.ancf.elements = {elements} }}
            beam.left = {{ start = [4, 1], end = [4, 0], axial_stiffness = 5e4, mass_per_length = 0.2, basis.ancf.elements = 4 }}
            beam.right = {{ start = [8, 1], end = [8, 0], axial_stiffness = 5e4, mass_per_length = 0.2, basis.ancf.elements = 4 }}
            joint = [
                {{ type = 'hinge', first = {{ beam = 'upper', at = 4 }}, second = {{ beam = 'left', at = 'start' }} }},
                {{ type = 'hinge', first = {{ beam = 'lower', at = 4 }}, second = {{ beam = 'left', at = 'end' }} }},
                {{ type = 'hinge', first = {{ beam = 'upper', at = 8 }}, second = {{ beam = 'right', at = 'start' }} }},
                {{ type = 'hinge', first = {{ beam = 'lower', at = 8 }}, second = {{ beam = 'right', at = 'end' }} }},
            ]
            support = [
                {{ beam = 'upper', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'upper', at = 'end', fix = ['x', 'y'], move.x = 0.06 }},
                {{ beam = 'lower', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'lower', at = 'end', fix = ['x', 'y'], move.x = 0.012 }},
            ]
            effect.gravity.acceleration = [0, -9.81]
            effect.force = [{{ beam = 'lower', at = 4, value = [0, 15] }}]
            analysis.static = {{}}\n"
        ))
    };
    for elements in [6, 24] {
        let found = wires(elements);
        assert_eq!(found.run.warnings, [""; 0], "{elements}");
    }
}

/// A string without weight that is slack rests anywhere: which of its places is told is chance.
#[test]
fn a_slack_string_without_weight_says_that_it_rests_anywhere() {
    let slack = solve(
        "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 2.2, basis.ancf.elements = 10 }
        beam.string = { start = [1, 0], end = [1, -0.5], axial_stiffness = 50, basis.ancf.elements = 3 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'string', at = 'end', fix = ['x', 'y'], move = { x = -0.0444732, y = -0.0016524 } }]
        joint = [{ type = 'hinge', first = { beam = 'arm', at = 'end' }, second = { beam = 'string', at = 'start' } }]
        effect.force = [{ beam = 'arm', at = 0.5, value = [0, -0.2] }]
        analysis.static.steps = 6\n",
    );
    let told = |warning: &String| {
        warning.contains("rests in another equilibrium") || warning.contains("structure jumps")
    };
    assert!(slack.run.warnings.iter().any(told), "{:?}", slack.run.warnings);
}
