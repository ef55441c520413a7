//! Threads that share the bands of a frame, for as long as the tracer lives.
//!
//! A frame takes tenths of a millisecond, so handing it out must take microseconds: bands are
//! claimed from counters, the caller claims too, and the frame is finished when its *bands* are. A
//! worker that the system has put aside before its first band is not waited for. Each thread has a
//! counter of its own, for bands next to each other that are its own in every frame, since their
//! memory lies in its cache; when they are gone it helps the others. Threads that wait look for a
//! while before they sleep; between frames that follow each other at once, none does, and the
//! system is not called.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr;
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release, SeqCst};
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicUsize};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle, Thread};
use std::time::{Duration, Instant};

use crate::number::Expression;

/// The most threads of a pool. With four times as many the memory maps of a process run out on
/// Linux, and where a new thread finds none for its signal stack, the standard library ends the
/// process.
const MAX_THREADS: usize = 4096;

/// How long a thread looks for what it waits for before it sleeps: a little longer than a small
/// frame needs on one thread before its first band, or after its last.
const SPIN_TIME: Duration = Duration::from_micros(100);

/// Some threads, of which the caller's is one.
pub(crate) struct Pool {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
}

/// What the bands of a frame are for.
struct Job<'w> {
    /// Called with the number of the thread and that of the band.
    work: &'w (dyn Fn(usize, usize) + Sync),
    bands: usize,
}

/// What the threads know of each other.
struct Shared {
    /// For each thread, how many of the bands that it is to begin with no thread has claimed; the
    /// last ones go first.
    unclaimed: Vec<Counter>,
    /// Bands of the job that are not finished: those, and the claimed ones that somebody works at.
    unfinished: Counter,
    /// The job, on the stack of the caller. To be touched only between claiming a band and
    /// reporting it finished.
    job: AtomicPtr<Job<'static>>,
    /// Counts jobs: workers wait for the next.
    posted: Counter,
    /// Whether each worker sleeps, or is about to.
    asleep: Vec<AtomicBool>,
    /// The caller, while it sleeps or is about to.
    caller: Mutex<Option<Thread>>,
    /// What bands of the job have panicked with.
    panics: Mutex<Vec<Box<dyn Any + Send>>>,
    closing: AtomicBool,
}

/// In a cache line of its own, and in no pair of lines that is fetched together.
#[repr(align(128))]
#[derive(Default)]
struct Counter(AtomicUsize);

impl Pool {
    /// A pool of `threads` threads, the caller's among them; 0 is one a core, or as many as the
    /// system gives.
    ///
    /// # Errors
    /// Where the system refuses them.
    pub(crate) fn new(threads: usize) -> io::Result<Pool> {
        let one_a_core = threads == 0;
        let threads = match threads {
            0 => thread::available_parallelism().map_or(1, usize::from),
            threads => threads,
        };
        if threads > MAX_THREADS {
            let most = format!("{MAX_THREADS} is the most");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, most));
        }
        let mut pool = Pool {
            shared: Arc::new(Shared {
                unclaimed: (0..threads).map(|_| Counter::default()).collect(),
                posted: Counter::default(),
                unfinished: Counter::default(),
                job: AtomicPtr::new(ptr::null_mut()),
                asleep: (1..threads).map(|_| AtomicBool::new(false)).collect(),
                caller: Mutex::new(None),
                panics: Mutex::new(Vec::new()),
                closing: AtomicBool::new(false),
            }),
            workers: Vec::new(),
        };
        // A thread that begins asks for a little memory, and the C library ends the process where
        // that is refused: so all have begun before the caller asks for pictures.
        Expression::begin_thread();
        let begun = Arc::new((Mutex::new(0), Condvar::new()));
        for number in 1..threads {
            let (shared, begun) = (pool.shared.clone(), begun.clone());
            let worker = thread::Builder::new().name(format!("tracer {number}"));
            let serve = move || {
                Expression::begin_thread();
                *lock(&begun.0) += 1;
                begun.1.notify_one();
                drop(begun);
                shared.serve(number);
            };
            match worker.spawn(serve) {
                Ok(worker) => pool.workers.push(worker),
                // Those that there are do the work of all.
                Err(_) if one_a_core => break,
                // Those before it end as the pool is dropped.
                Err(refused) => return Err(refused),
            }
        }
        let (count, changed) = &*begun;
        let all = |count: &mut usize| *count < pool.workers.len();
        drop(changed.wait_while(lock(count), all));
        Ok(pool)
    }

    /// How many threads there are.
    pub(crate) fn threads(&self) -> usize {
        self.workers.len() + 1
    }

    /// Hands out `bands`: calls `work` once with each, the number of the thread that it is called
    /// on, and that of the band. Returns when all have been worked at.
    ///
    /// # Panics
    /// Where `work` does, as it does.
    pub(crate) fn share<Band: Send>(
        &mut self,
        bands: impl Iterator<Item = Band>,
        work: impl Fn(usize, usize, Band) + Sync,
    ) {
        // Nobody waits for these locks: a band is claimed once.
        let bands: Vec<_> = bands.map(|band| Mutex::new(Some(band))).collect();
        self.run(bands.len(), |thread, number| {
            let band = lock(&bands[number]).take();
            if let Some(band) = band {
                work(thread, number, band);
            }
        });
    }

    /// Calls `work` once for each band from 0 to before `bands`, with the number of the thread that
    /// it is called on, from 0 to before [`Pool::threads`], and that of the band. Returns when all
    /// bands are finished.
    ///
    /// # Panics
    /// Where a band does, as it does; with workers, after all other bands are finished.
    fn run(&mut self, bands: usize, work: impl Fn(usize, usize) + Sync) {
        if self.workers.is_empty() {
            return (0..bands).for_each(|band| work(0, band));
        }
        let shared = &*self.shared;
        let job = Job { work: &work, bands };
        // No worker has a band now, because `&mut self` lets in one caller at a time, and the one
        // before left when all bands were finished. From the first store into `unclaimed` on, until
        // `wait` returns, `job` must stay where it is: nothing between may unwind.
        shared
            .job
            .store(ptr::from_ref(&job).cast_mut().cast(), Relaxed);
        shared.unfinished.0.store(bands, Relaxed);
        for (thread, unclaimed) in shared.unclaimed.iter().enumerate() {
            let (from, to) = (shared.first(thread, bands), shared.first(thread + 1, bands));
            unclaimed.0.store(to - from, Release);
        }
        shared.posted.0.fetch_add(1, SeqCst);
        for (asleep, worker) in shared.asleep.iter().zip(&self.workers).take(bands) {
            // In the one order of all `SeqCst`, either the worker's look at `posted`, which follows
            // its store, comes after the addition above and finds the job; or this load comes after
            // the worker's store and finds that it sleeps.
            if asleep.load(SeqCst) {
                worker.thread().unpark();
            }
        }
        shared.work(0);
        shared.wait();
        let panics = std::mem::take(&mut *lock(&shared.panics));
        if let Some(panic) = panics.into_iter().next() {
            resume_unwind(panic);
        }
    }
}

impl Shared {
    /// The first band of those that a thread is to begin with.
    fn first(&self, thread: usize, bands: usize) -> usize {
        bands * thread / self.unclaimed.len()
    }

    /// Works at bands for as long as there are unclaimed ones.
    fn work(&self, number: usize) {
        let claim = |unclaimed: usize| unclaimed.checked_sub(1);
        for owner in (number..self.unclaimed.len()).chain(0..number) {
            let unclaimed = &self.unclaimed[owner].0;
            while let Ok(rest) = unclaimed.fetch_update(Acquire, Relaxed, claim) {
                // SAFETY: this thread has claimed a band, and has not reported it finished.
                // Whatever it believed to be going on before (it may have slept through any number
                // of jobs between two instructions), the band is one of the job that the counter
                // was last stored for, and the caller cannot leave `run`, where that job lies,
                // before the band is reported below. The store was after the one into `job`, which
                // claiming, a read-modify-write of the stored value or of one that follows from it,
                // therefore makes visible; and there is no later store into `job` before the caller
                // has left. The lifetime that the pointer has lost is longer than this turn of the
                // loop.
                let job = unsafe { &*self.job.load(Relaxed) };
                let band = self.first(owner, job.bands) + rest - 1;
                let work = AssertUnwindSafe(|| (job.work)(number, band));
                if let Err(panic) = catch_unwind(work) {
                    lock(&self.panics).push(panic);
                }
                // From here on the job is not touched. The caller, which sees 0, sees what all
                // bands have written.
                if self.unfinished.0.fetch_sub(1, Release) == 1 && number != 0 {
                    self.wake_caller();
                }
            }
        }
    }

    /// Waits until all bands are finished, as the caller.
    fn wait(&self) {
        let finished = || self.unfinished.0.load(Acquire) == 0;
        if look(finished) {
            return;
        }
        *lock(&self.caller) = Some(thread::current());
        // Whoever finishes the last band locks the same mutex afterwards: before this thread did,
        // and then it is seen here that all are finished; or after, and then it finds this thread
        // and wakes it.
        while !finished() {
            thread::park();
        }
        *lock(&self.caller) = None;
    }

    /// The handle stays: who comes late, in another job, wakes a caller that looks and sleeps
    /// again.
    fn wake_caller(&self) {
        if let Some(caller) = &*lock(&self.caller) {
            caller.unpark();
        }
    }

    /// What a worker does.
    fn serve(&self, number: usize) {
        let asleep = &self.asleep[number - 1];
        let mut seen = 0;
        while !self.closing.load(Relaxed) {
            let called = || self.posted.0.load(SeqCst) != seen || self.closing.load(SeqCst);
            if !look(called) {
                asleep.store(true, SeqCst);
                while !called() {
                    thread::park();
                }
                asleep.store(false, Relaxed);
            }
            seen = self.posted.0.load(Acquire);
            self.work(number);
        }
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        self.shared.closing.store(true, SeqCst);
        for worker in &self.workers {
            worker.thread().unpark();
        }
        for worker in self.workers.drain(..) {
            // A worker catches every panic.
            let _ = worker.join();
        }
    }
}

/// Whether a condition comes true soon.
fn look(condition: impl Fn() -> bool) -> bool {
    if condition() {
        return true;
    }
    let begin = Instant::now();
    while begin.elapsed() < SPIN_TIME {
        for _ in 0..16 {
            std::hint::spin_loop();
            if condition() {
                return true;
            }
        }
    }
    false
}

/// What is guarded is whole after every statement: a panic elsewhere does not spoil it.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test stops at the first surprise, and one panics on purpose"
)]
mod tests {
    use std::sync::Barrier;

    use super::*;

    /// Under Miri, which interprets, a few.
    const JOBS: usize = if cfg!(miri) { 40 } else { 5000 };

    /// Jobs of 0 to 8 bands; each thread's bands are its own.
    fn run_jobs(pool: &mut Pool, jobs: usize) {
        for job in 0..jobs {
            match job % 2 {
                0 => run_job(pool, job % 9),
                _ => run_job_deeper(pool, job % 9),
            }
        }
    }

    fn run_job(pool: &mut Pool, bands: usize) {
        let counts: Vec<_> = (0..bands).map(|_| AtomicUsize::new(0)).collect();
        let busy: Vec<_> = (0..pool.threads())
            .map(|_| AtomicBool::new(false))
            .collect();
        pool.run(bands, |thread, band| {
            assert!(!busy[thread].swap(true, Relaxed));
            // That the caller sees what the bands have written is up to the pool.
            counts[band].fetch_add(1, Relaxed);
            assert!(busy[thread].swap(false, Relaxed));
        });
        let counts = counts.into_iter().map(AtomicUsize::into_inner);
        assert!(counts.eq(std::iter::repeat_n(1, bands)));
    }

    /// With the job elsewhere on the stack, where the next one is not: a worker that takes one for
    /// the other is found out.
    #[inline(never)]
    fn run_job_deeper(pool: &mut Pool, bands: usize) {
        let depth = std::hint::black_box([0u8; 2000]);
        run_job(pool, bands);
        std::hint::black_box(depth);
    }

    #[test]
    fn every_band_is_worked_at_once() {
        for threads in 1..=8 {
            let mut pool = Pool::new(threads).unwrap();
            assert_eq!(pool.threads(), threads);
            run_jobs(&mut pool, JOBS);
        }
    }

    #[test]
    fn jobs_wake_workers_that_sleep_and_callers_that_do() {
        let mut pool = Pool::new(3).unwrap();
        for pause in [2 * SPIN_TIME, SPIN_TIME, SPIN_TIME / 2, Duration::ZERO].repeat(JOBS / 40) {
            run_jobs(&mut pool, 9);
            // Asleep, or about to be.
            thread::sleep(pause);
            // Every thread has a band, or none of them ends.
            let all = Barrier::new(3);
            pool.run(3, |thread, _| {
                all.wait();
                // The caller has nothing left to do and waits.
                if thread != 0 {
                    thread::sleep(pause);
                }
            });
        }
    }

    #[test]
    fn a_panic_reaches_the_caller_after_all_other_bands() {
        for threads in [1, 2, 5] {
            let mut pool = Pool::new(threads).unwrap();
            for panicking in 0..6 {
                let count = AtomicUsize::new(0);
                let run = || {
                    pool.run(6, |_, band| {
                        if band == panicking {
                            resume_unwind(Box::new(band));
                        }
                        count.fetch_add(1, Relaxed);
                    });
                };
                let panic = catch_unwind(AssertUnwindSafe(run)).unwrap_err();
                assert_eq!(panic.downcast_ref::<usize>(), Some(&panicking));
                // Alone, a thread stops where it panics.
                let others = if threads == 1 { panicking } else { 5 };
                assert_eq!(count.into_inner(), others);
                run_jobs(&mut pool, 9);
            }
        }
    }

    #[test]
    fn a_pool_ends_whether_its_workers_look_or_sleep_or_never_worked() {
        for pause in [Duration::ZERO, SPIN_TIME, 3 * SPIN_TIME] {
            for jobs in [0, 5] {
                let mut pool = Pool::new(4).unwrap();
                run_jobs(&mut pool, jobs);
                thread::sleep(pause);
                let shared = Arc::downgrade(&pool.shared);
                drop(pool);
                assert!(shared.upgrade().is_none());
            }
        }
    }

    #[test]
    fn one_a_core_or_too_many() {
        let cores = thread::available_parallelism().unwrap().get();
        assert_eq!(Pool::new(0).unwrap().threads(), cores);
        for threads in [MAX_THREADS + 1, usize::MAX] {
            let error = Pool::new(threads).err().unwrap();
            assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        }
    }
}
