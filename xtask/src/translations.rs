//! Checks that translated Markdown files have the structure of their originals.

use std::fmt;

use crate::failure::{Failure, Result};
use crate::{links, output, shell};

/// The end of the name of a translation.
const SUFFIX: &str = ".zh-CN.md";

/// The pages of the documentation's site, which link to the pages of their language, so they have no common structure.
const SUMMARY: &str = "docs/SUMMARY.zh-CN.md";

/// The number of lines at the start of a file that must contain the link to the other file.
const NEAR: usize = 5;

/// Checks every translation that git tracks.
pub fn check() -> Result {
    let listed = shell::capture(shell::program("git").args(["ls-files", &format!("*{SUFFIX}")]))?;
    let mut found = Vec::new();
    for path in listed.lines().filter(|path| *path != SUMMARY) {
        let Some(stem) = path.strip_suffix(SUFFIX) else { continue };
        let read = |path: &str| {
            let name = path.rsplit('/').next().unwrap_or(path).to_owned();
            Ok(Page { name, text: shell::read(&shell::root().join(path))? })
        };
        let (original, translation) = (read(&format!("{stem}.md"))?, read(path)?);
        let parts = parts(&original.text, [&original.name, &translation.name]);
        let count = |kind| parts.iter().filter(|part| part.kind == kind).count();
        let (headings, code, links) = (count(Kind::Heading), count(Kind::Code), count(Kind::Link));
        output::line(format_args!("    {path}: {headings} headings, {code} lines of code, {links} links"));
        found.extend(faults(&original, &translation).into_iter().map(|fault| format!("{fault} ({path})")));
    }
    match found.is_empty() {
        true => Ok(()),
        false => Err(Failure::new(format!("translations that differ from their originals:\n{}", found.join("\n")))),
    }
}

/// A Markdown file.
struct Page {
    name: String,
    text: String,
}

/// A kind of part that a translation keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Heading,
    /// A row of a table.
    Row,
    /// The start of a code block.
    Block,
    /// A line of a code block.
    Code,
    /// A link or a picture.
    Link,
}

/// A part of a file that its translation must also have.
struct Part {
    /// The line number, from 1.
    line: usize,
    kind: Kind,
    /// The text that must be equal: the marks of a heading, the columns of a row and the inline code in its first cell,
    /// the language of a block, code without its comment, the target of a link.
    key: String,
    /// The text for messages.
    shown: String,
}

impl Part {
    fn equals(&self, other: &Part) -> bool {
        self.kind == other.kind && self.key == other.key
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            Kind::Heading => "heading",
            Kind::Row => "table row",
            Kind::Block => "code block",
            Kind::Code => "code",
            Kind::Link => "link",
        };
        write!(f, "{kind} `{}`", self.shown)
    }
}

/// The differences of a translation from its original, and missing links from one to the other; one message each.
fn faults(original: &Page, translation: &Page) -> Vec<String> {
    let mut faults = Vec::new();
    for (page, other) in [(original, translation), (translation, original)] {
        let is_link = |(line, target): &(usize, String)| *line <= NEAR && *target == other.name;
        if !links::links(&page.text).iter().any(is_link) {
            faults.push(format!("  {}:1: no link to {} in the first {NEAR} lines", page.name, other.name));
        }
    }
    let names = [&*original.name, &*translation.name];
    let (left, right) = (parts(&original.text, names), parts(&translation.text, names));
    let last_line = translation.text.lines().count();
    // Each run of parts between two parts that both files have.
    let (mut i, mut j) = (0, 0);
    let common = common(&left, &right);
    for (to_i, to_j) in common.into_iter().chain([(left.len(), right.len())]) {
        let (missing, added) = (&left[i..to_i], &right[j..to_j]);
        let (line, place) = match right.get(to_j) {
            Some(next) => (next.line, format!("before {next}")),
            None => (last_line, "at the end".to_owned()),
        };
        for k in 0..missing.len().max(added.len()) {
            let at = |line| format!("  {}:{line}", translation.name);
            let absent =
                |part: &Part| format!("{}: {place}, {part} of {}:{} is missing", at(line), original.name, part.line);
            let extra = |part: &Part| format!("{}: {part} is not in {}", at(part.line), original.name);
            match (missing.get(k), added.get(k)) {
                (Some(old), Some(new)) if old.kind == new.kind => {
                    faults.push(format!("{}: {new}, but {}:{} has {old}", at(new.line), original.name, old.line));
                }
                (old, new) => faults.extend(old.map(absent).into_iter().chain(new.map(extra))),
            }
        }
        (i, j) = (to_i + 1, to_j + 1);
    }
    faults
}

/// The longest common subsequence: pairs of indices.
fn common(left: &[Part], right: &[Part]) -> Vec<(usize, usize)> {
    let mut longest = vec![vec![0; right.len() + 1]; left.len() + 1];
    for i in (0..left.len()).rev() {
        for j in (0..right.len()).rev() {
            longest[i][j] = match left[i].equals(&right[j]) {
                true => longest[i + 1][j + 1] + 1,
                false => longest[i + 1][j].max(longest[i][j + 1]),
            };
        }
    }
    let (mut i, mut j, mut pairs) = (0, 0, Vec::new());
    while i < left.len() && j < right.len() {
        if left[i].equals(&right[j]) {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if longest[i + 1][j] >= longest[i][j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}

/// Headings, table rows, code and links of a text in their order, without the links from one file of the pair to the
/// other.
fn parts(text: &str, pair: [&str; 2]) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut fence: Option<&str> = None;
    let (mut indented, mut blanks, mut after_blank) = (false, 0, true);
    for (i, line) in text.lines().enumerate() {
        let mut add = |kind, key: &str, shown: &str| {
            parts.push(Part { line: i + 1, kind, key: key.to_owned(), shown: shown.trim().to_owned() });
        };
        let start = line.trim();
        let is_blank = start.is_empty();
        let is_indented = !is_blank && (line.starts_with("    ") || line.starts_with('\t'));
        if let Some(mark) = fence {
            match start.starts_with(mark) && start.trim_start_matches(&mark[..1]).is_empty() {
                true => fence = None,
                false => add(Kind::Code, without_comment(line), line),
            }
        } else if is_indented && (indented || after_blank) {
            match indented {
                true => (0..blanks).for_each(|_| add(Kind::Code, "", "")),
                false => add(Kind::Block, "indented", "indented"),
            }
            add(Kind::Code, without_comment(line), line);
            (indented, blanks) = (true, 0);
        } else if is_blank {
            blanks += 1;
        } else {
            (indented, blanks) = (false, 0);
            let level = line.len() - line.trim_start_matches('#').len();
            if (1..=6).contains(&level) && line[level..].starts_with(' ') {
                add(Kind::Heading, &line[..level], line);
            } else if start.starts_with('|') {
                let name = start.split('|').nth(1).and_then(|cell| cell.split('`').nth(1)).unwrap_or_default();
                add(Kind::Row, &format!("{} {name}", start.matches('|').count()), line);
            } else if let Some((mark, info)) = fence_start(start) {
                fence = Some(mark);
                let block = format!("fenced {info}");
                add(Kind::Block, &block, &block);
            }
        }
        after_blank = is_blank;
    }
    for (line, target) in links::links(text).into_iter().filter(|(_, target)| !pair.contains(&target.as_str())) {
        // Anchors of the file itself are made of its headings.
        // A translation links to translations.
        let key = if target.starts_with('#') { "#".to_owned() } else { target.replace(SUFFIX, ".md") };
        parts.push(Part { line, kind: Kind::Link, key, shown: target });
    }
    parts.sort_by_key(|part| part.line);
    parts
}

/// The mark and the language of a line that starts a fenced block.
fn fence_start(line: &str) -> Option<(&str, &str)> {
    let mark = ["`", "~"].into_iter().find(|mark| line.starts_with(&mark.repeat(3)))?;
    let info = line.trim_start_matches(mark);
    // "```code```" in one line is inline code.
    (!info.contains('`')).then(|| (&line[..line.len() - info.len()], info.trim()))
}

/// A line of code without its comment: `#` outside quotes, with a blank or nothing on each side. `#[test]` and
/// `#:schema` are code.
fn without_comment(line: &str) -> &str {
    let (mut quote, mut before) = (None, ' ');
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), c) if c == open => quote = None,
            (None, '#') if before.is_whitespace() && line[at + 1..].chars().next().is_none_or(char::is_whitespace) => {
                return line[..at].trim_end();
            }
            _ => {}
        }
        before = c;
    }
    line.trim_end()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENGLISH: &str = "# Name\n\n[其他](b.md)\n\n![A hill](hill.png)\n\n    run a    # makes a\n\n    run b '# c'\n\n\
                           ## First\n\n| a | b |\n|---|---|\n| `v` | [x](x.md) |\n| `w` | 2 |\n\n```toml\n# A seed\nseed = 1   # any\n\
                           color = \"#fff # no\"\n```\n\n## Second\n\nSee [y](y.md) and [z](z.md#at), [above](#first).\n";
    const CHINESE: &str = "# 名称\n\n[English](a.md)\n\n![山](hill.png)\n\n    run a    # 生成 a\n\n    run b '# c'\n\n\
                           ## 一\n\n| 甲 | 乙 |\n|---|---|\n| `v` | [x](x.md) |\n| `w` | 2 |\n\n```toml\n# 种子\nseed = 1   # 任意\n\
                           color = \"#fff # no\"\n```\n\n## 二\n\n参见 [y](y.md) 和 [z](z.md#at)，[见上](#一)。\n";

    /// The faults of the translation after a replacement in it.
    fn changed(from: &str, to: &str) -> Vec<String> {
        assert!(CHINESE.contains(from), "{from}");
        found(ENGLISH, &CHINESE.replace(from, to))
    }

    fn found(original: &str, translation: &str) -> Vec<String> {
        let page = |name: &str, text: &str| Page { name: name.to_owned(), text: text.to_owned() };
        faults(&page("a.md", original), &page("b.md", translation))
    }

    #[test]
    fn translated_titles_comments_and_texts_are_no_faults() {
        assert_eq!(found(ENGLISH, CHINESE), [""; 0]);
        assert_eq!(changed("    # 生成 a", ""), [""; 0]);
    }

    #[test]
    fn headings_are_compared() {
        assert_eq!(
            changed("## 二\n", ""),
            ["  b.md:25: before link `y.md`, heading `## Second` of a.md:24 is missing"]
        );
        assert_eq!(changed("## 二", "### 二"), ["  b.md:24: heading `### 二`, but a.md:24 has heading `## Second`"]);
        assert_eq!(changed("## 二", "## 二\n\n## 三"), ["  b.md:26: heading `## 三` is not in a.md"]);
        assert_eq!(
            changed("参见 [y](y.md) 和 [z](z.md#at)，[见上](#一)。", ""),
            [
                "  b.md:26: at the end, link `y.md` of a.md:26 is missing",
                "  b.md:26: at the end, link `z.md#at` of a.md:26 is missing",
                "  b.md:26: at the end, link `#first` of a.md:26 is missing",
            ]
        );
        // The part is in another place.
        assert_eq!(changed("\n## 一\n", "").len(), 1);
        assert_eq!(found(ENGLISH, &CHINESE.replace("## 一\n", "").replace("seed", "## 一\n\nseed")).len(), 3);
    }

    #[test]
    fn code_is_compared_without_comments() {
        assert_eq!(
            changed("run a ", "run c "),
            ["  b.md:7: code `run c    # 生成 a`, but a.md:7 has code `run a    # makes a`"]
        );
        assert_eq!(changed("'# c'", "'# d'").len(), 1);
        assert_eq!(changed("#fff # no", "#fff # 否").len(), 1);
        assert_eq!(
            changed("seed = 1", "seed = 2"),
            ["  b.md:20: code `seed = 2   # 任意`, but a.md:20 has code `seed = 1   # any`"]
        );
        assert_eq!(
            changed("seed = 1   # 任意\n", ""),
            ["  b.md:20: before code `color = \"#fff # no\"`, code `seed = 1   # any` of a.md:20 is missing"]
        );
        assert_eq!(
            changed("toml", "json"),
            ["  b.md:18: code block `fenced json`, but a.md:18 has code block `fenced toml`"]
        );
        assert_eq!(changed("\n    run b '# c'\n", "\nText\n\n    run b '# c'\n").len(), 2);
    }

    #[test]
    fn links_pictures_and_rows_are_compared() {
        assert_eq!(changed("[y](y.md)", "y"), ["  b.md:26: before link `z.md#at`, link `y.md` of a.md:26 is missing"]);
        assert_eq!(
            changed("hill.png", "hill-zh.png"),
            ["  b.md:5: link `hill-zh.png`, but a.md:5 has link `hill.png`"]
        );
        assert_eq!(changed("[y](y.md) 和 [z](z.md#at)", "[z](z.md#at) 和 [y](y.md)").len(), 2);
        assert_eq!(changed("z.md#at", "z.md").len(), 1);
        assert_eq!(
            changed("| `w` | 2 |", "| `w` |"),
            ["  b.md:16: table row `| `w` |`, but a.md:16 has table row `| `w` | 2 |`"]
        );
        assert_eq!(
            changed("| `w` | 2 |\n", ""),
            ["  b.md:17: before code block `fenced toml`, table row `| `w` | 2 |` of a.md:16 is missing"]
        );
    }

    #[test]
    fn each_file_links_the_other_near_its_start() {
        let missing = |of: &str, to: &str| vec![format!("  {of}:1: no link to {to} in the first 5 lines")];
        assert_eq!(changed("[English](a.md)", ""), missing("b.md", "a.md"));
        assert_eq!(found(&ENGLISH.replace("[其他](b.md)", ""), CHINESE), missing("a.md", "b.md"));
        let at_the_end = format!("{}\n[English](a.md)\n", CHINESE.replace("[English](a.md)\n", ""));
        assert_eq!(found(ENGLISH, &at_the_end), missing("b.md", "a.md"));
    }

    #[test]
    fn comments_end_code() {
        assert_eq!(without_comment("a   # b # c"), "a");
        assert_eq!(without_comment("# b"), "");
        assert_eq!(without_comment("a #"), "a");
        for code in ["#[test]", "a#b", "a #b", "a '# b'", "a = \"it's # b\"", "a\t#:schema b"] {
            assert_eq!(without_comment(code), code);
        }
    }
}
