//! The front faces of a tetrahedron, prepared for rows.

use crate::tracer::scanline::edges::table::Receiver;
use crate::tracer::scanline::write::paint::PaintNumber;

/// The front faces of a tetrahedron, and the pairs that tell which one is seen.
pub(crate) struct FrontFaces<'f> {
    /// In the order of their face numbers.
    pub(crate) all: &'f [FrontFace],
    /// All pairs of them.
    pub(crate) pairs: &'f [Pair],
}

/// A face of a tetrahedron that eye rays enter.
#[derive(Clone, Copy)]
pub(crate) struct FrontFace {
    /// The paint outside of all shadows: of a face turned away from the light, that of the dark.
    pub(crate) outside: PaintNumber,
    /// The paint in a shadow; the same where none may fall on the face.
    pub(crate) in_shadow: PaintNumber,
    /// The receiver of the shadows on the face.
    pub(crate) shadows: Receiver,
}

/// Two front faces that share an edge.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    /// Their indices; the first has the lower face number.
    pub(crate) front_faces: (usize, usize),
    /// The number of the region in which eye rays enter the first one last.
    pub(crate) crease: usize,
}
