//! The recipes of the tutorial, the cookbook and the pages for engines: each stands on a page and in a file of its own.
//! `cargo xtask clients book` runs the commands of these pages. Those of all other pages are parsed here.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::harness::{Folder, words};

/// The folders with such pages.
const FOLDERS: [&str; 4] = ["tutorial", "cookbook", "engines", "ops"];

/// The files with an extension in a folder, sorted; none if there is no folder.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|file| file.extension().is_some_and(|e| e == extension)).collect();
    files.sort();
    files
}

/// The recipes of a page: names and texts of the blocks that follow a link to a file in `recipes/`.
fn recipes(page: &str) -> Vec<(&str, &str)> {
    let blocks = page.match_indices("](recipes/").map(|(at, link)| &page[at + link.len()..]);
    blocks
        .filter_map(|rest| {
            let (name, rest) = rest.split_once(')')?;
            let (between, rest) = rest.split_once("```toml\n")?;
            // Other links to the file have no block of their own.
            (between.trim_matches([':', '.', '\n', ' ']).is_empty()).then_some(())?;
            Some((name, rest.split_once("```").map(|(recipe, _)| recipe)?))
        })
        .collect()
}

#[test]
fn recipes_of_pages_are_valid_and_kept_as_files() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let folder = Folder::with_small();
    // The heights that a page makes before its recipe.
    folder.good(&["export", "small.toml", "-o", "valley.tif"]);
    let mut names = Vec::new();
    for pages in FOLDERS.map(|name| docs.join(name)) {
        let mut on_pages = Vec::new();
        for page in files(&pages, "md") {
            let text = std::fs::read_to_string(&page).unwrap();
            for (name, recipe) in recipes(&text) {
                let file = pages.join("recipes").join(name);
                let kept = std::fs::read_to_string(&file).unwrap_or_default();
                let advice = "is not the recipe of the page: run `cargo xtask gallery book`";
                assert!(kept == recipe, "{}: {} {advice}", page.display(), file.display());
                on_pages.push(file);
            }
        }
        for file in files(&pages.join("recipes"), "toml") {
            assert!(on_pages.contains(&file), "{} is on no page", file.display());
            let name = format!("{}-{}", names.len(), file.file_name().unwrap().to_str().unwrap());
            folder.write(&name, std::fs::read_to_string(&file).unwrap());
            names.push(name);
        }
    }
    assert!(names.len() >= 15, "{names:?}");
    let arguments: Vec<&str> = ["check"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let told = folder.good(&arguments);
    assert_eq!(told.text().matches(": valid, ").count(), names.len(), "{}", told.text());
}

/// The commands within the sentences of a page.
fn inline_commands(page: &str) -> Vec<String> {
    let parts = page.split('`').skip(1).step_by(2);
    parts.filter_map(|code| code.strip_prefix("orogen ")).map(str::to_owned).collect()
}

/// The command lines of a page: those in indented blocks, with continued lines joined, without comments.
fn commands(page: &str) -> Vec<String> {
    let joined = page.replace("\\\n", " ");
    let (mut commands, mut is_fenced) = (Vec::new(), false);
    for line in joined.lines() {
        is_fenced ^= line.starts_with("```");
        if let (false, Some(command)) = (is_fenced, line.strip_prefix("    orogen ")) {
            commands.push(command.split(" #").next().unwrap_or_default().trim().to_owned());
        }
    }
    commands
}

#[test]
fn every_command_of_the_docs_is_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["docs"].into_iter().map(str::to_owned).chain(FOLDERS.map(|folder| format!("docs/{folder}")));
    let pages = folders.flat_map(|folder| files(&root.join(folder), "md")).chain([root.join("README.md")]);
    let mut found = BTreeMap::new();
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap();
        // In the reference, inline commands have placeholders.
        let is_followed = FOLDERS.iter().any(|folder| page.parent().is_some_and(|parent| parent.ends_with(folder)));
        let inline = if is_followed { inline_commands(&text) } else { Vec::new() };
        for command in commands(&text).into_iter().chain(inline) {
            found.entry(command).or_insert_with(|| page.clone());
        }
    }
    assert!(found.len() > 300, "{} commands", found.len());
    let folder = Folder::new();
    for (command, page) in &found {
        // The shell would replace the variable of a cluster.
        let mut arguments = words(&command.replace("$SLURM_ARRAY_TASK_ID", "1"));
        // All that is before it has been parsed when it is found.
        arguments.push("--help".to_owned());
        let outcome = folder.run(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        // Commands of optional features are those of other builds.
        if outcome.err.contains("this program was built without") {
            continue;
        }
        assert_eq!(outcome.code, 0, "{}: orogen {command}: {}", page.display(), outcome.err);
    }
}
