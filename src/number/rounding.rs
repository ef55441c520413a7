//! What f64 arithmetic can be off by, and how bounds on that are computed in f64 themselves: see
//! `bounded.rs`.

/// u, the largest relative error of one rounding to f64.
pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// 1 + 2⁻⁴⁸ = 1 + 32u.
pub(super) const ROUND_UP: f64 = 1.0 + 64.0 * f64::EPSILON / 4.0;

/// More than any chain of operations here loses to underflow, and less than any number that
/// matters.
pub(super) const UNDERFLOW: f64 = 1e-290;
