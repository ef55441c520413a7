//! Hidden-surface culling: in which rows a solid, a shadow or a mirror image can be seen at all.
//!
//! The screen is cut into tiles. If the outline of a solid covers a tile, the solid hides there
//! whatever lies behind the farthest point at which eye rays enter it. A region that is hidden in
//! all its tiles is left out. Culling decides about no pixel: it may miss what is hidden, but never
//! hides what is seen.

use bumpalo::Bump;
use fearless_simd::Level;

use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::grid::{Columns, Grid, ROWS};
use crate::tracer::scanline::prepare::depth::{Depth, Rectangle};

/// The most tiles in a row of tiles.
const TILES_IN_A_ROW: u32 = 16;
/// The most rows of tiles. The height of a tile is a multiple of [`ROWS`].
const TILE_ROWS: u32 = 64;

/// A half-open range of rows.
pub(crate) type Rows = (u32, u32);

/// The tiles of a screen, each with a depth behind which nothing is seen.
pub(crate) struct Tiles<'f> {
    grid: Grid,
    level: Level,
    /// The columns of a tile.
    width: u32,
    /// The rows of a tile.
    height: u32,
    /// For each tile, from the left and row by row from the bottom: the depth behind which all is
    /// hidden.
    hidden_behind: &'f mut [f64],
    /// The number of tiles in a row of tiles.
    across: u32,
}

/// The columns of a region in a row of tiles.
struct TileRowColumns {
    /// The columns that the region may have in any row of pixels.
    possible: Columns,
    /// The columns that the region certainly has in all rows of pixels.
    certain: Columns,
}

impl<'f> Tiles<'f> {
    /// Tiles in which everything is seen.
    pub(crate) fn new(grid: Grid, level: Level, arena: &'f Bump) -> Self {
        let rows = ROWS as u32;
        let width = grid.size.div_ceil(TILES_IN_A_ROW).max(rows);
        let height = grid.size.div_ceil(TILE_ROWS).next_multiple_of(rows);
        let (across, up) = (grid.size.div_ceil(width), grid.size.div_ceil(height));
        Tiles {
            grid,
            level,
            width,
            height,
            hidden_behind: arena.alloc_slice_fill_copy((across * up) as usize, f64::INFINITY),
            across,
        }
    }

    fn up(&self) -> u32 {
        self.hidden_behind.len() as u32 / self.across
    }

    fn number(&self, across: u32, up: u32) -> usize {
        (up * self.across + across) as usize
    }

    /// The rows of tiles in which these rows lie.
    fn rows_of_tiles(&self, (from, to): Rows) -> std::ops::Range<u32> {
        from / self.height..to.div_ceil(self.height).min(self.up())
    }

    /// The columns and rows of a tile.
    fn of(&self, across: u32, up: u32) -> (Columns, Rows) {
        let ends = |number: u32, length: u32| {
            let from = number * length;
            (from, (from + length).min(self.grid.size))
        };
        (ends(across, self.width), ends(up, self.height))
    }

    fn rectangle(&self, across: u32, up: u32) -> Rectangle {
        let (columns, rows) = self.of(across, up);
        let ends =
            |(from, to): (u32, u32)| [from, to - 1].map(|number| self.grid.coordinate(number));
        Rectangle {
            x: ends(columns),
            y: ends(rows),
        }
    }

    fn columns(&self, region: &Region<'_>, up: u32) -> TileRowColumns {
        let (_, (from, to)) = self.of(0, up);
        let mut columns = TileRowColumns {
            possible: (self.grid.size, 0),
            certain: (0, self.grid.size),
        };
        let mut band = BandColumns::NONE;
        for first in (from..to).step_by(ROWS) {
            region.cross_at(self.level, first, self.grid, &mut band);
            for row in 0..((to - first) as usize).min(ROWS) {
                let ends = |ends: &[[u32; ROWS]; 2]| (ends[0][row], ends[1][row]);
                let (possible, certain) = (ends(&band.possible), ends(&band.certain));
                if band.filled >> row & 1 == 0 {
                    columns.certain = (0, 0);
                    continue;
                }
                columns.possible.0 = columns.possible.0.min(possible.0);
                columns.possible.1 = columns.possible.1.max(possible.1);
                columns.certain.0 = columns.certain.0.max(certain.0);
                columns.certain.1 = columns.certain.1.min(certain.1);
            }
        }
        columns
    }

    /// The tiles of a row that have any of these columns.
    fn reached(&self, (from, to): Columns) -> std::ops::Range<u32> {
        if from < to {
            from / self.width..to.div_ceil(self.width)
        } else {
            0..0
        }
    }

    /// The tiles of a row that have no columns but these.
    fn covered(&self, (from, to): Columns) -> std::ops::Range<u32> {
        let end = if to == self.grid.size {
            self.across
        } else {
            to / self.width
        };
        from.div_ceil(self.width)..end
    }

    /// Hides what lies behind a solid, in the tiles that its outline covers.
    pub(crate) fn hide_behind(&mut self, outline: &Region<'_>, depth: &Depth<'_>) {
        for up in self.rows_of_tiles(outline.rows()) {
            let columns = self.columns(outline, up);
            for across in self.covered(columns.certain) {
                let (_, upper) = depth.bounds(None, self.rectangle(across, up));
                let before = &mut self.hidden_behind[(up * self.across + across) as usize];
                *before = before.min(upper);
            }
        }
    }

    /// The rows in which a solid can be seen, from the first tile to the last in which it is not
    /// hidden.
    pub(crate) fn rows_of_solid(&self, outline: &Region<'_>, depth: &Depth<'_>) -> Rows {
        self.rows_where(outline, |across, up| {
            let (lower, _) = depth.bounds(None, self.rectangle(across, up));
            // A depth that is a NaN hides nothing.
            let is_hidden = lower > self.hidden_behind[self.number(across, up)];
            !is_hidden
        })
    }

    /// The rows of a region from the first tile to the last for which `holds` is true.
    fn rows_where(&self, region: &Region<'_>, holds: impl Fn(u32, u32) -> bool) -> Rows {
        let is_seen = |up: &u32| {
            let columns = self.columns(region, *up);
            self.reached(columns.possible)
                .any(|across| holds(across, *up))
        };
        let mut tiles = self.rows_of_tiles(region.rows());
        let first = tiles.find(is_seen);
        let Some(first) = first else {
            return (0, 0);
        };
        let last = tiles.rfind(is_seen).unwrap_or(first);
        let (from, to) = region.rows();
        let (_, (begin, _)) = self.of(0, first);
        let (_, (_, end)) = self.of(0, last);
        (from.max(begin), to.min(end))
    }

    /// Tiles for what is seen through a region, which is at least as far away as `min_depth` tells
    /// for each Y. In tiles where the region may be seen, everything is seen; in others, nothing.
    pub(crate) fn seen_through(
        &self,
        region: &Region<'_>,
        min_depth: impl Fn(f64) -> f64,
        arena: &'f Bump,
    ) -> Tiles<'f> {
        let tiles = Tiles::new(self.grid, self.level, arena);
        tiles.hidden_behind.fill(f64::NEG_INFINITY);
        for up in self.rows_of_tiles(region.rows()) {
            let columns = self.columns(region, up);
            for across in self.reached(columns.possible) {
                let [low, high] = self.rectangle(across, up).y;
                let number = self.number(across, up);
                let is_hidden = min_depth(low).min(min_depth(high)) > self.hidden_behind[number];
                if !is_hidden {
                    tiles.hidden_behind[number] = f64::INFINITY;
                }
            }
        }
        tiles
    }

    /// Leaves out rows in which shadows on one receiver make no difference: in a tile that a shadow
    /// covers, the others are not needed.
    pub(crate) fn restrict_shadows(&self, shadows: &mut [Region<'_>], arena: &Bump) {
        let covering = arena.alloc_slice_fill_copy(self.hidden_behind.len(), u32::MAX);
        for (shadow, region) in shadows.iter().enumerate() {
            for up in self.rows_of_tiles(region.rows()) {
                for across in self.covered(self.columns(region, up).certain) {
                    let first = &mut covering[self.number(across, up)];
                    *first = (*first).min(shadow as u32);
                }
            }
        }
        for (shadow, region) in shadows.iter_mut().enumerate() {
            let rows = self.rows_where(region, |across, up| {
                let number = self.number(across, up);
                let first = covering[number];
                self.hidden_behind[number] > f64::NEG_INFINITY
                    && (first == u32::MAX || first == shadow as u32)
            });
            region.restrict(rows);
        }
    }
}
