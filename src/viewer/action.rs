//! What the keys do: one table.

use winit::keyboard::{KeyCode, NamedKey};

use crate::Stage;

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    Stage(Stage),
    Pause,
    NextFrame,
    PreviousFrame,
    TurnLeft,
    TurnRight,
    Faster,
    Slower,
    Zero,
    SavePng,
    SaveExr,
    Errors,
    NextKernel,
    Information,
    Copy,
    Fit,
    FullScreen,
    Menu,
    Help,
    Leave,
}

/// A row of the table.
pub(super) struct Binding {
    /// The keys, as they are shown to a person.
    pub(super) keys: &'static str,
    /// What they do, as it is shown to a person.
    does: &'static str,
    pub(super) action: Action,
    /// The characters that mean it, letters in lower case.
    pub(super) characters: &'static [char],
    /// The keys without a character that mean it.
    pub(super) named: &'static [NamedKey],
    /// The places on the keyboard that stand for it, whatever is printed there.
    pub(super) places: &'static [KeyCode],
    /// Whether Shift must be down, must not be, or does not matter.
    pub(super) shift: Option<bool>,
    /// Whether Ctrl must be down; else it must not be.
    pub(super) ctrl: bool,
    /// Whether holding the key down repeats it.
    pub(super) repeats: bool,
}

impl Binding {
    const fn new(keys: &'static str, does: &'static str, action: Action) -> Binding {
        Binding {
            keys,
            does,
            action,
            characters: &[],
            named: &[],
            places: &[],
            shift: None,
            ctrl: false,
            repeats: false,
        }
    }

    const fn stage(
        stage: Stage,
        keys: &'static str,
        characters: &'static [char],
        places: &'static [KeyCode],
    ) -> Binding {
        Binding {
            characters,
            places,
            ..Binding::new(keys, stage.title(), Action::Stage(stage))
        }
    }
}

use Action as A;
use KeyCode as C;
use NamedKey as N;

/// Every action of the viewer and the keys it is on.
pub(super) const BINDINGS: &[Binding] = &[
    Binding::stage(Stage::Image, "1", &['1'], &[C::Digit1, C::Numpad1]),
    Binding::stage(Stage::Spheres, "2", &['2'], &[C::Digit2, C::Numpad2]),
    Binding::stage(Stage::Tetrahedron, "3", &['3'], &[C::Digit3, C::Numpad3]),
    Binding::stage(Stage::Shading, "4", &['4'], &[C::Digit4, C::Numpad4]),
    Binding::stage(Stage::Shadow, "5", &['5'], &[C::Digit5, C::Numpad5]),
    Binding::stage(Stage::Reflection, "6", &['6'], &[C::Digit6, C::Numpad6]),
    Binding::stage(Stage::Animation, "7", &['7'], &[C::Digit7, C::Numpad7]),
    Binding {
        named: &[N::Space],
        ..Binding::new("Space", "pause or resume the animation", A::Pause)
    },
    Binding {
        characters: &['.'],
        repeats: true,
        ..Binding::new(
            ".",
            "pause, and on to the next α of the 21 frames",
            A::NextFrame,
        )
    },
    Binding {
        characters: &[','],
        repeats: true,
        ..Binding::new(
            ",",
            "pause, and back to the previous α of the 21 frames",
            A::PreviousFrame,
        )
    },
    Binding {
        named: &[N::ArrowLeft],
        repeats: true,
        ..Binding::new("←", "turn by −0.05 rad", A::TurnLeft)
    },
    Binding {
        named: &[N::ArrowRight],
        repeats: true,
        ..Binding::new("→", "turn by 0.05 rad", A::TurnRight)
    },
    Binding {
        characters: &['+', '='],
        repeats: true,
        ..Binding::new("+", "play 1.25 times faster", A::Faster)
    },
    Binding {
        characters: &['-', '−'],
        repeats: true,
        ..Binding::new("-", "play 1.25 times slower", A::Slower)
    },
    Binding {
        characters: &['0'],
        named: &[N::Home],
        places: &[C::Digit0, C::Numpad0],
        ..Binding::new("0, Home", "α = 0", A::Zero)
    },
    Binding {
        characters: &['s'],
        places: &[C::KeyS],
        shift: Some(false),
        ..Binding::new("S", "save the traced picture as a PNG", A::SavePng)
    },
    Binding {
        characters: &['s'],
        places: &[C::KeyS],
        shift: Some(true),
        ..Binding::new("Shift+S", "save the traced picture as an EXR", A::SaveExr)
    },
    Binding {
        characters: &['e'],
        places: &[C::KeyE],
        ..Binding::new(
            "E",
            "how far this kernel is from reference, and back",
            A::Errors,
        )
    },
    Binding {
        characters: &['k'],
        places: &[C::KeyK],
        ..Binding::new("K", "the next kernel", A::NextKernel)
    },
    Binding {
        characters: &['i'],
        places: &[C::KeyI],
        ..Binding::new(
            "I",
            "information, and the pixel under the pointer",
            A::Information,
        )
    },
    Binding {
        characters: &['c'],
        places: &[C::KeyC],
        ctrl: true,
        ..Binding::new("Ctrl+C", "copy the text of the clicked pixel", A::Copy)
    },
    Binding {
        characters: &['z'],
        places: &[C::KeyZ],
        ..Binding::new("Z", "the whole picture again, after wheel and drag", A::Fit)
    },
    Binding {
        characters: &['f'],
        places: &[C::KeyF],
        ..Binding::new("F", "full screen, and back", A::FullScreen)
    },
    Binding {
        characters: &['m'],
        places: &[C::KeyM],
        ..Binding::new("M", "the menu, also on the right button", A::Menu)
    },
    Binding {
        characters: &['h'],
        named: &[N::F1],
        places: &[C::KeyH],
        ..Binding::new("H, F1", "the keys", A::Help)
    },
    Binding {
        characters: &['q'],
        named: &[N::Escape],
        places: &[C::KeyQ],
        ..Binding::new("Q, Esc", "leave; Esc first closes what is open", A::Leave)
    },
];

/// A row of the menu.
pub(super) struct Row {
    pub(super) keys: &'static str,
    pub(super) does: &'static str,
    pub(super) action: Action,
    /// Rows of another kind come before it.
    pub(super) opens_group: bool,
}

/// Every action, as the menu shows it.
pub(super) fn rows() -> impl Iterator<Item = Row> {
    BINDINGS.iter().map(|binding| Row {
        keys: binding.keys,
        does: binding.does,
        action: binding.action,
        opens_group: matches!(
            binding.action,
            A::Pause | A::SavePng | A::Errors | A::Fit | A::Menu | A::Leave
        ),
    })
}

/// The keys of the viewer and what they do, one a line.
///
/// ```
/// assert!(firsthit::viewer::key_table().contains("Space    pause or resume the animation\n"));
/// ```
pub fn key_table() -> String {
    let width = BINDINGS
        .iter()
        .map(|binding| binding.keys.chars().count())
        .max()
        .unwrap_or(0);
    BINDINGS
        .iter()
        .map(|binding| format!("{:width$}  {}\n", binding.keys, binding.does))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_shows_every_key_once() {
        let table = key_table();
        assert_eq!(table.lines().count(), BINDINGS.len());
        assert!(table.starts_with("1        Image\n"));
        let mut keys: Vec<_> = BINDINGS.iter().map(|binding| binding.keys).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), BINDINGS.len());
    }
}
