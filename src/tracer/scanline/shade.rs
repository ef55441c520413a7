//! Spheres: the pixels of a span of one are shaded many at a time.

pub(super) mod caster;
pub(super) mod certified;
pub(super) mod light;
pub(super) mod shaded;
pub(super) mod spans;
pub(super) mod sphere;
pub(super) mod unchecked;
