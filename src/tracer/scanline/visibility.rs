//! What is visible in a gap: from the regions that cover its columns to one paint or one sphere, or
//! to pixels that are decided one by one.

pub(super) mod coverage;
pub(super) mod depth;
pub(super) mod resolve;
pub(super) mod separation;
pub(super) mod visible;
