//! A recipe built in code: nodes are plain structs, connected by names; the compiler checks their types.
//!
//! `cargo run --release --example recipe_in_code`

use orogen::field::{Add, Edge, Fbm, Multiply, Remap};
use orogen::solver::Normalise;
use orogen::{Recipe, World, WorldSpec};

fn main() -> Result<(), orogen::Error> {
    let mut recipe = Recipe::new(WorldSpec::default().with_seed(7).with_size(Some([8192.0, 8192.0])).with_cell(16.0));
    recipe.about = "An island made in code".to_string();
    recipe
        .add("hills", Fbm { wavelength: 2500.0, octaves: 8, ..Fbm::default() })
        .add("land", Remap { source: "hills".into(), to: [0.2, 1.0], ..Remap::default() })
        .add("coast", Edge { width: 2500.0, ..Edge::default() })
        .add("island", Multiply { a: "land".into(), b: "coast".into() })
        .add("raised", Add { a: "island".into(), b: (-0.2).into() })
        .add("height", Normalise { source: "raised".into(), low: -150.0, high: 620.0, ..Normalise::default() })
        .output("height", "height");

    // The same recipe as a TOML document, which `orogen generate` reads.
    println!("{}", recipe.to_toml());

    let world = World::open(recipe)?;
    let grid = world.window("height", &world.full_window(64.0)?)?;
    for j in (0..grid.height()).step_by(8) {
        let row: String = (0..grid.width())
            .step_by(4)
            .map(|i| match grid[(i, j)] {
                height if height <= 0.0 => '~',
                height if height < 120.0 => '.',
                height if height < 300.0 => 'o',
                _ => '^',
            })
            .collect();
        println!("{row}");
    }
    Ok(())
}
