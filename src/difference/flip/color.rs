//! Colours as an observer tells them apart.

use glam::{DMat3, DVec3};

use crate::image::light;

/// X, Y and Z of the primaries and the white of sRGB, each scaled to 1 at white, which is what all
/// formulas here ask for.
pub(super) struct ColorSpace {
    xyz_of_rgb: DMat3,
    rgb_of_xyz: DMat3,
    /// The largest difference of two colours, that of green and blue.
    largest: f64,
}

impl ColorSpace {
    pub(super) fn new() -> ColorSpace {
        let x = DVec3::new(10_135_552.0, 8_788_810.0, 4_435_075.0) / 23_359_437.0;
        let y = DVec3::new(2_613_072.0, 8_788_810.0, 887_015.0) / 12_288_897.0;
        let z = DVec3::new(1_425_312.0, 8_788_810.0, 70_074_185.0) / 80_288_307.0;
        let xyz_of_rgb = DMat3::from_cols(x, y, z).transpose();
        let mut space = ColorSpace {
            xyz_of_rgb,
            rgb_of_xyz: xyz_of_rgb.inverse(),
            largest: 0.0,
        };
        let [green, blue] = [DVec3::Y, DVec3::Z].map(|rgb| space.hunt_adjusted_lab(rgb));
        space.largest = difference(green, blue);
        space
    }

    /// What a pixel of a display stands for as opponents: luminance, red against green, blue
    /// against yellow. They are those of the paper's YCxCz, which scales and shifts them.
    pub(super) fn opponents(&self, pixel: &[f32]) -> [f64; 3] {
        // A NaN is black.
        let shown = |channel: usize| pixel[channel].clamp(0.0, 1.0).max(0.0);
        let light = [0, 1, 2].map(|channel| light(shown(channel)));
        let DVec3 { x, y, z } = self.xyz_of_rgb * DVec3::from(light);
        [y, x - y, y - z]
    }

    /// The colour of opponents, where differences are as large as they seem: CIELAB, the chroma
    /// corrected by the lightness, as the paper has it from Hunt.
    pub(super) fn perceived(&self, [luminance, red_green, blue_yellow]: [f64; 3]) -> DVec3 {
        let xyz = DVec3::new(luminance + red_green, luminance, luminance - blue_yellow);
        let rgb = self.rgb_of_xyz * xyz;
        self.hunt_adjusted_lab(rgb.clamp(DVec3::ZERO, DVec3::ONE))
    }

    fn hunt_adjusted_lab(&self, rgb: DVec3) -> DVec3 {
        let DVec3 { x, y, z } = (self.xyz_of_rgb * rgb).map(lab_curve);
        let lightness = 116.0 * y - 16.0;
        let chroma = 0.01 * lightness;
        DVec3::new(
            lightness,
            chroma * 500.0 * (x - y),
            chroma * 200.0 * (y - z),
        )
    }

    /// The error of a colour, from 0 to 1: small differences take most of that.
    pub(super) fn error(&self, a: DVec3, b: DVec3) -> f64 {
        let (knee, error_there) = (0.4 * self.largest, 0.95);
        match difference(a, b) {
            below if below < knee => below * error_there / knee,
            above => error_there + (above - knee) / (self.largest - knee) * (1.0 - error_there),
        }
    }
}

/// The curve of CIELAB, from a quotient of light to what is seen of it.
fn lab_curve(light: f64) -> f64 {
    const DELTA: f64 = 6.0 / 29.0;
    match light > DELTA * DELTA * DELTA {
        true => libm::cbrt(light),
        false => light / (3.0 * DELTA * DELTA) + 4.0 / 29.0,
    }
}

/// The difference HyAB of two colours, compressed.
fn difference(a: DVec3, b: DVec3) -> f64 {
    let DVec3 { x, y, z } = a - b;
    libm::pow(x.abs() + (y * y + z * z).sqrt(), 0.7)
}
