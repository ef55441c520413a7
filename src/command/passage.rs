//! What traced pictures pass through before they are written.

use clap::ValueEnum;
use firsthit::Image;
use firsthit::screen::{Backend, Offscreen, ScreenError};

use super::waiting::Waiting;

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

/// The way that is taken, open for pictures of one size.
pub(crate) struct Passage {
    screen: Option<(Backend, Offscreen)>,
    /// The ways to go on with where this one fails; none if it was asked for.
    others: Vec<Backend>,
    /// Why those before it were not taken; `None` if it was asked for.
    reasons: Option<String>,
    size: u32,
}

impl Passage {
    /// The way that is asked for, else EGL, else OSMesa, else none.
    pub(crate) fn open(way: Option<Way>, size: u32) -> Result<Passage, ScreenError> {
        let mut passage = Passage {
            screen: None,
            others: Vec::new(),
            reasons: None,
            size,
        };
        match way {
            Some(Way::Egl) => passage.enter(Backend::Egl)?,
            Some(Way::Osmesa) => passage.enter(Backend::OsMesa)?,
            Some(Way::None) => {}
            None => {
                passage.others = vec![Backend::OsMesa, Backend::Egl];
                passage.reasons = Some(String::new());
                passage.enter_next();
            }
        }
        Ok(passage)
    }

    fn enter(&mut self, backend: Backend) -> Result<(), ScreenError> {
        let _waiting = Waiting::for_driver(self.size);
        self.screen = Some((backend, Offscreen::open(backend, self.size)?));
        Ok(())
    }

    /// Takes the next way that is open, or none.
    fn enter_next(&mut self) {
        while let Some(backend) = self.others.pop() {
            match self.enter(backend) {
                Ok(()) => return,
                Err(error) => self.leave(backend, &error),
            }
        }
    }

    /// Notes why a way is not taken.
    fn leave(&mut self, backend: Backend, error: &ScreenError) {
        let name = backend.name();
        let reasons = self.reasons.get_or_insert_default();
        reasons.push_str(&format!("; not through {name}: {error}"));
    }

    /// Sends a picture through. At the other end it is the same, bit for bit, or there is an error;
    /// where the way was not asked for, the next one is taken then.
    pub(crate) fn pass(&mut self, image: &Image) -> Result<(), ScreenError> {
        while let Some((backend, screen)) = &mut self.screen {
            let waiting = Waiting::for_driver(self.size);
            let passed = screen.show(image).and_then(|back| compare(image, &back));
            drop(waiting);
            match passed {
                Ok(()) => break,
                Err(error) if self.reasons.is_none() => return Err(error),
                Err(error) => {
                    let backend = *backend;
                    self.screen = None;
                    self.leave(backend, &error);
                    self.enter_next();
                }
            }
        }
        Ok(())
    }

    /// Which way was taken and why, unless it was asked for.
    pub(crate) fn note(&self) -> Option<String> {
        let reasons = self.reasons.as_ref()?;
        Some(match &self.screen {
            Some((backend, _)) => {
                let name = backend.name();
                format!("captured through {name}, the first that works here{reasons}")
            }
            None => {
                format!("captured through none, since nothing else works here{reasons}")
            }
        })
    }
}

/// By the contract of [`Offscreen::show`] both are the same; a driver may break it.
fn compare(drawn: &Image, back: &Image) -> Result<(), ScreenError> {
    let same = |(a, b): (&f32, &f32)| a.to_bits() == b.to_bits();
    let samples = drawn.samples().iter().zip(back.samples());
    let Some(sample) = samples.clone().position(|pair| !same(pair)) else {
        return Ok(());
    };
    let pixel = (sample / 3) as u32;
    let (column, row) = (pixel % drawn.size(), pixel / drawn.size());
    let [drawn, back] = [drawn, back].map(|image| image.pixel(column, row).unwrap_or_default());
    Err(ScreenError::Altered {
        column,
        row,
        drawn,
        back,
    })
}
