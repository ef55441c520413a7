//! How the faces and the edges of a tetrahedron are numbered.

/// The vertices of each face. Face k is the one opposite vertex k; its vertices are listed
/// counter-clockwise as seen from outside, for a tetrahedron whose edges 0→1, 0→2, 0→3 are
/// right-handed.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The edge that faces i < j share, from its first to its last vertex along n_i × n_j, where n is
/// the outward normal of a right-handed tetrahedron's face. The other two vertices are i and j.
pub(crate) const EDGES: [(usize, usize, [usize; 2]); 6] = [
    (0, 1, [2, 3]),
    (0, 2, [3, 1]),
    (0, 3, [1, 2]),
    (1, 2, [0, 3]),
    (1, 3, [2, 0]),
    (2, 3, [0, 1]),
];
