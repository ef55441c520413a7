//! What the keys do: one table for each thing that a window shows.

use winit::keyboard::{KeyCode, NamedKey};

use crate::Stage;

/// What a window shows, which decides what its keys do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Subject {
    /// A scene, traced.
    #[default]
    Scene,
    /// Two pictures and their difference.
    Pictures,
}

/// One of the pictures of [`Subject::Pictures`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Side {
    #[default]
    A,
    B,
    /// How far A is from B.
    Difference,
}

/// What a key asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Action {
    Stage(Stage),
    Show(Side),
    ShowNext,
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
    /// What they do, as a menu says it.
    label: &'static str,
    /// What the label leaves open, if anything.
    detail: &'static str,
    pub(super) action: Action,
    /// Its logical keys with a character, letters in lower case.
    pub(super) characters: &'static [char],
    /// Its logical keys without a character.
    pub(super) named: &'static [NamedKey],
    /// Its physical keys, whatever is printed on them.
    pub(super) physical_keys: &'static [KeyCode],
    /// Whether Shift must be down, must not be, or does not matter.
    pub(super) shift: Option<bool>,
    /// Whether Ctrl must be down; else it must not be.
    pub(super) ctrl: bool,
    /// Whether holding the key down repeats it.
    pub(super) repeats: bool,
}

impl Binding {
    const fn new(keys: &'static str, label: &'static str, action: Action) -> Binding {
        Binding {
            keys,
            label,
            detail: "",
            action,
            characters: &[],
            named: &[],
            physical_keys: &[],
            shift: None,
            ctrl: false,
            repeats: false,
        }
    }

    const fn stage(
        stage: Stage,
        keys: &'static str,
        characters: &'static [char],
        physical_keys: &'static [KeyCode],
    ) -> Binding {
        Binding {
            characters,
            physical_keys,
            ..Binding::new(keys, stage.title(), Action::Stage(stage))
        }
    }

    const fn save_png(detail: &'static str) -> Binding {
        Binding {
            characters: &['s'],
            physical_keys: &[C::KeyS],
            shift: Some(false),
            detail,
            ..Binding::new("S", "Save PNG", A::SavePng)
        }
    }

    const fn save_exr(detail: &'static str) -> Binding {
        Binding {
            characters: &['s'],
            physical_keys: &[C::KeyS],
            shift: Some(true),
            detail,
            ..Binding::new("Shift+S", "Save EXR", A::SaveExr)
        }
    }

    const fn show(
        side: Side,
        (keys, label): (&'static str, &'static str),
        characters: &'static [char],
        physical_keys: &'static [KeyCode],
    ) -> Binding {
        Binding {
            characters,
            physical_keys,
            ..Binding::new(keys, label, Action::Show(side))
        }
    }
}

use Action as A;
use KeyCode as C;
use NamedKey as N;

/// The actions of a window that shows pictures, and the keys they are on.
const OF_PICTURES: &[Binding] = &[
    Binding::show(
        Side::A,
        ("1", "Picture A"),
        &['1'],
        &[C::Digit1, C::Numpad1],
    ),
    Binding::show(
        Side::B,
        ("2", "Picture B"),
        &['2'],
        &[C::Digit2, C::Numpad2],
    ),
    Binding::show(
        Side::Difference,
        ("3", "Difference"),
        &['3'],
        &[C::Digit3, C::Numpad3],
    ),
    Binding {
        named: &[N::Tab],
        detail: "A, B, their difference in turn",
        ..Binding::new("Tab", "Next picture", A::ShowNext)
    },
    Binding::save_png("what is shown, in 8 bits"),
    Binding::save_exr("what is shown, every bit"),
];

/// The actions of a window that shows a scene, and the keys they are on.
const OF_SCENES: &[Binding] = &[
    Binding::stage(Stage::Image, "1", &['1'], &[C::Digit1, C::Numpad1]),
    Binding::stage(Stage::Spheres, "2", &['2'], &[C::Digit2, C::Numpad2]),
    Binding::stage(Stage::Tetrahedron, "3", &['3'], &[C::Digit3, C::Numpad3]),
    Binding::stage(Stage::Shading, "4", &['4'], &[C::Digit4, C::Numpad4]),
    Binding::stage(Stage::Shadow, "5", &['5'], &[C::Digit5, C::Numpad5]),
    Binding::stage(Stage::Reflection, "6", &['6'], &[C::Digit6, C::Numpad6]),
    Binding::stage(Stage::Animation, "7", &['7'], &[C::Digit7, C::Numpad7]),
    Binding {
        named: &[N::Space],
        ..Binding::new("Space", "Pause / Resume", A::Pause)
    },
    Binding {
        characters: &['.'],
        detail: "pauses at the next of 21 α",
        repeats: true,
        ..Binding::new(".", "Next frame", A::NextFrame)
    },
    Binding {
        characters: &[','],
        detail: "pauses at the one before",
        repeats: true,
        ..Binding::new(",", "Previous frame", A::PreviousFrame)
    },
    Binding {
        named: &[N::ArrowLeft],
        detail: "by 0.05 rad",
        repeats: true,
        ..Binding::new("←", "Turn left", A::TurnLeft)
    },
    Binding {
        named: &[N::ArrowRight],
        detail: "by 0.05 rad",
        repeats: true,
        ..Binding::new("→", "Turn right", A::TurnRight)
    },
    Binding {
        characters: &['+', '='],
        detail: "speed × 1.25",
        repeats: true,
        ..Binding::new("+", "Faster", A::Faster)
    },
    Binding {
        characters: &['-', '−'],
        detail: "speed ÷ 1.25",
        repeats: true,
        ..Binding::new("-", "Slower", A::Slower)
    },
    Binding {
        characters: &['0'],
        named: &[N::Home],
        physical_keys: &[C::Digit0, C::Numpad0],
        detail: "α = 0",
        ..Binding::new("0, Home", "Reset angle", A::Zero)
    },
    Binding::save_png("the picture as traced, in 8 bits"),
    Binding::save_exr("the picture as traced, every bit"),
    Binding {
        characters: &['e'],
        physical_keys: &[C::KeyE],
        detail: "the picture against the truth",
        ..Binding::new("E", "Show errors", A::Errors)
    },
    Binding {
        characters: &['k'],
        physical_keys: &[C::KeyK],
        detail: "and after them each program",
        ..Binding::new("K", "Next kernel", A::NextKernel)
    },
    Binding {
        characters: &['i'],
        physical_keys: &[C::KeyI],
        detail: "stage, kernel, α, times",
        ..Binding::new("I", "Information", A::Information)
    },
];

/// The actions of every window, and the keys they are on.
const OF_WINDOWS: &[Binding] = &[
    Binding {
        characters: &['c'],
        physical_keys: &[C::KeyC],
        ctrl: true,
        detail: "of the clicked pixel",
        ..Binding::new("Ctrl+C", "Copy pixel text", A::Copy)
    },
    Binding {
        characters: &['z'],
        physical_keys: &[C::KeyZ],
        detail: "after wheel and drag",
        ..Binding::new("Z", "Fit to window", A::Fit)
    },
    Binding {
        characters: &['f'],
        physical_keys: &[C::KeyF],
        ..Binding::new("F", "Full screen", A::FullScreen)
    },
    Binding {
        characters: &['m'],
        physical_keys: &[C::KeyM],
        detail: "also on the right button",
        ..Binding::new("M", "Menu", A::Menu)
    },
    Binding {
        characters: &['h'],
        named: &[N::F1],
        physical_keys: &[C::KeyH],
        ..Binding::new("H, F1", "Keys", A::Help)
    },
    Binding {
        characters: &['q'],
        named: &[N::Escape],
        physical_keys: &[C::KeyQ],
        detail: "Esc closes and leaves full screen first",
        ..Binding::new("Q, Esc", "Quit", A::Leave)
    },
];

impl Subject {
    /// Every action of a window that shows this, and the keys it is on.
    pub(super) fn bindings(self) -> impl Iterator<Item = &'static Binding> {
        let own = match self {
            Subject::Scene => OF_SCENES,
            Subject::Pictures => OF_PICTURES,
        };
        own.iter().chain(OF_WINDOWS)
    }

    /// The keys of a window that shows this and what they do, one a line.
    pub(super) fn key_table(self) -> String {
        self.bindings()
            .map(|binding| match binding.detail {
                "" => row(binding.keys, binding.label),
                detail => row(binding.keys, &format!("{}: {detail}", binding.label)),
            })
            .collect()
    }

    /// What the mouse does there, in lines as those of the keys.
    pub(super) fn mouse_table(self) -> String {
        let click = match self {
            Subject::Scene => "Explain the pixel",
            Subject::Pictures => "Keep the pixel's values",
        };
        let rows = MOUSE.iter().map(|(hand, does)| row(hand, does));
        row("click", click) + &rows.collect::<String>()
    }
}

/// What the mouse does but for a click, as the table of keys says what they do.
const MOUSE: [(&str, &str); 5] = [
    ("pointer", "Name the pixel"),
    ("wheel", "Zoom; scroll the panel"),
    ("drag", "Move the picture"),
    ("right", "Menu"),
    ("PgUp/Dn", "Scroll the panel"),
];

/// A row of the menu.
pub(super) struct MenuRow {
    pub(super) keys: &'static str,
    pub(super) label: &'static str,
    pub(super) action: Action,
    /// Rows of another kind come before it.
    pub(super) opens_group: bool,
}

/// Every action of a window that shows `subject`, as the menu shows it.
pub(super) fn rows(subject: Subject) -> impl Iterator<Item = MenuRow> {
    subject.bindings().map(move |binding| MenuRow {
        keys: binding.keys,
        label: binding.label,
        action: binding.action,
        opens_group: match binding.action {
            A::Pause | A::SavePng | A::Errors | A::Fit | A::Menu | A::Leave => true,
            A::Copy => subject == Subject::Pictures,
            _ => false,
        },
    })
}

/// The keys of the viewer and what they do, one a line.
///
/// ```
/// assert!(firsthit::viewer::key_table().contains("Space    Pause / Resume\n"));
/// ```
pub fn key_table() -> String {
    Subject::Scene.key_table()
}

/// The column of a table in which it says what a key does.
pub(super) const DOES: usize = 9;

fn row(keys: &str, does: &str) -> String {
    format!("{keys:DOES$}{does}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUBJECTS: [Subject; 2] = [Subject::Scene, Subject::Pictures];

    #[test]
    fn the_tables_show_every_key_once() {
        assert!(key_table().starts_with("1        Image\n"));
        for subject in SUBJECTS {
            let table = subject.key_table();
            assert_eq!(table.lines().count(), subject.bindings().count());
            let mut keys: Vec<_> = subject.bindings().map(|binding| binding.keys).collect();
            let count = keys.len();
            keys.sort_unstable();
            keys.dedup();
            assert_eq!(keys.len(), count);
            for line in (table + &subject.mouse_table()).lines() {
                let keys = line.split("  ").next().unwrap_or(line);
                assert!(keys.chars().count() + 2 <= DOES, "{keys}");
            }
        }
    }

    #[test]
    fn a_label_is_four_words_at_most() {
        for row in SUBJECTS.into_iter().flat_map(rows) {
            let words = row.label.split_whitespace().filter(|word| *word != "/");
            assert!(words.count() <= 4, "{}", row.label);
            assert!(row.label.chars().next().is_some_and(char::is_uppercase));
        }
    }
}
