//! Scene, stage and α in; image out.
//!
//! Every formula of the picture is written once, over an abstract number (`number.rs`). A
//! [`Kernel`] chooses the number, and what happens where it leaves a doubt. To be read in this
//! order:
//!
//! - `kernel`, `decision`, `vector`, `line`, `half_space`: the kernels, what a pixel can show,
//!   points and rays;
//! - `view_space`, `view_transform`, `view_signs`, `view_tetrahedra`, `view`: view space, into
//!   which the scene and its mirror image are turned by α;
//! - `sphere`, `tetrahedron`, `surface`: intersections; `shading`: equation 4-1; `palette`: the
//!   colours that many pixels share;
//! - `extent`, `tiles`, `surface_casters`: which solids a pixel need not be tested against;
//! - `pixel`: what a pixel shows: the definition of the picture;
//! - `ladder`: a pixel in f64 with bounds; in doubt, in double-doubles; still in doubt, in
//!   arbitrary precision;
//! - `scanline`: whole rows at once: nearly all pixels are made there, and few by the ladder;
//! - `listing`: the document's code as printed, slips included; it shares nothing with the rest;
//! - `frame_work`: a frame in the arithmetic of each kernel;
//! - `pool`, `target`, `stream`, `arena`: threads, the memory of rows and of what a frame needs;
//! - `progress`, `tally`: how far a frame is, and what it took;
//! - `explain`: a pixel in words; `colors`: what other decisions would look like; `mistaken`: what
//!   mistakes look like.
//!
//! [`Tracer::trace`] gives the frame to `with_frame`, which chooses the numbers; `trace_into` the
//! image to the threads of the pool, in bands of rows; `RowTracer` traces a band.
//!
//! `scanline` also says what a new kind of solid would need.
//!
//! `tests/oracle.rs` evaluates the picture a second time. The oracle shares no code with this.

mod arena;
mod colors;
mod decision;
mod error;
mod explain;
mod extent;
mod frame_work;
mod half_space;
mod kernel;
mod ladder;
mod line;
mod listing;
mod mistaken;
mod palette;
mod pixel;
pub(crate) mod pool;
mod progress;
mod scanline;
mod shading;
mod simd;
mod sphere;
mod stream;
mod surface;
mod surface_casters;
mod tally;
mod target;
mod tetrahedron;
mod tiles;
mod vector;
mod view;
mod view_signs;
mod view_space;
mod view_tetrahedra;
mod view_transform;

use std::ops::Range;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, PoisonError};

use crate::image::MAX_SIZE;
use crate::{Image, Scene, Stage, memory};
use arena::Arena;
pub(crate) use colors::{Colors, with_colors};
pub use decision::{Decision, Seen};
pub use error::TraceError;
pub(crate) use explain::{name, say};
use frame_work::{FrameWork, with_frame};
pub use kernel::Kernel;
use ladder::{Pixels, RowPixels, Rung};
pub(crate) use mistaken::{Far, Mistake, Mistaken, Toward, with_pixels};
use pool::{Pool, lock};
pub use progress::Progress;
use scanline::{Precision, ROWS, RowHistory, RowTracer, Scratch};
pub use simd::Simd;
pub use tally::Tally;
use target::Target;

/// The rows of a band, which one thread traces. A band is small enough to balance the threads, and
/// large enough that claiming one costs nothing.
const BAND: usize = ROWS;

/// Traces pictures: made once, used for any number of frames.
pub struct Tracer {
    kernel: Kernel,
    pool: Pool,
    /// What each thread of the pool needs.
    local: Vec<Mutex<Local>>,
    simd: Simd,
    progress: Progress,
    tally: Tally,
    /// Only `get_mut` is used: the mutex makes `Tracer` `Sync`, so that threads can explain pixels.
    arena: Box<Mutex<Arena>>,
    /// The rows of the frame that [`Tracer::retrace`] traced last.
    history: Vec<RowHistory>,
    /// The number of that frame, or 0.
    frame_number: u64,
}

impl Tracer {
    /// A tracer with `threads` threads, the caller's among them, at most 4096; 0 is one a core, or
    /// fewer where the system refuses some. Their number changes no bit of a picture.
    ///
    /// # Errors
    /// [`TraceError::Threads`] where there are more than 4096, or the system refuses them.
    pub fn new(kernel: Kernel, threads: usize) -> Result<Tracer, TraceError> {
        let pool = Pool::new(threads).map_err(|source| TraceError::Threads { threads, source })?;
        let local = std::iter::repeat_with(Mutex::default);
        Ok(Tracer {
            kernel,
            local: local.take(pool.threads()).collect(),
            pool,
            simd: Simd::best(),
            history: Vec::new(),
            frame_number: 0,
            progress: Progress::default(),
            tally: Tally::default(),
            arena: Box::default(),
        })
    }

    /// The same tracer, confined to these vector instructions. Kernels that trace pixel by pixel
    /// use none.
    pub fn with_simd(self, simd: Simd) -> Tracer {
        Tracer { simd, ..self }
    }

    /// The vector instructions that it uses: the widest, unless it was confined.
    pub fn simd(&self) -> Simd {
        self.simd
    }

    /// The kernel it was made with.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// What the frame traced last took; zeros before the first. Explained pixels do not count.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// The progress of the frame that is traced now or was traced last.
    pub fn progress(&self) -> Progress {
        self.progress.clone()
    }

    /// Traces `scene` in `stage`, seen at angle `alpha` in radians, into the whole of `image`.
    ///
    /// # Errors
    /// [`TraceError::Angle`] where `alpha` is not finite, [`TraceError::Listing`] where the kernel
    /// is [`Kernel::Listing`] and the scene not of the document's shape; the image is left as
    /// it was. [`TraceError::Cancelled`] where its [`Progress`] was told so.
    pub fn trace(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), TraceError> {
        self.trace_frame(scene, stage, alpha, image, None, Update::Whole)
    }

    /// The same picture. If `image` still holds the frame that this tracer retraced last, only what
    /// has changed is written; any other image is written whole.
    ///
    /// Returns a range of rows, counted from the bottom, that holds all rows written.
    ///
    /// ```
    /// use firsthit::{Image, Kernel, Scene, Stage, Tracer};
    ///
    /// let (scene, mut tracer) = (Scene::builtin(), Tracer::new(Kernel::Exact, 1)?);
    /// let (mut image, mut whole) = (Image::new(64)?, Image::new(64)?);
    /// for alpha in [0.0, 0.3, 0.6] {
    ///     let rows = tracer.retrace(&scene, Stage::Animation, alpha, &mut image)?;
    ///     assert!(rows.end < 64 || alpha == 0.0, "the uppermost row shows the background in every frame");
    ///     tracer.trace(&scene, Stage::Animation, alpha, &mut whole)?;
    ///     assert!(image == whole);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Tracer::trace`].
    pub fn retrace(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<Range<u32>, TraceError> {
        self.history
            .iter_mut()
            .for_each(|row| row.is_written = false);
        self.trace_frame(scene, stage, alpha, image, None, Update::Changes)?;
        let is_written = |row: &RowHistory| row.is_written;
        let first = self.history.iter().position(is_written);
        let last = self.history.iter().rposition(is_written);
        Ok(first
            .zip(last)
            .map_or(0..0, |(first, last)| first as u32..last as u32 + 1))
    }

    /// As [`Tracer::trace`]. Returns the decision of each of the N² pixels, rows from the bottom.
    ///
    /// # Errors
    /// As [`Tracer::trace`], and [`TraceError::Memory`] where the decisions do not fit.
    pub fn trace_with_decisions(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<Vec<Decision>, TraceError> {
        let (pixels, mut decisions) = (image.samples().len() / 3, Vec::new());
        memory::reserve(&mut decisions, pixels).map_err(|_| TraceError::Memory { pixels })?;
        decisions.resize(pixels, Decision::Background);
        self.trace_frame(
            scene,
            stage,
            alpha,
            image,
            Some(&mut decisions),
            Update::Whole,
        )?;
        Ok(decisions)
    }

    /// One pixel, worked through for a person to read: its rays, all that they meet, the decision
    /// and the arithmetic that settled it, each term of equation 4-1, the samples. All numbers come
    /// from the code that traces. `size` is N, 1 to [`MAX_SIZE`].
    ///
    /// # Errors
    /// [`TraceError::Angle`] where `alpha` is not finite, [`TraceError::Pixel`] where a picture of
    /// `size` has no such pixel, or `size` is larger.
    pub fn explain(
        &self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        size: u32,
        (column, row): (u32, u32),
    ) -> Result<String, TraceError> {
        if !alpha.is_finite() {
            return Err(TraceError::Angle(alpha));
        }
        if size > MAX_SIZE || column >= size || row >= size {
            return Err(TraceError::Pixel { column, row, size });
        }
        let arena = Arena::default();
        let work = ExplainPixel {
            simd: self.simd,
            at: (column, row),
        };
        let frame = (scene, stage, alpha, size);
        let (text, rung) = with_frame(self.kernel, frame, &arena, work)?;
        let by = match (self.kernel, rung) {
            (Kernel::Fast, _) => "f32",
            (Kernel::Double | Kernel::Listing, _) => "f64",
            (_, Rung::Hardware) => "f64 with a bound on its error",
            (_, Rung::DoubleDouble) => "double-doubles with a bound on their error",
            (_, Rung::Arbitrary) => "arbitrary precision",
        };
        Ok(format!(
            "pixel        column {column}, row {row} from the bottom, of {size} × {size}\n\
             frame        stage {stage}, α = {alpha:?}\n{text}decided by   {by} (kernel {})\n",
            self.kernel.name()
        ))
    }

    fn trace_frame(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
        decisions: Option<&mut [Decision]>,
        update: Update,
    ) -> Result<(), TraceError> {
        if !alpha.is_finite() {
            return Err(TraceError::Angle(alpha));
        }
        let mut arena = std::mem::take(inner(&mut self.arena));
        arena.clear();
        let (kernel, frame) = (self.kernel, (scene, stage, alpha, image.size()));
        // A frame that is not wanted any more may be cancelled while it is set up, too.
        self.progress.begin();
        let work = TraceFrame {
            tracer: self,
            image,
            decisions,
            update,
        };
        let traced = with_frame(kernel, frame, &arena, work);
        *inner(&mut self.arena) = arena;
        if self.progress.is_cancelled() {
            // Nobody knows what the image shows.
            self.frame_number = 0;
            return Err(TraceError::Cancelled);
        }
        traced
    }

    /// Calls `trace` with the memory that samples, decisions and histories go to.
    fn trace_into(
        &mut self,
        image: &mut Image,
        decisions: Option<&mut [Decision]>,
        update: Update,
        trace: impl FnOnce(&mut Tracer, Target<'_>) -> Tally,
    ) {
        let size = image.size();
        let mut history = std::mem::take(&mut self.history);
        let (remembered, samples) = match update {
            Update::Whole => (None, image.samples_mut()),
            Update::Changes => {
                let is_same = self.frame_number != 0 && image.frame_number() == self.frame_number;
                if !is_same {
                    history.iter_mut().for_each(RowHistory::clear);
                }
                history.resize_with(size as usize, RowHistory::default);
                self.frame_number = next_frame_number();
                let samples = image.samples_of_frame(self.frame_number);
                (Some(history.as_mut_slice()), samples)
            }
        };
        let target = Target {
            size,
            samples,
            decisions,
            history: remembered,
        };
        self.tally = trace(self, target);
        self.history = history;
    }

    fn trace_rows(
        &mut self,
        pixels: &dyn RowPixels,
        precision: Precision,
        target: Target<'_>,
        arena: &Arena,
    ) -> Tally {
        let rows = RowTracer::new(pixels, precision, self.simd.0, arena);
        let size = target.size;
        for local in &mut self.local {
            rows.begin(&mut inner(local).scratch);
        }
        let streamed = target.history.is_none() && size_of_val(target.samples) > stream::PLAIN;
        let progress = self.progress();
        self.each_band(target, |first, band, local| {
            let Local { scratch, row, .. } = local;
            if !streamed {
                let end = first + (band.samples.len() / (3 * size as usize)) as u32;
                let Target {
                    samples,
                    decisions,
                    history,
                    ..
                } = band;
                return rows.trace(first..end, samples, decisions, history, scratch, &progress);
            }
            let mut tally = Tally::default();
            for (number, target) in (first..).zip(band.split(1)) {
                if progress.is_cancelled() {
                    break;
                }
                row.resize(target.samples.len(), 0.0);
                let only = number..number + 1;
                let of_row = rows.trace(only, row, target.decisions, None, scratch, &progress);
                tally = tally.and(of_row);
                stream::copy(row, target.samples);
            }
            stream::finish();
            tally
        })
    }

    fn trace_pixels(&mut self, pixels: &impl Pixels, target: Target<'_>) -> Tally {
        let progress = self.progress();
        self.each_band(target, |first, band, _| {
            let mut tally = Tally::default();
            'rows: for (number, row) in (first..).zip(band.split(1)) {
                if let Some(history) = row.history.and_then(<[RowHistory]>::first_mut) {
                    history.is_written = true;
                }
                let mut decisions = row.decisions.into_iter().flatten();
                for (column, sample) in row.samples.chunks_exact_mut(3).enumerate() {
                    if progress.is_cancelled() {
                        break 'rows;
                    }
                    let ((decision, color), rung) = pixels.pixel(column as u32, number);
                    tally.count(rung);
                    sample.copy_from_slice(&color);
                    if let Some(decided) = decisions.next() {
                        *decided = decision;
                    }
                }
                progress.add(1);
            }
            tally
        })
    }

    /// Traces bands of rows on all threads; a single thread traces all rows as one band. `trace`
    /// gets the number of the band's first row.
    fn each_band(
        &mut self,
        target: Target<'_>,
        trace: impl Fn(u32, Target<'_>, &mut Local) -> Tally + Sync,
    ) -> Tally {
        let band = |number: usize, band: Target<'_>, local: &mut Local| {
            let tally = trace((number * BAND) as u32, band, local);
            local.tally = local.tally.and(tally);
        };
        match &mut self.local[..] {
            [local] => band(0, target, inner(local)),
            // Each thread locks its own memory only.
            locals => self
                .pool
                .share(target.split(BAND), |thread, number, target| {
                    band(number, target, &mut lock(&locals[thread]));
                }),
        }
        let tally = |local: &mut Mutex<Local>| std::mem::take(&mut inner(local).tally);
        let counts = self.local.iter_mut().map(tally);
        counts.fold(Tally::default(), Tally::and)
    }
}

/// Traces a frame into an image.
struct TraceFrame<'t> {
    tracer: &'t mut Tracer,
    image: &'t mut Image,
    decisions: Option<&'t mut [Decision]>,
    update: Update,
}

impl FrameWork for TraceFrame<'_> {
    type Output = ();

    fn by_rows(self, pixels: &dyn RowPixels, precision: Precision, arena: &Arena) {
        let trace = |tracer: &mut Tracer, target: Target<'_>| {
            tracer.trace_rows(pixels, precision, target, arena)
        };
        let tracer = self.tracer;
        tracer.trace_into(self.image, self.decisions, self.update, trace);
    }

    fn by_pixels(self, pixels: &impl Pixels) {
        let trace = |tracer: &mut Tracer, target: Target<'_>| tracer.trace_pixels(pixels, target);
        let tracer = self.tracer;
        tracer.trace_into(self.image, self.decisions, self.update, trace);
    }
}

/// Works through a pixel.
struct ExplainPixel {
    simd: Simd,
    at: (u32, u32),
}

impl FrameWork for ExplainPixel {
    type Output = (String, Rung);

    /// The pixel is traced with the rest of its row, as in a picture.
    fn by_rows(
        self,
        pixels: &dyn RowPixels,
        precision: Precision,
        arena: &Arena,
    ) -> (String, Rung) {
        let (column, row) = self.at;
        let size = pixels.bounded().size as usize;
        let (mut samples, mut decisions) = (vec![0.0; 3 * size], vec![Decision::Background; size]);
        let (rows, mut scratch) = (
            RowTracer::new(pixels, precision, self.simd.0, arena),
            Scratch::default(),
        );
        rows.begin(&mut scratch);
        let only = row..row + 1;
        let decided = Some(&mut decisions[..]);
        let progress = Progress::default();
        rows.trace(only, &mut samples, decided, None, &mut scratch, &progress);
        let index = column as usize;
        let color = std::array::from_fn(|channel| samples[3 * index + channel]);
        let text = pixels.explain(column, row, (decisions[index], color));
        (text, pixels.pixel(column, row).1)
    }

    fn by_pixels(self, pixels: &impl Pixels) -> (String, Rung) {
        let (column, row) = self.at;
        let (traced, rung) = pixels.pixel(column, row);
        (pixels.explain(column, row, traced), rung)
    }
}

/// What a mutex guards, without locking it.
fn inner<T>(mutex: &mut Mutex<T>) -> &mut T {
    mutex.get_mut().unwrap_or_else(PoisonError::into_inner)
}

/// The memory of one thread, in cache lines of its own.
#[repr(align(128))]
#[derive(Default)]
struct Local {
    scratch: Scratch,
    /// The row that is traced, if the picture is streamed.
    row: Vec<f32>,
    /// Counted over the rows of this frame that the thread has traced.
    tally: Tally,
}

/// How much of an image is written.
#[derive(Clone, Copy)]
enum Update {
    Whole,
    /// Only what differs from the frame before.
    Changes,
}

/// The number of a new frame, unique among all tracers.
fn next_frame_number() -> u64 {
    static COUNT: AtomicU64 = AtomicU64::new(1);
    COUNT.fetch_add(1, Relaxed)
}
