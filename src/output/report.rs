//! `report.html`: one page that needs nothing beside it.

use askama::Template;

use super::digits::with_error;
use super::error::OutputError;
use super::event::EventText;
use super::figures::{self, Figure};
use super::motion::Motion;
use super::plot::human;
use super::summary::{ProbeSummary, Summary};
use crate::results::{
    AnalysisKind, Event, LargestStress, ProbeSample, Reaction, Results, SectionForces, Tension, Trajectory,
};

#[derive(Template)]
#[template(path = "report.html", config = "src/output/askama.toml")]
struct Page<'a> {
    title: &'a str,
    subtitle: String,
    complete: bool,
    style: &'static str,
    player: &'static str,
    warnings: Vec<String>,
    /// JSON, free of `<`; empty where nothing moves.
    motion: String,
    /// One for each stage, or the only one.
    parts: Vec<Analysed<'a>>,
    version: &'a str,
}

/// What there is to show of one analysis.
struct Analysed<'a> {
    /// Empty where it is the only one.
    stage: &'a str,
    /// Its folder, as an address.
    folder: String,
    subtitle: String,
    results: Vec<NumberTable>,
    settings: &'a [(String, String)],
    counts: Vec<(&'static str, String)>,
    figures: Vec<Figure>,
}

impl<'a> Analysed<'a> {
    fn new(stage: &'a str, results: &'a Results, summary: &Summary, figures: Vec<Figure>) -> Self {
        let t = results.states();
        Self {
            stage,
            folder: address(stage),
            subtitle: subtitle(t),
            results: [
                eigenvalues(results),
                probes(t, summary),
                sections(t, summary),
                stresses(t, summary),
                reactions(t, summary),
                tensions(t, summary),
                energy(t, summary),
                events(t),
            ]
            .into_iter()
            .flatten()
            .collect(),
            settings: &t.run.settings,
            counts: counts(t, summary),
            figures,
        }
    }
}

/// A folder's name as a relative address: what is not a letter, a digit or one of `-_.` is encoded.
fn address(folder: &str) -> String {
    let plain = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'-' | b'_' | b'.');
    folder.bytes().map(|b| if plain(b) { char::from(b).to_string() } else { format!("%{b:02X}") }).collect()
}

fn kind(t: &Trajectory) -> &'static str {
    match t.run.analysis {
        AnalysisKind::Static => "Equilibrium",
        AnalysisKind::Dynamic => "Motion",
        AnalysisKind::Modal => "Natural vibrations",
        AnalysisKind::Buckling => "Critical loads",
    }
}

fn subtitle(t: &Trajectory) -> String {
    let count = t.run.degrees_of_freedom;
    format!("{} · {count} degree{} of freedom", kind(t), if count == 1 { "" } else { "s" })
}

/// A table of numbers.
struct NumberTable {
    caption: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The page of one analysis.
pub(super) fn page(
    results: &Results,
    summary: &Summary,
    figures: Vec<Figure>,
) -> Result<String, OutputError> {
    let t = results.states();
    let parts = vec![Analysed::new("", results, summary, figures)];
    let title = if t.run.title.trim().is_empty() { kind(t) } else { &t.run.title };
    render(Page {
        title,
        subtitle: subtitle(t),
        complete: t.run.complete,
        style: STYLE,
        player: PLAYER,
        warnings: t.run.warnings.clone(),
        motion: movie(&[("", results)]),
        parts,
        version: &summary.version,
    })
}

/// The page of all stages; `complete` tells whether there are no more.
pub(super) fn page_of_stages(stages: &[(&str, Results)], complete: bool) -> Result<String, OutputError> {
    let (mut parts, mut warnings) = (Vec::new(), Vec::new());
    let mut version = String::new();
    for (stage, results) in stages {
        let summary = Summary::of(results);
        parts.push(Analysed::new(stage, results, &summary, figures::figures(results)?));
        let of_stage = |warning: &String| format!("stage {stage}: {warning}");
        warnings.extend(results.run().warnings.iter().map(of_stage));
        version = summary.version;
    }
    let title = stages.first().map_or("", |(_, results)| results.run().title.trim());
    let borrowed: Vec<(&str, &Results)> = stages.iter().map(|(stage, results)| (*stage, results)).collect();
    render(Page {
        title: if title.is_empty() { "Stages" } else { title },
        subtitle: stages.iter().map(|(stage, _)| *stage).collect::<Vec<_>>().join(" → "),
        complete: complete && stages.iter().all(|(_, results)| results.run().complete),
        style: STYLE,
        player: PLAYER,
        warnings,
        motion: movie(&borrowed),
        parts,
        version: &version,
    })
}

/// Events that a page tells one by one.
const MOST_EVENTS: usize = 100;
const STYLE: &str = include_str!("templates/report.css");
const PLAYER: &str = include_str!("templates/player.js");

/// The data are numbers and names: they always have a JSON form.
fn movie(stages: &[(&str, &Results)]) -> String {
    Motion::of(stages).and_then(|motion| motion.to_json().ok()).unwrap_or_default()
}

fn render(page: Page<'_>) -> Result<String, OutputError> {
    page.render().map_err(|source| OutputError::Report { source })
}

fn last(t: &Trajectory) -> String {
    match (t.run.analysis, t.parameter.last()) {
        (AnalysisKind::Static | AnalysisKind::Modal, Some(&load)) => {
            format!(" at load factor {}", human(load, 6))
        }
        (AnalysisKind::Dynamic, Some(&time)) => format!(" at {} s", human(time, 6)),
        _ => String::new(),
    }
}

fn events(t: &Trajectory) -> Option<NumberTable> {
    let known = |value: f64, error: Option<f64>| {
        error.and_then(|error| with_error(value, error)).unwrap_or_else(|| human(value, 7))
    };
    let row = |(i, event): (usize, &Event)| {
        let errors = t.run.error.as_ref().and_then(|error| error.events.get(i)).copied();
        let EventText { name, when, what } = EventText::new(event, errors, known);
        vec![name, when, what]
    };
    let caption = match t.events.len() {
        0 => return None,
        count if count > MOST_EVENTS => {
            format!("Events: the first {MOST_EVENTS} of {count}, which are all in summary.json")
        }
        _ => "Events".to_owned(),
    };
    Some(NumberTable {
        caption,
        header: ["event", "at", "what"].map(String::from).into(),
        rows: t.events.iter().enumerate().take(MOST_EVENTS).map(row).collect(),
    })
}

fn probes(t: &Trajectory, summary: &Summary) -> Option<NumberTable> {
    if summary.probes.is_empty() {
        return None;
    }
    let moving = summary.probes.iter().any(|(_, p)| p.sample.vx.is_some());
    let mut header: Vec<String> =
        ["probe", "x [m]", "y [m]", "angle [°]", "κ [1/m]", "ε [–]"].map(String::from).into();
    if moving {
        header.extend(["vx [m/s]", "vy [m/s]"].map(String::from));
    }
    let length = t.run.undeformed.iter().filter_map(|b| b.s.last()).fold(0.0_f64, |m, l| m.max(*l));
    // One digit is enough for round-off.
    let number = |(v, scale): (f64, f64)| human(v, if v.abs() < 1e-12 * scale { 1 } else { 7 });
    let row = |(name, ProbeSummary { sample: s, error, .. }): &(String, ProbeSummary)| {
        let known = |value: f64, scale: f64, of: fn(&ProbeSample) -> f64| {
            error.and_then(|error| with_error(value, of(&error))).unwrap_or_else(|| number((value, scale)))
        };
        let mut row = vec![name.clone()];
        row.extend([known(s.x, length, |e| e.x), known(s.y, length, |e| e.y)]);
        row.push(known(s.angle.to_degrees(), 1.0, |e| e.angle.to_degrees()));
        row.extend([known(s.curvature, 1.0 / length, |e| e.curvature), known(s.strain, 1.0, |e| e.strain)]);
        if moving {
            let [vx, vy]: [fn(&ProbeSample) -> f64; 2] = [|e| e.vx.unwrap_or(0.0), |e| e.vy.unwrap_or(0.0)];
            row.extend([(s.vx, vx), (s.vy, vy)].map(|(v, of)| v.map_or("–".into(), |v| known(v, 0.0, of))));
        }
        row
    };
    Some(NumberTable {
        caption: format!("Probes{}", last(t)),
        header,
        rows: summary.probes.iter().map(row).collect(),
    })
}

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().copied().map(String::from).collect()
}

/// What the sections at the probes carry.
fn sections(t: &Trajectory, summary: &Summary) -> Option<NumberTable> {
    let known = summary.probes.iter().filter_map(|(name, probe)| Some((name, probe.section?)));
    let known: Vec<_> = known.collect();
    let stressed = known.iter().any(|(_, section)| section.stress_top.is_some());
    let mut header = strings(&["section at", "N [N]", "Q [N]", "M [N m]"]);
    if stressed {
        header.extend(strings(&["σ bottom [Pa]", "σ top [Pa]"]));
    }
    let row = |(name, section): &(&String, SectionForces)| {
        let mut row = vec![(*name).clone()];
        let forces = [section.axial_force, section.shear_force, section.bending_moment];
        row.extend(forces.map(|force| human(force, 7)));
        if stressed {
            let stresses = [section.stress_bottom, section.stress_top];
            row.extend(stresses.map(|stress| stress.map_or("–".into(), |stress| human(stress, 5))));
        }
        row
    };
    let rows: Vec<_> = known.iter().map(row).collect();
    let caption = format!("Sections at the probes{}", last(t));
    (!rows.is_empty()).then_some(NumberTable { caption, header, rows })
}

/// The largest stress in each beam.
fn stresses(t: &Trajectory, summary: &Summary) -> Option<NumberTable> {
    let row = |stress: &LargestStress| {
        vec![
            stress.beam.clone(),
            human(stress.value, 5),
            human(stress.s, 6),
            format!("{}", stress.layer),
            stress.face.to_owned(),
        ]
    };
    let rows: Vec<_> = summary.stress.iter().map(row).collect();
    let header = strings(&["largest stress in", "σ [Pa]", "s [m]", "layer", "face"]);
    let caption = format!("Largest stresses{}", last(t));
    (!rows.is_empty()).then_some(NumberTable { caption, header, rows })
}

/// Forces of supports and joints.
fn reactions(t: &Trajectory, summary: &Summary) -> Option<NumberTable> {
    let row = |(name, force): &(String, Reaction)| {
        let values = [force.fx, force.fy, force.moment].map(|value| human(value, 7));
        std::iter::once(name.clone()).chain(values).collect()
    };
    let rows: Vec<_> = summary.reactions.iter().map(row).collect();
    let header = strings(&["reaction of", "fx [N]", "fy [N]", "moment [N m]"]);
    let caption = format!("Reactions{}", last(t));
    (!rows.is_empty()).then_some(NumberTable { caption, header, rows })
}

/// Tensions of the tendons whose lengths are given.
fn tensions(t: &Trajectory, summary: &Summary) -> Option<NumberTable> {
    let row = |Tension { beam, tension }: &Tension| vec![beam.clone(), human(*tension, 7)];
    let rows: Vec<_> = summary.tensions.iter().map(row).collect();
    let header = strings(&["tendon of", "tension [N]"]);
    let caption = format!("Tendons of given length{}", last(t));
    (!rows.is_empty()).then_some(NumberTable { caption, header, rows })
}

fn energy(t: &Trajectory, summary: &Summary) -> Option<NumberTable> {
    let e = summary.energy?;
    let parts = [
        ("stretch", e.stretch),
        ("bend", e.bend),
        ("springs and contacts", e.stored),
        ("kinetic", e.kinetic),
        ("potential", e.potential),
        ("put in", e.work),
        ("lost", e.lost),
        ("total", e.total),
    ];
    // Energies that are not simulated have no column.
    let there = |(name, value): &(&str, f64)| {
        *value != 0.0 || !matches!(*name, "springs and contacts" | "put in" | "lost")
    };
    let mut header: Vec<String> = vec!["energy [J]".into()];
    let mut row: Vec<String> = vec!["last record".into()];
    for (name, value) in parts.into_iter().filter(there) {
        header.push(name.into());
        row.push(human(value, 7));
    }
    if let Some(drift) = e.drift {
        header.push("drift [–]".into());
        row.push(human(drift, 3));
    }
    Some(NumberTable { caption: format!("Energies{}", last(t)), header, rows: vec![row] })
}

fn eigenvalues(results: &Results) -> Option<NumberTable> {
    let (caption, name, none) = match results {
        Results::Vibrations(_) => ("Natural frequencies", "frequency [Hz]", " (nothing resists)"),
        Results::CriticalLoads(_) => ("Critical loads", "load factor", ""),
        Results::Trajectory(_) => return None,
    };
    let errors = results.run().error.as_ref().map(|error| &error.eigenvalues[..]).unwrap_or_default();
    let lost = results.round_off();
    let number = |i: usize, v: f64| {
        let error = errors.get(i).and_then(|error| with_error(v, error * v.abs()));
        let is_hidden = lost.get(i).is_some_and(|lost| *lost > 0.0);
        error.unwrap_or_else(|| match v {
            0.0 if is_hidden => "0 (hidden by round-off)".into(),
            0.0 => format!("0{none}"),
            _ => human(v, 8),
        })
    };
    let values = results.eigenvalues();
    let rows = values.iter().enumerate().map(|(i, &v)| vec![format!("{}", i + 1), number(i, v)]).collect();
    Some(NumberTable { caption: caption.into(), header: vec!["mode".into(), name.into()], rows })
}

fn counts(t: &Trajectory, summary: &Summary) -> Vec<(&'static str, String)> {
    let s = &t.run.statistics;
    let mut counts: Vec<(&'static str, String)> = [
        ("steps", s.steps),
        ("rejected steps", s.rejected_steps),
        ("load steps", s.load_steps),
        ("Newton iterations", s.newton_iterations),
        ("residual evaluations", s.residual_evaluations),
        ("tangent evaluations", s.tangent_evaluations),
        ("factorisations", s.factorizations),
    ]
    .into_iter()
    .filter(|(_, count)| *count > 0)
    .map(|(name, count)| (name, count.to_string()))
    .collect();
    let seconds =
        |v: f64| if v < 0.1 { format!("{} ms", human(1e3 * v, 3)) } else { format!("{} s", human(v, 3)) };
    counts.push(("time to build", seconds(summary.seconds.build)));
    counts.push(("time to solve", seconds(summary.seconds.solve)));
    counts
}
