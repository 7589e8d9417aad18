//! Solvers. Each asks the system for forces, tangents, supports and constraints, and knows neither
//! discretisation nor effect.

pub mod buckling;
pub mod dynamics;
pub mod eigen;
pub mod equilibrium;
pub mod modal;
pub mod newton;
pub mod path;
mod record;
pub mod relax;
pub mod resume;
pub mod retraction;
pub mod stability;
pub mod statics;
mod work;

pub use record::{ContactImpulse, RecordedState, RecordedStates, Statistics, StepRecord, TakenUp};
pub use work::Work;
