//! The constants of error bounds.
//!
//! Bounds are sums of terms that are not negative. Computing a bound rounds too, by a relative
//! error below 2⁻⁴⁰, so every bound is multiplied by [`INFLATION`].

/// u, the largest relative error of one rounding to f64.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// 1 + 2⁻³⁹.
pub(crate) const INFLATION: f64 = 1.0 + 8192.0 * f64::EPSILON;
