//! Why mutants survive: reasons that people write, kept from one record to the next.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

/// What stands where nobody has written a reason yet.
pub const UNEXPLAINED: &str = "to be explained";

/// A missed mutant.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Survivor {
    /// File, place and change, in the tool's words.
    pub mutant: String,
    /// Why no test need catch it, or why none does.
    pub reason: String,
    /// It gives the results of the sources in all cases, as the reason explains, so that there is
    /// nothing to catch.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub equivalent: bool,
}

impl Survivor {
    /// Whether somebody has written why.
    pub fn explained(&self) -> bool {
        self.reason != UNEXPLAINED
    }
}

/// Survivors with the reasons that were written for the same ones before. Lines move, so places do
/// not count; where one text stands for several places, these are taken in their order as long as
/// there are as many, otherwise by their lines.
pub fn explain(missed: &[&str], before: &[Survivor]) -> Vec<Survivor> {
    let mut old: HashMap<String, Vec<&Survivor>> = HashMap::new();
    for survivor in before {
        old.entry(without_place(&survivor.mutant)).or_default().push(survivor);
    }
    let mut number: HashMap<String, usize> = HashMap::new();
    for name in missed {
        *number.entry(without_place(name)).or_default() += 1;
    }
    let mut seen: HashMap<String, usize> = HashMap::new();
    let former = |name: &str| -> Option<&Survivor> {
        let text = without_place(name);
        let same = old.get(&text)?;
        let turn = seen.entry(text.clone()).or_default();
        *turn += 1;
        if number.get(&text) == Some(&same.len()) {
            return same.get(*turn - 1).copied();
        }
        let first = same.first()?;
        let agree = same.iter().all(|s| (&s.reason, s.equivalent) == (&first.reason, first.equivalent));
        same.iter().find(|s| s.mutant == name).or(agree.then_some(first)).copied()
    };
    let former: Vec<Option<&Survivor>> = missed.iter().copied().map(former).collect();
    missed
        .iter()
        .zip(former)
        .map(|(name, former)| Survivor {
            mutant: (*name).to_owned(),
            reason: former.map_or_else(|| UNEXPLAINED.to_owned(), |s| s.reason.clone()),
            equivalent: former.is_some_and(|s| s.equivalent),
        })
        .collect()
}

/// `src/a.rs:12:7: replace …` without `:12:7`.
pub fn without_place(name: &str) -> String {
    match name.split_once(": ") {
        Some((place, change)) => format!("{}: {change}", place.split(':').next().unwrap_or(place)),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn survivor(mutant: &str, reason: &str) -> Survivor {
        Survivor { mutant: mutant.to_owned(), reason: reason.to_owned(), equivalent: false }
    }

    const A: &str = "src/solve/step/size.rs:3:5: replace < with <= in grow";
    const B: &str = "src/basis/ancf.rs:9:1: replace - with + in row";
    const C: &str = "src/basis/ancf.rs:9:9: replace - with / in row";

    #[test]
    fn reasons_stay_when_lines_move() {
        let moved = "src/basis/ancf.rs:90:4: replace - with + in row";
        let kept = explain(&[moved, A], &[survivor(B, "y is 1 − x"), survivor(C, "another")]);
        assert_eq!(kept, [survivor(moved, "y is 1 − x"), survivor(A, UNEXPLAINED)]);
    }

    #[test]
    fn one_text_at_several_places_keeps_a_reason_each() {
        let at = |line: u32| format!("src/basis/ancf.rs:{line}:1: replace - with + in row");
        let before = [survivor(&at(10), "first"), survivor(&at(20), "second")];
        let reasons = |lines: &[u32]| {
            let names: Vec<String> = lines.iter().map(|&l| at(l)).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            explain(&names, &before).into_iter().map(|s| s.reason).collect::<Vec<_>>()
        };
        assert_eq!(reasons(&[11, 21]), ["first", "second"]);
        // Caught at one of the places: the line tells which is left, and where it does not, nobody
        // guesses.
        assert_eq!(reasons(&[20]), ["second"]);
        assert_eq!(reasons(&[25]), [UNEXPLAINED]);
    }

    #[test]
    fn what_is_equivalent_stays_so() {
        let before = Survivor { equivalent: true, ..survivor(B, "y is 0") };
        let kept = explain(&[A, B], std::slice::from_ref(&before));
        assert_eq!(kept, [survivor(A, UNEXPLAINED), before]);
    }
}
