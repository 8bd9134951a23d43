//! Overviews with half the samples along each side. Each sample is the mean over its own area.

use orogen_grid::parallel;

/// Number of samples along a side of an overview, for a side of `n` samples.
#[must_use]
pub fn half(n: usize) -> usize {
    n.div_ceil(2)
}

/// The samples along a side under one sample of the overview, and the share that each covers. A sample of the overview
/// is at most twice as long as a sample, so it touches at most three.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Index of the first sample.
    pub first: usize,
    /// The share that each sample covers; 0 for samples beyond the span.
    pub shares: [f64; 3],
}

impl Span {
    /// The samples under sample `i` of the overview of a side with `n` samples.
    #[must_use]
    pub fn of(i: usize, n: usize) -> Span {
        // In units in which a sample of the overview has length n and a sample below it length m, all ends are
        // integers.
        let m = half(n);
        let (start, end) = (i * n, (i + 1) * n);
        let first = start / m;
        let shares = std::array::from_fn(|k| {
            let from = start.max((first + k) * m);
            let to = end.min((first + k + 1) * m);
            to.saturating_sub(from) as f64 / n as f64
        });
        Span { first, shares }
    }

    /// The index after the last sample of the span.
    #[must_use]
    pub fn end(&self) -> usize {
        self.first + self.shares.iter().filter(|share| **share > 0.0).count()
    }
}

/// The samples from which some rows of an overview are computed: rows of the raster, or parts of them.
pub struct Below<'a> {
    /// Samples, row-major.
    pub rows: &'a [f32],
    /// The index of the first column.
    pub left: usize,
    /// The index of the first row.
    pub first: usize,
    /// Number of samples per row.
    pub width: usize,
    /// Number of rows of the whole raster.
    pub height: usize,
}

/// Computes the overview's rows `made..until`, in the columns of the given spans, which `below` must contain. Samples
/// that are NaN or equal to `missing` are excluded from the means. If no sample is left, the overview's sample is
/// missing, too.
#[must_use]
pub fn reduce(below: &Below, columns: &[Span], made: usize, until: usize, missing: Option<f32>) -> Vec<f32> {
    let mut out = vec![0.0; columns.len() * (until - made)];
    parallel::for_each(out.chunks_exact_mut(columns.len()).enumerate(), |(j, row)| {
        let span = Span::of(made + j, below.height);
        // Rows and columns beyond the raster have share 0, so the last ones are used in their place.
        let rows: [&[f32]; 3] = std::array::from_fn(|k| {
            let start = (span.first + k).min(span.end() - 1) - below.first;
            &below.rows[start * below.width..(start + 1) * below.width]
        });
        for (sample, column) in row.iter_mut().zip(columns) {
            let last = column.end() - 1;
            let at: [usize; 3] = std::array::from_fn(|k| (column.first + k).min(last) - below.left);
            *sample = mean(rows, at, span.shares, column.shares, missing);
        }
    });
    out
}

/// The weighted mean of nine samples, in f64, so that level ground stays level bit for bit.
fn mean(rows: [&[f32]; 3], at: [usize; 3], down: [f64; 3], across: [f64; 3], missing: Option<f32>) -> f32 {
    let mut sum = 0.0;
    for (row, down) in rows.iter().zip(down) {
        let along: f64 = at.iter().zip(across).map(|(&i, share)| f64::from(row[i]) * share).sum();
        sum += along * down;
    }
    if missing.is_none_or(f32::is_nan) && !sum.is_nan() {
        return sum as f32;
    }
    let (mut sum, mut total) = (0.0, 0.0);
    for (row, down) in rows.iter().zip(down) {
        for (&i, across) in at.iter().zip(across) {
            let share = down * across;
            if share > 0.0 && !row[i].is_nan() && missing != Some(row[i]) {
                sum += f64::from(row[i]) * share;
                total += share;
            }
        }
    }
    match total > 0.0 {
        true => (sum / total) as f32,
        false => missing.unwrap_or(f32::NAN),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_whole_and_lie_in_the_middle() {
        for n in 1..200 {
            for i in 0..half(n) {
                let span = Span::of(i, n);
                let total: f64 = span.shares.iter().sum();
                assert!((total - 1.0).abs() < 1e-12 && span.end() <= n, "{n} {i}: {span:?}");
                let middle: f64 =
                    span.shares.iter().enumerate().map(|(k, s)| s * ((span.first + k) as f64 + 0.5)).sum();
                let expect = (i as f64 + 0.5) * n as f64 / half(n) as f64;
                // A raster with overviews has hundreds of samples per row, so this is a thousandth of a sample.
                assert!((middle - expect).abs() < 0.5 / n as f64, "{n} {i}: {middle}, not {expect}");
            }
        }
        assert_eq!(Span::of(3, 8), Span { first: 6, shares: [0.5, 0.5, 0.0] });
        assert_eq!(Span::of(0, 1), Span { first: 0, shares: [1.0, 0.0, 0.0] });
        assert_eq!(Span::of(1, 3).first, 1);
    }

    fn small(width: usize, height: usize, samples: &[f32], missing: Option<f32>) -> Vec<f32> {
        let columns: Vec<Span> = (0..half(width)).map(|i| Span::of(i, width)).collect();
        reduce(&Below { rows: samples, left: 0, first: 0, width, height }, &columns, 0, half(height), missing)
    }

    #[test]
    fn means() {
        assert_eq!(small(2, 2, &[1.0, 2.0, 3.0, 6.0], None), [3.0]);
        assert_eq!(small(4, 1, &[1.0, 2.0, 3.0, 6.0], None), [1.5, 4.5]);
        assert_eq!(small(3, 1, &[0.0, 3.0, 6.0], None), [1.0, 5.0]);
        assert_eq!(small(1, 1, &[7.25], None), [7.25]);
        for n in [5, 31, 1001] {
            assert!(small(n, 3, &vec![1234.5678; 3 * n], None).iter().all(|h| *h == 1234.5678));
        }
        let most = small(2, 2, &[f32::MAX; 4], None);
        assert_eq!(most, [f32::MAX]);
    }

    #[test]
    fn what_is_missing_is_left_out() {
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        assert_eq!(small(2, 2, &[1.0, nan, 3.0, nan], None), [2.0]);
        assert!(small(2, 2, &[nan; 4], None)[0].is_nan());
        assert_eq!(small(2, 2, &[-9999.0, 5.0, 7.0, nan], Some(-9999.0)), [6.0]);
        assert_eq!(small(2, 2, &[-9999.0, nan, nan, nan], Some(-9999.0)), [-9999.0]);
        assert_eq!(small(4, 1, &[inf, 1.0, 2.0, 4.0], None), [inf, 3.0]);
        assert_eq!(small(5, 1, &[1.0, 1.0, inf, 1.0, 1.0], None), [1.0, inf, 1.0]);
    }
}
