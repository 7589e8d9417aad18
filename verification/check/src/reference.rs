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

/// How the numbers came about.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Name of the oracle.
    pub oracle: String,
    /// A few words.
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
    /// What was typed, from the root of the repository.
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

fn same(cell: &str, wanted: &str) -> bool {
    match (cell.trim().parse::<f64>(), wanted.trim().parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 1e-12 * a.abs().max(b.abs()),
        _ => cell.trim() == wanted.trim(),
    }
}
