//! Checks that the documented surface of the libraries stays small enough to survey.

use std::collections::BTreeSet;
use std::path::Path;

use crate::failure::{Failure, Result, on_file};
use crate::output;

/// Maximum number of items at the root of `orogen`.
const ROOT: usize = 120;

/// Maximum number of modules of all other crates.
const MODULES: usize = 150;

/// Maximum number of public types of all other crates. A quarter of them are ops.
const TYPES: usize = 420;

/// Maximum depth of a module.
const DEPTH: usize = 2;

/// The documented surface, from the pages that rustdoc has written.
#[derive(Default)]
struct Surface {
    /// Number of items at the root of `orogen`.
    root: usize,
    /// The modules of all other crates.
    modules: BTreeSet<String>,
    /// The types by their path in a crate: a type that a crate re-exports at the same path counts once.
    places: BTreeSet<String>,
    /// The types by crate and name: a type that a crate has at two paths counts once.
    types: BTreeSet<String>,
}

/// Checks the pages of the documentation in a folder.
pub fn check(pages: &Path) -> Result {
    let mut surface = Surface::default();
    for (name, path, is_folder) in entries(pages)? {
        if !is_folder || !name.starts_with("orogen") {
            continue;
        }
        if name == "orogen" {
            let items = entries(&path)?;
            surface.root = items.iter().filter(|(item, _, is_folder)| *is_folder || is_item(item)).count();
        } else {
            read(&path, &name, &mut surface)?;
        }
    }
    let Surface { root, modules, types, .. } = &surface;
    output::line(format_args!(
        "    {root} items at the root of orogen; {} modules and {} types in the other crates",
        modules.len(),
        types.len()
    ));
    let mut faults = Vec::new();
    let mut most = |what: &str, count: usize, limit: usize| {
        if count > limit {
            faults.push(format!("  {count} {what}, at most {limit}"));
        }
    };
    most("items at the root of `orogen`", *root, ROOT);
    most("modules in the other crates", modules.len(), MODULES);
    most("public types in the other crates", types.len(), TYPES);
    let deep = modules.iter().filter(|module| module.matches("::").count() > DEPTH);
    faults.extend(deep.map(|module| format!("  the module {module} is deeper than {DEPTH}")));
    if *root == 0 || types.is_empty() {
        faults.push(format!("  {} has no pages of the crates", pages.display()));
    }
    if faults.is_empty() {
        return Ok(());
    }
    let advice = "pass on what programs use in the `mod.rs` of its folder, and mark the rest `#[doc(hidden)]`";
    Err(Failure::new(format!("the documented surface is too wide:\n{}\n{advice}", faults.join("\n"))))
}

/// Adds the modules and types of a folder of pages.
fn read(folder: &Path, module: &str, surface: &mut Surface) -> Result {
    // A folder without an index has only pages that redirect to the documentation of an item.
    let is_module = folder.join("index.html").is_file();
    if is_module && module.contains("::") {
        surface.modules.insert(module.to_owned());
    }
    for (name, path, is_folder) in entries(folder)? {
        if is_folder {
            read(&path, &format!("{module}::{name}"), surface)?;
        } else if is_module
            && ["struct.", "enum.", "trait.", "type.", "union."].iter().any(|kind| name.starts_with(kind))
        {
            let (owner, place) = module.split_once("::").unwrap_or((module, ""));
            if surface.places.insert(format!("{place}/{name}")) {
                surface.types.insert(format!("{owner}/{name}"));
            }
        }
    }
    Ok(())
}

/// Whether a file is the page of an item.
fn is_item(name: &str) -> bool {
    name.ends_with(".html") && name.matches('.').count() == 2
}

/// Names, paths, and whether each is a folder, sorted, so that counts do not depend on the order of the file system.
fn entries(folder: &Path) -> Result<Vec<(String, std::path::PathBuf, bool)>> {
    let listed = std::fs::read_dir(folder).map_err(|cause| on_file("read", folder, &cause))?;
    let entry = |entry: std::fs::DirEntry| {
        let path = entry.path();
        (entry.file_name().to_string_lossy().into_owned(), path.clone(), path.is_dir())
    };
    let mut entries: Vec<_> = listed.flatten().map(entry).collect();
    entries.sort();
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pages(name: &str, files: &[&str]) -> std::path::PathBuf {
        let folder = std::env::temp_dir().join(format!("orogen-front-door-{}-{name}", std::process::id()));
        for file in files {
            let path = folder.join(file);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(path, "").expect("a page");
        }
        folder
    }

    fn said(pages: &Path) -> String {
        check(pages).expect_err("a fault").message().to_owned()
    }

    #[test]
    fn pages_are_counted_and_deep_modules_refused() {
        let good =
            ["orogen/fn.open.html", "orogen/index.html", "orogen_a/room/index.html", "orogen_a/room/struct.A.html"];
        let folder = pages("good", &good);
        check(&folder).expect("a small surface");
        let deep = pages("deep", &[&good[..], &["orogen_a/b/c/d/index.html"]].concat());
        let error = said(&deep);
        assert!(error.contains("the module orogen_a::b::c::d is deeper than 2"), "{error}");
        let items: Vec<String> = (0..=ROOT).map(|i| format!("orogen/struct.S{i}.html")).collect();
        let items: Vec<&str> = items.iter().map(String::as_str).chain(good).collect();
        let error = said(&pages("wide", &items));
        assert!(error.contains("122 items at the root of `orogen`, at most 120"), "{error}");
        let error = said(&pages("empty", &["other/index.html"]));
        assert!(error.contains("has no pages"), "{error}");
        for name in ["good", "deep", "wide", "empty"] {
            std::fs::remove_dir_all(pages(name, &[])).expect("removed");
        }
    }
}
