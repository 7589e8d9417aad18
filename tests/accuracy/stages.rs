//! Errors of analyses one after the other: each is right about what it begins with, too.

use super::{cantilever, error, last, scene};
use ancf::accuracy::estimate_stages;
use ancf::results::Results;
use ancf::run::{Options, StagesRun, solve_stages};

/// A cantilever is bent into an arc, into more of one, vibrates, and is let go.
fn bent_and_let_go(cells: usize, tolerance: f64) -> String {
    let stages = format!(
        "effect.moment = [{{ beam = 'arm', at = 'end', value = 1.5, until = 'loose' }}, \
         {{ beam = 'arm', at = 'end', value = 1.5, stage = 'more', until = 'loose' }}]\n\
         stage = [{{ name = 'bend', analysis.static = {{}} }}, {{ name = 'more', analysis.static = {{}} }}, \
         {{ name = 'tones', analysis.modal = {{ count = 2, about = 'equilibrium' }} }}, \
         {{ name = 'loose', analysis.dynamic = {{ duration = 0.1, output_every = 0.01, radau.tolerance = {tolerance:e} }} }}]"
    );
    let named = format!("basis = {{ ancf = {{ elements = {cells} }} }}, mass_per_length = 1 }}");
    cantilever(1e3, 1.0, &stages).replacen("mass_per_length = 1 }", &named, 1)
}

fn results(run: StagesRun) -> Vec<Results> {
    assert!(run.failure.is_none(), "{:?}", run.failure.map(|failure| failure.to_string()));
    run.results
}

/// The arcs have closed forms, x = sin φ/φ and y = (1 − cos φ)/φ; what follows is held against a mesh that is four times as fine.
#[test]
fn every_stage_knows_its_error_and_that_of_its_start() {
    let asked = scene(&bent_and_let_go(6, 1e-4));
    let found = results(estimate_stages(asked.stages(), Options::default()));
    let plain = results(solve_stages(asked.stages(), Options::default()));
    let finer = scene(&bent_and_let_go(24, 1e-6));
    let truth = results(solve_stages(finer.stages(), Options::default()));
    for (with_errors, plain) in found.iter().zip(&plain) {
        let tips = [with_errors, plain].map(|results| results.states().probes[0].samples.clone());
        assert_eq!(tips[0], tips[1], "an estimate changes no result");
        assert_eq!(with_errors.eigenvalues(), plain.eigenvalues());
    }
    for (stage, turn) in [(0, 1.5_f64), (1, 3.0)] {
        let tip = last(&found[stage]);
        let off = (tip.x - turn.sin() / turn).hypot(tip.y - (1.0 - turn.cos()) / turn);
        let told = error(&found[stage]).estimated.result;
        assert!(off <= 3.0 * told && told <= 10.0 * off, "an arc of {turn} rad: {off:.1e}, told {told:.1e}");
    }
    let tones = found[2].eigenvalues().into_iter().zip(truth[2].eigenvalues());
    let off = tones.map(|(found, truth)| (found / truth - 1.0).abs()).fold(0.0, f64::max);
    let told = error(&found[2]).estimated.result;
    assert!(off <= 3.0 * told && told <= 10.0 * off, "frequencies: {off:.1e}, told {told:.1e}");
    let [begins, told] = [&error(&found[1]), &error(&found[3])].map(|error| error.probes[0].samples.clone());
    let (begins, told) = (begins.last().expect("a record"), told);
    assert!(told[0].x >= 0.5 * begins.x, "a motion errs at first by what it begins with");
    let probes = [&found[3], &truth[3]].map(|results| &results.states().probes[0].samples);
    let off = probes[0].iter().zip(probes[1]).map(|(a, b)| (a.x - b.x).hypot(a.y - b.y)).fold(0.0, f64::max);
    let told = error(&found[3]).estimated.result;
    assert!(off <= 3.0 * told && told <= 10.0 * off, "a motion: {off:.1e}, told {told:.1e}");
}

/// Where a motion rests, no step errs, however many it takes: it is as wrong as the equilibrium that it begins in.
#[test]
fn a_motion_that_rests_errs_by_what_it_begins_with() {
    let stages = "effect.force = [{ beam = 'arm', at = 'end', value = [0, -4] }]\n\
                  stage = [{ name = 'hang', analysis.static = {} }, { name = 'rest', analysis.dynamic = { duration = 0.1 } }]";
    let named = "basis.ancf.elements = 6, mass_per_length = 1 }";
    let asked = scene(&cantilever(1e4, 1.0, stages).replacen("mass_per_length = 1 }", named, 1));
    let found = results(estimate_stages(asked.stages(), Options::default()));
    let [hangs, rests] = [&found[0], &found[1]].map(|results| error(results).estimated.result);
    assert!(rests >= 0.3 * hangs && rests <= 3.0 * hangs, "{rests:.1e} after {hangs:.1e}");
}
