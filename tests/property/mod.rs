//! What must hold at every state: derivatives, invariances, exactness.

mod absence;
mod agreement;
mod basis;
mod derivatives;
mod dynamics;
pub mod generators;
mod inextensible;
mod invariance;
mod linear;
mod modal;
mod parts;
mod scene;
mod supports;
mod turning;

use proptest::test_runner::{Config, FileFailurePersistence};

/// So many random cases; what once failed is kept beside the test and tried again first.
pub fn cases(count: u32) -> Config {
    let beside = FileFailurePersistence::WithSource("regressions");
    Config { cases: count, failure_persistence: Some(Box::new(beside)), ..Config::default() }
}
