//! `orogen map`.

use std::path::PathBuf;

use clap::ValueEnum;
use orogen::file;
use orogen::jobs::map::{MapColors, MapJob};
use orogen::jobs::sheet_format::SheetFormat;
use orogen::palette::color::Rgb;
use orogen::sheet::options::{GridStep, Labels, PageColors, Parts, Resolution, Scale, Shading};
use orogen::sheet::paper::Paper;
use orogen::world::HEIGHT;

use crate::bar::Bar;
use crate::export_options::LayerOptions;
use crate::failure::Failure;
use crate::options::Limits;
use crate::replace::Replace;
use crate::sink::{Sink, kind};
use crate::source::{Source, title};
use crate::values::color::color;
use crate::values::number::{Numbers, dpi, positive};
use crate::view::View;
use crate::{interrupt, palette, say};

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
    /// Give each value the color of the nearest stop of the palette, without mixing (as gdaldem's -nearest_color_entry); with --shade none pixels have
    /// exactly these colors
    #[arg(long, requires = "palette")]
    nearest_color: bool,
    /// Relief shading
    #[arg(long, value_name = "HOW", default_value = "multi")]
    shade: Shade,
    /// Contour interval in metres [default: a round number that suits relief and scale]
    #[arg(long, value_name = "M", value_parser = positive, allow_negative_numbers = true)]
    contours: Option<f64>,
    /// Contour heights in metres, instead of an interval, such as 100,250,500; all of them are labelled
    #[arg(long, value_name = "A,B,...", conflicts_with = "contours", allow_hyphen_values = true)]
    levels: Option<Numbers>,
    /// Contours that have labels, as far as there is room for them [default: index; all with --levels]
    #[arg(long, value_name = "WHICH")]
    labels: Option<Labelled>,
    /// Coordinate grid, with its numbers along all four sides: STEP metres apart, or degrees on a map in degrees [default STEP: a round distance of at
    /// least 20 mm on the page]
    #[arg(long, value_name = "STEP", num_args = 0..=1, default_missing_value = "auto", value_parser = grid_step, allow_negative_numbers = true)]
    grid: Option<GridStep>,
    /// Minimum drainage area of rivers in m^2 [default: depends on the scale, at least 100000; none on bare noise, which has no rivers]
    #[arg(long, value_name = "M2", value_parser = positive, allow_negative_numbers = true)]
    river_area: Option<f64>,
    /// Minimum area of lakes in m^2 [default: depends on the scale; none on bare noise, which has no lakes]
    #[arg(long, value_name = "M2", value_parser = positive, allow_negative_numbers = true)]
    lake_area: Option<f64>,
    /// Names on the map: a .csv file with columns x, y and name, and optionally kind (place, summit, river or lake) and height, or a .geojson file of points
    /// with these properties, and of lines that names follow; in the CRS of the heights; without a CRS, in metres
    /// east and north of the world's north-west corner (points south of it are negative). Names without room are left out, the last of the file first
    #[arg(long, value_name = "FILE")]
    names: Option<PathBuf>,
    /// Scale of the map, 1 : N, which sets the size of the page [default: the map is 240 mm long, or as large as --paper allows]
    #[arg(long, value_name = "N", value_parser = positive, conflicts_with = "paper", allow_negative_numbers = true)]
    scale: Option<f64>,
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
    page_colors: PageColorArgs,
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

/// Colors of the page and of its lines.
#[derive(Debug, Clone, Copy, clap::Args)]
#[command(next_help_heading = "Colors of the page, as #rrggbb or a name")]
struct PageColorArgs {
    /// The page [default: white]
    #[arg(long, value_name = "COLOR", value_parser = color)]
    page_color: Option<Rgb>,
    /// Texts, frames and symbols [default: almost black]
    #[arg(long, value_name = "COLOR", value_parser = color)]
    ink_color: Option<Rgb>,
    /// Rivers, lakes, shores and contours under water [default: shades of blue]; the sea has the colors of the palette
    #[arg(long, value_name = "COLOR", value_parser = color)]
    water_color: Option<Rgb>,
    /// Contours on land [default: brown, bright on dark ground]
    #[arg(long, value_name = "COLOR", value_parser = color)]
    contour_color: Option<Rgb>,
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
    /// Labels of the contours, as --labels none
    #[arg(long, conflicts_with = "labels")]
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

/// The contours that have labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Labelled {
    /// Index contours
    Index,
    /// All contours
    All,
    /// No contours
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

impl From<ColorOf> for MapColors {
    fn from(of: ColorOf) -> MapColors {
        match of {
            ColorOf::Palette => MapColors::Palette,
            ColorOf::Surfaces => MapColors::Surfaces,
            ColorOf::Biomes => MapColors::Biomes,
            ColorOf::Classes => MapColors::Classes,
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

/// Draws the sheet.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.view.each_output(&args.out, |view, out| map(&Args { view, out, ..args.clone() }))
}

fn map(args: &Args) -> Result<(), Failure> {
    let mut job = job(args)?;
    let source = Source::find(&args.recipe)?;
    job.is_place = matches!(source, Source::Dem(_));
    let budget = args.limits.budget();
    let mut recipe = args.view.recipe(&source, &budget)?;
    let policy = args.replace.policy(source.inputs(&recipe)).protecting(&args.palette).protecting(&args.names);
    let sink = Sink::new(&args.out, &policy)?;
    if let Some(path) = &args.names {
        job = job.with_names_from(path, &recipe)?;
    }
    job.prepare(&mut recipe)?;
    let world = args.limits.open(recipe, &budget)?;
    job.window = Some(args.view.window(&world)?);
    if let Sink::File(output) = &sink {
        file::check_folder(file::folder(output.path()))?;
    }
    let (bar, progress) = Bar::new(args.quiet);
    let stopped = |error: orogen::Error| interrupt::explain(error.into(), "nothing was written");
    let drawn = job.draw(&world, &progress).map_err(stopped)?;
    for warning in drawn.warnings() {
        say::error(&format!("warning: {warning}"));
    }
    if !drawn.lacking().is_empty() {
        let letters: String = drawn.lacking().iter().collect();
        say::error(&format!(
            "note: no installed font has the letters {letters}; they are left out (install a font that has them, such as Noto)"
        ));
    }
    match &sink {
        Sink::File(output) => drawn.to_file(output).map_err(stopped)?,
        Sink::Stdout => sink.write(|out| drawn.to_stream(out))?,
    }
    drop(bar);
    sink.tell(args.quiet, &format!("{}: {}\n", args.out.display(), drawn.words()))
}

/// What the arguments ask for, without the window.
fn job(args: &Args) -> Result<MapJob, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let mut job = MapJob::new(match kind(&args.out, args.format, &KINDS, "a map")? {
        Kind::Png => SheetFormat::Png,
        Kind::Svg => SheetFormat::Svg,
        Kind::Pdf => SheetFormat::Pdf,
    });
    job.colors = args.color.into();
    job.layer.clone_from(&args.layer);
    job.layer_options = args.layer_options.read()?;
    job.palette = palette::chosen(args.palette.as_deref(), args.nearest_color)?;
    if args.layer == HEIGHT && args.ramp.is_some() {
        return usage("--ramp needs a --layer other than height".into());
    }
    job.scale = args.ramp.map(|ramp| match ramp {
        Ramp::Linear => Scale::Linear,
        Ramp::Log => Scale::Log,
        Ramp::Labels => Scale::Labels,
    });
    job.range = match args.range.as_ref().map(|range| range.0.as_slice()) {
        None => None,
        Some(&[low, high]) if low < high => Some([low as f32, high as f32]),
        Some(_) => return usage("--range must be LOW,HIGH with the lower value first, such as 0,45".into()),
    };
    if args.color != ColorOf::Palette && (args.layer != HEIGHT || args.palette.is_some() || job.range.is_some()) {
        let color = job.colors.plural();
        return usage(format!("--color {color} cannot be combined with --layer, --palette or --range"));
    }
    job.shading = match args.shade {
        _ if args.without.no_shade => Shading::None,
        Shade::Single => Shading::Single,
        Shade::Multi => Shading::Multi,
        Shade::Swiss => Shading::Swiss,
        Shade::None => Shading::None,
    };
    job.interval = args.contours;
    job.levels = args.levels.as_ref().map(|levels| levels.0.clone());
    job.labels = args.labels.and_then(|labels| match labels {
        Labelled::Index => Some(Labels::Index),
        Labelled::All => Some(Labels::All),
        Labelled::None => None,
    });
    job.page_colors = page_colors(&args.page_colors);
    job.grid = args.grid;
    job.river_area = args.river_area;
    job.lake_area = args.lake_area;
    job.map_scale = args.scale;
    job.title = args.title.clone().unwrap_or_else(|| title(&args.recipe));
    job.paper = args.paper.map(|paper| paper.sides(args.landscape));
    job.resolution = match (args.dpi, args.size) {
        (Some(dpi), _) => Some(Resolution::Inch(f64::from(dpi))),
        (None, size) => size.map(Resolution::Longer),
    };
    job.parts = parts(&args.without);
    job.parts.labels &= args.labels != Some(Labelled::None);
    job.has_sidecars = !args.no_sidecar;
    if job.is_too_large() {
        return usage(format!(
            "there is not enough memory for a page of {:.0} pixels per side; use a lower --dpi or a smaller --paper",
            job.side()
        ));
    }
    Ok(job)
}

/// `--grid`: a distance, or `auto`.
fn grid_step(text: &str) -> Result<GridStep, String> {
    match text {
        "auto" => Ok(GridStep::Automatic),
        _ => positive(text).map(GridStep::Every).map_err(|_| {
            "the distance between the lines of a grid must be a number of metres or degrees above 0, such as 1000; leave it out for a distance that suits the \
             scale, with --grid after the recipe"
                .into()
        }),
    }
}

/// The colors of the page.
fn page_colors(args: &PageColorArgs) -> PageColors {
    let mut colors = PageColors::default();
    colors.page = args.page_color.unwrap_or(colors.page);
    colors.ink = args.ink_color.unwrap_or(colors.ink);
    colors.water = args.water_color;
    colors.contours = args.contour_color;
    colors
}

/// The parts that are not left out.
fn parts(without: &Without) -> Parts {
    let mut parts = Parts::default();
    parts.title = !without.no_title;
    parts.axes = !without.no_axes;
    parts.contours = !without.no_contours;
    parts.labels = !without.no_labels;
    parts.summits = !without.no_summits;
    parts.rivers = !without.no_rivers;
    parts.lakes = !without.no_lakes;
    parts.legend = !without.no_legend;
    parts.colors = !without.no_color;
    parts.scale = !without.no_scale;
    parts.north = !without.no_north;
    parts.profile = !without.no_profile;
    parts
}
