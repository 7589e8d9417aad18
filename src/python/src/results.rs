//! Results: numbers as bytes of doubles, small structures as JSON.

use std::path::Path;
use std::sync::Arc;

use ancf::basis::BasisCache;
use ancf::output::{self, OutputOptions, Summary};
use ancf::results::{AnalysisKind, ModeShape, ProbeSample, SectionForces, Shape};
use ancf::run::shapes_at;
use ancf::{Analysis, Results as Solved};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};

use crate::errors;
use crate::run::State;

/// The results of a run, with what was solved.
#[pyclass(module = "ancf._ancf", frozen)]
pub struct Results {
    solved: Solved,
    of: Of,
}

/// What was solved.
pub struct Of {
    pub scene: ancf::Scene,
    pub analysis: Analysis,
    pub cache: Arc<BasisCache>,
}

/// Doubles as bytes that Python may change.
fn doubles<'py>(py: Python<'py>, values: impl IntoIterator<Item = f64>) -> Bound<'py, PyByteArray> {
    let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_ne_bytes).collect();
    PyByteArray::new(py, &bytes)
}

fn of_shape<'py>(py: Python<'py>, shape: &Shape) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    columns.set_item("beam", &shape.beam)?;
    for (name, values) in [
        ("s", &shape.s),
        ("x", &shape.x),
        ("y", &shape.y),
        ("angle", &shape.angle),
        ("strain", &shape.strain),
        ("curvature", &shape.curvature),
        ("N", &shape.axial_force),
        ("Q", &shape.shear_force),
        ("M", &shape.bending_moment),
    ] {
        columns.set_item(name, doubles(py, values.iter().copied()))?;
    }
    if !shape.stress.is_empty() {
        let of_layers = shape.stress.iter().flat_map(|layer| layer.bottom.iter().zip(&layer.top));
        columns.set_item("stress", doubles(py, of_layers.flat_map(|(bottom, top)| [*bottom, *top])))?;
    }
    columns.set_item("nodes", doubles(py, shape.nodes.iter().flatten().copied()))?;
    Ok(columns)
}

fn of_mode<'py>(py: Python<'py>, mode: &ModeShape) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    columns.set_item("beam", &mode.beam)?;
    for (name, values) in [
        ("s", &mode.s),
        ("x", &mode.x),
        ("y", &mode.y),
        ("angle", &mode.angle),
        ("strain", &mode.strain),
        ("curvature", &mode.curvature),
    ] {
        columns.set_item(name, doubles(py, values.iter().copied()))?;
    }
    Ok(columns)
}

fn of_samples<'py>(py: Python<'py>, samples: &[ProbeSample]) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let set = |name: &str, of: &dyn Fn(&ProbeSample) -> f64| {
        columns.set_item(name, doubles(py, samples.iter().map(of)))
    };
    set("x", &|sample| sample.x)?;
    set("y", &|sample| sample.y)?;
    set("angle", &|sample| sample.angle)?;
    set("curvature", &|sample| sample.curvature)?;
    set("strain", &|sample| sample.strain)?;
    if samples.iter().any(|sample| sample.vx.is_some()) {
        set("vx", &|sample| sample.vx.unwrap_or(f64::NAN))?;
        set("vy", &|sample| sample.vy.unwrap_or(f64::NAN))?;
    }
    Ok(columns)
}

impl Results {
    pub fn of(solved: Solved, of: Of) -> Self {
        Self { solved, of }
    }
}

#[pymethods]
impl Results {
    /// `static`, `dynamic`, `modal` or `buckling`.
    #[getter]
    fn analysis(&self) -> &'static str {
        match self.solved.run().analysis {
            AnalysisKind::Static => "static",
            AnalysisKind::Dynamic => "dynamic",
            AnalysisKind::Modal => "modal",
            AnalysisKind::Buckling => "buckling",
        }
    }

    /// Load factors or times.
    fn parameter<'py>(&self, py: Python<'py>) -> Bound<'py, PyByteArray> {
        doubles(py, self.solved.states().parameter.iter().copied())
    }

    /// Names of the probes.
    #[getter]
    fn probes(&self) -> Vec<&str> {
        self.solved.states().probes.iter().map(|probe| probe.name.as_str()).collect()
    }

    /// What probe number `index` sees.
    fn probe<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyDict>> {
        let states = self.solved.states();
        let columns = of_samples(py, states.probes.get(index).map_or(&[], |probe| &probe.samples))?;
        if let Some(series) = states.sections.get(index) {
            let set = |name: &str, of: fn(&SectionForces) -> f64| {
                columns.set_item(name, doubles(py, series.samples.iter().map(of)))
            };
            set("axial_force", |forces| forces.axial_force)?;
            set("shear_force", |forces| forces.shear_force)?;
            set("bending_moment", |forces| forces.bending_moment)?;
            if series.samples.iter().any(|forces| forces.stress_top.is_some()) {
                set("stress_bottom", |forces| forces.stress_bottom.unwrap_or(f64::NAN))?;
                set("stress_top", |forces| forces.stress_top.unwrap_or(f64::NAN))?;
            }
        }
        Ok(columns)
    }

    /// The estimated errors of what it sees, where they are known.
    fn probe_error<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Option<Bound<'py, PyDict>>> {
        let errors = self.solved.run().error.as_ref().and_then(|error| error.probes.get(index));
        errors.map(|errors| of_samples(py, &errors.samples)).transpose()
    }

    /// Energies of the records.
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let energy = &self.solved.states().energy;
        let columns = PyDict::new(py);
        let set = |name: &str, of: fn(&ancf::results::Energy) -> f64| {
            columns.set_item(name, doubles(py, energy.iter().map(of)))
        };
        set("stretch", |e| e.stretch)?;
        set("bend", |e| e.bend)?;
        set("stored", |e| e.stored)?;
        set("kinetic", |e| e.kinetic)?;
        set("potential", |e| e.potential)?;
        set("work", |e| e.work)?;
        set("lost", |e| e.lost)?;
        set("total", ancf::results::Energy::total)?;
        Ok(columns)
    }

    /// Forces of supports and joints, by their names.
    fn reactions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for series in &self.solved.states().reactions {
            let columns = PyDict::new(py);
            columns.set_item("fx", doubles(py, series.samples.iter().map(|r| r.fx)))?;
            columns.set_item("fy", doubles(py, series.samples.iter().map(|r| r.fy)))?;
            columns.set_item("moment", doubles(py, series.samples.iter().map(|r| r.moment)))?;
            all.set_item(&series.name, columns)?;
        }
        Ok(all)
    }

    /// Energies and forces of effects, by their names.
    fn effects<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for series in &self.solved.states().effects {
            let columns = PyDict::new(py);
            let of = |k: usize| doubles(py, series.samples.iter().map(move |sample| sample[k]));
            if series.has_energy {
                columns.set_item("energy", of(0))?;
            }
            columns.set_item("fx", of(1))?;
            columns.set_item("fy", of(2))?;
            all.set_item(&series.name, columns)?;
        }
        Ok(all)
    }

    /// Natural frequencies or critical load factors.
    fn eigenvalues<'py>(&self, py: Python<'py>) -> Bound<'py, PyByteArray> {
        doubles(py, self.solved.eigenvalues())
    }

    /// The shapes that belong to them, each of all beams.
    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Vec<Vec<Bound<'py, PyDict>>>> {
        let modes = self.solved.mode_shapes().into_iter();
        modes.map(|mode| mode.iter().map(|shape| of_mode(py, shape)).collect()).collect()
    }

    /// The last shapes, or those at a load factor or time.
    fn shapes<'py>(&self, py: Python<'py>, at: Option<f64>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let states = self.solved.states();
        let Some(at) = at else { return states.last.iter().map(|shape| of_shape(py, shape)).collect() };
        let Of { scene, analysis, cache } = &self.of;
        if matches!(analysis, Analysis::Modal(_) | Analysis::Buckling(_)) {
            let message = "vibrations and critical loads are about one state: leave the load factor out";
            return Err(pyo3::exceptions::PyValueError::new_err(message));
        }
        if states.states.is_none() {
            let message = "the states of this run were not kept: run(shapes=True) keeps them";
            return Err(errors::ComputationError::new_err(message));
        }
        let shapes = py.detach(|| {
            // What was chosen for an accuracy is in the text that was chosen.
            let chosen = states.run.error.as_ref().and_then(|error| error.chosen.as_deref());
            match chosen.and_then(|text| ancf::scene::parse(scene.name(), text).ok()) {
                Some(mut chosen) => {
                    chosen.add_parts_of(scene);
                    shapes_at(chosen.model(), chosen.analysis(), states, at, Some(cache))
                }
                None => {
                    let model = scene.stages().last().map_or_else(|| scene.model(), |stage| &stage.model);
                    shapes_at(model, analysis, states, at, Some(cache))
                }
            }
        });
        let shapes = shapes.map_err(|error| errors::of_run(py, scene.name(), error))?;
        shapes.iter().map(|shape| of_shape(py, shape)).collect()
    }

    /// The stress-free shapes.
    fn undeformed<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.solved.run().undeformed.iter().map(|shape| of_shape(py, shape)).collect()
    }

    /// Everything that `summary.json` says, as JSON.
    fn summary(&self) -> PyResult<String> {
        Summary::of(&self.solved)
            .to_json()
            .map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))
    }

    /// The scene with what was chosen for an accuracy, which gives the same results.
    #[getter]
    fn chosen(&self) -> Option<&str> {
        self.solved.run().error.as_ref()?.chosen.as_deref()
    }

    /// The state from which a motion can start.
    #[getter]
    fn state(&self) -> Option<State> {
        let saved = self.solved.states().saved.clone()?;
        Some(State { saved: Arc::new(saved) })
    }

    /// The page, with its moving picture.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| output::page(&self.solved)).map_err(|error| errors::of_output(&error))
    }

    /// Writes the files of the command line.
    fn save(&self, py: Python<'_>, directory: &str) -> PyResult<()> {
        let options = self.of.scene.output();
        let options = OutputOptions { states: options.states, vtu: options.vtu };
        let written = py.detach(|| {
            let mut results = self.solved.clone();
            std::fs::create_dir_all(directory).map_err(|source| output::OutputError::Write {
                path: Path::new(directory).to_owned(),
                source,
            })?;
            output::write(Path::new(directory), &mut results, &options)
        });
        written.map(drop).map_err(|error| errors::of_output(&error))
    }
}
