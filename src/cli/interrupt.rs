//! Ctrl-C: once to end a run after its current step, twice to end the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::terminal;

/// What shells report of a program that SIGINT ended.
const INTERRUPTED: i32 = 130;

/// Whether the user wants the run to end, from now on.
pub fn listen() -> Arc<AtomicBool> {
    let wanted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&wanted);
    let handler = move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
        terminal::note("interrupted: the run ends after this step; press Ctrl-C again to end it at once");
    };
    // Without a handler Ctrl-C ends the program at once, which is no reason not to run.
    let _ = ctrlc::set_handler(handler);
    wanted
}
