//! What is done with an input, and which outcomes are complaints.

use std::fmt;

use ancf::model::{Analysis, Buckling, Modal, Model};
use ancf::output::{self, OutputOptions};
use ancf::restart::SavedState;
use ancf::results::Results;
use ancf::run::{self, Control};
use ancf::scene;

/// Most nodes of a scene that is built.
const BUILT: usize = 20_000;
/// Most nodes of a scene that is run.
const RUN: usize = 80;
/// Most eigenpairs of a scene that is run.
const MODES: usize = 100;
/// Steps after which a run is stopped.
const STEPS: usize = 5;
/// Most records of a run: one step may pass them all.
const RECORDS: f64 = 2e4;

/// A scene, and perhaps a saved state that it starts from.
pub struct Input {
    pub scene: String,
    pub state: Option<String>,
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.scene)?;
        match &self.state {
            Some(state) => write!(f, "\n# starts from\n# {state}\n"),
            None => Ok(()),
        }
    }
}

/// How far an input got.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reached {
    /// It was refused.
    Refused,
    /// It is a scene.
    Legal,
    /// It was run.
    Run,
}

fn few_steps() -> impl FnMut(&run::Progress) -> Control {
    let mut steps = 0;
    move |_| {
        steps += 1;
        if steps < STEPS { Control::Continue } else { Control::Stop }
    }
}

fn nodes(model: &Model) -> usize {
    model.beams.iter().map(|beam| beam.discretization.nodes().count()).fold(0, usize::saturating_add)
}

fn is_small(analysis: &Analysis) -> bool {
    match analysis {
        Analysis::Buckling(Buckling { count }) | Analysis::Modal(Modal { count, .. }) => *count <= MODES,
        Analysis::Dynamic(dynamic) => dynamic.duration / dynamic.output_every <= RECORDS,
        _ => true,
    }
}

/// Reads, inspects and runs an input; `write` its results too.
///
/// # Errors
/// The complaint.
pub fn meet(input: &Input, write: bool) -> Result<Reached, String> {
    let scene = match scene::parse("scene.toml", &input.scene) {
        Ok(scene) => scene,
        Err(error) if error.place().is_none() => return Err(format!("a refusal without a place: {error}")),
        Err(_) => return Ok(Reached::Refused),
    };
    let nodes = nodes(scene.model());
    if nodes > BUILT || run::inspect(scene.model(), scene.analysis()).is_err() {
        return Ok(Reached::Legal);
    }
    if nodes > RUN || !is_small(scene.analysis()) {
        return Ok(Reached::Legal);
    }
    let saved = match &input.state {
        Some(text) => match load(text)? {
            Some(saved) => Some(saved),
            None => return Ok(Reached::Legal),
        },
        None => None,
    };
    let observer = &mut few_steps();
    let options = run::Options { start: saved.as_ref(), observer: Some(observer), ..run::Options::default() };
    let outcome = scene.model().solve_with(scene.analysis(), options);
    let mut results = match outcome {
        Ok(results) => results,
        Err(mut error) => {
            if error.to_string().contains("NaN") {
                return Err(format!("a message with a number that is none: {error}"));
            }
            match error.take_partial() {
                Some(partial) => partial,
                None => return Ok(Reached::Run),
            }
        }
    };
    finite(&results)?;
    if write {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let all = OutputOptions { states: true, vtu: true };
        output::write(folder.path(), &mut results, &all).map_err(|error| format!("output: {error}"))?;
    }
    Ok(Reached::Run)
}

/// The saved state in a text, if there is one. It is also read as a file, but there the checksum
/// would refuse every damaged state.
fn load(text: &str) -> Result<Option<SavedState>, String> {
    let file = tempfile::NamedTempFile::new().map_err(|error| error.to_string())?;
    std::fs::write(file.path(), text).map_err(|error| error.to_string())?;
    let read = SavedState::load(file.path());
    Ok(serde_json::from_str(text).ok().or(read.ok()))
}

fn finite(results: &Results) -> Result<(), String> {
    let t = results.states();
    let samples = t.probes.iter().flat_map(|probe| &probe.samples);
    let seen = samples.flat_map(|s| [s.x, s.y, s.angle, s.curvature, s.strain]);
    let energies = t.energy.iter().flat_map(|e| [e.stretch, e.bend, e.kinetic, e.potential, e.work]);
    let eigen = results.eigenvalues().into_iter().chain(t.parameter.iter().copied());
    match seen.chain(energies).chain(eigen).find(|v| !v.is_finite()) {
        Some(v) => Err(format!("results with {v} in a {:?} analysis", t.run.analysis)),
        None => Ok(()),
    }
}

/// The scene with the state that its motion has after some steps, where it has a motion and is
/// small.
pub fn saved(scene: &str) -> Option<(String, serde_json::Value)> {
    let parsed = scene::parse("seed", scene).ok()?;
    if nodes(parsed.model()) > RUN || !is_small(parsed.analysis()) {
        return None;
    }
    let observer = &mut few_steps();
    let options = run::Options { observer: Some(observer), ..run::Options::default() };
    let results = parsed.model().solve_with(parsed.analysis(), options).ok()?;
    Some((scene.to_owned(), serde_json::to_value(results.into_states().saved?).ok()?))
}
