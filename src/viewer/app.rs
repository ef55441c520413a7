//! The application: the redisplay, and the replies of the other threads.

mod actions;
mod events;
mod hud_values;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::UVec2;
use winit::event_loop::{ActiveEventLoop, ControlFlow};

use crate::screen::driver_limits;
use crate::tracer::Tally;
use crate::{Image, Render, RenderError, Scene, Stage};

use super::action::Subject;
use super::comparison::{self, Comparing};
use super::content::{Content, Redisplay, STAND_IN};
use super::desktop::event_loop;
use super::frame_rate::FrameRate;
use super::information::Times;
use super::playback::Playback;
use super::renderer::{Renderer, Renderers};
use super::tracing::{Frame, Pictures, Reply, Traced, Tracing};
use super::ui::{POLL, Ui};
use super::watch::{Change, Watch, Watched};
use super::window::Opening;
use super::{Event, Options, ViewerError};

/// How long a redisplay waits for the next picture before it draws the last one again.
const PICTURE_TIMEOUT: Duration = Duration::from_millis(100);

/// How long a renderer is at a picture before that is said.
const SLOW: Duration = Duration::from_millis(500);

/// Opens the viewer and stays until it is left.
pub(super) fn run(
    options: Options,
    renderers: Vec<Box<dyn Render + Send>>,
    report: &mut dyn FnMut(Event),
) -> Result<(), ViewerError> {
    let started = Instant::now();
    let of_kernels = Pictures::of_kernels(&options)?;
    let event_loop = event_loop()?;
    driver_limits::check(u64::from(options.size).pow(2))?;
    let proxy = event_loop.create_proxy();
    let wake = move || {
        // Without an event loop nobody waits.
        let _ = proxy.send_event(());
    };
    let comparing = Comparing::start(&options, wake.clone())?;
    let watch = Watch::start(watched(&options, &renderers), wake.clone());
    let names = renderers.iter().map(|renderer| Arc::from(renderer.name()));
    let shown = Renderers::new(names, options.kernel);
    let tracing = Tracing::start(of_kernels, renderers, wake)?;
    let mut app = App {
        started,
        scene: Arc::new(options.scene),
        scene_file: options.scene_file,
        scene_refusal: None,
        stage: options.stage,
        renderers: shown,
        size: options.size,
        playback: Playback::new(options.pace),
        exit_after_frames: options.exit_after_frames,
        report,
        tracing,
        comparing,
        watch: watch.map_err(ViewerError::Thread)?,
        failure_of_renderer: None,
        content: Content::default(),
        ui: Ui::new(Subject::Scene),
        next_frame: started,
        frame_time: Duration::ZERO,
        frame_rate: FrameRate::default(),
        title: String::new(),
        times: Times::default(),
        failure: None,
    };
    // While the window opens the first picture is traced.
    app.advance(started);
    let ended = event_loop.run_app(&mut app);
    app.leave(ended.is_ok())
}

/// The files to watch.
fn watched(options: &Options, renderers: &[Box<dyn Render + Send>]) -> Vec<Watched> {
    let scene = options.scene_file.clone().map(Watched::Scene);
    let renderers = renderers.iter().enumerate();
    let of_renderers = renderers.flat_map(|(number, renderer)| {
        let files = renderer.files().into_iter();
        files.map(move |file| Watched::Renderer(number, file))
    });
    scene.into_iter().chain(of_renderers).collect()
}

struct App<'a> {
    started: Instant,
    scene: Arc<Scene>,
    scene_file: Option<PathBuf>,
    /// Why the scene file, as it is now, gives no scene.
    scene_refusal: Option<String>,
    stage: Stage,
    renderers: Renderers,
    /// N.
    size: u32,
    playback: Playback,
    exit_after_frames: Option<u64>,
    report: &'a mut dyn FnMut(Event),
    tracing: Tracing,
    comparing: Comparing,
    watch: Watch,
    /// A frame of which there is no picture, and why.
    failure_of_renderer: Option<(Frame, String)>,
    content: Content,
    ui: Ui,
    /// When the next frame of the playing animation is due.
    next_frame: Instant,
    /// How long the display shows a frame.
    frame_time: Duration,
    frame_rate: FrameRate,
    title: String,
    times: Times,
    failure: Option<ViewerError>,
}

impl App<'_> {
    /// What is said as long as it is so: why the scene or the picture is not what was asked for, or
    /// how long a slow renderer has been at it.
    fn notice(&self) -> Option<String> {
        let failure = self.failure_of_renderer.as_ref();
        let failure = failure.filter(|(frame, _)| *frame == self.wanted());
        let slow = || match self.renderers.shown() {
            Renderer::Kernel(_) => None,
            Renderer::Given(given) => {
                let time = self.waits_for().filter(|time| *time >= SLOW)?.as_secs_f64();
                Some(format!("{} has been at it for {time:.1} s", given.name))
            }
        };
        self.scene_refusal
            .clone()
            .or_else(|| failure.map(|(_, reason)| reason.clone()))
            .or_else(slow)
    }

    /// Ends the viewer after the last event.
    fn leave(mut self, ended_well: bool) -> Result<(), ViewerError> {
        self.ui.counts.traces = self.tracing.made();
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
        (self.report)(Event::Left(self.ui.counts));
        Ok(())
    }

    fn playing(&self) -> bool {
        self.stage == Stage::Animation && !self.playback.paused()
    }

    /// The picture that should be shown.
    fn wanted(&self) -> Frame {
        Frame {
            scene: self.scene.clone(),
            stage: self.stage,
            alpha: self.playback.alpha(),
            renderer: self.renderers.shown().clone(),
        }
    }

    /// The picture that should be shown is not there yet.
    fn waiting(&self) -> bool {
        self.waits_for().is_some()
    }

    /// Whether a renderer that the viewer was given is making it.
    fn waits_for_renderer(&self) -> bool {
        matches!(self.renderers.shown(), Renderer::Given(_)) && self.waiting()
    }

    /// Whether it takes so long that this is said.
    fn is_slow(&self) -> bool {
        self.waits_for_renderer() && self.waits_for() >= Some(SLOW)
    }

    /// For how long it has not been there.
    fn waits_for(&self) -> Option<Duration> {
        let shown = self.content.traced().map(|traced| &traced.frame);
        self.tracing.behind(shown)
    }

    /// Requests the picture that should be shown.
    fn request(&mut self) {
        self.tracing.request(self.wanted());
    }

    /// Requests the next picture. Before that α advances to `now`, if the animation plays and its
    /// last picture has come.
    fn advance(&mut self, now: Instant) {
        if self.playing() && !self.waiting() {
            self.playback.advance(now);
            // The next picture is traced over this one, unless its pixels are looked at.
            if !self.ui.hud.names_pixels() {
                let next = self.wanted();
                self.content.give_back(&next);
            }
        }
        self.request();
    }

    /// Uploads what the texture lacks of the content, if that can be had. Returns whether there was
    /// anything to upload.
    fn upload(&mut self) -> Result<bool, ViewerError> {
        let (Some(gl_window), Some((image, rows))) =
            (&mut self.ui.gl_window, self.content.to_upload())
        else {
            return Ok(false);
        };
        self.times.upload = gl_window.upload(image, rows, self.ui.hud.information)?;
        self.ui.counts.uploads += 1;
        self.content.uploaded();
        Ok(true)
    }

    /// Checks that the driver shows what is uploaded, once in each size of the window.
    fn check_pixels(&mut self) {
        if let (Some(gl_window), Some(image)) = (&mut self.ui.gl_window, self.content.in_texture())
            && let Some(differs) = gl_window.check_pixels(image)
        {
            let renderer = gl_window.renderer().to_owned();
            (self.report)(Event::Differs { renderer, differs });
        }
    }

    /// Draws the content, and requests the next picture if there is to be one.
    fn redraw(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let start = Instant::now();
        let overdue = std::mem::take(&mut self.ui.overdue);
        event_loop.set_control_flow(ControlFlow::Wait);
        let visible = self.ui.visible();
        self.watch.hold(!visible);
        if !visible {
            self.playback.hold();
            self.frame_rate.stop();
            if self.ui.is_minimized() {
                event_loop.set_control_flow(ControlFlow::WaitUntil(start + POLL));
            }
            return Ok(());
        }
        if self.ui.counts.draws == 0 && self.content.traced().is_some() {
            // Opening the window was no part of the animation.
            self.playback.count_from(start - self.frame_time);
        }
        if self.content.traced().is_none() && self.is_slow() {
            let mut frame = self.wanted();
            // Not this picture, which is still to come.
            frame.alpha = f64::NAN;
            self.stand_in(frame)?;
        }
        let is_new = self.upload()?;
        self.check_pixels();
        // The next picture is traced while this one is drawn.
        if !self.is_last() {
            self.advance(start);
        }
        let redisplay = self.content.redisplay(is_new, self.waiting(), overdue);
        if redisplay == Redisplay::Wait {
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + PICTURE_TIMEOUT));
            return Ok(());
        }
        if let Some(until) = self
            .ui
            .gl_window
            .as_mut()
            .and_then(|gl_window| gl_window.awaits_size(start))
        {
            // Drawn in the new size at once, instead of in the old one first.
            self.ui.overdue |= overdue;
            event_loop.set_control_flow(ControlFlow::WaitUntil(until));
            return Ok(());
        }
        let change = self.ui.hud.expire(start);
        if redisplay == Redisplay::Clear {
            // A renderer that is slow with its first picture is noticed.
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + PICTURE_TIMEOUT));
            return self.ui.clear();
        }
        let values = self.hud_values();
        let Some(draw) = self.ui.draw(&values, self.ui.hud.information)? else {
            self.content.lose_texture();
            event_loop.set_control_flow(ControlFlow::WaitUntil(start + POLL));
            return Ok(());
        };
        self.times.draw = draw;
        self.times.display = self.frame_rate.per_second();
        if self.ui.counts.draws == 1
            && let Some(gl_window) = &self.ui.gl_window
        {
            (self.report)(Event::FirstFrame {
                after: self.started.elapsed(),
                renderer: gl_window.renderer().to_owned(),
            });
        }
        // A picture that is only drawn again while the next one is awaited is no other frame.
        let is_frame = (is_new || !self.waiting()) && !self.content.is_stand_in();
        if self.playing() && is_frame && self.frame_rate.count(start) {
            self.poll_window();
        }
        self.next_frame = start + self.frame_time;
        // The time that a comparison or a renderer takes is seen to pass.
        let passes = self.content.is_comparing() || self.waits_for_renderer();
        let next = passes.then(|| start + PICTURE_TIMEOUT);
        if let Some(end) = change.into_iter().chain(next).min() {
            event_loop.set_control_flow(ControlFlow::WaitUntil(end));
        }
        self.schedule(event_loop);
        Ok(())
    }

    /// Whether a frame that is drawn now is the last one.
    fn is_last(&self) -> bool {
        self.exit_after_frames
            .is_some_and(|frames| self.ui.counts.draws + 1 >= frames)
    }

    /// Polls the display for the state of the window: only now and then, since each time is a round
    /// trip.
    fn poll_window(&mut self) {
        self.ui.poll();
        if let Some(gl_window) = &self.ui.gl_window {
            self.frame_time = gl_window.frame_time();
        }
        self.retitle();
    }

    /// Schedules the frame after this one, if it follows without an event.
    fn schedule(&mut self, event_loop: &ActiveEventLoop) {
        let last = self
            .exit_after_frames
            .is_some_and(|frames| self.ui.counts.draws >= frames);
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
        } else if let Some(gl_window) = &self.ui.gl_window {
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
                    if traced.frame.differs_in_angle(&self.wanted()) {
                        self.content.picture_came(traced, samples, Instant::now());
                        if self.playback.recover() {
                            self.retitle();
                        }
                        self.draw_in_time(event_loop);
                    }
                }
                Reply::Saved(saved) => {
                    let event = saved.map_or_else(Event::NotSaved, Event::Saved);
                    self.ui.hud.say(event.to_string());
                    (self.report)(event);
                    self.ui.touch();
                }
                Reply::Explained(pixel, text) => {
                    self.ui.hud.inspect(pixel, text.clone());
                    (self.report)(Event::Inspected(text));
                    self.ui.touch();
                }
                Reply::Refused(frame, reason) => self.refuse(frame, reason)?,
                Reply::Failed(error) => return Err(error),
            }
        }
        while let Some(change) = self.watch.change() {
            self.reload(change);
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
            self.ui.touch();
        }
        Ok(())
    }

    /// There is no picture of `frame`, for this reason.
    fn refuse(&mut self, frame: Frame, reason: RenderError) -> Result<(), ViewerError> {
        let is_wanted = self.tracing.refuse(&frame);
        match &frame.renderer {
            Renderer::Kernel(_) if self.content.traced().is_none() => {
                return Err(ViewerError::Refused(reason));
            }
            // Another kernel has one.
            Renderer::Kernel(_) => {
                self.ui.hud.say(reason.to_string());
                if self.renderers.shown() == &frame.renderer {
                    self.renderers.show_next();
                    self.retitle();
                    self.request();
                }
            }
            // What failed may be mended while it is looked at.
            Renderer::Given(given) => {
                let event = Event::NotRendered {
                    renderer: given.name.to_string(),
                    reason: reason.to_string(),
                };
                if is_wanted {
                    self.failure_of_renderer = Some((frame.clone(), event.to_string()));
                    // A program that fails is not started again for each frame.
                    if self.stage == Stage::Animation {
                        self.playback.halt();
                    }
                    self.retitle();
                }
                // A picture that was cancelled is missed by nobody.
                if is_wanted {
                    (self.report)(event);
                }
                if self.content.traced().is_none() {
                    self.stand_in(frame)?;
                }
            }
        }
        self.ui.touch();
        Ok(())
    }

    /// Shows black where there is no picture yet, so that notes can be read.
    fn stand_in(&mut self, frame: Frame) -> Result<(), ViewerError> {
        let traced = Traced {
            frame,
            number: STAND_IN,
            changed: 0..self.size,
            time: Duration::ZERO,
            tally: Tally::default(),
        };
        let black = Arc::new(Image::new(self.size)?);
        self.content.picture_came(traced, black, Instant::now());
        Ok(())
    }

    /// A watched file has changed.
    fn reload(&mut self, change: Change) {
        match change {
            Change::Scene(read) => match *read {
                Ok(scene) => {
                    self.scene = Arc::new(scene);
                    self.scene_refusal = None;
                    if let Some(path) = &self.scene_file {
                        (self.report)(Event::SceneRead(path.clone()));
                    }
                }
                Err(error) => {
                    self.scene_refusal = Some(error.to_string());
                    (self.report)(Event::SceneRefused(error));
                }
            },
            Change::Renderer(number) => {
                self.renderers.has_changed(number);
                // Before the next picture is requested, which must not be cancelled.
                self.tracing.cancel(number);
            }
        }
        self.request();
        self.ui.touch();
    }

    /// Requests the errors of the picture, if they are to be shown.
    fn compare(&mut self) {
        if let Some((frame, image)) = self.content.to_compare() {
            self.comparing.request(frame, image);
        }
    }

    /// Writes stage, kernel, α and frames a second into the title, where they changed.
    fn retitle(&mut self) {
        let Some(gl_window) = &self.ui.gl_window else {
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
            self.renderers.shown().name(),
            self.playback.alpha(),
        );
        if title != self.title {
            gl_window.window().set_title(&title);
            self.title = title;
        }
    }

    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<(), ViewerError> {
        let opening = Opening {
            picture: UVec2::splat(self.size),
            magnification: 1,
            panel: false,
        };
        self.frame_time = self.ui.open(event_loop, opening)?.frame_time();
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
