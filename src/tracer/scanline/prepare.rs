//! A frame, from the scene as it is seen: solids and surface, with the edges and paints that they
//! bring.

pub(super) mod depth;
pub(super) mod floor;
pub(super) mod prepared;
pub(super) mod solids;
