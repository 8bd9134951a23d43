//! Cut-offs: where a bend comes back to itself.

use super::{Oxbow, distance};

/// Distance of the lines of two parts at which the neck between them is cut, in widths.
const NECK: f64 = 1.3;

/// Minimum distance along the river of two parts, in widths, so that they are not the same bend's.
const APART: f64 = 5.0;

/// Cuts all necks, and adds the bends to `oxbows`.
pub fn cut(width: f64, points: &mut Vec<[f64; 2]>, time: f64, oxbows: &mut Vec<Oxbow>) {
    while let Some((from, to)) = neck(width, points) {
        let line = points[from..=to].to_vec();
        points.drain(from + 1..to);
        oxbows.push(Oxbow { line, time });
    }
}

/// The first point that is near a later part of the river, and its nearest point there.
fn neck(width: f64, points: &[[f64; 2]]) -> Option<(usize, usize)> {
    let cell = NECK * width;
    let place = |[x, y]: [f64; 2]| ((x / cell).floor() as i64, (y / cell).floor() as i64);
    let mut along = Vec::with_capacity(points.len());
    let mut sum = 0.0;
    for (k, point) in points.iter().enumerate() {
        sum += if k > 0 { distance(points[k - 1], *point) } else { 0.0 };
        along.push(sum);
    }
    let mut placed: Vec<((i64, i64), usize)> = points.iter().map(|point| place(*point)).zip(0..).collect();
    placed.sort_unstable();
    for (k, point) in points.iter().enumerate() {
        let (column, row) = place(*point);
        let mut best: Option<(f64, usize)> = None;
        for column in column - 1..=column + 1 {
            let first = placed.partition_point(|(at, _)| *at < (column, row - 1));
            for &(_, other) in placed[first..].iter().take_while(|(at, _)| *at <= (column, row + 1)) {
                if other > k && along[other] - along[k] > APART * width {
                    let apart = distance(*point, points[other]);
                    if apart < cell && best.is_none_or(|best| (apart, other) < best) {
                        best = Some((apart, other));
                    }
                }
            }
        }
        if let Some((_, other)) = best {
            return Some((k, other));
        }
    }
    None
}
