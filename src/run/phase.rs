//! Vibrations that run slow in steps of a fixed length.
//!
//! Of an oscillation of the angular frequency ω a method with the step h keeps a frequency that is too low by the part c (ω h)ᵖ. What it is
//! late by adds up as long as the oscillation lasts, and is no error of energy: of a motion that nothing drives, the root mean
//! squares of velocities and displacements tell ω, and so how late it ends.

use crate::assembly::nodes;
use crate::model::{Dynamic, Integrator, StepControl};
use crate::numeric::plain;
use crate::solve::dynamics::State;
use crate::system::System;
use std::f64::consts::{PI, SQRT_2, TAU};

/// What a vibration may be late by \[rad\] …
const TOLERATED: f64 = 0.1;
/// … and is with the steps that the message names.
const GOOD: f64 = 0.01;
/// Fewer states tell no frequency.
const STATES: usize = 10;
/// Displacements below this part of the length of the beams are no motion.
const STILL: f64 = 1e-8;

/// The coefficient c and the power p of the part by which a method makes frequencies too low. That of generalised-α follows from
/// the eigenvalues of its amplification, those of collocation from their stability functions on the imaginary axis.
fn slowness(method: Integrator) -> (f64, i32) {
    match method {
        Integrator::GeneralizedAlpha { spectral_radius: rho, .. } => {
            (1.0 / 12.0 + 0.375 * ((1.0 - rho) / (1.0 + rho)).powi(2), 2)
        }
        Integrator::Gauss { stages: 1, .. } => (1.0 / 12.0, 2),
        Integrator::Gauss { stages: 2, .. } => (1.0 / 720.0, 4),
        Integrator::Gauss { .. } => (1.0 / 100_800.0, 6),
        Integrator::Radau { stages: 2, .. } => (1.0 / 270.0, 4),
        Integrator::Radau { .. } => (1.0 / 42_000.0, 6),
    }
}

/// How a system moves while nothing drives it.
struct Oscillation {
    /// Angular frequency of the largest displacements, or less \[rad/s\].
    frequency: f64,
    /// The time during which it lasts \[s\].
    lasts: f64,
    /// Root mean square of the displacements \[m\].
    size: f64,
}

impl Oscillation {
    /// `None` of what hardly moves, and where states are too few.
    fn of(system: &System, states: &[State]) -> Option<Self> {
        let [first, .., last] = states else { return None };
        if states.len() < STATES {
            return None;
        }
        let count = states.len() as f64;
        let size = |values: &[f64]| -> f64 {
            nodes(values).map(|node| node.position.iter().map(|x| x * x).sum::<f64>()).sum()
        };
        let mut mean = vec![0.0; first.q.len()];
        for state in states {
            mean.iter_mut().zip(&state.q).for_each(|(mean, q)| *mean += q / count);
        }
        let mut off = vec![0.0; mean.len()];
        let mut displaced = 0.0;
        for state in states {
            off.iter_mut().zip(&state.q).zip(&mean).for_each(|((off, q), mean)| *off = q - mean);
            displaced += size(&off) / count;
        }
        let fast: Vec<f64> = states.iter().map(|state| size(&state.v)).collect();
        let [second, fourth] = [1, 2].map(|power| fast.iter().map(|v| v.powi(power)).sum::<f64>() / count);
        let rms = (displaced / nodes(&mean).len() as f64).sqrt();
        if rms < STILL * system.length() || fourth == 0.0 {
            return None;
        }
        let span = last.time - first.time;
        // Of what swings back and forth between two states displacements tell nothing.
        let frequency = (second / displaced).sqrt().min(PI * (count - 1.0) / span);
        // Of an oscillation that goes on the mean fourth power is 3/2 of the square of the mean second one.
        let lasts = span * (1.5 * second * second / fourth).min(1.0);
        Some(Self { frequency, lasts, size: rms })
    }
}

/// A message where the steps, which are of a fixed length, let what moves most be late in the end. Nothing is said of times at which a load or a
/// support changes, which sets the pace.
pub(super) fn late(system: &System, settings: &Dynamic, states: &[State], steps: usize) -> Option<String> {
    let StepControl::Fixed(step) = settings.integrator.step_control() else { return None };
    let [first, .., last] = states else { return None };
    let times: Vec<f64> = states.iter().map(|state| state.time).collect();
    let free = states.get(system.steady_from(&times)?..)?;
    let Oscillation { frequency, lasts, size } = Oscillation::of(system, free)?;
    let step = step.min((last.time - first.time) / steps.max(1) as f64);
    let (coefficient, power) = slowness(settings.integrator);
    let slow = (coefficient * (frequency * step).powi(power)).min(1.0);
    let late = slow * frequency * lasts;
    // From a quarter of a swing on, a state is as far off as one that is taken at random.
    let off = size * (2.0 * (0.5 * late.min(PI)).sin()).min(SQRT_2);
    (late > TOLERATED).then(|| {
        format!(
            "vibrations of {} Hz, which most of the motion consists of, run {slow:.1e} of themselves too slow in steps of {step:.1e} s, and are late by \
             about {} cycles after {} s: positions at a time are off by about {off:.1e} m (root mean square); use steps below {:.1e} s, or a `tolerance`",
            plain(frequency / TAU, 3),
            plain(late / TAU, 2),
            plain(lasts, 3),
            step * (GOOD / late).powf(1.0 / f64::from(power))
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::scene::parse;

    /// A rod of 1 kg on a spring of (2π)² N/m, which swings once in a second, along its axis.
    fn told(more: &str, analysis: &str) -> Option<String> {
        let text = format!(
            "beam.rod = {{ start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 1e3, mass_per_length = 1, \
             basis.ancf.elements = 1 }}\n\
             effect.spring = [{{ beam = 'rod', at = 'start', anchor = [-1, 0], stiffness = {} }}]\n\
             initial_velocity = [{{ beam = 'rod', value = [0.5, 0] }}]\n{more}\nanalysis.dynamic = {{ duration = 100, output_every = 0.37, {analysis} }}\n",
            std::f64::consts::TAU.powi(2)
        );
        let scene = parse("scene", &text).unwrap_or_else(|error| panic!("{error}"));
        let results = scene.model().solve(scene.analysis()).expect("a motion");
        results.run().warnings.iter().find(|text| text.contains("too slow in steps")).cloned()
    }

    /// The number in a message between two of its words.
    fn between(message: &str, before: &str, after: &str) -> f64 {
        let rest = message.split_once(before).unwrap_or_else(|| panic!("{before}: {message}")).1;
        rest.split(after).next().and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{message}"))
    }

    /// Of the frequency the trapezoidal rule keeps 1 − (2π/20)²/12 with 20 steps a swing, and after 100 of them 0.82 are missing. With
    /// 80 steps it is a sixteenth of that, 0.3 rad, and with 160 0.08 rad, which is no matter.
    #[test]
    fn swings_that_steps_lose_are_counted() {
        let trapezoidal =
            |step: f64| told("", &format!("generalized_alpha = {{ step = {step}, spectral_radius = 1 }}"));
        let message = trapezoidal(0.05).expect("a warning");
        for (before, after, expected) in [
            ("vibrations of ", " Hz", 1.0),
            ("run ", " of themselves", 8.2e-3),
            ("late by about ", " cycles", 0.82),
            // 0.5 m/s let it swing by 0.08 m, 0.056 m as a root mean square, and 0.82 cycles are out of all step.
            ("off by about ", " m", 0.08),
            // (0.01 rad/5.17 rad)^(1/2) of the step.
            ("use steps below ", " s", 2.2e-3),
        ] {
            // Root mean squares of 271 states know as much.
            let found = between(&message, before, after);
            assert!((found - expected).abs() < 0.03 * expected, "{found} for {expected}: {message}");
        }
        assert!(trapezoidal(0.0125).is_some());
        assert_eq!(trapezoidal(0.00625), None);
    }

    /// Of 100 swings one, two and three stages of Gauss lose (2π h)²/12, (2π h)⁴/720 and (2π h)⁶/100800, and the most damped generalised-α
    /// 11 (2π h)²/24.
    #[test]
    fn every_method_loses_its_own_part() {
        for (method, lost) in [
            ("gauss = { stages = 1, step = 0.02 }", 0.13),
            ("gauss = { stages = 2, step = 0.15 }", 0.11),
            ("gauss = { stages = 3, step = 0.3 }", 0.044),
            ("generalized_alpha = { step = 0.01, spectral_radius = 0 }", 0.18),
        ] {
            let message = told("", method).expect(method);
            let found = between(&message, "late by about ", " cycles");
            assert!((found - lost).abs() < 0.05 * lost + 0.005, "{method}: {message}");
        }
        for method in ["gauss.step = 0.05", "radau = { stages = 2, step = 0.05 }", "radau.step = 0.05"] {
            assert_eq!(told("", method), None);
        }
    }

    /// Nothing is said of what keeps the time of a law, of what comes to rest before it is late, and of what moves on its way.
    #[test]
    fn what_is_driven_or_damped_is_not_late() {
        let steps = "generalized_alpha.step = 0.025";
        assert!(told("", steps).is_some());
        let driven = "effect.force = [{ beam = 'rod', at = 'start', value = [1, 0], in_time.harmonic.frequency = 1.3 }]";
        assert_eq!(told(driven, steps), None);
        assert_eq!(told("effect.damping = [{ beam = 'rod', mass_proportional = 1 }]", steps), None);
        assert_eq!(told("effect.damping = [{ beam = 'rod', mass_proportional = 100 }]", steps), None);
    }
}
