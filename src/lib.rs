//! A **scene** seen at angle **α** in a **stage** is traced by a **kernel** into an **image**, and the image goes to a **screen** or a **file**.

pub mod camera;
pub mod image;
pub mod scene;
pub mod screen;
mod stage;
pub mod tracer;

pub use image::Image;
pub use scene::Scene;
pub use stage::Stage;
pub use tracer::{Kernel, Tracer};
