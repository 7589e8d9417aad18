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
//! fall, later by which they fall from round to round; but no more than the method promises. Where cells
//! have moved, differences before and after do not tell how errors fall, as those of positions need not come
//! from where curvatures err: there are three runs again.
//! Where the mesh and the steps of a motion do not fall alike, a run on the coarse mesh with the finer
//! steps tells their errors apart: each has its own k, and what is stated is the sum of both.
//! Curvatures and section forces are of second order: their k is 4, or less. Where these first two
//! runs show that errors would be too large on halved cells even if they fell as the method
//! promises, or that equilibria are a tenth of a beam length apart, those are not paid for: the
//! search goes on with a finer mesh at once.
//!
//! Whether an accuracy is met is decided with these largest errors. What is then stated is what is most
//! likely: the geometric mean of the largest error and the smallest one, which falls as fast as was seen.
//!
//! Radial shape functions that a scene names may have errors that no finer mesh removes, so that all
//! meshes agree. Where they do, elements on the same nodes are asked as well, and errors are taken to
//! be at least the difference.
//!
//! The result is that of the finer run, as it would be without any estimate: the scene with what
//! was chosen gives the same numbers.

pub(crate) mod difference;
mod judgement;
mod mesh;
mod missing;
mod model_error;
mod prospect;
mod round;
mod runner;
mod saturation;
mod search;
pub(crate) mod setting;
mod stages;
mod statement;

use crate::model::{About, Accuracy, Analysis, Model, Open, Place, Stage};
use crate::results::{LazyText, Results};
use crate::run::{Options, RunError, StagesRun, solve_stages, solve_stages_by};
use crate::scene::Scene;
use runner::{Fineness, Runner};
use search::Search;
use stages::Starts;

/// Accuracy of the equilibrium that tells where nodes must be.
const PLACES: f64 = 1e-4;
/// Such places of several equilibria that are nearer to each other, in beam lengths, share a node: in a cell the error is that of a corner
/// times the square of its distance from the node. That of vibrations is not, and all of theirs have one.
const NEAR: f64 = 2e-3;
/// At so many places of each beam its forces are known, and linear between them.
const ROWS: usize = 2001;

/// Results as accurate as was wanted, and how they were come by.
#[derive(Clone, Debug)]
pub struct Accurate {
    /// The results; their [`Run::error`](crate::results::Run::error) is there.
    pub results: Results,
    /// What was chosen, as lines of a scene.
    pub chosen: String,
    /// Where forces pass corners of laws.
    corners: Vec<Place>,
}

impl Accurate {
    fn is_met(&self) -> bool {
        self.results.run().error.as_ref().is_some_and(|error| error.met)
    }
}

/// Solves a scene: with everything chosen that it leaves open where it asks for an accuracy, and
/// else as it stands. Of a scene with stages these are the results of the last one; see
/// [`solve_stages`] for all.
///
/// # Errors
/// As [`solve`].
pub fn run(scene: &Scene, options: Options<'_>) -> Result<Results, RunError> {
    if !scene.stages().is_empty() {
        return solve_stages(scene.stages(), options).last();
    }
    let Some(wanted) = scene.accuracy() else {
        return scene.model().solve_with(scene.analysis(), options);
    };
    let Accurate { mut results, chosen, .. } =
        solve(scene.model(), scene.analysis(), scene.open(), wanted, options)?;
    if let Some(error) = &mut results.run_mut().error {
        error.usual = !scene.names_accuracy();
        error.chosen = Some(LazyText::new(scene.chosen_later(chosen)));
    }
    Ok(results)
}

/// The model and the analysis with which the search for the accuracy of a scene begins; those of
/// the scene where it asks for none.
pub fn first(scene: &Scene) -> (Model, Analysis) {
    let (model, analysis) = (scene.model(), scene.analysis());
    if scene.accuracy().is_none() {
        return (model.clone(), analysis.clone());
    }
    let runner = Runner::new(model, analysis, scene.open(), scene.accuracy(), Options::default());
    runner.setting(Fineness::Fine, Fineness::Fine).apply(model, analysis)
}

/// Solves `model` with everything chosen that is `open`, so that no error is larger than `wanted`.
/// An estimate that says that this was not reached is no failure here: see
/// [`ErrorEstimate::met`](crate::results::ErrorEstimate::met).
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
    let jumps = stiffness_jumps(model, analysis, open, wanted, &options);
    let mut options = options;
    let mut missed = None;
    if !jumps.is_empty() {
        let mut with_nodes = model.clone();
        with_nodes.nodes_at.extend(jumps);
        match Search::new(Runner::new(&with_nodes, analysis, open, Some(wanted), options.again())).run() {
            Ok(found) if found.is_met() || !found.results.run().complete => return Ok(found),
            found => missed = Some(found),
        }
    }
    // Where such nodes are in the way of an equilibrium, other meshes may do.
    let found = Search::new(Runner::new(model, analysis, open, Some(wanted), options)).run();
    match (found, missed) {
        (Ok(found), Some(Ok(missed))) if !found.is_met() => Ok(missed),
        (Err(_), Some(missed)) => missed,
        (found, _) => found,
    }
}

/// Where there must be nodes since the stiffness of open beams jumps in equilibria, or in that about which they vibrate: where
/// their forces pass corners of their laws. A first search, which wants no more than [`PLACES`], finds them.
fn stiffness_jumps(
    model: &Model,
    analysis: &Analysis,
    open: &Open,
    wanted: Accuracy,
    options: &Options<'_>,
) -> Vec<Place> {
    let rests = match analysis {
        Analysis::Modal(settings) => settings.about == About::Equilibrium,
        Analysis::Static(_) => true,
        _ => false,
    };
    let linear = model.beams.iter().all(|beam| beam.section.is_linear());
    if !rests || linear {
        return Vec::new();
    }
    let wanted = Accuracy::new(wanted.result.max(PLACES));
    let Options { start, cache, .. } = *options;
    let first = Options { start, cache, shape_points: ROWS, ..Options::default() };
    // What fails here fails again, and is told then.
    let Ok(found) = Search::new(Runner::new(model, analysis, open, Some(wanted), first)).run() else {
        return Vec::new();
    };
    let shapes = &found.results.states().last;
    let length = |beam: usize| shapes.get(beam).and_then(|shape| shape.s.last()).copied().unwrap_or(0.0);
    let near = if matches!(analysis, Analysis::Static(_)) { NEAR } else { 0.0 };
    let open_beams = found.corners.into_iter().filter(|place| open.beams.get(place.beam) == Some(&true));
    open_beams.fold(Vec::new(), |mut places: Vec<Place>, place| {
        let near = near * length(place.beam);
        if places.iter().all(|other| other.beam != place.beam || (other.s - place.s).abs() > near) {
            places.push(place);
        }
        places
    })
}

/// Solves `model` as it is and estimates the errors of the results by a run on half as many cells
/// with larger steps.
///
/// # Errors
/// [`RunError`], where the model cannot be solved as it is.
pub fn estimate(model: &Model, analysis: &Analysis, options: Options<'_>) -> Result<Results, RunError> {
    let open = Open::none(model);
    Ok(Search::new(Runner::new(model, analysis, &open, None, options)).run()?.results)
}

/// [`solve_stages`], with the errors of every stage estimated as [`estimate`] does: by runs of all of them on half as many cells with
/// larger steps, so that the error with which a stage begins is part of that of its results.
pub fn estimate_stages(stages: &[Stage], options: Options<'_>) -> StagesRun {
    let mut starts = Starts::new(options.start.cloned());
    solve_stages_by(stages, options, &mut |index, model, analysis, mut options| {
        let open = Open::none(model);
        let mut runner = Runner::new(model, analysis, &open, None, options.again());
        runner.starts = Some(&mut starts);
        let results = Search::new(runner).run()?.results;
        starts.go_on(&stages[index]);
        Ok(results)
    })
}
