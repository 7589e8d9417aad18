//! Tests of the whole: properties, validation against reference data, regression snapshots, files
//! of results, the command line.

mod accuracy;
mod cli;
mod hard;
mod layout;
mod output;
mod property;
mod regress;
mod validate;
mod values;
