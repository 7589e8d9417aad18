//! `sweep.csv`: one row a run.

use std::collections::HashMap;
use std::io::{self, Write};

use super::Grid;
use super::journal::Record;
use super::leaves;
use crate::output::cell;

/// Keys of a summary that are no results of a run.
const LEFT_OUT: [&str; 3] = ["title.", "version.", "seconds."];

/// The names and texts of a run's results.
fn cells(record: &Record) -> Vec<(String, String)> {
    let mut cells = Vec::new();
    if let Some(summary) = &record.summary {
        leaves::visit(summary, "", &mut |path, text| {
            if !LEFT_OUT.iter().any(|key| format!("{path}.").starts_with(key)) {
                cells.push((path.to_owned(), text));
            }
        });
    }
    cells
}

/// The columns of all results, in an order that keeps the order of every run's own results.
#[derive(Default)]
pub(super) struct Columns(Vec<String>);

impl Columns {
    /// Makes room for the results of a run. Calls in the order of the runs give the same columns
    /// each time.
    pub fn add(&mut self, record: &Record) {
        let mut place = 0;
        for (name, _) in cells(record) {
            // Most runs have the columns of the one before, in the same places.
            if self.0.get(place) != Some(&name) {
                match self.0.iter().position(|column| *column == name) {
                    Some(found) => place = found,
                    None => self.0.insert(place, name),
                }
            }
            place += 1;
        }
    }
}

/// The table, written row by row.
pub(super) struct SweepTable<'a> {
    writer: csv::Writer<&'a mut dyn Write>,
    columns: HashMap<&'a str, usize>,
    grid: &'a Grid,
}

impl<'a> SweepTable<'a> {
    /// Writes the header.
    pub fn new(out: &'a mut dyn Write, grid: &'a Grid, columns: &'a Columns) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_field("run")?;
        grid.paths().try_for_each(|path| writer.write_field(cell(path).as_bytes()))?;
        writer.write_field("outcome")?;
        writer.write_field("message")?;
        columns.0.iter().try_for_each(|column| writer.write_field(column))?;
        writer.write_field("seconds")?;
        writer.write_record(None::<&[u8]>)?;
        let columns = columns.0.iter().enumerate().map(|(at, name)| (name.as_str(), at)).collect();
        Ok(Self { writer, columns, grid })
    }

    /// Writes the row of a run.
    pub fn row(&mut self, record: &Record) -> io::Result<()> {
        let mut row = vec![String::new(); self.columns.len()];
        for (name, text) in cells(record) {
            if let Some(place) = self.columns.get(name.as_str()) {
                row[*place] = text;
            }
        }
        let writer = &mut self.writer;
        writer.write_field(record.run.to_string())?;
        self.grid
            .values(record.run)
            .into_iter()
            .try_for_each(|value| writer.write_field(cell(value).as_bytes()))?;
        writer.write_field(record.outcome.name())?;
        writer.write_field(cell(record.message.as_deref().unwrap_or("")).as_bytes())?;
        row.iter().try_for_each(|text| writer.write_field(text))?;
        writer.write_field(format!("{:.6}", record.seconds))?;
        writer.write_record(None::<&[u8]>)?;
        Ok(())
    }

    /// Writes the rest to the file.
    pub fn finish(mut self) -> io::Result<()> {
        self.writer.flush()
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
        records.iter().for_each(|record| columns.add(record));
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
        let (columns, mut out) = (columns(&records), Vec::<u8>::new());
        let mut table = SweepTable::new(&mut out, &grid, &columns).unwrap();
        records.iter().for_each(|record| table.row(record).unwrap());
        table.finish().unwrap();
        let expected = "\
run,x.y,outcome,message,b.x,a.1,a.2,seconds
1,1,solved,,5.0000000000000000e-1,3,,0.500000
2,'=2,failed,no way on,,,,0.500000
3,3 N,solved,,,7,8,0.500000
";
        assert_eq!(String::from_utf8(out).unwrap(), expected);
    }

    /// A table as short as this one is kept until it is finished.
    #[test]
    fn a_table_that_cannot_be_written_is_an_error() {
        struct Full;

        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::Error::other("the disk is full"))
            }

            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }

        let grid = Grid::new(vec![Axis::parse("a=1").unwrap()]).unwrap();
        let (columns, mut full) = (Columns::default(), Full);
        let table = SweepTable::new(&mut full, &grid, &columns).unwrap();
        assert_eq!(table.finish().unwrap_err().to_string(), "the disk is full");
    }
}
