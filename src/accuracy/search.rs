//! The search for a mesh and steps that are good enough.

use super::difference::{Difference, events, is_path, jumps};
use super::judgement::{CAUTION, Estimate, Fall, Judged, LEAST_CONTRACTION, Seen, excess};
use super::mesh::{self, CellErrors, Mesh};
use super::missing::Missing;
use super::prospect::{POWER, Paid, beyond_price, outgrown};
use super::round::{Outcome, Round};
use super::runner::{FINEST, Fineness, LOOSER, Purpose, Runner, short};
use super::{Accurate, model_error, statement};
use crate::model::{Accuracy, Analysis, StepControl};
use crate::results::{ErrorEstimate, Errors};
use crate::run::RunError;

/// Most rounds of two or three runs.
const ROUNDS: usize = 8;
/// Rounds without a mesh on which both runs come to their end.
const FAILURES: usize = 4;
/// Most times that the tolerance is reduced because steps do not follow it.
const MUTE: usize = 3;
/// Errors that did not fall below this part of what they were, in spite of a finer mesh or smaller
/// steps, will not fall.
const STALLED: f64 = 0.7;
/// Rounds in succession that gain nothing before the search gives up.
const STALLS: usize = 2;
/// The same in equilibria with obstacles: where in a cell a contact ends decides about its error, by chance.
const STALLS_OF_CONTACT: usize = 4;
/// Rounds after which errors that grow with time are no more those of too coarse a mesh.
const GROWN: usize = 3;
/// Part of the wanted error that the next round aims at.
const AIM: f64 = 0.5;
/// Most times as many cells in the next round …
const LEAP: f64 = 6.0;
/// … and where errors have not fallen as the method promises, so that nobody can tell yet how many
/// are needed.
const CAREFUL_LEAP: f64 = 3.0;
/// Most times the tolerance is changed by at once.
const LEAP_OF_TOLERANCE: f64 = 200.0;
/// Differences that fall by this factor at least tell all errors well enough together.
const FELL_WELL: f64 = 4.0;
/// Errors of equilibria with friction, of which load steps go with the root of the tolerance.
const POWER_OF_LOAD_STEPS: f64 = 0.5;
/// The tolerance goes with this power of steps.
const STEPS: f64 = 5.0;
/// Most cells of all beams …
const CELLS: usize = 4096;
/// … with friction, in thousands of load steps …
const CELLS_OF_LOAD_STEPS: usize = 1024;
/// … or so many times those with which the search begins.
const CELLS_MORE: usize = 16;
/// Accuracies below this are beyond what doubles and iterations leave.
const ROUND_OFF: f64 = 1e-12;
/// Why errors do not fall.
const SEVERAL: &str = "finer meshes and smaller steps do not bring the results nearer to each other: there are several solutions, \
                       errors grow with time, or the strain jumps where something pulls along a beam (cut it there: two beams in a `weld` \
                       have a strain each)";
/// The same with friction.
const STICKS: &str = "finer meshes and more load steps do not bring the results nearer to each other: friction sticks and slips at single points of the \
                      mesh and of the path, so that its errors fall irregularly; ask for less";
/// Why nothing is known of a motion whose steps the tolerance does not decide about.
const MUTE_STEPS: &str = "with a looser tolerance the motion takes hardly fewer steps, so that the errors of its steps cannot be seen; give a \
                          smaller tolerance, or leave the integrator out";
/// The same of steps of a given length.
const MUTE_FIXED_STEPS: &str = "steps of twice the length had to be divided, so that the errors of these cannot be seen; give a smaller `step`, or a `tolerance` in \
                                place of it";
/// The same of equilibria with friction.
const MUTE_LOAD_STEPS: &str = "with twice the `max_step` there are hardly fewer load steps, so that what friction errs by in them cannot be seen; give a \
                               smaller `max_step`, or leave it out";
/// Why the steps of the load are not small enough.
const TOO_MANY_LOAD_STEPS: &str =
    "friction depends on the path, of which more than 2,500 load steps would be needed";
/// Why a load is not known.
const FIELD: &str = "a force field, or a velocity at the start, changes within the cells of its beam by more than they see; name a `basis` with \
                     nodes where it does, or let it be smoother";
/// What an accuracy means along a path.
const LAST_POINT: &str = "the error is that of the last point of the path: each run takes points of its own, and of those before nothing is known";
/// Why nothing can be refined.
const NAMED: &str =
    "the scene names the basis of every beam, and with it the mesh: leave it out, or give it more nodes";

/// A search under way.
pub(super) struct Search<'a, 'o> {
    runner: Runner<'a, 'o>,
    /// Most cells of all beams.
    most: usize,
}

impl<'a, 'o> Search<'a, 'o> {
    /// A search that begins where `runner` is.
    pub fn new(runner: Runner<'a, 'o>) -> Self {
        let cells: usize = runner.meshes.iter().map(Mesh::cells).sum();
        let most = if runner.open.load_steps { CELLS_OF_LOAD_STEPS } else { CELLS };
        Self { most: most.max(CELLS_MORE * cells), runner }
    }

    /// Refines until errors are small enough, or there is a reason why they will not be.
    ///
    /// # Errors
    /// [`RunError`], of the last run, where no pair of runs came to its end.
    pub fn run(mut self) -> Result<Accurate, RunError> {
        let mut before: Option<Seen> = None;
        let mut best: Option<Judged> = None;
        let mut paid: Vec<Paid> = Vec::new();
        let (mut rounds, mut stalls, mut failures, mut mute) = (0, 0, 0, 0);
        let touches = matches!(self.runner.analysis, Analysis::Static(_)) && self.runner.model.has_contact();
        let most_stalls = if touches { STALLS_OF_CONTACT } else { STALLS };
        let mut too_coarse = false;
        loop {
            // Where the meshes of the round before were others, three runs tell how errors fall on these.
            let alone = before.as_ref().is_none_or(|before| !before.is_like(&self.runner.meshes));
            let round = match self.runner.round(alone, too_coarse || before.is_some()) {
                Ok(Outcome::Compared(round)) => *round,
                Ok(Outcome::TooCoarse(difference)) => {
                    let seen = self.begin_finer(&difference);
                    // What meshes too coarse for any mode differ by tells nothing of how errors fall: three
                    // finer runs do.
                    let modes = matches!(self.runner.analysis, Analysis::Modal(_) | Analysis::Buckling(_));
                    (before, too_coarse) = ((!modes).then_some(seen), true);
                    continue;
                }
                // What is wrong with the model is wrong on all meshes.
                Err(error) if error.exit_status() == 2 => return Err(error),
                Err(error) => {
                    let shortened =
                        best.is_some().then(|| self.runner.shortened(&error.to_string())).flatten();
                    failures += 1;
                    if shortened.is_none() && failures < FAILURES && self.refine_everywhere() {
                        continue;
                    }
                    return match best {
                        Some(best) => {
                            Ok(self.finished(best, Some(shortened.unwrap_or_else(|| error.to_string()))))
                        }
                        None => Err(error),
                    };
                }
            };
            if !round.results.run().complete {
                // Somebody stopped it: what an earlier round found is more than a part of this one.
                let why = Some("the search for it was interrupted".to_owned());
                return Ok(match best {
                    Some(mut best) => {
                        best.round.results.run_mut().complete = false;
                        self.finished(best, why)
                    }
                    None => self.finished(Judged::unknown(round), why),
                });
            }
            let difference = match &round.difference {
                Ok(difference) => difference.clone(),
                Err(why) => {
                    let shortened = best.is_some().then(|| self.runner.shortened(why)).flatten();
                    failures += 1;
                    if shortened.is_none() && failures < FAILURES && self.refine_everywhere() {
                        continue;
                    }
                    let why = shortened.or_else(|| Some(why.clone()));
                    return Ok(self.finished(best.unwrap_or_else(|| Judged::unknown(round)), why));
                }
            };
            if !self.runner.steps_are_open() && !round.tells_of_steps() {
                let why = match self.runner.analysis {
                    Analysis::Static(_) => MUTE_LOAD_STEPS,
                    Analysis::Dynamic(motion)
                        if matches!(motion.integrator.step_control(), StepControl::Fixed(_)) =>
                    {
                        MUTE_FIXED_STEPS
                    }
                    _ => MUTE_STEPS,
                };
                return Ok(self.finished(Judged::unknown(round), Some(why.to_owned())));
            }
            rounds += 1;
            if self.runner.wanted.is_some() && round.results.run().misses_fields {
                if rounds < ROUNDS && self.refine_meshes() {
                    before = None;
                    continue;
                }
                return Ok(self.finished(Judged::unknown(round), Some(FIELD.to_owned())));
            }
            let (now, mut judged) = self.judged(round, difference, before.as_ref().filter(|_| !alone));
            stalls = match &before {
                Some(before) if now.excess > STALLED * before.excess => stalls + 1,
                _ => 0,
            };
            let same_steps = before.as_ref().is_some_and(|before| before.tolerance == now.tolerance);
            // No error is smaller than what finer meshes do not remove.
            let errors = judged.errors();
            judged.excess = self.runner.wanted.map_or(0.0, |wanted| excess(errors, wanted));
            paid.push(Paid::of(&judged));
            if let Some((run, stated)) = self.runner.runs.get_mut(judged.round.run).zip(judged.stated()) {
                run.error = Some(stated.errors.result);
            }
            if judged.excess <= 1.0 && mute < MUTE && !judged.round.tells_of_steps() {
                // Something else than the tolerance decides about steps: a smaller one will.
                mute += 1;
                self.runner.tolerance = short((self.runner.tolerance / LOOSER).max(self.runner.finest()));
                continue;
            }
            let Some(wanted) = self.runner.wanted.filter(|_| judged.excess > 1.0) else {
                return Ok(self.finished(judged, None));
            };
            let why = if wanted.result < ROUND_OFF {
                Some(format!("errors below {ROUND_OFF:e} are those of round-off"))
            } else if let Some(remains) = self.runner.remains(&judged.round, judged.caution, wanted) {
                Some(remains)
            } else if stalls >= most_stalls && self.runner.open.load_steps {
                Some(STICKS.to_owned())
            } else if stalls >= most_stalls {
                let jump = || self.runner.largest_jump(&judged.round.jumps);
                let jump = if errors.result <= wanted.result { jump() } else { None };
                Some(self.runner.kink_at().or(jump).unwrap_or_else(|| SEVERAL.to_owned()))
            } else if let Some(growth) = outgrown(&self.runner, &judged, wanted).filter(|_| rounds >= GROWN) {
                Some(growth)
            } else if let Some(price) = beyond_price(&paid) {
                Some(price)
            } else if rounds >= ROUNDS {
                Some(format!("{ROUNDS} rounds of finer meshes and smaller steps were not enough"))
            } else if stalls > 0 && same_steps && self.runner.open.integrator {
                // What a finer mesh alone did not make smaller may be what the steps err by on each mesh.
                self.runner.tolerance = short((self.runner.tolerance / LOOSER).max(FINEST));
                None
            } else {
                self.improve(&judged, wanted, rounds > 1).err().map(|why| match self.runner.kink_at() {
                    Some(kink) => format!("{why}; {kink}"),
                    None => why,
                })
            };
            before = Some(now);
            best = Some(match best {
                Some(mut best) if best.excess <= judged.excess => {
                    // A finer run that differs more shows that this one's small difference was luck.
                    let luck = judged.excess / best.excess;
                    best.caution *= luck;
                    best.excess *= luck;
                    best
                }
                _ => judged,
            });
            if why.is_some()
                && let Some(best) = best.take()
            {
                return Ok(self.finished(best, why));
            }
        }
    }

    /// What a round has seen, and what it tells of the errors of its finer run; together with the round `before` if its
    /// meshes were like these.
    fn judged(&mut self, round: Round, difference: Difference, before: Option<&Seen>) -> (Seen, Judged) {
        let excess_of =
            |runner: &Runner<'_, '_>, errors| runner.wanted.map_or(0.0, |wanted| excess(errors, wanted));
        let finer = before.map(|before| (before, before.finer(&self.runner.meshes, self.runner.tolerance)));
        let all = difference.errors.result;
        let (whole, mut caution) = match finer {
            None => self.runner.fall_alone(round.fall, all),
            Some((before, [cells, steps])) => (before.whole.to(cells.max(steps), all), 1.0),
        };
        let mut now = Seen {
            meshes: self.runner.meshes.clone(),
            cells: difference.cells.clone(),
            tolerance: self.runner.tolerance,
            excess: excess_of(&self.runner, difference.errors),
            whole,
            apart: None,
        };
        let errors = |difference: Difference, contractions: [f64; 2]| {
            (difference.divided(contractions.map(|contraction| contraction - 1.0)), contractions[0])
        };
        let (errors_of_both, contraction) =
            errors(difference, self.runner.contractions_with_steps(whole.factor));
        let enough = excess_of(&self.runner, errors_of_both.errors) * caution <= 1.0;
        let mut estimate = Estimate {
            whole: errors_of_both.clone(),
            seen: errors_of_both.clone(),
            mesh: errors_of_both,
            contraction,
            steps: None,
            missing: None,
        };
        // Another run is not worth its price where two are enough and what they differ by has fallen well.
        let parts = if enough && contraction >= FELL_WELL { None } else { self.apart(&round) };
        if let Some([mesh, steps]) = parts {
            let differences = [&mesh, &steps].map(|difference| difference.errors.result);
            let falls = match finer.and_then(|(before, finer)| Some((before.apart?, finer))) {
                None => [Fall { difference: differences[0], ..whole }, Fall::of_steps(differences[1])],
                Some(([mesh, steps], finer)) => {
                    [mesh.to(finer[0], differences[0]), steps.to(finer[1], differences[1])]
                }
            };
            let (mesh, contraction) = errors(mesh, self.runner.contractions(falls[0].factor));
            let (steps, _) = errors(steps, self.runner.contractions_of_steps(falls[1].factor));
            let mesh = mesh.divided([caution.recip(); 2]);
            if let Some(whole) = mesh.plus(&steps) {
                caution = 1.0;
                estimate = Estimate {
                    seen: whole.clone(),
                    whole,
                    mesh,
                    contraction,
                    steps: Some(steps.errors.result),
                    missing: None,
                };
                now.apart = Some(falls);
            }
        }
        let fall = if finer.is_some() { whole.factor } else { round.fall.unwrap_or(f64::NAN) };
        let likely = self.runner.likely(all, fall, caution * estimate.seen.errors.result);
        let Runner { model, analysis, meshes, .. } = &self.runner;
        let missing = |coarse| Missing::of(model, analysis, meshes, coarse, &round.results);
        let estimate = estimate.with(round.coarse.as_ref().and_then(missing), round.unseen.as_ref());
        (now, Judged { round, estimate: Some(estimate), caution, likely, excess: 0.0 })
    }

    /// By how much the steps and the mesh of a round err apart from each other: a run on the coarse mesh
    /// with the finer steps lies between those that were compared. `None` where not both can be changed,
    /// or there is no such run.
    fn apart(&mut self, round: &Round) -> Option<[Difference; 2]> {
        if !self.runner.steps_are_open() || !round.tells_of_steps() {
            return None;
        }
        let coarse = round.coarse.as_ref()?;
        let setting = self.runner.setting(Fineness::Coarse, Fineness::Fine);
        let between = self.runner.solve(&round.stations, &setting, Purpose::Shapes).ok()?;
        let mut of_steps = self.runner.difference(coarse, &between).ok()?;
        let of_mesh = self.runner.difference(&between, &round.results).ok()?;
        let [told, finer, coarse] = [&round.results, &between, coarse].map(|run| &run.states().events[..]);
        of_steps.events = events(told, [coarse, finer]);
        between.run().complete.then_some([of_mesh, of_steps])
    }

    /// Finer meshes where cells err and smaller steps where steps err, so that the next round is
    /// good enough; why this cannot be. `again` after the first round.
    fn improve(&mut self, judged: &Judged, wanted: Accuracy, again: bool) -> Result<(), String> {
        let (round, Some(estimate)) = (&judged.round, &judged.estimate) else {
            return Err("nothing is known of the errors".to_owned());
        };
        let errors = judged.with_caution(estimate.mesh.errors);
        let needed = more_cells(errors, wanted, estimate.contraction);
        let [promised, _] = self.runner.contractions(f64::INFINITY);
        let times = needed.min(if estimate.contraction < promised { CAREFUL_LEAP } else { LEAP });
        let mut steps = false;
        let missing = estimate.missing.as_ref().map(|missing| missing.errors(&estimate.whole).errors);
        let missing = missing.map_or(0.0, |errors| excess(errors, wanted) / AIM);
        if self.runner.open.integrator && missing > 1.0 {
            steps = true;
            let factor = missing.powf(-STEPS).clamp(LEAP_OF_TOLERANCE.recip(), LOOSER.recip());
            self.runner.tolerance = short((self.runner.tolerance * factor).max(FINEST));
        } else if let Some(time) = estimate.steps {
            let time = judged.caution * time;
            // Where a finer mesh comes next and this one errs more, what is seen of the steps is not yet
            // what they do there.
            let ratio = time / (AIM * wanted.result);
            steps = ratio > 1.0 && (time >= errors.result || round.cells == 0);
            let power = if self.runner.open.load_steps { POWER_OF_LOAD_STEPS } else { POWER };
            if steps && self.runner.open.load_steps && self.runner.tolerance <= self.runner.finest() {
                return Err(TOO_MANY_LOAD_STEPS.to_owned());
            }
            if steps {
                let factor = ratio.powf(-power.recip()).max(LEAP_OF_TOLERANCE.recip());
                self.runner.tolerance = short((self.runner.tolerance * factor).max(self.runner.finest()));
            } else if again && estimate.contraction <= LEAST_CONTRACTION {
                // Two meshes whose difference does not fall may differ by what the steps err on each.
                self.runner.tolerance = short((self.runner.tolerance / LOOSER).max(self.runner.finest()));
            }
        } else if self.runner.steps_are_open() && !round.tells_of_steps() {
            // The errors may be those of the steps, which nobody has seen.
            self.runner.tolerance = short((self.runner.tolerance / LOOSER).max(self.runner.finest()));
        }
        let resolved = self.runner.resolve(&round.layers, wanted);
        let graded = self.runner.grade(&round.jumps, wanted.result)? || resolved;
        if graded && times <= 1.0 {
            self.runner.take(self.runner.meshes.clone());
        }
        if (steps || graded) && (times <= 1.0 || round.cells == 0) {
            return Ok(());
        }
        if round.cells == 0 {
            return Err(NAMED.to_owned());
        }
        let most = self.most;
        if 2 * round.cells >= most {
            let why = match self.runner.open.load_steps {
                _ if self.runner.kink.is_some() => "",
                true => ": friction sticks or slips in a part of a cell; ask for less",
                false => {
                    ": where something pulls along a beam between its ends, cut it there (two beams in a `weld` have a strain each)"
                }
            };
            return Err(format!("more than {most} cells would be needed{why}"));
        }
        self.spread(&estimate.mesh.cells, times.max(1.1));
        Ok(())
    }

    /// So many times as many cells in the open beams, where `cells` err.
    fn spread(&mut self, cells: &[CellErrors], times: f64) {
        let of_open =
            |(index, cells): (usize, &CellErrors)| self.runner.is_open(index).then(|| cells.clone());
        let errors: Vec<Option<CellErrors>> = cells.iter().enumerate().map(of_open).collect();
        self.runner.take(mesh::refined(&self.runner.meshes, &errors, times, self.most / 2));
    }

    /// Finer meshes in place of those with which the search began, of which two runs were enough to
    /// tell that they do not do; what was seen of them.
    fn begin_finer(&mut self, difference: &Difference) -> Seen {
        let coarser: Vec<Mesh> = self.runner.meshes.iter().map(Mesh::coarser).collect();
        let [promised, _] = self.runner.contractions(f64::INFINITY);
        let cells = coarser.iter().zip(&self.runner.meshes).zip(&difference.cells);
        let seen = Seen {
            cells: cells.map(|((coarser, mesh), errors)| coarser.gathered(mesh, errors)).collect(),
            meshes: coarser,
            tolerance: LOOSER * self.runner.tolerance,
            excess: f64::INFINITY,
            whole: Fall::unknown(difference.errors.result),
            apart: None,
        };
        if let Some(wanted) = self.runner.wanted {
            let needed = more_cells(self.runner.foreseen(difference), wanted, promised);
            let least = if self.runner.is_apart(difference) { 2.0 } else { 1.1 };
            self.spread(&difference.cells, needed.clamp(least, CAREFUL_LEAP));
        }
        seen
    }

    /// Twice the cells in all open beams, and steps to match; whether there was any to refine.
    fn refine_everywhere(&mut self) -> bool {
        let any = self.refine_meshes() || self.runner.steps_are_open();
        self.runner.tolerance = short((self.runner.tolerance / LOOSER).max(self.runner.finest()));
        any
    }

    /// Cells of half the length of all open beams; whether there are any.
    fn refine_meshes(&mut self) -> bool {
        let mut any = false;
        for index in 0..self.runner.meshes.len() {
            if self.runner.is_open(index) && self.runner.meshes[index].cells() < self.most / 2 {
                self.runner.meshes[index] = self.runner.meshes[index].halved();
                any = true;
            }
        }
        any
    }

    /// The results of a round with what is known of their errors.
    fn finished(self, judged: Judged, reason: Option<String>) -> Accurate {
        let stated = judged.stated();
        let Judged { round, estimate: errors, .. } = judged;
        let Round { mut results, setting, corners, .. } = round;
        let lengths: Vec<f64> = self.runner.meshes.iter().map(Mesh::length).collect();
        let largest = model_error::largest(lengths.len(), results.states());
        let mut notes = model_error::notes(self.runner.model, &lengths, &largest);
        let last = &results.states().last;
        notes.extend(model_error::at_jumps(self.runner.model, |probe| {
            jumps(self.runner.model, last, probe.at)
        }));
        if is_path(self.runner.analysis) && self.runner.wanted.is_some() {
            notes.push(LAST_POINT.to_owned());
        }
        results.states_mut().stations.clear();
        let solver = self.runner.steps_are_open() || self.runner.static_tolerance().is_some();
        let chosen = setting.toml_of(self.runner.model, |beam| self.runner.is_open(beam), solver);
        let wanted = self.runner.wanted.map(|wanted| Errors {
            result: wanted.result,
            curvature: wanted.curvature,
            section_force: wanted.section_force,
        });
        let unknown = Errors { result: f64::INFINITY, ..Errors::default() };
        let mut estimate = ErrorEstimate {
            wanted,
            reason,
            notes,
            runs: self.runner.runs,
            estimated: unknown,
            ..ErrorEstimate::default()
        };
        estimate.notes.extend(errors.and_then(|estimate| estimate.missing?.note()));
        if let Some(Difference { errors, eigenvalues, probes, events, records, beams, .. }) = stated {
            estimate.probes = probes.into_iter().map(statement::of_probe).collect();
            let events = statement::of_events(events, self.runner.model, results.states(), &estimate.probes);
            estimate = ErrorEstimate { estimated: errors, eigenvalues, events, records, beams, ..estimate };
            estimate
                .notes
                .extend(self.runner.wanted.into_iter().flat_map(|wanted| of_nothing(wanted, errors)));
            estimate.met = self.runner.wanted.is_none_or(|wanted| excess(estimate.estimated, wanted) <= 1.0);
        }
        if let Some(wanted) = self.runner.wanted
            && !estimate.met
        {
            let states = results.states();
            let first = estimate.records.iter().position(|error| *error > wanted.result);
            estimate.good_until =
                first.and_then(|first| states.parameter.get(first.checked_sub(1)?).copied());
        }
        results.run_mut().error = Some(Box::new(estimate));
        Accurate { results, chosen, corners }
    }
}

/// What is said where an error is wanted of something that is nowhere more than round-off.
fn of_nothing(wanted: Accuracy, errors: Errors) -> impl Iterator<Item = String> {
    let kinds = [
        ("curvature", wanted.curvature, errors.curvature),
        ("section force", wanted.section_force, errors.section_force),
    ];
    let of_nothing = kinds.into_iter().filter(|(_, wanted, error)| wanted.is_some() && error.is_none());
    of_nothing.map(|(what, ..)| {
        format!("no {what} is larger than what round-off makes of none: nothing is said of its error")
    })
}

/// How many times as many cells make these errors half of those that are wanted, where errors of the
/// result fall by `contraction` from one mesh to its halves, and curvatures and section forces are of
/// second order.
fn more_cells(errors: Errors, wanted: Accuracy, contraction: f64) -> f64 {
    let order = (contraction / CAUTION).log2().clamp(1.0, 4.0);
    let times = |error: Option<f64>, wanted: Option<f64>, order: f64| {
        error.zip(wanted).map_or(0.0, |(error, wanted)| (error / (AIM * wanted)).powf(order.recip()))
    };
    times(Some(errors.result), Some(wanted.result), order)
        .max(times(errors.curvature, wanted.curvature, 2.0))
        .max(times(errors.section_force, wanted.section_force, 2.0))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::accuracy::difference::Difference;
    use crate::accuracy::round::tests::{round, run};
    use crate::accuracy::runner::tests::{runner, scene};
    use crate::results::{AnalysisKind, Trajectory};

    pub const STILL: &str = "analysis.static = {}";
    pub const MOTION: &str = "analysis.dynamic = { duration = 1 }";

    /// What a search knows of a round with these differences; errors are a (contraction − 1)-th.
    pub fn judged(runner: &Runner<'_, '_>, difference: Difference, contractions: [f64; 2]) -> Judged {
        let results = run(AnalysisKind::Static, 1, 0);
        Judged {
            round: round(runner, results, None),
            estimate: Some(estimate(difference, contractions)),
            caution: 1.0,
            likely: 1.0,
            excess: 2.0,
        }
    }

    fn estimate(difference: Difference, contractions: [f64; 2]) -> Estimate {
        let whole = difference.divided(contractions.map(|contraction| contraction - 1.0));
        Estimate {
            seen: whole.clone(),
            mesh: whole.clone(),
            whole,
            contraction: contractions[0],
            steps: None,
            missing: None,
        }
    }

    /// Half of the wanted error of 1e-4 is aimed at, with cells that all err alike.
    #[test]
    fn as_many_cells_are_taken_as_errors_need() {
        let still = scene(STILL);
        let cells = |errors: Errors, contractions: [f64; 2], wanted: Accuracy, most: usize| {
            let mut search = Search::new(runner(&still, 1e-3));
            search.most = most;
            let even = CellErrors { squares: vec![1.0; 4], order: 2.0 };
            let judged = judged(
                &search.runner,
                Difference { errors, cells: vec![even], ..Difference::default() },
                contractions,
            );
            search.improve(&judged, wanted, true).map(|()| search.runner.meshes[0].cells())
        };
        let result = |error: f64| Errors { result: error, ..Errors::default() };
        let wanted = Accuracy::new(1e-4);
        // Of fourth order: sixteen times the error wants twice the cells, but never more than six times.
        let promised = [15.0, 4.0];
        assert_eq!(cells(result(14.0 * 5e-5 * 15.9), promised, wanted, 4096), Ok(8));
        assert_eq!(cells(result(14.0), promised, wanted, 4096), Ok(24));
        // Seen to be of second order: nine times the error wants thrice the cells, and that is the most.
        assert_eq!(cells(result(2.0 * 5e-5 * 3.9), [3.0, 4.0], wanted, 4096), Ok(8));
        assert_eq!(cells(result(2.0 * 5e-5 * 60.0), [3.0, 4.0], wanted, 4096), Ok(12));
        // A tenth more cells at least; no more than there may be, where one mesh is twice the other.
        assert_eq!(cells(result(1e-9), promised, wanted, 4096), Ok(5));
        assert_eq!(cells(result(14.0), promised, wanted, 20), Ok(10));
        assert_eq!(cells(result(14.0), promised, wanted, 9).map_err(drop), Ok(4));
        assert!(cells(result(14.0), promised, wanted, 8).is_err_and(|why| why.contains("more than 8 cells")));
        // Curvatures and section forces are of second order.
        let errors = Errors { result: 0.0, curvature: Some(3.0 * 0.5 * 8.9), section_force: None };
        assert_eq!(cells(errors, promised, Accuracy { curvature: Some(1.0), ..wanted }, 4096), Ok(12));
        assert_eq!(cells(errors, promised, wanted, 4096), Ok(5), "not asked for");
        let errors = Errors { result: 0.0, curvature: None, section_force: Some(3.0 * 0.5 * 3.9) };
        assert_eq!(cells(errors, promised, Accuracy { section_force: Some(1.0), ..wanted }, 4096), Ok(8));
    }

    /// Four cells of which halves would err by 16 times what is aimed at, as fast as errors may fall, become
    /// eight; never more than three times as many. What was seen is of every second node, and of how errors fall
    /// nothing.
    #[test]
    fn too_coarse_meshes_are_made_finer_at_once() {
        let still = scene(STILL);
        let begun = |error: f64| {
            let mut search = Search::new(runner(&still, 1e-3));
            let cells = vec![CellErrors { squares: vec![1.0; 4], order: 2.0 }];
            let errors = Errors { result: 15.0 * 14.0 * error, ..Errors::default() };
            let seen = search.begin_finer(&Difference { errors, cells, ..Difference::default() });
            assert_eq!(seen.cells[0].squares, [2.0, 2.0]);
            let loose = seen.tolerance / search.runner.tolerance;
            (search.runner.meshes[0].cells(), seen.meshes[0].cells(), loose, seen.whole.factor)
        };
        assert_eq!(begun(5e-4 * 15.9), (8, 2, 16.0, 4.0 / 0.75));
        assert_eq!(begun(1.0).0, 12);
    }

    /// The mesh errs by a tenth of what is wanted and the steps by ten times as much: a twentieth of the errors
    /// that are now is the aim, and errors go with the power 3/4 of the tolerance. Where the mesh errs more,
    /// the tolerance stays, unless its errors do not fall from round to round.
    #[test]
    fn what_errs_more_is_made_finer() {
        let motion = scene(MOTION);
        let improved_again = |mesh: f64, steps: f64, caution: f64, [again, falls]: [bool; 2]| {
            let mut search = Search::new(runner(&motion, 1e-4));
            let before = (search.runner.meshes[0].cells(), search.runner.tolerance);
            let cells = vec![CellErrors { squares: vec![1.0; before.0], order: 2.0 }];
            let errors = Errors { result: mesh, ..Errors::default() };
            let mut judged = judged(
                &search.runner,
                Difference { errors, cells, ..Difference::default() },
                [if falls { 2.0 } else { 1.5 }; 2],
            );
            judged.caution = caution;
            judged.round.results.run_mut().analysis = AnalysisKind::Dynamic;
            judged.estimate.as_mut().expect("an estimate").steps = Some(steps);
            search.improve(&judged, Accuracy::new(1e-4), again).expect("what can be finer");
            let (cells, tolerance) = (search.runner.meshes[0].cells(), search.runner.tolerance);
            (cells as f64 / before.0 as f64, tolerance / before.1)
        };
        let improved = |mesh, steps, caution| improved_again(mesh, steps, caution, [true, true]);
        let (cells, tolerance) = improved(1e-5, 1e-3, 1.0);
        assert!(
            cells == 1.0 && (tolerance - 20.0_f64.powf(-4.0 / 3.0)).abs() < 1e-2 * tolerance,
            "{tolerance}"
        );
        let (cells, tolerance) = improved(5e-6, 5e-4, 2.0);
        assert!(
            cells == 1.0 && (tolerance - 20.0_f64.powf(-4.0 / 3.0)).abs() < 1e-2 * tolerance,
            "{tolerance}"
        );
        let (cells, tolerance) = improved(1e-3, 9e-4, 1.0);
        assert!(cells > 2.0 && tolerance == 1.0, "{cells}");
        let (cells, tolerance) = improved_again(1e-3, 9e-4, 1.0, [true, false]);
        assert!(cells > 2.0 && (tolerance - 1.0 / 16.0).abs() < 1e-2, "{cells}, {tolerance}");
        assert_eq!(
            improved_again(1e-3, 9e-4, 1.0, [false, false]).1,
            1.0,
            "nothing is known yet of how errors fall"
        );
    }

    /// Where both runs take the same steps their difference may be that of the steps: these become smaller with the
    /// cells.
    #[test]
    fn steps_whose_errors_are_not_seen_become_smaller_too() {
        let motion = scene(MOTION);
        let improved = |steps: usize| {
            let mut search = Search::new(runner(&motion, 1e-4));
            let before = (search.runner.meshes[0].cells(), search.runner.tolerance);
            let cells = vec![CellErrors { squares: vec![1.0; before.0], order: 2.0 }];
            let errors = Errors { result: 1e-2, ..Errors::default() };
            let mut judged =
                judged(&search.runner, Difference { errors, cells, ..Difference::default() }, [15.0, 4.0]);
            judged.round.results = run(AnalysisKind::Dynamic, steps, 0);
            judged.round.coarse = Some(run(AnalysisKind::Dynamic, 100, 0));
            search.improve(&judged, Accuracy::new(1e-4), false).expect("what can be finer");
            assert!(search.runner.meshes[0].cells() > before.0);
            search.runner.tolerance / before.1
        };
        assert_eq!(improved(200), 1.0);
        assert!((improved(101) * LOOSER - 1.0).abs() < 1e-1, "{}", improved(101));
    }

    /// Meshes of too few cells have fewer critical loads of a short pressed part than are asked for, and cannot be compared: finer ones can.
    #[test]
    fn meshes_that_cannot_be_compared_are_made_finer() {
        let scene = scene(
            "effect.force = [{ beam = 'arm', at = 0.04, value = [-1, 0] }]\nanalysis.buckling = { count = 6, accuracy = 0.3 }",
        );
        let found = Search::new(runner(&scene, 0.3)).run().expect("critical loads");
        let error = found.results.run().error.as_ref().expect("an estimate");
        assert!(error.met && error.runs.len() > 4, "{:?}", error.reason);
    }

    /// A force along a beam within its span makes the strain jump there, which is nothing to a beam beside it.
    #[test]
    fn jumps_of_the_strain_are_errors_of_their_own_beam() {
        let scene = scene(
            "beam.other = { start = [0, 0], end = [0, 4], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 8 }
             joint = [{ type = 'weld', first = { beam = 'arm', at = 'start' }, second = { beam = 'other', at = 'start' } }]
             effect.force = [{ beam = 'arm', at = 2, value = [100, 0] }, { beam = 'other', at = 'end', value = [0.01, 0] }]
             probe = [{ name = 'tip', beam = 'other', at = 'end' }]
             analysis.static = {}",
        );
        let found = Search::new(runner(&scene, 1e-2)).run().expect("an equilibrium");
        let error = found.results.run().error.as_ref().expect("an estimate");
        let last = error.probes[0].samples.last().expect("an equilibrium");
        assert!(last.x < 1e-3, "{}", last.x);
    }

    #[test]
    fn a_mesh_that_the_scene_names_cannot_be_refined() {
        let named = scene("beam.arm.basis.ancf.elements = 4\nanalysis.static = {}");
        let mut search = Search::new(runner(&named, 1e-4));
        let mut judged = judged(&search.runner, Difference::default(), [15.0, 4.0]);
        judged.round.cells = 0;
        assert_eq!(search.improve(&judged, Accuracy::new(1e-4), false), Err(NAMED.to_owned()));
        assert!(!search.refine_everywhere());
    }

    #[test]
    fn everywhere_means_twice_the_cells_and_a_sixteenth_of_the_tolerance() {
        let refined = |more: &str, most: usize| {
            let scene = scene(more);
            let mut search = Search::new(runner(&scene, 1e-3));
            search.most = most;
            (search.refine_everywhere(), search.runner.meshes[0].cells(), search.runner.tolerance)
        };
        assert_eq!(refined(STILL, 4096), (true, 8, 6.3e-5));
        assert_eq!((refined(STILL, 10), refined(STILL, 8)), ((true, 8, 6.3e-5), (false, 4, 6.3e-5)));
        let named = format!("beam.arm.basis.ancf.elements = 8\n{MOTION}");
        assert_eq!(refined(&named, 4096), (true, 4, 6.3e-5), "the integrator is open");
    }

    #[test]
    fn searches_may_take_thousands_of_cells_or_sixteen_times_the_first() {
        let still = scene(STILL);
        assert_eq!(Search::new(runner(&still, 1e-4)).most, 4096);
        let mut fine = runner(&still, 1e-4);
        let nodes: Vec<f64> = (0..=300).map(f64::from).collect();
        fine.meshes = vec![Mesh::of(&nodes)];
        assert_eq!(Search::new(fine).most, 4800);
    }

    #[test]
    fn an_estimate_says_whether_and_until_when_the_accuracy_is_met() {
        let motion = scene(MOTION);
        let estimate = |result: f64, records: [f64; 3]| {
            let search = Search::new(runner(&motion, 1e-4));
            let errors = Errors { result, ..Errors::default() };
            let eigenvalues = vec![6.0];
            let difference =
                Difference { errors, records: records.into(), eigenvalues, ..Difference::default() };
            let mut judged = judged(&search.runner, difference, [4.0, 4.0]);
            let parameter = vec![0.0, 0.5, 1.0];
            judged.round.results = Trajectory { parameter, ..Trajectory::default() }.into();
            *search.finished(judged, None).results.run_mut().error.take().expect("an estimate")
        };
        let found = estimate(3e-4, [0.0, 1e-4, 3e-4]);
        assert!(found.met && found.good_until.is_none() && (found.estimated.result - 1e-4).abs() < 1e-19);
        assert_eq!((found.eigenvalues, found.records[2] * 3.0), (vec![2.0], 3e-4));
        let found = estimate(6e-4, [0.0, 1e-4, 6e-4]);
        assert_eq!((found.met, found.good_until), (false, Some(0.5)));
        assert_eq!(estimate(6e-4, [6e-4, 1e-4, 0.0]).good_until, None, "from the first record on");
    }
}
