//! Files of heights from other programs, intact and damaged. Source: `xtask/clients/dem_files.py`.

use orogen::field::{Dem as Node, DemShows};
use orogen::filter::Blur;
use orogen::io::dem::{PreparedDem, open};
use orogen::io::format::crs::keys::{self, GeoKeys};
use orogen::io::format::crs::unit::Unit;
use orogen::io::format::dem::Part;
use orogen::io::format::geotiff::Options as Layout;
use orogen::io::format::geotiff::{reader, writer};
use orogen::io::format::{Dem, Request, import};
use orogen::io::spool::Spool;
use orogen::io::test_folder::TestFolder;
use orogen::{Budget, Error, ErrorKind, Options, Recipe, Window, World, WorldSpec};
use std::io::Cursor;
use std::path::{Path, PathBuf};

pub fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/dem")
}

fn read(name: &str) -> Dem {
    import::read(&corpus().join(name), 1 << 20).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(name: &str) -> String {
    import::read(&corpus().join(name), 1 << 20).unwrap_err().to_string()
}

/// The value that `dem_files.py` writes at column `i`, row `j`.
fn formula(i: usize, j: usize) -> f32 {
    30.0 + 2.0 * i as f32 - j as f32 + (i * j % 7) as f32
}

/// Compares with the formula; if `hole` is true, sample (5, 3) is a hole.
fn same(name: &str, dem: &Dem, add: f32, within: f32, hole: bool) {
    assert_eq!((dem.width, dem.height, dem.missing()), (37, 23, usize::from(hole)), "{name}");
    for (k, height) in dem.heights.iter().enumerate() {
        let (i, j) = (k % 37, k / 37);
        if hole && (i, j) == (5, 3) {
            assert!(height.is_nan(), "{name}");
        } else {
            let expect = formula(i, j) + add;
            assert!((height - expect).abs() <= within, "{name} at ({i}, {j}): {height}, not {expect}");
        }
    }
}

#[test]
fn every_kind_of_geotiff_is_read() {
    let mut seen = 0;
    for entry in std::fs::read_dir(corpus()).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let kind = name.split('-').next().unwrap_or_default();
        let add = match kind {
            "f32" => 0.25,
            "f64" => 0.125,
            "i8" | "i16" | "i32" | "i64" | "u8" | "u16" | "u32" | "u64" => 0.0,
            _ => continue,
        };
        let dem = read(&name);
        same(&name, &dem, add, 0.0, true);
        let place = dem.place.unwrap();
        assert_eq!(
            (place.origin, place.step, place.unit),
            ([500015.0, 5199985.0], [30.0; 2], Unit::Metres(1.0)),
            "{name}"
        );
        assert!(
            place.keys.unwrap().directory.windows(4).any(|key| key == [3072, 0, 1, 32632]),
            "{name}: EPSG code kept"
        );
        seen += 1;
    }
    assert_eq!(seen, 28);
}

#[test]
fn other_formats_are_read() {
    same("arc.asc", &read("arc.asc"), 0.25, 0.0, true);
    let place = read("arc.asc").place.unwrap();
    assert_eq!((place.origin, place.step), ([500015.0, 5199985.0], [30.0; 2]));
    same("array.npy", &read("array.npy"), 0.25, 0.0, false);
    same("floats.r32", &read("floats.r32"), 0.25, 0.0, false);
    same("grey.png", &read("grey.png"), 0.0, 1e-3, false);
    same("raw.r16", &read("raw.r16"), 0.0, 1e-3, false);
    for name in ["array.npy", "floats.r32", "grey.png", "raw.r16"] {
        assert_eq!(read(name).place.unwrap().step, [30.0; 2], "{name}");
    }
}

#[test]
fn a_band_of_several_is_chosen() {
    let names = ["bands.tif", "bands-pixels-p3.tif", "bands-pixels-p2.tif", "bands-apart.tif", "bands-lerc.tif"];
    for name in names {
        let read = |band| import::read(&corpus().join(name), Request::new(1 << 20).with_band(band));
        same(name, &read(Some(1)).unwrap(), 0.0, 0.0, false);
        same(name, &read(Some(2)).unwrap(), 1000.0, 0.0, false);
        assert_eq!(read(Some(3)).unwrap().heights[0], formula(36, 22), "{name}");
        let why = read(None).unwrap_err().to_string();
        assert!(why.contains("it has 3 bands") && why.contains("`band = 1`"), "{why}");
        assert!(read(Some(4)).unwrap_err().to_string().contains("not a band 4"));
        assert!(read(Some(0)).unwrap_err().to_string().contains("not a band 0"));
    }
    let why = import::read(&corpus().join("arc.asc"), Request::new(1 << 20).with_band(Some(2))).unwrap_err();
    assert!(why.to_string().contains("one band, not a band 2"), "{why}");
    same("lossy-lerc.tif", &read("lossy-lerc.tif"), 0.25, 0.5, false);
    // By a recipe key, and after a colon in the path.
    let of_node = world(Node { band: 2, ..node("bands.tif") }, None);
    assert_eq!(of_node.height(30.0, 60.0).unwrap(), 1000.0 + formula(1, 2));
    let ground = PreparedDem::read(&corpus().join("bands-lerc.tif:2"), None, 1 << 20).unwrap();
    assert_eq!(ground.grid[(1, 2)], 1000.0 + formula(1, 2));
}

#[test]
fn what_stands_beside_a_file_tells_its_place() {
    for name in ["placed.asc", "world.png", "notes.png"] {
        let dem = read(name);
        let place = dem.place.unwrap();
        assert_eq!((place.origin, place.step), ([500015.0, 5199985.0], [30.0; 2]), "{name}");
        assert_eq!(keys::epsg(&place.keys.unwrap()), Some(32632), "{name}");
        assert!(dem.notes.is_empty());
    }
    // Without a coordinate system the same numbers are metres; an unknown coordinate system is reported in a note.
    let folder = TestFolder::new("dems-beside").unwrap();
    std::fs::copy(corpus().join("arc.asc"), folder.join("a.asc")).unwrap();
    std::fs::write(folder.join("a.prj"), "LOCAL_CS[\"mine\"]").unwrap();
    let dem = import::read(&folder.join("a.asc"), 1 << 20).unwrap();
    assert_eq!(dem.place.unwrap().keys, None);
    assert!(
        dem.notes[0].contains("its coordinate system is not known") && dem.notes[0].contains("LOCAL_CS"),
        "{:?}",
        dem.notes
    );
}

/// The bits of heights, so that NaN can be compared too.
pub fn bits(heights: &[f32]) -> Vec<u32> {
    heights.iter().map(|height| height.to_bits()).collect()
}

/// The samples of a whole file that belong to a part of it.
fn crop(whole: &Dem, part: Part) -> Vec<f32> {
    let rows = whole.heights.chunks(whole.width).skip(part.from[1]).take(part.size[1]);
    rows.flat_map(|row| &row[part.from[0]..part.from[0] + part.size[0]]).copied().collect()
}

#[test]
fn a_part_of_a_file_has_the_bits_of_the_whole() {
    let mut seen = 0;
    for entry in std::fs::read_dir(corpus()).unwrap() {
        let path = entry.unwrap().path();
        let bands = path.file_stem().unwrap().to_str().unwrap().starts_with("bands").then_some(2);
        let request = Request::new(1 << 20).with_band(bands);
        let Ok(whole) = import::read(&path, request) else { continue };
        if !import::reads_parts(&path) {
            continue;
        }
        seen += 1;
        let [width, height] = [whole.width, whole.height];
        for (from, size) in [
            ([0, 0], [width, height]),
            ([0, 0], [1, 1]),
            ([width - 1, height - 1], [1, 1]),
            ([3, 2], [7, 5]),
            ([width / 2, 0], [width - width / 2, height]),
            ([0, height / 2], [width, 1]),
        ] {
            let part = Part { from, size };
            if !part.is_within([width, height]) {
                continue;
            }
            let read = import::read(&path, request.with_part(Some(part))).unwrap();
            assert_eq!([read.width, read.height], size, "{}", path.display());
            assert_eq!(bits(&read.heights), bits(&crop(&whole, part)), "{} {part:?}", path.display());
        }
        let beyond = request.with_part(Some(Part { from: [1, 0], size: [width, 1] }));
        assert!(import::read(&path, beyond).unwrap_err().to_string().contains("others were asked for"));
        // With holes filled, and on square cells.
        let name = bands.map_or(path.clone(), |band| format!("{}:{band}", path.display()).into());
        let whole = PreparedDem::read(&name, None, 1 << 20).unwrap();
        if whole.georeference.is_none() {
            continue;
        }
        let outline = PreparedDem::outline(&name).unwrap().unwrap();
        assert_eq!((outline.size, &outline.georeference), (whole.size, &whole.georeference), "{}", name.display());
        let all = *whole.grid.window();
        for window in
            [all, Window { width: 3, height: 4, ..all }.at(4, 1), all.at(all.width as i64 - 2, 5), all.grown(9)]
        {
            let inside = window.intersection(&all);
            let Some(part) = PreparedDem::part(&name, &window, 1 << 20).unwrap() else {
                assert!(inside.is_empty(), "{} {window:?}", name.display());
                continue;
            };
            assert_eq!(*part.grid.window(), inside);
            assert_eq!(
                bits(part.grid.data()),
                bits(whole.grid.crop(&inside).unwrap().data()),
                "{} {window:?}",
                name.display()
            );
        }
        assert!(PreparedDem::part(&name, &all.at(9999, 0), 1 << 20).unwrap().is_none());
    }
    assert!(seen > 40, "{seen}");
    assert!(PreparedDem::outline(&corpus().join("arc.asc")).unwrap().is_none());
}

/// A file that counts the bytes that are read.
struct Counted<'a>(Cursor<&'a [u8]>, usize);

impl std::io::Read for Counted<'_> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let count = self.0.read(to)?;
        self.1 += count;
        Ok(count)
    }
}

impl std::io::Seek for Counted<'_> {
    fn seek(&mut self, to: std::io::SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

/// A file of 640 x 500 samples in tiles of 64 with overviews, with holes of one sample and of 40 x 40 samples.
fn with_holes() -> (Vec<u8>, orogen::Grid) {
    let window = Window::new(640, 500, 30.0);
    let hole = |i: usize, j: usize| (400..440).contains(&i) && (300..340).contains(&j) || (i, j) == (70, 80);
    let heights = (0..640 * 500).map(|k| match (k % 640, k / 640) {
        (i, j) if hole(i, j) => f32::NAN,
        (i, j) => formula(i, j) + ((i * 7919 + j * 104_729) % 10_007) as f32 * 1e-3,
    });
    let grid = orogen::Grid::from_data(window, heights.collect()).unwrap();
    let mut bytes = Vec::new();
    writer::write(&mut bytes, &grid, &Layout::of_unit("m").with_tile(Some(64)), Spool::in_memory()).unwrap();
    (bytes, grid)
}

#[test]
fn a_part_of_a_file_takes_its_blocks_alone() {
    let (bytes, grid) = with_holes();
    let taken = |part: Option<Part>| {
        let mut file = Counted(Cursor::new(&bytes), 0);
        // Memory for a tenth of the file.
        let request = Request::new(if part.is_some() { 128 << 10 } else { 8 << 20 }).with_part(part);
        let dem = reader::read(&mut file, "a.tif", request).unwrap();
        (dem, file.1)
    };
    let (_, whole) = taken(None);
    let part = Part { from: [250, 130], size: [100, 60] };
    let (dem, some) = taken(Some(part));
    let inside = Window { width: 100, height: 60, ..*grid.window() }.at(250, 130);
    assert_eq!(dem.heights, grid.crop(&inside).unwrap().data());
    // Three of eighty tiles, and the directories.
    assert!(some < whole / 8, "{some} of {whole} bytes");

    let folder = TestFolder::new("dems-part").unwrap();
    let path = folder.join("a.tif");
    std::fs::write(&path, &bytes).unwrap();
    let whole = PreparedDem::read(&path, None, 8 << 20).unwrap();
    for (x, y, side) in [(60, 75, 30), (405, 310, 20), (430, 290, 30), (0, 0, 10), (600, 460, 100)] {
        let window = Window::new(side, side, 30.0).at(x, y);
        let part = PreparedDem::part(&path, &window, 8 << 20).unwrap().unwrap();
        let inside = window.intersection(grid.window());
        assert_eq!(bits(part.grid.data()), bits(whole.grid.crop(&inside).unwrap().data()), "{window:?}");
    }
    // A small hole is filled only from its surroundings.
    assert!(PreparedDem::part(&path, &Window::new(30, 30, 30.0).at(60, 75), 300 << 10).is_ok());
}

#[test]
fn a_world_of_a_part_has_the_bits_of_the_whole_or_asks_for_it() {
    let (bytes, _) = with_holes();
    let folder = TestFolder::new("dems-part-world").unwrap();
    let path = folder.join("a.tif");
    std::fs::write(&path, &bytes).unwrap();
    let open = |ground: PreparedDem| {
        let mut recipe = Recipe::from_dem(&path, &std::sync::Arc::new(ground));
        recipe.add("soft", Blur { source: "place".into(), radius: 90.0 });
        recipe.add("wide", Blur { source: "place".into(), radius: 3000.0 });
        recipe.output("soft", "soft").output("wide", "wide");
        World::open(recipe).unwrap()
    };
    let held = Window::new(120, 100, 30.0).at(520, 20);
    let part = open(PreparedDem::part(&path, &held, 8 << 20).unwrap().unwrap());
    let whole = open(PreparedDem::read(&path, None, 8 << 20).unwrap());
    assert_eq!(part.full_window(30.0).unwrap(), whole.full_window(30.0).unwrap());
    // At the cell of the file and at other cells, and at the eastern end of the file.
    for (layer, window) in [
        ("height", held.shrunk(4)),
        ("height", Window::new(20, 12, 100.0).at(158, 10)),
        ("height", Window::new(40, 40, 30.0).at(600, 40)),
        ("soft", Window::new(40, 40, 30.0).at(590, 50)),
    ] {
        assert_eq!(part.window(layer, &window).unwrap(), whole.window(layer, &window).unwrap(), "{layer} {window:?}");
    }
    let asks = |error: Error| assert_eq!(error.kind(), ErrorKind::Part, "{error}");
    asks(part.window("height", &held.at(515, 20)).unwrap_err());
    asks(part.window("wide", &Window::new(4, 4, 30.0).at(580, 70)).unwrap_err());
    asks(part.points("height", &[17_000.0], &[1500.0]).unwrap_err());
    let outline = open(PreparedDem::outline(&path).unwrap().unwrap());
    asks(outline.window("height", &held).unwrap_err());
}

#[test]
fn tiles_are_one_place() {
    for name in ["tiles", "tiles.vrt"] {
        let dem = open::read(&corpus().join(name), (1 << 20).into()).unwrap();
        assert_eq!((dem.width, dem.height), (37, 23), "{name}");
        for (k, height) in dem.heights.iter().enumerate() {
            let (i, j) = (k % 37, k / 37);
            match i < 20 || j < 12 {
                true => assert_eq!(*height, formula(i, j) + 0.25, "{name} at ({i}, {j})"),
                // There is no tile here. The virtual raster has no nodata value, so GDAL reads 0.
                false if name == "tiles.vrt" => assert_eq!(*height, 0.0, "({i}, {j})"),
                false => assert!(height.is_nan(), "{name}: no tile lies at ({i}, {j})"),
            }
        }
        let place = dem.place.unwrap();
        assert_eq!((place.origin, keys::epsg(&place.keys.unwrap())), ([500015.0, 5199985.0], Some(32632)), "{name}");
        // The whole file takes 3404 bytes, the largest tile 960.
        assert!(open::read(&corpus().join(name), 4364.into()).is_ok(), "{name}");
        let why = open::read(&corpus().join(name), 4300.into()).unwrap_err().to_string();
        assert!(why.contains("is allowed"), "{name}: {why}");
        let why = open::read(&corpus().join(name), 3000.into()).unwrap_err().to_string();
        assert!(why.contains("37 x 23 samples"), "{name}: {why}");
        assert!(open::is_dem(&corpus().join(name)));
    }
    let folder = TestFolder::new("dems-tiles").unwrap();
    assert!(!open::is_dem(&folder));
    let with = |name: &str| {
        std::fs::copy(corpus().join(name), folder.join(name)).unwrap();
        let read = open::read(&folder, (1 << 20).into());
        std::fs::remove_file(folder.join(name)).unwrap();
        read.unwrap_err().to_string()
    };
    std::fs::copy(corpus().join("f32-strips.tif"), folder.join("a.tif")).unwrap();
    assert!(with("degrees.tif").contains("a.tif and degrees.tif are in different coordinate systems"));
    assert!(with("oblong.tif").contains("have different cell sizes, 30 x 30 and 20 x 30"));
    std::fs::copy(corpus().join("array.npy"), folder.join("b.tif")).unwrap();
    assert!(with("sparse.tif").contains("b.tif: it is not a TIFF"));
}

#[test]
fn files_that_lie_otherwise_are_understood_or_refused() {
    // This file states the position of the sample itself instead of the corner of its pixel; the result is the same.
    assert_eq!(read("point.tif").place.unwrap().origin, [500015.0, 5199985.0]);
    let south_up = read("south-up.tif");
    assert_eq!((south_up.heights[36], south_up.heights[22 * 37]), (formula(36, 22), formula(0, 0)));
    assert_eq!(south_up.place.unwrap().origin, [500015.0, 5200000.0 + 22.5 * 30.0]);
    assert!(refused("turned.tif").contains("its rows are rotated"));
    assert!(refused("webp.tif").contains("it has 3 bands"));
    let webp = Request::new(1 << 20).with_band(Some(1));
    let why = import::read(&corpus().join("webp.tif"), webp).unwrap_err().to_string();
    assert!(why.contains("compressed with WebP"), "{why}");
    assert!(refused("all-nodata.tif").contains("37 x 23 samples are nodata"));
    let sparse = read("sparse.tif");
    assert_eq!((sparse.width, sparse.height, sparse.missing()), (64, 48, 64 * 48 - 256));
    assert_eq!(sparse.heights[20 * 64 + 20], 7.0);
    assert_eq!(read("scaled.tif").heights[3], 100.0 + formula(3, 0) / 2.0);
    let why = import::read(&corpus().join("raw.toml"), 1 << 20).unwrap_err().to_string();
    assert!(why.contains("is not that of a format for heights; supported are .tif"), "{why}");
    let why = import::read(&corpus().join("f32-strips.tif"), 3000).unwrap_err().to_string();
    assert!(why.contains("37 x 23 samples need 3.4 KiB of memory, and 2.9 KiB is allowed"), "{why}");
}

#[test]
fn what_other_files_state_is_read_as_gdal_reads_it() {
    // Feet, stated by the unit of the heights or only by the code of the vertical system.
    let highest = |name: &str| read(name).heights.iter().copied().fold(f32::MIN, f32::max);
    assert_eq!((highest("feet.tif"), highest("feet-by-code.tif")), (213.36, 213.360_43));
    let zero = read("absent.tif");
    assert_eq!((zero.heights[24 * 32 + 24], zero.missing()), (0.0, 0));
    let masked = read("mask.tif");
    assert_eq!(masked.missing(), 256);
    assert!(masked.heights.iter().all(|height| height.is_nan() || *height == 100.0));
    let grads = PreparedDem::read(&corpus().join("grads.tif"), None, 1 << 20).unwrap();
    assert!(grads.notes[0].contains("710.07 x 1000.18 m"), "{:?}", grads.notes);
    let padded = read("padded-keys.tif").place.unwrap().keys.unwrap();
    assert_eq!((padded.directory.len(), keys::epsg(&padded)), (12, Some(32632)));
    assert!(refused("nan.asc").contains("`xllcorner` is NaN"));
    let scaled = open::read(&corpus().join("scaled.vrt"), (1 << 20).into()).unwrap();
    assert_eq!((scaled.heights[0], scaled.heights[63]), (60.0, 98.5));
    for name in ["header.bil", "lines.xyz"] {
        assert_eq!(read(name).heights, [1.0, 2.0, 3.0, 4.0, -5.0, 6.0], "{name}");
    }
}

#[test]
fn netcdf_is_read_as_gdal_writes_it() {
    for (name, of) in [("gdal-classic.nc", "f32-strips.tif"), ("gdal-offset.nc", "degrees.tif")] {
        let (own, other) = (read(name), read(of));
        assert_eq!(bits(&own.heights), bits(&other.heights), "{name}");
        let [own, other] = [own.place.unwrap(), other.place.unwrap()];
        let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < 1e-9);
        assert!(near(own.origin, other.origin) && near(own.step, other.step), "{name}: {own:?}");
        assert_eq!(own.keys.as_ref().map(keys::epsg), other.keys.as_ref().map(keys::epsg), "{name}");
    }
    for name in ["gmt-gridline.nc", "gmt-pixel.grd"] {
        assert_eq!(read(name).heights, read("lines.xyz").heights, "{name}");
    }
    assert!(refused("netcdf4.nc").contains("convert it, for example with gdal_translate netcdf4.nc out.tif"));
    let why = refused("records.nc");
    assert!(why.contains("it has 4 bands; choose one with `band = 1` in the node, or with FILE:1"), "{why}");
}

#[test]
fn degrees_and_oblong_cells_become_square_metres() {
    let ground = |name: &str| PreparedDem::read(&corpus().join(name), None, 1 << 20).unwrap();
    let degrees = ground("degrees.tif");
    // 3 arc seconds at 46 degrees north: 64.6 by 92.6 m.
    let window = degrees.grid.window();
    assert!((window.cell - 64.56).abs() < 0.05 && window.width == 37 && window.height == 32, "{window:?}");
    assert!(
        degrees.notes[0].contains("cells of 64.56 x 92.63 m, were resampled to squares of 64.56 m"),
        "{:?}",
        degrees.notes
    );
    let oblong = ground("oblong.tif");
    assert_eq!((oblong.grid.window().cell, oblong.grid.width(), oblong.grid.height()), (20.0, 37, 34));
    // Rows of 30 m: every third row of 20 m is a row of the file.
    assert_eq!(oblong.grid[(9, 3)], formula(9, 2));
    assert_eq!(oblong.georeference.unwrap().at(40.0, 60.0), [500010.0 + 40.0, 5199985.0 - 60.0]);
}

fn world(dem: Node, size: Option<[f64; 2]>) -> World {
    let mut recipe = Recipe::new(WorldSpec::default().with_size(size).with_cell(30.0));
    recipe.add("place", dem).output("height", "place");
    World::with_options(recipe, Options { threads: Some(1), memory: Budget::of(64 << 20), ..Options::default() })
        .unwrap()
}

fn node(name: &str) -> Node {
    Node { path: corpus().join(name).to_str().unwrap().into(), ..Node::default() }
}

#[test]
fn a_dem_is_a_field() {
    let file = world(Node { at: [60.0, -30.0], scale: 2.0, offset: 5.0, ..node("f32-strips.tif") }, None);
    let grid = file.window("height", &Window::new(20, 10, 30.0)).unwrap();
    // Column 2 is the file's column 0, and row 0 is its row 1. The file's border is repeated beyond it.
    assert_eq!(grid[(6, 4)], 2.0 * (formula(4, 5) + 0.25) + 5.0);
    assert_eq!(grid[(0, 4)], 2.0 * (formula(0, 5) + 0.25) + 5.0);
    let faded = world(Node { fade: 100.0, outside: -50.0, ..node("f32-strips.tif") }, None);
    assert_eq!(faded.height(-100.0, 30.0).unwrap(), -50.0);
    let half = faded.height(-50.0, 30.0).unwrap();
    assert!((half - (formula(0, 1) + 0.25 - 50.0) / 2.0).abs() < 1e-3, "{half}");
    let inside = world(Node { fade: 100.0, shows: DemShows::Inside, ..node("f32-strips.tif") }, None);
    let at = |x: f64| inside.height(x, 30.0).unwrap();
    assert_eq!((at(5.0), at(-50.0), at(-100.0)), (1.0, 0.5, 0.0));
}

#[test]
fn what_is_in_the_file_is_the_key_and_not_its_name() {
    let folder = TestFolder::new("dems").unwrap();
    let (a, b) = (folder.join("a.tif"), folder.join("b.tif"));
    std::fs::copy(corpus().join("f32-strips.tif"), &a).unwrap();
    std::fs::copy(corpus().join("f32-tiles-deflate-p3.tif"), &b).unwrap();
    let text = |name: &str| {
        format!(
            "orogen = 1\n[world]\nsize = 600\ncell = 30\n[nodes.a]\nop = \"dem\"\npath = \"{name}\"\n[outputs]\nheight = \"a\"\n"
        )
    };
    let key = |name: &str| {
        let recipe = folder.join("recipe.toml");
        std::fs::write(&recipe, text(name)).unwrap();
        World::open(Recipe::read(&recipe).unwrap()).unwrap().key("height").unwrap()
    };
    // The same heights, packed in two ways.
    assert_eq!(key("a.tif"), key("b.tif"));
    std::fs::copy(corpus().join("point.tif"), &b).unwrap();
    assert_ne!(key("a.tif"), key("b.tif"));
    // A recipe written to another folder still finds its file.
    let written = Recipe::read(&folder.join("recipe.toml")).unwrap().to_toml();
    assert!(World::open(Recipe::parse(&written, "elsewhere").unwrap()).is_ok(), "{written}");
    let error = World::open(Recipe::parse(&text("gone.tif"), "t").unwrap()).err().unwrap().to_string();
    assert!(error.contains("node `a`: cannot read gone.tif: no such file"), "{error}");
    let error = Recipe::parse(&text(""), "t").unwrap_err().to_string();
    assert!(error.contains("`path` is empty"), "{error}");
}

#[test]
fn files_count_in_the_memory_of_a_plan() {
    let world = world(node("f32-strips.tif"), Some([1080.0, 660.0]));
    let window = Window::new(8, 8, 30.0);
    let plan = world.plan(&["height"], &window).unwrap();
    let bare =
        World::open(Recipe::parse("orogen = 1\n[nodes.a]\nop = \"fbm\"\n[outputs]\nheight = \"a\"\n", "t").unwrap())
            .unwrap();
    let other = bare.plan(&["height"], &window).unwrap();
    assert_eq!(world.recipe().held(), 37 * 23 * 4);
    assert!(
        world.memory_of(&plan).unwrap() >= 37 * 23 * 4
            && bare.recipe().held() == 0
            && bare.memory_of(&other).unwrap() > 0
    );
}

#[test]
fn what_a_file_says_of_its_map_is_kept_on_the_way_out() {
    for name in ["f32-strips.tif", "point.tif", "degrees.tif", "arc.asc"] {
        let mut recipe = Recipe::new(WorldSpec::default().with_cell(30.0));
        // The corner of the file is two cells east and one cell north of the origin.
        recipe.add("place", Node { at: [60.0, -30.0], ..node(name) }).output("height", "place");
        let world = World::open(recipe).unwrap();
        let grid = world.window("height", &Window::new(20, 10, 30.0).at(2, 3)).unwrap();
        let map = world.recipe().georeference().unwrap();
        let mut bytes = Vec::new();
        let options = Layout::default().with_map(Some(map.clone()));
        writer::write(&mut bytes, &grid, &options, Spool::in_memory()).unwrap();
        let back = reader::read(&mut Cursor::new(&bytes), name, 1 << 20).unwrap();
        assert_eq!(back.heights, grid.data());
        let (place, file) = (back.place.unwrap(), read(name).place.unwrap());
        assert_eq!(place.unit, file.unit, "{name}");
        let expect = map.at(60.0, 90.0);
        assert!((0..2).all(|k| (place.origin[k] - expect[k]).abs() < 1e-9), "{name}: {place:?}");
        if name != "degrees.tif" {
            assert_eq!((place.origin, place.step), ([500015.0, 5199985.0 - 120.0], [30.0; 2]), "{name}");
        }
        if let Some(keys) = file.keys {
            let code = |keys: &GeoKeys| {
                keys.directory.chunks_exact(4).find(|key| [2048, 3072].contains(&key[0])).map(|key| key[3])
            };
            let kept = place.keys.unwrap();
            assert_eq!((code(&kept), &kept.text), (code(&keys), &keys.text), "{name}");
            assert!(code(&keys).is_some() && usize::from(kept.directory[3]) * 4 + 4 == kept.directory.len());
        }
    }
}
