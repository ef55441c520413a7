//! A frame, from the scene as it is seen: solids and surface, with the edges and paints that they
//! bring.

pub(super) mod bodies;
pub(super) mod builder;
pub(super) mod culling;
pub(super) mod depth;
pub(super) mod outline;
pub(super) mod prepared;
pub(super) mod shadows;
pub(super) mod solids;
pub(super) mod surface;
