//! A window of a preset as files: any part at any resolution, sampled from the same terrain.
//!
//! `cargo run --release --example preset_to_file`

use orogen::{Export, Window};

fn main() -> orogen::Result<()> {
    let world = orogen::open("alpine")?;

    // 20 km by 15 km around the middle, one sample every 25 m: sample (0, 0) of the window is sample (820, 930) of the
    // world's grid. The extension determines the format.
    let window = Window::new(800, 600, 25.0).at(820, 930);
    for (layer, file) in [("height", "alpine.tif"), ("height", "alpine.png"), ("hillshade", "hillshade.png")] {
        world.export(layer, &window, file)?;
        println!("{file} holds {} x {} samples of {layer}", window.width, window.height);
    }
    Ok(())
}
