//! Errors of the library as Python's exceptions.

use ancf::run::RunError;
use pyo3::exceptions::{PyException, PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::results::Results;

pyo3::create_exception!(
    _ancf,
    SceneError,
    PyValueError,
    "A scene that is not legal: what was found, what is legal, and the place (`file`, `line`, `column`, counted from 1)."
);
pyo3::create_exception!(
    _ancf,
    ComputationError,
    PyException,
    "A computation that found no way on, or not to the accuracy that was wanted. `partial` holds the results until then, or `None`."
);
pyo3::create_exception!(_ancf, SweepError, PyException, "A sweep that could not be done.");

/// A scene that is not legal.
pub fn of_scene(py: Python<'_>, error: &ancf::SceneError) -> PyErr {
    let raised = SceneError::new_err(error.to_string());
    let (file, line, column) = match error.place() {
        Some((file, line, column)) => (Some(file), Some(line), Some(column)),
        None => (None, None, None),
    };
    let value = raised.value(py);
    let set = value
        .setattr("file", file)
        .and_then(|()| value.setattr("line", line))
        .and_then(|()| value.setattr("column", column));
    set.err().unwrap_or(raised)
}

/// A run that failed; scenes whose equations cannot be built are not legal.
pub fn of_run(py: Python<'_>, name: &str, error: RunError) -> PyErr {
    let help = miette::Diagnostic::help(&error).map(|help| format!("\n    {help}")).unwrap_or_default();
    let message = format!("{name}: {error}{help}");
    if let RunError::NoShape { .. } = error {
        return PyValueError::new_err(message);
    }
    if error.exit_status() == 2 {
        let raised = SceneError::new_err(message);
        let value = raised.value(py);
        let set = ["line", "column"].iter().try_for_each(|place| value.setattr(*place, py.None()));
        return set.and_then(|()| value.setattr("file", name)).err().unwrap_or(raised);
    }
    ComputationError::new_err(message)
}

/// An exception with what was computed before it.
pub fn with_partial(py: Python<'_>, raised: PyErr, partial: Option<Results>) -> PyErr {
    raised.value(py).setattr("partial", partial).err().unwrap_or(raised)
}

/// A sweep that could not be done.
pub fn of_sweep(py: Python<'_>, error: &ancf::sweep::SweepError) -> PyErr {
    match error {
        ancf::sweep::SweepError::Scene(error) => of_scene(py, error),
        error => {
            let help =
                miette::Diagnostic::help(error).map(|help| format!("\n    {help}")).unwrap_or_default();
            SweepError::new_err(format!("{error}{help}"))
        }
    }
}

/// Files that cannot be written.
pub fn of_output(error: &ancf::output::OutputError) -> PyErr {
    PyOSError::new_err(error.to_string())
}

/// A structure as JSON.
pub fn json(value: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))
}
