//! What is wrong with a decision, whoever took it.

use crate::tracer::{Decision, Seen};

/// What is wrong with a decision: the first thing that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WrongDecision {
    /// Something else is seen: another solid, the surface, the background.
    Solid,
    /// The right tetrahedron, but another of its faces.
    Face,
    /// The right thing, but in shadow instead of in light, or the other way round.
    Shadow,
    /// The surface in light, but it mirrors something else, or the same otherwise lit.
    Mirror,
}

impl WrongDecision {
    /// What is wrong with `decision` in a pixel whose true one is `truth`; `None` where it is the
    /// right one.
    pub fn of(decision: Decision, truth: Decision) -> Option<WrongDecision> {
        use Decision::{Mirrored, Solid, Surface, SurfaceInShadow};
        if decision == truth {
            return None;
        }
        Some(match (decision, truth) {
            (Solid(seen), Solid(truth)) => match (seen, truth) {
                (Seen { solid, .. }, truth) if solid != truth.solid => WrongDecision::Solid,
                (Seen { face, .. }, truth) if face != truth.face => WrongDecision::Face,
                _ => WrongDecision::Shadow,
            },
            (SurfaceInShadow, Surface | Mirrored(_)) | (Surface | Mirrored(_), SurfaceInShadow) => {
                WrongDecision::Shadow
            }
            (Surface | Mirrored(_), Surface | Mirrored(_)) => WrongDecision::Mirror,
            _ => WrongDecision::Solid,
        })
    }
}

/// Pixels with a wrong decision, each counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WrongPixels {
    /// Those of [`WrongDecision::Solid`].
    pub solid: u64,
    /// Those of [`WrongDecision::Face`].
    pub face: u64,
    /// Those of [`WrongDecision::Shadow`].
    pub shadow: u64,
    /// Those of [`WrongDecision::Mirror`].
    pub mirror: u64,
}

impl WrongPixels {
    /// All of them.
    pub fn total(&self) -> u64 {
        self.solid + self.face + self.shadow + self.mirror
    }

    /// The counts of two pictures.
    #[cfg(feature = "program")]
    pub(crate) fn and(self, other: WrongPixels) -> WrongPixels {
        WrongPixels {
            solid: self.solid + other.solid,
            face: self.face + other.face,
            shadow: self.shadow + other.shadow,
            mirror: self.mirror + other.mirror,
        }
    }

    /// Counts a pixel, if `decision` is wrong.
    pub fn add(&mut self, decision: Decision, truth: Decision) {
        match WrongDecision::of(decision, truth) {
            Some(WrongDecision::Solid) => self.solid += 1,
            Some(WrongDecision::Face) => self.face += 1,
            Some(WrongDecision::Shadow) => self.shadow += 1,
            Some(WrongDecision::Mirror) => self.mirror += 1,
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: Seen = Seen {
        solid: 0,
        face: None,
        in_shadow: false,
    };
    const FACE: Seen = Seen {
        solid: 2,
        face: Some(1),
        in_shadow: false,
    };

    #[test]
    fn a_wrong_pixel_is_counted_by_the_first_thing_that_is_wrong() {
        use Decision::{Background, Mirrored, Quadrant, Solid, Surface, SurfaceInShadow};
        let dark = |seen| Seen {
            in_shadow: true,
            ..seen
        };
        let face = |face| Seen {
            face: Some(face),
            ..FACE
        };
        let kinds = [
            // Right: not counted.
            (Solid(FACE), Solid(FACE), [0, 0, 0, 0]),
            (Mirrored(SPHERE), Mirrored(SPHERE), [0, 0, 0, 0]),
            // Another thing, whatever else is wrong with it.
            (Background, Solid(SPHERE), [1, 0, 0, 0]),
            (Solid(dark(FACE)), Solid(SPHERE), [1, 0, 0, 0]),
            (Surface, Solid(SPHERE), [1, 0, 0, 0]),
            (Mirrored(SPHERE), Solid(SPHERE), [1, 0, 0, 0]),
            (Background, SurfaceInShadow, [1, 0, 0, 0]),
            (Quadrant(0), Quadrant(1), [1, 0, 0, 0]),
            // Another face, in shadow or not.
            (Solid(face(3)), Solid(FACE), [0, 1, 0, 0]),
            (Solid(dark(face(3))), Solid(FACE), [0, 1, 0, 0]),
            // Shadows, on solids and on the surface.
            (Solid(dark(FACE)), Solid(FACE), [0, 0, 1, 0]),
            (SurfaceInShadow, Surface, [0, 0, 1, 0]),
            (Mirrored(SPHERE), SurfaceInShadow, [0, 0, 1, 0]),
            // What the surface mirrors.
            (Surface, Mirrored(SPHERE), [0, 0, 0, 1]),
            (Mirrored(FACE), Mirrored(SPHERE), [0, 0, 0, 1]),
            (Mirrored(face(0)), Mirrored(FACE), [0, 0, 0, 1]),
            (Mirrored(dark(SPHERE)), Mirrored(SPHERE), [0, 0, 0, 1]),
        ];
        for (decision, truth, expected) in kinds {
            for (decision, truth) in [(decision, truth), (truth, decision)] {
                let mut wrong = WrongPixels::default();
                wrong.add(decision, truth);
                let WrongPixels {
                    solid,
                    face,
                    shadow,
                    mirror,
                } = wrong;
                assert_eq!(
                    [solid, face, shadow, mirror],
                    expected,
                    "{decision:?} for {truth:?}"
                );
                assert_eq!(wrong.total(), expected.iter().sum::<u64>());
            }
        }
    }
}
