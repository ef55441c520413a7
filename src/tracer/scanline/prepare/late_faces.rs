//! Late faces: the front faces of a tetrahedron in a crowd, prepared when a row first shows the
//! solid.
//!
//! Each face receives the shadows of many solids, and few of a crowd's solids are seen. So the
//! creases and shadows of a solid are no edges of the frame: they are made for the rows that show
//! the solid, and divide what they show of it.
//!
//! A crowd can have millions of such shadows. So of most, only the borders of their half-planes are
//! kept, and they are made again in the few bands in which that leaves a doubt; and where the memory
//! for that is used up, they are made again in each band that they reach.
//!
//! A low solid is mostly seen in a few rows. Of one with few creases and shadows, the edges in these
//! rows are kept instead, crossed while the regions are at hand; in other rows, these are made
//! again.

use std::sync::OnceLock;

use fearless_simd::Simd;

use crate::number::Bounded;
use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::border::Border;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::region::{Region, enclose};
use crate::tracer::scanline::edges::table::RegionKinds;
use crate::tracer::scanline::fetch::fetch;
use crate::tracer::scanline::grid::{Grid, ROWS};
use crate::tracer::scanline::prepare::front_faces::FrontFaces;
use crate::tracer::scanline::prepare::outline::OutlinedFaces;
use crate::tracer::scanline::row_edges::{BandEdges, BandRegions, RowOfEdges};
use crate::tracer::scanline::write::paint::AllPaints;
use crate::tracer::view_tetrahedra::TetrahedronInView;

/// The front faces of a tetrahedron, made when they are first asked for.
pub(crate) struct LateFaces<'f> {
    /// The number among all late faces of the frame.
    pub(crate) number: usize,
    /// Whether the solid is seen in the mirror.
    pub(super) mirrored: bool,
    /// What they are made from.
    pub(super) outlined: OutlinedFaces<'f>,
    pub(super) tetrahedron: &'f TetrahedronInView<Bounded>,
    /// They themselves, once they are made.
    pub(super) made: OnceLock<&'f SplitFaces<'f>>,
}

/// Front faces with regions and paints of their own.
pub(crate) struct SplitFaces<'f> {
    /// The faces; receivers, creases and paints are numbers among those of this solid.
    pub(crate) front_faces: FrontFaces,
    /// What the regions are: the creases, and the shadows on the faces.
    pub(crate) kinds: RegionKinds<'f>,
    /// The paints of the faces.
    pub(crate) paints: AllPaints<'f>,
    /// What is kept of the regions.
    pub(super) kept: Kept<'f>,
}

/// What is kept of the regions of late faces.
pub(super) enum Kept<'f> {
    Regions(&'f [KeptRegion<'f>]),
    /// The edges in the rows of a band, which may begin at any row.
    Edges {
        first: u32,
        band: BandEdges<'f>,
    },
    /// There was no memory for anything.
    Nothing,
}

impl<'f> SplitFaces<'f> {
    /// The edges in a row, if they are kept.
    pub(crate) fn kept_edges(&self, row: u32) -> Option<RowOfEdges<'f>> {
        let Kept::Edges { first, band } = self.kept else {
            return None;
        };
        let row = row.checked_sub(first)? as usize;
        (row < ROWS).then(|| band.row(row))
    }
}

/// A region of late faces, as it is kept.
pub(super) enum KeptRegion<'f> {
    Whole(&'f Region<'f>),
    /// The shadow of a tetrahedron, clipped to the outline of the solid.
    Shadow {
        /// The borders of its half-planes, if there was memory for them.
        half_planes: Option<&'f [Border]>,
        cast: Cast,
        /// The rows in which the shadow may have pixels.
        rows: (u16, u16),
    },
}

/// Which shadow of a tetrahedron it is.
#[derive(Clone, Copy)]
pub(super) struct Cast {
    /// The number of the face that it falls on.
    pub(super) face: u8,
    /// The number of the tetrahedron in the scene.
    pub(super) caster: u16,
}

impl<'f> LateFaces<'f> {
    /// Nothing is made yet.
    pub(crate) fn new(
        number: usize,
        mirrored: bool,
        outlined: OutlinedFaces<'f>,
        tetrahedron: &'f TetrahedronInView<Bounded>,
    ) -> Self {
        LateFaces {
            number,
            mirrored,
            outlined,
            tetrahedron,
            made: OnceLock::new(),
        }
    }

    /// Asks for the memory that getting them takes.
    #[inline(always)]
    pub(crate) fn fetch(&self) {
        fetch(&self.number);
        fetch(&self.made.get().is_some());
    }
}

/// The kept regions of late faces, to be crossed.
pub(super) struct KeptRegions<'a, 'f> {
    pub(super) all: &'a [KeptRegion<'f>],
    /// The half-planes of the solid's outline, and its rows.
    pub(super) outline: (&'f [HalfPlane<'f>], (u32, u32)),
    /// Finds the columns of a shadow in the band, made again.
    pub(super) again: &'a dyn Fn(Cast, &mut BandColumns),
}

impl BandRegions for KeptRegions<'_, '_> {
    #[inline(always)]
    fn fetch(&self, number: usize) {
        if let KeptRegion::Shadow {
            half_planes: Some([first, ..]),
            ..
        } = &self.all[number]
        {
            fetch(first);
        }
    }

    #[inline(always)]
    fn cross<S: Simd>(
        &self,
        simd: S,
        number: usize,
        (first, grid): (u32, Grid),
        band: &mut BandColumns,
    ) {
        match &self.all[number] {
            KeptRegion::Whole(region) => region.cross_at(simd.level(), first, grid, band),
            KeptRegion::Shadow {
                half_planes, cast, ..
            } => {
                let (outline, rows) = self.outline;
                if let Some(half_planes) = half_planes {
                    let all = (*half_planes, outline);
                    enclose(simd, None, all, (rows, first), grid, band);
                    if band.is_certain {
                        return;
                    }
                }
                (self.again)(*cast, band);
            }
        }
    }
}
