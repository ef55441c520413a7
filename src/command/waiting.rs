//! What is waited for that is not ours: it is named when it takes long, and a driver is not waited
//! for without end.

use std::fs;
use std::path::Path;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use crate::exit;

/// How long a wait is before it is named.
const LONG: Duration = Duration::from_secs(2);

/// A wait; it ends when this is dropped.
pub(crate) struct Waiting {
    _ended: Option<Sender<()>>,
}

impl Waiting {
    /// For what `path` is to hold, if it is a pipe or a device: it is waited for until it comes, or
    /// the program is interrupted. A file is not waited for.
    pub(crate) fn for_input(path: &Path) -> Option<Waiting> {
        let is_file = fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
        let what = || format!("for {} to be written", path.display());
        (!is_file).then(|| Waiting::begin(what(), None))
    }

    /// For an OpenGL driver that is to do something with pictures of `size` × `size` pixels.
    pub(crate) fn for_driver(size: u32) -> Waiting {
        // A processor of today draws ten pixels in a microsecond.
        let work = Duration::from_micros(u64::from(size) * u64::from(size));
        Waiting::begin(
            "for the OpenGL driver".to_owned(),
            Some(Duration::from_secs(20) + work),
        )
    }

    /// Says that it waits `what`, and ends the program after the time of `limit`.
    fn begin(what: String, limit: Option<Duration>) -> Waiting {
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
        // Where the system has no thread for it, nobody watches.
        let watching = thread::Builder::new().stack_size(1 << 16).spawn(watch);
        Waiting {
            _ended: watching.is_ok().then_some(ended),
        }
    }
}
