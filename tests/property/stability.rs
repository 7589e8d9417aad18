//! Inertia of bordered matrices, stability of paths, buckling after bending, equilibria of
//! mechanisms, redundant joints.

use ancf::assembly::Needs;
use ancf::linear::bordered::BorderRow;
use ancf::linear::{Factor, Matrix};
use ancf::results::{Results, Trajectory};
use ancf::run::{Options, RunError, solve_stages};
use ancf::scene::{Scene, parse};
use ancf::system::System;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par, Side};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn scene(text: &str) -> Scene {
    parse("scene.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn attempt(text: &str) -> Result<Trajectory, RunError> {
    let scene = scene(text);
    scene.model().solve(scene.analysis()).map(Results::into_states)
}

fn solve(text: &str) -> Trajectory {
    attempt(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Natural frequencies, or critical load factors.
fn eigenvalues(text: &str) -> Vec<f64> {
    let scene = scene(text);
    let results = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    results.eigenvalues()
}

fn tip(trajectory: &Trajectory) -> [f64; 2] {
    let last = trajectory.probes[0].samples.last().expect("a state");
    [last.x, last.y]
}

fn beam(name: &str, [a, b]: [[f64; 2]; 2], section: &str, basis: &str) -> String {
    format!("[beam.{name}]\nstart = {a:?}\nend = {b:?}\nbasis = {basis}\n{section}\n")
}

fn joint(kind: &str, first: (&str, &str), second: (&str, &str)) -> String {
    let place = |(beam, at): (&str, &str)| format!("{{ beam = '{beam}', at = {at} }}");
    format!("[[joint]]\ntype = '{kind}'\nfirst = {}\nsecond = {}\n", place(first), place(second))
}

fn support(beam: &str, at: &str, fix: &str) -> String {
    format!("[[support]]\nbeam = '{beam}'\nat = {at}\nfix = {fix}\n")
}

fn force(beam: &str, value: [f64; 2]) -> String {
    format!("[[effect.force]]\nbeam = '{beam}'\nat = 'end'\nvalue = {value:?}\n")
}

fn probe(beam: &str) -> String {
    format!("[[probe]]\nname = 'tip'\nbeam = '{beam}'\nat = 'end'\n")
}

const CLAMP: &str = "['x', 'y', 'angle']";
const PIN: &str = "['x', 'y']";
const ANCF: &str =
    "{ ancf = { elements = 16, gauss_points = { stretch = 3, bend = 2, stretch_rule = 'lobatto' } } }";
const RPIM: &str = "{ rpim = { nodes = 10 } }";

/// An orthonormal basis of what the rows leave of the coordinates `free`; nothing if they depend on
/// each other.
fn allowed(rows: &[BorderRow], free: &[usize]) -> Option<Mat<f64>> {
    let (n, m) = (free.len(), rows.len());
    if m == 0 {
        return Some(Mat::identity(n, n));
    }
    let mut b = Mat::zeros(n, m);
    for (r, row) in rows.iter().enumerate() {
        let size = row.iter().map(|(_, value)| value * value).sum::<f64>().sqrt();
        for (i, value) in row {
            b[(free.iter().position(|f| f == i).expect("a free coordinate"), r)] = value / size;
        }
    }
    let qr = b.qr();
    let upper = qr.thin_R();
    (0..m).all(|r| upper[(r, r)].abs() > 1e-6).then(|| qr.compute_Q().get(.., m..).to_owned())
}

fn dense(matrix: &Matrix, of: &[usize]) -> Mat<f64> {
    Mat::from_fn(of.len(), of.len(), |i, j| matrix.get(of[i], of[j]))
}

proptest! {
    #![proptest_config(super::cases(12))]

    /// The number of negative eigenvalues on the allowed motions, whether K is regular, singular or
    /// indefinite beyond them, and however far rows reach.
    #[test]
    fn directions_are_counted_as_a_dense_solution_counts_them(
        entries in proptest::collection::vec(-1.0..1.0_f64, 24 * 24),
        shift in -1.0..3.0_f64,
        soft in 0..4_usize,
        rows in 1..7_usize,
        reach in 1..24_usize,
        rough in any::<bool>(),
    ) {
        let n = 24;
        let mut k = Matrix::zeros(n / 4, 2, true);
        for i in 0..n {
            for j in k.columns(i).filter(|j| *j >= i) {
                let of_soft = i / 4 == soft || j / 4 == soft;
                let value = entries[n * i + j] + if i == j { shift } else { 0.0 };
                // A node that nothing but rows holds: its block is zero.
                k.add_at(i, j, if of_soft { 0.0 } else { value });
            }
        }
        let unit = |i: usize| if rough && i % 4 > 1 { 1e-3 } else { 1.0 };
        let mut border: Vec<BorderRow> = (0..4).map(|d| vec![(4 * soft + d, unit(d)), ((4 * soft + 8 + d) % n, -unit(d))]).collect();
        border.iter_mut().for_each(|row| row.sort_by_key(|(i, _)| *i));
        for r in 0..rows {
            let from = (7 * r) % (n - reach).max(1);
            border.push((from..=(from + reach).min(n - 1)).map(|i| (i, unit(i) * entries[n * r + i])).collect());
        }
        let all: Vec<usize> = (0..n).collect();
        let z = allowed(&border, &all);
        prop_assume!(z.is_some());
        let z = z.expect("independent rows");
        let eigen = (z.transpose() * dense(&k, &all) * &z).self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
        prop_assume!(eigen.iter().all(|value| value.abs() > 1e-6));
        let expected = eigen.iter().filter(|value| **value < 0.0).count();
        let factor = Factor::new(&k, &border).expect("regular");
        prop_assert_eq!(factor.negative_directions(&k, &border), Some(expected));
    }

    /// The sign of the determinant of an unsymmetric matrix on the allowed motions, whatever the
    /// number of rows and however far they reach.
    #[test]
    fn the_determinant_has_the_sign_of_a_dense_one(
        entries in proptest::collection::vec(-1.0..1.0_f64, 24 * 24),
        rows in 0..7_usize,
        reach in 1..24_usize,
    ) {
        let n = 24;
        let mut k = Matrix::zeros(n / 4, 2, false);
        for i in 0..n {
            for j in k.columns(i).filter(|j| i / 4 <= j / 4 + 1 && j / 4 <= i / 4 + 1) {
                k.add_at(i, j, entries[n * i + j]);
            }
        }
        let border: Vec<BorderRow> = (0..rows)
            .map(|r| {
                let from = (7 * r) % (n - reach).max(1);
                (from..=(from + reach).min(n - 1)).map(|i| (i, entries[n * r + i])).collect()
            })
            .collect();
        let all: Vec<usize> = (0..n).collect();
        let z = allowed(&border, &all);
        prop_assume!(z.is_some());
        let z = z.expect("independent rows");
        let determinant = (z.transpose() * dense(&k, &all) * &z).determinant();
        prop_assume!(determinant.abs() > 1e-9);
        let factor = Factor::new(&k, &border).expect("regular");
        prop_assert_eq!(factor.negative_determinants(&k, &border), Some(usize::from(determinant < 0.0)));
    }

    /// A structure's frequencies are the same however many are asked for, by either method, and
    /// those of a dense solution: also with strings, which nothing resists across, and with masses
    /// and stiffnesses of all sizes.
    #[test]
    fn frequencies_do_not_depend_on_how_many_are_wanted(
        columns in 1..4_usize,
        elements in 1..7_usize,
        feet in proptest::collection::vec(any::<bool>(), 4),
        kinds in proptest::collection::vec(0..3_usize, 3),
        logs in proptest::collection::vec(0.0..1.0_f64, 24),
        bases in proptest::collection::vec(any::<bool>(), 4),
    ) {
        let size = |i: usize, from: f64, to: f64| 10f64.powf(from + (to - from) * logs[i]);
        let mut text = String::new();
        for c in 0..=columns {
            let x = c as f64;
            let ei = size(3 * c, 0.0, 3.0);
            let section = format!(
                "axial_stiffness = {:e}\nbending_stiffness = {ei:e}\nmass_per_length = {:e}",
                ei * size(3 * c + 1, 2.0, 6.0), size(3 * c + 2, -1.0, 1.0)
            );
            let basis = if bases[c] { format!("{{ ancf = {{ elements = {elements} }} }}") } else { format!("{{ rpim = {{ nodes = {} }} }}", elements + 2) };
            text += &beam(&format!("c{c}"), [[x, 0.0], [x, 1.0]], &section, &basis);
            text += &support(&format!("c{c}"), "'start'", if feet[c] { CLAMP } else { PIN });
        }
        for (c, kind) in kinds.iter().enumerate().take(columns) {
            let (x, i) = (c as f64, 12 + 3 * c);
            let (section, kind) = match kind {
                0 => (format!("axial_stiffness = {:e}\nmass_per_length = {:e}", size(i, 0.0, 4.0), size(i + 1, -6.0, 0.0)), "hinge"),
                k => (
                    format!("axial_stiffness = {:e}\nbending_stiffness = {:e}\nmass_per_length = {:e}", size(i, 4.0, 8.0), size(i + 1, 0.0, 3.0), size(i + 2, -1.0, 1.0)),
                    if *k == 1 { "hinge" } else { "weld" },
                ),
            };
            text += &beam(&format!("b{c}"), [[x, 1.0], [x + 1.0, 1.0]], &section, "{ ancf = { elements = 1 } }");
            text += &joint(kind, (&format!("c{c}"), "'end'"), (&format!("b{c}"), "'start'"));
            text += &joint("hinge", (&format!("c{}", c + 1), "'end'"), (&format!("b{c}"), "'end'"));
        }
        let with = |count: usize| format!("{text}[analysis.modal]\ncount = {count}\n");
        let model = scene(&with(1));
        let system = System::build(model.model(), Needs { inertia: true, motion: false }).expect("a legal model");
        let held = system.fixed();
        let free: Vec<usize> = (0..held.len()).filter(|i| !held[*i]).collect();
        let (mut k, mut m) = (system.internal_tangent(system.reference()), system.mass_matrix());
        for matrix in [&mut k, &mut m] {
            system.supports().turn_matrix(0.0, matrix);
        }
        let z = allowed(&system.border(0.0, system.reference()), &free).expect("independent rows");
        let (k, m) = (z.transpose() * dense(&k, &free) * &z, z.transpose() * dense(&m, &free) * &z);
        let (factor, mut k) = (m.llt(Side::Lower).expect("masses"), k);
        for _ in 0..2 {
            solve_lower_triangular_in_place(factor.L(), k.as_mut(), Par::Seq);
            k = k.transpose().to_owned();
        }
        let squares = k.self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
        let largest = squares[squares.len() - 1];
        let all = squares.len().min(24);
        let found = eigenvalues(&with(all));
        prop_assert_eq!(found.len(), all);
        for (f, square) in found.iter().zip(&squares) {
            let omega = TAU * f;
            prop_assert!((omega * omega - square).abs() < 1e-7 * square.abs() + 1e-13 * largest, "{omega}² and {square} of {squares:?}");
        }
        for count in (1..all).step_by(2) {
            let fewer = eigenvalues(&with(count));
            prop_assert_eq!(fewer.len(), count);
            for (a, b) in fewer.iter().zip(&found) {
                prop_assert!((a - b).abs() <= 1e-7 * b && (*a == 0.0) == (*b == 0.0), "{count} of {all}: {fewer:?} and {found:?}");
            }
        }
    }
}

/// A column of one beam or two, with axial stiffness or without, on supports at nodes: all reach
/// the same equilibrium beside their bifurcation, and all say where a perfect one passes it.
#[test]
fn columns_of_every_kind_leave_the_unstable_branch_or_say_where_it_begins() {
    let (ea, none) = ("bending_stiffness = 1.0\naxial_stiffness = 1e6", "bending_stiffness = 1.0");
    for (section, basis) in [(ea, ANCF), (none, ANCF), (ea, RPIM), (none, RPIM)] {
        let one = beam("a", [[0.0, 0.0], [1.0, 0.0]], section, basis) + &probe("a");
        let two = beam("b", [[0.0, 0.0], [0.4, 0.0]], section, basis)
            + &beam("a", [[0.4, 0.0], [1.0, 0.0]], section, basis)
            + &joint("weld", ("b", "'end'"), ("a", "'start'"))
            + &probe("a");
        for (column, foot) in [(one, "a"), (two, "b")] {
            let column = column + &support(foot, "'start'", CLAMP);
            for steps in ["", "steps = 3"] {
                let [x, y] = tip(&solve(&format!(
                    "{column}{}[analysis.static]\n{steps}\n",
                    force("a", [-6.2728, 6.2728e-3])
                )));
                assert!((x + 0.10668).hypot(y - 0.75055) < 1e-3, "{basis} {section}: {x} {y}");
            }
            let perfect =
                solve(&format!("{column}{}[analysis.static]\n", force("a", [-2.5 * PI * PI / 4.0, 0.0])));
            let [warning] = &perfect.run.warnings[..] else {
                panic!("{basis} {section}: {:?}", perfect.run.warnings)
            };
            assert!(warning.contains("loses definiteness at load factor 0.400"), "{warning}");
        }
        let mass = format!("{section}\nmass_per_length = 1.0");
        let heavy = beam("a", [[0.0, 0.0], [0.0, 1.0]], &mass, basis) + &support("a", "'start'", CLAMP);
        let heavy = solve(&format!(
            "effect.gravity.acceleration = [0.0, {}]\n{heavy}[analysis.static]\n",
            -2.5 * 7.8373
        ));
        assert!(heavy.run.warnings[0].contains("at load factor 0.400"), "{:?}", heavy.run.warnings);
    }
}

/// A frame whose legs are pinned and hinged to a beam that a load presses: P = π² EI of a leg whose
/// top a brace holds.
#[test]
fn a_hinged_leg_buckles_with_a_warning() {
    let leg = "axial_stiffness = 1e6\nbending_stiffness = 1.0";
    for stiff in ["axial_stiffness = 1e6\nbending_stiffness = 1e3", "bending_stiffness = 1e3"] {
        let text = beam("leg", [[0.0, 0.0], [0.0, 1.0]], leg, ANCF)
            + &beam("arm", [[1.0, 1.0], [0.0, 1.0]], stiff, ANCF)
            + &joint("hinge", ("leg", "'end'"), ("arm", "'end'"))
            + &support("leg", "'start'", PIN)
            + &support("arm", "'start'", PIN)
            + &force("arm", [0.0, -2.0 * PI * PI]);
        // The arm hardly turns, and with it a load that follows it.
        for (follower, said) in [
            ("", "the tangent loses definiteness at load factor 0.50"),
            ("follower = true\n", "the determinant of the tangent changes its sign at load factor 0.50"),
        ] {
            let found = solve(&format!("{text}{follower}[analysis.static]\n"));
            assert!(found.run.warnings[0].contains(said), "{:?}", found.run.warnings);
        }
    }
}

/// A column between a pin and a roller, pressed along its axis by a force that turns with its end:
/// the roller takes what it then has across, so that the critical load is Euler's, π² EI/L². Beyond
/// it, the straight column is an unstable equilibrium.
#[test]
fn columns_under_follower_loads_say_where_they_become_unstable() {
    let (ea, none) = ("bending_stiffness = 1.0\naxial_stiffness = 1e6", "bending_stiffness = 1.0");
    for (section, basis) in [(ea, ANCF), (none, ANCF), (ea, RPIM), (none, RPIM)] {
        let one = beam("a", [[0.0, 0.0], [1.0, 0.0]], section, basis);
        let two = beam("b", [[0.0, 0.0], [0.4, 0.0]], section, basis)
            + &beam("a", [[0.4, 0.0], [1.0, 0.0]], section, basis)
            + &joint("weld", ("b", "'end'"), ("a", "'start'"));
        for (column, foot) in [(one, "a"), (two, "b")] {
            let found = solve(&format!(
                "{column}{}{}{}follower = true\n[analysis.static]\n",
                support(foot, "'start'", PIN),
                support("a", "'end'", "['y']"),
                force("a", [-2.5 * PI * PI, 0.0])
            ));
            let [warning] = &found.run.warnings[..] else {
                panic!("{basis} {section}: {:?}", found.run.warnings)
            };
            assert!(
                warning.contains("changes its sign at load factor 0.400"),
                "{basis} {section}: {warning}"
            );
            assert!(warning.ends_with("unstable: a bifurcation or a limit point"), "{warning}");
        }
        // Two columns side by side lose their stiffness at once, and the product of their determinants
        // keeps its sign.
        let column = |name: &str, y: f64| {
            beam(name, [[0.0, y], [1.0, y]], section, basis)
                + &support(name, "'start'", PIN)
                + &support(name, "'end'", "['y']")
                + &force(name, [-2.5 * PI * PI, 0.0])
                + "follower = true\n"
        };
        let found = solve(&(column("a", 0.0) + &column("b", 1.0) + "[analysis.static]\n"));
        let [warning] = &found.run.warnings[..] else {
            panic!("{basis} {section}: {:?}", found.run.warnings)
        };
        assert!(warning.contains("changes its sign at load factor 0.400"), "{basis} {section}: {warning}");
    }
}

/// Two bars in a line, hinged to each other and brought together at their ends, fold to the side of a
/// small weight where a step of the load presses them by less than π² EI/L² of the longer one, 17.5 N;
/// where it is more, a warning says that it may be the other. A string has nothing that buckles.
#[test]
fn bars_brought_together_fold_to_the_side_of_their_weight() {
    let bar = "bending_stiffness = 1.6\naxial_stiffness = 38e3\nmass_per_length = 1.0";
    let string = "axial_stiffness = 38e3\nmass_per_length = 1.0";
    let ends = "[support.move]\nx = -0.1\n[effect.gravity]\nacceleration = [0.01, -0.1]\n";
    let buckles = |warning: &String| warning.contains("its beams buckle before it moves");
    for basis in [RPIM, "{ ancf = { elements = 5 } }"] {
        // The strain of the whole move times EA is 2235 N.
        for (steps, pressed) in [(1, true), (3, true), (20, true), (200, false)] {
            let analysis = format!("[analysis.static]\nsteps = {steps}\n");
            let bars = beam("a", [[0.0, 0.0], [0.75, 0.0]], bar, basis)
                + &beam("b", [[0.75, 0.0], [1.7, 0.0]], bar, basis)
                + &joint("hinge", ("a", "'end'"), ("b", "'start'"))
                + &support("a", "'start'", PIN)
                + &support("b", "'end'", PIN)
                + ends
                + &probe("a")
                + &analysis;
            let found = solve(&bars);
            assert_eq!(found.run.warnings.iter().any(buckles), pressed, "{basis}, {steps} steps");
            assert!(pressed || tip(&found)[1] < -0.1, "{basis}, {steps} steps: {:?}", tip(&found));
        }
        let hanging = beam("a", [[0.0, 0.0], [1.7, 0.0]], string, basis)
            + &support("a", "'start'", PIN)
            + &support("a", "'end'", PIN)
            + ends
            + "[analysis.static]\n";
        assert!(!solve(&hanging).run.warnings.iter().any(buckles), "{basis}");
    }
}

/// An arc on a pin and a slider whose far end is held at an angle until the second stage: what goes is one
/// couple, so that the stage begins with the reactions with which the first one ended. Where the
/// unbalanced couple was spread along a beam that keeps its length, they were three times as large, and two
/// welded beams came to rest in an unstable equilibrium.
#[test]
fn a_support_that_goes_leaves_all_other_forces_as_they_were() {
    let arc = |name: &str, [foot, head]: [f64; 2], [from, to]: [f64; 2], section: &str, basis: &str| {
        beam(name, [[foot, 0.0], [head, 0.0]], section, basis)
            + &format!(
                "initial_shape.arc = {{ center = [-0.4903256903984984, 1.3182328723187474], radius = 1.4064697609001409, from = {from:?}, to = {to:?} }}\n"
            )
    };
    let (start, end) = (-1.2146963267948965, -0.6458963267948965);
    let part = 4.0 / 9.0;
    let cut = start + part * (end - start);
    let mut tips = Vec::new();
    for (section, basis) in [
        ("bending_stiffness = 1.0", RPIM),
        ("bending_stiffness = 1.0", ANCF),
        ("bending_stiffness = 1.0\naxial_stiffness = 1e6", ANCF),
    ] {
        let one = arc("a", [0.0, 0.8], [start, end], section, basis);
        let two = arc("b", [0.0, 0.8 * part], [start, cut], section, basis)
            + &arc("a", [0.8 * part, 0.8], [cut, end], section, basis)
            + &joint("weld", ("b", "'end'"), ("a", "'start'"));
        for (beams, first) in [(one, "a"), (two, "b")] {
            let text = beams
                + &support(first, "'start'", PIN)
                + &support("a", "'end'", "['angle']")
                + "until = 'two'\n"
                + "[[joint]]\ntype = 'slider'\nalong = [0.07351, -0.9973]\nfirst = { beam = 'a', at = 'end' }\n"
                + &format!("[[effect.moment]]\nbeam = '{first}'\nat = 'start'\nvalue = 0.8194\n")
                + "[[effect.spring]]\nbeam = 'a'\nat = 'end'\nstiffness = 9.397\n"
                + &probe("a")
                + "[output]\nreactions = true\n"
                + "[[stage]]\nname = 'one'\nanalysis.static = {}\n[[stage]]\nname = 'two'\nanalysis.static = {}\n";
            let run = solve_stages(scene(&text).stages(), Options::default());
            let [before, after] = &run.results[..] else { panic!("{:?}", run.failure) };
            assert!(after.run().warnings.is_empty(), "{:?}", after.run().warnings);
            let of = |results: &Results, last: bool| {
                let samples = &results.states().reactions[0].samples;
                let sample = if last { samples.last() } else { samples.first() };
                sample.map(|sample| [sample.fx, sample.fy]).expect("a reaction")
            };
            let ([x, y], [u, v]) = (of(before, true), of(after, false));
            assert!((x - u).hypot(y - v) < 1e-3 * x.hypot(y), "{section} {basis}: {x} {y}, then {u} {v}");
            tips.push(tip(after.states()));
        }
    }
    let [x, y] = tips[0];
    assert!(tips.iter().all(|tip| (tip[0] - x).hypot(tip[1] - y) < 1e-4), "{tips:?}");
}

/// A column between pins that its middle support alone holds straight: beyond π² EI/L², and below the
/// 4 π² EI/L² of two half waves, it is unstable as soon as that is taken away.
#[test]
fn a_structure_that_is_unstable_from_the_start_is_told() {
    for (basis, middle) in [(RPIM, 0.5), (ANCF, 0.5), (ANCF, 0.47)] {
        for (load, follower) in
            [(0.9, ""), (1.1, ""), (2.0, ""), (0.9, "follower = true\n"), (1.1, "follower = true\n")]
        {
            let text = beam(
                "a",
                [[0.0, 0.0], [1.0, 0.0]],
                "bending_stiffness = 1.0\naxial_stiffness = 1e6",
                basis,
            ) + &support("a", "'start'", PIN)
                + &support("a", "'end'", "['y']")
                + &support("a", &format!("{middle:?}"), "['y']")
                + "until = 'free'\n"
                + &force("a", [-load * PI * PI, 0.0])
                + follower
                + "[[stage]]\nname = 'held'\nanalysis.static = {}\n[[stage]]\nname = 'free'\nanalysis.static = {}\n";
            let run = solve_stages(scene(&text).stages(), Options::default());
            assert!(run.failure.is_none(), "{:?}", run.failure);
            let told: Vec<bool> = run
                .results
                .iter()
                .map(|results| {
                    results
                        .run()
                        .warnings
                        .iter()
                        .any(|said| said.contains("begins in a state that is unstable in"))
                })
                .collect();
            assert_eq!(told, [false, load > 1.0], "{load} of the critical load, {basis}, {follower}");
        }
    }
}

/// The row of a tendon of given length along all of a fine mesh would make the determinant of an
/// unsymmetric tangent as dear as that of a dense matrix; that it is not computed is said.
#[test]
fn a_determinant_that_is_too_dear_is_told() {
    for (elements, told) in [(20, false), (300, true)] {
        let found = solve(
            &(beam(
                "a",
                [[0.0, 0.0], [1.0, 0.0]],
                "bending_stiffness = 1.0\naxial_stiffness = 1e5",
                &format!("{{ ancf = {{ elements = {elements} }} }}"),
            ) + &support("a", "'start'", CLAMP)
                + "[[effect.tendon]]\nbeam = 'a'\noffset = 0.02\nshortening = 1e-4\n"
                + &force("a", [0.0, 0.1])
                + "follower = true\n[analysis.static]\n"),
        );
        let said = found.run.warnings.iter().any(|warning| warning.starts_with("stability is not watched:"));
        assert_eq!(said, told, "{elements} elements: {:?}", found.run.warnings);
    }
}

/// A beam on three supports, one of them between nodes, is shortened by forty times what it buckles
/// under, in a field of forces without a potential. Two directions lose their stiffness early in the
/// first step, which leaves the sign of the determinant as it was; the straight state stores 18 times
/// as much energy as the bent one.
#[test]
fn two_instabilities_within_a_step_are_seen_by_a_tangent_without_symmetry() {
    for nodes in [3, 5, 9, 17] {
        let found = solve(&format!(
            "{}{}[support.move]\nx = 0.024\n{}{}[[effect.force_field]]\nbeam = 'a'\nvalue = ['-0.25/(1+x^2)', '-0.37*exp(-y^2/0.27)-0.25*atan(x*y)']\n[analysis.static]\n",
            beam(
                "a",
                [[0.0, 0.0], [1.0, 0.0]],
                "bending_stiffness = 1.0\naxial_stiffness = 84e3",
                &format!("{{ ancf = {{ nodes = {nodes} }} }}")
            ),
            support("a", "'start'", CLAMP),
            support("a", "'end'", PIN),
            support("a", "0.75", "['y']"),
        ));
        let energy = found.energy.last().expect("an equilibrium");
        assert!(energy.bend > 1.2 && energy.stretch < 0.02, "{nodes} nodes: {energy:?}");
    }
}

proptest! {
    #![proptest_config(super::cases(8))]

    /// π²/4, whatever the axial stiffness, the direction, the basis, and a little force across; and
    /// bending alone is told from buckling.
    #[test]
    fn a_little_bending_does_not_change_a_critical_load(
        log in 3.0..9.0_f64,
        extensible in any::<bool>(),
        turn in -PI..PI,
        across in -0.02..0.02_f64,
        basis in prop_oneof![Just(ANCF), Just(RPIM), Just("{ ancf = { elements = 9 } }")],
    ) {
        let section = if extensible { format!("bending_stiffness = 1.0\naxial_stiffness = {:e}", 10f64.powf(log)) } else { "bending_stiffness = 1.0".into() };
        let (s, c) = turn.sin_cos();
        let turned = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
        let buckling = |load| {
            let text = beam("a", [[0.0, 0.0], [c, s]], &section, basis)
                + &support("a", "'start'", CLAMP)
                + &force("a", turned(load))
                + "[analysis.buckling]\ncount = 2\n";
            let scene = scene(&text);
            scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error}\n{text}"))
        };
        let found = buckling([-1.0, across]);
        prop_assert!((found.eigenvalues()[0] / (PI * PI / 4.0) - 1.0).abs() < 5e-4, "{:?}", found.eigenvalues());
        prop_assert!((found.eigenvalues()[1] / (PI * PI * 2.25) - 1.0).abs() < 2e-3, "{:?}", found.eigenvalues());
        let of_the_second = |warning: &String| warning.contains("from number 2 on");
        prop_assert!(found.run().warnings.iter().all(of_the_second), "{:?}", found.run().warnings);
        let bent = buckling([-1.0, 0.5]);
        prop_assert!(bent.run().warnings[0].contains("arc_length"), "{:?}", bent.run().warnings);
        // A force across compresses nothing.
        let bent = buckling([0.0, 1.0]);
        prop_assert!(bent.eigenvalues().iter().all(|load| *load > 20.0), "{:?}", bent.eigenvalues());
        prop_assert!(bent.eigenvalues().is_empty() || bent.run().warnings[0].contains("arc_length"), "{:?}", bent.run().warnings);
    }

    /// One stiff rod on a hinge swings by 3g/2L, two by the frequencies of the double pendulum,
    /// from wherever they start, upright included.
    #[test]
    fn hinged_rods_hang_still_and_swing_by_closed_forms(
        starts in proptest::collection::vec(-PI..PI, 2),
        upright in any::<bool>(),
        log in 3.0..6.0_f64,
        length in prop_oneof![Just(1e-3), Just(1.0), Just(100.0)],
        extensible in any::<bool>(),
        bases in proptest::collection::vec(any::<bool>(), 2),
    ) {
        let weight = 9.81 * length;
        let ei = 10f64.powf(log) * weight * length * length;
        let section = format!("bending_stiffness = {ei:e}\nmass_per_length = 1.0\n{}", if extensible { format!("axial_stiffness = {:e}", 100.0 * ei / (length * length)) } else { String::new() });
        let basis = |rpim: bool| if rpim { "{ rpim = { nodes = 6 } }" } else { "{ ancf = { elements = 4 } }" };
        let along = |start: f64| { let (s, c) = if upright { (1.0, 0.0) } else { start.sin_cos() }; [length * c, length * s] };
        let (a, b) = (along(starts[0]), along(starts[1]));
        let rod = "effect.gravity.acceleration = [0.0, -9.81]\n".to_string()
            + &beam("a", [[0.0, 0.0], a], &section, basis(bases[0])) + &support("a", "'start'", PIN) + &probe("a");
        let two = rod.clone() + &beam("b", [a, [a[0] + b[0], a[1] + b[1]]], &section, basis(bases[1])) + &joint("hinge", ("a", "'end'"), ("b", "'start'"));
        let unit = (9.81 / length).sqrt() / TAU;
        // M = [4/3 1/2; 1/2 1/3], K = diag(3/2, 1/2).
        let expected = [1.5f64.sqrt(), (3.0 - 6.0 / 7f64.sqrt()).sqrt(), (3.0 + 6.0 / 7f64.sqrt()).sqrt()];
        let [x, y] = tip(&solve(&format!("{rod}[analysis.static]\n")));
        prop_assert!(x.abs() < 1e-6 * length && (y / length + 1.0).abs() < 1e-3, "{x} {y}");
        let about = "[analysis.modal]\nabout = 'equilibrium'\ncount = ";
        let one = eigenvalues(&format!("{rod}{about}1\n"));
        prop_assert!((one[0] / (expected[0] * unit) - 1.0).abs() < 2e-3, "{one:?}, {}", expected[0] * unit);
        let both = eigenvalues(&format!("{two}{about}2\n"));
        for (found, expected) in both.iter().zip(&expected[1..]) {
            prop_assert!((found / (expected * unit) - 1.0).abs() < 5e-3, "{both:?}, {expected} {unit}");
        }
    }
}

/// What no load of fixed direction holds is refused, with all the motions that are free.
#[test]
fn mechanisms_that_nothing_holds_are_refused() {
    let section = "axial_stiffness = 1e5\nbending_stiffness = 1e3\nmass_per_length = 1.0";
    let rod = beam("a", [[0.0, 0.0], [1.0, 0.0]], section, ANCF);
    let next = beam("b", [[1.0, 0.0], [2.0, 0.0]], section, ANCF)
        + &joint("hinge", ("a", "'end'"), ("b", "'start'"));
    let weight = "effect.gravity.acceleration = [0.0, -9.81]\n";
    let pinned = rod.clone() + &support("a", "'start'", PIN);
    let moment = "[[effect.moment]]\nbeam = 'a'\nat = 'end'\nvalue = 1.0\n";
    let refused = |text: String, words: &[&str]| {
        let error =
            parse("scene.toml", &text).err().unwrap_or_else(|| panic!("not refused:\n{text}")).to_string();
        assert!(words.iter().all(|words| error.contains(words)), "{error}");
    };
    for analysis in ["[analysis.static]\n", "[analysis.modal]\nabout = 'equilibrium'\ncount = 1\n"] {
        let turn = ["under-supported: it is free for rotation about the point (0, 0)"];
        refused(format!("{pinned}{analysis}"), &turn);
        refused(format!("{pinned}{moment}{analysis}"), &turn);
        for load in ["", weight] {
            let all = ["translation along x, translation along y and rotation about the point (0, 0)"];
            refused(format!("{load}{rod}{analysis}"), &all);
            let rolls = rod.clone() + &support("a", "'start'", "['y']");
            refused(
                format!("{load}{rolls}{analysis}"),
                &["translation along x and rotation about the point (0, 0)"],
            );
        }
        // The lower rod carries nothing.
        refused(
            format!("{pinned}{next}{}{analysis}", force("a", [0.0, -1.0])),
            &["beam `b`", "about the point (1, 0)"],
        );
    }
    refused(format!("{weight}{pinned}[analysis.buckling]\ncount = 1\n"), &["under-supported"]);
    // With weight, other loads of fixed direction take part: 10 N each way at the end of the lower
    // rod, and 9.81 N of each rod.
    let [x, y] = tip(&solve(&format!(
        "{weight}{pinned}{next}{}{}[analysis.static]\n",
        probe("b"),
        force("b", [10.0, -10.0])
    )));
    let rods = [1.5 * 9.81 + 10.0, 0.5 * 9.81 + 10.0]
        .map(|down: f64| [10.0 / down.hypot(10.0), -down / down.hypot(10.0)]);
    assert!((x - rods[0][0] - rods[1][0]).hypot(y - rods[0][1] - rods[1][1]) < 2e-3, "{x} {y}");
}

/// Two rods in the direction `turn`, hinged to each other and to the ground, that grow and so must
/// leave their line, while a weight pulls to one side.
fn toggle(axial_stiffness: &str, turn: f64, basis: &str, side: f64) -> Trajectory {
    let (sine, cosine) = turn.sin_cos();
    let at = |s: f64| [s * cosine, s * sine];
    let section =
        format!("axial_stiffness = {axial_stiffness}\nbending_stiffness = 0.5893\nmass_per_length = 1.0");
    let (x, y) = (-0.001 * side * sine, 0.001 * side * cosine);
    let grows = |beam: &str| format!("[[effect.actuation]]\nbeam = '{beam}'\nstrain = 4.5e-5\n");
    solve(
        &(beam("a", [at(0.0), at(0.5)], &section, basis)
            + &beam("b", [at(0.5), at(1.0)], &section, basis)
            + &joint("hinge", ("a", "'end'"), ("b", "'start'"))
            + &support("a", "'start'", PIN)
            + &support("b", "'end'", PIN)
            + &format!("[effect.gravity]\nacceleration = [{x:?}, {y:?}]\n")
            + &grows("a")
            + &grows("b")
            + &probe("a")
            + "[analysis.static]\n"),
    )
}

/// The side is that to which a weight far smaller than their thrust pulls them, in every direction
/// of the line, where the thrust, 15 N, is less than the 23 N at which a rod by itself would
/// buckle; where it is more, a warning says that it may be the other.
#[test]
fn a_toggle_leaves_its_line_on_the_side_of_its_weight() {
    for turn in [0.0, 0.4, 1.9, -1.2, 3.0] {
        for (basis, side) in [(RPIM, 1.0), (RPIM, -1.0), (ANCF, 1.0), (ANCF, -1.0)] {
            let found = toggle("3.364e5", turn, basis, side);
            let ([px, py], (sine, cosine)) = (tip(&found), turn.sin_cos());
            let across = side * (cosine * (py - 0.5 * sine) - sine * (px - 0.5 * cosine));
            // Each is the hypotenuse over half of the line: 0.5 √((1 + ε)² − 1).
            let expected = 0.5 * (1.000_045_f64.powi(2) - 1.0).sqrt();
            assert!(
                (across / expected - 1.0).abs() < 0.02,
                "{basis} turned by {turn}: {across}, not {expected}"
            );
            assert!(found.run.warnings.is_empty(), "{:?}", found.run.warnings);
            let warnings = toggle("3.364e8", turn, basis, side).run.warnings;
            assert!(
                warnings.iter().any(|warning| warning.contains("buckle before it moves")),
                "{warnings:?}"
            );
        }
    }
}

/// A path ends where it is told to, however long its last step would have been: at a load factor,
/// or where a probe is, whichever comes first.
#[test]
fn a_path_ends_where_its_target_is() {
    for (stiffness, cells) in [("1e4", 4), ("1.66e8", 9)] {
        for until in [
            "until_load = 1.24",
            "until_probe = { probe = 'tip', x = 1.1 }",
            "until_load = 1.24\nuntil_probe = { probe = 'tip', x = 1.1 }",
        ] {
            let section = format!("axial_stiffness = {stiffness}\nbending_stiffness = 0.481");
            let basis = format!("{{ ancf = {{ elements = {cells} }} }}");
            let found = solve(
                &(beam("a", [[0.0, 0.0], [0.5, -0.2]], &section, &basis)
                    + &beam("b", [[0.5, -0.2], [0.935, -0.355]], &section, &basis)
                    + &joint("weld", ("a", "'end'"), ("b", "'start'"))
                    + "[[support]]\nbeam = 'a'\nat = 'start'\nfix = ['x', 'y', 'angle']\nmove = { x = 0.173 }\n"
                    + "[[effect.spring]]\nbeam = 'b'\nat = 0.2\nanchor = [0.294, 0.0263]\nstiffness = 0.385\n"
                    + &probe("b")
                    + "[analysis.static.arc_length]\n"
                    + until),
            );
            let (load, x) = (*found.parameter.last().expect("a point"), tip(&found)[0]);
            if until.contains("probe") {
                assert!((x - 1.1).abs() < 1e-11 && load < 1.2, "{until}: {x} at {load}");
            } else {
                assert_eq!(load, 1.24);
            }
            // The same equilibrium as by load steps to that load.
            let straight = solve(
                &(beam("a", [[0.0, 0.0], [0.5, -0.2]], &section, &basis)
                    + &beam("b", [[0.5, -0.2], [0.935, -0.355]], &section, &basis)
                    + &joint("weld", ("a", "'end'"), ("b", "'start'"))
                    + &format!(
                        "[[support]]\nbeam = 'a'\nat = 'start'\nfix = ['x', 'y', 'angle']\nmove = {{ x = {:e} }}\n",
                        0.173 * load
                    )
                    + "[[effect.spring]]\nbeam = 'b'\nat = 0.2\nanchor = [0.294, 0.0263]\nstiffness = 0.385\n"
                    + &probe("b")
                    + "[analysis.static]\n"),
            );
            let ([x, y], [a, b]) = (tip(&found), tip(&straight));
            assert!((x - a).hypot(y - b) < 1e-8, "{until}: ({x}, {y}), not ({a}, {b})");
        }
    }
}

/// A rod on a hinge that is carried away hangs from where the hinge is then, however far that is
/// beyond the cells beside it.
#[test]
fn a_hinged_rod_goes_with_its_support() {
    let mut runs = 0;
    for nodes in [3, 5, 9, 30] {
        for (x, y) in [(0.12, 0.0), (0.5, 0.4), (-0.3, 0.9)] {
            for steps in [1, 4] {
                for kind in ["ancf", "rpim"].into_iter().filter(|kind| nodes > 3 || *kind == "ancf") {
                    let section = "axial_stiffness = 2200.0\nbending_stiffness = 1.0\nmass_per_length = 1.0";
                    let found = solve(
                        &(beam(
                            "a",
                            [[0.0, 0.0], [0.78, 0.0]],
                            section,
                            &format!("{{ {kind} = {{ nodes = {nodes} }} }}"),
                        ) + &format!(
                            "[[support]]\nbeam = 'a'\nat = 'start'\nfix = ['x', 'y']\nmove = {{ x = {x}, y = {y} }}\n"
                        ) + "[effect.gravity]\nacceleration = [0.14, -0.22]\n"
                            + &probe("a")
                            + &format!("[analysis.static]\nsteps = {steps}\n")),
                    );
                    let [gx, gy] = [0.14, -0.22].map(|g: f64| g / 0.14_f64.hypot(0.22));
                    let [at_x, at_y] = tip(&found);
                    // Its own weight makes it longer by half of its strain at the hinge, 9.2e-5.
                    let off = (at_x - x - 0.78 * gx).hypot(at_y - y - 0.78 * gy);
                    assert!(off < 5e-5, "{kind} {nodes} nodes, moved by ({x}, {y}) in {steps}: off by {off}");
                    assert!(found.run.warnings.is_empty(), "{:?}", found.run.warnings);
                    runs += 1;
                }
            }
        }
    }
    assert_eq!(runs, 42);
}

/// Joints that hold one motion twice are named.
#[test]
fn redundant_joints_are_named() {
    let beams = |section: &str| {
        beam("a", [[0.0, 0.0], [1.0, 0.0]], section, ANCF)
            + &beam("b", [[1.0, 0.0], [2.0, 0.0]], section, RPIM)
            + &support("a", "'start'", CLAMP)
            + &force("b", [0.0, 1.0])
            + "[analysis.static]\n"
    };
    let (elastic, inextensible) =
        ("axial_stiffness = 1e5\nbending_stiffness = 1.0", "bending_stiffness = 1.0");
    let (end, start) = (("a", "'end'"), ("b", "'start'"));
    let at = "s = 1.0000 m of beam `a` and s = 0.0000 m of beam `b`";
    let refused = |text: String, parts: &[&str]| {
        let error = attempt(&text).err().unwrap_or_else(|| panic!("not refused:\n{text}"));
        assert_eq!(error.exit_status(), 2, "{error}");
        let error = error.to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    };
    let (weld, hinge) = (joint("weld", end, start), joint("hinge", end, start));
    let (named_weld, named_hinge) = (format!("the weld of {at}"), format!("the hinge of {at}"));
    for section in [elastic, inextensible] {
        let beams = beams(section);
        refused(
            format!("{beams}{weld}{weld}"),
            &[&format!("{named_weld} and {named_weld} hold the same motion")],
        );
        refused(format!("{beams}{weld}{hinge}"), &[&named_weld, &named_hinge]);
        refused(format!("{beams}{hinge}{}", joint("weld", start, end)), &[&named_hinge, "the weld of"]);
        refused(
            format!("{beams}{weld}{}", joint("hinge", ("a", "0.5"), ("a", "0.5"))),
            &["ties a point to itself"],
        );
        let both = support("b", "'start'", CLAMP) + &support("a", "'end'", PIN);
        refused(format!("{beams}{hinge}{both}"), &[&named_hinge, "the support at s = 0.0000 m of beam `b`"]);
    }
    let far = support("b", "'end'", PIN);
    refused(
        format!("{}{weld}{far}", beams(inextensible)),
        &[&named_weld, "the length that beam `a` keeps", "the support at s = 1.0000 m of beam `b`"],
    );
    solve(&format!("{}{weld}{far}", beams(elastic)));
    // Held once more than it needs to be, but not twice alike: a square with one diagonal, a ring,
    // an arch of straight rods.
    let corner = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut square = String::new();
    for i in 0..4 {
        square += &beam(
            &format!("e{i}"),
            [corner[i], corner[(i + 1) % 4]],
            inextensible,
            "{ ancf = { elements = 2 } }",
        );
        square += &joint("hinge", (&format!("e{i}"), "'end'"), (&format!("e{}", (i + 1) % 4), "'start'"));
    }
    square += &beam("d", [corner[0], corner[2]], inextensible, "{ ancf = { elements = 2 } }");
    square += &joint("hinge", ("d", "'start'"), ("e0", "'start'"));
    square += &joint("hinge", ("d", "'end'"), ("e2", "'start'"));
    square += &(support("e0", "'start'", PIN) + &support("e0", "'end'", "['y']"));
    solve(&format!("{square}{}[analysis.static]\n", force("e1", [1.0, 0.5])));
    let second = beam("f", [corner[1], corner[3]], inextensible, "{ ancf = { elements = 2 } }")
        + &joint("hinge", ("f", "'start'"), ("e1", "'start'"))
        + &joint("hinge", ("f", "'end'"), ("e3", "'start'"));
    refused(
        format!("{square}{second}{}[analysis.static]\n", force("e1", [1.0, 0.5])),
        &[
            "the length that beam `e0` keeps",
            "the length that beam `d` keeps",
            "the length that beam `f` keeps",
        ],
    );
}

/// A path that may not have as many points as it needs is incomplete, and says how far it came.
#[test]
fn a_path_that_does_not_reach_its_target_is_incomplete() {
    let arm = beam("a", [[0.0, 0.0], [1.0, 0.0]], "axial_stiffness = 1e5\nbending_stiffness = 1.0", ANCF)
        + &support("a", "'start'", CLAMP)
        + &probe("a")
        + &force("a", [0.0, 4.0]);
    let path =
        |until: &str| attempt(&format!("{arm}[analysis.static.arc_length]\nmax_step = 0.05\n{until}\n"));
    for (until, target) in [
        ("until_load = 1.0\nmax_points = 4", "before load factor 1"),
        ("until_probe = { probe = 'tip', y = 0.5 }\nmax_points = 4", "before y = 0.5 m of probe `tip`"),
    ] {
        let mut error = path(until).expect_err("not reached");
        assert_eq!(error.exit_status(), 1);
        let message = error.to_string();
        assert!(
            message.contains("`max_points = 4` at load factor 0.") && message.contains(target),
            "{message}"
        );
        let partial = error.take_partial().expect("five states");
        assert!(!partial.run().complete && partial.states().parameter.len() == 5);
    }
    for until in ["max_points = 4", "until_load = 1.0", "until_load = 0.01\nmax_points = 4"] {
        assert!(path(until).expect("reached").run.complete);
    }
}

/// Exact roots of a clamped beam with a mass and a rotary inertia at its tip, and no frequency
/// between them on any mesh.
#[test]
fn rotary_inertia_of_a_point_makes_no_mode_of_its_own() {
    let arm = |basis: &str| {
        beam(
            "a",
            [[0.0, 0.0], [0.02223, 0.0]],
            "axial_stiffness = 14942\nbending_stiffness = 1.1307e-3\nmass_per_length = 9.3049",
            basis,
        ) + &support("a", "'start'", CLAMP)
            + "[[effect.point_mass]]\nbeam = 'a'\nat = 'end'\nmass = 0.03429\nrotary_inertia = 2.3387e-5\n[analysis.modal]\ncount = 4\n"
    };
    for basis in ["{ ancf = { elements = 8 } }", "{ ancf = { elements = 96 } }", "{ rpim = { nodes = 25 } }"]
    {
        let found = eigenvalues(&arm(basis));
        for (found, exact) in found.iter().zip([6.1437, 19.8814, 97.189, 242.15]) {
            assert!((found / exact - 1.0).abs() < 1e-3, "{basis}: {found} and {exact}");
        }
    }
}

/// A flywheel on a free stiff rod, off its middle: by every integrator energy and angular momentum
/// stay, and the rod turns at the speed at which it starts.
#[test]
fn a_flywheel_keeps_energy_and_momentum() {
    for method in [
        "gauss = { tolerance = 1e-6 }",
        "radau = { tolerance = 1e-6 }",
        "generalized_alpha = { step = 5e-4, spectral_radius = 1.0 }",
    ] {
        let text = beam(
            "a",
            [[0.0, 0.0], [1.0, 0.0]],
            "axial_stiffness = 1e4\nbending_stiffness = 10.0\nmass_per_length = 1.0",
            ANCF,
        ) + &support("a", "'start'", PIN)
            + &probe("a")
            + "[[effect.point_mass]]\nbeam = 'a'\nat = 0.75\nrotary_inertia = 0.5\n\
               [[initial_velocity]]\nbeam = 'a'\nrotation = 3.0\nabout = [0, 0]\n"
            + &format!("[analysis.dynamic]\nduration = 2.0\noutput_every = 0.1\n{method}\n");
        let found = solve(&text);
        let energies: Vec<f64> = found.energy.iter().map(|energy| energy.total()).collect();
        // ½ (1/3 + 1/2) 3²
        assert!((energies[0] - 3.75).abs() < 1e-3, "{method}: {}", energies[0]);
        let worst = energies.iter().fold(0.0_f64, |worst, e| worst.max((e - energies[0]).abs()));
        assert!(worst < 2e-3 * energies[0], "{method}: {worst} of {energies:?}");
        let angle = found.probes[0].samples.last().expect("a state").angle;
        assert!((angle - 6.0).abs() < 0.06, "{method}: {angle}");
    }
}

/// A column on an elastic hinge that is pushed by one per cent, and one that heat compresses to 2.4
/// times its critical load in a slight flow, and one that its end presses, in a flow along it, past
/// its second critical load within the first twentieth: however many load steps there are, they
/// bend to the side to which they begin to, in one half-wave.
#[test]
fn the_number_of_load_steps_does_not_choose_the_branch() {
    let pushed = "beam.a = { start = [0, 0], end = [1, 0], axial_stiffness = 259100, bending_stiffness = 1, basis.ancf.nodes = 6 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] },
                   { beam = 'a', at = 'end', fix = ['x', 'y'], move = { x = -0.009241, y = 0.001005 } }]
        effect.torsion_spring = [{ beam = 'a', at = 'end', stiffness = 0.42 }]";
    let heated = "beam.a = { start = [0, 0], end = [0.8, 0], axial_stiffness = 15000, bending_stiffness = 0.9, mass_per_length = 1.5, basis.ancf.nodes = 3 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'a', at = 'end', fix = ['x', 'y', 'angle'] }]
        effect.actuation = [{ beam = 'a', strain = 0.009 }]
        effect.drag = [{ beam = 'a', normal = 0.3, flow = [0.4, -1.0] }]";
    let pressed = "beam.a = { start = [0, 0], end = [-0.3, 1], axial_stiffness = 9000, bending_stiffness = 1, mass_per_length = 2, basis.ancf.elements = 9 }
        support = [{ beam = 'a', at = 'start', fix = ['x', 'y'] }, { beam = 'a', at = 'end', fix = ['x', 'y'], move = { x = -0.1, y = -0.1 } }]
        effect.gravity.acceleration = [-0.7, -0.3]
        effect.drag = [{ beam = 'a', viscous_tangential = 0.01, flow = [0.0, -2.0] }]";
    for system in [pushed, heated, pressed] {
        let middle = |steps: usize| {
            let scene = format!(
                "{system}\nprobe = [{{ name = 'middle', beam = 'a', at = 0.37 }}]\nanalysis.static.steps = {steps}"
            );
            let trajectory = solve(&scene);
            trajectory.probes[0].samples.last().expect("an equilibrium").y
        };
        let expected = middle(20);
        assert!(expected.abs() > 0.02, "the column is bent");
        for steps in [1, 2, 3, 5, 7, 10] {
            let found = middle(steps);
            assert!((found - expected).abs() < 1e-7, "{steps} steps: {found}, not {expected}\n{system}");
        }
    }
}

/// A rod on a hinge whose other end is brought nearer gives way to one side or the other: with
/// nothing across it the side is arbitrary, and told; a little weight across decides it. One that
/// stands on its head falls to where it hangs, on either side.
#[test]
fn an_arbitrary_side_is_told() {
    let rod = |turn: f64, fix: &str, shift: f64, [x, y]: [f64; 2]| {
        let (s, c) = turn.sin_cos();
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [{c:?}, {s:?}], axial_stiffness = 1e6, bending_stiffness = 1e3, mass_per_length = 1, basis.ancf.elements = 2 }}
             support = [{{ beam = 'rod', at = 'start', fix = ['x', 'y'] }}{}]
             effect.gravity.acceleration = [{x:?}, {y:?}]\nprobe = [{{ name = 'tip', beam = 'rod', at = 'end' }}]\nanalysis.static = {{}}\n",
            if fix.is_empty() { String::new() } else { format!(", {{ beam = 'rod', at = 'end', fix = {fix}, move = {{ x = {shift:?} }} }}") }
        );
        let scene = ancf::scene::parse("rod.toml", &text).unwrap_or_else(|error| panic!("{error:?}"));
        let found = scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error:?}"));
        let told = found
            .run()
            .warnings
            .iter()
            .any(|warning| warning.contains("which of them was found is arbitrary"));
        (told, *found.states().probes[0].samples.last().expect("an equilibrium"))
    };
    let (told, tip) = rod(0.0, "['x']", -0.01, [-1.0, 0.0]);
    assert!(told && (tip.y.abs() - (1.0_f64 - 0.99 * 0.99).sqrt()).abs() < 1e-4, "{told} {tip:?}");
    for across in [0.1, -0.1] {
        let (told, tip) = rod(0.0, "['x']", -0.01, [-1.0, across]);
        assert!(!told && tip.y * across > 0.0, "{told} {tip:?}");
    }
    let (told, tip) = rod(PI / 2.0, "", 0.0, [0.0, -9.81]);
    assert!(!told && (tip.y + 1.0).abs() < 1e-4, "{told} {tip:?}");
}
