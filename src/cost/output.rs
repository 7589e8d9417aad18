//! The files of a study: tables, plots, a page, and the scene with the cheapest setting.
//!
//! | file | holds |
//! |---|---|
//! | `cost.csv` | one row a setting: what it is, its errors, seconds, counts; whether it is on the front and meets the target |
//! | `cost.svg`, `cost-work.svg` | error against wall time, and against tangents and factorisations |
//! | `cost.html` | all of it, with what was left out |
//! | `cost.json` | [`Report`] |
//! | `best.toml` | the scene with the cheapest setting that meets the target; absent where there is none |

use std::fs;
use std::io;
use std::path::Path;

use askama::Template;
use serde::Serialize;

use super::trial::front;
use super::{Alone, Deviation, Family, LeftOut, Measured, Solver, Study, Trial, least};
use crate::model::Integrator;
use crate::output::plot::{Axis, Chart, Colour, GREY, Mark, PALETTE, Series, human};
use crate::output::{OutputError, StagedFiles, exact};

/// The contents of `cost.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Report<'a> {
    /// The scene's title.
    pub title: &'a str,
    /// Version of this library.
    pub version: &'static str,
    /// Whether the study came to its end.
    pub complete: bool,
    /// Wanted error.
    pub target: f64,
    /// Name and unit of the error.
    pub error: &'static str,
    /// Time allowed for everything \[s\].
    pub budget: f64,
    /// The two runs that agree.
    pub reference: &'a [String; 2],
    /// By how much they differ.
    pub uncertainty: Deviation,
    /// All settings measured.
    pub trials: Vec<ReportedTrial>,
    /// Index of the cheapest trial that meets the target.
    pub best: Option<usize>,
    /// Tables of a scene file that select it.
    pub lines: Option<&'a str>,
    /// What accuracy alone chooses.
    pub alone: Option<&'a Alone>,
    /// Settings that were not tried, and why.
    pub left_out: &'a [LeftOut],
    /// Warnings for the reader.
    pub warnings: Vec<String>,
}

/// A trial in words and numbers.
#[derive(Clone, Debug, Serialize)]
pub struct ReportedTrial {
    /// The discretisation.
    pub discretization: String,
    /// Cells of the beam with the most.
    pub cells: usize,
    /// How equations are solved.
    pub solver: String,
    /// Cost and error.
    #[serde(flatten)]
    pub measured: Measured,
    /// Whether its error is below the uncertainty of the reference.
    pub below_uncertainty: bool,
    /// Whether no other trial beats it in time and error.
    pub front: bool,
    /// Whether its error plus the uncertainty of the reference is within the target, and its run
    /// warned of nothing.
    pub meets_target: bool,
}

impl Study {
    /// The study in words and numbers.
    pub fn report(&self) -> Report<'_> {
        let uncertainty = self.reference.uncertainty;
        let target = self.options.target;
        let trial = |(index, trial): (usize, &Trial)| ReportedTrial {
            discretization: trial.family.to_string(),
            cells: trial.cells,
            solver: trial.setting.solver.to_string(),
            measured: trial.measured.clone(),
            below_uncertainty: trial.measured.deviation.error < uncertainty.error,
            front: self.front.contains(&index),
            meets_target: trial.measured.warnings.is_empty()
                && trial.measured.deviation.error <= target - uncertainty.error,
        };
        Report {
            title: &self.reference.results.run().title,
            version: env!("CARGO_PKG_VERSION"),
            complete: self.complete,
            target,
            error: Deviation::name(self.reference.results.run().analysis),
            budget: self.options.budget.as_secs_f64(),
            reference: &self.reference.pair,
            uncertainty,
            trials: self.trials.iter().enumerate().map(trial).collect(),
            best: self.best.as_ref().map(|best| best.trial),
            lines: self.best.as_ref().map(|best| best.lines.as_str()),
            alone: self.alone.as_ref(),
            left_out: &self.left_out,
            warnings: self.warnings(),
        }
    }
}

/// Names of the files.
const FILES: [&str; 6] = ["cost.csv", "cost.svg", "cost-work.svg", "cost.html", "best.toml", "cost.json"];

/// Writes the files of a study into `directory`, all or none.
///
/// # Errors
/// [`OutputError`] where a file cannot be drawn or written.
pub fn write(directory: &Path, study: &Study) -> Result<(), OutputError> {
    let [csv, time, work, page, best, json] = FILES;
    let report = study.report();
    let draw = |name: &str, chart: &Chart| {
        chart.svg().map_err(|source| OutputError::Plot { name: name.to_owned(), source })
    };
    let error = report.error;
    let mut by_time = chart(study, "time to build and solve [s]", |m| m.seconds);
    if let Some(alone) = &study.alone {
        let point = vec![[alone.seconds, alone.error]];
        by_time =
            by_time.with(Series::points("accuracy alone, estimate included", point, PALETTE[3]).size(6.0));
    }
    let by_time = draw(time, &by_time)?;
    let by_work =
        draw(work, &chart(study, "(tangent evaluations + factorisations) × unknowns", Measured::sized_work))?;
    let marks = "Dots on lines: meshes of one discretisation with an accurate solver; circles: other tolerances and Gauss; \
                 crosses: generalised-α; grey: what no other setting beats; dashed: the target, and the uncertainty of the \
                 reference, below which errors are only known to be no more than that.";
    let figures = [
        (by_time.as_str(), format!("The {error} against wall time. {marks}")),
        (by_work.as_str(), format!("The {error} against work.")),
    ];
    let html = html(study, &report, &figures)?;
    let mut stage = StagedFiles::new(directory)?;
    stage.add(csv, |out| table(&report, out))?;
    stage.add(time, |out| out.write_all(by_time.as_bytes()))?;
    stage.add(work, |out| out.write_all(by_work.as_bytes()))?;
    stage.add(page, |out| out.write_all(html.as_bytes()))?;
    if let Some(found) = &study.best {
        stage.add(best, |out| out.write_all(found.scene.text().as_bytes()))?;
    }
    stage.add(json, |out| {
        serde_json::to_writer_pretty(&mut *out, &report)?;
        out.write_all(b"\n")
    })?;
    stage.commit()?;
    if study.best.is_none() {
        // The file of an older study would be taken for this one's. Most often there is none.
        let _ = fs::remove_file(directory.join(best));
    }
    Ok(())
}

fn table(report: &Report<'_>, out: &mut dyn io::Write) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(out);
    rows.write_record([
        "discretization",
        "cells",
        "solver",
        "degrees_of_freedom",
        "error",
        "below_uncertainty",
        "curvature_error",
        "energy_error",
        "seconds",
        "runs",
        "tangent_evaluations",
        "factorizations",
        "residual_evaluations",
        "newton_iterations",
        "steps",
        "front",
        "meets_target",
    ])?;
    for trial in &report.trials {
        let Measured { degrees_of_freedom, seconds, runs, statistics, deviation, .. } = trial.measured;
        let optional = |value: Option<f64>| value.map(exact).unwrap_or_default();
        rows.write_record([
            trial.discretization.clone(),
            trial.cells.to_string(),
            trial.solver.clone(),
            degrees_of_freedom.to_string(),
            exact(deviation.error),
            trial.below_uncertainty.to_string(),
            optional(deviation.curvature),
            optional(deviation.energy),
            exact(seconds),
            runs.to_string(),
            statistics.tangent_evaluations.to_string(),
            statistics.factorizations.to_string(),
            statistics.residual_evaluations.to_string(),
            statistics.newton_iterations.to_string(),
            (statistics.steps.max(statistics.load_steps)).to_string(),
            trial.front.to_string(),
            trial.meets_target.to_string(),
        ])?;
    }
    rows.flush()
}

/// Error against some cost, both logarithmic.
fn chart(study: &Study, axis: &str, cost: fn(&Measured) -> f64) -> Chart {
    let point = |trial: &Trial| [cost(&trial.measured), trial.measured.deviation.error];
    let name = Deviation::name(study.reference.results.run().analysis);
    let mut chart = Chart::new("", Axis::log(axis), Axis::log(name)).sized(900, 560);
    let costs = || study.trials.iter().map(|trial| cost(&trial.measured)).filter(|c| *c > 0.0);
    let ends = [costs().fold(f64::INFINITY, f64::min), costs().fold(0.0, f64::max)];
    for (label, level, colour) in [
        ("target", study.options.target, PALETTE[6]),
        ("uncertainty of the reference", study.reference.uncertainty.error, GREY),
    ] {
        chart = chart.with(Series::dashed(label, ends.map(|x| [x, level]).into(), colour));
    }
    let all: Vec<[f64; 2]> = study.trials.iter().map(point).collect();
    let distinct_errors: Vec<[f64; 2]> = all
        .iter()
        .map(|[cost, error]| [*cost, error.max(least(study.options.target, &study.reference))])
        .collect();
    let front = front(&distinct_errors).into_iter().map(|i| all[i]).collect();
    chart = chart.with(Series::line("front", front, GREY).size(7.0).opacity(0.35));
    let families = distinct(study.trials.iter().map(|trial| trial.family));
    for kind in distinct(families.iter().map(|family| family.kind())) {
        let mut label = kind.as_str();
        for family in families.iter().copied().filter(|family| family.kind() == kind) {
            let Some(colour) = colour(family) else { continue };
            // The first solver of a family is that with which its meshes were compared.
            let own = || study.trials.iter().filter(move |r| r.family == family);
            let Some(first) = own().next().map(|trial| trial.setting.solver) else { continue };
            let (mut line, mut circles, mut crosses) = (vec![], vec![], vec![]);
            for trial in own() {
                let alpha =
                    matches!(trial.setting.solver, Solver::Integrator(Integrator::GeneralizedAlpha { .. }));
                match trial.setting.solver {
                    solver if solver == first => line.push(point(trial)),
                    _ if alpha => crosses.push(point(trial)),
                    _ => circles.push(point(trial)),
                }
            }
            chart = chart
                .with(Series::line(label, line.clone(), colour).size(1.1).opacity(0.7))
                .with(Series::points("", line, colour))
                .with(Series::new("", circles, Mark::Circles, colour))
                .with(Series::new("", crosses, Mark::Crosses, colour));
            label = "";
        }
    }
    let of = |trials: Vec<&Trial>| trials.into_iter().map(point).collect::<Vec<_>>();
    let scene = of(study.trials.iter().filter(|r| r.family == Family::Scene).collect());
    if !scene.is_empty() {
        chart = chart.with(Series::points("the scene as it is", scene, PALETTE[6]).size(4.5));
    }
    if let Some(best) = &study.best {
        let best = of(vec![&study.trials[best.trial]]);
        chart = chart
            .with(Series::new("cheapest that meets the target", best, Mark::Circles, PALETTE[1]).size(6.5));
    }
    chart
}

/// The colour of a kind of discretisation; none for the scene's own, which has a mark of its own.
fn colour(family: Family) -> Option<Colour> {
    match family {
        Family::Scene => None,
        Family::Ancf(points) if points.lobatto => Some(PALETTE[4]),
        Family::Ancf(_) => Some(PALETTE[1]),
        Family::Rpim { neighbours: 1, .. } => Some(PALETTE[2]),
        Family::Rpim { neighbours: 2, .. } => Some(PALETTE[0]),
        Family::Rpim { .. } => Some(PALETTE[3]),
    }
}

fn distinct<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut distinct = Vec::new();
    for one in all {
        if !distinct.contains(&one) {
            distinct.push(one);
        }
    }
    distinct
}

#[derive(Template)]
#[template(path = "cost.html", config = "src/output/askama.toml")]
struct Page<'a> {
    title: &'a str,
    version: &'a str,
    style: &'static str,
    target: String,
    error_name: &'a str,
    seconds: String,
    warnings: &'a [String],
    lines: &'a str,
    alone: String,
    figures: &'a [(&'a str, String)],
    header: [&'static str; 9],
    rows: Vec<(bool, [String; 9])>,
    reference: Vec<(&'static str, String)>,
    left_out: &'a [LeftOut],
}

fn html(study: &Study, report: &Report<'_>, figures: &[(&str, String)]) -> Result<String, OutputError> {
    let uncertainty = report.uncertainty;
    let mut order: Vec<&ReportedTrial> = report.trials.iter().collect();
    order.sort_by(|a, b| a.measured.seconds.total_cmp(&b.measured.seconds));
    let optional = |value: Option<f64>| value.map_or("–".into(), |v| human(v, 2));
    let row = |trial: &ReportedTrial| {
        let Measured { degrees_of_freedom, seconds, statistics, deviation, .. } = trial.measured;
        let cells = [
            trial.discretization.clone(),
            trial.cells.to_string(),
            trial.solver.clone(),
            degrees_of_freedom.to_string(),
            if trial.below_uncertainty {
                format!("< {}", human(uncertainty.error, 2))
            } else {
                human(deviation.error, 2)
            },
            optional(deviation.curvature),
            optional(deviation.energy),
            human(1e3 * seconds, 3),
            format!("{}, {}", statistics.tangent_evaluations, statistics.factorizations),
        ];
        (trial.front, cells)
    };
    let [first, second] = report.reference;
    let page = Page {
        title: if report.title.trim().is_empty() { "Scene" } else { report.title },
        version: report.version,
        style: include_str!("../output/templates/report.css"),
        target: human(report.target, 3),
        error_name: report.error,
        seconds: human(study.seconds, 3),
        warnings: &report.warnings,
        lines: report.lines.unwrap_or_default(),
        alone: report.alone.map(Alone::to_string).unwrap_or_default(),
        figures,
        header: [
            "discretisation",
            "cells",
            "solver",
            "unknowns",
            "error",
            "curvature",
            "energy",
            "time [ms]",
            "tangents, factorisations",
        ],
        rows: order.into_iter().map(row).collect(),
        reference: vec![
            ("one run", first.clone()),
            ("the other", second.clone()),
            ("they differ by", human(uncertainty.error, 2)),
            ("their curvatures by", optional(uncertainty.curvature)),
            ("their energies by", optional(uncertainty.energy)),
            ("time to make it", format!("{} s", human(study.reference.seconds, 3))),
        ],
        left_out: report.left_out,
    };
    page.render().map_err(|source| OutputError::Report { source })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::tests::{TARGET, UNCERTAINTY, made_up};

    #[test]
    fn a_report_says_what_each_setting_is_worth() {
        let study = made_up();
        let report = study.report();
        let which = |is: fn(&ReportedTrial) -> bool| -> Vec<usize> {
            report.trials.iter().enumerate().filter(|(_, trial)| is(trial)).map(|(index, _)| index).collect()
        };
        assert_eq!(which(|trial| trial.below_uncertainty), [4]);
        assert_eq!(which(|trial| trial.meets_target), [1, 3, 9]);
        assert_eq!(which(|trial| trial.front), [1, 3]);
        assert_eq!((report.title, report.error), ("Made up", "position error [beam lengths]"));
        assert_eq!((report.target, report.budget, report.complete), (TARGET, 20.0, true));
        assert_eq!((report.best, report.trials.len(), report.warnings.len()), (Some(1), 10, 2));
        assert_eq!(report.lines, Some("[beam.cantilever.basis.ancf]\nelements = 4\n"));
        assert_eq!(report.trials[6].solver, "generalised-α (ρ∞ = 0.9), step 0.5 s");
    }

    /// Lines are meshes with the first solver of a discretisation, circles and crosses others; of
    /// one kind of discretisation the first one alone is named.
    #[test]
    fn a_chart_shows_every_setting() {
        let series = |label: &str, points: &[[f64; 2]], mark, colour, [size, opacity]: [f64; 2]| Series {
            label: label.to_owned(),
            points: points.to_owned(),
            mark,
            colour,
            size,
            opacity,
        };
        let family = |label: &str, colour: Colour, meshes: &[[f64; 2]], others: [&[[f64; 2]]; 2]| {
            [
                series(label, meshes, Mark::Line, colour, [1.1, 0.7]),
                series("", meshes, Mark::Points, colour, [2.6, 1.0]),
                series("", others[0], Mark::Circles, colour, [3.4, 1.0]),
                series("", others[1], Mark::Crosses, colour, [3.4, 1.0]),
            ]
        };
        let (grey, black, red) = (Colour(130, 130, 130), Colour(60, 60, 60), Colour(213, 94, 0));
        let best = [1.0 / 64.0, TARGET - UNCERTAINTY];
        let level = |error: f64| [[1.0 / 64.0, error], [8.0, error]];
        let none: [&[[f64; 2]]; 2] = [&[], &[]];
        let expected = [
            vec![
                series("target", &level(TARGET), Mark::Dashed, black, [1.4, 1.0]),
                series("uncertainty of the reference", &level(UNCERTAINTY), Mark::Dashed, grey, [1.4, 1.0]),
                series("front", &[best, [1.0 / 32.0, UNCERTAINTY]], Mark::Line, grey, [7.0, 0.35]),
            ],
            family("ANCF, 5/3 points", red, &[best, [0.125, TARGET]], none).into(),
            family("ANCF, 3L/2 points", Colour(230, 159, 0), &[[1.0 / 32.0, UNCERTAINTY]], none).into(),
            family(
                "RPIM, 2 neighbours",
                Colour(0, 114, 178),
                &[[0.25, UNCERTAINTY / 2.0]],
                [&[[1.0, 1.0 / 512.0]], &[[2.0, 1.0 / 256.0]]],
            )
            .into(),
            family("", Colour(0, 114, 178), &[[3.0, 1.0 / 2048.0]], none).into(),
            family("RPIM, 1 neighbour", Colour(0, 158, 115), &[[4.0, 1.0 / 128.0]], none).into(),
            family("RPIM, 3 neighbours", Colour(204, 121, 167), &[[8.0, 1.0 / 64.0]], none).into(),
            vec![
                series("the scene as it is", &[[0.5, 1.0 / 32.0]], Mark::Points, black, [4.5, 1.0]),
                series("cheapest that meets the target", &[best], Mark::Circles, red, [6.5, 1.0]),
            ],
        ];
        let study = made_up();
        let found = chart(&study, "time", |measured| measured.seconds);
        assert_eq!(found.series, expected.concat());
        assert_eq!((found.width, found.height), (900, 560));
        assert_eq!((found.x, found.y), (Axis::log("time"), Axis::log("position error [beam lengths]")));
        // Zero costs cannot be drawn on a logarithmic axis. Four cells have 16 unknowns, eight 32.
        let work = chart(&study, "work", Measured::sized_work);
        assert_eq!(work.series[0].points, [[32.0, TARGET], [64.0, TARGET]]);
        let bare =
            chart(&Study { best: None, trials: study.trials[1..].to_vec(), ..made_up() }, "work", |_| 2.0);
        assert_eq!(bare.series.len(), 3 + 6 * 4);
    }

    /// Numbers have as many digits as are of use.
    #[test]
    fn a_page_reads_as_reviewed() {
        let mut study = made_up();
        study.options.target = 1.234_56e-3;
        study.seconds = 17.456;
        study.reference.seconds = 1.2345;
        study.reference.uncertainty = Deviation { error: 1.2345e-5, curvature: Some(2.345e-3), energy: None };
        let scene = &mut study.trials[0].measured;
        scene.seconds = 12.3456e-3;
        scene.deviation = Deviation { error: 3.456e-2, curvature: Some(5.678e-2), energy: None };
        study.trials[1].measured.deviation.error = 1e-6;
        let page = |study: &Study| html(study, &study.report(), &[]).unwrap();
        let text = page(&study);
        for part in [
            "<h1>Made up: what accuracy costs</h1>",
            "target 0.00123 (position error [beam lengths]), measured in 17.5 s",
            "<li>the reference: it turns</li>",
            "<tr><td>as the scene is</td><td>3</td><td>as the scene is</td><td>0</td><td>0.035</td><td>0.057</td>\
             <td>–</td><td>12.3</td><td>1, 1</td></tr>",
            "<tr class=\"front\"><td>ANCF, 5/3 points</td><td>4</td>",
            "; 1.2 × 10⁻⁵</td>",
            "<th>they differ by</th><td>1.2 × 10⁻⁵</td>",
            "<th>their curvatures by</th><td>0.0023</td>",
            "<th>their energies by</th><td>–</td>",
            "<th>time to make it</th><td>1.23 s</td>",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        // By their times: 12 ms before 16 ms.
        assert!(text.find("<td>as the scene is</td><td>3</td>") < text.find("<td>ANCF, 5/3 points</td>"));
        study.reference.results.states_mut().run.title = " ".to_owned();
        assert!(page(&study).contains("<h1>Scene: what accuracy costs</h1>"));
    }

    #[test]
    fn a_best_scene_is_of_this_study() {
        let folder = tempfile::tempdir().unwrap();
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).ok();
        let mut study = made_up();
        write(folder.path(), &study).unwrap();
        assert_eq!(read("best.toml"), study.best.as_ref().map(|best| best.scene.text().to_owned()));
        assert!(read("cost.json").is_some_and(|text| text.ends_with("}\n")));
        study.best = None;
        write(folder.path(), &study).unwrap();
        assert_eq!(read("best.toml"), None);
        assert!(FILES.iter().all(|name| *name == "best.toml" || read(name).is_some()));
    }

    #[test]
    fn what_is_there_twice_is_kept_once() {
        assert_eq!(distinct([1, 2, 1, 3, 2].into_iter()), [1, 2, 3]);
    }
}
