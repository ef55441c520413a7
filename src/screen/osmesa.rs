//! An OpenGL context without window or device, from Mesa's off-screen library, where a system still
//! has it.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::sync::LazyLock;

use libloading::Library;

use super::ScreenError;
use super::context::{Context, Profile};

const LIBRARY: &str = "libOSMesa.so.8";
const OTHER_NAMES: [&str; 2] = ["libOSMesa.so.6", "libOSMesa.so"];
const PACKAGES: &str = "libosmesa6";

/// `OSMESA_FORMAT`, `OSMESA_PROFILE`, `OSMESA_CONTEXT_MAJOR_VERSION` and
/// `OSMESA_CONTEXT_MINOR_VERSION` with their values, as GL/osmesa.h has them, and the 0 that ends
/// the list.
fn attributes(profile: Profile) -> [c_int; 9] {
    let (profile, major, minor) = match profile {
        Profile::Core => (0x34, 3, 3),
        // The newest that every OSMesa gives.
        Profile::Compatibility => (0x35, 2, 1),
    };
    let format = glow::RGBA as c_int;
    [0x22, format, 0x33, profile, 0x36, major, 0x37, minor, 0]
}

type Handle = *mut c_void;
type Create = unsafe extern "C" fn(*const c_int, Handle) -> Handle;
type MakeCurrent = unsafe extern "C" fn(Handle, *mut c_void, u32, c_int, c_int) -> u8;
type Destroy = unsafe extern "C" fn(Handle);
type ProcAddress = unsafe extern "C" fn(*const c_char) -> *const c_void;

/// The library's functions. It is never unloaded: drivers leave threads and exit handlers behind
/// that must not lose their code.
struct Functions {
    create: Create,
    make_current: MakeCurrent,
    destroy: Destroy,
    proc_address: ProcAddress,
    _library: Library,
}

static FUNCTIONS: LazyLock<Result<Functions, String>> =
    LazyLock::new(|| Functions::load().map_err(|reason| reason.to_string()));

impl Functions {
    fn load() -> Result<Functions, libloading::Error> {
        // SAFETY: Mesa's library may be loaded anywhere and at any time: its initialisers only fill
        // tables of its own.
        let open = |name: &str| unsafe { Library::new(name) };
        let library = open(LIBRARY).or_else(|first| {
            let mut others = OTHER_NAMES.iter().filter_map(|name| open(name).ok());
            others.next().ok_or(first)
        })?;
        // SAFETY: the types are those that GL/osmesa.h declares for these names, and the library
        // outlives the pointers beside it.
        unsafe {
            Ok(Functions {
                create: *library.get(b"OSMesaCreateContextAttribs\0")?,
                make_current: *library.get(b"OSMesaMakeCurrent\0")?,
                destroy: *library.get(b"OSMesaDestroyContext\0")?,
                proc_address: *library.get(b"OSMesaGetProcAddress\0")?,
                _library: library,
            })
        }
    }
}

/// A context and the one pixel of memory that OSMesa wants as its window.
pub(super) struct OsMesa {
    functions: &'static Functions,
    handle: Handle,
    pixel: Box<UnsafeCell<[u8; 4]>>,
}

impl OsMesa {
    /// An OpenGL context.
    pub(super) fn open(profile: Profile) -> Result<OsMesa, ScreenError> {
        let functions = FUNCTIONS.as_ref().map_err(|reason| ScreenError::Missing {
            library: LIBRARY,
            reason: reason.clone(),
            packages: PACKAGES,
        })?;
        // SAFETY: the list of attributes ends with 0, and the new context shares with none.
        let handle =
            unsafe { (functions.create)(attributes(profile).as_ptr(), std::ptr::null_mut()) };
        if handle.is_null() {
            return Err(refusal("OSMesaCreateContextAttribs gave none"));
        }
        Ok(OsMesa {
            functions,
            handle,
            pixel: Box::new(UnsafeCell::new([0; 4])),
        })
    }
}

fn refusal(reason: &str) -> ScreenError {
    ScreenError::Context {
        library: LIBRARY,
        reason: reason.to_owned(),
        packages: PACKAGES,
    }
}

impl Context for OsMesa {
    fn make_current(&self) -> Result<(), ScreenError> {
        // SAFETY: the handle lives until the drop, and the pixel, one of four bytes as the format
        // says, as long.
        let made = unsafe {
            (self.functions.make_current)(
                self.handle,
                self.pixel.get().cast(),
                glow::UNSIGNED_BYTE,
                1,
                1,
            )
        };
        if made == 0 {
            return Err(refusal("OSMesaMakeCurrent failed"));
        }
        Ok(())
    }

    fn release(&self) {
        // SAFETY: no context and no buffer: no context is current afterwards.
        unsafe {
            (self.functions.make_current)(std::ptr::null_mut(), std::ptr::null_mut(), 0, 0, 0)
        };
    }

    fn proc_address(&self, name: &CStr) -> *const c_void {
        // SAFETY: the name ends with 0.
        unsafe { (self.functions.proc_address)(name.as_ptr()) }
    }
}

impl Drop for OsMesa {
    fn drop(&mut self) {
        self.release();
        // SAFETY: the handle came from OSMesaCreateContextAttribs, is not current, and is destroyed
        // once.
        unsafe { (self.functions.destroy)(self.handle) };
    }
}
