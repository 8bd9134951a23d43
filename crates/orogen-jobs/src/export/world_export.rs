//! Exports of a world in one call.

use super::job::ExportJob;
use super::registry;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::file::OutputPolicy;
use std::path::Path;

/// Exports of worlds: `world.export("height", &window, "land.tif")`.
pub trait Export {
    /// Exports a layer over a window to a file and its sidecars. The extension of the file determines the format, as on
    /// the command line: GeoTIFF, PNG, `.npy`, glTF and others. The layer is an output of the recipe, `node.layer`, or
    /// a layer derived from the heights, such as `hillshade`; formats of vector features also accept `contours`,
    /// `rivers` and others.
    ///
    /// The file is written atomically. An existing file of the same kind is replaced, unless it is a file that the
    /// world reads or a hand-written recipe. For options, progress and streams use an [`ExportJob`].
    ///
    /// # Errors
    /// If no format has this extension, there is no such layer, the world cannot make the window, or the file cannot be
    /// written or replaced.
    fn export(&self, layer: &str, window: &Window, path: impl AsRef<Path>) -> Result<()>;
}

impl Export for World {
    fn export(&self, layer: &str, window: &Window, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let job = ExportJob::new(registry::of_path(path)?).with_layer(layer).with_window(*window);
        let output = OutputPolicy::default().protecting(self.recipe().files()).output(path)?;
        let mut recipe = self.recipe().clone();
        job.prepare(&mut recipe)?;
        // Some derived layers are made by nodes that the opened world does not have.
        let prepared = match recipe.nodes().len() == self.recipe().nodes().len() {
            true => None,
            false => Some(self.session().open(recipe)?),
        };
        job.to_file(prepared.as_ref().unwrap_or(self), &output, &Progress::none()).map(drop)
    }
}
