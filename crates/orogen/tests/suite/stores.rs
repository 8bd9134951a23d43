//! The storage of solutions does not change any bit: in memory, on disk, in a cache folder for later runs.

use crate::support::world_of;
use orogen::field::{Fbm, Warp};
use orogen::filter::{Blur, Slope};
use orogen::io::read_at::ReadAt;
use orogen::io::test_folder::TestFolder;
use orogen::solver::{Bake, Normalise};
use orogen::store::EntryKey;
use orogen::store::solution_store::Entry;
use orogen::{
    Budget, ErrorKind, FolderStore, Grid, MemoryStore, Options, Progress, Recipe, Session, SolutionStore, Window, World,
};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A temporary folder.
struct Folder(TestFolder);

impl Folder {
    fn new(name: &str) -> Folder {
        Folder(TestFolder::new(&format!("stores-{name}")).unwrap())
    }

    fn names(&self) -> Vec<PathBuf> {
        let mut names: Vec<PathBuf> = fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().path()).collect();
        names.sort();
        names
    }

    fn cache(&self) -> FolderStore {
        FolderStore { slower_than: Duration::ZERO, ..FolderStore::new(&*self.0) }
    }
}

/// Warps of filters of solvers, twice; with `large`, the world takes more than one page and tile of everything.
fn stacked(cell: f64, large: bool) -> Recipe {
    let size = if large { [1300.0 * cell, 1030.0 * cell] } else { [640.0 * cell, 512.0 * cell] };
    let spec = world_of(cell).with_size(Some(size));
    let mut recipe = Recipe::new(spec);
    let noise = |seed, length: f64| Fbm { seed, wavelength: length * cell, octaves: 2, ..Default::default() };
    recipe.add("land", noise(1, 90.0)).add("wx", noise(2, 40.0)).add("wy", noise(3, 40.0));
    recipe.add("heights", Normalise { source: "land".into(), low: 0.0, high: 900.0, ..Normalise::default() });
    recipe.add("baked", Bake { source: "heights".into(), cell: 1.7 * cell, ..Bake::default() });
    recipe.add("steep", Slope { source: "baked".into(), ..Default::default() });
    recipe.add("soft", Blur { source: "baked".into(), radius: 2.3 * cell });
    let strength = 12.0 * cell;
    recipe.add("warped", Warp { source: "soft".into(), x: "wx".into(), y: "wy".into(), strength });
    recipe.add("again", Bake { source: "warped".into(), cell: 0.0, ..Bake::default() });
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
        // In memory and stored for a later run, found by it, on disk, found on disk.
        let short = Some(10 << 20);
        for (threads, memory, cached) in
            [(1, None, true), (2, None, true), (2, short, false), (1, short, true), (2, short, true)]
        {
            let store = cached.then(|| Arc::new(folder.cache()) as Arc<dyn SolutionStore>);
            let world = open(
                &recipe,
                Options {
                    threads: Some(threads),
                    memory: Budget::of(memory),
                    store,
                    scratch: Some(folder.0.to_path_buf()),
                    ..Options::default()
                },
            );
            let name = format!("{threads} threads, {memory:?} of memory, cache {cached}, cell {cell}");
            let mut moved = 0;
            for part in &parts {
                let plan = world.plan(&["height", "steep", "again"], part).unwrap();
                let on_disk = plan.solves().iter().filter(|solve| solve.on_disk).count();
                moved += on_disk;
                assert!(
                    memory.is_none_or(|memory| world.memory_of(&plan).unwrap() <= memory),
                    "{}",
                    world.explain(&plan).unwrap()
                );
                assert_eq!(world.disk_of(&plan) > 0, on_disk > 0);
                assert_eq!(world.explain(&plan).unwrap().contains("MiB temporarily"), on_disk > 0);
                same(&name, &whole, &layers(&world, part));
            }
            assert_eq!(moved > 0, memory.is_some(), "{name}");
            let (i, j) = (390, 355);
            let point = world.points("height", &[window.east(i)], &[window.south(j)]).unwrap()[0];
            assert_eq!(point.to_bits(), whole[0][(i, j)].to_bits(), "{name}");
            if cell != 10.24 {
                // The other positions differ only in their coordinates, so one run on disk is sufficient.
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
        assert!(world.memory_of(&plan).unwrap() <= memory, "{memory}: {}", world.explain(&plan).unwrap());
        sides.push(plan.solves()[0].side);
        same(&format!("{memory} bytes"), &whole, &layers(&world, &window));
    }
    assert!(sides[0] > sides[2], "several sizes of tiles were seen: {sides:?}");
}

/// Returns the work to make a window, the number of progress reports, and the grid.
fn made(recipe: &Recipe, cache: FolderStore, window: &Window) -> (f64, u64, Grid) {
    // Several threads may report the same work in different portions.
    let world = open(recipe, Options { threads: Some(1), store: Some(Arc::new(cache)), ..Options::default() });
    let plan = world.plan(&["height"], window).unwrap();
    let work = world.work(&plan).unwrap();
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
    // Another world has different solutions.
    let mut other = recipe.clone();
    other.world.seed += 1;
    assert!(made(&other, folder.cache(), &window).0 > less);
    assert_eq!(made(&recipe, folder.cache(), &window), (less, fewer, expect));
}

#[test]
fn what_was_quick_is_not_kept_and_no_folder_is_no_error() {
    let folder = Folder::new("quick");
    let window = Window::new(20, 20, 10.0);
    let slow = FolderStore { slower_than: Duration::from_secs(3600), ..folder.cache() };
    let (_, _, expect) = made(&stacked(10.0, false), slow, &window);
    assert!(folder.names().is_empty());
    fs::write(folder.0.join("file"), "in the way").unwrap();
    let (_, _, again) = made(&stacked(10.0, false), FolderStore::new(folder.0.join("file")), &window);
    assert_eq!(again, expect);
}

#[test]
fn what_cannot_fit_is_refused_with_the_figure() {
    let recipe = stacked(10.0, false);
    let world = open(&recipe, Options { threads: Some(2), memory: Budget::of(2 << 20), ..Options::default() });
    let error = world.window("height", &Window::new(10, 10, 10.0)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Memory);
    let text = error.to_string();
    assert!(text.contains(", and 2.0") && text.contains(" MiB is allowed"), "{text}");
    let recipe = stacked(10.0, true);
    let none = Options { memory: Budget::of(8 << 20), scratch: Some("/dev/null/nowhere".into()), ..Options::default() };
    let error = open(&recipe, none).window("height", &Window::new(10, 10, 10.0)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::File, "{error}");
    assert!(error.to_string().contains("cannot work in /dev/null/nowhere"), "{error}");
}

#[test]
fn solutions_of_other_layers_leave_memory_when_it_is_short() {
    let recipe = stacked(10.0, false);
    let window = Window::new(30, 30, 10.0);
    let ample = open(&recipe, Options::default());
    // Just enough for one layer at a time.
    let needed = |layer| ample.memory_of(&ample.plan(&[layer], &window).unwrap()).unwrap();
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
        recipe.add(&format!("n{i}"), Bake { source: (&format!("n{}", i - 1)).into(), ..Bake::default() });
    }
    recipe.output("height", "n199");
    let world = open(&recipe, Options::default());
    let begun = Instant::now();
    let plan = world.plan(&["height"], &Window::new(9, 9, 10.0)).unwrap();
    assert_eq!(plan.solves().len(), 199);
    let told = world.explain(&plan).unwrap();
    assert!(told.contains("samples: ") && told.contains(" to solve the world once\n"), "{told}");
    // Work that doubles with each solver would never end.
    assert!(begun.elapsed() < Duration::from_secs(120), "{:?}", begun.elapsed());
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
                    Options {
                        threads: Some(1),
                        memory: Budget::of(memory),
                        store: Some(Arc::new(cache)),
                        ..Options::default()
                    },
                );
                same("shared", expect, &layers(&world, &window));
            });
        }
    });
}

/// The fault of [`Objects`].
#[derive(Debug, Clone, Copy, PartialEq)]
enum Flaw {
    None,
    /// Nothing can be read.
    Get,
    /// Nothing can be stored.
    Put,
    /// Reads return the bytes of another entry.
    Swapped,
    /// The read with this number and all later reads fail.
    Read(i64),
    /// From the read with this number on, a bit in the middle is flipped.
    Flipped(i64),
    /// Bytes are missing at the end.
    Short,
}

/// A custom store of a program: bytes in a map, with faults.
#[derive(Debug)]
struct Objects {
    held: Mutex<BTreeMap<EntryKey, Arc<Vec<u8>>>>,
    fault: Mutex<Flaw>,
    /// Number of reads before the fault.
    left: Arc<AtomicI64>,
    removed: AtomicU64,
}

#[derive(Debug)]
struct Object {
    bytes: Arc<Vec<u8>>,
    fault: Flaw,
    left: Arc<AtomicI64>,
}

impl Objects {
    fn new() -> Arc<Objects> {
        let (held, fault) = (Mutex::default(), Mutex::new(Flaw::None));
        Arc::new(Objects { held, fault, left: Arc::default(), removed: AtomicU64::new(0) })
    }

    fn set(&self, fault: Flaw) {
        *self.fault.lock().unwrap() = fault;
        if let Flaw::Read(left) | Flaw::Flipped(left) = fault {
            self.left.store(left, Ordering::Relaxed);
        }
    }

    fn fault(&self) -> Flaw {
        *self.fault.lock().unwrap()
    }
}

impl SolutionStore for Objects {
    fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>> {
        let (held, fault) = (self.held.lock().unwrap(), self.fault());
        let bytes = match fault {
            Flaw::Get => return Err(io::Error::other("the network is gone")),
            Flaw::Swapped => held.iter().find(|(other, _)| *other != key).map(|(_, bytes)| bytes),
            _ => held.get(key),
        };
        let object = |bytes: &Arc<Vec<u8>>| Object { bytes: Arc::clone(bytes), fault, left: Arc::clone(&self.left) };
        Ok(bytes.map(|bytes| Box::new(object(bytes)) as Box<dyn ReadAt>))
    }

    fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()> {
        if self.fault() == Flaw::Put {
            return Err(io::Error::other("no more credit"));
        }
        let bytes = entry.to_bytes()?;
        assert_eq!(bytes.len() as u64, entry.length());
        self.held.lock().unwrap().insert(*key, Arc::new(bytes));
        Ok(())
    }

    fn contains(&self, key: &EntryKey) -> bool {
        self.held.lock().unwrap().contains_key(key)
    }

    fn remove(&self, key: &EntryKey) -> io::Result<()> {
        self.removed.fetch_add(1, Ordering::Relaxed);
        self.held.lock().unwrap().remove(key);
        Ok(())
    }
}

impl ReadAt for Object {
    fn length(&self) -> io::Result<u64> {
        Ok(self.bytes.len() as u64 - u64::from(self.fault == Flaw::Short))
    }

    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.bytes.read_exact_at(at, bytes)?;
        match self.fault {
            Flaw::Read(_) if self.left.fetch_sub(1, Ordering::Relaxed) <= 0 => {
                Err(io::Error::other("the connection was reset"))
            }
            Flaw::Flipped(_) if self.left.fetch_sub(1, Ordering::Relaxed) == 0 => {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 4;
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// Makes the layers in a session with a store, on one thread, so that reads keep their order. Returns the layers, the
/// number of solutions that were made, and the store's failure.
fn through(
    recipe: &Recipe,
    store: Arc<dyn SolutionStore>,
    memory: Option<u64>,
    window: &Window,
) -> (orogen::Result<Vec<Grid>>, u64, Option<String>) {
    let options = Options { threads: Some(1), memory: Budget::of(memory), store: Some(store), ..Options::default() };
    let session = Session::new(options).unwrap();
    let world = session.open(recipe.clone()).unwrap();
    let made = world.grids(&["height", "steep", "again"], window, &Progress::none());
    (made, session.solutions_made(), session.store_failure().map(|error| error.to_string()))
}

#[test]
fn a_store_of_a_program_may_fail_but_never_changes_a_bit() {
    let recipe = stacked(10.0, false);
    let window = Window::new(90, 80, 10.0).at(300, 200);
    let expect = layers(&open(&recipe, Options::default()), &window);
    let objects = Objects::new();
    let run = |memory| through(&recipe, objects.clone(), memory, &window);
    let failure = |fault| {
        objects.set(fault);
        let (layers, made, failure) = run(None);
        same(&format!("{fault:?}"), &expect, &layers.unwrap());
        objects.set(Flaw::None);
        (made, failure.unwrap_or_default())
    };
    let (made, told) = failure(Flaw::Put);
    assert_eq!(made, 3);
    assert!(told.starts_with("cannot store the solution ") && told.ends_with(": no more credit"), "{told}");
    assert_eq!(failure(Flaw::None), (3, String::new()));
    assert_eq!(failure(Flaw::None), (0, String::new()), "found");
    let (made, told) = failure(Flaw::Get);
    assert_eq!(made, 3);
    assert!(told.starts_with("cannot read the stored solution ") && told.ends_with(": the network is gone"), "{told}");
    // Damaged entries are removed, solved again and stored again.
    for (fault, expected) in [
        (Flaw::Swapped, "is not a stored solution: "),
        (Flaw::Short, "is not a stored solution: "),
        (Flaw::Read(0), "the connection was reset"),
        (Flaw::Read(4), "the connection was reset"),
        (Flaw::Flipped(0), "is not a stored solution: "),
        (Flaw::Flipped(1), "is not a stored solution: "),
        (Flaw::Flipped(4), "are damaged"),
    ] {
        let removed = objects.removed.load(Ordering::Relaxed);
        let (made, told) = failure(fault);
        assert!(made > 0 && told.contains(expected), "{fault:?}: {made} made, {told}");
        assert!(objects.removed.load(Ordering::Relaxed) > removed, "{fault:?}");
        assert_eq!(failure(Flaw::None), (0, String::new()), "{fault:?}: stored again");
    }
}

#[test]
fn entries_that_stay_in_a_store_are_the_same_bits_or_an_error() {
    // More pages than are kept in memory, so that they are read again after verification.
    let recipe = stacked(10.0, true);
    let window = Window::new(250, 240, 10.0).at(20, 20);
    let expect = layers(&open(&recipe, Options::default()), &window);
    let objects = Objects::new();
    let (mut errors, mut solved, mut fine) = (0, 0, 0);
    let mut run = |fault, memory| {
        objects.set(fault);
        let (layers, made, _) = through(&recipe, objects.clone(), memory, &window);
        match layers {
            Ok(layers) => {
                same(&format!("{fault:?}"), &expect, &layers);
                *(if made > 0 { &mut solved } else { &mut fine }) += 1;
            }
            Err(error) => {
                assert_eq!(error.kind(), ErrorKind::File, "{fault:?}: {error}");
                assert!(error.to_string().contains("the spilled data in"), "{error}");
                errors += 1;
            }
        }
    };
    run(Flaw::None, None);
    for reads in [1, 20, 40, 50, 53, 55, 1_000_000] {
        for fault in [Flaw::Read(reads), Flaw::Flipped(reads)] {
            run(fault, Some(10 << 20));
            run(Flaw::None, None);
        }
    }
    assert!(errors > 0 && solved > 1 && fine > 0, "{errors} errors, {solved} solved, {fine} found");
}

#[test]
fn sessions_share_a_store_in_memory() {
    let recipe = stacked(10.0, false);
    let window = Window::new(90, 80, 10.0).at(300, 200);
    let expect = layers(&open(&recipe, Options::default()), &window);
    let store = Arc::new(MemoryStore::new(1 << 30));
    for (memory, solved) in [(None, 3), (None, 0), (Some(6 << 20), 0)] {
        let (layers, made, failure) = through(&recipe, store.clone(), memory, &window);
        same(&format!("{memory:?}"), &expect, &layers.unwrap());
        assert_eq!((made, failure), (solved, None), "{memory:?}");
    }
    assert_eq!(store.entries(), 3);
}
