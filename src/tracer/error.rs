//! The errors of tracers and of requests to them.

use std::io;

use crate::image::MAX_SIZE;

/// A tracer that cannot be made, or a frame that cannot be traced.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TraceError {
    /// α is a NaN or an infinity.
    #[error("α = {0} is not an angle: give a finite number of radians")]
    Angle(f64),
    /// The pixel is not in the picture, or there is no picture of this size.
    #[error("column {column}, row {row} is not in a picture of {size} × {size} pixels: both count from 0 to {}", (*size).min(MAX_SIZE).saturating_sub(1))]
    Pixel {
        /// Its column, counted from the left.
        column: u32,
        /// Its row, counted from the bottom.
        row: u32,
        /// N.
        size: u32,
    },
    /// The kernel [`Kernel::Listing`](crate::Kernel::Listing) and a scene that is not of the
    /// document's shape.
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
    /// The frame was cancelled by [`Progress::cancel`](super::Progress::cancel): some rows of the
    /// image show it, and some what was there before.
    #[error("the frame was cancelled: trace it again")]
    Cancelled,
    /// There is no memory for the decisions.
    #[error("not enough memory for the decisions of {pixels} pixels: choose a smaller picture")]
    Memory {
        /// N².
        pixels: usize,
    },
    /// The worker threads could not be started.
    #[error("{threads} threads cannot be started: {source}; ask for fewer")]
    Threads {
        /// How many were asked for.
        threads: usize,
        /// Why there are none.
        source: io::Error,
    },
}
