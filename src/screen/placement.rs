//! Where the picture lies in a window or framebuffer: the letterbox.

use glam::{DVec2, I64Vec2, IVec2, UVec2};

/// The square of a framebuffer that the picture fills, in pixels from the framebuffer's bottom left
/// corner.
///
/// It may reach beyond the framebuffer on any side; what lies outside is not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// The bottom left corner.
    pub origin: IVec2,
    /// The length of a side; 0 where there is no room for a single pixel.
    pub side: u32,
}

impl Placement {
    /// No square at all: nothing is drawn.
    pub const NOWHERE: Placement = Placement {
        origin: IVec2::ZERO,
        side: 0,
    };

    /// The largest square for a picture of `size` × `size` pixels in the middle of `surface`, width
    /// and height in pixels.
    ///
    /// The side is the largest whole multiple of `size` that fits, so that every pixel of the
    /// picture becomes a square of the same size; where not even one fits, it is the shorter
    /// side of `surface`. Where the margins cannot be equal, the left and the bottom one are a
    /// pixel narrower.
    pub fn fit(surface: UVec2, size: u32) -> Placement {
        let shorter = surface.min_element();
        let side = match shorter.checked_div(size) {
            Some(multiple @ 1..) => multiple * size,
            _ => shorter,
        };
        Placement {
            origin: ((surface - side) / 2).as_ivec2(),
            side,
        }
    }

    /// The largest side for which a picture of `size` × `size` pixels is drawn exactly: N E must
    /// stay below 2³¹.
    pub fn max_side(size: u32) -> u32 {
        (u32::MAX / 2) / size.max(1)
    }

    /// The pixel, column and row, of a picture of `size` × `size` pixels that the pixel `window` of
    /// the framebuffer shows; both count from the bottom left corner. `None` beside the
    /// picture.
    pub fn pixel_at(&self, window: IVec2, size: u32) -> Option<UVec2> {
        let place = window.as_i64vec2() - self.origin.as_i64vec2();
        let side = i64::from(self.side);
        if place.min_element() < 0 || place.max_element() >= side {
            return None;
        }
        Some(((2 * place + 1) * i64::from(size) / (2 * side)).as_uvec2())
    }

    /// The pixels of the framebuffer that show the picture's pixel at column and row `pixel`: the
    /// bottom left one, and the one past the top right one. Both are the same where the picture
    /// is drawn too small for this pixel to be seen.
    pub fn square_of(&self, pixel: UVec2, size: u32) -> [IVec2; 2] {
        let (side, size) = (i64::from(self.side), i64::from(size.max(1)));
        let first = |pixel: I64Vec2| {
            // The first p with 2 p + 1 ≥ 2 E pixel / N.
            let doubled = 2 * side * pixel - size;
            let first = (doubled + (2 * size - 1)).div_euclid(I64Vec2::splat(2 * size));
            (first + self.origin.as_i64vec2()).as_ivec2()
        };
        let pixel = pixel.as_i64vec2();
        [first(pixel), first(pixel + 1)]
    }

    /// The picture of `size` × `size` pixels with sides of length `side`, so that what the pixel
    /// `window` of the framebuffer shows stays there; the pixel of the picture exactly, where
    /// it is drawn larger than one of the framebuffer before and after.
    pub fn zoomed(&self, window: IVec2, side: u32, size: u32) -> Placement {
        let scale = |side: u32| f64::from(side) / f64::from(size);
        // In pixels of the picture, from its corner.
        let place = ((window - self.origin).as_dvec2() + 0.5) / scale(self.side);
        // Whole pixels of the picture apart from the rest, so that no rounding leads from one into
        // the next.
        let whole = place.floor();
        let within: DVec2 = (place - whole) * scale(side);
        let shift = (whole * scale(side)).floor() + within.floor();
        Placement {
            origin: window - shift.as_ivec2(),
            side,
        }
    }

    /// The same, moved as little as it takes to have the middle of `surface` within the picture.
    pub fn around_the_middle(&self, surface: UVec2) -> Placement {
        let middle = surface.as_i64vec2() / 2;
        let last = i64::from(self.side.saturating_sub(1));
        let origin = self.origin.as_i64vec2().clamp(middle - last, middle);
        Placement {
            origin: origin.as_ivec2(),
            side: self.side,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(width: u32, height: u32, size: u32) -> (i32, i32, u32) {
        let placement = Placement::fit(UVec2::new(width, height), size);
        (placement.origin.x, placement.origin.y, placement.side)
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

    /// Placements of all kinds: smaller than the picture, as large, whole multiples, and others;
    /// inside the window and reaching out.
    fn placements(size: u32) -> impl Iterator<Item = Placement> {
        let sides = [
            1,
            3,
            size - 1,
            size,
            size + 1,
            2 * size,
            3 * size + 2,
            5 * size,
        ];
        let origins = [IVec2::ZERO, IVec2::new(7, -3), IVec2::new(-40, 11)];
        sides
            .into_iter()
            .flat_map(move |side| origins.map(|origin| Placement { origin, side }))
    }

    #[test]
    fn from_the_window_to_the_picture_and_back() {
        let both = [12, 13].map(|size| placements(size).map(move |placement| (size, placement)));
        for (size, placement) in both.into_iter().flatten() {
            let mut shown = vec![0_i64; (size * size) as usize];
            let side = placement.side as i32;
            for y in -50..side + 50 {
                for x in -50..side + 50 {
                    let window = IVec2::new(x, y);
                    let inside = window.cmpge(placement.origin).all()
                        && window.cmplt(placement.origin + side).all();
                    let pixel = placement.pixel_at(window, size);
                    assert_eq!(pixel.is_some(), inside, "{placement:?} {window}");
                    if let Some(pixel) = pixel {
                        let [first, end] = placement.square_of(pixel, size);
                        assert!(window.cmpge(first).all() && window.cmplt(end).all());
                        shown[(pixel.y * size + pixel.x) as usize] += 1;
                    }
                }
            }
            // No pixel's square holds more than the pixels of the window that lead to it.
            for (number, shown) in (0..).zip(shown) {
                let pixel = UVec2::new(number % size, number / size);
                let [first, end] = placement.square_of(pixel, size);
                let area = (end - first).as_i64vec2().element_product();
                assert_eq!(area, shown, "{placement:?} {pixel}");
            }
        }
    }

    #[test]
    fn zooming_keeps_the_pixel_under_the_pointer() {
        let size = 13;
        for placement in placements(size).filter(|placement| placement.side >= size) {
            for multiple in 1..70 {
                for window in [IVec2::new(0, 8), IVec2::new(7, 9), IVec2::new(12, 12)] {
                    let zoomed = placement.zoomed(window, multiple * size, size);
                    let before = placement.pixel_at(window, size);
                    if before.is_some() {
                        assert_eq!(zoomed.pixel_at(window, size), before);
                    }
                }
            }
        }
    }

    #[test]
    fn the_largest_side_is_still_drawn_exactly() {
        for size in [1, 500, 16384] {
            let product = u64::from(Placement::max_side(size)) * u64::from(size);
            assert!(product < 1 << 31 && product + u64::from(size) >= (1 << 31) - 1);
        }
    }
}
