//! A line and the glazed surface: a square in a horizontal plane.

use std::cmp::Ordering;

use super::half_space::HalfSpace;
use super::line::Line;
use super::vector::Vector;
use super::view_space::{eye_direction, turn_back};
use crate::number::{Real, all};
use crate::scene::Support;

/// The square in view space: turned about y with the view, but always level.
#[derive(Clone, Copy)]
pub(super) struct Surface<R> {
    /// The y of the plane.
    pub(super) height: R,
    /// The same in pixels: (N/2) · height.
    pub(super) height_in_pixels: R,
    /// Half the length of a side.
    pub(super) half_width: R,
    /// sin α, the direction of the sides.
    pub(super) sin: R,
    pub(super) cos: R,
    /// The plane.
    pub(super) support: Support,
}

impl<R: Real> Surface<R> {
    /// The coordinates along the square's sides of a level vector.
    pub(super) fn along_sides(&self, v: Vector<R>) -> [R; 2] {
        turn_back(self.sin, self.cos, v)
    }

    /// The mirrored ray from a point of the square. In the reflected scene it is the continuation
    /// of the eye ray.
    pub(super) fn mirrored_ray(&self, point: Vector<R>) -> Line<R> {
        Line {
            origin: point,
            direction: eye_direction(),
            origin_support: Some(self.support),
        }
    }

    /// How far a point of the square's plane is inside of each side. `half` is half the length of a
    /// side; the point and `half` may be scaled by one positive factor.
    fn inside_of_sides(&self, point: Vector<R>, half: R) -> [R; 4] {
        // Both sides are told instead of |coordinate|: on the middle line the coordinate's sign may
        // be in doubt.
        let [a, b] = self.along_sides(point);
        [half - a, half + a, half - b, half + b]
    }

    /// The same for the points `origin` + X · `per_x` + Y · `per_y`: linear functions of X and Y,
    /// each as a constant and the coefficients of X and Y.
    pub(super) fn sides(&self, [origin, per_x, per_y]: [Vector<R>; 3], half: R) -> [[R; 3]; 4] {
        let constants = self.inside_of_sides(origin, half);
        let slopes = [per_x, per_y].map(|slope| {
            let [a, b] = self.along_sides(slope);
            [-a, a, -b, b]
        });
        std::array::from_fn(|side| [constants[side], slopes[0][side], slopes[1][side]])
    }

    /// Whether a point of the square's plane lies in the square; its border belongs to it.
    pub(super) fn contains(&self, point: Vector<R>) -> Result<bool, R::Doubt> {
        self.contains_scaled(point, self.half_width)
    }

    /// The same for a point and a square that are both scaled by one positive factor.
    fn contains_scaled(&self, point: Vector<R>, half_width: R) -> Result<bool, R::Doubt> {
        let sides = self.inside_of_sides(point, half_width);
        all(sides.map(|inside| Ok(inside.sign()?.is_ge())))
    }

    /// The half-spaces whose intersection holds the square's shadow: all points whose ray in the
    /// direction `to_light` meets the square. `rise` is the sign of that ray's rise. The
    /// half-spaces follow from [`Surface::is_ahead`], whose conditions are linear in the origin.
    ///
    /// Where `rise` is not 0, the intersection is the shadow. A level ray meets the square from
    /// some points of its plane only, which the half-spaces do not tell from the others.
    pub(super) fn shadow(
        &self,
        to_light: Vector<R>,
        rise: Ordering,
    ) -> impl Iterator<Item = HalfSpace<R>> {
        let (zero, one) = (R::exact(0.0), R::exact(1.0));
        let up = Vector::new(zero, one, zero);
        let at = Vector::new(zero, self.height, zero);
        let before = |normal: Vector<R>, closed: bool| HalfSpace {
            normal,
            at,
            closed,
            support: Some(self.support),
        };
        let (bounds, sides) = match rise {
            Ordering::Equal => ([Some(before(up, true)), Some(before(-up, true))], None),
            Ordering::Greater => ([Some(before(-up, false)), None], Some(to_light)),
            Ordering::Less => ([Some(before(up, false)), None], Some(-to_light)),
        };
        let sides = sides.into_iter().flat_map(move |l| {
            // The unit vectors along the sides.
            let along = [
                Vector::new(self.cos, zero, self.sin),
                Vector::new(-self.sin, zero, self.cos),
            ];
            along
                .into_iter()
                .flat_map(|side| [side, -side])
                .map(move |side| HalfSpace {
                    // half − a(p), times |rise|, where p is moved along the light into the plane.
                    normal: up * side.dot(l) - side * l.y,
                    at: at + side * self.half_width,
                    closed: true,
                    support: None,
                })
        });
        bounds.into_iter().flatten().chain(sides)
    }

    /// Whether the ray meets the square at some t > 0, from either side; one that lies in its
    /// plane, if it meets it there.
    pub(super) fn is_ahead(&self, ray: &Line<R>) -> Result<bool, R::Doubt> {
        let rise = ray.direction.vector.y;
        let above = self.height - ray.origin.y;
        let toward = if ray.origin_support == Some(self.support) {
            Ordering::Equal
        } else {
            above.sign()?
        };
        match (rise.sign()?, toward) {
            (Ordering::Equal, Ordering::Equal) => self.is_ahead_in_plane(ray),
            (Ordering::Equal, _) | (_, Ordering::Equal) => Ok(false),
            (up, toward) if up == toward => {
                // The point at t = above/rise, times |rise|: no division, so that the border is as
                // sharp as can be.
                let (rise, above) = if up.is_gt() {
                    (rise, above)
                } else {
                    (-rise, -above)
                };
                self.contains_scaled(
                    ray.origin * rise + ray.direction.vector * above,
                    self.half_width * rise,
                )
            }
            _ => Ok(false),
        }
    }

    /// The same for a ray in the square's own plane: the slabs between opposite sides and t > 0
    /// have a parameter in common.
    fn is_ahead_in_plane(&self, ray: &Line<R>) -> Result<bool, R::Doubt> {
        let origin = self.along_sides(ray.origin);
        let direction = self.along_sides(ray.direction.vector);
        let (mut enter, mut leave): (Option<R>, Option<R>) = (None, None);
        for (start, slope) in origin.into_iter().zip(direction) {
            let heading = slope.sign()?;
            if heading.is_eq() {
                if (self.half_width - start).sign()?.is_lt()
                    || (self.half_width + start).sign()?.is_lt()
                {
                    return Ok(false);
                }
                continue;
            }
            let (near, far) = if heading.is_gt() {
                (-self.half_width - start, self.half_width - start)
            } else {
                (self.half_width - start, -self.half_width - start)
            };
            let (near, far) = (near / slope, far / slope);
            enter = match enter {
                Some(other) if (other - near).sign()?.is_ge() => Some(other),
                _ => Some(near),
            };
            leave = match leave {
                Some(other) if (far - other).sign()?.is_ge() => Some(other),
                _ => Some(far),
            };
        }
        match (enter, leave) {
            (Some(enter), Some(leave)) => {
                Ok(leave.sign()?.is_gt() && (leave - enter).sign()?.is_ge())
            }
            // A ray that moves along neither side does not exist: its direction is not 0.
            _ => Ok(true),
        }
    }
}
