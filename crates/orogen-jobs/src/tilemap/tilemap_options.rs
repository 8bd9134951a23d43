//! The options of a tilemap.

use super::job::TilemapJob;
use super::tileset_source;
use crate::options::Condition::IsFile;
use crate::options::{Choice, OptionSpec, Options, ValueKind};
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::Result;
use orogen_output::tilemap::art::set::SETS;

const fn layout(layout: Layout) -> Choice {
    Choice::new(layout.name(), layout.about())
}

const LAYOUTS: &[Choice] = &[layout(Layout::Blob), layout(Layout::Edge), layout(Layout::Corner), layout(Layout::Dual)];

/// The options, in the order of the help.
const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("tileset", "T", ValueKind::Tileset)
        .with_about(
            "Tileset to draw with: `fields-16` or `fields-32`, or a file: a tileset of Tiled (.tsx) with a wang set, \
             or a description (.toml)",
        )
        .with_default(SETS[0].name),
    OptionSpec::new("wang-set", "NAME", ValueKind::Text)
        .with_about("Wang set to use of a .tsx that has several")
        .when(IsFile("tileset")),
    OptionSpec::new("layout", "L", ValueKind::Choice(LAYOUTS))
        .with_about("How the tiles follow their surroundings [default: that of the tileset, `blob`]"),
    OptionSpec::switch("infinite").with_about(
        "Make the maps for Tiled infinite: chunks of 16 x 16 tiles at the positions of the world's cells, so that \
             maps of parts join",
    ),
];

impl TilemapJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// A job with everything that [`OPTIONS`](TilemapJob::OPTIONS) chooses.
    ///
    /// # Errors
    /// If an option does not apply, there is no such tileset, or it cannot be read.
    pub fn with_options(options: &Options) -> Result<TilemapJob> {
        read(options)
    }
}

/// Creates the job from options.
fn read(options: &Options) -> Result<TilemapJob> {
    options.check(OPTIONS)?;
    let name = options.text("tileset").unwrap_or(SETS[0].name);
    let source = tileset_source::find(name, options.word("layout").and_then(Layout::named), options.text("wang-set"))?;
    let mut job = TilemapJob::new(source.tileset).with_infinite(options.has("infinite"));
    job.files = source.files;
    Ok(job)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_choose_tiles_layout_and_chunks() {
        let job = |given: &[(&str, &str)]| {
            let options = Options::of(OPTIONS, given.iter().copied()).unwrap();
            read(&options)
        };
        let own = job(&[]).unwrap();
        assert_eq!(
            (own.tileset.name.as_str(), own.tileset.layout, own.is_infinite),
            (SETS[0].name, Layout::Blob, false)
        );
        let other = job(&[("tileset", SETS[1].name), ("layout", "dual"), ("infinite", "")]).unwrap();
        assert_eq!(
            (other.tileset.name.as_str(), other.tileset.layout, other.is_infinite),
            (SETS[1].name, Layout::Dual, true)
        );
        let error = job(&[("wang-set", "a")]).unwrap_err().to_string();
        assert_eq!(error, "--wang-set needs a file as --tileset");
    }
}
