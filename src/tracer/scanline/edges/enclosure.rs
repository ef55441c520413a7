//! Enclosures of a region's edges, before they are rounded to columns.

/// Enclosures of where a region begins and ends, in as many rows as there are lanes. Positions are
/// given in columns, and both ends are included.
pub(crate) struct ColumnEnclosure<V> {
    /// No pixel outside of this interval is in the region.
    pub(crate) possible: [V; 2],
    /// Every pixel in this interval is in the region.
    pub(crate) certain: [V; 2],
}

/// An end of an interval without columns: none lies at or before this position.
pub(crate) const NOWHERE: f64 = -1.0;
