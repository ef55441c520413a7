//! A lock with a timeout, for a program that is about to end while another thread may hold it.

use std::sync::{Mutex, MutexGuard, TryLockError};
use std::thread;
use std::time::Duration;

/// How many milliseconds the thread that holds the lock may take.
const TIMEOUT_MS: u32 = 1000;

/// Locks `mutex`, if that is free within a second: the thread that holds it may be this one, which
/// has run out of memory.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    (0..TIMEOUT_MS).find_map(|_| match mutex.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(guard)) => Some(guard.into_inner()),
        Err(TryLockError::WouldBlock) => {
            thread::sleep(Duration::from_millis(1));
            None
        }
    })
}
