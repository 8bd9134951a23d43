//! Which page of the repository stands where in the site.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result, bail};
use mdbook_summary::{Summary, SummaryItem};

/// A language of the documentation.
#[derive(Clone, Copy, PartialEq)]
pub struct Language {
    /// The tag of the language.
    pub tag: &'static str,
    /// The name of the language in itself.
    pub name: &'static str,
    /// The title of its book.
    pub title: &'static str,
    /// The summary of its book, from the root of the repository.
    pub summary: &'static str,
    /// The folder of its book in the site, with a slash at the end, or nothing.
    pub folder: &'static str,
    /// The end of its pages' names.
    pub suffix: &'static str,
    /// The text of links that open a recipe in the studio, and of links to the recipe's file.
    pub open: [&'static str; 2],
    /// A script for its search, from the folder of this program.
    pub search: Option<&'static str>,
    /// Texts of mdBook's pages, and what they are in this language.
    pub texts: &'static [(&'static str, &'static str)],
}

impl Language {
    /// Whether there are no blanks between words and sentences.
    pub fn is_unspaced(&self) -> bool {
        self.tag.starts_with("zh")
    }
}

/// The languages; every page is in the first one.
pub const LANGUAGES: [Language; 2] = [
    Language {
        tag: "en",
        name: "English",
        title: "Orogen",
        summary: "docs/SUMMARY.md",
        folder: "",
        suffix: ".md",
        open: ["Open in the studio", "Download"],
        search: None,
        // The two themes that are shown.
        texts: &[(">Navy<", ">Dark<")],
    },
    Language {
        tag: "zh-CN",
        name: "简体中文",
        title: "Orogen 中文文档",
        summary: "docs/SUMMARY.zh-CN.md",
        folder: "zh-CN/",
        suffix: ".zh-CN.md",
        open: ["在工作室中打开", "下载"],
        search: Some("theme/search-zh.js"),
        texts: &[
            (">Auto<", ">自动<"),
            (">Light<", ">浅色<"),
            (">Navy<", ">深色<"),
            ("\"Toggle Table of Contents\"", "\"目录\""),
            ("\"Table of contents\"", "\"目录\""),
            ("\"Themes\"", "\"主题\""),
            ("\"Change theme\"", "\"主题\""),
            ("\"Search (`/`)\"", "\"搜索（`/`）\""),
            ("\"Toggle Searchbar\"", "\"搜索\""),
            ("\"Search this book ...\"", "\"搜索……\""),
            ("\"Print this book\"", "\"打印全书\""),
            ("\"Previous chapter\"", "\"上一章\""),
            ("\"Next chapter\"", "\"下一章\""),
            (">Keyboard shortcuts<", ">键盘快捷键<"),
            (" to navigate between chapters<", " 切换章节<"),
            (" to search in the book<", " 搜索<"),
            (" to show this help<", " 显示此帮助<"),
            (" to hide this help<", " 关闭此帮助<"),
        ],
    },
];

/// The pages of all books: their files in the repository and their addresses in the site.
pub struct Places(BTreeMap<String, String>);

impl Places {
    /// The places of the pages of some summaries.
    pub fn new(summaries: &[(Language, Summary)]) -> Result<Places> {
        let mut places = BTreeMap::new();
        for (language, summary) in summaries {
            let mut add = |location: &str| {
                let file = resolved("docs", location)?;
                let address = address(language, &file);
                match places.insert(file.clone(), address) {
                    Some(_) => bail!("{file} is twice in the summaries"),
                    None => Ok(()),
                }
            };
            each(&items(summary), &mut add)?;
        }
        Ok(Places(places))
    }

    /// The address of a file of the repository, if it is a page.
    pub fn address(&self, file: &str) -> Option<&str> {
        self.0.get(file).map(String::as_str)
    }

    /// All files and their addresses.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(file, address)| (file.as_str(), address.as_str()))
    }

    /// The same page in another language; `None` if it is not translated.
    pub fn counterpart(&self, file: &str, from: &Language, to: &Language) -> Option<&str> {
        self.address(&format!("{}{}", file.strip_suffix(from.suffix)?, to.suffix))
    }
}

/// The address of a page. A folder's `README.md` is its index.
pub fn address(language: &Language, file: &str) -> String {
    let file = file.strip_prefix("docs/").unwrap_or(file);
    let stem = file.strip_suffix(language.suffix).or_else(|| file.strip_suffix(".md")).unwrap_or(file);
    let stem = match stem.strip_suffix("README") {
        Some(folder) => format!("{folder}index"),
        None => stem.to_owned(),
    };
    // Files at the root of the repository are written in capitals.
    let stem = if stem.contains('/') { stem } else { stem.to_lowercase() };
    format!("{}{stem}.html", language.folder)
}

/// The items of a summary.
fn items(summary: &Summary) -> Vec<&SummaryItem> {
    summary.prefix_chapters.iter().chain(&summary.numbered_chapters).chain(&summary.suffix_chapters).collect()
}

fn each(items: &[&SummaryItem], add: &mut impl FnMut(&str) -> Result<()>) -> Result<()> {
    for item in items {
        let SummaryItem::Link(link) = item else { continue };
        let location = link.location.as_deref().with_context(|| format!("'{}' has no page", link.name))?;
        add(&location.to_string_lossy())?;
        each(&link.nested_items.iter().collect::<Vec<_>>(), add)?;
    }
    Ok(())
}

/// A relative path in a folder, without `.` and `..`.
pub fn resolved(folder: &str, path: &str) -> Result<String> {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.pop().is_none() => bail!("{path} leads out of the repository"),
            ".." => {}
            part => parts.push(part),
        }
    }
    Ok(parts.join("/"))
}

/// The folder of a file; empty at the root.
pub fn folder(file: &str) -> &str {
    file.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The relative link from one address to another.
pub fn relative(from: &str, to: &str) -> String {
    let (here, there): (Vec<&str>, Vec<&str>) = (from.split('/').collect(), to.split('/').collect());
    let shared = here.iter().zip(&there).take_while(|(a, b)| a == b).count().min(here.len() - 1).min(there.len() - 1);
    "../".repeat(here.len() - 1 - shared) + &there[shared..].join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_and_links() {
        let [english, chinese] = LANGUAGES;
        assert_eq!(address(&english, "README.md"), "index.html");
        assert_eq!(address(&english, "ARCHITECTURE.md"), "architecture.html");
        assert_eq!(address(&english, "docs/decisions/README.md"), "decisions/index.html");
        assert_eq!(address(&chinese, "README.zh-CN.md"), "zh-CN/index.html");
        assert_eq!(address(&chinese, "docs/tutorial/noise.zh-CN.md"), "zh-CN/tutorial/noise.html");
        assert_eq!(relative("a/b.html", "a/c.html"), "c.html");
        assert_eq!(relative("a/b.html", "c.html"), "../c.html");
        assert_eq!(relative("b.html", "a/a/c.html"), "a/a/c.html");
        assert_eq!(relative("zh-CN/a/b.html", "a/c.png"), "../../a/c.png");
        assert_eq!(resolved("docs/tutorial", "../images/a.png").ok().as_deref(), Some("docs/images/a.png"));
        assert!(resolved("docs", "../../a").is_err());
    }
}
