//! The memory and the threads that an OpenGL driver takes for granted: where the system refuses
//! them, drivers crash, or wait for ever.

use std::sync::mpsc;
use std::thread::{self, Builder};

use super::ScreenError;

/// More than Mesa's software renderer maps to begin with, LLVM and the heaps of its threads
/// included: at least 760 MB were needed.
#[cfg(target_os = "linux")]
const ADDRESSES: u64 = 1 << 30;

/// More than the copies of a picture that a driver may make, 16 bytes a pixel each.
#[cfg(target_os = "linux")]
const BYTES_A_PIXEL: u64 = 64;

/// Mesa's software renderer starts a thread a core, but not more than this, and some for its
/// caches.
const MOST_RENDERERS: usize = 32;
const OTHER_THREADS: usize = 4;

/// Checks that the system grants what a driver will ask for, for pictures of so many pixels.
///
/// # Errors
/// [`ScreenError::Addresses`] and [`ScreenError::Threads`] where it is refused.
pub(crate) fn check(pixels: u64) -> Result<(), ScreenError> {
    #[cfg(target_os = "linux")]
    addresses(pixels)?;
    let _ = pixels;
    threads().map_err(ScreenError::Threads)
}

/// Checks the address space, which nothing but `ulimit -v` limits.
#[cfg(target_os = "linux")]
fn addresses(pixels: u64) -> Result<(), ScreenError> {
    use rustix::process::{Resource, getrlimit};

    let Some(limit) = getrlimit(Resource::As).current else {
        return Ok(());
    };
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mapped = status
        .lines()
        .find_map(|line| line.strip_prefix("VmSize:")?.split_whitespace().next());
    let kib: u64 = mapped.and_then(|kib| kib.parse().ok()).unwrap_or(0);
    let left = limit.saturating_sub(kib << 10);
    let needed = ADDRESSES + BYTES_A_PIXEL * pixels;
    if left < needed {
        return Err(ScreenError::Addresses {
            left: left >> 20,
            needed: needed >> 20,
        });
    }
    Ok(())
}

/// Checks that as many threads as a driver starts can run at the same time.
fn threads() -> std::io::Result<()> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let mut started = Vec::new();
    for _ in 0..cores.min(MOST_RENDERERS) + OTHER_THREADS {
        let (end, wait) = mpsc::channel::<()>();
        // Each thread waits until its sender is dropped.
        let thread = Builder::new()
            .stack_size(1 << 16)
            .spawn(move || wait.iter().count())?;
        started.push((end, thread));
    }
    for (end, thread) in started {
        drop(end);
        // The threads do nothing that could fail.
        let _ = thread.join();
    }
    Ok(())
}
