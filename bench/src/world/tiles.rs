//! Tiles of 512 with a halo of 32 compared with the whole map at once: CPU time, one thread.

use cpu_time::ProcessTime;
use orogen::tiles::Tiling;
use orogen::{Progress, Window, World};

use super::figure::{Figure, Target};
use super::hills;
use crate::measure::median;
use crate::options::Options;

const TILE: usize = 512;

/// Samples per side: the halo is a sixteenth of a tile's side, and there are 8 x 8 tiles.
const SIDE: usize = 4096;

/// Maximum ratio of the CPU time of tiles that are made one at a time.
const ALONE: f64 = 1.4;
/// Maximum ratio of the CPU time of tiles in a stream that shares halos.
const SHARED: f64 = 1.15;

const LAYER: &str = "stretched";

/// Measures the three ways in turns.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let length = hills::fields()?.world.size.ok_or("`hills` has bounds")?[0];
    let cell = length / SIDE as f64;
    let world = hills::open(hills::with_halo(cell)?, 1)?;
    let window = Window::new(SIDE, SIDE, cell);
    // Solves the world before any timing.
    world.window(LAYER, &Window::new(TILE, TILE, cell)).map_err(|e| e.to_string())?;
    let ways: [fn(&World, &Window) -> orogen::Result<()>; 3] = [whole, alone, shared];
    let mut times = ways.map(|_| Vec::new());
    for _ in 0..options.repetitions.min(5) {
        for (way, times) in ways.iter().zip(&mut times) {
            let start = ProcessTime::now();
            way(&world, &window).map_err(|e| e.to_string())?;
            times.push(start.elapsed().as_secs_f64() * 1e9 / window.len() as f64);
        }
    }
    let [whole, alone, shared] = times.map(|mut times| median(&mut times));
    let figure = |case: &str, ours, most| Figure {
        case: case.to_string(),
        ours,
        unit: "ns/sample",
        other: Some(("whole map", whole)),
        target: Target::RatioAtMost(most),
    };
    Ok(vec![
        figure("tiles of 512, halo 32, each alone, ratio at most", alone, ALONE),
        figure("tiles of 512, halo 32, as a stream, ratio at most", shared, SHARED),
    ])
}

fn whole(world: &World, window: &Window) -> orogen::Result<()> {
    world.window(LAYER, window).map(|_| ())
}

fn alone(world: &World, window: &Window) -> orogen::Result<()> {
    let tiling = Tiling::of(TILE);
    let [columns, rows] = tiling.layout(window);
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        world.window(LAYER, &tiling.tile(window, column, row))?;
    }
    Ok(())
}

fn shared(world: &World, window: &Window) -> orogen::Result<()> {
    // The memory of eight tiles and their halos, as in `build`, instead of the whole map at once.
    let tiling = Tiling { memory: Some(64 << 20), ..Tiling::of(TILE) };
    world.tiles(&[LAYER], window, tiling, &Progress::none())?.try_for_each(|tile| tile.map(|_| ()))
}
