//! Shades a run: neighbouring pixels of a sphere in a row, many at a time.

use std::ops::Range;

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::decision::Decision;
use crate::tracer::scanline::grid::{Columns, Grid};
use crate::tracer::scanline::shade::equation::{Classes, Hits, RowShader};
use crate::tracer::scanline::shade::policy::{LaneVector, Policy, Samples};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::ZONES;
use crate::tracer::scanline::write::pixels::{interleaved, store};
use crate::tracer::view_space::PIXEL;

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
    /// How many pixels they are.
    pub(crate) count: usize,
    /// Where the sphere's zones and highlight lie in the row; `None` where each pixel finds out by
    /// itself, which only the certified shader can.
    pub(crate) columns: Option<RunColumns>,
    /// Whether all pixels face the light, or the stage has no shadows.
    pub(crate) is_facing: bool,
    /// The casters that may cast a shadow on any of the pixels; `None` if all may.
    pub(crate) casters: Option<&'r [usize]>,
    /// The samples of the row from the first pixel on, and what follows them in memory.
    pub(crate) samples: &'r mut [f32],
    /// Those of the run's pixels.
    pub(crate) decisions: Option<&'r mut [Decision]>,
    /// The columns left in doubt.
    pub(crate) doubts: &'r mut Vec<u32>,
}

/// Some pixels of a run: their samples in the light, and a bit for each that tells whether it is in
/// shadow, and whether that is in doubt.
struct Part<S: Simd, P: Policy<S>> {
    samples: Samples<LaneVector<S, P>>,
    in_shadow: u64,
    in_doubt: u64,
}

impl<S: Simd, P: Policy<S>> Clone for Part<S, P> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd, P: Policy<S>> Copy for Part<S, P> {}

// No closures below: only what is inlined into a dispatch is compiled with the instructions of its
// level, and closures that are given to other functions are not.
//
// Few branches, too: most runs of a crowd are a few pixels at the border of a shadow, and what they
// show cannot be predicted.

impl Run<'_> {
    /// The hits of the pixels from number `first` on, in two vectors if one does not hold all.
    #[inline(always)]
    fn hits<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        first: usize,
    ) -> [Hits<LaneVector<S, P>>; 2] {
        let lanes = LaneVector::<S, P>::LEN;
        let x = self.grid.coordinate(self.from + first as u32);
        let mut hits = [row.hits(x); 2];
        if lanes < S::f32s::LEN && first + lanes < self.count {
            hits[1] = row.hits(x + PIXEL * lanes as f64);
        }
        hits
    }

    /// Shades pixels with these hits: the first of them, as many as `here`, are of the run.
    #[inline(always)]
    fn part<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        shaded: &ShadedSphere<'_>,
        hits: &Hits<LaneVector<S, P>>,
        (here, known): (usize, Option<Classes>),
    ) -> Part<S, P> {
        let light = row.value(&shaded.constants.n_dot_l, hits);
        let (in_shadow, in_doubt) = self.shadowed(row, shaded, hits, light);
        let Classes {
            zone,
            bright,
            beyond,
        } = match known {
            Some(classes) => classes,
            None => row.classify(hits, first_bits(here)),
        };
        Part {
            samples: row.lit(hits, light, (zone, bright)),
            in_shadow: in_shadow & !beyond,
            in_doubt: in_doubt | beyond,
        }
    }

    /// A bit for each pixel: whether it is in shadow, and whether that is in doubt. `light` is their
    /// n·l.
    #[inline(always)]
    fn shadowed<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        shaded: &ShadedSphere<'_>,
        hits: &Hits<LaneVector<S, P>>,
        light: LaneVector<S, P>,
    ) -> (u64, u64) {
        let (mut dark, mut lit) = (row.mask(false), row.mask(true));
        if !self.is_facing {
            (dark, lit) = P::is_not_negative(-light, shaded.constants.n_dot_l.error);
        }
        match self.casters {
            Some(casters) => {
                for &caster in casters {
                    let (behind, free) = row.behind(&shaded.casters[caster], hits);
                    dark |= behind;
                    lit &= free;
                }
            }
            None => {
                for caster in shaded.casters {
                    let (behind, free) = row.behind(caster, hits);
                    dark |= behind;
                    lit &= free;
                }
            }
        }
        (dark.to_bitmask(), (!(dark | lit)).to_bitmask())
    }

    /// What is known of the pixels from number `first` on, as many as `here`.
    #[inline(always)]
    fn classes<S: Simd>(&self, first: usize, here: usize) -> Option<Classes> {
        let RunColumns { zones, bright } = self.columns?;
        let begin = self.from + first as u32;
        let is_out = |(from, to): Columns| begin < from || begin + here as u32 > to;
        let [innermost, inner] = zones;
        let (end, (from, to)) = (begin + S::f32s::LEN as u32, bright);
        let before = |column: u32| first_bits((column.clamp(begin, end) - begin) as usize);
        Some(Classes {
            zone: usize::from(is_out(innermost)) + usize::from(is_out(inner)),
            bright: before(to) & !before(from),
            beyond: 0,
        })
    }

    /// Writes the decisions of pixels, whose bits in `in_shadow` tell which are dark.
    #[inline(always)]
    fn write_decisions(&mut self, shaded: &ShadedSphere<'_>, pixels: Range<usize>, in_shadow: u64) {
        if let Some(decisions) = &mut self.decisions {
            for (i, decision) in decisions[pixels].iter_mut().enumerate() {
                *decision = if in_shadow >> i & 1 == 1 {
                    shaded.in_shadow.decision
                } else {
                    shaded.in_light
                };
            }
        }
    }
}

/// So many bits, fewer than 64.
#[inline(always)]
fn first_bits(count: usize) -> u64 {
    (1 << count) - 1
}

/// Shades a run of pixels that see a sphere.
#[inline(always)]
pub(crate) fn shade<S: Simd, P: Policy<S>>(simd: S, shaded: &ShadedSphere<'_>, run: &mut Run<'_>) {
    // Each turn writes the pixels of one vector of f32s, which are those of two vectors of f64s.
    let (width, lanes) = (S::f32s::LEN, LaneVector::<S, P>::LEN);
    let row = RowShader::<S, P>::new(simd, &shaded.constants, run.y);
    let in_shadow_color = shaded.in_shadow.color();
    let last = run.count.saturating_sub(width);
    let (mut done, mut first) = (0, 0);
    let mut hits = run.hits(&row, first);
    while done < run.count {
        // The last vector may overlap the one before.
        let next = (first + width).min(last);
        // Roots take long, so that of the next vector is begun before this one is used.
        let now = hits;
        if next > first {
            hits = run.hits(&row, next);
        }
        let here = width.min(run.count - first);
        let mut known = run.classes::<S>(first, here);
        let low = run.part(&row, shaded, &now[0], (here.min(lanes), known));
        let mut high = low;
        if here > lanes {
            if let Some(classes) = &mut known {
                classes.bright >>= lanes;
            }
            high = run.part(&row, shaded, &now[1], (here - lanes, known));
        }
        let all = first_bits(here);
        let in_shadow = (low.in_shadow | high.in_shadow << lanes) & all;
        let (mut samples, doubts) = P::round(low.samples, high.samples);
        let is_dark = S::mask32s::from_bitmask(simd, in_shadow);
        for (sample, dark) in samples.iter_mut().zip(in_shadow_color) {
            *sample = is_dark.select(S::f32s::splat(simd, dark), *sample);
        }
        store(
            simd,
            &mut run.samples[3 * first..],
            &interleaved(simd, samples),
            here,
        );
        run.write_decisions(shaded, first..first + here, in_shadow);
        let in_doubt = low.in_doubt | high.in_doubt << lanes | doubts & !in_shadow;
        let mut doubts = in_doubt & all;
        while doubts != 0 {
            // Both vectors may doubt a pixel in which they overlap.
            let doubt = run.from + first as u32 + doubts.trailing_zeros();
            if doubt >= run.from + done as u32 || !run.doubts.contains(&doubt) {
                run.doubts.push(doubt);
            }
            doubts &= doubts - 1;
        }
        done = first + here;
        first = next;
    }
}
