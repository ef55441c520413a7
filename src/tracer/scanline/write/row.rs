//! A row that is being written.

use std::ops::Range;

use fearless_simd::{Level, dispatch};

use crate::tracer::decision::Decision;
use crate::tracer::in_doubt::InDoubt;
use crate::tracer::ladder::Pixels;
use crate::tracer::scanline::grid::{Columns, Grid};
use crate::tracer::scanline::precision::Precision;
use crate::tracer::scanline::shade::columns::{SphereColumns, bit_of};
use crate::tracer::scanline::shade::policy::Certified;
use crate::tracer::scanline::shade::run::{Run, RunScratch, shade};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::write::history::RowHistory;
use crate::tracer::scanline::write::paint::{self, Paint};

/// A row that is being written, of some neighbouring ones.
pub(crate) struct Row<'r> {
    pub(crate) level: Level,
    pub(crate) precision: Precision,
    pub(crate) grid: Grid,
    /// The first of the rows.
    pub(crate) first: u32,
    pub(crate) number: u32,
    /// Y.
    pub(crate) y: f64,
    /// Those of all the rows.
    pub(crate) samples: &'r mut [f32],
    pub(crate) decisions: Option<&'r mut [Decision]>,
    /// What the samples are from the frame before, where only what differs is to be written.
    pub(crate) history: Option<&'r mut [RowHistory]>,
    /// Pixels that are still to be filled. What ends a row mostly begins the next, and they lie
    /// side by side.
    pub(crate) pending: Option<(Range<usize>, &'r Paint)>,
    pub(crate) in_doubt: InDoubt,
}

/// The columns of `columns` that are among others: none, somewhere among them, if there are none.
fn both(columns: Columns, others: Columns) -> Columns {
    let from = others.0.clamp(columns.0, columns.1);
    (from, others.1.clamp(from, columns.1))
}

impl<'r> Row<'r> {
    /// Where columns lie among the pixels of all rows.
    fn pixels(&self, (from, to): Columns) -> Range<usize> {
        let start = (self.number - self.first) as usize * self.grid.size as usize;
        start + from as usize..start + to as usize
    }

    /// What is remembered of the row.
    fn history(&mut self) -> Option<&mut RowHistory> {
        let index = (self.number - self.first) as usize;
        self.history.as_mut().map(|history| &mut history[index])
    }

    /// One colour in all columns.
    pub(crate) fn fill(&mut self, columns: Columns, paint: &'r Paint) {
        let pixels = self.pixels(columns);
        if let Some(decisions) = &mut self.decisions {
            decisions[pixels].fill(paint.decision);
        }
        // It is lent to the history, which calls back.
        match self.history.take() {
            Some(history) => {
                let index = (self.number - self.first) as usize;
                let write = |columns| self.extend_pending(columns, paint);
                history[index].fill(columns, paint.bits(), write);
                self.history = Some(history);
            }
            None => self.extend_pending(columns, paint),
        }
    }

    fn extend_pending(&mut self, columns: Columns, paint: &'r Paint) {
        let pixels = self.pixels(columns);
        match &mut self.pending {
            Some((pending, same)) if pending.end == pixels.start && same.bits() == paint.bits() => {
                pending.end = pixels.end;
            }
            _ => {
                self.write_pending();
                self.pending = Some((pixels, paint));
            }
        }
    }

    fn write_pending(&mut self) {
        if let Some((pixels, paint)) = self.pending.take() {
            let samples = &mut self.samples[3 * pixels.start..3 * pixels.end];
            dispatch!(self.level, simd => paint::fill(simd, samples, paint));
        }
    }

    /// A sphere. What is left in doubt is in `scratch`.
    pub(crate) fn shade(
        &mut self,
        columns: Columns,
        shaded: &ShadedSphere<'_>,
        sphere_columns: &SphereColumns,
        in_shadow: &'r Paint,
        scratch: &mut RunScratch,
    ) {
        let shadeable = both(columns, sphere_columns.shadeable);
        scratch.doubts.extend(columns.0..shadeable.0);
        scratch.doubts.extend(shadeable.1..columns.1);
        let facing = match sphere_columns.facing {
            _ if !shaded.sphere.shadows => Some((shadeable, true)),
            facing => facing,
        };
        let mut shade = |row: &mut Self, columns, is_facing| {
            row.shade_known(
                columns,
                shaded,
                (sphere_columns, is_facing),
                in_shadow,
                scratch,
            );
        };
        match facing {
            None => shade(self, shadeable, false),
            Some((inside, inside_faces)) => {
                let inside = both(shadeable, inside);
                let parts = [
                    ((shadeable.0, inside.0), !inside_faces),
                    (inside, inside_faces),
                    ((inside.1, shadeable.1), !inside_faces),
                ];
                for (columns, faces) in parts {
                    match faces {
                        _ if columns.0 == columns.1 => {}
                        true => shade(self, columns, true),
                        false => self.fill(columns, in_shadow),
                    }
                }
            }
        }
    }

    /// Columns of a sphere in which all is shadeable that f64 has to know to shade it.
    fn shade_known(
        &mut self,
        columns: Columns,
        shaded: &ShadedSphere<'_>,
        (sphere_columns, is_facing): (&SphereColumns, bool),
        in_shadow: &Paint,
        scratch: &mut RunScratch,
    ) {
        if columns.0 == columns.1 {
            return;
        }
        self.mark_written();
        scratch.casters.clear();
        if sphere_columns.casters != 0 {
            let x = |column| self.grid.coordinate(column);
            let ends = (x(columns.0), x(columns.1 - 1));
            let hits = shaded.sphere.hit_box(ends, (self.y, self.y));
            let casters = shaded.casters.iter().enumerate();
            let near = casters.filter(|(number, caster)| {
                sphere_columns.casters & bit_of(*number) != 0 && !caster.misses(&hits)
            });
            scratch.casters.extend(near.map(|(number, _)| number));
        }
        let range = self.pixels(columns);
        let mut run = Run {
            grid: self.grid,
            y: self.y,
            from: columns.0,
            zones: sphere_columns.zones,
            bright: sphere_columns.bright,
            is_facing,
            samples: &mut self.samples[3 * range.start..3 * range.end],
            decisions: self.decisions.as_mut().map(|all| &mut all[range]),
            in_shadow,
            scratch,
        };
        dispatch!(self.level, simd => match self.precision {
            Precision::Bounded => shade::<_, Certified>(simd, shaded, &mut run),
            Precision::Double => shade::<_, f64>(simd, shaded, &mut run),
            Precision::Single => shade::<_, f32>(simd, shaded, &mut run),
        });
    }

    fn mark_written(&mut self) {
        if let Some(history) = self.history() {
            history.is_written = true;
        }
    }

    /// The row is written.
    pub(crate) fn finish(&mut self) {
        if let Some(history) = self.history() {
            history.finish();
        }
    }

    /// All rows are.
    pub(crate) fn finish_all(mut self) -> InDoubt {
        self.write_pending();
        self.in_doubt
    }

    /// Asks for each pixel by itself.
    pub(crate) fn ask(&mut self, columns: impl IntoIterator<Item = u32>, pixels: &impl Pixels) {
        for column in columns {
            self.mark_written();
            let ((decision, color), rung) = pixels.pixel(column, self.number);
            let index = self.pixels((column, column)).start;
            self.samples[3 * index..3 * index + 3].copy_from_slice(&color);
            if let Some(decisions) = &mut self.decisions {
                decisions[index] = decision;
            }
            self.in_doubt.count(rung);
        }
    }
}
