//! The kinds of exports.

/// A kind of export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kind {
    /// A layer or a mesh in any format.
    #[default]
    Layer,
    /// A package for a game engine.
    Engine,
    /// A map sheet.
    Map,
    /// A rendered picture.
    Render,
    /// A map of tiles.
    Tilemap,
}

impl Kind {
    /// All kinds, each with the key of its name.
    pub const ALL: [(Kind, &'static str); 5] = [
        (Kind::Layer, "export.kind_layer"),
        (Kind::Engine, "export.kind_engine"),
        (Kind::Map, "export.kind_map"),
        (Kind::Render, "export.kind_render"),
        (Kind::Tilemap, "export.kind_tilemap"),
    ];

    /// Its name in recipes.
    #[must_use]
    pub fn keyword(self) -> &'static str {
        match self {
            Kind::Layer => "layer",
            Kind::Engine => "engine",
            Kind::Map => "map",
            Kind::Render => "render",
            Kind::Tilemap => "tilemap",
        }
    }

    /// The kind with this name in recipes.
    #[must_use]
    pub fn of_keyword(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().map(|(kind, _)| kind).find(|kind| kind.keyword() == name)
    }

    /// The suffix of its file name after the name of the recipe, so that no kind replaces the file of another one.
    #[must_use]
    pub fn suffix(self) -> &'static str {
        match self {
            Kind::Layer | Kind::Engine => "",
            Kind::Map => "-map",
            Kind::Render => "-render",
            Kind::Tilemap => "-tiles",
        }
    }

    /// Whether the output is a folder of files.
    #[must_use]
    pub fn is_folder(self) -> bool {
        self == Kind::Tilemap
    }
}
