//! The colours of errors.

/// Errors from this many octaves of f32 steps on have the last colour: such samples have not even
/// their first digit in common.
pub(super) const OCTAVES: u32 = 24;

/// From 1 step to 2^24 in equal ratios: the map inferno of matplotlib without its black. It grows
/// lighter all the way, so it reads in grey and for the colour-blind.
const RAMP: [[u8; 3]; 5] = [
    [0x42, 0x0a, 0x68],
    [0x93, 0x26, 0x67],
    [0xdd, 0x51, 0x3a],
    [0xfc, 0xa5, 0x0a],
    [0xfc, 0xff, 0xa4],
];

/// No error.
const NONE: [u8; 3] = [0, 0, 0];

/// A NaN in the place of a number.
const NAN: [u8; 3] = [0x56, 0xb4, 0xe9];

/// The colour, red, green and blue of a display, for an error as [`steps`](super::steps) counts it:
/// black for 0, light blue for `None`, and from dark purple at 1 over red and orange to pale yellow
/// at 2²⁴ and more.
///
/// ```
/// use firsthit::difference::error_color;
/// assert_eq!(error_color(Some(0)), [0, 0, 0]);
/// assert_eq!(error_color(Some(1 << 24)), error_color(Some(u32::MAX)));
/// ```
pub fn error_color(steps: Option<u32>) -> [u8; 3] {
    match steps {
        None => NAN,
        Some(0) => NONE,
        Some(steps) => {
            // Straight between powers of two: nobody sees the difference to a logarithm.
            let octave = steps.ilog2();
            let octaves = octave as f32 + (steps as f32 / (1_u64 << octave) as f32 - 1.0);
            color_at(octaves / OCTAVES as f32)
        }
    }
}

/// The colour at a place of the ramp, from 0 to 1.
pub(super) fn color_at(place: f32) -> [u8; 3] {
    let last = RAMP.len() - 1;
    let place = place.clamp(0.0, 1.0) * last as f32;
    let first = (place as usize).min(last - 1);
    let part = place - first as f32;
    let (from, to) = (RAMP[first], RAMP[first + 1]);
    [0, 1, 2].map(|channel| {
        let (from, to) = (f32::from(from[channel]), f32::from(to[channel]));
        (from + (to - from) * part).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_error_is_lighter_also_in_grey() {
        let grey = |steps| {
            let [red, green, blue] = error_color(Some(steps)).map(f32::from);
            0.299 * red + 0.587 * green + 0.114 * blue
        };
        let greys: Vec<f32> = (0..=OCTAVES).map(|octave| grey(1 << octave)).collect();
        assert!(grey(0) + 20.0 < greys[0]);
        assert!(
            greys.is_sorted_by(|darker, lighter| darker < lighter),
            "{greys:?}"
        );
        assert_eq!(error_color(Some(1)), RAMP[0]);
        assert_eq!(error_color(Some(1 << OCTAVES)), RAMP[4]);
        assert_eq!(error_color(Some(u32::MAX)), RAMP[4]);
        assert!(!RAMP.contains(&error_color(None)));
    }
}
