//! What the bounds on errors are made with.
//!
//! u is 2⁻⁵³, the largest relative error of an f64 operation. Bounds are sums of terms that are not
//! negative; computing them rounds too, each by less than 2⁻⁴⁰, for which [`MORE`] makes up.

/// u, the largest relative error of one rounding to f64.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// 1 + 2⁻³⁹.
pub(crate) const MORE: f64 = 1.0 + 8192.0 * f64::EPSILON;
