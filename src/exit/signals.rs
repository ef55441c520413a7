//! Signals that would leave an unfinished file or another program behind, or end the program
//! without a message.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{self, Sender};
use std::thread;

use signal_hook::consts::{SIGABRT, SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

/// Handles signals from now on.
pub(super) fn watch() {
    // A file that grows beyond its limit then fails to be written, as with any other error.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    // The C library prints a line and aborts where it lacks memory for something that cannot fail:
    // the exit status is then that of every failure.
    let always = Arc::new(AtomicBool::new(true));
    let _ = signal_hook::flag::register_conditional_shutdown(SIGABRT, 1, always);
    // The thread itself registers the signals: where there is no thread for it, they keep their
    // default actions. No file or program is begun before they are registered.
    let (registered, is_registered) = mpsc::channel();
    let watching = thread::Builder::new()
        .name("signals".to_owned())
        .stack_size(1 << 16)
        .spawn(move || wait(registered));
    if watching.is_ok() {
        let _ = is_registered.recv();
    }
}

/// Waits for a signal that ends the program, and then lets its default action do so. `registered`
/// is dropped once the signals are registered.
fn wait(registered: Sender<()>) {
    let ignored = ignored();
    let ends = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let Ok(mut signals) = Signals::new(ends.filter(|signal| ignored >> (signal - 1) & 1 == 0))
    else {
        return;
    };
    drop(registered);
    if let Some(signal) = signals.forever().next() {
        super::leave_nothing();
        let _ = emulate_default_handler(signal);
    }
}

/// The signals that the parent process has set to be ignored, as nohup does: signal n is bit n − 1.
fn ignored() -> u64 {
    // Where the system does not say, none is ignored.
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}
