//! Columns for a block game: chunks of 16 x 16 columns, each with the height of its ground and its top material.
//!
//! `cargo run --release --example block_columns` prints chunks as seen from above.

use orogen::{Recipe, Sampler, Window, World};

/// The cell is 1 m, so a sample is a block. Valleys below sea level, hills, and mountains where a second noise selects
/// them.
const RECIPE: &str = r#"
    orogen = 1
    world = { seed = 4, sea_level = 62 }
    outputs = { height = "land" }
    nodes.rolling  = { op = "fbm", seed = 1, wavelength = 130, octaves = 6 }
    nodes.hills    = { op = "remap", source = "rolling", from = [-0.5, 0.5], to = [42, 88] }
    nodes.crests   = { op = "ridged", seed = 2, wavelength = 120, octaves = 5 }
    nodes.peaks    = { op = "remap", source = "crests", from = [-0.2, 0.8], to = [60, 150] }
    nodes.regions  = { op = "perlin", seed = 3, wavelength = 220 }
    nodes.mountain = { op = "curve", source = "regions", points = [[-0.1, 0], [0.3, 1]] }
    nodes.land     = { op = "mix", a = "hills", b = "peaks", amount = "mountain" }
"#;

const SIDE: usize = 16;
const SEA: f32 = 62.0;

#[derive(Clone, Copy)]
enum Block {
    Water,
    Sand,
    Grass,
    Stone,
    Snow,
}

/// One column: the uppermost solid block and its material (the depth of water follows from the height).
#[derive(Clone, Copy)]
struct Column {
    height: i32,
    top: Block,
}

/// Returns the columns of the chunk at (`east`, `south`), in chunks. The result does not depend on order or threads.
fn columns(ground: &Sampler<World>, east: i64, south: i64) -> orogen::Result<[[Column; SIDE]; SIDE]> {
    // One more column on each side, for the slope at the border of the chunk.
    let chunk = Window::new(SIDE, SIDE, 1.0).at(east * SIDE as i64, south * SIDE as i64);
    let heights = ground.window(&chunk.grown(1))?;
    let column = |i: usize, j: usize| {
        let height = heights[(i + 1, j + 1)];
        let rise_east = heights[(i + 2, j + 1)] - heights[(i, j + 1)];
        let rise_south = heights[(i + 1, j + 2)] - heights[(i + 1, j)];
        let slope = 0.5 * (rise_east * rise_east + rise_south * rise_south).sqrt();
        let top = match height {
            height if height < SEA => Block::Water,
            _ if slope > 1.0 => Block::Stone,
            height if height < SEA + 2.0 => Block::Sand,
            height if height < 115.0 => Block::Grass,
            _ => Block::Snow,
        };
        Column { height: height.floor() as i32, top }
    };
    Ok(std::array::from_fn(|j| std::array::from_fn(|i| column(i, j))))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ground = Sampler::new(World::open(Recipe::parse(RECIPE, "block_columns")?)?, "height")?;
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for south in -1..2 {
        let chunks = (-3..4).map(|east| columns(&ground, east, south)).collect::<orogen::Result<Vec<_>>>()?;
        for j in 0..SIDE {
            let row = chunks.iter().flat_map(|chunk| chunk[j]);
            let line = row.map(|Column { height, top }| {
                (lowest, highest) = (lowest.min(height), highest.max(height));
                match top {
                    Block::Water => '~',
                    Block::Sand => '.',
                    Block::Grass => '"',
                    Block::Stone => '#',
                    Block::Snow => '*',
                }
            });
            println!("{}", line.collect::<String>());
        }
    }
    println!("21 chunks; columns from {lowest} to {highest} blocks high, the sea at {SEA}");
    Ok(())
}
