//! NumPy's `.npy`: the unchanged samples.
//!
//! The format is NEP 1 (numpy.lib.format): a magic number, a version, the length of the header, the header as a Python
//! dictionary padded so that the data begins at a multiple of 64, and the data. The writer produces version 1.0 with
//! `<f4` in C order. The reader accepts versions 1 to 3, one or two dimensions, and floats and integers of any byte
//! order in C order. It allocates memory only for bytes that exist, not for those that a header claims.

use std::io::{self, Read, Write};

use super::input::afford;
use super::stored::{Kind, Stored};
use crate::samples;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};

const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// Maximum length of a header. NumPy's own reader has the same limit.
const LONGEST_HEADER: usize = 10_000;

/// Number of bytes that are converted at a time, a multiple of every sample size.
const PIECE: usize = 1 << 16;

/// Writes a grid as an array of `height` x `width` f32, little-endian.
pub fn write(out: &mut dyn Write, grid: &Grid) -> io::Result<()> {
    write_header(out, grid.width(), grid.height())?;
    write_rows(out, grid.data())
}

/// Writes everything before the samples of a grid. Exactly `width * height` samples must follow with [`write_rows`].
pub fn write_header(out: &mut dyn Write, width: usize, height: usize) -> io::Result<()> {
    write_shape(out, &[height, width])
}

/// Writes everything before the samples of an array with any number of dimensions, of which the last varies fastest.
/// Exactly as many samples as the product of `shape` must follow with [`write_rows`].
pub fn write_shape(out: &mut dyn Write, shape: &[usize]) -> io::Result<()> {
    // Python writes a tuple of one element with a trailing comma.
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    let comma = if sides.len() == 1 { "," } else { "" };
    let shape = format!("({}{comma})", sides.join(", "));
    let mut header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
    let before = MAGIC.len() + 2 + 2;
    // The newline ends the header, and the data after it begins at a multiple of 64.
    let total = (before + header.len() + 1).next_multiple_of(64);
    while before + header.len() + 1 < total {
        header.push(' ');
    }
    header.push('\n');
    out.write_all(MAGIC)?;
    out.write_all(&[1, 0])?;
    out.write_all(&(header.len() as u16).to_le_bytes())?;
    out.write_all(header.as_bytes())
}

/// Writes the next samples of an array, row-major. Any number of samples can be written at a time.
pub fn write_rows(out: &mut dyn Write, samples: &[f32]) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(PIECE.min(samples.len() * 4));
    for piece in samples.chunks(PIECE / 4) {
        bytes.clear();
        samples::append_bytes(&mut bytes, piece);
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Reads an array as a grid that starts at the origin, with `cell` metres between samples (the file does not store it).
/// A one-dimensional array becomes one row. Wider numbers are rounded to f32.
///
/// `name` is the name of the file in error messages.
pub fn read(input: &mut dyn Read, name: &str, cell: f64) -> Result<Grid> {
    read_within(input, name, cell, u64::MAX)
}

/// [`read`] with a limit of `allowed` bytes for the samples as f32.
pub fn read_within(input: &mut dyn Read, name: &str, cell: f64, allowed: u64) -> Result<Grid> {
    let refuse = |why: String| Error::new(ErrorKind::File, format!("cannot read {name}: {why}"));
    let header = read_header(input).map_err(refuse)?;
    afford(header.shape[1] as u64, header.shape[0] as u64, allowed).map_err(refuse)?;
    let data = read_samples(input, &header).map_err(refuse)?;
    let [height, width] = header.shape;
    Grid::from_data(Window::new(width, height, cell), data)
        .ok_or_else(|| refuse("the samples do not fill its shape".into()))
}

/// A parsed and validated header.
#[derive(Debug, PartialEq)]
struct Header {
    kind: Kind,
    size: usize,
    big_endian: bool,
    /// Number of rows and of columns.
    shape: [usize; 2],
}

/// Fills `bytes`; fails if the file ends before they are complete.
fn read_exactly(input: &mut dyn Read, bytes: &mut [u8], what: &str) -> std::result::Result<(), String> {
    input.read_exact(bytes).map_err(|cause| match cause.kind() {
        io::ErrorKind::UnexpectedEof => format!("it ends within its {what}"),
        _ => cause.to_string(),
    })
}

fn read_header(input: &mut dyn Read) -> std::result::Result<Header, String> {
    let mut start = [0; 8];
    let not_npy = "it is not a NumPy .npy file";
    read_exactly(input, &mut start, "header").map_err(|_| not_npy.to_string())?;
    if &start[..6] != MAGIC {
        return Err(not_npy.into());
    }
    let length = match start[6] {
        1 => {
            let mut length = [0; 2];
            read_exactly(input, &mut length, "header")?;
            usize::from(u16::from_le_bytes(length))
        }
        2 | 3 => {
            let mut length = [0; 4];
            read_exactly(input, &mut length, "header")?;
            u32::from_le_bytes(length) as usize
        }
        version => {
            return Err(format!("it is a .npy file of version {version}.{}; versions 1 to 3 are supported", start[7]));
        }
    };
    if length > LONGEST_HEADER {
        return Err(format!("its header declares {length} bytes; at most {LONGEST_HEADER} are supported"));
    }
    let mut text = vec![0; length];
    read_exactly(input, &mut text, "header")?;
    let text = std::str::from_utf8(&text).map_err(|_| "its header is not text".to_string())?;
    parse_header(text)
}

fn parse_header(text: &str) -> std::result::Result<Header, String> {
    let mut rest = Scanner(text);
    let (mut descr, mut fortran, mut shape) = (None, None, None);
    rest.expect('{')?;
    while !rest.eat('}') {
        let key = rest.string()?;
        rest.expect(':')?;
        match key {
            "descr" => {
                descr = Some(rest.string().map_err(|_| {
                    "its samples are records of several values; only plain numbers are supported".to_string()
                })?);
            }
            "fortran_order" => fortran = Some(rest.boolean()?),
            "shape" => shape = Some(rest.tuple()?),
            other => return Err(format!("its header has an unknown key '{other}'")),
        }
        if !rest.eat(',') {
            rest.expect('}')?;
            break;
        }
    }
    let (Some(descr), Some(fortran), Some(shape)) = (descr, fortran, shape) else {
        return Err("its header lacks one of descr, fortran_order and shape".into());
    };
    let (kind, size, big_endian) = sample_type(descr)?;
    let shape = match shape[..] {
        [columns] => [1, columns],
        [rows, columns] => [rows, columns],
        _ => return Err(format!("it has {} dimensions; heights have two", shape.len())),
    };
    if fortran && shape[0] > 1 && shape[1] > 1 {
        return Err("its samples are in Fortran order; save it with numpy.ascontiguousarray".into());
    }
    let [rows, columns] = shape;
    if rows == 0 || columns == 0 {
        return Err(format!("it is empty: its shape is ({rows}, {columns})"));
    }
    // This also keeps sums of a window's coordinates far from overflow.
    match rows.checked_mul(columns).and_then(|n| n.checked_mul(size)) {
        Some(bytes) if bytes <= isize::MAX as usize => Ok(Header { kind, size, big_endian, shape }),
        _ => Err(format!("its shape ({rows}, {columns}) is impossibly large")),
    }
}

fn sample_type(descr: &str) -> std::result::Result<(Kind, usize, bool), String> {
    let unknown = || format!("its samples are of type '{descr}'; supported are f4, f8, i1, i2, i4, u1, u2 and u4");
    let (order, kind) = descr.split_at_checked(1).ok_or_else(unknown)?;
    let (kind, size) = match kind {
        "f4" => (Kind::Float, 4),
        "f8" => (Kind::Float, 8),
        "i1" => (Kind::Signed, 1),
        "i2" => (Kind::Signed, 2),
        "i4" => (Kind::Signed, 4),
        "u1" => (Kind::Unsigned, 1),
        "u2" => (Kind::Unsigned, 2),
        "u4" => (Kind::Unsigned, 4),
        _ => return Err(unknown()),
    };
    match order {
        "<" => Ok((kind, size, false)),
        ">" => Ok((kind, size, true)),
        "|" if size == 1 => Ok((kind, size, false)),
        _ => Err(unknown()),
    }
}

/// Reads the samples in pieces, so that memory grows only with bytes that exist.
fn read_samples(input: &mut dyn Read, header: &Header) -> std::result::Result<Vec<f32>, String> {
    let count = header.shape[0] * header.shape[1];
    let stored = Stored { kind: header.kind, size: header.size, big_endian: header.big_endian };
    let mut samples: Vec<f32> = Vec::new();
    let mut bytes = vec![0; PIECE];
    while samples.len() < count {
        let piece = (count - samples.len()).min(PIECE / header.size) * header.size;
        read_exactly(input, &mut bytes[..piece], "samples")
            .map_err(|why| format!("{why}; its header declares {} x {}", header.shape[0], header.shape[1]))?;
        stored.append(&bytes[..piece], None, &mut samples);
    }
    match input.read(&mut bytes[..1]) {
        Ok(0) => Ok(samples),
        Ok(_) => Err(format!(
            "it continues after its samples; its header declares {} x {}",
            header.shape[0], header.shape[1]
        )),
        Err(cause) => Err(cause.to_string()),
    }
}

/// A parser for the Python literals of a header.
struct Scanner<'a>(&'a str);

impl<'a> Scanner<'a> {
    fn bad<T>(&self) -> std::result::Result<T, String> {
        let near: String = self.0.trim_start().chars().take(20).collect();
        match near.is_empty() {
            true => Err("its header ends too early".into()),
            false => Err(format!("its header cannot be understood near \"{}\"", near.escape_debug())),
        }
    }

    fn eat(&mut self, c: char) -> bool {
        self.0 = self.0.trim_start();
        match self.0.strip_prefix(c) {
            Some(rest) => {
                self.0 = rest;
                true
            }
            None => false,
        }
    }

    fn expect(&mut self, c: char) -> std::result::Result<(), String> {
        if self.eat(c) { Ok(()) } else { self.bad() }
    }

    fn string(&mut self) -> std::result::Result<&'a str, String> {
        for quote in ['\'', '"'] {
            let before = self.0;
            if self.eat(quote) {
                let Some((text, rest)) = self.0.split_once(quote) else {
                    self.0 = before;
                    return self.bad();
                };
                self.0 = rest;
                return Ok(text);
            }
        }
        self.bad()
    }

    fn boolean(&mut self) -> std::result::Result<bool, String> {
        self.0 = self.0.trim_start();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.0.strip_prefix(word) {
                self.0 = rest;
                return Ok(value);
            }
        }
        self.bad()
    }

    fn tuple(&mut self) -> std::result::Result<Vec<usize>, String> {
        self.expect('(')?;
        let mut numbers = Vec::new();
        while !self.eat(')') {
            self.0 = self.0.trim_start();
            let digits = self.0.find(|c: char| !c.is_ascii_digit()).unwrap_or(self.0.len());
            let Ok(number) = self.0[..digits].parse() else {
                return self.bad();
            };
            numbers.push(number);
            self.0 = self.0[digits..].strip_prefix('L').unwrap_or(&self.0[digits..]);
            if !self.eat(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        let data = (0..15).map(|i| i as f32 * 0.1 - 0.7).collect();
        Grid::from_data(Window::new(5, 3, 2.0), data).unwrap()
    }

    /// A file with the header `text`, followed by `data`.
    fn file(text: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn read_bytes(bytes: &[u8]) -> Result<Grid> {
        read(&mut &bytes[..], "a.npy", 2.0)
    }

    #[test]
    fn the_header_is_numpys_own() {
        let mut bytes = Vec::new();
        write(&mut bytes, &grid()).unwrap();
        let text = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 5), }";
        assert_eq!(&bytes[..10], b"\x93NUMPY\x01\x00\x76\x00");
        assert_eq!(std::str::from_utf8(&bytes[10..128]).unwrap().trim_end(), text);
        assert_eq!((bytes[127], bytes.len()), (b'\n', 128 + 15 * 4));
        assert_eq!(&bytes[128..132], (-0.7f32).to_le_bytes());
    }

    #[test]
    fn shapes_are_python_tuples() {
        for (shape, text) in [(&[7][..], "(7,)"), (&[2, 3], "(2, 3)"), (&[4, 3, 2], "(4, 3, 2)")] {
            let mut bytes = Vec::new();
            write_shape(&mut bytes, shape).unwrap();
            assert!(String::from_utf8_lossy(&bytes).contains(&format!("'shape': {text}, }}")), "{shape:?}");
            assert_eq!(bytes.len() % 64, 0);
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut bytes = Vec::new();
        write(&mut bytes, &grid()).unwrap();
        assert_eq!(read_bytes(&bytes).unwrap(), grid());
        let large = Grid::filled(Window::new(401, 307, 2.0), 3.5);
        bytes.clear();
        write(&mut bytes, &large).unwrap();
        assert_eq!(read_bytes(&bytes).unwrap(), large);
    }

    #[test]
    fn every_type_and_byte_order_is_read() {
        let check = |descr: &str, data: &[u8], expect: [f32; 2]| {
            let text = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 2)}}");
            assert_eq!(read_bytes(&file(&text, data)).unwrap().data(), expect, "{descr}");
        };
        check("<f4", &[0, 0, 192, 63, 0, 0, 0, 192], [1.5, -2.0]);
        check(">f4", &[63, 192, 0, 0, 192, 0, 0, 0], [1.5, -2.0]);
        check("<f8", &[1.5f64.to_le_bytes(), (-2.0f64).to_le_bytes()].concat(), [1.5, -2.0]);
        check(">f8", &[1.5f64.to_be_bytes(), (-2.0f64).to_be_bytes()].concat(), [1.5, -2.0]);
        check("|u1", &[7, 255], [7.0, 255.0]);
        check("|i1", &[7, 255], [7.0, -1.0]);
        check("<u2", &[1, 2, 255, 255], [513.0, 65535.0]);
        check(">i2", &[2, 1, 255, 255], [513.0, -1.0]);
        check("<i4", &[1, 0, 0, 0, 255, 255, 255, 255], [1.0, -1.0]);
        check(">u4", &[0, 0, 0, 1, 0, 1, 0, 0], [1.0, 65536.0]);
    }

    #[test]
    fn other_spellings_of_a_header_are_read() {
        for text in [
            "{\"shape\":(1,2),\"fortran_order\":False,\"descr\":\"<f4\"}\n",
            "{'descr': '<f4', 'fortran_order': True, 'shape': (2L,), }   \n",
            "{ 'fortran_order' : True , 'descr':'<f4' , 'shape' : ( 1 , 2 , ) , } ",
        ] {
            assert_eq!(read_bytes(&file(text, &[0; 8])).unwrap().data(), [0.0, 0.0], "{text}");
        }
    }

    #[test]
    fn a_file_cut_anywhere_is_a_sentence() {
        let mut bytes = Vec::new();
        write(&mut bytes, &grid()).unwrap();
        for n in 0..bytes.len() {
            let error = read_bytes(&bytes[..n]).unwrap_err().to_string();
            assert!(error.starts_with("cannot read a.npy: it "), "{n}: {error}");
        }
        bytes.push(0);
        assert!(read_bytes(&bytes).unwrap_err().to_string().contains("continues after"));
    }

    #[test]
    fn lying_and_foreign_headers_are_sentences() {
        let check = |text: &str, expect: &str| {
            let error = read_bytes(&file(text, &[0; 8])).unwrap_err().to_string();
            assert!(error.contains(expect), "{text}: {error}");
        };
        let header = |descr: &str, order: &str, shape: &str| {
            format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}")
        };
        let shape = |shape: &str| header("'<f4'", "False", shape);
        check(&shape("(1000000, 1000000)"), "it ends within its samples; its header declares 1000000 x 1000000");
        check(&shape("(18446744073709551615, 2)"), "impossibly large");
        check(&shape("(99999999999999999999999, 2)"), "cannot be understood near \"9999");
        check(&shape("(-1, 2)"), "cannot be understood near \"-1");
        check(&shape("(0, 2)"), "empty");
        check(&shape("()"), "0 dimensions");
        check(&shape("(1, 1, 2)"), "3 dimensions");
        check(&shape("(1, 2"), "cannot be understood");
        check(&header("'<f4'", "True", "(2, 2)"), "Fortran order");
        check(&header("'<f4'", "Maybe", "(1, 2)"), "near \"Maybe");
        check(&header("'<c8'", "False", "(1, 2)"), "of type '<c8'");
        check(&header("'é4'", "False", "(1, 2)"), "of type 'é4'");
        check(&header("''", "False", "(1, 2)"), "of type ''");
        check(&header("[('x', '<f4')]", "False", "(1, 2)"), "records");
        check("{'descr': '<f4'}", "lacks");
        check("{'colour': '<f4'}", "unknown key 'colour'");
        check("{'descr", "cannot be understood");
        check("", "ends too early");
        check("[1, 2]", "near \"[1, 2]");
    }

    #[test]
    fn what_is_no_npy_is_a_sentence() {
        for bytes in [&b""[..], b"\x89PNG\r\n\x1a\n", b"\x93NUMP", &[0; 1000]] {
            assert!(read_bytes(bytes).unwrap_err().to_string().contains("not a NumPy .npy file"));
        }
        assert!(read_bytes(b"\x93NUMPY\x09\x01").unwrap_err().to_string().contains("version 9.1"));
        assert!(
            read_bytes(b"\x93NUMPY\x02\x00\xff\xff\xff\xff")
                .unwrap_err()
                .to_string()
                .contains("declares 4294967295 bytes")
        );
    }
}
