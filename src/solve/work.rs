//! The work of actuators along a path of equilibria.
//!
//! What actuators put in as the load factor grows, W = ∫ P(λ, q(λ)) dλ with P that of
//! [`System::actuators_rate`], depends on the whole path. Where the equations converge well its
//! steps are long, so that P is also evaluated between their ends, until Simpson's rule no longer
//! changes.

use super::path::Path;
use crate::system::System;

/// Halving ends where it changes Simpson's rule by less than this, relative to the work on rigid
/// beams.
const CHANGE: f64 = 1e-7;
/// Most halvings.
const HALVINGS: usize = 8;

/// Work so far, with its estimated error.
#[derive(Clone, Copy, Debug, Default)]
pub struct Work {
    /// The work \[J\].
    pub value: f64,
    /// Its estimated error \[J\].
    pub error: f64,
    /// The work if the beams were rigid \[J\].
    pub size: f64,
    /// dP/dλ in the last step that was integrated by the trapezoidal rule.
    slope: Option<f64>,
}

/// P in a state of the path.
#[derive(Clone, Debug)]
struct Sample {
    load: f64,
    power: f64,
    x: Vec<f64>,
}

impl Sample {
    fn of(system: &System, load: f64, x: &[f64]) -> Self {
        Self { load, power: system.actuators_rate(load, &x[..system.coordinates()]), x: x.to_vec() }
    }
}

impl Work {
    /// Adds the work of the path's last step along the load factor.
    pub fn add_step(&mut self, path: &mut Path<'_, '_>) {
        let system = path.equilibrium.system();
        let Some([a, b]) = path.last_two().filter(|_| system.has_actuators()) else { return };
        let (from, to) = (Sample::of(system, a.load, &a.x), Sample::of(system, b.load, &b.x));
        self.size += unyielding(system, from.load, to.load);
        match between(path, &from, &to) {
            Some(middle) => self.add_piece(path, [&from, &middle, &to], HALVINGS),
            None => self.add_straight(&from, &to),
        }
    }

    /// Adds the work between two states by the trapezoidal rule, where no state between them is
    /// known.
    pub fn add_states(&mut self, system: &System, (from, x): (f64, &[f64]), (to, y): (f64, &[f64])) {
        if system.has_actuators() {
            self.size += unyielding(system, from, to);
            self.add_straight(&Sample::of(system, from, x), &Sample::of(system, to, y));
        }
    }

    fn add_straight(&mut self, from: &Sample, to: &Sample) {
        let (step, change) = (to.load - from.load, to.power - from.power);
        self.value += trapezoid(from, to);
        // The rule errs by a twelfth of P'' h³, and P'' h is the change of slope from step to step.
        let slope = if step == 0.0 { 0.0 } else { change / step };
        self.error += (step * step * (slope - self.slope.unwrap_or(0.0))).abs() / 12.0;
        self.slope = Some(slope);
    }

    fn add_piece(&mut self, path: &mut Path<'_, '_>, [from, middle, to]: [&Sample; 3], halvings: usize) {
        let whole = simpson([from, middle, to]);
        let (Some(first), Some(second)) = (between(path, from, middle), between(path, middle, to)) else {
            self.value += whole;
            self.error += (whole - trapezoid(from, to)).abs();
            return;
        };
        let halves = [[from, &first, middle], [middle, &second, to]];
        let sum: f64 = halves.iter().copied().map(simpson).sum();
        if (sum - whole).abs() <= CHANGE * self.size || halvings == 0 {
            self.value += sum;
            self.error += (sum - whole).abs();
        } else {
            halves.into_iter().for_each(|half| self.add_piece(path, half, halvings - 1));
        }
    }
}

/// The work from one load factor to another if the beams were rigid.
fn unyielding(system: &System, from: f64, to: f64) -> f64 {
    0.5 * (system.actuators_size(from) + system.actuators_size(to)) * (to - from).abs()
}

/// The state halfway. Where the one between the ends of the whole step does not lead there, the
/// nearer ones do.
fn between(path: &mut Path<'_, '_>, from: &Sample, to: &Sample) -> Option<Sample> {
    let load = 0.5 * (from.load + to.load);
    let ends = [(from.load, &from.x[..]), (to.load, &to.x[..])];
    let point = path.between(load).or_else(|| path.near(ends, load))?;
    Some(Sample::of(path.equilibrium.system(), point.load, &point.x))
}

fn trapezoid(from: &Sample, to: &Sample) -> f64 {
    0.5 * (from.power + to.power) * (to.load - from.load)
}

fn simpson([from, middle, to]: [&Sample; 3]) -> f64 {
    (to.load - from.load) / 6.0 * (from.power + 4.0 * middle.power + to.power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::model::{Beam, Discretization, Model, Place, Section, Support};
    use crate::solve::equilibrium::Equilibrium;
    use crate::solve::newton::Settings;
    use crate::solve::path::Parameter;

    fn sample((load, power): (f64, f64), x: Vec<f64>) -> Sample {
        Sample { load, power, x }
    }

    /// For P = λ² from 0 to 6 Simpson's rule gives 72 J, the trapezoidal rule 108 J. Where no more
    /// states are found between, as on a path of one state, the work may err by the difference.
    #[test]
    fn work_is_doubtful_where_no_more_states_are_found() {
        let section = Section::new(1.0, 1.0);
        let beam = Beam::line("arm", [0.0, 0.0], [1.0, 0.0], section, Discretization::ancf(1));
        let supports = vec![Support::clamp(Place::new(0, 0.0))];
        let model = Model { beams: vec![beam], supports, ..Model::default() };
        let system = System::build(&model, Needs::default()).unwrap();
        let mut equilibrium = Equilibrium::new(&system);
        let x = equilibrium.start();
        let n = x.len();
        let mut path = Path::new(&mut equilibrium, Parameter::Load, Settings::default(), 1.0, x).unwrap();
        let mut work = Work::default();
        // From nowhere no iteration leads anywhere.
        let [from, middle, to] =
            [(0.0, 0.0), (3.0, 9.0), (6.0, 36.0)].map(|at| sample(at, vec![f64::NAN; n]));
        work.add_piece(&mut path, [&from, &middle, &to], HALVINGS);
        assert_eq!((work.value, work.error), (72.0, 36.0));
    }

    /// P grows from 0 to 4 along 2, by 2 for each of λ, and stays: the trapezoids are 4 J and 8 J, and
    /// each may err by 2² times a twelfth of how much the slope has changed.
    #[test]
    fn trapezoids_may_err_by_the_change_of_slope() {
        let mut work = Work::default();
        work.add_straight(&sample((0.0, 0.0), vec![]), &sample((2.0, 4.0), vec![]));
        assert_eq!(work.value, 4.0);
        assert!((work.error - 4.0 * 2.0 / 12.0).abs() < 1e-15, "{work:?}");
        work.add_straight(&sample((2.0, 4.0), vec![]), &sample((4.0, 4.0), vec![]));
        assert_eq!(work.value, 12.0);
        assert!((work.error - 4.0 * (2.0 + 2.0) / 12.0).abs() < 1e-15, "{work:?}");
        work.add_straight(&sample((4.0, 4.0), vec![]), &sample((4.0, 9.0), vec![]));
        assert!(work.value == 12.0 && work.error.is_finite(), "{work:?}");
    }
}
