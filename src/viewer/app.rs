//! What happens when: the events of the window, the keys, and the redisplay.

use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::event::{KeyEvent, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::ModifiersState;
use winit::window::WindowId;

use crate::image::Format;
use crate::{Kernel, Stage};

use super::action::{Action, Press};
use super::frames::Meter;
use super::picture::Picture;
use super::playback::Playback;
#[cfg(all(unix, not(target_vendor = "apple")))]
use super::server::event_loop;
use super::window::View;
use super::{Counts, Event, Options, ViewerError};

/// α turned by an arrow key, in radians.
const NUDGE: f64 = 0.05;

/// What + and − do to the speed.
const FASTER: f64 = 1.25;

/// How soon to look again for a window that nothing can be drawn on and that does not say when that ends.
const LOOK_AGAIN: Duration = Duration::from_millis(250);

pub(super) struct App<'a> {
    started: Instant,
    stage: Stage,
    kernel: Kernel,
    picture: Picture,
    playback: Playback,
    exit_after_frames: Option<u64>,
    report: &'a mut dyn FnMut(Event),
    /// `None` before the first [`ApplicationHandler::resumed`], and on systems that take the window away meanwhile.
    view: Option<View>,
    /// The texture holds the picture.
    uploaded: bool,
    modifiers: ModifiersState,
    /// Other windows cover this one.
    occluded: bool,
    /// The window is an icon.
    minimized: bool,
    /// How long the display shows a frame.
    frame_time: Duration,
    meter: Meter,
    title: String,
    counts: Counts,
    failure: Option<ViewerError>,
}

impl<'a> App<'a> {
    pub(super) fn new(
        options: Options,
        report: &'a mut dyn FnMut(Event),
    ) -> Result<App<'a>, ViewerError> {
        Ok(App {
            started: Instant::now(),
            stage: options.stage,
            kernel: options.kernel,
            picture: Picture::new(&options)?,
            playback: Playback::new(options.pace),
            exit_after_frames: options.exit_after_frames,
            report,
            view: None,
            uploaded: false,
            modifiers: ModifiersState::empty(),
            occluded: false,
            minimized: false,
            frame_time: Duration::ZERO,
            meter: Meter::default(),
            title: String::new(),
            counts: Counts::default(),
            failure: None,
        })
    }

    /// Runs until the window is closed.
    pub(super) fn run(mut self) -> Result<(), ViewerError> {
        let ended = event_loop()?.run_app(&mut self);
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        ended.map_err(|_| ViewerError::Lost)?;
        (self.report)(Event::Left(self.counts));
        Ok(())
    }

    fn playing(&self) -> bool {
        self.stage == Stage::Animation && !self.playback.paused()
    }

    /// Makes the image the one of the present stage and α.
    fn trace(&mut self) -> Result<(), ViewerError> {
        if self.picture.bring(self.stage, self.playback.alpha())? {
            self.counts.traces += 1;
            self.uploaded = false;
        }
        Ok(())
    }

    /// Shows the present stage and α, and sees to the next frame if there is one to come.
    fn redraw(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let start = Instant::now();
        event_loop.set_control_flow(ControlFlow::Wait);
        if !self.visible() {
            self.playback.hold();
            self.meter.stop();
            if self.minimized {
                event_loop.set_control_flow(ControlFlow::WaitUntil(start + LOOK_AGAIN));
            }
            return Ok(());
        }
        if self.playing() {
            self.playback.advance(start);
        }
        self.trace()?;
        let Some(view) = &mut self.view else {
            return Ok(());
        };
        let image = (!self.uploaded).then(|| self.picture.image());
        self.counts.uploads += u64::from(image.is_some());
        self.uploaded = view.draw(image)?;
        if !self.uploaded {
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + LOOK_AGAIN));
            return Ok(());
        }
        self.counts.draws += 1;
        if self.counts.draws == 1 {
            (self.report)(Event::FirstFrame {
                after: self.started.elapsed(),
                renderer: view.renderer().to_owned(),
            });
        }
        if self.playing() && self.meter.frame(start) {
            self.look_around();
        }
        self.schedule(event_loop, start);
        Ok(())
    }

    /// Whether there is anything to draw on that is seen.
    fn visible(&mut self) -> bool {
        let Some(view) = &self.view else {
            return false;
        };
        if self.minimized {
            self.minimized = view.is_minimized();
        }
        !(self.occluded || self.minimized || view.is_empty())
    }

    /// What is only looked at now and then while the animation plays: each time it asks the display.
    fn look_around(&mut self) {
        if let Some(view) = &self.view {
            self.minimized = view.is_minimized();
            self.frame_time = view.frame_time();
        }
        self.retitle();
    }

    /// After a frame that was begun at `start`: the next one, if it comes by itself.
    fn schedule(&mut self, event_loop: &ActiveEventLoop, start: Instant) {
        let last = self
            .exit_after_frames
            .is_some_and(|frames| self.counts.draws >= frames);
        if last {
            event_loop.exit();
            return;
        }
        let more = self.playing() || self.exit_after_frames.is_some();
        let Some(view) = self.view.as_ref().filter(|_| more) else {
            return;
        };
        // A display that waits for its own refresh has kept us about as long as it shows a frame; one that does not is waited for here.
        let next = start + self.frame_time;
        if Instant::now() < next {
            event_loop.set_control_flow(ControlFlow::WaitUntil(next));
        } else {
            view.window().request_redraw();
        }
    }

    fn act(&mut self, event_loop: &ActiveEventLoop, action: Action) -> Result<(), ViewerError> {
        match action {
            Action::Stage(stage) if stage == self.stage => {}
            Action::Stage(Stage::Animation) => self.stage = Stage::Animation,
            Action::Stage(stage) => {
                self.stage = stage;
                self.playback.settle();
            }
            Action::Pause if self.stage == Stage::Animation => self.playback.toggle(),
            Action::Pause => {}
            Action::NextFrame => {
                self.stop();
                self.playback.next_frame();
            }
            Action::PreviousFrame => {
                self.stop();
                self.playback.previous_frame();
            }
            Action::TurnLeft => self.playback.nudge(-NUDGE),
            Action::TurnRight => self.playback.nudge(NUDGE),
            Action::Faster => self.playback.scale(FASTER),
            Action::Slower => self.playback.scale(1.0 / FASTER),
            Action::Zero => self.playback.zero(),
            Action::SavePng => self.save(Format::Png)?,
            Action::SaveExr => self.save(Format::Exr)?,
            Action::FullScreen => {
                if let Some(view) = &self.view {
                    view.toggle_full_screen();
                }
            }
            Action::Leave => event_loop.exit(),
        }
        if !self.playing() {
            self.meter.stop();
        }
        self.retitle();
        let shown = (self.stage, self.playback.alpha());
        if (self.playing() || !self.uploaded || !self.picture.is(shown))
            && let Some(view) = &self.view
        {
            view.window().request_redraw();
        }
        Ok(())
    }

    /// Pauses the animation if it is on.
    fn stop(&mut self) {
        if self.stage == Stage::Animation {
            self.playback.pause();
        }
    }

    fn save(&mut self, format: Format) -> Result<(), ViewerError> {
        self.trace()?;
        let event = match super::snapshot::save(self.picture.image(), self.stage, format) {
            Ok(path) => Event::Saved(path),
            Err(error) => Event::NotSaved(error),
        };
        (self.report)(event);
        Ok(())
    }

    /// Writes stage, kernel, α and frames a second into the title, where they changed.
    fn retitle(&mut self) {
        let Some(view) = &self.view else {
            return;
        };
        let tail = match (self.stage, self.meter.rate()) {
            (Stage::Animation, _) if self.playback.paused() => " — paused".to_owned(),
            (Stage::Animation, Some(rate)) => format!(" — {rate:.0} fps"),
            _ => String::new(),
        };
        let title = format!(
            "firsthit — {} — {} — α = {:.3}{tail}",
            self.stage,
            self.kernel.name(),
            self.playback.alpha(),
        );
        if title != self.title {
            view.window().set_title(&title);
            self.title = title;
        }
    }

    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let view = View::open(event_loop, self.picture.image().size())?;
        view.window().request_redraw();
        self.frame_time = view.frame_time();
        self.view = Some(view);
        self.uploaded = false;
        self.retitle();
        Ok(())
    }

    /// Ends the program where `result` is an error.
    fn check(&mut self, event_loop: &ActiveEventLoop, result: Result<(), ViewerError>) {
        if let Err(failure) = result {
            self.failure.get_or_insert(failure);
            event_loop.exit();
        }
    }
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.view.is_none() {
            let opened = self.open(event_loop);
            self.check(event_loop, opened);
        }
    }

    fn suspended(&mut self, _event_loop: &ActiveEventLoop) {
        self.view = None;
    }

    fn exiting(&mut self, _event_loop: &ActiveEventLoop) {
        // While the display is still open.
        self.view = None;
    }

    fn new_events(&mut self, event_loop: &ActiveEventLoop, cause: StartCause) {
        if let StartCause::ResumeTimeReached { .. } = cause
            && let Some(view) = &self.view
        {
            event_loop.set_control_flow(ControlFlow::Wait);
            view.window().request_redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::RedrawRequested => {
                let drawn = self.redraw(event_loop);
                self.check(event_loop, drawn);
            }
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::KeyboardInput {
                event,
                is_synthetic: false,
                ..
            } if event.state.is_pressed() => {
                if let Some(action) = self.pressed(&event) {
                    let done = self.act(event_loop, action);
                    self.check(event_loop, done);
                }
            }
            WindowEvent::Resized(size) => {
                if let Some(view) = &mut self.view {
                    view.resize(size);
                    view.window().request_redraw();
                }
            }
            WindowEvent::Occluded(occluded) => {
                self.occluded = occluded;
                if let Some(view) = self.view.as_ref().filter(|_| !occluded) {
                    view.window().request_redraw();
                }
            }
            _ => {}
        }
    }
}

impl App<'_> {
    fn pressed(&self, event: &KeyEvent) -> Option<Action> {
        let press = Press {
            meaning: &event.logical_key,
            place: event.physical_key,
            location: event.location,
            modifiers: self.modifiers,
            repeat: event.repeat,
        };
        press.action()
    }
}

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
fn event_loop() -> Result<winit::event_loop::EventLoop<()>, ViewerError> {
    winit::event_loop::EventLoop::new().map_err(|error| ViewerError::Display {
        server: "the desktop".to_owned(),
        reason: super::error::reason(&error),
    })
}
