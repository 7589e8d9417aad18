//! Loads and their amplitudes.

use super::Effect;
use crate::law::Law;

/// The factor by which a load acts.
#[derive(Clone, Debug, PartialEq)]
pub enum Amplitude {
    /// The load factor itself.
    Proportional,
    /// One, at all times.
    Full,
    /// A factor, times what is [`remaining`].
    Fading {
        /// The factor.
        factor: f64,
        /// Whether it is the value of a law of time.
        by_law: bool,
    },
    /// A law of time.
    Law(Law),
}

impl Amplitude {
    /// The factor at load factor or time `parameter`.
    pub fn at(&self, parameter: f64) -> f64 {
        match self {
            Self::Proportional => parameter,
            Self::Full => 1.0,
            Self::Fading { factor, .. } => factor * remaining(parameter)[0],
            Self::Law(law) => law.at(parameter)[0],
        }
    }

    /// As [`Self::at`], with the first two derivatives by the time.
    pub fn rates(&self, time: f64) -> [f64; 3] {
        match self {
            Self::Law(law) => law.at(time),
            _ => [self.at(time), 0.0, 0.0],
        }
    }

    /// The law of time that it follows.
    pub fn law(&self) -> Option<&Law> {
        match self {
            Self::Law(law) => Some(law),
            _ => None,
        }
    }

    /// Its derivative with respect to the load factor, which laws of time do not depend on.
    pub fn rate(&self, load: f64) -> f64 {
        match self {
            Self::Proportional => 1.0,
            Self::Fading { factor, .. } => factor * remaining(load)[1],
            Self::Full | Self::Law(_) => 0.0,
        }
    }
}

/// What is left at a load factor of that which fades, or closes, as the load factor goes from 0 to 1,
/// with its derivative, at 0 and 1 that of the way ahead. A path goes on beyond 1, and what has
/// faded does not come back with the opposite sign.
pub fn remaining(load: f64) -> [f64; 2] {
    let rate = if (0.0..1.0).contains(&load) { -1.0 } else { 0.0 };
    [1.0 - load.clamp(0.0, 1.0), rate]
}

/// How a part acts in the state with which an analysis begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Acting {
    /// Not yet.
    Not,
    /// As it goes on to act.
    Already,
    /// It acted at this time \[s\], and has gone.
    NoLonger {
        /// The time.
        time: f64,
    },
}

impl Acting {
    /// The amplitude of a load that follows `law`; `None` for that of the system.
    pub fn amplitude(self, law: Option<&Law>) -> Option<Amplitude> {
        match (self, law) {
            (Self::NoLonger { time }, Some(law)) => {
                Some(Amplitude::Fading { factor: law.at(time)[0], by_law: true })
            }
            (Self::NoLonger { .. }, None) => Some(Amplitude::Fading { factor: 1.0, by_law: false }),
            (_, Some(law)) => Some(Amplitude::Law(law.clone())),
            (Self::Already, None) => Some(Amplitude::Full),
            (Self::Not, None) => None,
        }
    }
}

/// A load with its amplitude.
pub struct ActingLoad {
    /// The load.
    pub effect: Box<dyn Effect>,
    /// `None` for a load without a law of its own: it takes the amplitude of the system.
    pub amplitude: Option<Amplitude>,
}

impl ActingLoad {
    /// Whether the load belongs to the sum of loads that are the same in every state.
    pub fn is_summed(&self) -> bool {
        self.amplitude.is_none() && self.effect.is_constant()
    }

    /// Whether its work is the difference of a potential. For a load that follows a law of time, or
    /// has followed one before it went, it is not.
    pub fn has_potential(&self) -> bool {
        let by_law = match self.amplitude {
            Some(Amplitude::Law(_)) => true,
            Some(Amplitude::Fading { by_law, .. }) => by_law,
            Some(Amplitude::Proportional | Amplitude::Full) | None => false,
        };
        !by_law && self.effect.is_conservative()
    }
}
