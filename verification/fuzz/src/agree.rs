//! The differential fuzzer: draws legal scenes over the whole vocabulary, and runs each in several
//! ways that must agree.
//!
//! A finding is a run of status 0 without a warning that disagrees by more than ten times the
//! accuracy asked for, a scene that has a result in only one of two equivalent ways, or a panic. A
//! disagreement is no finding if the results of neighbouring scenes depart as much, because then no
//! computation can give a definite result.

mod balance;
mod cut;
mod draw;
mod formula;
mod frame;
mod gap;
mod judge;
mod momentum;
mod neighbour;
mod outcome;
mod quantity;
mod report;
mod seldom;
mod settings;
mod shrink;
mod stages;
mod vocabulary;
mod ways;

use std::path::Path;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use fastrand::Rng;

use judge::{Case, Verdict, judge};
use outcome::Outcome;
use report::{Report, alike};
use seldom::Weights;
use ways::WAYS;

/// Number of ways in which each scene is run, of those that there are.
const WAYS_A_SCENE: usize = 5;
/// Most draws until a scene is legal.
const DRAWS: usize = 60;

/// The task of a campaign.
#[derive(Clone, Copy, Debug)]
pub struct Task<'t> {
    /// How many scenes at most.
    pub scenes: usize,
    /// For how long at most.
    pub time: Duration,
    /// The same seed gives the same scenes.
    pub seed: u64,
    /// The one scene to look at.
    pub only: Option<usize>,
    /// Where findings are written, if anywhere.
    pub out: Option<&'t Path>,
    /// How many scenes at once.
    pub threads: usize,
}

/// A finding, as it is written.
pub struct Written {
    /// Number of the scene, and the way.
    pub name: String,
    /// The disagreement.
    pub what: String,
    /// The smallest scene.
    pub scene: String,
}

/// Draws and judges scenes; returns the counts, and the findings in the order of the scenes.
pub fn campaign(task: &Task<'_>) -> (Report, Vec<Written>) {
    outcome::hear_panics();
    let weights = Weights::survey();
    let next = AtomicUsize::new(0);
    let end = Instant::now() + task.time;
    let all = Mutex::new((Report::default(), Vec::new()));
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= task.scenes || Instant::now() > end {
                return;
            }
            if task.only.is_some_and(|only| only != index) {
                continue;
            }
            let begin = Instant::now();
            let (mut report, found) = scene(task, &weights, index);
            report.slowest = (begin.elapsed().as_secs_f64(), index);
            for written in &found {
                if let Some(out) = task.out {
                    let path = out.join(format!("{}.toml", written.name));
                    eprintln!("{}: {}", path.display(), written.what);
                    keep(&path, &written.scene);
                }
            }
            let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
            all.0.add(report);
            all.1.extend(found.into_iter().map(|written| (index, written)));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..task.threads.max(1) {
            scope.spawn(work);
        }
    });
    let (report, mut found) = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort_by_key(|(index, _)| *index);
    (report, found.into_iter().map(|(_, written)| written).collect())
}

/// Draws one scene and judges it.
fn scene(task: &Task<'_>, weights: &Weights, index: usize) -> (Report, Vec<Written>) {
    let mut report = Report::default();
    let mut rng = Rng::with_seed(task.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index as u64);
    let Some(case) = legal(weights, &mut rng, &mut report) else { return (report, Vec::new()) };
    report.scene(&case.scene);
    if let (Some(out), Some(_)) = (task.out, task.only) {
        // Before it is run, since a run may take long.
        keep(&out.join(format!("{index}.toml")), &case.frame.write(&case.scene).to_string());
    }
    let base = outcome::run(&case.scene, &case.frame);
    let kind = match &base {
        Outcome::Solved(seen) if seen.warnings.is_empty() => "solved",
        Outcome::Solved(seen) => {
            for warning in &seen.warnings {
                *report.reasons.entry(format!("warned: {}", alike(warning))).or_default() += 1;
            }
            "warned of"
        }
        Outcome::Failed(said) => {
            *report.reasons.entry(format!("1: {}", alike(said))).or_default() += 1;
            "failed"
        }
        Outcome::Refused(said) => {
            *report.reasons.entry(format!("2: {}", alike(said))).or_default() += 1;
            "refused"
        }
        Outcome::TooLong => "too long",
        Outcome::Panicked(_) => "panicked",
    };
    report.outcomes.insert(kind, 1);
    let mut ways = WAYS.to_vec();
    rng.shuffle(&mut ways);
    let (mut taken, mut found) = (0, Vec::new());
    for way in ways {
        if taken >= WAYS_A_SCENE {
            break;
        }
        let verdict = judge(&case, way, &base);
        taken += usize::from(!matches!(verdict, Verdict::NotApplicable));
        report.verdict(way, &verdict);
        if let Verdict::Finding(finding) = verdict {
            let (small, finding) = shrink::shrink(case.clone(), finding);
            let text = small.frame.write(&small.scene).to_string();
            let comment = |text: &str| format!("# {}\n", text.replace('\n', "\n# "));
            let mut scene = comment(&format!("{}: {}", way.name(), finding.what));
            scene += &comment(&format!("--agree --seed {} --only {index}", task.seed));
            scene += &text;
            scene += &comment("The other way:");
            scene += &comment(&finding.other);
            found.push(Written { name: format!("{index}-{}", way.name()), what: finding.what, scene });
        }
    }
    (report, found)
}

/// A scene that the reader takes, with the frame in which it does.
fn legal(weights: &Weights, rng: &mut Rng, report: &mut Report) -> Option<Case> {
    for _ in 0..DRAWS {
        let scene = weights.draw(rng);
        let frame = draw::frame(rng, &scene);
        match outcome::check(&scene, &frame) {
            Ok(()) => return Some(Case { scene, frame, seed: rng.u64(..) }),
            Err(reason) => {
                let reason = reason.split_once(": ").map_or(reason.clone(), |(_, reason)| reason.to_owned());
                *report.illegal.entry(alike(&reason)).or_default() += 1;
            }
        }
    }
    None
}

fn keep(path: &Path, scene: &str) {
    if let Err(error) = std::fs::write(path, scene) {
        eprintln!("{}: {error}", path.display());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The number of scenes ends the test, never the clock.
    const SCENES: usize = 60;

    #[test]
    fn equivalent_runs_of_drawn_scenes_agree() {
        let task = Task {
            scenes: SCENES,
            time: Duration::from_secs(3600),
            seed: 5,
            only: None,
            out: None,
            threads: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        };
        let (report, findings) = campaign(&task);
        let said: Vec<String> =
            findings.iter().map(|w| format!("{}: {}\n{}", w.name, w.what, w.scene)).collect();
        assert!(findings.is_empty(), "{report}\n{}", said.join("\n"));
    }

    #[test]
    fn frames_go_back_and_forth() {
        let mut rng = Rng::with_seed(7);
        for _ in 0..50 {
            let scene = draw::scene(&mut rng);
            let frame = draw::frame(&mut rng, &scene);
            let p = [rng.f64(), rng.f64()];
            let mut table = toml::Table::new();
            let mut beam = toml::Table::new();
            beam.insert("start".into(), frame::list(p));
            let mut beams = toml::Table::new();
            beams.insert("a".into(), beam.into());
            table.insert("beam".into(), beams.into());
            let written = frame.write(&table);
            let there = settings::get(&written, &["beam", "a", "start"]).and_then(frame::vector);
            let back = frame.point_back(there.unwrap_or_default());
            assert!((back[0] - p[0]).hypot(back[1] - p[1]) < 1e-12, "{p:?}, {back:?} in {frame:?}");
        }
    }
}
