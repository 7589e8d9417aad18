//! Runs of a problem, on meshes and with steps of three finenesses.

use super::difference::{self, Difference, jumps_of_modes, stiffness_jumps};
use super::mesh::Mesh;
use super::saturation::{ends_prevail, has_uneven_cells, saturates};
use super::setting::{Family, Setting, Solver};
use super::stages::Starts;
use crate::basis::Basis;
use crate::centreline::Curve;
use crate::model::{
    Accuracy, Analysis, Beam, Discretization, Dynamic, Integrator, Model, Nodes, Open, Place,
    RPIM_GAUSS_POINTS, Static, StepControl,
};
use crate::results::{Results, RunForError};
use crate::run::{Control, Options, Progress, RunError};

/// Smallest tolerance of any run.
pub(super) const FINEST: f64 = 1e-13;
/// Tolerance of the first finer run, in the wanted error.
const TOLERANCE: f64 = 3.0;
/// Loosest tolerance of the first finer run: beyond, other things than the tolerance decide about
/// steps.
const FIRST_TOLERANCE: f64 = 1e-3;
/// Errors of motions that are wanted smaller than this need fewer nodes of a meshfree beam than
/// cable elements, by so much that each may cost more …
const MESHFREE: f64 = 3e-5;
/// … of this kind: of those that `ancf cost` tries the cheapest for a falling pendulum.
const MESHFREE_FAMILY: Family = Family::Rpim { neighbours: 1, shape: 6.0, points: RPIM_GAUSS_POINTS.bend };
/// The tolerance of the coarse run, in that of the finer one.
pub(super) const LOOSER: f64 = 16.0;
/// Wanted errors of equilibria for which the first cells of a search do; for smaller ones
/// it begins with as many more as errors of fourth order need.
const FIRST_CELLS_DO: f64 = 1e-3;
/// The same of modes …
const FIRST_CELLS_OF_MODES_DO: f64 = 2e-3;
/// … whose errors fall faster than the fourth power of cells that are not yet short against their waves.
const FIRST_CELLS_OF_MODES: f64 = 0.21;
/// So many times as many for a motion, of which fewer tell nothing.
const FIRST_CELLS_OF_MOTION: f64 = 2.0;
/// Most times as many for an equilibrium: where it is near the start, few cells do for small errors.
const MOST_FIRST_CELLS: f64 = 6.0;
/// Curvatures and section forces of the coarse run are compared at each so many-th place.
const COARSER: usize = 4;
/// Loosest tolerance of any run.
const LOOSEST: f64 = 0.1;
/// The largest load step with friction is this, times the root of the tolerance …
const LOAD_STEP: f64 = 0.6;
/// … so that with so many times as many steps the tolerance is as small as that of [`LOOSER`].
const LOAD_STEPS: f64 = 4.0;
/// The tolerance with 2,500 load steps.
const FINEST_OF_LOAD_STEPS: f64 = 4.5e-7;
/// Wanted errors down to which the usual tolerance of equilibria does …
const USUAL_IS_ENOUGH: f64 = 1e-8;
/// … and that of others, in the wanted error.
const EQUILIBRIUM: f64 = 1e-2;
/// What acts this near to a node, in cells, acts there: the error is the cube of it.
const AT_NODE: f64 = 0.02;

/// What is solved, on which meshes and with which steps.
pub(super) struct Runner<'a, 'o> {
    pub model: &'a Model,
    pub analysis: &'a Analysis,
    pub open: &'a Open,
    pub wanted: Option<Accuracy>,
    pub options: Options<'o>,
    /// Where other runs than those of the results begin, in a stage behind others.
    pub starts: Option<&'o mut Starts>,
    /// Of the coarse runs.
    pub meshes: Vec<Mesh>,
    /// What open beams are made of.
    pub families: Vec<Family>,
    /// Of the finer runs, nodes that must be included, of beams that the scene gives a basis.
    pub named: Vec<Option<Mesh>>,
    /// Those of them whose errors finer meshes do not remove.
    pub saturated: Vec<bool>,
    /// Those of them whose shape functions in the coarse runs are too different, or whose cells are too much alike. Not in motions, for
    /// which elements would take more time than the estimate may.
    pub dissimilar: Vec<bool>,
    /// Those of them within whose cells something acts in a point.
    pub pointed: Vec<bool>,
    /// A place within a string where something acts in a point.
    pub kink: Option<Place>,
    /// Where in each beam the stiffness against stretching jumps, or the strain of a mode may.
    pub softer: Vec<Vec<f64>>,
    /// Where in each open beam the strain jumps, and how long cells beside that may be in the coarse runs \[m\].
    pub short: Vec<Vec<[f64; 2]>>,
    /// The halvings between the meshes of two runs: more than one where the scene gives all beams an odd number of
    /// cells.
    pub halvings: f64,
    /// Of the finer runs of a motion whose integrator is open.
    pub tolerance: f64,
    pub runs: Vec<RunForError>,
}

/// Which of the runs of a round.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Fineness {
    Coarsest,
    Coarse,
    Fine,
}

/// What a run is made for: how much of it is sampled.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Purpose {
    /// Positions at the stations.
    Positions,
    /// Curvatures and section forces, too.
    Shapes,
    /// All that was asked for.
    Results,
}

impl<'a, 'o> Runner<'a, 'o> {
    /// With the meshes and the tolerance with which a search begins.
    pub fn new(
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
        let result = wanted.map_or(Accuracy::USUAL, |wanted| wanted.result);
        let times = match analysis {
            Analysis::Dynamic(_) => FIRST_CELLS_OF_MOTION,
            Analysis::Static(_) => (FIRST_CELLS_DO / result).powf(0.25).min(MOST_FIRST_CELLS),
            _ => (FIRST_CELLS_OF_MODES_DO / result).powf(FIRST_CELLS_OF_MODES),
        };
        let mut meshes = Mesh::first(model, waves, times);
        let named = |(index, mesh): (usize, &Mesh)| {
            let beam = &model.beams[index];
            let curve =
                Curve::new(&beam.centreline).ok().filter(|_| beam.discretization != Discretization::Open)?;
            // Nodes of elements move to where one must be. Meshfree ones do so, too, but coarser meshes of those are less even, and
            // tell less of their errors, than of even ones with more nodes.
            let elements = matches!(beam.discretization, Discretization::Ancf { .. });
            let breaks = if elements { model.breaks(index) } else { Vec::new() };
            let nodes = Discretization::Ancf { nodes: beam.discretization.nodes().clone() };
            Some(mesh.with(Basis::broken(&nodes, curve.length(), &breaks).ok()?.nodes()))
        };
        let named: Vec<Option<Mesh>> = meshes.iter().enumerate().map(named).collect();
        let pointed = |(index, named): (usize, &Option<Mesh>)| {
            named.as_ref().is_some_and(|named| has_points(model, index, named))
        };
        let pointed = named.iter().enumerate().map(pointed).collect();
        let kink = difference::kink(model, &meshes);
        let jumps = match analysis {
            Analysis::Modal(_) | Analysis::Buckling(_) => jumps_of_modes,
            _ => stiffness_jumps,
        };
        let softer = |(index, mesh): (usize, &Mesh)| jumps(model, index, mesh.length());
        let softer = meshes.iter().enumerate().map(softer).collect();
        let saturated = |(beam, mesh): (&Beam, &Mesh)| saturates(&beam.discretization, mesh.length());
        let saturated = model.beams.iter().zip(&meshes).map(saturated).collect();
        for (mesh, named) in meshes.iter_mut().zip(&named) {
            if let Some(named) = named {
                *mesh = named.coarser();
            }
        }
        let moves = matches!(analysis, Analysis::Dynamic(_));
        let dissimilar = |(index, coarse): (usize, &Mesh)| {
            let discretization = &model.beams[index].discretization;
            let uneven = || has_uneven_cells(discretization, coarse.length(), &model.breaks(index));
            let alike = || named[index].as_ref().is_some_and(|named| coarse.hardly_differs_from(named));
            !moves && (ends_prevail(discretization, coarse.cells()) || uneven() || alike())
        };
        let dissimilar = meshes.iter().enumerate().map(dissimilar).collect();
        let coarsening = |named: &Option<Mesh>| named.as_ref().map_or(Some(2.0), Mesh::coarsening);
        let times = named.iter().filter_map(coarsening).fold(f64::INFINITY, f64::min);
        let tolerance = short((TOLERANCE * result).min(FIRST_TOLERANCE));
        let accurate = wanted.is_some_and(|wanted| wanted.result <= MESHFREE);
        let family = |(beam, mesh): (&Beam, &Mesh)| {
            let stiff = beam.section.axial_stiffness.is_some() && beam.section.bending_stiffness.is_some();
            let meshfree =
                accurate && stiff && mesh.is_one_part() && matches!(analysis, Analysis::Dynamic(_));
            if meshfree { MESHFREE_FAMILY } else { Family::REDUCED }
        };
        let families = model.beams.iter().zip(&meshes).map(family).collect();
        Self {
            model,
            analysis,
            open,
            wanted,
            options,
            starts: None,
            meshes,
            families,
            named,
            saturated,
            dissimilar,
            pointed,
            kink,
            softer,
            short: vec![Vec::new(); model.beams.len()],
            halvings: if times.is_finite() { times.log2() } else { 1.0 },
            tolerance,
            runs: Vec::new(),
        }
    }

    pub fn is_open(&self, beam: usize) -> bool {
        self.open.beams.get(beam).copied().unwrap_or(false)
    }

    /// The setting of a run on meshes and with steps of such a fineness.
    pub fn setting(&self, mesh: Fineness, steps: Fineness) -> Setting {
        let beams = self.model.beams.iter().zip(&self.meshes).enumerate().map(|(index, (beam, coarse))| {
            let nodes = match mesh {
                Fineness::Coarsest => coarse.coarser().places(),
                Fineness::Coarse => coarse.places(),
                Fineness::Fine => coarse.halved().places(),
            };
            match (self.is_open(index), mesh) {
                (true, _) => self.families[index].of(beam, nodes),
                (false, Fineness::Fine) => (beam.discretization.clone(), beam.gauss_points),
                (false, _) => (coarser(&beam.discretization, nodes), beam.gauss_points),
            }
        });
        let solver = match self.analysis {
            Analysis::Dynamic(settings) => {
                let integrator = match self.open.integrator {
                    true => Integrator::usual(StepControl::Tolerance(self.tolerance)),
                    false => settings.integrator,
                };
                Solver::Integrator(match steps {
                    Fineness::Coarsest => {
                        integrator.with_step(looser(2, integrator.step_control(), settings))
                    }
                    Fineness::Coarse => integrator.with_step(looser(1, integrator.step_control(), settings)),
                    // As the scene names it, to the last digit.
                    Fineness::Fine => integrator,
                })
            }
            Analysis::Static(settings) => self.statics(settings, steps),
            _ => Solver::Scene,
        };
        Setting { beams: beams.collect(), solver }
    }

    /// How equilibria are found: with friction in load steps of such a fineness.
    fn statics(&self, settings: &Static, steps: Fineness) -> Solver {
        let tolerance = self.static_tolerance();
        let coarser = match steps {
            Fineness::Coarsest => 2,
            Fineness::Coarse => 1,
            Fineness::Fine => 0,
        };
        let largest = match self.model.has_friction() {
            false => None,
            true if self.open.load_steps => {
                // Every load factor of a coarser run is one of the finer one.
                let coarsest = (LOAD_STEP * self.tolerance.sqrt() * LOAD_STEPS.powi(2)).recip().ceil();
                Some((coarsest * LOAD_STEPS.powi(2 - coarser)).recip())
            }
            // As the scene has it, to the last digit.
            true if steps == Fineness::Fine => None,
            true => Some(2.0_f64.powi(coarser) * settings.largest_step(true)),
        };
        match (largest, tolerance) {
            (Some(largest), tolerance) => Solver::LoadSteps { largest, tolerance },
            (None, Some(tolerance)) => Solver::Tolerance(tolerance),
            (None, None) => Solver::Scene,
        }
    }

    /// Whether errors of steps are part of those of results: of motions, and of friction.
    pub fn has_steps(&self) -> bool {
        match self.analysis {
            Analysis::Dynamic(_) => true,
            Analysis::Static(_) => self.model.has_friction(),
            _ => false,
        }
    }

    /// Whether a tolerance decides about the steps, and is to be chosen.
    pub fn steps_are_open(&self) -> bool {
        self.open.integrator || self.open.load_steps
    }

    /// The smallest tolerance that is tried.
    pub fn finest(&self) -> f64 {
        if self.open.load_steps { FINEST_OF_LOAD_STEPS } else { FINEST }
    }

    /// The tolerance of equilibria where that of the solver may not do, and the scene names none.
    pub fn static_tolerance(&self) -> Option<f64> {
        let Analysis::Static(settings) = self.analysis else { return None };
        let wanted = self.wanted.filter(|wanted| wanted.result < USUAL_IS_ENOUGH)?.result;
        settings.tolerance.is_none().then(|| short((EQUILIBRIUM * wanted).max(FINEST)))
    }

    /// Solves the model with a setting, and keeps what is at the `stations`.
    pub fn solve(
        &mut self,
        stations: &[Vec<f64>],
        setting: &Setting,
        purpose: Purpose,
    ) -> Result<Results, RunError> {
        self.solve_within(usize::MAX, stations, setting, purpose)
    }

    /// [`Self::solve`], stopped after so many Newton iterations.
    pub fn solve_within(
        &mut self,
        iterations: usize,
        stations: &[Vec<f64>],
        setting: &Setting,
        purpose: Purpose,
    ) -> Result<Results, RunError> {
        let (model, analysis) = setting.apply(self.model, self.analysis);
        let has_corners = self.has_corners();
        let wanted = self.wanted.is_some_and(|w| w.curvature.is_some() || w.section_force.is_some());
        let modes = matches!(self.analysis, Analysis::Modal(_) | Analysis::Buckling(_));
        let all = purpose == Purpose::Results;
        let other = match &mut self.starts {
            Some(starts) if !all => Some(starts.of(&setting.beams)?),
            _ => None,
        };
        let options = self.options.again();
        let start = other.as_ref().map_or(options.start, Option::as_ref);
        let shape_points = match purpose {
            _ if wanted => options.shape_points,
            Purpose::Positions | Purpose::Shapes if modes => {
                let few = every(COARSER, options.shape_points);
                let cells = self.meshes.iter().map(Mesh::cells).max().unwrap_or(0);
                if 2 * cells < few { few } else { options.shape_points }
            }
            Purpose::Positions => 2,
            Purpose::Shapes => every(COARSER, options.shape_points),
            Purpose::Results => options.shape_points,
        };
        let mut observer = options.observer;
        let mut watch = |now: &Progress| match &mut observer {
            _ if now.newton_iterations > iterations => Control::Stop,
            Some(observer) => observer(now),
            None => Control::Continue,
        };
        let options = Options {
            start,
            observer: Some(&mut watch),
            states: (options.states || has_corners) && all,
            frames: if all { options.frames } else { 0 },
            shape_points,
            stations,
            compared: true,
            saved: options.saved && (all || other.is_some()),
            ..options
        };
        let results = model.solve_with(&analysis, options)?;
        if let Some(starts) = &mut self.starts {
            starts.keep(&setting.beams, results.states().saved.as_ref());
        }
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

    pub fn difference(&self, coarse: &Results, fine: &Results) -> Result<Difference, String> {
        difference::between(self.model, self.analysis, &self.meshes, coarse, fine)
    }
}

/// Whether something acts in a point, begins or ends within a cell that the scene gives a beam. `named` has nodes there, and those that the scene
/// names.
fn has_points(model: &Model, beam: usize, named: &Mesh) -> bool {
    let Ok(length) = Curve::new(&model.beams[beam].centreline).map(|curve| curve.length()) else {
        return false;
    };
    let discretization = &model.beams[beam].discretization;
    let breaks = model.breaks(beam);
    let own: Vec<f64> = match discretization {
        Discretization::Ancf { .. } => {
            Basis::broken(discretization, length, &breaks).map(|basis| basis.nodes().to_vec())
        }
        _ => Basis::new(discretization, length)
            .map(|basis| basis.nodes().iter().copied().chain(breaks).collect()),
    }
    .unwrap_or_default();
    if own.is_empty() {
        return false;
    }
    let near = AT_NODE * length / own.len() as f64;
    let within = |s: &f64| own.iter().all(|node| (node - s).abs() > near);
    named.nodes.iter().any(within) || model.edges(beam).iter().any(within)
}

/// Steps of twice the length, or with a tolerance that is as much looser, so many times in turn.
fn looser(times: i32, control: StepControl, settings: &Dynamic) -> StepControl {
    match control {
        StepControl::Fixed(step) => StepControl::Fixed((2.0_f64.powi(times) * step).min(settings.duration)),
        StepControl::Tolerance(tolerance) => {
            StepControl::Tolerance(short(LOOSER.powi(times) * tolerance).min(LOOSEST))
        }
    }
}

/// Number of every `stride`-th of so many evenly spaced places, ends included; all where they do not
/// come out even.
fn every(stride: usize, places: usize) -> usize {
    let spaces = places.saturating_sub(1);
    if spaces.is_multiple_of(stride) { spaces / stride + 1 } else { places }
}

/// Two digits, which is enough for a tolerance.
pub(super) fn short(tolerance: f64) -> f64 {
    format!("{tolerance:.1e}").parse().unwrap_or(tolerance)
}

/// The same kind of discretisation on fewer nodes.
pub(super) fn coarser(discretization: &Discretization, places: Nodes) -> Discretization {
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

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::scene::{Scene, parse};

    /// A clamped beam of 4 m whose basis is open unless it is named.
    pub fn scene(more: &str) -> Scene {
        let text = "beam.arm.start = [0, 0]\nbeam.arm.end = [4, 0]\nbeam.arm.axial_stiffness = 1e4\nbeam.arm.bending_stiffness = 1\n\
                    beam.arm.mass_per_length = 1\nsupport = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\n";
        parse("scene", &format!("{text}{more}\n")).unwrap_or_else(|error| panic!("{error}\n{more}"))
    }

    /// What begins a search in a scene for an error of the result.
    pub fn runner(scene: &Scene, wanted: f64) -> Runner<'_, 'static> {
        let wanted = Some(Accuracy::new(wanted));
        Runner::new(scene.model(), scene.analysis(), scene.open(), wanted, Options::default())
    }

    const MOTION: &str = "analysis.dynamic = { duration = 1 }";

    fn control(runner: &Runner<'_, '_>, steps: Fineness) -> StepControl {
        match runner.setting(Fineness::Fine, steps).solver {
            Solver::Integrator(integrator) => integrator.step_control(),
            other => panic!("{other}"),
        }
    }

    #[test]
    fn coarser_runs_take_larger_steps() {
        let of = |analysis: &str| {
            let scene = scene(analysis);
            let runner = runner(&scene, 1e-4);
            [Fineness::Fine, Fineness::Coarse, Fineness::Coarsest].map(|steps| control(&runner, steps))
        };
        let named =
            |step: &str| of(&format!("analysis.dynamic = {{ duration = 1, generalized_alpha.{step} }}"));
        assert_eq!(named("step = 0.0625"), [0.0625, 0.125, 0.25].map(StepControl::Fixed));
        assert_eq!(named("step = 0.375"), [0.375, 0.75, 1.0].map(StepControl::Fixed), "the whole motion");
        // A named tolerance is that of the finer run to the last digit; others need but two.
        assert_eq!(named("tolerance = 1.234e-5"), [1.234e-5, 2.0e-4, 3.2e-3].map(StepControl::Tolerance));
        assert_eq!(named("tolerance = 1e-3"), [1e-3, 1.6e-2, 0.1].map(StepControl::Tolerance));
        assert_eq!(of(MOTION), [3e-4, 4.8e-3, 7.7e-2].map(StepControl::Tolerance));
    }

    #[test]
    fn tolerances_follow_what_is_wanted() {
        let motion = scene(MOTION);
        assert_eq!([1e-2, 1e-5].map(|wanted| runner(&motion, wanted).tolerance), [1e-3, 3e-5]);
        let still = scene("analysis.static = {}");
        let of = |scene: &Scene, wanted: f64| runner(scene, wanted).static_tolerance();
        assert_eq!([1e-8, 9e-9, 1e-12].map(|wanted| of(&still, wanted)), [None, Some(9e-11), Some(1e-13)]);
        assert_eq!(of(&scene("analysis.static.tolerance = 1e-9"), 1e-12), None, "the scene names one");
        assert_eq!(of(&motion, 1e-12), None);
        assert_eq!((short(1.2345e-5), short(9.99e-3)), (1.2e-5, 1e-2));
    }

    /// The smaller an error is wanted, the more cells a search begins with: as the fourth root of the error, for modes a little
    /// slower, but no more than six times as many for an equilibrium.
    #[test]
    fn searches_begin_with_so_many_cells() {
        let cells = |analysis: &str, wanted: f64| runner(&scene(analysis), wanted).meshes[0].cells();
        let still = "analysis.static = {}";
        assert_eq!([1e-2, 1e-3, 1.1e-3 / 16.0, 1e-7].map(|wanted| cells(still, wanted)), [4, 4, 8, 24]);
        assert_eq!(cells(MOTION, 1e-9), 8);
        assert_eq!([1e-2, 1e-3].map(|wanted| cells("analysis.modal.count = 9", wanted)), [12, 20]);
        assert_eq!(
            cells(
                "analysis.buckling.count = 7\neffect.force = [{ beam = 'arm', at = 'end', value = [-1, 0] }]",
                1e-3
            ),
            16
        );
        // Of a named mesh of seven cells the coarse run takes three, of one cell the same.
        let named =
            |elements: usize| format!("beam.arm.basis.ancf.elements = {elements}\nanalysis.static = {{}}");
        assert_eq!([7, 8, 1].map(|elements| cells(&named(elements), 1e-3)), [3, 4, 1]);
    }

    #[test]
    fn runs_of_all_finenesses_are_of_the_same_kind() {
        let open = scene("analysis.static = {}");
        let nodes = |runner: &Runner<'_, '_>| {
            [Fineness::Coarsest, Fineness::Coarse, Fineness::Fine]
                .map(|mesh| runner.setting(mesh, Fineness::Fine).beams[0].0.nodes().count())
        };
        assert_eq!(nodes(&runner(&open, 1e-3)), [3, 5, 9]);
        let named = scene("beam.arm.basis.rpim = { nodes = 9, neighbours = 3 }\nanalysis.static = {}");
        let runner = runner(&named, 1e-3);
        assert_eq!(nodes(&runner), [3, 5, 9]);
        let coarse = &runner.setting(Fineness::Coarse, Fineness::Fine).beams[0];
        let Discretization::Rpim { neighbours: 3, nodes: Nodes::Uniform(5), .. } = coarse.0 else {
            panic!("{coarse:?}")
        };
    }

    /// Seven elements are two and a third times as many as three; beside an open beam errors fall as of halves. One element
    /// tells nothing, nor do narrow radial functions.
    #[test]
    fn named_meshes_fall_by_their_own_factor_or_not_at_all() {
        let of = |basis: &str, more: &str| {
            let scene = scene(&format!("beam.arm.basis = {basis}\n{more}analysis.static = {{}}"));
            let runner = runner(&scene, 1e-3);
            (runner.is_unseen(0), runner.halvings.exp2(), runner.contractions(f64::INFINITY)[0])
        };
        let (unseen, times, fall) = of("{ ancf.elements = 7 }", "");
        assert!(!unseen && (times - 7.0 / 3.0).abs() < 1e-12);
        assert!((fall - 15.0_f64.powf(times.log2())).abs() < 1e-9, "{fall}");
        assert_eq!(of("{ ancf.elements = 8 }", ""), (false, 2.0, 15.0));
        assert_eq!(of("{ ancf.elements = 1 }", ""), (true, 2.0, 15.0));
        assert!(of("{ rpim = { nodes = 9, kernel = { wendland = { radius = 8.0 } } } }", "").0);
        // A node that must be at 1.5 m leaves one cell before it.
        let couple = "effect.moment = [{ beam = 'arm', at = 1.5, value = 1 }]\n";
        assert!(of("{ ancf.nodes = [0, 2, 3, 4] }", couple).0);
        assert!(!of("{ ancf.nodes = [0, 0.75, 1.5, 2.75, 4] }", couple).0);
        let moving = scene(&format!("beam.arm.basis.ancf.elements = 7\n{MOTION}"));
        assert_eq!(runner(&moving, 1e-3).contractions(f64::INFINITY)[0], 10.0, "steps are halved");
    }

    /// Small errors of motions are cheaper by interpolation without a mesh, of stiff beams without
    /// places that must be nodes.
    #[test]
    fn meshfree_beams_are_for_small_errors_of_motions() {
        let meshfree = |more: &str, wanted: f64| runner(&scene(more), wanted).families[0] == MESHFREE_FAMILY;
        assert!(meshfree(MOTION, 3e-5) && !meshfree(MOTION, 4e-5) && !meshfree("analysis.static = {}", 1e-6));
        let node = "effect.moment = [{ beam = 'arm', at = 1.5, value = 1 }]";
        assert!(!meshfree(&format!("{node}\n{MOTION}"), 1e-6));
        let without = |stiffness: &str| {
            let text = format!(
                "beam.arm = {{ start = [0, 0], end = [4, 0], {stiffness} = 1, mass_per_length = 1 }}\n\
                 support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}]\n{MOTION}\n"
            );
            parse("scene", &text).unwrap_or_else(|error| panic!("{error}"))
        };
        for stiffness in ["axial_stiffness", "bending_stiffness"] {
            assert!(runner(&without(stiffness), 1e-6).families[0] == Family::REDUCED, "{stiffness}");
        }
    }

    /// A quarter of the load step goes with a 16th of the tolerance, and every load factor of a coarser run is one of the finer.
    #[test]
    fn load_steps_follow_the_tolerance_where_there_is_friction() {
        let ground = "effect.contact = [{ beam = 'arm', stiffness = 1e4, half_plane = { point = [0, -1], normal = [0, 1] }, friction = { coefficient = 0.3 } }]";
        let steps = |analysis: &str, fineness: Fineness| {
            let scene = scene(&format!("{ground}\n{analysis}"));
            match runner(&scene, 1e-4).setting(fineness, fineness).solver {
                Solver::LoadSteps { largest, .. } => 1.0 / largest,
                _ => 0.0,
            }
        };
        let all = |analysis: &str| {
            [Fineness::Coarsest, Fineness::Coarse, Fineness::Fine]
                .map(|fineness| steps(analysis, fineness).round())
        };
        // 0.6 √3e-4 is 1/96.
        assert_eq!(all("analysis.static = {}"), [7.0, 28.0, 112.0]);
        assert_eq!(all("analysis.static.max_step = 0.01"), [25.0, 50.0, 0.0]);
        assert_eq!(all("analysis.static.arc_length = { max_points = 9 }"), [13.0, 25.0, 0.0]);
        assert_eq!(all("analysis.static.arc_length = { max_points = 9, max_step = 0.1 }"), [3.0, 5.0, 0.0]);
    }

    #[test]
    fn a_part_of_the_places_comes_out_even_or_is_all() {
        assert_eq!([every(4, 201), every(4, 5), every(4, 202), every(4, 1)], [51, 2, 202, 1]);
    }
}
