//! The solids as a frame's rows cross them: seen directly, or in the mirror.

use bumpalo::collections::Vec as Growing;

use crate::number::Bounded;
use crate::scene::Side;
use crate::tracer::arena::collect;
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::table::{Edge, Receiver};
use crate::tracer::scanline::prepare::bodies::Bodies;
use crate::tracer::scanline::prepare::depth::Depth;
use crate::tracer::scanline::prepare::outline::Outlines;
use crate::tracer::scanline::prepare::prepared::Builder;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::visibility::separation::Separation;
use crate::tracer::scanline::write::paint::PaintNumber;
use crate::tracer::view::View;

/// The solids of a view that are seen.
pub(crate) struct Solids<'f> {
    pub(crate) mirrored: bool,
    pub(crate) solids: &'f [Solid<'f>],
    /// Which is in front of which.
    pub(crate) separation: Separation<'f>,
}

/// One of them.
pub(crate) struct Solid<'f> {
    pub(crate) side: Side,
    pub(crate) depth: Depth<'f>,
    pub(crate) body: Body<'f>,
}

/// How its pixels are coloured.
pub(crate) enum Body<'f> {
    /// All alike.
    Flat(PaintNumber),
    Sphere(&'f ShadedSphere<'f>),
    Facets(&'f [Facet], &'f [Pair]),
}

/// A face that eye rays enter.
pub(crate) struct Facet {
    pub(crate) lit: PaintNumber,
    pub(crate) in_shadow: PaintNumber,
    /// Whether it is in shadow where nothing else throws one.
    pub(crate) turned_away: bool,
    pub(crate) shadows: Receiver,
}

/// Two facets, the first of the lower number, and the edge of where eye rays enter that last.
pub(crate) struct Pair {
    pub(crate) facets: (usize, usize),
    pub(crate) first: usize,
}

impl<'f> Solids<'f> {
    /// Those with these outlines, and the edges that they bring.
    pub(crate) fn new(
        picture: &Picture<'_, Bounded>,
        view: &View<'_, Bounded>,
        outlines: Outlines<'f>,
        parts: &mut Builder<'f, '_>,
    ) -> Self {
        let (arena, mirrored) = (parts.arena, outlines.mirrored);
        let numbers = collect(arena, outlines.all.iter().map(|solid| solid.number));
        let bodies = Bodies::new(picture, view, mirrored);
        let mut solids = Growing::with_capacity_in(numbers.len(), arena);
        for (place, solid) in outlines.all.into_iter().enumerate() {
            let body = bodies.of(&solid, parts);
            let edge = if mirrored {
                Edge::Mirrored(place)
            } else {
                Edge::Direct(place)
            };
            parts.edges.add(solid.outline, edge);
            solids.push(Solid {
                side: solid.side,
                depth: solid.depth,
                body,
            });
        }
        Solids {
            mirrored,
            solids: solids.into_bump_slice(),
            separation: Separation::new(view, numbers, arena),
        }
    }
}
