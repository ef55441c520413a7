//! How the program ends before its time: for want of memory, through a fault, on a signal. It says
//! one line at most, leaves no file that is not whole, and comes back to nobody.

mod memory;
#[cfg(unix)]
mod signals;

use std::backtrace::{Backtrace, BacktraceStatus};
use std::cell::Cell;
use std::io::{self, Write as _};
use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use firsthit::fault;
use firsthit::image::abandon_unfinished;

pub(crate) use memory::Memory;

/// Sees to signals and faults from now on.
pub(crate) fn prepare() {
    panic::set_hook(Box::new(fault));
    #[cfg(unix)]
    signals::watch();
}

/// Ends the program, with status 1.
pub(crate) fn at_once() -> ! {
    abandon_unfinished();
    // What other threads do, drivers' among them, is not waited for, and no code of theirs is run:
    // any of it might hang.
    #[cfg(unix)]
    signal_hook::low_level::exit(1);
    #[cfg(not(unix))]
    #[expect(clippy::exit, reason = "the only way from any thread")]
    std::process::exit(1);
}

/// Waits for ever where another thread ends the program already, so that no second line is said.
fn only_once() {
    static ENDING: AtomicBool = AtomicBool::new(false);
    thread_local! {
        static HERE: Cell<bool> = const { Cell::new(false) };
    }
    // A thread that finds no memory for its line says that instead.
    if HERE.replace(true) {
        return;
    }
    while ENDING.swap(true, Ordering::Relaxed) {
        thread::sleep(Duration::from_secs(1));
    }
}

/// What happens on a panic that nobody catches: a line, and the way there if RUST_BACKTRACE asks
/// for it.
fn fault(panic: &PanicHookInfo<'_>) {
    if fault::is_caught() {
        return;
    }
    only_once();
    let words = fault::words(panic.payload());
    // The standard library panics where a new thread is refused the memory for its signals.
    if words.contains("(os error 12)") {
        crate::command::say(&format!("not enough memory: {words}"));
        at_once();
    }
    let place = panic
        .location()
        .map_or_else(String::new, |place| format!(" at {place}"));
    let version = env!("CARGO_PKG_VERSION");
    crate::command::say(&format!(
        "a fault of version {version}{place}: {words}: please report this line, and what led to it"
    ));
    let backtrace = Backtrace::capture();
    if backtrace.status() == BacktraceStatus::Captured {
        let _ = write!(io::stderr(), "{backtrace}");
    }
    at_once();
}
