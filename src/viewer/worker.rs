//! A thread that works for the window, so that the window answers however long the work takes.

use std::collections::VecDeque;
use std::io;
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// The thread, seen from the window's side.
pub(super) struct Worker<Task, Reply> {
    inbox: Arc<Inbox<Task>>,
    replies: Receiver<Reply>,
    thread: JoinHandle<()>,
}

struct Inbox<Task> {
    tasks: Mutex<Tasks<Task>>,
    changed: Condvar,
}

struct Tasks<Task> {
    /// What has to be done, in this order.
    errands: VecDeque<Task>,
    /// Errands that are not done yet, the one that is being worked on included.
    unfinished: usize,
    /// What is to be shown next: only what was wished for last.
    wish: Option<Task>,
    closed: bool,
}

impl<Task> Inbox<Task> {
    fn lock(&self) -> MutexGuard<'_, Tasks<Task>> {
        // No code that holds the lock can panic halfway.
        self.tasks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next task, waited for, and whether it is an errand; `None` once there will be no more.
    fn next(&self) -> Option<(Task, bool)> {
        let mut tasks = self.lock();
        loop {
            if let Some(errand) = tasks.errands.pop_front() {
                return Some((errand, true));
            }
            if tasks.closed {
                return None;
            }
            if let Some(wish) = tasks.wish.take() {
                return Some((wish, false));
            }
            tasks = self
                .changed
                .wait(tasks)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl<Task: Send + 'static, Reply: Send + 'static> Worker<Task, Reply> {
    /// Starts it. `work` does a task and may answer as often as it likes; after each answer `wake`
    /// is called, on the worker's thread.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        name: &str,
        wake: impl Fn() + Send + 'static,
        mut work: impl FnMut(Task, &mut dyn FnMut(Reply)) + Send + 'static,
    ) -> io::Result<Worker<Task, Reply>> {
        let inbox = Arc::new(Inbox {
            tasks: Mutex::new(Tasks {
                errands: VecDeque::new(),
                unfinished: 0,
                wish: None,
                closed: false,
            }),
            changed: Condvar::new(),
        });
        let (sender, replies) = mpsc::channel();
        let theirs = inbox.clone();
        let thread = thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                while let Some((task, errand)) = theirs.next() {
                    work(task, &mut |reply| {
                        // Nobody listens once the window is closed.
                        let _ = sender.send(reply);
                        wake();
                    });
                    theirs.lock().unfinished -= usize::from(errand);
                }
            })?;
        Ok(Worker {
            inbox,
            replies,
            thread,
        })
    }

    /// Wishes for `task`; a wish that is not begun yet is forgotten.
    pub(super) fn wish(&self, task: Task) {
        self.inbox.lock().wish = Some(task);
        self.inbox.changed.notify_one();
    }

    /// Sends the worker on an errand: it is done before any wish, after the errands before it, and
    /// also when the window closes.
    pub(super) fn send(&self, errand: Task) {
        let mut tasks = self.inbox.lock();
        tasks.errands.push_back(errand);
        tasks.unfinished += 1;
        self.inbox.changed.notify_one();
    }

    /// The next answer, if there is one.
    pub(super) fn reply(&self) -> Option<Reply> {
        self.replies.try_recv().ok()
    }

    /// Waits for the errands, but for no wish, and gives the last answers.
    pub(super) fn finish(self) -> Vec<Reply> {
        let unfinished = {
            let mut tasks = self.inbox.lock();
            tasks.closed = true;
            self.inbox.changed.notify_one();
            tasks.unfinished > 0
        };
        if unfinished {
            let _ = self.thread.join();
        }
        self.replies.try_iter().collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;
    use std::sync::mpsc::Sender;

    /// A worker that answers with its task once it is let go on, and the word that lets it.
    fn slow() -> (Worker<u32, u32>, Sender<()>, Receiver<()>) {
        let (go, wait) = mpsc::channel();
        let (woken, wakes) = mpsc::channel();
        let worker = Worker::start(
            "test",
            move || {
                let _ = woken.send(());
            },
            move |task, reply| {
                let _ = wait.recv();
                reply(task);
            },
        );
        (worker.unwrap(), go, wakes)
    }

    #[test]
    fn of_wishes_only_the_last_is_done_and_errands_come_first() {
        let (worker, go, wakes) = slow();
        worker.wish(1);
        // Until the first one is begun.
        while worker.inbox.lock().wish.is_some() {
            thread::yield_now();
        }
        worker.wish(2);
        worker.wish(3);
        worker.send(10);
        worker.send(11);
        assert_eq!(worker.reply(), None);
        for expected in [1, 10, 11, 3] {
            go.send(()).unwrap();
            wakes.recv().unwrap();
            assert_eq!(worker.reply(), Some(expected));
        }
    }

    #[test]
    fn closing_waits_for_errands_and_for_no_wish() {
        let (worker, go, _) = slow();
        worker.send(10);
        worker.send(11);
        worker.wish(1);
        for _ in 0..3 {
            go.send(()).unwrap();
        }
        assert_eq!(worker.finish(), [10, 11]);

        let (worker, _go, _) = slow();
        worker.wish(1);
        assert!(worker.finish().is_empty(), "it would never end");
    }
}
