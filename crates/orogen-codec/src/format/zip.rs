//! Reads the only file of a ZIP archive (APPNOTE 6.3), stored or compressed with deflate. SRTM tiles are distributed in
//! this form.

use std::io::{Read, SeekFrom};

use miniz_oxide::inflate::decompress_to_vec_with_limit;

use super::input::{Input, length};

/// Lengths of the fixed parts of the records, in bytes.
const END: usize = 22;
const CENTRAL: usize = 46;
const LOCAL: usize = 30;

/// Maximum length of the comment after the last record.
const MAX_COMMENT: u64 = 1 << 16;

/// The bytes of the only file in the archive, which must have at most `most` bytes.
///
/// # Errors
/// A message if the input is not a ZIP archive, or if the archive has several files or is damaged, encrypted or too
/// large.
pub fn only_file(input: &mut dyn Input, most: u64) -> Result<Vec<u8>, String> {
    let there = length(input)?;
    let tail = there.min(END as u64 + MAX_COMMENT);
    let bytes = part(input, there, there - tail, tail)?;
    let at = bytes.windows(4).rposition(|four| four == b"PK\x05\x06").ok_or("it is not a ZIP archive")?;
    let end = bytes.get(at..at + END).ok_or_else(damaged)?;
    if number(end, 10, 2)? != 1 {
        return Err(format!("it is an archive of {} files; unpack it first", number(end, 10, 2)?));
    }
    let central = part(input, there, number(end, 16, 4)?, CENTRAL as u64)?;
    if !central.starts_with(b"PK\x01\x02") {
        return Err(damaged());
    }
    let (method, packed, full) = (number(&central, 10, 2)?, number(&central, 20, 4)?, number(&central, 24, 4)?);
    if number(&central, 8, 2)? & 1 == 1 {
        return Err("its file is encrypted".into());
    }
    if full > most || packed > there {
        return Err(format!("its file has {full} bytes, and at most {most} are expected or allowed"));
    }
    let begin = number(&central, 42, 4)?;
    let local = part(input, there, begin, LOCAL as u64)?;
    if !local.starts_with(b"PK\x03\x04") {
        return Err(damaged());
    }
    let data = begin + LOCAL as u64 + number(&local, 26, 2)? + number(&local, 28, 2)?;
    let bytes = part(input, there, data, packed)?;
    let out = match method {
        0 => bytes,
        8 => decompress_to_vec_with_limit(&bytes, full as usize).map_err(|_| damaged())?,
        other => return Err(format!("its file is compressed with method {other}; only deflate is supported")),
    };
    if out.len() as u64 == full { Ok(out) } else { Err(damaged()) }
}

fn damaged() -> String {
    "it is a damaged ZIP archive".into()
}

/// Reads `count` bytes at offset `at` of an input of `there` bytes.
fn part(input: &mut dyn Input, there: u64, at: u64, count: u64) -> Result<Vec<u8>, String> {
    if at.checked_add(count).is_none_or(|end| end > there) {
        return Err(damaged());
    }
    input.seek(SeekFrom::Start(at)).map_err(|cause| cause.to_string())?;
    let mut bytes = Vec::new();
    input.take(count).read_to_end(&mut bytes).map_err(|cause| cause.to_string())?;
    if bytes.len() as u64 == count { Ok(bytes) } else { Err(damaged()) }
}

/// A little-endian number of `size` bytes.
fn number(bytes: &[u8], at: usize, size: usize) -> Result<u64, String> {
    let bytes = bytes.get(at..at + size).ok_or_else(damaged)?;
    Ok(bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::deflate::compress_to_vec;
    use std::io::Cursor;

    /// An archive of one file `a`.
    fn archive(method: u16, packed: &[u8], full: usize) -> Vec<u8> {
        let sizes = [&(packed.len() as u32).to_le_bytes()[..], &(full as u32).to_le_bytes()].concat();
        let local = [b"PK\x03\x04\x14\0\0\0", &method.to_le_bytes()[..], &[0; 8], &sizes, &[1, 0, 0, 0], b"a", packed];
        let mut out = local.concat();
        let at = out.len() as u32;
        let central =
            [b"PK\x01\x02\x14\0\x14\0\0\0", &method.to_le_bytes()[..], &[0; 8], &sizes, &[1, 0], &[0; 16], b"a"];
        out.extend(central.concat());
        out.extend([b"PK\x05\x06\0\0\0\0\x01\0\x01\0", &47u32.to_le_bytes()[..], &at.to_le_bytes(), &[0; 2]].concat());
        out
    }

    #[test]
    fn stored_and_compressed_files_are_read() {
        let bytes: Vec<u8> = (0..1000u32).map(|k| (k % 7) as u8).collect();
        let read = |archive: &[u8], most| only_file(&mut Cursor::new(archive), most);
        assert_eq!(read(&archive(0, &bytes, 1000), 1000).unwrap(), bytes);
        let packed = archive(8, &compress_to_vec(&bytes, 6), 1000);
        assert_eq!(read(&packed, 1000).unwrap(), bytes);
        assert!(read(&packed, 999).unwrap_err().contains("has 1000 bytes"));
        assert!(read(&archive(12, &bytes, 1000), 1000).unwrap_err().contains("method 12"));
        assert!(read(b"PK", 10).unwrap_err().contains("not a ZIP archive"));
        for n in 0..packed.len() {
            assert!(read(&packed[..n], 1000).is_err(), "{n}");
        }
        // Any damage gives a message or a file.
        for n in 0..packed.len() {
            let mut damaged = packed.clone();
            damaged[n] ^= 0xff;
            let _ = read(&damaged, 1000);
        }
    }
}
