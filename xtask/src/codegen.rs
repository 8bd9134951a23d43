//! `cargo xtask codegen`: generates the lists of nodes, formats and layers.
//!
//! A node is a file with one `op!` block. The lines of its module, its entry in the list of nodes and its part of the
//! JSON Schema are generated from that file. An export format is a file that declares a `FORMAT`, a layer of vector
//! features one that declares a `LAYER`.

mod lists;
mod op;

use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result, on_file};
use crate::{output, shell};
use op::Op;

pub const ABOUT: &str = "rewrite the lists of modules, nodes and formats, the JSON Schema and the ops' reference";

pub const HELP: &str = "
Usage: cargo xtask codegen [--check]

Reads the op! block of every file in crates/orogen-ops/src/{field,filter,levelled,solver} and rewrites
  - the modules and their items at the end of each folder's mod.rs
  - crates/orogen-ops/src/node_list.rs
  - crates/orogen-jobs/src/export/format_list.rs, of the files in export/formats that declare a FORMAT
  - crates/orogen-jobs/src/export/vector_list.rs, of the files in export/vectors that declare a LAYER
  - crates/orogen-engine/recipes/orogen.schema.json, from `orogen schema`
  - docs/ops.md, from `orogen ops --markdown`

  --check  write nothing; fail if one of the files is not up to date
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
    lists(check)?;
    written(check)
}

/// The module lines and the list of nodes.
pub fn lists(check: bool) -> Result {
    let src = shell::root().join("crates/orogen-ops/src");
    let mut ops = Vec::new();
    for locality in LOCALITIES {
        let folder = src.join(locality);
        let mut listed = Vec::new();
        for name in modules(&folder)? {
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
    exports(&shell::root().join("crates/orogen-jobs/src/export"), check)
}

/// Generated lists of exports: the folder, the declaration, and the name of the list.
const DECLARED: [(&str, &str, &str); 2] =
    [("formats", "FORMAT: Format", "format_list.rs"), ("vectors", "LAYER: VectorLayer", "vector_list.rs")];

/// The module lines and lists of export formats and of layers of vector features.
fn exports(export: &Path, check: bool) -> Result {
    for (folder, declaration, list) in DECLARED {
        let (constant, _) = declaration.split_once(':').unwrap_or((declaration, ""));
        let names = modules(&export.join(folder))?;
        let mut declared = Vec::new();
        for name in &names {
            let text = shell::read(&export.join(folder).join(format!("{name}.rs")))?;
            if text.lines().any(|line| line.starts_with(&format!("pub static {declaration}"))) {
                declared.push(name.clone());
            }
        }
        settle_modules(&export.join(folder), &lists::public_modules(&names), check)?;
        settle(&export.join(list), &lists::declared_list(folder, constant, &declared), check)?;
    }
    Ok(())
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

/// The names of a folder's modules.
fn modules(folder: &Path) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(folder).map_err(|e| on_file("read", folder, &e))?;
    let mut names = Vec::new();
    for entry in entries {
        let path: PathBuf = entry.map_err(|e| on_file("read", folder, &e))?.path();
        let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or("");
        if path.extension().is_some_and(|e| e == "rs") && stem != "mod" {
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
