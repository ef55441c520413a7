//! A running program: its first process, and whatever processes that has started in its group.

use std::io;
use std::process::{Child, Command, ExitStatus};
use std::thread;
use std::time::{Duration, Instant};

use super::held;

/// How long to sleep between two looks at a process.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// The group. Dropped, it is ended.
pub(super) struct Group {
    child: Child,
}

impl Group {
    pub(super) fn start(command: &mut Command) -> io::Result<Group> {
        let child = held::start(command)?;
        Ok(Group { child })
    }

    /// The first process, to take its pipes.
    pub(super) fn first(&mut self) -> &mut Child {
        &mut self.child
    }

    /// Whether the first process has ended.
    pub(super) fn has_ended(&mut self) -> bool {
        #[cfg(unix)]
        {
            use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
            // The process keeps its number, which is that of the group.
            let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
            let first = WaitId::Pid(Pid::from_child(&self.child));
            !matches!(waitid(first, options), Ok(None))
        }
        #[cfg(not(unix))]
        !matches!(self.child.try_wait(), Ok(None))
    }

    /// Waits until the first process has ended, or until `deadline`. Whether it has ended.
    pub(super) fn has_ended_by(&mut self, deadline: Instant) -> bool {
        while !self.has_ended() {
            if Instant::now() >= deadline {
                return false;
            }
            thread::sleep(POLL_INTERVAL);
        }
        true
    }

    /// Ends every process of the group; how the first one ended.
    pub(super) fn end(&mut self) -> ExitStatus {
        held::end(&mut self.child);
        // It was waited for elsewhere only where this process ignores its children.
        self.child.wait().unwrap_or_default()
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        self.end();
    }
}
