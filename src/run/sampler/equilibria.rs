//! The trajectory of a static analysis.

use super::energy::put_in;
use super::{History, LOOKED_AT, Sampler, is_among};
use crate::assembly::remaining;
use crate::model::Model;
use crate::numeric::plain;
use crate::restart::SavedState;
use crate::results::{AnalysisKind, Energy, ProbeSeries, Shape, Trajectory};
use crate::run::balance::too_few_cells;
use crate::run::laws::Reach;
use crate::run::locking::unheld;
use crate::run::tendons::Tendons;
use crate::run::{imbalance, stability, strings};
use crate::solve::dynamics;
use crate::solve::resume::Holding;
use crate::solve::statics::Solution;
use std::f64::consts::FRAC_PI_2;

impl Sampler<'_> {
    pub(in crate::run) fn statics(&self, solution: &Solution) -> Trajectory {
        self.equilibria(AnalysisKind::Static, solution, &self.angles)
    }

    /// The trajectory of equilibria that an analysis needs; `angles` are those of the probes in the first of them, where they are known.
    pub(in crate::run) fn equilibria(
        &self,
        analysis: AnalysisKind,
        solution: &Solution,
        angles: &[f64],
    ) -> Trajectory {
        let mut trajectory = self.empty(analysis);
        let count = solution.states.len();
        let (mut locking, mut loose) = (self.locking.clone(), self.loose.clone());
        let mut reach = Reach::new(self.model);
        let mut tendons = Tendons::new(self.model, true);
        let states = solution.states.iter().zip(&solution.variables).zip(&solution.work);
        for (i, (((load, x), variables), work)) in states.enumerate() {
            let q = self.coordinates_of(x);
            if self.model.outputs.reactions {
                self.record_reactions(&mut trajectory, &self.system.static_reactions(*load, x, variables));
            }
            let energy = Energy { work: work.value, ..self.system.energy(*load, q, None).with(variables) };
            let history = self.history(solution, i, angles);
            self.record(&mut trajectory, *load, (history, q), (None, variables), energy);
            if is_among(i, count, self.frames) {
                trajectory.frames.push(self.frame(*load, q));
            }
            tendons.see_tensions(*load, self.system.tensions(&x[q.len()..]).map(|(tension, _)| tension));
            if i + 1 == count {
                loose.see(self.system, *load, q);
            }
            if is_among(i, count, LOOKED_AT) {
                locking.see(q);
                if tendons.are_there() {
                    tendons.see(&self.shape(q));
                }
                if reach.watches() {
                    reach.see(&self.shape(q), &trajectory.run.undeformed);
                }
            }
        }
        if let (Some((load, x)), Some(variables)) = (solution.states.last(), solution.variables.last()) {
            let known = self.system.tensions(&x[self.system.coordinates()..]);
            trajectory.run.tensions = tendons.tensions(known.map(|(tension, _)| tension));
            let actions = self.system.static_actions(*load, x, variables);
            trajectory.last = self.loaded(self.coordinates_of(x), &actions);
            trajectory.run.warnings.extend(imbalance::out_of_balance(self.system, *load, x, variables));
        }
        if !self.is_compared() {
            let load = solution.states.last().map_or(1.0, |(load, _)| *load);
            let told = too_few_cells(self.model, self.system, (load, &trajectory.last), None);
            trajectory.run.warnings.extend(told);
        }
        let states = [solution.states.first(), solution.states.last()].into_iter().flatten();
        let states: Vec<(&[f64], f64)> = states.map(|(_, x)| (self.coordinates_of(x), 0.0)).collect();
        self.see_fields(&mut trajectory.run, &states);
        trajectory.run.warnings.extend(self.folds(&trajectory.last));
        trajectory.run.warnings.extend(strings::kinks(self.model, self.system, &trajectory.last));
        trajectory.run.warnings.extend(strings::pressed_at_rest(self.model, &trajectory.last));
        let known = solution.work.last().zip(trajectory.energy.last());
        trajectory.run.warnings.extend(known.and_then(|(work, energy)| put_in(work, energy)));
        let work = trajectory.energy.last().map_or(0.0, |energy| energy.potential.abs());
        trajectory.run.warnings.extend(locking.jammed(&trajectory.last, work));
        trajectory.run.warnings.extend(unheld(self.model, &trajectory.last, &trajectory.run.undeformed));
        trajectory.run.warnings.extend(locking.warnings(0.0));
        trajectory.run.warnings.extend(loose.warnings());
        trajectory.run.warnings.extend(reach.warnings());
        trajectory.parameter.iter().for_each(|at| tendons.see_factor(*at));
        trajectory.run.warnings.extend(tendons.warnings());
        trajectory.history = solution.history.clone();
        trajectory.run.statistics = solution.statistics;
        trajectory.run.warnings.extend(stability::warnings(solution));
        if analysis == AnalysisKind::Static {
            let unseen = stability::unseen_waves(self.model, self.system, &trajectory.last);
            trajectory.run.warnings.extend(unseen);
        }
        trajectory.events.extend(solution.events.iter().map(stability::event));
        trajectory
    }

    /// The last state, if it is the equilibrium under the full loads.
    /// `asked` is the model before it went on from another state, and `time` that of this state.
    pub(in crate::run) fn equilibrium(
        &self,
        solution: &Solution,
        seen: &Trajectory,
        asked: &Model,
        time: f64,
    ) -> Option<SavedState> {
        let (_, x) = solution.states.last().filter(|(load, _)| *load == 1.0)?;
        let mut state = dynamics::State::at_rest(self.coordinates_of(x));
        state.time = time;
        state.variables = solution.variables.last().cloned().unwrap_or_default();
        state.angles = seen.probes.iter().filter_map(|p| p.samples.last()).map(|s| s.angle).collect();
        let checkpoint = dynamics::Checkpoint { state, ..dynamics::Checkpoint::default() };
        let supports = self.system.static_support_forces(1.0, x, &checkpoint.state.variables);
        let holding = Holding { supports, multipliers: x[self.system.coordinates()..].to_vec() };
        Some(SavedState::new(asked, self.system, String::new(), checkpoint, Some(holding)))
    }

    /// The message on a path that ends while things come and go.
    pub(in crate::run) fn on_the_way(&self, solution: &Solution) -> Option<String> {
        let (load, _) = solution.states.last().filter(|(load, _)| self.system.is_between(*load))?;
        Some(format!(
            "the last state, at load factor {load:.4}, lies on the way to load factor 1, where all that goes with this stage has gone \
             and all that comes has come: {:.0} % of it is still as it was before",
            100.0 * remaining(*load)[0]
        ))
    }

    /// The directions at all probes in the last of some equilibria \[rad\], with the full turns since the start.
    pub(in crate::run) fn last_angles(&self, solution: &Solution) -> Vec<f64> {
        let mut series = vec![ProbeSeries::default(); self.probes.len()];
        for (i, (load, x)) in solution.states.iter().enumerate() {
            self.see_probes(
                &mut series,
                (i + 1, *load),
                (self.history(solution, i, &self.angles), self.coordinates_of(x)),
                None,
            );
        }
        series.iter().filter_map(|series| series.samples.last()).map(|sample| sample.angle).collect()
    }

    /// From where turns are counted in a state of this number, if these are the angles of the first.
    fn history<'h>(&self, solution: &'h Solution, number: usize, angles: &'h [f64]) -> History<'h> {
        match number.checked_sub(1) {
            None => History::Angles(angles),
            Some(before) => {
                let turned = solution.turned.get(number).map_or(&[][..], |turned| turned);
                let (load, x) = &solution.states[before];
                History::Before { load: *load, q: self.coordinates_of(x), turned }
            }
        }
    }

    /// Messages on beams that turn back within a cell. In a string only the axial stiffness resists
    /// such a fold; in a beam it lies between the quadrature points of bending, so that it may
    /// remain where a large step has left it.
    fn folds(&self, shapes: &[Shape]) -> Vec<String> {
        let beams = shapes.iter().zip(self.system.beams()).zip(&self.model.beams);
        let folds = beams.filter_map(|((shape, part), beam)| {
            let is_string = beam.section.bending_stiffness.is_none();
            let s = part.basis.nodes().windows(2).find_map(|cell| match *cell {
                [start, end] => {
                    let from = shape.s.partition_point(|s| *s < start).saturating_sub(1);
                    let to = (shape.s.partition_point(|s| *s <= end) + 1).min(shape.s.len());
                    let angles = shape.angle.get(from..to)?;
                    let turn = if is_string {
                        let (low, high) = angles
                            .iter()
                            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(*a), h.max(*a)));
                        high - low
                    } else {
                        // Even a beam that bends strongly turns little from one point to the next.
                        angles.windows(2).fold(0.0_f64, |turn, pair| turn.max((pair[1] - pair[0]).abs()))
                    };
                    (turn > FRAC_PI_2).then_some(start)
                }
                _ => None,
            })?;
            let (what, advice) = if is_string {
                ("string", "begin from an arc of its length, reach the load in smaller `steps`, or use more nodes")
            } else {
                ("beam", "reach the load in smaller `steps`, begin nearer to the equilibrium, or use other nodes")
            };
            Some(format!(
                "{what} `{}` turns by more than a right angle within its cell from s = {} m: it may have folded back, \
                 which is no equilibrium of a real {what}; {advice}",
                shape.beam,
                plain(s, 4)
            ))
        });
        folds.collect()
    }
}
