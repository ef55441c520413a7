//! The front faces of a tetrahedron, prepared for rows.

use crate::tracer::scanline::edges::table::Receiver;
use crate::tracer::scanline::write::paint::PaintNumber;

/// The front faces of a tetrahedron, and the pairs that tell which one is seen.
pub(crate) struct FrontFaces {
    /// In the order of their face numbers; after them, others that nothing refers to.
    pub(crate) all: [FrontFace; 4],
    /// All pairs of front faces that share an edge: their indices, the lower one first.
    pub(crate) pairs: &'static [[u8; 2]],
    /// The number of the region in which eye rays enter the first face of the first pair last.
    /// Those of the other pairs follow.
    pub(crate) first_crease: usize,
}

/// A face of a tetrahedron that eye rays enter.
#[derive(Clone, Copy, Default)]
pub(crate) struct FrontFace {
    /// The paint outside of all shadows: of a face turned away from the light, that of the dark.
    pub(crate) outside: PaintNumber,
    /// The paint in a shadow; the same where none may fall on the face.
    pub(crate) in_shadow: PaintNumber,
    /// The receiver of the shadows on the face.
    pub(crate) shadows: Receiver,
}
