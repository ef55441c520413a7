//! What a screen leaves in the framebuffer of a window: the right pixels, as the right bytes,
//! whatever was drawn there before.

use std::ffi::{CStr, c_void};
use std::rc::Rc;

use firsthit::Image;
use firsthit::image::Raster;
use firsthit::screen::{Backend, Offscreen, Placement, Screen, ScreenError};
use glam::{IVec2, UVec2};
use glow::HasContext as _;
use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device;
use glutin::api::egl::display::Display;
use glutin::config::{Api, ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, Version};
use glutin::display::GlDisplay as _;

use crate::helpers::skipped;

/// A current context, and its functions.
struct Gl {
    gl: Rc<glow::Context>,
    context: PossiblyCurrentContext,
}

impl Gl {
    /// `None` where EGL is not installed: never so in CI.
    fn open() -> Option<Gl> {
        Gl::with(|_, real| real)
    }

    /// With `replace(name, address)` in place of each function's address.
    fn with(replace: impl Fn(&CStr, *const c_void) -> *const c_void) -> Option<Gl> {
        let devices = match Device::query_devices() {
            Ok(devices) => devices,
            Err(error) => {
                skipped(&format!("no EGL devices: {error}"));
                return None;
            }
        };
        let device = devices
            .into_iter()
            .max_by_key(|device| device.extensions().contains("EGL_MESA_device_software"))
            .unwrap();
        let template = ConfigTemplateBuilder::new()
            .with_api(Api::OPENGL)
            .with_surface_type(ConfigSurfaceTypes::empty())
            .build();
        let attributes = ContextAttributesBuilder::new()
            .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
            .build(None);
        // SAFETY: no handle of a window, display or other context is passed; the functions are of
        // the context that is current.
        unsafe {
            let display = Display::with_device(&device, None).unwrap();
            let config = display.find_configs(template).unwrap().next().unwrap();
            let context = display.create_context(&config, &attributes).unwrap();
            let context = context.make_current_surfaceless().unwrap();
            let gl = glow::Context::from_loader_function_cstr(|name| {
                replace(name, display.get_proc_address(name))
            });
            Some(Gl {
                gl: Rc::new(gl),
                context,
            })
        }
    }

    /// Binds a new framebuffer of this format and size, with depth and stencil as a window may
    /// have.
    fn bind_framebuffer(&self, format: u32, surface: UVec2) {
        let gl = &self.gl;
        let [width, height] = surface.as_ivec2().to_array();
        // SAFETY: the context is current; it frees the names at its end.
        unsafe {
            let color = gl.create_renderbuffer().unwrap();
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(color));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, width, height);
            let framebuffer = gl.create_framebuffer().unwrap();
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
            gl.framebuffer_renderbuffer(
                glow::FRAMEBUFFER,
                glow::COLOR_ATTACHMENT0,
                glow::RENDERBUFFER,
                Some(color),
            );
            let depth = gl.create_renderbuffer().unwrap();
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(depth));
            gl.renderbuffer_storage(glow::RENDERBUFFER, glow::DEPTH24_STENCIL8, width, height);
            gl.framebuffer_renderbuffer(
                glow::FRAMEBUFFER,
                glow::DEPTH_STENCIL_ATTACHMENT,
                glow::RENDERBUFFER,
                Some(depth),
            );
            assert_eq!(
                gl.check_framebuffer_status(glow::FRAMEBUFFER),
                glow::FRAMEBUFFER_COMPLETE
            );
        }
    }

    /// The bytes of the bound framebuffer, `surface` wide and high, as four of `kind` a pixel.
    fn read(&self, surface: UVec2, kind: u32, bytes_of_kind: usize) -> Vec<u8> {
        let mut bytes = vec![0; surface.element_product() as usize * 4 * bytes_of_kind];
        let [width, height] = surface.as_ivec2().to_array();
        let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
        // SAFETY: rows of four values of one or four bytes have no gaps, so that the driver fills
        // the bytes and no more.
        unsafe {
            self.gl
                .read_pixels(0, 0, width, height, glow::RGBA, kind, pixels)
        };
        bytes
    }

    fn read_bytes(&self, surface: UVec2) -> Vec<u8> {
        self.read(surface, glow::UNSIGNED_BYTE, 1)
    }

    fn read_floats(&self, surface: UVec2) -> Vec<f32> {
        let bytes = self.read(surface, glow::FLOAT, 4);
        let (floats, _) = bytes.as_chunks();
        floats.iter().copied().map(f32::from_ne_bytes).collect()
    }
}

/// A screen in the context of the [`Gl`] whose functions these are.
fn screen(gl: Rc<glow::Context>, width: u32, height: u32) -> Result<Screen, ScreenError> {
    // SAFETY: these tests keep that context current as long as they have a screen in it.
    unsafe { Screen::new(gl, UVec2::new(width, height)) }
}

/// A picture whose pixels say where they are: column, row, 0.5.
fn coordinates(width: u32, height: u32) -> Raster {
    let mut image = Raster::new(width, height).unwrap();
    for (i, pixel) in image.samples_mut().chunks_mut(3).enumerate() {
        let (column, row) = (i as u32 % width, i as u32 / width);
        pixel.copy_from_slice(&[column as f32, row as f32, 0.5]);
    }
    image
}

/// A square of `side` pixels.
fn square(origin: IVec2, side: u32) -> Placement {
    let size = UVec2::splat(side);
    Placement { origin, size }
}

/// Draws [`coordinates`] of `picture`, width and height, into `placement` of a float framebuffer
/// and compares every pixel of it with the definition.
#[track_caller]
fn assert_drawn(gl: &Gl, screen: &Screen, picture: UVec2, surface: UVec2, placement: Placement) {
    gl.bind_framebuffer(glow::RGBA32F, surface);
    screen.draw(surface, placement);
    let texel = |pixel: u32, origin: i32, side: u32, size: u32| {
        let side = i64::from(side);
        let offset = i64::from(pixel) - i64::from(origin);
        let inside = (0..side).contains(&offset);
        inside.then(|| ((2 * offset + 1) * i64::from(size) / (2 * side)) as f32)
    };
    for (i, drawn) in gl.read_floats(surface).chunks(4).enumerate() {
        let (x, y) = (i as u32 % surface.x, i as u32 / surface.x);
        let Placement { origin, size } = placement;
        let column = texel(x, origin.x, size.x, picture.x);
        let row = texel(y, origin.y, size.y, picture.y);
        let expected = match (column, row) {
            (Some(column), Some(row)) => [column, row, 0.5, 1.0],
            _ => [0.0, 0.0, 1.0, 1.0],
        };
        assert_eq!(
            drawn, expected,
            "{picture}, {placement:?}, ({x}, {y}) of {surface}"
        );
    }
}

#[test]
fn every_pixel_is_its_nearest_neighbour_and_the_rest_is_clear() {
    let Some(gl) = Gl::open() else { return };
    for size in [1, 2, 7, 10, 64] {
        let mut screen = screen(gl.gl.clone(), size, size).unwrap();
        screen.upload(&coordinates(size, size)).unwrap();
        // Whole multiples with and without a margin, and smaller ones, among them those where every
        // centre lies between two texels.
        for side in 1..=3 * size + 2 {
            for surface in [UVec2::new(side, side), UVec2::new(side + 5, side + 2)] {
                assert_drawn(
                    &gl,
                    &screen,
                    UVec2::splat(size),
                    surface,
                    Placement::fit(surface, UVec2::splat(size)),
                );
            }
        }
        // Beyond the edges, or not there at all.
        let surface = UVec2::new(40, 30);
        for (x, y, side) in [
            (-13, -7, 100),
            (25, -20, 33),
            (-20, 21, 33),
            (40, 0, 9),
            (0, -9, 9),
            (3, 3, 0),
            (i32::MIN, i32::MIN, 9),
            (i32::MAX, i32::MAX, 9),
        ] {
            let origin = IVec2::new(x, y);
            assert_drawn(
                &gl,
                &screen,
                UVec2::splat(size),
                surface,
                square(origin, side),
            );
        }
    }
}

#[test]
fn pictures_of_any_width_and_height_are_drawn_pixel_by_pixel() {
    let Some(gl) = Gl::open() else { return };
    for picture in [
        UVec2::new(7, 3),
        UVec2::new(3, 10),
        UVec2::new(1, 64),
        UVec2::new(33, 32),
    ] {
        let mut screen = screen(gl.gl.clone(), picture.x, picture.y).unwrap();
        screen.upload(&coordinates(picture.x, picture.y)).unwrap();
        for side in 1..=3 * picture.max_element() + 2 {
            for surface in [UVec2::splat(side), UVec2::new(side + 5, side.div_ceil(2))] {
                let placement = Placement::fit(surface, picture);
                assert_drawn(&gl, &screen, picture, surface, placement);
            }
        }
        // Beyond the edges, and not in the picture's aspect.
        let surface = UVec2::new(40, 30);
        for (origin, size) in [
            (IVec2::new(-13, -7), UVec2::new(100, 20)),
            (IVec2::new(25, -20), UVec2::new(9, 64)),
        ] {
            assert_drawn(&gl, &screen, picture, surface, Placement { origin, size });
        }
        // Some rows of it.
        let mut other = coordinates(picture.x, picture.y);
        other.samples_mut().fill(0.25);
        screen.upload_rows(&other, 1..2).unwrap();
        gl.bind_framebuffer(glow::RGBA32F, picture);
        screen.draw(picture, Placement::fit(picture, picture));
        let drawn = gl.read_floats(picture);
        for (row, samples) in (0_u32..).zip(drawn.chunks(4 * picture.x as usize)) {
            let expected = if row == 1 {
                [0.25, 0.25]
            } else {
                [0.0, row as f32]
            };
            assert_eq!(samples[..2], expected, "{picture}");
        }
    }
}

#[test]
fn texels_are_exact_where_floats_no_longer_are() {
    let Some(gl) = Gl::open() else { return };
    let (size, side) = (255, 8_400_000);
    let mut screen = screen(gl.gl.clone(), size, size).unwrap();
    screen.upload(&coordinates(size, size)).unwrap();
    // Around the first pixel of each texel: a 32-bit float cannot tell it from its neighbours.
    for texel in 1..size {
        let first = (side / size * texel) as i32;
        let surface = UVec2::splat(32);
        let origin = IVec2::splat(8 - first);
        assert_drawn(
            &gl,
            &screen,
            UVec2::splat(size),
            surface,
            square(origin, side),
        );
    }
}

/// Draws samples around the middles of the `steps` between 0 and 1, and some beyond, into a
/// framebuffer of `format`. What it holds of each pixel, as four bytes of `kind`, must be what
/// `pixel` says of the samples' nearest steps.
fn holds_the_nearest_steps(
    gl: &Gl,
    (format, kind): (u32, u32),
    steps: u32,
    pixel: fn([u32; 3]) -> u32,
) {
    let mut samples = vec![
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -0.0,
        -1.0,
        2.0,
        1e-40,
    ];
    for k in 0..=2 * steps {
        let middle = k as f32 / (2 * steps) as f32;
        samples.extend([middle.next_down(), middle, middle.next_up()]);
    }
    let size = 64;
    let mut image = Image::new(size).unwrap();
    assert!(samples.len() <= image.samples().len());
    image.samples_mut()[..samples.len()].copy_from_slice(&samples);
    let surface = UVec2::splat(size);
    gl.bind_framebuffer(format, surface);
    let mut screen = screen(gl.gl.clone(), size, size).unwrap();
    screen.upload(&image).unwrap();
    screen.draw(surface, Placement::fit(surface, UVec2::splat(size)));
    let bytes = gl.read(surface, kind, 1);
    let (drawn, _) = bytes.as_chunks();
    let nearest = |sample: f32| (sample.clamp(0.0, 1.0) * steps as f32).round_ties_even() as u32;
    for (drawn, shown) in drawn.iter().zip(image.samples().chunks(3)) {
        let expected = pixel([0, 1, 2].map(|i| nearest(shown[i])));
        assert_eq!(u32::from_ne_bytes(*drawn), expected, "{shown:?}");
    }
}

/// The bytes of a pixel of 8 bits each.
fn bytes([red, green, blue]: [u32; 3]) -> u32 {
    u32::from_ne_bytes([red as u8, green as u8, blue as u8, 255])
}

#[test]
fn eight_bits_are_the_nearest_byte_ties_to_even() {
    let Some(gl) = Gl::open() else { return };
    holds_the_nearest_steps(&gl, (glow::RGBA8, glow::UNSIGNED_BYTE), 255, bytes);
}

#[test]
fn ten_bits_are_the_nearest_step_ties_to_even() {
    let Some(gl) = Gl::open() else { return };
    let format = (glow::RGB10_A2, glow::UNSIGNED_INT_2_10_10_10_REV);
    holds_the_nearest_steps(&gl, format, 1023, |[red, green, blue]| {
        3 << 30 | blue << 20 | green << 10 | red
    });
}

/// The shader rounds, not the driver alone: in 8 bits that are said to be 4, every colour is a
/// multiple of 17.
#[test]
fn colours_are_rounded_to_the_steps_that_the_driver_tells() {
    /// # Safety
    /// As glGetFramebufferAttachmentParameteriv.
    unsafe extern "system" fn parameter(_: u32, _: u32, name: u32, value: *mut i32) {
        let answer = match name {
            glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE => glow::RENDERBUFFER as i32,
            glow::FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE => glow::UNSIGNED_NORMALIZED as i32,
            _ => 4,
        };
        // SAFETY: the caller passes room for an integer.
        unsafe { *value = answer };
    }
    let replaced = Gl::with(|name, real| match name.to_bytes() {
        b"glGetFramebufferAttachmentParameteriv" => parameter as *const c_void,
        _ => real,
    });
    let Some(gl) = replaced else { return };
    holds_the_nearest_steps(&gl, (glow::RGBA8, glow::UNSIGNED_BYTE), 15, |steps| {
        bytes(steps.map(|step| 17 * step))
    });
}

/// Leaves behind in `gl` what another painter may, by its name.
fn disturb(gl: &glow::Context, what: &str) {
    // SAFETY: the context is current; the one buffer is bound only for as long as no memory of ours
    // is meant.
    unsafe {
        match what {
            "blending" => {
                gl.enable(glow::BLEND);
                gl.blend_func(glow::ONE, glow::ONE);
            }
            "culling" => {
                gl.enable(glow::CULL_FACE);
                gl.cull_face(glow::FRONT_AND_BACK);
            }
            "a depth test" => {
                gl.enable(glow::DEPTH_TEST);
                gl.depth_func(glow::NEVER);
            }
            "a stencil test" => {
                gl.enable(glow::STENCIL_TEST);
                gl.stencil_func(glow::NEVER, 0, 0);
            }
            "dithering" => gl.enable(glow::DITHER),
            "sRGB encoding" => gl.enable(glow::FRAMEBUFFER_SRGB),
            "discarding" => gl.enable(glow::RASTERIZER_DISCARD),
            "scissors" => {
                gl.enable(glow::SCISSOR_TEST);
                gl.scissor(1, 1, 2, 2);
            }
            "a colour mask" => gl.color_mask(false, true, false, true),
            "outlines" => gl.polygon_mode(glow::FRONT_AND_BACK, glow::LINE),
            "a viewport" => gl.viewport(1, 1, 2, 2),
            "a clear colour" => gl.clear_color(1.0, 1.0, 1.0, 0.0),
            "no program" => gl.use_program(None),
            "no vertex array" => gl.bind_vertex_array(None),
            "another texture" => {
                for unit in [glow::TEXTURE1, glow::TEXTURE0] {
                    gl.active_texture(unit);
                    let texture = gl.create_texture().unwrap();
                    gl.bind_texture(glow::TEXTURE_2D, Some(texture));
                }
            }
            "another texture unit" => gl.active_texture(glow::TEXTURE1),
            "a sampler" => {
                let sampler = gl.create_sampler().unwrap();
                gl.bind_sampler(0, Some(sampler));
            }
            "an alignment" => gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 8),
            "a row length" => gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 3),
            "rows to skip" => gl.pixel_store_i32(glow::UNPACK_SKIP_ROWS, 1),
            "pixels to skip" => gl.pixel_store_i32(glow::UNPACK_SKIP_PIXELS, 1),
            "swapped bytes" => gl.pixel_store_i32(glow::UNPACK_SWAP_BYTES, 1),
            "an unpack buffer" => {
                let buffer = gl.create_buffer().unwrap();
                gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, Some(buffer));
            }
            _ => panic!("{what}"),
        }
    }
}

#[test]
fn what_another_painter_leaves_behind_does_no_harm() {
    let Some(gl) = Gl::open() else { return };
    let size = 7;
    let surface = UVec2::new(9, 8);
    let placement = Placement::fit(surface, UVec2::splat(size));
    // Grey in between black and white is what sRGB encoding changes most.
    let mut image = Image::new(size).unwrap();
    for (i, sample) in image.samples_mut().iter_mut().enumerate() {
        *sample = (i + 1) as f32 / 255.0;
    }
    for format in [glow::RGBA8, glow::SRGB8_ALPHA8] {
        let mut expected = None;
        for what in [
            "dithering", // where OpenGL starts
            "blending",
            "culling",
            "a depth test",
            "a stencil test",
            "sRGB encoding",
            "discarding",
            "scissors",
            "a colour mask",
            "outlines",
            "a viewport",
            "a clear colour",
            "no program",
            "no vertex array",
            "another texture",
            "another texture unit",
            "a sampler",
            "an alignment",
            "a row length",
            "rows to skip",
            "pixels to skip",
            "swapped bytes",
            "an unpack buffer",
        ] {
            gl.bind_framebuffer(format, surface);
            // A disturbance before the screen is made, between upload and draw, and between two
            // draws.
            disturb(&gl.gl, what);
            let mut screen = screen(gl.gl.clone(), size, size).unwrap();
            disturb(&gl.gl, what);
            screen.upload(&image).unwrap();
            for _ in 0..2 {
                disturb(&gl.gl, what);
                screen.draw(surface, placement);
                let drawn = gl.read_bytes(surface);
                let expected = expected.get_or_insert_with(|| drawn.clone());
                assert!(drawn == *expected, "{what}");
            }
        }
        let bytes = expected.unwrap();
        assert_eq!(bytes[..4], [0, 0, 255, 255], "the clear colour");
        assert_eq!(bytes[4..8], [1, 2, 3, 255], "the first pixel");
    }
}

#[test]
fn an_offscreen_that_ends_takes_nothing_of_another_context_along() {
    let Some(gl) = Gl::open() else { return };
    let offscreen = Offscreen::open(Backend::Egl, 5).unwrap();
    gl.context.make_current_surfaceless().unwrap();
    let mut screen = screen(gl.gl.clone(), 5, 5).unwrap();
    screen.upload(&coordinates(5, 5)).unwrap();
    drop(offscreen);
    gl.context.make_current_surfaceless().unwrap();
    let surface = UVec2::splat(5);
    assert_drawn(
        &gl,
        &screen,
        UVec2::splat(5),
        surface,
        Placement::fit(surface, UVec2::splat(5)),
    );
}

#[test]
fn a_picture_of_another_size_is_refused_and_the_old_one_stays() {
    let Some(gl) = Gl::open() else { return };
    let mut screen = screen(gl.gl.clone(), 5, 5).unwrap();
    screen.upload(&coordinates(5, 5)).unwrap();
    for size in [[4, 4], [6, 6], [5, 4], [6, 5]] {
        match screen.upload(&coordinates(size[0], size[1])) {
            Err(ScreenError::Size { image, screen }) => {
                assert_eq!((image, screen), (size.into(), UVec2::splat(5)));
            }
            other => panic!("{other:?}"),
        }
    }
    let surface = UVec2::splat(5);
    assert_drawn(
        &gl,
        &screen,
        UVec2::splat(5),
        surface,
        Placement::fit(surface, UVec2::splat(5)),
    );
}

#[test]
fn a_size_that_no_picture_has_is_refused() {
    let Some(gl) = Gl::open() else { return };
    for size in [0, 16_385, u32::MAX] {
        for [width, height] in [[size, size], [5, size], [size, 5]] {
            let error = screen(gl.gl.clone(), width, height).err().unwrap();
            assert!(matches!(error, ScreenError::Image(_)), "{error}");
        }
    }
}

#[test]
fn a_small_drivers_largest_texture_is_respected() {
    /// A driver whose textures have up to 64 × 64 texels and that has no extensions.
    ///
    /// # Safety
    /// As glGetIntegerv.
    unsafe extern "system" fn get_integer(name: u32, value: *mut i32) {
        let answer = if name == glow::MAX_TEXTURE_SIZE {
            64
        } else {
            0
        };
        // SAFETY: the caller passes room for an integer.
        unsafe { *value = answer };
    }
    let replaced = Gl::with(|name, real| match name.to_bytes() {
        b"glGetIntegerv" => get_integer as *const c_void,
        _ => real,
    });
    let Some(gl) = replaced else { return };
    assert!(screen(gl.gl.clone(), 64, 64).is_ok());
    for [width, height] in [[65, 65], [65, 5], [5, 65]] {
        let error = screen(gl.gl.clone(), width, height).err().unwrap();
        let ScreenError::TextureTooLarge { size, max: 64 } = error else {
            panic!("{error}");
        };
        assert_eq!(size, UVec2::new(width, height));
    }
}

#[test]
fn a_driver_without_memory_is_reported() {
    /// # Safety
    /// None needed.
    unsafe extern "system" fn get_error() -> u32 {
        glow::OUT_OF_MEMORY
    }
    let replaced = Gl::with(|name, real| match name.to_bytes() {
        b"glGetError" => get_error as *const c_void,
        _ => real,
    });
    let Some(gl) = replaced else { return };
    let error = screen(gl.gl.clone(), 64, 64).err().unwrap();
    assert!(
        matches!(error, ScreenError::Memory { size } if size == UVec2::splat(64)),
        "{error}"
    );
}

#[test]
fn a_driver_that_does_not_understand_the_shaders_is_quoted_in_one_line() {
    /// A compiler that finds two errors in whatever it reads.
    ///
    /// # Safety
    /// As glGetShaderiv.
    unsafe extern "system" fn get_shader(_shader: u32, name: u32, value: *mut i32) {
        let answer = if name == glow::COMPILE_STATUS {
            0
        } else {
            LOG.len() as i32
        };
        // SAFETY: the caller passes room for an integer.
        unsafe { *value = answer };
    }
    /// # Safety
    /// As glGetShaderInfoLog.
    unsafe extern "system" fn get_log(_shader: u32, size: i32, length: *mut i32, text: *mut u8) {
        assert_eq!(size as usize, LOG.len());
        // SAFETY: the caller passes room for `size` bytes and for an integer.
        unsafe {
            text.copy_from_nonoverlapping(LOG.as_ptr(), LOG.len());
            *length = LOG.len() as i32 - 1;
        }
    }
    const LOG: &[u8] = b"0:1(1): error: what?\n0:2(1): error: what now?\n\0";
    let replaced = Gl::with(|name, real| match name.to_bytes() {
        b"glGetShaderiv" => get_shader as *const c_void,
        b"glGetShaderInfoLog" => get_log as *const c_void,
        _ => real,
    });
    let Some(gl) = replaced else { return };
    let error = screen(gl.gl.clone(), 64, 64).err().unwrap().to_string();
    let quoted = "the vertex shader (0:1(1): error: what? 0:2(1): error: what now?)";
    assert!(error.contains(quoted), "{error}");
}
