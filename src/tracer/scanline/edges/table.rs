//! The edge table: all regions of a frame, and the rows that their edges can cross.

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x8};

use crate::tracer::arena::{bucketed, collect};
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::grid::{Grid, ROWS};

/// What the pixels of a region have in common.
#[derive(Clone, Copy)]
pub(crate) enum RegionKind {
    /// Their eye rays meet the surface.
    Surface,
    /// Their points on a receiver are in one shadow.
    Shadow(Receiver),
    /// Of two front faces that share an edge, their eye rays enter the first one last.
    Crease,
    /// Their eye rays meet a solid.
    Direct(SolidIndex),
    /// Their mirrored rays meet a solid.
    Mirrored(SolidIndex),
}

/// The index of a solid among those of a frame that are seen directly, or among those that are seen
/// in the mirror. It is not the solid's number in the scene: most solids of a crowd are not seen.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SolidIndex(pub(crate) u32);

/// The number of what shadows fall on: the surface or a front face.
#[derive(Clone, Copy, Default)]
pub(crate) struct Receiver(pub(crate) u32);

/// An edge table to which regions are added. A region is known by its number.
pub(crate) struct EdgeTableBuilder<'f> {
    arena: &'f Bump,
    regions: Growing<'f, Region<'f>>,
    kinds: Growing<'f, RegionKind>,
    receivers: u32,
}

/// Regions, and what each of them is.
pub(crate) struct Regions<'f> {
    /// By their numbers.
    pub(crate) all: &'f [Region<'f>],
    pub(crate) kinds: RegionKinds<'f>,
}

/// What each of some regions is.
pub(crate) struct RegionKinds<'f> {
    /// By the number of the region.
    pub(crate) all: &'f [RegionKind],
    /// How many receivers of shadows there are.
    pub(crate) receivers: usize,
}

/// The regions of a frame.
pub(crate) struct EdgeTable<'f> {
    pub(crate) regions: Regions<'f>,
    /// For 64 regions at a time, the half-open range of the rows of each: where it begins, and
    /// where it ends. Missing regions and low ones have no rows.
    rows: &'f [[[u32; 64]; 2]],
    /// The numbers of low regions, band by band; a region in two bands is in both.
    low: &'f [u32],
    /// Where each band begins in `low`, and where the last ends.
    low_bands: &'f [u32],
}

/// The most rows of a low region.
const MAX_LOW: u32 = 24;

/// Whether a region with these rows is low: it leaves the active edges as soon as it has entered
/// them.
fn is_low((from, to): (u32, u32)) -> bool {
    from < to && to <= from + MAX_LOW
}

impl EdgeTable<'_> {
    /// The number of words that hold a bit for every region.
    pub(crate) fn words(&self) -> usize {
        self.rows.len()
    }

    /// Whether any region is low.
    pub(crate) fn has_low(&self) -> bool {
        !self.low.is_empty()
    }

    /// The low regions that may have pixels in the band of rows from `first` on.
    pub(crate) fn low(&self, first: u32) -> &[u32] {
        let band = first as usize / ROWS;
        &self.low[self.low_bands[band] as usize..self.low_bands[band + 1] as usize]
    }

    /// A bit for each of 64 regions: whether it is not low and may have pixels in the band of rows
    /// from `first` on.
    #[inline(always)]
    pub(crate) fn reaching<S: Simd>(&self, simd: S, word: usize, first: u32) -> u64 {
        let [from, to] = &self.rows[word];
        let mut reaching = 0;
        for bit in (0..64).step_by(8) {
            let from = u32x8::from_slice(simd, &from[bit..bit + 8]);
            let to = u32x8::from_slice(simd, &to[bit..bit + 8]);
            let is_reaching = from.simd_lt(first + ROWS as u32) & to.simd_gt(first);
            reaching |= is_reaching.to_bitmask() << bit;
        }
        reaching
    }
}

impl<'f> EdgeTableBuilder<'f> {
    /// An empty one, with room for so many regions before it grows.
    pub(crate) fn new(expected: usize, arena: &'f Bump) -> Self {
        EdgeTableBuilder {
            arena,
            regions: Growing::with_capacity_in(expected, arena),
            kinds: Growing::with_capacity_in(expected, arena),
            receivers: 0,
        }
    }

    /// The number of regions so far, and of the next.
    pub(crate) fn count(&self) -> usize {
        self.kinds.len()
    }

    /// Adds a region.
    pub(crate) fn add(&mut self, region: Region<'f>, kind: RegionKind) {
        self.regions.push(region);
        self.kinds.push(kind);
    }

    /// Adds a receiver that is seen in these rows only, and the shadows on it.
    pub(crate) fn add_receiver(
        &mut self,
        shadows: impl IntoIterator<Item = Region<'f>>,
        rows: (u32, u32),
    ) -> Receiver {
        let receiver = Receiver(self.receivers);
        self.receivers += 1;
        let shadows = shadows.into_iter().map(|shadow| shadow.within(rows));
        for shadow in shadows.filter(|shadow| !shadow.is_nowhere()) {
            self.add(shadow, RegionKind::Shadow(receiver));
        }
        receiver
    }

    /// The regions that were added.
    pub(crate) fn regions(self) -> Regions<'f> {
        Regions {
            all: self.regions.into_bump_slice(),
            kinds: RegionKinds {
                all: self.kinds.into_bump_slice(),
                receivers: self.receivers as usize,
            },
        }
    }

    /// Low regions are told apart if a row meets so many more of them than of others.
    pub(crate) fn build(self, low_from: f64, grid: Grid) -> EdgeTable<'f> {
        let is_low = |region: &Region<'_>| is_low(region.rows());
        let more: f64 = self
            .regions
            .iter()
            .map(|region| {
                let (from, to) = region.rows();
                let height = f64::from(to.saturating_sub(from));
                if is_low(region) { height } else { -height }
            })
            .sum();
        let pays = more >= low_from * f64::from(grid.size);
        let is_low = |region: &Region<'_>| pays && is_low(region);
        let regions = self.regions.iter().enumerate();
        let low = regions.filter_map(|(number, region)| {
            let rows = region.rows();
            is_low(region).then_some((number as u32, rows))
        });
        let low = low.flat_map(|(number, (from, to))| {
            let bands = from as usize / ROWS..(to as usize).div_ceil(ROWS);
            bands.map(move |band| (band, number))
        });
        let bands = (grid.size as usize).div_ceil(ROWS);
        let (low, low_bands) = bucketed(self.arena, bands, low);
        let rows = self.regions.chunks(64).map(|regions| {
            let mut rows = [[0; 64]; 2];
            for (bit, region) in regions.iter().enumerate() {
                if !is_low(region) {
                    (rows[0][bit], rows[1][bit]) = region.rows();
                }
            }
            rows
        });
        EdgeTable {
            rows: collect(self.arena, rows),
            low,
            low_bands,
            regions: self.regions(),
        }
    }
}
