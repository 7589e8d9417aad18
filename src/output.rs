//! Files for people and for programs: the [`Results`] of an analysis as tables, plots and one page.
//!
//! | file | holds |
//! |---|---|
//! | `summary.json` | [`Summary`]: last values, energies, counts, times, whether the run came to its end |
//! | `probes.csv`, `energy.csv` | one row per load factor or time; 17 significant digits, SI |
//! | `shape.csv` | the last state along every beam, with section forces; two rows where a force or a couple acts in a point |
//! | `state.json` | the last state of a motion, or the equilibrium under the full loads, from which a motion can start |
//! | `frequencies.csv` or `load_factors.csv` | modal analysis or buckling |
//! | `modes.csv` | what each mode changes along the beams: displacements, turn of r', strain, curvature |
//! | `report.html` | everything to look at, the moving beam included; needs no network |
//! | `shape.svg`, `curvature.svg`, … | the page's plots, one each |
//! | `states.csv`; `states.pvd`, `modes.pvd`, `vtu/` | all recorded states as a table; states and modes for ParaView (both when asked for) |
//!
//! Pages and plots need the feature `report`, which is on unless it is declined.
//!
//! In tables a name that begins as a formula does (`=`, `+`, `-`, `@`) has an apostrophe before it,
//! which spreadsheets take for the mark of a text.
//!
//! Files are written under temporary names and renamed when all of them are complete: a failure
//! leaves no half-written file under a final name.

mod digits;
mod error;
mod event;
#[cfg(feature = "report")]
mod figures;
#[cfg(feature = "report")]
mod mode;
#[cfg(feature = "report")]
mod motion;
#[cfg(feature = "report")]
pub mod plot;
#[cfg(feature = "report")]
mod report;
mod staged_files;
mod summary;
mod tables;
mod vtu;

use std::fs;
use std::path::Path;
use std::time::Instant;

pub use digits::with_error;
pub use error::OutputError;
pub(crate) use event::EventText;
pub(crate) use summary::drift;
pub use summary::{
    EnergySummary, ErrorSummary, ProbeSummary, StageSummary, StagesSummary, Summary, WantedError,
};

use crate::restart::SavedState;
use crate::results::{PICTURES, Results};
pub(crate) use staged_files::StagedFiles;
pub(crate) use tables::{cell, exact, text_of_cell};

/// Which of the larger files to write.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutputOptions {
    /// `states.csv`: every beam at every record.
    pub states: bool,
    /// `states.pvd`, `modes.pvd` and `vtu/…`: states and modes for ParaView.
    pub vtu: bool,
}

impl OutputOptions {
    /// How many frames a run should keep: all if they are written, otherwise as many as a page
    /// draws.
    pub fn frames(&self) -> usize {
        if self.states || self.vtu { usize::MAX } else { PICTURES }
    }
}

/// Names that a run may leave; those that this run does not write are removed when it replaces an
/// older one, so that a directory never mixes two runs.
const NAMES: [&str; 33] = [
    "chosen.toml",
    "reactions.csv",
    "effects.csv",
    "summary.json",
    "state.json",
    "probes.csv",
    "energy.csv",
    "shape.csv",
    "layers.csv",
    "frequencies.csv",
    "load_factors.csv",
    "modes.csv",
    "states.csv",
    "states.pvd",
    "modes.pvd",
    "vtu/last.vtu",
    "report.html",
    "shape.svg",
    "curvature.svg",
    "error.svg",
    "strain.svg",
    "stress.svg",
    "forces.svg",
    "moments.svg",
    "stresses.svg",
    "position.svg",
    "angle.svg",
    "velocity.svg",
    "energy.svg",
    "convergence.svg",
    "steps.svg",
    "newton.svg",
    "modes.svg",
];

/// Writes the results into `directory`, which is made where it is missing, and returns what
/// `summary.json` says. Adds the time taken until the summary was written to
/// `seconds.write`.
///
/// # Errors
/// [`OutputError`] where the trajectory contradicts itself, or a file cannot be written: then no
/// file has a new content that is not complete, and directories made for it are removed.
pub fn write(
    directory: &Path,
    results: &mut Results,
    options: &OutputOptions,
) -> Result<Summary, OutputError> {
    let start = Instant::now();
    check(results)?;
    let (t, modes) = (results.states(), results.mode_shapes());
    // Drawn before anything is written, so that a failure to draw leaves no files behind.
    #[cfg(feature = "report")]
    let figures = figures::figures(results)?;
    #[cfg(feature = "report")]
    let page = report::page(results, &Summary::of(results), figures.clone())?;
    let mut stage = StagedFiles::new(directory)?;
    if !t.parameter.is_empty() {
        stage.add("probes.csv", |out| tables::probes(t, out))?;
        stage.add("energy.csv", |out| tables::energy(t, out))?;
    }
    if !t.reactions.is_empty() {
        stage.add("reactions.csv", |out| tables::reactions(t, out))?;
    }
    if !t.effects.is_empty() {
        stage.add("effects.csv", |out| tables::effects(t, out))?;
    }
    stage.add("shape.csv", |out| tables::shape(t, out))?;
    if t.last.iter().any(|shape| shape.stress.len() > 1) {
        stage.add("layers.csv", |out| tables::layers(t, out))?;
    }
    if let Some(saved) = &t.saved {
        stage.add("state.json", |out| Ok(serde_json::to_writer(out, saved)?))?;
    }
    if let Some(chosen) = t.run.error.as_ref().and_then(|error| error.chosen.as_ref()) {
        stage.add("chosen.toml", |out| out.write_all(chosen.as_bytes()))?;
    }
    let eigenvalues = match results {
        Results::Trajectory(_) => None,
        Results::Vibrations(_) => Some(("frequencies.csv", "frequency")),
        Results::CriticalLoads(_) => Some(("load_factors.csv", "load_factor")),
    };
    if let Some((name, column)) = eigenvalues {
        stage.add(name, |out| tables::eigenvalues(column, &results.eigenvalues(), out))?;
    }
    if !modes.is_empty() {
        stage.add("modes.csv", |out| tables::modes(&modes, out))?;
    }
    if options.states && !t.frames.is_empty() {
        stage.add("states.csv", |out| tables::states(t, out))?;
    }
    if options.vtu {
        for (name, text) in vtu::states(t).into_iter().chain(vtu::modes(&t.last, &modes)) {
            stage.add(&name, |out| out.write_all(text.as_bytes()))?;
        }
    }
    #[cfg(feature = "report")]
    {
        for figure in &figures {
            stage.add(&format!("{}.svg", figure.name), |out| out.write_all(figure.svg.as_bytes()))?;
        }
        stage.add("report.html", |out| out.write_all(page.as_bytes()))?;
    }
    let series = if options.vtu { [t.frames.len(), modes.len()] } else { [0; 2] };
    results.states_mut().run.seconds.write += start.elapsed().as_secs_f64();
    let summary = Summary::of(results);
    stage.add("summary.json", |out| out.write_all(summary.to_json()?.as_bytes()))?;
    replace(directory, stage, series, &[])?;
    Ok(summary)
}

/// Gives the files their names and removes those of an older run, of which so many frames and modes for ParaView
/// have been replaced, and the folders of its stages that are not among `stages`.
fn replace(
    directory: &Path,
    staged: StagedFiles,
    series: [usize; 2],
    stages: &[&str],
) -> Result<(), OutputError> {
    // Only beside a summary are these names surely those of an older run.
    let replaces = directory.join("summary.json").is_file();
    let older: Vec<&str> = NAMES.into_iter().filter(|name| replaces && !staged.contains(name)).collect();
    let gone = stages_of(directory).into_iter().filter(|name| !stages.contains(&name.as_str()));
    let gone: Vec<String> = gone.collect();
    staged.commit()?;
    if replaces {
        remove(directory, &older, series);
    }
    for name in gone {
        let folder = directory.join(name);
        if folder.join("summary.json").is_file() {
            remove(&folder, &NAMES, [0; 2]);
            // Files of others stay, and so does then their folder.
            let _ = fs::remove_dir(folder);
        }
    }
    Ok(())
}

/// Removes these files, and the frames and modes for ParaView behind the first so many.
fn remove(directory: &Path, names: &[&str], [frames, modes]: [usize; 2]) {
    for name in names {
        // Missing, most often. A file that cannot be removed does not make the new ones wrong.
        let _ = fs::remove_file(directory.join(name));
    }
    // They are numbered without gaps.
    let _ = (frames..).try_for_each(|i| fs::remove_file(directory.join(vtu::frame_name(i))));
    let _ = (modes..).try_for_each(|i| fs::remove_file(directory.join(vtu::mode_name(i))));
    let _ = fs::remove_dir(directory.join("vtu"));
}

/// The stages of which the summary in `directory` tells; none where it is that of one analysis.
fn stages_of(directory: &Path) -> Vec<String> {
    #[derive(serde::Deserialize)]
    struct Named {
        name: String,
    }
    #[derive(serde::Deserialize)]
    struct Stages {
        stages: Vec<Named>,
    }
    let text = fs::read_to_string(directory.join("summary.json")).unwrap_or_default();
    let names = serde_json::from_str(&text).map_or_else(|_| Vec::new(), |Stages { stages }| stages);
    // A name that is more than that of a folder here is none of ours.
    let is_ours = |name: &String| Path::new(name).file_name().is_some_and(|file| file == name.as_str());
    names.into_iter().map(|stage| stage.name).filter(is_ours).collect()
}

/// Writes the results of stages, each into a folder of its own name in `directory`, and one page and
/// one summary of all into `directory` itself. `complete` tells whether these are all stages.
///
/// # Errors
/// As [`write()`].
pub fn write_stages(
    directory: &Path,
    stages: &mut [(&str, Results)],
    options: &OutputOptions,
    complete: bool,
) -> Result<StagesSummary, OutputError> {
    stages.iter().try_for_each(|(_, results)| check(results))?;
    #[cfg(feature = "report")]
    let page = report::page_of_stages(stages, complete)?;
    let mut summaries = Vec::with_capacity(stages.len());
    for (name, results) in stages.iter_mut() {
        let summary = write(&directory.join(*name), results, options)?;
        summaries.push(StageSummary { name: (*name).to_owned(), summary });
    }
    let mut staged = StagedFiles::new(directory)?;
    #[cfg(feature = "report")]
    staged.add("report.html", |out| out.write_all(page.as_bytes()))?;
    let summary = StagesSummary::new(summaries, complete);
    staged.add("summary.json", |out| out.write_all(summary.to_json()?.as_bytes()))?;
    let names: Vec<&str> = stages.iter().map(|(name, _)| *name).collect();
    replace(directory, staged, [0; 2], &names)?;
    Ok(summary)
}

/// The page that [`write()`] writes as `report.html`.
///
/// # Errors
/// [`OutputError`] where the trajectory contradicts itself, or a picture cannot be drawn.
#[cfg(feature = "report")]
pub fn page(results: &Results) -> Result<String, OutputError> {
    check(results)?;
    let figures = figures::figures(results)?;
    report::page(results, &Summary::of(results), figures)
}

/// Writes `state.json` alone: a checkpoint of a run that is under way.
///
/// # Errors
/// [`OutputError`] where it cannot be written; an older one is then left as it was.
pub fn save(directory: &Path, state: &SavedState) -> Result<(), OutputError> {
    let mut stage = StagedFiles::new(directory)?;
    stage.add("state.json", |out| Ok(serde_json::to_writer(out, state)?))?;
    stage.commit()
}

/// Refuses lists whose lengths do not fit together, which would put values beside the wrong
/// parameter.
fn check(results: &Results) -> Result<(), OutputError> {
    let t = results.states();
    let fits = |quantity: &dyn Fn() -> String, expected: usize, found: usize| {
        if expected == found {
            return Ok(());
        }
        Err(OutputError::Inconsistent { quantity: quantity(), expected, found })
    };
    let records = t.parameter.len();
    fits(&|| "energies".into(), records, t.energy.len())?;
    for probe in &t.probes {
        fits(&|| format!("samples of probe `{}`", probe.name), records, probe.samples.len())?;
    }
    for shape in t.run.undeformed.iter().chain(&t.last) {
        let values = [&shape.x, &shape.y, &shape.angle, &shape.strain, &shape.curvature];
        // Only states under load have section forces.
        let forces = [&shape.axial_force, &shape.shear_force, &shape.bending_moment];
        for values in values.into_iter().chain(forces.into_iter().filter(|forces| !forces.is_empty())) {
            fits(&|| format!("values along beam `{}`", shape.beam), shape.s.len(), values.len())?;
        }
        for values in shape.stress.iter().flat_map(|layer| [&layer.bottom, &layer.top]) {
            fits(&|| format!("stresses along beam `{}`", shape.beam), shape.s.len(), values.len())?;
        }
    }
    for mode in results.mode_shapes().into_iter().flatten() {
        for values in [&mode.x, &mode.y, &mode.angle, &mode.strain, &mode.curvature] {
            fits(&|| format!("values of a mode along beam `{}`", mode.beam), mode.s.len(), values.len())?;
        }
    }
    Ok(())
}
