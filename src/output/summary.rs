//! The few numbers that a script reads first.

use serde::{Serialize, Serializer};

use crate::results::{
    AnalysisKind, Energy, ErrorEstimate, Event, EventErrors, LargestStress, ProbeSample, Reaction, Results,
    RunForError, Seconds, SectionForces, Shape, Statistics, Tension,
};

/// The contents of `summary.json`; keys and their order are those of the fields.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The scene's title.
    pub title: String,
    /// Kind of analysis.
    pub analysis: AnalysisKind,
    /// Version of this library.
    pub version: String,
    /// Whether the run reached as far as was asked for.
    pub complete: bool,
    /// Unknowns after supports are eliminated, plus multipliers.
    pub degrees_of_freedom: usize,
    /// Load factor or time \[s\] of the last record; `null` where there is none.
    pub last: Option<f64>,
    /// Per probe, by name, its last sample.
    #[serde(serialize_with = "as_map")]
    pub probes: Vec<(String, ProbeSummary)>,
    /// Estimated errors of the results, where they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<ErrorSummary>,
    /// Per support and joint, its forces in the last state, where they were asked for.
    #[serde(serialize_with = "as_map", skip_serializing_if = "Vec::is_empty")]
    pub reactions: Vec<(String, Reaction)>,
    /// The largest stress in the last state of each beam whose section tells its shape.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stress: Vec<LargestStress>,
    /// Energies of the last record; `null` where there is none (modal, buckling).
    pub energy: Option<EnergySummary>,
    /// Events of a motion that were asked for, or changes of stability along a path, in order; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventSummary>,
    /// Natural frequencies \[Hz\], ascending, 0 where nothing resists the motion; modal analysis
    /// only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequencies: Option<Vec<f64>>,
    /// Estimated errors of the frequencies \[Hz\], where they are known; `null` of one that round-off hides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency_errors: Option<Vec<f64>>,
    /// Critical load factors, ascending; buckling only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_factors: Option<Vec<f64>>,
    /// Estimated errors of the critical load factors, where they are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_factor_errors: Option<Vec<f64>>,
    /// The tensions at the end of the tendons whose lengths are given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tensions: Vec<Tension>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Counts of steps, iterations and factorisations.
    pub statistics: Statistics,
    /// Wall time \[s\].
    pub seconds: Seconds,
}

/// The contents of `summary.json` of a scene with stages.
#[derive(Clone, Debug, Serialize)]
pub struct StagesSummary {
    /// The scene's title.
    pub title: String,
    /// Version of this library.
    pub version: String,
    /// Whether every stage reached its end.
    pub complete: bool,
    /// The stages that were computed, in their order.
    pub stages: Vec<StageSummary>,
}

/// The summary of a stage.
#[derive(Clone, Debug, Serialize)]
pub struct StageSummary {
    /// Its name, which is that of its folder.
    pub name: String,
    /// What `summary.json` in its folder says.
    #[serde(flatten)]
    pub summary: Summary,
}

impl StagesSummary {
    pub(super) fn new(stages: Vec<StageSummary>, complete: bool) -> Self {
        let title = stages.first().map_or_else(String::new, |stage| stage.summary.title.clone());
        let version = env!("CARGO_PKG_VERSION").to_owned();
        let complete = complete && stages.iter().all(|stage| stage.summary.complete);
        Self { title, version, complete, stages }
    }

    /// The text of `summary.json`, as [`Summary::to_json`].
    pub(super) fn to_json(&self) -> Result<String, serde_json::Error> {
        indented(self)
    }
}

/// What a probe saw at the last record.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProbeSummary {
    /// The last sample.
    #[serde(flatten)]
    pub sample: ProbeSample,
    /// What the section at the probe carries, where it was asked for.
    #[serde(flatten)]
    pub section: Option<SectionForces>,
    /// The estimated error of each quantity, in its unit; of x and y the distance from the right
    /// place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<ProbeSample>,
}

/// Something that happened in a motion, or along a path of equilibria.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventSummary {
    /// What, and when.
    #[serde(flatten)]
    pub event: Event,
    /// The estimated errors, where errors are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<EventErrorSummary>,
}

/// The estimated errors of an event; an infinite one, of which nothing is known, becomes `null`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EventErrorSummary {
    /// Of its time \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Of its load factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_factor: Option<f64>,
    /// Of the value at which a quantity turned back, in its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Of the impulse of a contact that ended: the length of the difference \[N s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impulse: Option<f64>,
    /// Of the largest force of that contact \[N\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_force: Option<f64>,
}

impl EventErrorSummary {
    fn new(event: &Event, errors: EventErrors) -> Self {
        let EventErrors { parameter, value, impulse, largest_force } = errors;
        let others = Self { value, impulse, largest_force, ..Self::default() };
        match event {
            Event::Stability { .. } => Self { load_factor: Some(parameter), ..others },
            _ => Self { time: Some(parameter), ..others },
        }
    }
}

/// The estimated errors of the results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorSummary {
    /// The largest error that was wanted: of positions in beam lengths, or of numbers, relative;
    /// `null` where nobody asked for any.
    pub wanted: Option<f64>,
    /// The largest error of the results; `null` where nothing is known of it.
    pub estimated: f64,
    /// Whether no error is larger than wanted.
    pub met: bool,
    /// The reason why an error is larger than wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The time \[s\] or load factor until which the results are as good as was wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub good_until: Option<f64>,
    /// Error of the curvature, relative to the largest curvature.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curvature: Option<WantedError>,
    /// Error of axial force, shear force and bending moment in the last state, relative to the
    /// largest of each.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section_force: Option<WantedError>,
    /// Where the model itself errs, which no finer mesh mends.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// The runs that were made to choose the mesh and to estimate the errors, in their order.
    pub runs: Vec<RunForError>,
}

/// An error and the largest that was wanted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WantedError {
    /// `null` where nobody asked for any.
    pub wanted: Option<f64>,
    /// The estimate.
    pub estimated: f64,
}

impl ErrorSummary {
    fn of(error: &ErrorEstimate) -> Self {
        let pair = |wanted: Option<f64>, estimated: Option<f64>| {
            estimated.map(|estimated| WantedError { wanted, estimated })
        };
        let (wanted, found) = (error.wanted, error.estimated);
        Self {
            wanted: wanted.map(|wanted| wanted.result),
            estimated: found.result,
            met: error.met,
            reason: error.reason.clone(),
            good_until: error.good_until,
            curvature: pair(wanted.and_then(|wanted| wanted.curvature), found.curvature),
            section_force: pair(wanted.and_then(|wanted| wanted.section_force), found.section_force),
            notes: error.notes.clone(),
            runs: error.runs.clone(),
        }
    }
}

/// Energies \[J\] of the last record.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnergySummary {
    /// ½∫ EA (ε − ε₀)² ds, ε₀ that of an actuation.
    pub stretch: f64,
    /// ½∫ EI (κ − κ₀)² ds.
    pub bend: f64,
    /// Of springs, foundations and contacts; left out where there are none.
    #[serde(skip_serializing_if = "is_zero")]
    pub stored: f64,
    /// ½∫ ρA ṙ·ṙ ds.
    pub kinetic: f64,
    /// Of gravity and conservative loads.
    pub potential: f64,
    /// In a motion done by loads without a potential, moving supports and actuators since its start; along equilibria by actuators alone,
    /// since the analysis began.
    pub work: f64,
    /// Taken by damping since the start; left out where there is none.
    #[serde(skip_serializing_if = "is_zero")]
    pub lost: f64,
    /// Sum of the energies, less the work, plus the energy lost: what is kept in a motion, and along equilibria where nothing but
    /// actuators, and loads with a potential, do work.
    pub total: f64,
    /// max |total − initial total| / max kinetic over all records; `null` where nothing moves.
    pub drift: Option<f64>,
}

impl Summary {
    /// The summary of the results.
    pub fn of(results: &Results) -> Self {
        let (trajectory, run) = (results.states(), results.run());
        let error = run.error.as_deref();
        let last_sample = |(i, p): (usize, &crate::results::ProbeSeries)| {
            let section = trajectory.sections.get(i).and_then(|series| series.samples.last()).copied();
            let of_probe = error.and_then(|error| error.last_of(&p.name)).copied();
            let summary = |sample: &ProbeSample| ProbeSummary { sample: *sample, section, error: of_probe };
            p.samples.last().map(|sample| (p.name.clone(), summary(sample)))
        };
        let absolute = |kind: AnalysisKind| {
            let error = error.filter(|_| run.analysis == kind)?;
            let pairs = results.eigenvalues().into_iter().zip(&error.eigenvalues);
            // Of what round-off hides, which has a relative error, none is known.
            let absolute = |(value, error): (f64, &f64)| match value {
                0.0 if *error > 0.0 => f64::INFINITY,
                _ => error * value.abs(),
            };
            Some(pairs.map(absolute).collect())
        };
        Self {
            title: run.title.clone(),
            analysis: run.analysis,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            complete: run.complete,
            degrees_of_freedom: run.degrees_of_freedom,
            last: trajectory.parameter.last().copied(),
            error: error.map(ErrorSummary::of),
            probes: trajectory.probes.iter().enumerate().filter_map(last_sample).collect(),
            reactions: trajectory
                .reactions
                .iter()
                .filter_map(|r| Some((r.name.clone(), *r.samples.last()?)))
                .collect(),
            stress: trajectory.last.iter().filter_map(Shape::largest_stress).collect(),
            energy: trajectory.energy.last().map(|last| EnergySummary {
                stretch: last.stretch,
                bend: last.bend,
                stored: last.stored,
                kinetic: last.kinetic,
                potential: last.potential,
                work: last.work,
                lost: last.lost,
                total: last.total(),
                drift: drift(&trajectory.energy),
            }),
            events: trajectory
                .events
                .iter()
                .enumerate()
                .map(|(i, event)| EventSummary {
                    event: event.clone(),
                    error: error
                        .and_then(|error| error.events.get(i))
                        .map(|errors| EventErrorSummary::new(event, *errors)),
                })
                .collect(),
            frequency_errors: absolute(AnalysisKind::Modal),
            load_factor_errors: absolute(AnalysisKind::Buckling),
            frequencies: (run.analysis == AnalysisKind::Modal).then(|| results.eigenvalues()),
            load_factors: (run.analysis == AnalysisKind::Buckling).then(|| results.eigenvalues()),
            tensions: run.tensions.clone(),
            warnings: run.warnings.clone(),
            statistics: run.statistics,
            seconds: run.seconds,
        }
    }

    /// The text of `summary.json`, indented, with a final newline. Numbers round-trip exactly.
    ///
    /// # Errors
    /// None in practice: every field has a JSON form (what is not finite becomes `null`).
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        indented(self)
    }
}

fn indented(summary: &impl Serialize) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(summary).map(|text| text + "\n")
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// max |total − initial total| / max kinetic; none where nothing moves but by the round-off of the energies.
pub(crate) fn drift(energy: &[Energy]) -> Option<f64> {
    let initial = energy.first()?.total();
    let change = energy.iter().fold(0.0_f64, |m, e| m.max((e.total() - initial).abs()));
    Energy::kinetic_of(energy).map(|kinetic| change / kinetic)
}

fn as_map<T: Serialize, S: Serializer>(named: &[(String, T)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(named.iter().map(|(name, value)| (name, value)))
}
