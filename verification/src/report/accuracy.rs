//! The page of what estimated errors are worth.

use std::path::Path;

use ancf::output::plot::{Axis, Chart, GREY, Mark, PALETTE, Series};
use askama::Template;

use super::number::short;
use super::page::Page;
use crate::Failure;
use crate::accuracy::{Judged, RANGE, SceneWorth, Score, WANTED, Worth, read};

/// Kinds of analysis, with their names on the page.
const KINDS: [(&str, &str); 4] =
    [("static", "statics"), ("dynamic", "motions"), ("modal", "vibrations"), ("buckling", "critical loads")];

#[derive(Template)]
#[template(path = "accuracy.html")]
struct Body<'a> {
    measured: Option<&'a Worth>,
    range: [f64; 2],
    wanted: Vec<String>,
    /// Name, then what [`score`] says.
    scores: Vec<(String, [String; 5])>,
    rows: Vec<Row<'a>>,
    drawing: Result<String, String>,
}

/// A scene.
struct Row<'a> {
    scene: &'a SceneWorth,
    truth: String,
    /// Per accuracy: true error, estimate, class of the cell.
    cells: Vec<[String; 3]>,
}

/// What the estimates of errors are worth.
pub fn page(file: &Path) -> Result<Page, Failure> {
    let measured = read(file)?;
    let scenes = measured.as_ref().map_or(&[][..], |worth| &worth.scenes);
    let runs = || scenes.iter().flat_map(|scene| scene.runs.iter().flatten());
    let mut scores = Vec::new();
    for wanted in WANTED {
        scores.push((short(wanted), score(Score::of(runs().filter(|run| run.wanted == wanted)))));
    }
    for (kind, name) in KINDS {
        let of = scenes.iter().filter(|scene| scene.analysis == kind);
        scores.push((name.to_owned(), score(Score::of(of.flat_map(|scene| scene.runs.iter().flatten())))));
    }
    scores.push(("all".to_owned(), score(Score::of(runs()))));
    Ok(Page {
        id: "what-the-estimate-is-worth".into(),
        title: "What the estimate is worth".into(),
        pass: measured.as_ref().map(|worth| worth.score().passes()),
        listed: true,
        body: Body {
            measured: measured.as_ref(),
            range: RANGE,
            wanted: WANTED.map(short).into(),
            scores,
            rows: scenes.iter().map(row).collect(),
            drawing: drawing(scenes),
        }
        .render()?,
    })
}

/// Runs, those that say that they are as accurate as wanted and can be judged, those of them that
/// are not, those whose true error can be told, and the part of these whose estimate is right.
fn score(score: Score) -> [String; 5] {
    let right = match score.compared {
        0 => "–".to_owned(),
        _ => format!("{:.1} %", 100.0 * score.within()),
    };
    let Score { runs, judged, missed, compared, .. } = score;
    [runs.to_string(), judged.to_string(), missed.to_string(), compared.to_string(), right]
}

fn row(scene: &SceneWorth) -> Row<'_> {
    let cell = |run: &Result<Judged, String>| match run {
        Err(why) => [why.clone(), String::new(), "why".to_owned()],
        Ok(run) => {
            let class = match () {
                () if run.met && run.told && run.error > run.wanted => "fails",
                () if run.told && !(RANGE[0]..=RANGE[1]).contains(&run.ratio()) => "beyond",
                () => "",
            };
            let error = if run.told || run.error == 0.0 {
                short(run.error)
            } else {
                format!("≤ {}", short(run.error))
            };
            let said = if run.met { "" } else { ", not met" };
            [error, format!("{}{said}", short(run.estimated)), class.to_owned()]
        }
    };
    let truth = match &scene.truth {
        Ok(truth) => format!("{} of {}", truth.kept, truth.kept + truth.missed.len()),
        Err(why) => why.clone(),
    };
    Row { scene, truth, cells: scene.runs.iter().map(cell).collect() }
}

/// True errors over their estimates.
fn drawing(scenes: &[SceneWorth]) -> Result<String, String> {
    let axis = |label: &str| Axis::log(label).range(1e-10, 1.0);
    let mut chart = Chart::new("", axis("estimated error"), axis("true error")).sized(640, 460);
    let line = |factor: f64| vec![[1e-9, factor * 1e-9], [0.3, factor * 0.3]];
    chart = chart
        .with(Series::dashed("a fifth of the estimate, and three times", line(RANGE[0]), GREY))
        .with(Series::dashed("", line(RANGE[1]), GREY))
        .with(Series::line("", line(1.0), GREY));
    for ((kind, name), colour) in KINDS.into_iter().zip(PALETTE) {
        let of = scenes.iter().filter(|scene| scene.analysis == kind);
        let runs = of.flat_map(|scene| scene.runs.iter().flatten());
        let told = runs.filter(|run| run.told && run.estimated.is_finite());
        let points = told.map(|run| [run.estimated, run.error]).collect();
        chart = chart.with(Series::new(name, points, Mark::Points, colour).size(2.5).opacity(0.7));
    }
    chart.svg().map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::Truth;

    fn judged(wanted: f64, estimated: f64, error: f64, told: bool) -> Result<Judged, String> {
        Ok(Judged { wanted, met: true, estimated, error, told, degrees_of_freedom: 8 })
    }

    #[test]
    fn the_page_shows_what_is_right_wrong_and_unknown() {
        let scene = SceneWorth {
            case: "tip-load".into(),
            label: "load = 1".into(),
            analysis: "static".into(),
            truth: Ok(Truth { estimated: 1e-12, kept: 2, missed: vec!["one".into()] }),
            runs: vec![
                judged(1e-2, 2e-3, 1e-3, true),
                judged(1e-3, 5e-4, 2e-3, true),
                judged(1e-4, 8e-5, 1e-6, true),
                judged(1e-5, 5e-6, 1e-13, false),
                Err("given up".into()),
            ],
        };
        let worth = Worth { date: "2026-01-02".into(), machine: "a machine".into(), scenes: vec![scene] };
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("accuracy.json");
        std::fs::write(&file, serde_json::to_string(&worth).expect("JSON")).expect("a file");
        let page = page(&file).expect("a page");
        assert_eq!(page.pass, Some(false), "one run in four errs by more than it was asked to");
        for text in
            ["2026-01-02", "#tip-load", "2 of 3", "fails", "beyond", "≤ 1.0e−13", "why\">given up", "<svg"]
        {
            assert!(page.body.contains(text), "`{text}` is missing in {}", page.body);
        }
    }

    #[test]
    fn what_is_not_measured_says_how() {
        let page = page(Path::new("nowhere")).expect("a page");
        assert!(page.pass.is_none() && page.body.contains("-- accuracy</code>"));
    }
}
