//! Worlds that share threads, solutions and memory.

use orogen::{Budget, ErrorKind, Options, Progress, Recipe, Session, Window, World, presets};
use std::sync::Barrier;
use std::sync::atomic::{AtomicU64, Ordering};

fn session(memory: Option<u64>) -> Session {
    Session::new(Options { threads: Some(2), memory: Budget::of(memory), ..Options::default() }).unwrap()
}

/// Two solvers, an expensive filter, and a cheap field that only the layer `other` reads.
const RECIPE: &str = r#"
    orogen = 1
    [world]
    seed = 5
    size = [7680, 7680]
    cell = 30.0
    [nodes.noise]
    op = "fbm"
    wavelength = 3000
    [nodes.land]
    op = "normalise"
    source = "noise"
    low = -50
    high = 900
    [nodes.carved]
    op = "stream-power"
    source = "land"
    steps = 2
    sea = false
    [nodes.aside]
    op = "billow"
    wavelength = 700
    [nodes.slid]
    op = "thermal"
    source = "carved"
    [outputs]
    height = "slid"
    other = "aside"
"#;

fn recipe() -> Recipe {
    Recipe::parse(RECIPE, "session").unwrap()
}

fn edited(from: &str, to: &str) -> Recipe {
    assert!(RECIPE.contains(from), "{from}");
    Recipe::parse(&RECIPE.replacen(from, to, 1), "session").unwrap()
}

fn window() -> Window {
    Window::new(200, 160, 30.0).at(10, 20)
}

#[test]
fn two_worlds_in_two_threads_stay_below_one_budget() {
    let expect = [2, 3].map(|seed| {
        let mut recipe = recipe();
        recipe.world.seed = seed;
        (World::open(recipe.clone()).unwrap().window("height", &window()).unwrap(), recipe)
    });
    // Enough for one and a half requests.
    let world = session(None).open(recipe()).unwrap();
    let one = world.memory_of(&world.plan(&["height"], &window()).unwrap()).unwrap();
    let session = session(Some(one * 3 / 2));
    std::thread::scope(|scope| {
        for (grid, recipe) in &expect {
            let session = session.clone();
            scope.spawn(move || {
                for _ in 0..3 {
                    let world = session.open(recipe.clone()).unwrap();
                    assert_eq!(world.window("height", &window()).unwrap(), *grid);
                }
            });
        }
    });
    let peak = session.budget().peak();
    assert!(peak >= one / 2 && peak <= one * 3 / 2, "{peak} of {one}");
    assert_eq!(session.budget().unused(), Some(one * 3 / 2), "all is given back");
}

#[test]
fn sixteen_threads_that_want_one_tile_solve_once() {
    let expect = World::open(recipe()).unwrap().window("height", &window()).unwrap();
    let session = session(None);
    let begin = Barrier::new(16);
    std::thread::scope(|scope| {
        for k in 0..16 {
            let (session, begin, expect) = (&session, &begin, &expect);
            scope.spawn(move || {
                // Half of the requests open a new world.
                let world = session.open(recipe()).unwrap();
                begin.wait();
                match k % 2 {
                    0 => assert_eq!(world.window("height", &window()).unwrap(), *expect),
                    _ => assert_eq!(world.height(600.0, 900.0).unwrap(), expect[(10, 10)]),
                }
            });
        }
    });
    assert_eq!(session.solutions_made(), 2, "`land` and `carved`");
}

/// Threads of another pool can wait too, without a deadlock.
#[test]
fn threads_of_other_pools_solve_once() {
    let session = session(None);
    let world = session.open(recipe()).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
    let grids = pool.install(|| orogen::grid::parallel::map(0..12, |_| world.window("height", &window()).unwrap()));
    assert!(grids.iter().all(|grid| *grid == grids[0]));
    assert_eq!(session.solutions_made(), 2);
}

#[test]
fn only_what_reads_an_edited_node_is_solved_again() {
    let session = session(None);
    let solved = |recipe: Recipe| {
        let before = session.solutions_made();
        session.open(recipe).unwrap().grids(&["height", "other"], &window(), &Progress::none()).unwrap();
        session.solutions_made() - before
    };
    assert_eq!(solved(recipe()), 2, "the first time");
    let edits = [
        (recipe(), 0, "nothing"),
        (edited("seed = 5", "seed = 5\n    sea_level = 120.0"), 0, "a sea level that nothing reads"),
        (edited("wavelength = 700", "wavelength = 800"), 0, "a node that no solver reads"),
        (
            edited("[nodes.aside]", "[nodes.unread]\n    op = \"fbm\"\n    [nodes.aside]"),
            0,
            "a node that nothing reads",
        ),
        (edited("op = \"thermal\"", "op = \"thermal\"\n    iterations = 7"), 0, "a filter behind the solvers"),
        (edited("steps = 2", "steps = 3"), 1, "the second solver"),
        (edited("high = 900", "high = 950"), 2, "the first solver"),
        (edited("wavelength = 3000", "wavelength = 3100"), 2, "what the first solver reads"),
        (edited("sea = false", "sea = true"), 1, "a solver that reads the sea level now"),
        (edited("seed = 5", "seed = 6"), 2, "the seed"),
    ];
    for (recipe, expect, what) in edits {
        assert_eq!(solved(recipe), expect, "{what}");
    }
    assert_eq!(solved(recipe()), 0, "undone");
}

#[test]
fn grids_of_expensive_filters_are_found_again() {
    let session = session(None);
    let first = session.open(recipe()).unwrap().window("height", &window()).unwrap();
    assert_eq!(session.filters_found(), 0);
    let again = session.open(edited("wavelength = 700", "wavelength = 800")).unwrap();
    assert_eq!(again.window("height", &window()).unwrap(), first);
    assert_eq!(session.filters_found(), 1, "the edit is not upstream of the filter");
    assert_eq!(again.window("height", &window().at(11, 20)).unwrap().row(3)[..100], first.row(3)[1..101]);
    assert_eq!(session.filters_found(), 1, "another window is another grid");
    let kept = session.kept_memory();
    assert!(kept > 0);
    let none = Session::new(Options { kept_grids: Some(0), ..Options::default() }).unwrap();
    for _ in 0..2 {
        assert_eq!(none.open(recipe()).unwrap().window("height", &window()).unwrap(), first);
    }
    assert_eq!(none.filters_found(), 0);
}

/// Cancels at many moments, and checks that stored solutions are valid, no memory stays reserved, and the next request
/// has the same bits.
fn cancelled_at_many_moments(recipe: &Recipe, samples: usize, moments: u64) {
    let open = |session: &Session| session.open(recipe.clone()).unwrap();
    let expect = {
        let world = open(&session(None));
        let window = world.window_fitting(samples).unwrap_or(Window::new(samples, samples, 30.0));
        world.window("height", &window).unwrap()
    };
    let session = session(Some(2 << 30));
    let mut cancelled = 0;
    for moment in 0..moments {
        // Each report of progress is a moment; the k-th run stops at a moment that no other run used.
        let heard = AtomicU64::new(0);
        let stop = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
        let told = std::sync::Arc::clone(&stop);
        let at = moment * 7919 % 97;
        let progress = Progress::new(move |_| {
            if heard.fetch_add(1, Ordering::Relaxed) >= at {
                told.store(true, Ordering::Relaxed);
            }
        })
        .stopped_by(stop);
        let fresh = session.with_empty_store();
        match open(&fresh).grids(&["height"], expect.window(), &progress) {
            Ok(grids) => assert_eq!(grids[0], expect),
            Err(error) => {
                assert_eq!(error.kind(), ErrorKind::Cancelled, "{error}");
                cancelled += 1;
            }
        }
        assert_eq!(fresh.budget().unused(), Some(2 << 30), "all is given back");
        if moment % 8 == 0 {
            assert_eq!(open(&fresh).window("height", expect.window()).unwrap(), expect, "after moment {moment}");
        }
    }
    assert!(cancelled > 0, "no run was cancelled");
}

#[test]
fn cancelled_requests_leave_nothing_behind() {
    cancelled_at_many_moments(&recipe(), 128, 24);
}

#[test]
#[ignore = "long: every preset, 200 moments each"]
fn every_preset_can_be_cancelled_at_any_moment() {
    for preset in presets::all() {
        println!("{}", preset.name);
        cancelled_at_many_moments(&preset.recipe().unwrap(), 128, 200);
    }
}
