//! The memory that codes take for many elements.
//!
//! A clamped rope hangs under its weight, in equilibrium and in a motion of a few steps. Counted is
//! the peak of the process above what it was before, from the description of the beam to its results,
//! so with the objects that another code's Python interface makes.

use std::path::Path;

use ancf::model::{Discretization, Nodes};
use ancf::scene::Scene;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::{chain, peak};
use crate::Failure;
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

/// Measures and prints all.
///
/// # Errors
/// Where the scene cannot be read; what a code does not solve is said in its entry.
pub fn measure(path: &Path) -> Result<Vec<Memory>, Failure> {
    let mut all = Vec::new();
    eprintln!("\n{:>12} {:>12} {:>14}", "code", "analysis", "bytes/element");
    for (analysis, set) in ANALYSES {
        let overrides = [
            "beam.arm.basis={ancf={elements=30, gauss_points={stretch=5, bend=3}}}",
            "support=[{beam='arm', at='start', fix=['x', 'y', 'angle']}]",
            "effect.gravity.acceleration=[9.81, 0.0]",
            set,
        ];
        let scene = Scene::load(path, &overrides.map(str::to_owned))?;
        let discretization = Discretization::Ancf { nodes: Nodes::Uniform(ELEMENTS + 1) };
        let model = chain(scene.model(), ELEMENTS, discretization);
        for (code, settings) in CODES {
            let settings: IndexMap<String, String> =
                settings.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
            let before = peak(true);
            let solved = match code {
                Code::Ours => model.solve(scene.analysis()).map(drop).map_err(|e| e.to_string()),
                other => peer::solve(other, (&model, scene.analysis()), &settings, 1)
                    .map(drop)
                    .map_err(|e| e.to_string()),
            };
            let megabytes = before.zip(peak(false)).map(|(before, after)| after - before);
            let bytes = solved.and_then(|()| {
                let megabytes = megabytes.ok_or_else(|| "this system does not tell it".to_owned())?;
                Ok(megabytes * f64::from(1 << 20) / ELEMENTS as f64)
            });
            match &bytes {
                Ok(bytes) => eprintln!("{:>12} {analysis:>12} {bytes:>14.0}", code.name()),
                Err(why) => eprintln!("{:>12} {analysis:>12} {why}", code.name()),
            }
            all.push(Memory { code, analysis: analysis.to_owned(), elements: ELEMENTS, bytes });
        }
    }
    Ok(all)
}
