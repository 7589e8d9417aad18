//! Events in words, as the terminal and the page tell them.

use crate::model::ProbeQuantity;
use crate::results::{ContactImpulse, Event, EventErrors};

/// An event in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EventText {
    /// What it is one of, such as `event at tip`.
    pub name: String,
    /// Time or load factor.
    pub when: String,
    /// What is then.
    pub what: String,
}

impl EventText {
    /// An event with its errors, where these are known; `known` writes a number with no digit beyond its error.
    pub fn new(
        event: &Event,
        errors: Option<EventErrors>,
        known: impl Fn(f64, Option<f64>) -> String,
    ) -> Self {
        let errors = errors.unwrap_or_default();
        let unknown = if errors.parameter.is_finite() { "" } else { " (error unknown)" };
        let parameter = known(event.parameter(), Some(errors.parameter));
        match event {
            Event::Probe { probe, quantity, value, turns, .. } => {
                let unit = ProbeQuantity::ALL.iter().map(|of| of.name()).find(|(name, _)| name == quantity);
                let unit = unit.map_or("", |(_, unit)| unit);
                let turns = turns.map_or_else(String::new, |turns| format!(", a {turns}"));
                let value = format!("{} {unit}", known(*value, errors.value));
                Self {
                    name: format!("event at {probe}"),
                    when: format!("{parameter} s{unknown}"),
                    what: format!("{quantity} = {}{turns}", value.trim_end()),
                }
            }
            Event::Contact { contact, touches, impulse, .. } => {
                let mut what = if *touches { "begins" } else { "ends" }.to_owned();
                if let Some(ContactImpulse { impulse, largest_force }) = impulse {
                    let [x, y] = impulse.map(|part| known(part, errors.impulse));
                    let force = known(*largest_force, errors.largest_force);
                    what.push_str(&format!(", impulse ({x}, {y}) N s, up to {force} N"));
                }
                Self { name: format!("contact {contact}"), when: format!("{parameter} s{unknown}"), what }
            }
            Event::Stability { stability, unstable_directions, .. } => Self {
                name: format!("stability {stability}"),
                when: format!("load factor {parameter}{unknown}"),
                what: unstable_directions.map_or_else(String::new, |[before, after]| {
                    format!("unstable directions {before} before, {after} after")
                }),
            },
        }
    }
}
