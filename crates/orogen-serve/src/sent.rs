//! Limits of recipes that clients send.

use orogen::grid::{hex, words};
use orogen::{Error, ErrorKind, Recipe, Registry, Result, Window, World};
use sha2::{Digest, Sha256};

/// The option that allows them.
pub const OPTION: &str = "allow-recipes";

/// Digits of the name of a world, which is the beginning of the SHA-256 hash of its text.
const DIGITS: usize = 32;

/// Maximum length of the text, in bytes.
pub const MAX_BYTES: usize = 256 << 10;

/// Maximum number of nodes, also with those of the presets that it uses.
pub const MAX_NODES: usize = 512;

/// Maximum number of inputs of all nodes together, and of outputs, with which a world is still opened at once.
const MAX_INPUTS: usize = 2048;
const MAX_OUTPUTS: usize = 64;

/// Recipes that are kept.
pub const MAX_KEPT: usize = 16;

/// Maximum number of samples of a request.
pub const MAX_SAMPLES: usize = 1 << 22;

/// Maximum memory of a tile of a layer, with the solution of the world that it needs: without a memory limit of the
/// server in bytes, otherwise its share.
const MEMORY: u64 = 1 << 30;
const MEMORY_SHARE: u64 = 4;

/// Maximum time of a tile, as it is estimated for all threads together, in seconds.
const MAX_SECONDS: f64 = 60.0;

/// Samples along the side of a tile.
const SIDE: usize = 256;

/// The name of the world of a recipe.
pub fn name(text: &str) -> String {
    hex::encode(&Sha256::digest(text))[..DIGITS].to_string()
}

/// Whether a name in a path is that of such a world, also if it is not kept any more.
pub fn is_name(name: &str) -> bool {
    name.len() == DIGITS && name.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// Reads the text of a recipe. It cannot name files, so none is ever read for it.
///
/// # Errors
/// If it is not valid, or too large: all diagnostics at once, with their places.
pub fn read(text: &str) -> Result<Recipe> {
    let recipe = Registry::new().parse_without_files(text, "recipe", MAX_NODES)?;
    let inputs: usize = recipe.nodes().iter().map(|named| named.node.inputs().len()).sum();
    for (what, count, most) in
        [("inputs of nodes", inputs, MAX_INPUTS), ("outputs", recipe.outputs().count(), MAX_OUTPUTS)]
    {
        if count > most {
            let message = format!("the recipe has {count} {what}; recipes of clients have at most {most}");
            return Err(Error::new(ErrorKind::Recipe, message));
        }
    }
    Ok(recipe)
}

/// Checks that a tile of each layer takes neither too much memory nor too much time.
///
/// # Errors
/// If one does.
pub fn check(world: &World) -> Result<()> {
    let spec = &world.recipe().world;
    let whole = match spec.size {
        Some(_) => world.full_window(spec.cell)?,
        None => Window::new(SIDE, SIDE, spec.cell),
    };
    let window = Window::new(whole.width.min(SIDE), whole.height.min(SIDE), spec.cell);
    let most = world.budget().limit().map_or(MEMORY, |limit| MEMORY.min(limit / MEMORY_SHARE));
    for layer in world.recipe().outputs() {
        // Without a limit nothing of it goes to the disk.
        let plan = world.plan_within(&[layer], &window, None)?;
        let instead = "use a smaller world, or a larger cell of the world or of the nodes that solve it";
        let needed = world.memory_of(&plan)?;
        if needed > most {
            let [needed, most] = [needed, most].map(words::bytes);
            let message = format!(
                "a tile of the layer `{layer}` needs up to {needed} of memory, and recipes of clients may have {most}; {instead}"
            );
            return Err(Error::new(ErrorKind::Memory, message));
        }
        let seconds = world.work(&plan)? / 1e9 / world.threads() as f64;
        if seconds > MAX_SECONDS {
            let message = format!(
                "a tile of the layer `{layer}` takes about {} s, and recipes of clients may take {MAX_SECONDS} s; {instead}",
                words::number(seconds.round())
            );
            return Err(Error::new(ErrorKind::Memory, message));
        }
    }
    Ok(())
}
