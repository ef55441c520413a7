//! Scene, stage and α in; image out.
//!
//! Every formula of the picture is written once, over an abstract number: a line and a [sphere](self), a line and a
//! tetrahedron, a line and the surface, equation 4-1. A [`Kernel`] is a choice of that number.

mod decision;
mod explain;
mod extent;
mod ladder;
mod line;
mod listing;

mod palette;
mod pixel;
#[cfg(test)]
mod rational;
mod rows;
mod shading;
mod simd;
mod sphere;
mod surface;
mod tetrahedron;
mod vector;
mod view;

use rayon::ThreadPool;
use rayon::prelude::*;

use crate::{Image, Scene, Stage};
pub use decision::{Decision, Seen};
use ladder::{Ladder, Lines, Pixels, Plain, Rung};
use listing::Listing;
use rows::{Precision, Rows, Scratch};
pub use simd::Simd;

/// How numbers are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Kernel {
    /// Every decision as in exact arithmetic, every sample the true value correctly rounded.
    #[default]
    Exact,
    /// Every pixel in f32: careful formulas, no bounds, no safety net. Where borders cross a row is computed once a row, in f64.
    Fast,
    /// The same in f64, rounded to f32 once at the end.
    Double,
    /// The document's listings as printed, slips included: the baseline. Two spheres, one tetrahedron and a surface only.
    Listing,
    /// What errors are measured against: as exact, but with no f64 on the way.
    Reference,
}

impl Kernel {
    /// Every kernel.
    pub const ALL: [Kernel; 5] = [
        Kernel::Exact,
        Kernel::Fast,
        Kernel::Double,
        Kernel::Listing,
        Kernel::Reference,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Exact => "exact",
            Kernel::Fast => "fast",
            Kernel::Double => "double",
            Kernel::Listing => "listing",
            Kernel::Reference => "reference",
        }
    }
}

/// A tracer that cannot be made, or a frame that cannot be traced.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// α is a NaN or an infinity.
    #[error("α = {0} is not an angle: give a finite number of radians")]
    Angle(f64),
    /// The pixel is not in the picture.
    #[error("column {column}, row {row} is not in a picture of {size} × {size} pixels: both count from 0 to {}", size.saturating_sub(1))]
    Pixel {
        /// Its column, counted from the left.
        column: u32,
        /// Its row, counted from the bottom.
        row: u32,
        /// N.
        size: u32,
    },
    /// The kernel [`Kernel::Listing`] and a scene that is not of the document's shape.
    #[error(
        "the kernel listing traces 2 spheres, 1 tetrahedron and 1 surface; this scene has {spheres}, {tetrahedra} and {surfaces}: \
         choose another kernel"
    )]
    Listing {
        /// How many spheres there are.
        spheres: usize,
        /// How many tetrahedra.
        tetrahedra: usize,
        /// How many surfaces: 0 or 1.
        surfaces: usize,
    },
    /// The worker threads could not be started.
    #[error("{threads} threads cannot be started: {source}; ask for fewer")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// Why there are none.
        source: rayon::ThreadPoolBuildError,
    },
}

/// How many pixels of a frame were left in doubt by the cheaper arithmetic of the kernels that are right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InDoubt {
    /// Settled by double-doubles only.
    pub double_double: u64,
    /// Settled by arbitrary precision only.
    pub arbitrary: u64,
}

impl InDoubt {
    fn count(&mut self, rung: Rung) {
        match rung {
            Rung::Double => {}
            Rung::DoubleDouble => self.double_double += 1,
            Rung::Arbitrary => self.arbitrary += 1,
        }
    }

    fn and(self, other: InDoubt) -> InDoubt {
        InDoubt {
            double_double: self.double_double + other.double_double,
            arbitrary: self.arbitrary + other.arbitrary,
        }
    }
}

/// A pixel of a kernel that goes pixel by pixel.
fn explain_pixel(pixels: &impl Pixels, (column, row): (u32, u32)) -> (String, Rung) {
    let (traced, rung) = pixels.pixel(column, row);
    (pixels.explain(column, row, traced), rung)
}

/// Rows are handed to threads in bands of so many.
const BAND: usize = 16;

/// Traces pictures: made once, used for any number of frames.
pub struct Tracer {
    kernel: Kernel,
    /// `None` for one thread, which is the caller's.
    pool: Option<ThreadPool>,
    simd: Simd,
    in_doubt: InDoubt,
}

impl Tracer {
    /// A tracer with `threads` worker threads; 0 is one a core. Their number changes no bit of a picture.
    ///
    /// # Errors
    /// [`TraceError::Threads`] where the system refuses the threads.
    pub fn new(kernel: Kernel, threads: usize) -> Result<Tracer, TraceError> {
        let pool = if threads == 1 {
            None
        } else {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            Some(pool.map_err(|source| TraceError::Threads { threads, source })?)
        };
        Ok(Tracer {
            kernel,
            pool,
            simd: Simd::best(),
            in_doubt: InDoubt::default(),
        })
    }

    /// The same tracer, confined to these vector instructions. The kernels that go pixel by pixel use none.
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

    /// How many pixels of the frame traced last were in doubt; none for a kernel that knows no doubt.
    pub fn in_doubt(&self) -> InDoubt {
        self.in_doubt
    }

    /// Traces `scene` in `stage`, seen at angle `alpha` in radians, into the whole of `image`.
    ///
    /// # Errors
    /// [`TraceError::Angle`] where `alpha` is not finite, [`TraceError::Listing`] where the kernel is [`Kernel::Listing`] and the
    /// scene not of the document's shape; the image is left as it was.
    pub fn trace(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), TraceError> {
        self.trace_frame(scene, stage, alpha, image, None)
    }

    /// The same, and what was decided for each pixel: N² decisions, rows from the bottom.
    ///
    /// # Errors
    /// As [`Tracer::trace`].
    pub fn trace_with_decisions(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<Vec<Decision>, TraceError> {
        let mut decisions = vec![Decision::Background; image.samples().len() / 3];
        self.trace_frame(scene, stage, alpha, image, Some(&mut decisions))?;
        Ok(decisions)
    }

    /// One pixel, worked through for a person to read: the rays, what they meet and what that beat, the decisions and the
    /// arithmetic that settled them, each term of equation 4-1, the samples. It comes from the code that traces.
    ///
    /// # Errors
    /// [`TraceError::Angle`] where `alpha` is not finite, [`TraceError::Pixel`] where a picture of `size` has no such pixel.
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
        if column >= size || row >= size {
            return Err(TraceError::Pixel { column, row, size });
        }
        let at = (column, row);
        let (text, rung) = match self.kernel {
            Kernel::Exact => {
                let ladder = Ladder::new(scene, stage, alpha, size, Rung::Double);
                self.explain_from_row(&ladder, Precision::Bounded, at)
            }
            Kernel::Fast => {
                let plain = Plain::<f32>::new(scene, stage, alpha, size);
                self.explain_from_row(&plain, Precision::Single, at)
            }
            Kernel::Double => {
                let plain = Plain::<f64>::new(scene, stage, alpha, size);
                self.explain_from_row(&plain, Precision::Double, at)
            }
            Kernel::Listing => explain_pixel(&Listing::new(scene, stage, alpha, size)?, at),
            Kernel::Reference => {
                let ladder = Ladder::new(scene, stage, alpha, size, Rung::DoubleDouble);
                explain_pixel(&ladder, at)
            }
        };
        let by = match (self.kernel, rung) {
            (Kernel::Fast, _) => "f32",
            (Kernel::Double | Kernel::Listing, _) => "f64",
            (_, Rung::Double) => "f64 with a bound on its error",
            (_, Rung::DoubleDouble) => "double-doubles with a bound on their error",
            (_, Rung::Arbitrary) => "arbitrary precision",
        };
        Ok(format!(
            "pixel        column {column}, row {row} from the bottom, of {size} × {size}\n\
             frame        stage {stage}, α = {alpha:?}\n{text}decided by   {by} (kernel {})\n",
            self.kernel.name()
        ))
    }

    /// The pixel as it is traced, with the rest of its row.
    fn explain_from_row(
        &self,
        pixels: &impl Lines,
        precision: Precision,
        (column, row): (u32, u32),
    ) -> (String, Rung) {
        let size = pixels.bounded().size as usize;
        let (mut samples, mut decisions) = (vec![0.0; 3 * size], vec![Decision::Background; size]);
        Rows::new(pixels, precision, self.simd.0).trace(
            row,
            &mut samples,
            Some(&mut decisions),
            &mut Scratch::default(),
        );
        let place = column as usize;
        let color = std::array::from_fn(|channel| samples[3 * place + channel]);
        let text = pixels.explain(column, row, (decisions[place], color));
        (text, pixels.pixel(column, row).1)
    }

    fn trace_frame(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
        decisions: Option<&mut [Decision]>,
    ) -> Result<(), TraceError> {
        if !alpha.is_finite() {
            return Err(TraceError::Angle(alpha));
        }
        let n = image.size();
        self.in_doubt = match self.kernel {
            Kernel::Exact => {
                let ladder = Ladder::new(scene, stage, alpha, n, Rung::Double);
                self.trace_rows(&ladder, Precision::Bounded, image, decisions)
            }
            Kernel::Fast => {
                let plain = Plain::<f32>::new(scene, stage, alpha, n);
                self.trace_rows(&plain, Precision::Single, image, decisions)
            }
            Kernel::Double => {
                let plain = Plain::<f64>::new(scene, stage, alpha, n);
                self.trace_rows(&plain, Precision::Double, image, decisions)
            }
            Kernel::Listing => {
                self.trace_pixels(&Listing::new(scene, stage, alpha, n)?, image, decisions)
            }
            Kernel::Reference => self.trace_pixels(
                &Ladder::new(scene, stage, alpha, n, Rung::DoubleDouble),
                image,
                decisions,
            ),
        };
        Ok(())
    }

    fn trace_rows(
        &self,
        pixels: &impl Lines,
        precision: Precision,
        image: &mut Image,
        decisions: Option<&mut [Decision]>,
    ) -> InDoubt {
        let rows = Rows::new(pixels, precision, self.simd.0);
        let scratch = Scratch::default;
        self.each_row(
            image,
            decisions,
            scratch,
            |row, samples, decisions, scratch| rows.trace(row, samples, decisions, scratch),
        )
    }

    fn trace_pixels(
        &self,
        pixels: &impl Pixels,
        image: &mut Image,
        decisions: Option<&mut [Decision]>,
    ) -> InDoubt {
        self.each_row(
            image,
            decisions,
            || (),
            |row, samples, decisions, ()| {
                let mut in_doubt = InDoubt::default();
                let mut decisions = decisions.into_iter().flatten();
                for (column, sample) in samples.chunks_exact_mut(3).enumerate() {
                    let ((decision, color), rung) = pixels.pixel(column as u32, row);
                    in_doubt.count(rung);
                    sample.copy_from_slice(&color);
                    if let Some(place) = decisions.next() {
                        *place = decision;
                    }
                }
                in_doubt
            },
        )
    }

    /// Traces every row, on all threads: `trace` gets its number, its samples, and the place for its decisions if they are asked for.
    fn each_row<Scratch>(
        &self,
        image: &mut Image,
        decisions: Option<&mut [Decision]>,
        scratch: impl Fn() -> Scratch + Sync,
        trace: impl Fn(u32, &mut [f32], Option<&mut [Decision]>, &mut Scratch) -> InDoubt + Sync,
    ) -> InDoubt {
        let width = image.size() as usize;
        let band = |first: usize, samples: &mut [f32], decisions: Option<&mut [Decision]>| {
            let mut scratch = scratch();
            let mut decisions = decisions.map(|decisions| decisions.chunks_exact_mut(width));
            let rows = samples.chunks_exact_mut(3 * width).enumerate();
            rows.map(|(row, samples)| {
                let decisions = decisions.as_mut().and_then(Iterator::next);
                trace((first + row) as u32, samples, decisions, &mut scratch)
            })
            .fold(InDoubt::default(), InDoubt::and)
        };
        let samples = image.samples_mut();
        let Some(pool) = &self.pool else {
            return band(0, samples, decisions);
        };
        let bands = samples.par_chunks_mut(3 * width * BAND).enumerate();
        pool.install(|| match decisions {
            Some(decisions) => bands
                .zip(decisions.par_chunks_mut(width * BAND))
                .map(|((number, samples), decisions)| band(number * BAND, samples, Some(decisions)))
                .reduce(InDoubt::default, InDoubt::and),
            None => bands
                .map(|(number, samples)| band(number * BAND, samples, None))
                .reduce(InDoubt::default, InDoubt::and),
        })
    }
}
