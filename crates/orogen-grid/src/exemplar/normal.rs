//! Values with a normal distribution, and back.

use crate::parallel;

/// The standard normal quantile of a share between 0 and 1 (M. J. Wichura, "Algorithm AS 241: the percentage points of
/// the normal distribution", Applied Statistics 37(3), 1988: PPND7, to seven digits).
pub(super) fn quantile(share: f64) -> f64 {
    /// Numerators and denominators, from the highest power down.
    type Ratio<const N: usize, const D: usize> = ([f64; N], [f64; D]);
    const MIDDLE: Ratio<4, 4> = (
        [59.109_374_720, 159.291_132_02, 50.434_271_938, 3.387_132_717_9],
        [67.187_563_600, 78.757_757_664, 17.895_169_469, 1.0],
    );
    const NEAR: Ratio<4, 3> = (
        [0.170_238_211_03, 1.306_728_481_6, 2.756_815_390_0, 1.423_437_277_7],
        [0.120_211_329_75, 0.737_001_642_50, 1.0],
    );
    const FAR: Ratio<4, 3> = (
        [0.017_337_203_997, 0.428_682_943_37, 3.081_226_386_0, 6.657_905_115_0],
        [0.012_258_202_635, 0.241_978_942_25, 1.0],
    );
    let polynomial = |coefficients: &[f64], t: f64| coefficients.iter().fold(0.0, |sum, c| sum * t + c);
    let ratio = |above: &[f64], below: &[f64], t: f64| polynomial(above, t) / polynomial(below, t);
    let q = share - 0.5;
    if q.abs() <= 0.425 {
        return q * ratio(&MIDDLE.0, &MIDDLE.1, 0.180_625 - q * q);
    }
    let tail = if q < 0.0 { share } else { 1.0 - share };
    let t = (-libm::log(tail.max(f64::MIN_POSITIVE))).sqrt();
    let size = match t <= 5.0 {
        true => ratio(&NEAR.0, &NEAR.1, t - 1.6),
        false => ratio(&FAR.0, &FAR.1, t - 5.0),
    };
    if q < 0.0 { -size } else { size }
}

/// Replaces samples by the normal quantiles of their ranks, less their mean. Equal samples stay equal: they get the
/// mean of their ranks. Gives that mean, and the table that leads back.
pub(super) fn gaussianized(samples: &mut [f32]) -> (f32, InverseTable) {
    let mut sorted: Vec<(f32, u32)> = samples.iter().copied().zip(0..).collect();
    parallel::sort_by(&mut sorted, |one, other| one.0.total_cmp(&other.0));
    let share = 1.0 / sorted.len().max(1) as f64;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let (mut knot, mut beside) = (0, 0);
    let mut sum = 0.0;
    let mut first = 0;
    for equal in sorted.chunk_by(|one, other| one.0 == other.0) {
        let after = first + equal.len();
        let normal = quantile(0.5 * (first + after) as f64 * share);
        sum += normal * equal.len() as f64;
        for (_, at) in equal {
            if let Some(sample) = samples.get_mut(*at as usize) {
                *sample = normal as f32;
            }
        }
        // Only the points beside knots of the table are needed: the first and the last one of each interval.
        let point = [normal, f64::from(equal[0].0)];
        let next = InverseTable::knot_after(normal);
        beside = if next == knot { beside + 1 } else { 1 };
        knot = next;
        match points.last_mut() {
            Some(last) if beside > 2 => *last = point,
            _ => points.push(point),
        }
        first = after;
    }
    let mean = sum * share;
    for sample in samples {
        *sample = (f64::from(*sample) - mean) as f32;
    }
    (mean as f32, InverseTable::new(&points))
}

/// The values of samples by their normal quantiles: monotone cubics with continuous slopes (F. N. Fritsch and R. E.
/// Carlson, "Monotone piecewise cubic interpolation", SIAM Journal on Numerical Analysis 17(2), 1980).
#[derive(Debug, Clone)]
pub(super) struct InverseTable {
    /// The coefficients of a cubic of the position in each interval, from the constant one up.
    pieces: Vec<[f32; 4]>,
}

/// The quantiles of the table are between -LIMIT and LIMIT.
const LIMIT: f64 = 5.0;

/// Intervals of the table per unit.
const DENSITY: f64 = 16.0;

/// Number of intervals.
const PIECES: usize = (2.0 * LIMIT * DENSITY) as usize;

impl InverseTable {
    /// The number of the first knot above a quantile.
    fn knot_after(normal: f64) -> usize {
        ((normal + LIMIT) * DENSITY + 1.0).floor().clamp(0.0, (PIECES + 1) as f64) as usize
    }

    /// The table through points of a quantile and a value, both ascending.
    fn new(points: &[[f64; 2]]) -> InverseTable {
        let mut values = Vec::with_capacity(PIECES + 1);
        let mut at = 0;
        for knot in 0..=PIECES {
            let normal = knot as f64 / DENSITY - LIMIT;
            while points.get(at + 1).is_some_and(|point| point[0] < normal) {
                at += 1;
            }
            values.push(match (points.get(at), points.get(at + 1)) {
                (Some([low, from]), Some([high, to])) => {
                    from + (to - from) * ((normal - low) / (high - low)).clamp(0.0, 1.0)
                }
                (Some([_, value]), None) => *value,
                (None, _) => 0.0,
            });
        }
        let rises: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // The harmonic mean of two rises keeps the cubics monotone. Beyond the ends values are constant.
        let slope = |knot: usize| match (knot.checked_sub(1).and_then(|k| rises.get(k)), rises.get(knot)) {
            (Some(before), Some(after)) if before * after > 0.0 => 2.0 * before * after / (before + after),
            _ => 0.0,
        };
        let piece = |(knot, rise): (usize, &f64)| {
            let [before, after] = [slope(knot), slope(knot + 1)];
            let [square, cube] = [3.0 * rise - 2.0 * before - after, before + after - 2.0 * rise];
            [values[knot], before, square, cube].map(|coefficient| coefficient as f32)
        };
        InverseTable { pieces: rises.iter().enumerate().map(piece).collect() }
    }

    /// The value of a quantile.
    #[inline(always)]
    pub(super) fn value(&self, normal: f32) -> f32 {
        // The limit is a little less than the last knot, so that it is in the last interval.
        let t = ((normal + LIMIT as f32) * DENSITY as f32).clamp(0.0, PIECES as f32 - 1.0 / 1024.0);
        let piece = t as usize;
        let t = t - piece as f32;
        let [c0, c1, c2, c3] = self.pieces.get(piece).copied().unwrap_or([f32::NAN; 4]);
        c0 + t * (c1 + t * (c2 + t * c3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn quantiles_are_those_of_tables() {
        let expect = [
            (0.5, 0.0),
            (0.841_344_746_068_543, 1.0),
            (0.975, 1.959_963_984_540_054),
            (0.001, -3.090_232_306_167_813),
            (1e-6, -4.753_424_308_822_899),
            (1e-12, -7.034_483_825_301_131),
        ];
        for (share, normal) in expect {
            assert!((quantile(share) - normal).abs() < 2e-6 * (1.0 + normal.abs()), "{share}: {}", quantile(share));
        }
    }

    #[test]
    fn samples_become_normal_and_come_back() {
        let mut random = Random::new(3, 1);
        // A distribution with a long tail.
        let samples: Vec<f32> = (0..20_000).map(|_| libm::expf(3.0 * random.share() as f32) + 7.0).collect();
        let mut normal = samples.clone();
        let (mean, inverse) = gaussianized(&mut normal);
        let moment = |order: i32| {
            normal.iter().map(|n| (0..order).fold(1.0, |power, _| power * f64::from(*n))).sum::<f64>() / 20_000.0
        };
        assert!(mean.abs() < 1e-6 && moment(1).abs() < 1e-6, "{mean}");
        let moments = [moment(2), moment(3), moment(4)];
        assert!(
            (moments[0] - 1.0).abs() < 1e-3 && moments[1].abs() < 1e-3 && (moments[2] - 3.0).abs() < 0.02,
            "{moments:?}"
        );
        for (sample, normal) in samples.iter().zip(&normal) {
            let back = inverse.value(normal + mean);
            assert!((back - sample).abs() < 0.1, "{sample} became {normal}, then {back}");
        }
        assert_eq!(inverse.value(-99.0), inverse.value(-5.0));
        assert_eq!(inverse.value(99.0), inverse.value(5.0));
    }

    #[test]
    fn equal_samples_stay_equal() {
        let mut normal = [0.0, 0.0, 1.0, 0.0];
        let (mean, inverse) = gaussianized(&mut normal);
        assert_eq!([normal[0], normal[1]], [normal[3]; 2]);
        assert!(normal[2] > normal[0]);
        assert!((inverse.value(normal[0] + mean)).abs() < 0.1 && (inverse.value(normal[2] + mean) - 1.0).abs() < 0.1);
        let mut flat = [4.0; 9];
        let (mean, inverse) = gaussianized(&mut flat);
        assert_eq!((flat, mean, inverse.value(0.3)), ([0.0; 9], 0.0, 4.0));
    }
}
