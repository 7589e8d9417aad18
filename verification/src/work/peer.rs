//! Other codes, timed: the same description as in the comparison of numbers, with settings of their
//! own, and what they find in the form in which ours leaves it, so that one norm judges all.

use std::f64::consts::TAU;

use ancf::model::{Analysis, Model};
use ancf::results::{
    ProbeSample, ProbeSeries, Results, Run, Shape, Statistics, Trajectory, Vibration, Vibrations,
};
use ancf::system::View;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::problem::Code;
use crate::Failure;
use crate::bridge::Script;
use crate::peers::Track;
use crate::peers::describe::{Description, basis, describe};

/// Points at which shapes are sampled, as ours are.
const SHAPE_POINTS: usize = 201;

/// What asks the other codes.
static SCRIPTS: [(Code, Script); 5] = [
    (Code::Exudyn, Script::new("exudyn_work")),
    (Code::ScikitFem, Script::new("scikit_fem_work")),
    (Code::OpenSees, Script::new("opensees_work")),
    (Code::PyElastica, Script::new("elastica_work")),
    (Code::MuJoCo, Script::new("mujoco_work")),
];

#[derive(Serialize)]
struct Question<'a> {
    description: Description,
    settings: &'a IndexMap<String, String>,
    repeat: usize,
}

/// The answer of another code; fields that it does not know or was not asked for are empty.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Answer {
    seconds: Vec<f64>,
    build: Vec<f64>,
    steps: usize,
    newton_iterations: usize,
    jacobians: usize,
    rejected_steps: usize,
    parameter: Vec<f64>,
    probes: Vec<Track>,
    /// Per beam and node of the last state: \[x, y, x', y'\].
    nodes: Vec<Vec<[f64; 4]>>,
    frequencies: Vec<f64>,
}

/// Times of the repetitions \[s\], and the result of the last.
pub struct Timed {
    /// Times of the solution alone.
    pub seconds: Vec<f64>,
    /// Times of the preparation; empty where they are not known.
    pub build: Vec<f64>,
    /// The results.
    pub results: Results,
}

/// Solves a model `repeat` times.
///
/// # Errors
/// What of the scene has no counterpart, a Python that cannot be had, and what the other code
/// raises.
pub fn solve(
    code: Code,
    (model, analysis): (&Model, &Analysis),
    settings: &IndexMap<String, String>,
    repeat: usize,
) -> Result<Timed, Failure> {
    let script = SCRIPTS.iter().find(|(known, _)| *known == code);
    let (_, script) = script.ok_or_else(|| format!("there is no script for {}", code.name()))?;
    let description = describe(model, analysis)?;
    let answer: Answer = script.ask(&Question { description, settings, repeat })?;
    let results = results(model, &answer)?;
    Ok(Timed { seconds: answer.seconds, build: answer.build, results })
}

/// The results in the form of ours: records of the probes, the last shapes, frequencies.
fn results(model: &Model, answer: &Answer) -> Result<Results, Failure> {
    let samples = |track: &Track| {
        let places = track.x.iter().zip(&track.y);
        places.map(|(&x, &y)| ProbeSample { x, y, ..ProbeSample::default() }).collect()
    };
    let statistics = Statistics {
        steps: answer.steps,
        rejected_steps: answer.rejected_steps,
        newton_iterations: answer.newton_iterations,
        tangent_evaluations: answer.jacobians,
        factorizations: answer.jacobians,
        ..Statistics::default()
    };
    let states = Trajectory {
        run: Run { complete: true, statistics, ..Run::default() },
        parameter: answer.parameter.clone(),
        probes: answer
            .probes
            .iter()
            .map(|track| ProbeSeries { name: track.name.clone(), samples: samples(track) })
            .collect(),
        last: model
            .beams
            .iter()
            .zip(&answer.nodes)
            .map(|(beam, nodes)| {
                let basis = basis(beam)?;
                let evenly = |k: usize| basis.length() * k as f64 / (SHAPE_POINTS - 1) as f64;
                let view = View::points(&basis, 0, &(0..SHAPE_POINTS).map(evenly).collect::<Vec<_>>())?;
                let mut shape = Shape { beam: beam.name.clone(), s: view.s().to_vec(), ..Shape::default() };
                for fields in view.all(nodes.as_flattened()) {
                    shape.x.push(fields.position[0]);
                    shape.y.push(fields.position[1]);
                    let (angle, before) = (fields.angle(), shape.angle.last().copied().unwrap_or(0.0));
                    shape.angle.push(angle + TAU * ((before - angle) / TAU).round());
                    shape.strain.push(fields.strain(beam.strain));
                    shape.curvature.push(fields.curvature());
                }
                shape.nodes = nodes.iter().map(|[x, y, ..]| [*x, *y]).collect();
                Ok(shape)
            })
            .collect::<Result<_, Failure>>()?,
        ..Trajectory::default()
    };
    if answer.frequencies.is_empty() {
        return Ok(Results::Trajectory(states));
    }
    let vibration = |&frequency: &f64| Vibration { frequency, round_off: 0.0, shape: Vec::new() };
    let modes = answer.frequencies.iter().map(vibration).collect();
    Ok(Results::Vibrations(Vibrations { equilibrium: states, modes }))
}
