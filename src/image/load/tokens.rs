//! A file that begins with words of text, as PFM and PPM do.

use std::fmt::Display;
use std::io::{self, BufRead};
use std::str::FromStr;

use super::Problem;

/// The longest word: more is no number that a picture has.
const MAX_WORD: usize = 64;

/// What is left of a file.
pub(super) struct Tokens<R>(pub(super) R);

impl<R: BufRead> Tokens<R> {
    /// The next word, and past one character of white space behind it. Comments, from `#` to the
    /// end of a line, are skipped before it.
    pub(super) fn word(&mut self) -> Result<String, Problem> {
        let mut word = Vec::new();
        while let Some(byte) = self.next()? {
            match byte {
                b'#' if word.is_empty() => {
                    while !matches!(self.next()?, None | Some(b'\n' | b'\r')) {}
                }
                _ if !byte.is_ascii_whitespace() => word.push(byte),
                _ if word.is_empty() => {}
                _ => break,
            }
            if word.len() > MAX_WORD {
                let reason = format!("one of its words has more than {MAX_WORD} characters");
                return Err(Problem::Damaged(reason));
            }
        }
        Ok(String::from_utf8_lossy(&word).escape_debug().to_string())
    }

    /// The next word as a number; `what` it is.
    pub(super) fn number<T: FromStr>(&mut self, what: impl Display) -> Result<T, Problem> {
        let word = self.word()?;
        if word.is_empty() {
            return Err(Problem::Damaged(format!("it ends before {what}")));
        }
        let not_one = |_| Problem::Damaged(format!("{what} is “{word}”, not such a number"));
        word.parse().map_err(not_one)
    }

    /// The next bytes.
    pub(super) fn bytes<const COUNT: usize>(&mut self) -> Result<[u8; COUNT], Problem> {
        let mut bytes = [0; COUNT];
        for byte in &mut bytes {
            let next = self.next()?;
            let missing = || Problem::Damaged("it ends before its last pixel".to_owned());
            *byte = next.ok_or_else(missing)?;
        }
        Ok(bytes)
    }

    /// Refuses a file that goes on, but for white space: a line break of two characters before the
    /// pixels would shift all of them, for instance.
    pub(super) fn end(&mut self) -> Result<(), Problem> {
        while let Some(byte) = self.next()? {
            if !byte.is_ascii_whitespace() {
                return Err(Problem::Damaged(
                    "it goes on after its last pixel".to_owned(),
                ));
            }
        }
        Ok(())
    }

    fn next(&mut self) -> Result<Option<u8>, Problem> {
        loop {
            match self.0.fill_buf() {
                Ok(buffer) => {
                    let byte = buffer.first().copied();
                    self.0.consume(usize::from(byte.is_some()));
                    return Ok(byte);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(Problem::Io(error)),
            }
        }
    }
}
