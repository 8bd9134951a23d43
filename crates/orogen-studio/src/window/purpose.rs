//! The purpose of choosing a file.

use std::path::PathBuf;

/// The purpose of choosing a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Opening a document.
    Open,
    /// Saving the document.
    Save,
    /// Reading a palette.
    OpenPalette,
    /// Writing a palette.
    SavePalette,
}

impl Purpose {
    /// The catalog key of the dialog's title.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Purpose::Open => "command.open",
            Purpose::Save => "command.save_as",
            Purpose::OpenPalette => "colors.open",
            Purpose::SavePalette => "colors.save",
        }
    }

    /// The catalog key of the name of its files.
    #[must_use]
    pub fn files(self) -> &'static str {
        match self {
            Purpose::Open => "file.lands",
            Purpose::Save => "file.recipes",
            Purpose::OpenPalette | Purpose::SavePalette => "file.palettes",
        }
    }

    /// The path of a chosen file: a new file without an extension gets the usual one.
    #[must_use]
    pub fn completed(self, path: PathBuf) -> PathBuf {
        if self.saves() && path.extension().is_none() { path.with_extension("toml") } else { path }
    }

    /// Whether the file is written.
    #[must_use]
    pub fn saves(self) -> bool {
        matches!(self, Purpose::Save | Purpose::SavePalette)
    }

    /// Extensions of the files that are listed.
    #[must_use]
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Purpose::Open | Purpose::Save => &RECIPES,
            Purpose::OpenPalette | Purpose::SavePalette => &PALETTES,
        }
    }
}

/// Extensions of recipes and common files of heights, and of palettes.
const PALETTES: [&str; 4] = ["toml", "cpt", "gpl", "txt"];
const RECIPES: [&str; 9] = ["toml", "json", "tif", "tiff", "asc", "hgt", "npy", "exr", "zarr"];
