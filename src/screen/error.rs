//! What can keep a picture from the screen.

use glam::UVec2;

use crate::image::ImageError;

/// A screen that cannot be made or used. Each message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScreenError {
    /// A library that the way to the screen needs is not there.
    #[error(
        "{library} cannot be used ({reason}): install it (Debian packages: {packages}), or capture with `--through none`, which needs no OpenGL"
    )]
    Missing {
        /// The file that was looked for first.
        library: &'static str,
        /// What the system said.
        reason: String,
        /// The Debian packages that bring it, separated by spaces.
        packages: &'static str,
    },
    /// EGL does not exist on this kind of system.
    #[cfg(target_vendor = "apple")]
    #[error("this system has no EGL: capture with `--through none`, which needs no OpenGL")]
    NoEgl,
    /// The library is there but gives no OpenGL 3.3 core context.
    #[error(
        "{library} gives no OpenGL 3.3 core context ({reason}): install a driver (Debian packages: {packages}), or capture with `--through none`, which needs no OpenGL"
    )]
    Context {
        /// The library that was asked.
        library: &'static str,
        /// What it said, for each device that was tried.
        reason: String,
        /// The Debian packages that bring a software driver, separated by spaces.
        packages: &'static str,
    },
    /// There is no picture of such a size, or no memory for the one that is read back.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The picture is larger than the driver's largest texture.
    #[error(
        "a picture of {} × {} pixels exceeds this OpenGL driver's largest texture, {max} × {max}: choose a smaller size, or capture with `--through none`",
        size.x, size.y
    )]
    TextureTooLarge {
        /// The picture's width and height in pixels.
        size: UVec2,
        /// The driver's `GL_MAX_TEXTURE_SIZE`.
        max: u32,
    },
    /// The driver says that it is out of memory; Mesa's software renderer also says so of a texture
    /// beyond a fixed number of bytes.
    #[error(
        "this OpenGL driver has no room for a picture of {} × {} pixels: choose a smaller size, or capture with `--through none`",
        size.x, size.y
    )]
    Memory {
        /// The picture's width and height in pixels.
        size: UVec2,
    },
    /// The picture is not of the size that the screen was made for.
    #[error(
        "a picture of {} × {} pixels does not fit a screen made for {} × {}: make a screen of the picture's size",
        image.x, image.y, screen.x, screen.y
    )]
    Size {
        /// The picture's width and height in pixels.
        image: UVec2,
        /// The screen's.
        screen: UVec2,
    },
    /// What may be mapped is limited (`ulimit -v`), and a driver would crash for want of it.
    #[error(
        "an OpenGL driver may need {needed} MiB, and the limit of this process leaves {left}: raise it (`ulimit -v`), or capture with `--through none`, which needs no OpenGL"
    )]
    Addresses {
        /// MiB that are left.
        left: u64,
        /// MiB that may be needed.
        needed: u64,
    },
    /// Threads are limited (`ulimit -u`), and a driver would wait for ever for those that it cannot
    /// have.
    #[error(
        "the system refuses the threads that an OpenGL driver needs ({0}): raise the limit (`ulimit -u`), or capture with `--through none`, which needs no OpenGL"
    )]
    Threads(std::io::Error),
    /// What came back from the driver is not what was drawn.
    #[error(
        "the OpenGL driver does not give back what was drawn: at column {column}, row {row} from the bottom {back:?} instead of {drawn:?}: try another driver, or capture with `--through none`"
    )]
    Altered {
        /// The first pixel that differs: its column.
        column: u32,
        /// Its row, counted from the bottom.
        row: u32,
        /// Its samples as they were drawn.
        drawn: [f32; 3],
        /// As they came back.
        back: [f32; 3],
    },
    /// The driver refused something that every OpenGL 3.3 driver should do.
    #[error(
        "the OpenGL driver refuses {what} ({reason}): try another driver, or capture with `--through none`, which needs no OpenGL"
    )]
    Refused {
        /// What it was asked for.
        what: &'static str,
        /// What it said, in one line.
        reason: String,
    },
}

impl ScreenError {
    /// `what` was refused, with the driver's words in one line however many they came in.
    pub(crate) fn refused(what: &'static str, reason: &str) -> ScreenError {
        ScreenError::Refused {
            what,
            reason: reason.split_whitespace().collect::<Vec<_>>().join(" "),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_is_one_line_and_says_what_to_do() {
        let reason = || "because".to_owned();
        let errors = [
            ScreenError::Missing {
                library: "libX.so",
                reason: reason(),
                packages: "libx1 libx2",
            },
            ScreenError::Context {
                library: "libX.so",
                reason: reason(),
                packages: "libx1 libx2",
            },
            ScreenError::TextureTooLarge {
                size: UVec2::splat(9000),
                max: 8192,
            },
            ScreenError::Memory {
                size: UVec2::new(9000, 7),
            },
            ScreenError::refused("the shader", "line 1:\n  no\r\n\tline 2: no\n"),
        ];
        for error in errors {
            let text = error.to_string();
            assert!(!text.contains(['\n', '\r', '\t']), "{text:?}");
            assert!(text.contains("`--through none`"), "{text}");
        }
    }

    #[test]
    fn a_missing_library_names_its_packages() {
        let error = ScreenError::Missing {
            library: "libX.so",
            reason: "not found".to_owned(),
            packages: "libx1 libx2",
        };
        assert_eq!(
            error.to_string(),
            "libX.so cannot be used (not found): install it (Debian packages: libx1 libx2), or capture with `--through none`, which needs no OpenGL"
        );
    }
}
