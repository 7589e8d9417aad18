//! `verify scaling`: what a time step costs per element as elements become many, and the memory
//! that it takes.

use std::path::Path;
use std::time::{Duration, Instant};

use ancf::model::{Centreline, Discretization, Nodes};
use ancf::run::{Control, Options, Progress};
use ancf::scene::Scene;
use ancf_check::Suite;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::report::{machine, now};

/// Where the results are written, and where the report looks for them, from the root of the
/// repository.
pub const FILE: &str = "target/verification/scaling.json";

/// Elements of 6 cm, hanging from one end.
const ELEMENTS: [usize; 4] = [100, 1_000, 10_000, 100_000];
/// Steps of 1 ms, of which those after the first few are measured: what comes before belongs to no
/// step, and with many elements the operating system takes as long as 10 steps to clear the memory
/// that is touched for the first time. A motion is repeated until this much time has gone.
const STEPS: usize = 40;
const FIRST: usize = 10;
const LEAST: Duration = Duration::from_secs(2);

/// One day's measurement.
#[derive(Deserialize, Serialize)]
pub struct Scaling {
    /// Day and time.
    pub date: String,
    /// Processor and system.
    pub machine: String,
    /// From few elements to many.
    pub rows: Vec<Row>,
}

/// A number of elements.
#[derive(Deserialize, Serialize)]
pub struct Row {
    /// Number of elements.
    pub elements: usize,
    /// Shortest time of a step, per element \[s\].
    pub seconds: f64,
    /// Shortest time until the first step is done, the system's construction included, per element
    /// \[s\].
    pub start: f64,
    /// Peak memory of the process above that before the run \[MB\], where the system tells.
    pub megabytes: Option<f64>,
    /// Iterations a step.
    pub iterations: f64,
}

/// Measures, prints and writes.
pub fn print(suite: &Suite) -> Result<bool, Failure> {
    let scene = suite.root.join("verification/cases/soft-pendulum/scene.toml");
    let set = [
        "beam.arm.basis={ancf={elements=30}}".to_owned(),
        format!(
            "analysis.dynamic={{duration=\"{STEPS} ms\", output_every=\"{STEPS} ms\", \
             generalized_alpha={{step=\"1 ms\", spectral_radius=1.0}}}}"
        ),
    ];
    let scene = Scene::load(&scene, &set).map_err(|e| e.to_string())?;
    let mut result = Scaling { date: now(), machine: machine(), rows: Vec::new() };
    eprintln!(
        "{:>9} {:>16} {:>17} {:>8} {:>17}",
        "elements", "µs/element/step", "µs/element before", "MB", "iterations a step"
    );
    for elements in ELEMENTS {
        let mut model = scene.model().clone();
        model.beams[0].centreline = Centreline::Line { start: [0.0; 2], end: [0.06 * elements as f64, 0.0] };
        model.beams[0].discretization = Discretization::Ancf { nodes: Nodes::Uniform(elements + 1) };
        model.probes.clear();
        let before = peak(true);
        let [mut step, mut start] = [f64::INFINITY; 2];
        let mut iterations = 0.0;
        let begin = Instant::now();
        while begin.elapsed() < LEAST {
            let (mut ends, clock) = (Vec::with_capacity(STEPS), Instant::now());
            let observer = &mut |progress: &Progress| {
                ends.push((Instant::now(), progress.newton_iterations));
                Control::Continue
            };
            let options = Options { observer: Some(observer), ..Options::default() };
            model.solve_with(scene.analysis(), options).map_err(|e| e.to_string())?;
            let (Some(&(first, _)), Some(&(from, before)), Some(&(to, after))) =
                (ends.first(), ends.get(FIRST - 1), ends.last())
            else {
                return Err("the beam that is measured did not move".into());
            };
            let steps = (ends.len() - FIRST) as f64;
            start = start.min((first - clock).as_secs_f64());
            step = step.min((to - from).as_secs_f64() / steps);
            iterations = (after - before) as f64 / steps;
        }
        let row = Row {
            elements,
            seconds: step / elements as f64,
            start: start / elements as f64,
            megabytes: before.zip(peak(false)).map(|(before, peak)| peak - before),
            iterations,
        };
        let megabytes = row.megabytes.map_or("–".to_owned(), |m| format!("{m:.0}"));
        eprintln!(
            "{elements:>9} {:>16.3} {:>17.3} {megabytes:>8} {:>17.1}",
            1e6 * row.seconds,
            1e6 * row.start,
            row.iterations
        );
        result.rows.push(row);
    }
    let file = suite.root.join(FILE);
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    std::fs::write(&file, serde_json::to_string_pretty(&result)?)
        .map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(true)
}

/// The last measurement, if there is one.
pub fn read(file: &Path) -> Result<Option<Scaling>, Failure> {
    if !file.exists() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(Some(serde_json::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?))
}

/// Peak resident memory \[MB\] where the system tells; with `reset` that of now, from which it
/// counts anew.
fn peak(reset: bool) -> Option<f64> {
    if reset {
        std::fs::write("/proc/self/clear_refs", "5").ok()?;
    }
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}
