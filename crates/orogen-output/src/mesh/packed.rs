//! Compact storage of triangles.

use super::tile::Sample;

/// Number of triangles of a piece.
pub(super) const PIECE: usize = 1 << 14;

/// The first byte of a triangle whose vertices are stored in full.
const FULL: i8 = i8::MIN;

/// Bits of the offset from the first vertex to another one, and the largest offset.
const STEP: u32 = 6;
const MOST: i32 = 31;

/// Triangles of samples of a tile, in order, as bytes.
///
/// A triangle is usually small and close to the previous one. It then takes five bytes: the offset in columns and rows
/// of its first vertex from the previous first vertex, one byte each, and the offsets of the other two vertices from
/// its first one, six bits each. Other triangles take 13 bytes. Pieces can be read separately.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PackedTriangles {
    bytes: Box<[u8]>,
    /// The start of each piece, and the end of the last one.
    starts: Box<[usize]>,
    count: usize,
}

impl PackedTriangles {
    /// Iterates over the triangles twice, so that it allocates exactly the needed memory.
    pub fn new(triangles: impl Iterator<Item = [Sample; 3]> + Clone) -> PackedTriangles {
        let (mut length, mut count, mut starts) = (0, 0, Vec::new());
        encode(triangles.clone(), |triangle| {
            if count % PIECE == 0 {
                starts.push(length);
            }
            count += 1;
            length += triangle.len();
        });
        starts.push(length);
        let mut bytes = Vec::with_capacity(length);
        encode(triangles, |triangle| bytes.extend_from_slice(triangle));
        PackedTriangles { bytes: bytes.into(), starts: starts.into(), count }
    }

    /// Number of triangles.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        self.starts.len() - 1
    }

    /// Calls `each` with the columns and rows of the vertices of each triangle of a piece, in order.
    pub fn piece(&self, piece: usize, mut each: impl FnMut([[i32; 2]; 3])) {
        let mut rest = &self.bytes[self.starts[piece]..self.starts[piece + 1]];
        let mut before = [0; 2];
        loop {
            let triangle = match rest {
                [first, full @ ..] if *first == FULL as u8 => {
                    let Some((numbers, after)) = full.split_first_chunk::<12>() else { return };
                    rest = after;
                    let (numbers, _) = numbers.as_chunks::<4>();
                    [0, 1, 2].map(|k| Sample::from_number(u32::from_le_bytes(numbers[k])).place())
                }
                _ => {
                    let Some((&[right, down, small @ ..], after)) = rest.split_first_chunk::<5>() else { return };
                    rest = after;
                    let first = [before[0] + i32::from(right as i8), before[1] + i32::from(down as i8)];
                    let small = u32::from_le_bytes([small[0], small[1], small[2], 0]);
                    // Shifted up and down again for sign extension.
                    let step = |k: u32| (small << (32 - STEP * (k + 1))) as i32 >> (32 - STEP);
                    [first, [first[0] + step(0), first[1] + step(1)], [first[0] + step(2), first[1] + step(3)]]
                }
            };
            before = triangle[0];
            each(triangle);
        }
    }
}

/// Calls `each` with the bytes of each triangle.
fn encode(triangles: impl Iterator<Item = [Sample; 3]>, mut each: impl FnMut(&[u8])) {
    let mut before = [0; 2];
    for (k, triangle) in triangles.enumerate() {
        if k % PIECE == 0 {
            before = [0; 2];
        }
        let places = triangle.map(Sample::place);
        let [first, ways @ ..] = [(before, 0), (places[0], 1), (places[0], 2)]
            .map(|(from, k)| [places[k][0] - from[0], places[k][1] - from[1]]);
        let is_near = first.iter().all(|way| (-127..=127).contains(way));
        let is_small = ways.as_flattened().iter().all(|way| (-MOST..=MOST).contains(way));
        before = places[0];
        match is_near && is_small {
            true => {
                let mask = (1 << STEP) - 1;
                let small = ways.as_flattened().iter().rev().fold(0, |bits, way| bits << STEP | (*way as u32 & mask));
                let [low, middle, high, _] = small.to_le_bytes();
                each(&[first[0] as u8, first[1] as u8, low, middle, high]);
            }
            false => {
                let mut full = [FULL as u8; 13];
                for (bytes, corner) in full[1..].chunks_exact_mut(4).zip(triangle) {
                    bytes.copy_from_slice(&corner.number().to_le_bytes());
                }
                each(&full);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_comes_out_in_order() {
        let mut state = 1u32;
        let mut draw = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((u64::from(state) * u64::from(below)) >> 32) as i32
        };
        for count in [0, 1, PIECE, 2 * PIECE + 5] {
            let triangles: Vec<[[i32; 2]; 3]> = (0..count)
                .map(|k| {
                    // Some extend across the tile, most are small and close together, and some end at a byte boundary.
                    let reach = [5, 34, 260, 1025][draw(4) as usize];
                    let left = (k as i32 / 64) % 700;
                    [0; 3].map(|_| [(left + draw(reach)).min(1024), draw(reach)])
                })
                .collect();
            let packed = PackedTriangles::new(triangles.iter().map(|triangle| triangle.map(Sample::at)));
            assert_eq!((packed.count(), packed.pieces()), (count, count.div_ceil(PIECE)));
            let mut found = Vec::new();
            for piece in 0..packed.pieces() {
                packed.piece(piece, |triangle| found.push(triangle));
                assert_eq!(found.len(), count.min((piece + 1) * PIECE));
            }
            assert_eq!(found, triangles);
        }
        let small = (0..5000).map(|k| [[k % 90, k / 90], [k % 90 + 1, k / 90], [k % 90, k / 90 + 1]].map(Sample::at));
        assert_eq!(PackedTriangles::new(small).bytes.len(), 5 * 5000);
    }
}
