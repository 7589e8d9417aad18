//! The table of a cost study on a terminal.

use std::fmt::Write as _;
use std::path::Path;

use crate::cost::{LeftOut, Report, ReportedTrial};
use crate::output::plot::human;

/// A setting is close to the front if no setting with at most its error takes less than this part
/// of its time.
const CLOSE: f64 = 0.8;

/// Settings left out for one reason that are named on the terminal.
const NAMED: usize = 3;

/// The settings on the front and close to it, and the lines for the cheapest one that meets the
/// target.
pub fn table(report: &Report<'_>, directory: &Path) -> String {
    let error = |trial: &ReportedTrial| trial.measured.deviation.error;
    let close = |trial: &ReportedTrial| {
        let faster = |other: &ReportedTrial| {
            other.measured.seconds < CLOSE * trial.measured.seconds && error(other) <= error(trial)
        };
        !report.trials.iter().any(faster)
    };
    let mut shown: Vec<(usize, &ReportedTrial)> = report.trials.iter().enumerate().collect();
    shown.retain(|(index, trial)| *index == 0 || trial.front || close(trial));
    shown.sort_by(|(_, a), (_, b)| a.measured.seconds.total_cmp(&b.measured.seconds));
    let optional = |value: Option<f64>| value.map_or("–".into(), |v| format!("{v:.1e}"));
    let header =
        ["", "discretisation", "cells", "solver", "time [ms]", "work", "error", "curvature", "energy"];
    let mut rows = vec![header.map(str::to_owned)];
    for (index, trial) in shown {
        let measured = &trial.measured;
        let mark = match (trial.front, report.best == Some(index)) {
            (_, true) => "►",
            (true, false) => "•",
            (false, false) => "",
        };
        rows.push([
            mark.to_owned(),
            trial.discretization.clone(),
            trial.cells.to_string(),
            trial.solver.clone(),
            human(1e3 * measured.seconds, 3),
            measured.work().to_string(),
            if trial.below_uncertainty {
                "below the reference's uncertainty".to_owned()
            } else {
                format!("{:.1e}", error(trial))
            },
            optional(measured.deviation.curvature),
            optional(measured.deviation.energy),
        ]);
    }
    let mut text = format!("{}\n\n", report.title);
    let widths: Vec<usize> = (0..header.len())
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    for row in &rows {
        let cells = row
            .iter()
            .zip(&widths)
            .map(|(cell, width)| cell.clone() + &" ".repeat(width - cell.chars().count()));
        let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join("  ").trim_end());
    }
    let [one, other] = report.reference;
    let _ = write!(
        text,
        "\n• nothing is better in time and error; ► the cheapest that meets the target {:e}\n\
         error: {}; work: tangent evaluations and factorisations\n\
         reference: {one}\n\
         against: {other}\n\
         uncertainty of the reference: {:.1e}, of its curvature {}, of its energy {}\n\
         {} settings measured; details and plots: {}",
        report.target,
        report.error,
        report.uncertainty.error,
        optional(report.uncertainty.curvature),
        optional(report.uncertainty.energy),
        report.trials.len(),
        directory.join("cost.html").display(),
    );
    if let Some(alone) = report.alone {
        let _ = write!(text, "\naccuracy = {:e} alone: {alone}", report.target);
    }
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for LeftOut { what, why } in report.left_out {
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, settings)) => settings.push(what),
            None => reasons.push((why, vec![what])),
        }
    }
    for (why, settings) in reasons {
        let more = settings.len().saturating_sub(NAMED);
        let names = settings[..settings.len() - more].join("; ");
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        let _ = write!(text, "\nleft out, because {why}: {names}{more}");
    }
    if let Some(lines) = report.lines {
        let _ = write!(
            text,
            "\n\nIn place of the tables of these names (or run {}):\n\n{}",
            directory.join("best.toml").display(),
            lines.trim_end()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::{Deviation, Measured};
    use crate::results::Statistics;

    fn trial(
        discretization: &str,
        seconds: f64,
        deviation: Deviation,
        [front, below_uncertainty]: [bool; 2],
    ) -> ReportedTrial {
        let statistics = Statistics { tangent_evaluations: 3, factorizations: 4, ..Statistics::default() };
        let measured = Measured { seconds, deviation, statistics, ..Measured::default() };
        let (discretization, solver) = (discretization.to_owned(), "as the scene is".to_owned());
        ReportedTrial {
            discretization,
            cells: 8,
            solver,
            measured,
            below_uncertainty,
            front,
            meets_target: false,
        }
    }

    /// Settings on the front and those close to it, by their time; one that takes 1.3 times as long
    /// for the same is left out, one that takes just 1.25 times as long is not.
    #[test]
    fn the_table_reads_as_reviewed() {
        let error = |error: f64| Deviation { error, ..Deviation::default() };
        let full = Deviation { error: 2.5e-5, curvature: Some(1.5e-3), energy: Some(4e-6) };
        let left = |what: &str, why: &str| LeftOut { what: what.to_owned(), why: why.to_owned() };
        let (slow, over, same) = ("it was too slow", "the time is over", "it is the same");
        let report = Report {
            title: "Arm",
            version: "0",
            complete: true,
            target: 1e-4,
            error: "position error",
            budget: 60.0,
            reference: &["one".to_owned(), "other".to_owned()],
            uncertainty: Deviation { error: 1e-7, curvature: Some(2e-4), energy: None },
            trials: vec![
                trial("the scene", 5e-3, error(1e-3), [false, false]),
                trial("dear", 1.3e-3, full, [false, false]),
                trial("best", 1e-3, full, [true, false]),
                trial("as good", 1.2344e-3, full, [false, false]),
                trial("just so", 1.25e-3, full, [false, false]),
                trial("exact", 4.5e-2, error(1e-8), [true, true]),
            ],
            best: Some(2),
            alone: None,
            lines: Some("elements = 8\n"),
            left_out: &[
                left("a", slow),
                left("b", slow),
                left("k", over),
                left("c", slow),
                left("d", slow),
                left("l", over),
                left("e", slow),
                left("m", over),
                left("r", same),
                left("s", same),
                left("t", same),
                left("u", same),
            ],
            warnings: vec![],
        };
        let expected = "\
Arm

   discretisation  cells  solver           time [ms]  work  error                              curvature  energy
►  best            8      as the scene is  1          7     2.5e-5                             1.5e-3     4.0e-6
   as good         8      as the scene is  1.23       7     2.5e-5                             1.5e-3     4.0e-6
   just so         8      as the scene is  1.25       7     2.5e-5                             1.5e-3     4.0e-6
   the scene       8      as the scene is  5          7     1.0e-3                             –          –
•  exact           8      as the scene is  45         7     below the reference's uncertainty  –          –

• nothing is better in time and error; ► the cheapest that meets the target 1e-4
error: position error; work: tangent evaluations and factorisations
reference: one
against: other
uncertainty of the reference: 1.0e-7, of its curvature 2.0e-4, of its energy –
6 settings measured; details and plots: out/cost.html
left out, because it was too slow: a; b; c; and 2 more
left out, because the time is over: k; l; m
left out, because it is the same: r; s; t; and 1 more

In place of the tables of these names (or run out/best.toml):

elements = 8";
        assert_eq!(table(&report, Path::new("out")), expected);
        let nothing = Report { best: None, lines: None, left_out: &[], ..report };
        let text = table(&nothing, Path::new("out"));
        assert!(!text.contains("►  best") && text.contains("•  best"), "{text}");
        assert!(text.ends_with("details and plots: out/cost.html"), "{text}");
    }
}
