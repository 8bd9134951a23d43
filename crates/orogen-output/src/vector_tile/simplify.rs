//! Simplification of lines (Douglas and Peucker 1973).

/// The points that a line needs to stay within `tolerance` of itself, in order. The first, the last and all fixed
/// points are kept, so that parts of a line between fixed points do not depend on the parts around them.
pub fn simplified(points: &[[f64; 2]], is_fixed: &[bool], tolerance: f64) -> Vec<[f64; 2]> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let is_kept = |at: usize| at == 0 || at == last || is_fixed.get(at).copied().unwrap_or(false);
    let mut keep: Vec<bool> = (0..points.len()).map(is_kept).collect();
    let (mut left, mut from) = (Vec::new(), 0);
    for at in (1..=last).filter(|at| is_kept(*at)) {
        left.push((from, at));
        from = at;
    }
    while let Some((first, end)) = left.pop() {
        let inner = points.get(first + 1..end).unwrap_or_default();
        let (mut far, mut most) = (first, tolerance * tolerance);
        for (k, point) in inner.iter().enumerate() {
            let squared = squared_distance(*point, points[first], points[end]);
            if squared > most {
                (far, most) = (first + 1 + k, squared);
            }
        }
        if far > first {
            keep[far] = true;
            left.extend([(first, far), (far, end)]);
        }
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(point, _)| *point).collect()
}

/// The square of the distance of a point from a segment.
fn squared_distance([x, y]: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, across) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
    let length = along[0] * along[0] + along[1] * along[1];
    let share = match length > 0.0 {
        true => ((across[0] * along[0] + across[1] * along[1]) / length).clamp(0.0, 1.0),
        false => 0.0,
    };
    let [east, south] = [across[0] - share * along[0], across[1] - share * along[1]];
    east * east + south * south
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_stays_close_and_fixed_points_stay() {
        let wave: Vec<[f64; 2]> = (0..200).map(|k| [f64::from(k), 30.0 * libm::sin(f64::from(k) / 9.0)]).collect();
        let mut fixed = vec![false; wave.len()];
        fixed[77] = true;
        let found = simplified(&wave, &fixed, 0.5);
        assert!(
            found.len() < 80 && found.contains(&wave[77]) && found.contains(&wave[0]) && found.contains(&wave[199])
        );
        for point in &wave {
            let near = found.windows(2).map(|pair| squared_distance(*point, pair[0], pair[1])).fold(f64::MAX, f64::min);
            assert!(near <= 0.25);
        }
        // The parts on both sides of a fixed point are those of the lines that end there.
        let none = vec![false; wave.len()];
        let mut parts = simplified(&wave[..=77], &none, 0.5);
        parts.extend(&simplified(&wave[77..], &none, 0.5)[1..]);
        assert_eq!(parts, found);
        assert!(simplified(&[], &[], 1.0).is_empty());
        assert_eq!(simplified(&[[1.0, 1.0]], &[], 1.0), [[1.0, 1.0]]);
        // A ring keeps the points that are far from its start.
        let ring = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]];
        assert_eq!(simplified(&ring, &[], 1.0), ring);
    }
}
