//! Critical loads of structures of several beams, and of what has none.

use std::f64::consts::PI;

use ancf::results::Results;
use ancf::scene::parse;
use proptest::prelude::*;

/// First solution of tan z = z, squared: the critical load of a column that is clamped at one end
/// and pinned at the other, in EI/L².
const CLAMPED_PINNED: f64 = 20.190_728_556_426_63;

fn solve(text: &str) -> Results {
    let scene = parse("scene.toml", text).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    scene.model().solve(scene.analysis()).unwrap_or_else(|error| panic!("{error:?}\n{text}"))
}

/// A column of unit length and bending stiffness in the direction `turn`, of as many beams as
/// `cells` has numbers of elements, one welded to the next; it is clamped at its start, pinned at
/// its end, and would shrink by `strain`.
fn column(cells: &[usize], axial_stiffness: f64, turn: f64, strain: f64) -> String {
    let (sine, cosine) = turn.sin_cos();
    let at = |k: usize| {
        let s = k as f64 / cells.len() as f64;
        format!("[{:?}, {:?}]", s * cosine, s * sine)
    };
    let mut text = String::from("[analysis.buckling]\ncount = 1\n");
    for (k, elements) in cells.iter().enumerate() {
        text += &format!(
            "[beam.b{k}]\nstart = {}\nend = {}\naxial_stiffness = {axial_stiffness:e}\nbending_stiffness = 1.0\n\
             basis.ancf.elements = {elements}\n[[effect.actuation]]\nbeam = \"b{k}\"\nstrain = {strain:?}\n",
            at(k),
            at(k + 1)
        );
        if k > 0 {
            text += &format!(
                "[[joint]]\ntype = \"weld\"\nfirst = {{ beam = \"b{}\", at = \"end\" }}\nsecond = {{ beam = \"b{k}\", at = \"start\" }}\n",
                k - 1
            );
        }
    }
    let support = |beam: usize, at: &str, fix: &str| {
        format!("[[support]]\nbeam = \"b{beam}\"\nat = \"{at}\"\nfix = {fix}\n")
    };
    text + &support(0, "start", r#"["x", "y", "angle"]"#) + &support(cells.len() - 1, "end", r#"["x", "y"]"#)
}

proptest! {
    #![proptest_config(super::cases(24))]

    /// Held at its length, a column that would shrink is pulled, and buckles under no part of the
    /// load, however stiff it is and however fine its mesh; one that would grow buckles by Euler's
    /// formula.
    #[test]
    fn a_welded_column_buckles_where_it_is_pressed(
        cells in proptest::collection::vec(4..30_usize, 1..4),
        log in 2.0..10.0_f64,
        turn in prop_oneof![Just(0.0), -PI..PI],
        strain in 0.001..0.01_f64,
    ) {
        let axial_stiffness = 10f64.powf(log);
        let pulled = solve(&column(&cells, axial_stiffness, turn, -strain));
        prop_assert!(pulled.eigenvalues().is_empty(), "{:?}", pulled.eigenvalues());
        let pressed = solve(&column(&cells, axial_stiffness, turn, strain));
        let expected = CLAMPED_PINNED / (axial_stiffness * strain);
        // Four elements, the fewest, err by 0.1 %.
        prop_assert!((pressed.eigenvalues()[0] / expected - 1.0).abs() < 2e-3, "{:?} {expected}", pressed.eigenvalues());
        prop_assert!(pressed.run().warnings.is_empty(), "{:?}", pressed.run().warnings);
    }
}

proptest! {
    #![proptest_config(super::cases(24))]

    /// A column that keeps its length and stands on its foot buckles under its own weight at
    /// ρA g L³/EI = 7.8373 (Greenhill 1881), whichever way is up: along its axis it has no stiffness
    /// but the round-off of the direction.
    #[test]
    fn a_column_that_keeps_its_length_stands_in_every_direction(
        elements in 4..40_usize,
        rpim in any::<bool>(),
        turn in prop_oneof![(-4..5_i32).prop_map(|quarters| f64::from(quarters) * 0.5 * PI), -PI..PI],
        foot in prop_oneof![Just("angle"), Just("gradient")],
    ) {
        let (sine, cosine) = turn.sin_cos();
        let basis = if rpim { format!("rpim.nodes = {}", elements.min(20) + 1) } else { format!("ancf.elements = {elements}") };
        let loads = solve(&format!(
            "beam.a = {{ start = [0, 0], end = [{cosine:e}, {sine:e}], bending_stiffness = 1, mass_per_length = 1, basis.{basis} }}
            support = [{{ beam = \"a\", at = \"start\", fix = [\"x\", \"y\", \"{foot}\"] }}]
            effect.gravity.acceleration = [{:e}, {:e}]
            analysis.buckling.count = 1",
            -cosine, -sine,
        ));
        // Four cubic elements err by 3e-4.
        prop_assert!((loads.eigenvalues()[0] - 7.83734744).abs() < 5e-3, "{:?}", loads.eigenvalues());
    }
}

/// A string has no stiffness across it before it is loaded, from which linear buckling would start;
/// one that rests on a foundation has.
#[test]
fn strings_have_no_critical_load() {
    let text = |turn: f64, more: &str| {
        let (sine, cosine) = turn.sin_cos();
        format!(
            "[beam.cable]\nstart = [0, 0]\nend = [{cosine:?}, {sine:?}]\naxial_stiffness = 100\nmass_per_length = 1\nbasis.ancf.elements = 6\n\
             [[support]]\nbeam = \"cable\"\nat = \"start\"\nfix = [\"x\", \"y\"]\n\
             [effect.gravity]\nacceleration = [0, -9.81]\n{more}[analysis.buckling]\ncount = 1\n"
        )
    };
    for turn in [0.0, 0.4, 1.6, -2.5] {
        let error =
            parse("scene.toml", &text(turn, "")).expect_err("a string that is asked for its buckling");
        assert!(error.to_string().contains("no bending stiffness"), "{error}");
    }
    let bedded = "[[effect.foundation]]\nbeam = \"cable\"\nstiffness = [10, 10]\n";
    assert!(parse("scene.toml", &text(0.4, bedded)).is_ok());
}

/// Green's strain lets a bar give way at loads of the order of EA, without end and different on
/// every mesh: what lies so far beyond small strains is told, from its number on. A slender column
/// is not.
#[test]
fn critical_loads_at_large_strains_are_told() {
    for (stiffness, told) in
        [("80", Some("from number 2 on")), ("1e5", None), ("20", Some("the loads strain"))]
    {
        for basis in ["ancf.elements = 12", "rpim.nodes = 13"] {
            let found = solve(&format!(
                "[beam.a]\nstart = [0, 0]\nend = [1, 0]\nstrain = \"green\"\naxial_stiffness = {stiffness}\nbending_stiffness = 1\n\
                 basis.{basis}\n[[support]]\nbeam = \"a\"\nat = \"start\"\nfix = [\"x\", \"y\", \"angle\"]\n\
                 [[effect.force]]\nbeam = \"a\"\nat = \"end\"\nvalue = [-1, 0]\n[analysis.buckling]\ncount = 3\n"
            ));
            let warned =
                found.run().warnings.iter().filter(|warning| warning.contains("strain the beam")).count();
            assert_eq!(warned, usize::from(told.is_some()), "{stiffness}: {:?}", found.run().warnings);
            assert!(
                told.is_none_or(|words| found.run().warnings[0].contains(words)),
                "{:?}",
                found.run().warnings
            );
        }
    }
}

/// A beam on a hinge turns without resistance, wherever else a spring stands; a spring on it, or
/// about the hinge, holds it.
#[test]
fn springs_hold_the_motions_that_they_resist_and_no_others() {
    let structure = |spring: &str| {
        let text = format!(
            "beam.a = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 4 }}
             beam.b = {{ start = [1, 0], end = [2, 0], axial_stiffness = 1e4, bending_stiffness = 1, basis.ancf.elements = 4 }}
             support = [{{ beam = 'a', at = 'start', fix = ['x', 'y', 'angle'] }}]
             joint = [{{ type = 'hinge', first = {{ beam = 'a', at = 'end' }}, second = {{ beam = 'b', at = 'start' }} }}]
             effect.force = [{{ beam = 'b', at = 'end', value = [-1, 0] }}]
             {spring}\nanalysis.buckling.count = 1\n"
        );
        parse("scene.toml", &text).map(|scene| scene.model().solve(scene.analysis()).expect("critical loads"))
    };
    for free in [
        "spring = [{ beam = 'a', at = 'end', stiffness = 10 }]",
        "torsion_spring = [{ beam = 'a', at = 0.5, stiffness = 1 }]",
        "foundation = [{ beam = 'a', stiffness = [1, 1] }]",
    ] {
        let refused = structure(&format!("effect.{free}")).expect_err("a mechanism").to_string();
        assert!(
            refused.contains("beam `b` is under-supported: it is free for rotation about the point (1, 0)"),
            "{refused}"
        );
    }
    for held in [
        "spring = [{ beam = 'b', at = 'end', stiffness = 10 }]",
        "torsion_spring = [{ beam = 'b', at = 'start', stiffness = 1 }]",
        "foundation = [{ beam = 'b', stiffness = [0, 1] }]",
    ] {
        let found = structure(&format!("effect.{held}")).unwrap_or_else(|error| panic!("{held}: {error}"));
        assert!(!found.eigenvalues().is_empty(), "{held}");
    }
}
