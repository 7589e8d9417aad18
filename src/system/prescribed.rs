//! Prescribed quantities of supports as functions of the parameter of an analysis: the load factor
//! in statics, the time in a motion.

use crate::law::Law;

/// Relative difference that counts as round-off.
pub(super) const ROUND_OFF: f64 = 1e-9;

/// A prescribed quantity: start + change · (load factor, or law of time).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prescribed {
    /// Value in the stress-free state.
    pub start: f64,
    /// The change, which is multiplied by the load factor or the law.
    pub change: f64,
    /// The law of time; `None` if it follows the load factor.
    pub law: Option<Law>,
}

impl Prescribed {
    /// The value at the load factor or time `parameter`.
    pub fn at(&self, parameter: f64) -> f64 {
        let part = self.law.as_ref().map_or(parameter, |law| law.at(parameter)[0]);
        self.change.mul_add(part, self.start)
    }

    /// Sets the start to `value`, unless a law moves the quantity or `value` differs only by
    /// round-off relative to `unit`.
    pub fn freeze(&mut self, value: f64, unit: f64) {
        if !self.moves_in_time() && (self.start - value).abs() > ROUND_OFF * unit {
            self.start = value;
        }
    }

    /// As [`Self::freeze`], for the angle by which `reference` is turned to the direction of
    /// `field`.
    pub fn freeze_angle(&mut self, reference: [f64; 2], field: [f64; 2]) {
        let (sine, cosine) = self.start.sin_cos();
        let [x, y] =
            [cosine * reference[0] - sine * reference[1], sine * reference[0] + cosine * reference[1]];
        let further = (x * field[1] - y * field[0]).atan2(x * field[0] + y * field[1]);
        self.freeze(self.start + further, 1.0);
    }

    /// Value and first two derivatives with respect to the parameter.
    pub fn rates(&self, parameter: f64) -> [f64; 3] {
        let [part, first, second] = self.law.as_ref().map_or([parameter, 1.0, 0.0], |law| law.at(parameter));
        [self.change.mul_add(part, self.start), self.change * first, self.change * second]
    }

    /// As [`Self::rates`] in a motion, where a quantity without a law is constant.
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
