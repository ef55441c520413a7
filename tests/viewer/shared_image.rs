//! What a window shows, through memory that the X server shares: over the connection it takes ten
//! times as long, most of it in code of x11rb that is not optimised.

use std::fs::File;
use std::os::unix::fs::FileExt as _;

use rustix::fs::{MemfdFlags, ftruncate, memfd_create};
use x11rb::connection::Connection as _;
use x11rb::protocol::shm::ConnectionExt as _;
use x11rb::protocol::xproto::{ImageFormat, Window};
use x11rb::rust_connection::RustConnection;

use super::pixels::Pixels;

/// No window is larger, in bytes: that many make the largest screen that the tests start.
const LENGTH: usize = 4 * 1280 * 1024;

/// Memory that the X server writes images into.
pub struct SharedImage {
    memory: File,
    /// The server's name for it.
    segment: u32,
}

impl SharedImage {
    pub fn new(connection: &RustConnection) -> SharedImage {
        let memory = memfd_create("window", MemfdFlags::CLOEXEC).unwrap();
        ftruncate(&memory, LENGTH as u64).unwrap();
        let segment = connection.generate_id().unwrap();
        let server_side = memory.try_clone().unwrap();
        let attached = connection.shm_attach_fd(segment, server_side, false);
        attached.unwrap().check().unwrap();
        SharedImage {
            memory: memory.into(),
            segment,
        }
    }

    /// What `window`, of that width and height, shows, if it can be read.
    pub fn of(
        &self,
        connection: &RustConnection,
        window: Window,
        (width, height): (usize, usize),
    ) -> Option<Pixels> {
        let [columns, rows] = [width, height].map(|length| u16::try_from(length).unwrap());
        let (all_planes, format) = (u32::MAX, ImageFormat::Z_PIXMAP.into());
        let image = connection.shm_get_image(
            window,
            0,
            0,
            columns,
            rows,
            all_planes,
            format,
            self.segment,
            0,
        );
        image.unwrap().reply().ok()?;
        let mut data = vec![0; 4 * width * height];
        self.memory.read_exact_at(&mut data, 0).unwrap();
        // 24 bits deep, in 32 bits of little endian: blue first.
        let bytes = data.chunks_exact(4).map(|p| [p[2], p[1], p[0]]);
        Some(Pixels {
            width,
            height,
            bytes: bytes.collect(),
        })
    }
}
