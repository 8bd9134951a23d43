//! Cubic Bézier curves in the plane.

/// Maximum number of straight segments that replace a curve.
const MAX_SEGMENTS: u32 = 1 << 16;

/// A cubic Bézier curve: start, two control points, end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic(pub [[f64; 2]; 4]);

impl Cubic {
    /// The number of straight segments, at equal steps of the parameter, that approximate the curve within `tolerance`.
    ///
    /// The distance is at most an eighth of the second derivative, divided by the square of the number of segments. The
    /// second derivative is at most six times the larger second difference of the control points.
    #[must_use]
    pub fn segments(&self, tolerance: f64) -> u32 {
        let [a, b, c, d] = self.0;
        let second = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            let [x, y] = [0, 1].map(|k| (a[k] - b[k]) + (c[k] - b[k]));
            (x * x + y * y).sqrt()
        };
        let bend = second(a, b, c).max(second(b, c, d));
        ((0.75 * bend / tolerance).sqrt().ceil() as u32).clamp(1, MAX_SEGMENTS)
    }

    /// The point at a parameter, 0 at the start and 1 at the end.
    ///
    /// It is computed relative to the start, so the precision does not depend on the distance from the origin.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 2] {
        let [a, b, c, d] = self.0;
        let s = 1.0 - t;
        let weights = [3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        [0, 1].map(|k| a[k] + ((b[k] - a[k]) * weights[0] + (c[k] - a[k]) * weights[1] + (d[k] - a[k]) * weights[2]))
    }

    /// The cubic curve that equals a quadratic Bézier curve (start, control point, end).
    #[must_use]
    pub fn of_quadratic([a, b, c]: [[f64; 2]; 3]) -> Cubic {
        let towards = |end: [f64; 2]| [0, 1].map(|k| end[k] + (b[k] - end[k]) * (2.0 / 3.0));
        Cubic([a, towards(a), towards(c), c])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_keep_the_tolerance_and_are_few() {
        for offset in [0.0, 1e6] {
            let at = |x: f64, y: f64| [x + offset, y - offset];
            let curves = [
                Cubic([at(0.0, 0.0), at(0.0, 100.0), at(100.0, 100.0), at(100.0, 0.0)]),
                Cubic([at(0.0, 0.0), at(300.0, 10.0), at(-200.0, 10.0), at(100.0, 0.0)]),
                Cubic::of_quadratic([at(0.0, 0.0), at(50.0, 80.0), at(100.0, 0.0)]),
            ];
            for curve in curves {
                for tolerance in [10.0, 1.0, 0.01] {
                    let count = curve.segments(tolerance);
                    let mut worst = 0.0f64;
                    for k in 0..count {
                        let ends = [k, k + 1].map(|k| curve.at(f64::from(k) / f64::from(count)));
                        for m in 1..8 {
                            let share = f64::from(m) / 8.0;
                            let on = curve.at((f64::from(k) + share) / f64::from(count));
                            let chord = [0, 1].map(|i| ends[0][i] + (ends[1][i] - ends[0][i]) * share);
                            worst = worst.max(libm::hypot(on[0] - chord[0], on[1] - chord[1]));
                        }
                    }
                    assert!(
                        worst <= tolerance && worst > 0.05 * tolerance || count == 1,
                        "{worst} {tolerance} {count}"
                    );
                }
            }
        }
        let straight = Cubic([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]);
        assert_eq!(straight.segments(1e-6), 1);
        assert_eq!(Cubic([[f64::NAN; 2]; 4]).segments(1.0), 1);
    }
}
