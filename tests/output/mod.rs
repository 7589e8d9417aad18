//! What trajectories whose numbers are made up leave: pictures, pages and tables, held against
//! these numbers, and against snapshots. Accept a wanted change with `cargo insta review`; to look
//! at pictures before, `ANCF_PICTURES=FOLDER cargo test --test main output::` writes them there.

mod axes;
mod charts;
mod figures;
mod made_up;
mod movie;
mod page;
mod picture;
mod replaced;
mod tables;

use ancf::output::{OutputOptions, write};
use ancf::results::Results;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Texts by the names of their files.
type Files = BTreeMap<String, String>;

/// What results leave.
fn written(results: &(impl Clone + Into<Results>)) -> Files {
    with_options(results, OutputOptions::default())
}

/// What it leaves with all that can be asked for.
fn written_in_full(results: &(impl Clone + Into<Results>)) -> Files {
    with_options(results, OutputOptions { states: true, vtu: true })
}

fn with_options(results: &(impl Clone + Into<Results>), options: OutputOptions) -> Files {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &mut results.clone().into(), &options).expect("files");
    let mut files = Files::new();
    collect(folder.path(), "", &mut files);
    files
}

fn collect(folder: &Path, before: &str, files: &mut Files) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry")) {
        let name = format!("{before}{}", entry.file_name().display());
        if entry.path().is_dir() {
            collect(&entry.path(), &format!("{name}/"), files);
        } else {
            files.insert(name, fs::read_to_string(entry.path()).expect("a text"));
        }
    }
}

/// Writes a picture for who wants to look at it.
fn show(name: &str, svg: &str) {
    if let Some(folder) = std::env::var_os("ANCF_PICTURES") {
        fs::create_dir_all(&folder).expect("a folder");
        let name = name.replace([' ', '/'], "-");
        fs::write(Path::new(&folder).join(name), svg).expect("a picture");
    }
}

fn snapshot(name: &str, text: &str) {
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!(name, text);
    });
}
