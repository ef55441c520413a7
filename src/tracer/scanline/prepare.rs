//! Prepares a frame: its solids and its surface, with their regions and paints.

pub(super) mod appearance;
pub(super) mod builder;
pub(super) mod culling;
pub(super) mod depth;
pub(super) mod frame;
pub(super) mod front_faces;
pub(super) mod late_faces;
mod late_making;
pub(super) mod late_source;
pub(super) mod outline;
pub(super) mod shadows;
pub(super) mod solids;
pub(super) mod surface;
pub(super) mod surface_plane;
