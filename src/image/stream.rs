//! A picture into any output: a pipe, a socket, a file that is open already.

use std::io::{self, BufWriter, Seek as _, Write};

use super::{Raster, display_byte, exr, png};

impl Raster {
    /// Writes the bytes of the `.png` that [`Raster::save`] makes.
    ///
    /// # Errors
    /// Those of `output`.
    pub fn write_png(&self, output: &mut impl Write) -> io::Result<()> {
        png::write(self, output)
    }

    /// Writes the bytes of the `.exr` that [`Raster::save`] makes. An EXR begins with a table of
    /// what follows, so that it is made in a temporary file without a name and then copied.
    ///
    /// # Errors
    /// Those of `output` and of the temporary file.
    pub fn write_exr(&self, output: &mut impl Write) -> io::Result<()> {
        let mut file = tempfile::tempfile()?;
        let mut buffered = BufWriter::new(&file);
        exr::write(self, &mut buffered)?;
        buffered.flush()?;
        drop(buffered);
        file.rewind()?;
        io::copy(&mut file, output)?;
        Ok(())
    }

    /// Writes a byte a sample and nothing else: red, green and blue of each pixel as
    /// [`display_byte`] shows them, rows from the **top**, a row from left to right.
    ///
    /// ```
    /// let image = firsthit::Image::new(2)?;
    /// let mut bytes = Vec::new();
    /// image.write_rgb24(&mut bytes)?;
    /// assert_eq!(bytes, [0; 12]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of `output`.
    pub fn write_rgb24(&self, output: &mut impl Write) -> io::Result<()> {
        // Row by row: a second copy of a large picture would not fit beside it.
        let mut bytes = Vec::new();
        for row in self.rows_from_top() {
            bytes.clear();
            bytes.extend(row.iter().copied().map(display_byte));
            output.write_all(&bytes)?;
        }
        Ok(())
    }
}
