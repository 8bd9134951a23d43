//! The sources of the books, as mdBook reads them: a folder for each language.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, bail, ensure};
use mdbook_summary::{Summary, SummaryItem, parse_summary};

use crate::page::{Site, asset};
use crate::places::{LANGUAGES, Language, Places, address, resolved};

/// The staged sources of a book.
pub struct Staged {
    pub language: Language,
    /// The summary, with the paths of staged pages.
    pub summary: Summary,
    /// The folder of the pages.
    pub folder: PathBuf,
}

/// Stages the pages of all languages and the files they link to below `work`.
pub fn stage(root: &Path, work: &Path) -> Result<Vec<Staged>> {
    let mut summaries = Vec::new();
    for language in LANGUAGES {
        let text = read(&root.join(language.summary))?;
        summaries.push((language, parse_summary(&text).with_context(|| language.summary.to_owned())?));
    }
    let places = Places::new(&summaries)?;
    missing(root, &places)?;
    let mut site = Site::new(root, &places)?;
    let mut pages: BTreeMap<String, String> = BTreeMap::new();
    for (file, address) in places.iter() {
        let language = LANGUAGES.iter().rev().find(|language| file.ends_with(language.suffix));
        let language = language.with_context(|| format!("{file} is no page"))?;
        let text = site.page(language, file, &read(&root.join(file))?)?;
        pages.insert(address.to_owned(), text);
    }
    let folder = |language: &Language| work.join(language.tag);
    for (address, text) in &pages {
        // The folder of the second language is part of its addresses.
        let language = LANGUAGES.iter().rev().find(|language| address.starts_with(language.folder));
        let language = language.with_context(|| format!("{address} has no language"))?;
        let page = address.strip_prefix(language.folder).unwrap_or(address).replace(".html", ".md");
        write(&folder(language).join(page), text.as_bytes())?;
    }
    let first = folder(&LANGUAGES[0]);
    for file in &site.assets {
        let bytes = std::fs::read(root.join(file)).with_context(|| format!("cannot read {file}"))?;
        write(&first.join(asset(file)), &bytes)?;
    }
    let staged = |(language, mut summary): (Language, Summary)| {
        let parts = [&mut summary.prefix_chapters, &mut summary.numbered_chapters, &mut summary.suffix_chapters];
        parts.into_iter().try_for_each(|items| relocate(&language, items))?;
        Ok(Staged { folder: folder(&language), language, summary })
    };
    summaries.into_iter().map(staged).collect()
}

/// Refuses pages that are in no summary.
fn missing(root: &Path, places: &Places) -> Result<()> {
    let listed = Command::new("git").current_dir(root).args(["ls-files", "docs/*.md"]).output().context("git")?;
    ensure!(listed.status.success(), "git cannot list the pages of {}", root.display());
    let listed = String::from_utf8(listed.stdout).context("git ls-files")?;
    let is_summary = |file: &&str| LANGUAGES.iter().any(|language| language.summary == *file);
    let left: Vec<&str> = listed.lines().filter(|file| !is_summary(file) && places.address(file).is_none()).collect();
    match left.is_empty() {
        true => Ok(()),
        false => bail!("pages in no summary: add them to docs/SUMMARY.md: {}", left.join(", ")),
    }
}

/// Replaces the paths of pages by those of staged pages.
fn relocate(language: &Language, items: &mut [SummaryItem]) -> Result<()> {
    for item in items {
        let SummaryItem::Link(link) = item else { continue };
        if let Some(location) = &mut link.location {
            let address = address(language, &resolved("docs", &location.to_string_lossy())?);
            *location = address.strip_prefix(language.folder).unwrap_or(&address).replace(".html", ".md").into();
        }
        relocate(language, &mut link.nested_items)?;
    }
    Ok(())
}

/// Reads a text file.
pub fn read(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Writes a file and the folders above it.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}
