//! `resample`: filters that give the same land at any requested cell.

use crate::support::open;
use orogen::declare::Input;
use orogen::field::{Fbm, Resample, Warp};
use orogen::filter::{Geomorphons, Thermal};
use orogen::grid::resample::{self, LayerKind};
use orogen::tiles::Tiling;
use orogen::{Budget, ErrorKind, Grid, Options, Points, Progress, Recipe, Sampler, Window, World, WorldSpec};

/// The cell of the worlds and of their filters.
const CELL: f64 = 30.0;

/// Steep noise, and its weathering at the requested cell; `land` is the same weathering at the fixed cell.
fn recipe(size: Option<f64>, cell: f64) -> Recipe {
    let mut recipe =
        Recipe::new(WorldSpec::default().with_seed(5).with_size(size.map(|side| [side; 2])).with_cell(CELL));
    recipe.add("noise", Fbm { wavelength: 700.0, octaves: 5, ..Fbm::default() });
    recipe.add("heights", orogen::field::Multiply { a: "noise".into(), b: 400.0.into() });
    recipe.add("worn", Thermal { source: "heights".into(), talus_angle: 20.0, iterations: 6, ..Thermal::default() });
    recipe.add("land", Resample { source: "worn".into(), cell, ..Resample::default() });
    recipe.output("height", "land").output("worn", "worn");
    recipe
}

fn bits(grid: &Grid) -> Vec<u32> {
    grid.data().iter().map(|sample| sample.to_bits()).collect()
}

/// Windows at the origin, below zero and far out.
const PLACES: [(i64, i64); 4] = [(0, 0), (-37, -1), (1_000_003, -999_937), (-40_000_000_001, 17)];

#[test]
fn a_filter_makes_the_same_land_at_any_cell() {
    let world = open(&recipe(None, 0.0), 2);
    for (x, y) in PLACES {
        // At its own cell it is identical to the filter.
        let own = Window::new(81, 73, CELL).at(8 * x, 8 * y);
        let land = world.window("height", &own).unwrap();
        assert_eq!(bits(&land), bits(&world.window("worn", &own).unwrap()));
        for ratio in [2, 4, 8] {
            let coarse = Window::new(80 / ratio + 1, 72 / ratio + 1, CELL * ratio as f64);
            let coarse = coarse.at(8 / ratio as i64 * x, 8 / ratio as i64 * y);
            let [made, worn] = ["height", "worn"].map(|layer| world.window(layer, &coarse).unwrap());
            let shared = (0..coarse.height).flat_map(|j| (0..coarse.width).map(move |i| (i, j)));
            assert!(shared.clone().all(|(i, j)| made[(i, j)].to_bits() == land[(ratio * i, ratio * j)].to_bits()));
            assert!(shared.clone().any(|at| made[at] != worn[at]), "the filter itself depends on the cell");
        }
        // Finer samples are interpolated.
        let fine = Window::new(120, 90, CELL / 4.0).at(4 * own.x + 40, 4 * own.y + 40);
        let mut expect = vec![0.0; fine.len()];
        let (xs, ys) = (fine.eastings(), fine.southings());
        resample::read(&land, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, &mut expect);
        assert_eq!(world.window("height", &fine).unwrap().data(), expect);
    }
}

#[test]
fn a_tile_equals_the_crop_at_any_cell() {
    let world = open(&recipe(None, 0.0), 2);
    // Finer, equal, coarser, coarser than the largest ratio, and not multiples of the cell.
    for cell in [CELL / 8.0, 11.3, CELL, 1.37 * CELL, 3.0 * CELL, 7.9 * CELL, 8.0 * CELL, 37.0 * CELL, 64.0 * CELL] {
        for (x, y) in PLACES {
            let whole = Window::new(40, 33, cell).at(x, y);
            let made = world.window("height", &whole).unwrap();
            assert!(made.data().iter().all(|height| height.is_finite()));
            for tile in [Window::new(1, 1, cell).at(x + 39, y + 32), Window::new(17, 9, cell).at(x + 5, y + 20)] {
                let alone = open(&recipe(None, 0.0), 1).window("height", &tile).unwrap();
                assert_eq!(bits(&alone), bits(&made.crop(&tile).unwrap()), "{tile:?}");
            }
        }
    }
}

#[test]
fn points_are_the_samples_of_any_cell() {
    let recipe = recipe(Some(6000.0), 40.0);
    let (world, sampler) = (open(&recipe, 2), Sampler::new(open(&recipe, 1), "height").unwrap());
    for cell in [7.5, CELL, 50.0, 240.0] {
        let window = Window::new(10, 9, cell).at(7, 5);
        let grid = world.window("height", &window).unwrap();
        assert_eq!(sampler.window(&window).unwrap(), grid);
        for (i, j) in [(0, 0), (9, 8), (3, 7)] {
            let (east, south) = (window.east(i), window.south(j));
            assert_eq!(world.height(east, south).unwrap().to_bits(), grid[(i, j)].to_bits(), "{cell} m");
            assert_eq!(sampler.at(east, south).unwrap().to_bits(), grid[(i, j)].to_bits(), "{cell} m");
        }
    }
}

#[test]
fn beyond_the_largest_ratio_the_source_is_computed_at_a_larger_cell() {
    let world = open(&recipe(None, 0.0), 2);
    let window = Window::new(9, 9, 32.0 * CELL);
    // 32 times the cell: computed at 4 times the cell.
    let source = world.window("worn", &Window::new(65, 65, 4.0 * CELL)).unwrap();
    let made = world.window("height", &window).unwrap();
    assert!((0..9).all(|i| made[(i, 8 - i)].to_bits() == source[(8 * i, 64 - 8 * i)].to_bits()));
    // So the memory of a window is bounded for any cell.
    let needed = |cell: f64| world.memory_of(&world.plan(&["height"], &Window::new(200, 200, cell)).unwrap()).unwrap();
    assert_eq!(needed(8.0 * CELL), needed(f64::from(1 << 30) * CELL));
    assert!(needed(8.0 * CELL) > 64 * 4 * 200 * 200 && needed(8.0 * CELL) < 2 * 20 * 64 * 200 * 200);
}

#[test]
fn plans_know_the_samples_of_large_cells() {
    let options = || Options { memory: Budget::of(24 << 20), threads: Some(2), ..Options::default() };
    let world = World::with_options(recipe(None, 0.0), options()).unwrap();
    let window = Window::new(256, 256, 8.0 * CELL).at(-100, 7);
    let error = world.window("height", &window).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Memory, "{error}");
    // Tiles of the same window fit.
    let expect = open(&recipe(None, 0.0), 2).window("height", &window).unwrap();
    let mut tiles = 0;
    for tile in world.tiles(&["height"], &window, Tiling::of(32), &Progress::none()).unwrap() {
        let grid = tile.unwrap().grids.remove(0);
        assert_eq!(bits(&grid), bits(&expect.crop(grid.window()).unwrap()));
        tiles += 1;
    }
    assert_eq!(tiles, 64);
    let plan = world.plan(&["height"], &Window::new(16, 16, 8.0 * CELL)).unwrap();
    let said = world.explain(&plan).unwrap();
    assert!(said.contains("samples at 30 m") && said.contains("apply `worn` to 126 x 126 at (-2, -2)"), "{said}");
}

#[test]
fn layers_are_interpolated_as_their_source_and_constants_stay() {
    let mut recipe = recipe(None, 0.0);
    recipe.add("forms", Geomorphons { source: "worn".into(), ..Geomorphons::default() });
    recipe.add("form", Resample { source: "forms".into(), cell: 100.0, ..Resample::default() });
    recipe.add("flat", Resample { source: 7.5.into(), ..Resample::default() });
    recipe.add("east", Fbm { wavelength: 900.0, seed: 3, ..Fbm::default() });
    let warp = |source: &str| Warp { source: source.into(), x: "east".into(), y: 0.3.into(), strength: 200.0 };
    recipe.add("bent", warp("land"));
    // Two in sequence, and masked.
    let again = Resample { source: "land".into(), cell: 75.0, ..Resample::default() };
    recipe.add_masked("again", again, Input::from("east"));
    for name in ["form", "flat", "bent", "again"] {
        recipe.output(name, name);
    }
    let world = open(&recipe, 2);
    let window = Window::new(60, 50, 20.0).at(-11, 400);
    let form = world.window("form", &window).unwrap();
    assert_eq!(world.kind("form").unwrap(), LayerKind::Label);
    assert!(form.data().iter().all(|form| form.fract() == 0.0) && form[(0, 0)] == form[(1, 0)]);
    assert!(world.window("flat", &window).unwrap().data().iter().all(|value| *value == 7.5));
    for layer in ["form", "bent", "again"] {
        let coarse = world.window(layer, &Window::new(20, 20, 40.0).at(-4, 201)).unwrap();
        let fine = world.window(layer, &Window::new(40, 40, 20.0).at(-8, 402)).unwrap();
        let shared = (0..20).flat_map(|j| (0..20).map(move |i| (i, j)));
        for (i, j) in shared {
            assert_eq!(coarse[(i, j)].to_bits(), fine[(2 * i, 2 * j)].to_bits(), "{layer} ({i}, {j})");
        }
    }
}

#[test]
fn a_chain_of_a_thousand_needs_no_stack() {
    let work = || {
        let mut recipe = Recipe::new(WorldSpec::default());
        recipe.add("n0", Fbm::default());
        for i in 1..1000 {
            recipe
                .add(&format!("n{i}"), Resample { source: Input::Node(format!("n{}", i - 1)), ..Resample::default() });
        }
        recipe.output("height", "n999").output("noise", "n0");
        let world = open(&recipe, 1);
        let window = Window::new(8, 8, recipe.world.cell);
        assert_eq!(world.window("height", &window).unwrap(), world.window("noise", &window).unwrap());
    };
    std::thread::Builder::new().stack_size(512 << 10).spawn(work).unwrap().join().unwrap();
}

#[test]
fn the_key_holds_the_cell() {
    let key = |cell: f64, world_cell: f64| {
        let mut recipe = recipe(None, cell);
        recipe.world.cell = world_cell;
        open(&recipe, 1).key("height").unwrap()
    };
    assert_ne!(key(0.0, 30.0), key(0.0, 60.0));
    assert_eq!(key(30.0, 30.0), key(30.0, 60.0));
}

#[test]
fn what_cannot_be_is_refused_with_a_sentence() {
    let said = |params: &str| {
        let text = format!(
            "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[nodes.b]\nop = \"resample\"\n{params}\n[outputs]\nheight = \"b\"\n"
        );
        Recipe::parse(&text, "t").and_then(World::open).err().unwrap().to_string()
    };
    for (params, expect) in [
        ("cell = 30", "source"),
        ("source = \"a\"\ncell = -1", "`cell` must be a finite number from 0 to 1e6 (m), not -1"),
        ("source = \"a\"\nmax_ratio = 0.5", "`max_ratio` must be a finite number from 1 to 64, not 0.5"),
        ("source = \"a\"\ncel = 30", "did you mean `cell`"),
    ] {
        assert!(said(params).contains(expect), "{}", said(params));
    }
    // A window that is too large for any memory is refused before the work starts.
    let options = Options { memory: Budget::of(1 << 30), threads: Some(1), ..Options::default() };
    let world = World::with_options(recipe(None, 1e-6), options).unwrap();
    let error = world.window("height", &Window::new(1 << 26, 1 << 26, 100.0)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Memory, "{error}");
}

#[test]
fn ground_with_resampled_weathering_is_the_same_land_at_any_cell() {
    let text = "orogen = 1\n[world]\ncell = 20\n[nodes.noise]\nop = \"billow\"\n\
        [nodes.ground]\nop = \"expr\"\nexpr = \"900 * noise\"\n\
        [nodes.weathered]\nop = \"thermal\"\nsource = \"ground\"\niterations = 16\n\
        [nodes.change]\nop = \"expr\"\nexpr = \"weathered - ground\"\n\
        [nodes.weathering]\nop = \"resample\"\nsource = \"change\"\n\
        [nodes.terrain]\nop = \"add\"\na = \"ground\"\nb = \"weathering\"\n[outputs]\nheight = \"terrain\"\n";
    let world = World::open(Recipe::parse(text, "test.toml").unwrap()).unwrap();
    let window = Window::new(129, 65, 20.0).at(400, 512);
    let land = world.window("height", &window).unwrap();
    let weathered = world.window("weathered", &window).unwrap();
    assert!(land.data().iter().zip(weathered.data()).all(|(a, b)| (a - b).abs() < 1e-3));
    for ratio in [2, 8] {
        let coarse = Window::new(128 / ratio + 1, 64 / ratio + 1, 20.0 * ratio as f64);
        let coarse = world.window("height", &coarse.at(400 / ratio as i64, 512 / ratio as i64)).unwrap();
        let same = |j: usize| (0..coarse.width()).all(|i| coarse[(i, j)] == land[(ratio * i, ratio * j)]);
        assert!((0..coarse.height()).all(same));
    }
}
