//! `ancf sweep`: many runs of a scene, in one table.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use crate::run::Control;
use crate::sweep::{self, Axis, Shard, Sweep, SweepProgress};
use clap::Args;

use super::destination::Destination;
use super::failure::Failure;
use super::terminal::{self, SweepLine};
use super::{Overrides, default_directory, interrupt};

/// What follows the options in `ancf sweep --help`.
const NOTES: &str = "\
All combinations are checked before the first one is run. A run that fails is recorded with its message and ends nothing. \
Called again with the same arguments, a sweep that was interrupted or killed goes on where it was.

Exit status: 0 every run is recorded, solved or not; 1 the sweep was interrupted or could not be written, or runs are \
missing from a merge; 2 the input is wrong, or DIR holds another sweep.";

/// Many runs of one scene.
#[derive(Debug, Args)]
#[command(after_help = NOTES)]
pub struct SweepArguments {
    /// The scene file (TOML)
    #[arg(required_unless_present = "merge")]
    scene: Option<PathBuf>,
    /// Vary one value of the scene: PATH=START:STOP:COUNT evenly, PATH=START:STOP:COUNT:log evenly
    /// in the logarithm, or PATH=a,b,c; both ends with the same unit, as in
    /// effect.moment.0.value="0 N m:300 N m:7". Repeatable: all combinations are run, the last one
    /// changing fastest
    #[arg(long, value_name = "PATH=VALUES")]
    vary: Vec<String>,
    /// Take values from the lines of a CSV file whose header names paths of the scene
    #[arg(long, value_name = "FILE.csv")]
    list: Option<PathBuf>,
    /// Directory of the sweep: its journals and sweep.csv [default: out/<stem of the scene file>]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Compute every N-th run only, from the I-th; `--merge` joins the shards
    #[arg(long, value_name = "I/N", default_value = "1/1", hide_default_value = true)]
    shard: Shard,
    /// Runs at a time [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    #[command(flatten)]
    overrides: Overrides,
    /// Join the shards in DIR to DIR/sweep.csv, and see that no run is missing
    #[arg(long, value_name = "DIR",
        conflicts_with_all = ["scene", "vary", "list", "output", "shard", "threads", "set"])]
    merge: Option<PathBuf>,
    /// Print warnings and errors only
    #[arg(short, long)]
    quiet: bool,
}

/// Runs the command.
pub fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    if let Some(directory) = &arguments.merge {
        return merge(directory, arguments.quiet);
    }
    // The parser asks for a scene where nothing is merged.
    let scene = arguments.scene.as_deref().unwrap_or(Path::new(""));
    let list = arguments.list.iter().map(|path| Axis::list(path));
    let axes =
        list.chain(arguments.vary.iter().map(|option| Axis::parse(option))).collect::<Result<_, _>>()?;
    let threads = arguments.threads.map_or(0, usize::from);
    let sweep = Sweep::new(scene, &arguments.overrides.set, axes, threads)?;
    let interrupted = interrupt::listen("the sweep ends after the runs in progress");
    let destination = match &arguments.output {
        Some(directory) => Destination::prepare(directory)?,
        None => Destination::prepare(&default_directory(scene))?,
    };
    let (directory, shard) = (destination.path().to_owned(), arguments.shard);
    let line = SweepLine::new(arguments.quiet);
    let observer = &mut |progress: &SweepProgress| {
        line.show(progress);
        if interrupted.load(Ordering::Relaxed) { Control::Stop } else { Control::Continue }
    };
    let done = sweep.run(&directory, shard, observer);
    line.clear();
    done?;
    destination.keep();
    if shard == Shard::WHOLE {
        return merge(&directory, arguments.quiet);
    }
    if !arguments.quiet {
        let runs = shard.runs(sweep.grid().runs()).count();
        terminal::note(&format!(
            "shard {shard}: all of its {runs} runs are done; when every shard is, join them with `ancf sweep --merge {}`",
            directory.display()
        ));
    }
    Ok(())
}

fn merge(directory: &Path, quiet: bool) -> Result<(), Failure> {
    let merged = sweep::merge(directory)?;
    if !merged.unsolved.is_empty() {
        terminal::note(&format!(
            "warning: {} of {} runs were not solved (see the columns `outcome` and `message`): {}",
            merged.unsolved.len(),
            merged.runs,
            sweep::numbers(&merged.unsolved)
        ));
    }
    if !merged.warned.is_empty() {
        terminal::note(&format!(
            "warning: {} of {} runs have warnings (see the columns `warnings.…`): {}",
            merged.warned.len(),
            merged.runs,
            sweep::numbers(&merged.warned)
        ));
    }
    if !quiet {
        terminal::note(&format!("{} runs: {}", merged.runs, merged.table.display()));
    }
    Ok(())
}
