//! Heights that are NaN or infinite: in every command that makes heights, there is an error if none is finite, and a
//! warning if some are not.

use crate::commands::{WRITERS, Writer, prepare, workplace};
use crate::harness::Folder;

/// A recipe with the size of `small.toml` whose heights are NaN where a number overflows 32-bit floats: where the noise
/// is high, or everywhere.
fn recipe(everywhere: bool) -> String {
    let large = match everywhere {
        true => "op = \"constant\"\nvalue = 1e5",
        false => "op = \"remap\"\nsource = \"noise\"\nto = [0, 1e5]",
    };
    let mut text = format!(
        "orogen = 1\n[world]\nsize = [640, 480]\ncell = 10\n[nodes.noise]\nop = \"fbm\"\nwavelength = 200\n[nodes.hills]\n\
         op = \"remap\"\nsource = \"noise\"\nto = [0, 200]\n[nodes.large]\n{large}\n"
    );
    // The eighth power of numbers above 63 000 is infinite, and infinity times 0 is NaN.
    for (name, a, b) in
        [("a", "\"large\"", "\"large\""), ("b", "\"a\"", "\"a\""), ("c", "\"b\"", "\"b\""), ("d", "\"c\"", "0")]
    {
        text.push_str(&format!("[nodes.{name}]\nop = \"multiply\"\na = {a}\nb = {b}\n"));
    }
    text + "[nodes.land]\nop = \"add\"\na = \"hills\"\nb = \"d\"\n[outputs]\nheight = \"land\"\n"
}

/// Commands that make heights from a recipe.
fn of_recipes() -> impl Iterator<Item = &'static Writer> {
    WRITERS.iter().filter(|writer| writer.arguments.contains(&"small.toml"))
}

#[test]
fn no_finite_height_is_an_error_of_every_command() {
    for writer in of_recipes() {
        let folder = workplace();
        folder.write("small.toml", recipe(true));
        prepare(&folder, writer);
        let layer = writer.arguments.iter().skip_while(|argument| **argument != "--layer").nth(1).unwrap_or(&"height");
        let expect = format!("the layer `{layer}` has no finite sample: all ");
        folder.bad(&[writer.arguments, &["-q"]].concat(), 2, &expect);
        assert!(writer.files.iter().all(|file| !folder.path(file).exists()), "{:?}", folder.names(""));
    }
}

/// Derived layers can be finite where the heights are not.
#[test]
fn derived_layers_tell_of_the_heights_beneath() {
    let folder = Folder::new();
    for layer in ["slope", "hillshade", "normal", "splat", "occlusion"] {
        folder.write("small.toml", recipe(true));
        folder.bad(&["export", "small.toml", "--layer", layer, "-o", "a.png"], 2, "has no finite sample: all 3072 are");
        assert_eq!(folder.names(""), ["small.toml"], "{layer}");
        folder.write("small.toml", recipe(false));
        let told = folder.good(&["export", "small.toml", "--layer", layer, "-o", "a.png", "-q"]).err;
        assert!(told.contains("warning: ") && told.contains(" of 3072 samples"), "{layer}: {told}");
        for made in folder.names("").iter().filter(|name| *name != "small.toml") {
            std::fs::remove_file(folder.path(made)).unwrap();
        }
    }
}

#[test]
fn some_that_are_not_finite_are_told_by_every_command() {
    for writer in of_recipes() {
        let folder = workplace();
        folder.write("small.toml", recipe(false));
        if ["a.stl", "a.3mf"].iter().any(|name| writer.arguments.contains(name)) {
            folder.bad(writer.arguments, 2, "samples are nodata, and a solid must not have holes");
            continue;
        }
        let outcome = folder.good(&[writer.arguments, &["-q"]].concat());
        let told = outcome.err.contains("warning: ") && outcome.err.contains(" %) are NaN or infinite");
        assert!(told, "{:?}: {}", writer.arguments, outcome.err);
    }
    let folder = Folder::new();
    folder.write("small.toml", recipe(false));
    folder.good(&["generate", "small.toml", "-q"]);
    let summary = folder.json("out/summary.json");
    for key in ["height_min", "height_mean", "height_max", "land_share"] {
        assert!(summary[key].as_f64().is_some_and(|value| (0.0..=200.0).contains(&value)), "{key}: {summary}");
    }
}
