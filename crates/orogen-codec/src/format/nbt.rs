//! Named binary tags (NBT) of Minecraft: Java Edition, in the form of files: big-endian, with strings in modified
//! UTF-8.
//!
//! Only the tags that other formats in this crate need are supported. Texts must be ASCII, which is unchanged in
//! modified UTF-8.

use std::io::{self, Write};

/// The data version of the game that defines the block states and the layout of worlds here: 1.20.4.
pub const DATA_VERSION: i32 = 3700;

/// The name of that version.
pub const GAME_VERSION: &str = "1.20.4";

/// The numbers of tag types.
const END: u8 = 0;
const BYTE: u8 = 1;
const SHORT: u8 = 2;
const INT: u8 = 3;
const LONG: u8 = 4;
const FLOAT: u8 = 5;
const BYTE_ARRAY: u8 = 7;
const STRING: u8 = 8;
const LIST: u8 = 9;
const COMPOUND: u8 = 10;
const INT_ARRAY: u8 = 11;
const LONG_ARRAY: u8 = 12;

/// Writes the tags of compounds in sequence.
pub struct Tags<'a> {
    out: &'a mut dyn Write,
}

impl<'a> Tags<'a> {
    /// Writes tags to `out`.
    pub fn new(out: &'a mut dyn Write) -> Tags<'a> {
        Tags { out }
    }

    fn head(&mut self, kind: u8, name: &str) -> io::Result<()> {
        self.out.write_all(&[kind])?;
        self.text(name)
    }

    fn text(&mut self, text: &str) -> io::Result<()> {
        let length =
            u16::try_from(text.len()).map_err(|_| io::Error::other("a text of NBT has more than 65535 bytes"))?;
        self.out.write_all(&length.to_be_bytes())?;
        self.out.write_all(text.as_bytes())
    }

    /// Begins a compound. Its tags follow until [`Tags::end`].
    pub fn compound(&mut self, name: &str) -> io::Result<()> {
        self.head(COMPOUND, name)
    }

    /// Ends a compound.
    pub fn end(&mut self) -> io::Result<()> {
        self.out.write_all(&[END])
    }

    /// Writes an 8-bit number. Truth values are 0 and 1.
    pub fn byte(&mut self, name: &str, number: u8) -> io::Result<()> {
        self.head(BYTE, name)?;
        self.out.write_all(&[number])
    }

    /// Writes a 16-bit number. Formats with unsigned numbers use the same bits.
    pub fn short(&mut self, name: &str, number: u16) -> io::Result<()> {
        self.head(SHORT, name)?;
        self.out.write_all(&number.to_be_bytes())
    }

    /// Writes a 32-bit number.
    pub fn int(&mut self, name: &str, number: i32) -> io::Result<()> {
        self.head(INT, name)?;
        self.out.write_all(&number.to_be_bytes())
    }

    /// Writes a 64-bit number.
    pub fn long(&mut self, name: &str, number: i64) -> io::Result<()> {
        self.head(LONG, name)?;
        self.out.write_all(&number.to_be_bytes())
    }

    /// Writes a 32-bit floating-point number.
    pub fn float(&mut self, name: &str, number: f32) -> io::Result<()> {
        self.head(FLOAT, name)?;
        self.out.write_all(&number.to_be_bytes())
    }

    /// Writes an array of 64-bit numbers.
    pub fn longs(&mut self, name: &str, numbers: &[u64]) -> io::Result<()> {
        self.head(LONG_ARRAY, name)?;
        self.length(numbers.len())?;
        numbers.iter().try_for_each(|number| self.out.write_all(&number.to_be_bytes()))
    }

    fn length(&mut self, length: usize) -> io::Result<()> {
        let length = i32::try_from(length).map_err(|_| io::Error::other("an array of NBT has more than 2 GiB"))?;
        self.out.write_all(&length.to_be_bytes())
    }

    /// Begins a list of compounds. The tags of each follow, with [`Tags::end`] after each; the list itself has no end.
    pub fn compounds(&mut self, name: &str, count: usize) -> io::Result<()> {
        self.head(LIST, name)?;
        self.out.write_all(&[COMPOUND])?;
        self.length(count)
    }

    /// Writes a list of texts of ASCII characters.
    pub fn strings(&mut self, name: &str, texts: &[&str]) -> io::Result<()> {
        self.head(LIST, name)?;
        self.out.write_all(&[STRING])?;
        self.length(texts.len())?;
        texts.iter().try_for_each(|text| self.text(text))
    }

    /// Writes an array of 32-bit numbers.
    pub fn ints(&mut self, name: &str, numbers: &[i32]) -> io::Result<()> {
        self.head(INT_ARRAY, name)?;
        self.length(numbers.len())?;
        numbers.iter().try_for_each(|number| self.out.write_all(&number.to_be_bytes()))
    }

    /// Writes a text of ASCII characters.
    pub fn string(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.head(STRING, name)?;
        self.text(text)
    }

    /// Writes an empty list of compounds.
    pub fn empty_list(&mut self, name: &str) -> io::Result<()> {
        self.compounds(name, 0)
    }

    /// Writes an array of bytes.
    pub fn bytes(&mut self, name: &str, bytes: &[u8]) -> io::Result<()> {
        self.head(BYTE_ARRAY, name)?;
        self.length(bytes.len())?;
        self.out.write_all(bytes)
    }
}
