//! Loads whose place moves with time.

use super::{Actions, Kind};

/// A load whose place on its beam follows time.
pub trait MovingLoad: Send + Sync {
    /// What it is.
    fn kind(&self) -> Kind;

    /// Index of the beam.
    fn beam(&self) -> usize;

    /// `f += factor ·` its generalised force, which is that of a density of negative work.
    fn add_force(&self, factor: f64, time: f64, f: &mut [f64]);

    /// Adds mean and first moment of the force from `start` to `end`
    /// ([`crate::law::Law::moments`]).
    fn add_moments(&self, start: f64, end: f64, moments: [&mut [f64]; 2]);

    /// What it does to its beam in the state `q`.
    fn add_actions(&self, time: f64, q: &[f64], sum: &mut Actions);

    /// When it comes and goes.
    fn kinks(&self) -> [f64; 2];

    /// Points, and bytes of its tables.
    fn size(&self) -> (usize, usize);
}
