//! Exports that are kept in a recipe.

use std::path::Path;

use orogen::export::registry;
use orogen::export::targets::list as targets;
use orogen::jobs::{MapJob, RenderJob, SheetFormat};
use orogen::tilemap::TilemapJob;
use orogen::world::HEIGHT;

use super::given;
use super::kind::Kind;
use super::layer::{LayerExport, layer_options};
use super::request::Export;
use crate::editing::kept::KeptExport;
use crate::preview::region::Region;

impl Export {
    /// The export as a recipe keeps it. A file in `folder` is named relative to it.
    #[must_use]
    pub fn to_kept(&self, folder: &Path) -> KeptExport {
        let file = self.path().strip_prefix(folder).unwrap_or(self.path());
        let mut kept = KeptExport {
            kind: self.kind.keyword().to_owned(),
            file: file.to_string_lossy().into_owned(),
            part: match self.region {
                Region::Whole => None,
                Region::Square { center: [east, south], side } => Some([east, south, side]),
            },
            ..KeptExport::default()
        };
        let layer_of = |layer: &str| if layer == HEIGHT { String::new() } else { layer.to_owned() };
        match self.kind {
            Kind::Layer => {
                let own = &self.layer;
                (kept.layer, kept.format, kept.size) = (layer_of(&own.layer), own.format.name.to_owned(), own.size);
                kept.options = given::kept(own.format.options, &own.options);
                kept.layer_options = given::kept(layer_options(&own.layer), &own.layer_options);
            }
            Kind::Engine => {
                let own = &self.engine;
                (kept.layer, kept.format, kept.size) = (layer_of(&own.layer), own.target.name.to_owned(), own.side);
                kept.tiles = (own.tiles != [1, 1]).then_some(own.tiles);
            }
            Kind::Map => {
                (kept.format, kept.size) = (self.map.format.name().to_owned(), self.map.samples);
                kept.options = given::kept(MapJob::OPTIONS, &self.map.options);
            }
            Kind::Render => {
                kept.size = self.render.samples;
                kept.options = given::kept(RenderJob::OPTIONS, &self.render.options);
            }
            Kind::Tilemap => {
                kept.size = Some(self.tilemap.size);
                kept.options = given::kept(TilemapJob::OPTIONS, &self.tilemap.options);
            }
        }
        kept
    }

    /// The export that a recipe in `folder` keeps, with what it does not say from another one. Parts that this version
    /// does not know are left out; `None` if its kind is one of them.
    #[must_use]
    pub fn of_kept(kept: &KeptExport, folder: &Path, other: &Export) -> Option<Export> {
        let mut export = other.clone();
        export.kind = Kind::of_keyword(&kept.kind)?;
        let layer = if kept.layer.is_empty() { HEIGHT } else { &kept.layer };
        match export.kind {
            Kind::Layer => {
                let mut own = LayerExport::new(registry::named(&kept.format)?);
                own.set_layer(layer);
                own.size = kept.size;
                own.options = given::of_kept(own.format.options, &kept.options);
                own.layer_options = given::of_kept(layer_options(layer), &kept.layer_options);
                export.layer = own;
            }
            Kind::Engine => {
                let target = targets::all().iter().find(|target| target.name == kept.format).copied()?;
                export.engine.layer = layer.to_owned();
                export.engine.set_target(target);
                (export.engine.side, export.engine.tiles) = (kept.size, kept.tiles.unwrap_or([1, 1]));
            }
            Kind::Map => {
                let format = SheetFormat::of_path(Path::new(&format!("map.{}", kept.format)));
                (export.map.format, export.map.samples) = (format?, kept.size);
                export.map.options = given::of_kept(MapJob::OPTIONS, &kept.options);
            }
            Kind::Render => {
                export.render.samples = kept.size;
                export.render.options = given::of_kept(RenderJob::OPTIONS, &kept.options);
            }
            Kind::Tilemap => {
                export.tilemap.size = kept.size.unwrap_or(TilemapJob::SIDE);
                export.tilemap.options = given::of_kept(TilemapJob::OPTIONS, &kept.options);
            }
        }
        export.region = match kept.part {
            Some([east, south, side]) if side > 0.0 && [east, south, side].iter().all(|part| part.is_finite()) => {
                Region::Square { center: [east, south], side }
            }
            _ => Region::Whole,
        };
        export.set_path(&folder.join(&kept.file).to_string_lossy());
        Some(export)
    }
}

/// How an export is sent to another instance of the program, for `#[serde(with = ...)]`.
pub mod wire {
    use serde::de::Error as _;
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{Export, KeptExport, Path, Region};

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn serialize<S: Serializer>(export: &Export, to: S) -> Result<S::Ok, S::Error> {
        let kept = serde_json::to_string(&export.to_kept(Path::new(""))).map_err(S::Error::custom)?;
        (kept, &export.map.own_title, export.map.is_place).serialize(to)
    }

    #[allow(missing_docs, clippy::missing_errors_doc, reason = "as in serde")]
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Export, D::Error> {
        let (kept, title, is_place) = <(String, String, bool)>::deserialize(from)?;
        let kept: KeptExport = serde_json::from_str(&kept).map_err(D::Error::custom)?;
        Export::new(Region::Whole, &title, is_place, Path::new(""))
            .and_then(|usual| Export::of_kept(&kept, Path::new(""), &usual))
            .ok_or_else(|| D::Error::custom("no such kind of export"))
    }
}
