//! Which part of the picture the window shows.

use glam::{IVec2, UVec2};

use crate::screen::Placement;

/// The largest square that a pixel of the picture becomes, in pixels of the window.
const MAX_MULTIPLE: u32 = 64;

/// The picture as a whole, or a part of it that was zoomed and dragged to.
#[derive(Debug, Default)]
pub(super) struct Zoom {
    /// `None` where the whole picture is shown.
    chosen: Option<Placement>,
}

impl Zoom {
    /// Where `picture`, width and height in pixels, lies on a surface.
    pub(super) fn placement(&self, surface: UVec2, picture: UVec2) -> Placement {
        self.chosen
            .unwrap_or_else(|| Placement::fit(surface, picture))
    }

    /// Shows the whole picture.
    pub(super) fn fit(&mut self) {
        self.chosen = None;
    }

    /// Zooms by `steps`, outward where they are negative. The pixel of the picture at `pointer`
    /// stays there, as long as the middle of the window shows the picture.
    pub(super) fn by(&mut self, steps: i32, pointer: IVec2, surface: UVec2, picture: UVec2) {
        // By the longer side, which the shorter one follows.
        let size = picture.max_element();
        let least = Placement::fit(surface, picture).size.max_element();
        if least == 0 {
            return;
        }
        let mut placement = self.placement(surface, picture);
        for _ in 0..steps.unsigned_abs().min(MAX_MULTIPLE) {
            let side = placement.size.max_element();
            let side = if steps > 0 {
                larger(side, size).max(least)
            } else {
                smaller(side, size)
            };
            if side <= least && steps < 0 {
                self.fit();
                return;
            }
            placement = placement.zoomed(pointer, Placement::scaled(picture, side), picture);
        }
        self.chosen = Some(placement.around_the_middle(surface));
    }

    /// Moves the picture by so many pixels of the window.
    pub(super) fn drag(&mut self, by: IVec2, surface: UVec2, picture: UVec2) {
        let mut placement = self.placement(surface, picture);
        placement.origin = placement.origin.saturating_add(by);
        self.chosen = Some(placement.around_the_middle(surface));
    }

    /// The surface has a new size: what was in its middle stays there.
    pub(super) fn resize(&mut self, from: UVec2, to: UVec2) {
        if let Some(placement) = &mut self.chosen {
            placement.origin += to.as_ivec2() / 2 - from.as_ivec2() / 2;
            *placement = placement.around_the_middle(to);
        }
    }
}

/// The next larger side: in whole multiples of `size` once there is one.
fn larger(side: u32, size: u32) -> u32 {
    if side < size {
        return side.saturating_add(side.div_ceil(4)).min(size);
    }
    let multiple = side / size;
    let next = (multiple + (multiple / 4).max(1)).min(MAX_MULTIPLE.max(multiple));
    let next = next.saturating_mul(size);
    if next <= Placement::max_side(size) {
        next
    } else {
        side
    }
}

/// The next smaller side.
fn smaller(side: u32, size: u32) -> u32 {
    if side <= size {
        return side - side.div_ceil(5);
    }
    let multiple = side / size;
    (multiple - (multiple / 5).max(1)) * size
}

#[cfg(test)]
mod tests {
    use super::*;

    const SURFACE: UVec2 = UVec2::new(640, 500);
    const PICTURE: UVec2 = UVec2::splat(500);

    #[test]
    fn what_is_under_the_pointer_stays_there_however_far() {
        for picture in [
            UVec2::splat(40),
            UVec2::splat(500),
            UVec2::splat(1500),
            UVec2::new(400, 33),
            UVec2::new(70, 1400),
        ] {
            let mut zoom = Zoom::default();
            let pointer = IVec2::new(300, 222);
            let placement = |zoom: &Zoom| zoom.placement(SURFACE, picture);
            let pixel = |zoom: &Zoom| placement(zoom).pixel_at(pointer, picture);
            for _ in 0..30 {
                // A pixel of the window may show several of a picture that is larger; from 1:1 on
                // it shows one.
                let single = placement(&zoom).size.cmpge(picture).all();
                let before = pixel(&zoom);
                zoom.by(1, pointer, SURFACE, picture);
                if single {
                    assert_eq!(pixel(&zoom), before);
                }
            }
            assert_eq!(placement(&zoom).size, MAX_MULTIPLE * picture);
            zoom.by(-100, pointer, SURFACE, picture);
            assert_eq!(zoom.chosen, None, "all the way out is the whole picture");
        }
    }

    #[test]
    fn pixels_become_squares_of_one_size() {
        let mut zoom = Zoom::default();
        for _ in 0..40 {
            zoom.by(1, IVec2::ZERO, SURFACE, UVec2::splat(700));
            let side = zoom.placement(SURFACE, UVec2::splat(700)).size.x;
            assert!(side < 700 || side % 700 == 0, "{side}");
        }
        let mut zoom = Zoom::default();
        zoom.by(40, IVec2::ZERO, SURFACE, UVec2::splat(16384));
        let side = zoom.placement(SURFACE, UVec2::splat(16384)).size.x;
        assert!(side > 16384 && side <= Placement::max_side(16384));
    }

    #[test]
    fn the_middle_of_the_window_never_leaves_the_picture() {
        let mut zoom = Zoom::default();
        zoom.by(3, IVec2::ZERO, SURFACE, PICTURE);
        let middle = SURFACE.as_ivec2() / 2;
        for by in [
            IVec2::splat(-100_000),
            IVec2::new(i32::MAX, 3),
            IVec2::splat(i32::MIN),
        ] {
            zoom.drag(by, SURFACE, PICTURE);
            let placement = zoom.placement(SURFACE, PICTURE);
            assert!(
                placement.pixel_at(middle, PICTURE).is_some(),
                "{placement:?}"
            );
        }
        zoom.resize(SURFACE, UVec2::new(31, 1000));
        let placement = zoom.placement(UVec2::new(31, 1000), PICTURE);
        assert!(placement.pixel_at(IVec2::new(15, 500), PICTURE).is_some());
    }

    #[test]
    fn a_window_without_room_is_not_zoomed() {
        let mut zoom = Zoom::default();
        zoom.by(5, IVec2::ZERO, UVec2::new(640, 0), PICTURE);
        assert_eq!(zoom.chosen, None);
    }
}
