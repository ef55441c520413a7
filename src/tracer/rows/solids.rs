//! The solids as a frame's rows cross them: seen directly, or in the mirror.

use std::cell::LazyCell;
use std::ops::Range;

use bumpalo::Bump;
use bumpalo::collections::Vec as Growing;

use super::ball::Ball;
use super::border::Border;
use super::caster::{Caster, Passing};
use super::ellipse::{Ellipse, Lines, Off};
use super::half_plane::HalfPlane;
use super::lighting::Lighting;
use super::order::Order;
use super::paint::PaintNumber;
use super::parts::Parts;
use super::place::Screen;
use super::rounding::{MORE, U};
use super::shaded::ShadedBall;
use super::shape::Shape;
use super::sheet::Sheet;
use crate::number::{Bounded, Real};
use crate::scene::{Side, Support};
use crate::stage::Stage;
use crate::tracer::arena::collect;
use crate::tracer::decision::{Decision, Seen};
use crate::tracer::frame::looking;
use crate::tracer::pixel::Picture;
use crate::tracer::tetrahedron::HalfSpace;
use crate::tracer::vector::Vector;
use crate::tracer::view::View;

/// All solids that take part in a stage.
pub(super) struct Solids<'f> {
    pub(super) mirrored: bool,
    pub(super) solids: &'f [Solid<'f>],
    /// Which is in front of which.
    pub(super) order: Order<'f>,
}

/// One of them.
pub(super) struct Solid<'f> {
    pub(super) side: Side,
    depth: Depth<'f>,
    pub(super) body: Body<'f>,
}

/// How its pixels are coloured.
pub(super) enum Body<'f> {
    /// All alike.
    Flat(PaintNumber),
    Ball(&'f ShadedBall<'f>),
    Facets(&'f [Facet], &'f [Pair]),
    /// Each is to be asked for.
    Unknown,
}

/// A face that eye rays enter.
pub(super) struct Facet {
    pub(super) lit: PaintNumber,
    pub(super) in_shadow: PaintNumber,
    /// Whether it is in shadow where nothing else throws one.
    pub(super) turned_away: bool,
    /// The borders of the shadows on it.
    pub(super) shadows: Range<usize>,
}

/// Two facets, the first of the lower number, and the border of where eye rays enter that last.
pub(super) struct Pair {
    pub(super) facets: (usize, usize),
    pub(super) first: usize,
}

/// The parameter at which eye rays enter.
enum Depth<'f> {
    /// g/109 − s/√109, where g goes linearly with Y, and s² = R² − m² − q² as in `ball.rs`.
    Ball {
        off: Off,
        squared_radius: f64,
        center: f64,
        g: [f64; 2],
        error: f64,
        squared_error: f64,
        support: Support,
    },
    /// The largest of some linear functions of X and Y, each with a bound on its error.
    Facets(&'f [([f64; 3], f64)]),
}

impl<'f> Solids<'f> {
    pub(super) fn new(
        picture: &Picture<'_, Bounded>,
        view: &View<'_, Bounded>,
        mirrored: bool,
        parts: &mut Parts<'f, '_>,
    ) -> Self {
        let (screen, arena) = (parts.screen, parts.arena);
        let (scene, stage) = (picture.scene, picture.stage);
        let count = view.spheres.len();
        // Whether points can be in shadow.
        let shadows = stage >= Stage::Shadow;
        let numbers = match stage {
            Stage::Spheres => 0..count,
            Stage::Tetrahedron => count..count + view.tetrahedra.len(),
            _ => 0..count + view.tetrahedra.len(),
        };
        let order = Order::new(view, numbers.clone(), arena);
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
        let border = |place: usize, side: Side| match side {
            _ if !mirrored => Some(Border::Direct(place)),
            // Below the surface nothing is mirrored.
            Side::Below => None,
            _ => Some(Border::Mirrored(place)),
        };
        let facts = scene.facts();
        let rising = -scene.light().direction.y;
        // Whether the surface may stand between a point of a solid and the light.
        let surface_shades = |solid: usize| {
            picture.floor.is_some()
                && !match facts.sides[solid] {
                    Side::Above => rising > 0.0,
                    Side::Below => rising < 0.0,
                    Side::Across => false,
                }
        };
        let reflectance = match &picture.floor {
            Some(floor) if mirrored => floor.mirror.as_ref().map(|mirror| mirror.reflectance),
            _ => None,
        };
        // In the mirror only what the surface shows matters.
        let rows = match &picture.floor {
            Some(floor) if mirrored => floor.extent.rows(screen.size),
            _ => (0, screen.size),
        };
        let lighting = LazyCell::new(|| Lighting::new(&view.shading));
        if stage != Stage::Tetrahedron {
            for (index, sphere) in view.spheres.iter().enumerate() {
                let ellipse = Ellipse::outline(sphere.center, sphere.radius, screen);
                let mut paint = |in_shadow| parts.paints.of(decision(index, None, in_shadow));
                let body = if stage == Stage::Spheres {
                    Body::Flat(paint(false))
                } else if surface_shades(index) {
                    Body::Unknown
                } else {
                    let own = picture.solid_color(index);
                    let own = reflectance.map_or(own, |reflectance| own * reflectance);
                    let ball = Ball::new(sphere, &ellipse, &lighting, own, shadows);
                    let casters = if shadows {
                        let casters = &facts.casters[index];
                        casters_on(&ball, index, view, &lighting, casters, arena)
                    } else {
                        &[]
                    };
                    parts.balls += 1;
                    Body::Ball(arena.alloc(ShadedBall {
                        number: parts.balls - 1,
                        ball,
                        casters,
                        lit: decision(index, None, false),
                        in_shadow: paint(shadows),
                    }))
                };
                let depth = depth_of_ball(sphere.center, &ellipse, sphere.support, screen);
                let side = facts.sides[index];
                if let Some(border) = border(solids.len(), side) {
                    let outline = Shape::new(&[], Some(ellipse), screen).within(rows);
                    parts.borders.add(outline, border);
                }
                solids.push(Solid { side, depth, body });
            }
        }
        if stage != Stage::Spheres {
            for (index, t) in (count..).zip(view.tetrahedra) {
                let sheet = eye_sheet(screen);
                let plane = |half_space| HalfPlane::of(&half_space, &sheet, screen);
                let (first, end) = view.extents[index].rows(screen.size);
                let rows = (first.max(rows.0), end.min(rows.1));
                let planes = collect(arena, t.solid.met(&t.from_eye).map(plane));
                let outline = Shape::new(planes, None, screen);
                let mut facets = Growing::new_in(arena);
                let mut depths = Growing::new_in(arena);
                for face in t.from_eye.entered() {
                    let (sheet, depth) = face_sheet(t.solid.plane(face), screen);
                    depths.push(depth);
                    let turned_away = shadows && t.solid.turned_away(face);
                    let casters: &[u16] = if shadows && !turned_away {
                        &facts.casters[index]
                    } else {
                        &[]
                    };
                    let casters = casters.iter().copied();
                    let thrown = shadows_on(&sheet, view, casters, |_| false, screen, arena);
                    let mut paint =
                        |in_shadow| parts.paints.of(decision(index, Some(face), in_shadow));
                    facets.push(Facet {
                        lit: paint(false),
                        in_shadow: paint(shadows),
                        turned_away,
                        shadows: parts.borders.add_details(thrown, rows),
                    });
                }
                let place = |face: usize| t.from_eye.entered().position(|other| other == face);
                let pairs = t.solid.entered_pairs(&t.from_eye);
                let pairs = pairs.filter_map(|(i, j, first)| {
                    let first = Shape::new(arena.alloc([plane(first)]), None, screen);
                    Some(Pair {
                        facets: (place(i)?, place(j)?),
                        first: parts.borders.add_details([first], rows).start,
                    })
                });
                let pairs = collect(arena, pairs);
                let body = if surface_shades(index) {
                    Body::Unknown
                } else {
                    Body::Facets(facets.into_bump_slice(), pairs)
                };
                let side = facts.sides[index];
                if let Some(border) = border(solids.len(), side) {
                    parts.borders.add(outline.within(rows), border);
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
            order,
        }
    }
}

impl Solid<'_> {
    /// Bounds on the parameter at which the eye rays at Y, from one X to another, enter it.
    pub(super) fn depth(&self, y: f64, ends: [f64; 2]) -> (f64, f64) {
        match &self.depth {
            Depth::Ball {
                off,
                squared_radius,
                center,
                g,
                error,
                squared_error,
                ..
            } => {
                let m = off.at(y);
                let squared = |q: f64| (squared_radius - m * m) - q * q;
                let q = ends.map(|x| x - center);
                let farthest = q[0].abs().max(q[1].abs());
                let nearest = if q[0] * q[1] <= 0.0 {
                    0.0
                } else {
                    q[0].abs().min(q[1].abs())
                };
                let least = (squared(farthest) - squared_error).max(0.0).sqrt();
                let most = (squared(nearest) + squared_error).max(0.0).sqrt() * MORE;
                // 1/√109, from below and from above.
                const ROOT: f64 = 0.095_782_628_522_115_14;
                let g = (g[0] + g[1] * y) / 109.0;
                (
                    g - most * ROOT * MORE - error,
                    g - least * ROOT / MORE / MORE + error,
                )
            }
            Depth::Facets(functions) => functions.iter().fold(
                (f64::NEG_INFINITY, f64::NEG_INFINITY),
                |(low, high), ([constant, column, row], error)| {
                    let ends = ends.map(|x| constant + column * x + row * y);
                    (
                        low.max(ends[0].min(ends[1]) - error),
                        high.max(ends[0].max(ends[1]) + error),
                    )
                },
            ),
        }
    }

    /// Whether both are the same sphere.
    pub(super) fn is_same_sphere(&self, other: &Solid<'_>) -> bool {
        match (&self.depth, &other.depth) {
            (Depth::Ball { support: a, .. }, Depth::Ball { support: b, .. }) => a == b,
            _ => false,
        }
    }
}

fn depth_of_ball(
    center: Vector<Bounded>,
    outline: &Ellipse,
    support: Support,
    screen: Screen,
) -> Depth<'static> {
    let [three, ten] = [3.0, 10.0].map(Bounded::exact);
    // (c − o) · d with o = (X, Y, Z), d = −(0, 3, 10): 3 (Y − c_y) + 10 (Z − c_z).
    let constant = ten * (Bounded::exact(screen.reach) - center.z) - three * center.y;
    let magnitude = constant.value().abs() + 3.0 * screen.reach;
    let q = center.x.error() + 2.0 * U * (center.x.value().abs() + screen.reach);
    let radius = outline.squared_radius.max(0.0).sqrt() * MORE;
    let reach = radius + q;
    Depth::Ball {
        off: outline.off,
        squared_radius: outline.squared_radius,
        center: center.x.value(),
        g: [constant.value(), 3.0],
        error: (constant.error() + 8.0 * U * (magnitude + radius)) * MORE,
        squared_error: (outline.chord_error + (2.0 * reach + q) * q + 8.0 * U * reach * reach)
            * MORE,
        support,
    }
}

/// The places of the pixels on the screen, where eye rays begin.
fn eye_sheet(screen: Screen) -> Sheet {
    let vector = |x, y, z| Vector::new(Bounded::exact(x), Bounded::exact(y), Bounded::exact(z));
    Sheet {
        origin: vector(0.0, 0.0, screen.reach),
        per_column: vector(1.0, 0.0, 0.0),
        per_row: vector(0.0, 1.0, 0.0),
        plane: None,
    }
}

/// Where eye rays meet the plane of a face, and at which parameter.
fn face_sheet(face: HalfSpace<Bounded>, screen: Screen) -> (Sheet, ([f64; 3], f64)) {
    let eye = eye_sheet(screen);
    let d = looking::<Bounded>().vector;
    // t = −n·(o − a)/(n·d), linear in o.
    let speed = face.normal.dot(d);
    let depth = |v: Vector<Bounded>| -(face.normal.dot(v) / speed);
    let depths = [
        depth(eye.origin - face.at),
        depth(eye.per_column),
        depth(eye.per_row),
    ];
    let magnitudes: f64 = depths
        .iter()
        .zip([1.0, screen.reach, screen.reach])
        .map(|(depth, reach)| depth.value().abs() * reach)
        .sum();
    let errors: f64 = depths
        .iter()
        .zip([1.0, screen.reach, screen.reach])
        .map(|(depth, reach)| depth.error() * reach)
        .sum();
    let sheet = Sheet {
        origin: eye.origin + d * depths[0],
        per_column: eye.per_column + d * depths[1],
        per_row: eye.per_row + d * depths[2],
        plane: face.border,
    };
    let error = (errors + 8.0 * U * magnitudes) * MORE;
    (sheet, (depths.map(Bounded::value), error))
}

/// The pixels whose points on a sheet are in the shadows of `casters`. Of a caster that `is_ahead` of all the sheet's pixels it is
/// not asked whether it is.
pub(super) fn shadows_on<'f>(
    sheet: &Sheet,
    view: &View<'_, Bounded>,
    casters: impl Iterator<Item = u16>,
    is_ahead: impl Fn(usize) -> bool,
    screen: Screen,
    arena: &'f Bump,
) -> impl Iterator<Item = Shape<'f>> {
    let to_light = view.shading.to_light;
    let lines = LazyCell::new(move || Lines::new(sheet, to_light));
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
                    .map(|half_space| HalfPlane::of(half_space, sheet, screen));
                let ellipse = lines.meet((sphere.center, sphere.radius), screen);
                Shape::new(collect(arena, before), Some(ellipse), screen)
            }
            None => {
                let t = &view.tetrahedra[caster - view.spheres.len()];
                let plane = |half_space| HalfPlane::of(&half_space, sheet, screen);
                let planes = if is_ahead {
                    collect(arena, t.solid.met(&t.from_light).map(plane))
                } else {
                    collect(arena, t.solid.ahead(&t.from_light).map(plane))
                };
                Shape::new(planes, None, screen)
            }
        }
    };
    casters.map(shape)
}

/// What may shade the pixels of a sphere.
fn casters_on<'f>(
    ball: &Ball,
    index: usize,
    view: &View<'_, Bounded>,
    lighting: &Lighting,
    casters: &[u16],
    arena: &'f Bump,
) -> &'f [Caster<'f>] {
    let to_light = view.shading.to_light;
    let own = view.spheres[index].support;
    let beside = LazyCell::new(|| ball.beside(lighting));
    let casters = casters.iter().filter_map(|&caster| {
        let caster = usize::from(caster);
        match view.spheres.get(caster) {
            // A ray leaves its own sphere, also where that is listed twice.
            Some(sphere) if sphere.support == own => None,
            Some(sphere) => {
                let (moment, before) = ball.around(sphere.center, &to_light, &beside);
                let reach = to_light.squared_length * sphere.radius.squared();
                Some(Caster::Ball(
                    arena.alloc(Passing::new(before, moment, reach)),
                ))
            }
            None => {
                let t = &view.tetrahedra[caster - view.spheres.len()];
                let ahead = t.solid.ahead(&t.from_light);
                let forms = ahead.map(|half_space| ball.inside(&half_space, lighting));
                Some(Caster::Cell(collect(arena, forms)))
            }
        }
    });
    collect(arena, casters)
}
