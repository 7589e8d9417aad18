//! What must hold at every state: derivatives, invariances, exactness.

mod absence;
mod acting;
mod agreement;
mod arm;
mod balances;
mod basis;
mod breaks;
mod buckling;
mod buoyancy;
mod contact;
mod curves;
mod derivatives;
mod driven;
mod dynamics;
mod events;
mod frames;
mod friction;
pub mod generators;
mod held;
mod inextensible;
mod invariance;
mod joints;
mod laws;
mod linear;
mod modal;
mod newton;
mod parts;
mod restart;
mod rows;
mod scene;
mod section_forces;
mod stability;
mod steps;
mod strings;
mod supports;
mod surfaces;
mod threads;
mod turning;
mod weld;
mod winding;

use proptest::test_runner::{Config, FileFailurePersistence, RngSeed};

/// So many cases, the same in every run: what a change breaks must not depend on luck. The nightly
/// run draws others, by `PROPTEST_RNG_SEED`. What once failed is kept beside the test and tried
/// again first.
pub fn cases(count: u32) -> Config {
    let beside = FileFailurePersistence::WithSource("regressions");
    let default = Config::default();
    let rng_seed = match default.rng_seed {
        RngSeed::Random => RngSeed::Fixed(2018),
        given => given,
    };
    Config { cases: count, rng_seed, failure_persistence: Some(Box::new(beside)), ..default }
}
