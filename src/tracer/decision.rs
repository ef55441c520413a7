//! The decision of a pixel: what it shows, apart from its colour.

/// The decision of a pixel: the discrete part of the picture, right or wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Decision {
    /// Nothing is hit.
    Background,
    /// Stage 1: one of the four quadrants of Code 2-1, 0 to 3 in the order of its branches.
    Quadrant(u8),
    /// A solid is hit first.
    Solid(Seen),
    /// The surface is hit first, and it shows its own colour.
    Surface,
    /// The surface is hit first, in the shadow of a solid.
    SurfaceInShadow,
    /// The surface is hit first, and mirrors a solid.
    Mirrored(Seen),
}

/// A solid as it is seen, directly or mirrored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Seen {
    /// Its number: spheres in the scene's order, then tetrahedra.
    pub solid: u16,
    /// The face that the ray enters, 0 to 3, for a tetrahedron; `None` for a sphere.
    pub face: Option<u8>,
    /// Whether the point is in shadow; false in the stages that have no shadows.
    pub in_shadow: bool,
}

impl Seen {
    /// Whether it is a sphere in the light, whose pixels are shaded; all other pixels of one
    /// decision have one colour.
    pub(crate) fn is_lit_sphere(&self) -> bool {
        self.face.is_none() && !self.in_shadow
    }
}
