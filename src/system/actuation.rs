//! The elastic energy of actuated beams, and the work of the actuators.
//!
//! If several actuations with the amplitudes a_i act on a beam, ε₀ = Σ a_i ε₀ᵢ, the elastic energy
//! is
//!
//! ```text
//! ½ ∫ EA (ε − ε₀)² ds = ½ ∫ EA ε² ds − Σ a_i ∫ EA ε₀ᵢ ε ds + ½ EA L ε₀²
//! ```
//!
//! and likewise for bending. The first term is the energy of the beam without actuation, and the
//! terms of the sum are the potentials by which actuation acts on the motion. When an amplitude
//! changes, the actuator supplies the power −∫ N ε̇₀ ds − ∫ M κ̇₀ ds.

use super::System;
use crate::assembly::Amplitude;
use crate::assembly::Kind;
use crate::model::Model;

/// The strains, or the curvatures, that actuations impose on a beam.
#[derive(Debug)]
pub(super) struct Actuated {
    beam: usize,
    kind: Kind,
    /// EA L or EI L.
    stiffness: f64,
    /// ε₀ᵢ or κ₀ᵢ with its amplitude; `None` stands for the amplitude of all loads without a law.
    own: Vec<(f64, Option<Amplitude>)>,
}

/// Collects the actuations of the model's parts by beam.
pub(super) fn actuated(model: &Model, system: &System) -> Vec<Actuated> {
    let mut all = Vec::new();
    for (index, (beam, part)) in model.beams.iter().zip(&system.beams).enumerate() {
        let parts: Vec<_> = model.parts.iter().filter_map(|part| part.actuation(index)).collect();
        let law = |law: Option<&crate::law::Law>| law.cloned().map(Amplitude::Law);
        let strains = parts.iter().map(|(strain, _, l)| (*strain, law(*l)));
        let curvatures = parts.iter().map(|(_, curvature, l)| (*curvature, law(*l)));
        for (kind, stiffness, own) in [
            (Kind::PreStrain, beam.section.axial_stiffness, strains.collect::<Vec<_>>()),
            (Kind::PreCurvature, beam.section.bending_stiffness, curvatures.collect()),
        ] {
            if own.iter().any(|(value, _)| *value != 0.0) {
                let stiffness = stiffness.unwrap_or(0.0) * part.basis.length();
                all.push(Actuated { beam: index, kind, stiffness, own });
            }
        }
    }
    all
}

impl System {
    /// ε₀ or κ₀, and its derivative with respect to the amplitude of all loads without a law.
    fn own(&self, actuated: &Actuated, parameter: f64) -> (f64, f64) {
        actuated.own.iter().fold((0.0, 0.0), |(sum, rate), (value, law)| match law {
            Some(law) => (sum + law.at(parameter) * value, rate),
            None => (sum + self.amplitude.at(parameter) * value, rate + value),
        })
    }

    /// −∫ EA ε₀ᵢ ε ds or −∫ EI κ₀ᵢ κ ds, relative to the stress-free shape: the sum over actuations
    /// with a law of time, times their amplitudes, and the sum over those without a law, without
    /// their amplitude.
    fn coupling(&self, actuated: &Actuated, parameter: f64, q: &[f64]) -> [f64; 2] {
        let of = self
            .terms
            .loads
            .iter()
            .filter(|load| load.effect.kind() == actuated.kind && load.effect.beam() == actuated.beam);
        of.fold([0.0; 2], |[by_law, others], load| {
            let energy = load.effect.energy(q) - load.effect.energy(&self.reference);
            match &load.amplitude {
                Some(law) => [by_law + law.at(parameter) * energy, others],
                None => [by_law, others + energy],
            }
        })
    }

    /// The terms that actuation adds to the energies of stretch and of bending \[J\], and the part
    /// of them that actuators with laws of time have supplied since the start.
    pub(super) fn actuation_energy(&self, parameter: f64, q: &[f64]) -> ([f64; 2], f64) {
        let (mut energy, mut put_in) = ([0.0; 2], 0.0);
        for actuated in &self.actuated {
            let square = |parameter: f64| 0.5 * actuated.stiffness * self.own(actuated, parameter).0.powi(2);
            let [by_law, others] = self.coupling(actuated, parameter, q);
            energy[usize::from(actuated.kind == Kind::PreCurvature)] +=
                by_law + self.amplitude.at(parameter) * others + square(parameter);
            if self.amplitude == Amplitude::Full {
                put_in += by_law + square(parameter) - square(0.0);
            }
        }
        (energy, put_in)
    }

    /// Whether there are any actuators.
    pub fn has_actuators(&self) -> bool {
        !self.actuated.is_empty()
    }

    /// The scale of [`Self::actuators_rate`] \[J\]: the sum of its terms for beams that do not
    /// deform at all. Where beams follow their actuators, these terms cancel others of the same
    /// size.
    pub fn actuators_size(&self, load: f64) -> f64 {
        let size = |actuated: &Actuated| {
            let (own, rate) = self.own(actuated, load);
            (actuated.stiffness * own * rate).abs()
        };
        self.actuated.iter().map(size).sum()
    }

    /// Derivative of the actuators' work with respect to the load factor \[J\]: −∫ N ε₀ ds − ∫ M κ₀
    /// ds in the state `q`.
    pub fn actuators_rate(&self, load: f64, q: &[f64]) -> f64 {
        let rate = |actuated: &Actuated| {
            let (own, rate) = self.own(actuated, load);
            self.coupling(actuated, load, q)[1] + actuated.stiffness * own * rate
        };
        self.actuated.iter().map(rate).sum()
    }
}
