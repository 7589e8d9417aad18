//! Do the tests catch faults? A *mutant* is one small fault put into the sources. It is *caught*
//! where a test fails or does not come to its end, *missed* where all tests pass, *unviable* where
//! it does not compile.
//!
//! A build per mutant takes minutes. Here all mutants of a sample stand in one copy of the sources,
//! each behind a switch that an environment variable turns at run time, and the copy is built once:
//!
//! ```text
//! a - b   ─►   (if crate::mutant_switch::on(17) { (a) + (b) } else { a - b })
//! ```
//!
//! | module | subject |
//! |---|---|
//! | [`find`] | the mutants of a source file |
//! | [`values`] | what the body of a function is replaced by |
//! | [`splice`] | a source file with switches, and which mutant a compiler's message is about |
//! | [`sample`] | some mutants of each folder, spread over its sources |
//! | [`copy`] | a copy of the repository |
//! | [`build`] | the copy built, without the mutants that do not compile |
//! | [`trial`] | which tests reach which mutants, and which fail |
//! | [`record`], [`reasons`] | `verification/mutants.toml`: counts, survivors and why they survive |
#![warn(missing_docs)]

pub mod build;
pub mod copy;
pub mod find;
pub mod reasons;
pub mod record;
pub mod sample;
pub mod splice;
pub mod trial;
pub mod values;

/// What ends the program.
pub type Failure = Box<dyn std::error::Error>;
