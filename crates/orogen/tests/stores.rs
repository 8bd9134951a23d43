//! The storage of solutions changes no bit: in memory, on disk, in a cache folder for later runs.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod support;

use orogen::field::{fbm::Fbm, warp::Warp};
use orogen::filter::{blur::Blur, slope::Slope};
use orogen::solver::{bake::Bake, normalise::Normalise};
use orogen::{Budget, Cache, Grid, Options, Progress, Recipe, Window, World};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use support::world_of;

/// A temporary folder, removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("orogen-stores-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn names(&self) -> Vec<PathBuf> {
        let mut names: Vec<PathBuf> = fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.sort();
        names
    }

    fn cache(&self) -> Cache {
        Cache { slower_than: Duration::ZERO, ..Cache::new(&self.0) }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Warps of filters of solvers, twice: more than one page and tile of everything if the world is `large`.
fn stacked(cell: f64, large: bool) -> Recipe {
    let size = if large { [1300.0 * cell, 1030.0 * cell] } else { [640.0 * cell, 512.0 * cell] };
    let spec = world_of(cell).with_size(Some(size));
    let mut recipe = Recipe::new(spec);
    let noise = |seed, length: f64| Fbm { seed, wavelength: length * cell, octaves: 2, ..Default::default() };
    recipe.add("land", noise(1, 90.0)).add("wx", noise(2, 40.0)).add("wy", noise(3, 40.0));
    recipe.add("heights", Normalise { source: "land".into(), low: 0.0, high: 900.0 });
    recipe.add("baked", Bake { source: "heights".into(), cell: 1.7 * cell });
    recipe.add("steep", Slope { source: "baked".into(), ..Default::default() });
    recipe.add("soft", Blur { source: "baked".into(), radius: 2.3 * cell });
    let strength = 12.0 * cell;
    recipe.add("warped", Warp { source: "soft".into(), x: "wx".into(), y: "wy".into(), strength });
    recipe.add("again", Bake { source: "warped".into(), cell: 0.0 });
    recipe.add("smooth", Blur { source: "again".into(), radius: 1.5 * cell });
    recipe.add("last", Warp { source: "smooth".into(), x: "wy".into(), y: "steep.east".into(), strength });
    recipe.output("height", "last").output("steep", "steep.south").output("again", "again");
    recipe
}

fn layers(world: &World, window: &Window) -> Vec<Grid> {
    world.grids(&["height", "steep", "again"], window, &Progress::none()).unwrap()
}

fn same(name: &str, whole: &[Grid], part: &[Grid]) {
    for (whole, part) in whole.iter().zip(part) {
        let crop = whole.crop(part.window()).unwrap();
        assert!(
            crop.data().iter().zip(part.data()).all(|(a, b)| a.to_bits() == b.to_bits()),
            "{name}: {:?}",
            part.window()
        );
    }
}

fn open(recipe: &Recipe, options: Options) -> World {
    World::with_options(recipe.clone(), options).unwrap()
}

#[test]
fn memory_disk_and_folder_make_the_same_bits() {
    for cell in [10.24, 0.1, 1.0 / 3.0] {
        let recipe = stacked(cell, true);
        let folder = Folder::new(&format!("bits-{cell}"));
        let window = Window::new(420, 360, cell).at(870, 660);
        let whole = layers(&open(&recipe, Options { threads: Some(2), ..Options::default() }), &window);
        assert!(whole.iter().all(|grid| grid.data().iter().all(|sample| sample.is_finite())));
        let parts: Vec<Window> = [(1, 419, 359), (64, 20, 281), (300, 111, 60)]
            .map(|(side, x, y)| Window::new(side, side, cell).at(window.x + x, window.y + y))
            .into();
        // In memory for a later run, found by it, on disk, found on disk.
        let short = Some(10 << 20);
        for (threads, memory, cached) in
            [(1, None, true), (2, None, true), (2, short, false), (1, short, true), (2, short, true)]
        {
            let cache = cached.then(|| folder.cache());
            let world = open(
                &recipe,
                Options {
                    threads: Some(threads),
                    memory: Budget::of(memory),
                    cache,
                    scratch: Some(folder.0.clone()),
                    ..Options::default()
                },
            );
            let name = format!("{threads} threads, {memory:?} of memory, cache {cached}, cell {cell}");
            let mut moved = 0;
            for part in &parts {
                let plan = world.plan(&["height", "steep", "again"], part).unwrap();
                let on_disk = plan.solves().iter().filter(|solve| solve.on_disk).count();
                moved += on_disk;
                assert!(memory.is_none_or(|memory| world.memory_of(&plan) <= memory), "{}", world.explain(&plan));
                assert_eq!(world.disk_of(&plan) > 0, on_disk > 0);
                assert_eq!(world.explain(&plan).contains("MiB temporarily"), on_disk > 0);
                same(&name, &whole, &layers(&world, part));
            }
            assert_eq!(moved > 0, memory.is_some(), "{name}");
            let (i, j) = (390, 355);
            let point = world.points("height", &[window.east(i)], &[window.south(j)]).unwrap()[0];
            assert_eq!(point.to_bits(), whole[0][(i, j)].to_bits(), "{name}");
            if cell != 10.24 {
                // The others differ in their positions only: one run on disk is sufficient.
                let world =
                    open(&recipe, Options { threads: Some(2), memory: Budget::of(short), ..Options::default() });
                same("disk", &whole, &layers(&world, &parts[2]));
                break;
            }
        }
        assert_eq!(folder.names().len(), 3, "three solutions, and nothing else is left: {:?}", folder.names());
    }
}

#[test]
fn tiles_of_any_size_solve_the_same() {
    let recipe = stacked(10.24, true);
    let window = Window::new(100, 90, 10.24).at(900, 800);
    let whole = layers(&open(&recipe, Options::default()), &window);
    let mut sides = Vec::new();
    for memory in [40 << 20, 11 << 20, 8 << 20] {
        let world = open(&recipe, Options { threads: Some(2), memory: Budget::of(memory), ..Options::default() });
        let plan = world.plan(&["height", "steep", "again"], &window).unwrap();
        assert!(world.memory_of(&plan) <= memory, "{memory}: {}", world.explain(&plan));
        sides.push(plan.solves()[0].side);
        same(&format!("{memory} bytes"), &whole, &layers(&world, &window));
    }
    assert!(sides[0] > sides[2], "several sizes of tiles were seen: {sides:?}");
}

/// Returns the work to make a window, the number of progress reports, and the grid.
fn made(recipe: &Recipe, cache: Cache, window: &Window) -> (f64, u64, Grid) {
    let world = open(recipe, Options { cache: Some(cache), ..Options::default() });
    let plan = world.plan(&["height"], window).unwrap();
    let work = world.work(&plan);
    let reports = Arc::new(AtomicU64::new(0));
    let heard = Arc::clone(&reports);
    let progress = Progress::new(move |_| _ = heard.fetch_add(1, Ordering::Relaxed));
    let grid = world.run(&plan, &progress).unwrap().remove(0);
    (work, reports.load(Ordering::Relaxed), grid)
}

#[test]
fn a_later_run_finds_what_was_solved_and_makes_again_what_is_damaged() {
    let folder = Folder::new("later");
    let recipe = stacked(10.0, false);
    let window = Window::new(20, 20, 10.0).at(600, 30);
    let (work, reports, expect) = made(&recipe, folder.cache(), &window);
    let (less, fewer, again) = made(&recipe, folder.cache(), &window);
    assert_eq!(expect, again);
    assert!(less * 20.0 < work && fewer < reports, "{less} after {work}, {fewer} reports after {reports}");
    // Only the last solver's solution is read; its inputs are not needed.
    let entries = folder.names();
    assert_eq!(entries.len(), 3);
    let height: Vec<&PathBuf> = entries.iter().filter(|path| fs::metadata(path).unwrap().len() < 1000).collect();
    assert_eq!(height.len(), 1, "normalise keeps numbers alone");
    fs::remove_file(height[0]).unwrap();
    assert_eq!(made(&recipe, folder.cache(), &window), (less, fewer, expect.clone()));
    for damaged in folder.names() {
        let mut bytes = fs::read(&damaged).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(&damaged, &bytes).unwrap();
        let (_, third, again) = made(&recipe, folder.cache(), &window);
        assert!(third > fewer && again == expect, "{third}");
        assert!(fs::read(&damaged).unwrap() != bytes, "it was made again");
    }
    // Another world has other solutions.
    let mut other = recipe.clone();
    other.world.seed += 1;
    assert!(made(&other, folder.cache(), &window).0 > less);
    assert_eq!(made(&recipe, folder.cache(), &window), (less, fewer, expect));
}

#[test]
fn what_was_quick_is_not_kept_and_no_folder_is_no_error() {
    let folder = Folder::new("quick");
    let window = Window::new(20, 20, 10.0);
    let slow = Cache { slower_than: Duration::from_secs(3600), ..folder.cache() };
    let (_, _, expect) = made(&stacked(10.0, false), slow, &window);
    assert!(folder.names().is_empty());
    fs::write(folder.0.join("file"), "in the way").unwrap();
    let (_, _, again) = made(&stacked(10.0, false), Cache::new(folder.0.join("file")), &window);
    assert_eq!(again, expect);
}

#[test]
fn what_cannot_fit_is_refused_with_the_figure() {
    let recipe = stacked(10.0, false);
    let world = open(&recipe, Options { threads: Some(2), memory: Budget::of(2 << 20), ..Options::default() });
    let error = world.window("height", &Window::new(10, 10, 10.0)).unwrap_err();
    assert_eq!(error.kind(), orogen::ErrorKind::Memory);
    assert!(error.to_string().contains("2.0 MiB is allowed"), "{error}");
    let recipe = stacked(10.0, true);
    let none = Options { memory: Budget::of(8 << 20), scratch: Some("/dev/null/nowhere".into()), ..Options::default() };
    let error = open(&recipe, none).window("height", &Window::new(10, 10, 10.0)).unwrap_err();
    assert_eq!(error.kind(), orogen::ErrorKind::File, "{error}");
    assert!(error.to_string().contains("cannot work in /dev/null/nowhere"), "{error}");
}

#[test]
fn solutions_of_other_layers_leave_memory_when_it_is_short() {
    let recipe = stacked(10.0, false);
    let window = Window::new(30, 30, 10.0);
    let ample = open(&recipe, Options::default());
    // Just enough for either layer alone.
    let needed = |layer| ample.memory_of(&ample.plan(&[layer], &window).unwrap());
    let limit = needed("height").max(needed("steep"));
    let world = open(&recipe, Options { memory: Budget::of(limit), ..Options::default() });
    for layer in ["steep", "height", "steep", "again", "height"] {
        assert_eq!(world.window(layer, &window).unwrap(), ample.window(layer, &window).unwrap());
    }
}

#[test]
fn a_chain_of_solvers_is_planned_in_no_time() {
    let mut recipe = Recipe::new(world_of(10.0));
    recipe.add("n0", Fbm::default());
    for i in 1..200 {
        recipe.add(&format!("n{i}"), Bake { source: (&format!("n{}", i - 1)).into(), cell: 0.0 });
    }
    recipe.output("height", "n199");
    let world = open(&recipe, Options::default());
    let begun = Instant::now();
    let plan = world.plan(&["height"], &Window::new(9, 9, 10.0)).unwrap();
    assert_eq!(plan.solves().len(), 199);
    let told = world.explain(&plan);
    assert!(told.contains("samples: ") && told.contains(" to solve the world once\n"), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    let first = world.window("n0", &Window::new(9, 9, 10.0)).unwrap();
    assert_eq!(world.window("height", &Window::new(9, 9, 10.0)).unwrap(), first);
}

#[test]
fn several_worlds_share_a_folder_at_once() {
    let folder = Folder::new("shared");
    let recipe = stacked(10.0, false);
    let window = Window::new(40, 40, 10.0).at(100, 100);
    let expect = layers(&open(&recipe, Options::default()), &window);
    std::thread::scope(|scope| {
        for memory in [None, Some(6 << 20), None] {
            let (recipe, expect, cache) = (&recipe, &expect, folder.cache());
            scope.spawn(move || {
                let world = open(
                    recipe,
                    Options { threads: Some(1), memory: Budget::of(memory), cache: Some(cache), ..Options::default() },
                );
                same("shared", expect, &layers(&world, &window));
            });
        }
    });
}
