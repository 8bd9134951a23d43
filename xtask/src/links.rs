//! Checks that relative links in Markdown files lead to files, and their anchors to headings.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use crate::failure::{Failure, Result, on_file};
use crate::{output, shell};

/// Checks every Markdown file that git tracks.
pub fn check() -> Result {
    let listed = shell::capture(shell::program("git").args(["ls-files", "*.md"]))?;
    let files: Vec<PathBuf> = listed.lines().map(PathBuf::from).collect();
    if files.is_empty() {
        return Err(Failure::new("git tracks no Markdown file here"));
    }
    let (dead, links) = dead_links(shell::root(), &files)?;
    match dead.is_empty() {
        true => {
            output::line(format_args!("    {links} relative links in {} files", files.len()));
            Ok(())
        }
        false => Err(Failure::new(format!("links that lead nowhere:\n{}", dead.join("\n")))),
    }
}

/// The dead links of `files`, relative to `root`, one message each, and the number of relative links.
fn dead_links(root: &Path, files: &[PathBuf]) -> Result<(Vec<String>, usize)> {
    let (mut dead, mut count) = (Vec::new(), 0);
    let mut anchors: BTreeMap<PathBuf, BTreeSet<String>> = BTreeMap::new();
    for file in files {
        let text = read(&root.join(file))?;
        for (line, link) in links(&text) {
            if has_scheme(&link) {
                continue;
            }
            count += 1;
            let (path, anchor) = link.split_once('#').map_or((link.as_str(), None), |(path, at)| (path, Some(at)));
            let target = match path {
                "" => file.clone(),
                path => resolved(file.parent().unwrap_or(Path::new("")), path),
            };
            let mut fault = |why: String| dead.push(format!("  {}:{line}: ({link}) {why}", file.display()));
            if !root.join(&target).exists() {
                fault(format!("{} does not exist", target.display()));
                continue;
            }
            let is_markdown = target.extension().is_some_and(|extension| extension == "md");
            if let (Some(anchor), true) = (anchor, is_markdown) {
                if !anchors.contains_key(&target) {
                    anchors.insert(target.clone(), headings(&read(&root.join(&target))?));
                }
                if !anchors[&target].contains(anchor) {
                    fault(format!("{} has no heading for it", target.display()));
                }
            }
        }
    }
    Ok((dead, count))
}

/// Whether a link is absolute: `https:`, `mailto:`, `data:` ...
fn has_scheme(link: &str) -> bool {
    link.split_once(':')
        .is_some_and(|(scheme, _)| !scheme.is_empty() && scheme.chars().all(|c| c.is_ascii_alphabetic()))
}

fn read(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|cause| on_file("read", path, &cause))
}

/// A path relative to a folder, without `.` and `..`.
fn resolved(folder: &Path, path: &str) -> PathBuf {
    let mut whole = folder.to_path_buf();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => drop(whole.pop()),
            Component::CurDir => {}
            other => whole.push(other),
        }
    }
    whole
}

/// The text with code replaced by blanks; line numbers do not change.
fn without_code(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut fence: Option<&str> = None;
    // Lines that inline code can span.
    let mut block = String::new();
    for line in text.split_inclusive('\n') {
        let start = line.trim_start();
        let mark = ["```", "~~~"].into_iter().find(|mark| start.starts_with(mark));
        if fence.is_some() || mark.is_some() || start.is_empty() || start.starts_with(['|', '#', '-', '>']) {
            out.push_str(&without_inline_code(&block));
            block.clear();
        }
        match (fence, mark) {
            (None, Some(mark)) => fence = Some(mark),
            (Some(open), Some(mark)) if open == mark => fence = None,
            (None, None) => {
                block.push_str(line);
                continue;
            }
            _ => {}
        }
        out.push('\n');
    }
    out + &without_inline_code(&block)
}

/// The text with every other part between backticks replaced by blanks. An odd backtick is text.
fn without_inline_code(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    let blank = |c| if c == '\n' { '\n' } else { ' ' };
    let part = |(i, part): (usize, &&str)| match i % 2 == 1 && i + 1 < parts.len() {
        true => part.chars().map(blank).collect(),
        false => (*part).to_owned(),
    };
    parts.iter().enumerate().map(part).collect()
}

/// The targets of all links and pictures, each with its line.
pub fn links(text: &str) -> Vec<(usize, String)> {
    let text = without_code(text);
    let mut found = Vec::new();
    let mut add = |at: usize, target: &str| {
        let target = target.trim().trim_start_matches('<');
        let target = target.split([' ', '\n', '>']).next().unwrap_or_default();
        if !target.is_empty() {
            found.push((text[..at].matches('\n').count() + 1, target.to_owned()));
        }
    };
    for (at, _) in text.match_indices("](") {
        let rest = &text[at + 2..];
        let mut depth = 1;
        let end = rest.find(|c| {
            depth += match c {
                '(' => 1,
                ')' => -1,
                _ => 0,
            };
            depth == 0
        });
        if let Some(end) = end {
            add(at, &rest[..end]);
        }
    }
    for attribute in ["src=\"", "href=\""] {
        for (at, _) in text.match_indices(attribute) {
            let rest = &text[at + attribute.len()..];
            add(at, rest.split('"').next().unwrap_or_default());
        }
    }
    // Definitions of reference links: `[name]: target`.
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        if let Some((_, target)) = line.strip_prefix('[').and_then(|rest| rest.split_once("]: ")) {
            add(at, target);
        }
        at += line.len();
    }
    found
}

/// The anchors of a text's headings, as GitHub makes them, and of `id` and `name` attributes.
fn headings(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut fenced = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        }
        let title = line.trim_start_matches('#');
        let level = line.len() - title.len();
        if !fenced && (1..=6).contains(&level) && title.starts_with(' ') {
            let base = slug(title);
            let again = (1..).map(|n| format!("{base}-{n}"));
            let free = std::iter::once(base.clone()).chain(again).find(|slug| !found.contains(slug));
            found.extend(free);
        }
        for attribute in ["id=\"", "name=\""] {
            for (at, _) in line.match_indices(attribute) {
                found.extend(line[at + attribute.len()..].split('"').next().map(str::to_owned));
            }
        }
    }
    found
}

/// The anchor of a heading: lower case, blanks as hyphens, no punctuation, links by their text.
fn slug(title: &str) -> String {
    let mut text = String::new();
    let mut rest = title.trim();
    while let Some((before, after)) = rest.split_once("](") {
        text.push_str(before);
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    text.push_str(rest);
    let kept = text.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dead_links_are_found_and_others_are_not() {
        let root = std::env::temp_dir().join(format!("orogen-links-{}", std::process::id()));
        std::fs::create_dir_all(root.join("docs")).expect("a folder");
        std::fs::write(root.join("docs/b.md"), "# One title\n## Two: `code`, (more)\n## One title\n```\n# no\n```\n")
            .expect("a file");
        let text = "[a](docs/b.md) [b](docs/b.md#one-title) [c](docs/b.md#two-code-more) [d](#here)\n# Here\n\
                    `[code](nowhere.md)` [e](docs/b.md#one-title-1 \"title\")\n```\n[f](nowhere.md)\n```\n<img src=\"docs/b.md\">\n\
                    [g](https://example.org/x#y) ![h](data:image/png;base64,AA==)\n";
        std::fs::write(root.join("a.md"), text).expect("a file");
        let check = |name: &str| dead_links(&root, &[PathBuf::from(name)]).expect("files are read");
        assert_eq!(check("a.md"), (vec![], 6));
        let broken = "ok\n[a](b.md)\n![b](docs/c.png) [c](docs/b.md#no)\n[d]: gone.md\n<a href=\"#gone\">x</a>\n";
        std::fs::write(root.join("a.md"), broken).expect("a file");
        let (dead, _) = check("a.md");
        let expected = [
            "a.md:2: (b.md)",
            "a.md:3: (docs/c.png)",
            "a.md:3: (docs/b.md#no)",
            "a.md:4: (gone.md)",
            "a.md:5: (#gone)",
        ];
        assert_eq!(dead.len(), expected.len(), "{dead:?}");
        for expected in expected {
            assert!(dead.iter().any(|dead| dead.contains(expected)), "{expected}: {dead:?}");
        }
        // Inline code over two lines, and an odd backtick.
        let text = "`a\n[b](b.md)` [c](c.md)\nd` [e](e.md)\n- f` [g](g.md)\n\n`[h](h.md)`\n";
        let expected = [(2, "c.md"), (3, "e.md"), (4, "g.md")].map(|(line, target)| (line, target.to_owned()));
        assert_eq!(links(text), expected);
        // Out of a folder, and back.
        std::fs::write(root.join("docs/d.md"), "[a](../a.md) [b](../docs/b.md#one-title) [c](./e.md)\n")
            .expect("a file");
        let (dead, _) = check("docs/d.md");
        assert!(dead.len() == 1 && dead[0].contains("docs/e.md does not exist"), "{dead:?}");
        std::fs::remove_dir_all(&root).expect("removed");
    }
}
