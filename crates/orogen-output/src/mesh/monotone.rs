//! Triangulation of polygons between two lines from west to east.

/// Triangulates the polygon between an upper and a lower line; returns counter-clockwise triangles. Vertices are
/// indices, and `at` returns their position along the wall and up. No vertex is west of `start` or east of `end`. Both
/// lines never go westward, and they do not touch.
///
/// Every vertex is used, also vertices within straight lines, so the outer edges of the triangles are exactly the edges
/// of the polygon. This is the sweep of Garey et al., "Triangulating a simple polygon" (1978).
pub(super) fn triangles(
    at: &impl Fn(u32) -> [f64; 2],
    [start, end]: [u32; 2],
    upper: &[u32],
    lower: &[u32],
) -> Vec<[u32; 3]> {
    let turn = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(at);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let mut order: Vec<(u32, bool)> = Vec::with_capacity(upper.len() + lower.len());
    let (mut u, mut l) = (upper.iter().copied().peekable(), lower.iter().copied().peekable());
    loop {
        let is_upper = match (u.peek(), l.peek()) {
            (Some(above), Some(below)) => at(*above)[0] <= at(*below)[0],
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => break,
        };
        order.extend((if is_upper { u.next() } else { l.next() }).map(|vertex| (vertex, is_upper)));
    }
    let mut made = Vec::with_capacity(order.len());
    let mut push = |a: u32, b: u32, c: u32| made.push(if turn(a, b, c) >= 0.0 { [a, b, c] } else { [a, c, b] });
    let Some(&first) = order.first() else { return Vec::new() };
    let mut stack = vec![(start, first.1), first];
    for &(vertex, is_upper) in &order[1..] {
        let Some(&top) = stack.last() else { break };
        if top.1 != is_upper {
            for pair in stack.windows(2) {
                push(vertex, pair[0].0, pair[1].0);
            }
            stack = vec![top, (vertex, is_upper)];
            continue;
        }
        let mut last = top;
        stack.pop();
        while let Some(&before) = stack.last() {
            let side = turn(before.0, last.0, vertex);
            if !(if is_upper { side < 0.0 } else { side > 0.0 }) {
                break;
            }
            push(vertex, last.0, before.0);
            last = before;
            stack.pop();
        }
        stack.extend([last, (vertex, is_upper)]);
    }
    for pair in stack.windows(2) {
        push(end, pair[0].0, pair[1].0);
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Checks the triangles of a polygon: their area and their outer edges.
    fn check(at: &[[f64; 2]], ends: [u32; 2], upper: &[u32], lower: &[u32]) {
        let made = triangles(&|vertex| at[vertex as usize], ends, upper, lower);
        assert_eq!(made.len(), upper.len() + lower.len());
        let line: Vec<u32> = [ends[0]]
            .into_iter()
            .chain(lower.iter().copied())
            .chain([ends[1]])
            .chain(upper.iter().rev().copied())
            .collect();
        let pairs = |line: &[u32]| -> Vec<[u32; 2]> {
            (0..line.len()).map(|k| [line[k], line[(k + 1) % line.len()]]).collect()
        };
        let cross = |[a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|vertex| at[vertex as usize]);
            (a[0] * b[1] - a[1] * b[0]) / 2.0
        };
        let mut edges = BTreeSet::new();
        let mut area = 0.0;
        for triangle in &made {
            let sides = pairs(triangle);
            let own: f64 = sides.iter().map(|side| cross(*side)).sum();
            assert!(own > 0.0, "{triangle:?}");
            area += own;
            assert!(sides.into_iter().all(|side| edges.insert(side)), "{triangle:?}");
        }
        let open: BTreeSet<[u32; 2]> = edges.iter().copied().filter(|[a, b]| !edges.contains(&[*b, *a])).collect();
        assert_eq!(open, pairs(&line).into_iter().collect());
        let expect: f64 = pairs(&line).into_iter().map(cross).sum();
        assert!((area - expect).abs() < 1e-9 * expect, "{area} {expect}");
    }

    #[test]
    fn polygons_of_two_lines_are_filled() {
        // A house with a chimney, and vertices in the middle of straight lines.
        let at = [
            [0.0, 0.0],
            [9.0, 0.0],
            [0.0, 3.0],
            [3.0, 6.0],
            [3.0, 9.0],
            [4.0, 9.0],
            [4.0, 7.0],
            [9.0, 3.0],
            [2.0, 0.0],
            [4.5, 0.0],
            [7.0, 0.0],
        ];
        check(&at, [0, 1], &[2, 3, 4, 5, 6, 7], &[8, 9, 10]);
        // The sky around a tower with straight sides.
        let at = [
            [0.0, 0.0],
            [9.0, 0.0],
            [3.0, 1.0],
            [3.0, 4.0],
            [5.0, 4.0],
            [5.0, 1.0],
            [0.0, 8.0],
            [4.0, 8.0],
            [9.0, 8.0],
        ];
        check(&at, [0, 1], &[6, 7, 8], &[2, 3, 4, 5]);
        // Teeth above and below.
        let mut at = vec![[0.0, 0.0], [40.0, 0.0]];
        let (mut upper, mut lower) = (Vec::new(), Vec::new());
        for k in 1..40u32 {
            for (line, sign) in [(&mut upper, 1.0), (&mut lower, -1.0)] {
                line.push(at.len() as u32);
                at.push([f64::from(k), sign * (1.0 + f64::from(k * 7 % 5))]);
            }
        }
        check(&at, [0, 1], &upper, &lower);
    }
}
