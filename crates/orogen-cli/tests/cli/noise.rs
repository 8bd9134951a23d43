//! `orogen noise`.

use crate::harness::{Folder, npy, png};
use orogen_noise::{Basis, Depth, Falloff, Fractal, Kind, Points};

/// The samples of the noise over W x H.
fn samples(noise: &Fractal, width: u32, height: u32, depth: Option<f64>) -> Vec<f32> {
    let side = |n| (0..n).map(f64::from).collect::<Vec<_>>();
    let (xs, ys) = (side(width), side(height));
    let points = Points::Lattice { xs: &xs, ys: &ys };
    let mut value = vec![0.0; points.len()];
    match depth {
        None => noise.fill(&points, &mut value).unwrap(),
        Some(depth) => noise.fill3(&points, &Depth::Slice(depth), &mut value).unwrap(),
    }
    value
}

/// The f32 values at the end of an array file, and the shape in its header.
fn array(bytes: &[u8], count: usize) -> (Vec<f32>, String) {
    let (header, data) = bytes.split_at(bytes.len() - count * 4);
    let header = String::from_utf8_lossy(header).into_owned();
    let shape = header.split_once("'shape': ").unwrap().1.split_once(", }").unwrap().0.to_string();
    (data.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect(), shape)
}

#[test]
fn every_basis_is_drawn_with_the_librarys_own_samples() {
    let folder = Folder::new();
    for &basis in Basis::all() {
        folder.good(&["noise", basis.name(), "-o", "a.npy", "--size", "70x40", "--seed", "9", "-q"]);
        let wavelength = if basis == Basis::White { 1.0 } else { 64.0 };
        let noise = Fractal::new(9, wavelength).with_basis(basis).with_octaves(1);
        let grid = npy(&folder.read("a.npy"));
        assert_eq!((grid.width(), grid.height()), (70, 40));
        assert_eq!(grid.data(), samples(&noise, 70, 40, None), "{}", basis.name());
    }
}

#[test]
fn every_parameter_reaches_the_noise() {
    let folder = Folder::new();
    let options = [
        "--size",
        "33",
        "--wavelength",
        "12.5",
        "--octaves",
        "4",
        "--gain",
        "0.7",
        "--lacunarity",
        "1.9",
        "--seed",
        "5",
    ];
    let noise = Fractal::new(5, 12.5).with_octaves(4).with_gain(0.7).with_lacunarity(1.9);
    let weighted = Kind::Weighted { k: 2.5, falloff: Falloff::SquareRoot };
    for (more, kind, depth) in [
        (&["--fractal", "ridged"][..], Kind::Ridged, None),
        (&["--fractal", "billow", "--z", "-7.5"], Kind::Billow, Some(-7.5)),
        (&["--fractal", "weighted", "--k", "2.5", "--falloff", "square-root"], weighted, None),
        (&["--z", "0"], Kind::Fbm, Some(0.0)),
        (&["--fractal", "ping-pong"], Kind::PingPong { strength: 2.0 }, None),
        (&["--fractal", "ping-pong", "--strength", "3.5", "--z", "1"], Kind::PingPong { strength: 3.5 }, Some(1.0)),
        (&["--fractal", "hybrid"], Kind::Hybrid { offset: 0.7 }, None),
        (&["--fractal", "hybrid", "--offset", "0.9"], Kind::Hybrid { offset: 0.9 }, None),
        (&["--fractal", "hetero"], Kind::Hetero { offset: 0.7 }, None),
        (&["--fractal", "hetero", "--offset", "-0.2"], Kind::Hetero { offset: -0.2 }, None),
        (&["--fractal", "swiss"], Kind::Swiss { warp: 0.15 }, None),
        (&["--fractal", "swiss", "--warp", "0.3"], Kind::Swiss { warp: 0.3 }, None),
        (&["--fractal", "jordan"], Kind::Jordan { warp: 0.35, damp: 0.8 }, None),
        (&["--fractal", "jordan", "--warp", "0.1", "--damp", "2"], Kind::Jordan { warp: 0.1, damp: 2.0 }, None),
    ] {
        folder.good(&[&["noise", "value", "-o", "a.npy"], &options[..], more].concat());
        let expect = samples(&noise.with_basis(Basis::Value).with_kind(kind), 33, 33, depth);
        assert_eq!(npy(&folder.read("a.npy")).data(), expect, "{more:?}");
    }
    // A fractal has six octaves by default, a plain noise one.
    for (more, octaves) in [(&["--fractal", "fbm"][..], 6), (&[], 1)] {
        folder.good(&[&["noise", "value", "-o", "a.npy", "--size", "33"], more].concat());
        let expect = Fractal::default().with_basis(Basis::Value).with_wavelength(64.0).with_octaves(octaves);
        assert_eq!(npy(&folder.read("a.npy")).data(), samples(&expect, 33, 33, None), "{more:?}");
    }
}

#[test]
fn words_of_textbooks_are_the_same_options() {
    let folder = Folder::new();
    let made = |args: &[&str]| {
        folder.good(&[&["noise", "perlin", "-o", "a.npy", "--size", "33", "--octaves", "3"], args].concat());
        npy(&folder.read("a.npy"))
    };
    let expect = made(&["--wavelength", "20", "--gain", "0.7"]);
    assert_eq!(made(&["--scale", "20", "--persistence", "0.7"]), expect);
    assert_eq!(made(&["--frequency", "0.05", "--persistence", "0.7"]), expect);
    for (args, expect) in [
        (&["--frequency", "0.05", "--wavelength", "20"][..], "cannot be used with"),
        (&["--frequency", "0"], "a number greater than 0"),
        (&["--frequency", "1e-320"], "its wavelength would be infinite"),
        (&["--frequency", "slow"], "a number greater than 0"),
    ] {
        folder.bad(&[&["noise", "perlin", "-o", "b.npy"], args].concat(), 2, expect);
    }
}

#[test]
fn an_array_has_the_range_that_is_asked_for() {
    let folder = Folder::new();
    let made = |args: &[&str], count: usize| {
        let line = [&["noise", "perlin", "-o", "a.npy", "--size", "24x16", "--wavelength", "9"], args].concat();
        let outcome = folder.good(&line);
        (array(&folder.read("a.npy"), count * 24 * 16).0, outcome.text().to_string())
    };
    let (plain, _) = made(&[], 1);
    for ([low, high], text) in [([0.0, 1.0], "0,1"), ([-250.0, 1750.0], "-250, 1750"), ([1.0, -1.0], "1,-1")] {
        let (found, told) = made(&["--range", text], 1);
        assert!(told.contains(&format!(", {low} to {high}")), "{told}");
        for (found, plain) in found.iter().zip(&plain) {
            let expect = low + (f64::from(*plain) + 1.0) / 2.0 * (high - low);
            assert!((f64::from(*found) - expect).abs() <= 1e-6 * (high - low).abs(), "{found}, not {expect}");
        }
    }
    let (slices, _) = made(&["--volume", "2", "--range", "0,1"], 2);
    assert!(slices.iter().all(|value| (0.0..=1.0).contains(value)) && slices[..384] != slices[384..]);
    for (args, expect) in [
        (&["-o", "b.png", "--range", "0,1"][..], "--range sets the values of an array; use the extension .npy"),
        (&["-o", "b.npy", "--range", "1,1"], "the values of a range must be different"),
        (&["-o", "b.npy", "--range", "0,1e39"], "32-bit numbers"),
        (&["-o", "b.npy", "--range", "1"], "two numbers separated by a comma"),
        (&["-o", "b.npy", "--range", "0,1", "--gradient"], "cannot be used with"),
    ] {
        folder.bad(&[&["noise", "perlin"], args].concat(), 2, expect);
    }
}

#[test]
fn greys_span_minus_one_to_one() {
    let folder = Folder::new();
    let outcome = folder.good(&["noise", "perlin", "--size", "64x48"]);
    assert_eq!(outcome.text(), "noise.png: perlin noise, wavelength 64, seed 0; 64 x 48 samples\n");
    folder.good(&["noise", "perlin", "--size", "64x48", "-o", "b.PNG", "--bits", "16"]);
    let (a, b) = (png(&folder.read("noise.png")), png(&folder.read("b.PNG")));
    assert_eq!((a.width, a.height, a.bits, a.channels), (64, 48, 8, 1));
    let noise = Fractal::default().with_wavelength(64.0).with_octaves(1);
    for ((value, &grey), deep) in samples(&noise, 64, 48, None).into_iter().zip(&a.data).zip(b.grey16()) {
        assert!((f32::from(grey) - (value + 1.0) * 127.5).abs() <= 0.501);
        assert!((f32::from(deep) - (value + 1.0) * 32767.5).abs() <= 0.52);
    }
}

#[test]
fn white_noise_has_a_value_per_sample() {
    let folder = Folder::new();
    let outcome = folder.good(&["noise", "white", "-o", "a.npy", "--size", "33"]);
    assert_eq!(outcome.text(), "a.npy: white noise, wavelength 1, seed 0; 33 x 33 samples\n");
    let expect = Fractal::default().with_basis(Basis::White).with_wavelength(1.0).with_octaves(1);
    assert_eq!(npy(&folder.read("a.npy")).data(), samples(&expect, 33, 33, None));
    let outcome =
        folder.good(&["noise", "white", "-o", "b.npy", "--size", "33", "--wavelength", "4", "--fractal", "ridged"]);
    assert_eq!(outcome.text(), "b.npy: ridged of 6 octaves of white noise, wavelength 4, seed 0; 33 x 33 samples\n");
}

#[test]
fn an_animation_has_its_frames_and_comes_back() {
    let folder = Folder::new();
    folder.good(&["noise", "perlin", "--size", "40x30", "--frames", "6", "--z", "3", "-o", "a.png"]);
    folder.good(&["noise", "perlin", "--size", "40x30", "--z", "3", "-o", "first.png"]);
    let bytes = folder.read("a.png");
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (6, 0));
    let frames: Vec<Vec<u8>> = (0..6)
        .map(|_| {
            let mut data = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut data).unwrap();
            data
        })
        .collect();
    assert_eq!(frames[0], png(&folder.read("first.png")).data);
    assert!(frames[1] != frames[0] && frames[2] != frames[1] && frames[3] != frames[2]);
    // The animation goes forward and back, except for the rounding of the cosine.
    let far = frames[1].iter().zip(&frames[5]).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(far <= Some(1), "{far:?}");
}

#[test]
fn a_block_is_its_slices() {
    let folder = Folder::new();
    folder.good(&["noise", "perlin", "--size", "20x10", "--volume", "3", "--z", "0.5", "--wavelength", "8"]);
    let (values, shape) = array(&folder.read("noise.npy"), 600);
    assert_eq!(shape, "(3, 10, 20)");
    let noise = Fractal::default().with_wavelength(8.0).with_octaves(1);
    for (slice, depth) in values.chunks_exact(200).zip([0.5, 1.5, 2.5]) {
        assert_eq!(slice, samples(&noise, 20, 10, Some(depth)));
    }
}

#[test]
fn slopes_are_arrays_or_normals() {
    let folder = Folder::new();
    folder.good(&["noise", "perlin", "--size", "20x10", "--gradient", "-o", "a.npy"]);
    let (slopes, shape) = array(&folder.read("a.npy"), 400);
    assert_eq!(shape, "(2, 10, 20)");
    let noise = Fractal::default().with_wavelength(64.0).with_octaves(1);
    for k in [0, 57, 199] {
        let (x, y) = (f64::from(k % 20), f64::from(k / 20));
        let east = (noise.sample(x + 0.5, y) - noise.sample(x - 0.5, y)) as f64;
        let south = (noise.sample(x, y + 0.5) - noise.sample(x, y - 0.5)) as f64;
        let got = [slopes[k as usize], slopes[200 + k as usize]].map(f64::from);
        assert!((got[0] - east).abs() < 1e-3 && (got[1] - south).abs() < 1e-3, "{k}: {got:?} {east} {south}");
    }
    for (bits, options) in [(8, &[][..]), (16, &["--bits", "16"])] {
        folder.good(&[&["noise", "perlin", "--size", "20", "--gradient", "-o", "a.png"][..], options].concat());
        let picture = png(&folder.read("a.png"));
        assert_eq!((picture.bits, picture.channels), (bits, 3));
        let step = usize::from(bits) / 8;
        for pixel in picture.data.chunks_exact(3 * step) {
            let part = |n: usize| f64::from(pixel[n * step]) / 127.5 - 1.0;
            let length = part(0) * part(0) + part(1) * part(1) + part(2) * part(2);
            assert!((length - 1.0).abs() < 0.05 && part(2) > 0.3, "{pixel:?}");
        }
    }
}

#[test]
fn what_is_tileable_repeats_to_the_bit() {
    let folder = Folder::new();
    let noise = Fractal::new(9, 30.0).with_octaves(3);
    let options = ["--wavelength", "30", "--octaves", "3", "--seed", "9", "--tileable"];
    for &basis in Basis::all().iter().filter(|basis| basis.is_tileable()) {
        let outcome = folder.good(&[&["noise", basis.name(), "--size", "60x90", "-o", "a.npy"], &options[..]].concat());
        assert!(outcome.text().ends_with("wavelength 30, seed 9, repeating; 60 x 90 samples\n"), "{}", outcome.text());
        assert_eq!(outcome.err, "");
        let tiled = noise.with_basis(basis).tiled([2, 3]).unwrap();
        for (k, &value) in npy(&folder.read("a.npy")).data().iter().enumerate() {
            let (x, y) = ((k % 60) as f64, (k / 60) as f64);
            assert_eq!((value, value), (tiled.sample(x, y), tiled.sample(x + 60.0, y - 90.0)), "{basis:?} {x} {y}");
        }
    }
}

#[test]
fn wavelengths_are_rounded_to_fit_and_it_is_said() {
    let folder = Folder::new();
    let size = ["--size", "128x50", "--tileable", "-o", "a.npy"];
    let outcome = folder.good(&[&["noise", "perlin", "--wavelength", "30"], &size[..]].concat());
    assert_eq!(
        outcome.err,
        "note: the size is not a multiple of the wavelength 30; it is 32 x 25, so that 4 x 2 fit\n"
    );
    assert!(outcome.text().contains("wavelength 32 x 25, seed 0, repeating"), "{}", outcome.text());
    let tiled = Fractal::default().with_wavelength(1.0).with_octaves(1).tiled([4, 2]).unwrap();
    for (k, &value) in npy(&folder.read("a.npy")).data().iter().enumerate() {
        let expect = tiled.sample((k % 128) as f64 / 32.0, (k / 128) as f64 / 25.0);
        assert!((value - expect).abs() < 1e-5, "{k}: {value} {expect}");
    }
    let quiet = folder.good(&[&["noise", "perlin", "--wavelength", "30", "-q"], &size[..]].concat());
    assert_eq!(quiet.err, "");
    // A wavelength longer than the picture is limited to its size.
    let outcome = folder.good(&["noise", "value", "--wavelength", "500", "--size", "40", "--tileable"]);
    assert!(outcome.err.contains("it is 40, so that 1 x 1 fit"), "{}", outcome.err);
}

#[test]
fn tileable_animations_blocks_slopes_and_materials_close() {
    let folder = Folder::new();
    let options = ["--size", "48", "--wavelength", "16", "--tileable"];
    // A block of 20 slices has one wavelength of 20 along its depth.
    let outcome =
        folder.good(&[&["noise", "perlin", "--volume", "20", "--z", "3", "-o", "a.npy"], &options[..]].concat());
    assert!(outcome.err.ends_with("wavelength 16; through the slices it is 20, so that 1 fit\n"), "{}", outcome.err);
    let (values, _) = array(&folder.read("a.npy"), 48 * 48 * 20);
    let tiled = Fractal::default().with_wavelength(16.0).with_octaves(1).tiled([3, 3, 1]).unwrap();
    for k in (0..values.len()).step_by(97) {
        let (x, y, z) = ((k % 48) as f64, (k / 48 % 48) as f64, (k / 2304 + 3) as f64 * 0.8);
        assert_eq!(values[k], tiled.sample3(x + 48.0, y, z), "{k}");
        assert_eq!(tiled.sample3(x, y, z), tiled.sample3(x, y - 48.0, z + 16.0), "{k}");
    }
    // One wavelength over all frames: frame 12 of 24 is half way, and the frame after the last equals the first.
    folder.good(&[&["noise", "perlin", "--frames", "24", "-o", "a.png"], &options[..]].concat());
    let bytes = folder.read("a.png");
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let frames: Vec<Vec<u8>> = (0..24)
        .map(|_| {
            let mut data = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut data).unwrap();
            data
        })
        .collect();
    for (frame, data) in frames.iter().enumerate() {
        let z = 16.0 * frame as f64 / 24.0;
        for k in (0..data.len()).step_by(53) {
            let value = tiled.sample3((k % 48) as f64, (k / 48) as f64, z + 16.0);
            assert!((f32::from(data[k]) - (value + 1.0) * 127.5).abs() <= 0.501, "{frame} {k}");
        }
    }
    // Seams of textures made from the noise are not steeper than the interior.
    for more in [&["--gradient"][..], &["--texture", "marble"], &["--texture", "wood"], &["--texture", "clouds"]] {
        let options = ["--size", "96", "--wavelength", "32", "--tileable", "-q", "-o", "b.png"];
        folder.good(&[&["noise", "perlin"], more, &options[..]].concat());
        let picture = png(&folder.read("b.png"));
        let at = |x: usize, y: usize| picture.data[(y % 96 * 96 + x % 96) * 3 + 1];
        let across = |x: usize| (0..96).map(|y| u64::from(at(x, y).abs_diff(at(x + 1, y)))).sum::<u64>();
        let down = |y: usize| (0..96).map(|x| u64::from(at(x, y).abs_diff(at(x, y + 1)))).sum::<u64>();
        let [inside, below] = [(0..95).map(across).max().unwrap(), (0..95).map(down).max().unwrap()];
        assert!(across(95) <= inside + inside / 4 && down(95) <= below + below / 4, "{more:?}");
    }
}

#[test]
fn textures_are_colored_each_in_its_way() {
    let folder = Folder::new();
    for texture in ["clouds", "marble", "wood"] {
        folder.good(&["noise", "perlin", "--size", "128", "--texture", texture, "-o", "a.png"]);
        let picture = png(&folder.read("a.png"));
        assert_eq!((picture.bits, picture.channels), (8, 3));
        let sum = |c: usize| picture.data.iter().skip(c).step_by(3).map(|&b| u64::from(b)).sum::<u64>();
        let (red, blue) = (sum(0), sum(2));
        match texture {
            "clouds" => assert!(blue > red * 11 / 10),
            "wood" => assert!(red > blue * 15 / 10),
            _ => assert!(red.abs_diff(blue) < red / 10),
        }
        folder.good(&["noise", "value", "--size", "16", "--texture", texture, "--frames", "2", "-o", "b.png"]);
    }
}

#[test]
fn what_cannot_be_drawn_is_a_sentence_and_leaves_nothing() {
    let folder = Folder::new();
    for (arguments, code, expect) in [
        (&["perln"][..], 2, "a similar value exists: 'perlin'"),
        (&["nothing"], 2, "possible values: white, value, perlin"),
        (&[], 2, "<BASIS>"),
        (&["perlin", "--size", "0"], 2, "sides from 1 to 1000000000"),
        (&["perlin", "--size", "5x0"], 2, "sides from 1 to 1000000000"),
        (&["perlin", "--size", "1000000000"], 1, "of memory"),
        (&["perlin", "--size", "4000", "--frames", "2", "--memory", "100MB"], 1, "of memory, and 95 MiB is allowed"),
        (&["perlin", "--wavelength", "0"], 2, "a number greater than 0"),
        (&["perlin", "--wavelength", "nan"], 2, "a number greater than 0"),
        (&["perlin", "--wavelength", "long"], 2, "a number greater than 0"),
        (&["perlin", "--octaves", "0"], 2, "a whole number from 1 to 32"),
        (&["perlin", "--octaves", "33"], 2, "a whole number from 1 to 32"),
        (&["perlin", "--gain", "inf"], 2, "must be a number"),
        (&["perlin", "--lacunarity", "0"], 2, "greater than 0"),
        (&["perlin", "--k", "1"], 2, "--k applies to --fractal weighted"),
        (&["perlin", "--fractal", "ridged", "--falloff", "smoothstep"], 2, "--falloff applies to --fractal weighted"),
        (&["perlin", "--fractal", "swiss", "--strength", "1"], 2, "--strength applies to --fractal ping-pong"),
        (&["perlin", "--offset", "1"], 2, "--offset applies to --fractal hybrid or hetero"),
        (&["perlin", "--warp", "1"], 2, "--warp applies to --fractal swiss or jordan"),
        (&["perlin", "--fractal", "swiss", "--damp", "1"], 2, "--damp applies to --fractal jordan"),
        (&["perlin", "--fractal", "jordan", "--damp", "-1"], 2, "a number, at least 0"),
        (&["simplex", "--tileable"], 2, "simplex cannot be tileable: its triangular lattice"),
        (&["opensimplex2-smooth", "--tileable"], 2, "use perlin, value or worley"),
        (
            &["perlin", "--tileable", "--octaves", "3", "--lacunarity", "1.9"],
            2,
            "a whole number for --lacunarity, such as 2",
        ),
        (&["perlin", "--tileable", "--octaves", "32"], 2, "--tileable: octave"),
        (&["perlin", "--tileable", "--wavelength", "1e-300"], 2, "--tileable: octave 0 would have to repeat after"),
        (&["worley", "--gradient"], 2, "the slope of worley is not implemented"),
        (&["perlin", "--fractal", "weighted", "--k", "-1"], 2, "a number, at least 0"),
        (&["perlin", "--fractal", "rigded"], 2, "ridged"),
        (&["perlin", "--z", "deep"], 2, "must be a number"),
        (&["perlin", "--frames", "0"], 2, "from 1 to 1000000"),
        (&["perlin", "--frames", "3", "-o", "a.npy"], 2, "the extension .png"),
        (&["perlin", "--volume", "0"], 2, "from 1 to 1000000000"),
        (&["perlin", "--volume", "3", "-o", "a.png"], 2, "the extension .npy"),
        (&["perlin", "--volume", "3", "--frames", "3"], 2, "cannot be used with"),
        (&["perlin", "--bits", "12"], 2, "it must be 8 or 16"),
        (&["perlin", "--bits", "16", "-o", "a.npy"], 2, "--bits applies to pictures"),
        (&["perlin", "--texture", "marble", "-o", "a.npy"], 2, "the extension .png"),
        (&["perlin", "--texture", "marble", "--bits", "16"], 2, "not to textures"),
        (&["perlin", "--texture", "marble", "--fractal", "fbm"], 2, "cannot be used with"),
        (&["white", "--gradient"], 2, "white noise has no slope"),
        (&["perlin", "-o", "a.jpg"], 2, "a noise is a .png or .npy"),
        (&["perlin", "-o", "a.tif"], 2, "a noise is a .png or .npy"),
        (&["perlin", "-o", "a.npz"], 2, "a noise is a .png or .npy"),
        (&["perlin", "-o", "a"], 2, "a noise is a .png or .npy"),
        (&["perlin", "-o", "none/a.png"], 1, "cannot write into none: the folder does not exist"),
    ] {
        folder.bad(&[&["noise"][..], arguments].concat(), code, expect);
        assert!(folder.names("").is_empty(), "{arguments:?}");
    }
}

#[test]
fn the_strangest_numbers_are_drawn_all_the_same() {
    let folder = Folder::new();
    for options in [
        &["--wavelength", "1e-300", "--size", "9x7"][..],
        &["--wavelength", "1e300", "--gain", "2", "--size", "7"],
        &["--gain", "-1e300", "--size", "9"],
        &["--lacunarity", "1e300", "--gradient", "--size", "9x7"],
        &["--z", "1e300", "--size", "1x1"],
        &["--frames", "1", "--size", "9"],
        &["--texture", "marble", "--wavelength", "1e-9", "--size", "9"],
    ] {
        folder.good(&[&["noise", "perlin", "--octaves", "3"][..], options].concat());
    }
}
