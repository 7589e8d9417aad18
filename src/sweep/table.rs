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

/// The columns of all results, in an order that keeps the one that each run gives its own.
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
pub(super) struct Table<'a> {
    writer: csv::Writer<&'a mut dyn Write>,
    columns: HashMap<&'a str, usize>,
    grid: &'a Grid,
}

impl<'a> Table<'a> {
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

    /// Writes what is left.
    pub fn finish(mut self) -> io::Result<()> {
        self.writer.flush()
    }
}
