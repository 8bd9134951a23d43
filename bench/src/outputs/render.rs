//! A picture of `alpine` with 1920 x 1080 pixels, of a finished world: wall time on all cores.

use std::hint::black_box;
use std::time::Instant;

use orogen::output::render::{CameraSpec, Land, Scene, Style, View};
use orogen::{Progress, World, presets};

use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

const SIZE: [usize; 2] = [1920, 1080];

/// Layers in the picture of the preset.
const LAYERS: [&str; 3] = ["height", "surface", "flow"];

/// Measures preparation and rendering together.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let told = |error: orogen::Error| error.to_string();
    let preset = presets::find("alpine").ok_or("there is no preset alpine")?;
    let recipe = preset.recipe().map_err(told)?;
    let sea_level = Some(recipe.world.sea_level);
    let world = World::open(recipe).map_err(told)?;
    let progress = Progress::none();
    let window = world.window_fitting(1024).map_err(told)?;
    let grids = world.grids(&LAYERS, &window, &progress).map_err(told)?;
    let [heights, surface, flow] = grids.as_slice() else {
        return Err("alpine has not the layers of a picture".into());
    };
    let land = Land { heights, surface: Some(surface), flow: Some(flow), sea_level };
    let view = View::Around { azimuth: 200.0, elevation: 24.0, distance: None };
    let mut times = Vec::new();
    for _ in 0..options.repetitions {
        let start = Instant::now();
        let scene = Scene::new(&land, &Style::default(), &progress).map_err(told)?;
        let camera = scene.camera(&CameraSpec::new(view, SIZE));
        let mut bytes = vec![0; SIZE[0] * SIZE[1] * 3];
        scene.paint(&camera, SIZE, 0..SIZE[1], &mut bytes, &progress).map_err(told)?;
        black_box(bytes);
        times.push(start.elapsed().as_secs_f64());
    }
    Ok(vec![Figure {
        case: format!(
            "render of {} x {} pixels, soft shadows, alpine {} x {}",
            SIZE[0], SIZE[1], window.width, window.height
        ),
        ours: median(&mut times),
        unit: "s on the wall",
        other: None,
        target: Target::AtMost(5.0),
    }])
}
