//! Exudyn, timed: the same description as in the comparison of numbers, with settings of its own, and what it finds in the form in
//! which ours leaves it, so that one norm judges both.

use std::f64::consts::TAU;

use ancf::model::Model;
use ancf::scene::Scene;
use ancf::system::View;
use ancf::trajectory::{ProbeSample, ProbeSeries, Shape, Statistics, Trajectory};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::bridge::Script;
use crate::peers::Track;
use crate::peers::describe::{Description, basis, describe};

/// Points at which shapes are sampled, as ours are.
const SHAPE_POINTS: usize = 201;

#[derive(Serialize)]
struct Question<'a> {
    description: Description,
    settings: &'a IndexMap<String, String>,
    repeat: usize,
}

#[derive(Deserialize)]
struct Answer {
    seconds: Vec<f64>,
    steps: usize,
    newton_iterations: usize,
    jacobians: usize,
    rejected_steps: usize,
    parameter: Vec<f64>,
    probes: Vec<Track>,
    /// Per beam and node of the last state: \[x, y, x', y'\].
    nodes: Vec<Vec<[f64; 4]>>,
}

/// Solves a scene `repeat` times: seconds of each, and the result of the last.
///
/// # Errors
/// What of the scene has no counterpart, a Python that cannot be had, and what Exudyn raises.
pub fn solve(
    scene: &Scene,
    settings: &IndexMap<String, String>,
    repeat: usize,
) -> Result<(Vec<f64>, Trajectory), Failure> {
    static SCRIPT: Script = Script::new("exudyn_work");
    let description = describe(scene.model(), scene.analysis())?;
    let answer: Answer = SCRIPT.ask(&Question { description, settings, repeat })?;
    let trajectory = trajectory(scene.model(), &answer)?;
    Ok((answer.seconds, trajectory))
}

/// What Exudyn found, as ours would leave it: records of the probes, and the last shapes.
fn trajectory(model: &Model, answer: &Answer) -> Result<Trajectory, Failure> {
    let samples = |track: &Track| {
        let places = track.x.iter().zip(&track.y);
        places.map(|(&x, &y)| ProbeSample { x, y, ..ProbeSample::default() }).collect()
    };
    Ok(Trajectory {
        complete: true,
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
        statistics: Statistics {
            steps: answer.steps,
            rejected_steps: answer.rejected_steps,
            newton_iterations: answer.newton_iterations,
            tangent_evaluations: answer.jacobians,
            factorizations: answer.jacobians,
            ..Statistics::default()
        },
        ..Trajectory::default()
    })
}
