//! Ctrl-C, or another request to end, such as a batch queue's before its time is over. The first
//! ends the computation after the step, or the runs, in progress; the second ends the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::terminal;

/// Exit status that shells report for a program ended by SIGINT.
const INTERRUPTED: i32 = 130;

/// A flag that is set when the user wants to end; `then` says what happens at the first Ctrl-C.
pub fn listen(then: &'static str) -> Arc<AtomicBool> {
    let wanted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&wanted);
    let handler = move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
        terminal::note(&format!("interrupted: {then}; press Ctrl-C again to end it at once"));
    };
    // Without a handler Ctrl-C ends the program at once, which is no reason not to run.
    let _ = ctrlc::set_handler(handler);
    wanted
}
