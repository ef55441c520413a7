//! The seven stages of the document, from a test image to the animation.

use std::fmt;

/// One of the seven stages; its number is also its key in the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// 1: the four quadrants of the document's Code 2-1, no scene at all.
    Image = 1,
    /// 2: the first hit among the spheres, in flat colour.
    Spheres,
    /// 3: the first hit with the tetrahedra, in flat colour.
    Tetrahedron,
    /// 4: the first hit among all solids, shaded by equation 4-1.
    Shading,
    /// 5: the surface joins, and shadows fall on it and on the solids.
    Shadow,
    /// 6: the surface mirrors the solids.
    Reflection,
    /// 7: stage 6, with α advancing at every redisplay.
    Animation,
}

impl Stage {
    /// Every stage, in the order of the document.
    pub const ALL: [Stage; 7] = [
        Stage::Image,
        Stage::Spheres,
        Stage::Tetrahedron,
        Stage::Shading,
        Stage::Shadow,
        Stage::Reflection,
        Stage::Animation,
    ];

    /// The stage with this number, 1 to 7; `None` for any other.
    ///
    /// ```
    /// use firsthit::Stage;
    /// assert_eq!(Stage::from_number(6), Some(Stage::Reflection));
    /// assert_eq!(Stage::from_number(8), None);
    /// ```
    pub fn from_number(number: u8) -> Option<Stage> {
        Stage::ALL
            .into_iter()
            .find(|stage| stage.number() == number)
    }

    /// Its number, 1 to 7.
    pub fn number(self) -> u8 {
        self as u8
    }

    /// Its name, as the menu and the window's title show it.
    pub const fn title(self) -> &'static str {
        match self {
            Stage::Image => "Image",
            Stage::Spheres => "Spheres",
            Stage::Tetrahedron => "Tetrahedron",
            Stage::Shading => "Shading",
            Stage::Shadow => "Shadow",
            Stage::Reflection => "Reflection",
            Stage::Animation => "Animation",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.number(), self.title())
    }
}
