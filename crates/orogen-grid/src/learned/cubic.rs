//! Interpolation of coarse heights at half their cell.

use crate::grid::Grid;

/// Cubic interpolation of coarse heights at a column and a row, and half a cell further where `east` or `south` is 1.
pub fn interpolated(coarse: &Grid, [column, row]: [usize; 2], [east, south]: [usize; 2]) -> f32 {
    let along = |row: usize| {
        let row = &coarse.row(row)[column - 1..column + 3];
        cubic([row[0], row[1], row[2], row[3]], east)
    };
    match south {
        0 => along(row),
        _ => cubic([row - 1, row, row + 1, row + 2].map(along), 1),
    }
}

/// The second of four values, or the interpolating cubic in the middle.
fn cubic([a, b, c, d]: [f32; 4], phase: usize) -> f32 {
    if phase == 0 { b } else { (b + c) * 0.5 + ((b - a) + (c - d)) * 0.0625 }
}
