//! The solids as a frame's rows cross them: seen directly, or in the mirror.

use std::cell::LazyCell;
use std::cmp::Ordering;

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;

use crate::number::{Bounded, Real};
use crate::scene::Side;
use crate::stage::Stage;
use crate::tracer::arena::collect;
use crate::tracer::decision::{Decision, Seen};
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipse::{Ellipse, Lines};
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::pixel_plane::PixelPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{Edge, Receiver};
use crate::tracer::scanline::grid::Grid;
use crate::tracer::scanline::prepare::depth::{Depth, face_plane, screen_plane};
use crate::tracer::scanline::prepare::prepared::Builder;
use crate::tracer::scanline::shade::caster::{Caster, ShadowCylinder};
use crate::tracer::scanline::shade::light::Lighting;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::{LinearForm, RowSphere};
use crate::tracer::scanline::visibility::separation::Separation;
use crate::tracer::scanline::write::paint::PaintNumber;
use crate::tracer::tetrahedron::HalfSpace;
use crate::tracer::view::View;

/// All solids that take part in a stage.
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
    pub(crate) fn new(
        picture: &Picture<'_, Bounded>,
        view: &View<'_, Bounded>,
        mirrored: bool,
        parts: &mut Builder<'f, '_>,
    ) -> Self {
        let (grid, arena) = (parts.grid, parts.arena);
        let (scene, stage) = (picture.scene, picture.stage);
        let count = view.spheres.len();
        // Whether points can be in shadow.
        let shadows = stage >= Stage::Shadow;
        let numbers = match stage {
            Stage::Spheres => 0..count,
            Stage::Tetrahedron => count..count + view.tetrahedra.len(),
            _ => 0..count + view.tetrahedra.len(),
        };
        let separation = Separation::new(view, numbers.clone(), arena);
        let decision = |solid: usize, face: Option<usize>, in_shadow: bool| {
            let seen = Seen {
                solid: solid as u16,
                face: face.map(|face| face as u8),
                in_shadow,
            };
            if mirrored {
                Decision::Mirrored(seen)
            } else {
                Decision::Solid(seen)
            }
        };
        let mut solids = Growing::with_capacity_in(numbers.len(), arena);
        let edge = |place: usize, side: Side| match side {
            _ if !mirrored => Some(Edge::Direct(place)),
            // Below the surface nothing is mirrored.
            Side::Below => None,
            _ => Some(Edge::Mirrored(place)),
        };
        let facts = scene.facts();
        let rising = -scene.light().direction.y;
        // The surface, where it may stand between a point of a solid and the light.
        let shading_surface = |solid: usize| {
            let shades = match facts.sides[solid] {
                Side::Above => rising <= 0.0,
                Side::Below => rising >= 0.0,
                Side::Across => true,
            };
            let floor = picture.floor.as_ref().filter(|_| shades);
            floor.map(|floor| &floor.surface)
        };
        // In the mirror light comes from below where it comes from above.
        let climb = if mirrored { -rising } else { rising };
        let climb = climb.partial_cmp(&0.0).unwrap_or(Ordering::Equal);
        let to_light = view.shading.to_light.vector;
        let reflectance = match &picture.floor {
            Some(floor) if mirrored => floor.mirror.as_ref().map(|mirror| mirror.reflectance),
            _ => None,
        };
        // In the mirror only what the surface shows matters.
        let rows = match &picture.floor {
            Some(floor) if mirrored => floor.extent.rows(grid.size),
            _ => (0, grid.size),
        };
        let lighting = LazyCell::new(|| Lighting::new(&view.shading));
        if stage != Stage::Tetrahedron {
            for (index, sphere) in view.spheres.iter().enumerate() {
                let ellipse = Ellipse::outline(sphere.center, sphere.radius, grid);
                let mut paint = |in_shadow| parts.paints.of(decision(index, None, in_shadow));
                let body = if stage == Stage::Spheres {
                    Body::Flat(paint(false))
                } else {
                    let own = picture.solid_color(index);
                    let own = reflectance.map_or(own, |reflectance| own * reflectance);
                    let row_sphere = RowSphere::new(sphere, &ellipse, &lighting, own, shadows);
                    let casters = if shadows {
                        let solids = &facts.casters[index];
                        let solids = casters_on(&row_sphere, index, view, &lighting, solids, arena);
                        let surface = shading_surface(index).map(|surface| {
                            let shadow = surface.shadow(to_light, climb);
                            let forms =
                                shadow.map(|half_space| row_sphere.inside(&half_space, &lighting));
                            let unknown = climb.is_eq().then_some(LinearForm::UNKNOWN);
                            Caster::Polyhedron(collect(arena, forms.chain(unknown)))
                        });
                        collect(arena, solids.chain(surface))
                    } else {
                        &[]
                    };
                    parts.shaded_spheres += 1;
                    Body::Sphere(arena.alloc(ShadedSphere {
                        number: parts.shaded_spheres - 1,
                        sphere: row_sphere,
                        casters,
                        lit: decision(index, None, false),
                        in_shadow: paint(shadows),
                    }))
                };
                let depth = Depth::of_sphere(sphere.center, &ellipse, sphere.support, grid);
                let side = facts.sides[index];
                if let Some(edge) = edge(solids.len(), side) {
                    let outline = Region::new(&[], Some(ellipse), grid).within(rows);
                    parts.edges.add(outline, edge);
                }
                solids.push(Solid { side, depth, body });
            }
        }
        if stage != Stage::Spheres {
            for (index, t) in (count..).zip(view.tetrahedra) {
                let plane = screen_plane(grid);
                let plane = |half_space| HalfPlane::of(&half_space, &plane, grid);
                let (first, end) = view.extents[index].rows(grid.size);
                let rows = (first.max(rows.0), end.min(rows.1));
                let planes = collect(arena, t.solid.met(&t.from_eye).map(plane));
                let outline = Region::new(planes, None, grid);
                let mut facets = Growing::new_in(arena);
                let mut depths = Growing::new_in(arena);
                for face in t.from_eye.entered() {
                    let (plane, depth) = face_plane(t.solid.plane(face), grid);
                    depths.push(depth);
                    let turned_away = shadows && t.solid.turned_away(face);
                    let casters: &[u16] = if shadows && !turned_away {
                        &facts.casters[index]
                    } else {
                        &[]
                    };
                    let casters = casters.iter().copied();
                    let thrown = shadows_on(&plane, view, casters, |_| false, grid, arena);
                    let surface = shading_surface(index).filter(|_| !turned_away);
                    let surface = surface.map(|surface| {
                        let shadow = surface.shadow(to_light, climb);
                        let planes =
                            shadow.map(|half_space| HalfPlane::of(&half_space, &plane, grid));
                        let unknown = climb.is_eq().then_some(HalfPlane::UNKNOWN);
                        Region::new(collect(arena, planes.chain(unknown)), None, grid)
                    });
                    let thrown = thrown.chain(surface);
                    let mut paint =
                        |in_shadow| parts.paints.of(decision(index, Some(face), in_shadow));
                    facets.push(Facet {
                        lit: paint(false),
                        in_shadow: paint(shadows),
                        turned_away,
                        shadows: parts.edges.add_receiver(thrown, rows),
                    });
                }
                let place = |face: usize| t.from_eye.entered().position(|other| other == face);
                let pairs = t.solid.entered_pairs(&t.from_eye);
                let pairs = pairs.filter_map(|(i, j, first)| {
                    let first = Region::new(arena.alloc([plane(first)]), None, grid);
                    Some(Pair {
                        facets: (place(i)?, place(j)?),
                        first: parts.edges.add(first.within(rows), Edge::Crease),
                    })
                });
                let pairs = collect(arena, pairs);
                let body = Body::Facets(facets.into_bump_slice(), pairs);
                let side = facts.sides[index];
                if let Some(edge) = edge(solids.len(), side) {
                    parts.edges.add(outline.within(rows), edge);
                }
                solids.push(Solid {
                    side,
                    depth: Depth::Facets(depths.into_bump_slice()),
                    body,
                });
            }
        }
        Solids {
            mirrored,
            solids: solids.into_bump_slice(),
            separation,
        }
    }
}

/// The pixels whose points on a plane are in the shadows of `casters`. Of a caster that `is_ahead`
/// of all the plane's pixels it is not asked whether it is.
pub(crate) fn shadows_on<'f>(
    plane: &PixelPlane,
    view: &View<'_, Bounded>,
    casters: impl Iterator<Item = u16>,
    is_ahead: impl Fn(usize) -> bool,
    grid: Grid,
    arena: &'f Bump,
) -> impl Iterator<Item = Region<'f>> {
    let to_light = view.shading.to_light;
    let lines = LazyCell::new(move || Lines::new(plane, to_light));
    let shape = move |caster: u16| {
        let caster = usize::from(caster);
        let is_ahead = is_ahead(caster);
        match view.spheres.get(caster) {
            Some(sphere) => {
                let before = (!is_ahead).then(|| HalfSpace {
                    normal: -to_light.vector,
                    at: sphere.center,
                    closed: false,
                    border: None,
                });
                let before = before
                    .iter()
                    .map(|half_space| HalfPlane::of(half_space, plane, grid));
                let ellipse = lines.meet((sphere.center, sphere.radius), grid);
                Region::new(collect(arena, before), Some(ellipse), grid)
            }
            None => {
                let t = &view.tetrahedra[caster - view.spheres.len()];
                let plane = |half_space| HalfPlane::of(&half_space, plane, grid);
                let planes = if is_ahead {
                    collect(arena, t.solid.met(&t.from_light).map(plane))
                } else {
                    collect(arena, t.solid.ahead(&t.from_light).map(plane))
                };
                Region::new(planes, None, grid)
            }
        }
    };
    casters.map(shape)
}

/// What may shade the pixels of a sphere.
fn casters_on<'f>(
    row_sphere: &RowSphere,
    index: usize,
    view: &View<'_, Bounded>,
    lighting: &Lighting,
    casters: &[u16],
    arena: &'f Bump,
) -> impl Iterator<Item = Caster<'f>> {
    let to_light = view.shading.to_light;
    let own = view.spheres[index].support;
    let beside = LazyCell::new(|| row_sphere.beside(lighting));
    casters.iter().filter_map(move |&caster| {
        let caster = usize::from(caster);
        match view.spheres.get(caster) {
            // A ray leaves its own sphere, also where that is listed twice.
            Some(sphere) if sphere.support == own => None,
            Some(sphere) => {
                let (moment, before) = row_sphere.around(sphere.center, &to_light, &beside);
                let reach = to_light.squared_length * sphere.radius.squared();
                Some(Caster::Sphere(
                    arena.alloc(ShadowCylinder::new(before, moment, reach)),
                ))
            }
            None => {
                let t = &view.tetrahedra[caster - view.spheres.len()];
                let ahead = t.solid.ahead(&t.from_light);
                let forms = ahead.map(|half_space| row_sphere.inside(&half_space, lighting));
                Some(Caster::Polyhedron(collect(arena, forms)))
            }
        }
    })
}
