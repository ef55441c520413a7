//! A span that shows a sphere: columns in shadow are filled, and all others are shaded or decided
//! one by one.

use fearless_simd::dispatch;

use crate::tracer::ladder::RowPixels;
use crate::tracer::scanline::grid::Columns;
use crate::tracer::scanline::shade::columns::{SphereCache, SphereColumns, bit_of};
use crate::tracer::scanline::shade::policy::{Certified, Precision};
use crate::tracer::scanline::shade::run::{Run, RunColumns, shade};
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::write::row_writer::RowWriter;

/// What the shading of spheres needs, kept from span to span.
#[derive(Default)]
pub(crate) struct SpanShader {
    cache: SphereCache,
    /// The casters that may cast a shadow on any pixel of a run.
    casters: Vec<usize>,
    /// The columns left in doubt.
    doubts: Vec<u32>,
}

impl SpanShader {
    /// Prepares for so many spheres of a frame.
    pub(crate) fn begin(&mut self, count: usize) {
        self.cache.begin(count);
    }

    /// Writes columns that show a sphere.
    pub(crate) fn shade<'r>(
        &mut self,
        writer: &mut RowWriter<'r>,
        columns: Columns,
        shaded: &'r ShadedSphere<'_>,
        pixels: &dyn RowPixels,
    ) {
        // Its columns would take longer than its pixels.
        if shaded.constants.is_small && writer.precision == Precision::Certified {
            self.shade_run(writer, columns, shaded, None);
            self.decide_doubts(writer, shaded, pixels);
            return;
        }
        let sphere = self.cache.of(shaded, writer.row, writer.level, writer.grid);
        let shadeable = both(columns, sphere.shadeable);
        self.doubts.extend(columns.0..shadeable.0);
        self.doubts.extend(shadeable.1..columns.1);
        match sphere.facing {
            _ if !shaded.constants.has_shadows => {
                self.shade_run(writer, shadeable, shaded, Some((&sphere, true)));
            }
            None => self.shade_run(writer, shadeable, shaded, Some((&sphere, false))),
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
                        true => self.shade_run(writer, columns, shaded, Some((&sphere, true))),
                        false => writer.fill(columns, &shaded.in_shadow),
                    }
                }
            }
        }
        self.decide_doubts(writer, shaded, pixels);
    }

    /// Decides the columns left in doubt.
    fn decide_doubts(
        &mut self,
        writer: &mut RowWriter<'_>,
        shaded: &ShadedSphere<'_>,
        pixels: &dyn RowPixels,
    ) {
        if !self.doubts.is_empty() {
            let pixel = |column, row| pixels.pixel_on_sphere(shaded.in_light, column, row);
            writer.decide(self.doubts.drain(..), pixel);
        }
    }

    /// Shades columns. If they are `known`, they are all shadeable, and the bool tells whether they
    /// face the light.
    fn shade_run(
        &mut self,
        writer: &mut RowWriter<'_>,
        columns: Columns,
        shaded: &ShadedSphere<'_>,
        known: Option<(&SphereColumns, bool)>,
    ) {
        if columns.0 == columns.1 {
            return;
        }
        writer.mark_written();
        if let Some((sphere, _)) = known {
            self.find_casters(writer, columns, shaded, sphere.casters);
        }
        let range = writer.pixels(columns);
        let mut run = Run {
            grid: writer.grid,
            y: writer.y,
            from: columns.0,
            count: range.len(),
            columns: known.map(|(sphere, _)| RunColumns {
                zones: sphere.zones,
                bright: sphere.bright,
            }),
            is_facing: known.map_or(!shaded.constants.has_shadows, |(_, is_facing)| is_facing),
            casters: known.map(|_| &*self.casters),
            samples: &mut writer.samples[3 * range.start..],
            decisions: writer.decisions.as_mut().map(|all| &mut all[range]),
            doubts: &mut self.doubts,
        };
        dispatch!(writer.level, simd => match writer.precision {
            Precision::Certified => shade::<_, Certified>(simd, shaded, &mut run),
            Precision::Double => shade::<_, f64>(simd, shaded, &mut run),
            Precision::Single => shade::<_, f32>(simd, shaded, &mut run),
        });
    }

    /// Finds the casters that may cast a shadow on any of some columns, out of those whose bits are
    /// set in `near`.
    fn find_casters(
        &mut self,
        writer: &RowWriter<'_>,
        columns: Columns,
        shaded: &ShadedSphere<'_>,
        near: u64,
    ) {
        self.casters.clear();
        if near == 0 {
            return;
        }
        let ends = [columns.0, columns.1 - 1].map(|column| writer.grid.coordinate(column));
        let hits = shaded.constants.hit_box(ends.into(), (writer.y, writer.y));
        let casters = shaded.casters.iter().enumerate();
        let casters = casters.filter(|(number, caster)| {
            near & bit_of(*number) != 0 && !caster.misses(shaded.constants.lighting, &hits)
        });
        self.casters.extend(casters.map(|(number, _)| number));
    }
}

/// The intersection of two ranges of columns; an empty one lies within `columns`.
fn both(columns: Columns, others: Columns) -> Columns {
    let from = others.0.clamp(columns.0, columns.1);
    (from, others.1.clamp(from, columns.1))
}
