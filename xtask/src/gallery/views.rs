//! Rendered views.

use std::path::Path;

use crate::failure::Result;
use crate::shell;

/// The name of a picture, and the arguments of `orogen render`.
const VIEWS: [(&str, &str); 7] = [
    (
        "hero",
        "fjords --edge haze --size 1280x640 --samples 9 --camera 13000,5500,2400 --look 27000,6500 --fov 48 --sun 250,20",
    ),
    ("view-alpine", "alpine --size 1120x630 --samples 9"),
    ("view-island", "island --size 1120x630 --samples 9 --camera 215,16"),
    ("view-canyon", "canyon --size 1120x630 --samples 9 --color desert --camera 225,22 --sun 275,24"),
    ("view-folds", "folds --size 1120x630 --samples 9 --color desert --camera 205,24 --sun 255,30"),
    (
        "view-mesa",
        "mesa --size 880x495 --samples 9 --color desert --camera 15000,24000,3600 --look 12000,11000 --sun 275,24",
    ),
    ("view-volcano", "volcano --size 1120x630 --samples 9 --color surfaces --camera 215,24"),
];

/// Writes them to a folder.
pub fn write(images: &Path) -> Result {
    for (name, arguments) in VIEWS {
        let to = images.join(format!("{name}.png"));
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- render --quiet");
        shell::run(orogen.args(arguments.split_whitespace()).arg("-o").arg(&to))?;
        println!("{}", shell::relative(&to));
    }
    Ok(())
}
