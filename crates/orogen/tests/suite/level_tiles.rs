//! Tiles of levels: made once in a session and kept for later runs, with the same bits wherever they come from.

use orogen::io::read_at::ReadAt;
use orogen::io::test_folder::TestFolder;
use orogen::op::{Context, GridInputs, Levelled, Levels};
use orogen::solver::Normalise;
use orogen::store::EntryKey;
use orogen::store::solution_store::Entry;
use orogen::{
    Budget, Error, ErrorKind, FolderStore, Grid, MemoryStore, Options, Progress, Recipe, Result, Session,
    SolutionStore, Window, WorldSpec,
};
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

orogen::op! {
    /// Hashes of positions, added up from level to level.
    pub struct Sums = "tests.sums", levelled, revision 1;
    inputs {
        /// Added to each level.
        source: optional,
    }
    params {
        /// Names the hook that each tile of the coarsest level calls.
        hook: u64 = 0;
        /// Nanoseconds for a sample, as the op says.
        cost: f64 = 1000.0, range 0.0 to 1e6;
    }
    layers {
        /// The sum.
        height: height, unit "m";
    }
}

type Hook = Arc<dyn Fn(&Context) -> Result<()> + Send + Sync>;

/// Hooks by number: one for each test, because tests run in parallel.
static HOOKS: Mutex<Option<HashMap<u64, Hook>>> = Mutex::new(None);

fn set_hook(number: u64, hook: impl Fn(&Context) -> Result<()> + Send + Sync + 'static) {
    let mut hooks = HOOKS.lock().unwrap_or_else(PoisonError::into_inner);
    hooks.get_or_insert_default().insert(number, Arc::new(hook));
}

fn hash(level: usize, x: i64, y: i64) -> f32 {
    let hash = [level as u64, x as u64, y as u64]
        .iter()
        .fold(7u64, |hash, part| (hash ^ part).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29));
    (hash >> 44) as f32 / (1u32 << level) as f32
}

impl Sums {
    fn planes_of(window: &Window, sum: impl Fn(i64, i64) -> f32) -> Vec<Grid> {
        let (mut sums, mut columns) = (Grid::filled(*window, 0.0f32), Grid::filled(*window, 0.0f32));
        for (i, j) in (0..window.height).flat_map(|j| (0..window.width).map(move |i| (i, j))) {
            sums[(i, j)] = sum(window.x + i as i64, window.y + j as i64);
            columns[(i, j)] = (window.x + i as i64) as f32;
        }
        vec![sums, columns]
    }
}

impl Levelled for Sums {
    fn levels(&self) -> Levels {
        Levels { finest: 10.0, count: 4 }
    }

    fn planes(&self) -> usize {
        2
    }

    fn halo(&self, _: usize) -> usize {
        2
    }

    fn coarsest(&self, inputs: &GridInputs, window: &Window, context: &Context) -> Result<Vec<Grid>> {
        let hook = HOOKS.lock().unwrap_or_else(PoisonError::into_inner).as_ref().and_then(|hooks| {
            let hook = hooks.get(&self.hook)?;
            Some(Arc::clone(hook))
        });
        hook.map_or(Ok(()), |hook| hook(context))?;
        let source = inputs.get("source").map_or(0.0, |source| source.data()[0]);
        Ok(Sums::planes_of(window, |x, y| hash(0, x, y) + source))
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        _: &GridInputs,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        context.progress.check()?;
        let over = *parent[0].window();
        let at = |x: i64, y: i64| parent[0][((x - over.x) as usize, (y - over.y) as usize)];
        Ok(Sums::planes_of(window, |x, y| {
            0.5 * (at((x >> 1) - 2, y >> 1) + at((x >> 1) + 2, y >> 1)) + hash(level, x, y)
        }))
    }

    fn surface_halo(&self, _: usize, _: &[bool]) -> usize {
        1
    }

    fn layers_of(
        &self,
        _: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        _: &Context,
    ) -> Result<()> {
        let ([sums, _], [Some(out)]) = (planes, out) else { return Ok(()) };
        *out = sums.crop(window).ok_or_else(|| Error::new(ErrorKind::Internal, "the planes are too small"))?;
        Ok(())
    }

    fn cost(&self, _: usize) -> f64 {
        self.cost
    }
}

fn recipe(hook: u64) -> Recipe {
    recipe_of(Sums { hook, ..Sums::default() })
}

fn recipe_of(sums: Sums) -> Recipe {
    let mut recipe = Recipe::new(WorldSpec::default().with_cell(10.0));
    recipe.add("sums", sums).output("height", "sums");
    recipe
}

fn session(store: Option<Arc<dyn SolutionStore>>) -> Session {
    Session::new(Options { threads: Some(2), store, kept_grids: Some(0), ..Options::default() }).unwrap()
}

fn stored(folder: &TestFolder) -> FolderStore {
    FolderStore { slower_than: Duration::ZERO, ..FolderStore::new(&**folder) }
}

fn window_of(session: &Session, hook: u64, window: &Window, progress: &Progress) -> Result<Grid> {
    session.open(recipe(hook))?.grids(&["height"], window, progress).map(|mut grids| grids.remove(0))
}

fn made(session: &Session, hook: u64, window: &Window) -> Grid {
    window_of(session, hook, window, &Progress::none()).unwrap()
}

fn same(a: &Grid, b: &Grid) -> bool {
    let bits = |grid: &Grid| grid.data().iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
    a.window() == b.window() && bits(a) == bits(b)
}

/// Windows of all levels and between levels, which share tiles.
fn windows() -> [Window; 6] {
    [
        Window::new(90, 70, 10.0).at(-30, -40),
        Window::new(300, 200, 10.0).at(-150, -100),
        Window::new(64, 64, 20.0).at(500, -20),
        Window::new(50, 80, 13.0).at(31, 7),
        Window::new(40, 40, 80.0).at(-300, 40),
        Window::new(70, 20, 40.0).at(100, 100),
    ]
}

#[test]
fn requests_at_once_make_each_tile_once() {
    const HOOK: u64 = 1;
    set_hook(HOOK, |_| {
        thread::sleep(Duration::from_millis(5));
        Ok(())
    });
    let serial = session(None);
    let expect = windows().map(|window| made(&serial, HOOK, &window));
    let tiles = serial.level_tiles_made();
    assert!(tiles > 20, "{tiles}");
    windows().iter().for_each(|window| _ = made(&serial, HOOK, window));
    assert_eq!(serial.level_tiles_made(), tiles, "all are kept");
    // Threads of the program, and threads of another pool, where a waiting thread may be given the work of another
    // request.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    for threads in [1, 2] {
        let options = Options { threads: Some(threads), kept_grids: Some(0), ..Options::default() };
        let session = Session::new(options.clone()).unwrap();
        thread::scope(|scope| {
            for k in 0..12 {
                let (session, expect) = (&session, &expect[k % 6]);
                scope.spawn(move || assert!(same(&made(session, HOOK, expect.window()), expect)));
            }
        });
        assert_eq!(session.level_tiles_made(), tiles, "{threads} threads");
        let session = Session::new(options).unwrap();
        pool.install(|| {
            orogen::grid::parallel::for_each(0..24, |k: usize| {
                let expect = &expect[k % 6];
                assert!(same(&made(&session, HOOK, expect.window()), expect));
            });
        });
        assert_eq!(session.level_tiles_made(), tiles, "{threads} threads, requests from another pool");
    }
}

/// Solvers read levels on threads of the pool, which do not wait.
#[test]
fn solvers_and_windows_at_once_do_not_wait_for_each_other() {
    const HOOK: u64 = 2;
    set_hook(HOOK, |_| {
        thread::sleep(Duration::from_millis(2));
        Ok(())
    });
    let mut solved = recipe(HOOK);
    solved.world = solved.world.with_size(Some([2400.0, 1800.0]));
    solved.add("land", Normalise { source: "sums".into(), low: 0.0, high: 900.0, ..Normalise::default() });
    solved.output("land", "land");
    let window = Window::new(50, 40, 10.0).at(20, 20);
    let layers = ["height", "land"];
    let all =
        |session: &Session| session.open(solved.clone()).unwrap().grids(&layers, &window, &Progress::none()).unwrap();
    let expect = all(&session(None));
    for threads in [1, 2] {
        let session = Session::new(Options { threads: Some(threads), ..Options::default() }).unwrap();
        thread::scope(|scope| {
            for k in 0..8 {
                let (session, solved, expect, all) = (&session, &solved, &expect, &all);
                scope.spawn(move || match k % 2 {
                    0 => assert!(all(session).iter().zip(expect).all(|(a, b)| same(a, b))),
                    _ => {
                        let world = session.open(solved.clone()).unwrap();
                        assert!(same(&world.window("height", &window).unwrap(), &expect[0]));
                    }
                });
            }
        });
    }
}

/// Waits for a condition. The deadline only ends a test that would hang.
fn until(what: &str, is_met: impl Fn() -> bool) {
    let begun = Instant::now();
    while !is_met() {
        assert!(begun.elapsed() < Duration::from_secs(300), "{what}");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn after_a_cancelled_or_failed_request_one_that_waits_makes_the_tile() {
    const HOOK: u64 = 3;
    let (entered, held) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicBool::new(true)));
    let (heard, hold) = (Arc::clone(&entered), Arc::clone(&held));
    // The first request stays in its first tile until it is cancelled or fails.
    set_hook(HOOK, move |context| {
        let is_first = heard.fetch_add(1, Ordering::SeqCst) == 0;
        while is_first && hold.load(Ordering::SeqCst) {
            context.progress.check()?;
            thread::sleep(Duration::from_millis(1));
        }
        match is_first {
            true => Err(Error::new(ErrorKind::Request, "the first fails")),
            false => Ok(()),
        }
    });
    let window = Window::new(20, 20, 80.0);
    let tiles = {
        entered.store(1, Ordering::SeqCst);
        let session = session(None);
        made(&session, HOOK, &window);
        session.level_tiles_made()
    };
    assert_eq!(tiles, 1);
    for (threads, kind) in [(1, ErrorKind::Cancelled), (2, ErrorKind::Cancelled), (1, ErrorKind::Request)] {
        entered.store(0, Ordering::SeqCst);
        held.store(true, Ordering::SeqCst);
        let options = Options { threads: Some(threads), kept_grids: Some(0), ..Options::default() };
        let session = &Session::new(options).unwrap();
        let (first, waiter) = (Progress::none(), Progress::none());
        thread::scope(|scope| {
            let failing = scope.spawn(|| window_of(session, HOOK, &window, &first));
            until("the first request has begun", || entered.load(Ordering::SeqCst) == 1);
            let others: Vec<_> = (0..3).map(|_| scope.spawn(|| made(session, HOOK, &window))).collect();
            let cancelled = scope.spawn(|| window_of(session, HOOK, &window, &waiter));
            thread::sleep(Duration::from_millis(20));
            assert!(!others.iter().any(|other| other.is_finished()), "they wait");
            waiter.cancel();
            assert_eq!(cancelled.join().unwrap().unwrap_err().kind(), ErrorKind::Cancelled, "a wait ends");
            assert!(!failing.is_finished() && entered.load(Ordering::SeqCst) == 1);
            match kind {
                ErrorKind::Cancelled => first.cancel(),
                _ => held.store(false, Ordering::SeqCst),
            }
            assert_eq!(failing.join().unwrap().unwrap_err().kind(), kind);
            let grids: Vec<Grid> = others.into_iter().map(|other| other.join().unwrap()).collect();
            assert!(grids.iter().all(|grid| same(grid, &grids[0])));
        });
        assert_eq!((session.level_tiles_made(), entered.load(Ordering::SeqCst)), (1, 2), "{threads} threads, {kind:?}");
    }
}

/// The names of a folder's entries.
fn entries(folder: &TestFolder) -> Vec<PathBuf> {
    let mut names: Vec<PathBuf> = fs::read_dir(&**folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    names
}

#[test]
fn a_later_run_finds_the_tiles_and_makes_again_what_is_damaged() {
    const HOOK: u64 = 4;
    let folder = TestFolder::new("level-tiles-later").unwrap();
    let expect = windows().map(|window| made(&session(None), HOOK, &window));
    let run = |window: &Window, expect: &Grid| {
        let session = session(Some(Arc::new(stored(&folder))));
        assert!(same(&made(&session, HOOK, window), expect));
        (session.level_tiles_made(), session.store_failure().map(|error| error.to_string()))
    };
    let mut all = 0;
    for (window, expect) in windows().iter().zip(&expect) {
        let (tiles, failure) = run(window, expect);
        all += tiles;
        assert_eq!((entries(&folder).len() as u64, failure), (all, None), "each tile is stored once");
        assert_eq!(run(window, expect), (0, None), "found");
    }
    let listed = stored(&folder).stored().unwrap();
    assert_eq!(listed.len() as u64, all);
    let planes = |window: &Window| window.width == window.height && (window.width == 64 || window.width == 128);
    assert!(listed.iter().all(|tile| tile.level.is_some_and(|level| level < 4)));
    assert!(listed.iter().all(|tile| tile.layers.as_ref().is_some_and(|of| of.len() == 2 && of.iter().all(planes))));
    // A flipped bit, missing bytes, another tile's bytes.
    for round in 0..3 {
        let names = entries(&folder);
        for (at, name) in names.iter().enumerate() {
            let mut bytes = fs::read(name).unwrap();
            let middle = bytes.len() / 2;
            match round {
                0 => bytes[middle] ^= 8,
                1 => bytes.truncate(middle),
                _ => bytes = fs::read(&names[(at + 1) % names.len()]).unwrap(),
            }
            fs::write(name, &bytes).unwrap();
        }
        let mut again = 0;
        for (window, expect) in windows().iter().zip(&expect) {
            let (tiles, failure) = run(window, expect);
            assert!(tiles == 0 || failure.is_some_and(|why| why.contains("is not a stored tile")), "round {round}");
            again += tiles;
            assert_eq!(run(window, expect), (0, None), "stored again");
        }
        assert!(again > 0);
    }
}

#[test]
fn sessions_that_share_a_folder_at_once_make_the_same_bits_within_its_limit() {
    const HOOK: u64 = 5;
    let expect = windows().map(|window| made(&session(None), HOOK, &window));
    let length = |folder: &TestFolder| -> u64 {
        let length = |path: PathBuf| fs::metadata(path).map_or(0, |meta| meta.len());
        entries(folder).into_iter().map(length).sum()
    };
    for limit in [1 << 30, 300 << 10] {
        let folder = TestFolder::new("level-tiles-shared").unwrap();
        thread::scope(|scope| {
            for first in 0..4 {
                let (expect, store) = (&expect, FolderStore { limit, ..stored(&folder) });
                scope.spawn(move || {
                    let session = session(Some(Arc::new(store)));
                    for k in 0..6 {
                        let expect = &expect[(first + k) % 6];
                        assert!(same(&made(&session, HOOK, expect.window()), expect));
                    }
                    assert!(session.store_failure().is_none(), "{:?}", session.store_failure());
                });
            }
        });
        let found = session(Some(Arc::new(FolderStore { limit, ..stored(&folder) })));
        for expect in &expect {
            assert!(same(&made(&found, HOOK, expect.window()), expect));
        }
        match limit {
            0x4000_0000 => assert_eq!(found.level_tiles_made(), 0),
            _ => assert!(length(&folder) <= limit && found.level_tiles_made() > 0, "{} bytes", length(&folder)),
        }
    }
}

/// A store that counts requests.
#[derive(Debug)]
struct Counting {
    behind: MemoryStore,
    asked: AtomicUsize,
    keeps: bool,
}

impl SolutionStore for Counting {
    fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.behind.get(key)
    }

    fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()> {
        assert!(entry.is_tile() && entry.to_bytes()?.len() as u64 == entry.length());
        self.behind.put(key, entry)
    }

    fn contains(&self, key: &EntryKey) -> bool {
        self.behind.contains(key)
    }

    fn remove(&self, key: &EntryKey) -> io::Result<()> {
        self.behind.remove(key)
    }

    fn keeps_tiles(&self) -> bool {
        self.keeps
    }
}

#[test]
fn only_stores_that_keep_tiles_get_those_that_are_worth_it() {
    const HOOK: u64 = 6;
    let window = windows()[1];
    let expect = made(&session(None), HOOK, &window);
    let run = |store: Arc<dyn SolutionStore>, sums: Sums, memory: Option<u64>| {
        let options =
            Options { threads: Some(2), memory: Budget::of(memory), store: Some(store), ..Options::default() };
        let session = Session::new(options).unwrap();
        let grid = session.open(recipe_of(sums)).unwrap().window("height", &window).unwrap();
        assert!(same(&grid, &expect));
        session.level_tiles_made()
    };
    let sums = || Sums { hook: HOOK, ..Sums::default() };
    let store = |keeps| Arc::new(Counting { behind: MemoryStore::new(1 << 30), asked: AtomicUsize::new(0), keeps });
    let counts = |store: &Counting| (store.behind.entries() as u64, store.asked.load(Ordering::Relaxed) > 0);
    let keeping = store(true);
    let tiles = run(keeping.clone(), sums(), None);
    assert_eq!(counts(&keeping), (tiles, true));
    assert_eq!(run(keeping.clone(), sums(), None), 0);
    assert_eq!(run(keeping, sums(), Some(12 << 20)), 0, "with little memory, too");
    let others = store(false);
    run(others.clone(), sums(), None);
    assert_eq!(counts(&others), (0, false));
    // Tiles that are made as quickly as they are read.
    let cheap = store(true);
    run(cheap.clone(), Sums { cost: 20.0, ..sums() }, None);
    assert_eq!(counts(&cheap), (0, false));
    // A request that takes less time than the store requires.
    let folder = TestFolder::new("level-tiles-quick").unwrap();
    let patient = FolderStore { slower_than: Duration::from_secs(3600), ..stored(&folder) };
    run(Arc::new(patient), sums(), None);
    assert!(entries(&folder).is_empty());
    // A session whose store was removed.
    let folder = TestFolder::new("level-tiles-without").unwrap();
    let session = session(Some(Arc::new(stored(&folder)))).with_empty_store();
    assert!(same(&made(&session, HOOK, &window), &expect) && entries(&folder).is_empty());
}
