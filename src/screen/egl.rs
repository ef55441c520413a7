//! An OpenGL context without window or display server, on one of EGL's devices.

use std::ffi::{CStr, c_void};

use glutin::api::egl::context::PossiblyCurrentContext;
use glutin::api::egl::device::Device;
use glutin::api::egl::display::Display;
use glutin::config::{Api, ConfigSurfaceTypes, ConfigTemplateBuilder};
use glutin::context::{ContextApi, ContextAttributesBuilder, GlProfile, Version};
use glutin::display::GlDisplay as _;
use glutin::prelude::PossiblyCurrentGlContext as _;

use super::ScreenError;
use super::context::{Context, Profile};
use crate::panics::caught;

const LIBRARY: &str = "libEGL.so.1";
const PACKAGES: &str = "libegl1 libegl-mesa0 libgl1-mesa-dri";

/// A context with no surface at all, and the display that it is on.
pub(super) struct Egl {
    context: PossiblyCurrentContext,
    display: Display,
}

impl Egl {
    /// An OpenGL context on the first device that gives one, software before hardware: the same
    /// pictures on every machine.
    pub(super) fn open(profile: Profile) -> Result<Egl, ScreenError> {
        let missing = |reason: String| ScreenError::Missing {
            library: LIBRARY,
            reason,
            packages: PACKAGES,
        };
        // glutin panics where the library lacks what it takes for granted.
        let devices = caught(|| Device::query_devices().map(Iterator::collect));
        let mut devices: Vec<Device> = devices
            .map_err(&missing)?
            .map_err(|error| missing(error.to_string()))?;
        if devices.is_empty() {
            return Err(missing("it has no devices".to_owned()));
        }
        devices.sort_by_key(|device| !device.extensions().contains("EGL_MESA_device_software"));
        let mut reasons = Vec::new();
        for device in &devices {
            let reason = match caught(|| Egl::on(device, profile)) {
                Ok(Ok(egl)) => return Ok(egl),
                Ok(Err(error)) => error.to_string(),
                Err(panic) => panic,
            };
            let name = device.name().unwrap_or("unnamed device");
            reasons.push(format!("{name}: {reason}"));
        }
        Err(refusal(reasons.join("; ")))
    }

    fn on(device: &Device, profile: Profile) -> Result<Egl, glutin::error::Error> {
        let template = ConfigTemplateBuilder::new()
            .with_api(Api::OPENGL)
            .with_surface_type(ConfigSurfaceTypes::empty())
            .with_depth_size(0)
            .with_stencil_size(0)
            .build();
        let attributes = ContextAttributesBuilder::new()
            .with_context_api(ContextApi::OpenGl(Some(Version::new(3, 3))))
            .with_profile(match profile {
                Profile::Core => GlProfile::Core,
                Profile::Compatibility => GlProfile::Compatibility,
            })
            .build(None);
        // SAFETY: no native display is handed over.
        let display = unsafe { Display::with_device(device, None) }?;
        // SAFETY: the template names no native window.
        let config = unsafe { display.find_configs(template) }?
            .next()
            .ok_or(glutin::error::ErrorKind::BadConfig)?;
        // SAFETY: the attributes name neither a window nor a context to share with.
        let context =
            unsafe { display.create_context(&config, &attributes) }?.make_current_surfaceless()?;
        Ok(Egl { context, display })
    }
}

fn refusal(reason: String) -> ScreenError {
    ScreenError::Context {
        library: LIBRARY,
        reason,
        packages: PACKAGES,
    }
}

impl Context for Egl {
    fn make_current(&self) -> Result<(), ScreenError> {
        self.context
            .make_current_surfaceless()
            .map_err(|error| refusal(error.to_string()))
    }

    fn release(&self) {
        // A context that cannot be released is lost, and a lost one is current nowhere.
        let _ = self.context.make_not_current_in_place();
    }

    fn proc_address(&self, name: &CStr) -> *const c_void {
        self.display.get_proc_address(name)
    }
}

impl Drop for Egl {
    fn drop(&mut self) {
        self.release();
    }
}
