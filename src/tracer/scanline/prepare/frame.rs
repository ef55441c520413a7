//! A frame, prepared for its rows: plain data, which is all that the later steps know of it.

use bumpalo::Bump;
use fearless_simd::Level;

use crate::number::Bounded;
use crate::stage::Stage;
use crate::tracer::decision::Decision;
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::table::{EdgeTable, RegionKind};
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::prepare::appearance::prepare_solids;
use crate::tracer::scanline::prepare::builder::Builder;
use crate::tracer::scanline::prepare::culling::Tiles;
use crate::tracer::scanline::prepare::outline::Outlines;
use crate::tracer::scanline::prepare::solids::{Appearance, PreparedSolids};
use crate::tracer::scanline::prepare::surface::PreparedSurface;
use crate::tracer::scanline::write::paint::{AllPaints, PaintNumber};

/// From which crowds on a frame is prepared in other ways than from a few solids.
#[derive(Clone, Copy)]
pub(crate) struct Crowd {
    /// The mean number of solids behind a pixel from which on frames are culled.
    pub(crate) cull_from: u64,
    /// How many more low regions than others a row meets, in the mean, where low regions are no
    /// active edges.
    pub(crate) low_from: f64,
    /// The mean number of shadows on front faces in a row from which on faces are late.
    pub(crate) late_from: u64,
    /// How many bytes the regions of late faces may take, besides what tells their casters.
    pub(crate) late_bytes: usize,
    /// The number of places for edges of late faces from which on a thread forgets them.
    pub(crate) late_edges: usize,
}

/// A frame, prepared for its rows.
pub(crate) struct PreparedFrame<'f> {
    pub(crate) grid: Grid,
    pub(crate) edge_table: EdgeTable<'f>,
    pub(crate) paints: AllPaints<'f>,
    pub(crate) background: PaintNumber,
    pub(crate) surface: Option<PreparedSurface<'f>>,
    /// The solids seen directly.
    direct: PreparedSolids<'f>,
    /// How many spheres are shaded.
    pub(crate) shaded_spheres: usize,
    /// How many solids have late faces.
    pub(crate) late_faces: usize,
    /// The paints of Code 2-1, in the stage that shows it.
    pub(crate) quadrants: Option<[PaintNumber; 4]>,
}

impl<'f> PreparedFrame<'f> {
    /// `color` tells the colour of a decision.
    pub(crate) fn new(
        picture: &Picture<'f, Bounded>,
        color: &dyn Fn(Decision) -> [f32; 3],
        crowd: Crowd,
        level: Level,
        arena: &'f Bump,
    ) -> Self {
        let grid = Grid::new(picture.size);
        // Few solids have more regions.
        let regions = 8 * picture.view.solid_count();
        let mut parts = Builder::new((grid, level), color, crowd.late_from, regions, arena);
        let background = parts.paints.add(Decision::Background);
        let mut outlines = Outlines::new(picture, &picture.view, None, (grid, level), arena);
        let is_crowded = outlines.depth_complexity() >= crowd.cull_from;
        let tiles = is_crowded.then(|| {
            let mut tiles = Tiles::new(grid, level, arena);
            outlines.cull(&mut tiles);
            tiles
        });
        let surface = picture.surface.as_ref();
        let surface = surface
            .map(|surface| PreparedSurface::new(picture, surface, tiles.as_ref(), &mut parts));
        let direct = prepare_solids(picture, &picture.view, outlines, &mut parts);
        let quadrant = |number| parts.paints.add(Decision::Quadrant(number));
        let quadrants = (picture.stage == Stage::Image).then(|| [0, 1, 2, 3].map(quadrant));
        PreparedFrame {
            grid,
            edge_table: parts.edge_table.build(crowd.low_from, grid),
            paints: parts.paints.all(),
            background,
            surface,
            direct,
            shaded_spheres: parts.shaded_spheres,
            late_faces: parts.late_faces,
            quadrants,
        }
    }

    /// Asks for the memory of the solids of some regions.
    pub(crate) fn fetch(&self, regions: &[u32]) {
        let kinds = self.edge_table.regions.kinds.all;
        let solids = regions
            .iter()
            .filter_map(|&number| match kinds[number as usize] {
                RegionKind::Direct(solid) => Some((self.solids(false), solid)),
                RegionKind::Mirrored(solid) => Some((self.solids(true), solid)),
                _ => None,
            });
        for (solids, solid) in solids.clone() {
            solids.fetch(solid);
        }
        for (solids, solid) in solids {
            if let Appearance::LateFaces(late) = solids.appearance(solid) {
                late.fetch();
            }
        }
    }

    /// The solids seen directly, or in the mirror if there is one.
    pub(crate) fn solids(&self, mirrored: bool) -> &PreparedSolids<'f> {
        let in_mirror = self
            .surface
            .as_ref()
            .and_then(|surface| surface.mirrored.as_ref());
        in_mirror.filter(|_| mirrored).unwrap_or(&self.direct)
    }
}
