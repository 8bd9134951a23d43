//! `orogen graph`.

use std::path::PathBuf;

use clap::ValueEnum;

use orogen::grid::words::count;
use orogen::output::sheet::{pdf, raster, vector};

use crate::failure::Failure;
use crate::graph::diagram::Diagram;
use crate::graph::{dot, draw};
use crate::options::DrawOptions;
use crate::sink::{Sink, kind};
use crate::source::{Source, title};
use crate::values::arguments::Arguments;
use crate::values::number::dpi;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or - for standard input
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    /// File to write: .svg, .pdf, .png, or .dot for Graphviz; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "graph.svg")]
    out: PathBuf,
    /// Format, if the file extension does not determine it [default: svg]
    #[arg(long)]
    format: Option<Kind>,
    /// Resolution of a .png, in pixels per inch
    #[arg(long, value_name = "N", value_parser = dpi(), default_value = "150")]
    dpi: u16,
    #[command(flatten)]
    arguments: Arguments,
    #[command(flatten)]
    options: DrawOptions,
    /// Print no summary
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Vector drawing
    Svg,
    /// PDF page
    Pdf,
    /// Picture
    Png,
    /// Graphviz source
    Dot,
}

const KINDS: [(Kind, &str); 5] =
    [(Kind::Svg, "svg"), (Kind::Pdf, "pdf"), (Kind::Png, "png"), (Kind::Dot, "dot"), (Kind::Dot, "gv")];

/// Maximum number of boxes of a drawing; Graphviz may handle more.
const MAX_BLOCKS: usize = 2000;

/// Maximum number of pixels of a picture.
const MAX_PIXELS: f32 = 4e8;

/// Draws the graph.
pub fn run(args: &Args) -> Result<(), Failure> {
    let kind = kind(&args.out, args.format, &KINDS, "a graph is a")?;
    let source = Source::find(&args.recipe)?;
    let recipe = source.read(&args.options.budget(), &args.arguments)?;
    let sink = Sink::new(&args.out, &args.options.replace.policy(source.inputs(&recipe)))?;
    let diagram = Diagram::of(&recipe)?;
    let title = title(&args.recipe);
    let blocks = diagram.blocks.len();
    if kind == Kind::Dot {
        let text = dot::text(&diagram, &title);
        sink.write(|out| out.write_all(text.as_bytes()))?;
    } else if blocks > MAX_BLOCKS {
        return Err(Failure::Usage(format!(
            "a drawing has at most {MAX_BLOCKS} boxes, and this one needs {blocks}; write a .dot file for Graphviz instead"
        )));
    } else {
        let scene = draw::draw(&diagram, &title)?;
        match kind {
            Kind::Svg => sink.write(|out| vector::write(out, &scene))?,
            Kind::Pdf => sink.write(|out| pdf::write(out, &scene))?,
            _ => {
                let dpi = f32::from(args.dpi) / 25.4;
                if scene.size.width * scene.size.height * dpi * dpi > MAX_PIXELS {
                    return Err(Failure::Usage(
                        "the picture would be too large; use a lower --dpi, or write a .svg".into(),
                    ));
                }
                sink.picture(&raster::draw(&scene, f64::from(args.dpi)))?;
            }
        }
    }
    let nodes = recipe.nodes().len();
    let words = [count(nodes, "node"), count(blocks - nodes, "output"), count(diagram.wires.len(), "wire")];
    sink.tell(args.quiet, &format!("{}: {}\n", args.out.display(), words.join(", ")))
}
