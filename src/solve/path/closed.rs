//! Whether a path comes back to where it has been.

use crate::solve::equilibrium::size;
use crate::system::System;

/// Parts of how far a path has been away, in load factor and in shape, by which two equilibria differ at most that are one: limit
/// points of a path that comes back to them are.
const SAME: (f64, f64) = (1e-8, 1e-5);

/// The load factor of the first of the equilibria (λ, x) of a path that is the same as an earlier one, in view of how far the path
/// has gone away between them.
pub fn comes_back(system: &System, states: &[(f64, Vec<f64>)]) -> Option<f64> {
    let apart = |i: usize, k: usize| {
        let change: Vec<f64> = states[i].1.iter().zip(&states[k].1).map(|(a, b)| a - b).collect();
        size(system, &change)
    };
    let comes_back = |last: &usize| {
        let mut away = 0.0_f64;
        (0..*last).rev().any(|earlier| {
            let apart_in_load = (states[*last].0 - states[earlier].0).abs();
            let is_same_load = apart_in_load <= SAME.0 * away;
            away = away.max(apart_in_load);
            is_same_load && {
                let away =
                    (earlier + 1..*last).fold(0.0_f64, |away, between| away.max(apart(*last, between)));
                apart(*last, earlier) <= SAME.1 * away
            }
        })
    };
    (2..states.len()).find(comes_back).map(|last| states[last].0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::Needs;
    use crate::model::{Beam, Discretization, Model, Section};

    /// A path around a circle, in whatever unit of length, comes back after its last point of four; one that goes on along a line
    /// does not, nor does one with points close to each other.
    #[test]
    fn a_path_around_a_circle_comes_back() {
        for length in [1e-6, 1.0, 1e6] {
            let section = Section::new(1.0, 1.0);
            let beam = Beam::line("arm", [0.0, 0.0], [length, 0.0], section, Discretization::ancf(1));
            let model = Model { beams: vec![beam], ..Model::default() };
            let system = System::build(&model, Needs::default()).unwrap();
            let state = |x: f64, load: f64| (load, vec![x * length, 0.0, 1.0, 0.0, length, 0.0, 1.0, 0.0]);
            let mut states = vec![state(1.0, 0.0), state(0.0, 1.0), state(-1.0, 0.0), state(0.0, -1.0)];
            assert_eq!(comes_back(&system, &states), None);
            states.push(state(1.0 + 1e-9, 1e-9));
            assert_eq!(comes_back(&system, &states), Some(1e-9));
            let line: Vec<_> = (0..5).map(|i| state(f64::from(i), f64::from(i))).collect();
            assert_eq!(comes_back(&system, &line), None);
            let dense: Vec<_> =
                (0..5).map(|i| state(1e-7 * f64::from(i), 1.0 + 1e-10 * f64::from(i))).collect();
            assert_eq!(comes_back(&system, &dense), None);
        }
    }
}
