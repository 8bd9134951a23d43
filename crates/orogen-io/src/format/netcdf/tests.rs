//! Hand-built files of the corpus, and damaged ones. Heights and positions of the corpus are compared with GDAL's where
//! GDAL reads them (`crates/orogen/tests/suite/dems.rs`).

use std::io::Cursor;

use super::reader::{head, read};
use crate::format::crs::keys::epsg;
use crate::format::crs::unit::Unit;
use crate::format::dem::{Dem, Part, Request};

const GRIDLINE: &[u8] = include_bytes!("../../../../../fuzz/corpus/dem/gmt-gridline.nc");
const PIXEL: &[u8] = include_bytes!("../../../../../fuzz/corpus/dem/gmt-pixel.grd");
const CDF5: &[u8] = include_bytes!("../../../../../fuzz/corpus/dem/cdf5.nc");
const RECORDS: &[u8] = include_bytes!("../../../../../fuzz/corpus/dem/records.nc");

const HEIGHTS: [f32; 6] = [1.0, 2.0, 3.0, 4.0, -5.0, 6.0];

fn open(bytes: &[u8], band: Option<u32>) -> Result<Dem, String> {
    let request = Request::new(1 << 20).with_band(band);
    read(&mut Cursor::new(bytes), "d/a.nc", request).map_err(|error| error.to_string())
}

#[test]
fn gridlines_and_pixels_have_their_samples_in_place() {
    for (bytes, origin, step, system) in
        [(GRIDLINE, [7.0, 46.01], [0.01, 0.01], Some(4326)), (PIXEL, [600_050.0, 5_199_950.0], [100.0; 2], None)]
    {
        let dem = open(bytes, None).unwrap();
        assert_eq!((dem.width, dem.height, &dem.heights[..]), (3, 2, &HEIGHTS[..]));
        let place = dem.place.clone().unwrap();
        assert!(
            (0..2).all(|k| (place.origin[k] - origin[k]).abs() < 1e-9 && (place.step[k] - step[k]).abs() < 1e-9),
            "{place:?}"
        );
        assert_eq!(place.keys.as_ref().and_then(epsg), system);
        assert_eq!(head(&mut Cursor::new(bytes), "a.nc", None).unwrap(), ([3, 2], dem.place));
    }
}

#[test]
fn packed_values_of_every_type_are_heights() {
    let dem = open(CDF5, None).unwrap();
    assert_eq!(
        (&dem.heights[..5], dem.missing()),
        (&HEIGHTS[..5].iter().map(|height| if *height > 0.0 { *height } else { -5.0 }).collect::<Vec<_>>()[..], 1)
    );
    assert_eq!(dem.place.unwrap().unit, Unit::Metres(1.0));
}

#[test]
fn records_and_variables_are_bands() {
    let first = open(RECORDS, Some(1)).unwrap();
    assert_eq!((&first.heights[..], first.place.unwrap().origin), (&HEIGHTS[..], [0.0, 20.0]));
    let second = open(RECORDS, Some(2)).unwrap();
    // A sample that was never written has the fill value of its type.
    assert_eq!((&second.heights[..5], second.missing()), (&[10.0, 20.0, 30.0, 40.0, -50.0][..], 1));
    let unsigned = open(RECORDS, Some(4)).unwrap();
    assert_eq!((&unsigned.heights[..5], unsigned.missing()), (&[200.0, 201.0, 202.0, 203.0, 204.0][..], 1));
    let why = open(RECORDS, None).unwrap_err();
    assert!(why.contains("it has 4 bands; choose one") && why.ends_with("its grids are a, b"), "{why}");
}

#[test]
fn a_part_has_its_rows_alone() {
    let part = Part { from: [1, 0], size: [2, 1] };
    for bytes in [GRIDLINE, PIXEL, CDF5] {
        let dem = read(&mut Cursor::new(bytes), "a.nc", Request::new(8).with_part(Some(part))).unwrap();
        assert_eq!((dem.width, dem.height, &dem.heights[..]), (2, 1, &HEIGHTS[1..3]));
    }
}

#[test]
fn what_is_no_grid_is_a_message() {
    let changed = |from: &[u8], to: &[u8]| {
        let at = GRIDLINE.windows(from.len()).rposition(|window| window == from).unwrap();
        [&GRIDLINE[..at], to, &GRIDLINE[at + to.len()..]].concat()
    };
    let degree = |number: f64| number.to_be_bytes();
    for (bytes, expect) in [
        (b"\x89HDF\r\n\x1a\n".to_vec(), "it is NetCDF-4, which is HDF5 and not supported"),
        (b"\x89HDF\r\n\x1a\n".to_vec(), "gdal_translate a.nc out.tif"),
        (b"DSBB".to_vec(), "it does not begin with CDF"),
        (b"CDF\x03".to_vec(), "it does not begin with CDF"),
        (GRIDLINE[..200].to_vec(), "it ends within its header"),
        (GRIDLINE[..GRIDLINE.len() - 1].to_vec(), "its samples should reach byte"),
        (changed(&degree(7.01), &degree(7.012)), "its coordinates `lon` are not evenly spaced"),
        (changed(&degree(7.02), &degree(7.0)), "its coordinates `lon` are not evenly spaced"),
        (GRIDLINE[..8].iter().copied().chain([0; 24]).collect(), "it has no grid"),
    ] {
        let why = open(&bytes, None).unwrap_err();
        assert!(why.contains(expect), "{why}");
    }
    let why = read(&mut Cursor::new(GRIDLINE), "a.nc", Request::new(23)).unwrap_err().to_string();
    assert!(why.contains("3 x 2 samples need 24 bytes"), "{why}");
}
