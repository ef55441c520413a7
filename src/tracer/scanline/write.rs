//! Writes what a row shows, unless it stands there from the frame before.

pub(super) mod history;
pub(super) mod paint;
pub(super) mod pixels;
pub(super) mod row_writer;
