//! Simplification of lines.

/// The points of a line that are needed so that no point of the line is further than `tolerance` from the result
/// (Douglas and Peucker 1973). Both ends are kept.
#[must_use]
pub fn thinned(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let mut is_kept = vec![false; points.len()];
    for end in [is_kept.len().checked_sub(1), Some(0)].into_iter().flatten() {
        if let Some(end) = is_kept.get_mut(end) {
            *end = true;
        }
    }
    let mut waiting = vec![[0, points.len().saturating_sub(1)]];
    while let Some([first, last]) = waiting.pop() {
        let (Some(from), Some(to)) = (points.get(first), points.get(last)) else { continue };
        let between = points.iter().zip(&mut is_kept).enumerate().take(last).skip(first + 1);
        let farthest = between
            .map(|(k, (point, is_kept))| (distance([*from, *to], *point), k, is_kept))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, k, is_kept)) = farthest.filter(|(far, ..)| *far > tolerance) {
            *is_kept = true;
            waiting.extend([[first, k], [k, last]]);
        }
    }
    points.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept).map(|(point, _)| *point).collect()
}

/// The distance from the line segment between two points.
pub(super) fn distance([[ax, ay], [bx, by]]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> f64 {
    let (ux, uy) = (bx - ax, by - ay);
    let square = ux * ux + uy * uy;
    let along = if square > 0.0 { (((x - ax) * ux + (y - ay) * uy) / square).clamp(0.0, 1.0) } else { 0.0 };
    libm::hypot(x - ax - along * ux, y - ay - along * uy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_need_two_points() {
        let line: Vec<[f64; 2]> = (0..50).map(|k| [f64::from(k), 2.0 * f64::from(k)]).collect();
        assert_eq!(thinned(&line, 0.01), [[0.0, 0.0], [49.0, 98.0]]);
        assert_eq!(thinned(&line[..1], 0.01), [[0.0, 0.0]]);
        assert_eq!(thinned(&[], 0.01), [[0.0; 2]; 0]);
        // There and back again: the turning point is kept.
        assert_eq!(thinned(&[[0.0, 0.0], [9.0, 0.0], [1.0, 0.0]], 0.5), [[0.0, 0.0], [9.0, 0.0], [1.0, 0.0]]);
    }

    #[test]
    fn no_point_is_farther_away_than_the_tolerance() {
        let spiral = |k: i32| {
            let turn = f64::from(k) * 0.02;
            [libm::cos(turn) * turn * 10.0, libm::sin(turn) * turn * 10.0]
        };
        let line: Vec<[f64; 2]> = (0..2000).map(spiral).collect();
        for tolerance in [0.1, 1.0, 5.0] {
            let thin = thinned(&line, tolerance);
            let away = |point: &[f64; 2]| {
                thin.windows(2).map(|ends| distance([ends[0], ends[1]], *point)).fold(f64::INFINITY, f64::min)
            };
            let worst = line.iter().map(away).fold(0.0, f64::max);
            assert!(worst <= tolerance && worst > tolerance / 4.0, "{worst} {tolerance}");
            assert!(thin.len() < 1000 && (thin.first(), thin.last()) == (line.first(), line.last()), "{}", thin.len());
        }
    }
}
