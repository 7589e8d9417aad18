//! Commands of the `ancf` program. This module and those below it are the only code that prints.
//!
//! Results go to files, or to standard output where a command is there to print them; progress,
//! tables, warnings and errors go to standard error. Exit status: 0 done, 1 the computation or the
//! writing of its results failed or was interrupted (what was computed until then is written,
//! marked as incomplete), 2 the input is wrong.

#![expect(rustdoc::invalid_html_tags, reason = "documentation of arguments is what `--help` prints")]

mod cost;
mod destination;
mod failure;
mod interrupt;
mod sweep;
mod terminal;

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

use crate::accuracy;
use crate::output::OutputOptions;
use crate::restart::SavedState;
use crate::results::Results;
use crate::run::{self, Control, Progress, RunError, StagesRun};
use crate::scene::{self, Scene};
use clap::{Args, Parser, Subcommand};

use destination::Destination;
use failure::Failure;
use terminal::ProgressLine;

/// Planar flexible beams by the absolute nodal coordinate formulation: cable elements and Hermite
/// radial point interpolation.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    after_help = "Exit status: 0 done, 1 the computation failed, 2 the input is wrong."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Solve a scene and write its results, plots and report page
    Run(RunArguments),
    /// Say whether scenes are legal and can be built; nothing is solved or written
    Check(CheckArguments),
    /// Print what would be built for a scene: effects, tables, unknowns, bandwidth, memory
    Inspect(InspectArguments),
    /// Run a scene many times over a grid or list of values, in parallel and resumable, into one
    /// table
    Sweep(sweep::SweepArguments),
    /// Measure what accuracy costs in time, over discretisations, meshes and integrators
    Cost(cost::CostArguments),
    /// Print the JSON schema of scene files
    Schema,
}

#[derive(Debug, Args)]
struct RunArguments {
    /// The scene file (TOML)
    scene: PathBuf,
    /// Directory of the results [default: out/<stem of the scene file>]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Start from the state that a motion or a static run has saved (`state.json` in its directory): a motion lasts for `duration` from
    /// there on, what is new in statics grows with the load factor, and vibrations may be about it
    #[arg(long, value_name = "STATE")]
    from: Option<PathBuf>,
    /// Save the state of a motion every so often by the clock, such as "10 min", into `state.json`
    /// of the directory, from which `--from` goes on should the run be killed
    #[arg(long, value_name = "TIME", value_parser = duration)]
    checkpoint: Option<Duration>,
    #[command(flatten)]
    overrides: Overrides,
    /// Largest error of the results, in place of the scene's: what the scene leaves open is chosen
    /// for it
    #[arg(long, value_name = "ERROR")]
    accuracy: Option<String>,
    /// Estimate the errors of the results of a scene that names its mesh and steps itself
    #[arg(long, conflicts_with = "accuracy")]
    error: bool,
    /// Print warnings and errors only
    #[arg(short, long)]
    quiet: bool,
    /// Print summary.json on standard output
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct CheckArguments {
    /// Scene files (TOML)
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    overrides: Overrides,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Debug, Args)]
struct InspectArguments {
    /// The scene file (TOML)
    scene: PathBuf,
    #[command(flatten)]
    overrides: Overrides,
    /// Measure the time that each effect and the linear algebra take in an iteration
    #[arg(long)]
    measure: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct Overrides {
    /// Set one value of the scene, such as beam.arm.basis.ancf.elements=9 or
    /// effect.moment.0.value="3 kN m"; beam.*.strain=green sets it for all beams; repeatable
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// Runs the program with its name and arguments; returns its exit status.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let Arguments { command } = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(told) => {
            // Help that nobody reads, as behind a pipe to `head`, is no failure.
            let _ = told.print();
            return u8::try_from(told.exit_code()).unwrap_or(2);
        }
    };
    let done = match command {
        Command::Run(arguments) => solve(&arguments).map_err(|failure| vec![failure]),
        Command::Check(arguments) => check(&arguments),
        Command::Inspect(arguments) => inspect(&arguments).map_err(|failure| vec![failure]),
        Command::Sweep(arguments) => sweep::sweep(&arguments).map_err(|failure| vec![failure]),
        Command::Cost(arguments) => cost::cost(&arguments).map_err(|failure| vec![failure]),
        Command::Schema => print_json(&scene::schema()).map_err(|failure| vec![failure]),
    };
    let failures = done.err().unwrap_or_default();
    failures.iter().for_each(terminal::report);
    failures.iter().map(Failure::exit_status).max().unwrap_or(0)
}

/// A positive time with its unit.
fn duration(text: &str) -> Result<Duration, String> {
    if text.trim().parse::<f64>().is_ok() {
        return Err(format!("it has no unit: write \"{0} s\" or \"{0} min\"", text.trim()));
    }
    Duration::try_from_secs_f64(scene::seconds(text)?).map_err(|error| error.to_string())
}

fn load(path: &Path, overrides: &Overrides) -> Result<Scene, Failure> {
    Scene::load(path, &overrides.set).map_err(Failure::Scene)
}

fn solve(arguments: &RunArguments) -> Result<(), Failure> {
    let mut scene = load(&arguments.scene, &arguments.overrides)?;
    let in_stages = !scene.stages().is_empty();
    if in_stages && arguments.accuracy.is_some() {
        return Err(Failure::run(scene.name(), RunError::Stages));
    }
    if let Some(error) = &arguments.accuracy {
        let analysis = scene.analysis().kind();
        let wanted = [format!("analysis.{analysis}.accuracy={error}")];
        scene = scene.with(&wanted).map_err(Failure::Scene)?;
    }
    let saved = arguments.from.as_deref().map(SavedState::load).transpose();
    let saved = saved.map_err(|error| Failure::run(scene.name(), error.into()))?;
    let interrupted = interrupt::listen("the run ends after this step");
    let destination = match &arguments.output {
        Some(directory) => Destination::prepare(directory)?,
        None => Destination::prepare(&default_directory(&arguments.scene))?,
    };
    let progress = ProgressLine::new(scene.analysis(), arguments.quiet);
    let observer = &mut |progress_now: &Progress| {
        progress.show(progress_now);
        if interrupted.load(Ordering::Relaxed) { Control::Stop } else { Control::Continue }
    };
    let take = |state: &SavedState| {
        if let Err(error) = crate::output::save(destination.path(), state) {
            terminal::note(&format!("{}: no checkpoint: {error}", destination.path().display()));
        }
    };
    let wanted = OutputOptions { states: scene.output().states, vtu: scene.output().vtu };
    let checkpoints = arguments.checkpoint.map(|every| run::Checkpointing { every, take: &take });
    let options = run::Options {
        start: saved.as_ref(),
        observer: Some(observer),
        checkpoints,
        frames: wanted.frames(),
        ..run::Options::default()
    };
    if in_stages {
        let run = match arguments.error {
            true => accuracy::estimate_stages(scene.stages(), options),
            false => run::solve_stages(scene.stages(), options),
        };
        progress.clear();
        return finish_stages(arguments, &scene, run, &wanted, destination);
    }
    let outcome = if arguments.error && scene.accuracy().is_none() {
        accuracy::estimate(scene.model(), scene.analysis(), options)
    } else {
        accuracy::run(&scene, options)
    };
    progress.clear();
    let (mut results, failure) = match outcome {
        Ok(results) if results.run().complete => {
            let failure = Failure::inaccurate(scene.name(), results.run());
            (results, failure)
        }
        Ok(partial) => (partial, Some(Failure::interrupted(&scene, destination.path()))),
        Err(mut error) => match error.take_partial() {
            Some(partial) => (partial, Some(Failure::run(scene.name(), error))),
            None => return Err(Failure::run(scene.name(), error)),
        },
    };
    terminal::warnings(results.run());
    results.states_mut().run.warnings.extend(failure.as_ref().map(Failure::to_string));
    let summary = crate::output::write(destination.path(), &mut results, &wanted).map_err(Failure::Output)?;
    if !arguments.quiet {
        terminal::results(&results, destination.path());
    }
    destination.keep();
    if arguments.json {
        print_json(&summary)?;
    }
    failure.map_or(Ok(()), Err)
}

/// Writes and tells what was computed of a scene with stages.
fn finish_stages(
    arguments: &RunArguments,
    scene: &Scene,
    run: StagesRun,
    wanted: &OutputOptions,
    destination: Destination,
) -> Result<(), Failure> {
    let StagesRun { mut results, failure } = run;
    let interrupted = results.last().is_some_and(|results| !results.run().complete);
    let failure = match failure {
        Some(error) => Some(Failure::run(scene.name(), error)),
        None => interrupted.then(|| Failure::interrupted(scene, destination.path())),
    };
    if results.is_empty() {
        return failure.map_or(Ok(()), Err);
    }
    let names = scene.stages().iter().map(|stage| stage.name.as_str());
    for (name, results) in names.clone().zip(&results) {
        terminal::stage_warnings(name, results.run());
    }
    if let (Some(failure), Some(last)) = (&failure, results.last_mut()) {
        last.run_mut().warnings.push(failure.to_string());
    }
    let mut stages: Vec<(&str, Results)> = names.zip(results).collect();
    let summary = crate::output::write_stages(destination.path(), &mut stages, wanted, failure.is_none())
        .map_err(Failure::Output)?;
    if !arguments.quiet {
        for (name, results) in &stages {
            terminal::note(&format!("stage {name}"));
            terminal::results(results, &destination.path().join(name));
        }
        terminal::note(&format!("all stages  {}", destination.path().join("report.html").display()));
    }
    destination.keep();
    if arguments.json {
        print_json(&summary)?;
    }
    failure.map_or(Ok(()), Err)
}

fn default_directory(scene: &Path) -> PathBuf {
    Path::new("out").join(scene.file_stem().unwrap_or(scene.as_os_str()))
}

/// Checks every scene, so that one call tells all that is wrong.
fn check(arguments: &CheckArguments) -> Result<(), Vec<Failure>> {
    let mut failures = Vec::new();
    for path in &arguments.scenes {
        let checked = load(path, &arguments.overrides).and_then(|scene| {
            // Some faults, such as shape functions that cannot be solved for, show only when they
            // are built.
            let checked = match scene.stages() {
                [] => {
                    let (model, analysis) = accuracy::first(&scene);
                    run::inspect(&model, &analysis).map(drop)
                }
                stages => run::inspect_stages(stages, run::inspect).map(drop),
            };
            checked.map_err(|error| Failure::run(scene.name(), error))
        });
        match checked {
            Ok(_) if arguments.quiet => {}
            Ok(_) => terminal::note(&format!("{}: ok", path.display())),
            Err(failure) => failures.push(failure),
        }
    }
    if failures.is_empty() { Ok(()) } else { Err(failures) }
}

fn inspect(arguments: &InspectArguments) -> Result<(), Failure> {
    let scene = load(&arguments.scene, &arguments.overrides)?;
    let look = if arguments.measure { run::measure } else { run::inspect };
    if !scene.stages().is_empty() {
        let inventories =
            run::inspect_stages(scene.stages(), look).map_err(|error| Failure::run(scene.name(), error))?;
        return if arguments.json {
            let named = inventories
                .into_iter()
                .map(|(name, inventory)| (name.to_owned(), serde_json::json!(inventory)));
            print_json(&named.collect::<serde_json::Map<_, _>>())
        } else {
            inventories.iter().try_for_each(|(name, inventory)| print(&format!("stage {name}\n{inventory}")))
        };
    }
    let (model, analysis) = accuracy::first(&scene);
    let inventory = look(&model, &analysis).map_err(|error| Failure::run(scene.name(), error))?;
    if arguments.json { print_json(&inventory) } else { print(&inventory.to_string()) }
}

fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Failure::Print(error.into()))?;
    print(&text)
}

/// Writes to standard output. A reader that closes the pipe early, as `head` does, is no failure.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{}", terminal::visible(text.trim_end())).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Print(error)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn results_go_to_out_and_the_stem() {
        assert_eq!(default_directory(Path::new("a/b/roll-up.toml")), Path::new("out/roll-up"));
    }

    #[test]
    fn times_have_units_and_are_positive() {
        assert_eq!(duration("10 min"), Ok(Duration::from_secs(600)));
        assert_eq!(duration("250ms"), Ok(Duration::from_millis(250)));
        for wrong in ["10", "2 m", "-3 s", "1e30 s"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }
}
