//! `verify work-precision`: what accuracy costs, measured, written and printed.

use std::path::Path;

use ancf_check::Suite;
use ancf_verification::python::Facts;
use ancf_verification::work::{self, Cheapest, Made, Results, Verdict};
use ancf_verification::{Failure, bridge};
use indicatif::{ProgressBar, ProgressStyle};

use crate::report::{machine, now, short};

/// Where results are written, and where the report looks for them, from the root of the repository.
pub const FOLDER: &str = "target/verification/work-precision";

/// What pins the codes that nothing else needs: they are large, and a test must not wait for them.
const REQUIREMENTS: &str = "work-requirements.txt";

/// Steps of the progress bar.
const PARTS: f64 = 1000.0;

/// Installs the codes that nothing else needs.
pub fn further_packages(suite: &Suite) -> Result<Facts, Failure> {
    bridge::environment()?.add(suite, &suite.peers_folder().join(REQUIREMENTS))
}

/// Measures problems, all if none is named, writes their files into `out` and prints what became of
/// the claims. The answer is whether no claim failed.
pub fn print(suite: &Suite, names: &[String], quick: bool, out: &Path) -> Result<bool, Failure> {
    let all = work::names(suite)?;
    if let Some(unknown) = names.iter().find(|name| !all.contains(name)) {
        return Err(format!("there is no problem `{unknown}`; there are: {}", all.join(", ")).into());
    }
    let facts = further_packages(suite)?;
    let tools = facts.tool(|package| !["mpmath", "numpy", "vtk"].contains(&package));
    std::fs::create_dir_all(out).map_err(|e| format!("{}: {e}", out.display()))?;
    if cfg!(debug_assertions) {
        eprintln!(
            "this is a debug build: its times say nothing (cargo run --release -p ancf-verification -- …)"
        );
    }
    let mut held = true;
    for name in if names.is_empty() { &all } else { names } {
        let problem = work::problem(suite, name)?;
        let bar = ProgressBar::new(PARTS as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}") {
            bar.set_style(style);
        }
        let tell = &mut |part: f64, what: &str| {
            bar.set_position((PARTS * part) as u64);
            bar.set_message(what.to_owned());
        };
        let made = Made { date: now(), machine: machine(), tools: tools.clone() };
        let results = work::measure(suite, name, &problem, quick, made, tell)?;
        bar.finish_and_clear();
        results.write(out)?;
        held &= results.claims.iter().all(|claim| claim.met != Some(false));
        held &= results.prices.iter().all(|paid| paid.met);
        println!("{}", told(&results));
    }
    println!("{}", out.display());
    Ok(held)
}

/// A problem's claims, and the number of settings that are missing.
fn told(results: &Results) -> String {
    let mut lines = vec![format!("{}: {} settings", results.name, results.points.len())];
    for claim in &results.claims {
        let met = match claim.met {
            Some(true) => "met",
            Some(false) => "MISSED",
            None => "undecided",
        };
        lines.push(format!("  {} · {}: {met}", wanted(claim).join(", "), found(claim).join(", ")));
        for (code, cheapest) in [("ours", &claim.ours), ("against", &claim.theirs)] {
            lines.push(format!(
                "    {code}: {}",
                cheapest.as_ref().map_or("none is good enough".into(), setting)
            ));
        }
    }
    for paid in &results.prices {
        let times = |ratio: Option<f64>, word: &str| ratio.map(|ratio| format!(", {ratio:.1} × {word}"));
        let compared =
            [times(paid.dearer, "dearer than the cheapest"), times(paid.faster, "faster than others")];
        lines.push(format!(
            "  accuracy {:e} alone: {}{}{}",
            paid.wanted,
            setting(&paid.alone),
            compared.into_iter().flatten().collect::<String>(),
            if paid.met { "" } else { ": MISSED" }
        ));
    }
    let failed = results.left_out.iter().map(|left| format!("  left out: {}: {}", left.what, left.why));
    lines.extend(failed);
    lines.join("\n")
}

/// The limits of a claim, in words.
pub fn wanted(claim: &Verdict) -> Vec<String> {
    let limit = claim.limit.as_ref().map(|(norm, error)| format!("{norm} to {}", short(*error)));
    limit.into_iter().chain([format!("{} × faster", claim.times)]).collect()
}

/// The outcome of a claim, in words.
pub fn found(claim: &Verdict) -> Vec<String> {
    let ratio = claim.ratio.map(|ratio| format!("{ratio:.1} × faster"));
    let alone = claim.ours.as_ref().map(|ours| time(ours.seconds));
    let both: Vec<_> = ratio.into_iter().chain(alone).collect();
    if both.is_empty() { vec!["nothing".to_owned()] } else { both }
}

fn setting(cheapest: &Cheapest) -> String {
    let error = cheapest.error.map(|error| format!(", error {}", short(error))).unwrap_or_default();
    format!("{}{error}, {}", cheapest.setting, time(cheapest.seconds))
}

/// A time with three digits and its unit.
pub fn time(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-3 => (s * 1e6, "µs"),
        s if s < 1.0 => (s * 1e3, "ms"),
        s => (s, "s"),
    };
    let decimals = if value < 9.995 { 2 } else { usize::from(value < 99.95) };
    format!("{value:.decimals$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::time;

    #[test]
    fn times_have_three_digits() {
        let cases = [
            (2.5e-4, "250 µs"),
            (9.996e-6, "10.0 µs"),
            (0.0571, "57.1 ms"),
            (16.34, "16.3 s"),
            (1.0, "1.00 s"),
        ];
        for (seconds, text) in cases {
            assert_eq!(time(seconds), text);
        }
    }
}
