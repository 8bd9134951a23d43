//! Layers prepared for writing: vector features, or the contours of a layer of samples.

use std::io;

use super::layer::{Maker, Style, VectorLayer};
use super::options::{FeatureOptions, OPTIONS};
use super::source::FeatureSource;
use crate::export::contours::{self, Contours};
use crate::export::format::{Format, Writer};
use crate::export::layer_source::LayerSource;
use crate::export::{contour_options, vectors};
use crate::options::Options;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::format::dem::Georeference;
use orogen_io::format::features::{Crs, Definition, FeatureLayer};

/// Layers with their coordinate system.
pub struct Drawing {
    /// The layers, each with its style.
    pub layers: Vec<(FeatureLayer, Style)>,
    map: Option<Georeference>,
    /// Distance between samples in metres, or less for features that are not made from samples.
    cell: f64,
    /// The summary of the contours of a layer of samples.
    contours: Option<String>,
}

/// A format for vector features and for contours of layers of samples.
pub const fn format(name: &'static str, about: &'static str, write: Writer) -> Format {
    Format { name, aliases: &[], about, options: OPTIONS, channels: 1, features: true, memory: contours::memory, write }
}

/// The contours of a source's samples.
///
/// Fails if the source fails, or the levels cannot be parsed.
pub fn contours(source: &mut LayerSource, options: &Options) -> io::Result<Contours> {
    contour_options::check(options)?;
    Ok(contours::on(&source.whole()?.swap_remove(0), options)?)
}

impl Drawing {
    /// The source's layers as features, in metres east and south of the world's origin.
    ///
    /// Fails if the source fails, or an option belongs to none of the layers.
    pub fn of(source: &mut LayerSource, options: &Options) -> io::Result<Drawing> {
        let (map, mut cell) = (source.map(), source.window().cell);
        let asked = source.vectors().to_vec();
        let mut words = None;
        let layers = match asked.as_slice() {
            [] => {
                let found = contours(source, options)?;
                words = Some(found.words(source.unit()));
                vec![(vectors::contours::features(&found), vectors::contours::LAYER.style)]
            }
            asked => {
                check(asked, options)?;
                let wanted = FeatureOptions::new(options, source.world().recipe())?;
                let (world, window, progress) = (source.world(), *source.window(), source.progress().clone());
                let ground = match asked.iter().any(|layer| matches!(layer.make, Maker::Ground(_))) {
                    true => Some(FeatureSource::of(world, &window, &wanted, 0, &progress)?),
                    false => None,
                };
                let heights = ground.as_ref().and_then(FeatureSource::heights);
                source.made_of(heights.map_or(FiniteCount::default(), |heights| FiniteCount::of(heights.data())));
                let mut layers = Vec::with_capacity(asked.len());
                for layer in asked {
                    match (&layer.make, &ground) {
                        (Maker::Ground(make), Some(ground)) => {
                            layers.push((make(ground, &wanted, &progress)?, layer.style))
                        }
                        (Maker::Ground(_), None) => {}
                        (Maker::World(make), _) => {
                            // Objects are closer to each other than samples.
                            cell = cell.min(1.0);
                            layers.push((make(world, &window, &progress)?, layer.style));
                        }
                    }
                }
                layers
            }
        };
        Ok(Drawing { layers, map, cell, contours: words })
    }

    /// Converts metres of the world to map coordinates.
    pub fn place(&mut self) {
        self.layers.iter_mut().for_each(|(layer, _)| layer.place(self.map.as_ref()));
    }

    /// The coordinate system after [`Drawing::place`].
    pub fn crs(&self) -> Crs<'_> {
        self.map.as_ref().map_or(Crs::Local, Crs::Map)
    }

    /// The resolution that coordinates need, in map units: the distance between samples, or less.
    pub fn step(&self) -> f64 {
        self.map.as_ref().map_or(self.cell, |map| self.cell * map.per_metre[0].min(map.per_metre[1]))
    }

    /// The only layer, for formats with a single layer.
    ///
    /// Fails if there are several.
    pub fn only(&self, format: &str) -> io::Result<&FeatureLayer> {
        match self.layers.as_slice() {
            [(layer, _)] => Ok(layer),
            _ => {
                let message = format!("a .{format} file holds one layer; choose one with --layer, or write a .gpkg");
                Err(Error::new(ErrorKind::Request, message).into())
            }
        }
    }

    /// [`Drawing::words`], and the reason if the file cannot store the coordinate system of the map.
    pub fn words_with_crs(&self) -> String {
        let words = self.words();
        match (self.crs().definition(), &self.map) {
            (Definition::Unknown { .. }, Some(map)) => {
                let why = map.wkt().err().unwrap_or_default();
                format!("{words}; without its coordinate system: {why}")
            }
            _ => words,
        }
    }

    /// A summary of the number of features.
    pub fn words(&self) -> String {
        if let Some(words) = &self.contours {
            return words.clone();
        }
        let counts: Vec<String> = (self.layers.iter())
            .map(|(layer, _)| match layer.features.len() {
                1 => format!("1 feature of {}", layer.name),
                count => format!("{count} features of {}", layer.name),
            })
            .collect();
        counts.join(", ")
    }
}

/// Checks that each given option belongs to one of the layers.
fn check(layers: &[&VectorLayer], options: &Options) -> Result<()> {
    let all = || OPTIONS.iter().map(|spec| spec.name);
    for name in options.names().filter(|name| all().any(|known| known == *name)) {
        if !layers.iter().any(|layer| layer.options.contains(&name)) {
            let knows: Vec<&str> = super::list::all()
                .iter()
                .filter(|layer| layer.options.contains(&name))
                .map(|layer| layer.name)
                .collect();
            let message = format!("--{name} has no effect here; it applies to {}", knows.join(", "));
            return Err(Error::new(ErrorKind::Request, message));
        }
    }
    Ok(())
}
