//! Simplification of a border: the polyline with the fewest vertices within an error.

/// The indices of the vertices of a polyline along `heights` with the fewest vertices whose vertical distance from
/// every sample is at most `max_error`. It starts with the first sample and ends with the last.
///
/// The result depends only on these heights, so two tiles that share an edge get the same vertices along it. It is a
/// breadth-first search over the number of segments; the possible ends of a segment follow from the cone of slopes that
/// pass close enough to all samples so far (Imai and Iri, "Polygonal approximations of a curve", 1988).
pub(super) fn polyline(heights: &[f64], max_error: f64) -> Vec<usize> {
    let count = heights.len();
    if count < 3 {
        return (0..count).collect();
    }
    // The vertex from which a sample was first reached, or the sample itself if it was not reached.
    let mut from: Vec<usize> = (0..count).collect();
    let mut reached = vec![0];
    while from[count - 1] == count - 1 {
        let mut next = Vec::new();
        for &start in &reached {
            let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
            for end in start + 1..count {
                let (away, rise) = ((end - start) as f64, heights[end] - heights[start]);
                if from[end] == end && (low..=high).contains(&(rise / away)) {
                    from[end] = start;
                    next.push(end);
                }
                low = low.max((rise - max_error) / away);
                high = high.min((rise + max_error) / away);
                if low > high {
                    break;
                }
            }
        }
        reached = next;
    }
    let mut corners = vec![count - 1];
    let mut at = count - 1;
    while at != 0 {
        at = from[at];
        corners.push(at);
    }
    corners.reverse();
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest distance of a sample from the polyline.
    fn distance(heights: &[f64], corners: &[usize]) -> f64 {
        let mut worst: f64 = 0.0;
        for pair in corners.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            for at in a + 1..b {
                let t = (at - a) as f64 / (b - a) as f64;
                worst = worst.max((heights[a] + t * (heights[b] - heights[a]) - heights[at]).abs());
            }
        }
        worst
    }

    /// The minimum number of segments, by exhaustive search.
    fn fewest(heights: &[f64], max_error: f64) -> usize {
        let mut best = vec![usize::MAX; heights.len()];
        best[0] = 0;
        for end in 1..heights.len() {
            for start in 0..end {
                if distance(heights, &[start, end]) <= max_error && best[start] < usize::MAX {
                    best[end] = best[end].min(best[start] + 1);
                }
            }
        }
        best[heights.len() - 1]
    }

    fn wave(count: usize) -> Vec<f64> {
        (0..count).map(|i| 100.0 * libm::sin(i as f64 * 0.13) + 20.0 * libm::sin(i as f64 * 0.7 + 1.0)).collect()
    }

    #[test]
    fn it_stays_within_the_distance_with_the_fewest_corners() {
        let heights = wave(160);
        for max_error in [0.0, 0.5, 3.0, 20.0, 90.0, 1000.0] {
            let corners = polyline(&heights, max_error);
            assert_eq!((corners[0], corners[corners.len() - 1]), (0, 159));
            assert!(corners.windows(2).all(|pair| pair[0] < pair[1]));
            assert!(distance(&heights, &corners) <= max_error + 1e-9, "{max_error}");
            assert_eq!(corners.len() - 1, fewest(&heights, max_error), "{max_error}");
        }
    }

    #[test]
    fn short_and_straight_borders() {
        assert_eq!(polyline(&[1.0, 9.0], 0.0), [0, 1]);
        assert_eq!(polyline(&[4.0; 3000], 0.0), [0, 2999]);
        let ramp: Vec<f64> = (0..1000).map(|i| 0.5 * f64::from(i)).collect();
        assert_eq!(polyline(&ramp, 0.0), [0, 999]);
        assert_eq!(polyline(&[0.0, 5.0, 0.0], 4.9), [0, 1, 2]);
        assert_eq!(polyline(&[0.0, 5.0, 0.0], 5.0), [0, 2]);
    }
}
