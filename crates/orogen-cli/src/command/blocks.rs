//! `orogen blocks`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use orogen::blocks::caves;
use orogen::blocks::kind::{Block, KINDS};
use orogen::blocks::land::{self, COLUMN_BYTES, HALO, Land};
use orogen::blocks::levels::{DEFAULT_BELOW, Extent, Levels, MAX_BELOW};
use orogen::blocks::luanti::{FILES, LuantiWorld, OPENED};
use orogen::blocks::mesh::BlockMesh;
use orogen::blocks::picture::Isometric;
use orogen::blocks::schem::write_schem;
use orogen::blocks::section::Section;
use orogen::blocks::volume::BlockVolume;
use orogen::blocks::vox::write_vox;
use orogen::file::{self, Existing, Output, OutputFolder, OutputPolicy};
use orogen::format::{schem, vox};
use orogen::jobs::render::EXAGGERATION;
use orogen::words::{count, number};
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Progress, Window, World};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::finite;
use crate::interrupt::{self, Stoppable};
use crate::options::RunOptions;
use crate::say::{self, SOFTWARE};
use crate::sink::{Sink, is_stdout};
use crate::source::Source;
use crate::values::number::positive;
use crate::values::size::Size;
use crate::view::SizedView;

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Levels of blocks below the lowest ground [default: 16; with --caves 48]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_BELOW)), allow_negative_numbers = true)]
    below: Option<u32>,
    /// Vertical exaggeration of the ground and the water
    #[arg(long, value_name = "N", value_parser = positive, default_value = "1", allow_negative_numbers = true)]
    exaggeration: f64,
    /// Carve caves into the ground, away from water; not for recipes with an output `density`
    #[arg(long)]
    caves: bool,
    /// Draw a vertical cut along a row or a column of the window, counted from 0 in the north and in the west, as a .png
    #[arg(long, value_name = "row=N|column=N", value_parser = Section::parse)]
    section: Option<Section>,
    /// Format [default: by the extension of the output; a Luanti world if it has none]
    #[arg(long, value_enum)]
    format: Option<BlockFormat>,
    /// Output: .vox, .schem, .glb, .png, or a folder for a Luanti world; - for standard output
    #[arg(short, long, value_name = "FILE|DIR", default_value = "blocks.vox")]
    out: PathBuf,
    #[command(flatten)]
    run: RunOptions,
}

/// `--format`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum BlockFormat {
    /// MagicaVoxel models (.vox)
    Vox,
    /// A Sponge schematic, version 3, for Minecraft: Java Edition (.schem)
    Schem,
    /// The smooth surface of the ground as a mesh (.glb)
    Glb,
    /// A picture from the south-east (.png)
    Png,
    /// A folder with a Luanti (Minetest) world
    Luanti,
}

/// Columns along the longer side of a map without --size and --cell.
const SIDE: usize = 256;

/// Columns along the longer side up to which a world has one for each of its cells.
const MAX_OWN_SIDE: f64 = 512.0;

/// Memory for writing a file, in bytes.
const ENCODERS: u64 = 4 << 20;

/// Makes the blocks.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| blocks(&Args { samples, out, ..args.clone() }))
}

fn blocks(args: &Args) -> Result<(), Failure> {
    let format = format(args)?;
    if !EXAGGERATION.contains(&args.exaggeration) {
        let (from, to) = (EXAGGERATION.start(), EXAGGERATION.end());
        return Err(Failure::Usage(format!("--exaggeration must be from {from} to {to}, not {}", args.exaggeration)));
    }
    if args.section.is_some() && format != BlockFormat::Png {
        return Err(Failure::Usage("--section draws a picture: name a .png with -o, or use --format png".into()));
    }
    if format == BlockFormat::Luanti && is_stdout(&args.out) {
        return Err(Failure::Usage("a Luanti world has several files: name a folder with -o".into()));
    }
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = make(args, format, &progress);
    drop(bar);
    made.map_err(|failure| interrupt::explain(failure, "nothing was written"))
}

/// The format: as named, otherwise by the extension.
fn format(args: &Args) -> Result<BlockFormat, Failure> {
    let extension = args.out.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    let told = match extension.as_deref() {
        _ if is_stdout(&args.out) => args.format.or(Some(BlockFormat::Vox)),
        Some("vox") => Some(BlockFormat::Vox),
        Some("schem") => Some(BlockFormat::Schem),
        Some("glb") => Some(BlockFormat::Glb),
        Some("png") => Some(BlockFormat::Png),
        Some(_) => None,
        None => Some(BlockFormat::Luanti),
    };
    match (args.format, told) {
        (Some(asked), None | Some(BlockFormat::Luanti)) => Ok(asked),
        (Some(asked), Some(told)) if asked != told => {
            Err(Failure::Usage(format!("--format does not match the extension of {}", args.out.display())))
        }
        (_, Some(told)) => Ok(told),
        (None, None) => Err(Failure::Usage(format!(
            "{}: blocks are a .vox, .schem, .glb or .png, or a folder for a Luanti world; name a file that ends so, or use --format",
            args.out.display()
        ))),
    }
}

fn make(args: &Args, format: BlockFormat, progress: &Progress) -> Result<(), Failure> {
    let source = Source::find(&args.recipe)?;
    let budget = args.run.limits.budget();
    let mut recipe = args.samples.recipe(&source, &budget)?;
    let policy = args.run.replace.policy(source.inputs(&recipe));
    let spec = &recipe.world;
    // A small world has a block for each of its cells.
    let is_small = spec.size.is_some_and(|size| size[0].max(size[1]) <= MAX_OWN_SIDE * spec.cell);
    let is_free = args.samples.size.is_none() && args.samples.view.cell.is_none() && !args.samples.has_part();
    let size = args.samples.size.or((is_free && !is_small).then_some(Size::Longer(SIDE)));
    let samples = SizedView { size, ..args.samples.clone() };
    // The classes of a recipe without any depend on the cell of the map.
    let window = samples.window(&args.run.limits.open(recipe.clone(), &budget)?)?;
    land::prepare(&mut recipe, window.cell)?;
    if args.caves {
        caves::add(&mut recipe, window.cell)?;
    }
    let world = args.run.limits.open(recipe, &budget)?;
    let target = Target::new(args, format, &policy)?;
    // The sides are known before the heights are.
    let sea_level = world.recipe().world.sea_level * args.exaggeration;
    let one = Levels { bottom: Levels::of(sea_level, window.cell), count: 1 };
    let fits = |levels: Levels| match args.section {
        Some(section) => section.check(&window, levels.count).map(drop),
        None => fits(format, &window, levels, sea_level, &world),
    };
    fits(one)?;
    let _columns =
        budget.reserve((window.grown(HALO).len() as u64).saturating_mul(COLUMN_BYTES).saturating_add(ENCODERS))?;
    let [reading, making, writing] = progress.parts([2.0, 3.0, 5.0]);
    let below = args.below.unwrap_or(if args.caves { caves::BELOW } else { DEFAULT_BELOW });
    let land = Land::of(&world, &window, Extent::Below(below), args.exaggeration, &fits, &reading)?;
    finite::tell(HEIGHT, land.finite)?;
    let mut levels = land.levels;
    let text = match target {
        Target::Mesh(sink) => {
            let mesh = world.install(|| BlockMesh::of(&land, &budget, &making))?;
            sink.write(|out| mesh.write_glb(out))?;
            let [triangles, parts] = mesh.triangles();
            format!("{} in {}\n", count(triangles, "triangle"), count(parts, "part"))
        }
        Target::Volume(target) => {
            let _volume = budget.reserve(BlockVolume::memory(&window, levels))?;
            let volume = world.install(|| BlockVolume::of(&land, &making))?;
            drop(land);
            levels = volume.levels;
            target.write(&volume, &world, &writing)?;
            world.install(|| shares(&volume))
        }
    };
    writing.finish();
    match args.run.quiet || is_stdout(&args.out) {
        true => Ok(()),
        false => say::out(&format!("{}{text}", words(&args.out, &window, levels, &world))),
    }
}

/// Checks that the format can hold the blocks of a window.
fn fits(format: BlockFormat, window: &Window, levels: Levels, sea_level: f64, world: &World) -> orogen::Result<()> {
    let (width, height) = (window.width, window.height);
    match format {
        BlockFormat::Vox => vox::check([width, height, levels.count]),
        BlockFormat::Schem => schem::check([width, levels.count, height]),
        BlockFormat::Png => Isometric::new([width, levels.count, height]).map(drop),
        BlockFormat::Luanti => {
            LuantiWorld::start([width, levels.count, height], levels, sea_level, window.cell).map(drop)
        }
        BlockFormat::Glb => world.budget().afford(world.install(|| BlockMesh::memory(window, levels))),
    }
}

/// Where the result goes.
enum Target {
    Mesh(Sink),
    Volume(VolumeTarget),
}

/// Where blocks go.
enum VolumeTarget {
    Vox(Sink),
    Schem(Sink),
    Png(Sink),
    Section(Sink, Section),
    Luanti(OutputFolder, Vec<Output>),
}

impl Target {
    fn new(args: &Args, format: BlockFormat, policy: &OutputPolicy) -> Result<Target, Failure> {
        let sink = || Sink::new(&args.out, policy);
        Ok(Target::Volume(match format {
            BlockFormat::Glb => return Ok(Target::Mesh(sink()?)),
            BlockFormat::Vox => VolumeTarget::Vox(sink()?),
            BlockFormat::Schem => VolumeTarget::Schem(sink()?),
            BlockFormat::Png => match args.section {
                Some(section) => VolumeTarget::Section(sink()?, section),
                None => VolumeTarget::Png(sink()?),
            },
            BlockFormat::Luanti => {
                if policy.existing() != Existing::Replace && args.out.join(OPENED).exists() {
                    let message = format!(
                        "cannot write {}: Luanti has opened this world, so it may have been changed; choose another name, or replace its map with --force",
                        args.out.display()
                    );
                    return Err(Error::new(ErrorKind::File, message).into());
                }
                let outputs =
                    FILES.iter().map(|name| policy.output(args.out.join(name))).collect::<orogen::Result<_>>()?;
                VolumeTarget::Luanti(OutputFolder::ready(&folder_of_textures(&args.out))?, outputs)
            }
        }))
    }
}

/// The innermost folder of a Luanti world.
fn folder_of_textures(out: &Path) -> PathBuf {
    out.join(FILES[0]).parent().map_or_else(|| out.to_path_buf(), Path::to_path_buf)
}

impl VolumeTarget {
    fn write(self, volume: &BlockVolume, world: &World, progress: &Progress) -> Result<(), Failure> {
        let budget = world.budget();
        let blocks = volume.blocks.len() as u64;
        match self {
            VolumeTarget::Vox(sink) => sink.write(|out| write_vox(out, volume)),
            VolumeTarget::Schem(sink) => sink.write(|out| write_schem(out, volume)),
            VolumeTarget::Png(sink) => {
                let picture = Isometric::new(volume.size())?;
                let _picture = budget.reserve(picture.memory())?;
                sink.write(|out| picture.write(out, volume, &[("Software", SOFTWARE)]))
            }
            VolumeTarget::Section(sink, section) => {
                sink.write(|out| section.write(out, volume, &[("Software", SOFTWARE)]))
            }
            VolumeTarget::Luanti(folder, outputs) => {
                let _map = budget.reserve(LuantiWorld::memory(blocks))?;
                let luanti = world.install(|| LuantiWorld::new(volume, progress))?;
                let stage = |(name, output): (&&str, &Output)| {
                    file::stage(output, |out| luanti.write(name, &mut Stoppable(out), SOFTWARE))
                };
                let staged: Vec<_> = FILES.iter().zip(&outputs).map(stage).collect::<orogen::Result<_>>()?;
                file::commit(staged)?;
                folder.keep();
                Ok(())
            }
        }
    }
}

/// The first line of the final message.
fn words(out: &Path, window: &Window, levels: Levels, world: &World) -> String {
    format!(
        "{}: {} x {} columns, {}, {} m a block, seed {}\n",
        out.display(),
        window.width,
        window.height,
        count(levels.count, "level"),
        number(window.cell),
        world.recipe().world.seed,
    )
}

/// The kinds of blocks with their numbers and shares, and the air.
fn shares(volume: &BlockVolume) -> String {
    let counts = volume.counts();
    let all: u64 = counts[1..].iter().sum();
    let shares = KINDS.iter().zip(counts).skip(1).filter(|(_, blocks)| *blocks > 0);
    let shares: Vec<String> = shares
        .map(|(kind, blocks)| format!("{:.1} % {} ({blocks})", 100.0 * blocks as f64 / all as f64, kind.name))
        .collect();
    let air = counts[Block::Air as usize];
    let enclosed = volume.enclosed();
    format!("{all} blocks: {}\n{air} of air, {enclosed} of them in caves and below overhangs\n", shares.join(", "))
}
