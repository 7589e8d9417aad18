//! A round of a search: the same problem on meshes and with steps of two or three finenesses.

mod unseen;

use super::difference::{self, Difference, Layer, StrainJump, stations};
use super::judgement::{excess, scaled};
use super::mesh::Mesh;
use super::runner::{Fineness, Purpose, Runner};
use super::setting::Setting;
use crate::model::{Analysis, Place};
use crate::results::{Energy, Errors, Results};
use crate::run::RunError;

/// Why a run that goes on from a file has no estimate.
const SAVED_MESH: &str = "the saved state with which it begins has this mesh and no coarser one to compare with; as a `[[stage]]` of one file \
    with the analysis that has made the state, both have errors";
/// Two motions of which the finer one takes less than so many times the steps of the coarse one
/// tell nothing of the errors of their steps.
const MORE_STEPS: f64 = 1.2;

/// A finer run is not worth its price where its errors would be so many times those that are wanted, even if they fell as
/// fast as they may …
const HOPELESS: f64 = 1.5;
/// … and of a motion, of which loose tolerances tell less.
const HOPELESS_MOTION: f64 = 10.0;

/// Positions of two equilibria, in beam lengths, beyond which they do not show the same shape.
const APART: f64 = 0.1;
/// Most Newton iterations of an equilibrium on a mesh that only tells errors.
const MOST_OF_COARSE: usize = 50_000;

/// What became of a round.
pub(super) enum Outcome {
    /// A coarse run and a finer one.
    Compared(Box<Round>),
    /// Two coarse runs that differ so much that the finer one was not worth its price.
    TooCoarse(Difference),
}

/// What a round found.
pub(super) struct Round {
    /// Where its runs are compared: per beam, arc lengths \[m\].
    pub stations: Vec<Vec<f64>>,
    /// Of the finer run, stations included, as of the coarse one.
    pub results: Results,
    pub coarse: Option<Results>,
    pub setting: Setting,
    /// Number of the finer run among all.
    pub run: usize,
    pub difference: Result<Difference, String>,
    /// What coarser meshes do not tell of the errors of the finer run.
    pub unseen: Option<Difference>,
    /// Where in open beams the strain jumps, with the part of it that shorter cells there would make smaller.
    pub jumps: Vec<StrainJump>,
    /// Layers at ends of beams that cells do not show.
    pub layers: Vec<Layer>,
    /// Where forces pass corners of laws, in all states that rest.
    pub corners: Vec<Place>,
    /// By which factor the difference has fallen, where there was a third run.
    pub fall: Option<f64>,
    /// Cells of the open beams.
    pub cells: usize,
    /// Whether steps err, too.
    pub steps_matter: bool,
}

impl Round {
    /// Whether the finer run takes more steps than the coarse one, where steps matter.
    pub fn tells_of_steps(&self) -> bool {
        let steps = |results: &Results| {
            let counts = results.run().statistics;
            (counts.steps + counts.load_steps + counts.rejected_steps) as f64
        };
        !self.steps_matter
            || self.coarse.as_ref().is_none_or(|coarse| steps(&self.results) >= MORE_STEPS * steps(coarse))
    }
}

impl Runner<'_, '_> {
    /// A coarse run and a finer one; `alone`, where no round before tells how errors fall, one that is still
    /// coarser, too. Each finds its own way from the start: one that began where another ended would follow it
    /// to a wrong branch. With `hopeful` such a round goes on to the finer run even if it cannot be enough.
    pub fn round(&mut self, alone: bool, hopeful: bool) -> Result<Outcome, RunError> {
        let stations = stations(&self.meshes);
        // On the same meshes a coarser run tells nothing of how their errors fall.
        let beams = |mesh: Fineness| self.setting(mesh, mesh).beams;
        let tells = alone && beams(Fineness::Coarsest) != beams(Fineness::Coarse);
        // A coarse mesh may creep to an equilibrium that finer ones find at once, and is not waited for. A path has as many points as it has.
        let creeps = matches!(self.analysis, Analysis::Static(_)) && !difference::is_path(self.analysis);
        let most = if creeps { MOST_OF_COARSE } else { usize::MAX };
        let mut pair = |fineness, purpose| {
            self.solve_within(most, &stations, &self.setting(fineness, fineness), purpose)
        };
        let coarsest = if tells { pair(Fineness::Coarsest, Purpose::Positions).ok() } else { None };
        let coarse = pair(Fineness::Coarse, Purpose::Shapes);
        let before = coarsest.as_ref().zip(coarse.as_ref().ok());
        let before = before.and_then(|(a, b)| {
            let complete = a.run().complete && b.run().complete;
            complete.then(|| self.difference(a, b).ok()).flatten()
        });
        let before = match before {
            Some(before) if !hopeful && self.is_too_coarse(&before) => return Ok(Outcome::TooCoarse(before)),
            before => before,
        };
        let setting = self.setting(Fineness::Fine, Fineness::Fine);
        let mut results = self.solve(&stations, &setting, Purpose::Results)?;
        let run = self.runs.len() - 1;
        let corners = self.corners(&setting, &results);
        if !self.options.states {
            results.states_mut().states = None;
        }
        let mut difference = match &coarse {
            Ok(coarse) if coarse.run().complete => self.difference(coarse, &results),
            Ok(_) => Err("the run on fewer cells was stopped".to_owned()),
            Err(RunError::Restart(_)) => Err(SAVED_MESH.to_owned()),
            Err(error) => Err(format!("on half as many cells there is no result: {error}")),
        };
        let seen = difference.as_ref().ok();
        let beside = match self.beside_finer(&stations, &setting, &results, &corners, seen) {
            Ok(beside) => beside,
            Err(why) => {
                difference = Err(why);
                None
            }
        };
        let mut jumps = self.stiffness_jumps(beside.as_ref());
        let mut layers = Vec::new();
        let round_off = difference::round_off(&results);
        let both = |a: Option<Difference>, b: Option<Difference>| match (a, b) {
            (Some(a), Some(b)) => a.plus(&b),
            (a, b) => a.or(b),
        };
        let mut unseen = both(beside, round_off);
        let difference = difference.and_then(|difference| {
            let steps = self.beside_chosen_steps(&stations, &setting, &results, &difference)?;
            unseen = both(unseen.take(), steps);
            unseen =
                both(unseen.take(), self.changes_beside_jumps(&stations, &setting, &results, &difference));
            Ok(difference)
        });
        if let (Ok(difference), Results::Trajectory(run)) = (&difference, &results) {
            let nodes = self.named.iter().zip(&self.meshes).map(|(named, mesh)| match named {
                Some(named) => named.nodes.clone(),
                None => mesh.halved().nodes,
            });
            let nodes: Vec<Vec<f64>> = nodes.collect();
            if let Some((errors, places)) = difference::strain_jumps(self.model, &nodes, run, difference) {
                unseen = both(unseen, Some(errors));
                jumps.extend(places.into_iter().filter(|jump| self.is_open(jump.beam)));
            }
            if let Some((errors, found)) = difference::layers(self.model, &nodes, run, difference) {
                unseen = both(unseen, Some(errors));
                layers = found;
            }
        }
        if let (Ok(difference), Results::Trajectory(run)) = (&difference, &results) {
            // The scene may leave it open that a beam is meshfree.
            let (chosen, _) = setting.apply(self.model, self.analysis);
            unseen = both(unseen, difference::laid_out(&chosen, difference));
            unseen = both(unseen, difference::bent(&chosen, run, difference));
        }
        let fall = before
            .zip(difference.as_ref().ok())
            .map(|(before, now)| before.errors.result / now.errors.result);
        let of_open = |(index, mesh): (usize, &Mesh)| if self.is_open(index) { mesh.cells() } else { 0 };
        let cells = self.meshes.iter().enumerate().map(of_open).sum();
        let coarse = coarse.ok();
        // Of what rests no step errs.
        let moves = !matches!(self.analysis, Analysis::Dynamic(_))
            || Energy::kinetic_of(&results.states().energy).is_some();
        let steps_matter = self.has_steps() && moves;
        let round = Round {
            stations,
            results,
            coarse,
            setting,
            run,
            difference,
            unseen,
            jumps,
            layers,
            corners,
            fall,
            cells,
            steps_matter,
        };
        Ok(Outcome::Compared(Box::new(round)))
    }

    /// The errors of a finer run that has not been made yet, from the difference of two runs that are
    /// two and four times as coarse, if errors fall as fast as the methods promise.
    pub fn foreseen(&self, before: &Difference) -> Errors {
        scaled(before.errors, self.contractions(f64::INFINITY).map(|k| k * (k - 1.0)))
    }

    /// Whether neither of two runs knows an equilibrium, so that what they differ by foretells nothing.
    pub fn is_apart(&self, before: &Difference) -> bool {
        matches!(self.analysis, Analysis::Static(_)) && before.errors.result > APART
    }

    /// Whether a finer run would not be good enough even so, and better meshes can be had.
    fn is_too_coarse(&self, before: &Difference) -> bool {
        let moves = matches!(self.analysis, Analysis::Dynamic(_));
        let open = self.open.beams.iter().all(|open| *open) && (self.steps_are_open() || !self.has_steps());
        let Some(wanted) = self.wanted.filter(|_| open) else { return false };
        let most = if moves { HOPELESS_MOTION } else { HOPELESS };
        excess(self.foreseen(before), wanted) > most || self.is_apart(before)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::Scene;
    use crate::accuracy::runner::tests::{runner, scene};
    use crate::model::Accuracy;
    use crate::results::{AnalysisKind, Trajectory};

    /// A round of which no more is told than the statistics of its runs.
    pub fn round(runner: &Runner<'_, '_>, results: Results, coarse: Option<Results>) -> Round {
        let stations = stations(&runner.meshes);
        let setting = runner.setting(Fineness::Fine, Fineness::Fine);
        let cells = runner.meshes.iter().map(Mesh::cells).sum();
        let difference = Err(String::new());
        let steps_matter = runner.has_steps();
        Round {
            stations,
            results,
            coarse,
            setting,
            run: 0,
            difference,
            unseen: None,
            jumps: Vec::new(),
            layers: Vec::new(),
            corners: Vec::new(),
            fall: None,
            cells,
            steps_matter,
        }
    }

    const MOTION: &str = "analysis.dynamic = { duration = 1 }";

    /// Of the difference of the coarsest two runs a 15·14th is the error of the finer one, of motions a 10·9th,
    /// of curvatures a half; one and a half times what is wanted is too much, of motions ten times.
    #[test]
    fn meshes_are_too_coarse_if_even_the_promised_fall_is_not_enough() {
        let (still, motion) = (scene("analysis.static = {}"), scene(MOTION));
        let too_coarse_for = |scene: &Scene, wanted: f64, result: f64, curvature: f64| {
            let errors = Errors { result, curvature: Some(curvature), section_force: None };
            let mut runner = runner(scene, wanted);
            runner.wanted = Some(Accuracy { curvature: Some(1e-2), ..Accuracy::new(wanted) });
            runner.is_too_coarse(&Difference { errors, ..Difference::default() })
        };
        let too_coarse = |scene: &Scene, result, curvature| too_coarse_for(scene, 1e-4, result, curvature);
        assert_eq!([0.031, 0.032].map(|result| too_coarse(&still, result, 0.0)), [false, true]);
        assert_eq!([0.029, 0.031].map(|curvature| too_coarse(&still, 0.0, curvature)), [false, true]);
        assert_eq!([0.089, 0.091].map(|result| too_coarse(&motion, result, 0.0)), [false, true]);
        // Equilibria a tenth of the length apart are of different shapes, whatever is wanted; motions may be.
        assert_eq!([0.099, 0.101].map(|result| too_coarse_for(&still, 1e-2, result, 0.0)), [false, true]);
        assert!(!too_coarse_for(&motion, 1e-2, 0.101, 0.0));
        // What the scene names cannot be made finer.
        assert!(!too_coarse(&scene("beam.arm.basis.ancf.elements = 7\nanalysis.static = {}"), 1.0, 0.0));
        let named = "analysis.dynamic = { duration = 1, gauss = { stages = 2, tolerance = 1e-4 } }";
        assert!(!too_coarse(&scene(named), 1.0, 0.0));
        let mut estimate = runner(&still, 1e-4);
        estimate.wanted = None;
        let large = Errors { result: 1.0, ..Errors::default() };
        assert!(!estimate.is_too_coarse(&Difference { errors: large, ..Difference::default() }));
    }

    /// A run of so many steps, of which some were rejected.
    pub fn run(analysis: AnalysisKind, steps: usize, rejected_steps: usize) -> Results {
        let mut results = Results::from(Trajectory::default());
        results.run_mut().analysis = analysis;
        results.run_mut().statistics.steps = steps;
        results.run_mut().statistics.rejected_steps = rejected_steps;
        results
    }

    #[test]
    fn a_fifth_more_steps_tell_of_their_errors() {
        let ground = |friction: &str| {
            format!(
                "effect.contact = [{{ beam = 'arm', stiffness = 1e4, half_plane = {{ point = [0, -1], normal = [0, 1] }}{friction} }}]"
            )
        };
        let (still, motion) = (AnalysisKind::Static, AnalysisKind::Dynamic);
        let rough = ground(", friction = { coefficient = 0.3 }") + "\nanalysis.static = {}";
        let smooth = ground("") + "\nanalysis.static = {}";
        for (more, analysis, matter) in
            [(MOTION, motion, true), (rough.as_str(), still, true), (smooth.as_str(), still, false)]
        {
            let scene = scene(more);
            let runner = runner(&scene, 1e-4);
            let tells = |[steps, rejected]: [usize; 2], coarse: bool| {
                let coarse = coarse.then(|| run(analysis, 80, 20));
                round(&runner, run(analysis, steps, rejected), coarse).tells_of_steps()
            };
            assert!(tells([100, 21], true) && tells([1, 0], false), "{more}");
            assert_eq!(tells([119, 0], true), !matter, "{more}");
        }
    }
}
