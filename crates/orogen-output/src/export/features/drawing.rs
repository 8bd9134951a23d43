//! Layers ready to be written: those of vector features that were asked for, or the contours of a layer of samples.

use std::io;

use super::layer::{Style, VectorLayer};
use super::options::FeatureOptions;
use super::source::FeatureSource;
use crate::export::contour_options;
use crate::export::contours::{self, Contours};
use crate::export::layer_source::LayerSource;
use crate::export::options::Options;
use crate::export::vectors;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::format::dem::Georeference;
use orogen_io::format::features::{Crs, FeatureLayer};

/// Layers, and where they lie.
pub struct Drawing {
    /// The layers, and how each is drawn.
    pub layers: Vec<(FeatureLayer, Style)>,
    map: Option<Georeference>,
    cell: f64,
    /// What there is to say of the contours of a layer of samples.
    contours: Option<String>,
}

/// The contours of a subject's samples.
///
/// Fails as the subject does, or if the levels cannot be read.
pub fn contours(source: &mut LayerSource, options: &Options) -> io::Result<Contours> {
    contour_options::check(options)?;
    Ok(contours::on(&source.whole()?.swap_remove(0), options)?)
}

impl Drawing {
    /// What a subject's layers are as features, in metres east and south of the world's origin.
    ///
    /// Fails as the subject does, and if an option was given that none of the layers knows.
    pub fn of(source: &mut LayerSource, options: &Options) -> io::Result<Drawing> {
        let (map, cell) = (source.map(), source.window().cell);
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
                let ground = FeatureSource::of(source.world(), source.window(), &wanted, 0, source.progress())?;
                source.made_of(
                    ground.heights().map_or(FiniteCount::default(), |heights| FiniteCount::of(heights.data())),
                );
                let make = |layer: &&VectorLayer| Ok(((layer.make)(&ground, &wanted)?, layer.style));
                asked.iter().map(make).collect::<Result<Vec<_>>>()?
            }
        };
        Ok(Drawing { layers, map, cell, contours: words })
    }

    /// Turns metres of the world into map coordinates.
    pub fn place(&mut self) {
        self.layers.iter_mut().for_each(|(layer, _)| layer.place(self.map.as_ref()));
    }

    /// The system of the coordinates once they are placed.
    pub fn crs(&self) -> Crs<'_> {
        self.map.as_ref().map_or(Crs::Local, Crs::Map)
    }

    /// From one sample to the next, in the map's unit.
    pub fn step(&self) -> f64 {
        self.map.as_ref().map_or(self.cell, |map| self.cell * map.per_metre[0].min(map.per_metre[1]))
    }

    /// The only layer, for formats that hold no more.
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

    /// How much there is, in words.
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

/// Whether each option that was given changes one of the layers.
fn check(layers: &[&VectorLayer], options: &Options) -> Result<()> {
    let all = || super::options::OPTIONS.iter().map(|spec| spec.name);
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
