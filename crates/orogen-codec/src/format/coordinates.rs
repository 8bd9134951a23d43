//! Positions of lines and areas, as lists of numbers with `each` numbers per position.

use std::ops::Range;

use super::number::number;

/// The bounds (west, south, east, north) that contain two others.
#[must_use]
pub fn join(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}

/// The bounds (west, south, east, north) of positions and of `others`; `None` if there are neither.
#[must_use]
pub fn bounds(numbers: &[f64], each: usize, others: Option<[f64; 4]>) -> Option<[f64; 4]> {
    numbers.chunks_exact(each).map(|at| [at[0], at[1], at[0], at[1]]).fold(others, |bounds, own| match bounds {
        Some(bounds) => Some(join(bounds, own)),
        None => Some(own),
    })
}

/// Converts positions to the coordinates of a map, in which the world's origin is at `origin` and `per_metre` is the
/// number of units per metre. Without a map, y is only negated, so that it points north.
pub fn place(numbers: &mut [f64], each: usize, map: Option<([f64; 2], [f64; 2])>) {
    for at in numbers.chunks_exact_mut(each) {
        let (x, y) = (at[0], at[1]);
        [at[0], at[1]] = match map {
            Some((origin, per_metre)) => [origin[0] + x * per_metre[0], origin[1] - y * per_metre[1]],
            None => [x, -y],
        };
    }
}

/// Appends the numbers with the indices `taken` of each position, little-endian.
pub fn append_bytes(numbers: &[f64], each: usize, taken: Range<usize>, bytes: &mut Vec<u8>) {
    bytes.reserve(numbers.len() / each * taken.len() * 8);
    for at in numbers.chunks_exact(each) {
        bytes.extend(at[taken.clone()].iter().flat_map(|number| number.to_le_bytes()));
    }
}

/// Appends a list of positions as JSON, with the first `taken` numbers of each position. Heights have three decimals.
pub fn append_list(text: &mut String, numbers: &[f64], each: usize, taken: usize, decimals: usize) {
    text.push('[');
    for (k, at) in numbers.chunks_exact(each).enumerate() {
        if k > 0 {
            text.push(',');
        }
        append_position(text, &at[..taken], decimals);
    }
    text.push(']');
}

/// Appends a position as JSON. Heights have three decimals.
pub fn append_position(text: &mut String, at: &[f64], decimals: usize) {
    text.push('[');
    for (k, value) in at.iter().enumerate() {
        if k > 0 {
            text.push(',');
        }
        number(text, *value, if k < 2 { decimals } else { 3 });
    }
    text.push(']');
}

/// Appends a line as path commands of SVG, relative to `origin`.
pub fn append_path(text: &mut String, line: &[[f64; 2]], origin: [f64; 2], decimals: usize) {
    for (k, [x, y]) in line.iter().enumerate() {
        text.push(if k == 0 { 'M' } else { 'L' });
        number(text, x - origin[0], decimals);
        text.push(' ');
        number(text, y - origin[1], decimals);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_and_places() {
        let mut line = [3.0, 4.0, 9.0, -1.0, 2.0, 8.0];
        assert_eq!(bounds(&line, 3, None), Some([-1.0, 2.0, 3.0, 4.0]));
        assert_eq!(bounds(&line, 3, Some([0.0, 0.0, 5.0, 1.0])), Some([-1.0, 0.0, 5.0, 4.0]));
        assert_eq!(bounds(&[], 2, None), None);
        place(&mut line, 3, Some(([100.0, 200.0], [2.0, 0.5])));
        assert_eq!(line, [106.0, 198.0, 9.0, 98.0, 199.0, 8.0]);
        place(&mut line, 3, None);
        assert_eq!(line[..2], [106.0, -198.0]);
    }

    #[test]
    fn lists_and_bytes_take_what_they_are_told() {
        let mut text = String::new();
        append_list(&mut text, &[1.0, 2.5, 7.0, 3.0, 4.0, 8.0], 3, 2, 1);
        assert_eq!(text, "[[1,2.5],[3,4]]");
        let mut bytes = Vec::new();
        append_bytes(&[1.0, 2.5, 7.0], 3, 0..2, &mut bytes);
        assert_eq!(bytes, [1.0f64.to_le_bytes(), 2.5f64.to_le_bytes()].concat());
    }
}
