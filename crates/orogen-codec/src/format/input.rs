//! The sources of readers, and their memory limits.

use std::io::{Read, Seek};

use orogen_grid::words::bytes_apart;

/// The source of a reader: a file, or bytes in memory.
pub trait Input: Read + Seek {}

impl<T: Read + Seek> Input for T {}

/// Checks, before allocation, that `width` x `height` heights fit in `allowed` bytes. Returns the number of heights.
///
/// # Errors
/// A message with both sizes.
pub fn afford(width: u64, height: u64, allowed: u64) -> Result<usize, String> {
    if width == 0 || height == 0 {
        return Err(format!("its header declares {width} x {height} samples, which is empty"));
    }
    let needed = width.saturating_mul(height).saturating_mul(4);
    match needed > allowed || needed > isize::MAX as u64 {
        true => {
            let [needed, allowed] = bytes_apart(needed, allowed);
            Err(format!(
                "its {width} x {height} samples need {needed} of memory, and {allowed} is allowed; cut out a part of it, or raise the memory limit"
            ))
        }
        false => Ok((width * height) as usize),
    }
}

/// Size of a reader's buffers, in bytes, that does not count towards the limit.
const BUFFER: u64 = 4 << 20;

/// Checks that `beside` bytes, which a reader needs during decompression, fit in `allowed` bytes in addition to `count`
/// heights.
///
/// # Errors
/// A message with both sizes.
pub fn afford_beside(count: usize, beside: u64, allowed: u64) -> Result<(), String> {
    let needed = (count as u64).saturating_mul(4).saturating_add(beside);
    match beside > BUFFER && needed > allowed {
        true => {
            let [needed, allowed] = bytes_apart(needed, allowed);
            Err(format!(
                "reading it needs {needed} of memory for its heights and one decompressed block, and {allowed} is allowed; save it with smaller blocks, or raise the memory limit"
            ))
        }
        false => Ok(()),
    }
}

/// Reverses the order of the rows, in place.
pub fn turn_rows(samples: &mut [f32], width: usize) {
    let rows = samples.len().checked_div(width).unwrap_or(0);
    for j in 0..rows / 2 {
        let (upper, lower) = samples.split_at_mut((rows - 1 - j) * width);
        upper[j * width..(j + 1) * width].swap_with_slice(&mut lower[..width]);
    }
}

/// The length of an input in bytes. Afterwards its position is at the start.
pub fn length(input: &mut dyn Input) -> Result<u64, String> {
    let length = input.seek(std::io::SeekFrom::End(0)).map_err(|cause| cause.to_string())?;
    input.rewind().map_err(|cause| cause.to_string())?;
    Ok(length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_known_before_memory_is_taken() {
        assert_eq!(afford(1 << 10, 1 << 10, 1 << 22), Ok(1 << 20));
        let why = afford(1 << 16, 1 << 16, 1 << 30).unwrap_err();
        assert!(why.contains("16 GiB") && why.contains("1.0 GiB"), "{why}");
        assert!(afford(u64::MAX, u64::MAX, u64::MAX).is_err());
        assert!(afford(0, 5, 100).unwrap_err().contains("0 x 5 samples, which is empty"));
    }
}
