//! A window of a world as an image: any part at any resolution, sampled from the same terrain.
//!
//! `cargo run --release --example window_to_image`

use orogen::file::{OutputPolicy, write_whole};
use orogen::map::paint::Painter;
use orogen::{Window, World, presets};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let preset = presets::find("alpine").ok_or("there is no such preset")?;
    let world = World::open(preset.recipe()?)?;
    let sea_level = world.recipe().world.sea_level;

    // 20 km by 15 km around the middle, one sample every 25 m: sample (0, 0) of the window is sample (820, 930) of the
    // grid.
    let window = Window::new(800, 600, 25.0).at(820, 930);
    let grid = world.window("height", &window)?;

    let path = Path::new("window.png");
    let painter = Painter::fit(&grid, sea_level);
    write_whole(&OutputPolicy::default().output(path)?, |out| {
        painter.write_png(out, &grid, None, &[("Title", "A window of alpine")])
    })?;
    println!("{} holds {} x {} samples", path.display(), grid.width(), grid.height());
    Ok(())
}
