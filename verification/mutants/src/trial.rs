//! Which tests reach which mutants, and which fail when one is on.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs::{self, File};
use std::io::Write;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::Failure;
use crate::build::{Harness, Program};
use crate::copy::{PYTHON, Workshop};
use crate::find::Mutant;

/// A test takes too long after this many times its usual time, and this much more.
const TIMES: f64 = 5.0;
const MORE: Duration = Duration::from_secs(5);
/// A test without mutant may take so long.
const LONGEST: Duration = Duration::from_secs(1800);
/// Address space of a test in KiB, for mutants that never stop to ask for more.
const MEMORY: u64 = 8_000_000;

/// How the interpreter is told to run tests: without a record of the last run, which needs a place.
const PYTEST: [&str; 4] = ["-m", "pytest", "-p", "no:cacheprovider"];

/// A test, by itself.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Test {
    /// Program and name.
    pub name: String,
    program: PathBuf,
    folder: PathBuf,
    harness: Harness,
    own: String,
    /// Time that it takes without mutant \[s\].
    seconds: f64,
    /// Numbers of the mutants that it asks for.
    reaches: BTreeSet<usize>,
    /// Whether it passes without mutant; otherwise it can show nothing.
    passes: bool,
}

/// The outcome of a mutant.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub enum Outcome {
    /// This test failed.
    Caught(String),
    /// This test did not come to its end.
    TimedOut(String),
    /// All of so many tests passed; none where nothing reaches it.
    Missed(usize),
}

/// All tests with what they reach, found by running each once; what is known from an earlier run of
/// the same sources is not run again.
///
/// Those in Python, which take a second to start, are kept for the mutants that no others reach:
/// those of the Python module.
pub fn tests(
    workshop: &Workshop,
    programs: &[Program],
    mutants: &[Mutant],
    fingerprint: u64,
) -> Result<Vec<Test>, Failure> {
    let path = workshop.outcomes.join(format!("{fingerprint:016x}-tests.jsonl"));
    let mut tests: Vec<Test> = lines(&path)?;
    let known: BTreeSet<String> = tests.iter().map(|test| test.name.clone()).collect();
    let mut rest = Vec::new();
    for program in programs {
        for own in list(program)? {
            rest.push(Test {
                name: format!("{} {own}", program.name),
                program: program.path.clone(),
                folder: program.folder.clone(),
                harness: program.harness,
                own,
                seconds: 0.0,
                reaches: BTreeSet::new(),
                passes: false,
            });
        }
    }
    rest.retain(|test| !known.contains(&test.name));
    let number = tests.len() + rest.len();
    let mut file = File::options().append(true).create(true).open(&path)?;
    for mut test in rest {
        let reached = workshop.temporary.join("reached");
        let _ = fs::remove_file(&reached);
        let start = Instant::now();
        let end = test.run(workshop, "ANCF_MUTANT_REACHED", reached.as_os_str(), LONGEST, 0)?;
        test.seconds = start.elapsed().as_secs_f64();
        test.passes = end == End::Passed;
        test.reaches = numbers(&reached)?;
        if test.harness == Harness::Pytest {
            test.reaches.retain(|&number| mutants[number].file.starts_with(PYTHON));
        }
        writeln!(file, "{}", serde_json::to_string(&test)?)?;
        tests.push(test);
        if tests.len().is_multiple_of(100) || tests.len() == number {
            eprintln!("{} of {number} tests run without mutant", tests.len());
        }
    }
    for test in tests.iter().filter(|test| !test.passes) {
        eprintln!("fails without any mutant, and is left out: {}", test.name);
    }
    Ok(tests)
}

/// The outcome of each mutant, by number, of so many tried at a time. What is known from an earlier
/// run of the same sources is not tried again.
pub fn outcomes(
    workshop: &Workshop,
    tests: &[Test],
    mutants: &[(usize, String)],
    fingerprint: u64,
    jobs: usize,
) -> Result<BTreeMap<usize, Outcome>, Failure> {
    let path = workshop.outcomes.join(format!("{fingerprint:016x}.jsonl"));
    let known: BTreeMap<usize, Outcome> = lines(&path)?.into_iter().collect();
    let file = Mutex::new(File::options().append(true).create(true).open(&path)?);
    let (next, known) = (AtomicUsize::new(0), &known);
    let work = |job: usize| -> Result<Vec<(usize, Outcome)>, String> {
        let mut own = Vec::new();
        while let Some((i, (number, name))) = take(&next, mutants) {
            let start = Instant::now();
            let outcome = match known.get(number) {
                Some(outcome) => outcome.clone(),
                None => {
                    let outcome = attempt(workshop, tests, *number, job).map_err(|e| e.to_string())?;
                    let line = serde_json::to_string(&(number, &outcome)).map_err(|e| e.to_string())?;
                    let mut file = file.lock().map_err(|e| e.to_string())?;
                    writeln!(file, "{line}").map_err(|e| e.to_string())?;
                    outcome
                }
            };
            let seconds = start.elapsed().as_secs_f64();
            eprintln!("{}/{} #{number} {name}: {outcome} ({seconds:.1} s)", i + 1, mutants.len());
            own.push((*number, outcome));
        }
        Ok(own)
    };
    let parts = std::thread::scope(|scope| {
        let work = &work;
        let jobs: Vec<_> = (0..jobs.max(1)).map(|job| scope.spawn(move || work(job))).collect();
        jobs.into_iter().map(|job| job.join()).collect::<Vec<_>>()
    });
    let mut all = BTreeMap::new();
    for part in parts {
        all.extend(part.map_err(|_| "a job has panicked")??);
    }
    Ok(all)
}

/// The next of a list that no other has taken.
fn take<'a, T>(next: &AtomicUsize, list: &'a [T]) -> Option<(usize, &'a T)> {
    let i = next.fetch_add(1, Ordering::Relaxed);
    Some((i, list.get(i)?))
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Caught(test) => write!(f, "caught by {test}"),
            Self::TimedOut(test) => write!(f, "timed out in {test}"),
            Self::Missed(0) => write!(f, "MISSED, for nothing reaches it"),
            Self::Missed(tests) => write!(f, "MISSED by {tests} tests"),
        }
    }
}

/// Runs the tests that reach a mutant, the quickest first, until one fails.
fn attempt(workshop: &Workshop, tests: &[Test], number: usize, job: usize) -> Result<Outcome, Failure> {
    let mut reaching: Vec<&Test> = tests.iter().filter(|t| t.passes && t.reaches.contains(&number)).collect();
    reaching.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    for test in &reaching {
        let limit = Duration::from_secs_f64(TIMES * test.seconds) + MORE;
        match test.run(workshop, "ANCF_MUTANT", number.to_string().as_ref(), limit, job)? {
            End::Passed => {}
            End::Failed => return Ok(Outcome::Caught(test.name.clone())),
            End::TooLong => return Ok(Outcome::TimedOut(test.name.clone())),
        }
    }
    Ok(Outcome::Missed(reaching.len()))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Passed,
    Failed,
    TooLong,
}

impl Test {
    fn run(
        &self,
        workshop: &Workshop,
        key: &str,
        value: &std::ffi::OsStr,
        limit: Duration,
        job: usize,
    ) -> Result<End, Failure> {
        // Removes the files that a killed test left behind.
        let own = workshop.temporary.join(format!("job-{job}"));
        let _ = fs::remove_dir_all(&own);
        fs::create_dir_all(&own)?;
        let one: &[&str] = match self.harness {
            Harness::Rust => &["--exact"],
            Harness::Pytest => &PYTEST,
        };
        let child = Command::new("sh")
            .args(["-c", &format!("ulimit -v {MEMORY}; exec \"$0\" \"$@\"")])
            .arg(&self.program)
            .args(one)
            .arg(&self.own)
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .env("TMPDIR", &own)
            .env("PYTHONPATH", workshop.copy.join(PYTHON))
            .env("INSTA_UPDATE", "no")
            .env("RUST_BACKTRACE", "0")
            .env(key, value)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            // Its own group, so that it can be ended with all that it started.
            .process_group(0)
            .spawn()
            .map_err(|e| format!("sh: {e}"))?;
        wait(child, limit)
    }
}

fn wait(mut child: Child, limit: Duration) -> Result<End, Failure> {
    let start = Instant::now();
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(if status.success() { End::Passed } else { End::Failed });
        }
        if start.elapsed() > limit {
            let group = format!("-{}", child.id());
            Command::new("kill").args(["-KILL", "--", &group]).status()?;
            child.wait()?;
            return Ok(End::TooLong);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

/// What stands in the lines of a file, nothing where there is none. The last line may have been
/// broken off.
fn lines<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, Failure> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let Some((whole, broken)) = text.rsplit_once('\n') else { return Ok(Vec::new()) };
    if !broken.is_empty() {
        fs::write(path, format!("{whole}\n"))?;
    }
    let read = |line| serde_json::from_str(line).map_err(|e| format!("{}: {e}", path.display()).into());
    whole.lines().map(read).collect()
}

fn numbers(path: &Path) -> Result<BTreeSet<usize>, Failure> {
    let text = fs::read_to_string(path).unwrap_or_default();
    text.lines().map(|line| Ok(line.parse::<usize>().map_err(|e| format!("{line}: {e}"))?)).collect()
}

/// The names of a program's tests, without those that are ignored.
fn list(program: &Program) -> Result<BTreeSet<String>, Failure> {
    let names = |arguments: &[&str]| -> Result<String, Failure> {
        let output = Command::new(&program.path)
            .args(arguments)
            .current_dir(&program.folder)
            .env("PYTHONPATH", program.folder.join(PYTHON))
            .output()
            .map_err(|e| format!("{}: {e}", program.path.display()))?;
        if !output.status.success() {
            return Err(format!("{}: {}", program.name, String::from_utf8_lossy(&output.stderr)).into());
        }
        Ok(String::from_utf8(output.stdout)?)
    };
    let tests = |text: String| -> BTreeSet<String> {
        text.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect()
    };
    Ok(match program.harness {
        Harness::Rust => {
            let ignored = tests(names(&["--list", "--format", "terse", "--ignored"])?);
            &tests(names(&["--list", "--format", "terse"])?) - &ignored
        }
        Harness::Pytest => {
            let listed = names(&[&PYTEST[..], &["--collect-only"]].concat())?;
            listed.lines().filter(|line| line.contains("::")).map(str::to_owned).collect()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch a run that cannot go on where it was broken off in the midst of a line.
    #[test]
    fn whole_lines_are_read_and_a_broken_one_is_removed() {
        let name = format!("ancf-mutants-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        assert_eq!(lines::<usize>(&path).expect("no file, no lines"), Vec::<usize>::new());
        let line = serde_json::to_string(&(7, Outcome::Missed(3))).expect("a line");
        fs::write(&path, format!("{line}\n{line}\n[7, {{")).expect("a file");
        let two = vec![(7, Outcome::Missed(3)); 2];
        assert_eq!(lines::<(usize, Outcome)>(&path).expect("two lines"), two);
        assert_eq!(fs::read_to_string(&path).expect("a file"), format!("{line}\n{line}\n"));
        fs::remove_file(&path).expect("a file");
    }

    fn started(line: &str) -> Child {
        Command::new("sh").args(["-c", line]).process_group(0).spawn().expect("a shell")
    }

    /// Would catch a failure taken for a success, and a test that is never ended.
    #[test]
    fn processes_pass_fail_or_take_too_long() {
        let long = Duration::from_secs(600);
        assert_eq!(wait(started("exit 0"), long).expect("an end"), End::Passed);
        assert_eq!(wait(started("exit 101"), long).expect("an end"), End::Failed);
        // The child of the shell, too, is ended; otherwise this would wait for it.
        let child = started("sleep 600 | sleep 600");
        assert_eq!(wait(child, Duration::from_millis(50)).expect("an end"), End::TooLong);
    }
}
