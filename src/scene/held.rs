//! What supports hold: nothing twice, no more than a mesh can give, and in statics every rigid motion of every beam.

use crate::model::{FixedRotation, Joint, Model, Place, Support};

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

/// Refuses a structure that can move without deforming. A planar rigid motion of a beam is (t_x, t_y, ω); a support at r₀ holds
/// t_x − ω (y₀ − ȳ), t_y + ω (x₀ − x̄) and ω, and a joint equals those of two beams. All motions are held when the rows have full rank. The direction of
/// a string is found with its shape, from the load that it carries.
pub(super) fn check_rigid_motions(model: &Model, built: &[Built]) -> Result<(), Fault> {
    let length = built.iter().map(|beam| beam.curve.length()).fold(0.0, f64::max);
    let origins: Vec<[f64; 2]> = built.iter().map(|beam| beam.curve.position(0.0)).collect();
    let columns = 3 * built.len();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    // A row of Σ n·u over points, and one of Σ ω.
    let displacement = |terms: &[(Place, [f64; 2])]| {
        let mut row = vec![0.0; columns];
        for (place, n) in terms {
            let ([x, y], [ox, oy]) = (built[place.beam].curve.position(place.s), origins[place.beam]);
            let lever = (n[1] * (x - ox) - n[0] * (y - oy)) / length;
            for (i, value) in [n[0], n[1], lever].into_iter().enumerate() {
                row[3 * place.beam + i] += value;
            }
        }
        row
    };
    let rotation = |terms: &[(Place, f64)]| {
        let mut row = vec![0.0; columns];
        terms.iter().for_each(|(place, sign)| row[3 * place.beam + 2] += sign);
        row
    };
    for Support { at, fix, .. } in &model.supports {
        if fix.x {
            rows.push(displacement(&[(*at, [1.0, 0.0])]));
        }
        if fix.y {
            rows.push(displacement(&[(*at, [0.0, 1.0])]));
        }
        if fix.rotation != FixedRotation::Free {
            rows.push(rotation(&[(*at, 1.0)]));
        }
    }
    for (beam, _) in model.beams.iter().enumerate().filter(|(_, b)| b.section.bending_stiffness.is_none()) {
        rows.push(rotation(&[(Place { beam, s: 0.0 }, 1.0)]));
    }
    for joint in &model.joints {
        match *joint {
            Joint::Slider { at, along: [x, y] } => rows.push(displacement(&[(at, [-y, x])])),
            Joint::Hinge { first, second } | Joint::Weld { first, second } => {
                rows.push(displacement(&[(first, [-1.0, 0.0]), (second, [1.0, 0.0])]));
                rows.push(displacement(&[(first, [0.0, -1.0]), (second, [0.0, 1.0])]));
                if matches!(joint, Joint::Weld { .. }) {
                    rows.push(rotation(&[(first, -1.0), (second, 1.0)]));
                }
            }
        }
    }
    let Some(motion) = free_motion(rows, columns) else { return Ok(()) };
    // The beam that moves most.
    let size = |beam: usize| motion[3 * beam..3 * beam + 3].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let index = (0..built.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0);
    let of_beam = [0, 1, 2].map(|i| motion[3 * index + i] / size(index));
    let words = describe(of_beam, origins[index], length);
    let beam = &built[index];
    Err(Fault::new(
        beam.name.span(),
        format!("beam `{}` is under-supported: it is free for {words}", beam.name.get()),
    )
    .help(
        "an equilibrium needs every rigid motion held: add a `[[support]]`, such as \
         `fix = [\"x\", \"y\", \"angle\"]` at the start, or a `[[joint]]`",
    ))
}

/// A motion that every row leaves free, if there is one: Gauss–Jordan elimination with full pivoting.
fn free_motion(mut rows: Vec<Vec<f64>>, columns: usize) -> Option<Vec<f64>> {
    let mut pivots: Vec<usize> = Vec::with_capacity(columns);
    while pivots.len() < columns {
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
        let by = rows[done][c];
        let pivot: Vec<f64> = rows[done].iter().map(|value| value / by).collect();
        for (other, row) in rows.iter_mut().enumerate() {
            let factor = row[c];
            if other != done {
                for (value, p) in row.iter_mut().zip(&pivot) {
                    *value -= factor * p;
                }
            }
        }
        rows[done] = pivot;
        pivots.push(c);
    }
    // The last column without a pivot; rotation is named in preference to a shift.
    let free = (0..columns).rev().find(|c| !pivots.contains(c))?;
    let mut motion = vec![0.0; columns];
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
