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
    /// Tasks that all have to be done, in this order.
    queue: VecDeque<Task>,
    /// Queued tasks that are not done yet, the one that is being worked on included.
    unfinished: usize,
    /// The latest request, if it has not begun.
    request: Option<Task>,
    closed: bool,
}

impl<Task> Inbox<Task> {
    fn lock(&self) -> MutexGuard<'_, Tasks<Task>> {
        // No code that holds the lock can panic halfway.
        self.tasks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next task, waited for, and whether it was queued; `None` once there will be no more.
    fn next(&self) -> Option<(Task, bool)> {
        let mut tasks = self.lock();
        loop {
            if let Some(task) = tasks.queue.pop_front() {
                return Some((task, true));
            }
            if tasks.closed {
                return None;
            }
            if let Some(task) = tasks.request.take() {
                return Some((task, false));
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
                queue: VecDeque::new(),
                unfinished: 0,
                request: None,
                closed: false,
            }),
            changed: Condvar::new(),
        });
        let (sender, replies) = mpsc::channel();
        let theirs = inbox.clone();
        let thread = thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                while let Some((task, is_queued)) = theirs.next() {
                    work(task, &mut |reply| {
                        // Nobody listens once the window is closed.
                        let _ = sender.send(reply);
                        wake();
                    });
                    theirs.lock().unfinished -= usize::from(is_queued);
                }
            })?;
        Ok(Worker {
            inbox,
            replies,
            thread,
        })
    }

    /// Requests `task`, instead of the last request if that has not begun.
    pub(super) fn request(&self, task: Task) {
        self.inbox.lock().request = Some(task);
        self.inbox.changed.notify_one();
    }

    /// Queues `task`: it is done before any request, after the tasks queued before it, and also
    /// when the window closes.
    pub(super) fn enqueue(&self, task: Task) {
        let mut tasks = self.inbox.lock();
        tasks.queue.push_back(task);
        tasks.unfinished += 1;
        self.inbox.changed.notify_one();
    }

    /// The next answer, if there is one.
    pub(super) fn reply(&self) -> Option<Reply> {
        self.replies.try_recv().ok()
    }

    /// Waits for the queued tasks, but for no request, and gives the last answers.
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
    fn of_requests_only_the_last_is_done_and_queued_tasks_come_first() {
        let (worker, go, wakes) = slow();
        worker.request(1);
        // Until the first one is begun.
        while worker.inbox.lock().request.is_some() {
            thread::yield_now();
        }
        worker.request(2);
        worker.request(3);
        worker.enqueue(10);
        worker.enqueue(11);
        assert_eq!(worker.reply(), None);
        for expected in [1, 10, 11, 3] {
            go.send(()).unwrap();
            wakes.recv().unwrap();
            assert_eq!(worker.reply(), Some(expected));
        }
    }

    #[test]
    fn closing_waits_for_queued_tasks_and_for_no_request() {
        let (worker, go, _) = slow();
        worker.enqueue(10);
        worker.enqueue(11);
        worker.request(1);
        for _ in 0..3 {
            go.send(()).unwrap();
        }
        assert_eq!(worker.finish(), [10, 11]);

        let (worker, _go, _) = slow();
        worker.request(1);
        assert!(worker.finish().is_empty(), "it would never end");
    }
}
