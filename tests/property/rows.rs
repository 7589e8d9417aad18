//! Rows of constraints by themselves: values by the fields that they combine, derivatives by
//! differences, and what they do to the beam.

use ancf::basis::{Basis, BasisTable, Discretization, Nodes};
use ancf::system::constraints::{Constraint, Row};
use ancf::system::prescribed::Prescribed;

/// First coefficient of the beam: three nodes of another one come before.
const OFFSET: usize = 6;
/// Coordinates of both.
const COORDINATES: usize = 2 * (OFFSET + 8);

fn table(s: f64, order: usize) -> BasisTable {
    let discretization = Discretization::Ancf { nodes: Nodes::Given(vec![0.0, 0.5, 1.4, 2.0]) };
    Basis::new(&discretization, 2.0).expect("nodes").points(&[s], &[order]).expect("on the beam")
}

/// Coordinates without any order, different for each `phase`.
fn state(phase: f64) -> Vec<f64> {
    (0..COORDINATES).map(|i| (1.7 * i as f64 + phase).sin() + 0.3 * (0.6 * i as f64).cos()).collect()
}

/// The field of a table of one row in a state.
fn field(table: &BasisTable, q: &[f64]) -> [f64; 2] {
    let (_, row) = table.block(table.cells[0]);
    let first = 2 * (OFFSET + table.cells[0].first as usize);
    let mut sum = [0.0; 2];
    for (a, n) in row.iter().enumerate() {
        sum[0] += n * q[first + 2 * a];
        sum[1] += n * q[first + 2 * a + 1];
    }
    sum
}

fn prescribed(start: f64, change: f64) -> Prescribed {
    Prescribed { start, change, law: None }
}

fn single(s: f64, order: usize, row: Row) -> Constraint {
    Constraint::new(&table(s, order), OFFSET, row)
}

fn joint(order: usize, normals: Vec<[f64; 2]>, value: f64) -> Constraint {
    let tables = [table(0.2, order), table(1.7, order)];
    let mut joint = Constraint::joint(tables.iter().take(normals.len()).map(|t| (t, OFFSET)), order, normals);
    joint.add_to_sum(value);
    joint
}

fn angle(angle: f64) -> Constraint {
    let tables = [table(0.2, 1), table(1.7, 1)];
    Constraint::angle([(&tables[0], OFFSET), (&tables[1], OFFSET)], angle)
}

fn length(reference: &[f64]) -> Constraint {
    let tables = [table(0.7, 1), table(0.9, 1), table(1.3, 1)];
    let points: Vec<(usize, &[f64], f64)> = tables
        .iter()
        .zip([0.2, 0.5, 0.3])
        .map(|(t, weight)| (2 * (OFFSET + t.cells[0].first as usize), t.block(t.cells[0]).1, weight))
        .collect();
    Constraint::length(&points, reference)
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The value of a row at a load factor and a state.
type Formula = Box<dyn Fn(f64, &[f64]) -> f64>;

fn by(formula: impl Fn(f64, &[f64]) -> f64 + 'static) -> Formula {
    Box::new(formula)
}

/// Every kind of row with its formula.
fn rows() -> Vec<(&'static str, Constraint, Formula)> {
    let normals = || vec![[0.6, -0.8], [-0.3, 0.4]];
    let mut rows: Vec<(&'static str, Constraint, Formula)> = Vec::new();
    for axis in 0..2 {
        rows.push((
            "position",
            single(0.8, 0, Row::Position { axis, value: prescribed(0.3, 0.7) }),
            by(move |load, q| field(&table(0.8, 0), q)[axis] - 0.3 - 0.7 * load),
        ));
        rows.push((
            "gradient",
            single(1.1, 1, Row::Gradient { axis, reference: [0.8, 0.6], rotation: prescribed(0.2, 1.3) }),
            by(move |load, q| {
                let (sine, cosine) = f64::sin_cos(0.2 + 1.3 * load);
                let held = [0.8 * cosine - 0.6 * sine, 0.8 * sine + 0.6 * cosine];
                field(&table(1.1, 1), q)[axis] - held[axis]
            }),
        ));
    }
    rows.push((
        "direction",
        single(1.9, 1, Row::Direction(prescribed(0.4, -0.9))),
        by(|load, q| {
            let (sine, cosine) = f64::sin_cos(0.4 - 0.9 * load);
            dot([-sine, cosine], field(&table(1.9, 1), q))
        }),
    ));
    for order in 0..2 {
        rows.push((
            "joint",
            joint(order, normals(), 0.05),
            by(move |_, q| {
                let [a, b] = [0.2, 1.7].map(|s| field(&table(s, order), q));
                dot([0.6, -0.8], a) + dot([-0.3, 0.4], b) - 0.05
            }),
        ));
    }
    rows.push((
        "slider",
        joint(0, vec![[0.6, -0.8]], -0.2),
        by(|_, q| dot([0.6, -0.8], field(&table(0.2, 0), q)) + 0.2),
    ));
    rows.push((
        "angle",
        angle(0.3),
        by(|_, q| {
            let [a, b] = [0.2, 1.7].map(|s| field(&table(s, 1), q));
            let turn = b[1].atan2(b[0]) - a[1].atan2(a[0]) - 0.3;
            turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round()
        }),
    ));
    rows.push((
        "length",
        length(&state(4.0)),
        by(|_, q| {
            let reference = state(4.0);
            let of = |(s, weight): (f64, f64)| {
                let [now, before] = [q, &reference[..]].map(|q| field(&table(s, 1), q));
                0.5 * weight * (dot(now, now) - dot(before, before))
            };
            [(0.7, 0.2), (0.9, 0.5), (1.3, 0.3)].map(of).iter().sum()
        }),
    ));
    rows
}

const STATES: [f64; 3] = [0.0, 1.1, 2.5];

#[test]
fn rows_have_the_value_of_their_formula() {
    for (name, row, formula) in rows() {
        for (load, phase) in [0.0, 0.4, 1.0].into_iter().zip(STATES) {
            let q = state(phase);
            let (value, expected) = (row.value(load, &q), formula(load, &q));
            assert!((value - expected).abs() < 1e-13, "{name}: {value}, not {expected}");
            let units = if matches!(name, "position" | "slider" | "length") { 2.5 } else { 1.0 };
            if name != "joint" {
                let miss = row.miss(load, &q, 2.5);
                assert!((miss - expected.abs() / units).abs() < 1e-13, "{name}: {miss} of {expected}");
                let scale = if units == 2.5 { 40.0 / 2.5 } else { 40.0 * 2.5 };
                assert_eq!(row.scale(40.0, 2.5), scale, "{name}");
            }
        }
    }
    let [of_positions, of_gradients] = [0, 1].map(|order| joint(order, vec![[1.0, 0.0], [-1.0, 0.0]], 0.0));
    assert_eq!((of_positions.scale(40.0, 2.5), of_gradients.scale(40.0, 2.5)), (16.0, 100.0));
    let q = state(0.0);
    let [a, b] = [&of_positions, &of_gradients].map(|row| (row.value(0.0, &q), row.miss(0.0, &q, 2.5)));
    assert!((a.1 - a.0.abs() / 2.5).abs() < 1e-14 && (b.1 - b.0.abs()).abs() < 1e-14, "{a:?} {b:?}");
}

/// ∂g/∂q, ∂g/∂λ and ∂²g/∂q∂q by central differences.
#[test]
fn derivatives_of_rows_are_those_of_their_values() {
    for (name, row, _) in rows() {
        for (load, phase) in [0.0, 0.4, 1.0].into_iter().zip(STATES) {
            let q = state(phase);
            let dense = |q: &[f64]| {
                let mut gradient = vec![0.0; COORDINATES];
                row.gradient(load, q).for_each(|(i, value)| gradient[i] += value);
                gradient
            };
            let moved = |i: usize, by: f64| {
                let mut q = q.clone();
                q[i] += by;
                q
            };
            let mut second = vec![vec![0.0; COORDINATES]; COORDINATES];
            row.second_derivative(&q).for_each(|(i, j, value)| second[i][j] += value);
            let (h, gradient) = (2e-6, dense(&q));
            let mut touched = Vec::new();
            for i in 0..COORDINATES {
                let slope = (row.value(load, &moved(i, h)) - row.value(load, &moved(i, -h))) / (2.0 * h);
                assert!((slope - gradient[i]).abs() < 1e-8, "{name}, q{i}: {} and {slope}", gradient[i]);
                if gradient[i] != 0.0 {
                    touched.push(i);
                }
                let (after, before) = (dense(&moved(i, h)), dense(&moved(i, -h)));
                for j in 0..COORDINATES {
                    let slope = (after[j] - before[j]) / (2.0 * h);
                    let found = second[i][j];
                    assert!((slope - found).abs() < 1e-7, "{name}, q{i} q{j}: {found} and {slope}");
                    let mirrored = second[j][i];
                    assert!((found - mirrored).abs() < 1e-14, "{name}, q{i} q{j}: {found} {mirrored}");
                }
            }
            let slope = (row.value(load + h, &q) - row.value(load - h, &q)) / (2.0 * h);
            assert!((slope - row.rate(load, &q)).abs() < 1e-8, "{name}: {} and {slope}", row.rate(load, &q));
            let v = state(phase + 0.5);
            let curvature: f64 = (0..COORDINATES)
                .flat_map(|i| (0..COORDINATES).map(move |j| (i, j)))
                .map(|(i, j)| v[i] * second[i][j] * v[j])
                .sum();
            assert!((row.curvature(&q, &v) - curvature).abs() < 1e-11 * (1.0 + curvature.abs()), "{name}");
            assert_eq!(row.is_nonlinear(), matches!(name, "angle" | "length"), "{name}");
            // Shape functions of the beam alone, from the first that it combines on.
            assert!(touched.iter().all(|i| *i >= row.first()) && touched[0] < row.first() + 2, "{name}");
            match row.span() {
                Some(span) => {
                    assert!(!matches!(name, "joint" | "angle" | "length"), "{name} is not of one point");
                    assert_eq!(span, row.first()..row.first() + 8);
                    assert!(touched.iter().all(|i| span.contains(i)), "{name}");
                }
                None => assert!(matches!(name, "joint" | "angle" | "length"), "{name}"),
            }
            assert_eq!(row.is_slider(), name == "slider");
        }
    }
}

/// −μ n acts at the point of a position, and −μ r' × n is the couple of a gradient; of a length
/// nothing acts from without.
#[test]
fn rows_act_on_the_beam_by_their_normals() {
    let (q, mu, load) = (state(1.1), 2.5, 0.4);
    let rotated = |x: [f64; 2], y: [f64; 2]| x[0] * y[1] - x[1] * y[0];
    for (name, row, _) in rows() {
        let found: Vec<_> = row.actions(load, &q, mu).collect();
        let (last, of_gradient) = row.last_field(load, &q);
        let (places, order): (&[f64], usize) = match name {
            "position" => (&[0.8], 0),
            "gradient" => (&[1.1], 1),
            "direction" => (&[1.9], 1),
            "joint" => (&[0.2, 1.7], usize::from(of_gradient.is_some())),
            "slider" => (&[0.2], 0),
            "angle" => (&[0.2, 1.7], 1),
            _ => (&[], 1),
        };
        assert_eq!(found.len(), places.len(), "{name}");
        assert_eq!(of_gradient.is_some(), order == 1, "{name}");
        let dense =
            |i: usize| -> f64 { row.gradient(load, &q).filter(|(j, _)| *j == i).map(|(_, v)| v).sum() };
        for ((first, s, action), place) in found.iter().zip(places) {
            let (point, table) = (field(&table(*place, order), &q), table(*place, order));
            assert_eq!((*first, *s), (2 * (OFFSET + table.cells[0].first as usize), *place), "{name}");
            // n is ∂g/∂q by any shape function.
            let (_, shape) = table.block(table.cells[0]);
            let n = [0, 1].map(|d| dense(first + d) / shape[0]);
            let force = n.map(|n| -mu * n);
            let moment = rotated(point, force);
            assert!((action.moment - moment).abs() < 1e-12, "{name}: {} N m, not {moment}", action.moment);
            for (found, expected) in [action.force.x, action.force.y].into_iter().zip(force) {
                let expected = if order == 0 { expected } else { 0.0 };
                assert!((found - expected).abs() < 1e-12, "{name}: {found} N, not {expected}");
            }
            if places.last() == Some(place) {
                assert!((last[0] - n[0]).hypot(last[1] - n[1]) < 1e-12, "{name}: {last:?}");
                assert!(of_gradient.is_none_or(|r| r == point), "{name}: {of_gradient:?}");
            }
        }
    }
}

/// What a support holds of a position is how far it has come; a joint opens and closes; a state in
/// which a motion is taken up is held as it is.
#[test]
fn rows_hold_what_they_are_told_to() {
    let q = state(2.5);
    for axis in 0..2 {
        let mut row = single(0.8, 0, Row::Position { axis, value: prescribed(0.3, 0.7) });
        let here = field(&table(0.8, 0), &q)[axis];
        let (of, change) = row.position_change(0.5, &q).expect("a position");
        assert!(of == axis && (change - (0.3 + 0.35 - here)).abs() < 1e-14, "{change}");
        row.freeze(&q, 2.0);
        assert!(row.value(0.0, &q).abs() < 1e-14, "{}", row.value(0.0, &q));
    }
    for row in [Row::Direction(prescribed(0.4, 0.0)), Row::Direction(prescribed(-3.0, 0.0))] {
        let mut row = single(1.9, 1, row);
        assert!(row.position_change(0.5, &q).is_none() && row.value(0.0, &q).abs() > 1e-3);
        row.freeze(&q, 2.0);
        assert!(row.value(0.0, &q).abs() < 1e-13, "{}", row.value(0.0, &q));
    }
    // The gradient is turned to its direction; its length stays.
    let there = field(&table(1.1, 1), &q);
    for axis in 0..2 {
        let rotation = prescribed(0.2, 0.0);
        let mut row = single(1.1, 1, Row::Gradient { axis, reference: [0.8, 0.6], rotation });
        row.freeze(&q, 2.0);
        let expected = there[axis] - there[axis] / there[0].hypot(there[1]);
        assert!((row.value(0.0, &q) - expected).abs() < 1e-13, "{}", row.value(0.0, &q));
    }
    let mut open = joint(0, vec![[0.6, -0.8], [-0.3, 0.4]], 0.05);
    let before = open.value(0.0, &q);
    open.add_to_sum(0.2);
    assert!((open.value(0.0, &q) - (before - 0.2)).abs() < 1e-14);
    assert!((open.closed().value(0.0, &q) - (before + 0.05)).abs() < 1e-14);
    // What follows a law goes by it, and what is there but for round-off stays as it is written.
    let law = Some(ancf::model::Law::Step { start: 2.0 });
    let mut row =
        single(0.8, 0, Row::Position { axis: 0, value: Prescribed { law, ..prescribed(0.3, 0.7) } });
    let here = field(&table(0.8, 0), &q)[0];
    row.freeze(&q, 2.0);
    assert!((row.value(1.0, &q) - (here - 0.3)).abs() < 1e-14);
    assert!((row.value(3.0, &q) - (here - 1.0)).abs() < 1e-14);
    let mut near = prescribed(0.3, 0.0);
    near.freeze(0.3 + 1.9e-9, 2.0);
    assert_eq!(near.start, 0.3);
    near.freeze(0.3 + 2.1e-9, 2.0);
    assert_eq!(near.start, 0.3 + 2.1e-9);
}

/// Start, change and law of what is prescribed, with its rates.
#[test]
fn what_is_prescribed_has_its_rates() {
    let by_load = prescribed(0.5, 2.0);
    assert_eq!((by_load.at(0.25), by_load.rates(0.25)), (1.0, [1.0, 2.0, 0.0]));
    assert_eq!(by_load.prescribed(0.25), [0.5, 0.0, 0.0], "a motion moves by laws alone");
    assert!(by_load.moves() && !by_load.moves_in_time());
    let law = Some(ancf::model::Law::Polynomial(vec![0.0, 1.0, 3.0]));
    let by_law = Prescribed { law, ..prescribed(0.5, 2.0) };
    // f = t + 3 t², f' = 1 + 6 t, f'' = 6 at t = 0.5.
    assert_eq!(by_law.at(0.5), 3.0);
    assert_eq!((by_law.rates(0.5), by_law.prescribed(0.5)), ([3.0, 8.0, 12.0], [3.0, 8.0, 12.0]));
    assert!(by_law.moves() && by_law.moves_in_time());
    let still = Prescribed { change: 0.0, ..by_law };
    assert!(!still.moves() && !still.moves_in_time());
    assert_eq!(still.rates(0.5), [0.5, 0.0, 0.0]);
}
