//! Things that a declaration needs and that codegen does not write: golden lines, pictures, rows of pages.

use std::path::Path;

use crate::failure::Result;
use crate::shell;

/// Files that belong to a declaration; `NAME` stands for its name.
pub struct Required {
    /// The file, or several files of which one suffices.
    files: &'static [&'static str],
    /// Texts, one of which must be in the file. If there are none, the file only has to exist.
    texts: &'static [&'static str],
    /// What to do if it is missing.
    how: &'static str,
}

const BLESS: &str = "run `cargo xtask bless golden`";
const GALLERY: &str = "run `cargo xtask gallery NAME`";

/// Files of an op.
pub const OP: &[Required] = &[
    Required { files: &["golden/ops.txt"], texts: &["\nNAME ", "\nNAME."], how: BLESS },
    Required {
        files: &["docs/ops/README.md"],
        texts: &["`NAME`"],
        how: "add its node, command and picture, and run `cargo xtask gallery book`",
    },
];

/// Files of a noise basis.
pub const BASIS: &[Required] =
    &[Required { files: &["crates/orogen-noise/tests/goldens.txt"], texts: &["\nfbm NAME "], how: BLESS }];

/// Files of an export format.
pub const FORMAT: &[Required] = &[Required {
    files: &["docs/formats.md", "docs/meshes.md", "docs/water.md"],
    texts: &["`.NAME`"],
    how: "add a row that describes it",
}];

/// Files of a preset.
pub const PRESET: &[Required] = &[
    Required { files: &["golden/presets.txt"], texts: &["\nNAME "], how: BLESS },
    Required { files: &["docs/images/NAME.png"], texts: &[], how: GALLERY },
    Required { files: &["docs/images/NAME-hillshade.png"], texts: &[], how: GALLERY },
    Required { files: &["crates/orogen-studio/assets/presets/NAME.png"], texts: &[], how: GALLERY },
    Required { files: &["docs/gallery.md"], texts: &["\n| `NAME`: "], how: GALLERY },
    Required { files: &["docs/resolution.md"], texts: &["\n| NAME, "], how: "run `cargo xtask resolution`" },
];

/// A line for each thing that these names lack in the tree at `root`.
pub fn find<'a>(root: &Path, places: &[Required], names: impl Iterator<Item = &'a str> + Clone) -> Result<Vec<String>> {
    let mut missing = Vec::new();
    for Required { files, texts, how } in places {
        let mut content = String::new();
        for file in files.iter().filter(|_| !texts.is_empty()) {
            content += &format!("\n{}", shell::read(&root.join(file))?);
        }
        for name in names.clone() {
            let of_name = |text: &str| text.replace("NAME", name);
            let (found, lack) = match texts {
                [] => (files.iter().all(|file| root.join(of_name(file)).is_file()), "is missing".to_owned()),
                _ => (texts.iter().any(|text| content.contains(&of_name(text))), format!("does not have `{name}`")),
            };
            if !found {
                missing.push(format!("  {} {lack}: {}", of_name(&files.join(" or ")), of_name(how)));
            }
        }
    }
    Ok(missing)
}
