//! The memory that codes take for many elements.
//!
//! A clamped rope hangs under its weight, in equilibrium and in a motion of a few steps. Counted is
//! the peak of the process above what it was before, from the description of the beam to its results,
//! so with the objects that another code's Python interface makes.

use std::path::Path;
use std::process::Command;

use ancf::model::{Discretization, Nodes};
use ancf::scene::Scene;
use ancf_check::Suite;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::{chain, peak};
use crate::{Failure, cost};
use ancf_verification::work::{Code, peer};

/// Elements: so many that what a program needs besides does not count.
const ELEMENTS: usize = 10_000;
/// Analyses and their settings. The steps are short for elements of 6 cm that stretch.
const ANALYSES: [(&str, &str); 2] = [
    ("equilibrium", "analysis={static={steps=1}}"),
    (
        "motion",
        "analysis={dynamic={duration='4 ms', output_every='4 ms', generalized_alpha={step='1 ms', spectral_radius=1.0}}}",
    ),
];
/// Codes with their settings beyond the usual.
const CODES: [(Code, &[(&str, &str)]); 3] =
    [(Code::Ours, &[]), (Code::Exudyn, &[("linear_solver", "EigenSparse")]), (Code::OpenSees, &[])];

/// The memory of a code in an analysis.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Memory {
    /// The code.
    pub code: Code,
    /// The analysis.
    pub analysis: String,
    /// Number of elements.
    pub elements: usize,
    /// Bytes per element, or why they are not known.
    pub bytes: Result<f64, String>,
}

/// Measures and prints all, each in a process of its own: memory that was freed before would be
/// taken again without being counted.
///
/// # Errors
/// Where this program cannot be run; what a code does not solve is said in its entry.
pub fn measure() -> Result<Vec<Memory>, Failure> {
    let program = std::env::current_exe()?;
    let mut all = Vec::new();
    eprintln!("\n{:>12} {:>12} {:>14}", "code", "analysis", "bytes/element");
    for (analysis, _) in ANALYSES {
        for (code, _) in CODES {
            let output =
                Command::new(&program).args(["scaling", "--memory", code.name(), analysis]).output()?;
            let bytes = match String::from_utf8_lossy(&output.stdout).trim().parse::<f64>() {
                Ok(bytes) if output.status.success() => Ok(bytes),
                _ => Err(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
            };
            match &bytes {
                Ok(bytes) => eprintln!("{:>12} {analysis:>12} {bytes:>14.0}", code.name()),
                Err(why) => eprintln!("{:>12} {analysis:>12} {why}", code.name()),
            }
            all.push(Memory { code, analysis: analysis.to_owned(), elements: ELEMENTS, bytes });
        }
    }
    Ok(all)
}

/// Prints the bytes per element that a code takes in an analysis.
///
/// # Errors
/// Where the code or the analysis is not known, is not solved, or the system does not tell.
pub fn print(suite: &Suite, path: &Path, code: &str, analysis: &str) -> Result<bool, Failure> {
    let (_, set) = ANALYSES.iter().find(|(name, _)| *name == analysis).ok_or("an unknown analysis")?;
    let (code, settings) = CODES.iter().find(|(known, _)| known.name() == code).ok_or("an unknown code")?;
    let overrides = [
        "beam.arm.basis={ancf={elements=30, gauss_points={stretch=5, bend=3}}}",
        "support=[{beam='arm', at='start', fix=['x', 'y', 'angle']}]",
        "effect.gravity.acceleration=[9.81, 0.0]",
        set,
    ];
    let scene = Scene::load(path, &overrides.map(str::to_owned))?;
    let discretization = Discretization::Ancf { nodes: Nodes::Uniform(ELEMENTS + 1) };
    let model = chain(scene.model(), ELEMENTS, discretization);
    let settings: IndexMap<String, String> =
        settings.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    if !code.is_ours() {
        cost::further_packages(suite)?;
        // The interpreter and the code are there before the beam is.
        let few = chain(scene.model(), 4, Discretization::Ancf { nodes: Nodes::Uniform(5) });
        peer::solve(*code, (&few, scene.analysis()), &settings, 1)?;
    }
    let before = peak(true);
    match code {
        Code::Ours => drop(model.solve(scene.analysis()).map_err(|e| e.to_string())?),
        other => drop(peer::solve(*other, (&model, scene.analysis()), &settings, 1)?),
    }
    let megabytes = before.zip(peak(false)).map(|(before, after)| after - before);
    let megabytes = megabytes.ok_or("this system does not tell how much memory a process takes")?;
    println!("{}", megabytes * f64::from(1 << 20) / ELEMENTS as f64);
    Ok(true)
}
