//! Where a solid can be seen at all: most pixels ask about most solids in vain.

use std::ops::RangeInclusive;

use bumpalo::Bump;

use super::arena::collect;
use super::frame::{Frame, reflect};
use super::vector::Vector;
use crate::number::{Bounded, Real};
use crate::scene::Scene;

/// The pixels whose eye ray can meet a solid; all others certainly miss it.
#[derive(Clone, Debug)]
pub(super) struct Extent {
    columns: RangeInclusive<i64>,
    rows: RangeInclusive<i64>,
}

/// The extents of a frame: of every solid, of every solid in the mirror, and of the surface.
pub(super) struct Extents<'f> {
    pub(super) direct: &'f [Extent],
    pub(super) mirrored: &'f [Extent],
    pub(super) surface: Option<Extent>,
}

impl Extent {
    #[inline]
    pub(super) fn holds(&self, column: u32, row: u32) -> bool {
        self.columns.contains(&column.into()) && self.rows.contains(&row.into())
    }

    /// Its rows of a picture of `size` rows, from the first to before the last.
    pub(super) fn rows(&self, size: u32) -> (u32, u32) {
        within(&self.rows, size)
    }

    /// Its columns.
    pub(super) fn columns(&self, size: u32) -> (u32, u32) {
        within(&self.columns, size)
    }

    /// Whether any pixel is in both.
    pub(super) fn meets(&self, other: &Extent) -> bool {
        let meet = |a: &RangeInclusive<i64>, b: &RangeInclusive<i64>| {
            a.start() <= b.end() && b.start() <= a.end()
        };
        meet(&self.columns, &other.columns) && meet(&self.rows, &other.rows)
    }

    /// How many pixels of a picture are in it.
    pub(super) fn area(&self, size: u32) -> u64 {
        let length = |(from, to): (u32, u32)| u64::from(to.saturating_sub(from));
        length(self.columns(size)) * length(self.rows(size))
    }

    /// The smallest that holds the shadows that all `points` cast on the screen along the eye's
    /// rays, each point thickened by `across` to the left and right and by `along` up and down
    /// the screen, in view space.
    fn of(points: &[Vector<Bounded>], across: Bounded, along: Bounded, size: u32) -> Extent {
        let half = f64::from(size) / 2.0;
        let third = Bounded::exact(1.0) / Bounded::exact(3.0);
        // The ray through a point p meets the screen, z = 3N/2, at y = p.y + (3N/2 − p.z) · 3/10.
        let screen = Bounded::exact(3.0 * half);
        let slope = Bounded::exact(3.0) / Bounded::exact(10.0);
        let columns = points.iter().map(|p| (p.x, across));
        let rows = points.iter().map(|p| (p.y + (screen - p.z) * slope, along));
        let range = |places: &mut dyn Iterator<Item = (Bounded, Bounded)>| {
            let ends = places.map(|(place, reach)| {
                let pixels = |x: Bounded| x * third + Bounded::exact(half);
                (
                    pixels(place - reach).at_least(),
                    pixels(place + reach).at_most(),
                )
            });
            let (low, high) = ends
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (l, h)| {
                    (low.min(l), high.max(h))
                });
            // A float beyond an i64 becomes the nearest one, which is far outside of any picture.
            low.floor() as i64..=high.ceil() as i64
        };
        Extent {
            columns: range(&mut columns.into_iter()),
            rows: range(&mut rows.into_iter()),
        }
    }
}

/// What of a range lies in a picture.
fn within(range: &RangeInclusive<i64>, size: u32) -> (u32, u32) {
    let limit = |number: i64| number.clamp(0, size.into()) as u32;
    (limit(*range.start()), limit(range.end().saturating_add(1)))
}

impl<'f> Extents<'f> {
    pub(super) fn new(scene: &Scene, frame: &Frame<Bounded>, size: u32, arena: &'f Bump) -> Self {
        let solids = |mirror: Option<Bounded>| {
            let place = |point| reflect(frame.place(point), mirror);
            // A sphere is as wide as its diameter; slanting rays √109/10 times as high.
            let stretch = Bounded::exact(109.0).sqrt() / Bounded::exact(10.0);
            let spheres = scene.spheres().iter().map(|sphere| {
                let radius = Bounded::exact(sphere.radius) * frame.scale;
                Extent::of(&[place(sphere.center)], radius, radius * stretch, size)
            });
            let none = Bounded::exact(0.0);
            let tetrahedra = scene
                .tetrahedra()
                .iter()
                .map(|t| Extent::of(&t.vertices.map(place), none, none, size));
            collect(arena, spheres.chain(tetrahedra))
        };
        let surface = scene.surface().map(|surface| {
            let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(x, z)| {
                frame.place(glam::DVec3::new(
                    x * surface.half_width,
                    surface.height,
                    z * surface.half_width,
                ))
            });
            Extent::of(&corners, Bounded::exact(0.0), Bounded::exact(0.0), size)
        });
        let mirror = frame.mirror(scene);
        let mirrored = if mirror.is_some() {
            solids(mirror)
        } else {
            &[]
        };
        Extents {
            direct: solids(None),
            mirrored,
            surface,
        }
    }
}
