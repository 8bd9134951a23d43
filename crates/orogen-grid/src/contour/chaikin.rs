//! Smoothing of lines by corner cutting.

use super::line::Line;

/// Cuts the corners of a line, `rounds` times. Every corner is replaced with the points at a quarter and three quarters
/// of the adjacent segments (G. Chaikin, "An algorithm for high-speed curve generation", Computer Graphics and Image
/// Processing 3, 1974). Each round doubles the number of points.
///
/// The ends of an open line do not move. Other points move by at most a quarter of the longer adjacent segment, so
/// neighboring lines rarely touch, but they may if they were very close.
#[must_use]
pub fn chaikin(line: &Line, rounds: usize) -> Line {
    let mut points = line.points.clone();
    for _ in 0..rounds {
        points = if line.closed { ring(&points) } else { open(&points) };
    }
    Line { points, ..line.clone() }
}

fn between(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]
}

fn ring(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).flat_map(|(a, b)| [between(*a, *b, 0.25), between(*a, *b, 0.75)]).collect()
}

fn open(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let ([first, .., last], true) = (points, points.len() > 2) else { return points.to_vec() };
    let mut out = vec![*first];
    let stretches = points.len() - 1;
    for (k, pair) in points.windows(2).enumerate() {
        // The first and last segments keep their outer quarter.
        if k > 0 {
            out.push(between(pair[0], pair[1], 0.25));
        }
        if k + 1 < stretches {
            out.push(between(pair[0], pair[1], 0.75));
        }
    }
    out.push(*last);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(closed: bool, points: &[[f64; 2]]) -> Line {
        Line { elevation: 1.0, level: 0, closed, points: points.to_vec() }
    }

    #[test]
    fn ends_stay_and_corners_go() {
        let corner = line(false, &[[0.0, 0.0], [8.0, 0.0], [8.0, 8.0]]);
        let round = chaikin(&corner, 1);
        assert_eq!(round.points, [[0.0, 0.0], [6.0, 0.0], [8.0, 2.0], [8.0, 8.0]]);
        let rounder = chaikin(&corner, 4);
        assert_eq!((rounder.points[0], *rounder.points.last().unwrap()), ([0.0, 0.0], [8.0, 8.0]));
        assert!(rounder.length() < round.length());
        assert_eq!(chaikin(&corner, 0), corner);
        let straight = line(false, &[[0.0, 0.0], [8.0, 0.0]]);
        assert_eq!(chaikin(&straight, 3), straight);
    }

    #[test]
    fn a_ring_stays_one_and_keeps_most_of_its_area() {
        let square = line(true, &[[0.0, 0.0], [0.0, 8.0], [8.0, 8.0], [8.0, 0.0]]);
        let round = chaikin(&square, 5);
        assert!(round.closed && round.points.len() == 4 << 5);
        // The limit of a square has five sixths of its area.
        assert!((round.area() / 64.0 - 5.0 / 6.0).abs() < 1e-3, "{}", round.area());
    }
}
