//! The vertices along the border of a surface.

use std::collections::BTreeMap;

use super::surface::Surface;

/// The vertices along each side of a surface, counter-clockwise from above: along the north, the west, the south and
/// the east. The last vertex of a side is the first of the next side, and is listed only there.
pub(super) fn sides(surface: &Surface) -> [Vec<u32>; 4] {
    let shape = surface.shape;
    let [east, south] = [surface.grid.width() - 1, surface.grid.height() - 1];
    // Vertices by side and position along it; a corner of the grid is on two sides.
    let mut found: [BTreeMap<usize, u32>; 4] = Default::default();
    let mut corner = 0;
    for row in shape.rows() {
        row.each(|column| {
            for (side, on, along) in [
                (0, row.row == 0, east - column),
                (1, column == 0, row.row),
                (2, row.row == south, column),
                (3, column == east, south - row.row),
            ] {
                if on {
                    found[side].insert(along, corner);
                }
            }
            corner += 1;
        });
    }
    found.map(|mut side| {
        side.pop_last();
        side.into_values().collect()
    })
}
