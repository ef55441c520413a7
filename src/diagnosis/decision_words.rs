//! Decisions in words.

use super::WrongDecision;
use crate::scene::Scene;
use crate::stage::Stage;
use crate::tracer::{Decision, Seen, name};

/// The words for the decisions of a scene in a stage.
#[derive(Clone, Copy)]
pub(super) struct DecisionWords<'s> {
    pub(super) scene: &'s Scene,
    pub(super) stage: Stage,
}

impl DecisionWords<'_> {
    /// What a pixel shows in place of the truth, as a sentence without its subject.
    pub(super) fn shown(self, decision: Decision, truth: Decision) -> String {
        format!(
            "{}, where {}",
            self.predicate(decision, truth),
            self.clause(decision, truth)
        )
    }

    /// Some decisions, one by one.
    pub(super) fn list(self, decisions: &[Decision]) -> String {
        /// A reader looks at no more.
        const MAX_NOUNS: usize = 4;
        let mut nouns: Vec<String> = decisions.iter().map(|one| self.noun(*one)).collect();
        if nouns.len() > MAX_NOUNS {
            let more = nouns.split_off(MAX_NOUNS).len();
            nouns.push(format!("{more} more"));
        }
        match nouns.pop() {
            Some(last) if nouns.is_empty() => last,
            Some(last) => format!("{} and {last}", nouns.join(", ")),
            None => String::new(),
        }
    }

    /// What is shown.
    fn predicate(self, decision: Decision, truth: Decision) -> String {
        let noun = self.noun(decision);
        match (decision, truth) {
            (Decision::Mirrored(seen), Decision::Mirrored(truth))
                if (seen.solid, seen.face) == (truth.solid, truth.face) =>
            {
                format!("mirrors {}{}", self.solid(seen), light(seen))
            }
            (Decision::Mirrored(seen), _) => {
                format!("mirrors {}{}", self.solid(seen), shadow(seen))
            }
            (Decision::Solid(seen), Decision::Solid(_)) if is_shadow(decision, truth) => {
                format!("shows {}{}", self.solid(seen), light(seen))
            }
            (Decision::Surface, Decision::SurfaceInShadow) => format!("shows {noun} lit"),
            (Decision::Surface, Decision::Mirrored(_)) => format!("shows {noun} plain"),
            _ => format!("shows {noun}"),
        }
    }

    /// What is true in place of what is shown.
    fn clause(self, decision: Decision, truth: Decision) -> String {
        use Decision::{Mirrored, Solid, Surface, SurfaceInShadow};
        match (decision, truth) {
            (Solid(_), Solid(truth)) if is_shadow(decision, Solid(truth)) => {
                format!("it is{}", light(truth))
            }
            (Solid(seen), Solid(truth)) if seen.solid == truth.solid => match truth.face {
                Some(face) => format!("face {face} is seen"),
                None => format!("{} is seen", self.solid(truth)),
            },
            (SurfaceInShadow, Surface) => "it is lit".to_owned(),
            (Surface, SurfaceInShadow) => "it is in shadow".to_owned(),
            (Mirrored(_), SurfaceInShadow) => "the surface is in shadow".to_owned(),
            (Mirrored(_), Surface) => "nothing is mirrored".to_owned(),
            (Surface | SurfaceInShadow, Mirrored(truth)) => {
                format!("it mirrors {}", self.solid(truth))
            }
            (Mirrored(seen), Mirrored(truth)) if seen.solid == truth.solid => {
                let face = truth.face.filter(|_| seen.face != truth.face);
                match face {
                    Some(face) => format!("face {face} is mirrored"),
                    None => format!("it is mirrored{}", light(truth)),
                }
            }
            (Mirrored(_), Mirrored(truth)) => format!("{} is mirrored", self.solid(truth)),
            (_, Mirrored(truth)) => format!("the surface mirrors {}", self.solid(truth)),
            (_, Surface | SurfaceInShadow) => "the surface is seen".to_owned(),
            (_, Solid(truth)) => format!("{} is seen", self.solid(truth)),
            _ => format!("{} is seen", self.noun(truth)),
        }
    }

    /// A decision as a thing that is seen.
    fn noun(self, decision: Decision) -> String {
        match decision {
            Decision::Background => "the background".to_owned(),
            Decision::Quadrant(number) => format!("quadrant {number}"),
            Decision::Surface => "the surface".to_owned(),
            Decision::SurfaceInShadow => "the surface in shadow".to_owned(),
            Decision::Solid(seen) => format!("{}{}", self.solid(seen), shadow(seen)),
            Decision::Mirrored(seen) => {
                format!("{}{}, mirrored", self.solid(seen), shadow(seen))
            }
        }
    }

    /// A solid, with the face where the colour tells it.
    fn solid(self, seen: Seen) -> String {
        let solid = name(self.scene, usize::from(seen.solid), None);
        match seen.face {
            Some(face) if !seen.in_shadow && self.stage != Stage::Tetrahedron => {
                format!("face {face} of {solid}")
            }
            _ => solid,
        }
    }
}

fn shadow(seen: Seen) -> &'static str {
    if seen.in_shadow { " in shadow" } else { "" }
}

fn light(seen: Seen) -> &'static str {
    if seen.in_shadow { " in shadow" } else { " lit" }
}

fn is_shadow(decision: Decision, truth: Decision) -> bool {
    WrongDecision::of(decision, truth) == Some(WrongDecision::Shadow)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_decision_is_a_sentence_about_what_is_shown_and_what_is_true() {
        use Decision::{Background, Mirrored, Quadrant, Solid, Surface, SurfaceInShadow};
        let scene = Scene::builtin();
        let words = DecisionWords {
            scene: &scene,
            stage: Stage::Reflection,
        };
        let sphere = |solid| Seen {
            solid,
            face: None,
            in_shadow: false,
        };
        let face = |face| Seen {
            face: Some(face),
            ..sphere(2)
        };
        let dark = |seen| Seen {
            in_shadow: true,
            ..seen
        };
        let (one, two) = (sphere(0), sphere(1));
        for (shown, truth, expected) in [
            (
                SurfaceInShadow,
                Surface,
                "shows the surface in shadow, where it is lit",
            ),
            (
                Surface,
                SurfaceInShadow,
                "shows the surface lit, where it is in shadow",
            ),
            (
                SurfaceInShadow,
                Mirrored(one),
                "shows the surface in shadow, where it mirrors sphere 1",
            ),
            (
                Mirrored(dark(one)),
                SurfaceInShadow,
                "mirrors sphere 1 in shadow, where the surface is in shadow",
            ),
            (
                Surface,
                Mirrored(face(3)),
                "shows the surface plain, where it mirrors face 3 of tetrahedron 1",
            ),
            (
                Mirrored(one),
                Surface,
                "mirrors sphere 1, where nothing is mirrored",
            ),
            (
                Mirrored(one),
                Mirrored(two),
                "mirrors sphere 1, where sphere 2 is mirrored",
            ),
            (
                Mirrored(dark(one)),
                Mirrored(one),
                "mirrors sphere 1 in shadow, where it is mirrored lit",
            ),
            (
                Mirrored(one),
                Mirrored(dark(one)),
                "mirrors sphere 1 lit, where it is mirrored in shadow",
            ),
            (
                Mirrored(face(1)),
                Mirrored(face(2)),
                "mirrors face 1 of tetrahedron 1, where face 2 is mirrored",
            ),
            (
                Solid(dark(one)),
                Solid(one),
                "shows sphere 1 in shadow, where it is lit",
            ),
            (
                Solid(face(1)),
                Solid(dark(face(1))),
                "shows face 1 of tetrahedron 1 lit, where it is in shadow",
            ),
            (
                Solid(face(2)),
                Solid(face(1)),
                "shows face 2 of tetrahedron 1, where face 1 is seen",
            ),
            (
                Solid(dark(two)),
                Solid(face(1)),
                "shows sphere 2 in shadow, where face 1 of tetrahedron 1 is seen",
            ),
            (
                Background,
                Solid(two),
                "shows the background, where sphere 2 is seen",
            ),
            (
                Solid(one),
                Mirrored(one),
                "shows sphere 1, where the surface mirrors sphere 1",
            ),
            (
                Solid(one),
                Background,
                "shows sphere 1, where the background is seen",
            ),
            (
                Surface,
                Background,
                "shows the surface, where the background is seen",
            ),
            (
                Background,
                SurfaceInShadow,
                "shows the background, where the surface is seen",
            ),
            (
                Quadrant(1),
                Quadrant(3),
                "shows quadrant 1, where quadrant 3 is seen",
            ),
        ] {
            assert_eq!(words.shown(shown, truth), expected);
        }
        let flat = DecisionWords {
            stage: Stage::Tetrahedron,
            ..words
        };
        assert_eq!(
            flat.shown(Solid(face(0)), Background),
            "shows tetrahedron 1, where the background is seen"
        );
        assert_eq!(
            words.list(&[SurfaceInShadow, Mirrored(dark(one))]),
            "the surface in shadow and sphere 1 in shadow, mirrored"
        );
        let many = [Background, Surface, Solid(one), Solid(two)].repeat(2);
        assert_eq!(
            words.list(&many),
            "the background, the surface, sphere 1, sphere 2 and 4 more"
        );
    }
}
