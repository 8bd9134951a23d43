//! The commands of pages, run in their order, each page in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, Result, bail, ensure};

use crate::recipes::{Part, pages, parts, picture};
use crate::{pictures, stage};

/// What happens with the pictures of pages.
#[derive(Clone, Copy, PartialEq)]
pub enum Pictures {
    /// They must be what the commands drew.
    Compare,
    /// They are replaced by what the commands drew.
    Write,
}

/// Minimum size in bytes of a file that a command writes.
const MIN_BYTES: u64 = 50;

/// Runs the commands of all pages, or of those whose path contains one of some words.
pub fn run(root: &Path, orogen: &Path, work: &Path, kept: Pictures, words: &[&str]) -> Result<()> {
    let is_asked = |page: &String| words.is_empty() || words.iter().any(|word| page.contains(word));
    let asked: Vec<String> = pages(root)?.into_iter().filter(is_asked).collect();
    ensure!(!asked.is_empty(), "no page has such a path");
    let (mut faults, mut count, begun) = (Vec::new(), 0, Instant::now());
    for page in &asked {
        let folder = work.join(page.trim_start_matches("docs/").trim_end_matches(".md").replace('/', "-"));
        match follow(root, orogen, &folder, kept, page) {
            Ok(commands) => count += commands,
            Err(error) => faults.push(format!("  {page}: {error:#}")),
        }
    }
    ensure!(faults.is_empty(), "pages whose commands fail:\n{}", faults.join("\n"));
    println!("    {count} commands of {} pages in {:.1} s", asked.len(), begun.elapsed().as_secs_f64());
    Ok(())
}

/// Follows a page in an empty folder; returns the number of its commands.
fn follow(root: &Path, orogen: &Path, folder: &Path, kept: Pictures, page: &str) -> Result<usize> {
    if folder.exists() {
        std::fs::remove_dir_all(folder)?;
    }
    std::fs::create_dir_all(folder)?;
    let (begun, mut count, mut printed) = (Instant::now(), 0, String::new());
    let parts = parts(&stage::read(&root.join(page))?);
    for part in &parts {
        match part {
            Part::File { name, content, .. } => {
                ensure!(name.contains('.'), "a block of text has no name: {content}");
                stage::write(&folder.join(name), content.as_bytes())?;
            }
            Part::Command(line) => {
                printed = command(orogen, folder, line)?;
                count += 1;
            }
            Part::Python(script) => {
                let mut python = Command::new("python3");
                printed = output(python.current_dir(folder).arg("-c").arg(script)).context("the script in Python")?;
                count += 1;
            }
            Part::Printed(lines) => {
                for line in lines.lines() {
                    ensure!(printed.contains(line.trim()), "the command does not print '{line}', but:\n{printed}");
                }
            }
            Part::Picture(_) => {}
        }
    }
    // A page without commands shows the pictures of others.
    for part in parts.iter().filter(|_| count > 0) {
        let Part::Picture(name) = part else { continue };
        let bytes = pictures::encoded(&drawn(folder, name))?;
        let to = picture(root, page, name);
        if std::fs::read(&to).ok().as_ref() == Some(&bytes) {
            continue;
        }
        match kept {
            Pictures::Write => stage::write(&to, &bytes)?,
            Pictures::Compare => bail!("{} is not what the commands draw: `cargo xtask gallery book`", to.display()),
        }
    }
    println!("    {page}: {count} commands, {:.1} s", begun.elapsed().as_secs_f64());
    Ok(count)
}

/// The file of a picture: a file of its name, or the picture of a folder of its name.
fn drawn(folder: &Path, name: &str) -> PathBuf {
    let inside = ["preview.png", "map.png"].map(|file| folder.join(name).join(file));
    inside.into_iter().find(|file| file.is_file()).unwrap_or_else(|| folder.join(format!("{name}.png")))
}

/// Runs a command line, and checks that it wrote the file that it names; returns what it printed.
fn command(orogen: &Path, folder: &Path, line: &str) -> Result<String> {
    let words = words(line);
    let (program, arguments) = words.split_first().context("an empty command")?;
    let mut command = match program.as_str() {
        "orogen" => Command::new(orogen),
        other => Command::new(other),
    };
    // Solutions are kept from command to command, as they are for readers, but not from run to run.
    let cache = folder.parent().unwrap_or(folder).join("cache");
    command.current_dir(folder).args(arguments).env("OROGEN_CACHE", cache);
    let printed = output(&mut command).with_context(|| line.to_owned())?;
    if let Some(at) = arguments.iter().position(|argument| argument == "-o") {
        let out = arguments.get(at + 1).context("-o without a name")?;
        ensure!(is_written(folder, out), "{line}: it wrote no {out}");
    }
    Ok(printed)
}

/// Whether a command wrote an output: a folder, a file, or several files whose names it completed, as for tiles.
fn is_written(folder: &Path, out: &str) -> bool {
    let file = folder.join(out);
    if file.is_dir() || file.metadata().is_ok_and(|file| file.len() >= MIN_BYTES) {
        return true;
    }
    let (stem, extension) = out.rsplit_once('.').unwrap_or((out, ""));
    let names = folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.file_name());
    names
        .filter_map(|name| name.into_string().ok())
        .any(|name| name.strip_prefix(stem).is_some_and(|rest| rest.starts_with('_') && rest.ends_with(extension)))
}

/// Runs a program; returns what it printed. Its errors are part of the failure.
fn output(command: &mut Command) -> Result<String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.stdin(Stdio::null()).output().with_context(|| format!("cannot start {name}"))?;
    let [out, errors] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    ensure!(output.status.success(), "{}", errors.trim());
    Ok(out + &errors)
}

/// The words of a command line; those in double quotes may contain blanks.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut is_quoted) = (Vec::new(), None::<String>, false);
    for c in line.chars() {
        match c {
            '"' => {
                is_quoted = !is_quoted;
                word.get_or_insert_default();
            }
            ' ' if !is_quoted => words.extend(word.take()),
            c => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_line() {
        assert_eq!(
            words("orogen map  a -o b.png --title \"The Isles\" \"\""),
            ["orogen", "map", "a", "-o", "b.png", "--title", "The Isles", ""]
        );
    }
}
