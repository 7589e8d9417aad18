//! The native half of the Python module `ancf`: the library's scenes, runs, results and sweeps as
//! Python objects.
//!
//! Nothing is decided here. Numbers cross as bytes of doubles, which Python sees as arrays, and
//! small structures as JSON; the names of the field, the arrays and the tables are given in Python,
//! in `src/python/ancf`.

mod errors;
mod load;
mod results;
mod run;
mod scene;
mod sweep;

use pyo3::prelude::*;

/// The native half of `ancf`.
#[pymodule]
mod _ancf {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::errors::{ComputationError, SceneError, SweepError};
    #[pymodule_export]
    use super::results::Results;
    #[pymodule_export]
    use super::run::State;
    #[pymodule_export]
    use super::scene::Scene;
    #[pymodule_export]
    use super::sweep::{Journal, Sweep};
    #[pymodule_export]
    use super::{main, schema};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

/// Runs the command line with the program's name and its arguments; returns the exit status.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| ancf::cli::main(arguments.into_iter().map(Into::into)))
}

/// The JSON schema of scenes.
#[pyfunction]
fn schema() -> PyResult<String> {
    errors::json(&ancf::scene::schema())
}
