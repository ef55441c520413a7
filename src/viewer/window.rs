//! The window, its OpenGL context, and what is drawn in it.

mod growth;
mod opengl;

use std::num::NonZeroU32;
use std::ops::Range;
use std::rc::Rc;
use std::time::{Duration, Instant};

use glam::{DVec2, IVec2, UVec2};
use glow::HasContext as _;
use glutin::config::Config;
use glutin::context::{
    ContextApi, ContextAttributesBuilder, GlProfile, PossiblyCurrentContext, Version,
};
use glutin::display::GetGlDisplay as _;
use glutin::prelude::*;
use glutin::surface::{Surface, SurfaceAttributesBuilder, SwapInterval, WindowSurface};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle, RawDisplayHandle};
use winit::dpi::{LogicalSize, PhysicalPosition, PhysicalSize};
use winit::event_loop::ActiveEventLoop;
use winit::monitor::MonitorHandle;
use winit::window::{Fullscreen, Window, WindowAttributes};

use crate::image::Raster;
use crate::screen::{Differs, Placement, Screen};

use super::ViewerError;
use super::canvas::TextBox;
use super::icon::icon;
use super::layout::{Layout, with_panel};
use super::overlay::Overlay;
use super::panel;
use super::rect::Rect;
#[cfg(all(unix, not(target_vendor = "apple")))]
use super::x11_window::X11Window;
use super::zoom::Zoom;
use growth::Growth;
use opengl::{EIGHT_BITS, Failure, config, display, fitting, functions};

/// A driver that shows wrong pixels in so many checks in a row is wrong.
const CHECKS: u32 = 4;

/// So many frames are presented in a size before the first check.
const UNCHECKED: u64 = 2;

/// A window with an OpenGL context.
pub(super) struct GlWindow {
    /// `None` only while they are being replaced.
    resources: Option<GlResources>,
    config: Config,
    /// `None` on another display than X11.
    #[cfg(all(unix, not(target_vendor = "apple")))]
    x11: Option<X11Window>,
    window: Window,
    /// The width and height of the surface in pixels; 0 where the window shows none.
    surface: UVec2,
    /// The width and height of the pictures that are shown, in pixels.
    picture: UVec2,
    zoom: Zoom,
    /// A panel stands beside the picture.
    panel: bool,
    /// What the window was asked to become for the panel.
    growth: Growth,
    /// How often the pixels may still be checked in this size.
    checks_left: u32,
    /// The frames presented in this size.
    presented: u64,
    /// How many these were at the last check.
    checked_at: u64,
}

/// The context and its objects, lost together. Dropped in this order: the screen needs the context.
struct GlResources {
    /// Made when there is something to write.
    overlay: Option<Overlay>,
    gl: Rc<glow::Context>,
    screen: Screen,
    renderer: String,
    surface: Surface<WindowSurface>,
    context: PossiblyCurrentContext,
}

/// What a window is opened for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Opening {
    /// The width and height of its pictures in pixels.
    pub(super) picture: UVec2,
    /// So many logical pixels, each way, show one of the picture.
    pub(super) magnification: u32,
    /// It opens with a panel beside the picture.
    pub(super) panel: bool,
}

impl Opening {
    /// The width and height of the window in pixels: so that the picture is magnified, or as large
    /// as fits the monitor, and the panel has its room, where the monitor has it.
    fn size(self, monitor: Option<UVec2>, scale: f64) -> UVec2 {
        let wanted = self.picture.as_dvec2() * f64::from(self.magnification) * scale;
        let most = monitor.map_or(DVec2::INFINITY, |monitor| monitor.as_dvec2());
        let size = wanted * (most / wanted).min_element().min(1.0);
        let size = size.round().max(DVec2::ONE).as_uvec2();
        if !self.panel {
            return size;
        }
        let shown = Placement::fit(size, self.picture).size;
        let size = with_panel(size, self.picture, shown.x, panel::wanted(cell(scale)));
        monitor.map_or(size, |monitor| size.min(monitor))
    }
}

/// The width and height of a character in pixels: 7 × 14 logical ones.
fn cell(scale: f64) -> UVec2 {
    let width = (7.0 * scale).round().max(1.0) as u32;
    UVec2::new(width, 2 * width)
}

impl GlWindow {
    /// Opens a window.
    pub(super) fn open(
        event_loop: &ActiveEventLoop,
        opening: Opening,
    ) -> Result<GlWindow, ViewerError> {
        let monitor = event_loop
            .primary_monitor()
            .or_else(|| event_loop.available_monitors().next())
            .filter(|monitor| monitor.size().width > 0 && monitor.size().height > 0);
        let scale = monitor.as_ref().map_or(1.0, MonitorHandle::scale_factor);
        let monitor =
            monitor.map(|monitor| UVec2::new(monitor.size().width, monitor.size().height));
        let size = opening.size(monitor, scale).as_dvec2() / scale;
        let attributes = Window::default_attributes()
            .with_title("firsthit")
            .with_window_icon(icon())
            .with_inner_size(LogicalSize::new(size.x, size.y));
        #[cfg(all(unix, not(target_vendor = "apple")))]
        let attributes = named(attributes);
        let mut reasons = Vec::new();
        for prefer_egl in [false, true] {
            match GlWindow::open_with(event_loop, &attributes, opening, prefer_egl) {
                Ok(gl_window) => return Ok(gl_window),
                Err(Failure::OpenGl(reason)) if !reasons.contains(&reason) => reasons.push(reason),
                Err(Failure::OpenGl(_)) => {}
                Err(Failure::Viewer(error)) => return Err(error),
            }
        }
        Err(ViewerError::OpenGl(reasons.join("; ")))
    }

    fn open_with(
        event_loop: &ActiveEventLoop,
        attributes: &WindowAttributes,
        opening: Opening,
        prefer_egl: bool,
    ) -> Result<GlWindow, Failure> {
        let create = |config: Option<&Config>| match config {
            Some(config) => event_loop.create_window(fitting(attributes.clone(), config)),
            None => event_loop.create_window(attributes.clone()),
        };
        // Windows has no display without a window; elsewhere the display says what kind of window
        // it can draw in.
        let early = cfg!(windows).then(|| create(None)).transpose()?;
        let handle = early
            .as_ref()
            .map(|window| window.window_handle())
            .transpose()?;
        let display = display(event_loop, handle.map(|handle| handle.as_raw()), prefer_egl)?;
        let config = config(&display)?;
        let window = match early {
            Some(window) => window,
            None => create(Some(&config))?,
        };
        let size = window.inner_size();
        let mut gl_window = GlWindow {
            resources: None,
            config,
            #[cfg(all(unix, not(target_vendor = "apple")))]
            x11: X11Window::of(&window),
            window,
            surface: UVec2::new(size.width, size.height),
            picture: opening.picture,
            zoom: Zoom::default(),
            panel: opening.panel,
            growth: Growth::default(),
            checks_left: CHECKS,
            presented: 0,
            checked_at: UNCHECKED,
        };
        gl_window.renew()?;
        Ok(gl_window)
    }

    /// Makes surface, context and screen, anew where they were lost. The screen's texture is empty
    /// after it.
    fn renew(&mut self) -> Result<(), Failure> {
        self.resources = None;
        self.restart_checks();
        self.resources = Some(GlResources::new(
            &self.config,
            &self.window,
            self.surface,
            self.picture,
        )?);
        Ok(())
    }

    pub(super) fn window(&self) -> &Window {
        &self.window
    }

    /// The name of the OpenGL renderer.
    pub(super) fn renderer(&self) -> &str {
        self.resources
            .as_ref()
            .map_or("", |resources| &resources.renderer)
    }

    /// Whether the surface has no pixels.
    pub(super) fn is_empty(&self) -> bool {
        self.surface.min_element() == 0
    }

    /// Whether the window is an icon, as far as the display says.
    pub(super) fn is_minimized(&self) -> bool {
        self.window.is_minimized() == Some(true)
    }

    /// Whether the window lies on the screen, as far as the display says: behind others, perhaps,
    /// but not on another workspace whose windows are unmapped.
    pub(super) fn is_viewable(&self) -> bool {
        #[cfg(all(unix, not(target_vendor = "apple")))]
        let viewable = self.x11.as_ref().is_none_or(X11Window::is_viewable);
        #[cfg(not(all(unix, not(target_vendor = "apple"))))]
        let viewable = true;
        viewable
    }

    /// The window has a new size, in pixels.
    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) {
        let surface = UVec2::new(size.width, size.height);
        self.growth.resized(surface);
        self.restart_checks();
        self.change(|gl_window| gl_window.surface = surface);
        let size = (NonZeroU32::new(size.width), NonZeroU32::new(size.height));
        if let (Some(resources), (Some(width), Some(height))) = (&self.resources, size) {
            resources.surface.resize(&resources.context, width, height);
        }
    }

    /// Opens or closes the panel. The window grows by what the panel needs, where it may, and
    /// shrinks again.
    pub(super) fn show_panel(&mut self, open: bool) {
        if self.panel == open {
            return;
        }
        let side = self.zoom_to_fit().size.x;
        self.change(|gl_window| gl_window.panel = open);
        if self.is_empty() {
            return;
        }
        let (window, surface) = (&self.window, self.surface);
        let size = if open {
            let wanted = with_panel(surface, self.picture, side, panel::wanted(self.cell()));
            self.growth.grow(window, surface, wanted)
        } else {
            self.growth.shrink(window, surface)
        };
        if let Some(size) = size {
            self.resize(size);
        }
    }

    /// Until when a new size of the window is awaited, if one is.
    pub(super) fn awaits_size(&mut self, now: Instant) -> Option<Instant> {
        self.growth.awaited(now)
    }

    /// Changes what the layout depends on: what was in the middle of the picture's part stays
    /// there.
    fn change(&mut self, change: impl FnOnce(&mut GlWindow)) {
        let before = self.layout().picture.size();
        change(self);
        let after = self.layout().picture.size();
        self.zoom.resize(before, after);
    }

    /// The window and its parts.
    pub(super) fn layout(&self) -> Layout {
        let wanted = self.panel.then(|| panel::wanted(self.cell()));
        Layout::new(self.surface, self.picture, wanted)
    }

    pub(super) fn surface(&self) -> UVec2 {
        self.surface
    }

    /// Where the whole picture lies in its part of the window.
    fn zoom_to_fit(&self) -> Placement {
        Placement::fit(self.layout().picture.size(), self.picture)
    }

    /// The bottom left corner of the picture's part of the window, counted from the window's.
    fn corner(&self, part: Rect) -> IVec2 {
        IVec2::new(part.min.x, self.surface.y as i32 - part.max.y)
    }

    /// Where the picture lies in the window.
    fn placement(&self) -> Placement {
        let part = self.layout().picture;
        let mut placement = self.zoom.placement(part.size(), self.picture);
        placement.origin += self.corner(part);
        placement
    }

    /// Zooms around `pointer`, a pixel of the window, by so many steps; outward where they are
    /// negative.
    pub(super) fn zoom(&mut self, steps: i32, pointer: IVec2) {
        let part = self.layout().picture;
        let pointer = pointer - self.corner(part);
        self.zoom.by(steps, pointer, part.size(), self.picture);
    }

    /// Moves the picture by so many pixels.
    pub(super) fn drag(&mut self, by: IVec2) {
        let part = self.layout().picture;
        self.zoom.drag(by, part.size(), self.picture);
    }

    /// Shows the whole picture.
    pub(super) fn fit(&mut self) {
        self.zoom.fit();
    }

    /// The pixel of the window at a place that winit names: both count from 0, but ours from the
    /// bottom.
    pub(super) fn window_pixel(&self, place: PhysicalPosition<f64>) -> IVec2 {
        let (x, y) = (place.x.floor() as i32, place.y.floor() as i32);
        IVec2::new(x, self.surface.y as i32 - 1 - y)
    }

    /// How long the monitor shows a frame: 1/60 s where it does not say.
    pub(super) fn frame_time(&self) -> Duration {
        let millihertz = self
            .window
            .current_monitor()
            .and_then(|monitor| monitor.refresh_rate_millihertz())
            .filter(|&millihertz| millihertz > 0)
            .unwrap_or(60_000);
        Duration::from_secs(1000) / millihertz
    }

    pub(super) fn is_full_screen(&self) -> bool {
        self.window.fullscreen().is_some()
    }

    pub(super) fn toggle_full_screen(&self) {
        let wanted = match self.window.fullscreen() {
            Some(_) => None,
            None => Some(Fullscreen::Borderless(None)),
        };
        self.window.set_fullscreen(wanted);
    }

    /// Replaces rows of the picture, counted from the bottom, by those of `image`. What it took;
    /// where `waits`, until it is done.
    pub(super) fn upload(
        &mut self,
        image: &Raster,
        rows: Range<u32>,
        waits: bool,
    ) -> Result<Duration, ViewerError> {
        let Some(resources) = &mut self.resources else {
            return Err(ViewerError::Lost);
        };
        let start = Instant::now();
        resources.screen.upload_rows(image, rows)?;
        if waits {
            resources.screen.finish();
        }
        Ok(start.elapsed())
    }

    /// Draws `image`, which is uploaded, and finds the first pixel that the driver shows wrong:
    /// once in each size of the window.
    ///
    /// A window that is just being resized on the display may hold anything for some frames. So the
    /// first frames that are presented in a size are not checked, and wrong pixels are checked
    /// again in the next frames before the driver is called wrong.
    pub(super) fn check_pixels(&mut self, image: &Raster) -> Option<Differs> {
        let (placement, surface) = (self.placement(), self.surface);
        let resources = self.resources.as_ref()?;
        // A surface of fewer bits shows other bytes.
        let has_eight_bits = self.config.color_buffer_type() == Some(EIGHT_BITS);
        let is_new = self.presented > self.checked_at;
        if self.checks_left == 0 || !is_new || self.is_empty() || !has_eight_bits {
            return None;
        }
        self.checked_at = self.presented;
        resources.screen.draw(surface, placement);
        let differs = resources.screen.first_difference(surface, placement, image);
        let size = self.window.inner_size();
        self.checks_left = match differs {
            None => 0,
            Some(_) => self.checks_left - 1,
        };
        let is_settled = UVec2::new(size.width, size.height) == surface;
        differs.filter(|_| self.checks_left == 0 && is_settled)
    }

    /// Checks the pixels anew: the surface has another size, or is another one.
    fn restart_checks(&mut self) {
        self.checks_left = CHECKS;
        self.presented = 0;
        self.checked_at = UNCHECKED;
    }

    /// Draws the picture, `marks` over it, and `text_boxes` over that. What it took, once it is on
    /// the way to the display; where `waits`, until it is done. `None` says that the surface was
    /// lost and everything on it made anew, so that a picture must be uploaded again.
    pub(super) fn draw(
        &mut self,
        (marks, text_boxes): (&[Mark], Vec<TextBox>),
        waits: bool,
    ) -> Result<Option<Duration>, ViewerError> {
        let (placement, surface) = (self.placement(), self.surface);
        let (part, cell) = (self.layout().picture, self.cell());
        let Some(resources) = &mut self.resources else {
            return Err(ViewerError::Lost);
        };
        let start = Instant::now();
        resources.screen.draw(surface, placement);
        for (rect, color) in marks {
            let rect = rect.intersection(part);
            if !rect.is_empty() {
                let corner = IVec2::new(rect.min.x, surface.y as i32 - rect.max.y);
                resources.screen.fill(corner, rect.size(), *color);
            }
        }
        if !text_boxes.is_empty() || resources.overlay.is_some() {
            let gl = resources.gl.clone();
            let overlay = resources
                .overlay
                .get_or_insert_with(|| Overlay::new(gl, cell));
            overlay.draw(surface.y, cell, text_boxes)?;
        }
        if waits {
            resources.screen.finish();
        }
        let time = start.elapsed();
        Ok(self.present()?.then_some(time))
    }

    /// Draws a window without a picture.
    pub(super) fn clear(&mut self) -> Result<(), ViewerError> {
        if let Some(resources) = &self.resources {
            resources.screen.draw(self.surface, Placement::NOWHERE);
        }
        self.present().map(drop)
    }

    fn present(&mut self) -> Result<bool, ViewerError> {
        let Some(resources) = &mut self.resources else {
            return Err(ViewerError::Lost);
        };
        self.window.pre_present_notify();
        if resources.surface.swap_buffers(&resources.context).is_ok() {
            self.presented += 1;
            return Ok(true);
        }
        match self.renew() {
            Ok(()) => Ok(false),
            Err(Failure::OpenGl(_)) => Err(ViewerError::Lost),
            Err(Failure::Viewer(error)) => Err(error),
        }
    }

    /// The width and height of a character in pixels: 7 × 14 logical ones.
    pub(super) fn cell(&self) -> UVec2 {
        cell(self.window.scale_factor())
    }

    /// The pixel of the picture, column and row, that the pixel `window` of the window shows.
    pub(super) fn picture_pixel(&self, window: IVec2) -> Option<UVec2> {
        let part = self.layout().picture;
        let shown = part.contains(self.place_of(window));
        shown.then(|| self.placement().pixel_at(window, self.picture))?
    }

    /// Whether the panel is at the pixel `window` of the window.
    pub(super) fn is_over_panel(&self, window: IVec2) -> bool {
        let panel = self.layout().panel;
        panel.is_some_and(|panel| panel.contains(self.place_of(window)))
    }

    /// The place of the pixel `window` of the window, counted from its top left corner.
    pub(super) fn place_of(&self, window: IVec2) -> IVec2 {
        IVec2::new(window.x, self.surface.y as i32 - 1 - window.y)
    }

    /// The rectangle of the window that shows a pixel of the picture.
    pub(super) fn rectangle(&self, pixel: UVec2) -> Rect {
        let [first, end] = self.placement().rectangle_of(pixel, self.picture);
        let height = self.surface.y as i32;
        Rect {
            min: IVec2::new(first.x, height - end.y),
            max: IVec2::new(end.x, height - first.y),
        }
    }
}

/// A window that a desktop knows by the program's name: app_id on Wayland, WM_CLASS on X11.
#[cfg(all(unix, not(target_vendor = "apple")))]
fn named(attributes: WindowAttributes) -> WindowAttributes {
    use winit::platform::wayland::WindowAttributesExtWayland as _;
    attributes.with_name("firsthit", "firsthit")
}

/// A rectangle of the window in one colour, over the picture.
pub(super) type Mark = (Rect, [u8; 3]);

impl GlResources {
    fn new(
        config: &Config,
        window: &Window,
        size: UVec2,
        picture: UVec2,
    ) -> Result<GlResources, Failure> {
        let display = config.display();
        let handle = window.window_handle()?.as_raw();
        let attributes = ContextAttributesBuilder::new()
            .with_profile(GlProfile::Core)
            .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
            .build(Some(handle));
        // SAFETY: the handle is of a window that outlives this context.
        let context = unsafe { display.create_context(config, &attributes) }?;
        // A window of no size yet still needs a surface of some.
        let side = |length: u32| NonZeroU32::new(length).unwrap_or(NonZeroU32::MIN);
        let attributes = SurfaceAttributesBuilder::<WindowSurface>::new().build(
            handle,
            side(size.x),
            side(size.y),
        );
        // SAFETY: as above.
        let surface = unsafe { display.create_window_surface(config, &attributes) }?;
        let context = context.make_current(&surface)?;
        // On Wayland a swap that waits would wait for ever while the window is hidden; there the
        // compositor asks for each frame. Where a driver knows no interval, the clock alone
        // paces the animation.
        let interval = match window.display_handle()?.as_raw() {
            RawDisplayHandle::Wayland(_) => SwapInterval::DontWait,
            _ => SwapInterval::Wait(NonZeroU32::MIN),
        };
        let _ = surface.set_swap_interval(&context, interval);
        let gl = functions(&display)?;
        // SAFETY: the context is current; every context has these two names.
        let renderer = unsafe { gl.get_parameter_string(glow::RENDERER) };
        let gl = Rc::new(gl);
        // SAFETY: the context is current, and stays so; where it is lost, the drop of what holds
        // both makes it current before the screen's.
        let screen = unsafe { Screen::new(gl.clone(), picture) }.map_err(ViewerError::from)?;
        Ok(GlResources {
            overlay: None,
            gl,
            screen,
            renderer,
            surface,
            context,
        })
    }
}

impl Drop for GlResources {
    fn drop(&mut self) {
        // Freeing the screen needs its context. Where it is lost, there is nothing left to free.
        let _ = self.context.make_current(&self.surface);
    }
}
