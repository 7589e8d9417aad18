//! How loads and supports follow the parameter of an analysis: the load factor of statics, the time of a motion.

use crate::model::Law;

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

/// A prescribed quantity: start + change · (load factor or law of time).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Course {
    /// Value in the stress-free state.
    pub start: f64,
    /// By how much it changes.
    pub change: f64,
    /// The law of time; none: the load factor.
    pub law: Option<Law>,
}

impl Course {
    /// The value at load factor or time `parameter`.
    pub fn at(&self, parameter: f64) -> f64 {
        let part = self.law.as_ref().map_or(parameter, |law| law.at(parameter)[0]);
        self.change.mul_add(part, self.start)
    }

    /// Value and first two derivatives by the parameter.
    pub fn rates(&self, parameter: f64) -> [f64; 3] {
        let [part, first, second] = self.law.as_ref().map_or([parameter, 1.0, 0.0], |law| law.at(parameter));
        [self.change.mul_add(part, self.start), self.change * first, self.change * second]
    }

    /// The same in a motion, where what follows no law stays.
    pub fn prescribed(&self, time: f64) -> [f64; 3] {
        if self.law.is_some() { self.rates(time) } else { [self.start, 0.0, 0.0] }
    }

    /// Whether it changes at all.
    pub fn moves(&self) -> bool {
        self.change != 0.0
    }

    /// Whether it changes with time.
    pub fn moves_in_time(&self) -> bool {
        self.moves() && self.law.is_some()
    }
}
