//! `cargo xtask codegen`: generates the lists of nodes, formats, layers and presets.
//!
//! A node is a file with one `op!` block. The lines of its module, its entry in the list of nodes and its part of the
//! JSON Schema are generated from that file. An export format is a file that declares a `FORMAT`, a layer of vector
//! features is a file that declares a `LAYER`, and a preset is a recipe file.

mod lists;
mod missing;
mod op;

use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result, on_file};
use crate::{output, shell};
use op::Op;

pub const ABOUT: &str =
    "rewrite the lists of modules, nodes, formats and presets, the JSON Schema and the ops' reference";

pub const HELP: &str = "
Usage: cargo xtask codegen [--check]

Reads the op! block of every file in crates/orogen-ops/src/{field,filter,levelled,solver} and rewrites
  - the modules and their items at the end of each folder's mod.rs
  - crates/orogen-ops/src/node_list.rs
  - crates/orogen-jobs/src/export/format_list.rs, of the files in export/formats that declare a FORMAT
  - crates/orogen-jobs/src/export/vector_list.rs, of the files in export/vectors that declare a LAYER
  - crates/orogen-engine/src/recipe/preset_list.rs, of the recipes in crates/orogen-engine/recipes
  - crates/orogen-studio/src/window/preset_pictures.rs, of the pictures in crates/orogen-studio/assets/presets
  - crates/orogen-engine/recipes/orogen.schema.json, from `orogen schema`
  - docs/ops.md, from `orogen ops --markdown`

Then it lists what declarations lack that other commands make: golden lines, pictures, rows of pages.

  --check  write nothing; fail if one of the files is not up to date, or if anything is missing
";

/// The four localities: the folder and the word in an op! block.
const LOCALITIES: [&str; 4] = ["field", "filter", "levelled", "solver"];

const SCHEMA: &str = "crates/orogen-engine/recipes/orogen.schema.json";
const REFERENCE: &str = "docs/ops.md";

/// Writes or checks everything.
pub fn run(args: &[String]) -> Result {
    let check = match args {
        [] => false,
        [flag] if flag == "--check" => true,
        _ => return Err(Failure::usage(format!("expected nothing or --check, got '{}'", args.join(" ")))),
    };
    // The lists come first: `orogen schema` does not build without the module of a new node.
    lists(shell::root(), check)?;
    written(check)
}

/// Writes or checks the lists of the tree at `root`, and looks for missing things that are not in lists. Missing things
/// are a failure if `check` is set, otherwise a note.
pub fn lists(root: &Path, check: bool) -> Result {
    let mut missing = bases(root)?;
    missing.extend(ops(root, check)?);
    missing.extend(exports(root, check)?);
    missing.extend(presets(root, check)?);
    match missing.is_empty() {
        true => Ok(()),
        false if check => Err(Failure::new(format!("not complete:\n{}", missing.join("\n")))),
        false => {
            output::line(format_args!("still missing:\n{}", missing.join("\n")));
            Ok(())
        }
    }
}

/// Messages about things that noise bases lack; their table is not generated.
fn bases(root: &Path) -> Result<Vec<String>> {
    let table = shell::read(&root.join("crates/orogen-noise/src/basis.rs"))?;
    let rows = table.lines().filter(|line| line.contains(", cost "));
    missing::find(root, missing::BASIS, rows.filter_map(|row| row.split('"').nth(1)))
}

/// The module lines and the list of nodes.
fn ops(root: &Path, check: bool) -> Result<Vec<String>> {
    let src = root.join("crates/orogen-ops/src");
    let mut ops = Vec::new();
    for locality in LOCALITIES {
        let folder = src.join(locality);
        let mut listed = Vec::new();
        for name in stems(&folder, "rs")? {
            let path = folder.join(format!("{name}.rs"));
            let text = shell::read(&path)?;
            let found = op::find(&text).map_err(|e| Failure::new(format!("{}: {e}", shell::relative(&path))))?;
            let mut items = Vec::new();
            if let Some(declared) = found {
                items = op::public_types(&text);
                if declared.locality != locality {
                    return Err(Failure::new(format!(
                        "{}: its op! block says {}, its folder says {locality}",
                        shell::relative(&path),
                        declared.locality
                    )));
                }
                ops.push(Op { module: name.clone(), ..declared });
            }
            listed.push((name, items));
        }
        settle_modules(&folder, &lists::op_modules(&listed), check)?;
    }
    lists::distinct(&ops).map_err(Failure::new)?;
    settle(&src.join("node_list.rs"), &lists::node_list(&LOCALITIES, &ops), check)?;
    missing::find(root, missing::OP, ops.iter().map(|op| op.op.as_str()))
}

/// Generated lists of exports: the folder, the declaration, and the name of the list.
const DECLARED: [(&str, &str, &str); 2] =
    [("formats", "FORMAT: Format", "format_list.rs"), ("vectors", "LAYER: VectorLayer", "vector_list.rs")];

/// The module lines and lists of export formats and of layers of vector features.
fn exports(root: &Path, check: bool) -> Result<Vec<String>> {
    let export = root.join("crates/orogen-jobs/src/export");
    let mut formats = Vec::new();
    for (folder, declaration, list) in DECLARED {
        let (constant, _) = declaration.split_once(':').unwrap_or((declaration, ""));
        let names = stems(&export.join(folder), "rs")?;
        let mut lines = Vec::new();
        for name in &names {
            let text = shell::read(&export.join(folder).join(format!("{name}.rs")))?;
            if text.lines().any(|line| line.starts_with(&format!("pub static {declaration}"))) {
                lines.push(format!("&{folder}::{name}::{constant}"));
                formats.extend(text.lines().filter(|_| constant == "FORMAT").find_map(lists::declared_name));
            }
        }
        settle_modules(&export.join(folder), &lists::public_modules(&names), check)?;
        settle(&export.join(list), &lists::list(&format!("files in {folder}/"), &lines), check)?;
    }
    missing::find(root, missing::FORMAT, formats.iter().map(String::as_str))
}

/// The lists of presets, which are recipes, and of their pictures on the start page of the studio.
fn presets(root: &Path, check: bool) -> Result<Vec<String>> {
    let [recipes, pictures] = ["crates/orogen-engine/recipes", "crates/orogen-studio/assets/presets"];
    let names = stems(&root.join(recipes), "toml")?;
    let lines: Vec<String> = (names.iter())
        .map(|name| format!("Preset {{ name: \"{name}\", text: include_str!(\"../../recipes/{name}.toml\") }}"))
        .collect();
    let list = root.join("crates/orogen-engine/src/recipe/preset_list.rs");
    settle(&list, &lists::list("files in recipes/", &lines), check)?;
    let lines: Vec<String> = (stems(&root.join(pictures), "png")?.iter())
        .map(|name| format!("(\"{name}\", include_bytes!(\"../../assets/presets/{name}.png\"))"))
        .collect();
    let list = root.join("crates/orogen-studio/src/window/preset_pictures.rs");
    settle(&list, &lists::list("pictures in assets/presets/", &lines), check)?;
    missing::find(root, missing::PRESET, names.iter().map(String::as_str))
}

/// Writes the lines of modules at the end of a folder's mod.rs.
fn settle_modules(folder: &Path, lines: &[String], check: bool) -> Result {
    let list = folder.join("mod.rs");
    let head = shell::read(&list)?;
    let text = lists::module_file(&head, lines)
        .ok_or_else(|| Failure::new(format!("{}: the line '{}' is missing", shell::relative(&list), lists::MARKER)))?;
    settle(&list, &text, check)
}

/// Writes the documents made from declarations: the JSON Schema of recipes and the reference of the ops.
fn written(check: bool) -> Result {
    for (arguments, path) in [("schema", SCHEMA), ("ops --markdown", REFERENCE)] {
        let text = shell::capture(&mut shell::cargo(&format!("run --quiet --package orogen-cli -- {arguments}")))?;
        if text.trim().is_empty() {
            return Err(Failure::new(format!("`orogen {arguments}` printed nothing")));
        }
        settle(&shell::root().join(path), &text, check)?;
    }
    Ok(())
}

/// The names of a folder's files with this extension, without it.
fn stems(folder: &Path, extension: &str) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(folder).map_err(|e| on_file("read", folder, &e))?;
    let mut names = Vec::new();
    for entry in entries {
        let path: PathBuf = entry.map_err(|e| on_file("read", folder, &e))?.path();
        let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or("");
        if path.extension().is_some_and(|e| e == extension) && stem != "mod" {
            names.push(stem.to_owned());
        }
    }
    names.sort_by(|a, b| lists::version_order(a, b));
    Ok(names)
}

/// Writes a file with this text, or fails if it differs.
fn settle(path: &Path, text: &str, check: bool) -> Result {
    let shown = shell::relative(path);
    let current = if path.exists() { shell::read(path)? } else { String::new() };
    if current == text {
        output::line(format_args!("    {shown} is current"));
        return Ok(());
    }
    if check {
        return Err(Failure::new(format!(
            "{shown} is not current; run `cargo xtask codegen` and commit what it writes"
        )));
    }
    output::line(format_args!("    {shown} rewritten"));
    shell::write(path, text)
}
