//! Decompression of blocks of OpenEXR pictures.

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

/// The message for a damaged picture.
#[must_use]
pub fn damaged() -> String {
    "it is a damaged OpenEXR picture".into()
}

/// Removes `count` bytes from the front of `rest` and returns them.
///
/// # Errors
/// A message if there are not enough bytes.
pub fn take<'a>(rest: &mut &'a [u8], count: usize) -> Result<&'a [u8], String> {
    let (head, tail) = rest.split_at_checked(count).ok_or_else(damaged)?;
    *rest = tail;
    Ok(head)
}

/// Decompresses a block to `due` bytes.
///
/// # Errors
/// A message if the block is damaged.
pub fn unpack(packing: u8, packed: &[u8], due: usize) -> Result<Vec<u8>, String> {
    let mut parted = match packing {
        1 => runs(packed, due)?,
        2 | 3 => decompress_to_vec_zlib_with_limit(packed, due).map_err(|_| damaged())?,
        _ => return Err(damaged()),
    };
    if parted.len() != due {
        return Err(damaged());
    }
    for k in 1..due {
        parted[k] = parted[k].wrapping_add(parted[k - 1]).wrapping_sub(128);
    }
    let (even, odd) = parted.split_at(due.div_ceil(2));
    Ok((0..due).map(|k| if k % 2 == 0 { even[k / 2] } else { odd[k / 2] }).collect())
}

/// Run-length coding: a negative count is followed by that number of literal bytes; any other count is followed by a
/// byte that is repeated count + 1 times.
fn runs(packed: &[u8], due: usize) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    let mut rest = packed;
    while !rest.is_empty() {
        match take(&mut rest, 1)?[0] as i8 {
            count @ ..0 => out.extend_from_slice(take(&mut rest, usize::from(count.unsigned_abs()))?),
            count => {
                let byte = take(&mut rest, 1)?[0];
                out.resize(out.len() + count as usize + 1, byte);
            }
        }
        if out.len() > due {
            return Err(damaged());
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_bytes() {
        assert_eq!(runs(&[2, 7, 0xfe, 1, 2], 5), Ok(vec![7, 7, 7, 1, 2]));
        assert!(runs(&[9, 7], 5).is_err() && runs(&[0x80, 1], 500).is_err());
    }
}
