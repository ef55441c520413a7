//! The angle α: its frames, its sine and its cosine.

pub use crate::number::sin_cos;

/// The frames of a round of the animation: the document adds 0.3 until α > 6.28.
pub const ROUND: u64 = 21;

/// α_k = 3k/10 rounded once to f64, the angle in radians of animation frame `k`, which counts
/// modulo [`ROUND`].
///
/// ```
/// use firsthit::camera::frame_angle;
/// assert_eq!(frame_angle(3), 0.9);
/// assert_eq!(frame_angle(21), 0.0);
/// ```
pub fn frame_angle(k: u64) -> f64 {
    (3 * (k % ROUND)) as f64 / 10.0
}
