//! Two pictures and their difference in a window, one at a time.

mod pair;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use glam::UVec2;
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::WindowId;

use crate::image::{Format, SaveError};
use crate::screen::driver_limits;

use super::action::{Action, Side, Subject};
use super::desktop::event_loop;
use super::hud::{HudValues, Part, VALUES};
use super::ui::{POLL, Ui, Wish};
use super::window::Opening;
use super::worker::Worker;
use super::{Event, ViewerError, snapshot};
use pair::Pair;
pub use pair::Picture;

/// Pictures of fewer pixels are magnified, in a window of up to about so many logical pixels.
const MAGNIFIED: u32 = 512;

/// Opens a window and stays until it is left.
pub(super) fn compare(
    pictures: [Picture; 2],
    report: &mut dyn FnMut(Event),
) -> Result<(), ViewerError> {
    let started = Instant::now();
    let event_loop = event_loop()?;
    let pair = Arc::new(Pair::new(pictures)?);
    let UVec2 { x, y } = pair.size();
    driver_limits::check(u64::from(x) * u64::from(y))?;
    let proxy = event_loop.create_proxy();
    let wake = move || {
        // Without an event loop nobody waits.
        let _ = proxy.send_event(());
    };
    let theirs = pair.clone();
    let saving = Worker::start("saving", wake, move |task, reply| {
        if let Some((side, format)) = task {
            reply(snapshot::save(theirs.image(side), "compare", format));
        }
    });
    let mut pictures = Pictures {
        started,
        pair,
        saving: saving.map_err(ViewerError::Thread)?,
        shown: Side::A,
        uploaded: None,
        ui: Ui::new(Subject::Pictures),
        report,
        failure: None,
    };
    let ended = event_loop.run_app(&mut pictures);
    for saved in pictures.saving.finish() {
        (pictures.report)(saved.map_or_else(Event::NotSaved, Event::Saved));
    }
    if let Some(failure) = pictures.failure {
        return Err(failure);
    }
    ended.map_err(|_| ViewerError::Lost)?;
    (pictures.report)(Event::Left(pictures.ui.counts));
    Ok(())
}

struct Pictures<'a> {
    started: Instant,
    pair: Arc<Pair>,
    /// Writes the picture to a new file.
    saving: Worker<(Side, Format), Result<PathBuf, SaveError>>,
    shown: Side,
    /// What the texture holds.
    uploaded: Option<Side>,
    ui: Ui,
    report: &'a mut dyn FnMut(Event),
    failure: Option<ViewerError>,
}

impl ApplicationHandler for Pictures<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.ui.gl_window.is_none() {
            let opened = self.open(event_loop);
            self.check(event_loop, opened);
        }
    }

    fn suspended(&mut self, _event_loop: &ActiveEventLoop) {
        self.ui.close();
    }

    fn exiting(&mut self, _event_loop: &ActiveEventLoop) {
        self.ui.close();
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause {
            event_loop.set_control_flow(ControlFlow::Wait);
            self.ui.ask_for_redraw();
        }
    }

    fn user_event(&mut self, _event_loop: &ActiveEventLoop, (): ()) {
        while let Some(saved) = self.saving.reply() {
            let event = saved.map_or_else(Event::NotSaved, Event::Saved);
            self.ui.hud.say(event.to_string());
            (self.report)(event);
            self.ui.touch();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match self.ui.window_event(event_loop, event) {
            Some(Wish::Redraw) => {
                let drawn = self.redraw(event_loop);
                self.check(event_loop, drawn);
            }
            Some(Wish::Act(Action::Show(side))) => self.show(side),
            Some(Wish::Act(Action::ShowNext)) => self.show(self.shown.next()),
            Some(Wish::Act(Action::SavePng)) => self.saving.enqueue((self.shown, Format::Png)),
            Some(Wish::Act(Action::SaveExr)) => self.saving.enqueue((self.shown, Format::Exr)),
            Some(Wish::Explain(pixel)) => self.explain(pixel),
            // This window has no key for any other action.
            Some(Wish::Act(_)) | None => {}
        }
    }
}

impl Pictures<'_> {
    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let picture = self.pair.size();
        let opening = Opening {
            picture,
            magnification: (MAGNIFIED / picture.max_element()).max(1),
            panel: true,
        };
        self.ui.open(event_loop, opening)?;
        (self.report)(Event::Opened);
        self.uploaded = None;
        self.retitle();
        Ok(())
    }

    fn show(&mut self, side: Side) {
        self.shown = side;
        self.retitle();
        self.ui.touch();
    }

    fn retitle(&self) {
        if let Some(gl_window) = &self.ui.gl_window {
            let title = format!("firsthit — {}", self.pair.title(self.shown));
            gl_window.window().set_title(&title);
        }
    }

    /// Keeps what there is to say about a pixel, column and row.
    fn explain(&mut self, pixel: UVec2) {
        let text = self.pair.pixel(Some(pixel));
        self.ui.hud.inspect(pixel, text.clone());
        (self.report)(Event::Inspected(text));
        self.ui.touch();
    }

    /// Draws the picture, and what there is to say beside it.
    fn redraw(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let now = Instant::now();
        event_loop.set_control_flow(ControlFlow::Wait);
        if !self.ui.visible() {
            return Ok(());
        }
        self.upload()?;
        let change = self.ui.hud.expire(now);
        let values = self.hud_values();
        if self.ui.draw(&values, false)?.is_none() {
            self.uploaded = None;
            event_loop.set_control_flow(ControlFlow::WaitUntil(now + POLL));
            return Ok(());
        }
        if self.ui.counts.draws == 1
            && let Some(gl_window) = &self.ui.gl_window
        {
            (self.report)(Event::FirstFrame {
                after: self.started.elapsed(),
                renderer: gl_window.renderer().to_owned(),
            });
        }
        if let Some(end) = change {
            event_loop.set_control_flow(ControlFlow::WaitUntil(end));
        }
        Ok(())
    }

    /// Uploads the picture that is to be shown, unless the texture holds it, and checks once in a
    /// size of the window that the driver shows it.
    fn upload(&mut self) -> Result<(), ViewerError> {
        let Some(gl_window) = &mut self.ui.gl_window else {
            return Ok(());
        };
        let image = self.pair.image(self.shown);
        if self.uploaded != Some(self.shown) {
            gl_window.upload(image, 0..image.height(), false)?;
            self.ui.counts.uploads += 1;
            self.uploaded = Some(self.shown);
        }
        if let Some(differs) = gl_window.check_pixels(image) {
            let renderer = gl_window.renderer().to_owned();
            (self.report)(Event::Differs { renderer, differs });
        }
        Ok(())
    }

    /// What the panel says.
    fn hud_values(&self) -> HudValues {
        let pictures = Part {
            heading: "Pictures",
            text: self.pair.list(self.shown),
            hanging: pair::NAMES,
            scale: (self.shown == Side::Difference).then(Vec::new),
        };
        let pointed = Part {
            heading: "Pixel under the pointer",
            text: self.pair.pixel(self.ui.pointed_pixel()),
            hanging: VALUES,
            scale: None,
        };
        let mut on = vec![Action::Show(self.shown)];
        on.extend(self.ui.hud.keys_are_shown().then_some(Action::Help));
        HudValues {
            parts: vec![pictures, pointed],
            on,
            ..HudValues::default()
        }
    }

    /// Ends the program where `result` is an error.
    fn check(&mut self, event_loop: &ActiveEventLoop, result: Result<(), ViewerError>) {
        if let Err(failure) = result {
            self.failure.get_or_insert(failure);
            event_loop.exit();
        }
    }
}
