//! The shaded relief of every preset, as pictures and as a page of the docs.

use std::path::Path;

use crate::failure::{Result, on_file};
use crate::shell;

/// The window that is shaded, at the world's cell.
fn part(preset: &str) -> &'static str {
    match preset {
        // In its mountains.
        "continent" => "16824,23480,400,400",
        // All of it.
        "caves" => "0,0,384,384",
        _ => "100,100,400,400",
    }
}

/// The shaded relief of every preset, and the page with all of them.
pub fn write(presets: &[(&str, &str)], images: &Path) -> Result {
    let mut page = String::from(
        "# Gallery\n\nEvery preset with its defaults: a map of the whole world, and the shaded relief of a part of it without colors (light from the north-west at\n\
         45 degrees elevation; one pixel per sample at the world's own cell), which shows artifacts that colors hide.\n\nWritten by `cargo xtask gallery`.\n\n\
         | preset | map | shaded relief |\n|---|---|---|\n",
    );
    for (name, about) in presets {
        let to = images.join(format!("{name}-hillshade.png"));
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- export --quiet --layer hillshade");
        shell::run(orogen.args([name, "--bits", "8", "--range", "0,1", "--window", part(name), "-o"]).arg(&to))?;
        // The sidecar serves programs that read the samples; a picture of the docs needs none.
        let sidecar = to.with_extension("json");
        std::fs::remove_file(&sidecar).map_err(|e| on_file("delete", &sidecar, &e))?;
        println!("{}", shell::relative(&to));
        let about = about.trim();
        page += &format!(
            "| `{name}`: {about} | ![map of {name}](images/{name}.png) | ![shaded relief of {name}](images/{name}-hillshade.png) |\n"
        );
    }
    let to = shell::root().join("docs/gallery.md");
    std::fs::write(&to, page).map_err(|e| on_file("write", &to, &e))
}
