//! What pages contain besides text: recipes and other files, commands, pictures.

use std::path::Path;
use std::process::Command;

use anyhow::{Context as _, Result, ensure};
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag, TagEnd};

use crate::page::options;
use crate::places::{LANGUAGES, folder};
use crate::stage;

/// The folders whose pages are followed step by step: their commands are run, and their recipes kept as files.
const FOLLOWED: [&str; 4] = ["docs/tutorial/", "docs/cookbook/", "docs/engines/", "docs/ops/"];

/// The folder of recipes, beside the pages that contain them.
const RECIPES: &str = "recipes/";

/// The folder of pictures, beside the pages that show them.
const PICTURES: &str = "pictures/";

/// A step of a page, in the order of the page.
#[derive(Debug, PartialEq)]
pub enum Part {
    /// A file that the page contains, and its name: the last name or link before it.
    File { name: String, content: String, is_recipe: bool },
    /// A command line.
    Command(String),
    /// A script in Python.
    Python(String),
    /// Lines that the command before it prints.
    Printed(String),
    /// A picture that a command before or after it has drawn: its name without an extension.
    Picture(String),
}

/// The pages with steps, in the first language; translations have the same.
pub fn pages(root: &Path) -> Result<Vec<String>> {
    let mut command = Command::new("git");
    let listed = command.current_dir(root).args(["ls-files"]).args(FOLLOWED).output().context("git")?;
    ensure!(listed.status.success(), "git cannot list the pages of {}", root.display());
    let listed = String::from_utf8(listed.stdout).context("git ls-files")?;
    let is_original = |file: &&str| file.ends_with(".md") && LANGUAGES[1..].iter().all(|l| !file.ends_with(l.suffix));
    Ok(listed.lines().filter(is_original).map(str::to_owned).collect())
}

/// The steps of a page.
pub fn parts(text: &str) -> Vec<Part> {
    let (mut parts, mut name, mut is_link) = (Vec::new(), String::new(), false);
    let mut block: Option<(Option<String>, String)> = None;
    for event in Parser::new_ext(text, options()) {
        match event {
            Event::Start(Tag::Link { dest_url, .. }) => (name, is_link) = (dest_url.to_string(), true),
            Event::Code(code) if !is_link => name = code.to_string(),
            // The name in a link is that of its file.
            Event::End(TagEnd::Paragraph) => is_link = false,
            Event::Start(Tag::Image { dest_url, .. }) => {
                if let Some(picture) = dest_url.strip_prefix(PICTURES) {
                    parts.push(Part::Picture(picture.trim_end_matches(".jpg").to_owned()));
                }
            }
            Event::Start(Tag::CodeBlock(kind)) => {
                let language = match kind {
                    CodeBlockKind::Fenced(info) => Some(info.to_string()),
                    CodeBlockKind::Indented => None,
                };
                block = Some((language, String::new()));
            }
            Event::Text(code) => {
                if let Some((_, content)) = &mut block {
                    *content += &code;
                }
            }
            Event::End(TagEnd::CodeBlock) => {
                let Some((language, content)) = block.take() else { continue };
                match language.as_deref() {
                    None => parts.extend(commands(&content)),
                    Some("python") => parts.push(Part::Python(content)),
                    Some("text") => parts.push(Part::Printed(content)),
                    // Formulas, and code of programs that are not here.
                    Some("math" | "gdscript" | "csharp" | "rust") => {}
                    Some(_) => {
                        let is_recipe = name.starts_with(RECIPES);
                        let name = name.rsplit('/').next().unwrap_or_default().to_owned();
                        parts.push(Part::File { name, content, is_recipe });
                    }
                }
                (name, is_link) = (String::new(), false);
            }
            _ => {}
        }
    }
    parts
}

/// The commands of a block, without comments.
fn commands(block: &str) -> Vec<Part> {
    let lines = block.lines().map(|line| line.split("  #").next().unwrap_or_default().trim());
    lines.filter(|line| !line.is_empty()).map(|line| Part::Command(line.to_owned())).collect()
}

/// Writes the recipes of all pages as files.
pub fn write(root: &Path) -> Result<()> {
    for page in pages(root)? {
        for part in parts(&stage::read(&root.join(&page))?) {
            let Part::File { name, content, is_recipe: true } = part else { continue };
            let to = root.join(folder(&page)).join(RECIPES).join(name);
            if stage::read(&to).ok().as_ref() != Some(&content) {
                stage::write(&to, content.as_bytes())?;
                println!("{}", to.display());
            }
        }
    }
    Ok(())
}

/// The path of a picture of a page in the repository.
pub fn picture(root: &Path, page: &str, name: &str) -> std::path::PathBuf {
    root.join(folder(page)).join(PICTURES).join(format!("{name}.jpg"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_a_page() {
        let text = "# A\n\nSave `x` as [`a.toml`](recipes/a.toml):\n\n```toml\norogen = 1\n```\n\n    orogen map a.toml -o a.png  # draws\n\n\
                    ![A](pictures/a.jpg)\n\n```math\nx\n```\n\nAs `b.csv`:\n\n```csv\nx\n```\n\n```python\nprint(1)\n```\n\n```text\n1\n```\n";
        let file = |name: &str, content: &str, is_recipe| {
            let (name, content) = (name.to_owned(), content.to_owned());
            Part::File { name, content, is_recipe }
        };
        let expected = [
            file("a.toml", "orogen = 1\n", true),
            Part::Command("orogen map a.toml -o a.png".to_owned()),
            Part::Picture("a".to_owned()),
            file("b.csv", "x\n", false),
            Part::Python("print(1)\n".to_owned()),
            Part::Printed("1\n".to_owned()),
        ];
        assert_eq!(parts(text), expected);
    }
}
