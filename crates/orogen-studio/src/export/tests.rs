//! Compares files of each kind with the jobs of the library and with the command lines.

use std::path::Path;

use orogen::export::registry;
use orogen::export::targets::list;
use orogen::io::file::OutputPolicy;
use orogen::io::palette::named;
use orogen::io::test_folder::TestFolder;
use orogen::jobs::{MapColors, MapJob, RenderJob, SheetFormat};
use orogen::output::render::View;
use orogen::output::render::scene::Colors;
use orogen::output::sheet::{GridStep, Resolution, Shading};
use orogen::recipe::Recipe;
use orogen::tilemap::TilemapJob;
use orogen::tilemap::art::set::SETS;
use orogen::world::HEIGHT;
use orogen::{ErrorKind, Progress, Session, presets};

use super::given::Given;
use super::kind::Kind;
use super::request::Export;
use crate::preview::region::Region;

fn recipe() -> Recipe {
    presets::find("classic").unwrap().recipe().unwrap()
}

fn session() -> Session {
    Session::new(orogen::Options::default()).unwrap()
}

fn export(kind: Kind, folder: &Path) -> Export {
    let mut export = Export::new(Region::Whole, "classic", false, folder).unwrap();
    export.set_kind(kind);
    export
}

/// Sets options.
fn give(given: &mut Given, options: &[(&'static str, &str)]) {
    given.extend(options.iter().map(|(name, text)| (*name, text.to_string())));
}

fn run(export: &Export) -> String {
    export.run(&session(), recipe(), None, &Progress::none()).unwrap()
}

fn line(export: &Export) -> String {
    export.command_line("classic", &recipe().world).to_string()
}

#[test]
fn a_layer_has_the_samples_of_the_world() {
    let folder = TestFolder::new("studio-export").unwrap();
    let mut export = export(Kind::Layer, &folder);
    export.layer.set_format(registry::named("r32").unwrap(), None);
    export.layer.size = Some(64);
    export.set_extension();
    run(&export);
    let bytes = std::fs::read(folder.join("classic.r32")).unwrap();
    let world = session().open(recipe()).unwrap();
    let grid = world.window(HEIGHT, &world.window_fitting(64).unwrap()).unwrap();
    let expect: Vec<u8> = grid.data().iter().flat_map(|height| height.to_le_bytes()).collect();
    assert!(bytes == expect);
}

#[test]
fn an_engine_gets_what_it_imports_and_says_how() {
    let folder = TestFolder::new("studio-engine").unwrap();
    let mut export = export(Kind::Engine, &folder);
    export.engine.set_target(list::named("unity").unwrap());
    export.engine.side = Some(65);
    export.engine.tiles = [2, 2];
    export.set_extension();
    let words = run(&export);
    assert!(words.contains("Heightmap Resolution 65 x 65") && words.starts_with("129 x 129 samples"), "{words}");
    assert_eq!(std::fs::metadata(folder.join("classic_1_1.r16")).unwrap().len(), 2 * 65 * 65);
    // Weights are exported as pictures.
    export.engine.layer = "slope".into();
    export.set_extension();
    assert!(
        line(&export).ends_with("classic.png --target unity --layer slope --size 65 --tiles 2x2"),
        "{}",
        line(&export)
    );
    export.set_path(&folder.join("a.r16").to_string_lossy());
    let error = export.run(&session(), recipe(), None, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("is a .png"), "{error}");
    // A part becomes a square with a size that the engine supports.
    export.region = Region::Square { center: [100.0, 4000.0], side: 1500.0 };
    export.engine.layer = HEIGHT.into();
    (export.engine.tiles, export.engine.side) = ([1, 1], Some(33));
    let words = run(&export);
    assert!(words.starts_with("33 x 33 samples of 46.875 m"), "{words}");
}

#[test]
fn a_map_is_that_of_the_job() {
    let folder = TestFolder::new("studio-map").unwrap();
    let mut export = export(Kind::Map, &folder);
    export.map.samples = Some(80);
    let names = folder.join("places.csv");
    std::fs::write(&names, "x,y,name\n200,-300,Ford\n").unwrap();
    let options = [
        ("color", "surfaces"),
        ("shade", "swiss"),
        ("levels", "300, 450.5"),
        ("grid", "auto"),
        ("lake-area", "50000"),
        ("names", names.to_str().unwrap()),
        ("scale", "100000"),
        ("size", "300"),
        ("page-color", "#faf0dc"),
        ("no-rivers", ""),
    ];
    give(&mut export.map.options, &options);
    let words = run(&export);
    assert!(words.starts_with("surfaces, ") && words.contains("80 x 80 samples"), "{words}");
    let mut job = MapJob::new(SheetFormat::Png).with_colors(MapColors::Surfaces).with_title("classic");
    job.resolution = Some(Resolution::Longer(300));
    job.shading = Shading::Swiss;
    job.parts.rivers = false;
    job.lake_area = Some(5e4);
    job.map_scale = Some(1e5);
    job.levels = Some(vec![300.0, 450.5]);
    job.grid = Some(GridStep::Automatic);
    job.page_colors.page = [250, 240, 220];
    let mut recipe = recipe();
    job.names_file = Some(names.clone());
    job.prepare(&mut recipe).unwrap();
    let world = session().open(recipe).unwrap();
    let job = job.with_window(world.window_fitting(80).unwrap());
    let output = OutputPolicy::default().output(folder.join("job.png")).unwrap();
    job.to_file(&world, &output, &Progress::none()).unwrap();
    assert!(std::fs::read(export.path()).unwrap() == std::fs::read(output.path()).unwrap());
    let cell = 0.0125 * super::tests::recipe().world.size.unwrap()[0];
    let end = format!(
        "classic-map.png --color surfaces --shade swiss --levels '300, 450.5' --grid --lake-area 50000 --names {} --scale 100000 --size 300 --page-color '#faf0dc' --no-rivers --cell {cell}",
        names.display()
    );
    assert!(line(&export).ends_with(&end), "{}", line(&export));
    // The extension selects the kind of file.
    export.set_path(&folder.join("a.pdf").to_string_lossy());
    assert_eq!(export.map.format, SheetFormat::Pdf);
    // Options that no longer apply are omitted: surfaces have no palette.
    give(&mut export.map.options, &[("palette", "swiss"), ("range", "3,1")]);
    assert!(!line(&export).contains("--range"), "{}", line(&export));
    export.map.options.remove("color");
    let error = export.run(&session(), super::tests::recipe(), None, &Progress::none()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Request);
}

#[test]
fn a_render_is_that_of_the_job() {
    let folder = TestFolder::new("studio-render").unwrap();
    let mut export = export(Kind::Render, &folder);
    export.render.samples = Some(48);
    let options = [
        ("size", "64x40"),
        ("camera", "120.5,40"),
        ("samples", "1"),
        ("color", "map"),
        ("palette", "swiss"),
        ("nearest-color", ""),
        ("range", "0,900"),
        ("color-bar", ""),
    ];
    give(&mut export.render.options, &options);
    let words = run(&export);
    assert!(words.starts_with("64 x 40 pixels, of 48 x 48 samples"), "{words}");
    let mut job = RenderJob::default();
    job.size = [64, 40];
    job.view = View::Around { azimuth: 120.5, elevation: 40.0, distance: None };
    job.samples = 1;
    job.colors = Colors::Map;
    job.palette = named::find("swiss").map(|palette| palette.palette().nearest());
    job.range = Some([0.0, 900.0]);
    job.color_bar = true;
    let world = session().open(recipe()).unwrap();
    let job = job.with_window(world.window_fitting(48).unwrap());
    let output = OutputPolicy::default().output(folder.join("job.png")).unwrap();
    job.to_file(&world, &output, &Progress::none()).unwrap();
    assert!(std::fs::read(export.path()).unwrap() == std::fs::read(output.path()).unwrap());
    let options = " --size 64x40 --camera 120.5,40 --color map --samples 1 --palette swiss --nearest-color --range 0,900 --color-bar --cell ";
    assert!(line(&export).contains(options), "{}", line(&export));
    give(&mut export.render.options, &[("haze", "101")]);
    let error = export.run(&session(), recipe(), None, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("a number from 0 to 100"), "{error}");
}

#[test]
fn a_tilemap_is_that_of_the_job() {
    let folder = TestFolder::new("studio-tilemap").unwrap();
    let mut export = export(Kind::Tilemap, &folder);
    assert_eq!(export.path(), folder.join("classic-tiles"));
    export.tilemap.size = 24;
    let words = run(&export);
    assert!(words.starts_with("tiles.png ") && words.contains("24 x 24 tiles of fields-16 (blob)"), "{words}");
    let job = TilemapJob::new(SETS[0].draw(orogen::grid::autotile::Layout::Blob));
    let world = session().open(recipe()).unwrap();
    let window = world.window_fitting(24).unwrap();
    let mut recipe = recipe();
    job.prepare(&mut recipe, window.cell).unwrap();
    let map = job.make(&session().open(recipe).unwrap(), &window, &Progress::none()).unwrap();
    let mut bytes = Vec::new();
    map.write_csv(&mut bytes).unwrap();
    assert!(std::fs::read(folder.join("classic-tiles/classes.csv")).unwrap() == bytes);
    assert!(line(&export).ends_with("classic-tiles --size 24"), "{}", line(&export));
}

#[test]
fn command_lines_name_the_part_of_the_world() {
    let mut export = export(Kind::Layer, Path::new(""));
    assert_eq!(line(&export), "orogen export classic --out classic.tif");
    export.set_path("my map's.png");
    assert_eq!(export.layer.format.name, "png");
    export.layer.size = Some(300);
    export.layer.set_layer("viewshed");
    export.layer.options.insert("bits", "8".into());
    export.layer.layer_options.insert("observer", "-5,7".into());
    assert_eq!(
        line(&export),
        "orogen export classic --out 'my map'\\''s.png' --layer viewshed --size 300 --bits 8 --observer=-5,7"
    );
    // Watersheds are samples in one format and areas in another.
    for (path, layers) in [("a.tif", ["watershed", "filled"]), ("a.geojson", ["watershed", "watersheds"])] {
        let format = registry::of_path(Path::new(path)).unwrap();
        let known = crate::export::layer::layers(format, &recipe());
        assert!(layers.iter().all(|layer| known.iter().any(|name| name == layer)), "{path}: {known:?}");
    }
    // A name that the user has chosen is kept.
    export.set_kind(Kind::Render);
    assert_eq!(export.path(), Path::new("my map's.png"));
    export.set_kind(Kind::Layer);
    export.set_path("my map's.png");
    export.set_path("a.data");
    assert!(line(&export).contains("--out a.data --format png"), "{}", line(&export));
    // A part of an unbounded world, and a part that is cut off at the edge of a bounded world.
    export.layer.set_layer(HEIGHT);
    export.region = Region::Square { center: [1000.0, 500.0], side: 2000.0 };
    export.layer.size = Some(200);
    let mut endless = recipe().world;
    endless.size = None;
    let words = export.command_line("endless", &endless).to_string();
    assert!(words.contains("--cell 10 --window 0,-50,200,200"), "{words}");
    assert!(line(&export).contains("--cell 10 --window 0,0,200,150"), "{}", line(&export));
}

#[test]
fn what_is_cancelled_leaves_no_file() {
    let folder = TestFolder::new("studio-cancel").unwrap();
    for (kind, _) in Kind::ALL {
        let progress = Progress::none();
        progress.cancel();
        let error = export(kind, &folder).run(&session(), recipe(), None, &progress).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled, "{kind:?}");
    }
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn what_a_recipe_keeps_makes_the_same_command_line() {
    let folder = Path::new("/lands");
    for (kind, _) in Kind::ALL {
        let mut first = export(kind, folder);
        match kind {
            Kind::Layer => {
                first.layer.set_format(registry::named("png").unwrap(), None);
                first.layer.set_layer("hillshade");
                first.layer.size = Some(300);
                give(&mut first.layer.options, &[("bits", "8")]);
                give(&mut first.layer.layer_options, &[("azimuth", "300")]);
            }
            Kind::Engine => {
                first.engine.set_target(list::named("unreal").unwrap());
                (first.engine.side, first.engine.tiles) = (Some(253), [2, 3]);
            }
            Kind::Map => give(&mut first.map.options, &[("title", "A land")]),
            Kind::Render => give(&mut first.render.options, &[("exaggeration", "2")]),
            Kind::Tilemap => first.tilemap.size = 48,
        }
        first.set_extension();
        first.region = Region::Square { center: [3000.0, 4000.0], side: 2000.0 };
        let kept = first.to_kept(folder);
        assert!(!kept.file.contains('/'), "{}", kept.file);
        let other = export(Kind::Layer, folder);
        let again = Export::of_kept(&kept, folder, &other).unwrap();
        assert_eq!(line(&again), line(&first));
        assert_eq!(again.to_kept(folder), kept);
    }
    let unknown = crate::editing::kept::KeptExport { kind: "later".into(), ..Default::default() };
    assert!(Export::of_kept(&unknown, folder, &export(Kind::Layer, folder)).is_none());
}
