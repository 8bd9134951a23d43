//! A set of samples of a grid with consecutive numbers.

/// Samples per word.
const BITS: usize = u32::BITS as usize;

/// A subset of 32 consecutive samples of a row.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Word {
    bits: u32,
    /// Number of samples in all previous words.
    before: u32,
}

/// A subset of the samples of a grid, numbered row by row. It takes one bit and a share of a count per sample of the
/// grid: a quarter of a byte.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SampleSet {
    words: Vec<Word>,
    /// Words per row.
    stride: usize,
    count: usize,
}

impl SampleSet {
    /// An empty set for a grid of this width and height.
    pub fn empty([width, height]: [usize; 2]) -> SampleSet {
        let stride = width.div_ceil(BITS).max(1);
        SampleSet { words: vec![Word::default(); stride * height], stride, count: 0 }
    }

    /// Adds the sample in a column and row. Numbers are valid after [`SampleSet::number_all`].
    pub fn insert(&mut self, [column, row]: [usize; 2]) {
        self.words[row * self.stride + column / BITS].bits |= 1 << (column % BITS);
    }

    /// Numbers the samples.
    pub fn number_all(&mut self) {
        let mut before = 0;
        for word in &mut self.words {
            word.before = before;
            before += word.bits.count_ones();
        }
        self.count = before as usize;
    }

    /// Number of samples in the set.
    pub fn len(&self) -> usize {
        self.count
    }

    /// The number of a sample of the set.
    pub fn number(&self, [column, row]: [usize; 2]) -> u32 {
        let word = self.words[row * self.stride + column / BITS];
        word.before + (word.bits & ((1 << (column % BITS)) - 1)).count_ones()
    }

    /// The column and row of the sample with a number.
    pub fn sample(&self, number: u32) -> [usize; 2] {
        let at = self.words.partition_point(|word| word.before <= number) - 1;
        let Word { mut bits, before } = self.words[at];
        for _ in before..number {
            // Clears the lowest set bit.
            bits &= bits - 1;
        }
        [at % self.stride * BITS + bits.trailing_zeros() as usize, at / self.stride]
    }

    /// The rows, from the north.
    pub fn rows(&self) -> impl Iterator<Item = &[Word]> {
        self.words.chunks_exact(self.stride)
    }
}

/// Number of samples of the set in a row.
pub(super) fn count(row: &[Word]) -> usize {
    row.iter().map(|word| word.bits.count_ones() as usize).sum()
}

/// Calls `each` with the column of each sample of the set in a row, from the west.
pub(super) fn columns(row: &[Word], mut each: impl FnMut(usize)) {
    for (k, word) in row.iter().enumerate() {
        let mut bits = word.bits;
        while bits != 0 {
            each(k * BITS + bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_numbered_row_by_row() {
        for (width, height, modulus) in [(1, 1, 1), (31, 5, 3), (32, 4, 1), (33, 40, 7), (200, 30, 97)] {
            let listed: Vec<[usize; 2]> =
                (0..width * height).filter(|k| k * k % modulus == 0).map(|k| [k % width, k / width]).collect();
            let mut set = SampleSet::empty([width, height]);
            listed.iter().rev().chain(&listed).for_each(|sample| set.insert(*sample));
            set.number_all();
            assert_eq!(set.len(), listed.len());
            for (number, sample) in listed.iter().enumerate() {
                assert_eq!((set.number(*sample), set.sample(number as u32)), (number as u32, *sample));
            }
            let mut found = Vec::new();
            for (j, row) in set.rows().enumerate() {
                let before = found.len();
                columns(row, |column| found.push([column, j]));
                assert_eq!(count(row), found.len() - before);
            }
            assert_eq!(found, listed);
        }
    }
}
