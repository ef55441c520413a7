//! The solids as a frame's rows cross them: seen directly, or in the mirror.

use std::iter;
use std::ops::Range;

use super::Parts;
use super::ball::Ball;
use super::lanes::Caster;
use super::order::Order;
use super::paint::PaintNumber;
use super::shape::{Ellipse, HalfPlane, MORE, Off, Screen, Shape, Sheet, U};
use super::sweep::{Border, Borders};
use crate::number::{Bounded, Real};
use crate::scene::{Side, Support};
use crate::stage::Stage;
use crate::tracer::decision::{Decision, Seen};
use crate::tracer::pixel::Picture;
use crate::tracer::tetrahedron::HalfSpace;
use crate::tracer::vector::Vector;
use crate::tracer::view::{View, looking};

/// All solids that take part in a stage.
pub(super) struct Solids {
    pub(super) mirrored: bool,
    /// Whether points can be in shadow.
    pub(super) shadows: bool,
    pub(super) solids: Vec<Solid>,
    /// Which is in front of which.
    pub(super) order: Order,
}

/// One of them.
pub(super) struct Solid {
    pub(super) side: Side,
    depth: Depth,
    pub(super) body: Body,
}

/// How its pixels are coloured.
pub(super) enum Body {
    /// All alike.
    Flat(PaintNumber),
    Ball(Box<ShadedBall>),
    Facets(Vec<Facet>, Vec<Pair>),
    /// Each is to be asked for.
    Unknown,
}

/// A sphere that is shaded.
pub(super) struct ShadedBall {
    pub(super) ball: Ball,
    /// What may throw a shadow on it.
    pub(super) casters: Vec<Caster>,
    /// Its decision in the light.
    pub(super) lit: Decision,
    pub(super) in_shadow: PaintNumber,
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
enum Depth {
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
    Facets(Vec<([f64; 3], f64)>),
}

impl Solids {
    pub(super) fn new(
        picture: &Picture<'_, Bounded>,
        view: &View<Bounded>,
        mirrored: bool,
        parts: &mut Parts<'_>,
    ) -> Solids {
        let screen = parts.screen;
        let (scene, stage) = (picture.scene, picture.stage);
        let count = view.spheres.len();
        let mut all = Solids {
            mirrored,
            shadows: stage >= Stage::Shadow,
            solids: Vec::new(),
            order: Order::new(
                view,
                match stage {
                    Stage::Spheres => 0..count,
                    Stage::Tetrahedron => count..count + view.tetrahedra.len(),
                    _ => 0..count + view.tetrahedra.len(),
                },
            ),
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
        if stage != Stage::Tetrahedron {
            for (index, sphere) in view.spheres.iter().enumerate() {
                let ellipse = Ellipse::outline(sphere.center, sphere.radius, screen);
                let mut paint = |in_shadow| {
                    let decision = all.decision(index as u16, None, in_shadow);
                    parts.paints.of(decision)
                };
                let body = if stage == Stage::Spheres {
                    Body::Flat(paint(false))
                } else if surface_shades(index) {
                    Body::Unknown
                } else {
                    let own = picture.solid_color(index);
                    let own = reflectance.map_or(own, |reflectance| own * reflectance);
                    let ball = Ball::new(sphere, &ellipse, &view.shading, own, all.shadows);
                    let casters = if all.shadows {
                        casters_on(&ball, index, view, &facts.casters[index])
                    } else {
                        Vec::new()
                    };
                    Body::Ball(Box::new(ShadedBall {
                        ball,
                        casters,
                        lit: all.decision(index as u16, None, false),
                        in_shadow: paint(all.shadows),
                    }))
                };
                let depth = depth_of_ball(sphere.center, &ellipse, sphere.support, screen);
                all.push(
                    Solid {
                        side: facts.sides[index],
                        depth,
                        body,
                    },
                    Shape::new(Vec::new(), Some(ellipse), screen).within(rows),
                    &mut parts.borders,
                );
            }
        }
        if stage != Stage::Spheres {
            for (index, t) in (count..).zip(&view.tetrahedra) {
                let planes = |half_spaces: &mut dyn Iterator<Item = HalfSpace<Bounded>>| {
                    let sheet = eye_sheet(screen);
                    half_spaces
                        .map(|half_space| HalfPlane::of(&half_space, &sheet, screen))
                        .collect::<Vec<_>>()
                };
                let (first, end) = view.extents[index].rows(screen.size);
                let rows = (first.max(rows.0), end.min(rows.1));
                let outline = Shape::new(planes(&mut t.solid.met(&t.from_eye)), None, screen);
                let entered: Vec<usize> = t.from_eye.entered().collect();
                let (mut facets, mut depths) = (Vec::new(), Vec::new());
                for &face in &entered {
                    let (sheet, depth) = face_sheet(t.solid.plane(face), screen);
                    depths.push(depth);
                    let turned_away = all.shadows && t.solid.turned_away(face);
                    let shadows = if all.shadows && !turned_away {
                        let casters = facts.casters[index].iter().copied();
                        shadows_on(&sheet, view, casters, |_| false, screen)
                    } else {
                        Vec::new()
                    };
                    let mut paint = |in_shadow| {
                        let decision = all.decision(index as u16, Some(face as u8), in_shadow);
                        parts.paints.of(decision)
                    };
                    facets.push(Facet {
                        lit: paint(false),
                        in_shadow: paint(all.shadows),
                        turned_away,
                        shadows: parts.borders.add_details(shadows.into_iter(), rows),
                    });
                }
                let place = |face: usize| entered.iter().position(|&other| other == face);
                let sheet = eye_sheet(screen);
                let pairs = t
                    .solid
                    .entered_pairs(&t.from_eye)
                    .filter_map(|(i, j, first)| {
                        let first = HalfPlane::of(&first, &sheet, screen);
                        let first = Shape::new(vec![first], None, screen);
                        Some(Pair {
                            facets: (place(i)?, place(j)?),
                            first: parts.borders.add_details(iter::once(first), rows).start,
                        })
                    })
                    .collect();
                let body = if surface_shades(index) {
                    Body::Unknown
                } else {
                    Body::Facets(facets, pairs)
                };
                all.push(
                    Solid {
                        side: facts.sides[index],
                        depth: Depth::Facets(depths),
                        body,
                    },
                    outline.within(rows),
                    &mut parts.borders,
                );
            }
        }
        all
    }

    fn push(&mut self, solid: Solid, outline: Shape, borders: &mut Borders) {
        let place = self.solids.len();
        if !self.mirrored {
            borders.add(outline, Border::Direct(place));
        } else if solid.side != Side::Below {
            // Below the surface nothing is mirrored.
            borders.add(outline, Border::Mirrored(place));
        }
        self.solids.push(solid);
    }

    /// What pixels of a solid show.
    pub(super) fn decision(&self, solid: u16, face: Option<u8>, in_shadow: bool) -> Decision {
        let seen = Seen {
            solid,
            face,
            in_shadow,
        };
        if self.mirrored {
            Decision::Mirrored(seen)
        } else {
            Decision::Solid(seen)
        }
    }
}

impl Solid {
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
    pub(super) fn is_same_sphere(&self, other: &Solid) -> bool {
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
) -> Depth {
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
pub(super) fn shadows_on(
    sheet: &Sheet,
    view: &View<Bounded>,
    casters: impl Iterator<Item = u16>,
    is_ahead: impl Fn(usize) -> bool,
    screen: Screen,
) -> Vec<Shape> {
    let to_light = view.shading.to_light;
    let shape = |caster: u16| {
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
                let ellipse = Ellipse::of(
                    (sphere.center, sphere.radius),
                    (to_light.vector, to_light.squared_length),
                    sheet,
                    screen,
                );
                Shape::new(before.collect(), Some(ellipse), screen)
            }
            None => {
                let t = &view.tetrahedra[caster - view.spheres.len()];
                let plane = |half_space| HalfPlane::of(&half_space, sheet, screen);
                let planes = if is_ahead {
                    t.solid.met(&t.from_light).map(plane).collect()
                } else {
                    t.solid.ahead(&t.from_light).map(plane).collect()
                };
                Shape::new(planes, None, screen)
            }
        }
    };
    casters.map(shape).collect()
}

/// What may shade the pixels of a sphere.
fn casters_on(ball: &Ball, index: usize, view: &View<Bounded>, casters: &[u16]) -> Vec<Caster> {
    let to_light = view.shading.to_light;
    let own = view.spheres[index].support;
    casters
        .iter()
        .filter_map(|&caster| {
            let caster = usize::from(caster);
            match view.spheres.get(caster) {
                // A ray leaves its own sphere, also where that is listed twice.
                Some(sphere) if sphere.support == own => None,
                Some(sphere) => {
                    let (moment, before) = ball.around(sphere.center, &to_light);
                    let reach = to_light.squared_length * sphere.radius.squared();
                    Some(Caster::ball(before, moment, reach))
                }
                None => {
                    let t = &view.tetrahedra[caster - view.spheres.len()];
                    let ahead = t.solid.ahead(&t.from_light);
                    Some(Caster::Cell(
                        ahead.map(|half_space| ball.inside(&half_space)).collect(),
                    ))
                }
            }
        })
        .collect()
}
