//! The order of solids that a plane separates: which is in front wherever a ray meets both.
//!
//! All eye rays have one direction, so they cross a plane that separates two solids from the same
//! side. Every ray that meets both meets the solid on that side first. This needs no depth test,
//! and holds for a whole frame. A plane across the eye rays separates most solids of a crowd;
//! planes between others are looked for if there are few solids.

use bumpalo::Bump;

use crate::number::{Bounded, Real};
use crate::scene::Solid;
use crate::tracer::arena::collect;
use crate::tracer::extent::Entry;
use crate::tracer::scanline::edges::table::SolidIndex;
use crate::tracer::scanline::fetch::fetch;
use crate::tracer::vector::Vector;
use crate::tracer::view::View;
use crate::tracer::view_space::eye_direction;

/// The largest number of solids for which all pairs are tested in every frame.
const MOST: usize = 16;

/// The order of the solids of a view.
pub(crate) struct Separation<'f> {
    /// Where eye rays enter each solid.
    entries: &'f [Entry],
    /// The number of its solids; 0 if there are more than [`MOST`].
    count: usize,
    /// For each pair, whether the first is in front of the second, if a plane separates them.
    in_front: &'f [Option<bool>],
}

impl<'f> Separation<'f> {
    /// The order of the solids of `view` with these numbers in the scene.
    pub(crate) fn new(view: &View<'_, Bounded>, solids: &[usize], arena: &'f Bump) -> Self {
        let count = if solids.len() <= MOST {
            solids.len()
        } else {
            0
        };
        let in_front = arena.alloc_slice_fill_copy(count * count, None);
        for i in 0..count {
            for j in 0..i {
                let order = is_in_front(view, solids[i], solids[j]);
                in_front[i * count + j] = order;
                in_front[j * count + i] = order.map(|first| !first);
            }
        }
        Separation {
            entries: collect(arena, solids.iter().map(|solid| view.extents.entry(*solid))),
            count,
            in_front,
        }
    }

    /// Asks for the memory of a solid's entry.
    pub(crate) fn fetch(&self, solid: usize) {
        fetch(&self.entries[solid].nearest);
    }

    /// The solid of `met` that is certainly in front of all others, if there is one.
    pub(crate) fn first(&self, met: &[SolidIndex]) -> Option<SolidIndex> {
        if let [only] = met {
            return Some(*only);
        }
        let is_before = |SolidIndex(a): SolidIndex, SolidIndex(b): SolidIndex| {
            let (a, b) = (a as usize, b as usize);
            a == b
                || self.entries[a].farthest < self.entries[b].nearest
                || self.in_front.get(a * self.count + b) == Some(&Some(true))
        };
        let is_first = |&a: &SolidIndex| met.iter().all(|&b| is_before(a, b));
        met.iter().copied().find(is_first)
    }
}

/// Whether solid `i` is in front of solid `j`; `None` where no plane is found that separates them.
fn is_in_front(view: &View<'_, Bounded>, i: usize, j: usize) -> Option<bool> {
    let toward_j = match (view.solid(i), view.solid(j)) {
        (Solid::Sphere(a), Solid::Sphere(b)) => {
            let between = b.center - a.center;
            let gap = between.squared_length() - (a.radius + b.radius).squared();
            is_positive(gap).then_some(between)
        }
        _ => apart_by_face(view, i, j)
            .or_else(|| apart_by_face(view, j, i).map(|direction| -direction)),
    }?;
    let d_toward_j = eye_direction::<Bounded>().vector.dot(toward_j);
    // No ray parallel to the plane meets both.
    d_toward_j.sign().ok().map(|sign| sign.is_gt())
}

/// The outward normal of a face of tetrahedron `i` whose plane separates it from solid `j`.
fn apart_by_face(view: &View<'_, Bounded>, i: usize, j: usize) -> Option<Vector<Bounded>> {
    let Solid::Tetrahedron(t) = view.solid(i) else {
        return None;
    };
    (0..4).find_map(|face| {
        let plane = t.solid.inner_half_space(face);
        let outward = -plane.normal;
        let height = |point: Vector<Bounded>| outward.dot(point - plane.at);
        let is_beyond = match view.solid(j) {
            Solid::Sphere(sphere) => {
                let height = height(sphere.center);
                let squared_radius = sphere.radius.squared() * outward.squared_length();
                is_positive(height) && is_positive(height.squared() - squared_radius)
            }
            Solid::Tetrahedron(other) => {
                let mut heights = other.solid.vertices().map(height).into_iter();
                heights.all(is_positive)
            }
        };
        is_beyond.then_some(outward)
    })
}

fn is_positive(x: Bounded) -> bool {
    x.sign().is_ok_and(|sign| sign.is_gt())
}
