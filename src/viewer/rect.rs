//! Rectangles of the window, in pixels from its top left corner.

use glam::{IVec2, UVec2};

/// The pixels from `min` to before `max`; none where that is not right of and below `min`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rect {
    pub(super) min: IVec2,
    pub(super) max: IVec2,
}

impl Rect {
    pub(super) fn new(min: IVec2, size: UVec2) -> Rect {
        let max = min.saturating_add_unsigned(size);
        Rect { min, max }
    }

    /// Its width and height.
    pub(super) fn size(&self) -> UVec2 {
        self.max
            .saturating_sub(self.min)
            .max(IVec2::ZERO)
            .as_uvec2()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.size().min_element() == 0
    }

    pub(super) fn contains(&self, pixel: IVec2) -> bool {
        pixel.cmpge(self.min).all() && pixel.cmplt(self.max).all()
    }

    /// The pixels of both.
    pub(super) fn intersection(&self, other: Rect) -> Rect {
        Rect {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// The same with a margin of `margin` pixels on each side; narrower where that is negative.
    pub(super) fn grown(&self, margin: i32) -> Rect {
        Rect {
            min: self.min.saturating_sub(IVec2::splat(margin)),
            max: self.max.saturating_add(IVec2::splat(margin)),
        }
    }

    /// The same, moved as little as it takes to lie within `other`; at its corner where it is too
    /// large.
    pub(super) fn moved_into(&self, other: Rect) -> Rect {
        let min = self
            .min
            .min(other.max - self.size().as_ivec2())
            .max(other.min);
        Rect::new(min, self.size())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_are_cut_and_moved() {
        let window = Rect::new(IVec2::ZERO, UVec2::new(100, 50));
        let low = Rect::new(IVec2::new(90, 45), UVec2::new(20, 10));
        let corner = Rect::new(IVec2::new(90, 45), UVec2::new(10, 5));
        assert_eq!(low.intersection(window), corner);
        let within = Rect::new(IVec2::new(80, 40), UVec2::new(20, 10));
        assert_eq!(low.moved_into(window), within);
        let large = Rect::new(IVec2::new(3, 3), UVec2::new(10, 90));
        assert_eq!(large.moved_into(window).min, IVec2::new(3, 0));
        assert!(window.contains(IVec2::new(99, 0)) && !window.contains(IVec2::new(100, 0)));
        assert!(window.grown(-25).is_empty() && !window.grown(-24).is_empty());
    }
}
