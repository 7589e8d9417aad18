//! What is varied: discretisations, meshes, and how equations are advanced or solved.

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
    /// As the scene says.
    Scene,
    /// Cable elements.
    Ancf(GaussPoints),
    /// Radial point interpolation with multiquadrics; what is not said takes the defaults of
    /// scenes.
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
    /// Cable elements as scenes have them where they say no more: with fewer points, which let
    /// membrane locking go.
    pub const REDUCED: Self = Self::Ancf(ANCF_GAUSS_POINTS);

    /// Radial point interpolation as scenes have it where they say no more, but for the Gauss
    /// points.
    pub fn usual(points: usize) -> Self {
        let shape = match RPIM_KERNEL {
            Kernel::Multiquadric { shape, .. } => shape,
            _ => 5.0,
        };
        Self::Rpim { neighbours: RPIM_NEIGHBOURS, shape, points }
    }

    /// Those of the ladder.
    pub fn all() -> Vec<Self> {
        let points = RPIM_GAUSS_POINTS.bend;
        let widths = [2, 1, 3].into_iter();
        let rpim = widths
            .flat_map(|neighbours| [6.0, 3.3, 10.0].map(|shape| Self::Rpim { neighbours, shape, points }));
        let usual = [points, points - 1].map(Self::usual);
        [Self::FULL, Self::REDUCED].into_iter().chain(usual).chain(rpim).collect()
    }

    /// The beams of `model` with as many cells that the one with the most has `cells`, the others
    /// in proportion to what they have in the model. Nodes are spaced evenly, or graded as the
    /// model's given ones.
    pub(super) fn beams(self, model: &Model, cells: usize) -> Vec<(Discretization, GaussPoints)> {
        let most = model.beams.iter().map(cells_of).max().unwrap_or(1);
        let beam = |beam: &Beam| {
            let share = cells as f64 * cells_of(beam) as f64 / most as f64;
            let nodes = graded(beam.discretization.nodes(), (share.round() as usize).max(1));
            match self {
                Self::Scene => (beam.discretization.clone(), beam.gauss_points),
                // What does not lock needs its points: a string folds where too few resist.
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
        };
        model.beams.iter().map(beam).collect()
    }

    /// The discretisation without what is varied within RPIM beyond the support: for the colours of
    /// plots.
    pub(super) fn kind(self) -> String {
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
pub(super) fn cells(model: &Model) -> usize {
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
    /// As the scene says.
    Scene,
    /// Equilibria to this relative accuracy.
    Tolerance(f64),
    /// Motion by this integrator.
    Integrator(Integrator),
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene => f.write_str("as the scene is"),
            Self::Tolerance(tolerance) => write!(f, "tolerance {tolerance:e}"),
            Self::Integrator(integrator) => integrator.fmt(f),
        }
    }
}

/// Everything that the ladder varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Per beam.
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
            (Solver::Integrator(integrator), Analysis::Dynamic(settings)) => settings.integrator = integrator,
            _ => {}
        }
        (model, analysis)
    }

    /// The lines of a scene that ask for this setting: tables to stand in place of those of the
    /// same names, the bases of all beams and the integrator.
    pub fn toml(&self, model: &Model) -> String {
        let mut tables = Vec::new();
        for (beam, (discretization, points)) in model.beams.iter().zip(&self.beams) {
            let name = Key::new(beam.name.as_str());
            tables.push(basis(&format!("beam.{name}.basis"), discretization, *points));
        }
        match self.solver {
            Solver::Scene => {}
            Solver::Tolerance(tolerance) => {
                tables.push(format!("[analysis.static]\ntolerance = {tolerance:e}\n"));
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

    #[test]
    fn beams_keep_their_proportion_and_grading() {
        let scene = scene("[analysis.static]");
        let beams = Family::FULL.beams(scene.model(), 16);
        assert_eq!(beams[0].0, Discretization::Ancf { nodes: Nodes::Uniform(17) });
        assert_eq!(beams[1].0, Discretization::Ancf { nodes: Nodes::Given(vec![0.0, 0.25, 0.5, 1.25, 2.0]) });
    }
}
