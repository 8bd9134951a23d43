//! Rings of detail around the place that the camera looks at: nested squares, each with half the cell of the one around
//! it.

use orogen::Window;

/// Maximum number of rings.
pub const MAX_RINGS: u32 = 5;

/// The border over which a ring turns into the coarser one, as a divisor of its side.
pub const BAND: usize = 16;

/// The steps in which rings move, as a divisor of their side: small movements of the camera need no new ring.
const STEPS: usize = 8;

/// Rings with fewer cells along a side are left out.
const MIN_CELLS: i64 = 32;

/// The windows of the rings around a place (metres east and south) of a land, from coarse to fine. `cells` is the
/// number of cells along their sides, a multiple of 16; the finest ones have a cell of about `cell` metres.
#[must_use]
pub fn around(land: &Window, place: [f64; 2], cell: f64, cells: usize) -> Vec<Window> {
    let mut windows: Vec<Window> = Vec::new();
    let ([width, height], first) = ([land.width, land.height].map(|side| side as i64), [land.x, land.y]);
    let mut lowest = first;
    let mut highest = [first[0] + width - 1, first[1] + height - 1];
    let mut own = land.cell;
    let cells = cells as i64;
    while windows.len() < MAX_RINGS as usize && own > cell && place.iter().all(|metres| metres.is_finite()) {
        own /= 2.0;
        // Samples of a coarser ring are samples of a finer one.
        let [first, last] = [lowest, highest].map(|ends| ends.map(|at| 2 * at));
        let step = cells / STEPS as i64;
        let ends = [0, 1].map(|axis| {
            let side = cells.min((last[axis] - first[axis]) / 2 * 2);
            let start = ((place[axis] / own - side as f64 / 2.0) / step as f64).round() as i64 * step;
            let start = start.clamp(first[axis], last[axis] - side);
            [start, start + side]
        });
        if ends.iter().any(|[start, end]| end - start < MIN_CELLS) {
            break;
        }
        let samples = ends.map(|[start, end]| (end - start + 1) as usize);
        windows.push(Window::new(samples[0], samples[1], own).at(ends[0][0], ends[1][0]));
        // The next ring is inside the part that shows all details.
        let [inset_x, inset_y] = ends.map(|[start, end]| band((end - start + 1) as usize) as i64);
        lowest = [ends[0][0] + inset_x, ends[1][0] + inset_y];
        highest = [ends[0][1] - inset_x, ends[1][1] - inset_y];
    }
    windows
}

/// The number of cells over which a ring with so many samples along a side turns into the coarser one.
#[must_use]
pub fn band(samples: usize) -> usize {
    (samples / BAND).max(4)
}

/// Whether a ring is inside the part of a coarser ring that shows all details.
#[must_use]
pub fn is_within(fine: &Window, coarse: &Window) -> bool {
    let inside = |[first, count]: [i64; 2], [around, samples]: [i64; 2]| {
        let inset = band(samples as usize) as i64;
        let metres = |at: i64, cell: f64| at as f64 * cell;
        metres(first, fine.cell) >= metres(around + inset, coarse.cell)
            && metres(first + count - 1, fine.cell) <= metres(around + samples - 1 - inset, coarse.cell)
    };
    inside([fine.x, fine.width as i64], [coarse.x, coarse.width as i64])
        && inside([fine.y, fine.height as i64], [coarse.y, coarse.height as i64])
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAND: Window = Window { width: 1024, height: 1024, cell: 60.0, x: 0, y: 0 };

    #[test]
    fn cells_become_as_fine_as_asked_and_rings_are_nested() {
        assert!(around(&LAND, [3e4; 2], 60.0, 512).is_empty());
        for (cell, count) in [(59.0, 1), (30.0, 1), (29.0, 2), (4.0, 4), (1e-3, MAX_RINGS as usize)] {
            let rings = around(&LAND, [2e4, 3e4], cell, 512);
            assert_eq!(rings.len(), count, "{cell}");
            for (k, ring) in rings.iter().enumerate() {
                assert_eq!((ring.cell, ring.width), (60.0 / f64::from(2 << k), 513));
                let middle = |first: i64, count: usize| (first as f64 + count as f64 / 2.0) * ring.cell;
                assert!((middle(ring.x, ring.width) - 2e4).abs() < 40.0 * ring.cell);
                assert!(k == 0 || is_within(ring, &rings[k - 1]));
                // Borders are at samples of the coarser ring.
                assert!([ring.x, ring.y, ring.x + 512].iter().all(|at| at % 2 == 0));
            }
        }
    }

    #[test]
    fn small_movements_need_no_new_rings() {
        let rings = around(&LAND, [2e4, 3e4], 4.0, 512);
        let differ = |by: f64| {
            let moved = around(&LAND, [2e4 + by, 3e4], 4.0, 512);
            rings.iter().zip(moved).filter(|(before, after)| *before != after).count()
        };
        assert_eq!(differ(1.0), 0);
        assert!(differ(300.0) > 0 && differ(300.0) < 4, "only the finest ones move");
    }

    #[test]
    fn rings_stay_inside_the_land() {
        for (land, place) in [
            (LAND, [0.0; 2]),
            (LAND, [61_000.0, -500.0]),
            (Window { width: 600, height: 90, cell: 10.0, x: -300, y: 4000 }, [2000.0, 40_200.0]),
            (Window { width: 257, height: 257, cell: 8.0, x: -9, y: 7 }, [100.0, 100.0]),
        ] {
            let rings = around(&land, place, 0.1, 256);
            assert!(!rings.is_empty());
            let mut around = land;
            for (k, ring) in rings.iter().enumerate() {
                let outer = |first: i64, count: usize, cell: f64| {
                    [first as f64 * cell, (first + count as i64 - 1) as f64 * cell]
                };
                for (own, coarse) in [
                    (outer(ring.x, ring.width, ring.cell), outer(around.x, around.width, around.cell)),
                    (outer(ring.y, ring.height, ring.cell), outer(around.y, around.height, around.cell)),
                ] {
                    assert!(own[0] >= coarse[0] && own[1] <= coarse[1], "{ring:?} in {around:?}");
                }
                assert!(k == 0 || is_within(ring, &around));
                around = *ring;
            }
        }
        assert!(around(&Window { width: 12, height: 12, cell: 10.0, x: 0, y: 0 }, [50.0; 2], 0.1, 256).is_empty());
        assert!(around(&LAND, [f64::NAN, 0.0], 0.1, 256).is_empty());
    }
}
