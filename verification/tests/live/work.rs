//! A small measurement: what is measured is right and complete. No clock is judged.

use ancf_check::Suite;
use ancf_verification::work::{Code, Made, Point, Problem, Results, measure};

const PROBLEM: &str = r#"
title = "Half circle"
about = "A cantilever bent into half a circle."
case = "roll-up-convergence"
set = ["beam.cantilever.strain=engineering", "effect.moment.0.value=156.44258750251175"]

[norm.tip]
title = "tip [m]"
quantity = ["probe.tip.x", "probe.tip.y"]
oracle = "roll-up-convergence/circle"
where = { quarters = 2, s = 1.8 }
why = "Exact."

[norm.curvature]
title = "curvature"
quantity = "shape.curvature"
oracle = "roll-up-convergence/circle"
where = { quarters = 2 }
along = "s"
norm = "rms"
per = "reference"
why = "Exact."

[method.ours]
code = "ours"
label = "ours"
set = ["beam.cantilever.basis={ ancf = { elements = {elements}, gauss_points = { stretch = 5, bend = 3 } } }", "analysis.static={ tolerance = 1e-10 }"]
over.mesh.elements = [8, 16]

[method.exudyn]
code = "exudyn"
label = "Exudyn"
set = ["beam.cantilever.basis={ ancf = { elements = {elements}, gauss_points = { stretch = 5, bend = 3 } } }", "analysis.static={ steps = 4 }"]
settings = { newton = "{newton}", quadrature = "5/3" }
over.mesh.elements = [8, 16]
over.newton.newton = ["full", "modified"]

[method.lobatto]
code = "exudyn"
label = "Lobatto"
set = ["beam.cantilever.basis={ ancf = { elements = 16, gauss_points = { stretch = 5, bend = 3 } } }", "analysis.static={ steps = 4 }"]
settings = { quadrature = "Lobatto" }

[method.wrong]
code = "exudyn"
label = "wrong"
set = ["beam.cantilever.basis={ ancf = { elements = 16, gauss_points = { stretch = 5, bend = 3 } } }"]
settings = { colour = "red" }

[method.slow]
code = "exudyn"
label = "slow"
slow = true

[[claim]]
norm = "tip"
error = 1e-3
times = 1.0
"#;

fn measured() -> Results {
    let problem = Problem::parse(PROBLEM).expect("a problem");
    let made = Made { date: "today".into(), machine: "here".into(), tools: "Exudyn".into() };
    measure(&Suite::here(), "small", &problem, true, made, &mut |_, _| ()).unwrap_or_else(|e| panic!("{e}"))
}

fn point<'a>(results: &'a Results, method: &str, setting: &str) -> &'a Point {
    let found = results.points.iter().find(|p| p.method == method && p.setting == setting);
    found.unwrap_or_else(|| panic!("no {method}, {setting}: {:?}", results.left_out))
}

#[test]
fn one_norm_judges_both_codes_and_the_same_elements_have_the_same_error() {
    let results = measured();
    for elements in ["elements = 8", "elements = 16"] {
        let ours = point(&results, "ours", elements);
        for newton in ["full", "modified"] {
            let theirs = point(&results, "exudyn", &format!("{elements}, newton = {newton}"));
            for norm in ["tip", "curvature"] {
                let (a, b) = (ours.error[norm], theirs.error[norm]);
                assert!((a - b).abs() < 1e-6 * a.max(1e-3), "{elements}, {newton}, {norm}: {a:e}, {b:e}");
            }
        }
    }
    let error = |method, setting| point(&results, method, setting).error["tip"];
    let order = (error("ours", "elements = 8") / error("ours", "elements = 16")).log2();
    assert!((3.0..5.0).contains(&order), "cubic elements: order 4, found {order}");
    // Other points of integration, another error: the setting has reached Exudyn.
    let (full, other) = (error("ours", "elements = 16"), error("lobatto", ""));
    assert!((full - other).abs() > 0.1 * full, "{full:e}, {other:e}");
}

#[test]
fn medians_counts_and_what_is_missing_are_recorded_and_read_back() {
    let results = measured();
    for point in &results.points {
        let seconds = point.seconds;
        assert!(seconds.runs >= 3 && 0.0 < seconds.least, "{point:?}");
        assert!(seconds.least <= seconds.median && seconds.median <= seconds.largest, "{point:?}");
        assert!(point.newton_iterations > 0 && point.factorizations > 0 && point.steps > 0, "{point:?}");
        assert_eq!(point.build.is_some(), point.code == Code::Ours);
    }
    let claim = &results.claims[0];
    assert!(claim.met.is_some() && claim.ratio.is_some_and(f64::is_finite), "{claim:?}");
    let missing: Vec<_> = results.left_out.iter().map(|l| (l.what.as_str(), l.why.as_str())).collect();
    assert!(
        missing.iter().any(|(what, why)| what.starts_with("wrong") && why.contains("`colour`")),
        "{missing:?}"
    );
    assert!(missing.iter().any(|(what, why)| *what == "slow" && why.contains("--quick")), "{missing:?}");

    let folder = tempfile::tempdir().expect("a folder");
    results.write(folder.path()).unwrap_or_else(|e| panic!("{e}"));
    let again = Results::read(folder.path(), "small").expect("its own file").expect("a file");
    assert_eq!(again.points.len(), results.points.len());
    assert_eq!(again.claims, results.claims);
    assert!(Results::read(folder.path(), "none").expect("no file").is_none());
    let csv = std::fs::read_to_string(folder.path().join("small.csv")).expect("a table");
    assert_eq!(csv.lines().count(), 1 + results.points.len());
    assert!(csv.starts_with("code,method,setting,error_tip,error_curvature,seconds_median,"), "{csv}");
    for norm in ["tip", "curvature"] {
        let drawing = std::fs::read_to_string(folder.path().join(format!("small.{norm}.svg")));
        let drawing = drawing.expect("a drawing");
        assert!(
            drawing.contains("Exudyn") && !drawing.contains("Lobatto"),
            "one line for all methods of another code"
        );
    }
}
