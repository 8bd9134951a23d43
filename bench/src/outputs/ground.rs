//! The ground that outputs are made of: ten octaves of fBm, 3000 m from low to high.

use orogen::{Grid, Recipe, Window, World};

/// Metres from one sample to the next.
pub const CELL: f64 = 30.0;

/// A square of it.
pub fn ground(side: usize) -> Result<Grid, String> {
    let text = "orogen = 1\n[world]\nseed = 3\n[nodes.noise]\nop = \"fbm\"\nwavelength = 20000\noctaves = 10\n\
                [nodes.ground]\nop = \"remap\"\nsource = \"noise\"\nto = [0, 3000]\n[outputs]\nheight = \"ground\"\n";
    let world = Recipe::parse(text, "ground").and_then(World::open).map_err(|e| e.to_string())?;
    world.window("height", &Window::new(side, side, CELL)).map_err(|e| e.to_string())
}
