//! Visibility: from the regions that cover a gap to what it shows, a paint, a sphere, or pixels
//! that are decided one by one.

pub(super) mod coverage;
pub(super) mod depth_test;
pub(super) mod resolve;
pub(super) mod separation;
pub(super) mod visible;
