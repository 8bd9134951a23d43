//! What the formats of meshes share: their options, and the surface that these ask for.

use std::io;

use serde_json::{Value, json};

use super::files::{Files, Stopping};
use super::layer_source::LayerSource;
use super::memory::whole;
use super::mesh_tint;
use super::options::{OptionSpec, Options, ValueKind};
use crate::map::paint::Painter;
use crate::map::shade::Shade;
use crate::mesh::adaptive::{TILE, adaptive_with};
use crate::mesh::relief::HeightCurve;
use crate::mesh::shape::Shape;
use crate::mesh::surface::Surface;
use orogen_grid::analysis::halo::Halo;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::{count, number};
use orogen_io::format::dem::Georeference;
use orogen_io::format::levels::{NO_SAMPLES, extremes};

/// `--max-error`.
pub const MAX_ERROR: OptionSpec = OptionSpec {
    name: "max-error",
    value: "M",
    about: "Adaptive mesh with a vertical error of at most M metres at every sample [default: a full grid, two triangles per cell]",
    value_kind: ValueKind::Number(0.0, 1e9),
};

/// `--exaggeration`.
pub const EXAGGERATION: OptionSpec = OptionSpec {
    name: "exaggeration",
    value: "F",
    about: "Vertical exaggeration factor [default: 1]",
    value_kind: ValueKind::Number(0.001, 1000.0),
};

/// `--height-curve`.
pub const HEIGHT_CURVE: OptionSpec = OptionSpec {
    name: "height-curve",
    value: "A:B,...",
    about: "Curve applied to the heights, from 0:0 (lowest of the window) to 1:1 (highest), such as 0:0,0.5:0.2,1:1",
    value_kind: ValueKind::Text,
};

/// `--color`.
pub const COLOR: OptionSpec = OptionSpec {
    name: "color",
    value: "HOW",
    about: "Map colours without shading, stored as texture (a picture), vertex or none [default: texture; ply: vertex]",
    value_kind: ValueKind::Word(&["texture", "vertex", "none"]),
};

/// Nanoseconds of one core that a sample takes, about: to choose the corners of few triangles, or of all, to paint it, and to write its triangles.
const FEW_TRIANGLES: f64 = 250.0;
const LATTICE: f64 = 3.0;
const PAINTING: f64 = 60.0;
const WRITING: f64 = 60.0;

/// Bytes that a mesh of a window takes beside what its file is written from: the heights, and for few triangles these and the triangulations of the tiles at
/// work, if one sample in five becomes a corner.
pub fn memory(window: &Window, options: &Options) -> u64 {
    let samples = whole(window);
    match options.has(MAX_ERROR.name) {
        true => {
            let at_work = (TILE * TILE * rayon::current_num_threads() * size_of::<f32>()) as u64;
            samples.saturating_mul(2).saturating_add(samples.min(at_work).saturating_mul(6))
        }
        false => samples.saturating_mul(2),
    }
}

/// A grid and what is made of it.
pub struct Prepared {
    /// The heights, bent where that is asked for.
    pub grid: Grid,
    /// Levels of detail, the finest first.
    pub shapes: Vec<Shape>,
    /// What its corners or its picture are coloured with.
    pub painter: Painter,
    halo: Halo,
    exaggeration: f32,
    max_error: Option<f64>,
    /// The work that is left: a picture, and of each level the writing.
    painting: Progress,
    writing: Vec<Progress>,
    /// The curve that the heights were bent by, and their range before.
    curve: Option<(HeightCurve, [f32; 2])>,
    /// How metres lie on a map, where the recipe holds a real place.
    map: Option<Georeference>,
}

impl Prepared {
    /// The subject's samples, and so many shapes over them: of every second, fourth ... sample, or of twice, four times ... the error.
    ///
    /// Fails as the subject does, and on windows that are no mesh.
    pub fn new(source: &mut LayerSource, options: &Options, levels: usize) -> io::Result<Prepared> {
        let curve = options.text(HEIGHT_CURVE.name).map(HeightCurve::parse).transpose()?;
        let max_error = options.number(MAX_ERROR.name);
        let samples = source.window().len() as f64;
        let (shaping, writing) = if max_error.is_some() { (FEW_TRIANGLES, WRITING / 4.0) } else { (LATTICE, WRITING) };
        let progress = source.progress().clone();
        progress.expect(samples * (PAINTING + levels as f64 * (shaping + writing)));
        let mut halo = Halo::default();
        let mut grid = source.surrounded(&mut halo)?;
        // A mesh is lit by whoever shows it, so the map's own light stays out.
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

    /// A level of detail, its corners with colours if they are wanted.
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

    /// What heights are multiplied by.
    pub fn exaggeration(&self) -> f32 {
        self.exaggeration
    }

    /// How far samples are from the surface at most, where it has few triangles.
    pub fn max_error(&self) -> Option<f64> {
        self.max_error
    }

    /// Bends heights as those of the mesh were.
    pub fn bend(&self, heights: &mut [f32]) {
        if let Some((curve, range)) = &self.curve {
            curve.bend_within(*range, heights);
        }
    }

    /// The picture that it wears, as PNG: a pixel for each sample.
    ///
    /// Fails as `out` does, or if the work is cancelled.
    pub fn picture(&self, out: &mut dyn io::Write) -> io::Result<()> {
        self.painter.write_png(&mut Stopping { out, progress: &self.painting }, &self.grid, &[])?;
        self.painting.finish();
        Ok(())
    }

    /// Where it lies and how its axes are, for the comments of a file.
    pub fn comments(&self, axes: &str) -> Vec<String> {
        let window = self.grid.window();
        let place = format!(
            "the first sample, at the origin, stands {} m east and {} m south",
            window.east(0),
            window.south(0)
        );
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

    /// Where the origin lies on the map of a real place: what a file of keys and values tells of it.
    pub fn extras(&self) -> Vec<(String, Value)> {
        let Some(map) = &self.map else { return Vec::new() };
        let window = self.grid.window();
        let mut extras = vec![
            ("origin".to_string(), json!(map.at(window.east(0), window.south(0)))),
            ("map_units_per_metre".to_string(), json!(map.per_metre)),
        ];
        extras.extend(map.epsg().map(|code| ("crs".to_string(), json!(format!("EPSG:{code}")))));
        extras.extend(map.wkt().ok().map(|wkt| ("wkt".to_string(), json!(wkt))));
        extras
    }

    /// How much there is, in words.
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

/// How a mesh is coloured: what is asked for, else `otherwise`. A stream has no picture beside it.
pub fn color(options: &Options, otherwise: &'static str, files: &Files, beside: bool) -> &'static str {
    match options.word(COLOR.name).unwrap_or(otherwise) {
        "texture" if beside && files.path().is_none() => "none",
        color => color,
    }
}
