//! Samples: what a row shows is written, unless it stands there from the frame before.

pub(super) mod history;
pub(super) mod paint;
pub(super) mod row;
