//! Results that know their error: everything that a scene leaves open is chosen for the accuracy
//! that is wanted.
//!
//! ```text
//! wanted ─► mesh, tolerance ─► run ───────────────┐
//!   ▲             └─► halved, a 16th ─► run ──────┴─► difference ─► error ─► small enough: done
//!   └───────── cells and steps where they are needed ◄───────────────┘ else
//! ```
//!
//! # The estimate
//! A mesh and its halves, and a tolerance and its sixteenth, give two results u_c and u_f whose
//! errors go like e_f = e_c/k. Then u_c − u_f = (k − 1) e_f but for its sign. Cells of half the
//! length err 16 times less in positions, frequencies and critical loads, and less than that where
//! something acts inside a cell; a 16th of the tolerance makes motions err about 8 times less.
//!
//! A pair alone cannot tell k, nor whether the meshes see what decides: a boundary layer that is
//! thinner than a cell changes little from one mesh to the next. So a third run on half the coarse
//! mesh comes first, and k is three quarters of the factor by which the differences of the three
//! fall, later by which they fall from round to round; but no more than the method promises.
//! Curvatures and section forces are of second order: their k is 4, or less.
//!
//! The result is that of the finer run, as it would be without any estimate: the scene with what
//! was chosen gives the same numbers.

pub(crate) mod difference;
mod mesh;
mod model_error;
pub(crate) mod setting;

use crate::basis::Basis;
use crate::centreline::Curve;
use crate::model::{
    Accuracy, Analysis, Discretization, GaussPoints, Integrator, Model, Nodes, Open, StepControl,
};
use crate::results::{
    AnalysisKind, BeamErrors, ErrorEstimate, Errors, ProbeErrors, ProbeSample, Results, RunForError,
};
use crate::run::{Options, RunError};
use crate::scene::Scene;
use difference::{Difference, Stations};
use mesh::{CellErrors, Mesh};
use setting::{Setting, Solver};

/// By how much the error falls from the coarse run to the finer one at most: of equilibria and
/// modes …
const CONTRACTION: f64 = 15.0;
/// … of motions …
const CONTRACTION_OF_MOTION: f64 = 8.0;
/// … of curvatures and section forces, and of all results of a method of second order …
const CONTRACTION_OF_CURVATURE: f64 = 4.0;
/// … and at least, however slowly it was seen to fall.
const LEAST_CONTRACTION: f64 = 1.5;
/// Errors that fall by more than so many times the promised factor begin beyond all use.
const TOO_FAST: f64 = 2.5;
/// The factor that is taken, in the factor that was seen.
const CAUTION: f64 = 0.75;
/// The tolerance of the coarse run, in that of the finer one.
const LOOSER: f64 = 16.0;
/// Loosest tolerance of any run.
const LOOSEST: f64 = 0.1;
/// Tolerance of the first finer run, in the wanted error.
const TOLERANCE: f64 = 3.0;
/// Most rounds of two or three runs.
const ROUNDS: usize = 8;
/// Rounds without a mesh on which both runs come to their end.
const FAILURES: usize = 4;
/// Loosest tolerance of the first finer run: beyond, other things than the tolerance decide about
/// steps.
const FIRST_TOLERANCE: f64 = 1e-3;
/// Two motions of which the finer one takes less than so many times the steps of the coarse one
/// tell nothing of the errors of their steps.
const MORE_STEPS: f64 = 1.2;
/// Most times that the tolerance is reduced for that.
const MUTE: usize = 3;
/// Part of the wanted error that the next round aims at.
const AIM: f64 = 0.5;
/// Most cells of all beams …
const CELLS: usize = 4096;
/// … or so many times those with which the search begins.
const CELLS_MORE: usize = 16;
/// Accuracies below this are beyond what doubles and iterations leave.
const ROUND_OFF: f64 = 1e-12;
/// Most times as many cells, and fewer tolerance, in the next round.
const LEAP: f64 = 6.0;
/// Errors of positions, in beam lengths, beyond which two motions have nothing in common.
const LOST: f64 = 0.2;
/// Errors that did not fall below this part of what they were, in spite of a finer mesh or smaller
/// steps, will not fall.
const STALLED: f64 = 0.7;
/// The records around one whose errors count for it, on either side, as a part of the run.
const WINDOW: usize = 20;
/// Rounds in succession that gain nothing before the search gives up.
const STALLS: usize = 2;
/// Why errors do not fall.
const SEVERAL: &str = "finer meshes and smaller steps do not bring the results nearer to each other: there are several solutions, or \
                       errors grow with time";
/// Why nothing is known of a motion whose steps the tolerance does not decide about.
const MUTE_STEPS: &str = "with a looser tolerance the motion takes hardly fewer steps, so that the errors of its steps cannot be seen; give a \
                          smaller tolerance, or leave the integrator out";
/// Why nothing can be refined.
const NAMED: &str =
    "the scene names the basis of every beam, and with it the mesh: leave it out, or give it more nodes";
/// Wanted errors down to which the usual tolerance of equilibria does …
const USUAL_IS_ENOUGH: f64 = 1e-8;
/// … and that of others, in the wanted error.
const EQUILIBRIUM: f64 = 1e-2;
/// Smallest tolerance of any run.
const FINEST: f64 = 1e-13;

/// Results as accurate as was wanted, and how they were come by.
#[derive(Clone, Debug)]
pub struct Accurate {
    /// The results; their [`Run::error`](crate::results::Run::error) is there.
    pub results: Results,
    /// What was chosen, as lines of a scene.
    pub chosen: String,
}

/// Solves a scene: with everything chosen that it leaves open where it asks for an accuracy, and
/// else as it stands.
///
/// # Errors
/// As [`solve`].
pub fn run(scene: &Scene, options: Options<'_>) -> Result<Results, RunError> {
    let Some(wanted) = scene.accuracy() else {
        return scene.model().solve_with(scene.analysis(), options);
    };
    let Accurate { mut results, chosen } =
        solve(scene.model(), scene.analysis(), scene.open(), wanted, options)?;
    match scene.chosen(&chosen) {
        Ok(chosen) => {
            if let Some(error) = &mut results.run_mut().error {
                error.chosen = Some(chosen.text().to_owned());
            }
        }
        Err(error) => {
            let warning = format!("the scene with what was chosen cannot be written: {}", error.brief());
            results.run_mut().warnings.push(warning);
        }
    }
    Ok(results)
}

/// The model and the analysis with which the search for the accuracy of a scene begins; those of
/// the scene where it leaves nothing open.
pub fn first(scene: &Scene) -> (Model, Analysis) {
    let (model, analysis) = (scene.model(), scene.analysis());
    if scene.accuracy().is_none() || scene.open().is_closed() {
        return (model.clone(), analysis.clone());
    }
    let search = Search::new(model, analysis, scene.open(), scene.accuracy(), Options::default());
    search.setting(Fineness::Fine, Fineness::Fine).apply(model, analysis)
}

/// Solves `model` with everything chosen that is `open`, so that no error is larger than `wanted`.
/// An estimate that says that this was not reached is no failure here: see
/// [`ErrorEstimate::met`].
///
/// # Errors
/// [`RunError`], of the last run, where no pair of runs came to its end.
pub fn solve(
    model: &Model,
    analysis: &Analysis,
    open: &Open,
    wanted: Accuracy,
    options: Options<'_>,
) -> Result<Accurate, RunError> {
    Search::new(model, analysis, open, Some(wanted), options).run()
}

/// Solves `model` as it is and estimates the errors of the results by a run on half as many cells
/// with larger steps.
///
/// # Errors
/// [`RunError`], where the model cannot be solved as it is.
pub fn estimate(model: &Model, analysis: &Analysis, options: Options<'_>) -> Result<Results, RunError> {
    let open = Open { beams: vec![false; model.beams.len()], integrator: false };
    Ok(Search::new(model, analysis, &open, None, options).run()?.results)
}

struct Search<'a, 'o> {
    model: &'a Model,
    analysis: &'a Analysis,
    open: &'a Open,
    wanted: Option<Accuracy>,
    options: Options<'o>,
    /// Of the coarse runs.
    meshes: Vec<Mesh>,
    /// Of the finer runs of a motion whose integrator is open.
    tolerance: f64,
    runs: Vec<RunForError>,
    /// Most cells of all beams.
    most: usize,
}

/// Which of the runs of a round.
#[derive(Clone, Copy, PartialEq)]
enum Fineness {
    Coarsest,
    Coarse,
    Fine,
}

/// What a round found.
struct Round {
    stations: Stations,
    /// Of the finer run, stations included, as of the coarse one.
    results: Results,
    coarse: Option<Results>,
    setting: Setting,
    difference: Result<Difference, String>,
    /// By which factor the difference has fallen, where there was a third run.
    fall: Option<f64>,
    /// Cells of the open beams.
    cells: usize,
}

/// A round with what is known of its errors.
struct Judged {
    round: Round,
    difference: Option<Difference>,
    contractions: [f64; 2],
    /// The largest error in units of what was wanted.
    excess: f64,
}

impl Judged {
    /// Nothing is known.
    fn unknown(round: Round) -> Self {
        Self { round, difference: None, contractions: [LEAST_CONTRACTION; 2], excess: f64::INFINITY }
    }
}

/// What a round has seen.
struct Seen {
    cells: usize,
    tolerance: f64,
    error: f64,
    /// The largest difference in units of what is wanted of it.
    excess: f64,
}

impl Seen {
    /// By which factor errors fall if cells are halved, as they have fallen to those of a later
    /// round; `None` where that is hardly finer.
    fn fall_to(&self, later: &Self) -> Option<f64> {
        let cells = later.cells as f64 / self.cells as f64;
        // A 16th of the tolerance goes with halved cells.
        let finer = cells.max((self.tolerance / later.tolerance).powf(LOOSER.log2().recip()));
        (finer > 1.2).then(|| (self.error / later.error).powf(finer.log2().recip()))
    }
}

impl Round {
    /// Whether the finer run of a motion takes more steps than the coarse one.
    fn tells_of_steps(&self) -> bool {
        let steps = |results: &Results| {
            let counts = results.run().statistics;
            (counts.steps + counts.rejected_steps) as f64
        };
        let moves = self.results.run().analysis == AnalysisKind::Dynamic;
        !moves || self.coarse.as_ref().is_none_or(|coarse| steps(&self.results) >= MORE_STEPS * steps(coarse))
    }
}

impl<'a, 'o> Search<'a, 'o> {
    fn new(
        model: &'a Model,
        analysis: &'a Analysis,
        open: &'a Open,
        wanted: Option<Accuracy>,
        options: Options<'o>,
    ) -> Self {
        let waves = match analysis {
            Analysis::Modal(settings) => settings.count,
            Analysis::Buckling(settings) => settings.count,
            _ => 0,
        };
        let mut meshes = Mesh::first(model, waves);
        for (beam, mesh) in model.beams.iter().zip(&mut meshes) {
            if beam.discretization != Discretization::Open {
                let curve = Curve::new(&beam.centreline);
                let nodes = curve.ok().and_then(|curve| {
                    let nodes = Discretization::Ancf { nodes: beam.discretization.nodes().clone() };
                    Basis::new(&nodes, curve.length()).ok().map(|basis| basis.nodes().to_vec())
                });
                if let Some(nodes) = nodes {
                    *mesh = mesh.every_second_of(&nodes);
                }
            }
        }
        let result = wanted.map_or(Accuracy::USUAL, |wanted| wanted.result);
        let tolerance = short((TOLERANCE * result).min(FIRST_TOLERANCE));
        let cells: usize = meshes.iter().map(Mesh::cells).sum();
        let most = CELLS.max(CELLS_MORE * cells);
        Self { model, analysis, open, wanted, options, meshes, tolerance, runs: Vec::new(), most }
    }

    fn is_open(&self, beam: usize) -> bool {
        self.open.beams.get(beam).copied().unwrap_or(false)
    }

    /// The setting of a run on meshes and with steps of such a fineness.
    fn setting(&self, mesh: Fineness, steps: Fineness) -> Setting {
        let beams = self.model.beams.iter().zip(&self.meshes).enumerate().map(|(index, (beam, coarse))| {
            let nodes = match mesh {
                Fineness::Coarsest => coarse.every_second_of(&coarse.nodes).places(),
                Fineness::Coarse => coarse.places(),
                Fineness::Fine => coarse.halved().places(),
            };
            let discretization = match (self.is_open(index), mesh) {
                (true, _) => Discretization::Ancf { nodes },
                (false, Fineness::Fine) => beam.discretization.clone(),
                (false, _) => coarser(&beam.discretization, nodes),
            };
            let points = match self.is_open(index) {
                true => GaussPoints::usual(&discretization, &beam.section),
                false => beam.gauss_points,
            };
            (discretization, points)
        });
        let solver = match self.analysis {
            Analysis::Dynamic(settings) => {
                let halvings = match steps {
                    Fineness::Coarsest => 2,
                    Fineness::Coarse => 1,
                    Fineness::Fine => 0,
                };
                let integrator = match self.open.integrator {
                    true => Integrator::usual(StepControl::Tolerance(self.tolerance)),
                    false => settings.integrator,
                };
                Solver::Integrator(integrator.with_step(match integrator.step_control() {
                    StepControl::Fixed(step) => {
                        StepControl::Fixed((2.0_f64.powi(halvings) * step).min(settings.duration))
                    }
                    StepControl::Tolerance(tolerance) => {
                        StepControl::Tolerance(short(LOOSER.powi(halvings) * tolerance).min(LOOSEST))
                    }
                }))
            }
            Analysis::Static(_) => self.static_tolerance().map_or(Solver::Scene, Solver::Tolerance),
            _ => Solver::Scene,
        };
        Setting { beams: beams.collect(), solver }
    }

    /// The tolerance of equilibria where that of the solver may not do, and the scene names none.
    fn static_tolerance(&self) -> Option<f64> {
        let Analysis::Static(settings) = self.analysis else { return None };
        let wanted = self.wanted.filter(|wanted| wanted.result < USUAL_IS_ENOUGH)?.result;
        settings.tolerance.is_none().then(|| short((EQUILIBRIUM * wanted).max(FINEST)))
    }

    /// Solves the watched model with a setting.
    fn solve(&mut self, stations: &Stations, setting: &Setting, frames: usize) -> Result<Results, RunError> {
        let (model, analysis) = setting.apply(&stations.watch(self.model), self.analysis);
        let Options { start, observer, checkpoints, .. } = &mut self.options;
        let options = Options {
            start: *start,
            observer: observer.as_mut().map(|observer| &mut **observer as _),
            checkpoints: *checkpoints,
            frames,
        };
        let results = model.solve_with(&analysis, options)?;
        let run = results.run();
        let cells: usize = setting.beams.iter().map(|(beam, _)| beam.nodes().count().saturating_sub(1)).sum();
        self.runs.push(RunForError {
            setting: match setting.solver {
                Solver::Scene => format!("{cells} cells"),
                solver => format!("{cells} cells, {solver}"),
            },
            degrees_of_freedom: run.degrees_of_freedom,
            seconds: run.seconds.build + run.seconds.solve,
            error: None,
        });
        Ok(results)
    }

    /// A coarse run and a finer one; in the first round one that is still coarser, too.
    fn round(&mut self, first: bool) -> Result<Round, RunError> {
        let stations = Stations::new(self.model, &self.meshes);
        let mut pair = |fineness| self.solve(&stations, &self.setting(fineness, fineness), 0);
        let coarsest = if first { pair(Fineness::Coarsest).ok() } else { None };
        let coarse = pair(Fineness::Coarse);
        let setting = self.setting(Fineness::Fine, Fineness::Fine);
        let results = self.solve(&stations, &setting, self.options.frames)?;
        let difference = match &coarse {
            Ok(coarse) if coarse.run().complete => self.difference(&stations, coarse, &results),
            Ok(_) => Err("the run on fewer cells was stopped".to_owned()),
            Err(error) => Err(format!("on half as many cells there is no result: {error}")),
        };
        let before = coarsest.as_ref().zip(coarse.as_ref().ok());
        let before = before.and_then(|(a, b)| self.difference(&stations, a, b).ok());
        let fall = before
            .zip(difference.as_ref().ok())
            .map(|(before, now)| before.errors.result / now.errors.result);
        let of_open = |(index, mesh): (usize, &Mesh)| if self.is_open(index) { mesh.cells() } else { 0 };
        let cells = self.meshes.iter().enumerate().map(of_open).sum();
        Ok(Round { stations, results, coarse: coarse.ok(), setting, difference, fall, cells })
    }

    fn difference(
        &self,
        stations: &Stations,
        coarse: &Results,
        fine: &Results,
    ) -> Result<Difference, String> {
        difference::between(self.model, self.analysis, (stations, &self.meshes), coarse, fine)
    }

    /// The fall of errors that is believed of the first three runs: where the coarsest was of no use
    /// at all, its difference tells nothing.
    fn first_fall(&self, seen: Option<f64>) -> f64 {
        let unknown = CONTRACTION_OF_CURVATURE / CAUTION;
        let [promised, _] = self.contractions(f64::INFINITY);
        seen.filter(|fall| *fall <= TOO_FAST * promised).unwrap_or(unknown)
    }

    /// Factors by which errors fall from a coarse run to a finer one: as the methods promise, and
    /// of the result no more than was seen.
    fn contractions(&self, seen: f64) -> [f64; 2] {
        let second = match self.analysis {
            Analysis::Dynamic(settings) if !self.open.integrator => matches!(
                settings.integrator,
                Integrator::GeneralizedAlpha { step: StepControl::Fixed(_), .. }
                    | Integrator::Gauss { stages: 1, step: StepControl::Fixed(_) }
            ),
            _ => false,
        };
        let result = match self.analysis {
            _ if second => CONTRACTION_OF_CURVATURE,
            Analysis::Dynamic(_) => CONTRACTION_OF_MOTION,
            _ => CONTRACTION,
        };
        let seen = if seen.is_nan() { result } else { CAUTION * seen };
        [result.min(seen).max(LEAST_CONTRACTION), CONTRACTION_OF_CURVATURE]
    }

    fn run(mut self) -> Result<Accurate, RunError> {
        let mut before: Option<Seen> = None;
        let mut best: Option<Judged> = None;
        let (mut rounds, mut stalls, mut failures, mut mute) = (0, 0, 0, 0);
        loop {
            let round = match self.round(before.is_none()) {
                Ok(round) => round,
                // What is wrong with the model is wrong on all meshes.
                Err(error) if error.exit_status() == 2 => return Err(error),
                Err(error) => {
                    failures += 1;
                    if failures < FAILURES && self.refine_everywhere() {
                        continue;
                    }
                    return match best {
                        Some(best) => Ok(self.finished(best, Some(error.to_string()))),
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
                    failures += 1;
                    if failures < FAILURES && self.refine_everywhere() {
                        continue;
                    }
                    let why = Some(why.clone());
                    return Ok(self.finished(best.unwrap_or_else(|| Judged::unknown(round)), why));
                }
            };
            if self.open.integrator && mute < MUTE && !round.tells_of_steps() {
                // Something else than the tolerance decides about steps: a smaller one will.
                mute += 1;
                self.tolerance = short((self.tolerance / LOOSER).max(FINEST));
                continue;
            }
            if !self.open.integrator && !round.tells_of_steps() {
                return Ok(self.finished(Judged::unknown(round), Some(MUTE_STEPS.to_owned())));
            }
            rounds += 1;
            let now = Seen {
                cells: round.cells,
                tolerance: self.tolerance,
                error: difference.errors.result,
                excess: self.wanted.map_or(0.0, |wanted| excess(difference.errors, wanted)),
            };
            let fall = match &before {
                None => self.first_fall(round.fall),
                Some(before) => before.fall_to(&now).unwrap_or(f64::INFINITY),
            };
            let contractions = self.contractions(fall);
            stalls = match &before {
                Some(before) if now.excess > STALLED * before.excess => stalls + 1,
                _ => 0,
            };
            let errors = scaled(difference.errors, contractions);
            if let Some(last) = self.runs.last_mut() {
                last.error = Some(errors.result);
            }
            let excess = self.wanted.map_or(0.0, |wanted| excess(errors, wanted));
            let judged = Judged { round, difference: Some(difference), contractions, excess };
            let Some(wanted) = self.wanted.filter(|_| excess > 1.0) else {
                return Ok(self.finished(judged, None));
            };
            let why = if wanted.result < ROUND_OFF {
                Some(format!("errors below {ROUND_OFF:e} are those of round-off"))
            } else if stalls >= STALLS {
                Some(SEVERAL.to_owned())
            } else if let Some(growth) = self.outgrown(&judged, wanted) {
                Some(growth)
            } else if rounds >= ROUNDS {
                Some(format!("{ROUNDS} rounds of finer meshes and smaller steps were not enough"))
            } else {
                self.improve(&judged, wanted).err()
            };
            before = Some(now);
            let best_now = match best {
                Some(best) if best.excess <= judged.excess => best,
                _ => judged,
            };
            if why.is_some() {
                return Ok(self.finished(best_now, why));
            }
            best = Some(best_now);
        }
    }

    /// Why no steps are small enough for a motion whose errors grow with time: as fast as they grew
    /// from what is wanted to what tells nothing any more, they would have to begin below all
    /// tolerances.
    fn outgrown(&self, judged: &Judged, wanted: Accuracy) -> Option<String> {
        let Analysis::Dynamic(_) = self.analysis else { return None };
        let difference = judged.difference.as_ref()?;
        let times = &judged.round.results.states().parameter;
        let divide = judged.contractions[0] - 1.0;
        let passes = |level: f64| {
            let first = difference.records.iter().position(|error| error / divide > level)?;
            times.get(first).copied()
        };
        let (good, lost, end) = (passes(wanted.result)?, passes(LOST)?, *times.last()?);
        if lost <= good || wanted.result >= LOST {
            return None;
        }
        // Errors grow like exp(λ t).
        let rate = (LOST / wanted.result).ln() / (lost - good);
        let needed = rate * (end - good);
        let left = (self.tolerance / FINEST).ln();
        // Errors go with a power of 0.75 of the tolerance.
        (0.75 * left < needed).then(|| {
            let twice = std::f64::consts::LN_2 / rate;
            format!("errors of this motion double every {twice:.2} s, so that no steps are small enough for all of it")
        })
    }

    /// Finer meshes where cells err and smaller steps where steps err, so that the next round is
    /// good enough; why this cannot be.
    fn improve(&mut self, judged: &Judged, wanted: Accuracy) -> Result<(), String> {
        let Judged { round, difference, contractions, .. } = judged;
        let contractions = *contractions;
        let mut space = difference.clone().unwrap_or_default();
        let mut steps = false;
        if self.open.integrator
            && let Some(coarse) = &round.coarse
            // A run on the coarse mesh with the finer steps tells the errors of both apart.
            && let Ok(between) = self.solve(&round.stations, &self.setting(Fineness::Coarse, Fineness::Fine), 0)
            && let Ok(time) = self.difference(&round.stations, coarse, &between)
            && let Ok(mesh) = self.difference(&round.stations, &between, &round.results)
        {
            let ratio = scaled(time.errors, contractions).result / (AIM * wanted.result);
            if ratio > 1.0 {
                // Errors go with a power of 0.75 of the tolerance.
                self.tolerance =
                    short((self.tolerance / ratio.min(LEAP.powi(3)).powf(4.0 / 3.0)).max(FINEST));
                steps = true;
            }
            space = mesh;
        }
        let errors = scaled(space.errors, contractions);
        let order = (contractions[0] / CAUTION).log2().clamp(1.0, 4.0);
        let needed = |error: Option<f64>, wanted: Option<f64>, order: f64| {
            error.zip(wanted).map_or(0.0, |(error, wanted)| (error / (AIM * wanted)).powf(order.recip()))
        };
        let times = needed(Some(errors.result), Some(wanted.result), order)
            .max(needed(errors.curvature, wanted.curvature, 2.0))
            .max(needed(errors.section_force, wanted.section_force, 2.0))
            .min(LEAP);
        if steps && (times <= 1.0 || round.cells == 0) {
            return Ok(());
        }
        if round.cells == 0 {
            return Err(NAMED.to_owned());
        }
        let most = self.most;
        if 2 * round.cells >= most {
            return Err(format!("more than {most} cells would be needed"));
        }
        let errors: Vec<Option<CellErrors>> = space
            .cells
            .iter()
            .enumerate()
            .map(|(index, cells)| self.is_open(index).then(|| cells.clone()))
            .collect();
        self.meshes = mesh::refined(&self.meshes, &errors, times.max(1.1), most / 2);
        Ok(())
    }

    /// Twice the cells in all open beams, and steps to match; whether there was any to refine.
    fn refine_everywhere(&mut self) -> bool {
        let mut any = self.open.integrator;
        for index in 0..self.meshes.len() {
            if self.is_open(index) && self.meshes[index].cells() < self.most / 2 {
                self.meshes[index] = self.meshes[index].halved();
                any = true;
            }
        }
        self.tolerance = short((self.tolerance / LOOSER).max(FINEST));
        any
    }

    /// The results of a round with what is known of their errors.
    fn finished(self, judged: Judged, reason: Option<String>) -> Accurate {
        let Judged { round, difference, contractions, .. } = judged;
        let Round { stations, mut results, setting, .. } = round;
        let lengths: Vec<f64> = self.meshes.iter().map(Mesh::length).collect();
        let largest = model_error::largest(stations.of_beams(results.states()), results.states());
        let notes = model_error::notes(self.model, &lengths, &largest);
        stations.strip(&mut results);
        let solver = self.open.integrator || self.static_tolerance().is_some();
        let chosen = setting.toml_of(self.model, |beam| self.is_open(beam), solver);
        let wanted = self.wanted.map(|wanted| Errors {
            result: wanted.result,
            curvature: wanted.curvature,
            section_force: wanted.section_force,
        });
        let unknown = Errors { result: f64::INFINITY, ..Errors::default() };
        let mut estimate = ErrorEstimate {
            wanted,
            reason,
            notes,
            runs: self.runs,
            estimated: unknown,
            ..ErrorEstimate::default()
        };
        if let Some(difference) = difference {
            let divide = [contractions[0] - 1.0, contractions[1] - 1.0];
            estimate.estimated = scaled(difference.errors, contractions);
            estimate.eigenvalues = difference.eigenvalues.iter().map(|error| error / divide[0]).collect();
            estimate.records = difference.records.iter().map(|error| error / divide[0]).collect();
            estimate.probes = difference.probes.into_iter().map(|probe| of_probe(probe, divide)).collect();
            estimate.beams = difference.beams.into_iter().map(|beam| of_beam(beam, divide)).collect();
            estimate.met = self.wanted.is_none_or(|wanted| excess(estimate.estimated, wanted) <= 1.0);
        }
        if let Some(wanted) = self.wanted
            && !estimate.met
        {
            let states = results.states();
            let first = estimate.records.iter().position(|error| *error > wanted.result);
            estimate.good_until =
                first.and_then(|first| states.parameter.get(first.checked_sub(1)?).copied());
        }
        results.run_mut().error = Some(Box::new(estimate));
        Accurate { results, chosen }
    }
}

/// Two digits, which is enough for a tolerance.
fn short(tolerance: f64) -> f64 {
    format!("{tolerance:.1e}").parse().unwrap_or(tolerance)
}

/// Errors of the finer run from its differences to the coarse one.
fn scaled(errors: Errors, [result, curvature]: [f64; 2]) -> Errors {
    Errors {
        result: errors.result / (result - 1.0),
        curvature: errors.curvature.map(|error| error / (curvature - 1.0)),
        section_force: errors.section_force.map(|error| error / (curvature - 1.0)),
    }
}

/// The largest error in units of what was wanted.
fn excess(errors: Errors, wanted: Accuracy) -> f64 {
    let of = |error: Option<f64>, wanted: Option<f64>| {
        error.zip(wanted).map_or(0.0, |(error, wanted)| error / wanted)
    };
    (errors.result / wanted.result)
        .max(of(errors.curvature, wanted.curvature))
        .max(of(errors.section_force, wanted.section_force))
}

/// Errors oscillate, and a moment at which two runs agree by chance is no better than those around
/// it: the largest within a twentieth of the run on either side.
fn of_probe(mut probe: ProbeErrors, [result, curvature]: [f64; 2]) -> ProbeErrors {
    let reach = probe.samples.len() / WINDOW;
    let around: Vec<ProbeSample> = (0..probe.samples.len())
        .map(|i| {
            let last = (i + reach).min(probe.samples.len() - 1);
            if probe.samples[i].x.is_nan() {
                return probe.samples[i];
            }
            probe.samples[i.saturating_sub(reach)..=last].iter().fold(
                ProbeSample::default(),
                |most, sample| {
                    let of = |a: Option<f64>, b: Option<f64>| b.map(|b| a.map_or(b, |a| a.max(b)));
                    ProbeSample {
                        x: most.x.max(sample.x),
                        y: most.y.max(sample.y),
                        angle: most.angle.max(sample.angle),
                        curvature: most.curvature.max(sample.curvature),
                        strain: most.strain.max(sample.strain),
                        vx: of(most.vx, sample.vx),
                        vy: of(most.vy, sample.vy),
                    }
                },
            )
        })
        .collect();
    probe.samples = around;
    for sample in &mut probe.samples {
        sample.x /= result;
        sample.y /= result;
        sample.angle /= result;
        sample.strain /= curvature;
        sample.curvature /= curvature;
        sample.vx = sample.vx.map(|v| v / result);
        sample.vy = sample.vy.map(|v| v / result);
    }
    probe
}

fn of_beam(mut beam: BeamErrors, [result, curvature]: [f64; 2]) -> BeamErrors {
    beam.position.iter_mut().for_each(|error| *error /= result);
    beam.curvature.iter_mut().for_each(|error| *error /= curvature);
    beam
}

/// The same kind of discretisation on fewer nodes.
fn coarser(discretization: &Discretization, places: Nodes) -> Discretization {
    match discretization {
        Discretization::Rpim { kernel, polynomial_terms, side_condition, neighbours, .. } => {
            Discretization::Rpim {
                nodes: places,
                kernel: *kernel,
                polynomial_terms: *polynomial_terms,
                side_condition: *side_condition,
                neighbours: *neighbours,
            }
        }
        _ => Discretization::Ancf { nodes: places },
    }
}
