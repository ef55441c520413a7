//! How the pixels of solids are coloured, and which shadows fall on them.

use std::cell::OnceCell;

use bumpalo::collections::Vec as Growing;

use crate::number::Bounded;
use crate::scene::Solid;
use crate::stage::Stage;
use crate::tracer::arena::collect;
use crate::tracer::decision::{Decision, Seen};
use crate::tracer::pixel::Picture;
use crate::tracer::scanline::edges::ellipse::Ellipse;
use crate::tracer::scanline::edges::half_plane::HalfPlane;
use crate::tracer::scanline::edges::region::Region;
use crate::tracer::scanline::edges::table::{RegionKind, SolidIndex};
use crate::tracer::scanline::prepare::builder::Builder;
use crate::tracer::scanline::prepare::depth::face_plane;
use crate::tracer::scanline::prepare::front_faces::{FrontFace, FrontFaces};
use crate::tracer::scanline::prepare::late_faces::LateFaces;
use crate::tracer::scanline::prepare::outline::{OutlinedFaces, Outlines};
use crate::tracer::scanline::prepare::shadows::{SurfaceShadow, casters_on, shadows_on_face};
use crate::tracer::scanline::prepare::solids::{Appearance, PreparedSolids};
use crate::tracer::scanline::shade::light::Lighting;
use crate::tracer::scanline::shade::shaded::ShadedSphere;
use crate::tracer::scanline::shade::sphere::{HitBounds, SphereConstants};
use crate::tracer::scanline::visibility::separation::Separation;
use crate::tracer::sphere::Sphere;
use crate::tracer::tetrahedron::Passage;
use crate::tracer::vector::Vector;
use crate::tracer::view::View;
use crate::tracer::view_space::eye_direction;
use crate::tracer::view_tetrahedra::TetrahedronInView;

/// Prepares the solids of these outlines, and adds their regions and paints. `view` is that of
/// the scene, or the one in the mirror.
pub(crate) fn prepare_solids<'f>(
    picture: &Picture<'f, Bounded>,
    view: &View<'f, Bounded>,
    outlines: Outlines<'_, 'f>,
    parts: &mut Builder<'f, '_>,
) -> PreparedSolids<'f> {
    let (arena, mirrored) = (parts.arena, outlines.mirrored);
    let numbers = outlines.numbers;
    let appearances = Appearances::new(picture, view, mirrored);
    let sides = numbers.iter().map(|&number| outlines.side(number));
    let sides = collect(arena, sides);
    // Colours and casters lie in another order: in loops of their own, the processor reads several
    // at once.
    let is_sphere = |&number: &usize| matches!(picture.scene.solid(number), Solid::Sphere(_));
    let spheres = numbers.iter().copied().filter(is_sphere);
    let count = spheres.clone().count();
    let mut colors = Growing::with_capacity_in(count, arena);
    colors.extend(spheres.clone().map(|number| picture.solid_color(number)));
    let mut casters = Growing::with_capacity_in(count, arena);
    casters.extend(spheres.map(|number| appearances.casters(number)));
    let mut of_spheres = colors.into_iter().zip(casters);
    let is_late = appearances.has_shadows && outlines.face_shadows() >= parts.late_from;
    let mut all_appearances = Growing::with_capacity_in(numbers.len(), arena);
    let mut depths = Growing::with_capacity_in(numbers.len(), arena);
    outlines.for_each(|solid| {
        let index = depths.len();
        let appearance = match view.solid(solid.number) {
            Solid::Sphere(sphere) => match (of_spheres.next(), solid.outline.ellipse()) {
                (Some((color, casters)), Some(outline)) => {
                    appearances.sphere(solid.number, sphere, (outline, color, casters), parts)
                }
                // Every sphere has a colour, and its outline is an ellipse.
                _ => Appearance::Flat(parts.paints.add(Decision::Background)),
            },
            Solid::Tetrahedron(t) if is_late => {
                parts.late_faces += 1;
                let number = parts.late_faces - 1;
                Appearance::LateFaces(arena.alloc(LateFaces::new(
                    number,
                    mirrored,
                    solid.faces(),
                    t,
                )))
            }
            Solid::Tetrahedron(t) => {
                let front_faces = appearances.front_faces(&solid.faces(), t, parts);
                Appearance::FrontFaces(arena.alloc(front_faces))
            }
        };
        let index = SolidIndex(index as u32);
        let kind = if mirrored {
            RegionKind::Mirrored(index)
        } else {
            RegionKind::Direct(index)
        };
        parts.edge_table.add(solid.outline, kind);
        all_appearances.push(appearance);
        depths.push(solid.depth);
    });
    PreparedSolids {
        mirrored,
        numbers,
        sides,
        appearance: all_appearances.into_bump_slice(),
        depths: depths.into_bump_slice(),
        separation: Separation::new(view, numbers, arena),
    }
}

/// Makes the appearances of a view's solids.
pub(super) struct Appearances<'p, 's, 'f> {
    picture: &'p Picture<'s, Bounded>,
    view: &'p View<'s, Bounded>,
    mirrored: bool,
    /// Whether the stage has shadows.
    has_shadows: bool,
    surface: SurfaceShadow<'p>,
    /// Made for the first sphere.
    lighting: OnceCell<&'f Lighting>,
}

impl<'p, 's, 'f> Appearances<'p, 's, 'f> {
    pub(super) fn new(
        picture: &'p Picture<'s, Bounded>,
        view: &'p View<'s, Bounded>,
        mirrored: bool,
    ) -> Self {
        Appearances {
            picture,
            view,
            mirrored,
            has_shadows: picture.stage >= Stage::Shadow,
            surface: SurfaceShadow::new(picture, view, mirrored),
            lighting: OnceCell::new(),
        }
    }

    /// The casters of a sphere, if the stage has shadows.
    fn casters(&self, number: usize) -> &'s [u16] {
        if self.has_shadows {
            self.picture.scene.facts().casters.on(number, None)
        } else {
            &[]
        }
    }

    fn decision(&self, solid: usize, face: Option<usize>, in_shadow: bool) -> Decision {
        let seen = Seen {
            solid: solid as u16,
            face: face.map(|face| face as u8),
            in_shadow,
        };
        if self.mirrored {
            Decision::Mirrored(seen)
        } else {
            Decision::Solid(seen)
        }
    }

    fn sphere(
        &self,
        number: usize,
        sphere: &Sphere<Bounded>,
        (outline, color, casters): (&Ellipse, Vector<Bounded>, &[u16]),
        parts: &mut Builder<'f, '_>,
    ) -> Appearance<'f> {
        let arena = parts.arena;
        if self.picture.stage == Stage::Spheres {
            return Appearance::Flat(parts.paints.add(self.decision(number, None, false)));
        }
        let color = if self.mirrored {
            self.picture.reflected(color)
        } else {
            color
        };
        let lighting = *self
            .lighting
            .get_or_init(|| arena.alloc(Lighting::new(&self.view.shading)));
        let bounds = HitBounds::new(sphere, outline);
        let mut all_casters = Growing::new_in(arena);
        if self.has_shadows {
            let surface = self.surface.on_sphere(number, &bounds, lighting, arena);
            // Most spheres have one caster or none.
            all_casters.reserve_exact(casters.len() + surface.iter().len());
            let solids = casters_on(&bounds, number, self.view, lighting, casters, arena);
            all_casters.extend(solids.chain(surface));
        }
        let in_shadow = self.decision(number, None, self.has_shadows);
        parts.shaded_spheres += 1;
        Appearance::Sphere(arena.alloc_with(|| ShadedSphere {
            number: parts.shaded_spheres - 1,
            constants: SphereConstants::new(
                sphere,
                outline,
                &bounds,
                lighting,
                color,
                self.has_shadows,
            ),
            casters: all_casters.into_bump_slice(),
            in_light: self.decision(number, None, false),
            in_shadow: parts.paints.of(in_shadow),
        }))
    }

    /// Whether shadows may fall on a face.
    fn receives(&self, solid: usize, face: usize, t: &TetrahedronInView<Bounded>) -> bool {
        let casters = &self.picture.scene.facts().casters;
        self.has_shadows
            && !t.solid.turned_away(face)
            && (self.surface.reaches(solid) || !casters.on(solid, Some(face)).is_empty())
    }

    /// The front faces of a tetrahedron, whose regions and paints are added.
    pub(super) fn front_faces(
        &self,
        solid: &OutlinedFaces<'f>,
        t: &TetrahedronInView<Bounded>,
        parts: &mut Builder<'f, '_>,
    ) -> FrontFaces {
        let (arena, grid) = (parts.arena, parts.grid);
        let passage = Passage::of(t.eye_signs);
        let mut front_faces = [FrontFace::default(); 4];
        // In shadow, all faces have one colour.
        let mut dark = None;
        for (front_face, face) in front_faces.iter_mut().zip(passage.entered()) {
            let mut shadows = Growing::new_in(arena);
            if self.receives(solid.number, face, t) {
                shadows = self.shadows_on_face(solid, face, t, parts);
            }
            let mut paint = |in_shadow| {
                let decision = self.decision(solid.number, Some(face), in_shadow);
                if !in_shadow {
                    return parts.paints.add(decision);
                }
                let paint = match dark {
                    Some(dark) => parts.paints.add_like(dark, decision),
                    None => parts.paints.add(decision),
                };
                *dark.insert(paint)
            };
            let outside = paint(self.has_shadows && t.solid.turned_away(face));
            *front_face = FrontFace {
                outside,
                in_shadow: if shadows.is_empty() {
                    outside
                } else {
                    paint(true)
                },
                shadows: parts.edge_table.add_receiver(shadows, solid.rows),
            };
        }
        let lines = (&t.solid, eye_direction().vector);
        let creases = HalfPlane::all_of(lines, &passage.creases, None, (grid, parts.level), arena);
        let first_crease = parts.edge_table.count();
        for crease in creases.chunks(1) {
            // A crease matters within the solid only: elsewhere a level one would cross many edges.
            let crease = Region::new(crease, None, grid)
                .within(solid.rows)
                .clipped(solid.outline);
            parts.edge_table.add(crease, RegionKind::Crease);
        }
        FrontFaces {
            all: front_faces,
            pairs: passage.pairs(),
            first_crease,
        }
    }

    /// The shadows that may fall on a front face.
    fn shadows_on_face(
        &self,
        solid: &OutlinedFaces<'f>,
        face: usize,
        t: &TetrahedronInView<Bounded>,
        parts: &Builder<'f, '_>,
    ) -> Growing<'f, Region<'f>> {
        let (arena, grid) = (parts.arena, parts.grid);
        let casters = &self.picture.scene.facts().casters;
        let casters = casters.on(solid.number, Some(face)).iter().copied();
        let behind = t.solid.inner_half_space(face);
        let plane = &face_plane(&behind, grid);
        let screen = (grid, parts.level);
        let solids = shadows_on_face((&behind, plane), self.view, casters, screen, arena);
        let surface = self.surface.on_plane(solid.number, plane, grid, arena);
        // Most shadows on the front face's plane fall beside the solid.
        let clipped = |shadow: Region<'f>| shadow.clipped(solid.outline);
        let mut shadows = Growing::new_in(arena);
        shadows.extend(solids.chain(surface).map(clipped));
        shadows
    }
}
