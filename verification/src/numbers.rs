//! `verify numbers`: are the numbers of the documents still true?
//!
//! `verification/numbers.toml` quotes them. A `[[number]]` is computed anew, by a scene and a check
//! as in `case.toml`, and must lie in the interval that its digits mean. What a clock says is
//! `[[measured]]`, with the command that measures it; what a test or a case holds is `[[held]]`,
//! with its name. Every number of the documents that is written with a power of ten must be quoted,
//! so that none is added without saying where it comes from.

use std::collections::BTreeMap;
use std::time::Duration;

use ancf::scene::Scene;
use ancf_check::case::{Check, Family};
use ancf_check::execute::Run;
use ancf_check::family::members;
use ancf_check::{Suite, compare, quantity};
use ancf_verification::Failure;
use indexmap::IndexMap;
use serde::Deserialize;

use crate::report::short;

/// The documents that are looked through.
const DOCUMENTS: [&str; 7] = [
    "README.md",
    "verification/README.md",
    "src/handbook/motion.md",
    "src/handbook/mechanisms.md",
    "src/handbook/choosing.md",
    "src/handbook/hard.md",
    "src/handbook/studies.md",
];

/// `verification/numbers.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Numbers {
    number: Vec<Number>,
    held: Vec<Quoted>,
    measured: Vec<Quoted>,
    /// Words with numbers that are no results: what is asked for, or an example.
    given: Vec<Words>,
}

#[derive(Deserialize)]
struct Words {
    file: String,
    words: String,
}

/// Words, and the case, test or command that stands for them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Quoted {
    file: String,
    words: String,
    by: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Number {
    file: String,
    words: String,
    /// From the root of the repository.
    scene: String,
    #[serde(default)]
    set: Vec<String>,
    /// The interval that the digits mean.
    between: [f64; 2],
    check: Check,
}

impl Numbers {
    fn read(suite: &Suite) -> Result<Self, Failure> {
        let path = suite.root.join("verification/numbers.toml");
        let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?)
    }

    /// File and words of everything that is quoted.
    fn quotations(&self) -> impl Iterator<Item = (&str, &str)> {
        let quoted = self.held.iter().chain(&self.measured).map(|q| (q.file.as_str(), q.words.as_str()));
        let given = self.given.iter().map(|w| (w.file.as_str(), w.words.as_str()));
        self.number.iter().map(|n| (n.file.as_str(), n.words.as_str())).chain(quoted).chain(given)
    }
}

/// Computes the numbers and prints them beside their words; the answer is whether all of them are
/// true.
pub fn print(suite: &Suite) -> Result<bool, Failure> {
    let numbers = Numbers::read(suite)?;
    let problems = problems(suite, &numbers)?;
    problems.iter().for_each(|problem| println!("WRONG {problem}"));
    let mut wrong = problems.len();
    for number in &numbers.number {
        let [low, high] = number.between;
        let found = compute(suite, number).map_err(|e| format!("`{}`: {e}", number.words))?;
        let holds = (low..=high).contains(&found);
        wrong += usize::from(!holds);
        let (word, interval) = (if holds { "true" } else { "FALSE" }, [low, high].map(short).join(" … "));
        println!("{word}: {found:.3e} in {interval}: {}: {}", number.file, number.words);
    }
    println!(
        "{} numbers computed, {wrong} wrong; {} held by cases and tests, {} measured by other commands",
        numbers.number.len(),
        numbers.held.len(),
        numbers.measured.len()
    );
    Ok(wrong == 0)
}

/// The error, or the quantity itself, as a check takes it.
fn compute(suite: &Suite, number: &Number) -> Result<f64, Failure> {
    let scene = Scene::load(&suite.root.join(&number.scene), &number.set).map_err(|e| e.to_string())?;
    let results = scene.model().solve(scene.analysis())?;
    let mut tables = IndexMap::new();
    if let Some(name) = &number.check.oracle {
        let (case, oracle) = name.split_once('/').ok_or("an oracle here is `<case>/<oracle>`")?;
        tables.insert(name.clone(), suite.table(case, oracle)?);
    }
    let member = members(&Family::default())?.remove(0);
    let result = quantity::Result::Solved(Box::new(results));
    let run = Run { member, label: String::new(), result, took: Duration::ZERO };
    Ok(compare::member(&tables, 0, &number.check, 0, &run)?.error)
}

/// Words that are not in their document, numbers of documents that are not quoted, cases that are
/// not there.
fn problems(suite: &Suite, numbers: &Numbers) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    let mut texts = BTreeMap::new();
    for file in DOCUMENTS {
        let text = std::fs::read_to_string(suite.root.join(file)).map_err(|e| format!("{file}: {e}"))?;
        texts.insert(file, prose(&text));
    }
    let mut quoted: BTreeMap<&str, Vec<std::ops::Range<usize>>> = BTreeMap::new();
    for (file, words) in numbers.quotations() {
        let Some(text) = texts.get(file) else {
            problems.push(format!("{file} is none of the documents that are looked through"));
            continue;
        };
        let words = prose(words);
        let places: Vec<_> = text.match_indices(&words).map(|(at, w)| at..at + w.len()).collect();
        if places.is_empty() {
            problems.push(format!("{file} does not say `{words}`"));
        }
        quoted.entry(file).or_default().extend(places);
    }
    for (file, text) in &texts {
        for at in powers_of_ten(text) {
            if !quoted.get(file).is_some_and(|places| places.iter().any(|place| place.contains(&at))) {
                let from = text[..at].char_indices().rev().nth(40).map_or(0, |(k, _)| k);
                let to = text[at..].char_indices().nth(20).map_or(text.len(), |(k, _)| at + k);
                problems.push(format!("{file}: where does this number come from? … {} …", &text[from..to]));
            }
        }
    }
    let cases = suite.names()?;
    for held in &numbers.held {
        let there = match held.by.strip_prefix("case ") {
            Some(case) => cases.iter().any(|name| name == case),
            None => held.by.starts_with("test "),
        };
        if !there {
            problems.push(format!("`{}` is neither `case NAME` nor `test NAME`", held.by));
        }
    }
    Ok(problems)
}

/// A document without its blocks of code, and with single spaces.
fn prose(text: &str) -> String {
    let mut code = false;
    let lines = text.lines().filter(|line| {
        let fence = line.starts_with("```");
        code ^= fence;
        !code && !fence && !line.starts_with("    ")
    });
    lines.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}

/// Where numbers such as 2e-8 or 1.5e12 stand, those in `code` left out.
fn powers_of_ten(text: &str) -> Vec<usize> {
    let bytes = text.as_bytes();
    let digit = |k: usize| bytes.get(k).is_some_and(u8::is_ascii_digit);
    let mut code = false;
    let mut found = Vec::new();
    for (k, byte) in bytes.iter().enumerate() {
        code ^= *byte == b'`';
        let exponent = digit(k + 1) || (bytes.get(k + 1) == Some(&b'-') && digit(k + 2));
        if !code && *byte == b'e' && k > 0 && digit(k - 1) && exponent {
            found.push(k - 1);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a document that was changed without its numbers, and a new number that nobody
    /// computes.
    #[test]
    fn every_number_of_the_documents_says_where_it_comes_from() {
        let suite = Suite::here();
        let numbers = Numbers::read(&suite).expect("a legal file");
        assert_eq!(problems(&suite, &numbers).expect("documents"), Vec::<String>::new());
    }

    /// Catches a search that overlooks numbers, or takes words and settings for some.
    #[test]
    fn numbers_are_found_in_prose_alone() {
        let text =
            prose("to 2e-8 L\n```toml\nx = 1e-3\n```\n    cargo 1e5\nand `1e-4`, the 5 e-mails, 1.5e12");
        let found: Vec<_> = powers_of_ten(&text).into_iter().map(|at| &text[at..at + 3]).collect();
        assert_eq!(found, ["2e-", "5e1"]);
    }
}
