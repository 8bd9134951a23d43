//! Bytes as hexadecimal digits: two lower-case digits for each byte.

/// The hexadecimal digits of `bytes`.
#[must_use]
pub fn encode(bytes: &[u8]) -> String {
    let digit = |value: u8| char::from_digit(u32::from(value), 16).unwrap_or_default();
    bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect()
}

/// The `N` bytes that hexadecimal digits in lower or upper case stand for. `None` if there are not exactly `2 N`
/// digits.
#[must_use]
pub fn decode<const N: usize>(digits: &str) -> Option<[u8; N]> {
    if digits.len() != 2 * N || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let mut bytes = [0; N];
    for (byte, pair) in bytes.iter_mut().zip(digits.as_bytes().chunks_exact(2)) {
        *byte = u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()?;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_and_bytes() {
        assert_eq!(encode(&[0, 9, 0xa, 0xf0, 0xff]), "00090af0ff");
        assert_eq!(decode("00090AF0ff"), Some([0, 9, 0xa, 0xf0, 0xff]));
        for text in ["", "0", "000", "0g", "+1", "é"] {
            assert_eq!(decode::<1>(text), None, "{text}");
        }
    }
}
