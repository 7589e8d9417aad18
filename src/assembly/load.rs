//! Loads as a system sums them, with the factor by which they act.

use super::Effect;
use crate::law::Law;

/// By what factor a load acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Amplitude {
    /// By the load factor.
    Proportional,
    /// In full at all times.
    Full,
    /// By a law of time.
    Law(Law),
}

impl Amplitude {
    /// The factor at load factor or time `parameter`.
    pub fn at(&self, parameter: f64) -> f64 {
        match self {
            Self::Proportional => parameter,
            Self::Full => 1.0,
            Self::Law(law) => law.at(parameter)[0],
        }
    }
}

/// A load with its amplitude.
pub struct ActingLoad {
    /// The load.
    pub effect: Box<dyn Effect>,
    /// None: that of all loads without a law of their own.
    pub amplitude: Option<Amplitude>,
}

impl ActingLoad {
    /// Whether it is part of the sum of loads that are the same in every state.
    pub fn is_summed(&self) -> bool {
        self.amplitude.is_none() && self.effect.is_constant()
    }

    /// Whether its work is the difference of a potential: of a load that follows time it is not.
    pub fn has_potential(&self) -> bool {
        self.amplitude.is_none() && self.effect.is_conservative()
    }
}
