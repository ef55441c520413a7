//! Signals that would leave a file behind, or end the program without a word.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{self, Sender};
use std::thread;

use firsthit::image::abandon_unfinished;
use signal_hook::consts::{SIGABRT, SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

/// Sees to signals from now on.
pub(super) fn watch() {
    // A file that grows beyond what is allowed is an error of the write then, which is told as any
    // other.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    // C's library aborts, after a line, where it is refused memory that it has no error for: the
    // status is then that of every failure.
    let always = Arc::new(AtomicBool::new(true));
    let _ = signal_hook::flag::register_conditional_shutdown(SIGABRT, 1, always);
    // It registers itself what it waits for: where there is no thread for it, signals end the
    // program as they do any. Before that no file is begun.
    let (registered, is_registered) = mpsc::channel();
    let watching = thread::Builder::new()
        .name("signals".to_owned())
        .stack_size(1 << 16)
        .spawn(move || wait(registered));
    if watching.is_ok() {
        let _ = is_registered.recv();
    }
}

/// Waits for a signal to end on, and ends as the signal does it. `registered` is dropped once
/// signals come here.
fn wait(registered: Sender<()>) {
    let ignored = ignored();
    let ends = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let Ok(mut signals) = Signals::new(ends.filter(|signal| ignored >> (signal - 1) & 1 == 0))
    else {
        return;
    };
    drop(registered);
    if let Some(signal) = signals.forever().next() {
        abandon_unfinished();
        let _ = emulate_default_handler(signal);
    }
}

/// The signals that whoever started the program wants to be ignored, as nohup does: a bit for each,
/// the lowest for the first.
fn ignored() -> u64 {
    // Where the system does not tell, none is.
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}
