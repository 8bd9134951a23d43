//! The words of an ASCII grid.

use std::io::{BufRead, BufReader};

use super::input::Input;

/// Maximum length of a header line, and of a number.
const LONGEST_WORD: usize = 64;

/// Reads the words of a text. Each is at most as long as a number.
pub struct Words<'a> {
    input: BufReader<&'a mut dyn Input>,
    word: Vec<u8>,
}

impl<'a> Words<'a> {
    /// The words of `input`.
    pub fn new(input: &'a mut dyn Input) -> Words<'a> {
        Words { input: BufReader::new(input), word: Vec::new() }
    }

    /// Reads heights in the given numbers of columns and rows. `first` is the first word. Heights with the value
    /// `nodata` become NaN.
    ///
    /// # Errors
    /// A message if a word is not a number, or if there are too few words.
    pub fn heights(
        &mut self,
        first: Option<String>,
        [columns, rows]: [usize; 2],
        nodata: Option<f64>,
    ) -> Result<Vec<f32>, String> {
        let count = columns * rows;
        let mut heights: Vec<f32> = Vec::new();
        self.word.clear();
        self.word.extend_from_slice(first.unwrap_or_default().as_bytes());
        while heights.len() < count {
            // Words are ASCII.
            let word = str::from_utf8(&self.word).unwrap_or_default();
            if word.is_empty() {
                return Err(format!("it ends after {} heights; its header declares {columns} x {rows}", heights.len()));
            }
            let height = number(word).ok_or_else(|| {
                let (row, column) = (heights.len() / columns + 1, heights.len() % columns + 1);
                format!("`{}` in row {row}, column {column} is not a number", word.escape_debug())
            })?;
            heights.push(if nodata == Some(height) { f32::NAN } else { height as f32 });
            if heights.len() < count {
                self.advance()?;
            }
        }
        Ok(heights)
    }

    /// Skips the byte order mark that Windows editors write.
    ///
    /// # Errors
    /// A message if the input fails.
    pub fn skip_mark(&mut self) -> Result<(), String> {
        if self.input.fill_buf().map_err(|cause| cause.to_string())?.starts_with(b"\xef\xbb\xbf") {
            self.input.consume(3);
        }
        Ok(())
    }

    /// The next word; `None` at the end.
    ///
    /// # Errors
    /// A message if the input fails, or if a word does not belong in such a text.
    #[allow(clippy::should_implement_trait, reason = "it can fail")]
    pub fn next(&mut self) -> Result<Option<String>, String> {
        self.advance()?;
        Ok((!self.word.is_empty()).then(|| String::from_utf8_lossy(&self.word).into_owned()))
    }

    /// Advances to the next word, which is empty at the end.
    fn advance(&mut self) -> Result<(), String> {
        self.word.clear();
        loop {
            let buffer = self.input.fill_buf().map_err(|cause| cause.to_string())?;
            if buffer.is_empty() {
                break;
            }
            let blanks =
                if self.word.is_empty() { buffer.iter().take_while(|b| b.is_ascii_whitespace()).count() } else { 0 };
            let rest = &buffer[blanks..];
            let letters = rest.iter().position(|b| b.is_ascii_whitespace()).unwrap_or(rest.len());
            self.word.extend_from_slice(&rest[..letters.min(LONGEST_WORD + 1)]);
            let ended = letters < rest.len();
            self.input.consume(blanks + letters);
            if self.word.len() > LONGEST_WORD || self.word.iter().any(|byte| !(0x20..0x7f).contains(byte)) {
                return Err("it is not an ASCII grid: it contains more than words and numbers".into());
            }
            if ended && !self.word.is_empty() {
                break;
            }
        }
        Ok(())
    }
}

/// The number that a word represents, with a decimal point or comma.
#[must_use]
pub fn number(word: &str) -> Option<f64> {
    // Some locales write decimal commas.
    match word.contains(',') {
        true => word.replace(',', ".").parse().ok(),
        false => word.parse().ok(),
    }
}
