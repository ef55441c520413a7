//! Shades a run: neighbouring pixels of a sphere in a row, many at a time.

use std::ops::Range;

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::decision::Decision;
use crate::tracer::scanline::grid::{Columns, Grid};
use crate::tracer::scanline::shade::equation::{Classes, RowShader};
use crate::tracer::scanline::shade::policy::{LaneVector, Policy};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::ZONES;
use crate::tracer::scanline::write::paint::{Paint, fill};
use crate::tracer::view_space::PIXEL;

/// What the shading of a run needs, kept from run to run.
#[derive(Default)]
pub(crate) struct RunScratch {
    /// The casters that may cast a shadow on any pixel of the run.
    pub(crate) casters: Vec<usize>,
    /// The columns left in doubt.
    pub(crate) doubts: Vec<u32>,
}

/// The columns in each zone of a sphere but the outermost, and those that may have a highlight.
#[derive(Clone, Copy)]
pub(crate) struct RunColumns {
    pub(crate) zones: [Columns; ZONES - 1],
    pub(crate) bright: Columns,
}

/// The pixels of a run: where they are, and where their samples go.
pub(crate) struct Run<'r> {
    pub(crate) grid: Grid,
    /// Y.
    pub(crate) y: f64,
    /// The first column.
    pub(crate) from: u32,
    /// Where the sphere's zones and highlight lie in the row; `None` where each pixel finds out by
    /// itself, which only the certified shader can.
    pub(crate) columns: Option<RunColumns>,
    /// Whether all pixels face the light, or the stage has no shadows.
    pub(crate) is_facing: bool,
    pub(crate) samples: &'r mut [f32],
    pub(crate) decisions: Option<&'r mut [Decision]>,
    /// What pixels in shadow show.
    pub(crate) in_shadow: &'r Paint,
    pub(crate) scratch: &'r mut RunScratch,
}

// No closures below: only what is inlined into a dispatch is compiled with the instructions of its
// level, and closures that are given to other functions are not.

impl Run<'_> {
    /// X of a pixel, and of the pixel `on` columns to the right.
    #[inline(always)]
    fn x(&self, first: usize, on: usize) -> [f64; 2] {
        let x = self.grid.coordinate(self.from + first as u32);
        [x, x + PIXEL * on as f64]
    }

    /// What is known of the first `here` of `width` pixels from pixel `first` on.
    #[inline(always)]
    fn classify<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        first: usize,
        here: usize,
    ) -> Classes {
        let begin = self.from + first as u32;
        let Some(RunColumns { zones, bright }) = self.columns else {
            let lanes = LaneVector::<S, P>::LEN;
            let last = self.grid.coordinate(begin + here as u32 - 1);
            return row.classify(self.x(first, lanes), last, u64::MAX >> (64 - here));
        };
        let is_out = |(from, to): Columns| begin < from || begin + here as u32 > to;
        let [innermost, inner] = zones;
        let (end, (from, to)) = (begin + S::f32s::LEN as u32, bright);
        Classes {
            zone: usize::from(is_out(innermost)) + usize::from(is_out(inner)),
            bright: (1 << (to.clamp(begin, end) - begin)) - (1 << (from.clamp(begin, end) - begin)),
            beyond: 0,
        }
    }

    /// Writes the pixels whose bit is set in `in_shadow`.
    #[inline(always)]
    fn darken(&mut self, pixels: Range<usize>, in_shadow: u64) {
        if in_shadow != 0 {
            let samples = self.samples[3 * pixels.start..3 * pixels.end].chunks_exact_mut(3);
            for (i, pixel) in samples.enumerate() {
                if in_shadow >> i & 1 == 1 {
                    pixel.copy_from_slice(&self.in_shadow.color());
                }
            }
        }
    }

    /// Writes the decisions of pixels, whose bits in `in_shadow` tell which are dark.
    #[inline(always)]
    fn write_decisions(&mut self, shaded: &ShadedSphere<'_>, pixels: Range<usize>, in_shadow: u64) {
        if let Some(decisions) = &mut self.decisions {
            for (i, decision) in decisions[pixels].iter_mut().enumerate() {
                *decision = if in_shadow >> i & 1 == 1 {
                    self.in_shadow.decision
                } else {
                    shaded.in_light
                };
            }
        }
    }
}

/// Shades a run of pixels that see a sphere.
#[inline(always)]
pub(crate) fn shade<S: Simd, P: Policy<S>>(simd: S, shaded: &ShadedSphere<'_>, run: &mut Run<'_>) {
    // Each turn writes the pixels of one vector of f32s, which are those of two vectors of f64s.
    let (width, lanes) = (S::f32s::LEN, LaneVector::<S, P>::LEN);
    let row = RowShader::<S, P>::new(simd, &shaded.constants, run.y);
    let tests_shadows = !run.is_facing || !run.scratch.casters.is_empty();
    let count = run.samples.len() / 3;
    let last = count.saturating_sub(width);
    let (mut done, mut first) = (0, 0);
    let mut lights = row.lights(run.x(first, lanes));
    while done < count {
        // The last vector may overlap the one before.
        let next = (first + width).min(last);
        // Roots take long, so that of the next vector is begun before this one is used.
        let now = lights;
        if next > first {
            lights = row.lights(run.x(next, lanes));
        }
        let here = width.min(count - first);
        let all = u64::MAX >> (64 - here);
        let column = run.from + first as u32;
        let x = run.x(first, lanes);
        let (mut in_shadow, mut in_doubt) = (0, 0);
        if tests_shadows {
            // The second vector of a short run may hold no pixel.
            for half in 0..here.div_ceil(lanes) {
                let (dark, doubts) = shadowed(&row, shaded, run, x[half], now[half]);
                in_shadow |= dark << (half * lanes);
                in_doubt |= doubts << (half * lanes);
            }
        }
        let Classes {
            zone,
            bright,
            beyond,
        } = run.classify(&row, first, here);
        in_shadow &= !beyond;
        in_doubt |= beyond;
        let samples = &mut run.samples[3 * first..3 * (first + here)];
        if in_shadow & all == all {
            fill(simd, samples, here, run.in_shadow);
        } else {
            let ambient = row.ambient(zone);
            let lit_low = row.lit(x[0], now[0], &ambient, (zone, bright));
            let mut lit_high = lit_low;
            if lanes < width {
                lit_high = row.lit(x[1], now[1], &ambient, (zone, bright >> lanes));
            }
            let (rounded, doubts) = P::round(lit_low, lit_high);
            store::<S>(samples, &rounded);
            in_doubt = (in_doubt | doubts) & !in_shadow;
            run.darken(first..first + here, in_shadow);
        }
        run.write_decisions(shaded, first..first + here, in_shadow);
        let mut doubts = in_doubt & all;
        while doubts != 0 {
            // Both vectors may doubt a pixel in which they overlap.
            let doubt = column + doubts.trailing_zeros();
            if doubt >= run.from + done as u32 || !run.scratch.doubts.contains(&doubt) {
                run.scratch.doubts.push(doubt);
            }
            doubts &= doubts - 1;
        }
        done = first + here;
        first = next;
    }
}

/// A bit for each pixel from X = `x` on: whether it is in shadow, and whether that is in doubt.
/// `light` is their n·l.
#[inline(always)]
fn shadowed<S: Simd, P: Policy<S>>(
    row: &RowShader<'_, S, P>,
    shaded: &ShadedSphere<'_>,
    run: &Run<'_>,
    x: f64,
    light: LaneVector<S, P>,
) -> (u64, u64) {
    let (mut dark, mut lit) = (row.mask(false), row.mask(true));
    if !run.is_facing {
        (dark, lit) = P::is_not_negative(-light, shaded.constants.n_dot_l.error);
    }
    if !run.scratch.casters.is_empty() {
        let hits = row.hits(x);
        for &caster in &run.scratch.casters {
            let (behind, free) = row.behind(&shaded.casters[caster], &hits);
            dark |= behind;
            lit &= free;
        }
    }
    (dark.to_bitmask(), (!(dark | lit)).to_bitmask())
}

/// Stores three vectors of samples, or as many of them as `samples` holds.
#[inline(always)]
fn store<S: Simd>(samples: &mut [f32], vectors: &[S::f32s; 3]) {
    let width = S::f32s::LEN;
    if samples.len() == 3 * width {
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut samples[i * width..(i + 1) * width]);
        }
    } else {
        let mut all = [0.0; 3 * 16];
        for (i, vector) in vectors.iter().enumerate() {
            vector.store_slice(&mut all[i * width..(i + 1) * width]);
        }
        // Copies of constant length are moves instead of calls.
        let (pixels, _) = samples.as_chunks_mut::<3>();
        for (pixel, from) in pixels.iter_mut().zip(all.as_chunks::<3>().0) {
            *pixel = *from;
        }
    }
}
