//! `verify`: makes the reference data of the verification cases, and reports how the solver
//! compares with it.

mod accuracy;
mod beside;
mod browser;
mod cost;
mod figures;
mod freeze;
mod instructions;
mod numbers;
mod parallel;
mod report;
mod scaling;

use std::path::PathBuf;
use std::process::ExitCode;

use ancf_check::Suite;
use ancf_verification::Failure;
use clap::{Parser, Subcommand};

/// Verification of ancf against closed forms, publications and other codes.
#[derive(Parser)]
#[command(version, about)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run every case and write index.html and report.json; exit status 1 if any claim does not
    /// hold
    Report {
        /// Folder of the report
        #[arg(short, long, default_value = "target/verification")]
        out: PathBuf,
        /// An earlier report.json: show what has changed; exit status 1 if a digit was lost
        #[arg(long, value_name = "JSON")]
        against: Option<PathBuf>,
        /// Cases; all if none is named
        cases: Vec<String>,
    },
    /// Make reference data from the oracles and write it to reference_data
    Freeze {
        /// Write nothing; exit status 1 if an oracle gives other numbers today
        #[arg(long)]
        check: bool,
        /// Cases; all if none is named
        cases: Vec<String>,
    },
    /// Solve the scenes of some cases by Exudyn too, and print both tips side by side
    Peers {
        /// Cases; those with reference data by a peer if none is named
        cases: Vec<String>,
    },
    /// Measure what accuracy costs, ours and that of other codes in turn, and write tables and diagrams; exit
    /// status 1 if a claim about time does not hold. For numbers that count: a release build, and a
    /// machine that does nothing else
    WorkPrecision {
        /// Leave out the slow settings of other codes
        #[arg(long)]
        quick: bool,
        /// Folder of the results; the report shows those in the default one
        #[arg(short, long, default_value = cost::FOLDER)]
        out: PathBuf,
        /// Problems, files of verification/work-precision; all if none is named
        problems: Vec<String>,
    },
    /// Solve the scenes of the cases with nothing chosen but an accuracy, from 1e-2 to 1e-7, and
    /// hold the estimated errors against the true ones; exit status 1 if too many are wrong
    Accuracy {
        /// Cases; all if none is named
        cases: Vec<String>,
    },
    /// Open the pages of runs, of a cost study and of the report in Chromium and say what is wrong
    /// with them; exit status 1 if anything is. Needs chromium and chromedriver
    Browser {
        /// A report's index.html with report.json beside it; one of some cases is made if none is
        /// named
        #[arg(long, value_name = "HTML")]
        report: Option<PathBuf>,
        /// Damage pages too: every damage must be found out
        #[arg(long)]
        prove: bool,
    },
    /// Compute the numbers that the documents quote; exit status 1 if one of them is false
    Numbers,
    /// Draw the pictures of the documents
    Figures {
        /// Write nothing; exit status 1 if one of them is not what the solver gives today
        #[arg(long)]
        check: bool,
    },
    /// Measure what a time step costs per element, and the memory it takes, from 100 to 100,000
    /// elements
    Scaling {
        /// Print the bytes per element that a code takes in an analysis: a process of its own for each
        #[arg(long, num_args = 2, value_names = ["CODE", "ANALYSIS"], hide = true)]
        memory: Option<Vec<String>>,
    },
    /// Count the instructions of some runs with valgrind, keep them for the report, and compare
    /// them with another build's or the last time's; exit status 1 if a count grew by more than 1 %
    Instructions {
        /// The program of another build
        #[arg(long, value_name = "PROGRAM")]
        against: Option<PathBuf>,
        /// The program `ancf`, with symbols
        program: PathBuf,
    },
}

fn main() -> ExitCode {
    let suite = Suite::here();
    let outcome = match Arguments::parse().command {
        Command::Report { out, against, cases } => report::write(&suite, &out, against.as_deref(), &cases),
        Command::Freeze { check, cases } => freeze::freeze(&suite, &cases, check),
        Command::Peers { cases } => beside::print(&suite, &cases),
        Command::WorkPrecision { quick, out, problems } => cost::print(&suite, &problems, quick, &out),
        Command::Accuracy { cases } => accuracy::print(&suite, &cases),
        Command::Browser { report, prove } => browser::print(&suite, report.as_deref(), prove),
        Command::Numbers => numbers::print(&suite),
        Command::Figures { check } => figures::print(&suite, check),
        Command::Scaling { memory } => match memory.as_deref() {
            Some([code, analysis]) => scaling::print_memory(&suite, code, analysis),
            _ => scaling::print(&suite),
        },
        Command::Instructions { against, program } => {
            instructions::print(&suite, &program, against.as_deref())
        }
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// The named cases, or all; an unknown name is an error.
fn chosen(suite: &Suite, cases: &[String]) -> Result<Vec<String>, Failure> {
    let all = suite.names()?;
    if let Some(unknown) = cases.iter().find(|c| !all.contains(c)) {
        return Err(format!("there is no case `{unknown}`; there are: {}", all.join(", ")).into());
    }
    Ok(if cases.is_empty() { all } else { cases.to_vec() })
}
