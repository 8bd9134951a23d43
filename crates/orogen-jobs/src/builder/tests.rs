//! Builds that are interrupted, damaged, repeated and rejected. The result always equals the result of an uninterrupted
//! build.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::journal::{Journal, JournalState};
use super::run::{Build, Report, Start};
use super::spec::{BuildSpec, Form, Samples};
use orogen_engine::budget::Budget;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::session::Options;
use orogen_engine::world::World;
use orogen_grid::error::ErrorKind;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::file::{Existing, Output, OutputPolicy};
use orogen_io::format::encoding::Encoding;
use orogen_io::format::geotiff::{options, writer};
use orogen_io::format::import;
use orogen_io::format::sidecar::Sidecar;
use orogen_io::spool::Spool;
use orogen_io::test_folder::TestFolder;

/// A bounded world with a filter and a solver, and an unbounded one.
const BOUNDED: &str = r#"
orogen = 1
[world]
seed = 3
size = [1000, 800]
cell = 5
[nodes.noise]
op = "fbm"
wavelength = 300
octaves = 4
[nodes.soft]
op = "blur"
source = "noise"
radius = 20
[nodes.land]
op = "normalise"
source = "soft"
low = -50
high = 200
[outputs]
height = "land"
rough = "noise"
"#;

mod parts;

const FORMS: [Form; 9] = Form::ALL;

fn world(memory: Option<u64>, threads: usize) -> World {
    let recipe = Recipe::parse(BOUNDED, "test").unwrap();
    World::with_options(recipe, Options { threads: Some(threads), memory: Budget::of(memory), ..Options::default() })
        .unwrap()
}

/// Odd sizes, which are not multiples of the tiles and overviews.
fn spec(form: Form) -> BuildSpec {
    let tile = match form {
        Form::Cog => 32,
        Form::Xyz(_) | Form::Pmtiles(_) => 256,
        _ => 40,
    };
    let window = match form {
        // A cell size for which the window covers several tiles of the map.
        Form::Xyz(_) | Form::Pmtiles(_) => Window::new(300, 257, 3.0).at(3, 10),
        _ => Window::new(101, 77, 5.0).at(7, 11),
    };
    let layers = if form.holds_many() { vec!["height".into(), "rough".into()] } else { vec!["height".into()] };
    BuildSpec { form, window, tile: Some(tile), layers, part: None }
}

/// A folder for the result of a build.
struct Folder(TestFolder);

impl Folder {
    fn new() -> Folder {
        Folder(TestFolder::new("build").unwrap())
    }

    fn out(&self) -> PathBuf {
        self.0.join("out")
    }
}

/// All files below a path, or the file itself, by relative path.
fn files(path: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut left = vec![path.to_path_buf()];
    while let Some(path) = left.pop() {
        match fs::read_dir(&path) {
            Ok(entries) => left.extend(entries.map(|entry| entry.unwrap().path())),
            Err(_) if path.is_file() => {
                found.insert(path.clone(), fs::read(&path).unwrap());
            }
            Err(_) => {}
        }
    }
    found
}

/// All files after a build, below the folder of the build.
fn result(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    files(out).into_iter().map(|(path, bytes)| (path.strip_prefix(out).unwrap().to_path_buf(), bytes)).collect()
}

fn output(out: &Path) -> Output {
    OutputPolicy::new(Existing::Replace).output(out).unwrap()
}

fn run(world: &World, spec: &BuildSpec, out: &Path, start: Start) -> Report {
    Build::new(world, spec, &output(out)).unwrap().run(start, &Progress::none()).unwrap()
}

/// An uninterrupted build.
fn undisturbed(form: Form) -> (BTreeMap<PathBuf, Vec<u8>>, Report) {
    let folder = Folder::new();
    let report = run(&world(None, 2), &spec(form), &folder.out(), Start::Fresh);
    let beside = files(&folder.0.join("out.build"));
    let names: Vec<&str> = beside.keys().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["journal", "lock"], "{form:?}");
    (result(&folder.out()), report)
}

#[test]
fn the_bytes_depend_neither_on_memory_nor_on_threads() {
    for form in FORMS {
        let (expect, report) = undisturbed(form);
        assert!(report.made > 3 && report.kept == 0, "{form:?} {report:?}");
        assert_eq!(report.bytes, expect.values().map(|bytes| bytes.len() as u64).sum::<u64>(), "{form:?}");
        let spec = spec(form);
        // A memory limit so small that each tile is made alone.
        let folder = Folder::new();
        let fits = |memory: &u64| Build::new(&world(Some(*memory), 1), &spec, &output(&folder.out())).is_ok();
        let smaller = |memory: &u64| Some(memory / 4 * 3);
        let least = std::iter::successors(Some(1 << 30), smaller).take_while(fits).last();
        assert!(least.is_some());
        for (memory, threads) in [(least, 1), (None, 5)] {
            let folder = Folder::new();
            run(&world(memory, threads), &spec, &folder.out(), Start::Fresh);
            assert!(result(&folder.out()) == expect, "{form:?} {memory:?} {threads}");
        }
    }
}

#[test]
fn too_little_memory_is_refused_before_anything_is_written() {
    let folder = Folder::new();
    let world = world(Some(10_000), 1);
    let error = Build::new(&world, &spec(Form::Zarr), &output(&folder.out())).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::Memory);
    assert!(
        error.to_string().contains("and 9.8 KiB is allowed; use smaller tiles, or raise the memory limit"),
        "{error}"
    );
    assert_eq!(files(&folder.0), BTreeMap::new());
}

#[test]
fn a_geotiff_is_the_one_that_export_writes() {
    let world = world(None, 2);
    for (n, (width, height)) in
        [(1, 1), (16, 16), (17, 16), (33, 100), (65, 31), (101, 77), (48, 97), (129, 64)].into_iter().enumerate()
    {
        for tile in [16, 32] {
            let window = Window::new(width, height, 5.0).at(n as i64, 3);
            let folder = Folder::new();
            let spec =
                BuildSpec { form: Form::Cog, window, tile: Some(tile), layers: vec!["height".into()], part: None };
            run(&world, &spec, &folder.out(), Start::Fresh);
            let mut expect = Vec::new();
            let options = options::Options::of_unit("m").with_tile(Some(tile));
            writer::write(&mut expect, &world.window("height", &window).unwrap(), &options, Spool::in_memory())
                .unwrap();
            assert!(fs::read(folder.out()).unwrap() == expect, "{width} x {height} in {tile}");
        }
    }
}

/// Simulates a disk that is full after `files` files: the next file is truncated.
fn fill_after(build: &mut Build, files: usize) {
    let left = AtomicUsize::new(files);
    build.put = Box::new(move |path, bytes| {
        let full = left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err();
        fs::write(path, if full { &bytes[..bytes.len() / 2] } else { bytes })?;
        if full { Err(io::ErrorKind::StorageFull.into()) } else { Ok(()) }
    });
}

#[test]
fn interrupted_anywhere_it_ends_with_the_same_bytes() {
    for form in FORMS {
        let (expect, whole) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        let folder = Folder::new();
        // The disk is full several times, each time a little later.
        let mut kept = 0;
        for files in (0..).step_by(3) {
            let mut build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
            fill_after(&mut build, files);
            match build.run(Start::Resume, &Progress::none()) {
                Ok(report) => {
                    assert_eq!(report.made + report.kept, whole.made, "{form:?}");
                    assert!(report.kept >= kept);
                    break;
                }
                Err(error) => assert!(error.to_string().ends_with(": no storage space"), "{error}"),
            }
            let left = fs::read_to_string(folder.0.join("out.build/journal")).unwrap();
            let entered = left.lines().filter(|line| line.starts_with("{\"tile\"")).count();
            // Tiles in the journal are not made again.
            assert!(entered >= kept, "{form:?}: {entered} after {kept}");
            kept = entered;
        }
        assert!(result(&folder.out()) == expect, "{form:?}");
        assert_eq!(files(&folder.0.join("out.build")).len(), 2, "{form:?}: only journal and lock are left");
    }
}

#[test]
fn cancelled_it_goes_on() {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    for form in FORMS {
        let (expect, whole) = undisturbed(form);
        let (world, spec) = (world(None, 1), spec(form));
        // In at least one of these cases some tiles are made and others are not.
        let mut amid = false;
        for share_at_stop in [0.5, 0.7, 0.8, 0.9, 0.95, 0.98] {
            let folder = Folder::new();
            let build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
            let flag = Arc::new(AtomicBool::new(false));
            let stop = Arc::clone(&flag);
            let progress =
                Progress::new(move |share| stop.store(share >= share_at_stop, Ordering::Relaxed)).stopped_by(flag);
            let Err(error) = build.run(Start::Fresh, &progress) else { continue };
            assert_eq!(error.kind(), ErrorKind::Cancelled, "{error}");
            let report = build.run(Start::Resume, &Progress::none()).unwrap();
            assert_eq!(report.made + report.kept, whole.made, "{form:?} {report:?}");
            assert!(result(&folder.out()) == expect, "{form:?}");
            amid |= report.made > 0 && report.kept > 0;
        }
        assert!(amid, "{form:?}");
    }
}

#[test]
fn what_is_damaged_is_made_again() {
    for form in FORMS {
        let (expect, _) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        let folder = Folder::new();
        run(&world, &spec, &folder.out(), Start::Fresh);
        for (n, path) in expect.keys().enumerate() {
            let path = if path.as_os_str().is_empty() { folder.out() } else { folder.out().join(path) };
            let whole = fs::read(&path).unwrap();
            let mut flipped = whole.clone();
            flipped[whole.len() / 2] ^= 4;
            match n % 4 {
                0 => fs::write(&path, flipped).unwrap(),
                1 => fs::write(&path, &whole[..whole.len() - 1]).unwrap(),
                2 => fs::write(&path, []).unwrap(),
                _ => fs::remove_file(&path).unwrap(),
            }
            // One by one, then all remaining tiles at once.
            if n < 6 || n + 1 == expect.len() {
                run(&world, &spec, &folder.out(), Start::Resume);
                assert!(result(&folder.out()) == expect, "{form:?}: {}", path.display());
            }
        }
        let report = run(&world, &spec, &folder.out(), Start::Resume);
        assert_eq!(report.made, 0, "{form:?}");
    }
}

#[test]
fn what_is_damaged_on_the_way_is_made_again() {
    for form in FORMS {
        let (expect, whole) = undisturbed(form);
        let (world, spec) = (world(None, 2), spec(form));
        let folder = Folder::new();
        let mut build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
        fill_after(&mut build, 4);
        assert!(build.run(Start::Fresh, &Progress::none()).is_err());
        for (n, (path, mut bytes)) in files(&folder.0).into_iter().enumerate() {
            if path.ends_with("journal") || path.ends_with("lock") {
                continue;
            }
            match n % 3 {
                0 => bytes[0] ^= 1,
                1 => bytes.truncate(1),
                _ => bytes.clear(),
            }
            fs::write(path, bytes).unwrap();
        }
        let report = run(&world, &spec, &folder.out(), Start::Resume);
        assert_eq!((report.made, report.kept), (whole.made, 0), "{form:?}");
        assert!(result(&folder.out()) == expect, "{form:?}");
    }
}

#[test]
fn what_is_there_is_not_overwritten() {
    let folder = Folder::new();
    let (world, spec) = (world(None, 2), spec(Form::Zarr));
    let build = |spec: &BuildSpec, start| {
        let done = Build::new(&world, spec, &output(&folder.out())).unwrap().run(start, &Progress::none());
        done.map_err(|error| error.to_string().replace(&folder.0.display().to_string(), "~"))
    };
    build(&spec, Start::Fresh).unwrap();
    let expect = result(&folder.out());
    assert_eq!(
        build(&spec, Start::Fresh).unwrap_err(),
        "~/out is already complete; use --resume to check it, or --force to build it again"
    );
    let other = BuildSpec { tile: Some(64), ..spec.clone() };
    assert_eq!(
        build(&other, Start::Resume).unwrap_err(),
        "~/out cannot be resumed: it was started with tiles of 40, not 64; use the same arguments, or start again with --force and without --resume"
    );
    assert_eq!(
        build(&other, Start::Fresh).unwrap_err(),
        "~/out is another build: it was started with tiles of 40, not 64; choose another output, or replace it with --force"
    );
    assert!(result(&folder.out()) == expect);
    build(&other, Start::Force).unwrap();
    assert!(result(&folder.out()) != expect);
    build(&spec, Start::Force).unwrap();
    assert!(result(&folder.out()) == expect, "and nothing is left of the other");
    fs::write(folder.0.join("out.build/journal"), "nonsense").unwrap();
    assert!(build(&spec, Start::Resume).unwrap_err().contains("is damaged, so the build cannot be resumed"));
    fs::remove_file(folder.0.join("out.build/journal")).unwrap();
    assert_eq!(build(&spec, Start::Fresh).unwrap_err(), "~/out already exists; use --force to replace it");
    assert!(
        build(&spec, Start::Resume)
            .unwrap_err()
            .contains("is missing, so it cannot be resumed; use --force, without --resume, to build it again")
    );
    let fresh = build(&other, Start::Fresh);
    assert_eq!(fresh.unwrap_err(), "~/out already exists; use --force to replace it");
    // `--force` does not remove files that no build made.
    fs::remove_dir_all(folder.out()).unwrap();
    fs::create_dir_all(folder.out()).unwrap();
    fs::write(folder.out().join("diary"), "mine").unwrap();
    for start in [Start::Fresh, Start::Resume, Start::Force] {
        assert_eq!(
            build(&spec, start).unwrap_err(),
            "~/out holds files that were not made by a build, which --force does not remove; empty the folder, or choose another output"
        );
    }
    assert_eq!(result(&folder.out()).len(), 1);
}

#[test]
fn a_begun_build_is_not_begun_again() {
    let folder = Folder::new();
    let (world, spec) = (world(None, 2), spec(Form::Cog));
    let mut build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
    fill_after(&mut build, 5);
    assert!(build.run(Start::Fresh, &Progress::none()).is_err());
    let error =
        Build::new(&world, &spec, &output(&folder.out())).unwrap().run(Start::Fresh, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("is an unfinished build; use --resume to continue it"), "{error}");
    let other = BuildSpec { window: spec.window.at(0, 0), ..spec };
    let error =
        Build::new(&world, &other, &output(&folder.out())).unwrap().run(Start::Resume, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("it was started over 101 x 77 samples at (7, 11)"), "{error}");
}

#[test]
fn only_one_builds_at_a_time() {
    let folder = Folder::new();
    let (world, spec) = (world(None, 1), spec(Form::Xyz(Encoding::Terrarium)));
    let build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
    let work_dir = super::work_dir::WorkDir::new(&output(&folder.out()), false).unwrap();
    let held = work_dir.hold().unwrap();
    for start in [Start::Fresh, Start::Resume, Start::Force] {
        let error = build.run(start, &Progress::none()).unwrap_err();
        assert!(error.to_string().contains("another build of"), "{error}");
    }
    drop(held);
    build.run(Start::Fresh, &Progress::none()).unwrap();
}

/// The heights in a tile.
fn tile(out: &Path, zoom: u32, [column, row]: [u32; 2]) -> Vec<f32> {
    let bytes = fs::read(out.join(format!("{zoom}/{column}/{row}.png"))).unwrap();
    let told = Sidecar { encoding: Some("terrarium".into()), cell: Some(1.0), ..Sidecar::default() };
    import::parse(&mut io::Cursor::new(bytes), "tile", "png", Some(told), 1 << 22).unwrap().heights
}

/// The tile of a web map and the pixel in it at a longitude and latitude, by the formula of OpenStreetMap's wiki.
fn slippy(longitude: f64, latitude: f64, zoom: u32) -> [f64; 2] {
    let (count, latitude) = (f64::from(1 << zoom), latitude.to_radians());
    let down = libm::log(libm::tan(latitude) + 1.0 / libm::cos(latitude)) / std::f64::consts::PI;
    [(longitude + 180.0) / 360.0 * count, (1.0 - down) / 2.0 * count]
}

#[test]
fn a_world_on_the_web_map_is_in_its_real_tiles() {
    const RADIUS: f64 = 6_378_137.0;
    const ZOOM: u32 = 15;
    let pixel = super::tile_grid::cell_near(5.0, 256, None);
    // Vienna, with pixels between the samples and on them.
    let first = |at: f64| ((at / pixel).floor() + 0.5) * pixel;
    for (origin, is_exact) in [([1_822_000.0, 6_141_000.0], false), ([first(1_822_000.0), first(6_141_000.0)], true)] {
        let map = format!("cell = 5\ncrs = \"EPSG:3857\"\norigin = [{:?}, {:?}]", origin[0], origin[1]);
        let world = World::open(Recipe::parse(&BOUNDED.replace("cell = 5", &map), "test").unwrap()).unwrap();
        let folder = Folder::new();
        let spec = BuildSpec::new(Form::Xyz(Encoding::Terrarium), Window::new(180, 150, pixel).at(10, 5));
        run(&world, &spec, &folder.out(), Start::Fresh);
        let tiles: serde_json::Value =
            serde_json::from_slice(&fs::read(folder.out().join("tiles.json")).unwrap()).unwrap();
        assert_eq!((&tiles["maxzoom"], &tiles["map_metres_per_metre"]), (&ZOOM.into(), &1.0.into()));
        let samples = world.window("height", &Window::new(200, 160, pixel)).unwrap();
        for [x, y] in [[100.0, 80.0], [500.0, 430.0], [700.0, 600.0]] {
            let [east, north] = [origin[0] + x, origin[1] - y];
            let longitude = (east / RADIUS).to_degrees();
            let latitude = libm::atan(libm::sinh(north / RADIUS)).to_degrees();
            let at = slippy(longitude, latitude, ZOOM);
            let number = at.map(|at| at as u32);
            let [i, j] = at.map(|at| (at.fract() * 256.0) as usize);
            let height = tile(&folder.out(), ZOOM, number)[j * 256 + i];
            // The middle of that pixel in the world.
            let middle = |k: usize, inside: usize| (f64::from(number[k]) * 256.0 + inside as f64 + 0.5) * pixel;
            let half = std::f64::consts::PI * RADIUS;
            let (x, y) = (middle(0, i) - half - origin[0], middle(1, j) - half + origin[1]);
            let expect = world.height(x, y).unwrap();
            assert!((height - expect).abs() < 0.05, "{height} {expect}");
            if is_exact {
                let sample = samples[((x / pixel).round() as usize, (y / pixel).round() as usize)];
                assert!((height - sample).abs() <= 0.5 / 256.0, "{height} {sample}");
            }
        }
        let bounds = tiles["bounds"].as_array().unwrap().iter().map(|at| at.as_f64().unwrap()).collect::<Vec<_>>();
        let west = (origin[0] + 10.0 * pixel) / RADIUS;
        assert!((bounds[0] - west.to_degrees()).abs() < 2.0 * pixel / 111_000.0, "{bounds:?}");
    }
    let far = BOUNDED.replace("cell = 5", "cell = 5\ncrs = \"EPSG:3857\"\norigin = [20037400, 0]");
    let world = World::open(Recipe::parse(&far, "test").unwrap()).unwrap();
    let spec = BuildSpec::new(Form::Xyz(Encoding::Terrarium), Window::new(100, 50, 5.0));
    let error = Build::new(&world, &spec, &output(&Folder::new().out())).err().unwrap().to_string();
    assert!(error.contains("is not on the map of EPSG:3857"), "{error}");
}

#[test]
fn impossible_orders_are_sentences() {
    let world = world(None, 1);
    let window = Window::new(50, 50, 5.0);
    let layers = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<String>>();
    let check = |form, window, tile, names: &[&str], expect: &str| {
        let spec = BuildSpec { form, window, tile, layers: layers(names), part: None };
        let error = Build::new(&world, &spec, &output(&Folder::new().out())).err().unwrap().to_string();
        assert!(error.contains(expect), "{error} / {expect}");
    };
    check(Form::Zarr, window, None, &[], "no layer was chosen");
    check(Form::Zarr, window, None, &["height", "height"], "listed twice");
    check(Form::Zarr, window, None, &["hieght"], "did you mean `height`?");
    check(Form::Cog, window, None, &["height", "rough"], "a GeoTIFF holds one layer, and 2 were chosen");
    check(Form::Xyz(Encoding::Terrarium), window, None, &["height", "rough"], "an XYZ tree holds one layer");
    check(Form::Cog, window, Some(100), &["height"], "a multiple of 16, not 100");
    check(Form::Xyz(Encoding::Terrarium), window, Some(100), &["height"], "256 or 512 samples per side, not 100");
    check(Form::Tiles(Samples::R32), window, Some(1), &["height"], "2 to 16384 samples per side, not 1");
    check(Form::Zarr, window, Some(10_000), &["height"], "1 to 8192 samples per side");
    check(Form::Zarr, Window::new(500, 5, 5.0), None, &["height"], "is not inside the world");
    let folder = Folder::new();
    fs::write(folder.out(), "a file").unwrap();
    let error = Build::new(&world, &spec(Form::Zarr), &output(&folder.out())).err().unwrap().to_string();
    assert!(error.contains("it is a file, and a folder is needed"), "{error}");
}

/// A journal with valid checksums whose sums do not fit in 64 bits.
#[test]
fn a_journal_of_impossible_lengths_is_no_journal_of_this_result() {
    let (expect, _) = undisturbed(Form::Zarr);
    let (world, spec, folder) = (world(None, 2), spec(Form::Zarr), Folder::new());
    run(&world, &spec, &folder.out(), Start::Fresh);
    let path = folder.0.join("out.build").join("journal");
    let mut state = JournalState::read(&path).unwrap().unwrap();
    for digest in state.records.values_mut().flat_map(|record| &mut record.digests) {
        digest.length = u64::MAX;
    }
    Journal::write(&path, &path.with_extension("new"), &state).unwrap();
    let build = Build::new(&world, &spec, &output(&folder.out())).unwrap();
    assert_eq!(build.disk().1, u64::MAX);
    let report = build.run(Start::Resume, &Progress::none()).unwrap();
    assert_eq!((report.kept, report.made), (0, build.tiles().0));
    assert!(result(&folder.out()) == expect);
}
