//! Scene, stage and α in; image out.
//!
//! Every formula of the picture is written once, over an abstract number: a line and a [sphere](self), a line and a
//! tetrahedron, a line and the surface, equation 4-1. A [`Kernel`] is a choice of that number.

mod decision;
mod line;
mod pixel;
mod real;
mod shading;
mod sphere;
mod surface;
mod tetrahedron;
mod vector;
mod view;

use rayon::ThreadPool;
use rayon::prelude::*;

use crate::camera::sin_cos;
use crate::{Image, Scene, Stage};
pub use decision::{Decision, Seen};
use pixel::Picture;

/// How numbers are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Kernel {
    /// f64 through and through, rounded to f32 once at the end.
    #[default]
    Double,
}

impl Kernel {
    /// Every kernel.
    pub const ALL: [Kernel; 1] = [Kernel::Double];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::Double => "double",
        }
    }
}

/// A tracer that cannot be made, or a frame that cannot be traced.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// α is a NaN or an infinity.
    #[error("α = {0} is not an angle: give a finite number of radians")]
    Angle(f64),
    /// The worker threads could not be started.
    #[error("{threads} threads cannot be started: {source}; ask for fewer")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// Why there are none.
        source: rayon::ThreadPoolBuildError,
    },
}

/// Traces pictures: made once, used for any number of frames.
pub struct Tracer {
    kernel: Kernel,
    pool: ThreadPool,
}

impl Tracer {
    /// A tracer with `threads` worker threads; 0 is one a core. Their number changes no bit of a picture.
    ///
    /// # Errors
    /// [`TraceError::Threads`] where the system refuses the threads.
    pub fn new(kernel: Kernel, threads: usize) -> Result<Tracer, TraceError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        Ok(Tracer {
            kernel,
            pool: pool.map_err(|source| TraceError::Threads { threads, source })?,
        })
    }

    /// The kernel it was made with.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// Traces `scene` in `stage`, seen at angle `alpha` in radians, into the whole of `image`.
    ///
    /// # Errors
    /// [`TraceError::Angle`] where `alpha` is not finite; the image is left as it was.
    pub fn trace(
        &mut self,
        scene: &Scene,
        stage: Stage,
        alpha: f64,
        image: &mut Image,
    ) -> Result<(), TraceError> {
        self.trace_rows(scene, stage, alpha, image, None)
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
        self.trace_rows(scene, stage, alpha, image, Some(&mut decisions))?;
        Ok(decisions)
    }

    fn trace_rows(
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
        let (sin, cos) = sin_cos(alpha);
        let size = image.size();
        let Ok(picture) = match self.kernel {
            Kernel::Double => Picture::<f64>::new(scene, stage, sin, cos, size),
        };
        let width = size as usize;
        let trace_row = |row: usize, samples: &mut [f32], decisions: Option<&mut [Decision]>| {
            let mut decisions = decisions.into_iter().flatten();
            for (column, sample) in samples.chunks_exact_mut(3).enumerate() {
                let Ok((decision, color)) = picture.pixel(column as u32, row as u32);
                sample.copy_from_slice(&color);
                if let Some(place) = decisions.next() {
                    *place = decision;
                }
            }
        };
        let rows = image
            .samples_mut()
            .par_chunks_exact_mut(3 * width)
            .enumerate();
        self.pool.install(|| match decisions {
            Some(decisions) => rows
                .zip(decisions.par_chunks_exact_mut(width))
                .for_each(|((row, samples), decisions)| trace_row(row, samples, Some(decisions))),
            None => rows.for_each(|(row, samples)| trace_row(row, samples, None)),
        });
        Ok(())
    }
}
