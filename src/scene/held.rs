//! What supports hold: nothing twice, no more than a mesh can give, and in statics every rigid motion of every beam.

use crate::model::{FixedRotation, Model, Support};

use super::error::Fault;
use super::file::SceneTable;
use super::to_model::Built;

/// Places nearer to each other than this, per length of the beam, are one: what two supports hold there differs by less
/// than the equations can tell.
const NEAR: f64 = 1e-6;

/// Refuses two supports at one point of a beam that hold the same quantity.
pub(super) fn check_duplicates(file: &SceneTable, model: &Model, built: &[Built]) -> Result<(), Fault> {
    for (index, later) in model.supports.iter().enumerate() {
        for earlier in model.supports.iter().take(index) {
            let length = built.get(later.at.beam).map_or(0.0, |beam| beam.curve.length());
            let apart = (later.at.s - earlier.at.s).abs() > NEAR * length;
            if later.at.beam != earlier.at.beam || apart {
                continue;
            }
            let shared = [
                ("x", later.fix.x && earlier.fix.x),
                ("y", later.fix.y && earlier.fix.y),
                (
                    "the direction of r'",
                    later.fix.rotation != FixedRotation::Free && earlier.fix.rotation != FixedRotation::Free,
                ),
            ];
            if let (Some((what, _)), Some(table)) =
                (shared.into_iter().find(|(_, both)| *both), file.support.get(index))
            {
                return Err(Fault::new(
                    table.get().fix.span(),
                    format!("a support before this one already fixes {what} at the same point"),
                )
                .help("fix each quantity of a point once, in one `[[support]]`"));
            }
        }
    }
    Ok(())
}

/// Refuses a beam that can move without deforming. A planar rigid motion is (t_x, t_y, ω); a support at r₀ holds
/// t_x − ω (y₀ − ȳ), t_y + ω (x₀ − x̄) and ω. All three motions are held when these rows have rank 3.
pub(super) fn check_rigid_motions(model: &Model, built: &[Built]) -> Result<(), Fault> {
    for (index, beam) in built.iter().enumerate() {
        let length = beam.curve.length();
        let origin = beam.curve.position(0.0);
        let mut rows: Vec<[f64; 3]> = Vec::new();
        for Support { at, fix, .. } in model.supports.iter().filter(|support| support.at.beam == index) {
            let [x, y] = beam.curve.position(at.s);
            if fix.x {
                rows.push([1.0, 0.0, -(y - origin[1]) / length]);
            }
            if fix.y {
                rows.push([0.0, 1.0, (x - origin[0]) / length]);
            }
            if fix.rotation != FixedRotation::Free {
                rows.push([0.0, 0.0, 1.0]);
            }
        }
        if let Some(motion) = free_motion(rows) {
            let words = describe(motion, origin, length);
            return Err(Fault::new(
                beam.name.span(),
                format!("beam `{}` is under-supported: it is free for {words}", beam.name.get()),
            )
            .help(
                "an equilibrium needs every rigid motion held: add a `[[support]]`, such as \
                 `fix = [\"x\", \"y\", \"angle\"]` at the start",
            ));
        }
    }
    Ok(())
}

/// A motion that every row leaves free, if there is one: Gauss–Jordan elimination with full pivoting.
fn free_motion(mut rows: Vec<[f64; 3]>) -> Option<[f64; 3]> {
    let mut pivots: Vec<usize> = Vec::with_capacity(3);
    while pivots.len() < 3 {
        let done = pivots.len();
        let best = rows
            .iter()
            .enumerate()
            .skip(done)
            .flat_map(|(r, row)| row.iter().enumerate().map(move |(c, value)| (value.abs(), r, c)))
            .filter(|(_, _, c)| !pivots.contains(c))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, r, c)) = best.filter(|(size, ..)| *size > 1e-9) else { break };
        rows.swap(done, r);
        let pivot = rows[done].map(|value| value / rows[done][c]);
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = row[c];
            if other != done {
                for (value, p) in row.iter_mut().zip(pivot) {
                    *value -= factor * p;
                }
            }
        }
        rows[done] = pivot;
        pivots.push(c);
    }
    // The last column without a pivot; rotation is named in preference to a shift.
    let free = (0..3).rev().find(|c| !pivots.contains(c))?;
    let mut motion = [0.0; 3];
    motion[free] = 1.0;
    for (row, c) in rows.iter().zip(pivots) {
        motion[c] = -row[free];
    }
    Some(motion)
}

fn describe([tx, ty, turn]: [f64; 3], origin: [f64; 2], length: f64) -> String {
    let round = |value: f64| {
        let rounded = (value * 1e6).round() / 1e6;
        if rounded == 0.0 { 0.0 } else { rounded }
    };
    if turn.abs() > 1e-9 {
        // The point that stays: t_x − ω y = 0 and t_y + ω x = 0, in units of the length.
        let (x, y) = (origin[0] - ty / turn * length, origin[1] + tx / turn * length);
        return format!("rotation about the point ({}, {})", round(x), round(y));
    }
    if ty == 0.0 {
        "translation along x".into()
    } else if tx == 0.0 {
        "translation along y".into()
    } else {
        format!("translation along ({}, {})", round(tx), round(ty))
    }
}
