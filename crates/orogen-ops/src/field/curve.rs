//! A monotone curve through control points.

use crate::lower::Lowering;
use crate::op::{Evaluator, Field, WorldParams};
use orogen_noise::shader::function::Shader;

op! {
    /// The source mapped through a smooth monotone curve through the control points. The curve does not overshoot
    /// between points.
    ///
    /// Below the first point and above the last point the result is constant. Two points of equal height give a
    /// constant segment: `points = [[-1, 0], [0.4, 0], [1, 1]]` maps all values below 0.4 to 0. Method: cubic Hermite
    /// interpolation with the tangents of Fritsch and Carlson (1980).
    pub struct Curve = "curve", field, revision 1;
    inputs {
        /// The values to map.
        source: required,
    }
    params {
        /// Control points [[from, to], ...]; each `from` must be greater than the one before.
        points: Vec<[f64; 2]> = vec![[-1.0, -1.0], [1.0, 1.0]], range -1e9 to 1e9;
    }
}

/// One segment between two control points: to(x) = a + t (b + t (c + t d)) with t = x - start.
#[derive(Clone, Copy)]
struct Segment {
    start: f32,
    a: f32,
    b: f32,
    c: f32,
    d: f32,
}

/// A control point's tangents.
#[derive(Clone, Copy, Default)]
struct Knot {
    /// Slope of the straight line to the next point.
    secant: f64,
    tangent: f64,
}

impl Curve {
    /// The segments, and the first and the last point.
    fn segments(&self) -> (Vec<Segment>, [f32; 2], [f32; 2]) {
        let points = &self.points;
        let count = points.len();
        let mut knots = vec![Knot::default(); count];
        for (knot, pair) in knots.iter_mut().zip(points.windows(2)) {
            knot.secant = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        }
        let secant = |knots: &[Knot], i: usize| (i + 1 < count).then(|| knots[i].secant);
        for i in 0..count {
            let before = i.checked_sub(1).and_then(|before| secant(&knots, before));
            knots[i].tangent = match (before, secant(&knots, i)) {
                (Some(before), Some(after)) if before * after > 0.0 => 0.5 * (before + after),
                (Some(_), Some(_)) => 0.0,
                (Some(only), None) | (None, Some(only)) => only,
                (None, None) => 0.0,
            };
        }
        // Fritsch and Carlson's condition: tangents within a circle of radius 3 around the secant keep the piece
        // monotone.
        for i in 1..count {
            let secant = knots[i - 1].secant;
            if secant == 0.0 {
                knots[i - 1].tangent = 0.0;
                knots[i].tangent = 0.0;
                continue;
            }
            let (alpha, beta) = (knots[i - 1].tangent / secant, knots[i].tangent / secant);
            let square = alpha * alpha + beta * beta;
            if square > 9.0 {
                let tau = 3.0 / square.sqrt();
                knots[i - 1].tangent = tau * alpha * secant;
                knots[i].tangent = tau * beta * secant;
            }
        }
        let segment = |(pair, knots): (&[[f64; 2]], &[Knot])| {
            let (width, secant) = (pair[1][0] - pair[0][0], knots[0].secant);
            let (m0, m1) = (knots[0].tangent, knots[1].tangent);
            Segment {
                start: pair[0][0] as f32,
                a: pair[0][1] as f32,
                b: m0 as f32,
                c: ((3.0 * secant - 2.0 * m0 - m1) / width) as f32,
                d: ((m0 + m1 - 2.0 * secant) / (width * width)) as f32,
            }
        };
        let end = |point: Option<&[f64; 2]>| point.map_or([0.0f32; 2], |[x, y]| [*x as f32, *y as f32]);
        (points.windows(2).zip(knots.windows(2)).map(segment).collect(), end(points.first()), end(points.last()))
    }

    /// The curve as a function.
    #[doc(hidden)]
    pub fn function(&self) -> impl Fn(f32) -> f32 + Send + Sync + use<> {
        let (segments, first, last) = self.segments();
        move |x| {
            if x <= first[0] {
                first[1]
            } else if x >= last[0] {
                last[1]
            } else if x.is_nan() {
                x
            } else {
                let at = segments.partition_point(|segment| segment.start <= x).saturating_sub(1);
                let Segment { start, a, b, c, d } = segments[at];
                let t = x - start;
                a + t * (b + t * (c + t * d))
            }
        }
    }
}

impl Field for Curve {
    fn prepare(&self, _: &WorldParams) -> Option<Evaluator> {
        let function = self.function();
        Some(Box::new(move |_, inputs, out| {
            out.iter_mut().zip(inputs.required("source")?).for_each(|(sample, x)| *sample = function(*x));
            Ok(())
        }))
    }

    fn cost(&self) -> f64 {
        1.5
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        let (segments, first, last) = self.segments();
        let mut numbers = [first, last].concat();
        numbers.extend(segments.iter().flat_map(|&Segment { start, a, b, c, d }| [start, a, b, c, d]));
        let mut shader = Shader::new("curve", include_str!("curve.wgsl"), &numbers);
        shader.words.insert(0, segments.len() as u32);
        Lowering::Shader(shader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declare::Input;

    fn run(points: &[[f64; 2]], xs: &[f32]) -> Vec<f32> {
        let curve = Curve { source: Input::None, points: points.to_vec() };
        xs.iter().copied().map(curve.function()).collect()
    }

    #[test]
    fn passes_through_points_and_stays_level() {
        let points = [[-1.0, 0.0], [0.4, 0.0], [0.6, 0.5], [1.0, 1.0]];
        assert_eq!(run(&points, &[-5.0, -1.0, 0.0, 0.39, 0.6, 1.0, 7.0]), [0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0]);
    }

    #[test]
    fn never_overshoots() {
        let points = [[0.0, 0.0], [0.1, 0.9], [0.2, 0.91], [0.9, 0.92], [1.0, 2.0]];
        let xs: Vec<f32> = (0..=1000).map(|i| i as f32 / 1000.0).collect();
        let ys = run(&points, &xs);
        assert!(ys.windows(2).all(|pair| pair[1] >= pair[0] - 1e-6), "monotone data make a monotone curve");
        assert!(ys.iter().all(|y| (-1e-6..=2.0 + 1e-6).contains(y)));
    }

    #[test]
    fn many_points_are_as_good_as_few() {
        let line: Vec<[f64; 2]> = (0..=100).map(|i| [f64::from(i), 3.0 * f64::from(i)]).collect();
        let xs: Vec<f32> = (0..=400).map(|i| i as f32 / 4.0).collect();
        let straight: Vec<f32> = xs.iter().map(|x| 3.0 * x).collect();
        assert_eq!(run(&line, &xs), straight);
        assert_eq!(run(&[[0.0, 0.0], [100.0, 300.0]], &xs), straight);
    }

    #[test]
    fn nan_stays_nan() {
        assert!(run(&[[0.0, 0.0], [1.0, 1.0]], &[f32::NAN])[0].is_nan());
    }
}
