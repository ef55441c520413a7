//! The shown picture as a new file in the current folder.

use std::fs::{self, File};
use std::io;
use std::path::PathBuf;

use crate::image::{Format, Raster, SaveError};

/// Saves `image` under the first free name `firsthit-what-NNNN`, and says which. No file that is
/// there is ever touched.
///
/// # Errors
/// [`SaveError`] where the current folder takes no file, or not this one.
pub(super) fn save(image: &Raster, what: &str, format: Format) -> Result<PathBuf, SaveError> {
    let path = reserve(what, format)?;
    image.save(&path).inspect_err(|_| {
        // What is there is the empty file of this name that was just made.
        let _ = fs::remove_file(&path);
    })?;
    Ok(path)
}

/// Makes an empty file of the first free name: from here on the name is taken, also for another
/// viewer in the same folder.
fn reserve(what: &str, format: Format) -> Result<PathBuf, SaveError> {
    let mut number = 1_u64;
    loop {
        let name = format!("firsthit-{what}-{number:04}.{}", format.extension());
        let path = PathBuf::from(name);
        match File::create_new(&path) {
            Ok(_) => return Ok(path),
            Err(reason) if reason.kind() == io::ErrorKind::AlreadyExists => number += 1,
            Err(reason) => return Err(SaveError::Write { path, reason }),
        }
    }
}
