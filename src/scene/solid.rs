//! How solids are numbered: the spheres first, then the tetrahedra, each in the file's order.

/// What there is of each kind of solid, or a solid of either kind.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Solid<S, T> {
    /// A sphere.
    Sphere(S),
    /// A tetrahedron.
    Tetrahedron(T),
}

impl<'s, S, T> Solid<&'s S, &'s T> {
    /// The solid of this number.
    #[inline]
    pub(crate) fn numbered(number: usize, spheres: &'s [S], tetrahedra: &'s [T]) -> Self {
        match Solid::index(number, spheres.len()) {
            Solid::Sphere(index) => Solid::Sphere(&spheres[index]),
            Solid::Tetrahedron(index) => Solid::Tetrahedron(&tetrahedra[index]),
        }
    }
}

impl Solid<usize, usize> {
    /// The index of a solid among those of its kind, where there are so many spheres.
    #[inline]
    pub(crate) fn index(number: usize, spheres: usize) -> Self {
        match number.checked_sub(spheres) {
            None => Solid::Sphere(number),
            Some(index) => Solid::Tetrahedron(index),
        }
    }
}
