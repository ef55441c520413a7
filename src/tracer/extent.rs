//! Bounding rectangles on the screen: most pixels need not be tested against most solids.

use std::ops::RangeInclusive;

use bumpalo::Bump;

use super::arena::collect;
use super::surface_casters::SurfaceCasterLookup;
use super::vector::Vector;
use super::view_space::{
    EYE_SQUARED, EYE_Y, EYE_Z, PIXEL, along_eye_ray, coordinate, number_at, reflect,
};
use super::view_transform::ViewTransform;
use crate::number::Bounded;
use crate::scene::Scene;

/// The pixels whose eye ray can meet a solid; all others certainly miss it.
#[derive(Clone, Debug)]
pub(super) struct Extent {
    /// May reach beyond the picture, as `rows` may.
    columns: RangeInclusive<i64>,
    rows: RangeInclusive<i64>,
}

/// The extents of a frame: of every solid, of every solid in the mirror, and of the surface; and
/// the casters of the surface.
pub(super) struct Extents<'f> {
    pub(super) direct: ExtentsOfSolids<'f>,
    pub(super) mirrored: ExtentsOfSolids<'f>,
    pub(super) surface: Option<Extent>,
    pub(super) casters_on_surface: Option<SurfaceCasterLookup<'f>>,
}

/// The extents of all solids, and which of them reach each tile of the screen, the nearest first.
#[derive(Clone, Copy)]
pub(super) struct ExtentsOfSolids<'f> {
    all: &'f [SolidExtent],
    /// N/2.
    half: f64,
    /// Pixels along a side of a tile.
    side: u32,
    /// The number of tiles side by side.
    tiles_per_row: u32,
    /// For each tile, the index of its first solid in `solids`; then the length of `solids`.
    starts: &'f [u32],
    /// The solids of each tile, the nearest first.
    solids: &'f [u16],
}

/// The extent of a solid, and how near it is.
struct SolidExtent {
    extent: Extent,
    entry: Entry,
}

/// Bounds on 109 t − 3 Y where eye rays enter a solid: t is a ray's parameter, Y the coordinate of
/// the pixel's row.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    pub(super) nearest: f64,
    pub(super) farthest: f64,
}

/// Tiles in a row, if there are more than [`MAX_UNTILED`] solids.
const TILES: u32 = 32;
/// So many solids share one tile.
const MAX_UNTILED: usize = 16;

impl<'f> ExtentsOfSolids<'f> {
    const NONE: ExtentsOfSolids<'static> = ExtentsOfSolids {
        all: &[],
        half: 0.0,
        side: 1,
        tiles_per_row: 1,
        starts: &[],
        solids: &[],
    };

    fn new(all: &'f [SolidExtent], size: u32, arena: &'f Bump) -> Self {
        let tiles = if all.len() > MAX_UNTILED { TILES } else { 1 };
        let side = size.div_ceil(tiles);
        let tiles_per_row = size.div_ceil(side);
        let reached = |SolidExtent { extent, .. }: &SolidExtent| {
            let tiles = |(from, to): (u32, u32)| {
                if from < to {
                    from / side..to.div_ceil(side)
                } else {
                    0..0
                }
            };
            let (columns, rows) = (tiles(extent.columns(size)), tiles(extent.rows(size)));
            rows.flat_map(move |row| {
                columns
                    .clone()
                    .map(move |column| (row * tiles_per_row + column) as usize)
            })
        };
        let starts = arena.alloc_slice_fill_copy((tiles_per_row * tiles_per_row) as usize + 1, 0);
        for tile in all.iter().flat_map(reached) {
            starts[tile] += 1;
        }
        let mut end = 0;
        for start in &mut *starts {
            end += *start;
            *start = end;
        }
        let solids = arena.alloc_slice_fill_copy(end as usize, 0);
        // Each tile is filled from its end: the farthest first.
        let order = arena.alloc_slice_fill_iter((0..all.len()).map(|solid| solid as u16));
        let nearest = |solid: u16| all[usize::from(solid)].entry.nearest;
        order.sort_unstable_by(|a, b| nearest(*b).total_cmp(&nearest(*a)));
        for &mut solid in order {
            for tile in reached(&all[usize::from(solid)]) {
                starts[tile] -= 1;
                solids[starts[tile] as usize] = solid;
            }
        }
        ExtentsOfSolids {
            all,
            half: f64::from(size) / 2.0,
            side,
            tiles_per_row,
            starts,
            solids,
        }
    }

    /// Y of a row.
    pub(super) fn y_of(&self, row: u32) -> f64 {
        coordinate(row, self.half)
    }

    /// The extent of a solid.
    pub(super) fn of(&self, solid: usize) -> &'f Extent {
        &self.all[solid].extent
    }

    /// Where eye rays enter a solid.
    pub(super) fn entry(&self, solid: usize) -> Entry {
        self.all[solid].entry
    }

    /// A lower bound on the parameter at which the eye ray of a pixel meets a solid. The bounds of
    /// the solids of [`ExtentsOfSolids::at`] are in increasing order.
    pub(super) fn min_depth(&self, solid: usize, y: f64) -> f64 {
        let depth = (self.all[solid].entry.nearest + EYE_Y * y) / EYE_SQUARED;
        // 3 Y is a whole number of halves; the sum and the quotient round by u each.
        depth - 2.0 * f64::EPSILON * depth.abs()
    }

    /// The solids that can be seen in a pixel, the nearest first.
    pub(super) fn at(&self, (column, row): (u32, u32)) -> impl Iterator<Item = usize> + use<'f> {
        let tile = (row / self.side * self.tiles_per_row + column / self.side) as usize;
        let range = self.starts[tile] as usize..self.starts[tile + 1] as usize;
        let (all, solids) = (self.all, &self.solids[range]);
        let solids = solids.iter().map(|solid| usize::from(*solid));
        solids.filter(move |solid| all[*solid].extent.holds(column, row))
    }
}

impl Extent {
    #[inline]
    pub(super) fn holds(&self, column: u32, row: u32) -> bool {
        self.columns.contains(&column.into()) && self.rows.contains(&row.into())
    }

    /// The half-open range of its rows in a picture of `size` rows.
    pub(super) fn rows(&self, size: u32) -> (u32, u32) {
        within(&self.rows, size)
    }

    /// The half-open range of its columns.
    pub(super) fn columns(&self, size: u32) -> (u32, u32) {
        within(&self.columns, size)
    }

    /// Whether both extents have a pixel in common.
    pub(super) fn meets(&self, other: &Extent) -> bool {
        let meet = |a: &RangeInclusive<i64>, b: &RangeInclusive<i64>| {
            a.start() <= b.end() && b.start() <= a.end()
        };
        meet(&self.columns, &other.columns) && meet(&self.rows, &other.rows)
    }

    /// The number of its pixels in a picture.
    pub(super) fn area(&self, size: u32) -> u64 {
        let length = |(from, to): (u32, u32)| u64::from(to.saturating_sub(from));
        length(self.columns(size)) * length(self.rows(size))
    }

    /// The smallest extent that holds the projections of all `points` onto the screen, each
    /// enlarged by `half_width` to the left and right and by `half_height` up and down, in view
    /// space, and by `rounding` to all sides.
    fn of(
        points: &[Vector<f64>],
        (half_width, half_height): (f64, f64),
        rounding: f64,
        size: u32,
    ) -> Extent {
        let half = f64::from(size) / 2.0;
        // The ray through a point p meets the screen, z = 3N/2, at y = p.y + (3N/2 − p.z) · 3/10.
        let columns = points.iter().map(|p| p.x);
        let rows = points
            .iter()
            .map(|p| p.y + (PIXEL * half - p.z) * (EYE_Y / EYE_Z));
        let range = |coordinates: &mut dyn Iterator<Item = f64>, half_length: f64| {
            let ends = coordinates.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (x.min(low), x.max(high))
            });
            let (low, high) = (
                number_at(ends.0 - half_length - rounding, half),
                number_at(ends.1 + half_length + rounding, half),
            );
            // A float beyond an i64 becomes the nearest one, which is far outside of any picture.
            low.floor() as i64..=high.ceil() as i64
        };
        Extent {
            columns: range(&mut columns.into_iter(), half_width),
            rows: range(&mut rows.into_iter(), half_height),
        }
    }
}

/// The half-open part of a range that lies in a picture.
fn within(range: &RangeInclusive<i64>, size: u32) -> (u32, u32) {
    let clamped = |number: i64| number.clamp(0, size.into()) as u32;
    (
        clamped(*range.start()),
        clamped(range.end().saturating_add(1)),
    )
}

impl<'f> Extents<'f> {
    pub(super) fn new(
        scene: &'f Scene,
        transform: &ViewTransform<f64>,
        bounded: &ViewTransform<Bounded>,
        size: u32,
        arena: &'f Bump,
    ) -> Self {
        // To turn, scale, reflect and project a point takes fewer than 32 roundings, each by at
        // most u = 2⁻⁵³ of these magnitudes: 2⁻⁴⁰ of them is more than all roundings, and far less
        // than a pixel.
        let least =
            PIXEL * f64::from(size) + 2.0 * transform.surface_height(scene).unwrap_or(0.0).abs();
        let rounding = |points: &[Vector<f64>], radius: f64| {
            let magnitudes = points.iter().map(|p| p.x.abs() + p.y.abs() + p.z.abs());
            let largest = magnitudes.fold(0.0, f64::max);
            (largest + 2.0 * radius + least) / (1_u64 << 40) as f64
        };
        let solids = |mirror_height: Option<f64>| {
            let point = |p| reflect(transform.point(p), mirror_height);
            let root = EYE_SQUARED.sqrt();
            let along = |p| along_eye_ray(p, f64::from(size) / 2.0);
            let spheres = scene.spheres().iter().map(|sphere| {
                let center = point(sphere.center);
                let radius = sphere.radius * transform.scale;
                let rounding = rounding(&[center], radius);
                // A sphere is as wide as its diameter; slanting rays √109/10 times as high.
                let half = (radius, radius * root / EYE_Z);
                SolidExtent {
                    extent: Extent::of(&[center], half, rounding, size),
                    entry: Entry {
                        nearest: along(center) - radius * root - 16.0 * rounding,
                        // Rays that touch the sphere enter it last.
                        farthest: along(center) + 16.0 * rounding,
                    },
                }
            });
            let tetrahedra = scene.tetrahedra().iter().map(|t| {
                let vertices = t.vertices.map(point);
                let rounding = rounding(&vertices, 0.0);
                let depths = vertices.map(along).into_iter();
                SolidExtent {
                    extent: Extent::of(&vertices, (0.0, 0.0), rounding, size),
                    entry: Entry {
                        nearest: depths.clone().fold(f64::INFINITY, f64::min) - 16.0 * rounding,
                        farthest: depths.fold(f64::NEG_INFINITY, f64::max) + 16.0 * rounding,
                    },
                }
            });
            let all = collect(arena, spheres.chain(tetrahedra));
            ExtentsOfSolids::new(all, size, arena)
        };
        let surface = scene.surface().map(|surface| {
            let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(x, z)| {
                transform.point(glam::DVec3::new(
                    x * surface.half_width,
                    surface.height,
                    z * surface.half_width,
                ))
            });
            Extent::of(&corners, (0.0, 0.0), rounding(&corners, 0.0), size)
        });
        let mirror_height = transform.surface_height(scene);
        let mirrored = if mirror_height.is_some() {
            solids(mirror_height)
        } else {
            ExtentsOfSolids::NONE
        };
        Extents {
            direct: solids(None),
            mirrored,
            surface,
            casters_on_surface: SurfaceCasterLookup::new(scene, bounded),
        }
    }
}
