//! How the program exits early: out of memory, on a panic, on a signal. It prints one line at most,
//! leaves no unfinished file and no program running, and returns to no caller.

mod allocator;
#[cfg(unix)]
mod signals;

use std::backtrace::{Backtrace, BacktraceStatus};
use std::cell::Cell;
use std::hint;
use std::io::{self, Write as _};
use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use firsthit::image::abandon_unfinished;
use firsthit::panics;
use firsthit::program;

pub(crate) use allocator::Allocator;

/// Handles signals and panics from now on.
pub(crate) fn install_handlers() {
    panic::set_hook(Box::new(fault));
    #[cfg(unix)]
    signals::watch();
}

/// The stack that the main thread needs: its largest frame has 120 KiB.
const STACK: usize = 1 << 19;

/// Takes the main thread's stack before anything else takes the memory. It grows as it is used, and
/// where the system has no memory for that, it ends the program without a word.
#[inline(never)]
pub(crate) fn take_stack() {
    hint::black_box([0_u8; STACK]);
}

/// Exits with status 1.
pub(crate) fn now() -> ! {
    leave_nothing();
    // Other threads, drivers' among them, are not waited for, and no exit handler runs: any of them
    // might hang.
    #[cfg(unix)]
    signal_hook::low_level::exit(1);
    #[cfg(not(unix))]
    #[expect(clippy::exit, reason = "the only way from any thread")]
    std::process::exit(1);
}

/// Removes every unfinished file, and ends every program that makes pictures, for an exit that is
/// about to come.
fn leave_nothing() {
    abandon_unfinished();
    program::end_all();
}

/// Lets one thread exit, and blocks every other one that tries, so that no second line is printed.
fn claim() {
    static CLAIMED: AtomicBool = AtomicBool::new(false);
    thread_local! {
        static HERE: Cell<bool> = const { Cell::new(false) };
    }
    // The thread that exits may run out of memory while it prints: it says so instead.
    if HERE.replace(true) {
        return;
    }
    while CLAIMED.swap(true, Ordering::Relaxed) {
        thread::sleep(Duration::from_secs(1));
    }
}

/// The panic hook: a panic that nobody catches is one line, and a backtrace if RUST_BACKTRACE asks
/// for it.
fn fault(panic: &PanicHookInfo<'_>) {
    if panics::is_caught() {
        return;
    }
    claim();
    let words = panics::words(panic.payload());
    // The standard library panics where a new thread is refused the memory for its signals.
    if words.contains("(os error 12)") {
        crate::command::say(&format!("not enough memory: {words}"));
        now();
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
    now();
}
