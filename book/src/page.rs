//! What changes on a page between the repository and the site: links, recipes that open in the studio, formulas.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use anyhow::{Context as _, Result, bail};
use math_core::{LatexToMathML, MathCoreConfig, MathDisplay};
use pulldown_cmark::{CodeBlockKind, Event, HeadingLevel, Options, Parser, Tag, TagEnd};

use crate::places::{LANGUAGES, Language, Places, folder, relative, resolved};

/// Where the studio stands, from the root of this site.
const STUDIO: &str = "../studio/";

/// The path from the studio's page to the root of this site.
const FROM_STUDIO: &str = "../book/";

/// The folder of the site with files of the repository that are outside of `docs/`.
const OUTSIDE: &str = "files/";

/// The page whose maps of presets open them in the studio.
const GALLERY: &str = "docs/gallery.md";

/// What a recipe has that reads a file, which the studio does not find in a browser.
const READS_A_FILE: &str = "\npath = ";

/// The reference of ops, where the picture of an op stands below its name.
const REFERENCE: &str = "docs/ops.md";

/// The folder of the pictures of ops.
const OPS: &str = "docs/ops/pictures/";

/// What all pages share.
pub struct Site<'a> {
    /// The root of the repository.
    pub root: &'a Path,
    pub places: &'a Places,
    /// The files that pages link to: paths in the repository.
    pub assets: BTreeSet<String>,
    formulas: LatexToMathML,
}

impl<'a> Site<'a> {
    pub fn new(root: &'a Path, places: &'a Places) -> Result<Site<'a>> {
        let formulas = LatexToMathML::new(MathCoreConfig::default()).map_err(|error| anyhow::anyhow!("{error:?}"))?;
        Ok(Site { root, places, assets: BTreeSet::new(), formulas })
    }

    /// The text of a page for the site. `file` is its path in the repository.
    pub fn page(&mut self, language: &Language, file: &str, text: &str) -> Result<String> {
        let address = self.places.address(file).with_context(|| format!("{file} is in no summary"))?.to_owned();
        let page = Page { language, file, address: &address };
        let mut edits = self.edits(&page, text)?;
        edits.sort_by_key(|(range, _)| range.start);
        let mut out = self.language_links(&page);
        let mut at = 0;
        for (range, new) in edits {
            out += text.get(at..range.start).with_context(|| format!("{file}: two changes of the same text"))?;
            out += &new;
            at = range.end;
        }
        out += &text[at..];
        Ok(out)
    }

    /// The parts of a page's text that change.
    fn edits(&mut self, page: &Page, text: &str) -> Result<Vec<(Range<usize>, String)>> {
        let mut edits = Vec::new();
        // The target of the last link, which may name the recipe in the next block of code.
        let mut last = String::new();
        let mut block: Option<(String, String)> = None;
        for (event, range) in Parser::new_ext(text, options()).into_offset_iter() {
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    last = dest_url.to_string();
                    let source = &text[range.clone()];
                    if let (GALLERY, Some(preset)) = (page.file, preset(source)) {
                        edits.push((range.start..range.start, "[".to_owned()));
                        edits.push((range.end..range.end, format!("]({STUDIO}?preset={preset})")));
                    }
                    if self.is_language_link(page, source, &dest_url) {
                        edits.push((range, String::new()));
                        continue;
                    }
                    let Some(new) = self.link(page, &dest_url)? else { continue };
                    let at = source.rfind(&*dest_url).with_context(|| format!("{}: the link {source}", page.file))?;
                    let start = range.start + at;
                    edits.push((start..start + dest_url.len(), new));
                }
                Event::Html(html) | Event::InlineHtml(html) => {
                    for attribute in ["src=\"", "href=\""] {
                        for (at, _) in html.match_indices(attribute) {
                            let start = range.start + at + attribute.len();
                            let target = text[start..].split('"').next().unwrap_or_default();
                            if let Some(new) = self.link(page, target)? {
                                edits.push((start..start + target.len(), new));
                            }
                        }
                    }
                }
                Event::End(TagEnd::Heading(HeadingLevel::H3)) if page.file == REFERENCE => {
                    let op = text[range.clone()].split('`').nth(1).unwrap_or_default();
                    let picture = format!("{OPS}{op}.jpg");
                    if self.root.join(&picture).is_file() {
                        let to = relative(page.address, &asset(&picture));
                        edits.push((
                            range.end..range.end,
                            format!("\n<img class=\"op\" src=\"{to}\" alt=\"{op}\">\n\n"),
                        ));
                        self.assets.insert(picture);
                    }
                }
                Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                    block = Some((info.to_string(), String::new()));
                }
                Event::Text(code) => {
                    if let Some((_, content)) = &mut block {
                        *content += &code;
                    }
                }
                Event::End(TagEnd::CodeBlock) => {
                    let Some((info, content)) = block.take() else { continue };
                    match info.as_str() {
                        "math" => edits.push((range, self.formula(page, &content)?)),
                        "toml" if last.starts_with("recipes/") => {
                            edits.push((range.end..range.end, self.studio(page, &last, &content)?));
                        }
                        _ => {}
                    }
                    last.clear();
                }
                // A browser shows a line's end as a blank, which Chinese does not have between sentences.
                Event::SoftBreak if page.language.is_unspaced() && !text[range.end..].starts_with(' ') => {
                    edits.push((range, String::new()));
                }
                _ => {}
            }
        }
        Ok(edits)
    }

    /// Whether a link is the one between two languages at the top of a page, which the site has on every page.
    fn is_language_link(&self, page: &Page, source: &str, target: &str) -> bool {
        LANGUAGES.iter().any(|other| other.tag != page.language.tag && source == format!("[{}]({target})", other.name))
    }

    /// Links to the same page in the other languages, or to their first pages.
    fn language_links(&self, page: &Page) -> String {
        let others = LANGUAGES.iter().filter(|other| other.tag != page.language.tag);
        let link = |other: &Language| {
            let first = format!("{}index.html", other.folder);
            let to = self.places.counterpart(page.file, page.language, other).unwrap_or(&first);
            let (tag, name) = (other.tag, other.name);
            format!("<a href=\"{}\" lang=\"{tag}\" hreflang=\"{tag}\">{name}</a>", relative(page.address, to))
        };
        format!("<p class=\"languages\">{}</p>\n\n", others.map(link).collect::<String>())
    }

    /// The target of a link in the site; `None` if it stays as it is.
    fn link(&mut self, page: &Page, target: &str) -> Result<Option<String>> {
        let (path, anchor) = target.split_once('#').map_or((target, ""), |(path, _)| (path, &target[path.len()..]));
        if path.is_empty() || path.contains(':') {
            return Ok(None);
        }
        let named = resolved(folder(page.file), path)?;
        let on_disk = self.root.join(&named);
        // A folder is no page: its readme stands for it.
        let file = match on_disk.is_dir() {
            true => Some(format!("{named}/README.md")).filter(|file| self.root.join(file).is_file()),
            false => on_disk.is_file().then_some(named),
        };
        let Some(file) = file else { bail!("{}: nothing in this site is what {target} links to", page.file) };
        if let Some(address) = self.places.address(&file) {
            return Ok(Some(relative(page.address, address) + anchor));
        }
        let address = asset(&file);
        self.assets.insert(file);
        Ok(Some(relative(page.address, &address) + anchor))
    }

    /// A formula in MathML, which browsers draw without a script.
    fn formula(&self, page: &Page, latex: &str) -> Result<String> {
        let mathml = self.formulas.convert_with_local_state(latex.trim(), MathDisplay::Block);
        let mathml = mathml.map_err(|error| anyhow::anyhow!("{}: the formula {latex}: {error}", page.file))?;
        Ok(format!("<div class=\"formula\">{}</div>\n", mathml.mathml.replace('\n', " ")))
    }

    /// The links below a recipe: to the studio with it, unless it reads files of the reader, and to its file.
    fn studio(&mut self, page: &Page, target: &str, recipe: &str) -> Result<String> {
        let file = resolved(folder(page.file), target)?;
        let address = asset(&file);
        self.assets.insert(file);
        let [open, download] = page.language.open;
        let studio = relative(page.address, "index.html").replace("index.html", STUDIO);
        let opened = format!("<a class=\"studio\" href=\"{studio}?open={FROM_STUDIO}{address}\">{open}</a> ");
        let opened = if recipe.contains(READS_A_FILE) { String::new() } else { opened };
        let to_file = relative(page.address, &address);
        Ok(format!("\n<p class=\"recipe\">{opened}<a href=\"{to_file}\" download>{download}</a></p>\n"))
    }
}

/// A page that is being changed.
struct Page<'a> {
    language: &'a Language,
    file: &'a str,
    address: &'a str,
}

/// The preset of a picture in the gallery: `![map of NAME](...)`.
fn preset(picture: &str) -> Option<&str> {
    picture.strip_prefix("![map of ")?.split(']').next()
}

/// The address of a file that is no page.
pub fn asset(file: &str) -> String {
    match file.strip_prefix("docs/") {
        Some(file) => file.to_owned(),
        None => format!("{OUTSIDE}{file}"),
    }
}

/// The extensions of Markdown that pages use.
pub fn options() -> Options {
    Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH | Options::ENABLE_FOOTNOTES
}
