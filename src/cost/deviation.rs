//! How far one run is from another.

use serde::Serialize;

use crate::model::{Analysis, Model};
use crate::output::Summary;
use crate::trajectory::{AnalysisKind, Shape, Trajectory};

/// Records belong together when their times or load factors differ by less, relative to the last
/// one.
const SAME: f64 = 1e-9;

/// Errors of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Deviation {
    /// What the target refers to. Statics and motion: largest distance of a probe from its place in
    /// the reference, over probes and common records, in lengths of the probe's beam. Modal
    /// analysis and buckling: largest relative error of a frequency or load factor.
    pub error: f64,
    /// Root mean square error of the curvature along all beams in the last state, relative to the
    /// largest curvature there; `None` where nothing bends or there is no state.
    pub curvature: Option<f64>,
    /// Statics: relative error of the strain energy in the last state. Motion: max |total −
    /// initial| / max kinetic, which needs no reference.
    pub energy: Option<f64>,
}

impl Deviation {
    /// What [`Deviation::error`] is for this analysis, with its unit.
    pub fn name(analysis: AnalysisKind) -> &'static str {
        match analysis {
            AnalysisKind::Static | AnalysisKind::Dynamic => "position error [beam lengths]",
            AnalysisKind::Modal => "relative error of frequencies",
            AnalysisKind::Buckling => "relative error of load factors",
        }
    }

    /// The deviation of `run` from `reference`, both of `model` with this `analysis`.
    ///
    /// # Errors
    /// In words, where they cannot be compared.
    pub(super) fn between(
        model: &Model,
        analysis: &Analysis,
        run: &Trajectory,
        reference: &Trajectory,
    ) -> Result<Self, String> {
        let error = match analysis {
            Analysis::Modal { .. } => values(&run.frequencies, &reference.frequencies, "frequencies")?,
            Analysis::Buckling { .. } => values(&run.load_factors, &reference.load_factors, "load factors")?,
            Analysis::Static(settings) if settings.arc_length.is_some() => {
                let last = |t: &Trajectory| t.parameter.len().checked_sub(1);
                let ends = last(run).zip(last(reference)).ok_or("no record")?;
                positions(model, run, reference, &[ends])
            }
            Analysis::Static(_) | Analysis::Dynamic(_) => {
                positions(model, run, reference, &common(&run.parameter, &reference.parameter)?)
            }
        };
        if !error.is_finite() {
            return Err("its error is not a number".into());
        }
        let energy = match analysis {
            Analysis::Static(_) => strain_energy(run).zip(strain_energy(reference)).and_then(|(u, exact)| {
                let error = ((u - exact) / exact).abs();
                error.is_finite().then_some(error)
            }),
            Analysis::Dynamic(_) => Summary::of(run).energy.and_then(|energy| energy.drift),
            Analysis::Modal { .. } | Analysis::Buckling { .. } => None,
        };
        let has_state = matches!(analysis, Analysis::Static(_) | Analysis::Dynamic(_));
        let curvature = if has_state { curvature(&run.last, &reference.last) } else { None };
        Ok(Self { error, curvature, energy })
    }
}

/// Pairs of records at the same time or load factor; both lists ascend. The last of the reference
/// must be among them.
fn common(run: &[f64], reference: &[f64]) -> Result<Vec<(usize, usize)>, String> {
    let last = *reference.last().ok_or("no record")?;
    let (mut pairs, mut i) = (Vec::new(), 0);
    for (j, &at) in reference.iter().enumerate() {
        while i < run.len() && run[i] < at - SAME * last.abs() {
            i += 1;
        }
        if run.get(i).is_some_and(|found| (found - at).abs() <= SAME * last.abs()) {
            pairs.push((i, j));
        }
    }
    // A motion that an event ends has its last record at a moment of its own.
    if pairs.is_empty() { Err("no record at the times or loads of the reference".into()) } else { Ok(pairs) }
}

fn positions(model: &Model, run: &Trajectory, reference: &Trajectory, pairs: &[(usize, usize)]) -> f64 {
    let mut largest = 0.0_f64;
    for ((probe, ours), theirs) in model.probes.iter().zip(&run.probes).zip(&reference.probes) {
        let length = reference.undeformed.get(probe.at.beam).and_then(|beam| beam.s.last());
        for &(i, j) in pairs {
            if let (Some(a), Some(b), Some(length)) = (ours.samples.get(i), theirs.samples.get(j), length) {
                let distance = (a.x - b.x).hypot(a.y - b.y) / length;
                // A maximum that keeps what is not a number.
                largest = if distance > largest || distance.is_nan() { distance } else { largest };
            }
        }
    }
    largest
}

fn values(run: &[f64], reference: &[f64], what: &str) -> Result<f64, String> {
    if run.len() != reference.len() || run.is_empty() {
        return Err(format!("{} {what} where the reference has {}", run.len(), reference.len()));
    }
    let largest = reference.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    // Motions that nothing resists have the frequency 0, or its round-off.
    let relative =
        |(a, b): (&f64, &f64)| (a - b).abs() / if b.abs() > SAME * largest { b.abs() } else { largest };
    Ok(run.iter().zip(reference).map(relative).fold(0.0, f64::max))
}

fn strain_energy(t: &Trajectory) -> Option<f64> {
    t.energy.last().map(|energy| energy.stretch + energy.bend)
}

fn curvature(run: &[Shape], reference: &[Shape]) -> Option<f64> {
    let (mut sum, mut count, mut largest, mut length) = (0.0, 0_usize, 0.0_f64, 0.0_f64);
    for (a, b) in run.iter().zip(reference) {
        for (a, b) in a.curvature.iter().zip(&b.curvature) {
            sum += (a - b) * (a - b);
            count += 1;
            largest = largest.max(b.abs());
        }
        length = b.s.last().map_or(length, |l| length.max(*l));
    }
    (largest * length > 1e-9).then(|| (sum / count as f64).sqrt() / largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_compared_where_both_have_one() {
        let pairs = common(&[0.0, 0.25, 0.5, 1.0], &[0.0, 0.5, 0.75, 1.0 + 1e-12]).unwrap();
        assert_eq!(pairs, [(0, 0), (2, 1), (3, 3)]);
        assert!(common(&[0.1], &[0.0, 0.2]).is_err());
    }

    #[test]
    fn eigenvalues_are_compared_one_by_one() {
        assert_eq!(values(&[0.0, 2.2, 4.0], &[1e-13, 2.0, 4.0], "f").unwrap(), 0.10000000000000009);
        assert!(values(&[1.0], &[1.0, 2.0], "f").is_err());
    }
}
