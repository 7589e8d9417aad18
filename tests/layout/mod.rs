//! Modules import what the table on the crate's front page says, and all that it says.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

type Imports = BTreeMap<String, BTreeSet<String>>;

/// Modules and what they import, in the order of the table in `src/lib.rs`.
fn stated(front_page: &str) -> (Vec<String>, Imports) {
    // Every second part is between two backticks.
    let named =
        |cell: &str| -> BTreeSet<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let rows = front_page.split_once("| module | subject | imports |").expect("the table").1;
    let rows = rows.lines().skip(2).take_while(|line| line.starts_with("//! |"));
    let (mut order, mut imports) = (Vec::new(), Imports::new());
    for row in rows {
        let cells: Vec<&str> = row.split('|').collect();
        let [_, name, _, depends, _] = cells[..] else { panic!("three cells in {row}") };
        let name = named(name).pop_first().expect("a module");
        imports.insert(name.clone(), named(depends));
        order.push(name);
    }
    (order, imports)
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            sources(&entry, found);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
}

/// What the sources import from each other, without comments and without their own tests.
fn imported(root: &Path, modules: &[String]) -> Imports {
    let mut files = Vec::new();
    sources(root, &mut files);
    let mut imports: Imports = modules.iter().map(|name| (name.clone(), BTreeSet::new())).collect();
    for file in files {
        let first = file.strip_prefix(root).expect("below the root").components().next().expect("a name");
        let first = first.as_os_str().to_string_lossy();
        let Some(own) = imports.get_mut(first.trim_end_matches(".rs")) else { continue };
        let text = fs::read_to_string(&file).expect("a source");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let code: Vec<&str> = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        for rest in code.join("\n").split("crate::").skip(1) {
            let end = match rest.strip_prefix('{') {
                Some(list) => 1 + list.find("};").expect("a closed list"),
                None => rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len()),
            };
            let names = rest[..end].split(|c: char| !c.is_alphanumeric() && c != '_');
            let known = names.filter(|name| modules.iter().any(|module| module == name));
            own.extend(known.filter(|name| *name != first.trim_end_matches(".rs")).map(str::to_owned));
        }
    }
    imports
}

#[test]
fn modules_import_what_the_front_page_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let front_page = fs::read_to_string(root.join("lib.rs")).expect("the front page");
    let (order, stated) = stated(&front_page);
    assert!(order.len() > 10, "{order:?}");
    for (module, imports) in imported(&root, &order) {
        assert_eq!(imports, stated[&module], "what {module} imports, and what src/lib.rs says");
    }
    // None imports what stands below it.
    let place = |name: &str| order.iter().position(|module| module == name).expect("a row");
    let upwards: Vec<(&str, &str)> = stated
        .iter()
        .flat_map(|(module, imports)| imports.iter().map(move |other| (module.as_str(), other.as_str())))
        .filter(|(module, other)| place(other) > place(module))
        .collect();
    assert_eq!(upwards, [], "imports from below their place");
}
