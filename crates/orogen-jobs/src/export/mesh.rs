//! Common parts of the mesh formats: options, and the surface that they define.

use std::io;

use serde_json::{Value, json};

use super::files::Files;
use super::layer_source::LayerSource;
use super::memory::whole;
use super::mesh_tint;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_grid::analysis::halo::Halo;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_grid::words::{count, number};
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::format::dem::Georeference;
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_output::map::paint::Painter;
use orogen_output::map::shade::Shade;
use orogen_output::mesh::adaptive::{TILE, adaptive_with};
use orogen_output::mesh::relief::HeightCurve;
use orogen_output::mesh::shape::Shape;
use orogen_output::mesh::surface::Surface;

/// `--max-error`.
pub const MAX_ERROR: OptionSpec = OptionSpec::new("max-error", "M", ValueKind::Number(0.0, 1e9)).with_about(
    "Adaptive mesh with a vertical error of at most M metres at every sample [default: a full grid, two \
             triangles per cell]",
);

/// `--exaggeration`.
pub const EXAGGERATION: OptionSpec = OptionSpec::new("exaggeration", "F", ValueKind::Number(0.001, 1000.0))
    .with_about("Vertical exaggeration factor [default: 1]");

/// `--height-curve`.
pub const HEIGHT_CURVE: OptionSpec = OptionSpec::new("height-curve", "A:B,...", ValueKind::Text).with_about(
    "Curve applied to the heights, from 0:0 (lowest of the window) to 1:1 (highest), such as 0:0,0.5:0.2,1:1",
);

/// `--color`.
pub const COLOR: OptionSpec = OptionSpec::new("color", "HOW", ValueKind::Word(&["texture", "vertex", "none"]))
    .with_about(
        "Map colors without shading, stored as texture (a picture), vertex or none [default: texture; ply: vertex]",
    );

/// Approximate time per sample on one core, in nanoseconds: for choosing the vertices of an adaptive mesh or of a full
/// grid, for painting, and for writing triangles.
const FEW_TRIANGLES: f64 = 250.0;
const LATTICE: f64 = 3.0;
const PAINTING: f64 = 60.0;
const WRITING: f64 = 60.0;

/// Memory of a mesh of a window, in bytes, in addition to the memory for writing the file: the heights and, for an
/// adaptive mesh, its triangles and the triangulations in progress, if one sample in five becomes a vertex.
#[must_use]
pub fn memory(window: &Window, options: &Options) -> u64 {
    let samples = whole(window);
    match options.has(MAX_ERROR.name) {
        true => {
            let at_work = (TILE * TILE * parallel::threads() * size_of::<f32>()) as u64;
            samples.saturating_mul(2).saturating_add(samples.min(at_work).saturating_mul(6))
        }
        false => samples.saturating_mul(2),
    }
}

/// A grid and the meshes made from it.
pub struct Prepared {
    /// The heights, remapped by the height curve if there is one.
    pub grid: Grid,
    /// Levels of detail, the finest first.
    pub shapes: Vec<Shape>,
    /// The painter of the vertices or the texture.
    pub painter: Painter,
    halo: Halo,
    exaggeration: f32,
    max_error: Option<f64>,
    /// Progress of the remaining work: the texture, and writing each level.
    painting: Progress,
    writing: Vec<Progress>,
    /// The height curve, and the range of heights before it.
    curve: Option<(HeightCurve, [f32; 2])>,
    /// The position of metres on a map, if the recipe contains a real place or a `crs`.
    map: Option<Georeference>,
}

impl Prepared {
    /// The source's samples with `levels` meshes: each further level uses every second, fourth ... sample, or two
    /// times, four times ... the error.
    ///
    /// Fails if the source fails, or the window is too small for a mesh.
    pub fn new(source: &mut LayerSource, options: &Options, levels: usize) -> io::Result<Prepared> {
        let curve = options.text(HEIGHT_CURVE.name).map(HeightCurve::parse).transpose()?;
        let max_error = options.number(MAX_ERROR.name);
        let samples = source.window().len() as f64;
        let (shaping, writing) = if max_error.is_some() { (FEW_TRIANGLES, WRITING / 4.0) } else { (LATTICE, WRITING) };
        let progress = source.progress().clone();
        progress.expect(samples * (PAINTING + levels as f64 * (shaping + writing)));
        let mut halo = Halo::default();
        let mut grid = source.surrounded(&mut halo)?;
        // Viewers light the mesh, so the map's shading is omitted.
        let painter = Painter::new(mesh_tint::of(source, options)?, Shade::new(0.0));
        let range = extremes(NO_SAMPLES, grid.data());
        if let Some(curve) = &curve {
            curve.bend(&mut grid, &mut halo);
        }
        let curve = curve.map(|curve| (curve, range));
        let shape = |level: usize| {
            let part = progress.part(samples * shaping);
            part.check()?;
            let shape = match max_error {
                Some(max_error) => adaptive_with(&grid, max_error * (1u64 << level) as f64, &part),
                None => Shape::lattice(&grid, 1 << level),
            };
            part.finish();
            shape
        };
        let shapes = (0..levels).map(shape).collect::<Result<Vec<Shape>>>()?;
        let exaggeration = options.number(EXAGGERATION.name).unwrap_or(1.0) as f32;
        let painting = progress.part(samples * PAINTING);
        let writing = (0..levels).map(|_| progress.part(samples * writing)).collect();
        let map = source.map();
        Ok(Prepared { grid, halo, shapes, painter, exaggeration, max_error, painting, writing, curve, map })
    }

    /// A level of detail, with vertex colors on request.
    #[must_use]
    pub fn surface(&self, level: usize, colors: bool) -> Surface<'_> {
        Surface {
            grid: &self.grid,
            halo: &self.halo,
            shape: &self.shapes[level],
            exaggeration: self.exaggeration,
            painter: colors.then_some(&self.painter),
            progress: Some(&self.writing[level]),
        }
    }

    /// The factor that heights are multiplied by.
    #[must_use]
    pub fn exaggeration(&self) -> f32 {
        self.exaggeration
    }

    /// The error of an adaptive mesh; `None` for a full grid.
    #[must_use]
    pub fn max_error(&self) -> Option<f64> {
        self.max_error
    }

    /// Remaps heights by the height curve of the mesh.
    pub fn bend(&self, heights: &mut [f32]) {
        if let Some((curve, range)) = &self.curve {
            curve.bend_within(*range, heights);
        }
    }

    /// The texture as PNG: one pixel per sample.
    ///
    /// Fails if `out` fails, or if the work is cancelled.
    pub fn picture(&self, out: &mut dyn io::Write) -> io::Result<()> {
        self.painter.write_png(&mut CancellableWriter { out, progress: &self.painting }, &self.grid, None, &[])?;
        self.painting.finish();
        Ok(())
    }

    /// Position and axes, for the comments of a file.
    #[must_use]
    pub fn comments(&self, axes: &str) -> Vec<String> {
        let window = self.grid.window();
        let place =
            format!("the first sample, at the origin, is {} m east and {} m south", window.east(0), window.south(0));
        let mut comments =
            vec![concat!("Orogen ", env!("CARGO_PKG_VERSION")).into(), format!("metres; {axes}; {place}")];
        if let Some(map) = &self.map {
            let [east, north] = map.at(window.east(0), window.south(0));
            let system = match (map.epsg(), map.wkt()) {
                (Some(code), _) => format!("EPSG:{code}"),
                (None, Ok(wkt)) => wkt,
                (None, Err(why)) => format!("an unknown coordinate system: {why}"),
            };
            comments.push(format!("the origin on the map: east {east}, north {north}, in {system}"));
            let [across, up] = map.per_metre;
            if [across, up] != [1.0; 2] {
                comments.push(format!("the map's units in a metre: {across} east, {up} north"));
            }
        }
        comments
    }

    /// The position of the origin on the map of a real place, as keys and values.
    #[must_use]
    pub fn extras(&self) -> Vec<(String, Value)> {
        let Some(map) = &self.map else { return Vec::new() };
        let window = self.grid.window();
        let mut extras = vec![
            ("origin".to_string(), json!(map.at(window.east(0), window.south(0)))),
            ("map_units_per_metre".to_string(), json!(map.per_metre)),
        ];
        extras.extend(map.epsg().map(|code| ("crs".to_string(), json!(format!("EPSG:{code}")))));
        extras.push(match map.wkt() {
            Ok(wkt) => ("wkt".to_string(), json!(wkt)),
            Err(why) => ("crs_missing".to_string(), json!(why)),
        });
        extras
    }

    /// A summary of the number of triangles.
    #[must_use]
    pub fn words(&self) -> String {
        let counts: Vec<String> = self.shapes.iter().map(|shape| shape.triangles().to_string()).collect();
        let counts = match counts.as_slice() {
            [_] => count(self.shapes[0].triangles(), "triangle"),
            many => format!("levels of {} triangles", many.join(", ")),
        };
        match self.max_error {
            Some(error) => format!("{counts}, no sample more than {} m above or below them", number(error)),
            None => counts,
        }
    }
}

/// The coloring of a mesh: the requested one, or `otherwise` by default. A stream has no separate texture file.
#[must_use]
pub fn color(options: &Options, otherwise: &'static str, files: &Files, beside: bool) -> &'static str {
    match options.word(COLOR.name).unwrap_or(otherwise) {
        "texture" if beside && files.path().is_none() => "none",
        color => color,
    }
}
