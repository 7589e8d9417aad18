//! What must hold at every state: derivatives, invariances, exactness.

mod absence;
mod agreement;
mod balances;
mod basis;
mod breaks;
mod buoyancy;
mod contact;
mod derivatives;
mod dynamics;
mod events;
mod frames;
mod friction;
pub mod generators;
mod inextensible;
mod invariance;
mod laws;
mod linear;
mod modal;
mod parts;
mod restart;
mod scene;
mod section_forces;
mod stability;
mod supports;
mod turning;
mod weld;
mod winding;

use proptest::test_runner::{Config, FileFailurePersistence};

/// So many random cases; what once failed is kept beside the test and tried again first.
pub fn cases(count: u32) -> Config {
    let beside = FileFailurePersistence::WithSource("regressions");
    Config { cases: count, failure_persistence: Some(Box::new(beside)), ..Config::default() }
}
