//! An op of your own: a filter that a recipe uses by its name.
//!
//! `cargo run --release --example op_of_your_own` writes terraces.png.

use orogen::io::file::{OutputPolicy, write_whole};
use orogen::op::{Context, Filter, GridInputs, only_layer};
use orogen::output::map::Painter;
use orogen::{Grid, Registry, Result, Window, World};
use std::path::Path;

orogen::op! {
    /// Terraces whose edges follow the slope: flat where the ground is gentle, untouched where it is steep.
    ///
    /// Each sample moves towards the next lower multiple of `height`, by a share that falls from 1 on level ground to 0
    /// at the slope `steep`.
    pub struct Terraces = "mygame.terraces", filter, revision 1;
    inputs {
        /// The heights to cut into terraces.
        source: required,
    }
    params {
        /// Height of a terrace.
        height: f64 = 20.0, unit "m", range 1e-3 to 1e5;
        /// Slope (rise over run) at which no terraces are left.
        steep: f64 = 0.8, range 1e-3 to 100.0;
    }
}

impl Filter for Terraces {
    /// The slope of a sample depends on the samples next to it.
    fn halo(&self, _cell: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let (height, steep, run) = (self.height as f32, self.steep as f32, 2.0 * window.cell as f32);
        for j in 0..window.height {
            context.progress.check()?;
            for i in 0..window.width {
                // Sample (i, j) of the window is (i + 1, j + 1) of the source, which has the halo on each side.
                let here = source[(i + 1, j + 1)];
                let east = (source[(i + 2, j + 1)] - source[(i, j + 1)]) / run;
                let south = (source[(i + 1, j + 2)] - source[(i + 1, j)]) / run;
                let share = (1.0 - (east * east + south * south).sqrt() / steep).max(0.0);
                out[(i, j)] = here + ((here / height).floor() * height - here) * share;
            }
        }
        Ok(())
    }
}

/// Built-in ops and a custom one in the same recipe.
const RECIPE: &str = r#"
    orogen = 1
    world = { seed = 7, size = 8000, cell = 20 }
    outputs = { height = "land" }
    nodes.noise = { op = "fbm", wavelength = 3000, octaves = 4, gain = 0.35 }
    nodes.hills = { op = "normalise", source = "noise", low = 0, high = 900 }
    nodes.where = { op = "ramp", origin = [3500, 0], length = 1000, azimuth = 90 }
    nodes.land  = { op = "mygame.terraces", source = "hills", height = 75, steep = 1.5, mask = "where" }
"#;

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let mut registry = Registry::new();
    registry.register::<Terraces>()?;
    let world = World::open(registry.parse(RECIPE, "op_of_your_own")?)?;

    let window = world.full_window(10.0)?;
    let grid = world.window("height", &window)?;
    let painter = Painter::fit(&grid, world.recipe().world.sea_level);
    write_whole(&OutputPolicy::default().output(Path::new("terraces.png"))?, |out| {
        painter.write_png(out, &grid, None, &[("Title", "Terraces")])
    })?;
    let level = grid.data().iter().filter(|height| (*height / 75.0).fract() < 0.02).count();
    println!(
        "terraces.png holds {} x {} samples; {} % lie on a terrace",
        grid.width(),
        grid.height(),
        100 * level / grid.data().len()
    );
    Ok(())
}

#[test]
fn it_obeys_the_laws() {
    let violations =
        orogen::laws::Laws::of(|cell| Terraces { height: 0.2, steep: 0.1 / cell, ..Terraces::default() }).check();
    assert!(violations.is_empty(), "{violations:#?}");
}
