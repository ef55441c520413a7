//! Which solids can cast a shadow on which: most cannot, and turning the scene does not change
//! that. `surface_casters.rs` tells which can cast one on the surface.

use std::cmp::Ordering;
use std::sync::OnceLock;

use glam::DVec3;
use smallvec::SmallVec;

use super::bounding_ball::{BoundingBall, MARGIN, Projections, bounding_balls};
use super::{EDGES, FACES, Solid, Sphere, Tetrahedron};

/// The casters of each sphere and each face: the solids that may stand between a point of it and
/// the light. In a crowd, those of most are never asked for.
///
/// Enclosed solids are neither casters nor receivers: their shadows lie within the shadows of the
/// solids that enclose them, and no ray meets them first. Faces turned away from the light have no
/// casters: they are dark anyway.
#[derive(Clone, Debug)]
pub(crate) struct Casters {
    /// The way to the light, of length 1.
    l: DVec3,
    /// By the number of the solid.
    enclosed: Vec<bool>,
    balls: Vec<BoundingBall>,
    /// The projections of `balls` onto a line across the light.
    projections: Projections,
    /// By the number of the tetrahedron.
    prisms: Vec<Prisms>,
    on_spheres: Vec<OnceLock<CasterList>>,
    on_faces: Vec<OnceLock<OnFaces>>,
}

/// The casters of the faces of a tetrahedron: mostly read together, so they lie together.
#[derive(Clone, Debug)]
struct OnFaces {
    /// Those of face 0, then those of face 1, and so on.
    all: CasterList,
    /// Where those of each face end.
    ends: [u32; 4],
}

/// The numbers of casters. Most solids of a crowd have no more than eight: these are read without a
/// look elsewhere.
type CasterList = SmallVec<[u16; 8]>;

impl OnFaces {
    fn of(&self, face: usize) -> &[u16] {
        let begin = if face == 0 { 0 } else { self.ends[face - 1] };
        &self.all[begin as usize..self.ends[face] as usize]
    }
}

/// The casters of so many solids are found at once, so that no frame has to find any.
const FEW: usize = 256;

impl Casters {
    /// `facing_light` tells the sign of n·l for each face.
    pub(super) fn new(
        spheres: &[Sphere],
        tetrahedra: &[Tetrahedron],
        to_light: DVec3,
        enclosed: &[bool],
        facing_light: &[[Ordering; 4]],
    ) -> Self {
        let l = to_light.normalize();
        let balls = bounding_balls(spheres, tetrahedra);
        let prisms = tetrahedra.iter().zip(facing_light);
        let casters = Casters {
            l,
            enclosed: enclosed.to_vec(),
            projections: Projections::new(&balls, l.any_orthonormal_vector()),
            prisms: prisms
                .map(|(tetrahedron, facing)| Prisms::new(tetrahedron, facing, l))
                .collect(),
            on_spheres: vec![OnceLock::new(); spheres.len()],
            on_faces: vec![OnceLock::new(); tetrahedra.len()],
            balls,
        };
        if casters.are_found() {
            for solid in 0..casters.balls.len() {
                // Those of all faces of a tetrahedron are found together.
                casters.on(solid, Some(0));
            }
        }
        casters
    }

    /// The casters of a sphere, or of a face of a tetrahedron, in the scene's order.
    pub(crate) fn on(&self, solid: usize, face: Option<usize>) -> &[u16] {
        match (
            Solid::numbered(solid, &self.on_spheres, &self.on_faces),
            face,
        ) {
            (Solid::Sphere(casters), _) => casters.get_or_init(|| self.find_on_sphere(solid)),
            (Solid::Tetrahedron(casters), Some(face)) => {
                casters.get_or_init(|| self.find_on_faces(solid)).of(face)
            }
            (Solid::Tetrahedron(_), None) => &[],
        }
    }

    /// Whether the casters of all solids are found.
    pub(crate) fn are_found(&self) -> bool {
        self.balls.len() <= FEW
    }

    fn find_on_sphere(&self, sphere: usize) -> CasterList {
        let ball = Balls::of(&self.balls[sphere]);
        let is_caster = |&caster: &u16| !self.misses(caster, None, ball);
        let near = self.near(sphere);
        let mut casters: CasterList = near.into_iter().filter(is_caster).collect();
        // They live as long as the scene.
        casters.shrink_to_fit();
        casters
    }

    fn find_on_faces(&self, tetrahedron: usize) -> OnFaces {
        let prisms = &self.prisms[tetrahedron - self.on_spheres.len()];
        let near = self.near(tetrahedron);
        let mut all = CasterList::new();
        let ends = [0, 1, 2, 3].map(|face| {
            if let Some(light) = &prisms.light[face] {
                let vertices = vertices_of(face, &prisms.vertices);
                let points = Balls::points(&vertices);
                let is_caster = |&caster: &u16| !self.misses(caster, Some(light), points);
                all.extend(near.iter().copied().filter(is_caster));
            }
            all.len() as u32
        });
        // They live as long as the scene.
        all.shrink_to_fit();
        OnFaces { all, ends }
    }

    /// The solids whose balls may stand between a point of the receiver's ball and the light.
    fn near(&self, receiver: usize) -> Vec<u16> {
        if self.enclosed[receiver] {
            return Vec::new();
        }
        let ball = &self.balls[receiver];
        let is_near = |&caster: &usize| {
            let other = &self.balls[caster];
            let between = other.center - ball.center;
            let slack = ball.slack(other);
            let touching = (other.radius + ball.radius) * MARGIN + slack;
            let is_beside = between.cross(self.l).length_squared() > touching * touching * MARGIN;
            let is_behind = between.dot(self.l) < -touching;
            !self.enclosed[caster] && !is_beside && !is_behind
        };
        let near = self.projections.overlapping(receiver).filter(is_near);
        let mut near: Vec<u16> = near.map(|caster| caster as u16).collect();
        near.sort_unstable();
        near
    }

    /// Whether a solid certainly casts no shadow on a sphere, or on a face with the prism `light`
    /// on it.
    fn misses(&self, caster: u16, light: Option<&Prism>, of_receiver: Balls<'_>) -> bool {
        let caster = usize::from(caster);
        let misses = |balls| light.is_some_and(|light| light.misses(balls));
        match Solid::numbered(caster, &self.on_spheres, &self.prisms) {
            Solid::Sphere(_) => misses(Balls::of(&self.balls[caster])),
            Solid::Tetrahedron(prisms) => {
                misses(Balls::points(&prisms.vertices)) || prisms.shadow.misses(of_receiver)
            }
        }
    }
}

/// Balls around some points, which hold a solid or a face in their convex hull.
#[derive(Clone, Copy)]
struct Balls<'s> {
    centers: &'s [DVec3],
    radius: f64,
}

impl<'s> Balls<'s> {
    fn of(ball: &'s BoundingBall) -> Self {
        Balls {
            centers: std::slice::from_ref(&ball.center),
            radius: ball.radius,
        }
    }

    fn points(centers: &'s [DVec3]) -> Self {
        Balls {
            centers,
            radius: 0.0,
        }
    }
}

/// The vertices of face `k` of a tetrahedron: all but vertex `k`.
fn vertices_of(k: usize, vertices: &[DVec3; 4]) -> [DVec3; 3] {
    FACES[k].map(|vertex| vertices[vertex])
}

/// The prisms of a tetrahedron along the light.
#[derive(Clone, Debug)]
struct Prisms {
    vertices: [DVec3; 4],
    /// For each face that is turned to the light: what stands on the face toward the light. Its
    /// casters reach into it.
    light: [Option<Prism>; 4],
    /// What extends from the tetrahedron away from the light. Its receivers reach into it.
    shadow: Prism,
}

impl Prisms {
    /// `facing` tells the sign of n·l for each face; `l` has length 1.
    fn new(tetrahedron: &Tetrahedron, facing: &[Ordering; 4], l: DVec3) -> Self {
        let v = tetrahedron.vertices;
        let magnitude = v.iter().map(|v| v.abs().element_sum()).fold(0.0, f64::max);
        let along_light = |from: DVec3, to: DVec3, inner: DVec3| {
            PrismPlane::new(from, [to - from, l], inner, magnitude.max(1.0))
        };
        // The plane of a face, with the solid on the inner side.
        let own = |k: usize| {
            let [a, b, c] = vertices_of(k, &tetrahedron.vertices);
            PrismPlane::new(a, [b - a, c - a], v[k], magnitude)
        };
        let light = [0, 1, 2, 3].map(|k: usize| {
            let [a, b, c] = vertices_of(k, &tetrahedron.vertices);
            let on_face = [
                own(k).map(PrismPlane::flipped),
                along_light(a, b, c),
                along_light(b, c, a),
                along_light(c, a, b),
            ];
            let is_lit = facing[k].is_gt();
            is_lit.then(|| Prism(on_face.into_iter().flatten().collect()))
        });
        let lit = [0, 1, 2, 3]
            .into_iter()
            .filter(|k: &usize| facing[*k].is_gt());
        // An edge belongs to the silhouette if both other vertices are on one side.
        let silhouette = EDGES.map(|(c, d, [a, b])| {
            along_light(v[a], v[b], v[c])
                .filter(|plane| plane.height(v[d]).is_some_and(|height| height < 0.0))
        });
        let shadow = lit.map(own).chain(silhouette);
        Prisms {
            vertices: v,
            light,
            shadow: Prism(shadow.flatten().collect()),
        }
    }
}

/// An intersection of half-spaces.
#[derive(Clone, Debug)]
struct Prism(Vec<PrismPlane>);

impl Prism {
    /// Whether all of the balls certainly lie outside, beyond one of its planes.
    fn misses(&self, balls: Balls<'_>) -> bool {
        self.0.iter().any(|plane| plane.is_below(balls))
    }
}

/// A plane of a prism.
#[derive(Clone, Debug)]
struct PrismPlane {
    at: DVec3,
    /// Out of the prism, of length `length`.
    normal: DVec3,
    length: f64,
    /// A bound on the error of `normal`.
    error: f64,
}

impl PrismPlane {
    /// The plane through `at` along two vectors, each of length 1 or the difference of two points
    /// at most `magnitude` from the origin; `inner` lies on the inner side. `None` where f64 does
    /// not tell which side that is.
    fn new(at: DVec3, [a, b]: [DVec3; 2], inner: DVec3, magnitude: f64) -> Option<Self> {
        let normal = a.cross(b);
        // A difference rounds by u of its points, which the product multiplies by the other factor;
        // a cross product rounds three times. 32 u of these magnitudes is more than the sum.
        let magnitudes =
            magnitude * (a.abs() + b.abs()).element_sum() + (a.length() + magnitude) * b.length();
        let error = 16.0 * f64::EPSILON * magnitudes;
        let plane = PrismPlane {
            at,
            length: normal.length() * MARGIN,
            normal,
            error,
        };
        let inside = plane.height(inner)?;
        Some(if inside > 0.0 { plane.flipped() } else { plane })
    }

    fn flipped(self) -> Self {
        PrismPlane {
            normal: -self.normal,
            ..self
        }
    }

    /// The height of a point above the plane, times `length`; `None` where its sign is in doubt.
    fn height(&self, point: DVec3) -> Option<f64> {
        let from = point - self.at;
        let height = self.normal.dot(from);
        (height.abs() > self.slack(point)).then_some(height)
    }

    fn slack(&self, point: DVec3) -> f64 {
        let magnitudes = (point.abs() + self.at.abs()).element_sum();
        (self.error + 8.0 * f64::EPSILON * self.length) * magnitudes * 2.0
    }

    /// Whether the plane certainly lies below all of the balls.
    fn is_below(&self, balls: Balls<'_>) -> bool {
        let radius = balls.radius * MARGIN * (self.length + self.error);
        let is_above =
            |center: &DVec3| self.normal.dot(center - self.at) > radius + self.slack(*center);
        balls.centers.iter().all(is_above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Whether the ray from a point along `l` certainly meets a ball.
    fn meets_ball(point: DVec3, l: DVec3, center: DVec3, radius: f64) -> bool {
        let between = center - point;
        between.dot(l) > 0.0 && between.cross(l).length() < radius * 0.999
    }

    /// Whether the ray from a point along `l` certainly meets a tetrahedron: its line enters all
    /// faces before it leaves any.
    fn meets_tetrahedron(point: DVec3, l: DVec3, tetrahedron: &Tetrahedron) -> bool {
        let (mut enter, mut leave) = (1e-6, f64::INFINITY);
        for k in 0..4 {
            let [a, b, c] = vertices_of(k, &tetrahedron.vertices);
            let normal = (b - a).cross(c - a);
            let outward = -normal * normal.dot(tetrahedron.vertices[k] - a).signum();
            let (height, climb) = (outward.dot(point - a), outward.dot(l));
            let at = -height / climb;
            if climb < 0.0 {
                enter = at.max(enter);
            } else {
                leave = at.min(leave);
            }
        }
        enter + 1e-6 < leave
    }

    #[test]
    fn every_solid_that_a_ray_to_the_light_meets_is_a_caster() {
        let mut random = Random::new();
        let mut number = |max: f64| max * (2.0 * random.fraction() - 1.0);
        let (mut met, mut listed, mut pairs) = (0, 0, 0);
        for _ in 0..60 {
            let mut vector = |max: f64| DVec3::new(number(max), number(max), number(max));
            let l = vector(1.0).normalize();
            let tetrahedra: Vec<Tetrahedron> = (0..12)
                .map(|_| {
                    let middle = vector(1.0);
                    Tetrahedron {
                        vertices: [(); 4].map(|()| middle + vector(0.4)),
                        color: DVec3::ONE,
                    }
                })
                .collect();
            let spheres: Vec<Sphere> = (0..4)
                .map(|_| Sphere {
                    center: vector(1.0),
                    radius: 0.2,
                    color: DVec3::ONE,
                })
                .collect();
            let facing: Vec<[Ordering; 4]> = tetrahedra
                .iter()
                .map(|tetrahedron| {
                    [0, 1, 2, 3].map(|k| {
                        let [a, b, c] = vertices_of(k, &tetrahedron.vertices);
                        let normal = (b - a).cross(c - a);
                        let inward = normal.dot(tetrahedron.vertices[k] - a).signum();
                        (-inward * normal.dot(l)).total_cmp(&0.0)
                    })
                })
                .collect();
            let solids = spheres.len() + tetrahedra.len();
            let casters = Casters::new(&spheres, &tetrahedra, l, &vec![false; solids], &facing);
            let mut check = |receiver: usize, face: Option<usize>, point: DVec3| {
                for caster in (0..solids).filter(|caster| *caster != receiver) {
                    let is_met = match Solid::numbered(caster, &spheres, &tetrahedra) {
                        Solid::Sphere(sphere) => meets_ball(point, l, sphere.center, sphere.radius),
                        Solid::Tetrahedron(tetrahedron) => meets_tetrahedron(point, l, tetrahedron),
                    };
                    let is_listed = casters.on(receiver, face).contains(&(caster as u16));
                    assert!(
                        is_listed || !is_met,
                        "{caster} shadows {receiver}, {face:?}"
                    );
                    met += usize::from(is_met);
                    listed += usize::from(is_listed);
                    pairs += 1;
                }
            };
            for (receiver, sphere) in spheres.iter().enumerate() {
                for _ in 0..20 {
                    let point = sphere.center + vector(1.0).normalize() * sphere.radius;
                    check(receiver, None, point);
                }
            }
            for (index, tetrahedron) in tetrahedra.iter().enumerate() {
                for k in (0..4).filter(|k| facing[index][*k].is_gt()) {
                    let [a, b, c] = vertices_of(k, &tetrahedron.vertices);
                    for _ in 0..20 {
                        let [i, j] = [a, b].map(|_| vector(1.0).x.abs());
                        let (i, j) = if i + j > 1.0 {
                            (1.0 - i, 1.0 - j)
                        } else {
                            (i, j)
                        };
                        let point = a + (b - a) * i + (c - a) * j;
                        check(spheres.len() + index, Some(k), point);
                    }
                }
            }
        }
        // Most solids shadow nothing, and are not listed.
        assert!(
            met > 1000 && listed < 6 * met,
            "{met} of {listed}, {pairs} in all"
        );
    }
}
