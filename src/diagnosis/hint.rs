//! What to look at in the code of a tracer.

use std::fmt;

/// A mistake that explains a picture. Displayed, it is one line: what the picture looks like, and
/// what to look at in the code that made it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Hint {
    /// The rows come from the top to the bottom, or y points down.
    UpsideDown,
    /// Rows and columns are swapped.
    Transposed,
    /// Eye rays go through the middles of pixels, instead of their lower left corners.
    HalfPixelOff,
    /// The samples are encoded for a display: by sRGB's curve, or to the power of 1/2.2.
    Gamma,
    /// The samples of a pixel are blue, green, red.
    Bgr,
    /// The samples go from 0 to 255.
    Bytes,
    /// α is taken for degrees, or converted to degrees.
    Degrees,
    /// n·l has the wrong sign.
    LightSign,
    /// Shadow rays go away from the light.
    ShadowDirection,
    /// Shadow rays meet what lies behind their origin, or the solid that they start from.
    ShadowBehind,
    /// Rays hit solids where they leave them: the larger root is taken for the smaller one.
    FarRoot,
    /// Shadow acne: rounding decides whether a shadow ray meets the solid that it starts from.
    ShadowAcne,
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Hint::UpsideDown => "the picture is upside down: rows are expected from the bottom",
            Hint::Transposed => {
                "rows and columns are swapped: the pixels of a row are expected side by side"
            }
            Hint::HalfPixelOff => {
                "the picture is half a pixel off: u and v are those of (x, y), not of (x + 1/2, y + 1/2)"
            }
            Hint::Gamma => "the samples are gamma-encoded: linear ones are expected",
            Hint::Bgr => "red and blue are swapped: red, green, blue are expected",
            Hint::Bytes => "every sample is 255 times too large: 0 to 1 is expected",
            Hint::Degrees => "the eye is turned too much or too little: α is in radians",
            Hint::LightSign => {
                "light falls on the wrong side of solids: in n·l, l is the way toward the light"
            }
            Hint::ShadowDirection => {
                "shadows fall to the wrong side: shadow rays go toward the light"
            }
            Hint::ShadowBehind => {
                "solids are shaded by what lies behind them or by themselves: a shadow ray is met at t > 0 only"
            }
            Hint::FarRoot => {
                "solids show their far sides: a ray enters at the smaller one of both roots"
            }
            Hint::ShadowAcne => {
                "lit places are scattered with shadow: a shadow ray meets the solid that it starts from"
            }
        })
    }
}
