//! A thread that works for the window, so that the window answers however long the work takes.

use std::collections::VecDeque;
use std::io;
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// How long a worker has nothing to do after a task before it is idle.
const IDLE: Duration = Duration::from_millis(200);

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

/// What a worker does next.
enum Next<Task> {
    Queued(Task),
    Requested(Task),
    /// There has been nothing to do for a while.
    Idle,
    /// There will be no more.
    Nothing,
}

impl<Task> Inbox<Task> {
    fn lock(&self) -> MutexGuard<'_, Tasks<Task>> {
        // No code that holds the lock can panic halfway.
        self.tasks.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What there is to do next, waited for. A worker that `has_worked` may have become idle.
    fn next(&self, has_worked: bool) -> Next<Task> {
        let mut tasks = self.lock();
        let mut idle = false;
        loop {
            if let Some(task) = tasks.queue.pop_front() {
                return Next::Queued(task);
            }
            if tasks.closed {
                return Next::Nothing;
            }
            if let Some(task) = tasks.request.take() {
                return Next::Requested(task);
            }
            if idle {
                return Next::Idle;
            }
            if has_worked {
                let waited = self.changed.wait_timeout(tasks, IDLE);
                let (woken, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
                (tasks, idle) = (woken, timeout.timed_out());
            } else {
                let waited = self.changed.wait(tasks);
                tasks = waited.unwrap_or_else(PoisonError::into_inner);
            }
        }
    }
}

impl<Task: Send + 'static, Reply: Send + 'static> Worker<Task, Reply> {
    /// Starts it. `work` does a task and may answer as often as it likes; after each answer `wake`
    /// is called, on the worker's thread. Once there has been nothing to do for a while after a
    /// task, `work` is called without one.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub(super) fn start(
        name: &str,
        wake: impl Fn() + Send + 'static,
        mut work: impl FnMut(Option<Task>, &mut dyn FnMut(Reply)) + Send + 'static,
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
                let mut has_worked = false;
                loop {
                    let (task, is_queued) = match theirs.next(has_worked) {
                        Next::Queued(task) => (Some(task), true),
                        Next::Requested(task) => (Some(task), false),
                        Next::Idle => (None, false),
                        Next::Nothing => return,
                    };
                    has_worked = task.is_some();
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
                if let Some(task) = task {
                    let _ = wait.recv();
                    reply(task);
                }
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
    fn a_worker_is_idle_once_after_its_last_task() {
        let worker = Worker::start("test", || {}, |task, reply| reply(task)).unwrap();
        let answered = |most: Duration| {
            let reply = worker.replies.recv_timeout(most);
            reply.ok()
        };
        assert_eq!(answered(3 * IDLE), None, "it has done nothing yet");
        for task in 0..3 {
            worker.request(task);
            assert_eq!(answered(10 * IDLE), Some(Some(task)));
        }
        assert_eq!(answered(10 * IDLE), Some(None));
        assert_eq!(answered(3 * IDLE), None);
        worker.enqueue(3);
        assert_eq!(answered(10 * IDLE), Some(Some(3)));
        assert_eq!(answered(10 * IDLE), Some(None));
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
