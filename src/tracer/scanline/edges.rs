//! Regions of the screen, and the edges at which a row enters and leaves them.

pub(super) mod band_columns;
pub(super) mod border;
#[cfg(test)]
mod bounds_tests;
pub(super) mod ellipse;
pub(super) mod ellipses;
pub(super) mod enclosure;
pub(super) mod half_plane;
pub(super) mod pixel_plane;
pub(super) mod region;
pub(super) mod table;
