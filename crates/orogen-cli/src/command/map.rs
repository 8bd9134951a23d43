//! `orogen map`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use orogen::export::derived::list;
use orogen::export::layer_source::LayerSource;
use orogen::export::place;
use orogen::export::{biome_cover, sheet_cover};
use orogen::format::affine::Affine;
use orogen::layer::LayerKind;
use orogen::palette::named;
use orogen::palette::palette::Palette;
use orogen::sheet::draw::{Sheet, draw};
use orogen::sheet::geometry::{Rect, Size};
use orogen::sheet::linework::lines_at;
use orogen::sheet::options::{Coloring, Layer, Page, Parts, Resolution, Scale, Shading, SheetOptions};
use orogen::sheet::{pdf, raster, vector};
use orogen::words::number;
use orogen::world::HEIGHT;
use orogen::{Grid, Progress, Window, World, file};

use crate::bar::Bar;
use crate::export_options::LayerOptions;
use crate::failure::Failure;
use crate::options::Limits;
use crate::replace::Replace;
use crate::sink::{Sink, kind};
use crate::source::{Source, title};
use crate::values::number::{Numbers, dpi, positive};
use crate::values::paper::Paper;
use crate::view::View;
use crate::{finite, interrupt, palette, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// Output file: .png, .svg or .pdf; - is standard output
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Format, if the file extension does not determine it [default: png]
    #[arg(long)]
    format: Option<Kind>,
    /// Layer to colour: an output, `node.layer`, or a layer derived from the heights (`orogen export --help` lists them)
    #[arg(long, value_name = "L", default_value = HEIGHT)]
    layer: String,
    /// What the colours show: a layer with a palette, the surfaces of the ground, the biomes, or the terrain classes
    #[arg(long, value_name = "WHAT", default_value = "palette", aliases = ["colors", "colour", "colours"])]
    color: ColorOf,
    /// How values are mapped to colours [default: log for drainage areas and similar, labels for numbered areas, else linear]
    #[arg(long, value_name = "HOW")]
    ramp: Option<Ramp>,
    /// Values at the ends of the palette, for example to use the same range for several maps [default: the minimum and maximum of this map]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true)]
    range: Option<Numbers>,
    /// Palette: a name (`orogen palettes` lists them) or a file (.cpt, .gpl, .toml, or gdaldem) [default: hypsometric for heights; for
    /// other layers the palette with the layer's name, else viridis]
    #[arg(long, value_name = "NAME|FILE")]
    palette: Option<PathBuf>,
    /// Relief shading
    #[arg(long, value_name = "HOW", default_value = "multi")]
    shade: Shade,
    /// Contour interval in metres [default: a round number that suits relief and scale]
    #[arg(long, value_name = "M", value_parser = positive, allow_negative_numbers = true)]
    contours: Option<f64>,
    /// Title [default: the recipe's name]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Paper size: a0 to a5, letter, legal or WxHmm [default: the size of the map]
    #[arg(long, value_name = "PAPER")]
    paper: Option<Paper>,
    /// Landscape orientation
    #[arg(long, requires = "paper")]
    landscape: bool,
    /// Pixels per inch of a .png, and of the relief in a .svg or .pdf [default: 220; 150 for a .png without --paper]
    #[arg(long, value_name = "N", value_parser = dpi(), allow_negative_numbers = true)]
    dpi: Option<u16>,
    /// Pixels along the longer side of the page, instead of --dpi
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(100..=30000), conflicts_with = "dpi",
          allow_negative_numbers = true)]
    size: Option<u32>,
    /// Do not write georeferencing files beside a .png (world file, .prj, .aux.xml)
    #[arg(long)]
    no_sidecar: bool,
    #[command(flatten)]
    view: View,
    #[command(flatten)]
    without: Without,
    #[command(flatten)]
    replace: Replace,
    #[command(flatten)]
    layer_options: LayerOptions,
    #[command(flatten)]
    limits: Limits,
    /// Print no progress and no summary
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// Parts that are left out.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Parts to leave out")]
struct Without {
    /// Title and subtitle
    #[arg(long)]
    no_title: bool,
    /// Coordinates along the edges
    #[arg(long)]
    no_axes: bool,
    /// Contours and their labels
    #[arg(long)]
    no_contours: bool,
    /// Labels of the contours
    #[arg(long)]
    no_labels: bool,
    /// Summits and their heights
    #[arg(long)]
    no_summits: bool,
    /// Rivers
    #[arg(long)]
    no_rivers: bool,
    /// Lakes (maps of a file of heights have none)
    #[arg(long)]
    no_lakes: bool,
    /// Relief shading, as --shade none
    #[arg(long, conflicts_with = "shade")]
    no_shade: bool,
    /// Legend
    #[arg(long)]
    no_legend: bool,
    /// Colour bar, or the list of surfaces, biomes or classes
    #[arg(long, aliases = ["no-colors", "no-colour", "no-colours"])]
    no_color: bool,
    /// Scale bar
    #[arg(long)]
    no_scale: bool,
    /// North arrow
    #[arg(long)]
    no_north: bool,
    /// Profiles in the free space of --paper
    #[arg(long)]
    no_profile: bool,
}

/// Relief shading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Shade {
    /// Hillshade with one light from the north-west
    Single,
    /// Hillshade with three lights
    Multi,
    /// Three lights, with soft hazy lowlands and crisp summits
    Swiss,
    /// No shading
    None,
}

/// What the colours show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ColorOf {
    /// The heights or the --layer, with a palette
    Palette,
    /// The recipe's surfaces, or the standard ones: grass, sand, scree, rock, snow, river beds
    Surfaces,
    /// The classes of an output that is the layer of a `biome`, with their names
    Biomes,
    /// The recipe's terrain classes, `[[class]]`, with their names
    Classes,
}

impl ColorOf {
    /// What the legend lists.
    fn plural(self) -> &'static str {
        match self {
            ColorOf::Palette => "values",
            ColorOf::Surfaces => "surfaces",
            ColorOf::Biomes => "biomes",
            ColorOf::Classes => "classes",
        }
    }
}

/// How values are mapped to colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Ramp {
    /// Linear scale
    Linear,
    /// Logarithmic scale, for quantities over orders of magnitude
    Log,
    /// A different colour for each number
    Labels,
}

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Picture
    Png,
    /// Vector drawing
    Svg,
    /// PDF page
    Pdf,
}

const KINDS: [(Kind, &[&str]); 3] = [(Kind::Png, &["png"]), (Kind::Svg, &["svg"]), (Kind::Pdf, &["pdf"])];

/// The palette of a layer without a palette of its name.
const LAYER_PALETTE: &str = "viridis";

/// Longer side of a map on a fitted page, in millimetres.
const LONGER: f64 = 240.0;

/// Default resolution in pixels per inch: of pictures, and on paper and in vector files.
const SCREEN: f64 = 150.0;
const PRINT: f64 = 220.0;

/// Maximum number of pixels of a page.
const MOST: f64 = 4e8;

/// Approximate time of drawing per sample of the heights, and of drawing and writing per pixel of the page, in
/// nanoseconds.
const DRAWING: f64 = 400.0;
const WRITING: f64 = 60.0;

/// Draws the sheet.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.view.each_output(&args.out, |view, out| map(&Args { view, out, ..args.clone() }))
}

fn map(args: &Args) -> Result<(), Failure> {
    let kind = kind(&args.out, args.format, &KINDS, "a map")?;
    let palette = match (&args.palette, args.layer.as_str()) {
        (Some(palette), _) => palette::find(palette)?,
        (None, HEIGHT) => palette::find(Path::new(named::DEFAULT))?,
        (None, layer) => {
            let derived = list::named(layer).map(|derived| derived.palette).filter(|palette| !palette.is_empty());
            let own = derived.or(named::find(layer).map(|named| named.name)).unwrap_or(LAYER_PALETTE);
            palette::find(Path::new(own))?
        }
    };
    let range = range(args)?;
    let is_covered = args.color != ColorOf::Palette;
    if is_covered && (args.layer != HEIGHT || args.palette.is_some() || range.is_some()) {
        let color = args.color.plural();
        return Err(Failure::Usage(format!("--color {color} cannot be combined with --layer, --palette or --range")));
    }
    let source = Source::find(&args.recipe)?;
    let budget = args.limits.budget();
    let mut recipe = args.view.recipe(&source, &budget)?;
    let sink = Sink::new(&args.out, &args.replace.policy(source.inputs(&recipe)).protecting(&args.palette))?;
    list::prepare(&mut recipe, &args.layer, &args.layer_options.read()?)?;
    if args.color == ColorOf::Surfaces {
        sheet_cover::prepare(&mut recipe);
    }
    let world = args.limits.open(recipe, &budget)?;
    let window = args.view.window(&world)?;
    let is_place = matches!(source, Source::Dem(_));
    let mut options = options(args, kind, palette, &world, is_place);
    options.range = range.filter(|_| args.layer == HEIGHT);
    let _drawing = world.budget().reserve(drawing(&options, &window, args)?)?;
    let (bar, progress) = Bar::new(args.quiet);
    let stopped = |error: orogen::Error| interrupt::explain(error.into(), "nothing was written");
    let plan = world.plan(&[HEIGHT], &window)?;
    let work = world.work(&plan)?;
    let layered = if args.layer == HEIGHT && !is_covered { 0.0 } else { work };
    let [making, layering, drawing, writing] =
        progress.parts([work, layered, DRAWING * window.len() as f64, WRITING * pixels(&options)]);
    let mut grids = world.run(&plan, &making).map_err(stopped)?;
    let Some(heights) = grids.pop() else { return Ok(()) };
    finite::check(HEIGHT, &heights)?;
    let explained = |failure: Failure| interrupt::explain(failure, "nothing was written");
    if args.layer != HEIGHT {
        options.coloring = Coloring::Layer(layer(args, &world, &window, range, &layering).map_err(explained)?);
    }
    if is_covered {
        let (made, doing) = match args.color {
            ColorOf::Biomes => (biome_cover::of(&world, &heights, options.sea_level, &layering), "make the biomes of"),
            ColorOf::Classes => {
                (biome_cover::of_terrain(&world, &heights, options.sea_level, &layering), "make the classes of")
            }
            _ => (sheet_cover::of(&world, &heights, options.sea_level, &layering), "make the surfaces of"),
        };
        let made = made.map_err(|cause| explained(file::explain(doing, &args.out, &cause).into()))?;
        options.coloring = Coloring::Surfaces(made);
    }
    let sheet = draw(&heights, &options, &drawing).map_err(stopped)?;
    drawing.finish();
    if !sheet.lacking.is_empty() {
        let letters: String = sheet.lacking.iter().collect();
        say::error(&format!(
            "note: no installed font has the letters {letters}; they are left out (install a font that has them, such as Noto)"
        ));
    }
    let software = say::SOFTWARE;
    match kind {
        Kind::Png => {
            let page = raster::draw(&sheet.scene, sheet.dpi);
            let mut notes = vec![("Software", software)];
            // PNG text chunks contain Latin-1 only.
            if options.title.chars().all(|letter| letter <= '\u{ff}' && !letter.is_control()) {
                notes.push(("Title", &options.title));
            }
            let beside = match (&sink, &options.map) {
                (Sink::File(output), Some(map)) if !args.no_sidecar => {
                    place::stage(output, map, on_page(&map.affine(&window, false), &window, &sheet))?
                }
                _ => Vec::new(),
            };
            sink.write(|out| page.write_png(out, &notes))?;
            file::commit(beside)?;
        }
        Kind::Svg => sink.write(|out| vector::write(out, &sheet.scene))?,
        Kind::Pdf => sink.write(|out| pdf::write(out, &sheet.scene))?,
    }
    writing.finish();
    drop(bar);
    if args.quiet {
        return Ok(());
    }
    let Size { width, height } = sheet.scene.size;
    let size = match kind {
        Kind::Png => {
            let [width, height] = raster::pixels(&sheet.scene, sheet.dpi);
            format!("{width} x {height} pixels")
        }
        _ => format!("{width:.0} x {height:.0} mm"),
    };
    let contours = sheet.interval.map_or(String::new(), |interval| format!(", contours {} m apart", number(interval)));
    let layer = match (args.color, args.layer.as_str()) {
        (ColorOf::Palette, HEIGHT) => String::new(),
        (ColorOf::Palette, layer) => format!("{layer}, "),
        (color, _) => format!("{}, ", color.plural()),
    };
    let words = format!(
        "{}: {layer}{size}, {} x {} samples of {} m{contours}\n",
        args.out.display(),
        window.width,
        window.height,
        number(window.cell)
    );
    sink.tell(args.quiet, &words)
}

/// The transform from pixels of a page to map coordinates, from that of the ground on it.
fn on_page(samples: &Affine, window: &Window, sheet: &Sheet) -> Affine {
    let Rect { left, top, width, height } = sheet.ground;
    let [left, top, width, height] =
        [left, top, width, height].map(|millimetres| f64::from(millimetres) * sheet.dpi / 25.4);
    let scale = [(window.width - 1) as f64 / width, (window.height - 1) as f64 / height];
    samples.resampled(scale, [(0.5 - left) * scale[0], (0.5 - top) * scale[1]])
}

/// The two values of `--range`.
fn range(args: &Args) -> Result<Option<[f32; 2]>, Failure> {
    if args.layer == HEIGHT && args.ramp.is_some() {
        return Err(Failure::Usage("--ramp needs a --layer other than height".into()));
    }
    match args.range.as_ref().map(|range| range.0.as_slice()) {
        None => Ok(None),
        Some(&[low, high]) if low < high => Ok(Some([low as f32, high as f32])),
        Some(_) => Err(Failure::Usage("--range must be LOW,HIGH with the lower value first, such as 0,45".into())),
    }
}

/// The layer that colours the map.
fn layer(
    args: &Args,
    world: &World,
    window: &Window,
    range: Option<[f32; 2]>,
    progress: &Progress,
) -> Result<Layer, Failure> {
    let mut source = LayerSource::new(world, &args.layer, *window, progress)?;
    if source.channels() != 1 {
        return Err(Failure::Usage(format!(
            "`{}` has {} channels, but a map shows a layer with one channel",
            args.layer,
            source.channels()
        )));
    }
    let scale = match (args.ramp, source.kind()) {
        (Some(Ramp::Linear), _) => Scale::Linear,
        (Some(Ramp::Log), _) | (None, LayerKind::Flow) => Scale::Log,
        (Some(Ramp::Labels), _) | (None, LayerKind::Label) => Scale::Labels,
        (None, _) => Scale::Linear,
    };
    let unit = source.unit();
    let made = source.whole().map_err(|cause| file::explain("make the layer of", &args.out, &cause))?;
    let values = made.into_iter().next().unwrap_or_else(|| Grid::filled(*window, f32::NAN));
    finite::check(&args.layer, &values)?;
    Ok(Layer::new(&args.layer, values).with_unit(unit).with_scale(scale).with_range(range))
}

fn options(args: &Args, kind: Kind, palette: Palette, world: &World, is_place: bool) -> SheetOptions {
    let recipe = world.recipe();
    let page = match args.paper {
        Some(paper) => Page::Paper(paper.sides(args.landscape)),
        None => Page::Fitted(LONGER),
    };
    let without = &args.without;
    // Lines and water would hide the other layer.
    let is_height = args.layer == HEIGHT;
    let mut parts = Parts::default();
    parts.title = !without.no_title;
    parts.axes = !without.no_axes;
    parts.contours = !without.no_contours && (is_height || args.contours.is_some());
    parts.labels = !without.no_labels;
    parts.summits = !without.no_summits && is_height;
    parts.rivers = !without.no_rivers && is_height;
    // Most depressions of a real place are gorges dammed by coarse samples, and its lakes are level in the data
    // already.
    parts.lakes = !without.no_lakes && !is_place && is_height;
    parts.legend = !without.no_legend;
    parts.colors = !without.no_color;
    parts.scale = !without.no_scale;
    parts.north = !without.no_north;
    parts.profile = !without.no_profile;
    let usual = if kind == Kind::Png && args.paper.is_none() { SCREEN } else { PRINT };
    let resolution = match (args.dpi, args.size) {
        (Some(dpi), _) => Resolution::Inch(f64::from(dpi)),
        (None, Some(size)) => Resolution::Longer(size),
        (None, None) => Resolution::Inch(usual),
    };
    let about = match recipe.about.as_str() {
        about if is_place => about.to_string(),
        "" => format!("Seed {}", recipe.world.seed),
        about => format!("{}; seed {}", about.trim_end_matches('.'), recipe.world.seed),
    };
    let mut options = SheetOptions::new(palette);
    options.title = args.title.clone().unwrap_or_else(|| title(&args.recipe));
    options.about = about;
    options.shading = match args.shade {
        _ if without.no_shade => Shading::None,
        Shade::Single => Shading::Single,
        Shade::Multi => Shading::Multi,
        Shade::Swiss => Shading::Swiss,
        Shade::None => Shading::None,
    };
    options.interval = args.contours;
    options.parts = parts;
    options.page = page;
    options.resolution = resolution;
    // A file of heights has no sea level: all of it is land.
    options.sea_level = (!is_place).then_some(recipe.world.sea_level);
    options.map = recipe.georeference();
    options
}

/// Approximate longer side of a page, in millimetres.
fn longer(page: Page) -> f64 {
    match page {
        Page::Fitted(longer) => longer + 36.0,
        Page::Paper([width, height]) => width.max(height),
    }
}

/// Pixels of a square that contains the page.
fn pixels(options: &SheetOptions) -> f64 {
    let side = match options.resolution {
        Resolution::Inch(dpi) => longer(options.page) * dpi / 25.4,
        Resolution::Longer(pixels) => f64::from(pixels),
    };
    side * side
}

/// Memory of drawing beside the heights, in bytes, or an error if the page is too large.
fn drawing(options: &SheetOptions, window: &Window, args: &Args) -> Result<u64, Failure> {
    let side = pixels(options).sqrt();
    if side * side > MOST {
        return Err(Failure::Usage(format!(
            "there is not enough memory for a page of {:.0} pixels per side; use a lower --dpi or a smaller --paper",
            side
        )));
    }
    let lines = lines_at(longer(options.page)) as f64;
    // First the water and the contours are computed; then they are held beside the page twice, the picture and its
    // heights.
    let page = f64::max(64.0 * lines * lines, 20.0 * side * side + 16.0 * lines * lines);
    // The heights count in the world's plan; another layer is held beside them, twice while it is computed.
    let layer = if args.layer == HEIGHT { 0.0 } else { 8.0 * window.len() as f64 };
    // The albedo of the surfaces is also held at the resolution of the page.
    let cover = match args.color {
        ColorOf::Palette => 0.0,
        ColorOf::Surfaces => sheet_cover::memory(window) as f64 + 12.0 * side * side,
        ColorOf::Biomes | ColorOf::Classes => biome_cover::memory(window) as f64 + 12.0 * side * side,
    };
    Ok((page + layer + cover) as u64)
}
