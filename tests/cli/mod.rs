//! The program as its users meet it: commands, exit statuses, messages, files.

mod accuracy;
pub(crate) mod commands;
mod cost;
mod documents;
mod hygiene;
mod interrupt;
mod messages;
mod motion;
mod output;
mod sweep;
