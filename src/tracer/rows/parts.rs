//! A frame as it is prepared.

use bumpalo::Bump;

use super::border::Borders;
use super::paint::Paints;
use super::place::Screen;

/// What a frame's rows are made of, as they are prepared.
pub(super) struct Parts<'f, 'c> {
    pub(super) screen: Screen,
    pub(super) arena: &'f Bump,
    pub(super) borders: Borders<'f>,
    pub(super) paints: Paints<'f, 'c>,
    pub(super) balls: usize,
}
