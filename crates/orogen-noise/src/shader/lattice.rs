//! Lattices for GPUs. The cells of columns and rows are computed here, in f64, so that positions keep their precision
//! at any distance from the origin. A shader only adds the fraction and the displacement of the sample.

/// Positions of the columns and rows of a window along each axis, in metres. The position of a sample is the sum of the
/// positions of its column and its row. An empty list contributes nothing; for example, columns in the plane have no y.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Positions {
    /// x and y of the columns.
    pub columns: [Vec<f64>; 2],
    /// x and y of the rows.
    pub rows: [Vec<f64>; 2],
}

/// A lattice. Coordinates in cells are `matrix` times the position in metres, plus `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Cells per metre, with a row for each axis of the lattice.
    pub matrix: [[f64; 2]; 2],
    /// Coordinates of the origin, in cells.
    pub offset: [f64; 2],
    /// Maximum absolute value of positions, in metres; others are clamped.
    pub limit: f64,
}

shader_constants! {
    /// The functions that find the cell of a sample, which every shader with lattices needs. The block of a lattice is
    /// its matrix as pairs of f32, and the tables of columns and rows along each axis.
    pub PLACE = "place.wgsl", LATTICE_TABLES = 8, LATTICE_WORDS = 12, TABLED_WORDS = 3
}

impl Lattice {
    /// Square cells along the axes with a side of `1 / frequency` metres.
    #[must_use]
    pub fn square(frequency: f64, offset: [f64; 2]) -> Lattice {
        Lattice { matrix: [[frequency, 0.0], [0.0, frequency]], offset, limit: f64::MAX }
    }

    /// Coordinates in units of `unit` metres from `origin`.
    #[must_use]
    pub fn metres(unit: f64, origin: [f64; 2]) -> Lattice {
        Lattice::square(1.0 / unit, origin.map(|origin| -origin / unit))
    }

    /// Appends the tables to `data` and returns the block. If the words of the hash along each axis are given, the
    /// tables contain the keys of cells instead of the cells.
    pub(super) fn encode(
        &self,
        positions: &Positions,
        hash: Option<&AxisWords>,
        data: &mut Vec<u32>,
    ) -> [u32; LATTICE_WORDS] {
        let mut block = [0; LATTICE_WORDS];
        for axis in 0..2 {
            for by in 0..2 {
                let factor = self.matrix[axis][by];
                // A pair of f32 has twice as many digits, so that displacements by many cells keep their fraction.
                let first = factor as f32;
                let [high, low] = [first, (factor - f64::from(first)) as f32];
                block[4 * axis + 2 * by] = high.to_bits();
                block[4 * axis + 2 * by + 1] = low.to_bits();
            }
            let offset = self.offset[axis];
            let columns = self.part(axis, &positions.columns);
            let rows = self.part(axis, &positions.rows);
            // The offset is added to only one of the two.
            let (to_columns, to_rows) = if columns.is_empty() { (0.0, offset) } else { (offset, 0.0) };
            let hash = hash.map(|words| words[axis]);
            block[LATTICE_TABLES + 2 * axis] = table(&columns, to_columns, hash, data);
            block[LATTICE_TABLES + 2 * axis + 1] = table(&rows, to_rows, hash, data);
        }
        block
    }

    /// The coordinates along an axis that columns or rows contribute, without the offset; empty if there are none.
    fn part(&self, axis: usize, at: &[Vec<f64>; 2]) -> Vec<f64> {
        let [by_x, by_y] = self.matrix[axis];
        let held = |position: f64| position.max(-self.limit).min(self.limit);
        match (at, by_x != 0.0, by_y != 0.0) {
            ([x, y], true, true) if !x.is_empty() && !y.is_empty() => {
                x.iter().zip(y).map(|(x, y)| held(*x) * by_x + held(*y) * by_y).collect()
            }
            ([x, _], true, _) if !x.is_empty() => x.iter().map(|x| held(*x) * by_x).collect(),
            ([_, y], _, true) if !y.is_empty() => y.iter().map(|y| held(*y) * by_y).collect(),
            // A lattice without cells along this axis: all samples are at its offset.
            ([x, y], false, false) => vec![0.0; x.len().max(y.len())],
            _ => Vec::new(),
        }
    }
}

/// The words of a hash along each axis.
pub type AxisWords = [[u32; 2]; 2];

/// The key of a cell along an axis, as computed by `noise_key` of `hash.wgsl`.
fn key([low, high]: [u32; 2], cell: i64) -> u32 {
    let here = (cell as u32).wrapping_mul(0x915f_77f5).wrapping_add(low);
    let upper = ((cell >> 32) as u32).wrapping_add(0x4338_0000);
    let key = (here ^ (here >> 15) ^ upper ^ high).wrapping_mul(0x93d7_65dd);
    key ^ (key >> 15)
}

/// Appends a table of cells: the low word, high word and fraction of each cell, or two keys and the fraction. Returns
/// its index, or 0 if there is no table.
fn table(coordinates: &[f64], offset: f64, hash: Option<[u32; 2]>, data: &mut Vec<u32>) -> u32 {
    if coordinates.is_empty() {
        return 0;
    }
    let at = data.len() as u32;
    for coordinate in coordinates {
        let coordinate = coordinate + offset;
        let whole = coordinate.floor();
        let fraction = (coordinate - whole) as f32;
        let cell = whole as i64;
        let [first, second] = match hash {
            Some(words) => [key(words, cell), key(words, cell.wrapping_add(1))],
            None => [cell as u32, (cell >> 32) as u32],
        };
        let words: [u32; TABLED_WORDS] = [first, second, fraction.to_bits()];
        data.extend(words);
    }
    at
}
