//! The pictures of presets, and the page of the docs with all of them.

use std::path::Path;

use crate::failure::{Result, on_file};
use crate::shell;

/// Samples along a side of a preset's map, and of its map on the start page of the studio.
const SIZES: [&str; 2] = ["400", "150"];

/// The window that is shaded, at the world's cell.
fn part(preset: &str) -> &'static str {
    match preset {
        // A window in its mountains.
        "continent" => "16824,23480,400,400",
        // Glaciers and cirques.
        "glaciers" => "430,540,400,400",
        // Bends, an oxbow lake and a terrace.
        "floodplain" => "560,330,400,400",
        // A front with fans, and a playa.
        "basin" => "330,130,400,400",
        // Rims and walls.
        "canyon" => "250,330,400,400",
        // The summit.
        "volcano" => "310,310,400,400",
        // The whole world.
        "caves" => "0,0,384,384",
        _ => "100,100,400,400",
    }
}

/// A preset's maps and its shaded relief.
pub fn write(preset: &str, images: &Path) -> Result {
    let work = shell::target_dir().join("gallery");
    let start_page = shell::root().join("crates/orogen-studio/assets/presets");
    for (folder, size) in [images, &start_page].into_iter().zip(SIZES) {
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- generate --quiet");
        shell::run(orogen.args([preset, "--size", size, "-o"]).arg(&work))?;
        let to = folder.join(format!("{preset}.png"));
        std::fs::copy(work.join("map.png"), &to).map_err(|e| on_file("write", &to, &e))?;
        println!("{}", shell::relative(&to));
    }
    let to = images.join(format!("{preset}-hillshade.png"));
    let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- export --quiet --layer hillshade");
    shell::run(orogen.args([preset, "--bits", "8", "--range", "0,1", "--window", part(preset), "-o"]).arg(&to))?;
    // The sidecar serves programs that read the samples; a picture of the docs needs none.
    let sidecar = to.with_extension("json");
    std::fs::remove_file(&sidecar).map_err(|e| on_file("delete", &sidecar, &e))?;
    println!("{}", shell::relative(&to));
    Ok(())
}

/// The page with the pictures of all presets.
pub fn page(presets: &[(&str, &str)]) -> Result {
    let mut page = String::from(
        "# Gallery\n\nEvery preset with its defaults: a map of the whole world, and the shaded relief of a part of it without colors (light from the north-west at 45 degrees elevation; one pixel per sample at the world's own cell), which shows artifacts that colors hide.\n\nWritten by `cargo xtask gallery`.\n\n\
         | preset | map | shaded relief |\n|---|---|---|\n",
    );
    for (name, about) in presets {
        let about = about.trim();
        page += &format!(
            "| `{name}`: {about} | ![map of {name}](images/{name}.png) | ![shaded relief of {name}](images/{name}-hillshade.png) |\n"
        );
    }
    shell::write(&shell::root().join("docs/gallery.md"), &page)
}
