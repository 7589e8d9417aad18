//! Joints as constraint rows.
//!
//! | joint | rows |
//! |---|---|
//! | hinge | r_b − r_a = 0 |
//! | weld | r_b − r_a = 0 and r'_b − R(φ) r'_a = 0 |
//! | slider along d | (J d)·(r − r₀) = 0 |
//!
//! with φ the angle between the gradients of the stress-free shapes. All rows are linear in q and constant, so that a motion stays an ordinary
//! differential equation on the subspace that they leave ([`crate::solve::dynamics::motion`]).
//!
//! # Stretch at a weld
//! A weld could hold the angle alone; it holds both components of the gradient and with them |r'_b| = |r'_a|, as the clamp of a cable element does.
//! Where the axial forces of the two beams differ, that stress is balanced within the adjoining cells. Its energy is that of a strain ε = N/EA over
//! one cell, less than the bending energy by EI/(EA L²): 1e-5 for a beam of slenderness 100.

use super::constraints::Constraint;
use super::{System, SystemError};
use crate::model::{Joint, Place};

/// Distance of two points that are one \[beam lengths\].
const APART: f64 = 1e-9;

/// The rows of a joint.
pub(super) fn rows(system: &System, joint: Joint) -> Result<Vec<Constraint>, SystemError> {
    let mut rows = Vec::new();
    match joint {
        Joint::Hinge { first, second } => rows.extend(coincide(system, first, second)?),
        Joint::Weld { first, second } => {
            rows.extend(coincide(system, first, second)?);
            rows.extend(keep_angle(system, first, second)?);
        }
        Joint::Slider { at, along: [x, y] } => {
            let length = x.hypot(y);
            rows.push(row(system, 0, &[(at, [-y / length, x / length])])?);
        }
    }
    Ok(rows)
}

const AXES: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

fn coincide(system: &System, first: Place, second: Place) -> Result<[Constraint; 2], SystemError> {
    let rows = AXES.map(|[x, y]| row(system, 0, &[(first, [-x, -y]), (second, [x, y])]));
    let rows = transpose(rows)?;
    // What the row holds at zero coordinates is the distance in the stress-free shape.
    let [x, y] = rows.each_ref().map(|row| -row.value(0.0, &vec![0.0; system.coordinates()]));
    let gap = x.hypot(y);
    if gap > APART * system.length() {
        let name = |place: Place| system.beams()[place.beam].name.clone();
        return Err(SystemError::Apart {
            first: name(first),
            first_s: first.s,
            second: name(second),
            second_s: second.s,
            gap,
        });
    }
    // Round-off of where the points are is no gap.
    Ok(rows.map(|row| row.closed()))
}

fn keep_angle(system: &System, first: Place, second: Place) -> Result<[Constraint; 2], SystemError> {
    let [a, b] = [first, second].map(|place| system.gradient_of(place));
    let ([ax, ay], [bx, by]) = (a?, b?);
    // R(φ) r'_a = r'_b but for the lengths, which are 1.
    let (cosine, sine) = (ax * bx + ay * by, ax * by - ay * bx);
    let length = cosine.hypot(sine);
    let (cosine, sine) = (cosine / length, sine / length);
    // Rows of R(φ).
    let turned = [[cosine, -sine], [sine, cosine]];
    let axes = [0, 1].map(|i| (AXES[i], turned[i]));
    let rows = axes.map(|(axis, turned)| row(system, 1, &[(first, turned.map(|n| -n)), (second, axis)]));
    Ok(transpose(rows)?.map(|row| row.closed()))
}

fn transpose<T, E>(results: [Result<T, E>; 2]) -> Result<[T; 2], E> {
    let [a, b] = results;
    Ok([a?, b?])
}

/// Σ n·r⁽ᵒ⁾ over the given places, with the value that it has in the stress-free shape.
fn row(system: &System, order: usize, terms: &[(Place, [f64; 2])]) -> Result<Constraint, SystemError> {
    let mut parts = Vec::with_capacity(terms.len());
    for (place, normal) in terms {
        let (part, s) = system.part("a joint", *place)?;
        let table = part.basis.points(&[s], &[order]).map_err(|e| SystemError::basis(&part.name, e))?;
        parts.push((table, part.offset(), *normal));
    }
    let normals = parts.iter().map(|(.., normal)| *normal).collect();
    let mut row = Constraint::joint(parts.iter().map(|(table, offset, _)| (table, *offset)), order, normals);
    row.hold(row.value(0.0, system.reference()));
    Ok(row)
}
