//! Small files as other programs write them, built here: their units, masks, absent blocks and positions.

use std::io::Cursor;

use super::options::Options;
use super::reader::{read, read_with};
use super::writer::write;
use crate::dem::prepared::PreparedDem;
use crate::format::aux_xml;
use crate::format::band::BandMetadata;
use crate::format::crs::keys::epsg;
use crate::format::crs::unit::{US_FOOT, Unit};
use crate::format::dem::Dem;
use crate::format::sidecar::Sidecar;
use crate::spool::Spool;
use orogen_grid::grid::Window;

/// The values of a tag.
enum Values {
    Shorts(Vec<u16>),
    Longs(Vec<u32>),
    Doubles(Vec<f64>),
    Text(&'static str),
}

use Values::{Doubles, Longs, Shorts, Text};

/// The bytes of a classic TIFF with these directories; `data` follows the header, at byte 8.
fn tiff(data: &[u8], directories: &[Vec<(u16, Values)>]) -> Vec<u8> {
    let mut out = b"II\x2a\0\0\0\0\0".to_vec();
    out.extend(data);
    let mut link = 4;
    for fields in directories {
        let mut table = (fields.len() as u16).to_le_bytes().to_vec();
        for (tag, values) in fields {
            let (kind, count, bytes): (u16, usize, Vec<u8>) = match values {
                Shorts(list) => (3, list.len(), list.iter().flat_map(|v| v.to_le_bytes()).collect()),
                Longs(list) => (4, list.len(), list.iter().flat_map(|v| v.to_le_bytes()).collect()),
                Doubles(list) => (12, list.len(), list.iter().flat_map(|v| v.to_le_bytes()).collect()),
                Text(text) => (2, text.len() + 1, [text.as_bytes(), &[0]].concat()),
            };
            table.extend(tag.to_le_bytes());
            table.extend(kind.to_le_bytes());
            table.extend((count as u32).to_le_bytes());
            if bytes.len() <= 4 {
                table.extend(&bytes);
                table.resize(table.len() + 4 - bytes.len(), 0);
            } else {
                table.extend((out.len() as u32).to_le_bytes());
                out.extend(&bytes);
            }
        }
        let at = (out.len() as u32).to_le_bytes();
        out[link..link + 4].copy_from_slice(&at);
        out.extend(table);
        link = out.len();
        out.extend([0; 4]);
    }
    out
}

const KEYS: [u16; 16] = [1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32632];

/// The tags of 4 x 4 floats at byte 8, in cells of 100 m.
fn fields(more: Vec<(u16, Values)>) -> Vec<(u16, Values)> {
    let mut fields = vec![
        (256, Shorts(vec![4])),
        (257, Shorts(vec![4])),
        (258, Shorts(vec![32])),
        (259, Shorts(vec![1])),
        (273, Longs(vec![8])),
        (277, Shorts(vec![1])),
        (278, Shorts(vec![4])),
        (279, Longs(vec![64])),
        (339, Shorts(vec![3])),
        (33550, Doubles(vec![100.0, 100.0, 0.0])),
        (33922, Doubles(vec![0.0, 0.0, 0.0, 600_000.0, 5_200_000.0, 0.0])),
        (34735, Shorts(KEYS.to_vec())),
    ];
    for (tag, values) in more {
        fields.retain(|(own, _)| *own != tag);
        fields.push((tag, values));
    }
    fields.sort_by_key(|(tag, _)| *tag);
    fields
}

/// Heights 0, 10, 20, ... 150.
fn samples() -> Vec<u8> {
    (0..16).flat_map(|k| (k as f32 * 10.0).to_le_bytes()).collect()
}

fn dem(more: Vec<(u16, Values)>) -> Result<Dem, String> {
    let bytes = tiff(&samples(), &[fields(more)]);
    read(&mut Cursor::new(bytes), "a.tif", 1 << 20).map_err(|error| error.to_string())
}

/// Writes a DEM with Orogen's writer and reads it again.
fn again(dem: &Dem) -> Dem {
    let prepared = PreparedDem::of(dem.clone(), None, 1 << 20).unwrap();
    let options = Options::of_unit("m").with_map(prepared.georeference.clone());
    let mut bytes = Vec::new();
    write(&mut bytes, &prepared.grid, &options, Spool::in_memory()).unwrap();
    read(&mut Cursor::new(bytes), "b.tif", 1 << 20).unwrap()
}

#[test]
fn padding_behind_the_keys_is_not_written_again() {
    let plain = again(&dem(Vec::new()).unwrap());
    let padded = again(&dem(vec![(34735, Shorts([&KEYS[..], &[0; 4]].concat()))]).unwrap());
    assert_eq!(padded, plain);
    let place = padded.place.unwrap();
    assert_eq!((place.origin, epsg(&place.keys.unwrap())), ([600_050.0, 5_199_950.0], Some(32632)));
}

#[test]
fn feet_become_metres_once() {
    let keys = |more: [u16; 4]| {
        let mut keys = [&KEYS[..], &more].concat();
        keys[3] = 4;
        (34735, Shorts(keys))
    };
    let item = "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item></GDALMetadata>";
    for (more, foot) in [
        (vec![keys([4099, 0, 1, 9002])], 0.3048),
        (vec![keys([4099, 0, 1, 9003])], US_FOOT),
        (vec![keys([4096, 0, 1, 6360])], US_FOOT),
        (vec![keys([4096, 0, 1, 8228])], 0.3048),
        (vec![(42112, Text(item))], 0.3048),
        // The unit of the band takes precedence over that of the coordinate system, as in GDAL.
        (vec![keys([4099, 0, 1, 9003]), (42112, Text(item))], 0.3048),
        (vec![keys([4096, 0, 1, 5703])], 1.0),
    ] {
        let dem = dem(more).unwrap();
        assert_eq!(dem.heights[15], (150.0 * foot) as f32);
        assert_eq!(again(&dem).heights, dem.heights, "a second time nothing changes");
    }
    let why = dem(vec![keys([4099, 0, 1, 9102])]).unwrap_err();
    assert!(why.contains("EPSG:9102 (GeoKey 4099)"), "{why}");
}

#[test]
fn metadata_that_is_no_number_is_refused() {
    let item = "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">nan</Item></GDALMetadata>";
    assert!(dem(vec![(42112, Text(item))]).unwrap_err().contains("the scale of its band"));
    for tags in [
        (33550, Doubles(vec![f64::NAN, 100.0, 0.0])),
        (33922, Doubles(vec![0.0, 0.0, 0.0, 1e300, 5_200_000.0, 0.0])),
        (33922, Doubles(vec![0.0, 0.0, 0.0, 600_000.0, f64::NAN, 0.0])),
    ] {
        assert!(dem(vec![tags]).unwrap_err().contains("georeference"));
    }
}

#[test]
fn grads_are_nine_tenths_of_degrees() {
    let keys = vec![1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4807];
    let position = Doubles(vec![0.0, 0.0, 0.0, 2.0, 50.0, 0.0]);
    let dem = dem(vec![(34735, Shorts(keys)), (33550, Doubles(vec![0.01, 0.01, 0.0])), (33922, position)]).unwrap();
    assert_eq!(dem.place.as_ref().unwrap().unit, Unit::Grads);
    let prepared = PreparedDem::of(dem, None, 1 << 20).unwrap();
    // At 45 degrees north, 0.009 degrees of longitude become square cells of this length.
    assert!((prepared.grid.window().cell - 709.7).abs() < 0.5, "{:?}", prepared.grid.window());
    let north = (prepared.grid.height() - 1) as f64 * prepared.grid.window().cell;
    assert!((2100.0..=3001.0).contains(&north), "{north}");
}

#[test]
fn absent_blocks_are_zero_or_nodata() {
    let absent = || vec![(273, Longs(vec![8, 0])), (278, Shorts(vec![2])), (279, Longs(vec![32, 0]))];
    let zero = dem(absent()).unwrap();
    assert_eq!((zero.heights[7], &zero.heights[8..]), (70.0, &[0.0; 8][..]));
    let mut with = absent();
    with.push((42113, Text("-1")));
    assert_eq!(dem(with).unwrap().missing(), 8);
}

#[test]
fn masked_samples_are_missing() {
    // One bit per sample, each row padded to a byte: column 0 of row 1 and column 3 of row 2 are masked.
    let data = [&samples()[..], &[0xf0, 0x70, 0xe0, 0xf0]].concat();
    let mask = |kind: u32, size: u16, bits: u16, at: u32, length: u32| {
        vec![
            (254, Longs(vec![kind])),
            (256, Shorts(vec![size])),
            (257, Shorts(vec![size])),
            (258, Shorts(vec![bits])),
            (259, Shorts(vec![1])),
            (273, Longs(vec![at])),
            (277, Shorts(vec![1])),
            (278, Shorts(vec![size])),
            (279, Longs(vec![length])),
        ]
    };
    let missing = |dem: &Dem| -> Vec<usize> { (0..16).filter(|k| dem.heights[*k].is_nan()).collect() };
    let open = |bytes: &[u8]| read(&mut Cursor::new(bytes), "a.tif", 1 << 20);
    let own = open(&tiff(&data, &[fields(Vec::new()), mask(4, 4, 1, 72, 4)])).unwrap();
    assert_eq!(missing(&own), [4, 11]);
    // The mask of an overview does not apply.
    let other = open(&tiff(&data, &[fields(Vec::new()), mask(5, 2, 1, 72, 2)])).unwrap();
    assert_eq!(missing(&other), [0usize; 0]);
    let error = open(&tiff(&data, &[fields(Vec::new()), mask(4, 4, 1, 72, 2)])).unwrap_err().to_string();
    assert!(error.contains("its mask cannot be read"), "{error}");

    // A broken chain of directories does not hide the raster.
    let mut broken = tiff(&samples(), &[fields(Vec::new())]);
    let end = broken.len();
    broken[end - 4..].copy_from_slice(&u32::MAX.to_le_bytes());
    let dem = open(&broken).unwrap();
    assert!(dem.missing() == 0 && dem.notes[0].contains("after its raster cannot be read"), "{:?}", dem.notes);

    let folder = crate::test_folder::TestFolder::new("geotiff-mask").unwrap();
    let path = folder.join("a.tif");
    std::fs::write(&path, tiff(&samples(), &[fields(Vec::new())])).unwrap();
    let bytes: Vec<u8> = (0..16).map(|k| if k == 5 { 0 } else { 255 }).collect();
    std::fs::write(folder.join("a.tif.msk"), tiff(&bytes, &[mask(0, 4, 8, 8, 16)])).unwrap();
    assert_eq!(missing(&crate::format::import::read(&path, 1 << 20).unwrap()), [5]);
    std::fs::write(folder.join("a.tif.msk"), tiff(&bytes, &[mask(0, 2, 8, 8, 4)])).unwrap();
    let error = crate::format::import::read(&path, 1 << 20).unwrap_err().to_string();
    assert!(error.contains("the .msk beside it cannot be read: it has 2 x 2 samples"), "{error}");
}

#[test]
fn the_sidecar_of_gdal_states_nodata_and_unit() {
    let xml = "<PAMDataset><PAMRasterBand band=\"1\"><NoDataValue>70</NoDataValue><UnitType>ft</UnitType></PAMRasterBand></PAMDataset>";
    let told = Sidecar { bands: aux_xml::parse(xml).unwrap().bands, ..Sidecar::default() };
    let bytes = tiff(&samples(), &[fields(Vec::new())]);
    let dem = read_with(&mut Cursor::new(bytes), "a.tif", 1 << 20, &told).unwrap();
    assert!(dem.heights[7].is_nan() && dem.missing() == 1 && dem.heights[1] == 3.048);
    assert_eq!(told.band(Some(2)), BandMetadata::default());
}

#[test]
fn cells_that_are_nearly_square_keep_both_sizes() {
    let dem = dem(vec![(33550, Doubles(vec![100.09, 100.0, 0.0]))]).unwrap();
    let map = PreparedDem::of(dem, None, 1 << 20).unwrap();
    let ([east, _], steps) = map.georeference.unwrap().of(&Window::new(4, 4, 100.0));
    assert!((east + 3.0 * steps[0] - (600_000.0 + 3.5 * 100.09)).abs() < 1e-6 && steps[1] == 100.0, "{steps:?}");
}

#[test]
fn an_alpha_band_is_a_mask() {
    let samples = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let fields = |planes: u16, offsets: Vec<u32>, lengths: Vec<u32>| {
        vec![
            (256, Shorts(vec![3])),
            (257, Shorts(vec![1])),
            (258, Shorts(vec![32, 32])),
            (259, Shorts(vec![1])),
            (262, Shorts(vec![1])),
            (273, Longs(offsets)),
            (277, Shorts(vec![2])),
            (278, Shorts(vec![1])),
            (279, Longs(lengths)),
            (284, Shorts(vec![planes])),
            (338, Shorts(vec![2])),
            (339, Shorts(vec![3, 3])),
        ]
    };
    let together = tiff(&samples(&[5.0, 255.0, -9999.0, 0.0, 7.0, 1.0]), &[fields(1, vec![8], vec![24])]);
    let apart = tiff(&samples(&[5.0, -9999.0, 7.0, 255.0, 0.0, 1.0]), &[fields(2, vec![8, 20], vec![12, 12])]);
    for file in [together, apart] {
        // GDAL reads bands of 8 and 16 bits in the same way.
        let dem = read(&mut Cursor::new(&file), "a.tif", 1 << 20).unwrap();
        assert!(dem.heights[0] == 5.0 && dem.heights[1].is_nan() && dem.heights[2] == 7.0, "{:?}", dem.heights);
        assert!(dem.notes.is_empty(), "{:?}", dem.notes);
    }
}

#[test]
fn halves_are_floats() {
    let fields = vec![
        (256, Shorts(vec![2])),
        (257, Shorts(vec![1])),
        (258, Shorts(vec![16])),
        (259, Shorts(vec![1])),
        (273, Longs(vec![8])),
        (277, Shorts(vec![1])),
        (278, Shorts(vec![1])),
        (279, Longs(vec![4])),
        (339, Shorts(vec![3])),
    ];
    let dem = read(&mut Cursor::new(&tiff(&[0x00, 0x3e, 0x00, 0xc0], &[fields])), "a.tif", 1 << 20).unwrap();
    assert_eq!(dem.heights, [1.5, -2.0]);
}
