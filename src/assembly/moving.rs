//! Loads whose position moves along a beam.

use super::{Actions, Kind};

/// A load whose position on its beam is a function of time.
pub trait MovingLoad: Send + Sync {
    /// The kind of effect.
    fn kind(&self) -> Kind;

    /// Index of the beam.
    fn beam(&self) -> usize;

    /// `f += factor ·` its generalised force, with the sign of a density: the derivative of its
    /// negative work.
    fn add_force(&self, factor: f64, time: f64, f: &mut [f64]);

    /// Adds mean and first moment of the force from `start` to `end`
    /// ([`crate::law::Law::moments`]).
    fn add_moments(&self, start: f64, end: f64, moments: [&mut [f64]; 2]);

    /// Adds to `sum` its action on the beam in the state `q`.
    fn add_actions(&self, time: f64, q: &[f64], sum: &mut Actions);

    /// The times at which it enters and leaves the beam.
    fn kinks(&self) -> [f64; 2];

    /// Number of points, and bytes of its tables.
    fn size(&self) -> (usize, usize);
}
