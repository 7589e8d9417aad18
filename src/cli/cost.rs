//! `ancf cost`: what accuracy costs in time.

mod table;

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use crate::cost::{self, Control, Options, StudyProgress};
use clap::Args;

use super::destination::Destination;
use super::failure::Failure;
use super::terminal::{self, CostLine};
use super::{Overrides, default_directory, interrupt, load, print_json};

/// What follows the options in `ancf cost --help`.
const NOTES: &str = "\
The reference is made by refining until two different discretisations agree to a tenth of the target; their difference is \
its uncertainty. A setting meets the target where its error plus that uncertainty does. Timings are medians of runs that \
have the program for themselves: leave the machine alone meanwhile.

DIR receives cost.csv, cost.json, cost.html, cost.svg (error against time), cost-work.svg (error against work) and \
best.toml, the scene with the cheapest setting that meets the target.

Exit status: 0 measured, with warnings where the reference or no setting is good enough; 1 no reference could be made, or \
it was interrupted (what was measured until then is written, marked as incomplete); 2 the input is wrong.";

/// What accuracy costs.
#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub struct CostArguments {
    /// The scene file (TOML)
    scene: PathBuf,
    /// Wanted error: largest distance of a probe from its true place, in beam lengths (without
    /// probes: of both ends and the middle of every beam); for modal analysis and buckling,
    /// relative error of frequencies or load factors
    #[arg(long, value_name = "ERROR", default_value_t = Options::default().target)]
    target: f64,
    /// Time for everything, with its unit; the reference takes up to half of it
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = super::duration)]
    budget: Duration,
    /// Directory of the results [default: out/<stem of the scene file>]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    overrides: Overrides,
    /// Print warnings and errors only
    #[arg(short, long)]
    quiet: bool,
    /// Print the results (cost.json) on standard output
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn cost(arguments: &CostArguments) -> Result<(), Failure> {
    let scene = load(&arguments.scene, &arguments.overrides)?;
    let interrupted = interrupt::listen("what was measured until now is written");
    let destination = match &arguments.output {
        Some(directory) => Destination::prepare(directory)?,
        None => Destination::prepare(&default_directory(&arguments.scene))?,
    };
    let line = CostLine::new(arguments.quiet);
    let watcher = |progress: &StudyProgress<'_>| {
        line.show(progress);
        if interrupted.load(Ordering::Relaxed) { Control::Stop } else { Control::Continue }
    };
    let options = Options { target: arguments.target, budget: arguments.budget };
    let studied = cost::study(&scene, options, &watcher);
    line.clear();
    let study = studied.map_err(|error| Failure::cost(scene.name(), error))?;
    cost::write(destination.path(), &study).map_err(Failure::Output)?;
    let results = destination.path().to_owned();
    destination.keep();
    let report = study.report();
    for warning in &report.warnings {
        terminal::note(&format!("warning: {warning}"));
    }
    if !arguments.quiet {
        terminal::note(&table::table(&report, &results));
    }
    if arguments.json {
        print_json(&report)?;
    }
    if study.complete {
        return Ok(());
    }
    Err(Failure::interrupted(&scene, &results))
}
