//! What vibrations that are too fast for the steps would add to a motion.
//!
//! Methods that damp what their steps cannot follow take the same vibrations from a coarse run and from
//! a finer one, so that the two do not differ by them. The balance of energy tells: what both runs lose
//! alike, U, would vibrate on. With the mass m, and the stiffnesses ∫ EA ds and ∫ EI ds of all beams,
//! velocities are then larger by √(2 U/m) in the mean, strains by √(2 U/∫ EA ds), and curvatures by
//! √(2 U/∫ EI ds). Since a step h follows what is slower than 1/h, positions err by h √(2 U/m) at most.

use super::difference::{Difference, Scales, pairs};
use super::mesh::Mesh;
use crate::effect::BeamDamping;
use crate::model::{Along, Analysis, Beam, Model, Section};
use crate::results::{AnalysisKind, BeamErrors, Errors, ProbeErrors, ProbeSample, Results, Trajectory};
use std::any::Any;

/// Energy that is missing, in the largest energy of the motion, that is worth a word.
const TELLING: f64 = 1e-5;
/// Errors of steps that follow a motion fall by this factor at least from a coarse run to a finer one.
const FALLEN: f64 = 4.0;
/// The error of positions that is most likely, in the largest that there may be: most vibrations are faster than the slowest
/// that the steps do not follow.
const LIKELY: f64 = 0.3;
/// Energies are compared during such a part of the motion at a time.
const WINDOW: usize = 4;
/// Fewer records than that are few.
const FEW: usize = 16;

/// The vibrations that are missing.
pub(super) struct Missing {
    /// Per record of the finer run \[J\].
    energies: Vec<f64>,
    /// m \[kg\].
    mass: f64,
    /// ∫ EA ds \[N m\] of the beams that resist stretch.
    axial: f64,
    /// ∫ EI ds \[N m³\] of the beams that resist bending.
    bending: f64,
    /// The largest EA \[N\] and EI \[N m²\] of a beam.
    stiffest: [f64; 2],
    /// Mean step of the finer run \[s\].
    step: f64,
    /// Length of the longest beam \[m\].
    length: f64,
    /// Largest energy of the finer run \[J\].
    largest: f64,
}

impl Missing {
    /// What two motions on these meshes lack alike; `None` where they lack nothing.
    pub fn of(
        model: &Model,
        analysis: &Analysis,
        meshes: &[Mesh],
        coarse: &Results,
        fine: &Results,
    ) -> Option<Self> {
        let (coarse, fine) = (coarse.states(), fine.states());
        if fine.run.analysis != AnalysisKind::Dynamic {
            return None;
        }
        let mut losses = Vec::new();
        for (i, j) in pairs(analysis, &coarse.parameter, &fine.parameter).ok()? {
            losses.push((*fine.parameter.get(j)?, [lost(coarse, i)?, lost(fine, j)?]));
        }
        // Between two steps a state is interpolated, and its energy errs to both sides: a few records tell nothing, but for
        // the last one, with which a step ends.
        if losses.len() < FEW {
            losses.drain(..losses.len().saturating_sub(1));
        }
        let window = losses.len().div_ceil(WINDOW) + 1;
        let missing = |window: &[(f64, [f64; 2])]| {
            let fine = median(window.iter().map(|(_, [_, fine])| *fine));
            // What falls from the coarse run to the finer one is an error of steps that follow the motion.
            let apart = median(window.iter().map(|(_, [coarse, fine])| (coarse - fine).abs()));
            (window.last().map_or(0.0, |(time, _)| *time), (fine - apart / FALLEN).max(0.0))
        };
        let known = losses.windows(window.min(losses.len())).map(missing);
        let step =
            (fine.parameter.last()? - fine.parameter.first()?) / fine.run.statistics.steps.max(1) as f64;
        let fading = fading(model, meshes, step);
        let (mut most, mut energy, mut before) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut energies: Vec<f64> = known
            .map(|(time, known)| {
                // What was damped once stays away, but for what would have faded since.
                let more = (known - most).max(0.0);
                energy = energy * (-fading * (time - before)).exp() + more;
                (most, before) = (most + more, time);
                energy
            })
            .collect();
        energies.resize(fine.parameter.len(), energy);
        let total = |of: fn(&Section) -> Option<&Along>| {
            let beams = model.beams.iter().zip(meshes);
            let of = beams
                .filter_map(|(beam, mesh)| Some((of(&beam.section)?.mean(mesh.length()), mesh.length())));
            of.fold([0.0_f64; 2], |[sum, most], (mean, length)| [sum + mean * length, most.max(mean)])
        };
        let [mass, _] = total(|section| section.mass_per_length.as_ref());
        let [axial, stretch] = total(|section| section.axial_stiffness.as_ref());
        let [bending, bend] = total(|section| section.bending_stiffness.as_ref());
        let first = fine.energy.first()?.potential;
        let parts =
            fine.energy.iter().flat_map(|e| [e.stretch, e.bend, e.stored, e.kinetic, e.potential - first]);
        let missing = Self {
            mass,
            axial,
            bending,
            stiffest: [stretch, bend],
            step,
            length: meshes.iter().map(Mesh::length).fold(0.0, f64::max),
            largest: parts.fold(0.0, |most, part| most.max(part.abs())),
            energies,
        };
        (missing.most() > 0.0 && mass > 0.0).then_some(missing)
    }

    /// The largest energy that is missing \[J\].
    fn most(&self) -> f64 {
        self.energies.iter().copied().fold(0.0, f64::max)
    }

    /// What such an energy \[J\] adds to what a probe sees.
    fn sample(&self, energy: f64) -> ProbeSample {
        let amplitude = |of: f64| if of > 0.0 { (2.0 * energy / of).sqrt() } else { 0.0 };
        let (velocity, curvature) = (amplitude(self.mass), amplitude(self.bending));
        let position = self.step * velocity;
        ProbeSample {
            x: position,
            y: position,
            // A wave of number k turns by k and bends by k² times its height.
            angle: (position * curvature).sqrt(),
            curvature,
            strain: amplitude(self.axial),
            vx: Some(velocity),
            vy: Some(velocity),
        }
    }

    /// What is missing as errors of the finer run, of as many places and as large a curvature and forces as
    /// this difference.
    pub fn errors(&self, difference: &Difference) -> Difference {
        let (most, last) =
            (self.sample(self.most()), self.sample(self.energies.last().copied().unwrap_or(0.0)));
        let relative = |error: f64, scale: f64| if scale > 0.0 { error / scale } else { 0.0 };
        let Scales { curvature, force, moment } = difference.scales;
        let [stretch, bend] = self.stiffest;
        let errors = Errors {
            result: most.x / self.length,
            curvature: Some(relative(most.curvature, curvature)),
            section_force: Some(
                relative(stretch * last.strain, force).max(relative(bend * last.curvature, moment)),
            ),
        };
        let samples: Vec<ProbeSample> = self.energies.iter().map(|energy| self.sample(*energy)).collect();
        // What a support holds does not vibrate.
        let moves = |missing: f64, differs: f64| if differs == 0.0 { 0.0 } else { missing };
        let velocity =
            |missing: Option<f64>, differs: Option<f64>| missing.zip(differs).map(|(m, d)| moves(m, d));
        let of_sample = |(missing, differs): (&ProbeSample, &ProbeSample)| ProbeSample {
            x: moves(missing.x, differs.x),
            y: moves(missing.y, differs.y),
            angle: moves(missing.angle, differs.angle),
            vx: velocity(missing.vx, differs.vx),
            vy: velocity(missing.vy, differs.vy),
            curvature: moves(missing.curvature, differs.curvature),
            strain: moves(missing.strain, differs.strain),
        };
        let of_probe = |probe: &ProbeErrors| ProbeErrors {
            name: probe.name.clone(),
            samples: samples.iter().zip(&probe.samples).map(of_sample).collect(),
        };
        let of_beam = |beam: &BeamErrors| BeamErrors {
            position: vec![errors.result; beam.s.len()],
            curvature: vec![most.curvature; beam.s.len()],
            ..beam.clone()
        };
        Difference {
            errors,
            probes: difference.probes.iter().map(of_probe).collect(),
            records: samples.iter().map(|sample| sample.x / self.length).collect(),
            beams: difference.beams.iter().map(of_beam).collect(),
            ..Difference::default()
        }
    }

    /// The same as they most likely are: of positions a part of the largest.
    pub fn likely_errors(&self, difference: &Difference) -> Difference {
        let mut likely = self.errors(difference);
        likely.errors.result *= LIKELY;
        let of_probes = likely.probes.iter_mut().flat_map(|probe| &mut probe.samples);
        let positions = of_probes.flat_map(|sample| [&mut sample.x, &mut sample.y]);
        let of_beams = likely.beams.iter_mut().flat_map(|beam| &mut beam.position);
        positions.chain(of_beams).chain(&mut likely.records).for_each(|error| *error *= LIKELY);
        likely
    }

    /// What there is to say of them.
    pub fn note(&self) -> Option<String> {
        let energy = self.most();
        (energy > TELLING * self.largest).then(|| {
            format!(
                "vibrations with an energy of {energy:.1e} J are too fast for the steps, which damp them; with them velocities would differ \
                 by {:.1e} m/s. A smaller accuracy of positions or of section forces makes steps that follow them",
                self.sample(energy).x / self.step
            )
        })
    }
}

/// The energy that the steps have taken from a motion since its start \[J\].
fn lost(motion: &Trajectory, record: usize) -> Option<f64> {
    Some(motion.energy.first()?.total() - motion.energy.get(record)?.total())
}

/// The rate \[1/s\] at which the damping of all beams takes at least the energy of a vibration that is faster than a
/// `step` of h \[s\]: α + η/h² of Rayleigh damping, or where that is too fast to vibrate α + 1/η.
fn fading(model: &Model, meshes: &[Mesh], step: f64) -> f64 {
    let of_beam = |(index, (beam, mesh)): (usize, (&Beam, &Mesh))| {
        let least = |of: fn(&BeamDamping) -> Option<&Along>| -> f64 {
            let damping = model.parts.iter().filter_map(|part| {
                let part: &dyn Any = part.as_ref();
                part.downcast_ref::<BeamDamping>().filter(|damping| damping.beam == index)
            });
            damping.filter_map(of).map(|along| along.bounds(mesh.length())[0]).sum()
        };
        let viscous = |eta: f64| if eta > 0.0 { (eta / (step * step)).min(eta.recip()) } else { 0.0 };
        let along = beam.section.axial_stiffness.as_ref().map(|_| viscous(least(|d| d.strain.as_ref())));
        let across =
            beam.section.bending_stiffness.as_ref().map(|_| viscous(least(|d| d.curvature.as_ref())));
        let slowest = [along, across].into_iter().flatten().reduce(f64::min);
        least(|d| d.mass_proportional.as_ref()) + slowest.unwrap_or(0.0)
    };
    model.beams.iter().zip(meshes).enumerate().map(of_beam).fold(f64::INFINITY, f64::min)
}

/// The middle one of all values, of two the larger.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::round::tests::run;
    use crate::accuracy::runner::tests::scene;
    use crate::results::Energy;

    /// A motion of ten steps within a second with these kinetic energies, all that there are.
    fn motion(kinetic: &[f64]) -> Results {
        let mut results = run(AnalysisKind::Dynamic, 10, 0);
        let energy = kinetic.iter().map(|kinetic| Energy { kinetic: *kinetic, ..Energy::default() });
        let states = results.states_mut();
        states.energy = energy.collect();
        let times = kinetic.len().saturating_sub(1).max(1) as f64;
        states.parameter = (0..kinetic.len()).map(|i| i as f64 / times).collect();
        results
    }

    /// A beam of 4 m with EA = 10⁴ N, EI = 1 N m² and 1 kg/m.
    fn missing(coarse: &[f64], fine: &[f64]) -> Option<Missing> {
        let scene = scene("analysis.dynamic = { duration = 1 }");
        let analysis = scene.analysis();
        Missing::of(scene.model(), analysis, &[Mesh::of(&[0.0, 4.0])], &motion(coarse), &motion(fine))
    }

    /// Of seventeen records any six are looked at together.
    #[test]
    fn what_both_motions_lose_is_missing() {
        let energies =
            |coarse: [f64; 17], fine: [f64; 17]| missing(&coarse, &fine).map(|missing| missing.energies);
        let lost = |of: f64| {
            let mut kinetic = [10.0 - of; 17];
            kinetic[0] = 10.0;
            kinetic
        };
        assert_eq!(energies(lost(1.0), lost(1.0)), Some(vec![1.0; 17]));
        // What falls from run to run is an error of steps that follow the motion.
        assert_eq!(energies(lost(5.0), lost(1.0)), None);
        assert_eq!(energies(lost(3.0), lost(1.0)), Some(vec![0.5; 17]));
        assert_eq!(energies(lost(1.0), lost(-1.0)), None, "gained");
        // Energies that err to both sides are no loss; what was lost once stays so.
        let errs = std::array::from_fn(|i| 10.0 - [0.0, 1.0, 0.0, -1.0][i % 4]);
        assert_eq!(energies(errs, errs), None);
        let late = std::array::from_fn(|i| if (8..14).contains(&i) { 9.0 } else { 10.0 });
        assert_eq!(energies(late, late), Some([vec![0.0; 5], vec![1.0; 12]].concat()));
        // Of a few records the last one counts.
        let few = |last: f64| missing(&[10.0, 8.0, last], &[10.0, 8.0, last]).map(|missing| missing.energies);
        assert_eq!((few(9.0), few(10.0)), (Some(vec![1.0; 3]), None));
        assert!(missing(&[0.0], &[]).is_none());
    }

    /// α + η/h² with α = 0.5/s and the smaller one of two η, 2e-4 s and 1e-4 s, at steps of 0.01 s; α + 1/η where what is faster
    /// than a step does not vibrate. At 1.5/s the energy that is missing falls by e^{−1.5} in a second.
    #[test]
    fn damping_takes_what_is_missing() {
        let meshes = [Mesh::of(&[0.0, 4.0])];
        let rate = |damping: &str, step: f64| {
            let motion = "analysis.dynamic = { duration = 1 }";
            let scene = scene(&format!("effect.damping = [{{ beam = 'arm', {damping} }}]\n{motion}"));
            fading(scene.model(), &meshes, step)
        };
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
        let both = "mass_proportional = 0.5, strain = 2e-4, curvature = 1e-4";
        near(rate(both, 0.01), 0.5 + 1.0);
        near(rate("mass_proportional = 0.5, strain = 2e-2, curvature = 1e-2", 1e-3), 0.5 + 50.0);
        assert_eq!(rate("curvature = 1e-4", 0.01), 0.0);
        assert_eq!(rate("mass_proportional = 0.25", 0.01), 0.25);
        let scene = scene(
            "effect.damping = [{ beam = 'arm', mass_proportional = 1.5 }]\nanalysis.dynamic = { duration = 1 }",
        );
        // A loss of 2 J within a sixteenth of a second.
        let mut lost = [8.0; 17];
        lost[0] = 10.0;
        let motions = [(); 2].map(|()| motion(&lost));
        let missing = Missing::of(scene.model(), scene.analysis(), &meshes, &motions[0], &motions[1]);
        let energies = missing.expect("2 J").energies;
        near(energies[0], 2.0);
        near(energies[1], 2.0 * (-1.5_f64 / 16.0).exp());
        assert_eq!(energies[11..], [energies[16]; 6]);
        near(energies[16], 2.0 * (-1.5_f64 * 11.0 / 16.0).exp());
    }

    /// 8 J of 4 kg are 2 m/s, of 4·10⁴ N m a strain of 0.02, and of 4 N m³ a curvature of 2/m; during a step of
    /// 0.1 s it is 0.2 m, a twentieth of the length.
    #[test]
    fn errors_are_those_of_the_energy() {
        let lost = [10.0, 2.0];
        let missing = missing(&lost, &lost).expect("8 J");
        let probe = |x: f64, vx: Option<f64>| ProbeErrors {
            name: "tip".into(),
            samples: vec![
                ProbeSample {
                    x,
                    angle: x,
                    vx,
                    strain: 1e-9,
                    curvature: 1e-9,
                    ..ProbeSample::default()
                };
                2
            ],
        };
        let difference = Difference {
            probes: vec![probe(1e-9, Some(1e-9)), probe(0.0, Some(0.0)), probe(1e-9, None)],
            beams: vec![BeamErrors { s: vec![0.0, 4.0], ..BeamErrors::default() }],
            scales: Scales { curvature: 4.0, force: 400.0, moment: 10.0 },
            ..Difference::default()
        };
        let found = missing.errors(&difference);
        let near =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        near(found.errors.result, 0.05);
        near(found.errors.curvature.expect("it bends"), 0.5);
        near(found.errors.section_force.expect("it is loaded"), 0.5);
        near(found.records[1], 0.05);
        near(found.beams[0].position[1], 0.05);
        near(found.beams[0].curvature[0], 2.0);
        let [tip, held, _] = [0, 1, 2].map(|probe: usize| found.probes[probe].samples[1]);
        near(tip.x, 0.2);
        near(tip.angle, 0.4_f64.sqrt());
        near(tip.strain, 0.02);
        near(tip.curvature, 2.0);
        near(tip.vx.expect("a motion"), 2.0);
        assert_eq!((held.x, held.angle, held.vx, held.curvature), (0.0, 0.0, Some(0.0), tip.curvature));
        assert_eq!((found.probes[2].samples[1].vx, found.probes[0].samples[1].y), (None, 0.0));
        let unloaded = Difference { scales: Scales::default(), ..difference };
        assert_eq!(missing.errors(&unloaded).errors.section_force, Some(0.0));
        assert!(missing.note().is_some_and(|note| note.contains("8.0e0 J") && note.contains("2.0e0 m/s")));
    }

    #[test]
    fn a_hundred_thousandth_of_the_energy_is_worth_a_word() {
        let note =
            |lost: f64| missing(&[1.0, 1.0 - lost], &[1.0, 1.0 - lost]).and_then(|missing| missing.note());
        assert!(note(0.9e-5).is_none() && note(1.1e-5).is_some());
    }
}
