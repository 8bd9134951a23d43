//! The books of all languages, made by mdBook.

use std::path::Path;

use anyhow::{Context as _, Result};
use mdbook_driver::MDBook;
use mdbook_driver::config::Config;

use crate::check;
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
    let book = MDBook::load_with_config_and_summary(root.join("book"), config, staged.summary)?;
    book.build()
}
