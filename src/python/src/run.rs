//! Runs, which let other Python threads go on, and which Ctrl-C ends after a step.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ancf::basis::BasisCache;
use ancf::output::OutputOptions;
use ancf::restart::SavedState;
use ancf::run::{Control, Options, Progress, RunError};
use ancf::scene::Output;
use ancf::{Analysis, Results as Solved, accuracy};
use pyo3::exceptions::{PyKeyError, PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::errors;
use crate::load::{self, Failed, PythonForce};
use crate::results::{Of, Results};

/// How often Python is asked whether somebody wants to end the run, and told how far it is.
const TICK: Duration = Duration::from_millis(100);

/// How a scene is run.
pub struct Run {
    /// Whether errors are estimated of a scene that names its mesh and steps itself.
    pub estimate: bool,
    /// Where a motion begins.
    pub start: Option<Arc<SavedState>>,
    /// The stage whose results are wanted; the last where there is none.
    pub stage: Option<String>,
    /// How long a motion lasts and the time between its records, in place of the scene's.
    pub duration: Option<f64>,
    /// Whether the states are kept from which shapes are made.
    pub shapes: bool,
    /// Whether pictures are kept.
    pub pictures: bool,
    /// Called now and then.
    pub tick: Option<Py<PyAny>>,
    /// Called after every step.
    pub on_step: Option<Py<PyAny>>,
    /// Shape functions of earlier runs.
    pub cache: Arc<BasisCache>,
}

/// A state from which a motion can start.
#[pyclass(module = "ancf._ancf", frozen)]
pub struct State {
    pub saved: Arc<SavedState>,
}

#[pymethods]
impl State {
    /// Reads a `state.json`.
    #[staticmethod]
    fn load(path: &str) -> PyResult<Self> {
        let saved =
            SavedState::load(Path::new(path)).map_err(|error| PyOSError::new_err(error.to_string()))?;
        Ok(Self { saved: Arc::new(saved) })
    }

    /// Writes a `state.json`.
    fn save(&self, path: &str) -> PyResult<()> {
        self.saved.write(Path::new(path)).map_err(|error| PyOSError::new_err(error.to_string()))
    }

    /// Its time in seconds.
    #[getter]
    fn time(&self) -> f64 {
        self.saved.time()
    }
}

/// Solves a scene.
pub fn solve(py: Python<'_>, scene: &ancf::Scene, forces: &[PythonForce], run: Run) -> PyResult<Results> {
    let Run { estimate, start, stage, duration, shapes, pictures, tick, on_step, cache } = run;
    let failed = Failed::default();
    let mut scene = load::with_forces(py, scene, forces, &failed);
    if let Some(name) = stage {
        scene = scene.through(&name).ok_or_else(|| {
            let known: Vec<&str> = scene.stages().iter().map(|stage| stage.name.as_str()).collect();
            PyKeyError::new_err(format!("there is no stage `{name}`; the stages are: {}", known.join(", ")))
        })?;
    }
    // The results are those of the last stage.
    let mut analysis =
        scene.stages().last().map_or_else(|| scene.analysis(), |stage| &stage.analysis).clone();
    if !scene.stages().is_empty() && duration.is_some() {
        return Err(PyValueError::new_err("this scene has stages, and this takes one analysis"));
    }
    match (&mut analysis, duration) {
        (_, None) => {}
        (Analysis::Dynamic(motion), Some(time)) => {
            motion.duration = time;
            // Its start and its end are records, and nothing between.
            let begin = start.as_ref().map_or(0.0, |start| start.time());
            motion.output_every = 2.0 * (begin + time);
        }
        (_, Some(_)) => return Err(PyValueError::new_err("only a motion has a duration")),
    }
    let (mut raised, mut asked, mut ended) = (None, Instant::now(), false);
    let mut observer = |progress: &Progress| {
        let ticks = asked.elapsed() >= TICK;
        if on_step.is_none() && !ticks {
            return Control::Continue;
        }
        let Progress { parameter, target, step, newton_iterations } = *progress;
        let told = Python::attach(|py| -> PyResult<bool> {
            if ticks {
                py.check_signals()?;
            }
            let mut goes_on = true;
            let listeners = [on_step.as_ref(), tick.as_ref().filter(|_| ticks)];
            for listener in listeners.into_iter().flatten() {
                let answer = listener.call1(py, (parameter, target, step, newton_iterations))?;
                goes_on &= !answer.is(&*pyo3::types::PyBool::new(py, false));
            }
            Ok(goes_on)
        });
        if ticks {
            asked = Instant::now();
        }
        match told {
            Ok(true) => Control::Continue,
            Ok(false) => {
                ended = true;
                Control::Stop
            }
            Err(error) => {
                raised = Some(error);
                Control::Stop
            }
        }
    };
    let outcome = py.detach(|| -> Result<Solved, RunError> {
        let defaults = Options::default();
        let options = Options {
            start: start.as_deref(),
            observer: Some(&mut observer),
            cache: Some(&cache),
            states: shapes,
            frames: match scene.output() {
                Output { states: false, vtu: false } if !pictures => 0,
                Output { states, vtu } => OutputOptions { states, vtu }.frames(),
            },
            ..defaults
        };
        match () {
            () if duration.is_some() => scene.model().solve_with(&analysis, options),
            () if estimate && !scene.stages().is_empty() => {
                accuracy::estimate_stages(scene.stages(), options).last()
            }
            () if estimate && scene.accuracy().is_none() => {
                accuracy::estimate(scene.model(), scene.analysis(), options)
            }
            () => accuracy::run(&scene, options),
        }
    });
    // What a function of the user has raised says more than what came of it.
    let raised = failed.take().or(raised);
    let name = scene.name().to_owned();
    let of = |solved| Results::of(solved, Of { scene, analysis, cache });
    let results = match (outcome, raised) {
        (Ok(results), None) => results,
        (Ok(mut results), Some(raised)) => {
            results.run_mut().complete = false;
            return Err(errors::with_partial(py, raised, Some(of(results))));
        }
        (Err(mut error), raised) => {
            let partial = error.take_partial();
            let raised = raised.unwrap_or_else(|| errors::of_run(py, &name, error));
            return Err(errors::with_partial(py, raised, partial.map(of)));
        }
    };
    let missed = results.run().error.as_ref().and_then(|error| error.missed(results.run().analysis));
    let missed = missed.filter(|_| !ended).map(|missed| format!("{name}: {missed}"));
    let results = of(results);
    match missed {
        Some(missed) => {
            Err(errors::with_partial(py, errors::ComputationError::new_err(missed), Some(results)))
        }
        None => Ok(results),
    }
}
