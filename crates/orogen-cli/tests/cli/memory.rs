//! Peak memory of every command compared with `--memory`. The whole process counts; its peak comes from the system.
//!
//! The table covers all formats, derived layers, engines and build forms that the library lists. A command without a
//! row fails the test, so new ones are included automatically. The long test measures 4096 x 4096 samples at three
//! limits:
//!
//!     cargo test -p orogen-cli --test cli memory -- --ignored --nocapture

use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use orogen::export::derived::layer::Nature;
use orogen::export::derived::list as derived;
use orogen::export::registry;
use orogen::export::targets::list as targets;

use crate::harness::Folder;

/// The maximum peak memory as a multiple of the limit.
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "the peak of a process is read from /proc"))]
pub const MOST: f64 = 1.1;

/// Commands that only hold a text or a page of fixed size in memory, and have no `--memory`; and `serve`, which runs
/// until it is interrupted.
const SMALL: [&str; 11] =
    ["cache", "devices", "presets", "new", "ops", "palettes", "schema", "serve", "studio", "completions", "help"];

/// Rough terrain with many contours, rivers and triangles.
fn recipe(side: usize, last: &str) -> String {
    format!(
        "orogen = 1\n[parameters]\nup = 1\n[world]\nseed = 3\nsize = [{0}.0, {0}.0]\ncell = 10.0\n\
         [nodes.noise]\nop = \"fbm\"\nwavelength = 9000\noctaves = 10\n\
         [nodes.land]\nop = \"remap\"\nsource = \"noise\"\nfrom = [-0.5, 0.5]\nto = [-200, 1500]\n{last}",
        side * 10
    )
}

/// All commands that need memory, as arguments to which `--memory` can be appended.
fn rows(side: usize) -> Vec<Vec<String>> {
    let mut rows: Vec<String> = vec![
        "explain land.toml".into(),
        "check land.toml -q".into(),
        "check dem.tif -q".into(),
        "graph land.toml -o graph.svg -q".into(),
        "generate land.toml -o made -q".into(),
        "generate dem.tif -o placed -q".into(),
        "analyze land.toml -q".into(),
        "locate land.toml --where height>1400 --area 1000000 -q".into(),
        "locate dem.tif --find summits -q".into(),
        "analyze dem.tif -o page.png -q".into(),
        "variants land.toml --seeds 2 -q".into(),
        "variants land.toml --seeds 2 --render --size 256 -q".into(),
        "variants land.toml --sweep up=0..1:5 --animate --size 512 -q".into(),
        "render land.toml --size 480x270 --samples 1 -q".into(),
        "grow rising.toml --frames 2 -q".into(),
        "grow rising.toml --frames 2 -o grow.gif -q".into(),
        "fit dem.tif -o fitted.toml --tries 12 --judges 1 -q".into(),
        "refine dem.tif -o fine.tif --cell 5 -q".into(),
        "refine dem.tif -o fine.toml -q".into(),
        format!("tilemap land.toml --size {side} -o tiles -q"),
        format!("noise perlin --size {side} -q"),
        format!("noise perlin --size {side} -o noise.npy -q"),
        format!("noise perlin --size {side} --frames 2 -o frames.png -q"),
        format!("compare --size {} -q", (side / 8).max(120)),
    ];
    rows.extend(["vox", "schem", "glb", "png", "world"].map(|out| {
        let out = if out == "world" { "world".to_string() } else { format!("blocks.{out}") };
        format!("blocks land.toml --size {} -o {out} -q", side / 8)
    }));
    rows.push(format!("blocks land.toml --size {side} -o large.vox -q"));
    rows.push(format!("blocks land.toml --size {side} --format minecraft --exaggeration 0.2 -o save -q"));
    rows.extend(["png", "svg", "pdf"].map(|kind| format!("map land.toml -o map.{kind} -q")));
    rows.push("map land.toml --color surfaces -o ground.png -q".into());
    rows.push("map climate.toml --color biomes -o biomes.png -q".into());
    rows.push("map classes.toml --color classes -o classes.png -q".into());
    rows.push(format!("tilemap classes.toml --size {side} -o tiles -q"));
    rows.push(format!("tilemap trees.toml --size {side} --layout dual -o tiles -q"));
    rows.push("export land.toml --surfaces --max-error 20 -o ground.glb -q".into());
    // Few pixels, but many samples for the lines.
    rows.push("map land.toml --dpi 40 -o small.png -q".into());
    // SRTM has fixed sizes, and .json and .tres hold only objects.
    let formats = registry::all().iter().filter(|format| !matches!(format.name, "hgt" | "json" | "tres"));
    for format in formats {
        rows.push(format!("export land.toml -o out.{} -q", format.name));
        if format.knows("max-error") {
            rows.push(format!("export land.toml -o few.{} --max-error 3 -q", format.name));
        }
    }
    rows.push("export land.toml --size 400 -o cut.3mf --cut 700 -q".into());
    rows.push("export land.toml --size 400 -o engraved.stl --text Land --text-style engraved -q".into());
    rows.push("export land.toml --size 400 -o parts.stl --cut 300 --hollow 1 -q".into());
    rows.push("export land.toml --size 400 -o hollow.stl --hollow 1 --text Land -q".into());
    rows.extend(
        ["csv", "json", "tres", "gpkg"].map(|kind| format!("export trees.toml -o trees.{kind} --layer scatter -q")),
    );
    rows.push("export trees.toml -o trees.glb --objects -q".into());
    rows.push("export land.toml -o weights.png --layer splat --preview -q".into());
    for layer in derived::all() {
        let kind = if layer.nature() == Nature::Numbers { "tif" } else { "png" };
        let needed = if layer.name == "viewshed" { "--observer 3000,2000" } else { "" };
        rows.push(format!("export land.toml -o layer.{kind} --layer {} {needed} -q", layer.name));
    }
    for target in targets::all() {
        let fits = target.sides.iter().filter(|samples| **samples <= side).max();
        let size = fits.map_or(String::new(), |samples| format!("--size {samples}"));
        rows.push(format!("export land.toml --target {} -o engine.{} {size} -q", target.name, target.formats[0]));
    }
    rows.extend(["tif", "zarr", "pmtiles"].map(|kind| format!("build land.toml -o built.{kind} --force -q")));
    let tiles = ["png", "r16", "r32", "terrarium", "terrain-rgb"];
    rows.extend(tiles.map(|tiles| format!("build land.toml -o built-{tiles} --tiles {tiles} --force -q")));
    rows.iter().map(|row| row.split_whitespace().map(String::from).collect()).collect()
}

/// Returns the exit code of a run, its standard error, and its peak memory in bytes.
fn measured(command: Command) -> (i32, String, u64) {
    let watched = watched(command, None);
    (watched.code.unwrap(), watched.said, watched.peak)
}

/// A command that has ended.
pub struct Watched {
    /// The exit code; `None` if a signal ended it.
    pub code: Option<i32>,
    /// The standard error output.
    pub said: String,
    /// The peak memory in bytes.
    pub peak: u64,
    /// The time from the interruption to the end, if it was interrupted.
    pub late: Option<Duration>,
}

/// Runs a command until it ends. It is interrupted once if it takes longer than `patience`.
pub fn watched(mut command: Command, patience: Option<Duration>) -> Watched {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let (status, mut peak) = (format!("/proc/{}/status", child.id()), 0);
    let (begun, mut asked) = (Instant::now(), None);
    let code = loop {
        // The system keeps the peak, so only growth after the last reading is missed.
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let most = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let most = most.and_then(|most| most.trim().trim_end_matches(" kB").parse::<u64>().ok());
        peak = peak.max(most.unwrap_or(0) << 10);
        if let Some(ended) = child.try_wait().unwrap() {
            break ended.code();
        }
        if asked.is_none() && patience.is_some_and(|patience| begun.elapsed() > patience) {
            let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
            assert!(status.success());
            asked = Some(Instant::now());
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let late = asked.map(|asked| asked.elapsed());
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    Watched { code, said, peak, late }
}

#[test]
#[cfg(target_os = "linux")]
fn every_command_keeps_its_memory() {
    measure_every(1536, &[64]);
}

#[test]
#[cfg(target_os = "linux")]
#[ignore = "long: every command at 4096 x 4096 samples under three limits"]
fn every_command_keeps_its_memory_at_large_sizes() {
    measure_every(4096, &[64, 200, 1024]);
}

/// The peak of a process is read from /proc.
#[cfg(target_os = "linux")]
fn measure_every(side: usize, limits: &[u32]) {
    let folder = Folder::new();
    folder.write("land.toml", recipe(side, "[outputs]\nheight = \"land\"\n"));
    let trees = "[outputs]\nheight = \"land\"\n[[scatter]]\nname = \"tree\"\nspacing = 20\nslope = [0, 20]\n";
    folder.write("trees.toml", recipe(side, trees));
    let rising =
        "[nodes.up]\nop = \"stream-power\"\nsource = \"land\"\nyears = 20000\nsteps = 2\n[outputs]\nheight = \"up\"\n";
    folder.write("rising.toml", recipe(side, rising));
    let climate = "[nodes.warm]\nop = \"temperature\"\nsource = \"land\"\n[nodes.rain]\nop = \"orographic-rain\"\nsource = \"land\"\n\
                   [nodes.biome]\nop = \"biome\"\ntemperature = \"warm\"\nrain = \"rain\"\n\
                   [outputs]\nheight = \"land\"\nbiome = \"biome\"\n";
    folder.write("climate.toml", recipe(side, climate));
    let classes = "[outputs]\nheight = \"land\"\n[[class]]\nname = \"grass\"\n[[class]]\nname = \"rock\"\nslope = { min = 30 }\n\
                   [[class]]\nname = \"water\"\nshare = { of = \"height\", lowest = 0.3 }\n";
    folder.write("classes.toml", recipe(side, classes));
    folder.good(&["export", "land.toml", "-o", "dem.tif", "-q"]);
    let mut worst = Vec::new();
    for row in rows(side) {
        let mut line = format!("{:<60}", row.join(" "));
        for limit in limits {
            let _ = std::fs::remove_file(folder.path("fitted.toml"));
            let memory = format!("{limit}MiB");
            let mut arguments: Vec<&str> = row.iter().map(String::as_str).collect();
            arguments.extend(["--memory", &memory]);
            let (code, said, peak) = measured(folder.command(&arguments));
            let share = peak as f64 / f64::from(limit << 20);
            line += &format!(" {:>9.2}{}", share, if code == 0 { ' ' } else { '-' });
            // A request that does not fit is rejected at once, with the required and the allowed memory.
            let refused = code == 1 && said.contains(" is allowed");
            if share > MOST || code != 0 && !refused {
                worst.push(format!("{arguments:?}: {share:.2} times {limit} MiB, exit {code}: {said}"));
            }
        }
        println!("{line}");
    }
    assert!(worst.is_empty(), "{}", worst.join("\n"));
}

/// Memory that the allocator keeps for each thread also counts.
#[test]
#[cfg(target_os = "linux")]
fn bands_of_many_columns_keep_their_memory() {
    let folder = Folder::with_small();
    for size in ["4096", "8192"] {
        let arguments = ["export", "small.toml", "-o", "a.r32", "--size", size, "-q", "--force", "--memory", "64MiB"];
        let (code, said, peak) = measured(folder.command(&arguments));
        assert!(code == 0 && peak as f64 <= MOST * f64::from(64 << 20), "{size}: {code}, {peak} bytes: {said}");
    }
}

/// The heights of the file need 108 MiB.
#[test]
#[cfg(target_os = "linux")]
fn windows_of_a_large_file_keep_their_memory() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "dem.tif", "--size", "6144", "-q"]);
    let cell = "[world]\ncell = 0.1\n[nodes.place]\nop = \"dem\"\npath = \"dem.tif\"\n";
    let wide = "[nodes.wide]\nop = \"blur\"\nsource = \"place\"\nradius = 20\n";
    let outputs = "[outputs]\nheight = \"place\"\nwide = \"wide\"\n";
    folder.write("place.toml", format!("orogen = 1\n{cell}{wide}{outputs}"));
    let window = ["--window", "3000,2500,200,200", "--memory", "64MiB", "-q"];
    for (source, layer, out) in [
        ("place.toml", "height", "a.tif"),
        ("place.toml", "wide", "b.tif"),
        ("place.toml", "slope", "c.tif"),
        ("dem.tif", "height", "d.tif"),
        ("dem.tif", "curvature", "e.tif"),
    ] {
        let arguments = [&["export", source, "--layer", layer, "-o", out][..], &window].concat();
        let (code, said, peak) = measured(folder.command(&arguments));
        assert!(code == 0 && peak < 64 << 20, "{source} {layer}: {code}, {peak} bytes: {said}");
    }
    // Drainage depends on all heights, which are read part by part.
    let drainage = |memory: &str| {
        let arguments = ["export", "dem.tif", "--layer", "drainage-area", "-o", "f.tif", "--memory", memory];
        measured(folder.command(&[&arguments, &window[..2], &["-q", "--force"]].concat()))
    };
    let (code, said, peak) = drainage("64MiB");
    assert!(code == 1 && said.contains(" is allowed") && peak < 64 << 20, "{code}, {peak} bytes: {said}");
    let (code, said, peak) = drainage("128MiB");
    assert!(code == 0 && peak < 128 << 20, "{code}, {peak} bytes: {said}");
}

#[test]
#[cfg(target_os = "linux")]
fn what_is_measured_on_disk_is_what_is_measured_in_memory() {
    let folder = Folder::new();
    folder.write("land.toml", recipe(1536, "[outputs]\nheight = \"land\"\n"));
    let analyze = |memory: &str, page: &str| {
        let arguments = ["analyze", "land.toml", "--json", "-o", page, "--memory", memory];
        let told = folder.good(&arguments).text().to_string();
        (told, folder.read(page))
    };
    let (roomy, short) = (analyze("1GiB", "roomy.png"), analyze("64MiB", "short.png"));
    assert!(roomy.0.contains("\"hack\"") && roomy == short);
    let (code, said, peak) =
        measured(folder.command(&["analyze", "land.toml", "-o", "short.png", "-q", "--memory", "64MiB"]));
    assert!(code == 0 && peak as f64 <= MOST * f64::from(64 << 20), "{peak}: {said}");
}

#[test]
fn no_command_is_forgotten() {
    let folder = Folder::new();
    let help = folder.good(&["--help"]).text().to_string();
    let (_, list) = help.split_once("Commands:\n").unwrap();
    let names = list.lines().take_while(|line| !line.trim().is_empty()).filter_map(|line| {
        let is_name = line.starts_with("  ") && !line.starts_with("   ");
        line.split_whitespace().next().filter(|_| is_name)
    });
    let rows = rows(1024);
    for name in names {
        let is_measured = rows.iter().any(|row| row[0] == name);
        assert!(is_measured != SMALL.contains(&name), "`{name}` is in no row of this table");
    }
}

#[test]
fn a_file_that_unpacks_to_more_than_is_allowed_is_refused() {
    // A picture of 20000 x 20000 pixels in a few hundred kilobytes.
    let folder = Folder::new();
    let mut picture = Vec::new();
    let side = 20_000u32;
    let mut encoder = ::png::Encoder::new(&mut picture, side, side);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::Sixteen);
    encoder.set_compression(::png::Compression::Fastest);
    let mut writer = encoder.write_header().unwrap();
    let mut rows = writer.stream_writer().unwrap();
    let row = vec![7u8; 2 * side as usize];
    (0..side).for_each(|_| std::io::Write::write_all(&mut rows, &row).unwrap());
    rows.finish().unwrap();
    drop(writer);
    assert!(picture.len() < 8 << 20, "{}", picture.len());
    folder.write("bomb.png", picture);
    folder.write("bomb.png.json", "{\"cell\": 1, \"low\": 0, \"high\": 9}");
    for command in [
        &["explain", "bomb.png"][..],
        &["generate", "bomb.png", "-o", "x"],
        &["export", "bomb.png", "-o", "x.npy"],
        &["map", "bomb.png", "-o", "x.png"],
        &["render", "bomb.png"],
        &["analyze", "bomb.png"],
        &["fit", "bomb.png", "-o", "x.toml"],
        &["refine", "bomb.png", "-o", "x.tif"],
        &["build", "bomb.png", "-o", "x.tif"],
    ] {
        let (code, said, peak) = measured(folder.command(&[command, &["--memory", "256MiB"]].concat()));
        assert!(code == 1 && said.contains("need 1.5 GiB"), "{command:?}: {said}");
        assert!(peak < 64 << 20, "{command:?}: {peak}");
    }
    assert_eq!(folder.names(""), ["bomb.png", "bomb.png.json"]);
}

#[test]
#[cfg(target_os = "linux")]
fn what_does_not_fit_is_refused_before_it_takes_memory() {
    let folder = Folder::with_small();
    let endless = |cell: &str| format!("export endless --window 0,0,32,32 --cell {cell} -o a.tif");
    let level =
        "samples of the coarsest level of node `land`, which has a cell of 122880 m; use a cell of at most 503316480 m";
    let small = folder.text("small.toml");
    let dense =
        "[[scatter]]\nname = \"tree\"\nspacing = 0.5\n[[scatter]]\nname = \"rock\"\nspacing = 0.5\nclearance = 1e6\n";
    folder.write("dense.toml", small.clone() + dense);
    folder.write("sparse.toml", small + &dense.replace("name = \"tree\"", "name = \"tree\"\ndensity = 0"));
    for (arguments, code, expect) in [
        (endless("3e10"), 2, level),
        (endless("1e12"), 2, level),
        (
            endless("1e300"),
            2,
            "invalid value '1e300' for '--cell <M>': the cell size must be 0.000001 to 1000000000000 m",
        ),
        (endless("1e-300"), 2, "for '--cell <M>': the cell size must be 0.000001 to"),
        ("export endless --window 0m,0m,1000000000km,1000000000km --size 32 -o a.tif".into(), 2, level),
        (
            "export endless --window 0m,0m,1000000000km,1000000000km -o a.tif".into(),
            2,
            "it may have 2147483648 along a side; use a smaller window or a larger cell",
        ),
        ("export dense.toml --layer scatter -o a.csv".into(), 1, "of memory, and 64 MiB is allowed"),
    ] {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        let (ended, said, peak) = measured(folder.command(&[&arguments[..], &["-q", "--memory", "64MiB"]].concat()));
        assert!(ended == code && said.contains(expect), "{arguments:?}: {ended} {said}");
        assert!(peak < 70 << 20, "{arguments:?}: {peak}");
    }
    // The distance reaches far beyond the world, where there are no objects to keep away from.
    let sparse = ["export", "sparse.toml", "--layer", "scatter", "-o", "a.csv", "-q"];
    let (ended, said, peak) = measured(folder.command(&sparse));
    assert!(ended == 0 && peak < 400 << 20, "{said}: {peak}");
}

#[test]
#[cfg(unix)]
fn what_may_never_end_is_refused() {
    let folder = Folder::with_small();
    assert!(Command::new("mkfifo").arg(folder.path("pipe.tif")).status().unwrap().success());
    assert!(Command::new("mkfifo").arg(folder.path("pipe.toml")).status().unwrap().success());
    for (arguments, expect) in [
        (
            &["map", "small.toml", "-o", "a.png", "--palette", "/dev/urandom"][..],
            "/dev/urandom: it is a pipe or a device",
        ),
        (&["map", "small.toml", "-o", "a.png", "--palette", "pipe.toml"], "pipe.toml: it is a pipe or a device"),
        (&["palettes", "/dev/zero"], "/dev/zero: it is a pipe or a device"),
        (&["generate", "pipe.tif"], "pipe.tif: it is a pipe or a device"),
        (&["generate", "pipe.toml"], "pipe.toml: it is a pipe or a device"),
        (&["explain", "/dev/zero"], "/dev/zero: it is a pipe or a device"),
        (&["fit", "pipe.tif", "-o", "a.toml"], "pipe.tif: it is a pipe or a device"),
        (&["refine", "pipe.tif", "-o", "a.tif"], "pipe.tif: it is a pipe or a device"),
    ] {
        folder.bad(arguments, 1, expect);
    }
    folder.write("reads.toml", "orogen = 1\n[nodes.a]\nop = \"dem\"\npath = \"pipe.tif\"\n[outputs]\nheight = \"a\"\n");
    folder.bad(&["export", "reads.toml", "-o", "a.npy"], 1, "pipe.tif: it is a pipe or a device");
    // The file that a shell passes for <(command) is read.
    let script = format!("{} explain /dev/fd/3 3< <(cat small.toml)", env!("CARGO_BIN_EXE_orogen"));
    let ended = Command::new("bash").arg("-c").arg(script).current_dir(&folder.0).output().unwrap();
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
}

#[test]
fn many_threads_are_no_more_than_there_is_work_for() {
    let folder = Folder::with_small();
    let made = |threads: &str| {
        folder.good(&["export", "small.toml", "-o", "a.npy", "-q", "--threads", threads]);
        folder.read("a.npy")
    };
    assert!(made("1") == made("1000"));
    if cfg!(target_os = "linux") {
        // A thousand thread stacks would take more.
        let (code, said, peak) =
            measured(folder.command(&["export", "small.toml", "-o", "a.npy", "--threads", "1000"]));
        assert!(code == 0 && peak < 24 << 20, "{peak}: {said}");
    }
}

/// The memory that a refusal names suffices, and one step less does not.
#[test]
fn what_a_refusal_names_is_enough() {
    let folder = Folder::with_solutions();
    for line in [
        "export alpine --size 1500 -o a.npy",
        "export hills --layer albedo --size 1024 -o a.npy",
        "export hills --layer slope --size 1024 -o a.tif",
        "export island --size 512 --layer rivers -o a.geojson",
        "build hills --cell 40 -o b.tif",
        "generate hills --size 512 -o made",
        "map hills --size 400 -o a.png",
        "render hills --size 128x64 --samples 1 -o view.png",
        "tilemap hills --size 128 -o tiles",
        "analyze hills --size 512",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let run = |memory: &str| folder.run(&[&words[..], &["-q", "--memory", memory]].concat());
        let refused = run("18MiB");
        let named = refused.err.split("needs up to ").nth(1).and_then(|rest| rest.split(" of memory").next());
        let named = named.unwrap_or_else(|| panic!("{line}: {}", refused.err)).replace(' ', "");
        let mib: u64 = named.strip_suffix("MiB").unwrap_or_else(|| panic!("{line}: {named}")).parse().unwrap();
        assert_eq!(run(&format!("{}MiB", mib - 1)).code, 1, "{line}: less than {named} is enough");
        let enough = run(&named);
        assert_eq!(enough.code, 0, "{line}: {named}: {}", enough.err);
    }
}
