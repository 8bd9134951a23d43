//! Pictures of the studio's window. `cargo xtask clients studio` makes them, because they need a display.

use std::path::{Path, PathBuf};

use crate::clients::studio;
use crate::failure::{Failure, Result, on_file};
use crate::shell;

/// The files and the folder that stay when all other pictures are made again.
const FILES: [&str; 2] = ["studio.png", "studio-zh.png"];
const FOLDER: &str = "studio";

/// A picture and its bytes.
type Picture = (PathBuf, Vec<u8>);

/// Takes the pictures of jobs that the last `cargo xtask clients studio` left.
pub fn write(images: &Path) -> Result {
    let made = listed(&studio::pictures())?;
    if made.is_empty() {
        return Err(Failure::new("there are no pictures of the studio; run `cargo xtask clients studio` first"));
    }
    let folder = images.join(FOLDER);
    shell::empty_dir(&folder)?;
    for path in made {
        let to = folder.join(path.file_name().unwrap_or_default());
        std::fs::copy(&path, &to).map_err(|e| on_file("write", &to, &e))?;
        println!("{}", shell::relative(&to));
    }
    Ok(())
}

/// Reads the pictures of windows in the docs.
pub fn read(images: &Path) -> Result<Vec<Picture>> {
    let files = FILES.iter().map(|name| images.join(name)).filter(|path| path.is_file());
    files
        .chain(listed(&images.join(FOLDER))?)
        .map(|path| {
            let bytes = std::fs::read(&path).map_err(|e| on_file("read", &path, &e))?;
            Ok((path, bytes))
        })
        .collect()
}

/// Writes pictures that were read.
pub fn restore(images: &Path, pictures: Vec<Picture>) -> Result {
    shell::empty_dir(&images.join(FOLDER))?;
    pictures
        .into_iter()
        .try_for_each(|(path, bytes)| std::fs::write(&path, bytes).map_err(|e| on_file("write", &path, &e)))
}

/// The pictures of jobs in a folder; none if there is no folder.
fn listed(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let entries = std::fs::read_dir(folder).map_err(|e| on_file("read", folder, &e))?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| on_file("read", folder, &e))?.path();
        if path.extension().is_some_and(|extension| extension == "webp") {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
