//! Networks for learned detail: any bytes are a network or refused with a message. With the hash of its weights put
//! right, too; and what is read refines land without a panic.

use orogen_grid::grid::{Grid, Window};
use orogen_grid::learned::{Draw, Network};
use orogen_grid::progress::Progress;
use sha2::{Digest, Sha256};

/// Runs the target on an input.
pub fn run(input: &[u8]) {
    for file in [Some(input.to_vec()), with_hash(input)].into_iter().flatten() {
        let Ok(network) = Network::parse(&file) else { continue };
        let window = Window::new(3, 2, 45.0).at(-1, 4);
        let side = 4 + 2 * network.halo();
        let halo = network.halo() as i64;
        let mut coarse = Grid::filled(Window::new(side, side, 90.0).at(-1 - halo, 2 - halo), 0.0);
        coarse.data_mut().iter_mut().enumerate().for_each(|(at, height)| *height = (at * at % 97) as f32);
        let draw = Draw { seed: 1, level: 1, noise: 1.0 };
        let made = network.refine(&coarse, &window, &draw, &Progress::none()).unwrap();
        assert_eq!(made.window(), &window);
        assert!(network.scratch(side, side) > 0);
    }
}

/// The file with the hash that its weights have.
fn with_hash(file: &[u8]) -> Option<Vec<u8>> {
    let body = file.windows(2).position(|pair| pair == b"\n\n")? + 2;
    let header = std::str::from_utf8(&file[..body]).ok()?;
    let at = header.find("sha256 ")? + "sha256 ".len();
    let line = header[at..].find('\n')?;
    let hash: String = Sha256::digest(&file[body..]).iter().map(|byte| format!("{byte:02x}")).collect();
    Some([&file[..at], hash.as_bytes(), &file[at + line..]].concat())
}
