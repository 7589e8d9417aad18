//! A model in plain words: nodes, numbers, supports and loads at nodes. The one translation to
//! other codes.
//!
//! Whatever these words cannot say is an error that names it; nothing is left out silently.

use std::any::Any;

use ancf::basis::Basis;
use ancf::centreline::Curve;
use ancf::effect::{self, BeamDamping, Gravity};
use ancf::model::{
    About, Along, Analysis, Beam, Centreline, Discretization, FixedRotation, Integrator, Joint, Law, Modal,
    Model, Place, StepControl, StrainMeasure,
};
use serde::Serialize;

/// Parts of the load in statics where the scene leaves it to the solver.
const LOAD_STEPS: usize = 20;

/// The problem that another code is asked to solve.
#[derive(Debug, Serialize)]
pub struct Description {
    beams: Vec<Cable>,
    supports: Vec<Support>,
    joints: Vec<Joined>,
    forces: Vec<Force>,
    moments: Vec<Moment>,
    gravity: [f64; 2],
    probes: Vec<Probe>,
    analysis: Question,
}

/// A straight beam of engineering strain, cut into cubic elements.
#[derive(Debug, Serialize)]
struct Cable {
    nodes: Vec<[f64; 2]>,
    tangent: [f64; 2],
    /// Rates of \[x, y, x', y'\] at every node.
    velocities: Vec<[f64; 4]>,
    lengths: Vec<f64>,
    axial_stiffness: f64,
    bending_stiffness: f64,
    mass_per_length: f64,
    /// c of the axial force EA ε + c ε̇ \[N s\].
    axial_damping: f64,
    /// c of the bending moment EI κ + c κ̇ \[N m² s\].
    bending_damping: f64,
    gauss_points: [usize; 2],
}

#[derive(Debug, Serialize)]
struct Support {
    beam: usize,
    node: usize,
    x: bool,
    y: bool,
    rotation: &'static str,
    /// The displacements of the fixed quantities, x \[m\], y \[m\], angle \[rad\], at the start and
    /// at the end of every step.
    moved: Option<Vec<[f64; 3]>>,
}

/// Two nodes at the same place, each as beam and node; a weld keeps the angle between their directions.
#[derive(Debug, PartialEq, Serialize)]
struct Joined {
    first: [usize; 2],
    second: [usize; 2],
    weld: bool,
}

#[derive(Debug, Serialize)]
struct Force {
    beam: usize,
    node: usize,
    value: [f64; 2],
    follower: bool,
    factors: Option<Factors>,
}

#[derive(Debug, Serialize)]
struct Moment {
    beam: usize,
    node: usize,
    value: f64,
    factors: Option<Factors>,
}

/// The factors of a load at the start of a motion and at the end of every step.
type Factors = Vec<f64>;

#[derive(Debug, Serialize)]
struct Probe {
    name: String,
    beam: usize,
    node: usize,
}

#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum Question {
    Static { steps: usize },
    Dynamic { steps: usize, step: f64, every: usize, spectral_radius: f64 },
    Modal { count: usize },
}

/// Says a model and what is to be computed in plain words.
///
/// # Errors
/// What cannot be said: `no counterpart for …`.
pub fn describe(model: &Model, analysis: &Analysis) -> Result<Description, String> {
    let bases = model.beams.iter().map(basis).collect::<Result<Vec<_>, _>>()?;
    let node = |what: &str, at: &Place| {
        let found = bases.get(at.beam).and_then(|basis| basis.node_at(at.s));
        found.ok_or_else(|| none(&format!("{what} at s = {} m, where no node is", at.s)))
    };
    let mut description = Description {
        beams: model
            .beams
            .iter()
            .zip(&bases)
            .map(|(beam, basis)| cable(beam, basis))
            .collect::<Result<_, _>>()?,
        supports: Vec::new(),
        joints: Vec::new(),
        forces: Vec::new(),
        moments: Vec::new(),
        gravity: [0.0; 2],
        probes: Vec::new(),
        analysis: question(analysis)?,
    };
    let times = times(&description.analysis);
    for joint in &model.joints {
        let (first, second, weld) = match joint {
            Joint::Hinge { first, second } => (first, second, false),
            Joint::Weld { first, second } => (first, second, true),
            other => return Err(none(&format!("{other:?}"))),
        };
        let of = |at: &Place| Ok::<_, String>([at.beam, node("a joint", at)?]);
        description.joints.push(Joined { first: of(first)?, second: of(second)?, weld });
    }
    for support in &model.supports {
        let by = support.displacement;
        let by = [by.x, by.y, by.angle];
        let moved = match (&support.law, &times) {
            _ if by == [0.0; 3] => None,
            (Some(law), Some(times)) => {
                Some(values(law, times).into_iter().map(|factor| by.map(|v| factor * v)).collect())
            }
            _ => return Err(none("a support that is moved in statics")),
        };
        if moved.is_some() && matches!(description.analysis, Question::Dynamic { spectral_radius: 1.0, .. }) {
            return Err(none(
                "a support that is moved, by the trapezoidal rule, which holds velocities there",
            ));
        }
        let rotation = match support.fix.rotation {
            FixedRotation::Free => "free",
            FixedRotation::Angle => "angle",
            FixedRotation::Gradient => "gradient",
        };
        let (beam, node) = (support.at.beam, node("a support", &support.at)?);
        let (x, y) = (support.fix.x, support.fix.y);
        description.supports.push(Support { beam, node, x, y, rotation, moved });
    }
    for part in &model.parts {
        let any: &dyn Any = part.as_ref();
        let factors = |law: &Option<Law>| match (law, &times) {
            (None, _) => Ok(None),
            (Some(law), Some(times)) => Ok(Some(values(law, times))),
            (Some(_), None) => Err(none("a load that follows time in statics")),
        };
        if let Some(damping) = any.downcast_ref::<BeamDamping>() {
            add_damping(&mut description.beams, damping)?;
        } else if let Some(effect::Force { at, value, follower, law }) = any.downcast_ref() {
            let (beam, node, factors) = (at.beam, node("a force", at)?, factors(law)?);
            description.forces.push(Force { beam, node, value: *value, follower: *follower, factors });
        } else if let Some(effect::Moment { at, value, law }) = any.downcast_ref() {
            let (beam, node, factors) = (at.beam, node("a moment", at)?, factors(law)?);
            description.moments.push(Moment { beam, node, value: *value, factors });
        } else if let Some(Gravity { acceleration: [x, y], law: None }) = any.downcast_ref() {
            description.gravity[0] += x;
            description.gravity[1] += y;
        } else {
            return Err(none(&format!("{part:?}")));
        }
    }
    for given in &model.initial_velocities {
        let beam = description.beams.get_mut(given.beam).ok_or_else(|| none("a velocity of no beam"))?;
        let nodes = beam.nodes.iter().zip(bases[given.beam].nodes());
        for (rate, (position, s)) in beam.velocities.iter_mut().zip(nodes) {
            rate.iter_mut().zip(given.at(*s, *position, beam.tangent)).for_each(|(sum, v)| *sum += v);
        }
    }
    for probe in &model.probes {
        let (beam, node) = (probe.at.beam, node(&format!("the probe `{}`", probe.name), &probe.at)?);
        description.probes.push(Probe { name: probe.name.clone(), beam, node });
    }
    Ok(description)
}

/// When a motion starts and when every step of it ends.
fn times(analysis: &Question) -> Option<Vec<f64>> {
    match analysis {
        Question::Dynamic { steps, step, .. } => Some((0..=*steps).map(|k| k as f64 * step).collect()),
        Question::Static { .. } | Question::Modal { .. } => None,
    }
}

fn values(law: &Law, times: &[f64]) -> Factors {
    times.iter().map(|t| law.at(*t)[0]).collect()
}

fn add_damping(beams: &mut [Cable], damping: &BeamDamping) -> Result<(), String> {
    if damping.mass_proportional.is_some() {
        return Err(none("damping in proportion to mass"));
    }
    let beam = beams.get_mut(damping.beam).ok_or_else(|| none("the damping of no beam"))?;
    let constant = |quantity: &Option<Along>| match quantity {
        None => Ok(0.0),
        Some(along) => along.constant().ok_or_else(|| none("damping that varies along a beam")),
    };
    beam.axial_damping += constant(&damping.strain)? * beam.axial_stiffness;
    beam.bending_damping += constant(&damping.curvature)? * beam.bending_stiffness;
    Ok(())
}

fn none(what: &str) -> String {
    format!("no counterpart for {what}")
}

/// The nodes and shape functions of a beam that can be said.
pub(crate) fn basis(beam: &Beam) -> Result<Basis, String> {
    if !matches!(beam.discretization, Discretization::Ancf { .. }) {
        return Err(none(&format!("the discretisation of beam `{}`: {}", beam.name, beam.discretization)));
    }
    let length = Curve::new(&beam.centreline).map_err(|e| e.to_string())?.length();
    Basis::new(&beam.discretization, length).map_err(|e| e.to_string())
}

fn cable(beam: &Beam, basis: &Basis) -> Result<Cable, String> {
    let of_beam = |what: &str| none(&format!("{what} of beam `{}`", beam.name));
    let Centreline::Line { start, end } = beam.centreline else {
        return Err(of_beam("the curved centreline"));
    };
    if beam.strain != StrainMeasure::Engineering {
        return Err(of_beam(&format!("the strain measure `{}` (only `engineering`)", beam.strain)));
    }
    let points = [beam.gauss_points.stretch, beam.gauss_points.bend];
    if beam.gauss_points.lobatto || ![[5, 3], [4, 2]].contains(&points) {
        return Err(of_beam(&format!("the Gauss points {}/{} (only 5/3 and 4/2)", points[0], points[1])));
    }
    let constant = |quantity: &Option<Along>| match quantity {
        None => Ok(0.0),
        Some(along) => along.constant().ok_or_else(|| of_beam("a section that varies along it")),
    };
    let length = basis.length();
    let tangent = [(end[0] - start[0]) / length, (end[1] - start[1]) / length];
    Ok(Cable {
        nodes: basis.nodes().iter().map(|s| [start[0] + s * tangent[0], start[1] + s * tangent[1]]).collect(),
        tangent,
        velocities: vec![[0.0; 4]; basis.nodes().len()],
        lengths: basis.nodes().windows(2).map(|ends| ends[1] - ends[0]).collect(),
        axial_stiffness: constant(&beam.section.axial_stiffness)?,
        bending_stiffness: constant(&beam.section.bending_stiffness)?,
        mass_per_length: constant(&beam.section.mass_per_length)?,
        axial_damping: 0.0,
        bending_damping: 0.0,
        gauss_points: points,
    })
}

fn question(analysis: &Analysis) -> Result<Question, String> {
    match analysis {
        Analysis::Static(settings) if settings.arc_length.is_some() => Err(none("arc-length continuation")),
        Analysis::Static(settings) => Ok(Question::Static { steps: settings.steps.unwrap_or(LOAD_STEPS) }),
        Analysis::Dynamic(settings) => {
            let Integrator::GeneralizedAlpha { step: StepControl::Fixed(step), spectral_radius, .. } =
                settings.integrator
            else {
                return Err(none(&format!("the integrator {}", settings.integrator)));
            };
            if !settings.events.is_empty() {
                return Err(none("an event"));
            }
            let whole = |time: f64, name: &str| {
                let steps = (time / step).round();
                let even = steps >= 1.0 && (steps * step - time).abs() <= 1e-9 * time;
                even.then_some(steps as usize).ok_or_else(|| {
                    none(&format!("{name} = {time} s, which is no multiple of the step {step} s"))
                })
            };
            let (steps, every) =
                (whole(settings.duration, "duration")?, whole(settings.output_every, "output_every")?);
            if steps % every != 0 {
                return Err(none("a duration that is no multiple of output_every"));
            }
            Ok(Question::Dynamic { steps, step, every, spectral_radius })
        }
        Analysis::Modal(Modal { count, about: About::Reference }) => Ok(Question::Modal { count: *count }),
        Analysis::Modal(_) => Err(none("vibrations about an equilibrium")),
        Analysis::Buckling(_) => Err(none("a buckling analysis")),
        other => Err(none(&format!("{other:?}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
[beam.b]
start = [0.0, 0.0]
end = [0.0, 2.0]
axial_stiffness = 1e4
bending_stiffness = 2.0
strain = "engineering"
basis.ancf = { elements = 4, gauss_points = { stretch = 5, bend = 3 } }
[[support]]
beam = "b"
at = "start"
fix = ["x", "y", "angle"]
[[effect.force]]
beam = "b"
at = "end"
value = [1.0, 0.0]
[[probe]]
name = "tip"
beam = "b"
at = "end"
[analysis.static]
"#;

    fn with(old: &str, new: &str) -> Result<Description, String> {
        assert!(SCENE.contains(old), "{old}");
        let scene = ancf::scene::parse("scene.toml", &SCENE.replace(old, new)).expect("a legal scene");
        describe(scene.model(), scene.analysis())
    }

    #[test]
    fn a_scene_keeps_its_numbers() {
        let description = with("", "").expect("a counterpart");
        let beam = &description.beams[0];
        assert_eq!(beam.nodes, [[0.0, 0.0], [0.0, 0.5], [0.0, 1.0], [0.0, 1.5], [0.0, 2.0]]);
        assert_eq!((beam.tangent, &beam.lengths[..]), ([0.0, 1.0], &[0.5; 4][..]));
        assert_eq!((description.forces[0].node, description.probes[0].node), (4, 4));
    }

    const MOTION: &str = "[analysis.dynamic]\nduration = 0.3\noutput_every = 0.1\n\
                          generalized_alpha = { step = 0.1, spectral_radius = 0.9 }";
    const TURNED: &str = "fix = [\"x\", \"y\", \"angle\"]\n\
                          move = { angle = 2.0, in_time = { ramp = { duration = 0.2 } } }";

    /// A motion whose scene has more lines before its analysis.
    fn moving(more: &str) -> Result<Description, String> {
        let scene = SCENE
            .replace("bending_stiffness = 2.0", "bending_stiffness = 2.0\nmass_per_length = 1.0")
            .replace("[analysis.static]", &format!("{more}\n{MOTION}"));
        let scene = ancf::scene::parse("scene.toml", &scene).expect("a legal scene");
        describe(scene.model(), scene.analysis())
    }

    /// Factors that are not those at the ends of the steps, or are lost, would move another code's
    /// beam differently.
    #[test]
    fn laws_of_time_are_said_by_their_values_at_the_ends_of_the_steps() {
        let moment = "[[effect.moment]]\nbeam = \"b\"\nat = \"end\"\nvalue = 3.0\n\
                      in_time = { ramp = { duration = 0.2 } }";
        let description = moving(moment).expect("a counterpart");
        assert_eq!(description.moments[0].factors, Some(vec![0.0, 0.5, 1.0, 1.0]));
        assert_eq!((&description.forces[0].factors, &description.supports[0].moved), (&None, &None));
        let scene = SCENE
            .replace("bending_stiffness = 2.0", "bending_stiffness = 2.0\nmass_per_length = 1.0")
            .replace("fix = [\"x\", \"y\", \"angle\"]", TURNED)
            .replace("[analysis.static]", MOTION);
        let turned = |scene: &str| {
            let scene = ancf::scene::parse("scene.toml", scene).expect("a legal scene");
            describe(scene.model(), scene.analysis())
        };
        let moved = turned(&scene).expect("a counterpart").supports.remove(0).moved;
        assert_eq!(moved.expect("it moves").iter().map(|by| by[2]).collect::<Vec<_>>(), [0.0, 1.0, 2.0, 2.0]);
        let error = turned(&scene.replace("= 0.9 }", "= 1.0 }")).expect_err("held by its velocity there");
        assert!(
            error.starts_with("no counterpart for a support that is moved, by the trapezoidal rule"),
            "{error}"
        );
    }

    /// A joint that is lost or joins other nodes leaves another structure.
    #[test]
    fn joints_are_said_by_the_nodes_that_they_join() {
        let second = SCENE.replace(
            "[beam.b]\nstart = [0.0, 0.0]\nend = [0.0, 2.0]",
            "[beam.c]\nstart = [0.0, 2.0]\nend = [1.0, 2.0]",
        );
        let beam = second.split("[[support]]").next().expect("a beam");
        let joint = |kind: &str, at: &str| {
            format!(
                "{beam}[[joint]]\ntype = \"{kind}\"\nfirst = {{ beam = \"b\", at = {at} }}\n\
                 second = {{ beam = \"c\", at = \"start\" }}\n[[support]]\nbeam = \"c\"\nat = \"end\"\nfix = [\"y\"]\n[[support]]"
            )
        };
        for (kind, weld) in [("weld", true), ("hinge", false)] {
            let description = with("[[support]]", &joint(kind, "\"end\"")).expect("a counterpart");
            assert_eq!(description.joints, [Joined { first: [0, 4], second: [1, 0], weld }]);
        }
        let slider = "[[joint]]\ntype = \"slider\"\nfirst = { beam = \"b\", at = \"end\" }\nalong = [1, 0]\n[[support]]";
        let error = with("[[support]]", slider).expect_err("no word");
        assert!(error.starts_with("no counterpart for Slider"), "{error}");
    }

    /// Another code takes the coefficients themselves, c = η EA and η EI; without them its beam
    /// would swing on.
    #[test]
    fn damping_is_said_in_newton_seconds() {
        let damping = "[[effect.damping]]\nbeam = \"b\"\nstrain = 0.5\ncurvature = 0.25";
        let beam = &moving(damping).expect("a counterpart").beams[0];
        assert_eq!((beam.axial_damping, beam.bending_damping), (5e3, 0.5));
        let error = moving("[[effect.damping]]\nbeam = \"b\"\nmass_proportional = 1.0").expect_err("no word");
        assert_eq!(error, "no counterpart for damping in proportion to mass");
    }

    #[test]
    fn what_cannot_be_said_is_named() {
        let cases = [
            ("\"engineering\"", "\"green\"", "the strain measure `green` (only `engineering`) of beam `b`"),
            ("stretch = 5", "stretch = 6", "the Gauss points 6/3 (only 5/3 and 4/2) of beam `b`"),
            (
                "at = \"end\"\n[analysis",
                "at = 0.6\n[analysis",
                "the probe `tip` at s = 0.6 m, where no node is",
            ),
            ("[analysis.static]", "[analysis.buckling]\ncount = 1", "a buckling analysis"),
        ];
        for (old, new, message) in cases {
            let error = with(old, new).expect_err("nothing like it there");
            assert_eq!(error, format!("no counterpart for {message}"));
        }
    }
}
