//! A mouse for a Wayland compositor without a screen.

use std::os::unix::net::UnixStream;

use wayland_client::globals::{GlobalListContents, registry_queue_init};
use wayland_client::protocol::wl_pointer::ButtonState;
use wayland_client::protocol::wl_registry::{self, WlRegistry};
use wayland_client::{Connection, Dispatch, EventQueue, QueueHandle, delegate_noop};
use wayland_protocols_wlr::virtual_pointer::v1::client::zwlr_virtual_pointer_manager_v1::ZwlrVirtualPointerManagerV1;
use wayland_protocols_wlr::virtual_pointer::v1::client::zwlr_virtual_pointer_v1::ZwlrVirtualPointerV1;

/// The left button, as Linux numbers it.
const LEFT: u32 = 0x110;

/// It is plugged in as long as it lives.
pub struct Mouse {
    queue: EventQueue<Nothing>,
    pointer: ZwlrVirtualPointerV1,
    /// The size of the display in pixels.
    size: [u32; 2],
}

/// Nobody answers a mouse.
struct Nothing;

delegate_noop!(Nothing: ZwlrVirtualPointerManagerV1);
delegate_noop!(Nothing: ZwlrVirtualPointerV1);

impl Dispatch<WlRegistry, GlobalListContents> for Nothing {
    fn event(
        _: &mut Nothing,
        _: &WlRegistry,
        _: wl_registry::Event,
        _: &GlobalListContents,
        _: &Connection,
        _: &QueueHandle<Nothing>,
    ) {
    }
}

impl Mouse {
    /// Plugs it into the compositor that listens at the socket `display`.
    pub fn new(display: &str, size: [u32; 2]) -> Mouse {
        let socket = UnixStream::connect(display).unwrap();
        let connection = Connection::from_socket(socket).unwrap();
        let (globals, queue) = registry_queue_init(&connection).unwrap();
        let handle = queue.handle();
        let manager: ZwlrVirtualPointerManagerV1 = globals.bind(&handle, 1..=1, ()).unwrap();
        let pointer = manager.create_virtual_pointer(None, &handle, ());
        let mut mouse = Mouse {
            queue,
            pointer,
            size,
        };
        mouse.sent();
        mouse
    }

    /// Moves to a pixel of the display, counted from its top left corner.
    pub fn point(&mut self, x: u32, y: u32) {
        let [width, height] = self.size;
        self.pointer.motion_absolute(0, x, y, width, height);
        self.sent();
    }

    /// Presses the left button and lets it go.
    pub fn click(&mut self) {
        for state in [ButtonState::Pressed, ButtonState::Released] {
            self.pointer.button(0, LEFT, state);
            self.sent();
        }
    }

    /// Ends what belongs together, and waits until the compositor has it.
    fn sent(&mut self) {
        self.pointer.frame();
        self.queue.roundtrip(&mut Nothing).unwrap();
    }
}
