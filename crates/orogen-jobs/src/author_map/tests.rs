//! Tests on the small map.

use std::sync::OnceLock;

use super::{AuthorMapJob, AuthorWorld};
use orogen_engine::session;
use orogen_engine::world::World;
use orogen_engine::{Recipe, Window};
use orogen_grid::polylines::outline::Outline;
use orogen_grid::polylines::segments::Segments;
use orogen_grid::progress::Progress;
use orogen_io::file::{Existing, OutputPolicy};
use orogen_io::format::fmg::{FmgMap, samples};
use orogen_io::format::points::NamedPoints;
use orogen_io::test_folder::TestFolder;

/// The world of the small map, with a width in kilometres.
fn made(width: f64) -> AuthorWorld {
    let map = FmgMap::parse(&samples::map().to_string(), Some(width)).unwrap();
    AuthorMapJob::new().run_on(map, "mine", &session::Options::default(), &Progress::none()).unwrap()
}

/// The world of the small map with its own width, made once.
fn shared() -> &'static AuthorWorld {
    static WORLD: OnceLock<AuthorWorld> = OnceLock::new();
    WORLD.get_or_init(|| made(410.0))
}

/// The world in a folder, with a detail of the coast.
fn opened(world: &AuthorWorld, folder: &TestFolder, detail: Option<f64>) -> World {
    let path = folder.join("mine.toml");
    if !path.exists() {
        world.write(&path, &folder.join("mine"), &OutputPolicy::new(Existing::Keep)).unwrap();
    }
    let set: Vec<(String, f64)> = detail.map(|detail| ("coast_detail".into(), detail)).into_iter().collect();
    World::open(Recipe::read_with(&path, &set).unwrap()).unwrap()
}

fn shore(map: &FmgMap) -> Segments {
    let rings = map.coast.iter().flatten();
    let outline = |ring: &Vec<[f64; 2]>| {
        Outline::of_points(&ring.iter().map(|at| [at[0], at[1], 0.0]).collect::<Vec<_>>()).closed()
    };
    Segments::new(&rings.map(outline).collect::<Vec<_>>(), 1.0)
}

#[test]
fn heights_follow_the_map() {
    let world = shared();
    assert!(world.correlation() > 0.9, "{}", world.words());
    assert!((0.8..1.25).contains(&world.calibration.ratio), "{}", world.words());
}

#[test]
fn the_coast_is_the_drawn_one_within_a_cell() {
    let world = made(41.0);
    let folder = TestFolder::new("author-map").unwrap();
    let opened = opened(&world, &folder, Some(0.0));
    let shore = shore(&world.map);
    for (cell, window) in [
        (opened.recipe().world.cell * 8.0, None),
        (opened.recipe().world.cell, None),
        // A piece of the eastern coast of the western land, and parts of it.
        (opened.recipe().world.cell / 4.0, Some([22_000.0, 10_000.0, 3000.0])),
        (opened.recipe().world.cell / 16.0, Some([22_000.0, 10_500.0, 1000.0])),
        (opened.recipe().world.cell / 32.0, Some([22_000.0, 10_500.0, 500.0])),
    ] {
        let window = match window {
            None => opened.full_window(cell).unwrap(),
            Some([x, y, side]) => {
                let index = |metres: f64| (metres / cell) as i64;
                Window::new(index(side) as usize, index(side) as usize, cell).at(index(x), index(y))
            }
        };
        let heights = opened.window("surface", &window).unwrap();
        let within = 1.5 * cell;
        let (mut wrong, mut land) = (0, 0);
        for j in 0..window.height {
            for i in 0..window.width {
                let at = [window.east(i), window.south(j)];
                let is_land = heights[(i, j)] > 0.0;
                land += usize::from(is_land);
                let near = shore.nearest(at, f64::INFINITY).unwrap().distance() <= within;
                wrong += usize::from(!near && is_land != shore.is_inside(at));
            }
        }
        let samples = window.len();
        assert!(land > samples / 20 && land < samples, "{land} of {samples} at {cell} m");
        assert!(wrong <= samples / 500, "{wrong} of {samples} samples at {cell} m");
    }
}

#[test]
fn files_are_written_together_and_never_over_others() {
    let world = shared();
    let folder = TestFolder::new("author-files").unwrap();
    let (recipe, inner) = (folder.join("mine.toml"), folder.join("mine"));
    let policy = OutputPolicy::new(Existing::Keep);
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(inner.join("rivers.geojson"), "mine").unwrap();
    let why = world.write(&recipe, &inner, &policy).unwrap_err().to_string();
    assert!(why.contains("rivers.geojson already exists and is left unchanged"), "{why}");
    assert_eq!((std::fs::read_dir(&inner).unwrap().count(), recipe.exists()), (1, false));
    std::fs::remove_file(inner.join("rivers.geojson")).unwrap();
    world.write(&recipe, &inner, &policy).unwrap();
    let mut names: Vec<String> =
        std::fs::read_dir(&inner).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let expect =
        ["coast.geojson", "heights.tif", "lakes.geojson", "places.csv", "rain.tif", "rivers.geojson", "uplift.tif"];
    assert_eq!(names, expect);
    let found = NamedPoints::read(&inner.join("places.csv"), 100).unwrap();
    assert_eq!(found.points.len(), 2 + 1 + 5);
    let lines = NamedPoints::read(&inner.join("rivers.geojson"), 100).unwrap().lines;
    assert_eq!(lines[0].name.as_deref(), Some("Arden River"));
    assert!(lines.iter().flat_map(|line| &line.points).all(|at| at[1] <= 0.0));
}

#[test]
fn the_same_map_makes_the_same_world() {
    let (one, other) = (shared(), made(410.0));
    assert_eq!((one.recipe(), &one.rasters.uplift), (other.recipe(), &other.rasters.uplift));
}
