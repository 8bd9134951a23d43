//! `cargo xtask clients`: checks of our files by other programs.
//!
//! Each client is a row of a table and, except for the emulator, a script in xtask/clients/. A client that cannot be
//! installed is a failure, not a skip: a check that did not run proves nothing.

mod asan;
mod blender;
pub mod book;
mod engines;
mod gpu;
mod install;
mod neon;
mod passed;
mod presets;
pub mod python;
mod remote;
pub mod studio;
mod wasm;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use crate::failure::{Failure, Result};
use crate::shell::{cargo, program, root, run as sh, target_dir};
use crate::steps::{self, Step};
use crate::web_build;

pub const ABOUT: &str = "install other programs and check that they read our files";

pub const HELP: &str = "
Usage: cargo xtask clients [--all | STEP...]

Builds `orogen` in release mode, installs missing clients and runs every step of the first list, only the steps named, or with
--all those of both lists:

  install   apt (as root on Debian); rustup's wasm32-unknown-unknown
  packages  pip into target/clients/venv, npm into target/clients/node; versions pinned; those of the second list only if chosen
  build     cargo build --release of the command line, of the Python package and of the library for C
  window    clippy and build of the studio's window and of graphics cards
  wasm      the libraries built for WebAssembly, without threads; four presets under node, and a world without files
  remote    builds, caches and elevation models in an object store, moto's: the bytes of local files
  serve     GDAL's drivers for WMTS and XYZ tiles, rasterio, NumPy, xarray, zarr-python, zarrita and a decoder of quantized-mesh read what
            `orogen serve` answers: the samples of exports
  page      Chromium drives the map of `orogen serve` by mouse, keyboard and touch, in both languages: no error, no request to other hosts
  c         a program in C and one in C++ use the library: the samples of an export
  vector    GDAL reads vector tiles: contours at the heights of an export, its lakes and rivers; pmtiles a PMTiles file
  presets   every preset against golden/presets.txt, at every SIMD level of this machine, on one thread or two
  numpy     NumPy reads .npy: the numbers of summary.json, and the orientation
  pillow    Pillow reads the pictures: grey values, the share of sea, animations
  rasterio  rasterio reads GeoTIFFs: samples and coordinates; rio-cogeo validates their layout
  xarray    xarray and zarr-python read Zarr groups: samples and coordinates
  tiles     NumPy and Pillow read tiles: shared edges, one scale; Terrarium heights at the right map positions
  dems      orogen reads heights in every kind that rasterio writes: bit-equal samples, the same coordinates
  meshes    the glTF validator, trimesh, meshio and admesh read GLB, OBJ, PLY, STL and 3MF: samples, orientation, closed solids
  tilemaps  Tiled, PyTMX, ldtkpy and godot_parser read tilemaps: the same tiles, wang sets and pictures
  blocks    nbtlib, anvil-parser2, midvoxio and trimesh read blocks: no cracks in the mesh
  contours  gdal_contour of the same heights gives the same lines; GDAL reads our files
  water     GDAL, SQLite and Shapely read rivers, lakes and watersheds: valid, connected, never rising, at the coordinates of the GeoTIFF
  maps      Poppler and librsvg draw map sheets: they look like the .png
  formats   OpenEXR, GDAL, rasterio, Pillow and Godot read exported heights of every format, not mirrored, rotated or shifted
  relief    gdaldem computes the same hillshade, slope and aspect
  layers    WhiteboxTools and traces along flow directions give the same layers of water
  taplo     taplo validates every recipe against the JSON Schema, and rejects broken ones
  python    the Python package in a new environment: its tests, its types, its generated files
  book      the documentation as a site: every link leads somewhere; the commands and scripts of tutorial, cookbook and engines draw its pictures
  studio    the studio's tests with Mesa's software Vulkan, and its window under Xvfb in both languages: eleven jobs by mouse and keyboard
  gpu       fields, filters, presets and pictures on a graphics card, or Mesa's software Vulkan, beside the processor's; and without any card

Only if named or with --all, because they take long or need large programs:

  wasm-all  every preset under node
  levels    every preset at every SIMD level on one thread and on two
  neon      the tests of every SIMD level, built for ARM, in QEMU: NEON gives the committed bits
  asan      the tests of the SIMD levels under AddressSanitizer: no kernel reads or writes outside its slices
  fuzz      libFuzzer on the readers of foreign files, 60 s each
  luanti    a Luanti server opens worlds of blocks: the same blocks
  grass     GRASS and gdaldem compute the same derived layers: wetness, insolation, viewshed, landforms ...
  azure     builds, caches and elevation models in Azurite's object store: the bytes of local files
  web       the studio as a page in Chromium: its land, changes, both languages, files; exports have the bytes of the command line
  bevy      the example in Bevy without a window, with Mesa's software Vulkan: colliders have the heights of an export, a ball rolls on them
  godot     the library for Godot registers its classes with a stand-in for the engine; gdtoolkit reads the scripts of the example project
  faults    clippy on object stores, and builds, caches and elevation models in a store that fails every few requests
  wheel     the same tests of the Python package as the wheel that maturin makes
  nogil     the tests of arrays and worlds from the wheel of the free-threaded python3.14t, in four threads; needs that Python
  cesium    Cesium in Chromium shows the meshes that `orogen serve` answers: the heights of points
  training  PyTorch trains ten steps of the network of learned detail, and makes the same land from networks as orogen
  blender   Blender imports meshes: size, summit and light are right; needs Python 3.11

xtask/clients/passed.txt says when each of these last passed; a run without them prints those that are older than 14 days.

`install`, `packages` and `build` always run first, the last two side by side. Then `window` to `python` run side by side, one for
each core: each prints when it ends, and what it has printed so far is in target/steps. The others run alone. On systems other
than Debian, or without root, the command prints what to install.
";

/// A program of others, or several programs that one script runs.
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
const XARRAY: &str = "xarray==2026.9.0";
const ZARR: &str = "zarr==3.1.6";
const PILLOW: &str = "pillow==12.2.0";
const BLOCKS: &[&str] =
    &[NUMPY, "anvil-parser2==0.10.6", "nbtlib==2.0.4", "midvoxio==0.1.6", "matplotlib==3.11.2", "trimesh==5.2.0"];
const MOTO: &str = "moto[server]==5.2.5";
/// A font with Chinese letters, by a file that it has.
const CHINESE: (&str, &str) = ("/usr/share/fonts/truetype/wqy/wqy-microhei.ttc", "fonts-wqy-microhei");
const LAYERS: &[&str] = &[NUMPY, RASTERIO, "whitebox-workflows==2.0.6"];

const CLIENTS: &[Client] = &[
    Client { name: "neon", apt: neon::APT, pip: &[], npm: &[] },
    Client { name: "wasm", apt: &[("node", "nodejs")], pip: &[], npm: &[] },
    Client { name: "wasm-all", apt: &[("node", "nodejs")], pip: &[], npm: &[] },
    Client { name: "numpy", apt: &[], pip: &[NUMPY], npm: &[] },
    Client { name: "pillow", apt: &[], pip: &[NUMPY, PILLOW], npm: &[] },
    Client { name: "rasterio", apt: &[], pip: &[NUMPY, RASTERIO, "rio-cogeo==7.0.4"], npm: &[] },
    Client { name: "xarray", apt: &[], pip: &[NUMPY, XARRAY, ZARR], npm: &[] },
    Client { name: "tiles", apt: &[], pip: &[NUMPY, PILLOW], npm: &[] },
    Client {
        name: "dems",
        apt: &[],
        pip: &[NUMPY, RASTERIO, ZARR, "numcodecs==0.16.6", "pyproj==3.7.2", "OpenEXR==3.5.3"],
        npm: &[],
    },
    Client {
        name: "meshes",
        apt: &[("node", "nodejs"), ("npm", "npm"), ("admesh", "admesh")],
        pip: &[NUMPY, PILLOW, "trimesh==5.2.0", "meshio==5.3.5", "networkx==3.6.1", "lxml==6.1.3"],
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
        apt: &[("node", "nodejs"), ("npm", "npm")],
        pip: BLOCKS,
        npm: &["gltf-validator@2.0.0-dev.3.10"],
    },
    Client { name: "luanti", apt: &[("/usr/games/minetestserver", "minetest-server")], pip: BLOCKS, npm: &[] },
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
    Client { name: "layers", apt: &[], pip: LAYERS, npm: &[] },
    Client { name: "grass", apt: &[("gdaldem", "gdal-bin"), ("grass", "grass-core")], pip: LAYERS, npm: &[] },
    Client {
        name: "studio",
        apt: &[
            ("/usr/share/doc/mesa-vulkan-drivers/copyright", "mesa-vulkan-drivers"),
            ("/usr/share/doc/libvulkan1/copyright", "libvulkan1"),
            ("/usr/share/doc/libxkbcommon-x11-0/copyright", "libxkbcommon-x11-0"),
            CHINESE,
            ("Xvfb", "xvfb"),
            ("xdotool", "xdotool"),
            ("xclip", "xclip"),
            ("dbus-daemon", "dbus-daemon"),
            ("/usr/libexec/at-spi-bus-launcher", "at-spi2-core"),
        ],
        pip: &[NUMPY, PILLOW, RASTERIO, "jeepney==0.9.0"],
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
    Client {
        name: "python",
        apt: &[("node", "nodejs"), ("npm", "npm")],
        pip: &[
            NUMPY,
            "xarray==2026.9.0",
            "dask==2026.8.0",
            "distributed==2026.8.0",
            "zarr==3.1.6",
            "matplotlib==3.11.2",
            "nbclient==0.11.0",
            "ipykernel==7.4.0",
            "pytest==9.2.0",
            "hypothesis==6.170.17",
            "mypy==2.4.1",
            "tqdm==4.70.1",
            "fastscapelib==0.3.0",
            "opensimplex==0.4.5.1",
            "perlin-numpy==0.0.1",
            MOTO,
            "obstore==0.12.1",
        ],
        npm: &["pyright@1.1.414"],
    },
    Client { name: "book", apt: &[], pip: &[NUMPY, "matplotlib==3.11.2"], npm: &[] },
    Client { name: "remote", apt: &[], pip: &[NUMPY, RASTERIO, MOTO], npm: &[] },
    Client {
        name: "serve",
        apt: &[("node", "nodejs"), ("npm", "npm")],
        pip: &[
            NUMPY,
            RASTERIO,
            XARRAY,
            ZARR,
            "aiohttp==3.14.5",
            "fsspec==2026.9.0",
            "numcodecs==0.16.6",
            "pyogrio==0.13.0",
        ],
        npm: &["zarrita@0.7.5", "@here/quantized-mesh-decoder@1.2.8"],
    },
    Client {
        name: "page",
        apt: &[("chromium", "chromium"), ("node", "nodejs"), ("npm", "npm"), CHINESE],
        pip: &[NUMPY, PILLOW, RASTERIO, "trimesh==5.2.0"],
        npm: &["playwright-core@1.65.1"],
    },
    Client {
        name: "cesium",
        apt: &[("chromium", "chromium"), ("node", "nodejs"), ("npm", "npm")],
        pip: &[NUMPY, PILLOW],
        npm: &["cesium@1.145.0", "playwright-core@1.65.1"],
    },
    Client { name: "c", apt: &[("gcc", "gcc"), ("g++", "g++")], pip: &[NUMPY], npm: &[] },
    Client {
        name: "vector",
        apt: &[],
        pip: &[NUMPY, PILLOW, "shapely==2.2.0", "pyogrio==0.13.0", "pmtiles==3.8.1"],
        npm: &[],
    },
    Client {
        name: "azure",
        apt: &[("node", "nodejs"), ("npm", "npm")],
        pip: &[NUMPY, RASTERIO, "azure-storage-blob==12.31.1"],
        npm: &["azurite@3.35.0"],
    },
    Client {
        name: "web",
        apt: &[("node", "nodejs"), ("npm", "npm"), ("chromium", "chromium"), CHINESE],
        pip: &[NUMPY, PILLOW],
        npm: &["playwright-core@1.65.1"],
    },
    Client {
        name: "bevy",
        apt: &[
            ("/usr/share/doc/mesa-vulkan-drivers/copyright", "mesa-vulkan-drivers"),
            ("/usr/share/doc/libvulkan1/copyright", "libvulkan1"),
        ],
        pip: &[NUMPY, PILLOW],
        npm: &[],
    },
    Client { name: "godot", apt: &[], pip: &[NUMPY, "gdtoolkit==4.5.0", "godot_parser==0.1.7"], npm: &[] },
    Client { name: "training", apt: &[], pip: &[NUMPY], npm: &[] },
    Client { name: "wheel", apt: &[], pip: &["maturin==1.16.0"], npm: &[] },
    Client { name: "nogil", apt: &[], pip: &["maturin==1.16.0"], npm: &[] },
    Client { name: "taplo", apt: &[("node", "nodejs"), ("npm", "npm")], pip: &[], npm: &["@taplo/cli@0.7.0"] },
];

/// A step that runs alone, because it keeps all cores busy.
const fn alone(name: &'static str, about: &'static str, run: fn() -> Result) -> Step {
    Step { name, about, group: None, run }
}

/// A step that runs in parallel with others that need only built and installed programs.
const fn beside(name: &'static str, about: &'static str, run: fn() -> Result) -> Step {
    Step { name, about, group: Some(2), run }
}

/// The names of the steps of this run.
static CHOSEN: OnceLock<Vec<&'static str>> = OnceLock::new();

/// Whether a step is part of this run.
fn is_chosen(name: &str) -> bool {
    CHOSEN.get().is_some_and(|chosen| chosen.contains(&name))
}

/// Runs first and alone, because system packages may replace the linker.
const INSTALL: Step = alone("install", "the programs of the clients, and the standard libraries of targets", || {
    install::programs(CLIENTS.iter().filter(|client| is_chosen(client.name)))?;
    if is_chosen("neon") {
        neon::install()?;
    }
    wasm::install()
});
/// Waits for downloads most of the time, so programs are built in parallel.
const PACKAGES: Step = Step {
    name: "packages",
    about: "the Python and Node packages of the clients",
    group: Some(1),
    run: || {
        let is_asked = |client: &&Client| !ON_REQUEST.iter().any(|step| step.name == client.name);
        install::packages(CLIENTS.iter().filter(|client| is_asked(client) || is_chosen(client.name)))
    },
};
const BUILD: Step = Step {
    name: "build",
    about: "cargo build --release -p orogen-cli -p orogen-py -p orogen-c, with object stores and the server",
    group: Some(1),
    run: || sh(&mut cargo(&format!("build --quiet --release {}", remote::BUILT))),
};

/// Of the steps that run in parallel, the longest ones come first.
const STEPS: &[&Step] = &[
    &INSTALL,
    &PACKAGES,
    &BUILD,
    &beside("window", "clippy and build of the studio's window and of graphics cards", studio::build),
    &beside("wasm", "four presets made by the libraries built for WebAssembly", wasm::check_four),
    &beside("python", "the Python package in a new environment", python::check),
    &beside("book", "the documentation as a site, and the commands of its pages", book::check),
    &beside("remote", "builds, caches and heights in an object store, moto's", || script("remote")),
    &beside("page", "Chromium drives the map that is served", || script("page")),
    &beside("c", "a program in C reads the samples of an export", || script("c")),
    &beside("vector", "GDAL reads vector tiles, and pmtiles a PMTiles file", || script("vector")),
    &beside("serve", "GDAL, rasterio, NumPy, xarray, zarrita and a decoder of meshes read what is served", || {
        script("serve")
    }),
    &beside("presets", "the presets' golden hashes at every level", presets::check),
    &beside("meshes", "the glTF validator, trimesh, meshio and admesh read meshes", || script("meshes")),
    &beside("water", "GDAL, SQLite and Shapely read rivers, lakes and watersheds", || script("water")),
    &beside("layers", "WhiteboxTools and traces along flow directions give the same layers of water", || {
        script("layers")
    }),
    &beside("maps", "Poppler and librsvg draw map sheets", || script("maps")),
    &beside("numpy", "NumPy reads .npy", || script("numpy")),
    &beside("pillow", "Pillow reads the pictures", || script("pillow")),
    &beside("rasterio", "rasterio and rio-cogeo read GeoTIFFs", || script("rasterio")),
    &beside("xarray", "xarray and zarr-python read Zarr groups", || script("xarray")),
    &beside("tiles", "NumPy and Pillow read tiles", || script("tiles")),
    &beside("dems", "orogen reads what rasterio writes", || script("dems")),
    &beside("tilemaps", "Tiled, PyTMX, ldtkpy and godot_parser read tilemaps", || script("tilemaps")),
    &beside("blocks", "nbtlib, anvil-parser2, midvoxio and trimesh read worlds of blocks", || script("blocks")),
    &beside("contours", "gdal_contour draws the same contours", || script("contours")),
    &beside("formats", "OpenEXR, GDAL, rasterio, Pillow and Godot read exports", || script("formats")),
    &beside("relief", "gdaldem computes the same hillshade, slope and aspect", || script("relief")),
    &beside("taplo", "taplo checks the recipes against the schema", || script("taplo")),
    &alone("studio", "the studio with software Vulkan, and its window under Xvfb", studio::check),
    &alone("gpu", "terrain and pictures on a graphics card, beside the processor's", gpu::check),
];

/// Steps that run only if they are named, or with `--all`. [`passed`] records when they last passed.
const ON_REQUEST: &[&Step] = &[
    &beside("neon", "the tests of every SIMD level on an emulated ARM processor", || noted("neon", neon::check)),
    &beside("asan", "the tests of the SIMD levels under AddressSanitizer", || noted("asan", asan::check)),
    &beside("luanti", "a Luanti server reads worlds of blocks", || noted("luanti", || script_for("luanti", "blocks"))),
    &beside("grass", "GRASS and gdaldem compute the same derived layers", || {
        noted("grass", || script_for("grass", "layers"))
    }),
    &beside("cesium", "Cesium shows the meshes that are served", || noted("cesium", || script("cesium"))),
    &beside("training", "PyTorch trains a network, and makes the same land", || {
        noted("training", || script("training"))
    }),
    &beside("blender", "Blender imports meshes", || noted("blender", blender::check)),
    &beside("azure", "builds, caches and heights in Azurite's object store", || {
        noted("azure", || script_for("azure", "remote"))
    }),
    &alone("web", "the studio as a page, in Chromium", || noted("web", web)),
    &alone("bevy", "the example in Bevy, with software Vulkan", || noted("bevy", engines::check_bevy)),
    &alone("godot", "the library for Godot, and its example project", || noted("godot", engines::check_godot)),
    &alone("faults", "object stores that fail", || noted("faults", remote::check_faults)),
    &alone("wheel", "the Python package as a wheel", || noted("wheel", python::check_wheel)),
    &alone("nogil", "the wheel of the free-threaded Python, in several threads", || {
        noted("nogil", python::check_free_threaded)
    }),
    // These two share their folders with `wasm` and `presets`.
    &alone("wasm-all", "every preset made by the libraries built for WebAssembly", || {
        noted("wasm-all", wasm::check_all)
    }),
    &alone("levels", "the presets' golden hashes at every level and thread count", || {
        noted("levels", presets::check_all)
    }),
    &alone("fuzz", "libFuzzer on the readers of foreign files", || noted("fuzz", || crate::fuzz::run(&[]))),
];

/// Runs a step on request, and records that it passed.
fn noted(name: &str, check: impl Fn() -> Result) -> Result {
    check()?;
    passed::note(name)
}

/// Runs the clients.
pub fn run(args: &[String]) -> Result {
    let is_all = args == ["--all"];
    let mut named = if is_all { Vec::new() } else { args.to_vec() };
    let mut steps = STEPS.to_vec();
    if is_all || !named.is_empty() {
        // Before the steps that run alone, so that all steps that run in parallel are neighbors.
        let at = steps.iter().position(|step| step.name == "studio").unwrap_or(steps.len());
        steps.splice(at..at, ON_REQUEST.iter().copied());
    }
    if !named.is_empty() {
        let needed = [INSTALL.name, PACKAGES.name, BUILD.name];
        named.extend(needed.map(str::to_owned));
    }
    let chosen = steps::choose(&steps, &named)?;
    CHOSEN.get_or_init(|| chosen.iter().map(|step| step.name).collect());
    steps::run("cargo xtask clients", &steps, &named)?;
    if args.is_empty() {
        print_old()?;
    }
    Ok(())
}

/// Prints the steps on request that have not passed for too long.
fn print_old() -> Result {
    let names: Vec<&str> = ON_REQUEST.iter().map(|step| step.name).collect();
    let old = passed::old(&names)?;
    if !old.is_empty() {
        println!("older than {} days (cargo xtask clients --all):\n  {}", passed::MAX_AGE, old.join("\n  "));
    }
    Ok(())
}

/// The folder of the clients: the venv, the Node packages, the files they open.
fn folder() -> PathBuf {
    target_dir().join("clients")
}

/// The binary under test.
fn orogen() -> PathBuf {
    target_dir().join("release").join(format!("orogen{}", std::env::consts::EXE_SUFFIX))
}

/// Installs the standard library for WebAssembly.
pub fn install_wasm() -> Result {
    wasm::install()
}

/// Installs the source of the standard library. Returns whether it is there.
pub fn install_source() -> bool {
    wasm::install_source()
}

/// Builds the studio as a page, and uses it in a browser.
fn web() -> Result {
    if !wasm::install_source() {
        return Err(Failure::new("the source of the standard library is missing: rustup component add rust-src"));
    }
    let page = web_build::build(&folder().join("web"), web_build::Profile::Quick, true)?;
    let work = empty_work("web")?;
    sh(python_script(&install::python(), "web", "web", &work).env("OROGEN_WEB", page))
}

/// Runs a client's script in a new folder.
fn script(name: &str) -> Result {
    script_for(name, name)
}

/// Runs a script for one of several clients. The environment variable `OROGEN_CLIENT` tells the script which client to
/// use.
fn script_for(client: &str, script: &str) -> Result {
    if !CLIENTS.iter().any(|c| c.name == client) {
        return Err(Failure::new(format!("{client} is not in the table of clients: nothing installs it")));
    }
    script_by(&install::python(), client, script)
}

/// [`script_for`] with another Python.
fn script_by(python: &Path, client: &str, script: &str) -> Result {
    // A client's second script leaves the files of the first.
    let name = if client == script { client.to_owned() } else { format!("{client}-{script}") };
    let work = empty_work(&name)?;
    sh(&mut python_script(python, client, script, &work))
}

/// An empty folder for the files of a script.
fn empty_work(name: &str) -> Result<PathBuf> {
    let work = folder().join("work").join(name);
    crate::shell::empty_dir(&work)?;
    Ok(work)
}

/// The command that runs a script for a client in a folder.
fn python_script(python: &Path, client: &str, script: &str, work: &Path) -> Command {
    let mut command = program(python);
    command
        .arg(format!("xtask/clients/check_{script}.py"))
        .env("OROGEN_CLIENT", client)
        .env("OROGEN", orogen())
        .env("OROGEN_ROOT", root())
        .env("OROGEN_WORK", work)
        .env("OROGEN_NODE_BIN", install::node_bin())
        // No .pyc files in the source tree.
        .env("PYTHONDONTWRITEBYTECODE", "1");
    command
}
