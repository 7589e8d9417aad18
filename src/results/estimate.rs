//! How wrong results are, estimated.

use super::{AnalysisKind, ProbeSample};
use serde::Serialize;
use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, LazyLock};

/// How wrong the results of a run are, as far as the run itself can tell.
#[derive(Clone, Debug, Default)]
pub struct ErrorEstimate {
    /// The largest errors that were wanted; `None` where nobody asked for any.
    pub wanted: Option<Errors>,
    /// Whether that is the usual accuracy, which is taken where a scene names no mesh and says
    /// nothing of errors.
    pub usual: bool,
    /// The largest errors of the results: what they most likely are, or where the accuracy is not met, at
    /// most; infinite where nothing is known of them.
    pub estimated: Errors,
    /// Whether no error is larger than wanted, as large as they may be.
    pub met: bool,
    /// Why not.
    pub reason: Option<String>,
    /// The time \[s\] or load factor until which the results are as good as was wanted, where they
    /// are not to the end.
    pub good_until: Option<f64>,
    /// Where the model itself errs, which no finer mesh mends.
    pub notes: Vec<String>,
    /// Per frequency or load factor its error, relative.
    pub eigenvalues: Vec<f64>,
    /// Per probe and record.
    pub probes: Vec<ProbeErrors>,
    /// Per event.
    pub events: Vec<EventErrors>,
    /// Per record: the largest error of a position on any beam, in beam lengths.
    pub records: Vec<f64>,
    /// Per beam: where the error is.
    pub beams: Vec<BeamErrors>,
    /// The scene with everything that was chosen, which gives the same results.
    pub chosen: Option<LazyText>,
    /// The runs that were made to choose the mesh and to know the errors, in their order.
    pub runs: Vec<RunForError>,
}

/// A text that is made when it is first read.
#[derive(Clone)]
pub struct LazyText(Arc<LazyLock<String, Box<dyn FnOnce() -> String + Send + Sync>>>);

impl LazyText {
    /// The text that `make` returns.
    pub fn new(make: impl FnOnce() -> String + Send + Sync + 'static) -> Self {
        Self(Arc::new(LazyLock::new(Box::new(make))))
    }
}

impl Deref for LazyText {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl fmt::Debug for LazyText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&**self, f)
    }
}

impl ErrorEstimate {
    /// The errors of what a probe sees at the last record.
    pub fn last_of(&self, probe: &str) -> Option<&ProbeSample> {
        self.probes.iter().find(|errors| errors.name == probe)?.samples.last()
    }

    /// Which accuracy is missed, by how much, and why; `None` where nobody asked for any, or it is
    /// met.
    pub fn missed(&self, analysis: AnalysisKind) -> Option<String> {
        let wanted = self.wanted.filter(|_| !self.met)?;
        let (unit, parameter, second) = match analysis {
            AnalysisKind::Static => (" of a beam length", "load factor ", ""),
            AnalysisKind::Dynamic => (" of a beam length", "", " s"),
            AnalysisKind::Modal | AnalysisKind::Buckling => (", relative", "", ""),
        };
        let mut text = format!("the wanted accuracy of {:e}{unit} is not met", wanted.result);
        let found = self.estimated;
        if found.result.is_infinite() {
            text += "; nothing is known of the errors";
        } else if found.result > wanted.result {
            text += &format!("; the results may err by {:.1e}", found.result);
        }
        for (what, wanted, found) in [
            ("the curvature", wanted.curvature, found.curvature),
            ("section forces", wanted.section_force, found.section_force),
        ] {
            if let (Some(wanted), Some(found)) = (wanted, found)
                && found > wanted
            {
                text += &format!("; {what} may err by {found:.1e} where {wanted:e} is wanted");
            }
        }
        if let Some(reason) = &self.reason {
            text += &format!(": {reason}");
        }
        if let Some(until) = self.good_until {
            text += &format!("; good to {:e} until {parameter}{until:.4}{second}", wanted.result);
        }
        Some(text)
    }
}

/// Errors of the results as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Statics and motions: of positions, in beam lengths. Vibrations and critical loads: of the
    /// numbers, relative.
    pub result: f64,
    /// Of the curvature, relative to its largest.
    pub curvature: Option<f64>,
    /// Of axial force, shear force and bending moment in the last state, relative to the largest
    /// of each kind.
    pub section_force: Option<f64>,
}

/// Errors of what a probe sees.
#[derive(Clone, Debug, Default)]
pub struct ProbeErrors {
    /// The probe's name.
    pub name: String,
    /// Per record: of x and y the distance from the right place \[m\], of all else the size of the
    /// error, in its unit.
    pub samples: Vec<ProbeSample>,
}

/// Errors of an event; infinite where nothing is known of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventErrors {
    /// Of its time \[s\] or load factor.
    pub parameter: f64,
    /// Of the value at which a quantity turned back, in its unit.
    pub value: Option<f64>,
    /// Of the impulse of a contact that ended: the length of the difference \[N s\].
    pub impulse: Option<f64>,
    /// Of the largest force of that contact \[N\].
    pub largest_force: Option<f64>,
}

impl EventErrors {
    /// Of an event that a coarser run does not have.
    pub const UNKNOWN: Self =
        Self { parameter: f64::INFINITY, value: None, impulse: None, largest_force: None };
}

/// Where along a beam its positions and curvature err.
#[derive(Clone, Debug, Default)]
pub struct BeamErrors {
    /// Name of the beam.
    pub beam: String,
    /// Arc lengths \[m\].
    pub s: Vec<f64>,
    /// The largest error of the position there over all records, in lengths of the beam.
    pub position: Vec<f64>,
    /// The largest error of the curvature there over all records \[1/m\].
    pub curvature: Vec<f64>,
}

/// A run that was made on the way.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RunForError {
    /// Its discretisation and integrator in words.
    pub setting: String,
    /// Its unknowns.
    pub degrees_of_freedom: usize,
    /// Time to build and to solve \[s\].
    pub seconds: f64,
    /// The error of the result that it was estimated to have; `None` for a run that only serves
    /// another one's estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(result: f64, curvature: f64) -> ErrorEstimate {
        let errors = |result, curvature| Errors { result, curvature: Some(curvature), section_force: None };
        ErrorEstimate {
            wanted: Some(errors(1e-3, 1e-2)),
            estimated: errors(result, curvature),
            ..ErrorEstimate::default()
        }
    }

    /// Made once, when it is first read, and for all copies.
    #[test]
    fn a_lazy_text_is_made_when_it_is_read() {
        let (sender, made) = std::sync::mpsc::channel();
        let text = LazyText::new(move || {
            sender.send(()).expect("a receiver");
            "chosen".to_owned()
        });
        let copy = text.clone();
        assert!(made.try_recv().is_err());
        assert_eq!((&*text, &*copy, format!("{copy:?}")), ("chosen", "chosen", "\"chosen\"".to_owned()));
        assert!(made.try_recv().is_ok() && made.try_recv().is_err());
    }

    #[test]
    fn what_is_missed_is_said_of_each_error() {
        let missed = |result, curvature| estimate(result, curvature).missed(AnalysisKind::Static).unwrap();
        let first = "the wanted accuracy of 1e-3 of a beam length is not met";
        assert_eq!(missed(2e-3, 1e-2), format!("{first}; the results may err by 2.0e-3"));
        assert_eq!(
            missed(1e-3, 2e-2),
            format!("{first}; the curvature may err by 2.0e-2 where 1e-2 is wanted")
        );
        assert_eq!(missed(f64::INFINITY, 1e-2), format!("{first}; nothing is known of the errors"));
        let late =
            ErrorEstimate { reason: Some("it swings".into()), good_until: Some(1.5), ..estimate(2e-3, 1e-2) };
        let said = late.missed(AnalysisKind::Dynamic).unwrap();
        assert!(said.ends_with(": it swings; good to 1e-3 until 1.5000 s"), "{said}");
        let exact = estimate(1e-3, 1e-2).missed(AnalysisKind::Static);
        assert_eq!(exact.as_deref(), Some(first), "of errors that are as large as is wanted nothing is said");
        let early = ErrorEstimate { good_until: Some(0.5), ..estimate(2e-3, 1e-2) };
        let said = early.missed(AnalysisKind::Static).unwrap();
        assert!(said.ends_with("; good to 1e-3 until load factor 0.5000"), "{said}");
        for analysis in [AnalysisKind::Modal, AnalysisKind::Buckling] {
            let said = estimate(2e-3, 1e-2).missed(analysis).unwrap();
            assert!(said.starts_with("the wanted accuracy of 1e-3, relative is not met; "), "{said}");
        }
        let forces = |section_force| Errors { section_force: Some(section_force), ..Errors::default() };
        let of_forces =
            ErrorEstimate { wanted: Some(forces(1e-2)), estimated: forces(0.02), ..estimate(0.0, 0.0) };
        let said = of_forces.missed(AnalysisKind::Static).unwrap();
        assert!(said.ends_with("; section forces may err by 2.0e-2 where 1e-2 is wanted"), "{said}");
        let met = ErrorEstimate { met: true, ..estimate(2e-3, 1e-2) };
        assert_eq!(met.missed(AnalysisKind::Static), None);
        assert_eq!(ErrorEstimate::default().missed(AnalysisKind::Static), None);
    }

    #[test]
    fn the_last_errors_of_a_probe_are_found_by_its_name() {
        let errors = |name: &str, x: f64| ProbeErrors {
            name: name.into(),
            samples: vec![ProbeSample::default(), ProbeSample { x, ..ProbeSample::default() }],
        };
        let probes = vec![errors("middle", 1.0), errors("tip", 2.0)];
        let estimate = ErrorEstimate { probes, ..ErrorEstimate::default() };
        assert_eq!(estimate.last_of("tip").map(|sample| sample.x), Some(2.0));
        assert_eq!(estimate.last_of("elbow"), None);
    }
}
