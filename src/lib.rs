//! Planar flexible beams.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
pub mod basis;
pub mod centreline;
pub mod effect;
pub mod linear;
pub mod model;
pub mod run;
pub mod solve;
pub mod system;
pub mod trajectory;
