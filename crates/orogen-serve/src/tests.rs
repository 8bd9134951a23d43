//! Tests of the whole server, over loopback.

mod abuse;
mod bad_requests;
mod client;
mod descriptions;
mod meshes;
mod page;
mod recipes;
mod samples;
mod site;
mod variants;
mod vector;
mod vector_reader;
mod work;
mod zarr;

/// A bounded world without a CRS.
const HILLS: &str = r#"
orogen = 1
about = "Hills & <valleys>"
[world]
size = [5120, 2560]
cell = 10
sea_level = 20
[nodes.noise]
op = "fbm"
wavelength = 900
[nodes.land]
op = "remap"
source = "noise"
to = [0, 300]
[outputs]
height = "land"
"#;

/// An unbounded world.
const PLAIN: &str = r#"
orogen = 1
[world]
cell = 10
[nodes.noise]
op = "fbm"
wavelength = 900
[outputs]
height = "noise"
"#;

/// The head of a world at a place.
fn placed(crs: &str, origin: [f64; 2]) -> String {
    HILLS.replace("cell = 10", &format!("cell = 10\ncrs = \"{crs}\"\norigin = [{}, {}]", origin[0], origin[1]))
}

/// [`HILLS`] with rivers, lakes and trees.
fn watered() -> String {
    HILLS.replace(
        "[outputs]\nheight = \"land\"",
        "[nodes.terrain]\nop = \"lakes\"\nsource = \"land\"\nsmallest = 4000\n[nodes.rivers]\nop = \"drainage\"\n\
         source = \"terrain.surface\"\nstream = 40000\n[outputs]\nheight = \"terrain\"\nlakes = \"terrain.lake\"\n\
         flow = \"rivers.flow\"\n[[scatter]]\nname = \"tree\"\nspacing = 40",
    )
}
