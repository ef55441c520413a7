//! What traced pictures pass through before they are written.

use std::borrow::Cow;

use clap::ValueEnum;
use firsthit::Image;
use firsthit::screen::{Offscreen, ScreenError, Through};

/// The values of `--through`.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Way {
    /// A texture and a quad in an offscreen OpenGL context of EGL
    Egl,
    /// The same in OSMesa
    Osmesa,
    /// Nothing: the traced picture itself
    None,
}

/// The way that was taken, open for pictures of one size.
pub(crate) struct Passage {
    screen: Option<Offscreen>,
    /// Which way was taken and why, unless it was asked for.
    pub(crate) note: Option<String>,
}

impl Passage {
    /// The way that is asked for, else EGL, else OSMesa, else none.
    pub(crate) fn open(way: Option<Way>, size: u32) -> Result<Passage, ScreenError> {
        let through = match way {
            Some(Way::Egl) => Through::Egl,
            Some(Way::Osmesa) => Through::OsMesa,
            Some(Way::None) => {
                return Ok(Passage {
                    screen: None,
                    note: None,
                });
            }
            None => return Ok(Passage::first_of([Through::Egl, Through::OsMesa], size)),
        };
        Ok(Passage {
            screen: Some(Offscreen::open(through, size)?),
            note: None,
        })
    }

    fn first_of(ways: [Through; 2], size: u32) -> Passage {
        let mut reasons = String::new();
        for through in ways {
            let name = through.name();
            match Offscreen::open(through, size) {
                Ok(screen) => {
                    return Passage {
                        screen: Some(screen),
                        note: Some(format!(
                            "captured through {name}, the first that works here{reasons}"
                        )),
                    };
                }
                Err(error) => reasons.push_str(&format!("; not through {name}: {error}")),
            }
        }
        Passage {
            screen: None,
            note: Some(format!(
                "captured through none, since nothing else works here{reasons}"
            )),
        }
    }

    /// The picture at the other end: the same, bit for bit.
    pub(crate) fn pass<'a>(&mut self, image: &'a Image) -> Result<Cow<'a, Image>, ScreenError> {
        match &mut self.screen {
            Some(screen) => screen.show(image).map(Cow::Owned),
            None => Ok(Cow::Borrowed(image)),
        }
    }
}
