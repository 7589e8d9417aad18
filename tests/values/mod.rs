//! Values of what is read and written: each key of a scene and each column of a file against closed
//! forms and hand calculation.
//!
//! Expected numbers come from rigid motions, cuts through statically determinate beams, Euler's
//! beams and systems of one degree of freedom, with numbers so chosen that a swapped axis, a sign,
//! a factor or a neighbouring index gives another result. `keys.toml` and `columns.toml` say which
//! test looks at what; [`covered`] holds them against the schema and the headers.

mod actuators;
mod bent;
mod bounds;
mod covered;
mod effects;
mod electrodes;
mod energies;
mod events;
mod fault_parts;
mod faults;
mod fields;
mod files;
mod folds;
mod laws;
mod locking;
mod memory;
mod modes;
mod observers;
mod obstacles;
mod pictures;
mod records;
mod refusals;
mod sections;
mod settings;
mod shapes;
mod stages;
mod starts;
mod stretches;
mod studies;
mod tendons;
mod time;
mod units;
mod warnings;
mod words;

use ancf::output::{OutputOptions, write};
use ancf::scene::parse;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The files that a scene leaves.
pub(crate) struct Written(TempDir);

impl Written {
    /// Reads, solves and writes as `ancf run` does.
    pub(crate) fn of(text: &str) -> Self {
        let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let solved = ancf::accuracy::run(&scene, ancf::Options::default());
        let mut trajectory = solved.unwrap_or_else(|error| panic!("{error}\n{text}"));
        let options = OutputOptions { states: scene.output().states, vtu: scene.output().vtu };
        let folder = tempfile::tempdir().expect("a folder");
        write(folder.path(), &mut trajectory, &options).expect("files");
        Self(folder)
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.0.path().join(file)
    }

    pub(crate) fn text(&self, file: &str) -> String {
        fs::read_to_string(self.path(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    }

    pub(crate) fn summary(&self) -> serde_json::Value {
        serde_json::from_str(&self.text("summary.json")).expect("JSON")
    }

    /// The number at a path of `summary.json`, such as `/energy/work`.
    pub(crate) fn said(&self, pointer: &str) -> f64 {
        let summary = self.summary();
        let value = summary.pointer(pointer).and_then(serde_json::Value::as_f64);
        value.unwrap_or_else(|| panic!("no number {pointer} in {summary}"))
    }

    pub(crate) fn header(&self, file: &str) -> Vec<String> {
        header(&self.path(file))
    }

    /// The numbers of a column.
    pub(crate) fn column(&self, file: &str, name: &str) -> Vec<f64> {
        let number = |cell: &String| cell.parse().unwrap_or_else(|_| panic!("{file}, {name}: {cell}"));
        column(&self.path(file), name).iter().map(number).collect()
    }

    pub(crate) fn words(&self, file: &str, name: &str) -> Vec<String> {
        column(&self.path(file), name)
    }

    /// The last number of a column.
    pub(crate) fn last(&self, file: &str, name: &str) -> f64 {
        *self.column(file, name).last().expect("a row")
    }

    /// Holds the last numbers of columns against expected ones.
    pub(crate) fn ends(&self, file: &str, expected: &[(&str, f64)], tolerance: f64) {
        for (name, expected) in expected {
            near(self.last(file, name), *expected, tolerance, &format!("{file}, {name}"));
        }
    }
}

/// The names of a table's columns.
pub(crate) fn header(path: &Path) -> Vec<String> {
    let mut reader = csv::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    reader.headers().expect("a header").iter().map(str::to_owned).collect()
}

/// The cells of a column.
pub(crate) fn column(path: &Path, name: &str) -> Vec<String> {
    let names = header(path);
    let at = names.iter().position(|n| n == name);
    let at = at.unwrap_or_else(|| panic!("{}: no column {name} in {names:?}", path.display()));
    let mut reader = csv::Reader::from_path(path).expect("a table");
    reader.records().map(|row| row.expect("a row")[at].to_owned()).collect()
}

pub(crate) fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance, "{what}: {found}, not {expected}");
}

/// A beam without supports from (0, 0) to (1, 0), 2 kg, so stiff that it moves as a rigid body
/// under the loads of these tests.
pub(crate) const ROD: &str = "beam.rod = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, \
    bending_stiffness = 1e4, mass_per_length = 2, basis.ancf.elements = 2 }
    probe = [{ name = 'start', beam = 'rod', at = 'start' }, { name = 'middle', beam = 'rod', at = 0.5 }, \
    { name = 'end', beam = 'rod', at = 'end' }]\n";

/// A second of its motion.
pub(crate) const SECOND: &str =
    "analysis.dynamic = { duration = 1, output_every = 0.25, radau.tolerance = 1e-9 }\n";
