//! Chunks around a moving viewer cover the ground exactly once, at every step, and have the samples of the world.

use crate::support::{Random, open, recipe_of, world_of};
use orogen::chunks::{Sides, stitch};
use orogen::node::Node;
use orogen::op::Op;
use orogen::{
    Budget, ChunkId, ChunkStep, Chunks, Grid, LodConfig, Options, Progress, Sampler, Window, World, WorldSpec, presets,
};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex};

const RINGS: LodConfig =
    LodConfig::new().with_cells(8).with_cell(2.0).with_levels(5).with_detail(1.25).with_range(900.0).with_slack(0.25);

/// Returns a random position in -n ..= n.
fn about(random: &mut Random, n: u64) -> f64 {
    random.below(2 * n + 1) as f64 - n as f64
}

/// A walk with turns, jumps and pauses.
fn walk(seed: u64, steps: usize) -> impl Iterator<Item = [f64; 2]> {
    let mut random = Random(seed);
    let mut at = [about(&mut random, 5000), about(&mut random, 5000)];
    (0..steps).map(move |step| {
        let stride = if step % 17 == 16 { 3000 } else { 40 };
        at = at.map(|metres| metres + about(&mut random, stride) * 0.7);
        at
    })
}

/// Returns the chunks of `sorted` that cover a chunk of the finest level.
fn covering(sorted: &BTreeSet<ChunkId>, finest: ChunkId, levels: u8) -> Vec<ChunkId> {
    let mut id = finest;
    let mut found = Vec::new();
    for _ in 0..levels {
        found.extend(sorted.get(&id));
        id = id.parent();
    }
    found
}

/// Returns the chunk of the finest level at a position.
fn finest(lod: &LodConfig, [x, y]: [f64; 2]) -> ChunkId {
    let side = lod.side(0);
    ChunkId { level: 0, y: (y / side).floor() as i64, x: (x / side).floor() as i64 }
}

#[test]
fn the_ground_in_range_is_covered_once_and_neighbors_differ_by_one_level() {
    for detail in [1.25, 2.0] {
        let lod = RINGS.with_detail(detail);
        let mut chunks = Chunks::new(lod, None).unwrap();
        let square = |side: f64| side * side;
        let mut random = Random(3);
        for at in walk(1, 60) {
            chunks.set_viewer(at[0], at[1]).unwrap();
            let wanted: BTreeSet<ChunkId> = chunks.wanted().iter().copied().collect();
            assert_eq!(wanted.len(), chunks.wanted().len());
            let area: f64 = wanted.iter().map(|id| square(lod.side(id.level))).sum();
            let roots: BTreeSet<ChunkId> =
                wanted.iter().map(|id| (id.level..4).fold(*id, |id, _| id.parent())).collect();
            assert_eq!(area, roots.len() as f64 * square(lod.side(4)), "{at:?}: no gap and nothing twice");
            for _ in 0..50 {
                let place = at.map(|metres| metres + about(&mut random, 899));
                let covers = covering(&wanted, finest(&lod, place), 5);
                assert_eq!(covers.len(), 1, "{at:?}: {place:?} is covered by {covers:?}");
                let id = covers[0];
                // At least as fine as configured, and not finer than the configuration with its slack.
                let distance = lod.distance(id, at);
                assert!(id.level == 0 || distance >= detail * lod.side(id.level), "{id:?} at {distance} m is coarse");
                let parent = id.parent();
                let far = (detail + lod.slack) * lod.side(parent.level);
                assert!(id.level == 4 || lod.distance(parent, at) < far, "{id:?} at {distance} m is fine");
            }
            for id in &wanted {
                for (columns, rows) in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)] {
                    let grandparent = id.beside(columns, rows).parent().parent();
                    let mut too_coarse = (id.level + 2..5).scan(grandparent, |id, _| {
                        let here = *id;
                        *id = id.parent();
                        Some(here)
                    });
                    assert!(!too_coarse.any(|id| wanted.contains(&id)), "{at:?}: {id:?}");
                }
            }
        }
    }
}

#[test]
fn chunks_come_nearest_first_and_leave_no_hole() {
    let mut chunks = Chunks::new(RINGS, None).unwrap();
    let mut shown: BTreeSet<ChunkId> = BTreeSet::new();
    let mut made = 0;
    for (number, at) in walk(2, 80).enumerate() {
        chunks.set_viewer(at[0], at[1]).unwrap();
        let wanted: BTreeSet<ChunkId> = chunks.wanted().iter().copied().collect();
        let mut places: Vec<ChunkId> = walk(number as u64, 30)
            .map(|place| finest(&RINGS, [at[0] + place[0] % 880.0, at[1] + place[1] % 880.0]))
            .filter(|place| !covering(&shown, *place, 5).is_empty() && !covering(&wanted, *place, 5).is_empty())
            .collect();
        let mut nearest = 0.0;
        // Only some of the chunks: the viewer moves on before all are made.
        for _ in 0..random_budget(number) {
            match chunks.next_step() {
                Some(ChunkStep::Make(id)) => {
                    assert!(wanted.contains(&id) && shown.insert(id), "{id:?} is wanted and not there yet");
                    let distance = RINGS.distance(id, at);
                    assert!(distance >= nearest, "nearest first");
                    nearest = distance;
                    made += 1;
                }
                Some(ChunkStep::Drop(id)) => assert!(!wanted.contains(&id) && shown.remove(&id), "{id:?}"),
                None => {
                    assert_eq!(shown, wanted, "complete");
                    assert_eq!(chunks.next_step(), None);
                    break;
                }
            }
            places.retain(|place| {
                assert!(!covering(&shown, *place, 5).is_empty(), "{place:?} had ground before");
                true
            });
        }
    }
    assert!(made > 500, "{made} chunks were made");
}

fn random_budget(number: usize) -> usize {
    [5, 1000, 0, 40, 1, 1000][number % 6]
}

#[test]
fn a_viewer_who_goes_to_and_fro_makes_nothing_anew() {
    let mut chunks = Chunks::new(RINGS, None).unwrap();
    let steps = |chunks: &mut Chunks, x: f64| {
        chunks.set_viewer(x, 0.0).unwrap();
        std::iter::from_fn(|| chunks.next_step()).count()
    };
    assert!(steps(&mut chunks, 0.0) > 50);
    for x in [1.0, -1.0, 3.9, 0.0, 4.0] {
        let first = steps(&mut chunks, x);
        // The finest chunks have sides of 16 m and a slack of 4 m.
        assert_eq!((steps(&mut chunks, x - 3.9), steps(&mut chunks, x)), (0, 0), "{x}, first {first}");
    }
    assert_eq!(steps(&mut chunks, 4.0), 0, "standing still takes no steps");
    assert!(steps(&mut chunks, 100.0) > 0);
}

#[test]
fn chunks_made_elsewhere_come_back_in_any_order() {
    let mut chunks = Chunks::new(RINGS, None).unwrap();
    chunks.set_viewer(0.0, 0.0).unwrap();
    let count = chunks.wanted().len();
    let taken: Vec<ChunkId> = std::iter::from_fn(|| chunks.take()).collect();
    assert_eq!(taken.len(), count);
    assert_eq!((chunks.take(), chunks.evict()), (None, None));
    // One chunk fails and is returned again.
    chunks.forget(taken[0]);
    assert_eq!(chunks.take(), Some(taken[0]));
    // The viewer leaves before any chunk is made: the chunks are requested and dropped.
    chunks.set_viewer(1e6, 1e6).unwrap();
    assert_eq!(chunks.evict(), None, "what is not made yet cannot be given up");
    taken.iter().rev().for_each(|id| chunks.done(*id));
    let gone: BTreeSet<ChunkId> = std::iter::from_fn(|| chunks.evict()).collect();
    assert_eq!(gone, taken.iter().copied().collect());
    // A coarse chunk stays until all chunks that replace it are made, in any order.
    let mut chunks = Chunks::new(RINGS, None).unwrap();
    chunks.set_viewer(2000.0, 0.0).unwrap();
    while chunks.next_step().is_some() {}
    chunks.set_viewer(1500.0, 0.0).unwrap();
    let coarse = ChunkId { level: 4, y: 0, x: 5 };
    let finer: Vec<ChunkId> = std::iter::from_fn(|| chunks.take()).collect();
    let parts: Vec<ChunkId> = finer.iter().copied().filter(|id| coarse.covers(*id)).collect();
    for id in parts.iter().rev() {
        assert!(!std::iter::from_fn(|| chunks.evict()).any(|id| id == coarse), "{id:?} is missing yet");
        chunks.done(*id);
    }
    assert!(parts.is_empty() || std::iter::from_fn(|| chunks.evict()).any(|id| id == coarse), "{parts:?}");
    assert!(!parts.is_empty());
}

#[test]
fn every_chunk_is_the_window_and_shares_its_borders() {
    for node in Node::all() {
        if matches!(node.op(), Op::Solver(_)) || matches!(node.op(), Op::Field(field) if field.needs_bounds()) {
            continue;
        }
        let op = node.spec().op;
        // Glaciers are kilometres long: with a smaller cell, chunks would need thousands of samples around them.
        let cell = if matches!(op, "glaciate" | "glaciers") { 100.0 / 3.0 } else { 1.0 / 3.0 };
        let spec = WorldSpec::default().with_seed(3).with_size(None).with_cell(cell);
        let world = open(&recipe_of(&node, spec, false), 2);
        let sampler = Sampler::new(open(&recipe_of(&node, spec, false), 1), "height").unwrap();
        let lod = LodConfig::default().with_cells(8).with_cell(cell).with_levels(3).with_range(60.0 * cell);
        for at in [[0.0, 0.0], [-777.7, 123_456.7], [3e8, -9e9]] {
            let mut chunks = world.chunks(lod).unwrap();
            chunks.set_viewer(at[0], at[1]).unwrap();
            let mut made: BTreeMap<ChunkId, Grid> = BTreeMap::new();
            while let Some(id) = chunks.take() {
                made.insert(id, sampler.window(&chunks.window(id)).unwrap());
            }
            let near = made.iter().take(12).chain(made.iter().rev().take(4));
            for (id, grid) in near {
                let window = chunks.window(*id);
                assert_eq!(grid, &world.window("height", &window).unwrap(), "{op} {id:?}");
                // Points evaluate filters at the world's cell, which is the cell of level 0.
                if id.level == 0 {
                    let height = world.height(window.east(5), window.south(3)).unwrap();
                    assert_eq!(height.to_bits(), grid[(5, 3)].to_bits(), "{op} {id:?}");
                }
            }
            let mut met = 0;
            for (id, grid) in &made {
                if let Some(east) = made.get(&id.beside(1, 0)) {
                    assert!((0..9).all(|j| grid[(8, j)].to_bits() == east[(0, j)].to_bits()), "{op} {id:?}");
                    met += 1;
                }
                if let Some(south) = made.get(&id.beside(0, 1)) {
                    assert!((0..9).all(|i| grid[(i, 8)].to_bits() == south[(i, 0)].to_bits()), "{op} {id:?}");
                }
                // The inputs of nodes are filtered, and the result of a filter depends on the cell, so levels agree for
                // fields only.
            }
            assert!(met > 10, "{met} neighbors met");
        }
    }
}

#[test]
fn chunks_of_bounded_worlds_are_windows_too() {
    for node in Node::all() {
        let bound = match node.op() {
            Op::Solver(_) => true,
            Op::Field(field) => field.needs_bounds(),
            Op::Filter(_) | Op::Levelled(_) => false,
        };
        if !bound {
            continue;
        }
        let (recipe, op) = (recipe_of(&node, world_of(10.24), true), node.spec().op);
        let (world, sampler) = (open(&recipe, 2), Sampler::new(open(&recipe, 1), "height").unwrap());
        let lod = LodConfig::default().with_cells(8).with_cell(10.24).with_levels(3).with_range(5000.0);
        let mut chunks = world.chunks(lod).unwrap();
        // Near a corner outside of the world, chunks of every level; chunks at the far edges are clipped.
        chunks.set_viewer(1000.0, 900.0).unwrap();
        let mut levels = [0; 3];
        while let Some(id) = chunks.take() {
            let window = chunks.window(id);
            let grid = sampler.window(&window).unwrap();
            assert_eq!(grid, world.window("height", &window).unwrap(), "{op} {id:?}");
            if id.level == 0 {
                let height = world.height(window.east(1), window.south(1)).unwrap();
                assert_eq!(height.to_bits(), grid[(1, 1)].to_bits(), "{op} {id:?}");
            }
            levels[usize::from(id.level)] += 1;
        }
        assert!(levels.iter().all(|count| *count > 0), "{op}: {levels:?}");
    }
}

#[test]
fn levels_meet_without_cracks() {
    let world = World::open(presets::find("hills").unwrap().recipe().unwrap()).unwrap();
    let sampler = Sampler::new(&world, "height").unwrap();
    let lod = LodConfig::default().with_cells(16).with_cell(3.0).with_levels(4).with_range(1500.0);
    let mut chunks = world.chunks(lod).unwrap();
    chunks.set_viewer(7000.0, 8000.0).unwrap();
    let mut made: BTreeMap<ChunkId, Grid> = BTreeMap::new();
    while let Some(id) = chunks.take() {
        let mut grid = sampler.window(&chunks.window(id)).unwrap();
        // For fields, a chunk of any level equals the values at its points.
        let height = sampler.at(grid.window().east(7), grid.window().south(9)).unwrap();
        assert_eq!(height.to_bits(), grid[(7, 9)].to_bits(), "{id:?}");
        stitch(&mut grid, chunks.coarser(id));
        made.insert(id, grid);
    }
    let mut met = 0;
    for (id, grid) in made.iter().filter(|(id, _)| chunks.coarser(**id) != Sides::default()) {
        if !chunks.coarser(*id).east {
            continue;
        }
        let coarse = id.beside(1, 0).parent();
        let Some(neighbor) = made.get(&coarse) else { panic!("{id:?} has a coarser neighbor in the east") };
        let top = (chunks.window(*id).y / 2 - chunks.window(coarse).y) as usize;
        for j in 0..=16 {
            let here = grid[(16, j)];
            let there = match j % 2 {
                0 => neighbor[(0, top + j / 2)],
                _ => 0.5 * neighbor[(0, top + j / 2)] + 0.5 * neighbor[(0, top + j / 2 + 1)],
            };
            assert_eq!(here.to_bits(), there.to_bits(), "{id:?} row {j}");
        }
        met += 1;
    }
    assert!(met >= 6, "{met} seams");
}

#[test]
fn a_world_with_bounds_has_no_chunks_beyond_them() {
    let world = open(&recipe_of(&Node::named("edge").unwrap(), world_of(10.0), false), 1);
    let sampler = Sampler::new(&world, "height").unwrap();
    // Neither 960 m nor 800 m is a multiple of the coarser chunks of 128 and 256 m.
    let lod = LodConfig::default().with_cells(8).with_cell(8.0).with_levels(3).with_range(3000.0);
    for at in [[0.0, 0.0], [960.0, 800.0], [-500.0, 400.0], [480.0, 1500.0]] {
        let mut chunks = world.chunks(lod).unwrap();
        chunks.set_viewer(at[0], at[1]).unwrap();
        let (mut count, mut right, mut bottom) = (0, 0.0f64, 0.0f64);
        while let Some(ChunkStep::Make(id)) = chunks.next_step() {
            let grid = sampler.window(&chunks.window(id)).unwrap();
            assert!(grid.width() >= 2 && grid.height() >= 2 && grid.width() <= 9 && id.x >= 0 && id.y >= 0);
            right = right.max(grid.window().east(grid.width() - 1));
            bottom = bottom.max(grid.window().south(grid.height() - 1));
            count += 1;
        }
        assert!(count >= 12, "{count}");
        assert!(right > 960.0 - 32.0 && right <= 960.0 && bottom > 800.0 - 32.0 && bottom <= 800.0, "{right} {bottom}");
    }
    let mut chunks = world.chunks(lod).unwrap();
    chunks.set_viewer(9000.0, 0.0).unwrap();
    assert!(chunks.wanted().is_empty(), "the world is out of sight");
    let outside = ChunkId { level: 0, y: 0, x: -1 };
    let error = sampler.window(&chunks.window(outside)).unwrap_err().to_string();
    assert!(error.contains("not inside the world, which at a cell of 8 m has samples (0, 0) to (120, 100)"), "{error}");
}

#[test]
fn positions_that_are_none_are_said() {
    let mut chunks = Chunks::new(RINGS, None).unwrap();
    chunks.set_viewer(5.0, 5.0).unwrap();
    let before = chunks.wanted().to_vec();
    for (x, said) in [(f64::NAN, "finite"), (f64::INFINITY, "finite"), (1e300, "2^52 cells of 2 m")] {
        let error = chunks.set_viewer(x, 0.0).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    assert_eq!(chunks.wanted(), before);
    for far in [9e15, -9e15] {
        chunks.set_viewer(far, -far).unwrap();
        assert!(chunks.wanted().len() > 50);
    }
}

#[test]
fn any_number_of_threads_makes_the_same_chunks() {
    let world = Arc::new(open(&recipe_of(&Node::named("blur").unwrap(), WorldSpec::default(), false), 1));
    let sampler = Sampler::new(Arc::clone(&world), "height").unwrap();
    let mut one = BTreeMap::new();
    let mut chunks = world.chunks(RINGS).unwrap();
    chunks.set_viewer(-400.0, 300.0).unwrap();
    while let Some(id) = chunks.take() {
        one.insert(id, sampler.window(&chunks.window(id)).unwrap());
    }
    let mut chunks = world.chunks(RINGS).unwrap();
    chunks.set_viewer(-400.0, 300.0).unwrap();
    let (chunks, made) = (Mutex::new(chunks), Mutex::new(BTreeMap::new()));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                loop {
                    let Some((id, window)) = ({
                        let mut chunks = chunks.lock().unwrap();
                        chunks.take().map(|id| (id, chunks.window(id)))
                    }) else {
                        return;
                    };
                    made.lock().unwrap().insert(id, sampler.window(&window).unwrap());
                    chunks.lock().unwrap().done(id);
                }
            });
        }
    });
    assert_eq!(one, made.into_inner().unwrap());
}

#[test]
fn bands_of_rows_are_the_window_in_little_memory() {
    let recipe = recipe_of(&Node::named("blur").unwrap(), world_of(10.0), true);
    let whole_window = Window::new(900, 700, 1.0).at(31, 17);
    let whole = open(&recipe, 2).window("height", &whole_window).unwrap();
    // The 900 x 700 samples alone take 2.4 MiB.
    for (memory, beside, threads) in [(4 << 20, 0, 1), (8 << 20, 1 << 20, 2)] {
        let options = Options { threads: Some(threads), memory: Budget::of(memory), ..Options::default() };
        let world = World::with_options(recipe.clone(), options).unwrap();
        let mut rows = 0;
        for band in world.bands(&["height"], &whole_window, beside, &Progress::none()).unwrap() {
            let band = band.unwrap().remove(0);
            assert_eq!((band.width(), band.window().y), (900, 17 + rows as i64));
            assert_eq!(whole.crop(band.window()).unwrap(), band);
            rows += band.height();
        }
        assert_eq!(rows, 700);
        let error = world.bands(&["height"], &whole_window, memory, &Progress::none()).err().unwrap().to_string();
        assert!(error.contains("making 4 rows at a time needs up to"), "{error}");
    }
}
