//! Enclosures of a region's edges, before they are rounded to columns.

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::tracer::scanline::grid::Position;

/// For as many rows as there are lanes, two intervals that enclose the columns of a region from
/// outside and from inside. Their ends are positions in columns, which need not be whole; the ends
/// belong to the intervals.
pub(crate) struct ColumnEnclosure<V> {
    /// No pixel outside of this interval is in the region.
    pub(crate) possible: [V; 2],
    /// Every pixel in this interval is in the region.
    pub(crate) certain: [V; 2],
}

/// The right end of an interval without columns: no column lies at or to the left of it.
pub(crate) const NOWHERE: f32 = -1.0;

/// A part of the screen that enclosures can be intersected with.
pub(crate) trait Cut {
    /// Intersects enclosures of as many rows as there are lanes with it.
    fn cut<S: Simd, V>(&self, simd: S, y: V, enclosure: &mut ColumnEnclosure<V>)
    where
        V: SimdFloat<S, Element: Position>;
}
