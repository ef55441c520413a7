//! Shades a run: neighbouring pixels of a sphere in a row, many at a time.

use std::ops::Range;

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::decision::Decision;
use crate::tracer::scanline::grid::{Columns, Grid};
use crate::tracer::scanline::shade::equation::{Classes, Hits, RowShader};
use crate::tracer::scanline::shade::policy::{LaneVector, Policy};
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

/// One number for each pixel that a turn shades: in two vectors, of which the second is not used
/// where one holds all.
type Pair<V> = [V; 2];

// No vectors in closures below: only what is inlined into a dispatch is compiled with the
// instructions of its level, and closures that are given to other functions are not.
//
// Few branches, too: most runs of a crowd are a few pixels at the border of a shadow, and what they
// show cannot be predicted.

impl Run<'_> {
    /// The hits of the pixels from number `first` on.
    #[inline(always)]
    fn hits<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        first: usize,
    ) -> Pair<Hits<LaneVector<S, P>>> {
        let lanes = LaneVector::<S, P>::LEN;
        let x = self.grid.coordinate(self.from + first as u32);
        let mut hits = [row.hits(x); 2];
        if halves::<S, P>() == 2 && first + lanes < self.count {
            hits[1] = row.hits(x + PIXEL * lanes as f64);
        }
        hits
    }

    /// A bit for each of the pixels with these hits, as many as `here`: whether it is in shadow, and
    /// whether that is in doubt. `lights` is their n·l.
    #[inline(always)]
    fn shadowed<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        shaded: &ShadedSphere<'_>,
        (here, hits): (usize, &Pair<Hits<LaneVector<S, P>>>),
        lights: &Pair<LaneVector<S, P>>,
    ) -> (u64, u64) {
        if self.is_facing && self.casters.is_some_and(<[usize]>::is_empty) {
            return (0, 0);
        }
        let (mut dark, mut lit) = ([row.mask(false); 2], [row.mask(true); 2]);
        if !self.is_facing {
            for half in 0..halves::<S, P>() {
                let error = shaded.constants.n_dot_l.error;
                (dark[half], lit[half]) = P::is_not_negative(-lights[half], error);
            }
        }
        let count = self.casters.map_or(shaded.casters.len(), <[usize]>::len);
        for i in 0..count {
            let caster = &shaded.casters[self.casters.map_or(i, |casters| casters[i])];
            for half in 0..halves::<S, P>() {
                // The second vector of a short run holds none of its pixels.
                if half * LaneVector::<S, P>::LEN >= here {
                    break;
                }
                let (behind, free) = row.behind(caster, &hits[half]);
                dark[half] |= behind;
                lit[half] &= free;
            }
        }
        let (mut in_shadow, mut in_doubt) = (0, 0);
        for half in 0..halves::<S, P>() {
            let shift = half * LaneVector::<S, P>::LEN;
            in_shadow |= dark[half].to_bitmask() << shift;
            in_doubt |= (!(dark[half] | lit[half])).to_bitmask() << shift;
        }
        (in_shadow, in_doubt)
    }

    /// What is known of the pixels from number `first` on, as many as `here`.
    #[inline(always)]
    fn classify<S: Simd, P: Policy<S>>(
        &self,
        row: &RowShader<'_, S, P>,
        (first, here): (usize, usize),
        hits: &Pair<Hits<LaneVector<S, P>>>,
    ) -> Classes {
        let Some(RunColumns { zones, bright }) = self.columns else {
            let lanes = LaneVector::<S, P>::LEN;
            let mut classes = row.classify(&hits[0], first_bits(here.min(lanes)));
            if halves::<S, P>() == 2 {
                let second = row.classify(&hits[1], first_bits(here) >> lanes);
                classes.zone = classes.zone.max(second.zone);
                classes.bright |= second.bright << lanes;
                classes.beyond |= second.beyond << lanes;
            }
            return classes;
        };
        let begin = self.from + first as u32;
        let is_out = |(from, to): Columns| begin < from || begin + here as u32 > to;
        let [innermost, inner] = zones;
        let (end, (from, to)) = (begin + S::f32s::LEN as u32, bright);
        let before = |column: u32| first_bits((column.clamp(begin, end) - begin) as usize);
        Classes {
            zone: usize::from(is_out(innermost)) + usize::from(is_out(inner)),
            bright: before(to) & !before(from),
            beyond: 0,
        }
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

    /// Notes the pixels in doubt: their bits, from pixel `first` on. All pixels before `done` were
    /// noted in turns before.
    #[inline(always)]
    fn note_doubts(&mut self, first: usize, done: usize, mut doubts: u64) {
        while doubts != 0 {
            // Both vectors may doubt a pixel in which they overlap.
            let doubt = self.from + first as u32 + doubts.trailing_zeros();
            if doubt >= self.from + done as u32 || !self.doubts.contains(&doubt) {
                self.doubts.push(doubt);
            }
            doubts &= doubts - 1;
        }
    }
}

/// The number of vectors of a policy's floats that hold as many pixels as one of f32s.
#[inline(always)]
const fn halves<S: Simd, P: Policy<S>>() -> usize {
    S::f32s::LEN / LaneVector::<S, P>::LEN
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
        let mut lights = [row.value(&shaded.constants.n_dot_l, &now[0]); 2];
        if halves::<S, P>() == 2 {
            lights[1] = row.value(&shaded.constants.n_dot_l, &now[1]);
        }
        let (in_shadow, in_doubt) = run.shadowed(&row, shaded, (here, &now), &lights);
        let Classes {
            zone,
            bright,
            beyond,
        } = run.classify(&row, (first, here), &now);
        let mut samples = [row.lit(lights[0], zone), row.lit(lights[1], zone)];
        for half in 0..halves::<S, P>() {
            let bright = bright >> (half * lanes);
            if bright != 0 {
                row.add_highlight(&mut samples[half], &now[half], (zone, bright));
            }
        }
        let [low, high] = samples;
        let all = first_bits(here);
        let in_shadow = in_shadow & !beyond & all;
        let (mut samples, mut are_certain) = P::round(simd, low, high);
        if let Some(is_absent) = shaded.constants.color.is_absent {
            for channel in 0..3 {
                if is_absent[channel] {
                    samples[channel] = S::f32s::splat(simd, 0.0);
                    are_certain[channel] = S::mask32s::splat(simd, true);
                }
            }
        }
        let doubts = (!(are_certain[0] & are_certain[1] & are_certain[2])).to_bitmask();
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
        run.note_doubts(first, done, (in_doubt | beyond | doubts & !in_shadow) & all);
        done = first + here;
        first = next;
    }
}
