//! Joints as constraint rows.
//!
//! | joint | rows |
//! |---|---|
//! | hinge | r_b − r_a = 0 |
//! | weld | r_b − r_a = 0 and θ_b − θ_a − φ = 0, θ = atan2(y', x') |
//! | slider along d | (J d)·(r − r₀) = 0 |
//!
//! with φ the angle between the gradients of the stress-free shapes. A weld leaves the lengths of
//! the gradients free, because the axial strains of the two beams jump where their stiffnesses do.
//! The direction is not linear in q. In statics the row depends on the state; in a motion the
//! gradients of both points are described by polar coordinates ([`super::polar`]), in which all
//! rows are linear and constant, so that a motion remains an ordinary differential equation on the
//! subspace that the rows leave ([`crate::solve::dynamics::motion`]). Every joint is at a node
//! ([`crate::model::Model::breaks`]).

use super::constraints::Constraint;
use super::polar::Polar;
use super::reaction::Source;
use super::{BuildError, Fields, System};
use crate::basis::BasisTable;
use crate::model::{Joint, Place};

/// Largest distance of two points that coincide, in beam lengths.
const APART: f64 = 1e-9;
/// Steps of Newton's method, of which a curve takes a few.
const STEPS_TO_NEAREST: usize = 8;

/// The constraint rows of a joint; `open` tells whether its points may be apart at the start.
pub(super) fn rows(system: &System, joint: Joint, open: bool) -> Result<Vec<Constraint>, BuildError> {
    let mut rows = Vec::new();
    match joint {
        Joint::Hinge { first, second } => rows.extend(coincide(system, open, first, second)?),
        Joint::Weld { first, second } => {
            rows.extend(coincide(system, open, first, second)?);
            rows.push(keep_angle(system, first, second)?);
        }
        Joint::Slider { at, along: [x, y] } => {
            let length = x.hypot(y);
            rows.push(row(system, 0, &[(at, [-y / length, x / length])])?);
        }
    }
    Ok(rows)
}

const AXES: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

fn coincide(system: &System, open: bool, first: Place, second: Place) -> Result<[Constraint; 2], BuildError> {
    let rows = AXES.map(|[x, y]| row(system, 0, &[(first, [-x, -y]), (second, [x, y])]));
    let rows = transpose(rows)?;
    // The value of the row at zero coordinates is the negative distance at the start.
    let [x, y] = rows.each_ref().map(|row| -row.value(0.0, &vec![0.0; system.coordinates()]));
    let gap = x.hypot(y);
    if gap > APART * system.length() && !open {
        let name = |place: Place| system.beams()[place.beam].name.clone();
        let meets = |place: Place, other: Place| {
            let s = nearest(system, place, system.fields_of(other)?.position)?;
            Ok::<_, BuildError>(s.map(|s| (name(place), s)))
        };
        return Err(BuildError::Apart {
            first: name(first),
            first_s: first.s,
            second: name(second),
            second_s: second.s,
            at: system.fields_of(first)?.position,
            gap,
            meets: meets(first, second)?.or(meets(second, first)?),
        });
    }
    // The remaining distance is round-off and is not kept as a gap.
    Ok(rows.map(|row| row.closed()))
}

/// The arc length near a place at which its beam goes through a point, if it does.
fn nearest(system: &System, place: Place, point: [f64; 2]) -> Result<Option<f64>, BuildError> {
    let end = system.beams()[place.beam].basis.length();
    let mut here = place;
    for _ in 0..STEPS_TO_NEAREST {
        let Fields { position: [x, y], gradient: [dx, dy], .. } = system.fields_of(here)?;
        let [x, y] = [point[0] - x, point[1] - y];
        if x.hypot(y) <= APART * system.length() {
            return Ok(Some(here.s));
        }
        here.s = (here.s + (x * dx + y * dy) / dx.hypot(dy).powi(2)).clamp(0.0, end);
    }
    Ok(None)
}

fn keep_angle(system: &System, first: Place, second: Place) -> Result<Constraint, BuildError> {
    let ([ax, ay], [bx, by]) = (system.gradient_of(first)?, system.gradient_of(second)?);
    let angle = (ax * by - ay * bx).atan2(ax * bx + ay * by);
    let [(a, of_a), (b, of_b)] = transpose([first, second].map(|place| table(system, 1, place)))?;
    Ok(Constraint::angle([(&a, of_a), (&b, of_b)], angle))
}

fn transpose<T, E>(results: [Result<T, E>; 2]) -> Result<[T; 2], E> {
    let [a, b] = results;
    Ok([a?, b?])
}

/// The row Σ n·r⁽ᵒ⁾ over the given places, where the sum keeps the value that it has at the start.
fn row(system: &System, order: usize, terms: &[(Place, [f64; 2])]) -> Result<Constraint, BuildError> {
    let mut parts = Vec::with_capacity(terms.len());
    for (place, normal) in terms {
        let (table, offset) = table(system, order, *place)?;
        parts.push((table, offset, *normal));
    }
    let normals = parts.iter().map(|(.., normal)| *normal).collect();
    let mut row = Constraint::joint(parts.iter().map(|(table, offset, _)| (table, *offset)), order, normals);
    row.add_to_sum(row.value(0.0, system.start()));
    Ok(row)
}

/// The shape functions of r⁽ᵒ⁾ at a place, and the first coefficient of its beam.
fn table(system: &System, order: usize, place: Place) -> Result<(BasisTable, usize), BuildError> {
    let (part, s) = system.part("a joint", place)?;
    let table = part.basis.points(&[s], &[order]).map_err(|e| BuildError::basis(&part.name, e))?;
    Ok((table, part.offset()))
}

/// The gradients that are described by polar coordinates in a motion: those of welded nodes, unless
/// a support fixes something of the gradient.
pub(super) fn polar(system: &System, joints: &[Joint]) -> Result<Polar, BuildError> {
    let fixed: Vec<usize> = system.supports.eliminated().map(|i| i / 2).collect();
    let (mut pairs, mut welds, mut sliders) = (Vec::new(), Vec::new(), Vec::new());
    let node = |place: Place| {
        let (part, s) = system.part("a joint", place)?;
        Ok(part.basis.node_at(s).map(|node| part.first_node + node))
    };
    let of_joints = &system.sources[system.sources.len() - joints.len()..];
    for (joint, rows) in joints.iter().zip(of_joints) {
        let (first, second) = match *joint {
            Joint::Weld { first, second } => (first, second),
            Joint::Slider { at, .. } => {
                sliders.extend(node(at)?);
                continue;
            }
            Joint::Hinge { .. } => continue,
        };
        let nodes = transpose([node(first), node(second)])?;
        pairs.extend(nodes.iter().flatten().map(|node| 2 * node + 1));
        if let ([Some(first), Some(second)], Source::Rows(rows)) = (nodes, rows) {
            welds.push(([first, second], rows.start));
        }
    }
    pairs.retain(|pair| !fixed.contains(pair));
    Ok(Polar::new(pairs, welds, sliders))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::RunError;
    use crate::scene::parse;

    /// The beam that meets the other one's point where its arc length is given in full, and neither where none does.
    fn meets(second: &str, at: &str) -> Option<(String, f64)> {
        let text = format!(
            "beam.bar = {{ start = [0, 0], end = [3, 4], axial_stiffness = 1, bending_stiffness = 1, basis.ancf.elements = 2 }}\n\
             beam.strut = {{ {second}, axial_stiffness = 1, bending_stiffness = 1, basis.ancf.elements = 8 }}\n\
             joint = [{{ type = 'weld', first = {{ beam = 'bar', at = 2.000001 }}, second = {{ beam = 'strut', at = {at} }} }}]\n\
             support = [{{ beam = 'bar', at = 'start', fix = ['x', 'y', 'angle'] }}]\n[analysis.static]\n"
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let Err(RunError::System(BuildError::Apart { meets, .. })) = scene.model().solve(scene.analysis())
        else {
            panic!("points of a joint that are apart")
        };
        meets
    }

    #[test]
    fn a_joint_whose_points_are_apart_is_told_where_they_meet() {
        let (beam, s) = meets("start = [1.2, 1.6], end = [1, -2]", "'start'").expect("a place of the bar");
        assert!(beam == "bar" && (s - 2.0).abs() < 1e-8, "{beam} {s}");
        let (beam, s) =
            meets("start = [1.2000006, 1.7], end = [1.2000006, -2]", "0.1").expect("a place of the strut");
        assert!(beam == "strut" && (s - 0.099_999_2).abs() < 1e-8, "{beam} {s}");
        assert_eq!(meets("start = [1.3, 1.6], end = [1.3, -2]", "'start'"), None);
    }
}
