//! `orogen export`.

use crate::harness::{Folder, Outcome, SMALL, npy, png};
use std::io::Read;
use std::process::Stdio;

#[test]
fn a_window_is_the_crop_of_the_whole() {
    let folder = Folder::with_small();
    let outcome = folder.good(&["export", "small.toml", "-o", "all.npy"]);
    assert!(outcome.text().starts_with("all.npy: height, 64 x 48 samples of 10 m, "), "{}", outcome.text());
    folder.good(&["export", "small.toml", "-o", "part.npy", "--window", "10,20,30,15", "-q"]);
    let (all, part) = (npy(&folder.read("all.npy")), npy(&folder.read("part.npy")));
    assert_eq!((part.width(), part.height()), (30, 15));
    assert!((0..15).all(|j| (0..30).all(|i| part[(i, j)] == all[(i + 10, j + 20)])));
    assert_eq!(folder.names(""), ["all.npy", "part.npy", "small.toml"]);
}

#[test]
fn a_file_of_heights_is_a_recipe() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "a.tif", "-q"]);
    folder.good(&["export", "a.tif", "-o", "b.npy", "-q"]);
    folder.good(&["export", "small.toml", "-o", "c.npy", "-q"]);
    assert!(folder.read("b.npy") == folder.read("c.npy"));
    // A node of another recipe: the path is relative to the recipe's folder, not to the working directory.
    let text = "orogen = 1\n[world]\nsize = 200\ncell = 10\n[nodes.a]\nop = \"dem\"\npath = \"../a.tif\"\nat = [-100, -50]\n\
                [outputs]\nheight = \"a\"\n";
    std::fs::create_dir(folder.path("sub")).unwrap();
    std::fs::write(folder.path("sub/place.toml"), text).unwrap();
    folder.good(&["export", "sub/place.toml", "-o", "d.npy", "-q"]);
    let (all, part) = (npy(&folder.read("c.npy")), npy(&folder.read("d.npy")));
    assert!((0..20).all(|j| (0..20).all(|i| part[(i, j)] == all[(i + 10, j + 5)])));
    std::fs::write(folder.path("cut.tif"), &folder.read("a.tif")[..900]).unwrap();
    folder.bad(&["generate", "cut.tif"], 1, "cannot read cut.tif: it ends within its");
    folder.bad(&["generate", "a.tif", "--watch"], 2, "a.tif is a file of heights");
    folder.bad(&["generate", "gone.tif"], 1, "cannot read gone.tif: no such file");
    // A height picture with its summary file.
    folder.good(&["generate", "small.toml", "-o", "made", "-q"]);
    let told = folder.good(&["export", "made/height.png", "-o", "e.npy"]).text().to_string();
    assert!(told.contains("64 x 48 samples of 10 m"), "{told}");
}

#[test]
fn a_window_of_a_file_of_heights_reads_its_blocks_alone() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "a.tif", "--cell", "0.5", "-q"]);
    let asked = |file: &str, out: &str, layer: &str| {
        folder.good(&["export", file, "-o", out, "--layer", layer, "--window", "300,200,40,30", "-q"]);
        npy(&folder.read(out))
    };
    folder.good(&["export", "a.tif", "-o", "all.npy", "-q"]);
    let (all, part) = (npy(&folder.read("all.npy")), asked("a.tif", "part.npy", "height"));
    assert_eq!((part.width(), part.height()), (40, 30));
    assert!((0..30).all(|j| (0..40).all(|i| part[(i, j)] == all[(i + 300, j + 200)])));
    // Layers that read their surroundings, and layers of the whole drainage area, for which the rest of the file is
    // read.
    for layer in ["slope", "filled"] {
        folder.good(&["export", "a.tif", "-o", "all.npy", "--layer", layer, "-q"]);
        let (all, part) = (npy(&folder.read("all.npy")), asked("a.tif", "part.npy", layer));
        assert!((0..30).all(|j| (0..40).all(|i| part[(i, j)] == all[(i + 300, j + 200)])), "{layer}");
    }
    // The last blocks of the file are those of its south-east. Without them the window is the same.
    let bytes = folder.read("a.tif");
    folder.write("cut.tif", &bytes[..bytes.len() - 20_000]);
    assert_eq!(asked("cut.tif", "cut.npy", "height").data(), asked("a.tif", "part.npy", "height").data());
    folder.bad(&["export", "cut.tif", "-o", "all.npy", "-q"], 1, "cannot read cut.tif: it ends within its samples");
    folder.bad(
        &["export", "cut.tif", "-o", "b.npy", "--layer", "filled", "--window", "300,200,40,30"],
        1,
        "it ends within",
    );
    folder.bad(&["export", "cut.tif", "-o", "b.npy", "--window", "30000,0,5,5"], 2, "is not inside the world");
    // Output that was written to a stream cannot be started again.
    let streamed = folder.run(&["export", "a.tif", "-o", "-", "--format", "npy", "--window", "300,200,40,30"]);
    assert_eq!(npy(&streamed.out).data(), asked("a.tif", "part.npy", "height").data());
}

#[test]
fn what_does_not_fit_in_memory_is_written_as_it_is_made() {
    let folder = Folder::with_small();
    // 3200 x 2400 samples are 29 MiB.
    let asked = ["export", "small.toml", "--cell", "0.2", "--threads", "1", "-q"];
    folder.good(&[&asked[..], &["-o", "a.npy"]].concat());
    folder.good(&[&asked[..], &["-o", "b.npy", "--memory", "26MiB"]].concat());
    assert!(folder.read("a.npy") == folder.read("b.npy"));
    folder.bad(&[&asked[..], &["-o", "c.npy", "--memory", "1kB"]].concat(), 1, "of memory, and 1000 bytes is allowed");
    let streamed = folder.run(&[&asked[..], &["-o", "-", "--memory", "26MiB"]].concat());
    assert!(streamed.out == folder.read("a.npy"));
    assert_eq!(folder.names(""), ["a.npy", "b.npy", "small.toml"]);
}

#[test]
fn a_picture_spans_its_own_range() {
    let folder = Folder::with_small();
    let outcome = folder.good(&["export", "small.toml", "-o", "a.PNG", "--layer", "noise"]);
    assert!(outcome.text().contains("0 is -") && outcome.text().contains("65535 is 0."), "{}", outcome.text());
    let levels = png(&folder.read("a.PNG")).grey16();
    assert_eq!((levels.iter().min(), levels.iter().max()), (Some(&0), Some(&65535)));
}

#[test]
fn a_geotiff_is_the_same_on_any_number_of_threads() {
    let folder = Folder::with_small();
    let outcome = folder.good(&["export", "small.toml", "-o", "a.tif", "--cell", "1", "--threads", "1"]);
    assert!(outcome.text().starts_with("a.tif: height, 640 x 480 samples of 1 m, "), "{}", outcome.text());
    folder.good(&["export", "small.toml", "-o", "b.TIFF", "--cell", "1", "--threads", "3", "-q"]);
    let bytes = folder.read("a.tif");
    assert!(bytes.starts_with(b"II\x2a\0") && bytes == folder.read("b.TIFF"));
    assert_eq!(folder.names(""), ["a.tif", "b.TIFF", "small.toml"]);
}

/// The greatest difference between two exported arrays.
fn off(folder: &Folder, a: &str, b: &str) -> f32 {
    let (a, b) = (npy(&folder.read(a)), npy(&folder.read(b)));
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    a.data().iter().zip(b.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn formats_with_a_sidecar_come_back_as_heights() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "all.npy", "-q"]);
    // 250 m over 65535 or 255 levels: the error is at most half a level plus f32 rounding.
    for (file, options, most) in [
        ("a.asc", &[][..], 0.0),
        ("b.r32", &[], 0.0),
        ("c.r32", &["--first-row", "south"], 0.0),
        ("d.r16", &[], 0.002),
        ("e.r16", &["--first-row", "south", "--range", "-100,300"], 0.0031),
        ("f.png", &[], 0.002),
        ("g.png", &["--first-row", "south"], 0.002),
        ("h.png", &["--bits", "8"], 0.491),
        ("i.raw", &["--format", "r16", "--no-sidecar"], 0.002),
    ] {
        let told = folder.good(&[&["export", "small.toml", "-o", file][..], options].concat());
        if file == "i.raw" {
            assert!(folder.read(file) == folder.read("d.r16") && !folder.path("i.json").exists());
            continue;
        }
        assert!(told.text().contains("64 x 48 samples of 10 m"), "{}", told.text());
        folder.good(&["export", file, "-o", "back.npy", "-q"]);
        assert!(off(&folder, "all.npy", "back.npy") <= most, "{file}: {}", off(&folder, "all.npy", "back.npy"));
    }
    let told = folder.json("e.json");
    assert_eq!((told["low"].as_f64(), told["high"].as_f64()), (Some(-100.0), Some(300.0)));
    let all = npy(&folder.read("all.npy"));
    let number = |key: &str| told[key].as_f64().unwrap() as f32;
    assert!(
        all.data().iter().all(|h| (number("min")..=number("max")).contains(h)) && all.data().contains(&number("max"))
    );
    for (key, expect) in
        [("seed", "3"), ("cell", "10.0"), ("first_row", "\"south\""), ("layer", "\"height\""), ("sea_level", "0.0")]
    {
        assert_eq!(told[key].to_string(), expect, "{key}");
    }
    assert_eq!(told["layer_sha256"].as_str().unwrap().len(), 64);
    // Both files have the same rows in opposite order.
    let (north, south) = (folder.read("b.r32"), folder.read("c.r32"));
    assert!(north.chunks(256).eq(south.chunks(256).rev()));
}

#[test]
fn a_sidecar_takes_nobodys_place() {
    let folder = Folder::with_small();
    let recipe = folder.good(&["export", "small.toml", "-o", "b.r16"]);
    assert!(recipe.text().contains("; b.json describes it"), "{}", recipe.text());
    let told = folder.good(&["export", "small.toml", "-o", "b.png", "--bits", "8", "--range", "-500,500"]);
    assert!(told.text().contains("; b.png.json describes it"), "{}", told.text());
    folder.good(&["export", "b.png", "-o", "back.npy", "-q"]);
    folder.good(&["export", "small.toml", "-o", "all.npy", "-q"]);
    assert!(off(&folder, "all.npy", "back.npy") <= 1.97, "each file is read by its own sidecar");
    // A recipe with that name is kept.
    folder.write("c.json", "{\"orogen\": 1}");
    folder.good(&["export", "small.toml", "-o", "c.r16", "-q"]);
    assert_eq!(folder.text("c.json"), "{\"orogen\": 1}");
    assert!(folder.path("c.r16.json").exists());
}

#[test]
fn labels_and_masks_keep_their_numbers() {
    let folder = Folder::new();
    let text = SMALL.replace("[outputs]", "[nodes.rain]\nop = \"drainage\"\nsource = \"land\"\n[nodes.steep]\n\
        op = \"select-slope\"\nsource = \"land\"\nrange = [10, 90]\n[outputs]\nsteep = \"steep\"\nwatershed = \"rain.watershed\"");
    folder.write("rivers.toml", text);
    for layer in ["steep", "watershed"] {
        folder.good(&["export", "rivers.toml", "-o", "a.npy", "--layer", layer, "-q"]);
        folder.good(&["export", "rivers.toml", "-o", "a.png", "--layer", layer, "-q"]);
        let (samples, levels) = (npy(&folder.read("a.npy")), png(&folder.read("a.png")).grey16());
        let scale = if layer == "steep" { 65535.0 } else { 1.0 };
        let same =
            samples.data().iter().zip(&levels).all(|(s, l)| (f64::from(*s) * scale - f64::from(*l)).abs() <= 0.5);
        assert!(same && samples.data().iter().any(|s| *s > 0.0), "{layer}");
    }
    folder.bad(
        &[
            "export",
            "rivers.toml",
            "-o",
            "b.png",
            "--layer",
            "watershed",
            "--bits",
            "8",
            "--window",
            "0,0,1,1",
            "--range",
            "3,2",
        ],
        2,
        "the lower first",
    );
}

#[test]
fn heights_in_colors_come_back() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "all.npy", "-q"]);
    let samples = npy(&folder.read("all.npy"));
    for (encoding, base, step) in [("terrarium", -32768.0, 1.0 / 256.0), ("terrain-rgb", -10000.0, 0.1)] {
        folder.good(&["export", "small.toml", "-o", "a.png", "--encoding", encoding, "-q"]);
        let picture = png(&folder.read("a.png"));
        assert_eq!((picture.bits, picture.channels), (8, 3));
        for (rgb, sample) in picture.data.chunks_exact(3).zip(samples.data()) {
            let steps = f64::from(u32::from_be_bytes([0, rgb[0], rgb[1], rgb[2]]));
            assert!((steps * step + base - f64::from(*sample)).abs() <= 0.5001 * step);
        }
    }
}

#[test]
fn engines_get_what_they_ask_for() {
    let folder = Folder::with_small();
    let told = folder.good(&["export", "small.toml", "-o", "a.png", "--target", "unreal", "--size", "253"]);
    assert!(
        told.text().contains("a.png: height, 253 x 253 samples of 1.9") && told.text().contains("Scale X 190."),
        "{}",
        told.text()
    );
    assert!(told.text().contains("the first 480 x 480 m"), "{}", told.text());
    let told = folder.json("a.json");
    assert_eq!(
        (
            told["width"].as_u64(),
            told["low"].as_f64().map(|low| low / -256.0 == (low / -256.0 * 100.0).round() / 100.0)
        ),
        (Some(253), Some(true))
    );

    // Tiles with one scale and shared edges; rows from the south, counted from the south.
    folder.good(&[
        "export",
        "small.toml",
        "-o",
        "u.r16",
        "--target",
        "unity",
        "--size",
        "33",
        "--tiles",
        "2x1",
        "--cell",
        "5",
        "-q",
    ]);
    let levels = |name: &str| -> Vec<u16> {
        folder.read(name).chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect()
    };
    let (west, east) = (levels("u_0_0.r16"), levels("u_1_0.r16"));
    assert!(west.len() == 33 * 33 && (0..33).all(|j| west[33 * j + 32] == east[33 * j]));
    assert!(west.iter().chain(&east).min() == Some(&0) && west.iter().chain(&east).max() == Some(&65535));
    folder.good(&["export", "u_1_0.r16", "-o", "back.npy", "-q"]);
    folder.good(&["export", "small.toml", "-o", "part.npy", "--window", "32,0,33,33", "--cell", "5", "-q"]);
    assert!(off(&folder, "back.npy", "part.npy") < 0.003, "{}", off(&folder, "back.npy", "part.npy"));

    folder.good(&["export", "small.toml", "-o", "t.exr", "--target", "terrain3d", "--size", "256", "-q"]);
    folder.good(&["export", "small.toml", "-o", "h.exr", "--target", "hterrain", "--size", "65", "-q"]);
    folder.good(&[
        "export",
        "small.toml",
        "-o",
        "w.png",
        "--target",
        "hterrain",
        "--size",
        "65",
        "--layer",
        "splat",
        "-q",
    ]);
    assert_eq!(png(&folder.read("w_2.png")).width, 64);
    folder.good(&[
        "export",
        "small.toml",
        "-o",
        "l.png",
        "--target",
        "unreal",
        "--size",
        "127",
        "--tiles",
        "2x1",
        "--cell",
        "2",
        "--layer",
        "splat",
        "-q",
    ]);
    assert!(folder.path("l_x1_y0_rock.png").exists());

    for (options, code, expect) in [
        (&["-o", "x.png", "--target", "unreal", "--size", "1024"][..], 2, "the nearest is 1009"),
        (&["-o", "x.tif", "--target", "unreal"], 2, "unreal imports `height` as .png or .r16, not as .tif"),
        (&["-o", "x.r16", "--target", "unity", "--first-row", "north"], 2, "sets --first-row"),
        (&["-o", "x.exr", "--target", "terrain3d", "--tiles", "2x2"], 2, "leave out --tiles"),
        (&["-o", "x.r16", "--target", "unity", "--size", "4097", "--cell", "10"], 2, "not inside the world"),
        (&["-o", "x.png", "--target", "cryengine"], 2, "invalid value"),
        (&["-o", "no/x.png", "--target", "unreal"], 1, "cannot write into no: the folder does not exist"),
    ] {
        folder.bad(&[&["export", "small.toml"][..], options].concat(), code, expect);
        assert!(!folder.path("x.png").exists() && !folder.path("x.r16").exists());
    }
}

#[test]
fn one_range_makes_windows_that_fit() {
    let folder = Folder::with_small();
    let window = |file: &str, window: &str| {
        folder.good(&["export", "small.toml", "-o", file, "--range", "-60,210", "--window", window, "-q"]);
        png(&folder.read(file)).grey16()
    };
    let (all, part) = (window("a.png", "0,0,64,48"), window("b.png", "10,20,30,15"));
    assert!((0..15).all(|j| (0..30).all(|i| part[30 * j + i] == all[64 * (j + 20) + i + 10])));
}

#[test]
fn standard_output_gets_the_very_file_and_nothing_else() {
    let folder = Folder::with_small();
    for (options, file) in [
        (&[][..], "a.npy"),
        (&["--format", "png"][..], "a.png"),
        (&["--format", "tif"][..], "a.tiff"),
        (&["--format", "exr"][..], "a.exr"),
        (&["--format", "r16"][..], "a.r16"),
    ] {
        folder.good(&["export", "small.toml", "-o", file]);
        let outcome = folder.good(&[&["export", "small.toml", "-o", "-"][..], options].concat());
        assert!(outcome.out == folder.read(file) && outcome.err.is_empty());
    }
}

#[test]
fn a_reader_that_goes_away_ends_it_quietly() {
    let folder = Folder::new();
    let mut child = folder
        .command(&["export", "classic", "-o", "-"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut start = [0; 6];
    let mut stdout = child.stdout.take().unwrap();
    stdout.read_exact(&mut start).unwrap();
    drop(stdout);
    let outcome = Outcome::of(&child.wait_with_output().unwrap());
    assert_eq!((&start, outcome.code, outcome.err.as_str()), (b"\x93NUMPY", 0, ""));
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_full_is_a_sentence() {
    let folder = Folder::with_small();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = folder.command(&["export", "small.toml", "-o", "-"]).stdout(full).output().unwrap();
    let outcome = Outcome::of(&output);
    assert_eq!(outcome.code, 1);
    assert_eq!(outcome.err, "error: cannot write to standard output: no space left on device\n");
    folder.bad(&["export", "small.toml", "-o", "/dev/full", "--format", "npy"], 1, "no space left on device");
}

#[test]
fn what_cannot_be_asked_for_is_usage() {
    let folder = Folder::with_small();
    for (options, expect) in [
        (&["-o", "a.npz"][..], "did you mean .npy?"),
        (&["-o", "a.qqqqqq"], "known extensions: ."),
        (&["-o", "a.tig"], "did you mean .tif?"),
        (&["-o", "a"], "no file extension"),
        (&["-o", "a.png", "--format", "npy"], "does not match the extension"),
        (&["-o", "a.npy", "--format", "bmp"], "invalid value"),
        (&["-o", "a.npy", "--bits", "8"], "--bits does not apply to the format npy; it applies to: .pgm and .png"),
        (&["-o", "a.png", "--bits", "12"], "invalid value '12' for '--bits <N>': it must be 8 or 16"),
        (&["-o", "a.png", "--range", "9,3"], "the lower first"),
        (&["-o", "a.png", "--encoding", "terrarium", "--range", "1,2"], "leave out --range"),
        (&["-o", "a.hgt"], "not 64 x 48; the nearest is --cell 0.4 --window 0,0,1201,1201"),
        (&["-o", "a.npy", "--layer", "hieght"], "did you mean `height`?"),
        (&["-o", "a.npy", "--layer", "qqqqqq"], "`height` and `noise`"),
        (&["-o", "a.npy", "--layer", "rivers"], "`rivers` consists of vector features, which .npy cannot hold"),
        (&["-o", "a.npy", "--window", "60,0,10,10"], "not inside the world"),
        (&["-o", "a.npy", "--window", "-1,0,10,10"], "not inside the world"),
        (&["-o", "a.npy", "--window", "0,0,10"], "X,Y,W,H"),
        (&["-o", "a.npy", "--window", "0,0,0,10"], "1 to 1000000000 samples"),
        (&["-o", "a.npy", "--window", "99999999999999,0,5,5"], "not inside the world"),
        (&["-o", "a.npy", "--window", "9223372036854775807,0,5,5"], "not a column or row"),
        (&["-o", "a.npy", "--cell", "-2"], "greater than 0 m"),
        (&[], "--out <FILE>"),
    ] {
        folder.bad(&[&["export", "small.toml"][..], options].concat(), 2, expect);
        assert_eq!(folder.names(""), ["small.toml"], "{options:?}");
    }
    folder.bad(&["export", "small.toml", "-o", "none/a.npy"], 1, "cannot write into none: the folder does not exist");
    folder.bad(&["export", "small.toml", "-o", "a.npy", "--memory", "1kB"], 1, "of memory");
    // The suggested window is valid.
    folder.good(&["export", "small.toml", "-o", "a.hgt", "--cell", "0.4", "--window", "0,0,1201,1201"]);
}
