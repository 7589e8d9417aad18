//! `sweep.csv`: one row a run.

use std::collections::HashMap;

use serde_json::Value;

use super::Grid;
use super::journal::Record;
use super::leaves;
use crate::output::cell;

/// Keys of a summary that are no results of a run.
const LEFT_OUT: [&str; 3] = ["title.", "version.", "seconds."];

/// Calls `see` with the name and the value of each of a run's results.
fn visit(record: &Record, see: &mut dyn FnMut(&str, &Value)) {
    let Some(summary) = &record.summary else { return };
    leaves::visit(summary, "", &mut |path, value| {
        if !LEFT_OUT.iter().any(|key| path.starts_with(key) || path == key.trim_end_matches('.')) {
            see(path, value);
        }
    });
}

/// The names of a run's results.
pub(super) fn names(record: &Record) -> Vec<String> {
    let mut names = Vec::new();
    visit(record, &mut |name, _| names.push(name.to_owned()));
    names
}

/// The columns of all results, in an order that keeps the order of every run's own results.
#[derive(Default)]
pub(super) struct Columns(Vec<String>);

impl Columns {
    /// Makes room for the results of a run by their [`names`]. Calls in the order of the runs give the same columns
    /// each time.
    pub fn add(&mut self, names: &[String]) {
        let mut place = 0;
        for name in names {
            // Most runs have the columns of the one before, in the same places.
            if self.0.get(place) != Some(name) {
                match self.0.iter().position(|column| column == name) {
                    Some(found) => place = found,
                    None => self.0.insert(place, name.clone()),
                }
            }
            place += 1;
        }
    }
}

/// The cells of the table.
pub(super) struct SweepTable<'a> {
    columns: &'a Columns,
    places: HashMap<&'a str, usize>,
    grid: &'a Grid,
}

impl<'a> SweepTable<'a> {
    pub fn new(grid: &'a Grid, columns: &'a Columns) -> Self {
        let places = columns.0.iter().enumerate().map(|(at, name)| (name.as_str(), at)).collect();
        Self { columns, places, grid }
    }

    /// The names of all columns.
    pub fn header(&self) -> Vec<String> {
        let mut header = vec!["run".to_owned()];
        header.extend(self.grid.paths().map(|path| cell(path).into_owned()));
        header.extend(["outcome", "message"].map(str::to_owned));
        header.extend(self.columns.0.iter().cloned());
        header.push("seconds".to_owned());
        header
    }

    /// The row of a run.
    pub fn row(&self, record: &Record) -> Vec<String> {
        let mut row = vec![record.run.to_string()];
        row.extend(self.grid.values(record.run).into_iter().map(|value| cell(value).into_owned()));
        row.push(record.outcome.name().to_owned());
        row.push(cell(record.message.as_deref().unwrap_or("")).into_owned());
        let first = row.len();
        row.resize(first + self.columns.0.len(), String::new());
        visit(record, &mut |name, value| {
            if let Some(place) = self.places.get(name) {
                row[first + place] = leaves::text(value);
            }
        });
        row.push(format!("{:.6}", record.seconds));
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{Axis, Outcome};

    fn record(run: usize, summary: &str) -> Record {
        let summary = Some(serde_json::from_str(summary).unwrap());
        Record { run, outcome: Outcome::Solved, message: None, seconds: 0.5, summary }
    }

    fn columns(records: &[Record]) -> Columns {
        let mut columns = Columns::default();
        records.iter().for_each(|record| columns.add(&names(record)));
        columns
    }

    #[test]
    fn columns_keep_the_order_that_runs_give_them() {
        let summaries = [r#"{"a":1,"b":2,"d":4}"#, r#"{"a":1,"c":3,"d":4}"#, r#"{"b":5,"e":6}"#];
        let records = summaries.map(|summary| record(1, summary));
        assert_eq!(columns(&records).0, ["a", "c", "b", "e", "d"]);
    }

    #[test]
    fn rows_hold_results_under_their_names() {
        let failed = Record {
            outcome: Outcome::Failed,
            message: Some("no way on".into()),
            summary: None,
            ..record(2, "0")
        };
        let solved = r#"{"title":"t","b":{"x":0.5},"a":[3,null],"version":"0","seconds":{"solve":1.5}}"#;
        let records = [record(1, solved), failed, record(3, r#"{"a":[7,8]}"#)];
        let grid = Grid::new(vec![Axis::parse("x.y=1,=2,3 N").unwrap()]).unwrap();
        let columns = columns(&records);
        let table = SweepTable::new(&grid, &columns);
        let rows = records.iter().map(|record| table.row(record));
        let found: Vec<String> =
            [table.header()].into_iter().chain(rows).map(|row| row.join(",") + "\n").collect();
        let expected = "\
run,x.y,outcome,message,b.x,a.1,a.2,seconds
1,1,solved,,5.0000000000000000e-1,3,,0.500000
2,'=2,failed,no way on,,,,0.500000
3,3 N,solved,,,7,8,0.500000
";
        assert_eq!(found.concat(), expected);
    }
}
