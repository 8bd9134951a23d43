//! Common parts of the formats for 3D printing: options, and the solid that they define.

use std::io;

use super::format::refuse;
use super::layer_source::LayerSource;
use super::memory::whole;
use super::mesh::{self, EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared};
use super::print_bed::{BED, Bed, ModelSize, flatness, shown};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::{count, number};
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_output::mesh::solid::{LEGIBLE, Print, RAISED, Solid};
use orogen_output::proportions;

/// `--print-size`.
pub const PRINT_SIZE: OptionSpec = OptionSpec::new("print-size", "MM", ValueKind::Number(1.0, 1e5))
    .with_about("Length of the longer side in millimetres [default: 150]");

/// `--base`.
pub const BASE: OptionSpec = OptionSpec::new("base", "MM", ValueKind::Number(0.1, 1e4))
    .with_about("Thickness of the base below the lowest sample, in millimetres [default: 3]");

/// `--cut`.
pub const CUT: OptionSpec = OptionSpec::new("cut", "M", ValueKind::Number(-1e6, 1e6)).with_about(
    "Print only the land above M metres, with its outline; its base begins there [default: all of the window]",
);

/// `--hollow`.
pub const HOLLOW: OptionSpec = OptionSpec::new("hollow", "MM", ValueKind::Number(0.8, 1e3)).with_about(
    "Hollow model, open below, with walls and a ceiling of at least MM millimetres, less than the base \
             [default: full]",
);

/// `--text`.
pub const TEXT: OptionSpec = OptionSpec::new("text", "TEXT", ValueKind::Text)
    .with_about("Letters on the southern side of the base, as large as it has room for [default: none]");

/// `--text-style`.
pub const TEXT_STYLE: OptionSpec = OptionSpec::new("text-style", "HOW", ValueKind::Word(&["raised", "engraved"]))
    .with_about("Letters of --text: raised, which stand out of the side, or engraved [default: raised]");

/// The options of solids.
pub const OPTIONS: &[OptionSpec] =
    &[MAX_ERROR, EXAGGERATION, HEIGHT_CURVE, PRINT_SIZE, BASE, CUT, HOLLOW, TEXT, TEXT_STYLE, BED];

/// Memory for drawing a letter, in bytes.
const LETTER: u64 = 160 << 10;

/// Memory of the solid of a window, in bytes, in addition to the memory for writing the file: the mesh, and 12 bytes
/// for each vertex and triangle. A cut takes the whole surface, the part that remains (for white noise, two vertices
/// per sample), and a copy for the base. A cavity also takes its ceiling at each vertex and the divided triangles; it
/// has at most two vertices per sample.
#[must_use]
pub fn memory(window: &Window, options: &Options) -> u64 {
    // In an adaptive mesh, one sample in five becomes a vertex.
    let corners = if options.has(MAX_ERROR.name) { whole(window) / 5 } else { whole(window) };
    let copies = match (options.has(CUT.name), options.has(HOLLOW.name)) {
        (true, true) => 10,
        (true, false) => 6,
        (false, _) => 1,
    };
    let solid = corners.saturating_mul(9 * copies);
    let ceiling = if options.has(HOLLOW.name) { whole(window).saturating_mul(20) } else { 0 };
    let letters = options.text(TEXT.name).map_or(0, |text| LETTER * text.chars().count() as u64);
    mesh::memory(window, options).saturating_add(solid).saturating_add(ceiling).saturating_add(letters)
}

/// A solid that is ready to be written.
pub struct PrintJob {
    /// The solid.
    pub solid: Solid,
    /// Progress of writing it.
    pub writing: Progress,
    words: String,
}

impl PrintJob {
    /// Makes the solid of the source's samples.
    ///
    /// Fails if the source fails, or if no solid can be made from it.
    pub fn new(source: &mut LayerSource, options: &Options) -> io::Result<PrintJob> {
        let bed = options.text(BED.name).map(Bed::parse).transpose()?;
        let mesh = Prepared::new(source, options, 1)?;
        let print_size = options.number(PRINT_SIZE.name).unwrap_or(150.0);
        let base = options.number(BASE.name).unwrap_or(3.0);
        let is_engraved = options.word(TEXT_STYLE.name) == Some("engraved");
        if options.has(TEXT_STYLE.name) && !options.has(TEXT.name) {
            return refuse(format!(
                "--{} applies to the letters of --{}; name them, or leave it out",
                TEXT_STYLE.name, TEXT.name
            ));
        }
        if is_engraved && options.has(CUT.name) {
            return refuse(format!(
                "--{} engraved does not apply with --{}: land above a cut may be thinner than letters are deep; use raised letters",
                TEXT_STYLE.name, CUT.name
            ));
        }
        let mut print = Print::new(print_size).with_base(base);
        print.hollow = options.number(HOLLOW.name);
        if let Some(level) = options.number(CUT.name) {
            let mut level = [level as f32];
            mesh.bend(&mut level);
            print = print.with_cut(f64::from(level[0]));
        }
        let surface = mesh.surface(0, false);
        let mut solid = Solid::new(&surface, &print)?;
        let letter = |text: &str| if is_engraved { solid.engrave(text, print.hollow) } else { solid.letter(text) };
        let letters = options.text(TEXT.name).map(letter).transpose()?;
        let exaggeration = f64::from(mesh.exaggeration());
        let raised = if letters.is_some() && !is_engraved { f64::from(RAISED) } else { 0.0 };
        let model = ModelSize { size: solid.size(), fixed: [0.0, raised, base], print_size, exaggeration };
        bed.map_or(Ok(()), |bed| bed.check(&model))?;
        let [low, high] = extremes(NO_SAMPLES, mesh.grid.data());
        let window = mesh.grid.window();
        let width = window.width.max(window.height) as f64 * window.cell;
        let steep = proportions::warning(f64::from(high) - f64::from(low), width, exaggeration);
        let warnings = [steep, flatness(&model), letters.and_then(small_letters)]
            .into_iter()
            .flatten()
            .map(|warning| format!("\nwarning: {warning}"));
        let shape = match options.number(CUT.name) {
            Some(level) => {
                format!("{} of the land above {} m", count(solid.triangles.len(), "triangle"), number(level))
            }
            None => mesh.words(),
        };
        let words = format!("{shape} and a base, {} mm{}", shown(model.size), warnings.collect::<String>());
        Ok(PrintJob { solid, writing: surface.progress.cloned().unwrap_or_else(Progress::none), words })
    }

    /// The end of the final message.
    #[must_use]
    pub fn words(self) -> String {
        self.words
    }
}

/// A warning if letters of this size are too small to print.
fn small_letters(size: f64) -> Option<String> {
    let told = |size: f64| number((size * 10.0).round() / 10.0);
    (size < LEGIBLE).then(|| {
        format!(
            "the letters of --text have a size of {} mm, and those below {} mm are hard to print; use a thicker --base or a shorter text",
            told(size),
            told(LEGIBLE)
        )
    })
}
