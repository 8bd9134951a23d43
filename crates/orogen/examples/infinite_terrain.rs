//! Unbounded terrain: a viewer walks 10 km; chunks around it are loaded and unloaded, and are coarser in the distance.
//!
//! `cargo run --release --example infinite_terrain` prints the state after each kilometre and writes the last view to
//! `infinite_terrain.png`.

use orogen::io::file::{OutputPolicy, write_whole};
use orogen::output::map::Painter;
use orogen::output::map::canvas::Canvas;
use orogen::{ChunkId, ChunkStep, Grid, LodConfig, Recipe, Sampler, Window, World};
use std::collections::HashMap;
use std::path::Path;

/// A world without a `size` is unbounded. Plains with scattered mountains.
const RECIPE: &str = r#"
    orogen = 1
    world = { seed = 11 }
    outputs = { height = "land" }
    nodes.rolling  = { op = "fbm", seed = 1, wavelength = 5000, octaves = 10 }
    nodes.plains   = { op = "remap", source = "rolling", to = [0, 500] }
    nodes.crests   = { op = "ridged", seed = 2, wavelength = 4000, octaves = 9, gain = 0.45 }
    nodes.peaks    = { op = "remap", source = "crests", to = [200, 1600] }
    nodes.regions  = { op = "perlin", seed = 3, wavelength = 11000 }
    nodes.mountain = { op = "curve", source = "regions", points = [[-0.3, 0], [0.5, 1]] }
    nodes.land     = { op = "mix", a = "plains", b = "peaks", amount = "mountain" }
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let world = World::open(Recipe::parse(RECIPE, "infinite_terrain")?)?;
    let ground = Sampler::new(&world, "height")?;
    // Chunks of 64 x 64 cells: 1 m near the viewer, 32 m at the horizon.
    let mut chunks = world.chunks(LodConfig::default().with_range(6000.0))?;
    let mut scene: HashMap<ChunkId, Grid> = HashMap::new();

    let (mut made, mut dropped) = (0, 0);
    for metres in (0..=10_000).step_by(10) {
        let (x, y) = walk(f64::from(metres));
        chunks.set_viewer(x, y)?;
        while let Some(step) = chunks.next_step() {
            match step {
                // A game would build a mesh here, on any thread; `chunks.coarser(id)` returns the sides that need
                // stitching.
                ChunkStep::Make(id) => {
                    scene.insert(id, ground.window(&chunks.window(id))?);
                    made += 1;
                }
                ChunkStep::Drop(id) => {
                    scene.remove(&id);
                    dropped += 1;
                }
            }
        }
        if metres % 1000 == 0 {
            let feet = ground.at(x, y)?;
            println!(
                "{:2} km: feet at {feet:4.0} m, {} chunks, {made} made, {dropped} dropped",
                metres / 1000,
                scene.len()
            );
            (made, dropped) = (0, 0);
        }
    }
    draw(&scene, chunks.lod(), Path::new("infinite_terrain.png"))?;
    Ok(())
}

/// The position of the viewer after a distance in metres: a winding path to the south-east.
fn walk(metres: f64) -> (f64, f64) {
    let turn = (metres / 2500.0).fract() * 2.0 - 1.0;
    (metres * 0.8 + 600.0 * (1.0 - turn * turn), metres * 0.6)
}

/// Draws the ground around the viewer as a map: each pixel from the chunk that covers it, with outlined chunks.
fn draw(scene: &HashMap<ChunkId, Grid>, lod: &LodConfig, path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    const PIXELS: usize = 900;
    let (x, y) = walk(10_000.0);
    let cell = 2.0 * lod.range / PIXELS as f64;
    let first = |middle: f64| ((middle - lod.range) / cell) as i64;
    let window = Window::new(PIXELS, PIXELS, cell).at(first(x), first(y));
    let mut heights = Grid::filled(window, 0.0);
    let mut cover = vec![None; window.len()];
    for (j, i) in (0..PIXELS).flat_map(|j| (0..PIXELS).map(move |i| (j, i))) {
        let Some((id, height)) = sample(scene, lod, window.east(i), window.south(j)) else { continue };
        heights.row_mut(j)[i] = height;
        cover[j * PIXELS + i] = Some(id);
    }
    let painter = Painter::fit(&heights, 0.0);
    let mut page = Canvas::new(PIXELS, PIXELS, [255; 3]);
    let mut colors = [0; 3 * (PIXELS - 2)];
    for j in 1..PIXELS - 1 {
        painter.row([heights.row(j - 1), heights.row(j), heights.row(j + 1)], cell, &mut colors);
        for (i, color) in (1..).zip(colors.chunks_exact(3)) {
            let here = cover[j * PIXELS + i];
            let outline = here != cover[j * PIXELS + i - 1] || here != cover[(j - 1) * PIXELS + i];
            page.set(i as i64, j as i64, [color[0], color[1], color[2]]);
            page.cover(i as i64, j as i64, [0; 3], if outline { 0.5 } else { 0.0 });
        }
    }
    for metres in 0..10_000 {
        let (x, y) = walk(f64::from(metres));
        let pixel = |at: f64, first: i64| (at / cell) as i64 - first;
        page.set(pixel(x, window.x), pixel(y, window.y), [200, 0, 0]);
    }
    write_whole(&OutputPolicy::default().output(path)?, |out| {
        page.write_png(out, &[("Title", "Chunks around a viewer")])
    })?;
    println!("{} shows {:.0} km of ground, the walk in red", path.display(), 2.0 * lod.range / 1000.0);
    Ok(())
}

/// Returns the finest loaded chunk at a position, and its height there.
fn sample(scene: &HashMap<ChunkId, Grid>, lod: &LodConfig, x: f64, y: f64) -> Option<(ChunkId, f32)> {
    let mut id = ChunkId { level: 0, x: (x / lod.side(0)).floor() as i64, y: (y / lod.side(0)).floor() as i64 };
    while id.level < lod.levels {
        if let Some(grid) = scene.get(&id) {
            let window = grid.window();
            let (column, row) = (x / window.cell - window.x as f64, y / window.cell - window.y as f64);
            let (i, j) = ((column as usize).min(lod.cells - 1), (row as usize).min(lod.cells - 1));
            let (right, down) = (column as f32 - i as f32, row as f32 - j as f32);
            let along = |j: usize| grid[(i, j)] * (1.0 - right) + grid[(i + 1, j)] * right;
            return Some((id, along(j) * (1.0 - down) + along(j + 1) * down));
        }
        id = id.parent();
    }
    None
}
