//! Supports at nodes by themselves: frames, what is eliminated of vectors and matrices, and how
//! held coordinates move, by differences of their places.

use ancf::linear::Matrix;
use ancf::model::Law;
use ancf::system::prescribed::Prescribed;
use ancf::system::supports::{RestrainedPair, Restraint, Supports};

/// Three nodes.
const COORDINATES: usize = 12;

fn by(start: f64, change: f64, law: Option<Law>) -> Prescribed {
    Prescribed { start, change, law }
}

/// 0.1 + 0.5 t − 0.3 t².
fn law() -> Option<Law> {
    Some(Law::Polynomial(vec![0.1, 0.5, -0.3]))
}

fn pair(pair: usize, hold: Restraint) -> RestrainedPair {
    RestrainedPair { pair, restraint: hold }
}

/// Supports that follow a law where there is `law`, and the load factor otherwise: a position held
/// along x, a direction, a position held along y that stays, a direction that stays, a gradient.
fn supports(law: impl Fn() -> Option<Law>) -> Supports {
    Supports::new(vec![
        pair(0, Restraint::Position([Some(by(0.2, 0.5, law())), None])),
        pair(1, Restraint::Direction(by(0.3, 0.8, law()))),
        pair(2, Restraint::Position([None, Some(by(-1.0, 0.0, None))])),
        pair(3, Restraint::Direction(by(1.1, 0.0, None))),
        pair(5, Restraint::Gradient { reference: [0.6, 0.8], rotation: by(0.1, 0.7, law()) }),
    ])
}

fn none() -> Option<Law> {
    None
}

fn numbers(phase: f64) -> Vec<f64> {
    (0..COORDINATES).map(|i| (1.3 * i as f64 + phase).sin() + 0.2).collect()
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sine, cosine) = angle.sin_cos();
    [cosine * x - sine * y, sine * x + cosine * y]
}

fn close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len());
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() < tolerance, "{what}, coordinate {i}: {a}, not {b}");
    }
}

/// The frame's angle of each held pair at load factor or time `t`, and which components are held.
fn frames(angle: f64) -> [(usize, f64, [bool; 2]); 5] {
    [
        (0, 0.0, [true, false]),
        (1, angle, [false, true]),
        (2, 0.0, [false, true]),
        (3, 1.1, [false, true]),
        (5, 0.0, [true, true]),
    ]
}

#[test]
fn supports_say_what_they_hold() {
    let (moving, still) = (supports(law), supports(none));
    for held in [&moving, &still] {
        assert_eq!(held.eliminated().collect::<Vec<_>>(), [0, 3, 5, 7, 10, 11]);
        assert_eq!(held.count(), 6);
        assert_eq!(held.half_fixed().collect::<Vec<_>>(), [0, 0, 1, 1]);
        assert_eq!(held.positions().collect::<Vec<_>>(), [0, 1]);
        assert!(held.moves());
    }
    assert!(
        moving.moves_in_time() && moving.turn_in_time() && !still.moves_in_time() && !still.turn_in_time()
    );
    let holding: Vec<usize> = (0..COORDINATES).filter(|i| moving.is_stationary(*i)).collect();
    assert_eq!(holding, [4, 5, 6, 7]);
    let holding: Vec<usize> = (0..COORDINATES).filter(|i| still.is_stationary(*i)).collect();
    assert_eq!(holding, [0, 1, 2, 3, 4, 5, 6, 7, 10, 11]);
    let courses: Vec<(f64, f64)> = moving.moving(2.5).map(|(course, unit)| (course.start, unit)).collect();
    assert_eq!(courses, [(0.2, 2.5), (0.3, 1.0), (0.1, 1.0)]);
    assert_eq!(still.moving(2.5).count(), 0);
    let nothing = Supports::new(vec![pair(3, Restraint::Direction(by(1.1, 0.0, law())))]);
    assert!(!nothing.moves() && !nothing.moves_in_time() && !nothing.turn_in_time());
    // What moves tells of jumps, and any law of kinks.
    let step = || Some(Law::Step { start: 0.7 });
    let jumping = supports(step);
    assert_eq!(jumping.jumps().collect::<Vec<_>>(), [(0, 0.7, 0.5), (2, 0.7, 0.8), (10, 0.7, 0.7)]);
    assert_eq!(jumping.laws().flat_map(Law::kinks).collect::<Vec<_>>(), [0.7, 0.7, 0.7]);
    let pairs = vec![pair(1, Restraint::Position([Some(by(0.0, 0.0, step())), Some(by(0.0, -2.0, step()))]))];
    assert_eq!(Supports::new(pairs).jumps().collect::<Vec<_>>(), [(2, 0.7, -2.0)]);
    assert_eq!(moving.jumps().count() + moving.laws().flat_map(Law::kinks).count(), 0);
}

/// Held components go where they are prescribed and free ones stay; a direction keeps the length of
/// its gradient.
#[test]
fn held_coordinates_are_put_in_place() {
    for (supports, part) in [(supports(none), 0.4), (supports(law), 0.1 + 0.5 * 0.4 - 0.3 * 0.16)] {
        let mut q = numbers(0.5);
        supports.impose(0.4, &mut q);
        let mut expected = numbers(0.5);
        expected[0] = 0.2 + 0.5 * part;
        expected[5] = -1.0;
        for (pair, angle) in [(1, 0.3 + 0.8 * part), (3, 1.1)] {
            let length = expected[2 * pair].hypot(expected[2 * pair + 1]);
            expected[2 * pair..2 * pair + 2].copy_from_slice(&turned([length, 0.0], angle));
        }
        expected[10..].copy_from_slice(&turned([0.6, 0.8], 0.1 + 0.7 * part));
        close(&q, &expected, 1e-14, "imposed");
    }
    let changes: Vec<(usize, f64)> = supports(none).position_changes(0.4, &numbers(0.5)).collect();
    let q = numbers(0.5);
    let expected = [(0, 0.2 + 0.5 * 0.4 - q[0]), (1, -1.0 - q[5])];
    assert!(
        changes.iter().zip(expected).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-15),
        "{changes:?}"
    );
    assert_eq!(changes.len(), 2);
}

/// Into the frames, where held components are cleared, and back.
#[test]
fn vectors_are_turned_into_frames_and_back() {
    let (load, supports) = (0.4, supports(none));
    let angle = 0.3 + 0.8 * load;
    let v = numbers(1.5);
    let (mut into, mut expected) = (v.clone(), v.clone());
    supports.to_frames(load, &mut into);
    for (pair, angle, held) in frames(angle) {
        let mut turned = turned([v[2 * pair], v[2 * pair + 1]], -angle);
        turned.iter_mut().zip(held).for_each(|(value, held)| *value = if held { 0.0 } else { *value });
        expected[2 * pair..2 * pair + 2].copy_from_slice(&turned);
    }
    close(&into, &expected, 1e-14, "in their frames");
    let mut back = into.clone();
    supports.from_frames(load, &mut back);
    let mut released = v.clone();
    // At load factor zero, where a motion's frames stand.
    let mut zero = v.clone();
    supports.to_frames(0.0, &mut zero);
    let mut unknowns = v.clone();
    supports.unknowns_to_frames(&mut unknowns);
    close(&unknowns, &zero, 1e-14, "unknowns in their frames");
    supports.from_frames(0.0, &mut zero);
    supports.release(&mut released);
    close(&released, &zero, 1e-14, "released");
    for (pair, angle, _) in frames(angle) {
        let there = turned([into[2 * pair], into[2 * pair + 1]], angle);
        close(&back[2 * pair..2 * pair + 2], &there, 1e-14, "back");
    }
    close(&back[8..10], &v[8..10], 1e-300, "what is free");
    let mut fixed = v.clone();
    supports.to_fixed_axes(load, &mut fixed);
    let mut kept = v.clone();
    supports.keep_fixed(load, &mut kept);
    for (pair, angle, held) in frames(angle) {
        let here = [v[2 * pair], v[2 * pair + 1]];
        close(&fixed[2 * pair..2 * pair + 2], &turned(here, angle), 1e-14, "in fixed axes");
        let mut inside = turned(here, -angle);
        inside.iter_mut().zip(held).for_each(|(value, held)| *value = if held { *value } else { 0.0 });
        close(&kept[2 * pair..2 * pair + 2], &turned(inside, angle), 1e-14, "kept");
    }
    assert_eq!(kept[8..10], [0.0, 0.0]);
}

/// Directions that turn with time are unknowns in their frames: they are neither turned there nor
/// back, and lose what is held in their frame.
#[test]
fn directions_that_turn_stay_in_their_frames() {
    let supports = supports(law);
    let v = numbers(1.5);
    let (mut back, mut unknowns, mut released) = (v.clone(), v.clone(), v.clone());
    supports.from_frames(0.4, &mut back);
    assert_eq!(back[2..4], v[2..4]);
    close(&back[6..8], &turned([v[6], v[7]], 1.1), 1e-14, "a direction that stays");
    supports.unknowns_to_frames(&mut unknowns);
    assert_eq!(unknowns[2..4], [v[2], 0.0]);
    supports.release(&mut released);
    assert_eq!(released[2..4], [v[2], 0.0]);
    let mut x = v.clone();
    supports.impose_unknowns(0.4, &mut x);
    assert_eq!(x[2..4], [v[2], 0.0]);
    let part = 0.1 + 0.5 * 0.4 - 0.3 * 0.16;
    assert!((x[0] - (0.2 + 0.5 * part)).abs() < 1e-15 && x[1] == v[1]);
    close(&x[10..], &turned([0.6, 0.8], 0.1 + 0.7 * part), 1e-15, "a gradient");
}

/// ∂q/∂λ of what is held, in its frame, by differences of where it is put.
#[test]
fn rates_of_supports_are_those_of_their_places() {
    let (supports, load, h) = (supports(none), 0.4, 1e-6);
    let mut q = numbers(0.5);
    supports.impose(load, &mut q);
    let mut rate = vec![7.0; COORDINATES];
    supports.rate(load, &q, &mut rate);
    supports.from_frames(load, &mut rate);
    let at = |load: f64| {
        let mut q = q.clone();
        supports.impose(load, &mut q);
        q
    };
    let (after, before) = (at(load + h), at(load - h));
    let slopes: Vec<f64> = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * h)).collect();
    close(&rate, &slopes, 1e-9, "rate");
}

/// Places, velocities and accelerations that go together: unknowns y(t) = a + b t + c t², carried
/// by the supports at three times, differ by the velocities and accelerations that are carried with
/// them.
#[test]
fn velocities_and_accelerations_are_those_of_the_places() {
    let supports = supports(law);
    let (a, b, c) = (numbers(0.1), numbers(2.2), numbers(4.1));
    let carried = |t: f64| {
        let unknown = |f: &dyn Fn(usize) -> f64| (0..COORDINATES).map(f).collect::<Vec<f64>>();
        let mut q = unknown(&|i| a[i] + b[i] * t + c[i] * t * t);
        let mut v = unknown(&|i| b[i] + 2.0 * c[i] * t);
        let mut acceleration = unknown(&|i| 2.0 * c[i]);
        supports.carry(t, [&mut q, &mut v, &mut acceleration]);
        [q, v, acceleration]
    };
    let (t, h) = (0.6, 1e-4);
    let [[before, ..], [q, v, acceleration], [after, ..]] = [t - h, t, t + h].map(carried);
    let first: Vec<f64> = after.iter().zip(&before).map(|(x, y)| (x - y) / (2.0 * h)).collect();
    let second: Vec<f64> = (0..COORDINATES).map(|i| (after[i] - 2.0 * q[i] + before[i]) / (h * h)).collect();
    for i in 0..COORDINATES {
        assert!((v[i] - first[i]).abs() < 1e-6, "coordinate {i}: {} m/s, not {}", v[i], first[i]);
        let off = (acceleration[i] - second[i]).abs();
        assert!(off < 1e-5, "coordinate {i}: {} m/s², not {}", acceleration[i], second[i]);
    }
    assert_eq!((q[5], v[5], acceleration[5]), (-1.0, 0.0, 0.0));
    let part = 0.1 + 0.5 * t - 0.3 * t * t;
    assert!((q[0] - (0.2 + 0.5 * part)).abs() < 1e-15, "{}", q[0]);
    let y = a[2] + b[2] * t + c[2] * t * t;
    close(&q[2..4], &turned([y, 0.0], 0.3 + 0.8 * part), 1e-14, "a direction");
    // And back: components along the direction, and nothing across it.
    let (mut back, mut rates) = (q.clone(), v.clone());
    supports.uncarry(t, &mut back, &mut rates);
    close(&back[2..4], &[y, 0.0], 1e-14, "an unknown");
    close(&rates[2..4], &[b[2] + 2.0 * c[2] * t, 0.0], 1e-13, "its rate");
    assert_eq!((&back[..2], &back[4..]), (&q[..2], &q[4..]));
    // What a support prescribes of a velocity, with nothing of what is free.
    let mut prescribed = vec![7.0; COORDINATES];
    supports.prescribed_velocity(t, &q, &mut prescribed);
    let rate = 0.5 - 0.6 * t;
    let mut expected = vec![0.0; COORDINATES];
    expected[0] = 0.5 * rate;
    let across = turned([0.0, y * 0.8 * rate], 0.3 + 0.8 * part);
    expected[2..4].copy_from_slice(&across);
    let gradient = turned([0.6, 0.8], 0.1 + 0.7 * part);
    expected[10..].copy_from_slice(&[-gradient[1] * 0.7 * rate, gradient[0] * 0.7 * rate]);
    close(&prescribed, &expected, 1e-13, "prescribed velocity");
}

/// T K Tᵀ with the frames' T; held rows and columns become those of the identity times the diagonal
/// that was there, or nothing.
#[test]
fn matrices_are_turned_and_reduced() {
    for symmetric in [true, false] {
        let mut k = Matrix::zeros(3, 3, symmetric);
        let entry = |i: usize, j: usize| {
            let (a, b) = if symmetric { (i.min(j), i.max(j)) } else { (i, j) };
            // One held coordinate without stiffness.
            if (a, b) == (5, 5) {
                0.0
            } else {
                (0.7 * a as f64 + 1.9 * b as f64).sin() + if a == b { -3.0 } else { 0.0 }
            }
        };
        for i in 0..COORDINATES {
            for j in 0..COORDINATES {
                k.add_at(i, j, entry(i, j));
            }
        }
        let (supports, load) = (supports(none), 0.4);
        let mut turn = vec![vec![0.0; COORDINATES]; COORDINATES];
        (0..COORDINATES).for_each(|i| turn[i][i] = 1.0);
        for (pair, angle, _) in frames(0.3 + 0.8 * load) {
            let ((sine, cosine), x) = (angle.sin_cos(), 2 * pair);
            turn[x][x] = cosine;
            turn[x][x + 1] = sine;
            turn[x + 1][x] = -sine;
            turn[x + 1][x + 1] = cosine;
        }
        let mut expected = vec![vec![0.0; COORDINATES]; COORDINATES];
        for i in 0..COORDINATES {
            for j in 0..COORDINATES {
                for a in 0..COORDINATES {
                    for b in 0..COORDINATES {
                        expected[i][j] += turn[i][a] * entry(a, b) * turn[j][b];
                    }
                }
            }
        }
        supports.turn_matrix(load, &mut k);
        for (i, row) in expected.iter().enumerate() {
            for (j, expected) in row.iter().enumerate() {
                let found = k.get(i, j);
                assert!((found - expected).abs() < 1e-13, "{i} {j}: {found}, not {expected}");
            }
        }
        let held = [0, 3, 5, 7, 10, 11];
        let (mut reduced, mut cleared) = (k.clone(), k.clone());
        supports.eliminate(load, &mut reduced);
        supports.clear_fixed(load, &mut cleared);
        for i in 0..COORDINATES {
            for j in 0..COORDINATES {
                let apart = held.contains(&i) || held.contains(&j);
                let diagonal = match i {
                    5 => 1.0,
                    i => k.get(i, i).abs(),
                };
                let one = if !apart {
                    k.get(i, j)
                } else if i == j {
                    diagonal
                } else {
                    0.0
                };
                assert_eq!(reduced.get(i, j), one, "{i} {j}");
                assert_eq!(cleared.get(i, j), if apart { 0.0 } else { k.get(i, j) }, "{i} {j}");
            }
        }
    }
}
