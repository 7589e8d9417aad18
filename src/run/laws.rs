//! Strains beyond the tables of elastic laws, and where they pass corners.

use crate::model::{Model, Place};
use crate::numeric::plain;
use crate::results::Shape;
use crate::system::System;

/// The strains and curvatures that beams with elastic laws have reached.
#[derive(Clone)]
pub(super) struct Reach {
    beams: Vec<Watched>,
}

#[derive(Clone)]
struct Watched {
    beam: usize,
    name: String,
    /// Of the axial law and of the bending law: the ends of the table, and the smallest and largest
    /// value that was reached.
    laws: [Option<([f64; 2], [f64; 2])>; 2],
}

impl Reach {
    pub(super) fn new(model: &Model) -> Self {
        let beams = model.beams.iter().enumerate().filter(|(_, beam)| !beam.section.is_linear());
        let watched = |(beam, of): (usize, &crate::model::Beam)| {
            let laws = [&of.section.axial_law, &of.section.bending_law];
            let laws = laws.map(|law| law.as_ref().map(|law| (law.ends(), [0.0; 2])));
            Watched { beam, name: of.name.clone(), laws }
        };
        Self { beams: beams.map(watched).collect() }
    }

    /// Whether any beam is watched.
    pub(super) fn watches(&self) -> bool {
        !self.beams.is_empty()
    }

    /// Takes a state into account, given the stress-free one.
    pub(super) fn see(&mut self, now: &[Shape], free: &[Shape]) {
        for Watched { beam, laws, .. } in &mut self.beams {
            let (now, free) = (&now[*beam], &free[*beam]);
            let bend = now.curvature.iter().zip(&free.curvature).map(|(now, free)| now - free);
            let strains: [Vec<f64>; 2] = [now.strain.clone(), bend.collect()];
            for (law, strains) in laws.iter_mut().zip(strains) {
                let Some((_, [low, high])) = law else { continue };
                strains.iter().for_each(|strain| (*low, *high) = (low.min(*strain), high.max(*strain)));
            }
        }
    }

    /// What to say of them.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let words = [("axial strain", "axial_law"), ("curvature", "bending_law")];
        self.beams.iter().flat_map(move |Watched { name, laws, .. }| {
            laws.iter().zip(words).filter_map(move |(law, (what, key))| {
                let ([first, last], [low, high]) = (*law)?;
                let beyond = if high > last { Some(high) } else { (low < first).then_some(low) }?;
                Some(format!(
                    "the {what} of beam `{name}` reaches {beyond:.4e}, and its `{key}` is known from {first} to {last} only: beyond, it was taken to \
                     go on as straight as at its end; give the table more points, or smaller loads"
                ))
            })
        })
    }
}

/// Distance from a corner of a law, relative to the width of its table, that counts as none.
const CORNER: f64 = 1e-9;

/// Part of a cell that a place may be off a node to count as there.
const AT_NODE: f64 = 1e-2;
/// False positions with which a place is found.
const POSITIONS: usize = 6;

/// The model with cells divided where the section forces of a state pass those of corners of its laws, since the stiffness
/// jumps there and a sum over fixed points takes a whole cell to be on one side or the other; `None` where there are
/// no such places. The forces tell where, for they are continuous and known better than the strains of a cell that cannot
/// have a corner. `forces_at` gives the axial force \[N\] and the bending moment \[N m\] at an arc length \[m\] of a beam.
pub(super) fn divided(
    model: &Model,
    now: &[Shape],
    forces_at: &dyn Fn(usize, f64) -> Option<[f64; 2]>,
) -> Option<Model> {
    let mut divided = model.clone();
    for (index, (beam, shape)) in divided.beams.iter_mut().zip(now).enumerate() {
        let section = &mut beam.section;
        let laws =
            [(&section.axial_law, &shape.axial_force, 0), (&section.bending_law, &shape.bending_moment, 1)];
        section.law_jumps = laws.map(|(law, forces, kind)| {
            let Some(law) = law else { return Vec::new() };
            let largest = forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
            let of_corner = |corner: f64| {
                let force = law.force_and_stiffness(corner).0;
                let rows = shape.s.iter().zip(forces).map(|(s, now)| (*s, now - force));
                // Forces that differ from it by round-off are on neither side.
                let rows: Vec<(f64, f64)> = rows.filter(|(_, off)| off.abs() > CORNER * largest).collect();
                let passes = |pair: &[(f64, f64)]| {
                    let off = |s: f64| forces_at(index, s).map(|forces| forces[kind] - force);
                    (pair[0].1 * pair[1].1 < 0.0).then(|| zero([pair[0], pair[1]], off))
                };
                rows.windows(2).filter_map(passes).collect::<Vec<f64>>()
            };
            let mut at: Vec<f64> = law.corners(CORNER).flat_map(of_corner).collect();
            at.sort_by(f64::total_cmp);
            at.dedup();
            at
        });
    }
    divided.beams.iter().any(|beam| beam.section.law_jumps.iter().any(|at| !at.is_empty())).then_some(divided)
}

/// Where along its beams the stiffness of a model jumps in the state `now`, as far as its rows tell.
pub(crate) fn stiffness_jumps(model: &Model, now: &[Shape]) -> Vec<Place> {
    divided(model, now, &|_, _| None).as_ref().map_or_else(Vec::new, jumps_of)
}

/// Where cells are divided.
fn jumps_of(divided: &Model) -> Vec<Place> {
    let beams = divided.beams.iter().enumerate();
    beams
        .flat_map(|(beam, of)| of.section.law_jumps.iter().flatten().map(move |s| Place { beam, s: *s }))
        .collect()
}

/// The warning on the first jump of the stiffness inside of a cell, whose shape functions have a curvature or a strain that does not
/// jump with it. `system` has the nodes.
pub(super) fn within_cells(divided: &Model, system: &System) -> Option<String> {
    let inside = |place: &Place| {
        let basis = &system.beams()[place.beam].basis;
        let cell = basis.cell_at(place.s);
        let (left, right) = (basis.nodes()[cell], basis.nodes()[cell + 1]);
        (place.s - left).min(right - place.s) > AT_NODE * (right - left)
    };
    let Place { beam, s } = jumps_of(divided).into_iter().find(inside)?;
    Some(format!(
        "the stiffness of beam `{}` jumps at s = {} m, where its force passes a corner of its law inside a cell: frequencies and critical loads err by a part \
         of that jump that falls with the cells' length only; put a node there, or leave out the `basis` for an `accuracy`, which does",
        divided.beams[beam].name,
        plain(s, 6)
    ))
}

/// The place between two others at which a function with values of either sign there vanishes, by a few false positions
/// (the Illinois rule halves the value of an end that stays).
fn zero([mut left, mut right]: [(f64, f64); 2], of: impl Fn(f64) -> Option<f64>) -> f64 {
    let between = |(s, a): (f64, f64), (next, b): (f64, f64)| s + (next - s) * a / (a - b);
    for _ in 0..POSITIONS {
        let s = between(left, right);
        let Some(value) = of(s).filter(|value| *value != 0.0 && left.0 != right.0) else { return s };
        if value * right.1 < 0.0 {
            left = right;
        } else {
            left.1 *= 0.5;
        }
        right = (s, value);
    }
    between(left, right)
}

/// Warnings on beams in the state `now` that are at corners of their laws, of which a linear
/// solution about the state takes one side, or another one from point to point; `free` is the stress-free state. Strains tell
/// where these are given, section forces where loads give them.
pub(super) fn at_corners(model: &Model, now: &[Shape], free: &[Shape]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (beam, (now, free)) in model.beams.iter().zip(now.iter().zip(free)) {
        let bend = now.curvature.iter().zip(&free.curvature).map(|(now, free)| now - free).collect();
        let laws = [
            (&beam.section.axial_law, now.strain.clone(), &now.axial_force, "axial strain", "axial_law"),
            (&beam.section.bending_law, bend, &now.bending_moment, "curvature", "bending_law"),
        ];
        for (law, strains, forces, what, key) in laws {
            let Some(law) = law else { continue };
            // A single place, such as a free end, resists nothing by itself.
            let corner = |strain: f64| law.corner(strain, CORNER);
            let along = strains.windows(2).find_map(|pair| corner(pair[0]).and(corner(pair[1])));
            let largest = forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
            let carried = || {
                law.corners(CORNER).find_map(|strain| {
                    let force = law.force_and_stiffness(strain).0;
                    let is_there = |now: &f64| force != 0.0 && (now - force).abs() <= CORNER * largest;
                    forces.windows(2).any(|pair| pair.iter().all(is_there)).then(|| corner(strain)).flatten()
                })
            };
            let Some([left, right]) = along.or_else(carried) else { continue };
            warnings.push(format!(
                "the {what} of beam `{}` is at a corner of its `{key}`, where its stiffness is {left:.4e} on one side and {right:.4e} on the other: \
                 a linear solution about this state takes one of both, or now this and now that along the beam; give the table no corner there, or load the beam before",
                beam.name
            ));
        }
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    /// A law whose stiffness falls from 2 to 1 N m² where the moment is 1 N m.
    fn model() -> Model {
        let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e3, bending_law = { curvature = [-2, -0.5, 0.5, 2], moment = [-2.5, -1, 1, 2.5] }, basis.ancf.nodes = [0, 0.3, 1] }\n\
                    support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]\nanalysis.static = {}\n";
        parse("scene", text).unwrap_or_else(|error| panic!("{error}")).model().clone()
    }

    fn shape(moments: &[f64]) -> Shape {
        let s = (0..moments.len()).map(|i| i as f64 / (moments.len() - 1) as f64).collect();
        Shape {
            s,
            bending_moment: moments.to_vec(),
            axial_force: vec![0.0; moments.len()],
            ..Shape::default()
        }
    }

    /// A moment of 1.5 (1 − s)² passes the corner once, which the parabola says better than the line between rows does; one that is the corner's but
    /// for round-off passes it nowhere.
    #[test]
    fn cells_are_divided_where_forces_pass_corners() {
        let model = model();
        let moment = |s: f64| 1.5 * (1.0 - s) * (1.0 - s);
        let now = [shape(&[0.0, 0.25, 0.5, 0.75, 1.0].map(moment))];
        let at = |forces: &dyn Fn(usize, f64) -> Option<[f64; 2]>| {
            let divided = divided(&model, &now, forces).expect("a corner");
            jumps_of(&divided).iter().map(|place| place.s).collect::<Vec<f64>>()
        };
        let exact = 1.0 - (1.0_f64 / 1.5).sqrt();
        let found = at(&|_, s| Some([0.0, moment(s)]));
        assert!(found.len() == 1 && (found[0] - exact).abs() < 1e-9, "{found:?} {exact}");
        let line = at(&|_, _| None);
        let between = 0.25 * (1.5 - 1.0) / (1.5 - moment(0.25));
        assert!(line.len() == 1 && (line[0] - between).abs() < 1e-12, "{line:?} {between}");
        for sign in [-1.0, 1.0] {
            let even = [shape(&[1.0 + 1e-13, 1.0 - 1e-13, 1.0 + 1e-13].map(|moment| sign * moment))];
            assert!(stiffness_jumps(&model, &even).is_empty(), "{sign}");
        }
    }
}
