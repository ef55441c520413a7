//! What the keys do: one table.

use winit::keyboard::{Key, KeyCode, KeyLocation, ModifiersState, NamedKey, PhysicalKey};

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
struct Binding {
    /// The keys, as they are shown to a person.
    keys: &'static str,
    /// What they do, as it is shown to a person.
    does: &'static str,
    action: Action,
    /// The characters that mean it, letters in lower case.
    characters: &'static [char],
    /// The keys without a character that mean it.
    named: &'static [NamedKey],
    /// The places on the keyboard that stand for it, whatever is printed there.
    places: &'static [KeyCode],
    /// Whether Shift must be down, must not be, or does not matter.
    shift: Option<bool>,
    /// Whether Ctrl must be down; else it must not be.
    ctrl: bool,
    /// Whether holding the key down repeats it.
    repeats: bool,
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
const BINDINGS: &[Binding] = &[
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

/// A key going down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Press<'a> {
    /// What the key means in the person's layout.
    pub(super) meaning: &'a Key,
    /// Where it lies on the keyboard.
    pub(super) place: PhysicalKey,
    /// On which part of the keyboard its meaning lies.
    pub(super) location: KeyLocation,
    pub(super) modifiers: ModifiersState,
    /// It is held down.
    pub(super) repeat: bool,
}

impl Press<'_> {
    /// The action it asks for, if any.
    ///
    /// What a key means decides where it means a letter, a digit or a key of its own: on-screen keyboards and programs that type
    /// report such keys at false places. Otherwise its place comes first: the digit row of a French keyboard means `&é"'(-è`, a
    /// keypad without NumLock means arrows, and the letters of a Cyrillic keyboard are none of ours.
    pub(super) fn action(&self) -> Option<Action> {
        let others = ModifiersState::ALT | ModifiersState::SUPER;
        if self.modifiers.intersects(others) {
            return None;
        }
        let certain = match self.meaning {
            Key::Character(text) => text.chars().all(|c| c.is_ascii_alphanumeric()),
            Key::Named(_) => self.location != KeyLocation::Numpad,
            Key::Unidentified(_) | Key::Dead(_) => false,
        };
        let by_meaning = || self.find(|binding| self.means(binding));
        let binding = if certain {
            by_meaning()
        } else {
            self.find(|binding| self.lies(binding)).or_else(by_meaning)
        };
        binding
            .filter(|binding| binding.repeats || !self.repeat)
            .map(|binding| binding.action)
    }

    fn find(&self, matches: impl Fn(&Binding) -> bool) -> Option<&'static Binding> {
        let (shift, ctrl) = (self.modifiers.shift_key(), self.modifiers.control_key());
        BINDINGS
            .iter()
            .filter(|binding| binding.ctrl == ctrl)
            .filter(|binding| binding.shift.is_none_or(|wanted| wanted == shift))
            .find(|binding| matches(binding))
    }

    fn means(&self, binding: &Binding) -> bool {
        match self.meaning {
            Key::Character(text) => {
                let mut characters = text.chars();
                let first = characters.next().map(|c| c.to_ascii_lowercase());
                characters.next().is_none()
                    && first.is_some_and(|c| binding.characters.contains(&c))
            }
            Key::Named(named) => binding.named.contains(named),
            Key::Unidentified(_) | Key::Dead(_) => false,
        }
    }

    fn lies(&self, binding: &Binding) -> bool {
        matches!(self.place, PhysicalKey::Code(code) if binding.places.contains(&code))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::keyboard::NativeKey;

    fn press(meaning: Key, place: C) -> Option<Action> {
        held(
            meaning,
            place,
            KeyLocation::Standard,
            ModifiersState::empty(),
        )
    }

    fn shifted(meaning: &str, place: C) -> Option<Action> {
        held(
            character(meaning),
            place,
            KeyLocation::Standard,
            ModifiersState::SHIFT,
        )
    }

    fn keypad(meaning: Key, place: C) -> Option<Action> {
        held(meaning, place, KeyLocation::Numpad, ModifiersState::empty())
    }

    fn held(
        meaning: Key,
        place: C,
        location: KeyLocation,
        modifiers: ModifiersState,
    ) -> Option<Action> {
        let place = PhysicalKey::Code(place);
        Press {
            meaning: &meaning,
            place,
            location,
            modifiers,
            repeat: false,
        }
        .action()
    }

    fn character(text: &str) -> Key {
        Key::Character(text.into())
    }

    const ROW: [C; 7] = [
        C::Digit1,
        C::Digit2,
        C::Digit3,
        C::Digit4,
        C::Digit5,
        C::Digit6,
        C::Digit7,
    ];
    const PAD: [C; 7] = [
        C::Numpad1,
        C::Numpad2,
        C::Numpad3,
        C::Numpad4,
        C::Numpad5,
        C::Numpad6,
        C::Numpad7,
    ];

    #[test]
    fn digits_choose_the_stage_on_every_keyboard() {
        let french = ["&", "é", "\"", "'", "(", "-", "è"];
        let czech = ["+", "ě", "š", "č", "ř", "ž", "ý"];
        let unlocked = [
            N::End,
            N::ArrowDown,
            N::PageDown,
            N::ArrowLeft,
            N::Clear,
            N::ArrowRight,
            N::Home,
        ];
        for (i, stage) in Stage::ALL.into_iter().enumerate() {
            let chosen = Some(A::Stage(stage));
            let digit = character(&stage.number().to_string());
            assert_eq!(press(digit.clone(), ROW[i]), chosen);
            assert_eq!(keypad(digit.clone(), PAD[i]), chosen);
            assert_eq!(press(digit.clone(), C::Escape), chosen, "a false place");
            assert_eq!(press(digit, C::Digit0), chosen, "a false place");
            assert_eq!(press(character(french[i]), ROW[i]), chosen);
            assert_eq!(press(character(czech[i]), ROW[i]), chosen);
            assert_eq!(keypad(Key::Named(unlocked[i]), PAD[i]), chosen);
            assert_eq!(
                press(Key::Unidentified(NativeKey::Unidentified), ROW[i]),
                chosen
            );
            assert_eq!(shifted(&stage.number().to_string(), ROW[i]), chosen);
        }
        assert_eq!(press(character("à"), C::Digit0), Some(A::Zero));
        assert_eq!(keypad(Key::Named(N::Insert), C::Numpad0), Some(A::Zero));
        assert_eq!(press(character("8"), C::Digit1), None, "a false place");
    }

    #[test]
    fn letters_go_by_their_meaning_and_only_foreign_ones_by_their_place() {
        assert_eq!(press(character("q"), C::KeyA), Some(A::Leave));
        assert_eq!(press(character("a"), C::KeyQ), None);
        assert_eq!(
            press(character("q"), C::Digit1),
            Some(A::Leave),
            "a false place"
        );
        assert_eq!(press(character("й"), C::KeyQ), Some(A::Leave));
        assert_eq!(press(character("ы"), C::KeyS), Some(A::SavePng));
        assert_eq!(shifted("Ы", C::KeyS), Some(A::SaveExr));
        assert_eq!(press(character("s"), C::KeyS), Some(A::SavePng));
        assert_eq!(
            press(character("S"), C::KeyS),
            Some(A::SavePng),
            "Caps Lock"
        );
        assert_eq!(shifted("S", C::KeyS), Some(A::SaveExr));
        assert_eq!(press(character("f"), C::KeyF), Some(A::FullScreen));
        assert_eq!(press(character("x"), C::KeyX), None);
    }

    #[test]
    fn the_other_keys_do_what_is_written_beside_them() {
        for (named, action) in [
            (N::Space, A::Pause),
            (N::ArrowLeft, A::TurnLeft),
            (N::ArrowRight, A::TurnRight),
            (N::Home, A::Zero),
            (N::Escape, A::Leave),
        ] {
            assert_eq!(press(Key::Named(named), C::Digit3), Some(action));
        }
        for (text, place, action) in [
            (".", C::Period, A::NextFrame),
            (",", C::Comma, A::PreviousFrame),
            ("=", C::Equal, A::Faster),
            ("-", C::Minus, A::Slower),
            ("0", C::Digit0, A::Zero),
        ] {
            assert_eq!(press(character(text), place), Some(action));
        }
        assert_eq!(shifted("+", C::Equal), Some(A::Faster));
        assert_eq!(keypad(character("+"), C::NumpadAdd), Some(A::Faster));
        assert_eq!(keypad(character("-"), C::NumpadSubtract), Some(A::Slower));
        assert_eq!(press(Key::Named(N::Tab), C::Tab), None);
    }

    #[test]
    fn keys_of_the_desktop_are_not_ours() {
        let ctrl = |meaning, place| {
            let (location, ctrl) = (KeyLocation::Standard, ModifiersState::CONTROL);
            held(character(meaning), place, location, ctrl)
        };
        assert_eq!(ctrl("c", C::KeyC), Some(A::Copy));
        assert_eq!(ctrl("с", C::KeyC), Some(A::Copy), "a Cyrillic keyboard");
        assert_eq!(ctrl("s", C::KeyS), None);
        assert_eq!(press(character("c"), C::KeyC), None);
        for other in [
            ModifiersState::CONTROL,
            ModifiersState::ALT,
            ModifiersState::SUPER,
        ] {
            assert_eq!(
                held(character("q"), C::KeyQ, KeyLocation::Standard, other),
                None
            );
        }
    }

    #[test]
    fn holding_a_key_repeats_only_what_moves() {
        for binding in BINDINGS {
            let meaning = match (binding.characters, binding.named) {
                ([first, ..], _) => character(&first.to_string()),
                (_, [first, ..]) => Key::Named(*first),
                _ => unreachable!("{} is on no key", binding.keys),
            };
            let press = |repeat| {
                let mut modifiers = ModifiersState::empty();
                modifiers.set(ModifiersState::SHIFT, binding.shift == Some(true));
                modifiers.set(ModifiersState::CONTROL, binding.ctrl);
                Press {
                    meaning: &meaning,
                    place: PhysicalKey::Code(C::F35),
                    location: KeyLocation::Standard,
                    modifiers,
                    repeat,
                }
                .action()
            };
            assert_eq!(press(false), Some(binding.action));
            let moves = matches!(
                binding.action,
                A::NextFrame
                    | A::PreviousFrame
                    | A::TurnLeft
                    | A::TurnRight
                    | A::Faster
                    | A::Slower
            );
            assert_eq!(press(true), moves.then_some(binding.action));
        }
    }

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
