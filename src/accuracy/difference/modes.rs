//! By how much vibration and buckling modes differ.

use super::kinks::kink;
use super::{Difference, larger};
use crate::accuracy::mesh::{CellErrors, Mesh};
use crate::model::Model;
use crate::results::places::interpolated;
use crate::results::{Errors, ModeShape, Results};

/// The part of the largest error that a value has at least, in proportion to the squares of both.
const LEAST: f64 = 0.1;
/// Bending of a mode, relative to its displacement, that is round-off.
const RIGID: f64 = 1e-5;

/// The difference of the modes of two runs: of values, relative, and of bending in the cells.
///
/// # Errors
/// In words, where they are not as many, or not numbers.
pub fn modes(model: &Model, meshes: &[Mesh], coarse: &Results, fine: &Results) -> Result<Difference, String> {
    let (a, b) = (coarse.eigenvalues(), fine.eigenvalues());
    if a.len() != b.len() {
        return Err(format!("one run has {} values, the other {}", a.len(), b.len()));
    }
    // The frequency of a motion that nothing resists is zero in both.
    let relative = |(a, b): (&f64, &f64)| if a == b { 0.0 } else { (a - b).abs() / b.abs() };
    let seen: Vec<f64> = a.iter().zip(&b).map(relative).collect();
    // Two runs may happen to agree in one value. Errors of bending and of stretching grow with the square of the value.
    let least = |value: &f64| {
        let of_others =
            seen.iter().zip(&b).map(|(error, other)| LEAST * error * (value / other).powi(2).min(1.0));
        of_others.filter(|error| error.is_finite()).fold(0.0, f64::max)
    };
    let mut eigenvalues: Vec<f64> =
        seen.iter().zip(&b).map(|(error, value)| larger(*error, least(value))).collect();
    let result = eigenvalues.iter().copied().fold(0.0, larger);
    // A kink changes the tension of a string, and with it all values by similar parts.
    if kink(model, meshes).is_some() {
        eigenvalues.fill(result);
    }
    if !result.is_finite() {
        return Err("a value is not a number".into());
    }
    let shapes: Vec<(&[ModeShape], &[ModeShape])> =
        coarse.mode_shapes().into_iter().zip(fine.mode_shapes()).collect();
    let mut cells: Vec<CellErrors> = meshes
        .iter()
        .zip(&model.beams)
        .map(|(mesh, beam)| CellErrors {
            squares: vec![0.0; mesh.cells()],
            order: if beam.section.bending_stiffness.is_some() { 2.0 } else { 3.0 },
        })
        .collect();
    let longest = meshes.iter().map(Mesh::length).fold(0.0, f64::max);
    for (a, b) in shapes {
        fn bent(shape: &ModeShape, order: f64) -> &[f64] {
            if order == 2.0 { &shape.curvature } else { &shape.angle }
        }
        // Signs are arbitrary, and one for the whole mode; so is the size.
        let (mut product, mut size, mut largest) = (0.0, 0.0, 0.0_f64);
        for (a, b) in a.iter().zip(b) {
            for (k, s) in a.s.iter().enumerate() {
                product += a.x[k] * interpolated(&b.s, &b.x, *s, false).unwrap_or(0.0);
                product += a.y[k] * interpolated(&b.s, &b.y, *s, false).unwrap_or(0.0);
            }
        }
        for b in b {
            largest = b.x.iter().chain(&b.y).fold(largest, |most, value| most.max(value.abs()));
        }
        let sign = if product < 0.0 { -1.0 } else { 1.0 };
        let mut now: Vec<Vec<f64>> = cells.iter().map(|cells| vec![0.0; cells.squares.len()]).collect();
        for (((a, b), mesh), (cells, now)) in a.iter().zip(b).zip(meshes).zip(cells.iter().zip(&mut now)) {
            let (coarse, fine) = (bent(a, cells.order), bent(b, cells.order));
            // The finer run knows all places of the coarse one, and more.
            for (k, s) in a.s.windows(2).enumerate() {
                let ends = interpolated(&b.s, fine, s[0], true).zip(interpolated(&b.s, fine, s[1], false));
                let Some((from, to)) = ends else { continue };
                let (value, other) = (0.5 * (from + to), 0.5 * (coarse[k] + coarse[k + 1]));
                let middle = 0.5 * (s[0] + s[1]);
                let cell = mesh.nodes.partition_point(|node| *node <= middle).saturating_sub(1);
                size += value * value * (s[1] - s[0]);
                if let Some(cell) = now.get_mut(cell) {
                    *cell += (value - sign * other).powi(2) * (s[1] - s[0]);
                }
            }
        }
        // A rigid motion bends nothing; what is left of it is round-off.
        if size * longest.powi(3) <= (RIGID * largest).powi(2) {
            continue;
        }
        for (cells, now) in cells.iter_mut().zip(now) {
            cells.squares.iter_mut().zip(now).for_each(|(most, now)| *most = larger(*most, now / size));
        }
    }
    Ok(Difference {
        errors: Errors { result, curvature: None, section_force: None },
        eigenvalues,
        cells,
        ..Difference::default()
    })
}

/// What round-off may change the values of a run by; `None` where that is nothing, and for states.
pub(in crate::accuracy) fn round_off(results: &Results) -> Option<Difference> {
    let eigenvalues = results.round_off();
    let result = eigenvalues.iter().copied().fold(0.0, larger);
    (result > 0.0).then(|| Difference {
        errors: Errors { result, curvature: None, section_force: None },
        eigenvalues,
        ..Difference::default()
    })
}

#[cfg(test)]
mod tests {
    use super::super::between;
    use super::super::tests::{meshes, scene};
    use super::*;
    use crate::results::{BucklingMode, CriticalLoads, Vibration, Vibrations};

    /// The bent beam and the string in a mode, with values at `s` as parts of their lengths.
    fn shapes(s: &[f64], beam: [&[f64]; 3], string: [&[f64]; 3]) -> Vec<ModeShape> {
        let shape = |length: f64, [x, y, bent]: [&[f64]; 3]| ModeShape {
            s: s.iter().map(|s| s * length).collect(),
            x: x.into(),
            y: y.into(),
            ..if length == 2.0 {
                ModeShape { curvature: bent.into(), angle: vec![7.0; s.len()], ..ModeShape::default() }
            } else {
                ModeShape { angle: bent.into(), curvature: vec![7.0; s.len()], ..ModeShape::default() }
            }
        };
        vec![shape(2.0, beam), shape(4.0, string)]
    }

    fn vibrations(modes: Vec<(f64, Vec<ModeShape>)>) -> Results {
        let modes = modes
            .into_iter()
            .map(|(frequency, shape)| Vibration { frequency, round_off: 0.0, shape })
            .collect();
        Results::from(Vibrations { modes, ..Vibrations::default() })
    }

    #[test]
    fn differences_of_modes_do_not_depend_on_their_signs() {
        let scene = scene("modal.count = 1");
        let of = |coarse: &Results, fine: &Results| {
            between(scene.model(), scene.analysis(), &meshes(), coarse, fine)
        };
        let (few, many) = ([0.0, 0.5, 1.0], [0.0, 0.25, 0.5, 0.75, 1.0]);
        let none = [0.0; 5];
        let coarse = |sign: f64| {
            let [beam, string] = [[-2.0, -2.0, -1.0], [1.0, 1.0, 0.0]].map(|v| v.map(|v| sign * v));
            shapes(&few, [&[0.0; 3], &[0.0, -sign, -4.0 * sign], &beam], [&[0.0; 3], &[0.0; 3], &string])
        };
        let fine =
            || shapes(&many, [&none, &[0.0, 0.25, 1.0, 2.25, 4.0], &[2.0; 5]], [&none, &none, &[-1.0; 5]]);
        // The coarse spaces are 1 m long, in the second cell, with curvatures of 2 and 1.5 in place of 2. On
        // the string, where they are 2 m long, angles are 1 and 0.5 in place of 1. Both count in the size,
        // 4·2 + 1·4.
        let expected = [vec![0.0, 0.25 / 12.0], vec![2.0 * 0.25 / 12.0]];
        for sign in [1.0, -1.0] {
            let found = of(&vibrations(vec![(1.1, coarse(sign))]), &vibrations(vec![(1.0, fine())])).unwrap();
            assert!(
                (found.eigenvalues[0] - 0.1).abs() < 1e-15 && found.errors.result == found.eigenvalues[0]
            );
            assert_eq!(found.cells.iter().map(|cells| cells.order).collect::<Vec<_>>(), [2.0, 3.0]);
            for (found, expected) in found.cells.iter().zip(&expected) {
                assert!(found.squares.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
            }
        }
        // A mode along x has its sign from there. The square of what bends it, ∫ κ² ds = 2 m κ² times the
        // cube of 4 m, is more than the square of 1e-5 of its displacement; with half of that curvature
        // it is less, as in a rigid motion, and counts for nothing.
        let along = |places: &[f64], x: f64, bent: f64| {
            let [x, y, bent, zero] = [x, 0.0, bent, 0.0].map(|value| vec![value; places.len()]);
            shapes(places, [&x, &y, &bent], [&zero, &zero, &zero])
        };
        for (size, squares) in [(1e-6, [0.25, 0.75]), (5e-7, [0.0, 0.0])] {
            let (a, b) = (along(&many, -1.0, -2.0 * size), along(&many, 1.0, size));
            let found = of(&vibrations(vec![(0.0, a)]), &vibrations(vec![(0.0, b)])).unwrap();
            assert_eq!(found.eigenvalues, [0.0], "a frequency of zero in both runs");
            assert!(
                found.cells[0].squares.iter().zip(squares).all(|(a, b)| (a - b).abs() < 1e-9),
                "{found:?}"
            );
        }
        // All frequencies of a string with something within it err by the same part.
        let kinked = super::super::tests::scene(
            "modal.count = 1\neffect.point_mass = [{ beam = 'rope', at = 1, mass = 1 }]",
        );
        let two = |first: f64, second: f64| vibrations(vec![(first, fine()), (second, fine())]);
        for (scene, errors) in [(&scene, [0.0125 / 64.0, 0.125]), (&kinked, [0.125; 2])] {
            let found =
                between(scene.model(), scene.analysis(), &meshes(), &two(1.0, 9.0), &two(1.0, 8.0)).unwrap();
            assert_eq!(found.eigenvalues[1], errors[1]);
            assert!((found.eigenvalues[0] - errors[0]).abs() < 1e-15, "{found:?}");
        }
        // Runs with different numbers of values cannot be compared, nor those that are none.
        let one = |value: f64| vibrations(vec![(value, fine())]);
        assert!(of(&vibrations(Vec::new()), &one(1.0)).is_err());
        // Where nothing buckles on either mesh they agree.
        assert_eq!(of(&vibrations(Vec::new()), &vibrations(Vec::new())).unwrap().errors.result, 0.0);
        assert!(of(&one(f64::NAN), &one(1.0)).is_err());
        let load = |load_factor: f64| {
            let modes = vec![BucklingMode { load_factor, round_off: 0.0, shape: fine() }];
            Results::from(CriticalLoads { modes, ..CriticalLoads::default() })
        };
        assert_eq!(of(&load(-3.0), &load(-4.0)).unwrap().eigenvalues, [0.25]);
    }
}
