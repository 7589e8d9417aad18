//! Reference data: one table of numbers with its provenance.

use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::case::{Class, Scalar};
use crate::{Error, Result};

/// `reference_data/<case>/<oracle>.csv`.
#[derive(Clone, Debug)]
pub struct Table {
    /// The file.
    pub path: PathBuf,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// `<oracle>.provenance.toml`.
    pub provenance: Provenance,
}

/// The origin of the numbers.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Name of the oracle.
    pub oracle: String,
    /// A title of a few words.
    pub title: String,
    /// How much it can be trusted.
    pub class: Class,
    /// Literature, or the formula's name.
    pub citation: String,
    /// What a reader of the numbers must know.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Programs and versions that made the numbers.
    pub tool: String,
    /// The command that was typed in the root of the repository.
    pub command: String,
    /// Day on which the numbers were made.
    pub date: String,
    /// Machine and system.
    pub platform: String,
    /// SHA-256 of the table.
    pub csv_sha256: String,
    /// What the table was made from: file, from the root of the repository → SHA-256.
    pub inputs: IndexMap<String, String>,
}

/// SHA-256 of some bytes as hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The provenance file that belongs to a table.
pub fn provenance_path(csv: &Path) -> PathBuf {
    csv.with_extension("provenance.toml")
}

impl Table {
    /// Reads a table and its provenance.
    pub fn read(path: &Path) -> Result<Self> {
        let format = |path: &Path, message: String| Error::Format { path: path.to_owned(), message };
        let read = |path: &Path| {
            std::fs::read_to_string(path).map_err(|source| Error::Read { path: path.to_owned(), source })
        };
        let text = read(path)?;
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let columns: Vec<String> =
            reader.headers().map_err(|e| format(path, e.to_string()))?.iter().map(str::to_owned).collect();
        let rows = reader
            .records()
            .map(|record| {
                Ok(record.map_err(|e| format(path, e.to_string()))?.iter().map(str::to_owned).collect())
            })
            .collect::<Result<Vec<Vec<String>>>>()?;
        let source = provenance_path(path);
        let provenance = toml::from_str(&read(&source)?).map_err(|e| format(&source, e.to_string()))?;
        Ok(Self { path: path.to_owned(), columns, rows, provenance })
    }

    /// The rows that have all these values; numbers are compared as numbers.
    pub fn matching(&self, wanted: &[(String, Scalar)]) -> std::result::Result<Vec<&[String]>, String> {
        let wanted = wanted
            .iter()
            .map(|(name, value)| Ok((self.column(name)?, value.to_string())))
            .collect::<std::result::Result<Vec<_>, String>>()?;
        Ok(self
            .rows
            .iter()
            .filter(|row| wanted.iter().all(|(k, v)| row.get(*k).is_some_and(|cell| same(cell, v))))
            .map(Vec::as_slice)
            .collect())
    }

    /// The numbers of one column in some rows.
    pub fn numbers(&self, name: &str, rows: &[&[String]]) -> std::result::Result<Vec<f64>, String> {
        let column = self.column(name)?;
        rows.iter()
            .map(|row| {
                let cell = row.get(column).map_or("", String::as_str);
                match cell.trim().parse::<f64>() {
                    Ok(v) if v.is_finite() => Ok(v),
                    _ => Err(format!("{}, column `{name}`: `{cell}` is not a number", self.path.display())),
                }
            })
            .collect()
    }

    fn column(&self, name: &str) -> std::result::Result<usize, String> {
        self.columns.iter().position(|c| c == name).ok_or_else(|| {
            format!(
                "{} has no column `{name}`; it has {}",
                self.path.display(),
                crate::case::list(self.columns.iter())
            )
        })
    }
}

/// Part of a column's largest number by which another processor's round-off may change its numbers.
const ROUND_OFF: f64 = 1e-9;
/// Two units of the last of the twelve decimals that many oracles print. It is needed in a column
/// that is zero but for round-off, where the largest number means nothing.
const LAST_DECIMAL: f64 = 2e-12;

/// The difference between a table made today and the frozen one, if it is more than the round-off
/// of another processor: other words, or numbers that differ by more than 1e-9 of their column's
/// largest. `None` if there is no such difference.
pub fn difference(today: &str, frozen: &str) -> Option<String> {
    let rows = |text: &str| -> Vec<Vec<String>> {
        text.lines().map(|line| line.split(',').map(|cell| cell.trim().to_owned()).collect()).collect()
    };
    let (today, frozen) = (rows(today), rows(frozen));
    if today.len() != frozen.len() {
        return Some(format!("{} lines today, {} frozen", today.len(), frozen.len()));
    }
    let largest = |column: usize| {
        let cells = frozen.iter().filter_map(|row| row.get(column)?.parse::<f64>().ok());
        cells.filter(|value| value.is_finite()).fold(0.0_f64, |m, value| m.max(value.abs()))
    };
    let columns = frozen.iter().map(Vec::len).max().unwrap_or(0);
    let allowed: Vec<f64> = (0..columns).map(|k| ROUND_OFF * largest(k) + LAST_DECIMAL).collect();
    today.iter().zip(&frozen).find_map(|(a, b)| {
        let same = a.len() == b.len()
            && a.iter().zip(b).zip(&allowed).all(|((a, b), allowed)| {
                match (a.parse::<f64>(), b.parse::<f64>()) {
                    (Ok(a), Ok(b)) => (a - b).abs() <= *allowed,
                    _ => a == b,
                }
            });
        (!same).then(|| format!("today {}, frozen {}", a.join(","), b.join(",")))
    })
}

fn same(cell: &str, wanted: &str) -> bool {
    match (cell.trim().parse::<f64>(), wanted.trim().parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 1e-12 * a.abs().max(b.abs()),
        _ => cell.trim() == wanted.trim(),
    }
}

#[cfg(test)]
mod tests {
    use super::difference;

    const FROZEN: &str = "load,x,y\n1,0.500000000000,1e-17\n2,-20.0,3e-16\n";

    /// Would catch a comparison that overlooks a digit, a row, a column or a word, and one that
    /// takes round-off for a difference, be it in the last decimal or of a number that is zero.
    #[test]
    fn round_off_is_no_difference_and_a_digit_is() {
        for same in [
            FROZEN,
            "load,x,y\n1,0.500000000001,-4e-16\n2,-20.0,0.0\n",
            "load,x,y\r\n1.0,0.5,1e-17\r\n2,-2.00000000001e1,3e-16\r\n",
        ] {
            assert_eq!(difference(same, FROZEN), None);
        }
        for other in [
            "load,x,y\n1,0.50000003,1e-17\n2,-20.0,3e-16\n",
            "load,x,y\n1,0.5,1e-11\n2,-20.0,3e-16\n",
            "load,x,y\n1,0.5,1e-17\n2,20.0,3e-16\n",
            "load,x,y\n1,0.5,1e-17\n2,nan,3e-16\n",
            "load,x,y\n1,0.5,1e-17\n",
            "load,x\n1,0.5\n2,-20.0\n",
            "load,x,z\n1,0.5,1e-17\n2,-20.0,3e-16\n",
        ] {
            assert!(difference(other, FROZEN).is_some(), "{other}");
        }
    }
}
