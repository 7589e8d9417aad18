//! `verify scaling`: what a time step costs per element as elements become many, the memory that it
//! takes, and what the machine would need at least.

mod floor;
mod memory;

use std::path::Path;
use std::time::{Duration, Instant};

use ancf::model::{Analysis, Centreline, Discretization, Dynamic, Integrator, Model, Nodes};
use ancf::run::{Control, Options, Progress};
use ancf::scene::Scene;
use ancf_check::Suite;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::report::{machine, now};

/// Where the results are written, and where the report looks for them, from the root of the
/// repository.
pub const FILE: &str = "target/verification/scaling.json";

pub use floor::{Count, Machine};
pub use memory::Memory;

/// The beam and its load.
const SCENE: &str = "verification/cases/soft-pendulum/scene.toml";
/// Elements of 6 cm, hanging from one end.
const ELEMENTS: [usize; 4] = [100, 1_000, 10_000, 100_000];
/// Steps of 1 ms, of which those after the first few are measured: what comes before belongs to no
/// step, and with many elements the operating system takes as long as 10 steps to clear the memory
/// that is touched for the first time. A motion is repeated until this much time has gone.
const STEPS: usize = 40;
const FIRST: usize = 10;
const LEAST: Duration = Duration::from_secs(2);
/// Chains of so many elements are worked on by several threads.
const SEVERAL_THREADS: usize = 20_000;
/// Elements whose numbers stay in the caches.
const IN_CACHE: usize = 100;
/// One thread and two take turns so often.
const TURNS: usize = 3;
/// Newton's tolerance with which steps take fewer iterations.
const LOOSE: f64 = 1e-7;

/// One day's measurement.
#[derive(Deserialize, Serialize)]
pub struct Scaling {
    /// Day and time.
    pub date: String,
    /// Processor and system.
    pub machine: String,
    /// From few elements to many.
    pub rows: Vec<Row>,
    /// What one thread of the machine does at best.
    #[serde(default)]
    pub best: Machine,
    /// Iterations and steps beside what the machine does at best.
    #[serde(default)]
    pub floors: Vec<Floor>,
    /// Memory of several codes.
    #[serde(default)]
    pub memory: Vec<Memory>,
}

/// An iteration or a step of a beam whose numbers stay in the caches.
#[derive(Deserialize, Serialize)]
pub struct Floor {
    /// The beam.
    pub beam: String,
    /// What is timed.
    pub what: String,
    /// Operations per node.
    pub operations: f64,
    /// Time per node \[s\].
    pub seconds: f64,
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
    /// Bytes that a step moves per element, if no cache holds anything.
    #[serde(default)]
    pub bytes: f64,
    /// The time of a step by one thread, in that by two, in turn; for chains that are long enough for
    /// several.
    #[serde(default)]
    pub two_threads: Option<f64>,
}

/// Prints the bytes per element that a code takes in an analysis.
pub fn print_memory(suite: &Suite, code: &str, analysis: &str) -> Result<bool, Failure> {
    memory::print(suite, &suite.root.join(SCENE), code, analysis)
}

/// Measures, prints and writes.
pub fn print(suite: &Suite) -> Result<bool, Failure> {
    let path = suite.root.join(SCENE);
    let motion = format!(
        "analysis.dynamic={{duration=\"{STEPS} ms\", output_every=\"{STEPS} ms\", \
         generalized_alpha={{step=\"1 ms\", spectral_radius=1.0}}}}"
    );
    let scene = Scene::load(&path, &["beam.arm.basis={ancf={elements=30}}".to_owned(), motion.clone()])?;
    let best = Machine::measure();
    let mut result = Scaling {
        date: now(),
        machine: machine(),
        rows: Vec::new(),
        best,
        floors: Vec::new(),
        memory: Vec::new(),
    };
    eprintln!(
        "{:>9} {:>16} {:>17} {:>8} {:>17} {:>18} {:>9} {:>11}",
        "elements",
        "µs/element/step",
        "µs/element before",
        "MB",
        "iterations a step",
        "bytes/element/step",
        "of stream",
        "two threads"
    );
    for elements in ELEMENTS {
        let discretization = Discretization::Ancf { nodes: Nodes::Uniform(elements + 1) };
        let model = chain(scene.model(), elements, discretization);
        let before = peak(true);
        let Timed { step, start, iterations } = by_threads(1, &model, scene.analysis())?;
        let megabytes = before.zip(peak(false)).map(|(before, peak)| peak - before);
        let several = elements >= SEVERAL_THREADS;
        let two_threads = several.then(|| gain_of_two(&model, scene.analysis())).transpose()?;
        let row = Row {
            elements,
            seconds: step / elements as f64,
            start: start / elements as f64,
            megabytes,
            iterations,
            bytes: floor::work(&model.beams[0]).map_or(0.0, |work| work.step(iterations).bytes),
            two_threads,
        };
        let megabytes = row.megabytes.map_or("–".to_owned(), |m| format!("{m:.0}"));
        eprintln!(
            "{elements:>9} {:>16.3} {:>17.3} {megabytes:>8} {:>17.1} {:>18.0} {:>9.2} {:>11}",
            1e6 * row.seconds,
            1e6 * row.start,
            row.iterations,
            row.bytes,
            row.of_stream(best),
            row.gain()
        );
        result.rows.push(row);
    }
    for (name, basis) in [
        ("cable elements", format!("{{ancf={{elements={IN_CACHE}}}}}")),
        ("radial point interpolation", format!("{{rpim={{nodes={}}}}}", IN_CACHE + 1)),
    ] {
        let scene = Scene::load(&path, &[format!("beam.arm.basis={basis}"), motion.clone()])?;
        let discretization = scene.model().beams[0].discretization.clone();
        let model = chain(scene.model(), IN_CACHE, discretization);
        result.floors.extend(floors(name, &model, scene.analysis())?);
    }
    eprintln!(
        "\n{:.1} GB/s, {:.1} operations a nanosecond at best",
        1e-9 * best.bytes,
        1e-9 * best.operations
    );
    for Floor { beam, what, operations, seconds } in &result.floors {
        let share = operations / (best.operations * seconds);
        eprintln!(
            "{beam}, {what}: {operations:.0} operations a node in {:.1} ns, {share:.2} of the best",
            1e9 * seconds
        );
    }
    result.memory = memory::measure()?;
    let file = suite.root.join(FILE);
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    std::fs::write(&file, serde_json::to_string_pretty(&result)?)
        .map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(true)
}

/// The beam of `model` with so many elements of 6 cm.
fn chain(model: &Model, elements: usize, discretization: Discretization) -> Model {
    let mut model = model.clone();
    model.beams[0].centreline = Centreline::Line { start: [0.0; 2], end: [0.06 * elements as f64, 0.0] };
    model.beams[0].discretization = discretization;
    model.probes.clear();
    model
}

/// The shortest times of a motion.
struct Timed {
    /// Of a step \[s\].
    step: f64,
    /// Until the first step is done \[s\].
    start: f64,
    /// Iterations a step.
    iterations: f64,
}

/// The times of so many threads.
fn by_threads(threads: usize, model: &Model, analysis: &Analysis) -> Result<Timed, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    Ok(pool.install(|| time(model, analysis).map_err(|error| error.to_string()))?)
}

/// How many times as fast two threads are as one, which take turns.
fn gain_of_two(model: &Model, analysis: &Analysis) -> Result<f64, Failure> {
    let mut shortest = [f64::INFINITY; 2];
    for _ in 0..TURNS {
        for (threads, shortest) in [1, 2].into_iter().zip(&mut shortest) {
            *shortest = shortest.min(by_threads(threads, model, analysis)?.step);
        }
    }
    Ok(shortest[0] / shortest[1])
}

fn time(model: &Model, analysis: &Analysis) -> Result<Timed, Failure> {
    let mut timed = Timed { step: f64::INFINITY, start: f64::INFINITY, iterations: 0.0 };
    let begin = Instant::now();
    while begin.elapsed() < LEAST {
        let (mut ends, clock) = (Vec::with_capacity(STEPS), Instant::now());
        let observer = &mut |progress: &Progress| {
            ends.push((Instant::now(), progress.newton_iterations));
            Control::Continue
        };
        let options = Options { observer: Some(observer), ..Options::default() };
        model.solve_with(analysis, options).map_err(|e| e.to_string())?;
        let (Some(&(first, _)), Some(&(from, before)), Some(&(to, after))) =
            (ends.first(), ends.get(FIRST - 1), ends.last())
        else {
            return Err("the beam that is measured did not move".into());
        };
        let steps = (ends.len() - FIRST) as f64;
        timed.start = timed.start.min((first - clock).as_secs_f64());
        timed.step = timed.step.min((to - from).as_secs_f64() / steps);
        timed.iterations = (after - before) as f64 / steps;
    }
    Ok(timed)
}

/// A step of a beam, and an iteration: the difference that the last iterations make.
fn floors(beam: &str, model: &Model, analysis: &Analysis) -> Result<[Floor; 2], Failure> {
    let nodes = model.beams[0].discretization.nodes().count() as f64;
    let work = floor::work(&model.beams[0]).ok_or("the discretisation has no count of operations")?;
    let usual = time(model, analysis)?;
    let mut loose = analysis.clone();
    if let Analysis::Dynamic(Dynamic {
        integrator: Integrator::GeneralizedAlpha { newton_tolerance, .. },
        ..
    }) = &mut loose
    {
        *newton_tolerance = LOOSE;
    }
    let fewer = time(model, &loose)?;
    let iteration = (usual.step - fewer.step) / (usual.iterations - fewer.iterations);
    let floor = |what: &str, Count { operations, .. }, seconds: f64| Floor {
        beam: beam.to_owned(),
        what: what.to_owned(),
        operations,
        seconds: seconds / nodes,
    };
    Ok([
        floor("a step", work.step(usual.iterations), usual.step),
        floor("an iteration", work.iteration, iteration),
    ])
}

impl Row {
    /// How many times as fast two threads are, in words.
    pub fn gain(&self) -> String {
        self.two_threads.map_or("–".to_owned(), |gain| format!("{gain:.2} ×"))
    }

    /// The time in which the machine could move the bytes of a step, as a part of that it takes.
    pub fn of_stream(&self, best: Machine) -> f64 {
        self.bytes / (best.bytes * self.seconds)
    }
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
