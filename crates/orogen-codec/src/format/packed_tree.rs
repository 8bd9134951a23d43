//! Packed R-trees: boxes sorted along a Hilbert curve and grouped into nodes, level by level (I. Kamel and C.
//! Faloutsos, "On Packing R-trees", CIKM 1993).

use super::coordinates::join;

/// Bounds: west, south, east, north.
pub type Bounds = [f64; 4];

/// The order of boxes along a Hilbert curve over all of them, by their centers. Ties keep the order of the list.
pub fn hilbert_order(boxes: &[Bounds]) -> Vec<usize> {
    let Some(all) = boxes.iter().copied().reduce(join) else { return Vec::new() };
    const LARGEST: f64 = 65_535.0;
    let along = |low: f64, high: f64, from: f64, to: f64| {
        let extent = to - from;
        if extent > 0.0 { (LARGEST * ((low + high) / 2.0 - from) / extent).clamp(0.0, LARGEST) as u32 } else { 0 }
    };
    let mut keyed: Vec<(u32, usize)> = (boxes.iter().enumerate())
        .map(|(k, [w, s, e, n])| (hilbert(along(*w, *e, all[0], all[2]), along(*s, *n, all[1], all[3])), k))
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, k)| k).collect()
}

/// The position of a cell along a Hilbert curve of 2^16 x 2^16 cells.
fn hilbert(mut x: u32, mut y: u32) -> u32 {
    let mut along = 0u32;
    for bit in (0..16).rev() {
        let side = 1u32 << bit;
        let (right, upper) = (u32::from(x & side > 0), u32::from(y & side > 0));
        along = along << 2 | ((3 * right) ^ upper);
        if upper == 0 {
            if right == 1 {
                (x, y) = (0xFFFF - x, 0xFFFF - y);
            }
            (x, y) = (y, x);
        }
    }
    along
}

/// The boxes of all nodes over sorted boxes, with `fanout` children per node. The lowest level is first, the level of
/// the root (one node) last. Without boxes there are no levels.
#[must_use]
pub fn levels(boxes: &[Bounds], fanout: usize) -> Vec<Vec<Bounds>> {
    let mut levels: Vec<Vec<Bounds>> = Vec::new();
    let mut below = boxes;
    while !below.is_empty() {
        let level: Vec<Bounds> =
            (below.chunks(fanout.max(2))).filter_map(|children| children.iter().copied().reduce(join)).collect();
        levels.push(level);
        below = match levels.last() {
            Some(level) if level.len() > 1 => level,
            _ => &[],
        };
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_from_cell_to_neighboring_cell() {
        // The first 4^5 cells of the curve fill a square, and consecutive cells are adjacent.
        let mut cells: Vec<(u32, [i64; 2])> = Vec::new();
        for x in 0..32u32 {
            for y in 0..32u32 {
                // The largest cells, which are the cells of a coarser curve.
                cells.push((hilbert(x << 11, y << 11) >> 22, [i64::from(x), i64::from(y)]));
            }
        }
        cells.sort_unstable();
        for (k, pair) in cells.windows(2).enumerate() {
            let ([ax, ay], [bx, by]) = (pair[0].1, pair[1].1);
            assert_eq!((pair[0].0 as usize, (ax - bx).abs() + (ay - by).abs()), (k, 1), "{pair:?}");
        }
    }

    #[test]
    fn nodes_hold_what_is_below_them() {
        let boxes: Vec<Bounds> = (0..300).map(|k| [k as f64, 0.0, k as f64 + 2.0, 5.0]).collect();
        let levels = levels(&boxes, 16);
        assert_eq!(levels.iter().map(Vec::len).collect::<Vec<_>>(), [19, 2, 1]);
        assert_eq!(levels[2], [[0.0, 0.0, 301.0, 5.0]]);
        assert_eq!(levels[0][1], [16.0, 0.0, 33.0, 5.0]);
        assert_eq!((super::levels(&[], 16).len(), super::levels(&boxes[..1], 16).len()), (0, 1));
        let order = hilbert_order(&boxes);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..300).collect::<Vec<_>>());
    }
}
