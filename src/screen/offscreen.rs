//! A screen without a window: pictures are drawn by OpenGL and read back.

use std::ops::Range;
use std::rc::Rc;

use bytemuck::cast_slice_mut;
use glam::{IVec2, UVec2};
use glow::HasContext as _;

use super::context::{Context, Profile};
#[cfg(not(target_vendor = "apple"))]
use super::egl::Egl;
use super::osmesa::OsMesa;
use super::{Placement, Screen, ScreenError, check, driver_limits};
use crate::Image;

/// The library that makes the context of an [`Offscreen`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// EGL on a device, without a surface: libEGL.
    Egl,
    /// Mesa's software renderer as a library: libOSMesa.
    OsMesa,
}

impl Backend {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Backend::Egl => "egl",
            Backend::OsMesa => "osmesa",
        }
    }

    /// A context for pictures of `size` × `size` pixels.
    pub(super) fn open(self, profile: Profile, size: u32) -> Result<Box<dyn Context>, ScreenError> {
        driver_limits::check(u64::from(size).pow(2))?;
        Ok(match self {
            #[cfg(not(target_vendor = "apple"))]
            Backend::Egl => Box::new(Egl::open(profile)?),
            #[cfg(target_vendor = "apple")]
            Backend::Egl => return Err(ScreenError::NoEgl),
            Backend::OsMesa => Box::new(OsMesa::open(profile)?),
        })
    }
}

/// A [`Screen`] in a context and a float framebuffer of its own.
///
/// Several may live in one thread. Making, using and dropping one leaves **no** context current:
/// EGL and OSMesa may share one place for "the current context" without telling each other, so
/// nothing is left there to be mistaken. For the same reason, who has made another context current
/// on this thread should release it first.
pub struct Offscreen {
    // Dropped in this order: what belongs to the context before the context.
    framebuffer: Framebuffer,
    screen: Screen,
    context: Box<dyn Context>,
}

impl Offscreen {
    /// A context of `backend`, with all that pictures of `size` × `size` pixels need.
    ///
    /// # Errors
    /// [`ScreenError::Missing`] and [`ScreenError::Context`] where there is no such context, else
    /// those of [`Screen::new`].
    pub fn open(backend: Backend, size: u32) -> Result<Offscreen, ScreenError> {
        let context = backend.open(Profile::Core, size)?;
        context.make_current()?;
        let made = Offscreen::make(context.as_ref(), size);
        context.release();
        let (screen, framebuffer) = made?;
        Ok(Offscreen {
            framebuffer,
            screen,
            context,
        })
    }

    fn make(context: &dyn Context, size: u32) -> Result<(Screen, Framebuffer), ScreenError> {
        let gl = Rc::new(context.functions()?);
        // SAFETY: the context is current, and made current again before the screen is used or
        // dropped.
        let screen = unsafe { Screen::new(gl.clone(), UVec2::splat(size)) }?;
        let rows = size.min(MAX_PIXELS / size);
        let framebuffer = Framebuffer::new(gl, UVec2::new(size, rows), glow::RGBA32F)?;
        Ok((screen, framebuffer))
    }

    /// Uploads `image`, draws it pixel for pixel, and reads back what was drawn: the same samples,
    /// bit for bit, from a driver that does what OpenGL asks of it.
    ///
    /// # Errors
    /// Those of [`Screen::upload`]; [`ScreenError::Image`] where there is no memory for the picture
    /// that is read back.
    pub fn show(&mut self, image: &Image) -> Result<Image, ScreenError> {
        self.show_rows(image, 0..image.size())
    }

    /// The same with only some rows uploaded, as by [`Screen::upload_rows`]: the others come back
    /// as they were uploaded before.
    ///
    /// # Errors
    /// As [`Offscreen::show`].
    pub fn show_rows(&mut self, image: &Image, rows: Range<u32>) -> Result<Image, ScreenError> {
        self.context.make_current()?;
        let shown = self
            .screen
            .upload_rows(image, rows)
            .and_then(|()| self.framebuffer.read(&self.screen));
        self.context.release();
        shown
    }
}

impl Drop for Offscreen {
    fn drop(&mut self) {
        // The fields that are dropped next need their context. Without it, no context is safer for
        // them than another one.
        if self.context.make_current().is_err() {
            self.context.release();
        }
    }
}

/// The most pixels of a float [`Framebuffer`]: 64 MiB of floats, where a whole picture of the
/// largest size would take 4 GiB.
const MAX_PIXELS: u32 = 1 << 22;

/// A framebuffer as wide as the picture, of as many rows as are drawn and read back at a time.
///
/// Red, green, blue and alpha, because OpenGL need not render to floats without alpha.
pub(super) struct Framebuffer {
    gl: Rc<glow::Context>,
    framebuffer: glow::Framebuffer,
    renderbuffer: glow::Renderbuffer,
    size: UVec2,
}

impl Framebuffer {
    /// `size` is its width and height, `format` its internal format.
    pub(super) fn new(
        gl: Rc<glow::Context>,
        size: UVec2,
        format: u32,
    ) -> Result<Framebuffer, ScreenError> {
        // SAFETY: the context is current.
        let framebuffer = unsafe { gl.create_framebuffer() }
            .map_err(|reason| ScreenError::refused("a framebuffer", &reason))?;
        // SAFETY: the context is current.
        let renderbuffer = unsafe { gl.create_renderbuffer() }
            .map_err(|reason| ScreenError::refused("a renderbuffer", &reason))?;
        let framebuffer = Framebuffer {
            gl,
            framebuffer,
            renderbuffer,
            size,
        };
        framebuffer.allocate(format)?;
        Ok(framebuffer)
    }

    fn allocate(&self, format: u32) -> Result<(), ScreenError> {
        let what = "a framebuffer as large as the picture";
        let gl = &self.gl;
        // SAFETY: the context is current and the names are of it.
        let status = unsafe {
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(self.renderbuffer));
            gl.renderbuffer_storage(
                glow::RENDERBUFFER,
                format,
                self.size.x as i32,
                self.size.y as i32,
            );
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer));
            gl.framebuffer_renderbuffer(
                glow::FRAMEBUFFER,
                glow::COLOR_ATTACHMENT0,
                glow::RENDERBUFFER,
                Some(self.renderbuffer),
            );
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
        check(gl, what, UVec2::splat(self.size.x))?;
        if status != glow::FRAMEBUFFER_COMPLETE {
            let reason = format!("framebuffer status {status:#06x}");
            return Err(ScreenError::refused(what, &reason));
        }
        Ok(())
    }

    /// Binds the framebuffer to be drawn into and read from.
    pub(super) fn bind(&self) {
        // SAFETY: the context is current and the name is of it.
        unsafe {
            self.gl
                .bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer))
        };
    }

    /// The picture that `screen` draws, one pixel of the framebuffer for each texel.
    fn read(&self, screen: &Screen) -> Result<Image, ScreenError> {
        let (gl, size) = (&self.gl, self.size.x);
        let mut image = Image::new(size)?;
        let band = self.size.y as usize * size as usize * 3;
        let mut placement = Placement {
            origin: IVec2::ZERO,
            size: UVec2::splat(size),
        };
        for samples in image.samples_mut().chunks_mut(band) {
            let rows = samples.len() / (size as usize * 3);
            self.bind();
            screen.draw(self.size, placement);
            // SAFETY: the context is current. Its pixel-store parameters are as they were made, so
            // that the driver writes size × rows × 3 floats without a gap, and so many
            // are there.
            unsafe {
                gl.read_pixels(
                    0,
                    0,
                    size as i32,
                    rows as i32,
                    glow::RGB,
                    glow::FLOAT,
                    glow::PixelPackData::Slice(Some(cast_slice_mut(samples))),
                );
            }
            placement.origin.y -= self.size.y as i32;
        }
        check(
            gl,
            "to draw the picture and read it back",
            UVec2::splat(size),
        )?;
        Ok(image)
    }
}

impl Drop for Framebuffer {
    fn drop(&mut self) {
        // SAFETY: both names were made here and nothing else deletes them.
        unsafe {
            self.gl.delete_framebuffer(self.framebuffer);
            self.gl.delete_renderbuffer(self.renderbuffer);
        }
    }
}
