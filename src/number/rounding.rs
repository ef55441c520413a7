//! What f64 and f32 arithmetic can be off by, and how bounds on that are computed in f64.
//!
//! A bound is a sum of terms that are not negative. Computing a bound rounds, too: so bounds are
//! multiplied by [`ROUND_UP`] or [`INFLATION`].

/// u, the largest relative error of one rounding to f64.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// 1 + 2⁻⁴⁸ = 1 + 32u, for bounds of a few operations: see `bounded.rs`.
pub(super) const ROUND_UP: f64 = 1.0 + 16.0 * f64::EPSILON;

/// 1 + 2⁻³⁹, for all other bounds: computing one of them has a relative error below 2⁻⁴⁰.
pub(crate) const INFLATION: f64 = 1.0 + 8192.0 * f64::EPSILON;

/// The largest relative error of one rounding to f32: v.
pub(crate) const U_F32: f64 = f32::EPSILON as f64 / 2.0;

/// 1 + 8v, for bounds of a few roundings to f32, which are rounded to f32 themselves.
pub(crate) const INFLATION_F32: f64 = 1.0 + 8.0 * U_F32;

/// More than any chain of operations here loses to underflow, and less than any number that
/// matters.
pub(super) const UNDERFLOW: f64 = 1e-290;
