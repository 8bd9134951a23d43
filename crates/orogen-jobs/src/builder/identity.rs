//! The identity of a build: everything that its bytes depend on.

use serde::{Deserialize, Serialize};

use super::spec::BuildSpec;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::{hex, words};
use orogen_io::format::dem::Georeference;
use sha2::{Digest, Sha256};

/// Everything that the bytes of a result depend on. The number of threads and the memory limit are not part of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// The program's version, because other versions may produce different terrain or files.
    pub version: String,
    /// The form of the result: "cog", "zarr", ...
    pub form: String,
    /// SHA-256 over the nodes of the layers, in hexadecimal digits. Names of nodes and comments are not included.
    pub recipe: String,
    /// The layers.
    pub layers: Vec<String>,
    /// The unit of each layer, or empty.
    pub units: Vec<String>,
    /// The window.
    pub window: Window,
    /// Side of a tile, in samples.
    pub tile: usize,
    /// The position of metres on a map, if the world has one.
    #[serde(default)]
    pub map: Option<Georeference>,
}

impl Identity {
    /// The identity of a build whose tile side is known.
    ///
    /// # Errors
    /// If the world does not have one of the layers.
    pub fn of(world: &World, spec: &BuildSpec, tile: usize) -> Result<Identity> {
        let mut hash = Sha256::new();
        let mut units = Vec::new();
        for layer in &spec.layers {
            hash.update(world.key(layer)?);
            units.push(world.unit(layer)?.to_string());
        }
        Ok(Identity {
            version: env!("CARGO_PKG_VERSION").to_string(),
            form: spec.form.name().to_string(),
            recipe: hex::encode(&hash.finalize()),
            layers: spec.layers.clone(),
            units,
            window: spec.window,
            tile,
            map: world.recipe().georeference(),
        })
    }

    /// What `begun` differs in, as text to follow "it was begun"; `None` if the two are the same.
    pub fn difference(&self, begun: &Identity) -> Option<String> {
        let window = |window: &Window| {
            let Window { x, y, width, height, cell } = window;
            format!("{width} x {height} samples at ({x}, {y}) with a cell of {cell} m")
        };
        let layers = |layers: &[String]| words::list(layers.iter().map(String::as_str));
        let say = |theirs: String, ours: String| Some(format!("{theirs}, not {ours}"));
        if begun.version != self.version {
            return say(format!("by orogen {}", begun.version), self.version.clone());
        }
        if begun.form != self.form {
            return say(format!("as {}", begun.form), format!("as {}", self.form));
        }
        if begun.layers != self.layers {
            return say(format!("for {}", layers(&begun.layers)), format!("for {}", layers(&self.layers)));
        }
        if begun.window != self.window {
            return say(format!("over {}", window(&begun.window)), window(&self.window));
        }
        if begun.tile != self.tile {
            return say(format!("with tiles of {}", begun.tile), self.tile.to_string());
        }
        if begun.map != self.map {
            return Some("elsewhere on the map".to_string());
        }
        (begun.recipe != self.recipe).then(|| {
            let short = |hash: &str| hash.get(..12).unwrap_or(hash).to_string();
            format!(
                "from another recipe or seed (its hash is {}, this one's {})",
                short(&begun.recipe),
                short(&self.recipe)
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_difference_has_its_sentence() {
        let ours = Identity {
            version: "1.2.3".into(),
            form: "zarr".into(),
            recipe: "aa".into(),
            layers: vec!["height".into()],
            units: vec!["m".into()],
            window: Window::new(5, 6, 10.0),
            tile: 512,
            map: None,
        };
        assert_eq!(ours.difference(&ours), None);
        for (begun, expect) in [
            (Identity { version: "1.2.2".into(), ..ours.clone() }, "by orogen 1.2.2, not 1.2.3"),
            (Identity { form: "cog".into(), ..ours.clone() }, "as cog, not as zarr"),
            (
                Identity { layers: vec!["sea".into(), "b".into()], ..ours.clone() },
                "for `sea` and `b`, not for `height`",
            ),
            (
                Identity { window: Window::new(5, 7, 10.0).at(-1, 0), ..ours.clone() },
                "over 5 x 7 samples at (-1, 0) with a cell of 10 m, not 5 x 6 samples at (0, 0) with a cell of 10 m",
            ),
            (Identity { tile: 256, ..ours.clone() }, "with tiles of 256, not 512"),
            (
                Identity { recipe: "bb".into(), ..ours.clone() },
                "from another recipe or seed (its hash is bb, this one's aa)",
            ),
        ] {
            assert_eq!(ours.difference(&begun).as_deref(), Some(expect));
        }
    }
}
