//! Tests of the whole: properties, validation against reference data, regression snapshots, the
//! command line.

mod cli;
mod hard;
mod layout;
mod property;
mod regress;
mod validate;
mod values;
