//! `verify browser`: the pages in a real browser.
//!
//! Runs, a cost study and a sweep are made anew; `browser/look.py` opens their pages and the
//! report's in Chromium, and says what is wrong: messages on the console, pictures without a size
//! or with nothing in them, movies that do not advance or do not stop, numbers that are not those
//! of the files beside them. With `prove`, pages that are damaged in each of these ways must be
//! found out.

use std::path::{Path, PathBuf};
use std::time::Duration;

use ancf::cost;
use ancf::output::{self, OutputOptions};
use ancf::run::Control;
use ancf::scene::Scene;
use ancf::sweep::{self, Axis, Shard, Sweep};
use ancf_check::Suite;
use ancf_verification::{Failure, bridge};
use serde::{Deserialize, Serialize};

use crate::report;

/// Where pages, pictures of them and `found.json` are written, from the root of the repository.
pub const FOLDER: &str = "target/verification/browser";

/// A page of every kind: few states and many, vibrations, critical loads, a path that turns back,
/// obstacles, several beams.
const RUNS: [(&str, &str); 8] = [
    ("roll-up", "verification/cases/roll-up-shapes/rpim.toml"),
    ("soft-pendulum", "tests/scenes/soft-pendulum.toml"),
    ("modal", "tests/scenes/modal.toml"),
    ("euler-column", "verification/cases/euler-column/scene.toml"),
    ("shallow-arch", "verification/cases/hard-shallow-arch/scene.toml"),
    ("contact-circle", "verification/cases/contact-circle/scene.toml"),
    ("bounce", "verification/cases/bounce/scene.toml"),
    ("slider-crank", "verification/cases/slider-crank/scene.toml"),
];
/// The scene of the cost study and of the sweep.
const STATIC: &str = "tests/scenes/tip-load.toml";
const SWEPT: &str = "effect.force.0.value";
const LOADS: [&str; 2] = ["[0.0, -1.0]", "[0.0, -4.0]"];
/// Cases of the report where none is given: one that compares curves, a hard one, and a grid.
const CASES: [&str; 4] = ["distributed-load", "euler-column", "hard-shape-parameter", "roll-up-table-4"];
/// Pages of the report of which a picture is kept.
const PICTURES: [&str; 4] = ["overview", "hard-cases", "distributed-load", "roll-up-table-4"];

/// What is replaced in the page of a falling pendulum, by what, and the problem that must then be
/// found.
const DAMAGES: [(&str, &str, &str); 10] = [
    ("\"use strict\";", "\"use strict\"; console.warn(\"a message\");", "console: "),
    ("const margin = 26;", "const margin = missing;", "console: "),
    ("<svg ", "<svg style=\"height: 0\" ", "picture: "),
    (" stroke=\"#", " was=\"#", "has nothing in it"),
    ("context.stroke();", "", "(canvas, ) has nothing in it"),
    ("    draw();\n    requestAnimationFrame(tick);", "    requestAnimationFrame(tick);", "does not advance"),
    ("{ frame = last; stop(); }", "frame = last;", "after its end"),
    ("(started === null ? play() : stop())", "play()", "when it was stopped"),
    ("<td>tip</td><td>", "<td>tip</td><td>9", "number: tip.x"),
    ("\"cell\":0.", "\"cell\":1.", "beside the movie's beams"),
];

/// The question that `browser/look.py` reads.
#[derive(Serialize)]
struct Wanted {
    screenshots: PathBuf,
    pages: Vec<Page>,
}

#[derive(Clone, Serialize)]
struct Page {
    name: String,
    #[serde(flatten)]
    kind: Kind,
    file: PathBuf,
}

#[derive(Clone, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
enum Kind {
    Run {
        #[serde(flatten)]
        row: Option<Row>,
    },
    Cost,
    Report {
        json: PathBuf,
        pictures: Vec<&'static str>,
    },
}

/// A row of a sweep's table, counted from 0.
#[derive(Clone, Serialize)]
struct Row {
    sweep: PathBuf,
    row: usize,
}

/// The answer that it prints.
#[derive(Deserialize)]
struct Found {
    browser: String,
    pages: Vec<Seen>,
}

#[derive(Deserialize)]
struct Seen {
    name: String,
    problems: Vec<String>,
    pictures: usize,
    numbers: usize,
    frames: usize,
}

/// Looks at the pages, those of `report` among them or else of a report on some cases; the answer
/// is whether nothing is wrong.
pub fn print(suite: &Suite, report: Option<&Path>, prove: bool) -> Result<bool, Failure> {
    let folder = suite.root.join(FOLDER);
    // The pages of an earlier version must not be looked at.
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    }
    let mut pages = Vec::new();
    for (name, scene) in RUNS {
        let kind = Kind::Run { row: None };
        pages.push(solved(name, kind, &suite.root.join(scene), &[], &folder)?);
    }
    let scene = suite.root.join(STATIC);
    pages.push(priced(&scene, &folder.join("cost"))?);
    pages.extend(swept(&scene, &folder)?);
    let index = match report {
        Some(file) => file.to_owned(),
        None => {
            let folder = folder.join("report");
            let names = CASES.map(str::to_owned);
            report::write(suite, &folder, None, &names)?;
            folder.join("index.html")
        }
    };
    let kind = Kind::Report { json: index.with_file_name("report.json"), pictures: PICTURES.to_vec() };
    pages.push(Page { name: "report".into(), kind, file: index });

    let found = look(suite, &folder, "pages", pages)?;
    println!("{}", found.browser);
    for seen in &found.pages {
        let Seen { name, pictures, numbers, frames, problems } = seen;
        println!("{name}: {pictures} pictures, {numbers} numbers, {frames} frames of a movie seen");
        problems.iter().for_each(|problem| println!("  WRONG {problem}"));
    }
    println!("{}", folder.join("pages").display());
    let whole = found.pages.iter().all(|seen| seen.problems.is_empty());
    Ok(whole & (!prove || proven(suite, &folder)?))
}

/// Whether every damage is found out.
fn proven(suite: &Suite, folder: &Path) -> Result<bool, Failure> {
    let set = ["analysis.dynamic.duration=\"0.5 s\"".to_owned()];
    let scene = suite.root.join("tests/scenes/soft-pendulum.toml");
    let mut pages = Vec::new();
    for (number, (from, to, _)) in DAMAGES.iter().enumerate() {
        let name = format!("damaged-{number}");
        let page = solved(&name, Kind::Run { row: None }, &scene, &set, folder)?;
        let text = std::fs::read_to_string(&page.file)?;
        if !text.contains(from) {
            return Err(format!("{} has no `{from}` that could be damaged", page.file.display()).into());
        }
        std::fs::write(&page.file, text.replace(from, to))?;
        pages.push(page);
    }
    let found = look(suite, folder, "damaged", pages)?;
    let mut all = true;
    for ((from, to, expected), seen) in DAMAGES.iter().zip(&found.pages) {
        let out = seen.problems.iter().any(|problem| problem.contains(expected));
        all &= out;
        let word = if out { "found out" } else { "NOT FOUND OUT" };
        println!("`{from}` → `{to}`: {word}: {}", seen.problems.join("; "));
    }
    Ok(all)
}

/// Runs a scene; its page lies in a folder of this name.
fn solved(name: &str, kind: Kind, scene: &Path, set: &[String], folder: &Path) -> Result<Page, Failure> {
    let folder = folder.join(name);
    let scene = Scene::load(scene, set).map_err(|e| e.to_string())?;
    let mut results =
        scene.model().solve(scene.analysis()).map_err(|error| format!("{}: {error}", scene.name()))?;
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    output::write(&folder, &mut results, &OutputOptions::default())?;
    Ok(Page { name: name.to_owned(), kind, file: folder.join("report.html") })
}

fn priced(scene: &Path, folder: &Path) -> Result<Page, Failure> {
    let scene = Scene::load(scene, &[]).map_err(|e| e.to_string())?;
    let options = cost::Options { target: 1e-4, budget: Duration::from_secs(5) };
    let study = cost::study(&scene, options, &|_| Control::Continue)?;
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    cost::write(folder, &study)?;
    Ok(Page { name: "cost".into(), kind: Kind::Cost, file: folder.join("cost.html") })
}

/// A sweep has a table and no page: each row is held against the page of the same run alone.
fn swept(scene: &Path, folder: &Path) -> Result<Vec<Page>, Failure> {
    let directory = folder.join("sweep");
    std::fs::create_dir_all(&directory).map_err(|e| format!("{}: {e}", directory.display()))?;
    let axis = Axis::parse(&format!("{SWEPT}={}", LOADS.join(",")))?;
    let sweep = Sweep::new(scene, &[], vec![axis], 0)?;
    sweep.run(&directory, Shard::WHOLE, &mut |_| Control::Continue)?;
    let table = sweep::merge(&directory)?.table;
    let page = |(row, load): (usize, &str)| {
        let kind = Kind::Run { row: Some(Row { sweep: table.clone(), row }) };
        solved(&format!("sweep-{}", row + 1), kind, scene, &[format!("{SWEPT}={load}")], folder)
    };
    LOADS.into_iter().enumerate().map(page).collect()
}

/// Asks `browser/look.py`; its question, its answer and its pictures stay in the folder.
fn look(suite: &Suite, folder: &Path, name: &str, pages: Vec<Page>) -> Result<Found, Failure> {
    let question = folder.join(format!("{name}.json"));
    let wanted = Wanted { screenshots: folder.join(name), pages };
    std::fs::write(&question, serde_json::to_string_pretty(&wanted)?)?;
    let script = suite.root.join("verification/browser/look.py");
    let answer = bridge::environment()?.run(&script, &[question.to_string_lossy().into_owned()])?;
    std::fs::write(folder.join(format!("{name}-found.json")), &answer)?;
    Ok(serde_json::from_str(&answer)?)
}
