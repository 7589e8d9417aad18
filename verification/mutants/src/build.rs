//! Builds the copy, without the mutants that do not compile.

use std::collections::BTreeSet;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::ops::Range;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::Failure;
use crate::copy::Workshop;
use crate::splice::Spliced;

/// The packages that have tests in Rust, without those beside other codes.
const TESTED: [&str; 7] = ["test", "-p", "ancf", "-p", "ancf-check", "-p", "ancf-fuzz"];

/// A program of tests.
pub struct Program {
    /// Kind and name of the target, as in `lib ancf`.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// Its package's folder, which its tests expect to be in.
    pub folder: PathBuf,
    /// How it is asked for its tests and told which to run.
    pub harness: Harness,
}

/// What runs tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum Harness {
    /// That of `cargo test`, a part of the program.
    Rust,
    /// pytest; the program is the interpreter.
    Pytest,
}

/// The result of a build.
pub enum Built {
    /// The programs of tests; none where it was only checked.
    Programs(Vec<Program>),
    /// Mutants that do not compile.
    Unviable(BTreeSet<usize>),
}

/// Checks that the sources compile; quick.
pub fn check(workshop: &Workshop, spliced: &[(String, Spliced)]) -> Result<Built, Failure> {
    cargo(workshop, spliced, &["check", "-p", "ancf", "-p", "ancf-python", "--lib", "--bins"])
}

/// Builds the tests, and the Python module for its own.
pub fn tests(workshop: &Workshop, spliced: &[(String, Spliced)]) -> Result<Built, Failure> {
    let tests = [&TESTED[..], &["--lib", "--bins", "--test", "main", "--no-run"]].concat();
    let mut programs = match cargo(workshop, spliced, &tests)? {
        Built::Programs(programs) => programs,
        unviable => return Ok(unviable),
    };
    if let unviable @ Built::Unviable(_) = cargo(workshop, spliced, &["build", "-p", "ancf-python"])? {
        return Ok(unviable);
    }
    // Beside the half of the module that is written in Python, where its tests find it.
    let library = format!("{DLL_PREFIX}_ancf{DLL_SUFFIX}");
    let module = workshop.copy.join("src/python/ancf/_ancf.abi3.so");
    fs::copy(workshop.target.join("debug").join(library), module)?;
    programs.push(Program {
        name: "pytest".to_owned(),
        path: workshop.python.clone(),
        folder: workshop.copy.clone(),
        harness: Harness::Pytest,
    });
    Ok(Built::Programs(programs))
}

#[derive(Deserialize)]
struct Line {
    reason: String,
    message: Option<Message>,
    executable: Option<PathBuf>,
    manifest_path: Option<PathBuf>,
    profile: Option<Profile>,
    target: Option<Target>,
}

#[derive(Deserialize)]
struct Profile {
    test: bool,
}

#[derive(Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
}

#[derive(Deserialize)]
struct Message {
    level: String,
    rendered: Option<String>,
    spans: Vec<Place>,
    children: Vec<Message>,
}

#[derive(Deserialize)]
struct Place {
    file_name: String,
    byte_start: usize,
    byte_end: usize,
    is_primary: bool,
    expansion: Option<Box<Expansion>>,
}

#[derive(Deserialize)]
struct Expansion {
    span: Place,
}

impl Place {
    /// The place, and those of the macros that it comes from.
    fn chain(&self) -> Vec<(&str, Range<usize>)> {
        let mut chain = vec![(self.file_name.as_str(), self.byte_start..self.byte_end)];
        chain.extend(self.expansion.iter().flat_map(|e| e.span.chain()));
        chain
    }
}

impl Message {
    /// The mutants that the message is about: those at its primary places, otherwise those at its
    /// other places, otherwise those of the messages below it.
    fn blame(&self, spliced: &[(String, Spliced)]) -> BTreeSet<usize> {
        for primary in [true, false] {
            let places = self.spans.iter().filter(|place| place.is_primary == primary);
            let found: BTreeSet<usize> = places
                .flat_map(Place::chain)
                .filter_map(|(file, bytes)| Some((spliced.iter().find(|(own, _)| own == file)?, bytes)))
                .flat_map(|((_, text), bytes)| text.blame(&bytes))
                .collect();
            if !found.is_empty() {
                return found;
            }
        }
        self.children.iter().flat_map(|child| child.blame(spliced)).collect()
    }
}

fn cargo(workshop: &Workshop, spliced: &[(String, Spliced)], command: &[&str]) -> Result<Built, Failure> {
    let output = Command::new("cargo")
        .args(command)
        .args(["--message-format", "json", "--quiet"])
        .current_dir(&workshop.copy)
        .env("CARGO_TARGET_DIR", &workshop.target)
        .env("CARGO_INCREMENTAL", "0")
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("cargo cannot be started: {e}"))?;
    let text = String::from_utf8(output.stdout)?;
    let lines = text
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok())
        .filter_map(|value| serde_json::from_value::<Line>(value).ok());
    let (mut unviable, mut programs) = (BTreeSet::new(), Vec::new());
    for line in lines {
        if let Some(message) =
            line.message.filter(|m| line.reason == "compiler-message" && m.level == "error")
        {
            let blamed = message.blame(spliced);
            let said = message.rendered.unwrap_or_default();
            if blamed.is_empty() && !said.contains("aborting due to") {
                return Err(format!("the copy does not compile, and not by a mutant:\n{said}").into());
            }
            unviable.extend(blamed);
        }
        if let (Some(path), Some(manifest), Some(target)) = (line.executable, line.manifest_path, line.target)
            && line.profile.is_some_and(|p| p.test)
        {
            let folder = manifest.parent().map(PathBuf::from).unwrap_or_default();
            let name = format!("{} {}", target.kind.join(","), target.name);
            programs.push(Program { name, path, folder, harness: Harness::Rust });
        }
    }
    match (output.status.success(), unviable.is_empty()) {
        (true, _) => Ok(Built::Programs(programs)),
        (false, false) => Ok(Built::Unviable(unviable)),
        (false, true) => Err(format!("`cargo {}` failed", command.join(" ")).into()),
    }
}
