//! From a key going down to what it asks for.

use winit::keyboard::{Key, KeyLocation, ModifiersState, PhysicalKey};

use super::action::{Action, Binding, Subject};

/// A key going down.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyPress<'a> {
    /// The key as the keyboard layout names it.
    pub(super) logical_key: &'a Key,
    /// The key by its place on the keyboard, whatever the layout.
    pub(super) physical_key: PhysicalKey,
    /// On which part of the keyboard the logical key lies.
    pub(super) location: KeyLocation,
    pub(super) modifiers: ModifiersState,
    /// It is held down.
    pub(super) repeat: bool,
}

impl KeyPress<'_> {
    /// The action it asks for in a window that shows `subject`, if any.
    ///
    /// The logical key decides where it is an ASCII letter, a digit or a key without a character:
    /// on-screen keyboards and programs that type report such keys with false physical keys.
    /// Otherwise the physical key comes first: the digit row of a French keyboard gives `&é"'(-è`,
    /// a keypad without NumLock gives arrows, and no binding has the letters of a Cyrillic
    /// keyboard.
    pub(super) fn action(&self, subject: Subject) -> Option<Action> {
        let others = ModifiersState::ALT | ModifiersState::SUPER;
        if self.modifiers.intersects(others) {
            return None;
        }
        let certain = match self.logical_key {
            Key::Character(text) => text.chars().all(|c| c.is_ascii_alphanumeric()),
            Key::Named(_) => self.location != KeyLocation::Numpad,
            Key::Unidentified(_) | Key::Dead(_) => false,
        };
        let by_logical_key = || self.find(subject, |binding| self.matches_logical_key(binding));
        let binding = if certain {
            by_logical_key()
        } else {
            self.find(subject, |binding| self.matches_physical_key(binding))
                .or_else(by_logical_key)
        };
        binding
            .filter(|binding| binding.repeats || !self.repeat)
            .map(|binding| binding.action)
    }

    fn find(
        &self,
        subject: Subject,
        matches: impl Fn(&Binding) -> bool,
    ) -> Option<&'static Binding> {
        let (shift, ctrl) = (self.modifiers.shift_key(), self.modifiers.control_key());
        subject
            .bindings()
            .filter(|binding| binding.ctrl == ctrl)
            .filter(|binding| binding.shift.is_none_or(|wanted| wanted == shift))
            .find(|binding| matches(binding))
    }

    fn matches_logical_key(&self, binding: &Binding) -> bool {
        match self.logical_key {
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

    fn matches_physical_key(&self, binding: &Binding) -> bool {
        matches!(self.physical_key, PhysicalKey::Code(code) if binding.physical_keys.contains(&code))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stage;
    use Action as A;
    use NamedKey as N;
    use winit::keyboard::{KeyCode as C, NamedKey, NativeKey};

    fn press(logical_key: Key, physical_key: C) -> Option<Action> {
        held(
            logical_key,
            physical_key,
            KeyLocation::Standard,
            ModifiersState::empty(),
        )
    }

    fn shifted(logical_key: &str, physical_key: C) -> Option<Action> {
        held(
            character(logical_key),
            physical_key,
            KeyLocation::Standard,
            ModifiersState::SHIFT,
        )
    }

    fn keypad(logical_key: Key, physical_key: C) -> Option<Action> {
        held(
            logical_key,
            physical_key,
            KeyLocation::Numpad,
            ModifiersState::empty(),
        )
    }

    fn held(
        logical_key: Key,
        physical_key: C,
        location: KeyLocation,
        modifiers: ModifiersState,
    ) -> Option<Action> {
        let physical_key = PhysicalKey::Code(physical_key);
        KeyPress {
            logical_key: &logical_key,
            physical_key,
            location,
            modifiers,
            repeat: false,
        }
        .action(Subject::Scene)
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
            assert_eq!(
                press(digit.clone(), C::Escape),
                chosen,
                "a false physical key"
            );
            assert_eq!(press(digit, C::Digit0), chosen, "a false physical key");
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
        assert_eq!(
            press(character("8"), C::Digit1),
            None,
            "a false physical key"
        );
    }

    #[test]
    fn letters_go_by_their_logical_key_and_only_foreign_ones_by_their_physical_key() {
        assert_eq!(press(character("q"), C::KeyA), Some(A::Leave));
        assert_eq!(press(character("a"), C::KeyQ), None);
        assert_eq!(
            press(character("q"), C::Digit1),
            Some(A::Leave),
            "a false physical key"
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
        for (text, physical_key, action) in [
            (".", C::Period, A::NextFrame),
            (",", C::Comma, A::PreviousFrame),
            ("=", C::Equal, A::Faster),
            ("-", C::Minus, A::Slower),
            ("0", C::Digit0, A::Zero),
        ] {
            assert_eq!(press(character(text), physical_key), Some(action));
        }
        assert_eq!(shifted("+", C::Equal), Some(A::Faster));
        assert_eq!(keypad(character("+"), C::NumpadAdd), Some(A::Faster));
        assert_eq!(keypad(character("-"), C::NumpadSubtract), Some(A::Slower));
        assert_eq!(press(Key::Named(N::Tab), C::Tab), None);
    }

    #[test]
    fn keys_of_the_desktop_are_not_ours() {
        let ctrl = |logical_key, physical_key| {
            let (location, ctrl) = (KeyLocation::Standard, ModifiersState::CONTROL);
            held(character(logical_key), physical_key, location, ctrl)
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
        let bindings = |subject: Subject| subject.bindings().map(move |binding| (subject, binding));
        let all = [Subject::Scene, Subject::Pictures]
            .into_iter()
            .flat_map(bindings);
        for (subject, binding) in all {
            let logical_key = match (binding.characters, binding.named) {
                ([first, ..], _) => character(&first.to_string()),
                (_, [first, ..]) => Key::Named(*first),
                _ => unreachable!("{} is on no key", binding.keys),
            };
            let press = |repeat| {
                let mut modifiers = ModifiersState::empty();
                modifiers.set(ModifiersState::SHIFT, binding.shift == Some(true));
                modifiers.set(ModifiersState::CONTROL, binding.ctrl);
                KeyPress {
                    logical_key: &logical_key,
                    physical_key: PhysicalKey::Code(C::F35),
                    location: KeyLocation::Standard,
                    modifiers,
                    repeat,
                }
                .action(subject)
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
}
