//! Weight.

use super::force::add_dead_force;
use crate::assembly::{Assembly, BuildError, Extent, Kind, Part};
use crate::law::Law;

/// Weight of every beam and every point mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// Acceleration of gravity \[m/s²\].
    pub acceleration: [f64; 2],
    /// In a motion, the law of time that the load's factor follows; without one the load acts in
    /// full from the start.
    pub law: Option<Law>,
}

impl Gravity {
    /// Gravity with this acceleration \[m/s²\].
    pub fn new(acceleration: [f64; 2]) -> Self {
        Self { acceleration, law: None }
    }
}

impl Part for Gravity {
    fn add_to(&self, assembly: &mut Assembly<'_>) -> Result<(), BuildError> {
        let beams = assembly.beams();
        let weights = beams.iter().enumerate().filter_map(|(index, beam)| {
            let mass = beam.section.mass_per_length.as_ref()?;
            Some(Extent::along(index, assembly.mass_rule(index), mass))
        });
        let points = assembly.masses().iter().map(|(at, mass)| (*mass, Extent::Point(*at)));
        let weights: Vec<(f64, Extent)> = weights.chain(points).collect();
        if let (true, Some(first)) = (weights.is_empty(), beams.first()) {
            return Err(BuildError::missing(first, "mass per length", "gravity"));
        }
        weights.into_iter().try_for_each(|(mass, extent)| {
            let force = self.acceleration.map(|g| mass * g);
            add_dead_force(assembly, Kind::Gravity, extent, force, self.law.as_ref())
        })
    }

    fn fades(&self) -> bool {
        true
    }
}
