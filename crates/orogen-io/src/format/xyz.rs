//! Regular grids as text, `.xyz`: a line of east, north and height for each sample, separated by blanks, commas,
//! semicolons or tabs, row by row, from the north or from the south. The first line may contain names.

use super::affine::{Affine, Lattice};
use super::crs::unit::Unit;
use super::dem::{Dem, Input, Placement, refused, turn_rows};
use super::xyz_rows::{self, Rows};
use orogen_grid::error::Result;

/// Reads a grid. `name` is the file's name in errors.
///
/// # Errors
/// If a line is not three numbers, the samples do not form a regular grid, or heights take more than `allowed` bytes.
pub fn read(input: &mut dyn Input, name: &str, allowed: u64) -> Result<Dem> {
    open(input, allowed).map_err(|why| refused(name, why))
}

fn open(input: &mut dyn Input, allowed: u64) -> std::result::Result<Dem, String> {
    let Rows { mut heights, width, first, step, down } = xyz_rows::read(input, allowed)?;
    let rows = heights.len() / width;
    let Lattice { origin, step, from_south } = Affine([step, 0.0, first[0], 0.0, down, first[1]]).lattice(rows)?;
    if from_south {
        turn_rows(&mut heights, width);
    }
    let unit = Unit::guess(origin, step);
    Dem::new([width, rows], heights, Some(Placement { origin, step, unit, cell: None, keys: None }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn grid(text: &str) -> std::result::Result<Dem, String> {
        open(&mut Cursor::new(text.as_bytes()), 1 << 20)
    }

    #[test]
    fn rows_from_the_north_and_from_the_south() {
        // As written by GDAL, and with names, commas and rows from the south.
        let north = "600050 5199950 1\n600150 5199950 2\n600250 5199950 3\n600050 5199850 4\n600150 5199850 -5\n600250 5199850 6\n";
        let south = "x,y,z\n600050,5199850,4\n600150,5199850,-5\n600250,5199850,6\r\n600050,5199950,1\n600150,5199950,2\n600250,5199950,3";
        let commas = north.replace(' ', ";").replace(";5", ",0;5");
        assert!(commas.starts_with("600050,0;5199950;1\n"));
        for text in [north, south, &commas] {
            let dem = grid(text).unwrap();
            assert_eq!((dem.width, dem.height, &dem.heights[..]), (3, 2, &[1.0, 2.0, 3.0, 4.0, -5.0, 6.0][..]));
            let place = dem.place.unwrap();
            assert_eq!((place.origin, place.step), ([600_050.0, 5_199_950.0], [100.0; 2]));
        }
    }

    #[test]
    fn what_is_no_regular_grid_is_a_message() {
        for (text, expect) in [
            ("", "fewer than two rows"),
            ("1 2 3\n", "fewer than two rows"),
            ("0 0 1\n1 0 2\n", "fewer than two rows"),
            ("0 0 1\n1 0 2\n0 -1 3\n", "not whole rows of 2"),
            ("0 0 1\n1 0 2\n0.5 -1 3\n1 -1 3\n", "line 3 is at 0.5, -1"),
            ("0 0 1\n1 0 2\n3 0 2\n", "line 3 is at 3, 0"),
            ("0 0 1\n1 x 2\n", "line 2 is not three numbers"),
            ("0 0 1\n0 1 2\n0 2 3\n", "not whole rows"),
            ("1 0 1\n0 0 2\n1 -1 3\n0 -1 3\n", "from west to east"),
        ] {
            let why = grid(text).unwrap_err();
            assert!(why.contains(expect), "{text:?}: {why}");
        }
        let many = "0 0 1\n1 0 2\n0 -1 3\n1 -1 3\n";
        assert!(open(&mut Cursor::new(many.as_bytes()), 8).unwrap_err().contains("is allowed"));
    }
}
