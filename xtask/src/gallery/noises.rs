//! The gallery at the top of the documentation of orogen-noise.

use std::path::Path;

use super::base64::base64;
use crate::failure::{Result, on_file};
use crate::shell;

/// The captions of the pictures and the arguments of `orogen noise` that make them, row by row.
const PICTURES: [(&str, &str); 16] = [
    ("White", "white --wavelength 4"),
    ("Value", "value --wavelength 32"),
    ("Perlin", "perlin --wavelength 32"),
    ("Simplex", "simplex --wavelength 44"),
    ("OpenSimplex2, smooth", "opensimplex2-smooth --wavelength 44"),
    ("Worley, F1", "worley --wavelength 32"),
    ("Worley, edge", "worley-edge --wavelength 32"),
    ("Fbm", "perlin --fractal fbm --octaves 6 --wavelength 64"),
    ("Ridged", "perlin --fractal ridged --octaves 6 --wavelength 64"),
    ("Billow", "perlin --fractal billow --octaves 6 --wavelength 64"),
    ("Weighted", "perlin --fractal weighted --octaves 6 --wavelength 64"),
    ("PingPong", "perlin --fractal ping-pong --strength 4 --octaves 6 --wavelength 100"),
    ("Hybrid", "perlin --fractal hybrid --octaves 6 --wavelength 64 --gain 0.8"),
    ("Hetero", "perlin --fractal hetero --octaves 6 --wavelength 64"),
    ("Swiss", "perlin --fractal swiss --octaves 6 --wavelength 64"),
    ("Jordan", "perlin --fractal jordan --octaves 6 --wavelength 64"),
];

const COLUMNS: usize = 4;

/// Writes crates/orogen-noise/docs/gallery.md; `work` is for temporary files.
pub fn write(work: &Path) -> Result {
    let file = work.join("noise.png");
    let mut text = String::from("<!-- Written by `cargo xtask gallery`. Do not edit. -->\n<table>\n");
    for row in PICTURES.chunks(COLUMNS) {
        text.push_str("<tr>\n");
        for (name, arguments) in row {
            let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- noise");
            orogen.args(arguments.split_whitespace()).args(["--size", "128", "--seed", "4", "--quiet", "-o"]);
            shell::run(orogen.arg(&file))?;
            let bytes = std::fs::read(&file).map_err(|e| on_file("read", &file, &e))?;
            let source = format!("data:image/png;base64,{}", base64(&bytes));
            text.push_str(&format!(
                "<td><img width=\"128\" height=\"128\" alt=\"{name}\" title=\"orogen noise {arguments}\" src=\"{source}\"><br>{name}</td>\n"
            ));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</table>\n");
    let to = shell::root().join("crates/orogen-noise/docs/gallery.md");
    shell::write(&to, &text)?;
    println!("{}", shell::relative(&to));
    Ok(())
}
