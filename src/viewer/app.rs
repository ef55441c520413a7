//! The application: the redisplay, and the replies of the other threads.

mod actions;
mod events;
mod hud_values;

use std::time::{Duration, Instant};

use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::ModifiersState;

use crate::screen::driver_limits;
use crate::{Kernel, Stage};

use super::clipboard::Clipboard;
use super::comparison::{self, Comparing};
use super::content::{Content, Redisplay};
use super::frame_rate::FrameRate;
use super::hud::Hud;
use super::information::Times;
use super::playback::Playback;
use super::pointer::Pointer;
#[cfg(all(unix, not(target_vendor = "apple")))]
use super::server::event_loop;
use super::tracing::{Frame, FrameTracer, Reply, Tracing};
use super::window::GlWindow;
use super::{Counts, Event, Options, ViewerError};

/// How long a redisplay waits for the next picture before it draws the last one again.
const PATIENCE: Duration = Duration::from_millis(100);

/// How often a window that nothing can be drawn on is polled: no event says when that ends.
const POLL: Duration = Duration::from_millis(250);

/// Opens the viewer and stays until it is left.
pub(super) fn run(options: Options, report: &mut dyn FnMut(Event)) -> Result<(), ViewerError> {
    let started = Instant::now();
    let frame_tracer = FrameTracer::new(&options)?;
    let event_loop = event_loop()?;
    driver_limits::check(options.size)?;
    let proxy = event_loop.create_proxy();
    let comparing = {
        let proxy = proxy.clone();
        Comparing::start(&options, move || {
            let _ = proxy.send_event(());
        })?
    };
    let tracing = Tracing::start(frame_tracer, move || {
        // Without an event loop nobody waits for the picture.
        let _ = proxy.send_event(());
    })?;
    let mut app = App {
        started,
        stage: options.stage,
        kernel: options.kernel,
        size: options.size,
        playback: Playback::new(options.pace),
        exit_after_frames: options.exit_after_frames,
        report,
        tracing,
        comparing,
        content: Content::default(),
        gl_window: None,
        clipboard: None,
        overdue: false,
        next_frame: started,
        modifiers: ModifiersState::empty(),
        pointer: Pointer::default(),
        occluded: false,
        minimized: false,
        frame_time: Duration::ZERO,
        frame_rate: FrameRate::default(),
        title: String::new(),
        hud: Hud::default(),
        times: Times::default(),
        counts: Counts::default(),
        failure: None,
    };
    // While the window opens the first picture is traced.
    app.advance(started);
    let ended = event_loop.run_app(&mut app);
    app.leave(ended.is_ok())
}

struct App<'a> {
    started: Instant,
    stage: Stage,
    kernel: Kernel,
    /// N.
    size: u32,
    playback: Playback,
    exit_after_frames: Option<u64>,
    report: &'a mut dyn FnMut(Event),
    tracing: Tracing,
    comparing: Comparing,
    content: Content,
    /// `None` before the first `resumed`, and on systems that take the window away meanwhile.
    gl_window: Option<GlWindow>,
    /// `None` without a window.
    clipboard: Option<Clipboard>,
    /// The next redisplay does not wait for the next picture: that took too long, or something else
    /// has changed.
    overdue: bool,
    /// When the next frame of the playing animation is due.
    next_frame: Instant,
    modifiers: ModifiersState,
    pointer: Pointer,
    /// Other windows cover this one.
    occluded: bool,
    /// The window is an icon.
    minimized: bool,
    /// How long the display shows a frame.
    frame_time: Duration,
    frame_rate: FrameRate,
    title: String,
    hud: Hud,
    times: Times,
    counts: Counts,
    failure: Option<ViewerError>,
}

impl App<'_> {
    /// Ends the viewer after the last event.
    fn leave(mut self, ended_well: bool) -> Result<(), ViewerError> {
        self.counts.traces = self.tracing.traces;
        for reply in self.tracing.finish() {
            if let Reply::Saved(saved) = reply {
                (self.report)(saved.map_or_else(Event::NotSaved, Event::Saved));
            }
        }
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        if !ended_well {
            return Err(ViewerError::Lost);
        }
        (self.report)(Event::Left(self.counts));
        Ok(())
    }

    fn playing(&self) -> bool {
        self.stage == Stage::Animation && !self.playback.paused()
    }

    /// The picture that should be shown.
    fn wanted(&self) -> Frame {
        Frame {
            stage: self.stage,
            alpha: self.playback.alpha(),
            kernel: self.kernel,
        }
    }

    /// The picture that should be shown is not there yet.
    fn waiting(&self) -> bool {
        self.tracing
            .is_behind(self.content.traced().map(|traced| traced.frame))
    }

    /// Requests the next picture. Before that α advances to `now`, if the animation plays and its
    /// last picture has come.
    fn advance(&mut self, now: Instant) {
        if self.playing() && !self.waiting() {
            self.playback.advance(now);
            // The next picture is traced over this one, unless its pixels are looked at.
            if !self.hud.names_pixels() {
                self.content.give_back(self.wanted());
            }
        }
        self.tracing.request(self.wanted());
    }

    /// Uploads what the texture lacks of the content, if that can be had. Returns whether there was
    /// anything to upload.
    fn upload(&mut self) -> Result<bool, ViewerError> {
        let (Some(gl_window), Some((image, rows))) =
            (&mut self.gl_window, self.content.to_upload())
        else {
            return Ok(false);
        };
        self.times.upload = gl_window.upload(image, rows, self.hud.information)?;
        self.counts.uploads += 1;
        self.content.uploaded();
        Ok(true)
    }

    /// Checks that the driver shows what is uploaded, once in each size of the window.
    fn check_pixels(&mut self) {
        if let (Some(gl_window), Some(image)) = (&mut self.gl_window, self.content.in_texture())
            && let Some(differs) = gl_window.check_pixels(image)
        {
            let renderer = gl_window.renderer().to_owned();
            (self.report)(Event::Differs { renderer, differs });
        }
    }

    /// Draws the content, and requests the next picture if there is to be one.
    fn redraw(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let start = Instant::now();
        let overdue = std::mem::take(&mut self.overdue);
        event_loop.set_control_flow(ControlFlow::Wait);
        if !self.visible() {
            self.playback.hold();
            self.frame_rate.stop();
            if self.minimized {
                event_loop.set_control_flow(ControlFlow::WaitUntil(start + POLL));
            }
            return Ok(());
        }
        if self.counts.draws == 0 && self.content.traced().is_some() {
            // Opening the window was no part of the animation.
            self.playback.count_from(start - self.frame_time);
        }
        let is_new = self.upload()?;
        self.check_pixels();
        // The next picture is traced while this one is drawn.
        if !self.is_last() {
            self.advance(start);
        }
        let redisplay = self.content.redisplay(is_new, self.waiting(), overdue);
        if redisplay == Redisplay::Wait {
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + PATIENCE));
            return Ok(());
        }
        if let Some(until) = self
            .gl_window
            .as_mut()
            .and_then(|gl_window| gl_window.awaits_size(start))
        {
            // Drawn in the new size at once, instead of in the old one first.
            self.overdue |= overdue;
            event_loop.set_control_flow(ControlFlow::WaitUntil(until));
            return Ok(());
        }
        let change = self.hud.expire(start);
        let values = self.hud_values();
        let marks = self.marks(&values);
        let Some(gl_window) = &mut self.gl_window else {
            return Ok(());
        };
        if redisplay == Redisplay::Clear {
            return gl_window.clear();
        }
        let waits = self.hud.information;
        let window = (gl_window.surface(), gl_window.layout());
        let text_boxes = self.hud.text_boxes(window, gl_window.cell(), &values);
        let Some(draw) = gl_window.draw((&marks, text_boxes), waits)? else {
            self.content.lose_texture();
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + POLL));
            return Ok(());
        };
        self.times.draw = draw;
        self.times.display = self.frame_rate.per_second();
        self.counts.draws += 1;
        if self.counts.draws == 1 {
            (self.report)(Event::FirstFrame {
                after: self.started.elapsed(),
                renderer: gl_window.renderer().to_owned(),
            });
        }
        if self.playing() && self.frame_rate.count(start) {
            self.poll_window();
        }
        self.next_frame = start + self.frame_time;
        // The time that a comparison takes is seen to pass.
        let comparing = self.content.is_comparing().then(|| start + PATIENCE);
        if let Some(end) = change.into_iter().chain(comparing).min() {
            event_loop.set_control_flow(ControlFlow::WaitUntil(end));
        }
        self.schedule(event_loop);
        Ok(())
    }

    /// Whether a frame that is drawn now is the last one.
    fn is_last(&self) -> bool {
        self.exit_after_frames
            .is_some_and(|frames| self.counts.draws + 1 >= frames)
    }

    /// Whether the window can be drawn on and seen.
    fn visible(&mut self) -> bool {
        let Some(gl_window) = &self.gl_window else {
            return false;
        };
        if self.minimized {
            self.minimized = gl_window.is_minimized();
        }
        !(self.occluded || self.minimized || gl_window.is_empty())
    }

    /// Polls the display for the state of the window: only now and then, since each time is a round
    /// trip.
    fn poll_window(&mut self) {
        if let Some(gl_window) = &self.gl_window {
            self.minimized = gl_window.is_minimized();
            self.frame_time = gl_window.frame_time();
        }
        self.retitle();
    }

    /// Schedules the frame after this one, if it follows without an event.
    fn schedule(&mut self, event_loop: &ActiveEventLoop) {
        let last = self
            .exit_after_frames
            .is_some_and(|frames| self.counts.draws >= frames);
        if last {
            event_loop.exit();
        } else if !self.waiting() && (self.playing() || self.exit_after_frames.is_some()) {
            self.draw_in_time(event_loop);
        }
    }

    /// Requests the next frame once the display has shown the last one. A driver with vertical sync
    /// has waited for that; without, the event loop waits.
    fn draw_in_time(&self, event_loop: &ActiveEventLoop) {
        if Instant::now() < self.next_frame {
            event_loop.set_control_flow(ControlFlow::WaitUntil(self.next_frame));
        } else if let Some(gl_window) = &self.gl_window {
            gl_window.window().request_redraw();
        }
    }

    /// Handles the replies of the other threads.
    fn receive(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        while let Some(reply) = self.tracing.reply() {
            match reply {
                Reply::Traced(traced, samples) => {
                    // A stage that was left meanwhile is not shown any more; an angle is, or one
                    // that moves fast would never be seen.
                    let Frame { stage, kernel, .. } = traced.frame;
                    if (stage, kernel) == (self.stage, self.kernel) {
                        self.content.picture_came(traced, samples, Instant::now());
                        self.draw_in_time(event_loop);
                    }
                }
                Reply::Saved(saved) => {
                    let event = saved.map_or_else(Event::NotSaved, Event::Saved);
                    self.hud.say(event.to_string());
                    (self.report)(event);
                    self.touch();
                }
                Reply::Explained(pixel, text) => {
                    self.hud.inspect(pixel, text.clone());
                    (self.report)(Event::Inspected(text));
                    self.touch();
                }
                Reply::Refused(_, error) if self.content.traced().is_none() => {
                    return Err(error.into());
                }
                Reply::Refused(frame, error) => {
                    self.hud.say(error.to_string());
                    if self.kernel == frame.kernel {
                        self.next_kernel();
                        self.retitle();
                        self.tracing.request(self.wanted());
                    }
                    self.touch();
                }
                Reply::Failed(error) => return Err(error),
            }
        }
        self.compare();
        while let Some(reply) = self.comparing.reply() {
            if !self.content.shows_errors() {
                continue;
            }
            match reply {
                comparison::Reply::Begun(kernel, progress) => {
                    self.content.comparison_traces(kernel, progress);
                }
                comparison::Reply::Done(compared) => self.content.comparison_came(compared),
                comparison::Reply::Failed(error) => return Err(error),
            }
            self.touch();
        }
        Ok(())
    }

    /// Requests a redisplay at once, for something other than the picture has changed.
    fn touch(&mut self) {
        let open = self.hud.has_panel() || self.content.shows_errors();
        if let Some(gl_window) = &mut self.gl_window {
            gl_window.show_panel(open);
        }
        self.overdue = true;
        self.ask_for_redraw();
    }

    /// Requests the errors of the picture, if they are to be shown.
    fn compare(&mut self) {
        if let Some(frame) = self.content.frame_to_compare() {
            self.comparing.request(frame);
        }
    }

    fn ask_for_redraw(&self) {
        if let Some(gl_window) = &self.gl_window {
            gl_window.window().request_redraw();
        }
    }

    /// Writes stage, kernel, α and frames a second into the title, where they changed.
    fn retitle(&mut self) {
        let Some(gl_window) = &self.gl_window else {
            return;
        };
        let tail = match (self.stage, self.frame_rate.per_second()) {
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
            gl_window.window().set_title(&title);
            self.title = title;
        }
    }

    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let gl_window = GlWindow::open(event_loop, self.size)?;
        gl_window.window().request_redraw();
        self.frame_time = gl_window.frame_time();
        self.clipboard = Some(Clipboard::beside(gl_window.window()));
        self.gl_window = Some(gl_window);
        (self.report)(Event::Opened);
        self.content.lose_texture();
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

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
fn event_loop() -> Result<winit::event_loop::EventLoop<()>, ViewerError> {
    winit::event_loop::EventLoop::new().map_err(|error| ViewerError::Display {
        server: "the desktop".to_owned(),
        reason: super::error::reason(&error),
    })
}
