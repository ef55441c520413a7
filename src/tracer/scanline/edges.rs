//! The edges of a frame: the lines on the screen at which a row may change what it shows.
//!
//! A silhouette, an edge between two faces, the outline of a shadow or of a mirror image is a
//! straight line or an ellipse on the screen, because eye rays are parallel, and so are those to
//! the light.

#[cfg(test)]
mod bounds;
pub(super) mod ellipse;
pub(super) mod enclosure;
pub(super) mod half_plane;
pub(super) mod pixel_plane;
pub(super) mod region;
pub(super) mod table;
