//! What verification needs besides pure Rust: Python, and in it the codes that ours is compared
//! with.
//!
//! ```text
//! scene.toml ──► Model + Analysis ─┬─► ancf::run                                 ─► results
//!                                  └─► Description ─json─► peers/exudyn_scene.py ─► the same
//! ```
//!
//! | module | subject |
//! |---|---|
//! | [`python`] | the environment with pinned packages under `target/`, and scripts as processes |
//! | [`bridge`] | the same Python inside this process: scripts loaded once, JSON in, JSON out |
//! | [`peers`] | a scene in the words of another code, and its answer |
//! | [`work`] | what accuracy costs, ours and another code's |
//!
//! Nothing outside this package links Python. Where Python or a package is missing, whatever asks
//! for it fails and says what to install; nothing is skipped.
#![warn(missing_docs)]

pub mod bridge;
pub mod peers;
pub mod python;
pub mod work;

/// What ends a command.
pub type Failure = Box<dyn std::error::Error>;
