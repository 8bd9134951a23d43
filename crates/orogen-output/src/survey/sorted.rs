//! Samples in ascending order, sorted in memory or in parts. Both give the same order, so sums over it have the same
//! bits.

use orogen_grid::error::Result;

/// A source of samples that calls its argument with all of them, in pieces, in the same order every time.
pub type Samples<'a> = dyn Fn(&mut dyn FnMut(&[f32])) -> Result<()> + 'a;

/// The finite samples of a source, in ascending order.
pub struct Sorted<'a> {
    samples: &'a Samples<'a>,
    /// All samples, if they fit in memory.
    held: Option<Vec<f32>>,
    /// Otherwise, the number of samples for each [`high`] half of a key.
    buckets: Vec<u64>,
    count: u64,
    most: usize,
}

/// An integer that sorts like `f32::total_cmp`.
fn key(sample: f32) -> u32 {
    let bits = sample.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The sample of a key.
fn sample(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 { key & !(1 << 31) } else { !key })
}

fn high(key: u32) -> usize {
    (key >> 16) as usize
}

impl<'a> Sorted<'a> {
    /// Sorts all samples in memory.
    ///
    /// # Errors
    /// If the source fails.
    pub fn held(samples: &'a Samples<'a>) -> Result<Sorted<'a>> {
        let mut held = Vec::new();
        samples(&mut |some| held.extend(some.iter().copied().filter(|sample| sample.is_finite())))?;
        held.sort_unstable_by(f32::total_cmp);
        Ok(Sorted { samples, count: held.len() as u64, held: Some(held), buckets: Vec::new(), most: 0 })
    }

    /// Holds at most `most` samples at a time: the source is read once per part, and once more to count.
    ///
    /// # Errors
    /// If the source fails.
    pub fn in_parts(samples: &'a Samples<'a>, most: usize) -> Result<Sorted<'a>> {
        let mut buckets = vec![0u64; 1 << 16];
        samples(&mut |some| finite(some).for_each(|key| buckets[high(key)] += 1))?;
        Ok(Sorted { samples, count: buckets.iter().sum(), held: None, buckets, most: most.max(1) })
    }

    /// Number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Visits all samples in ascending order, in pieces.
    ///
    /// # Errors
    /// If the source fails.
    pub fn each(&self, visit: &mut dyn FnMut(&[f32])) -> Result<()> {
        if let Some(held) = &self.held {
            visit(held);
            return Ok(());
        }
        let mut first = 0;
        while first < self.buckets.len() {
            let (mut end, mut count) = (first, 0);
            while end < self.buckets.len() && (end == first || count + self.buckets[end] <= self.most as u64) {
                count += self.buckets[end];
                end += 1;
            }
            if count > self.most as u64 {
                self.alike(first, visit)?;
            } else if count > 0 {
                let mut part = Vec::with_capacity(count as usize);
                (self.samples)(&mut |some| {
                    part.extend(
                        some.iter()
                            .copied()
                            .filter(|sample| sample.is_finite() && (first..end).contains(&high(key(*sample)))),
                    );
                })?;
                part.sort_unstable_by(f32::total_cmp);
                visit(&part);
            }
            first = end;
        }
        Ok(())
    }

    /// The samples of a bucket that is too large to be held: they are counted by value.
    fn alike(&self, bucket: usize, visit: &mut dyn FnMut(&[f32])) -> Result<()> {
        let mut counts = vec![0u64; 1 << 16];
        (self.samples)(&mut |some| {
            finite(some).filter(|key| high(*key) == bucket).for_each(|key| counts[key as usize & 0xffff] += 1);
        })?;
        for (low, count) in counts.into_iter().enumerate().filter(|(_, count)| *count > 0) {
            let run = [sample((bucket << 16 | low) as u32); 1024];
            let mut left = count as usize;
            while left > 0 {
                let some = left.min(run.len());
                visit(&run[..some]);
                left -= some;
            }
        }
        Ok(())
    }

    /// The samples at these positions of the order; positions must be ascending and valid.
    ///
    /// # Errors
    /// If the source fails.
    pub fn at<const N: usize>(&self, places: [u64; N]) -> Result<[f32; N]> {
        let (mut found, mut next, mut before) = ([f32::NAN; N], 0, 0);
        self.each(&mut |some| {
            while next < N && places[next] < before + some.len() as u64 {
                found[next] = some[(places[next] - before) as usize];
                next += 1;
            }
            before += some.len() as u64;
        })?;
        Ok(found)
    }
}

fn finite(samples: &[f32]) -> impl Iterator<Item = u32> {
    samples.iter().filter(|sample| sample.is_finite()).map(|sample| key(*sample))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_in_the_order_of_all() {
        // Many equal numbers, both zeros, both signs, and some NaNs.
        let all: Vec<f32> = (0..5000u32)
            .map(|k| match k % 11 {
                0 => f32::NAN,
                1 | 2 => 7.5,
                3 => -0.0,
                4 => 0.0,
                5 => f32::INFINITY,
                _ => ((k * 7919) % 5003) as f32 * 0.37 - 900.0,
            })
            .collect();
        let source = |visit: &mut dyn FnMut(&[f32])| {
            all.chunks(97).for_each(visit);
            Ok(())
        };
        let held = Sorted::held(&source).unwrap();
        let bits = |sorted: &Sorted| {
            let mut bits = Vec::new();
            sorted.each(&mut |some| bits.extend(some.iter().map(|sample| sample.to_bits()))).unwrap();
            bits
        };
        let expect = bits(&held);
        assert_eq!(expect.len() as u64, held.count());
        for most in [1, 10, 300, 2000, 1_000_000] {
            let parts = Sorted::in_parts(&source, most).unwrap();
            assert_eq!((parts.count(), bits(&parts) == expect), (held.count(), true), "{most}");
            let places = [0, 17, 2000, held.count() - 1];
            assert_eq!(parts.at(places).unwrap().map(f32::to_bits), held.at(places).unwrap().map(f32::to_bits));
        }
        assert!((0..=u32::MAX).step_by(65_537).all(|k| key(sample(k)) == k));
    }
}
