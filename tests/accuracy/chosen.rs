//! What is chosen, what is kept, and what the files say of it.

use super::{cantilever, error, estimate, last, run, scene};
use ancf::model::{Analysis, Discretization, Integrator, Nodes, StepControl};
use ancf::scene::parse;
use std::f64::consts::TAU;

const MOTION: &str = "effect.gravity.acceleration = [0, -9.81]\n\
                      analysis.dynamic = { duration = 0.4, output_every = 0.05, accuracy = 1e-4 }";

/// The chosen scene is a plain one, and gives the same numbers to the last bit.
#[test]
fn the_chosen_scene_gives_the_same_bits() {
    let statics =
        "effect.force = [{ beam = 'arm', at = 0.3, value = [0, 9] }]\nanalysis.static = { accuracy = 1e-6 }";
    for text in [cantilever(1e4, 1.0, statics), cantilever(1e4, 1.0, MOTION)] {
        let results = run(&scene(&text));
        let chosen = error(&results).chosen.clone().expect("the chosen scene");
        let chosen = parse("chosen.toml", &chosen).expect("a legal scene");
        assert_eq!(chosen.accuracy(), None);
        let again = run(&chosen);
        assert!(again.run().error.is_none());
        assert_eq!(results.states().parameter, again.states().parameter);
        assert_eq!(results.states().probes[0].samples, again.states().probes[0].samples);
        assert_eq!(results.run().statistics, again.run().statistics);
    }
}

/// Where a scene asks for no accuracy the model of the first run is its own, and one whose mesh is
/// chosen gets it.
#[test]
fn the_first_model_is_that_of_the_scene_where_nothing_is_chosen() {
    let force = "effect.force = [{ beam = 'arm', at = 0.3, value = [0, 9] }]\n";
    let open = cantilever(1e4, 1.0, &format!("{force}analysis.static = {{ accuracy = 1e-6 }}"));
    let plain = cantilever(1e4, 1.0, &format!("{force}analysis.static = {{}}"))
        .replace("bending_stiffness", "basis.ancf.elements = 7, bending_stiffness");
    let first = |text: &str| ancf::accuracy::first(&scene(text)).0.beams[0].discretization.clone();
    assert_eq!(first(&plain), Discretization::Ancf { nodes: Nodes::Uniform(8) });
    assert_eq!(scene(&open).model().beams[0].discretization, Discretization::Open);
    assert_ne!(first(&open), Discretization::Open);
}

/// A basis that the scene names stays, as does an integrator; the other beam's basis is chosen.
#[test]
fn what_the_scene_names_is_kept() {
    let text = "\
        beam.first = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, basis.ancf.elements = 31 }\n\
        beam.second = { start = [1, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1 }\n\
        support = [{ beam = 'first', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
        joint = [{ type = 'weld', first = { beam = 'first', at = 'end' }, second = { beam = 'second', at = 'start' } }]\n\
        effect.gravity.acceleration = [0, -1]\n\
        analysis.dynamic = { duration = 0.2, output_every = 0.1, accuracy = 1e-3, gauss = { stages = 3, tolerance = 1e-5 } }";
    let results = run(&scene(text));
    let chosen = parse("chosen.toml", error(&results).chosen.as_ref().expect("a scene")).expect("legal");
    let beams = &chosen.model().beams;
    assert_eq!(beams[0].discretization, Discretization::Ancf { nodes: Nodes::Uniform(32) });
    assert!(matches!(beams[1].discretization, Discretization::Ancf { .. }), "{:?}", beams[1].discretization);
    let Analysis::Dynamic(settings) = chosen.analysis() else { panic!("a motion") };
    assert_eq!(settings.integrator, Integrator::Gauss { stages: 3, step: StepControl::Tolerance(1e-5) });
}

/// A scene that names neither a basis nor an accuracy takes the usual one.
#[test]
fn the_usual_accuracy_is_a_ten_thousandth() {
    let results = run(&scene(&cantilever(1e4, 1.0, "analysis.static = {}")));
    assert_eq!(error(&results).wanted.map(|wanted| wanted.result), Some(1e-4));
    // With a basis nothing is chosen, nothing estimated, and nothing paid.
    let text = cantilever(1e4, 1.0, "analysis.static = {}")
        .replace("mass_per_length", "basis.ancf.elements = 4, mass_per_length");
    let plain = run(&scene(&text));
    assert!(plain.run().error.is_none());
}

/// Curvature and section forces converge more slowly than positions; what is wanted of them takes
/// more cells.
#[test]
fn curvatures_and_forces_have_accuracies_of_their_own() {
    let with = |accuracy: &str| {
        let rest = format!(
            "effect.force = [{{ beam = 'arm', at = 'end', value = [0, 5] }}]\nanalysis.static.accuracy = {accuracy}"
        );
        run(&scene(&cantilever(1e4, 1.0, &rest)))
    };
    let coarse = with("1e-3");
    let fine = with("{ position = 1e-3, curvature = 1e-3, section_force = 1e-3 }");
    let (wanted, found) = (error(&fine).wanted.expect("wanted"), error(&fine).estimated);
    assert_eq!((wanted.curvature, wanted.section_force), (Some(1e-3), Some(1e-3)));
    assert!(found.curvature.expect("curvature") <= 1e-3 && found.section_force.expect("forces") <= 1e-3);
    assert!(error(&fine).met);
    assert!(fine.run().degrees_of_freedom > coarse.run().degrees_of_freedom);
    // EI κ at the clamp is the moment of the force about it.
    let moment = 5.0 * last(&fine).x;
    let curvature = fine.states().last[0].curvature[0];
    assert!((curvature / moment - 1.0).abs() <= 1e-3, "{curvature} {moment}");
}

/// The nodes that are chosen for a scene of one beam.
fn nodes(text: &str) -> Vec<f64> {
    let results = run(&scene(text));
    let chosen = parse("chosen.toml", error(&results).chosen.as_ref().expect("a scene")).expect("legal");
    let Discretization::Ancf { nodes: Nodes::Given(nodes) } = &chosen.model().beams[0].discretization else {
        panic!("given nodes")
    };
    nodes.clone()
}

/// A force within the span has a node of its own.
#[test]
fn a_force_within_the_span_has_a_node() {
    let rest =
        "effect.force = [{ beam = 'arm', at = 0.37, value = [0, 5] }]\nanalysis.static.accuracy = 1e-5";
    let nodes = nodes(&cantilever(1e4, 1.0, rest));
    assert!(nodes.contains(&0.37), "{nodes:?}");
}

/// So have all places at which the moment of a force, F (L - s) of what hardly bends, passes a corner of the law.
#[test]
fn every_corner_of_a_law_has_a_node() {
    let nodes = nodes(
        "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6,\n\
           bending_law = { curvature = [-1, -0.009, -0.003, 0.003, 0.009, 1], moment = [-20.42, -0.6, -0.3, 0.3, 0.6, 20.42] } }\n\
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
         effect.force = [{ beam = 'arm', at = 'end', value = [0, 1] }]\n\
         analysis.static.accuracy = 1e-5",
    );
    for corner in [0.4, 0.7] {
        assert!(nodes.iter().any(|s| (s - corner).abs() < 2e-4), "{corner}: {nodes:?}");
    }
}

/// Two motions of which the coarse one takes the same steps tell nothing of time.
#[test]
fn estimates_for_a_scene_as_it_is_take_its_own_mesh() {
    let text = cantilever(
        1e4,
        1.0,
        "effect.force = [{ beam = 'arm', at = 'end', value = [0, 5] }]\nanalysis.static = {}",
    );
    let text = text.replace("mass_per_length", "basis.ancf.elements = 12, mass_per_length");
    let scene = scene(&text);
    let plain = scene.model().solve(scene.analysis()).expect("an equilibrium");
    let known = estimate(&scene);
    assert_eq!(plain.states().probes[0].samples, known.states().probes[0].samples);
    let fine = run(&super::scene(&cantilever(
        1e4,
        1.0,
        "effect.force = [{ beam = 'arm', at = 'end', value = [0, 5] }]\nanalysis.static.accuracy = 1e-9",
    )));
    let truth = (last(&known).x - last(&fine).x).hypot(last(&known).y - last(&fine).y);
    let estimated = error(&known).estimated.result;
    assert!(error(&known).wanted.is_none());
    assert!((0.2..3.0).contains(&(truth / estimated)), "{truth:e} {estimated:e}");
}

/// Within a cubic cell of length h a force at ξ h misses the deflection F h³ ξ³ (1 − ξ)³/(3 EI) of a beam that is held at its
/// nodes, which no coarser mesh tells: there the force has another place in its cell.
#[test]
fn a_force_within_a_cell_errs_by_its_place_there() {
    let (cells, load) = (12.0_f64, 0.3_f64);
    for s in [0.4, 0.46, 0.7] {
        let text = cantilever(
            1e4,
            1.0,
            &format!(
                "effect.force = [{{ beam = 'arm', at = {s:?}, value = [0, {load:?}] }}]\nanalysis.static = {{}}"
            ),
        );
        let text = text.replace(
            "name = 'tip', beam = 'arm', at = 'end'",
            &format!("name = 'there', beam = 'arm', at = {s:?}"),
        );
        let scene = scene(&text.replace("mass_per_length", "basis.ancf.elements = 12, mass_per_length"));
        let known = estimate(&scene);
        let part = (cells * s).fract();
        let truth = load * (part * (1.0 - part) / cells).powi(3) / 3.0;
        let estimated = error(&known).estimated.result;
        assert!((0.2..3.0).contains(&(truth / estimated)), "{s}: {truth:e} {estimated:e}");
    }
}

/// Meshfree cells tell as little of it by themselves: at the tip, errors on fewer of them may have either sign.
#[test]
fn a_force_within_a_meshfree_cell_errs_by_its_place_there() {
    for (nodes, s) in [(14, 0.43), (23, 0.4531), (18, 0.7)] {
        let text = |basis: &str| {
            let load = format!(
                "effect.force = [{{ beam = 'arm', at = {s:?}, value = [0, 1] }}]\nanalysis.static = {{}}"
            );
            cantilever(1e4, 1.0, &load).replace("mass_per_length", &format!("basis.{basis}, mass_per_length"))
        };
        let named = scene(&text(&format!("rpim.nodes = {nodes}")));
        let known = estimate(&named);
        let fine = run(&scene(&text("ancf.elements = 200")));
        let truth = (last(&known).x - last(&fine).x).hypot(last(&known).y - last(&fine).y);
        let told = error(&known).probes[0].samples.last().expect("a state").x;
        assert!(truth <= 3.0 * told, "{nodes} {s}: {truth:e} {told:e}");
    }
}

/// Where an imposed strain begins, elements of length h move the place by Δε h/12, beside errors that fall much faster.
#[test]
fn a_strain_that_jumps_moves_its_place() {
    let scene = scene(
        "beam.arm = { start = [0, 0], end = [-0.51, 0.86], axial_stiffness = 7200, bending_stiffness = 1, mass_per_length = 1, \
         basis.ancf.elements = 22 }\n\
         support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
         effect.gravity.acceleration = [-2.7, 0.88]\neffect.foundation = [{ beam = 'arm', stiffness = [11, 11] }]\n\
         effect.actuation = [{ beam = 'arm', strain = 2.7e-4, from = 0.27 }]\n\
         probe = [{ name = 'there', beam = 'arm', at = 0.27 }]\nanalysis.static = {}\n",
    );
    let known = estimate(&scene);
    let truth = 2.7e-4 * 0.51_f64.hypot(0.86) / 22.0 / 12.0;
    let told = error(&known).probes[0].samples.last().expect("a state").x;
    assert!((0.5..3.0).contains(&(told / truth)), "{told:e} {truth:e}");
}

/// A rod whose axial stiffness falls from 1e4 N to a fifth at 0.37 m: elements have one strain there and two on both sides, and
/// frequency and elongation err by as much as they are long, which fewer of them do not show. With ω = k₁ √EA₁ = k₂ √EA₂ the two parts
/// vibrate by EA₁ k₁ cot k₁ℓ₁ = EA₂ k₂ tan k₂ℓ₂.
#[test]
fn a_stiffness_that_jumps_errs_by_the_length_of_elements() {
    let [stiff, soft] = [1e4_f64, 2e3];
    let residual = |omega: f64| {
        let [before, behind] = [stiff, soft].map(|stiffness| omega / stiffness.sqrt());
        stiff * before / (before * 0.37).tan() - soft * behind * (behind * 0.63).tan()
    };
    let (mut low, mut high) = (90.0, 105.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (residual(middle) < 0.0) == (residual(low) < 0.0) { low = middle } else { high = middle }
    }
    for (basis, times) in [
        ("ancf.elements = 8", 3.0),
        ("ancf.elements = 16", 3.0),
        ("ancf.elements = 40", 3.0),
        ("rpim.nodes = 15", 5.0),
    ] {
        let of = |rest: &str| {
            let scene = scene(&format!(
                "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = {{ pieces = {{ until = [0.37], value = [1e4, 2e3] }} }}, \
                 bending_stiffness = 1e7, mass_per_length = 1, basis.{basis} }}\n\
                 support = [{{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
                 probe = [{{ name = 'end', beam = 'b', at = 'end' }}]\n{rest}"
            ));
            estimate(&scene)
        };
        let vibrations = of("analysis.modal.count = 2\n");
        let found = TAU * vibrations.eigenvalues()[0];
        let (truth, told) = ((found / low - 1.0).abs(), error(&vibrations).estimated.result);
        assert!((0.3..times).contains(&(told / truth)), "{told:e} for {truth:e}, {basis}");
        let pulled =
            of("effect.force = [{ beam = 'b', at = 'end', value = [100, 0] }]\nanalysis.static = {}\n");
        let end = pulled.states().probes[0].samples.last().expect("a state").x;
        let truth = (end - 1.0 - 100.0 * (0.37 / stiff + 0.63 / soft)).abs();
        let told = error(&pulled).probes[0].samples.last().expect("a state").x;
        assert!((0.3..times).contains(&(told / truth)), "{told:e} for {truth:e}, pulled, {basis}");
    }
}

/// A layer on one side of a sheet that becomes thinner at 0.43 m: where the coupling of stretch and bending jumps, one beam errs with
/// the first order in the length of the cells there, beside errors that fall so fast that they hide it. Two beams in a weld have a
/// strain each, and tell.
#[test]
fn errors_where_a_coupling_jumps_are_seen_by_a_search() {
    let layers = |height: &str| {
        format!(
            "section.layers = [{{ youngs_modulus = 70e9, density = 2700, width = 0.02, height = 0.002 }}, \
             {{ youngs_modulus = 3.72e10, density = 1200, width = 0.02, height = {height} }}]"
        )
    };
    let rest = "support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }]\n";
    let one = scene(&format!(
        "beam.a = {{ start = [0, 0], end = [1, 0], {} }}\n{rest}analysis.modal = {{ count = 3, accuracy = 1e-4 }}\n",
        layers("{ pieces = { until = [0.43], value = [0.00703, 0.00068] } }")
    ));
    let two = scene(&format!(
        "beam.a = {{ start = [0, 0], end = [0.43, 0], {}, basis.ancf.elements = 60 }}\n\
         beam.b = {{ start = [0.43, 0], end = [1, 0], {}, basis.ancf.elements = 60 }}\n{rest}\
         joint = [{{ type = 'weld', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}]\n\
         analysis.modal.count = 3\n",
        layers("0.00703"),
        layers("0.00068")
    ));
    let [found, exact] = [run(&one), run(&two)];
    for (i, (f, exact)) in found.eigenvalues().iter().zip(exact.eigenvalues()).enumerate() {
        let (truth, told) = ((f / exact - 1.0).abs(), error(&found).eigenvalues[i]);
        assert!(truth <= 1e-4 && truth <= 3.0 * told, "{i}: {truth:e} for {told:e}");
    }
}

/// A bar that heats up by 3e-3 from its middle on: there the strain is 0 before and 3e-3 behind, and one value errs by as much as it
/// is off from either.
#[test]
fn the_strain_errs_by_its_jump_where_it_jumps() {
    let text = "beam.a = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 10 }\n\
                support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                effect.actuation = [{ beam = 'a', strain = 3e-3, from = 0.5 }]\n\
                probe = [{ name = 'p', beam = 'a', at = 0.5 }]\nanalysis.static.accuracy = 1e-5\n";
    let results = run(&scene(text));
    let (found, told) =
        (last(&results).strain, error(&results).probes[0].samples.last().expect("a state").strain);
    let off = found.abs().max((found - 3e-3).abs());
    assert!(off <= 3.0 * told && told < 1e-2, "{found:e} for 0 and 3e-3, {told:e} told");
}

/// A bar of 1 m on ten cells, of which the strain jumps in the middle: where its stiffness is doubled under 10 N, where it begins to heat
/// up by 1e-3, and at a hook that takes the 10 N. Its strain is known, and the error that is told beside the middle is that of half
/// the jump, wherever the probe is.
#[test]
fn the_strain_errs_beside_where_it_jumps() {
    let pull = "effect.force = [{ beam = 'b', at = 'end', value = [10, 0] }]\n";
    let hook = "support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'b', at = 0.5, fix = ['x'] }]\n";
    let clamp = "support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }]\n";
    let heat = "effect.actuation = [{ beam = 'b', strain = 1e-3, from = 0.5 }]\n";
    for (stiffness, more, before, behind) in [
        ("{ pieces = { until = [0.5], value = [1e4, 2e4] } }", [clamp, pull], 1e-3, 5e-4),
        ("1e4", [clamp, heat], 0.0, 1e-3),
        ("1e4", [hook, pull], 0.0, 1e-3),
    ] {
        for basis in ["ancf.elements = 10", "rpim.nodes = 11"] {
            let text = format!(
                "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = {stiffness}, bending_stiffness = 1, basis.{basis} }}\n{}{}\
                 probe = [{{ name = 'p', beam = 'b', at = 0.499 }}, {{ name = 'q', beam = 'b', at = 0.5001 }}]\nanalysis.static = {{}}\n",
                more[0], more[1]
            );
            let scene = scene(&text);
            let results = estimate(&scene);
            let states = results.states();
            for (number, exact) in [before, behind].into_iter().enumerate() {
                let found = states.probes[number].samples.last().expect("a state").strain;
                let told = error(&results).probes[number].samples.last().expect("a state").strain;
                let truth = (found - exact).abs();
                assert!(
                    truth <= 3.0 * told && told <= 5.0 * truth,
                    "{more:?} {basis}: {truth:e}, {told:e} told"
                );
            }
        }
    }
}

/// A cantilever under a small load q, of 25 meshfree nodes, which at its clamp miss a constant curvature by a part that finer meshes do
/// not make smaller. The curvature there is q L²/(2 EI).
#[test]
fn the_curvature_of_meshfree_beams_errs_at_their_ends() {
    for nodes in [25, 40] {
        let scene = scene(&format!(
            "beam.b = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.rpim.nodes = {nodes} }}\n\
             support = [{{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }}]\n\
             effect.distributed_force = [{{ beam = 'b', value = [0, -2e-3] }}]\n\
             probe = [{{ name = 'p', beam = 'b', at = 'start' }}]\nanalysis.static = {{}}\n"
        ));
        let results = estimate(&scene);
        let truth = (last(&results).curvature + 1e-3).abs();
        let told = error(&results).probes[0].samples.last().expect("a state").curvature;
        assert!(truth <= 3.0 * told && told <= 5.0 * truth, "{nodes}: {truth:e}, {told:e} told");
    }
}

/// The same where the program chooses meshfree nodes, for a motion that comes to rest.
#[test]
fn the_curvature_of_chosen_meshfree_beams_errs_at_their_ends() {
    let scene = scene(
        "beam.b = { start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1 }\n\
         support = [{ beam = 'b', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
         effect.distributed_force = [{ beam = 'b', value = [0, -2e-2] }]\n\
         effect.damping = [{ beam = 'b', mass_proportional = 4 }]\n\
         probe = [{ name = 'p', beam = 'b', at = 'start' }]\n\
         analysis.dynamic = { duration = 6, output_every = 0.5, accuracy = 1e-6 }\n",
    );
    let results = run(&scene);
    // What is left of the vibration is 1e-5 of q L²/(2 EI).
    let truth = (last(&results).curvature + 1e-2).abs();
    let told = error(&results).probes[0].samples.last().expect("a state").curvature;
    assert!(truth > 1e-6 && truth <= 3.0 * told && told <= 5.0 * truth, "{truth:e}, {told:e} told");
}
