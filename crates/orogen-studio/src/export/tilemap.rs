//! A map of tiles.

use orogen::autotile::mask::Layout;
use orogen::recipe::class::document::CLASS;
use orogen::tilemap::art::set::SETS;
use orogen::tilemap::files::SIDE;
use orogen::tilemap::job::TilemapJob;
use orogen::tilemap::tileset_source;
use orogen::world::HEIGHT;
use orogen::{Result, WorldSpec};

use super::command_line::CommandLine;
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// The choices of a map of tiles.
#[derive(Debug, Clone)]
pub struct TilemapExport {
    /// The tileset: a name of the program's own, or a file.
    pub tileset: String,
    /// The wang set of a .tsx that has several; empty for its only one.
    pub wang_set: String,
    /// How tiles follow their surroundings; that of the tileset if `None`.
    pub layout: Option<Layout>,
    /// Cells along the longer side.
    pub size: usize,
    /// Whether maps for Tiled are infinite.
    pub is_infinite: bool,
}

impl Default for TilemapExport {
    fn default() -> TilemapExport {
        TilemapExport {
            tileset: SETS[0].name.into(),
            wang_set: String::new(),
            layout: None,
            size: SIDE,
            is_infinite: false,
        }
    }
}

impl TilemapExport {
    fn samples(&self, region: Region, world: &WorldSpec) -> Samples {
        Samples::of(region, Some(self.size), world)
    }

    /// Adds the options of `orogen tilemap`.
    pub fn words(&self, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        match self.samples(region, world) {
            Samples::Fitting(SIDE) => {}
            samples => samples.sized(line),
        }
        line.differing("tileset", self.tileset.as_str(), &SETS[0].name);
        line.differing("wang-set", self.wang_set.as_str(), &"");
        if let Some(layout) = self.layout {
            line.option("layout", layout.name());
        }
        if self.is_infinite {
            line.flag("infinite");
        }
    }

    /// Makes the files. Returns a description.
    ///
    /// # Errors
    /// If there is no such tileset, or the export fails; then there are no files, or those which were there.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        let wang_set = Some(self.wang_set.as_str()).filter(|name| !name.is_empty());
        let tileset = tileset_source::find(&self.tileset, self.layout, wang_set)?;
        work.inputs.extend(tileset.files);
        let job = TilemapJob::new(tileset.tileset).with_infinite(self.is_infinite);
        let layer = if work.recipe.outputs().any(|name| name == CLASS) { CLASS } else { HEIGHT };
        // The classes of a recipe without any depend on the cell of the map.
        let window = self.samples(region, &work.recipe.world).window(&work.open()?)?;
        job.prepare(&mut work.recipe, window.cell)?;
        let world = work.open()?;
        let written = job.to_folder(&world, &window, layer, (&work.path, &work.policy()), work.progress)?;
        // The dialog names the folder itself.
        let (words, folder) = (written.words(), format!("{}: ", work.path.display()));
        Ok(lines(words.strip_prefix(&folder).unwrap_or(&words), written.warning))
    }
}
