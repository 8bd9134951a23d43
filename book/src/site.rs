//! The books of all languages, made by mdBook.

use std::path::Path;

use anyhow::{Context as _, Result};
use mdbook_driver::MDBook;
use mdbook_driver::config::Config;

use crate::check;
use crate::places::Language;
use crate::stage::{self, Staged};

/// The settings that all books share.
const CONFIG: &str = include_str!("../book.toml");

/// What the site is, for search programs.
const ABOUT: &str = "Orogen, a procedural terrain engine: tutorial, cookbook and reference";

/// Makes the site in a folder, which is emptied before, and checks its links.
pub fn build(root: &Path, out: &Path) -> Result<()> {
    let work = out.with_extension("sources");
    for folder in [out, &work] {
        if folder.exists() {
            std::fs::remove_dir_all(folder).with_context(|| format!("cannot empty {}", folder.display()))?;
        }
    }
    std::fs::create_dir_all(out).with_context(|| format!("cannot create {}", out.display()))?;
    let out = out.canonicalize().with_context(|| format!("cannot find {}", out.display()))?;
    for staged in stage::stage(root, &work)? {
        let (tag, pages) = (staged.language.tag, staged.folder.clone());
        book(root, &out, staged).with_context(|| format!("the book {tag} in {}", pages.display()))?;
    }
    let count = check::site(&out)?;
    std::fs::remove_dir_all(&work).with_context(|| format!("cannot remove {}", work.display()))?;
    println!("    {} pages, {} links", count.pages, count.links);
    println!("{}", out.join("index.html").display());
    Ok(())
}

/// Makes the book of a language.
fn book(root: &Path, out: &Path, staged: Staged) -> Result<()> {
    let language = staged.language;
    let mut config: Config = CONFIG.parse()?;
    config.book.title = Some(language.title.to_owned());
    config.book.description = Some(ABOUT.to_owned());
    config.book.language = Some(language.tag.to_owned());
    config.book.src = staged.folder.canonicalize().with_context(|| format!("{}", staged.folder.display()))?;
    config.build.build_dir = out.join(language.folder);
    if let Some(script) = language.search {
        config.set("output.html.additional-js", vec![script])?;
    }
    let book = MDBook::load_with_config_and_summary(root.join("book"), config, staged.summary)?;
    book.build()?;
    texts(&out.join(language.folder), &language)
}

/// Replaces the texts of mdBook's pages in a folder.
fn texts(folder: &Path, language: &Language) -> Result<()> {
    for entry in std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))? {
        let path = entry?.path();
        // The books of other languages are made after the first one.
        if path.is_dir() {
            texts(&path, language)?;
        } else if path.extension().is_some_and(|extension| extension == "html") {
            let text = language.texts.iter().fold(stage::read(&path)?, |text, (old, new)| text.replace(old, new));
            let text = language.search.and_then(|script| moved(&text, script)).unwrap_or(text);
            stage::write(&path, text.as_bytes())?;
        }
    }
    Ok(())
}

/// A page whose script for the search stands before mdBook's, which may load the index as soon as it runs.
fn moved(page: &str, script: &str) -> Option<String> {
    let name = script.strip_suffix(".js")?;
    let (start, end) = ("<script src=\"", "</script>");
    let element = |part: &str| {
        let at = page.find(part)?;
        let from = page[..at].rfind(start)?;
        Some(from..at + page[at..].find(end)? + end.len())
    };
    let (ours, theirs) = (element(name)?, element("searcher-")?);
    (theirs.end <= ours.start).then_some(())?;
    let [before, between, after] = [&page[..theirs.start], &page[theirs.start..ours.start], &page[ours.end..]];
    Some(format!("{before}{}\n{between}{after}", &page[ours.clone()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_of_the_search_stands_before_its_user() {
        let page = "<script src=\"searcher-1.js\"></script>\n<b><script src=\"../theme/zh-2.js\"></script></b>";
        let expected = "<script src=\"../theme/zh-2.js\"></script>\n<script src=\"searcher-1.js\"></script>\n<b></b>";
        assert_eq!(moved(page, "theme/zh.js").as_deref(), Some(expected));
        assert_eq!(moved(expected, "theme/zh.js"), None);
    }
}
