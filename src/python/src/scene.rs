//! Scenes.

use std::path::Path;
use std::sync::Arc;

use ancf::basis::BasisCache;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::errors;
use crate::load::{self, Failed, PythonForce};
use crate::results::Results;
use crate::run::{self, Run, State};

/// A legal scene, with the shape functions that its runs have computed.
#[pyclass(module = "ancf._ancf", frozen)]
pub struct Scene {
    pub(crate) scene: ancf::Scene,
    cache: Arc<BasisCache>,
    /// Forces by functions, which a scene's text does not have.
    forces: Vec<PythonForce>,
}

impl Scene {
    fn new(scene: ancf::Scene) -> Self {
        Self { scene, cache: Arc::default(), forces: Vec::new() }
    }
}

#[pymethods]
impl Scene {
    /// Reads a file, with overrides `PATH=VALUE`.
    #[staticmethod]
    fn load(py: Python<'_>, path: &str, overrides: Vec<String>) -> PyResult<Self> {
        let scene = py.detach(|| ancf::Scene::load(Path::new(path), &overrides));
        scene.map(Self::new).map_err(|error| errors::of_scene(py, &error))
    }

    /// Reads text; `name` stands for the file in messages.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        let scene = py.detach(|| ancf::scene::parse(name, text));
        scene.map(Self::new).map_err(|error| errors::of_scene(py, &error))
    }

    /// The scene with further overrides, which shares what was computed before.
    fn with_overrides(&self, py: Python<'_>, overrides: Vec<String>) -> PyResult<Self> {
        let scene =
            py.detach(|| self.scene.with(&overrides)).map_err(|error| errors::of_scene(py, &error))?;
        let cache = Arc::clone(&self.cache);
        let forces = self.forces.iter().map(|force| force.clone_ref(py)).collect();
        Ok(Self { scene, cache, forces })
    }

    /// The scene of another text, which shares what was computed before.
    fn with_text(&self, py: Python<'_>, text: &str) -> PyResult<Self> {
        let scene = ancf::scene::parse(self.scene.name(), text);
        let scene = scene.map_err(|error| errors::of_scene(py, &error))?;
        let cache = Arc::clone(&self.cache);
        let forces = self.forces.iter().map(|force| force.clone_ref(py)).collect();
        Ok(Self { scene, cache, forces })
    }

    /// The scene with a force at a point that a function gives.
    fn with_force(
        &self,
        py: Python<'_>,
        beam: &str,
        at: f64,
        force: Py<PyAny>,
        derivative: Option<Py<PyAny>>,
        moving: bool,
    ) -> PyResult<Self> {
        let beams = &self.scene.model().beams;
        let Some(index) = beams.iter().position(|known| known.name == beam) else {
            let known: Vec<&str> = beams.iter().map(|beam| beam.name.as_str()).collect();
            return Err(PyKeyError::new_err(format!(
                "there is no beam `{beam}`; the beams are: {}",
                known.join(", ")
            )));
        };
        let mut forces: Vec<_> = self.forces.iter().map(|force| force.clone_ref(py)).collect();
        forces.push(PythonForce::new(ancf::Place::new(index, at), force, derivative, moving));
        Ok(Self { scene: self.scene.clone(), cache: Arc::clone(&self.cache), forces })
    }

    /// The value at a path as JSON; nothing where the scene has none.
    fn value(&self, py: Python<'_>, path: &str) -> PyResult<Option<String>> {
        let value = self.scene.value(path).map_err(|error| errors::of_scene(py, &error))?;
        value.map(|value| errors::json(&value)).transpose()
    }

    /// The text, overrides included.
    #[getter]
    fn text(&self) -> &str {
        self.scene.text()
    }

    /// The name in messages: the file's path.
    #[getter]
    fn name(&self) -> &str {
        self.scene.name()
    }

    /// The names of the stages; none of a scene with one analysis.
    #[getter]
    fn stages(&self) -> Vec<String> {
        self.scene.stages().iter().map(|stage| stage.name.clone()).collect()
    }

    /// `static`, `dynamic`, `modal`, `buckling` or `stages`.
    #[getter]
    fn analysis(&self) -> &'static str {
        self.scene.analysis().kind()
    }

    /// Per beam its name and length in metres.
    #[getter]
    fn beams(&self) -> Vec<(String, f64)> {
        let length =
            |beam: &ancf::Beam| ancf::centreline::Curve::new(&beam.centreline).map_or(0.0, |c| c.length());
        self.scene.model().beams.iter().map(|beam| (beam.name.clone(), length(beam))).collect()
    }

    /// Duration of a motion and the time between its records, in seconds.
    #[getter]
    fn motion(&self) -> Option<(f64, f64)> {
        match self.scene.analysis() {
            ancf::Analysis::Dynamic(motion) => Some((motion.duration, motion.output_every)),
            _ => None,
        }
    }

    /// Number of forces by functions.
    #[getter]
    fn forces(&self) -> usize {
        self.forces.len()
    }

    /// Whether an accuracy chooses what the scene leaves open.
    #[getter]
    fn is_open(&self) -> bool {
        self.scene.accuracy().is_some() && !self.scene.open().is_closed()
    }

    /// What would be built.
    fn inspect(&self, py: Python<'_>) -> PyResult<String> {
        if !self.scene.stages().is_empty() {
            let scene = load::with_forces(py, &self.scene, &self.forces, &Failed::default());
            let inventories = ancf::run::inspect_stages(scene.stages(), ancf::run::inspect)
                .map_err(|error| errors::of_run(py, self.scene.name(), error))?;
            let text = |(name, inventory)| format!("stage {name}\n{inventory}");
            return Ok(inventories.into_iter().map(text).collect::<Vec<_>>().join("\n"));
        }
        let (model, analysis) =
            ancf::accuracy::first(&load::with_forces(py, &self.scene, &self.forces, &Failed::default()));
        let inventory = py.detach(|| ancf::run::inspect(&model, &analysis));
        let inventory = inventory.map_err(|error| errors::of_run(py, self.scene.name(), error))?;
        Ok(inventory.to_string())
    }

    /// Solves it. `tick` is called every tenth of a second, `on_step` after every step, with
    /// (parameter, target, step, Newton iterations); where one returns `False` the run ends there.
    #[pyo3(signature = (*, estimate, start, stage, duration, shapes, pictures, tick, on_step))]
    #[expect(clippy::too_many_arguments, reason = "keywords, given by Python's half alone")]
    fn run(
        &self,
        py: Python<'_>,
        estimate: bool,
        start: Option<PyRef<'_, State>>,
        stage: Option<String>,
        duration: Option<f64>,
        shapes: bool,
        pictures: bool,
        tick: Option<Py<PyAny>>,
        on_step: Option<Py<PyAny>>,
    ) -> PyResult<Results> {
        let start = start.map(|state| Arc::clone(&state.saved));
        let cache = Arc::clone(&self.cache);
        run::solve(
            py,
            &self.scene,
            &self.forces,
            Run { estimate, start, stage, duration, shapes, pictures, tick, on_step, cache },
        )
    }
}
