//! Warnings on strains beyond the tables of elastic laws.

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
