//! The window, its OpenGL context, and the screen in it.

mod opengl;

use std::num::NonZeroU32;
use std::ops::Range;
use std::rc::Rc;
use std::time::{Duration, Instant};

use egui::{Pos2, Rect};
use glam::{IVec2, UVec2};
use glow::HasContext as _;
use glutin::config::Config;
use glutin::context::{
    ContextApi, ContextAttributesBuilder, GlProfile, PossiblyCurrentContext, Version,
};
use glutin::display::GetGlDisplay as _;
use glutin::prelude::*;
use glutin::surface::{Surface, SurfaceAttributesBuilder, SwapInterval, WindowSurface};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle, RawDisplayHandle};
use winit::dpi::{PhysicalPosition, PhysicalSize};
use winit::event_loop::ActiveEventLoop;
use winit::window::{Fullscreen, Window, WindowAttributes};

use crate::Image;
use crate::screen::{Placement, Screen};

use super::ViewerError;
use super::overlay::Overlay;
use super::sheet::{Facts, Sheet};
use super::zoom::Zoom;
use opengl::{Failure, config, display, functions};

/// The window and everything that draws in it.
pub(super) struct View {
    /// `None` only while it is being replaced.
    drawing: Option<Drawing>,
    config: Config,
    window: Window,
    /// The width and height of the surface in pixels; 0 where the window shows none.
    surface: UVec2,
    /// N of the pictures that are shown.
    picture: u32,
    zoom: Zoom,
}

/// What is lost when the context is. Freed in this order: the screen needs the context.
struct Drawing {
    /// Made when there is something to write over the picture.
    overlay: Option<Overlay>,
    screen: Screen,
    renderer: String,
    surface: Surface<WindowSurface>,
    context: PossiblyCurrentContext,
}

impl View {
    /// Opens a window for pictures of `picture` × `picture` pixels: of that size where it fits the monitor, else the largest square that does.
    pub(super) fn open(event_loop: &ActiveEventLoop, picture: u32) -> Result<View, ViewerError> {
        let monitor = event_loop
            .primary_monitor()
            .or_else(|| event_loop.available_monitors().next())
            .map(|monitor| monitor.size())
            .filter(|size| size.width > 0 && size.height > 0);
        let side = monitor.map_or(picture, |size| picture.min(size.width).min(size.height));
        let attributes = Window::default_attributes()
            .with_title("firsthit")
            .with_inner_size(PhysicalSize::new(side, side));
        let mut reasons = Vec::new();
        for prefer_egl in [false, true] {
            match View::open_with(event_loop, &attributes, picture, prefer_egl) {
                Ok(view) => return Ok(view),
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
        picture: u32,
        prefer_egl: bool,
    ) -> Result<View, Failure> {
        let create = |config: Option<&Config>| match config {
            Some(config) => glutin_winit::finalize_window(event_loop, attributes.clone(), config),
            None => event_loop.create_window(attributes.clone()),
        };
        // Windows has no display without a window; elsewhere the display says what kind of window it can draw in.
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
        let mut view = View {
            drawing: None,
            config,
            window,
            surface: UVec2::new(size.width, size.height),
            picture,
            zoom: Zoom::default(),
        };
        view.renew()?;
        Ok(view)
    }

    /// Makes surface, context and screen, anew where they were lost. The screen's texture is empty after it.
    fn renew(&mut self) -> Result<(), Failure> {
        self.drawing = None;
        self.drawing = Some(Drawing::new(
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
        self.drawing
            .as_ref()
            .map_or("", |drawing| &drawing.renderer)
    }

    /// Whether there is not a pixel to draw on.
    pub(super) fn is_empty(&self) -> bool {
        self.surface.min_element() == 0
    }

    /// Whether the window is an icon, as far as the display says.
    pub(super) fn is_minimized(&self) -> bool {
        self.window.is_minimized() == Some(true)
    }

    /// The window has a new size, in pixels.
    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) {
        let surface = UVec2::new(size.width, size.height);
        self.zoom.resize(self.surface, surface);
        self.surface = surface;
        let size = (NonZeroU32::new(size.width), NonZeroU32::new(size.height));
        if let (Some(drawing), (Some(width), Some(height))) = (&self.drawing, size) {
            drawing.surface.resize(&drawing.context, width, height);
        }
    }

    /// Where the picture lies.
    fn placement(&self) -> Placement {
        self.zoom.placement(self.surface, self.picture)
    }

    /// Zooms around `pointer`, a pixel of the window, by so many steps; outward where they are negative.
    pub(super) fn zoom(&mut self, steps: i32, pointer: IVec2) {
        self.zoom.by(steps, pointer, self.surface, self.picture);
    }

    /// Moves the picture by so many pixels.
    pub(super) fn drag(&mut self, by: IVec2) {
        self.zoom.drag(by, self.surface, self.picture);
    }

    /// Shows the whole picture.
    pub(super) fn fit(&mut self) {
        self.zoom.fit();
    }

    /// The pixel of the window at a place that winit names: both count from 0, but ours from the bottom.
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

    pub(super) fn toggle_full_screen(&self) {
        let wanted = match self.window.fullscreen() {
            Some(_) => None,
            None => Some(Fullscreen::Borderless(None)),
        };
        self.window.set_fullscreen(wanted);
    }

    /// Replaces rows of the picture, counted from the bottom, by those of `image`. What it took; where `waits`, until it is done.
    pub(super) fn upload(
        &mut self,
        image: &Image,
        rows: Range<u32>,
        waits: bool,
    ) -> Result<Duration, ViewerError> {
        let Some(drawing) = &mut self.drawing else {
            return Err(ViewerError::Lost);
        };
        let start = Instant::now();
        drawing.screen.upload_rows(image, rows)?;
        if waits {
            drawing.screen.finish();
        }
        Ok(start.elapsed())
    }

    /// Draws the picture, and `sheet` over it. What it took, once it is on the way to the display; where `waits`, until it is done. `None`
    /// says that the surface was lost and everything on it made anew, so that a picture must be uploaded again.
    pub(super) fn draw(
        &mut self,
        (sheet, facts): (&mut Sheet, &Facts),
        waits: bool,
    ) -> Result<Option<Duration>, ViewerError> {
        let (placement, surface) = (self.placement(), self.surface);
        let scale = self.scale();
        let Some(drawing) = &mut self.drawing else {
            return Err(ViewerError::Lost);
        };
        let start = Instant::now();
        drawing.screen.draw(surface, placement);
        if !sheet.is_empty() || facts.errors.is_some() {
            let overlay = match drawing.overlay.take() {
                Some(overlay) => overlay,
                None => Overlay::new(functions(&self.config.display()))?,
            };
            let overlay = drawing.overlay.insert(overlay);
            overlay.draw(surface, scale, |context| sheet.lay_out(context, facts));
        }
        if waits {
            drawing.screen.finish();
        }
        let time = start.elapsed();
        Ok(self.present()?.then_some(time))
    }

    /// Draws a window without a picture.
    pub(super) fn clear(&mut self) -> Result<(), ViewerError> {
        if let Some(drawing) = &self.drawing {
            drawing.screen.draw(self.surface, Placement::NOWHERE);
        }
        self.present().map(drop)
    }

    fn present(&mut self) -> Result<bool, ViewerError> {
        let Some(drawing) = &mut self.drawing else {
            return Err(ViewerError::Lost);
        };
        self.window.pre_present_notify();
        if drawing.surface.swap_buffers(&drawing.context).is_ok() {
            return Ok(true);
        }
        match self.renew() {
            Ok(()) => Ok(false),
            Err(Failure::OpenGl(_)) => Err(ViewerError::Lost),
            Err(Failure::Viewer(error)) => Err(error),
        }
    }

    /// Pixels to a point.
    fn scale(&self) -> f32 {
        self.window.scale_factor() as f32
    }

    /// The pixel of the picture, column and row, that the pixel `window` of the window shows.
    pub(super) fn picture_pixel(&self, window: IVec2) -> Option<UVec2> {
        self.placement().pixel_at(window, self.picture)
    }

    /// The place of the middle of the pixel `window`, in points from the top left corner.
    pub(super) fn in_points(&self, window: IVec2) -> Pos2 {
        let top = self.surface.y as i32 - 1 - window.y;
        Pos2::new(window.x as f32 + 0.5, top as f32 + 0.5) / self.scale()
    }

    /// The square that shows a pixel of the picture, in points from the top left corner.
    pub(super) fn square_in_points(&self, pixel: UVec2) -> Rect {
        let [first, end] = self.placement().square_of(pixel, self.picture);
        let height = self.surface.y as i32;
        Rect::from_min_max(
            Pos2::new(first.x as f32, (height - end.y) as f32) / self.scale(),
            Pos2::new(end.x as f32, (height - first.y) as f32) / self.scale(),
        )
    }
}

impl Drawing {
    fn new(
        config: &Config,
        window: &Window,
        size: UVec2,
        picture: u32,
    ) -> Result<Drawing, Failure> {
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
        // On Wayland a swap that waits would wait for ever while the window is hidden; there the compositor asks for each frame. Where a
        // driver knows no interval, the clock alone paces the animation.
        let interval = match window.display_handle()?.as_raw() {
            RawDisplayHandle::Wayland(_) => SwapInterval::DontWait,
            _ => SwapInterval::Wait(NonZeroU32::MIN),
        };
        let _ = surface.set_swap_interval(&context, interval);
        let gl = functions(&display);
        // SAFETY: the context is current; every context has these two names.
        let renderer = unsafe { gl.get_parameter_string(glow::RENDERER) };
        let screen = Screen::new(Rc::new(gl), picture).map_err(ViewerError::from)?;
        Ok(Drawing {
            overlay: None,
            screen,
            renderer,
            surface,
            context,
        })
    }
}

impl Drop for Drawing {
    fn drop(&mut self) {
        // Freeing the screen needs its context. Where it is lost, there is nothing left to free.
        let _ = self.context.make_current(&self.surface);
    }
}
