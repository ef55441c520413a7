//! The borders of a frame: what changes where a row crosses them.

use std::ops::Range;

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;

use super::shape::Shape;

/// What a border is of.
#[derive(Clone, Copy)]
pub(super) enum Border {
    Surface,
    ShadowOnSurface,
    /// Part of a solid: it is asked for where that is seen.
    Detail,
    /// A solid, by its place among those seen directly, or in the mirror.
    Direct(usize),
    Mirrored(usize),
}

/// All borders of a frame, as they are found. Each is known by its number.
pub(super) struct Borders<'f> {
    shapes: Growing<'f, Shape<'f>>,
    rows: Growing<'f, (u32, u32)>,
    of: Growing<'f, Border>,
}

/// The borders of a frame.
pub(super) struct AllBorders<'f> {
    pub(super) shapes: &'f [Shape<'f>],
    /// The rows that each can cross.
    pub(super) rows: &'f [(u32, u32)],
    pub(super) of: &'f [Border],
}

impl<'f> Borders<'f> {
    pub(super) fn new(arena: &'f Bump) -> Self {
        Borders {
            shapes: Growing::new_in(arena),
            rows: Growing::new_in(arena),
            of: Growing::new_in(arena),
        }
    }

    pub(super) fn add(&mut self, shape: Shape<'f>, of: Border) -> usize {
        self.rows.push(shape.rows());
        self.shapes.push(shape);
        self.of.push(of);
        self.of.len() - 1
    }

    /// Details of a solid that is seen in these rows only. Returns their numbers.
    pub(super) fn add_details(
        &mut self,
        shapes: impl IntoIterator<Item = Shape<'f>>,
        rows: (u32, u32),
    ) -> Range<usize> {
        let first = self.of.len();
        for shape in shapes {
            self.add(shape.within(rows), Border::Detail);
        }
        first..self.of.len()
    }

    pub(super) fn all(self) -> AllBorders<'f> {
        AllBorders {
            shapes: self.shapes.into_bump_slice(),
            rows: self.rows.into_bump_slice(),
            of: self.of.into_bump_slice(),
        }
    }
}
