//! Makes late faces, keeps their regions, and crosses them with bands.

use std::cell::Cell;
use std::iter;

use bumpalo::Bump;

use crate::image::MAX_SIZE;
use crate::scene::Solid;
use crate::tracer::arena::collect;
use crate::tracer::decision::Decision;
use crate::tracer::scanline::edges::band_columns::BandColumns;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{Receiver, RegionKind, RegionKinds, Regions};
use crate::tracer::scanline::grid::ROWS;
use crate::tracer::scanline::prepare::appearance::Appearances;
use crate::tracer::scanline::prepare::builder::Builder;
use crate::tracer::scanline::prepare::depth::face_plane;
use crate::tracer::scanline::prepare::front_faces::FrontFaces;
use crate::tracer::scanline::prepare::late_faces::{
    Cast, Kept, KeptRegion, KeptRegions, LateFaces, SplitFaces,
};
use crate::tracer::scanline::prepare::late_source::{LateMaker, LateMemory, LateSource, LateWork};
use crate::tracer::scanline::prepare::outline::OutlinedFaces;
use crate::tracer::scanline::prepare::shadows::shadows_on_face;
use crate::tracer::scanline::row_edges::{Added, RowEdges};
use crate::tracer::scanline::write::paint::AllPaints;
use crate::tracer::tetrahedron::Passage;

/// In a solid of more rows, each shadow's own rows are found.
const FEW_ROWS: u32 = 4 * ROWS as u32;

/// In a solid of no more rows, mostly one band tells all that is asked for.
const LOW: u32 = 2 * ROWS as u32;

/// Few solids have more creases and shadows.
const FEW_REGIONS: usize = 16;

// Rows are kept as u16.
const _: () = assert!(MAX_SIZE <= u16::MAX as u32);

impl<'f> LateFaces<'f> {
    /// The faces. The first call makes them, for a row that shows the solid.
    pub(crate) fn get(
        &self,
        row: u32,
        maker: &LateMaker<'_, 'f>,
        work: &mut LateWork,
    ) -> &'f SplitFaces<'f> {
        self.made.get_or_init(|| {
            work.spare.reset();
            let LateMemory {
                member,
                paints: blocks,
                ..
            } = maker.memory();
            let color = |decision| maker.source.pixels.color(decision);
            let (faces, regions, paints) = self.make(maker.source, &color, &work.spare);
            member.alloc(SplitFaces {
                front_faces: faces,
                kinds: RegionKinds {
                    all: member.alloc_slice_copy(regions.kinds.all),
                    receivers: regions.kinds.receivers,
                },
                paints: paints.kept_in(blocks, member),
                kept: self.keep(&regions, row, maker, (&work.spare, &mut work.edges)),
            })
        })
    }

    /// The faces, their regions and their paints. `color` tells the colour of a decision.
    fn make<'s>(
        &self,
        source: &'s LateSource<'f>,
        color: &'s dyn Fn(Decision) -> [f32; 3],
        spare: &'s Bump,
    ) -> (FrontFaces, Regions<'s>, AllPaints<'s>) {
        let picture = source.pixels.bounded();
        let appearances = Appearances::new(picture, picture.view(self.mirrored), self.mirrored);
        let screen = (source.grid, source.level);
        let mut parts = Builder::new(screen, color, u64::MAX, FEW_REGIONS, spare);
        let faces = appearances.front_faces(&self.outlined, self.tetrahedron, &mut parts);
        (faces, parts.edge_table.regions(), parts.paints.all())
    }

    /// Keeps what tells the edges of the regions; `row` is the first that needs them.
    fn keep(
        &self,
        regions: &Regions<'_>,
        row: u32,
        maker: &LateMaker<'_, 'f>,
        (spare, edges): (&Bump, &mut RowEdges),
    ) -> Kept<'f> {
        let has_memory = maker.has_memory();
        let (from, to) = self.outlined.rows;
        let is_low = to <= from + LOW && regions.all.len() <= FEW_REGIONS;
        if has_memory && is_low {
            edges.clear();
            let added = cross(regions, row, edges, maker.source, spare);
            let LateMemory {
                member,
                edges: blocks,
                ..
            } = maker.memory();
            let band = edges.band(&added).kept_in(blocks, member);
            maker.take(band.size());
            return Kept::Edges { first: row, band };
        }
        let is_ellipse = |region: &Region<'_>| region.ellipse().is_some();
        if has_memory || !regions.all.iter().any(is_ellipse) {
            Kept::Regions(self.keep_regions((regions, has_memory), maker))
        } else {
            Kept::Nothing
        }
    }

    /// Copies regions to memory that the frame keeps, those of shadows whole only if it
    /// `has_memory`.
    fn keep_regions(
        &self,
        (regions, has_memory): (&Regions<'_>, bool),
        maker: &LateMaker<'_, 'f>,
    ) -> &'f [KeptRegion<'f>] {
        let (source, memory) = (maker.source, &maker.memory().member);
        let picture = source.pixels.bounded();
        let view = picture.view(self.mirrored);
        // A tetrahedron's shadow has all rows of the solid. So each has a region, in the order of
        // the casters on its face; then comes that of the surface.
        let tetrahedra = |face: usize| {
            let casters = &picture.scene.facts().casters;
            let casters = casters.on(self.outlined.number, Some(face)).iter();
            casters
                .filter(|caster| matches!(view.solid(usize::from(**caster)), Solid::Tetrahedron(_)))
        };
        let mut faces = Passage::of(self.tetrahedron.eye_signs).entered();
        let mut casters = [(); 4].map(|()| faces.next().map(|face| (face, tetrahedra(face))));
        let (from, to) = self.outlined.rows;
        let is_high = to > from + FEW_ROWS;
        let taken = Cell::new(0);
        let take = |bytes: usize| taken.set(taken.get() + bytes);
        let shadow = |region: &Region<'_>, cast| {
            let half_planes = has_memory.then(|| {
                let borders = region
                    .half_planes()
                    .iter()
                    .map(|half_plane| *half_plane.border());
                let borders = &*memory.alloc_slice_fill_iter(borders);
                take(size_of_val(borders));
                borders
            });
            let (from, to) = if is_high {
                region.rows_between_sides(source.grid)
            } else {
                region.rows()
            };
            KeptRegion::Shadow {
                half_planes,
                cast,
                rows: (from as u16, to as u16),
            }
        };
        let regions = regions.all.iter().zip(regions.kinds.all);
        let regions = regions.map(|(region, kind)| {
            let cast = match kind {
                RegionKind::Shadow(Receiver(index)) if region.ellipse().is_none() => {
                    let of_face = casters[*index as usize].as_mut();
                    of_face.and_then(|(face, casters)| {
                        let (face, caster) = (*face as u8, *casters.next()?);
                        Some(Cast { face, caster })
                    })
                }
                _ => None,
            };
            let shadow = cast.map(|cast| shadow(region, cast));
            shadow.unwrap_or_else(|| {
                take(region.kept_size());
                KeptRegion::Whole(memory.alloc(region.kept_in(memory, self.outlined.outline)))
            })
        });
        let kept = memory.alloc_slice_fill_iter(regions);
        maker.take(taken.get() + size_of_val(kept));
        kept
    }

    /// Adds the edges of `faces`, those of this solid, in the band of rows from `first` on.
    pub(crate) fn cross(
        &self,
        faces: &SplitFaces<'f>,
        first: u32,
        edges: &mut RowEdges,
        source: &LateSource<'f>,
        work: &mut LateWork,
    ) -> Added {
        work.spare.reset();
        let spare = &work.spare;
        let (level, grid) = (source.level, source.grid);
        let Kept::Regions(regions) = faces.kept else {
            // Nobody asks for these paints.
            let (_, regions, _) = self.make(source, &|_| [0.0; 3], spare);
            return cross(&regions, first, edges, source, spare);
        };
        let numbers = (0..).zip(regions).filter(|(_, region)| match region {
            KeptRegion::Whole(region) => reaches(region.rows(), first),
            KeptRegion::Shadow {
                rows: (from, to), ..
            } => reaches((u32::from(*from), u32::from(*to)), first),
        });
        let numbers = collect(spare, numbers.map(|(number, _)| number));
        let again = |cast, band: &mut BandColumns| {
            let shadow = self.shadow(cast, source, spare);
            shadow.cross_at(level, first, grid, band);
        };
        let regions = KeptRegions {
            all: regions,
            outline: (self.outlined.outline, self.outlined.rows),
            again: &again,
        };
        edges.add(&regions, numbers, first, level, grid)
    }

    /// The shadow of a tetrahedron on a front face.
    fn shadow<'s>(
        &'s self,
        Cast { face, caster }: Cast,
        source: &LateSource<'f>,
        spare: &'s Bump,
    ) -> Region<'s> {
        let (grid, view) = (source.grid, source.pixels.bounded().view(self.mirrored));
        let face = self.tetrahedron.solid.inner_half_space(usize::from(face));
        let (plane, screen) = (face_plane(&face, grid), (grid, source.level));
        let casters = iter::once(caster);
        let mut shadows = shadows_on_face((&face, &plane), view, casters, screen, spare);
        // Every caster has one.
        let in_doubt = || Region::new(&[HalfPlane::IN_DOUBT], None, grid);
        let OutlinedFaces { outline, rows, .. } = self.outlined;
        let shadow = shadows.next().unwrap_or_else(in_doubt);
        shadow.within(rows).clipped(outline)
    }
}

/// Whether some rows reach into the band of rows from `first` on.
fn reaches((from, to): (u32, u32), first: u32) -> bool {
    from < first + ROWS as u32 && first < to
}

/// Adds the edges of all of these regions in the band of rows from `first` on.
fn cross(
    regions: &Regions<'_>,
    first: u32,
    edges: &mut RowEdges,
    source: &LateSource<'_>,
    spare: &Bump,
) -> Added {
    let numbers = (0..).zip(regions.all);
    let numbers = numbers.filter(|(_, region)| reaches(region.rows(), first));
    let numbers = collect(spare, numbers.map(|(number, _)| number));
    edges.add(regions, numbers, first, source.level, source.grid)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]
mod tests {
    use super::*;
    use crate::stage::Stage;
    use crate::tracer::scanline::RowTracer;
    use crate::tracer::scanline::prepare::solids::Appearance;
    use crate::tracer::scanline::tests::{
        CROWDED, CROWDED_WITHOUT_MEMORY, slivers, specks, with_tracer,
    };

    /// All late faces of a frame.
    fn all_of<'t, 'f>(tracer: &'t RowTracer<'f>) -> impl Iterator<Item = &'t LateFaces<'f>> {
        [false, true].into_iter().flat_map(|mirrored| {
            let solids = tracer.frame.solids(mirrored);
            // Without a mirror, these are those seen directly.
            let all = solids
                .appearance
                .iter()
                .filter(move |_| solids.mirrored == mirrored);
            all.filter_map(|appearance| match appearance {
                Appearance::LateFaces(late) => Some(*late),
                _ => None,
            })
        })
    }

    /// The edges of late faces in a band of rows, with their regions made again.
    fn made_again<'f>(
        late: &LateFaces<'f>,
        first: u32,
        source: &LateSource<'f>,
        spare: &mut Bump,
    ) -> (RowEdges, Added) {
        spare.reset();
        let (_, regions, _) = late.make(source, &|_| [0.0; 3], spare);
        let numbers: Vec<u32> = (0..regions.all.len() as u32).collect();
        let mut edges = RowEdges::default();
        let added = edges.add(&regions, &numbers, first, source.level, source.grid);
        (edges, added)
    }

    #[test]
    fn kept_regions_have_the_columns_of_those_that_are_made_again() {
        let (text, size) = (slivers(100), 128);
        let crowds = [CROWDED, CROWDED_WITHOUT_MEMORY].into_iter();
        for (alpha, crowd) in crowds.flat_map(|crowd| [(0.0, crowd), (0.3, crowd)]) {
            with_tracer(&text, (Stage::Reflection, alpha, size), crowd, |tracer| {
                let (source, mut spare) = (&tracer.late, Bump::new());
                let (maker, mut work) = (LateMaker::new(source), LateWork::default());
                let (mut shadows, mut whole, mut edges) = (0, 0, 0);
                for late in all_of(tracer) {
                    let faces = late.get(late.outlined.rows.0, &maker, &mut work);
                    let Kept::Regions(regions) = faces.kept else {
                        continue;
                    };
                    for kept in regions {
                        match kept {
                            KeptRegion::Whole(_) => whole += 1,
                            KeptRegion::Shadow { .. } => shadows += 1,
                        }
                    }
                    for first in (0..size).step_by(ROWS) {
                        let mut kept = RowEdges::default();
                        let of_kept = late.cross(faces, first, &mut kept, source, &mut work);
                        let (made, of_made) = made_again(late, first, source, &mut spare);
                        for row in first..first + ROWS as u32 {
                            assert!(
                                kept.sorted(&of_kept, row).eq(made.sorted(&of_made, row)),
                                "α = {alpha}, row {row}"
                            );
                            edges += of_made.count(row);
                        }
                    }
                }
                let counts = (shadows, whole, edges);
                assert!(shadows > 500 && whole > 50 && edges > 2000, "{counts:?}");
            });
        }
    }

    #[test]
    fn kept_edges_are_those_of_regions_that_are_made_again() {
        let (text, size) = (specks(200), 128);
        for alpha in [0.0, 0.3] {
            with_tracer(&text, (Stage::Reflection, alpha, size), CROWDED, |tracer| {
                let (source, mut spare) = (&tracer.late, Bump::new());
                let (maker, mut work) = (LateMaker::new(source), LateWork::default());
                let (mut kept, mut others) = (0, 0);
                for (late, above) in all_of(tracer).zip((0..4).cycle()) {
                    let (from, to) = late.outlined.rows;
                    let asked = (from + above).min(to - 1);
                    let faces = late.get(asked, &maker, &mut work);
                    if !matches!(faces.kept, Kept::Edges { .. }) {
                        continue;
                    }
                    for row in from..to {
                        let first = row - row % ROWS as u32;
                        let (made, of_made) = made_again(late, first, source, &mut spare);
                        let Some(edges) = faces.kept_edges(row) else {
                            assert!(!(asked..asked + ROWS as u32).contains(&row));
                            others += 1;
                            continue;
                        };
                        assert!(
                            edges.eq(made.sorted(&of_made, row)),
                            "α = {alpha}, row {row}"
                        );
                        kept += of_made.count(row);
                    }
                }
                assert!(kept > 500 && others > 50, "{kept}, {others}");
            });
        }
    }
}
