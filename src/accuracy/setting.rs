//! The settings that are varied: discretisations, meshes, and how equations are advanced or solved.

use std::fmt;
use std::fmt::Write as _;

use toml_edit::Key;

use crate::model::{
    ANCF_GAUSS_POINTS, RPIM_GAUSS_POINTS, RPIM_KERNEL, RPIM_NEIGHBOURS, RPIM_POLYNOMIAL_TERMS,
    RPIM_SIDE_CONDITION, SPECTRAL_RADIUS, STRING_GAUSS_POINTS,
};
use crate::model::{
    Analysis, Beam, Discretization, GaussPoints, Integrator, Kernel, Model, Nodes, SideCondition, StepControl,
};

/// A kind of discretisation, of any fineness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// The scene's own.
    Scene,
    /// Cable elements.
    Ancf(GaussPoints),
    /// Radial point interpolation with multiquadrics; everything else takes the defaults of scenes.
    Rpim {
        /// Nodes beyond the cell's own two, on each side.
        neighbours: usize,
        /// Shape parameter.
        shape: f64,
        /// Gauss points in a cell.
        points: usize,
    },
}

impl Family {
    /// Cable elements with the points that integrate Green's strain exactly.
    pub const FULL: Self = Self::Ancf(GaussPoints { stretch: 5, bend: 3, lobatto: false });
    /// Cable elements as scenes have them by default: with fewer points, which avoids membrane
    /// locking.
    pub const REDUCED: Self = Self::Ancf(ANCF_GAUSS_POINTS);

    /// Radial point interpolation as scenes have it by default, but for the Gauss points.
    pub fn usual(points: usize) -> Self {
        let shape = match RPIM_KERNEL {
            Kernel::Multiquadric { shape, .. } => shape,
            _ => 5.0,
        };
        Self::Rpim { neighbours: RPIM_NEIGHBOURS, shape, points }
    }

    /// The families of the search.
    pub fn all() -> Vec<Self> {
        let points = RPIM_GAUSS_POINTS.bend;
        let widths = [2, 1, 3].into_iter();
        let rpim = widths
            .flat_map(|neighbours| [6.0, 3.3, 10.0].map(|shape| Self::Rpim { neighbours, shape, points }));
        let usual = [points, points - 1].map(Self::usual);
        [Self::FULL, Self::REDUCED].into_iter().chain(usual).chain(rpim).collect()
    }

    /// The beams of `model` with new meshes: the beam with the most cells has `cells` of them, the
    /// others in proportion to their numbers in the model. Nodes are spaced evenly, or graded as
    /// the model's given ones.
    pub(crate) fn beams(self, model: &Model, cells: usize) -> Vec<(Discretization, GaussPoints)> {
        let most = model.beams.iter().map(cells_of).max().unwrap_or(1);
        let beam = |beam: &Beam| {
            let share = cells as f64 * cells_of(beam) as f64 / most as f64;
            let nodes = graded(beam.discretization.nodes(), (share.round() as usize).max(1));
            self.of(beam, nodes)
        };
        model.beams.iter().map(beam).collect()
    }

    /// The discretisation and the Gauss points of a beam on these nodes.
    pub(crate) fn of(self, beam: &Beam, nodes: Nodes) -> (Discretization, GaussPoints) {
        match self {
            Self::Scene => (beam.discretization.clone(), beam.gauss_points),
            // Strings and inextensible beams do not lock: they keep all points, because a string
            // folds where too few resist.
            Self::Ancf(_)
                if beam.section.bending_stiffness.is_none() || beam.section.axial_stiffness.is_none() =>
            {
                (Discretization::Ancf { nodes }, STRING_GAUSS_POINTS)
            }
            Self::Ancf(points) => (Discretization::Ancf { nodes }, points),
            Self::Rpim { neighbours, shape, points } => {
                let kernel = match RPIM_KERNEL {
                    Kernel::Multiquadric { q, .. } => Kernel::Multiquadric { q, shape },
                    other => other,
                };
                let discretization = Discretization::Rpim {
                    nodes,
                    kernel,
                    polynomial_terms: RPIM_POLYNOMIAL_TERMS,
                    side_condition: RPIM_SIDE_CONDITION,
                    neighbours,
                };
                (discretization, GaussPoints { stretch: points, bend: points, lobatto: false })
            }
        }
    }

    /// The discretisation without the parameters of RPIM other than the number of neighbours: for
    /// the colours of plots.
    pub(crate) fn kind(self) -> String {
        match self {
            Self::Rpim { neighbours, .. } => {
                format!("RPIM, {neighbours} neighbour{}", if neighbours == 1 { "" } else { "s" })
            }
            other => other.to_string(),
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("as the scene is"),
            Self::Ancf(points) => {
                let rule = if points.lobatto { "L" } else { "" };
                write!(f, "ANCF, {}{rule}/{} points", points.stretch, points.bend)
            }
            Self::Rpim { shape, points, .. } => {
                write!(f, "{}, shape {shape}", self.kind())?;
                if *points == RPIM_GAUSS_POINTS.bend { Ok(()) } else { write!(f, ", {points} points") }
            }
        }
    }
}

/// Cells between the nodes of a beam.
fn cells_of(beam: &Beam) -> usize {
    beam.discretization.nodes().count().saturating_sub(1).max(1)
}

/// Cells of the beam of `model` that has the most.
pub(crate) fn cells(model: &Model) -> usize {
    model.beams.iter().map(cells_of).max().unwrap_or(1)
}

/// `cells` cells, spaced evenly, or as the nodes given are.
fn graded(nodes: &Nodes, cells: usize) -> Nodes {
    let Nodes::Given(given) = nodes else { return Nodes::Uniform(cells + 1) };
    let last = given.len().saturating_sub(1);
    let place = |i: usize| {
        let at = i as f64 * last as f64 / cells as f64;
        let left = (at.floor() as usize).min(last);
        let right = (left + 1).min(last);
        given[left] + (at - left as f64) * (given[right] - given[left])
    };
    Nodes::Given((0..=cells).map(place).collect())
}

/// How equations are solved or advanced in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solver {
    /// The scene's own.
    Scene,
    /// Equilibria to this relative accuracy.
    Tolerance(f64),
    /// Equilibria with a largest load step, or step along a path.
    LoadSteps {
        /// The largest step, of the load factor or in beam lengths.
        largest: f64,
        /// Their relative accuracy, where it is not the scene's.
        tolerance: Option<f64>,
    },
    /// Motion by this integrator.
    Integrator(Integrator),
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("as the scene is"),
            Self::Tolerance(tolerance) => write!(f, "tolerance {tolerance:e}"),
            Self::LoadSteps { largest, .. } => write!(f, "steps of {largest:e} of the load"),
            Self::Integrator(integrator) => integrator.fmt(f),
        }
    }
}

/// Everything that the search varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The discretisation and the Gauss points of each beam.
    pub beams: Vec<(Discretization, GaussPoints)>,
    /// How equations are solved.
    pub solver: Solver,
}

impl Setting {
    /// The model and the analysis with this setting in place of theirs.
    pub fn apply(&self, model: &Model, analysis: &Analysis) -> (Model, Analysis) {
        let (mut model, mut analysis) = (model.clone(), analysis.clone());
        for (beam, (discretization, points)) in model.beams.iter_mut().zip(&self.beams) {
            beam.discretization = discretization.clone();
            beam.gauss_points = *points;
        }
        match (self.solver, &mut analysis) {
            (Solver::Tolerance(tolerance), Analysis::Static(settings)) => {
                settings.tolerance = Some(tolerance);
            }
            (Solver::LoadSteps { largest, tolerance }, Analysis::Static(settings)) => {
                settings.tolerance = tolerance.or(settings.tolerance);
                match &mut settings.arc_length {
                    Some(arc) => arc.max_step = Some(largest),
                    None => settings.max_step = Some(largest),
                }
            }
            (Solver::Integrator(integrator), Analysis::Dynamic(settings)) => settings.integrator = integrator,
            _ => {}
        }
        (model, analysis)
    }

    /// The lines of a scene that select this setting, to stand in place of the tables of the same
    /// names: the bases of all beams and the integrator.
    pub fn toml(&self, model: &Model) -> String {
        self.toml_of(model, |_| true, true)
    }

    /// The same for some of the beams, by index, and with the solver or without.
    pub fn toml_of(&self, model: &Model, which: impl Fn(usize) -> bool, solver: bool) -> String {
        let mut tables = Vec::new();
        for (index, (beam, (discretization, points))) in model.beams.iter().zip(&self.beams).enumerate() {
            if which(index) {
                let name = Key::new(beam.name.as_str());
                tables.push(basis(&format!("beam.{name}.basis"), discretization, *points));
            }
        }
        match self.solver {
            _ if !solver => {}
            Solver::Scene => {}
            Solver::Tolerance(tolerance) => {
                tables.push(format!("[analysis.static]\ntolerance = {tolerance:e}\n"));
            }
            Solver::LoadSteps { largest, tolerance } => {
                let tolerance =
                    tolerance.map_or_else(String::new, |value| format!("tolerance = {value:e}\n"));
                tables.push(format!("[analysis.static]\nmax_step = {largest:e}\n{tolerance}"));
            }
            Solver::Integrator(integrator) => tables.push(method(&integrator)),
        }
        tables.join("\n")
    }
}

fn basis(path: &str, discretization: &Discretization, points: GaussPoints) -> String {
    let (kind, nodes, default_points) = match discretization {
        Discretization::Ancf { nodes } => ("ancf", nodes, ANCF_GAUSS_POINTS),
        Discretization::Rpim { nodes, .. } => ("rpim", nodes, RPIM_GAUSS_POINTS),
        Discretization::Open => return String::new(),
    };
    let mut text = format!("[{path}.{kind}]\n");
    // Writing to a string does not fail.
    let _ = match nodes {
        Nodes::Uniform(count) if kind == "ancf" => writeln!(text, "elements = {}", count - 1),
        Nodes::Uniform(count) => writeln!(text, "nodes = {count}"),
        Nodes::Chebyshev(count) => writeln!(text, "nodes = {count}\nspacing = \"chebyshev\""),
        Nodes::Given(places) => writeln!(text, "nodes = {places:?}"),
    };
    if let Discretization::Rpim { kernel, polynomial_terms, side_condition, neighbours, .. } = discretization
    {
        let _ = writeln!(text, "neighbours = {neighbours}");
        let _ = match kernel {
            Kernel::Multiquadric { q, shape } => {
                writeln!(text, "kernel.multiquadric = {{ q = {q:?}, shape = {shape:?} }}")
            }
            Kernel::Exponential { shape } => writeln!(text, "kernel.exponential = {{ shape = {shape:?} }}"),
            Kernel::ThinPlateSpline { exponent } => {
                writeln!(text, "kernel.thin_plate_spline = {{ exponent = {exponent:?} }}")
            }
            Kernel::Wendland { radius } => writeln!(text, "kernel.wendland = {{ radius = {radius:?} }}"),
        };
        if *polynomial_terms != RPIM_POLYNOMIAL_TERMS {
            let _ = writeln!(text, "polynomial_terms = {polynomial_terms}");
        }
        if *side_condition != RPIM_SIDE_CONDITION {
            let sign = match side_condition {
                SideCondition::Plus => "plus",
                SideCondition::Minus => "minus",
            };
            let _ = writeln!(text, "side_condition = \"{sign}\"");
        }
    }
    if points != default_points {
        let GaussPoints { stretch, bend, lobatto } = points;
        let rule = if lobatto { ", stretch_rule = \"lobatto\"" } else { "" };
        let _ = writeln!(text, "gauss_points = {{ stretch = {stretch}, bend = {bend}{rule} }}");
    }
    text
}

fn method(integrator: &Integrator) -> String {
    let (name, first) = match integrator {
        Integrator::GeneralizedAlpha { spectral_radius, newton_tolerance, .. } => {
            let mut lines = String::new();
            if *spectral_radius != SPECTRAL_RADIUS {
                lines += &format!("spectral_radius = {spectral_radius:?}\n");
            }
            if *newton_tolerance != Integrator::NEWTON_TOLERANCE {
                lines += &format!("newton_tolerance = {newton_tolerance:e}\n");
            }
            ("generalized_alpha", lines)
        }
        Integrator::Gauss { stages, .. } => ("gauss", format!("stages = {stages}\n")),
        Integrator::Radau { stages, .. } => ("radau", format!("stages = {stages}\n")),
    };
    let control = match integrator.step_control() {
        StepControl::Fixed(step) => format!("step = {step:?}"),
        StepControl::Tolerance(tolerance) => format!("tolerance = {tolerance:e}"),
    };
    format!("[analysis.dynamic.{name}]\n{first}{control}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, parse};

    const BEAMS: &str = r#"
        [beam.arm]
        start = [0, 0]
        end = [2, 0]
        axial_stiffness = 1e4
        bending_stiffness = 1.0
        mass_per_length = 1.0
        basis.ancf.elements = 8
        [beam."a rod"]
        start = [0, 1]
        end = [2, 1]
        axial_stiffness = 1e4
        bending_stiffness = 1.0
        mass_per_length = 1.0
        basis.rpim = { nodes = [0.0, 0.5, 2.0], kernel.wendland.radius = 4.0 }
        [[support]]
        beam = "arm"
        at = 0.3
        fix = ["x", "y", "angle"]
        [[support]]
        beam = "a rod"
        at = "start"
        fix = ["x", "y", "angle"]
    "#;

    fn scene(analysis: &str) -> Scene {
        parse("scene", &format!("{BEAMS}\n{analysis}")).unwrap()
    }

    #[test]
    fn lines_say_what_the_setting_is() {
        let motion = scene("[analysis.dynamic]\nduration = 1.0\ngeneralized_alpha = { step = 0.01 }");
        let still = scene("[analysis.static]\nsteps = 2");
        let (tolerance, step) = (StepControl::Tolerance(1e-5), StepControl::Fixed(0.003));
        let integrators = [
            Integrator::Gauss { stages: 2, step: tolerance },
            Integrator::Radau { stages: 3, step },
            Integrator::GeneralizedAlpha { step, spectral_radius: SPECTRAL_RADIUS, newton_tolerance: 2e-9 },
            Integrator::GeneralizedAlpha {
                step: tolerance,
                spectral_radius: 1.0,
                newton_tolerance: Integrator::NEWTON_TOLERANCE,
            },
        ];
        let mut solvers: Vec<_> = integrators.map(|i| (&motion, Solver::Integrator(i))).into();
        solvers.extend([(&still, Solver::Scene), (&still, Solver::Tolerance(2e-7))]);
        let largest = 1.0 / 112.0;
        solvers
            .extend([None, Some(2e-7)].map(|tolerance| (&still, Solver::LoadSteps { largest, tolerance })));
        for family in Family::all().into_iter().chain([Family::Scene]) {
            for &(scene, solver) in &solvers {
                let setting = Setting { beams: family.beams(scene.model(), 6), solver };
                let lines = setting.toml(scene.model());
                let merged = scene.merged(&lines).unwrap_or_else(|error| panic!("{error}\n{lines}"));
                let (model, analysis) = setting.apply(scene.model(), scene.analysis());
                assert_eq!(merged.model(), &model, "{lines}");
                assert_eq!(merged.analysis(), &analysis, "{lines}");
            }
        }
    }

    /// Defaults are left out.
    #[test]
    fn lines_say_no_more_than_they_must() {
        let given = || Nodes::Given(vec![0.0, 0.5, 2.0]);
        let rpim = |kernel, polynomial_terms, side_condition| Discretization::Rpim {
            nodes: Nodes::Uniform(7),
            kernel,
            polynomial_terms,
            side_condition,
            neighbours: 1,
        };
        let (usual, plus, minus) = (RPIM_GAUSS_POINTS, SideCondition::Plus, SideCondition::Minus);
        let points = |stretch, bend, lobatto| GaussPoints { stretch, bend, lobatto };
        for (discretization, points, expected) in [
            (Discretization::ancf(8), ANCF_GAUSS_POINTS, "ancf]\nelements = 8\n"),
            (
                Discretization::Ancf { nodes: Nodes::Chebyshev(5) },
                points(5, 3, false),
                "ancf]\nnodes = 5\nspacing = \"chebyshev\"\ngauss_points = { stretch = 5, bend = 3 }\n",
            ),
            (
                Discretization::Ancf { nodes: given() },
                points(4, 2, true),
                "ancf]\nnodes = [0.0, 0.5, 2.0]\n\
                 gauss_points = { stretch = 4, bend = 2, stretch_rule = \"lobatto\" }\n",
            ),
            (
                rpim(RPIM_KERNEL, 2, plus),
                usual,
                "rpim]\nnodes = 7\nneighbours = 1\nkernel.multiquadric = { q = 1.03, shape = 5.0 }\n",
            ),
            (
                rpim(Kernel::ThinPlateSpline { exponent: 5.0 }, 4, minus),
                usual,
                "rpim]\nnodes = 7\nneighbours = 1\nkernel.thin_plate_spline = { exponent = 5.0 }\n\
                 polynomial_terms = 4\nside_condition = \"minus\"\n",
            ),
            (
                rpim(Kernel::Exponential { shape: 0.5 }, 2, plus),
                points(4, 3, false),
                "rpim]\nnodes = 7\nneighbours = 1\nkernel.exponential = { shape = 0.5 }\n\
                 gauss_points = { stretch = 4, bend = 3 }\n",
            ),
            (
                rpim(Kernel::Wendland { radius: 4.0 }, 2, plus),
                usual,
                "rpim]\nnodes = 7\nneighbours = 1\nkernel.wendland = { radius = 4.0 }\n",
            ),
        ] {
            let lines = basis("beam.arm.basis", &discretization, points);
            assert_eq!(lines, format!("[beam.arm.basis.{expected}"));
        }
        let step = StepControl::Fixed(0.003);
        let alpha = |spectral_radius: f64, newton_tolerance: f64| Integrator::GeneralizedAlpha {
            step,
            spectral_radius,
            newton_tolerance,
        };
        for (integrator, expected) in [
            (alpha(0.9, 1e-11), "generalized_alpha]\nstep = 0.003\n"),
            (alpha(0.5, 1e-11), "generalized_alpha]\nspectral_radius = 0.5\nstep = 0.003\n"),
            (alpha(0.9, 2e-9), "generalized_alpha]\nnewton_tolerance = 2e-9\nstep = 0.003\n"),
            (Integrator::Gauss { stages: 2, step }, "gauss]\nstages = 2\nstep = 0.003\n"),
            (
                Integrator::Radau { stages: 3, step: StepControl::Tolerance(1e-5) },
                "radau]\nstages = 3\ntolerance = 1e-5\n",
            ),
        ] {
            assert_eq!(method(&integrator), format!("[analysis.dynamic.{expected}"));
        }
    }

    /// Everything that a scene may say of a meshfree basis and of an integrator is legal in a
    /// scene.
    #[test]
    fn lines_of_unusual_settings_are_legal() {
        let scene = scene("[analysis.dynamic]\nduration = 1.0");
        let step = StepControl::Fixed(0.003);
        let solver = Solver::Integrator(Integrator::GeneralizedAlpha {
            step,
            spectral_radius: 0.5,
            newton_tolerance: 2e-9,
        });
        for kernel in [Kernel::ThinPlateSpline { exponent: 5.0 }, Kernel::Exponential { shape: 0.5 }] {
            let beam = Discretization::Rpim {
                nodes: Nodes::Chebyshev(7),
                kernel,
                polynomial_terms: 4,
                side_condition: SideCondition::Minus,
                neighbours: 1,
            };
            let other = Discretization::Ancf { nodes: Nodes::Given(vec![0.0, 0.5, 2.0]) };
            let points = GaussPoints { stretch: 4, bend: 2, lobatto: true };
            let setting = Setting { beams: vec![(beam, RPIM_GAUSS_POINTS), (other, points)], solver };
            let lines = setting.toml(scene.model());
            let merged = scene.merged(&lines).unwrap_or_else(|error| panic!("{error}\n{lines}"));
            let (model, analysis) = setting.apply(scene.model(), scene.analysis());
            assert_eq!((merged.model(), merged.analysis()), (&model, &analysis), "{lines}");
        }
    }

    #[test]
    fn the_search_has_these_families() {
        let names: Vec<String> = Family::all().iter().map(Family::to_string).collect();
        let expected = [
            "ANCF, 5/3 points",
            "ANCF, 3L/2 points",
            "RPIM, 2 neighbours, shape 5",
            "RPIM, 2 neighbours, shape 5, 3 points",
            "RPIM, 2 neighbours, shape 6",
            "RPIM, 2 neighbours, shape 3.3",
            "RPIM, 2 neighbours, shape 10",
            "RPIM, 1 neighbour, shape 6",
            "RPIM, 1 neighbour, shape 3.3",
            "RPIM, 1 neighbour, shape 10",
            "RPIM, 3 neighbours, shape 6",
            "RPIM, 3 neighbours, shape 3.3",
            "RPIM, 3 neighbours, shape 10",
        ];
        assert_eq!(names, expected);
        assert_eq!(Family::Scene.kind(), "as the scene is");
        assert_eq!(Family::usual(3).kind(), "RPIM, 2 neighbours");
        assert_eq!(Solver::Tolerance(2e-7).to_string(), "tolerance 2e-7");
    }

    #[test]
    fn a_setting_changes_what_it_is_about() {
        let still = scene("[analysis.static]\nsteps = 2");
        let beams = Family::FULL.beams(still.model(), 4);
        let with = |solver: Solver, analysis: &Analysis| {
            Setting { beams: beams.clone(), solver }.apply(still.model(), analysis)
        };
        let (model, analysis) = with(Solver::Tolerance(2e-7), still.analysis());
        assert_eq!(model.beams[0].discretization, Discretization::ancf(4));
        assert_eq!(model.beams[0].gauss_points, GaussPoints { stretch: 5, bend: 3, lobatto: false });
        assert!(
            matches!(&analysis, Analysis::Static(s) if s.tolerance == Some(2e-7) && s.steps == Some(2)),
            "{analysis:?}"
        );
        let motion = scene("[analysis.dynamic]\nduration = 1.0");
        let gauss = Integrator::Gauss { stages: 2, step: StepControl::Fixed(0.5) };
        let (_, analysis) = with(Solver::Integrator(gauss), motion.analysis());
        assert!(
            matches!(&analysis, Analysis::Dynamic(d) if d.integrator == gauss && d.duration == 1.0),
            "{analysis:?}"
        );
        // An analysis that does not know the solver is left as it is.
        let (_, analysis) = with(Solver::Tolerance(2e-7), motion.analysis());
        assert_eq!(&analysis, motion.analysis());
    }

    /// Eight and two cells become sixteen and four, and one of each at least.
    #[test]
    fn beams_keep_their_proportion_and_grading() {
        let scene = scene("[analysis.static]");
        assert_eq!(cells(scene.model()), 8);
        let beams = Family::FULL.beams(scene.model(), 16);
        assert_eq!(beams[0].0, Discretization::Ancf { nodes: Nodes::Uniform(17) });
        assert_eq!(beams[1].0, Discretization::Ancf { nodes: Nodes::Given(vec![0.0, 0.25, 0.5, 1.25, 2.0]) });
        let beams = Family::FULL.beams(scene.model(), 1);
        assert_eq!(beams[0].0, Discretization::Ancf { nodes: Nodes::Uniform(2) });
        assert_eq!(beams[1].0, Discretization::Ancf { nodes: Nodes::Given(vec![0.0, 2.0]) });
        // A third and two thirds of the way along two cells of 0.5 m and 1.5 m.
        let Nodes::Given(places) = graded(&Nodes::Given(vec![0.0, 0.5, 2.0]), 3) else {
            panic!("given nodes stay given")
        };
        let expected = [0.0, 1.0 / 3.0, 1.0, 2.0];
        assert!(
            places.iter().zip(expected).all(|(found, right)| (found - right).abs() < 1e-15),
            "{places:?}"
        );
        assert_eq!(places.len(), 4);
    }

    /// Neither of them locks.
    #[test]
    fn strings_and_inextensible_beams_keep_their_points() {
        let text = "beam.beam = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, basis.ancf.elements = 4 }\n\
                    beam.rope = { start = [0, 1], end = [1, 1], axial_stiffness = 1, basis.ancf.elements = 4 }\n\
                    beam.rod = { start = [0, 2], end = [1, 2], bending_stiffness = 1, basis.ancf.elements = 4 }\n\
                    support = [{ beam = 'beam', at = 'start', fix = ['x', 'y', 'angle'] }, \
                    { beam = 'rope', at = 'start', fix = ['x', 'y'] }, { beam = 'rope', at = 'end', fix = ['x', 'y'] }, \
                    { beam = 'rod', at = 'start', fix = ['x', 'y', 'angle'] }]\n\
                    analysis.static = {}\n";
        let scene = parse("scene", text).unwrap();
        let points: Vec<GaussPoints> =
            Family::REDUCED.beams(scene.model(), 8).into_iter().map(|(_, points)| points).collect();
        let full = GaussPoints { stretch: 5, bend: 3, lobatto: false };
        assert_eq!(points, [GaussPoints { stretch: 3, bend: 2, lobatto: true }, full, full]);
    }
}
