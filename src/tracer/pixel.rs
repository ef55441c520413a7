//! One pixel: first hit, shading, shadow, mirror, each as far as the stage asks for it.

use std::cmp::Ordering;
use std::iter;

use super::decision::{Decision, Seen};
use super::extent::{Extent, Extents};
use super::line::{Hit, Line};
use super::number::{Real, all, any};
use super::surface::Surface;
use super::vector::Vector;
use super::view::{Frame, FrameBearings, Reach, Solids, View, looking};
use crate::scene::Scene;
use crate::stage::Stage;

/// Everything about a frame that its pixels share.
pub(super) struct Picture<'a, R> {
    pub(super) scene: &'a Scene,
    pub(super) stage: Stage,
    pub(super) size: u32,
    pub(super) frame: Frame<R>,
    pub(super) view: View<R>,
    pub(super) floor: Option<Floor<R>>,
}

/// The surface, from stage 5 on.
pub(super) struct Floor<R> {
    pub(super) surface: Surface<R>,
    /// Where it can be seen.
    extent: Extent,
    color: Vector<R>,
    /// (N/2) · height.
    height_in_pixels: R,
    pub(super) mirror: Option<Mirror<R>>,
}

/// What the surface mirrors, from stage 6 on.
pub(super) struct Mirror<R> {
    pub(super) view: View<R>,
    pub(super) reflectance: R,
}

/// Whether anything is mirrored in this stage.
pub(super) fn mirrors(scene: &Scene, stage: Stage) -> bool {
    stage >= Stage::Reflection && scene.surface().is_some()
}

/// A pixel: what was decided, and the colour that follows from it.
pub(super) type Pixel = (Decision, [f32; 3]);

impl<'a, R: Real> Picture<'a, R> {
    /// `bearings` and `extents` are those of the same frame.
    pub(super) fn new(
        scene: &'a Scene,
        stage: Stage,
        frame: &Frame<R>,
        size: u32,
        bearings: &FrameBearings,
        extents: &Extents,
    ) -> Self {
        let floor = match (scene.surface(), frame.surface(scene), &extents.surface) {
            (Some(described), Some(surface), Some(extent)) if stage >= Stage::Shadow => {
                Some(Floor {
                    surface,
                    extent: extent.clone(),
                    color: Vector::exact(described.color),
                    height_in_pixels: R::exact(described.height) * R::exact(f64::from(size) / 2.0),
                    mirror: bearings.mirrored.as_ref().map(|bearings| Mirror {
                        view: View::new(scene, frame, bearings, &extents.mirrored, true),
                        reflectance: R::exact(described.reflectance),
                    }),
                })
            }
            _ => None,
        };
        Picture {
            scene,
            stage,
            size,
            frame: *frame,
            view: View::new(scene, frame, &bearings.direct, &extents.direct, false),
            floor,
        }
    }

    /// The pixel at `column` from the left and `row` from the bottom.
    pub(super) fn pixel(&self, column: u32, row: u32) -> Result<Pixel, R::Doubt> {
        let (decision, color) = match self.stage {
            Stage::Image => quadrant(column, row, self.size),
            Stage::Spheres => self.flat(column, row, Solids::Spheres)?,
            Stage::Tetrahedron => self.flat(column, row, Solids::Tetrahedra)?,
            Stage::Shading => self.lit(column, row)?,
            Stage::Shadow | Stage::Reflection | Stage::Animation => self.traced(column, row)?,
        };
        Ok((
            decision,
            [
                color.x.to_sample()?,
                color.y.to_sample()?,
                color.z.to_sample()?,
            ],
        ))
    }

    /// The whole line of sight through a pixel.
    pub(super) fn eye_ray(&self, column: u32, row: u32) -> Line<R> {
        let half = f64::from(self.size) / 2.0;
        let origin = [f64::from(column) - half, f64::from(row) - half, half]
            .map(|coordinate| R::exact(3.0 * coordinate));
        Line {
            origin: Vector::new(origin[0], origin[1], origin[2]),
            direction: looking(),
            leaves: None,
        }
    }

    /// Stages 2 and 3: the first hit, in the solid's colour.
    fn flat(
        &self,
        column: u32,
        row: u32,
        solids: Solids,
    ) -> Result<(Decision, Vector<R>), R::Doubt> {
        Ok(
            match self.view.first_hit(
                (column, row),
                &self.eye_ray(column, row),
                Reach::Line,
                solids,
            )? {
                Some((solid, hit)) => {
                    (Decision::Solid(seen(solid, &hit, false)), self.color(solid))
                }
                None => self.background(),
            },
        )
    }

    /// Stage 4: the first hit, shaded.
    fn lit(&self, column: u32, row: u32) -> Result<(Decision, Vector<R>), R::Doubt> {
        Ok(
            match self.view.first_hit(
                (column, row),
                &self.eye_ray(column, row),
                Reach::Line,
                Solids::All,
            )? {
                Some((solid, hit)) => {
                    let light = self.view.shading.lit(&hit)?;
                    (
                        Decision::Solid(seen(solid, &hit, false)),
                        self.color(solid).times(light),
                    )
                }
                None => self.background(),
            },
        )
    }

    /// Stages 5 to 7: the first hit among the solids and the surface.
    fn traced(&self, column: u32, row: u32) -> Result<(Decision, Vector<R>), R::Doubt> {
        let ray = self.eye_ray(column, row);
        let hit = self
            .view
            .first_hit((column, row), &ray, Reach::Line, Solids::All)?;
        if let Some(floor) = self
            .floor
            .as_ref()
            .filter(|floor| floor.extent.holds(column, row))
        {
            let (depth, point) = self.surface_point(floor, &ray, row);
            let hides = || match &hit {
                // Of a solid and the surface at the same depth, the solid is seen.
                Some((_, hit)) if hit.support == floor.surface.support => Ok(false),
                Some((_, hit)) => (hit.depth - depth).sign().map(Ordering::is_gt),
                None => Ok(true),
            };
            let contains = || floor.surface.contains(point);
            if all(iter::once_with(hides).chain(iter::once_with(contains)))? {
                return self.surface_at(floor, (column, row), point);
            }
        }
        Ok(match hit {
            Some((solid, hit)) => {
                let (in_shadow, color) = self.solid(&self.view, solid, &hit)?;
                (Decision::Solid(seen(solid, &hit, in_shadow)), color)
            }
            None => self.background(),
        })
    }

    /// Where an eye ray meets the surface's plane: its parameter, and the point, whose height is known without any rounding.
    pub(super) fn surface_point(
        &self,
        floor: &Floor<R>,
        ray: &Line<R>,
        row: u32,
    ) -> (R, Vector<R>) {
        let depth = R::exact(f64::from(row) - f64::from(self.size) / 2.0) - floor.height_in_pixels;
        (
            depth,
            Vector {
                y: floor.surface.height,
                ..ray.at(depth)
            },
        )
    }

    /// The surface where it is seen: in shadow, mirroring, or plain.
    fn surface_at(
        &self,
        floor: &Floor<R>,
        pixel: (u32, u32),
        point: Vector<R>,
    ) -> Result<(Decision, Vector<R>), R::Doubt> {
        let leaves = floor.surface.support;
        if self
            .view
            .is_shadowed(&self.view.ray_to_light(point, leaves))?
        {
            return Ok((Decision::SurfaceInShadow, self.view.shading.ambient()));
        }
        if let Some(mirror) = &floor.mirror {
            // The eye's ray goes on straight into the reflected scene.
            let ray = Line {
                origin: point,
                direction: looking(),
                leaves: Some(leaves),
            };
            if let Some((solid, hit)) =
                mirror
                    .view
                    .first_hit(pixel, &ray, Reach::Ahead, Solids::All)?
            {
                let (in_shadow, color) = self.solid(&mirror.view, solid, &hit)?;
                return Ok((
                    Decision::Mirrored(seen(solid, &hit, in_shadow)),
                    color * mirror.reflectance,
                ));
            }
        }
        Ok((Decision::Surface, floor.color))
    }

    /// Whether a point of a solid is in shadow, and its colour.
    fn solid(
        &self,
        view: &View<R>,
        solid: usize,
        hit: &Hit<R>,
    ) -> Result<(bool, Vector<R>), R::Doubt> {
        let ray = view.ray_to_light(hit.point, hit.support);
        let turned_away = || view.shading.facing_light(hit).map(Ordering::is_le);
        let by_solid = || view.is_shadowed(&ray);
        let by_surface = || {
            self.floor
                .as_ref()
                .map_or(Ok(false), |floor| floor.surface.is_ahead(&ray))
        };
        let in_shadow = any(iter::once_with(turned_away)
            .chain(iter::once_with(by_solid))
            .chain(iter::once_with(by_surface)))?;
        let light = if in_shadow {
            view.shading.ambient()
        } else {
            view.shading.lit(hit)?
        };
        Ok((in_shadow, self.color(solid).times(light)))
    }

    /// The colour c of a solid.
    pub(super) fn color(&self, solid: usize) -> Vector<R> {
        let spheres = self.scene.spheres();
        Vector::exact(match spheres.get(solid) {
            Some(sphere) => sphere.color,
            None => self.scene.tetrahedra()[solid - spheres.len()].color,
        })
    }

    fn background(&self) -> (Decision, Vector<R>) {
        (Decision::Background, Vector::exact(self.scene.background()))
    }
}

fn seen<R>(solid: usize, hit: &Hit<R>, in_shadow: bool) -> Seen {
    // A scene has at most 4096 solids.
    Seen {
        solid: solid as u16,
        face: hit.face,
        in_shadow,
    }
}

/// Code 2-1, the order of its `<=` and `>=` kept, with 250 read as N/2.
pub(super) fn quadrant<R: Real>(column: u32, row: u32, size: u32) -> (Decision, Vector<R>) {
    let (x, y) = (2 * column, 2 * row);
    let (number, [red, green, blue]) = if x <= size && y <= size {
        (0, [0.3, 0.3, 0.0])
    } else if x <= size && y >= size {
        (1, [0.0, 0.3, 0.3])
    } else if x >= size && y <= size {
        (2, [0.3, 0.0, 0.3])
    } else {
        (3, [0.0, 0.0, 0.0])
    };
    (
        Decision::Quadrant(number),
        Vector::new(R::exact(red), R::exact(green), R::exact(blue)),
    )
}
