//! The texts of the interface, in one catalog file per language: `locales/`.

mod declared;
mod messages;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use crate::platform;

/// A language of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Language {
    /// English.
    #[default]
    #[serde(rename = "en")]
    English,
    /// Simplified Chinese.
    #[serde(rename = "zh-CN")]
    Chinese,
}

/// Texts by key.
type Texts = BTreeMap<String, String>;

static ENGLISH: LazyLock<Texts> = LazyLock::new(|| read(include_str!("../locales/en.toml")));
static CHINESE: LazyLock<Texts> = LazyLock::new(|| read(include_str!("../locales/zh-CN.toml")));

/// Reads a catalog: tables of texts, whose keys are joined by dots.
fn read(file: &str) -> Texts {
    let mut texts = Texts::new();
    // A test parses every catalog.
    let table: toml::Table = file.parse().unwrap_or_default();
    let mut waiting: Vec<(String, toml::Value)> = table.into_iter().collect();
    while let Some((key, value)) = waiting.pop() {
        match value {
            toml::Value::Table(table) => {
                waiting.extend(table.into_iter().map(|(inner, value)| (format!("{key}.{inner}"), value)));
            }
            toml::Value::String(text) => drop(texts.insert(key, text)),
            _ => {}
        }
    }
    texts
}

impl Language {
    /// All languages.
    pub const ALL: [Language; 2] = [Language::English, Language::Chinese];

    /// The name of the language in that language.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Language::English => "English",
            Language::Chinese => "简体中文",
        }
    }

    /// The code of the language.
    #[must_use]
    pub fn code(self) -> &'static str {
        match self {
            Language::English => "en",
            Language::Chinese => "zh-CN",
        }
    }

    /// The language with this code; `None` if the interface lacks it.
    #[must_use]
    pub fn of_code(code: &str) -> Option<Language> {
        Language::ALL.into_iter().find(|language| language.code() == code)
    }

    /// The language of the system, as it states it.
    #[must_use]
    pub fn of_system() -> Language {
        match platform::locale() {
            Some(locale) if locale.starts_with("zh") => Language::Chinese,
            _ => Language::English,
        }
    }

    fn texts(self) -> &'static Texts {
        match self {
            Language::English => &ENGLISH,
            Language::Chinese => &CHINESE,
        }
    }

    /// The text for a key; in English if this language lacks it, and the key itself if English also lacks it.
    #[must_use]
    pub fn text(self, key: &'static str) -> &'static str {
        self.find(key).unwrap_or(key)
    }

    /// The text for a key; `None` if this catalog lacks it.
    #[must_use]
    pub fn find(self, key: &str) -> Option<&'static str> {
        self.texts().get(key).or_else(|| ENGLISH.get(key)).map(String::as_str)
    }

    /// The text for a key with values in place of `{name}`.
    #[must_use]
    pub fn fill(self, key: &'static str, values: &[(&str, &str)]) -> String {
        let mut text = self.text(key).to_string();
        for (name, value) in values {
            text = text.replace(&format!("{{{name}}}"), value);
        }
        text
    }

    /// The keys of the catalog.
    pub fn keys(self) -> impl Iterator<Item = &'static str> {
        self.texts().keys().map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::given::WITHOUT_FIELD;
    use orogen::jobs::{MapJob, RenderJob};
    use orogen::options::ValueKind;
    use orogen::tilemap::TilemapJob;
    use orogen::tilemap::art::set::SETS;
    use std::collections::BTreeSet;

    /// The names in braces in a text.
    fn placeholders(text: &str) -> BTreeSet<&str> {
        text.split('{').skip(1).filter_map(|part| part.split_once('}')).map(|(name, _)| name).collect()
    }

    /// The keys of the options of jobs, and of their choices.
    fn declared() -> BTreeSet<String> {
        let mut keys = BTreeSet::from(["choice.palette-auto".to_owned(), "choice.paper-auto".to_owned()]);
        let specs = [MapJob::OPTIONS, RenderJob::OPTIONS, TilemapJob::OPTIONS].into_iter().flatten();
        for spec in specs.filter(|spec| !WITHOUT_FIELD.contains(&spec.name)) {
            keys.insert(format!("option.{}", spec.name));
            let names: Vec<&str> = match spec.kind {
                ValueKind::Choice(choices) => choices.iter().map(|choice| choice.name).collect(),
                ValueKind::Tileset => SETS.iter().map(|set| set.name).collect(),
                ValueKind::Tuple(components, _) => components.iter().map(|component| component.name).collect(),
                _ => continue,
            };
            keys.extend(names.into_iter().map(|name| format!("choice.{}-{name}", spec.name)));
        }
        keys
    }

    #[test]
    fn both_languages_have_all_keys_and_the_same_placeholders() {
        for file in [include_str!("../locales/en.toml"), include_str!("../locales/zh-CN.toml")] {
            file.parse::<toml::Table>().unwrap();
        }
        let [english, chinese] = Language::ALL.map(|language| language.keys().collect::<BTreeSet<_>>());
        assert_eq!(english.difference(&chinese).collect::<Vec<_>>(), Vec::<&&str>::new(), "missing in zh-CN.toml");
        assert_eq!(chinese.difference(&english).collect::<Vec<_>>(), Vec::<&&str>::new(), "missing in en.toml");
        for key in english {
            let texts = Language::ALL.map(|language| language.text(key));
            assert!(texts.iter().all(|text| !text.trim().is_empty()), "{key}");
            assert_eq!(placeholders(texts[0]), placeholders(texts[1]), "{key}");
        }
    }

    /// Checks every `"a.b"` in the sources whose first part is a table of the catalog.
    #[test]
    fn every_key_in_the_sources_is_there_and_every_key_is_used() {
        let tables: BTreeSet<&str> =
            Language::English.keys().filter_map(|key| key.split_once('.')).map(|(table, _)| table).collect();
        let keys: BTreeSet<&str> = Language::English.keys().collect();
        let mut used = declared();
        assert!(used.iter().all(|key| keys.contains(key.as_str())), "{used:?}");
        let mut folders = vec![std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src")];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                    continue;
                }
                let text = std::fs::read_to_string(&path).unwrap();
                for literal in text.split('"').skip(1) {
                    let is_key = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '.' | '_');
                    let Some((table, _)) = literal.split_once('.') else { continue };
                    // File names are not keys.
                    if [".rs", ".wgsl", ".toml", ".json", ".png"].iter().any(|end| literal.ends_with(end)) {
                        continue;
                    }
                    if literal.chars().all(is_key) && tables.contains(table) && !literal.ends_with('.') {
                        assert!(keys.contains(literal), "{}: there is no text `{literal}`", path.display());
                        used.insert(literal.to_string());
                    }
                }
            }
        }
        let unused: Vec<&&str> = keys.iter().filter(|key| !used.contains(**key)).collect();
        assert!(unused.is_empty(), "no code uses {unused:?}");
    }

    #[test]
    fn values_are_filled_in() {
        assert_eq!(Language::English.text("no such key"), "no such key");
        for language in Language::ALL {
            assert!(language.fill("status.made", &[("samples", "256"), ("seconds", "0.1")]).contains("256"));
        }
    }
}
