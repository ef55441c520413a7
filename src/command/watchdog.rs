//! A watchdog over calls that may hang: it names what takes long, and gives up a driver that never
//! returns.

use std::fs;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use crate::exit;

/// How long a call takes before the watchdog names it.
const LONG: Duration = Duration::from_secs(2);

/// A thread that watches a call until this is dropped.
pub(crate) struct Watchdog {
    _ended: Option<Sender<()>>,
}

impl Watchdog {
    /// Watches the reading of `path` if that is a pipe or a device, for any time: its writer
    /// decides. A file needs no watchdog.
    pub(crate) fn for_input(path: &Path) -> Option<Watchdog> {
        let is_file = fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
        let what = || format!("for {} to be written", path.display());
        (!is_file).then(|| Watchdog::begin(what(), None))
    }

    /// Watches a call of an OpenGL driver with pictures of `width` × `height` pixels.
    pub(crate) fn for_driver(width: u32, height: u32) -> Watchdog {
        // A processor of today draws ten pixels in a microsecond.
        let work = Duration::from_micros(u64::from(width) * u64::from(height));
        Watchdog::begin(
            "for the OpenGL driver".to_owned(),
            Some(Duration::from_secs(20) + work),
        )
    }

    /// Says after a while that the program waits `what`, and exits after `limit`.
    fn begin(what: String, limit: Option<Duration>) -> Watchdog {
        let (ended, end) = mpsc::channel::<()>();
        let watch = move || {
            if end.recv_timeout(LONG) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            super::say(&format!("waits {what}: Ctrl+C ends it"));
            let Some(limit) = limit else { return };
            if end.recv_timeout(limit - LONG) == Err(RecvTimeoutError::Timeout) {
                super::say(&format!(
                    "waited {what}, and gave up after {} s: try another driver, or `firsthit capture --through none`, which needs no OpenGL",
                    limit.as_secs()
                ));
                exit::now();
            }
        };
        // Where the system has no thread left, there is no watchdog.
        let watching = thread::Builder::new().stack_size(1 << 16).spawn(watch);
        Watchdog {
            _ended: watching.is_ok().then_some(ended),
        }
    }
}
