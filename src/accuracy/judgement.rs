//! What a round tells of the errors of its finer run.

use super::difference::Difference;
use super::mesh::{self, CellErrors, Mesh};
use super::missing::Missing;
use super::round::Round;
use super::runner::{LOOSER, Runner};
use crate::model::{Accuracy, Analysis, Integrator, StepControl};
use crate::results::Errors;

/// By how much the error falls from the coarse run to the finer one at most: of equilibria and
/// modes …
const CONTRACTION: f64 = 15.0;
/// … of critical loads, of which cells under tension and under compression err by opposite signs …
const CONTRACTION_OF_BUCKLING: f64 = 8.0;
/// … of motions …
const CONTRACTION_OF_MOTION: f64 = 10.0;
/// … of beams with contacts, which begin and end within cells …
const CONTRACTION_OF_CONTACT: f64 = 6.0;
/// … of strings with a kink within them, which continuous tangents round off, and with friction, which sticks in a part of a cell or
/// not …
const CONTRACTION_OF_FIRST_ORDER: f64 = 2.0;
/// … of all results of a method of second order …
const CONTRACTION_OF_SECOND_ORDER: f64 = 4.0;
/// … of curvatures and section forces, of which the largest error on a beam counts: at loads and
/// obstacles within cells it falls with the first order …
const CONTRACTION_OF_CURVATURE: f64 = 2.0;
/// … of equilibria with friction, by four times as many load steps, or by twice as many of those of a scene …
const CONTRACTION_OF_LOAD_STEPS: f64 = 4.0;
const CONTRACTION_OF_NAMED_STEPS: f64 = 2.0;
/// … of steps, of which nothing is known yet but that large ones err less regularly …
const FALL_OF_STEPS: f64 = 6.0;
/// … and at least, however slowly it was seen to fall.
pub(super) const LEAST_CONTRACTION: f64 = 1.5;
/// Errors are larger by this than three coarse meshes alone tell.
const FIRST: f64 = 1.5;
/// Errors that fall by more than so many times the promised factor begin beyond all use.
const TOO_FAST: f64 = 2.5;
/// The factor that is taken, in the factor that was seen.
pub(super) const CAUTION: f64 = 0.75;
/// Cells must be so many times finer than those of the round before to tell how errors fall …
const FINER: f64 = 1.5;
/// … and where errors were by the same factor as everywhere, but for this one.
const ALIKE: f64 = 1.3;

/// A round with what is known of its errors.
pub(super) struct Judged {
    pub round: Round,
    /// Of the finer run; `None` where nothing is known.
    pub estimate: Option<Estimate>,
    /// By how much errors are taken to be larger.
    pub caution: f64,
    /// The part of the largest errors of results that was seen which they most likely are.
    pub likely: f64,
    /// The largest error in units of what was wanted.
    pub excess: f64,
}

/// The errors of a finer run, told from differences.
pub(super) struct Estimate {
    /// All of them, as large as they may be.
    pub whole: Difference,
    /// Those that the difference of two runs shows.
    pub seen: Difference,
    /// Those of the mesh; all of them where those of the steps are not known apart from them.
    pub mesh: Difference,
    /// By which factor these fall with halved cells.
    pub contraction: f64,
    /// The largest of positions that the steps make, where they are known apart.
    pub steps: Option<f64>,
    /// Vibrations that are too fast for the steps.
    pub missing: Option<Missing>,
}

impl Estimate {
    /// With the errors that missing vibrations make, and those of the finer run that coarser meshes do not tell.
    #[must_use]
    pub fn with(mut self, missing: Option<Missing>, unseen: Option<&Difference>) -> Self {
        let of_missing = missing.as_ref().map(|missing| missing.errors(&self.seen));
        for part in of_missing.iter().chain(unseen) {
            self.whole = self.whole.plus(part).unwrap_or(self.whole);
        }
        Self { missing, ..self }
    }
}

impl Judged {
    /// Nothing is known.
    pub fn unknown(round: Round) -> Self {
        Self { round, estimate: None, caution: 1.0, likely: 1.0, excess: f64::INFINITY }
    }

    /// The largest errors that the finer run may have; infinite where nothing is known.
    pub fn errors(&self) -> Errors {
        let unknown = Errors { result: f64::INFINITY, ..Errors::default() };
        self.estimate.as_ref().map_or(unknown, |estimate| self.with_caution(estimate.whole.errors))
    }

    /// The errors that are stated: the most likely ones of a result that is good enough, else the largest.
    pub fn stated(&self) -> Option<Difference> {
        let estimate = self.estimate.as_ref()?;
        if self.excess > 1.0 {
            return Some(estimate.whole.clone().divided([self.caution.recip(); 2]));
        }
        let seen = estimate.seen.clone().divided([self.likely * self.caution, self.caution].map(f64::recip));
        let missing = estimate.missing.as_ref().map(|missing| missing.likely_errors(&estimate.seen));
        let parts = missing.iter().chain(&self.round.unseen);
        Some(parts.fold(seen, |sum, part| sum.plus(part).unwrap_or(sum)))
    }

    /// Errors as they are taken to be.
    pub fn with_caution(&self, errors: Errors) -> Errors {
        scaled(errors, [self.caution.recip(); 2])
    }
}

/// By which factor a difference is believed to fall from one pair of runs to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall {
    /// The difference of positions or values.
    pub difference: f64,
    pub factor: f64,
}

impl Fall {
    /// Before anything is known of it.
    pub fn unknown(difference: f64) -> Self {
        Self { difference, factor: CONTRACTION_OF_SECOND_ORDER / CAUTION }
    }

    /// That of the steps of motions before anything is known of it.
    pub fn of_steps(difference: f64) -> Self {
        Self { difference, factor: FALL_OF_STEPS / CAUTION }
    }

    /// That to a `difference` of runs in which all is so many times finer; as before where that is
    /// hardly finer.
    pub fn to(self, finer: f64, difference: f64) -> Self {
        let fallen = || (self.difference / difference).powf(finer.log2().recip());
        Self { difference, factor: if finer < FINER { self.factor } else { fallen() } }
    }
}

/// What a round has seen.
pub(super) struct Seen {
    /// The coarser meshes of the two that were compared, and where they err.
    pub meshes: Vec<Mesh>,
    pub cells: Vec<CellErrors>,
    /// Of the finer run.
    pub tolerance: f64,
    /// The largest difference in units of what is wanted of it.
    pub excess: f64,
    /// Of both together.
    pub whole: Fall,
    /// Of the mesh and of the steps, where they were told apart.
    pub apart: Option<[Fall; 2]>,
}

impl Seen {
    /// Whether such meshes are finer by as much everywhere as where errors were. Only then the differences of both rounds
    /// tell how errors fall: those of positions need not come from where curvatures err.
    pub fn is_like(&self, meshes: &[Mesh]) -> bool {
        let cells = |meshes: &[Mesh]| meshes.iter().map(Mesh::cells).sum::<usize>() as f64;
        let everywhere = cells(meshes) / cells(&self.meshes);
        let there = mesh::refinement(&self.meshes, &self.cells, meshes);
        (there / everywhere).max(everywhere / there) <= ALIKE
    }

    /// How many times finer such meshes and such a tolerance are, in halvings of cells: a 16th of the
    /// tolerance goes with one.
    pub fn finer(&self, meshes: &[Mesh], tolerance: f64) -> [f64; 2] {
        let cells = mesh::refinement(&self.meshes, &self.cells, meshes);
        [cells, (self.tolerance / tolerance).powf(LOOSER.log2().recip())]
    }
}

impl Runner<'_, '_> {
    /// The fall of errors that is believed of three runs, and the caution with which: where the coarsest
    /// was of no use at all, its difference tells nothing, and little is taken.
    pub fn fall_alone(&self, seen: Option<f64>, difference: f64) -> (Fall, f64) {
        let [promised, _] = self.contractions_with_steps(f64::INFINITY);
        match seen.filter(|factor| *factor <= TOO_FAST * promised) {
            None => (Fall::unknown(difference), 1.0),
            Some(factor) => (Fall { difference, factor }, FIRST),
        }
    }

    /// The part of the `largest` error that the error of a finer run most likely is: the geometric mean of this one and
    /// of the smallest, which falls as fast as was `seen`, within [`TOO_FAST`] of what the methods promise, to the
    /// `difference`.
    pub fn likely(&self, difference: f64, seen: f64, largest: f64) -> f64 {
        let [promised, _] = self.contractions_with_steps(f64::INFINITY);
        let fastest = if seen.is_nan() { promised } else { seen.clamp(promised, TOO_FAST * promised) };
        let part = (difference / (fastest - 1.0) / largest).sqrt();
        if part < 1.0 { part } else { 1.0 }
    }

    /// Factors by which errors fall from a coarse run to a finer one: as the methods promise, and
    /// of the result no more than was seen.
    pub fn contractions(&self, seen: f64) -> [f64; 2] {
        let [result, curvature] = self.contractions_of_smooth(seen);
        let first_order = self.kink.is_some() || self.model.has_friction();
        [if first_order { result.min(CONTRACTION_OF_FIRST_ORDER) } else { result }, curvature]
    }

    /// The same where no string has a kink and nothing sticks.
    fn contractions_of_smooth(&self, seen: f64) -> [f64; 2] {
        let second = match self.analysis {
            Analysis::Dynamic(settings) if !self.open.integrator => matches!(
                settings.integrator,
                Integrator::GeneralizedAlpha { step: StepControl::Fixed(_), .. }
                    | Integrator::Gauss { stages: 1, step: StepControl::Fixed(_) }
            ),
            _ => false,
        };
        let result = match self.analysis {
            _ if second => CONTRACTION_OF_SECOND_ORDER,
            Analysis::Dynamic(_) => CONTRACTION_OF_MOTION,
            Analysis::Buckling(_) => CONTRACTION_OF_BUCKLING,
            _ => CONTRACTION,
        };
        let result = if self.model.has_contact() { result.min(CONTRACTION_OF_CONTACT) } else { result };
        // Steps differ by one halving, whatever meshes do.
        let result = if self.has_steps() { result } else { result.powf(self.halvings) };
        let seen = if seen.is_nan() { result } else { CAUTION * seen };
        [result.min(seen).max(LEAST_CONTRACTION), CONTRACTION_OF_CURVATURE]
    }

    /// The same where the steps of both runs differ, too.
    pub fn contractions_with_steps(&self, seen: f64) -> [f64; 2] {
        let [result, curvature] = self.contractions(seen);
        [result.min(self.contractions_of_steps(seen)[0]), curvature]
    }

    /// The same of the errors of steps alone.
    pub fn contractions_of_steps(&self, seen: f64) -> [f64; 2] {
        let [result, curvature] = self.contractions_of_smooth(seen);
        let of_steps = match self.analysis {
            Analysis::Static(_) if self.has_steps() => match self.steps_are_open() {
                true => CONTRACTION_OF_LOAD_STEPS,
                false => CONTRACTION_OF_NAMED_STEPS,
            },
            _ => result,
        };
        [result.min(of_steps), curvature]
    }
}

/// Errors from differences.
pub(super) fn scaled(errors: Errors, [result, curvature]: [f64; 2]) -> Errors {
    Errors {
        result: errors.result / result,
        curvature: errors.curvature.map(|error| error / curvature),
        section_force: errors.section_force.map(|error| error / curvature),
    }
}

/// The largest error in units of what was wanted.
pub(super) fn excess(errors: Errors, wanted: Accuracy) -> f64 {
    let of = |error: Option<f64>, wanted: Option<f64>| {
        error.zip(wanted).map_or(0.0, |(error, wanted)| error / wanted)
    };
    (errors.result / wanted.result)
        .max(of(errors.curvature, wanted.curvature))
        .max(of(errors.section_force, wanted.section_force))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::round::tests::{round, run};
    use crate::accuracy::runner::tests::{runner, scene};
    use crate::results::AnalysisKind;

    #[test]
    fn errors_are_differences_by_how_much_they_fall() {
        let differences = Errors { result: 3.0, curvature: Some(6.0), section_force: Some(9.0) };
        let errors = scaled(differences, [6.0, 3.0]);
        assert_eq!(errors, Errors { result: 0.5, curvature: Some(2.0), section_force: Some(3.0) });
    }

    #[test]
    fn the_largest_error_counts_of_those_that_were_asked_for() {
        let errors = Errors { result: 1e-4, curvature: Some(0.5), section_force: Some(0.25) };
        let wanted = |curvature, section_force| Accuracy { result: 1e-3, curvature, section_force };
        assert_eq!(excess(errors, wanted(None, None)), 0.1);
        assert_eq!(excess(errors, wanted(Some(0.25), Some(0.125))), 2.0);
        assert_eq!(excess(errors, wanted(Some(0.25), Some(0.0625))), 4.0);
    }

    #[test]
    fn errors_fall_no_faster_than_the_methods_promise_and_than_was_seen() {
        let of = |more: &str, seen: f64| {
            let scene = scene(more);
            runner(&scene, 1e-4).contractions(seen)
        };
        let still = "analysis.static = {}";
        assert_eq!(of(still, f64::INFINITY), [15.0, 2.0]);
        assert_eq!(of(still, f64::NAN), [15.0, 2.0]);
        assert_eq!([8.0, 1.0].map(|seen| of(still, seen)[0]), [6.0, 1.5]);
        let pressed =
            "effect.force = [{ beam = 'arm', at = 'end', value = [-1, 0] }]\nanalysis.buckling.count = 2";
        assert_eq!([pressed, "analysis.modal.count = 2"].map(|more| of(more, f64::INFINITY)[0]), [8.0, 15.0]);
        let motion = |integrator: &str| {
            of(&format!("analysis.dynamic = {{ duration = 1{integrator} }}"), f64::INFINITY)[0]
        };
        assert_eq!(motion(""), 10.0);
        assert_eq!(motion(", radau = { stages = 3, step = 0.1 }"), 10.0);
        assert_eq!(motion(", gauss = { stages = 2, step = 0.1 }"), 10.0);
        assert_eq!(motion(", gauss = { stages = 1, step = 0.1 }"), 4.0);
        assert_eq!(motion(", generalized_alpha.step = 0.1"), 4.0);
        assert_eq!(motion(", generalized_alpha.tolerance = 1e-4"), 10.0);
        let ground = "effect.contact = [{ beam = 'arm', stiffness = 1e4, half_plane = { point = [0, -1], normal = [0, 1] } }]";
        assert_eq!(of(&format!("{ground}\n{still}"), f64::INFINITY), [6.0, 2.0]);
        // Something acts within a string: what its mesh errs by falls with the first order, and what steps do as ever.
        let string = |more: &str| {
            let text = format!(
                "beam.rope = {{ start = [0, 0], end = [4, 0], axial_stiffness = 1, mass_per_length = 1 }}\n\
                 support = [{{ beam = 'rope', at = 'start', fix = ['x', 'y'] }}]\n\
                 effect.point_mass = [{{ beam = 'rope', at = 1, mass = 2 }}]\n{more}\n"
            );
            let scene = crate::scene::parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
            let runner = runner(&scene, 1e-4);
            [runner.contractions(f64::INFINITY)[0], runner.contractions_with_steps(f64::INFINITY)[0]]
        };
        assert_eq!(string(still), [2.0; 2]);
        assert_eq!(string("analysis.dynamic = { duration = 1 }"), [2.0; 2]);
        // So do what meshes err by with friction, and its steps, by four times as many that are chosen, or twice as many of those
        // of a scene.
        let rough = ground.replace("stiffness = 1e4", "stiffness = 1e4, friction = { coefficient = 0.1 }");
        let with_steps = |more: &str, seen: f64| {
            let scene = scene(more);
            let runner = runner(&scene, 1e-4);
            [runner.contractions_with_steps(seen)[0], runner.contractions_of_steps(seen)[0]]
        };
        let named = "analysis.static.max_step = 0.01";
        assert_eq!(with_steps(&format!("{rough}\n{still}"), f64::INFINITY), [2.0, 4.0]);
        assert_eq!(with_steps(&format!("{rough}\n{still}"), 4.0), [2.0, 3.0]);
        assert_eq!(with_steps(&format!("{rough}\n{named}"), f64::INFINITY), [2.0, 2.0]);
        assert_eq!(with_steps(&format!("{ground}\n{still}"), f64::INFINITY), [6.0; 2]);
    }

    /// What falls 37.5 times where 15 are promised has begun beyond all use.
    #[test]
    fn three_runs_are_believed_with_caution_or_not_at_all() {
        let scene = scene("analysis.static = {}");
        let runner = runner(&scene, 1e-4);
        let of = |seen: Option<f64>| {
            let (fall, caution) = runner.fall_alone(seen, 2e-3);
            assert_eq!(fall.difference, 2e-3);
            (fall.factor, caution)
        };
        assert_eq!(of(Some(37.5)), (37.5, 1.5));
        let unknown = (4.0 / 0.75, 1.0);
        assert_eq!([Some(37.6), None].map(of), [unknown; 2]);
    }

    /// Differences of 14 and 29 are errors of 1 where they fall by 15 and 30, so that 4 is twice the geometric mean.
    #[test]
    fn errors_are_most_likely_between_the_largest_and_the_smallest() {
        let scene = scene("analysis.static = {}");
        let likely =
            |difference: f64, seen: f64, largest: f64| runner(&scene, 1e-4).likely(difference, seen, largest);
        assert_eq!([3.0, f64::NAN].map(|seen| likely(14.0, seen, 4.0)), [0.5; 2]);
        assert_eq!((likely(29.0, 30.0, 4.0), likely(36.5, 1e3, 16.0)), (0.5, 0.25));
        assert_eq!((likely(14.0, 15.0, 0.5), likely(0.0, 15.0, 0.0)), (1.0, 1.0));
    }

    #[test]
    fn caution_makes_errors_larger() {
        let scene = scene("analysis.static = {}");
        let runner = runner(&scene, 1e-4);
        let round = || round(&runner, run(AnalysisKind::Static, 1, 0), None);
        let errors = Errors { result: 8.0, curvature: Some(6.0), section_force: None };
        let whole = Difference { errors, ..Difference::default() }.divided([6.0, 3.0]);
        let estimate = Estimate {
            seen: whole.clone(),
            mesh: whole.clone(),
            whole,
            contraction: 7.0,
            steps: None,
            missing: None,
        };
        let mut judged =
            Judged { round: round(), estimate: Some(estimate), caution: 1.5, likely: 0.5, excess: 0.0 };
        assert_eq!(judged.errors(), Errors { result: 2.0, curvature: Some(3.0), section_force: None });
        // What is good enough is half as wrong, and what coarser meshes do not tell comes to that.
        let stated = |judged: &Judged| judged.stated().expect("an estimate").errors;
        assert_eq!(stated(&judged), Errors { result: 1.0, curvature: Some(3.0), section_force: None });
        let errors = Errors { result: 0.25, curvature: Some(0.5), section_force: None };
        judged.round.unseen = Some(Difference { errors, ..Difference::default() });
        assert_eq!(stated(&judged), Errors { result: 1.25, curvature: Some(3.5), section_force: None });
        judged.excess = 1.5;
        assert_eq!(stated(&judged), judged.errors());
        let unknown = Judged::unknown(round());
        assert!(unknown.stated().is_none());
        assert_eq!((unknown.errors().result, unknown.excess), (f64::INFINITY, f64::INFINITY));
    }

    /// Four times the cells, and a 256th of the tolerance, are two halvings.
    #[test]
    fn a_fall_is_that_of_one_halving() {
        let even = |cells: usize| Mesh::of(&(0..=cells).map(|i| i as f64 / cells as f64).collect::<Vec<_>>());
        let seen = Seen {
            meshes: vec![even(8)],
            cells: vec![CellErrors { squares: vec![1.0; 8], order: 2.0 }],
            tolerance: 256e-6,
            excess: 1.0,
            whole: Fall { difference: 1.0, factor: 7.0 },
            apart: None,
        };
        assert_eq!(seen.finer(&[even(32)], 256e-6), [4.0, 1.0]);
        assert_eq!(seen.finer(&[even(16)], 1e-6), [2.0, 4.0]);
        let fall = |finer: f64, difference: f64| seen.whole.to(finer, difference);
        let found = fall(4.0, 1.0 / 64.0);
        assert_eq!((found.difference, found.factor), (1.0 / 64.0, 8.0));
        assert_eq!(fall(2.0, 0.25).factor, 4.0);
        assert_eq!(fall(1.4, 0.1).factor, 7.0, "hardly finer");
    }

    /// The first of two cells errs. It is cut into six and the other one into two, or both into three or four.
    #[test]
    fn meshes_are_alike_where_cells_are_finer_by_as_much_everywhere() {
        let seen = Seen {
            meshes: vec![Mesh::of(&[0.0, 1.0, 2.0])],
            cells: vec![CellErrors { squares: vec![1.0, 0.0], order: 2.0 }],
            tolerance: 1e-3,
            excess: 1.0,
            whole: Fall { difference: 1.0, factor: 7.0 },
            apart: None,
        };
        let is_like = |cells: [usize; 2]| {
            let part = |(start, cells): (usize, usize)| {
                (0..cells).map(move |i| start as f64 + i as f64 / cells as f64)
            };
            let nodes = cells.into_iter().enumerate().flat_map(part).chain([2.0]).collect::<Vec<_>>();
            seen.is_like(&[Mesh::of(&nodes)])
        };
        assert!(is_like([4, 4]) && is_like([4, 3]) && is_like([3, 4]));
        assert!(!is_like([6, 2]) && !is_like([2, 6]) && !is_like([2, 4]));
    }
}
