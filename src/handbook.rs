//! What a user should know, by subject.
//!
//! | page | subject |
//! |---|---|
//! | [`sections`] | stiffness, mass and shape of sections, varying along a beam; layers; stresses; the shape at the start |
//! | [`motion`] | duration, integrators, tolerances, events, going on from a state |
//! | [`stages`] | analyses one after the other: what comes, what goes, prestress, assembly |
//! | [`mechanisms`] | joints, supports that move, and everything else that takes part |
//! | [`choosing`] | which discretisation and which integrator for which purpose, with what they reach |
//! | [`hard`] | what happens when it gets hard: turns, limit points, stiff beams, obstacles |
//! | [`studies`] | many runs of one scene, and what a digit costs |
//! | [`python`] | the module `ancf` of Python: scenes, results as arrays, control in the loop, forces of one's own, many machines |
//!
//! The theory stands on the [front page](crate): the densities, the discretisations and where each
//! is computed.

#[doc = include_str!("handbook/sections.md")]
pub mod sections {}

#[doc = include_str!("handbook/motion.md")]
pub mod motion {}

#[doc = include_str!("handbook/stages.md")]
pub mod stages {}

#[doc = include_str!("handbook/mechanisms.md")]
pub mod mechanisms {}

#[doc = include_str!("handbook/choosing.md")]
pub mod choosing {}

#[doc = include_str!("handbook/hard.md")]
pub mod hard {}

#[doc = include_str!("handbook/studies.md")]
pub mod studies {}

#[doc = include_str!("handbook/python.md")]
pub mod python {}
