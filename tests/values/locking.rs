//! What a run says of meshes that lock, and of strings that hold themselves: the numbers in the
//! warnings against Simpson's rule over the rows of the last shape.

use super::near;
use ancf::results::{Shape, Trajectory};
use ancf::scene::parse;

fn solved(text: &str) -> Trajectory {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

/// An `arm` with EI = 1 N m² that is clamped at its start, behind a `post` on which nothing acts.
fn arm(geometry: &str, basis: &str, more: &str) -> String {
    format!(
        "beam.post = {{ start = [3, 0], end = [3, 1], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 3 }}
         beam.arm = {{ {geometry}, bending_stiffness = 1, mass_per_length = 1, basis.{basis} }}
         support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}, \
         {{ beam = 'post', at = 'start', fix = ['x', 'y', 'angle'] }}]
         {more}\n"
    )
}

const LINE: &str = "start = [1, 0], end = [2.2, 1.6]";
const ARC: &str = "arc = { center = [0, 0], radius = 1, from = '0 deg', to = '120 deg' }";
/// So many points that the quadrature is exact to the digits that are written.
const POINTS: &str = "gauss_points = { stretch = 12, bend = 8 }";

fn loads(tip: [f64; 2], along: [f64; 2]) -> String {
    format!(
        "effect.force = [{{ beam = 'arm', at = 'end', value = {tip:?} }}]
         effect.distributed_force = [{{ beam = 'arm', value = {along:?} }}]"
    )
}

/// ½ ∫ EA (ε − ε_linear)² ds over the cells of a shape, by Simpson's rule over its rows.
fn locked(shape: &Shape, cells: usize, axial_stiffness: f64) -> f64 {
    let rows = (shape.s.len() - 1) / cells;
    assert!(rows.is_multiple_of(2) && rows * cells + 1 == shape.s.len(), "even rows in each cell");
    let mut energy = 0.0;
    for cell in 0..cells {
        let first = cell * rows;
        let h = (shape.s[first + rows] - shape.s[first]) / rows as f64;
        let weight = |i: usize| match i {
            0 => h / 3.0,
            i if i == rows => h / 3.0,
            i if i % 2 == 1 => 4.0 * h / 3.0,
            _ => 2.0 * h / 3.0,
        };
        let integral = |f: &dyn Fn(usize) -> f64| (0..=rows).map(|i| weight(i) * f(first + i)).sum::<f64>();
        let length = integral(&|_| 1.0);
        let middle = integral(&|i| shape.s[i]) / length;
        let mean = integral(&|i| shape.strain[i]) / length;
        let slope = integral(&|i| (shape.s[i] - middle) * (shape.strain[i] - mean))
            / integral(&|i| (shape.s[i] - middle).powi(2));
        let apart = |i: usize| shape.strain[i] - mean - slope * (shape.s[i] - middle);
        energy += 0.5 * axial_stiffness * integral(&|i| apart(i).powi(2));
    }
    energy
}

fn about_locking(found: &Trajectory) -> Vec<&str> {
    let locks = |text: &&str| text.starts_with("beam `arm` locks: stretch that bending alone causes");
    found.run.warnings.iter().map(String::as_str).filter(locks).collect()
}

/// The percentage in the only warning of a run about locking, and the warning.
fn told(found: &Trajectory) -> (f64, &str) {
    let [warning] = about_locking(found)[..] else { panic!("{:?}", found.run.warnings) };
    let part = warning.split("takes ").nth(1).and_then(|rest| rest.split(" %").next());
    (part.and_then(|part| part.parse().ok()).unwrap_or_else(|| panic!("a percentage: {warning}")), warning)
}

/// Straight and curved beams in either discretisation and measure, with and without a strain that
/// grows along the cell: would catch what a cell can follow taken for locking, bending of the
/// stress-free shape counted in, the other beam's numbers, and another energy in the denominator.
#[test]
fn locking_is_told_by_its_part_of_the_bending_energy() {
    let (cable, points) = ("leave `gauss_points` out, or use more elements", "12 points a cell resist it");
    let radial = "use more nodes, or fewer `gauss_points` for stretching";
    for (geometry, basis, cells, stiffness, measure, tip, along, advice) in [
        (LINE, "ancf = { elements = 1, POINTS }", 1, 1e3, "green", [-0.4, 0.3], [0.0, 0.0], cable),
        (LINE, "ancf = { elements = 1, POINTS }", 1, 100.0, "green", [-0.4, 0.3], [-0.3, -0.4], cable),
        (ARC, "ancf = { elements = 1, POINTS }", 1, 20.0, "green", [-0.4, 0.3], [-0.6, -0.8], cable),
        (ARC, "ancf = { elements = 1, POINTS }", 1, 1e3, "engineering", [-0.1, 0.05], [0.0, 0.0], cable),
        (ARC, "ancf = { elements = 2, POINTS }", 2, 1e4, "green", [-0.1, 0.05], [0.0, 0.0], cable),
        (ARC, "rpim = { nodes = 2, POINTS }", 1, 1e4, "engineering", [-0.1, 0.05], [0.0, 0.0], radial),
    ] {
        let geometry = format!("{geometry}, axial_stiffness = {stiffness:e}, strain = '{measure}'");
        let text = arm(&geometry, &basis.replace("POINTS", POINTS), &loads(tip, along));
        let found = solved(&(text + "analysis.static = {}\n"));
        let expected =
            100.0 * locked(&found.last[1], cells, stiffness) / found.energy.last().expect("one").bend;
        let (part, warning) = told(&found);
        near(part, expected, 0.051 + 1e-3 * expected, &format!("{geometry}, {basis}"));
        assert!(warning.ends_with(&format!("{points}: {advice}")), "{warning}");
    }
}

/// What the last state of a motion locks by is told as well.
#[test]
fn locking_is_told_of_motions() {
    let geometry = format!("{ARC}, axial_stiffness = 1e3, strain = 'green'");
    let basis = format!("ancf = {{ elements = 1, {POINTS} }}");
    let text = arm(&geometry, &basis, &loads([-0.1, 0.05], [0.0, 0.0]));
    let motion = "analysis.dynamic = { duration = 0.5, output_every = 0.5, radau.tolerance = 1e-5 }\n";
    let found = solved(&(text + motion));
    let expected = 100.0 * locked(&found.last[1], 1, 1e3) / found.energy.last().expect("a record").bend;
    near(told(&found).0, expected, 0.051 + 1e-3 * expected, "percent");
}

/// A pull straightens the arc, so that its first states lock most; those that bend less than a
/// tenth of what the last one does say nothing. Each state is that of a run to its load alone.
#[test]
fn states_that_hardly_bend_do_not_lock() {
    let geometry = format!("{ARC}, axial_stiffness = 100, strain = 'engineering'");
    let basis = format!("ancf = {{ elements = 1, {POINTS} }}");
    let pulled = |load: f64, steps: usize| {
        let text = arm(&geometry, &basis, &loads([0.0, load], [0.0, 0.0]));
        solved(&format!("{text}analysis.static.steps = {steps}\n"))
    };
    let bend = |found: &Trajectory| found.energy.last().expect("a record").bend;
    let part = |found: &Trajectory| 100.0 * locked(&found.last[1], 1, 100.0) / bend(found);
    let [first, second, last] = [3.0 / 16.0, 6.0 / 16.0, 3.0].map(|load| pulled(load, 1));
    let whole = pulled(3.0, 16);
    assert!(bend(&first) < 0.06 * bend(&last) && bend(&second) > 0.12 * bend(&last));
    assert!(part(&first) > 13.0 && part(&second) < 11.0 && part(&last) < 3.0);
    near(told(&whole).0, part(&second), 0.051, "the worst state that bends enough");
}

/// What a mesh can follow is no locking: as many points as leave nothing but a line, cells that are
/// many enough, and a pull beside which the energy of locking is nothing.
#[test]
fn what_does_not_lock_is_not_told() {
    let text = |stiffness: &str, basis: &str, tip: [f64; 2]| {
        let geometry = format!("{LINE}, axial_stiffness = {stiffness}, strain = 'green'");
        arm(&geometry, basis, &loads(tip, [0.0, 0.0])) + "analysis.static = {}\n"
    };
    let bent = [-0.8, 0.6];
    for (points, part) in [
        ("stretch = 2", None),
        ("stretch = 3, stretch_rule = 'lobatto'", None),
        ("stretch = 4", Some("; 4 points a cell resist it")),
        ("stretch = 4, stretch_rule = 'lobatto'", Some("; 4 points a cell resist it")),
    ] {
        let basis = format!("ancf = {{ elements = 1, gauss_points = {{ bend = 8, {points} }} }}");
        let found = solved(&text("1e3", &basis, bent));
        match part {
            None => assert_eq!(about_locking(&found), [""; 0], "{points}"),
            Some(part) => assert!(told(&found).1.contains(part), "{points}: {:?}", found.run.warnings),
        }
    }
    for (stiffness, basis, tip) in [
        // Three points of a soft element are stretched unevenly; three are what it can follow.
        ("10", "ancf.elements = 1".to_owned(), bent),
        ("1e3", format!("ancf = {{ elements = 16, {POINTS} }}"), [-0.4, 0.3]),
    ] {
        let found = solved(&text(stiffness, &basis, tip));
        assert_eq!(about_locking(&found), [""; 0], "{basis}");
    }
    // Of the energy of the pull and the bending less than a thousandth, of the bending a hundredth.
    let pulled = "start = [0, 0], end = [0.6, 0.8], axial_stiffness = 1e5, strain = 'green'";
    let basis = format!("ancf = {{ elements = 1, {POINTS} }}");
    let tip = [0.6 * 80.0 - 0.8, 0.8 * 80.0 + 0.6];
    let found = solved(&(arm(pulled, &basis, &loads(tip, [0.0, 0.0])) + "analysis.static.steps = 1\n"));
    let energy = found.energy.last().expect("a record");
    let locked = locked(&found.last[1], 1, 1e5);
    assert!(locked > 0.008 * energy.bend && locked < 2e-4 * (energy.bend + energy.stretch), "{energy:?}");
    assert_eq!(about_locking(&found), [""; 0]);
}

/// Two strings, of which one holds itself: its own energy is told, and the one that its section
/// forces account for; beside a neighbour whose load does a million times its work it is not
/// worth a word.
#[test]
fn strings_that_hold_themselves_are_told_with_their_energies() {
    let strings = |stiffness: f64, neighbour: f64| {
        solved(&format!(
            "beam.slack = {{ start = [0, 1], end = [0.8, 1], axial_stiffness = 1e4, mass_per_length = 1, basis.ancf.elements = 3 }}
             beam.a = {{ start = [0, 0], end = [0.8, 0], axial_stiffness = {stiffness:e}, mass_per_length = 1, \
             basis.ancf.nodes = [0.0, 0.1, 0.3, 0.4, 0.5, 0.6, 0.8] }}
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'a', at = 'end', fix = ['y'] }}, \
             {{ beam = 'slack', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'slack', at = 'end', fix = ['x', 'y'] }}]
             effect.distributed_force = [{{ beam = 'a', value = [-0.003, 0.07] }}, {{ beam = 'slack', value = [0, {neighbour:e}] }}]
             output.effects = true
             analysis.static = {{}}\n"
        ))
    };
    for stiffness in [2.5e4, 2.5e8] {
        let found = strings(stiffness, -1.0);
        let own = found.effects.iter().find(|effect| effect.name == "stretch.a").expect("a string stretches");
        let stretch = own.samples.last().expect("a record")[0];
        let shape = &found.last[1];
        let pieces = shape.s.windows(2).zip(shape.axial_force.windows(2));
        let squares: f64 =
            pieces.map(|(s, n)| (s[1] - s[0]) * (n[0].powi(2) + n[0] * n[1] + n[1].powi(2)) / 3.0).sum();
        let balanced = 0.5 * squares / stiffness;
        let [warning] = &found.run.warnings[..] else { panic!("{:?}", found.run.warnings) };
        assert!(
            warning.starts_with(&format!("string `a` holds itself: its stretch takes {stretch:.1e} J,")),
            "{warning}"
        );
        let said = warning.split("account for ").nth(1).and_then(|rest| rest.split(" J").next());
        let said: f64 = said.and_then(|said| said.parse().ok()).unwrap_or_else(|| panic!("{warning}"));
        near(said / balanced, 1.0, 0.05, "the energy that section forces account for");
        assert!(stretch > 1e4 * balanced, "{stretch} and {balanced}");
    }
    let found = strings(2.5e8, -1e4);
    assert!(found.energy.last().expect("a record").potential < -100.0);
    assert_eq!(found.run.warnings, Vec::<String>::new());
}

/// A couple M of 5 N m rolls a beam with EI = 1 N m² and EA = 50 N: κ √(EI/EA) = 0.707. Its energy ½ EA ε² + ½ EI θ'² − M θ is
/// convex, and κ = M/EI; with two Gauss points for bending, cable elements have other states. Half of the couple is held.
#[test]
fn strains_that_two_points_for_bending_do_not_hold_are_told() {
    let told = |moment: f64, more: &str| {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 50, bending_stiffness = 1, {more} }}
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]
             effect.moment = [{{ beam = 'a', at = 'end', value = {moment:?} }}]
             analysis.static = {{}}"
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}"));
        results
            .run()
            .warnings
            .iter()
            .any(|warning| warning.contains("let the strain at the nodes of cable elements run away"))
    };
    assert!(told(5.0, "basis.ancf.elements = 16"));
    assert!(!told(3.5, "basis.ancf.elements = 16"), "κ √(EI/EA) = 0.495");
    assert!(!told(5.0, "basis.ancf = { elements = 16, gauss_points = { stretch = 5, bend = 3 } }"));
    assert!(!told(5.0, "basis.rpim.nodes = 9"));
}
