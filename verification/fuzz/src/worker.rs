//! The process that tries the inputs.

use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use fastrand::Rng;

use crate::exercise;
use crate::{Arguments, MEMORY, damage};

/// The file that holds the present input.
pub const IN_HAND: &str = "in-hand.txt";

/// Tries inputs until the time is over.
pub fn work(arguments: &Arguments) -> ExitCode {
    let scenes = seeds();
    assert!(!scenes.is_empty(), "no scenes below {}", root().display());
    let states: Vec<_> = scenes.iter().filter_map(|scene| exercise::saved(scene)).collect();
    let start = Instant::now();
    let now = move || start.elapsed().as_millis() as u64;
    let began = Arc::new(AtomicU64::new(0));
    watch(Arc::clone(&began), now, 1000 * arguments.seconds);
    let said = Arc::new(Mutex::new(String::new()));
    let hear = Arc::clone(&said);
    panic::set_hook(Box::new(move |info| {
        *hear.lock().unwrap_or_else(PoisonError::into_inner) = info.to_string();
    }));
    let limit = MEMORY.allocated() + (arguments.mebibytes << 20);
    MEMORY.set_limit(limit).expect("less is allocated");

    let mut rng = Rng::with_seed(arguments.seed);
    let (mut inputs, mut legal, mut run) = (0_u64, 0_u64, 0_u64);
    while start.elapsed() < Duration::from_secs_f64(60.0 * arguments.minutes) {
        let input = damage::input(&mut rng, &scenes, &states);
        let text = input.to_string();
        // If this fails, only the record of the present input is lost.
        let _ = std::fs::write(arguments.out.join(IN_HAND), &text);
        began.store(now(), Ordering::Relaxed);
        inputs += 1;
        match panic::catch_unwind(AssertUnwindSafe(|| exercise::meet(&input, inputs.is_multiple_of(16)))) {
            Ok(Ok(reached)) => {
                legal += u64::from(reached >= exercise::Reached::Legal);
                run += u64::from(reached >= exercise::Reached::Run);
            }
            Ok(Err(complaint)) => keep(&arguments.out, &complaint, &text),
            Err(_) => keep(&arguments.out, &said.lock().unwrap_or_else(PoisonError::into_inner), &text),
        }
    }
    eprintln!("{inputs} inputs, {legal} of them legal, {run} run");
    ExitCode::SUCCESS
}

/// Ends the process when an input takes more milliseconds than `limit`.
fn watch(began: Arc<AtomicU64>, now: impl Fn() -> u64 + Send + 'static, limit: u64) {
    thread::spawn(move || {
        loop {
            thread::sleep(Duration::from_millis(500));
            let began = began.load(Ordering::Relaxed);
            if began > 0 && now() - began > limit {
                eprintln!("an input takes more than {limit} ms");
                std::process::abort();
            }
        }
    });
}

/// Keeps the first input of each complaint.
fn keep(out: &Path, complaint: &str, text: &str) {
    let words: String = complaint.chars().filter(|c| !c.is_ascii_digit()).collect();
    let name: String =
        words.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).take(120).collect();
    let path = out.join(format!("{name}.txt"));
    if !path.exists() {
        eprintln!("{complaint}");
        let _ = std::fs::write(path, format!("# {}\n{text}", complaint.replace('\n', "\n# ")));
    }
}

fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here)
}

/// The scenes of the repository, in the order of their paths.
fn seeds() -> Vec<String> {
    let mut paths = Vec::new();
    for folder in ["verification/cases", "tests/scenes"] {
        scenes_in(&root().join(folder), &mut paths);
    }
    paths.sort();
    paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()).collect()
}

fn scenes_in(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            scenes_in(&path, found);
        } else if path.extension().is_some_and(|e| e == "toml") && !path.ends_with("case.toml") {
            found.push(path);
        }
    }
}
