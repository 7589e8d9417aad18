//! Section forces and stresses at every record: at the probes, and along the beams.

use super::sampler::Sampler;
use crate::assembly::{Actions, Side};
use crate::results::{BeamSections, SectionForces, SectionSeries, Trajectory};

/// A recorded state: coordinates, velocities, and what acts on each beam, where it is known.
pub(super) type Acted<'s> = (&'s [f64], Option<&'s [f64]>, Option<Vec<Actions>>);

impl Sampler<'_> {
    /// Adds to every record what the sections carry; `states` are those of the records.
    pub(super) fn record_sections<'s>(
        &self,
        trajectory: &mut Trajectory,
        states: impl Iterator<Item = Acted<'s>>,
    ) {
        let series = |name: &str| SectionSeries { name: name.to_owned(), samples: Vec::new() };
        trajectory.sections = trajectory.probes.iter().map(|probe| series(&probe.name)).collect();
        let mut frames = trajectory.frames.iter().peekable();
        for (parameter, (q, v, actions)) in trajectory.parameter.iter().zip(states) {
            for (place, series) in self.probe_places().zip(&mut trajectory.sections) {
                let forces = actions.as_ref().map(|actions| self.section_at(place, q, actions));
                series.samples.push(forces.unwrap_or(SectionForces::UNKNOWN));
            }
            if frames.next_if(|frame| frame.parameter == *parameter).is_some() {
                trajectory.along.push(self.along_beams(q, v, actions.as_deref()));
            }
        }
    }

    /// What the section at a place carries: behind the place, and at the beam's end before it.
    pub(super) fn section_at(
        &self,
        (beam, s): (usize, f64),
        q: &[f64],
        actions: &[Actions],
    ) -> SectionForces {
        let side = if s >= self.system.beams()[beam].basis.length() { Side::Left } else { Side::Right };
        let shape = self.cut_shape(beam, &[s], &[side], q, &actions[beam]);
        let first = |values: &[f64]| values.first().copied().unwrap_or(f64::NAN);
        let [bottom, top] =
            shape.face_stresses().map_or([None; 2], |faces| faces.map(|face| Some(first(face))));
        SectionForces {
            axial_force: first(&shape.axial_force),
            shear_force: first(&shape.shear_force),
            bending_moment: first(&shape.bending_moment),
            stress_bottom: bottom,
            stress_top: top,
        }
    }

    /// All beams at the places of a frame; empty where it is not known what acts.
    fn along_beams(&self, q: &[f64], v: Option<&[f64]>, actions: Option<&[Actions]>) -> Vec<BeamSections> {
        let of_beam = |(beam, actions): (usize, &Actions)| {
            let (s, velocity) = self.frame_places(beam, v);
            let mut sides = vec![Side::Right; s.len()];
            if let Some(end) = sides.last_mut() {
                *end = Side::Left;
            }
            BeamSections { shape: self.cut_shape(beam, &s, &sides, q, actions), velocity }
        };
        actions.into_iter().flatten().enumerate().map(of_beam).collect()
    }
}
