//! What late faces are made from, and the memory in which a thread makes them.

use std::cell::{Cell, OnceCell};
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;

use bumpalo::Bump;
use bumpalo_herd::{Herd, Member};
use fearless_simd::Level;
use smallvec::SmallVec;

use crate::tracer::arena::Blocks;
use crate::tracer::ladder::RowPixels;
use crate::tracer::pool::lock;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::row_edges::RowEdges;
use crate::tracer::scanline::write::paint::Paint;

/// What late faces are made from.
pub(crate) struct LateSource<'f> {
    pub(crate) pixels: &'f dyn RowPixels,
    pub(crate) grid: Grid,
    pub(crate) level: Level,
    /// The memory for what threads make.
    pub(crate) threads: &'f Herd,
    /// How many bytes of it regions may take. Each thread may go beyond this with one solid, with
    /// what it has not counted yet, and with what is left over of its blocks; and then each shadow
    /// takes what tells its caster and its rows.
    pub(crate) most: usize,
    /// How many they take.
    pub(crate) taken: AtomicUsize,
    /// The parts of it that a thread used before, and no thread uses now. A list of so many lies
    /// here: a frame on few threads asks the system for no memory.
    pub(crate) free: Mutex<SmallVec<[LateMemory<'f>; 16]>>,
}

/// The memory in which one thread at a time keeps late faces.
pub(crate) struct LateMemory<'f> {
    /// All of it.
    pub(crate) member: Member<'f>,
    /// Parts of it, for edges and paints.
    pub(super) edges: Blocks<'f, [f64; ROWS]>,
    pub(super) paints: Blocks<'f, Paint>,
}

/// What a thread needs while it makes late faces.
#[derive(Default)]
pub(crate) struct LateWork {
    /// Memory that is free between late faces.
    pub(super) spare: Bump,
    /// The edges of one solid.
    pub(super) edges: RowEdges,
}

/// Keeps the late faces that one thread makes.
pub(crate) struct LateMaker<'s, 'f> {
    pub(crate) source: &'s LateSource<'f>,
    /// The thread's memory, once it is asked for.
    memory: OnceCell<LateMemory<'f>>,
    /// How many bytes regions took that [`LateSource::taken`] does not count yet.
    uncounted: Cell<usize>,
}

/// So many bytes are counted at once: a processor that counts what others count, too, waits until
/// all that it wrote before is in the cache.
const COUNTED_AT_ONCE: usize = 1 << 16;

impl<'s, 'f> LateMaker<'s, 'f> {
    pub(crate) fn new(source: &'s LateSource<'f>) -> Self {
        LateMaker {
            source,
            memory: OnceCell::new(),
            uncounted: Cell::new(0),
        }
    }

    /// The memory for what the frame keeps.
    pub(super) fn memory(&self) -> &LateMemory<'f> {
        self.memory.get_or_init(|| {
            let free = lock(&self.source.free).pop();
            free.unwrap_or_else(|| LateMemory {
                member: self.source.threads.get(),
                edges: Blocks::default(),
                paints: Blocks::default(),
            })
        })
    }

    /// Whether regions may take more memory.
    pub(super) fn has_memory(&self) -> bool {
        self.source.taken.load(Relaxed) + self.uncounted.get() < self.source.most
    }

    /// Counts bytes that regions take.
    pub(super) fn take(&self, bytes: usize) {
        self.uncounted.set(self.uncounted.get() + bytes);
        if self.uncounted.get() >= COUNTED_AT_ONCE {
            self.count();
        }
    }

    fn count(&self) {
        let bytes = self.uncounted.take();
        self.source.taken.fetch_add(bytes, Relaxed);
    }
}

impl Drop for LateMaker<'_, '_> {
    fn drop(&mut self) {
        if let Some(memory) = self.memory.take() {
            lock(&self.source.free).push(memory);
        }
        if self.uncounted.get() > 0 {
            self.count();
        }
    }
}
