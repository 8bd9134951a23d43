//! A layer or a mesh in any format.

use std::path::Path;

use orogen::export::derived::layer::Nature;
use orogen::export::derived::list as derived;
use orogen::export::features::list as features;
use orogen::export::{ExportJob, Format, registry};
use orogen::options::OptionSpec;
use orogen::recipe::Recipe;
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Result, WorldSpec};

use super::command_line::CommandLine;
use super::given::{self, Given};
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// The settings of an export of a layer or a mesh.
#[derive(Debug, Clone)]
pub struct LayerExport {
    /// The format.
    pub format: &'static Format,
    /// The layer.
    pub layer: String,
    /// Number of samples along the longer side; `None` for the world's own cell.
    pub size: Option<usize>,
    /// Options of the format.
    pub options: Given,
    /// Options of the layer.
    pub layer_options: Given,
}

/// The option for the precision of meshes.
const MAX_ERROR: &str = "max-error";

impl LayerExport {
    /// An export of the heights in a format.
    #[must_use]
    pub fn new(format: &'static Format) -> LayerExport {
        LayerExport { format, layer: HEIGHT.into(), size: None, options: Given::new(), layer_options: Given::new() }
    }

    /// Selects another format and drops options that it lacks. If it cannot hold the layer, the heights are selected. A
    /// mesh gets few triangles: its error is a round number of metres near 1/250 of `relief`, the difference
    /// between the highest and the lowest height.
    pub fn set_format(&mut self, format: &'static Format, relief: Option<f64>) {
        let was_mesh = self.format.knows(MAX_ERROR);
        self.format = format;
        self.options.retain(|name, _| format.knows(name));
        if !holds(format, &self.layer) {
            self.set_layer(HEIGHT);
        }
        if let (true, false, Some(relief)) = (format.knows(MAX_ERROR), was_mesh, relief) {
            self.options.insert(MAX_ERROR, round(relief / 250.0).to_string());
        }
    }

    /// Selects another layer and drops options that it lacks.
    pub fn set_layer(&mut self, layer: &str) {
        self.layer = layer.to_owned();
        let known = layer_options(layer);
        self.layer_options.retain(|name, _| known.iter().any(|spec| spec.name == *name));
    }

    fn job(&self) -> Result<ExportJob> {
        let job = ExportJob::new(self.format)
            .with_layer(&self.layer)
            .with_options(given::read(self.format.options, &self.options)?)
            .with_layer_options(given::read(layer_options(&self.layer), &self.layer_options)?);
        job.check()?;
        Ok(job)
    }

    /// Adds the options of `orogen export`.
    pub fn words(&self, path: &Path, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        if registry::of_path(path).map_or(true, |format| format.name != self.format.name) {
            line.option("format", self.format.name);
        }
        line.differing("layer", self.layer.as_str(), &HEIGHT);
        Samples::of(region, self.size, world).sized(line);
        given::words(self.format.options, &self.options, line);
        given::words(layer_options(&self.layer), &self.layer_options, line);
    }

    /// Writes the file. Returns a description.
    ///
    /// # Errors
    /// If an option is not valid, or the export fails; then an existing file is unchanged.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        let job = self.job()?;
        job.prepare(&mut work.recipe)?;
        let world = work.open()?;
        let window = Samples::of(region, self.size, &work.recipe.world).window(&world)?;
        let output = work.policy().protecting(job.files()).output(&work.path)?;
        let written = job.with_window(window).to_file(&world, &output, work.progress)?;
        let warning = written.count.check(&format!("the layer `{}`", self.layer))?;
        Ok(lines(&written.words, warning))
    }
}

/// The layers of a recipe that a format can hold: its outputs, layers derived from the heights, and vector features.
#[must_use]
pub fn layers(format: &Format, recipe: &Recipe) -> Vec<String> {
    let mut names: Vec<String> = recipe.outputs().map(str::to_owned).collect();
    let derived = derived::all().iter().map(|layer| layer.name);
    let all = derived.chain(features::all().iter().map(|layer| layer.name));
    for name in all.filter(|name| holds(format, name)) {
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    names
}

/// The options of a derived layer.
pub fn layer_options(layer: &str) -> &'static [OptionSpec] {
    derived::named(layer).map_or(&[], |derived| (derived.options)())
}

/// Whether a format can hold a layer of this kind.
fn holds(format: &Format, layer: &str) -> bool {
    match (derived::named(layer), features::named(layer)) {
        (Some(derived), _) => derived.nature() == Nature::Numbers || format.channels > 1,
        (None, Some(_)) => format.features,
        (None, None) => true,
    }
}

/// The nearest number that is 1, 2 or 5 times a power of ten.
fn round(value: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(value.max(1e-3)).floor());
    let nearest = [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power);
    let rounded = nearest.min_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs())).unwrap_or(1.0);
    // Avoids rounding errors of powers.
    format!("{rounded:.0e}").parse().unwrap_or(rounded)
}

/// The format for the extension of a file.
///
/// # Errors
/// If there is no such format.
pub fn format_of(path: &Path) -> Result<&'static Format> {
    registry::of_path(path)
}

/// The error for an extension that a kind of export does not support.
pub(super) fn ending(path: &Path, what: &str, endings: &[&str]) -> Error {
    let message = format!("{}: {what} is a .{}; name a file that ends so", path.display(), endings.join(" or ."));
    Error::new(ErrorKind::Request, message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_gets_few_triangles_and_formats_drop_what_they_lack() {
        let named = |name: &str| registry::named(name).unwrap();
        let mut export = LayerExport::new(named("tif"));
        export.set_layer("normal");
        export.set_format(named("glb"), Some(2600.0));
        assert_eq!(
            (export.layer.as_str(), export.options.get("max-error").map(String::as_str)),
            ("height", Some("10"))
        );
        // A value that the user chose is kept for another kind of mesh.
        export.options.insert("max-error", "7".into());
        export.set_format(named("obj"), Some(2600.0));
        assert_eq!(export.options.get("max-error").map(String::as_str), Some("7"));
        export.set_format(named("geojson"), Some(2600.0));
        assert!(export.options.is_empty());
        let recipe = orogen::presets::find("classic").unwrap().recipe().unwrap();
        let names = layers(export.format, &recipe);
        assert!(names.iter().any(|layer| layer == "contours") && !names.iter().any(|layer| layer == "normal"));
        export.set_format(named("png"), None);
        let names = layers(export.format, &recipe);
        assert!(names.iter().any(|layer| layer == "normal") && !names.iter().any(|layer| layer == "contours"));
    }

    #[test]
    fn errors_are_round() {
        for (value, expect) in [(2.6, 2.0), (0.8, 1.0), (0.04, 0.05), (4.9, 5.0), (9.0, 10.0), (0.0, 0.001)] {
            assert_eq!(round(value), expect, "{value}");
        }
    }
}
