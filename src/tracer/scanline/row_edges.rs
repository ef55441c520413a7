//! The edges of regions in the rows of a band, each row by itself: nothing is kept of their order
//! from one row to the next.

use bumpalo_herd::Member;
use fearless_simd::{Level, Simd, dispatch};

use crate::image::MAX_SIZE;
use crate::tracer::arena::Blocks;
use crate::tracer::scanline::active::Edge;
use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::table::Regions;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::sort::{BLOCK, sort_rows};

/// An edge of a region after its column in a row, in one number: of two edges, that with the
/// smaller number comes first.
///
/// All numbers lie in [1, 2), where no two are equal, and none is a NaN or subnormal: minimum and
/// maximum order them alike on every processor.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct EdgeAt(f64);

impl EdgeAt {
    /// A column behind all others.
    const BEYOND: u32 = (1 << 20) - 1;

    /// In place of an edge where a row has no more.
    const NONE: EdgeAt = EdgeAt::new(EdgeAt::BEYOND, Edge(u32::MAX));

    const fn new(column: u32, edge: Edge) -> EdgeAt {
        // After the exponent of 1, 20 bits for the column and 32 for the edge.
        let bits = (column as u64) << 32 | edge.0 as u64;
        EdgeAt(f64::from_bits(1.0_f64.to_bits() | bits))
    }

    /// The column at which it is.
    pub(crate) fn column(self) -> u32 {
        (self.0.to_bits() >> 32) as u32 & EdgeAt::BEYOND
    }

    /// The edge itself.
    pub(crate) fn edge(self) -> Edge {
        Edge(self.0.to_bits() as u32)
    }
}

const _: () = assert!(MAX_SIZE < EdgeAt::BEYOND);

/// Regions that bands can cross.
pub(crate) trait BandRegions {
    /// Asks for the memory that crossing the region of this number takes.
    fn fetch(&self, number: usize);

    /// Finds the columns of the region of this number in the band of rows from the given one on.
    /// `band` may hold anything before.
    fn cross<S: Simd>(&self, simd: S, number: usize, first: (u32, Grid), band: &mut BandColumns);
}

impl BandRegions for Regions<'_> {
    #[inline(always)]
    fn fetch(&self, number: usize) {
        self.all[number].fetch();
    }

    #[inline(always)]
    fn cross<S: Simd>(
        &self,
        simd: S,
        number: usize,
        (first, grid): (u32, Grid),
        band: &mut BandColumns,
    ) {
        self.all[number].cross(simd, first, grid, band);
    }
}

/// The edges of some regions in each row of a band.
#[derive(Default)]
pub(crate) struct RowEdges {
    /// Those of each row, side by side: vector instructions sort all rows at once.
    edges: Vec<[f64; ROWS]>,
    /// How many of `edges` are in use; the others are memory for more.
    used: usize,
    /// The columns of regions whose edges are to be written.
    bands: [BandColumns; AT_ONCE],
}

/// So many regions are crossed before the edges of the first are written: no crossing then waits
/// for what is unpredictable about the edges of another, and the memory of all is asked for at
/// once.
const AT_ONCE: usize = 16;

/// Which edges were added together.
#[derive(Clone, Copy, Default)]
pub(crate) struct Added {
    /// Where they begin among all.
    begin: usize,
    /// How many there are in each row.
    counts: [usize; ROWS],
}

impl Added {
    /// How many there are in a row of the band.
    pub(crate) fn count(&self, row: u32) -> usize {
        self.counts[row as usize % ROWS]
    }
}

impl RowEdges {
    /// Removes all edges.
    pub(crate) fn clear(&mut self) {
        self.used = 0;
    }

    /// The number of places for edges that are in use, those included that stay empty because
    /// another row of the band has more edges, or because whole blocks are sorted.
    pub(crate) fn places(&self) -> usize {
        ROWS * self.used
    }

    /// Adds the edges of the regions of these numbers in the band of rows from `first` on, sorted.
    pub(crate) fn add(
        &mut self,
        regions: &impl BandRegions,
        numbers: &[u32],
        first: u32,
        level: Level,
        grid: Grid,
    ) -> Added {
        dispatch!(level, simd => {
            let added = self.cross_all(simd, regions, numbers, first, grid);
            sort_rows(simd, &mut self.edges[added.begin..self.used]);
            added
        })
    }

    /// The same without sorting them.
    #[inline(always)]
    fn cross_all<S: Simd>(
        &mut self,
        simd: S,
        regions: &impl BandRegions,
        numbers: &[u32],
        first: u32,
        grid: Grid,
    ) -> Added {
        let begin = self.used;
        let mut ends = [begin; ROWS];
        let mut most = begin;
        for numbers in numbers.chunks(AT_ONCE) {
            for &number in numbers {
                regions.fetch(number as usize);
            }
            for (band, &number) in self.bands.iter_mut().zip(numbers) {
                regions.cross(simd, number as usize, (first, grid), band);
            }
            // A region has at most four edges in each row.
            most += 4 * numbers.len();
            if self.edges.len() < most {
                self.edges.resize(most, [0.0; ROWS]);
            }
            for (band, &number) in self.bands.iter().zip(numbers) {
                push(&mut self.edges, &mut ends, number, band);
            }
        }
        for end in ends {
            self.used = self.used.max(end);
        }
        self.used = begin + (self.used - begin).next_multiple_of(BLOCK);
        if self.edges.len() < self.used {
            self.edges.resize(self.used, [0.0; ROWS]);
        }
        for (row, &end) in ends.iter().enumerate() {
            for edges in &mut self.edges[end..self.used] {
                edges[row] = EdgeAt::NONE.0;
            }
        }
        let counts = ends.map(|end| end - begin);
        Added { begin, counts }
    }

    /// Those edges that were added together.
    pub(crate) fn band(&self, added: &Added) -> BandEdges<'_> {
        let most = added.counts.into_iter().max().unwrap_or(0);
        BandEdges {
            edges: &self.edges[added.begin..added.begin + most],
            counts: added.counts.map(|count| count as u32),
        }
    }

    /// Those edges of a row of the band that were added together.
    pub(crate) fn sorted(&self, added: &Added, row: u32) -> RowOfEdges<'_> {
        let row = row as usize % ROWS;
        RowOfEdges {
            edges: self.edges[added.begin..added.begin + added.counts[row]].iter(),
            row,
        }
    }
}

/// The edges of some regions in each row of a band, sorted.
#[derive(Clone, Copy)]
pub(crate) struct BandEdges<'a> {
    edges: &'a [[f64; ROWS]],
    /// How many there are in each row.
    counts: [u32; ROWS],
}

impl<'a> BandEdges<'a> {
    /// The same in other memory.
    pub(crate) fn kept_in<'k>(
        &self,
        blocks: &Blocks<'k, [f64; ROWS]>,
        memory: &Member<'k>,
    ) -> BandEdges<'k> {
        BandEdges {
            edges: blocks.keep(self.edges, memory),
            counts: self.counts,
        }
    }

    /// How many bytes the edges take.
    pub(crate) fn size(&self) -> usize {
        size_of_val(self.edges)
    }

    /// The edges in a row, by its number in the band.
    pub(crate) fn row(self, row: usize) -> RowOfEdges<'a> {
        RowOfEdges {
            edges: self.edges[..self.counts[row] as usize].iter(),
            row,
        }
    }
}

/// The edges in a row, from the left.
pub(crate) struct RowOfEdges<'a> {
    edges: std::slice::Iter<'a, [f64; ROWS]>,
    /// The number of the row in its band.
    row: usize,
}

impl Iterator for RowOfEdges<'_> {
    type Item = EdgeAt;

    #[inline]
    fn next(&mut self) -> Option<EdgeAt> {
        self.edges.next().map(|rows| EdgeAt(rows[self.row]))
    }
}

/// Writes the edges of a region behind those of each row, which end at `ends`.
#[inline(always)]
fn push(edges: &mut [[f64; ROWS]], ends: &mut [usize; ROWS], region: u32, band: &BandColumns) {
    let ([a, d], [b, c]) = (&band.possible, &band.certain);
    let is_filled = |row: usize| band.filled >> row & 1 == 1;
    let edge = |kind: u32, column: u32| EdgeAt::new(column, Edge(4 * region + kind)).0;
    if band.is_certain {
        // No processor predicts in which rows a low region has columns: so edges are written for
        // all rows, and the end of each tells whether they count.
        for row in 0..ROWS {
            let end = ends[row];
            edges[end][row] = edge(1, a[row]);
            edges[end + 1][row] = edge(3, d[row]);
            ends[row] = end + 2 * (band.filled >> row & 1) as usize;
        }
        return;
    }
    for row in (0..ROWS).filter(|row| is_filled(*row)) {
        let columns = [a[row], b[row], c[row], d[row]];
        let is_certain = (a[row], d[row]) == (b[row], c[row]);
        for kind in Edge::of(region as usize, is_certain).map(Edge::kind) {
            edges[ends[row]][row] = edge(kind as u32, columns[kind]);
            ends[row] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::tracer;

    /// Random columns of regions in a band.
    struct RandomRegions(Vec<BandColumns>);

    impl BandRegions for RandomRegions {
        fn fetch(&self, _: usize) {}

        fn cross<S: Simd>(&self, _: S, number: usize, _: (u32, Grid), band: &mut BandColumns) {
            *band = self.0[number].clone();
        }
    }

    impl RandomRegions {
        fn new(count: usize, random: &mut Random) -> RandomRegions {
            let region = |_| {
                let mut band = BandColumns::NONE;
                for row in 0..ROWS {
                    let mut columns = [(); 4].map(|()| random.below(MAX_SIZE as usize + 1) as u32);
                    columns.sort_unstable();
                    let [a, mut b, mut c, d] = columns;
                    if random.below(3) > 0 {
                        (b, c) = (a, d);
                    }
                    (band.possible[0][row], band.possible[1][row]) = (a, d);
                    (band.certain[0][row], band.certain[1][row]) = (b, c);
                    band.is_certain &= (a, d) == (b, c);
                    band.filled |= u64::from(a < d && random.below(2) > 0) << row;
                }
                band
            };
            RandomRegions((0..count).map(region).collect())
        }

        /// The edges in a row, from the left.
        fn edges(&self, row: usize) -> Vec<(u32, Edge)> {
            let numbered = self.0.iter().enumerate();
            let filled = numbered.filter(|(_, band)| band.filled >> row & 1 == 1);
            let edges = filled.flat_map(|(number, band)| {
                let ([a, d], [b, c]) = (band.possible, band.certain);
                let columns = [a[row], b[row], c[row], d[row]];
                let is_certain = (columns[0], columns[3]) == (columns[1], columns[2]);
                Edge::of(number, is_certain).map(move |edge| (columns[edge.kind()], edge))
            });
            let mut edges: Vec<_> = edges.collect();
            edges.sort_unstable();
            edges
        }
    }

    #[test]
    fn each_row_has_the_edges_of_its_regions_from_the_left() {
        let mut random = Random::new();
        let grid = Grid::new(MAX_SIZE);
        for level in tracer::Simd::all().into_iter().map(|simd| simd.0) {
            let mut all = RowEdges::default();
            for count in (0..40).chain([100, 128, 129]) {
                if count % 10 == 0 {
                    all.clear();
                }
                let [regions, others] = [(); 2].map(|()| RandomRegions::new(count, &mut random));
                let numbers: Vec<u32> = (0..count as u32).collect();
                let added = all.add(&regions, &numbers, 0, level, grid);
                all.add(&others, &numbers, 0, level, grid);
                for row in 0..ROWS {
                    let sorted = all.sorted(&added, row as u32);
                    let sorted: Vec<_> = sorted.map(|at| (at.column(), at.edge())).collect();
                    assert!(sorted == regions.edges(row), "{count} regions, row {row}");
                }
            }
        }
    }
}
