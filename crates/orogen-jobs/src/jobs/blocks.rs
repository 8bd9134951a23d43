//! Blocks of a world as one job.

use std::io::{self, Write};
use std::ops::RangeInclusive;

use super::blocks_folder::BlocksFolder;
use super::blocks_format::BlockFormat;
use super::minecraft::MinecraftSave;
use super::render::EXAGGERATION;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::budget::Reservation;
use orogen_engine::recipe::WorldSpec;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::view::View;
use orogen_engine::world::World;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::{count, number};
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::file::{self, Output};
use orogen_io::format::notes::SOFTWARE;
use orogen_io::format::{schem, vox};
use orogen_output::blocks::caves;
use orogen_output::blocks::kind::{Block, KINDS};
use orogen_output::blocks::land::{self, COLUMN_BYTES, HALO, Land};
use orogen_output::blocks::levels::{DEFAULT_BELOW, Extent, Levels, MAX_BELOW};
use orogen_output::blocks::luanti::{FILES, LuantiWorld};
use orogen_output::blocks::mesh::BlockMesh;
use orogen_output::blocks::minecraft::placement::SEA_Y;
use orogen_output::blocks::picture::Isometric;
use orogen_output::blocks::schem::write_schem;
use orogen_output::blocks::section::Section;
use orogen_output::blocks::volume::BlockVolume;
use orogen_output::blocks::vox::write_vox;

/// Blocks of a world.
///
/// [`prepare`](BlocksJob::prepare) a recipe, open its world, then [`make`](BlocksJob::make) the blocks, and write them.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct BlocksJob {
    /// The kind of file.
    pub format: BlockFormat,
    /// Levels of blocks below the lowest ground; by default 16, and 48 with caves.
    pub below: Option<u32>,
    /// Vertical exaggeration of the ground and the water.
    pub exaggeration: f64,
    /// Whether caves are carved into the ground.
    pub has_caves: bool,
    /// The section that a picture shows, in place of the view from the south-east.
    pub section: Option<Section>,
    /// The y of the uppermost water of the sea in Minecraft.
    pub sea_y: i32,
}

/// The range of [`BlocksJob::sea_y`].
const SEA_Y_RANGE: RangeInclusive<f64> = -4_000_000.0..=4_000_000.0;

/// Memory for writing a file, in bytes.
const ENCODERS: u64 = 4 << 20;

/// Samples along the longer side without a choice.
const SIDE: usize = 256;

/// Cells along the longer side up to which a world has a block for each.
const MAX_OWN_SIDE: f64 = 512.0;

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("below", "N", ValueKind::Whole(0, MAX_BELOW as u64))
        .with_about("Levels of blocks below the lowest ground [default: 16; with --caves 48]")
        .with_example("16", ["", ""]),
    OptionSpec::new("exaggeration", "N", ValueKind::Number(*EXAGGERATION.start(), *EXAGGERATION.end()))
        .with_about("Vertical exaggeration of the ground and the water")
        .with_default("1"),
    OptionSpec::switch("caves")
        .with_about("Carve caves into the ground, away from water; not for recipes with an output `density`"),
    OptionSpec::new("section", "row=N|column=N", ValueKind::Text).with_about(
        "Draw a vertical cut along a row or a column of the window, counted from 0 in the north and in the west, \
             as a .png",
    ),
    OptionSpec::new("sea-y", "Y", ValueKind::Number(*SEA_Y_RANGE.start(), *SEA_Y_RANGE.end()))
        .with_about("Minecraft's y of the uppermost water of the sea, a whole number, in a save or a .schem")
        .with_default("62"),
];

impl BlocksJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// Blocks of the ground and the water, without caves.
    #[must_use]
    pub fn new(format: BlockFormat) -> BlocksJob {
        BlocksJob { format, below: None, exaggeration: 1.0, has_caves: false, section: None, sea_y: SEA_Y }
    }

    /// The same with all that is chosen by [`OPTIONS`](BlocksJob::OPTIONS).
    ///
    /// # Errors
    /// If a section is not valid, or the errors of [`check`](BlocksJob::check).
    pub fn with_options(self, options: &Options) -> Result<BlocksJob> {
        options.check(OPTIONS)?;
        let mut job = BlocksJob {
            below: options.whole("below").map(|levels| levels as u32),
            exaggeration: options.number("exaggeration").unwrap_or(self.exaggeration),
            has_caves: options.has("caves"),
            section: options.text("section").map(Section::parse).transpose()?,
            ..self
        };
        if let Some(y) = options.number("sea-y") {
            if y.trunc() != y {
                return Err(Error::new(ErrorKind::Request, format!("--sea-y must be a whole number, not {y}")));
            }
            job.sea_y = y as i32;
        }
        job.check()?;
        Ok(job)
    }

    /// Checks that the options do not contradict each other.
    ///
    /// # Errors
    /// If they do, or the exaggeration is out of its range.
    pub fn check(&self) -> Result<()> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        if !EXAGGERATION.contains(&self.exaggeration) {
            let (from, to) = (EXAGGERATION.start(), EXAGGERATION.end());
            return refuse(format!("the exaggeration must be from {from} to {to}, not {}", self.exaggeration));
        }
        if self.section.is_some() && self.format != BlockFormat::Png {
            return refuse("--section draws a picture: name a .png with -o, or use --format png".into());
        }
        if self.below.is_some() && self.format == BlockFormat::Minecraft {
            return refuse("the blocks of a save of Minecraft go down to its bedrock; leave out --below".into());
        }
        if !SEA_Y_RANGE.contains(&f64::from(self.sea_y)) {
            return refuse(format!("--sea-y must be from -4000000 to 4000000, not {}", self.sea_y));
        }
        Ok(())
    }

    /// The samples of a world that blocks are made of, if neither a part nor a cell nor a size is chosen: one for each
    /// cell of a world of up to 512 cells along a side, otherwise 256 along the longer side.
    #[must_use]
    pub fn view(view: &View, world: &WorldSpec) -> View {
        let is_small = world.size.is_some_and(|size| size[0].max(size[1]) <= MAX_OWN_SIDE * world.cell);
        if is_small { *view } else { view.sized(SIDE) }
    }

    /// Appends to a recipe the nodes that the blocks need; call it before the world is opened. `cell` is the size of a
    /// block in metres.
    ///
    /// # Errors
    /// The errors of [`land::prepare`] and [`caves::add`].
    pub fn prepare(&self, recipe: &mut Recipe, cell: f64) -> Result<()> {
        land::prepare(recipe, cell)?;
        if self.has_caves {
            caves::add(recipe, cell)?;
        }
        Ok(())
    }

    /// Makes the blocks of a window of a world of a [prepared](BlocksJob::prepare) recipe. Writing them is the rest of
    /// `progress`.
    ///
    /// # Errors
    /// The errors of [`check`](BlocksJob::check); if the format cannot hold them, or the world cannot make the window;
    /// if memory does not suffice; or the work was cancelled.
    pub fn make<'w>(&self, world: &'w World, window: &Window, progress: &Progress) -> Result<MadeBlocks<'w>> {
        self.check()?;
        if self.format == BlockFormat::Minecraft {
            return self.make_minecraft(world, window, progress);
        }
        // The sides are known before the heights are.
        let sea_level = world.recipe().world.sea_level * self.exaggeration;
        let one = Levels { bottom: Levels::of(sea_level, window.cell), count: 1 };
        let fits = |levels: Levels| match self.section {
            Some(section) => section.check(window, levels.count).map(drop),
            None => self.fits(window, levels, sea_level, world),
        };
        fits(one)?;
        let budget = world.budget();
        let columns = (window.grown(HALO).len() as u64).saturating_mul(COLUMN_BYTES).saturating_add(ENCODERS);
        let mut reserved = vec![budget.reserve(columns)?];
        let [reading, making, writing] = progress.parts([2.0, 3.0, 5.0]);
        let below = self.below.unwrap_or(if self.has_caves { caves::BELOW } else { DEFAULT_BELOW });
        let land = Land::of(world, window, Extent::Below(below), self.exaggeration, &fits, &reading)?;
        let (finite, mut levels) = (land.finite, land.levels);
        let content = if self.format == BlockFormat::Glb {
            Content::Mesh(world.install(|| BlockMesh::of(&land, budget, &making))?)
        } else {
            reserved.push(budget.reserve(BlockVolume::memory(window, levels))?);
            let volume = world.install(|| BlockVolume::of(&land, &making))?;
            levels = volume.levels;
            Content::Volume(volume)
        };
        let made = MadeBlocks {
            job: self.clone(),
            world,
            window: *window,
            finite,
            levels,
            content,
            writing,
            _reserved: reserved,
        };
        Ok(made)
    }

    /// Plans a save of Minecraft, whose chunks are made as they are written.
    fn make_minecraft<'w>(&self, world: &'w World, window: &Window, progress: &Progress) -> Result<MadeBlocks<'w>> {
        let [reading, writing] = progress.parts([1.0, 9.0]);
        let save = MinecraftSave::new(world, window, self.exaggeration, self.sea_y, &reading)?;
        let (finite, levels) = (save.finite, save.placement.levels());
        let content = Content::Minecraft(Box::new(save));
        let job = self.clone();
        Ok(MadeBlocks { job, world, window: *window, finite, levels, content, writing, _reserved: Vec::new() })
    }

    /// Checks that the format can hold the blocks of a window.
    fn fits(&self, window: &Window, levels: Levels, sea_level: f64, world: &World) -> Result<()> {
        let (width, height) = (window.width, window.height);
        match self.format {
            BlockFormat::Vox => vox::check([width, height, levels.count]),
            BlockFormat::Schem => schem::check([width, levels.count, height]),
            BlockFormat::Png => Isometric::new([width, levels.count, height]).map(drop),
            BlockFormat::Luanti => {
                LuantiWorld::start([width, levels.count, height], levels, sea_level, window.cell).map(drop)
            }
            BlockFormat::Glb => world.budget().afford(world.install(|| BlockMesh::memory(window, levels))),
            // A save is planned by itself.
            BlockFormat::Minecraft => Ok(()),
        }
    }
}

/// Blocks that are made.
pub struct MadeBlocks<'w> {
    job: BlocksJob,
    world: &'w World,
    window: Window,
    /// How many of the heights are finite.
    pub finite: FiniteCount,
    levels: Levels,
    content: Content,
    writing: Progress,
    _reserved: Vec<Reservation>,
}

enum Content {
    Mesh(BlockMesh),
    Volume(BlockVolume),
    Minecraft(Box<MinecraftSave>),
}

impl MadeBlocks<'_> {
    /// Writes them to a stream.
    ///
    /// # Errors
    /// If the format is a folder, the stream fails, memory does not suffice, or the work was cancelled.
    pub fn to_stream(&self, out: &mut dyn Write) -> io::Result<()> {
        let out = &mut CancellableWriter { out, progress: &self.writing };
        let notes = [("Software", SOFTWARE)];
        match (&self.content, self.job.format, self.job.section) {
            (Content::Mesh(mesh), ..) => mesh.write_glb(out)?,
            (Content::Minecraft(_), ..) | (_, BlockFormat::Luanti, _) => {
                return Err(Error::new(ErrorKind::Internal, "a world of several files has a folder").into());
            }
            (Content::Volume(volume), _, Some(section)) => section.write(out, volume, &notes)?,
            (Content::Volume(volume), BlockFormat::Schem, _) => write_schem(out, volume, self.job.sea_y)?,
            (Content::Volume(volume), BlockFormat::Png, _) => {
                let picture = Isometric::new(volume.size())?;
                let _picture = self.world.budget().reserve(picture.memory())?;
                picture.write(out, volume, &notes)?;
            }
            (Content::Volume(volume), ..) => write_vox(out, volume)?,
        }
        self.writing.finish();
        Ok(())
    }

    /// Writes a world to its folder, atomically.
    ///
    /// # Errors
    /// If the format is not a folder, a file cannot be written, memory does not suffice, or the work was cancelled.
    pub fn to_folder(&self, folder: BlocksFolder) -> Result<()> {
        let staged = match &self.content {
            Content::Volume(volume) if self.job.format == BlockFormat::Luanti => {
                let _map = self.world.budget().reserve(LuantiWorld::memory(volume.blocks.len() as u64))?;
                let luanti = self.world.install(|| LuantiWorld::new(volume, &self.writing))?;
                let stage = |(name, output): (&&str, &Output)| {
                    file::stage(output, |out| {
                        luanti.write(name, &mut CancellableWriter { out, progress: &self.writing }, SOFTWARE)
                    })
                };
                FILES.iter().zip(folder.outputs()).map(stage).collect::<Result<_>>()?
            }
            Content::Minecraft(save) => save.stage(self.world, folder.outputs(), &self.writing)?,
            _ => return Err(Error::new(ErrorKind::Internal, "these blocks are a single file")),
        };
        file::commit(staged)?;
        folder.keep();
        self.writing.finish();
        Ok(())
    }

    /// A description: the size, and the kinds of blocks with their shares.
    #[must_use]
    pub fn words(&self) -> String {
        let parts = match &self.content {
            Content::Mesh(mesh) => {
                let [triangles, parts] = mesh.triangles();
                format!("{} in {}", count(triangles, "triangle"), count(parts, "part"))
            }
            Content::Volume(volume) => self.world.install(|| shares(&volume.counts(), volume.enclosed())),
            Content::Minecraft(save) => save
                .written()
                .map_or_else(String::new, |written| shares(&written.counts, written.enclosed) + &written.words()),
        };
        let Window { width, height, cell, .. } = self.window;
        format!(
            "{width} x {height} columns, {}, {} m a block, seed {}\n{parts}",
            count(self.levels.count, "level"),
            number(cell),
            self.world.recipe().world.seed,
        )
    }
}

/// The kinds of blocks with their numbers and shares, and the air.
fn shares(counts: &[u64; KINDS.len()], enclosed: u64) -> String {
    let all: u64 = counts[1..].iter().sum();
    let shares = KINDS.iter().zip(counts).skip(1).filter(|(_, blocks)| **blocks > 0);
    let shares: Vec<String> = shares
        .map(|(kind, blocks)| format!("{:.1} % {} ({blocks})", 100.0 * *blocks as f64 / all as f64, kind.name))
        .collect();
    let air = counts[Block::Air as usize];
    format!("{all} blocks: {}\n{air} of air, {enclosed} of them in caves and below overhangs", shares.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_choose_levels_caves_and_a_section() {
        let job = |format: BlockFormat, given: &[(&str, &str)]| {
            let options = Options::of(OPTIONS, given.iter().copied()).unwrap();
            BlocksJob::new(format).with_options(&options).map_err(|error| error.to_string())
        };
        let own = job(BlockFormat::Vox, &[]).unwrap();
        assert_eq!((own.below, own.exaggeration, own.has_caves, own.section), (None, 1.0, false, None));
        let given = [("below", "7"), ("exaggeration", "2.5"), ("caves", ""), ("section", "row=12")];
        let other = job(BlockFormat::Png, &given).unwrap();
        assert_eq!((other.below, other.exaggeration, other.has_caves), (Some(7), 2.5, true));
        assert_eq!(other.section, Some(Section::Row(12)));
        assert!(job(BlockFormat::Vox, &[("section", "row=12")]).unwrap_err().contains("--section draws a picture"));
        assert_eq!((own.sea_y, job(BlockFormat::Schem, &[("sea-y", "-300")]).unwrap().sea_y), (62, -300));
        assert!(job(BlockFormat::Schem, &[("sea-y", "1.5")]).unwrap_err().contains("whole number"));
        assert!(job(BlockFormat::Minecraft, &[("below", "7")]).unwrap_err().contains("leave out --below"));
        assert!(job(BlockFormat::Png, &[("section", "12")]).unwrap_err().contains("row=N or column=N"));
    }
}
