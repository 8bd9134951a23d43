//! A rendered picture.

use orogen::jobs::RenderJob;
use orogen::{Result, WorldSpec};

use super::command_line::CommandLine;
use super::given::{self, Given};
use super::layer::ending;
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// The settings of an export of a rendered picture.
#[derive(Debug, Clone, Default)]
pub struct RenderExport {
    /// Number of samples of the land along its longer side; `None` for the world's own cell.
    pub samples: Option<usize>,
    /// The options of [`RenderJob::OPTIONS`].
    pub options: Given,
}

impl RenderExport {
    /// Adds the options of `orogen render`.
    pub fn words(&self, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        given::words(RenderJob::OPTIONS, &self.options, line);
        Samples::of(region, self.samples, world).unsized_for(world, line);
    }

    /// Writes the file. Returns a description.
    ///
    /// # Errors
    /// If options are not valid, or the export fails; then an existing file is unchanged.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        if !work.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Err(ending(&work.path, "a render", &["png"]));
        }
        let options = given::read(RenderJob::OPTIONS, &self.options)?;
        let job = RenderJob::default().with_options(&options)?;
        job.prepare(&mut work.recipe)?;
        let world = work.open()?;
        let window = Samples::of(region, self.samples, &work.recipe.world).window(&world)?;
        let output = work.policy().protecting(options.files()).output(&work.path)?;
        let rendering = job.with_window(window).to_file(&world, &output, work.progress)?;
        let lifted = rendering.lifted();
        let lifted = lifted.map(|metres| format!("the camera was below the ground and was raised by {metres:.0} m"));
        Ok(lines(&rendering.words(), rendering.warnings.iter().cloned().chain(lifted)))
    }
}
