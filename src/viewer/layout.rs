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
    /// high, stands to the right of `picture`, width and height in pixels; below it, where the
    /// window is taller than the picture is in its width. It leaves the picture the window's
    /// shorter way, or half of the window, and takes what the picture has no use for.
    pub(super) fn new(surface: UVec2, picture: UVec2, wanted: Option<UVec2>) -> Layout {
        let window = Rect::new(IVec2::ZERO, surface);
        let Some(wanted) = wanted else {
            return Layout {
                picture: window,
                panel: None,
            };
        };
        let tall = is_tall(surface, picture);
        let spare = surface.saturating_sub(filled(surface, picture));
        let (long, spare, wanted) = if tall {
            (surface.y, spare.y, wanted.y)
        } else {
            (surface.x, spare.x, wanted.x)
        };
        let least = wanted.min(spare.max(long / 2));
        let used = if tall {
            let room = UVec2::new(surface.x, long - least);
            Placement::fit(room, picture).size.y
        } else {
            let room = UVec2::new(long - least, surface.y);
            Placement::fit(room, picture).size.x
        };
        // Lines as long as wanted are long enough; there can always be more of them.
        let most = if tall { u32::MAX } else { wanted };
        let length = (long - used).min(most.min(wanted.max(spare)));
        let (mut picture, mut panel) = (window, window);
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

/// The size of a window that has room for a panel beside `picture`, which is drawn `side` pixels
/// wide: at least as large as now.
pub(super) fn with_panel(surface: UVec2, picture: UVec2, side: u32, wanted: UVec2) -> UVec2 {
    let beside = surface.max(UVec2::new(side + wanted.x, wanted.y));
    if !is_tall(surface, picture) && !is_tall(beside, picture) {
        return beside;
    }
    let filled = filled(UVec2::new(surface.x, u32::MAX), picture);
    surface.max(UVec2::new(surface.x, filled.y.saturating_add(wanted.y)))
}

/// The part of a window that `picture` would fill if pixels could be divided.
fn filled(surface: UVec2, picture: UVec2) -> UVec2 {
    let across = |length: u32, [from, to]: [u32; 2]| {
        let other = u64::from(length) * u64::from(to) / u64::from(from.max(1));
        u32::try_from(other).unwrap_or(u32::MAX)
    };
    let width = across(surface.y, [picture.y, picture.x]);
    let height = across(surface.x, [picture.x, picture.y]);
    surface.min(UVec2::new(width, height))
}

/// Whether the window is taller than the picture, each by its width.
fn is_tall(surface: UVec2, picture: UVec2) -> bool {
    let [surface, picture] = [surface, picture].map(|size| size.as_i64vec2());
    surface.y * picture.x > surface.x * picture.y
}

#[cfg(test)]
mod tests {
    use super::*;

    const WANTED: UVec2 = UVec2::new(392, 378);
    const PICTURE: UVec2 = UVec2::splat(500);

    #[test]
    fn the_parts_fill_the_window_and_do_not_overlap() {
        for width in (0..2000).step_by(37) {
            for height in (0..2000).step_by(41) {
                let surface = UVec2::new(width, height);
                let layout = Layout::new(surface, PICTURE, Some(WANTED));
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
            let picture = UVec2::splat(size);
            let side = Placement::fit(surface, picture).size.x;
            let grown = with_panel(surface, picture, side, WANTED);
            let layout = Layout::new(grown, picture, Some(WANTED));
            let after = Placement::fit(layout.picture.size(), picture).size.x;
            assert!(after >= side, "{surface}: {side} becomes {after}");
            let panel = layout.panel.map(|panel| panel.size());
            let full = panel.is_some_and(|panel| panel.cmpge(WANTED).all() || surface.x < WANTED.x);
            assert!(full, "{surface}: {panel:?}");
        }
        let grown = with_panel(UVec2::new(500, 500), PICTURE, 500, WANTED);
        assert_eq!(grown, UVec2::new(892, 500), "by the panel's width");
        let wide = UVec2::new(1280, 720);
        assert_eq!(
            with_panel(wide, PICTURE, 500, WANTED),
            wide,
            "there is room already"
        );
    }

    #[test]
    fn a_picture_of_any_aspect_keeps_its_size_beside_the_panel_or_above_it() {
        for (picture, below) in [
            (UVec2::new(1000, 500), false),
            (UVec2::new(400, 800), false),
            (UVec2::new(20, 300), false),
            // To the right it would have to be as high as the panel, and there is room below.
            (UVec2::new(1000, 100), true),
        ] {
            let grown = with_panel(picture, picture, picture.x, WANTED);
            let layout = Layout::new(grown, picture, Some(WANTED));
            let panel = layout.panel.unwrap_or_default();
            assert_eq!(panel.min.y > 0, below, "{picture}");
            assert!(panel.size().cmpge(WANTED).all(), "{picture}: {panel:?}");
            let shown = Placement::fit(layout.picture.size(), picture).size;
            assert_eq!(shown, picture);
        }
    }

    #[test]
    fn half_of_a_window_that_cannot_grow_is_left_to_the_picture() {
        let layout = Layout::new(UVec2::new(500, 500), PICTURE, Some(WANTED));
        assert_eq!(layout.picture.size(), UVec2::new(250, 500));
    }
}
