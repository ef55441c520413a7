//! Where the picture lies in a window or framebuffer: the letterbox.

use glam::{DVec2, I64Vec2, IVec2, UVec2};

/// The rectangle of a framebuffer that the picture fills, in pixels from the framebuffer's bottom
/// left corner. Pictures are given by their width and height in pixels, neither 0.
///
/// It may reach beyond the framebuffer on any side; what lies outside is not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// The bottom left corner.
    pub origin: IVec2,
    /// The width and height; 0 where there is no room for a single pixel.
    pub size: UVec2,
}

impl Placement {
    /// No rectangle at all: nothing is drawn.
    pub const NOWHERE: Placement = Placement {
        origin: IVec2::ZERO,
        size: UVec2::ZERO,
    };

    /// The largest rectangle for `picture` in the middle of `surface`, width and height in pixels.
    ///
    /// It is the largest whole multiple of `picture` that fits, so that every pixel of the picture
    /// becomes a square of the same size; where not even one fits, it has the aspect of the picture
    /// as nearly as whole pixels can, and at least one each way. Where the margins cannot be equal,
    /// the left and the bottom one are a pixel narrower.
    pub fn fit(surface: UVec2, picture: UVec2) -> Placement {
        let picture = picture.max(UVec2::ONE);
        let multiple = (surface / picture).min_element();
        let size = match multiple {
            0 if surface.min_element() == 0 => UVec2::ZERO,
            0 => {
                let (surface, picture) = (surface.as_i64vec2(), picture.as_i64vec2());
                let longer = picture.max_element();
                // Each way the least L for which picture L / longer, rounded down, fills it.
                let filling = (surface * longer + picture - 1) / picture;
                Placement::scaled(picture.as_uvec2(), filling.min_element() as u32)
            }
            multiple => multiple * picture,
        };
        Placement {
            origin: ((surface - size) / 2).as_ivec2(),
            size,
        }
    }

    /// The width and height of `picture` where its longer side is drawn `longer` pixels long: whole
    /// multiples where that is one, else the shorter side is rounded down, but to no less than 1.
    pub fn scaled(picture: UVec2, longer: u32) -> UVec2 {
        let side = picture.max_element().max(1);
        let scaled = picture.as_i64vec2() * i64::from(longer) / i64::from(side);
        scaled.max(I64Vec2::splat(longer.min(1).into())).as_uvec2()
    }

    /// The largest side for which a picture with a side of `size` pixels is drawn exactly: N E must
    /// stay below 2³¹.
    pub fn max_side(size: u32) -> u32 {
        (u32::MAX / 2) / size.max(1)
    }

    /// The pixel of `picture`, column and row, that the pixel `window` of the framebuffer shows;
    /// both count from the bottom left corner. `None` beside the picture.
    pub fn pixel_at(&self, window: IVec2, picture: UVec2) -> Option<UVec2> {
        let place = window.as_i64vec2() - self.origin.as_i64vec2();
        let size = self.size.as_i64vec2();
        if place.min_element() < 0 || place.cmpge(size).any() {
            return None;
        }
        Some(((2 * place + 1) * picture.as_i64vec2() / (2 * size)).as_uvec2())
    }

    /// The pixels of the framebuffer that show the pixel of `picture` at column and row `pixel`:
    /// the bottom left one, and the one past the top right one. Both are the same in a direction in
    /// which the picture is drawn too small for this pixel to be seen.
    pub fn rectangle_of(&self, pixel: UVec2, picture: UVec2) -> [IVec2; 2] {
        let (size, picture) = (self.size.as_i64vec2(), picture.max(UVec2::ONE).as_i64vec2());
        let first = |pixel: I64Vec2| {
            // The first p with 2 p + 1 ≥ 2 E pixel / N.
            let doubled = 2 * size * pixel - picture;
            let first = (doubled + (2 * picture - 1)).div_euclid(2 * picture);
            (first + self.origin.as_i64vec2()).as_ivec2()
        };
        let pixel = pixel.as_i64vec2();
        [first(pixel), first(pixel + 1)]
    }

    /// The same picture drawn with another `size`, so that what the pixel `window` of the
    /// framebuffer shows stays there; the pixel of `picture` exactly, where it is drawn larger than
    /// one of the framebuffer before and after.
    pub fn zoomed(&self, window: IVec2, size: UVec2, picture: UVec2) -> Placement {
        let scale = |size: UVec2| size.as_dvec2() / picture.as_dvec2();
        // In pixels of the picture, from its corner.
        let place = ((window - self.origin).as_dvec2() + 0.5) / scale(self.size);
        // Whole pixels of the picture apart from the rest, so that no rounding leads from one into
        // the next.
        let whole = place.floor();
        let within: DVec2 = (place - whole) * scale(size);
        let shift = (whole * scale(size)).floor() + within.floor();
        Placement {
            origin: window - shift.as_ivec2(),
            size,
        }
    }

    /// The same, moved as little as it takes to have the middle of `surface` within the picture.
    pub fn around_the_middle(&self, surface: UVec2) -> Placement {
        let middle = surface.as_i64vec2() / 2;
        let last = self.size.saturating_sub(UVec2::ONE).as_i64vec2();
        let origin = self.origin.as_i64vec2().clamp(middle - last, middle);
        Placement {
            origin: origin.as_ivec2(),
            size: self.size,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a square picture: the corner and the side.
    fn fit(width: u32, height: u32, size: u32) -> (i32, i32, u32) {
        let placement = Placement::fit(UVec2::new(width, height), UVec2::splat(size));
        assert_eq!(placement.size.x, placement.size.y);
        (placement.origin.x, placement.origin.y, placement.size.x)
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
    fn the_aspect_of_any_picture_stays() {
        for (surface, picture, corner, size) in [
            ([1000, 500], [100, 30], [0, 100], [1000, 300]),
            ([999, 500], [100, 30], [49, 115], [900, 270]),
            ([500, 1000], [30, 100], [100, 0], [300, 1000]),
            // Smaller than the picture: by its width, and by its height.
            ([640, 480], [1920, 1080], [0, 60], [640, 360]),
            ([640, 480], [1000, 3000], [240, 0], [160, 480]),
            ([640, 100], [1920, 1080], [231, 0], [178, 100]),
            ([500, 500], [16384, 1], [0, 249], [500, 1]),
            ([500, 500], [1, 16384], [249, 0], [1, 500]),
            ([1, 1], [3, 2], [0, 0], [1, 1]),
        ] {
            let placement = Placement::fit(surface.into(), picture.into());
            let expected = Placement {
                origin: corner.into(),
                size: size.into(),
            };
            assert_eq!(placement, expected, "{surface:?} {picture:?}");
        }
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
    fn placements(picture: UVec2) -> impl Iterator<Item = Placement> {
        let longer = picture.max_element();
        let sides = [
            1,
            3,
            longer - 1,
            longer,
            longer + 1,
            2 * longer,
            3 * longer + 2,
            5 * longer,
        ];
        let origins = [IVec2::ZERO, IVec2::new(7, -3), IVec2::new(-40, 11)];
        sides.into_iter().flat_map(move |longer| {
            let size = Placement::scaled(picture, longer);
            origins.map(|origin| Placement { origin, size })
        })
    }

    /// Pictures as wide as high, wide, and high.
    const PICTURES: [UVec2; 4] = [
        UVec2::splat(12),
        UVec2::splat(13),
        UVec2::new(13, 5),
        UVec2::new(4, 12),
    ];

    #[test]
    fn from_the_window_to_the_picture_and_back() {
        let all = PICTURES.map(|picture| placements(picture).map(move |place| (picture, place)));
        for (picture, placement) in all.into_iter().flatten() {
            let mut shown = vec![0_i64; picture.element_product() as usize];
            let size = placement.size.as_ivec2();
            for y in -50..size.y + 50 {
                for x in -50..size.x + 50 {
                    let window = IVec2::new(x, y);
                    let inside = window.cmpge(placement.origin).all()
                        && window.cmplt(placement.origin + size).all();
                    let pixel = placement.pixel_at(window, picture);
                    assert_eq!(pixel.is_some(), inside, "{placement:?} {window}");
                    if let Some(pixel) = pixel {
                        let [first, end] = placement.rectangle_of(pixel, picture);
                        assert!(window.cmpge(first).all() && window.cmplt(end).all());
                        shown[(pixel.y * picture.x + pixel.x) as usize] += 1;
                    }
                }
            }
            // No pixel's rectangle holds more than the pixels of the window that lead to it.
            for (number, shown) in (0..).zip(shown) {
                let pixel = UVec2::new(number % picture.x, number / picture.x);
                let [first, end] = placement.rectangle_of(pixel, picture);
                let area = (end - first).as_i64vec2().element_product();
                assert_eq!(area, shown, "{placement:?} {pixel}");
            }
        }
    }

    #[test]
    fn zooming_keeps_the_pixel_under_the_pointer() {
        for picture in PICTURES {
            let all = placements(picture);
            for placement in all.filter(|placement| placement.size.cmpge(picture).all()) {
                for multiple in 1..70 {
                    for window in [IVec2::new(0, 8), IVec2::new(7, 9), IVec2::new(12, 12)] {
                        let zoomed = placement.zoomed(window, multiple * picture, picture);
                        let before = placement.pixel_at(window, picture);
                        if before.is_some() {
                            assert_eq!(zoomed.pixel_at(window, picture), before);
                        }
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
