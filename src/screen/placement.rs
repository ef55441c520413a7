//! Where the picture lies in a window or framebuffer: the letterbox.

use glam::{IVec2, UVec2};

/// The square of a framebuffer that the picture fills, in pixels from the framebuffer's bottom left corner.
///
/// It may reach beyond the framebuffer on any side; what lies outside is not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// The bottom left corner.
    pub origin: IVec2,
    /// The length of a side; 0 where there is no room for a single pixel.
    pub extent: u32,
}

impl Placement {
    /// No square at all: nothing is drawn.
    pub const NOWHERE: Placement = Placement {
        origin: IVec2::ZERO,
        extent: 0,
    };

    /// The largest square for a picture of `size` × `size` pixels in the middle of `surface`, width and height in pixels.
    ///
    /// The side is the largest whole multiple of `size` that fits, so that every pixel of the picture becomes a square of the same
    /// size; where not even one fits, it is the shorter side of `surface`. Where the margins cannot be equal, the left and the
    /// bottom one are a pixel narrower.
    pub fn fit(surface: UVec2, size: u32) -> Placement {
        let side = surface.min_element();
        let extent = match side.checked_div(size) {
            Some(multiple @ 1..) => multiple * size,
            _ => side,
        };
        Placement {
            origin: ((surface - extent) / 2).as_ivec2(),
            extent,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(width: u32, height: u32, size: u32) -> (i32, i32, u32) {
        let placement = Placement::fit(UVec2::new(width, height), size);
        (placement.origin.x, placement.origin.y, placement.extent)
    }

    #[test]
    fn whole_multiples_fill_the_surface() {
        assert_eq!(fit(500, 500, 500), (0, 0, 500));
        assert_eq!(fit(1500, 1500, 500), (0, 0, 1500));
        assert_eq!(fit(1, 1, 1), (0, 0, 1));
        assert_eq!(fit(16384, 16384, 16384), (0, 0, 16384));
    }

    #[test]
    fn the_rest_of_a_multiple_is_margin() {
        assert_eq!(fit(1499, 1499, 500), (249, 249, 1000));
        assert_eq!(fit(501, 502, 500), (0, 1, 500));
        assert_eq!(fit(800, 600, 7), (102, 2, 595));
    }

    #[test]
    fn smaller_than_the_picture_is_the_largest_square() {
        assert_eq!(fit(499, 499, 500), (0, 0, 499));
        assert_eq!(fit(640, 333, 500), (153, 0, 333));
        assert_eq!(fit(1, 9, 500), (0, 4, 1));
    }

    #[test]
    fn nothing_is_nothing() {
        assert_eq!(fit(0, 0, 500), (0, 0, 0));
        assert_eq!(fit(640, 0, 500), (320, 0, 0));
        assert_eq!(fit(0, 480, 500), (0, 240, 0));
        assert_eq!(fit(640, 480, 0), (80, 0, 480));
    }

    #[test]
    fn very_wide_and_very_high() {
        assert_eq!(fit(100_000, 1200, 500), (49_500, 100, 1000));
        assert_eq!(fit(1, u32::MAX, 500), (0, (u32::MAX / 2) as i32, 1));
        assert_eq!(
            fit(u32::MAX, u32::MAX, 1 << 14),
            (8191, 8191, u32::MAX - 16383)
        );
    }
}
