//! Enclosures of a region's edges, before they are rounded to columns.

use fearless_simd::{Simd, f32x8};

/// For a row, or for each row of a band, two intervals that enclose the columns of a region from
/// outside and from inside. Their ends are positions in columns, which need not be whole; the ends
/// belong to the intervals.
pub(crate) struct ColumnEnclosure<V> {
    /// No pixel outside of this interval is in the region.
    pub(crate) possible: [V; 2],
    /// Every pixel in this interval is in the region.
    pub(crate) certain: [V; 2],
}

impl ColumnEnclosure<f64> {
    /// Whether the region has a column; `None` where that is in doubt.
    pub(crate) fn holds(&self, column: f64) -> Option<bool> {
        let is_in = |[from, to]: [f64; 2]| from <= column && column <= to;
        match is_in(self.certain) {
            true => Some(true),
            false => (!is_in(self.possible)).then_some(false),
        }
    }
}

/// The right end of an interval without columns: no column lies at or to the left of it.
pub(crate) const NOWHERE: f32 = -1.0;

/// A part of the screen that enclosures can be intersected with.
pub(crate) trait Cut {
    /// Intersects the enclosures of a band's rows, with these Y, with it.
    fn cut<S: Simd>(&self, simd: S, y: f32x8<S>, enclosure: &mut ColumnEnclosure<f32x8<S>>);
}
