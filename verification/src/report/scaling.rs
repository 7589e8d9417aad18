//! The page of time and memory over the number of elements.

use std::path::Path;

use ancf::output::plot::{Axis, Chart, Mark, PALETTE, Series};
use askama::Template;

use super::page::Page;
use crate::Failure;
use crate::scaling::{Floor, Memory, Row, Scaling, read};

/// Growth of the cost per element that is wanted at most, from the fewest elements to the most.
const WANTED: f64 = 1.5;

#[derive(Template)]
#[template(path = "scaling.html")]
struct Body<'a> {
    measured: Option<&'a Scaling>,
    /// Elements, time of a step and before it, memory, iterations, bytes moved and their share, gain of a
    /// second thread.
    rows: Vec<[String; 8]>,
    /// Bytes and operations a nanosecond at best.
    best: Option<[String; 2]>,
    /// Beam, what is timed, operations, time, share of the best.
    floors: Vec<[String; 5]>,
    /// Code, analysis, bytes per element or why they are not known, class of that.
    memory: Vec<[String; 4]>,
    growth: String,
    wanted: f64,
    drawing: Result<String, String>,
}

/// What a step costs per element.
pub fn page(file: &Path) -> Result<Page, Failure> {
    let measured = read(file)?;
    let rows = measured.as_ref().map_or(&[][..], |m| &m.rows);
    let growth = rows.first().zip(rows.last()).map(|(first, last)| last.seconds / first.seconds);
    let points = rows.iter().map(|row| [row.elements as f64, 1e6 * row.seconds]).collect();
    let highest = rows.iter().fold(0.0_f64, |m, row| m.max(1.2e6 * row.seconds));
    let axes = (Axis::log("elements"), Axis::linear("µs per element and step").range(0.0, highest));
    let line = Series::new("", points, Mark::Line, PALETTE[0]);
    let drawing = Chart::new("", axes.0, axes.1).sized(560, 280).with(line).svg().map_err(|e| e.to_string());
    let best = measured.as_ref().map(|m| m.best).filter(|best| best.bytes > 0.0);
    let share = |row: &Row| best.map_or("–".to_owned(), |best| format!("{:.2}", row.of_stream(best)));
    let floor = |floor: &Floor| {
        let share = best.map(|best| floor.operations / (best.operations * floor.seconds));
        [
            floor.beam.clone(),
            floor.what.clone(),
            format!("{:.0}", floor.operations),
            format!("{:.1}", 1e9 * floor.seconds),
            share.map_or("–".to_owned(), |share| format!("{share:.2}")),
        ]
    };
    let memory = |memory: &Memory| {
        let (bytes, class) = match &memory.bytes {
            Ok(bytes) => (format!("{bytes:.0}"), ""),
            Err(why) => (why.clone(), "why"),
        };
        [memory.code.name().to_owned(), memory.analysis.clone(), bytes, class.to_owned()]
    };
    Ok(Page {
        id: "scaling".into(),
        title: "Many elements".into(),
        pass: growth.map(|growth| growth <= WANTED),
        listed: true,
        body: Body {
            measured: measured.as_ref(),
            rows: rows
                .iter()
                .map(|row| {
                    [
                        row.elements.to_string(),
                        format!("{:.3}", 1e6 * row.seconds),
                        format!("{:.2}", 1e6 * row.start),
                        row.megabytes.map_or("–".to_owned(), |m| format!("{m:.0}")),
                        format!("{:.1}", row.iterations),
                        format!("{:.0}", row.bytes),
                        share(row),
                        row.gain(),
                    ]
                })
                .collect(),
            best: best.map(|best| [best.bytes, best.operations].map(|rate| format!("{:.1}", 1e-9 * rate))),
            memory: measured.iter().flat_map(|m| &m.memory).map(memory).collect(),
            floors: measured.iter().flat_map(|m| &m.floors).map(floor).collect(),
            growth: growth.map_or("–".to_owned(), |g| format!("{g:.2}")),
            wanted: WANTED,
            drawing,
        }
        .render()?,
    })
}
