//! What accuracy costs, on a terminal.

use std::fmt::Write as _;
use std::path::Path;

use ancf::cost::{LeftOut, Report, ReportedRung};
use ancf::output::plot::human;

/// A setting is close to the front where nothing with its error takes less than this part of its time.
const CLOSE: f64 = 0.8;

/// Settings left out for one reason that are named on the terminal.
const NAMED: usize = 3;

/// The settings on the front and close to it, and the lines for the cheapest one that meets the target.
pub fn table(report: &Report<'_>, directory: &Path) -> String {
    let error = |rung: &ReportedRung| rung.measured.deviation.error;
    let close = |rung: &ReportedRung| {
        let faster = |other: &ReportedRung| {
            other.measured.seconds < CLOSE * rung.measured.seconds && error(other) <= error(rung)
        };
        !report.rungs.iter().any(faster)
    };
    let mut shown: Vec<(usize, &ReportedRung)> = report.rungs.iter().enumerate().collect();
    shown.retain(|(index, rung)| *index == 0 || rung.front || close(rung));
    shown.sort_by(|(_, a), (_, b)| a.measured.seconds.total_cmp(&b.measured.seconds));
    let optional = |value: Option<f64>| value.map_or("–".into(), |v| format!("{v:.1e}"));
    let header =
        ["", "discretisation", "cells", "solver", "time [ms]", "work", "error", "curvature", "energy"];
    let mut rows = vec![header.map(str::to_owned)];
    for (index, rung) in shown {
        let measured = &rung.measured;
        let mark = match (rung.front, report.best == Some(index)) {
            (_, true) => "►",
            (true, false) => "•",
            (false, false) => "",
        };
        rows.push([
            mark.to_owned(),
            rung.discretization.clone(),
            rung.cells.to_string(),
            rung.solver.clone(),
            human(1e3 * measured.seconds, 3),
            measured.work().to_string(),
            if rung.below_uncertainty {
                "below the reference's uncertainty".to_owned()
            } else {
                format!("{:.1e}", error(rung))
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
        report.rungs.len(),
        directory.join("cost.html").display(),
    );
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
