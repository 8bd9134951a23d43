//! `cargo xtask clients`: checks of our files by other programs.
//!
//! Each client is a row of a table and, except for the emulator, a script in xtask/clients/. A client that cannot be installed is a failure, not
//! a skip: a check that did not run proves nothing.

mod asan;
mod blender;
mod gpu;
mod install;
mod neon;
mod presets;
mod studio;
mod wasm;

use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result};
use crate::shell::{cargo, program, root, run as sh, target_dir};
use crate::steps::{self, Step};

pub const ABOUT: &str = "install other programs and check that they read our files";

pub const HELP: &str = "
Usage: cargo xtask clients [STEP...]

Builds `orogen` in release mode, installs missing clients and runs every step, or only the steps named:

  build     cargo build --release -p orogen-cli
  install   apt (as root on Debian), pip into target/clients/venv, npm into target/clients/node; versions pinned; rustup's
            aarch64-unknown-linux-gnu and wasm32-unknown-unknown
  neon      the tests of every SIMD level, built for ARM, in QEMU: NEON gives the committed bits
  presets   every preset against golden/presets.txt, on one thread and two, at every SIMD level of this machine
  wasm      the libraries built for WebAssembly, without threads; every preset under node
  asan      the tests of the SIMD levels under AddressSanitizer: no kernel reads or writes outside its slices
  numpy     NumPy reads .npy: the numbers of summary.json, and the orientation
  pillow    Pillow reads the pictures: grey values, the share of sea, animations
  rasterio  rasterio reads GeoTIFFs: samples and coordinates; rio-cogeo validates their layout
  xarray    xarray and zarr-python read Zarr groups: samples and coordinates
  tiles     NumPy and Pillow read tiles: shared edges, one scale; Terrarium heights at the right map positions
  dems      orogen reads heights in every kind that rasterio writes: bit-equal samples, the same coordinates
  meshes    the glTF validator, trimesh, meshio and admesh read GLB, OBJ, PLY and STL: samples, orientation, closed solids
  tilemaps  Tiled, PyTMX, ldtkpy and godot_parser read tilemaps: the same tiles, wang sets and pictures
  blocks    nbtlib, midvoxio and trimesh read blocks, and a Luanti server opens them: the same blocks, no cracks in the mesh
  contours  gdal_contour of the same heights gives the same lines; GDAL reads our files
  water     GDAL, SQLite and Shapely read rivers, lakes and watersheds: valid, connected, never rising, at the coordinates of the GeoTIFF
  maps      Poppler and librsvg draw map sheets: they look like the .png
  formats   OpenEXR, GDAL, rasterio, Pillow and Godot read exported heights of every format, not mirrored, rotated or shifted
  relief    gdaldem computes the same hillshade, slope and aspect
  layers    GRASS, WhiteboxTools and gdaldem compute the same derived layers: wetness, HAND, insolation, viewshed, landforms ...
  studio    the studio's tests with Mesa's software Vulkan, and its window under Xvfb in both languages
  gpu       fields, filters, presets and pictures on a graphics card, or Mesa's software Vulkan, beside the processor's; and without any card
  fuzz      libFuzzer on the readers of foreign files, 15 s each
  taplo     taplo validates every recipe against the JSON Schema, and rejects broken ones

Only if named, because Blender is large and needs Python 3.11:

  blender   Blender imports meshes: size, summit and light are right

`build` and `install` always run first. On systems other than Debian, or without root, the command prints what to install.
";

/// A foreign program, or several that one script runs.
struct Client {
    /// The name of the step, and of its script in xtask/clients/.
    name: &'static str,
    /// Debian packages, each with a program (or, as an absolute path, a file) that it installs.
    apt: &'static [(&'static str, &'static str)],
    /// Python packages, pinned.
    pip: &'static [&'static str],
    /// Node packages, pinned.
    npm: &'static [&'static str],
}

const NUMPY: &str = "numpy==2.4.6";
const RASTERIO: &str = "rasterio==1.4.4";
const PILLOW: &str = "pillow==12.2.0";

const CLIENTS: &[Client] = &[
    Client { name: "neon", apt: neon::APT, pip: &[], npm: &[] },
    Client { name: "wasm", apt: &[("node", "nodejs")], pip: &[], npm: &[] },
    Client { name: "numpy", apt: &[], pip: &[NUMPY], npm: &[] },
    Client { name: "pillow", apt: &[], pip: &[NUMPY, PILLOW], npm: &[] },
    Client { name: "rasterio", apt: &[], pip: &[NUMPY, RASTERIO, "rio-cogeo==7.0.4"], npm: &[] },
    Client { name: "xarray", apt: &[], pip: &[NUMPY, "xarray==2026.9.0", "zarr==3.1.6"], npm: &[] },
    Client { name: "tiles", apt: &[], pip: &[NUMPY, PILLOW], npm: &[] },
    Client {
        name: "dems",
        apt: &[],
        pip: &[NUMPY, RASTERIO, "zarr==3.1.6", "numcodecs==0.16.6", "pyproj==3.7.2", "OpenEXR==3.5.3"],
        npm: &[],
    },
    Client {
        name: "meshes",
        apt: &[("node", "nodejs"), ("npm", "npm"), ("admesh", "admesh")],
        pip: &[NUMPY, PILLOW, "trimesh==5.2.0", "meshio==5.3.5"],
        npm: &["gltf-validator@2.0.0-dev.3.10"],
    },
    Client {
        name: "tilemaps",
        apt: &[("tiled", "tiled"), ("tmxrasterizer", "tiled")],
        pip: &[NUMPY, PILLOW, "pytmx==3.32", "ldtkpy==1.4.1", "godot_parser==0.1.7"],
        npm: &[],
    },
    Client {
        name: "blocks",
        apt: &[("node", "nodejs"), ("npm", "npm"), ("/usr/games/minetestserver", "minetest-server")],
        pip: &[NUMPY, "nbtlib==2.0.4", "midvoxio==0.1.6", "matplotlib==3.11.2", "trimesh==5.2.0"],
        npm: &["gltf-validator@2.0.0-dev.3.10"],
    },
    Client { name: "contours", apt: &[("gdal_contour", "gdal-bin")], pip: &[NUMPY], npm: &[] },
    Client {
        name: "water",
        apt: &[("ogrinfo", "gdal-bin")],
        pip: &[NUMPY, RASTERIO, "shapely==2.2.0", "pyogrio==0.13.0"],
        npm: &[],
    },
    Client {
        name: "maps",
        apt: &[("pdftoppm", "poppler-utils"), ("rsvg-convert", "librsvg2-bin")],
        pip: &[NUMPY, PILLOW],
        npm: &[],
    },
    Client {
        name: "formats",
        apt: &[("gdalinfo", "gdal-bin"), ("godot3-server", "godot3-server")],
        pip: &[NUMPY, PILLOW, RASTERIO, "OpenEXR==3.5.3"],
        npm: &[],
    },
    Client { name: "relief", apt: &[("gdaldem", "gdal-bin")], pip: &[NUMPY, RASTERIO], npm: &[] },
    Client {
        name: "layers",
        apt: &[("gdaldem", "gdal-bin"), ("grass", "grass-core")],
        pip: &[NUMPY, RASTERIO, "whitebox-workflows==2.0.6"],
        npm: &[],
    },
    Client {
        name: "studio",
        apt: &[
            ("/usr/share/doc/mesa-vulkan-drivers/copyright", "mesa-vulkan-drivers"),
            ("/usr/share/doc/libvulkan1/copyright", "libvulkan1"),
            ("/usr/share/doc/libxkbcommon-x11-0/copyright", "libxkbcommon-x11-0"),
            ("/usr/share/fonts/truetype/wqy/wqy-microhei.ttc", "fonts-wqy-microhei"),
            ("Xvfb", "xvfb"),
        ],
        pip: &[NUMPY, PILLOW],
        npm: &[],
    },
    Client {
        name: "gpu",
        apt: &[
            ("/usr/share/doc/mesa-vulkan-drivers/copyright", "mesa-vulkan-drivers"),
            ("/usr/share/doc/libvulkan1/copyright", "libvulkan1"),
        ],
        pip: &[NUMPY, PILLOW],
        npm: &[],
    },
    Client { name: "fuzz", apt: &[("g++", "g++")], pip: &[], npm: &[] },
    Client { name: "taplo", apt: &[("node", "nodejs"), ("npm", "npm")], pip: &[], npm: &["@taplo/cli@0.7.0"] },
];

const BUILD: Step = Step {
    name: "build",
    about: "cargo build --release -p orogen-cli",
    run: || sh(&mut cargo("build --quiet --release --package orogen-cli")),
};
const INSTALL: Step = Step {
    name: "install",
    about: "the programs and packages of the clients",
    run: || {
        install::all(CLIENTS)?;
        neon::install()?;
        wasm::install()
    },
};

const STEPS: &[&Step] = &[
    &BUILD,
    &INSTALL,
    &Step { name: "presets", about: "the presets' golden hashes at every level and thread count", run: presets::check },
    &Step { name: "neon", about: "the tests of every SIMD level on an emulated ARM processor", run: neon::check },
    &Step { name: "wasm", about: "every preset made by the libraries built for WebAssembly", run: wasm::check },
    &Step { name: "asan", about: "the tests of the SIMD levels under AddressSanitizer", run: asan::check },
    &Step { name: "numpy", about: "NumPy reads .npy", run: || script("numpy") },
    &Step { name: "pillow", about: "Pillow reads the pictures", run: || script("pillow") },
    &Step { name: "rasterio", about: "rasterio and rio-cogeo read GeoTIFFs", run: || script("rasterio") },
    &Step { name: "xarray", about: "xarray and zarr-python read Zarr groups", run: || script("xarray") },
    &Step { name: "tiles", about: "NumPy and Pillow read tiles", run: || script("tiles") },
    &Step { name: "dems", about: "orogen reads what rasterio writes", run: || script("dems") },
    &Step {
        name: "meshes",
        about: "the glTF validator, trimesh, meshio and admesh read meshes",
        run: || script("meshes"),
    },
    &Step {
        name: "tilemaps",
        about: "Tiled, PyTMX, ldtkpy and godot_parser read tilemaps",
        run: || script("tilemaps"),
    },
    &Step {
        name: "blocks",
        about: "nbtlib, midvoxio, trimesh and a Luanti server read worlds of blocks",
        run: || script("blocks"),
    },
    &Step { name: "contours", about: "gdal_contour draws the same contours", run: || script("contours") },
    &Step {
        name: "water",
        about: "GDAL, SQLite and Shapely read rivers, lakes and watersheds",
        run: || script("water"),
    },
    &Step { name: "maps", about: "Poppler and librsvg draw map sheets", run: || script("maps") },
    &Step {
        name: "formats",
        about: "OpenEXR, GDAL, rasterio, Pillow and Godot read exports",
        run: || script("formats"),
    },
    &Step { name: "relief", about: "gdaldem computes the same hillshade, slope and aspect", run: || script("relief") },
    &Step {
        name: "layers",
        about: "GRASS, WhiteboxTools and gdaldem compute the same derived layers",
        run: || script("layers"),
    },
    &Step { name: "studio", about: "the studio with software Vulkan, and its window under Xvfb", run: studio::check },
    &Step { name: "gpu", about: "terrain and pictures on a graphics card, beside the processor's", run: gpu::check },
    &Step { name: "fuzz", about: "libFuzzer on the readers of foreign files", run: fuzz },
    &Step { name: "taplo", about: "taplo checks the recipes against the schema", run: || script("taplo") },
];

/// Steps that run only if they are named.
const ASKED: &[&Step] = &[&Step { name: "blender", about: "Blender imports meshes", run: blender::check }];

/// A short run, which covers inputs close to the committed files; `cargo xtask fuzz` runs longer.
fn fuzz() -> Result {
    crate::fuzz::run(&["--seconds", "15"].map(str::to_owned))
}

/// Runs the clients.
pub fn run(args: &[String]) -> Result {
    let mut named = args.to_vec();
    let mut steps = STEPS.to_vec();
    if !named.is_empty() {
        steps.extend(ASKED);
        named.extend([BUILD.name.to_owned(), INSTALL.name.to_owned()]);
    }
    steps::run("cargo xtask clients", &steps, &named)
}

/// The folder of the clients: the venv, the Node packages, the files they open.
fn folder() -> PathBuf {
    target_dir().join("clients")
}

/// The binary under test.
fn orogen() -> PathBuf {
    target_dir().join("release").join(format!("orogen{}", std::env::consts::EXE_SUFFIX))
}

/// Runs a client's script in a new folder.
fn script(name: &str) -> Result {
    if !CLIENTS.iter().any(|c| c.name == name) {
        return Err(Failure::new(format!("{name} is not in the table of clients: nothing installs it")));
    }
    script_by(&install::python(), name)
}

/// The same with another Python.
fn script_by(python: &Path, name: &str) -> Result {
    let work = folder().join("work").join(name);
    crate::shell::empty_dir(&work)?;
    let mut command = program(python);
    command
        .arg(format!("xtask/clients/check_{name}.py"))
        .env("OROGEN", orogen())
        .env("OROGEN_ROOT", root())
        .env("OROGEN_WORK", &work)
        .env("OROGEN_NODE_BIN", install::node_bin())
        // No .pyc files in the source tree.
        .env("PYTHONDONTWRITEBYTECODE", "1");
    sh(&mut command)
}
