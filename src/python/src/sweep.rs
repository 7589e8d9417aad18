//! Sweeps: runs that any process may compute, and the journal in which one process records them.

use std::path::{Path, PathBuf};

use ancf::sweep::{self, Axis, Grid, Recorder, Runs, Shard};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

use crate::errors;
use crate::scene::Scene;

fn grid(py: Python<'_>, axes: Vec<(Vec<String>, Vec<Vec<String>>)>) -> PyResult<Grid> {
    let axes = axes.into_iter().map(|(paths, values)| Axis { paths, values, lines: sweep::Lines::default() });
    Grid::new(axes.collect()).map_err(|error| errors::of_sweep(py, &error))
}

/// The runs of a sweep.
#[pyclass(module = "ancf._ancf", frozen)]
pub struct Sweep {
    runs: Runs,
}

#[pymethods]
impl Sweep {
    /// The runs of a scene over the product of axes, each of paths with the texts that they take.
    #[new]
    fn new(
        py: Python<'_>,
        scene: PyRef<'_, Scene>,
        axes: Vec<(Vec<String>, Vec<Vec<String>>)>,
    ) -> PyResult<Self> {
        Ok(Self { runs: Runs::new(scene.scene.clone(), grid(py, axes)?) })
    }

    /// Refuses it where the scene of a run is not legal.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.runs.check()).map_err(|error| errors::of_sweep(py, &error))
    }

    /// Number of runs.
    fn __len__(&self) -> usize {
        self.runs.grid().runs()
    }

    /// Computes runs, numbered from 1: their lines of the journal.
    fn compute(&self, py: Python<'_>, numbers: Vec<usize>) -> PyResult<Vec<String>> {
        let most = self.runs.grid().runs();
        if let Some(wrong) = numbers.iter().find(|number| !(1..=most).contains(*number)) {
            return Err(PyValueError::new_err(format!("the runs are 1 to {most}, found {wrong}")));
        }
        Ok(py.detach(|| numbers.into_iter().map(|number| self.runs.line(number)).collect()))
    }
}

/// The journal of a sweep in a directory, open for this process.
#[pyclass(module = "ancf._ancf", frozen)]
pub struct Journal {
    directory: PathBuf,
    recorder: Mutex<Option<Recorder>>,
}

#[pymethods]
impl Journal {
    /// Makes a directory that of a sweep, or goes on with it.
    #[new]
    fn new(py: Python<'_>, sweep: PyRef<'_, Sweep>, directory: &str) -> PyResult<Self> {
        let directory = Path::new(directory).to_owned();
        std::fs::create_dir_all(&directory)?;
        let recorder = Recorder::open(&sweep.runs, &directory, Shard::WHOLE);
        let recorder = recorder.map_err(|error| errors::of_sweep(py, &error))?;
        Ok(Self { directory, recorder: Mutex::new(Some(recorder)) })
    }

    /// The numbers of the runs that are left.
    fn missing(&self) -> Vec<usize> {
        let recorder = self.recorder.lock().unwrap_or_else(PoisonError::into_inner);
        recorder.as_ref().map_or_else(Vec::new, Recorder::missing)
    }

    /// Records lines that a worker has computed; lines of runs that are recorded already are left
    /// out. Returns how many were new.
    fn enter(&self, py: Python<'_>, lines: Vec<String>) -> PyResult<usize> {
        let mut recorder = self.recorder.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(recorder) = recorder.as_mut() else {
            return Err(PyValueError::new_err("the journal is closed"));
        };
        let mut new = 0;
        for line in &lines {
            new += usize::from(recorder.enter(line).map_err(|error| errors::of_sweep(py, &error))?);
        }
        Ok(new)
    }

    /// Closes it, so that another process may go on.
    fn close(&self) {
        *self.recorder.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Writes the table of a complete sweep: its path, and the runs that were not solved, and those with warnings.
    fn merge(&self, py: Python<'_>) -> PyResult<(PathBuf, Vec<usize>, Vec<usize>)> {
        let merged =
            py.detach(|| sweep::merge(&self.directory)).map_err(|error| errors::of_sweep(py, &error))?;
        Ok((merged.table, merged.unsolved, merged.warned))
    }
}
