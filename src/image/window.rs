//! Windows: where the pixels of an OpenEXR file lie in a scene.

use std::fmt;

/// A rectangle of pixels in the pixel space of OpenEXR, whose columns count to the right and whose
/// rows count down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The column and the row of its upper left pixel.
    pub corner: [i32; 2],
    /// Its width and its height.
    pub size: [u32; 2],
}

impl Window {
    /// The pixels of both windows, if there are any.
    pub fn intersection(self, other: Window) -> Option<Window> {
        let corner = [0, 1].map(|axis| self.corner[axis].max(other.corner[axis]));
        let size = [0, 1].map(|axis| {
            let end = self.end()[axis].min(other.end()[axis]);
            u32::try_from(end - i64::from(corner[axis])).unwrap_or(0)
        });
        (!size.contains(&0)).then_some(Window { corner, size })
    }

    /// The column and the row behind its lower right pixel.
    fn end(self) -> [i64; 2] {
        [0, 1].map(|axis| i64::from(self.corner[axis]) + i64::from(self.size[axis]))
    }
}

/// Its first and its last pixel.
impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([left, top], [right, bottom]) = (self.corner, self.end().map(|end| end - 1));
        write!(f, "({left}, {top}) to ({right}, {bottom})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(corner: [i32; 2], size: [u32; 2]) -> Window {
        Window { corner, size }
    }

    #[test]
    fn an_intersection_has_the_pixels_of_both() {
        let wide = window([-3, 2], [10, 4]);
        let high = window([5, -1], [1, 20]);
        let both = window([5, 2], [1, 4]);
        assert_eq!(wide.intersection(high), Some(both));
        assert_eq!(high.intersection(wide), Some(both));
        assert_eq!(wide.to_string(), "(-3, 2) to (6, 5)");
        for apart in [
            window([7, 2], [1, 4]),
            window([-3, 6], [10, 1]),
            window([i32::MAX; 2], [u32::MAX; 2]),
            window([i32::MIN; 2], [0; 2]),
        ] {
            assert_eq!(wide.intersection(apart), None, "{apart}");
        }
        let all = window([i32::MIN; 2], [u32::MAX; 2]);
        assert_eq!(wide.intersection(all), Some(wide));
    }
}
