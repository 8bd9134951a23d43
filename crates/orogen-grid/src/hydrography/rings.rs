//! Rings: closed lines in columns and rows.

use super::joints::Path;
use crate::contour::line::twice_area;

/// Groups rings into parts: each outer ring with its holes, the largest first.
#[must_use]
pub fn nested(rings: Vec<&Path>) -> Vec<Vec<Path>> {
    let (outer, holes): (Vec<&Path>, Vec<&Path>) = rings.into_iter().partition(|ring| twice_area(ring) > 0.0);
    let mut parts: Vec<Vec<Path>> = outer.into_iter().map(|ring| vec![ring.clone()]).collect();
    parts.sort_by(|a, b| twice_area(&b[0]).total_cmp(&twice_area(&a[0])));
    for hole in holes {
        // A hole may touch the ring around it, but not along an edge. It belongs to the smallest part that contains it;
        // parts are sorted by size.
        let at = match hole.as_slice() {
            [[ax, ay], [bx, by], ..] => [(ax + bx) / 2.0, (ay + by) / 2.0],
            _ => continue,
        };
        let home = match parts.len() {
            1 => parts.first_mut(),
            _ => parts.iter_mut().rev().find(|part| holds(&part[0], at)),
        };
        if let Some(part) = home {
            part.push(hole.clone());
        }
    }
    parts
}

/// Whether a ring, which repeats its first point, contains a point (even-odd rule).
#[must_use]
pub fn holds(ring: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for pair in ring.windows(2) {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        if (ay > y) != (by > y) && x > ax + (y - ay) / (by - ay) * (bx - ax) {
            inside = !inside;
        }
    }
    inside
}
