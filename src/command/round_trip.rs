//! The round trip of a traced picture through OpenGL, before it is written.

use clap::ValueEnum;
use firsthit::Image;
use firsthit::screen::{Backend, Offscreen, ScreenError};

use super::watchdog::Watchdog;

/// The values of `--through`.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Through {
    /// A texture and a quad in an offscreen OpenGL context of EGL
    Egl,
    /// The same in OSMesa
    Osmesa,
    /// Nothing: the traced picture itself
    None,
}

/// The backend that is used, open for pictures of one size.
pub(crate) struct RoundTrip {
    screen: Option<(Backend, Offscreen)>,
    /// The backends to try where this one fails; none if it was asked for.
    others: Vec<Backend>,
    /// Why those before it are not used; `None` if it was asked for.
    reasons: Option<String>,
    size: u32,
}

impl RoundTrip {
    /// Through the backend that is asked for, else EGL, else OSMesa, else none.
    pub(crate) fn open(through: Option<Through>, size: u32) -> Result<RoundTrip, ScreenError> {
        let mut round_trip = RoundTrip {
            screen: None,
            others: Vec::new(),
            reasons: None,
            size,
        };
        match through {
            Some(Through::Egl) => round_trip.open_backend(Backend::Egl)?,
            Some(Through::Osmesa) => round_trip.open_backend(Backend::OsMesa)?,
            Some(Through::None) => {}
            None => {
                round_trip.others = vec![Backend::OsMesa, Backend::Egl];
                round_trip.reasons = Some(String::new());
                round_trip.open_next();
            }
        }
        Ok(round_trip)
    }

    fn open_backend(&mut self, backend: Backend) -> Result<(), ScreenError> {
        let _watchdog = Watchdog::for_driver(self.size, self.size);
        self.screen = Some((backend, Offscreen::open(backend, self.size)?));
        Ok(())
    }

    /// Opens the next backend that works, or none.
    fn open_next(&mut self) {
        while let Some(backend) = self.others.pop() {
            match self.open_backend(backend) {
                Ok(()) => return,
                Err(error) => self.reject(backend, &error),
            }
        }
    }

    /// Notes why a backend is not used.
    fn reject(&mut self, backend: Backend, error: &ScreenError) {
        let name = backend.name();
        let reasons = self.reasons.get_or_insert_default();
        reasons.push_str(&format!("; not through {name}: {error}"));
    }

    /// Draws a picture and reads it back. It comes back the same, bit for bit, or there is an
    /// error; where the backend was not asked for, the next one is tried then.
    pub(crate) fn send(&mut self, image: &Image) -> Result<(), ScreenError> {
        while let Some((backend, screen)) = &mut self.screen {
            let watchdog = Watchdog::for_driver(self.size, self.size);
            let sent = screen.show(image).and_then(|back| compare(image, &back));
            drop(watchdog);
            match sent {
                Ok(()) => break,
                Err(error) if self.reasons.is_none() => return Err(error),
                Err(error) => {
                    let backend = *backend;
                    self.screen = None;
                    self.reject(backend, &error);
                    self.open_next();
                }
            }
        }
        Ok(())
    }

    /// Which backend was used and why, unless it was asked for.
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
