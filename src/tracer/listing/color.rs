//! Code 4-1: Equation 4-1.

use glam::DVec3;

use super::unit::get_unit;
use crate::scene::Scene;

/// Code 4-1. `scene` holds the document's `Light I`: its ka, kd, ks are the material's, its Ia and
/// Ib the light's.
pub(super) fn get_pixel_color(
    ligdir: DVec3,
    viewdir: DVec3,
    normal: DVec3,
    scene: &Scene,
) -> DVec3 {
    let (i, material) = (scene.light(), scene.material());
    let h = get_unit(viewdir + ligdir);
    let mul_nl = ligdir.dot(normal);
    let mul_nh = normal.dot(h);
    let max_nl = if mul_nl > 0.0 { mul_nl } else { 0.0 };
    let max_nh = if mul_nh > 0.0 { mul_nh } else { 0.0 };
    // Slip (Code 4-1): Equation 4-1 asks for the power of the true n·h. A dot product has a
    // relative error of some 1e-16, and its 1000th power 1000 times that.
    let highlight = libm::pow(max_nh, f64::from(material.exponent));
    material.ambient * i.ambient_intensity
        + material.diffuse * i.intensity * max_nl
        + material.specular * i.intensity * highlight // eq 4-1
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::camera::sin_cos;

    /// Where n = h the equation's power is 1, and the listing's is off by nothing or by some 1000
    /// times what n·h is off by.
    #[test]
    #[expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]
    fn a_power_multiplies_the_error_of_its_base() {
        let scene = Scene::from_toml(
            "material = { ambient = [0, 0, 0], diffuse = [0, 0, 0], specular = [1, 1, 1] }",
        )
        .unwrap();
        let ligdir = get_unit(scene.light().direction);
        let errors = (0..100).map(|step| {
            let (sin, cos) = sin_cos(f64::from(step) * 0.06);
            let viewdir = get_unit(dvec3(sin, 0.3, cos));
            let normal = get_unit(viewdir + ligdir);
            (get_pixel_color(ligdir, viewdir, normal, &scene).x - 1.0).abs()
        });
        let (none, some): (Vec<_>, Vec<_>) = errors.partition(|&error| error < f64::EPSILON);
        assert!(!none.is_empty() && !some.is_empty());
        for error in some {
            assert!(
                (400.0..4000.0).contains(&(error / f64::EPSILON)),
                "{error:e}"
            );
        }
    }
}
