//! What actuators put in along a path of equilibria, and how well it is known.

use super::near;
use ancf::results::Trajectory;
use ancf::scene::parse;

fn solved(text: &str) -> Trajectory {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}")).into_states()
}

/// A beam of EI = 1 N m² that would take a curvature by itself, its end tied to where it was.
fn tied(stiffness: f64, curvature: f64, analysis: &str) -> Trajectory {
    solved(&format!(
        "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 10 }}
         support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]
         effect.actuation = [{{ beam = 'a', curvature = {curvature:?} }}]
         effect.spring = [{{ beam = 'a', at = 'end', stiffness = {stiffness:?} }}]
         analysis.static{analysis}\n"
    ))
}

/// What is told of the work of actuators.
fn told(found: &Trajectory) -> Option<&String> {
    found.run.warnings.iter().find(|warning| warning.contains("actuation has put in"))
}

/// Between walls nothing moves: ½ EA ε₀² L and ½ EI κ₀² L at each load factor, ε₀ and κ₀ the sums
/// over all that acts on the beam.
#[test]
fn actuators_between_walls_store_all_their_work() {
    for measure in ["engineering", "green"] {
        for analysis in [" = {}", ".steps = 3", ".arc_length.until_load = 1"] {
            let found = solved(&format!(
                "beam.bar = {{ start = [0, 0], end = [2, 0], axial_stiffness = 1e3, bending_stiffness = 5, strain = '{measure}', \
                 basis.ancf.elements = 4 }}
                 support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}, {{ beam = 'bar', at = 'end', fix = ['x', 'y', 'angle'] }}]
                 effect.actuation = [{{ beam = 'bar', strain = 0.01 }}, {{ beam = 'bar', strain = 0.02, curvature = 0.3 }}, \
                 {{ beam = 'bar', curvature = -0.1 }}]
                 analysis.static{analysis}\n"
            ));
            assert_eq!(found.run.warnings, Vec::<String>::new());
            assert_eq!(found.parameter.last(), Some(&1.0));
            for (load, energy) in found.parameter.iter().zip(&found.energy) {
                near(energy.stretch, 0.9 * load * load, 1e-12, "stretch");
                near(energy.bend, 0.2 * load * load, 1e-12, "bend");
                near(energy.work, 1.1 * load * load, 1e-12, "work");
            }
        }
    }
}

/// What actuators put in stays in the beam and its spring, however long the steps; along an arc
/// length as well as the points tell.
#[test]
fn actuators_put_in_what_beam_and_spring_store() {
    for (stiffness, curvature, analysis, share) in [
        (20.0, 3.0, " = {}", 1e-6),
        (20.0, 3.0, ".steps = 3", 1e-6),
        (500.0, 3.0, ".steps = 3", 1e-6),
        (100.0, 6.0, " = {}", 1e-6),
        (20.0, 3.0, ".arc_length = { until_load = 1, max_step = 0.05 }", 1e-4),
    ] {
        let found = tied(stiffness, curvature, analysis);
        let energy = found.energy.last().expect("a record");
        let stored = energy.stretch + energy.bend + energy.stored;
        assert!(stored > 1.0 && energy.stored > 0.1, "{stored}");
        near(energy.work, stored, share * stored, &format!("{stiffness}, {curvature}: {analysis}"));
        assert_eq!(told(&found), None);
    }
}

/// Between the points of an arc length nothing is known: with P = −∫ M κ₀ ds at each the work is
/// the sum of ½ (P + P') h, and errs by h²/12 times the change of the slope of P. More than a
/// hundredth of the energies is told, with both numbers.
#[test]
fn work_that_is_not_well_known_is_told() {
    for (stiffness, curvature, worth_a_word) in
        [(20.0, 3.0, false), (20.0, 6.0, false), (100.0, 9.0, false), (20.0, 9.0, true), (5.0, 9.0, false)]
    {
        let found = tied(stiffness, curvature, ".arc_length = { until_load = 1, max_step = 10 }");
        let (mut power, mut slope, mut error) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (loads, energies) in found.parameter.windows(2).zip(found.energy.windows(2)) {
            let step = loads[1] - loads[0];
            let next = 2.0 * (energies[1].work - energies[0].work) / step - power;
            let new_slope = (next - power) / step;
            error += (step * step * (new_slope - slope)).abs() / 12.0;
            (power, slope) = (next, new_slope);
        }
        // By Simpson's rule over the rows, ten panels in each cell.
        let shape = &found.last[0];
        let weight = |i: usize| if i == 0 || i == 200 { 1.0 } else { [2.0, 4.0][i % 2] };
        let moments: f64 =
            shape.curvature.iter().enumerate().map(|(i, kappa)| weight(i) * (kappa - curvature)).sum();
        let expected = -curvature * moments / 600.0;
        near(power, expected, 2e-2 * expected, &format!("{stiffness}, {curvature}: P at the end"));
        let last = found.energy.last().expect("a record");
        // ½ EI κ² L is what the actuator would put in if nothing gave way.
        let unyielding = 0.5 * curvature * curvature;
        let parts = [last.stretch, last.bend, last.stored, last.work, unyielding];
        let largest = parts.into_iter().fold(0.0, f64::max);
        assert_eq!(error > 1e-2 * largest, worth_a_word, "{stiffness} {curvature}: {error} of {largest}");
        let text = worth_a_word.then(|| {
            format!(
                "the energy that actuation has put in, {:.3e} J, is a sum over the states of the path and may err by {error:.0e} J: give",
                last.work
            )
        });
        match (text, told(&found)) {
            (None, None) => {}
            (Some(text), Some(warning)) => assert!(warning.starts_with(&text), "{text}: {warning}"),
            (text, warning) => panic!("{text:?}: {warning:?}"),
        }
    }
}

/// Two pinned beams welded to each other are bent far by actuation, and other equilibria lie beside the path.
/// What acts between the ends of a step is that of the path: the work does not depend on the steps.
#[test]
fn the_work_of_actuators_does_not_depend_on_load_steps() {
    let work = |analysis: &str| {
        let found = solved(&format!(
            "beam.a = {{ points = [[0, 0], [0.230501, 0.320982], [0.453506, 0.649543]], axial_stiffness = 232900, \
             bending_stiffness = 1, basis.rpim.nodes = 7 }}
             beam.b = {{ arc = {{ center = [0.6099665393854626, 2.089242335483733], radius = 1.4481761208420376, \
             from = -1.6790473400460515, to = -1.0567473400460514 }}, axial_stiffness = 232900, bending_stiffness = 1, \
             basis.rpim.nodes = 7 }}
             joint = [{{ type = 'weld', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}]
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}, \
             {{ beam = 'b', at = 'end', fix = ['x', 'y'], move.x = -0.1502 }}]
             effect.moment = [{{ beam = 'a', at = 'start', value = 0.8793 }}]
             effect.actuation = [{{ beam = 'b', strain.pieces = {{ until = [0.252156], value = [-0.02480039, -0.02422049] }}, \
             curvature.polynomial = [2.545563, 0.07863115845539292, -0.12877404029425474] }}]
             analysis.static{analysis}\n"
        ));
        assert_eq!(found.run.warnings, Vec::<String>::new());
        found.energy.last().expect("a record").work
    };
    let fine = work(".steps = 100");
    assert!(fine > 0.1, "{fine}");
    for analysis in [" = {}", ".steps = 2", ".steps = 7"] {
        near(work(analysis), fine, 1e-4 * fine, analysis);
    }
}

/// A shallow arch between a hinge and a slider that actuation bends the other way is straight until it
/// buckles. No load does work: what the actuator puts in is stored. Turned, it takes other steps, by round-off.
#[test]
fn actuators_put_in_what_is_stored_past_a_bifurcation() {
    for (turn, along) in [(0.0, [0.0, -1.0]), (1.1, [1.1_f64.sin(), -(1.1_f64.cos())])] {
        let [sine, cosine] = [f64::sin(turn), f64::cos(turn)];
        let (x, y) = (1.2119234646657875, 7.246900345713129);
        let found = solved(&format!(
            "beam.a = {{ arc = {{ center = [{}, {}], radius = 7.347538574577516, from = {}, to = {} }}, \
             axial_stiffness = 855000, bending_stiffness = 1, basis.ancf.elements = 4 }}
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y'] }}]
             joint = [{{ type = 'slider', along = {along:?}, first = {{ beam = 'a', at = 'end' }} }}]
             effect.actuation = [{{ beam = 'a', curvature.pieces = {{ until = [0.3896], value = [-1.0124, -1.1403] }} }}]
             analysis.static = {{}}\n",
            x * cosine - y * sine,
            x * sine + y * cosine,
            4.5466889803846895 + turn,
            4.41058898038469 + turn,
        ));
        let energy = found.energy.last().expect("a record");
        let stored = energy.stretch + energy.bend;
        assert!(stored > 0.05, "{stored}");
        near(energy.work, stored, 1e-5 * stored, &format!("turned by {turn}"));
    }
}
