//! The page of instruction counts and their trend.

use std::path::Path;

use ancf::output::plot::{Axis, Chart, Mark, PALETTE, Series};
use askama::Template;

use super::page::Page;
use crate::Failure;
use crate::instructions::{Day, history};

#[derive(Template)]
#[template(path = "instructions.html")]
struct Body<'a> {
    last: Option<&'a Day>,
    lines: Vec<Line>,
    prices: Vec<[String; 3]>,
    drawing: Option<Result<String, String>>,
}

/// A run that is counted.
struct Line {
    name: String,
    count: String,
    /// Against the count before, and against the first.
    ratios: [String; 2],
}

/// Instructions of the runs of the list, day after day.
pub fn page(file: &Path) -> Result<Page, Failure> {
    let days = history(file)?;
    let last = days.last();
    let lines = last.map_or(Vec::new(), |day| day.counts.iter().map(|count| line(&days, count)).collect());
    let prices = last.map_or(Vec::new(), prices);
    let drawing = (days.len() > 1).then(|| trend(&days));
    Ok(Page {
        id: "instructions".into(),
        title: "Instructions".into(),
        pass: None,
        listed: true,
        body: Body { last, lines, prices, drawing }.render()?,
    })
}

fn earlier<'a>(days: &'a [Day], name: &'a str) -> impl DoubleEndedIterator<Item = (usize, f64)> + 'a {
    let of = move |day: &Day| day.counts.iter().find(|(n, _)| n == name).map(|(_, count)| *count);
    days.iter().enumerate().filter_map(move |(i, day)| Some((i, of(day)?)))
}

fn line(days: &[Day], (name, count): &(String, f64)) -> Line {
    let ratio =
        |other: Option<(usize, f64)>| other.map_or("–".to_owned(), |(_, o)| format!("{:.4}", count / o));
    let before = &days[..days.len() - 1];
    Line {
        name: name.clone(),
        count: format!("{count:.0}"),
        ratios: [ratio(earlier(before, name).next_back()), ratio(earlier(before, name).next())],
    }
}

/// Per effect its name, what it adds to a step, and that against the base; the base comes first.
fn prices(day: &Day) -> Vec<[String; 3]> {
    let Some((name, base)) = day.prices.first() else { return Vec::new() };
    let first = [name.clone(), format!("{base:.0}"), "1".to_owned()];
    let others = day.prices.iter().skip(1).map(|(name, with)| {
        [format!("with {name}"), format!("{:+.0}", with - base), format!("{:.3}", with / base)]
    });
    std::iter::once(first).chain(others).collect()
}

/// Every count relative to its first, over the number of the measurement.
fn trend(days: &[Day]) -> Result<String, String> {
    let names = days.last().map_or(&[][..], |day| &day.counts[..]).iter().map(|(name, _)| name);
    let series = names.enumerate().map(|(k, name)| {
        let counts: Vec<(usize, f64)> = earlier(days, name).collect();
        let first = counts.first().map_or(1.0, |(_, count)| *count);
        let points = counts.iter().map(|(i, count)| [*i as f64 + 1.0, count / first]).collect();
        Series::new(name.clone(), points, Mark::Line, PALETTE[k % PALETTE.len()])
    });
    let chart = Chart::new(
        "",
        Axis::linear("measurement").whole(),
        Axis::linear("instructions, relative to the first"),
    );
    let room = 20 * days.last().map_or(0, |day| day.counts.len()) as u32;
    series.fold(chart.sized(720, 260 + room), Chart::with).svg().map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_is_compared_with_the_last_and_the_first() {
        let day = |count: f64| Day {
            date: "d".into(),
            commit: "c".into(),
            counts: vec![("a".into(), count)],
            prices: Vec::new(),
        };
        let days = [day(200.0), day(100.0), day(50.0)];
        let line = line(&days, &days[2].counts[0]);
        assert_eq!(line.ratios, ["0.5000", "0.2500"]);
        assert!(trend(&days).expect("a drawing").contains("<svg"));
        let priced = Day { prices: vec![("base".into(), 100.0), ("drag".into(), 125.0)], ..day(1.0) };
        assert_eq!(prices(&priced)[1], ["with drag", "+25", "1.250"]);
    }
}
