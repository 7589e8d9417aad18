//! Tables of modes, and a summary that says what the tables end with.

use super::{Written, near};
use std::f64::consts::PI;

/// A beam on two hinges, EI = 3 N m², ρA = 0.5 kg/m, 2 m.
fn hinged(analysis: &str) -> Written {
    Written::of(&format!(
        "beam.arm = {{ start = [1, 0], end = [3, 0], axial_stiffness = 1e6, bending_stiffness = 3, mass_per_length = 0.5, basis.ancf.elements = 24 }}
         support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y'] }}, {{ beam = 'arm', at = 'end', fix = ['y'] }}]
         effect.force = [{{ beam = 'arm', at = 'end', value = [-1, 0] }}]
         {analysis}\n"
    ))
}

/// Would catch modes that are numbered from 0, frequencies in rad/s, shapes of another mode, and
/// slopes, strains and curvatures that are not of these shapes.
#[test]
fn modes_of_a_hinged_beam_are_sines_with_their_numbers() {
    let wave = PI / 2.0;
    // A vibration has a unit mass, ½ ρA L h² = 1 kg m²; a buckled beam moves 1 m at most.
    for (analysis, file, name, expected, exact) in [
        (
            "analysis.modal = { count = 3, about = 'reference' }",
            "frequencies.csv",
            "frequency",
            2_f64.sqrt(),
            Box::new(|n: f64| n * n * wave * wave * (3.0_f64 / 0.5).sqrt() / (2.0 * PI))
                as Box<dyn Fn(f64) -> f64>,
        ),
        (
            "analysis.buckling.count = 3",
            "load_factors.csv",
            "load_factor",
            1.0,
            Box::new(|n| 3.0 * (n * wave).powi(2)),
        ),
    ] {
        let found = hinged(analysis);
        assert_eq!(found.words(file, "mode"), ["1", "2", "3"]);
        let said = if name == "frequency" { "/frequencies" } else { "/load_factors" };
        for (i, value) in found.column(file, name).into_iter().enumerate() {
            near(value / exact((i + 1) as f64), 1.0, 2e-4, name);
            near(found.said(&format!("{said}/{i}")), value, 0.0, said);
        }
        let columns =
            ["s", "ux", "uy", "rotation", "strain", "curvature"].map(|name| found.column("modes.csv", name));
        let number = found.words("modes.csv", "mode");
        assert!(found.words("modes.csv", "beam").iter().all(|beam| beam == "arm"));
        assert_eq!(number.len(), 3 * 201);
        for n in 1..=3 {
            let rows: Vec<usize> = (0..number.len()).filter(|i| number[*i] == n.to_string()).collect();
            assert_eq!(rows.len(), 201, "mode {n}");
            let k = f64::from(n) * wave;
            // The height of the sine, with its sign, at its first crest.
            let crest = rows.iter().min_by(|a, b| {
                (columns[0][**a] * k - PI / 2.0).abs().total_cmp(&(columns[0][**b] * k - PI / 2.0).abs())
            });
            let crest = *crest.expect("a row");
            let height = columns[2][crest] / (k * columns[0][crest]).sin();
            let size = height.abs();
            near(size, expected, 1e-3, &format!("{analysis}, the height of mode {n}"));
            for i in rows {
                let [s, x, y, rotation, strain, curvature] = columns.each_ref().map(|column| column[i]);
                for (name, value, exact, tolerance) in [
                    ("ux", x, 0.0, 1e-4 * size),
                    ("uy", y, height * (k * s).sin(), 2e-3 * size),
                    ("rotation", rotation, height * k * (k * s).cos(), 1e-2 * size * k),
                    ("strain", strain, 0.0, 1e-4 * size * k),
                    ("curvature", curvature, -height * k * k * (k * s).sin(), 3e-2 * size * k * k),
                ] {
                    near(value, exact, tolerance, &format!("{analysis}, mode {n}, {name} at s = {s}"));
                }
            }
        }
    }
}

/// What `summary.json` says is what the tables end with: would catch any two of its numbers that
/// are swapped, of another record, or of another beam.
#[test]
fn the_summary_says_what_the_tables_end_with() {
    let moving = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 0.5, mass_per_length = 1, basis.ancf.elements = 4 }
        title = 'All kinds of energy'
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y'] }]
        effect.gravity.acceleration = [0.5, -9.81]
        effect.moment = [{ beam = 'arm', at = 'end', value = 0.4 }]
        effect.spring = [{ beam = 'arm', at = 0.4, stiffness = 3, damping = 0.7 }]
        probe = [{ name = 'end', beam = 'arm', at = 'end' }, { name = 'quarter', beam = 'arm', at = 0.25 }]
        analysis.dynamic = { duration = 0.3, output_every = 0.1, radau.tolerance = 1e-6 }\n";
    let still = moving.replace(
        "analysis.dynamic = { duration = 0.3, output_every = 0.1, radau.tolerance = 1e-6 }",
        "analysis.static.steps = 3",
    );
    for text in [moving, &still] {
        let found = Written::of(text);
        let summary = found.summary();
        assert_eq!(
            (summary["title"].as_str(), summary["complete"].as_bool()),
            (Some("All kinds of energy"), Some(true))
        );
        let dynamic = summary["analysis"] == "dynamic";
        // Five nodes of four coordinates, two held.
        assert_eq!(found.said("/degrees_of_freedom"), 18.0);
        let parameter = if dynamic { "time" } else { "load" };
        let last = found.last("energy.csv", parameter);
        assert_eq!((found.said("/last"), found.last("probes.csv", parameter)), (last, last));
        near(last, if dynamic { 0.3 } else { 1.0 }, 1e-15, "the end");
        let mut seen = Vec::new();
        for name in found.header("energy.csv").into_iter().skip(1) {
            let value = found.last("energy.csv", &name);
            assert_eq!(found.said(&format!("/energy/{name}")), value, "{name}");
            if value != 0.0 {
                assert!(!seen.contains(&value.to_bits()), "{name}: each has a value of its own");
                seen.push(value.to_bits());
            }
        }
        assert_eq!(seen.len(), if dynamic { 8 } else { 5 });
        let moves = ["end.vx", "end.vy"].map(|name| found.header("probes.csv").iter().any(|n| n == name));
        assert_eq!(moves, [dynamic; 2], "velocities belong to motions");
        for name in found.header("probes.csv").into_iter().skip(1) {
            let pointer = format!("/probes/{}", name.replace('.', "/"));
            assert_eq!(found.said(&pointer), found.last("probes.csv", &name), "{name}");
        }
        // Total: what there is, less what was put in, with what was lost.
        let e = |name: &str| found.said(&format!("/energy/{name}"));
        let (kept, lost) = (
            e("stretch") + e("bend") + e("stored") + e("kinetic") + e("potential"),
            if dynamic { e("lost") } else { 0.0 },
        );
        near(e("total"), kept - e("work") + lost, 1e-14, "total");
        if dynamic {
            let totals = found.column("energy.csv", "total");
            let change = totals.iter().fold(0.0_f64, |m, t| m.max((t - totals[0]).abs()));
            let kinetic = found.column("energy.csv", "kinetic").into_iter().fold(0.0, f64::max);
            near(e("drift"), change / kinetic, 1e-15, "drift");
        }
        // The last rows of the shape are those of the probe at the end.
        for name in ["x", "y", "angle", "strain", "curvature"] {
            near(found.last("shape.csv", name), found.said(&format!("/probes/end/{name}")), 1e-12, name);
        }
    }
}

/// Counts of what can be counted by hand, what is left out, and where the time went.
#[test]
fn the_summary_counts_steps_and_says_what_it_left_out() {
    let arm = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_stiffness = 0.5, mass_per_length = 1, basis.ancf.elements = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        effect.force = [{ beam = 'arm', at = 'end', value = [1e-3, 0] }]
        initial_velocity = [{ beam = 'arm', polynomial = { vy = [0, 0, 1e-3] } }]\n";
    // 30 steps of 10 ms, and four parts of a load to which the bar answers in proportion.
    for (analysis, steps, load_steps, warned) in [
        ("analysis.dynamic = { duration = 0.3, output_every = 0.1, radau.step = '10 ms' }\n", 30, 0, None),
        ("analysis.static.steps = 4\n", 4, 4, Some("`initial_velocity` takes no part in statics")),
    ] {
        let found = Written::of(&format!("{arm}{analysis}"));
        let summary = found.summary();
        let count = |name: &str| summary["statistics"][name].as_u64().unwrap_or_else(|| panic!("{name}"));
        assert_eq!((count("steps"), count("load_steps"), count("rejected_steps")), (steps, load_steps, 0));
        assert!((steps..=4 * steps).contains(&count("newton_iterations")), "{summary}");
        assert!(count("residual_evaluations") >= count("newton_iterations"), "{summary}");
        for name in ["tangent_evaluations", "factorizations"] {
            assert!((1..=2 * count("residual_evaluations")).contains(&count(name)), "{name}: {summary}");
        }
        let warnings: Vec<_> =
            summary["warnings"].as_array().into_iter().flatten().filter_map(|w| w.as_str()).collect();
        assert_eq!(warnings.len(), usize::from(warned.is_some()), "{warnings:?}");
        assert!(warned.is_none_or(|part| warnings[0].starts_with(part)), "{warnings:?}");
        assert_eq!(summary["version"].as_str(), Some(env!("CARGO_PKG_VERSION")));
        let seconds = ["build", "solve", "write"].map(|name| found.said(&format!("/seconds/{name}")));
        assert!(seconds.iter().all(|s| (0.0..60.0).contains(s)), "{seconds:?}");
        assert!(seconds[1] > 0.0 && seconds[2] > 0.0, "{seconds:?}");
    }
}
