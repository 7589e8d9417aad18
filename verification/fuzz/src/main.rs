//! `fuzz`: feeds the solver damaged scenes and saved states, and keeps those that it handles badly;
//! with `--agree` legal ones, each in several ways that must agree ([`mod@agree`]).
//!
//! The seeds are all scenes of the repository. A worker process damages them, as trees of values
//! and as text, reads, inspects and, where they are small, runs them for a few steps and writes the
//! results. Findings are panics, states with numbers that are not finite, inputs that take too long
//! or too much memory, and messages without a place. The worker may die of one; the parent then
//! keeps the input that it had in hand and starts another.

mod agree;
mod damage;
mod exercise;
mod worker;

use std::alloc::System;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use cap::Cap;
use clap::Parser;

/// Refuses memory beyond the limit that the worker sets, which ends the process.
#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, usize::MAX);

/// Scenes from which on it is told whether each key of the schema took part in enough of them: a key that
/// is in 0.75 % of the scenes is counted in less than 0.5 % of so many by chance once in 500 times.
const BROAD: usize = 10_000;

/// Damaged scenes and saved states for the solver.
#[derive(Debug, Parser)]
#[command(version, about)]
struct Arguments {
    /// For how long
    #[arg(long, default_value_t = 10.0)]
    minutes: f64,
    /// What the damage is drawn from; the same number gives the same inputs
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder of the findings
    #[arg(long, default_value = "target/fuzz")]
    out: PathBuf,
    /// Longest time for one input, in seconds
    #[arg(long, default_value_t = 20)]
    seconds: u64,
    /// Memory beyond what the seeds take, in MiB
    #[arg(long, default_value_t = 512)]
    mebibytes: usize,
    /// Draw legal scenes, and run each in several ways that must agree
    #[arg(long)]
    agree: bool,
    /// With `--agree`: how many scenes at most
    #[arg(long, default_value_t = usize::MAX)]
    scenes: usize,
    /// With `--agree`: the one scene to look at, which is written as it was drawn
    #[arg(long)]
    only: Option<usize>,
    /// With `--agree`: how many scenes at once; as many as processors where nothing is said
    #[arg(long)]
    threads: Option<usize>,
    /// With `--agree`: list how often each key of the schema took part
    #[arg(long)]
    keys: bool,
    /// Be the worker
    #[arg(long, hide = true)]
    worker: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.worker {
        return worker::work(&arguments);
    }
    let found = if arguments.agree { agree(&arguments) } else { supervise(&arguments) };
    match found {
        Ok(0) => ExitCode::SUCCESS,
        Ok(_) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs scenes in ways that must agree; returns the number of findings.
fn agree(arguments: &Arguments) -> std::io::Result<usize> {
    std::fs::create_dir_all(&arguments.out)?;
    let processors = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let task = agree::Task {
        scenes: arguments.scenes,
        time: Duration::from_secs_f64(60.0 * arguments.minutes),
        seed: arguments.seed,
        only: arguments.only,
        out: Some(&arguments.out),
        threads: arguments.threads.unwrap_or(processors),
    };
    let (report, findings) = agree::campaign(&task);
    print!("{report}");
    if arguments.keys {
        print!("{}", report.keys());
    }
    // A campaign that is large enough to tell must be broad.
    let narrow = report.scenes >= BROAD && !report.rare().is_empty();
    Ok(findings.len() + usize::from(narrow))
}

/// Runs workers until the time is over; returns the number of findings.
fn supervise(arguments: &Arguments) -> std::io::Result<usize> {
    std::fs::create_dir_all(&arguments.out)?;
    let program = std::env::current_exe()?;
    let end = Instant::now() + Duration::from_secs_f64(60.0 * arguments.minutes);
    let mut seed = arguments.seed;
    let mut died = 0;
    loop {
        let left = end.saturating_duration_since(Instant::now());
        if left < Duration::from_secs(1) {
            break;
        }
        let status = Command::new(&program)
            .arg("--worker")
            .args(["--minutes", &(left.as_secs_f64() / 60.0).to_string()])
            .args(["--seed", &seed.to_string()])
            .args(["--seconds", &arguments.seconds.to_string()])
            .args(["--mebibytes", &arguments.mebibytes.to_string()])
            .arg("--out")
            .arg(&arguments.out)
            .status()?;
        if !status.success() {
            died += 1;
            seed += 1;
            let kept = arguments.out.join(format!("died-{seed}.txt"));
            std::fs::copy(arguments.out.join(worker::IN_HAND), &kept)?;
            eprintln!("the worker died ({status}): {}", kept.display());
        }
    }
    let findings = findings(&arguments.out)?;
    eprintln!("{} findings in {}, {died} of them the worker's end", findings, arguments.out.display());
    Ok(findings)
}

fn findings(folder: &Path) -> std::io::Result<usize> {
    let names = std::fs::read_dir(folder)?.filter_map(Result::ok).map(|entry| entry.file_name());
    Ok(names.filter(|name| name != worker::IN_HAND).count())
}
