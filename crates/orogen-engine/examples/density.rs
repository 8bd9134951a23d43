//! A density in space: chunks of 16 x 16 columns by 128 metres at random places, with the time for each.

use orogen_engine::{Recipe, Sampler, Window, World};
use std::time::Instant;

const RECIPE: &str = r#"
orogen = 1
[nodes.altitude]
op = "altitude"
[nodes.ground]
op = "fbm"
wavelength = 500
[nodes.caves]
op = "ridged"
wavelength = 40
octaves = 3
vertical = 0.5
[nodes.tunnels]
op = "perlin"
wavelength = 60
vertical = 1
[nodes.density]
op = "expr"
expr = "60 * ground - altitude + 30 * caves + 20 * tunnels"
[outputs]
density = "density"
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let world = World::open(Recipe::parse(RECIPE, "density")?)?;
    let sampler = Sampler::new(&world, "density")?;
    for (side, step, count, altitude_step) in [(16, 1.0, 128, 1.0), (5, 4.0, 33, 4.0)] {
        let altitudes: Vec<f64> = (0..count).map(|k| f64::from(k) * altitude_step - 64.0).collect();
        let mut samples = vec![0.0; side * side * altitudes.len()];
        let mut times: Vec<f64> = (0..500i64)
            .map(|i| {
                let chunk = Window::new(side, side, step).at(i * 7919 % 100_003, -i * 104_729 % 99_991);
                let start = Instant::now();
                sampler.fill_volume(&chunk, &altitudes, &mut samples)?;
                Ok(start.elapsed().as_secs_f64() * 1e3)
            })
            .collect::<Result<_, orogen_engine::Error>>()?;
        times.sort_by(f64::total_cmp);
        println!("{side} x {side} x {count} samples: median {:.3} ms, 99 % {:.3} ms", times[250], times[495]);
    }
    Ok(())
}
