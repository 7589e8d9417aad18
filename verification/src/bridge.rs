//! Python inside this process: scripts are loaded once, take JSON and give JSON.
//!
//! JSON keeps every digit (both sides print the shortest text that reads back the same number), and
//! it keeps scripts free of Rust and Rust free of Python's types: a script can be tried at a prompt
//! with the very same text.

use std::ffi::CString;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use ancf_check::Suite;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::Failure;
use crate::python::Python as Environment;

/// A file of `verification/peers/` with a function `answer` from JSON to JSON.
pub struct Script {
    name: &'static str,
    /// `sys.modules` is no place to look whether a script is loaded: threads have raced there.
    answer: PyOnceLock<Py<PyAny>>,
}

impl Script {
    /// The script `verification/peers/<name>.py`.
    pub const fn new(name: &'static str) -> Self {
        Self { name, answer: PyOnceLock::new() }
    }

    /// Its file.
    pub fn path(&self, suite: &Suite) -> PathBuf {
        suite.peers_folder().join(format!("{}.py", self.name))
    }

    /// What the script answers to a question.
    ///
    /// # Errors
    /// Where Python or its packages cannot be had, and what the script raises.
    pub fn ask<Q: Serialize, A: DeserializeOwned>(&self, question: &Q) -> Result<A, Failure> {
        let environment = environment()?;
        let question = serde_json::to_string(question)?;
        let answer = Python::attach(|py| -> Result<String, Failure> {
            let answer = self.answer.get_or_try_init(py, || self.load(py, environment))?;
            Ok(answer
                .bind(py)
                .call1((question,))
                .and_then(|text| text.extract())
                .map_err(|e| told(py, &e))?)
        })?;
        Ok(serde_json::from_str(&answer)?)
    }

    fn load(&self, py: Python<'_>, environment: &Environment) -> Result<Py<PyAny>, Failure> {
        let facts = &environment.facts;
        let here: String = py.import("platform")?.call_method0("python_version")?.extract()?;
        if here != facts.python {
            return Err(format!(
                "this program is linked to Python {here}, but the environment's is {}; build it again",
                facts.python
            )
            .into());
        }
        let places = py.import("sys")?.getattr("path")?;
        if !places.contains(&facts.site_packages)? {
            // First, so that the pinned packages count and not what the machine has.
            places.call_method1("insert", (0, &facts.site_packages))?;
        }
        let path = self.path(&Suite::here());
        let code = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let file = CString::new(path.to_string_lossy().as_bytes())?;
        let module = PyModule::from_code(py, &CString::new(code)?, &file, &CString::new(self.name)?)
            .map_err(|e| told(py, &e))?;
        Ok(module.getattr("answer")?.unbind())
    }
}

/// The environment, made once in this process.
///
/// # Errors
/// Where it cannot be made; the message says what to install.
pub fn environment() -> Result<&'static Environment, Failure> {
    static ENVIRONMENT: OnceLock<Result<Environment, String>> = OnceLock::new();
    let made = ENVIRONMENT.get_or_init(|| Environment::prepare(&Suite::here()).map_err(|e| e.to_string()));
    made.as_ref().map_err(|message| message.clone().into())
}

/// An exception with the line of the script where it was raised.
fn told(py: Python<'_>, error: &PyErr) -> String {
    let trace = error.traceback(py).and_then(|t| t.format().ok()).unwrap_or_default();
    let place = trace.lines().rev().find_map(|line| {
        let (file, rest) = line.trim().strip_prefix("File \"")?.split_once('"')?;
        let number = rest.strip_prefix(", line ")?.split(',').next()?;
        Some(format!(" ({}:{number})", Path::new(file).file_name()?.to_string_lossy()))
    });
    format!("{}{}", error.value(py), place.unwrap_or_default())
}
