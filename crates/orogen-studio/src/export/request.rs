//! An export: its kind, the settings of each kind, and the file.

use std::path::{Path, PathBuf};

use orogen::export::registry;
use orogen::jobs::SheetFormat;
use orogen::recipe::Recipe;
use orogen::{Progress, Result, Session, WorldSpec};

use super::command_line::CommandLine;
use super::engine::EngineExport;
use super::kind::Kind;
use super::layer::{LayerExport, format_of};
use super::map::MapExport;
use super::render::RenderExport;
use super::tilemap::TilemapExport;
use super::work::Work;
use crate::preview::region::Region;

/// An export. The settings of each kind are kept while another kind is selected.
#[derive(Debug, Clone)]
pub struct Export {
    /// The selected kind.
    pub kind: Kind,
    /// A layer or a mesh.
    pub layer: LayerExport,
    /// A package for a game engine.
    pub engine: EngineExport,
    /// A map sheet.
    pub map: MapExport,
    /// A rendered picture.
    pub render: RenderExport,
    /// A map of tiles.
    pub tilemap: TilemapExport,
    /// The part of the world.
    pub region: Region,
    /// The file, or the folder.
    path: PathBuf,
}

impl Export {
    /// An export of the heights of a part of a world as GeoTIFF to a folder. `title` is the name of the recipe, and
    /// `is_place` says whether it is a file of heights.
    #[must_use]
    pub fn new(region: Region, title: &str, is_place: bool, folder: &Path) -> Option<Export> {
        let format = registry::named("tif").or(registry::all().first().copied())?;
        Some(Export {
            kind: Kind::default(),
            layer: LayerExport::new(format),
            engine: EngineExport::new()?,
            map: MapExport::new(title, is_place),
            render: RenderExport::default(),
            tilemap: TilemapExport::default(),
            region,
            path: folder.join(format!("{title}.{}", format.name)),
        })
    }

    /// The file or folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Selects another kind. The file gets its extension, and its default name unless the user has chosen a name.
    pub fn set_kind(&mut self, kind: Kind) {
        let usual = |kind: Kind| format!("{}{}", self.map.own_title, kind.suffix());
        if self.path.file_stem().is_some_and(|stem| *stem == *usual(self.kind)) {
            // The name gets an extension to replace, because a title may contain dots.
            self.path.set_file_name(format!("{}.file", usual(kind)));
        }
        self.kind = kind;
        self.set_extension();
    }

    /// Sets the extension of the file for the current settings.
    pub fn set_extension(&mut self) {
        let extension = match self.kind {
            Kind::Layer => self.layer.format.name,
            Kind::Engine => self.engine.formats().first().copied().unwrap_or_default(),
            Kind::Map => self.map.format.name(),
            Kind::Render => "png",
            Kind::Tilemap => "",
        };
        self.path.set_extension(extension);
    }

    /// Sets the path of the file, as typed. Its extension selects the format.
    pub fn set_path(&mut self, path: &str) {
        self.path = PathBuf::from(path);
        match self.kind {
            Kind::Layer => {
                if let Ok(format) = format_of(&self.path)
                    && format.name != self.layer.format.name
                {
                    self.layer.set_format(format, None);
                }
            }
            Kind::Map => self.map.format = SheetFormat::of_path(&self.path).unwrap_or(self.map.format),
            Kind::Engine | Kind::Render | Kind::Tilemap => {}
        }
    }

    /// The command line that makes the same file. `recipe` is the argument for the recipe, and `world` is its world.
    #[must_use]
    pub fn command_line(&self, recipe: &str, world: &WorldSpec) -> CommandLine {
        let command = match self.kind {
            Kind::Layer | Kind::Engine => "export",
            Kind::Map => "map",
            Kind::Render => "render",
            Kind::Tilemap => "tilemap",
        };
        let mut line = CommandLine::new(command, recipe);
        line.option("out", self.path.to_string_lossy());
        match self.kind {
            Kind::Layer => self.layer.words(&self.path, self.region, world, &mut line),
            Kind::Engine => self.engine.words(self.region, world, &mut line),
            Kind::Map => self.map.words(&self.path, self.region, world, &mut line),
            Kind::Render => self.render.words(self.region, world, &mut line),
            Kind::Tilemap => self.tilemap.words(self.region, world, &mut line),
        }
        line
    }

    /// Writes the files. `own` is the recipe's file. Returns a description.
    ///
    /// # Errors
    /// If an option is not valid, or the export fails; then an existing file is unchanged.
    pub fn run(&self, session: &Session, recipe: Recipe, own: Option<&Path>, progress: &Progress) -> Result<String> {
        let inputs = recipe.files().into_iter().chain(own.map(Path::to_path_buf)).collect();
        let work = Work { session, recipe, path: self.path.clone(), inputs, progress };
        match self.kind {
            Kind::Layer => self.layer.make(work, self.region),
            Kind::Engine => self.engine.make(work, self.region),
            Kind::Map => self.map.make(work, self.region),
            Kind::Render => self.render.make(work, self.region),
            Kind::Tilemap => self.tilemap.make(work, self.region),
        }
    }
}
