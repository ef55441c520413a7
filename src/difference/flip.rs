//! FLIP: how different two pictures look to whoever flips between them.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström and M. D. Fairchild: FLIP:
//! A Difference Evaluator for Alternating Images, Proceedings of the ACM on Computer Graphics and
//! Interactive Techniques 3(2), 2020, <https://doi.org/10.1145/3406183>. The constants are those of
//! the published code. Everything is computed in f64, by arithmetic and `libm`: a mean is the same
//! number on every machine.

mod color;
mod filters;
mod neighborhood;

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::num::NonZeroUsize;
use std::ops::{Range, RangeInclusive};
use std::thread;

use super::{SizesDiffer, check_sizes};
use crate::image::Raster;
use color::ColorSpace;
use filters::{Filters, Seen};
use neighborhood::Neighborhood;

/// The pixels per degree of the visual field that the paper assumes: those of a display of 3840
/// pixels and 0.7 m width, 0.7 m away.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// The pixels per degree of displays.
pub const PIXELS_PER_DEGREE_RANGE: RangeInclusive<f64> = 1.0..=1000.0;

/// FLIP of two pictures that cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlipError {
    /// The two pictures are not of one size.
    #[error(transparent)]
    Sizes(#[from] SizesDiffer),
    /// Not in [`PIXELS_PER_DEGREE_RANGE`].
    #[error("no display has {0} pixels per degree: choose a number from 1 to 1000")]
    PixelsPerDegree(f64),
}

/// The mean FLIP error of `image` against `truth`, from 0 to 1, on a display of so many pixels per
/// degree of the visual field.
///
/// Samples are taken for what a display shows: encoded by the curve of sRGB, and clamped to 0 … 1,
/// a NaN to 0. Light, as renderers write it to EXR files, has to be encoded before.
///
/// # Errors
/// [`FlipError`] unless both pictures have one size, and `pixels_per_degree` is in
/// [`PIXELS_PER_DEGREE_RANGE`].
///
/// ```
/// use firsthit::difference::{PIXELS_PER_DEGREE, flip};
/// use firsthit::image::Raster;
///
/// let black = Raster::new(40, 30)?;
/// let mut dot = black.clone();
/// dot.samples_mut()[..3].fill(1.0);
/// assert_eq!(flip(&black, &black, PIXELS_PER_DEGREE)?, 0.0);
/// assert!(flip(&dot, &black, PIXELS_PER_DEGREE)? > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn flip(image: &Raster, truth: &Raster, pixels_per_degree: f64) -> Result<f64, FlipError> {
    check_sizes(image, truth)?;
    if !PIXELS_PER_DEGREE_RANGE.contains(&pixels_per_degree) {
        return Err(FlipError::PixelsPerDegree(pixels_per_degree));
    }
    let colors = ColorSpace::new();
    let filters = Filters::new(pixels_per_degree);
    let sums_of_rows = |rows: Range<usize>| -> Vec<f64> {
        let around = |image| Neighborhood::new(image, &colors, filters.radius(), rows.start);
        let mut neighborhoods = [image, truth].map(around);
        let sum_of_row = |_| {
            let seen = |neighborhood| filters.seen(neighborhood, &colors);
            let [seen, true_seen] = neighborhoods.each_ref().map(seen);
            neighborhoods.iter_mut().for_each(Neighborhood::advance);
            let pixels = seen.iter().zip(&true_seen);
            pixels.map(|(a, b)| error(a, b, &colors)).sum()
        };
        rows.clone().map(sum_of_row).collect()
    };
    let sums = in_bands(image.height() as usize, sums_of_rows);
    let sum: f64 = sums.iter().sum();
    Ok(sum / (f64::from(image.width()) * f64::from(image.height())))
}

/// What there is for each of so many rows, by a thread for each core and a band of rows for each
/// thread.
fn in_bands(rows: usize, band: impl Fn(Range<usize>) -> Vec<f64> + Sync) -> Vec<f64> {
    let threads = thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let height = rows.div_ceil(threads);
    let bands = (0..threads).map(|number| {
        let first = (number * height).min(rows);
        first..(first + height).min(rows)
    });
    let bands = bands.filter(|rows| !rows.is_empty());
    thread::scope(|scope| {
        let band = &band;
        let workers: Vec<_> = bands
            .map(|rows| {
                let own = rows.clone();
                let worker = thread::Builder::new().spawn_scoped(scope, move || band(own));
                (rows, worker)
            })
            .collect();
        // Where the system has no thread for a band, it is done here.
        let done = workers.into_iter().flat_map(|(rows, worker)| {
            let done = worker.ok().and_then(|worker| worker.join().ok());
            done.unwrap_or_else(|| band(rows))
        });
        done.collect()
    })
}

/// The error of a pixel, the paper's final difference: that of its colours, and larger where edges
/// or points of luminance differ.
fn error(a: &Seen, b: &Seen, colors: &ColorSpace) -> f64 {
    let edges = (a.edge - b.edge).abs();
    let points = (a.point - b.point).abs();
    let features = (FRAC_1_SQRT_2 * edges.max(points)).sqrt();
    libm::pow(colors.error(a.color, b.color), 1.0 - features)
}
