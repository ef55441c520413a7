//! What is visible in a span: from the edges that hold it to one paint, one sphere, or a pixel to
//! be asked by itself.

pub(super) mod coverage;
pub(super) mod depth;
pub(super) mod resolve;
pub(super) mod separation;
pub(super) mod visible;
