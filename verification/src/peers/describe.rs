//! A model in plain words: nodes, numbers, supports and loads at nodes. The one translation to other codes.
//!
//! Whatever these words cannot say is an error that names it; nothing is left out silently.

use ancf::basis::Basis;
use ancf::centreline::Curve;
use ancf::model::{
    About, Analysis, Beam, Centreline, Discretization, FixedRotation, Integrator, Load, Model, Place,
    StepControl, StrainMeasure,
};
use serde::Serialize;

/// Parts of the load in statics where the scene leaves it to the solver.
const LOAD_STEPS: usize = 20;

/// What another code is asked to solve.
#[derive(Debug, Serialize)]
pub struct Description {
    beams: Vec<Cable>,
    supports: Vec<Support>,
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
    gauss_points: [usize; 2],
}

#[derive(Debug, Serialize)]
struct Support {
    beam: usize,
    node: usize,
    x: bool,
    y: bool,
    rotation: &'static str,
}

#[derive(Debug, Serialize)]
struct Force {
    beam: usize,
    node: usize,
    value: [f64; 2],
    follower: bool,
}

#[derive(Debug, Serialize)]
struct Moment {
    beam: usize,
    node: usize,
    value: f64,
}

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
        forces: Vec::new(),
        moments: Vec::new(),
        gravity: [0.0; 2],
        probes: Vec::new(),
        analysis: question(analysis)?,
    };
    if let Some(joint) = model.joints.first() {
        return Err(none(&format!("{joint:?}")));
    }
    if let Some(part) = model.parts.first() {
        return Err(none(&format!("{part:?}")));
    }
    for support in &model.supports {
        let moved = support.displacement;
        if [moved.x, moved.y, moved.angle] != [0.0; 3] {
            return Err(none("a support that is moved"));
        }
        let rotation = match support.fix.rotation {
            FixedRotation::Free => "free",
            FixedRotation::Angle => "angle",
            FixedRotation::Gradient => "gradient",
        };
        let (beam, node) = (support.at.beam, node("a support", &support.at)?);
        description.supports.push(Support { beam, node, x: support.fix.x, y: support.fix.y, rotation });
    }
    for load in &model.loads {
        match load {
            Load::Force { at, value, follower } => {
                let (beam, node) = (at.beam, node("a force", at)?);
                description.forces.push(Force { beam, node, value: *value, follower: *follower });
            }
            Load::Moment { at, value } => {
                let (beam, node) = (at.beam, node("a moment", at)?);
                description.moments.push(Moment { beam, node, value: *value });
            }
            Load::Gravity { acceleration: [x, y] } => {
                description.gravity[0] += x;
                description.gravity[1] += y;
            }
            Load::DistributedForce { .. } => return Err(none("a distributed force")),
            Load::InTime { .. } => return Err(none("a load that follows time")),
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
    let length = basis.length();
    let tangent = [(end[0] - start[0]) / length, (end[1] - start[1]) / length];
    Ok(Cable {
        nodes: basis.nodes().iter().map(|s| [start[0] + s * tangent[0], start[1] + s * tangent[1]]).collect(),
        tangent,
        velocities: vec![[0.0; 4]; basis.nodes().len()],
        lengths: basis.nodes().windows(2).map(|ends| ends[1] - ends[0]).collect(),
        axial_stiffness: beam.section.axial_stiffness.unwrap_or(0.0),
        bending_stiffness: beam.section.bending_stiffness.unwrap_or(0.0),
        mass_per_length: beam.section.mass_per_length.unwrap_or(0.0),
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
        Analysis::Modal { count, about: About::Reference } => Ok(Question::Modal { count: *count }),
        Analysis::Modal { .. } => Err(none("vibrations about an equilibrium")),
        Analysis::Buckling { .. } => Err(none("a buckling analysis")),
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
