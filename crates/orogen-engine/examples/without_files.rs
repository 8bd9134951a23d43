//! A world on a host without a file system: `cargo run -p orogen-engine --example without_files --no-default-features`.
//!
//! Terrain is made in memory, solutions are kept in memory for later sessions, and a recipe that names a file is
//! refused with the reason.

use orogen_engine::{ErrorKind, MemoryStore, Options, Recipe, Session, Window};
use std::error::Error;
use std::sync::Arc;

const RECIPE: &str = r#"
    orogen = 1

    [world]
    size = [4000.0, 4000.0]
    cell = 20.0

    [nodes.noise]
    op = "fbm"
    wavelength = 1500.0

    [nodes.land]
    op = "normalise"
    source = "noise"
    high = 900.0

    [outputs]
    height = "land"
"#;

const WITH_A_FILE: &str = r#"
    orogen = 1

    [nodes.land]
    op = "dem"
    path = "land.tif"

    [outputs]
    height = "land"
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let store = Arc::new(MemoryStore::new(64 << 20));
    for solved in [1, 0] {
        let session = Session::new(Options { store: Some(store.clone()), ..Options::default() })?;
        let tile = session.open(Recipe::parse(RECIPE, "land.toml")?)?.window("height", &Window::new(200, 200, 20.0))?;
        let highest = tile.data().iter().copied().fold(f32::MIN, f32::max);
        println!("{highest} m, {} solutions made", session.solutions_made());
        if session.solutions_made() != solved {
            return Err("the second session finds what the first one has solved".into());
        }
    }
    let error = Session::new(Options::default())?.open(Recipe::parse(WITH_A_FILE, "file.toml")?).err();
    match error {
        Some(error) if error.kind() == ErrorKind::File => println!("{error}"),
        other => return Err(format!("a recipe that names a file is refused, not {other:?}").into()),
    }
    Ok(())
}
