//! The solver against `reference_data`: every case under `verification/cases`, every number of it.
//!
//! Cases, tolerances and the reasons for them are read from the case folders; there is no list here
//! to keep up to date.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use ancf_check::{Suite, audit, examine};

#[test]
fn every_case_keeps_its_claims() {
    examine_all(|nightly| !nightly);
}

#[test]
#[ignore = "takes minutes"]
fn every_long_case_keeps_its_claims() {
    examine_all(|nightly| nightly);
}

/// Examines the cases whose `nightly` is wanted, on all cores.
fn examine_all(wanted: impl Fn(bool) -> bool) {
    let suite = Suite::here();
    let mut names = suite.names().expect("verification/cases can be read");
    assert!(!names.is_empty(), "there are no cases in {}", suite.cases_folder().display());
    // What cannot be read is reported by those that are always run.
    names.retain(|name| wanted(suite.case(name).is_ok_and(|case| case.text.nightly)));

    let next = AtomicUsize::new(0);
    let found = Mutex::new((0, Vec::new()));
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(name) = names.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let examined = examine(&suite, name);
                    let mut found = found.lock().expect("no other thread panics while it holds this");
                    match examined {
                        Ok(examined) => {
                            found.0 += examined.outcomes.len();
                            let failed = examined.outcomes.iter().filter(|o| !o.verdict.passed());
                            found.1.extend(failed.map(|o| o.line(name)));
                        }
                        Err(error) => found.1.push(error.to_string()),
                    }
                }
            });
        }
    });
    let (compared, mut failed) = found.into_inner().expect("no thread panicked");
    failed.sort();
    assert!(
        failed.is_empty(),
        "{} of {compared} comparisons failed:\n{}\n`cargo run -p ancf-verification -- report` shows them in full",
        failed.len(),
        failed.join("\n")
    );
    println!("{} cases, {compared} comparisons", names.len());
}

#[test]
fn every_case_and_every_reference_is_used_and_none_was_edited() {
    let problems = audit(&Suite::here()).expect("verification and reference_data can be read");
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
