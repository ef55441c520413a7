//! Times: rounds of frames against filling the same picture as often, one after the other.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::fill::{Stores, fill};
use crate::tracer::TraceError;
use crate::tracer::pool::Pool;
use crate::{Image, Kernel, Scene, Stage, Tracer};

/// Few samples of a slow kernel, many of a fast one: about this long for each row and number of
/// threads.
const MEASURING_TIME: Duration = Duration::from_millis(1500);

/// The fewest samples of which a median is taken.
pub(super) const MIN_SAMPLES: usize = 3;

/// The most samples: more do not change the median.
const MAX_SAMPLES: usize = 101;

/// The middle of some measurements, and how far they spread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Spread {
    /// As many are below it as above.
    pub(super) median: f64,
    /// The least.
    pub(super) min: f64,
    /// The most.
    pub(super) max: f64,
}

impl Spread {
    /// The spread of `values`; `None` of none.
    pub(super) fn of(mut values: Vec<f64>) -> Option<Spread> {
        values.sort_by(f64::total_cmp);
        let (&min, &max) = (values.first()?, values.last()?);
        let middle = values.len() / 2;
        let median = match values.len() % 2 {
            0 => (values[middle - 1] + values[middle]) / 2.0,
            _ => values[middle],
        };
        Some(Spread { median, min, max })
    }
}

/// How fast one kernel traces some frames, with one number of threads.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Timing {
    /// Threads that traced, and filled.
    pub(super) threads: usize,
    /// The vector instructions that the kernel used, as [`Simd`](crate::tracer::Simd) names them;
    /// "none" if none.
    pub(super) simd: &'static str,
    /// Rounds measured.
    pub(super) samples: usize,
    /// Milliseconds a frame.
    pub(super) ms: Spread,
    /// Milliseconds to fill the picture with one colour, measured between the rounds.
    pub(super) fill_ms: Spread,
    /// The time of a round by the time of filling as often.
    pub(super) fill_ratio: Spread,
    /// The same with each frame traced over its predecessor, by [`Tracer::retrace`].
    pub(super) retained_fill_ratio: Spread,
}

/// The fastest fill for one size and at most some threads.
pub(super) struct Filler {
    stores: Stores,
    pool: Pool,
    /// Whether all threads of the pool fill, and not this one alone.
    shared: bool,
}

impl Filler {
    /// Times every kind of stores, on one thread and on all, and keeps the fastest.
    pub(super) fn fastest(threads: usize, image: &mut Image) -> Result<Filler, TraceError> {
        let pool = Pool::new(threads).map_err(|source| TraceError::Threads { threads, source })?;
        let variants = if threads == 1 {
            &[false][..]
        } else {
            &[false, true]
        };
        let mut filler = Filler {
            stores: Stores::Plain,
            pool,
            shared: false,
        };
        let mut fastest = (Stores::Plain, false);
        let mut least = Duration::MAX;
        // In turn, so that a slow moment of the machine hits all of them.
        for _ in 0..9 {
            for variant in variants
                .iter()
                .flat_map(|&shared| Stores::ALL.map(|stores| (stores, shared)))
            {
                (filler.stores, filler.shared) = variant;
                // Twice: the first fill finds the caches that another variant has left.
                filler.fill(image);
                let start = Instant::now();
                filler.fill(image);
                let time = start.elapsed();
                if time < least {
                    (fastest, least) = (variant, time);
                }
            }
        }
        (filler.stores, filler.shared) = fastest;
        Ok(filler)
    }

    fn fill(&mut self, image: &mut Image) {
        let color = std::hint::black_box([0.8, 0.8, 0.8]);
        let pool = self.shared.then_some(&mut self.pool);
        fill(image.samples_mut(), color, self.stores, pool);
        std::hint::black_box(image.samples());
    }

    /// Seconds to fill the picture once.
    pub(super) fn seconds(&mut self, image: &mut Image) -> f64 {
        // Twice: the first fill finds the caches that others have left.
        self.fill(image);
        let start = Instant::now();
        self.fill(image);
        start.elapsed().as_secs_f64().max(1e-9)
    }

    /// How it fills, for people.
    pub(super) fn how(&self) -> String {
        let threads = if self.shared { self.pool.threads() } else { 1 };
        let s = if threads == 1 { "" } else { "s" };
        format!("{} stores, {threads} thread{s}", self.stores)
    }
}

/// Times `tracer` on the frames at `angles`, in turn with `filler`.
///
/// A sample is a whole round: all frames in order, on one tracer, into one picture, everything that
/// a frame needs inside; and then filling the picture as often.
pub(super) fn time(
    tracer: &mut Tracer,
    threads: usize,
    (scene, stage, angles): (&Scene, Stage, &[f64]),
    image: &mut Image,
    filler: &mut Filler,
) -> Result<Option<Timing>, TraceError> {
    // A picture of its own, so that each frame finds its predecessor.
    let mut kept = image.clone();
    let (mut ms, mut fill_ms) = (Vec::new(), Vec::new());
    let (mut ratios, mut retained) = (Vec::new(), Vec::new());
    let count = angles.len() as f64;
    let begin = Instant::now();
    while !is_enough(ms.len(), begin, 1) {
        let round = time_round(angles, |alpha| tracer.trace(scene, stage, alpha, image))?;
        std::hint::black_box(image.samples());
        let fills = time_round(angles, |_| {
            filler.fill(image);
            Ok(())
        })?;
        let over = time_round(angles, |alpha| {
            tracer
                .retrace(scene, stage, alpha, &mut kept)
                .map(|_rows| ())
        })?;
        std::hint::black_box(kept.samples());

        ms.push(1e3 * round / count);
        fill_ms.push(1e3 * fills / count);
        ratios.push(round / fills);
        retained.push(over / fills);
    }
    let samples = ms.len();
    let simd = match tracer.kernel() {
        Kernel::Exact | Kernel::Fast | Kernel::Double => tracer.simd().name(),
        // These trace pixel by pixel.
        Kernel::Listing | Kernel::Reference => "none",
    };
    let spreads = [ms, fill_ms, ratios, retained].map(Spread::of);
    let [
        Some(ms),
        Some(fill_ms),
        Some(fill_ratio),
        Some(retained_fill_ratio),
    ] = spreads
    else {
        return Ok(None);
    };
    Ok(Some(Timing {
        threads,
        simd,
        samples,
        ms,
        fill_ms,
        fill_ratio,
        retained_fill_ratio,
    }))
}

/// Whether so many samples suffice, of each of some `rows` that are measured in turn since `begin`.
pub(super) fn is_enough(samples: usize, begin: Instant, rows: usize) -> bool {
    let time = MEASURING_TIME.mul_f64(rows as f64);
    samples >= MAX_SAMPLES || (samples >= MIN_SAMPLES && begin.elapsed() >= time)
}

/// Seconds for all frames at `angles`. The last of them comes before the first too, and does not
/// count then: what is made at first use is made, threads are awake, and caches hold what a frame
/// finds in them when others of its kind came before.
pub(super) fn time_round(
    angles: &[f64],
    mut frame: impl FnMut(f64) -> Result<(), TraceError>,
) -> Result<f64, TraceError> {
    if let Some(&last) = angles.last() {
        frame(last)?;
    }
    let start = Instant::now();
    for &alpha in angles {
        frame(alpha)?;
    }
    // A clock that stood still must not make a ratio infinite.
    Ok(start.elapsed().as_secs_f64().max(1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_median_is_the_middle() {
        let spread = |values: &[f64]| Spread::of(values.to_vec()).map(|s| (s.median, s.min, s.max));
        assert_eq!(spread(&[]), None);
        assert_eq!(spread(&[2.0]), Some((2.0, 2.0, 2.0)));
        assert_eq!(spread(&[9.0, 1.0, 2.0]), Some((2.0, 1.0, 9.0)));
        assert_eq!(spread(&[9.0, 1.0, 2.0, 4.0]), Some((3.0, 1.0, 9.0)));
    }
}
