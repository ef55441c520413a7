//! What a displayed frame costs, step by step: as this crate draws it, and as the document does.

use std::ffi::c_void;
use std::ops::Range;
use std::rc::Rc;
use std::time::{Duration, Instant};

use glam::{IVec2, UVec2};
use glow::HasContext as _;

use super::context::{Context, Profile};
use super::offscreen::Framebuffer;
use super::{Backend, CLEAR_COLOR, FRAGMENT_CAPABILITIES, Placement, Screen, ScreenError};
use super::{check, set_unpacking};
use crate::{Image, memory};

/// How pictures are drawn into a framebuffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DrawMethod {
    /// As a retained texture, drawn on a quad, in a core context: a [`Screen`].
    Texture,
    /// By `glDrawPixels`, as the document does, in a compatibility context.
    DrawPixels,
}

impl DrawMethod {
    /// Both.
    pub(crate) const ALL: [DrawMethod; 2] = [DrawMethod::Texture, DrawMethod::DrawPixels];

    /// "texture" or "glDrawPixels".
    pub(crate) fn name(self) -> &'static str {
        match self {
            DrawMethod::Texture => "texture",
            DrawMethod::DrawPixels => "glDrawPixels",
        }
    }
}

/// The times of a displayed frame. Each step is waited for (`glFinish`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cost {
    /// The texture's new samples; nothing for [`DrawMethod::DrawPixels`].
    pub(crate) upload: Duration,
    /// Clearing and drawing.
    pub(crate) draw: Duration,
    /// Reading back what was drawn.
    pub(crate) read_back: Duration,
}

/// A framebuffer of 8 bits a sample, as a window's, in a context of its own, and one method of
/// drawing into it.
///
/// As with [`Offscreen`](super::Offscreen), no context is current before and after each call.
pub(crate) struct TimedScreen {
    // Dropped in this order: what belongs to the context before the context.
    framebuffer: Framebuffer,
    drawing: Drawing,
    gl: Rc<glow::Context>,
    size: u32,
    /// Red, green, blue and alpha of every pixel shown last, rows from the bottom; nothing before
    /// the first.
    bytes: Vec<u8>,
    context: Box<dyn Context>,
}

/// What draws by a [`DrawMethod`].
enum Drawing {
    Texture(Screen),
    DrawPixels(DrawPixels),
}

/// Functions that a core context no longer has.
#[derive(Clone, Copy)]
struct DrawPixels {
    window_pos: unsafe extern "system" fn(i32, i32),
    draw_pixels: unsafe extern "system" fn(i32, i32, u32, u32, *const c_void),
}

impl DrawPixels {
    fn load(context: &dyn Context) -> Result<DrawPixels, ScreenError> {
        let address = |name| {
            let address = context.proc_address(name);
            (!address.is_null())
                .then_some(address)
                .ok_or_else(|| ScreenError::refused("glDrawPixels", "there is no such function"))
        };
        let (window_pos, draw_pixels) = (address(c"glWindowPos2i")?, address(c"glDrawPixels")?);
        // SAFETY: the addresses are those of the functions of these names, and the types are what
        // OpenGL 1.4 declares for them.
        unsafe {
            Ok(DrawPixels {
                window_pos: std::mem::transmute::<*const c_void, unsafe extern "system" fn(i32, i32)>(
                    window_pos,
                ),
                draw_pixels: std::mem::transmute::<
                    *const c_void,
                    unsafe extern "system" fn(i32, i32, u32, u32, *const c_void),
                >(draw_pixels),
            })
        }
    }

    /// Clears the bound framebuffer and draws `image` into its corner.
    fn draw(self, gl: &glow::Context, image: &Image) {
        let size = image.size() as i32;
        let [red, green, blue, alpha] = CLEAR_COLOR;
        set_unpacking(gl);
        // SAFETY: the context is current and has the two functions; with these pixel-store
        // parameters the driver reads exactly size × size × 3 floats, and so many an image
        // of this size has.
        unsafe {
            for capability in FRAGMENT_CAPABILITIES {
                gl.disable(capability);
            }
            gl.clear_color(red, green, blue, alpha);
            gl.clear(glow::COLOR_BUFFER_BIT);
            (self.window_pos)(0, 0);
            (self.draw_pixels)(
                size,
                size,
                glow::RGB,
                glow::FLOAT,
                image.samples().as_ptr().cast(),
            );
        }
    }
}

impl TimedScreen {
    /// A screen for pictures of `size` × `size` pixels.
    ///
    /// # Errors
    /// Those of [`Offscreen::open`](super::Offscreen::open).
    pub(crate) fn open(
        backend: Backend,
        method: DrawMethod,
        size: u32,
    ) -> Result<TimedScreen, ScreenError> {
        let profile = match method {
            DrawMethod::Texture => Profile::Core,
            DrawMethod::DrawPixels => Profile::Compatibility,
        };
        let context = backend.open(profile, size)?;
        context.make_current()?;
        let made = TimedScreen::make(context.as_ref(), method, size);
        context.release();
        let (framebuffer, drawing, gl) = made?;
        Ok(TimedScreen {
            framebuffer,
            drawing,
            gl,
            size,
            bytes: Vec::new(),
            context,
        })
    }

    fn make(
        context: &dyn Context,
        method: DrawMethod,
        size: u32,
    ) -> Result<(Framebuffer, Drawing, Rc<glow::Context>), ScreenError> {
        let gl = Rc::new(context.functions()?);
        let drawing = match method {
            DrawMethod::Texture => {
                let size = UVec2::splat(size);
                // SAFETY: the context is current, and made current again before the screen is used
                // or dropped.
                Drawing::Texture(unsafe { Screen::new(gl.clone(), size) }?)
            }
            DrawMethod::DrawPixels => Drawing::DrawPixels(DrawPixels::load(context)?),
        };
        let framebuffer = Framebuffer::new(gl.clone(), UVec2::splat(size), glow::RGBA8)?;
        Ok((framebuffer, drawing, gl))
    }

    /// Shows `image`, and says what each step cost. Of a texture only `rows` are replaced, as by
    /// [`Screen::upload_rows`].
    ///
    /// # Errors
    /// [`ScreenError`] unless `image` has the size of the screen and the driver takes it.
    pub(crate) fn show(&mut self, image: &Image, rows: Range<u32>) -> Result<Cost, ScreenError> {
        self.context.make_current()?;
        let cost = self.steps(image, rows);
        self.context.release();
        cost
    }

    fn steps(&mut self, image: &Image, rows: Range<u32>) -> Result<Cost, ScreenError> {
        if image.size() != self.size {
            return Err(ScreenError::Size {
                image: UVec2::splat(image.size()),
                screen: UVec2::splat(self.size),
            });
        }
        self.framebuffer.bind();
        let start = Instant::now();
        if let Drawing::Texture(screen) = &mut self.drawing {
            screen.upload_rows(image, rows)?;
            self.finish();
        }
        let uploaded = Instant::now();
        match &self.drawing {
            Drawing::Texture(screen) => screen.draw(
                UVec2::splat(self.size),
                Placement {
                    origin: IVec2::ZERO,
                    size: UVec2::splat(self.size),
                },
            ),
            Drawing::DrawPixels(functions) => functions.draw(&self.gl, image),
        }
        self.finish();
        let drawn = Instant::now();
        self.read_back()?;
        let read = Instant::now();
        let size = UVec2::splat(self.size);
        check(&self.gl, "to draw the picture and read it back", size)?;
        let upload = match self.drawing {
            Drawing::Texture(_) => uploaded - start,
            Drawing::DrawPixels(_) => Duration::ZERO,
        };
        Ok(Cost {
            upload,
            draw: drawn - uploaded,
            read_back: read - drawn,
        })
    }

    fn finish(&self) {
        // SAFETY: the context is current.
        unsafe { self.gl.finish() };
    }

    fn read_back(&mut self) -> Result<(), ScreenError> {
        let length = self.size as usize * self.size as usize * 4;
        let missing = length - self.bytes.len();
        memory::reserve(&mut self.bytes, missing).map_err(|_| ScreenError::Memory {
            size: UVec2::splat(self.size),
        })?;
        self.bytes.resize(length, 0);
        // SAFETY: the context is current. Its pixel-store parameters are as they were made, and
        // rows of four bytes a pixel have no gaps at any alignment, so that the driver
        // writes as many bytes as are there.
        unsafe {
            self.gl.read_pixels(
                0,
                0,
                self.size as i32,
                self.size as i32,
                glow::RGBA,
                glow::UNSIGNED_BYTE,
                glow::PixelPackData::Slice(Some(&mut self.bytes)),
            );
        }
        Ok(())
    }
}

impl Drop for TimedScreen {
    fn drop(&mut self) {
        // The fields that are dropped next need their context. Without it, no context is safer for
        // them than another one.
        if self.context.make_current().is_err() {
            self.context.release();
        }
    }
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::explicit_write,
    reason = "a test stops at the first surprise, and says what it leaves out"
)]
mod tests {
    use std::io::Write as _;

    use super::*;
    use crate::image::display_byte;

    /// A picture whose samples grow by equal steps in this order, from below 0 to above 1.
    fn ramp(order: impl Fn(usize) -> usize) -> Image {
        let mut image = Image::new(64).unwrap();
        for (i, sample) in image.samples_mut().iter_mut().enumerate() {
            *sample = order(i) as f32 / 12288.0 * 1.5 - 0.2;
        }
        image
    }

    /// Both show what [`display_byte`] says, so their times are those of the same work.
    #[test]
    fn both_methods_show_the_same_bytes() {
        // The second has another value at every sample.
        let pictures = [ramp(|i| i), ramp(|i| 12287 - i)];
        for backend in [Backend::Egl, Backend::OsMesa] {
            for method in DrawMethod::ALL {
                let what = format!("{} {}", backend.name(), method.name());
                let mut screen = match TimedScreen::open(backend, method, 64) {
                    Err(error @ ScreenError::Missing { .. }) => {
                        assert!(std::env::var_os("CI").is_none(), "{error}");
                        writeln!(std::io::stderr(), "skipped: {error}").unwrap();
                        continue;
                    }
                    opened => opened.expect(&what),
                };
                assert!(screen.bytes.is_empty());
                for picture in &pictures {
                    let cost = screen.show(picture, 0..64).expect(&what);
                    assert_eq!(cost.upload.is_zero(), method == DrawMethod::DrawPixels);
                    let pixels = picture.samples().chunks_exact(3);
                    let expected: Vec<u8> = pixels
                        .flat_map(|pixel| {
                            let [red, green, blue] = [0, 1, 2].map(|i| display_byte(pixel[i]));
                            [red, green, blue, 255]
                        })
                        .collect();
                    assert!(screen.bytes == expected, "{what}");
                }
                let other = Image::new(63).unwrap();
                assert!(matches!(
                    screen.show(&other, 0..64),
                    Err(ScreenError::Size { .. })
                ));
            }
        }
    }
}
