//! The terrain of the outputs: ten octaves of fBm with a relief of 3000 m.

use orogen::{Grid, Recipe, Window, World};

/// Distance between samples, in metres.
pub const CELL: f64 = 30.0;

/// A square of the terrain.
pub fn ground(side: usize) -> Result<Grid, String> {
    let text = "orogen = 1\n[world]\nseed = 3\n[nodes.noise]\nop = \"fbm\"\nwavelength = 20000\noctaves = 10\n\
                [nodes.ground]\nop = \"remap\"\nsource = \"noise\"\nto = [0, 3000]\n[outputs]\nheight = \"ground\"\n";
    let world = Recipe::parse(text, "ground").and_then(World::open).map_err(|e| e.to_string())?;
    world.window("height", &Window::new(side, side, CELL)).map_err(|e| e.to_string())
}
