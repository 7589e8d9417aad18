//! Draws in which every key of the schema takes part often enough: of several scenes one is taken,
//! the rather the more it has of what is seldom drawn.

use std::collections::BTreeMap;

use fastrand::Rng;
use toml::Table;

use super::{draw, outcome, vocabulary};

/// Draws that tell how often keys are in legal scenes.
const SURVEY: usize = 4_000;
/// Share of the scenes that every key should have.
const WANTED: f64 = 0.012;
/// Scenes of which one is taken.
const CANDIDATES: usize = 100;

/// The weight of each key, zero for those that are often drawn.
pub struct Weights(BTreeMap<String, f64>);

impl Weights {
    /// Draws scenes to find how often each key is in one that is legal.
    ///
    /// A key of the share p below the wanted share w gets the weight (w − p)/p: where scenes are taken in
    /// proportion to the sum of their weights, such keys are in about w − p more of them.
    pub fn survey() -> Self {
        let mut rng = Rng::with_seed(0);
        let mut counts = BTreeMap::new();
        for _ in 0..SURVEY {
            let scene = draw::scene(&mut rng);
            if outcome::check(&scene, &draw::frame(&mut rng, &scene)).is_ok() {
                vocabulary::count(&scene, &mut counts);
            }
        }
        let wanted = WANTED * SURVEY as f64;
        let known = vocabulary::keys();
        let weights = counts.into_iter().filter(|(key, _)| known.contains(key)).map(|(key, n)| {
            let n = n as f64;
            (key, (wanted - n).max(0.0) / n)
        });
        Self(weights.collect())
    }

    fn of(&self, scene: &Table) -> f64 {
        vocabulary::used(scene).iter().filter_map(|key| self.0.get(key)).sum()
    }

    /// Draws scenes, and takes one of them.
    pub fn draw(&self, rng: &mut Rng) -> Table {
        let candidates: Vec<Table> = (0..CANDIDATES).map(|_| draw::scene(rng)).collect();
        let weights: Vec<f64> = candidates.iter().map(|scene| self.of(scene)).collect();
        let mut left = rng.f64() * weights.iter().sum::<f64>();
        let taken = weights.iter().position(|weight| {
            left -= weight;
            left < 0.0
        });
        candidates.into_iter().nth(taken.unwrap_or(0)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_schema_is_drawn() {
        let Weights(drawn) = Weights::survey();
        let never: Vec<String> =
            vocabulary::keys().into_iter().filter(|key| !drawn.contains_key(key)).collect();
        assert!(never.is_empty(), "no legal scene has {never:?}");
    }

    #[test]
    fn what_is_seldom_drawn_is_taken_more_often() {
        let key = "beam.*.section.circle.diameter.polynomial";
        let weights = Weights::survey();
        let mut rng = Rng::with_seed(1);
        let scenes: Vec<Table> = (0..400).map(|_| weights.draw(&mut rng)).collect();
        let n = scenes.iter().filter(|scene| vocabulary::used(scene).contains(key)).count();
        assert!(n >= 2, "{key} in {n} of 400");
    }
}
