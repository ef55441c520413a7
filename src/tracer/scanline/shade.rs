//! Spheres: the pixels of a span that shows a sphere are shaded many at a time.

#[cfg(test)]
mod bounds_tests;
pub(super) mod caster;
pub(super) mod columns;
pub(super) mod equation;
pub(super) mod lane;
pub(super) mod light;
pub(super) mod policy;
pub(super) mod run;
pub(super) mod shaded;
pub(super) mod span;
pub(super) mod sphere;
#[cfg(test)]
mod tests;
