//! How the window is divided between the picture and the panel beside it.

use glam::{IVec2, UVec2};

use crate::screen::Placement;

use super::rect::Rect;

/// The two parts of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) picture: Rect,
    /// `None` where no panel is open.
    pub(super) panel: Option<Rect>,
}

impl Layout {
    /// Divides a window of `surface` pixels. A panel, which should be `wanted` pixels wide and
    /// high, stands to the right of a picture of `size` × `size` pixels; below it, where the window
    /// is taller than wide. It leaves the picture a square of the window's shorter side, or half of
    /// the window, and takes what the picture has no use for.
    pub(super) fn new(surface: UVec2, size: u32, wanted: Option<UVec2>) -> Layout {
        let window = Rect::new(IVec2::ZERO, surface);
        let Some(wanted) = wanted else {
            return Layout {
                picture: window,
                panel: None,
            };
        };
        let (mut picture, mut panel) = (window, window);
        let tall = is_tall(surface);
        let (long, short, wanted) = if tall {
            (surface.y, surface.x, wanted.y)
        } else {
            (surface.x, surface.y, wanted.x)
        };
        let least = wanted.min((long - short).max(long / 2));
        let side = Placement::fit(UVec2::new(long - least, short), size).side;
        // Lines as long as wanted are long enough; there can always be more of them.
        let most = if tall { u32::MAX } else { wanted };
        let length = (long - side).min(most.min(wanted.max(long - short)));
        if tall {
            picture.max.y -= length as i32;
            panel.min.y = picture.max.y;
        } else {
            picture.max.x -= length as i32;
            panel.min.x = picture.max.x;
        }
        Layout {
            picture,
            panel: Some(panel),
        }
    }
}

/// The size of a window that has room for a panel beside a picture of `side` × `side` pixels: at
/// least as large as now.
pub(super) fn with_panel(surface: UVec2, side: u32, wanted: UVec2) -> UVec2 {
    let enough = if is_tall(surface) {
        UVec2::new(surface.x, surface.x + wanted.y)
    } else {
        UVec2::new(side + wanted.x, wanted.y)
    };
    surface.max(enough)
}

fn is_tall(surface: UVec2) -> bool {
    surface.y > surface.x
}

#[cfg(test)]
mod tests {
    use super::*;

    const WANTED: UVec2 = UVec2::new(392, 378);

    #[test]
    fn the_parts_fill_the_window_and_do_not_overlap() {
        for width in (0..2000).step_by(37) {
            for height in (0..2000).step_by(41) {
                let surface = UVec2::new(width, height);
                let layout = Layout::new(surface, 500, Some(WANTED));
                let panel = layout.panel.unwrap_or_default();
                assert!(panel.intersection(layout.picture).is_empty(), "{surface}");
                let area = |rect: Rect| rect.size().element_product();
                let sum = area(panel) + area(layout.picture);
                assert_eq!(sum, width * height, "{surface}");
                let below = panel.min.x == 0 && panel.min.y > 0;
                assert!(
                    surface.min_element() == 0 || below == (height > width),
                    "{surface}"
                );
            }
        }
    }

    #[test]
    fn the_picture_keeps_its_size_where_the_window_may_grow() {
        for (size, surface) in [
            (500, UVec2::new(500, 500)),
            (500, UVec2::new(1280, 720)),
            (120, UVec2::new(120, 120)),
            (120, UVec2::new(360, 1000)),
            (500, UVec2::new(500, 510)),
        ] {
            let side = Placement::fit(surface, size).side;
            let grown = with_panel(surface, side, WANTED);
            let layout = Layout::new(grown, size, Some(WANTED));
            let after = Placement::fit(layout.picture.size(), size).side;
            assert!(after >= side, "{surface}: {side} becomes {after}");
            let panel = layout.panel.map(|panel| panel.size());
            let full = panel.is_some_and(|panel| panel.cmpge(WANTED).all() || surface.x < WANTED.x);
            assert!(full, "{surface}: {panel:?}");
        }
        let grown = with_panel(UVec2::new(500, 500), 500, WANTED);
        assert_eq!(grown, UVec2::new(892, 500), "by the panel's width");
        let wide = UVec2::new(1280, 720);
        assert_eq!(with_panel(wide, 500, WANTED), wide, "there is room already");
    }

    #[test]
    fn half_of_a_window_that_cannot_grow_is_left_to_the_picture() {
        let layout = Layout::new(UVec2::new(500, 500), 500, Some(WANTED));
        assert_eq!(layout.picture.size(), UVec2::new(250, 500));
    }
}
