//! The quantities that a check compares: paths of words that pick numbers out of a finished run.
//!
//! | quantity | what it is | a series over |
//! |---|---|---|
//! | `probe.<name>.x` (`y`, `angle`, `curvature`, `strain`, `vx`, `vy`) | what a probe saw | time or load factor |
//! | `energy.stretch` (`bend`, `stored`, `kinetic`, `potential`, `work`, `lost`, `total`) | energies \[J\] | time or load factor |
//! | `reaction.<name>.x` (`y`, `moment`) | forces of a support or joint, where `output.reactions` asks for them | time or load factor |
//! | `energy.drift` | max abs(total − initial) / max kinetic | – |
//! | `parameter` | load factor or time \[s\] itself | time or load factor |
//! | `shape.x` (`s`, `y`, `angle`, `strain`, `curvature`, `axial_force`, `shear_force`, `bending_moment`, `stress_bottom`, `stress_top`), `shape.<beam>.x` | the last state | s \[m\] |
//! | `frequency.<k>`, `load-factor.<k>` | k-th from 1, \[Hz\] or – | – |
//! | `statistics.<name>` | counts, as in `summary.json`; `most_iterations` of an accepted step | – |
//! | `stage.<name>.<quantity>` | the quantity in a stage; without it that of the last stage | as there |
//! | `interpolated.stretch` (`bend`) | ½∫EA ε² ds, ½∫EI κ² ds of exact nodal values \[J\] | – |
//! | `interpolated.distance` | largest distance of 201 even places of the interpolated curve from the exact one \[m\] | – |
//! | `interpolated.x` (`s`, `y`, `curvature`, `strain`) | the interpolated curve | s \[m\] |

use ancf::results::{Energy, ProbeSample, Results, Shape, Trajectory};
use ancf::system::Reaction;

use crate::case::Pick;
use crate::interpolation::Interpolation;

/// What is said where stresses are not known.
const UNSTRESSED: &str = "the section of this beam does not tell its shape";

/// The results of a run.
#[derive(Clone, Debug)]
pub enum Result {
    /// The results of a computation.
    Solved(Box<Results>),
    /// The results of all stages, by their names.
    Staged(Vec<(String, Results)>),
    /// An interpolation of exact nodal values.
    Interpolated(Box<Interpolation>),
}

/// The values of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// One number.
    Number(f64),
    /// A number for every abscissa, recorded along a run.
    Series {
        /// Time or load factor.
        abscissa: Vec<f64>,
        /// The values there.
        values: Vec<f64>,
    },
    /// A number for every abscissa, along a beam.
    Shape {
        /// Arc length \[m\].
        abscissa: Vec<f64>,
        /// The values there.
        values: Vec<f64>,
    },
}

impl Values {
    /// One number, for a series the one that `pick` selects. `over` replaces the abscissa in the
    /// search for a maximum.
    pub fn number(&self, pick: Pick, over: Option<&[f64]>) -> std::result::Result<f64, String> {
        match self {
            Self::Number(v) => Ok(*v),
            Self::Shape { .. } => Err("this is a curve over s: name the column of s with `along`".to_owned()),
            Self::Series { abscissa, values } => match pick {
                Pick::Last => values.last().copied().ok_or_else(|| "the run recorded nothing".to_owned()),
                Pick::Largest => values
                    .iter()
                    .map(|v| v.abs())
                    .reduce(f64::max)
                    .ok_or_else(|| "the run recorded nothing".to_owned()),
                Pick::FirstMaximum => first_maximum(over.unwrap_or(abscissa), values),
            },
        }
    }

    /// Abscissa and values of a curve.
    pub fn curve(&self) -> Option<(&[f64], &[f64])> {
        match self {
            Self::Number(_) => None,
            Self::Series { abscissa, values } | Self::Shape { abscissa, values } => Some((abscissa, values)),
        }
    }
}

/// The top of the parabola through the first record that exceeds both its neighbours, and through
/// these.
fn first_maximum(abscissa: &[f64], values: &[f64]) -> std::result::Result<f64, String> {
    let top = values.windows(3).position(|w| matches!(w, [a, b, c] if b >= a && b > c)).ok_or_else(|| {
        "the series rises or falls throughout: it has no maximum between its ends".to_owned()
    })?;
    let (Some(&[x0, x1, x2]), Some(&[y0, y1, y2])) = (
        abscissa.get(top..top + 3).and_then(|w| w.first_chunk()),
        values.get(top..top + 3).and_then(|w| w.first_chunk()),
    ) else {
        return Err("the abscissa is shorter than the series".to_owned());
    };
    // Newton's form: y1 + d1 (x − x1) + d2 (x − x1)(x − x0)
    let d1 = (y1 - y0) / (x1 - x0);
    let d2 = ((y2 - y1) / (x2 - x1) - d1) / (x2 - x0);
    let x = ((x0 + x1) - d1 / d2) / 2.0;
    let y = y0 + d1 * (x - x0) + d2 * (x - x0) * (x - x1);
    if y.is_finite() { Ok(y) } else { Err("three records around the maximum coincide".to_owned()) }
}

/// The values of the quantity `path`.
pub fn values(path: &str, result: &Result) -> std::result::Result<Values, String> {
    let words: Vec<&str> = path.split('.').collect();
    match result {
        Result::Solved(results) => solved(&words, results),
        Result::Staged(stages) => staged(&words, stages),
        Result::Interpolated(interpolation) => interpolated(&words, interpolation),
    }
    .map_err(|message| format!("`{path}`: {message}"))
}

fn staged(words: &[&str], stages: &[(String, Results)]) -> std::result::Result<Values, String> {
    if let ["stage", name, rest @ ..] = words {
        let found = stages.iter().find(|(stage, _)| stage == name);
        let names = || crate::case::list(stages.iter().map(|(stage, _)| stage));
        let (_, results) = found.ok_or_else(|| format!("no such stage; there are {}", names()))?;
        return solved(rest, results);
    }
    let (_, last) = stages.last().ok_or("no stage was run")?;
    solved(words, last)
}

fn solved(words: &[&str], results: &Results) -> std::result::Result<Values, String> {
    let t = results.states();
    let series = |values: Vec<f64>| Values::Series { abscissa: t.parameter.clone(), values };
    match words {
        ["probe", name, field] => {
            let probe = t.probes.iter().find(|p| p.name == *name).ok_or_else(|| {
                format!("no such probe; there are {}", crate::case::list(t.probes.iter().map(|p| &p.name)))
            })?;
            Ok(series(probe.samples.iter().map(|s| sample(s, field)).collect::<std::result::Result<_, _>>()?))
        }
        ["reaction", name, field] => {
            let reaction = t.reactions.iter().find(|r| r.name == *name).ok_or_else(|| {
                format!(
                    "no such reaction; there are {}",
                    crate::case::list(t.reactions.iter().map(|r| &r.name))
                )
            })?;
            Ok(series(
                reaction.samples.iter().map(|s| force(s, field)).collect::<std::result::Result<_, _>>()?,
            ))
        }
        ["energy", "drift"] => {
            let initial = t.energy.first().map_or(0.0, Energy::total);
            let drift = t.energy.iter().map(|e| (e.total() - initial).abs()).fold(0.0, f64::max);
            Ok(Values::Number(drift / t.energy.iter().map(|e| e.kinetic).fold(0.0, f64::max)))
        }
        ["energy", field] => {
            Ok(series(t.energy.iter().map(|e| energy(e, field)).collect::<std::result::Result<_, _>>()?))
        }
        ["parameter"] => Ok(series(t.parameter.clone())),
        ["shape", field] => match t.last.as_slice() {
            [only] => shape(only, field),
            shapes => Err(format!("there are {} beams; name one: shape.<beam>.{field}", shapes.len())),
        },
        ["shape", beam, field] => {
            let found = t.last.iter().find(|s| s.beam == *beam).ok_or_else(|| {
                format!("no such beam; there are {}", crate::case::list(t.last.iter().map(|s| &s.beam)))
            })?;
            shape(found, field)
        }
        ["frequency", k] => match results {
            Results::Vibrations(vibrations) => nth(&vibrations.frequencies(), k),
            _ => Err("frequencies are those of a modal analysis".to_owned()),
        },
        ["load-factor", k] => match results {
            Results::CriticalLoads(loads) => nth(&loads.load_factors(), k),
            _ => Err("load factors are those of a buckling analysis".to_owned()),
        },
        ["statistics", name] => statistic(t, name),
        _ => Err("no such quantity".to_owned()),
    }
}

fn nth(list: &[f64], k: &str) -> std::result::Result<Values, String> {
    let index = k.parse::<usize>().ok().filter(|&k| k > 0).ok_or("a number from 1 is expected")?;
    let value = list.get(index - 1).ok_or_else(|| format!("the run found {}", list.len()))?;
    Ok(Values::Number(*value))
}

fn sample(s: &ProbeSample, field: &str) -> std::result::Result<f64, String> {
    let still = || format!("`{field}` is recorded in dynamics only");
    match field {
        "x" => Ok(s.x),
        "y" => Ok(s.y),
        "angle" => Ok(s.angle),
        "curvature" => Ok(s.curvature),
        "strain" => Ok(s.strain),
        "vx" => s.vx.ok_or_else(still),
        "vy" => s.vy.ok_or_else(still),
        _ => Err("a probe has x, y, angle, curvature, strain, vx, vy".to_owned()),
    }
}

fn force(reaction: &Reaction, field: &str) -> std::result::Result<f64, String> {
    match field {
        "x" => Ok(reaction.fx),
        "y" => Ok(reaction.fy),
        "moment" => Ok(reaction.moment),
        _ => Err("a reaction has x, y, moment".to_owned()),
    }
}

fn energy(e: &Energy, field: &str) -> std::result::Result<f64, String> {
    match field {
        "stretch" => Ok(e.stretch),
        "bend" => Ok(e.bend),
        "stored" => Ok(e.stored),
        "kinetic" => Ok(e.kinetic),
        "potential" => Ok(e.potential),
        "work" => Ok(e.work),
        "lost" => Ok(e.lost),
        "total" => Ok(e.total()),
        _ => Err("there are stretch, bend, stored, kinetic, potential, work, lost, total, drift".to_owned()),
    }
}

fn shape(shape: &Shape, field: &str) -> std::result::Result<Values, String> {
    let values = match field {
        "s" => &shape.s,
        "x" => &shape.x,
        "y" => &shape.y,
        "angle" => &shape.angle,
        "strain" => &shape.strain,
        "curvature" => &shape.curvature,
        "axial_force" => &shape.axial_force,
        "shear_force" => &shape.shear_force,
        "bending_moment" => &shape.bending_moment,
        "stress_bottom" => &shape.stress.first().ok_or(UNSTRESSED)?.bottom,
        "stress_top" => &shape.stress.last().ok_or(UNSTRESSED)?.top,
        _ => {
            return Err(
                "a shape has s, x, y, angle, strain, curvature, axial_force, shear_force, bending_moment, stress_bottom, stress_top"
                    .to_owned(),
            );
        }
    };
    Ok(Values::Shape { abscissa: shape.s.clone(), values: values.clone() })
}

fn statistic(t: &Trajectory, name: &str) -> std::result::Result<Values, String> {
    let s = &t.run.statistics;
    let count = match name {
        "steps" => s.steps,
        "rejected_steps" => s.rejected_steps,
        "load_steps" => s.load_steps,
        "newton_iterations" => s.newton_iterations,
        "residual_evaluations" => s.residual_evaluations,
        "tangent_evaluations" => s.tangent_evaluations,
        "factorizations" => s.factorizations,
        "degrees_of_freedom" => t.run.degrees_of_freedom,
        "most_iterations" => {
            t.history.iter().filter(|s| s.accepted).map(|s| s.increments.len()).max().unwrap_or(0)
        }
        _ => return Err("no such count; see `statistics` in summary.json".to_owned()),
    };
    Ok(Values::Number(count as f64))
}

fn interpolated(words: &[&str], i: &Interpolation) -> std::result::Result<Values, String> {
    let along = |values: &[f64]| Values::Shape { abscissa: i.s.clone(), values: values.to_vec() };
    match words {
        ["interpolated", "stretch"] => {
            i.stretch.map(Values::Number).ok_or_else(|| "the beam has no EA".to_owned())
        }
        ["interpolated", "bend"] => i.bend.map(Values::Number).ok_or_else(|| "the beam has no EI".to_owned()),
        ["interpolated", "distance"] => Ok(Values::Number(i.distance)),
        ["interpolated", "s"] => Ok(along(&i.s)),
        ["interpolated", "x"] => Ok(along(&i.x)),
        ["interpolated", "y"] => Ok(along(&i.y)),
        ["interpolated", "strain"] => Ok(along(&i.strain)),
        ["interpolated", "curvature"] => Ok(along(&i.curvature)),
        _ => Err("an interpolation has interpolated.{stretch, bend, distance, s, x, y, strain, curvature}"
            .to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_of_a_parabola_is_found_exactly_from_uneven_records() {
        let x = [0.0, 0.3, 0.8, 1.5, 2.0];
        let y: Vec<f64> = x.iter().map(|x| 7.0 - 3.0 * (x - 0.9) * (x - 0.9)).collect();
        let top = first_maximum(&x, &y).expect("a maximum");
        assert!((top - 7.0).abs() < 1e-12, "{top}");
        assert!(first_maximum(&x, &x).is_err());
    }
}
