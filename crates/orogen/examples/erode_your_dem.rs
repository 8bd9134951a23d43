//! Erosion of a file of heights: as a node of a recipe, and on a grid in memory.
//!
//! `cargo run --release --example erode_your_dem -- alps.tif`

use orogen::filter::Thermal;
use orogen::grid::erosion;
use orogen::{Export, Progress, Window, World};

fn main() -> orogen::Result<()> {
    // Without an argument, a part of a preset replaces the real place.
    let path = std::env::args().nth(1).unwrap_or_else(|| "place.tif".to_owned());
    if path == "place.tif" {
        orogen::open("alpine")?.export("height", &Window::new(256, 256, 30.0).at(900, 900), &path)?;
    }
    let place = orogen::open(&path)?;
    let window = place.full_window(place.recipe().world.cell)?;

    // The file is the node `place`. The world keeps the map and the coordinate system of the file.
    let mut recipe = place.recipe().clone();
    recipe
        .add("settled", Thermal { source: "place".into(), talus_angle: 27.0, ..Thermal::default() })
        .output("settled", "settled");
    World::open(recipe)?.export("settled", &window, "settled.tif")?;

    // The same process on a grid. A process that reads neighbors needs ground beyond the edges: `padded` repeats the
    // samples there, so that the result is as large as the heights.
    let heights = place.window("height", &window)?;
    let passes = 40;
    let settled = erosion::Thermal::new(0.5).run(&heights.padded(passes), passes, &Progress::none())?;
    assert_eq!(settled.window(), heights.window());
    let moved: f64 = heights.data().iter().zip(settled.data()).map(|(a, b)| f64::from((a - b).abs())).sum();
    println!("settled.tif; heights changed by {:.2} m on average", moved / heights.data().len() as f64);
    Ok(())
}
