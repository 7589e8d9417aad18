//! The elastic energy of actuated beams, and the work of the actuators.
//!
//! If several actuations with the amplitudes a_i act on a beam, ε₀ = Σ a_i ε₀ᵢ, the elastic energy
//! is
//!
//! ```text
//! ½ ∫ EA (ε − ε₀)² ds = ½ ∫ EA ε² ds − Σ a_i ∫ EA ε₀ᵢ ε ds + ½ Σ a_i a_j ∫ EA ε₀ᵢ ε₀ⱼ ds
//! ```
//!
//! and likewise for bending; what a section couples is counted with bending. The first term is the energy of the beam without actuation, and the
//! terms of the sum are the potentials by which actuation acts on the motion. When an amplitude
//! changes, the actuator supplies the power −∫ N ε̇₀ ds − ∫ M κ̇₀ ds.

use super::System;
use crate::assembly::{Acting, Actions, Amplitude, DiscretizedBeam, Imposed, Kind, Part};
use crate::model::{Along, Beam, Model};
use std::sync::Arc;

/// The actuations of a beam.
#[derive(Debug)]
pub(super) struct Actuated {
    beam: usize,
    /// a_i; `None` stands for the amplitude of all loads without a law.
    amplitudes: Vec<Option<Amplitude>>,
    /// The strains that are imposed on single layers: index of the layer, strain, and a_i.
    layers: Vec<(usize, Along, Option<Amplitude>)>,
    taken: Vec<Taken>,
    /// ∫ EA ε₀ᵢ ε₀ⱼ ds, and ∫ (EI κ₀ᵢ κ₀ⱼ + EB ε₀ᵢ κ₀ⱼ + EB κ₀ᵢ ε₀ⱼ) ds \[J\], of row i and column j.
    own: [Vec<Vec<f64>>; 2],
}

/// What one actuation takes from the axial force and the bending moment of a beam, as far as it has such stiffnesses.
#[derive(Debug)]
struct Taken {
    /// EA ε₀ᵢ and EB κ₀ᵢ \[N\], EB ε₀ᵢ and EI κ₀ᵢ \[N m\].
    forces: [[Option<Along>; 2]; 2],
    /// a_i.
    amplitude: Option<Amplitude>,
}

/// Collects the actuations of the model's parts and of those that are `fading` by beam.
pub(super) fn actuated(model: &Model, fading: &[(Arc<dyn Part>, f64)], system: &System) -> Vec<Actuated> {
    let of_beam = |(index, (beam, part)): (usize, (&Beam, &DiscretizedBeam))| {
        let standing =
            model.parts.iter().enumerate().map(|(number, part)| {
                (part, if model.stands(number) { Acting::Already } else { Acting::Not })
            });
        let gone = fading.iter().map(|(part, time)| (part, Acting::NoLonger { time: *time }));
        let parts: Vec<_> = standing
            .chain(gone)
            .filter_map(|(part, acting)| {
                let imposed = part.actuation(index)?;
                let amplitude = acting.amplitude(imposed.law);
                Some((imposed, amplitude))
            })
            .collect();
        let length = part.basis.length();
        let integral = |stiffness: &Option<Along>, first: &Along, second: &Along| {
            let product = stiffness.as_ref().map(|along| along.product(first).product(second));
            product.map_or(0.0, |along| along.mean(length) * length)
        };
        let section = &beam.section;
        // What is imposed on one layer acts together with what is imposed on the same one, or on all.
        let shared = |i: usize, j: usize, part: usize| -> Option<Option<Along>> {
            match (parts[i].0.layer, parts[j].0.layer) {
                (None, None) => None,
                (Some(a), Some(b)) if a != b => Some(None),
                (a, b) => {
                    let layer = section.layers.get(a.or(b)?)?;
                    Some(layer.stiffness.as_ref().map(|stiffness| stiffness[part].clone()))
                }
            }
        };
        let stretch = |i: usize, j: usize| {
            let (first, second) = (parts[i].0.strain, parts[j].0.strain);
            match shared(i, j, 0) {
                Some(stiffness) => integral(&stiffness, first, second),
                None => integral(&section.axial_stiffness, first, second),
            }
        };
        let bend = |i: usize, j: usize| {
            let Imposed { strain: e, curvature: k, .. } = parts[i].0;
            let Imposed { strain: f, curvature: l, .. } = parts[j].0;
            let coupling = match shared(i, j, 1) {
                // A layer has no curvature of its own.
                Some(coupling) => return integral(&coupling, e, l) + integral(&coupling, k, f),
                None => &section.coupling,
            };
            integral(&section.bending_stiffness, k, l) + integral(coupling, e, l) + integral(coupling, k, f)
        };
        let rows = |entry: &dyn Fn(usize, usize) -> f64| {
            (0..parts.len()).map(|i| (0..parts.len()).map(|j| entry(i, j)).collect()).collect()
        };
        let amplitudes = parts.iter().map(|(_, amplitude)| amplitude.clone()).collect();
        let layers = parts.iter().filter_map(|(imposed, amplitude)| {
            Some((imposed.layer?, imposed.strain.clone(), amplitude.clone()))
        });
        let layers = layers.collect();
        let taken = parts.iter().filter_map(|(imposed, amplitude)| {
            let [strain, curvature] = [imposed.strain, imposed.curvature];
            let forces = match imposed.layer {
                Some(layer) => {
                    let stiffness = section.layers.get(layer)?.stiffness.as_ref();
                    [0, 1].map(|part| [stiffness.map(|stiffness| stiffness[part].product(strain)), None])
                }
                None => {
                    let by = |stiffness: &Option<Along>, along| stiffness.as_ref().map(|s| s.product(along));
                    let coupled = |along| by(&section.coupling, along);
                    let (axial, bending) = (&section.axial_stiffness, &section.bending_stiffness);
                    [[by(axial, strain), coupled(curvature)], [coupled(strain), by(bending, curvature)]]
                }
            };
            Some(Taken { forces, amplitude: amplitude.clone() })
        });
        let taken = taken.collect();
        let own = || [rows(&stretch), rows(&bend)];
        (!parts.is_empty()).then(|| Actuated { beam: index, amplitudes, layers, taken, own: own() })
    };
    model.beams.iter().zip(&system.beams).enumerate().filter_map(of_beam).collect()
}

impl System {
    /// a_i, of one of [`Actuated::amplitudes`] or of a load.
    fn amplitude_or_own<'a>(&'a self, amplitude: &'a Option<Amplitude>) -> &'a Amplitude {
        amplitude.as_ref().unwrap_or(&self.amplitude)
    }

    /// ½ Σ a_i a_j G_ij of one of the matrices of [`Actuated::own`], and its derivative with respect
    /// to the load factor.
    fn square(&self, actuated: &Actuated, part: usize, parameter: f64) -> (f64, f64) {
        let amplitude = |law: &Option<Amplitude>| {
            let amplitude = self.amplitude_or_own(law);
            (amplitude.at(parameter), amplitude.rate(parameter))
        };
        let amplitudes: Vec<(f64, f64)> = actuated.amplitudes.iter().map(amplitude).collect();
        let mut sums = (0.0, 0.0);
        for ((a, rate), row) in amplitudes.iter().zip(&actuated.own[part]) {
            let other: f64 = amplitudes.iter().zip(row).map(|((b, _), entry)| b * entry).sum();
            sums.0 += 0.5 * a * other;
            sums.1 += rate * other;
        }
        sums
    }

    /// −∫ EA ε₀ᵢ ε ds (part 0) or −∫ EI κ₀ᵢ κ ds (part 1), relative to the stress-free shape, of all
    /// actuations of a beam, each with its amplitude, if it has one of its own.
    fn potentials<'a>(
        &'a self,
        actuated: &'a Actuated,
        part: usize,
        q: &'a [f64],
    ) -> impl Iterator<Item = (&'a Option<Amplitude>, f64)> {
        let kind = [Kind::PreStrain, Kind::PreCurvature][part];
        let loads = self.terms.loads.iter();
        let of = loads.filter(move |load| load.effect.kind() == kind && load.effect.beam() == actuated.beam);
        of.map(|load| (&load.amplitude, load.effect.energy(q) - load.effect.energy(&self.reference)))
    }

    /// The terms that actuation adds to the energies of stretch and of bending \[J\], and the part
    /// of them that actuators with laws of time have supplied since the start.
    pub(super) fn actuation_energy(&self, parameter: f64, q: &[f64]) -> ([f64; 2], f64) {
        let (mut energy, mut put_in) = ([0.0; 2], 0.0);
        for actuated in &self.actuated {
            for (part, energy) in energy.iter_mut().enumerate() {
                let (mut own, mut common) = (0.0, 0.0);
                for (amplitude, potential) in self.potentials(actuated, part, q) {
                    match amplitude {
                        Some(amplitude) => own += amplitude.at(parameter) * potential,
                        None => common += potential,
                    }
                }
                let square = self.square(actuated, part, parameter).0;
                *energy += own + self.amplitude.at(parameter) * common + square;
                if self.amplitude == Amplitude::Full {
                    put_in += own + square - self.square(actuated, part, 0.0).0;
                }
            }
        }
        (energy, put_in)
    }

    /// Notes the strains that are imposed on layers beside the actions on each beam.
    pub(super) fn add_layer_strains(&self, parameter: f64, actions: &mut [Actions]) {
        for Actuated { beam, layers, .. } in &self.actuated {
            for (layer, strain, amplitude) in layers {
                let factor = self.amplitude_or_own(amplitude).at(parameter);
                actions[*beam].add_layer_strain(factor, *layer, strain);
            }
        }
    }

    /// The force Σ a_i EA ε₀ᵢ \[N\] at `s` that actuation takes from EA ε; `inside` is a place of the
    /// same cell.
    pub fn imposed_force(&self, beam: usize, s: f64, inside: f64, parameter: f64) -> f64 {
        self.imposed(beam, s, inside, parameter)[0][0]
    }

    /// What actuation takes from the axial force and the bending moment at `s`, each as the parts that the imposed strain and
    /// the imposed curvature have in it \[N, N m\]; `inside` is a place of the same cell.
    pub fn imposed(&self, beam: usize, s: f64, inside: f64, parameter: f64) -> [[f64; 2]; 2] {
        let mut sum = [[0.0; 2]; 2];
        let of_beam = self.actuated.iter().filter(|actuated| actuated.beam == beam);
        for Taken { forces, amplitude } in of_beam.flat_map(|actuated| &actuated.taken) {
            let amplitude = self.amplitude_or_own(amplitude).at(parameter);
            for (sum, force) in sum.as_flattened_mut().iter_mut().zip(forces.as_flattened()) {
                *sum += force.as_ref().map_or(0.0, |force| amplitude * force.at(s, inside));
            }
        }
        sum
    }

    /// Whether there are any actuators.
    pub fn has_actuators(&self) -> bool {
        !self.actuated.is_empty()
    }

    /// The scale of [`Self::actuators_rate`] \[J\]: the sum of its terms for beams that do not
    /// deform at all. Where beams follow their actuators, these terms cancel others of the same
    /// size.
    pub fn actuators_size(&self, load: f64) -> f64 {
        let size =
            |actuated: &Actuated| (0..2).map(|part| self.square(actuated, part, load).1.abs()).sum::<f64>();
        self.actuated.iter().map(size).sum()
    }

    /// Derivative of the actuators' work with respect to the load factor \[J\]: −∫ N ε₀ ds − ∫ M κ₀
    /// ds in the state `q`.
    pub fn actuators_rate(&self, load: f64, q: &[f64]) -> f64 {
        let of = |actuated: &Actuated, part: usize| {
            let potentials = self.potentials(actuated, part, q);
            let loads = potentials.map(|(amplitude, of)| self.amplitude_or_own(amplitude).rate(load) * of);
            loads.sum::<f64>() + self.square(actuated, part, load).1
        };
        let rate = |actuated: &Actuated| of(actuated, 0) + of(actuated, 1);
        self.actuated.iter().map(rate).sum()
    }
}
