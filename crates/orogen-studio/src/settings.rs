//! Settings that are remembered between runs.

pub mod layout;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use self::layout::{KeptLayout, Layout};
use crate::catalogue::Language;
use crate::files;
use crate::platform;

/// Maximum number of recent files.
const RECENT: usize = 12;

/// The color theme of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// Dark.
    Dark,
    /// Light.
    Light,
    /// The theme of the system.
    #[default]
    System,
}

/// Settings that are remembered between runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// The language of the interface; the system's language if it was never chosen.
    pub language: Option<Language>,
    /// The color theme.
    pub theme: Theme,
    /// The most recently opened files, the latest first.
    pub recent: Vec<PathBuf>,
    /// The size of the window, in points.
    pub window: Option<[f32; 2]>,
    /// Scale of the interface; 1 is normal.
    pub scale: f32,
    /// Memory limit in bytes.
    pub memory: u64,
    /// Kept cameras of the 3D view, as numbers.
    pub views: Vec<[f32; 6]>,
    /// Whether nodes of the graph show small pictures.
    pub thumbnails: bool,
    /// Whether files are chosen in dialogs of the system, if it has any.
    pub has_system_dialogs: bool,
    /// The layout of the window.
    pub layout: Layout,
    /// Layouts that were kept under a name.
    pub layouts: Vec<KeptLayout>,
}

/// The default of [`Settings::memory`].
const MEMORY: u64 = platform::MEMORY;

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            language: None,
            theme: Theme::System,
            recent: Vec::new(),
            window: None,
            scale: 1.0,
            memory: MEMORY,
            views: Vec::new(),
            thumbnails: true,
            has_system_dialogs: true,
            layout: Layout::default(),
            layouts: Vec::new(),
        }
    }
}

const FILE: &str = "studio.json";

impl Settings {
    /// Reads the settings in a folder; the defaults if there are none, or they cannot be read.
    #[must_use]
    pub fn read(folder: Option<&Path>) -> Settings {
        let text = folder.and_then(|folder| files::read(&folder.join(FILE)).ok());
        let mut settings: Settings = text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        settings.recent.truncate(RECENT);
        settings.scale = if settings.scale.is_finite() { settings.scale.clamp(0.5, 3.0) } else { 1.0 };
        settings.memory = settings.memory.max(256 << 20);
        settings.layout = settings.layout.sound();
        settings.layouts.iter_mut().for_each(|kept| kept.layout = kept.layout.sound());
        settings
    }

    /// Writes the settings. Errors are ignored, because nothing else depends on them.
    pub fn write(&self, folder: Option<&Path>) {
        if let (Some(folder), Ok(text)) = (folder, serde_json::to_string_pretty(self)) {
            let _ = files::write(&folder.join(FILE), &text);
        }
    }

    /// The language.
    #[must_use]
    pub fn language(&self) -> Language {
        self.language.unwrap_or_else(Language::of_system)
    }

    /// Keeps the present layout under a name. An earlier one of that name is replaced.
    pub fn keep_layout(&mut self, name: &str) {
        let layout = self.layout;
        match self.layouts.iter_mut().find(|kept| kept.name == name) {
            Some(kept) => kept.layout = layout,
            None => self.layouts.push(KeptLayout { name: name.to_owned(), layout }),
        }
    }

    /// Records that a file was opened or saved.
    pub fn opened(&mut self, path: &Path) {
        self.recent.retain(|other| other != path);
        self.recent.insert(0, path.to_path_buf());
        self.recent.truncate(RECENT);
    }
}

#[cfg(test)]
mod tests {
    use super::layout::View;
    use super::*;
    use orogen::io::test_folder::TestFolder;

    #[test]
    fn settings_are_read_as_they_were_written() {
        let folder = TestFolder::new("studio-settings").unwrap();
        let mut settings =
            Settings { language: Some(Language::Chinese), theme: Theme::Dark, scale: 1.5, ..Settings::default() };
        (0..20).for_each(|n| settings.opened(Path::new(&format!("{n}.toml"))));
        settings.opened(Path::new("12.toml"));
        settings.write(Some(&folder));
        let read = Settings::read(Some(&folder));
        assert_eq!(read, settings);
        assert_eq!((read.recent.len(), read.recent[0].as_path()), (RECENT, Path::new("12.toml")));
    }

    #[test]
    fn broken_settings_are_defaults() {
        let folder = TestFolder::new("studio-broken-settings").unwrap();
        assert_eq!(Settings::read(None), Settings::default());
        for text in ["", "{", "[]", r#"{"scale": "x"}"#] {
            files::write(&folder.join(FILE), text).unwrap();
            assert_eq!(Settings::read(Some(&folder)), Settings::default(), "{text}");
        }
        files::write(&folder.join(FILE), r#"{"scale": 100, "later": 1, "layout": {"view": "both", "height": -3}}"#)
            .unwrap();
        let read = Settings::read(Some(&folder));
        assert_eq!((read.scale, read.layout.view, read.layout.height), (3.0, View::Both, None));
    }
}
