//! Tiles of the screen: a pixel asks only the solids that reach its tile.

/// Which solids reach each tile of the screen.
#[derive(Default)]
pub(super) struct Tiles {
    /// Pixels along a side of a tile.
    side: u32,
    /// The number of tiles side by side.
    per_row: u32,
    /// For each tile, the index of its first solid in `solids`; then the length of `solids`.
    pub(super) starts: Vec<u32>,
    /// The solids of each tile, the nearest first.
    pub(super) solids: Vec<u16>,
    /// All solids, the farthest first.
    order: Vec<u16>,
}

/// Tiles in a row, if there are more than [`MAX_UNTILED`] solids.
const TILES: u32 = 32;
/// So many solids share one tile.
const MAX_UNTILED: usize = 16;

impl Tiles {
    /// Finds the tiles of `count` solids in a picture of `size` rows. `extent` is the half-open
    /// range of columns, and that of rows, in which a solid is seen; `nearest` tells how near. Of
    /// several as near, the first in the scene comes first.
    pub(super) fn find(
        &mut self,
        count: usize,
        extent: impl Fn(usize) -> [(u32, u32); 2],
        nearest: impl Fn(usize) -> f64,
        size: u32,
    ) {
        let Tiles {
            starts,
            solids,
            order,
            ..
        } = self;
        let tiles = if count > MAX_UNTILED { TILES } else { 1 };
        let side = size.div_ceil(tiles);
        let per_row = size.div_ceil(side);
        let reached = |solid: usize| {
            let [columns, rows] = extent(solid).map(|(from, to)| {
                if from < to {
                    from / side..to.div_ceil(side)
                } else {
                    0..0
                }
            });
            rows.flat_map(move |row| {
                columns
                    .clone()
                    .map(move |column| (row * per_row + column) as usize)
            })
        };
        // As `bucketed`, but in memory that is reused.
        starts.clear();
        starts.resize((per_row * per_row) as usize + 1, 0);
        for tile in (0..count).flat_map(reached) {
            starts[tile] += 1;
        }
        let mut end = 0;
        for start in starts.iter_mut() {
            end += *start;
            *start = end;
        }
        solids.resize(end as usize, 0);
        // Each tile is filled from its end: the farthest first.
        order.clear();
        order.extend((0..count).map(|solid| solid as u16));
        let nearest = |solid: u16| nearest(usize::from(solid));
        order.sort_unstable_by(|a, b| nearest(*b).total_cmp(&nearest(*a)).then(b.cmp(a)));
        for &solid in order.iter() {
            for tile in reached(usize::from(solid)) {
                starts[tile] -= 1;
                solids[starts[tile] as usize] = solid;
            }
        }
        (self.side, self.per_row) = (side, per_row);
    }

    /// The solids that reach the tile of a pixel.
    pub(super) fn solids_at(&self, (column, row): (u32, u32)) -> &[u16] {
        let tile = (row / self.side * self.per_row + column / self.side) as usize;
        &self.solids[self.starts[tile] as usize..self.starts[tile + 1] as usize]
    }
}
