//! Forces that a Python function gives.

use std::sync::{Arc, Mutex, PoisonError};

use ancf::Place;
use ancf::assembly::{Assembly, BuildError, Density, Dissipation, Extent, Gradient, Hessian, Kind, Part};
use nalgebra::{Matrix2, Vector2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Step by which functions without a derivative are differenced, relative to the size of the
/// argument and to one.
const DIFFERENCE: f64 = 1e-6;

/// What a function has raised.
#[derive(Clone, Debug, Default)]
pub struct Failed(Arc<Mutex<Option<PyErr>>>);

impl Failed {
    /// The first exception.
    pub fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn note(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// A force and a couple at a point of a beam as a function of x, y and the angle there, or of their
/// rates, too.
#[derive(Debug)]
pub struct PythonForce {
    at: Place,
    force: Py<PyAny>,
    derivative: Option<Py<PyAny>>,
    moving: bool,
}

impl PythonForce {
    pub fn new(at: Place, force: Py<PyAny>, derivative: Option<Py<PyAny>>, moving: bool) -> Self {
        Self { at, force, derivative, moving }
    }

    pub fn clone_ref(&self, py: Python<'_>) -> Self {
        let derivative = self.derivative.as_ref().map(|derivative| derivative.clone_ref(py));
        Self { at: self.at, force: self.force.clone_ref(py), derivative, moving: self.moving }
    }

    /// The part of a model; what the function raises is noted in `failed`.
    pub fn part(&self, py: Python<'_>, failed: &Failed) -> PythonPart {
        let function = Function { force: Arc::new(self.clone_ref(py)), failed: failed.clone() };
        PythonPart { at: self.at, moving: self.moving, function }
    }
}

/// The scene with its forces; what their functions raise is noted in `failed`.
pub fn with_forces(
    py: Python<'_>,
    scene: &ancf::Scene,
    forces: &[PythonForce],
    failed: &Failed,
) -> ancf::Scene {
    let mut scene = scene.clone();
    for force in forces {
        scene.add(force.part(py, failed));
    }
    scene
}

/// The function with where its exceptions go.
#[derive(Clone, Debug)]
struct Function {
    force: Arc<PythonForce>,
    failed: Failed,
}

/// A force by a function as a part of a model.
#[derive(Debug)]
pub struct PythonPart {
    at: Place,
    moving: bool,
    function: Function,
}

impl Part for PythonPart {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let (kind, extent) = (Kind::Other("python_force"), Extent::Point(self.at));
        let function = || self.function.clone();
        if self.moving {
            assembly.damping(kind, extent, |_: Vec<[Vector2<f64>; 2]>| Resisting(function()))
        } else {
            assembly.load(kind, extent, None, |_: Vec<[Vector2<f64>; 2]>| Acting(function()))
        }
    }

    fn point(&self) -> Option<Place> {
        Some(self.at)
    }

    fn couple(&self) -> Option<Place> {
        Some(self.at)
    }
}

type Force = [f64; 3];

impl Function {
    /// (fx, fy, couple) for the arguments; no numbers once the function has failed.
    fn call(&self, arguments: &[f64]) -> Force {
        let called = Python::attach(|py| -> PyResult<Force> {
            let arguments = pyo3::types::PyTuple::new(py, arguments)?;
            three(self.force.force.bind(py).call1(arguments)?.as_any())
        });
        called.unwrap_or_else(|error| {
            self.failed.note(error);
            [f64::NAN; 3]
        })
    }

    /// The derivatives of (fx, fy, couple) by the arguments from number `first` on.
    fn derivative(&self, arguments: &[f64], first: usize) -> Vec<Force> {
        if let Some(derivative) = &self.force.derivative {
            let called = Python::attach(|py| -> PyResult<Vec<Force>> {
                let tuple = pyo3::types::PyTuple::new(py, arguments)?;
                let rows = derivative.bind(py).call1(tuple)?;
                let rows: Vec<Vec<f64>> = rows.extract().map_err(|_| {
                    PyTypeError::new_err(
                        "a derivative returns rows of numbers: of fx, of fy and, where the force has a couple, of it, each with as many \
                         entries as there are arguments to differentiate by",
                    )
                })?;
                let wanted = arguments.len() - first;
                if !(2..=3).contains(&rows.len()) || rows.iter().any(|row| row.len() != wanted) {
                    let found: Vec<usize> = rows.iter().map(Vec::len).collect();
                    return Err(PyValueError::new_err(format!(
                        "a derivative returns 2 or 3 rows of {wanted} numbers, found rows of {found:?}"
                    )));
                }
                if !rows.iter().flatten().all(|number| number.is_finite()) {
                    return Err(PyValueError::new_err(format!(
                        "a derivative returned {rows:?}, which are no derivatives of forces"
                    )));
                }
                let entry = |row: usize, column: usize| rows.get(row).map_or(0.0, |row| row[column]);
                Ok((0..wanted).map(|column| [0, 1, 2].map(|row| entry(row, column))).collect())
            });
            return called.unwrap_or_else(|error| {
                self.failed.note(error);
                vec![[f64::NAN; 3]; arguments.len() - first]
            });
        }
        (first..arguments.len())
            .map(|index| {
                let step = DIFFERENCE * arguments[index].abs().max(1.0);
                let at = |change: f64| {
                    let mut there = arguments.to_vec();
                    there[index] += change;
                    self.call(&there)
                };
                let [ahead, behind] = [at(step), at(-step)];
                [0, 1, 2].map(|i| (ahead[i] - behind[i]) / (2.0 * step))
            })
            .collect()
    }
}

/// Two or three finite numbers.
fn three(answer: &Bound<'_, PyAny>) -> PyResult<Force> {
    let numbers: Vec<f64> = answer.extract().map_err(|_| {
        PyTypeError::new_err("a force function returns (fx, fy) or (fx, fy, couple) in N and N m")
    })?;
    if !(2..=3).contains(&numbers.len()) {
        let found = numbers.len();
        return Err(PyValueError::new_err(format!(
            "a force function returns (fx, fy) or (fx, fy, couple), found {found} numbers"
        )));
    }
    match numbers.iter().all(|number| number.is_finite()) {
        true => Ok([numbers[0], numbers[1], numbers.get(2).copied().unwrap_or(0.0)]),
        false => {
            Err(PyValueError::new_err(format!("a force function returned {numbers:?}, which are no forces")))
        }
    }
}

/// J r'/|r'|², by which a couple acts on r', and its derivative by r'.
fn couple(gradient: &Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>) {
    let (x, y, square) = (gradient.x, gradient.y, gradient.norm_squared());
    let direction = Vector2::new(-y, x) / square;
    let (a, b) = ((x * x - y * y) / square / square, 2.0 * x * y / square / square);
    (direction, Matrix2::new(b, -a, -a, -b))
}

/// A force of positions, as a density of its negative work.
struct Acting(Function);

impl Density<2> for Acting {
    const ORDERS: [usize; 2] = [0, 1];
    const SYMMETRIC: bool = false;
    const CONSERVATIVE: bool = false;

    fn energy(&self, _: usize, _: &Gradient<2>) -> f64 {
        0.0
    }

    fn gradient(&self, _: usize, [r, d]: &Gradient<2>) -> Gradient<2> {
        let [x, y, m] = self.0.call(&[r.x, r.y, d.y.atan2(d.x)]);
        [-Vector2::new(x, y), -couple(d).0 * m]
    }

    fn gradient_and_hessian(
        &self,
        _: usize,
        [r, d]: &Gradient<2>,
        _: &Gradient<2>,
        _: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let arguments = [r.x, r.y, d.y.atan2(d.x)];
        let [x, y, m] = self.0.call(&arguments);
        let by = self.0.derivative(&arguments, 0);
        let (direction, change) = couple(d);
        let force = |k: usize| Vector2::new(by[k][0], by[k][1]);
        // dθ = (J r'/|r'|²) · dr'.
        let by_position = Matrix2::from_columns(&[force(0), force(1)]);
        let by_gradient = force(2) * direction.transpose();
        let couple_by_position = direction * Vector2::new(by[0][2], by[1][2]).transpose();
        let couple_by_gradient = direction * direction.transpose() * by[2][2] + change * m;
        (
            [-Vector2::new(x, y), -direction * m],
            [[-by_position, -by_gradient], [-couple_by_position, -couple_by_gradient]],
        )
    }
}

/// A force of positions and velocities.
struct Resisting(Function);

impl Resisting {
    fn arguments([r, d]: &Gradient<2>, [v, rate]: &Gradient<2>) -> [f64; 6] {
        [r.x, r.y, d.y.atan2(d.x), v.x, v.y, couple(d).0.dot(rate)]
    }
}

impl Dissipation<2> for Resisting {
    const ORDERS: [usize; 2] = [0, 1];

    fn force(&self, _: usize, z: &Gradient<2>, rate: &Gradient<2>) -> Gradient<2> {
        let [x, y, m] = self.0.call(&Self::arguments(z, rate));
        [-Vector2::new(x, y), -couple(&z[1]).0 * m]
    }

    fn force_and_matrix(
        &self,
        point: usize,
        z: &Gradient<2>,
        rate: &Gradient<2>,
    ) -> (Gradient<2>, Hessian<2>) {
        let by = self.0.derivative(&Self::arguments(z, rate), 3);
        let direction = couple(&z[1]).0;
        let force = |k: usize| Vector2::new(by[k][0], by[k][1]);
        let matrix = [
            [-Matrix2::from_columns(&[force(0), force(1)]), -force(2) * direction.transpose()],
            [
                -direction * Vector2::new(by[0][2], by[1][2]).transpose(),
                -direction * direction.transpose() * by[2][2],
            ],
        ];
        (self.force(point, z, rate), symmetric(matrix))
    }
}

/// The symmetric part: matrices of damping are symmetric, and this one only leads an iteration.
fn symmetric([[a, b], [c, d]]: Hessian<2>) -> Hessian<2> {
    let mean = |m: Matrix2<f64>, n: Matrix2<f64>| (m + n.transpose()) * 0.5;
    [[mean(a, a), mean(b, c)], [mean(c, b), mean(d, d)]]
}
