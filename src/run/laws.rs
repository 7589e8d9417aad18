//! Warnings on strains beyond the tables of elastic laws, and at their corners.

use crate::model::Model;
use crate::results::Shape;

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
                    "the {what} of beam `{name}` reaches {beyond:.4}, and its `{key}` is known from {first} to {last} only: beyond, it was taken to \
                     go on as straight as at its end; give the table more points, or smaller loads"
                ))
            })
        })
    }
}

/// Distance from a corner of a law, relative to the width of its table, that counts as none.
const CORNER: f64 = 1e-9;

/// Warnings on beams in the state `now` that are at corners of their laws, of which a linear
/// solution about the state takes one side only; `free` is the stress-free state.
pub(super) fn at_corners(model: &Model, now: &[Shape], free: &[Shape]) -> Vec<String> {
    let mut warnings = Vec::new();
    for (beam, (now, free)) in model.beams.iter().zip(now.iter().zip(free)) {
        let bend = now.curvature.iter().zip(&free.curvature).map(|(now, free)| now - free).collect();
        let laws = [
            (&beam.section.axial_law, now.strain.clone(), "axial strain", "axial_law"),
            (&beam.section.bending_law, bend, "curvature", "bending_law"),
        ];
        for (law, strains, what, key) in laws {
            let Some(law) = law else { continue };
            // A single place, such as a free end, resists nothing by itself.
            let corner = |strain: f64| law.corner(strain, CORNER);
            let along = strains.windows(2).find_map(|pair| corner(pair[0]).and(corner(pair[1])));
            let Some([left, right]) = along else { continue };
            warnings.push(format!(
                "the {what} of beam `{}` is at a corner of its `{key}`, where its stiffness is {left:.4e} on one side and {right:.4e} on the other: \
                 a linear solution about this state takes one of both; give the table no corner there, or load the beam before",
                beam.name
            ));
        }
    }
    warnings
}
