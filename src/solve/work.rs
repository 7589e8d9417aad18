//! The work of actuators along a path of equilibria.
//!
//! What actuators put in as the load factor grows, W = ∫ P(λ, q(λ)) dλ with P that of
//! [`System::actuators_rate`], depends on the whole path. Where the equations converge well its
//! steps are long, so that P is also evaluated between their ends, until Simpson's rule no longer
//! changes.

use super::path::{Path, Point};
use super::stability::Stability;
use crate::system::System;

/// Halving ends where it changes Simpson's rule by less than this, relative to the work on rigid
/// beams.
const CHANGE: f64 = 1e-7;
/// Most halvings.
const HALVINGS: usize = 8;
/// P jumps where one of four parts has this share of its change.
const JUMP: f64 = 0.9;
/// A step in which the work may err by more than this is taken back, relative to the work on rigid
/// beams.
const DOUBTFUL: f64 = 1e-4;
/// How often in succession steps are taken back at most: one beside a kink or a bifurcation may be as long as before.
const TAKEN_BACK: usize = 8;

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
    /// Steps that were taken back since one was kept.
    taken_back: usize,
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
    /// Adds the work of the path's last step along the load factor, unless it is doubtful and shorter steps
    /// can be tried: the step is then taken back. Returns whether it was kept.
    pub fn keep_step(&mut self, path: &mut Path<'_, '_>) -> bool {
        let before = *self;
        self.add_step(path);
        let doubtful = self.error - before.error > DOUBTFUL * (self.size - before.size);
        if doubtful && self.taken_back < TAKEN_BACK && path.take_back() {
            *self = Self { taken_back: before.taken_back + 1, ..before };
            return false;
        }
        self.taken_back = 0;
        true
    }

    /// Adds the work of the path's last step along the load factor.
    fn add_step(&mut self, path: &mut Path<'_, '_>) {
        let system = path.equilibrium.system();
        let Some([a, b]) = path.last_two().filter(|_| system.has_actuators()) else { return };
        let (from, to) = (Sample::of(system, a.load, &a.x), Sample::of(system, b.load, &b.x));
        self.size += unyielding(system, from.load, to.load);
        match between(path, &from, &to) {
            Some(middle) => {
                let jump = self.add_piece(path, [&from, &middle, &to], HALVINGS);
                // States between that are on another branch may reach anywhere in the step.
                self.error += jump * (to.load - from.load).abs();
            }
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

    /// Adds the work of a piece of a step; returns the largest jump of P in it.
    fn add_piece(
        &mut self,
        path: &mut Path<'_, '_>,
        [from, middle, to]: [&Sample; 3],
        halvings: usize,
    ) -> f64 {
        let whole = simpson([from, middle, to]);
        let (Some(first), Some(second)) = (between(path, from, middle), between(path, middle, to)) else {
            self.value += whole;
            self.error += (whole - trapezoid(from, to)).abs();
            return 0.0;
        };
        let halves = [[from, &first, middle], [middle, &second, to]];
        let sum: f64 = halves.iter().copied().map(simpson).sum();
        if (sum - whole).abs() <= CHANGE * self.size {
            self.value += sum;
            self.error += (sum - whole).abs();
            0.0
        } else if halvings == 0 {
            self.value += sum;
            self.error += (sum - whole).abs();
            jump([from, &first, middle, &second, to])
        } else {
            halves.map(|half| self.add_piece(path, half, halvings - 1)).into_iter().fold(0.0, f64::max)
        }
    }
}

/// By how much P jumps within a short piece, zero where it only bends there.
fn jump(samples: [&Sample; 5]) -> f64 {
    let changes = samples.windows(2).map(|pair| (pair[1].power - pair[0].power).abs());
    let (largest, all) = changes.fold((0.0_f64, 0.0), |(most, sum), change| (most.max(change), sum + change));
    if largest > JUMP * all { largest } else { 0.0 }
}

/// The work from one load factor to another if the beams were rigid.
fn unyielding(system: &System, from: f64, to: f64) -> f64 {
    0.5 * (system.actuators_size(from) + system.actuators_size(to)) * (to - from).abs()
}

/// The state halfway. Where the one between the ends of the whole step does not lead there, the
/// nearer ones do. Past a bifurcation within the step both may lead to the branch that the path has left:
/// a state less stable than both ends of the step is on that one. It is then looked for from the later
/// end alone, which is on the path.
fn between(path: &mut Path<'_, '_>, from: &Sample, to: &Sample) -> Option<Sample> {
    let load = 0.5 * (from.load + to.load);
    let ends = [(from.load, &from.x[..]), (to.load, &to.x[..])];
    let stable = path.last_two().map_or([None; 2], |step| step.map(|point| point.stability));
    let on_path = |point: &Point| {
        let lost = |end: &Option<Stability>| end.zip(point.stability).is_some_and(|(e, p)| e.is_lost(p));
        !stable.iter().all(lost)
    };
    let point = path.between(load).filter(on_path);
    let point = point.or_else(|| path.near(ends, load).filter(on_path));
    let point = point.or_else(|| path.near([(from.load, &to.x), ends[1]], load).filter(on_path))?;
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

    /// Of a kink as a square root has it, the part beside it has half of the change.
    #[test]
    fn a_jump_is_no_kink() {
        let all = |power: fn(f64) -> f64| {
            let samples = [0.0, 1.0, 2.0, 3.0, 4.0].map(|load| sample((load, power(load)), vec![]));
            jump(samples.each_ref())
        };
        assert_eq!(all(f64::sqrt), 0.0);
        assert_eq!(all(|load| 1e-3 * load + if load > 2.5 { 5.0 } else { 0.0 }), 5.001);
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
