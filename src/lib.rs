//! A **scene** seen at angle **α** in a **stage** is traced by a **kernel** into an **image**, and
//! the image goes to a **screen** (a window, or offscreen) or into a **file**.
//!
//! ```
//! use firsthit::{Image, Kernel, Scene, Stage, Tracer};
//!
//! let scene = Scene::builtin();
//! let mut tracer = Tracer::new(Kernel::Exact, 1)?;
//! let mut image = Image::new(64)?;
//! tracer.trace(&scene, Stage::Reflection, 0.3, &mut image)?;
//!
//! // The corner shows the background; rows go from the bottom to the top.
//! assert_eq!(image.pixel(0, 0), Some([0.8, 0.8, 0.8]));
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("picture.png");
//! image.save(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The document
//!
//! *The document* is the homework on ray tracing that the stages follow: its sections, its figures,
//! its listings Code 2-1 to Code 6-1 and its equations are cited by their numbers. The README has a
//! list of what it leaves open. Its equation 4-1 is the light at a point whose normal is n, where l
//! points toward the light and h halfway between l and the eye, all of length 1:
//!
//! L = k_a I_a + k_d I max(0, n·l) + k_s I max(0, n·h)ⁿ
//!
//! A pixel shows L times the solid's colour, or k_a I_a times that in shadow. The exponent n is the
//! material's.
//!
//! # From scene to screen
//!
//! Each bold word above is one place. The tracer knows no OpenGL, the screen knows no spheres.
//!
//! | place | what is there |
//! | --- | --- |
//! | [`scene`] | spheres, tetrahedra, the surface, the light; made in code or read from TOML, refusals with line and field; what exact arithmetic decides once |
//! | [`Stage`] | the seven stages, from a test image to the animation |
//! | [`camera`] | α: its frames, its sine and cosine |
//! | [`tracer`] | first hit, shading, shadow, mirror, each formula once; the kernels |
//! | [`Render`] | whatever makes pictures of scenes: the tracer, or yours |
//! | [`image`] | pixels of linear floats, N × N where they are traced; PNG and EXR in and out, animated PNG out |
//! | [`difference`] | how far one picture is from another, in numbers and in false colours |
//! | [`diagnosis`] | what is wrong with a picture: which decisions, and why perhaps |
//! | [`memory`] | which memory may be refused, for a program's allocator |
#![cfg_attr(
    feature = "screen",
    doc = "| [`screen`] | the retained texture and its quad; EGL and OSMesa without a window |",
    doc = "| [`panics`] | which panics become errors, for a program's panic hook |"
)]
#![cfg_attr(
    feature = "program",
    doc = "| [`program`] | another program that makes the pictures, in any language |",
    doc = "| [`report`] | speed against error: times, errors, a table, JSON, a plot |",
    doc = "| [`viewer`] | the window: keys, the clock of α, the redisplay |"
)]
//!
//! # Features
//!
//! Who wants pictures only turns the default off: what is left knows no OpenGL, no window and no
//! command line, and is less than half of the crates to build.
//!
//! | feature | what it adds |
//! | --- | --- |
//! | `screen` | `screen`: a picture as a texture in the caller's OpenGL context, or in one without a window |
//! | `program`, the default | `screen`, `program`, `report`, `viewer`, `difference::save_heat`, and the program itself |
//!
//! # What the picture is
//!
//! The picture is a mathematical function of scene, stage, α and N. An eye ray through the pixel
//! (x, y) is the line through e = (sin α + u cos α, v, cos α − u sin α) along −w, with u = (x −
//! N/2)/(N/2), v = (y − N/2)/(N/2) and w = (sin α, 3/10, cos α); sine and cosine are those of the
//! f64 α taken exactly, and every number of a scene is its f64 taken exactly. What the ray meets
//! first, whether a point is in shadow, what the surface mirrors: these are signs of real numbers,
//! and touching counts as meeting. A sample is the real number that equation 4-1 gives, rounded
//! once to the nearest f32. What is 0 for every α is decided in rationals; beyond that, a sign that
//! 8192 bits leave open counts as 0, and a sample as halfway between two f32s.
//! [`Kernel::Exact`] returns just that, on every machine, with any vector instructions and any
//! number of threads.
//!
//! # What was left out, and why
//!
//! - No epsilon: a solid is convex, so it is never tested against itself, and what coincides is
//!   decided exactly.
//! - No general ray tracer: projection is parallel, light comes from one direction, the surface
//!   mirrors once. What the scene does not need is not modelled.
//! - No platform libm: sines and cosines are correctly rounded, highlights use arithmetic only, or
//!   `libm` in plain Rust.
//! - No fused multiply-add where it would give other bits: only arithmetic with a bound, of which
//!   nothing but what is certain gets into a picture, uses it where the processor has it.
//! - No tree over the solids: rays have three directions, so every solid knows the rows and columns
//!   that it can touch. What can stand between the surface and the light is found in a grid over
//!   the surface, what can stand between a solid and the light in a list that a sweep makes once.

pub mod camera;
pub mod diagnosis;
pub mod difference;
pub mod image;
pub mod memory;
mod number;
#[cfg(feature = "screen")]
pub mod panics;
mod parting;
#[cfg(feature = "program")]
pub mod program;
#[cfg(test)]
mod random;
mod render;
#[cfg(feature = "program")]
pub mod report;
pub mod scene;
#[cfg(feature = "screen")]
pub mod screen;
mod stage;
#[cfg(feature = "program")]
mod text;
pub mod tracer;
#[cfg(feature = "program")]
pub mod viewer;

pub use image::Image;
pub use render::{Canceller, Render, RenderError};
pub use scene::Scene;
pub use stage::Stage;
pub use tracer::{Kernel, Tracer};
