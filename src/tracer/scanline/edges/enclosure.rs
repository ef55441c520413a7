//! Where a region begins and ends in some rows, enclosed: before places are rounded to columns.

/// Where columns begin and end in as many rows as there are lanes, given in columns: the first at
/// or after a place, up to another place.
pub(crate) struct RunEnclosure<V> {
    pub(crate) possible: [V; 2],
    pub(crate) certain: [V; 2],
}

/// No column lies up to this place.
pub(crate) const NOWHERE: f64 = -1.0;
