//! The discrete Fourier transform for lengths that are powers of two.

/// The transform for one length that is a power of two, with its table of complex roots of unity.
#[derive(Debug, Clone)]
pub struct Fourier {
    /// exp(-2 pi i k / N) for k = 0 .. N / 2.
    turns: Vec<[f64; 2]>,
    count: usize,
}

impl Fourier {
    /// The transform of `count` values; `None` if the count is not a power of two.
    #[must_use]
    pub fn new(count: usize) -> Option<Fourier> {
        if !count.is_power_of_two() {
            return None;
        }
        let turn = |k: usize| {
            let (sin, cos) = libm::sincos(-std::f64::consts::TAU * k as f64 / count as f64);
            [cos, sin]
        };
        Some(Fourier { turns: (0..count / 2).map(turn).collect(), count })
    }

    /// Transforms `values` (real and imaginary parts) in place with the algorithm of Cooley and Tukey (1965): X(k) =
    /// sum over n of x(n) exp(-2 pi i k n / N). Does nothing if the number of values is not that of the transform. The
    /// order of the sums is fixed, so the bits are the same on every machine.
    pub fn transform(&self, values: &mut [[f64; 2]]) {
        let count = values.len();
        if count != self.count || count == 1 {
            return;
        }
        let bits = count.trailing_zeros();
        for i in 0..count {
            let j = i.reverse_bits() >> (usize::BITS - bits);
            if i < j {
                values.swap(i, j);
            }
        }
        let mut half = 1;
        while half < count {
            let stride = count / (2 * half);
            for block in values.chunks_exact_mut(2 * half) {
                let (low, high) = block.split_at_mut(half);
                for ((a, b), [cos, sin]) in low.iter_mut().zip(high).zip(self.turns.iter().step_by(stride)) {
                    let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                    (*a, *b) = ([a[0] + turned[0], a[1] + turned[1]], [a[0] - turned[0], a[1] - turned[1]]);
                }
            }
            half *= 2;
        }
    }
}

/// [`Fourier::transform`] for any number of values that is a power of two. Does nothing for other numbers.
pub fn transform(values: &mut [[f64; 2]]) {
    if let Some(fourier) = Fourier::new(values.len()) {
        fourier.transform(values);
    }
}

/// The power |X|^2 of a square of `side` x `side` real samples, row-major. The first value belongs to frequency (0, 0).
#[must_use]
pub fn power(samples: &[f64], side: usize) -> Vec<f64> {
    let mut values: Vec<[f64; 2]> = samples.iter().map(|sample| [*sample, 0.0]).collect();
    let Some(fourier) = Fourier::new(side) else { return vec![0.0; values.len()] };
    values.chunks_exact_mut(side).for_each(|row| fourier.transform(row));
    let mut column = vec![[0.0; 2]; side];
    let mut out = vec![0.0; values.len()];
    for i in 0..side {
        for (j, value) in column.iter_mut().enumerate() {
            *value = values[j * side + i];
        }
        fourier.transform(&mut column);
        for (j, [re, im]) in column.iter().enumerate() {
            out[j * side + i] = re * re + im * im;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_that_it_says() {
        let samples: Vec<[f64; 2]> = (0..16).map(|n| [f64::from(n * n % 7), f64::from(n % 3)]).collect();
        let mut made = samples.clone();
        transform(&mut made);
        for (k, [re, im]) in made.iter().enumerate() {
            let (mut a, mut b) = (0.0, 0.0);
            for (n, [x, y]) in samples.iter().enumerate() {
                let (sin, cos) = libm::sincos(-std::f64::consts::TAU * (k * n) as f64 / 16.0);
                a += x * cos - y * sin;
                b += x * sin + y * cos;
            }
            assert!((re - a).abs() < 1e-12 && (im - b).abs() < 1e-12, "{k}");
        }
    }

    #[test]
    fn a_wave_has_its_power_at_its_frequency() {
        let wave = |k: usize| libm::cos(std::f64::consts::TAU * (3 * (k % 32) + 5 * (k / 32)) as f64 / 32.0);
        let power = power(&(0..1024).map(wave).collect::<Vec<f64>>(), 32);
        let at = |i: usize, j: usize| power[j * 32 + i];
        assert!((at(3, 5) - 512.0 * 512.0).abs() < 1e-6 && (at(29, 27) - 512.0 * 512.0).abs() < 1e-6);
        assert!(power.iter().sum::<f64>() - 2.0 * 512.0 * 512.0 < 1e-6);
    }
}
