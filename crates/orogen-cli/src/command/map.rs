//! `orogen map`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use orogen::palette::named;
use orogen::palette::palette::Palette;
use orogen::sheet::draw::draw;
use orogen::sheet::options::{Options, Page, Parts, Resolution};
use orogen::sheet::relief::Shading;
use orogen::sheet::{pdf, raster, vector};
use orogen::words::number;
use orogen::{Window, file};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::interrupt::Stoppable;
use crate::options::Limits;
use crate::paper::Paper;
use crate::replace::Replace;
use crate::seeds::Seeds;
use crate::size::positive;
use crate::source::Source;
use crate::view::View;
use crate::{finite, interrupt, memory, palette, say};

/// What it takes.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe's file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// File to write: .png, .svg or .pdf
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Colours: the name of a palette (`orogen palettes` lists them) or a file (.cpt, .gpl, .toml, or gdaldem's)
    #[arg(long, value_name = "NAME|FILE", default_value = named::DEFAULT)]
    palette: PathBuf,
    /// How relief is shaded
    #[arg(long, value_name = "HOW", default_value = "multi")]
    shade: Shade,
    /// Metres from one contour to the next [default: what suits the ground and the scale]
    #[arg(long, value_name = "M", value_parser = positive, allow_negative_numbers = true)]
    contours: Option<f64>,
    /// Heading [default: the recipe's name]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Page to fill: a3, a4, a5, letter, legal or WxHmm [default: as large as the map needs]
    #[arg(long, value_name = "PAPER")]
    paper: Option<Paper>,
    /// Lay the paper on its side
    #[arg(long, requires = "paper")]
    landscape: bool,
    /// Pixels an inch: of a .png, and of the relief within a .svg or .pdf
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(20..=1200), allow_negative_numbers = true)]
    dpi: Option<u16>,
    /// Pixels of the longer side of a .png
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(100..=30000), conflicts_with = "dpi",
          allow_negative_numbers = true)]
    size: Option<u32>,
    #[command(flatten)]
    view: View,
    #[command(flatten)]
    without: Without,
    #[command(flatten)]
    replace: Replace,
    #[command(flatten)]
    limits: Limits,
    /// Show neither progress nor the closing words
    #[arg(short, long)]
    quiet: bool,
}

/// Parts that are left out.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Parts to leave out")]
struct Without {
    /// The heading and what is said beneath it
    #[arg(long)]
    no_title: bool,
    /// The numbers along the sides
    #[arg(long)]
    no_axes: bool,
    /// The contours and their heights
    #[arg(long)]
    no_contours: bool,
    /// The heights along contours
    #[arg(long)]
    no_labels: bool,
    /// The summits and their heights
    #[arg(long)]
    no_summits: bool,
    /// The rivers
    #[arg(long)]
    no_rivers: bool,
    /// The lakes, of which a file of heights has none
    #[arg(long)]
    no_lakes: bool,
    /// The shading of the relief, as --shade none
    #[arg(long, conflicts_with = "shade")]
    no_shade: bool,
    /// What lines and marks mean
    #[arg(long)]
    no_legend: bool,
    /// The bar of colours
    #[arg(long)]
    no_colors: bool,
    /// The scale bar
    #[arg(long)]
    no_scale: bool,
    /// The arrow to the north
    #[arg(long)]
    no_north: bool,
}

/// How relief is shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Shade {
    /// By one light from the north-west
    Single,
    /// By three lights
    Multi,
    /// By three lights, lowlands soft and hazy, summits crisp
    Swiss,
    /// Not at all
    None,
}

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Png,
    Svg,
    Pdf,
}

/// Millimetres of the longer side of a map on a page that fits it.
const LONGER: f64 = 240.0;

/// Pixels an inch, where nobody says: of pictures, and of those on paper and in vector files.
const SCREEN: f64 = 150.0;
const PRINT: f64 = 220.0;

/// Most pixels of a page.
const MOST: f64 = 4e8;

/// Nanoseconds that drawing takes for each sample of the heights, and drawing and writing for each pixel of the page, about.
const DRAWING: f64 = 400.0;
const WRITING: f64 = 60.0;

/// Draws the sheet.
pub fn run(args: &Args) -> Result<(), Failure> {
    Seeds::each(args.view.seed.as_ref(), Some(&args.out), |seed, out| {
        let view = View { seed, ..args.view.clone() };
        map(&Args { view, out: out.unwrap_or_default(), ..args.clone() })
    })
}

fn map(args: &Args) -> Result<(), Failure> {
    let kind = kind(&args.out)?;
    if args.size.is_some() && kind != Kind::Png {
        return Err(Failure::Usage(
            "--size counts pixels, and only a .png is made of them; say --paper or --dpi".into(),
        ));
    }
    let palette = palette::find(&args.palette)?;
    let source = Source::find(&args.recipe)?;
    let mut recipe = source.read()?;
    args.view.apply(&mut recipe);
    let output = args.replace.policy(source.inputs(&recipe)).protecting([&args.palette]).output(&args.out)?;
    let world = args.limits.open(recipe)?;
    let window = args.view.window(&world)?;
    let is_place = matches!(source, Source::Dem(_));
    let options = options(args, kind, palette, &world, is_place);
    afford(&options, &window, args)?;
    let (bar, progress) = Bar::new(args.quiet);
    let stopped = |error: orogen::Error| interrupt::explain(error.into(), "nothing was written");
    let plan = world.plan(&[orogen::world::HEIGHT], &window)?;
    let [making, drawing, writing] =
        progress.parts([world.work(&plan), DRAWING * window.len() as f64, WRITING * pixels(&options)]);
    let mut grids = world.run(&plan, &making).map_err(stopped)?;
    let Some(heights) = grids.pop() else { return Ok(()) };
    finite::check(orogen::world::HEIGHT, &heights)?;
    let sheet = draw(&heights, &options, &drawing).map_err(stopped)?;
    drawing.finish();
    if !sheet.lacking.is_empty() {
        let letters: String = sheet.lacking.iter().collect();
        say::error(&format!(
            "note: no font on this machine has the letters {letters}; they are left out (install one that has, such as Noto)"
        ));
    }
    let software = format!("Orogen {}", env!("CARGO_PKG_VERSION"));
    match kind {
        Kind::Png => {
            let page = raster::draw(&sheet.scene, sheet.dpi);
            let mut notes = vec![("Software", software.as_str())];
            // PNG's plain notes hold Latin letters only.
            if options.title.chars().all(|letter| letter <= '\u{ff}' && !letter.is_control()) {
                notes.push(("Title", &options.title));
            }
            file::write_whole(&output, |out| page.write_png(&mut Stoppable(out), &notes)).map_err(stopped)?;
        }
        Kind::Svg => {
            file::write_whole(&output, |out| vector::write(&mut Stoppable(out), &sheet.scene)).map_err(stopped)?
        }
        Kind::Pdf => {
            file::write_whole(&output, |out| pdf::write(&mut Stoppable(out), &sheet.scene)).map_err(stopped)?
        }
    }
    writing.finish();
    drop(bar);
    if args.quiet {
        return Ok(());
    }
    let [width, height] = sheet.scene.size;
    let size = match kind {
        Kind::Png => {
            let [width, height] = raster::pixels(&sheet.scene, sheet.dpi);
            format!("{width} x {height} pixels")
        }
        _ => format!("{width:.0} x {height:.0} mm"),
    };
    let contours = sheet.interval.map_or(String::new(), |interval| format!(", contours {} m apart", number(interval)));
    say::out(&format!(
        "{}: {size}, {} x {} samples of {} m{contours}\n",
        args.out.display(),
        window.width,
        window.height,
        number(window.cell)
    ))
}

fn kind(path: &Path) -> Result<Kind, Failure> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match extension.as_str() {
        "png" => Ok(Kind::Png),
        "svg" => Ok(Kind::Svg),
        "pdf" => Ok(Kind::Pdf),
        _ => {
            Err(Failure::Usage(format!("{}: a map is a .png, .svg or .pdf; name a file that ends so", path.display())))
        }
    }
}

fn options(args: &Args, kind: Kind, palette: Palette, world: &orogen::World, is_place: bool) -> Options {
    let stem = args.recipe.file_stem().unwrap_or(args.recipe.as_os_str()).to_string_lossy().into_owned();
    let recipe = world.recipe();
    let page = match args.paper {
        Some(paper) => Page::Paper(paper.sides(args.landscape)),
        None => Page::Fitted(LONGER),
    };
    let without = &args.without;
    let parts = Parts {
        title: !without.no_title,
        axes: !without.no_axes,
        contours: !without.no_contours,
        labels: !without.no_labels,
        summits: !without.no_summits,
        rivers: !without.no_rivers,
        // Depressions of a real place are mostly gorges that coarse samples dam; its lakes are as level as their outlets.
        lakes: !without.no_lakes && !is_place,
        legend: !without.no_legend,
        colors: !without.no_colors,
        scale: !without.no_scale,
        north: !without.no_north,
    };
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
    Options {
        title: args.title.clone().unwrap_or(stem),
        about,
        palette,
        shading: match args.shade {
            _ if without.no_shade => Shading::None,
            Shade::Single => Shading::Single,
            Shade::Multi => Shading::Multi,
            Shade::Swiss => Shading::Swiss,
            Shade::None => Shading::None,
        },
        interval: args.contours,
        parts,
        page,
        resolution,
        // A file of heights tells nothing of a sea: all of it is land.
        sea_level: (!is_place).then_some(recipe.world.sea_level),
        map: recipe.georeference(),
    }
}

/// The longer side of a page in millimetres, about.
fn longer(page: Page) -> f64 {
    match page {
        Page::Fitted(longer) => longer + 36.0,
        Page::Paper([width, height]) => width.max(height),
    }
}

/// Pixels of a square that the page fits in.
fn pixels(options: &Options) -> f64 {
    let side = match options.resolution {
        Resolution::Inch(dpi) => longer(options.page) * dpi / 25.4,
        Resolution::Longer(pixels) => f64::from(pixels),
    };
    side * side
}

/// Refuses pages that no memory holds.
fn afford(options: &Options, window: &Window, args: &Args) -> Result<(), Failure> {
    let side = pixels(options).sqrt();
    if side * side > MOST {
        return Err(Failure::Usage(format!(
            "a page of {:.0} pixels a side is more than there is memory for; ask for fewer --dpi or a smaller --paper",
            side
        )));
    }
    // The page twice, the picture and its heights, and the heights themselves.
    let bytes = side * side * 20.0 + window.len() as f64 * 4.0;
    Ok(memory::afford(bytes as u64, args.limits.memory)?)
}
